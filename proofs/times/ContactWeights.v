(** Weights of contact data (set_weights of ccd/contact/data/contact_data.cpp), in double, to nearest. The weights of
    a feature's points except the first are clamped to the rest of 1, and the first gets what remains.

    Result: weights_right   each is in [0, 1] and differs by at most `weight_error` *)

From Coq Require Import Reals ZArith Lia Lra List.
From Flocq Require Import Core.
From Errbound Require Import Format.
Import ListNotations.
Open Scope R_scope.

#[local] Instance double_precision : Prec_gt_0 53 := eq_refl.
Notation fl := (rnd 53 (-1074) nearest).
Notation double := (number 53 (-1074)).
Notation u := (u 53).
Notation eps := (eps 53).

(** clamped *)
Definition clamped (weight most : R) : R := if Rlt_dec 0 weight then Rmin weight most else 0.
(** The loop over the rounded weights except the first, starting with the last: the resulting weights, the rest, and
    the sum of errors. *)
Fixpoint cut (told : list (R * R)) (remains error : R) : list R * R * R :=
  match told with
  | [] => ([], remains, error)
  | (value, off) :: rest =>
      let weight := clamped value remains in
      let '(weights, first, total) := cut rest (fl (remains - weight)) (fl (error + off)) in
      (weight :: weights, first, total)
  end.
(** The error if there is more than one point. *)
Definition weight_error (error : R) : R := fl (fl (error + eps / 2) * (1 + 4 * eps)).

Lemma double_1 : double 1.
Proof. change 1 with (bpow radix2 0). apply number_power; [easy | lia]. Qed.
(** A number up to 1 is rounded by at most half of 2^-53. *)
Lemma up_to_1 x : 0 <= x <= 1 -> Rabs (fl x - x) <= u / 2.
Proof.
  intros (X0 & X1). pose proof (rounding_error_nearest 53 (-1074) ltac:(lia)) as E. pose proof (u_positive 53) as U.
  assert (H : Rabs (fl x - x) <= / 2 * ulp radix2 (FLT_exp (-1074) 53) x)
    by (apply error_le_half_ulp; auto with typeclass_instances).
  destruct (Req_dec x 1) as [-> | N].
  { rewrite (rnd_exact 53 (-1074) nearest 1 double_1), Rminus_diag_eq, Rabs_R0 by easy. lra. }
  apply Rle_trans with (1 := H). enough (ulp radix2 (FLT_exp (-1074) 53) x <= u) by lra.
  apply Rle_trans with (ulp radix2 (FLT_exp (-1074) 53) (bpow radix2 (-1))).
  - destruct (Rle_or_lt x (bpow radix2 (-1))) as [L | L].
    + apply ulp_le; auto with typeclass_instances. rewrite !Rabs_pos_eq by (auto; apply bpow_ge_0). exact L.
    + right. rewrite !ulp_neq_0 by (pose proof (bpow_gt_0 radix2 (-1)); lra). unfold cexp. do 2 f_equal.
      rewrite mag_bpow. apply mag_unique. rewrite Rabs_pos_eq by lra. split; [simpl in *; lra | simpl; lra].
  - rewrite ulp_bpow. unfold Format.u. apply bpow_le. unfold FLT_exp. lia.
Qed.

Definition sum (l : list R) : R := fold_right Rplus 0 l.
Definition told_right (told : R * R) (w : R) : Prop := double (fst told) /\ 0 <= w /\ Rabs (fst told - w) <= snd told.
Lemma sum_nonnegative told weights : Forall2 told_right told weights -> 0 <= sum weights.
Proof. induction 1 as [| t w told weights (_ & W & _) F IH]; cbn [sum fold_right] in *; [lra | unfold sum in *; lra]. Qed.

(** rest: the sum of the first weight and the weights that follow in the loop. *)
Lemma cut_right told weights : Forall2 told_right told weights -> forall remains rest off error,
  double remains -> 0 <= remains <= 1 -> Rabs (remains - rest) <= off -> 0 <= rest - sum weights ->
  let total := off + sum (map snd told) + INR (length told) * (u / 2) in
  let '(found, first, _) := cut told remains error in
  Forall2 (fun f w => 0 <= f <= 1 /\ Rabs (f - w) <= total) found weights /\
  0 <= first <= 1 /\ Rabs (first - (rest - sum weights)) <= total.
