(** Bits of the exact stages' integers (include/errbound/integers/fixed_integer.hpp, long_integer.hpp); words as in
    Words.v. Results:
        bit_length_exact   bit_length() <= n exactly if -2^n <= x < 2^n
        from_bit_exact     from_bit: floor(x/2^shift) if it fits, else modulo the result's width
        long_bit_length_exact   the same for long_integer
        shifted_exact      shifted: magnitude 2^shift if it fits, else modulo the width
        long_shifted_exact the long integer of a magnitude, a shift and a sign *)

From Coq Require Import ZArith List Lia Bool.
From Errbound Require Import Words.
From Errbound Require SparseProduct.
Import ListNotations.
Open Scope Z_scope.

(** The words of a number: the i-th is floor(z/2^(64i)) modulo 2^64. *)
Definition words_of (n : nat) (z : Z) : list Z := map (fun i => z / B ^ Z.of_nat i mod B) (seq 0 n).

Lemma words_of_words n z : words (words_of n z) /\ length (words_of n z) = n.
Proof.
  unfold words_of. split; [| now rewrite map_length, seq_length].
  apply Forall_forall. intros w I. apply in_map_iff in I. destruct I as (i & <- & _).
  apply Z.mod_pos_bound. exact B_positive.
Qed.
Lemma words_of_succ n z : words_of (S n) z = z mod B :: words_of n (z / B).
Proof.
  unfold words_of. cbn [seq map]. change (B ^ Z.of_nat 0) with 1. rewrite Z.div_1_r. f_equal.
  rewrite <- seq_shift, map_map. apply map_ext. intros i.
  rewrite Nat2Z.inj_succ, Z.pow_succ_r, Z.div_div by
    (try apply Z.pow_pos_nonneg; try lia; exact B_positive || now apply Z.neq_sym, Z.lt_neq). reflexivity.
Qed.
Lemma words_of_value n z : value (words_of n z) = z mod B ^ Z.of_nat n.
Proof.
  revert z. induction n as [| n IH]; intros z; [now rewrite Z.mod_1_r |].
  rewrite words_of_succ. cbn [value]. rewrite IH, Nat2Z.inj_succ, Z.pow_succ_r by lia.
  symmetry. apply Z.rem_mul_r; [| apply power_positive]. generalize B_positive. lia.
Qed.
Lemma words_of_exact n z : n <> 0%nat -> fits n z -> signed (words_of n z) = z.
Proof.
  intros N F. destruct (words_of_words n z) as [W L].
  apply signed_is with (k := - (z / B ^ Z.of_nat n)); auto.
  - intros E. rewrite E in L. now destruct n.
  - now rewrite L.
  - rewrite words_of_value, L. generalize (Z.div_mod z (B ^ Z.of_nat n)) (power_positive n). lia.
Qed.

(** The words of a number, with sign words beyond the last. *)
Definition word_at (x : list Z) (i : nat) : Z := nth i x (sign_word x).
Lemma nth_value x i : words x -> (i < length x)%nat -> nth i x 0 = value x / B ^ Z.of_nat i mod B.
Proof.
  intros W. revert i. induction W as [| w x H W IH]; intros i L; [simpl in L; lia |].
  generalize B_positive. intros P. unfold word in H. cbn [value]. destruct i as [| i].
  - cbn [nth]. change (B ^ Z.of_nat 0) with 1. rewrite Z.div_1_r, Z.mul_comm, Z.mod_add by lia.
    symmetry. now apply Z.mod_small.
  - cbn [nth]. simpl in L. rewrite IH by lia. rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia.
    rewrite <- Z.div_div by (try apply power_positive; lia). rewrite (Z.mul_comm B), Z.div_add by lia.
    now rewrite (Z.div_small w) by lia.
