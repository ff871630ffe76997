(** Bound rule `interval` (include/errbound/rules/interval.hpp) over IEEE formats (Ieee.v), to nearest, including
    overflow; p >= 3, emax > p. A number x with value a is known by two floats if all are finite and both a and x lie
    between the floats. It is also known by -infinity and +infinity. Products and quotients are with fused
    multiply-add and without (`fused`). two_sum overflows after its sum only to NaN (two_sum_known). Results: the
    bounds that the code returns hold:
        interval_exact_known, interval_within_known, interval_negate_known, interval_add_known,
        interval_subtract_known, interval_multiply_known, interval_divide_known, interval_scale_known
        interval_sign_known   the rule's sign is right or uncertain
        interval_error_known  if the error is finite, so is the value, and |a - x| is at most the error
        product_known, remainder_known   results that product_error_is_exact and remainder_of_division_exact call
                              exact are, even after an overflow *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core IEEE754.BinarySingleNaN Sterbenz.
From Errbound Require Import Code Ieee IeeeRules.
From Errbound Require Format Interval ErrorFree.
Open Scope R_scope.

Section Rules.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_3 : (3 <= p)%Z).
Variable fused : bool.  (* has_fast_fma *)
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation format := (FLT_exp emin p).
Notation fl := (Format.rnd p emin Format.nearest).
Notation number := (Format.number p emin).
Notation emin_p := (emin_p p emax p_3).

Notation minus_infinity := (B754_infinity true : float).
Notation plus_infinity := (B754_infinity false : float).

(** A number x with value a lies between the ends, or is unknown. *)
Definition interval_known (a : float) (b : float * float) (x : R) : Prop :=
  b = (minus_infinity, plus_infinity) \/
  (finite (fst b) /\ finite (snd b) /\ finite a /\
   B2R (fst b) <= B2R a <= B2R (snd b) /\ B2R (fst b) <= x <= B2R (snd b)).

Lemma checked_known v lower upper x :
  (finite v -> finite lower -> finite upper -> B2R lower <= B2R v <= B2R upper ->
   B2R lower <= x <= B2R upper) ->
  interval_known v (interval_checked _ F v lower upper) x.
Proof.
  intros K. unfold interval_checked.
  destruct (less _ F (opposite _ F (infinity _ F)) lower && at_most _ F lower v &&
            at_most _ F v upper && less _ F upper (infinity _ F)) eqn:C; [right | now left].
  apply andb_prop in C. destruct C as [C C4]. apply andb_prop in C. destruct C as [C C3].
  apply andb_prop in C. destruct C as [C1 C2].
  assert (A : finite lower /\ finite v /\ finite upper).
  { destruct lower as [| s | | ], v as [| t | | ], upper as [| w | | ]; try discriminate; auto;
      try destruct s; try destruct t; try destruct w; discriminate. }
  destruct A as (FL & FV & FU). rewrite at_most_finite in C2, C3 by auto.
  assert (B : B2R lower <= B2R v <= B2R upper).
  { revert C2 C3. do 2 case Rle_bool_spec; try discriminate. auto. }
  cbn [fst snd]. generalize (K FV FL FU B). tauto.
Qed.

Lemma five_quarters_value : finite (five_quarters _ F) /\ B2R (five_quarters _ F) = 5 / 4.
Proof.
  generalize (constant_value p emax 5 (-2)). intros C.
  replace (5 / 4) with (IZR 5 * bpow radix2 (-2)) by (simpl; lra).
  generalize (p_emax p emax). intros L. apply C.
  - apply Format.number_integer; auto; [lia |]. apply Z.le_trans with (2 ^ 3)%Z; [simpl; lia |].
    apply Z.pow_le_mono_r; lia.
  - apply Rlt_le_trans with (bpow radix2 1).
    + rewrite Rabs_pos_eq; simpl; lra.
    + apply bpow_le. lia.
Qed.
Lemma step_finite c : finite (step _ F c) ->
  finite c /\ B2R (step _ F c) = Interval.step p emin (B2R c).
Proof.
  unfold step, Interval.step. intros H. apply plus_finite in H. destruct H as (H & _ & E1).
  apply times_finite in H. destruct H as (H & _ & E2). apply times_finite in H. destruct H as (H & _ & E3).
  apply (abs_finite p emax p_3) in H. destruct H as [H E4]. split; auto.
  rewrite E1, E2, E3, E4, (proj2 five_quarters_value), (proj2 (u_value p emax p_3)),
    (proj2 (eta_value p emax p_3)). reflexivity.
Qed.
Lemma below_finite c : finite (below _ F c) ->
  finite c /\ B2R (below _ F c) = Interval.below p emin (B2R c).
Proof.
  unfold below, Interval.below. intros H. apply minus_finite in H. destruct H as (C & H & E).
  apply step_finite in H. destruct H as [_ H]. split; auto. now rewrite E, H.
Qed.
Lemma above_finite c : finite (above _ F c) ->
  finite c /\ B2R (above _ F c) = Interval.above p emin (B2R c).
Proof.
  unfold above, Interval.above. intros H. apply plus_finite in H. destruct H as (C & H & E).
  apply step_finite in H. destruct H as [_ H]. split; auto. now rewrite E, H.
Qed.
Lemma below_true c t : finite (below _ F c) -> B2R c <= fl t -> B2R (below _ F c) <= t.
Proof.
  intros H L. apply below_finite in H. destruct H as [_ ->].
  apply (Interval.below_true p emin p_3); auto. apply number_B2R.
Qed.
Lemma above_true c t : finite (above _ F c) -> fl t <= B2R c -> t <= B2R (above _ F c).
Proof.
  intros H L. apply above_finite in H. destruct H as [_ ->].
  apply (Interval.above_true p emin p_3); auto. apply number_B2R.
Qed.

(** Results without overflow. The largest number is M, its ulp U. *)
Let U := bpow radix2 (emax - p).
Let M := bpow radix2 emax - U.
Lemma U_M : 0 < U /\ 7 * U <= M.
Proof.
  unfold M, U. split; [apply bpow_gt_0 |]. replace emax with (p + (emax - p))%Z at 2 by lia.
  rewrite bpow_plus. assert (bpow radix2 3 <= bpow radix2 p) by (apply bpow_le; lia).
  generalize (bpow_gt_0 radix2 (emax - p)). simpl (bpow radix2 3) in *. nra.
Qed.
Lemma le_M (x : float) : Rabs (B2R x) <= M.
Proof. apply (abs_B2R_le_emax_minus_prec p emax p_positive). Qed.
Lemma M_product : M = IZR (2 ^ p - 1) * bpow radix2 (emax - p).
Proof.
  unfold M, U. rewrite minus_IZR, Rmult_minus_distr_r. change 2%Z with (radix_val radix2).
  rewrite IZR_Zpower by lia. rewrite <- bpow_plus. replace (p + (emax - p))%Z with emax by lia. lra.
Qed.
Lemma number_M_times e : (emin <= emax - p + e)%Z -> number (M * bpow radix2 e).
Proof.
  intros H. rewrite M_product, Rmult_assoc, <- bpow_plus. apply Format.number_integer; auto.
  rewrite Z.abs_eq; [lia |]. generalize (Z.pow_pos_nonneg 2 p). lia.
Qed.
Lemma number_M : number M.
Proof.
  rewrite <- (Rmult_1_r M). change 1 with (bpow radix2 0). apply number_M_times.
  generalize (p_emax p emax). lia.
Qed.
Lemma ulp_U z : Rabs z <= M -> ulp radix2 format z <= U.
Proof.
  intros H. generalize U_M (p_emax p emax). intros [PU _] L. unfold U. destruct (Req_dec z 0) as [-> | NZ].
  - rewrite ulp_FLT_small; auto; [apply bpow_le; lia |]. rewrite Rabs_R0. apply bpow_gt_0.
  - rewrite ulp_neq_0 by auto. apply bpow_le. unfold cexp, FLT_exp.
    assert (mag radix2 z <= emax)%Z. { apply mag_le_bpow; auto. unfold M in H. lra. }
    lia.
Qed.
Lemma rounded_fits w : Rabs w < M + U / 2 -> Rabs (fl w) <= M.
Proof.
  assert (Up : forall v, v < M + U / 2 -> fl v <= M).
  { intros v H. apply round_N_le_midp; auto with typeclass_instances; [apply number_M |].
    generalize U_M. intros [PU LM]. rewrite succ_eq_pos by lra.
    enough (U <= ulp radix2 format M) by lra. rewrite ulp_neq_0 by lra. apply bpow_le.
    unfold cexp, FLT_exp. enough (emax <= mag radix2 M)%Z by lia. apply mag_ge_bpow.
    rewrite Rabs_pos_eq by lra. unfold M, U. replace emax with (1 + (emax - 1))%Z at 2 by lia.
    rewrite bpow_plus. simpl (bpow radix2 1).
    assert (bpow radix2 (emax - p) <= bpow radix2 (emax - 1)) by (apply bpow_le; lia). lra. }
  intros H. apply Rabs_def2 in H. apply Rabs_le. split; [| apply Up; lra].
  assert (fl (- w) <= M) by (apply Up; lra). rewrite (Interval.fl_opp p emin) in H0. lra.
