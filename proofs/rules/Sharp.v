(** Bound rule `sharp` (include/errbound/rules/sharp.hpp): TightBound with u in place of eps, as the C++ code
    computes it. Rounding is to nearest, ties to even, from 3 bits on, with u a number (emin <= -p).

    A number x has a value a and a bound sa, |a - x| <= sa. Results:
        sharp_add_sound, sharp_subtract_sound, sharp_multiply_sound, sharp_divide_sound, sharp_scale_sound *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format.
From Errbound Require AbsoluteBound Upper.
Open Scope R_scope.

Section Sharp.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.

Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation u := (u p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).

(** The code, in its order of evaluation; `multiply` and `divide` are those of AbsoluteBound.v. *)
Definition rounding (v : R) : R := fl (Rabs v * u).
Definition inflated (bound : R) : R := fl (bound * fl (1 + fl (4 * eps))).

Definition sharp_enlarged (v sa sb : R) : R :=
  fl (fl (rounding v + fl (sa + sb)) * fl (1 + fl (2 * eps))).
Definition sharp_add (v sa sb : R) : R :=
  Upper.sum_of_bounds p emin nearest (sharp_enlarged v sa sb) (rounding v) sa sb.
Definition sharp_multiply (v a sa b sb : R) : R :=
  AbsoluteBound.multiply p emin nearest rounding inflated true (fl (2 * eta)) v a sa b sb.
(** None: the result is unknown (the bound is infinite). *)
Definition sharp_divide (v a sa b sb : R) : option R :=
  AbsoluteBound.divide p emin nearest rounding inflated true (fl (2 * eta)) eta v a sa b sb.
Definition sharp_scale (v a sa : R) (e : Z) : R :=
  scaled_error p emin nearest (fun scaled => inflated (fl (scaled + eta))) v a sa e.

Context (p_3 : (3 <= p)%Z) (emin_p : (emin <= - p)%Z).

Let error := rounding_error_nearest p emin ltac:(lia).
Let rnd_exact := Format.rnd_exact p emin nearest.
Let rnd_number := Format.rnd_number p emin nearest.
Let rnd_nonnegative := Format.rnd_nonnegative p emin nearest.
Let rnd_0 := Format.rnd_0 p emin nearest.

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
Lemma normal_left x : smallest_normal <= Rabs x -> Rabs x * q <= Rabs (fl x).
Proof.
  intros C. generalize q_u q_1 (nearest_relative_to_result p emin x C) (Rabs_triang_inv x (fl x)). intros U Q B T.
  unfold rnd_nearest in B. rewrite Rabs_minus_sym in B.
  apply Rle_trans with ((1 + u) * Rabs (fl x) * q); [apply Rmult_le_compat_r; lra |].
  replace ((1 + u) * Rabs (fl x) * q) with (Rabs (fl x) * (q * (1 + u))) by ring. rewrite U. lra.
Qed.

(** The factors cover three and five roundings. *)
Lemma covers k g : (1 + u) ^ k <= g -> 1 <= g * q ^ k.
Proof.
  intros H. assert (P : 0 < q ^ k) by apply pow_lt, q_1. apply (Rmult_le_compat_r (q ^ k)) in H; [| lra].
  rewrite <- Rpow_mult_distr, (Rmult_comm (1 + u)), q_u, pow1 in H. lra.
Qed.
Lemma three_roundings : 1 <= (1 + 4 * u) * (q * q * q).
Proof. generalize u_8 (covers 3 (1 + 4 * u)). simpl. intros U C. enough (1 + u <= 2) by nra. lra. Qed.
Lemma f_q5 : 1 <= f * (q * q * q * q * q).
Proof. generalize u_8 (covers 5 f). unfold f. simpl. intros U C. nra. Qed.

(** These are numbers of the format. *)
Lemma add_factor : fl (1 + fl (2 * eps)) = 1 + 4 * u.
Proof. replace (4 * u) with (2 * eps) by (rewrite eps_2u; ring). apply (rnd_factor p emin nearest 1); auto; lia. Qed.
Lemma inflated_exact x : inflated x = fl (x * f).
Proof.
  unfold inflated, f. do 2 f_equal. replace (8 * u) with (4 * eps) by (rewrite eps_2u; ring).
  apply (rnd_factor p emin nearest 2); auto; lia.
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

Lemma rule : @AbsoluteBound.rule p emin nearest rounding inflated true (fl (2 * eta)) eta u (eta / 2) q f.
Proof.
  rewrite (rnd_exact (2 * eta) number_2_eta).
  generalize (eta_positive emin) (smallest_normal_eps p emin) u_8 q_1 q_u f_2. rewrite eps_2u. intros.
  split; auto using rounding_nonnegative, rounding_sum, rounding_any, rounding_0, inflated_exact, number_2_eta,
    number_eta, normal_left, f_q5; try nra.
  - intros v. apply rnd_number.
  - replace (1 - q) with (u * q) by lra. rewrite <- Rmult_assoc. apply Rmult_le_compat_r; nra.
Qed.
(** Sums and normal numbers keep the share q. *)
Lemma normal_relative x : smallest_normal <= x -> x * q <= fl x.
Proof. apply (AbsoluteBound.normal_left rule). Qed.
Lemma sum_relative x y : number x -> number y -> 0 <= x + y -> (x + y) * q <= fl (x + y).
Proof. apply (AbsoluteBound.sum_left rule). Qed.

(** The error of a sum, and the first of its two bounds. *)
Lemma sharp_sum_error a x sa b y sb :
  number a -> number b -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= rounding (fl (a + b)) + (sa + sb).
Proof. apply (AbsoluteBound.sum_error_at_most rule). Qed.
Lemma sharp_difference_error a x sa b y sb :
  number a -> number b -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a - b) - (x - y)) <= rounding (fl (a - b)) + (sa + sb).
Proof. intros. apply sharp_sum_error; auto using number_opp, within_opp. Qed.
Lemma sharp_enlarged_sound v sa sb : number sa -> number sb -> 0 <= sa -> 0 <= sb ->
  rounding v + (sa + sb) <= sharp_enlarged v sa sb.
Proof.
  unfold sharp_enlarged. rewrite add_factor. apply (AbsoluteBound.enlarged_sound rule); [| exact three_roundings].
  generalize u_8. lra.
Qed.
Theorem sharp_add_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= sharp_add (fl (a + b)) sa sb.
Proof.
  intros. apply (AbsoluteBound.add_sound rule); auto; [lia |].
  apply sharp_enlarged_sound; eauto using within_positive.
Qed.

Theorem sharp_subtract_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a - b) - (x - y)) <= sharp_add (fl (a - b)) sa sb.
Proof. intros. apply sharp_add_sound; auto using number_opp, within_opp. Qed.

Theorem sharp_multiply_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a * b) - x * y) <= sharp_multiply (fl (a * b)) a sa b sb.
Proof. apply (AbsoluteBound.multiply_sound rule). Qed.

Theorem sharp_divide_sound a x sa b y sb bound :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  sharp_divide (fl (a / b)) a sa b sb = Some bound ->
  y <> 0 /\ Rabs (fl (a / b) - x / y) <= bound.
Proof. apply (AbsoluteBound.divide_sound rule). Qed.

Theorem sharp_scale_sound a x sa e :
  number a -> number sa -> Rabs (a - x) <= sa ->
  Rabs (fl (a * bpow radix2 e) - x * bpow radix2 e) <= sharp_scale (fl (a * bpow radix2 e)) a sa e.
Proof. apply (AbsoluteBound.scale_sound rule); [now apply number_eta | generalize (eta_positive emin); lra]. Qed.

End Sharp.