Qed.
Lemma word_at_exact x i : words x -> x <> [] -> word_at x i = signed x / B ^ Z.of_nat i mod B.
Proof.
  intros W N. set (n := Nat.max (length x) (S i)). destruct (extended_exact x n N W ltac:(lia)) as (SE & We & L).
  assert (E : word_at x i = nth i (extended x n) 0).
  { unfold word_at, extended. destruct (Nat.lt_ge_cases i (length x)) as [C | C].
    - rewrite app_nth1 by auto. now apply nth_indep.
    - rewrite app_nth2, nth_overflow by auto. symmetry. apply (repeat_spec (n - length x)), nth_In.
      rewrite repeat_length. lia. }
  rewrite E, nth_value by (auto; lia). rewrite <- SE. destruct (signed_modulo (extended x n)) as [k ->]. rewrite L.
  replace (Z.of_nat n) with (Z.of_nat (n - S i) + 1 + Z.of_nat i) by lia.
  rewrite !Z.pow_add_r by lia. rewrite Z.pow_1_r, !Z.mul_assoc.
  rewrite Z.div_add by (generalize (power_positive i); lia).
  rewrite Z.mod_add by (generalize B_positive; lia). reflexivity.
Qed.

(** ⌊x/2^shift⌋ in n words. *)
Definition from_bit (x : list Z) (shift : Z) (n : nat) : list Z :=
  let whole := Z.to_nat (shift / 64) in
  let bits := shift mod 64 in
  map (fun i =>
    let low := word_at x (whole + i) in
    let high := word_at x (whole + i + 1) in
    Z.lor (low / 2 ^ bits) (high * 2 mod B * 2 ^ (63 - bits) mod B)) (seq 0 n).

(** Two words, from one bit of the first on. *)
Lemma bits_of_two q bits : 0 <= bits < 64 ->
  Z.lor (q mod B / 2 ^ bits) (q / B mod B * 2 mod B * 2 ^ (63 - bits) mod B) = q / 2 ^ bits mod B.
Proof.
  intros H. generalize B_positive. intros P.
  assert (P1 : 0 < 2 ^ bits) by (apply Z.pow_pos_nonneg; lia).
  assert (P2 : 0 < 2 ^ (64 - bits)) by (apply Z.pow_pos_nonneg; lia).
  assert (S : B = 2 ^ (64 - bits) * 2 ^ bits) by (rewrite <- Z.pow_add_r by lia; now replace (64 - bits + bits) with 64 by lia).
  assert (M : q / B mod B * 2 mod B * 2 ^ (63 - bits) mod B = (q / B) mod 2 ^ bits * 2 ^ (64 - bits)).
  { rewrite Z.mul_mod_idemp_l by lia. rewrite <- Z.mul_assoc, <- (Z.pow_succ_r 2) by lia.
    replace (Z.succ (63 - bits)) with (64 - bits) by lia. rewrite Z.mul_mod_idemp_l by lia.
    rewrite S at 2. rewrite (Z.mul_comm (2 ^ (64 - bits)) (2 ^ bits)). now rewrite Z.mul_mod_distr_r by lia. }
  rewrite M, Z.lor_comm, or_is_sum; [| lia |].
  2: { split; [apply Z.div_pos; [apply Z.mod_pos_bound; lia | lia] |].
       apply Z.div_lt_upper_bound; [lia |]. rewrite Z.mul_comm, <- S. now apply Z.mod_pos_bound. }
  (* q = q1 B + q0, so that q/2^bits = q1 2^(64 - bits) + q0/2^bits *)
  assert (Q : q = q mod B + q / B * 2 ^ (64 - bits) * 2 ^ bits).
  { rewrite <- Z.mul_assoc, <- S. generalize (Z.div_mod q B). lia. }
  rewrite Q at 3. assert (Q0 : 0 <= q mod B < B) by (apply Z.mod_pos_bound; lia).
  set (q1 := q / B) in *. set (q0 := q mod B) in *. rewrite Z.div_add by lia. rewrite (Z.div_mod q1 (2 ^ bits)) at 2 by lia.
  replace (q0 / 2 ^ bits + (2 ^ bits * (q1 / 2 ^ bits) + q1 mod 2 ^ bits) * 2 ^ (64 - bits))
    with (q1 mod 2 ^ bits * 2 ^ (64 - bits) + q0 / 2 ^ bits + q1 / 2 ^ bits * (2 ^ (64 - bits) * 2 ^ bits)) by ring.
  rewrite <- S, Z.mod_add by lia. symmetry. apply Z.mod_small.
  assert (0 <= q1 mod 2 ^ bits < 2 ^ bits) by (apply Z.mod_pos_bound; lia).
  assert (0 <= q0 / 2 ^ bits < 2 ^ (64 - bits)).
  { split; [apply Z.div_pos; lia | apply Z.div_lt_upper_bound; lia]. }
  nia.
