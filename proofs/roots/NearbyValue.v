(** Numbers with an error bound (include/errbound/roots/nearby_value.hpp): |x - value 2^k| <= error 2^k. Results:
        near_exact       a whole number times a power of two
        near_product     a product
        near_sum         a sum in one unit
        near_cut         fewer bits: one unit for the bits of the value, one for those of the error
        near_shifted     a finer unit
        near_widened     a coarser unit, if only the error is left
        near_sign        the sign, if the value exceeds the error *)

From Coq Require Import Reals ZArith Lia Lra Psatz.
From Flocq Require Import Core.
Open Scope R_scope.

Notation two := (bpow radix2).

Definition encloses (v e k : Z) (x : R) : Prop := Rabs (x - IZR v * two k) <= IZR e * two k.

Theorem near_exact v k : encloses v 0 k (IZR v * two k).
Proof. unfold encloses. rewrite Rminus_diag_eq by reflexivity. rewrite Rabs_R0. lra. Qed.

Lemma near_error v e k x : encloses v e k x -> (0 <= e)%Z.
Proof.
  unfold encloses. intros N. pose proof (Rabs_pos (x - IZR v * two k)). pose proof (bpow_gt_0 radix2 k).
  apply le_IZR. nra.
Qed.

(** x = (v + d) 2^k with |d| <= e. *)
Lemma near_part v e k x : encloses v e k x <-> exists d, x = (IZR v + d) * two k /\ Rabs d <= IZR e.
Proof.
  pose proof (bpow_gt_0 radix2 k) as P. unfold encloses. split.
  - intros N. exists (x / two k - IZR v). split; [field; lra |].
    replace (x / two k - IZR v) with ((x - IZR v * two k) / two k) by (field; lra).
    unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ two k)) by (left; now apply Rinv_0_lt_compat).
    apply Rmult_le_reg_r with (two k); [easy |]. rewrite Rmult_assoc, Rinv_l by lra. lra.
  - intros (d & -> & D). replace ((IZR v + d) * two k - IZR v * two k) with (d * two k) by ring.
    rewrite Rabs_mult, (Rabs_pos_eq (two k)) by lra. nra.
Qed.

(** operator* *)
Definition product_error (v e w f : Z) : Z := (e * (Z.abs w + f) + Z.abs v * f)%Z.
Theorem near_product v e k x w f l y : encloses v e k x -> encloses w f l y ->
  encloses (v * w) (product_error v e w f) (k + l) (x * y).
Proof.
  intros N M. pose proof (near_error _ _ _ _ N). pose proof (near_error _ _ _ _ M).
  apply near_part in N. apply near_part in M. destruct N as (c & -> & C), M as (d & -> & D). apply near_part.
  exists (c * (IZR w + d) + IZR v * d). split; [rewrite mult_IZR, bpow_plus; ring |].
  unfold product_error. rewrite plus_IZR, !mult_IZR, plus_IZR, !abs_IZR.
  eapply Rle_trans; [apply Rabs_triang |]. rewrite !Rabs_mult.
  pose proof (Rabs_triang (IZR w) d). pose proof (Rabs_pos c). pose proof (Rabs_pos d). pose proof (Rabs_pos (IZR w + d)).
  pose proof (Rabs_pos (IZR v)). pose proof (Rabs_pos (IZR w)).
  assert (Rabs c * Rabs (IZR w + d) <= IZR e * (Rabs (IZR w) + IZR f)) by (apply Rmult_le_compat; lra).
  assert (Rabs (IZR v) * Rabs d <= Rabs (IZR v) * IZR f) by (apply Rmult_le_compat_l; lra). lra.
Qed.

(** sum, in one unit *)
Theorem near_sum v e w f k x y : encloses v e k x -> encloses w f k y -> encloses (v + w) (e + f) k (x + y).
Proof.
  intros N M. apply near_part in N. apply near_part in M. destruct N as (c & -> & C), M as (d & -> & D).
  apply near_part. exists (c + d). rewrite !plus_IZR. split; [ring |]. pose proof (Rabs_triang c d). lra.
Qed.

Lemma two_shift s : (0 <= s)%Z -> two s = IZR (2 ^ s).
Proof. intros S. rewrite <- (IZR_Zpower radix2) by easy. reflexivity. Qed.

