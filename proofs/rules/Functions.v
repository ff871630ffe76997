(** Functions of tracked numbers (include/errbound/functions.hpp): the bounds of a square root, of a fused product
    and sum, of linear interpolation and of a length, as the C++ code computes them.

    A number x has a value a and a bound sa, |a - x| <= sa. Square roots need emin <= 2 - 2p, as in every IEEE format
    whose largest exponent is above p: they do not underflow there. Fused products need emin <= -p. Results:
        sqrt_sound, fma_sound, copysign_sound   rounding in any one direction, from 5 bits on
        lerp_sound                              rounding in any one direction, from 6 bits on
        sqrt_sound_nearest, fma_sound_nearest, lerp_sound_nearest, copysign_sound_nearest
                                                to nearest, ties to even, from 3 bits on
        hypot_sound_nearest                     to nearest, ties to even, from 8 bits on *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core Mult_error.
From Errbound Require Import Format.
From Errbound Require AbsoluteBound Tight.
Open Scope R_scope.

(** The inherited error for arguments with an error of at most e; x is not negative, since a >= e. *)
Lemma root_inherits a x e : 0 < e <= a -> Rabs (a - x) <= e ->
  0 <= x /\ Rabs (sqrt a - sqrt x) <= e / (sqrt a + sqrt (a - e)).
Proof.
  intros H L. apply Rabs_le_inv in L. split; [lra |].
  assert (PA : 0 < sqrt a) by (apply sqrt_lt_R0; lra).
  generalize (sqrt_pos x) (sqrt_pos (a - e)). intros PX PE.
  assert (LE : sqrt (a - e) <= sqrt x) by (apply sqrt_le_1_alt; lra).
  replace (sqrt a - sqrt x) with ((a - x) / (sqrt a + sqrt x)).
  2: { rewrite <- (sqrt_sqrt a) at 1 by lra. rewrite <- (sqrt_sqrt x) at 1 by lra. field. lra. }
  unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ _)) by (apply Rlt_le, Rinv_0_lt_compat; lra).
  apply Rmult_le_compat; [apply Rabs_pos | apply Rlt_le, Rinv_0_lt_compat; lra | now apply Rabs_le |].
  apply Rinv_le; lra.
Qed.

Section Functions.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (direction : R -> Z) {direction_valid : Valid_rnd direction}.

Notation fl := (rnd p emin direction).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).
Notation inflated := (Tight.inflated p emin direction).
Notation rounding := (Tight.rounding p emin direction).

(** The code, in its order of evaluation. *)
Definition rounding_of (v : R) : R := fl (rounding v + eta).
Definition sqrt_error (a e : R) : R :=
  let v := fl (sqrt a) in
  if Req_bool e 0 then inflated (rounding_of v)
  else
    let divisor := fl (v + fl (sqrt (fl (a - e)))) in
    inflated (fl (fl (e / divisor) + fl (rounding_of v + eta))).
Definition fma_error (v a sa b sb sc : R) : R :=
  let products := fl (fl (Rabs a * sb) + fl (sa * fl (Rabs b + sb))) in
  inflated (fl (rounding_of v + fl (products + fl (sc + fl (3 * eta))))).
Definition lerp_error (v d a sa b sb t st : R) : R :=
  let of_d := rounding_of d in
  let size := Rabs t in
  let from_ends := inflated (fl (fl (fl (Rabs (fl (1 - t)) + st) * sa) + fl (fl (size + st) * sb))) in
  let from_t := inflated (fl (fl (fl (Rabs d + of_d) * st) + fl (size * of_d))) in
  inflated (fl (rounding_of v + fl (from_ends + fl (from_t + fl (8 * eta))))).

(** e is the exponent of the larger of |x| and |y|, which is not 0. *)
Definition hypot_value (x y : R) (e : Z) : R :=
  let a := fl (x * bpow radix2 (- e)) in
  let b := fl (y * bpow radix2 (- e)) in
  fl (fl (sqrt (fl (fl (a * a) + fl (b * b)))) * bpow radix2 e).
Definition hypot_error (v sx sy : R) : R :=
  let relative := fl (fl (3 * eps) + fl (8 * eta)) in
  inflated (fl (fl (v * relative) + fl (fl (sx + sy) + fl (2 * eta)))).

Section Proof.

Context (p_3 : (3 <= p)%Z) (emin_p : (emin <= - p)%Z) (r h : R) (E : rounding_error p emin direction r h).
Let f := 1 + 8 * eps.
Let q := 1 - r.
Context (f_q6 : 1 <= f * (q * q * q * q * q * q)) (r_8 : r <= / 8).

Let rnd_number := Format.rnd_number p emin direction.
Let rnd_nonnegative := Format.rnd_nonnegative p emin direction.
Let rnd_above := Format.rnd_above p emin direction.
Let rnd_lower := Format.rnd_lower p emin direction r h E.
Let rnd_absolute := Format.rnd_absolute p emin direction r h E.
Let rnd_subnormal := Format.rnd_subnormal p emin direction.
Let sum_relative := Format.sum_relative p emin direction r h E.
Let sum_subnormal := Format.sum_subnormal p emin direction.

Lemma f_1 : 1 <= f.
Proof. unfold f. generalize (eps_positive p). lra. Qed.
Lemma q_8 : 7 / 8 <= q <= 1.
Proof. unfold q. generalize (error_r _ _ _ _ _ E). lra. Qed.
Lemma f_q5 : 1 <= f * (q * q * q * q * q).
Proof. generalize f_1 q_8. intros. apply (fewer_roundings f q); [lra | lra | exact f_q6]. Qed.
Lemma f_q4 : 1 <= f * (q * q * q * q).
Proof. generalize f_1 q_8. intros. apply (fewer_roundings f q); [lra | lra | exact f_q5]. Qed.
Lemma f_q3 : 1 <= f * (q * q * q).
Proof. generalize f_1 q_8. intros. apply (fewer_roundings f q); [lra | lra | exact f_q4]. Qed.
Lemma f_q2 : 1 <= f * (q * q).
Proof. generalize f_1 q_8. intros. apply (fewer_roundings f q); [lra | lra | exact f_q3]. Qed.
Lemma f_q1 : 1 <= f * q.
Proof. generalize f_1 q_8. intros. apply (fewer_roundings f q); [lra | lra | exact f_q2]. Qed.
Lemma no_less x c : 0 <= x -> 1 <= c -> x <= x * c.
Proof. intros X C. rewrite <- (Rmult_1_r x) at 1. apply Rmult_le_compat_l; lra. Qed.

Lemma rounding_nonnegative v : 0 <= rounding v.
Proof. apply (Tight.rounding_nonnegative p emin direction p_3 emin_p). Qed.
Lemma rounding_of_nonnegative v : 0 <= rounding_of v.
Proof. apply rnd_nonnegative. generalize (rounding_nonnegative v) (eta_positive emin). lra. Qed.
Lemma rounding_of_lower v : (rounding v + eta) * q <= rounding_of v.
Proof.
  generalize (rounding_nonnegative v) (eta_positive emin). intros.
  apply sum_relative; try lra; [apply rnd_number | exact (number_eta p emin)].
Qed.

(** Inflating S covers a bound Z. Above the smallest normal number, it covers all roundings. Below, sums are exact,
    and only S times f is rounded. *)
Lemma inflated_covers S Z : 0 <= S -> Z <= S * (f * q) ->
  (S < smallest_normal -> Z + h <= S * f) -> Z <= inflated S.
Proof.
  intros P Above Below. generalize f_1. intros F1.
  rewrite (Tight.inflated_exact p emin direction p_3 emin_p). fold f.
  assert (0 <= S * f) by (apply Rmult_le_pos; lra).
  destruct (Rlt_or_le (S * f) smallest_normal) as [C | C].
  - assert (S < smallest_normal) by nra.
    generalize (rnd_absolute (S * f) ltac:(auto) C). specialize (Below ltac:(auto)). lra.
  - generalize (Format.rnd_relative p emin direction r h E _ C). fold q. lra.
Qed.

(** Square roots are normal numbers. *)
Lemma number_from_eta a : number a -> 0 < a -> eta <= a.
Proof.
  intros N P. apply (succ_le_lt radix2 (FLT_exp emin p)) in P; auto with typeclass_instances.
  - rewrite succ_0, ulp_FLT_0 in P; auto.
  - apply number_0.
Qed.
Hypothesis emin_2p : (emin <= 2 - 2 * p)%Z.
Lemma root_normal a : number a -> 0 < a -> smallest_normal <= sqrt a.
Proof.
  intros N P. apply number_from_eta in P; auto.
  rewrite <- (sqrt_Rsqr smallest_normal) by (generalize (smallest_normal_positive p emin); lra).
  apply sqrt_le_1_alt. apply Rle_trans with (2 := P). unfold Rsqr, Format.smallest_normal, Format.eta.
  rewrite <- bpow_plus. apply bpow_le. lia.
Qed.
Lemma root_upper a : number a -> 0 <= a -> fl (sqrt a) <= sqrt a * (1 + r).
Proof.
  intros N [P | <-]; [| rewrite sqrt_0, (Format.rnd_0 p emin direction); lra].
  generalize (root_normal a N P) (sqrt_pos a). intros L PS.
  generalize (error_relative _ _ _ _ _ E (sqrt a)). rewrite (Rabs_pos_eq (sqrt a)) by auto.
  intros H. apply H, Rabs_le_inv in L. lra.
