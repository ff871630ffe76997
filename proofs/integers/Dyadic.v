(** Dyadic numbers n 2^e (include/errbound/integers/dyadic.hpp), n an exact integer. Results:
        dyadic_sum, dyadic_difference, dyadic_product, dyadic_scale   are those of the numbers, in normal form
        dyadic_equal, dyadic_order   == and <=> compare the numbers
        dyadic_in_units         in_units: x/2^unit
        dyadic_floor_log2       floor_log2 *)

From Coq Require Import Reals ZArith Lia Lra Bool.
From Flocq Require Import Core.
Open Scope Z_scope.

Definition dyadic : Set := Z * Z.
Definition value (x : dyadic) : R := (IZR (fst x) * bpow radix2 (snd x))%R.
(** The numerator is odd, or both are zero. *)
Definition normal (x : dyadic) : Prop := Z.Odd (fst x) \/ x = (0, 0).

(** lsb *)
Fixpoint trailing_zeros (n : positive) : Z :=
  match n with xO n => trailing_zeros n + 1 | _ => 0 end.
Definition least_bit (n : Z) : Z := match n with Z0 => 0 | Zpos n | Zneg n => trailing_zeros n end.
(** The constructor; a shift by 2^0 changes nothing. *)
Definition made (n e : Z) : dyadic :=
  if n =? 0 then (0, 0) else (n / 2 ^ least_bit n, e + least_bit n).
Definition in_units (x : dyadic) (unit : Z) : Z :=
  fst x * 2 ^ (if fst x =? 0 then 0 else snd x - unit).
Definition opposite (x : dyadic) : dyadic := made (- fst x) (snd x).
Definition sum (a b : dyadic) : dyadic :=
  let e := if snd a <? snd b then snd a else snd b in made (in_units a e + in_units b e) e.
Definition difference (a b : dyadic) : dyadic := sum a (opposite b).
Definition product (a b : dyadic) : dyadic := made (fst a * fst b) (snd a + snd b).
Definition scale (x : dyadic) (e : Z) : dyadic := made (fst x) (snd x + e).
Definition equal (a b : dyadic) : bool := (snd a =? snd b) && (fst a =? fst b).
Definition order (a b : dyadic) : comparison := fst (difference a b) ?= 0.
Definition floor_log2 (x : dyadic) : Z := Z.log2 (Z.abs (fst x)) + snd x.

Lemma least_bit_right n : n <> 0 -> 0 <= least_bit n /\ exists m, n = m * 2 ^ least_bit n /\ Z.Odd m.
Proof.
  assert (P : forall n, 0 <= trailing_zeros n /\ exists m, Zpos n = m * 2 ^ trailing_zeros n /\ Z.Odd m).
  { induction n0 as [n0 IH | n0 IH |]; cbn [trailing_zeros].
    - split; [lia |]. exists (Zpos (xI n0)). split; [lia |]. exists (Zpos n0). lia.
    - destruct IH as (L & m & E & O). split; [lia |]. exists m. split; [| exact O].
      rewrite Z.pow_add_r by lia. change (2 ^ 1) with 2. lia.
    - split; [lia |]. exists 1. split; [reflexivity |]. now exists 0. }
  destruct n as [| n | n]; [easy | intros _; apply P | intros _].
  destruct (P n) as (L & m & E & O). split; [exact L |]. exists (- m). cbn [least_bit]. split; [| now apply Z.odd_spec; rewrite Z.odd_opp; apply Z.odd_spec].
  change (Zneg n) with (- Zpos n). rewrite E. ring.
Qed.
Lemma made_right n e : value (made n e) = (IZR n * bpow radix2 e)%R /\ normal (made n e).
Proof.
  unfold made. destruct (Z.eqb_spec n 0) as [-> | N]; [split; [unfold value; simpl; ring | now right] |].
  destruct (least_bit_right n N) as (L & m & E & O). set (k := least_bit n) in *.
  assert (Q : n / 2 ^ k = m) by (rewrite E; apply Z.div_mul, Z.pow_nonzero; lia).
  split; [| left; cbn [fst]; now rewrite Q]. unfold value. cbn [fst snd]. rewrite Q, E, mult_IZR.
  change 2 with (radix_val radix2). rewrite IZR_Zpower, bpow_plus by auto. ring.
Qed.
Theorem dyadic_in_units x unit : unit <= snd x -> (IZR (in_units x unit) * bpow radix2 unit = value x)%R.
Proof.
  intros H. unfold in_units, value. destruct (Z.eqb_spec (fst x) 0) as [-> | N]; [simpl; ring |].
  rewrite mult_IZR. change 2 with (radix_val radix2). rewrite IZR_Zpower by lia. rewrite Rmult_assoc, <- bpow_plus.
  do 2 f_equal. lia.
Qed.
Theorem dyadic_sum a b : value (sum a b) = (value a + value b)%R /\ normal (sum a b).
Proof.
  unfold sum. cbv zeta. set (e := if snd a <? snd b then snd a else snd b).
  assert (E : e <= snd a /\ e <= snd b) by (unfold e; destruct (Z.ltb_spec (snd a) (snd b)); lia).
  destruct (made_right (in_units a e + in_units b e) e) as [V N]. split; [| exact N].
  rewrite V, plus_IZR, Rmult_plus_distr_r, !dyadic_in_units by apply E. reflexivity.
