(** Coordinates as integers of fixed width, with a unit for each axis (ccd/exact/axis_units.hpp). Results:
        difference_in_units_exact   differences of converted coordinates are those of the coordinates if they are
            below
                                    2^(64W - 1) units, even if the conversion wrapped around
        extent_bits_enough          coordinates of an axis differ by less than 2^bits units *)

From Coq Require Import Reals ZArith List Lia Lra Bool.
From Flocq Require Import Core.
From Errbound Require Import Format Words Widths.
From Errbound Require WordBits FixedWidths.
Open Scope Z_scope.

(** integer_units::in_units of the double (-1)^n m 2^e *)
Definition in_units (W : nat) (m e : Z) (negative : bool) (unit : Z) : list Z :=
  let shift := e - unit in
  let size := WordBits.shifted (m / 2 ^ Z.min 63 (Z.max 0 (- shift))) (Z.max shift 0) W in
  if negative then FixedWidths.opposite size else size.
Definition coordinate (m e : Z) (negative : bool) : R :=
  ((if negative then -1 else 1) * (IZR m * bpow radix2 e))%R.

Lemma in_units_modulo W m e negative unit : 0 <= m < 2 ^ 53 -> (2 ^ Z.max 0 (unit - e) | m) ->
  words (in_units W m e negative unit) /\ length (in_units W m e negative unit) = W /\
  exists v k, value (in_units W m e negative unit) = v + k * B ^ Z.of_nat W /\
    (IZR v * bpow radix2 unit = coordinate m e negative)%R.
Proof.
  intros M H. unfold in_units. cbv zeta. set (shift := e - unit).
  set (q := m / 2 ^ Z.min 63 (Z.max 0 (- shift))). set (v := q * 2 ^ Z.max shift 0).
  assert (E : (IZR v * bpow radix2 unit = IZR m * bpow radix2 e)%R).
  { destruct (Z.eq_dec m 0) as [Z0 | N].
    - unfold v, q. rewrite Z0, Z.div_0_l by (apply Z.pow_nonzero; lia). simpl. ring.
    - assert (L : exists bits, (IZR m * bpow radix2 e < bpow radix2 (unit + bits))%R).
      { exists (53 + e - unit). replace (unit + (53 + e - unit)) with (53 + e) by ring. rewrite bpow_plus.
        apply Rmult_lt_compat_r; [apply bpow_gt_0 |]. change (bpow radix2 53) with (IZR (2 ^ 53)). apply IZR_lt. lia. }
      destruct L as [bits L]. apply (converted_exact m e unit bits); auto. lia. }
  assert (Q : word q).
  { unfold word, q. assert (0 < 2 ^ Z.min 63 (Z.max 0 (- shift))) by (apply Z.pow_pos_nonneg; lia).
    split; [apply Z.div_pos; lia |]. apply Z.div_lt_upper_bound; [lia |]. change B with (2 ^ 11 * 2 ^ 53). nia. }
  assert (S := proj1 (WordBits.shifted_exact q (Z.max shift 0) W Q ltac:(lia))). fold v in S.
  rewrite (WordBits.shifted_words q (Z.max shift 0) W Q ltac:(lia)) in *. fold v in S |- *.
  destruct (WordBits.words_of_words W v) as [Ws Ls]. set (size := WordBits.words_of W v) in *.
  generalize (Z.div_mod v (B ^ Z.of_nat W)) (power_positive W). intros D P. unfold coordinate.
  destruct negative.
  - assert (L0 : length (zeros (length size)) = length size) by apply length_zeros. unfold FixedWidths.opposite.
    destruct (FixedWidths.difference_words _ _ L0 (words_zeros _) Ws) as [Wd Ld]. split; [exact Wd |]. split; [congruence |].
    generalize (stepped_difference _ _ 0 L0 (words_zeros _) Ws ltac:(lia)). unfold difference.
    destruct (stepped subtract_with_borrow (zeros (length size)) size 0) as [r c]. intros (_ & _ & Er). cbn [fst].
    exists (- v), (c + v / B ^ Z.of_nat W). split.
    + rewrite L0, value_zeros, Ls in Er. rewrite S in Er. lia.
    + rewrite opp_IZR, <- Ropp_mult_distr_l, E. ring.
  - split; [exact Ws |]. split; [exact Ls |]. exists v, (- (v / B ^ Z.of_nat W)). split; [lia |]. rewrite E. ring.
