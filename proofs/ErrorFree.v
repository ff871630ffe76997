(** Error-free transformations (include/errbound/error_free.hpp), rounded to nearest, ties to even:
    Flocq's theorems (its module Pff2Flocq), restated for the operations as the code orders them.

    Results:
        two_sum_exact         value + error = a + b; from 2 bits on
        fast_two_sum_exact    the same where |a| >= |b|, and where a = 0
        split_exact           value + error = x; the error has at most s bits; from 4 bits on
        two_product_exact     value + error = a b where product_error_is_exact says so; from 4 bits on
        two_product_fma_exact the same with fused multiply-add; from 2 bits on *)

From Coq Require Import Reals ZArith Lia Lra Psatz.
From Flocq Require Import Core Mult_error Pff2Flocq.
From Errbound Require Import Format.
Open Scope R_scope.

Section ErrorFree.

Variables p emin : Z.
Context {p_positive : Prec_gt_0 p}.
Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eta := (eta emin).
Notation u := (u p).

(** The code. *)
Definition two_sum (a b : R) : R * R :=
  let sum := fl (a + b) in
  let b_in_sum := fl (sum - a) in
  (sum, fl (fl (a - fl (sum - b_in_sum)) + fl (b - b_in_sum))).
Definition fast_two_sum (a b : R) : R * R :=
  let sum := fl (a + b) in (sum, fl (b - fl (sum - a))).
(** s = (p + 1) / 2, rounded down: what Flocq writes p - p / 2. *)
Definition half_bits : Z := ((p + 1) / 2)%Z.
Definition split (x : R) : R * R :=
  let c := fl ((bpow radix2 half_bits + 1) * x) in
  let high := fl (c - fl (c - x)) in
  (high, fl (x - high)).
Definition two_product (a b : R) : R * R :=
  let v := fl (a * b) in
  let (a_high, a_low) := split a in
  let (b_high, b_low) := split b in
  let first := fl (fl (a_high * b_high) - v) in
  let middle := fl (fl (first + fl (a_high * b_low)) + fl (a_low * b_high)) in
  (v, fl (middle + fl (a_low * b_low))).
Definition two_product_fma (a b : R) : R * R :=
  let v := fl (a * b) in (v, fl (a * b - v)).
Definition product_error_is_exact (a b : R) (product : R * R) : Prop :=
  a = 0 \/ b = 0 \/ fl (fl (eta / u) / u) <= Rabs (fst product).

Lemma choice_symmetric x : negb (Z.even x) = negb (negb (Z.even (- (x + 1)))).
Proof. rewrite Z.even_opp, Z.even_add. now destruct (Z.even x). Qed.
Lemma fl_opp x : fl (- x) = - fl x.
Proof. apply round_NE_opp. Qed.

Hypothesis emin_0 : (emin < 0)%Z.

Theorem two_sum_exact a b : (2 <= p)%Z -> number a -> number b ->
  fst (two_sum a b) + snd (two_sum a b) = a + b.
Proof.
  intros P A B.
  apply (TwoSum_correct emin p (fun n => negb (Z.even n)) ltac:(lia) ltac:(lia)
           choice_symmetric a b A B).
Qed.

Theorem fast_two_sum_exact a b : (2 <= p)%Z -> number a -> number b -> Rabs b <= Rabs a \/ a = 0 ->
  fst (fast_two_sum a b) + snd (fast_two_sum a b) = a + b.
Proof.
  intros P A B H. unfold fast_two_sum. simpl.
  assert (L : Rabs b <= Rabs a ->
              fl (a + b) + fl (b - fl (fl (a + b) - a)) = a + b).
  { intros C. replace (fl (a + b) - a) with (- (a - fl (a + b))) by ring. rewrite fl_opp.
    replace (b - - fl (a - fl (a + b))) with (b + fl (a - fl (a + b))) by ring.
    apply (Fast2Sum_correct emin p (fun n => negb (Z.even n)) ltac:(lia) ltac:(lia)
             choice_symmetric a b A B C). }
  destruct H as [H | ->]; auto.
  rewrite Rplus_0_l, (rnd_exact p emin nearest b B), Rminus_0_r, (rnd_exact p emin nearest b B).
  replace (b - b) with 0 by ring. rewrite (rnd_0 p emin nearest). ring.
Qed.

Lemma half_bits_div2 : half_bits = (p - Z.div2 p)%Z.
Proof.
  unfold half_bits. rewrite Z.div2_div. generalize (Z.div_mod p 2) (Z.div_mod (p + 1) 2)
    (Z.mod_pos_bound p 2) (Z.mod_pos_bound (p + 1) 2). lia.
Qed.