Proof.
  pose proof (u_positive 53) as U.
  induction 1 as [| (value, o) w told weights (D & W & V) F IH]; intros remains rest off error N L E R.
  { cbn [cut map length sum fold_right INR] in *. rewrite Rminus_0_r in *. split; [constructor |]. split; auto. lra. }
  cbn [cut fst snd map sum fold_right] in *. change (fold_right Rplus 0 weights) with (sum weights) in *.
  change (fold_right Rplus 0 (map snd told)) with (sum (map snd told)).
  pose proof (sum_nonnegative told weights F) as S0. pose proof (Rabs_pos (value - w)) as O0.
  assert (T0 : 0 <= sum (map snd told) + INR (length told) * (u / 2)).
  { pose proof (pos_INR (length told)). assert (0 <= INR (length told) * (u / 2)) by (apply Rmult_le_pos; lra).
    enough (0 <= sum (map snd told)) by lra. clear - F.
    induction F as [| t x told weights (_ & _ & X) F IH]; cbn [sum map fold_right] in *; [lra |].
    pose proof (Rabs_pos (fst t - x)). unfold sum in IH. lra. }
  set (weight := clamped value remains).
  assert (H : double weight /\ 0 <= weight <= remains /\ Rabs (weight - w) <= off + o /\
    Rabs (remains - weight - (rest - w)) <= off + o).
  { apply Rabs_le_inv in E, V. unfold weight, clamped. destruct (Rlt_dec 0 value) as [P | P].
    - destruct (Rle_or_lt value remains) as [Q | Q].
      + rewrite Rmin_left by auto. repeat split; auto; try lra; apply Rabs_le; lra.
      + rewrite Rmin_right by lra. repeat split; auto; try lra; apply Rabs_le; lra.
    - repeat split; try lra; try (apply number_0; easy); apply Rabs_le; lra. }
  destruct H as (Dw & Wr & Ew & Er). clearbody weight.
  assert (In01 : 0 <= remains - weight <= 1) by lra. pose proof (up_to_1 _ In01) as Rd.
  specialize (IH (fl (remains - weight)) (rest - w) (off + o + u / 2) (fl (error + o))).
  destruct (cut told _ _) as [[found first] total]. destruct IH as (A & B & C).
  - apply rnd_number; auto with typeclass_instances.
  - split; [apply rnd_nonnegative; auto with typeclass_instances; lra |]. apply rnd_below; auto using double_1 with typeclass_instances. lra.
  - apply Rabs_le_inv in Rd, Er. apply Rabs_le. lra.
  - lra.
  - change (length ((value, o) :: told)) with (S (length told)). rewrite S_INR. cbv zeta in *.
    replace (off + (o + sum (map snd told)) + (INR (length told) + 1) * (u / 2))
      with (off + o + u / 2 + sum (map snd told) + INR (length told) * (u / 2)) by ring.
    replace (rest - (w + sum weights)) with (rest - w - sum weights) by ring.
    split; [constructor; auto; split; [lra |] | split; auto]. lra.
Qed.

(** Edges have one given weight, faces two. *)
Theorem weights_right told weights : Forall2 told_right told weights -> (1 <= length told <= 2)%nat ->
  Forall (fun t => double (snd t)) told -> sum weights <= 1 ->
  let '(found, first, error) := cut told 1 0 in
  Forall2 (fun f w => 0 <= f <= 1 /\ Rabs (f - w) <= weight_error error) found weights /\
  0 <= first <= 1 /\ Rabs (first - (1 - sum weights)) <= weight_error error.
