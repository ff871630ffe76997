(** Functions of tracked numbers (include/errbound/functions.hpp): the bounds of a square root and of a
    fused product and sum, as the C++ code computes them.

    A number x is known by a value a and a bound sa, |a - x| <= sa. Results:
        sqrt_sound, fma_sound                   rounding in any one direction, from 5 bits on;
        sqrt_sound_nearest, fma_sound_nearest   to nearest, ties to even, from 3 bits on.
    Square roots need emin <= 2 - 2p, as it is in every IEEE format whose largest exponent is above p:
    they do not underflow there. Fused products need emin <= -p. *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format.
From Errbound Require Tight.
Open Scope R_scope.

(** Of numbers known to within e, as far as the root goes: x is not below zero, as a >= e. *)
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

Variables p emin : Z.
Context {p_positive : Prec_gt_0 p}.
Variable direction : R -> Z.
Context {direction_valid : Valid_rnd direction}.

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

Section Proof.

Hypothesis p_3 : (3 <= p)%Z.
Hypothesis emin_p : (emin <= - p)%Z.
Variables r h : R.
Hypothesis E : rounding_error p emin direction r h.
Let f := 1 + 8 * eps.
Let q := 1 - r.
Hypothesis f_q6 : 1 <= f * (q * q * q * q * q * q).
Hypothesis r_8 : r <= / 8.

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
(** One factor q less. *)
Lemma less_q x : 0 <= x -> 1 <= f * (x * q) -> 1 <= f * x.
Proof.
  intros P H. generalize f_1 q_8. intros F Q. assert (0 <= f * x) by (apply Rmult_le_pos; lra). nra.
Qed.
Lemma f_q5 : 1 <= f * (q * q * q * q * q).
Proof. apply less_q; [| exact f_q6]. generalize q_8. intros. repeat apply Rmult_le_pos; lra. Qed.
Lemma f_q4 : 1 <= f * (q * q * q * q).
Proof. apply less_q, f_q5. generalize q_8. intros. repeat apply Rmult_le_pos; lra. Qed.
Lemma f_q3 : 1 <= f * (q * q * q).
Proof. apply less_q, f_q4. generalize q_8. intros. repeat apply Rmult_le_pos; lra. Qed.
Lemma f_q2 : 1 <= f * (q * q).
Proof. apply less_q, f_q3. generalize q_8. intros. repeat apply Rmult_le_pos; lra. Qed.
Lemma f_q1 : 1 <= f * q.
Proof. apply less_q, f_q2. generalize q_8. lra. Qed.
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

(** What inflating S makes of a bound Z: all roundings on the way are paid for above the smallest
    normal number; below, sums are exact, and only S times f is rounded. *)
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

(** The divisor is at most (1 + r)^3 of the exact one. *)
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
  { rewrite Z in L. apply Tight.within_0 in L. subst x. split; [lra |].
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
  set (t := fl (Rabs b + sb)). set (P1 := fl (Rabs a * sb)). set (P2 := fl (sa * t)).
  set (P := fl (P1 + P2)). set (C3 := fl (sc + 3 * eta)). set (S1 := fl (P + C3)). set (S := fl (R0 + S1)).
  set (K := Rabs a * sb). set (T := sa * (Rabs b + sb)).
  assert (PK : 0 <= K) by (apply Rmult_le_pos; lra).
  assert (PT : 0 <= T) by (apply Rmult_le_pos; lra).
  assert (PR : 0 <= R) by apply rounding_nonnegative.
  assert (PR0 : 0 <= R0) by apply rounding_of_nonnegative.
  assert (Pt : 0 <= t) by (apply rnd_nonnegative; lra).
  assert (PP1 : 0 <= P1) by now apply rnd_nonnegative.
  assert (PP2 : 0 <= P2) by (apply rnd_nonnegative, Rmult_le_pos; lra).
  assert (PP : 0 <= P) by (apply rnd_nonnegative; lra).
  assert (PC3 : 0 <= C3) by (apply rnd_nonnegative; lra).
  assert (PS1 : 0 <= S1) by (apply rnd_nonnegative; lra).
  assert (PS : 0 <= S) by (apply rnd_nonnegative; lra).
  (* the exact bound *)
  apply Rle_trans with (R + h + (K + T) + sc).
  { replace (v - (x * y + z)) with ((v - (a * b + c)) + (a * b - x * y) + (c - z)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat; auto.
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat.
    - apply (Tight.rounding_any p emin direction p_3 emin_p r h E).
    - now apply Tight.product_inherits. }
  assert (Ht : T * q <= sa * t).
  { unfold T. rewrite Rmult_assoc. apply Rmult_le_compat_l; auto. apply sum_relative; auto. now apply number_abs. }
  assert (HR0 : (R + eta) * q <= R0) by apply rounding_of_lower.
  apply inflated_covers; auto.
  - generalize (rnd_lower K PK) (rnd_lower (sa * t) ltac:(apply Rmult_le_pos; lra)).
    change (fl K) with P1. fold P2 q. intros D1 D2.
    assert (D3 : (P1 + P2) * q <= P) by (apply sum_relative; auto; apply rnd_number).
    assert (D4 : (sc + 3 * eta) * q <= C3) by (apply sum_relative; auto using number_3_eta; lra).
    assert (D5 : (P + C3) * q <= S1) by (apply sum_relative; auto; apply rnd_number).
    assert (D6 : (R0 + S1) * q <= S) by (apply sum_relative; auto; apply rnd_number).
    assert (Q2 : 0 <= q * q) by nra. assert (Q3 : 0 <= q * q * q) by nra.
    assert (G1 : (K * q + T * q * q - 2 * h) * q <= P).
    { apply Rle_trans with (2 := D3). apply Rmult_le_compat_r; [lra |].
      assert (T * q * q <= sa * t * q) by (apply Rmult_le_compat_r; lra). lra. }
    assert (G2 : (K * q + T * q * q - 2 * h + sc + 3 * eta) * (q * q) <= S1).
    { apply Rle_trans with (2 := D5).
      replace ((K * q + T * q * q - 2 * h + sc + 3 * eta) * (q * q))
        with (((K * q + T * q * q - 2 * h) * q + (sc + 3 * eta) * q) * q) by ring.
      apply Rmult_le_compat_r; lra. }
    assert (G3 : (R + eta + (K * q + T * q * q - 2 * h + sc + 3 * eta) * q) * (q * q) <= S).
    { apply Rle_trans with (2 := D6).
      replace ((R + eta + (K * q + T * q * q - 2 * h + sc + 3 * eta) * q) * (q * q))
        with (((R + eta) * q + (K * q + T * q * q - 2 * h + sc + 3 * eta) * (q * q)) * q) by ring.
      apply Rmult_le_compat_r; lra. }
    apply Rle_trans with ((R + eta + (K * q + T * q * q - 2 * h + sc + 3 * eta) * q) * (q * q) * (f * q)).
    + replace ((R + eta + (K * q + T * q * q - 2 * h + sc + 3 * eta) * q) * (q * q) * (f * q))
        with (R * (f * (q * q * q)) + K * (f * (q * q * q * q * q)) + T * (f * (q * q * q * q * q * q))
              + sc * (f * (q * q * q * q)) + eta * (f * (q * q * q)) + (3 * eta - 2 * h) * (f * (q * q * q * q)))
        by ring.
      assert (0 <= (3 * eta - 2 * h) * (f * (q * q * q * q))) by (apply Rmult_le_pos; lra).
      assert (R <= R * (f * (q * q * q))) by (apply no_less; [lra | apply f_q3]). assert (K <= K * (f * (q * q * q * q * q))) by (apply no_less; [lra | apply f_q5]).
      assert (T <= T * (f * (q * q * q * q * q * q))) by (apply no_less; [lra | apply f_q6]).
      assert (sc <= sc * (f * (q * q * q * q))) by (apply no_less; [lra | apply f_q4]).
      assert (eta <= eta * (f * (q * q * q))) by (apply no_less; [lra | apply f_q3]). lra.
    + apply Rmult_le_compat_r; auto. lra.
  - intros C.
    assert (L1 : S1 <= S) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L2 : R0 <= S) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L3 : P <= S1) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L4 : C3 <= S1) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L5 : P1 <= P) by (apply rnd_above; [apply rnd_number | lra]).
    assert (L6 : P2 <= P) by (apply rnd_above; [apply rnd_number | lra]).
    assert (E1 : S = R0 + S1) by (apply sum_subnormal; auto; apply rnd_number).
    assert (E2 : S1 = P + C3).
    { apply sum_subnormal; auto; try apply rnd_number. fold S1. lra. }
    assert (E3 : R0 = R + eta).
    { apply sum_subnormal; auto using number_eta; try lra; [apply rnd_number |].
      change (R0 < smallest_normal). lra. }
    assert (E4 : P = P1 + P2).
    { apply sum_subnormal; auto; try apply rnd_number. fold P. lra. }
    assert (E5 : C3 = sc + 3 * eta).
    { apply sum_subnormal; auto using number_3_eta; try lra. fold C3. lra. }
    assert (D1 : K - h <= P1).
    { apply rnd_absolute; auto. apply rnd_subnormal. change (fl K) with P1. lra. }
    assert (D2 : sa * t - h <= P2).
    { apply rnd_absolute; [apply Rmult_le_pos; lra |]. apply rnd_subnormal. fold P2. lra. }
    apply Rle_trans with ((R + eta + (K - h + (T * q - h) + (sc + 3 * eta))) * f);
      [| rewrite E1, E2, E3, E4, E5; apply Rmult_le_compat_r; lra].
    replace ((R + eta + (K - h + (T * q - h) + (sc + 3 * eta))) * f)
      with (R * f + K * f + T * (f * q) + sc * f + (4 * eta - 2 * h) * f) by ring.
    assert (R <= R * f) by (apply no_less; lra). assert (K <= K * f) by (apply no_less; lra).
    assert (T <= T * (f * q)) by (apply no_less; [lra | apply f_q1]).
    assert (sc <= sc * f) by nra. assert (4 * eta - 2 * h <= (4 * eta - 2 * h) * f) by nra. lra.
Qed.

End Proof.
End Functions.

(** The theorems. *)
Section Sound.

Variables p emin : Z.
Context {p_positive : Prec_gt_0 p}.
Notation number := (number p emin).

Section Any_direction.

Hypothesis p_5 : (5 <= p)%Z.
Variable direction : R -> Z.
Context {direction_valid : Valid_rnd direction}.
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
(** The quotient in the code is one. *)
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

End To_nearest.
End Sound.
