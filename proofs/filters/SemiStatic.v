(** The semi-static filter (include/errbound/filters/semi_static_filter.hpp), rounded to nearest: its bound, from the
    largest difference M, covers the error. Hypotheses are those of StaticFilter.v, a degree of at most 2^(p-6), and
    emin <= -4p - 5 (double and float: -1074 <= -217, -149 <= -101). The code tests that m and a are exact:
    `trusted`. Results:
        mass_covers_size            S <= m M^d + (a - 3/4) tau + a tau M^d
        semi_static_bound_covers    the last operation's exact result is within bound(M), as computed
        semi_static_sign_certain    the certain sign of the code is right
        semi_static_overflow_uncertain   also with a largest number and any overflow *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool Classical_Prop.
From Flocq Require Import Core.
From Errbound Require Import Format Sign StaticFilter.
Open Scope R_scope.

Section SemiStatic.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.
Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation u := (u p).
Notation eta := (eta emin).
Notation value := (value p emin).
Notation exact_size := (exact_size p emin).
Notation tau := (allowance p emin).
Notation roundings := (roundings p).

(** The code: degree, mass and allowances of an expression. *)
Fixpoint degree (e : expression) : nat :=
  match e with
  | Coordinate _ | Difference _ _ => 1
  | Constant _ => 0
  | Sum x y | Minus x y => degree x
  | Product x y => degree x + degree y
  | Negation x => degree x
  end.
Fixpoint mass (e : expression) : R :=
  match e with
  | Coordinate _ | Difference _ _ => 1
  | Constant c => Rabs (fl (IZR c))
  | Sum x y | Minus x y => fl (mass x + mass y)
  | Product x y => fl (mass x * mass y)
  | Negation x => mass x
  end.
Fixpoint allowances (e : expression) : R :=
  match e with
  | Coordinate _ | Difference _ _ | Constant _ => 0
  | Sum x y | Minus x y => fl (allowances x + allowances y)
  | Product x y =>
      fl (fl (2 * fl (fl (mass x * allowances y) + fl (mass y * allowances x))) + 2)
  | Negation x => allowances x
  end.
Section Filter.

Variable M : R.

(** power<Exponent>(x): by squares if the exponent is even. *)
Fixpoint code_power (fuel n : nat) (x : R) : R :=
  match fuel with
  | O => x
  | S fuel =>
      if (n <=? 1)%nat then x
      else if Nat.even n then code_power fuel (Nat.div2 n) (fl (x * x))
      else fl (code_power fuel (n - 1) x * x)
  end.
Definition computed_power (n : nat) : R := code_power n n M.
Definition semi_static_bound (e : expression) : R :=
  fl (fl (filter_constant p emin (roundings e) / 2) *
      fl (fl (fl (2 * mass e) * computed_power (degree e)) + fl (fl (2 * allowances e) * tau))).
(** The code trusts m and a below 2^p. A constant 0 has an infinite mass, and so do all expressions with it. *)
Fixpoint constants_not_zero (e : expression) : bool :=
  match e with
  | Coordinate _ | Difference _ _ => true
  | Constant c => negb (c =? 0)%Z
  | Sum x y | Minus x y | Product x y => constants_not_zero x && constants_not_zero y
  | Negation x => constants_not_zero x
  end.
Definition trusted (e : expression) : bool :=
  constants_not_zero e && Rlt_bool (mass e) (IZR (2 ^ p)) && Rlt_bool (allowances e) (IZR (2 ^ p)).
Definition semi_static_sign (e : expression) : sign :=
  if trusted e && Rlt_bool (semi_static_bound e) (Rabs (value e)) then
    if Rlt_bool 0 (value e) then positive else negative
  else uncertain.

(** m and a in exact arithmetic, and conditions under which they are the computed ones. *)
Fixpoint whole_mass (e : expression) : Z :=
  match e with
  | Coordinate _ | Difference _ _ => 1
  | Constant c => Z.abs c
  | Sum x y | Minus x y => whole_mass x + whole_mass y
  | Product x y => whole_mass x * whole_mass y
  | Negation x => whole_mass x
  end%Z.
Fixpoint whole_allowances (e : expression) : Z :=
  match e with
  | Coordinate _ | Difference _ _ | Constant _ => 0
  | Sum x y | Minus x y => whole_allowances x + whole_allowances y
  | Product x y =>
      2 * (whole_mass x * whole_allowances y + whole_mass y * whole_allowances x) + 2
  | Negation x => whole_allowances x
  end%Z.
Fixpoint measured (e : expression) : Prop :=
  (whole_mass e <= 2 ^ p)%Z /\ (whole_allowances e <= 2 ^ p)%Z /\
  match e with
  | Coordinate c => Rabs c <= M
  | Difference a b => Rabs (fl (a - b)) <= M
  | Constant c => c <> 0%Z
  | Sum x y | Minus x y => measured x /\ measured y /\ degree x = degree y
  | Product x y => measured x /\ measured y
  | Negation x => measured x
  end.
Fixpoint homogeneous (e : expression) : Prop :=
  match e with
  | Coordinate c => Rabs c <= M
  | Difference a b => Rabs (fl (a - b)) <= M
  | Constant _ => True
  | Sum x y | Minus x y => homogeneous x /\ homogeneous y /\ degree x = degree y
  | Product x y => homogeneous x /\ homogeneous y
  | Negation x => homogeneous x
  end.

Context (M_0 : 0 <= M) (M_number : number M) (p_2 : (2 <= p)%Z) (emin_4p : (emin <= - 4 * p - 5)%Z).

Lemma whole_number n : (0 <= n <= 2 ^ p)%Z -> number (IZR n).
Proof.
  intros H. rewrite <- (Rmult_1_r (IZR n)). change 1 with (bpow radix2 0).
  apply number_integer; auto; lia.
Qed.
Lemma fl_whole n : (0 <= n <= 2 ^ p)%Z -> fl (IZR n) = IZR n.
Proof. intros H. apply rnd_exact; auto using whole_number with typeclass_instances. Qed.
Lemma masses e : measured e -> (1 <= whole_mass e)%Z /\ (0 <= whole_allowances e)%Z /\
  mass e = IZR (whole_mass e) /\ allowances e = IZR (whole_allowances e).
Proof.
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx];
    cbn [measured whole_mass whole_allowances mass allowances]; intros (LM & LA & H);
    try (repeat split; reflexivity || lia);
    try (destruct H as (A & B & _); destruct (IHx A) as (X1 & X2 & -> & ->), (IHy B) as (Y1 & Y2 & -> & ->);
         rewrite <- !plus_IZR, !fl_whole by lia; repeat split; lia).
  - repeat split; try lia. rewrite (fl_abs p emin), <- abs_IZR. apply fl_whole. lia.
  - destruct H as (A & B). destruct (IHx A) as (X1 & X2 & E1 & E2), (IHy B) as (Y1 & Y2 & E3 & E4).
    rewrite E1, E2, E3, E4. rewrite <- !mult_IZR.
    assert (0 <= whole_mass x * whole_allowances y)%Z by (apply Z.mul_nonneg_nonneg; lia).
    assert (0 <= whole_mass y * whole_allowances x)%Z by (apply Z.mul_nonneg_nonneg; lia).
    rewrite !fl_whole by nia. rewrite <- plus_IZR, fl_whole by lia.
    rewrite <- mult_IZR, fl_whole by lia. rewrite <- plus_IZR, fl_whole by lia.
    split; [nia |]. split; [nia |]. split; reflexivity.
  - auto.
Qed.

Lemma tau_positive : 0 < tau.
Proof. apply allowance_positive; auto; lia. Qed.
Lemma tau_small : IZR (2 ^ p) * (IZR (2 ^ p) * tau) <= / 16.
Proof.
  rewrite (allowance_exact p emin) by lia. change 2%Z with (radix_val radix2).
  rewrite IZR_Zpower by (unfold Prec_gt_0 in *; lia). rewrite <- !bpow_plus.
  replace (/ 16) with (bpow radix2 (- 4)) by (simpl; lra). apply bpow_le. simpl radix_val. lia.
Qed.

