(** Predicates of intersection points of lines with lines or planes (include/errbound/predicates.hpp). A point is its
    anchor and a quotient, anchor + (x, y, z) / w. A predicate multiplies the sign of a numerator by that of w. If
    the signs of both are right or uncertain, so is the predicate's sign, and it is zero or uncertain if the lines
    are parallel:
        orient2d_line_line_right, orient3d_line_plane_right, compare_x_line_line_right

    The static filter satisfies this from this number of bits on:
        orient2d_line_line_sign_certain   10
        orient3d_line_plane_sign_certain   11
        compare_x_line_line_sign_certain   10 *)

From Coq Require Import Reals ZArith Lia Lra.
From Flocq Require Import Core.
From Errbound Require Import Format Sign StaticFilter Predicates.
From Errbound Require BscCode.
Open Scope R_scope.

Notation times := BscCode.times_sign.

(** ** The code: numerators, denominators, signs *)

Definition difference (a b : point) (i : nat) : expression := Difference (a i) (b i).
(** forms::line_line: x, y, w *)
Definition line_line (a b c d : point) : expression * expression * expression :=
  let x := difference b a 0 in let y := difference b a 1 in
  let u := difference d c 0 in let v := difference d c 1 in
  let along := Minus (Product (difference c a 0) v) (Product (difference c a 1) u) in
  (Product x along, Product y along, Minus (Product x v) (Product y u)).
(** forms::line_plane: x, y, z, w *)
Definition line_plane (a b p q r : point) : expression * expression * expression * expression :=
  let x := difference b a 0 in let y := difference b a 1 in let z := difference b a 2 in
  let qx := difference q p 0 in let qy := difference q p 1 in let qz := difference q p 2 in
  let rx := difference r p 0 in let ry := difference r p 1 in let rz := difference r p 2 in
  let nx := cross qy rz qz ry in let ny := cross qz rx qx rz in let nz := cross qx ry qy rx in
  let dot u v w := Sum (Sum (Product nx u) (Product ny v)) (Product nz w) in
  let along := dot (difference p a 0) (difference p a 1) (difference p a 2) in
  (Product x along, Product y along, Product z along, Sum (Sum (Product nx x) (Product ny y)) (Product nz z)).

Definition w_line_line (a b c d : point) : expression := snd (line_line a b c d).
Definition w_line_plane (a b p q r : point) : expression := snd (line_plane a b p q r).
Definition turn_line_line (a b c d q r : point) : expression :=
  let '(px, py, pw) := line_line a b c d in
  let x := Sum (Product (difference a r 0) pw) px in
  let y := Sum (Product (difference a r 1) pw) py in
  Minus (Product x (difference q r 1)) (Product y (difference q r 0)).
Definition turn_line_plane (a b p q r s t u : point) : expression :=
  let '(ix, iy, iz, iw) := line_plane a b p q r in
  let x := Sum (Product (difference a u 0) iw) ix in
  let y := Sum (Product (difference a u 1) iw) iy in
  let z := Sum (Product (difference a u 2) iw) iz in
  let sx := difference s u 0 in let sy := difference s u 1 in let sz := difference s u 2 in
  let tx := difference t u 0 in let ty := difference t u 1 in let tz := difference t u 2 in
  Sum (Sum (Product x (cross sy tz sz ty)) (Product y (cross sz tx sx tz))) (Product z (cross sx ty sy tx)).
Definition order_line_line (a b c d e f g h : point) : expression :=
  let '(px, _, pw) := line_line a b c d in
  let '(qx, _, qw) := line_line e f g h in
  Sum (Product (difference a e 0) (Product pw qw)) (Minus (Product px qw) (Product qx pw)).

Section Signs.

(** Any function that returns the sign of an expression. *)
Variable sign_of : expression -> sign.

Definition orient2d_line_line (a b c d q r : point) : sign :=
  times (sign_of (turn_line_line a b c d q r)) (sign_of (w_line_line a b c d)).
Definition orient3d_line_plane (a b p q r s t u : point) : sign :=
  times (sign_of (turn_line_plane a b p q r s t u)) (sign_of (w_line_plane a b p q r)).
Definition compare_x_line_line (a b c d e f g h : point) : sign :=
  times (times (sign_of (order_line_line a b c d e f g h)) (sign_of (w_line_line a b c d)))
        (sign_of (w_line_line e f g h)).

(** ** The intersection *)

(** x is on the line through a and b; `coordinates` is their number. *)
Definition on_line (coordinates : nat) (a b x : point) : Prop :=
  exists along, forall i, (i < coordinates)%nat -> x i = a i + along * (b i - a i).
