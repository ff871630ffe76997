(** Bound rule `safe` over IEEE formats (Ieee.v), to nearest, including overflow, with any number of operations; p >=
    3, emax > p.

    A number x is known by a value a and (B, k) with B not negative. If a is finite and k < 2^29 (where counting
    stops), k = 0 only if B is |a|; if B is also finite, |x| <= B and |a - x| <= B((1 + eps)^k - 1). Results:
        safe_exact_known, safe_within_known, safe_add_known, safe_subtract_known, safe_multiply_known,
        safe_scale_known, safe_negate_known   the bound that the code returns holds
        safe_error_known   a finite error bounds |a - x|, and a is finite; from 2^29 operations on the error is never
                           finite (IeeeRules.v: `known`, and so the sign) *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code Ieee IeeeRules.
From Errbound Require Format Safe.
Open Scope R_scope.

Section Rules.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_3 : (3 <= p)%Z).
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation nonnegative := (nonnegative p emax).
Notation emin_p := (emin_p p emax p_3).
Notation real_known := (Safe.known p emin).
Notation enough_bits := (or_intror (conj p_3 eq_refl)).

Definition safe_known (a : float) (bound : float * Z) (x : R) : Prop :=
  let (B, k) := bound in
  nonnegative B /\ (0 <= k <= too_many)%Z /\
  (finite a -> (k < too_many)%Z ->
    (k = 0%Z -> finite B /\ B2R B = Rabs (B2R a)) /\
    (finite B -> real_known (B2R a) x (B2R B, k))).

Lemma counted_range k : (0 <= k <= 2 * too_many)%Z -> (1 <= counted k <= too_many)%Z.
Proof.
  unfold counted, too_many. change (2 ^ 29)%Z with 536870912%Z.
  intros. destruct (Z.ltb_spec k (536870912 - 1)); lia.
Qed.
Lemma counted_below k : (counted k < too_many)%Z -> (k < too_many - 1)%Z.
Proof.
  unfold counted, too_many. change (2 ^ 29)%Z with 536870912%Z.
  destruct (Z.ltb_spec k (536870912 - 1)); lia.
Qed.

Lemma enlarged_finite b : finite (safe_enlarged _ F b) ->
  finite b /\ B2R (safe_enlarged _ F b) = Safe.enlarged p emin Format.nearest (B2R b).
Proof.
  unfold safe_enlarged, Safe.enlarged. intros H. apply times_finite in H. destruct H as (B & H & E).
  apply plus_finite in H. destruct H as (_ & H & E1). apply times_finite in H. destruct H as (_ & _ & E2).
  split; auto. rewrite E, E1, E2, (proj2 (eps_value p emax p_3)).
  now rewrite (proj2 (integer_value p emax p_3 1 ltac:(lia))), (proj2 (integer_value p emax p_3 4 ltac:(lia))).
Qed.
Lemma nonnegative_enlarged b : nonnegative b -> nonnegative (safe_enlarged _ F b).
Proof.
  intros. unfold safe_enlarged. apply nonnegative_times; auto.
  apply nonnegative_plus; auto; [apply nonnegative_integer; auto; lia |].
  apply nonnegative_times; auto; [apply nonnegative_integer; auto; lia | now apply nonnegative_eps].
Qed.

Lemma nonnegative_max x y : nonnegative x -> nonnegative y -> nonnegative (max _ F x y).
Proof. unfold max. now destruct (less _ F x y). Qed.
Lemma max_finite x y : nonnegative x -> nonnegative y -> BinarySingleNaN.is_nan y = false ->
  finite (max _ F x y) -> finite x /\ finite y /\ B2R (max _ F x y) = Rmax (B2R x) (B2R y).
Proof.
  unfold max. intros X Y N H. assert (FF : finite x /\ finite y).
  { revert H. destruct x as [| s | | s m e b], y as [| t | | t n f c]; simpl in *; try subst; easy. }
  destruct FF as [FX FY]. split; auto. split; auto. rewrite less_finite in * by auto.
  unfold Rmax. destruct (Rlt_bool_spec (B2R x) (B2R y)), (Rle_dec (B2R x) (B2R y)); lra.