Lemma power_nonnegative n : 0 <= M ^ n.
Proof. now apply pow_le. Qed.
(** Powers of one number are both large or both small. *)
Lemma powers_alike i j : M ^ i <= 1 + M ^ i * M ^ j.
Proof.
  generalize (power_nonnegative i) (power_nonnegative j). intros P Q.
  destruct (Rle_or_lt 1 M) as [L | L].
  - assert (1 <= M ^ j) by now apply pow_R1_Rle. nra.
  - assert (M ^ i <= 1); [| nra]. rewrite <- (pow1 i). apply pow_incr. lra.
Qed.

Lemma measured_mass_covers_size e : measured e ->
  exact_size e <= IZR (whole_mass e) * M ^ degree e +
    (if (whole_allowances e =? 0)%Z then 0
     else (IZR (whole_allowances e) - 3 / 4) * tau + IZR (whole_allowances e) * tau * M ^ degree e).
Proof.
  generalize tau_positive; intros T.
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx];
    cbn [measured]; intros (LM & LA & H).
  (* the sum or difference, with or without allowances *)
  4, 5: destruct H as (A & B & D); specialize (IHx A); specialize (IHy B); rewrite <- D in IHy;
    pose proof (power_nonnegative (degree x)); destruct (masses x A) as (_ & X2 & _), (masses y B) as (_ & Y2 & _);
    cbn [StaticFilter.exact_size whole_mass whole_allowances degree]; rewrite !plus_IZR;
    set (a := whole_allowances x) in *; set (b := whole_allowances y) in *; set (D' := M ^ degree x) in *;
    destruct (Z.eqb_spec a 0) as [Ea | Ea], (Z.eqb_spec b 0) as [Eb | Eb], (Z.eqb_spec (a + b) 0) as [Ec | Ec];
    try lia; try rewrite Ea in *; try rewrite Eb in *; lra.
  - simpl. lra.
  - simpl. lra.
  - cbn [StaticFilter.exact_size whole_mass whole_allowances degree]. simpl (0 =? 0)%Z. cbv iota.
    cbn [whole_mass] in LM. rewrite (fl_abs p emin), <- abs_IZR, fl_whole by lia. simpl. lra.
  - destruct H as (A & B). specialize (IHx A). specialize (IHy B).
    destruct (masses x A) as (X1 & X2 & _), (masses y B) as (Y1 & Y2 & _).
    cbn [StaticFilter.exact_size whole_mass whole_allowances degree].
    rewrite pow_add. generalize (power_nonnegative (degree x)) (power_nonnegative (degree y))
      (powers_alike (degree x) (degree y)) (powers_alike (degree y) (degree x)).
    set (X := M ^ degree x) in *. set (Y := M ^ degree y) in *. intros PX PY L1 L2.
    assert (Bx : exact_size x <= IZR (whole_mass x) * X + IZR (whole_allowances x) * tau * (1 + X)).
    { apply Rle_trans with (1 := IHx). apply Rplus_le_compat_l.
      destruct (Z.eqb_spec (whole_allowances x) 0) as [-> |]; lra. }
    assert (By : exact_size y <= IZR (whole_mass y) * Y + IZR (whole_allowances y) * tau * (1 + Y)).
    { apply Rle_trans with (1 := IHy). apply Rplus_le_compat_l.
      destruct (Z.eqb_spec (whole_allowances y) 0) as [-> |]; lra. }
    destruct (Z.eqb_spec (2 * (whole_mass x * whole_allowances y + whole_mass y * whole_allowances x) + 2) 0)
      as [E | _]; [nia |].
    generalize (exact_size_nonnegative p emin ltac:(lia) x)
      (exact_size_nonnegative p emin ltac:(lia) y). intros Sx Sy.
    assert (Ax : measured x) by exact A. assert (Ay : measured y) by exact B.
    assert (HX : (whole_allowances x <= 2 ^ p)%Z) by (destruct x; apply A).
    assert (HY : (whole_allowances y <= 2 ^ p)%Z) by (destruct y; apply B).
    rewrite plus_IZR, !mult_IZR, plus_IZR, !mult_IZR.
    apply IZR_le in X1, Y1, X2, Y2, HX, HY.
    set (mx := IZR (whole_mass x)) in *. set (my := IZR (whole_mass y)) in *.
    set (ax := IZR (whole_allowances x)) in *. set (ay := IZR (whole_allowances y)) in *.
    (* products of allowances are negligible *)
    assert (Tiny : ax * (ay * tau) <= / 16).
    { apply Rle_trans with (2 := tau_small). apply Rmult_le_compat; auto.
      - apply Rmult_le_pos; lra.
      - apply Rmult_le_compat_r; lra. }
    assert (P : exact_size x * exact_size y <=
                (mx * X + ax * tau * (1 + X)) * (my * Y + ay * tau * (1 + Y)))
      by (apply Rmult_le_compat; lra).
    apply Rle_trans with (1 := Rplus_le_compat_r tau _ _ P).
    assert (Q : forall c d, 0 <= c -> 0 <= d -> 0 <= c * d) by (intros; now apply Rmult_le_pos).
    assert (T1 : mx * X * (ay * tau * (1 + Y)) <= 2 * (mx * ay) * tau * (1 + X * Y)).
    { replace (mx * X * (ay * tau * (1 + Y))) with (mx * ay * tau * (X + X * Y)) by ring.
      replace (2 * (mx * ay) * tau * (1 + X * Y)) with (mx * ay * tau * (2 * (1 + X * Y))) by ring.
      generalize (Q X Y PX PY). intros. apply Rmult_le_compat_l; [| lra].
      apply Q; [apply Q |]; lra. }
    assert (T2 : ax * tau * (1 + X) * (my * Y) <= 2 * (my * ax) * tau * (1 + X * Y)).
    { replace (ax * tau * (1 + X) * (my * Y)) with (my * ax * tau * (Y + X * Y)) by ring.
      replace (2 * (my * ax) * tau * (1 + X * Y)) with (my * ax * tau * (2 * (1 + X * Y))) by ring.
      generalize (Q X Y PX PY). intros. apply Rmult_le_compat_l; [| lra].
      apply Q; [apply Q |]; lra. }
    assert (T3 : ax * tau * (1 + X) * (ay * tau * (1 + Y)) <= / 4 * tau * (1 + X * Y)).
    { replace (ax * tau * (1 + X) * (ay * tau * (1 + Y)))
        with (ax * (ay * tau) * (tau * ((1 + X) * (1 + Y)))) by ring.
      generalize (Q X Y PX PY). intros.
      apply Rle_trans with (/ 16 * (tau * (4 * (1 + X * Y)))).
      - apply Rmult_le_compat; try lra.
        + apply Q; [| apply Q]; lra.
        + apply Q; [| apply Q]; lra.
        + apply Rmult_le_compat_l; lra.
      - lra. }
    generalize (Q X Y PX PY). intros.
    assert (0 <= tau * (X * Y)) by (apply Q; lra). lra.
  - cbn [StaticFilter.exact_size whole_mass whole_allowances degree]. auto.
Qed.

(** The power as computed. *)
Notation power := (power p).
Lemma eta_p : eta * IZR (2 ^ p) <= / 4.
Proof.
  change 2%Z with (radix_val radix2). rewrite IZR_Zpower by (unfold Prec_gt_0 in *; lia).
  unfold Format.eta. rewrite <- bpow_plus. replace (/ 4) with (bpow radix2 (- 2)) by (simpl; lra).
  apply bpow_le. lia.
Qed.
Lemma product_upper z : 0 <= z -> z <= (1 + u) * fl z + eta.
Proof.
  intros P. generalize (u_small p ltac:(lia)) (eta_positive emin). intros U E.
  assert (0 <= fl z) by (apply rnd_nonnegative; auto with typeclass_instances).
  assert (0 <= u * fl z) by (apply Rmult_le_pos; lra).
  destruct (Rlt_or_le z (smallest_normal p emin)) as [C | C].
  - generalize (rnd_absolute p emin nearest _ _ (rounding_error_nearest p emin ltac:(lia)) z P C). lra.
  - generalize (normal_upper p emin z C). lra.
Qed.
Lemma shifted_power y k : 0 <= y <= 1 -> 2 * INR k * eta <= 1 ->
  (y + eta) ^ k <= y ^ k + 2 * INR k * eta.
Proof.
  intros Y. generalize (eta_positive emin). intros E. induction k as [| k IH]; [simpl; lra |].
  rewrite S_INR. intros H. generalize (pos_INR k). intros K.
  assert (0 <= INR k * eta) by (apply Rmult_le_pos; lra).
  specialize (IH ltac:(lra)). rewrite <- !tech_pow_Rmult.
  assert (0 <= y ^ k <= 1).
  { split; [apply pow_le; lra |]. rewrite <- (pow1 k). apply pow_incr. lra. }
  apply Rle_trans with ((y + eta) * (y ^ k + 2 * INR k * eta)).
  - apply Rmult_le_compat_l; lra.
  - nra.
Qed.
Lemma number_1 : number 1.
Proof. change 1 with (bpow radix2 0). apply number_power; auto. lia. Qed.

Lemma even_half n : Nat.even n = true -> n = (2 * Nat.div2 n)%nat.
Proof.
  intros H. apply Nat.even_spec in H. destruct H as [k ->].
  now rewrite Nat.div2_double.
Qed.
Lemma power_lower fuel : forall n x, (1 <= n <= fuel)%nat -> number x -> 0 <= x ->
  2 * INR n * eta <= 1 ->
  0 <= code_power fuel n x /\
  (x <= 1 -> x ^ n <= power n * (code_power fuel n x + 2 * INR n * eta)) /\
  (1 <= x -> 1 <= code_power fuel n x /\ x ^ n <= power n * code_power fuel n x).
Proof.
  generalize (u_small p ltac:(lia)) (eta_positive emin). intros U E.
  induction fuel as [| fuel IH]; intros n x Hn N P Hs; [lia |]. cbn [code_power].
  assert (One : forall k, 1 <= power k) by (intros; apply power_1; lia).
  destruct (Nat.leb_spec n 1) as [L | L].
  { replace n with 1%nat in * by lia. unfold StaticFilter.power. simpl. split; auto.
    assert (0 <= u * x) by (apply Rmult_le_pos; lra).
    split; intros; [| split]; simpl in Hs; try lra. assert (0 <= u * eta) by nra. lra. }
  destruct (Nat.even n) eqn:Ev.
  - apply even_half in Ev. set (k := Nat.div2 n) in *.
    assert (Sq : 0 <= x * x) by (apply Rmult_le_pos; auto).
    assert (Ny : number (fl (x * x))) by (apply rnd_number; auto with typeclass_instances).
    assert (Py : 0 <= fl (x * x)) by (apply rnd_nonnegative; auto with typeclass_instances).
    assert (Kn : INR n = 2 * INR k) by (rewrite Ev, mult_INR; reflexivity).
    rewrite Kn in Hs.
    generalize (pos_INR k). intros Pk.
    assert (0 <= INR k * eta) by (apply Rmult_le_pos; lra).
    destruct (IH k (fl (x * x)) ltac:(lia) Ny Py ltac:(lra)) as (I1 & I2 & I3).
    set (y := fl (x * x)) in *. set (c := code_power fuel k y) in *.
    rewrite Ev. replace (2 * k)%nat with (k + k)%nat by lia.
    rewrite pow_add, <- Rpow_mult_distr. unfold StaticFilter.power. rewrite pow_add.
    fold (power k). split; auto. split; intros X.
    + assert (Y1 : y <= 1) by (apply rnd_below; auto using number_1 with typeclass_instances; nra).
      specialize (I2 Y1). generalize (product_upper (x * x) Sq). fold y. intros Z.
      apply Rle_trans with (((1 + u) * (y + eta)) ^ k).
      { apply pow_incr. split; auto. assert (0 <= u * eta) by (apply Rmult_le_pos; lra). lra. }
      rewrite Rpow_mult_distr. fold (power k). rewrite Rmult_assoc.
      apply Rmult_le_compat_l; [generalize (One k); lra |].
      apply Rle_trans with (1 := shifted_power y k ltac:(lra) ltac:(lra)).
      rewrite plus_INR. generalize (One k). intros Q.
      assert (1 * (2 * INR k * eta) <= power k * (2 * INR k * eta)) by (apply Rmult_le_compat_r; lra).
      lra.
    + assert (Y1 : 1 <= y) by (apply rnd_above; auto using number_1 with typeclass_instances; nra).
      destruct (I3 Y1) as [I4 I5]. split; auto.
      assert (Z : x * x <= (1 + u) * y).
      { apply (normal_upper p emin). apply Rle_trans with 1; [| nra].
        change 1 with (bpow radix2 0). apply bpow_le. unfold Prec_gt_0 in *. lia. }
      apply Rle_trans with (((1 + u) * y) ^ k); [apply pow_incr; lra |].
      rewrite Rpow_mult_distr. fold (power k). rewrite Rmult_assoc.
      apply Rmult_le_compat_l; [generalize (One k); lra | exact I5].
  - assert (exists k, n = S k) as [k ->] by (exists (n - 1)%nat; lia).
    replace (S k - 1)%nat with k by lia. rewrite S_INR in *.
    generalize (pos_INR k). intros Pk. assert (0 <= INR k * eta) by (apply Rmult_le_pos; lra).
    destruct (IH k x ltac:(lia) N P ltac:(lra)) as (I1 & I2 & I3).
    set (c := code_power fuel k x) in *.
    assert (Pc : 0 <= c * x) by (apply Rmult_le_pos; auto).
    assert (Pf : 0 <= fl (c * x)) by (apply rnd_nonnegative; auto with typeclass_instances).
    rewrite <- tech_pow_Rmult, power_succ. generalize (One k). intros Q. split; auto. split; intros X.
    + specialize (I2 X). generalize (product_upper (c * x) Pc). intros Z.
      apply Rle_trans with (x * (power k * (c + 2 * INR k * eta))); [apply Rmult_le_compat_l; auto |].
      replace (x * (power k * (c + 2 * INR k * eta)))
        with (power k * (c * x + x * (2 * INR k * eta))) by ring.
      replace ((1 + u) * power k * (fl (c * x) + 2 * (INR k + 1) * eta))
        with (power k * ((1 + u) * (fl (c * x) + 2 * (INR k + 1) * eta))) by ring.
      apply Rmult_le_compat_l; [lra |].
      assert (x * (2 * INR k * eta) <= 1 * (2 * INR k * eta)) by (apply Rmult_le_compat_r; lra).
      assert (0 <= u * (2 * (INR k + 1) * eta)) by (apply Rmult_le_pos; lra). lra.
    + destruct (I3 X) as [I4 I5].
      assert (F : 1 <= fl (c * x)) by (apply rnd_above; auto using number_1 with typeclass_instances; nra).
      split; auto. assert (Z : c * x <= (1 + u) * fl (c * x)).
      { apply (normal_upper p emin). apply Rle_trans with 1; [| nra].
        change 1 with (bpow radix2 0). apply bpow_le. unfold Prec_gt_0 in *. lia. }
      apply Rle_trans with (x * (power k * c)); [apply Rmult_le_compat_l; auto |].
      replace (x * (power k * c)) with (power k * (c * x)) by ring.
      replace ((1 + u) * power k * fl (c * x)) with (power k * ((1 + u) * fl (c * x))) by ring.
      apply Rmult_le_compat_l; lra.
Qed.
Lemma computed_power_lower n : (1 <= n)%nat -> 2 * INR n * eta <= 1 ->
  M ^ n <= power n * (computed_power n + 2 * INR n * eta) /\ 0 <= computed_power n.
Proof.
  intros L H. destruct (power_lower n n M ltac:(lia) M_number M_0 H) as (I1 & I2 & I3).
  split; auto. generalize (eta_positive emin) (pos_INR n). intros E P.
  destruct (Rle_or_lt M 1) as [C | C]; [now apply I2 |].
  destruct (I3 ltac:(lra)) as [_ I]. apply Rle_trans with (1 := I).
  apply Rmult_le_compat_l; [generalize (power_1 p ltac:(lia) n); lra |].
  assert (0 <= INR n * eta) by (apply Rmult_le_pos; lra). unfold computed_power. lra.
Qed.

Lemma degree_roundings e : measured e -> (degree e <= S (roundings e))%nat.
Proof.
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx];
    cbn [measured degree StaticFilter.roundings]; intros (_ & _ & H); try lia.
  - destruct H as (A & _). specialize (IHx A). lia.
  - destruct H as (A & _). specialize (IHx A). lia.
  - destruct H as (A & B). specialize (IHx A). specialize (IHy B). lia.
  - auto.
