(** Bound rule `tight` (include/errbound/rules/tight.hpp): TightBound, as the C++ code computes it.

    A number x has a value a and a bound sa, |a - x| <= sa. u is a number (emin <= -p), as in every IEEE format.
    Results:
        tight_add_sound, tight_subtract_sound, tight_multiply_sound, tight_divide_sound, tight_scale_sound
            rounding in any one direction, from 5 bits on
        tight_add_sound_nearest, tight_subtract_sound_nearest, tight_multiply_sound_nearest,
        tight_divide_sound_nearest, tight_scale_sound_nearest
            rounding to nearest, ties to even, from 3 bits on
        tight_exact_sound, tight_within_sound   exact numbers, and numbers within a given error
        tight_add_number, tight_multiply_number, tight_divide_number   the bound is a number of the format *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format.
From Errbound Require AbsoluteBound Upper.
Open Scope R_scope.

Section Tight.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (direction : R -> Z) {direction_valid : Valid_rnd direction}.

Notation fl := (rnd p emin direction).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).

(** The code, in its order of evaluation; `multiply` and `divide` are those of AbsoluteBound.v. *)
Definition rounding (v : R) : R := fl (Rabs v * fl (eps * fl (1 + eps))).
Definition inflated (bound : R) : R := fl (bound * fl (1 + fl (8 * eps))).

Definition tight_exact (a : R) : R := fl (a - a).
(** For error >= 0. *)
Definition tight_within (a error : R) : R := fl (error + fl (a - a)).
Definition tight_enlarged (v sa sb : R) : R := inflated (fl (rounding v + fl (sa + sb))).
Definition tight_add (v sa sb : R) : R :=
  Upper.sum_of_bounds p emin direction (tight_enlarged v sa sb) (rounding v) sa sb.
Definition tight_multiply (v a sa b sb : R) : R :=
  AbsoluteBound.multiply p emin direction rounding inflated false (fl (4 * eta)) v a sa b sb.
(** None: the result is unknown (the bound is infinite). *)
Definition tight_divide (v a sa b sb : R) : option R :=
  AbsoluteBound.divide p emin direction rounding inflated false (fl (4 * eta)) (fl (4 * eta)) v a sa b sb.
Definition tight_scale (v a sa : R) (e : Z) : R :=
  scaled_error p emin direction (fun scaled => inflated (fl (scaled + fl (2 * eta)))) v a sa e.

Let rnd_exact := Format.rnd_exact p emin direction.
Let rnd_number := Format.rnd_number p emin direction.
Let rnd_above := Format.rnd_above p emin direction.
Let rnd_0 := Format.rnd_0 p emin direction.

(** The proof for a rounding with a relative error r, or an error h below the smallest normal number. *)
Section Proof.

Context (p_3 : (3 <= p)%Z) (emin_p : (emin <= - p)%Z) (r h : R) (E : rounding_error p emin direction r h).
Let f := 1 + 8 * eps.
Let q := 1 - r.
Context (f_q6 : 1 <= f * (q * q * q * q * q * q)) (h_f : h * (2 + f) <= 4 * eta).

Lemma number_4_eta : number (4 * eta).
Proof. exact (number_eta_times p emin 2 ltac:(lia)). Qed.
Lemma number_2_eta : number (2 * eta).
Proof. exact (number_eta_times p emin 1 ltac:(lia)). Qed.

Lemma inflated_exact x : inflated x = fl (x * f).
Proof. unfold inflated. do 2 f_equal. apply (rnd_factor p emin direction 3); auto; lia. Qed.

