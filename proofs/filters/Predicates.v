(** The static filters of orient2d, orient3d, incircle and insphere, the latter two also for weighted points, and of
    comparisons of distances (include/errbound/predicates.hpp): the theorems of StaticFilter.v for their expressions.
    ImplicitPoints.v has intersection points. Results: the number of roundings that affect a sign, and the number of
    bits from which the filter's sign is right or uncertain:
        orient2d_sign_certain   3, from 9 bits on; orient3d_sign_certain   7, from 10 bits on
        incircle_sign_certain   10, from 10 bits on; insphere_sign_certain   15, from 11 bits on
        power_incircle_sign_certain   11, from 10 bits on; power_insphere_sign_certain   16, from 11 bits on
        compare_distances2d_sign_certain   4, from 9 bits on; compare_distances3d_sign_certain   5, from 9 bits on
        insphere_semi_static_certain   its semi-static filter, from 24 bits on
        power_incircle_scales, power_insphere_scales   scaling by the degrees of weighted points changes no sign *)

From Coq Require Import Reals ZArith List Lia Lra.
From Flocq Require Import Core.
From Errbound Require Import Format Sign StaticFilter SemiStatic.
Import ListNotations.
Open Scope R_scope.

(** A point as a function from index to coordinate. *)
Definition point := nat -> R.

(** The code: namespace forms, and predicates that combine several forms. *)
Definition area (a b c : point) : expression :=
  Minus (Product (Difference (a 0%nat) (c 0%nat)) (Difference (b 1%nat) (c 1%nat)))
        (Product (Difference (a 1%nat) (c 1%nat)) (Difference (b 0%nat) (c 0%nat))).
Definition cross (a b c d : expression) : expression := Minus (Product a b) (Product c d).
Definition volume (a b c d : point) : expression :=
  let d x i := Difference (x i) (d i) in
  let ax := d a 0%nat in let ay := d a 1%nat in let az := d a 2%nat in
  let bx := d b 0%nat in let by_ := d b 1%nat in let bz := d b 2%nat in
  let cx := d c 0%nat in let cy := d c 1%nat in let cz := d c 2%nat in
  Sum (Sum (Product az (cross bx cy cx by_)) (Product bz (cross cx ay ax cy)))
      (Product cz (cross ax by_ bx ay)).
Definition squared_distance2d (a b : point) : expression :=
  let x := Difference (a 0%nat) (b 0%nat) in let y := Difference (a 1%nat) (b 1%nat) in
  Sum (Product x x) (Product y y).
Definition squared_distance3d (a b : point) : expression :=
  let x := Difference (a 0%nat) (b 0%nat) in let y := Difference (a 1%nat) (b 1%nat) in
  let z := Difference (a 2%nat) (b 2%nat) in
  Sum (Sum (Product x x) (Product y y)) (Product z z).
Definition lifted_area (a b c d : point) (height : point -> expression -> expression) : expression :=
  let d x i := Difference (x i) (d i) in
  let ax := d a 0%nat in let ay := d a 1%nat in
  let bx := d b 0%nat in let by_ := d b 1%nat in
  let cx := d c 0%nat in let cy := d c 1%nat in
  let squared x y := Sum (Product x x) (Product y y) in
  Sum (Sum (Product (height a (squared ax ay)) (cross bx cy cx by_))
           (Product (height b (squared bx by_)) (cross cx ay ax cy)))
      (Product (height c (squared cx cy)) (cross ax by_ bx ay)).
Definition lifted_volume (a b c d e : point) (height : point -> expression -> expression) : expression :=
  let f x i := Difference (x i) (e i) in
  let ax := f a 0%nat in let ay := f a 1%nat in let az := f a 2%nat in
  let bx := f b 0%nat in let by_ := f b 1%nat in let bz := f b 2%nat in
  let cx := f c 0%nat in let cy := f c 1%nat in let cz := f c 2%nat in
  let dx := f d 0%nat in let dy := f d 1%nat in let dz := f d 2%nat in
  let ab := cross ax by_ bx ay in let bc := cross bx cy cx by_ in let cd := cross cx dy dx cy in
  let da := cross dx ay ax dy in let ac := cross ax cy cx ay in let bd := cross bx dy dx by_ in
  let abc := Sum (Minus (Product az bc) (Product bz ac)) (Product cz ab) in
  let bcd := Sum (Minus (Product bz cd) (Product cz bd)) (Product dz bc) in
  let cda := Sum (Sum (Product cz da) (Product dz ac)) (Product az cd) in
  let dab := Sum (Sum (Product dz ab) (Product az bd)) (Product bz da) in
  let squared x y z := Sum (Sum (Product x x) (Product y y)) (Product z z) in
  Sum (Minus (Product (height d (squared dx dy dz)) abc) (Product (height c (squared cx cy cz)) dab))
      (Minus (Product (height b (squared bx by_ bz)) cda) (Product (height a (squared ax ay az)) bcd)).