Qed.

(** The slack: constant(k) grows by 4k + 8 units of u, of which roundings of sizes take about half. *)
Lemma slack_enough t : 0 <= t -> 64 * (t + 3 * u) <= 1 ->
  (1 + u) ^ 6 * (1 + t) * ((1 + (t + u) + (t + u) * (t + u)) * (1 + u / 16)) <= 1 + 4 * t + 8 * u.
Proof.
  intros T H. generalize (u_positive p). intros U.
  assert (P2 : (1 + u) ^ 2 <= 1 + 2.01 * u) by (simpl; nra).
  assert (P6 : (1 + u) ^ 6 <= 1 + 6.2 * u) by nra.
  set (y := t + u) in *. assert (Y : 0 <= y <= / 64) by (unfold y; lra).
  assert (A : (1 + t) * (1 + y + y * y) <= 1 + 2.05 * t + 1.05 * u).
  { assert (y * y <= / 64 * y) by (apply Rmult_le_compat_r; lra).
    assert (t * (y + y * y) <= / 64 * (y + y * y)) by (apply Rmult_le_compat_r; nra).
    unfold y in *. lra. }
  assert (B : (1 + u) ^ 6 * (1 + u / 16) <= 1 + 6.3 * u).
  { apply Rle_trans with ((1 + 6.2 * u) * (1 + u / 16)); [apply Rmult_le_compat_r; lra | nra]. }
  replace ((1 + u) ^ 6 * (1 + t) * ((1 + y + y * y) * (1 + u / 16)))
    with ((1 + u) ^ 6 * (1 + u / 16) * ((1 + t) * (1 + y + y * y))) by ring.
  assert (0 <= (1 + u) ^ 6) by (apply pow_le; lra).
  apply Rle_trans with ((1 + 6.3 * u) * (1 + 2.05 * t + 1.05 * u)).
  - apply Rmult_le_compat; auto.
    + apply Rmult_le_pos; lra.
    + apply Rmult_le_pos; [lra |]. assert (0 <= y * y) by (apply Rmult_le_pos; lra). lra.
  - nra.
