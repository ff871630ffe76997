(** Functions of tracked numbers (include/errbound/functions.hpp) over IEEE formats (Ieee.v), to nearest, including
    overflow, by every bound rule that keeps its promises; p >= 3, emax > p.

    `promises` are the hypotheses on a rule. A predicate defines when a value and a bound hold for a number x, and
    the rule's operations preserve it. Its error is one in the sense of IeeeRules.v. Results:
        tight_promises, sharp_promises, safe_promises, interval_promises, residual_promises
        sqrt_known, abs_known, min_known, max_known, fma_known   the bound that the code returns holds for functions
            of
            known numbers; if the error of a square root is finite, its argument is not negative *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code Ieee IeeeRules.
From Errbound Require Format Tight Functions IeeeSafe IeeeInterval IeeeResidual.
Open Scope R_scope.

Section Functions.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_3 : (3 <= p)%Z).
Variable fused : bool.  (* has_fast_fma *)
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation nonnegative := (nonnegative p emax).
Notation emin_p := (emin_p p emax p_3).
Notation known := (known p emax).

Ltac parts := finite_parts p emax p_3.
Ltac values := known_values p emax p_3.

Definition right_sign (s : sign_type) (x : R) : Prop :=
  match s with
  | negative => x < 0
  | zero => x = 0
  | positive => 0 < x
  | uncertain => True
  end.