Definition unweighted (p : point) (squared : expression) : expression := squared.
(** Relative to the point o, with weights as coordinate i. *)
Definition weighted (i : nat) (o p : point) (squared : expression) : expression :=
  Minus squared (Difference (p i) (o i)).

Definition power_incircle (a b c d : point) : expression := lifted_area a b c d (weighted 2 d).
Definition power_insphere (a b c d e : point) : expression := lifted_volume a b c d e (weighted 3 e).
Definition compare_distances2d (p a b : point) : expression :=
  Minus (squared_distance2d p a) (squared_distance2d p b).
Definition compare_distances3d (p a b : point) : expression :=
  Minus (squared_distance3d p a) (squared_distance3d p b).
(** weighted_options::degrees *)
Definition weighted_degrees (count dimension : nat) : list nat :=
  map (fun i => if (i mod dimension =? dimension - 1)%nat then 2%nat else 1%nat) (seq 0 (count * dimension)).

(** Determinants by their rows. *)
Definition det2 (a b c d : R) : R := a * d - b * c.
Definition det3 (p q r : R * R * R) : R :=
  let '(a, b, c) := p in let '(d, e, f) := q in let '(g, h, i) := r in
  a * det2 e f h i - b * det2 d f g i + c * det2 d e g h.
Definition det4 (p q r s : R * R * R * R) : R :=
  let '(a, b, c, d) := p in let '(e, f, g, h) := q in
  let '(i, j, k, l) := r in let '(m, n, o, v) := s in
  a * det3 (f, g, h) (j, k, l) (n, o, v) - b * det3 (e, g, h) (i, k, l) (m, o, v)
  + c * det3 (e, f, h) (i, j, l) (m, n, v) - d * det3 (e, f, g) (i, j, k) (m, n, o).
(** x - o and, last, its squared length. *)
Definition lifted2 (x o : point) : R * R * R :=
  let d i := x i - o i in (d 0%nat, d 1%nat, d 0%nat * d 0%nat + d 1%nat * d 1%nat).
Definition lifted3 (x o : point) : R * R * R * R :=
  let d i := x i - o i in
  (d 0%nat, d 1%nat, d 2%nat,
   d 0%nat * d 0%nat + d 1%nat * d 1%nat + d 2%nat * d 2%nat).
(** The same for weighted points: the difference of weights is subtracted. *)
Definition power_lifted2 (x o : point) : R * R * R :=
  let '(u, v, squared) := lifted2 x o in (u, v, squared - (x 2%nat - o 2%nat)).
Definition power_lifted3 (x o : point) : R * R * R * R :=
  let '(u, v, w, squared) := lifted3 x o in (u, v, w, squared - (x 3%nat - o 3%nat)).
(** Point k with these degrees, scaled by s. *)
Definition scaled (degrees : list nat) (dimension : nat) (s : R) (k : nat) (x : point) : point :=
  fun i => s ^ nth (k * dimension + i) degrees 0%nat * x i.

Section Predicates.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (emin_p : (emin <= 1 - 2 * p)%Z).
Notation filter_sign := (filter_sign p emin).
Notation roundings := (roundings p).
Definition representable (a : point) : Prop := forall i, number p emin (a i).

(** From its counts, which the compiler evaluates. *)
Lemma sign_by_counts e k bits x :
  (2 <= bits <= p)%Z -> admissible p emin e -> roundings e = (k + 1)%nat ->
  (64 * Z.of_nat (k + 3) <= 2 ^ bits)%Z -> exact e = x ->
  roundings e = (k + 1)%nat /\ sign_is_right (filter_sign e) x.