Qed.
Lemma root_error a : number a -> 0 <= a -> Rabs (fl (sqrt a) - sqrt a) <= rounding (fl (sqrt a)).
Proof.
  intros N [P | <-].
  - apply (Format.rounding_of_normal p emin direction).
    + apply (Tight.rounding_factor p emin direction p_3 emin_p).
    + rewrite Rabs_pos_eq by apply sqrt_pos. now apply root_normal.
  - rewrite sqrt_0, (Format.rnd_0 p emin direction), Rminus_0_r, Rabs_R0. apply rounding_nonnegative.
Qed.

(** The computed divisor is at most (1 + r)^3 times the exact one. *)
Lemma divisor_upper a e : number a -> number e -> 0 < e <= a ->
  0 < fl (fl (sqrt a) + fl (sqrt (fl (a - e)))) <=
    (sqrt a + sqrt (a - e)) * ((1 + r) * (1 + r) * (1 + r)).
Proof.
  intros A N H. generalize (error_r _ _ _ _ _ E). intros [R0 _].
  set (v := fl (sqrt a)). set (s := fl (a - e)). set (w := fl (sqrt s)).
  generalize (sqrt_pos a) (sqrt_pos (a - e)) (sqrt_pos s) (smallest_normal_positive p emin). intros P1 P2 P3 Pm.
  assert (Ps : 0 <= s) by (apply rnd_nonnegative; lra).
  assert (HV : v <= sqrt a * (1 + r)) by (apply root_upper; auto; lra).
  assert (HW : w <= sqrt s * (1 + r)) by (apply root_upper; auto; apply rnd_number).
  assert (HS : s <= (a - e) * (1 + r)).
  { generalize (Format.sum_error p emin direction r h E a (- e) A (number_opp _ _ _ N)).
    change (a + - e) with (a - e). fold s. rewrite (Rabs_pos_eq (a - e)) by lra. intros D.
    apply Rabs_le_inv in D. lra. }
  assert (HQ : sqrt s <= sqrt (a - e) * (1 + r)).
  { apply Rle_trans with (sqrt ((a - e) * (1 + r))); [now apply sqrt_le_1_alt |].
    rewrite sqrt_mult by lra. apply Rmult_le_compat_l; auto.
    rewrite <- (sqrt_Rsqr (1 + r)) at 2 by lra. apply sqrt_le_1_alt. unfold Rsqr. nra. }
  assert (LV : smallest_normal <= v).
  { apply rnd_above; [now apply number_smallest_normal |]. apply root_normal; auto; lra. }
  assert (PW : 0 <= w) by now apply rnd_nonnegative.
  split.
  - apply Rlt_le_trans with (1 := Pm). apply rnd_above; [now apply number_smallest_normal | lra].
  - generalize (Format.sum_error p emin direction r h E v w (rnd_number _) (rnd_number _)).
    rewrite (Rabs_pos_eq (v + w)) by lra. intros D. apply Rabs_le_inv in D.
    apply Rle_trans with ((v + w) * (1 + r)); [lra |].
    replace ((sqrt a + sqrt (a - e)) * ((1 + r) * (1 + r) * (1 + r)))
      with ((sqrt a + sqrt (a - e)) * ((1 + r) * (1 + r)) * (1 + r)) by ring.
    apply Rmult_le_compat_r; [lra |].
    assert (sqrt a * (1 + r) <= sqrt a * ((1 + r) * (1 + r))) by (apply Rmult_le_compat_l; nra).
    assert (sqrt s * (1 + r) <= sqrt (a - e) * (1 + r) * (1 + r)) by (apply Rmult_le_compat_r; lra).
    lra.
Qed.

Lemma sqrt_covered a x e : number a -> number e -> 0 <= e <= a -> Rabs (a - x) <= e ->
  0 <= x /\ Rabs (fl (sqrt a) - sqrt x) <= sqrt_error a e.