Qed.
Lemma from_bit_words x shift n : words x -> x <> [] -> 0 <= shift ->
  from_bit x shift n = words_of n (signed x / 2 ^ shift).
Proof.
  intros W N P. unfold from_bit, words_of. cbv zeta. apply map_ext. intros i.
  assert (H : 0 <= shift mod 64 < 64) by (apply Z.mod_pos_bound; lia).
  assert (D := Z.div_mod shift 64 ltac:(lia)). assert (D0 : 0 <= shift / 64) by (apply Z.div_pos; lia).
  generalize B_positive. intros PB.
  rewrite !word_at_exact by auto. set (q := signed x / B ^ Z.of_nat (Z.to_nat (shift / 64) + i)).
  assert (Q : signed x / B ^ Z.of_nat (Z.to_nat (shift / 64) + i + 1) = q / B).
  { rewrite Nat2Z.inj_add, Z.pow_add_r by lia. rewrite <- Z.div_div by (try apply power_positive; try lia; generalize (power_positive (Z.to_nat (shift / 64) + i)); lia).
    reflexivity. }
  rewrite Q, bits_of_two by auto. f_equal. unfold q.
  rewrite !Z.div_div by (try apply Z.pow_nonzero; try apply Z.pow_pos_nonneg; lia). f_equal.
  unfold base. rewrite <- !Z.pow_mul_r, <- !Z.pow_add_r by lia. f_equal. lia.
Qed.
Theorem from_bit_exact x shift n : words x -> x <> [] -> 0 <= shift ->
  value (from_bit x shift n) = signed x / 2 ^ shift mod B ^ Z.of_nat n /\
  (n <> 0%nat -> fits n (signed x / 2 ^ shift) -> signed (from_bit x shift n) = signed x / 2 ^ shift).
Proof.
  intros. rewrite from_bit_words by auto. split; [apply words_of_value | apply words_of_exact].
Qed.

(** magnitude 2^shift in n words. *)
Definition shifted_word (magnitude shift : Z) (i : nat) : Z :=
  let whole := shift / 64 in
  let bits := shift mod 64 in
  let low := magnitude * 2 ^ bits mod B in
  let high := if bits =? 0 then 0 else magnitude / 2 ^ (64 - bits) in
  if Z.of_nat i =? whole then low else if Z.of_nat i =? whole + 1 then high else 0.
Definition shifted (magnitude shift : Z) (n : nat) : list Z := map (shifted_word magnitude shift) (seq 0 n).
Lemma shifted_word_right magnitude shift i : word magnitude -> 0 <= shift ->
  shifted_word magnitude shift i = magnitude * 2 ^ shift / B ^ Z.of_nat i mod B.