Proof.
  intros P A K B <-. split; auto. apply filter_sign_certain; auto; try lia.
  rewrite K. replace (k + 1 + 2)%nat with (k + 3)%nat by lia.
  apply Rle_trans with (bpow radix2 bits * Format.u p).
  - apply Rmult_le_compat_r; [generalize (u_positive p); lra |].
    rewrite INR_IZR_INZ, <- mult_IZR, <- IZR_Zpower by lia. now apply IZR_le.
  - unfold Format.u. rewrite <- bpow_plus. change 1 with (bpow radix2 0). apply bpow_le. lia.
Qed.

Lemma products_few (n : Z) : (3 <= p)%Z -> (n <= 8)%Z -> (n <= 2 ^ p)%Z.
Proof. intros P H. generalize (Z.pow_le_mono_r 2 3 p). simpl (2 ^ 3)%Z. lia. Qed.

Ltac by_counts :=
  intros;
  lazymatch goal with
  | |- ?r = (?n + 1)%nat /\ _ =>
      lazymatch goal with
      | H : (?least <= p)%Z |- _ => apply sign_by_counts with (k := n) (bits := least)
      end
  end;
  [lia | simpl admissible; repeat split; auto; apply products_few; lia | reflexivity | simpl; lia |].

Theorem orient2d_sign_certain a b c :
  (9 <= p)%Z -> representable a -> representable b -> representable c ->
  roundings (area a b c) = (3 + 1)%nat /\
  sign_is_right (filter_sign (area a b c))
    (det2 (a 0%nat - c 0%nat) (a 1%nat - c 1%nat) (b 0%nat - c 0%nat) (b 1%nat - c 1%nat)).
Proof. by_counts. unfold det2. simpl. ring. Qed.

Theorem orient3d_sign_certain a b c d :
  (10 <= p)%Z -> representable a -> representable b -> representable c -> representable d ->
  let row (x : point) := (x 0%nat - d 0%nat, x 1%nat - d 1%nat, x 2%nat - d 2%nat) in
  roundings (volume a b c d) = (7 + 1)%nat /\
  sign_is_right (filter_sign (volume a b c d)) (det3 (row a) (row b) (row c)).
Proof. by_counts. unfold row, det3, det2. simpl. ring. Qed.

Theorem incircle_sign_certain a b c d :
  (10 <= p)%Z -> representable a -> representable b -> representable c -> representable d ->
  roundings (lifted_area a b c d unweighted) = (10 + 1)%nat /\
  sign_is_right (filter_sign (lifted_area a b c d unweighted))
    (det3 (lifted2 a d) (lifted2 b d) (lifted2 c d)).
Proof. by_counts. unfold lifted2, det3, det2. simpl. ring. Qed.

Theorem insphere_sign_certain a b c d e :
  (11 <= p)%Z ->
  representable a -> representable b -> representable c -> representable d -> representable e ->
  roundings (lifted_volume a b c d e unweighted) = (15 + 1)%nat /\
  sign_is_right (filter_sign (lifted_volume a b c d e unweighted))
    (det4 (lifted3 a e) (lifted3 b e) (lifted3 c e) (lifted3 d e)).
Proof. by_counts. unfold lifted3, det4, det3, det2. simpl. ring. Qed.

Theorem power_incircle_sign_certain a b c d :
  (10 <= p)%Z -> representable a -> representable b -> representable c -> representable d ->
  roundings (power_incircle a b c d) = (11 + 1)%nat /\
  sign_is_right (filter_sign (power_incircle a b c d))
    (det3 (power_lifted2 a d) (power_lifted2 b d) (power_lifted2 c d)).
Proof. by_counts. unfold power_lifted2, lifted2, det3, det2. simpl. ring. Qed.

Theorem power_insphere_sign_certain a b c d e :
  (11 <= p)%Z ->
  representable a -> representable b -> representable c -> representable d -> representable e ->
  roundings (power_insphere a b c d e) = (16 + 1)%nat /\
  sign_is_right (filter_sign (power_insphere a b c d e))
    (det4 (power_lifted3 a e) (power_lifted3 b e) (power_lifted3 c e) (power_lifted3 d e)).
Proof. by_counts. unfold power_lifted3, lifted3, det4, det3, det2. simpl. ring. Qed.