Proof.
  intros A N H L. generalize (error_r _ _ _ _ _ E) (error_h _ _ _ _ _ E) (eta_positive emin) q_8 f_1.
  intros HR HH Pe Q8 F1. generalize f_q6 f_q5 f_q4 f_q3 f_q2 f_q1. intros F6 F5 F4 F3 F2 FQ.
  assert (HV := root_error a A ltac:(lra)). unfold sqrt_error. cbv zeta.
  set (v := fl (sqrt a)) in *. set (R := rounding v) in *. set (R0 := rounding_of v).
  assert (PR : 0 <= R) by apply rounding_nonnegative.
  assert (LR : (R + eta) * q <= R0) by apply rounding_of_lower.
  destruct (Req_bool_spec e 0) as [Z | Z].
  { rewrite Z in L. apply within_0 in L. subst x. split; [lra |].
    apply Rle_trans with (1 := HV). apply inflated_covers; [apply rounding_of_nonnegative | |].
    - apply Rle_trans with ((R + eta) * q * (f * q)); [| apply Rmult_le_compat_r; auto; lra].
      replace ((R + eta) * q * (f * q)) with ((R + eta) * (f * (q * q))) by ring. nra.
    - intros C. assert (ER : R0 = R + eta).
      { apply sum_subnormal; auto using number_eta; try lra. apply rnd_number. }
      rewrite ER. nra. }
  destruct (root_inherits a x e ltac:(lra) L) as [PX HX]. split; auto.
  destruct (divisor_upper a e A N ltac:(lra)) as [PD HD]. fold v in PD, HD.
  set (d := fl (v + _)) in *. set (D := sqrt a + sqrt (a - e)) in *. set (Z1 := e / D) in *.
  assert (PDD : 0 < D).
  { generalize (sqrt_lt_R0 a ltac:(lra)) (sqrt_pos (a - e)). unfold D. lra. }
  assert (PZ : 0 <= Z1) by (apply Rmult_le_pos; [lra | now apply Rlt_le, Rinv_0_lt_compat]).
  assert (HI : Z1 * (q * q * q) <= e / d).
  { apply Rle_trans with (e / (D * ((1 + r) * (1 + r) * (1 + r)))).
    - unfold Z1. replace (e / (D * ((1 + r) * (1 + r) * (1 + r))))
        with (e / D * (/ (1 + r) * / (1 + r) * / (1 + r))) by (field; lra).
      apply Rmult_le_compat_l; auto.
      assert (I : q <= / (1 + r)).
      { apply Rmult_le_reg_r with (1 + r); [lra |]. rewrite Rinv_l by lra. unfold q. nra. }
      assert (0 <= q * q) by nra.
      apply Rmult_le_compat; try lra. apply Rmult_le_compat; lra.
    - apply Rmult_le_compat_l; [lra |]. apply Rinv_le; auto. }
  assert (PI : 0 <= e / d) by (apply Rmult_le_pos; [lra | now apply Rlt_le, Rinv_0_lt_compat]).
  set (I := fl (e / d)). set (T := fl (R0 + eta)).
  assert (NI : 0 <= I) by now apply rnd_nonnegative.
  assert (P0 : 0 <= R0) by apply rounding_of_nonnegative.
  assert (NT : 0 <= T) by (apply rnd_nonnegative; lra).
  assert (HT : (R0 + eta) * q <= T).
  { apply sum_relative; auto using number_eta; try lra. apply rnd_number. }
  assert (HIL : Z1 * (q * q * q) * q - h <= I).
  { apply Rle_trans with (e / d * q - h); [| now apply rnd_lower].
    apply Rplus_le_compat_r, Rmult_le_compat_r; lra. }
  apply Rle_trans with (R + Z1).
  { replace (v - sqrt x) with ((v - sqrt a) + (sqrt a - sqrt x)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  assert (PS : 0 <= fl (I + T)) by (apply rnd_nonnegative; lra).
  apply inflated_covers; auto.
  - assert (HS : (I + T) * q <= fl (I + T)) by (apply sum_relative; auto; apply rnd_number).
    apply Rle_trans with ((I + T) * q * (f * q)); [| apply Rmult_le_compat_r; auto; lra].
    assert (G : Z1 * (q * q * q) * q - h + (R + eta + eta) * (q * q) <= I + T).
    { enough ((R + eta + eta) * (q * q) <= T) by lra. apply Rle_trans with (2 := HT).
      replace ((R + eta + eta) * (q * q)) with ((R + eta + eta) * q * q) by ring.
      apply Rmult_le_compat_r; [lra |]. nra. }
    apply Rle_trans with ((Z1 * (q * q * q) * q - h + (R + eta + eta) * (q * q)) * (q * (f * q))).
    + replace ((Z1 * (q * q * q) * q - h + (R + eta + eta) * (q * q)) * (q * (f * q)))
        with (Z1 * (f * (q * q * q * q * q * q)) + R * (f * (q * q * q * q))
              + (2 * eta * (q * q) - h) * (f * (q * q))) by ring.
      assert (Q2 : 49 / 64 <= q * q) by nra. assert (0 <= 2 * eta * (q * q) - h) by nra.
      assert (0 <= (2 * eta * (q * q) - h) * (f * (q * q))) by (apply Rmult_le_pos; lra).
      nra.
    + replace ((I + T) * q * (f * q)) with ((I + T) * (q * (f * q))) by ring.
      apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra.
  - intros C.
    assert (LT : T <= fl (I + T)) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L0 : R0 <= T) by (apply rnd_above; [apply rnd_number | lra]).
    assert (ES : fl (I + T) = I + T) by (apply sum_subnormal; auto; apply rnd_number).
    assert (ET : T = R0 + eta).
    { apply sum_subnormal; auto using number_eta; try lra; [apply rnd_number | fold T; lra]. }
    assert (ER : R0 = R + eta).
    { apply sum_subnormal; auto using number_eta; try lra; [apply rnd_number |].
      change (R0 < smallest_normal). lra. }
    rewrite ES, ET, ER.
    apply Rle_trans with ((Z1 * (q * q * q) * q - h + (R + eta + eta)) * f).
    + replace ((Z1 * (q * q * q) * q - h + (R + eta + eta)) * f)
        with (Z1 * (f * (q * q * q * q)) + (R + (2 * eta - h)) * f) by ring. nra.
    + apply Rmult_le_compat_r; lra.
Qed.

Lemma number_3_eta : number (3 * eta).
Proof.
  apply (number_integer p emin 3 emin); [lia |]. apply Z.le_trans with (2 ^ 3)%Z; [lia |].
  apply Z.pow_le_mono_r; lia.
Qed.

Lemma fma_covered a x sa b y sb c z sc :
  number a -> number b -> number sa -> number sb -> number sc ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> Rabs (c - z) <= sc ->
  Rabs (fl (a * b + c) - (x * y + z)) <= fma_error (fl (a * b + c)) a sa b sb sc.
Proof.
  intros A B SA SB SC HA HB HC.
  generalize (error_r _ _ _ _ _ E) (error_h _ _ _ _ _ E) (eta_positive emin) q_8 f_1.
  intros HR HH Pe Q8 F1. generalize f_q6 f_q5 f_q4 f_q3 f_q2 f_q1. intros F6 F5 F4 F3 F2 FQ.
  assert (PA : 0 <= sa) by (generalize (Rabs_pos (a - x)); lra).
  assert (PB : 0 <= sb) by (generalize (Rabs_pos (b - y)); lra).
  assert (PC : 0 <= sc) by (generalize (Rabs_pos (c - z)); lra).
  generalize (Rabs_pos a) (Rabs_pos b). intros Pa Pb.
  unfold fma_error. cbv zeta. rewrite (Format.rnd_exact p emin direction _ number_3_eta).
  set (v := fl (a * b + c)). set (R := rounding v). set (R0 := rounding_of v).
  destruct (Format.product_left p emin direction q h ltac:(lra) (proj1 HH) (rnd_relative p emin direction r h E)
    (fun x P C => proj1 (rnd_absolute x P C)) (Rabs a) sa (Rabs b) sb) as (PX & PP & LP & SP);
    auto using number_abs, Rabs_pos. revert PX PP LP SP.
  set (P := fl (fl (Rabs a * sb) + fl (sa * fl (Rabs b + sb)))). set (K := Rabs a * sb). set (T := sa * (Rabs b + sb)).
  intros PX PP LP SP. set (C3 := fl (sc + 3 * eta)). set (S1 := fl (P + C3)). set (S := fl (R0 + S1)).
  assert (PK : 0 <= K) by (apply Rmult_le_pos; lra).
  assert (PT : 0 <= T) by (apply Rmult_le_pos; lra).
  assert (PR : 0 <= R) by apply rounding_nonnegative.
  assert (PR0 : 0 <= R0) by apply rounding_of_nonnegative.
  assert (PC3 : 0 <= C3) by (apply rnd_nonnegative; lra).
  assert (PS1 : 0 <= S1) by (apply rnd_nonnegative; lra).
  assert (PS : 0 <= S) by (apply rnd_nonnegative; lra).
  (* the exact bound *)
  apply Rle_trans with (R + h + (K + T) + sc).
  { replace (v - (x * y + z)) with ((v - (a * b + c)) + (a * b - x * y) + (c - z)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat; auto.
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat.
    - apply (Tight.rounding_any p emin direction p_3 emin_p r h E).
    - now apply AbsoluteBound.product_inherits. }
  assert (HR0 : (R + eta) * q <= R0) by apply rounding_of_lower.
  apply inflated_covers; auto.
  - assert (D4 : (sc + 3 * eta) * q <= C3) by (apply sum_relative; auto using number_3_eta; lra).
    assert (D5 : (P + C3) * q <= S1) by (apply sum_relative; auto; apply rnd_number).
    assert (D6 : (R0 + S1) * q <= S) by (apply sum_relative; auto; apply rnd_number).
    set (X := (K + T) * (q * q) - 2 * h) in *.
    assert (G2 : (X + sc + 3 * eta) * (q * q) <= S1).
    { apply Rle_trans with (2 := D5).
      replace ((X + sc + 3 * eta) * (q * q)) with ((X * q + (sc + 3 * eta) * q) * q) by ring.
      apply Rmult_le_compat_r; lra. }
    assert (G3 : (R + eta + (X + sc + 3 * eta) * q) * (q * q) <= S).
    { apply Rle_trans with (2 := D6).
      replace ((R + eta + (X + sc + 3 * eta) * q) * (q * q))
        with (((R + eta) * q + (X + sc + 3 * eta) * (q * q)) * q) by ring.
      apply Rmult_le_compat_r; lra. }
    apply Rle_trans with ((R + eta + (X + sc + 3 * eta) * q) * (q * q) * (f * q)).
    + replace ((R + eta + (X + sc + 3 * eta) * q) * (q * q) * (f * q))
        with ((R + eta) * (f * (q * q * q)) + (K + T) * (f * (q * q * q * q * q * q))
              + (sc + (3 * eta - 2 * h)) * (f * (q * q * q * q))) by (unfold X; ring).
      assert (R + eta <= (R + eta) * (f * (q * q * q))) by (apply no_less; lra).
      assert (K + T <= (K + T) * (f * (q * q * q * q * q * q))) by (apply no_less; lra).
      assert (sc + (3 * eta - 2 * h) <= (sc + (3 * eta - 2 * h)) * (f * (q * q * q * q))) by (apply no_less; lra). lra.
    + apply Rmult_le_compat_r; auto. lra.
  - intros C.
    assert (L1 : S1 <= S) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L2 : R0 <= S) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L3 : P <= S1) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L4 : C3 <= S1) by (apply rnd_above; [apply rnd_number | lra]).
    assert (E1 : S = R0 + S1) by (apply sum_subnormal; auto; apply rnd_number).
    assert (E2 : S1 = P + C3).
    { apply sum_subnormal; auto; try apply rnd_number. fold S1. lra. }
    assert (E3 : R0 = R + eta).
    { apply sum_subnormal; auto using number_eta; try lra; [apply rnd_number |].
      change (R0 < smallest_normal). lra. }
    assert (E5 : C3 = sc + 3 * eta).
    { apply sum_subnormal; auto using number_3_eta; try lra. fold C3. lra. }
    destruct (SP ltac:(lra)) as (w & W & Kw).
    apply Rle_trans with ((R + eta + (K + T * q - 2 * h + (sc + 3 * eta))) * f);
      [| rewrite E1, E2, E3, E5; apply Rmult_le_compat_r; lra].
    replace ((R + eta + (K + T * q - 2 * h + (sc + 3 * eta))) * f)
      with (R * f + K * f + T * (f * q) + sc * f + (4 * eta - 2 * h) * f) by ring.
    assert (R <= R * f) by (apply no_less; lra). assert (K <= K * f) by (apply no_less; lra).
    assert (T <= T * (f * q)) by (apply no_less; lra).
    assert (sc <= sc * f) by (apply no_less; lra).
    assert (4 * eta - 2 * h <= (4 * eta - 2 * h) * f) by (apply no_less; lra). lra.
Qed.

Lemma number_8_eta : number (8 * eta).
Proof. exact (number_eta_times p emin 3 ltac:(lia)). Qed.
Lemma inflated_lower S : 0 <= S -> S * f * q - h <= inflated S.
Proof.
  intros P. rewrite (Tight.inflated_exact p emin direction p_3 emin_p). fold f.
  apply rnd_lower. apply Rmult_le_pos; auto. generalize f_1. lra.
Qed.
Lemma inflated_number S : number (inflated S).
Proof. apply rnd_number. Qed.
Lemma inflated_nonnegative S : 0 <= S -> 0 <= inflated S.
Proof.
  intros P. rewrite (Tight.inflated_exact p emin direction p_3 emin_p). fold f.
  apply rnd_nonnegative, Rmult_le_pos; auto. generalize f_1. lra.
Qed.
(** A sum of two products with computed factors, X q^i and Y q^j, enlarged. *)
Lemma products_lower X Y A B : 0 <= A -> 0 <= B -> 0 <= X -> 0 <= Y -> X * (q * q) <= A -> Y * (q * q) <= B ->
  X + Y - (2 * f + 1) * h <= inflated (fl (fl A + fl B)).
