(** Bound rules over IEEE formats (Ieee.v), to nearest, including overflow: the functions of Code.v.

    A number x is known by a value a and an error s, both floats. The error s is not negative, but possibly infinite
    or NaN. If s is finite, so is a, and |a - x| <= s. Results, for p >= 3 and emax > p: bounds of `exact` hold, and
    so do bounds of operations on known numbers, even after an overflow:
        tight_exact_known, tight_within_known, tight_add_known, tight_subtract_known, tight_multiply_known,
        tight_divide_known, tight_scale_known
        sharp_add_known, sharp_subtract_known, sharp_multiply_known, sharp_divide_known, sharp_scale_known (exact and
        within are those of tight)
        tight_negate_known   the same bound holds for -x, in both rules
        sign_of_known, none_guesses   the default sign is right or uncertain, except under the rule none
                             (emax > p makes u a number of the format) *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code Ieee.
From Errbound Require Format AbsoluteBound Tight Sharp Upper.
Open Scope R_scope.

Section Rules.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_3 : (3 <= p)%Z).
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation number := (Format.number p emin).
Notation nonnegative := (nonnegative p emax).
Notation emin_p := (emin_p p emax p_3).

Ltac parts := finite_parts p emax p_3.
Ltac values := known_values p emax p_3.

Let rnd_0 := Format.rnd_0 p emin Format.nearest.

(** A number x is known by a value and an error. *)
Definition known (a s : float) (x : R) : Prop :=
  nonnegative s /\ (finite s -> finite a /\ Rabs (B2R a - x) <= B2R s).

Lemma equal_true x y : finite y -> equal _ F x y = true -> finite x /\ B2R x = B2R y.
Proof.
  intros Y. destruct (BinarySingleNaN.is_finite x) eqn:X.
  - rewrite (equal_finite p emax x y X Y). case Req_bool_spec; easy.
  - destruct x as [| s | |], y; try easy; destruct s; easy.
Qed.
Lemma less_true_0 x : less _ F (integer _ F 0) x = true -> 0 < B2R x \/ x = B754_infinity false.
Proof.
  destruct (zero_value p emax p_3) as [Z0 Z]. destruct (BinarySingleNaN.is_finite x) eqn:X.
  - rewrite (less_finite p emax _ _ Z0 X), Z. case Rlt_bool_spec; [now left | discriminate].
  - destruct x as [| s | |]; try discriminate. destruct s; [discriminate | now right].
Qed.
Lemma is_zero_true a s : is_zero _ F a s = true -> finite a /\ finite s /\ B2R a = 0 /\ B2R s = 0.
Proof.
  destruct (zero_value p emax p_3) as [Z0 Z]. unfold is_zero. intros H.
  apply andb_prop in H. destruct H as [H1 H2]. apply equal_true in H1, H2; auto.
  rewrite Z in *. tauto.
Qed.
Lemma is_zero_value a s : finite a -> finite s ->
  is_zero _ F a s = AbsoluteBound.is_zero (B2R a) (B2R s).
Proof.
  destruct (zero_value p emax p_3) as [Z0 Z]. intros A S. unfold is_zero, AbsoluteBound.is_zero.
  now rewrite !equal_finite, Z.
Qed.
Lemma known_zero a s x : known a s x -> is_zero _ F a s = true -> x = 0.
Proof.
  intros (_ & K) H. apply is_zero_true in H. destruct H as (_ & FS & A & S).
  destruct (K FS) as [_ B]. rewrite A, S in B. apply Format.within_0 in B. lra.
Qed.