(** As Veltkamp's algorithm is written there. *)
Lemma split_as_there x : split x =
  let c := fl (x * (bpow radix2 half_bits + 1)) in
  let high := fl (fl (x - c) + c) in
  (high, fl (x - high)).
Proof.
  unfold split. cbv zeta. rewrite (Rmult_comm _ x).
  set (c := fl (x * (bpow radix2 half_bits + 1))).
  replace (c - x) with (- (x - c)) by ring. rewrite fl_opp.
  replace (c - - fl (x - c)) with (fl (x - c) + c) by ring. reflexivity.
Qed.

Theorem split_exact x : (4 <= p)%Z -> number x ->
  fst (split x) + snd (split x) = x /\
  generic_format radix2 (FLT_exp emin half_bits) (snd (split x)).
Proof.
  intros P X. rewrite split_as_there. simpl.
  assert (S : (2 <= half_bits <= p - 2)%Z).
  { rewrite half_bits_div2, Z.div2_div. generalize (Z.div_mod p 2) (Z.mod_pos_bound p 2). lia. }
  destruct (Veltkamp_tail radix2 emin p (fun n => negb (Z.even n)) half_bits ltac:(lia) ltac:(lia)
              (proj1 S) (proj2 S) x X) as [H1 H2].
  split; [symmetry; exact H1 | exact H2].
Qed.

(** The code's threshold, 2^(2p) eta, and the exact product's. *)
Lemma threshold : (1 <= p)%Z -> fl (fl (eta / u) / u) = bpow radix2 (emin + 2 * p).
Proof.
  intros P. assert (D : forall e, bpow radix2 e / u = bpow radix2 (e + p)).
  { intros e. unfold Rdiv, Format.u. rewrite <- bpow_opp, <- bpow_plus. f_equal. lia. }
  unfold Format.eta. rewrite D, (rnd_exact p emin nearest (bpow radix2 (emin + p))).
  - rewrite D, (rnd_exact p emin nearest).
    + f_equal. lia.
    + apply number_power; auto. lia.
  - apply number_power; auto. lia.
Qed.
Lemma far_from_underflow a b error : (1 <= p)%Z ->
  product_error_is_exact a b (fl (a * b), error) ->
  a * b = 0 \/ bpow radix2 (emin + 2 * p - 1) <= Rabs (a * b).
Proof.
  unfold product_error_is_exact. intros P [-> | [-> | H]]; [left; ring | left; ring | right].
  rewrite threshold in H by auto. cbn [fst] in H. apply Rnot_lt_le. intros C.
  assert (Rabs (fl (a * b)) <= bpow radix2 (emin + 2 * p - 1)).
  { apply (rnd_abs_below p emin nearest); [apply number_power; auto; lia | lra]. }
  assert (bpow radix2 (emin + 2 * p - 1) < bpow radix2 (emin + 2 * p)) by (apply bpow_lt; lia).
  lra.
Qed.

Theorem two_product_exact a b : (4 <= p)%Z -> number a -> number b ->
  product_error_is_exact a b (two_product a b) ->
  fst (two_product a b) + snd (two_product a b) = a * b.
Proof.
  intros P A B. unfold two_product. rewrite !split_as_there. cbv zeta. intros H.
  apply far_from_underflow in H; try lia. cbn [fst snd].
  revert H. rewrite half_bits_div2. intros H.
  set (ah := fl (fl (a - fl (a * (bpow radix2 (p - Z.div2 p) + 1))) +
                 fl (a * (bpow radix2 (p - Z.div2 p) + 1)))).
  set (bh := fl (fl (b - fl (b * (bpow radix2 (p - Z.div2 p) + 1))) +
                 fl (b * (bpow radix2 (p - Z.div2 p) + 1)))).
  replace (fl (ah * bh) - fl (a * b)) with (- fl (a * b) + fl (ah * bh)) by ring.
  symmetry.
  apply (proj1 (Dekker radix2 emin p (fun n => negb (Z.even n)) P ltac:(lia) a b A B
                  ltac:(now left)) H).
Qed.

Theorem two_product_fma_exact a b : (2 <= p)%Z -> number a -> number b ->
  product_error_is_exact a b (two_product_fma a b) ->
  fst (two_product_fma a b) + snd (two_product_fma a b) = a * b.
Proof.
  intros P A B H. apply far_from_underflow in H; try lia. unfold two_product_fma. cbn [fst snd].
  rewrite (rnd_exact p emin nearest (a * b - fl (a * b))); [ring |].
  replace (a * b - fl (a * b)) with (- (fl (a * b) - a * b)) by ring. apply number_opp.
  apply mult_error_FLT; auto with typeclass_instances.
  intros N. now destruct H.
Qed.

End ErrorFree.