Definition row (x o : point) : R * R * R := (x 0%nat - o 0%nat, x 1%nat - o 1%nat, x 2%nat - o 2%nat).
Definition turn2d (a b c : point) : R :=
  det2 (a 0%nat - c 0%nat) (a 1%nat - c 1%nat) (b 0%nat - c 0%nat) (b 1%nat - c 1%nat).
Definition turn3d (a b c d : point) : R := det3 (row a d) (row b d) (row c d).
Definition parallel_lines (a b c d : point) : Prop :=
  det2 (b 0%nat - a 0%nat) (b 1%nat - a 1%nat) (d 0%nat - c 0%nat) (d 1%nat - c 1%nat) = 0.
Definition parallel_to_plane (a b p q r : point) : Prop := det3 (row b a) (row q p) (row r p) = 0.

Definition finds (e : expression) : Prop := sign_is_right (sign_of e) (exact e).

Lemma times_right s t x w : sign_is_right s (w * x) -> sign_is_right t w -> w <> 0 -> sign_is_right (times s t) x.
Proof. destruct s, t; simpl; auto; intros; nra. Qed.
Lemma times_right_0 s t : sign_is_right t 0 -> sign_is_right (times s t) 0.
Proof. destruct s, t; simpl; auto; lra. Qed.
Lemma zero_times_right s t : sign_is_right s 0 -> sign_is_right (times s t) 0.
Proof. destruct s, t; simpl; auto; lra. Qed.

(** The common point is a + along (b - a). *)
Lemma at_line_line a b c d x :
  on_line 2 a b x -> on_line 2 c d x ->
  let w := exact (w_line_line a b c d) in let '(px, py, _) := line_line a b c d in
  exact px = w * (x 0%nat - a 0%nat) /\ exact py = w * (x 1%nat - a 1%nat).
Proof.
  intros [t A] [s C]. simpl.
  generalize (A 0%nat ltac:(lia)) (A 1%nat ltac:(lia)) (C 0%nat ltac:(lia)) (C 1%nat ltac:(lia)).
  generalize (x 0%nat) (x 1%nat). intros x0 x1 -> -> C0 C1.
  set (bx := b 0%nat - a 0%nat) in *. set (by_ := b 1%nat - a 1%nat) in *.
  set (dx := d 0%nat - c 0%nat) in *. set (dy := d 1%nat - c 1%nat) in *.
  assert (Ex : c 0%nat - a 0%nat = t * bx - s * dx) by lra.
  assert (Ey : c 1%nat - a 1%nat = t * by_ - s * dy) by lra.
  rewrite Ex, Ey. split; ring.
Qed.
Lemma at_line_plane a b p q r x :
  on_line 3 a b x -> turn3d x q r p = 0 ->
  let w := exact (w_line_plane a b p q r) in let '(ix, iy, iz, _) := line_plane a b p q r in
  exact ix = w * (x 0%nat - a 0%nat) /\ exact iy = w * (x 1%nat - a 1%nat) /\ exact iz = w * (x 2%nat - a 2%nat).
Proof.
  intros [t A]. unfold turn3d, row, det3, det2. simpl.
  rewrite (A 0%nat), (A 1%nat), (A 2%nat) by lia. clear A.
  set (qx := q 0%nat - p 0%nat). set (qy := q 1%nat - p 1%nat). set (qz := q 2%nat - p 2%nat).
  set (rx := r 0%nat - p 0%nat). set (ry := r 1%nat - p 1%nat). set (rz := r 2%nat - p 2%nat).
  set (bx := b 0%nat - a 0%nat). set (by_ := b 1%nat - a 1%nat). set (bz := b 2%nat - a 2%nat).
  intros P.
  set (along := _ + _ + _).
  assert (E : along = t * ((qy * rz - qz * ry) * bx + (qz * rx - qx * rz) * by_ + (qx * ry - qy * rx) * bz))
    by (unfold along; lra).
  rewrite E. repeat split; ring.
Qed.

Theorem orient2d_line_line_right a b c d q r :
  finds (turn_line_line a b c d q r) -> finds (w_line_line a b c d) ->
  (parallel_lines a b c d -> sign_is_right (orient2d_line_line a b c d q r) 0) /\
  (~ parallel_lines a b c d -> forall x, on_line 2 a b x -> on_line 2 c d x ->
   sign_is_right (orient2d_line_line a b c d q r) (turn2d x q r)).
Proof.
  unfold finds, orient2d_line_line. intros N W. split; intros P.
  - apply times_right_0. now rewrite <- P.
  - intros x A C. generalize (at_line_line a b c d x A C). intros [X Y].
    apply times_right with (w := exact (w_line_line a b c d)); auto.
    replace (_ * _) with (exact (turn_line_line a b c d q r)); auto.
    simpl in X, Y |- *. rewrite X, Y. unfold turn2d, det2. ring.
Qed.

