(** Bound rule `residual` (include/errbound/rules/residual.hpp) over IEEE formats (Ieee.v), to nearest, including
    overflow; p >= 3, emax > p.

    A number x is known by its value v, correction c and remainder r. The remainder r is not negative, but possibly
    infinite or NaN. If c and r are finite, so is v, and |v + c - x| <= r. Results: the bounds that the code returns
    hold:
        residual_exact_known, residual_within_known, residual_negate_known, residual_add_known,
        residual_subtract_known, residual_multiply_known, residual_divide_known (with fused multiply-add and without,
        `fused`), residual_scale_known
        residual_displacement_known   a number that is 0 is known by any value and `displacement`
        residual_error_known   the error is one, in the sense of IeeeRules.v
        residual_sign_known    the rule's sign is right or uncertain *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code Ieee IeeeRules.
From Errbound Require Format Residual ResidualProduct ErrorFree IeeeInterval.
Open Scope R_scope.

Section Rules.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_3 : (3 <= p)%Z).
Variable fused : bool.  (* has_fast_fma *)
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation nonnegative := (nonnegative p emax).
Notation emin_p := (emin_p p emax p_3).
Notation holds := (Residual.holds p emin).

Ltac parts := finite_parts p emax p_3.
Ltac values := known_values p emax p_3.

Definition residual_known (v : float) (b : float * float) (x : R) : Prop :=
  nonnegative (snd b) /\
  (finite (fst b) -> finite (snd b) -> finite v /\ holds (B2R v) (B2R (fst b)) (B2R (snd b)) x).

Lemma inflated_finite b : finite (residual_inflated _ F b) ->
  finite b /\ B2R (residual_inflated _ F b) = Residual.inflated p emin (B2R b).
Proof. unfold residual_inflated, Residual.inflated. intros H. parts. split; auto. now values. Qed.
Lemma nonnegative_inflated b : nonnegative b -> nonnegative (residual_inflated _ F b).
Proof. intros. unfold residual_inflated. positive. Qed.
(** A finite error of two_sum is that over real numbers. *)
Lemma two_sum_finite a b : finite (snd (two_sum _ F a b)) ->
  finite a /\ finite b /\
  B2R (fst (two_sum _ F a b)) = fst (ErrorFree.two_sum p emin (B2R a) (B2R b)) /\
  B2R (snd (two_sum _ F a b)) = snd (ErrorFree.two_sum p emin (B2R a) (B2R b)).
Proof.
  unfold two_sum, ErrorFree.two_sum. cbn [fst snd]. intros H. parts. repeat split; auto; now values.
Qed.

Theorem residual_exact_known v : residual_known v (residual_exact _ F v) (B2R v).
Proof.
  split; [apply nonnegative_nothing; auto |]. unfold residual_exact. cbn [fst snd]. intros _ H. parts.
  split; auto. values. apply Residual.residual_exact_sound; auto using number_B2R, emin_p.
Qed.
(** A negative, infinite or NaN error gives an unknown number. *)
Theorem residual_within_known v error x :
  (finite error -> 0 <= B2R error -> Rabs (B2R v - x) <= B2R error) ->
  residual_known v (residual_within _ F v error) x.
Proof.
  intros K. generalize (tight_within_known p emax p_3 v error x K).
  unfold tight_within, residual_within. intros [P H].
  split; [exact P |]. cbn [fst snd]. intros _ FR. destruct (H FR) as [V E]. split; auto.
  values. repeat split; auto using number_B2R, Format.number_0. now rewrite Rplus_0_r.
Qed.
Theorem residual_negate_known v b x : residual_known v b x ->
  residual_known (opposite _ F v) (residual_negate _ F b) (- x).
Proof.
  intros [P K]. split; [exact P |]. unfold residual_negate. cbn [fst snd]. intros C N.
  apply opposite_finite in C. destruct (K C N) as [V H]. rewrite !opposite_value. split.
  - simpl. now rewrite is_finite_Bopp.
  - now apply Residual.residual_negate_sound.