Qed.
Theorem dyadic_difference a b : value (difference a b) = (value a - value b)%R /\ normal (difference a b).
Proof.
  unfold difference. destruct (dyadic_sum a (opposite b)) as [V N]. split; [| exact N]. rewrite V.
  unfold opposite. rewrite (proj1 (made_right _ _)). unfold value. rewrite opp_IZR. ring.
Qed.
Theorem dyadic_product a b : value (product a b) = (value a * value b)%R /\ normal (product a b).
Proof.
  unfold product. destruct (made_right (fst a * fst b) (snd a + snd b)) as [V N]. split; [| exact N].
  rewrite V, mult_IZR, bpow_plus. unfold value. ring.
Qed.
Theorem dyadic_scale x e : value (scale x e) = (value x * bpow radix2 e)%R /\ normal (scale x e).
Proof.
  unfold scale. destruct (made_right (fst x) (snd x + e)) as [V N]. split; [| exact N].
  rewrite V, bpow_plus. unfold value. ring.
Qed.
Lemma value_sign x : (fst x ?= 0) = Rcompare (value x) 0.
Proof.
  assert (P := bpow_gt_0 radix2 (snd x)). unfold value. symmetry. destruct (Z.compare_spec (fst x) 0) as [E | E | E].
  - apply Rcompare_Eq. rewrite E. ring.
  - apply Rcompare_Lt. apply IZR_lt in E. nra.
  - apply Rcompare_Gt. apply IZR_lt in E. nra.
Qed.
Theorem dyadic_order a b : order a b = Rcompare (value a) (value b).
Proof.
  unfold order. rewrite value_sign, (proj1 (dyadic_difference a b)). case (Rcompare_spec (value a) (value b)); intros.
  - apply Rcompare_Lt. lra.
  - apply Rcompare_Eq. lra.
  - apply Rcompare_Gt. lra.
Qed.
Theorem dyadic_equal a b : normal a -> normal b -> (equal a b = true <-> value a = value b).
Proof.
  intros Na Nb. unfold equal. rewrite andb_true_iff, !Z.eqb_eq. split; [intros [E1 E2]; unfold value; now rewrite E1, E2 |].
  assert (Higher : forall x y, normal x -> normal y -> value x = value y -> snd x <= snd y -> snd x = snd y /\ fst x = fst y).
  { intros x y Nx Ny E L. rewrite <- (dyadic_in_units y (snd x) L) in E. unfold value in E.
    apply Rmult_eq_reg_r in E; [| apply Rgt_not_eq, bpow_gt_0]. apply eq_IZR in E. unfold in_units in E.
    destruct (Z.eqb_spec (fst y) 0) as [Zy | Zy].
    - rewrite Zy in *. destruct Nx as [[q O] | ->]; [lia |]. destruct Ny as [[q O] | ->]; [lia | auto].
    - destruct (Z.eq_dec (snd x) (snd y)) as [S | S].
      + rewrite S, Z.sub_diag in E. split; [exact S | lia].
      + exfalso. assert (Even : exists k, fst x = 2 * k).
        { exists (fst y * 2 ^ (snd y - snd x - 1)). rewrite E. replace (snd y - snd x) with (1 + (snd y - snd x - 1)) at 1 by ring.
          rewrite Z.pow_add_r by lia. change (2 ^ 1) with 2. ring. }
        destruct Even as [k K]. destruct Nx as [[q O] | ->]; [lia |]. cbn [fst] in *.
        assert (0 < 2 ^ (snd y - 0)) by (apply Z.pow_pos_nonneg; cbn [snd] in *; lia). cbn [snd] in *. nia. }
  intros E. destruct (Z_le_gt_dec (snd a) (snd b)) as [L | L].
  - now apply Higher.
  - destruct (Higher b a Nb Na (eq_sym E) ltac:(lia)). auto.
Qed.
Theorem dyadic_floor_log2 x : fst x <> 0 ->
  (bpow radix2 (floor_log2 x) <= Rabs (value x) < bpow radix2 (floor_log2 x + 1))%R.
Proof.
  intros N. unfold floor_log2, value. rewrite Rabs_mult, (Rabs_pos_eq (bpow _ _)), <- abs_IZR by apply bpow_ge_0.
  destruct (Z.log2_spec (Z.abs (fst x)) ltac:(lia)) as [L U]. generalize (Z.log2_nonneg (Z.abs (fst x))). intros P.
  replace (Z.log2 (Z.abs (fst x)) + snd x + 1) with (Z.succ (Z.log2 (Z.abs (fst x))) + snd x) by ring.
  rewrite !bpow_plus, <- (IZR_Zpower radix2 (Z.log2 _)), <- (IZR_Zpower radix2 (Z.succ _)) by lia. generalize (bpow_gt_0 radix2 (snd x)). intros B.
  split; [apply Rmult_le_compat_r; [lra | now apply IZR_le] | apply Rmult_lt_compat_r; [lra | now apply IZR_lt]].
Qed.
