(** Bound rule `sharp` (include/errbound/rules/sharp.hpp): TightBound with u in place of eps, as the C++ code
    computes it. Rounding is to nearest, ties to even, from 3 bits on, with u a number (emin <= -p).

    A number x has a value a and a bound sa, |a - x| <= sa. Results:
        sharp_add_sound, sharp_subtract_sound, sharp_multiply_sound, sharp_divide_sound, sharp_scale_sound *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format.
From Errbound Require Tight Upper.
Open Scope R_scope.

Section Sharp.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.

Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation u := (u p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).
Notation is_zero := Tight.is_zero.

(** The code, in its order of evaluation. *)
Definition rounding (v : R) : R := fl (Rabs v * u).
Definition inflated (bound : R) : R := fl (bound * fl (1 + fl (4 * eps))).

Definition sharp_enlarged (v sa sb : R) : R :=
  fl (fl (rounding v + fl (sa + sb)) * fl (1 + fl (2 * eps))).
Definition sharp_add (v sa sb : R) : R :=
  Upper.sum_of_bounds p emin nearest (sharp_enlarged v sa sb) (rounding v) sa sb.
Definition sharp_multiply (v a sa b sb : R) : R :=
  if is_zero a sa || is_zero b sb then rounding v
  else
    let inherited := fl (fl (Rabs a * sb) + fl (sa * fl (Rabs b + sb))) in
    inflated (fl (fl (rounding v + fl (2 * eta)) + inherited)).
(** None: the result is unknown (the bound is infinite). *)
Definition sharp_divide (v a sa b sb : R) : option R :=
  let distance := fl (Rabs b - sb) in
  if negb (Rlt_bool 0 distance) then None
  else if is_zero a sa then Some (rounding v)
  else
    let quotient := inflated (fl (Rabs v + eta)) in
    let lost := if Rlt_bool 0 sb then eta else 0 in
    let inherited := fl (fl (sa + fl (fl (quotient * sb) + lost)) / distance) in
    Some (inflated (fl (fl (rounding v + fl (2 * eta)) + inflated inherited))).

Definition sharp_scale (v a sa : R) (e : Z) : R :=
  scaled_error p emin nearest (fun scaled => inflated (fl (scaled + eta))) v a sa e.

Context (p_3 : (3 <= p)%Z) (emin_p : (emin <= - p)%Z).

Let an_error := rounding_error_nearest p emin ltac:(lia).
Let rnd_exact := Format.rnd_exact p emin nearest.
Let rnd_number := Format.rnd_number p emin nearest.
Let rnd_above := Format.rnd_above p emin nearest.
Let rnd_below := Format.rnd_below p emin nearest.
Let rnd_nonnegative := Format.rnd_nonnegative p emin nearest.
Let rnd_0 := Format.rnd_0 p emin nearest.
Let rnd_subnormal := Format.rnd_subnormal p emin nearest.
Let sum_subnormal := Format.sum_subnormal p emin nearest.
Let scaled_up := Format.scaled_up p emin nearest.
Let rnd_absolute := Format.rnd_absolute p emin nearest _ _ an_error.
Let sum_error := Format.sum_error p emin nearest _ _ an_error.

Lemma u_8 : 0 < u <= / 8.
Proof. generalize (u_positive p) (eps_le p 3 p_3) (eps_2u p). simpl. lra. Qed.

(** A rounding leaves at least q = 1/(1 + u) of a sum or a normal number. *)
Let q := / (1 + u).
Let f := 1 + 8 * u.
Lemma q_u : q * (1 + u) = 1.
Proof. unfold q. apply Rinv_l. generalize u_8. lra. Qed.
Lemma q_1 : 0 < q <= 1.
Proof. generalize u_8 q_u. intros. split; [apply Rinv_0_lt_compat; lra | nra]. Qed.
Lemma f_2 : 1 <= f <= 2.
Proof. unfold f. generalize u_8. lra. Qed.

Lemma leaves x : smallest_normal <= Rabs x -> Rabs x * q <= Rabs (fl x).
Proof.
  intros C. generalize q_u q_1 (nearest_relative_to_result p emin x C) (Rabs_triang_inv x (fl x)). intros U Q B T.
  unfold rnd_nearest in B. rewrite Rabs_minus_sym in B.
  apply Rle_trans with ((1 + u) * Rabs (fl x) * q); [apply Rmult_le_compat_r; lra |].
  replace ((1 + u) * Rabs (fl x) * q) with (Rabs (fl x) * (q * (1 + u))) by ring. rewrite U. lra.
Qed.
Let leaves_small := proj2 (leaves_of_error p emin nearest _ _ an_error).
Let h_eta := error_h p emin nearest _ _ an_error.
Lemma normal_relative x : smallest_normal <= x -> x * q <= fl x.
Proof. apply (normal_left p emin nearest q leaves). Qed.
Lemma sum_relative x y : number x -> number y -> 0 <= x + y -> (x + y) * q <= fl (x + y).
Proof. apply (sum_left p emin nearest q q_1 leaves). Qed.
Let rnd_lower := any_left p emin nearest q (eta / 2) q_1 h_eta leaves leaves_small.
Let scaled_relative := scaled_left p emin nearest q leaves.
Let sum_of_three := sum_of_three p emin nearest q q_1 leaves.

(** The factors cover three and five roundings. *)
Lemma three_roundings : 1 <= (1 + 4 * u) * (q * q * q).
Proof.
  generalize u_8 q_u q_1. intros U Q Q1.
  assert (A : (1 + u) * (1 + u) * (1 + u) <= 1 + 4 * u) by nra.
  apply Rle_trans with ((1 + u) * (1 + u) * (1 + u) * (q * q * q)).
  - right. replace ((1 + u) * (1 + u) * (1 + u) * (q * q * q))
      with (q * (1 + u) * (q * (1 + u)) * (q * (1 + u))) by ring. rewrite Q. ring.
  - apply Rmult_le_compat_r; auto. repeat apply Rmult_le_pos; lra.
Qed.
Lemma f_q5 : 1 <= f * (q * q * q * q * q).
Proof.
  generalize u_8 q_u q_1. intros U Q Q1.
  assert (A : (1 + u) * (1 + u) * (1 + u) * (1 + u) * (1 + u) <= f) by (unfold f; nra).
  apply Rle_trans with ((1 + u) * (1 + u) * (1 + u) * (1 + u) * (1 + u) * (q * q * q * q * q)).
  - right. replace ((1 + u) * (1 + u) * (1 + u) * (1 + u) * (1 + u) * (q * q * q * q * q))
      with (q * (1 + u) * (q * (1 + u)) * (q * (1 + u)) * (q * (1 + u)) * (q * (1 + u))) by ring.
    rewrite Q. ring.
  - apply Rmult_le_compat_r; auto. repeat apply Rmult_le_pos; lra.
Qed.
Lemma f_q4 : 1 <= f * (q * q * q * q).
Proof. generalize f_2. intros. apply (fewer_roundings f q); [lra | apply q_1 | exact f_q5]. Qed.
Lemma f_q3 : 1 <= f * (q * q * q).
Proof. generalize f_2. intros. apply (fewer_roundings f q); [lra | apply q_1 | exact f_q4]. Qed.

(** These are numbers of the format. *)
Lemma u_power k : bpow radix2 k * u = bpow radix2 (k - p).
Proof. unfold Format.u. rewrite <- bpow_plus. f_equal. Qed.
Lemma add_factor : fl (1 + fl (2 * eps)) = 1 + 4 * u.
Proof.
  replace (2 * eps) with (bpow radix2 (2 - p)).
  - rewrite (rnd_exact (bpow radix2 (2 - p))) by (apply number_power; auto; lia).
    rewrite (rnd_exact (1 + bpow radix2 (2 - p))) by (apply number_1_power; auto; lia).
    rewrite <- u_power. reflexivity.
  - rewrite eps_2u, <- u_power. change (bpow radix2 2) with 4. ring.
Qed.
Lemma inflated_exact x : inflated x = fl (x * f).
Proof.
  unfold inflated. replace (4 * eps) with (bpow radix2 (3 - p)).
  - rewrite (rnd_exact (bpow radix2 (3 - p))) by (apply number_power; auto; lia).
    rewrite (rnd_exact (1 + bpow radix2 (3 - p))) by (apply number_1_power; auto; lia).
    unfold f. rewrite <- u_power. reflexivity.
  - rewrite eps_2u, <- u_power. change (bpow radix2 3) with 8. ring.
Qed.
Lemma number_2_eta : number (2 * eta).
Proof. exact (number_eta_times p emin 1 ltac:(lia)). Qed.

(** The rule's rounding term is at least the error of its operation. *)
Lemma rounding_nonnegative v : 0 <= rounding v.
Proof. apply rnd_nonnegative. generalize u_8 (Rabs_pos v). nra. Qed.
Lemma rounding_large s : bpow radix2 (p + emin) <= Rabs (fl s) ->
  Rabs (fl s - s) <= rounding (fl s).
Proof. apply (error_of_large p emin). Qed.
Lemma rounding_sum x y :
  number x -> number y -> Rabs (fl (x + y) - (x + y)) <= rounding (fl (x + y)).
Proof.
  intros X Y. destruct (Rle_or_lt (Rabs (x + y)) (bpow radix2 (p + emin))) as [C | C].
  - rewrite (rnd_exact (x + y)) at 1 by now apply sum_exact.
    replace (x + y - (x + y)) with 0 by ring. rewrite Rabs_R0. apply rounding_nonnegative.
  - apply rounding_large. apply (rnd_abs_above p emin nearest); [apply number_power; auto; lia | lra].
Qed.
Lemma rounding_any s : Rabs (fl s - s) <= rounding (fl s) + eta / 2.
Proof.
  generalize (rounding_nonnegative (fl s)) (eta_positive emin). intros.
  destruct (Rle_or_lt (bpow radix2 (p + emin)) (Rabs (fl s))) as [C | C].
  - generalize (rounding_large s C). lra.
  - generalize (error_of_small p emin s C). lra.
Qed.
Lemma rounding_0 : rounding (fl 0) = 0.
Proof. unfold rounding. rewrite rnd_0, Rabs_R0, Rmult_0_l. apply rnd_0. Qed.

(** The error of a sum, and the first of its two bounds. *)
Lemma sharp_sum_error a x sa b y sb :
  number a -> number b -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= rounding (fl (a + b)) + (sa + sb).
Proof. intros. apply Tight.within_through with (a + b); [now apply rounding_sum | now apply Tight.within_sum]. Qed.
Lemma sharp_difference_error a x sa b y sb :
  number a -> number b -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a - b) - (x - y)) <= rounding (fl (a - b)) + (sa + sb).
