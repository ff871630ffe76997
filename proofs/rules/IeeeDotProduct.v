(** Running error bounds of dot products over IEEE formats (Ieee.v), to nearest, including overflow: if the bound is
    finite, CompoundCode.v computes the numbers of DotProduct.v. Numbers are known in the sense of IeeeRules.v. For
    lists of known numbers of any length, emax > p:
        tight_dot_known   from p = 8 on, the bound that the code returns under `tight` holds for the dot product
        sharp_dot_known   from p = 5 on, that under `sharp` holds *)

From Coq Require Import Reals ZArith Lia Lra Bool List.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code CompoundCode Ieee IeeeRules DotProduct.
From Errbound Require Format AbsoluteBound Sharp.
Import ListNotations.
Open Scope R_scope.

Section Dot.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_5 : (5 <= p)%Z).
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation rounded := (reals p emin Format.nearest).
Notation nonnegative := (nonnegative p emax).
Notation known := (known p emax).
Notation pair := ((float * float) * (float * float))%type.

Lemma p_3 : (3 <= p)%Z.
Proof. lia. Qed.
Ltac parts := finite_parts p emax p_3.
Ltac values := known_values p emax p_3.

Lemma small_integer n : (0 <= n <= 32)%Z -> finite (integer _ F n) /\ B2R (integer _ F n) = IZR n.
Proof.
  intros H. generalize (constant_value p emax n 0). change (bpow radix2 0) with 1. rewrite Rmult_1_r.
  intros C. generalize (p_emax p emax). intros L. apply C.
  - rewrite <- (Rmult_1_r (IZR n)). change 1 with (bpow radix2 0). apply Format.number_integer; auto; [lia |].
    apply Z.le_trans with (2 ^ 5)%Z; [change (2 ^ 5)%Z with 32%Z; lia | apply Z.pow_le_mono_r; lia].
  - rewrite Rabs_pos_eq by (apply IZR_le; lia). apply Rle_lt_trans with (bpow radix2 5).
    + simpl (bpow radix2 5). apply IZR_le. lia.
    + apply bpow_lt. lia.
Qed.

Section Running.

Context (most : nat) (factor_units : nat -> Z) (underflows : nat -> nat -> Z)
  (own_float : bool -> float -> float -> float -> float) (own_real : bool -> R -> R -> R -> R)
  (most_8 : (1 <= most <= 8)%nat) (few_units : forall m, (m <= 8)%nat -> (0 <= factor_units m <= 32)%Z)
  (few_underflows : forall m k, (k <= m <= 8)%nat -> (0 <= underflows m k <= 32)%Z) (own_value : forall first product
    before sum, finite (own_float first product before sum) -> finite before -> finite sum -> B2R (own_float first
    product before sum) = own_real first (B2R product) (B2R before) (B2R sum))
  (own_nonnegative : forall first product before sum, nonnegative (own_float first product before sum)).

Notation running := (running float).
Notation close_terms := (close_terms float F factor_units underflows).
Notation add_term := (add_term float F most factor_units underflows).
Notation close_real := (CompoundCode.close_terms R rounded factor_units underflows).
Notation add_real := (CompoundCode.add_term R rounded most factor_units underflows).

Definition all_finite (s : running) : Prop :=
  finite (closed _ s) /\ finite (own _ s) /\ finite (inherited _ s).
Definition real_of (s : running) : CompoundCode.running R :=
  {| closed := B2R (closed _ s); own := B2R (own _ s); inherited := B2R (inherited _ s);
     terms := terms _ s; uncertain_terms := uncertain_terms _ s |}.
