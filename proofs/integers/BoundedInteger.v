(** Integers that stand for a real number near them (ccd/exact/bounded_integer.hpp), over the integers. The files
    that use them prove that they fit their words.

    A number stands for every real number less than 2^error_bits away from its value. If error_bits is below
    exact/2, it stands only for its value. Results, without conditions on sizes or error bits:
        bit_length_bounds       |x| <= 2^bit_length, and 2^(bit_length - 1) <= |x| unless that is 0
        bounded_sum_known, bounded_difference_known, bounded_product_known
                                the result stands for the sum, difference and product
        bounded_sign_certain    sign_of is right or uncertain *)

From Coq Require Import ZArith Reals Lia Lra Bool.
From Flocq Require Import Core.
From Errbound Require Import Sign.
Open Scope Z_scope.

Notation pow2 := (bpow radix2).

(** bit_length() of x, or of its complement -x - 1 if x is negative. *)
Definition bit_width (x : Z) : Z := if x =? 0 then 0 else Z.log2 x + 1.
Definition bit_length (x : Z) : Z := bit_width (if x <? 0 then - x - 1 else x).

Theorem bit_length_bounds x : 0 <= bit_length x /\ Z.abs x <= 2 ^ bit_length x /\
  (0 < bit_length x -> 2 ^ (bit_length x - 1) <= Z.abs x).
Proof.
  unfold bit_length, bit_width.
  assert (H : forall m, 0 <= m -> 0 <= (if m =? 0 then 0 else Z.log2 m + 1) /\
    m < 2 ^ (if m =? 0 then 0 else Z.log2 m + 1) /\
    (0 < (if m =? 0 then 0 else Z.log2 m + 1) -> 2 ^ ((if m =? 0 then 0 else Z.log2 m + 1) - 1) <= m)).
  { intros m M. destruct (Z.eqb_spec m 0) as [-> | N]; [simpl; lia |].
    pose proof (Z.log2_spec m ltac:(lia)). pose proof (Z.log2_nonneg m).
    replace (Z.log2 m + 1 - 1) with (Z.log2 m) by lia. rewrite <- Z.add_1_r in *. lia. }
  destruct (Z.ltb_spec x 0) as [L | L]; [destruct (H (- x - 1)) as (A & B & C) | destruct (H x) as (A & B &
    C)];
    try lia; repeat split; auto; intros; try (specialize (C ltac:(auto))); lia.
Qed.

Definition exact : Z := - 2 ^ 20.
Record bounded := Bounded { value : Z; error_bits : Z }.
Definition is_exact (x : bounded) : bool := error_bits x <? exact / 2.

Definition add (a b : bounded) : bounded :=
  Bounded (value a + value b) (Z.max (error_bits a) (error_bits b) + 1).
Definition sub (a b : bounded) : bounded :=
  Bounded (value a - value b) (Z.max (error_bits a) (error_bits b) + 1).
Definition mul (a b : bounded) : bounded :=
  Bounded (value a * value b)
    (2 + Z.max (Z.max (bit_length (value a) + error_bits b) (bit_length (value b) + error_bits a))
           (error_bits a + error_bits b)).
Definition sign_of_integer (x : Z) : sign := match x ?= 0 with Lt => negative | Eq => zero | Gt => positive
  end.
Definition sign_of (x : bounded) : sign :=
  if negb (is_exact x) && (bit_length (value x) <=? Z.max (error_bits x) 0) then uncertain
  else sign_of_integer (value x).

(** The real numbers that a number stands for. *)
Definition stands (x : bounded) (r : R) : Prop :=
  if is_exact x then r = IZR (value x) else (Rabs (r - IZR (value x)) < pow2 (error_bits x))%R.

Open Scope R_scope.

Lemma stands_error x r : stands x r -> Rabs (r - IZR (value x)) < pow2 (error_bits x).
Proof.
  unfold stands. destruct (is_exact x); auto. intros ->. rewrite Rminus_diag_eq, Rabs_R0 by easy.
  apply bpow_gt_0.
