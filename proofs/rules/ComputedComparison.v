(** Theorem 2 of the TightCCD paper (Comparison.v) for bounds as the code computes them
    (include/errbound/rules/tight.hpp, safe.hpp), for + − ×, to nearest, with p >= 8 and emin <= 2 - 2p.

    A number of an expression has tight's error s, and safe's bound (B, k) with the error e. Results:
        tight_at_most_safe_computed   s <= (1 + 6m/least) (1 + 22 eps)^k e, if no B is below `least`, and m is the
                                      smallest normal number, m <= least
        tight_at_most_safe_always     s <= 7 (1 + 22 eps)^k e
        computed_tight_may_exceed     s <= e does not hold: 1 + 0 + ... + 0, with 50 zeros and 8 bits
        underflowed_tight_exceeds     nor after one operation if it underflows: eta eta *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Format.
From Errbound Require AbsoluteBound Code Ieee Tight Safe Upper.
Open Scope R_scope.

Section Computed.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (p_8 : (8 <= p)%Z) (emin_2p : (emin <= 2 - 2 * p)%Z).

Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation u := (u p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).
Notation tight_add := (Tight.tight_add p emin nearest).
Notation tight_multiply := (Tight.tight_multiply p emin nearest).
Notation safe_within := (Safe.safe_within p emin nearest).
Notation safe_add := (Safe.safe_add p emin nearest).
Notation safe_multiply := (Safe.safe_multiply p emin nearest).
Notation safe_error := (Safe.safe_error p emin nearest).

(** v, computed by an expression, has tight's error s and safe's bound (B, k). No B except 0 is below `least`. *)
Inductive computed (least : R) : R -> R -> R -> Z -> Prop :=
| exact_number v : number v -> computed least v (Tight.tight_exact p emin nearest v) (Rabs v) 0
| number_within v error B : number v -> number error -> 0 < error -> B = safe_within v error ->
    computed least v (Tight.tight_within p emin nearest v error) (fst B) (snd B)
| sum a sa Ba ka b sb Bb kb v B :
    computed least a sa Ba ka -> computed least b sb Bb kb ->
    v = fl (a + b) -> B = safe_add Ba ka Bb kb -> fst B = 0 \/ least <= fst B ->
    computed least v (tight_add v sa sb) (fst B) (snd B)
| difference a sa Ba ka b sb Bb kb v B :
    computed least a sa Ba ka -> computed least b sb Bb kb ->
    v = fl (a - b) -> B = safe_add Ba ka Bb kb -> fst B = 0 \/ least <= fst B ->
    computed least v (tight_add v sa sb) (fst B) (snd B)
| product a sa Ba ka b sb Bb kb v B :
    computed least a sa Ba ka -> computed least b sb Bb kb ->
    v = fl (a * b) -> B = safe_multiply a Ba ka b Bb kb -> fst B = 0 \/ least <= fst B ->
    computed least v (tight_multiply v a sa b sb) (fst B) (snd B).

Lemma p_1 : (1 <= p)%Z.
Proof. lia. Qed.
Lemma p_3 : (3 <= p)%Z.
Proof. lia. Qed.
Let E := rounding_error_nearest p emin p_1.
Let rnd_exact := Format.rnd_exact p emin nearest.
Let rnd_number := Format.rnd_number p emin nearest.
Let rnd_nonnegative := Format.rnd_nonnegative p emin nearest.

Lemma emin_p : (emin <= - p)%Z.
Proof. lia. Qed.
Lemma u_256 : 0 < u <= / 256.
Proof.
  split; [apply u_positive |]. generalize (eps_2u p) (eps_le p 8 p_8). simpl. lra.
Qed.

(** Upper ends of roundings. *)
Lemma up x : 0 <= x -> fl x <= x * (1 + u) + eta / 2.
Proof.
  intros P. generalize u_256 (eta_positive emin). intros U H. assert (A : Rabs x = x) by now apply Rabs_pos_eq.
  destruct (Rlt_or_le x smallest_normal) as [C | C].
  - generalize (error_absolute _ _ _ _ _ E x). rewrite A. intros D. specialize (D C).
    apply Rabs_le_inv in D. nra.
  - generalize (error_relative _ _ _ _ _ E x). rewrite A. intros D. specialize (D C).
    apply Rabs_le_inv in D. nra.
Qed.
Lemma up_sum x y : number x -> number y -> 0 <= x -> 0 <= y -> fl (x + y) <= (x + y) * (1 + u).
Proof.
  intros X Y PX PY. generalize (sum_error p emin nearest _ _ E x y X Y). rewrite (Rabs_pos_eq (x + y)) by lra.
  intros D. apply Rabs_le_inv in D. lra.
Qed.
Lemma covered x y : Rabs x <= y -> Rabs (fl x) <= fl y.
Proof.
  intros H. unfold rnd. rewrite <- (round_NE_abs radix2 (FLT_exp emin p)). apply (Format.rnd_le p emin nearest). exact H.
Qed.
(** A sum loses less than half of eta. *)
Lemma up_lost x d : number x -> 0 <= x -> d < eta / 2 -> fl (x + d) <= x.
Proof.
  intros N P D. apply round_N_le_midp; auto with typeclass_instances.
  rewrite succ_eq_pos by auto.
  enough (eta <= ulp radix2 (FLT_exp emin p) x) by lra.
  apply Rle_trans with (ulp radix2 (FLT_exp emin p) 0).
  - rewrite ulp_FLT_small; auto; [apply Rle_refl |]. rewrite Rabs_R0. apply bpow_gt_0.
  - apply ulp_ge_ulp_0; auto with typeclass_instances.
Qed.
Lemma up_inflated x : number x -> 0 <= x -> Tight.inflated p emin nearest x <= x * (1 + 32 * u) * (1 + u).
Proof.
  intros N P. rewrite (Tight.inflated_exact p emin nearest p_3 emin_p), (eps_2u p).
  generalize u_256. intros U. assert (PU : 0 <= x * u) by (apply Rmult_le_pos; lra).
  destruct (Rlt_or_le (x * (16 * u)) (eta / 2)) as [C | C].
  - replace (x * (1 + 8 * (2 * u))) with (x + x * (16 * u)) by ring.
    apply Rle_trans with (1 := up_lost x _ N P C). nra.
  - apply Rle_trans with (1 := up (x * (1 + 8 * (2 * u))) ltac:(nra)). nra.
Qed.
Lemma factor_exact : fl (eps * fl (1 + eps)) = eps * (1 + eps).
Proof.
  assert (S : 1 + eps = IZR (2 ^ (p - 1) + 1) * bpow radix2 (1 - p)).
  { rewrite plus_IZR, Rmult_plus_distr_r. change 2%Z with (radix_val radix2).
    rewrite IZR_Zpower by lia. rewrite <- bpow_plus. replace (p - 1 + (1 - p))%Z with 0%Z by lia.
    unfold Format.eps. simpl. lra. }
  assert (L : (Z.abs (2 ^ (p - 1) + 1) <= 2 ^ p)%Z).
  { assert (D : (2 ^ p = 2 * 2 ^ (p - 1))%Z).
    { rewrite <- Z.pow_succ_r by lia. f_equal. lia. }
    assert (1 <= 2 ^ (p - 1))%Z by (apply (Z.pow_le_mono_r 2 0); lia). lia. }
  rewrite (rnd_exact (1 + eps)).
  - apply rnd_exact. rewrite S. unfold Format.eps.
    replace (bpow radix2 (1 - p) * (IZR (2 ^ (p - 1) + 1) * bpow radix2 (1 - p)))
      with (IZR (2 ^ (p - 1) + 1) * bpow radix2 (2 - 2 * p)).
    + apply number_integer; auto.
    + replace (2 - 2 * p)%Z with (1 - p + (1 - p))%Z by lia. rewrite bpow_plus. ring.
  - rewrite S. apply number_integer; auto. lia.
Qed.

Notation rounding := (Tight.rounding p emin nearest).
Lemma rounding_facts v : number (rounding v) /\ 0 <= rounding v.
Proof.
  split; [apply rnd_number |]. apply (Tight.rounding_nonnegative p emin nearest p_3 emin_p).
Qed.
Lemma up_rounding v :
  rounding v <= Rabs v * (eps * (1 + eps)) * (1 + u) + eta / 2 /\
  rounding v <= 2 * (Rabs v * (eps * (1 + eps)) * (1 + u)).
Proof.
  unfold Tight.rounding. rewrite factor_exact. generalize (eps_positive p) u_256 (Rabs_pos v). intros Pe U A.
  assert (P : 0 <= Rabs v * (eps * (1 + eps))) by (repeat apply Rmult_le_pos; lra).
  set (x := Rabs v * (eps * (1 + eps))) in *.
  generalize (up x P). intros H. split; auto. assert (0 <= x * u) by (apply Rmult_le_pos; lra).
  destruct (Rlt_or_le x (eta / 2)) as [C | C]; [| lra].
  generalize (up_lost 0 x (number_0 p emin) (Rle_refl 0) C). rewrite Rplus_0_l. lra.
Qed.

(** The sum of all roundings of a bound, and the factor of each operation. *)
Let f := 1 + 22 * eps.
Lemma all_roundings : (1 + eps) * ((1 + 32 * u) * (1 + u) ^ 6) <= f.
Proof.
  unfold f. rewrite (eps_2u p). generalize u_256. generalize u. intros x [P L].
  assert (S1 : (1 + x) ^ 6 <= 1 + 6 * x + 16 * (x * x)) by nra.
  apply Rle_trans with ((1 + 2 * x) * ((1 + 32 * x) * (1 + 6 * x + 16 * (x * x)))).
  - apply Rmult_le_compat_l; [lra |]. apply Rmult_le_compat_l; lra.
  - nra.
Qed.
Lemma f_1 : 1 <= f.
Proof. unfold f. generalize (eps_positive p). lra. Qed.

(** The induction's bound: s <= c (f^k - 1) B. *)
Context (D least : R) (D_range : 1 <= D <= 7) (D_least : 6 * smallest_normal <= (D - 1) * Rmax least smallest_normal).
Let c := D * f / 22.
Notation power k := (f ^ Z.to_nat k).

Lemma c_range : 0 <= c <= 1.
Proof.
  unfold c, f. generalize (eps_positive p) (eps_2u p) u_256. intros P2 E2 U. split; [| nra].
  unfold Rdiv. repeat apply Rmult_le_pos; lra.
Qed.
Lemma c_own : c * (f - 1) = D * f * eps.
Proof. unfold c. unfold f at 2. field. Qed.
Lemma power_1 k : 1 <= power k.
Proof. apply pow_R1_Rle, f_1. Qed.
Lemma power_le k l : (k <= l)%Z -> power k <= power l.
Proof. intros. apply Rle_pow; [apply f_1 | lia]. Qed.
Lemma power_succ k : (0 <= k)%Z -> power (k + 1) = power k * f.
Proof. intros H. rewrite Z2Nat.inj_add, pow_add by lia. simpl. ring. Qed.

(** D has a share of the losses below the smallest normal number. *)
Lemma lost_share B : least <= B -> smallest_normal <= B -> 6 * eta <= (D - 1) * (eps * B).
Proof.
  intros L M. rewrite <- (smallest_normal_eps p emin). generalize (eps_positive p). intros P.
  replace (6 * (smallest_normal * eps)) with (6 * smallest_normal * eps) by ring.
  replace ((D - 1) * (eps * B)) with ((D - 1) * B * eps) by ring. apply Rmult_le_compat_r; [lra |].
  apply Rle_trans with (1 := D_least). apply Rmult_le_compat_l; [lra | now apply Rmax_lub].
Qed.

(** An operation's own error, in a sum's bound. *)
Lemma own_of_sum v B : Rabs v <= B -> B = 0 \/ least <= B ->
  rounding v * ((1 + 32 * u) * (1 + u) ^ 2) <= D * f * (eps * B).
Proof.
  intros V L. generalize (up_rounding v) (rounding_facts v) (eps_positive p) u_256 (Rabs_pos v) all_roundings
    (eta_positive emin). intros [R1 R2] [_ R0] Pe U PV A Ph.
  set (h := (1 + 32 * u) * (1 + u) ^ 2) in *. set (w := Rabs v * (eps * (1 + eps)) * (1 + u)) in *.
  assert (H6 : (1 + 32 * u) * (1 + u) ^ 6 = h * (1 + u) ^ 4) by (unfold h; ring).
  assert (H1 : 1 <= (1 + u) ^ 3) by (apply pow_R1_Rle; lra).
  assert (P0 : 0 <= h) by (unfold h; generalize (pow_le (1 + u) 2); nra).
  assert (W : w * h <= f * (eps * B)).
  { unfold w. apply Rle_trans with (eps * B * ((1 + eps) * (h * (1 + u)))).
    - replace (Rabs v * (eps * (1 + eps)) * (1 + u) * h) with (eps * Rabs v * ((1 + eps) * (h * (1 + u)))) by ring.
      apply Rmult_le_compat_r; [repeat apply Rmult_le_pos; lra |]. apply Rmult_le_compat_l; lra.
    - rewrite (Rmult_comm f). apply Rmult_le_compat_l; [apply Rmult_le_pos; lra |].
      apply Rle_trans with (2 := A). rewrite H6. apply Rmult_le_compat_l; [lra |]. apply Rmult_le_compat_l; auto.
      simpl in *. nra. }
  assert (PB : 0 <= f * (eps * B)).
  { apply Rle_trans with (2 := W). unfold w. repeat apply Rmult_le_pos; lra. }
  destruct (Rle_or_lt 2 D) as [C | C].
  - apply Rle_trans with (2 * (w * h)); [nra |]. rewrite Rmult_assoc. nra.
  - assert (Hh : h <= f).
    { apply Rle_trans with (2 := A). rewrite H6.
      assert (1 <= (1 + u) ^ 4) by (apply pow_R1_Rle; lra).
      assert (h * 1 <= h * (1 + u) ^ 4) by (apply Rmult_le_compat_l; lra).
      assert (0 <= eps * (h * (1 + u) ^ 4)) by (apply Rmult_le_pos; lra). lra. }
    destruct L as [Z | L].
    { replace (D * f * (eps * B)) with 0 by (rewrite Z; ring).
      assert (W0 : w = 0) by (unfold w; replace (Rabs v) with 0 by lra; ring). rewrite W0 in R2. nra. }
    assert (M : smallest_normal <= B).
    { generalize (smallest_normal_positive p emin). intros PS. apply Rle_trans with (2 := L).
      apply Rnot_lt_le. intros M. rewrite Rmax_right in D_least by lra. nra. }
    generalize (lost_share B L M). intros S.
    apply Rle_trans with (w * h + eta / 2 * h); [rewrite <- Rmult_plus_distr_r; now apply Rmult_le_compat_r |].
    apply Rle_trans with (f * (eps * B) + (D - 1) * (eps * B) * f); [| right; ring].
    apply Rplus_le_compat; auto. apply Rmult_le_compat; lra.
Qed.


(** Inequalities of safe's bounds. *)
Lemma g_q3 : 1 <= (1 + 4 * eps) * ((1 - u) * (1 - u) * (1 - u)).
Proof.
  rewrite (eps_2u p). replace (4 * (2 * u)) with (8 * u) by ring. apply Safe.three_roundings_nearest.
  generalize u_256. lra.
Qed.
Lemma enlarged_sum x y : number x -> number y -> 0 <= x -> 0 <= y ->
  x + y <= Safe.enlarged p emin nearest (fl (x + y)).
Proof. apply (Safe.enlarged_sum p emin nearest p_3 emin_p _ _ E g_q3). Qed.
Lemma enlarged_more x : number x -> 0 <= x -> x <= Safe.enlarged p emin nearest x.
Proof.
  intros N P. rewrite (Safe.enlarged_exact p emin nearest p_3 emin_p).
  apply Format.scaled_up; auto with typeclass_instances. generalize (eps_positive p). lra.
Qed.
Lemma counted_few k : (0 <= k)%Z -> (0 <= Safe.counted k <= Safe.too_many)%Z /\
  ((Safe.counted k < Safe.too_many)%Z -> (k < Safe.too_many)%Z /\ Safe.counted k = (k + 1)%Z).
Proof.
  unfold Safe.counted, Safe.too_many. intros K. change (2 ^ 29)%Z with 536870912%Z.
  destruct (Z.ltb_spec k (536870912 - 1)); lia.
Qed.

(** The invariant of each number. *)
Definition carries (v s B : R) (k : Z) : Prop :=
  number v /\ number s /\ number B /\ 0 <= s /\ (0 <= k <= Safe.too_many)%Z /\ Rabs v <= B /\
  ((k < Safe.too_many)%Z -> s <= c * (power k - 1) * B /\ (k = 0%Z -> s = 0)).

Lemma sum_carries a sa Ba ka b sb Bb kb B :
  carries a sa Ba ka -> carries b sb Bb kb -> B = safe_add Ba ka Bb kb -> fst B = 0 \/ least <= fst B ->
  carries (fl (a + b)) (tight_add (fl (a + b)) sa sb) (fst B) (snd B).
Proof.
  intros (NA & NSA & NBA & PSA & PKA & VA & HA) (NB & NSB & NBB & PSB & PKB & VB & HB) -> L.
  unfold Safe.safe_add in *. cbn [fst snd] in *. set (B := Safe.enlarged p emin nearest (fl (Ba + Bb))) in *.
  generalize (Rabs_pos a) (Rabs_pos b). intros PA PB.
  assert (S : Ba + Bb <= B) by (apply enlarged_sum; auto; lra).
  assert (V : Rabs (fl (a + b)) <= B).
  { apply Rle_trans with (fl (Ba + Bb)); [| apply enlarged_more; [apply rnd_number | apply rnd_nonnegative; lra]].
    apply covered. apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  destruct (counted_few (Z.max ka kb) ltac:(lia)) as [K0 K].
  assert (PS : 0 <= fl (sa + sb)) by (apply rnd_nonnegative; lra).
  destruct (rounding_facts (fl (a + b))) as [NR PR].
  assert (P2 : 0 <= fl (rounding (fl (a + b)) + fl (sa + sb))) by (apply rnd_nonnegative; lra).
  split; [apply rnd_number |]. split; [apply (Tight.tight_add_number p emin nearest) |]. split; [apply rnd_number |].
  split; [| split; [exact K0 | split; [exact V |]]].
  - apply Upper.sum_of_bounds_sound; auto with typeclass_instances; try lia; [lra |].
    apply rnd_nonnegative, Rmult_le_pos; [exact P2 |].
    apply rnd_above; auto with typeclass_instances; [apply number_0 |].
    assert (0 <= fl (8 * eps)) by (apply rnd_nonnegative; generalize (eps_positive p); lra). lra.
  - intros Few. apply K in Few. destruct Few as [Few EK]. rewrite EK, power_succ by lia. split; [| lia].
    destruct (HA ltac:(lia)) as [SA _], (HB ltac:(lia)) as [SB _]. clear HA HB.
    assert (GA := power_le ka (Z.max ka kb) ltac:(lia)). assert (GB := power_le kb (Z.max ka kb) ltac:(lia)).
    assert (G1 := power_1 (Z.max ka kb)). set (G := power (Z.max ka kb)) in *.
    generalize c_range u_256 f_1 (eps_positive p). intros C U F1 Pe.
    assert (Given : sa + sb <= c * (G - 1) * B).
    { apply Rle_trans with (c * (G - 1) * (Ba + Bb)); [| apply Rmult_le_compat_l; [nra | exact S]].
      apply Rle_trans with (c * (power ka - 1) * Ba + c * (power kb - 1) * Bb); [lra |].
      rewrite Rmult_plus_distr_l.
      apply Rplus_le_compat; apply Rmult_le_compat_r; try lra; apply Rmult_le_compat_l; lra. }
    set (h := (1 + 32 * u) * (1 + u) ^ 2).
    assert (Own := own_of_sum (fl (a + b)) B V L). fold h in Own.
    assert (Ph : 0 <= h) by (unfold h; apply Rmult_le_pos; [lra | apply pow_le; lra]).
    assert (Hf : (1 + u) * h <= f).
    { apply Rle_trans with (2 := all_roundings).
      replace ((1 + 32 * u) * (1 + u) ^ 6) with ((1 + u) * h * (1 + u) ^ 3) by (unfold h; ring).
      assert (1 <= (1 + u) ^ 3) by (apply pow_R1_Rle; lra). assert (0 <= (1 + u) * h) by nra.
      assert ((1 + u) * h * 1 <= (1 + u) * h * (1 + u) ^ 3) by (apply Rmult_le_compat_l; lra).
      assert (0 <= eps * ((1 + u) * h * (1 + u) ^ 3)) by (apply Rmult_le_pos; lra). lra. }
    apply Rle_trans with (1 := Upper.sum_of_bounds_at_most _ _ _ _ _ _ _).
    unfold Tight.tight_enlarged. set (R := rounding (fl (a + b))) in *.
    apply Rle_trans with (1 := up_inflated _ (rnd_number _) P2).
    apply Rle_trans with ((R + (sa + sb) * (1 + u)) * h).
    + replace ((R + (sa + sb) * (1 + u)) * h)
        with ((R + (sa + sb) * (1 + u)) * (1 + u) * ((1 + 32 * u) * (1 + u))) by (unfold h; ring).
      rewrite Rmult_assoc. apply Rmult_le_compat_r; [apply Rmult_le_pos; lra |].
      apply Rle_trans with (1 := up_sum _ _ NR (rnd_number _) PR PS). apply Rmult_le_compat_r; [lra |].
      generalize (up_sum _ _ NSA NSB PSA PSB). lra.
    + replace (c * (G * f - 1) * B) with (c * (f - 1) * B + f * (c * (G - 1) * B)) by ring. rewrite c_own.
      rewrite Rmult_plus_distr_r. apply Rplus_le_compat; [lra |].
      replace ((sa + sb) * (1 + u) * h) with ((1 + u) * h * (sa + sb)) by ring. apply Rmult_le_compat; try lra.
      apply Rmult_le_pos; lra.
Qed.
(** An operation's own error and losses, in a product's bound. *)
Lemma own_of_product v B : Rabs v <= B -> least <= B -> smallest_normal <= B ->
  (Rabs v * (eps * (1 + eps))) * ((1 + 32 * u) * (1 + u) ^ 6) + 11 / 2 * eta * ((1 + 32 * u) * (1 + u) ^ 6) <=
  D * f * (eps * B).
Proof.
  intros V L M. generalize (lost_share B L M) all_roundings (eps_positive p) u_256 (eta_positive emin) f_1 (Rabs_pos v).
  set (h := (1 + 32 * u) * (1 + u) ^ 6). intros S A Pe U Ph F PV.
  assert (H : 0 <= h) by (unfold h; apply Rmult_le_pos; [lra | apply pow_le; lra]).
  assert (W : Rabs v * (eps * (1 + eps)) * h <= f * (eps * B)).
  { replace (Rabs v * (eps * (1 + eps)) * h) with ((1 + eps) * h * (eps * Rabs v)) by ring.
    apply Rmult_le_compat; try apply Rmult_le_pos; try lra. apply Rmult_le_compat_l; lra. }
  assert (Hh : h <= f) by (apply Rle_trans with (2 := A); nra).
  assert (T : 11 / 2 * eta * h <= (D - 1) * (eps * B) * f) by (apply Rmult_le_compat; lra).
  lra.
Qed.

Lemma product_carries a sa Ba ka b sb Bb kb B :
  carries a sa Ba ka -> carries b sb Bb kb -> B = safe_multiply a Ba ka b Bb kb -> fst B = 0 \/ least <= fst B ->
  carries (fl (a * b)) (tight_multiply (fl (a * b)) a sa b sb) (fst B) (snd B).
Proof.
  intros (NA & NSA & NBA & PSA & PKA & VA & HA) (NB & NSB & NBB & PSB & PKB & VB & HB) EB L.
  generalize (Rabs_pos a) (Rabs_pos b) (eps_positive p) u_256 (eta_positive emin) c_range f_1.
  intros PA PB Pe U Ph C F1.
  assert (N0 : a * b = 0 -> carries (fl (a * b)) (rounding (fl (a * b))) (fst B) (snd B)).
  { intros Z. rewrite Z, Tight.rounding_0, Format.rnd_0 by auto with typeclass_instances.
    assert (PB' : number (fst B) /\ 0 <= fst B /\ (0 <= snd B <= Safe.too_many)%Z).
    { rewrite EB. unfold Safe.safe_multiply. destruct (_ || _); cbn [fst snd].
      - split; [apply number_0 | split; [lra | easy]].
      - generalize (smallest_normal_positive p emin) (proj1 (counted_few (ka + kb) ltac:(lia))). intros M K.
        split; [| split; [| exact K]].
        + apply Rmax_case; [apply rnd_number | now apply number_smallest_normal].
        + apply Rle_trans with (2 := Rmax_r _ _). lra. }
    destruct PB' as (N1 & P1 & P2). unfold carries. rewrite Rabs_R0.
    split; [apply number_0 |]. split; [apply number_0 |]. split; [exact N1 |]. split; [lra |].
    split; [exact P2 |]. split; [exact P1 |]. intros _. split; [| auto].
    generalize (power_1 (snd B)). intros G. repeat apply Rmult_le_pos; lra. }
  unfold Tight.tight_multiply, AbsoluteBound.multiply, AbsoluteBound.total. cbv zeta.
  destruct (AbsoluteBound.is_zero a sa || AbsoluteBound.is_zero b sb) eqn:TZ.
  { apply N0. apply orb_prop in TZ.
    destruct TZ as [TZ | TZ]; apply AbsoluteBound.is_zero_true in TZ; destruct TZ as [-> _]; ring. }
  clear N0. unfold Safe.safe_multiply in EB. destruct (Safe.is_zero a ka || Safe.is_zero b kb) eqn:SZ.
  { exfalso. assert (Q : forall x s X k, ((k < Safe.too_many)%Z -> s <= c * (power k - 1) * X /\ (k = 0%Z -> s = 0)) ->
      AbsoluteBound.is_zero x s = false -> Safe.is_zero x k = false).
    { intros x s X k H. unfold AbsoluteBound.is_zero, Safe.is_zero. destruct (Req_bool x 0); auto. cbn [andb].
      destruct (Z.eqb_spec k 0) as [-> | ]; auto. destruct (H ltac:(reflexivity)) as [_ H0].
      rewrite Req_bool_true; auto. }
    apply orb_false_elim in TZ. destruct TZ as [T1 T2].
    rewrite (Q _ _ _ _ HA T1), (Q _ _ _ _ HB T2) in SZ. discriminate. }
  subst B. cbn [fst snd] in *. set (B := Rmax (Safe.enlarged p emin nearest (fl (Ba * Bb))) smallest_normal) in *.
  assert (PP : 0 <= Ba * Bb) by (apply Rmult_le_pos; lra).
  assert (M : smallest_normal <= B) by apply Rmax_r.
  assert (P0 := smallest_normal_positive p emin).
  assert (LB : least <= B) by (destruct L; lra). clear L.
  assert (S : Ba * Bb <= B).
  { destruct (Rlt_or_le (Ba * Bb) smallest_normal) as [D1 | D1]; [lra |].
    apply Rle_trans with (2 := Rmax_l _ _). apply (Safe.enlarged_above p emin nearest p_3 emin_p _ _ E g_q3); auto.
    - apply (Format.rnd_relative p emin nearest _ _ E). exact D1.
    - intros D2. apply (Format.rnd_subnormal p emin nearest) in D2. lra. }
  assert (V : Rabs (fl (a * b)) <= B).
  { apply Rle_trans with (fl (Ba * Bb)).
    - apply covered. rewrite Rabs_mult. apply Rmult_le_compat; lra.
    - apply Rle_trans with (2 := Rmax_l _ _). apply enlarged_more; [apply rnd_number | now apply rnd_nonnegative]. }
  destruct (counted_few (ka + kb) ltac:(lia)) as [K0 K].
  destruct (rounding_facts (fl (a * b))) as [NR PR]. set (R := rounding (fl (a * b))) in *.
  rewrite (rnd_exact (4 * eta)) by (apply (Tight.number_4_eta p emin)).
  set (t := fl (Rabs b + sb)). set (P1 := fl (Rabs a * sb)). set (P2 := fl (sa * t)). set (I := fl (P1 + P2)).
  assert (Q1 : 0 <= Rabs a * sb) by (apply Rmult_le_pos; lra).
  assert (Pt : 0 <= t) by (apply rnd_nonnegative; lra).
  assert (Q2 : 0 <= sa * t) by (apply Rmult_le_pos; lra).
  assert (PP1 : 0 <= P1) by now apply rnd_nonnegative. assert (PP2 : 0 <= P2) by now apply rnd_nonnegative.
  assert (PI : 0 <= I) by (apply rnd_nonnegative; lra).
  assert (PRI : 0 <= fl (R + I)) by (apply rnd_nonnegative; lra).
  assert (PS : 0 <= fl (fl (R + I) + 4 * eta)) by (apply rnd_nonnegative; lra).
  split; [apply rnd_number |]. split; [apply rnd_number |].
  split; [apply Rmax_case; [apply rnd_number | now apply number_smallest_normal] |].
  split; [| split; [exact K0 | split; [exact V |]]].
  - apply rnd_nonnegative, Rmult_le_pos; [exact PS |].
    apply rnd_above; auto with typeclass_instances; [apply number_0 |].
    assert (0 <= fl (8 * eps)) by (apply rnd_nonnegative; lra). lra.
  - intros Few. apply K in Few. destruct Few as [Few EK]. rewrite EK, power_succ by lia. split; [| lia].
    destruct (HA ltac:(lia)) as [SA _], (HB ltac:(lia)) as [SB _]. clear HA HB.
    rewrite Z2Nat.inj_add, pow_add by lia.
    assert (G1 := power_1 ka). assert (G2 := power_1 kb). set (Ga := power ka) in *. set (Gb := power kb) in *.
    set (T := Rabs a * sb + sa * (Rabs b + sb)).
    assert (PT : 0 <= T) by (unfold T; assert (0 <= sa * (Rabs b + sb)) by (apply Rmult_le_pos; lra); lra).
    assert (Given : T <= c * (Ga * Gb - 1) * B).
    { apply Rle_trans with (c * (Ga * Gb - 1) * (Ba * Bb)).
      - apply Rle_trans with (Ba * (c * (Gb - 1) * Bb) + c * (Ga - 1) * Ba * (Bb + c * (Gb - 1) * Bb)).
        + unfold T. assert (0 <= c * (Ga - 1) * Ba) by (repeat apply Rmult_le_pos; lra).
          apply Rplus_le_compat; apply Rmult_le_compat; lra.
        + replace (Ba * (c * (Gb - 1) * Bb) + c * (Ga - 1) * Ba * (Bb + c * (Gb - 1) * Bb))
            with (c * (Ba * Bb) * ((Gb - 1) + (Ga - 1) + c * ((Ga - 1) * (Gb - 1)))) by ring.
          replace (c * (Ga * Gb - 1) * (Ba * Bb))
            with (c * (Ba * Bb) * ((Gb - 1) + (Ga - 1) + 1 * ((Ga - 1) * (Gb - 1)))) by ring.
          apply Rmult_le_compat_l; [apply Rmult_le_pos; lra |].
          assert (c * ((Ga - 1) * (Gb - 1)) <= 1 * ((Ga - 1) * (Gb - 1)));
            [apply Rmult_le_compat_r; [apply Rmult_le_pos |]; lra | lra].
      - apply Rmult_le_compat_l; [| exact S]. apply Rmult_le_pos; [lra |]. nra. }
    set (q := 1 + u). assert (Hq : 1 <= q) by (unfold q; lra).
    assert (Step : forall x n, 0 <= x -> x * q ^ n <= x * q ^ (1 + n)).
    { intros x n P. apply Rmult_le_compat_l; auto. apply Rle_pow; [auto | lia]. }
    assert (HI : I <= T * q ^ 3 + eta * q).
    { assert (H1 := up _ Q1). fold P1 q in H1. assert (H2 := up _ Q2). fold P2 q in H2.
      assert (H3 := up_sum _ _ (number_abs _ _ _ NB) NSB PB PSB). fold t q in H3.
      assert (H4 := up_sum P1 P2 (rnd_number _) (rnd_number _) PP1 PP2). fold I q in H4.
      assert (H5 : sa * t <= sa * (Rabs b + sb) * q).
      { rewrite Rmult_assoc. apply Rmult_le_compat_l; lra. }
      apply Rle_trans with (1 := H4).
      replace (T * q ^ 3 + eta * q) with ((T * q ^ 2 + eta) * q) by ring. apply Rmult_le_compat_r; [lra |].
      unfold T. generalize (Step (Rabs a * sb) 1%nat Q1). intros H6.
      assert (sa * t * q <= sa * (Rabs b + sb) * q * q) by (apply Rmult_le_compat_r; lra).
      simpl in H6 |- *. lra. }
    assert (HR := proj1 (up_rounding (fl (a * b)))). fold R q in HR.
    set (w := Rabs (fl (a * b)) * (eps * (1 + eps))) in *.
    assert (PW : 0 <= w) by (unfold w; repeat apply Rmult_le_pos; try lra; apply Rabs_pos).
    apply Rle_trans with (1 := up_inflated _ (rnd_number _) PS).
    set (h := 1 + 32 * u).
    assert (HS : fl (fl (R + I) + 4 * eta) <= (w + T) * q ^ 5 + 11 / 2 * eta * q ^ 5).
    { assert (N4 : number (4 * eta)) by (apply (Tight.number_4_eta p emin)).
      assert (H1 := up_sum R I NR (rnd_number _) PR PI). fold q in H1.
      assert (H2 := up_sum (fl (R + I)) (4 * eta) (rnd_number _) N4 PRI ltac:(lra)). fold q in H2.
      assert (Q : 1 <= q ^ 2 /\ q <= q ^ 4 /\ q ^ 2 <= q ^ 4 /\ q ^ 3 <= q ^ 4).
      { split; [now apply pow_R1_Rle |]. rewrite <- (pow_1 q) at 1. repeat split; apply Rle_pow; auto. }
      apply Rle_trans with (1 := H2).
      replace ((w + T) * q ^ 5 + 11 / 2 * eta * q ^ 5) with (((w + T) * q ^ 4 + 11 / 2 * eta * q ^ 4) * q) by ring.
      apply Rmult_le_compat_r; [lra |].
      assert (H3 : (R + I) * q <= (w * q + eta / 2 + (T * q ^ 3 + eta * q)) * q) by (apply Rmult_le_compat_r; lra).
      assert (H4 : w * q * q <= w * q ^ 4).
      { replace (w * q * q) with (w * q ^ 2) by ring. apply Rmult_le_compat_l; lra. }
      assert (H5 : eta * q <= eta * q ^ 4) by (apply Rmult_le_compat_l; lra).
      assert (H6 : eta * q ^ 2 <= eta * q ^ 4) by (apply Rmult_le_compat_l; lra).
      assert (H7 : eta * 1 <= eta * q ^ 4) by (apply Rmult_le_compat_l; lra).
      replace ((w * q + eta / 2 + (T * q ^ 3 + eta * q)) * q)
        with (w * q * q + / 2 * (eta * q) + T * q ^ 4 + eta * q ^ 2) in H3 by (field; auto). lra. }
    apply Rle_trans with (((w + T) * q ^ 5 + 11 / 2 * eta * q ^ 5) * h * q).
    { apply Rmult_le_compat_r; [lra |]. apply Rmult_le_compat_r; [unfold h; lra | exact HS]. }
    assert (Own := own_of_product (fl (a * b)) B V LB M). fold w h q in Own.
    replace (((w + T) * q ^ 5 + 11 / 2 * eta * q ^ 5) * h * q)
      with (w * (h * q ^ 6) + 11 / 2 * eta * (h * q ^ 6) + T * (h * q ^ 6)) by ring.
    replace (c * (Ga * Gb * f - 1) * B) with (c * (f - 1) * B + c * (Ga * Gb - 1) * B * f) by ring. rewrite c_own.
    apply Rplus_le_compat; [lra |].
    assert (A := all_roundings). fold h q in A. assert (0 <= h * q ^ 6) by (apply Rmult_le_pos; [unfold h; lra | apply pow_le; lra]).
    apply Rmult_le_compat; try lra. nra.
Qed.

Lemma computed_carries v s B k : computed least v s B k -> carries v s B k.
Proof.
  induction 1 as [v N | v error B N NE PE -> | a sa Ba ka b sb Bb kb v B _ IA _ IB -> EB L
                  | a sa Ba ka b sb Bb kb v B _ IA _ IB -> EB L | a sa Ba ka b sb Bb kb v B _ IA _ IB -> EB L].
  - assert (Z : Tight.tight_exact p emin nearest v = 0).
    { unfold Tight.tight_exact. rewrite Rminus_eq_0. apply Format.rnd_0; auto with typeclass_instances. }
    rewrite Z. split; [exact N |]. split; [apply number_0 |]. split; [now apply number_abs |].
    split; [lra |]. split; [easy |]. split; [apply Rle_refl |]. simpl. lra.
  - assert (Z : Tight.tight_within p emin nearest v error = error).
    { unfold Tight.tight_within. rewrite Rminus_eq_0, Format.rnd_0, Rplus_0_r by auto with typeclass_instances.
      now apply rnd_exact. }
    rewrite Z. generalize (eps_positive p) (Rabs_pos v) c_range c_own f_1. intros Pe PV C CO F.
    unfold Safe.safe_within. cbn [fst snd].
    assert (NQ : fl (error / eps) = error / eps).
    { unfold Rdiv, Format.eps. rewrite <- bpow_opp. apply (Format.scale_up p emin nearest); auto. lia. }
    assert (PQ : 0 <= error / eps) by (apply Rlt_le, Rdiv_lt_0_compat; lra).
    set (m := Rmax (fl (Rabs v + error)) (fl (error / eps))).
    assert (Nm : number m) by (unfold m; apply Rmax_case; apply rnd_number).
    assert (M1 : Rabs v <= m).
    { apply Rle_trans with (2 := Rmax_l _ _). apply rnd_above; auto with typeclass_instances; [now apply number_abs | lra]. }
    assert (M2 : error / eps <= m) by (rewrite <- NQ; apply Rmax_r).
    assert (M3 := enlarged_more m Nm ltac:(lra)).
    split; [exact N |]. split; [exact NE |]. split; [apply rnd_number |]. split; [lra |]. split; [easy |].
    split; [lra |]. intros _. split; [| discriminate]. change (power 1) with (f * 1). rewrite Rmult_1_r, CO.
    replace error with (1 * (eps * (error / eps))) by (field; lra). rewrite (Rmult_assoc (D * f)).
    assert (0 <= eps * (error / eps)) by (apply Rmult_le_pos; lra).
    assert (1 <= D * f) by nra. apply Rmult_le_compat; try lra. apply Rmult_le_compat_l; lra.
  - now apply sum_carries with (1 := IA) (2 := IB).
  - replace (a - b) with (a + - b) by ring. apply sum_carries with (1 := IA) (4 := L) (3 := EB).
    destruct IB as (N & H). split; [now apply number_opp |]. now rewrite Rabs_Ropp.
  - now apply product_carries with (1 := IA) (2 := IB).
Qed.

(** c (f^k - 1) B is little more than k eps B, and safe's error is at least that. *)
Lemma power_above n : f * (f ^ n - 1) <= INR n * (f - 1) * f ^ n.
Proof.
  generalize f_1. intros F. induction n as [| n IH]; [simpl; lra |]. rewrite S_INR, <- tech_pow_Rmult.
  assert (G : 1 <= f ^ n) by now apply pow_R1_Rle.
  assert (0 <= INR n * (f - 1) * f ^ n) by (generalize (pos_INR n); intros; repeat apply Rmult_le_pos; lra).
  assert (INR n * (f - 1) * f ^ n * 1 <= INR n * (f - 1) * f ^ n * f) by (apply Rmult_le_compat_l; lra). lra.
Qed.
Lemma compared v s B k e : computed least v s B k -> safe_error B k = Some e -> s <= D * f ^ Z.to_nat k * e.
Proof.
  intros H He. apply computed_carries in H. destruct H as (_ & _ & NB & _ & PK & VB & H).
  generalize (Rabs_pos v) (eps_positive p) f_1 (power_1 k). intros PV Pe F G.
  assert (K : k <> Safe.too_many).
  { intros ->. unfold Safe.safe_error in He. rewrite Z.eqb_refl, orb_true_r in He. discriminate. }
  destruct (H ltac:(lia)) as [S _]. clear H. set (n := Z.to_nat k) in *.
  assert (P1 : 1 + INR n * eps <= (1 + eps) ^ n) by now apply poly.
  assert (Le : B * ((1 + eps) ^ n - 1) <= e).
  { replace (B * ((1 + eps) ^ n - 1)) with (Rabs (B * ((1 + eps) ^ n - 1) - 0)).
    - apply (Safe.safe_error_sound p emin nearest (or_introl (Z.le_trans 4 8 p ltac:(lia) p_8)) emin_p) with (3 := He); auto.
      split; [exact NB |]. split; [apply PK |]. cbn [fst snd]. rewrite Rabs_R0. split; [lra |].
      rewrite Rminus_0_r, Rabs_pos_eq; [apply Rle_refl |]. apply Rmult_le_pos; [lra |].
      generalize (pos_INR n). nra.
    - rewrite Rminus_0_r. apply Rabs_pos_eq. apply Rmult_le_pos; [lra |]. generalize (pos_INR n). nra. }
  apply Rle_trans with (1 := S). apply Rle_trans with (D * f ^ n * (B * (INR n * eps))).
  - replace (D * f ^ n * (B * (INR n * eps))) with (D / 22 * (INR n * (f - 1) * f ^ n) * B) by (unfold f at 1; field).
    apply Rmult_le_compat_r; [lra |]. unfold c. unfold Rdiv.
    replace (D * f * / 22 * (f ^ n - 1)) with (D * / 22 * (f * (f ^ n - 1))) by ring.
    apply Rmult_le_compat_l; [lra | apply power_above].
  - apply Rmult_le_compat_l; [apply Rmult_le_pos; lra |]. apply Rle_trans with (2 := Le).
    apply Rmult_le_compat_l; lra.
Qed.

End Computed.

Section Theorems.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (p_8 : (8 <= p)%Z) (emin_2p : (emin <= 2 - 2 * p)%Z).
Notation eps := (eps p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).

(** The theorem if no B except 0 is below `least`. *)
Theorem tight_at_most_safe_computed least v s B k e : smallest_normal <= least ->
  computed p emin least v s B k -> Safe.safe_error p emin nearest B k = Some e ->
  s <= (1 + 6 * smallest_normal / least) * (1 + 22 * eps) ^ Z.to_nat k * e.
Proof.
  generalize (smallest_normal_positive p emin). intros P L.
  assert (H : 0 <= 6 * smallest_normal / least <= 6).
  { split; [apply Rlt_le, Rdiv_lt_0_compat; lra |]. apply Rmult_le_reg_r with least; [lra |].
    unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. }
  apply (compared p emin p_8 emin_2p (1 + 6 * smallest_normal / least) least); [lra |].
  rewrite Rmax_left by auto. right. field. lra.
Qed.
(** The theorem with any underflow. *)
Theorem tight_at_most_safe_always v s B k e :
  computed p emin 0 v s B k -> Safe.safe_error p emin nearest B k = Some e ->
  s <= 7 * (1 + 22 * eps) ^ Z.to_nat k * e.
Proof.
  apply (compared p emin p_8 emin_2p 7 0); [lra |].
  generalize (smallest_normal_positive p emin) (Rmax_r 0 smallest_normal). lra.
Qed.

(** eta eta with exact factors. *)
Theorem underflowed_tight_exceeds :
  let v := rnd p emin nearest (eta * eta) in
  let exact := Tight.tight_exact p emin nearest eta in
  let s := Tight.tight_multiply p emin nearest v eta exact eta exact in
  let (B, k) := Safe.safe_multiply p emin nearest eta (Rabs eta) 0 eta (Rabs eta) 0 in
  computed p emin 0 v s B k /\
  exists e, Safe.safe_error p emin nearest B k = Some e /\ 4 * eta <= s /\ e <= 2 * eta.
Proof.
  assert (N : number p emin eta) by now apply number_eta.
  generalize (eta_positive emin) (eps_positive p) (smallest_normal_positive p emin) (u_256 p p_8) (eps_2u p).
  intros Pe Ps Pm U E2.
  assert (Z1 : rnd p emin nearest 1 = 1).
  { apply (rnd_exact p emin nearest). change 1 with (bpow radix2 0). apply number_power; auto. lia. }
  assert (Lost : rnd p emin nearest (eta * eta) = 0).
  { assert (eta <= / 4) by (change (/ 4) with (bpow radix2 (-2)); apply bpow_le; lia).
    apply Rle_antisym; [| apply (rnd_nonnegative p emin nearest); nra].
    rewrite <- (Rplus_0_l (eta * eta)). apply (up_lost p emin 0 (eta * eta)); [apply number_0 | lra | nra]. }
  set (B := Safe.safe_multiply p emin nearest eta (Rabs eta) 0 eta (Rabs eta) 0).
  assert (EB : B = (smallest_normal, 1%Z)).
  { unfold B, Safe.safe_multiply, Safe.is_zero. rewrite Req_bool_false by lra. cbn [andb orb].
    rewrite Rabs_pos_eq, Lost by lra. unfold Safe.enlarged. rewrite Rmult_0_l, (rnd_0 p emin nearest).
    now rewrite Rmax_right by lra. }
  assert (P3 : (3 <= p)%Z) by lia. assert (Pp : (emin <= - p)%Z) by lia.
  cbv zeta. fold B. rewrite EB. split; [| eexists; split; [| split]].
  { pose proof (exact_number p emin 0 eta N) as Exact.
    assert (C := product p emin 0 _ _ _ _ _ _ _ _ _ B Exact Exact eq_refl eq_refl). rewrite EB in C. apply C.
    cbn [fst]. lra. }
  { unfold Safe.safe_error. cbv zeta.
    rewrite Z1, Rmult_1_l, (rnd_exact p emin nearest eps) by (apply number_power; auto; lia).
    rewrite Rle_bool_true by lra. reflexivity. }
  - replace (Tight.tight_exact p emin nearest eta) with 0
      by (unfold Tight.tight_exact; rewrite Rminus_eq_0; symmetry; apply (rnd_0 p emin nearest)).
    unfold Tight.tight_multiply, AbsoluteBound.multiply, AbsoluteBound.total, AbsoluteBound.is_zero.
    rewrite Req_bool_false by lra. cbn [andb orb]. cbv zeta.
    rewrite (Tight.inflated_exact p emin nearest P3 Pp).
    assert (Np : forall x, 0 <= x -> 0 <= rnd p emin nearest x) by (intros; now apply (rnd_nonnegative p emin nearest)).
    assert (N4 : number p emin (4 * eta)) by apply (Tight.number_4_eta p emin).
    rewrite (rnd_exact p emin nearest (4 * eta) N4).
    assert (L : 4 * eta <= rnd p emin nearest
      (rnd p emin nearest (Tight.rounding p emin nearest (rnd p emin nearest (eta * eta)) +
        rnd p emin nearest (rnd p emin nearest (Rabs eta * 0) + rnd p emin nearest (0 * rnd p emin nearest (Rabs eta + 0)))) +
       4 * eta)).
    { apply (rnd_above p emin nearest); auto. generalize (proj2 (rounding_facts p emin p_8 emin_2p (rnd p emin nearest (eta * eta)))).
      intros R. assert (H : forall x, 0 <= x -> 4 * eta <= x + 4 * eta) by (intros; lra). apply H, Np.
      apply Rplus_le_le_0_compat; auto. apply Np, Rplus_le_le_0_compat; apply Np; [rewrite Rmult_0_r | rewrite Rmult_0_l]; lra. }
    apply Rle_trans with (1 := L). apply (scaled_up p emin nearest); [apply rnd_number; auto with typeclass_instances | lra | lra].
  - rewrite !(Safe.enlarged_exact p emin nearest P3 Pp).
    set (y := rnd p emin nearest (rnd p emin nearest (eps * rnd p emin nearest (1 + eps)) * (1 + 4 * eps))).
    assert (Y : smallest_normal * y <= eta + eta / 4).
    { rewrite <- (smallest_normal_eps p emin). replace (smallest_normal * eps + smallest_normal * eps / 4)
        with (smallest_normal * (5 / 4 * eps)) by field. apply Rmult_le_compat_l; [lra |].
      unfold y. rewrite (factor_exact p emin p_8 emin_2p). assert (0 <= eps * (1 + eps) * (1 + 4 * eps)) by nra.
      apply Rle_trans with (1 := up p emin p_8 _ H). assert (eta <= eps * / 8).
      { change (/ 8) with (bpow radix2 (-3)). unfold Format.eta, Format.eps. rewrite <- bpow_plus. apply bpow_le. lia. }
      nra. }
    assert (W : rnd p emin nearest (smallest_normal * y) <= eta).
    { apply Rle_trans with (rnd p emin nearest (eta + eta / 4)); [now apply (rnd_le p emin nearest) |].
      apply (up_lost p emin eta (eta / 4)); auto; lra. }
    assert (N2 : number p emin (eta + eta)).
    { replace (eta + eta) with (2 * eta) by ring. apply (Tight.number_2_eta p emin). }
    assert (W2 : rnd p emin nearest (rnd p emin nearest (smallest_normal * y) + eta) <= eta + eta).
    { apply (rnd_below p emin nearest); auto. lra. }
    apply Rle_trans with (rnd p emin nearest ((eta + eta) + (eta + eta) * (4 * eps))).
    { apply (rnd_le p emin nearest). apply Rle_trans with ((eta + eta) * (1 + 4 * eps)); [| lra].
      apply Rmult_le_compat_r; lra. }
    apply Rle_trans with (eta + eta); [| lra]. apply (up_lost p emin); auto; nra.
Qed.
End Theorems.

(** 1 times 1, n times: its value, tight's error and safe's bound, as the code computes them. *)
Section Ones.
Context (T : Type) (A : Code.arithmetic T).
Fixpoint ones_multiplied (n : nat) : T * T * (T * Z) :=
  let number v := (v, Code.tight_exact T A v, Code.safe_exact T A v) in
  match n with
  | O => number (Code.integer T A 1)
  | S n =>
      let '(a, sa, (Ba, ka)) := ones_multiplied n in
      let '(b, sb, (Bb, kb)) := number (Code.integer T A 1) in
      let v := Code.times T A a b in
      (v, Code.tight_multiply T A v a sa b sb, Code.safe_multiply T A a Ba ka b Bb kb)
  end.
Definition tight_exceeds (n : nat) : bool :=
  let '(v, s, (B, k)) := ones_multiplied n in Code.less T A (Code.safe_error T A v B k) s.
End Ones.
Theorem computed_tight_may_exceed (p := 8%Z) (emax := 128%Z) :
  tight_exceeds _ (Ieee.floats p emax (p_positive := eq_refl) (p_below := eq_refl)) 70 = true.
Proof. vm_compute. reflexivity. Qed.
