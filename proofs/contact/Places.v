(** Estimated positions of roots (ccd/exact/cubic_roots.hpp): for any estimate, numerators fit their words. double,
    to nearest. Results:
        estimated_root_inside     estimated_root lies in [0, 1]
        estimated_place_bits      estimated_place: 0 <= numerator <= 2^bits
        refined_place_bits        the same for refined_place, whose bits fit one more word *)

From Coq Require Import Reals ZArith Lia Lra.
From Flocq Require Import Core.
From Errbound Require Import Format Widths.
Open Scope R_scope.

#[local] Instance double_precision : Prec_gt_0 53 := eq_refl.

(** The next t: Newton's if it is inside, else the middle. *)
Inductive next (low high : R) : R -> Prop :=
| by_newton x : double x -> low < x < high -> next low high x
| by_halving : next low high (fl (fl (low + high) / 2)).
(** Possible values of low, high and t after any number of steps; each ends at t or continues from there. *)
Inductive reached (start : R) : R -> R -> R -> Prop :=
| first : reached start 0 1 start
| later low high t t' : reached start low high t -> next t high t' -> reached start t high t'
| earlier low high t t' : reached start low high t -> next low t t' -> reached start low t t'.
(** The first t, if the end values have opposite signs, or one is zero. *)
Definition first_t (h0 h3 : R) : R := if Req_bool h0 0 then / 2 else if Req_bool h3 0 then / 2 else fl (h0 / fl (h0 - h3)).

Lemma double_whole z : (Z.abs z <= 2 ^ 53)%Z -> double (IZR z).
Proof.
  intros H. rewrite <- (Rmult_1_r (IZR z)). change 1 with (bpow radix2 0). apply number_integer; [exact eq_refl | lia | exact H].
Qed.
Lemma double_twice x : double x -> double (2 * x).
Proof.
  intros H. rewrite Rmult_comm. change 2 with (bpow radix2 1). rewrite <- (scale_up 53 (-1074) nearest x 1 H ltac:(lia)).
  apply rnd_number; auto with typeclass_instances.
Qed.
Lemma next_between low high t : double low -> double high -> low <= high -> next low high t ->
  low <= t <= high /\ double t.
Proof.
  intros L H O [x X I |]; [split; [split; apply Rlt_le; apply I | exact X] |]. split; [| apply rnd_number; auto with typeclass_instances].
  split.
  - apply (rnd_above 53 (-1074) nearest); auto.
    assert (2 * low <= fl (low + high)) by (apply (rnd_above 53 (-1074) nearest); [now apply double_twice | lra]). lra.
  - apply (rnd_below 53 (-1074) nearest); auto.
    assert (fl (low + high) <= 2 * high) by (apply (rnd_below 53 (-1074) nearest); [now apply double_twice | lra]). lra.
Qed.
Lemma first_t_inside h0 h3 : double h0 -> double h3 -> h0 * h3 <= 0 -> 0 <= first_t h0 h3 <= 1 /\ double (first_t h0 h3).
Proof.
  intros N0 N3 S. assert (Half : double (/ 2)) by (change (/ 2) with (bpow radix2 (-1)); apply number_power; [exact eq_refl | lia]).
  unfold first_t. case Req_bool_spec; intros Z0; [split; [lra | exact Half] |].
  case Req_bool_spec; intros Z3; [split; [lra | exact Half] |].
  split; [| apply rnd_number; auto with typeclass_instances].
  assert (N1 : double 1) by (apply (double_whole 1); lia).
  assert (Q : 0 <= h0 / fl (h0 - h3) <= 1).
  { destruct (Rlt_or_le 0 h0) as [P | P].
    - assert (h3 < 0) by (apply Rnot_le_lt; intros C; assert (0 < h0 * h3) by (apply Rmult_lt_0_compat; lra); lra). assert (D : h0 <= fl (h0 - h3)) by (apply (rnd_above 53 (-1074) nearest); [exact N0 | lra]).
      split; [apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra] |].
      apply Rmult_le_reg_r with (fl (h0 - h3)); [lra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra.
    - assert (0 < h3) by (apply Rnot_le_lt; intros C; assert (0 < h0 * h3) by (rewrite <- Rmult_opp_opp; apply Rmult_lt_0_compat; lra); lra). assert (D : fl (h0 - h3) <= h0) by (apply (rnd_below 53 (-1074) nearest); [exact N0 | lra]).
      replace (h0 / fl (h0 - h3)) with (- h0 / - fl (h0 - h3)) by (field; lra).
      split; [apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra] |].
      apply Rmult_le_reg_r with (- fl (h0 - h3)); [lra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. }
  split; [now apply (rnd_nonnegative 53 (-1074) nearest) | now apply (rnd_below 53 (-1074) nearest)].
Qed.
Theorem estimated_root_inside h0 h3 low high t : double h0 -> double h3 -> h0 * h3 <= 0 ->
  reached (first_t h0 h3) low high t -> 0 <= t <= 1.
Proof.
  intros N0 N3 S H. destruct (first_t_inside h0 h3 N0 N3 S) as [F NF].
  enough (0 <= low <= t /\ t <= high <= 1 /\ double low /\ double high /\ double t) by lra.
  induction H as [| low high t t' _ (L & H & NL & NH & Nt) N | low high t t' _ (L & H & NL & NH & Nt) N].
  - split; [lra |]. split; [lra |]. split; [apply number_0 |]. split; [apply (double_whole 1); lia | exact NF].
  - destruct (next_between t high t' Nt NH ltac:(lra) N) as [B Nt']. repeat split; auto; lra.
  - destruct (next_between low t t' NL Nt ltac:(lra) N) as [B Nt']. repeat split; auto; lra.
Qed.

(** The whole part stays within whole bounds. *)
Lemma truncated x (m : Z) : 0 <= x <= IZR m -> (0 <= Ztrunc x <= m)%Z.
Proof.
  intros H. rewrite Ztrunc_floor by lra. split.
  - apply Zfloor_lub. apply H.
  - apply le_IZR. apply Rle_trans with x; [apply Zfloor_lb | apply H].
Qed.
(** The interval [index, index + 1]/2^level of [0, 1]; t 2^to_bits is exact, or so small that it is rounded to 0. *)
Theorem estimated_place_bits index level to_bits t : (0 <= index)%Z -> (index + 1 <= 2 ^ level)%Z -> (0 <= level)%Z ->
  (0 <= to_bits)%Z -> 0 <= t <= 1 ->
  (0 <= index * 2 ^ to_bits + Ztrunc (fl (t * bpow radix2 to_bits)) <= 2 ^ (level + to_bits))%Z.
Proof.
  intros I J L K T. assert (P : (0 < 2 ^ to_bits)%Z) by (apply Z.pow_pos_nonneg; lia).
  assert (H : (0 <= Ztrunc (fl (t * bpow radix2 to_bits)) <= 2 ^ to_bits)%Z).
  { apply truncated. assert (B := bpow_gt_0 radix2 to_bits). split; [apply (rnd_nonnegative 53 (-1074) nearest); nra |].
    change 2%Z with (radix_val radix2). rewrite IZR_Zpower by auto.
    apply (rnd_below 53 (-1074) nearest); [apply number_power; [exact eq_refl | lia] | nra]. }
  rewrite Z.pow_add_r by lia. nia.
Qed.
(** low + width, the bracket's higher end, is at most 2^bits; width_bits is that of the bracket. *)
Theorem refined_place_bits low width width_bits bits T t : (0 <= low)%Z -> (0 < width < 2 ^ width_bits)%Z ->
  (width_bits <= 26)%Z -> (low + width <= 2 ^ bits)%Z -> (0 <= bits <= 64 * T - 2)%Z -> 0 <= t <= 1 ->
  let more := (46 - width_bits)%Z in
  (0 <= low * 2 ^ more + Ztrunc (fl (fl (IZR width * t) * bpow radix2 more)) <= 2 ^ (bits + more))%Z /\
  (bits + more <= 64 * (T + 1) - 2)%Z.
Proof.
  intros L W WB H HB I more. assert (Pw : (1 <= width_bits)%Z).
  { destruct (Z_le_gt_dec 1 width_bits) as [| C]; auto. exfalso.
    destruct (Z.eq_dec width_bits 0) as [-> |]; [simpl in W; lia |]. rewrite Z.pow_neg_r in W; lia. }
  split; [| unfold more; lia]. assert (P : (0 < 2 ^ more)%Z) by (apply Z.pow_pos_nonneg; unfold more; lia).
  assert (Small : (width < 2 ^ 26)%Z) by (apply Z.lt_le_trans with (1 := proj2 W), Z.pow_le_mono_r; lia).
  assert (PW : 0 < IZR width) by (apply IZR_lt; lia).
  assert (R : 0 <= fl (IZR width * t) <= IZR width).
  { split; [apply (rnd_nonnegative 53 (-1074) nearest); nra |].
    apply (rnd_below 53 (-1074) nearest); [apply double_whole; lia | nra]. }
  assert (H2 : (0 <= Ztrunc (fl (fl (IZR width * t) * bpow radix2 more)) <= width * 2 ^ more)%Z).
  { apply truncated. assert (B := bpow_gt_0 radix2 more). split; [apply (rnd_nonnegative 53 (-1074) nearest); nra |].
    rewrite mult_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by (unfold more; lia).
    apply (rnd_below 53 (-1074) nearest); [| nra]. apply number_integer; [exact eq_refl | unfold more; lia | lia]. }
  rewrite Z.pow_add_r by (unfold more; lia). nia.
Qed.