(** The rule's rounding term is at least the error of its operation. *)
Lemma rounding_factor : eps <= fl (eps * fl (1 + eps)).
Proof.
  generalize (eps_positive p). intros P. assert (1 <= fl (1 + eps)).
  { apply rnd_above; [change 1 with (bpow radix2 0); apply number_power; auto; lia | lra]. }
  apply rnd_above; [apply number_power; auto; lia | nra].
Qed.
Lemma rounding_nonnegative v : 0 <= rounding v.
Proof.
  apply rounding_term_nonnegative; auto. generalize (eps_positive p) rounding_factor. lra.
Qed.
Lemma rounding_sum x y :
  number x -> number y -> Rabs (fl (x + y) - (x + y)) <= rounding (fl (x + y)).
Proof. intros. apply rounding_of_sum; auto. apply rounding_factor. Qed.
Lemma rounding_any s : Rabs (fl s - s) <= rounding (fl s) + h.
Proof. apply rounding_of_any with r; auto. apply rounding_factor. Qed.
Lemma rounding_0 : rounding (fl 0) = 0.
Proof. unfold rounding. rewrite rnd_0, Rabs_R0, Rmult_0_l by auto. now apply rnd_0. Qed.

Lemma rule : @AbsoluteBound.rule p emin direction rounding inflated false (fl (4 * eta)) (fl (4 * eta)) r h q f.
Proof.
  rewrite (rnd_exact (4 * eta) number_4_eta).
  generalize (error_r _ _ _ _ _ E) (error_r_1 _ _ _ _ _ E) (error_h _ _ _ _ _ E).
  generalize (eps_positive p) (eta_positive emin) (smallest_normal_positive p emin) (smallest_normal_eps p emin).
  intros. assert (smallest_normal * r <= eta) by nra. unfold q.
  split; auto using rounding_nonnegative, rounding_sum, rounding_any, rounding_0, inflated_exact, number_4_eta; try nra.
  - intros x C. generalize (error_relative _ _ _ _ _ E x C) (Rabs_triang_inv x (fl x)). rewrite (Rabs_minus_sym x). lra.
  - intros v. apply rnd_number.
  - unfold f. lra.
  - unfold AbsoluteBound.last. fold q. lra.
Qed.

(** A sum of three, inflated, is at least the exact sum: nothing is lost below the smallest normal number, and the
    factor covers three roundings above. *)
Lemma inflated_sum_left x y z :
  number x -> number y -> number z -> 0 <= x -> 0 <= y -> 0 <= z ->
  x + y + z <= inflated (fl (fl (x + y) + z)).
Proof.
  rewrite inflated_exact. apply (AbsoluteBound.three_covered rule); [apply (AbsoluteBound.factor_1 rule) |].
  exact (AbsoluteBound.factor_3 rule).
Qed.

(** The error of a sum, and its bounds. *)
Lemma enlarged_sound v sa sb : number sa -> number sb -> 0 <= sa -> 0 <= sb ->
  rounding v + (sa + sb) <= tight_enlarged v sa sb.
Proof.
  unfold tight_enlarged. rewrite inflated_exact. apply (AbsoluteBound.enlarged_sound rule).
  - apply (AbsoluteBound.factor_1 rule).
  - exact (AbsoluteBound.factor_3 rule).
Qed.
Lemma add_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= tight_add (fl (a + b)) sa sb.
Proof.
  intros. apply (AbsoluteBound.add_sound rule); auto; [lia |].
  apply enlarged_sound; eauto using within_positive.
Qed.
Lemma scale_sound a x sa e :
  number a -> number sa -> Rabs (a - x) <= sa ->
  Rabs (fl (a * bpow radix2 e) - x * bpow radix2 e) <= tight_scale (fl (a * bpow radix2 e)) a sa e.
Proof.
  apply (AbsoluteBound.scale_sound rule); [apply rnd_number |]. generalize (error_h _ _ _ _ _ E).
  rewrite (rnd_exact (2 * eta) number_2_eta). lra.
Qed.

End Proof.

(** The factor 1 + 8 eps covers six roundings: of eps each from 5 bits on, of u from 3 bits on. *)
Lemma six_roundings_any e : 0 <= e <= / 16 -> 1 <= (1 + 8 * e) * (1 - e) ^ 6.
Proof. intros H. nra. Qed.
Lemma six_roundings_nearest e : 0 <= e <= / 8 -> 1 <= (1 + 16 * e) * (1 - e) ^ 6.
Proof. intros H. nra. Qed.

Theorem tight_exact_sound x : Rabs (x - x) <= tight_exact x.
Proof.
  unfold tight_exact. replace (x - x) with 0 by ring. rewrite Rabs_R0, rnd_0. lra.
Qed.
Theorem tight_within_sound a x error :
  number error -> Rabs (a - x) <= error -> Rabs (a - x) <= tight_within a error.
Proof.
  intros N H. unfold tight_within. replace (a - a) with 0 by ring.
  now rewrite rnd_0, Rplus_0_r, rnd_exact.
Qed.

(** The code's bounds are numbers, so results may be operands. *)
Theorem tight_add_number v sa sb : number (tight_add v sa sb).
Proof. apply Upper.sum_of_bounds_number, rnd_number; auto. Qed.
Theorem tight_multiply_number v a sa b sb : number (tight_multiply v a sa b sb).
Proof. unfold tight_multiply, AbsoluteBound.multiply. destruct (_ || _); apply rnd_number. Qed.
Theorem tight_divide_number v a sa b sb bound :
  tight_divide v a sa b sb = Some bound -> number bound.
Proof.
  unfold tight_divide, AbsoluteBound.divide. cbv zeta. destruct (negb _); [discriminate |].
  destruct (AbsoluteBound.is_zero a sa); intros G; injection G as <-; apply rnd_number.
Qed.

End Tight.

(** The theorems: the returned bound holds for the computed value. *)
Section Sound.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (emin_p : (emin <= - p)%Z).
Notation number := (number p emin).

Section Any_direction.

Context (p_5 : (5 <= p)%Z) (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation fl := (rnd p emin direction).

Lemma eps_16 : 0 <= eps p <= / 16.
Proof. generalize (eps_positive p) (eps_le p 5 p_5). simpl. lra. Qed.
Let error : rounding_error p emin direction (eps p) (eta emin) :=
  rounding_error_any p emin direction ltac:(lia).
Lemma any_q6 : 1 <= (1 + 8 * eps p) * ((1 - eps p) * (1 - eps p) * (1 - eps p) *
                                        (1 - eps p) * (1 - eps p) * (1 - eps p)).
Proof. apply Rle_trans with (1 := six_roundings_any _ eps_16). right. ring. Qed.
Lemma any_h : eta emin * (2 + (1 + 8 * eps p)) <= 4 * eta emin.
Proof. generalize eps_16 (eta_positive emin). nra. Qed.
Let any_rule := rule p emin direction ltac:(lia) emin_p _ _ error any_q6 any_h.

Theorem tight_add_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= tight_add p emin direction (fl (a + b)) sa sb.
Proof. apply (add_sound p emin direction ltac:(lia) emin_p _ _ error any_q6 any_h). Qed.

Theorem tight_subtract_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a - b) - (x - y)) <= tight_add p emin direction (fl (a - b)) sa sb.
Proof. intros. apply tight_add_sound; auto using number_opp, within_opp. Qed.

Theorem tight_multiply_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a * b) - x * y) <= tight_multiply p emin direction (fl (a * b)) a sa b sb.
Proof. apply (AbsoluteBound.multiply_sound any_rule). Qed.