Qed.

Lemma over_no_nan x y : BinarySingleNaN.is_nan x = false -> finite y -> B2R y <> 0 ->
  BinarySingleNaN.is_nan (x ⊘ y) = false.
Proof.
  intros X FY N. destruct (BinarySingleNaN.is_finite x) eqn:FX.
  - generalize (Bdiv_correct p emax _ _ mode_NE x y N). case Rlt_bool.
    + intros (_ & H & _). rewrite FX in H. revert H. unfold over, floats. now destruct (Bdiv mode_NE x y).
    + intros H. revert H. unfold over, floats. now destruct (Bdiv mode_NE x y).
  - destruct x, y; simpl in *; easy.
Qed.

Theorem safe_exact_known a : safe_known a (safe_exact _ F a) (B2R a).
Proof.
  unfold safe_known, safe_exact. split; [now apply nonnegative_abs |].
  split; [unfold too_many; lia |]. intros FA _.
  assert (FB : finite (abs _ F a)) by now apply abs_finite_intro.
  destruct (abs_finite p emax p_3 _ FB) as [_ E]. rewrite E. split; auto.
  intros _. apply Safe.safe_exact_sound. apply number_B2R.
Qed.

(** A negative, infinite or NaN error gives an unknown number. *)
Theorem safe_within_known a error x :
  (finite error -> 0 <= B2R error -> Rabs (B2R a - x) <= B2R error) -> safe_known a (safe_within _ F a error) x.
Proof.
  intros K. unfold safe_within. destruct (zero_value p emax p_3) as [Z0 Z].
  destruct (equal _ F error (integer _ F 0)) eqn:C0.
  { apply equal_true in C0; auto. destruct C0 as [FE C0]. rewrite Z in C0.
    specialize (K FE ltac:(lra)). rewrite C0 in K. apply Format.within_0 in K. rewrite <- K. apply safe_exact_known. }
  destruct (less _ F (integer _ F 0) error) eqn:C1; cbn [negb].
  2: { unfold safe_known. split; [reflexivity |]. split; [unfold too_many; lia |].
    intros _ _. split; [discriminate | discriminate]. }
  assert (PE : nonnegative error).
  { destruct (less_true_0 p emax p_3 _ C1) as [P | ->]; [| reflexivity].
    apply nonnegative_intro; [| lra]. destruct error; simpl in *; try lra; easy. }
  destruct (eps_value p emax p_3) as [Fe Ve].
  assert (Ne : B2R (epsilon _ F) <> 0) by (rewrite Ve; apply Rgt_not_eq, bpow_gt_0).
  assert (P1 : nonnegative (abs _ F a ⊕ error)) by (apply nonnegative_plus; auto; now apply nonnegative_abs).
  assert (P2 : nonnegative (error ⊘ epsilon _ F)).
  { apply nonnegative_over; auto. now apply nonnegative_eps. }
  unfold safe_known. split; [now apply nonnegative_enlarged, nonnegative_max |].
  split; [unfold too_many; lia |]. intros FA _. split; [discriminate |]. intros FB.
  apply enlarged_finite in FB. destruct FB as [FM E]. rewrite E. apply max_finite in FM; auto.
  2: { apply over_no_nan; auto. destruct error; easy. }
  destruct FM as (F1 & F2 & EM). rewrite EM.
  apply plus_finite in F1. destruct F1 as (F1 & FE & E1). apply (abs_finite p emax p_3) in F1.
  destruct F1 as [_ E3]. apply over_finite in F2; auto. destruct F2 as [_ E2].
  rewrite E1, E2, E3, Ve.
  assert (0 < B2R error) by (rewrite less_finite, Z in C1 by auto; revert C1; now case Rlt_bool_spec).
  apply (Safe.safe_within_sound p emin Format.nearest enough_bits emin_p); auto using number_B2R.
  apply K; auto. lra.
Qed.