Proof.
  intros M P. unfold shifted_word. cbv zeta. unfold word in M.
  assert (H : 0 <= shift mod 64 < 64) by (apply Z.mod_pos_bound; lia).
  assert (D := Z.div_mod shift 64 ltac:(lia)). assert (D0 : 0 <= shift / 64) by (apply Z.div_pos; lia).
  set (whole := shift / 64) in *. set (bits := shift mod 64) in *. set (k := Z.of_nat i).
  assert (K : 0 <= k) by (unfold k; lia). generalize B_positive. intros PB.
  assert (E : B ^ k = 2 ^ (64 * k)) by (unfold base; now rewrite <- Z.pow_mul_r by lia).
  assert (Pk : 0 < 2 ^ (64 * k)) by (apply Z.pow_pos_nonneg; lia).
  destruct (Z.eqb_spec k whole) as [-> | N1].
  { rewrite E, D, Z.pow_add_r by lia. rewrite (Z.mul_comm (2 ^ _)), Z.mul_assoc, Z.div_mul by lia. reflexivity. }
  destruct (Z.eqb_spec k (whole + 1)) as [-> | N2].
  { replace shift with (64 * whole + bits) by lia. rewrite E. replace (64 * (whole + 1)) with (64 * whole + 64) by lia.
    rewrite !Z.pow_add_r by lia. rewrite Z.mul_assoc, (Z.mul_comm magnitude), <- Z.mul_assoc, Z.div_mul_cancel_l by lia.
    assert (P1 : 0 < 2 ^ bits) by (apply Z.pow_pos_nonneg; lia).
    destruct (Z.eqb_spec bits 0) as [-> | N0].
    - rewrite Z.mul_1_r. change (2 ^ 64) with B. now rewrite (Z.div_small magnitude).
    - assert (S : 2 ^ 64 = 2 ^ (64 - bits) * 2 ^ bits) by (rewrite <- Z.pow_add_r by lia; now replace (64 - bits + bits) with 64 by lia).
      assert (P2 : 0 < 2 ^ (64 - bits)) by (apply Z.pow_pos_nonneg; lia).
      rewrite S, Z.div_mul_cancel_r by lia. symmetry. apply Z.mod_small.
      split; [apply Z.div_pos; lia |]. apply Z.div_lt_upper_bound; [lia |]. nia. }
  symmetry. destruct (Z_lt_le_dec k whole) as [C | C].
  - replace (magnitude * 2 ^ shift) with (magnitude * 2 ^ (shift - 64 * k - 64) * B * 2 ^ (64 * k)).
    + rewrite E, Z.div_mul by lia. apply Z.mod_mul. lia.
    + change B with (2 ^ 64). rewrite <- !Z.mul_assoc, <- !Z.pow_add_r by lia. do 2 f_equal. lia.
  - rewrite Z.div_small; [reflexivity |]. split; [apply Z.mul_nonneg_nonneg; [lia | apply Z.pow_nonneg; lia] |].
    apply Z.lt_le_trans with (2 ^ 64 * 2 ^ shift).
    + apply Z.mul_lt_mono_pos_r; [apply Z.pow_pos_nonneg; lia | apply M].
    + rewrite E, <- Z.pow_add_r by lia. apply Z.pow_le_mono_r; lia.
Qed.
Lemma shifted_words magnitude shift n : word magnitude -> 0 <= shift ->
  shifted magnitude shift n = words_of n (magnitude * 2 ^ shift).
Proof. intros. apply map_ext. intros. now apply shifted_word_right. Qed.
Theorem shifted_exact magnitude shift n : word magnitude -> 0 <= shift ->
  value (shifted magnitude shift n) = magnitude * 2 ^ shift mod B ^ Z.of_nat n /\
  (n <> 0%nat -> fits n (magnitude * 2 ^ shift) -> signed (shifted magnitude shift n) = magnitude * 2 ^ shift).
Proof.
  intros. rewrite shifted_words by auto. split; [apply words_of_value | apply words_of_exact].
Qed.

(** The least n with -2^n <= x < 2^n. *)
Definition bit_width (w : Z) : Z := if w =? 0 then 0 else Z.log2 w + 1.
Fixpoint length_from_last (x : list Z) (invert : Z) : Z :=
  match x with
  | [] => 0
  | w :: x =>
      let w := Z.lxor w invert in
      if w =? 0 then length_from_last x invert else 64 * size x + bit_width w
  end.
Definition bit_length (x : list Z) : Z := length_from_last (rev x) (sign_word x).

Lemma inverted w : word w -> Z.lxor w (B - 1) = B - 1 - w.
Proof.
  intros W. enough (w + Z.lxor w (B - 1) = B - 1) by lia. rewrite Z.add_nocarry_lxor.
  - now rewrite <- Z.lxor_assoc, Z.lxor_nilpotent, Z.lxor_0_l.
  - change (B - 1) with (Z.ones 64). apply Z.bits_inj'. intros i I. rewrite Z.land_spec, Z.lxor_spec, Z.bits_0.
    destruct (Z.ltb_spec i 64).
    + rewrite Z.ones_spec_low by lia. now destruct (Z.testbit w i).
    + enough (Z.testbit w i = false) as -> by reflexivity. unfold word in W.
      destruct (Z.eq_dec w 0) as [-> | D]; [apply Z.bits_0 |]. apply Z.bits_above_log2; [lia |].
      apply Z.lt_le_trans with 64; [| lia]. apply Z.log2_lt_pow2; [lia |]. apply W.
Qed.
(** All words inverted, or none. *)
Lemma length_of_value x invert : words x -> invert = 0 \/ invert = B - 1 ->
  length_from_last (rev x) invert = bit_width (if invert =? 0 then value x else B ^ size x - 1 - value x).