Qed.

(** The remainder of a sum, from ra, rb and the errors e and f of its corrections. *)
Lemma remainders_finite ra rb e f : nonnegative ra -> nonnegative rb ->
  let lost := abs _ F e ⊕ abs _ F f in
  let bound := sum_of_bounds _ F (residual_inflated _ F (ra ⊕ rb ⊕ lost)) (residual_inflated _ F lost) ra rb in
  finite bound -> finite ra /\ finite rb /\ finite e /\ finite f /\
  B2R ra + B2R rb + (Rabs (B2R e) + Rabs (B2R f)) <= B2R bound.
Proof.
  intros PA PB lost bound H. unfold bound in *. clear bound. assert (PL : nonnegative lost) by (unfold lost; positive).
  assert (Lost : finite lost -> finite e /\ finite f /\ B2R lost = fl (Rabs (B2R e) + Rabs (B2R f))).
  { unfold lost. intros L. parts. repeat split; auto. now values. }
  assert (NE := Format.number_abs p emin _ (number_B2R p emax e)).
  assert (NF := Format.number_abs p emin _ (number_B2R p emax f)).
  destruct (sum_of_bounds_finite p emax p_3 (residual_inflated _ F (ra ⊕ rb ⊕ lost)) (residual_inflated _ F lost) ra rb)
    as [E | (FO & FA & FB & L)]; auto using nonnegative_inflated.
  - rewrite E in H |- *. apply inflated_finite in H. destruct H as [H ->].
    assert (G := plus_finite p emax _ _ H). destruct G as (FAB & FL & ->).
    assert (G := plus_finite p emax _ _ FAB). destruct G as (FA & FB & ->).
    destruct (Lost FL) as (FE & FF & ->). repeat split; auto.
    apply Residual.inflated_remainders; auto using number_B2R, Rabs_pos, emin_p;
      now apply (nonnegative_value p emax).
  - apply inflated_finite in FO. destruct FO as [FL EO]. destruct (Lost FL) as (FE & FF & EL).
    repeat split; auto. rewrite EO, EL in L.
    generalize (Residual.inflated_losses p emin p_3 emin_p _ _ NE NF (Rabs_pos _) (Rabs_pos _)). lra.
Qed.
Lemma sum_known v a sa x b sb y : (finite v -> B2R v = fl (B2R a + B2R b)) ->
  residual_known a sa x -> residual_known b sb y ->
  residual_known v (residual_add _ F v a sa b sb) (x + y).
Proof.
  intros V [PA KA] [PB KB]. unfold residual_add. cbv zeta. split; cbn [fst snd].
  { apply nonnegative_plus; auto using nonnegative_nothing.
    apply nonnegative_sum_of_bounds; auto; apply nonnegative_inflated; positive. }
  intros FC FR. apply plus_finite in FR. destruct FR as (FS & FN & ER).
  assert (G := minus_finite p emax _ _ FN). destruct G as (FV & _ & EN). specialize (V FV).
  apply remainders_finite in FS; auto. destruct FS as (RA & RB & FE & FF & L).
  apply two_sum_finite in FE. destruct FE as (CA & CB & E3 & E4).
  apply two_sum_finite in FF. destruct FF as (FO & _ & E1 & E2).
  apply two_sum_finite in FO. destruct FO as (_ & _ & _ & E5).
  destruct (KA CA RA) as [_ HA], (KB CB RB) as [_ HB]. split; auto.
  assert (D := Residual.residual_sum_error p emin p_3 emin_p _ _ _ _ _ _ _ _ HA HB). cbv zeta in D.
  rewrite E4, E2, E5, E3 in L. rewrite <- V in D. repeat split; auto using number_B2R.
  rewrite ER, EN, Rminus_eq_0, (Format.rnd_0 p emin Format.nearest), Rplus_0_r,
    (Format.rnd_exact p emin Format.nearest) by apply number_B2R.
  rewrite E1, E5, E3. lra.
