(** Static filters (include/errbound/filters/static_filter.hpp): for every expression of coordinates, differences of
    coordinates, whole constants (ints, rounded in shorter formats), sums, differences, products and negations, to
    nearest. k is the number of roundings and S the size of an expression, as that file counts them. Formats have eta
    <= u eps (every IEEE format) and 64 (k + 2) u <= 1 (k up to 2^18 - 2 in float). A sum has at most 2^p products.
    Results:
        filter_error   |value - exact| <= ((1 + u)^k - 1) S
        filter_bound   |unrounded value - exact| <= bound, the code's bound(), from two roundings on
        filter_sign_certain   the certain sign of the code is right
        size_covers_value     |value| <= size
        overflow_uncertain    also with a largest number: after an overflow no sign is certain *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool Classical_Prop.
From Flocq Require Import Core Plus_error.
From Errbound Require Import Format Sign.
Open Scope R_scope.

Inductive expression :=
| Coordinate (c : R)
| Difference (a b : R)
| Constant (c : Z)
| Sum (x y : expression)
| Minus (x y : expression)
| Product (x y : expression)
| Negation (x : expression).

Section StaticFilter.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.
Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation u := (u p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).

Fixpoint exact (e : expression) : R :=
  match e with
  | Coordinate c => c
  | Difference a b => a - b
  | Constant c => IZR c
  | Sum x y => exact x + exact y
  | Minus x y => exact x - exact y
  | Product x y => exact x * exact y
  | Negation x => - exact x
  end.

(** The code: value, and the counts in the type. *)
Fixpoint value (e : expression) : R :=
  match e with
  | Coordinate c => c
  | Difference a b => fl (a - b)
  | Constant c => fl (IZR c)
  | Sum x y => fl (value x + value y)
  | Minus x y => fl (value x - value y)
  | Product x y => fl (value x * value y)
  | Negation x => - value x
  end.
Fixpoint roundings (e : expression) : nat :=
  match e with
  | Coordinate _ => 0
  | Difference _ _ => 1
  | Constant _ => if (p <? 31)%Z then 1 else 0
  | Sum x y | Minus x y => S (Nat.max (roundings x) (roundings y))
  | Product x y => S (roundings x + roundings y)
  | Negation x => roundings x
  end.
Fixpoint products (e : expression) : nat :=
  match e with
  | Coordinate _ | Difference _ _ | Constant _ => 0
  | Sum x y | Minus x y => products x + products y
  | Product _ _ => 1
  | Negation x => products x
  end.
Fixpoint plain (e : expression) : bool :=
  match e with
  | Coordinate _ | Difference _ _ | Constant _ => true
  | Sum _ _ | Minus _ _ => false
  | Product x y => plain x && plain y && (products x =? 0)%nat && (products y =? 0)%nat
  | Negation x => plain x
  end.

(** tau *)
Definition allowance : R := fl (fl (4 * smallest_normal) / u).
Definition with_allowance (size : R) (n : nat) : R := fl (size + fl (fl (INR n) * allowance)).
Definition full (size : R) (n : nat) : R :=
  match n with O => size | S _ => with_allowance size n end.
Fixpoint size (e : expression) : R :=
  match e with
  | Coordinate c => Rabs c
  | Difference a b => Rabs (fl (a - b))
  | Constant c => Rabs (fl (IZR c))
  | Sum x y | Minus x y => fl (size x + size y)
  | Product x y =>
      if plain (Product x y) then Rabs (fl (value x * value y))
      else fl (full (size x) (products x) * full (size y) (products y))
  | Negation x => size x
  end.
Definition filter_constant (k : nat) : R :=
  fl (fl (fl (INR k) * u) * fl (1 + fl (fl (INR (4 * k + 8)) * u))).
Definition bound (e : expression) : R :=
  match roundings e with
  | O | 1%nat => 0
  | S k => fl (filter_constant k * with_allowance (size e) (Nat.max 1 (products e)))
  end.
Definition filter_sign (e : expression) : sign :=
  if Rlt_bool (bound e) (Rabs (value e)) then
    if Rlt_bool 0 (value e) then positive else negative
  else if (roundings e <=? 1)%nat && (products e =? 0)%nat && Req_bool (value e) 0 then zero
  else uncertain.

(** Hypotheses on an expression: coordinates are numbers, constants ints, and no sum has more products than integers
    are exact. *)
Fixpoint admissible (e : expression) : Prop :=
  (Z.of_nat (products e) <= 2 ^ p)%Z /\
  match e with
  | Coordinate c => number c
  | Difference a b => number a /\ number b
  | Constant c => (Z.abs c <= 2 ^ 31)%Z
  | Sum x y | Minus x y | Product x y => admissible x /\ admissible y
  | Negation x => admissible x
  end.

(** The size in exact arithmetic: every term positive, and tau for each product. *)
Fixpoint exact_size (e : expression) : R :=
  match e with
  | Coordinate c => Rabs c
  | Difference a b => Rabs (fl (a - b))
  | Constant c => Rabs (fl (IZR c))
  | Sum x y | Minus x y => exact_size x + exact_size y
  | Product x y => exact_size x * exact_size y + allowance
  | Negation x => exact_size x
  end.

Context (p_2 : (2 <= p)%Z) (emin_p : (emin <= 1 - 2 * p)%Z).

Let an_error := rounding_error_nearest p emin ltac:(lia).
Let rnd_exact := Format.rnd_exact p emin nearest.
Let rnd_number := Format.rnd_number p emin nearest.
Let rnd_above := Format.rnd_above p emin nearest.
Let rnd_nonnegative := Format.rnd_nonnegative p emin nearest.
Let sum_error := Format.sum_error p emin nearest _ _ an_error.

Lemma u_small : 0 < u <= / 4.
Proof. generalize (u_positive p) (eps_le p 2 p_2) (eps_2u p). simpl. lra. Qed.

Lemma fl_opp x : fl (- x) = - fl x.
Proof. apply round_NE_opp. Qed.

Lemma allowance_exact : allowance = bpow radix2 (emin + 2 * p + 1).
Proof.
  unfold allowance. rewrite (rnd_exact (4 * smallest_normal)).
  - replace (4 * smallest_normal / u) with (bpow radix2 (emin + 2 * p + 1)).
    + apply rnd_exact, number_power; auto. lia.
    + unfold Rdiv, Format.u, Format.smallest_normal. rewrite <- bpow_opp.
      change 4 with (bpow radix2 2). rewrite <- !bpow_plus. f_equal. lia.
  - unfold Format.smallest_normal. change 4 with (bpow radix2 2). rewrite <- bpow_plus.
    apply number_power; auto. lia.
Qed.
Lemma allowance_positive : 0 < allowance.
Proof. rewrite allowance_exact. apply bpow_gt_0. Qed.
Lemma number_allowance : number allowance.
Proof. apply rnd_number. Qed.
(** u tau is a normal number, larger than any loss by underflow. *)
Lemma u_allowance : smallest_normal <= u * allowance.
Proof.
  rewrite allowance_exact. unfold Format.u. rewrite <- bpow_plus. apply bpow_le. lia.
Qed.
Lemma u_allowance_eta : eta / 2 <= u * allowance.
Proof.
  generalize u_allowance (eta_le_smallest_normal p emin) (eta_positive emin). lra.
Qed.

(** One rounding of a product has an error of u of it, or u tau. *)
Lemma product_error x : Rabs (fl x - x) <= u * Rabs x + eta / 2.
Proof.
  generalize u_small (eta_positive emin) (Rabs_pos x); intros.
  destruct (Rlt_or_le (Rabs x) smallest_normal) as [C | C].
  - generalize (error_absolute _ _ _ _ _ an_error x C). nra.
  - generalize (error_relative _ _ _ _ _ an_error x C). lra.
Qed.
(** The error in units of the result. *)
Lemma sum_error_of_result x y :
  number x -> number y -> Rabs (fl (x + y) - (x + y)) <= u * Rabs (fl (x + y)).
Proof. apply (sum_relative_to_result p emin). Qed.
Lemma sum_upper x y : number x -> number y -> 0 <= x + y -> x + y <= (1 + u) * fl (x + y).
Proof.
  intros X Y P. generalize (sum_error_of_result x y X Y). intros H.
  rewrite (Rabs_pos_eq (fl _)) in H by now apply rnd_nonnegative.
  apply Rabs_le_inv in H. lra.
Qed.
Lemma normal_upper x : smallest_normal <= x -> x <= (1 + u) * fl x.
Proof.
  intros C. generalize (smallest_normal_positive p emin); intros.
  assert (A : Rabs x = x) by (apply Rabs_pos_eq; lra).
  generalize (nearest_relative_to_result p emin x). rewrite A. intros H1. specialize (H1 C).
  unfold rnd_nearest in H1.
  rewrite (Rabs_pos_eq (fl _)) in H1 by (apply rnd_nonnegative; lra).
  apply Rabs_le_inv in H1. lra.
Qed.

(** A whole constant, as the code counts its rounding. *)
Lemma constant_rounds (c : Z) :
  (Z.abs c <= 2 ^ 31)%Z -> (31 <= p)%Z -> fl (IZR c) = IZR c.
Proof.
  intros C P. apply rnd_exact. rewrite <- (Rmult_1_r (IZR c)). change 1 with (bpow radix2 0).
  apply number_integer; auto; try lia. apply Z.le_trans with (1 := C).
  now apply Z.pow_le_mono_r.
Qed.
Lemma constant_normal (c : Z) : c <> 0%Z -> smallest_normal <= Rabs (IZR c).
Proof.
  intros C. apply Rle_trans with 1.
  - change 1 with (bpow radix2 0). apply bpow_le. lia.
  - rewrite <- abs_IZR. apply IZR_le. lia.
Qed.
Lemma constant_error (c : Z) : Rabs (fl (IZR c) - IZR c) <= u * Rabs (fl (IZR c)).
Proof.
  destruct (Z.eq_dec c 0) as [-> | C].
  - rewrite (rnd_0 p emin nearest). replace (0 - 0) with 0 by ring. rewrite Rabs_R0. lra.
  - now apply nearest_relative_to_result, constant_normal.
Qed.
Lemma constant_zero (c : Z) : fl (IZR c) = 0 -> c = 0%Z.
Proof.
  intros H. destruct (Z.eq_dec c 0) as [| C]; auto.
  generalize (rnd_abs_above p emin nearest _ _ (number_smallest_normal p emin)
                (constant_normal c C)) (smallest_normal_positive p emin).
  rewrite H, Rabs_R0. lra.
Qed.

Definition power (n : nat) : R := (1 + u) ^ n.
Lemma power_1 n : 1 <= power n.
Proof. apply pow_R1_Rle. generalize u_small. lra. Qed.
Lemma power_succ n : power (S n) = (1 + u) * power n.
Proof. reflexivity. Qed.
Lemma power_plus m n : power (m + n) = power m * power n.
Proof. apply pow_add. Qed.
Lemma power_le m n : (m <= n)%nat -> power m <= power n.
Proof. apply Rle_pow. generalize u_small. lra. Qed.

Lemma value_number e : admissible e -> number (value e).
Proof.
  induction e; simpl; intros [_ H]; try apply rnd_number; auto. now apply number_opp, IHe.
Qed.
Lemma size_number e : admissible e -> number (size e).
Proof.
  induction e as [c | a b | c | | | x ? y ? | ]; intros [_ H]; try apply rnd_number; auto.
  - now apply number_abs.
  - apply number_abs, rnd_number.
  - apply number_abs, rnd_number.
  - simpl. destruct (plain x && _ && _ && _).
    + apply number_abs, rnd_number.
    + apply rnd_number.
Qed.
Lemma exact_size_nonnegative e : 0 <= exact_size e.
Proof.
  generalize allowance_positive; intros.
  induction e; simpl; auto using Rabs_pos; try lra. nra.
Qed.

(** Two numbers with errors of at most (A - 1) S and (B - 1) T and sizes of at most A S and B T: their exact product
    has an error of at most (A B - 1) S T. *)
Lemma opposite a x : a * x <= 0 -> Rabs a + Rabs x <= Rabs (a - x).
Proof. intros H. unfold Rabs. repeat destruct Rcase_abs; nra. Qed.
Lemma alike a x low high :
  0 <= a * x -> low <= Rabs a <= high -> low <= Rabs x <= high -> Rabs (a - x) <= high - low.
Proof. intros H. unfold Rabs. repeat destruct Rcase_abs; nra. Qed.

Lemma product_of_errors a x A S b y B T :
  1 <= A -> 1 <= B -> 0 <= S -> 0 <= T ->
  Rabs a <= A * S -> Rabs x <= A * S -> Rabs (a - x) <= (A - 1) * S ->
  Rabs b <= B * T -> Rabs y <= B * T -> Rabs (b - y) <= (B - 1) * T ->
  Rabs (a * b - x * y) <= (A * B - 1) * (S * T).
Proof.
  intros HA HB PS PT Ha Hx Hax Hb Hy Hby.
  generalize (Rabs_pos a) (Rabs_pos x) (Rabs_pos b) (Rabs_pos y) (Rabs_pos (a - x))
    (Rabs_pos (b - y)); intros.
  (* two ways to split the difference *)
  assert (W1 : Rabs (a * b - x * y) <= Rabs (a - x) * Rabs b + Rabs x * Rabs (b - y)).
  { replace (a * b - x * y) with ((a - x) * b + x * (b - y)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult. lra. }
  assert (W2 : Rabs (a * b - x * y) <= Rabs (a - x) * Rabs y + Rabs a * Rabs (b - y)).
  { replace (a * b - x * y) with ((a - x) * y + a * (b - y)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult. lra. }
  assert (M : forall c d C D, 0 <= c -> 0 <= d -> c <= C -> d <= D -> c * d <= C * D).
  { intros. apply Rmult_le_compat; auto. }
  destruct (Rle_or_lt (Rabs x) S) as [Cx | Cx]; [nra |].
  destruct (Rle_or_lt (Rabs b) T) as [Cb | Cb]; [nra |].
  destruct (Rle_or_lt (Rabs y) T) as [Cy | Cy]; [nra |].
  destruct (Rle_or_lt (Rabs a) S) as [Ca | Ca]; [nra |].
  (* all are larger than their sizes *)
  assert (W3 : Rabs (a * b - x * y) <= Rabs a * Rabs b + Rabs x * Rabs y).
  { rewrite <- !Rabs_mult. unfold Rminus.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra. }
  destruct (Rle_or_lt (a * x) 0) as [Sx | Sx].
  { apply opposite in Sx. apply Rle_trans with (1 := W3).
    generalize (M (Rabs a + Rabs x) (B * T) ((A - 1) * S) (B * T) ltac:(lra) ltac:(lra)
                  ltac:(lra) ltac:(lra))
      (M (Rabs a) (Rabs b) (Rabs a) (B * T) ltac:(lra) ltac:(lra) ltac:(lra) Hb)
      (M (Rabs x) (Rabs y) (Rabs x) (B * T) ltac:(lra) ltac:(lra) ltac:(lra) Hy). nra. }
  destruct (Rle_or_lt (b * y) 0) as [Sy | Sy].
  { apply opposite in Sy. apply Rle_trans with (1 := W3).
    generalize (M (A * S) (Rabs b + Rabs y) (A * S) ((B - 1) * T) ltac:(lra) ltac:(lra)
                  ltac:(lra) ltac:(lra))
      (M (Rabs a) (Rabs b) (A * S) (Rabs b) ltac:(lra) ltac:(lra) Ha ltac:(lra))
      (M (Rabs x) (Rabs y) (A * S) (Rabs y) ltac:(lra) ltac:(lra) Hx ltac:(lra)). nra. }
  replace ((A * B - 1) * (S * T)) with (A * S * (B * T) - S * T) by ring.
  apply alike.
  - replace (a * b * (x * y)) with (a * x * (b * y)) by ring. apply Rmult_le_pos; lra.
  - rewrite Rabs_mult. split; apply M; lra.
  - rewrite Rabs_mult. split; apply M; lra.
Qed.

(** The invariant of every number of an expression, E = (1 + u)^k. *)
Definition near (v x E S : R) : Prop :=
  Rabs (v - x) <= (E - 1) * S /\ Rabs v <= E * S /\ Rabs x <= E * S.

Lemma near_weaker v x E F S : E <= F -> 0 <= S -> near v x E S -> near v x F S.
Proof. intros L P (H1 & H2 & H3). unfold near. repeat split; nra. Qed.
Lemma near_opp v x E S : near v x E S -> near (- v) (- x) E S.
Proof.
  unfold near. rewrite !Rabs_Ropp. replace (- v - - x) with (- (v - x)) by ring.
  now rewrite Rabs_Ropp.
Qed.
Lemma near_sum v x S w y T E :
  near v x E S -> near w y E T -> near (v + w) (x + y) E (S + T).
Proof.
  intros (H1 & H2 & H3) (G1 & G2 & G3). unfold near. repeat split.
  - replace (v + w - (x + y)) with ((v - x) + (w - y)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra.
  - apply Rle_trans with (1 := Rabs_triang _ _). lra.
  - apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.
Lemma near_product v x S w y T E F :
  1 <= E -> 1 <= F -> 0 <= S -> 0 <= T ->
  near v x E S -> near w y F T -> near (v * w) (x * y) (E * F) (S * T).
Proof.
  intros HE HF HS HT (H1 & H2 & H3) (G1 & G2 & G3). unfold near. repeat split.
  - now apply product_of_errors.
  - rewrite Rabs_mult. replace (E * F * (S * T)) with (E * S * (F * T)) by ring.
    apply Rmult_le_compat; auto using Rabs_pos.
  - rewrite Rabs_mult. replace (E * F * (S * T)) with (E * S * (F * T)) by ring.
    apply Rmult_le_compat; auto using Rabs_pos.
Qed.
(** One more rounding, with d for underflow. *)
Lemma near_rounded w x E S d :
  1 <= E -> 0 <= S -> 0 <= d -> Rabs (fl w - w) <= u * Rabs w + u * d ->
  near w x E S -> near (fl w) x ((1 + u) * E) (S + d).
Proof.
  intros HE HS Hd HR (H1 & H2 & H3). generalize u_small; intros U.
  assert (A : u * Rabs w <= u * (E * S)) by (apply Rmult_le_compat_l; lra).
  assert (0 <= E * d) by (apply Rmult_le_pos; lra).
  assert (D : d <= E * d) by nra.
  assert (0 <= u * (E * d)) by (apply Rmult_le_pos; lra).
  assert (u * d <= u * (E * d)) by (apply Rmult_le_compat_l; lra).
  assert (0 <= E * S) by (apply Rmult_le_pos; lra).
  assert (0 <= u * (E * S)) by (apply Rmult_le_pos; lra).
  unfold near. repeat split.
  - replace (fl w - x) with ((fl w - w) + (w - x)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra.
  - replace (fl w) with ((fl w - w) + w) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra.
  - apply Rle_trans with (1 := H3). lra.
Qed.

(** The exact result of the last operation. *)
Fixpoint unrounded (e : expression) : R :=
  match e with
  | Coordinate c => c
  | Difference a b => a - b
  | Constant c => IZR c
  | Sum x y => value x + value y
  | Minus x y => value x - value y
  | Product x y => value x * value y
  | Negation x => - unrounded x
  end.
Lemma value_rounds e : admissible e -> value e = fl (unrounded e).
Proof.
  induction e; simpl; intros [_ H]; auto.
  - now rewrite rnd_exact.
  - now rewrite fl_opp, IHe.
Qed.

Lemma expression_near e : admissible e ->
  near (value e) (exact e) (power (roundings e)) (exact_size e) /\
  Rabs (unrounded e - exact e) <= (power (Nat.pred (roundings e)) - 1) * exact_size e.
Proof.
  generalize allowance_positive u_small; intros T U.
  assert (Once : forall z, Rabs (fl z - z) <= u * Rabs (fl z) ->
    near (fl z) z (power 1) (Rabs (fl z)) /\ Rabs (z - z) <= (power 0 - 1) * Rabs (fl z)).
  { intros z D. unfold near, power. simpl. replace (z - z) with 0 by ring. rewrite Rabs_R0.
    assert (X : Rabs z <= (1 + u) * Rabs (fl z)).
    { replace z with (fl z - (fl z - z)) at 1 by ring.
      unfold Rminus at 1. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra. }
    generalize (Rabs_pos (fl z)). intros.
    assert (0 <= u * Rabs (fl z)) by (apply Rmult_le_pos; lra). repeat split; lra. }
  assert (Never : forall z, near z z (power 0) (Rabs z) /\ Rabs (z - z) <= (power 0 - 1) * Rabs z).
  { intros z. unfold near, power. simpl. replace (z - z) with 0 by ring. rewrite Rabs_R0.
    generalize (Rabs_pos z). lra. }
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx]; simpl;
    intros [_ H].
  - apply Never.
  - destruct H as [A B]. apply Once.
    apply (sum_error_of_result a (- b) A (number_opp _ _ _ B)).
  - destruct (Z.ltb_spec p 31) as [C | C].
    + apply Once, constant_error.
    + rewrite constant_rounds by auto. apply Never.
  - destruct H as [A B]. destruct (IHx A) as [NX _], (IHy B) as [NY _].
    set (m := Nat.max (roundings x) (roundings y)).
    assert (N : near (value x + value y) (exact x + exact y) (power m)
                  (exact_size x + exact_size y)).
    { apply near_sum.
      - apply near_weaker with (3 := NX); [apply power_le; lia | apply exact_size_nonnegative].
      - apply near_weaker with (3 := NY); [apply power_le; lia | apply exact_size_nonnegative]. }
    split; [| apply N]. rewrite power_succ. rewrite <- (Rplus_0_r (exact_size x + exact_size y)).
    generalize (exact_size_nonnegative x) (exact_size_nonnegative y). intros.
    apply near_rounded; auto using power_1; try lra.
    rewrite Rmult_0_r, Rplus_0_r. apply sum_error; now apply value_number.
  - destruct H as [A B]. destruct (IHx A) as [NX _], (IHy B) as [NY _].
    set (m := Nat.max (roundings x) (roundings y)).
    assert (N : near (value x - value y) (exact x - exact y) (power m)
                  (exact_size x + exact_size y)).
    { apply near_sum.
      - apply near_weaker with (3 := NX); [apply power_le; lia | apply exact_size_nonnegative].
      - apply near_opp.
        apply near_weaker with (3 := NY); [apply power_le; lia | apply exact_size_nonnegative]. }
    split; [| apply N]. rewrite power_succ. rewrite <- (Rplus_0_r (exact_size x + exact_size y)).
    generalize (exact_size_nonnegative x) (exact_size_nonnegative y). intros.
    apply near_rounded; auto using power_1; try lra.
    rewrite Rmult_0_r, Rplus_0_r. apply sum_error; [| apply number_opp]; now apply value_number.
  - destruct H as [A B]. destruct (IHx A) as [NX _], (IHy B) as [NY _].
    generalize (exact_size_nonnegative x) (exact_size_nonnegative y). intros.
    assert (N : near (value x * value y) (exact x * exact y) (power (roundings x + roundings y))
                  (exact_size x * exact_size y)).
    { rewrite power_plus. apply near_product; auto using power_1. }
    assert (0 <= exact_size x * exact_size y) by (apply Rmult_le_pos; auto).
    split.
    + rewrite power_succ. apply near_rounded; auto using power_1; try lra.
      generalize (product_error (value x * value y)) u_allowance_eta. lra.
    + apply Rle_trans with (1 := proj1 N).
      generalize (power_1 (roundings x + roundings y)). intros P1.
      apply Rmult_le_compat_l; lra.
  - destruct (IHx H) as [N1 N2]. split; [now apply near_opp |].
    replace (- unrounded x - - exact x) with (- (unrounded x - exact x)) by ring.
    now rewrite Rabs_Ropp.
Qed.

Theorem filter_error e : admissible e ->
  Rabs (value e - exact e) <= ((1 + u) ^ roundings e - 1) * exact_size e.
Proof. intros H. apply (proj1 (expression_near e H)). Qed.

(** Computed sizes: power (path e) covers their roundings. *)
Definition over (n : nat) : nat := Nat.min 1 n.
Fixpoint path (e : expression) : nat :=
  match e with
  | Coordinate _ | Difference _ _ | Constant _ => 0
  | Sum x y | Minus x y => S (Nat.max (path x) (path y))
  | Product x y => S (path x + over (products x) + (path y + over (products y)))
  | Negation x => path x
  end.
Lemma path_roundings e : (path e + over (products e) <= 2 * roundings e)%nat.
Proof. induction e; cbn [path products roundings]; unfold over in *; lia. Qed.

Lemma plain_size e : plain e = true -> products e = O -> size e = Rabs (value e).
Proof.
  induction e; simpl; try discriminate; auto.
  intros. rewrite Rabs_Ropp. auto.
Qed.
Lemma size_product x y :
  size (Product x y) = fl (full (size x) (products x) * full (size y) (products y)).
Proof.
  cbn [size]. destruct (plain (Product x y)) eqn:P; auto. simpl in P.
  apply andb_prop in P. destruct P as [P Y0]. apply andb_prop in P. destruct P as [P X0].
  apply andb_prop in P. destruct P as [PX PY].
  apply Nat.eqb_eq in X0, Y0. rewrite X0, Y0. unfold full.
  rewrite (plain_size x PX X0), (plain_size y PY Y0), <- Rabs_mult. symmetry.
  apply round_NE_abs. auto with typeclass_instances.
Qed.

Lemma number_count n : (Z.of_nat n <= 2 ^ p)%Z -> number (INR n).
Proof.
  intros H. rewrite INR_IZR_INZ, <- (Rmult_1_r (IZR _)). change 1 with (bpow radix2 0).
  apply number_integer; auto; lia.
Qed.
Lemma counted_allowance n :
  (Z.of_nat n <= 2 ^ p)%Z -> fl (fl (INR n) * allowance) = INR n * allowance.
Proof.
  intros H. rewrite (rnd_exact (INR n)) by now apply number_count. apply rnd_exact.
  rewrite INR_IZR_INZ, allowance_exact. apply number_integer; auto; lia.
Qed.
Lemma with_allowance_covers s n :
  number s -> 0 <= s -> (Z.of_nat n <= 2 ^ p)%Z ->
  s + INR n * allowance <= (1 + u) * with_allowance s n.
Proof.
  intros N P C. unfold with_allowance. generalize allowance_positive (pos_INR n); intros.
  assert (0 <= INR n * allowance) by (apply Rmult_le_pos; lra).
  rewrite <- (counted_allowance n C) in *. apply sum_upper; auto. lra.
Qed.
Lemma full_covers s n :
  number s -> 0 <= s -> (Z.of_nat n <= 2 ^ p)%Z ->
  s + INR n * allowance <= power (over n) * full s n.
Proof.
  intros N P C. destruct n as [| n].
  - unfold power, over. simpl. lra.
  - generalize (with_allowance_covers s (S n) N P C). unfold power, over, full.
    change (Nat.min 1 (S n)) with 1%nat. rewrite pow_1. auto.
Qed.

Lemma admissible_products e : admissible e -> (Z.of_nat (products e) <= 2 ^ p)%Z.
Proof. destruct e; now intros []. Qed.
Lemma size_nonnegative e : admissible e -> 0 <= size e.
Proof.
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx]; intros A;
    try apply Rabs_pos.
  - simpl in *. apply rnd_nonnegative. destruct A as (_ & A & B).
    generalize (IHx A) (IHy B). lra.
  - simpl in *. apply rnd_nonnegative. destruct A as (_ & A & B).
    generalize (IHx A) (IHy B). lra.
  - rewrite size_product. apply rnd_nonnegative. destruct A as (_ & A & B).
    assert (F : forall s n, 0 <= s -> 0 <= full s n).
    { intros s [| n] Ps; auto. apply rnd_nonnegative.
      assert (0 <= fl (fl (INR (S n)) * allowance)); [| lra].
      apply rnd_nonnegative. apply Rmult_le_pos; [| generalize allowance_positive; lra].
      apply rnd_nonnegative, pos_INR. }
    apply Rmult_le_pos; apply F; auto.
  - apply IHx, A.
Qed.

Lemma size_covered e : admissible e ->
  exact_size e <= power (path e) * (size e + INR (products e) * allowance).
Proof.
  generalize allowance_positive u_small; intros T U.
  assert (Sum : forall x y, admissible x -> admissible y ->
    exact_size x <= power (path x) * (size x + INR (products x) * allowance) ->
    exact_size y <= power (path y) * (size y + INR (products y) * allowance) ->
    exact_size x + exact_size y <=
      power (S (Nat.max (path x) (path y))) * (fl (size x + size y) + INR (products x + products y) * allowance)).
  { intros x y A B. generalize (size_nonnegative x A) (size_nonnegative y B)
      (sum_upper _ _ (size_number x A) (size_number y B)).
    intros PX PY G CX CY. specialize (G ltac:(lra)).
    rewrite plus_INR. set (m := Nat.max (path x) (path y)).
    generalize (pos_INR (products x)) (pos_INR (products y)); intros.
    assert (0 <= INR (products x) * allowance) by (apply Rmult_le_pos; lra).
    assert (0 <= INR (products y) * allowance) by (apply Rmult_le_pos; lra).
    assert (LX : power (path x) <= power m) by (apply power_le; lia).
    assert (LY : power (path y) <= power m) by (apply power_le; lia).
    rewrite power_succ. generalize (power_1 m). intros P1.
    apply Rle_trans with (power m * (size x + size y + (INR (products x) + INR (products y)) * allowance)).
    + nra.
    + replace ((1 + u) * power m) with (power m * (1 + u)) by ring. rewrite Rmult_assoc.
      apply Rmult_le_compat_l; [lra |]. nra. }
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx]; intros A;
    try (unfold power; simpl; lra).
  - destruct A as (_ & A & B). exact (Sum x y A B (IHx A) (IHy B)).
  - destruct A as (_ & A & B). exact (Sum x y A B (IHx A) (IHy B)).
  - rewrite size_product. cbn [exact_size path products]. destruct A as (_ & A & B).
    generalize (size_nonnegative x A) (size_nonnegative y B). intros PX PY.
    generalize (full_covers _ _ (size_number x A) PX (admissible_products x A))
      (full_covers _ _ (size_number y B) PY (admissible_products y B)).
    set (fx := full (size x) (products x)). set (fy := full (size y) (products y)).
    intros FX FY.
    assert (CX : exact_size x <= power (path x + over (products x)) * fx).
    { apply Rle_trans with (1 := IHx A). rewrite power_plus, Rmult_assoc.
      apply Rmult_le_compat_l; auto. generalize (power_1 (path x)). lra. }
    assert (CY : exact_size y <= power (path y + over (products y)) * fy).
    { apply Rle_trans with (1 := IHy B). rewrite power_plus, Rmult_assoc.
      apply Rmult_le_compat_l; auto. generalize (power_1 (path y)). lra. }
    set (i := (path x + over (products x))%nat) in *.
    set (j := (path y + over (products y))%nat) in *.
    assert (CZ : exact_size x * exact_size y <= power (i + j) * (fx * fy)).
    { rewrite power_plus.
      replace (power i * power j * (fx * fy)) with (power i * fx * (power j * fy)) by ring.
      apply Rmult_le_compat; auto using exact_size_nonnegative. }
    generalize (exact_size_nonnegative x) (exact_size_nonnegative y). intros.
    generalize (power_1 i) (power_1 j) (power_1 (i + j)). intros P1 P2 P3.
    assert (Pfx : 0 <= fx) by nra. assert (Pfy : 0 <= fy) by nra.
    assert (Pz : 0 <= fx * fy) by (apply Rmult_le_pos; auto).
    change (INR 1) with 1. rewrite Rmult_1_l, power_succ.
    set (P := power (i + j)) in *. set (z := fx * fy) in *.
    assert (0 <= P * allowance) by (apply Rmult_le_pos; lra).
    assert (0 <= u * (P * allowance)) by (apply Rmult_le_pos; lra).
    assert (allowance <= P * allowance) by nra.
    destruct (Rlt_or_le z smallest_normal) as [C | C].
    + assert (Z : z <= fl z + eta / 2).
      { generalize (rnd_absolute p emin nearest _ _ an_error z Pz C). lra. }
      assert (Pfz : 0 <= fl z) by now apply rnd_nonnegative.
      assert (P * z <= P * (fl z + eta / 2)) by (apply Rmult_le_compat_l; lra).
      assert (P * (eta / 2) <= P * (u * allowance)).
      { apply Rmult_le_compat_l; [lra | apply u_allowance_eta]. }
      assert (0 <= u * (P * fl z)) by (apply Rmult_le_pos; [| apply Rmult_le_pos]; lra).
      lra.
    + generalize (normal_upper z C). intros Z.
      assert (P * z <= P * ((1 + u) * fl z)) by (apply Rmult_le_compat_l; lra). lra.
  - apply IHx, A.
Qed.

(** The constant. *)
Lemma small_count n : INR n * u <= 1 -> (Z.of_nat n <= 2 ^ p)%Z.
Proof.
  intros H. apply le_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
  rewrite <- INR_IZR_INZ. apply Rmult_le_reg_r with u; [apply u_small |].
  unfold Format.u at 2. rewrite <- bpow_plus. replace (p + - p)%Z with 0%Z by lia. exact H.
Qed.
Lemma number_count_u n : (Z.of_nat n <= 2 ^ p)%Z -> number (INR n * u).
Proof. intros H. rewrite INR_IZR_INZ. apply number_integer; auto; lia. Qed.

Lemma INR_linear a b n : INR (a * n + b) = INR a * INR n + INR b.
Proof. now rewrite plus_INR, mult_INR. Qed.
Lemma constant_enough n : 64 * INR (n + 3) * u <= 1 ->
  (power n - 1) * power (2 * n + 6) <= INR n * u * (1 + INR (4 * n + 8) * u).
Proof.
  intros H. generalize u_small (pos_INR n); intros U Pn.
  generalize (power_quadratic u n) (power_quadratic u (2 * n + 6)).
  fold (power n) (power (2 * n + 6)).
  replace (INR (2 * n + 6) * u) with (2 * (INR n * u) + 6 * u)
    by (rewrite INR_linear; simpl; ring).
  replace (INR (4 * n + 8) * u) with (4 * (INR n * u) + 8 * u)
    by (rewrite INR_linear; simpl; ring).
  replace (64 * INR (n + 3) * u) with (64 * (INR n * u + 3 * u)) in H
    by (rewrite plus_INR; simpl; ring).
  assert (Pt : 0 <= INR n * u) by (apply Rmult_le_pos; lra).
  generalize (power_1 n) (power_1 (2 * n + 6)).
  generalize dependent (INR n * u). generalize (power n) (power (2 * n + 6)).
  intros A B t H Pt PA PB HA HB. specialize (HA ltac:(lra) ltac:(lra)).
  specialize (HB ltac:(lra) ltac:(lra)).
  assert (Y : exists y, y = 2 * t + 6 * u) by (eexists; reflexivity).
  destruct Y as [y Y]. rewrite <- Y in HB.
  assert (YY : y * y <= y / 32) by nra.
  apply Rle_trans with ((t + t * t) * (1 + y + y / 32)).
  - apply Rmult_le_compat; lra.
  - nra.
Qed.

Lemma filter_constant_lower n : (1 <= n)%nat -> 64 * INR (n + 3) * u <= 1 ->
  INR n * u * (1 + INR (4 * n + 8) * u) <= (1 + u) * (1 + u) * filter_constant n /\
  u <= filter_constant n.
Proof.
  intros N1 H. generalize u_small (pos_INR n); intros U Pn.
  assert (H1 : INR n * u <= 1 /\ INR (4 * n + 8) * u <= 1).
  { rewrite plus_INR in H. rewrite plus_INR, mult_INR. simpl INR in *. split; nra. }
  destruct H1 as [S1 S2]. apply small_count in S1, S2.
  unfold filter_constant.
  rewrite (rnd_exact (INR n)), (rnd_exact (INR n * u)), (rnd_exact (INR (4 * n + 8))),
    (rnd_exact (INR (4 * n + 8) * u)) by (apply number_count || apply number_count_u; auto).
  assert (N0 : number 1).
  { change 1 with (bpow radix2 0). apply number_power; auto. lia. }
  assert (Pk : 0 <= INR (4 * n + 8) * u) by (apply Rmult_le_pos; [apply pos_INR | lra]).
  assert (A : 1 <= fl (1 + INR (4 * n + 8) * u)) by (apply rnd_above; auto; lra).
  generalize (sum_upper 1 _ N0 (number_count_u _ S2) ltac:(lra)). intros B.
  set (c := fl (1 + INR (4 * n + 8) * u)) in *.
  assert (L : 1 <= INR n) by (change 1 with (INR 1); now apply le_INR).
  assert (Lu : u <= INR n * u).
  { rewrite <- (Rmult_1_l u) at 1. apply Rmult_le_compat_r; lra. }
  assert (C : u <= INR n * u * c).
  { apply Rle_trans with (1 := Lu). rewrite <- (Rmult_1_r (INR n * u)) at 1.
    apply Rmult_le_compat_l; lra. }
  split.
  - assert (M : smallest_normal <= INR n * u * c).
    { apply Rle_trans with (2 := C). apply bpow_le. lia. }
    generalize (normal_upper _ M). intros D.
    assert (INR n * u * (1 + INR (4 * n + 8) * u) <= INR n * u * ((1 + u) * c)).
    { apply Rmult_le_compat_l; lra. }
    assert ((1 + u) * (INR n * u * c) <= (1 + u) * ((1 + u) * fl (INR n * u * c))).
    { apply Rmult_le_compat_l; lra. }
    lra.
  - apply rnd_above; auto. apply number_power; auto. lia.
Qed.

Theorem filter_bound e : admissible e -> 64 * INR (roundings e + 2) * u <= 1 ->
  Rabs (unrounded e - exact e) <= bound e.
Proof.
  intros A H. generalize (proj2 (expression_near e A)). unfold bound.
  destruct (roundings e) as [| [| n]] eqn:K; simpl Nat.pred; intros N.
  - apply Rle_trans with (1 := N). unfold power. simpl. lra.
  - apply Rle_trans with (1 := N). unfold power. simpl. lra.
  - replace (S (S n) + 2)%nat with (S n + 3)%nat in H by lia.
    set (m := S n) in *. generalize u_small allowance_positive; intros U T.
    destruct (filter_constant_lower m ltac:(lia) H) as [C1 C2].
    set (C := filter_constant m) in *.
    set (P := Nat.max 1 (products e)). set (s := with_allowance (size e) P).
    assert (CP : (Z.of_nat P <= 2 ^ p)%Z).
    { generalize (admissible_products e A). unfold P.
      assert (1 <= 2 ^ p)%Z by (apply (Z.pow_le_mono_r 2 0); lia). lia. }
    generalize (size_nonnegative e A). intros Ps.
    generalize (with_allowance_covers _ P (size_number e A) Ps CP). fold s. intros W.
    (* the size *)
    assert (S1 : exact_size e <= power (2 * m + 3) * s).
    { apply Rle_trans with (1 := size_covered e A).
      replace (2 * m + 3)%nat with (S (2 * S m)) by lia. rewrite power_succ.
      replace ((1 + u) * power (2 * S m) * s) with (power (2 * S m) * ((1 + u) * s)) by ring.
      generalize (path_roundings e). rewrite K. fold m. intros L.
      generalize (power_1 (path e)) (pos_INR (products e)). intros.
      apply Rmult_le_compat; try lra.
      - assert (0 <= INR (products e) * allowance) by (apply Rmult_le_pos; lra). lra.
      - apply power_le. lia.
      - apply Rle_trans with (2 := W). apply Rplus_le_compat_l, Rmult_le_compat_r; [lra |].
        apply le_INR. lia. }
    (* the bound, a normal number *)
    assert (Ts : allowance <= s).
    { apply rnd_above; auto using number_allowance. rewrite (counted_allowance P CP).
      assert (1 <= INR P) by (change 1 with (INR 1); apply le_INR; lia). nra. }
    assert (M : smallest_normal <= C * s).
    { apply Rle_trans with (1 := u_allowance). apply Rmult_le_compat; lra. }
    generalize (normal_upper _ M). intros B.
    (* together *)
    generalize (constant_enough m H) (power_1 m) (power_1 (2 * m + 3)). intros G P1 P3.
    apply Rle_trans with (1 := N).
    apply Rle_trans with ((power m - 1) * (power (2 * m + 3) * s)).
    { apply Rmult_le_compat_l; lra. }
    replace (2 * m + 6)%nat with (2 * m + 3 + 3)%nat in G by lia.
    rewrite power_plus in G. change (power 3) with ((1 + u) * ((1 + u) * ((1 + u) * 1))) in G.
    set (Q := power (2 * m + 3)) in *. set (D := power m - 1) in *.
    apply Rmult_le_reg_l with ((1 + u) * ((1 + u) * (1 + u))).
    { repeat apply Rmult_lt_0_compat; lra. }
    apply Rle_trans with (INR m * u * (1 + INR (4 * m + 8) * u) * s); [nra |].
    apply Rle_trans with ((1 + u) * (1 + u) * C * s).
    { apply Rmult_le_compat_r; lra. }
    replace ((1 + u) * (1 + u) * C * s) with ((1 + u) * (1 + u) * (C * s)) by ring.
    replace ((1 + u) * ((1 + u) * (1 + u)) * fl (C * s))
      with ((1 + u) * (1 + u) * ((1 + u) * fl (C * s))) by ring.
    apply Rmult_le_compat_l; auto. apply Rmult_le_pos; lra.
Qed.

Lemma bound_number e : number (bound e).
Proof.
  unfold bound. destruct (roundings e) as [| []]; apply number_0 || apply rnd_number.
Qed.

Lemma zero_unrounded e : admissible e -> products e = O -> value e = 0 -> unrounded e = 0.
Proof.
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx]; simpl;
    intros [_ H] P; auto.
  - destruct H as [A B]. intros Z. unfold Rminus in *.
    apply round_plus_eq_0 in Z; auto with typeclass_instances. now apply number_opp.
  - intros Z. apply IZR_eq. now apply constant_zero.
  - destruct H as [A B]. intros Z.
    apply round_plus_eq_0 in Z; auto with typeclass_instances; now apply value_number.
  - destruct H as [A B]. intros Z. unfold Rminus in *.
    apply round_plus_eq_0 in Z; auto with typeclass_instances.
    + now apply value_number.
    + now apply number_opp, value_number.
  - discriminate.
  - intros Z. rewrite IHx; auto; lra.
Qed.

Theorem filter_sign_certain e : admissible e -> 64 * INR (roundings e + 2) * u <= 1 ->
  sign_is_right (filter_sign e) (exact e).
Proof.
  intros A H. generalize (filter_bound e A H). intros B. apply Rabs_le_inv in B.
  unfold filter_sign.
  destruct (Rlt_bool_spec (bound e) (Rabs (value e))) as [L | L].
  - rewrite (value_rounds e A) in *.
    assert (W : bound e < Rabs (unrounded e)).
    { apply Rnot_le_lt. intros C.
      apply (rnd_abs_below p emin nearest) in C; [lra | apply bound_number]. }
    destruct (Rlt_bool_spec 0 (fl (unrounded e))) as [S | S]; simpl.
    + assert (0 < unrounded e).
      { apply Rnot_le_lt. intros C.
        apply (rnd_below p emin nearest _ 0) in C; [lra | apply number_0]. }
      rewrite Rabs_pos_eq in W; lra.
    + assert (unrounded e < 0).
      { apply Rnot_le_lt. intros C. apply rnd_nonnegative in C.
        assert (Z : fl (unrounded e) = 0) by lra. rewrite Z, Rabs_R0 in L.
        assert (0 <= bound e); [| lra].
        apply Rle_trans with (2 := filter_bound e A H). apply Rabs_pos. }
      rewrite Rabs_left in W; lra.
  - destruct ((roundings e <=? 1)%nat && (products e =? 0)%nat) eqn:F; simpl; auto.
    destruct (Req_bool_spec (value e) 0) as [Z | Z]; simpl; auto.
    apply andb_prop in F. destruct F as [F1 F2]. apply Nat.leb_le in F1. apply Nat.eqb_eq in F2.
    apply zero_unrounded in Z; auto. rewrite Z in B.
    unfold bound in B. destruct (roundings e) as [| []]; try lra. lia.
Qed.

(** Overflow. For every operation of the value there is one of the size that is no smaller. *)
Lemma fl_abs x : Rabs (fl x) = fl (Rabs x).
Proof. symmetry. apply round_NE_abs. auto with typeclass_instances. Qed.
Lemma full_above s n : 0 <= s -> number s -> s <= full s n.
Proof.
  intros P N. destruct n as [| n]; [apply Rle_refl |]. apply rnd_above; auto.
  assert (0 <= fl (fl (INR (S n)) * allowance)); [| lra]. apply rnd_nonnegative.
  apply Rmult_le_pos; [apply rnd_nonnegative, pos_INR | generalize allowance_positive; lra].
Qed.
Theorem size_covers_value e : admissible e -> Rabs (value e) <= size e.
Proof.
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx]; intros A;
    try apply Rle_refl.
  - destruct A as (_ & A & B). cbn [value size]. rewrite fl_abs. apply (rnd_le p emin nearest).
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat; auto.
  - destruct A as (_ & A & B). cbn [value size]. rewrite fl_abs. apply (rnd_le p emin nearest).
    unfold Rminus. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. apply Rplus_le_compat; auto.
  - rewrite size_product. destruct A as (_ & A & B). cbn [value]. rewrite fl_abs, Rabs_mult.
    apply (rnd_le p emin nearest). apply Rmult_le_compat; auto using Rabs_pos.
    + apply Rle_trans with (1 := IHx A). apply full_above; auto using size_nonnegative, size_number.
    + apply Rle_trans with (1 := IHy B). apply full_above; auto using size_nonnegative, size_number.
  - destruct A as [_ A]. cbn [value size]. rewrite Rabs_Ropp. auto.
