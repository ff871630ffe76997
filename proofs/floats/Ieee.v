(** IEEE formats, with a largest number, infinities and NaN, rounded to nearest, ties to even: those of Flocq as an
    `arithmetic` for the code of Code.v.

    plus_finite and similar: a finite result has finite operands and is the rounded exact one. So if the code's
    result is finite, nothing before overflowed, and the code computed the definitions over real numbers (Tight.v,
    ...). `nonnegative` means not below zero, but possibly infinite or NaN. *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code.
From Errbound Require Format.
Open Scope R_scope.

Notation finite x := (BinarySingleNaN.is_finite x = true).

Section Ieee.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax}.
Notation float := (binary_float p emax).

(** n 2^e, rounded. *)
Definition constant (n e : Z) : float := binary_normalize p emax p_positive p_below mode_NE n e false.

(** number_traits of such a format, and its operations. *)
Definition floats : arithmetic float := {|
  plus := Bplus mode_NE;
  minus := Bminus mode_NE;
  times := Bmult mode_NE;
  over := Bdiv mode_NE;
  fma := Bfma mode_NE;
  root := Bsqrt mode_NE;
  opposite := Bopp;
  less := Bltb;
  at_most := Bleb;
  equal := Beqb;
  scale := Bldexp mode_NE;
  integer n := constant n 0;
  five_quarters := constant 5 (-2);
  digits := p;
  epsilon := constant 1 (1 - p);
  unit_roundoff := constant 1 (- p);
  underflow_unit := constant 1 (3 - emax - p);
  smallest_normal := constant 1 (2 - emax);
  largest := Bmax_float;
  infinity := B754_infinity false
|}.
(** The e with 1/2 <= |x| / 2^e < 1. *)
Definition exponent (x : float) : Z := snd (Bfrexp x).

Notation emin := (3 - emax - p)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation number := (Format.number p emin).

Lemma number_B2R (x : float) : number (B2R x).
Proof. apply (generic_format_B2R p emax x). Qed.

(** A finite result has finite operands and is the rounded exact one. *)
Lemma plus_finite x y : finite (plus _ floats x y) ->
  finite x /\ finite y /\ B2R (plus _ floats x y) = fl (B2R x + B2R y).
Proof.
  intros H. assert (F : finite x /\ finite y).
  { revert H. destruct x as [s | s | | s m e b], y as [t | t | | t n f c]; simpl; auto;
      destruct (Bool.eqb s t); discriminate. }
  destruct F as [X Y]. repeat split; auto.
  generalize (Bplus_correct p emax _ _ mode_NE x y X Y). case Rlt_bool; [tauto |].
  intros [O _]. exfalso. revert H O. simpl. destruct (Bplus mode_NE x y); discriminate.
Qed.
Lemma minus_finite x y : finite (minus _ floats x y) ->
  finite x /\ finite y /\ B2R (minus _ floats x y) = fl (B2R x - B2R y).
Proof.
  replace (minus _ floats x y) with (plus _ floats x (Bopp y)) by now destruct x, y.
  intros H. apply plus_finite in H. now rewrite is_finite_Bopp, B2R_Bopp in H.
Qed.
Lemma times_finite x y : finite (times _ floats x y) ->
  finite x /\ finite y /\ B2R (times _ floats x y) = fl (B2R x * B2R y).
Proof.
  intros H. generalize (Bmult_correct p emax _ _ mode_NE x y). case Rlt_bool.
  - intros (E & F & _). simpl in H. rewrite F in H. apply andb_prop in H. tauto.
  - intros O. exfalso. revert H O. simpl. destruct (Bmult mode_NE x y); discriminate.
Qed.
Lemma over_finite x y : finite y -> B2R y <> 0 -> finite (over _ floats x y) ->
  finite x /\ B2R (over _ floats x y) = fl (B2R x / B2R y).
Proof.
  intros Y N H. generalize (Bdiv_correct p emax _ _ mode_NE x y N). case Rlt_bool.
  - intros (E & F & _). simpl in H. rewrite F in H. tauto.
  - intros O. exfalso. revert H O. simpl. destruct (Bdiv mode_NE x y); discriminate.
