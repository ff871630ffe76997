(** Bits of exact results (include/errbound/integers/sized_integer.hpp, expression_count.hpp), and coordinates as
    integers (include/errbound/integers/common_exponent.hpp). Results:
        sized_exact       every number of an expression is less than 2^bits units of its degree, and stands for the
            exact
                          value
        sized_fits        so it fits the words, or the double, of the code
        bits_by_degree    bits = bits of the shape + degree times the coordinates' bits
        coordinate_bits_enough   coordinates that are shorter by the excess over the degree suffice
        converted_exact   common_unit::converted: the coordinate in units, and its bits
        word_coordinates_exact, short_coordinates_exact   if word_coordinates or short_coordinates fit, they are the
                          coordinates *)

From Coq Require Import Reals ZArith List Lia Lra.
From Flocq Require Import Core.
From Errbound Require Import Format Words.
Open Scope Z_scope.

Inductive sized :=
| Coordinate (c : Z)
| Constant (c : Z)
| Sum (x y : sized)
| Minus (x y : sized)
| Product (x y : sized)
| Negation (x : sized).

Section Sized.

(** A coordinate's bits. 1 is 2^-unit units, if numbers of different degree are added. *)
Context (coordinate_bits : Z) (unit : Z).

Fixpoint degree (e : sized) : Z :=
  match e with
  | Coordinate _ => 1
  | Constant _ => 0
  | Sum x y | Minus x y => Z.max (degree x) (degree y)
  | Product x y => degree x + degree y
  | Negation x => degree x
  end.
(** The code: expression_count, and the types of sized_integer. *)
Definition raised_bits (bits own other : Z) : Z := bits + Z.max 0 (other - own) * coordinate_bits.
Fixpoint bits (e : sized) : Z :=
  match e with
  | Coordinate _ => coordinate_bits
  | Constant _ => 32
  | Sum x y | Minus x y =>
      Z.max (raised_bits (bits x) (degree x) (degree y)) (raised_bits (bits y) (degree y) (degree x)) + 1
  | Product x y => bits x + bits y
  | Negation x => bits x
  end.
Definition raised (x own other : Z) : Z := x * (2 ^ (- unit)) ^ Z.max 0 (other - own).
Fixpoint number (e : sized) : Z :=
  match e with
  | Coordinate c | Constant c => c
  | Sum x y => raised (number x) (degree x) (degree y) + raised (number y) (degree y) (degree x)
  | Minus x y => raised (number x) (degree x) (degree y) - raised (number y) (degree y) (degree x)
  | Product x y => number x * number y
  | Negation x => - number x
  end.
Fixpoint exact (e : sized) : R :=
  match e with
  | Coordinate c => IZR c * bpow radix2 unit
  | Constant c => IZR c
  | Sum x y => exact x + exact y
  | Minus x y => exact x - exact y
  | Product x y => exact x * exact y
  | Negation x => - exact x
  end.

(** Coordinates are in range, constants are ints, and 1 is in range if degrees differ. *)
Fixpoint admissible (e : sized) : Prop :=
  match e with
  | Coordinate c => Z.abs c < 2 ^ coordinate_bits
  | Constant c => Z.abs c <= 2 ^ 31
  | Sum x y | Minus x y =>
      admissible x /\ admissible y /\
      (degree x = degree y \/ unit <= 0 /\ - unit < coordinate_bits)
  | Product x y => admissible x /\ admissible y
  | Negation x => admissible x
  end.

Hypothesis coordinate_bits_0 : 0 <= coordinate_bits.

Lemma degree_0 e : 0 <= degree e.
Proof. induction e; simpl; lia. Qed.
Lemma bits_0 e : 0 <= bits e.
Proof.
  induction e; simpl; unfold raised_bits; try lia;
    generalize (degree_0 e1) (degree_0 e2); nia.
Qed.
Lemma raised_range x b own other : 0 <= b -> Z.abs x < 2 ^ b ->
  own = other \/ unit <= 0 /\ - unit < coordinate_bits ->
  Z.abs (raised x own other) < 2 ^ raised_bits b own other.
Proof.
  unfold raised, raised_bits. intros B X [-> | [U V]].
  - replace (other - other) with 0 by lia. change (Z.max 0 0) with 0.
    rewrite Z.pow_0_r. now rewrite Z.mul_1_r, Z.mul_0_l, Z.add_0_r.
  - set (k := Z.max 0 (other - own)). assert (0 <= k) by lia.
    rewrite <- Z.pow_mul_r, Z.abs_mul, (Z.abs_eq (2 ^ _)), Z.pow_add_r by (apply Z.pow_nonneg || nia; lia).
    assert (2 ^ (- unit * k) <= 2 ^ (k * coordinate_bits)) by (apply Z.pow_le_mono_r; nia).
    assert (0 < 2 ^ (- unit * k)) by (apply Z.pow_pos_nonneg; nia). nia.
Qed.
Lemma number_range e : admissible e -> Z.abs (number e) < 2 ^ bits e.
Proof.
  assert (S : forall x y, admissible x -> admissible y ->
    degree x = degree y \/ unit <= 0 /\ - unit < coordinate_bits ->
    Z.abs (number x) < 2 ^ bits x -> Z.abs (number y) < 2 ^ bits y ->
    Z.abs (raised (number x) (degree x) (degree y)) + Z.abs (raised (number y) (degree y) (degree x)) <
    2 ^ (Z.max (raised_bits (bits x) (degree x) (degree y))
               (raised_bits (bits y) (degree y) (degree x)) + 1)).
  { intros x y _ _ D X Y.
    generalize (raised_range _ _ (degree x) (degree y) (bits_0 x) X D)
      (raised_range _ _ (degree y) (degree x) (bits_0 y) Y ltac:(lia)).
    set (i := raised_bits (bits x) _ _). set (j := raised_bits (bits y) _ _).
    assert (0 <= i /\ 0 <= j).
    { unfold i, j, raised_bits. generalize (bits_0 x) (bits_0 y). nia. }
    assert (2 ^ i <= 2 ^ Z.max i j) by (apply Z.pow_le_mono_r; lia).
    assert (2 ^ j <= 2 ^ Z.max i j) by (apply Z.pow_le_mono_r; lia).
    rewrite Z.pow_add_r by lia. change (2 ^ 1) with 2. lia. }
  induction e as [c | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx]; simpl; intros A.
  - exact A.
  - apply Z.le_lt_trans with (1 := A). reflexivity.
  - destruct A as (A & B & D). generalize (S x y A B D (IHx A) (IHy B)). lia.
  - destruct A as (A & B & D). generalize (S x y A B D (IHx A) (IHy B)). lia.
  - destruct A as (A & B). specialize (IHx A). specialize (IHy B).
    rewrite Z.abs_mul, Z.pow_add_r by apply bits_0. apply Z.mul_lt_mono_nonneg; lia.
  - rewrite Z.abs_opp. auto.
Qed.
Lemma raised_exact x own other :
  own = other \/ unit <= 0 /\ - unit < coordinate_bits ->
  (IZR (raised x own other) * bpow radix2 (unit * Z.max own other) = IZR x * bpow radix2 (unit * own))%R.
Proof.
  unfold raised. intros [-> | [U V]].
  - replace (other - other) with 0 by lia. rewrite !Z.max_id.
    now rewrite Z.pow_0_r, Z.mul_1_r.
  - set (k := Z.max 0 (other - own)). replace (Z.max own other) with (own + k) by lia.
    rewrite <- Z.pow_mul_r by lia. rewrite mult_IZR. change 2 with (radix_val radix2).
    rewrite IZR_Zpower by (apply Z.mul_nonneg_nonneg; lia).
    rewrite Rmult_assoc, <- bpow_plus. f_equal. f_equal. ring.
Qed.
Theorem sized_exact e : admissible e ->
  Z.abs (number e) < 2 ^ bits e /\ (IZR (number e) * bpow radix2 (unit * degree e) = exact e)%R.
Proof.
  intros H. split; [now apply number_range |]. revert H.
  induction e as [c | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx];
    cbn [admissible number degree exact]; intros A.
  - now rewrite Z.mul_1_r.
  - rewrite Z.mul_0_r. simpl. ring.
  - destruct A as (A & B & D). rewrite plus_IZR, Rmult_plus_distr_r, raised_exact by auto.
    rewrite Z.max_comm, raised_exact by lia. now rewrite IHx, IHy.
  - destruct A as (A & B & D). rewrite minus_IZR. unfold Rminus. rewrite Rmult_plus_distr_r.
    rewrite raised_exact by auto. rewrite <- Ropp_mult_distr_l, Z.max_comm, raised_exact by lia.
    now rewrite IHx, IHy.
  - destruct A as (A & B). rewrite mult_IZR, Z.mul_add_distr_l, bpow_plus.
    rewrite <- (IHx A), <- (IHy B). ring.
  - rewrite opp_IZR, <- (IHx A). ring.
Qed.

(** Words by bits: Bits / 64 + 1. *)
Theorem sized_fits e : admissible e -> fits (Z.to_nat (bits e / 64 + 1)) (number e).
Proof.
  intros A. generalize (number_range e A) (bits_0 e). intros H P. unfold fits.
  assert (0 <= bits e / 64) by (apply Z.div_pos; lia). rewrite Z2Nat.id by lia.
  unfold base. rewrite <- Z.pow_mul_r by lia.
  assert (L : 2 ^ (bits e + 1) <= 2 ^ (64 * (bits e / 64 + 1))).
  { apply Z.pow_le_mono_r; [lia |]. generalize (Z.div_mod (bits e) 64) (Z.mod_pos_bound (bits e) 64). lia. }
  rewrite Z.pow_add_r in L by lia. change (2 ^ 1) with 2 in L. lia.
Qed.

End Sized.

(** bits grows by the degree times the coordinates' bits, so shorter coordinates save that many bits. *)
Fixpoint shape_bits (e : sized) : Z :=
  match e with
  | Coordinate _ => 0
  | Constant _ => 32
  | Sum x y | Minus x y => Z.max (shape_bits x) (shape_bits y) + 1
  | Product x y => shape_bits x + shape_bits y
  | Negation x => shape_bits x
  end.
Lemma raised_by_degree n s own other :
  raised_bits n (s + own * n) own other = s + Z.max own other * n.
Proof.
  unfold raised_bits. replace (Z.max 0 (other - own)) with (Z.max own other - own) by lia. ring.
Qed.
Theorem bits_by_degree n e : bits n e = shape_bits e + degree e * n.
Proof.
  induction e as [c | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx];
    cbn [bits shape_bits degree]; rewrite ?IHx, ?IHy, ?raised_by_degree; try ring.
  - rewrite (Z.max_comm (degree y)). lia.
  - rewrite (Z.max_comm (degree y)). lia.
Qed.
(** predicate_type::coordinate_bits, for one number whose sign is evaluated. *)
Theorem coordinate_bits_enough n most fewer e :
  0 <= fewer -> 1 <= degree e -> fewer <= n - (bits n e - most + degree e - 1) / degree e -> fewer <= n ->
  bits fewer e <= most.
Proof.
  intros F D L Le. rewrite bits_by_degree. rewrite (bits_by_degree n e) in L.
  set (s := shape_bits e) in *. set (d := degree e) in *.
  generalize (Z.div_mod (s + d * n - most + d - 1) d ltac:(lia))
    (Z.mod_pos_bound (s + d * n - most + d - 1) d ltac:(lia)).
  set (q := (s + d * n - most + d - 1) / d) in *. intros. nia.
Qed.

(** A coordinate m 2^e in units of 2^unit, if its bits are all between unit and unit + bits. *)
Theorem converted_exact m e unit bits :
  0 < m < 2 ^ 53 -> (2 ^ Z.max 0 (unit - e) | m) -> (IZR m * bpow radix2 e < bpow radix2 (unit + bits))%R ->
  let shift := e - unit in
  let v := m / 2 ^ Z.min 63 (Z.max 0 (- shift)) * 2 ^ Z.max shift 0 in
  (IZR v * bpow radix2 unit = IZR m * bpow radix2 e)%R /\ (IZR v < bpow radix2 bits)%R.
Proof.
  intros M [q Q] H shift v. set (s := Z.max 0 (unit - e)) in *.
  assert (P : 0 < 2 ^ s) by (apply Z.pow_pos_nonneg; lia).
  assert (L : s < 53).
  { apply (Z.pow_lt_mono_r_iff 2); try lia. assert (1 <= q) by nia.
    apply Z.le_lt_trans with m; [| lia]. rewrite Q. rewrite <- (Z.mul_1_l (2 ^ s)) at 1.
    apply Z.mul_le_mono_nonneg_r; lia. }
  assert (S : Z.min 63 (Z.max 0 (- shift)) = s) by (unfold shift; lia).
  assert (E : (IZR v * bpow radix2 unit = IZR m * bpow radix2 e)%R).
  { unfold v. rewrite S, Q, Z.div_mul by lia. rewrite !mult_IZR. change 2 with (radix_val radix2).
    rewrite !IZR_Zpower by lia. rewrite !Rmult_assoc, <- !bpow_plus. f_equal. f_equal.
    unfold shift, s. lia. }
  split; auto. apply Rmult_lt_reg_r with (bpow radix2 unit); [apply bpow_gt_0 |].
  rewrite E, <- bpow_plus. now rewrite Z.add_comm.
Qed.

(** Coordinates in double, and arithmetic in double, rounded to nearest. *)
Notation fl := (rnd 53 (-1074) nearest).
Notation double := (Format.number 53 (-1074)).
#[local] Instance double_precision : Prec_gt_0 53 := eq_refl.

Lemma double_form x : double x -> exists m e : Z,
  (x = IZR m * bpow radix2 e)%R /\ Z.abs m < 2 ^ 53 /\ -1074 <= e.
Proof.
  intros H. apply FLT_format_generic in H; [| exact eq_refl]. destruct H as [[m e] -> M E].
  exists m, e. auto.
Qed.
Lemma double_is m e : Z.abs m < 2 ^ 53 -> -1074 <= e -> double (IZR m * bpow radix2 e).
Proof. intros M E. apply number_integer; [exact eq_refl | lia | change 2 with 2; lia]. Qed.

(** A truncated double is a double, and so is its product with a power of two down to 2^-1021. *)
Theorem word_coordinates_exact x unit : double x -> -1021 <= unit ->
  let i := Ztrunc (fl (x * bpow radix2 (- unit))) in
  fl (fl (IZR i) * bpow radix2 unit) = x -> (IZR i * bpow radix2 unit = x)%R.
Proof.
  intros X U i. set (y := fl (x * bpow radix2 (- unit))) in *.
  assert (Y : double y) by (apply rnd_number; auto with typeclass_instances).
  assert (F : exists m e, IZR i = (IZR m * bpow radix2 e)%R /\ Z.abs m < 2 ^ 53 /\ 0 <= e).
  { destruct (double_form y Y) as (m & e & Em & M & E).
    destruct (Z_le_gt_dec 0 e) as [P | P].
    - exists m, e. split; auto. rewrite <- Em. unfold i. rewrite Em.
      rewrite <- IZR_Zpower, <- mult_IZR by lia. now rewrite Ztrunc_IZR.
    - exists i, 0. simpl (bpow radix2 0). split; [ring |]. split; [| lia].
      apply lt_IZR. rewrite abs_IZR. apply Rle_lt_trans with (Rabs y).
      + unfold i. rewrite <- abs_IZR, <- Ztrunc_abs. rewrite Ztrunc_floor by apply Rabs_pos.
        apply Zfloor_lb.
      + rewrite Em, Rabs_mult, (Rabs_pos_eq (bpow _ _)) by apply bpow_ge_0. rewrite <- abs_IZR.
        apply Rle_lt_trans with (IZR (Z.abs m) * 1)%R.
        * apply Rmult_le_compat_l; [apply IZR_le; lia |]. change 1%R with (bpow radix2 0).
          apply bpow_le. lia.
        * rewrite Rmult_1_r. now apply IZR_lt. }
  destruct F as (m & e & Em & M & E). rewrite Em.
  rewrite (rnd_exact 53 (-1074) nearest (IZR m * bpow radix2 e)) by (apply double_is; auto; lia).
  rewrite Rmult_assoc, <- bpow_plus. intros H. rewrite <- H. symmetry.
  apply rnd_exact; auto with typeclass_instances. apply double_is; auto. lia.
Qed.

(** x + 3 2^51 units is rounded to whole units. *)
Theorem short_coordinates_exact x unit : double x -> -1022 <= unit <= 970 ->
  (Rabs x <= bpow radix2 (unit + 51))%R ->
  fl (fl (x + 3 * bpow radix2 (unit + 51)) - 3 * bpow radix2 (unit + 51)) = x ->
  exists k, Z.abs k <= 2 ^ 51 /\ (x = IZR k * bpow radix2 unit)%R.
Proof.
  intros X U B H. set (b := bpow radix2 unit).
  assert (P : (0 < b)%R) by apply bpow_gt_0.
  assert (P51 : bpow radix2 (unit + 51) = (IZR (2 ^ 51) * b)%R).
  { change 2 with (radix_val radix2). rewrite IZR_Zpower by lia. unfold b. rewrite <- bpow_plus.
    f_equal. lia. }
  assert (Whole : forall z, Z.abs z <= 2 ^ 53 -> double (IZR z * b)).
  { intros z Hz. apply number_integer; [exact eq_refl | lia | exact Hz]. }
  rewrite P51 in *. set (s := (x + 3 * (IZR (2 ^ 51) * b))%R) in *. apply Rabs_le_inv in B.
  (* the sum has 53 bits down to the unit *)
  assert (S : exists z, fl s = (IZR z * b)%R /\ 2 ^ 52 <= z <= 2 ^ 53).
  { assert (R : (bpow radix2 (unit + 52) <= Rabs s)%R).
    { replace (unit + 52) with (1 + (unit + 51)) by lia. rewrite bpow_plus, P51.
      change (bpow radix2 1) with 2%R. unfold s. rewrite Rabs_pos_eq; lra. }
    assert (C : (- (IZR (2 ^ 53) * b) <= fl s <= IZR (2 ^ 53) * b)%R).
    { apply Rabs_le_inv. apply (rnd_abs_below 53 (-1074) nearest).
      - apply Whole. lia.
      - apply Rabs_le. change (2 ^ 53) with (4 * 2 ^ 51). rewrite mult_IZR. unfold s. lra. }
    assert (D : (IZR (2 ^ 52) * b <= fl s)%R).
    { apply (rnd_above 53 (-1074) nearest); [apply Whole; lia |].
      change (2 ^ 52) with (2 * 2 ^ 51). rewrite mult_IZR. unfold s. lra. }
    assert (N : double (fl s)) by (apply rnd_number; auto with typeclass_instances).
    assert (G : exists z, fl s = (IZR z * b)%R).
    { unfold Format.number, generic_format in N. rewrite N. unfold F2R. simpl.
      set (m := Ztrunc _). set (c := cexp radix2 (FLT_exp (-1074) 53) (fl s)).
      assert (K : unit <= c).
      { unfold c, cexp, FLT_exp. apply Z.le_trans with (mag radix2 (fl s) - 53); [| lia].
        assert (unit + 53 <= mag radix2 (fl s)); [| lia]. apply mag_ge_bpow.
        replace (unit + 53 - 1) with (unit + 52) by lia.
        apply rnd_abs_above; auto with typeclass_instances. apply number_power; [exact eq_refl | lia]. }
      exists (m * 2 ^ (c - unit)). rewrite mult_IZR. change 2 with (radix_val radix2).
      rewrite IZR_Zpower by lia. unfold b. rewrite Rmult_assoc, <- bpow_plus. f_equal. f_equal. lia. }
    destruct G as [z G]. exists z. split; auto. rewrite G in C, D. split.
    - apply le_IZR. apply Rmult_le_reg_r with b; auto.
    - apply le_IZR. apply Rmult_le_reg_r with b; auto. lra. }
  destruct S as (z & Ez & Z). exists (z - 3 * 2 ^ 51). split; [lia |].
  rewrite <- H, Ez. replace (IZR z * b - 3 * (IZR (2 ^ 51) * b))%R with (IZR (z - 3 * 2 ^ 51) * b)%R.
  - apply rnd_exact; auto with typeclass_instances. apply Whole. lia.
  - rewrite minus_IZR, mult_IZR. ring.
Qed.