(** The rules' definitions over the real numbers are what Code.v computes. *)
Lemma tight_rounding_finite v : finite (tight_rounding _ F v) ->
  finite v /\ B2R (tight_rounding _ F v) = Tight.rounding p emin Format.nearest (B2R v).
Proof. unfold tight_rounding, Tight.rounding. intros H. parts. split; auto. values. reflexivity. Qed.
Lemma tight_inflated_finite b : finite (tight_inflated _ F b) ->
  finite b /\ B2R (tight_inflated _ F b) = Tight.inflated p emin Format.nearest (B2R b).
Proof. unfold tight_inflated, Tight.inflated. intros H. parts. split; auto. values. reflexivity. Qed.
Definition tight_enlarged (v sa sb : float) : float := tight_inflated _ F (tight_rounding _ F v ⊕ (sa ⊕ sb)).
Definition sharp_enlarged (v sa sb : float) : float :=
  (sharp_rounding _ F v ⊕ (sa ⊕ sb)) ⊗ (integer _ F 1 ⊕ integer _ F 2 ⊗ epsilon _ F).
Lemma tight_enlarged_finite v sa sb : finite (tight_enlarged v sa sb) ->
  finite v /\ finite sa /\ finite sb /\
  B2R (tight_enlarged v sa sb) = Tight.tight_enlarged p emin Format.nearest (B2R v) (B2R sa) (B2R sb).
Proof.
  unfold tight_enlarged. intros H. apply tight_inflated_finite in H. destruct H as [H E]. parts.
  apply tight_rounding_finite in H. destruct H as [H ER]. repeat split; auto.
  values. reflexivity.
Qed.

Lemma sharp_rounding_finite v : finite (sharp_rounding _ F v) ->
  finite v /\ B2R (sharp_rounding _ F v) = Sharp.rounding p emin (B2R v).
Proof. unfold sharp_rounding, Sharp.rounding. intros H. parts. split; auto. now values. Qed.
Lemma sharp_inflated_finite b : finite (sharp_inflated _ F b) ->
  finite b /\ B2R (sharp_inflated _ F b) = Sharp.inflated p emin (B2R b).
Proof. unfold sharp_inflated, Sharp.inflated. intros H. parts. split; auto. now values. Qed.
Lemma sharp_enlarged_finite v sa sb : finite (sharp_enlarged v sa sb) ->
  finite v /\ finite sa /\ finite sb /\
  B2R (sharp_enlarged v sa sb) = Sharp.sharp_enlarged p emin (B2R v) (B2R sa) (B2R sb).
Proof.
  unfold sharp_enlarged. intros H. parts.
  match goal with H : finite (sharp_rounding _ _ _) |- _ => apply sharp_rounding_finite in H; destruct H end.
  repeat split; auto. now values.
Qed.

(** Splits both rules' bounds: none is negative, and finite ones are those over the real numbers. *)
Ltac positive_bound := unfold tight_inflated, tight_rounding, sharp_inflated, sharp_rounding; positive.
Ltac rounded := match goal with
  | H : finite (tight_rounding _ _ _) |- _ => apply tight_rounding_finite in H; destruct H
  | H : finite (sharp_rounding _ _ _) |- _ => apply sharp_rounding_finite in H; destruct H
  end.
Ltac inflated := match goal with
  | H : finite (tight_inflated _ _ _) |- _ => apply tight_inflated_finite in H; destruct H
  | H : finite (sharp_inflated _ _ _) |- _ => apply sharp_inflated_finite in H; destruct H
  end.
(** Sums of bounds. *)
Lemma minus_nonnegative_finite x y : finite x -> finite y -> nonnegative x -> nonnegative y ->
  finite (x ⊖ y).
Proof.
  intros FX FY PX PY. apply nonnegative_value in PX, PY.
  generalize (Bminus_correct p emax _ _ mode_NE x y FX FY). rewrite Rlt_bool_true; [now intros (_ & ? & _) |].
  apply Rle_lt_trans with (Rmax (B2R x) (B2R y)).
  - apply (Format.rnd_abs_below p emin Format.nearest).
    + apply Rmax_case; apply number_B2R.
    + apply Rabs_le. generalize (Rmax_l (B2R x) (B2R y)) (Rmax_r (B2R x) (B2R y)). lra.
  - apply Rmax_case; (apply Rle_lt_trans with (1 := Rle_abs _); apply abs_B2R_lt_emax).
Qed.
Lemma nonnegative_sum_above x y : nonnegative x -> nonnegative y -> nonnegative (sum_above _ F x y).
Proof. intros X Y. unfold sum_above. cbv zeta. destruct less; positive. Qed.
Lemma sum_above_finite x y : nonnegative x -> nonnegative y -> finite (sum_above _ F x y) ->
  finite x /\ finite y /\ B2R (sum_above _ F x y) = Upper.sum_above p emin Format.nearest (B2R x) (B2R y).
Proof.
  intros PX PY H. assert (FS : finite (x ⊕ y)).
  { revert H. unfold sum_above. cbv zeta. destruct less; auto. intros H. apply times_finite in H. tauto. }
  assert (G := plus_finite p emax _ _ FS). destruct G as (FX & FY & ES).
  split; auto. split; auto. revert H. unfold sum_above, Upper.sum_above. cbv zeta.
  assert (M : finite (max _ F x y) /\ nonnegative (max _ F x y) /\ B2R (max _ F x y) = Rmax (B2R x) (B2R y)).
  { unfold max. rewrite less_finite by auto. unfold Rmax.
    case Rlt_bool_spec; intros C; destruct (Rle_dec (B2R x) (B2R y)); repeat split; auto; lra. }
  assert (L : finite (least _ F x y) /\ B2R (least _ F x y) = Rmin (B2R x) (B2R y)).
  { unfold least. rewrite less_finite by auto. unfold Rmin.
    case Rlt_bool_spec; intros C; destruct (Rle_dec (B2R x) (B2R y)); split; auto; lra. }
  destruct M as (FM & PM & EM), L as (FL & EL).
  assert (PS : nonnegative (x ⊕ y)) by positive.
  assert (D := minus_nonnegative_finite _ _ FS FM PS PM).
  assert (G := minus_finite p emax _ _ D). destruct G as (_ & _ & ED).
  rewrite (less_finite p emax _ _ D FL), ED, ES, EM, EL.
  destruct Rlt_bool; intros H; [| exact ES]. apply times_finite in H. destruct H as (_ & H & ->).
  rewrite ES. parts. now values.
Qed.

(** Either bound of a sum: the single formula, or the sum of own and x + y rounded upwards. *)
Lemma nonnegative_sum_of_bounds enlarged own x y : nonnegative enlarged -> nonnegative own -> nonnegative x ->
  nonnegative y -> nonnegative (sum_of_bounds _ F enlarged own x y).
Proof.
  intros PE PO PX PY. unfold sum_of_bounds. destruct (40 <=? _)%Z; auto. destruct less; auto.
  unfold least. destruct less; auto using nonnegative_sum_above.
Qed.
Lemma sum_of_bounds_finite enlarged own x y : nonnegative own -> nonnegative x -> nonnegative y ->
  finite (sum_of_bounds _ F enlarged own x y) ->
  sum_of_bounds _ F enlarged own x y = enlarged \/
  finite own /\ finite x /\ finite y /\
  B2R own + (B2R x + B2R y) <= B2R (sum_of_bounds _ F enlarged own x y).
Proof.
  intros PO PX PY. unfold sum_of_bounds. destruct (40 <=? _)%Z; auto. destruct less; auto.
  unfold least. destruct less; auto. intros H. right. assert (P := nonnegative_sum_above x y PX PY).
  destruct (sum_above_finite _ _ PO P H) as (FO & FS & E). destruct (sum_above_finite _ _ PX PY FS) as (FX & FY & ES).
  repeat split; auto. rewrite E, ES. apply nonnegative_value in PO, PX, PY.
  assert (L : (emin <= - p)%Z) by apply emin_p.
  assert (S : B2R x + B2R y <= Upper.sum_above p emin Format.nearest (B2R x) (B2R y)).
  { apply Upper.sum_above_sound; auto using number_B2R with typeclass_instances; lia. }
  apply Rle_trans with (B2R own + Upper.sum_above p emin Format.nearest (B2R x) (B2R y)); [lra |].
  apply Upper.sum_above_sound; auto using number_B2R with typeclass_instances; try lia; [| lra].
  apply Upper.sum_above_number; auto with typeclass_instances.
Qed.

Lemma sum_bounded first own v sa sb e :
  nonnegative first -> nonnegative own -> nonnegative sa -> nonnegative sb ->
  (finite first -> finite own /\ finite sa /\ finite sb /\ B2R own + (B2R sa + B2R sb) <= B2R first) ->
  (finite own -> finite sa -> finite sb -> finite v /\ Rabs (B2R v - e) <= B2R own + (B2R sa + B2R sb)) ->
  known v (sum_of_bounds _ F first own sa sb) e.
Proof.
  intros PF PO PA PB One Error. split; [now apply nonnegative_sum_of_bounds |]. intros H.
  assert (G : finite own /\ finite sa /\ finite sb /\
    B2R own + (B2R sa + B2R sb) <= B2R (sum_of_bounds _ F first own sa sb)).
  { destruct (sum_of_bounds_finite first own sa sb PO PA PB H) as [E | G]; auto.
    rewrite E in *. now apply One. }
  destruct G as (FO & FA & FB & L). destruct (Error FO FA FB) as [FV D]. split; auto. lra.
Qed.

Theorem tight_exact_known a : known a (tight_exact _ F a) (B2R a).
Proof.
  split; [apply nonnegative_nothing; auto |]. unfold tight_exact. intros H. parts. split; auto.
  values. replace (B2R a - B2R a) with 0 by ring. rewrite Rabs_R0, rnd_0. lra.
Qed.
(** A negative, infinite or NaN error gives an unknown number. *)
Theorem tight_within_known a error x :
  (finite error -> 0 <= B2R error -> Rabs (B2R a - x) <= B2R error) -> known a (tight_within _ F a error) x.
Proof.
  intros K. unfold tight_within. destruct (zero_value p emax p_3) as [Z0 Z].
  destruct (at_most _ F (integer _ F 0) error) eqn:C; [| split; [reflexivity | discriminate]].
  assert (P : finite error -> 0 <= B2R error).
  { intros FE. revert C. rewrite at_most_finite, Z by auto. now case Rle_bool_spec. }
  split.
  - apply nonnegative_plus; auto; [| now apply nonnegative_nothing].
    destruct (BinarySingleNaN.is_finite error) eqn:FE; [apply nonnegative_intro; auto |].
    destruct error as [| s | |]; try easy. now destruct s.
  - intros H. parts. split; auto. specialize (K ltac:(assumption) ltac:(auto)).
    values. replace (B2R a - B2R a) with 0 by ring. rewrite Format.rnd_0, Rplus_0_r by auto with typeclass_instances.
    rewrite (Format.rnd_exact p emin Format.nearest); auto. apply number_B2R.
Qed.

Lemma tight_sum_bounded v sa sb e : nonnegative sa -> nonnegative sb ->
  (finite v -> finite sa -> finite sb -> Rabs (B2R v - e) <=
     Tight.rounding p emin Format.nearest (B2R v) + (B2R sa + B2R sb)) ->
  known v (tight_add _ F v sa sb) e.
Proof.
  intros PA PB H. apply (sum_bounded (tight_enlarged v sa sb) (tight_rounding _ F v)); auto;
    try solve [unfold tight_enlarged; positive_bound].
  - intros One. assert (G := tight_enlarged_finite _ _ _ One). destruct G as (_ & FA & FB & E).
    rewrite E. unfold tight_enlarged in One. apply tight_inflated_finite in One.
    destruct One as [One _]. parts. repeat split; auto.
    rewrite (proj2 (tight_rounding_finite v ltac:(assumption))).
    apply Tight.tight_enlarged_sound_nearest; auto using number_B2R, nonnegative_value; apply emin_p.
  - intros FO FA FB. apply tight_rounding_finite in FO. destruct FO as [FV EV]. rewrite EV. auto.
Qed.
Lemma sharp_sum_bounded v sa sb e : nonnegative sa -> nonnegative sb ->
  (finite v -> finite sa -> finite sb -> Rabs (B2R v - e) <=
     Sharp.rounding p emin (B2R v) + (B2R sa + B2R sb)) ->
  known v (sharp_add _ F v sa sb) e.
Proof.
  intros PA PB H. apply (sum_bounded (sharp_enlarged v sa sb) (sharp_rounding _ F v)); auto;
    try solve [unfold sharp_enlarged; positive_bound].
  - intros One. assert (G := sharp_enlarged_finite _ _ _ One). destruct G as (_ & FA & FB & E).
    rewrite E. unfold sharp_enlarged in One. parts. repeat split; auto.
    rewrite (proj2 (sharp_rounding_finite v ltac:(assumption))).
    apply Sharp.sharp_enlarged_sound; auto using number_B2R, nonnegative_value; apply emin_p.
  - intros FO FA FB. apply sharp_rounding_finite in FO. destruct FO as [FV EV]. rewrite EV. auto.
Qed.
(** Proves a sum or difference, from the property `error` of the rounded result. *)
Ltac sum_known bounded error :=
  intros [PA KA] [PB KB]; apply bounded; auto; intros FV FA FB;
  destruct (KA FA) as [_ HA], (KB FB) as [_ HB]; parts; values;
  apply error; auto using number_B2R, Format.number_opp; apply emin_p.

Theorem tight_add_known a sa x b sb y : known a sa x -> known b sb y ->
  known (a ⊕ b) (tight_add _ F (a ⊕ b) sa sb) (x + y).
Proof. sum_known tight_sum_bounded Tight.tight_sum_error_nearest. Qed.
Theorem tight_subtract_known a sa x b sb y : known a sa x -> known b sb y ->
  known (a ⊖ b) (tight_add _ F (a ⊖ b) sa sb) (x - y).
Proof. sum_known tight_sum_bounded Tight.tight_difference_error_nearest. Qed.

(** A product with an exact zero. *)
Lemma zero_times a b : finite (a ⊗ b) -> B2R a = 0 \/ B2R b = 0 -> B2R (a ⊗ b) = 0.
Proof.
  intros H Z. apply times_finite in H. destruct H as (_ & _ & ->).
  replace (B2R a * B2R b) with 0 by (destruct Z as [-> | ->]; ring). apply rnd_0.
Qed.
Lemma product_with_zero a sa x b sb y :
  known a sa x -> known b sb y -> finite (a ⊗ b) ->
  is_zero _ F a sa || is_zero _ F b sb = true -> B2R (a ⊗ b) = 0 /\ x * y = 0.
Proof.
  intros KA KB H C. apply orb_prop in C. split.
  - apply zero_times; auto. destruct C as [C | C]; apply is_zero_true in C; tauto.
  - destruct C as [C | C].
    + rewrite (known_zero _ _ _ KA C). ring.
    + rewrite (known_zero _ _ _ KB C). ring.
Qed.

Ltac product_known sound :=
  intros KA KB; generalize KA KB; intros [PA LA] [PB LB];
  match goal with |- known _ (if is_zero _ F ?a ?sa || is_zero _ F ?b ?sb then _ else _) (?x * ?y) =>
    generalize (sound (B2R a) x (B2R sa) (B2R b) y (B2R sb));
    unfold Tight.tight_multiply, Sharp.sharp_multiply, AbsoluteBound.multiply, AbsoluteBound.total;
    case_eq (is_zero _ F a sa || is_zero _ F b sb)
  end; intros Zero T; cbv zeta in *; split;
  [ positive_bound
  | intros H; rounded; split; [assumption |];
    destruct (product_with_zero _ _ _ _ _ _ KA KB ltac:(eassumption) Zero) as [V Z];
    match goal with E : B2R (_ _ F _) = _ |- _ => rewrite E, V, Z end;
    unfold Tight.rounding, Sharp.rounding; rewrite Rminus_0_r, Rabs_R0, Rmult_0_l, rnd_0; lra
  | positive_bound
  | intros H; inflated; parts; rounded; split; [assumption |];
    destruct (LA ltac:(assumption)) as [_ HA], (LB ltac:(assumption)) as [_ HB];
    rewrite <- !is_zero_value, Zero in T by assumption;
    values; parts; values; apply T; auto using number_B2R ].
Theorem tight_multiply_known a sa x b sb y : known a sa x -> known b sb y ->
  known (a ⊗ b) (tight_multiply _ F (a ⊗ b) a sa b sb) (x * y).
Proof. unfold tight_multiply. product_known (Tight.tight_multiply_sound_nearest p emin emin_p p_3). Qed.

(** A nonzero divisor: both are finite, and so is its distance from zero. *)
Lemma abs_finite_intro x : finite x -> finite (abs _ F x).
Proof.
  intros X. unfold abs. destruct (less _ F x (integer _ F 0)); auto. simpl. now rewrite is_finite_Bopp.
Qed.
Lemma distance_positive b sb y : known b sb y ->
  less _ F (integer _ F 0) (abs _ F b ⊖ sb) = true ->
  finite b /\ finite sb /\ finite (abs _ F b ⊖ sb) /\ 0 < B2R (abs _ F b ⊖ sb) /\ B2R b <> 0 /\ y <> 0.
Proof.
  intros [P K] C. destruct (BinarySingleNaN.is_finite sb) eqn:FS.
  - destruct (K eq_refl) as [FB HB].
    assert (D : finite (abs _ F b ⊖ sb)).
    { apply minus_nonnegative_finite; auto using abs_finite_intro. now apply nonnegative_abs. }
    apply less_true_0 in C. destruct C as [C | C]; [| rewrite C in D; discriminate].
    destruct (minus_finite _ _ _ _ D) as (FA & _ & ED).
    apply (abs_finite p emax p_3) in FA. destruct FA as [_ EA]. apply nonnegative_value in P.
    assert (L : B2R sb < Rabs (B2R b)).
    { apply Rnot_le_lt. intros L. revert C. values.
      assert (fl (Rabs (B2R b) - B2R sb) <= 0).
      { apply (Format.rnd_below p emin Format.nearest); [apply Format.number_0 | lra]. }
      lra. }
    repeat split; auto.
    + intros Z. rewrite Z, Rabs_R0 in L. lra.
    + intros ->. rewrite Rminus_0_r in HB. lra.
  - exfalso. revert C. generalize (abs _ F b). intros c.
    destruct sb as [| s | |]; try discriminate; simpl in P; subst; destruct c as [| s | |]; try discriminate;
      destruct s; discriminate.
Qed.

(** Zero divided by a number that is not zero. *)
Lemma zero_over a b : finite b -> B2R b <> 0 -> B2R a = 0 -> finite (a ⊘ b) -> B2R (a ⊘ b) = 0.
Proof.
  intros FB NB Z H. apply over_finite in H; auto. destruct H as [_ ->]. rewrite Z.
  unfold Rdiv. rewrite Rmult_0_l. apply rnd_0.
Qed.

Ltac quotient_known sound :=
  intros KA KB; generalize KA KB; intros [PA LA] [PB LB]; cbv zeta;
  match goal with
  | _ : known ?a ?sa ?x, _ : known ?b ?sb ?y |- known (?a ⊘ ?b) (if negb ?far then _ else _) (?x / ?y) /\ _ =>
    generalize (sound (B2R a) x (B2R sa) (B2R b) y (B2R sb)); unfold Tight.tight_divide, Sharp.sharp_divide,
      AbsoluteBound.divide, AbsoluteBound.numerator, AbsoluteBound.total;
    case_eq far
  end; intros Far T; cbn [negb]; [| split; [split; [reflexivity |] |]; discriminate];
  generalize (distance_positive _ _ _ KB Far); intros (FB & FS & FD & D & NB & NY); split; [| auto];
  match goal with |- known _ (if ?zero then _ else _) _ => case_eq zero end; intros Zero; split;
  [ positive_bound
  | intros H; rounded; split; [assumption |]; rewrite (known_zero _ _ _ KA Zero);
    match goal with E : B2R (_ _ F _) = _ |- _ => rewrite E end; apply is_zero_true in Zero;
    rewrite zero_over by (auto; tauto); unfold Tight.rounding, Sharp.rounding, Rdiv;
    rewrite Rmult_0_l, Rminus_0_r, Rabs_R0, Rmult_0_l, rnd_0; lra
  | match goal with |- context [if ?lossy then ?lost else ?none] =>
      assert (nonnegative (if lossy then lost else none)) by (destruct lossy; positive) end;
    positive_bound; apply nonnegative_over; auto; [positive | apply nonnegative_intro; auto; lra | lra]
  | intros H; inflated; destruct (minus_finite _ _ _ _ FD) as (FM & _ & EM);
    apply (abs_finite p emax p_3) in FM; destruct FM as [_ EB];
    match type of D with 0 < B2R ?distance => set (d := distance) in *; clearbody d end;
    parts; rounded; inflated;
    match goal with H : finite (_ ⊘ ?d), D : 0 < B2R ?d |- _ => apply over_finite in H;
      [destruct H | assumption | lra] end;
    parts; inflated; split; [assumption |];
    destruct (LA ltac:(assumption)) as [FA HA], (LB FS) as [_ HB], (zero_value p emax p_3) as [FZ VZ];
    cbv zeta in T; rewrite <- is_zero_value, Zero in T by assumption;
    rewrite Rlt_bool_true in T by (now rewrite EM, EB in D); cbn [negb] in T; parts;
    match goal with H : finite (_ ⊘ _) |- _ => apply over_finite in H; [destruct H | assumption | assumption] end;
    values; rewrite less_finite, VZ in * by assumption;
    match goal with |- context [Rlt_bool 0 ?s] => destruct (Rlt_bool 0 s) end; parts; values; apply T;
      auto using number_B2R ].
Theorem tight_divide_known a sa x b sb y : known a sa x -> known b sb y ->
  known (a ⊘ b) (tight_divide _ F (a ⊘ b) a sa b sb) (x / y) /\
  (finite (tight_divide _ F (a ⊘ b) a sa b sb) -> y <> 0).
Proof. unfold tight_divide. quotient_known (Tight.tight_divide_sound_nearest p emin emin_p p_3). Qed.

(** Scaling for rules whose bound is an error. *)
Lemma scale_down_finite a e : finite a -> (e < 0)%Z -> finite (scale _ F a e).
Proof.
  intros A N. generalize (Bldexp_correct p emax _ _ mode_NE a e). rewrite Rlt_bool_true.
  - intros (_ & H & _). simpl. now rewrite H.
  - apply Rle_lt_trans with (Rabs (B2R a)); [| apply abs_B2R_lt_emax].
    apply (Format.rnd_abs_below p emin Format.nearest); [apply Format.number_abs, number_B2R |].
    rewrite Rabs_mult, (Rabs_pos_eq (bpow _ _)) by apply bpow_ge_0.
    assert (bpow radix2 e <= bpow radix2 0) by (apply bpow_le; lia). simpl in *.
    generalize (Rabs_pos (B2R a)). nra.
Qed.
Lemma scale_equal v a k : finite v -> finite a ->
  equal _ F (scale _ F v k) a = Req_bool (fl (B2R v * bpow radix2 k)) (B2R a).
Proof.
  intros V A. generalize (Bldexp_correct p emax _ _ mode_NE v k). case Rlt_bool_spec; intros C.
  - intros (E & H & _).
    change (fl (B2R v * bpow radix2 k)) with
      (round radix2 (SpecFloat.fexp p emax) (round_mode mode_NE) (B2R v * bpow radix2 k)).
    rewrite <- E. apply equal_finite; auto. simpl. now rewrite H.
  - intros O. rewrite Req_bool_false.
    + simpl. revert O. destruct (Bldexp mode_NE v k); try discriminate.
      destruct a; try easy; simpl; now destruct s.
    + intros E. unfold Format.rnd in E. simpl round_mode in C.
      assert (L := abs_B2R_lt_emax p emax a). rewrite <- E in L.
      apply (Rlt_not_le _ _ L). exact C.
Qed.
Definition scaled (inflate : float -> float) (v a sa : float) (e : Z) : float :=
  let scaled := scale _ F sa e in
  let lossless := (0 <=? e)%Z ||
    (equal _ F (scale _ F v (- e)) a && equal _ F (scale _ F scaled (- e)) sa) in
  if lossless then scaled ⊕ (v ⊖ v) else inflate scaled.
Lemma scaled_known inflate inflate_real :
  (forall s, nonnegative s -> nonnegative (inflate s)) ->
  (forall s, finite (inflate s) -> finite s /\ B2R (inflate s) = inflate_real (B2R s)) ->
  (forall a x sa e, number a -> number sa -> Rabs (a - x) <= sa ->
   Rabs (fl (a * bpow radix2 e) - x * bpow radix2 e) <=
     Format.scaled_error p emin Format.nearest inflate_real (fl (a * bpow radix2 e)) a sa e) ->
  forall a sa x e, known a sa x ->
  known (scale _ F a e) (scaled inflate (scale _ F a e) a sa e) (x * bpow radix2 e).
Proof.
  intros PI HI Sound a sa x e [P K]. unfold scaled. cbv zeta.
  set (v := scale _ F a e). set (s := scale _ F sa e).
  assert (Ps : nonnegative s) by now apply nonnegative_scale.
  split; [destruct (_ || _); [apply nonnegative_plus; auto; now apply nonnegative_nothing | now apply PI] |].
  assert (Given : finite v -> finite s ->
    finite a /\ Rabs (B2R v - x * bpow radix2 e) <= Format.scaled_error p emin Format.nearest
      inflate_real (B2R v) (B2R a) (B2R sa) e /\
    Format.scaled_error p emin Format.nearest inflate_real (B2R v) (B2R a) (B2R sa) e =
      if (0 <=? e)%Z || (equal _ F (scale _ F v (- e)) a && equal _ F (scale _ F s (- e)) sa)
      then fl (B2R s + fl (B2R v - B2R v)) else inflate_real (B2R s)).
  { intros V S. apply scale_finite in V as V', S as S'. destruct V' as [A EV], S' as [SA ES].
    change (B2R v = fl (B2R a * bpow radix2 e)) in EV. change (B2R s = fl (B2R sa * bpow radix2 e)) in ES.
    destruct (K SA) as [_ H]. split; auto. rewrite !scale_equal by auto. rewrite ES, EV.
    split; [apply Sound; auto using number_B2R | reflexivity]. }
  destruct (Z.leb_spec 0 e) as [E | E]; cbn [orb] in *.
  - intros H. parts. destruct (Given ltac:(auto) ltac:(auto)) as (A & L & EL). split; auto.
    rewrite EL in L. values. exact L.
  - destruct (equal _ F (scale _ F v (- e)) a && equal _ F (scale _ F s (- e)) sa) eqn:C.
    + intros H. parts. destruct (Given ltac:(auto) ltac:(auto)) as (A & L & EL). split; auto.
      rewrite EL in L. values. exact L.
    + intros H. apply HI in H. destruct H as [S ES].
      assert (V : finite v).
      { apply scale_down_finite; auto. apply scale_finite in S. now apply K. }
      destruct (Given V S) as (A & L & EL). split; auto. rewrite EL in L. now rewrite ES.
Qed.

Theorem tight_scale_known a sa x e : known a sa x ->
  known (scale _ F a e) (tight_scale _ F (scale _ F a e) a sa e) (x * bpow radix2 e).
Proof.
  apply (scaled_known (fun s => tight_inflated _ F (s ⊕ integer _ F 2 ⊗ underflow_unit _ F))
           (fun s => Tight.inflated p emin Format.nearest (fl (s + fl (2 * Format.eta emin))))).
  - intros s P. positive.
  - intros s H. apply tight_inflated_finite in H. destruct H as [H E]. parts. split; auto.
    rewrite E. now values.
  - apply Tight.tight_scale_sound_nearest; auto. apply emin_p.
Qed.

(** Negation for rules without a separate one: the same bound (tracked.hpp). *)
Theorem tight_negate_known a s x : known a s x -> known (opposite _ F a) s (- x).
Proof.
  intros [P K]. split; auto. intros H. destruct (K H) as [A B]. split.
  - simpl. now rewrite is_finite_Bopp.
  - rewrite opposite_value. replace (- B2R a - - x) with (- (B2R a - x)) by ring. now rewrite Rabs_Ropp.
Qed.

(** The rule sharp. *)
Theorem sharp_add_known a sa x b sb y : known a sa x -> known b sb y ->
  known (a ⊕ b) (sharp_add _ F (a ⊕ b) sa sb) (x + y).
Proof. sum_known sharp_sum_bounded Sharp.sharp_sum_error. Qed.
Theorem sharp_subtract_known a sa x b sb y : known a sa x -> known b sb y ->
  known (a ⊖ b) (sharp_add _ F (a ⊖ b) sa sb) (x - y).
Proof. sum_known sharp_sum_bounded Sharp.sharp_difference_error. Qed.
Theorem sharp_multiply_known a sa x b sb y : known a sa x -> known b sb y ->
  known (a ⊗ b) (sharp_multiply _ F (a ⊗ b) a sa b sb) (x * y).
Proof. unfold sharp_multiply. product_known (Sharp.sharp_multiply_sound p emin p_3 emin_p). Qed.
Theorem sharp_divide_known a sa x b sb y : known a sa x -> known b sb y ->
  known (a ⊘ b) (sharp_divide _ F (a ⊘ b) a sa b sb) (x / y) /\
  (finite (sharp_divide _ F (a ⊘ b) a sa b sb) -> y <> 0).
Proof. unfold sharp_divide. quotient_known (Sharp.sharp_divide_sound p emin p_3 emin_p). Qed.
Theorem sharp_scale_known a sa x e : known a sa x ->
  known (scale _ F a e) (sharp_scale _ F (scale _ F a e) a sa e) (x * bpow radix2 e).
Proof.
  apply (scaled_known (fun s => sharp_inflated _ F (s ⊕ underflow_unit _ F))
           (fun s => Sharp.inflated p emin (fl (s + Format.eta emin)))).
  - intros s P. positive.
  - intros s H. apply sharp_inflated_finite in H. destruct H as [H E]. parts. split; auto.
    rewrite E. now values.
  - apply Sharp.sharp_scale_sound; auto. apply emin_p.
Qed.

(** The default sign. *)
Theorem sign_of_known a s x : known a s x ->
  match sign_of _ F a s with
  | negative => x < 0
  | zero => x = 0
  | positive => 0 < x
  | uncertain => True
  end.
Proof.
  destruct (zero_value p emax p_3) as [Z0 Z]. intros [P K]. unfold sign_of.
  destruct (BinarySingleNaN.is_finite s) eqn:S.
  - destruct (K eq_refl) as [A H]. apply Rabs_le_inv in H.
    assert (N : finite (opposite _ F s)) by (simpl; now rewrite is_finite_Bopp).
    rewrite !less_finite, !equal_finite, (opposite_value p emax s), Z by auto.
    destruct (Rlt_bool_spec (B2R s) (B2R a)); [lra |].
    destruct (Rlt_bool_spec (B2R a) (- B2R s)); [lra |].
    destruct (Req_bool_spec (B2R a) 0), (Req_bool_spec (B2R s) 0); simpl; auto. lra.
  - destruct s as [| t | |]; try discriminate.
    + simpl in P. subst t. destruct a as [| t | | t m e b]; try easy; now destruct t.
    + destruct a as [| t | | t m e b]; try easy; now destruct t.
Qed.

(** The rule none returns zero for (1 + eta) - 1, which is positive. *)
Theorem none_guesses : let one := integer _ F 1 in let eta := underflow_unit _ F in
  let v := one ⊕ eta ⊖ one in
  B2R one = 1 /\ B2R eta = Format.eta emin /\ sign_of _ F v (none_error _ F v) = zero.
Proof.
  destruct (integer_value p emax p_3 1 ltac:(lia)) as [F1 V1].
  destruct (eta_value p emax p_3) as [Fe Ve]. destruct (zero_value p emax p_3) as [Z0 Z].
  cbv zeta. split; auto. split; auto.
  assert (S : finite (integer _ F 1 ⊕ underflow_unit _ F) /\ B2R (integer _ F 1 ⊕ underflow_unit _ F) = 1).
  { generalize (Bplus_correct p emax _ _ mode_NE _ _ F1 Fe). rewrite V1, Ve.
    change (round radix2 (SpecFloat.fexp p emax) (round_mode mode_NE) (1 + Format.eta emin))
      with (fl (1 + Format.eta emin)).
    rewrite (Format.eta_lost p emin) by (generalize (p_emax p emax); lia). rewrite Rabs_R1.
    rewrite Rlt_bool_true; [now intros (E & H & _) |].
    change 1 with (bpow radix2 0). apply bpow_lt. generalize (p_emax p emax). lia. }
  destruct S as [FS VS].
  assert (D : finite (integer _ F 1 ⊕ underflow_unit _ F ⊖ integer _ F 1) /\
              B2R (integer _ F 1 ⊕ underflow_unit _ F ⊖ integer _ F 1) = 0).
  { generalize (Bminus_correct p emax _ _ mode_NE _ _ FS F1). rewrite VS, V1, Rminus_eq_0, round_0.
    - rewrite Rabs_R0, Rlt_bool_true by apply bpow_gt_0. now intros (E & H & _).
    - auto with typeclass_instances. }
  destruct D as [FD VD]. set (v := _ ⊖ _) in *. clearbody v.
  assert (E : none_error _ F v = integer _ F 0).
  { unfold none_error, is_finite. replace (at_most _ F (abs _ F v) (largest _ F)) with true; auto.
    symmetry. rewrite at_most_finite; auto using abs_finite_intro.
    destruct (abs_finite p emax p_3 _ (abs_finite_intro v FD)) as [_ ->]. rewrite VD, Rabs_R0.
    apply Rle_bool_true. apply (nonnegative_value p emax). reflexivity. }
  rewrite E. unfold sign_of. rewrite !less_finite, !equal_finite, opposite_value, VD, Z by
    (auto; simpl; now rewrite ?is_finite_Bopp).
  rewrite Rlt_bool_false, Rlt_bool_false, Req_bool_true by lra. reflexivity.
Qed.
End Rules.
