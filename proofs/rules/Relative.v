(** Bound rule `relative` (include/errbound/rules/relative.hpp), as the C++ code computes it, to nearest, ties to
    even. Numbers have p >= 4 digits. Counts have q >= p digits, double in the code (q >= 24, with a small enough
    eta). A number x has a value v and a count k: v and x have one sign, or both are 0, and differ by at most a
    factor e^(kw), w = - ln(1 - u), which is `close v x (k w)`. Roundings of counts are bounded in units of v = 2^-q
    (chain_down, chain_up); `slack` covers fourteen roundings and its own. Results:
        relative_exact_sound, relative_within_sound, relative_negate_sound, relative_add_sound,
            relative_subtract_sound,
        relative_multiply_sound, relative_divide_sound, relative_scale_sound   the returned count holds if it is
            finite
        relative_error_sound   the returned error is a bound
        relative_sign_sound    the sign is right or uncertain *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format ErrorFree Upper.
From Errbound Require Code.
Open Scope R_scope.

(** Two inequalities, each by the derivative of a difference that is 0 at 0. *)
Lemma not_below_start f f' b :
  (forall x, 0 <= x < b -> derivable_pt_lim f x (f' x)) -> (forall x, 0 <= x < b -> 0 <= f' x) ->
  forall x, 0 <= x < b -> f 0 <= f x.
Proof.
  intros D S x H. destruct (Req_dec x 0) as [-> | N]; [lra |].
  destruct (MVT_cor2 f f' 0 x) as (c & E & C); [lra | intros c C; apply D; lra |].
  generalize (S c ltac:(lra)). intros. assert (0 <= f' c * (x - 0)) by (apply Rmult_le_pos; lra). lra.
Qed.
Lemma derivable_difference c x : derivable_pt_lim (fun x => c - x) x (-1).
Proof.
  replace (-1) with (0 - 1) by ring.
  apply (derivable_pt_lim_minus (fun _ => c) id x 0 1).
  - apply derivable_pt_lim_const.
  - apply derivable_pt_lim_id.
Qed.
Lemma derivable_inverse c x : c - x <> 0 -> derivable_pt_lim (fun x => / (c - x)) x (/ (c - x) ^ 2).
Proof.
  intros N.
  replace (/ (c - x) ^ 2) with ((0 * (c - x) - -1 * 1) / Rsqr (c - x)).
  - intros e E. destruct (derivable_pt_lim_div (fun _ => 1) (fun x => c - x) x 0 (-1)
      (derivable_pt_lim_const 1 x) (derivable_difference c x) N e E) as [d H].
    exists d. intros h H0 H1. specialize (H h H0 H1). unfold div_fct, Rdiv in *.
    now rewrite !Rmult_1_l in H.
  - unfold Rsqr. field. exact N.
Qed.
Lemma derivable_ln_difference c x : 0 < c - x -> derivable_pt_lim (fun x => ln (c - x)) x (- / (c - x)).
Proof.
  intros P. replace (- / (c - x)) with (/ (c - x) * -1) by ring.
  apply (derivable_pt_lim_comp (fun x => c - x) ln).
  - apply derivable_difference.
  - now apply derivable_pt_lim_ln.
Qed.

Lemma minus_ln_le r : 0 <= r < 1 -> - ln (1 - r) <= r * (6 - 5 * r) / (2 * (1 - r) * (3 - r)).
Proof.
  intros H.
  assert (P : / 4 * / (1 - 0) + 27 / 4 * / (3 - 0) + ln (1 - 0) <=
              / 4 * / (1 - r) + 27 / 4 * / (3 - r) + ln (1 - r)).
  { apply (not_below_start (fun r => / 4 * / (1 - r) + 27 / 4 * / (3 - r) + ln (1 - r))
             (fun r => / 4 * / (1 - r) ^ 2 + 27 / 4 * / (3 - r) ^ 2 + - / (1 - r)) 1); auto.
    - intros x X.
      apply (derivable_pt_lim_plus (fun r => / 4 * / (1 - r) + 27 / 4 * / (3 - r)) (fun r => ln (1 - r))).
      + apply (derivable_pt_lim_plus (fun r => / 4 * / (1 - r)) (fun r => 27 / 4 * / (3 - r)));
          apply (derivable_pt_lim_scal (fun r => / (_ - r))); apply derivable_inverse; lra.
      + apply derivable_ln_difference. lra.
    - intros x X.
      replace (/ 4 * / (1 - x) ^ 2 + 27 / 4 * / (3 - x) ^ 2 + - / (1 - x)) with
        (x ^ 3 * / ((1 - x) ^ 2 * (3 - x) ^ 2)) by (field; lra).
      apply Rmult_le_pos; [apply pow_le; lra |]. left. apply Rinv_0_lt_compat.
      apply Rmult_lt_0_compat; apply pow_lt; lra. }
  replace (1 - 0) with 1 in P by ring. rewrite ln_1 in P.
  replace (r * (6 - 5 * r) / (2 * (1 - r) * (3 - r))) with
    (/ 4 * / (1 - r) + 27 / 4 * / (3 - r) - 5 / 2) by (field; lra).
  lra.
Qed.

Lemma minus_ln_ge r : 0 <= r < 1 -> r + r * r / 2 <= - ln (1 - r).
Proof.
  intros H.
  assert (P : - ln (1 - 0) - (0 + / 2 * (0 * 0)) <= - ln (1 - r) - (r + / 2 * (r * r))).
  { apply (not_below_start (fun r => - ln (1 - r) - (r + / 2 * (r * r)))
             (fun r => - - / (1 - r) - (1 + / 2 * (1 * r + r * 1))) 1); auto.
    - intros x X.
      apply (derivable_pt_lim_minus (fun r => - ln (1 - r)) (fun r => r + / 2 * (r * r))).
      + apply (derivable_pt_lim_opp (fun r => ln (1 - r))), derivable_ln_difference. lra.
      + apply (derivable_pt_lim_plus id (fun r => / 2 * (r * r))); [apply derivable_pt_lim_id |].
        apply (derivable_pt_lim_scal (fun r => r * r)).
        apply (derivable_pt_lim_mult id id); apply derivable_pt_lim_id.
    - intros x X.
      replace (- - / (1 - x) - (1 + / 2 * (1 * x + x * 1))) with (x ^ 2 * / (1 - x)) by (field; lra).
      apply Rmult_le_pos; [apply pow_le; lra |]. left. apply Rinv_0_lt_compat. lra. }
  replace (1 - 0) with 1 in P by ring. rewrite ln_1 in P. lra.
Qed.

Lemma exp_minus_1_le l : 0 <= l < 2 -> exp l - 1 <= l / (1 - l / 2).
Proof.
  intros H.
  assert (P : - ln (2 - 0) + ln (2 - - 0) - 0 <= - ln (2 - l) + ln (2 - - l) - l).
  { apply (not_below_start (fun l => - ln (2 - l) + ln (2 - - l) - l)
             (fun l => - - / (2 - l) + - / (2 - - l) * -1 - 1) 2); auto.
    - intros x X.
      apply (derivable_pt_lim_minus (fun l => - ln (2 - l) + ln (2 - - l)) id).
      + apply (derivable_pt_lim_plus (fun l => - ln (2 - l)) (fun l => ln (2 - - l))).
        * apply (derivable_pt_lim_opp (fun l => ln (2 - l))), derivable_ln_difference. lra.
        * apply (derivable_pt_lim_comp Ropp (fun l => ln (2 - l))).
          -- apply (derivable_pt_lim_opp id x 1), derivable_pt_lim_id.
          -- apply derivable_ln_difference. lra.
      + apply derivable_pt_lim_id.
    - intros x X.
      replace (- - / (2 - x) + - / (2 - - x) * -1 - 1) with (x ^ 2 * / ((2 - x) * (2 + x)))
        by (field; lra).
      apply Rmult_le_pos; [apply pow_le; lra |]. left. apply Rinv_0_lt_compat.
      apply Rmult_lt_0_compat; lra. }
  replace (2 - - l) with (2 + l) in P by ring. replace (2 - - 0) with (2 - 0) in P by ring.
  assert (E : exp l <= (2 + l) / (2 - l)).
  { rewrite <- (exp_ln ((2 + l) / (2 - l))) by (apply Rdiv_lt_0_compat; lra).
    apply exp_le. unfold Rdiv. rewrite ln_mult, ln_Rinv; try lra.
    apply Rinv_0_lt_compat; lra. }
  replace (l / (1 - l / 2)) with ((2 + l) / (2 - l) - 1) by (field; lra). lra.
Qed.

(** v and x have one sign, and a quotient between e^-l and e^l; or both are 0. *)
Definition close (v x l : R) : Prop :=
  0 <= v * x /\ Rabs v <= Rabs x * exp l /\ Rabs x <= Rabs v * exp l.

Lemma close_exact v : close v v 0.
Proof. unfold close. rewrite exp_0, Rmult_1_r. split; [apply Rle_0_sqr | lra]. Qed.
Lemma close_weaken v x l m : close v x l -> l <= m -> close v x m.
Proof.
  intros (S & A & B) H. apply exp_le in H. generalize (Rabs_pos v) (Rabs_pos x). intros.
  split; [exact S |]. split; [apply Rle_trans with (1 := A) | apply Rle_trans with (1 := B)];
    apply Rmult_le_compat_l; auto.
Qed.
Lemma close_0 v x l : close v x l -> v = 0 <-> x = 0.
Proof.
  intros (_ & A & B). split; intros ->; rewrite Rabs_R0, Rmult_0_l in *;
    apply Rabs_eq_R0; apply Rle_antisym; auto using Rabs_pos.
Qed.
Lemma close_trans v y x l m : close v y l -> close y x m -> close v x (l + m).
Proof.
  intros C1 C2. destruct (Req_dec y 0) as [-> | N].
  - assert (x = 0) as -> by now apply (close_0 0 x m).
    assert (v = 0) as -> by now apply (close_0 v 0 l).
    unfold close. rewrite Rabs_R0. lra.
  - destruct C1 as (S1 & A1 & B1), C2 as (S2 & A2 & B2). rewrite !Rplus_comm with (r1 := l).
    generalize (exp_pos l) (exp_pos m). intros.
    unfold close. rewrite exp_plus. repeat split.
    + assert (0 <= (v * x) * Rsqr y).
      { unfold Rsqr. replace (v * x * (y * y)) with ((v * y) * (y * x)) by ring. now apply Rmult_le_pos. }
      assert (0 < Rsqr y) by now apply Rlt_0_sqr.
      apply Rmult_le_reg_r with (Rsqr y); auto. now rewrite Rmult_0_l.
    + apply Rle_trans with (1 := A1). rewrite <- Rmult_assoc. apply Rmult_le_compat_r; lra.
    + apply Rle_trans with (1 := B2). rewrite (Rmult_comm (exp m)), <- Rmult_assoc.
      apply Rmult_le_compat_r; lra.
Qed.
Lemma close_multiply a x b y l m : close a x l -> close b y m -> close (a * b) (x * y) (l + m).
Proof.
  intros (S1 & A1 & B1) (S2 & A2 & B2). unfold close. rewrite !Rabs_mult, exp_plus.
  replace (a * b * (x * y)) with ((a * x) * (b * y)) by ring.
  replace (Rabs x * Rabs y * (exp l * exp m)) with ((Rabs x * exp l) * (Rabs y * exp m)) by ring.
  replace (Rabs a * Rabs b * (exp l * exp m)) with ((Rabs a * exp l) * (Rabs b * exp m)) by ring.
  repeat split; [now apply Rmult_le_pos | |]; apply Rmult_le_compat; auto using Rabs_pos.
Qed.
Lemma close_inverse b y m : b <> 0 -> close b y m -> close (/ b) (/ y) m.
Proof.
  intros N C. assert (y <> 0) by (intros E; apply N; now apply (close_0 _ _ _ C)).
  destruct C as (S & A & B). unfold close. rewrite !Rabs_inv.
  assert (0 < Rabs b) by now apply Rabs_pos_lt. assert (0 < Rabs y) by now apply Rabs_pos_lt.
  repeat split.
  - rewrite <- Rinv_mult. destruct S as [S | S].
    + left. now apply Rinv_0_lt_compat.
    + rewrite <- S, Rinv_0. lra.
  - apply Rmult_le_reg_r with (Rabs b * Rabs y); [now apply Rmult_lt_0_compat |].
    replace (/ Rabs b * (Rabs b * Rabs y)) with (Rabs y) by (field; lra).
    replace (/ Rabs y * exp m * (Rabs b * Rabs y)) with (Rabs b * exp m) by (field; lra). exact B.
  - apply Rmult_le_reg_r with (Rabs b * Rabs y); [now apply Rmult_lt_0_compat |].
    replace (/ Rabs y * (Rabs b * Rabs y)) with (Rabs b) by (field; lra).
    replace (/ Rabs b * exp m * (Rabs b * Rabs y)) with (Rabs y * exp m) by (field; lra). exact A.
Qed.
Lemma close_opp v x l : close v x l -> close (- v) (- x) l.
Proof.
  intros (S & A & B). unfold close. rewrite !Rabs_Ropp. repeat split; auto.
  now replace (- v * - x) with (v * x) by ring.
Qed.
Lemma close_factor c v x l : close v x l -> close (v * c) (x * c) l.
Proof.
  intros (S & A & B). unfold close. rewrite !Rabs_mult.
  replace (v * c * (x * c)) with ((v * x) * (c * c)) by ring.
  replace (Rabs x * Rabs c * exp l) with (Rabs x * exp l * Rabs c) by ring.
  replace (Rabs v * Rabs c * exp l) with (Rabs v * exp l * Rabs c) by ring.
  repeat split; [apply Rmult_le_pos; auto; apply Rle_0_sqr | |];
    apply Rmult_le_compat_r; auto using Rabs_pos.
Qed.
(** The signs of close numbers are equal. *)
Lemma close_nonnegative v x l : close v x l -> 0 <= v -> 0 <= x.
Proof.
  intros C P. destruct (Req_dec v 0) as [-> | N].
  - right. symmetry. now apply (close_0 0 x l).
  - destruct C as (S & _). apply Rmult_le_reg_l with v; [lra |]. now rewrite Rmult_0_r.
Qed.
Lemma close_add_nonnegative a x b y l : close a x l -> close b y l -> 0 <= a -> 0 <= b ->
  close (a + b) (x + y) l.
Proof.
  intros C1 C2 A B. generalize (close_nonnegative _ _ _ C1 A) (close_nonnegative _ _ _ C2 B).
  intros X Y. destruct C1 as (S1 & A1 & B1), C2 as (S2 & A2 & B2). unfold close.
  rewrite !Rabs_pos_eq in * by lra. repeat split; [apply Rmult_le_pos; lra | lra | lra].
Qed.
Lemma close_add a x b y l : close a x l -> close b y l -> (0 <= a /\ 0 <= b) \/ (a <= 0 /\ b <= 0) ->
  close (a + b) (x + y) l.
Proof.
  intros C1 C2 [[A B] | [A B]]; [now apply close_add_nonnegative |].
  apply close_opp in C1, C2. rewrite <- (Ropp_involutive (a + b)), <- (Ropp_involutive (x + y)).
  apply close_opp. rewrite !Ropp_plus_distr. apply close_add_nonnegative; auto; lra.
Qed.

(** The count of an absolute error, and the reverse. *)
Lemma close_within v x e r : Rabs (v - x) <= e -> e <= r * Rabs v -> r < 1 ->
  0 <= r -> close v x (- ln (1 - r)).
Proof.
  intros D E R R0. generalize (Rabs_pos v) (Rabs_pos x). intros Pv Px.
  assert (I : exp (- ln (1 - r)) = / (1 - r)) by (rewrite exp_Ropp, exp_ln; lra).
  assert (D' : Rabs (v - x) <= r * Rabs v) by lra.
  assert (Rabs x <= (1 + r) * Rabs v).
  { replace x with (v - (v - x)) by ring. eapply Rle_trans; [apply Rabs_triang |].
    rewrite Rabs_Ropp. lra. }
  assert ((1 - r) * Rabs v <= Rabs x).
  { assert (Rabs v <= Rabs x + Rabs (v - x)); [| lra].
    replace v with (x + (v - x)) at 1 by ring. apply Rabs_triang. }
  unfold close. rewrite I. repeat split.
  - destruct (Req_dec v 0) as [-> | N]; [lra |].
    apply Rabs_le_inv in D'. unfold Rabs in D'. destruct (Rcase_abs v); nra.
  - apply Rmult_le_reg_r with (1 - r); [lra |].
    replace (Rabs x * / (1 - r) * (1 - r)) with (Rabs x) by (field; lra). lra.
  - apply Rmult_le_reg_r with (1 - r); [lra |].
    replace (Rabs v * / (1 - r) * (1 - r)) with (Rabs v) by (field; lra).
    assert ((1 + r) * (1 - r) <= 1) by nra. nra.
Qed.
Lemma close_error v x l : 0 <= l -> close v x l -> Rabs (v - x) <= Rabs v * (exp l - 1).
Proof.
  intros L (S & A & B). generalize (Rabs_pos v) (Rabs_pos x). intros Pv Px.
  assert (E : 1 <= exp l) by (rewrite <- exp_0; now apply exp_le).
  assert (H : Rabs (v - x) = Rabs (Rabs v - Rabs x)).
  { destruct (Rle_or_lt 0 v) as [V | V].
    - destruct (Rle_or_lt 0 x) as [X | X]; [now rewrite (Rabs_pos_eq v), (Rabs_pos_eq x) by lra |].
      assert (v = 0) as -> by nra.
      now rewrite Rabs_R0, Rminus_0_l, !Rabs_Ropp, Rminus_0_l, Rabs_Ropp, Rabs_Rabsolu.
    - destruct (Rle_or_lt x 0) as [X | X].
      + rewrite (Rabs_left1 v), (Rabs_left1 x) by lra. rewrite <- (Rabs_Ropp (v - x)). f_equal. ring.
      + nra. }
  rewrite H. apply Rabs_le. split; nra.
Qed.

(** Arithmetic of counts, in doubles. *)
Section Counts.

Context (q qmin : Z) {q_positive : Prec_gt_0 q}.

Notation dl := (rnd q qmin nearest).
Notation double := (Format.number q qmin).
Notation v := (Format.u q).
Notation deps := (Format.eps q).
Notation deta := (Format.eta qmin).
Notation normal := (Format.smallest_normal q qmin).

Definition slack : R := dl (1 + dl (8 * deps)).

Context (q_24 : (24 <= q)%Z) (qmin_q : (qmin <= - 6 * q)%Z).

Lemma v_small : 0 < v <= / 16777216.
Proof.
  split; [apply u_positive |]. generalize (eps_le q 24 q_24) (eps_2u q). simpl. lra.
Qed.
Lemma normal_le_v2 : normal <= v * v.
Proof. unfold Format.u. rewrite <- bpow_plus. apply bpow_le. lia. Qed.
Lemma normal_le_v4 : normal <= v * v * v * v.
Proof. unfold Format.u. rewrite <- !bpow_plus. apply bpow_le. lia. Qed.

Lemma slack_is : slack = 1 + 16 * v.
Proof.
  unfold slack. rewrite (eps_2u q). replace (8 * (2 * v)) with (16 * v) by ring.
  assert (E : dl (16 * v) = 16 * v).
  { apply rnd_exact; auto with typeclass_instances. unfold Format.u. change 16 with (bpow radix2 4).
    rewrite <- bpow_plus. apply number_power; auto. lia. }
  rewrite E. apply rnd_exact; auto with typeclass_instances. unfold Format.u.
  replace (1 + 16 * bpow radix2 (- q)) with (IZR (2 ^ (q - 4) + 1) * bpow radix2 (4 - q)).
  - apply number_integer; auto; [lia |].
    assert (2 ^ q = 2 * 2 ^ (q - 1) /\ 2 ^ (q - 1) = 8 * 2 ^ (q - 4))%Z as [E1 E2].
    { split.
      - replace q with (1 + (q - 1))%Z at 1 by lia. rewrite Z.pow_add_r by lia. reflexivity.
      - replace (q - 1)%Z with (3 + (q - 4))%Z by lia. rewrite Z.pow_add_r by lia. reflexivity. }
    assert (2 ^ 1 <= 2 ^ (q - 4))%Z by (apply Z.pow_le_mono_r; lia). lia.
  - rewrite plus_IZR. change 2%Z with (radix_val radix2) at 1. rewrite IZR_Zpower by lia.
    rewrite Rmult_plus_distr_r, <- bpow_plus. replace (q - 4 + (4 - q))%Z with 0%Z by lia.
    replace (4 - q)%Z with (4 + - q)%Z by lia. rewrite bpow_plus.
    change (bpow radix2 4) with 16. change (bpow radix2 0) with 1. ring.
Qed.

Lemma down x : normal <= x -> x * (1 - v) <= dl x.
Proof.
  intros H. apply (rnd_relative q qmin nearest v (deta / 2)); auto.
  apply rounding_error_nearest; auto. lia.
Qed.
Lemma up x : normal <= x -> dl x <= x * (1 + v).
Proof.
  intros H. generalize (smallest_normal_positive q qmin). intros P.
  generalize (error_relative q qmin nearest _ _ (rounding_error_nearest q qmin ltac:(lia)) x).
  rewrite Rabs_pos_eq by lra. intros E. specialize (E H). apply Rabs_le_inv in E. lra.
Qed.
Lemma up_any x : 0 <= x -> dl x <= x * (1 + v) + deta.
Proof.
  intros P. generalize (eta_positive qmin) v_small. intros Pe Pv.
  destruct (Rle_or_lt normal x) as [H | H]; [generalize (up x H); lra |].
  generalize (error_absolute q qmin nearest _ _ (rounding_error_nearest q qmin ltac:(lia)) x).
  rewrite Rabs_pos_eq by auto. intros E. specialize (E H). apply Rabs_le_inv in E. nra.
Qed.
Lemma down_any x : 0 <= x -> x * (1 - v) - deta / 2 <= dl x.
Proof.
  intros P. generalize (eta_positive qmin) v_small. intros Pe Pv.
  destruct (Rle_or_lt normal x) as [H | H]; [generalize (down x H); lra |].
  generalize (error_absolute q qmin nearest _ _ (rounding_error_nearest q qmin ltac:(lia)) x).
  rewrite Rabs_pos_eq by auto. intros E. specialize (E H). apply Rabs_le_inv in E. nra.
Qed.

(** A small addend is rounded away if the other number has few digits. *)
Lemma lost g t k : (qmin + q <= k)%Z -> double g -> bpow radix2 (k - 1) <= g - t -> g <= bpow radix2 k ->
  (exists n, g = IZR n * bpow radix2 (k - q)) -> 0 <= t -> 2 * t < bpow radix2 (k - q) -> dl (g - t) = g.
Proof.
  intros K G L U (n & N) T S. set (x := dl (g - t)).
  assert (X : double x) by (apply rnd_number; auto with typeclass_instances).
  assert (XU : x <= g) by (apply rnd_below; auto with typeclass_instances; lra).
  assert (XL : bpow radix2 (k - 1) <= x).
  { apply rnd_above; auto with typeclass_instances. apply number_power; auto. lia. }
  destruct XU as [XU |]; auto. exfalso.
  assert (XP : 0 < x) by (apply Rlt_le_trans with (2 := XL); apply bpow_gt_0).
  destruct (cexp_form q qmin x X) as (m & M & _).
  assert (C : cexp radix2 (FLT_exp qmin q) x = (k - q)%Z).
  { unfold cexp. rewrite (mag_unique radix2 x k).
    - unfold FLT_exp. lia.
    - rewrite Rabs_pos_eq by lra. lra. }
  rewrite C in M.
  assert (D : bpow radix2 (k - q) <= g - x).
  { rewrite N, M, <- Rmult_minus_distr_r. rewrite <- (Rmult_1_l (bpow radix2 (k - q))) at 1.
    apply Rmult_le_compat_r; [apply bpow_ge_0 |]. rewrite <- minus_IZR. apply (IZR_le 1).
    assert (m < n)%Z; [| lia]. apply lt_IZR.
    apply Rmult_lt_reg_r with (bpow radix2 (k - q)); [apply bpow_gt_0 |]. lra. }
  assert (E : Rabs (x - (g - t)) <= Rabs (g - (g - t))).
  { destruct (round_N_pt radix2 (FLT_exp qmin q) (fun n => negb (Z.even n)) (g - t)) as [_ H].
    now apply H. }
  replace (g - (g - t)) with t in E by ring. rewrite (Rabs_pos_eq t) in E by auto.
  apply Rabs_le_inv in E. lra.
Qed.

Notation upper_count := (upper q qmin).
Definition count_sum (j k : R) : R :=
  let sum := two_sum q qmin j k in
  if Rlt_bool 0 (snd sum) then upper_count (fst sum) else fst sum.

Lemma count_sum_number j k : double (count_sum j k).
Proof.
  unfold count_sum. case Rlt_bool; [apply upper_number; auto |].
  apply rnd_number; auto with typeclass_instances.
Qed.
Lemma count_sum_sound j k : double j -> double k -> 0 <= j -> 0 <= k -> j + k <= count_sum j k.
Proof.
  intros J K PJ PK. generalize (two_sum_exact q qmin ltac:(lia) j k ltac:(lia) J K). unfold count_sum.
  intros E. case Rlt_bool_spec; intros H; [| lra].
  change (fst (two_sum q qmin j k)) with (dl (j + k)). apply upper_covers_sum; auto; try lia. lra.
Qed.

(** Numbers with p digits, p no more than those of counts. *)
Context (p : Z) (p_q : (4 <= p <= q)%Z).
Notation u := (Format.u p).

Definition of_one_factor : R := dl (dl (dl (u * dl (1 - dl (u / 2))) / dl (1 - u)) * slack).

Lemma u_bounds : v <= u <= / 16.
Proof.
  split; [apply bpow_le; lia |].
  generalize (eps_le p 4 ltac:(lia)) (eps_2u p). simpl. lra.
Qed.
Lemma normal_small : normal <= v * / 16777216.
Proof. generalize normal_le_v2 v_small. nra. Qed.

Lemma minus_ln_u : - ln (1 - u) <= u * (1 - u / 2) / (1 - u).
Proof.
  generalize u_bounds v_small. intros U V.
  apply Rle_trans with (1 := minus_ln_le u ltac:(lra)).
  replace (u * (1 - u / 2) / (1 - u)) with (u * (6 - 5 * u + u * u) / (2 * (1 - u) * (3 - u)))
    by (field; lra).
  unfold Rdiv. apply Rmult_le_compat_r.
  - left. apply Rinv_0_lt_compat. apply Rmult_lt_0_compat; lra.
  - apply Rmult_le_compat_l; nra.
Qed.

Lemma quotient_le a b c d : 0 <= a -> a <= c -> 0 < d -> d <= b -> a / b <= c / d.
Proof.
  intros A C D B. unfold Rdiv. apply Rmult_le_compat; auto.
  - left. apply Rinv_0_lt_compat. lra.
  - now apply Rinv_le.
Qed.


(** Lower and upper bounds of computed numbers, in units of v. *)
Lemma chain_down x y n : 0 <= x -> 0 <= n -> x * (1 - n * v) <= y -> normal <= y ->
  x * (1 - (n + 1) * v) <= dl y.
Proof.
  intros X N H Y. generalize v_small (down y Y). intros V D. apply Rle_trans with (2 := D).
  apply Rle_trans with (x * (1 - n * v) * (1 - v)); [| apply Rmult_le_compat_r; lra].
  rewrite Rmult_assoc. apply Rmult_le_compat_l; auto.
  assert (0 <= n * (v * v)) by (repeat apply Rmult_le_pos; lra). lra.
Qed.
Lemma chain_up x y n : 0 <= x -> 0 <= n <= 100 -> y <= x * (1 + n * v) -> normal <= y ->
  dl y <= x * (1 + (n + 101 / 100) * v).
Proof.
  intros X N H Y. generalize v_small (up y Y). intros V D. apply Rle_trans with (1 := D).
  apply Rle_trans with (x * (1 + n * v) * (1 + v)); [apply Rmult_le_compat_r; lra |].
  rewrite Rmult_assoc. apply Rmult_le_compat_l; auto.
  assert (n * (v * v) <= 100 * (v * v)).
  { apply Rmult_le_compat_r; [apply Rmult_le_pos |]; lra. }
  assert (v * v <= v * / 16777216) by (apply Rmult_le_compat_l; lra). lra.
Qed.
Lemma product_lower a b x y m n : 0 <= x -> 0 <= y -> 0 <= m -> 0 <= n <= 100 ->
  x * (1 - m * v) <= a -> y * (1 - n * v) <= b -> 0 <= a -> x * y * (1 - (m + n) * v) <= a * b.
Proof.
  intros X Y M N A B P. generalize v_small. intros V.
  assert (NV : n * v <= 1) by (apply Rle_trans with (100 * v); [apply Rmult_le_compat_r |]; lra).
  apply Rle_trans with (x * (1 - m * v) * (y * (1 - n * v))).
  - replace (x * (1 - m * v) * (y * (1 - n * v))) with
      (x * y * (1 - (m + n) * v + (m * v) * (n * v))) by ring.
    apply Rmult_le_compat_l; [now apply Rmult_le_pos |].
    assert (0 <= (m * v) * (n * v)) by (repeat apply Rmult_le_pos; lra). lra.
  - apply Rle_trans with (a * (y * (1 - n * v))).
    + apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra.
    + now apply Rmult_le_compat_l.
Qed.
Lemma quotient_lower a b x y m n : 0 <= x -> 0 < y -> 0 <= m <= 100 -> 0 <= n <= 100 ->
  x * (1 - m * v) <= a -> b <= y * (1 + n * v) -> 0 < b -> x / y * (1 - (m + n) * v) <= a / b.
Proof.
  intros X Y M N A B P. generalize v_small. intros V.
  assert (NV : 0 <= n * v) by (apply Rmult_le_pos; lra).
  assert (MV : 0 <= m * v) by (apply Rmult_le_pos; lra).
  assert (MV1 : m * v <= 1) by (apply Rle_trans with (100 * v); [apply Rmult_le_compat_r |]; lra).
  apply Rle_trans with (x * (1 - m * v) / (y * (1 + n * v))).
  - replace (x * (1 - m * v) / (y * (1 + n * v))) with (x / y * ((1 - m * v) / (1 + n * v)))
      by (field; lra).
    apply Rmult_le_compat_l.
    + apply Rmult_le_pos; auto. left. now apply Rinv_0_lt_compat.
    + apply Rmult_le_reg_r with (1 + n * v); [lra |].
      replace ((1 - m * v) / (1 + n * v) * (1 + n * v)) with (1 - m * v) by (field; lra).
      assert (0 <= (m * v) * (n * v)) by (apply Rmult_le_pos; lra).
      assert (0 <= (n * v) * (n * v)) by (apply Rmult_le_pos; lra). lra.
  - apply quotient_le; auto. apply Rmult_le_pos; lra.
Qed.
(** The slack covers fourteen roundings and its own. *)
Lemma slack_pays x y n : 0 <= x -> 0 <= n <= 29 / 2 -> x * (1 - n * v) <= y -> normal <= y ->
  x <= dl (y * slack).
Proof.
  intros X N H Y. rewrite slack_is. generalize v_small (smallest_normal_positive q qmin).
  intros V P.
  assert (D : y * (1 + 16 * v) * (1 - v) <= dl (y * (1 + 16 * v))).
  { apply down. apply Rle_trans with (y * 1); [lra | apply Rmult_le_compat_l; lra]. }
  apply Rle_trans with (2 := D).
  apply Rle_trans with (x * (1 - n * v) * ((1 + 16 * v) * (1 - v))).
  - rewrite Rmult_assoc. rewrite <- (Rmult_1_r x) at 1. apply Rmult_le_compat_l; auto.
    apply Rle_trans with ((1 - 29 / 2 * v) * ((1 + 16 * v) * (1 - v))).
    + assert (0 <= v * (/ 2 - 300 * v)) by (apply Rmult_le_pos; lra).
      assert (0 <= v * v * v) by (repeat apply Rmult_le_pos; lra). lra.
    + apply Rmult_le_compat_r; [apply Rmult_le_pos; lra |].
      assert (n * v <= 29 / 2 * v) by (apply Rmult_le_compat_r; lra). lra.
  - rewrite (Rmult_assoc y). apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra.
Qed.

Lemma of_one_factor_sound : - ln (1 - u) <= of_one_factor.
Proof.
  generalize u_bounds v_small normal_small. intros U V N.
  apply Rle_trans with (1 := minus_ln_u). unfold of_one_factor.
  assert (E1 : dl (u / 2) = u / 2).
  { apply rnd_exact; auto with typeclass_instances.
    replace (u / 2) with (bpow radix2 (- p - 1)); [apply number_power; auto; lia |].
    unfold Format.u. replace (- p - 1)%Z with (- p + -1)%Z by lia. rewrite bpow_plus.
    change (bpow radix2 (-1)) with (/ 2). reflexivity. }
  rewrite E1.
  assert (UV : 0 <= u * v <= v).
  { split; [apply Rmult_le_pos; lra |]. rewrite <- (Rmult_1_l v) at 2. apply Rmult_le_compat_r; lra. }
  assert (D1 := chain_down (1 - u / 2) (1 - u / 2) 0 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)).
  set (a := dl (1 - u / 2)) in *.
  assert (A : 9 / 10 <= a) by lra.
  assert (NA : v * (9 / 10) <= u * a) by (apply Rmult_le_compat; lra).
  assert (D2 := chain_down (u * (1 - u / 2)) (u * a) 1 ltac:(apply Rmult_le_pos; lra) ltac:(lra)
    ltac:(rewrite Rmult_assoc; apply Rmult_le_compat_l; lra) ltac:(lra)).
  assert (D2' := down (u * a) ltac:(lra)).
  set (b := dl (u * a)) in *.
  assert (U3 := chain_up (1 - u) (1 - u) 0 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)).
  assert (L3 := down (1 - u) ltac:(lra)).
  set (c := dl (1 - u)) in *.
  assert (C : 9 / 10 <= c <= 1).
  { split; [lra |]. apply rnd_below; auto with typeclass_instances; [| lra].
    change 1 with (bpow radix2 0). apply number_power; auto. lia. }
  assert (B : v / 2 <= b) by nra.
  replace (1 + 1) with 2 in D2 by ring. replace (0 + 101 / 100) with (101 / 100) in U3 by ring.
  assert (Q := quotient_lower b c (u * (1 - u / 2)) (1 - u) 2 (101 / 100) ltac:(apply Rmult_le_pos; lra)
    ltac:(lra) ltac:(lra) ltac:(lra) D2 U3 ltac:(lra)).
  assert (BC : v / 2 <= b / c).
  { apply Rle_trans with (b / 1); [lra |]. apply quotient_le; lra. }
  set (x := u * (1 - u / 2) / (1 - u)) in *.
  assert (X : 0 <= x).
  { unfold x, Rdiv. apply Rmult_le_pos; [apply Rmult_le_pos; lra |]. left. apply Rinv_0_lt_compat. lra. }
  assert (D4 := chain_down x (b / c) (2 + 101 / 100) X ltac:(lra) Q ltac:(lra)).
  assert (D5 := down (b / c) ltac:(lra)).
  apply slack_pays with (n := 2 + 101 / 100 + 1); auto; [lra |].
  apply Rle_trans with (2 := D5). apply Rle_trans with (v / 2 * (1 - v)); [| apply Rmult_le_compat_r; lra].
  assert (v * v <= v * / 16777216) by (apply Rmult_le_compat_l; lra). lra.
Qed.

Lemma chain_up2 x y n : 0 <= x -> 0 <= n <= 100 -> y <= x * (1 + n * v) -> normal <= y ->
  forall m, n + 101 / 100 <= m -> dl y <= x * (1 + m * v).
Proof.
  intros X N H Y m M. apply Rle_trans with (1 := chain_up x y n X N H Y).
  apply Rmult_le_compat_l; auto. generalize v_small. intros V.
  assert ((n + 101 / 100) * v <= m * v) by (apply Rmult_le_compat_r; lra). lra.
Qed.
Lemma product_upper a b x y m n : 0 <= x -> 0 <= y -> 0 <= m <= 100 -> 0 <= n <= 100 ->
  a <= x * (1 + m * v) -> b <= y * (1 + n * v) -> 0 <= a -> 0 <= b ->
  a * b <= x * y * (1 + (m + n + / 100) * v).
Proof.
  intros X Y M N A B PA PB. generalize v_small. intros V.
  apply Rle_trans with (x * (1 + m * v) * (y * (1 + n * v))); [now apply Rmult_le_compat |].
  replace (x * (1 + m * v) * (y * (1 + n * v))) with
    (x * y * (1 + (m + n) * v + (m * n) * (v * v))) by ring.
  apply Rmult_le_compat_l; [now apply Rmult_le_pos |].
  assert (m * n <= 100 * 100) by (apply Rmult_le_compat; lra).
  assert (0 <= m * n) by (apply Rmult_le_pos; lra).
  assert (v * v <= v * / 16777216) by (apply Rmult_le_compat_l; lra).
  assert (0 <= v * v) by (apply Rmult_le_pos; lra).
  assert (m * n * (v * v) <= 10000 * (v * / 16777216)) by (apply Rmult_le_compat; lra). lra.
Qed.

Definition count_of_share (r : R) : R :=
  dl (dl (dl (r * dl (6 - dl (5 * r))) / dl (dl (dl (2 * dl (1 - r)) * dl (3 - r)) * u)) * slack).

Lemma below_1 r : double r -> r < 1 -> r <= 1 - v.
Proof.
  intros N H. assert (E : pred radix2 (FLT_exp qmin q) (bpow radix2 0) = 1 - v).
  { rewrite pred_bpow; auto with typeclass_instances. simpl (bpow radix2 0). f_equal.
    unfold Format.u. f_equal. f_equal. unfold FLT_exp. lia. }
  rewrite <- E. apply pred_ge_gt; auto with typeclass_instances.
  apply (number_power q qmin). lia.
Qed.
Lemma normal_tiny : normal <= v * v * / 64.
Proof.
  generalize normal_le_v4 v_small. intros N V. apply Rle_trans with (1 := N).
  rewrite Rmult_assoc. apply Rmult_le_compat_l; [apply Rmult_le_pos; lra |].
  apply Rle_trans with (/ 16777216 * / 16777216); [apply Rmult_le_compat |]; lra.
Qed.

Lemma count_of_large_share r : double r -> v / 8 <= r < 1 ->
  r * (6 - 5 * r) / (2 * (1 - r) * (3 - r)) / u <= count_of_share r.
Proof.
  intros D H. generalize u_bounds v_small normal_small normal_tiny (below_1 r D ltac:(lra)).
  intros U V N1 N2 B.
  assert (VV : 0 < v * v <= v * / 16777216).
  { split; [apply Rmult_lt_0_compat | apply Rmult_le_compat_l]; lra. }
  assert (UV : v * v <= u * v <= v).
  { split; [apply Rmult_le_compat_r | rewrite <- (Rmult_1_l v) at 2; apply Rmult_le_compat_r]; lra. }
  assert (RV : 0 <= r * v <= v).
  { split; [apply Rmult_le_pos | rewrite <- (Rmult_1_l v) at 2; apply Rmult_le_compat_r]; lra. }
  unfold count_of_share.
  assert (T1 := chain_up (5 * r) (5 * r) 0 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)).
  set (t1 := dl (5 * r)) in *.
  assert (T1' : (6 - 5 * r) * (1 - 6 * v) <= 6 - t1) by lra.
  assert (T1n : 9 / 10 <= 6 - t1) by lra.
  assert (T2 := chain_down (6 - 5 * r) (6 - t1) 6 ltac:(lra) ltac:(lra) T1' ltac:(lra)).
  set (t2 := dl (6 - t1)) in *.
  assert (T2n : / 2 <= t2) by lra.
  assert (T2r : r * / 2 <= r * t2) by (apply Rmult_le_compat_l; lra).
  assert (T3' := product_lower r t2 r (6 - 5 * r) 0 (6 + 1) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra) T2 ltac:(lra)).
  assert (RP : 0 <= r * (6 - 5 * r)) by (apply Rmult_le_pos; lra).
  assert (T3 := chain_down (r * (6 - 5 * r)) (r * t2) (0 + (6 + 1)) RP ltac:(lra) T3' ltac:(lra)).
  assert (T3n := down (r * t2) ltac:(lra)).
  set (t3 := dl (r * t2)) in *.
  assert (T3m : v / 32 <= t3).
  { apply Rle_trans with (2 := T3n). apply Rle_trans with (v / 16 * (1 - v)); [lra |].
    apply Rmult_le_compat_r; lra. }
  assert (D1 := chain_up2 (1 - r) (1 - r) 0 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) (101 / 100) ltac:(lra)).
  assert (D1n := down (1 - r) ltac:(lra)).
  set (d1 := dl (1 - r)) in *.
  assert (D1m : v / 2 <= d1).
  { apply Rle_trans with (2 := D1n). apply Rle_trans with (v * (1 - v)); [lra |].
    apply Rmult_le_compat_r; lra. }
  assert (D2 : dl (2 * d1) <= 2 * (1 - r) * (1 + 203 / 100 * v)).
  { apply chain_up2 with (n := 101 / 100); lra. }
  assert (D2n := down (2 * d1) ltac:(lra)).
  set (d2 := dl (2 * d1)) in *.
  assert (D2m : v / 2 <= d2).
  { apply Rle_trans with (2 := D2n). apply Rle_trans with (v * (1 - v)); [lra |].
    apply Rmult_le_compat_r; lra. }
  assert (D3 := chain_up2 (3 - r) (3 - r) 0 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) (101 / 100) ltac:(lra)).
  assert (D3n := down (3 - r) ltac:(lra)).
  set (d3 := dl (3 - r)) in *.
  assert (D3m : 1 <= d3) by lra.
  assert (D4' := product_upper d2 d3 (2 * (1 - r)) (3 - r) (203 / 100) (101 / 100) ltac:(lra) ltac:(lra)
    ltac:(lra) ltac:(lra) D2 D3 ltac:(lra) ltac:(lra)).
  assert (D4n' : v / 2 <= d2 * d3).
  { rewrite <- (Rmult_1_r (v / 2)). apply Rmult_le_compat; lra. }
  assert (DP : 0 < 2 * (1 - r) * (3 - r)) by (apply Rmult_lt_0_compat; lra).
  assert (D4 := chain_up2 (2 * (1 - r) * (3 - r)) (d2 * d3) (203 / 100 + 101 / 100 + / 100) ltac:(lra)
    ltac:(lra) D4' ltac:(lra) (407 / 100) ltac:(lra)).
  assert (D4n := down (d2 * d3) ltac:(lra)).
  set (d4 := dl (d2 * d3)) in *.
  assert (D4m : v / 4 <= d4).
  { apply Rle_trans with (2 := D4n). apply Rle_trans with (v / 2 * (1 - v)); [lra |].
    apply Rmult_le_compat_r; lra. }
  assert (D5n' : v / 4 * v <= d4 * u) by (apply Rmult_le_compat; lra).
  assert (D5' : d4 * u <= 2 * (1 - r) * (3 - r) * u * (1 + 407 / 100 * v)).
  { replace (2 * (1 - r) * (3 - r) * u * (1 + 407 / 100 * v)) with
      (2 * (1 - r) * (3 - r) * (1 + 407 / 100 * v) * u) by ring. apply Rmult_le_compat_r; lra. }
  assert (DU : 0 < 2 * (1 - r) * (3 - r) * u) by (apply Rmult_lt_0_compat; lra).
  assert (D5 := chain_up2 (2 * (1 - r) * (3 - r) * u) (d4 * u) (407 / 100) ltac:(lra) ltac:(lra) D5'
    ltac:(lra) (509 / 100) ltac:(lra)).
  assert (D5n := rnd_normal q qmin nearest (d4 * u) ltac:(lra)).
  set (d5 := dl (d4 * u)) in *.
  assert (D5m : 0 < d5) by (generalize (smallest_normal_positive q qmin); lra).
  assert (D5k : d5 <= 1).
  { apply Rle_trans with (1 := D5). apply Rle_trans with (6 * / 16 * (1 + 509 / 100 * v)); [| lra].
    apply Rmult_le_compat_r; [lra |]. apply Rmult_le_compat; lra. }
  assert (Q := quotient_lower t3 d5 (r * (6 - 5 * r)) (2 * (1 - r) * (3 - r) * u) (0 + (6 + 1) + 1)
    (509 / 100) RP DU ltac:(lra) ltac:(lra) T3 D5 D5m).
  assert (QN : v / 32 <= t3 / d5).
  { apply Rle_trans with (v / 32 / 1); [lra |]. apply quotient_le; lra. }
  set (x := r * (6 - 5 * r) / (2 * (1 - r) * (3 - r) * u)) in *.
  assert (X : 0 <= x).
  { unfold x, Rdiv. apply Rmult_le_pos; auto. left. now apply Rinv_0_lt_compat. }
  assert (Q1 := chain_down x (t3 / d5) (0 + (6 + 1) + 1 + 509 / 100) X ltac:(lra) Q ltac:(lra)).
  assert (Q1n := rnd_normal q qmin nearest (t3 / d5) ltac:(lra)).
  replace (r * (6 - 5 * r) / (2 * (1 - r) * (3 - r)) / u) with x by (unfold x; field; lra).
  apply slack_pays with (n := 0 + (6 + 1) + 1 + 509 / 100 + 1); auto. lra.
Qed.

Lemma number_small n : (Z.abs n <= 16)%Z -> double (IZR n).
Proof.
  intros H. rewrite <- (Rmult_1_r (IZR n)). change 1 with (bpow radix2 0). apply number_integer; auto; [lia |].
  assert (2 ^ 4 <= 2 ^ q)%Z by (apply Z.pow_le_mono_r; lia). lia.
Qed.
(** A small whole number is a multiple of a power of two that its format has, too. *)
Lemma as_multiple n k : (k <= q)%Z -> exists m, IZR n = IZR m * bpow radix2 (k - q).
Proof.
  intros K. exists (n * 2 ^ (q - k))%Z. rewrite mult_IZR. change 2%Z with (radix_val radix2) at 1.
  rewrite IZR_Zpower by lia. rewrite Rmult_assoc, <- bpow_plus.
  replace (q - k + (k - q))%Z with 0%Z by lia. simpl (bpow radix2 0). ring.
Qed.
Lemma six_times r : double r -> 0 <= r -> 6 * r < normal -> double (6 * r).
Proof.
  intros D P H. destruct (Req_dec r 0) as [-> | N].
  { replace (6 * 0) with (IZR 0) by ring. apply number_small. lia. }
  destruct (cexp_form q qmin r D) as (m & M & _).
  assert (C : cexp radix2 (FLT_exp qmin q) r = qmin).
  { rewrite cexp_FLT_FIX; auto. rewrite Rabs_pos_eq by auto.
    apply Rlt_trans with normal; [lra |]. apply bpow_lt. lia. }
  rewrite C in M. replace (6 * r) with (IZR (6 * m) * bpow radix2 qmin) by (rewrite mult_IZR, M; ring).
  apply number_integer; auto; [lia |].
  assert (B : IZR (6 * m) < IZR (2 ^ (q - 1))).
  { apply Rmult_lt_reg_r with (bpow radix2 qmin); [apply bpow_gt_0 |].
    change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia. rewrite <- bpow_plus, mult_IZR.
    replace (q - 1 + qmin)%Z with (qmin + q - 1)%Z by lia. fold (Format.smallest_normal q qmin).
    rewrite Rmult_assoc, <- M. exact H. }
  apply lt_IZR in B.
  assert (0 <= m)%Z.
  { apply le_IZR. apply Rmult_le_reg_r with (bpow radix2 qmin); [apply bpow_gt_0 |]. lra. }
  assert (2 ^ q = 2 * 2 ^ (q - 1))%Z.
  { replace q with (1 + (q - 1))%Z at 1 by lia. rewrite Z.pow_add_r by lia. reflexivity. }
  lia.
Qed.

Lemma count_of_small_share r : double r -> 0 <= r < v / 8 -> r / u <= count_of_share r.
Proof.
  intros D H. generalize u_bounds v_small normal_small (smallest_normal_positive q qmin).
  intros U V N NP. unfold count_of_share.
  assert (P : forall k, bpow radix2 (k - q) = bpow radix2 k * v).
  { intros k. unfold Format.u. rewrite <- bpow_plus. f_equal. }
  assert (T1 : 0 <= dl (5 * r) <= v).
  { split.
    - apply rnd_nonnegative; auto with typeclass_instances. lra.
    - apply rnd_below; auto with typeclass_instances; [| lra]. apply number_power; auto. lia. }
  set (t1 := dl (5 * r)) in *.
  assert (E2 : dl (6 - t1) = 6).
  { apply lost with (k := 3%Z); auto; [lia | apply number_small; lia | simpl; lra | simpl; lra | |
      lra | rewrite P; simpl; lra].
    apply as_multiple. lia. }
  assert (E1 : dl (1 - r) = 1).
  { apply lost with (k := 0%Z); auto; [lia | apply number_small; lia | simpl; lra | simpl; lra | |
      lra | rewrite P; simpl; lra].
    apply as_multiple. lia. }
  assert (E3 : dl (3 - r) = 3).
  { apply lost with (k := 2%Z); auto; [lia | apply number_small; lia | simpl; lra | simpl; lra | |
      lra | rewrite P; simpl; lra].
    apply as_multiple. lia. }
  assert (E4 : dl (2 * 1) = 2).
  { rewrite Rmult_1_r. apply rnd_exact; auto with typeclass_instances. apply number_small. lia. }
  assert (E5 : dl (2 * 3) = 6).
  { replace (2 * 3) with 6 by ring. apply rnd_exact; auto with typeclass_instances.
    apply number_small. lia. }
  assert (E6 : dl (6 * u) = 6 * u).
  { apply rnd_exact; auto with typeclass_instances. apply number_integer; auto; [lia |].
    assert (2 ^ 4 <= 2 ^ q)%Z by (apply Z.pow_le_mono_r; lia). lia. }
  rewrite E2, E1, E3, E4, E5, E6, (Rmult_comm r).
  assert (X : 0 <= r / u).
  { unfold Rdiv. apply Rmult_le_pos; [lra |]. left. apply Rinv_0_lt_compat. lra. }
  destruct (Rle_or_lt normal (6 * r)) as [B | B].
  - assert (T3 := down (6 * r) B). assert (T3n := rnd_normal q qmin nearest (6 * r) B).
    set (t3 := dl (6 * r)) in *.
    assert (Q : r / u * (1 - 1 * v) <= t3 / (6 * u)).
    { replace (r / u * (1 - 1 * v)) with (6 * r * (1 - v) / (6 * u)) by (field; lra).
      apply quotient_le; try lra. apply Rmult_le_pos; lra. }
    assert (QN : normal <= t3 / (6 * u)).
    { apply Rle_trans with (t3 / 1); [lra |]. apply quotient_le; lra. }
    assert (Q1 := chain_down (r / u) (t3 / (6 * u)) 1 X ltac:(lra) Q QN).
    apply slack_pays with (n := 1 + 1); auto; [lra |]. exact (rnd_normal q qmin nearest _ QN).
  - assert (E7 : dl (6 * r) = 6 * r).
    { apply rnd_exact; auto with typeclass_instances. apply six_times; auto. lra. }
    rewrite E7. replace (6 * r / (6 * u)) with (r / u) by (field; lra).
    assert (S : dl (r / u) = r / u /\ double (r / u)).
    { replace (r / u) with (r * bpow radix2 p).
      - assert (S : dl (r * bpow radix2 p) = r * bpow radix2 p) by (apply scale_up; auto with typeclass_instances; lia).
        split; auto. rewrite <- S. apply rnd_number; auto with typeclass_instances.
      - unfold Rdiv, Format.u. rewrite <- bpow_opp. f_equal. f_equal. lia. }
    rewrite (proj1 S). apply rnd_above; auto with typeclass_instances; [exact (proj2 S) |].
    rewrite slack_is. rewrite <- (Rmult_1_r (r / u)) at 1. apply Rmult_le_compat_l; lra.
Qed.

Lemma count_of_share_sound r : double r -> 0 <= r < 1 -> - ln (1 - r) <= count_of_share r * - ln (1 - u).
Proof.
  intros D H. generalize u_bounds v_small. intros U V.
  generalize (minus_ln_ge u ltac:(lra)) (minus_ln_le r ltac:(lra)). intros W L.
  assert (UU : 0 <= u * u) by (apply Rmult_le_pos; lra).
  destruct (Rlt_or_le r (v / 8)) as [S | S].
  - assert (C := count_of_small_share r D ltac:(lra)).
    apply Rle_trans with (r / u * (u + u * u / 2)).
    + replace (r / u * (u + u * u / 2)) with (r * (1 + u / 2)) by (field; lra).
      apply Rle_trans with (1 := L).
      apply Rle_trans with (r * (1 + r)); [| apply Rmult_le_compat_l; lra].
      replace (r * (6 - 5 * r) / (2 * (1 - r) * (3 - r))) with
        (r * ((6 - 5 * r) * / (2 * (1 - r) * (3 - r)))) by (field; lra).
      apply Rmult_le_compat_l; [lra |].
      assert (DP : 0 < 2 * (1 - r) * (3 - r)) by (apply Rmult_lt_0_compat; lra).
      apply Rmult_le_reg_r with (2 * (1 - r) * (3 - r)); auto.
      replace ((6 - 5 * r) * / (2 * (1 - r) * (3 - r)) * (2 * (1 - r) * (3 - r))) with (6 - 5 * r)
        by (field; lra).
      assert (0 <= r * (3 - 6 * r + 2 * (r * r))).
      { apply Rmult_le_pos; [lra |]. assert (0 <= r * r) by (apply Rmult_le_pos; lra). lra. }
      lra.
    + apply Rmult_le_compat; try lra.
      unfold Rdiv. apply Rmult_le_pos; [lra |]. left. apply Rinv_0_lt_compat. lra.
  - assert (C := count_of_large_share r D ltac:(lra)).
    set (x := r * (6 - 5 * r) / (2 * (1 - r) * (3 - r))) in *.
    assert (X : 0 <= x).
    { unfold x, Rdiv. apply Rmult_le_pos; [apply Rmult_le_pos; lra |]. left. apply Rinv_0_lt_compat.
      apply Rmult_lt_0_compat; lra. }
    apply Rle_trans with (1 := L). apply Rle_trans with (x / u * u).
    + right. field. lra.
    + apply Rmult_le_compat; try lra.
      unfold Rdiv. apply Rmult_le_pos; [lra |]. left. apply Rinv_0_lt_compat. lra.
Qed.
Lemma count_of_share_number r : double (count_of_share r).
Proof. apply rnd_number; auto with typeclass_instances. Qed.
Lemma count_of_share_nonnegative r : double r -> 0 <= r < 1 -> 0 <= count_of_share r.
Proof.
  intros D H. generalize u_bounds v_small (count_of_share_sound r D H) (minus_ln_ge r H)
    (minus_ln_ge u ltac:(generalize u_bounds v_small; lra)). intros U V S A B.
  nra.
Qed.

(** The relative error of a count: at least e^(kw) - 1, w = - ln(1 - u). *)
Definition error_of_count (k : R) : option R :=
  let l := dl (upper_count (dl (k * of_one_factor)) + deta) in
  if Rlt_bool l (7 / 4) then Some (dl (dl (l / dl (1 - dl (l / 2))) * slack)) else None.

Lemma error_of_length l : double l -> normal <= l < 7 / 4 ->
  l / (1 - l / 2) <= dl (dl (l / dl (1 - dl (l / 2))) * slack).
Proof.
  intros D H. generalize v_small normal_small (smallest_normal_positive q qmin) (eta_positive qmin).
  intros V N NP EP.
  assert (EN : deta <= normal) by (apply eta_le_smallest_normal; auto).
  assert (LV : 0 <= l * v <= 7 / 4 * v).
  { split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_r; lra]. }
  assert (H1 := down_any (l / 2) ltac:(lra)). assert (H2 := up_any (l / 2) ltac:(lra)).
  set (h := dl (l / 2)) in *.
  assert (D1 := chain_up2 (1 - l / 2) (1 - h) 8 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    (902 / 100) ltac:(lra)).
  assert (D1n := rnd_normal q qmin nearest (1 - h) ltac:(lra)).
  assert (D1k : dl (1 - h) <= 1).
  { apply rnd_below; auto with typeclass_instances; [apply number_small; lia |].
    assert (0 <= h) by (apply rnd_nonnegative; auto with typeclass_instances; lra). lra. }
  set (d := dl (1 - h)) in *.
  assert (Q := quotient_lower l d l (1 - l / 2) 0 (902 / 100) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra) D1 ltac:(lra)).
  assert (QN : l / 1 <= l / d) by (apply quotient_le; lra).
  assert (X : 0 <= l / (1 - l / 2)).
  { unfold Rdiv. apply Rmult_le_pos; [lra |]. left. apply Rinv_0_lt_compat. lra. }
  assert (Q1 := chain_down (l / (1 - l / 2)) (l / d) (0 + 902 / 100) X ltac:(lra) Q ltac:(lra)).
  assert (Q1n := rnd_normal q qmin nearest (l / d) ltac:(lra)).
  apply slack_pays with (n := 0 + 902 / 100 + 1); auto. lra.
Qed.
Lemma error_of_small_length l : double l -> 0 < l < normal ->
  l <= dl (dl (l / dl (1 - dl (l / 2))) * slack).
Proof.
  intros D H. generalize v_small normal_small (eta_positive qmin). intros V N EP.
  assert (EN : deta <= normal) by (apply eta_le_smallest_normal; auto).
  assert (H0 : 0 <= dl (l / 2)) by (apply rnd_nonnegative; auto with typeclass_instances; lra).
  assert (H1 := up_any (l / 2) ltac:(lra)).
  assert (LV : l * v <= l * 1) by (apply Rmult_le_compat_l; lra).
  assert (D0 : / 2 <= dl (1 - dl (l / 2)) <= 1).
  { split.
    - apply rnd_above; auto with typeclass_instances; [| lra].
      change (/ 2) with (bpow radix2 (-1)). apply number_power; auto. lia.
    - apply rnd_below; auto with typeclass_instances; [apply number_small; lia | lra]. }
  set (d := dl (1 - dl (l / 2))) in *.
  assert (Q : l <= dl (l / d)).
  { apply rnd_above; auto with typeclass_instances. apply Rle_trans with (l / 1); [lra |].
    apply quotient_le; lra. }
  apply rnd_above; auto with typeclass_instances. rewrite slack_is.
  apply Rle_trans with (dl (l / d) * 1); [lra |]. apply Rmult_le_compat_l; lra.
Qed.

Lemma error_of_count_sound k r : double k -> 0 <= k -> error_of_count k = Some r ->
  0 <= r /\ exp (k * - ln (1 - u)) - 1 <= r.
Proof.
  unfold error_of_count. intros D P. generalize u_bounds v_small (eta_positive qmin). intros U V EP.
  generalize of_one_factor_sound (minus_ln_ge u ltac:(lra)). intros W1 W2.
  set (w := - ln (1 - u)) in *. set (z := k * of_one_factor).
  assert (UU : 0 <= u * u) by (apply Rmult_le_pos; lra).
  assert (KW : 0 <= k * w <= z) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_l]; lra).
  assert (C := upper_eta_covers q qmin ltac:(lia) ltac:(lia) z ltac:(lra)).
  assert (Z : double (dl z)) by (apply rnd_number; auto with typeclass_instances).
  assert (Z0 : 0 <= dl z) by (apply rnd_nonnegative; auto with typeclass_instances; lra).
  assert (L0 : deta <= dl (upper_count (dl z) + deta)).
  { apply rnd_above; auto with typeclass_instances; [apply number_eta; auto |].
    generalize (upper_le q qmin ltac:(lia) ltac:(lia) (dl z) Z Z0). lra. }
  assert (LN : double (dl (upper_count (dl z) + deta))) by (apply rnd_number; auto with typeclass_instances).
  assert (S := upper_eta_small q qmin ltac:(lia) ltac:(lia) (dl z) Z Z0).
  assert (LZ : dl z <= dl (upper_count (dl z) + deta)).
  { apply rnd_above; auto with typeclass_instances.
    generalize (upper_le q qmin ltac:(lia) ltac:(lia) (dl z) Z Z0). lra. }
  set (l := dl (upper_count (dl z) + deta)) in *.
  case Rlt_bool_spec; intros L; [| discriminate]. intros E. injection E. intros <-. clear E.
  assert (B := exp_minus_1_le (k * w) ltac:(lra)).
  assert (G : k * w / (1 - k * w / 2) <= dl (dl (l / dl (1 - dl (l / 2))) * slack)).
  { destruct (Rle_or_lt normal l) as [H | H].
    - apply Rle_trans with (2 := error_of_length l LN ltac:(lra)). apply quotient_le; lra.
    - apply Rle_trans with (2 := error_of_small_length l LN ltac:(lra)).
      specialize (S ltac:(lra)).
      apply Rmult_le_reg_r with (1 - k * w / 2); [lra |].
      replace (k * w / (1 - k * w / 2) * (1 - k * w / 2)) with (k * w) by (field; lra).
      assert (z <= dl z + deta / 2).
      { generalize (half_ulp q qmin z). rewrite (ulp_small q qmin) by (auto; try lia; lra). intros Hz.
        apply Rabs_le_inv in Hz. lra. }
      assert (l * (k * w) <= deta).
      { apply Rle_trans with (normal * normal); [apply Rmult_le_compat; lra |].
        unfold Format.smallest_normal, Format.eta. rewrite <- bpow_plus. apply bpow_le. lia. }
      lra. }
  split; [| lra]. apply Rle_trans with (2 := G). unfold Rdiv. apply Rmult_le_pos; [lra |].
  left. apply Rinv_0_lt_compat. lra.
Qed.

End Counts.

(** The rule: numbers with p digits, counts with q >= p. *)
Section Rule.

Context (p emin q qmin : Z) {p_positive : Prec_gt_0 p} {q_positive : Prec_gt_0 q}.

Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation u := (u p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).
Notation upper_count := (upper q qmin).
Notation upper := (upper p emin).
Notation dl := (rnd q qmin nearest).
Notation double := (Format.number q qmin).
Notation deta := (Format.eta qmin).
Notation count_sum := (count_sum q qmin).

(** The logarithm of one factor. *)
Definition w : R := - ln (1 - u).

(** The code, in its order of evaluation; None stands for an infinite count or error. *)
Definition factors_of (error size : R) : option R :=
  if Rlt_bool 0 size then
    let share := fl (upper (fl (error / size)) + eta) in
    if Rlt_bool share 1 then
      let r := dl (upper_count (dl share) + deta) in
      if Rlt_bool r 1 then Some (count_of_share q qmin p r) else None
    else None
  else None.
Definition relative_error (v k : R) : option R :=
  if Req_bool k 0 then Some 0
  else
    match error_of_count q qmin p k with
    | Some r =>
      let share := fl r in
      let share := if Rlt_bool share r then fl (upper share + eta) else share in
      Some (fl (upper (fl (Rabs v * share)) + eta))
    | None => None
    end.
(** The sign, if an error is known. *)
Definition relative_sign (v k : R) : Code.sign_type :=
  match relative_error v k with
  | None => Code.uncertain
  | Some _ =>
    if Req_bool v 0 then Code.zero else if Rlt_bool 0 v then Code.positive else Code.negative
  end.
(** For error >= 0. *)
Definition relative_within (v error : R) : option R :=
  if Req_bool error 0 then Some 0 else factors_of error (Rabs v).
Definition rounded_to (v k : R) (is_exact : bool) : option R :=
  if is_exact then Some k
  else if Rle_bool smallest_normal (Rabs v) then Some (count_sum k 1) else None.
Definition rounded_sum (k : R) (is_exact : bool) : R := if is_exact then k else count_sum k 1.
(** `is_exact`: the transformations of error_free.hpp report that the rounded sum is exact. Products and quotients
    have it, too. *)
Definition relative_add (a ka b kb : R) (is_exact : bool) : option R :=
  let v := fl (a + b) in
  let k := if Rlt_bool ka kb then kb else ka in
  if Req_bool k 0 || (Rle_bool 0 a && Rle_bool 0 b) || (Rle_bool a 0 && Rle_bool b 0)
  then Some (rounded_sum k is_exact)
  else
    match relative_error a ka, relative_error b kb with
    | Some ea, Some eb =>
      let off := upper (fl (ea + eb)) in
      let least := if is_exact then Rabs v else fl (Rabs v * fl (1 - eps)) in
      if Rlt_bool off least then
        match factors_of off least with
        | Some k => Some (rounded_sum k is_exact)
        | None => None
        end
      else None
    | _, _ => None
    end.
Definition relative_subtract (a ka b kb : R) (is_exact : bool) : option R := relative_add a ka (- b) kb is_exact.
Definition is_zero (a ka : R) : bool := Req_bool a 0 && Req_bool ka 0.
Definition relative_multiply (v a ka b kb : R) (is_exact : bool) : option R :=
  if is_zero a ka || is_zero b kb then Some 0 else rounded_to v (count_sum ka kb) is_exact.
Definition relative_divide (v a ka b kb : R) (is_exact : bool) : option R :=
  if Req_bool b 0 then None
  else if is_zero a ka then Some 0 else rounded_to v (count_sum ka kb) is_exact.
Definition relative_scale (v a ka : R) (e : Z) : option R :=
  rounded_to v ka ((0 <=? e)%Z || Req_bool (fl (v * bpow radix2 (- e))) a).

(** The meaning of a number and its count for x. *)
Definition holds (v k x : R) : Prop := number v /\ double k /\ 0 <= k /\ close v x (k * w).

Context (p_q : (4 <= p <= q)%Z) (emin_p : (emin <= - p - 1)%Z) (q_24 : (24 <= q)%Z) (qmin_q : (qmin <= - 6 * q)%Z).

Lemma u_small : 0 < u <= / 16.
Proof. split; [apply u_positive |]. generalize (eps_le p 4 ltac:(lia)) (eps_2u p). simpl. lra. Qed.
Lemma w_positive : 0 < w.
Proof.
  generalize u_small (minus_ln_ge u ltac:(generalize u_small; lra)). unfold w. intros U W.
  assert (0 <= u * u) by (apply Rmult_le_pos; lra). lra.
Qed.
Lemma double_0 : double 0.
Proof. apply number_0. Qed.
Lemma double_1 : double 1.
Proof. change 1 with (bpow radix2 0). apply number_power; auto. lia. Qed.
Lemma number_fl x : number (fl x).
Proof. apply rnd_number; auto with typeclass_instances. Qed.

(** One rounding is one factor. *)
Lemma close_rounded z : Rabs (fl z - z) <= u * Rabs (fl z) -> close (fl z) z w.
Proof.
  generalize u_small. intros U H. apply (close_within _ _ (u * Rabs (fl z))); auto; lra.
Qed.
Lemma close_rounded_normal z : smallest_normal <= Rabs (fl z) -> close (fl z) z w.
Proof.
  intros H. apply close_rounded. generalize u_small (smallest_normal_positive p emin). intros U N.
  destruct (Rle_or_lt smallest_normal (Rabs z)) as [B | B].
  - apply nearest_relative_to_result; auto; lia.
  - apply Rle_trans with (eta / 2).
    + exact (error_absolute p emin nearest _ _ (rounding_error_nearest p emin ltac:(lia)) z B).
    + rewrite <- (smallest_normal_eps p emin), (eps_2u p).
      apply Rle_trans with (u * smallest_normal); [lra |]. apply Rmult_le_compat_l; lra.
Qed.
Lemma close_rounded_sum a b : number a -> number b -> close (fl (a + b)) (a + b) w.
Proof.
  intros A B. apply close_rounded. generalize u_small. intros U.
  destruct (Rle_or_lt smallest_normal (Rabs (a + b))) as [H | H].
  - apply nearest_relative_to_result; auto; lia.
  - rewrite sum_exact_below; auto with typeclass_instances. rewrite Rminus_diag_eq, Rabs_R0 by auto.
    apply Rmult_le_pos; [lra | apply Rabs_pos].
Qed.

Lemma holds_rounded v z k x (is_exact : bool) : v = fl z -> double k -> 0 <= k -> close z x (k * w) ->
  (is_exact = true -> v = z) -> (is_exact = false -> close v z w) ->
  holds v (if is_exact then k else count_sum k 1) x.
Proof.
  intros E D P C X N. generalize w_positive. intros W.
  assert (S := count_sum_sound q qmin q_24 qmin_q k 1 D double_1 P ltac:(lra)).
  destruct is_exact.
  - split; [rewrite E; apply number_fl |]. rewrite (X eq_refl). auto.
  - split; [rewrite E; apply number_fl |].
    split; [apply count_sum_number; auto; lia |]. split; [lra |].
    apply close_weaken with (w + k * w); [now apply close_trans with z; [apply N |] |].
    replace (w + k * w) with ((k + 1) * w) by ring. apply Rmult_le_compat_r; lra.
Qed.

Theorem relative_exact_sound v : number v -> holds v 0 v.
Proof.
  intros N. split; auto. split; [apply double_0 |]. split; [lra |]. rewrite Rmult_0_l. apply close_exact.
Qed.
Theorem relative_negate_sound v k x : holds v k x -> holds (- v) k (- x).
Proof.
  intros (N & D & P & C). split; [now apply number_opp |]. auto using close_opp.
Qed.

Lemma factors_of_sound error size k : 0 <= error -> factors_of error size = Some k ->
  0 < size /\ double k /\ 0 <= k /\
  forall v x, size <= Rabs v -> Rabs (v - x) <= error -> close v x (k * w).
Proof.
  intros E. unfold factors_of. case Rlt_bool_spec; intros S; [| discriminate].
  assert (E0 : 0 <= error / size).
  { unfold Rdiv. apply Rmult_le_pos; auto. left. now apply Rinv_0_lt_compat. }
  assert (A := upper_eta_covers p emin ltac:(lia) ltac:(lia) (error / size) E0).
  set (share := fl (upper (fl (error / size)) + eta)) in *.
  case Rlt_bool_spec; intros S1; [| discriminate].
  assert (B := upper_eta_covers q qmin ltac:(lia) ltac:(lia) share ltac:(lra)).
  assert (D : double (dl (upper_count (dl share) + deta))) by (apply rnd_number; auto with typeclass_instances).
  set (r := dl (upper_count (dl share) + deta)) in *.
  case Rlt_bool_spec; intros R1; [| discriminate]. intros K. injection K. intros <-.
  split; auto. split; [apply count_of_share_number; auto |].
  split; [apply count_of_share_nonnegative; auto; lra |].
  intros v x V H.
  apply close_weaken with (- ln (1 - r)).
  - apply (close_within v x error); auto; try lra.
    apply Rle_trans with (error / size * Rabs v).
    + apply Rle_trans with (error / size * size); [right; field; lra |]. now apply Rmult_le_compat_l.
    + apply Rmult_le_compat_r; [apply Rabs_pos | lra].
  - apply count_of_share_sound; auto; lra.
Qed.

Theorem relative_within_sound v error x k : number v -> 0 <= error -> Rabs (v - x) <= error ->
  relative_within v error = Some k -> holds v k x.
Proof.
  intros N E H. unfold relative_within. case Req_bool_spec; intros Z K.
  - injection K. intros <-. assert (x = v) as ->; [| now apply relative_exact_sound].
    rewrite Z in H. apply Rabs_le_inv in H. lra.
  - destruct (factors_of_sound _ _ _ E K) as (_ & D & P & C). split; auto. split; auto. split; auto.
    apply C; auto. lra.
Qed.

Theorem relative_error_sound v k x e : holds v k x -> relative_error v k = Some e ->
  number e /\ 0 <= e /\ Rabs (v - x) <= e.
Proof.
  intros (N & D & P & C). unfold relative_error. case Req_bool_spec; intros Z.
  - intros E. injection E. intros <-. split; [apply number_0 |]. split; [lra |].
    rewrite Z, Rmult_0_l in C.
    apply Rle_trans with (1 := close_error v x 0 ltac:(lra) C). rewrite exp_0. lra.
  - destruct (error_of_count q qmin p k) as [r |] eqn:R; [| discriminate].
    destruct (error_of_count_sound q qmin q_24 qmin_q p p_q k r D P R) as [R0 R1].
    set (share := if Rlt_bool (fl r) r then fl (upper (fl r) + eta) else fl r).
    assert (S : r <= share).
    { unfold share. case Rlt_bool_spec; auto. intros _. apply upper_eta_covers; auto; lia. }
    cbv zeta. fold share. intros E. injection E. intros <-. clear E.
    generalize (Rabs_pos v) w_positive. intros V W.
    assert (A := upper_eta_covers p emin ltac:(lia) ltac:(lia) (Rabs v * share)
      ltac:(apply Rmult_le_pos; lra)).
    split; [apply number_fl |]. assert (0 <= Rabs v * share) by (apply Rmult_le_pos; lra).
    split; [lra |]. apply Rle_trans with (2 := A).
    apply Rle_trans with (1 := close_error v x (k * w) ltac:(apply Rmult_le_pos; lra) C).
    apply Rmult_le_compat_l; auto. unfold w in *. lra.
Qed.
Theorem relative_sign_sound v k x : holds v k x ->
  match relative_sign v k with
  | Code.negative => x < 0
  | Code.zero => x = 0
  | Code.positive => 0 < x
  | Code.uncertain => True
  end.
Proof.
  intros (N & D & P & C). unfold relative_sign. destruct (relative_error v k); auto.
  case Req_bool_spec; intros Z; [now apply (close_0 v x (k * w)) |].
  assert (X : x <> 0) by (intros X; apply Z; now apply (close_0 v x (k * w))).
  destruct C as (S & _). case Rlt_bool_spec; intros V.
  - destruct (Rle_or_lt x 0) as [H | H]; auto. assert (0 < v * - x) by (apply Rmult_lt_0_compat; lra). lra.
  - destruct (Rle_or_lt 0 x) as [H | H]; auto. assert (0 < - v * x) by (apply Rmult_lt_0_compat; lra). lra.
Qed.

Theorem relative_add_sound a ka x b kb y (is_exact : bool) k : holds a ka x -> holds b kb y ->
  (is_exact = true -> fl (a + b) = a + b) ->
  relative_add a ka b kb is_exact = Some k -> holds (fl (a + b)) k (x + y).
Proof.
  intros HA HB X. assert (HA' := HA). assert (HB' := HB).
  destruct HA' as (NA & DA & PA & CA), HB' as (NB & DB & PB & CB). unfold relative_add.
  assert (W := w_positive). assert (CR := close_rounded_sum a b NA NB).
  set (m := if Rlt_bool ka kb then kb else ka).
  assert (M : ka <= m /\ kb <= m /\ double m).
  { unfold m. case Rlt_bool_spec; intros H; repeat split; auto; lra. }
  destruct M as (MA & MB & MD).
  assert (CA' := close_weaken _ _ _ (m * w) CA ltac:(apply Rmult_le_compat_r; lra)).
  assert (CB' := close_weaken _ _ _ (m * w) CB ltac:(apply Rmult_le_compat_r; lra)).
  case_eq (Req_bool m 0 || Rle_bool 0 a && Rle_bool 0 b || Rle_bool a 0 && Rle_bool b 0).
  - intros S E. injection E. intros <-. clear E. unfold rounded_sum.
    apply holds_rounded with (z := a + b); auto; [lra |].
    apply orb_prop in S. destruct S as [S | S]; [apply orb_prop in S; destruct S as [S | S] |].
    + revert S. case Req_bool_spec; [| discriminate]. intros E _. rewrite E, Rmult_0_l in *.
      assert (ka = 0) as EA by lra. assert (kb = 0) as EB by lra.
      assert (F : forall v t, close v t 0 -> t = v).
      { intros v t H. generalize (close_error v t 0 ltac:(lra) H). rewrite exp_0. intros B.
        replace (Rabs v * (1 - 1)) with 0 in B by ring. apply Rabs_le_inv in B. lra. }
      rewrite (F a x CA'), (F b y CB'). apply close_exact.
    + apply close_add; auto. left. apply andb_prop in S. destruct S as [S1 S2]. revert S1 S2.
      now do 2 (case Rle_bool_spec; [| discriminate]).
    + apply close_add; auto. right. apply andb_prop in S. destruct S as [S1 S2]. revert S1 S2.
      now do 2 (case Rle_bool_spec; [| discriminate]).
  - intros _. destruct (relative_error a ka) as [ea |] eqn:EA; [| discriminate].
    destruct (relative_error b kb) as [eb |] eqn:EB; [| discriminate].
    destruct (relative_error_sound _ _ _ _ HA EA) as (NEA & PEA & BA).
    destruct (relative_error_sound _ _ _ _ HB EB) as (NEB & PEB & BB).
    assert (OFF := upper_covers_sum p emin ltac:(lia) ltac:(lia) ea eb NEA NEB ltac:(lra)).
    set (off := upper (fl (ea + eb))) in *.
    set (least := if is_exact then Rabs (fl (a + b)) else fl (Rabs (fl (a + b)) * fl (1 - eps))).
    case Rlt_bool_spec; intros L; [| discriminate].
    destruct (factors_of off least) as [n |] eqn:F; [| discriminate]. intros E. injection E. intros <-. clear E.
    destruct (factors_of_sound off least n ltac:(lra) F) as (_ & DN & PN & C).
    unfold rounded_sum. apply holds_rounded with (z := a + b); auto.
    apply C.
    + unfold least. case_eq is_exact; intros IE; [rewrite (X IE); lra |].
      destruct (Req_dec (fl (a + b)) (a + b)) as [S | S]; [| apply lower_sum_sound; auto; lia].
      rewrite S. apply rnd_below; auto with typeclass_instances; [rewrite <- S; apply number_abs, number_fl |].
      rewrite <- (Rmult_1_r (Rabs (a + b))) at 2. apply Rmult_le_compat_l; [apply Rabs_pos |].
      apply rnd_below; auto with typeclass_instances; [| generalize (eps_positive p); lra].
      change 1 with (bpow radix2 0). apply number_power; auto. lia.
    + replace (a + b - (x + y)) with ((a - x) + (b - y)) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.

Theorem relative_subtract_sound a ka x b kb y (is_exact : bool) k : holds a ka x -> holds b kb y ->
  (is_exact = true -> fl (a - b) = a - b) ->
  relative_subtract a ka b kb is_exact = Some k -> holds (fl (a - b)) k (x - y).
Proof.
  intros HA HB. unfold relative_subtract, Rminus. apply relative_add_sound; auto.
  now apply relative_negate_sound.
Qed.

Lemma rounded_to_sound v z k x (is_exact : bool) n : v = fl z -> double k -> 0 <= k -> close z x (k * w) ->
  (is_exact = true -> v = z) -> rounded_to v k is_exact = Some n -> holds v n x.
Proof.
  intros E D P C X. unfold rounded_to. intros H.
  assert (n = (if is_exact then k else count_sum k 1)) as ->.
  { destruct is_exact; [now injection H |]. revert H. case Rle_bool_spec; [| discriminate].
    intros _ H. now injection H. }
  apply holds_rounded with z; auto. intros F. subst is_exact. revert H.
  case Rle_bool_spec; [| discriminate]. intros S _. rewrite E in S |- *. now apply close_rounded_normal.
Qed.
Lemma is_zero_tells a ka x : holds a ka x -> is_zero a ka = true -> a = 0 /\ x = 0.
Proof.
  intros (_ & _ & _ & C) H. apply andb_prop in H. destruct H as [H _]. revert H.
  case Req_bool_spec; [| discriminate]. intros -> _. split; auto. now apply (close_0 0 x (ka * w)).
Qed.
Lemma holds_0 : holds 0 0 0.
Proof. apply relative_exact_sound, number_0. Qed.
Lemma counts_of_two j k : double j -> double k -> 0 <= j -> 0 <= k ->
  double (count_sum j k) /\ 0 <= count_sum j k /\ j * w + k * w <= count_sum j k * w.
Proof.
  intros J K PJ PK. generalize w_positive (count_sum_sound q qmin q_24 qmin_q j k J K PJ PK). intros W S.
  split; [apply count_sum_number; auto; lia |]. split; [lra |].
  rewrite <- Rmult_plus_distr_r. apply Rmult_le_compat_r; lra.
Qed.

Theorem relative_multiply_sound a ka x b kb y (is_exact : bool) k : holds a ka x -> holds b kb y ->
  (is_exact = true -> fl (a * b) = a * b) ->
  relative_multiply (fl (a * b)) a ka b kb is_exact = Some k -> holds (fl (a * b)) k (x * y).
Proof.
  intros HA HB X. assert (HA' := HA). assert (HB' := HB).
  destruct HA' as (_ & DA & PA & CA), HB' as (_ & DB & PB & CB). unfold relative_multiply.
  case_eq (is_zero a ka || is_zero b kb).
  - intros Z K. injection K. intros <-. apply orb_prop in Z. destruct Z as [Z | Z].
    + destruct (is_zero_tells _ _ _ HA Z) as [-> ->]. rewrite !Rmult_0_l, rnd_0 by auto with typeclass_instances.
      apply holds_0.
    + destruct (is_zero_tells _ _ _ HB Z) as [-> ->]. rewrite !Rmult_0_r, rnd_0 by auto with typeclass_instances.
      apply holds_0.
  - intros _. destruct (counts_of_two ka kb DA DB PA PB) as (D & P & L).
    apply rounded_to_sound with (z := a * b); auto.
    apply close_weaken with (2 := L). now apply close_multiply.
Qed.
Theorem relative_divide_sound a ka x b kb y (is_exact : bool) k : holds a ka x -> holds b kb y ->
  (is_exact = true -> fl (a / b) = a / b) ->
  relative_divide (fl (a / b)) a ka b kb is_exact = Some k -> y <> 0 /\ holds (fl (a / b)) k (x / y).
Proof.
  intros HA HB X. assert (HA' := HA). assert (HB' := HB).
  destruct HA' as (_ & DA & PA & CA), HB' as (_ & DB & PB & CB). unfold relative_divide.
  case Req_bool_spec; intros B; [discriminate |]. intros K.
  split; [intros Y; apply B; now apply (close_0 b y (kb * w)) |]. revert K.
  case_eq (is_zero a ka).
  - intros Z K. injection K. intros <-. destruct (is_zero_tells _ _ _ HA Z) as [-> ->].
    unfold Rdiv. rewrite !Rmult_0_l, rnd_0 by auto with typeclass_instances. apply holds_0.
  - intros _. destruct (counts_of_two ka kb DA DB PA PB) as (D & P & L).
    apply rounded_to_sound with (z := a / b); auto.
    apply close_weaken with (2 := L). apply close_multiply; auto. now apply close_inverse.
Qed.
Theorem relative_scale_sound a ka x e k : holds a ka x ->
  relative_scale (fl (a * bpow radix2 e)) a ka e = Some k ->
  holds (fl (a * bpow radix2 e)) k (x * bpow radix2 e).
Proof.
  intros (N & D & P & C). unfold relative_scale.
  apply rounded_to_sound with (z := a * bpow radix2 e); auto; [now apply close_factor |].
  intros H. destruct (Z_le_gt_dec 0 e) as [E | E]; [apply scale_up; auto with typeclass_instances |].
  apply orb_prop in H. destruct H as [H | H]; [apply Zle_bool_imp_le in H; lia |].
  revert H. case Req_bool_spec; [| discriminate]. intros H _.
  assert (B := scale_back p emin nearest (fl (a * bpow radix2 e)) a e (number_fl _) ltac:(lia) H).
  exact B.
Qed.

End Rule.