Qed.

Section Overflow.

(** The format's largest number: rounding to nearest gives an infinity if the result without it would exceed it.
    Operations +, - and * on infinities and NaN give one of them. *)
Context (largest : R) (largest_0 : 0 <= largest).
Definition in_range (x : R) : Prop := Rabs x <= largest.

(** No operation of the value overflows, or of the size. *)
Fixpoint value_in_range (e : expression) : Prop :=
  in_range (value e) /\
  match e with
  | Coordinate _ | Difference _ _ | Constant _ => True
  | Sum x y | Minus x y | Product x y => value_in_range x /\ value_in_range y
  | Negation x => value_in_range x
  end.
Fixpoint size_in_range (e : expression) : Prop :=
  in_range (size e) /\
  match e with
  | Coordinate _ | Difference _ _ | Constant _ => True
  | Sum x y | Minus x y => size_in_range x /\ size_in_range y
  | Product x y =>
      if plain (Product x y) then value_in_range (Product x y)
      else (size_in_range x /\ in_range (full (size x) (products x))) /\
           (size_in_range y /\ in_range (full (size y) (products y)))
  | Negation x => size_in_range x
  end.
Lemma size_range_value e : admissible e -> size_in_range e -> value_in_range e.
Proof.
  assert (L : forall e, admissible e -> in_range (size e) -> in_range (value e)).
  { intros x A. unfold in_range. generalize (size_covers_value x A) (size_nonnegative x A).
    intros C P. rewrite (Rabs_pos_eq (size x)) by auto. lra. }
  induction e as [c | a b | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx]; intros A R;
    (split; [apply L; [exact A | apply R] |]); auto.
  - destruct A as (_ & A & B), R as (_ & R & S). auto.
  - destruct A as (_ & A & B), R as (_ & R & S). auto.
  - destruct R as [_ R]. cbn [size_in_range] in R. destruct (plain (Product x y)).
    + apply R.
    + destruct A as (_ & A & B), R as ((R & _) & (S & _)). auto.
  - destruct A as [_ A], R as [_ R]. auto.