Lemma add_known v a A x b B y s : safe_known a A x -> safe_known b B y ->
  (finite v -> finite a /\ finite b) ->
  (forall Ba ka Bb kb, (Z.max ka kb < 2 ^ 29)%Z -> finite v ->
    real_known (B2R a) x (Ba, ka) -> real_known (B2R b) y (Bb, kb) ->
    real_known (B2R v) s (Safe.safe_add p emin Format.nearest Ba ka Bb kb)) ->
  safe_known v (safe_add _ F (fst A) (snd A) (fst B) (snd B)) s.
Proof.
  destruct A as [Ba ka], B as [Bb kb]. intros (PA & RA & KA) (PB & RB & KB) FV Sound.
  unfold safe_add. cbn [fst snd].
  replace (if (ka <? kb)%Z then kb else ka) with (Z.max ka kb)
    by (destruct (Z.ltb_spec ka kb); lia).
  unfold safe_known.
  split; [now apply nonnegative_enlarged, nonnegative_plus |].
  assert (R := counted_range (Z.max ka kb) ltac:(lia)). split; [lia |].
  intros V C. apply counted_below in C. split; [lia |]. intros FB.
  apply enlarged_finite in FB. destruct FB as [FB E]. apply plus_finite in FB.
  destruct FB as (FA & FB & E1). rewrite E, E1. destruct (FV V) as [FFA FFB].
  apply Sound; auto; [unfold too_many in C; lia | apply KA | apply KB]; auto; lia.
Qed.

Theorem safe_add_known a A x b B y : safe_known a A x -> safe_known b B y ->
  safe_known (a ⊕ b) (safe_add _ F (fst A) (snd A) (fst B) (snd B)) (x + y).
Proof.
  intros KA KB. apply (add_known _ _ _ _ _ _ _ _ KA KB).
  - intros H. apply plus_finite in H. tauto.
  - intros Ba ka Bb kb Few H LA LB. apply plus_finite in H. destruct H as (_ & _ & ->).
    apply (Safe.safe_add_sound p emin Format.nearest enough_bits emin_p); auto using number_B2R.
Qed.
Theorem safe_subtract_known a A x b B y : safe_known a A x -> safe_known b B y ->
  safe_known (a ⊖ b) (safe_add _ F (fst A) (snd A) (fst B) (snd B)) (x - y).
Proof.
  intros KA KB. apply (add_known _ _ _ _ _ _ _ _ KA KB).
  - intros H. apply minus_finite in H. tauto.
  - intros Ba ka Bb kb Few H LA LB. apply minus_finite in H. destruct H as (_ & _ & ->).
    apply (Safe.safe_subtract_sound p emin Format.nearest enough_bits emin_p); auto using number_B2R.
Qed.

Lemma is_zero_known a B k x : safe_known a (B, k) x -> safe_is_zero _ F a k = true ->
  finite a /\ B2R a = 0 /\ x = 0.
Proof.
  intros (_ & _ & K) C. unfold safe_is_zero in C. apply andb_prop in C. destruct C as [C0 C].
  destruct (zero_value p emax p_3) as [Z0 Z]. apply equal_true in C0; auto. rewrite Z in C0.
  destruct C0 as [FA A]. split; auto. split; auto. apply Z.eqb_eq in C. subst k.
  destruct (K FA eq_refl) as [E H]. specialize (E eq_refl). destruct E as [FB E].
  destruct (H FB) as (_ & _ & _ & D). cbn [fst snd] in D. rewrite E, A, Rabs_R0, Rmult_0_l in D.
  apply Format.within_0 in D. auto.
Qed.

Theorem safe_multiply_known a A x b B y : safe_known a A x -> safe_known b B y ->
  safe_known (a ⊗ b) (safe_multiply _ F a (fst A) (snd A) b (fst B) (snd B)) (x * y).
