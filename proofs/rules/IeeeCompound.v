(** Functions of tracked numbers (include/errbound/functions.hpp), as in CompoundCode.v, over IEEE formats (Ieee.v),
    to nearest, including overflow, by every bound rule whose operations keep its bounds; p >= 3, emax > p.

    `keeps_operations` are the hypotheses on a rule, in addition to `promises` of IeeeFunctions.v. The dot products
    of tight and sharp are those of IeeeDotProduct.v. Results:
        tight_keeps_operations, sharp_keeps_operations, safe_keeps_operations, interval_keeps_operations,
        residual_keeps_operations   these rules are such rules
        midpoint_known, pow_known, dot_known, horner_known, lerp_known, copysign_known, and from p = 8 on hypot_known
                          by such a rule, the bound that the code returns holds for functions of known numbers *)

From Coq Require Import Reals ZArith Lia Lra Bool List.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code CompoundCode Ieee IeeeRules IeeeFunctions DotProduct Compound.
From Errbound Require Format Tight Functions IeeeSafe IeeeInterval IeeeResidual.
Import ListNotations.
Open Scope R_scope.

Section Compound.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_3 : (3 <= p)%Z).
Variable fused : bool.  (* has_fast_fma *)
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation known := (known p emax).
Notation promises := (promises p emax).

Ltac parts := finite_parts p emax p_3.
Ltac values := known_values p emax p_3.

Record keeps_operations (B : Type) (by_rule : operations float B) (holds : float -> B -> R -> Prop) : Prop := {
  keeps_promises : promises B (the_rule _ _ by_rule) holds;
  known_sum a sa x b sb y : holds a sa x -> holds b sb y ->
    holds (a ⊕ b) (rule_add _ _ by_rule (a ⊕ b) a sa b sb) (x + y);
  known_product a sa x b sb y : holds a sa x -> holds b sb y ->
    holds (a ⊗ b) (rule_multiply _ _ by_rule (a ⊗ b) a sa b sb) (x * y);
  (** A quotient by zero may be anything. *)
  known_quotient divide a sa x b sb y : rule_divide _ _ by_rule = Some divide -> holds a sa x -> holds b sb y ->
    forall t, y = 0 \/ t = x / y -> holds (a ⊘ b) (divide (a ⊘ b) a sa b sb) t;
  known_scaled a sa x e : holds a sa x ->
    holds (scale _ F a e) (rule_scale _ _ by_rule (scale _ F a e) a sa e) (x * bpow radix2 e);
  (** Zeros of both signs are equal. *)
  known_alike a c b x : finite a -> finite c -> B2R a = B2R c -> holds a b x -> holds c b x
}.

Lemma known_same a c s x : finite a -> finite c -> B2R a = B2R c -> known a s x -> known c s x.
Proof. intros _ C E [P K]. split; auto. intros H. rewrite <- E. split; auto. now apply K. Qed.

Lemma known_of_quotient v s x y : known v s (x / y) /\ (finite s -> y <> 0) -> forall t, y = 0 \/ t = x / y -> known v s t.
Proof.
  intros [K N] t [Y | ->]; [| exact K]. split; [apply K |]. intros H. now apply N in H.
Qed.

Ltac known_operations promised add multiply divide scale :=
  split; cbn [tight_operations sharp_operations the_rule rule_add rule_multiply rule_divide rule_scale];
  [ now apply promised | intros; now apply add | intros; now apply multiply
  | intros divided a sa x b sb y E; injection E as <-; intros; apply known_of_quotient with x y; auto; now apply divide
  | intros; now apply scale | apply known_same ].
Theorem tight_keeps_operations : keeps_operations _ (tight_operations _ F) known.
Proof. known_operations tight_promises tight_add_known tight_multiply_known tight_divide_known tight_scale_known. Qed.
Theorem sharp_keeps_operations : keeps_operations _ (sharp_operations _ F) known.
Proof. known_operations sharp_promises sharp_add_known sharp_multiply_known sharp_divide_known sharp_scale_known. Qed.
Theorem safe_keeps_operations : keeps_operations _ (safe_operations _ F) (IeeeSafe.safe_known p emax).
Proof.
  split; cbn [safe_operations the_rule rule_add rule_multiply rule_divide rule_scale].
  - now apply safe_promises.
  - intros. now apply IeeeSafe.safe_add_known.
  - intros. now apply IeeeSafe.safe_multiply_known.
  - discriminate.
  - intros. now apply IeeeSafe.safe_scale_known.
  - intros a c [B k] x A _ E (P & K & H). split; [exact P |]. split; [exact K |]. intros _ L. rewrite <- E. now apply H.