Qed.

(** sign_of with machine numbers: it tests for a finite value if the bound does not. *)
Definition not_finite (v : ieee) : Prop := v = plus_infinity \/ v = minus_infinity \/ v = nan.
Definition magnitude (v : ieee) : ieee :=
  match v with
  | finite x => finite (Rabs x)
  | plus_infinity | minus_infinity => plus_infinity
  | nan => nan
  end.
Definition is_finite (v : ieee) : bool := match v with finite _ => true | _ => false end.
Definition machine_sign (e : expression) (v b : ieee) : sign :=
  if less b (magnitude v) && ((1 <? roundings e)%nat || is_finite v) then
    if less (finite 0) v then positive else negative
  else if (roundings e <=? 1)%nat && (products e =? 0)%nat && equals_0 v then zero
  else uncertain.

Theorem overflow_uncertain e v b : admissible e -> 64 * INR (roundings e + 2) * u <= 1 ->
  (value_in_range e -> v = finite (value e)) -> (~ value_in_range e -> not_finite v) ->
  ((roundings e <= 1)%nat \/ size_in_range e -> in_range (bound e) -> b = finite (bound e)) ->
  (~ ((roundings e <= 1)%nat \/ size_in_range e) \/ ~ in_range (bound e) ->
   b = plus_infinity \/ b = nan) ->
  sign_is_right (machine_sign e v b) (exact e).
