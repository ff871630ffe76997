(** Rows of Bernstein coefficients cut to a few words (include/errbound/fixed_row.hpp): integers, each
    within an error of the real number that it stands for. Their words are exact integers here (Words.v).

    Results:
        row_cut      a row's numbers are near the coefficients, in its unit, and fit
        row_halves   likewise after halving, with the error that the code adds
        row_stays    and do not grow, so that sums of two fit
        row_sign     a certain sign is right *)

From Coq Require Import Reals ZArith List Lia Lra.
From Flocq Require Import Core.
Import ListNotations.
Open Scope R_scope.

Notation two k := (bpow radix2 k).

Lemma floor_of v cut : (0 <= cut)%Z -> 0 <= IZR v * two (- cut) - IZR (v / 2 ^ cut) < 1.
Proof.
  intros P. assert (P2 : (0 < 2 ^ cut)%Z) by (apply Z.pow_pos_nonneg; lia).
  rewrite bpow_opp, <- IZR_Zpower by auto. change (radix_val radix2) with 2%Z.
  assert (Pr : 0 < IZR (2 ^ cut)) by now apply (IZR_lt 0).
  generalize (Z.div_mod v (2 ^ cut) ltac:(lia)) (Z.mod_pos_bound v (2 ^ cut) P2). intros E R.
  assert (Q : IZR v * / IZR (2 ^ cut) - IZR (v / 2 ^ cut) = IZR (v mod 2 ^ cut) / IZR (2 ^ cut)).
  { rewrite E at 1. rewrite plus_IZR, mult_IZR. field. lra. }
  rewrite Q. split.
  - apply Rmult_le_pos; [apply (IZR_le 0); lia | apply Rlt_le, Rinv_0_lt_compat; lra].
  - apply Rmult_lt_reg_r with (IZR (2 ^ cut)); auto. unfold Rdiv. rewrite Rmult_assoc, Rinv_l, Rmult_1_l, Rmult_1_r by lra.
    apply IZR_lt. lia.
Qed.

