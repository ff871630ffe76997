(** Bound rule `interval` (include/errbound/rules/interval.hpp): its step outwards, rounded to nearest, from 3 bits
    on. IeeeInterval.v has the rule.

    Results: below_true, above_true   a step from the rounded t, or from beyond it, reaches t or passes it *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format.
Open Scope R_scope.

Section Outward.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (p_3 : (3 <= p)%Z).
Notation format := (FLT_exp emin p).
Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation u := (u p).
Notation eta := (eta emin).

(** The code. *)
Definition step (c : R) : R := fl (fl (fl (Rabs c * u) * (5 / 4)) + eta).
Definition below (c : R) : R := fl (c - step c).
Definition above (c : R) : R := fl (c + step c).

Let rnd_above := Format.rnd_above p emin nearest.

Lemma fl_opp x : fl (- x) = - fl x.
Proof. apply round_NE_opp. Qed.
Lemma step_opp c : step (- c) = step c.
Proof. unfold step. now rewrite Rabs_Ropp. Qed.
Lemma above_below c : above c = - below (- c).
Proof. unfold above, below. rewrite step_opp, <- fl_opp. f_equal. ring. Qed.

(** Half an ulp is less than the step. *)
Lemma step_large c : number c -> ulp radix2 format c < 2 * step c.
Proof.
  intros N. generalize (eta_positive emin) (u_positive p) (Rabs_pos c). intros Pe Pu Pc.
  set (w := fl (Rabs c * u)). set (x := fl (w * (5 / 4))).
  assert (Pw : 0 <= w) by (apply rnd_above; [apply number_0 | apply Rmult_le_pos; lra]).
  assert (Px : 0 <= x) by (apply rnd_above; [apply number_0 | lra]).
  assert (E : eta <= step c) by (apply rnd_above; [now apply number_eta | fold w x; lra]).
  destruct (Rlt_or_le (Rabs c) (bpow radix2 (emin + p))) as [S | S].
  { rewrite ulp_FLT_small by auto. change (bpow radix2 emin) with eta. lra. }
  (* half an ulp is 2^k, at most u|c| *)
  assert (NZ : c <> 0).
  { intros ->. rewrite Rabs_R0 in S. generalize (bpow_gt_0 radix2 (emin + p)). lra. }
  assert (M : (emin + p < mag radix2 c)%Z) by (apply mag_gt_bpow; auto).
  set (k := (mag radix2 c - p - 1)%Z).
  assert (Hulp : ulp radix2 format c = 2 * bpow radix2 k).
  { rewrite ulp_neq_0; auto. unfold cexp, FLT_exp. rewrite Z.max_l by lia.
    change 2 with (bpow radix2 1). rewrite <- bpow_plus. f_equal. unfold k. lia. }
  assert (L : bpow radix2 k <= Rabs c * u).
  { replace k with (mag radix2 c - 1 + - p)%Z by (unfold k; lia). rewrite bpow_plus.
    apply Rmult_le_compat_r; [apply bpow_ge_0 | now apply bpow_mag_le]. }
  rewrite Hulp. assert (Pk : 0 < bpow radix2 k) by apply bpow_gt_0.
  destruct (Z_lt_le_dec k (emin + 2)) as [K | K].
  - (* the sum with eta is exact *)
    assert (Nk : number (bpow radix2 k)) by (apply number_power; auto; unfold k; lia).
    assert (W : bpow radix2 k <= w) by (apply rnd_above; auto).
    assert (X : bpow radix2 k <= x) by (apply rnd_above; auto; lra).
    apply Rmult_lt_compat_l; [lra |]. apply Rlt_le_trans with (bpow radix2 k + eta); [lra |].
    apply rnd_above; [| fold w x; lra].
    replace (bpow radix2 k + eta) with (IZR (2 ^ (k - emin) + 1) * bpow radix2 emin).
    + apply number_integer; auto; try lia.
      assert (1 <= 2 ^ (k - emin) <= 2 ^ 1)%Z.
      { split; [apply (Z.pow_le_mono_r 2 0) | apply Z.pow_le_mono_r]; unfold k in *; lia. }
      assert (2 ^ 3 <= 2 ^ p)%Z by (apply Z.pow_le_mono_r; lia).
      change (2 ^ 1)%Z with 2%Z in *. change (2 ^ 3)%Z with 8%Z in *. rewrite Z.abs_eq; lia.
    + rewrite plus_IZR, Rmult_plus_distr_r. change 2%Z with (radix_val radix2).
      rewrite IZR_Zpower by (unfold k in *; lia). rewrite <- bpow_plus.
      replace (k - emin + emin)%Z with k by lia. unfold Format.eta. lra.
  - (* a quarter of it is a number *)
    assert (Nk : number (bpow radix2 k)) by (apply number_power; auto; lia).
    assert (W : bpow radix2 k <= w) by (apply rnd_above; auto).
    assert (N5 : number (5 / 4 * bpow radix2 k)).
    { replace (5 / 4 * bpow radix2 k) with (IZR 5 * bpow radix2 (k - 2)).
      - apply number_integer; auto; try lia.
        assert (2 ^ 3 <= 2 ^ p)%Z by (apply Z.pow_le_mono_r; lia).
        change (2 ^ 3)%Z with 8%Z in *. simpl. lia.
      - replace (k - 2)%Z with (k + -2)%Z by lia. rewrite bpow_plus.
        change (bpow radix2 (-2)) with (/ 4). lra. }
    assert (X : 5 / 4 * bpow radix2 k <= x) by (apply rnd_above; auto; lra).
    assert (Y : 5 / 4 * bpow radix2 k <= step c) by (apply rnd_above; auto; fold w x; lra).
    lra.
Qed.

(** A step reaches the neighbour or passes it. *)
Lemma below_pred c : number c -> below c <= pred radix2 format c.
Proof.
  intros N. unfold below. apply round_N_le_midp; auto with typeclass_instances.
  - apply generic_format_pred; auto with typeclass_instances.
  - rewrite succ_pred; auto with typeclass_instances.
    generalize (step_large c N).
    assert (c - ulp radix2 format c <= pred radix2 format c).
    { unfold pred.
      generalize (succ_le_plus_ulp radix2 format (- c)). rewrite ulp_opp. lra. }
    lra.
Qed.
Lemma below_true m t : number m -> m <= fl t -> below m <= t.
Proof.
  intros N H. apply Rle_trans with (1 := below_pred m N).
  apply Rle_trans with (pred radix2 format (fl t)).
  - apply pred_le; auto with typeclass_instances. apply rnd_number; auto with typeclass_instances.
  - apply pred_round_le_id; auto with typeclass_instances.
Qed.
Lemma above_true m t : number m -> fl t <= m -> t <= above m.
Proof.
  intros N H. rewrite above_below. enough (below (- m) <= - t) by lra.
  apply below_true; [now apply number_opp | rewrite fl_opp; lra].
Qed.

End Outward.