Qed.
Theorem difference_in_units_exact W m e n m' e' n' unit : W <> 0%nat ->
  0 <= m < 2 ^ 53 -> 0 <= m' < 2 ^ 53 -> (2 ^ Z.max 0 (unit - e) | m) -> (2 ^ Z.max 0 (unit - e') | m') ->
  (Rabs (coordinate m e n - coordinate m' e' n') < bpow radix2 (64 * Z.of_nat W - 1 + unit))%R ->
  (IZR (signed (difference (in_units W m e n unit) (in_units W m' e' n' unit))) * bpow radix2 unit =
   coordinate m e n - coordinate m' e' n')%R.
Proof.
  intros N M M' H H' L. destruct (in_units_modulo W m e n unit M H) as (Wa & La & v & k & V & E).
  destruct (in_units_modulo W m' e' n' unit M' H') as (Wb & Lb & v' & k' & V' & E').
  rewrite <- E, <- E' in *. rewrite <- Rmult_minus_distr_r, <- minus_IZR in *. f_equal. f_equal.
  assert (F : fits W (v - v')).
  { rewrite Rabs_mult, (Rabs_pos_eq (bpow _ _)), bpow_plus in L by apply bpow_ge_0.
    apply Rmult_lt_reg_r in L; [| apply bpow_gt_0]. rewrite <- abs_IZR, <- IZR_Zpower in L by lia. apply lt_IZR in L.
    change (radix_val radix2) with 2 in L. unfold fits, base. rewrite <- Z.pow_mul_r by lia.
    replace (64 * Z.of_nat W) with (1 + (64 * Z.of_nat W - 1)) by ring. rewrite Z.pow_add_r by lia. change (2 ^ 1) with 2. lia. }
  set (a := in_units W m e n unit) in *. set (b := in_units W m' e' n' unit) in *.
  assert (Lab : length a = length b) by congruence.
  destruct (FixedWidths.difference_words a b Lab Wa Wb) as [Wd Ld].
  generalize (stepped_difference a b 0 Lab Wa Wb ltac:(lia)). revert Wd Ld. unfold difference.
  destruct (stepped subtract_with_borrow a b 0) as [r c]. cbn [fst]. intros Wd Ld (_ & _ & Er).
  apply signed_is with (k := c + k - k'); auto.
  - intros Z0. rewrite Z0 in Ld. simpl in Ld. lia.
  - now rewrite Ld, La.
  - rewrite Ld, La. rewrite La, V, V' in Er. lia.
Qed.

#[local] Instance double_precision : Prec_gt_0 53 := eq_refl.
(** high - low, for doubles at one end of the step, rounded, is less than 2^E with E from its exponent; if infinite,
    E is 1025. *)
Theorem extent_bits_enough low high x y E unit : double low -> double high ->
  (low <= x <= high)%R -> (low <= y <= high)%R -> -1074 <= E ->
  (fl (high - low) < bpow radix2 E \/ (E = 1025)%Z /\ Rabs low < bpow radix2 1024 /\ Rabs high < bpow radix2 1024)%R ->
  (Rabs (x - y) < bpow radix2 (unit + Z.max 0 (E - unit)))%R.
Proof.
  intros NL NH X Y PE H. apply Rlt_le_trans with (bpow radix2 E); [| apply bpow_le; lia].
  apply Rle_lt_trans with (high - low)%R; [apply Rabs_le; lra |].
  destruct H as [H | (-> & HL & HH)].
  - apply Rnot_le_lt. intros C. apply (rnd_above 53 (-1074) nearest) in C; [lra |]. now apply number_power.
  - change (bpow radix2 1025) with (bpow radix2 (1 + 1024)). rewrite bpow_plus. change (bpow radix2 1) with 2%R.
    apply Rabs_def2 in HL, HH. lra.
Qed.