Proof.
  intros PA PB PX PY HA HB. generalize (error_h _ _ _ _ _ E) q_8 f_1. intros HH Q8 F1.
  generalize (rnd_lower A PA) (rnd_lower B PB) (rnd_nonnegative A PA) (rnd_nonnegative B PB).
  fold q. intros LA LB NA NB.
  assert (S : (fl A + fl B) * q <= fl (fl A + fl B)) by (apply sum_relative; auto; apply rnd_number).
  assert (NS : 0 <= fl (fl A + fl B)) by (apply rnd_nonnegative; lra).
  apply Rle_trans with (2 := inflated_lower _ NS).
  assert (L : (X * (q * q) * q + Y * (q * q) * q - 2 * h) * q <= fl (fl A + fl B)) by nra.
  apply Rle_trans with ((X * (q * q) * q + Y * (q * q) * q - 2 * h) * q * (f * q) - h).
  - replace ((X * (q * q) * q + Y * (q * q) * q - 2 * h) * q * (f * q) - h) with
      ((X + Y) * (f * (q * q * q * q * q)) - 2 * h * (f * (q * q)) - h) by ring.
    assert (X + Y <= (X + Y) * (f * (q * q * q * q * q))) by (apply no_less; [lra | apply f_q5]).
    assert (f * (q * q) <= f).
    { rewrite <- (Rmult_1_r f) at 2. apply Rmult_le_compat_l; [lra |].
      rewrite <- (Rmult_1_r 1). apply Rmult_le_compat; lra. }
    assert (2 * h * (f * (q * q)) <= 2 * h * f) by (apply Rmult_le_compat_l; lra). lra.
  - replace (fl (fl A + fl B) * f * q) with (fl (fl A + fl B) * (f * q)) by ring.
    apply Rplus_le_compat_r, Rmult_le_compat_r; auto. apply Rmult_le_pos; lra.
Qed.

Lemma lerp_covered a x sa b y sb t z st : (4 * f + 4) * h <= 9 * eta ->
  number a -> number b -> number t -> number sa -> number sb -> number st ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> Rabs (t - z) <= st ->
  let d := fl (b - a) in
  Rabs (fl (t * d + a) - ((1 - z) * x + z * y)) <= lerp_error (fl (t * d + a)) d a sa b sb t st.
Proof.
  intros H9 A B T SA SB ST HA HB HT d.
  generalize (error_h _ _ _ _ _ E) (eta_positive emin) q_8 f_1. intros HH Pe Q8 F1.
  assert (PA : 0 <= sa) by (generalize (Rabs_pos (a - x)); lra).
  assert (PB : 0 <= sb) by (generalize (Rabs_pos (b - y)); lra).
  assert (PT : 0 <= st) by (generalize (Rabs_pos (t - z)); lra).
  unfold lerp_error. cbv zeta. rewrite (Format.rnd_exact p emin direction _ number_8_eta).
  set (v := fl (t * d + a)). set (D := rounding_of d). set (R := rounding v). set (R0 := rounding_of v).
  set (c := fl (1 - t)).
  assert (PD : 0 <= D) by apply rounding_of_nonnegative.
  assert (N1 : number 1) by (change 1 with (bpow radix2 0); apply number_power; auto; lia).
  assert (HC : Rabs (1 - t) * q <= Rabs c).
  { generalize (Format.sum_error p emin direction r h E 1 (- t) N1 (number_opp _ _ _ T)).
    change (1 + - t) with (1 - t). fold c. intros G.
    assert (Rabs (1 - t) <= Rabs c + Rabs (c - (1 - t))).
    { replace (1 - t) with (c + - (c - (1 - t))) at 1 by ring. apply Rle_trans with (1 := Rabs_triang _ _).
      rewrite Rabs_Ropp. lra. }
    unfold q. lra. }
  assert (HD : Rabs (d - (b - a)) <= D).
  { apply Rle_trans with (rounding d).
    - apply (Format.rounding_of_sum p emin direction b (- a)); auto; [now apply number_opp |].
      apply (Tight.rounding_factor p emin direction p_3 emin_p).
    - apply rnd_above; [apply rnd_number | lra]. }
  generalize (Rabs_pos (1 - t)) (Rabs_pos t) (Rabs_pos d) (Rabs_pos c). intros P1t Pt Pd Pc.
  set (X1 := (Rabs (1 - t) + st) * sa). set (X2 := (Rabs t + st) * sb).
  set (X3 := (Rabs d + D) * st). set (X4 := Rabs t * D).
  assert (Q2 : 0 <= q * q <= q).
  { split; [apply Rmult_le_pos; lra |]. rewrite <- (Rmult_1_r q) at 3. apply Rmult_le_compat_l; lra. }
  assert (SC : (Rabs c + st) * q <= fl (Rabs c + st)).
  { apply sum_relative; auto. apply number_abs, rnd_number. }
  assert (STt : (Rabs t + st) * q <= fl (Rabs t + st)) by (apply sum_relative; auto; now apply number_abs).
  assert (SD : (Rabs d + D) * q <= fl (Rabs d + D)).
  { apply sum_relative; auto; [apply number_abs, rnd_number | apply rnd_number]. }
  set (ends := inflated (fl (fl (fl (Rabs c + st) * sa) + fl (fl (Rabs t + st) * sb)))).
  set (times := inflated (fl (fl (fl (Rabs d + D) * st) + fl (Rabs t * D)))).
  assert (PX1 : 0 <= X1) by (apply Rmult_le_pos; lra). assert (PX2 : 0 <= X2) by (apply Rmult_le_pos; lra).
  assert (PX3 : 0 <= X3) by (apply Rmult_le_pos; lra). assert (PX4 : 0 <= X4) by (apply Rmult_le_pos; lra).
  assert (PF1 : 0 <= fl (Rabs c + st)) by (apply rnd_nonnegative; lra).
  assert (PF2 : 0 <= fl (Rabs t + st)) by (apply rnd_nonnegative; lra).
  assert (PF3 : 0 <= fl (Rabs d + D)) by (apply rnd_nonnegative; lra).
  assert (LE : X1 + X2 - (2 * f + 1) * h <= ends).
  { apply products_lower; auto; try (apply Rmult_le_pos; lra).
    - unfold X1. replace ((Rabs (1 - t) + st) * sa * (q * q)) with ((Rabs (1 - t) + st) * (q * q) * sa) by ring.
      apply Rmult_le_compat_r; auto. apply Rle_trans with (2 := SC).
      replace ((Rabs (1 - t) + st) * (q * q)) with ((Rabs (1 - t) * q + st * q) * q) by ring.
      apply Rmult_le_compat_r; [lra |].
      assert (st * q <= st * 1) by (apply Rmult_le_compat_l; lra). lra.
    - unfold X2. replace ((Rabs t + st) * sb * (q * q)) with ((Rabs t + st) * (q * q) * sb) by ring.
      apply Rmult_le_compat_r; auto. apply Rle_trans with (2 := STt). apply Rmult_le_compat_l; lra. }
  assert (LT : X3 + X4 - (2 * f + 1) * h <= times).
  { apply products_lower; auto; try (apply Rmult_le_pos; lra).
    - unfold X3. replace ((Rabs d + D) * st * (q * q)) with ((Rabs d + D) * (q * q) * st) by ring.
      apply Rmult_le_compat_r; auto. apply Rle_trans with (2 := SD). apply Rmult_le_compat_l; lra.
    - rewrite <- (Rmult_1_r (Rabs t * D)). apply Rmult_le_compat_l; [apply Rmult_le_pos; lra | lra]. }
  assert (PE : 0 <= ends).
  { apply inflated_nonnegative, rnd_nonnegative, Rplus_le_le_0_compat; apply rnd_nonnegative, Rmult_le_pos; lra. }
  assert (PM : 0 <= times).
  { apply inflated_nonnegative, rnd_nonnegative, Rplus_le_le_0_compat; apply rnd_nonnegative, Rmult_le_pos; lra. }
  (* the exact bound *)
  apply Rle_trans with (R + h + (X1 + X2) + (X3 + X4)).
  { replace (v - ((1 - z) * x + z * y)) with ((v - (t * d + a)) + (t * (d - (b - a)) +
      ((1 - z) * (a - x) + z * (b - y) + (t - z) * (b - a)))) by ring.
    assert (G1 : Rabs (v - (t * d + a)) <= R + h) by apply (Tight.rounding_any p emin direction p_3 emin_p r h E).
    assert (G2 : Rabs (t * (d - (b - a))) <= X4) by (rewrite Rabs_mult; apply Rmult_le_compat_l; auto).
    assert (Z1 : Rabs (1 - z) <= Rabs (1 - t) + st).
    { replace (1 - z) with ((1 - t) + (t - z)) by ring. apply Rle_trans with (1 := Rabs_triang _ _). lra. }
    assert (Z2 : Rabs z <= Rabs t + st).
    { replace z with (t + - (t - z)) at 1 by ring. apply Rle_trans with (1 := Rabs_triang _ _).
      rewrite Rabs_Ropp. lra. }
    assert (G3 : Rabs ((1 - z) * (a - x)) <= X1).
    { rewrite Rabs_mult. apply Rmult_le_compat; auto; apply Rabs_pos. }
    assert (G4 : Rabs (z * (b - y)) <= X2) by (rewrite Rabs_mult; apply Rmult_le_compat; auto; apply Rabs_pos).
    assert (G5 : Rabs ((t - z) * (b - a)) <= X3).
    { rewrite Rabs_mult, Rmult_comm. apply Rmult_le_compat; auto; try apply Rabs_pos.
      replace (b - a) with (d + - (d - (b - a))) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
      rewrite Rabs_Ropp. lra. }
    generalize (Rabs_triang (v - (t * d + a)) (t * (d - (b - a)) +
      ((1 - z) * (a - x) + z * (b - y) + (t - z) * (b - a))))
      (Rabs_triang (t * (d - (b - a))) ((1 - z) * (a - x) + z * (b - y) + (t - z) * (b - a)))
      (Rabs_triang ((1 - z) * (a - x) + z * (b - y)) ((t - z) * (b - a)))
      (Rabs_triang ((1 - z) * (a - x)) (z * (b - y))). lra. }
  set (U := fl (times + 8 * eta)). set (W := fl (ends + U)).
  assert (PR : 0 <= R) by apply rounding_nonnegative.
  assert (PR0 : 0 <= R0) by apply rounding_of_nonnegative.
  assert (HR0 : (R + eta) * q <= R0) by apply rounding_of_lower.
  assert (PU : 0 <= U) by (apply rnd_nonnegative; lra).
  assert (PW : 0 <= W) by (apply rnd_nonnegative; lra).
  assert (ALL : R + h + (X1 + X2) + (X3 + X4) + h <= R + eta + ends + times + 8 * eta) by lra.
  apply inflated_covers; [apply rnd_nonnegative, Rplus_le_le_0_compat; auto | |].
  - assert (LU : (times + 8 * eta) * q <= U).
    { apply sum_relative; auto using number_8_eta; try lra. apply inflated_number. }
    assert (LW : (ends + U) * q <= W) by (apply sum_relative; auto; [apply inflated_number | apply rnd_number]).
    assert (LZ : (R0 + W) * q <= fl (R0 + W)) by (apply sum_relative; auto; apply rnd_number).
    set (Y := R + eta + ends + times + 8 * eta) in *.
    assert (LY : Y * (q * q * q) <= fl (R0 + W)).
    { apply Rle_trans with (2 := LZ). replace (Y * (q * q * q)) with (Y * (q * q) * q) by ring.
      apply Rmult_le_compat_r; [lra |].
      apply Rle_trans with ((R + eta) * q + (ends + (times + 8 * eta) * q) * q).
      - unfold Y. assert ((R + eta) * (q * q) <= (R + eta) * q) by (apply Rmult_le_compat_l; lra).
        assert (ends * (q * q) <= ends * q) by (apply Rmult_le_compat_l; lra). lra.
      - assert ((ends + (times + 8 * eta) * q) * q <= (ends + U) * q) by (apply Rmult_le_compat_r; lra). lra. }
    apply Rle_trans with (Y * (f * (q * q * q * q))).
    + apply Rle_trans with Y; [lra |]. apply no_less; [unfold Y; lra | apply f_q4].
    + replace (Y * (f * (q * q * q * q))) with (Y * (q * q * q) * (f * q)) by ring.
      apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra.
  - intros C'. assert (C : fl (R0 + W) < smallest_normal) by exact C'. clear C'.
    assert (L1 : R0 <= fl (R0 + W)) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L2 : W <= fl (R0 + W)) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L3 : U <= W) by (apply rnd_above; [apply rnd_number | lra]).
    assert (E1 : fl (R0 + W) = R0 + W) by (apply sum_subnormal; auto; apply rnd_number).
    assert (E2 : W = ends + U).
    { apply sum_subnormal; auto; [apply inflated_number | apply rnd_number |].
      change (W < smallest_normal). lra. }
    assert (E3 : U = times + 8 * eta).
    { apply sum_subnormal; auto using number_8_eta; try lra; [apply inflated_number |].
      change (U < smallest_normal). lra. }
    assert (E4 : R0 = R + eta).
    { apply sum_subnormal; auto using number_eta; try lra; [apply rnd_number |].
      change (R0 < smallest_normal). lra. }
    match goal with |- _ <= ?s * f => change (R + h + (X1 + X2) + (X3 + X4) + h <= fl (R0 + W) * f) end.
    apply Rle_trans with (fl (R0 + W) * 1); [lra |]. apply Rmult_le_compat_l; lra.