Proof.
  intros W I. induction x as [| w x IH] using rev_ind.
  { destruct I as [-> | ->]; reflexivity. }
  apply Forall_app in W. destruct W as [W H]. inversion_clear H as [| ? ? Hw _]. specialize (IH W).
  rewrite rev_app_distr. cbn [rev app length_from_last]. rewrite IH, rev_length.
  rewrite value_app, app_length. cbn [length value].
  replace (Z.of_nat (length x + 1)) with (Z.succ (size x)) by lia. rewrite Z.pow_succ_r by lia.
  generalize (value_bounds x W) (power_positive (length x)) B_positive. intros V P PB.
  assert (X : exists v, Z.lxor w invert = v /\ word v /\ (if invert =? 0 then w else B - 1 - w) = v).
  { unfold word in *. destruct I as [-> | ->].
    - exists w. rewrite Z.lxor_0_r. auto.
    - exists (B - 1 - w). rewrite inverted by auto. split; auto. split; [lia | reflexivity]. }
  destruct X as (v & -> & Wv & Ev). unfold word in Wv.
  set (y := if invert =? 0 then value x else B ^ size x - 1 - value x) in *.
  assert (Y : 0 <= y < B ^ size x) by (unfold y; destruct (invert =? 0); lia).
  assert (E : (if invert =? 0 then value x + B ^ size x * (w + B * 0)
               else B * B ^ size x - 1 - (value x + B ^ size x * (w + B * 0))) = y + v * B ^ size x).
  { unfold y. rewrite <- Ev. destruct (invert =? 0); ring. }
  rewrite E. destruct (Z.eqb_spec v 0) as [-> | NV].
  - f_equal. ring.
  - unfold bit_width. destruct (Z.eqb_spec v 0) as [| _]; [contradiction |].
    destruct (Z.eqb_spec (y + v * B ^ size x) 0) as [C | C]; [nia |].
    enough (Z.log2 (y + v * B ^ size x) = 64 * size x + Z.log2 v) by lia.
    destruct (Z.log2_spec v ltac:(lia)) as [L1 L2]. generalize (Z.log2_nonneg v). intros L0.
    assert (EB : B ^ size x = 2 ^ (64 * size x)) by (unfold base; now rewrite <- Z.pow_mul_r by lia).
    rewrite EB in *. apply Z.log2_unique; [lia |]. rewrite Z.pow_succ_r in L2 |- * by lia.
    rewrite Z.pow_add_r by lia. split; nia.
Qed.
Theorem bit_length_exact x n : words x -> x <> [] -> 0 <= n ->
  0 <= bit_length x /\ (bit_length x <= n <-> - 2 ^ n <= signed x < 2 ^ n).
Proof.
  intros W N P. unfold bit_length.
  assert (I : sign_word x = 0 \/ sign_word x = B - 1) by (unfold sign_word; destruct (negative x); auto).
  rewrite length_of_value by auto.
  assert (E : (if sign_word x =? 0 then value x else B ^ size x - 1 - value x) =
              if negative x then - 1 - signed x else signed x).
  { unfold sign_word, signed. destruct (negative x); [change (B - 1 =? 0) with false | rewrite Z.eqb_refl]; ring. }
  rewrite E. generalize (negative_spec x W N) (value_bounds x W). unfold signed. intros S V.
  assert (P2 : 0 < 2 ^ n) by (apply Z.pow_pos_nonneg; lia).
  assert (Key : forall y, 0 <= y -> 0 <= bit_width y /\ (bit_width y <= n <-> y < 2 ^ n)).
  { intros y Y. unfold bit_width. destruct (Z.eqb_spec y 0) as [-> | NY]; [lia |].
    generalize (Z.log2_nonneg y). intros L. split; [lia |]. rewrite Z.log2_lt_pow2 by lia. lia. }
  destruct (negative x).
  - destruct (Key (-1 - (value x - B ^ size x)) ltac:(lia)) as [K1 K2]. split; auto. rewrite K2. lia.
  - rewrite Z.sub_0_r in *. destruct (Key (value x) ltac:(lia)) as [K1 K2]. split; auto. rewrite K2. lia.
Qed.

(** long_integer::bit_length of a trimmed number: one of the last two words determines it. *)
Definition long_bit_length (x : list Z) : Z :=
  let invert := sign_word x in
  let at_last := (length x - (if (1 <? size x)%Z && (last x 0 =? invert)%Z then 2 else 1))%nat in
  64 * Z.of_nat at_last + bit_width (Z.lxor (nth at_last x 0) invert).