Qed.
Theorem interval_keeps_operations :
  keeps_operations _ (interval_operations _ F fused) (IeeeInterval.interval_known p emax).
Proof.
  split; cbn [interval_operations the_rule rule_add rule_multiply rule_divide rule_scale].
  - now apply interval_promises.
  - intros. now apply IeeeInterval.interval_add_known.
  - intros. now apply IeeeInterval.interval_multiply_known.
  - intros divide a sa x b sb y E. injection E as <-. intros KA KB t [-> | ->]; [| now apply IeeeInterval.interval_divide_known].
    left. unfold interval_divide. destruct (zero_value p emax p_3) as [Z0 Z].
    destruct KB as [-> | (H1 & H2 & _ & _ & H3)]; [now destruct (integer _ F 0) as [| | |] |].
    now rewrite !(less_finite p emax), Z, !Rlt_bool_false by (auto; lra).
  - intros. now apply IeeeInterval.interval_scale_known.
  - intros a c b x A C E [H | (H1 & H2 & _ & H3)]; [now left | right]. rewrite <- E. tauto.
Qed.
Theorem residual_keeps_operations :
  keeps_operations _ (residual_operations _ F fused) (IeeeResidual.residual_known p emax).
Proof.
  split; cbn [residual_operations the_rule rule_add rule_multiply rule_divide rule_scale].
  - now apply residual_promises.
  - intros. now apply IeeeResidual.residual_add_known.
  - intros. now apply IeeeResidual.residual_multiply_known.
  - intros divide a sa x b sb y E. injection E as <-. intros KA KB t Q.
    destruct (IeeeResidual.residual_divide_known p emax p_3 fused a sa x b sb y KA KB) as [[P K] N].
    destruct Q as [Y | ->]; split; auto. intros _ H. now apply N in H.
  - intros. now apply IeeeResidual.residual_scale_known.
  - intros a c b x A C E [P H]. split; auto. intros H1 H2. rewrite <- E. split; [exact C | now apply H].
Qed.

(** Theorems for any such rule. *)
Context (B : Type) (by_rule : operations float B) (holds : float -> B -> R -> Prop)
  (Keeps : keeps_operations B by_rule holds).
Notation rule := (the_rule float B by_rule).
Notation Rule := (keeps_promises _ _ _ Keeps).
Notation tracked_known := (tracked_known p emax B holds).
Notation error_of := (tracked_error float F B rule).

Lemma integer_known n : (n = 0 \/ n = 1)%Z -> holds (integer _ F n) (rule_exact _ _ rule (integer _ F n)) (IZR n).
Proof.
  intros N. rewrite <- (proj2 (integer_value p emax p_3 n ltac:(lia))). apply (promise_exact _ _ _ _ _ Rule).
Qed.
Lemma zero_plus a : finite (integer _ F 0 ⊕ a) \/ integer _ F 0 ⊕ a = a.
Proof.
  destruct (zero_value p emax p_3) as [Z0 Z]. destruct (BinarySingleNaN.is_finite a) eqn:FA.
  - left. generalize (Bplus_correct p emax _ _ mode_NE (integer _ F 0) a Z0 FA). rewrite Z, Rplus_0_l.
    rewrite Rlt_bool_true; [now intros (_ & H & _) |].
    change (Rabs (fl (B2R a)) < bpow radix2 emax).
    rewrite (Format.rnd_exact p emin Format.nearest) by apply number_B2R. apply abs_B2R_lt_emax.
  - right. clear Z. destruct (integer _ F 0) as [| | |]; try discriminate; now destruct a.