Qed.
Theorem residual_add_known a sa x b sb y : residual_known a sa x -> residual_known b sb y ->
  residual_known (a ⊕ b) (residual_add _ F (a ⊕ b) a sa b sb) (x + y).
Proof. apply sum_known. intros H. now apply plus_finite in H. Qed.
Theorem residual_subtract_known a sa x b sb y : residual_known a sa x -> residual_known b sb y ->
  residual_known (a ⊖ b) (residual_subtract _ F (a ⊖ b) a sa b sb) (x - y).
Proof.
  intros KA KB. apply sum_known; auto using residual_negate_known. rewrite opposite_value.
  intros H. now apply minus_finite in H.
Qed.

(** A number with value d that is known to be 0. *)
Theorem residual_displacement_known d : finite d -> residual_known d (opposite _ F d, integer _ F 0) 0.
Proof.
  intros FD. destruct (zero_value p emax p_3) as [Z0 Z]. split; [now apply nonnegative_integer |]. cbn [fst snd].
  intros _ _. split; auto. rewrite opposite_value, Z. apply Residual.residual_displacement_sound, number_B2R.
Qed.

Theorem residual_scale_known a sa x e : residual_known a sa x ->
  residual_known (scale _ F a e) (residual_scale _ F (scale _ F a e) a sa e) (x * bpow radix2 e).