Qed.

Lemma measured_bound_covers e : admissible p emin e -> measured e ->
  (1 <= whole_allowances e)%Z -> (1 <= degree e)%nat -> (1 <= roundings e)%nat ->
  64 * INR (roundings e + 3) * u <= 1 ->
  (whole_mass e * Z.of_nat (degree e) <= 2 ^ (2 * p - 6))%Z ->
  Rabs (unrounded p emin e - exact e) <= semi_static_bound e.
Proof.
  intros A Ho Ha Hd Hr H Hm.
  apply Rle_trans with (1 := proj2 (expression_near p emin ltac:(lia) ltac:(lia) e A)).
  set (k := roundings e) in *. set (d := degree e) in *.
  generalize (u_positive p) (eta_positive emin) tau_positive. intros U E T.
  destruct (masses e Ho) as (M1 & _ & Em & Ea).
  assert (LM : (whole_mass e <= 2 ^ p)%Z /\ (whole_allowances e <= 2 ^ p)%Z)
    by (destruct e; split; apply Ho).
  unfold semi_static_bound. rewrite Em, Ea. fold k d.
  generalize (measured_mass_covers_size e Ho). fold d.
  destruct (Z.eqb_spec (whole_allowances e) 0) as [Z | _]; [lia |]. intros S0.
  set (mz := whole_mass e) in *. set (az := whole_allowances e) in *.
  assert (Dr : (d <= S k)%nat) by now apply degree_roundings.
  (* k u and the like *)
  assert (Kp : 64 * (INR k * u + 3 * u) <= 1).
  { rewrite plus_INR in H. simpl (INR 3) in H. lra. }
  assert (K0 : 1 <= INR k) by (change 1 with (INR 1); now apply le_INR).
  set (t := INR k * u) in *. assert (T0 : u <= t) by (unfold t; nra).
  assert (Up : u * IZR (2 ^ p) = 1).
  { change 2%Z with (radix_val radix2). rewrite IZR_Zpower by (unfold Prec_gt_0 in *; lia).
    unfold Format.u. rewrite <- bpow_plus. now replace (- p + p)%Z with 0%Z by lia. }
  assert (Dp : INR d <= IZR (2 ^ p)).
  { apply Rmult_le_reg_l with u; auto. rewrite Up. apply le_INR in Dr. rewrite S_INR in Dr.
    assert (u * INR d <= u * (INR k + 1)) by (apply Rmult_le_compat_l; lra). unfold t in *. lra. }
  generalize (pos_INR d). intros D0.
  assert (De : 2 * INR d * eta <= 1).
  { generalize eta_p. intros. assert (INR d * eta <= IZR (2 ^ p) * eta) by (apply Rmult_le_compat_r; lra).
    lra. }
  destruct (computed_power_lower d Hd De) as [Pw P0]. set (P := computed_power d) in *.
  assert (m1 : 1 <= IZR mz) by now apply IZR_le.
  assert (a1 : 1 <= IZR az) by now apply IZR_le.
  (* underflow of the power *)
  assert (Te : IZR mz * (2 * INR d * eta) <= tau / 64).
  { apply IZR_le in Hm. rewrite mult_IZR, <- INR_IZR_INZ in Hm.
    change (2 ^ (2 * p - 6))%Z with (radix_val radix2 ^ (2 * p - 6))%Z in Hm.
    assert (Q : IZR (radix_val radix2 ^ (2 * p - 6)) * eta <= tau / 128).
    { destruct (Z_le_gt_dec 0 (2 * p - 6)) as [N | N].
      - rewrite IZR_Zpower by lia. rewrite (allowance_exact p emin) by lia. unfold Format.eta, Rdiv.
        replace (/ 128) with (bpow radix2 (- 7)) by (simpl; lra). rewrite <- !bpow_plus.
        apply bpow_le. lia.
      - rewrite Z.pow_neg_r by lia. lra. }
    assert (IZR mz * INR d * eta <= IZR (radix_val radix2 ^ (2 * p - 6)) * eta)
      by (apply Rmult_le_compat_r; lra). lra. }
  assert (Pd : power d <= 1 + (t + u) + (t + u) * (t + u)).
  { apply Rle_trans with (power (S k)).
    - apply power_le; auto; lia.
    - generalize (power_quadratic u (S k) ltac:(lra)). rewrite S_INR.
      replace ((INR k + 1) * u) with (t + u) by (unfold t; ring). intros Q. apply Q. lra. }
  set (pw := 1 + (t + u) + (t + u) * (t + u)) in *.
  assert (Mn : 0 <= M ^ d) by apply power_nonnegative.
  assert (MD : IZR mz * M ^ d <= pw * (IZR mz * P + tau / 64)).
  { apply Rle_trans with (IZR mz * (power d * (P + 2 * INR d * eta))).
    - apply Rmult_le_compat_l; lra.
    - replace (IZR mz * (power d * (P + 2 * INR d * eta)))
        with (power d * (IZR mz * P + IZR mz * (2 * INR d * eta))) by ring.
      assert (0 <= INR d * eta) by (apply Rmult_le_pos; lra).
      assert (0 <= IZR mz * P) by (apply Rmult_le_pos; lra).
      apply Rmult_le_compat; try lra.
      + generalize (power_1 p ltac:(lia) d). lra.
      + assert (0 <= IZR mz * (2 * INR d * eta)) by (apply Rmult_le_pos; lra). lra. }
  assert (AT : IZR az * tau <= u / 16).
  { apply Rmult_le_reg_l with (IZR (2 ^ p)).
    - rewrite <- (Rmult_1_l (IZR (2 ^ p))). nra.
    - replace (IZR (2 ^ p) * (u / 16)) with (/ 16) by (unfold Rdiv;
      rewrite <- Rmult_assoc, (Rmult_comm _ u), Up; ring).
      generalize tau_small. intros. apply Rle_trans with (IZR (2 ^ p) * (IZR (2 ^ p) * tau)); auto.
      apply Rmult_le_compat_l; [apply IZR_le; lia |]. apply Rmult_le_compat_r; [lra | apply IZR_le; lia]. }
  assert (S1 : exact_size e <= pw * (1 + u / 16) * (IZR mz * P) + (IZR az - / 2) * tau).
  { assert (IZR az * tau * M ^ d <= u / 16 * (IZR mz * M ^ d)).
    { apply Rmult_le_compat; try lra; [apply Rmult_le_pos; lra |]. nra. }
    apply Rle_trans with (1 := S0).
    assert ((1 + u / 16) * (IZR mz * M ^ d) <= (1 + u / 16) * (pw * (IZR mz * P + tau / 64)))
      by (apply Rmult_le_compat_l; lra).
    assert (pw * (1 + u / 16) <= 2).
    { unfold pw. assert (0 <= t + u <= / 64) by lra.
      assert ((t + u) * (t + u) <= / 64 * (t + u)) by (apply Rmult_le_compat_r; lra). nra. }
    assert (pw * (1 + u / 16) * (tau / 64) <= 2 * (tau / 64)) by (apply Rmult_le_compat_r; lra).
    lra. }
  (* the computed bound *)
  assert (Ptau : number (2 * IZR az * tau)).
  { rewrite (allowance_exact p emin) by lia.
    replace (2 * IZR az * bpow radix2 (emin + 2 * p + 1))
      with (IZR az * bpow radix2 (emin + 2 * p + 1 + 1)) by (rewrite bpow_plus;
        change (bpow radix2 1) with 2; ring).
    apply number_integer; auto; lia. }
  assert (Twice : forall z, (0 <= z <= 2 ^ p)%Z -> fl (2 * IZR z) = 2 * IZR z).
  { intros z Hz. apply rnd_exact; auto with typeclass_instances.
    replace (2 * IZR z) with (IZR z * bpow radix2 1) by (change (bpow radix2 1) with 2; ring).
    apply number_integer; auto; lia. }
  rewrite !Twice by lia. rewrite (rnd_exact p emin nearest _ Ptau).
  set (a := fl (2 * IZR mz * P)). set (s := fl (a + 2 * IZR az * tau)).
  assert (PP : 0 <= IZR mz * P) by (apply Rmult_le_pos; lra).
  assert (A1 : 2 * (IZR mz * P) <= (1 + u) * a + eta).
  { rewrite <- Rmult_assoc. apply product_upper. rewrite Rmult_assoc. lra. }
  assert (A0 : 0 <= a) by (apply rnd_nonnegative; auto with typeclass_instances; rewrite Rmult_assoc; lra).
  assert (Na : number a) by (apply rnd_number; auto with typeclass_instances).
  assert (AzT : tau <= IZR az * tau).
  { rewrite <- (Rmult_1_l tau) at 1. apply Rmult_le_compat_r; lra. }
  assert (A2 : a + 2 * IZR az * tau <= (1 + u) * s) by (apply (sum_upper p emin); auto; lra).
  assert (Ts : tau <= s).
  { apply (rnd_above p emin nearest); [apply rnd_number; auto with typeclass_instances | lra]. }
  destruct (filter_constant_lower p emin ltac:(lia) ltac:(lia) k Hr H) as [C1 C2].
  set (C := filter_constant p emin k) in *.
  assert (Nh : number (u / 2)).
  { unfold Format.u, Rdiv. replace (/ 2) with (bpow radix2 (- 1)) by reflexivity.
    rewrite <- bpow_plus. apply number_power; auto. unfold Prec_gt_0 in *. lia. }
  assert (Ch : u / 2 <= fl (C / 2)) by (apply rnd_above; auto with typeclass_instances; lra).
  assert (C3 : C / 2 <= (1 + u) * fl (C / 2)).
  { apply (normal_upper p emin). apply Rle_trans with (u / 2); [| lra].
    unfold Format.u, Rdiv. replace (/ 2) with (bpow radix2 (- 1)) by reflexivity.
    rewrite <- bpow_plus. apply bpow_le. unfold Prec_gt_0 in *. lia. }
  set (c := fl (C / 2)) in *.
  assert (B1 : c * s <= (1 + u) * fl (c * s)).
  { apply (normal_upper p emin). apply Rle_trans with (u / 2 * tau).
    - rewrite (allowance_exact p emin) by lia. unfold Format.u, Rdiv.
      replace (/ 2) with (bpow radix2 (- 1)) by reflexivity.
      rewrite <- !bpow_plus. apply bpow_le. lia.
    - apply Rmult_le_compat; lra. }
  set (b := fl (c * s)) in *.
  (* together *)
  assert (Et : eta <= tau / 4).
  { rewrite (allowance_exact p emin) by lia. unfold Format.eta, Rdiv.
    replace (/ 4) with (bpow radix2 (- 2)) by (simpl; lra). rewrite <- bpow_plus. apply bpow_le. lia. }
  assert (S2 : 2 * (IZR mz * P + (IZR az - / 4) * tau) <= (1 + u) ^ 2 * s).
  { apply Rle_trans with ((1 + u) * (a + 2 * IZR az * tau)).
    - assert (0 <= u * (2 * IZR az * tau)) by (apply Rmult_le_pos; lra). lra.
    - replace ((1 + u) ^ 2 * s) with ((1 + u) * ((1 + u) * s)) by ring.
      apply Rmult_le_compat_l; lra. }
  set (g := IZR mz * P + (IZR az - / 4) * tau) in *.
  assert (G0 : 0 <= g) by (unfold g; assert (0 <= (IZR az - / 4) * tau) by (apply Rmult_le_pos; lra); lra).
  assert (F1 : t * (1 + INR (4 * k + 8) * u) * g <= (1 + u) ^ 6 * b).
  { apply Rle_trans with ((1 + u) * (1 + u) * C * g); [apply Rmult_le_compat_r; auto |].
    replace ((1 + u) * (1 + u) * C * g) with ((1 + u) ^ 2 * ((C / 2) * (2 * g))) by field.
    replace ((1 + u) ^ 6 * b) with ((1 + u) ^ 2 * ((1 + u) ^ 3 * ((1 + u) * b))) by ring.
    apply Rmult_le_compat_l; [apply pow_le; lra |].
    apply Rle_trans with ((1 + u) * c * ((1 + u) ^ 2 * s)).
    - apply Rmult_le_compat; lra.
    - replace ((1 + u) * c * ((1 + u) ^ 2 * s)) with ((1 + u) ^ 3 * (c * s)) by ring.
      apply Rmult_le_compat_l; [apply pow_le; lra | exact B1]. }
  assert (L : power (Nat.pred k) - 1 <= t * (1 + t)).
  { assert (Kk : INR (Nat.pred k) * u <= t).
    { apply Rmult_le_compat_r; [lra |]. apply le_INR. lia. }
    assert (0 <= INR (Nat.pred k) * u) by (apply Rmult_le_pos; [apply pos_INR | lra]).
    generalize (power_quadratic u (Nat.pred k) ltac:(lra) ltac:(lra)). fold (power (Nat.pred k)). nra. }
  assert (Sl : (1 + u) ^ 6 * (1 + t) * (pw * (1 + u / 16)) <= 1 + INR (4 * k + 8) * u).
  { apply Rle_trans with (1 := slack_enough t ltac:(lra) Kp).
    rewrite plus_INR, mult_INR. simpl (INR 4). simpl (INR 8). unfold t. lra. }
  assert (Q1 : 1 <= (1 + u) ^ 6) by (apply pow_R1_Rle; lra).
  assert (Q2 : 1 <= pw * (1 + u / 16)).
  { unfold pw. assert (0 <= (t + u) * (t + u)) by (apply Rmult_le_pos; lra).
    apply Rle_trans with (1 * 1); [lra | apply Rmult_le_compat; lra]. }
  assert (S3 : exact_size e <= pw * (1 + u / 16) * g).
  { apply Rle_trans with (1 := S1). unfold g.
    assert (1 * ((IZR az - / 4) * tau) <= pw * (1 + u / 16) * ((IZR az - / 4) * tau))
      by (apply Rmult_le_compat_r; lra). lra. }
  apply Rmult_le_reg_l with ((1 + u) ^ 6); [lra |].
  apply Rle_trans with (2 := F1).
  apply Rle_trans with ((1 + u) ^ 6 * (t * (1 + t) * (pw * (1 + u / 16) * g))).
  - apply Rmult_le_compat_l; [lra |].
    apply Rmult_le_compat; auto.
    + generalize (power_1 p ltac:(lia) (Nat.pred k)). lra.
    + apply (exact_size_nonnegative p emin ltac:(lia)).
  - replace ((1 + u) ^ 6 * (t * (1 + t) * (pw * (1 + u / 16) * g)))
      with (t * ((1 + u) ^ 6 * (1 + t) * (pw * (1 + u / 16))) * g) by ring.
    apply Rmult_le_compat_r; auto. apply Rmult_le_compat_l; lra.
