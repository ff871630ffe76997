(** The last stage of the exact decisions (ccd/exact/interior_contact.hpp, ccd/exact/integer_decision.hpp): certain
    answers are right. Forms have exact integers as coefficients, since numbers of the code are rounded to words;
    FixedWidths.v proves that they fit. Estimates of positions are arbitrary functions. Results:
        throughout_right        signs of G_i that are certain throughout a bracket are right at a root of Y
        normal_vanishes_right   then N = 0 inside the bracket: a root of Y without contact
        near_right, near_here, by_halving_right   the meaning of answers on an interval
        interior_contact_right  collides: Y = 0 and all G_i > 0 at some t in [0, 1]; separate: nowhere, or Y = 0
                                throughout and some G_i <= 0 at t = 0
        interior_contact_ends, three_parts_wait   the loop ends, and at most three intervals wait
        face_decision_right, edges_decision_right, vertex_edge_decision_right   certain answers of contact_of are
            right *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool Classical.
From Flocq Require Import Core.
From Errbound Require Import Sign Bernstein Subdivision Contact VertexEdge Decisions AxisUnits CubicRoots.
From Errbound Require BoundedInteger.
Import ListNotations.
Open Scope R_scope.

(** ** Weights at a time *)

Definition all_positive (edges : bool) (b c p : point) : bool :=
  forallb (fun w => same_sign (sign_of_real w) positive) (weights edges b c p).
Lemma all_positive_true edges b c p : all_positive edges b c p = true <-> weights_positive edges b c p.
Proof.
  unfold all_positive, weights_positive. rewrite forallb_forall, Forall_forall.
  split; intros H w I; specialize (H w I).
  - pose proof (sign_of_real_right w) as S. destruct (sign_of_real w); try discriminate. easy.
  - now rewrite sign_positive.
Qed.

(** In other units of the axes, weights at Y = 0 are multiplied by one positive factor. *)
Lemma weights_stretched edges k l m b c p : 0 < k -> 0 < l -> 0 < m -> det b c p = 0 -> exists f, 0 < f /\
  weights edges (stretched (Point k l m) b) (stretched (Point k l m) c) (stretched (Point k l m) p) =
  map (Rmult f) (weights edges b c p).
Proof.
  intros K L M D.
  set (b' := stretched (Point k l m) b). set (c' := stretched (Point k l m) c). set (p' := stretched (Point k l m) p).
  assert (H : exists f, 0 < f /\ square_normal b' c' = f * square_normal b c /\
    weight_1 b' c' p' = f * weight_1 b c p /\ weight_2 b' c' p' = f * weight_2 b c p).
  { destruct (origin_dec (cross b c)) as [E | N].
    - exists 1. split; [lra |].
      assert (E' : cross b' c' = origin).
      { apply point_eq in E. unfold b', c', stretched. coordinates. destruct E as (E0 & E1 & E2).
        apply same_point; cbn [x y z].
        - transitivity (l * m * (y b * z c - z b * y c)); [ring | rewrite E0; ring].
        - transitivity (k * m * (z b * x c - x b * z c)); [ring | rewrite E1; ring].
        - transitivity (k * l * (x b * y c - y b * x c)); [ring | rewrite E2; ring]. }
      unfold square_normal, weight_1, weight_2. rewrite E, E'. coordinates. repeat split; ring.
    - assert (N2 : 0 < square_normal b c) by now apply square_positive.
      assert (N' : 0 < square_normal b' c').
      { apply square_positive. intros E. apply N. apply point_eq in E. unfold b', c', stretched in E.
        coordinates. destruct E as (E0 & E1 & E2).
        assert (Z : forall a q w, 0 < a -> 0 < q -> a * q * w = 0 -> w = 0).
        { intros a q w A Q W. apply Rmult_integral in W. destruct W; auto.
          assert (0 < a * q) by now apply Rmult_lt_0_compat. lra. }
        apply same_point; cbn [x y z]; [apply (Z l m) | apply (Z k m) | apply (Z k l)]; auto; lra. }
      exists (square_normal b' c' / square_normal b c). split; [now apply Rdiv_lt_0_compat |].
      pose proof (decomposed b c p) as E. cbv zeta in E. fold (square_normal b c) in E. rewrite D in E.
      apply point_eq in E.
      assert (Ep : along (along (along origin (- square_normal b c) p') (weight_1 b c p) b') (weight_2 b c
        p) c' = origin).
      { unfold b', c', p', stretched. coordinates. destruct E as (E0 & E1 & E2).
        apply same_point; cbn [x y z].
        - transitivity (k * (0 + - square_normal b c * x p + weight_1 b c p * x b + weight_2 b c p * x c));
            [ring | rewrite E0; ring].
        - transitivity (l * (0 + - square_normal b c * y p + weight_1 b c p * y b + weight_2 b c p * y c));
            [ring | rewrite E1; ring].
        - transitivity (m * (0 + - square_normal b c * z p + weight_1 b c p * z b + weight_2 b c p * z c));
            [ring | rewrite E2; ring]. }
      clearbody b' c' p'. clear E. apply point_eq in Ep. unfold along, origin in Ep. cbn [x y z] in Ep.
      destruct Ep as (E0 & E1 & E2). set (n2 := square_normal b c) in *.
      set (w1 := weight_1 b c p) in *. set (w2 := weight_2 b c p) in *. clearbody n2 w1 w2.
      assert (X0 : n2 * x p' = w1 * x b' + w2 * x c') by lra.
      assert (X1 : n2 * y p' = w1 * y b' + w2 * y c') by lra.
      assert (X2 : n2 * z p' = w1 * z b' + w2 * z c') by lra.
      repeat split; [field; lra | |]; apply Rmult_eq_reg_l with n2; try lra; field_simplify; try lra.
      + unfold weight_1, square_normal, dot, cross. cbn [x y z].
        transitivity (((n2 * y p') * z c' - (n2 * z p') * y c') * (y b' * z c' - z b' * y c') +
          ((n2 * z p') * x c' - (n2 * x p') * z c') * (z b' * x c' - x b' * z c') +
          ((n2 * x p') * y c' - (n2 * y p') * x c') * (x b' * y c' - y b' * x c')); [ring |].
        rewrite X0, X1, X2. ring.
      + unfold weight_2, square_normal, dot, cross. cbn [x y z].
        transitivity ((y b' * (n2 * z p') - z b' * (n2 * y p')) * (y b' * z c' - z b' * y c') +
          (z b' * (n2 * x p') - x b' * (n2 * z p')) * (z b' * x c' - x b' * z c') +
          (x b' * (n2 * y p') - y b' * (n2 * x p')) * (x b' * y c' - y b' * x c')); [ring |].
        rewrite X0, X1, X2. ring. }
  destruct H as (f & F & S & W1 & W2). exists f. split; auto.
  assert (A : forall b c p, on_a b c p = weight_1 b c p) by easy.
  assert (B : forall b c p, on_b b c p = - weight_2 b c p)
    by (intros; unfold on_b, weight_2, dot, cross; simpl; ring).
  unfold weights, weight_0. fold (square_normal b' c') (square_normal b c).
    rewrite (A b c p), (A b' c' p'), (B b c p), (B b' c' p'), S, W1, W2.
  destruct edges; cbn [map]; repeat (apply (f_equal2 (@cons R)); [ring |]); easy.
Qed.

(** ** Numbers known near the bracket *)

Notation known := BoundedInteger.bounded.
Notation stands := BoundedInteger.stands.
Record known_vector := KnownVector { kx : known; ky : known; kz : known }.
Definition cross_known (p q : known_vector) : known_vector :=
  let sub := BoundedInteger.sub in let mul := BoundedInteger.mul in
  KnownVector (sub (mul (ky p) (kz q)) (mul (kz p) (ky q))) (sub (mul (kz p) (kx q)) (mul (kx p) (kz q)))
    (sub (mul (kx p) (ky q)) (mul (ky p) (kx q))).
Definition dot_known (p q : known_vector) : known :=
  let add := BoundedInteger.add in let mul := BoundedInteger.mul in
  add (add (mul (kx p) (kx q)) (mul (ky p) (ky q))) (mul (kz p) (kz q)).
Definition known_weights (edges : bool) (b c p : known_vector) : list known :=
  let sub := BoundedInteger.sub in
  let n := cross_known b c in
  let n2 := dot_known n n in
  if edges then
    let on_a := dot_known (cross_known p c) n in
    let on_b := dot_known (cross_known p b) n in
    [on_a; sub n2 on_a; on_b; sub n2 on_b]
  else
    let w2 := dot_known (cross_known b p) n in
    let w1 := dot_known (cross_known p c) n in
    [w2; w1; sub (sub n2 w1) w2].

Definition vector_stands (v : known_vector) (r : point) : Prop :=
  stands (kx v) (x r) /\ stands (ky v) (y r) /\ stands (kz v) (z r).
Lemma cross_stands p q r s : vector_stands p r -> vector_stands q s ->
  vector_stands (cross_known p q) (cross r s).
Proof.
  intros (Px & Py & Pz) (Qx & Qy & Qz). unfold vector_stands, cross_known, cross. cbn [kx ky kz x y z].
  auto 8 using BoundedInteger.bounded_difference_known, BoundedInteger.bounded_product_known.
Qed.
Lemma dot_stands p q r s : vector_stands p r -> vector_stands q s -> stands (dot_known p q) (dot r s).
Proof.
  intros (Px & Py & Pz) (Qx & Qy & Qz). unfold dot_known, dot.
  auto 8 using BoundedInteger.bounded_sum_known, BoundedInteger.bounded_product_known.
Qed.
Lemma weights_stand edges b c p b' c' p' : vector_stands b b' -> vector_stands c c' -> vector_stands p p' ->
  Forall2 stands (known_weights edges b c p) (weights edges b' c' p').
Proof.
  intros B C P. unfold known_weights, weights, weight_0, weight_1, weight_2, on_a, on_b, square_normal.
  destruct edges; cbv zeta; repeat constructor;
    auto 8 using BoundedInteger.bounded_difference_known, cross_stands, dot_stands.
Qed.

(** The loop over G_i. *)
Fixpoint conclusion (found : outcome) (gs : list known) : outcome :=
  match gs with
  | [] => found
  | g :: rest =>
      match BoundedInteger.sign_of g with
      | negative => separate
      | positive => conclusion found rest
      | _ => conclusion undecided rest
      end
  end.
Lemma conclusion_right gs ws found : Forall2 stands gs ws ->
  (conclusion found gs = collides -> found = collides /\ Forall (Rlt 0) ws) /\
  (conclusion found gs = separate -> found = separate \/ ~ Forall (Rlt 0) ws).
Proof.
  intros F. revert found. induction F as [| g w gs ws S F IH]; intros found; cbn [conclusion]; [auto |].
  pose proof (BoundedInteger.bounded_sign_certain g w S) as H.
  destruct (BoundedInteger.sign_of g); simpl in H.
  - split; [discriminate |]. intros _. right. intros N. inversion_clear N. lra.
  - destruct (IH undecided) as (A & B). split; intros E; [now apply A in E |].
    destruct (B E) as [| N]; [discriminate |]. right. intros K. now inversion_clear K.
  - destruct (IH found) as (A & B). split; intros E.
    + destruct (A E). auto.
    + destruct (B E) as [| N]; auto. right. intros K. now inversion_clear K.
  - destruct (IH undecided) as (A & B). split; intros E; [now apply A in E |].
    destruct (B E) as [| N]; [discriminate |]. right. intros K. now inversion_clear K.
Qed.

(** A difference at low, times 2^bits, rounded to T words; extent is axis.bits. *)
Definition cut_of (T bits extent : Z) : Z := Z.max 0 (bits + extent - (64 * T - 4)).
Definition component (T low bits width_bits extent : Z) (l : list Z) : known :=
  let cut := cut_of T bits extent in
  let slope := (nth 1 l 0 - nth 0 l 0)%Z in
  let changes := (if slope =? 0 then BoundedInteger.exact
                  else BoundedInteger.bit_length slope + width_bits - cut)%Z in
  BoundedInteger.Bounded ((nth 0 l 0 * (2 ^ bits - low) + nth 1 l 0 * low) / 2 ^ cut)%Z
    (if 0 <? cut then Z.max changes 0 + 1 else changes)%Z.

Lemma component_stands T low bits width_bits extent width l t : length l = 2%nat -> (0 <= bits)%Z ->
  (0 <= width < 2 ^ width_bits)%Z -> over low bits <= t <= over (low + width) bits ->
  stands (component T low bits width_bits extent l)
    (IZR (2 ^ bits) / IZR (2 ^ cut_of T bits extent) * form (map IZR l) (1 - t) t).
Proof.
  intros L Hb Hw Ht. destruct l as [| x0 [| x1 [|]]]; try discriminate. clear L.
  assert (W : (0 <= width_bits)%Z).
  { apply Z.nlt_ge. intros N. rewrite Z.pow_neg_r in Hw by easy. lia. }
  pose proof (power_positive _ Hb) as P. set (w := IZR (2 ^ bits)) in *.
  set (u := t * w - IZR low).
  assert (U : 0 <= u <= IZR width).
  { unfold over in Ht. fold w in Ht. rewrite plus_IZR in Ht. unfold u.
    assert (IZR low / w * w = IZR low) by (field; lra).
    assert ((IZR low + IZR width) / w * w = IZR low + IZR width) by (field; lra).
    destruct Ht as (Ht & Ht'). apply (Rmult_le_compat_r w) in Ht, Ht'; lra. }
  unfold component. cbn [nth]. set (cut := cut_of T bits extent). cbv zeta.
  assert (Hc : (0 <= cut)%Z) by (unfold cut, cut_of; lia). pose proof (power_positive _ Hc) as Pc.
  set (v := (x0 * (2 ^ bits - low) + x1 * low)%Z). set (slope := (x1 - x0)%Z).
  assert (E : w * form (map IZR [x0; x1]) (1 - t) t = IZR v + IZR slope * u).
  { unfold v, slope, u, w. rewrite plus_IZR, !mult_IZR, !minus_IZR. simpl. ring. }
  replace (w / IZR (2 ^ cut) * form (map IZR [x0;
    x1]) (1 - t) t) with ((IZR v + IZR slope * u) / IZR (2 ^ cut))
    by (rewrite <- E; field; lra).
  (* the cut *)
  pose proof (Z.div_mod v (2 ^ cut) ltac:(lia)) as D.
  pose proof (Z.mod_pos_bound v (2 ^ cut) ltac:(apply Z.pow_pos_nonneg; lia)) as M.
  set (k := (v / 2 ^ cut)%Z) in *. set (m := (v mod 2 ^ cut)%Z) in *.
  assert (Dr : (IZR v + IZR slope * u) / IZR (2 ^ cut) - IZR k =
    IZR m / IZR (2 ^ cut) + IZR slope * u / IZR (2 ^ cut)).
  { rewrite D, plus_IZR, mult_IZR. field. lra. }
  assert (Hm : 0 <= IZR m / IZR (2 ^ cut) < 1).
  { destruct M as (M0 & M1). apply IZR_le in M0. apply IZR_lt in M1. split.
    - apply Rmult_le_pos; [lra | left; now apply Rinv_0_lt_compat].
    - apply Rmult_lt_reg_r with (IZR (2 ^ cut)); [lra |]. field_simplify; lra. }
  (* the change *)
  destruct (BoundedInteger.bit_length_bounds slope) as (Bl & Bs & _).
  set (n := BoundedInteger.bit_length slope) in *.
  assert (C : Rabs (IZR slope * u / IZR (2 ^ cut)) < bpow radix2 (n + width_bits - cut)).
  { replace (n + width_bits - cut)%Z with (n + (width_bits + - cut))%Z by ring.
    rewrite !bpow_plus, bpow_opp, <- !(IZR_Zpower radix2) by lia. change (Zpower radix2) with (Z.pow 2).
    unfold Rdiv. rewrite !Rabs_mult, <- abs_IZR, Rabs_inv, (Rabs_pos_eq u),
      (Rabs_pos_eq (IZR (2 ^ cut))) by lra.
    rewrite Rmult_assoc. pose proof (power_positive n Bl).
    apply Rle_lt_trans with (IZR (2 ^ n) * (u * / IZR (2 ^ cut))).
    - apply Rmult_le_compat_r; [| now apply IZR_le].
      apply Rmult_le_pos; [lra | left; now apply Rinv_0_lt_compat].
    - apply Rmult_lt_compat_l; auto. apply Rmult_lt_compat_r; [now apply Rinv_0_lt_compat |].
      destruct Hw as (_ & Hw). apply IZR_lt in Hw. lra. }
  unfold stands, BoundedInteger.is_exact. cbn [BoundedInteger.error_bits BoundedInteger.value].
  destruct (Z.ltb_spec 0 cut) as [Cp | Cz].
  - set (e := (if slope =? 0 then BoundedInteger.exact else n + width_bits - cut)%Z).
    destruct (Z.ltb_spec (Z.max e 0 + 1) (BoundedInteger.exact / 2)) as [X | _].
    { exfalso. change (BoundedInteger.exact / 2)%Z with (-524288)%Z in X. lia. }
    rewrite Dr.
    assert (Ch : Rabs (IZR slope * u / IZR (2 ^ cut)) <= bpow radix2 (Z.max e 0)).
    { unfold e. destruct (Z.eqb_spec slope 0) as [-> | _].
      - unfold Rdiv. rewrite !Rmult_0_l, Rabs_R0. apply bpow_ge_0.
      - left. apply Rlt_le_trans with (1 := C). apply bpow_le. lia. }
    pose proof (bpow_le radix2 0 (Z.max e 0) ltac:(lia)) as One. change (bpow radix2 0) with 1 in One.
    rewrite bpow_plus. change (bpow radix2 1) with 2.
    pose proof (Rabs_triang (IZR m / IZR (2 ^ cut)) (IZR slope * u / IZR (2 ^ cut))) as Tr.
    rewrite (Rabs_pos_eq (IZR m / IZR (2 ^ cut))) in Tr by lra. lra.
  - assert (cut = 0)%Z by lia. assert (Zm : IZR m = 0).
    { unfold m. replace cut with 0%Z by easy. rewrite Z.pow_0_r, Z.mod_1_r. easy. }
    rewrite Zm in Dr. unfold Rdiv in Dr at 2. rewrite Rmult_0_l, Rplus_0_l in Dr.
    destruct (Z.eqb_spec slope 0) as [S | S].
    + change (BoundedInteger.exact <? BoundedInteger.exact / 2)%Z with true. cbv iota.
      rewrite S in Dr |- *. unfold Rdiv in Dr at 2. rewrite !Rmult_0_l in Dr. lra.
    + destruct (Z.ltb_spec (n + width_bits - cut) (BoundedInteger.exact / 2)) as [X | _].
      { exfalso. change (BoundedInteger.exact / 2)%Z with (-524288)%Z in X. lia. }
      now rewrite Dr.
Qed.

(** ** interior_contact *)

Section Query.

(** Differences of coordinates as integers, of an edge/edge or a vertex/face query. On each axis they are below
    2^extent, which only determines the rounding. *)
Context (edges : bool) (b c p : @vector_form integers) (degree_b : degree b 1) (degree_c : degree c 1)
  (degree_p : degree p 1) (extent_x extent_y extent_z : Z).
Let y : list R := map IZR (y_form b c p).

Let B (t : R) : point := vector_at b t.
Let C (t : R) : point := vector_at c t.
Let P (t : R) : point := vector_at p t.
(** All G_i > 0. *)
Let Inside (t : R) : Prop := weights_positive edges (B t) (C t) (P t).

Lemma y_length : length y = 4%nat.
Proof. unfold y. rewrite map_length. apply (forms_y b c p 0); auto. Qed.
Lemma y_at t : at_ y t = det (B t) (C t) (P t).
Proof. apply (forms_y b c p t); auto. Qed.

(** forms_at, and the signs of all G_i there. *)
Definition vector_value (v : @vector_form integers) (s t : R) : point :=
  Point (form (map IZR (vx v)) s t) (form (map IZR (vy v)) s t) (form (map IZR (vz v)) s t).
Definition positive_at (s t : R) : bool :=
  all_positive edges (vector_value b s t) (vector_value c s t) (vector_value p s t).

Lemma vector_value_at v s t : degree v 1 -> s + t <> 0 ->
  vector_value v s t = stretched (Point (s + t) (s + t) (s + t)) (vector_at v (t / (s + t))).
Proof.
  intros (L0 & L1 & L2) N. destruct v as [v0 v1 v2]. cbn [vx vy vz] in *.
  assert (E : forall l : list Z, length l = 2%nat ->
    form (map IZR l) s t = (s + t) * form (map IZR l) (1 - t / (s + t)) (t / (s + t))).
  { intros l L. destruct l as [| l0 [| l1 [|]]]; try discriminate. simpl. field. easy. }
  unfold vector_value, vector_at, stretched, at_time. cbn [vx vy vz x Contact.y z]. now rewrite <- !E.
Qed.
Lemma weights_homogeneous k q r s :
  weights edges (stretched (Point k k k) q) (stretched (Point k k k) r) (stretched (Point k k k) s) = map (Rmult (k ^ 4)) (weights
    edges q r s).
Proof.
  unfold weights, weight_0, weight_1, weight_2, on_a, on_b, square_normal, stretched, dot, cross.
  cbn [x Contact.y z].
  destruct edges; cbn [map]; repeat (apply (f_equal2 (@cons R)); [ring |]); easy.
Qed.
Lemma inside_scaled k ws : 0 < k -> Forall (Rlt 0) (map (Rmult k) ws) <-> Forall (Rlt 0) ws.
Proof.
  intros K. rewrite Forall_map, !Forall_forall. split; intros H w I; specialize (H w I); nra.
Qed.
Lemma positive_at_right s t : 0 < s + t -> positive_at s t = true <-> Inside (t / (s + t)).
Proof.
  intros S. unfold positive_at. rewrite all_positive_true. unfold weights_positive.
  rewrite !vector_value_at by (auto; lra). rewrite weights_homogeneous, inside_scaled by (now apply pow_lt).
    easy.
Qed.
Lemma positive_over n bits : (0 <= bits)%Z ->
  positive_at (IZR (2 ^ bits - n)) (IZR n) = true <-> Inside (over n bits).
Proof.
  intros Hb. apply power_positive in Hb. rewrite positive_at_right; rewrite minus_IZR;
    [| lra]. unfold over. now replace (IZR (2 ^ bits) - IZR n + IZR n) with (IZR (2 ^ bits)) by ring.
Qed.

(** throughout: G_i between low and low + width, over 2^bits. *)
Definition known_at (T low bits width_bits : Z) (v : @vector_form integers) : known_vector :=
  KnownVector (component T low bits width_bits extent_x (vx v)) (component T low bits width_bits extent_y
    (vy v))
    (component T low bits width_bits extent_z (vz v)).
Definition throughout (T low bits width_bits : Z) : outcome :=
  conclusion collides (known_weights edges (known_at T low bits width_bits b) (known_at T low bits
    width_bits c)
    (known_at T low bits width_bits p)).

Theorem throughout_right T low bits width_bits width t : (0 <= bits)%Z -> (0 <= width < 2 ^ width_bits)%Z ->
  over low bits <= t <= over (low + width) bits -> at_ y t = 0 ->
  (throughout T low bits width_bits = collides -> Inside t) /\
  (throughout T low bits width_bits = separate -> ~ Inside t).
Proof.
  intros Hb Hw Ht Z. rewrite y_at in Z.
  set (k := fun extent => IZR (2 ^ bits) / IZR (2 ^ cut_of T bits extent)).
  assert (K : forall extent, 0 < k extent).
  { intros extent. unfold k. apply Rdiv_lt_0_compat; apply power_positive; auto. unfold cut_of. lia. }
  assert (V : forall v, degree v 1 -> vector_stands (known_at T low bits width_bits v)
    (stretched (Point (k extent_x) (k extent_y) (k extent_z)) (vector_at v t))).
  { intros v (L0 & L1 & L2).
    repeat split; cbn [known_at kx ky kz]; apply component_stands with (width := width); auto. }
  pose proof (weights_stand edges _ _ _ _ _ _ (V b degree_b) (V c degree_c) (V p degree_p)) as F.
  destruct (weights_stretched edges (k extent_x) (k extent_y) (k extent_z) (B t) (C t) (P t)) as (f & Pf &
    E); auto.
  unfold B, C, P in E. rewrite E in F. destruct (conclusion_right _ _ collides F) as (Yes & No).
  unfold throughout, Inside, weights_positive. split; intros O.
  - destruct (Yes O) as (_ & W). now apply (inside_scaled f).
  - intros W. destruct (No O) as [| N]; [discriminate |]. apply N. now apply inside_scaled.
Qed.

(** normal_vanishes: N's components have a common root inside the bracket. *)
Definition quadratic_of (l : list Z) : quadratic := Quadratic (IZR (nth 0 l 0%Z)) (IZR (nth 1 l 0%Z)) (IZR
  (nth 2 l 0%Z)).
Definition normal_vanishes (low high bits : Z) : bool :=
  let n := cross_form b c in
  let ends v := value v (IZR (2 ^ bits - low)) (IZR low) in
  match common_roots [quadratic_of (vx n); quadratic_of (vy n); quadratic_of (vz n)] with
  | one m =>
      let s := c0 m in let t := c1 m in
      below_0 (s * IZR low - t * IZR (2 ^ bits - low)) && below_0 (t * IZR (2 ^ bits - high) - s * IZR high)
  | of_quadratic f =>
      same_sign (times (sign_of_real (value f (IZR (2 ^ bits - low)) (IZR low)))
        (sign_of_real (value f (IZR (2 ^ bits - high)) (IZR high)))) negative
  | _ => false
  end.

Lemma normal_at t : all_vanish (let n := cross_form b c in
    [quadratic_of (vx n); quadratic_of (vy n); quadratic_of (vz n)]) t <-> cross (B t) (C t) = origin.
Proof.
  destruct (cross_at b c 1 1 t degree_b degree_c) as (E & L0 & L1 & L2). fold (B t) (C t) in E.
  rewrite <- E. cbv zeta. set (n := cross_form b c) in *. clearbody n. clear E.
  assert (Q : forall l, length l = 3%nat -> quadratic_at (quadratic_of l) t = form (map IZR l) (1 - t) t).
  { intros l L. destruct l as [| l0 [| l1 [| l2 [|]]]]; try discriminate.
    unfold quadratic_at, quadratic_of, value. simpl. ring. }
  unfold all_vanish. rewrite !Forall_cons_iff, !Q by easy. split.
  - intros (H0 & H1 & H2 & _). now apply same_point.
  - intros H. apply point_eq in H. destruct H as (H0 & H1 & H2). repeat split; easy.
Qed.
Lemma over_value f n bits : (0 <= bits)%Z ->
  sign_of_real (value f (IZR (2 ^ bits - n)) (IZR n)) = sign_of_real (quadratic_at f (over n bits)).
Proof.
  intros Hb. apply power_positive in Hb.
  replace (value f (IZR (2 ^ bits - n)) (IZR n)) with (IZR (2 ^ bits) ^ 2 * quadratic_at f (over n bits)).
  - rewrite sign_product, (sign_positive (IZR (2 ^ bits) ^ 2)) by now apply pow_lt.
    destruct (sign_of_real _); easy.
  - unfold quadratic_at, value, over. rewrite minus_IZR. field. lra.
Qed.

Theorem normal_vanishes_right low high bits : (0 <= low < high)%Z -> (high <= 2 ^ bits)%Z -> (0 <= bits)%Z ->
  normal_vanishes low high bits = true -> exists t,
    over low bits < t < over high bits /\ at_ y t = 0 /\ ~ Inside t.
Proof.
  intros Hl Hh Hb V.
  assert (N : exists t, over low bits < t < over high bits /\ cross (B t) (C t) = origin).
  { assert (O : 0 <= over low bits /\ over low bits < over high bits /\ over high bits <= 1).
    { pose proof (power_positive _ Hb). split; [| split; [now apply over_less |]].
      - replace 0 with (over 0 bits) by (unfold over; lra). apply over_le; lia.
      - replace 1 with (over (2 ^ bits) bits) by (unfold over; field; lra). now apply over_le. }
    unfold normal_vanishes in V. cbv zeta in V.
    pose proof (common_roots_right (let n := cross_form b c in
      [quadratic_of (vx n); quadratic_of (vy n); quadratic_of (vz n)])) as K. cbv zeta in K.
    destruct (common_roots _) as [| m | f |]; try discriminate; cbn [kind_is_right] in K.
    - destruct K as (k & t & Pk & T & (S0 & S1 & S2) & Only). exists t.
      split; [| apply normal_at, Only; auto]. apply andb_prop in V. destruct V as (V0 & V1).
      assert (Neg : forall a, below_0 a = true -> a < 0) by (intros a; unfold below_0; destruct Rlt_dec;
        easy).
      apply Neg in V0, V1. rewrite S0, S1, minus_IZR in *. pose proof (power_positive _ Hb) as W.
      set (w := IZR (2 ^ bits)) in *.
      assert (F0 : k * (1 - t) * (IZR low - t * w) < 0) by (eapply Rle_lt_trans; [| exact V0]; right; ring).
      assert (F1 : k * (1 - t) * (t * w - IZR high) < 0) by (eapply Rle_lt_trans; [| exact V1]; right; ring).
      assert (0 < k * (1 - t)) by (apply Rmult_lt_0_compat; lra).
      assert (Cancel : forall a q, 0 < a -> a * q < 0 -> q < 0) by (clear; intros; nra).
      apply Cancel in F0, F1; auto. unfold over. fold w.
      split; apply Rmult_lt_reg_r with w; auto; unfold Rdiv; rewrite Rmult_assoc, Rinv_l; lra.
    - destruct K as (_ & Same). rewrite !over_value, <- sign_product in V by easy.
      pose proof (sign_of_real_right (quadratic_at f (over low bits) * quadratic_at f (over high bits))) as S.
      destruct (sign_of_real _); try discriminate. simpl in S.
      destruct (between_signs (quadratic_at f) (over low bits) (over high bits)) as (t & T & Z); auto;
        [| lra |].
      + assert (E : quadratic_at f = at_ [c0 f; c1 f; c2 f]).
        { apply FunctionalExtensionality.functional_extensionality. intros t.
          unfold quadratic_at, value, at_. simpl. ring. }
        rewrite E. apply continuous_form.
      + exists t. split; auto. apply normal_at, Same; auto. lra. }
  destruct N as (t & T & N). exists t. split; auto. split.
  - rewrite y_at. unfold det. rewrite N. unfold dot, origin. cbn [x Contact.y z]. ring.
  - unfold Inside, weights_positive, weights, weight_0, weight_1, weight_2, on_a, on_b, square_normal. rewrite N.
    assert (Z : forall v, dot v origin = 0) by (intros; unfold dot, origin; cbn [x Contact.y z]; ring).
    rewrite !Z. intros F. destruct edges; inversion F; lra.
Qed.

(** Arbitrary estimates in floating point. *)
Context (estimate : part -> Z) (refine : Z -> part -> Z -> Z -> Z -> Z).

Fixpoint near (distinct : bool) (more : nat) (T : Z) (q : part) (place bits : Z) : option outcome :=
  match bracket_near y q place bits with
  | None => None
  | Some (low, high) =>
      if (low =? high)%Z then
        Some (if positive_at (IZR (2 ^ bits - low)) (IZR low) then collides
              else if distinct then separate else undecided)
      else
        let width_bits := BoundedInteger.bit_width (high - low) in
        match throughout T low bits width_bits with
        | undecided =>
            if (T =? 2)%Z && distinct && normal_vanishes low high bits then Some separate
            else
              match more with
              | O => Some undecided
              | Datatypes.S more =>
                  Some (match near distinct more (T + 1) q (refine T q low high bits) (bits + (46 -
                    width_bits)) with
                        | Some found => found
                        | None => undecided
                        end)
              end
        | found => Some found
        end
  end.

(** The meaning of an answer on (a, b). *)
Definition answers (a b : R) (o : outcome) : Prop :=
  match o with
  | collides => exists t, 0 <= t <= 1 /\ at_ y t = 0 /\ Inside t
  | separate => forall t, a < t < b -> at_ y t = 0 -> ~ Inside t
  | undecided => True
  end.

Lemma bit_width_bounds w : (0 <= w <= 2 ^ 25)%Z ->
  (w < 2 ^ BoundedInteger.bit_width w /\ 0 <= BoundedInteger.bit_width w <= 26)%Z.
Proof.
  intros W. unfold BoundedInteger.bit_width. destruct (Z.eqb_spec w 0) as [-> | N]; [simpl; lia |].
  pose proof (Z.log2_spec w ltac:(lia)). pose proof (Z.log2_le_mono w (2 ^ 25) ltac:(lia)).
  rewrite Z.log2_pow2 in * by lia. pose proof (Z.log2_nonneg w). rewrite <- Z.add_1_r in *. lia.
Qed.

(** `collides` implies a root inside the interval. *)
Lemma near_told distinct more T q place bits o : is_part y q -> (level q <= bits)%Z ->
  opposite (roots q) = true ->
  crosses_once (part_start q) (part_end q) (at_ y) (fun t => ~ Inside t /\ distinct = false) ->
  near distinct more T q place bits = Some o -> match o with
    | collides => exists t, part_start q < t < part_end q /\ at_ y t = 0 /\ Inside t
    | _ => answers (part_start q) (part_end q) o
  end.
Proof.
  intros H Hb O One. revert T place bits o Hb.
  induction more as [| more IH]; intros T place bits o Hb; cbn [near].
  all: destruct (bracket_near y q place bits) as [[low high] |] eqn:E; [| discriminate].
  all: destruct (bracket_near_right y q _ place bits low high y_length H Hb O One E) as
    ((L & Lh & W) & Ps & Pe & K).
  all: assert (Hp : (0 <= bits)%Z) by (destruct H as (_ & _ & (? & _) & _); lia).
  all: pose proof (part_inside y q H) as In01.
  all: destruct (Z.eqb_spec low high) as [Eq | Ne].
  1, 3: destruct K as [(_ & In & Z) | (N & _)]; [| lia]; intros X; injection X as <-;
    pose proof (positive_over low bits Hp) as Pos; destruct (positive_at _ _);
    [exists (over low bits); split; [exact In |]; split; auto; now apply Pos |];
    destruct distinct; [| easy]; intros t T' Zt Ins;
    destruct (part_signs y q H) as (A & _);
    destruct (only_crossing _ _ _ _ _ t (over low bits) One A T' In Zt Z) as [-> | [(_ & D) | (_ & D)]];
    try discriminate; apply Pos in Ins; discriminate.
  all: destruct K as [(N & _) | (Lt & r & Hr & Zr & Only)]; [lia |].
  all: destruct (bit_width_bounds (high - low) ltac:(lia)) as (Bw & B0).
  all: destruct (throughout_right T low bits (BoundedInteger.bit_width (high - low)) (high - low) r Hp) as
    (Yes & No);
    [lia | replace (low + (high - low))%Z with high by lia; lra | exact Zr |].
  all: destruct (throughout T low bits (BoundedInteger.bit_width (high - low))).
  1, 4: intros X; injection X as <-; intros t T' Zt; destruct (Only t T' Zt) as [-> | (Q & _)]; auto.
  1, 3: intros X; injection X as <-; exists r; split; [lra | auto].
  all: destruct ((T =? 2)%Z && distinct && normal_vanishes low high bits) eqn:V.
  1, 3: intros X; injection X as <-; apply andb_prop in V; destruct V as (V & Nv); apply andb_prop in V;
    destruct V as (_ & D); destruct (normal_vanishes_right low high bits) as (s & Hs & Zs & Ns); auto;
      try lia;
    destruct (Only s ltac:(lra) Zs) as [-> | (_ & D')]; [| congruence];
    intros t T' Zt; destruct (Only t T' Zt) as [-> | (Q & _)]; auto.
  - intros X. now injection X as <-.
  - destruct (near distinct more (T + 1) q _ _) as [o' |] eqn:E'; intros X; injection X as <-; [| easy].
    apply (IH _ _ _ o') in E'; auto. lia.
Qed.

Theorem near_right distinct more T q place bits o : is_part y q -> (level q <= bits)%Z ->
  opposite (roots q) = true ->
  crosses_once (part_start q) (part_end q) (at_ y) (fun t => ~ Inside t /\ distinct = false) ->
  near distinct more T q place bits = Some o -> answers (part_start q) (part_end q) o.
Proof.
  intros H Hb O One N. pose proof (part_inside y q H). apply near_told in N; auto. destruct o; auto.
  destruct N as (t & T' & Z). exists t. split; auto. lra.
Qed.
Theorem near_here distinct more T q place bits : is_part y q -> (level q <= bits)%Z ->
  opposite (roots q) = true ->
  crosses_once (part_start q) (part_end q) (at_ y) (fun t => ~ Inside t /\ distinct = false) ->
  near distinct more T q place bits = Some collides ->
  exists t, part_start q < t < part_end q /\ at_ y t = 0 /\ Inside t.
Proof. intros H Hb O One N. now apply near_told in N. Qed.

(** True if there are roots other than a double root. *)
Definition any_root (three : bool) (changes : sign_changes) : bool :=
  opposite changes || (three && Nat.ltb 0 (count changes)).
Definition max_halvings : Z := 40.
Definition without_halving (distinct three : bool) (q : part) : option outcome :=
  if negb (any_root three (roots q)) then Some separate
  else
    let found :=
      if opposite (roots q) && (Nat.eqb (count (roots q)) 1 || negb three)
      then near distinct 3 1 q (estimate q) (Z.min (level q + 48) 62) else None in
    match found with
    | Some found => Some found
    | None =>
        if (level q =? max_halvings)%Z then Some (throughout 1 (index q) (level q) 1)
        else
          let h := part_y q in
          let middle := sign_of_real (nth 0 h 0 + nth 1 h 0 + nth 2 h 0 + nth 3 h 0) in
          let t := (2 * index q + 1)%Z in
          if same_sign middle zero && positive_at (IZR (2 ^ (level q + 1) - t)) (IZR t) then Some collides
          else None
    end.

(** The loop. The interval that is tested next comes first. Running out of steps, which the code does not, gives no
    answer. *)
Definition waiting_next (three : bool) (q : part) (rest : list part) : list part :=
  filter (fun half => any_root three (roots half)) [left_of q; right_of q] ++ rest.
Fixpoint by_halving (distinct three : bool) (steps : nat) (waiting : list part) (found : outcome) : outcome :=
  match steps, waiting with
  | O, _ => undecided
  | _, [] => found
  | Datatypes.S steps, q :: rest =>
      match without_halving distinct three q with
      | Some collides => collides
      | Some undecided => by_halving distinct three steps rest undecided
      | Some separate => by_halving distinct three steps rest found
      | None => by_halving distinct three steps (waiting_next three q rest) found
      end
  end.

(** Facts about Y's other roots after at_multiple_root. *)
Definition known_roots (distinct three : bool) : Prop :=
  ~ Forall (eq 0) y /\ (three = true -> 0 < discriminant y) /\
  (three = false -> crosses_once 0 1 (at_ y) (fun t => ~ Inside t /\ distinct = false)).
Definition good (three : bool) (q : part) : Prop :=
  is_part y q /\ (level q <= max_halvings)%Z /\ (three = true -> 0 < discriminant (part_y q)).

(** An interval without roots to test has at most roots that are not crossed. *)
Lemma unasked three q (Q : R -> Prop) : (three = false -> crosses_once 0 1 (at_ y) Q) -> good three q ->
  any_root three (roots q) = false -> forall t, part_start q < t < part_end q -> at_ y t = 0 -> Q t.
Proof.
  intros One (H & _ & Dq) A t T Z. unfold any_root in A. apply orb_false_iff in A. destruct A as (O & A).
  destruct (part_signs y q H) as (S0 & S1 & _). rewrite O in S1. destruct three.
  - simpl in A. apply Nat.ltb_ge in A. pose proof H as (L & Er & _ & Nz & _). rewrite Er in A.
    destruct (no_changes (part_y q) L ltac:(lia)) as [F | F]; [easy |]. exfalso.
    destruct (part_at y q H) as (k & K & E). rewrite E in Z.
    apply (F _ (proj1 (part_place y q t H) T)). apply Rmult_integral in Z. destruct Z; [lra | easy].
  - pose proof (part_inside y q H). refine (uncrossed (part_start q) (part_end q) (at_ y) Q _ t _ S0 S1 T Z).
    apply (restricted 0 1); [now apply One | lra | lra].
Qed.
Lemma dropped distinct three q : known_roots distinct three -> good three q ->
  any_root three (roots q) = false -> answers (part_start q) (part_end q) separate.
Proof. intros (_ & _ & One) G A t T Z. exact (proj1 (unasked three q _ One G A t T Z)). Qed.

Lemma part_root three q : good three q -> any_root three (roots q) = true ->
  exists t, part_start q < t < part_end q /\ at_ y t = 0.
Proof.
  intros (H & _ & D) A. pose proof H as (L & Er & (Hl & _) & _).
  assert (Ru : exists u, 0 < u < 1 /\ at_ (part_y q) u = 0).
  { rewrite Er in A. unfold any_root in A. apply orb_prop in A.
    destruct A as [O | A]; [now apply odd_changes |].
    apply andb_prop in A. destruct A as (-> & C'). apply Nat.ltb_lt in C'. apply any_change; auto. }
  destruct Ru as (u & U & Zu). exists ((IZR (index q) + u) / IZR (2 ^ level q)).
  apply power_positive in Hl.
  assert (Eu : (IZR (index q) + u) / IZR (2 ^ level q) * IZR (2 ^ level q) - IZR (index q) = u) by (field;
    lra).
  split; [apply (proj2 (part_place y q _ H)); now rewrite Eu |].
  destruct (part_at y q H) as (k & _ & E'). rewrite E', Eu, Zu. ring.
Qed.
Lemma all_over_right q : is_part y q -> (exists t, part_start q < t < part_end q /\ at_ y t = 0) ->
  answers (part_start q) (part_end q) (throughout 1 (index q) (level q) 1).
Proof.
  intros H Root. pose proof (part_inside y q H). pose proof H as (_ & _ & (Hl & _) & _).
  assert (Th : forall t, part_start q <= t <= part_end q -> at_ y t = 0 ->
    (throughout 1 (index q) (level q) 1 = collides -> Inside t) /\
    (throughout 1 (index q) (level q) 1 = separate -> ~ Inside t))
    by (intros t T Z; apply throughout_right with (width := 1%Z); auto; lia).
  destruct (throughout 1 (index q) (level q) 1); simpl; auto.
  - intros t T Z. apply Th; auto; lra.
  - destruct Root as (t & T & Z). exists t. split; [lra |]. split; auto. apply Th; auto; lra.
Qed.
Lemma middle_sign q : is_part y q -> let h := part_y q in
  same_sign (sign_of_real (nth 0 h 0 + nth 1 h 0 + nth 2 h 0 + nth 3 h 0)) zero = true <->
  at_ y (over (2 * index q + 1) (level q + 1)) = 0.
Proof.
  intros H h. destruct (part_at y q H) as (k & K & E). pose proof H as (L & _ & (Hl & _) & _). rewrite E.
  pose proof (power_positive _ Hl) as W. unfold over. rewrite Z.pow_add_r, plus_IZR, !mult_IZR by lia.
  change (2 ^ 1)%Z with 2%Z.
  replace ((2 * IZR (index q) + 1) / (IZR (2 ^ level q) * 2) * IZR (2 ^ level q) - IZR (index q)) with (1 / 2)
    by (field; lra).
  unfold h. clear - L K. destruct (part_y q) as [| h0 [| h1 [| h2 [| h3 [|]]]]]; try discriminate. cbn [nth].
  replace (k * at_ [h0; h1; h2; h3] (1 / 2)) with (k / 8 * (h0 + h1 + h2 + h3)) by (unfold at_; simpl; field).
  split.
  - intros S. pose proof (sign_of_real_right (h0 + h1 + h2 + h3)) as Q.
    destruct (sign_of_real _); try discriminate. simpl in Q. rewrite Q. ring.
  - intros Z. apply Rmult_integral in Z. destruct Z; [lra |]. now rewrite sign_zero.
Qed.

Lemma without_halving_right distinct three q : known_roots distinct three -> good three q ->
  match without_halving distinct three q with
  | Some o => answers (part_start q) (part_end q) o
  | None => (level q < max_halvings)%Z /\
      let t := over (2 * index q + 1) (level q + 1) in at_ y t = 0 -> ~ Inside t
  end.
Proof.
  intros K G. unfold without_halving. pose proof (dropped distinct three q K G) as Drop.
  pose proof (part_root three q G) as Root.
  destruct (any_root three (roots q)) eqn:A; cbn [negb]; [| now apply Drop]. clear Drop.
  destruct G as (H & Lv & _). destruct K as (_ & _ & One). pose proof (part_inside y q H) as In01.
  destruct (if opposite (roots q) && (Nat.eqb (count (roots q)) 1 || negb three) then _ else None) as [o |]
    eqn:E.
  { destruct (opposite (roots q) && (Nat.eqb (count (roots q)) 1 || negb three)) eqn:Nr; [| discriminate].
    apply andb_prop in Nr. destruct Nr as (O & Nr).
    apply near_right with (5 := E); auto; [unfold max_halvings in Lv; lia |].
    destruct three; [| apply (restricted 0 1); [now apply One | lra | lra]].
    apply one_change_part; auto. rewrite orb_false_r in Nr. now apply Nat.eqb_eq. }
  destruct (Z.eqb_spec (level q) max_halvings) as [Eq | Ne]; [now apply all_over_right; auto |].
  cbv zeta. pose proof (middle_sign q H) as M. cbv zeta in M.
  assert (Hl : (0 <= level q + 1)%Z) by (destruct H as (_ & _ & (? & _) & _); lia).
  pose proof (positive_over (2 * index q + 1) (level q + 1) Hl) as Pos.
  destruct (halves_are_parts y q H) as (Hq & _ & _ & _ & Em & _).
  pose proof (part_inside y _ Hq) as Im. rewrite Em in Im.
  destruct (same_sign _ zero && positive_at _ _) eqn:S.
  - apply andb_prop in S. destruct S as (S0 & S1). exists (over (2 * index q + 1) (level q + 1)).
    split; [lra |]. split; [now apply M | now apply Pos].
  - split; [lia |]. intros Z I. apply M in Z. apply Pos in I. rewrite Z, I in S. discriminate.
Qed.

Lemma halves_good three q : good three q -> (level q < max_halvings)%Z ->
  good three (left_of q) /\ good three (right_of q).
Proof.
  intros (H & _ & D) L. destruct (halves_are_parts y q H) as (H0 & H1 & _).
  destruct (halves_at (part_y q) 0 (proj1 H)) as (_ & _ & _ & _ & D0 & D1).
  unfold good, left_of, right_of in *. cbn [part_y level] in *.
  split; (split; [easy |]; split; [lia |]); intros E; specialize (D E); lra.
Qed.

Theorem by_halving_right distinct three steps waiting found : known_roots distinct three ->
  Forall (good three) waiting ->
  (by_halving distinct three steps waiting found = collides ->
     found = collides \/ exists t, 0 <= t <= 1 /\ at_ y t = 0 /\ Inside t) /\
  (by_halving distinct three steps waiting found = separate ->
     found = separate /\ forall q, In q waiting -> answers (part_start q) (part_end q) separate).
Proof.
  intros K. revert waiting found. induction steps as [| steps IH]; intros waiting found G; [easy |].
  destruct waiting as [| q rest]; cbn [by_halving]; [split; intros E; [now left | split;
    [easy | intros q []]] |].
  inversion_clear G as [| ? ? Gq Gr].
  pose proof (without_halving_right distinct three q K Gq) as W.
  destruct (without_halving distinct three q) as [[ | | ] |]; simpl in W.
  - destruct (IH rest found Gr) as (Yes & No). split; auto. intros E. destruct (No E) as (F & A). split; auto.
    intros q' [<- | I]; auto.
  - split; [auto | discriminate].
  - destruct (IH rest undecided Gr) as (Yes & No). split; intros E.
    + destruct (Yes E); auto. discriminate.
    + destruct (No E). discriminate.
  - destruct W as (Lv & Mid). destruct (halves_good three q Gq Lv) as (G0 & G1).
    assert (Gn : Forall (good three) (waiting_next three q rest)).
    { unfold waiting_next. apply Forall_app. split; auto. apply Forall_forall. intros h I.
      apply filter_In in I.
      destruct I as ([<- | [<- | []]] & _); auto. }
    destruct (IH _ found Gn) as (Yes & No). split; auto. intros E. destruct (No E) as (F & A). split; auto.
    destruct (halves_are_parts y q (proj1 Gq)) as (_ & _ & Es & Ee & Em & Em').
    assert (Half : forall h, good three h -> h = left_of q \/ h = right_of q ->
      answers (part_start h) (part_end h) separate).
    { intros h Gh Eh. destruct (any_root three (roots h)) eqn:R.
      - apply A. unfold waiting_next. apply in_or_app. left. apply filter_In. split; auto. simpl.
          intuition auto.
      - now apply (dropped distinct three). }
    intros q' [<- | I].
    + intros t T Z. destruct (Rtotal_order t (over (2 * index q + 1) (level q + 1))) as [L | [-> | L]]; auto.
      * apply (Half (left_of q)); auto. lra.
      * apply (Half (right_of q)); auto. lra.
    + apply A. unfold waiting_next. apply in_or_app. now right.
Qed.

(** ** The decision *)

(** multiple_root: as the root of c0 s + c1 t, if there is one inside. Then distinct_, three_real_roots_ and triple_. *)
Definition linear_of_multiple : option (R * R) * (bool * bool * bool) :=
  let h := hessian y in
  let discriminant := sign_of_real (4 * (c0 h * c2 h) - c1 h * c1 h) in
  let distinct := negb (same_sign discriminant zero) in
  let three := same_sign discriminant positive in
  if distinct then (None, (distinct, three, false))
  else if is_0 (c2 h) then
    let s := 3 * nth 3 y 0 in
    (Some (if below_0 s then (- nth 2 y 0, - s) else (nth 2 y 0, s)), (distinct, three, true))
  else (if below_0 (c1 h) then Some (c1 h, 2 * c2 h) else None, (distinct, three, false)).
(** The answer at the multiple root, distinct_ and three_real_roots_. *)
Definition at_multiple_root : outcome * bool * bool :=
  let '(root, (distinct, three, triple)) := linear_of_multiple in
  let contact := match root with Some (p0, p1) => positive_at p1 (- p0) | None => false end in
  (if contact then collides else if triple then separate else undecided, distinct, three).

(** operator()(), with a number of steps of the loop. *)
Definition interior_contact (steps : nat) : outcome :=
  if is_0 (nth 0 y 0) && positive_at 1 0 then collides
  else if is_0 (nth 3 y 0) && positive_at 0 1 then collides
  else
    let changes := inner_sign_changes y in
    if Nat.eqb (count changes) 0 then separate
    else
      let whole := Part y changes 0 0 in
      if Nat.ltb 1 (count changes) then
        let '(multiple, distinct, three) := at_multiple_root in
        match multiple with
        | undecided => by_halving distinct three steps [whole] separate
        | _ => multiple
        end
      else by_halving true false steps [whole] separate.

Lemma below_0_true a : below_0 a = true <-> a < 0.
Proof. unfold below_0. destruct Rlt_dec; split; easy. Qed.

(** Then the only multiple root of Y inside is the returned one. *)
Lemma linear_of_multiple_right : (1 < count (inner_sign_changes y))%nat ->
  let '(root, (distinct, three, triple)) := linear_of_multiple in
  ~ Forall (eq 0) y /\ (three = true -> 0 < discriminant y) /\ (three = false -> discriminant y <= 0) /\
  (distinct = true -> discriminant y <> 0) /\
  match root with
  | Some (p0, p1) => p0 < 0 < p1 /\ let r := - p0 / (p1 + - p0) in
      at_ y r = 0 /\ (forall t, 0 < t < 1 -> multiple_root y t -> t = r) /\
      (triple = true -> forall t, at_ y t = 0 -> t = r)
  | None => triple = false /\ forall t, 0 < t < 1 -> discriminant y = 0 -> ~ multiple_root y t
  end.
Proof.
  intros N. pose proof y_length as L. unfold linear_of_multiple. fold (discriminant y). set (h := hessian y). cbv zeta.
  pose proof (sign_of_real_right (discriminant y)) as S. pose proof (never_uncertain (discriminant y)) as U.
  assert (Moving : ~ Forall (eq 0) y) by (apply changes_moving; auto; lia).
  destruct (sign_of_real (discriminant y)); try easy; simpl in S; cbn [same_sign negb].
  1, 3: do 4 (split; [first [exact Moving | intros; lra | discriminate] |]); split; [easy | intros; lra].
  destruct (is_0 (c2 h)) eqn:Z2; [| destruct (below_0 (c1 h)) eqn:B1].
  - apply is_0_true in Z2. destruct (triple_root_place y L S Z2 N) as (Neg & Pos).
    assert (Tell : forall p0 p1, p0 < 0 < p1 -> (forall u, at_ y u = 0 <-> u = - p0 / (p1 + - p0)) ->
      p0 < 0 < p1 /\ let r := - p0 / (p1 + - p0) in at_ y r = 0 /\
        (forall t, 0 < t < 1 -> multiple_root y t -> t = r) /\ (true = true -> forall t, at_ y t = 0 -> t = r)).
    { intros p0 p1 P01 Only. split; auto. cbv zeta. split; [now apply Only |].
      split; intros; apply Only; auto. destruct H0 as (a & k & E); rewrite E; unfold double_times, at_; simpl; ring. }
    split; auto. split; [discriminate |]. split; [intros; lra |]. split; [discriminate |].
    destruct (below_0 (3 * nth 3 y 0)) eqn:Bs.
    + apply below_0_true in Bs. destruct (Neg Bs) as (T & Only). apply Tell; [lra |].
      rewrite Ropp_involutive. exact Only.
    + assert (Ps : 0 <= 3 * nth 3 y 0) by (apply Rnot_lt_le; intros K; apply below_0_true in K; congruence).
      destruct (Pos Ps) as (Ps' & T & Only). apply Tell; [lra | exact Only].
  - assert (N2 : c2 h <> 0) by (intros E; apply is_0_true in E; congruence). apply below_0_true in B1.
    destruct (double_root_place y L S N2) as (P2 & Root & Only). fold h in P2, Root, Only.
    split; auto. split; [discriminate |]. split; [intros; lra |]. split; [discriminate |]. split; [lra |]. cbv zeta.
    split; [| split; [| discriminate]].
    + assert (E : form y (2 * c2 h) (- c1 h) =
        (2 * c2 h + - c1 h) ^ 3 * at_ y (- c1 h / (2 * c2 h + - c1 h))).
      { clearbody h. revert L. generalize y. intros w L. four w L. apply cubic_at_ratio. lra. }
      rewrite E in Root. apply Rmult_integral in Root. destruct Root as [Root |]; auto. exfalso.
      revert Root. apply pow_nonzero. lra.
    + intros t T M. now apply Only.
  - assert (N2 : c2 h <> 0) by (intros E; apply is_0_true in E; congruence).
    destruct (double_root_place y L S N2) as (_ & _ & Only). fold h in Only.
    split; auto. split; [discriminate |]. split; [intros; lra |]. split; [discriminate |]. split; auto.
    intros t T _ M. destruct (Only t T M) as (K & _). apply below_0_true in K. congruence.
Qed.
Lemma at_multiple_root_right : (1 < count (inner_sign_changes y))%nat ->
  let '(answer, distinct, three) := at_multiple_root in
  answers 0 1 answer /\ (answer = undecided -> known_roots distinct three).
Proof.
  intros N. pose proof (linear_of_multiple_right N) as M. pose proof y_length as L. unfold at_multiple_root.
  destruct linear_of_multiple as [root [[distinct three] triple]]. destruct M as (Moving & Three & One & Dist & Root).
  set (contact := match root with Some (p0, p1) => positive_at p1 (- p0) | None => false end).
  assert (Inside_somewhere : contact = true -> exists t, 0 <= t <= 1 /\ at_ y t = 0 /\ Inside t).
  { unfold contact. destruct root as [[p0 p1] |]; [| discriminate]. destruct Root as (P01 & Z & _). intros Yes.
    exists (- p0 / (p1 + - p0)). split; [| split; auto; now apply positive_at_right; [lra |]].
    split; [left; apply Rdiv_lt_0_compat; lra |]. apply Rmult_le_reg_r with (p1 + - p0); [lra |]. field_simplify; lra. }
  assert (Not : contact = false -> forall t, 0 < t < 1 -> multiple_root y t -> discriminant y = 0 -> ~ Inside t).
  { unfold contact. destruct root as [[p0 p1] |]; [| intros _ t T M D _; now apply (proj2 Root t T D)].
    destruct Root as (P01 & _ & Only & _). intros No t T M _ I. apply (Only t T) in M. subst t.
    apply positive_at_right in I; [congruence | lra]. }
  destruct contact eqn:Found; [now split; [apply Inside_somewhere |] |]. destruct triple.
  - split; [| discriminate]. destruct root as [[p0 p1] |]; [| now destruct Root].
    destruct Root as (P01 & _ & _ & Only). intros t _ Zt I. apply (Only eq_refl) in Zt. subst t.
    apply positive_at_right in I; [unfold contact in Found; congruence | lra].
  - split; [easy |]. intros _. split; auto. split; auto. intros E.
    destruct (one_real_root y L (One E)) as (l0 & l1 & q & H). exists l0, l1, q. intros t T.
    destruct (H t T) as (A & B' & Z). split; auto. split; auto. intros Zq. destruct (Z Zq) as (M & D).
    split; [now apply Not |]. destruct distinct; auto. now apply Dist in D.
Qed.

(** At some t in [0, 1], Y = 0 and all G_i > 0, as in face_inside and edges_inside. *)
Definition contact_inside : Prop := sometime (fun t => det (B t) (C t) (P t) = 0 /\ Inside t).

Definition zero_throughout : Prop := forall t, 0 <= t <= 1 -> det (B t) (C t) (P t) = 0.

Lemma y_zero : Forall (eq 0) y <-> zero_throughout.
Proof.
  assert (E : Forall (eq 0) y <-> forall t, 0 <= t <= 1 -> at_ y t = 0).
  2: { rewrite E. split; intros H t T; specialize (H t T); [now rewrite <- y_at | now rewrite y_at]. }
  generalize y y_length. intros w L. four w L. split.
  - intros F t _. repeat match goal with H : Forall _ (_ :: _) |- _ => inversion_clear H end. subst.
    unfold at_. simpl. ring.
  - intros H. pose proof (H 0 ltac:(lra)) as H0. pose proof (H 1 ltac:(lra)) as H1.
    pose proof (H (1 / 2) ltac:(lra)) as H2. pose proof (H (1 / 3) ltac:(lra)) as H3.
    unfold at_ in *. simpl in *. repeat constructor; lra.
Qed.

(** Between the ends. *)
Lemma inner_right steps : ~ Forall (eq 0) y -> answers 0 1
  (let changes := inner_sign_changes y in
   if Nat.eqb (count changes) 0 then separate
   else if Nat.ltb 1 (count changes) then
     let '(multiple, distinct, three) := at_multiple_root in
     match multiple with
     | undecided => by_halving distinct three steps [Part y changes 0 0] separate
     | _ => multiple
     end
   else by_halving true false steps [Part y changes 0 0] separate).
Proof.
  intros N. pose proof y_length as L. cbv zeta.
  destruct (Nat.eqb_spec (count (inner_sign_changes y)) 0) as [Z | N0].
  { destruct (no_changes y L Z) as [F | F]; [easy |]. intros t T Zt. now apply F in Zt. }
  assert (Loop : forall distinct three, known_roots distinct three ->
    answers 0 1 (by_halving distinct three steps [Part y (inner_sign_changes y) 0 0] separate)).
  { intros distinct three K. pose proof (whole_is_part y L N) as W.
    destruct (by_halving_right distinct three steps [Part y (inner_sign_changes y) 0 0] separate K) as (Yes
      & No).
    { constructor; [| constructor]. split; auto. split; [easy |]. apply K. }
    destruct (by_halving _ _ _ _ _); [| | easy].
    - destruct (No eq_refl) as (_ & A). specialize (A _ (or_introl eq_refl)).
      unfold part_start, part_end, over in A. cbn [index level] in A.
      replace (IZR 0 / IZR (2 ^ 0)) with 0 in A by (simpl; field).
      replace (IZR (0 + 1) / IZR (2 ^ 0)) with 1 in A by (simpl; field). easy.
    - now destruct (Yes eq_refl). }
  destruct (Nat.ltb_spec 1 (count (inner_sign_changes y))) as [Many | One].
  - pose proof (at_multiple_root_right Many) as M. destruct at_multiple_root as [[multiple distinct] three].
    destruct M as (A & K). destruct multiple; auto.
  - apply Loop. split; [easy |]. split; [discriminate |]. intros _.
    destruct (one_change_crosses y L ltac:(lia)) as (l0 & l1 & q & H). exists l0, l1, q. intros t T.
    destruct (H t T) as (A & B' & F). split; auto. split; auto. intros Z. destruct (F Z).
Qed.

Theorem interior_contact_right steps :
  (interior_contact steps = collides -> contact_inside) /\
  (interior_contact steps = separate -> ~ Inside 0 /\ zero_throughout \/ ~ contact_inside).
Proof.
  unfold interior_contact. pose proof y_length as L.
  assert (Ends : at_ y 0 = nth 0 y 0 /\ at_ y 1 = nth 3 y 0).
  { revert L. generalize y. intros w L. four w L. unfold at_. simpl. split; ring. }
  destruct Ends as (E0 & E1).
  pose proof (positive_at_right 1 0 ltac:(lra)) as I0. replace (0 / (1 + 0)) with 0 in I0 by field.
  pose proof (positive_at_right 0 1 ltac:(lra)) as I1. replace (1 / (0 + 1)) with 1 in I1 by field.
  destruct (is_0 (nth 0 y 0) && positive_at 1 0) eqn:S0.
  { split; [intros _ | discriminate]. apply andb_prop in S0. destruct S0 as (Z & I). apply is_0_true in Z.
    exists 0. split; [lra |]. split; [now rewrite <- y_at, E0 | now apply I0]. }
  destruct (is_0 (nth 3 y 0) && positive_at 0 1) eqn:S1.
  { split; [intros _ | discriminate]. apply andb_prop in S1. destruct S1 as (Z & I). apply is_0_true in Z.
    exists 1. split; [lra |]. split; [now rewrite <- y_at, E1 | now apply I1]. }
  assert (N0 : at_ y 0 = 0 -> ~ Inside 0).
  { rewrite E0. intros Z I. apply is_0_true in Z. apply I0 in I. rewrite Z, I in S0. discriminate. }
  assert (N1 : at_ y 1 = 0 -> ~ Inside 1).
  { rewrite E1. intros Z I. apply is_0_true in Z. apply I1 in I. rewrite Z, I in S1. discriminate. }
  destruct (classic (Forall (eq 0) y)) as [F | F].
  - assert (Z : count (inner_sign_changes y) = 0%nat).
    { destruct (Nat.eq_dec (count (inner_sign_changes y)) 0) as [| K]; auto. exfalso.
      revert F. apply changes_moving; auto. lia. }
    cbv zeta. rewrite Z. cbn [Nat.eqb]. split; [discriminate |]. intros _. left.
    apply y_zero in F. split; auto. apply N0. rewrite y_at. apply F. lra.
  - pose proof (inner_right steps F) as A. cbv zeta in *.
    match goal with |- (?o = collides -> _) /\ _ => set (answer := o) in * end.
    destruct answer; split; try discriminate; intros _.
    + right. intros (t & T & Z & I). rewrite <- y_at in Z.
      destruct (Req_dec t 0) as [-> |]; [now apply N0 |]. destruct (Req_dec t 1) as [-> |]; [now apply N1 |].
      apply (A t); auto. lra.
    + destruct A as (t & T & Z & I). exists t. split; [easy |]. split; [now rewrite <- y_at | easy].
Qed.

(** ** Waiting intervals *)

(** At most three intervals fit in the code's array. *)
Definition waiting_fits (waiting : list part) : Prop :=
  Forall (fun q => 0 < count (roots q))%nat waiting /\
  (list_sum (map (fun q => count (roots q)) waiting) <= 3)%nat.

Lemma three_at_most waiting : waiting_fits waiting -> (length waiting <= 3)%nat.
Proof.
  intros (F & S). enough (length waiting <= list_sum (map (fun q => count (roots q)) waiting))%nat by lia.
  clear S. induction F; simpl; lia.
Qed.
Lemma any_root_count three w : length w = 4%nat -> any_root three (inner_sign_changes w) = true ->
  (0 < count (inner_sign_changes w))%nat.
Proof.
  intros L A. apply orb_prop in A. destruct A as [A | A].
  - now apply (changes_ends w L).
  - apply andb_prop in A. destruct A as (_ & A). now apply Nat.ltb_lt in A.
Qed.

Theorem three_parts_wait three q rest : is_part y q -> waiting_fits (q :: rest) ->
  waiting_fits (waiting_next three q rest) /\ (length (waiting_next three q rest) <= 3)%nat.
Proof.
  intros (L & E & _) (F & S).
  assert (W : waiting_fits (waiting_next three q rest)); [| split; auto; now apply three_at_most].
  inversion_clear F as [| ? ? _ Fr]. cbn in S. rewrite E in S.
  pose proof (halves_changes (part_y q) L). destruct (halves_at (part_y q) 0 L) as (L0 & L1 & _).
  unfold waiting_next. cbn [filter].
  pose proof (any_root_count three _ L0) as C0. pose proof (any_root_count three _ L1) as C1.
  change (roots (left_of q)) with (inner_sign_changes (left_half_of (part_y q))).
  change (roots (right_of q)) with (inner_sign_changes (right_half_of (part_y q))).
  destruct (any_root three (inner_sign_changes (left_half_of (part_y q))));
    destruct (any_root three (inner_sign_changes (right_half_of (part_y q)))); split; cbn; auto; try lia.
  all: repeat constructor; cbn [roots left_of right_of]; auto.
Qed.

(** ** The loop ends *)

Definition work (waiting : list part) : Z := fold_right (fun q sum => 3 ^ (41 - level q) + sum)%Z 0%Z waiting.
Lemma work_positive waiting : (0 <= work waiting)%Z.
Proof. induction waiting as [| q rest IH]; simpl; [lia |]. pose proof (Z.pow_nonneg 3 (41 - level q)). lia.
  Qed.
Lemma next_work three q rest : (level q < max_halvings)%Z -> Forall (fun q => level q <= max_halvings)%Z rest ->
  Forall (fun q => level q <= max_halvings)%Z (waiting_next three q rest) /\
  (work (waiting_next three q rest) < work (q :: rest))%Z.
Proof.
  intros L F. unfold max_halvings in *. split.
  - unfold waiting_next. apply Forall_app. split; auto. apply Forall_forall. intros h I. apply filter_In in I.
    destruct I as ([<- | [<- | []]] & _); cbn [level left_of right_of]; lia.
  - assert (P3 : (0 < 3 ^ (40 - level q))%Z) by (apply Z.pow_pos_nonneg; lia).
    replace (work (q :: rest)) with (3 * 3 ^ (40 - level q) + work rest)%Z
      by (unfold work; cbn [fold_right]; rewrite <- Z.pow_succ_r by lia; do 2 f_equal; ring).
    assert (K : forall h tail, h = left_of q \/ h = right_of q -> work (h :: tail) = (3 ^ (40 - level q) +
      work tail)%Z).
    { intros h tail [-> | ->]; unfold work; cbn [fold_right level left_of right_of]; do 2 f_equal; ring. }
    unfold waiting_next. cbn [filter].
    destruct (any_root three (roots (left_of q))), (any_root three (roots (right_of q)));
      cbn [app]; rewrite ?K by auto; lia.
Qed.
Lemma enough_steps distinct three steps : forall waiting found more,
  Forall (fun q => level q <= max_halvings)%Z waiting -> (work waiting < Z.of_nat steps)%Z -> (steps <=
    more)%nat ->
  by_halving distinct three more waiting found = by_halving distinct three steps waiting found.
Proof.
  induction steps as [| steps IH]; intros waiting found more F W M.
  { pose proof (work_positive waiting). lia. }
  destruct more as [| more]; [lia |]. destruct waiting as [| q rest]; [easy |]. cbn [by_halving].
  inversion_clear F as [| ? ? Fq Fr]. pose proof (Z.pow_pos_nonneg 3 (41 - level q)) as P3.
  assert (Wr : (work (q :: rest) = 3 ^ (41 - level q) + work rest)%Z) by easy. unfold max_halvings in Fq.
  destruct (without_halving distinct three q) as [[ | | ] |] eqn:E; try (apply IH; auto; lia); [easy |].
  assert (N : level q <> max_halvings).
  { intros N. unfold without_halving in E. rewrite N, Z.eqb_refl in E.
    destruct (negb _); [discriminate |]. destruct (if _ && _ then _ else _); discriminate. }
  destruct (next_work three q rest) as (Fn & Wn); auto; [unfold max_halvings in *; lia |].
  apply IH; auto; lia.
Qed.

Theorem interior_contact_ends : exists enough, forall steps, (enough <= steps)%nat ->
  interior_contact steps = interior_contact enough.
Proof.
  set (whole := Part y (inner_sign_changes y) 0 0). set (enough := Datatypes.S (Z.to_nat (work [whole]))).
  assert (E : forall distinct three steps, (enough <= steps)%nat ->
    by_halving distinct three steps [whole] separate = by_halving distinct three enough [whole] separate).
  { intros distinct three steps M. apply enough_steps; auto.
    - repeat constructor. easy.
    - unfold enough. pose proof (work_positive [whole]). lia. }
  exists enough. intros steps M. unfold interior_contact. cbv zeta. fold whole.
  destruct at_multiple_root as [[multiple distinct] three].
  now rewrite (E distinct three steps M), (E true false steps M).
Qed.

End Query.

(** ** Queries *)

Notation integer_motion := (@moving_point integers).
(** decide_converted of ccd/exact/integer_decision.hpp: the given points m, and their integers q. *)
Definition vertex_edge_queries {A : Type} (edges : bool) (q0 q1 q2 q3 : A) : list (A * A * A) :=
  if edges then let a0 := q0 in let a1 := q1 in let b0 := q2 in let b1 := q3 in
    [(a0, b0, b1); (a1, b0, b1); (b0, a0, a1); (b1, a0, a1)]
  else let v := q0 in let f0 := q1 in let f1 := q2 in let f2 := q3 in
    [(v, f0, f1); (v, f1, f2); (v, f2, f0)].
Definition edge_contact (query : moving * moving * moving * (integer_motion * integer_motion * integer_motion)) :
    bool :=
  let '(original_v, original_e0, original_e1, (v, e0, e1)) := query in
  negb (separated original_v original_e0 original_e1) && contact (exact_motion v) (exact_motion e0) (exact_motion e1).
Definition contact_of (edges : bool) (extent_x extent_y extent_z : Z)
    (estimate : part -> Z) (refine : Z -> part -> Z -> Z -> Z -> Z) (steps : nat)
    (m0 m1 m2 m3 : moving) (q0 q1 q2 q3 : integer_motion) : outcome :=
  let b := side_b edges difference q0 q1 q2 q3 in
  let c := side_c edges difference q0 q1 q2 q3 in
  let p := side_p edges difference q0 q1 q2 q3 in
  if certainly_rootless (y_form b c p) then separate
  else if existsb edge_contact
      (combine (vertex_edge_queries edges m0 m1 m2 m3) (vertex_edge_queries edges q0 q1 q2 q3)) then collides
  else interior_contact edges b c p extent_x extent_y extent_z estimate refine steps.

Section Decisions.

Context (unit : point) (U : units unit) (extent_x extent_y extent_z : Z) (estimate : part -> Z)
  (refine : Z -> part -> Z -> Z -> Z -> Z) (steps : nat).
Let decide edges := contact_of edges extent_x extent_y extent_z estimate refine steps.

Theorem vertex_edge_decision_right m0 m1 m2 v e0 e1 : in_integers unit m0 v -> in_integers unit m1 e0 ->
  in_integers unit m2 e1 -> edge_contact (m0, m1, m2, (v, e0, e1)) = true <-> vertex_edge_collides m0 m1 m2.
Proof.
  unfold in_integers, edge_contact. intros -> -> ->.
  rewrite andb_true_iff, negb_true_iff, contact_right, (vertex_edge_units unit) by easy.
  split; [tauto |]. intros H. split; auto. destruct (separated m0 m1 m2) eqn:P; auto. now apply separated_right in P.
Qed.
Lemma queries_contact edges m0 m1 m2 m3 q0 q1 q2 q3 : in_integers unit m0 q0 -> in_integers unit m1 q1 ->
  in_integers unit m2 q2 -> in_integers unit m3 q3 ->
  existsb edge_contact (combine (vertex_edge_queries edges m0 m1 m2 m3) (vertex_edge_queries edges q0 q1 q2 q3)) = true
  <-> query_border edges m0 m1 m2 m3.
Proof.
  intros. unfold query_border, edges_border_collides, face_border_collides.
  destruct edges; cbn [vertex_edge_queries combine existsb];
    rewrite !orb_true_iff, !vertex_edge_decision_right by easy; intuition discriminate.
Qed.

(** Without contact at a border. *)
Lemma query_contact_inside edges (q0 q1 q2 q3 : integer_motion) :
  ~ query_border edges (exact_motion q0) (exact_motion q1) (exact_motion q2) (exact_motion q3) ->
  contact_inside edges (side_b edges difference q0 q1 q2 q3) (side_c edges difference q0 q1 q2 q3)
    (side_p edges difference q0 q1 q2 q3) <->
  query_collides edges (exact_motion q0) (exact_motion q1) (exact_motion q2) (exact_motion q3).
Proof.
  intros N. rewrite query_inside by easy. apply sometime_same. intros t.
  destruct (query_sides_at edges q0 q1 q2 q3 t) as (Eb & Ec & Ep). now rewrite Eb, Ec, Ep, query_inside_same.
Qed.

Lemma query_decision_right edges m0 m1 m2 m3 q0 q1 q2 q3 : in_integers unit m0 q0 -> in_integers unit m1 q1 ->
  in_integers unit m2 q2 -> in_integers unit m3 q3 -> let found := decide edges m0 m1 m2 m3 q0 q1 q2 q3 in
  (found = collides -> query_collides edges m0 m1 m2 m3) /\ (found = separate -> ~ query_collides edges m0 m1 m2 m3).
Proof.
  intros I0 I1 I2 I3. cbv zeta. pose proof (queries_contact edges m0 m1 m2 m3 q0 q1 q2 q3 I0 I1 I2 I3) as Border.
  rewrite <- (query_border_units unit) in Border by easy. rewrite <- (query_units unit) by easy.
  unfold in_integers in *. rewrite <- I0, <- I1, <- I2, <- I3 in *.
  unfold decide, contact_of. cbv zeta. destruct (query_degrees edges q0 q1 q2 q3) as (Db & Dc & Dp).
  destruct (certainly_rootless _) eqn:R.
  { split; [discriminate |]. intros _. now apply (query_rootless_separate edges q0 q1 q2 q3). }
  destruct (existsb _ _).
  { split; [intros _ | discriminate]. now apply query_border_collision, Border. }
  assert (N : ~ query_border edges (exact_motion q0) (exact_motion q1) (exact_motion q2) (exact_motion q3)).
  { intros H. now apply Border in H. }
  destruct (interior_contact_right edges _ _ _ Db Dc Dp extent_x extent_y extent_z estimate refine steps) as
    (Yes & No).
  pose proof (query_contact_inside edges q0 q1 q2 q3 N) as E.
  split; intros O; [now apply E, Yes |]. destruct (No O) as [(I & Z) | I]; [| now rewrite <- E].
  intros H. apply query_coplanar in H.
  - destruct H as [H | H]; [| easy]. apply I. destruct (query_sides_at edges q0 q1 q2 q3 0) as (-> & -> & ->).
    now apply query_inside_same.
  - intros t T. specialize (Z t T). cbv beta in Z. destruct (query_sides_at edges q0 q1 q2 q3 t) as (Eb & Ec & Ep).
    now rewrite Eb, Ec, Ep in Z.
Qed.
Theorem face_decision_right m0 m1 m2 m3 v f0 f1 f2 : in_integers unit m0 v -> in_integers unit m1 f0 ->
  in_integers unit m2 f1 -> in_integers unit m3 f2 -> let found := decide false m0 m1 m2 m3 v f0 f1 f2 in
  (found = collides -> vertex_face_collides m0 m1 m2 m3) /\ (found = separate -> ~ vertex_face_collides m0 m1 m2 m3).
Proof. exact (query_decision_right false m0 m1 m2 m3 v f0 f1 f2). Qed.
Theorem edges_decision_right m0 m1 m2 m3 a0 a1 b0 b1 : in_integers unit m0 a0 -> in_integers unit m1 a1 ->
  in_integers unit m2 b0 -> in_integers unit m3 b1 -> let found := decide true m0 m1 m2 m3 a0 a1 b0 b1 in
  (found = collides -> edge_edge_collides m0 m1 m2 m3) /\ (found = separate -> ~ edge_edge_collides m0 m1 m2 m3).
Proof. exact (query_decision_right true m0 m1 m2 m3 a0 a1 b0 b1). Qed.

End Decisions.