Qed.
Lemma M_emax : M < bpow radix2 emax.
Proof. generalize U_M. unfold M. lra. Qed.
Lemma minus_fits x y : finite x -> finite y -> Rabs (B2R x - B2R y) < M + U / 2 -> finite (x ⊖ y).
Proof.
  intros X Y H. generalize (Bminus_correct p emax _ _ mode_NE x y X Y). rewrite Rlt_bool_true; [now intros (_ & ? & _) |].
  apply Rle_lt_trans with (2 := M_emax). now apply rounded_fits.
Qed.
Lemma plus_fits x y : finite x -> finite y -> Rabs (B2R x + B2R y) < M + U / 2 -> finite (x ⊕ y).
Proof.
  intros X Y H. generalize (Bplus_correct p emax _ _ mode_NE x y X Y). rewrite Rlt_bool_true; [now intros (_ & ? & _) |].
  apply Rle_lt_trans with (2 := M_emax). now apply rounded_fits.
Qed.
Lemma half_ulp_U w : Rabs (fl w) <= M -> Rabs (fl w - w) <= U / 2.
Proof.
  intros H. generalize (ulp_U _ H). intros L.
  apply Rle_trans with (/ 2 * ulp radix2 format (fl w)); [| lra].
  apply error_le_half_ulp_round; auto with typeclass_instances.
Qed.

(** two_sum does not overflow after its sum, except in b_in_sum; then the error is NaN. *)
Lemma largest_in_sum x y : Rabs x = M -> number y -> Rabs y <= M -> Rabs (fl (x + y)) <= M ->
  fl (fl (x + y) - x) = fl (x + y) - x.
Proof.
  assert (Pos : forall y, number y -> Rabs y <= M -> fl (M + y) <= M ->
                fl (fl (M + y) - M) = fl (M + y) - M).
  { clear x y. intros y N HY HS. apply Rabs_le_inv in HY. generalize U_M. intros [PU LM].
    assert (N2 : number (M / 2)).
    { replace (M / 2) with (M * bpow radix2 (-1)) by (simpl; lra). apply number_M_times.
      generalize (p_emax p emax). lia. }
    destruct (Rle_or_lt (M / 2) (fl (M + y))) as [C | C].
    - apply (Format.rnd_exact p emin Format.nearest).
      apply (sterbenz radix2 format); auto with typeclass_instances; try lra.
      + apply (Format.rnd_number p emin Format.nearest).
      + apply number_M.
    - assert (D : M + y < M / 2).
      { apply Rnot_le_lt. intros D. apply (Format.rnd_above p emin Format.nearest) in D; auto. lra. }
      assert (E : fl (M + y) = M + y).
      { apply (Format.rnd_exact p emin Format.nearest). replace (M + y) with (M - - y) by ring.
        apply (sterbenz radix2 format); auto with typeclass_instances; try lra.
        + apply number_M.
        + now apply Format.number_opp. }
      rewrite E. replace (M + y - M) with y by ring. now apply (Format.rnd_exact p emin Format.nearest). }
  intros X N HY HS. generalize U_M. intros [PU LM].
  destruct (Rle_or_lt 0 x) as [P | P].
  - rewrite Rabs_pos_eq in X by auto. subst x. apply Pos; auto. apply Rabs_le_inv in HS. lra.
  - rewrite Rabs_left in X by auto. assert (Ex : x = - M) by lra. subst x.
    replace (- M + y) with (- (M + - y)) in * by ring. rewrite (Interval.fl_opp p emin) in *.
    rewrite Rabs_Ropp in HS. apply Rabs_le_inv in HS.
    replace (- fl (M + - y) - - M) with (- (fl (M + - y) - M)) by ring. rewrite (Interval.fl_opp p emin).
    rewrite Pos; auto; [now apply Format.number_opp | now rewrite Rabs_Ropp | lra].
Qed.
Lemma two_sum_known a b : finite (a ⊕ b) ->
  BinarySingleNaN.is_nan (snd (two_sum _ F a b)) = true \/
  (finite (snd (two_sum _ F a b)) /\ B2R (a ⊕ b) + B2R (snd (two_sum _ F a b)) = B2R a + B2R b).