(** A rule's operations preserve `holds`: a value and a bound hold for x. *)
Record promises (B : Type) (rule : rule float B) (holds : float -> B -> R -> Prop) : Prop := {
  promise_exact a : holds a (rule_exact _ _ rule a) (B2R a);
  promise_within a error x :
    (finite error -> 0 <= B2R error -> Rabs (B2R a - x) <= B2R error) ->
    holds a (rule_within _ _ rule a error) x;
  promise_error a b x : holds a b x -> known a (rule_error _ _ rule a b) x;
  promise_subtract a sa x b sb y : holds a sa x -> holds b sb y ->
    holds (a ⊖ b) (rule_subtract _ _ rule (a ⊖ b) a sa b sb) (x - y);
  promise_negate a b x : holds a b x -> holds (opposite _ F a) (rule_negate _ _ rule b) (- x);
  promise_sign a b x : holds a b x -> right_sign (rule_sign _ _ rule a b) x
}.

Ltac known_promises subtract :=
  split; cbn [tight_rule sharp_rule rule_exact rule_within rule_error rule_subtract rule_negate rule_sign]; auto;
  [ now apply tight_exact_known | now apply tight_within_known | intros; now apply subtract | apply tight_negate_known
  | now apply sign_of_known ].
Theorem tight_promises : promises _ (tight_rule _ F) known.
Proof. known_promises tight_subtract_known. Qed.
Theorem sharp_promises : promises _ (sharp_rule _ F) known.
Proof. known_promises sharp_subtract_known. Qed.
Theorem safe_promises : promises _ (safe_rule _ F) (IeeeSafe.safe_known p emax).
Proof.
  split; cbn [safe_rule rule_exact rule_within rule_error rule_subtract rule_negate rule_sign].
  - now apply IeeeSafe.safe_exact_known.
  - now apply IeeeSafe.safe_within_known.
  - now apply IeeeSafe.safe_error_known.
  - intros. now apply IeeeSafe.safe_subtract_known.
  - apply IeeeSafe.safe_negate_known.
  - intros a b x H. apply (sign_of_known p emax p_3). now apply IeeeSafe.safe_error_known.
Qed.
Theorem interval_promises : promises _ (interval_rule _ F) (IeeeInterval.interval_known p emax).
Proof.
  split; cbn [interval_rule rule_exact rule_within rule_error rule_subtract rule_negate rule_sign].
  - apply IeeeInterval.interval_exact_known.
  - now apply IeeeInterval.interval_within_known.
  - intros a b x H. split; [now apply IeeeInterval.interval_error_nonnegative with x |].
    now apply IeeeInterval.interval_error_known.
  - intros. now apply IeeeInterval.interval_subtract_known.
  - apply IeeeInterval.interval_negate_known.
  - now apply IeeeInterval.interval_sign_known.
Qed.
Theorem residual_promises : promises _ (residual_rule _ F) (IeeeResidual.residual_known p emax).
Proof.
  split; cbn [residual_rule rule_exact rule_within rule_error rule_subtract rule_negate rule_sign].
  - now apply IeeeResidual.residual_exact_known.
  - now apply IeeeResidual.residual_within_known.
  - now apply IeeeResidual.residual_error_known.
  - intros. now apply IeeeResidual.residual_subtract_known.
  - apply IeeeResidual.residual_negate_known.
  - now apply IeeeResidual.residual_sign_known.
Qed.

(** If the code's terms are finite, they are those over real numbers. *)
Lemma enlarged_finite b : finite (enlarged _ F b) ->
  finite b /\ B2R (enlarged _ F b) = Tight.inflated p emin Format.nearest (B2R b).
Proof. apply (tight_inflated_finite p emax p_3). Qed.
Lemma rounding_of_finite v : finite (rounding_of _ F v) ->
  finite v /\ B2R (rounding_of _ F v) = Functions.rounding_of p emin Format.nearest (B2R v).
Proof.
  change (rounding_of _ F v) with (tight_rounding _ F v ⊕ underflow_unit _ F). intros H.
  apply plus_finite in H. destruct H as (H & _ & E).
  apply (tight_rounding_finite p emax p_3) in H. destruct H as [V ER]. split; auto.
  rewrite E, ER. now values.
Qed.

(** Roots are so small that their sums do not overflow. *)
Lemma root_sum_finite x y : finite (root _ F x) -> finite (root _ F y) ->
  finite (root _ F x ⊕ root _ F y).
Proof.
  intros X Y. generalize (p_emax p emax). intros L. set (k := ((emax + 1) / 2)%Z).
  assert (HK : (emax <= 2 * k)%Z /\ (k + 1 < emax)%Z).
  { unfold k. generalize (Z.div_mod (emax + 1) 2) (Z.mod_pos_bound (emax + 1) 2). lia. }
  assert (B : forall z, finite (root _ F z) -> 0 <= B2R (root _ F z) <= bpow radix2 k).
  { intros z H. apply root_finite in H. destruct H as (FZ & PZ & ->). split.
    - apply (Format.rnd_nonnegative p emin Format.nearest), sqrt_pos.
    - apply (Format.rnd_below p emin Format.nearest); [apply Format.number_power; auto; lia |].
      rewrite <- (sqrt_Rsqr (bpow radix2 k)) by apply bpow_ge_0. apply sqrt_le_1_alt.
      unfold Rsqr. rewrite <- bpow_plus. apply Rle_trans with (bpow radix2 emax); [| apply bpow_le; lia].
      apply Rlt_le, Rle_lt_trans with (1 := Rle_abs _). apply abs_B2R_lt_emax. }
  generalize (B x X) (B y Y). intros BX BY.
  generalize (Bplus_correct p emax _ _ mode_NE _ _ X Y). rewrite Rlt_bool_true; [now intros (_ & ? & _) |].
  apply Rle_lt_trans with (bpow radix2 (k + 1)); [| apply bpow_lt; lia].
  apply (Format.rnd_abs_below p emin Format.nearest); [apply Format.number_power; auto; lia |].
  rewrite bpow_plus, Rabs_pos_eq by lra. change (bpow radix2 1) with 2. lra.
Qed.

(** Theorems for any such rule. *)
Context (B : Type) (rule : rule float B) (holds : float -> B -> R -> Prop) (Rule : promises B rule holds).

Definition tracked_known (x : float * B) (r : R) : Prop := holds (fst x) (snd x) r.
Notation error_of := (tracked_error float F B rule).

Lemma error_of_known x r : tracked_known x r -> known (fst x) (error_of x) r.
Proof.
  intros K. unfold tracked_error. cbv zeta. destruct equal; [now apply (promise_error _ _ _ Rule) |].
  split; [reflexivity | discriminate].
Qed.
Lemma negate_known x r : tracked_known x r -> tracked_known (tracked_negate _ F _ rule x) (- r).
Proof. apply (promise_negate _ _ _ Rule). Qed.

(** With an infinite or NaN error, a number may be anything, so its error is not finite. *)
Lemma nothing_known v e : ~ finite e -> forall r, tracked_known (tracked_within _ _ rule v e) r.
Proof. intros N r. apply (promise_within _ _ _ Rule). intros H. contradiction. Qed.
(** A number that may be anything has no finite error. *)
Lemma any_number_error x : (forall r, tracked_known x r) -> ~ finite (error_of x).
Proof.
  intros K H. set (s := B2R (error_of x)).
  destruct (proj2 (error_of_known _ _ (K (B2R (fst x) + (Rabs s + 1)))) H) as [_ D]. fold s in D.
  generalize (Rle_abs s) (Rabs_pos s) (Rle_abs (- (B2R (fst x) - (B2R (fst x) + (Rabs s + 1))))).
  rewrite Rabs_Ropp. lra.
Qed.
Lemma nothing_error v e : ~ finite e -> ~ finite (error_of (tracked_within _ _ rule v e)).
Proof. intros N. apply any_number_error. intros r. now apply nothing_known. Qed.

Theorem sqrt_known x r : tracked_known x r ->
  tracked_known (tracked_sqrt _ F fused _ rule x) (sqrt r) /\
  (finite (error_of (tracked_sqrt _ F fused _ rule x)) -> 0 <= r).
Proof.
  intros K. generalize (error_of_known x r K). intros [PE KE]. unfold tracked_sqrt. cbv zeta.
  set (e := error_of x) in *. set (a := fst x) in *. set (v := root _ F a).
  assert (Nothing : forall s, ~ finite s ->
    tracked_known (tracked_within _ _ rule v s) (sqrt r) /\
    (finite (error_of (tracked_within _ _ rule v s)) -> 0 <= r)).
  { intros s N. split; [now apply nothing_known |]. intros H. now apply nothing_error in H. }
  destruct (at_most _ F e a) eqn:C; cbn [negb]; [| now apply Nothing].
  destruct (zero_value p emax p_3) as [Z0 Z].
  destruct (BinarySingleNaN.is_finite e) eqn:FE.
  2: { (* the value is infinite *)
    assert (A : finite a -> False).
    { intros FA. revert C. unfold nonnegative in PE. destruct e as [| s | |]; try discriminate. subst s.
      now destruct a as [| s | | s]; try discriminate. }
    assert (C0 : equal _ F e (integer _ F 0) = false).
    { destruct (equal _ F e (integer _ F 0)) eqn:D; auto. apply (equal_true p emax) in D; auto.
      destruct D as [D _]. congruence. }
    rewrite C0. apply Nothing. intros H. apply enlarged_finite in H. destruct H as [H _].
    apply plus_finite in H. destruct H as (_ & H & _). apply plus_finite in H. destruct H as (H & _ & _).
    apply rounding_of_finite in H. destruct H as [H _]. apply root_finite in H. tauto. }
  destruct (KE eq_refl) as [FA HX]. apply nonnegative_value in PE.
  assert (L : 0 <= B2R e <= B2R a).
  { split; auto. revert C. rewrite at_most_finite by auto. now case Rle_bool_spec. }
  assert (FV : finite v) by (apply root_of_nonnegative; auto; lra).
  assert (EV : B2R v = fl (sqrt (B2R a))) by (apply root_finite in FV; tauto).
  destruct (Functions.sqrt_sound_nearest p emin p_3 (B2R a) r (B2R e)) as [PR T];
    auto using number_B2R; [generalize (p_emax p emax); lia |].
  rewrite <- EV in T. unfold Functions.sqrt_error in T. rewrite <- EV in T. cbv zeta in T.
  split; auto. rewrite equal_finite, Z by auto.
  destruct (Req_bool_spec (B2R e) 0) as [E0 | E0].
  - assert (W : tracked_known (tracked_within _ _ rule v (enlarged _ F (rounding_of _ F v))) (sqrt r)).
    { apply (promise_within _ _ _ Rule). intros H _. apply enlarged_finite in H. destruct H as [H ->].
      apply rounding_of_finite in H. destruct H as [_ ->]. exact T. }
    destruct (_ && _) eqn:D; [| exact W]. clear W T.
    apply andb_prop in D. destruct D as [D D3]. apply andb_prop in D. destruct D as [D1 D2].
    apply (IeeeInterval.product_known p emax p_3 fused) in D1. destruct D1 as (_ & _ & _ & _ & D1 & _).
    apply (equal_true p emax) in D2, D3; auto. rewrite Z in D2. destruct D2 as [_ D2], D3 as [_ D3].
    rewrite IeeeInterval.product_value in D3. rewrite D2, D3, Rplus_0_r in D1.
    rewrite E0 in HX. apply Format.within_0 in HX. rewrite <- HX.
    replace (sqrt (B2R a)) with (B2R v).
    + apply (promise_exact _ _ _ Rule).
    + rewrite D1. change (B2R v * B2R v) with (Rsqr (B2R v)). symmetry. apply sqrt_Rsqr. rewrite EV.
      apply (Format.rnd_nonnegative p emin Format.nearest), sqrt_pos.
  - apply (promise_within _ _ _ Rule). intros H _. apply enlarged_finite in H. destruct H as [H ->].
    assert (FW : finite (root _ F (a ⊖ e))).
    { assert (FD : finite (a ⊖ e)).
      { apply minus_nonnegative_finite; auto; apply nonnegative_intro; auto; lra. }
      apply root_of_nonnegative; auto. apply minus_finite in FD. destruct FD as (_ & _ & ->).
      apply (Format.rnd_nonnegative p emin Format.nearest). lra. }
    assert (FD : finite (v ⊕ root _ F (a ⊖ e))) by now apply root_sum_finite.
    assert (ED : B2R (v ⊕ root _ F (a ⊖ e)) = fl (B2R v + fl (sqrt (fl (B2R a - B2R e))))).
    { apply plus_finite in FD. destruct FD as (_ & _ & ->). apply root_finite in FW.
      destruct FW as (FM & _ & ->). apply minus_finite in FM. now destruct FM as (_ & _ & ->). }
    set (d := v ⊕ root _ F (a ⊖ e)) in *. clearbody d.
    apply plus_finite in H. destruct H as (H1 & H2 & ->). apply plus_finite in H2.
    destruct H2 as (H2 & _ & ->). apply rounding_of_finite in H2. destruct H2 as [_ ->].
    assert (PD : B2R d <> 0).
    { rewrite ED, EV. apply Rgt_not_eq.
      apply (Functions.divisor_positive p emin p_3 (B2R a) (B2R e)); auto using number_B2R; [| lra].
      generalize (p_emax p emax). lia. }
    apply over_finite in H1; auto. destruct H1 as [_ ->]. rewrite <- ED in T. clear ED EV. values. exact T.
Qed.

Theorem abs_known x r : tracked_known x r -> tracked_known (tracked_abs _ F _ rule x) (Rabs r).
Proof.
  intros K. generalize (promise_sign _ _ _ Rule _ _ _ K). intros S. unfold tracked_abs. cbv zeta.
  change (rule_sign _ _ rule (fst x) (snd x)) with (tracked_sign _ _ rule x) in S.
  assert (W : tracked_known (tracked_within _ _ rule (abs _ F (fst x)) (error_of x)) (Rabs r)).
  { apply (promise_within _ _ _ Rule). intros H _. apply error_of_known in K.
    destruct (proj2 K H) as [FA D]. apply (abs_finite_intro p emax) in FA.
    apply (abs_finite p emax p_3) in FA. destruct FA as [_ ->].
    apply Rle_trans with (2 := D). apply Rabs_triang_inv2. }
  assert (Kept : right_sign (if less _ F (fst x) (integer _ F 0) then negative else positive) r \/ r = 0 ->
    tracked_known (if less _ F (fst x) (integer _ F 0) then tracked_negate _ F _ rule x else x) (Rabs r)).
  { destruct (less _ F (fst x) (integer _ F 0)); simpl; intros D.
    - rewrite Rabs_left1 by lra. now apply negate_known.
    - rewrite Rabs_pos_eq by lra. exact K. }
  destruct (tracked_sign _ _ rule x); auto; destruct (less _ F (fst x) (integer _ F 0)); auto.
Qed.

Lemma larger_error_finite x r y s : tracked_known x r -> tracked_known y s ->
  finite (larger_error _ F _ rule x y) ->
  finite (error_of x) /\ finite (error_of y) /\
  B2R (error_of x) <= B2R (larger_error _ F _ rule x y) /\
  B2R (error_of y) <= B2R (larger_error _ F _ rule x y).
Proof.
  intros KX KY. apply error_of_known in KX, KY. destruct KX as [PX _], KY as [PY _].
  unfold larger_error. cbv zeta. set (e := error_of x) in *. set (g := error_of y) in *.
  destruct (at_most _ F e g) eqn:C1; [| destruct (at_most _ F g e) eqn:C2; [| discriminate]]; intros H.
  - assert (FE : finite e).
    { destruct e as [| t | |], g as [| w | | w]; try discriminate; auto; simpl in *; subst; discriminate. }
    rewrite at_most_finite in C1 by auto. revert C1. case Rle_bool_spec; [| discriminate].
    intros. repeat split; auto. lra.
  - assert (FG : finite g).
    { destruct g as [| t | |], e as [| w | | w]; try discriminate; auto; simpl in *; subst; discriminate. }
    rewrite at_most_finite in C2 by auto. revert C2. case Rle_bool_spec; [| discriminate].
    intros. repeat split; auto. lra.
Qed.
Lemma lesser_known x r y s : tracked_known x r -> tracked_known y s ->
  (finite (fst x) -> finite (fst y) -> B2R (fst x) <= B2R (fst y)) ->
  tracked_known (lesser_or_either _ F _ rule x y) (Rmin r s).
Proof.
  intros KX KY L. unfold lesser_or_either, tracked_compare.
  assert (S : right_sign (tracked_sign _ _ rule (tracked_subtract _ F _ rule x y)) (r - s)).
  { apply (promise_sign _ _ _ Rule). now apply (promise_subtract _ _ _ Rule). }
  assert (W : tracked_known (tracked_within _ _ rule (fst x) (larger_error _ F _ rule x y)) (Rmin r s)).
  { apply (promise_within _ _ _ Rule). intros H _.
    destruct (larger_error_finite x r y s KX KY H) as (FX & FY & LX & LY).
    apply error_of_known in KX, KY. destruct (proj2 KX FX) as [AX DX], (proj2 KY FY) as [AY DY].
    specialize (L AX AY). apply Rabs_le_inv in DX, DY. apply Rabs_le.
    unfold Rmin. destruct (Rle_dec r s); lra. }
  destruct (tracked_sign _ _ rule (tracked_subtract _ F _ rule x y)); simpl in S; auto;
    rewrite Rmin_left by lra; exact KX.
Qed.

Theorem min_known x r y s : tracked_known x r -> tracked_known y s ->
  tracked_known (tracked_min _ F _ rule x y) (Rmin r s).
Proof.
  intros KX KY. unfold tracked_min. destruct (less _ F (fst y) (fst x)) eqn:C.
  - rewrite Rmin_comm. apply lesser_known; auto. intros FY FX. revert C. rewrite less_finite by auto.
    case Rlt_bool_spec; [lra | discriminate].
  - apply lesser_known; auto. intros FX FY. revert C. rewrite less_finite by auto.
    case Rlt_bool_spec; [discriminate | auto].
Qed.
Theorem max_known x r y s : tracked_known x r -> tracked_known y s ->
  tracked_known (tracked_max _ F _ rule x y) (Rmax r s).
Proof.
  intros KX KY. unfold tracked_max.
  assert (E : Rmax r s = - Rmin (- r) (- s)) by (rewrite <- Ropp_Rmax; ring).
  assert (Finite : forall z, finite (fst (tracked_negate _ F _ rule z)) -> finite (fst z)).
  { intros z. apply opposite_finite. }
  assert (Value : forall z, B2R (fst (tracked_negate _ F _ rule z)) = - B2R (fst z)).
  { intros z. apply opposite_value. }
  destruct (less _ F (fst x) (fst y)) eqn:C; rewrite E; [rewrite (Rmin_comm (- r)) |]; apply negate_known;
    apply lesser_known; auto using negate_known; intros F1 F2; apply Finite in F1, F2; rewrite !Value;
    revert C; rewrite less_finite by auto; case Rlt_bool_spec; try discriminate; lra.
Qed.

Theorem fma_known x r y s z t : tracked_known x r -> tracked_known y s -> tracked_known z t ->
  tracked_known (tracked_fma _ F _ rule x y z) (r * s + t).
Proof.
  intros KX KY KZ. unfold tracked_fma. cbv zeta.
  set (e := error_of x). set (g := error_of y). set (k := error_of z). set (v := Code.fma _ F _ _ _).
  change ((equal _ F (fst x) (integer _ F 0)) && equal _ F e (integer _ F 0)) with (is_zero _ F (fst x) e).
  change ((equal _ F (fst y) (integer _ F 0)) && equal _ F g (integer _ F 0)) with (is_zero _ F (fst y) g).
  generalize (error_of_known x r KX) (error_of_known y s KY) (error_of_known z t KZ).
  fold e g k. intros LX LY LZ.
  destruct (_ && _) eqn:C.
  { assert (Zero : r * s = 0).
    { apply andb_prop in C. destruct C as [C _]. apply orb_prop in C.
      destruct C as [C | C]; [rewrite (known_zero p emax p_3 _ _ _ LX C) | rewrite (known_zero p emax p_3 _ _ _ LY C)];
        ring. }
    now rewrite Zero, Rplus_0_l. }
  clear C. apply (promise_within _ _ _ Rule). intros H _. apply enlarged_finite in H. destruct H as [H ->].
  apply plus_finite in H. destruct H as (FR & H & ->). apply rounding_of_finite in FR. destruct FR as [FV ->].
  apply fma_finite in FV. destruct FV as (FX & FY & FZ & EV). fold v in EV.
  parts. values.
  destruct (proj2 LX ltac:(assumption)) as [_ DX], (proj2 LY ltac:(assumption)) as [_ DY],
    (proj2 LZ ltac:(assumption)) as [_ DZ].
  assert (T := Functions.fma_sound_nearest p emin p_3 (B2R (fst x)) r (B2R e) (B2R (fst y)) s (B2R g)
                 (B2R (fst z)) t (B2R k) emin_p).
  unfold Functions.fma_error in T. cbv zeta in T. apply T; auto using number_B2R.
Qed.
End Functions.