Theorem tight_divide_sound a x sa b y sb bound :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  tight_divide p emin direction (fl (a / b)) a sa b sb = Some bound ->
  y <> 0 /\ Rabs (fl (a / b) - x / y) <= bound.
Proof. apply (AbsoluteBound.divide_sound any_rule). Qed.

Theorem tight_scale_sound a x sa e :
  number a -> number sa -> Rabs (a - x) <= sa ->
  Rabs (fl (a * bpow radix2 e) - x * bpow radix2 e) <=
    tight_scale p emin direction (fl (a * bpow radix2 e)) a sa e.
Proof. apply (scale_sound p emin direction ltac:(lia) emin_p _ _ error any_q6 any_h). Qed.

End Any_direction.

Section To_nearest.

Hypothesis p_3 : (3 <= p)%Z.
Notation fl := (rnd p emin nearest).

Lemma u_8 : 0 <= u p <= / 8.
Proof.
  generalize (u_positive p) (eps_le p 3 p_3) (eps_2u p). simpl. lra.
Qed.
Let error : rounding_error p emin nearest (u p) (eta emin / 2) :=
  rounding_error_nearest p emin ltac:(lia).
Lemma nearest_q6 : 1 <= (1 + 8 * eps p) * ((1 - u p) * (1 - u p) * (1 - u p) *
                                            (1 - u p) * (1 - u p) * (1 - u p)).