Qed.
Lemma compound_keeps : keeps float F B by_rule B2R holds.
Proof.
  destruct (zero_value p emax p_3) as [Z0 Z]. split.
  - apply integer_known. now left.
  - apply integer_known. now right.
  - intros a b x _. apply (promise_exact _ _ _ _ _ Rule).
  - apply (known_sum _ _ _ Keeps).
  - apply (promise_subtract _ _ _ _ _ Rule).
  - apply (known_product _ _ _ Keeps).
  - apply (known_scaled _ _ _ Keeps).
  - intros a b x H. destruct (zero_plus a) as [FS | ->]; auto.
    assert (G := plus_finite p emax _ _ FS). destruct G as (_ & FA & E).
    apply (known_alike _ _ _ Keeps) with a; auto. rewrite E, Z, Rplus_0_l. symmetry.
    apply (Format.rnd_exact p emin Format.nearest), number_B2R.
  - intros a sa x b c d r e H v KV L.
    assert (KE := error_of_known p emax B rule holds Rule (v, d) r KV). cbn [fst] in KE. destruct KE as [PE KE].
    assert (FE : finite (error_of (v, d))).
    { destruct (error_of (v, d)) as [| s | |]; try discriminate; auto. simpl in PE. subst s.
      now destruct e as [| [|] | | [|]]. }
    destruct (KE FE) as [FV _]. assert (G := plus_finite p emax _ _ FV). destruct G as (FA & FP & EV).
    assert (G := times_finite p emax _ _ FP). destruct G as (FB & FD & EP).
    assert (G := minus_finite p emax _ _ FD). destruct G as (FC & _ & ED).
    apply (known_alike _ _ _ Keeps) with v; auto. unfold v at 1.
    rewrite EV, EP, ED, Rminus_eq_0, (Format.rnd_0 p emin Format.nearest), Rmult_0_r,
      (Format.rnd_0 p emin Format.nearest), Rplus_0_r.
    apply (Format.rnd_exact p emin Format.nearest), number_B2R.
Qed.

Theorem midpoint_known x r y s : tracked_known x r -> tracked_known y s ->
  tracked_known (tracked_midpoint _ F _ by_rule x y) ((r + s) / 2).
Proof. apply (midpoint_kept _ _ _ _ _ _ compound_keeps). Qed.

(** x^n, and 1/x^-n for n < 0; if the error is finite, x is then not zero. *)
Theorem pow_known x r n : tracked_known x r ->
  tracked_known (tracked_pow _ F _ by_rule x n) (powerRZ r n) /\
  ((n < 0)%Z -> finite (error_of (tracked_pow _ F _ by_rule x n)) -> r <> 0).
Proof.
  intros X. destruct n as [| bits | bits].
  - split; [apply (power_kept _ _ _ _ _ _ compound_keeps x r 0 ltac:(lia) X) | lia].
  - split; [apply (power_kept _ _ _ _ _ _ compound_keeps x r (Zpos bits) ltac:(lia) X) | lia].
  - enough (G : forall t, r = 0 \/ t = / r ^ Pos.to_nat bits -> tracked_known (tracked_pow _ F _ by_rule x (Zneg bits)) t).
    { split; [apply G; now right |]. intros _ H ->. revert H. apply (any_number_error p emax B rule holds Rule). auto. }
    intros t Q. assert (P := power_kept _ _ _ _ _ _ compound_keeps x r (Zpos bits) ltac:(lia) X).
    cbn [tracked_pow Z.to_nat powerRZ] in *.
    destruct (rule_divide float B by_rule) as [divide |] eqn:D.
    + apply (known_quotient _ _ _ Keeps divide) with 1 (r ^ Pos.to_nat bits); auto.
      * apply integer_known. now right.
      * destruct Q as [-> | ->]; [left; apply pow_i; lia | right; unfold Rdiv; ring].
    + apply (nothing_known p emax B rule holds Rule). discriminate.
Qed.

(** dot_of for rules without a dot_bound. *)
Theorem dot_known pairs exacts :
  Forall2 (fun pair exact => tracked_known (fst pair) (fst exact) /\ tracked_known (snd pair) (snd exact)) pairs exacts ->
  tracked_known (tracked_dot _ F _ by_rule pairs) (exact_dot exacts).
Proof. apply (dot_kept _ _ _ _ _ _ compound_keeps). Qed.

Theorem horner_known c exact x r : Forall2 tracked_known c exact -> tracked_known x r ->
  tracked_known (tracked_horner _ F _ by_rule c x) (exact_horner exact r).