Qed.

(** Trusted counts are exact: m and a of a subexpression do not exceed those of the whole. *)
Lemma fl_whole_below n : (0 <= n)%Z -> fl (IZR n) < IZR (2 ^ p) -> fl (IZR n) = IZR n /\ (n < 2 ^ p)%Z.
Proof.
  intros P L. assert (B : (n < 2 ^ p)%Z).
  { apply Z.lt_nge. intros C. apply IZR_le in C. apply (Rlt_not_le _ _ L).
    apply rnd_above; auto using whole_number with typeclass_instances.
    apply whole_number. split; [apply Z.pow_nonneg; lia | lia]. }
  split; auto. apply fl_whole. lia.
Qed.
Lemma fl_above n x : (0 <= n <= 2 ^ p)%Z -> IZR n <= x -> IZR n <= fl x.
Proof. intros P L. apply rnd_above; auto using whole_number with typeclass_instances. Qed.
Lemma number_mass e : number (mass e) /\ number (allowances e).
Proof.
  assert (N : forall x, number (fl x)) by (intros; apply rnd_number; auto with typeclass_instances).
  induction e; cbn [mass allowances]; split; auto using number_1, number_0; try apply N; try apply IHe.
  now apply number_abs.
Qed.
(** A number is at most its sum with a nonnegative one, and at most its product with a factor >= 1. *)
Lemma part_of_sum x y : number x -> 0 <= y -> x <= fl (x + y).
Proof. intros N P. apply rnd_above; auto with typeclass_instances. lra. Qed.
Lemma part_of_product x y : number x -> 0 <= x -> 1 <= y -> x <= fl (x * y).
Proof. intros N P Q. apply rnd_above; auto with typeclass_instances. nra. Qed.
Lemma mass_1 e : constants_not_zero e = true -> 1 <= mass e /\ 0 <= allowances e.
Proof.
  assert (P2 : (1 <= 2 ^ p)%Z) by (generalize (Z.pow_le_mono_r 2 0 p); unfold Prec_gt_0 in p_positive; lia).
  assert (Z0 : forall x, 0 <= x -> 0 <= fl x) by (intros; now apply rnd_nonnegative;
    auto with typeclass_instances).
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx];
    cbn [constants_not_zero mass allowances]; try (intros _; lra).
  - intros C. apply negb_true_iff, Z.eqb_neq in C. split; [| lra]. rewrite (fl_abs p emin), <- abs_IZR.
    apply (fl_above 1); [lia |]. apply IZR_le. lia.
  - intros H. apply andb_prop in H. destruct H as (A & B).
    destruct (IHx A), (IHy B), (number_mass x), (number_mass y).
    split; [| apply Z0; lra]. apply Rle_trans with (mass x); auto. apply part_of_sum; auto. lra.
  - intros H. apply andb_prop in H. destruct H as (A & B).
    destruct (IHx A), (IHy B), (number_mass x), (number_mass y).
    split; [| apply Z0; lra]. apply Rle_trans with (mass x); auto. apply part_of_sum; auto. lra.
  - intros H. apply andb_prop in H. destruct H as (A & B).
    destruct (IHx A), (IHy B), (number_mass x), (number_mass y). split.
    + apply Rle_trans with (mass x); auto. apply part_of_product; auto. lra.
    + apply Z0. assert (0 <= fl (2 * fl (fl (mass x * allowances y) + fl (mass y * allowances x)))); [| lra].
      apply Z0, Rmult_le_pos; [lra |]. apply Z0, Rplus_le_le_0_compat; apply Z0, Rmult_le_pos; lra.
  - auto.