Theorem long_bit_length_exact x n : words x -> x <> [] -> SparseProduct.trimmed x -> 0 <= n ->
  0 <= long_bit_length x /\ (long_bit_length x <= n <-> - 2 ^ n <= signed x < 2 ^ n).
Proof.
  intros W N T P. enough (E : long_bit_length x = bit_length x) by (rewrite E; now apply bit_length_exact).
  unfold long_bit_length, bit_length. cbv zeta. set (invert := sign_word x).
  assert (I : invert = if negative x then B - 1 else 0) by reflexivity. clearbody invert.
  destruct (exists_last N) as (y & w & ->). rewrite last_last, rev_app_distr, app_length.
  cbn [rev app length_from_last length]. rewrite rev_length.
  unfold SparseProduct.trimmed in T. rewrite last_last, removelast_last, app_length in T. cbn [length] in T.
  assert (X : Z.lxor w invert = 0 <-> w = invert).
  { split; [apply Z.lxor_eq | intros ->; apply Z.lxor_nilpotent]. }
  destruct (Z.eqb_spec w invert) as [E | E].
  2: { rewrite andb_false_r. destruct (Z.eqb_spec (Z.lxor w invert) 0) as [Z0 |]; [now apply X in Z0 |].
       rewrite app_nth2 by lia. replace (length y + 1 - 1 - length y)%nat with 0%nat by lia. cbn [nth].
       now replace (length y + 1 - 1)%nat with (length y) by lia. }
  apply X in E. rewrite E, Z.eqb_refl, andb_true_r. apply X in E. clear X.
  destruct y as [| u z _] using rev_ind.
  { cbn [app nth length Nat.add Nat.sub]. now rewrite E, Z.lxor_nilpotent. }
  rewrite app_length in *. cbn [length] in *. replace (1 <? Z.of_nat (length z + 1 + 1)) with true by (symmetry; apply Z.ltb_lt; lia).
  replace (length z + 1 + 1 - 2)%nat with (length z) by lia. rewrite <- app_assoc, app_nth2, Nat.sub_diag by lia.
  rewrite rev_app_distr. cbn [rev app nth length_from_last]. rewrite rev_length.
  destruct (Z.eqb_spec (Z.lxor u invert) 0) as [Z0 |]; [| reflexivity]. exfalso. apply Z.lxor_eq in Z0. subst u.
  destruct T as [T | T]; [lia |]. apply T. rewrite E. unfold sign_word, negative. rewrite last_last.
  rewrite I. destruct (negative ((z ++ [invert]) ++ [w])); reflexivity.
Qed.

(** long_integer(magnitude, shift, negative) before it is trimmed; whole < n. *)
Definition long_shifted (magnitude shift : Z) (negative : bool) (n : nat) : list Z :=
  let whole := Z.to_nat (shift / 64) in
  let upper := map (shifted_word magnitude shift) (seq whole (n - whole)) in
  let inverted := if negative then map (fun w => Z.lxor w (B - 1)) upper else upper in
  zeros whole ++ fst (stepped add_with_carry inverted (zeros (length upper)) (if negative then 1 else 0)).
Lemma seq_from a n : seq a n = map (Nat.add a) (seq 0 n).
Proof.
  revert a. induction n as [| n IH]; intros a; [reflexivity |]. cbn [seq map]. rewrite Nat.add_0_r. f_equal.
  rewrite (IH (S a)), (IH 1%nat), map_map. apply map_ext. intros. lia.
Qed.
Lemma inverted_value x : words x ->
  words (map (fun w => Z.lxor w (B - 1)) x) /\ value (map (fun w => Z.lxor w (B - 1)) x) = B ^ size x - 1 - value x.
Proof.
  induction 1 as [| w x H W [IH1 IH2]]; [split; [constructor | reflexivity] |]. cbn [map value length].
  rewrite IH2, inverted, Nat2Z.inj_succ, Z.pow_succ_r by (auto; lia). split; [| ring].
  constructor; [| exact IH1]. unfold word in *. lia.
Qed.
Theorem long_shifted_exact magnitude shift (negative : bool) n : word magnitude -> 0 <= shift -> shift / 64 < Z.of_nat n ->
  let z := (if negative then -1 else 1) * (magnitude * 2 ^ shift) in
  fits n z -> signed (long_shifted magnitude shift negative n) = z.