Proof. apply (horner_kept _ _ _ _ _ _ compound_keeps). Qed.

(** Functions without a rule. *)
Theorem lerp_known x r y s z t : tracked_known x r -> tracked_known y s -> tracked_known z t ->
  tracked_known (tracked_lerp _ F _ by_rule x y z) ((1 - t) * r + t * s).
Proof.
  intros KX KY KZ. unfold tracked_lerp. cbv zeta.
  generalize (error_of_known p emax B rule holds Rule _ _ KX) (error_of_known p emax B rule holds Rule _ _ KY)
    (error_of_known p emax B rule holds Rule _ _ KZ).
  set (e := error_of x). set (g := error_of y). set (k := error_of z). intros LX LY LZ.
  destruct (zero_value p emax p_3) as [Z0 ZV]. destruct (integer_value p emax p_3 1 ltac:(lia)) as [O0 OV].
  assert (At : forall c, finite c -> equal _ F k (integer _ F 0) && equal _ F (fst z) c = true -> t = B2R c).
  { intros c FC C. apply andb_prop in C. destruct C as [C1 C2]. apply (equal_true p emax) in C1, C2; auto.
    destruct C1 as [FK EK], C2 as [_ EC]. destruct (proj2 LZ FK) as [_ D]. rewrite EK, ZV in D.
    apply Format.within_0 in D. congruence. }
  destruct (_ && _) eqn:C0.
  { rewrite (At _ Z0 C0), ZV. replace ((1 - 0) * r + 0 * s) with r by ring. exact KX. }
  clear C0. destruct (_ && _) eqn:C1.
  { rewrite (At _ O0 C1), OV. replace ((1 - 1) * r + 1 * s) with s by ring. exact KY. }
  clear C1 At. apply (promise_within _ _ _ _ _ Rule). intros H _.
  set (d := fst y ⊖ fst x) in *. set (v := Code.fma _ F (fst z) d (fst x)) in *.
  apply (IeeeFunctions.enlarged_finite p emax p_3) in H. destruct H as [H ->].
  apply plus_finite in H. destruct H as (FR & H & ->). apply (IeeeFunctions.rounding_of_finite p emax p_3) in FR. destruct FR as [FV ->].
  apply plus_finite in H. destruct H as (FE & H & ->). apply (IeeeFunctions.enlarged_finite p emax p_3) in FE. destruct FE as [FE ->].
  apply plus_finite in H. destruct H as (FT & H8 & ->). apply (IeeeFunctions.enlarged_finite p emax p_3) in FT. destruct FT as [FT ->].
  apply fma_finite in FV. destruct FV as (FZ & FD & FX & EV). fold v in EV.
  apply plus_finite in FT. destruct FT as (FT1 & FT2 & ->). apply times_finite in FT1, FT2.
  destruct FT1 as (FT1 & FK & ->), FT2 as (FT2 & FRD & ->).
  apply (IeeeFunctions.rounding_of_finite p emax p_3) in FRD. destruct FRD as [_ ERD].
  assert (G := minus_finite p emax _ _ FD). destruct G as (FY & _ & ED). fold d in ED.
  apply plus_finite in FT1. destruct FT1 as (FT1 & _ & ->).
  parts. values.
  destruct (proj2 LX ltac:(assumption)) as [_ DX], (proj2 LY ltac:(assumption)) as [_ DY],
    (proj2 LZ ltac:(assumption)) as [_ DZ].
  assert (T := Functions.lerp_sound_nearest p emin p_3 (B2R (fst x)) r (B2R e) (B2R (fst y)) s (B2R g)
                 (B2R (fst z)) t (B2R k) ltac:(generalize (p_emax p emax); lia)).
  unfold Functions.lerp_error in T. cbv zeta in T. apply T; auto using number_B2R.
Qed.

Lemma abs_value x : finite (fst (tracked_abs _ F _ rule x)) ->
  finite (fst x) /\ B2R (fst (tracked_abs _ F _ rule x)) = Rabs (B2R (fst x)).