Qed.
Lemma trusted_measured e : homogeneous e -> constants_not_zero e = true ->
  mass e < IZR (2 ^ p) -> allowances e < IZR (2 ^ p) ->
  measured e /\ (whole_mass e < 2 ^ p)%Z /\ (whole_allowances e < 2 ^ p)%Z.
Proof.
  assert (P2 : (1 < 2 ^ p)%Z).
  { unfold Prec_gt_0 in p_positive. change 1%Z with (2 ^ 0)%Z. apply Z.pow_lt_mono_r; lia. }
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx];
    cbn [homogeneous constants_not_zero mass allowances measured whole_mass whole_allowances].
  4, 5: intros (Hx & Hy & D) C M2 A2; apply andb_prop in C; destruct C as (Cx & Cy), (mass_1 x Cx), (mass_1 y Cy);
    pose proof (number_mass x) as (Nx & Ax); pose proof (number_mass y) as (Ny & Ay);
    assert (mass x <= fl (mass x + mass y) /\ mass y <= fl (mass x + mass y)) as (X1 & X2)
      by (split; [| rewrite Rplus_comm]; apply part_of_sum; auto; lra);
    assert (allowances x <= fl (allowances x + allowances y) /\ allowances y <= fl (allowances x + allowances y)) as (X3 & X4)
      by (split; [| rewrite Rplus_comm]; apply part_of_sum; auto);
    destruct (IHx Hx Cx ltac:(lra) ltac:(lra)) as (Mx & _ & _), (IHy Hy Cy ltac:(lra) ltac:(lra)) as (My & _ & _);
    destruct (masses x Mx) as (U1 & U2 & E1 & E2), (masses y My) as (V1 & V2 & E3 & E4);
    rewrite E1, E3, <- plus_IZR in M2; rewrite E2, E4, <- plus_IZR in A2;
    apply fl_whole_below in M2, A2; try lia; repeat split; auto; lia.
  - intros H _ _ _. repeat split; auto; lia.
  - intros H _ _ _. repeat split; auto; lia.
  - intros _ C L _. apply negb_true_iff, Z.eqb_neq in C. rewrite (fl_abs p emin), <- abs_IZR in L.
    apply fl_whole_below in L; [| lia]. repeat split; auto; lia.
  - intros (Hx & Hy) C M2 A2. apply andb_prop in C. destruct C as (Cx & Cy).
    destruct (mass_1 x Cx), (mass_1 y Cy), (number_mass x), (number_mass y).
    assert (N : forall r, number (fl r)) by (intros; apply rnd_number; auto with typeclass_instances).
    assert (Z0 : forall r, 0 <= r -> 0 <= fl r) by (intros; now apply rnd_nonnegative;
      auto with typeclass_instances).
    assert (X1 : mass x <= fl (mass x * mass y)) by (apply part_of_product; auto; lra).
    assert (X2 : mass y <= fl (mass x * mass y)) by (rewrite Rmult_comm; apply part_of_product; auto; lra).
    set (a := fl (mass x * allowances y)) in *. set (b := fl (mass y * allowances x)) in *.
    assert (Pa : 0 <= a) by (apply Z0, Rmult_le_pos; lra).
    assert (Pb : 0 <= b) by (apply Z0, Rmult_le_pos; lra).
    assert (X3 : allowances y <= a) by (unfold a; rewrite Rmult_comm; apply part_of_product; auto).
    assert (X4 : allowances x <= b) by (unfold b; rewrite Rmult_comm; apply part_of_product; auto).
    assert (X5 : a <= fl (a + b)) by (apply part_of_sum; auto; apply N).
    assert (X6 : b <= fl (a + b)) by (rewrite Rplus_comm; apply part_of_sum; auto; apply N).
    set (s := fl (a + b)) in *.
    assert (X7 : s <= fl (2 * s)) by (rewrite Rmult_comm; apply part_of_product; [apply N | lra | lra]).
    set (d := fl (2 * s)) in *.
    assert (X8 : d <= fl (d + 2)) by (apply part_of_sum; [apply N | lra]).
    destruct (IHx Hx Cx ltac:(lra) ltac:(lra)) as (Mx & _ & _),
      (IHy Hy Cy ltac:(lra) ltac:(lra)) as (My & _ & _).
    destruct (masses x Mx) as (U1 & U2 & E1 & E2), (masses y My) as (V1 & V2 & E3 & E4).
    rewrite E1, E3, <- mult_IZR in M2. apply fl_whole_below in M2; [| lia].
    assert (La : a < IZR (2 ^ p)) by lra. assert (Lb : b < IZR (2 ^ p)) by lra.
    assert (Ls : s < IZR (2 ^ p)) by lra. assert (Ld : d < IZR (2 ^ p)) by lra.
    unfold a in La. rewrite E1, E4, <- mult_IZR in La. apply fl_whole_below in La; [| lia].
    unfold b in Lb. rewrite E3, E2, <- mult_IZR in Lb. apply fl_whole_below in Lb; [| lia].
    assert (Ea : a = IZR (whole_mass x * whole_allowances y)) by (unfold a; rewrite E1, E4, <- mult_IZR;
      apply La).
    assert (Eb : b = IZR (whole_mass y * whole_allowances x)) by (unfold b; rewrite E3, E2, <- mult_IZR;
      apply Lb).
    unfold s in Ls. rewrite Ea, Eb, <- plus_IZR in Ls. apply fl_whole_below in Ls; [| lia].
    assert (Es : s = IZR (whole_mass x * whole_allowances y + whole_mass y * whole_allowances x))
      by (unfold s; rewrite Ea, Eb, <- plus_IZR; apply Ls).
    unfold d in Ld. rewrite Es, <- mult_IZR in Ld. apply fl_whole_below in Ld; [| lia].
    assert (Ed : d = IZR (2 * (whole_mass x * whole_allowances y + whole_mass y * whole_allowances x)))
      by (unfold d; rewrite Es, <- mult_IZR; apply Ld).
    rewrite Ed, <- plus_IZR in A2. apply fl_whole_below in A2; [| lia].
    repeat split; auto; lia.
  - intros Hx C M2 A2. destruct (IHx Hx C M2 A2) as (Mx & L & K). repeat split; auto; lia.