Proof.
  intros [P K]. unfold residual_scale. cbv zeta.
  set (v := scale _ F a e). set (c := scale _ F (fst sa) e). set (r := scale _ F (snd sa) e).
  assert (Pr : nonnegative r) by now apply nonnegative_scale.
  split; cbn [fst snd].
  { destruct (_ || _); [positive | apply nonnegative_inflated; positive]. }
  intros FC FR. generalize FC. intros C. apply scale_finite in C as [C EC]. change (B2R c = fl (B2R (fst sa) * bpow radix2 e)) in EC.
  assert (FS : finite r /\ finite v).
  { destruct (_ || _) eqn:L.
    - parts. auto.
    - apply inflated_finite in FR. destruct FR as [FR _]. parts. split; auto.
      apply orb_false_iff in L. destruct L as [L _]. apply Z.leb_gt in L.
      match goal with H : finite r |- _ => apply scale_finite in H; destruct H as [H _] end.
      apply scale_down_finite; auto. now apply K. }
  destruct FS as [FR' FV]. generalize FR' FV. intros R A.
  apply scale_finite in R as [R ER]. apply scale_finite in A as [A EV].
  change (B2R r = fl (B2R (snd sa) * bpow radix2 e)) in ER. change (B2R v = fl (B2R a * bpow radix2 e)) in EV.
  split; auto. destruct (K C R) as [_ H].
  generalize (Residual.residual_scale_sound p emin p_3 emin_p _ _ _ _ e H).
  unfold Residual.residual_scale. cbv zeta. cbn [fst snd]. rewrite <- EV, <- EC, <- ER.
  rewrite !(scale_equal p emax) in FR by auto. rewrite !(scale_equal p emax) by auto.
  clear EV EC ER. destruct (_ || _); intros T.
  - parts. now values.
  - apply inflated_finite in FR. destruct FR as [FR E]. rewrite E. parts. now values.
Qed.

Lemma error_finite c r : finite (residual_error _ F (c, r)) ->
  finite c /\ finite r /\ B2R (residual_error _ F (c, r)) = Residual.residual_error p emin (B2R c) (B2R r).
Proof.
  destruct (zero_value p emax p_3) as [Z0 Z]. unfold residual_error, Residual.residual_error. cbn [fst snd].
  destruct (equal _ F r (integer _ F 0)) eqn:E.
  - apply equal_true in E; auto. destruct E as [FR E]. rewrite E, Z, Req_bool_true by auto. intros H. parts. auto.
  - intros H. apply inflated_finite in H. destruct H as [H EI]. parts. rewrite equal_finite, Z in E by auto.
    rewrite E. repeat split; auto. now values.
Qed.
Theorem residual_error_known v b x : residual_known v b x -> known p emax v (residual_error _ F b) x.
Proof.
  destruct b as [c r]. intros [P K]. cbn [fst snd] in *. split.
  - unfold residual_error. cbn [fst snd]. destruct (equal _ F r _); [positive |].
    apply nonnegative_inflated. positive.
  - intros H. apply error_finite in H. destruct H as (C & N & ->). destruct (K C N) as [V H]. split; auto.
    apply (Residual.residual_error_sound p emin p_3 emin_p _ _ _ _ H).
Qed.

(** A sum that overflows is larger than any number. *)
Lemma sign_value (v : float) : finite v -> if Bsign v then B2R v <= 0 else 0 <= B2R v.
Proof.
  destruct v as [s | | | s m e b]; try easy; simpl; intros _.
  - destruct s; lra.
  - destruct s; [apply F2R_le_0 | apply F2R_ge_0]; simpl; lia.
Qed.
Lemma sum_overflows v c (r : float) : finite v -> finite c -> ~ finite (v ⊕ c) ->
  (v ⊕ c = B754_infinity false /\ Rabs (B2R r) < B2R v + B2R c) \/
  (v ⊕ c = B754_infinity true /\ B2R v + B2R c < - Rabs (B2R r)).
Proof.
  intros V C N. generalize (Bplus_correct p emax _ _ mode_NE v c V C). case Rlt_bool_spec; intros L.
  { intros (_ & H & _). easy. }
  intros [O S].
  assert (G : Rabs (B2R r) < Rabs (B2R v + B2R c)).
  { apply Rnot_le_lt. intros D. apply (Rlt_not_le _ _ (abs_B2R_lt_emax p emax r)).
    apply Rle_trans with (1 := L). apply (Format.rnd_abs_below p emin Format.nearest); auto.
    apply Format.number_abs, number_B2R. }
  generalize (sign_value v V) (sign_value c C). rewrite <- S.
  assert (E : v ⊕ c = B754_infinity (Bsign v)).
  { revert O. simpl plus. destruct (Bplus mode_NE v c); try discriminate. now intros [= ->]. }
  rewrite E. destruct (Bsign v); intros PV PC.
  - right. split; auto. rewrite (Rabs_left1 (_ + _)) in G; lra.
  - left. split; auto. rewrite (Rabs_pos_eq (_ + _)) in G; lra.
Qed.
Theorem residual_sign_known v b x : residual_known v b x ->
  match residual_sign _ F v b with
  | negative => x < 0
  | zero => x = 0
  | positive => 0 < x
  | uncertain => True
  end.
Proof.
  destruct b as [c r]. intros [P K]. cbn [fst snd] in *. destruct (zero_value p emax p_3) as [Z0 Z].
  unfold residual_sign. cbv zeta. cbn [fst snd].
  assert (Real : finite (v ⊕ c) -> finite r -> finite (residual_inflated _ F r) ->
    match Residual.residual_sign p emin (B2R v) (B2R c) (B2R r) with
    | negative => x < 0 | zero => x = 0 | positive => 0 < x | uncertain => True end /\
    Residual.residual_sign p emin (B2R v) (B2R c) (B2R r) =
    if equal _ F (v ⊕ c) (integer _ F 0) && equal _ F r (integer _ F 0) then zero
    else if negb (less _ F (residual_inflated _ F r) (abs _ F (v ⊕ c))) then uncertain
    else if less _ F (integer _ F 0) (v ⊕ c) then positive else negative).
  { intros S R I. generalize S. intros S'. apply plus_finite in S'. destruct S' as (V & C & E).
    destruct (K C R) as [_ H]. split; [exact (Residual.residual_sign_sound p emin p_3 emin_p _ _ _ _ H) |].
    assert (A : finite (abs _ F (v ⊕ c))) by now apply abs_finite_intro.
    rewrite !equal_finite, !less_finite, Z by auto. destruct (abs_finite p emax p_3 _ A) as [_ ->].
    apply inflated_finite in I. destruct I as [_ ->]. rewrite E. reflexivity. }
  destruct (equal _ F (v ⊕ c) (integer _ F 0) && equal _ F r (integer _ F 0)) eqn:E0.
  { apply andb_prop in E0. destruct E0 as [E1 E2]. apply equal_true in E1, E2; auto.
    destruct E1 as [S E1], E2 as [R E2]. apply plus_finite in S. destruct S as (_ & C & S).
    destruct (K C R) as [_ H].
    generalize (Residual.residual_sign_sound p emin p_3 emin_p _ _ _ _ H).
    unfold Residual.residual_sign. cbv zeta. rewrite <- S, E1, E2, Z, Req_bool_true by auto. auto. }
  destruct (less _ F (residual_inflated _ F r) (abs _ F (v ⊕ c))) eqn:L; cbn [negb orb]; auto.
  destruct (is_finite _ F (residual_error _ F (c, r))) eqn:FE; cbn [negb]; auto.
  apply (IeeeInterval.is_finite_true p emax) in FE. apply error_finite in FE. destruct FE as (C & R & _).
  destruct (K C R) as [V H].
  destruct (BinarySingleNaN.is_finite (v ⊕ c)) eqn:S.
  - assert (I : finite (residual_inflated _ F r)).
    { generalize (nonnegative_inflated r P) (abs_finite_intro p emax (v ⊕ c) S). revert L.
      destruct (residual_inflated _ F r) as [| t | |], (abs _ F (v ⊕ c)); simpl; try easy;
        intros L ->; discriminate. }
    destruct (Real eq_refl R I) as [T E]. rewrite E in T. cbn [negb] in T. exact T.
  - clear Real. destruct H as (_ & _ & _ & H). apply Rabs_le_inv in H. generalize (Rle_abs (B2R r)). intros.
    destruct (sum_overflows v c r V C) as [[-> G] | [-> G]]; [congruence | |]; simpl; lra.
Qed.

(** Products and quotients. *)
Lemma half_ulp_finite v : finite (half_ulp _ F v) ->
  finite v /\ B2R (half_ulp _ F v) = Residual.half_ulp p emin (B2R v).
Proof. unfold half_ulp, Residual.half_ulp. intros H. parts. split; auto. now values. Qed.
Lemma nonnegative_half_ulp v : nonnegative (half_ulp _ F v).
Proof. unfold half_ulp. positive. Qed.
Lemma roundings_finite x y f s : finite (roundings _ F x y f s) ->
  finite x /\ finite y /\
  B2R (roundings _ F x y f s) = Residual.roundings p emin (B2R x) (B2R y) (B2R f) (B2R s).
Proof. unfold roundings, Residual.roundings. intros H. parts. repeat split; auto. now values. Qed.
Lemma is_exact_true b : residual_is_exact _ F b = true ->
  finite (fst b) /\ finite (snd b) /\ B2R (fst b) = 0 /\ B2R (snd b) = 0.
Proof.
  destruct (zero_value p emax p_3) as [Z0 Z]. intros H. apply andb_prop in H. destruct H as [H1 H2].
  apply equal_true in H1, H2; auto. rewrite Z in *. tauto.
Qed.
Lemma is_exact_value b : finite (fst b) -> finite (snd b) ->
  residual_is_exact _ F b = Residual.is_exact (B2R (fst b)) (B2R (snd b)).
Proof.
  destruct (zero_value p emax p_3) as [Z0 Z]. intros C N. unfold residual_is_exact, Residual.is_exact.
  now rewrite !equal_finite, Z.
Qed.
Lemma is_zero_value a b : finite a -> finite (fst b) -> finite (snd b) ->
  residual_is_zero _ F a b = Residual.is_zero (B2R a) (B2R (fst b)) (B2R (snd b)).
Proof.
  destruct (zero_value p emax p_3) as [Z0 Z]. intros A C N. unfold residual_is_zero, Residual.is_zero.
  now rewrite equal_finite, Z, is_exact_value.
Qed.
Lemma known_zero a b x : residual_known a b x -> residual_is_zero _ F a b = true -> x = 0 /\ B2R a = 0.
Proof.
  intros [_ K] H. generalize H. intros H'. apply andb_prop in H'. destruct H' as [_ E].
  apply is_exact_true in E. destruct E as (C & N & _). destruct (K C N) as [A HA].
  rewrite is_zero_value in H by auto. apply (ResidualProduct.holds_zero p emin _ _ _ _ HA H).
Qed.
(** A value that is certainly zero. *)
Lemma zero_known v : (finite v -> B2R v = 0) -> residual_known v (residual_exact _ F v) 0.
Proof.
  intros Z. destruct (residual_exact_known v) as [P K]. split; auto. intros C N.
  destruct (K C N) as [V H]. now rewrite (Z V) in H |- *.
Qed.

Theorem residual_multiply_known a sa x b sb y : residual_known a sa x -> residual_known b sb y ->
  residual_known (a ⊗ b) (residual_multiply _ F fused (a ⊗ b) a sa b sb) (x * y).
Proof.
  intros KA KB. destruct (zero_value p emax p_3) as [Z0 Z]. unfold residual_multiply.
  destruct (residual_is_zero _ F a sa || residual_is_zero _ F b sb) eqn:CZ.
  { assert (E : x * y = 0 /\ (B2R a = 0 \/ B2R b = 0)).
    { apply orb_prop in CZ. destruct CZ as [C | C].
      - destruct (known_zero _ _ _ KA C) as [-> A]. split; [ring | auto].
      - destruct (known_zero _ _ _ KB C) as [-> B]. split; [ring | auto]. }
    destruct E as [-> E]. apply zero_known. intros H. now apply (zero_times p emax). }
  destruct KA as [PA KA], KB as [PB KB]. generalize (IeeeInterval.product_known p emax p_3 fused a b).
  cbv zeta. set (error := snd (two_product _ F fused a b)).
  set (known := product_error_is_exact _ F fused a b (two_product _ F fused a b)). set (v := a ⊗ b). intros KP.
  assert (EV : finite v -> finite a /\ finite b /\ B2R v = fl (B2R a * B2R b)).
  { apply times_finite. }
  assert (KN : known = true -> B2R v + B2R error = B2R a * B2R b) by (intros H; now apply KP).
  assert (FK : known = true -> finite v /\ finite error) by (intros H; split; now apply KP).
  set (own := if known then error else integer _ F 0).
  set (unknown := if known then integer _ F 0 else half_ulp _ F v).
  assert (Pu : nonnegative unknown).
  { unfold unknown. destruct known; [positive | apply nonnegative_half_ulp]. }
  assert (O : finite unknown -> finite v /\ B2R own = (if known then B2R error else 0) /\
    B2R unknown = if known then 0 else Residual.half_ulp p emin (B2R v)).
  { unfold own, unknown. destruct known; intros H.
    - split; [now apply FK | auto].
    - apply half_ulp_finite in H. tauto. }
  assert (Real : finite unknown -> finite (fst sa) -> finite (snd sa) -> finite (fst sb) -> finite (snd sb) ->
    finite v /\ let (c, r) := ResidualProduct.residual_multiply p emin known (B2R error) (B2R v)
      (B2R a) (B2R (fst sa)) (B2R (snd sa)) (B2R b) (B2R (fst sb)) (B2R (snd sb)) in
      holds (B2R v) c r (x * y)).
  { intros FU CA RA CB RB. destruct (O FU) as (FV & _). split; auto. destruct (EV FV) as (FA & FB & E).
    rewrite E. apply (ResidualProduct.residual_multiply_sound p emin p_3 emin_p); auto using number_B2R.
    - now apply KA.
    - now apply KB.
    - intros H. rewrite <- E. auto. }
  destruct (residual_is_exact _ F sa && residual_is_exact _ F sb) eqn:CE; split; cbn [fst snd].
  - exact Pu.
  - intros _ FU. generalize CE. intros C. apply andb_prop in C. destruct C as [C1 C2].
    apply is_exact_true in C1, C2. destruct C1 as (CA & RA & _), C2 as (CB & RB & _).
    destruct (Real FU CA RA CB RB) as [FV T]. split; auto. destruct (O FU) as (_ & EO & EU).
    destruct (EV FV) as (FA & FB & _). unfold ResidualProduct.residual_multiply in T.
    rewrite <- !is_zero_value, CZ, <- !is_exact_value, CE in T by auto. now rewrite EO, EU.
  - apply nonnegative_inflated. positive.
  - intros FC FR. apply inflated_finite in FR. destruct FR as [FR ER]. rewrite ER. clear ER. parts.
    match goal with H : finite (roundings _ _ _ _ _ _) |- _ => apply roundings_finite in H; destruct H as (FX & FY & ?) end.
    parts. destruct (Real ltac:(auto) ltac:(auto) ltac:(auto) ltac:(auto) ltac:(auto)) as [FV T]. split; auto.
    destruct (O ltac:(auto)) as (_ & EO & EU). unfold ResidualProduct.residual_multiply in T.
    rewrite <- !is_zero_value, CZ, <- !is_exact_value, CE in T by auto. cbv zeta in T. rewrite <- EO, <- EU in T.
    clear EO EU O Real. now values.
Qed.

(** A quotient by a number of known distance from zero; if r is finite, y is not zero. *)
Theorem residual_divide_known a sa x b sb y : residual_known a sa x -> residual_known b sb y ->
  residual_known (a ⊘ b) (residual_divide _ F fused (a ⊘ b) a sa b sb) (x / y) /\
  (finite (snd (residual_divide _ F fused (a ⊘ b) a sa b sb)) -> y <> 0).
Proof.
  intros KA KB. destruct (zero_value p emax p_3) as [Z0 Z]. unfold residual_divide. cbv zeta.
  set (off := residual_error _ F sb). set (d := abs _ F b ⊖ off).
  destruct (less _ F (integer _ F 0) d) eqn:C; cbn [negb];
    [| split; [split; [reflexivity |] |]; discriminate].
  generalize (residual_error_known _ _ _ KB). fold off. intros KO.
  generalize (distance_positive p emax p_3 _ _ _ KO C). fold off d. intros (FB & FO & FD & D & NB & NY).
  split; auto.
  generalize FO. intros EO. unfold off in EO. destruct sb as [cb rb]. apply error_finite in EO. destruct EO as (CB & RB & EO).
  fold off in EO. assert (ED : B2R d = fl (Rabs (B2R b) - Residual.residual_error p emin (B2R cb) (B2R rb))).
  { rewrite <- EO. unfold d in FD |- *. apply minus_finite in FD. destruct FD as (FA & _ & ->).
    now apply (abs_finite p emax p_3) in FA as [_ ->]. }
  generalize (is_exact_value (cb, rb) CB RB). cbn [fst snd]. intros XB. clearbody d. set (v := a ⊘ b).
  assert (EV : finite v -> finite a /\ B2R v = fl (B2R a / B2R b)) by now apply over_finite.
  destruct (residual_is_zero _ F a sa) eqn:CZ.
  { destruct (known_zero _ _ _ KA CZ) as [-> A]. unfold Rdiv. rewrite Rmult_0_l. apply zero_known.
    now apply (zero_over p emax). }
  generalize (IeeeInterval.remainder_known p emax p_3 fused a b). fold v.
  destruct (remainder_of_division _ F fused a b v) as [value known]. cbn [fst snd]. intros KR.
  destruct KA as [PA KA], KB as [PB KB]. destruct (KB CB RB) as [_ HB]. cbn [fst snd] in *. clear KB.
  set (own := if known then value else integer _ F 0).
  set (unknown := if known then integer _ F 0 else half_ulp _ F v).
  assert (Pu : nonnegative unknown).
  { unfold unknown. destruct known; [positive | apply nonnegative_half_ulp]. }
  assert (O : finite v -> finite unknown -> finite own /\ B2R own = (if known then B2R value else 0) /\
    B2R unknown = if known then 0 else Residual.half_ulp p emin (B2R v)).
  { unfold own, unknown. intros V. destruct known; intros H.
    - now destruct (KR V FB NB eq_refl).
    - apply half_ulp_finite in H. tauto. }
  assert (Real : finite v -> finite (fst sa) -> finite (snd sa) ->
    match ResidualProduct.residual_divide p emin known (B2R value) (B2R v)
      (B2R a) (B2R (fst sa)) (B2R (snd sa)) (B2R b) (B2R cb) (B2R rb) with
    | None => True
    | Some (c, r) => y <> 0 /\ holds (B2R v) c r (x / y)
    end).
  { intros FV CA RA. destruct (EV FV) as (FA & E). rewrite E.
    apply (ResidualProduct.residual_divide_sound p emin p_3 emin_p); auto using number_B2R.
    - now apply KA.
    - intros H. rewrite <- E. now apply KR. }
  unfold ResidualProduct.residual_divide in Real. cbv zeta in Real.
  rewrite <- ED, Rlt_bool_true in Real by auto. cbn [negb] in Real. clear ED.
  destruct (equal _ F own (integer _ F 0) && residual_is_exact _ F sa && residual_is_exact _ F (cb, rb)) eqn:CE;
    split; cbn [fst snd].
  - positive.
  - intros _ FR. parts. generalize CE. intros E. apply andb_prop in E. destruct E as [E _].
    apply andb_prop in E. destruct E as [_ E]. apply is_exact_true in E. destruct E as (CA & RA & _).
    split; auto. destruct (O ltac:(auto) ltac:(auto)) as (FW & E1 & E2). destruct (EV ltac:(auto)) as (FA & _).
    specialize (Real ltac:(auto) CA RA).
    rewrite <- !is_zero_value, CZ, <- E1, <- E2, <- !is_exact_value in Real by auto.
    rewrite equal_finite, Z in CE by auto.
    rewrite <- XB, CE in Real. destruct Real as [_ Real]. clear E1 E2. now values.
  - assert (PO : nonnegative off) by apply KO. apply nonnegative_inflated. positive.
    apply nonnegative_over; auto; [| apply nonnegative_intro; auto; lra | lra].
    apply nonnegative_inflated. positive.
  - intros FC FR. apply inflated_finite in FR. destruct FR as [FR ER]. rewrite ER. clear ER. parts.
    match goal with H : finite (_ ⊘ d) |- _ => apply over_finite in H; [destruct H as [FL EL] | auto | lra] end.
    match goal with H : finite (half_ulp _ _ _) |- _ => apply half_ulp_finite in H; destruct H as [_ EH] end.
    apply over_finite in FC; auto. destruct FC as [FN EC].
    apply inflated_finite in FL. destruct FL as [FL EI]. parts.
    match goal with H : finite (roundings _ _ _ _ _ _) |- _ => apply roundings_finite in H; destruct H as (FX & FY & ?) end.
    parts. split; auto. destruct (O ltac:(auto) ltac:(auto)) as (FW & E1 & E2).
    destruct (EV ltac:(auto)) as (FA & _). specialize (Real ltac:(auto) ltac:(auto) ltac:(auto)).
    rewrite <- !is_zero_value, CZ, <- E1, <- E2, <- !is_exact_value in Real by auto.
    rewrite equal_finite, Z in CE by auto.
    rewrite <- XB, CE in Real. destruct Real as [_ Real].
    clear EV O E1 E2 KR. now values.
Qed.

End Rules.