Proof.
  intros H. generalize H. intros FS. apply plus_finite in H. destruct H as (FA & FB & ES).
  unfold two_sum. cbn [snd]. set (s := a ⊕ b) in *. set (b' := s ⊖ a).
  destruct (BinarySingleNaN.is_finite b') eqn:FB'; [right | left].
  2: { destruct b' as [| t | |]; try discriminate.
    - assert (E1 : s ⊖ B754_infinity t = B754_infinity (negb t)) by (destruct s; easy).
      assert (E2 : b ⊖ B754_infinity t = B754_infinity (negb t)) by (destruct b; easy).
      rewrite E1, E2. assert (E3 : a ⊖ B754_infinity (negb t) = B754_infinity t).
      { destruct a, t; easy. }
      rewrite E3. now destruct t.
    - destruct s, a, b; easy. }
  generalize FB'. intros H. apply minus_finite in H. destruct H as (_ & _ & EB').
  change (B2R b' = fl (B2R s - B2R a)) in EB'.
  generalize U_M (le_M a) (le_M b) (le_M s) (le_M b'). intros [PU LM] MA MB MS MB'.
  assert (D1 : Rabs (B2R s - (B2R a + B2R b)) <= U / 2).
  { rewrite ES. apply half_ulp_U. now rewrite <- ES. }
  assert (D2 : Rabs (B2R b' - (B2R s - B2R a)) <= U / 2).
  { rewrite EB'. apply half_ulp_U. now rewrite <- EB'. }
  assert (FX : finite (s ⊖ b')).
  { apply minus_fits; auto. destruct (Req_dec (Rabs (B2R a)) M) as [E | E].
    - rewrite EB', ES, largest_in_sum; auto using number_B2R.
      + replace (fl (B2R a + B2R b) - (fl (B2R a + B2R b) - B2R a)) with (B2R a) by ring. lra.
      + now rewrite <- ES.
    - replace (B2R s - B2R b') with (B2R a - (B2R b' - (B2R s - B2R a))) by ring.
      apply Rle_lt_trans with (Rabs (B2R a) + Rabs (B2R b' - (B2R s - B2R a))); [| lra].
      unfold Rminus at 1. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra. }
  generalize FX. intros H. apply minus_finite in H. destruct H as (_ & _ & EX).
  assert (D3 : Rabs (B2R (s ⊖ b') - (B2R s - B2R b')) <= U / 2).
  { generalize (le_M (s ⊖ b')). rewrite EX. apply half_ulp_U. }
  apply Rabs_le_inv in D1, D2, D3.
  assert (NU : number U) by (apply Format.number_power; auto; generalize (p_emax p emax); lia).
  assert (LX : Rabs (B2R a - B2R (s ⊖ b')) <= U) by (apply Rabs_le; lra).
  assert (LY : Rabs (B2R b - B2R b') <= U) by (apply Rabs_le; lra).
  assert (FDX : finite (a ⊖ (s ⊖ b'))) by (apply minus_fits; auto; lra).
  assert (FDY : finite (b ⊖ b')) by (apply minus_fits; auto; lra).
  generalize FDX FDY. intros H1 H2. apply minus_finite in H1, H2.
  destruct H1 as (_ & _ & E1), H2 as (_ & _ & E2).
  assert (L1 : Rabs (B2R (a ⊖ (s ⊖ b'))) <= U).
  { rewrite E1. now apply (Format.rnd_abs_below p emin Format.nearest). }
  assert (L2 : Rabs (B2R (b ⊖ b')) <= U).
  { rewrite E2. now apply (Format.rnd_abs_below p emin Format.nearest). }
  apply Rabs_le_inv in L1, L2.
  assert (FE : finite (a ⊖ (s ⊖ b') ⊕ (b ⊖ b'))).
  { apply plus_fits; auto. apply Rle_lt_trans with (2 * U); [apply Rabs_le |]; lra. }
  split; auto. generalize FE. intros H. apply plus_finite in H. destruct H as (_ & _ & E3).
  generalize (ErrorFree.two_sum_exact p emin ltac:(generalize (p_emax p emax); lia) (B2R a) (B2R b)
                ltac:(lia) (number_B2R _ _ a) (number_B2R _ _ b)).
  unfold ErrorFree.two_sum. cbn [fst snd]. rewrite E3, E1, E2, EX, EB', ES. auto.
Qed.

Lemma zero_value' : finite (integer _ F 0) /\ B2R (integer _ F 0) = 0.
Proof. exact (zero_value p emax p_3). Qed.
Lemma at_most_0 x : at_most _ F (integer _ F 0) x = true ->
  BinarySingleNaN.is_nan x = false /\ (finite x -> 0 <= B2R x).
Proof.
  destruct zero_value' as [Z0 Z]. intros H. split.
  - now destruct x.
  - intros X. revert H. rewrite at_most_finite, Z by auto. now case Rle_bool_spec.
Qed.
Lemma at_most_0' x : at_most _ F x (integer _ F 0) = true ->
  BinarySingleNaN.is_nan x = false /\ (finite x -> B2R x <= 0).
Proof.
  destruct zero_value' as [Z0 Z]. intros H. split.
  - destruct x; easy.
  - intros X. revert H. rewrite at_most_finite, Z by auto. now case Rle_bool_spec.
Qed.

Theorem interval_exact_known a : interval_known a (interval_exact _ F a) (B2R a).
Proof. apply checked_known. lra. Qed.
(** A negative, infinite or NaN error gives an unknown number. *)
Theorem interval_within_known a error x :
  (finite error -> 0 <= B2R error -> Rabs (B2R a - x) <= B2R error) ->
  interval_known a (interval_within _ F a error) x.
Proof.
  intros K. unfold interval_within. destruct zero_value' as [Z0 Z].
  destruct (equal _ F error (integer _ F 0)) eqn:C.
  { apply equal_true in C; auto. destruct C as [FE C]. rewrite Z in C. specialize (K FE ltac:(lra)). rewrite C in K.
    apply Format.within_0 in K. rewrite <- K. apply interval_exact_known. }
  destruct (less _ F (integer _ F 0) error) eqn:P; cbn [negb]; [| now left].
  apply checked_known. intros _ L U' _.
  apply below_finite in L as L'. destruct L' as [L' _]. apply minus_finite in L'. destruct L' as (_ & FE & EL).
  apply above_finite in U' as W. destruct W as [W _]. apply plus_finite in W. destruct W as (_ & _ & EU).
  assert (0 < B2R error) by (rewrite less_finite, Z in P by auto; revert P; now case Rlt_bool_spec).
  specialize (K FE ltac:(lra)). apply Rabs_le_inv in K. split.
  - apply Rle_trans with (B2R a - B2R error); [| lra]. apply below_true; auto. lra.
  - apply Rle_trans with (B2R a + B2R error); [lra |]. apply above_true; auto. lra.
Qed.

Lemma sum_known v A B a x b y : interval_known a A x -> interval_known b B y ->
  interval_known v (interval_add _ F v A B) (x + y).
Proof.
  intros KA KB. unfold interval_add.
  destruct (two_sum _ F (fst A) (fst B)) as [lower low] eqn:EL.
  destruct (two_sum _ F (snd A) (snd B)) as [upper up] eqn:EU.
  assert (Hl : lower = fst A ⊕ fst B) by now inversion EL.
  assert (Hu : upper = snd A ⊕ snd B) by now inversion EU.
  apply checked_known. intros _ L W _.
  assert (FL : finite lower).
  { destruct (at_most _ F (integer _ F 0) low); auto. now apply below_finite in L. }
  assert (FU : finite upper).
  { destruct (at_most _ F up (integer _ F 0)); auto. now apply above_finite in W. }
  rewrite Hl in FL. rewrite Hu in FU.
  apply plus_finite in FL as SL. destruct SL as (FA & FB & SL).
  apply plus_finite in FU as SU. destruct SU as (_ & _ & SU).
  destruct KA as [-> | (_ & _ & _ & _ & HA)]; [discriminate |].
  destruct KB as [-> | (_ & _ & _ & _ & HB)]; [discriminate |].
  split.
  - apply Rle_trans with (B2R (fst A) + B2R (fst B)); [| lra].
    destruct (at_most _ F (integer _ F 0) low) eqn:C.
    + apply at_most_0 in C. destruct C as [N P]. destruct (two_sum_known _ _ FL) as [N' | [FE E]];
        rewrite EL in *; cbn [snd] in *; [congruence |]. specialize (P FE). rewrite Hl. lra.
    + apply below_true; auto. rewrite Hl. lra.
  - apply Rle_trans with (B2R (snd A) + B2R (snd B)); [lra |].
    destruct (at_most _ F up (integer _ F 0)) eqn:C.
    + apply at_most_0' in C. destruct C as [N P]. destruct (two_sum_known _ _ FU) as [N' | [FE E]];
        rewrite EU in *; cbn [snd] in *; [congruence |]. specialize (P FE). rewrite Hu. lra.
    + apply above_true; auto. rewrite Hu. lra.
Qed.
Theorem interval_add_known a A x b B y : interval_known a A x -> interval_known b B y ->
  interval_known (a ⊕ b) (interval_add _ F (a ⊕ b) A B) (x + y).
Proof. apply sum_known. Qed.
Theorem interval_negate_known a A x : interval_known a A x ->
  interval_known (opposite _ F a) (interval_negate _ F A) (- x).
Proof.
  destruct A as [l u]. intros [E | (L & U' & FA & H1 & H2)]; [left; now injection E as -> -> | right].
  cbn [fst snd] in *. unfold interval_negate. cbn [fst snd]. rewrite !opposite_value.
  simpl opposite. rewrite !is_finite_Bopp. repeat split; auto; lra.
Qed.
Theorem interval_subtract_known a A x b B y : interval_known a A x -> interval_known b B y ->
  interval_known (a ⊖ b) (interval_subtract _ F (a ⊖ b) A B) (x - y).
Proof. intros KA KB. apply (sum_known _ _ _ _ _ _ _ KA (interval_negate_known _ _ _ KB)). Qed.

Theorem interval_sign_known a A x : interval_known a A x ->
  match interval_sign _ F A with
  | negative => x < 0
  | zero => x = 0
  | positive => 0 < x
  | uncertain => True
  end.
Proof.
  destruct zero_value' as [Z0 Z]. destruct A as [l u]. unfold interval_sign. cbn [fst snd].
  intros [E | (L & U' & FA & H1 & H2)]; cbn [fst snd] in *; [now injection E as -> -> |].
  rewrite !less_finite, !equal_finite, Z by auto.
  destruct (Rlt_bool_spec 0 (B2R l)); [lra |]. destruct (Rlt_bool_spec (B2R u) 0); [lra |].
  destruct (Req_bool_spec (B2R l) 0), (Req_bool_spec (B2R u) 0); simpl; auto. lra.
Qed.

(** The minimum and the maximum of four numbers. *)
Lemma least_either m n : least _ F m n = m \/ least _ F m n = n.
Proof. unfold least. destruct (less _ F n m); auto. Qed.
Lemma max_either m n : most _ F m n = m \/ most _ F m n = n.
Proof. unfold most. destruct (less _ F m n); auto. Qed.
Notation no_nan x := (BinarySingleNaN.is_nan x = false).
Lemma least_no_nan m n : no_nan m -> no_nan n -> no_nan (least _ F m n).
Proof. destruct (least_either m n) as [-> | ->]; auto. Qed.
Lemma max_no_nan m n : no_nan m -> no_nan n -> no_nan (most _ F m n).
Proof. destruct (max_either m n) as [-> | ->]; auto. Qed.
Lemma least_minus m n : no_nan m -> no_nan n -> least _ F m n <> minus_infinity ->
  m <> minus_infinity /\ n <> minus_infinity.
Proof.
  intros Nm Nn H. split; intros ->; apply H; unfold least.
  - destruct n as [| [|] | |]; easy.
  - destruct m as [| [|] | |]; easy.
Qed.
Lemma max_plus m n : no_nan m -> no_nan n -> most _ F m n <> plus_infinity ->
  m <> plus_infinity /\ n <> plus_infinity.
Proof.
  intros Nm Nn H. split; intros ->; apply H; unfold most.
  - destruct n as [| [|] | |]; easy.
  - destruct m as [| [|] | |]; easy.
Qed.
Lemma least_le m n : finite m -> finite n -> B2R (least _ F m n) <= B2R m /\ B2R (least _ F m n) <= B2R n.
Proof.
  intros FM FN. unfold least. rewrite less_finite by auto. case Rlt_bool_spec; lra.
Qed.
Lemma max_ge m n : finite m -> finite n -> B2R m <= B2R (most _ F m n) /\ B2R n <= B2R (most _ F m n).
Proof.
  intros FM FN. unfold most. rewrite less_finite by auto. case Rlt_bool_spec; lra.
Qed.
Lemma finite_least m n : finite m -> finite n -> finite (least _ F m n).
Proof. destruct (least_either m n) as [-> | ->]; auto. Qed.
Lemma finite_most m n : finite m -> finite n -> finite (most _ F m n).
Proof. destruct (max_either m n) as [-> | ->]; auto. Qed.
Lemma finite_intro m : no_nan m -> m <> minus_infinity -> m <> plus_infinity -> finite m.
Proof. destruct m as [| [|] | |]; easy. Qed.

(** Ends of exact values Q. If one is not finite, neither is the hull, if none or all are NaN or infinite. *)
Lemma hull_known v w x y z t Qw Qx Qy Qz :
  (no_nan w /\ no_nan x /\ no_nan y /\ no_nan z) \/
    (~ finite w /\ ~ finite x /\ ~ finite y /\ ~ finite z) ->
  (finite w -> finite x -> finite y -> finite z ->
   (B2R w = fl Qw /\ B2R x = fl Qx /\ B2R y = fl Qy /\ B2R z = fl Qz) /\
   (Qw <= t \/ Qx <= t \/ Qy <= t \/ Qz <= t) /\ (t <= Qw \/ t <= Qx \/ t <= Qy \/ t <= Qz)) ->
  interval_known v (hull _ F v w x y z) t.
Proof.
  intros N K. unfold hull. apply checked_known. intros _ L W _.
  apply below_finite in L as FL. destruct FL as [FL _].
  apply above_finite in W as FW. destruct FW as [FW _].
  destruct N as [(Nw & Nx & Ny & Nz) | (Nw & Nx & Ny & Nz)].
  2: { exfalso. destruct (least_either (least _ F w x) (least _ F y z)) as [E | E]; rewrite E in FL.
    - destruct (least_either w x) as [E' | E']; rewrite E' in FL; tauto.
    - destruct (least_either y z) as [E' | E']; rewrite E' in FL; tauto. }
  assert (L4 : least _ F (least _ F w x) (least _ F y z) <> minus_infinity) by (intros E; now rewrite E in FL).
  apply least_minus in L4; auto using least_no_nan. destruct L4 as [L1 L2].
  apply least_minus in L1, L2; auto.
  assert (M4 : most _ F (most _ F w x) (most _ F y z) <> plus_infinity) by (intros E; now rewrite E in FW).
  apply max_plus in M4; auto using max_no_nan. destruct M4 as [M1 M2].
  apply max_plus in M1, M2; auto.
  assert (Fw : finite w) by (apply finite_intro; tauto). assert (Fx : finite x) by (apply finite_intro; tauto).
  assert (Fy : finite y) by (apply finite_intro; tauto). assert (Fz : finite z) by (apply finite_intro; tauto).
  destruct (K Fw Fx Fy Fz) as ((Ew & Ex & Ey & Ez) & HL & HU).
  destruct (least_le w x Fw Fx) as [A1 A2], (least_le y z Fy Fz) as [A3 A4].
  destruct (least_le _ _ (finite_least _ _ Fw Fx) (finite_least _ _ Fy Fz)) as [A5 A6].
  destruct (max_ge w x Fw Fx) as [B1 B2], (max_ge y z Fy Fz) as [B3 B4].
  destruct (max_ge _ _ (finite_most _ _ Fw Fx) (finite_most _ _ Fy Fz)) as [B5 B6].
  split.
  - destruct HL as [H | [H | [H | H]]]; (eapply Rle_trans; [| exact H]); apply below_true; auto; lra.
  - destruct HU as [H | [H | [H | H]]]; (eapply Rle_trans; [exact H |]); apply above_true; auto; lra.
Qed.

(** A product lies between products of ends. *)
Lemma corner_below l r x m n y : l <= x <= r -> m <= y <= n ->
  l * m <= x * y \/ l * n <= x * y \/ r * m <= x * y \/ r * n <= x * y.
Proof.
  intros X Y. destruct (Rle_or_lt 0 y) as [P | P].
  - assert (l * y <= x * y) by (apply Rmult_le_compat_r; lra).
    destruct (Rle_or_lt 0 l) as [Q | Q]; [left | right; left]; nra.
  - assert (r * y <= x * y) by nra.
    destruct (Rle_or_lt 0 r) as [Q | Q]; [right; right; left | right; right; right]; nra.
Qed.
Lemma corner_above l r x m n y : l <= x <= r -> m <= y <= n ->
  x * y <= l * m \/ x * y <= l * n \/ x * y <= r * m \/ x * y <= r * n.
Proof.
  intros X Y. generalize (corner_below (- r) (- l) (- x) m n y ltac:(lra) Y). lra.
Qed.

Lemma times_no_nan x y : finite x -> finite y -> no_nan (x ⊗ y).
Proof.
  intros X Y. generalize (Bmult_correct p emax _ _ mode_NE x y). case Rlt_bool.
  - intros (_ & H & _). rewrite X, Y in H. revert H. unfold times, floats. now destruct (Bmult mode_NE x y).
  - intros H. revert H. unfold times, floats. now destruct (Bmult mode_NE x y).
Qed.

Lemma is_point_true a A x : interval_known a A x -> is_point _ F A = true -> finite a /\ x = B2R a.
Proof.
  destruct A as [l u]. intros [E | (L & U' & FA & H1 & H2)] C; unfold is_point in C; cbn [fst snd] in *.
  - injection E as -> ->. discriminate.
  - rewrite equal_finite in C by auto. split; auto. revert C. case Req_bool_spec; [lra | discriminate].
Qed.
Lemma is_zero_true a A x : interval_known a A x -> is_zero_interval _ F A = true ->
  finite a /\ B2R a = 0 /\ x = 0.
Proof.
  destruct zero_value' as [Z0 Z]. destruct A as [l u].
  intros [E | (L & U' & FA & H1 & H2)] C; unfold is_zero_interval in C; cbn [fst snd] in *.
  - injection E as -> ->. discriminate.
  - rewrite !equal_finite, Z in C by auto. split; auto. revert C.
    do 2 case Req_bool_spec; try discriminate. lra.
Qed.

(** v, rounded from t, and the sign of its error. *)
Lemma nearest_known v error t : (finite v -> B2R v = fl t) ->
  (finite v -> finite error /\ (B2R error < 0 -> t <= B2R v) /\ (0 < B2R error -> B2R v <= t) /\
    (B2R error = 0 -> B2R v = t)) ->
  interval_known v (interval_nearest _ F v error) t.
Proof.
  destruct zero_value' as [Z0 Z]. intros E K. unfold interval_nearest. apply checked_known.
  intros FV L W _. destruct (K FV) as (FE & N & P & Q). rewrite !less_finite, Z in * by auto.
  specialize (E FV).
  destruct (Rlt_bool_spec (B2R error) 0) as [C | C], (Rlt_bool_spec 0 (B2R error)) as [D | D]; try lra.
  - split; [apply below_true; auto; lra | lra].
  - split; [lra | apply above_true; auto; lra].
Qed.
Lemma one_step_known v t : (finite v -> B2R v = fl t) ->
  interval_known v (interval_checked _ F v (below _ F v) (above _ F v)) t.
Proof.
  intros E. apply checked_known. intros FV L W _. specialize (E FV).
  split; [apply below_true | apply above_true]; auto; lra.
Qed.

(** two_product *)
Lemma is_finite_true x : is_finite _ F x = true -> finite x.
Proof.
  intros H. destruct (BinarySingleNaN.is_finite x) eqn:E; auto. exfalso. revert H. unfold is_finite, abs.
  destruct x as [| s | |]; try discriminate; destruct s; discriminate.
Qed.
Lemma split_finite x : finite (snd (split _ F x)) ->
  finite (fst (split _ F x)) /\ finite x /\
  B2R (fst (split _ F x)) = fst (ErrorFree.split p emin (B2R x)) /\
  B2R (snd (split _ F x)) = snd (ErrorFree.split p emin (B2R x)).
Proof.
  unfold split. cbn [fst snd]. set (s := ((digits _ F + 1) / 2)%Z). intros H.
  apply minus_finite in H. destruct H as (FX & H & E1). generalize H. intros FH.
  apply minus_finite in H. destruct H as (H & H' & E2). apply minus_finite in H'. destruct H' as (_ & _ & E3).
  apply times_finite in H. destruct H as (H & _ & E4). apply plus_finite in H. destruct H as (_ & _ & E5).
  assert (S : (0 <= s < p)%Z).
  { unfold s. change (digits _ F) with p. split; [apply Z.div_pos; lia | apply Z.div_lt_upper_bound; lia]. }
  assert (V : B2R (integer _ F (2 ^ s)) = bpow radix2 s).
  { generalize (constant_value p emax (2 ^ s) 0). change (bpow radix2 0) with 1. rewrite Rmult_1_r.
    change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia. generalize (p_emax p emax). intros L C.
    apply C.
    - apply Format.number_power; auto. lia.
    - rewrite Rabs_pos_eq by apply bpow_ge_0. apply bpow_lt. lia. }
  rewrite V, (proj2 (integer_value p emax p_3 1 ltac:(lia))) in E5.
  rewrite (Format.rnd_exact p emin Format.nearest) in E5.
  2: { replace (bpow radix2 s + 1) with (IZR (2 ^ s + 1) * bpow radix2 0).
    - generalize (p_emax p emax). intros L. apply Format.number_integer; auto; [lia |].
      assert (2 ^ s * 2 <= 2 ^ p)%Z.
      { rewrite <- (Z.pow_succ_r 2 s) || rewrite Z.mul_comm, <- Z.pow_succ_r by lia.
        apply Z.pow_le_mono_r; lia. }
      assert (1 <= 2 ^ s)%Z by (apply (Z.pow_le_mono_r 2 0); lia). lia.
    - rewrite plus_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia. simpl. ring. }
  unfold ErrorFree.split, ErrorFree.half_bits. cbn [fst snd]. change ((p + 1) / 2)%Z with s.
  rewrite E1, E2, E3, E4, E5. auto.
Qed.
Lemma product_value a b : fst (two_product _ F fused a b) = a ⊗ b.
Proof. unfold two_product. destruct fused, (split _ F a), (split _ F b); reflexivity. Qed.
(** Over real numbers. *)
Let real_product (a b : R) : R * R :=
  if fused then ErrorFree.two_product_fma p emin a b else ErrorFree.two_product p emin a b.
Lemma real_product_value a b : fst (real_product a b) = fl (a * b).
Proof.
  unfold real_product, ErrorFree.two_product. destruct fused; [reflexivity |].
  now destruct (ErrorFree.split p emin a), (ErrorFree.split p emin b).
Qed.
Lemma real_product_exact a b : number a -> number b -> fused = true \/ (4 <= p)%Z ->
  ErrorFree.product_error_is_exact p emin a b (real_product a b) ->
  fst (real_product a b) + snd (real_product a b) = a * b.
Proof.
  generalize (p_emax p emax). unfold real_product. intros L A B P. destruct fused.
  - apply ErrorFree.two_product_fma_exact; auto; lia.
  - destruct P as [P | P]; [discriminate |]. apply ErrorFree.two_product_exact; auto; lia.
Qed.
Lemma real_product_0 a b : a = 0 \/ b = 0 -> real_product a b = (0, 0).
Proof.
  assert (R0 : fl 0 = 0) by apply (Format.rnd_0 p emin Format.nearest).
  assert (S0 : ErrorFree.split p emin 0 = (0, 0)).
  { unfold ErrorFree.split. cbv zeta. now repeat rewrite ?Rmult_0_r, ?Rminus_0_r, ?R0. }
  unfold real_product, ErrorFree.two_product_fma, ErrorFree.two_product.
  intros [-> | ->]; rewrite S0; [destruct (ErrorFree.split p emin b) | destruct (ErrorFree.split p emin a)];
    destruct fused; cbv zeta; now repeat rewrite ?Rmult_0_l, ?Rmult_0_r, ?Rminus_0_r, ?Rplus_0_r, ?R0.
Qed.
Lemma product_finite a b : finite (a ⊗ b) -> finite (snd (two_product _ F fused a b)) ->
  B2R (snd (two_product _ F fused a b)) = snd (real_product (B2R a) (B2R b)).
Proof.
  unfold two_product, real_product. generalize (split_finite a) (split_finite b).
  destruct (split _ F a) as [ah al], (split _ F b) as [bh bl]. cbn [fst snd]. intros SA SB FV.
  apply times_finite in FV. destruct FV as (FA & FB & EV). destruct fused; cbn [snd]; intros H.
  { apply fma_finite in H. destruct H as (_ & _ & _ & ->). rewrite opposite_value, EV. reflexivity. }
  apply plus_finite in H. destruct H as (H1 & H2 & E1).
  apply times_finite in H2. destruct H2 as (HA & HB & E2). apply plus_finite in H1. destruct H1 as (H1 & H3 & E3).
  apply times_finite in H3. destruct H3 as (_ & _ & E4). apply plus_finite in H1. destruct H1 as (H1 & H3 & E5).
  apply times_finite in H3. destruct H3 as (_ & _ & E6). apply minus_finite in H1. destruct H1 as (H1 & _ & E7).
  apply times_finite in H1. destruct H1 as (_ & _ & E8).
  destruct (SA HA) as (_ & _ & S1 & S2), (SB HB) as (_ & _ & S3 & S4).
  unfold ErrorFree.two_product. destruct (ErrorFree.split p emin (B2R a)) as [rah ral].
  destruct (ErrorFree.split p emin (B2R b)) as [rbh rbl]. cbn [fst snd] in *.
  rewrite E1, E2, E3, E4, E5, E6, E7, E8, EV, S1, S2, S3, S4. reflexivity.
Qed.
Theorem product_known a b : product_error_is_exact _ F fused a b (two_product _ F fused a b) = true ->
  finite (a ⊗ b) /\ finite (snd (two_product _ F fused a b)) /\ finite a /\ finite b /\
  B2R (a ⊗ b) + B2R (snd (two_product _ F fused a b)) = B2R a * B2R b /\
  ErrorFree.product_error_is_exact p emin (B2R a) (B2R b)
    (B2R (a ⊗ b), B2R (snd (two_product _ F fused a b))).
Proof.
  generalize (product_finite a b). unfold product_error_is_exact.
  rewrite (surjective_pairing (two_product _ F fused a b)) at 3. rewrite product_value.
  set (error := snd (two_product _ F fused a b)). intros Real.
  destruct (is_finite _ F (a ⊗ b)) eqn:C1; [| discriminate]. cbn [negb orb].
  destruct (is_finite _ F error) eqn:C2; [| discriminate]. cbn [negb orb].
  apply is_finite_true in C1, C2. intros H. specialize (Real C1 C2). generalize C1. intros FV.
  apply times_finite in C1. destruct C1 as (FA & FB & EV).
  split; auto. split; auto. split; auto. split; auto. rewrite Real, EV.
  (* The test of large operands makes bounds equal on all processors; this theorem does not need it. *)
  cbv zeta in H. destruct (_ || _) in H; [discriminate |].
  destruct zero_value' as [Z0 Z]. rewrite !equal_finite, Z in H by auto.
  assert (Zero : B2R a = 0 \/ B2R b = 0 -> fl (B2R a * B2R b) + snd (real_product (B2R a) (B2R b)) = B2R a * B2R b).
  { intros C. rewrite <- real_product_value, real_product_0 by auto. cbn [fst snd].
    destruct C as [-> | ->]; ring. }
  destruct (Req_bool_spec (B2R a) 0) as [A0 | A0]; [split; [auto | now left] |].
  destruct (Req_bool_spec (B2R b) 0) as [B0 | B0]; [split; [auto | right; now left] |].
  clear Zero. cbn [orb] in H. change (digits _ F) with p in H.
  assert (P : fused = true \/ (4 <= p)%Z).
  { revert H. destruct fused; [auto |]. destruct (Z.ltb_spec p 4); [discriminate | auto]. }
  replace (negb fused && (p <? 4)%Z) with false in H.
  2: { destruct P as [-> | P]; [reflexivity |]. destruct (Z.ltb_spec p 4), fused; auto; lia. }
  destruct (less _ _ _ _) in H; [discriminate |].
  destruct (u_value p emax p_3) as [Fu Vu]. destruct (eta_value p emax p_3) as [Fe Ve].
  assert (Nu : B2R (unit_roundoff _ F) <> 0) by (rewrite Vu; apply Rgt_not_eq, bpow_gt_0).
  set (w := underflow_unit _ F ⊘ unit_roundoff _ F ⊘ unit_roundoff _ F) in *.
  assert (Pw : nonnegative p emax w).
  { apply nonnegative_over; auto; [apply nonnegative_over; auto |]; auto using nonnegative_u, nonnegative_eta. }
  assert (FM : finite (abs _ F (a ⊗ b))) by now apply abs_finite_intro.
  assert (Fw : finite w).
  { clearbody w. clear - Pw H FM.
    destruct (abs _ F (a ⊗ b)) as [| t | |]; try discriminate; destruct w as [| [|] | |]; easy. }
  assert (T : fl (fl (Format.eta emin / Format.u p) / Format.u p) <= Rabs (fl (B2R a * B2R b))).
  { rewrite at_most_finite in H by auto. apply (abs_finite p emax p_3) in FM. destruct FM as [_ EM].
    rewrite EM, EV in H. generalize Fw. intros H'. apply over_finite in H'; auto. destruct H' as [H' E1].
    apply over_finite in H'; auto. destruct H' as [_ E2]. fold w in E1. rewrite E1, E2, Vu, Ve in H.
    revert H. now case Rle_bool_spec. }
  split; [| right; right; exact T].
  rewrite <- real_product_value. apply real_product_exact; auto using number_B2R.
  right. right. now rewrite real_product_value.
Qed.

Theorem interval_multiply_known a A x b B y : interval_known a A x -> interval_known b B y ->
  interval_known (a ⊗ b) (interval_multiply _ F fused (a ⊗ b) a A b B) (x * y).
Proof.
  intros KA KB. unfold interval_multiply.
  destruct (is_zero_interval _ F A || is_zero_interval _ F B) eqn:CZ.
  { apply checked_known. intros V _ _ _.
    assert (H : B2R (a ⊗ b) = 0 /\ x * y = 0); [| lra].
    apply orb_prop in CZ. destruct CZ as [C | C].
    - destruct (is_zero_true _ _ _ KA C) as (_ & A0 & ->). split; [apply zero_times; auto | ring].
    - destruct (is_zero_true _ _ _ KB C) as (_ & B0 & ->). split; [apply zero_times; auto | ring]. }
  destruct (is_point _ F A && is_point _ F B) eqn:CP.
  { apply andb_prop in CP. destruct CP as [CA CB].
    destruct (is_point_true _ _ _ KA CA) as [FA ->], (is_point_true _ _ _ KB CB) as [FB ->].
    assert (E : finite (a ⊗ b) -> B2R (a ⊗ b) = fl (B2R a * B2R b)).
    { intros H. now apply times_finite in H. }
    destruct (product_error_is_exact _ F fused a b (two_product _ F fused a b)) eqn:CE; [| now apply one_step_known].
    apply product_known in CE. destruct CE as (_ & FE & _ & _ & EX & _).
    apply nearest_known; auto. intros _. split; auto. lra. }
  apply hull_known with (B2R (fst A) * B2R (fst B)) (B2R (fst A) * B2R (snd B))
    (B2R (snd A) * B2R (fst B)) (B2R (snd A) * B2R (snd B)).
  - destruct KA as [-> | (LA & UA & _)].
    + right. cbn [fst snd]. repeat split; intros H; apply times_finite in H; easy.
    + destruct KB as [-> | (LB & UB & _)].
      * right. cbn [fst snd]. repeat split; intros H; apply times_finite in H; easy.
      * left. auto using times_no_nan.
  - intros H1 H2 H3 H4. apply times_finite in H1, H2, H3, H4.
    destruct KA as [-> | (_ & _ & _ & _ & HA)]; [easy |].
    destruct KB as [-> | (_ & _ & _ & _ & HB)]; [easy |].
    split; [tauto |]. split; [apply corner_below | apply corner_above]; auto.
Qed.

(** Scaling. *)
Theorem interval_scale_known a A x e : interval_known a A x ->
  interval_known (scale _ F a e) (interval_scale _ F (scale _ F a e) A e) (x * bpow radix2 e).
Proof.
  intros K. unfold interval_scale. cbv zeta. set (l := scale _ F (fst A) e). set (w := scale _ F (snd A) e).
  assert (Ends : finite l -> finite w ->
    B2R l = fl (B2R (fst A) * bpow radix2 e) /\ B2R w = fl (B2R (snd A) * bpow radix2 e) /\
    finite (fst A) /\ finite (snd A) /\
    B2R (fst A) * bpow radix2 e <= x * bpow radix2 e <= B2R (snd A) * bpow radix2 e).
  { intros L W. apply scale_finite in L, W. generalize (bpow_ge_0 radix2 e). intros P.
    destruct K as [-> | (_ & _ & _ & _ & H)]; [easy |]. split; [tauto |]. split; [tauto |].
    split; [tauto |]. split; [tauto |]. split; apply Rmult_le_compat_r; lra. }
  destruct ((0 <=? e)%Z || (equal _ F (scale _ F l (- e)) (fst A) && equal _ F (scale _ F w (- e)) (snd A))) eqn:C;
    apply checked_known; intros _ L W _.
  - destruct (Ends L W) as (EL & EW & FL & FW & H).
    assert (Exact : B2R l = B2R (fst A) * bpow radix2 e /\ B2R w = B2R (snd A) * bpow radix2 e); [| lra].
    destruct (Z.leb_spec 0 e) as [E | E]; cbn [orb] in C.
    + rewrite EL, EW, !(Format.scale_up p emin Format.nearest) by auto using number_B2R. auto.
    + apply andb_prop in C. destruct C as [C1 C2]. rewrite scale_equal in C1, C2 by auto.
      split; apply (Format.scale_back p emin Format.nearest); auto using number_B2R.
      * revert C1. case Req_bool_spec; easy.
      * revert C2. case Req_bool_spec; easy.
  - apply below_finite in L as FL. apply above_finite in W as FW. destruct FL as [FL _], FW as [FW _].
    destruct (Ends FL FW) as (EL & EW & _ & _ & H). split.
    + apply Rle_trans with (B2R (fst A) * bpow radix2 e); [| lra]. apply below_true; auto. lra.
    + apply Rle_trans with (B2R (snd A) * bpow radix2 e); [lra |]. apply above_true; auto. lra.
Qed.

(** Division. *)
(** The remainder a - v b, if it is exact over real numbers: nothing overflows. *)
Lemma remainder_exact a v b : finite a -> finite v -> (B2R a = 0 -> B2R v = 0) ->
  (forall e, fl (B2R v * B2R b) + e = B2R v * B2R b ->
     ErrorFree.product_error_is_exact p emin (B2R v) (B2R b) (fl (B2R v * B2R b), e) -> B2R a <> 0 -> B2R v <> 0 ->
     fl (fl (B2R a - fl (B2R v * B2R b)) - e) = B2R a - B2R v * B2R b /\
     fl (B2R a - fl (B2R v * B2R b)) = B2R a - fl (B2R v * B2R b) /\
     Rabs (B2R a - B2R v * B2R b) <= Rabs (B2R v * B2R b) / 2) ->
  snd (remainder_of_division _ F fused a b v) = true ->
  finite (fst (remainder_of_division _ F fused a b v)) /\
  B2R (fst (remainder_of_division _ F fused a b v)) = B2R a - B2R v * B2R b.
Proof.
  intros FA FV V0 Exact. destruct zero_value' as [Z0 Z].
  unfold remainder_of_division. cbv zeta. rewrite equal_finite, Z by auto.
  destruct (Req_bool_spec (B2R a) 0) as [A0 | A0]; cbn [fst snd].
  { intros _. split; auto. rewrite V0, A0, Z by auto. ring. }
  intros C. apply andb_prop in C. destruct C as [CQ CP]. rewrite equal_finite, Z in CQ by auto.
  destruct (Req_bool_spec (B2R v) 0) as [NQ | NQ]; [discriminate CQ |]. clear CQ.
  apply product_known in CP. rewrite product_value. destruct CP as (FP & FE & _ & _ & EX & D).
  set (e := snd (two_product _ F fused v b)) in *.
  assert (EP : B2R (v ⊗ b) = fl (B2R v * B2R b)) by now apply times_finite in FP.
  rewrite EP in EX, D. destruct (Exact (B2R e) EX D A0 NQ) as (R & ED & Q). rewrite <- EP in R, ED.
  generalize U_M (le_M (v ⊗ b)). intros [PU LM] MP.
  assert (HP : Rabs (B2R (v ⊗ b) - B2R v * B2R b) <= U / 2).
  { rewrite EP. apply half_ulp_U. now rewrite <- EP. }
  assert (LQ : Rabs (B2R v * B2R b) <= M + U / 2).
  { replace (B2R v * B2R b) with (B2R (v ⊗ b) - (B2R (v ⊗ b) - B2R v * B2R b)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra. }
  assert (FD : finite (a ⊖ (v ⊗ b))).
  { apply minus_fits; auto.
    replace (B2R a - B2R (v ⊗ b)) with ((B2R a - B2R v * B2R b) + - (B2R (v ⊗ b) - B2R v * B2R b)) by ring.
    apply Rle_lt_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra. }
  generalize FD. intros H. apply minus_finite in H. destruct H as (_ & _ & H). rewrite ED in H, R. rewrite <- EP in EX.
  assert (FR : finite (a ⊖ (v ⊗ b) ⊖ e)).
  { apply minus_fits; auto. rewrite H.
    replace (B2R a - B2R (v ⊗ b) - B2R e) with (B2R a - B2R v * B2R b) by lra. lra. }
  split; auto. apply minus_finite in FR. destruct FR as (_ & _ & ->). rewrite H. exact R.
Qed.
Theorem remainder_known a b : finite (a ⊘ b) -> finite b -> B2R b <> 0 ->
  snd (remainder_of_division _ F fused a b (a ⊘ b)) = true ->
  finite (fst (remainder_of_division _ F fused a b (a ⊘ b))) /\
  B2R (fst (remainder_of_division _ F fused a b (a ⊘ b))) = B2R a - B2R (a ⊘ b) * B2R b.
Proof.
  intros FV FB NB. generalize (p_emax p emax). intros PE.
  generalize FV. intros H. apply over_finite in H; auto. destruct H as [FA EV]. apply remainder_exact; auto.
  { intros A0. rewrite EV, A0. unfold Rdiv. rewrite Rmult_0_l. exact (Format.rnd_0 p emin Format.nearest). }
  intros e EX D A0 NQ. rewrite EV in *.
  assert (R : ErrorFree.remainder_of_division p emin (B2R a) (fl (fl (B2R a / B2R b) * B2R b), e) =
    B2R a - fl (B2R a / B2R b) * B2R b)
    by (apply ErrorFree.remainder_of_division_exact; auto using number_B2R; lia).
  unfold ErrorFree.remainder_of_division in R. cbn [fst snd] in R.
  destruct (Req_bool_spec (B2R a) 0) as [? | _]; [contradiction |].
  assert (Q : Rabs (B2R a - fl (B2R a / B2R b) * B2R b) <= Rabs (fl (B2R a / B2R b) * B2R b) / 2)
    by (apply ErrorFree.quotient_error; auto; lia).
  destruct (ErrorFree.far_from_underflow p emin _ _ _ ltac:(lia) D) as [S | S]; [apply Rmult_integral in S; destruct S; contradiction |].
  split; [exact R |]. split; [| exact Q]. apply ErrorFree.difference_is_number; auto using number_B2R; try lia.
  apply Rle_trans with (2 := S). apply bpow_le. lia.
Qed.
Lemma over_no_nan x y : finite x -> B2R y <> 0 -> no_nan (x ⊘ y).
Proof.
  intros X Y. generalize (Bdiv_correct p emax _ _ mode_NE x y Y). case Rlt_bool.
  - intros (_ & H & _). rewrite X in H. revert H. unfold over, floats. now destruct (Bdiv mode_NE x y).
  - intros H. revert H. unfold over, floats. now destruct (Bdiv mode_NE x y).
Qed.
Lemma inverse_between m n y : m <= y <= n -> 0 < m \/ n < 0 -> / n <= / y <= / m.
Proof.
  intros [H1 H2] [P | P].
  - split; apply Rinv_le_contravar; lra.
  - assert (- / m <= - / y /\ - / y <= - / n); [| lra].
    rewrite !Ropp_inv_permute by lra. split; apply Rinv_le_contravar; lra.
Qed.

(** The signs of x - y b and of b determine on which side of y the quotient x/b lies. *)
Lemma quotient_above x b y : b <> 0 -> 0 <= (if Rlt_bool b 0 then - (x - y * b) else x - y * b) -> y <= x / b.
Proof.
  intros NB. case Rlt_bool_spec; intros C H.
  - apply Rmult_le_reg_r with (- b); [lra |]. replace (x / b * - b) with (- x) by (field; auto). lra.
  - apply Rmult_le_reg_r with b; [lra |]. replace (x / b * b) with x by (field; auto). lra.
Qed.
Lemma quotient_below x b y : b <> 0 -> (if Rlt_bool b 0 then - (x - y * b) else x - y * b) <= 0 -> x / b <= y.
Proof.
  intros NB H. enough (- y <= - x / b) by (unfold Rdiv in *; lra).
  apply quotient_above; auto. revert H. case Rlt_bool_spec; intros; lra.
Qed.

Theorem interval_divide_known a A x b B y : interval_known a A x -> interval_known b B y ->
  interval_known (a ⊘ b) (interval_divide _ F fused (a ⊘ b) a A b B) (x / y).
Proof.
  intros KA KB. destruct zero_value' as [Z0 Z]. unfold interval_divide.
  destruct (negb (less _ F (integer _ F 0) (fst B)) && negb (less _ F (snd B) (integer _ F 0))) eqn:CB;
    [left; reflexivity |].
  assert (H : finite (fst B) /\ finite (snd B) /\ finite b /\
    B2R (fst B) <= B2R b <= B2R (snd B) /\ B2R (fst B) <= y <= B2R (snd B)).
  { destruct KB as [-> | KB]; [discriminate CB | exact KB]. }
  destruct H as (FL & FU & FB & HB & HY).
  assert (S : 0 < B2R (fst B) \/ B2R (snd B) < 0).
  { rewrite !less_finite, Z in CB by assumption.
    destruct (Rlt_bool_spec 0 (B2R (fst B))), (Rlt_bool_spec (B2R (snd B)) 0); try lra. }
  clear CB. assert (NB : B2R b <> 0) by (destruct S; lra).
  destruct (is_point _ F A && is_point _ F B) eqn:CP.
  { apply andb_prop in CP. destruct CP as [CA CP].
    destruct (is_point_true _ _ _ KA CA) as [FA ->], (is_point_true _ _ _ KB CP) as [_ ->].
    clear KA KB CA CP.
    assert (E : finite (a ⊘ b) -> B2R (a ⊘ b) = fl (B2R a / B2R b)).
    { intros H. apply over_finite in H; [destruct H; assumption | assumption | assumption]. }
    generalize (remainder_known a b).
    destruct (remainder_of_division _ F fused a b (a ⊘ b)) as [r exact]. cbn [fst snd]. intros R.
    destruct exact; [| apply one_step_known; exact E].
    apply nearest_known; [exact E |]. intros FV. destruct (R FV FB NB eq_refl) as [FR ER].
    generalize (quotient_above (B2R a) (B2R b) (B2R (a ⊘ b)) NB)
      (quotient_below (B2R a) (B2R b) (B2R (a ⊘ b)) NB).
    assert (FO : finite (opposite _ F r)) by (simpl; rewrite is_finite_Bopp; exact FR).
    rewrite less_finite, Z, <- ER by assumption.
    destruct (Rlt_bool (B2R b) 0); rewrite ?opposite_value; intros G1 G2;
      (split; [assumption |]; split; [intros; apply G2; lra |]; split; [intros; apply G1; lra |];
       intros; apply Rle_antisym; [apply G1 | apply G2]; lra). }
  assert (NL : B2R (fst B) <> 0) by (destruct S; lra). assert (NU : B2R (snd B) <> 0) by (destruct S; lra).
  apply hull_known with (B2R (fst A) / B2R (fst B)) (B2R (fst A) / B2R (snd B))
    (B2R (snd A) / B2R (fst B)) (B2R (snd A) / B2R (snd B)).
  - destruct KA as [-> | (LA & UA & _)].
    + right. cbn [fst snd]. repeat split; intros H;
        (apply over_finite in H; [destruct H; discriminate | assumption | assumption]).
    + left. exact (conj (over_no_nan _ _ LA NL) (conj (over_no_nan _ _ LA NU)
        (conj (over_no_nan _ _ UA NL) (over_no_nan _ _ UA NU)))).
  - intros H1 H2 H3 H4. apply over_finite in H1, H2, H3, H4; try assumption.
    destruct H1 as [H1 E1], H2 as [_ E2], H3 as [_ E3], H4 as [_ E4].
    destruct KA as [-> | (_ & _ & _ & _ & HA)]; [discriminate H1 |].
    split; [exact (conj E1 (conj E2 (conj E3 E4))) |].
    generalize (inverse_between _ _ _ HY S). intros I. unfold Rdiv. split.
    + destruct (corner_below _ _ _ _ _ _ HA I) as [G | [G | [G | G]]]; auto.
    + destruct (corner_above _ _ _ _ _ _ HA I) as [G | [G | [G | G]]]; auto.
Qed.

(** The error. *)
Lemma largest_value : finite (largest _ F) /\ B2R (largest _ F) = M.
Proof.
  split; [reflexivity |]. unfold largest, floats, Bmax_float. rewrite B2R_SF2B, M_product. unfold SF2R, F2R.
  cbn [Fnum Fexp SpecFloat.cond_Zopp]. f_equal. f_equal.
  assert (H : (2 <= 2 ^ p)%Z) by (change 2%Z with (2 ^ 1)%Z at 1; apply Z.pow_le_mono_r; lia).
  assert (E : Z.pos (shift_pos (Z.to_pos p) 1) = (2 ^ p)%Z).
  { rewrite shift_pos_correct, Z.mul_1_r. change (2 ^ Z.pos (Z.to_pos p) = 2 ^ p)%Z.
    now rewrite Z2Pos.id by lia. }
  rewrite Pos2Z.inj_sub by lia. now rewrite E.
Qed.
Lemma difference_0 x y : number x -> number y -> fl (x - y) = 0 -> x = y.
Proof.
  intros X Y H. enough (x - y = 0) by lra.
  destruct (Rlt_or_le (Rabs (x - y)) (Format.smallest_normal p emin)) as [L | L].
  - rewrite <- H. symmetry. apply (Format.sum_exact_below p emin Format.nearest); auto using Format.number_opp.
  - exfalso. apply (Format.rnd_abs_above p emin Format.nearest) in L; [| now apply Format.number_smallest_normal].
    rewrite H, Rabs_R0 in L. generalize (Format.smallest_normal_positive p emin). lra.
Qed.
Lemma max_finite m n : m = plus_infinity \/ finite m -> n = plus_infinity \/ finite n ->
  max _ F m n = plus_infinity \/
  (finite m /\ finite n /\ finite (max _ F m n) /\ B2R m <= B2R (max _ F m n) /\ B2R n <= B2R (max _ F m n)).
Proof.
  intros [-> | HM] [-> | HN]; auto.
  - left. destruct n as [| [|] | |]; try discriminate; auto.
  - left. destruct m as [| [|] | | [|]]; try discriminate; auto.
  - right. unfold max. rewrite less_finite by auto. case Rlt_bool_spec; intros; repeat split; auto; lra.
Qed.
Lemma sign_range (x : float) : if Bsign x then B2R x <= 0 else 0 <= B2R x.
Proof.
  destruct x as [s | s | | s m e H]; simpl; try (destruct s; lra); try lra.
  destruct s; [apply F2R_le_0 | apply F2R_ge_0]; simpl; lia.
Qed.
Lemma difference_above x y : finite x -> finite y -> B2R y <= B2R x ->
  x ⊖ y = plus_infinity \/ finite (x ⊖ y).
Proof.
  intros X Y H. generalize (Bminus_correct p emax _ _ mode_NE x y X Y). case Rlt_bool_spec; intros C; [tauto |].
  intros [E S]. left. generalize (sign_range x) (sign_range y). rewrite S in *.
  destruct (Bsign y); simpl negb in *; intros S1 S2.
  - revert E. simpl. destruct (Bminus mode_NE x y); try discriminate. intros E. now injection E as ->.
  - exfalso. replace (B2R x - B2R y) with 0 in C by lra.
    rewrite round_0, Rabs_R0 in C by auto with typeclass_instances. generalize (bpow_gt_0 radix2 emax). lra.
Qed.

Lemma interval_error_nonnegative a A x : interval_known a A x -> nonnegative p emax (interval_error _ F a A).
Proof.
  destruct A as [l u]. intros K. unfold interval_error. cbv zeta. cbn [fst snd].
  assert (P : nonnegative p emax (u ⊖ a) /\ nonnegative p emax (a ⊖ l)).
  { destruct K as [E | (L & W & FA & HA & _)].
    - injection E as -> ->. destruct a as [| [|] | |]; easy.
    - cbn [fst snd] in *.
      destruct (difference_above u a W FA (proj2 HA)) as [E1 | F1], (difference_above a l FA L (proj1 HA)) as [E2 | F2];
        rewrite ?E1, ?E2; split; try reflexivity; apply nonnegative_intro; auto;
        match goal with H : finite (?y ⊖ ?z) |- 0 <= B2R (?y ⊖ ?z) =>
          apply minus_finite in H; destruct H as (_ & _ & ->) end;
        apply (Format.rnd_nonnegative p emin Format.nearest); lra. }
  set (off := max _ F (u ⊖ a) (a ⊖ l)).
  assert (PO : nonnegative p emax off) by (unfold off, max; destruct (less _ F _ _); tauto).
  destruct (equal _ F off (integer _ F 0)); auto.
  destruct (_ && _); [reflexivity |]. apply nonnegative_plus; auto. unfold step.
  assert (nonnegative p emax (five_quarters _ F)).
  { destruct five_quarters_value as [FF E]. apply nonnegative_intro; auto. rewrite E. lra. }
  positive.
Qed.
Theorem interval_error_known a A x : interval_known a A x -> finite (interval_error _ F a A) ->
  finite a /\ Rabs (B2R a - x) <= B2R (interval_error _ F a A).
Proof.
  destruct zero_value' as [Z0 Z]. destruct A as [l u]. intros [E | (L & W & FA & HA & HX)].
  { injection E as -> ->. unfold interval_error. cbv zeta. cbn [fst snd].
    set (off := max _ F (plus_infinity ⊖ a) (a ⊖ minus_infinity)).
    assert (NF : ~ finite off /\ equal _ F off (integer _ F 0) = false)
      by (unfold off; destruct a as [| [|] | |]; split; try discriminate; reflexivity).
    destruct NF as [NF ->]. change (interval_sign _ F (minus_infinity, plus_infinity)) with uncertain.
    cbn [andb]. intros H. apply above_finite in H. destruct H as [H _]. contradiction. }
  cbn [fst snd] in *. unfold interval_error. cbv zeta. cbn [fst snd].
  set (off := max _ F (u ⊖ a) (a ⊖ l)). set (enough := above _ F off).
  match goal with |- context [?c && negb (less _ F enough _)] => set (certain := c) end.
  assert (Certain : certain = true -> Rabs (B2R a - x) <= M).
  { unfold certain, interval_sign. cbn [fst snd]. rewrite !less_finite, !equal_finite, Z by assumption.
    generalize (le_M l) (le_M u). intros ML MU. apply Rabs_le_inv in ML, MU.
    destruct (Rlt_bool_spec 0 (B2R l)); [intros _; apply Rabs_le; lra |].
    destruct (Rlt_bool_spec (B2R u) 0); [intros _; apply Rabs_le; lra |].
    destruct (Req_bool_spec (B2R l) 0), (Req_bool_spec (B2R u) 0); cbn [andb]; try discriminate.
    intros _. apply Rabs_le. lra. }
  assert (Far : finite off -> Rabs (B2R a - x) <= Rmax (B2R u - B2R a) (B2R a - B2R l) /\
    fl (Rmax (B2R u - B2R a) (B2R a - B2R l)) <= B2R off).
  { intros FO. split.
    - apply Rabs_le. generalize (Rmax_l (B2R u - B2R a) (B2R a - B2R l)) (Rmax_r (B2R u - B2R a) (B2R a - B2R l)).
      lra.
    - destruct (max_finite _ _ (difference_above u a W FA (proj2 HA)) (difference_above a l FA L (proj1 HA)))
        as [E | (F1 & F2 & _ & O1 & O2)];
        [unfold off in FO; rewrite E in FO; discriminate FO |]; fold off in O1, O2.
      apply minus_finite in F1, F2. destruct F1 as (_ & _ & E1), F2 as (_ & _ & E2).
      rewrite E1 in O1. rewrite E2 in O2. apply Rmax_case; assumption. }
  clearbody off certain. destruct (equal _ F off (integer _ F 0)) eqn:C0.
  { intros FO. split; [exact FA |]. destruct (Far FO) as [F1 F2]. apply Rle_trans with (1 := F1).
    set (d := Rmax _ _) in *. rewrite equal_finite, Z in C0 by assumption.
    destruct (Req_bool_spec (B2R off) 0) as [O | O]; [| discriminate C0]. rewrite O in *.
    assert (D1 : B2R u - B2R a <= d) by apply Rmax_l. assert (D2 : B2R a - B2R l <= d) by apply Rmax_r.
    assert (D : 0 <= fl d) by (apply (Format.rnd_nonnegative p emin Format.nearest); lra).
    assert (D0 : fl d = 0) by lra. revert D0. unfold d.
    apply Rmax_case; intros D0; apply difference_0 in D0; try apply number_B2R; lra. }
  destruct (certain && negb (less _ F enough (largest _ F))) eqn:C1.
  - intros _. split; [exact FA |]. rewrite (proj2 largest_value).
    apply andb_prop in C1. destruct C1 as [C1 _]. exact (Certain C1).
  - intros H. split; [exact FA |]. unfold enough in *. apply above_finite in H as FO. destruct FO as [FO _].
    destruct (Far FO) as [F1 F2]. apply Rle_trans with (1 := F1). apply above_true; assumption.
Qed.
End Rules.