Qed.
Lemma trusted_parts e : homogeneous e -> trusted e = true ->
  measured e /\ (whole_mass e < 2 ^ p)%Z /\ (whole_allowances e < 2 ^ p)%Z.
Proof.
  intros H T. apply andb_prop in T. destruct T as (T & A). apply andb_prop in T. destruct T as (C & B).
  destruct (Rlt_bool_spec (mass e) (IZR (2 ^ p))) as [Lm |]; [| discriminate].
  destruct (Rlt_bool_spec (allowances e) (IZR (2 ^ p))) as [La |]; [| discriminate].
  now apply trusted_measured.
Qed.

Theorem mass_covers_size e : homogeneous e -> trusted e = true ->
  exact_size e <= IZR (whole_mass e) * M ^ degree e +
    (if (whole_allowances e =? 0)%Z then 0
     else (IZR (whole_allowances e) - 3 / 4) * tau + IZR (whole_allowances e) * tau * M ^ degree e).
Proof. intros H T. apply measured_mass_covers_size. now apply trusted_parts. Qed.

Theorem semi_static_bound_covers e : admissible p emin e -> homogeneous e -> trusted e = true ->
  (1 <= whole_allowances e)%Z -> (1 <= degree e)%nat -> (Z.of_nat (degree e) <= 2 ^ (p - 6))%Z ->
  (1 <= roundings e)%nat -> 64 * INR (roundings e + 3) * u <= 1 ->
  Rabs (unrounded p emin e - exact e) <= semi_static_bound e.
Proof.
  intros A H T Ha Hd Hp Hr Hk. destruct (trusted_parts e H T) as (Me & L & _).
  destruct (masses e Me) as (M1 & _). apply measured_bound_covers; auto.
  assert (P6 : (0 <= p - 6)%Z).
  { apply Z.le_ngt. intros C. rewrite Z.pow_neg_r in Hp by lia. lia. }
  replace (2 * p - 6)%Z with (p + (p - 6))%Z by lia. rewrite Z.pow_add_r by (unfold Prec_gt_0 in *; lia).
  apply Z.mul_le_mono_nonneg; lia.
Qed.

Theorem semi_static_sign_certain e : admissible p emin e -> homogeneous e ->
  (1 <= whole_allowances e)%Z -> (1 <= degree e)%nat -> (Z.of_nat (degree e) <= 2 ^ (p - 6))%Z ->
  (1 <= roundings e)%nat -> 64 * INR (roundings e + 3) * u <= 1 ->
  sign_is_right (semi_static_sign e) (exact e).
Proof.
  intros A H Ha Hd Hp Hr Hk. destruct (trusted e) eqn:T; [| unfold semi_static_sign; now rewrite T].
  generalize (semi_static_bound_covers e A H T Ha Hd Hp Hr Hk). intros B.
  apply Rabs_le_inv in B. unfold semi_static_sign. rewrite T. cbn [andb].
  destruct (Rlt_bool_spec (semi_static_bound e) (Rabs (value e))) as [L | L]; [| exact Logic.I].
  rewrite (value_rounds p emin e A) in *.
  assert (Nb : number (semi_static_bound e)) by (apply rnd_number; auto with typeclass_instances).
  assert (W : semi_static_bound e < Rabs (unrounded p emin e)).
  { apply Rnot_le_lt. intros C. apply (rnd_abs_below p emin nearest) in C; auto. lra. }
  destruct (Rlt_bool_spec 0 (fl (unrounded p emin e))) as [S | S]; simpl.
  - assert (0 < unrounded p emin e).
    { apply Rnot_le_lt. intros C. apply (rnd_below p emin nearest _ 0) in C; [lra | apply number_0]. }
    rewrite Rabs_pos_eq in W; lra.
  - assert (unrounded p emin e <= 0).
    { apply Rnot_lt_le. intros C. assert (0 <= fl (unrounded p emin e)).
      { apply rnd_nonnegative; auto with typeclass_instances. lra. }
      assert (Z : fl (unrounded p emin e) = 0) by lra. rewrite Z, Rabs_R0 in L. lra. }
    rewrite Rabs_left1 in W; lra.
Qed.

Section Overflow.

(** The format's largest number. Operations that exceed it give an infinity or NaN, as in StaticFilter.v. *)
Context (largest : R) (largest_p : 2 * IZR (2 ^ p) <= largest).
Notation in_range := (in_range largest).
Notation value_in_range := (value_in_range p emin largest).

(** No operation of the bound overflows (those of m, a, tau and the constant cannot). *)
Fixpoint power_in_range (fuel n : nat) (x : R) : Prop :=
  in_range x /\
  match fuel with
  | O => True
  | S fuel =>
      if (n <=? 1)%nat then True
      else if Nat.even n then power_in_range fuel (Nat.div2 n) (fl (x * x))
      else power_in_range fuel (n - 1) x /\ in_range (fl (code_power fuel (n - 1) x * x))
  end.
Definition bound_in_range (e : expression) : Prop :=
  let size := fl (fl (2 * mass e) * computed_power (degree e)) in
  trusted e = true /\ power_in_range (degree e) (degree e) M /\ in_range size /\
  in_range (fl (size + fl (fl (2 * allowances e) * tau))) /\ in_range (semi_static_bound e).
(** sign_of with machine numbers: the bound is infinite or NaN if it is not in range. *)
Definition semi_static_machine_sign (v b : ieee) : sign :=
  if less b (magnitude v) then if less (finite 0) v then positive else negative else uncertain.

Lemma parts_in_range k m d :
  (forall x, admissible p emin x -> measured x -> (roundings x <= k)%nat -> (whole_mass x <= m)%Z ->
    (degree x <= d)%nat -> in_range (value x)) ->
  forall e, admissible p emin e -> measured e -> (roundings e <= k)%nat -> (whole_mass e <= m)%Z ->
    (degree e <= d)%nat -> value_in_range e.
Proof.
  intros R. induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx]; intros A Me K L D;
    (split; [now apply R |]); auto;
    cbn [measured whole_mass degree StaticFilter.roundings admissible] in *; destruct A as (_ & A),
      Me as (_ & _ & Me).
  - destruct A as (A & B), Me as (X & Y & E). destruct (masses x X) as (X1 & _), (masses y Y) as (Y1 & _).
    split; [apply IHx | apply IHy]; auto; lia.
  - destruct A as (A & B), Me as (X & Y & E). destruct (masses x X) as (X1 & _), (masses y Y) as (Y1 & _).
    split; [apply IHx | apply IHy]; auto; lia.
  - destruct A as (A & B), Me as (X & Y). destruct (masses x X) as (X1 & _), (masses y Y) as (Y1 & _).
    split; [apply IHx | apply IHy]; auto; try lia; apply Z.le_trans with (2 := L); nia.
  - apply IHx; auto.
Qed.