Proof. intros. apply sharp_sum_error; auto using number_opp, Tight.within_opp. Qed.
Lemma sharp_enlarged_sound v sa sb : number sa -> number sb -> 0 <= sa -> 0 <= sb ->
  rounding v + (sa + sb) <= sharp_enlarged v sa sb.
Proof.
  intros. generalize u_8. intros. unfold sharp_enlarged. rewrite add_factor,
    (Rplus_comm (rounding v) (sa + sb)), (Rplus_comm (rounding v) (fl (sa + sb))).
  apply sum_of_three; auto using rounding_nonnegative, three_roundings; try lra.
  apply rnd_number.
Qed.
Theorem sharp_add_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= sharp_add (fl (a + b)) sa sb.
Proof.
  intros A B SA SB HA HB.
  assert (PA : 0 <= sa) by (generalize (Rabs_pos (a - x)); lra).
  assert (PB : 0 <= sb) by (generalize (Rabs_pos (b - y)); lra).
  assert (H := sharp_sum_error a x sa b y sb A B HA HB).
  apply Upper.sum_of_bounds_sound; auto using rounding_nonnegative with typeclass_instances; try lia; [apply rnd_number |].
  apply Rle_trans with (1 := H). now apply sharp_enlarged_sound.
Qed.

Theorem sharp_subtract_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a - b) - (x - y)) <= sharp_add (fl (a - b)) sa sb.
Proof. intros. apply sharp_add_sound; auto using number_opp, Tight.within_opp. Qed.