Theorem orient3d_line_plane_right a b p q r s t u :
  finds (turn_line_plane a b p q r s t u) -> finds (w_line_plane a b p q r) ->
  (parallel_to_plane a b p q r -> sign_is_right (orient3d_line_plane a b p q r s t u) 0) /\
  (~ parallel_to_plane a b p q r -> forall x, on_line 3 a b x -> turn3d x q r p = 0 ->
   sign_is_right (orient3d_line_plane a b p q r s t u) (turn3d x s t u)).
Proof.
  unfold finds, orient3d_line_plane. intros N W. split; intros P.
  - apply times_right_0. rewrite <- P. replace (det3 _ _ _) with (exact (w_line_plane a b p q r)); auto.
    unfold row, det3, det2. simpl. ring.
  - intros x A C. generalize (at_line_plane a b p q r x A C). intros [X [Y Z]].
    apply times_right with (w := exact (w_line_plane a b p q r)); auto.
    + replace (_ * _) with (exact (turn_line_plane a b p q r s t u)); auto.
      simpl in X, Y, Z |- *. rewrite X, Y, Z. unfold turn3d, row, det3, det2. ring.
    + intros E. apply P. unfold parallel_to_plane. rewrite <- E. unfold row, det3, det2. simpl. ring.
Qed.

Theorem compare_x_line_line_right a b c d e f g h :
  finds (order_line_line a b c d e f g h) -> finds (w_line_line a b c d) -> finds (w_line_line e f g h) ->
  (parallel_lines a b c d \/ parallel_lines e f g h -> sign_is_right (compare_x_line_line a b c d e f g h) 0) /\
  (~ parallel_lines a b c d -> ~ parallel_lines e f g h ->
   forall x y, on_line 2 a b x -> on_line 2 c d x -> on_line 2 e f y -> on_line 2 g h y ->
   sign_is_right (compare_x_line_line a b c d e f g h) (x 0%nat - y 0%nat)).
Proof.
  unfold finds, compare_x_line_line. intros N V W. split.
  - intros [P | P].
    + apply zero_times_right, times_right_0. now rewrite <- P.
    + apply times_right_0. now rewrite <- P.
  - intros P Q x y A C E G.
    generalize (at_line_line a b c d x A C) (at_line_line e f g h y E G). intros [X _] [Y _].
    apply times_right with (w := exact (w_line_line e f g h)); auto.
    apply times_right with (w := exact (w_line_line a b c d)); auto.
    replace (_ * _) with (exact (order_line_line a b c d e f g h)); auto.
    simpl in X, Y |- *. rewrite X, Y. ring.
Qed.

End Signs.

(** ** The static filter *)

Section Filter.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (emin_p : (emin <= 1 - 2 * p)%Z).
Notation filter_sign := (filter_sign p emin).
Notation roundings := (roundings p).
Notation representable := (representable p emin).

Ltac found bits :=
  lazymatch goal with
  | |- finds _ ?e =>
      let n := eval vm_compute in (StaticFilter.roundings 53%Z e - 1)%nat in
      apply (sign_by_counts p emin emin_p e n bits (exact e))
  end; [lia | simpl admissible; repeat split; auto; apply products_few; lia | reflexivity | simpl; lia | reflexivity].

Theorem orient2d_line_line_sign_certain a b c d q r :
  (10 <= p)%Z -> representable a -> representable b -> representable c -> representable d -> representable q ->
  representable r ->
  roundings (turn_line_line a b c d q r) = (9 + 1)%nat /\
  finds filter_sign (turn_line_line a b c d q r) /\ finds filter_sign (w_line_line a b c d).
Proof. intros. split; [reflexivity |]. split; found 10%Z. Qed.

Theorem orient3d_line_plane_sign_certain a b c d e f g h :
  (11 <= p)%Z -> representable a -> representable b -> representable c -> representable d -> representable e ->
  representable f -> representable g -> representable h ->
  roundings (turn_line_plane a b c d e f g h) = (17 + 1)%nat /\
  finds filter_sign (turn_line_plane a b c d e f g h) /\ finds filter_sign (w_line_plane a b c d e).
Proof. intros. split; [reflexivity |]. split; found 11%Z. Qed.

Theorem compare_x_line_line_sign_certain a b c d e f g h :
  (10 <= p)%Z -> representable a -> representable b -> representable c -> representable d -> representable e ->
  representable f -> representable g -> representable h ->
  roundings (order_line_line a b c d e f g h) = (12 + 1)%nat /\
  finds filter_sign (order_line_line a b c d e f g h) /\ finds filter_sign (w_line_line a b c d) /\
  finds filter_sign (w_line_line e f g h).
Proof. intros. split; [reflexivity |]. repeat split; found 10%Z. Qed.

End Filter.