(** If the bound does not overflow, nothing in the expression does. *)
Lemma bound_in_range_value e : admissible p emin e -> homogeneous e -> (1 <= degree e)%nat ->
  64 * INR (roundings e + 3) * u <= 1 -> bound_in_range e -> value_in_range e.
Proof.
  intros A Ho Hd Hk (T & _ & B & _). destruct (trusted_parts e Ho T) as (Me & Lm & _).
  destruct (masses e Me) as (M1 & _ & Em & _).
  pose proof (degree_roundings e Me) as Dr.
  generalize (u_positive p) (eta_positive emin) tau_positive tau_small. intros U E Tp Ts.
  assert (P2 : (1 <= 2 ^ p)%Z) by (generalize (Z.pow_le_mono_r 2 0 p); unfold Prec_gt_0 in p_positive; lia).
  apply IZR_le in P2. set (k := roundings e) in *. set (m := whole_mass e) in *. set (d := degree e) in *.
  assert (Ku : INR k * u + 3 * u <= / 64) by (rewrite plus_INR in Hk; simpl (INR 3) in Hk; lra).
  pose proof (pos_INR k) as K0. assert (0 <= INR k * u) by (apply Rmult_le_pos; lra).
  assert (Pk : power (S k) <= 1.02).
  { generalize (power_quadratic u (S k) ltac:(lra)). rewrite S_INR. intros Q. specialize (Q ltac:(lra)).
    fold (power (S k)) in Q. apply Rle_trans with (1 := Q).
    assert ((INR k + 1) * u * ((INR k + 1) * u) <= / 64 * / 64) by (apply Rmult_le_compat; lra). lra. }
  apply (parts_in_range k m d); auto; [| apply Z.le_refl]. intros x Ax Mx Kx Lx Dx.
  destruct (masses x Mx) as (Mx1 & Ax0 & _ & _).
  destruct (proj1 (expression_near p emin ltac:(lia) ltac:(lia) x Ax)) as (_ & V & _).
  pose proof (exact_size_nonnegative p emin ltac:(lia) x) as S0.
  assert (V' : Rabs (value x) <= 1.02 * exact_size x).
  { apply Rle_trans with (1 := V). apply Rmult_le_compat_r; auto. apply Rle_trans with (2 := Pk).
    apply power_le; auto; lia. }
  generalize (measured_mass_covers_size x Mx). intros Sx.
  assert (At : IZR (whole_allowances x) * tau <= / 16).
  { assert (Wa : (whole_allowances x <= 2 ^ p)%Z) by (destruct x; apply Mx). apply IZR_le in Wa.
    apply Rle_trans with (IZR (2 ^ p) * tau); [apply Rmult_le_compat_r; lra |].
    apply Rle_trans with (2 := Ts). assert (0 <= IZR (2 ^ p) * tau) by (apply Rmult_le_pos; lra). nra. }
  pose proof M1 as Mz. apply IZR_le in Mx1, Lx, Ax0, M1. pose proof (power_nonnegative (degree x)) as N.
  assert (S1 : exact_size x <= (IZR m + / 16) * M ^ degree x + / 16).
  { apply Rle_trans with (1 := Sx).
    assert (IZR (whole_mass x) * M ^ degree x <= IZR m * M ^ degree x) by (apply Rmult_le_compat_r; auto).
    destruct (whole_allowances x =? 0)%Z; [lra |].
    assert (IZR (whole_allowances x) * tau * M ^ degree x <= / 16 * M ^ degree x) by (apply
      Rmult_le_compat_r; auto).
    lra. }
  unfold StaticFilter.in_range in *. destruct (Rle_or_lt M 1) as [C | C].
  - assert (M ^ degree x <= 1) by (rewrite <- (pow1 (degree x)); apply pow_incr; lra).
    assert ((IZR m + / 16) * M ^ degree x <= (IZR m + / 16) * 1) by (apply Rmult_le_compat_l; lra).
    apply Z.lt_le_incl, IZR_le in Lm. lra.
  - assert (Md : M ^ degree x <= M ^ d) by (apply Rle_pow; [lra | exact Dx]).
    assert (Md1 : 1 <= M ^ d) by (apply pow_R1_Rle; lra).
    assert (De : 2 * INR d * eta <= / 64).
    { assert (Dp : INR d * u <= / 64).
      { apply le_INR in Dr. rewrite S_INR in Dr.
        apply Rle_trans with ((INR k + 1) * u); [apply Rmult_le_compat_r; lra | lra]. }
      assert (Eu : eta <= u / 2).
      { unfold Format.eta, Format.u, Rdiv. change (/ 2) with (bpow radix2 (-1)). rewrite <- bpow_plus.
        apply bpow_le. lia. }
      assert (INR d * eta <= INR d * (u / 2)) by (apply Rmult_le_compat_l; [apply pos_INR | lra]). lra. }
    destruct (computed_power_lower d Hd ltac:(lra)) as (Pw & P0). set (P := computed_power d) in *.
    assert (Pd : power d <= 1.02) by (apply Rle_trans with (2 := Pk); apply power_le; auto; lia).
    assert (Q1 : M ^ d <= 1.02 * (P + / 64)).
    { apply Rle_trans with (1 := Pw). pose proof (pos_INR d).
      assert (0 <= INR d * eta) by (apply Rmult_le_pos; lra).
      apply Rmult_le_compat; try lra. pose proof (power_1 p ltac:(lia) d). lra. }
    rewrite Em in B. fold m in B.
    assert (Twice : fl (2 * IZR m) = 2 * IZR m).
    { apply rnd_exact; auto with typeclass_instances.
      replace (2 * IZR m) with (IZR m * bpow radix2 1) by (change (bpow radix2 1) with 2; ring).
      apply number_integer; auto; lia. }
    rewrite Twice in B. assert (Pp : 0 <= 2 * IZR m * P) by (apply Rmult_le_pos; lra).
    pose proof (product_upper _ Pp) as Up.
    assert (B0 : 0 <= fl (2 * IZR m * P)) by (apply rnd_nonnegative; auto with typeclass_instances).
    rewrite (Rabs_pos_eq _ B0) in B. set (b := fl (2 * IZR m * P)) in *.
    assert (Q2 : IZR m * M ^ d <= IZR m * (1.02 * (P + / 64))) by (apply Rmult_le_compat_l; lra).
    assert (Q3 : IZR m <= IZR m * M ^ d) by (rewrite <- (Rmult_1_r (IZR m)) at 1; apply Rmult_le_compat_l; lra).
    assert (Q4 : (IZR m + / 16) * M ^ degree x <= (IZR m + / 16) * M ^ d) by (apply Rmult_le_compat_l; lra).
    assert (Q5 : M ^ d <= IZR m * M ^ d) by (rewrite <- (Rmult_1_l (M ^ d)) at 1; apply Rmult_le_compat_r; lra).
    assert (u * b <= / 64 * b) by (apply Rmult_le_compat_r; lra).
    assert (eta <= / 64).
    { apply le_INR in Hd. simpl (INR 1) in Hd.
      assert (1 * eta <= 2 * INR d * eta) by (apply Rmult_le_compat_r; lra). lra. }
    lra.
Qed.

Theorem semi_static_overflow_uncertain e v b : admissible p emin e -> homogeneous e ->
  (1 <= whole_allowances e)%Z -> (1 <= degree e)%nat -> (Z.of_nat (degree e) <= 2 ^ (p - 6))%Z ->
  (1 <= roundings e)%nat -> 64 * INR (roundings e + 3) * u <= 1 ->
  (value_in_range e -> v = finite (value e)) ->
  (bound_in_range e -> b = finite (semi_static_bound e)) ->
  (~ bound_in_range e -> b = plus_infinity \/ b = nan) ->
  sign_is_right (semi_static_machine_sign v b) (exact e).
Proof.
  intros A Ho Ha Hd Hp Hr Hk V B B'. unfold semi_static_machine_sign.
  destruct (classic (bound_in_range e)) as [I | I].
  - generalize (semi_static_sign_certain e A Ho Ha Hd Hp Hr Hk). unfold semi_static_sign.
    rewrite (proj1 I), (V (bound_in_range_value e A Ho Hd Hk I)), (B I). easy.
  - destruct (B' I) as [-> | ->]; destruct v; exact Logic.I.
Qed.

End Overflow.
End Filter.
End SemiStatic.