Proof.
  destruct A as [Ba ka], B as [Bb kb]. cbn [fst snd]. intros KA KB. unfold safe_multiply.
  destruct (safe_is_zero _ F a ka || safe_is_zero _ F b kb) eqn:C.
  - destruct (zero_value p emax p_3) as [Z0 Z].
    assert (V : finite (a ⊗ b) -> B2R (a ⊗ b) = 0).
    { intros H. apply zero_times; auto. apply orb_prop in C. destruct C as [C | C].
      - left. now apply (is_zero_known _ _ _ _ KA C).
      - right. now apply (is_zero_known _ _ _ _ KB C). }
    assert (XY : x * y = 0).
    { apply orb_prop in C. destruct C as [C | C].
      - destruct (is_zero_known _ _ _ _ KA C) as (_ & _ & ->). ring.
      - destruct (is_zero_known _ _ _ _ KB C) as (_ & _ & ->). ring. }
    unfold safe_known. split; [apply nonnegative_integer; auto; lia |].
    split; [unfold too_many; lia |]. intros H _. rewrite (V H), Z, XY, Rabs_R0. split; auto.
    intros _. unfold Safe.known. cbn [fst snd]. rewrite Rminus_0_r, Rabs_R0.
    repeat split; try lra; try lia. apply Format.number_0.
  - generalize KA KB. intros (PA & RA & LA) (PB & RB & LB). unfold safe_known.
    assert (PP : nonnegative (safe_enlarged _ F (Ba ⊗ Bb))) by now apply nonnegative_enlarged, nonnegative_times.
    destruct (smallest_normal_value p emax p_3) as [Fm Vm].
    assert (Pm : nonnegative (smallest_normal _ F)).
    { apply nonnegative_intro; auto. rewrite Vm. apply bpow_ge_0. }
    split; [now apply nonnegative_max |].
    assert (R := counted_range (ka + kb) ltac:(lia)). split; [lia |].
    intros H Few. apply counted_below in Few. split; [lia |]. intros FM. apply max_finite in FM; auto.
    2: { destruct (smallest_normal _ F); easy. }
    destruct FM as (FE & _ & EM). apply enlarged_finite in FE. destruct FE as [FE EE].
    apply times_finite in FE. destruct FE as (FA & FB & ET). rewrite EM, EE, ET, Vm.
    apply times_finite in H. destruct H as (FFA & FFB & ->).
    destruct (LA FFA ltac:(lia)) as [_ LA'], (LB FFB ltac:(lia)) as [_ LB'].
    assert (T := Safe.safe_multiply_sound p emin Format.nearest enough_bits emin_p (B2R a) x (B2R Ba) ka
                   (B2R b) y (B2R Bb) kb (number_B2R _ _ _) (number_B2R _ _ _) (LA' FA) (LB' FB)
                   ltac:(unfold too_many in *; lia)).
    unfold Safe.safe_multiply in T.
    assert (Same : forall c k, finite c -> safe_is_zero _ F c k = Safe.is_zero (B2R c) k).
    { intros c k FC. destruct (zero_value p emax p_3) as [Z0 Z].
      unfold safe_is_zero, Safe.is_zero. now rewrite equal_finite, Z. }
    rewrite <- !Same, C in T by auto. exact T.
Qed.

Lemma round_abs w : round radix2 (SpecFloat.fexp p emax) (round_mode mode_NE) (Rabs w) =
  Rabs (round radix2 (SpecFloat.fexp p emax) (round_mode mode_NE) w).
Proof. exact (round_NE_abs radix2 (FLT_exp emin p) w). Qed.

Theorem safe_scale_known a A x e : safe_known a A x ->
  safe_known (scale _ F a e) (safe_scale _ F (scale _ F a e) a (fst A) (snd A) e) (x * bpow radix2 e).