Qed.
Lemma fma_finite x y z : finite (fma _ floats x y z) ->
  finite x /\ finite y /\ finite z /\ B2R (fma _ floats x y z) = fl (B2R x * B2R y + B2R z).
Proof.
  intros H. assert (F : finite x /\ finite y /\ finite z).
  { revert H. destruct x as [s | s | | s m e b], y as [t | t | | t n f c], z as [w | w | | w o g d];
      simpl; auto; try destruct (Bool.eqb _ _); try discriminate. }
  destruct F as (X & Y & Z). repeat split; auto.
  generalize (Bfma_correct p emax _ _ mode_NE x y z X Y Z). cbv zeta. case Rlt_bool; [tauto |].
  intros O. exfalso. revert H O. unfold fma, floats. destruct (Bfma mode_NE x y z); discriminate.
Qed.
Lemma root_finite x : finite (root _ floats x) ->
  finite x /\ 0 <= B2R x /\ B2R (root _ floats x) = fl (sqrt (B2R x)).
Proof.
  generalize (Bsqrt_correct p emax _ _ mode_NE x). intros (E & F & _) H. simpl in H. rewrite F in H.
  destruct x as [s | s | | s m e b]; try discriminate; repeat split; auto; simpl; [lra |].
  destruct s; [discriminate |]. apply F2R_ge_0. simpl. lia.
Qed.
Lemma root_of_nonnegative x : finite x -> 0 <= B2R x -> finite (root _ floats x).
Proof.
  generalize (Bsqrt_correct p emax _ _ mode_NE x). intros (_ & F & _) H P. simpl. rewrite F.
  destruct x as [s | s | | s m e b]; try easy. destruct s; auto. exfalso. revert P. apply Rlt_not_le.
  apply F2R_lt_0. simpl. lia.
Qed.
Lemma scale_finite x e : finite (scale _ floats x e) ->
  finite x /\ B2R (scale _ floats x e) = fl (B2R x * bpow radix2 e).
Proof.
  intros H. generalize (Bldexp_correct p emax _ _ mode_NE x e). case Rlt_bool.
  - intros (E & F & _). simpl in H. rewrite F in H. tauto.
  - intros O. exfalso. revert H O. simpl. destruct (Bldexp mode_NE x e); discriminate.
Qed.
Lemma opposite_finite x : finite (opposite _ floats x) -> finite x.
Proof. simpl. now rewrite is_finite_Bopp. Qed.
Lemma opposite_value x : B2R (opposite _ floats x) = - B2R x.
Proof. apply B2R_Bopp. Qed.

Lemma less_finite x y : finite x -> finite y -> less _ floats x y = Rlt_bool (B2R x) (B2R y).
Proof. apply Bltb_correct. Qed.
Lemma at_most_finite x y : finite x -> finite y -> at_most _ floats x y = Rle_bool (B2R x) (B2R y).
Proof. apply Bleb_correct. Qed.
Lemma equal_finite x y : finite x -> finite y -> equal _ floats x y = Req_bool (B2R x) (B2R y).
Proof. apply Beqb_correct. Qed.

(** Constants. *)
Lemma constant_value n e :
  number (IZR n * bpow radix2 e) -> Rabs (IZR n * bpow radix2 e) < bpow radix2 emax ->
  finite (constant n e) /\ B2R (constant n e) = IZR n * bpow radix2 e.
Proof.
  intros N B. generalize (binary_normalize_correct p emax _ _ mode_NE n e false). cbv zeta.
  change (F2R (Float radix2 n e)) with (IZR n * bpow radix2 e).
  rewrite round_generic; auto with typeclass_instances. rewrite Rlt_bool_true by auto. tauto.
Qed.

Hypothesis p_3 : (3 <= p)%Z.
Lemma p_emax : (p < emax)%Z.
Proof. exact p_below. Qed.
Lemma emin_p : (emin <= - p)%Z.
Proof. generalize p_emax. lia. Qed.