Proof.
  assert (E : fst (if less _ F (fst x) (integer _ F 0) then tracked_negate _ F _ rule x else x) = Code.abs _ F (fst x)).
  { unfold Code.abs. now destruct (less _ F (fst x) (integer _ F 0)). }
  replace (fst (tracked_abs _ F _ rule x)) with (Code.abs _ F (fst x)); [apply (abs_finite p emax p_3) |].
  unfold tracked_abs. cbv zeta. destruct (tracked_sign _ _ rule x); try (now rewrite E); auto;
    destruct (less _ F (fst x) (integer _ F 0)) eqn:L; auto.
Qed.
(** A zero counts as positive. *)
Theorem copysign_known x r y s : tracked_known x r -> tracked_known y s ->
  tracked_known (tracked_copysign _ F _ by_rule x y) (if Rlt_bool s 0 then - Rabs r else Rabs r).
Proof.
  intros KX KY. unfold tracked_copysign. cbv zeta.
  assert (KS := abs_known p emax p_3 B rule holds Rule x r KX).
  assert (AV := abs_value x). set (size := tracked_abs _ F _ rule x) in *.
  assert (S := promise_sign _ _ _ _ _ Rule _ _ _ KY). change (rule_sign _ _ rule (fst y) (snd y)) with (tracked_sign _ _ rule y) in S.
  destruct (tracked_sign _ _ rule y); cbn [right_sign] in S.
  - rewrite Rlt_bool_true by exact S. now apply (negate_known p emax B rule holds Rule).
  - rewrite Rlt_bool_false by lra. exact KS.
  - rewrite Rlt_bool_false by lra. exact KS.
  - destruct (_ || _); apply (promise_within _ _ _ _ _ Rule); intros H _; [discriminate H |].
    apply (IeeeFunctions.enlarged_finite p emax p_3) in H. destruct H as [H ->].
    apply plus_finite in H. destruct H as (H1 & H2 & ->). apply times_finite in H1. destruct H1 as (_ & FS & ->).
    destruct (AV FS) as [_ ES]. assert (KE := error_of_known p emax B rule holds Rule _ _ KS).
    destruct (proj2 KE H2) as [_ D]. rewrite (proj2 (integer_value p emax p_3 2 ltac:(lia))).
    apply (Functions.copysign_sound_nearest p emin p_3 (B2R (fst size)) _ r); auto using number_B2R.
    + apply (emin_p p emax p_3).
    + rewrite ES. apply Rabs_pos.
    + destruct (less _ F (fst y) (integer _ F 0)); rewrite ?opposite_value, ?Rabs_Ropp, ES, Rabs_Rabsolu; reflexivity.
    + destruct (Rlt_bool s 0); rewrite ?Rabs_Ropp; apply Rabs_Rabsolu.
Qed.

(** For any exponent of number_traits. *)
Theorem hypot_known exponent x r y s : (8 <= p)%Z ->
  (forall a, finite a -> B2R a <> 0 -> bpow radix2 (exponent a - 1) <= Rabs (B2R a) < bpow radix2 (exponent a)) ->
  tracked_known x r -> tracked_known y s ->
  tracked_known (tracked_hypot _ F _ by_rule exponent x y) (sqrt (r * r + s * s)).