Proof.
  destruct A as [B k]. cbn [fst snd]. intros (PB & RB & KB). unfold safe_scale. cbv zeta.
  destruct (smallest_normal_value p emax p_3) as [Fm Vm].
  assert (Pm : nonnegative (smallest_normal _ F)).
  { apply nonnegative_intro; auto. rewrite Vm. apply bpow_ge_0. }
  assert (Ps : nonnegative (scale _ F B e)) by now apply nonnegative_scale.
  set (v := scale _ F a e). set (s := scale _ F B e) in *.
  assert (Real : finite v -> finite s -> (k < too_many)%Z ->
    real_known (B2R v) (x * bpow radix2 e)
      (if (0 <=? e)%Z || (equal _ F (scale _ F v (- e)) a && equal _ F (scale _ F s (- e)) B)
       then (B2R s, k)
       else (Rmax (Safe.enlarged p emin Format.nearest (B2R s)) (Format.smallest_normal p emin), counted k))).
  { intros V S Few. apply scale_finite in V as V', S as S'. destruct V' as [FA EV], S' as [FB ES].
    change (B2R v = fl (B2R a * bpow radix2 e)) in EV. change (B2R s = fl (B2R B * bpow radix2 e)) in ES.
    destruct (KB FA Few) as [_ K]. rewrite !scale_equal, ES, EV by auto.
    apply (Safe.safe_scale_sound p emin Format.nearest enough_bits emin_p); auto using number_B2R. }
  destruct ((0 <=? e)%Z || (equal _ F (scale _ F v (- e)) a && equal _ F (scale _ F s (- e)) B)) eqn:C.
  - unfold safe_known. split; auto. split; auto. intros V Few. split; [| now intros S; apply Real].
    intros ->. apply scale_finite in V as V'. destruct V' as [FA EV].
    destruct (KB FA Few) as [K0 _]. destruct (K0 eq_refl) as [FB EB].
    generalize (Bldexp_correct p emax _ _ mode_NE B e) (Bldexp_correct p emax _ _ mode_NE a e).
    rewrite EB.
    replace (Rabs (B2R a) * bpow radix2 e) with (Rabs (B2R a * bpow radix2 e)).
    2: { rewrite Rabs_mult, (Rabs_pos_eq (bpow _ _)); auto. apply bpow_ge_0. }
    rewrite (round_abs (B2R a * bpow radix2 e)), Rabs_Rabsolu.
    case Rlt_bool.
    + intros (EB' & FB' & _) (EA' & _). unfold s, v, scale, floats. rewrite FB', EB', EA'. auto.
    + intros _ O. exfalso. revert V. unfold v, scale, floats. now destruct (Bldexp mode_NE a e).
  - unfold safe_known. split; [now apply nonnegative_max; [apply nonnegative_enlarged |] |].
    assert (R := counted_range k ltac:(lia)). split; [lia |].
    intros V Few. apply counted_below in Few. split; [lia |]. intros FM. apply max_finite in FM; auto.
    2: now apply nonnegative_enlarged.
    2: { destruct (smallest_normal _ F); easy. }
    destruct FM as (FE & _ & EM). apply enlarged_finite in FE. destruct FE as [FE EE].
    rewrite EM, EE, Vm. apply Real; auto. lia.
Qed.

Theorem safe_negate_known a A x : safe_known a A x -> safe_known (opposite _ F a) A (- x).
Proof.
  destruct A as [B k]. intros (PB & RB & KB). split; auto. split; auto. intros FA Few.
  apply opposite_finite in FA. destruct (KB FA Few) as [K0 K]. rewrite opposite_value, Rabs_Ropp.
  split; auto. intros FB. destruct (K FB) as (N & G & X & D). unfold Safe.known. rewrite Rabs_Ropp.
  replace (- B2R a - - x) with (- (B2R a - x)) by ring. rewrite Rabs_Ropp. auto.
Qed.

(** The error of tracked numbers is infinite from 2^29 operations on. *)
Theorem safe_error_known a A x : safe_known a A x -> known p emax a (safe_error _ F a (fst A) (snd A)) x.
Proof.
  destruct A as [B k]. cbn [fst snd]. intros (PB & RB & KB). unfold safe_error. cbv zeta.
  destruct (integer_value p emax p_3 1 ltac:(lia)) as [F1 V1].
  destruct (negb (at_most _ F (integer _ F k ⊗ epsilon _ F) (integer _ F 1)) || (k =? too_many)%Z ||
            negb (is_finite _ F a)) eqn:C; [split; [reflexivity | discriminate] |].
  apply orb_false_elim in C. destruct C as [C Ca]. apply orb_false_elim in C. destruct C as [C1 C2].
  apply negb_false_iff in C1, Ca. apply Z.eqb_neq in C2.
  assert (FA : finite a).
  { destruct (BinarySingleNaN.is_finite a) eqn:FA; auto. exfalso. revert Ca. unfold is_finite, abs.
    destruct a as [| s | |]; try discriminate; destruct s; discriminate. }
  destruct (KB FA ltac:(lia)) as [K0 K].
  assert (Pk : nonnegative (integer _ F k)).
  { generalize (binary_normalize_correct p emax _ _ mode_NE k 0 false). cbv zeta. case Rlt_bool.
    - intros (E & FK & _). apply nonnegative_intro; auto. simpl integer. unfold constant. rewrite E.
      apply (Format.rnd_nonnegative p emin Format.nearest). unfold F2R. simpl. rewrite Rmult_1_r.
      apply IZR_le. lia.
    - intros O. apply (nonnegative_overflow _ _ _ _ O). apply Rlt_bool_false. unfold F2R. simpl.
      rewrite Rmult_1_r. apply IZR_le. lia. }
  assert (Px : nonnegative (integer _ F k ⊗ epsilon _ F)).
  { apply nonnegative_times; auto. now apply nonnegative_eps. }
  assert (Fx : finite (integer _ F k ⊗ epsilon _ F)).
  { destruct (integer _ F k ⊗ epsilon _ F) as [| s | |] eqn:Ex; try easy.
    simpl in Px. subst s. revert C1. now destruct (integer _ F 1). }
  assert (Ek : B2R (integer _ F k ⊗ epsilon _ F) = fl (fl (IZR k) * Format.eps p)).
  { apply times_finite in Fx. destruct Fx as (Fk & _ & E). rewrite E, (proj2 (eps_value p emax p_3)).
    f_equal. f_equal. generalize (binary_normalize_correct p emax _ _ mode_NE k 0 false). cbv zeta.
    case Rlt_bool.
    - intros (E' & _). simpl integer. unfold constant. rewrite E'. unfold F2R. simpl Fnum. simpl Fexp.
      change (bpow radix2 0) with 1. now rewrite Rmult_1_r.
    - intros O. exfalso. revert Fk O. simpl integer. unfold constant.
      destruct (binary_normalize p emax p_positive p_below mode_NE k 0 false); discriminate. }
  rewrite at_most_finite, V1, Ek in C1 by auto.
  assert (S : forall bound, Safe.safe_error p emin Format.nearest (B2R B) k = Some bound -> finite B ->
              Rabs (B2R a - x) <= bound).
  { intros bound EB FB. apply (Safe.safe_error_sound p emin Format.nearest enough_bits emin_p) with (B := B2R B) (k := k); auto.
    generalize (p_emax p emax). lia. }
  unfold Safe.safe_error in S. cbv zeta in S. rewrite C1 in S. cbn [negb orb] in S.
  change Safe.too_many with too_many in S. rewrite (proj2 (Z.eqb_neq _ _) C2) in S.
  destruct (Z.eqb_spec k 0) as [E0 | E0].
  - split; [apply nonnegative_integer; auto; lia |]. intros _. split; auto.
    rewrite (proj2 (zero_value p emax p_3)). apply S; auto. now apply K0.
  - split.
    + apply nonnegative_enlarged, nonnegative_plus; auto; [| now apply nonnegative_eta].
      apply nonnegative_times; auto. apply nonnegative_enlarged, nonnegative_times; auto.
      apply nonnegative_plus; auto. apply nonnegative_integer; auto; lia.
    + intros H. apply enlarged_finite in H. destruct H as [H E]. apply plus_finite in H.
      destruct H as (H & _ & Es). apply times_finite in H. destruct H as (FB & H & Et).
      apply enlarged_finite in H. destruct H as [H Eu]. apply times_finite in H. destruct H as (_ & H & Ev).
      apply plus_finite in H. destruct H as (_ & _ & Ew). split; auto.
      rewrite E, Es, Et, Eu, Ev, Ew, V1, Ek, (proj2 (eta_value p emax p_3)). now apply S.
Qed.

End Rules.
