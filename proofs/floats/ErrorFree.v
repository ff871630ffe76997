(** Error-free transformations (include/errbound/error_free.hpp), rounded to nearest, ties to even: Flocq's theorems
    (its module Pff2Flocq), restated for the operations in the code's order. Results:
        two_sum_exact         value + error = a + b; from 2 bits on
        fast_two_sum_exact    the same if |a| >= |b|, or if a = 0
        split_exact           value + error = x; the error has at most s bits; from 4 bits on
        two_product_exact     value + error = a b if product_error_is_exact; from 4 bits on
        two_product_fma_exact the same with fused multiply-add; from 2 bits on
        remainder_of_division_exact   the remainder a - q b, if the code reports that it is exact *)

From Coq Require Import Reals ZArith Lia Lra Psatz.
From Flocq Require Import Core Mult_error Sterbenz Pff2Flocq.
From Errbound Require Import Format.
Open Scope R_scope.

Section ErrorFree.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.
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
(** s = (p + 1) / 2, rounded down: Flocq's p - p / 2. *)
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

(** Veltkamp's algorithm as Flocq has it. *)
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

(** The code's threshold, 2^(2p) eta, and that of the exact product. *)
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

(** The remainder of q = fl(a / b), from either product. *)
Definition remainder_of_division (a : R) (product : R * R) : R :=
  if Req_bool a 0 then 0 else fl (fl (a - fst product) - snd product).

Lemma quotient_error a b : (2 <= p)%Z -> b <> 0 -> fl (a / b) <> 0 ->
  Rabs (a - fl (a / b) * b) <= Rabs b * (ulp radix2 (FLT_exp emin p) (fl (a / b)) / 2) /\
  Rabs (a - fl (a / b) * b) <= Rabs (fl (a / b) * b) / 2.
Proof.
  intros P B Q. set (q := fl (a / b)) in *.
  assert (E : Rabs (a / b - q) <= ulp radix2 (FLT_exp emin p) q / 2).
  { rewrite Rabs_minus_sym. unfold q, rnd.
    generalize (error_le_half_ulp_round radix2 (FLT_exp emin p) (fun n => negb (Z.even n)) (a / b)). lra. }
  assert (U : ulp radix2 (FLT_exp emin p) q <= Rabs q).
  { apply ulp_le_abs; auto. apply rnd_number; auto with typeclass_instances. }
  replace (a - q * b) with (b * (a / b - q)) by (now field). rewrite !Rabs_mult.
  generalize (Rabs_pos b). intros Pb. split.
  - apply Rmult_le_compat_l; auto.
  - replace (Rabs q * Rabs b / 2) with (Rabs b * (Rabs q / 2)) by field.
    apply Rmult_le_compat_l; lra.
Qed.
Lemma difference_is_number a c : (2 <= p)%Z -> number a -> smallest_normal p emin <= Rabs c ->
  Rabs (a - c) <= Rabs c / 2 -> fl (a - fl c) = a - fl c.
Proof.
  intros P A N H. apply rnd_exact; auto with typeclass_instances.
  assert (L : forall a c, number a -> smallest_normal p emin <= c -> Rabs (a - c) <= c / 2 ->
                          number (a - fl c)).
  { clear a c A N H. intros a c A N H. apply Rabs_le_inv in H.
    generalize (smallest_normal_positive p emin). intros S.
    assert (T : number (2 * a)).
    { rewrite Rmult_comm. change 2 with (bpow radix2 1). apply mult_bpow_pos_exact_FLT; auto. lia. }
    apply sterbenz; auto with typeclass_instances.
    - apply rnd_number; auto with typeclass_instances.
    - assert (fl c <= 2 * a) by (apply rnd_below; auto with typeclass_instances; lra).
      generalize (rnd_relative p emin nearest _ _ (rounding_error_nearest p emin ltac:(lia)) c N)
        (eps_le p 2 P) (eps_2u p). simpl. intros R E U.
      assert (c * u <= c * / 4) by (apply Rmult_le_compat_l; lra). lra. }
  destruct (Rle_or_lt 0 c) as [C | C].
  - rewrite (Rabs_pos_eq c) in * by auto. now apply L.
  - rewrite (Rabs_left c) in * by auto.
    replace (a - fl c) with (- (- a - fl (- c))) by (rewrite fl_opp; ring).
    apply number_opp, L; [now apply number_opp | auto |].
    replace (- a - - c) with (- (a - c)) by ring. now rewrite Rabs_Ropp.
Qed.
Lemma cexp_form x : number x -> exists m, x = IZR m * bpow radix2 (cexp radix2 (FLT_exp emin p) x) /\
  Rabs x < bpow radix2 (p + cexp radix2 (FLT_exp emin p) x).
Proof.
  intros N. exists (Ztrunc (scaled_mantissa radix2 (FLT_exp emin p) x)). split; [exact N |].
  apply Rlt_le_trans with (bpow radix2 (mag radix2 x)); [apply bpow_mag_gt |].
  apply bpow_le. unfold cexp, FLT_exp. lia.
Qed.

Theorem remainder_of_division_exact a b product :
  (2 <= p)%Z -> number a -> number b -> b <> 0 ->
  let q := fl (a / b) in
  fst product = fl (q * b) -> fst product + snd product = q * b ->
  a = 0 \/ q <> 0 /\ product_error_is_exact q b product ->
  remainder_of_division a product = a - q * b.
Proof.
  intros P A B B0 q V E C. unfold remainder_of_division.
  destruct (Req_bool_spec a 0) as [Z | Z].
  { unfold q. rewrite Z. unfold Rdiv. rewrite Rmult_0_l, (rnd_0 p emin nearest). ring. }
  destruct C as [C | [Q C]]; [easy |].
  destruct (quotient_error a b P B0 Q) as [E1 E2]. fold q in E1, E2.
  destruct product as [v e]. cbn [fst snd] in *. subst v.
  assert (F : q * b = 0 \/ bpow radix2 (emin + 2 * p - 1) <= Rabs (q * b))
    by (apply far_from_underflow with e; auto; lia).
  destruct F as [F | F]; [apply Rmult_integral in F; tauto |].
  rewrite difference_is_number; auto.
  2: { apply Rle_trans with (2 := F). apply bpow_le. lia. }
  replace (a - fl (q * b) - e) with (a - q * b) by lra.
  apply rnd_exact; auto with typeclass_instances.
  (* the remainder is a multiple of the smaller unit, and has few bits *)
  assert (Nq : number q) by (apply rnd_number; auto with typeclass_instances).
  destruct (cexp_form a A) as (ma & Fa & La), (cexp_form q Nq) as (mq & Fq & Lq),
    (cexp_form b B) as (mb & Fb & Lb).
  assert (Uq : ulp radix2 (FLT_exp emin p) q = bpow radix2 (cexp radix2 (FLT_exp emin p) q))
    by now apply ulp_neq_0.
  rewrite Uq in E1. assert (Ea : (emin <= cexp radix2 (FLT_exp emin p) a)%Z).
  { unfold cexp, FLT_exp. lia. }
  set (ea := cexp radix2 (FLT_exp emin p) a) in *. set (eq := cexp radix2 (FLT_exp emin p) q) in *.
  set (eb := cexp radix2 (FLT_exp emin p) b) in *.
  assert (Eqb : (emin <= eq + eb)%Z).
  { apply Z.lt_succ_r. apply Z.le_lt_trans with (emin + 2 * p - 1 - 2 * p + 1)%Z; [lia |].
    assert (emin + 2 * p - 1 < p + eq + (p + eb))%Z; [| lia].
    apply (lt_bpow radix2). apply Rle_lt_trans with (1 := F). rewrite Rabs_mult, bpow_plus.
    apply Rmult_le_0_lt_compat; auto using Rabs_pos. }
  assert (Form : forall m k, (emin <= k)%Z -> Rabs (IZR m * bpow radix2 k) < bpow radix2 (p + k) ->
                   number (IZR m * bpow radix2 k)).
  { intros m k K H. apply number_integer; auto.
    rewrite Rabs_mult, (Rabs_pos_eq (bpow _ _)), bpow_plus in H by apply bpow_ge_0.
    apply Rmult_lt_reg_r in H; [| apply bpow_gt_0].
    apply le_IZR. rewrite abs_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia. lra. }
  destruct (Z_le_gt_dec ea (eq + eb)) as [L | L].
  - assert (R : a - q * b = IZR (ma - mq * mb * 2 ^ (eq + eb - ea)) * bpow radix2 ea).
    { rewrite minus_IZR, !mult_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
      rewrite Fa at 1. rewrite Fq at 1. rewrite Fb at 1.
      replace (bpow radix2 (eq + eb - ea)) with (bpow radix2 eq * bpow radix2 eb * bpow radix2 (- ea))
        by (rewrite <- !bpow_plus; f_equal; lia).
      assert (X : bpow radix2 (- ea) * bpow radix2 ea = 1)
        by (rewrite <- bpow_plus; replace (- ea + ea)%Z with 0%Z by lia; reflexivity).
      replace ((IZR ma - IZR mq * IZR mb * (bpow radix2 eq * bpow radix2 eb * bpow radix2 (- ea))) *
               bpow radix2 ea)
        with (IZR ma * bpow radix2 ea - IZR mq * IZR mb * bpow radix2 eq * bpow radix2 eb *
              (bpow radix2 (- ea) * bpow radix2 ea)) by ring.
      rewrite X. ring. }
    rewrite R. apply Form; auto. rewrite <- R. apply Rle_lt_trans with (2 := La).
    assert (Rabs (q * b) <= Rabs (q * b - a) + Rabs a).
    { replace (q * b) with ((q * b - a) + a) at 1 by ring. apply Rabs_triang. }
    rewrite Rabs_minus_sym in H. lra.
  - assert (R : a - q * b = IZR (ma * 2 ^ (ea - (eq + eb)) - mq * mb) * bpow radix2 (eq + eb)).
    { rewrite minus_IZR, !mult_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
      rewrite Fa at 1. rewrite Fq at 1. rewrite Fb at 1.
      rewrite Rmult_minus_distr_r. rewrite (Rmult_assoc (IZR ma)), <- bpow_plus.
      replace (ea - (eq + eb) + (eq + eb))%Z with ea by lia. rewrite (bpow_plus radix2 eq eb). ring. }
    rewrite R. apply Form; auto. rewrite <- R. apply Rle_lt_trans with (1 := E1).
    replace (p + (eq + eb))%Z with (p + eb + eq)%Z by lia. rewrite (bpow_plus radix2 (p + eb)).
    assert (Rabs b * bpow radix2 eq < bpow radix2 (p + eb) * bpow radix2 eq)
      by (apply Rmult_lt_compat_r; [apply bpow_gt_0 | auto]).
    generalize (bpow_gt_0 radix2 eq) (Rabs_pos b). intros.
    assert (0 <= Rabs b * bpow radix2 eq) by (apply Rmult_le_pos; lra). lra.
Qed.

End ErrorFree.