Theorem compare_distances2d_sign_certain q a b :
  (9 <= p)%Z -> representable q -> representable a -> representable b ->
  let squared (x : point) := (q 0%nat - x 0%nat) ^ 2 + (q 1%nat - x 1%nat) ^ 2 in
  roundings (compare_distances2d q a b) = (4 + 1)%nat /\
  sign_is_right (filter_sign (compare_distances2d q a b)) (squared a - squared b).
Proof. by_counts. unfold squared. simpl. ring. Qed.

Theorem compare_distances3d_sign_certain q a b :
  (9 <= p)%Z -> representable q -> representable a -> representable b ->
  let squared (x : point) := (q 0%nat - x 0%nat) ^ 2 + (q 1%nat - x 1%nat) ^ 2 + (q 2%nat - x 2%nat) ^ 2 in
  roundings (compare_distances3d q a b) = (5 + 1)%nat /\
  sign_is_right (filter_sign (compare_distances3d q a b)) (squared a - squared b).
Proof. by_counts. unfold squared. simpl. ring. Qed.

(** M is the largest of all differences, as computed. *)
Theorem insphere_semi_static_certain a b c d e M :
  (24 <= p)%Z -> (emin <= - 4 * p - 5)%Z ->
  representable a -> representable b -> representable c -> representable d -> representable e ->
  number p emin M ->
  (forall x i, In x [a; b; c; d] -> Rabs (rnd p emin nearest (x i - e i)) <= M) ->
  sign_is_right (semi_static_sign p emin M (lifted_volume a b c d e unweighted))
    (det4 (lifted3 a e) (lifted3 b e) (lifted3 c e) (lifted3 d e)).
Proof.
  intros P E A B C D F N L.
  assert (M0 : 0 <= M).
  { apply Rle_trans with (2 := L a 0%nat (or_introl eq_refl)). apply Rabs_pos. }
  replace (det4 (lifted3 a e) (lifted3 b e) (lifted3 c e) (lifted3 d e))
    with (exact (lifted_volume a b c d e unweighted)) by (unfold lifted3, det4, det3, det2; simpl; ring).
  apply semi_static_sign_certain; auto; try lia.
  - simpl admissible. repeat split; auto; apply products_few; lia.
  - assert (La : forall i, Rabs (rnd p emin nearest (a i - e i)) <= M) by (intros; apply L; simpl; auto).
    assert (Lb : forall i, Rabs (rnd p emin nearest (b i - e i)) <= M) by (intros; apply L; simpl; auto).
    assert (Lc : forall i, Rabs (rnd p emin nearest (c i - e i)) <= M) by (intros; apply L; simpl; auto).
    assert (Ld : forall i, Rabs (rnd p emin nearest (d i - e i)) <= M) by (intros; apply L; simpl; auto).
    simpl homogeneous. repeat split; auto.
  - vm_compute. discriminate.
  - simpl. lia.
  - apply Z.le_trans with (2 ^ 18)%Z; [vm_compute; discriminate |]. apply Z.pow_le_mono_r; lia.
  - simpl. lia.
  - change (StaticFilter.roundings p (lifted_volume a b c d e unweighted)) with 16%nat.
    apply Rle_trans with (bpow radix2 24 * Format.u p).
    + apply Rmult_le_compat_r; [generalize (u_positive p); lra |].
      rewrite INR_IZR_INZ, <- mult_IZR, <- IZR_Zpower by lia. now apply IZR_le.
    + unfold Format.u. rewrite <- bpow_plus. change 1 with (bpow radix2 0). apply bpow_le. lia.
Qed.

End Predicates.

Theorem power_incircle_scales s a b c d :
  let by_s := scaled (weighted_degrees 4 3) 3 s in
  exact (power_incircle (by_s 0%nat a) (by_s 1%nat b) (by_s 2%nat c) (by_s 3%nat d)) =
  s ^ 4 * exact (power_incircle a b c d).
Proof. simpl. unfold scaled. simpl. ring. Qed.

Theorem power_insphere_scales s a b c d e :
  let by_s := scaled (weighted_degrees 5 4) 4 s in
  exact (power_insphere (by_s 0%nat a) (by_s 1%nat b) (by_s 2%nat c) (by_s 3%nat d) (by_s 4%nat e)) =
  s ^ 5 * exact (power_insphere a b c d e).
Proof. simpl. unfold scaled. simpl. ring. Qed.