Lemma integer_value n : (Z.abs n <= 8)%Z -> finite (integer _ floats n) /\ B2R (integer _ floats n) = IZR n.
Proof.
  intros H. generalize (constant_value n 0). change (bpow radix2 0) with 1. rewrite Rmult_1_r.
  intros C. generalize p_emax. intros L. apply C.
  - rewrite <- (Rmult_1_r (IZR n)). change 1 with (bpow radix2 0).
    apply Format.number_integer; auto.
    + lia.
    + apply Z.le_trans with (1 := H). apply (Z.pow_le_mono_r 2 3); lia.
  - rewrite <- abs_IZR. apply Rle_lt_trans with (bpow radix2 3).
    + simpl. now apply IZR_le.
    + apply bpow_lt. lia.
Qed.
Lemma power_value e : (emin <= e < emax)%Z ->
  finite (constant 1 e) /\ B2R (constant 1 e) = bpow radix2 e.
Proof.
  intros H. generalize (constant_value 1 e). rewrite Rmult_1_l. intros C. apply C.
  - apply Format.number_power; auto. lia.
  - rewrite Rabs_pos_eq by apply bpow_ge_0. apply bpow_lt. lia.
Qed.
Lemma zero_value : finite (integer _ floats 0) /\ B2R (integer _ floats 0) = 0.
Proof. now apply (integer_value 0). Qed.
Lemma eps_value : finite (epsilon _ floats) /\ B2R (epsilon _ floats) = Format.eps p.
Proof. apply power_value. generalize p_emax. lia. Qed.
Lemma u_value : finite (unit_roundoff _ floats) /\ B2R (unit_roundoff _ floats) = Format.u p.
Proof. apply power_value. generalize p_emax. lia. Qed.
Lemma eta_value : finite (underflow_unit _ floats) /\ B2R (underflow_unit _ floats) = Format.eta emin.
Proof. apply power_value. generalize p_emax. lia. Qed.
Lemma smallest_normal_value : finite (smallest_normal _ floats) /\
  B2R (smallest_normal _ floats) = Format.smallest_normal p emin.
Proof.
  unfold Format.smallest_normal. replace (emin + p - 1)%Z with (2 - emax)%Z by lia.
  apply power_value. generalize p_emax. lia.
Qed.

Lemma abs_finite x : finite (abs _ floats x) -> finite x /\ B2R (abs _ floats x) = Rabs (B2R x).
Proof.
  destruct zero_value as [Z0 Z]. unfold abs. intros H. assert (F : finite x).
  { revert H. case less; auto. apply opposite_finite. }
  split; auto. rewrite (less_finite x _ F Z0), Z. case Rlt_bool_spec; intros.
  - rewrite opposite_value, Rabs_left; auto.
  - now rewrite Rabs_pos_eq.
Qed.

(** Not below zero, but possibly +infinity or NaN. *)
Definition nonnegative (x : float) : Prop :=
  match x with
  | B754_zero _ | B754_nan => True
  | B754_infinity s | B754_finite s _ _ _ => s = false
  end.
Lemma nonnegative_value x : nonnegative x -> 0 <= B2R x.
Proof.
  destruct x as [| | | s m e b]; simpl; try lra. intros ->. apply F2R_ge_0. simpl. lia.
Qed.
Lemma nonnegative_intro x : finite x -> 0 <= B2R x -> nonnegative x.
Proof.
  destruct x as [| | | s m e b]; simpl; try easy. intros _. destruct s; auto. intros H. exfalso.
  assert (F2R (Float radix2 (Zneg m) e) < 0) by (apply F2R_lt_0; simpl; lia).
  unfold F2R in *. simpl in *. lra.
Qed.
Lemma nonnegative_sign x : nonnegative x -> B2R x <> 0 -> Bsign x = false.
Proof. destruct x; simpl; tauto. Qed.
Lemma nonnegative_overflow x s : B2SF x = binary_overflow p emax mode_NE s -> s = false -> nonnegative x.
Proof. intros H ->. destruct x; simpl in *; try easy. now injection H as ->. Qed.