Qed.

(** A size s of |X|, with a possibly wrong sign. *)
Definition copysign_error (s sx : R) : R := inflated (fl (fl (2 * s) + sx)).
Lemma copysign_covered s v X T sx : number s -> number sx -> 0 <= s -> Rabs (s - Rabs X) <= sx ->
  Rabs v = s -> Rabs T = Rabs X -> Rabs (v - T) <= copysign_error s sx.
Proof.
  intros N NS P H V HT. generalize q_8 f_1 f_q2. intros Q8 F1 F2.
  assert (PS : 0 <= sx) by (generalize (Rabs_pos (s - Rabs X)); lra).
  assert (N2 : number (2 * s)).
  { rewrite Rmult_comm. change 2 with (bpow radix2 1). apply Mult_error.mult_bpow_pos_exact_FLT; auto. lia. }
  unfold copysign_error. rewrite (Format.rnd_exact p emin direction _ N2).
  apply Rle_trans with (2 * s + sx).
  { apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp, V, HT. apply Rabs_le_inv in H. lra. }
  destruct (Rle_or_lt smallest_normal (fl (2 * s + sx))) as [C | C].
  - apply inflated_covers; [apply rnd_nonnegative; lra | | lra].
    assert (L : (2 * s + sx) * q <= fl (2 * s + sx)) by (apply sum_relative; auto; lra).
    apply Rle_trans with ((2 * s + sx) * q * (f * q)).
    + replace ((2 * s + sx) * q * (f * q)) with ((2 * s + sx) * (f * (q * q))) by ring. apply no_less; lra.
    + apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra.
  - assert (ES : fl (2 * s + sx) = 2 * s + sx) by (apply sum_subnormal; auto; lra).
    rewrite (Tight.inflated_exact p emin direction p_3 emin_p). fold f. rewrite ES at 1.
    apply rnd_above; [rewrite <- ES; apply rnd_number |]. apply no_less; lra.
Qed.

(** Lengths of numbers whose larger one is A, scaled to at least 1/2. *)
Context (eps_128 : eps <= / 128) (eta_small : eta <= / 8192) (h_half : 31 / 10 * h <= 2 * eta).

Lemma hypot_squares A B b : / 2 <= A < 1 -> 0 <= B <= A -> number A -> 0 <= b <= 1 -> Rabs (b - B) <= h ->
  let s := fl (fl (A * A) + fl (b * b)) in
  Rabs (s - (A * A + B * B)) <= (2 * r + r * r + 13 * h) * (A * A + B * B).
Proof.
  intros HA HB NA Hb D s. generalize (error_r _ _ _ _ _ E) (error_h _ _ _ _ _ E) (eta_positive emin).
  intros HR HH Pe. apply Rabs_le_inv in D.
  assert (SN : smallest_normal <= / 4).
  { change (/ 4) with (bpow radix2 (-2)). apply bpow_le. lia. }
  assert (A2 : / 4 <= A * A <= 1).
  { split; [replace (/ 4) with (/ 2 * / 2) by field | rewrite <- (Rmult_1_r 1)]; apply Rmult_le_compat; lra. }
  assert (B2 : 0 <= B * B) by (apply Rmult_le_pos; lra).
  assert (b2 : 0 <= b * b) by (apply Rmult_le_pos; lra).
  assert (RH : 0 <= r * h <= / 128 * h).
  { split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_r; lra]. }
  assert (bB : Rabs (b * b - B * B) <= 2 * h).
  { replace (b * b - B * B) with ((b - B) * (b + B)) by ring. rewrite Rabs_mult, (Rmult_comm 2).
    apply Rmult_le_compat; try apply Rabs_pos; apply Rabs_le; lra. }
  apply Rabs_le_inv in bB.
  assert (G : Rabs (fl (A * A) - A * A) <= r * (A * A)).
  { rewrite <- (Rabs_pos_eq (A * A)) at 3 by lra. apply (error_relative _ _ _ _ _ E).
    rewrite Rabs_pos_eq by lra. lra. }
  assert (K : Rabs (fl (b * b) - b * b) <= r * (b * b) + h).
  { assert (0 <= r * (b * b)) by (apply Rmult_le_pos; lra).
    destruct (Rle_or_lt smallest_normal (Rabs (b * b))) as [N | N].
    - apply Rle_trans with (1 := error_relative _ _ _ _ _ E _ N). rewrite Rabs_pos_eq by lra. lra.
    - apply Rle_trans with (1 := error_absolute _ _ _ _ _ E _ N). lra. }
  set (g := fl (A * A)) in *. set (k := fl (b * b)) in *.
  apply Rabs_le_inv in G. apply Rabs_le_inv in K.
  assert (rb : r * (b * b) <= r * (B * B) + 2 * (r * h)).
  { replace (r * (B * B) + 2 * (r * h)) with (r * (B * B + 2 * h)) by ring. apply Rmult_le_compat_l; lra. }
  set (T := A * A + B * B) in *.
  assert (GK : Rabs (g + k - T) <= r * T + 302 / 100 * h) by (apply Rabs_le; unfold T; lra).
  apply Rabs_le_inv in GK.
  assert (S : Rabs (s - (g + k)) <= r * Rabs (g + k)) by (apply (Format.sum_error p emin direction r h E); apply rnd_number).
  assert (GP : 0 <= g + k).
  { apply Rplus_le_le_0_compat; apply rnd_nonnegative; lra. }
  rewrite (Rabs_pos_eq (g + k)) in S by auto.
  assert (SB : r * (g + k) <= r * T + r * r * T + 302 / 100 * (r * h)).
  { replace (r * T + r * r * T + 302 / 100 * (r * h)) with (r * (T + (r * T + 302 / 100 * h))) by ring.
    apply Rmult_le_compat_l; lra. }
  apply Rabs_le_inv in S.
  assert (HT : h <= 4 * (h * T)).
  { apply Rle_trans with (4 * (h * / 4)); [lra |]. apply Rmult_le_compat_l; [lra |].
    apply Rmult_le_compat_l; unfold T; lra. }
  apply Rabs_le. lra.