Theorem sharp_multiply_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a * b) - x * y) <= sharp_multiply (fl (a * b)) a sa b sb.
Proof.
  intros A B SA SB HA HB.
  assert (PA : 0 <= sa) by (generalize (Rabs_pos (a - x)); lra).
  assert (PB : 0 <= sb) by (generalize (Rabs_pos (b - y)); lra).
  unfold sharp_multiply. cbv zeta.
  destruct (is_zero a sa || is_zero b sb) eqn:Zero.
  { destruct (Tight.product_with_zero a x sa b y sb HA HB Zero) as [-> ->].
    rewrite rounding_0, rnd_0, Rminus_0_r, Rabs_R0. lra. }
  rewrite (rnd_exact (2 * eta) number_2_eta), inflated_exact.
  set (v := fl (a * b)). set (R := rounding v). generalize (eta_positive emin) f_2 q_1 q_u u_8; intros.
  destruct (product_inherited p emin nearest q (eta / 2) q_1 h_eta leaves leaves_small
    (Rabs a) (Rabs b) sa sb (eta / 2)) as (PI & Small & Large); auto using Rabs_pos.
  { now apply number_abs. }
  { intros z w Pz Zw C. apply Rle_trans with (z * q * (1 + u) - eta / 2); [right; rewrite Rmult_assoc, q_u; ring |].
    assert (z * q * (1 + u) <= w * (1 + u)) by (apply Rmult_le_compat_r; lra).
    assert (w * u <= smallest_normal * u) by (apply Rmult_le_compat_r; lra).
    generalize (smallest_normal_eps p emin). rewrite eps_2u. lra. }
  revert PI Small Large. set (I := fl (fl (Rabs a * sb) + fl (sa * fl (Rabs b + sb)))).
  set (X := Rabs a * sb + sa * (Rabs b + sb)). intros PI Small Large.
  assert (NR : number R) by apply rnd_number. assert (PR : 0 <= R) by apply rounding_nonnegative.
  assert (NI : number I) by apply rnd_number.
  assert (PX : 0 <= X) by (generalize (Rabs_pos a) (Rabs_pos b); intros; unfold X; nra).
  (* the exact bound *)
  apply Rle_trans with (R + eta / 2 + X).
  { apply Tight.within_through with (a * b); [apply rounding_any | now apply Tight.product_inherits]. }
  set (J := fl (R + 2 * eta)). set (S := fl (J + I)).
  assert (NJ : number J) by apply rnd_number. assert (PJ : 0 <= J) by (apply rnd_nonnegative; lra).
  assert (NS : number S) by apply rnd_number. assert (LJ : J <= S) by (apply rnd_above; auto; lra).
  destruct (Rlt_or_le S smallest_normal) as [C | C].
  - (* all sums are exact; the products lose at most 2 eta *)
    apply Rle_trans with S; [| apply scaled_up; auto; lra].
    assert (EJ : J = R + 2 * eta) by (apply (sum_subnormal R (2 * eta)); auto using number_2_eta; [lra | fold J; lra]).
    assert (ES : S = J + I) by (apply (sum_subnormal J I); auto).
    specialize (Small ltac:(lra)). lra.
  - (* five roundings at most *)
    apply Rle_trans with (2 := scaled_relative S f C ltac:(lra)).
    generalize (sum_relative R (2 * eta) NR number_2_eta ltac:(lra)). fold J. intros D4.
    generalize (sum_relative J I NJ NI ltac:(lra)). fold S. intros D5.
    assert (G : (R + X) * (q * q * q * q) + eta * (q * q) <= S).
    { apply Rle_trans with (2 := D5).
      apply Rle_trans with (((R + 2 * eta) * q + (X * (q * q) - 2 * (eta / 2)) * q) * q).
      - assert (Q2 : 0 <= q * q <= 1) by nra.
        assert (R * (q * q * q * q) <= R * (q * q)).
        { apply Rmult_le_compat_l; auto. replace (q * q * q * q) with (q * q * (q * q)) by ring. nra. }
        lra.
      - apply Rmult_le_compat_r; [lra |]. now apply Rplus_le_compat. }
    generalize f_q5 f_q3; intros.
    apply Rle_trans with (((R + X) * (q * q * q * q) + eta * (q * q)) * (f * q)).
    + nra.
    + apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra.
