(** The error-counting scalar (include/errbound/filters/error_count.hpp): its counts, in floating point, bound the
    error of every expression, rounded in any direction.

    eps is the largest relative error of a rounding in any direction, eta the smallest positive number. An expression
    has a unit (for a product that of its factors' sizes, for a sum the larger one) and a degree in its inputs. W >=
    1 is at least every input's size. Results, for counts far from 1/eta:
        count_sound    |value| <= magnitude unit + underflow eta W^(degree - 1),
                       |value - exact| <= error eps unit + underflow eta W^(degree - 1)
        count_height   no count exceeds 2^height, a number that depends on the expression's shape *)

From Coq Require Import Reals ZArith Lia Lra Psatz.
From Flocq Require Import Core.
From Errbound Require Import Format.
Open Scope R_scope.

(** Inputs come with M, a bound on their computed sizes; constants are whole. Converted is a converted difference of
    longer numbers (RoundedAxes.v, converted_difference_near). *)
Inductive counted :=
| Exact (x M : R)
| Difference (a b M : R)
| Constant (c : Z)
| Sum (x y : counted)
| Minus (x y : counted)
| Product (x y : counted)
| Negation (x : counted)
| Converted (computed x M : R).

Fixpoint exact (e : counted) : R :=
  match e with
  | Exact x _ => x
  | Difference a b _ => a - b
  | Constant c => IZR c
  | Sum x y => exact x + exact y
  | Minus x y => exact x - exact y
  | Product x y => exact x * exact y
  | Negation x => - exact x
  | Converted _ x _ => x
  end.
Fixpoint unit (e : counted) : R :=
  match e with
  | Exact _ M | Difference _ _ M | Converted _ _ M => M
  | Constant _ => 1
  | Sum x y | Minus x y => Rmax (unit x) (unit y)
  | Product x y => unit x * unit y
  | Negation x => unit x
  end.
Fixpoint degree (e : counted) : nat :=
  match e with
  | Exact _ _ | Difference _ _ _ | Converted _ _ _ => 1
  | Constant _ => 0
  | Sum x y | Minus x y => Nat.max (degree x) (degree y)
  | Product x y => degree x + degree y
  | Negation x => degree x
  end.
Fixpoint height (e : counted) : nat :=
  match e with
  | Exact _ _ | Difference _ _ _ | Converted _ _ _ => 0
  | Constant c => Z.to_nat (Z.log2_up (Z.abs c))
  | Sum x y | Minus x y => 4 + Nat.max (height x) (height y)
  | Product x y => 4 + (height x + height y)
  | Negation x => height x
  end.

Section ErrorCount.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation fl := (rnd p emin direction).
(** Counts are rounded to nearest, since the compiler computes them. *)
Notation flc := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation u := (u p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).

(** The code. *)
Fixpoint value (e : counted) : R :=
  match e with
  | Exact x _ => x
  | Difference a b _ => fl (a - b)
  | Constant c => IZR c
  | Sum x y => fl (value x + value y)
  | Minus x y => fl (value x - value y)
  | Product x y => fl (value x * value y)
  | Negation x => - value x
  | Converted computed _ _ => computed
  end.

Record error_count := { magnitude : R; error : R; underflow : R }.
Definition rounded (count : R) : R := flc (count * flc (1 + flc (16 * eps))).
Definition count_sum (a b : error_count) : error_count :=
  let m := rounded (flc (magnitude a + magnitude b)) in
  {| magnitude := m;
     error := rounded (flc (flc (error a + error b) + m));
     underflow := rounded (flc (underflow a + underflow b)) |}.
Definition count_product (a b : error_count) : error_count :=
  let m := rounded (flc (magnitude a * magnitude b)) in
  {| magnitude := m;
     error := rounded (flc (flc (flc (flc (magnitude a * error b) + flc (error a * magnitude b)) +
                                 flc (flc (error a * error b) * eps)) + m));
     underflow :=
       rounded (flc (flc (flc (flc (magnitude a * underflow b) + flc (underflow a * magnitude b)) +
                          flc (flc (flc (error a * underflow b) + flc (underflow a * error b)) *
                               flc (2 * eps))) + 2)) |}.
Fixpoint count (e : counted) : error_count :=
  match e with
  | Exact _ _ => {| magnitude := 1; error := 0; underflow := 0 |}
  | Difference _ _ _ => {| magnitude := 1; error := 1; underflow := 0 |}
  | Constant c => {| magnitude := Rabs (IZR c); error := 0; underflow := 0 |}
  | Sum x y | Minus x y => count_sum (count x) (count y)
  | Product x y => count_product (count x) (count y)
  | Negation x => count x
  | Converted _ _ _ => {| magnitude := 1; error := 1; underflow := 1 |}
  end.

Context (W : R) (W_1 : 1 <= W).

(** Inputs are numbers within their bounds, constants are nonzero numbers, and there is no product of constants. *)
Fixpoint admissible (e : counted) : Prop :=
  match e with
  | Exact x M => number x /\ Rabs x <= M <= W
  | Difference a b M => number a /\ number b /\ Rabs (fl (a - b)) <= M <= W
  | Constant c => number (IZR c) /\ c <> 0%Z
  | Sum x y | Minus x y => admissible x /\ admissible y
  | Product x y => admissible x /\ admissible y /\ (1 <= degree x + degree y)%nat
  | Negation x => admissible x
  | Converted computed x M =>
      number computed /\ Rabs computed <= M <= W /\ Rabs (computed - x) <= eps * Rabs computed + eta
  end.

Context (p_10 : (10 <= p)%Z) (emin_p : (emin <= 1 - 2 * p)%Z).

Lemma nearest_error : rounding_error p emin nearest u (eta / 2).
Proof. apply rounding_error_nearest; auto. lia. Qed.
Lemma any_error : rounding_error p emin direction eps eta.
Proof. apply rounding_error_any; auto. lia. Qed.

Lemma u_small : 0 < u <= / 1024.
Proof.
  split; [apply u_positive |]. replace (/ 1024) with (bpow radix2 (- 10)) by (simpl; lra).
  apply bpow_le. lia.
Qed.
Lemma eps_small : 0 < eps <= / 512.
Proof. generalize u_small (eps_2u p). lra. Qed.

(** c is a number with c >= (1 - u)^j x: at least x computed with j roundings. Counts are zero or at least eps, so
    they do not underflow. *)
Definition shrunk (j : nat) : R := (1 - u) ^ j.
Lemma shrunk_positive j : 0 < shrunk j <= 1.
Proof.
  unfold shrunk. generalize u_small; intros. split; [apply pow_lt; lra |].
  apply Rle_trans with (1 ^ j); [apply pow_incr; lra | rewrite pow1; lra].
Qed.
Lemma shrunk_le i j : (i <= j)%nat -> shrunk j <= shrunk i.
Proof.
  intros L. unfold shrunk. replace j with (i + (j - i))%nat by lia. rewrite pow_add.
  fold (shrunk i) (shrunk (j - i)). generalize (shrunk_positive i) (shrunk_positive (j - i)). nra.
Qed.
Definition covers (j : nat) (c x : R) : Prop :=
  number c /\ (c = 0 \/ eps <= c) /\ 0 <= x /\ shrunk j * x <= c.

Lemma covers_more i j c x : (i <= j)%nat -> covers i c x -> covers j c x.
Proof.
  intros L (N & Z & P & H). repeat split; auto. apply Rle_trans with (2 := H).
  apply Rmult_le_compat_r; auto. now apply shrunk_le.
Qed.
Lemma covers_itself c : number c -> c = 0 \/ eps <= c -> covers 0 c c.
Proof.
  intros N Z. generalize eps_small; intros. repeat split; auto; unfold shrunk; simpl; lra.
Qed.
Lemma number_eps : number eps.
Proof. apply number_power; auto. lia. Qed.
Lemma covers_sum i c x d y :
  covers i c x -> covers i d y -> covers (S i) (flc (c + d)) (x + y).
Proof.
  intros (Nc & Zc & Pc & C) (Nd & Zd & Pd & D). generalize eps_small u_small; intros.
  assert (0 <= c) by lra. assert (0 <= d) by lra.
  repeat split; try lra.
  - apply rnd_number; auto with typeclass_instances.
  - destruct Zc as [-> | Zc], Zd as [-> | Zd].
    1: left; rewrite Rplus_0_l; apply rnd_0; auto with typeclass_instances.
    all: right; apply rnd_above; auto using number_eps with typeclass_instances; lra.
  - generalize (sum_relative p emin nearest _ _ nearest_error c d Nc Nd ltac:(lra) ltac:(lra)).
    unfold shrunk in *. rewrite <- tech_pow_Rmult. nra.
Qed.
Lemma covers_scaled i c x d y :
  covers i c x -> number d -> 0 <= y <= d -> (c * d = 0 \/ eps <= c * d) ->
  covers (S i) (flc (c * d)) (x * y).
Proof.
  intros (Nc & Zc & Pc & C) Nd Hy P. generalize eps_small u_small (shrunk_positive i); intros.
  assert (0 <= c) by lra. assert (0 <= x * y) by nra.
  assert (L : shrunk i * (x * y) <= c * d).
  { rewrite <- Rmult_assoc. apply Rmult_le_compat; try lra. apply Rmult_le_pos; lra. }
  repeat split; auto.
  - apply rnd_number; auto with typeclass_instances.
  - destruct P as [-> | P]; [left; apply rnd_0; auto with typeclass_instances | right].
    apply rnd_above; auto using number_eps with typeclass_instances.
  - unfold shrunk. rewrite <- tech_pow_Rmult. fold (shrunk i).
    apply Rle_trans with ((c * d) * (1 - u)); [nra |].
    destruct P as [-> | P].
    + rewrite (rnd_0 p emin nearest). lra.
    + apply (rnd_relative p emin nearest u (eta / 2) nearest_error).
      apply Rle_trans with (2 := P). apply bpow_le. lia.
Qed.

Lemma growth_exact : flc (1 + flc (16 * eps)) = 1 + 16 * eps.
Proof.
  assert (E : 16 * eps = bpow radix2 (5 - p)).
  { unfold Format.eps. change 16 with (bpow radix2 4). rewrite <- bpow_plus. f_equal. lia. }
  rewrite (rnd_exact p emin nearest (16 * eps)).
  - apply rnd_exact; auto with typeclass_instances. rewrite E.
    replace (1 + bpow radix2 (5 - p)) with (IZR (2 ^ (p - 5) + 1) * bpow radix2 (5 - p)).
    + apply number_integer; auto; try lia. rewrite Z.abs_eq.
      * apply Z.le_trans with (2 ^ (p - 5) + 2 ^ (p - 5))%Z.
        -- generalize (Z.pow_le_mono_r 2 0 (p - 5)). lia.
        -- replace (2 ^ (p - 5) + 2 ^ (p - 5))%Z with (2 ^ 1 * 2 ^ (p - 5))%Z by lia.
           rewrite <- Z.pow_add_r by lia. apply Z.pow_le_mono_r; lia.
      * generalize (Z.pow_nonneg 2 (p - 5)). lia.
    + rewrite plus_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
      rewrite Rmult_plus_distr_r, <- bpow_plus. replace (p - 5 + (5 - p))%Z with 0%Z by lia.
      simpl. lra.
  - rewrite E. apply number_power; auto. lia.
Qed.
Lemma number_growth : number (1 + 16 * eps).
Proof. rewrite <- growth_exact. apply rnd_number; auto with typeclass_instances. Qed.

(** `rounded` covers six roundings and one of the counted value. *)
Lemma rounded_covers i c x : (i <= 6)%nat -> covers i c x ->
  number (rounded c) /\ 0 <= x /\ (1 + eps) * x <= rounded c /\ c <= rounded c.
Proof.
  intros I H. generalize H. intros (Nc & Zc & Pc & _). generalize eps_small u_small; intros.
  unfold rounded. rewrite growth_exact.
  apply (covers_more i 6) in H; auto.
  assert (G : covers 7 (flc (c * (1 + 16 * eps))) (x * (1 + 16 * eps))).
  { apply covers_scaled; auto using number_growth; try lra.
    destruct Zc as [-> | Zc]; [left; ring | right; nra]. }
  destruct G as (N & _ & _ & G). repeat split; auto.
  - apply Rle_trans with (2 := G). rewrite (eps_2u p).
    assert (L : 1 - 7 * u <= shrunk 7).
    { unfold shrunk. generalize (u_positive p). intros.
      assert (B : forall n, 1 - INR n * u <= (1 - u) ^ n).
      { induction n as [| n IH]; [simpl; lra |]. rewrite <- tech_pow_Rmult, S_INR.
        generalize (pos_INR n). nra. }
      generalize (B 7%nat). simpl INR. lra. }
    assert (F : 1 + 2 * u <= (1 - 7 * u) * (1 + 16 * (2 * u))) by nra.
    apply Rle_trans with ((1 - 7 * u) * (1 + 16 * (2 * u)) * x).
    + apply Rmult_le_compat_r; auto.
    + replace (shrunk 7 * (x * (1 + 16 * (2 * u)))) with (shrunk 7 * (1 + 16 * (2 * u)) * x) by ring.
      apply Rmult_le_compat_r; auto. apply Rmult_le_compat_r; lra.
  - apply rnd_above; auto with typeclass_instances. nra.
Qed.

(** Properties of counts. *)
Definition proper (c : error_count) : Prop :=
  number (magnitude c) /\ number (error c) /\ number (underflow c) /\ 1 <= magnitude c /\
  (error c = 0 \/ 1 <= error c) /\ (underflow c = 0 \/ 1 <= underflow c).

Lemma number_1 : number 1.
Proof. change 1 with (bpow radix2 0). apply number_power; auto. lia. Qed.
Lemma number_2 : number 2.
Proof. change 2 with (bpow radix2 1). apply number_power; auto. lia. Qed.
Lemma covers_count c : number c -> c = 0 \/ 1 <= c -> covers 0 c c.
Proof. intros N Z. apply covers_itself; auto. generalize eps_small. lra. Qed.
Lemma covers_product c d : number c -> number d -> c = 0 \/ 1 <= c -> d = 0 \/ 1 <= d ->
  covers 1 (flc (c * d)) (c * d).
Proof.
  intros Nc Nd Zc Zd. apply covers_scaled; auto using covers_count; try lra.
  generalize eps_small; intros. destruct Zc as [-> | Zc], Zd as [-> | Zd]; try (left; ring).
  right. nra.
Qed.

Lemma sum_proper a b : proper a -> proper b -> proper (count_sum a b) /\
  (1 + eps) * (magnitude a + magnitude b) <= magnitude (count_sum a b) /\
  error a + error b + (magnitude a + magnitude b) <= error (count_sum a b) /\
  (1 + eps) * (underflow a + underflow b) <= underflow (count_sum a b).
Proof.
  intros (Na & Oa & Va & Ma & Ea & Ua) (Nb & Ob & Vb & Mb & Eb & Ub).
  generalize eps_small; intros P.
  destruct (rounded_covers 1 _ _ ltac:(lia)
              (covers_sum 0 _ _ _ _ (covers_count _ Na ltac:(lra)) (covers_count _ Nb ltac:(lra))))
    as (N1 & _ & H1 & _).
  set (m := rounded (flc (magnitude a + magnitude b))) in *.
  assert (M1 : 1 <= m) by nra.
  destruct (rounded_covers 2 _ _ ltac:(lia)
              (covers_sum 1 _ _ _ _
                 (covers_sum 0 _ _ _ _ (covers_count _ Oa Ea) (covers_count _ Ob Eb))
                 (covers_more 0 1 _ _ ltac:(lia) (covers_count m N1 ltac:(lra)))))
    as (N2 & _ & H2 & _).
  destruct (rounded_covers 1 _ _ ltac:(lia)
              (covers_sum 0 _ _ _ _ (covers_count _ Va Ua) (covers_count _ Vb Ub)))
    as (N3 & P3 & H3 & C3).
  unfold count_sum. fold m. cbn [magnitude error underflow].
  assert (0 <= error a + error b) by lra.
  set (er := rounded (flc (flc (error a + error b) + m))) in *.
  assert (0 <= eps * (error a + error b + m)) by (apply Rmult_le_pos; lra).
  split; [repeat split | repeat split; assumption || lra || nra]; auto.
  - right. simpl. lra.
  - simpl. assert (L : underflow a + underflow b <= rounded (flc (underflow a + underflow b))).
    { assert (0 <= eps * (underflow a + underflow b)) by (apply Rmult_le_pos; lra). lra. }
    destruct Ua as [Ua | Ua], Ub as [Ub | Ub]; [left | right; lra ..].
    unfold rounded. rewrite Ua, Ub, Rplus_0_l, (rnd_0 p emin nearest), Rmult_0_l.
    apply rnd_0. auto with typeclass_instances.
Qed.

Lemma product_proper a b : proper a -> proper b -> proper (count_product a b) /\
  (1 + eps) * (magnitude a * magnitude b) <= magnitude (count_product a b) /\
  magnitude a * error b + error a * magnitude b + error a * error b * eps +
    magnitude a * magnitude b <= error (count_product a b) /\
  (1 + eps) * (magnitude a * underflow b + underflow a * magnitude b +
    (error a * underflow b + underflow a * error b) * (2 * eps) + 2) <=
    underflow (count_product a b).
Proof.
  intros (Na & Oa & Va & Ma & Ea & Ua) (Nb & Ob & Vb & Mb & Eb & Ub).
  generalize eps_small; intros P.
  destruct (rounded_covers 1 _ _ ltac:(lia)
              (covers_product _ _ Na Nb ltac:(lra) ltac:(lra))) as (N1 & _ & H1 & _).
  set (m := rounded (flc (magnitude a * magnitude b))) in *.
  assert (M0 : 1 <= magnitude a * magnitude b) by nra. assert (M1 : 1 <= m) by nra.
  assert (Small : forall x, x = 0 \/ 1 <= x -> forall e, eps <= e -> x * e = 0 \/ eps <= x * e).
  { intros x [-> | X] e E; [left; ring | right; nra]. }
  assert (One : forall c d, c = 0 \/ 1 <= c -> d = 0 \/ 1 <= d ->
                  flc (c * d) = 0 \/ 1 <= flc (c * d)).
  { intros c d [-> | C] [-> | D]; try (left; rewrite ?Rmult_0_l, ?Rmult_0_r;
      apply rnd_0; auto with typeclass_instances).
    right. apply rnd_above; auto using number_1 with typeclass_instances. nra. }
  destruct (rounded_covers 4 _ _ ltac:(lia)
    (covers_sum 3 _ _ _ _
       (covers_sum 2 _ _ _ _
          (covers_sum 1 _ _ _ _ (covers_product _ _ Na Ob ltac:(lra) Eb)
                                (covers_product _ _ Oa Nb Ea ltac:(lra)))
          (covers_scaled 1 _ _ eps eps (covers_product _ _ Oa Ob Ea Eb) number_eps ltac:(lra)
             (Small _ (One _ _ Ea Eb) eps ltac:(lra))))
       (covers_more 0 3 _ _ ltac:(lia) (covers_count m N1 ltac:(lra)))))
    as (N2 & P2 & H2 & _).
  assert (E2 : flc (2 * eps) = 2 * eps).
  { apply rnd_exact; auto with typeclass_instances.
    replace (2 * eps) with (bpow radix2 (2 - p)).
    - apply number_power; auto. lia.
    - unfold Format.eps. replace (2 - p)%Z with (1 + (1 - p))%Z by lia. now rewrite bpow_plus. }
  assert (OneSum : forall c d, c = 0 \/ 1 <= c -> d = 0 \/ 1 <= d ->
                     flc (c + d) = 0 \/ 1 <= flc (c + d)).
  { intros c d [-> | C] [-> | D].
    1: left; rewrite Rplus_0_l; apply rnd_0; auto with typeclass_instances.
    all: right; apply rnd_above; auto using number_1 with typeclass_instances; lra. }
  assert (N2e : number (flc (2 * eps))) by (apply rnd_number; auto with typeclass_instances).
  destruct (rounded_covers 5 _ _ ltac:(lia)
    (covers_sum 4 _ _ _ _
       (covers_sum 3 _ _ _ _
          (covers_more 2 3 _ _ ltac:(lia)
             (covers_sum 1 _ _ _ _ (covers_product _ _ Na Vb ltac:(lra) Ub)
                                   (covers_product _ _ Va Nb Ua ltac:(lra))))
          (covers_scaled 2 _ _ (flc (2 * eps)) (2 * eps)
             (covers_sum 1 _ _ _ _ (covers_product _ _ Oa Vb Ea Ub)
                                   (covers_product _ _ Va Ob Ua Eb))
             N2e ltac:(rewrite E2; lra)
             (Small _ (OneSum _ _ (One _ _ Ea Ub) (One _ _ Ua Eb)) (flc (2 * eps))
                ltac:(rewrite E2; lra))))
       (covers_more 0 4 _ _ ltac:(lia) (covers_count 2 number_2 ltac:(lra)))))
    as (N3 & P3 & H3 & _).
  unfold count_product. fold m. cbn [magnitude error underflow].
  assert (Pos : forall c d, c = 0 \/ 1 <= c -> d = 0 \/ 1 <= d -> 0 <= c * d).
  { intros. apply Rmult_le_pos; lra. }
  generalize (Pos _ _ (or_intror Ma) Eb) (Pos _ _ Ea (or_intror Mb)) (Pos _ _ Ea Eb)
    (Pos _ _ (or_intror Ma) Ub) (Pos _ _ Ua (or_intror Mb)) (Pos _ _ Ea Ub) (Pos _ _ Ua Eb).
  intros A1 A2 A3 A4 A5 A6 A7.
  assert (A8 : 0 <= (error a * underflow b + underflow a * error b) * (2 * eps))
    by (apply Rmult_le_pos; lra).
  assert (A9 : 0 <= error a * error b * eps) by (apply Rmult_le_pos; lra).
  assert (0 <= eps * (magnitude a * error b + error a * magnitude b + error a * error b * eps + m))
    by (apply Rmult_le_pos; lra).
  assert (0 <= eps * (magnitude a * underflow b + underflow a * magnitude b +
    (error a * underflow b + underflow a * error b) * (2 * eps) + 2)) by (apply Rmult_le_pos; lra).
  repeat split; auto; try (right; cbn [magnitude error underflow]; lra || nra).
  - fold m. lra || nra.
Qed.

Lemma constant_1 c : c <> 0%Z -> 1 <= Rabs (IZR c).
Proof. intros H. rewrite <- abs_IZR. apply IZR_le. lia. Qed.
Lemma count_proper e : admissible e -> proper (count e).
Proof.
  generalize number_1 (number_0 p emin); intros N1 N0.
  induction e as [x M | a b M | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx | c x M]; simpl.
  - intros _. repeat split; simpl; auto; lra.
  - intros _. repeat split; simpl; auto; lra.
  - intros [C D]. repeat split; simpl; auto using constant_1. now apply number_abs.
  - intros [A B]. now apply sum_proper; auto.
  - intros [A B]. now apply sum_proper; auto.
  - intros (A & B & _). now apply product_proper; auto.
  - auto.
  - intros _. repeat split; simpl; auto; lra.
Qed.

(** Counts below powers of two. *)
Notation pow2 n := (bpow radix2 (Z.of_nat n)).
Lemma number_pow2 n : number (pow2 n).
Proof. apply number_power; auto. lia. Qed.
Lemma pow2_le m n : (m <= n)%nat -> pow2 m <= pow2 n.
Proof. intros. apply bpow_le. lia. Qed.
Lemma pow2_succ n : pow2 (S n) = 2 * pow2 n.
Proof. rewrite Nat2Z.inj_succ, <- Z.add_1_l. now rewrite bpow_plus. Qed.
Lemma pow2_plus m n : pow2 (m + n) = pow2 m * pow2 n.
Proof. rewrite Nat2Z.inj_add. now rewrite bpow_plus. Qed.
Lemma pow2_1 n : 1 <= pow2 n.
Proof. apply (pow2_le 0). lia. Qed.
Lemma sum_below n c d : c <= pow2 n -> d <= pow2 n -> flc (c + d) <= pow2 (S n).
Proof.
  intros. apply rnd_below; auto using number_pow2 with typeclass_instances. rewrite pow2_succ. lra.
Qed.
Lemma product_below m n c d :
  0 <= c <= pow2 m -> 0 <= d <= pow2 n -> flc (c * d) <= pow2 (m + n).
Proof.
  intros. apply rnd_below; auto using number_pow2 with typeclass_instances. rewrite pow2_plus.
  apply Rmult_le_compat; lra.
Qed.
Lemma rounded_below n c : 0 <= c -> c <= pow2 n -> rounded c <= pow2 (S n).
Proof.
  intros. unfold rounded. rewrite growth_exact. generalize eps_small; intros.
  apply rnd_below; auto using number_pow2 with typeclass_instances. rewrite pow2_succ. nra.
Qed.
Lemma flc_nonnegative x : 0 <= x -> 0 <= flc x.
Proof. apply rnd_nonnegative; auto with typeclass_instances. Qed.

Definition below (n : nat) (c : error_count) : Prop :=
  magnitude c <= pow2 n /\ error c <= pow2 n /\ underflow c <= pow2 n.
Lemma sum_of_counts_below n a b :
  proper a -> proper b -> below n a -> below n b -> below (4 + n) (count_sum a b).
Proof.
  intros (_ & _ & _ & Ma & Ea & Ua) (_ & _ & _ & Mb & Eb & Ub) (A1 & A2 & A3) (B1 & B2 & B3).
  unfold count_sum. set (m := rounded (flc (magnitude a + magnitude b))).
  assert (M : m <= pow2 (S (S n))).
  { apply rounded_below; [apply flc_nonnegative; lra | apply sum_below; auto]. }
  assert (M0 : 0 <= m).
  { apply flc_nonnegative. rewrite growth_exact. generalize eps_small. intros.
    apply Rmult_le_pos; [apply flc_nonnegative |]; lra. }
  assert (L : forall k c, (k <= 4 + n)%nat -> c <= pow2 k -> c <= pow2 (4 + n)).
  { intros k c K C. generalize (pow2_le k (4 + n) K). lra. }
  assert (E : 0 <= flc (error a + error b)) by (apply flc_nonnegative; lra).
  unfold below. cbn [magnitude error underflow]. split; [| split].
  - apply L with (2 := M). lia.
  - apply rounded_below; [apply flc_nonnegative; lra |]. apply sum_below; auto.
    apply Rle_trans with (1 := sum_below n _ _ A2 B2). apply pow2_le. lia.
  - apply L with (S (S n)); [lia |].
    apply rounded_below; [apply flc_nonnegative; lra | apply sum_below; auto].
Qed.
Lemma product_of_counts_below n k a b :
  proper a -> proper b -> below n a -> below k b -> below (4 + (n + k)) (count_product a b).
Proof.
  intros (_ & _ & _ & Ma & Ea & Ua) (_ & _ & _ & Mb & Eb & Ub) (A1 & A2 & A3) (B1 & B2 & B3).
  unfold count_product. set (m := rounded (flc (magnitude a * magnitude b))).
  assert (Q : forall c d, 0 <= c <= pow2 n -> 0 <= d <= pow2 k ->
                0 <= flc (c * d) <= pow2 (n + k)).
  { intros c d C D. split; [apply flc_nonnegative, Rmult_le_pos; lra | now apply product_below]. }
  assert (T : forall j c d, 0 <= c <= pow2 j -> 0 <= d <= pow2 j -> 0 <= flc (c + d) <= pow2 (S j)).
  { intros j c d C D. split; [apply flc_nonnegative; lra | apply sum_below; lra]. }
  assert (F : forall j c e, 0 <= c <= pow2 (S j) -> 0 <= e <= / 2 -> 0 <= flc (c * e) <= pow2 j).
  { intros j c e C D. rewrite pow2_succ in C. split.
    - apply flc_nonnegative, Rmult_le_pos; lra.
    - apply rnd_below; auto using number_pow2 with typeclass_instances. nra. }
  assert (W' : forall i j c, (i <= j)%nat -> 0 <= c <= pow2 i -> 0 <= c <= pow2 j).
  { intros i j c I C. generalize (pow2_le i j I). lra. }
  generalize eps_small; intros P.
  assert (M : 0 <= m <= pow2 (S (n + k))).
  { destruct (Q (magnitude a) (magnitude b)) as [Q1 Q2]; try lra. split.
    - apply flc_nonnegative. rewrite growth_exact. apply Rmult_le_pos; lra.
    - now apply rounded_below. }
  set (s := (n + k)%nat) in *.
  assert (E2 : 0 <= flc (2 * eps) <= / 2).
  { split; [apply flc_nonnegative; lra |]. apply rnd_below; auto with typeclass_instances.
    - replace (/ 2) with (bpow radix2 (- 1)) by (simpl; lra). apply number_power; auto. lia.
    - lra. }
  assert (Two : 0 <= 2 <= pow2 (S (S s))).
  { rewrite pow2_succ. generalize (pow2_1 (S s)). lra. }
  unfold below. cbn [magnitude error underflow]. split; [| split].
  - apply Rle_trans with (1 := proj2 M). apply pow2_le. lia.
  - assert (X : 0 <= flc (flc (flc (flc (magnitude a * error b) + flc (error a * magnitude b)) +
                     flc (flc (error a * error b) * eps)) + m) <= pow2 (S (S (S s)))).
    { apply T; [apply T; [apply T; apply Q; lra |] | apply W' with (2 := M); lia].
      apply W' with s; [lia |]. apply F; [apply W' with s; [lia | apply Q; lra] | lra]. }
    apply rounded_below; apply X.
  - assert (X : 0 <= flc (flc (flc (flc (magnitude a * underflow b) + flc (underflow a * magnitude b)) +
                     flc (flc (flc (error a * underflow b) + flc (underflow a * error b)) *
                          flc (2 * eps))) + 2) <= pow2 (S (S (S s)))).
    { apply T; [apply T; [apply T; apply Q; lra |] | exact Two].
      apply W' with s; [lia |]. apply F; [apply T; apply Q; lra | exact E2]. }
    apply rounded_below; apply X.
Qed.

Lemma below_more m n c : (m <= n)%nat -> below m c -> below n c.
Proof. intros L (H1 & H2 & H3). apply pow2_le in L. unfold below. lra. Qed.
Theorem count_height e : admissible e ->
  magnitude (count e) <= pow2 (height e) /\ error (count e) <= pow2 (height e) /\
  underflow (count e) <= pow2 (height e).
Proof.
  change (admissible e -> below (height e) (count e)).
  induction e as [x M | a b M | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx | c x M];
    cbn [admissible height count].
  4, 5: intros [A B]; apply sum_of_counts_below; auto using count_proper;
    [apply below_more with (2 := IHx A) | apply below_more with (2 := IHy B)]; lia.
  - unfold below. simpl. lra.
  - unfold below. simpl. lra.
  - intros [_ C]. unfold below. cbn [magnitude error underflow].
    generalize (pow2_1 (Z.to_nat (Z.log2_up (Z.abs c)))). intros. split; [| lra].
    rewrite <- abs_IZR. rewrite Z2Nat.id by apply Z.log2_up_nonneg.
    rewrite <- IZR_Zpower by apply Z.log2_up_nonneg. apply IZR_le. simpl (radix_val radix2).
    destruct (Z.eq_dec (Z.abs c) 1) as [-> | D]; [simpl; lia |]. apply Z.log2_up_spec. lia.
  - intros (A & B & _). apply product_of_counts_below; auto using count_proper.
  - auto.
  - unfold below. simpl. lra.
Qed.

(** Soundness. *)
Definition scale (e : counted) : R := W ^ Nat.pred (degree e).
Lemma power_W_1 n : 1 <= W ^ n.
Proof. now apply pow_R1_Rle. Qed.
Lemma power_W_le m n : (m <= n)%nat -> W ^ m <= W ^ n.
Proof. now apply Rle_pow. Qed.
Lemma unit_power e : admissible e -> 0 <= unit e <= W ^ degree e.
Proof.
  induction e as [x M0 | a b M0 | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx | c x M0]; simpl.
  4, 5: intros [A B]; specialize (IHx A); specialize (IHy B);
    generalize (power_W_le _ _ (Nat.le_max_l (degree x) (degree y))) (power_W_le _ _ (Nat.le_max_r (degree x) (degree y)));
    unfold Rmax; destruct Rle_dec; lra.
  - intros [_ H]. generalize (Rabs_pos x). lra.
  - intros (_ & _ & H). generalize (Rabs_pos (fl (a - b))). lra.
  - lra.
  - intros (A & B & _). specialize (IHx A). specialize (IHy B). rewrite pow_add. split.
    + apply Rmult_le_pos; lra.
    + apply Rmult_le_compat; lra.
  - auto.
  - intros (_ & H & _). generalize (Rabs_pos c). lra.
Qed.
Lemma underflow_of_constants e : admissible e -> degree e = O -> underflow (count e) = 0.
Proof.
  assert (Z : rounded (flc (0 + 0)) = 0).
  { unfold rounded. rewrite Rplus_0_l, (rnd_0 p emin nearest), Rmult_0_l.
    apply rnd_0. auto with typeclass_instances. }
  induction e as [x M0 | a b M0 | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx | c x M0]; simpl; auto;
    try discriminate; [.. | intros (_ & _ & L) D; lia]; intros [A B] D; now rewrite IHx, IHy by (auto; lia).
Qed.

(** v is near x: the property of count_sound. *)
Definition near (v x U T : R) (c : error_count) : Prop :=
  Rabs v <= magnitude c * U + underflow c * (eta * T) /\
  Rabs (v - x) <= error c * (eps * U) + underflow c * (eta * T).

Lemma near_sum v w x y a b U V T T' Z S :
  number v -> number w -> proper a -> proper b ->
  0 <= U <= Z -> 0 <= V <= Z -> 0 <= T <= S -> 0 <= T' <= S ->
  near v x U T a -> near w y V T' b -> near (fl (v + w)) (x + y) Z S (count_sum a b).
Proof.
  intros Nv Nw Ca Cb HU HV HT HT' (V1 & V2) (W1 & W2).
  generalize (sum_proper a b Ca Cb). intros (_ & M & E & F).
  destruct Ca as (_ & _ & _ & Ma & Ea & Ua), Cb as (_ & _ & _ & Mb & Eb & Ub).
  generalize eps_small (eta_positive emin); intros P Q.
  assert (Up : forall c d, 0 <= c -> d <= Z -> c * d <= c * Z).
  { intros. apply Rmult_le_compat_l; auto. }
  assert (Upe : forall c d, 0 <= c -> d <= Z -> c * (eps * d) <= c * (eps * Z)).
  { intros. apply Rmult_le_compat_l; auto. apply Rmult_le_compat_l; lra. }
  assert (Down : forall c d, 0 <= c -> d <= S -> c * (eta * d) <= c * (eta * S)).
  { intros. apply Rmult_le_compat_l; auto. apply Rmult_le_compat_l; lra. }
  set (mags := (magnitude a + magnitude b) * Z). set (unders := (underflow a + underflow b) * (eta * S)).
  assert (B : Rabs (v + w) <= mags + unders).
  { apply Rle_trans with (1 := Rabs_triang _ _). unfold mags, unders.
    generalize (Up (magnitude a) U) (Up (magnitude b) V) (Down (underflow a) T)
      (Down (underflow b) T'). lra. }
  assert (D : Rabs (v + w - (x + y)) <= (error a + error b) * (eps * Z) + unders).
  { replace (v + w - (x + y)) with ((v - x) + (w - y)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). unfold unders.
    generalize (Upe (error a) U) (Upe (error b) V) (Down (underflow a) T)
      (Down (underflow b) T'). lra. }
  generalize (sum_error p emin direction _ _ any_error v w Nv Nw). intros R.
  assert (R' : eps * Rabs (v + w) <= eps * (mags + unders)) by (apply Rmult_le_compat_l; lra).
  assert (HZ : 0 <= eta * S) by (apply Rmult_le_pos; lra).
  assert (M' : (1 + eps) * mags <= magnitude (count_sum a b) * Z).
  { unfold mags. rewrite <- Rmult_assoc. apply Rmult_le_compat_r; lra. }
  assert (F' : (1 + eps) * unders <= underflow (count_sum a b) * (eta * S)).
  { unfold unders. rewrite <- Rmult_assoc. apply Rmult_le_compat_r; lra. }
  assert (E' : (error a + error b) * (eps * Z) + eps * mags <= error (count_sum a b) * (eps * Z)).
  { unfold mags. apply Rle_trans with
      ((error a + error b + (magnitude a + magnitude b)) * (eps * Z)).
    - right. ring.
    - apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra. }
  split.
  - replace (fl (v + w)) with ((fl (v + w) - (v + w)) + (v + w)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra.
  - replace (fl (v + w) - (x + y)) with ((fl (v + w) - (v + w)) + (v + w - (x + y))) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.

Lemma product_rounding x : Rabs (fl x - x) <= eps * Rabs x + eta.
Proof.
  generalize eps_small (eta_positive emin) (Rabs_pos x); intros.
  assert (0 <= eps * Rabs x) by (apply Rmult_le_pos; lra).
  destruct (Rlt_or_le (Rabs x) smallest_normal) as [C | C].
  - generalize (absolute_error_any p emin direction x C). lra.
  - generalize (relative_error_any p emin direction x C). lra.
Qed.

(** T and T' belong to the factors, S to the product. If a factor has no underflow, its T is arbitrary. *)
Lemma near_product v w x y a b U V T T' S :
  proper a -> proper b -> 0 <= U -> 0 <= V -> 0 <= T -> 0 <= T' -> 1 <= S ->
  (underflow b = 0 \/ U * T' <= S) -> (underflow a = 0 \/ T * V <= S) ->
  (underflow a = 0 \/ underflow b = 0 \/ T * T' <= S) ->
  eta * (underflow a * underflow b) <= / 16 ->
  near v x U T a -> near w y V T' b -> near (fl (v * w)) (x * y) (U * V) S (count_product a b).
Proof.
  intros Ca Cb HU HV HT HT' HS SB SA SAB Tiny (V1 & V2) (W1 & W2).
  generalize (product_proper a b Ca Cb). intros (_ & M & E & F).
  destruct Ca as (_ & _ & _ & Ma & Ea & Ua), Cb as (_ & _ & _ & Mb & Eb & Ub).
  generalize eps_small (eta_positive emin); intros P Q.
  set (ma := magnitude a) in *. set (mb := magnitude b) in *. set (ea := error a) in *.
  set (eb := error b) in *. set (ua := underflow a) in *. set (ub := underflow b) in *.
  (* the contribution of underflow, in units of eta S *)
  set (h := eta * S). assert (Hh : eta <= h).
  { unfold h. rewrite <- (Rmult_1_r eta) at 1. apply Rmult_le_compat_l; lra. }
  assert (X1 : U * (ub * (eta * T')) <= ub * h).
  { unfold h. destruct SB as [-> | SB]; [lra |].
    replace (U * (ub * (eta * T'))) with (ub * (eta * (U * T'))) by ring.
    repeat apply Rmult_le_compat_l; lra. }
  assert (X2 : (ua * (eta * T)) * V <= ua * h).
  { unfold h. destruct SA as [-> | SA]; [lra |].
    replace (ua * (eta * T) * V) with (ua * (eta * (T * V))) by ring.
    repeat apply Rmult_le_compat_l; lra. }
  assert (X3 : (ua * (eta * T)) * (ub * (eta * T')) <= / 16 * h).
  { unfold h. destruct SAB as [-> | [-> | SAB]];
      [rewrite !Rmult_0_l; fold h; lra | rewrite Rmult_0_l, Rmult_0_r; fold h; lra |].
    replace (ua * (eta * T) * (ub * (eta * T'))) with (eta * (ua * ub) * (eta * (T * T'))) by ring.
    assert (0 <= T * T') by (apply Rmult_le_pos; lra).
    apply Rmult_le_compat; try lra.
    - apply Rmult_le_pos; [lra |]. apply Rmult_le_pos; lra.
    - apply Rmult_le_pos; lra.
    - apply Rmult_le_compat_l; lra. }
  set (p1 := ua * (eta * T)) in *. set (p2 := ub * (eta * T')) in *.
  assert (UV : 0 <= U * V) by (apply Rmult_le_pos; lra).
  assert (Hmm : forall c d, 0 <= c -> 0 <= d -> 0 <= c * d) by (intros; apply Rmult_le_pos; lra).
  generalize (Rabs_pos v) (Rabs_pos w) (Rabs_pos (v - x)) (Rabs_pos (w - y)); intros.
  (* the product's size *)
  set (under := (ma * ub + ua * mb) * h).
  assert (Y1 : ma * U * p2 <= ma * ub * h).
  { replace (ma * U * p2) with (ma * (U * p2)) by ring. rewrite (Rmult_assoc ma).
    apply Rmult_le_compat_l; lra. }
  assert (Y2 : p1 * (mb * V) <= ua * mb * h).
  { replace (p1 * (mb * V)) with (mb * (p1 * V)) by ring.
    replace (ua * mb * h) with (mb * (ua * h)) by ring. apply Rmult_le_compat_l; lra. }
  assert (B : Rabs (v * w) <= ma * mb * (U * V) + under + / 16 * h).
  { rewrite Rabs_mult. apply Rle_trans with ((ma * U + p1) * (mb * V + p2)).
    - apply Rmult_le_compat; lra.
    - unfold under. lra. }
  (* its error *)
  assert (Z1 : ea * (eps * U) * p2 <= ea * ub * eps * h).
  { replace (ea * (eps * U) * p2) with (ea * eps * (U * p2)) by ring.
    replace (ea * ub * eps * h) with (ea * eps * (ub * h)) by ring.
    apply Rmult_le_compat_l; auto. apply Hmm; lra. }
  assert (Z2 : p1 * (eb * (eps * V)) <= ua * eb * eps * h).
  { replace (p1 * (eb * (eps * V))) with (eb * eps * (p1 * V)) by ring.
    replace (ua * eb * eps * h) with (eb * eps * (ua * h)) by ring.
    apply Rmult_le_compat_l; auto. apply Hmm; lra. }
  set (cross := (ea * ub + ua * eb) * (2 * eps) * h).
  assert (D : Rabs (v * w - x * y) <=
    (ma * eb + ea * mb + ea * eb * eps) * (eps * (U * V)) + under + cross + 3 * (/ 16 * h)).
  { replace (v * w - x * y) with (v * (w - y) + (v - x) * w + - ((v - x) * (w - y))) by ring.
    apply Rle_trans with (Rabs v * Rabs (w - y) + Rabs (v - x) * Rabs w +
                          Rabs (v - x) * Rabs (w - y)).
    { apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp, !Rabs_mult.
      apply Rplus_le_compat_r. apply Rle_trans with (1 := Rabs_triang _ _).
      rewrite !Rabs_mult. lra. }
    apply Rle_trans with ((ma * U + p1) * (eb * (eps * V) + p2) +
      (ea * (eps * U) + p1) * (mb * V + p2) + (ea * (eps * U) + p1) * (eb * (eps * V) + p2)).
    - repeat apply Rplus_le_compat; apply Rmult_le_compat; lra.
    - unfold under, cross. lra. }
  generalize (product_rounding (v * w)). intros R.
  assert (R' : eps * Rabs (v * w) <= eps * (ma * mb * (U * V) + under + / 16 * h))
    by (apply Rmult_le_compat_l; lra).
  assert (Crs : 0 <= cross).
  { unfold cross. apply Hmm; [| lra]. apply Hmm; [| lra]. generalize (Hmm ea ub) (Hmm ua eb). lra. }
  assert (M' : (1 + eps) * (ma * mb * (U * V)) <= magnitude (count_product a b) * (U * V)).
  { rewrite <- Rmult_assoc. apply Rmult_le_compat_r; auto. }
  assert (F' : (1 + eps) * (under + cross + 2 * h) <= underflow (count_product a b) * h).
  { unfold under, cross. apply Rle_trans with
      ((1 + eps) * (ma * ub + ua * mb + (ea * ub + ua * eb) * (2 * eps) + 2) * h).
    - right. ring.
    - apply Rmult_le_compat_r; lra. }
  assert (E' : (ma * eb + ea * mb + ea * eb * eps) * (eps * (U * V)) + eps * (ma * mb * (U * V)) <=
               error (count_product a b) * (eps * (U * V))).
  { apply Rle_trans with
      ((ma * eb + ea * mb + ea * eb * eps + ma * mb) * (eps * (U * V))).
    - right. ring.
    - apply Rmult_le_compat_r; auto. apply Hmm; lra. }
  assert (0 <= eps * h <= / 512 * h).
  { split; [apply Hmm; lra | apply Rmult_le_compat_r; lra]. }
  assert (0 <= eps * cross) by (apply Hmm; lra).
  split; fold h.
  - replace (fl (v * w)) with ((fl (v * w) - v * w) + v * w) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra.
  - replace (fl (v * w) - x * y) with ((fl (v * w) - v * w) + (v * w - x * y)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.

Lemma value_number e : admissible e -> number (value e).
Proof.
  induction e; simpl; try (intros; apply rnd_number; auto with typeclass_instances); try tauto.
  intros A. apply number_opp. auto.
Qed.
Lemma near_opp v x U T c : near v x U T c -> near (- v) (- x) U T c.
Proof.
  unfold near. rewrite Rabs_Ropp. replace (- v - - x) with (- (v - x)) by ring.
  now rewrite Rabs_Ropp.
Qed.

Lemma count_near e : admissible e -> (Z.of_nat (height e) + emin <= 0)%Z ->
  near (value e) (exact e) (unit e) (scale e) (count e).
Proof.
  generalize eps_small (eta_positive emin); intros P Q.
  assert (S : forall e, 1 <= scale e) by (intros; apply power_W_1).
  assert (Max : forall x y, (degree x <= y)%nat -> 0 <= scale x <= W ^ Nat.pred y).
  { intros x y L. generalize (S x). split; [lra |]. apply power_W_le. lia. }
  assert (Sum : forall x y w z, admissible x -> admissible y -> number w ->
    near (value x) (exact x) (unit x) (scale x) (count x) ->
    near w z (unit y) (scale y) (count y) ->
    near (fl (value x + w)) (exact x + z) (Rmax (unit x) (unit y))
      (W ^ Nat.pred (Nat.max (degree x) (degree y))) (count_sum (count x) (count y))).
  { intros x y w z A B N X Y. generalize (unit_power x A) (unit_power y B); intros.
    apply near_sum with (9 := X) (10 := Y); auto using value_number, count_proper.
    - split; [lra | apply Rmax_l].
    - split; [lra | apply Rmax_r].
    - apply Max. lia.
    - apply Max. lia. }
  induction e as [x M | a b M | c | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx | c x M];
    cbn [admissible height]; intros A H.
  - destruct A as [_ A]. unfold near. simpl. replace (x - x) with 0 by ring. rewrite Rabs_R0. lra.
  - destruct A as (Na & Nb & A). unfold near. simpl.
    generalize (sum_error p emin direction _ _ any_error a (- b) Na (number_opp _ _ _ Nb))
      (number_opp _ _ _ Nb).
    change (a + - b) with (a - b). intros.
    split; [lra |].
    apply Rle_trans with (eps * Rabs (fl (a - b))); [| nra].
    destruct (Rlt_or_le (Rabs (a - b)) smallest_normal) as [C | C].
    + rewrite (sum_exact_below p emin direction a (- b) Na ltac:(auto) C) at 1.
      change (a + - b) with (a - b). replace (a - b - (a - b)) with 0 by ring. rewrite Rabs_R0.
      apply Rmult_le_pos; [lra | apply Rabs_pos].
    + apply Rle_trans with (ulp radix2 (FLT_exp emin p) (fl (a - b))).
      * apply error_le_ulp_round; auto with typeclass_instances.
      * rewrite (Rmult_comm eps). apply ulp_FLT_le; auto.
        apply rnd_abs_above; auto with typeclass_instances. apply number_smallest_normal; auto.
  - unfold near. simpl. replace (IZR c - IZR c) with 0 by ring. rewrite Rabs_R0. lra.
  - destruct A as [A B]. simpl. unfold scale. simpl. apply Sum; auto using value_number.
    + apply IHx; auto. lia.
    + apply IHy; auto. lia.
  - destruct A as [A B]. simpl. unfold scale. simpl. apply Sum; auto using number_opp, value_number.
    + apply IHx; auto. lia.
    + apply near_opp, IHy; auto. lia.
  - destruct A as (A & B & D). simpl.
    generalize (unit_power x A) (unit_power y B); intros HX HY.
    generalize (count_proper x A) (count_proper y B); intros CX CY.
    generalize (count_height x A) (count_height y B). intros (_ & _ & UX) (_ & _ & UY).
    generalize (S x) (S y); intros.
    assert (Deg : forall z, admissible z -> underflow (count z) = 0 \/ (1 <= degree z)%nat).
    { intros z Z. destruct (Nat.eq_dec (degree z) 0); [left | right; lia].
      now apply underflow_of_constants. }
    unfold scale at 1. cbn [degree].
    apply (near_product _ _ _ _ _ _ _ _ (scale x) (scale y)); auto; try lra.
    + apply power_W_1.
    + destruct (Deg y B) as [| L]; [now left | right].
      apply Rle_trans with (W ^ degree x * scale y).
      * apply Rmult_le_compat_r; lra.
      * unfold scale. rewrite <- pow_add. apply power_W_le. lia.
    + destruct (Deg x A) as [| L]; [now left | right].
      apply Rle_trans with (scale x * W ^ degree y).
      * apply Rmult_le_compat_l; lra.
      * unfold scale. rewrite <- pow_add. apply power_W_le. lia.
    + destruct (Deg x A) as [| L]; [now left | right].
      destruct (Deg y B) as [| L']; [now left | right].
      unfold scale. rewrite <- pow_add. apply power_W_le. lia.
    + apply Rle_trans with (bpow radix2 (emin + Z.of_nat (height x + height y))).
      * unfold Format.eta. rewrite bpow_plus. apply Rmult_le_compat_l; [apply bpow_ge_0 |].
        rewrite pow2_plus. destruct CX as (_ & _ & _ & _ & _ & ?), CY as (_ & _ & _ & _ & _ & ?).
        apply Rmult_le_compat; lra.
      * replace (/ 16) with (bpow radix2 (- 4)) by (simpl; lra). apply bpow_le. lia.
    + apply IHx; auto. lia.
    + apply IHy; auto. lia.
  - simpl. apply near_opp. apply IHx; auto.
  - destruct A as (_ & L & E). unfold near, scale. simpl. split; [lra |].
    assert (eps * Rabs c <= eps * M) by (apply Rmult_le_compat_l; lra). lra.
Qed.

Theorem count_sound e : admissible e -> (Z.of_nat (height e) + emin <= 0)%Z ->
  Rabs (value e) <=
    magnitude (count e) * unit e + underflow (count e) * (eta * W ^ Nat.pred (degree e)) /\
  Rabs (value e - exact e) <=
    error (count e) * (eps * unit e) + underflow (count e) * (eta * W ^ Nat.pred (degree e)).
Proof. apply count_near. Qed.

End ErrorCount.