Qed.
Lemma root_of_near S T d : 0 < T -> 0 <= d <= / 2 -> Rabs (S - T) <= d * T ->
  Rabs (sqrt S - sqrt T) <= d / (2 - d) * sqrt T.
Proof.
  intros PT PD D. apply Rabs_le_inv in D.
  assert (QT : 0 < sqrt T) by now apply sqrt_lt_R0.
  assert (PS : 0 <= S) by nra.
  assert (PSq : 0 <= sqrt S) by apply sqrt_pos.
  assert (LS : (1 - d) * sqrt T <= sqrt S).
  { rewrite <- (sqrt_Rsqr (1 - d)) by lra. rewrite <- sqrt_mult; [| apply Rle_0_sqr | lra].
    apply sqrt_le_1_alt. unfold Rsqr. nra. }
  replace (sqrt S - sqrt T) with ((S - T) / (sqrt S + sqrt T)).
  2: { rewrite <- (sqrt_sqrt S) at 1 by lra. rewrite <- (sqrt_sqrt T) at 1 by lra. field. lra. }
  unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ _)).
  2: { left. apply Rinv_0_lt_compat. lra. }
  apply Rle_trans with (d * T * / ((2 - d) * sqrt T)).
  - apply Rmult_le_compat; [apply Rabs_pos | left; apply Rinv_0_lt_compat; lra | apply Rabs_le; lra |].
    apply Rinv_le; [apply Rmult_lt_0_compat; lra | lra].
  - right. rewrite <- (sqrt_sqrt T) at 1 by lra. field. lra.
Qed.
(** A length changes by no more than its legs. *)
Lemma length_inherits x X y Y sx sy : Rabs (x - X) <= sx -> Rabs (y - Y) <= sy ->
  Rabs (sqrt (x * x + y * y) - sqrt (X * X + Y * Y)) <= sx + sy.
Proof.
  assert (T : forall a b c d s t, Rabs (a - c) <= s -> Rabs (b - d) <= t ->
    sqrt (a * a + b * b) <= sqrt (c * c + d * d) + (s + t)).
  { intros a b c d s t H1 H2.
    assert (P1 : 0 <= s) by (generalize (Rabs_pos (a - c)); lra).
    assert (P2 : 0 <= t) by (generalize (Rabs_pos (b - d)); lra).
    set (l := sqrt (c * c + d * d)). assert (PL : 0 <= l) by apply sqrt_pos.
    assert (LL : l * l = c * c + d * d) by (apply sqrt_sqrt; apply Rplus_le_le_0_compat; apply Rle_0_sqr).
    assert (C : Rabs c <= l).
    { rewrite <- sqrt_Rsqr_abs. apply sqrt_le_1_alt. unfold Rsqr. generalize (Rle_0_sqr d). unfold Rsqr. lra. }
    assert (D : Rabs d <= l).
    { rewrite <- sqrt_Rsqr_abs. apply sqrt_le_1_alt. unfold Rsqr. generalize (Rle_0_sqr c). unfold Rsqr. lra. }
    rewrite <- (sqrt_Rsqr (l + (s + t))) by lra. apply sqrt_le_1_alt. unfold Rsqr.
    apply Rle_trans with ((Rabs c + s) * (Rabs c + s) + (Rabs d + t) * (Rabs d + t)).
    - assert (G : forall m n k, Rabs (m - n) <= k -> m * m <= (Rabs n + k) * (Rabs n + k)).
      { intros m n k K. assert (M : Rabs m <= Rabs n + k).
        { replace m with (n + (m - n)) at 1 by ring. apply Rle_trans with (1 := Rabs_triang _ _). lra. }
        replace (m * m) with (Rabs m * Rabs m) by (rewrite <- Rabs_mult; apply Rabs_pos_eq, Rle_0_sqr).
        apply Rmult_le_compat; auto; apply Rabs_pos. }
      generalize (G a c s H1) (G b d t H2). lra.
    - assert (CC : Rabs c * Rabs c = c * c) by (rewrite <- Rabs_mult; apply Rabs_pos_eq, Rle_0_sqr).
      assert (DD : Rabs d * Rabs d = d * d) by (rewrite <- Rabs_mult; apply Rabs_pos_eq, Rle_0_sqr).
      assert (Rabs c * s <= l * s) by (apply Rmult_le_compat_r; auto).
      assert (Rabs d * t <= l * t) by (apply Rmult_le_compat_r; auto).
      assert (0 <= s * t) by (now apply Rmult_le_pos). lra. }
  intros H1 H2. assert (H1' := H1). assert (H2' := H2). rewrite Rabs_minus_sym in H1', H2'.
  generalize (T _ _ _ _ _ _ H1 H2) (T _ _ _ _ _ _ H1' H2'). intros. apply Rabs_le. lra.
Qed.

Lemma hypot_covered x X y Y sx sy e :
  number x -> number y -> number sx -> number sy -> Rabs (x - X) <= sx -> Rabs (y - Y) <= sy ->
  bpow radix2 (e - 1) <= Rmax (Rabs x) (Rabs y) < bpow radix2 e ->
  Rabs (hypot_value x y e - sqrt (X * X + Y * Y)) <= hypot_error (hypot_value x y e) sx sy.