Proof.
  intros F L N S1. pose proof (u_positive 53) as U. pose proof (eps_2u 53) as E2.
  pose proof (cut_right told weights F 1 1 0 0 double_1) as H. cbv zeta in H.
  assert (Offs : Forall (fun t => 0 <= snd t) told).
  { clear - F. induction F as [| t w told weights (_ & _ & X) F IH]; constructor; auto.
    pose proof (Rabs_pos (fst t - w)). lra. }
  assert (Enough : 0 + sum (map snd told) + INR (length told) * (u / 2) <= weight_error (snd (cut told 1 0))).
  { assert (U8 : u <= / 1024) by (unfold Format.u; apply Rle_trans with (bpow radix2 (-10)); [apply bpow_le; lia | simpl; lra]).
    assert (Neps : double (eps / 2)).
    { rewrite E2. replace (2 * u / 2) with (bpow radix2 (-53)) by (unfold Format.u; simpl (- (53))%Z; field).
      apply number_power; [easy | lia]. }
    assert (Sn : forall x y, double x -> double y -> 0 <= x -> 0 <= y -> (x + y) * (1 - u) <= fl (x + y)).
    { intros x y X Y X0 Y0. pose proof (sum_error 53 (-1074) nearest _ _ (rounding_error_nearest 53 (-1074) ltac:(lia)) x y X Y) as E.
      rewrite (Rabs_pos_eq (x + y)) in E by lra. apply Rabs_le_inv in E. lra. }
    (* the sum, then its double, whose product is far from underflow *)
    assert (Sum : sum (map snd told) * (1 - u) <= snd (cut told 1 0) /\ double (snd (cut told 1 0)) /\ 0 <= snd (cut told 1 0)).
    { destruct told as [| (v0, o0) [| (v1, o1) [|]]]; cbn [length] in L; try lia; cbn [cut snd map sum fold_right].
      - inversion_clear N as [| ? ? N0 _]. inversion_clear Offs as [| ? ? O0 _]. cbn [snd] in *.
        rewrite Rplus_0_l, (rnd_exact 53 (-1074) nearest o0 N0). repeat split; auto. nra.
      - inversion_clear N as [| ? ? N0 N']. inversion_clear N' as [| ? ? N1' _]. inversion_clear Offs as [| ? ? O0 O'].
        inversion_clear O' as [| ? ? O1 _]. cbn [snd] in *.
        rewrite Rplus_0_l, (rnd_exact 53 (-1074) nearest o0 N0). rewrite Rplus_0_r.
        split; [now apply Sn |].
        split; [apply rnd_number; auto with typeclass_instances | apply rnd_nonnegative; auto with typeclass_instances; lra]. }
    destruct Sum as (Sum & Ns & S0). set (error := snd (cut told 1 0)) in *. clearbody error.
    unfold weight_error. pose proof (Sn error (eps / 2) Ns Neps S0 ltac:(lra)) as T.
    set (t := fl (error + eps / 2)) in *. assert (Tu : u * (1 - u) <= t) by nra.
    assert (Big : u * / 2 <= t * (1 + 4 * eps)) by nra.
    assert (P : t * (1 + 4 * eps) * (1 - u) <= fl (t * (1 + 4 * eps))).
    { pose proof (error_relative 53 (-1074) nearest _ _ (rounding_error_nearest 53 (-1074) ltac:(lia)) (t * (1 + 4 * eps))) as E.
      rewrite (Rabs_pos_eq (t * (1 + 4 * eps))) in E by lra.
      assert (Sm : smallest_normal 53 (-1074) <= u * / 2).
      { unfold smallest_normal, Format.u. replace (bpow radix2 (- (53)) * / 2) with (bpow radix2 (-54))
          by (change (-54)%Z with (- (53) + (-1))%Z; rewrite bpow_plus; reflexivity). apply bpow_le. lia. }
      specialize (E ltac:(lra)). apply Rabs_le_inv in E. lra. }
    apply Rle_trans with (2 := P).
    assert (K : INR (length told) * (u / 2) <= u).
    { assert (INR (length told) <= 2) by (change 2 with (INR 2); apply le_INR; lia). nra. }
    assert (Z0 : 0 <= sum (map snd told)).
    { clear - Offs. induction Offs; cbn [map sum fold_right] in *; [lra | unfold sum in *; lra]. }
    set (s := sum (map snd told)) in *. rewrite E2 in *.
    assert (A : (s * (1 - u) + u) * (1 - u) <= t) by nra.
    assert (G : 1 <= (1 - u) * (1 - u) * (1 + 4 * (2 * u)) * (1 - u)) by nra.
    assert (t * (1 + 4 * (2 * u)) * (1 - u) >= (s * (1 - u) + u) * (1 - u) * (1 + 4 * (2 * u)) * (1 - u)).
    { apply Rle_ge, Rmult_le_compat_r; [lra |]. apply Rmult_le_compat_r; lra. }
    assert ((s + u) * 1 <= (s + u) * ((1 - u) * (1 - u) * (1 + 4 * (2 * u)) * (1 - u))) by (apply Rmult_le_compat_l; lra).
    assert ((s + u) * (1 - u) <= s * (1 - u) + u) by nra.
    assert ((s + u) * (1 - u) * ((1 - u) * (1 + 4 * (2 * u)) * (1 - u)) <=
      (s * (1 - u) + u) * ((1 - u) * (1 + 4 * (2 * u)) * (1 - u))) by (apply Rmult_le_compat_r; nra).
    lra. }
  destruct (cut told 1 0) as [[found first] error]. cbn [snd] in Enough.
  destruct H as (A & B & C); [lra | rewrite Rminus_diag_eq, Rabs_R0; lra | lra |].
  split; [| split; auto; lra]. clear - A Enough.
  induction A as [| f w found weights (F0 & F1) A IH]; constructor; [split; auto; lra | exact IH].
Qed.