Proof.
  rewrite eps_2u. apply Rle_trans with (1 := six_roundings_nearest _ u_8). right. ring.
Qed.
Lemma nearest_h : eta emin / 2 * (2 + (1 + 8 * eps p)) <= 4 * eta emin.
Proof. rewrite eps_2u. generalize u_8 (eta_positive emin). nra. Qed.
Let nearest_rule := rule p emin nearest p_3 emin_p _ _ error nearest_q6 nearest_h.

Theorem tight_add_sound_nearest a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= tight_add p emin nearest (fl (a + b)) sa sb.
Proof. apply (add_sound p emin nearest p_3 emin_p _ _ error nearest_q6 nearest_h). Qed.

(** The sum in the code, and the first of its two bounds. *)
Lemma tight_sum_error_nearest a x sa b y sb :
  number a -> number b -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= rounding p emin nearest (fl (a + b)) + (sa + sb).
Proof. apply (AbsoluteBound.sum_error_at_most nearest_rule). Qed.
Lemma tight_difference_error_nearest a x sa b y sb :
  number a -> number b -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a - b) - (x - y)) <= rounding p emin nearest (fl (a - b)) + (sa + sb).
Proof. intros. apply tight_sum_error_nearest; auto using number_opp, within_opp. Qed.
Lemma tight_enlarged_sound_nearest v sa sb : number sa -> number sb -> 0 <= sa -> 0 <= sb ->
  rounding p emin nearest v + (sa + sb) <= tight_enlarged p emin nearest v sa sb.
Proof. apply (enlarged_sound p emin nearest p_3 emin_p _ _ error nearest_q6 nearest_h). Qed.

Theorem tight_subtract_sound_nearest a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a - b) - (x - y)) <= tight_add p emin nearest (fl (a - b)) sa sb.
Proof. intros. apply tight_add_sound_nearest; auto using number_opp, within_opp. Qed.

Theorem tight_multiply_sound_nearest a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a * b) - x * y) <= tight_multiply p emin nearest (fl (a * b)) a sa b sb.
Proof. apply (AbsoluteBound.multiply_sound nearest_rule). Qed.

Theorem tight_divide_sound_nearest a x sa b y sb bound :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  tight_divide p emin nearest (fl (a / b)) a sa b sb = Some bound ->
  y <> 0 /\ Rabs (fl (a / b) - x / y) <= bound.
Proof. apply (AbsoluteBound.divide_sound nearest_rule). Qed.

Theorem tight_scale_sound_nearest a x sa e :
  number a -> number sa -> Rabs (a - x) <= sa ->
  Rabs (fl (a * bpow radix2 e) - x * bpow radix2 e) <=
    tight_scale p emin nearest (fl (a * bpow radix2 e)) a sa e.
Proof. apply (scale_sound p emin nearest p_3 emin_p _ _ error nearest_q6 nearest_h). Qed.

End To_nearest.
End Sound.