Proof.
  intros A H V V' D D'. generalize (filter_sign_certain e A H). unfold filter_sign, machine_sign.
  destruct (classic (value_in_range e)) as [F | F].
  - rewrite (V F). cbn [magnitude is_finite equals_0]. rewrite orb_true_r, andb_true_r.
    destruct (classic (((roundings e <= 1)%nat \/ size_in_range e) /\ in_range (bound e))) as [[I J] | I].
    + rewrite (D I J). auto.
    + intros _. assert (K : (roundings e <=? 1)%nat = false).
      { apply Nat.leb_gt, Nat.nle_gt. intros K. apply I. split; auto. unfold in_range, bound.
        destruct (roundings e) as [| []]; try lia; now rewrite Rabs_R0. }
      rewrite K. apply not_and_or in I. destruct (D' I) as [-> | ->]; exact Logic.I.
  - intros _. specialize (V' F). assert (E : equals_0 v = false).
    { destruct V' as [-> | [-> | ->]]; reflexivity. }
    rewrite E, andb_false_r. assert (I : is_finite v = false).
    { destruct V' as [-> | [-> | ->]]; reflexivity. }
    rewrite I, orb_false_r. destruct (Nat.ltb_spec 1 (roundings e)) as [K | K].
    + assert (N : ~ size_in_range e) by (intros S; now apply F, size_range_value).
      destruct D' as [-> | ->]; [left; intros [C |]; [lia | auto] | destruct v; exact Logic.I ..].
    + rewrite andb_false_r. exact Logic.I.
Qed.

End Overflow.
End StaticFilter.