Proof.
  intros M P L z F. assert (D := Z.div_mod shift 64 ltac:(lia)). assert (R := Z.mod_pos_bound shift 64 ltac:(lia)).
  assert (W0 : 0 <= shift / 64) by (apply Z.div_pos; lia). unfold long_shifted. cbv zeta.
  set (whole := Z.to_nat (shift / 64)). set (k := (n - whole)%nat).
  set (upper := map (shifted_word magnitude shift) (seq whole k)).
  assert (E : upper = words_of k (magnitude * 2 ^ (shift mod 64))).
  { unfold upper, words_of. rewrite seq_from, map_map. apply map_ext. intros i.
    rewrite shifted_word_right by auto. f_equal. rewrite Nat2Z.inj_add, Z.pow_add_r by lia.
    rewrite <- Z.div_div by (try apply power_positive; generalize (power_positive whole); lia). f_equal.
    rewrite D at 1. rewrite Z.pow_add_r by lia. unfold whole, base. rewrite Z2Nat.id, <- Z.pow_mul_r by lia.
    rewrite Z.mul_assoc, (Z.mul_comm magnitude), <- Z.mul_assoc, (Z.mul_comm (2 ^ _)).
    apply Z.div_mul, Z.pow_nonzero; lia. }
  destruct (words_of_words k (magnitude * 2 ^ (shift mod 64))) as [Wu Lu]. assert (Vu := words_of_value k (magnitude * 2 ^ (shift mod 64))).
  rewrite <- E in *. clearbody upper. clear E.
  assert (Pw : B ^ Z.of_nat whole * 2 ^ (shift mod 64) = 2 ^ shift).
  { unfold base, whole. rewrite Z2Nat.id, <- Z.pow_mul_r, <- Z.pow_add_r by lia. f_equal. lia. }
  assert (Pn : B ^ Z.of_nat n = B ^ Z.of_nat whole * B ^ Z.of_nat k) by (rewrite <- Z.pow_add_r by lia; f_equal; lia).
  set (q := magnitude * 2 ^ (shift mod 64)) in *.
  assert (Ez : z = (if negative then -1 else 1) * (B ^ Z.of_nat whole * q)) by (unfold z, q; rewrite <- Pw; ring).
  assert (Dq := Z.div_mod q (B ^ Z.of_nat k) ltac:(generalize (power_positive k); lia)). rewrite <- Vu in Dq.
  assert (I : exists x c, (if negative then map (fun w => Z.lxor w (B - 1)) upper else upper) = x /\ words x /\ length x = k /\
    (if negative then 1 else 0) = c /\ 0 <= c <= 1 /\
    (value x + c = if negative then B ^ Z.of_nat k - value upper else value upper)).
  { destruct (inverted_value upper Wu) as [I1 I2]. rewrite Lu in I2. destruct negative; eexists _, _;
      (split; [reflexivity |]); repeat split; try lia; auto; now rewrite ?map_length. }
  destruct I as (x & c & -> & Wx & Lx & -> & C & V).
  assert (Lz : length x = length (zeros (length upper))) by (rewrite length_zeros; congruence).
  generalize (stepped_sum x (zeros (length upper)) c Lz Wx (words_zeros _) C)
    (stepped_length add_with_carry x (zeros (length upper)) c Lz).
  destruct (stepped add_with_carry x (zeros (length upper)) c) as [r c']. cbn [fst]. intros (Wr & _ & Er) Lr.
  rewrite value_zeros, Lx in Er.
  assert (Lt : length (zeros whole ++ r) = n) by (rewrite app_length, length_zeros; lia).
  apply signed_is with (k := (if negative then 1 + q / B ^ Z.of_nat k - c' else - (q / B ^ Z.of_nat k) - c')); auto.
  - apply words_app; auto using words_zeros.
  - intros Z0. rewrite Z0 in Lt. simpl in Lt. lia.
  - now rewrite Lt.
  - rewrite Lt, value_app, value_zeros, length_zeros, Ez, Pn. set (e := q / B ^ Z.of_nat k) in *. clearbody e q.
    rewrite Dq. replace (value r) with (value x + c - B ^ Z.of_nat k * c') by lia. rewrite V. destruct negative; ring.
Qed.