(** Each is within `error` of the number that it stands for. *)
Definition near (error : Z) (v : Z) (x : R) : Prop := Rabs (x - IZR v) <= IZR error.
(** fixed_row's cut, of a coefficient c in units of 2^excess, towards zero *)
Definition cut_to (excess c : Z) : Z :=
  let size := (if 0 <? excess then Z.abs c / 2 ^ excess else Z.abs c * 2 ^ (- excess))%Z in
  if (c <? 0)%Z then (- size)%Z else size.
Theorem row_cut excess bits width c : (Z.abs c < 2 ^ bits)%Z -> (0 <= bits)%Z -> (excess = bits - (width - 3))%Z -> (3 <= width)%Z ->
  near (if (0 <? excess)%Z then 1 else 0) (cut_to excess c) (IZR c * two (- excess)) /\
  (Z.abs (cut_to excess c) < 2 ^ (width - 3))%Z.
Proof.
  intros Hc Pb E Pw. unfold near, cut_to. set (a := Z.abs c).
  assert (A : IZR c = (if (c <? 0)%Z then -1 else 1) * IZR a).
  { unfold a. destruct (Z.ltb_spec c 0); [rewrite Z.abs_neq, opp_IZR by lia | rewrite Z.abs_eq by lia]; ring. }
  destruct (Z.ltb_spec 0 excess) as [L | L].
  - assert (P : (0 < 2 ^ excess)%Z) by (apply Z.pow_pos_nonneg; lia).
    assert (Q : (0 <= a / 2 ^ excess)%Z) by (apply Z.div_pos; unfold a; lia). split.
    + assert (R := floor_of a excess ltac:(lia)).
      rewrite A. destruct (c <? 0)%Z; rewrite ?opp_IZR; apply Rabs_le; lra.
    + assert (a / 2 ^ excess < 2 ^ (width - 3))%Z.
      { apply Z.div_lt_upper_bound; [lia |]. rewrite <- Z.pow_add_r by lia. replace (excess + (width - 3))%Z with bits by lia. exact Hc. }
      destruct (c <? 0)%Z; lia.
  - assert (P : (0 < 2 ^ (- excess))%Z) by (apply Z.pow_pos_nonneg; lia). split.
    + rewrite A. assert (Z0 : IZR (a * 2 ^ (- excess)) = IZR a * two (- excess)).
      { rewrite mult_IZR. change 2%Z with (radix_val radix2). now rewrite IZR_Zpower by lia. }
      destruct (c <? 0)%Z; rewrite ?opp_IZR, Z0; apply Rabs_le; lra.
    + assert (a * 2 ^ (- excess) < 2 ^ (width - 3))%Z.
      { replace (width - 3)%Z with (bits + - excess)%Z by lia. rewrite Z.pow_add_r by lia. apply Z.mul_lt_mono_pos_r; auto. }
      assert (0 <= a * 2 ^ (- excess))%Z by (unfold a; lia). destruct (c <? 0)%Z; lia.
Qed.
Theorem row_sign error v x : near error v x ->
  ((v < 0 /\ error < - v)%Z -> x < 0) /\ ((0 <= v /\ error < v)%Z -> 0 < x).
Proof.
  unfold near. intros H. apply Rabs_le_inv in H. split; intros [C1 C2]; apply IZR_lt in C2; rewrite ?opp_IZR in C2; lra.
Qed.

(** One step of de Casteljau: neighbours' means, rounded down. *)
Fixpoint means (row : list Z) : list Z :=
  match row with a :: (b :: _) as l => ((a + b) / 2)%Z :: means l | _ => [] end.
Fixpoint real_means (row : list R) : list R :=
  match row with a :: (b :: _) as l => (a + b) / 2 :: real_means l | _ => [] end.
Fixpoint after {A} (step : list A -> list A) (k : nat) (row : list A) : list A :=
  match k with O => row | S k => after step k (step row) end.
(** The halves: the first of each step's, and the last in reverse order. *)
Definition left_half {A} (step : list A -> list A) (d : A) (row : list A) : list A :=
  map (fun i => hd d (after step i row)) (seq 0 (length row)).
Definition right_half {A} (step : list A -> list A) (d : A) (row : list A) : list A :=
  rev (map (fun i => last (after step i row) d) (seq 0 (length row))).

Definition within (error : R) (v : Z) (x : R) : Prop := Rabs (x - IZR v) <= error.
Lemma mean_within e a x b y : within e a x -> within e b y -> within (e + / 2) ((a + b) / 2) ((x + y) / 2).
Proof.
  unfold within. intros A B. apply Rabs_le_inv in A, B.
  generalize (Z.div_mod (a + b) 2) (Z.mod_pos_bound (a + b) 2). intros D M. specialize (D ltac:(lia)). specialize (M ltac:(lia)).
  assert (H : 2 * IZR ((a + b) / 2) <= IZR a + IZR b <= 2 * IZR ((a + b) / 2) + 1).
  { rewrite <- plus_IZR, <- mult_IZR, <- plus_IZR. split; apply IZR_le; lia. }
  apply Rabs_le. lra.
Qed.
Lemma means_within e row xs : Forall2 (within e) row xs -> Forall2 (within (e + / 2)) (means row) (real_means xs).
Proof.
  induction 1 as [| a x row xs H F IH]; [constructor |]. destruct F as [| b y row xs H' F]; [constructor |].
  cbn [means real_means] in *. constructor; auto. now apply mean_within.
Qed.
Lemma after_within k : forall e row xs, Forall2 (within e) row xs ->
  Forall2 (within (e + INR k / 2)) (after means k row) (after real_means k xs).
Proof.
  induction k as [| k IH]; intros e row xs F.
  - simpl. replace (e + 0 / 2) with e by field. exact F.
  - rewrite S_INR. replace (e + (INR k + 1) / 2) with (e + / 2 + INR k / 2) by field. cbn [after].
    now apply IH, means_within.
Qed.
Lemma length_within e row xs : Forall2 (within e) row xs -> length xs = length row.
Proof. induction 1; simpl; congruence. Qed.
Lemma hd_last_within e row xs : 0 <= e -> Forall2 (within e) row xs ->
  within e (hd 0%Z row) (hd 0 xs) /\ within e (last row 0%Z) (last xs 0).
Proof.
  intros P. assert (Z0 : within e 0 0) by (unfold within; rewrite Rminus_0_r, Rabs_R0; exact P).
  induction 1 as [| a x row xs H F IH]; [auto |]. split; [exact H |].
  destruct F as [| b y row xs H' F]; [exact H | apply IH].
Qed.
(** The code adds (n + 1)/2, rounded down, for n + 1 coefficients. *)
Theorem row_halves error row xs n : (0 <= error)%Z -> length row = S n -> Forall2 (near error) row xs ->
  let error' := (error + (Z.of_nat n + 1) / 2)%Z in
  Forall2 (near error') (left_half means 0%Z row) (left_half real_means 0 xs) /\
  Forall2 (near error') (right_half means 0%Z row) (right_half real_means 0 xs).
Proof.
  intros P L F error'. assert (Lx := length_within (IZR error) row xs F).
  assert (Each : forall i, (i < length row)%nat ->
    near error' (hd 0%Z (after means i row)) (hd 0 (after real_means i xs)) /\
    near error' (last (after means i row) 0%Z) (last (after real_means i xs) 0)).
  { intros i I. assert (Pe : 0 <= IZR error) by now apply (IZR_le 0).
    assert (Pi := pos_INR i). destruct (hd_last_within (IZR error + INR i / 2) _ _ ltac:(lra) (after_within i (IZR error) _ _ F)) as [H1 H2].
    assert (E : IZR error + INR i / 2 <= IZR error').
    { unfold error'. rewrite plus_IZR. apply Rplus_le_compat_l.
      apply Rle_trans with (IZR (Z.of_nat n) / 2); [rewrite <- INR_IZR_INZ; apply Rmult_le_compat_r; [lra | apply le_INR; lia] |].
      generalize (Z.div_mod (Z.of_nat n + 1) 2 ltac:(lia)) (Z.mod_pos_bound (Z.of_nat n + 1) 2 ltac:(lia)). intros D M.
      assert (H : (Z.of_nat n <= 2 * ((Z.of_nat n + 1) / 2))%Z) by lia. apply IZR_le in H. rewrite mult_IZR in H. lra. }
    unfold within in H1, H2. unfold near. lra. }
  unfold left_half, right_half. rewrite Lx.
  assert (Map : forall l, (forall i, In i l -> (i < length row)%nat) ->
    Forall2 (near error') (map (fun i => hd 0%Z (after means i row)) l) (map (fun i => hd 0 (after real_means i xs)) l) /\
    Forall2 (near error') (map (fun i => last (after means i row) 0%Z) l) (map (fun i => last (after real_means i xs) 0) l)).
  { induction l as [| i l IH]; intros H; cbn [map]; [split; constructor |].
    destruct (Each i ltac:(apply H; now left)) as [E1 E2]. destruct (IH ltac:(intros; apply H; now right)). split; constructor; auto. }
  destruct (Map (seq 0 (length row))) as [M1 M2]; [intros i I; apply in_seq in I; lia |].
  split; [exact M1 |]. revert M2. generalize (map (fun i => last (after means i row) 0%Z) (seq 0 (length row)))
    (map (fun i => last (after real_means i xs) 0) (seq 0 (length row))).
  induction 1 as [| a x l l' H F' IH]; [constructor |]. cbn [rev]. apply Forall2_app; auto.
Qed.
(** Sums of two have room, as numbers do not grow: at most 2^(width - 3) in size. *)
Theorem row_stays most k row : (0 <= most)%Z -> Forall (fun v => Z.abs v <= most)%Z row ->
  Forall (fun v => Z.abs v <= most)%Z (after means k row).
Proof.
  intros P. assert (Step : forall row, Forall (fun v => Z.abs v <= most)%Z row -> Forall (fun v => Z.abs v <= most)%Z (means row)).
  { induction 1 as [| a l H F IH]; [constructor |]. destruct F as [| b l H' F]; [constructor |].
    cbn [means] in *. constructor; auto. generalize (Z.div_mod (a + b) 2) (Z.mod_pos_bound (a + b) 2). lia. }
  revert row. induction k as [| k IH]; intros row F; [exact F |]. cbn [after]. apply IH, Step, F.
Qed.