Qed.

(** The code's bound of |a/b|. *)
Lemma quotient_covered s : Rabs s <= inflated (fl (Rabs (fl s) + eta)).
Proof.
  rewrite inflated_exact. apply (covered_by_rounded p emin nearest q (eta / 2) q_1 h_eta leaves leaves_small).
  - apply f_2.
  - apply f_q3.
Qed.

Theorem sharp_divide_sound a x sa b y sb bound :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  sharp_divide (fl (a / b)) a sa b sb = Some bound ->
  y <> 0 /\ Rabs (fl (a / b) - x / y) <= bound.
Proof.
  intros A B SA SB HA HB HT.
  assert (PA : 0 <= sa) by (generalize (Rabs_pos (a - x)); lra).
  assert (PB : 0 <= sb) by (generalize (Rabs_pos (b - y)); lra).
  generalize (eta_positive emin) f_2 q_1 q_u u_8; intros.
  revert HT. unfold sharp_divide. cbv zeta. set (d := fl (Rabs b - sb)). set (D := Rabs b - sb).
  destruct (Rlt_bool_spec 0 d) as [Pd | Pd]; simpl; [| discriminate].
  assert (PD : 0 < D).
  { apply Rnot_le_lt. intros C. apply (rnd_below _ 0) in C; auto using number_0.
    change (fl D) with d in C. lra. }
  assert (Y : y <> 0).
  { intros ->. unfold D in PD. rewrite Rminus_0_r in HB. lra. }
  assert (dD : d <= D * (1 + u)).
  { generalize (sum_error (Rabs b) (- sb) ltac:(now apply number_abs) ltac:(now apply number_opp)).
    change (Rabs b + - sb) with D. change (fl D) with d. rewrite (Rabs_pos_eq D) by lra.
    intros G. apply Rabs_le_inv in G. lra. }
  destruct (is_zero a sa) eqn:Zero.
  { (* an exact zero *)
    intros G. injection G as <-. apply Tight.is_zero_true in Zero. destruct Zero as [Z1 Z2].
    rewrite Z2 in HA. apply Tight.within_0 in HA. rewrite <- HA, Z1. unfold Rdiv.
    rewrite !Rmult_0_l, rounding_0, rnd_0, Rminus_0_r, Rabs_R0. split; auto. lra. }
  rewrite (rnd_exact (2 * eta) number_2_eta).
  set (v := fl (a / b)). set (R := rounding v). set (k := inflated (fl (Rabs v + eta))).
  set (lost := if Rlt_bool 0 sb then eta else 0).
  set (N := fl (sa + fl (fl (k * sb) + lost))). set (I := fl (N / d)).
  set (Z := (sa + Rabs (a / b) * sb) / D).
  intros G. injection G as <-. split; auto.
  generalize (Rabs_pos (a / b)); intros.
  assert (PQ : 0 <= Rabs (a / b) * sb) by (apply Rmult_le_pos; lra).
  assert (PZ : 0 <= Z).
  { apply Rmult_le_pos; [lra |]. now apply Rlt_le, Rinv_0_lt_compat. }
  assert (HK : Rabs (a / b) <= k) by apply quotient_covered.
  assert (Pq3 : 0 <= q * q * q) by (repeat apply Rmult_le_pos; lra).
  (* the numerator *)
  assert (HN : (sa + Rabs (a / b) * sb) * (q * q * q) <= N).
  { assert (Q2 : 0 <= q * q <= 1) by nra. assert (Q3 : q * q * q <= 1) by nra.
    unfold N, lost. destruct (Rlt_bool_spec 0 sb) as [S | S].
    - assert (Pk : 0 <= k * sb) by (apply Rmult_le_pos; lra).
      assert (PP : 0 <= fl (k * sb)) by now apply rnd_nonnegative.
      generalize (rnd_lower (k * sb) Pk). intros D1.
      generalize (sum_relative (fl (k * sb)) eta (rnd_number _) (number_eta p emin) ltac:(lra)).
      set (M := fl (fl (k * sb) + eta)). intros D2.
      assert (PM : 0 <= M) by (apply rnd_nonnegative; lra).
      generalize (sum_relative sa M SA (rnd_number _) ltac:(lra)). intros D3.
      apply Rle_trans with (2 := D3).
      assert (D4 : Rabs (a / b) * sb * q <= k * sb * q).
      { apply Rmult_le_compat_r; [lra |]. apply Rmult_le_compat_r; lra. }
      assert (D5 : Rabs (a / b) * sb * q * q <= M).
      { apply Rle_trans with (2 := D2). apply Rmult_le_compat_r; lra. }
      replace ((sa + Rabs (a / b) * sb) * (q * q * q))
        with ((sa * (q * q) + Rabs (a / b) * sb * q * q) * q) by ring.
      apply Rmult_le_compat_r; [lra |].
      assert (sa * (q * q) <= sa * 1) by (apply Rmult_le_compat_l; lra). lra.
    - assert (E0 : sb = 0) by lra. rewrite E0, !Rmult_0_r, !Rplus_0_r.
      rewrite rnd_0, rnd_0, !Rplus_0_r, (rnd_exact sa SA).
      assert (sa * (q * q * q) <= sa * 1) by (apply Rmult_le_compat_l; lra). lra. }
  assert (PN : 0 <= N).
  { apply Rle_trans with (2 := HN). apply Rmult_le_pos; lra. }
  (* and the quotient by the distance *)
  assert (HI : Z * (q * q * q * q) <= N / d).
  { apply Rle_trans with ((sa + Rabs (a / b) * sb) * (q * q * q) / (D * (1 + u))).
    - right. unfold Z, q. field. lra.
    - apply Rmult_le_compat; auto.
      + apply Rmult_le_pos; lra.
      + apply Rlt_le, Rinv_0_lt_compat. apply Rmult_lt_0_compat; lra.
      + apply Rinv_le; auto. }
  assert (PI : 0 <= N / d).
  { apply Rmult_le_pos; auto. now apply Rlt_le, Rinv_0_lt_compat. }
  assert (NI : number I) by apply rnd_number.
  assert (PIr : 0 <= I) by now apply rnd_nonnegative.
  assert (NR : number R) by apply rnd_number.
  assert (PR : 0 <= R) by apply rounding_nonnegative.
  assert (Pq4 : 0 <= q * q * q * q) by (apply Rmult_le_pos; lra).
  (* the exact bound *)
  apply Rle_trans with (R + eta / 2 + Z).
  { apply Tight.within_through with (a / b); [apply rounding_any | now apply Tight.quotient_inherits]. }
  generalize f_q5 f_q4 f_q3; intros F5 F4 F3.
  set (J := inflated I).
  assert (NJ : number J) by apply rnd_number.
  assert (PJ : 0 <= J).
  { unfold J. rewrite inflated_exact. apply rnd_nonnegative. apply Rmult_le_pos; lra. }
  destruct (quotient_inflated p emin nearest q (eta / 2) q_1 h_eta leaves leaves_small Z (N / d) f PZ (proj1 f_2) F5
    HI PI)
    as (Below & Above). rewrite <- inflated_exact in Below, Above. fold I J in Below, Above.
  destruct (Rlt_or_le I smallest_normal) as [C | C].
  - (* 2 eta covers underflows inside *)
    specialize (Below C).
    rewrite inflated_exact.
    apply Rle_trans with (R + 2 * eta + J).
    + assert (eta / 2 * (1 + f) <= eta / 2 * 3) by (apply Rmult_le_compat_l; lra). lra.
    + apply sum_of_three; auto using number_2_eta; lra.
  - (* eight roundings at most, and two factors *)
    specialize (Above C). assert (Pfq : 0 <= f * q) by (apply Rmult_le_pos; lra).
    assert (CJ : smallest_normal <= J).
    { apply Rle_trans with (1 := C). unfold J. rewrite inflated_exact. apply scaled_up; auto. lra. }
    rewrite inflated_exact. set (L := fl (R + 2 * eta)). set (S := fl (L + J)).
    assert (NL : number L) by apply rnd_number.
    assert (PL : 0 <= L) by (apply rnd_nonnegative; lra).
    assert (CS : smallest_normal <= S).
    { apply Rle_trans with (1 := CJ). apply rnd_above; auto. lra. }
    apply Rle_trans with (2 := scaled_relative S f CS ltac:(lra)).
    generalize (sum_relative R (2 * eta) NR number_2_eta ltac:(lra)). fold L. intros D4.
    generalize (sum_relative L J NL NJ ltac:(lra)). fold S. intros D5.
    apply Rle_trans with (((R + 2 * eta) * q + Z * (q * q * q * q) * q * (f * q)) * q * (f * q)).
    + replace (((R + 2 * eta) * q + Z * (q * q * q * q) * q * (f * q)) * q * (f * q))
        with ((R + 2 * eta) * (f * (q * q * q)) +
              Z * (f * (q * q * q * q) * (f * (q * q * q * q)))) by ring.
      assert ((R + 2 * eta) * 1 <= (R + 2 * eta) * (f * (q * q * q))) by
        (apply Rmult_le_compat_l; lra).
      assert (1 <= f * (q * q * q * q) * (f * (q * q * q * q))) by nra.
      assert (Z * 1 <= Z * (f * (q * q * q * q) * (f * (q * q * q * q)))) by
        (apply Rmult_le_compat_l; lra).
      lra.
    + apply Rmult_le_compat_r; auto. apply Rle_trans with (2 := D5).
      apply Rmult_le_compat_r; lra.
Qed.

Theorem sharp_scale_sound a x sa e :
  number a -> number sa -> Rabs (a - x) <= sa ->
  Rabs (fl (a * bpow radix2 e) - x * bpow radix2 e) <= sharp_scale (fl (a * bpow radix2 e)) a sa e.
Proof.
  apply (scaled_error_sound p emin nearest _ _ an_error). intros s S P. generalize (eta_positive emin) f_2. intros.
  rewrite inflated_exact. rewrite <- (rnd_exact (fl (s + eta))) by apply rnd_number.
  rewrite <- (Rplus_0_r (fl (s + eta))). apply Rle_trans with (s + eta + 0); [lra |].
  apply sum_of_three; auto using number_eta, number_0, f_q3; lra.
Qed.

End Sharp.