(** The invariant of the loop's states. *)
Definition regular (s : running) : Prop :=
  nonnegative (closed _ s) /\ nonnegative (own _ s) /\ nonnegative (inherited _ s) /\
  (uncertain_terms _ s <= terms _ s < most)%nat /\
  (terms _ s = O -> own _ s = integer _ F 0 /\ inherited _ s = integer _ F 0).

Lemma zero_finite : finite (integer _ F 0) /\ B2R (integer _ F 0) = 0.
Proof. apply (zero_value p emax p_3). Qed.
Lemma close_finite (s : running) : (uncertain_terms _ s <= terms _ s <= 8)%nat -> finite (closed _ (close_terms s)) ->
  all_finite s /\ real_of (close_terms s) = close_real (real_of s).
Proof.
  intros L H. destruct zero_finite as [_ Z]. unfold CompoundCode.close_terms in *. cbn [closed own inherited terms uncertain_terms] in *.
  destruct (small_integer (factor_units (terms _ s)) (few_units (terms _ s) ltac:(lia))) as [_ VU].
  destruct (small_integer (underflows (terms _ s) (uncertain_terms _ s)) (few_underflows _ _ L)) as [_ VL].
  assert (EQ : real_of {| closed := times _ F (plus _ F (plus _ F (own _ s) (plus _ F (inherited _ s) (closed _ s)))
      (times _ F (integer _ F (underflows (terms _ s) (uncertain_terms _ s))) (underflow_unit _ F)))
      (plus _ F (integer _ F 1) (times _ F (integer _ F (factor_units (terms _ s))) (epsilon _ F)));
      own := integer _ F 0; inherited := integer _ F 0; terms := O; uncertain_terms := O |} = close_real (real_of s)).
  { unfold real_of, CompoundCode.close_terms. cbn [closed own inherited terms uncertain_terms plus times integer epsilon
      underflow_unit reals]. rewrite Z. parts. f_equal.
    match goal with H : B2R (times _ _ ?x (plus _ _ _ _)) = _ |- _ => rewrite H end.
    repeat match goal with H : B2R _ = fl _ |- _ => rewrite H; clear H end.
    rewrite (proj2 (integer_value p emax p_3 1 ltac:(lia))), (proj2 (eps_value p emax p_3)), (proj2 (eta_value p emax p_3)), VU, VL.
    reflexivity. }
  split; [| exact EQ]. parts. repeat split; auto.
Qed.
Lemma nonnegative_small n : (0 <= n <= 32)%Z -> nonnegative (integer _ F n).
Proof.
  intros H. destruct (small_integer n H) as [FN V]. apply nonnegative_intro; auto. rewrite V. apply IZR_le. lia.
Qed.
Lemma close_regular s : nonnegative (closed _ s) -> nonnegative (own _ s) -> nonnegative (inherited _ s) ->
  (uncertain_terms _ s <= terms _ s <= 8)%nat -> regular (close_terms s).
Proof.
  intros P1 P2 P3 L. assert (P0 := nonnegative_small 0 ltac:(lia)). assert (P_1 := nonnegative_small 1 ltac:(lia)).
  assert (PU := nonnegative_small _ (few_units (terms _ s) ltac:(lia))).
  assert (PL := nonnegative_small _ (few_underflows _ _ L)).
  split; [| split; [exact P0 | split; [exact P0 | split; [cbn; lia | now intros _]]]].
  cbn [closed CompoundCode.close_terms].
  repeat first [apply nonnegative_times; auto | apply nonnegative_plus; auto].
  - apply nonnegative_eta. exact p_3.
  - apply nonnegative_eps. exact p_3.
Qed.

Lemma exact_value sa sb : finite sa -> finite sb ->
  equal _ F sa (integer _ F 0) && equal _ F sb (integer _ F 0) =
  equal _ rounded (B2R sa) 0 && equal _ rounded (B2R sb) 0.
Proof. intros A B. destruct zero_finite as [Z0 Z]. now rewrite !(equal_finite p emax), Z. Qed.

Lemma add_finite s v a sa b sb : regular s -> nonnegative v -> nonnegative sa -> nonnegative sb ->
  regular (add_term s v a sa b sb) /\
  (finite a -> finite b -> all_finite (add_term s v a sa b sb) ->
   all_finite s /\ finite v /\ finite sa /\ finite sb /\
   real_of (add_term s v a sa b sb) = add_real (real_of s) (B2R v) (B2R a) (B2R sa) (B2R b) (B2R sb)).
Proof.
  intros (P1 & P2 & P3 & L & Z) PV PSA PSB. destruct zero_finite as [Z0 ZV].
  unfold CompoundCode.add_term.
  set (exact := equal _ F sa (integer _ F 0) && equal _ F sb (integer _ F 0)).
  set (I := plus _ F (times _ F (Code.abs _ F a) sb) (times _ F sa (plus _ F (Code.abs _ F b) sb))).
  set (t := {| closed := closed _ s; own := plus _ F (own _ s) v;
               inherited := if exact then inherited _ s else plus _ F (inherited _ s) I;
               terms := S (terms _ s);
               uncertain_terms := if exact then uncertain_terms _ s else S (uncertain_terms _ s) |}).
  assert (PI : nonnegative I).
  { assert (P := p_3). unfold I. positive. }
  assert (PT : nonnegative (closed _ t) /\ nonnegative (own _ t) /\ nonnegative (inherited _ t)).
  { unfold t. cbn [closed own inherited]. repeat split; auto.
    - now apply nonnegative_plus.
    - destruct exact; auto. now apply nonnegative_plus. }
  destruct PT as (PT1 & PT2 & PT3).
  assert (LT : (uncertain_terms _ t <= terms _ t <= 8)%nat).
  { unfold t. cbn [terms uncertain_terms]. destruct exact; lia. }
  assert (Part : finite a -> finite b -> all_finite t -> all_finite s /\ finite v /\ finite sa /\ finite sb /\
    real_of t = {| closed := closed _ (real_of s); own := plus _ rounded (own _ (real_of s)) (B2R v);
      inherited := if equal _ rounded (B2R sa) 0 && equal _ rounded (B2R sb) 0 then inherited _ (real_of s)
                   else plus _ rounded (inherited _ (real_of s))
                     (plus _ rounded (times _ rounded (Code.abs _ rounded (B2R a)) (B2R sb))
                        (times _ rounded (B2R sa) (plus _ rounded (Code.abs _ rounded (B2R b)) (B2R sb))));
      terms := S (terms _ (real_of s));
      uncertain_terms := if equal _ rounded (B2R sa) 0 && equal _ rounded (B2R sb) 0
                         then uncertain_terms _ (real_of s) else S (uncertain_terms _ (real_of s)) |}).
  { intros FA FB (H1 & H2 & H3). unfold t in H1, H2, H3. cbn [closed own inherited] in H1, H2, H3.
    apply plus_finite in H2. destruct H2 as (H2 & HV & E2).
    assert (S : finite sa /\ finite sb /\ finite (inherited _ s)).
    { destruct exact eqn:X.
      - unfold exact in X. apply andb_prop in X. destruct X as [X1 X2].
        apply (equal_true p emax) in X1, X2; auto. tauto.
      - unfold I in H3. clear - H3 p_5. parts. auto. }
    destruct S as (FSA & FSB & FI). repeat split; auto.
    unfold t, real_of. cbn [closed own inherited terms uncertain_terms plus times reals].
    rewrite E2, <- (exact_value sa sb FSA FSB). fold exact.
    destruct exact eqn:X; [reflexivity |]. f_equal. unfold I in *.
    rewrite !(abs_reals p emin). clear - H3 FA FB FSA FSB p_5. parts.
    repeat match goal with H : B2R _ = fl _ |- _ => rewrite H; clear H end. values. reflexivity. }
  change (terms _ (real_of s)) with (terms _ s) in *. cbn [terms t].
  destruct (Nat.eqb_spec (S (terms _ s)) most) as [EM | EM].
  - split; [now apply close_regular |]. intros FA FB H. apply close_finite in LT; [| apply H]. destruct LT as [H' E].
    destruct (Part FA FB H') as (G1 & G2 & G3 & G4 & E'). repeat split; try apply G1; auto.
    rewrite E, E'. reflexivity.
  - split.
    + split; [exact PT1 |]. split; [exact PT2 |]. split; [exact PT3 |]. split; [| discriminate].
      unfold t in *. cbn [terms uncertain_terms] in *. lia.
    + exact Part.
Qed.

(** The loop. *)
Notation step := (dot_step float F most factor_units underflows own_float).
Notation step_real := (dot_step R rounded most factor_units underflows own_real).
Definition real_pair (x : pair) : (R * R) * (R * R) :=
  ((B2R (fst (fst x)), B2R (snd (fst x))), (B2R (fst (snd x)), B2R (snd (snd x)))).
Definition real_state (s : float * bool * running) : R * bool * CompoundCode.running R :=
  (B2R (fst (fst s)), snd (fst s), real_of (snd s)).
Definition state_finite (s : float * bool * running) : Prop := finite (fst (fst s)) /\ all_finite (snd s).
Definition known_pair (x : pair) (exact : R * R) : Prop :=
  known (fst (fst x)) (snd (fst x)) (fst exact) /\ known (fst (snd x)) (snd (snd x)) (snd exact).

Lemma step_finite s x exact : regular (snd s) -> known_pair x exact ->
  (state_finite (step s x) ->
   state_finite s /\ real_state (step s x) = step_real (real_state s) (real_pair x) /\
   DotProduct.pair_known p emin (real_pair x) exact).
Proof.
  destruct s as [[before first] bound], x as [[a sa] [b sb]], exact as [x y].
  unfold known_pair, dot_step, state_finite, real_state, real_pair. cbn [fst snd]. intros Reg [KA KB].
  set (product := times _ F a b). set (sum := plus _ F before product).
  intros H. assert (HS : finite sum) by (destruct (is_zero _ F a sa || is_zero _ F b sb); apply H).
  assert (G := plus_finite p emax _ _ HS). destruct G as (Fb & Fp & ES).
  assert (G := times_finite p emax _ _ Fp). destruct G as (FA & FB & EP).
  destruct zero_finite as [Z0 Z].
  assert (ZR : forall c sc, is_zero _ F c sc = true -> Code.is_zero R rounded (B2R c) (B2R sc) = true).
  { intros c sc C. apply (is_zero_true p emax p_3) in C. destruct C as (_ & _ & -> & ->). apply zero_is_zero. }
  unfold DotProduct.pair_known.
  destruct (is_zero _ F a sa || is_zero _ F b sb) eqn:C0.
  - cbn [fst snd] in *. split; [split; [exact Fb | apply H] |]. cbn [plus times reals].
    fold sum in ES. fold product in EP. split.
    + replace (is_zero R rounded (B2R a) (B2R sa) || is_zero R rounded (B2R b) (B2R sb)) with true.
      * now rewrite ES, EP.
      * symmetry. apply orb_prop in C0. destruct C0 as [C0 | C0]; rewrite (ZR _ _ C0); auto using orb_true_r.
    + split; [apply number_B2R |]. split; [apply number_B2R |]. apply orb_prop in C0. destruct C0 as [C0 | C0].
      * left. assert (X := known_zero p emax p_3 _ _ _ KA C0). apply (is_zero_true p emax p_3) in C0. tauto.
      * right. left. assert (X := known_zero p emax p_3 _ _ _ KB C0). apply (is_zero_true p emax p_3) in C0. tauto.
  - cbn [fst snd] in *. destruct H as [_ H].
    destruct (add_finite bound (own_float first product before sum) a sa b sb Reg) as [_ A];
      auto; [apply KA | apply KB |].
    destruct (A FA FB H) as (G1 & G2 & FSA & FSB & E). split; [split; [exact Fb | exact G1] |].
    cbn [plus times reals]. split.
    + assert (C1 : Code.is_zero R rounded (B2R a) (B2R sa) || Code.is_zero R rounded (B2R b) (B2R sb) = false).
      { change (AbsoluteBound.is_zero (B2R a) (B2R sa) || AbsoluteBound.is_zero (B2R b) (B2R sb) = false).
        rewrite <- !(is_zero_value p emax p_3) by auto. exact C0. }
      rewrite C1, E, own_value by auto. fold sum in ES. fold product in EP. now rewrite ES, EP.
    + split; [apply number_B2R |]. split; [apply number_B2R |]. right. right.
      split; [apply number_B2R |]. split; [apply number_B2R |]. split; [now apply KA | now apply KB].
Qed.

Lemma step_regular s x exact : regular (snd s) -> known_pair x exact -> regular (snd (step s x)).
Proof.
  destruct s as [[before first] bound], x as [[a sa] [b sb]], exact as [y z].
  unfold known_pair, dot_step. cbn [fst snd]. intros Reg [KA KB].
  destruct (is_zero _ F a sa || is_zero _ F b sb); [exact Reg |]. cbn [snd].
  apply add_finite; auto; [apply KA | apply KB].
Qed.
Lemma loop_finite pairs exacts : Forall2 known_pair pairs exacts -> forall s, regular (snd s) ->
  regular (snd (fold_left step pairs s)) /\
  (state_finite (fold_left step pairs s) ->
   state_finite s /\
   real_state (fold_left step pairs s) = fold_left step_real (map real_pair pairs) (real_state s) /\
   Forall2 (DotProduct.pair_known p emin) (map real_pair pairs) exacts).
Proof.
  induction 1 as [| x exact pairs exacts K _ IH]; intros s Reg; cbn [fold_left map].
  - split; [exact Reg |]. intros H. split; [exact H |]. split; [reflexivity | constructor].
  - destruct (IH (step s x) (step_regular s x exact Reg K)) as [I1 I2]. split; [exact I1 |].
    intros H. destruct (I2 H) as (H1 & H2 & H3). destruct (step_finite s x exact Reg K H1) as (G1 & G2 & G3).
    split; [exact G1 |]. split; [now rewrite H2, G2 | now constructor].
Qed.

Lemma dot_known pairs exacts : Forall2 known_pair pairs exacts ->
  (forall reals_pairs, Forall2 (DotProduct.pair_known p emin) reals_pairs exacts ->
   let '(sum, bound) := dot_of R rounded most factor_units underflows own_real reals_pairs in
   Format.number p emin bound /\ Rabs (sum - exact_dot exacts) <= bound) ->
  let '(sum, bound) := dot_of float F most factor_units underflows own_float pairs in
  known sum bound (exact_dot exacts).
Proof.
  intros K Sound. destruct zero_finite as [Z0 Z]. unfold dot_of.
  assert (P0 := nonnegative_small 0 ltac:(lia)).
  assert (R0 : regular (snd (integer _ F 0, true, no_terms float F))).
  { split; [exact P0 |]. split; [exact P0 |]. split; [exact P0 |]. split; [cbn; lia | auto]. }
  destruct (loop_finite pairs exacts K _ R0) as [Reg Fin].
  set (start := (integer _ F 0, true, no_terms float F)) in *.
  destruct (fold_left step pairs start) as [[sum first] bound] eqn:L. cbn [snd] in Reg.
  destruct Reg as (P1 & P2 & P3 & Few & None).
  assert (Last : nonnegative (closed_bound _ F factor_units underflows bound) /\
    (finite (closed_bound _ F factor_units underflows bound) -> all_finite bound /\
     B2R (closed_bound _ F factor_units underflows bound) =
     closed_bound _ rounded factor_units underflows (real_of bound))).
  { unfold closed_bound. change (terms _ (real_of bound)) with (terms _ bound).
    destruct (Nat.ltb_spec 0 (terms _ bound)) as [T | T].
    - split; [apply (close_regular bound); auto; lia |]. intros H.
      destruct (close_finite bound ltac:(lia) H) as [A E]. split; [exact A |]. now rewrite <- E.
    - split; [exact P1 |]. intros H. destruct (None ltac:(lia)) as [N1 N2]. split; [| reflexivity].
      unfold all_finite. now rewrite N1, N2. }
  destruct Last as [PL VL]. split.
  - apply nonnegative_plus; auto. apply nonnegative_nothing.
  - intros H. apply plus_finite in H. destruct H as (H1 & H2 & E). apply minus_finite in H2.
    destruct H2 as (FS & _ & ES). destruct (VL H1) as [A EV].
    destruct (Fin (conj FS A)) as (_ & E' & K'). split; [exact FS |].
    specialize (Sound _ K'). unfold dot_of in Sound.
    replace (real_state start) with (0, true, no_terms R rounded) in E'
      by (unfold real_state, start, real_of, no_terms; cbn [fst snd closed own inherited terms uncertain_terms]; now rewrite Z).
    cbn [integer reals] in Sound. rewrite <- E' in Sound. cbn [real_state fst snd] in Sound.
    rewrite E, ES, EV. exact (proj2 Sound).
Qed.
End Running.

Theorem tight_dot_known pairs exacts : (8 <= p)%Z -> Forall2 known_pair pairs exacts ->
  let '(sum, bound) := tight_dot float F pairs in known sum bound (exact_dot exacts).
Proof.
  intros P K. assert (Three := p_3). destruct (zero_value p emax p_3) as [Z0 Z].
  apply dot_known with (tight_own R rounded); auto.
  - split; [apply one_at_least; cbn [digits floats]; lia |].
    destruct (tight_most float F) as [| m] eqn:M; [lia |].
    apply (terms_squared (p - 2)). change (p - 2)%Z with (digits float F - 2)%Z. fold (tight_most float F). lia.
  - intros m M. unfold tight_units. lia.
  - intros m k M. unfold tight_underflows. lia.
  - intros first product before sum H FB FS. unfold tight_own in *. cbn [plus integer reals].
    apply plus_finite in H. destruct H as (H1 & H2 & E). rewrite E.
    assert (RT : forall v, finite (tight_rounding _ F v) -> B2R (tight_rounding _ F v) = tight_rounding R rounded (B2R v)).
    { intros v FV. apply (tight_rounding_finite p emax p_3) in FV. destruct FV as [_ ->].
      unfold tight_rounding. rewrite (abs_reals p emin). reflexivity. }
    rewrite (RT _ H1). destruct first; [now rewrite Z | now rewrite (RT _ H2)].
  - intros first product before sum. unfold tight_own, tight_rounding. apply nonnegative_plus; [positive |].
    destruct first; [now apply nonnegative_intro; rewrite ?Z; [| lra] | positive].
  - intros reals_pairs KR. apply tight_dot_sound; auto with typeclass_instances. apply (emin_p p emax p_3).
Qed.
Theorem sharp_dot_known pairs exacts : Forall2 known_pair pairs exacts ->
  let '(sum, bound) := sharp_dot float F pairs in known sum bound (exact_dot exacts).
Proof.
  intros K. assert (Three := p_3).
  apply dot_known with (sharp_own R rounded); auto.
  - split; [apply one_at_least; cbn [digits floats]; lia |].
    destruct (sharp_most float F) as [| m] eqn:M; [lia |].
    apply (terms_squared (p + 1)). change (p + 1)%Z with (digits float F + 1)%Z. fold (sharp_most float F). lia.
  - intros m M. unfold sharp_units.
    assert (Z.of_nat (m + 7) / 2 < 8)%Z by (apply Z.div_lt_upper_bound; lia).
    assert (0 <= Z.of_nat (m + 7) / 2)%Z by (apply Z.div_pos; lia). lia.
  - intros m k M. unfold sharp_underflows. lia.
  - intros first product before sum H FB FS. unfold sharp_own in *. cbn [plus reals].
    apply plus_finite in H. destruct H as (H1 & H2 & E). rewrite E.
    unfold sharp_rounding in *. apply times_finite in H1. destruct H1 as (H1 & _ & E1).
    apply (abs_finite p emax p_3) in H1. destruct H1 as (FP & EP). rewrite E1, EP, (proj2 (u_value p emax p_3)).
    assert (LV : forall x y x' y', finite x -> finite y -> B2R x = x' -> B2R y = y' ->
      finite (least _ F x y) /\ B2R (least _ F x y) = least R rounded x' y').
    { intros x y x' y' X Y <- <-. unfold least. rewrite (less_finite p emax) by auto. cbn [less reals].
      now destruct (Rlt_bool (B2R y) (B2R x)). }
    assert (AV : forall x, finite x -> finite (Code.abs _ F x) /\ B2R (Code.abs _ F x) = Code.abs R rounded (B2R x)).
    { intros x X. assert (XF := abs_finite_intro p emax x X). split; auto. rewrite (abs_reals p emin).
      now apply (abs_finite p emax p_3). }
    assert (FU : finite (times _ F (Code.abs _ F sum) (unit_roundoff _ F)) /\
      B2R (times _ F (Code.abs _ F sum) (unit_roundoff _ F)) = fl (Code.abs R rounded (B2R sum) * Format.u p)).
    { destruct (AV sum FS) as [AF AE]. destruct (u_value p emax p_3) as [UF UE]. rewrite <- AE, <- UE.
      generalize (Bmult_correct p emax _ _ mode_NE (Code.abs _ F sum) (unit_roundoff _ F)).
      rewrite Rlt_bool_true.
      - intros (M1 & M2 & _). rewrite AF, UF in M2. split; [exact M2 | exact M1].
      - apply Rle_lt_trans with (bpow radix2 (emax - p)); [| apply bpow_lt; lia].
        apply (Format.rnd_abs_below p emin Format.nearest);
          [apply Format.number_power; auto; generalize (p_emax p emax); lia |].
        rewrite AE, UE, (abs_reals p emin), Rabs_mult, Rabs_Rabsolu, (Rabs_pos_eq (Format.u p))
          by apply bpow_ge_0.
        replace (emax - p)%Z with (emax + - p)%Z by lia. rewrite bpow_plus.
        apply Rmult_le_compat_r; [apply bpow_ge_0 | apply Rlt_le, abs_B2R_lt_emax]. }
    destruct FU as [FU EU], (AV product FP) as [PF PE], (AV before FB) as [BF BE].
    destruct (LV _ _ _ _ PF BF PE BE) as [LF LE]. destruct (LV _ _ _ _ FU LF EU LE) as [_ ->].
    rewrite !(abs_reals p emin). reflexivity.
  - intros first product before sum. unfold sharp_own.
    assert (LN : forall x y, nonnegative x -> nonnegative y -> nonnegative (least _ F x y)).
    { intros x y X Y. unfold least. now destruct (less _ F y x). }
    unfold sharp_rounding. apply nonnegative_plus; [positive |]. apply LN; [positive |]. apply LN; positive.
  - intros reals_pairs KR. apply sharp_dot_sound; auto. apply (emin_p p emax p_3).
Qed.

End Dot.