Lemma nonnegative_plus x y : nonnegative x -> nonnegative y -> nonnegative (plus _ floats x y).
Proof.
  intros X Y. destruct (BinarySingleNaN.is_finite x) eqn:FX.
  - destruct (BinarySingleNaN.is_finite y) eqn:FY.
    + generalize (Bplus_correct p emax _ _ mode_NE x y FX FY).
      generalize (nonnegative_value x X) (nonnegative_value y Y). intros PX PY.
      case Rlt_bool_spec; intros C.
      * intros (E & F & _). apply nonnegative_intro; auto. simpl. rewrite E.
        apply (Format.rnd_nonnegative p emin Format.nearest). lra.
      * intros [O S]. apply (nonnegative_overflow _ _ O).
        destruct (Req_dec (B2R x) 0) as [X0 | X0]; [| now apply nonnegative_sign].
        rewrite S. apply nonnegative_sign; auto. intros Y0.
        rewrite X0, Y0, Rplus_0_r, round_0, Rabs_R0 in C; auto with typeclass_instances.
        generalize (bpow_gt_0 radix2 emax). lra.
    + destruct x, y; simpl in *; try easy; try discriminate.
  - destruct x as [| s | |], y as [| t | |]; simpl in *; try easy; subst; easy.
Qed.
Lemma nonnegative_times x y : nonnegative x -> nonnegative y -> nonnegative (times _ floats x y).
Proof.
  intros X Y. generalize (Bmult_correct p emax _ _ mode_NE x y).
  generalize (nonnegative_value x X) (nonnegative_value y Y). intros PX PY.
  case Rlt_bool_spec; intros C.
  - intros (E & F & _).
    destruct (BinarySingleNaN.is_finite x) eqn:FX, (BinarySingleNaN.is_finite y) eqn:FY;
      try (destruct x, y; simpl in *; subst; easy).
    apply nonnegative_intro; auto. simpl. rewrite E.
    apply (Format.rnd_nonnegative p emin Format.nearest). now apply Rmult_le_pos.
  - intros O. apply (nonnegative_overflow _ _ O).
    assert (N : B2R x * B2R y <> 0).
    { intros Z. rewrite Z, round_0, Rabs_R0 in C; auto with typeclass_instances.
      generalize (bpow_gt_0 radix2 emax). lra. }
    rewrite (nonnegative_sign x), (nonnegative_sign y); auto; intros Z; apply N; rewrite Z; ring.
Qed.
Lemma nonnegative_over x y : nonnegative x -> nonnegative y -> B2R y <> 0 ->
  nonnegative (over _ floats x y).
Proof.
  intros X Y N. generalize (Bdiv_correct p emax _ _ mode_NE x y N).
  generalize (nonnegative_value x X) (nonnegative_value y Y). intros PX PY.
  case Rlt_bool_spec; intros C.
  - intros (E & F & _). destruct (BinarySingleNaN.is_finite x) eqn:FX.
    + apply nonnegative_intro; auto. simpl. rewrite E.
      apply (Format.rnd_nonnegative p emin Format.nearest). apply Rmult_le_pos; auto.
      apply Rlt_le, Rinv_0_lt_compat. lra.
    + destruct x, y; simpl in *; subst; easy.
  - intros O. apply (nonnegative_overflow _ _ O).
    rewrite (nonnegative_sign y), (nonnegative_sign x); auto.
    intros Z. unfold Rdiv in C. rewrite Z, Rmult_0_l, round_0, Rabs_R0 in C; auto with typeclass_instances.
    generalize (bpow_gt_0 radix2 emax). lra.
Qed.
Lemma nonnegative_scale x e : nonnegative x -> nonnegative (scale _ floats x e).
Proof.
  intros X. generalize (Bldexp_correct p emax _ _ mode_NE x e) (nonnegative_value x X). intros H PX.
  revert H. case Rlt_bool_spec; intros C.
  - intros (E & F & _). destruct (BinarySingleNaN.is_finite x) eqn:FX.
    + apply nonnegative_intro; auto. simpl. rewrite E.
      apply (Format.rnd_nonnegative p emin Format.nearest). apply Rmult_le_pos; auto. apply bpow_ge_0.
    + destruct x; simpl in *; subst; easy.
  - intros O. apply (nonnegative_overflow _ _ O). apply nonnegative_sign; auto.
    intros Z. rewrite Z, Rmult_0_l, round_0, Rabs_R0 in C; auto with typeclass_instances.
    generalize (bpow_gt_0 radix2 emax). lra.
