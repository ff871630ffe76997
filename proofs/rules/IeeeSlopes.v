(** Square roots, and ab + c rounded once, under rules with first-order errors and under `interval`: the definitions
    of SlopeCode.v over IEEE formats (Ieee.v), to nearest, including overflow; p >= 3, emax > p. Results:
        root_remainder_exact       over real numbers, x - v^2 is a number of the format
        remainder_of_root_known    if the code reports so, the remainder x - v^2 of v = fl(sqrt x) is exact
        sqrt_by_slope_known, fma_by_slope_known    for every rule that keeps its operations (IeeeCompound.v)
        slope_sqrt_known, slope_fma_known    so returned bounds of functions of known numbers hold
        residual_sqrt_known, residual_fma_known    in particular for the rule `residual`
        interval_square_root_known, interval_fused_known, interval_sqrt_known, interval_fma_known    for `interval`
        affine_slope_sqrt_gives, affine_slope_fma_gives    for `affine`, with a source for each operation, from p = 4
                                                           on (IeeeAffineFunctions.v) *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool List.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code CompoundCode AffineCode NumberedCode SlopeCode Ieee IeeeRules IeeeFunctions IeeeCompound
  IeeeAffine IeeeAffineFunctions.
From Errbound Require Format ErrorFree IeeeInterval IeeeResidual Affine.
Import ListNotations.
Open Scope R_scope.

(** Over real numbers. *)
Section Remainder.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (p_3 : (3 <= p)%Z).
Notation fl := (Format.rnd p emin Format.nearest).
Notation number := (Format.number p emin).
Notation cexp := (cexp radix2 (FLT_exp emin p)).

Lemma root_error a : 0 <= a -> let q := fl (sqrt a) in 0 < q -> bpow radix2 (emin + 2 * p - 1) <= q * q ->
  (emin <= 0)%Z ->
  Rabs (a - q * q) <= q * bpow radix2 (cexp q) + bpow radix2 (cexp q) * bpow radix2 (cexp q) / 4 /\
  Rabs (a - q * q) <= q * q / 2.
Proof.
  intros A q Q F E0.
  assert (Nq : number q) by (apply Format.rnd_number; auto with typeclass_instances).
  assert (E : Rabs (sqrt a - q) <= bpow radix2 (cexp q) / 2).
  { rewrite Rabs_minus_sym. rewrite <- (ulp_neq_0 radix2 (FLT_exp emin p) q) by lra.
    generalize (error_le_half_ulp_round radix2 (FLT_exp emin p) (fun n => negb (Z.even n)) (sqrt a)).
    unfold q, Format.rnd. lra. }
  set (w := bpow radix2 (cexp q)) in *. assert (W : 0 < w) by apply bpow_gt_0.
  assert (N : bpow radix2 (emin + p - 1) <= q).
  { apply Rsqr_incr_0_var; [| lra]. unfold Rsqr. apply Rle_trans with (2 := F). rewrite <- bpow_plus.
    apply bpow_le. lia. }
  assert (U : 4 * w <= q).
  { destruct (ErrorFree.cexp_form p emin q Nq) as (m & Eq & L). fold w in Eq.
    assert (M : (2 ^ (p - 1) <= m)%Z).
    { apply le_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
      apply Rmult_le_reg_r with w; auto. rewrite <- Eq. unfold w. rewrite <- bpow_plus.
      unfold Core.Generic_fmt.cexp, FLT_exp. rewrite Zmax_left.
      - replace (p - 1 + (mag radix2 q - p))%Z with (mag radix2 q - 1)%Z by lia.
        destruct (mag radix2 q) as [e He]. simpl. rewrite Rabs_pos_eq in He by lra. apply He. lra.
      - assert (emin + p - 1 < mag radix2 q)%Z; [| lia]. apply (lt_bpow radix2).
        apply Rle_lt_trans with (1 := N). generalize (bpow_mag_gt radix2 q). rewrite Rabs_pos_eq; lra. }
    rewrite Eq. apply Rmult_le_compat_r; [lra |]. apply IZR_le.
    apply Z.le_trans with (2 := M). change 4%Z with (2 ^ 2)%Z. apply Z.pow_le_mono_r; lia. }
  apply Rabs_le_inv in E. set (d := sqrt a - q) in *.
  assert (D : a - q * q = d * (2 * q + d)).
  { unfold d. rewrite <- (sqrt_sqrt a A) at 1. ring. }
  rewrite D. clear D. clearbody d w.
  assert (P : 0 < 2 * q + d) by lra.
  rewrite Rabs_mult, (Rabs_pos_eq (2 * q + d)) by lra.
  assert (L : Rabs d <= w / 2) by (apply Rabs_le; lra).
  assert (H : Rabs d * (2 * q + d) <= w / 2 * (2 * q + w / 2)).
  { apply Rmult_le_compat; [apply Rabs_pos | lra | exact L |]. lra. }
  split; nra.
Qed.

Theorem root_remainder_exact a product : number a -> 0 <= a -> (emin <= 0)%Z ->
  let q := fl (sqrt a) in
  fst product = fl (q * q) -> fst product + snd product = q * q ->
  q <> 0 -> ErrorFree.product_error_is_exact p emin q q product ->
  fl (fl (a - fst product) - snd product) = a - q * q /\ fl (a - fst product) = a - fst product /\
  Rabs (a - q * q) <= q * q / 2.
Proof.
  intros A A0 E0 q V E Q C.
  assert (Q0 : 0 < q).
  { assert (0 <= q) by (apply (Format.rnd_nonnegative p emin Format.nearest), sqrt_pos). lra. }
  destruct product as [v e]. cbn [fst snd] in *. subst v.
  assert (F : q * q = 0 \/ bpow radix2 (emin + 2 * p - 1) <= Rabs (q * q))
    by (apply ErrorFree.far_from_underflow with e; auto; lia).
  destruct F as [F | F]; [apply Rmult_integral in F; tauto |].
  assert (P0 : 0 < q * q) by nra.
  assert (F' := F). rewrite Rabs_pos_eq in F' by lra.
  destruct (root_error a A0 Q0 F' E0) as [E1 E2]. fold q in E1, E2.
  assert (D : fl (a - fl (q * q)) = a - fl (q * q)).
  { apply ErrorFree.difference_is_number; auto; try lia.
    - apply Rle_trans with (2 := F). apply bpow_le. lia.
    - now rewrite (Rabs_pos_eq (q * q)) by lra. }
  split; [| auto]. rewrite D. replace (a - fl (q * q) - e) with (a - q * q) by lra.
  apply Format.rnd_exact; auto with typeclass_instances.
  assert (Nq : number q) by (apply Format.rnd_number; auto with typeclass_instances).
  destruct (ErrorFree.cexp_form p emin a A) as (ma & Fa & La), (ErrorFree.cexp_form p emin q Nq) as (mq & Fq & Lq).
  assert (Ea : (emin <= cexp a)%Z) by (unfold Core.Generic_fmt.cexp, FLT_exp; lia).
  set (ea := cexp a) in *. set (eq := cexp q) in *.
  assert (Eqq : (emin <= eq + eq)%Z).
  { assert (emin + 2 * p - 1 < p + eq + (p + eq))%Z; [| lia]. apply (lt_bpow radix2).
    apply Rle_lt_trans with (1 := F). rewrite Rabs_mult, bpow_plus. apply Rmult_le_0_lt_compat; auto using Rabs_pos. }
  assert (Pq : IZR (2 ^ p) = bpow radix2 p) by (change 2%Z with (radix_val radix2); apply IZR_Zpower; lia).
  destruct (Z_le_gt_dec ea (eq + eq)) as [L | L].
  - assert (R : a - q * q = IZR (ma - mq * mq * 2 ^ (eq + eq - ea)) * bpow radix2 ea).
    { rewrite minus_IZR, !mult_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
      rewrite Fa at 1. rewrite Fq at 1 2.
      assert (X : bpow radix2 (eq + eq - ea) * bpow radix2 ea = bpow radix2 eq * bpow radix2 eq)
        by (rewrite <- !bpow_plus; f_equal; lia).
      rewrite Rmult_minus_distr_r, (Rmult_assoc (IZR mq * IZR mq)), X. ring. }
    rewrite R. apply Format.number_integer; auto. apply le_IZR. rewrite abs_IZR, Pq.
    apply Rmult_le_reg_r with (bpow radix2 ea); [apply bpow_gt_0 |].
    rewrite <- (Rabs_pos_eq (bpow radix2 ea)) at 1 by apply bpow_ge_0. rewrite <- Rabs_mult, <- R, <- bpow_plus.
    apply Rle_trans with (Rabs a); [| lra]. rewrite (Rabs_pos_eq a) by lra. apply Rabs_le_inv in E2. apply Rabs_le. lra.
  - assert (R : a - q * q = IZR (ma * 2 ^ (ea - (eq + eq)) - mq * mq) * bpow radix2 (eq + eq)).
    { rewrite minus_IZR, !mult_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
      rewrite Fa at 1. rewrite Fq at 1 2. rewrite Rmult_minus_distr_r, (Rmult_assoc (IZR ma)), <- bpow_plus.
      replace (ea - (eq + eq) + (eq + eq))%Z with ea by lia. rewrite (bpow_plus radix2 eq eq). ring. }
    rewrite R. apply Format.number_integer; auto.
    set (k := (ma * 2 ^ (ea - (eq + eq)) - mq * mq)%Z) in *.
    assert (W : 0 < bpow radix2 eq) by apply bpow_gt_0.
    assert (M : (Z.abs k <= Z.abs mq)%Z).
    { apply Z.lt_succ_r, lt_IZR. rewrite succ_IZR, !abs_IZR.
      apply Rmult_lt_reg_r with (bpow radix2 eq * bpow radix2 eq); [nra |].
      assert (R1 : Rabs (IZR k) * (bpow radix2 eq * bpow radix2 eq) = Rabs (a - q * q)).
      { rewrite R, Rabs_mult, (Rabs_pos_eq (bpow radix2 (eq + eq))), bpow_plus by apply bpow_ge_0. ring. }
      assert (R2 : Rabs (IZR mq) * bpow radix2 eq = q).
      { rewrite <- (Rabs_pos_eq (bpow radix2 eq)) by lra. rewrite <- Rabs_mult, <- Fq. apply Rabs_pos_eq. lra. }
      rewrite R1, Rmult_plus_distr_r, <- (Rmult_assoc (Rabs (IZR mq))), R2. nra. }
    apply Z.le_trans with (1 := M), le_IZR. rewrite abs_IZR, Pq.
    apply Rmult_le_reg_r with (bpow radix2 eq); auto.
    rewrite <- (Rabs_pos_eq (bpow radix2 eq)) at 1 by lra. rewrite <- Rabs_mult, <- Fq, <- bpow_plus. lra.
Qed.

End Remainder.

Section Slopes.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_3 : (3 <= p)%Z).
Variable fused : bool.  (* has_fast_fma *)
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation known := (known p emax).

Lemma code_finite (x : float) : Code.is_finite _ F x = true -> finite x.
Proof. unfold Code.is_finite, Code.abs. destruct x as [| [|] | | [|]]; simpl; auto; discriminate. Qed.

Theorem remainder_of_root_known x v : finite v -> v = root _ F x ->
  snd (remainder_of_root _ F fused x v) = true ->
  finite (fst (remainder_of_root _ F fused x v)) /\
  B2R (fst (remainder_of_root _ F fused x v)) = B2R x - B2R v * B2R v.
Proof.
  intros FV Rv. assert (PE := p_emax p emax).
  assert (H := FV). rewrite Rv in H. apply root_finite in H. destruct H as (FX & PX & EV). rewrite <- Rv in EV.
  apply (IeeeInterval.remainder_exact p emax p_3 fused); auto.
  { intros X0. rewrite EV, X0, sqrt_0. exact (Format.rnd_0 p emin Format.nearest). }
  intros e EX D X0 NV.
  destruct (root_remainder_exact p emin p_3 (B2R x) (fl (B2R v * B2R v), e)) as (R & RD & Q);
    rewrite <- ?EV; cbn [fst snd]; auto using number_B2R; [lia |].
  rewrite <- EV in Q. rewrite <- EV in R. cbn [fst snd] in R, RD, Q.
  rewrite (Rabs_pos_eq (B2R v * B2R v)) by apply Rle_0_sqr. auto.
Qed.

(** For a rule that keeps its operations. *)
Section By_operations.

Context (B : Type) (by_rule : operations float B) (holds : float -> B -> R -> Prop)
  (Keeps : keeps_operations p emax B by_rule holds).
Notation rule := (the_rule float B by_rule).
Notation Rule := (keeps_promises _ _ _ _ _ Keeps).
Notation tracked_known := (tracked_known p emax B holds).
Notation error_of := (tracked_error float F B rule).
Notation exactly := (tracked_exactly float B rule).

Lemma exactly_known v : tracked_known (exactly v) (B2R v).
Proof. apply (promise_exact _ _ _ _ _ Rule). Qed.
Lemma add_known x r y s : tracked_known x r -> tracked_known y s -> tracked_known (tracked_add _ F _ by_rule x y) (r + s).
Proof. apply (known_sum _ _ _ _ _ Keeps). Qed.
Lemma subtract_known x r y s : tracked_known x r -> tracked_known y s ->
  tracked_known (tracked_subtract _ F _ rule x y) (r - s).
Proof. apply (promise_subtract _ _ _ _ _ Rule). Qed.
Lemma multiply_known x r y s : tracked_known x r -> tracked_known y s ->
  tracked_known (tracked_multiply _ F _ by_rule x y) (r * s).
Proof. apply (known_product _ _ _ _ _ Keeps). Qed.
Lemma divide_known x r y s : tracked_known x r -> tracked_known y s ->
  tracked_known (tracked_divide _ F _ by_rule x y) (r / s).
Proof.
  intros X Y. unfold tracked_divide. destruct (rule_divide float B by_rule) as [divide |] eqn:D.
  - apply (known_quotient _ _ _ _ _ Keeps divide) with r s; auto.
  - apply (nothing_known p emax B rule holds Rule). discriminate.
Qed.
Lemma closer_either x y : closer _ F B by_rule x y = x \/ closer _ F B by_rule x y = y.
Proof. unfold closer. cbv zeta. destruct (_ && _); auto. Qed.

(** The properties of the root that a slope needs. *)
Lemma slope_of_root x root s : fst root = Code.root _ F (fst x) -> known (fst root) (error_of root) s ->
  no_root_slope _ F fused B by_rule x root = false ->
  finite (error_of root) /\ 0 < B2R (fst root) /\
  B2R (fst (remainder_of_root _ F fused (fst x) (fst root))) = B2R (fst x) - B2R (fst root) * B2R (fst root).
Proof.
  intros V K C. unfold no_root_slope in C. apply orb_false_elim in C. destruct C as [C C3].
  apply orb_false_elim in C. destruct C as [C1 C2]. apply negb_false_iff in C1, C3. apply code_finite in C3.
  destruct (zero_value p emax p_3) as [Z0 Z]. destruct (proj2 K C3) as [FV _].
  rewrite (equal_finite p emax), Z in C2 by auto. destruct (Req_bool_spec (B2R (fst root)) 0) as [| NV]; [discriminate |].
  split; [exact C3 |]. split; [| now apply remainder_of_root_known].
  assert (H := FV). rewrite V in H. apply root_finite in H. destruct H as (_ & _ & H). rewrite <- V in H.
  assert (0 <= B2R (fst root)); [| lra]. rewrite H. apply (Format.rnd_nonnegative p emin Format.nearest), sqrt_pos.
Qed.
Lemma root_and_change x v r : 0 <= r -> 0 < v -> v + (r - x + (x - v * v)) / (sqrt r + v) = sqrt r.
Proof.
  intros P V. assert (S := sqrt_pos r). replace (r - x + (x - v * v)) with (sqrt r * sqrt r - v * v).
  - field. lra.
  - rewrite sqrt_sqrt by exact P. ring.
Qed.
Theorem sqrt_by_slope_known x r root : tracked_known x r -> fst root = Code.root _ F (fst x) ->
  tracked_known root (sqrt r) -> (finite (error_of root) -> 0 <= r) ->
  tracked_known (sqrt_by_slope _ F fused B by_rule x root) (sqrt r).
Proof.
  intros X V K P. unfold sqrt_by_slope. destruct (no_root_slope _ _ _ _ _ _ _) eqn:C; [exact K |]. cbv zeta.
  destruct (slope_of_root x root (sqrt r) V (error_of_known p emax B rule holds Rule _ _ K) C) as (FE & PV & E).
  rewrite <- (root_and_change (B2R (fst x)) (B2R (fst root)) r) by auto. rewrite <- E.
  apply add_known; [apply exactly_known |]. apply divide_known.
  - apply add_known; [| apply exactly_known]. apply subtract_known; [exact X | apply exactly_known].
  - apply add_known; [exact K | apply exactly_known].
Qed.
Lemma value_of_sqrt x : fst (tracked_sqrt _ F fused _ rule x) = Code.root _ F (fst x).
Proof. unfold tracked_sqrt. cbv zeta. repeat match goal with |- context [if ?c then _ else _] => destruct c end; reflexivity. Qed.
Theorem slope_sqrt_known crowded x r : tracked_known x r ->
  tracked_known (slope_sqrt _ F fused B by_rule crowded x) (sqrt r) /\
  (finite (error_of (slope_sqrt _ F fused B by_rule crowded x)) -> 0 <= r).
Proof.
  intros X. unfold slope_sqrt. cbv zeta. set (root := tracked_sqrt _ F fused _ rule x).
  destruct (sqrt_known p emax p_3 fused B rule holds Rule x r X) as [K P]. fold root in K, P.
  assert (S := sqrt_by_slope_known x r root X (value_of_sqrt x) K P).
  set (best := closer _ F B by_rule root (sqrt_by_slope _ F fused B by_rule x root)).
  assert (H : tracked_known best (sqrt r) /\ (finite (error_of best) -> 0 <= r)).
  { unfold best. destruct (closer_either root (sqrt_by_slope _ F fused B by_rule x root)) as [-> | ->]; auto.
    split; auto. unfold sqrt_by_slope. destruct (no_root_slope _ _ _ _ _ _ _) eqn:C; [exact P |]. intros _.
    apply P, (slope_of_root x root (sqrt r) (value_of_sqrt x) (error_of_known p emax B rule holds Rule _ _ K) C). }
  destruct (crowded (snd best)); [| exact H]. destruct H as [HB PB].
  assert (E := error_of_known p emax B rule holds Rule _ _ HB). split.
  - apply (promise_within _ _ _ _ _ Rule). intros FE _. now apply (proj2 E).
  - intros FE. apply PB. destruct (BinarySingleNaN.is_finite (error_of best)) eqn:N; auto. exfalso.
    apply (nothing_error p emax B rule holds Rule (fst best) (error_of best)); [congruence | exact FE].
Qed.

(** The rounding error of ab + c, in three numbers. *)
Lemma slope_of_fma (a b c : float * B) : no_fma_slope _ F fused B a b c = false ->
  let product := two_product _ F fused (fst a) (fst b) in
  let total := two_sum _ F (fst product) (fst c) in
  B2R (fst total) + B2R (snd total) + B2R (snd product) = B2R (fst a) * B2R (fst b) + B2R (fst c).
Proof.
  unfold no_fma_slope. cbv zeta. intros C. apply orb_false_elim in C. destruct C as [C1 C2].
  apply negb_false_iff in C1, C2. apply code_finite in C2.
  apply (IeeeInterval.product_known p emax p_3 fused) in C1. destruct C1 as (FP & FE & _ & _ & EX & _).
  rewrite (IeeeInterval.product_value p emax fused) in *.
  assert (FS : finite (fst a ⊗ fst b ⊕ fst c)).
  { revert C2. unfold two_sum. cbn [snd]. generalize (fst a ⊗ fst b ⊕ fst c). intros s H.
    apply plus_finite in H. destruct H as (_ & H & _). apply minus_finite in H. destruct H as (_ & H & _).
    apply minus_finite in H. tauto. }
  destruct (IeeeInterval.two_sum_known p emax p_3 _ _ FS) as [N | [_ E]].
  - destruct (snd (two_sum _ F (fst a ⊗ fst b) (fst c))); discriminate.
  - change (fst (two_sum _ F (fst a ⊗ fst b) (fst c))) with (fst a ⊗ fst b ⊕ fst c). lra.
Qed.
Theorem fma_by_slope_known a x b y c z sum : tracked_known a x -> tracked_known b y -> tracked_known c z ->
  tracked_known sum (x * y + z) -> tracked_known (fma_by_slope _ F fused B by_rule a b c sum) (x * y + z).
Proof.
  intros X Y Z K. unfold fma_by_slope. destruct (no_fma_slope _ _ _ _ _ _ _) eqn:C; [exact K |].
  assert (E := slope_of_fma a b c C). cbv zeta in *.
  set (product := two_product _ F fused (fst a) (fst b)) in *. set (total := two_sum _ F (fst product) (fst c)) in *.
  replace (x * y + z) with (B2R (fst sum) + (((x - B2R (fst a)) * B2R (fst b) + x * (y - B2R (fst b)) +
    (z - B2R (fst c))) + ((B2R (fst total) - B2R (fst sum)) + B2R (snd total) + B2R (snd product)))) by lra.
  repeat first [apply exactly_known | apply add_known | apply subtract_known | apply multiply_known | assumption].
Qed.
Theorem slope_fma_known a x b y c z : tracked_known a x -> tracked_known b y -> tracked_known c z ->
  tracked_known (slope_fma _ F fused B by_rule a b c) (x * y + z).
Proof.
  intros X Y Z. unfold slope_fma. cbv zeta. destruct (_ && _) eqn:C.
  - apply andb_prop in C. destruct C as [C _]. unfold product_is_zero in C.
    assert (E : x * y = 0).
    { apply orb_prop in C. destruct C as [C | C].
      - rewrite (known_zero p emax p_3 _ _ _ (error_of_known p emax B rule holds Rule _ _ X) C). ring.
      - rewrite (known_zero p emax p_3 _ _ _ (error_of_known p emax B rule holds Rule _ _ Y) C). ring. }
    now rewrite E, Rplus_0_l.
  - assert (K := fma_known p emax p_3 B rule holds Rule a x b y c z X Y Z).
    destruct (closer_either (tracked_fma _ F B rule a b c) (fma_by_slope _ F fused B by_rule a b c
      (tracked_fma _ F B rule a b c))) as [-> | ->]; [exact K | now apply fma_by_slope_known].
Qed.

End By_operations.

Theorem residual_sqrt_known x r : tracked_known p emax _ (IeeeResidual.residual_known p emax) x r ->
  tracked_known p emax _ (IeeeResidual.residual_known p emax)
    (slope_sqrt _ F fused _ (residual_operations _ F fused) (fun _ => false) x) (sqrt r).
Proof. intros X. apply (slope_sqrt_known _ _ _ (residual_keeps_operations p emax p_3 fused) _ x r X). Qed.
Theorem residual_fma_known a x b y c z :
  tracked_known p emax _ (IeeeResidual.residual_known p emax) a x ->
  tracked_known p emax _ (IeeeResidual.residual_known p emax) b y ->
  tracked_known p emax _ (IeeeResidual.residual_known p emax) c z ->
  tracked_known p emax _ (IeeeResidual.residual_known p emax)
    (slope_fma _ F fused _ (residual_operations _ F fused) a b c) (x * y + z).
Proof. apply (slope_fma_known _ _ _ (residual_keeps_operations p emax p_3 fused)). Qed.

(** The rule `interval`. *)
Notation interval_known := (IeeeInterval.interval_known p emax).

Lemma end_known a A x : interval_known a A x -> Code.is_finite _ F (fst A) = true ->
  finite (fst A) /\ finite (snd A) /\ finite a /\ B2R (fst A) <= B2R a <= B2R (snd A) /\
  B2R (fst A) <= x <= B2R (snd A).
Proof. intros [-> | K]; [discriminate | auto]. Qed.

Lemma lower_root c : finite c -> 0 <= B2R c -> let v := root _ F c in let r := remainder_of_root _ F fused c v in
  let w := if snd r && at_most _ F (integer _ F 0) (fst r) then v else below _ F v in finite w -> B2R w <= sqrt (B2R c).
Proof.
  intros FC PC v r w W. destruct (zero_value p emax p_3) as [Z0 Z].
  assert (FV : finite v) by now apply root_of_nonnegative.
  assert (H := FV). apply root_finite in H. destruct H as (_ & _ & EV). fold v in EV. unfold w in *.
  destruct (snd r && _) eqn:C.
  - apply andb_prop in C. destruct C as [C1 C2].
    destruct (remainder_of_root_known c v FV eq_refl C1) as [FR ER]. fold r in FR, ER.
    rewrite (at_most_finite p emax), Z, ER in C2 by auto. revert C2. case Rle_bool_spec; [intros S _ | discriminate].
    apply Rsqr_incr_0_var; [| apply sqrt_pos]. rewrite Rsqr_sqrt by exact PC. unfold Rsqr. lra.
  - apply (IeeeInterval.below_true p emax p_3); auto. rewrite EV. apply Rle_refl.
Qed.
Lemma upper_root c : finite c -> 0 <= B2R c -> let v := root _ F c in let r := remainder_of_root _ F fused c v in
  let w := if snd r && at_most _ F (fst r) (integer _ F 0) then v else above _ F v in finite w -> sqrt (B2R c) <= B2R w.
Proof.
  intros FC PC v r w W. destruct (zero_value p emax p_3) as [Z0 Z].
  assert (FV : finite v) by now apply root_of_nonnegative.
  assert (H := FV). apply root_finite in H. destruct H as (_ & _ & EV). fold v in EV. unfold w in *.
  destruct (snd r && _) eqn:C.
  - apply andb_prop in C. destruct C as [C1 C2].
    destruct (remainder_of_root_known c v FV eq_refl C1) as [FR ER]. fold r in FR, ER.
    rewrite (at_most_finite p emax), Z, ER in C2 by auto. revert C2. case Rle_bool_spec; [intros S _ | discriminate].
    assert (PV : 0 <= B2R v) by (rewrite EV; apply (Format.rnd_nonnegative p emin Format.nearest), sqrt_pos).
    apply Rsqr_incr_0_var; [| exact PV]. rewrite Rsqr_sqrt by exact PC. unfold Rsqr. lra.
  - apply (IeeeInterval.above_true p emax p_3); auto. rewrite EV. apply Rle_refl.
Qed.
(** If the bound of the root is finite, x is not negative. *)
Theorem interval_square_root_known a A x : interval_known a A x ->
  interval_known (root _ F a) (interval_square_root _ F fused (root _ F a) A) (sqrt x) /\
  (interval_square_root _ F fused (root _ F a) A <> interval_unknown _ F -> 0 <= x).
Proof.
  intros K. unfold interval_square_root. destruct (zero_value p emax p_3) as [Z0 Z].
  destruct (at_most _ F (integer _ F 0) (fst A)) eqn:C; cbn [negb]; [| split; [now left | congruence]].
  destruct K as [-> | (FL & FU & _ & _ & X)]; [now destruct (integer _ F 0) as [| | |]; simpl in C |].
  rewrite (at_most_finite p emax), Z in C by auto. revert C. case Rle_bool_spec; [intros PL _ | discriminate].
  split; [| lra]. cbv zeta. apply (IeeeInterval.checked_known p emax). intros _ L U _. split.
  - apply Rle_trans with (sqrt (B2R (fst A))); [now apply (lower_root (fst A) FL PL) | now apply sqrt_le_1_alt].
  - apply Rle_trans with (sqrt (B2R (snd A))); [now apply sqrt_le_1_alt |].
    apply (upper_root (snd A) FU); [lra | exact U].
Qed.
Theorem interval_sqrt_known x r : tracked_known p emax _ interval_known x r ->
  tracked_known p emax _ interval_known (interval_sqrt _ F fused x) (sqrt r).
Proof. intros K. apply (interval_square_root_known _ _ _ K). Qed.

(** A number rounded to w, or overflowing to it. *)
Definition rounds (w : float) (q : R) : Prop :=
  (finite w /\ B2R w = fl q) \/ (w = B754_infinity false /\ bpow radix2 emax <= fl q) \/
  (w = B754_infinity true /\ fl q <= - bpow radix2 emax).
Lemma fma_rounds a b c : finite a -> finite b -> finite c -> rounds (fma _ F a b c) (B2R a * B2R b + B2R c).
Proof.
  intros FA FB FC. generalize (Bfma_correct p emax _ _ mode_NE a b c FA FB FC). cbv zeta.
  change (round radix2 (SpecFloat.fexp p emax) (round_mode mode_NE) (B2R a * B2R b + B2R c)) with
    (fl (B2R a * B2R b + B2R c)).
  change (Bfma mode_NE a b c) with (fma _ F a b c). set (q := B2R a * B2R b + B2R c).
  case Rlt_bool_spec; intros L; [intros (E & H & _); left; auto |]. intros E. right.
  revert E. case Rlt_bool_spec; intros S E; [right | left].
  - assert (N : fl q <= 0).
    { rewrite <- (Format.rnd_0 p emin Format.nearest). apply (Format.rnd_le p emin Format.nearest). lra. }
    rewrite Rabs_left1 in L by exact N. split; [| lra].
    destruct (fma _ F a b c) as [| [|] | | ]; cbn in E; try discriminate; reflexivity.
  - assert (N : 0 <= fl q) by now apply (Format.rnd_nonnegative p emin Format.nearest).
    rewrite Rabs_pos_eq in L by exact N. split; [| exact L].
    destruct (fma _ F a b c) as [| [|] | | ]; cbn in E; try discriminate; reflexivity.
Qed.
(** The smaller or larger of C's two numbers has the smaller or larger rounded value. *)
Ltac chosen C := exfalso; first
  [ lra
  | match type of C with ?a = ?b => assert (X : a = negb b) by
      first [reflexivity | match goal with x : binary_float p emax |- _ => now destruct x as [| [|] | | [|]] end];
      rewrite C in X; discriminate X end
  | rewrite (less_finite p emax) in C by auto; revert C; case Rlt_bool_spec; intros; [lra || discriminate | lra || discriminate] ].
Ltac picked s := exists s; split; [unfold rounds; tauto | split; lra].
Lemma least_rounds m q n r : rounds m q -> rounds n r ->
  exists s, rounds (Code.least _ F m n) s /\ fl s <= fl q /\ fl s <= fl r.
Proof.
  intros M N. assert (LM := Rabs_def2 _ _ (abs_B2R_lt_emax p emax m)). assert (LN := Rabs_def2 _ _ (abs_B2R_lt_emax p emax n)).
  unfold Code.least. destruct (less _ F n m) eqn:C, (Rle_or_lt (fl q) (fl r)) as [O | O]; [| picked r | picked q |];
    destruct M as [[FM EM] | [[-> L] | [-> L]]], N as [[FN EN] | [[-> K] | [-> K]]];
    solve [chosen C | picked q | picked r].
Qed.
Lemma most_rounds m q n r : rounds m q -> rounds n r ->
  exists s, rounds (Code.most _ F m n) s /\ fl q <= fl s /\ fl r <= fl s.
Proof.
  intros M N. assert (LM := Rabs_def2 _ _ (abs_B2R_lt_emax p emax m)). assert (LN := Rabs_def2 _ _ (abs_B2R_lt_emax p emax n)).
  unfold Code.most. destruct (less _ F m n) eqn:C, (Rle_or_lt (fl r) (fl q)) as [O | O]; [| picked r | picked q |];
    destruct M as [[FM EM] | [[-> L] | [-> L]]], N as [[FN EN] | [[-> K] | [-> K]]];
    solve [chosen C | picked q | picked r].
Qed.
Lemma end_rounds (A B : float * float) c choice (order : R -> R -> Prop) :
  (forall x y z, order x y -> order y z -> order x z) ->
  (forall m q n r, rounds m q -> rounds n r -> exists s, rounds (choice m n) s /\ order (fl s) (fl q) /\ order (fl s) (fl r)) ->
  finite (fst A) -> finite (snd A) -> finite (fst B) -> finite (snd B) -> finite c ->
  exists s, rounds (fused_end _ F choice A B c) s /\
    order (fl s) (fl (B2R (fst A) * B2R (fst B) + B2R c)) /\ order (fl s) (fl (B2R (fst A) * B2R (snd B) + B2R c)) /\
    order (fl s) (fl (B2R (snd A) * B2R (fst B) + B2R c)) /\ order (fl s) (fl (B2R (snd A) * B2R (snd B) + B2R c)).
Proof.
  intros Trans Choice A1 A2 B1 B2 FC. unfold fused_end.
  destruct (Choice _ _ _ _ (fma_rounds _ _ _ A1 B1 FC) (fma_rounds _ _ _ A1 B2 FC)) as (s & S & S1 & S2).
  destruct (Choice _ _ _ _ (fma_rounds _ _ _ A2 B1 FC) (fma_rounds _ _ _ A2 B2 FC)) as (t & T & T1 & T2).
  destruct (Choice _ _ _ _ S T) as (w & W & W1 & W2). exists w. split; [exact W |].
  repeat split; [apply Trans with (fl s) | apply Trans with (fl s) | apply Trans with (fl t) | apply Trans with (fl t)];
    assumption.
Qed.
Lemma rounds_finite w q : rounds w q -> finite w -> B2R w = fl q.
Proof. intros [[_ E] | [[-> _] | [-> _]]]; [auto | discriminate | discriminate]. Qed.
Theorem interval_fused_known a A x b B y c C z : interval_known a A x -> interval_known b B y -> interval_known c C z ->
  interval_known (fma _ F a b c) (interval_fused _ F (fma _ F a b c) A B C) (x * y + z).
Proof.
  intros KA KB KC. unfold interval_fused. destruct (_ || _) eqn:D; [now left |].
  apply orb_false_elim in D. destruct D as [D D3]. apply orb_false_elim in D. destruct D as [D1 D2].
  apply negb_false_iff in D1, D2, D3.
  destruct (end_known _ _ _ KA D1) as (A1 & A2 & _ & _ & X), (end_known _ _ _ KB D2) as (B1 & B2 & _ & _ & Y),
    (end_known _ _ _ KC D3) as (C1 & C2 & _ & _ & Z). clear KA KB KC D1 D2 D3.
  apply (IeeeInterval.checked_known p emax). intros _ L U _.
  assert (Le : forall q, q <= x * y + z -> fl q <= fl (x * y + z)) by (intros; now apply (Format.rnd_le p emin Format.nearest)).
  assert (Ge : forall q, x * y + z <= q -> fl (x * y + z) <= fl q) by (intros; now apply (Format.rnd_le p emin Format.nearest)).
  split.
  - apply (IeeeInterval.below_true p emax p_3); auto.
    apply (IeeeInterval.below_finite p emax p_3) in L. destruct L as [L _].
    destruct (end_rounds A B (fst C) (Code.least _ F) Rle Rle_trans least_rounds A1 A2 B1 B2 C1) as (s & S & S1 & S2 & S3 & S4).
    rewrite (rounds_finite _ _ S L).
    destruct (IeeeInterval.corner_below _ _ _ _ _ _ X Y) as [H | [H | [H | H]]];
      [apply Rle_trans with (1 := S1) | apply Rle_trans with (1 := S2) | apply Rle_trans with (1 := S3) |
       apply Rle_trans with (1 := S4)]; apply Le; lra.
  - apply (IeeeInterval.above_true p emax p_3); auto.
    apply (IeeeInterval.above_finite p emax p_3) in U. destruct U as [U _].
    destruct (end_rounds A B (snd C) (Code.most _ F) Rge Rge_trans) as (s & S & S1 & S2 & S3 & S4); auto.
    { intros m q n r M N. destruct (most_rounds m q n r M N) as (s & S & S1 & S2). exists s. repeat split; auto; lra. }
    rewrite (rounds_finite _ _ S U).
    destruct (IeeeInterval.corner_above _ _ _ _ _ _ X Y) as [H | [H | [H | H]]];
      [apply Rle_trans with (2 := Rge_le _ _ S1) | apply Rle_trans with (2 := Rge_le _ _ S2) |
       apply Rle_trans with (2 := Rge_le _ _ S3) | apply Rle_trans with (2 := Rge_le _ _ S4)]; apply Ge; lra.
Qed.
Theorem interval_fma_known a x b y c z : tracked_known p emax _ interval_known a x ->
  tracked_known p emax _ interval_known b y -> tracked_known p emax _ interval_known c z ->
  tracked_known p emax _ interval_known (interval_fma _ F a b c) (x * y + z).
Proof.
  intros X Y Z. unfold interval_fma. cbv zeta. destruct (_ && _) eqn:C; [| now apply interval_fused_known].
  apply andb_prop in C. destruct C as [C _]. unfold product_is_zero in C.
  assert (Rule := interval_promises p emax p_3 fused). assert (E : x * y = 0).
  { apply orb_prop in C. destruct C as [C | C].
    - rewrite (known_zero p emax p_3 _ _ _ (error_of_known p emax _ _ _ Rule _ _ X) C). ring.
    - rewrite (known_zero p emax p_3 _ _ _ (error_of_known p emax _ _ _ Rule _ _ Y) C). ring. }
  now rewrite E, Rplus_0_l.
Qed.

End Slopes.

(** The rule `affine`, with a source for each operation. *)
Section Affine_slopes.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_4 : (4 <= p)%Z).
Variable fused : bool.  (* has_fast_fma *)
Context (limit : nat) (source : nat -> option Z)
  (all_different : forall i j s, source i = Some s -> source j = Some s -> i = j).
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation p_3 := (at_least_3 p p_4).
Notation operation := (fun k => affine_operations float F fused limit (source k)).
Notation rule := (the_rule _ _ (operation O)).
Notation exactly := (tracked_exactly _ _ rule).
Notation ready := (ready p emax source).
Notation gives := (gives p emax fused limit source).
Notation makes := (makes p emax fused limit source).
Notation first_rule := (operation O).

Lemma beside_exactly {X} l k v (m : counted X) P : ready k l ->
  (ready k ((exactly v, B2R v) :: l) -> makes ((exactly v, B2R v) :: l) k m P) -> makes l k m P.
Proof.
  intros Ready. apply (makes_beside p emax p_4 fused limit source l k (exactly v) (B2R v) m P Ready).
  apply (of_exactly p emax fused limit None l v).
Qed.
Lemma divide_gives l k a b x y : ready k l -> In (a, x) l -> In (b, y) l ->
  gives l k (numbered_divide _ F _ operation a b) (x / y).
Proof.
  intros Ready X Y. apply (gives_once p emax p_4 fused limit source all_different l k _ (x / y) Ready).
  apply (of_divide p emax fused limit (source k) l a x b y); auto.
Qed.
Notation add_gives := (add_gives p emax p_4 fused limit source all_different).
Notation subtract_gives := (subtract_gives p emax p_4 fused limit source all_different).
Notation multiply_gives := (multiply_gives p emax p_4 fused limit source all_different).
Notation after_it H := (makes_after p emax fused limit source _ _ _ _ _ _ H).

Lemma error_known l k n x : ready k l -> In (n, x) l -> known p emax (fst n) (tracked_error _ F _ rule n) x.
Proof.
  intros Ready I. assert (K := error_right p emax source k l n x Ready I). unfold tracked_error. cbv zeta.
  destruct equal; [exact K | split; [reflexivity | discriminate]].
Qed.
Lemma sqrt_by_slope_gives l k x r root : ready k l -> In (x, r) l -> In (root, sqrt r) l ->
  fst root = Code.root _ F (fst x) -> (finite (radius _ (snd root)) -> 0 <= r) ->
  gives l k (numbered_sqrt_by_slope _ F fused _ operation x root) (sqrt r).
Proof.
  intros Ready X W V P. unfold numbered_sqrt_by_slope.
  destruct (no_root_slope _ _ _ _ _ _ _) eqn:C; [now apply makes_at_once |]. cbv zeta.
  assert (K := error_known l k root (sqrt r) Ready W).
  destruct (slope_of_root p emax p_3 fused _ first_rule x root (sqrt r) V K C) as (FE & PV & E).
  assert (FR : finite (radius _ (snd root))).
  { revert FE. unfold tracked_error. cbv zeta. destruct equal; [auto | discriminate]. }
  rewrite <- (root_and_change (B2R (fst x)) (B2R (fst root)) r) by auto. rewrite <- E.
  set (remainder := fst (remainder_of_root _ F fused (fst x) (fst root))) in *.
  apply beside_exactly with (v := fst root); auto. intros R1.
  apply beside_exactly with (v := fst x); auto. intros R2.
  apply beside_exactly with (v := remainder); auto. intros R3.
  set (l3 := (exactly remainder, B2R remainder) :: (exactly (fst x), B2R (fst x)) :: (exactly (fst root), B2R (fst root)) :: l) in *.
  assert (I3 : incl l l3) by (intros n N; do 3 right; exact N).
  assert (X1 : In (exactly remainder, B2R remainder) l3) by now left.
  assert (X2 : In (exactly (fst x), B2R (fst x)) l3) by (right; now left).
  assert (X3 : In (exactly (fst root), B2R (fst root)) l3) by (do 2 right; now left).
  apply (after_it (subtract_gives l3 k R3 x _ r _ (I3 _ X) X2)). intros inherited l4 k4 I4 R4 N4. apply computed_incl in I4.
  apply (after_it (add_gives l4 k4 R4 inherited _ _ _ N4 (I4 _ X1))). intros change l5 k5 I5 R5 N5. apply computed_incl in I5.
  apply (after_it (add_gives l5 k5 R5 root _ _ _ (I5 _ (I4 _ (I3 _ W))) (I5 _ (I4 _ X3)))). intros divisor l6 k6 I6 R6 N6.
  apply computed_incl in I6.
  apply (after_it (divide_gives l6 k6 change divisor _ _ R6 (I6 _ N5) N6)). intros quotient l7 k7 I7 R7 N7.
  apply computed_incl in I7. apply add_gives; auto.
Qed.
Theorem affine_slope_sqrt_gives crowded l k x r : ready k l -> In (x, r) l ->
  gives l k (numbered_slope_sqrt _ F fused _ operation crowded x) (sqrt r).
Proof.
  intros Ready X. unfold numbered_slope_sqrt.
  destruct (affine_sqrt_gives p emax p_4 fused limit source all_different l k Ready x r X) as [G P].
  set (root := fst (numbered_sqrt _ F fused _ operation x k)) in P.
  apply (after_it (makes_and p emax fused limit source l k _ _ (fun n => n = root) G eq_refl)).
  intros n l1 j I1 R1 [N ->]. apply computed_incl in I1.
  assert (V : fst root = Code.root _ F (fst x)).
  { unfold root, numbered_sqrt, once. cbn [fst]. apply value_of_sqrt. }
  apply (after_it (sqrt_by_slope_gives l1 j x r root R1 (I1 _ X) N V P)). intros s l2 i I2 R2 S. apply computed_incl in I2.
  cbv zeta. match goal with |- context [crowded (snd ?n)] => set (best := n) end.
  assert (H : In (best, sqrt r) l2).
  { destruct (closer_either p emax _ first_rule root s) as [E | E];
      [change (best = root) in E | change (best = s) in E]; rewrite E; auto. }
  destruct (crowded (snd best)); [| now apply makes_at_once].
  assert (E := error_known l2 i best (sqrt r) R2 H).
  apply (gives_once p emax p_4 fused limit source all_different l2 i _ (sqrt r) R2).
  apply (of_within p emax fused limit (source i) l2 (fst best)). intros FE _. now apply (proj2 E).
Qed.

Lemma fma_by_slope_gives l k a x b y c z sum : ready k l -> In (a, x) l -> In (b, y) l -> In (c, z) l ->
  In (sum, x * y + z) l -> gives l k (numbered_fma_by_slope _ F fused _ operation a b c sum) (x * y + z).
Proof.
  intros Ready X Y Z W. unfold numbered_fma_by_slope.
  destruct (no_fma_slope _ _ _ _ _ _ _) eqn:C; [now apply makes_at_once |].
  assert (E := slope_of_fma p emax p_3 fused _ a b c C). cbv zeta in *.
  set (product := two_product _ F fused (fst a) (fst b)) in *. set (total := two_sum _ F (fst product) (fst c)) in *.
  replace (x * y + z) with (B2R (fst sum) + (((x - B2R (fst a)) * B2R (fst b) + x * (y - B2R (fst b)) +
    (z - B2R (fst c))) + ((B2R (fst total) - B2R (fst sum)) + B2R (snd total) + B2R (snd product)))) by lra.
  apply beside_exactly with (v := fst sum); auto. intros Q1. apply beside_exactly with (v := fst total); auto. intros Q2.
  apply beside_exactly with (v := snd total); auto. intros Q3.
  apply beside_exactly with (v := snd product); auto. intros Q4. apply beside_exactly with (v := fst a); auto. intros Q5.
  apply beside_exactly with (v := fst b); auto. intros Q6. apply beside_exactly with (v := fst c); auto. intros R0.
  clear Q1 Q2 Q3 Q4 Q5 Q6.
  match type of R0 with ready k ?m => set (l0 := m) in * end.
  assert (I0 : incl l l0) by (intros n N; do 7 right; exact N).
  assert (C1 : In (exactly (fst sum), B2R (fst sum)) l0) by (do 6 right; now left).
  assert (C2 : In (exactly (fst total), B2R (fst total)) l0) by (do 5 right; now left).
  assert (C3 : In (exactly (snd total), B2R (snd total)) l0) by (do 4 right; now left).
  assert (C4 : In (exactly (snd product), B2R (snd product)) l0) by (do 3 right; now left).
  assert (C5 : In (exactly (fst a), B2R (fst a)) l0) by (do 2 right; now left).
  assert (C6 : In (exactly (fst b), B2R (fst b)) l0) by (right; now left).
  assert (C7 : In (exactly (fst c), B2R (fst c)) l0) by now left.
  apply I0 in X, Y, Z. clearbody l0. clear I0.
  apply (after_it (subtract_gives l0 k R0 _ _ _ _ C2 C1)). intros difference l1 k1 I1 R1 N1. apply computed_incl in I1.
  apply (after_it (add_gives l1 k1 R1 _ _ _ _ N1 (I1 _ C3))). intros partial l2 k2 I2 R2 N2. apply computed_incl in I2.
  apply (after_it (add_gives l2 k2 R2 _ _ _ _ N2 (I2 _ (I1 _ C4)))). intros rounding l3 k3 I3 R3 N3. apply computed_incl in I3.
  assert (J3 : incl l0 l3) by (intros n N; now apply I3, I2, I1).
  apply (after_it (subtract_gives l3 k3 R3 _ _ _ _ (J3 _ Y) (J3 _ C6))). intros change_b l4 k4 I4 R4 N4.
  apply computed_incl in I4.
  apply (after_it (multiply_gives l4 k4 R4 _ _ _ _ (I4 _ (J3 _ X)) N4)). intros of_b l5 k5 I5 R5 N5. apply computed_incl in I5.
  assert (J5 : incl l0 l5) by (intros n N; now apply I5, I4, J3).
  apply (after_it (subtract_gives l5 k5 R5 _ _ _ _ (J5 _ X) (J5 _ C5))). intros change_a l6 k6 I6 R6 N6.
  apply computed_incl in I6.
  apply (after_it (multiply_gives l6 k6 R6 _ _ _ _ N6 (I6 _ (J5 _ C6)))). intros of_a l7 k7 I7 R7 N7. apply computed_incl in I7.
  assert (J7 : incl l0 l7) by (intros n N; now apply I7, I6, J5).
  apply (after_it (subtract_gives l7 k7 R7 _ _ _ _ (J7 _ Z) (J7 _ C7))). intros change_c l8 k8 I8 R8 N8.
  apply computed_incl in I8.
  apply (after_it (add_gives l8 k8 R8 _ _ _ _ (I8 _ N7) (I8 _ (I7 _ (I6 _ N5))))). intros products l9 k9 I9 R9 N9.
  apply computed_incl in I9.
  apply (after_it (add_gives l9 k9 R9 _ _ _ _ N9 (I9 _ N8))). intros inherited l10 k10 I10 R10 N10. apply computed_incl in I10.
  assert (J : incl l3 l10) by (intros n N; now apply I10, I9, I8, I7, I6, I5, I4).
  apply (after_it (add_gives l10 k10 R10 _ _ _ _ N10 (J _ N3))). intros change l11 k11 I11 R11 N11. apply computed_incl in I11.
  apply add_gives; auto.
Qed.
Theorem affine_slope_fma_gives l k a x b y c z : ready k l -> In (a, x) l -> In (b, y) l -> In (c, z) l ->
  gives l k (numbered_slope_fma _ F fused _ operation a b c) (x * y + z).
Proof.
  intros Ready X Y Z. unfold numbered_slope_fma. cbv zeta. destruct (_ && _) eqn:C.
  - apply andb_prop in C. destruct C as [C _]. unfold product_is_zero in C. assert (E : x * y = 0).
    { apply orb_prop in C. destruct C as [C | C].
      - rewrite (known_zero p emax p_3 _ _ _ (error_known l k a x Ready X) C). ring.
      - rewrite (known_zero p emax p_3 _ _ _ (error_known l k b y Ready Y) C). ring. }
    apply makes_at_once; auto. now rewrite E, Rplus_0_l.
  - apply (after_it (affine_fma_gives p emax p_4 fused limit source all_different l k Ready a b c x y z X Y Z)).
    intros sum l1 j I1 R1 N. apply computed_incl in I1.
    apply (after_it (fma_by_slope_gives l1 j a x b y c z sum R1 (I1 _ X) (I1 _ Y) (I1 _ Z) N)). intros s l2 i I2 R2 S.
    apply computed_incl in I2. apply makes_at_once; auto.
    destruct (closer_either p emax _ first_rule sum s) as [-> | ->]; auto.
Qed.

End Affine_slopes.