(** sum: a number in the coarser unit is converted to the finer one *)
Theorem near_shifted v e k s x : (0 <= s)%Z -> encloses v e k x -> encloses (v * 2 ^ s) (e * 2 ^ s) (k - s) x.
Proof.
  intros S N. unfold encloses in *. rewrite !mult_IZR, <- !two_shift by easy.
  assert (E : two s * two (k - s) = two k) by (rewrite <- bpow_plus; f_equal; lia).
  now rewrite !Rmult_assoc, E.
Qed.

(** drop: the value is rounded towards zero, the error downwards, and 2 is added. *)
Theorem near_cut v e k s x : (0 <= s)%Z -> encloses v e k x -> encloses (Z.quot v (2 ^ s)) (Z.quot e (2 ^ s) + 2) (k + s) x.
Proof.
  intros S N. pose proof (near_error _ _ _ _ N) as E. apply near_part in N. destruct N as (d & -> & D). apply near_part.
  assert (P : (0 < 2 ^ s)%Z) by (apply Z.pow_pos_nonneg; lia).
  exists ((IZR v + d) / two s - IZR (Z.quot v (2 ^ s))). pose proof (bpow_gt_0 radix2 s) as B. split.
  - rewrite bpow_plus. field. lra.
  - rewrite (two_shift s S) in *. pose proof (Z.quot_rem' v (2 ^ s)) as Q. pose proof (Z.quot_rem' e (2 ^ s)) as F.
    pose proof (Z.rem_bound_abs v (2 ^ s) ltac:(lia)) as RV. pose proof (Z.rem_bound_pos e (2 ^ s) E P) as RE.
    set (u := (2 ^ s)%Z) in *. set (q := Z.quot v u) in *. set (r := Z.rem v u) in *.
    set (g := Z.quot e u) in *. set (h := Z.rem e u) in *.
    assert (RV' : Rabs (IZR r) <= IZR u) by (rewrite <- abs_IZR; apply IZR_le; lia).
    assert (VE : IZR v = IZR u * IZR q + IZR r) by (rewrite Q, plus_IZR, mult_IZR; reflexivity).
    assert (EE : IZR e <= IZR u * (IZR g + 1)).
    { replace (IZR u * (IZR g + 1)) with (IZR (u * g + u)) by (rewrite plus_IZR, mult_IZR; ring). apply IZR_le. lia. }
    rewrite plus_IZR. replace ((IZR v + d) / IZR u - IZR q) with ((IZR r + d) / IZR u) by (rewrite VE; field; lra).
    unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ IZR u)) by (left; now apply Rinv_0_lt_compat).
    apply Rmult_le_reg_r with (IZR u); [easy |]. rewrite Rmult_assoc, Rinv_l by lra. rewrite Rmult_1_r.
    pose proof (Rabs_triang (IZR r) d). nra.
Qed.

(** sum: if only the error is left, its unit may be coarser. *)
Theorem near_widened e k l x : (k <= l)%Z -> encloses 0 e k x -> encloses 0 e l x.
Proof.
  intros L N. pose proof (near_error _ _ _ _ N) as E. apply IZR_le in E. unfold encloses in *.
  rewrite !Rmult_0_l, !Rminus_0_r in *. pose proof (bpow_le radix2 _ _ L). nra.
Qed.

(** sign *)
Theorem near_sign v e k x : encloses v e k x -> (e < Z.abs v)%Z \/ e = 0%Z ->
  (0 < v)%Z /\ 0 < x \/ (v < 0)%Z /\ x < 0 \/ v = 0%Z /\ x = 0.
Proof.
  intros N A. pose proof (near_error _ _ _ _ N) as E. apply near_part in N. destruct N as (d & -> & D).
  pose proof (bpow_gt_0 radix2 k). pose proof (Rle_abs d). pose proof (Rle_abs (- d)). rewrite Rabs_Ropp in *.
  destruct (Z.lt_trichotomy v 0) as [V | [-> | V]].
  - right. left. split; [easy |]. assert (IZR e + IZR v < 0) by (rewrite <- plus_IZR; apply IZR_lt; lia). nra.
  - right. right. split; [easy |]. assert (e = 0%Z) as -> by lia. pose proof (Rabs_pos d). assert (d = 0) as -> by lra. ring.
  - left. split; [easy |]. assert (0 < IZR v - IZR e) by (rewrite <- minus_IZR; apply IZR_lt; lia). nra.
Qed.