Proof.
  intros Nx Ny NSX NSY HX HY L.
  generalize (error_r _ _ _ _ _ E) (error_h _ _ _ _ _ E) (eta_positive emin) q_8 f_1 f_q4 f_q3 f_q2.
  intros HR HH Pe Q8 F1 F4 F3 F2.
  assert (PX : 0 <= sx) by (generalize (Rabs_pos (x - X)); lra).
  assert (PY : 0 <= sy) by (generalize (Rabs_pos (y - Y)); lra).
  assert (Q128 : 127 / 128 <= q) by (unfold q; lra).
  set (w := bpow radix2 e). assert (W : 0 < w) by apply bpow_gt_0.
  assert (IW : bpow radix2 (- e) = / w) by apply bpow_opp.
  (* the relative error of the computed root *)
  set (M := sqrt (x * x + y * y)). set (d := 2 * r + r * r + 13 * h). set (p0 := d / (2 - d)).
  assert (R2 : 0 <= r * r <= r * / 128).
  { split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_l; lra]. }
  assert (D : 0 <= d <= 302 / 150 * r + 13 * h /\ d <= / 50) by (unfold d; lra).
  assert (P0 : 0 <= p0 <= 102 / 100 * r + 7 * h).
  { unfold p0. split.
    - unfold Rdiv. apply Rmult_le_pos; [lra |]. left. apply Rinv_0_lt_compat. lra.
    - apply Rmult_le_reg_r with (2 - d); [lra |].
      replace (d / (2 - d) * (2 - d)) with d by (field; lra).
      assert ((102 / 100 * r + 7 * h) * (2 - / 50) <= (102 / 100 * r + 7 * h) * (2 - d))
        by (apply Rmult_le_compat_l; lra). lra. }
  assert (ROOT : exists root, number root /\ 0 <= root /\ hypot_value x y e = fl (root * w) /\
    Rabs (root * w - M) <= (p0 + r * (1 + p0)) * M).
  { unfold hypot_value. cbv zeta. rewrite IW.
    set (a := fl (x * / w)). set (b := fl (y * / w)).
    exists (fl (sqrt (fl (fl (a * a) + fl (b * b))))).
    split; [apply rnd_number |]. split; [apply rnd_nonnegative, sqrt_pos |]. split; [reflexivity |].
    assert (SC : forall z, number z -> Rabs (Rabs (fl (z * / w)) - Rabs (z * / w)) <= h).
    { intros z N. apply Rle_trans with (1 := Rabs_triang_inv2 _ _). rewrite <- IW.
      now apply (scale_error p emin direction r h E). }
    assert (SX : forall z, number z -> bpow radix2 (e - 1) <= Rabs z -> fl (z * / w) = z * / w).
    { intros z N H. apply (Format.rnd_exact p emin direction). rewrite <- IW. apply Mult_error.mult_bpow_exact_FLT; auto.
      assert (e <= mag radix2 z)%Z; [| lia]. replace e with (e - 1 + 1)%Z at 1 by lia.
      apply Zlt_le_succ, lt_bpow with radix2. apply Rle_lt_trans with (1 := H).
      apply bpow_mag_gt. }
    (* distinguishes sizes: the larger one is exact *)
    assert (G : forall z t, number z -> number t -> Rabs t <= Rabs z -> bpow radix2 (e - 1) <= Rabs z < w ->
      Rabs (fl (sqrt (fl (fl (fl (z * / w) * fl (z * / w)) + fl (fl (t * / w) * fl (t * / w))))) * w -
            sqrt (z * z + t * t)) <= (p0 + r * (1 + p0)) * sqrt (z * z + t * t)).
    { intros z t Nz Nt Ltz Lz. rewrite (SX z Nz (proj1 Lz)). set (c := fl (t * / w)).
      replace (z * / w * (z * / w)) with (Rabs z * / w * (Rabs z * / w)).
      2: { replace (Rabs z * / w * (Rabs z * / w)) with (Rabs z * Rabs z * (/ w * / w)) by ring.
           rewrite <- Rabs_mult, Rabs_pos_eq by apply Rle_0_sqr. ring. }
      replace (c * c) with (Rabs c * Rabs c) by (rewrite <- Rabs_mult; apply Rabs_pos_eq, Rle_0_sqr).
      set (A := Rabs z * / w). set (B := Rabs t * / w).
      assert (IP : 0 < / w) by now apply Rinv_0_lt_compat.
      assert (HA : / 2 <= A < 1).
      { unfold A. split.
        - apply Rle_trans with (bpow radix2 (e - 1) * / w); [| apply Rmult_le_compat_r; lra].
          rewrite <- IW, <- bpow_plus. replace (e - 1 + - e)%Z with (-1)%Z by lia. simpl. lra.
        - apply Rmult_lt_reg_r with w; auto. rewrite Rmult_assoc, Rinv_l by lra. lra. }
      assert (HB : 0 <= B <= A).
      { unfold A, B. split; [apply Rmult_le_pos; [apply Rabs_pos | lra] | apply Rmult_le_compat_r; lra]. }
      assert (NA : number A).
      { unfold A. rewrite <- (Rabs_pos_eq (/ w)) by lra. rewrite <- Rabs_mult. apply number_abs.
        rewrite <- (SX z Nz (proj1 Lz)). apply rnd_number. }
      assert (Hc : 0 <= Rabs c <= 1).
      { split; [apply Rabs_pos |]. apply (Format.rnd_abs_below p emin direction).
        - change 1 with (bpow radix2 0). apply number_power; auto. lia.
        - rewrite Rabs_mult, (Rabs_pos_eq (/ w)) by lra. fold B. lra. }
      assert (Hd : Rabs (Rabs c - B) <= h).
      { unfold B. rewrite <- (Rabs_pos_eq (/ w)) by lra. rewrite <- Rabs_mult. now apply SC. }
      assert (S := hypot_squares A B (Rabs c) HA HB NA Hc Hd). cbv zeta in S. fold d in S.
      set (s := fl (fl (A * A) + fl (Rabs c * Rabs c))) in *. set (T := A * A + B * B) in *.
      assert (A2 : / 4 <= A * A).
      { replace (/ 4) with (/ 2 * / 2) by field. apply Rmult_le_compat; lra. }
      assert (B2 : 0 <= B * B) by (apply Rmult_le_pos; lra).
      assert (PT : / 4 <= T) by (unfold T; lra).
      assert (RN := root_of_near s T d ltac:(lra) ltac:(lra) S). fold p0 in RN.
      assert (QT : / 2 <= sqrt T).
      { rewrite <- (sqrt_Rsqr (/ 2)) by lra. apply sqrt_le_1_alt. unfold Rsqr. lra. }
      assert (PM : p0 * sqrt T <= / 2 * sqrt T) by (apply Rmult_le_compat_r; lra).
      assert (RN' := RN). apply Rabs_le_inv in RN'.
      assert (SN : smallest_normal <= / 4).
      { change (/ 4) with (bpow radix2 (-2)). apply bpow_le. lia. }
      assert (RR : Rabs (fl (sqrt s) - sqrt s) <= r * sqrt s).
      { rewrite <- (Rabs_pos_eq (sqrt s)) at 3 by apply sqrt_pos. apply (error_relative _ _ _ _ _ E).
        rewrite Rabs_pos_eq by apply sqrt_pos. lra. }
      assert (RS : r * sqrt s <= r * (1 + p0) * sqrt T).
      { rewrite Rmult_assoc. apply Rmult_le_compat_l; lra. }
      assert (FIN : Rabs (fl (sqrt s) - sqrt T) <= (p0 + r * (1 + p0)) * sqrt T).
      { replace (fl (sqrt s) - sqrt T) with ((fl (sqrt s) - sqrt s) + (sqrt s - sqrt T)) by ring.
        apply Rle_trans with (1 := Rabs_triang _ _). lra. }
      assert (TW : sqrt (z * z + t * t) = sqrt T * w).
      { rewrite <- (sqrt_Rsqr w) at 1 by lra. rewrite <- sqrt_mult; [| lra | apply Rle_0_sqr]. f_equal.
        unfold T, A, B, Rsqr. replace (z * z) with (Rabs z * Rabs z)
          by (rewrite <- Rabs_mult; apply Rabs_pos_eq, Rle_0_sqr).
        replace (t * t) with (Rabs t * Rabs t) by (rewrite <- Rabs_mult; apply Rabs_pos_eq, Rle_0_sqr).
        field. lra. }
      rewrite TW. replace (fl (sqrt s) * w - sqrt T * w) with ((fl (sqrt s) - sqrt T) * w) by ring.
      rewrite Rabs_mult, (Rabs_pos_eq w) by lra. rewrite <- Rmult_assoc. apply Rmult_le_compat_r; lra. }
    unfold a, b, M. destruct (Rle_or_lt (Rabs y) (Rabs x)) as [C | C].
    - rewrite (Rmax_left _ _ C) in L. apply G; auto.
    - rewrite (Rmax_right _ _ (Rlt_le _ _ C)) in L.
      rewrite (Rplus_comm (fl (fl (x * / w) * fl (x * / w)))), (Rplus_comm (x * x)). apply G; auto. lra. }
  destruct ROOT as (root & NR & PR & EV & HR2). set (v := hypot_value x y e) in *.
  set (rho := p0 + r * (1 + p0)) in *.
  assert (RHO : 0 <= rho <= 205 / 100 * eps + 72 / 10 * eta /\ rho <= / 40).
  { assert (0 <= r * p0 <= / 128 * p0) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; lra).
    unfold rho. lra. }
  assert (PM : 0 <= M) by apply sqrt_pos.
  assert (PV : 0 <= v) by (rewrite EV; apply rnd_nonnegative, Rmult_le_pos; lra).
  assert (HV : Rabs (v - root * w) <= h) by (rewrite EV; now apply (scale_error p emin direction r h E)).
  apply Rabs_le_inv in HV. assert (HR2' := HR2). apply Rabs_le_inv in HR2'.
  assert (RM : rho * M <= / 40 * M) by (apply Rmult_le_compat_r; lra).
  (* in units of the computed value *)
  set (rel := 212 / 100 * eps + 75 / 10 * eta).
  assert (RV : rho * M <= rel * (v + h)).
  { apply Rle_trans with (rho * (40 / 39 * (v + h))); [apply Rmult_le_compat_l; lra |].
    replace (rho * (40 / 39 * (v + h))) with (rho * (40 / 39) * (v + h)) by ring.
    apply Rmult_le_compat_r; [lra |]. unfold rel. lra. }
  assert (INH : Rabs (M - sqrt (X * X + Y * Y)) <= sx + sy) by (apply length_inherits; auto).
  assert (RELH : 0 <= rel * h <= / 10 * h).
  { split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; unfold rel; lra. }
  (* the exact bound *)
  apply Rle_trans with (h + rel * v + rel * h + (sx + sy)).
  { replace (v - sqrt (X * X + Y * Y)) with
      ((v - root * w) + ((root * w - M) + (M - sqrt (X * X + Y * Y)))) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _).
    assert (Rabs (v - root * w) <= h) by (apply Rabs_le; lra).
    generalize (Rabs_triang (root * w - M) (M - sqrt (X * X + Y * Y))). lra. }
  unfold hypot_error. cbv zeta.
  assert (N3 : number (3 * eps)).
  { apply (number_integer p emin 3 (1 - p)); [lia |]. apply Z.le_trans with (2 ^ 3)%Z; [lia |].
    apply Z.pow_le_mono_r; lia. }
  assert (N2 : number (2 * eta)).
  { change 2 with (bpow radix2 1). unfold Format.eta. rewrite <- bpow_plus. apply number_power; auto. lia. }
  rewrite (Format.rnd_exact p emin direction _ N3), (Format.rnd_exact p emin direction _ number_8_eta),
    (Format.rnd_exact p emin direction _ N2).
  set (c := fl (3 * eps + 8 * eta)). set (P := fl (v * c)). set (I := fl (sx + sy)).
  set (J := fl (I + 2 * eta)).
  assert (LC : (3 * eps + 8 * eta) * q <= c) by (apply sum_relative; auto using number_8_eta; lra).
  assert (PC : 0 <= c) by (apply rnd_nonnegative; lra).
  assert (QQ : 126 / 128 <= q * q <= 1).
  { assert (127 / 128 * (127 / 128) <= q * q) by (apply Rmult_le_compat; lra).
    assert (q * q <= 1 * 1) by (apply Rmult_le_compat; lra). lra. }
  assert (LP : v * rel - h <= P).
  { apply Rle_trans with (2 := rnd_lower (v * c) (Rmult_le_pos _ _ PV PC)). fold q.
    apply Rplus_le_compat_r. rewrite Rmult_assoc. apply Rmult_le_compat_l; auto.
    apply Rle_trans with ((3 * eps + 8 * eta) * q * q); [| apply Rmult_le_compat_r; lra].
    rewrite Rmult_assoc. apply Rle_trans with ((3 * eps + 8 * eta) * (126 / 128)); [unfold rel; lra |].
    apply Rmult_le_compat_l; lra. }
  assert (PP : 0 <= P) by now apply rnd_nonnegative, Rmult_le_pos.
  assert (PI : 0 <= I) by (apply rnd_nonnegative; lra).
  assert (PJ : 0 <= J) by (apply rnd_nonnegative; lra).
  assert (LI : (sx + sy) * q <= I) by now apply sum_relative.
  assert (LJ : (I + 2 * eta) * q <= J) by (apply sum_relative; auto; [apply rnd_number | lra]).
  assert (LZ : (P + J) * q <= fl (P + J)) by (apply sum_relative; auto; apply rnd_number).
  apply inflated_covers; [apply rnd_nonnegative, Rplus_le_le_0_compat; auto | |].
  - (* if P is 0, the rest of 2 eta covers its h *)
    assert (T1 : (sx + sy) * (q * q) + 2 * eta * q <= J).
    { apply Rle_trans with (2 := LJ). replace ((sx + sy) * (q * q) + 2 * eta * q) with
        (((sx + sy) * q + 2 * eta) * q) by ring. apply Rmult_le_compat_r; lra. }
    apply Rle_trans with ((P + ((sx + sy) * (q * q) + 2 * eta * q)) * q * (f * q)).
    + replace ((P + ((sx + sy) * (q * q) + 2 * eta * q)) * q * (f * q)) with
        ((P + (2 * eta * q)) * (f * (q * q)) + (sx + sy) * (f * (q * q * q * q))) by ring.
      assert (sx + sy <= (sx + sy) * (f * (q * q * q * q))) by (apply no_less; lra).
      assert (EQ : 2 * eta * (127 / 128) <= 2 * eta * q) by (apply Rmult_le_compat_l; lra).
      assert (P + 2 * eta * q <= (P + 2 * eta * q) * (f * (q * q))) by (apply no_less; lra). lra.
    + apply Rmult_le_compat_r; [apply Rmult_le_pos; lra |].
      apply Rle_trans with (2 := LZ). apply Rmult_le_compat_r; lra.
  - intros C'. assert (C : fl (P + J) < smallest_normal) by exact C'. clear C'.
    assert (L1 : J <= fl (P + J)) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L2 : I <= J) by (apply rnd_above; [apply rnd_number | lra]).
    assert (E1 : fl (P + J) = P + J) by (apply sum_subnormal; auto; apply rnd_number).
    assert (E2 : J = I + 2 * eta).
    { apply sum_subnormal; auto; try lra; [apply rnd_number |]. change (J < smallest_normal). lra. }
    assert (E3 : I = sx + sy).
    { apply sum_subnormal; auto. change (I < smallest_normal). lra. }
    match goal with |- _ <= ?s * f =>
      change (h + rel * v + rel * h + (sx + sy) + h <= fl (P + J) * f) end.
    apply Rle_trans with (fl (P + J) * 1); [lra |]. apply Rmult_le_compat_l; lra.