Proof.
  intros P8 Exponent KX KY. unfold tracked_hypot. cbv zeta.
  generalize (error_of_known p emax B rule holds Rule _ _ KX) (error_of_known p emax B rule holds Rule _ _ KY).
  set (e := error_of x). set (g := error_of y). intros LX LY.
  destruct (zero_value p emax p_3) as [Z0 ZV].
  destruct (Code.is_finite _ F (e ⊕ g)) eqn:C; cbn [negb].
  2: { apply (nothing_known p emax B rule holds Rule). discriminate. }
  assert (FI : finite (e ⊕ g)).
  { revert C. unfold Code.is_finite, Code.abs. generalize (e ⊕ g). intros i. destruct i as [| [|] | |]; simpl; auto; discriminate. }
  assert (G := plus_finite p emax _ _ FI). destruct G as (FE & FG & EI).
  destruct (proj2 LX FE) as [FX DX], (proj2 LY FG) as [FY DY].
  set (larger := Code.max _ F (Code.abs _ F (fst x)) (Code.abs _ F (fst y))).
  assert (FAX := abs_finite_intro p emax _ FX). assert (FAY := abs_finite_intro p emax _ FY).
  destruct (abs_finite p emax p_3 _ FAX) as [_ EAX]. destruct (abs_finite p emax p_3 _ FAY) as [_ EAY].
  assert (LV : finite larger /\ B2R larger = Rmax (Rabs (B2R (fst x))) (Rabs (B2R (fst y)))).
  { unfold larger, Code.max. rewrite (less_finite p emax) by auto. rewrite EAX, EAY.
    case Rlt_bool_spec; intros; split; auto; [rewrite Rmax_right | rewrite Rmax_left]; auto; lra. }
  destruct LV as [FL EL].
  rewrite (equal_finite p emax) by auto. rewrite ZV, EL.
  case Req_bool_spec; intros M.
  - assert (X0 : B2R (fst x) = 0 /\ B2R (fst y) = 0).
    { generalize (Rmax_l (Rabs (B2R (fst x))) (Rabs (B2R (fst y)))) (Rmax_r (Rabs (B2R (fst x))) (Rabs (B2R (fst y))))
        (Rabs_pos (B2R (fst x))) (Rabs_pos (B2R (fst y))). intros.
      split; apply Rabs_eq_R0; lra. }
    destruct X0 as [X0 Y0]. apply (promise_within _ _ _ _ _ Rule). intros H _.
    apply (IeeeFunctions.enlarged_finite p emax p_3) in H. destruct H as [_ ->]. rewrite EI, ZV.
    assert (Pe : 0 <= B2R e) by (generalize (Rabs_pos (B2R (fst x) - r)); lra).
    assert (Pg : 0 <= B2R g) by (generalize (Rabs_pos (B2R (fst y) - s)); lra).
    apply Rle_trans with (B2R e + B2R g + 0).
    + rewrite Rplus_0_r, <- sqrt_0 at 1. replace 0 with (B2R (fst x) * B2R (fst x) + B2R (fst y) * B2R (fst y)) at 1
        by (rewrite X0, Y0; ring). now apply Functions.length_inherits.
    + rewrite <- (Format.rnd_exact p emin Format.nearest (fl (B2R e + B2R g))) by now apply Format.rnd_number, valid_rnd_N.
      rewrite <- (Rplus_0_r (fl (B2R e + B2R g))).
      apply (Tight.inflated_sum_left p emin Format.nearest p_3 (emin_p p emax p_3) _ _
        (Format.rounding_error_nearest p emin ltac:(lia)) (Tight.nearest_q6 p p_3)
        (Tight.nearest_h p emin p_3)); auto using number_B2R; try lra.
      apply Format.number_0.
  - assert (EX := Exponent larger FL ltac:(rewrite EL; exact M)). rewrite EL in EX.
    rewrite (Rabs_pos_eq (Rmax _ _)) in EX by (apply Rle_trans with (2 := Rmax_l _ _); apply Rabs_pos).
    set (n := exponent larger) in *.
    apply (promise_within _ _ _ _ _ Rule). intros H _.
    apply (IeeeFunctions.enlarged_finite p emax p_3) in H. destruct H as [H ->].
    apply plus_finite in H. destruct H as (H1 & H2 & ->). apply times_finite in H1. destruct H1 as (FV & HR & ->).
    apply scale_finite in FV. destruct FV as (FR & EV). apply root_finite in FR. destruct FR as (FS & _ & ER).
    rewrite ER in EV. apply plus_finite in FS. destruct FS as (FA & FB & ES). rewrite ES in EV.
    apply times_finite in FA, FB. destruct FA as (FA & _ & EA), FB as (FB & _ & EB). rewrite EA, EB in EV.
    apply scale_finite in FA, FB. destruct FA as (_ & EA'), FB as (_ & EB'). rewrite EA', EB' in EV.
    clear ER ES EA EB EA' EB'.
    apply plus_finite in H2. destruct H2 as (_ & H3 & ->). rewrite EI. parts. values.
    assert (T := Functions.hypot_sound_nearest p emin p_3 (B2R (fst x)) r (B2R (fst y)) s (B2R e) (B2R g) n P8
                   ltac:(generalize (p_emax p emax); lia)).
    unfold Functions.hypot_value, Functions.hypot_error in T. cbv zeta in T.
    apply T; auto using number_B2R.
Qed.

End Compound.