Qed.
Lemma nonnegative_abs x : nonnegative (abs _ floats x).
Proof.
  unfold abs. destruct (less _ floats x (integer _ floats 0)) eqn:C;
    destruct x as [| s | | s m e b]; simpl in *; auto; destruct s; auto; discriminate.
Qed.
Lemma nonnegative_integer n : (0 <= n <= 8)%Z -> nonnegative (integer _ floats n).
Proof.
  intros H. destruct (integer_value n) as [F V]; [lia |].
  apply nonnegative_intro; auto. rewrite V. now apply IZR_le.
Qed.
Lemma nonnegative_eps : nonnegative (epsilon _ floats).
Proof.
  destruct eps_value as [F V]. apply nonnegative_intro; auto. rewrite V. apply bpow_ge_0.
Qed.
Lemma nonnegative_u : nonnegative (unit_roundoff _ floats).
Proof. destruct u_value as [F V]. apply nonnegative_intro; auto. rewrite V. apply bpow_ge_0. Qed.
Lemma nonnegative_eta : nonnegative (underflow_unit _ floats).
Proof. destruct eta_value as [F V]. apply nonnegative_intro; auto. rewrite V. apply bpow_ge_0. Qed.
Lemma nonnegative_nothing x : nonnegative (minus _ floats x x).
Proof.
  destruct (BinarySingleNaN.is_finite x) eqn:F.
  - generalize (Bminus_correct p emax _ _ mode_NE x x F F).
    replace (B2R x - B2R x) with 0 by ring. rewrite round_0, Rabs_R0; auto with typeclass_instances.
    rewrite Rlt_bool_true by apply bpow_gt_0. intros (E & G & _).
    apply nonnegative_intro; auto. simpl. rewrite E. lra.
  - destruct x as [| s | |]; simpl in *; try easy. now destruct s.
Qed.
End Ieee.

Infix "⊕" := (plus _ (floats _ _)) (at level 50, left associativity).
Infix "⊖" := (minus _ (floats _ _)) (at level 50, left associativity).
Infix "⊗" := (times _ (floats _ _)) (at level 40, left associativity).
Infix "⊘" := (over _ (floats _ _)) (at level 40, left associativity).

(** Splits finite results into finite operands and the value. *)
Ltac finite_parts p emax p_3 := repeat match goal with
  | H : BinarySingleNaN.is_finite (plus _ (floats p emax) _ _) = true |- _ =>
      apply plus_finite in H; destruct H as (? & ? & ?)
  | H : BinarySingleNaN.is_finite (minus _ (floats p emax) _ _) = true |- _ =>
      apply minus_finite in H; destruct H as (? & ? & ?)
  | H : BinarySingleNaN.is_finite (times _ (floats p emax) _ _) = true |- _ =>
      apply times_finite in H; destruct H as (? & ? & ?)
  | H : BinarySingleNaN.is_finite (abs _ _ _) = true |- _ =>
      apply (abs_finite p emax p_3) in H; destruct H as (? & ?)
  end.
(** Rewrites with the values of constants and with known equations. *)
Ltac known_values p emax p_3 := repeat match goal with
  | |- context [B2R (integer _ _ ?n)] => rewrite (proj2 (integer_value p emax p_3 n ltac:(lia)))
  | |- context [B2R (epsilon _ _)] => rewrite (proj2 (eps_value p emax p_3))
  | |- context [B2R (unit_roundoff _ _)] => rewrite (proj2 (u_value p emax p_3))
  | |- context [B2R (underflow_unit _ _)] => rewrite (proj2 (eta_value p emax p_3))
  | E : B2R ?x = _ |- context [B2R ?x] => rewrite E
  end.
(** Sums and products of nonnegative numbers are nonnegative. *)
Ltac positive := repeat first
  [ apply nonnegative_plus | apply nonnegative_times
  | apply nonnegative_abs; assumption | apply nonnegative_eps; assumption
  | apply nonnegative_u; assumption | apply nonnegative_eta; assumption
  | apply nonnegative_integer; [assumption | lia] | apply nonnegative_nothing; assumption
  | assumption ].