Qed.
(** A result's error bound is that of an exact number only if both operands are exact. *)
Lemma stands_if x r a b : (Z.max (error_bits a) (error_bits b) < error_bits x)%Z ->
  (is_exact a = true -> is_exact b = true -> r = IZR (value x)) ->
  ((is_exact a = false \/ is_exact b = false) -> Rabs (r - IZR (value x)) < pow2 (error_bits x)) ->
  stands x r.
Proof.
  unfold stands, is_exact. intros E Both One.
  destruct (Z.ltb_spec (error_bits a) (exact / 2)), (Z.ltb_spec (error_bits b) (exact / 2)).
  1: { rewrite Both by easy. rewrite Rminus_diag_eq, Rabs_R0 by easy.
       destruct (_ <? _)%Z; [easy | apply bpow_gt_0]. }
  all: destruct (Z.ltb_spec (error_bits x) (exact / 2)); [exfalso; lia | now apply One; auto].
Qed.

Lemma sum_error a b x y : stands a x -> stands b y ->
  Rabs (x - IZR (value a)) + Rabs (y - IZR (value b)) < pow2 (Z.max (error_bits a) (error_bits b) + 1).
Proof.
  intros A B. apply stands_error in A, B. rewrite bpow_plus. change (pow2 1) with 2.
  pose proof (bpow_le radix2 _ _ (Z.le_max_l (error_bits a) (error_bits b))).
  pose proof (bpow_le radix2 _ _ (Z.le_max_r (error_bits a) (error_bits b))). lra.
Qed.

Theorem bounded_sum_known a b x y : stands a x -> stands b y -> stands (add a b) (x + y).
Proof.
  intros A B. apply (stands_if _ _ a b); cbn [add value error_bits].
  - lia.
  - unfold stands in *. intros Ea Eb. rewrite Ea in A. rewrite Eb in B. now rewrite A, B, plus_IZR.
  - intros _. apply Rle_lt_trans with (2 := sum_error a b x y A B). rewrite plus_IZR.
    replace (x + y - (IZR (value a) + IZR (value b))) with (x - IZR (value a) + (y - IZR (value b))) by ring.
    apply Rabs_triang.
Qed.
Theorem bounded_difference_known a b x y : stands a x -> stands b y -> stands (sub a b) (x - y).
Proof.
  intros A B. apply (stands_if _ _ a b); cbn [sub value error_bits].
  - lia.
  - unfold stands in *. intros Ea Eb. rewrite Ea in A. rewrite Eb in B. now rewrite A, B, minus_IZR.
  - intros _. apply Rle_lt_trans with (2 := sum_error a b x y A B). rewrite minus_IZR.
    replace (x - y - (IZR (value a) - IZR (value b))) with (x - IZR (value a) + - (y - IZR (value b))) by
      ring.
    rewrite <- (Rabs_Ropp (y - _)). apply Rabs_triang.
Qed.

Lemma value_size x : Rabs (IZR (value x)) <= pow2 (bit_length (value x)).
Proof.
  destruct (bit_length_bounds (value x)) as (N & B & _). rewrite <- abs_IZR.
  rewrite <- (IZR_Zpower radix2) by easy. now apply IZR_le.
Qed.

Theorem bounded_product_known a b x y : stands a x -> stands b y -> stands (mul a b) (x * y).
Proof.
  intros A B. destruct (bit_length_bounds (value a)) as (Na & _), (bit_length_bounds (value b)) as (Nb & _).
  apply (stands_if _ _ a b).
  - cbn [mul value error_bits]. lia.
  - unfold stands in *. intros Ea Eb. rewrite Ea in A. rewrite Eb in B. cbn [mul value].
    now rewrite A, B, mult_IZR.
  - intros _. apply stands_error in A, B. cbn [mul value error_bits]. rewrite mult_IZR.
    pose proof (value_size a) as Sa. pose proof (value_size b) as Sb.
    set (la := bit_length (value a)) in *. set (lb := bit_length (value b)) in *.
    set (ea := error_bits a) in *. set (eb := error_bits b) in *.
    set (va := IZR (value a)) in *. set (vb := IZR (value b)) in *.
    set (m := Z.max (Z.max (la + eb) (lb + ea)) (ea + eb)).
    replace (x * y - va * vb) with (va * (y - vb) + vb * (x - va) + (x - va) * (y - vb)) by ring.
    assert (P : forall p q d e, Rabs p <= pow2 d -> Rabs q < pow2 e -> (d + e <= m)%Z ->
      Rabs (p * q) <= pow2 m).
    { intros p q d e P Q M. rewrite Rabs_mult. apply Rle_trans with (pow2 d * pow2 e).
      - apply Rmult_le_compat; auto using Rabs_pos; lra.
      - rewrite <- bpow_plus. now apply bpow_le. }
    pose proof (P va (y - vb) la eb Sa B ltac:(lia)). pose proof (P vb (x - va) lb ea Sb A ltac:(lia)).
    pose proof (P (x - va) (y - vb) ea eb ltac:(lra) B ltac:(lia)).
    rewrite bpow_plus. change (pow2 2) with 4. pose proof (bpow_gt_0 radix2 m).
    pose proof (Rabs_triang (va * (y - vb) + vb * (x - va)) ((x - va) * (y - vb))).
    pose proof (Rabs_triang (va * (y - vb)) (vb * (x - va))). lra.
Qed.

Lemma sign_of_integer_right x : sign_is_right (sign_of_integer x) (IZR x).
Proof.
  unfold sign_of_integer. destruct (Z.compare_spec x 0) as [-> | L | L]; simpl; auto.
  - now apply IZR_lt in L.
  - now apply IZR_lt in L.
Qed.

Theorem bounded_sign_certain x r : stands x r -> sign_is_right (sign_of x) r.
Proof.
  unfold stands, sign_of. destruct (is_exact x); cbn [negb andb]; [intros ->; apply sign_of_integer_right |].
  destruct (Z.leb_spec (bit_length (value x)) (Z.max (error_bits x) 0)) as [| L]; [easy | intros E].
  destruct (bit_length_bounds (value x)) as (_ & _ & S). specialize (S ltac:(lia)). apply IZR_le in S.
  rewrite (IZR_Zpower radix2), abs_IZR in S by lia.
  pose proof (bpow_le radix2 (error_bits x) (bit_length (value x) - 1) ltac:(lia)).
  assert (D : Rabs (r - IZR (value x)) < Rabs (IZR (value x))) by lra. clear - D.
  pose proof (sign_of_integer_right (value x)) as Q.
  destruct (sign_of_integer (value x)); simpl in *; auto.
  - rewrite (Rabs_left (IZR (value x))) in D by easy. apply Rabs_def2 in D. lra.
  - rewrite Q, Rabs_R0 in D. pose proof (Rabs_pos (r - 0)). lra.
  - rewrite (Rabs_pos_eq (IZR (value x))) in D by lra. apply Rabs_def2 in D. lra.
Qed.