Qed.

End Proof.
End Functions.

(** The theorems. *)
Section Sound.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.
Notation number := (number p emin).

Section Any_direction.

Context (p_5 : (5 <= p)%Z) (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation fl := (rnd p emin direction).

Let error : rounding_error p emin direction (eps p) (eta emin) :=
  rounding_error_any p emin direction ltac:(lia).
Lemma eps_8 : eps p <= / 8.
Proof. generalize (Tight.eps_16 p p_5). lra. Qed.

Theorem sqrt_sound a x sa : (emin <= 2 - 2 * p)%Z -> number a -> number sa ->
  0 <= sa <= a -> Rabs (a - x) <= sa ->
  0 <= x /\ Rabs (fl (sqrt a) - sqrt x) <= sqrt_error p emin direction a sa.
Proof.
  intros H. apply (sqrt_covered p emin direction ltac:(lia) ltac:(lia) _ _ error
                     (Tight.any_q6 p p_5) eps_8 H).
Qed.
Theorem fma_sound a x sa b y sb c z sc : (emin <= - p)%Z ->
  number a -> number b -> number sa -> number sb -> number sc ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> Rabs (c - z) <= sc ->
  Rabs (fl (a * b + c) - (x * y + z)) <= fma_error p emin direction (fl (a * b + c)) a sa b sb sc.
Proof.
  intros H. apply (fma_covered p emin direction ltac:(lia) H _ _ error (Tight.any_q6 p p_5) eps_8).
Qed.

Theorem lerp_sound a x sa b y sb t z st : (6 <= p)%Z -> (emin <= 2 - 2 * p)%Z ->
  number a -> number b -> number t -> number sa -> number sb -> number st ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> Rabs (t - z) <= st ->
  let d := fl (b - a) in
  Rabs (fl (t * d + a) - ((1 - z) * x + z * y)) <= lerp_error p emin direction (fl (t * d + a)) d a sa b sb t st.
Proof.
  intros P H. apply (lerp_covered p emin direction ltac:(lia) ltac:(lia) _ _ error (Tight.any_q6 p p_5) eps_8 H).
  generalize (eps_le p 6 P) (eta_positive emin). simpl. intros L PE.
  apply Rle_trans with (9 * eta emin); [apply Rmult_le_compat_r |]; lra.
Qed.
Theorem copysign_sound s v X T sx : (emin <= - p)%Z -> number s -> number sx -> 0 <= s -> Rabs (s - Rabs X) <= sx ->
  Rabs v = s -> Rabs T = Rabs X -> Rabs (v - T) <= copysign_error p emin direction s sx.
Proof.
  intros H. apply (copysign_covered p emin direction ltac:(lia) H _ _ error (Tight.any_q6 p p_5) eps_8).
Qed.

End Any_direction.

Section To_nearest.

Hypothesis p_3 : (3 <= p)%Z.
Notation fl := (rnd p emin nearest).

Let error : rounding_error p emin nearest (u p) (eta emin / 2) :=
  rounding_error_nearest p emin ltac:(lia).
Lemma u_8 : u p <= / 8.
Proof. generalize (Tight.u_8 p p_3). lra. Qed.

Theorem sqrt_sound_nearest a x sa : (emin <= 2 - 2 * p)%Z -> number a -> number sa ->
  0 <= sa <= a -> Rabs (a - x) <= sa ->
  0 <= x /\ Rabs (fl (sqrt a) - sqrt x) <= sqrt_error p emin nearest a sa.
Proof.
  intros H. apply (sqrt_covered p emin nearest p_3 ltac:(lia) _ _ error (Tight.nearest_q6 p p_3) u_8 H).
Qed.
(** The code's divisor is positive. *)
Lemma divisor_positive a e : (emin <= 2 - 2 * p)%Z -> number a -> number e -> 0 < e <= a ->
  0 < fl (fl (sqrt a) + fl (sqrt (fl (a - e)))).
Proof.
  intros H A N L. apply (divisor_upper p emin nearest _ _ error H a e A N L).
Qed.
Theorem fma_sound_nearest a x sa b y sb c z sc : (emin <= - p)%Z ->
  number a -> number b -> number sa -> number sb -> number sc ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> Rabs (c - z) <= sc ->
  Rabs (fl (a * b + c) - (x * y + z)) <= fma_error p emin nearest (fl (a * b + c)) a sa b sb sc.
Proof.
  intros H. apply (fma_covered p emin nearest p_3 H _ _ error (Tight.nearest_q6 p p_3) u_8).
Qed.

Theorem lerp_sound_nearest a x sa b y sb t z st : (emin <= 2 - 2 * p)%Z ->
  number a -> number b -> number t -> number sa -> number sb -> number st ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> Rabs (t - z) <= st ->
  let d := fl (b - a) in
  Rabs (fl (t * d + a) - ((1 - z) * x + z * y)) <= lerp_error p emin nearest (fl (t * d + a)) d a sa b sb t st.
Proof.
  intros H. apply (lerp_covered p emin nearest p_3 ltac:(lia) _ _ error (Tight.nearest_q6 p p_3) u_8 H).
  generalize (eps_le p 3 p_3) (eta_positive emin). simpl. intros L PE.
  apply Rle_trans with (16 * (eta emin / 2)); [apply Rmult_le_compat_r |]; lra.
Qed.
Theorem copysign_sound_nearest s v X T sx : (emin <= - p)%Z -> number s -> number sx -> 0 <= s ->
  Rabs (s - Rabs X) <= sx -> Rabs v = s -> Rabs T = Rabs X -> Rabs (v - T) <= copysign_error p emin nearest s sx.
Proof.
  intros H. apply (copysign_covered p emin nearest p_3 H _ _ error (Tight.nearest_q6 p p_3) u_8).
Qed.
Theorem hypot_sound_nearest x X y Y sx sy e : (8 <= p)%Z -> (emin <= 2 - 2 * p)%Z ->
  number x -> number y -> number sx -> number sy -> Rabs (x - X) <= sx -> Rabs (y - Y) <= sy ->
  bpow radix2 (e - 1) <= Rmax (Rabs x) (Rabs y) < bpow radix2 e ->
  let v := hypot_value p emin nearest x y e in
  Rabs (v - sqrt (X * X + Y * Y)) <= hypot_error p emin nearest v sx sy.
Proof.
  intros P H. generalize (eps_le p 8 P) (eta_positive emin). simpl. intros L PE.
  assert (SE : eta emin <= / 8192).
  { replace (/ 8192) with (bpow radix2 (-13)) by (simpl; lra). apply bpow_le. lia. }
  apply (hypot_covered p emin nearest p_3 ltac:(lia) _ _ error (Tight.nearest_q6 p p_3) u_8 H); auto; lra.
Qed.

End To_nearest.
End Sound.
