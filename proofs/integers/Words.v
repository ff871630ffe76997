(** Integers of the exact stages (include/errbound/integers/fixed_integer.hpp, long_integer.hpp): two's complement
    numbers of 64-bit words, the least significant first. Exact over the integers. Results, for words:
        add_with_carry_exact, subtract_with_borrow_exact   the word and the carry are those of the exact sum
        add_multiple_exact      r + a b is the resulting words and the carry; no step overflows 128 bits
        sum_exact, difference_exact   for n words, right if the result fits n words
        product_exact           the product of m and n words, in m + n words; always right
        shift_exact             x 2^bits, if it fits; sign_exact, compare_exact   signs and order
        trim_exact, long_sum_exact, long_difference_exact   for numbers of any length: removed words are sign
            extensions, and one word more than the longer number suffices
        signed_words_exact      the sum of the signed words into which sparse products split a number *)

From Coq Require Import ZArith List Lia Bool.
Import ListNotations.
Open Scope Z_scope.

Definition base : Z := 2 ^ 64.
Notation B := base.
Lemma B_positive : 0 < B.
Proof. reflexivity. Qed.
Lemma B_large : 4 <= B.
Proof. now vm_compute. Qed.

Definition word (w : Z) : Prop := 0 <= w < B.
Definition words (x : list Z) : Prop := Forall word x.
Fixpoint value (x : list Z) : Z :=
  match x with [] => 0 | w :: x => w + B * value x end.
Notation size x := (Z.of_nat (length x)).

(** The first bit set: the number is negative. *)
Definition negative (x : list Z) : bool := B / 2 <=? last x 0.
Definition signed (x : list Z) : Z :=
  value x - (if negative x then B ^ size x else 0).
Definition fits (n : nat) (z : Z) : Prop := - B ^ Z.of_nat n <= 2 * z < B ^ Z.of_nat n.

(** The code. Double words are computed modulo 2^128. *)
Definition add_with_carry (a b carry : Z) : Z * Z :=
  let sum := (a + b + carry) mod (B * B) in (sum mod B, sum / B).
Definition subtract_with_borrow (a b borrow : Z) : Z * Z :=
  let difference := (a - b - borrow) mod (B * B) in (difference mod B, (difference / B) mod 2).
Fixpoint stepped (step : Z -> Z -> Z -> Z * Z) (a b : list Z) (carry : Z) : list Z * Z :=
  match a, b with
  | x :: a, y :: b =>
      let (w, c) := step x y carry in let (r, c') := stepped step a b c in (w :: r, c')
  | _, _ => ([], carry)
  end.
Definition sum (a b : list Z) : list Z := fst (stepped add_with_carry a b 0).
Definition difference (a b : list Z) : list Z := fst (stepped subtract_with_borrow a b 0).

(** r + a b in the words of b, and the carry beyond. *)
Fixpoint add_multiple (r : list Z) (a : Z) (b : list Z) (carry : Z) : list Z * Z :=
  match r, b with
  | x :: r, y :: b =>
      let s := ((a * y + x) mod (B * B) + carry) mod (B * B) in
      let (t, c) := add_multiple r a b (s / B) in (s mod B :: t, c)
  | _, _ => ([], carry)
  end.
Definition zeros (n : nat) : list Z := repeat 0 n.
(** Row by row: `r` has the words from position i on; the first is final after its row. *)
Fixpoint unsigned_product (r : list Z) (a b : list Z) : list Z :=
  match a with
  | [] => r
  | x :: a =>
      let (s, carry) := add_multiple r x b 0 in
      match s ++ [carry] with
      | w :: s => w :: unsigned_product s a b
      | [] => []
      end
  end.
(** Words from position n on, minus those of b if `if_`. *)
Definition subtract_from (n : nat) (r b : list Z) (if_ : bool) : list Z :=
  firstn n r ++ difference (skipn n r) (if if_ then b else zeros (length b)).
Definition product (a b : list Z) : list Z :=
  let r := unsigned_product (zeros (length b)) a b in
  let r := subtract_from (length a) r b (negative a) in
  subtract_from (length b) r a (negative b).

Lemma value_bounds x : words x -> 0 <= value x < B ^ size x.
Proof.
  induction 1 as [| w x W H IH]; [simpl; lia |].
  cbn [value length]. rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia. unfold word in W. nia.
Qed.
Lemma power_positive n : 0 < B ^ Z.of_nat n.
Proof. apply Z.pow_pos_nonneg; [exact B_positive | lia]. Qed.
Lemma value_app x y : value (x ++ y) = value x + B ^ size x * value y.
Proof.
  induction x as [| w x IH]; [cbn [app value length]; simpl (B ^ _); lia |].
  cbn [app value length]. rewrite IH, Nat2Z.inj_succ, Z.pow_succ_r by lia. ring.
Qed.
Lemma value_zeros n : value (zeros n) = 0.
Proof. unfold zeros. induction n as [| n IH]; cbn [repeat value]; lia. Qed.
Lemma words_zeros n : words (zeros n).
Proof. induction n; constructor; auto. unfold word. generalize B_positive. lia. Qed.
Lemma words_app x y : words x -> words y -> words (x ++ y).
Proof. intros. now apply Forall_app. Qed.
Lemma length_zeros n : length (zeros n) = n.
Proof. apply repeat_length. Qed.

Theorem add_with_carry_exact a b carry : word a -> word b -> 0 <= carry <= 1 ->
  let (w, c) := add_with_carry a b carry in
  word w /\ 0 <= c <= 1 /\ w + B * c = a + b + carry.
Proof.
  unfold word, add_with_carry. intros A D C. generalize B_large; intros P.
  cbv zeta. rewrite (Z.mod_small (a + b + carry) (B * B)) by nia.
  generalize (Z.div_mod (a + b + carry) B) (Z.mod_pos_bound (a + b + carry) B).
  intros H1 H2. split; [lia |]. split; [| lia]. split.
  - apply Z.div_pos; lia.
  - assert ((a + b + carry) / B < 2); [| lia]. apply Z.div_lt_upper_bound; lia.
Qed.
Theorem subtract_with_borrow_exact a b borrow : word a -> word b -> 0 <= borrow <= 1 ->
  let (w, c) := subtract_with_borrow a b borrow in
  word w /\ 0 <= c <= 1 /\ w - B * c = a - b - borrow.
Proof.
  unfold word, subtract_with_borrow. intros A D C. generalize B_large; intros P.
  set (d := a - b - borrow). assert (E : d mod (B * B) = if d <? 0 then d + B * B else d).
  { destruct (Z.ltb_spec d 0).
    - rewrite <- (Z.mod_add d 1) by nia. apply Z.mod_small. nia.
    - apply Z.mod_small. nia. }
  rewrite E. destruct (Z.ltb_spec d 0) as [L | L].
  - replace (d + B * B) with (d + B + (B - 1) * B) by ring.
    rewrite Z.mod_add, Z.div_add, (Z.mod_small (d + B)), (Z.div_small (d + B)) by lia.
    replace ((0 + (B - 1)) mod 2) with 1 by reflexivity. lia.
  - rewrite (Z.mod_small d), (Z.div_small d) by (unfold d in *; lia). change (0 mod 2) with 0.
    unfold d in *. lia.
Qed.

Lemma stepped_length step a b c : length a = length b ->
  length (fst (stepped step a b c)) = length a.
Proof.
  revert b c. induction a as [| x a IH]; destruct b as [| y b]; try easy. simpl. intros c H.
  destruct (step x y c) as [w d]. specialize (IH b d). destruct (stepped step a b d).
  simpl in *. rewrite IH; lia.
Qed.
(** A step of a sum, s = 1, or of a difference, s = -1. *)
Definition steps (step : Z -> Z -> Z -> Z * Z) (s : Z) : Prop :=
  forall a b c, word a -> word b -> 0 <= c <= 1 ->
  let (w, c') := step a b c in word w /\ 0 <= c' <= 1 /\ w + s * (B * c') = a + s * (b + c).
Lemma add_steps : steps add_with_carry 1.
Proof.
  intros a b c A D C. generalize (add_with_carry_exact a b c A D C). destruct (add_with_carry a b c). intuition lia.
Qed.
Lemma subtract_steps : steps subtract_with_borrow (-1).
Proof.
  intros a b c A D C. generalize (subtract_with_borrow_exact a b c A D C). destruct (subtract_with_borrow a b c).
  intuition lia.
Qed.
Lemma stepped_exact step s : steps step s -> forall a b c, length a = length b -> words a -> words b -> 0 <= c <= 1 ->
  let (r, c') := stepped step a b c in
  words r /\ 0 <= c' <= 1 /\ value r + s * (B ^ size a * c') = value a + s * (value b + c).
Proof.
  intros Step a. induction a as [| x a IH]; destruct b as [| y b]; try easy.
  - intros c _ _ _ C. cbn [stepped length value]. change (B ^ Z.of_nat 0) with 1.
    split; [constructor | lia].
  - intros c L Wa Wb C. inversion_clear Wa as [| ? ? X A]. inversion_clear Wb as [| ? ? Y D].
    cbn [stepped]. generalize (Step x y c X Y C).
    destruct (step x y c) as [w d]. intros (W & Hd & E).
    specialize (IH b d ltac:(simpl in L; lia) A D Hd).
    destruct (stepped step a b d) as [r c']. destruct IH as (R & Hc & F).
    split; [now constructor |]. split; auto. cbn [value length].
    rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia. nia.
Qed.

Lemma stepped_sum a b c : length a = length b -> words a -> words b -> 0 <= c <= 1 ->
  let (r, c') := stepped add_with_carry a b c in
  words r /\ 0 <= c' <= 1 /\ value r + B ^ size a * c' = value a + value b + c.
Proof.
  intros L A D C. generalize (stepped_exact _ _ add_steps a b c L A D C). destruct (stepped _ a b c).
  intuition lia.
Qed.
Lemma stepped_difference a b c : length a = length b -> words a -> words b -> 0 <= c <= 1 ->
  let (r, c') := stepped subtract_with_borrow a b c in
  words r /\ 0 <= c' <= 1 /\ value r - B ^ size a * c' = value a - value b - c.
Proof.
  intros L A D C. generalize (stepped_exact _ _ subtract_steps a b c L A D C). destruct (stepped _ a b c).
  intuition lia.
Qed.

(** Two's complement: among numbers that are equal modulo B^n, the one that fits n words. *)
Lemma negative_spec x : words x -> x <> [] ->
  if negative x then B ^ size x <= 2 * value x else 2 * value x < B ^ size x.
Proof.
  intros W N. destruct (exists_last N) as (y & w & ->). unfold negative. rewrite last_last.
  apply Forall_app in W. destruct W as [Wy Ww]. inversion_clear Ww as [| ? ? Hw _].
  generalize (value_bounds y Wy). intros Y. rewrite value_app, app_length. cbn [length value].
  replace (Z.of_nat (length y + 1)) with (Z.succ (size y)) by lia. rewrite Z.pow_succ_r by lia.
  assert (H : B = 2 * (B / 2)) by reflexivity. generalize (power_positive (length y)).
  destruct (Z.leb_spec (B / 2) w); nia.
Qed.
Lemma signed_fits x : words x -> x <> [] -> fits (length x) (signed x).
Proof.
  intros W N. generalize (negative_spec x W N) (value_bounds x W). unfold fits, signed.
  destruct (negative x); lia.
Qed.
Lemma signed_modulo x : exists k, signed x = value x + k * B ^ size x.
Proof. unfold signed. destruct (negative x); [exists (-1) | exists 0]; ring. Qed.
Lemma fits_unique n x y k : fits n x -> fits n y -> x = y + k * B ^ Z.of_nat n -> x = y.
Proof. unfold fits. intros X Y E. generalize (power_positive n). intros P. assert (k = 0) by nia. nia. Qed.
Lemma signed_is x z k : words x -> x <> [] -> fits (length x) z ->
  value x = z + k * B ^ size x -> signed x = z.
Proof.
  intros W N F E. destruct (signed_modulo x) as [j J].
  apply (fits_unique (length x) _ _ (j + k)); auto using signed_fits. rewrite J, E. ring.
Qed.

Lemma stepped_signed step s a b : steps step s -> length a = length b -> a <> [] -> words a -> words b ->
  fits (length a) (signed a + s * signed b) -> signed (fst (stepped step a b 0)) = signed a + s * signed b.
Proof.
  intros Step L N A D F. generalize (stepped_exact step s Step a b 0 L A D ltac:(lia)) (stepped_length step a b 0 L).
  destruct (stepped step a b 0) as [r c]. intros (R & _ & E) Lr. simpl in *.
  destruct (signed_modulo a) as [i I], (signed_modulo b) as [j J]. rewrite <- L in J.
  apply signed_is with (k := - (s * c + i + s * j)); auto.
  - destruct r; [destruct a |]; easy.
  - now rewrite Lr.
  - rewrite Lr, I, J. lia.
Qed.
Theorem sum_exact a b : length a = length b -> a <> [] -> words a -> words b ->
  fits (length a) (signed a + signed b) -> signed (sum a b) = signed a + signed b.
Proof. rewrite <- (Z.mul_1_l (signed b)). now apply stepped_signed, add_steps. Qed.
Theorem difference_exact a b : length a = length b -> a <> [] -> words a -> words b ->
  fits (length a) (signed a - signed b) -> signed (difference a b) = signed a - signed b.
Proof.
  replace (signed a - signed b) with (signed a + -1 * signed b) by ring. now apply stepped_signed, subtract_steps.
Qed.

Theorem add_multiple_exact r a b carry : length r = length b -> words r -> words b -> word a ->
  word carry ->
  let (s, c) := add_multiple r a b carry in
  length s = length r /\ words s /\ word c /\
  value s + B ^ size r * c = value r + a * value b + carry.
Proof.
  revert b carry. induction r as [| x r IH]; destruct b as [| y b]; try easy.
  - intros carry _ _ _ _ C. cbn [add_multiple length value]. change (B ^ Z.of_nat 0) with 1.
    split; [easy |]. split; [constructor |]. split; [exact C | lia].
  - intros carry L R D A C. inversion_clear R as [| ? ? X R']. inversion_clear D as [| ? ? Y D'].
    cbn [add_multiple]. unfold word in A, C, X, Y.
    cbv zeta. rewrite (Z.mod_small (a * y + x) (B * B)) by nia.
    rewrite (Z.mod_small (a * y + x + carry) (B * B)) by nia.
    set (s := a * y + x + carry). generalize B_positive; intros P.
    assert (S : 0 <= s < B * B) by (unfold s; nia).
    assert (Q : word (s / B)).
    { split; [apply Z.div_pos; lia | apply Z.div_lt_upper_bound; lia]. }
    specialize (IH b (s / B) ltac:(simpl in L; lia) R' D' A Q).
    destruct (add_multiple r a b (s / B)) as [t c]. destruct IH as (L' & T & W & E).
    generalize (Z.div_mod s B) (Z.mod_pos_bound s B). intros M M'.
    split; [simpl; lia |]. split; [constructor; [unfold word; lia | auto] |]. split; auto.
    cbn [value length]. rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia.
    assert (s = B * (s / B) + s mod B) by lia. unfold s in *. nia.
Qed.

Lemma unsigned_product_exact r a b : length r = length b -> b <> [] -> words r -> words a -> words b ->
  length (unsigned_product r a b) = (length a + length b)%nat /\
  words (unsigned_product r a b) /\
  value (unsigned_product r a b) = value r + value a * value b.
Proof.
  intros L N. revert r L. induction a as [| x a IH]; intros r L R A D.
  - simpl. repeat split; auto. lia.
  - inversion_clear A as [| ? ? X A']. cbn [unsigned_product].
    generalize (add_multiple_exact r x b 0 L R D X ltac:(unfold word; generalize B_positive; lia)).
    destruct (add_multiple r x b 0) as [s c]. intros (Ls & S & C & E).
    destruct s as [| w s]; [destruct r; [destruct b |]; easy |].
    inversion_clear S as [| ? ? W S']. cbn [app].
    destruct (IH (s ++ [c])) as (I1 & I2 & I3); auto.
    + rewrite app_length. simpl in *. lia.
    + apply words_app; auto. repeat constructor; auto; apply C.
    + split; [cbn [length]; lia |]. split; [now constructor |].
      cbn [value]. rewrite I3, value_app. cbn [value length] in *.
      rewrite <- Ls in E. rewrite Nat2Z.inj_succ, Z.pow_succ_r in E by lia. nia.
Qed.

(** Subtracting a number from all words except the first n changes a value by B^n times it, modulo the width. *)
Lemma subtract_from_exact n r b if_ : words r -> words b -> (n + length b = length r)%nat ->
  length (subtract_from n r b if_) = length r /\ words (subtract_from n r b if_) /\
  exists k, value (subtract_from n r b if_) =
            value r - B ^ Z.of_nat n * (if if_ then value b else 0) + k * B ^ size r.
Proof.
  intros R D L. unfold subtract_from.
  set (d := if if_ then b else zeros (length b)).
  assert (Ld : length d = length b) by (unfold d; destruct if_; auto using length_zeros).
  assert (Wd : words d) by (unfold d; destruct if_; auto using words_zeros).
  assert (Vd : value d = if if_ then value b else 0) by (unfold d; destruct if_; auto using value_zeros).
  rewrite <- Vd. assert (Ls : length (skipn n r) = length d) by (rewrite skipn_length; lia).
  assert (F : words (firstn n r) /\ words (skipn n r)).
  { apply Forall_app. rewrite firstn_skipn. exact R. }
  unfold difference.
  generalize (stepped_difference _ d 0 Ls (proj2 F) Wd ltac:(lia))
    (stepped_length subtract_with_borrow _ d 0 Ls).
  destruct (stepped subtract_with_borrow (skipn n r) d 0) as [s c]. intros (S & _ & E) Lr. simpl in *.
  assert (Lf : length (firstn n r) = n) by (rewrite firstn_length; lia).
  split; [rewrite app_length; lia |]. split; [apply words_app; tauto |].
  exists c. rewrite value_app, Lf. rewrite <- (firstn_skipn n r) at 2. rewrite value_app, Lf.
  replace (size r) with (Z.of_nat n + size (skipn n r)) by lia. rewrite Z.pow_add_r by lia. nia.
Qed.

Lemma product_fits m n x y : fits m x -> fits n y -> fits (m + n) (x * y).
Proof.
  unfold fits. rewrite Nat2Z.inj_add, Z.pow_add_r by lia. generalize (power_positive m) (power_positive n).
  set (M := B ^ Z.of_nat m). set (N := B ^ Z.of_nat n). intros PM PN FX FY.
  assert (Q : Z.abs (2 * x) * Z.abs (2 * y) <= M * N) by (apply Z.mul_le_mono_nonneg; lia).
  rewrite <- Z.abs_mul in Q. replace (2 * x * (2 * y)) with (4 * (x * y)) in Q by ring.
  assert (0 < M * N) by (apply Z.mul_pos_pos; lia). lia.
Qed.
Theorem product_exact a b : a <> [] -> b <> [] -> words a -> words b ->
  signed (product a b) = signed a * signed b.
Proof.
  intros Na Nb A D. unfold product.
  destruct (unsigned_product_exact (zeros (length b)) a b (length_zeros _) Nb (words_zeros _) A D)
    as (L1 & W1 & E1). rewrite value_zeros in E1.
  set (r := unsigned_product (zeros (length b)) a b) in *.
  destruct (subtract_from_exact (length a) r b (negative a) W1 D) as (L2 & W2 & k & E2); [lia |].
  set (s := subtract_from (length a) r b (negative a)) in *.
  destruct (subtract_from_exact (length b) s a (negative b) W2 A) as (L3 & W3 & j & E3); [lia |].
  set (t := subtract_from (length b) s a (negative b)) in *.
  assert (Lt : length t = (length a + length b)%nat) by lia.
  assert (P : B ^ size t = B ^ size a * B ^ size b).
  { rewrite Lt, Nat2Z.inj_add, Z.pow_add_r by lia. reflexivity. }
  apply signed_is with
    (k := k + j - (if negative a then 1 else 0) * (if negative b then 1 else 0)); auto.
  - destruct t; [| easy]. simpl in Lt. destruct a; easy.
  - rewrite Lt. now apply product_fits; apply signed_fits.
  - rewrite E3, E2, E1. rewrite L2, L1, Nat2Z.inj_add, Z.pow_add_r by lia. rewrite P. unfold signed.
    destruct (negative a), (negative b); ring.
Qed.
Lemma product_words a b : b <> [] -> words a -> words b ->
  words (product a b) /\ length (product a b) = (length a + length b)%nat.
Proof.
  intros N A D. unfold product.
  destruct (unsigned_product_exact (zeros (length b)) a b (length_zeros _) N (words_zeros _) A D) as (L1 & W1 & _).
  destruct (subtract_from_exact (length a) _ b (negative a) W1 D) as (L2 & W2 & _); [lia |].
  destruct (subtract_from_exact (length b) _ a (negative b) W2 A) as (L3 & W3 & _); [lia |].
  split; [exact W3 | lia].
Qed.

(** Sign and order. *)
Definition sign_of (x : list Z) : comparison :=
  if negative x then Lt else if forallb (Z.eqb 0) x then Eq else Gt.
Lemma value_zero x : words x -> forallb (Z.eqb 0) x = (value x =? 0).
Proof.
  induction 1 as [| w x W H IH]; auto. cbn [forallb value]. rewrite IH.
  generalize (value_bounds x H) B_positive. unfold word in W. intros.
  destruct (Z.eqb_spec 0 w), (Z.eqb_spec (value x) 0), (Z.eqb_spec (w + B * value x) 0); simpl; nia.
Qed.
Theorem sign_exact x : words x -> x <> [] -> sign_of x = (signed x ?= 0).
Proof.
  intros W N. unfold sign_of. generalize (signed_fits x W N) (negative_spec x W N) (value_bounds x W).
  unfold fits, signed. rewrite value_zero by auto. destruct (negative x); intros F S V.
  - symmetry. apply Z.compare_lt_iff. lia.
  - rewrite Z.sub_0_r. destruct (Z.eqb_spec (value x) 0) as [-> |]; auto.
    symmetry. apply Z.compare_gt_iff. lia.
Qed.

(** From the last word on, with its first bit inverted. *)
Fixpoint compare_from_last (x y : list Z) (first : bool) : comparison :=
  match x, y with
  | a :: x, b :: y =>
      let inverted w := if first then (w + B / 2) mod B else w in
      if a =? b then compare_from_last x y false else inverted a ?= inverted b
  | _, _ => Eq
  end.
Definition compare (x y : list Z) : comparison := compare_from_last (rev x) (rev y) true.

Lemma compare_unsigned x y : length x = length y -> words x -> words y ->
  compare_from_last (rev x) (rev y) false = (value x ?= value y).
Proof.
  revert y. induction x as [| a x IH] using rev_ind; intros y L X Y.
  - destruct y; easy.
  - destruct y as [| b y _] using rev_ind; [rewrite app_length in L; simpl in L; lia |].
    rewrite !app_length in L. simpl in L. assert (L' : length x = length y) by lia.
    rewrite !rev_app_distr. cbn [rev app compare_from_last].
    apply Forall_app in X, Y. destruct X as [X A], Y as [Y C].
    inversion_clear A as [| ? ? A' _]. inversion_clear C as [| ? ? C' _].
    rewrite !value_app, <- L'. cbn [value]. generalize (value_bounds x X) (value_bounds y Y).
    rewrite <- L'. intros Vx Vy. generalize (power_positive (length x)). intros P.
    destruct (Z.eqb_spec a b) as [<- | D].
    + rewrite IH by auto. rewrite (Z.add_comm (value x)), (Z.add_comm (value y)).
      symmetry. apply Z.add_compare_mono_l.
    + destruct (Z.compare_spec a b) as [| S | S]; [easy | symmetry ..].
      * apply Z.compare_lt_iff. nia.
      * apply Z.compare_gt_iff. nia.
Qed.
Theorem compare_exact x y : length x = length y -> words x -> words y ->
  compare x y = (signed x ?= signed y).
Proof.
  unfold compare. intros L X Y.
  destruct x as [| a x _] using rev_ind; [destruct y; easy |].
  destruct y as [| b y _] using rev_ind; [rewrite app_length in L; simpl in L; lia |].
  rewrite !app_length in L. simpl in L. assert (L' : length x = length y) by lia.
  rewrite !rev_app_distr. cbn [rev app compare_from_last].
  unfold signed, negative. rewrite !last_last, !app_length, <- L'. cbn [length].
  apply Forall_app in X, Y. destruct X as [X A], Y as [Y C].
  inversion_clear A as [| ? ? A' _]. inversion_clear C as [| ? ? C' _]. unfold word in A', C'.
  rewrite !value_app, <- L'. cbn [value]. generalize (value_bounds x X) (value_bounds y Y).
  rewrite <- L'. intros Vx Vy. generalize (power_positive (length x)). intros P.
  replace (Z.of_nat (length x + 1)) with (Z.succ (size x)) by lia. rewrite Z.pow_succ_r by lia.
  set (M := B ^ size x) in *. set (h := B / 2). assert (H : B = 2 * h) by reflexivity.
  assert (I : forall w, 0 <= w < B -> (w + h) mod B = if h <=? w then w - h else w + h).
  { intros w Hw. destruct (Z.leb_spec h w).
    - replace (w + h) with (w - h + 1 * B) by lia. rewrite Z.mod_add by lia.
      apply Z.mod_small. lia.
    - apply Z.mod_small. lia. }
  destruct (Z.eqb_spec a b) as [<- | D].
  - rewrite compare_unsigned by auto.
    destruct (Z.leb_spec h a); destruct (Z.compare_spec (value x) (value y)) as [E | E | E];
      symmetry; rewrite ?E; apply Z.compare_eq_iff || apply Z.compare_lt_iff || apply Z.compare_gt_iff; nia.
  - rewrite !I by auto.
    destruct (Z.leb_spec h a), (Z.leb_spec h b);
      match goal with |- (?u ?= ?v) = _ => destruct (Z.compare_spec u v) as [E | E | E] end;
      try lia; symmetry; apply Z.compare_lt_iff || apply Z.compare_gt_iff; nia.
Qed.

(** x << bits. *)
Fixpoint shift_words (previous : Z) (x : list Z) (bits : Z) : list Z :=
  match x with
  | [] => []
  | w :: x => Z.lor (w * 2 ^ bits mod B) (previous / 2 ^ (64 - bits)) :: shift_words w x bits
  end.
Definition shifted (x : list Z) (bits : Z) : list Z :=
  if bits =? 0 then x else shift_words 0 x bits.

(** For bits that do not overlap, "or" is addition. *)
Lemma or_is_sum high low n : 0 <= n -> 0 <= low < 2 ^ n -> Z.lor (high * 2 ^ n) low = high * 2 ^ n + low.
Proof.
  intros N L. assert (E : Z.land (high * 2 ^ n) low = 0).
  { destruct (Z.eq_dec low 0) as [-> | D]; [apply Z.land_0_r |].
    apply Z.bits_inj'. intros i I. rewrite Z.land_spec, Z.bits_0.
    destruct (Z.ltb_spec i n).
    - now rewrite Z.mul_pow2_bits_low by lia.
    - rewrite andb_comm, (Z.bits_above_log2 low); auto; try lia.
      apply Z.log2_lt_pow2; try lia.
      apply Z.lt_le_trans with (2 ^ n); [lia | apply Z.pow_le_mono_r; lia]. }
  now rewrite <- Z.lxor_lor, <- Z.add_nocarry_lxor.
Qed.
Lemma split_power bits : 0 < bits < 64 -> B = 2 ^ (64 - bits) * 2 ^ bits.
Proof. intros H. rewrite <- Z.pow_add_r by lia. now replace (64 - bits + bits) with 64 by lia. Qed.
Lemma shift_words_value previous x bits : 0 < bits < 64 -> word previous -> words x ->
  length (shift_words previous x bits) = length x /\ words (shift_words previous x bits) /\
  exists k, value (shift_words previous x bits) =
            previous / 2 ^ (64 - bits) + 2 ^ bits * value x + k * B ^ size x.
Proof.
  intros H. revert previous. induction x as [| w x IH]; intros previous P X.
  - split; [easy |]. split; [constructor |]. exists (- (previous / 2 ^ (64 - bits))). simpl. ring.
  - inversion_clear X as [| ? ? W X']. destruct (IH w W X') as (L & V & k & E).
    generalize (split_power bits H). intros S.
    assert (P1 : 0 < 2 ^ bits) by (apply Z.pow_pos_nonneg; lia).
    assert (P2 : 0 < 2 ^ (64 - bits)) by (apply Z.pow_pos_nonneg; lia).
    unfold word in P, W.
    assert (Q : 0 <= previous / 2 ^ (64 - bits) < 2 ^ bits).
    { split; [apply Z.div_pos; lia | apply Z.div_lt_upper_bound; lia]. }
    (* the word's bits that stay, and those that move on *)
    set (h := w / 2 ^ (64 - bits)). set (l := w mod 2 ^ (64 - bits)).
    assert (D : w = 2 ^ (64 - bits) * h + l) by (apply Z.div_mod; lia).
    assert (R : 0 <= l < 2 ^ (64 - bits)) by (apply Z.mod_pos_bound; lia).
    assert (M : (w * 2 ^ bits) mod B = l * 2 ^ bits).
    { replace (w * 2 ^ bits) with (l * 2 ^ bits + h * B) by (rewrite D, S; ring).
      rewrite Z.mod_add by lia. apply Z.mod_small. nia. }
    cbn [shift_words]. rewrite M, or_is_sum by lia.
    split; [cbn [length]; lia |]. split.
    { constructor; auto. unfold word. nia. }
    exists k. cbn [value length]. rewrite E. fold h.
    rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia. clearbody h l. rewrite D.
    replace (2 ^ bits * (2 ^ (64 - bits) * h + l + B * value x))
      with (2 ^ (64 - bits) * 2 ^ bits * h + 2 ^ bits * l + 2 ^ bits * B * value x) by ring.
    rewrite <- S. ring.
Qed.
Theorem shift_exact x bits : 0 <= bits < 64 -> words x -> x <> [] ->
  fits (length x) (signed x * 2 ^ bits) -> signed (shifted x bits) = signed x * 2 ^ bits.
Proof.
  intros H W N F. unfold shifted. destruct (Z.eqb_spec bits 0) as [-> | D]; [simpl; lia |].
  destruct (shift_words_value 0 x bits ltac:(lia) ltac:(unfold word; generalize B_positive; lia) W)
    as (L & V & k & E).
  rewrite Z.div_0_l in E by (apply Z.pow_nonzero; lia).
  destruct (signed_modulo x) as [j J].
  apply signed_is with (k := k - j * 2 ^ bits); auto.
  - destruct (shift_words 0 x bits); [| easy]. destruct x; easy.
  - now rewrite L.
  - rewrite L, E, J. ring.
Qed.

(** long_integer: words beyond the last are sign words. *)
Definition sign_word (x : list Z) : Z := if negative x then B - 1 else 0.
Definition extended (x : list Z) (n : nat) : list Z := x ++ repeat (sign_word x) (n - length x).

Lemma sign_word_word x : word (sign_word x).
Proof. unfold word, sign_word. generalize B_positive. destruct (negative x); lia. Qed.
Theorem trim_exact x : x <> [] -> signed (x ++ [sign_word x]) = signed x.
Proof.
  intros N. unfold signed. rewrite value_app, app_length. cbn [length value].
  replace (Z.of_nat (length x + 1)) with (Z.succ (size x)) by lia. rewrite Z.pow_succ_r by lia.
  assert (E : negative (x ++ [sign_word x]) = negative x).
  { unfold negative at 1. rewrite last_last. unfold sign_word. now destruct (negative x). }
  rewrite E. unfold sign_word. destruct (negative x); ring.
Qed.
Lemma extended_exact x n : x <> [] -> words x -> (length x <= n)%nat ->
  signed (extended x n) = signed x /\ words (extended x n) /\ length (extended x n) = n.
Proof.
  intros N W L. unfold extended.
  assert (R : forall k, signed (x ++ repeat (sign_word x) k) = signed x /\
                        sign_word (x ++ repeat (sign_word x) k) = sign_word x).
  { induction k as [| k' [IH1 IH2]]; [simpl; now rewrite app_nil_r |].
    replace (repeat (sign_word x) (S k')) with (repeat (sign_word x) k' ++ [sign_word x])
      by (rewrite <- repeat_cons; reflexivity).
    rewrite app_assoc. set (y := x ++ repeat (sign_word x) k') in *. rewrite <- IH2. split.
    - rewrite trim_exact; auto. unfold y. intros E. apply app_eq_nil in E. tauto.
    - unfold sign_word at 1, negative at 1. rewrite last_last. unfold sign_word.
      now destruct (negative y). }
  split; [apply R |]. split.
  - apply words_app; auto. apply Forall_forall. intros w I. apply repeat_spec in I. subst.
    apply sign_word_word.
  - rewrite app_length, repeat_length. lia.
Qed.

Definition long_sum (a b : list Z) : list Z :=
  let n := S (Nat.max (length a) (length b)) in sum (extended a n) (extended b n).
Definition long_difference (a b : list Z) : list Z :=
  let n := S (Nat.max (length a) (length b)) in difference (extended a n) (extended b n).
Lemma fits_wider m n x : (m <= n)%nat -> fits m x -> fits n x.
Proof.
  unfold fits. intros L F.
  assert (B ^ Z.of_nat m <= B ^ Z.of_nat n) by (apply Z.pow_le_mono_r; [exact B_positive | lia]). lia.
Qed.
Lemma fits_one_more n x y : fits n x -> fits n y -> fits (S n) (x + y) /\ fits (S n) (x - y).
Proof.
  unfold fits. rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia. generalize B_large (power_positive n).
  intros. nia.
Qed.
Ltac long_exact exact :=
  intros Na Nb A D; match goal with |- signed (?long ?a ?b) = _ => unfold long;
    set (m := Nat.max (length a) (length b));
    destruct (extended_exact a (S m) Na A ltac:(lia)) as (S1 & W1 & L1);
    destruct (extended_exact b (S m) Nb D ltac:(lia)) as (S2 & W2 & L2);
    rewrite exact; auto; [now rewrite S1, S2 | now rewrite L1, L2 | intros E; rewrite E in L1; discriminate |];
    rewrite L1, S1, S2; apply fits_one_more; [apply fits_wider with (length a) | apply fits_wider with (length b)];
    auto using signed_fits; lia
  end.
Theorem long_sum_exact a b : a <> [] -> b <> [] -> words a -> words b ->
  signed (long_sum a b) = signed a + signed b.
Proof. long_exact sum_exact. Qed.
Theorem long_difference_exact a b : a <> [] -> b <> [] -> words a -> words b ->
  signed (long_difference a b) = signed a - signed b.
Proof. long_exact difference_exact. Qed.

(** for_signed_words: the visited signed words and their positions. *)
Fixpoint signed_words (x : list Z) (carry : Z) (i : Z) : list (Z * Z) :=
  match x with
  | [] => []
  | w0 :: x =>
      let w := (w0 + carry) mod B in
      if w =? 0 then signed_words x carry (i + 1)
      else
        let carry := match x with
                     | [] => w0 / 2 ^ 63
                     | next :: _ => if next =? B - 1 then 1 else 0
                     end in
        (i, if carry =? 0 then w else - ((0 - w) mod B)) :: signed_words x carry (i + 1)
  end.
Fixpoint total (visited : list (Z * Z)) : Z :=
  match visited with [] => 0 | (i, w) :: l => w * B ^ i + total l end.

Lemma signed_cons w x : x <> [] -> signed (w :: x) = w + B * signed x.
Proof.
  intros N. unfold signed. cbn [value length]. rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia.
  replace (negative (w :: x)) with (negative x) by (destruct x; easy). destruct (negative x); ring.
Qed.
Lemma first_bit w : word w -> w / 2 ^ 63 = if B / 2 <=? w then 1 else 0.
Proof.
  unfold word. intros W. change (B / 2) with (2 ^ 63). assert (E : B = 2 * 2 ^ 63) by reflexivity.
  destruct (Z.leb_spec (2 ^ 63) w).
  - symmetry. apply Z.div_unique with (w - 2 ^ 63); lia.
  - apply Z.div_small. lia.
Qed.
Theorem signed_words_exact x carry i : words x -> x <> [] -> 0 <= carry <= 1 -> 0 <= i ->
  total (signed_words x carry i) = (signed x + carry) * B ^ i.
Proof.
  revert carry i. induction x as [| w0 x IH]; [easy |]. intros carry i W _ C I.
  inversion_clear W as [| ? ? W0 W']. generalize B_large; intros P.
  assert (M : (w0 + carry) mod B = if w0 + carry =? B then 0 else w0 + carry).
  { unfold word in W0. destruct (Z.eqb_spec (w0 + carry) B) as [-> |].
    - apply Z.mod_same. lia.
    - apply Z.mod_small. lia. }
  assert (V : forall w c, 0 < w < B -> c = 0 \/ c = 1 ->
              (if c =? 0 then w else - ((0 - w) mod B)) = w - c * B).
  { intros w c Hw [-> | ->]; [simpl; lia |]. change (1 =? 0) with false.
    replace (0 - w) with (B - w + (-1) * B) by ring. rewrite Z.mod_add by lia.
    rewrite Z.mod_small by lia. ring. }
  cbn [signed_words]. rewrite M. unfold word in W0.
  destruct x as [| next x].
  - assert (S : signed [w0] = w0 - (if B / 2 <=? w0 then 1 else 0) * B).
    { unfold signed, negative. cbn [last value length]. change (B ^ Z.of_nat 1) with B.
      destruct (B / 2 <=? w0); ring. }
    rewrite S. assert (Half : B = 2 * (B / 2)) by reflexivity.
    destruct (Z.eqb_spec (w0 + carry) B) as [E | E]; [change (0 =? 0) with true |].
    + cbn [signed_words total]. destruct (Z.leb_spec (B / 2) w0); nia.
    + destruct (Z.eqb_spec (w0 + carry) 0) as [Z | Z].
      * cbn [signed_words total]. destruct (Z.leb_spec (B / 2) w0); nia.
      * cbn [signed_words total]. rewrite first_bit by auto.
        rewrite V by (try lia; destruct (B / 2 <=? w0); auto). ring.
  - set (c := if next =? B - 1 then 1 else 0).
    assert (Hc : c = 0 \/ c = 1) by (unfold c; destruct (next =? B - 1); auto).
    rewrite signed_cons by easy.
    assert (Step : forall c', 0 <= c' <= 1 ->
      total (signed_words (next :: x) c' (i + 1)) = (signed (next :: x) + c') * (B ^ i * B)).
    { intros c' H. rewrite IH by (auto; easy || lia). rewrite Z.pow_add_r by lia.
      now rewrite Z.pow_1_r. }
    destruct (Z.eqb_spec (w0 + carry) B) as [E | E]; [change (0 =? 0) with true; cbv iota |].
    + rewrite Step by auto. assert (carry = 1) by lia. assert (w0 = B - 1) by lia. subst. ring.
    + destruct (Z.eqb_spec (w0 + carry) 0) as [Z | Z].
      * rewrite Step by auto. assert (carry = 0) by lia. assert (w0 = 0) by lia. subst. ring.
      * cbn [total]. rewrite V by (auto; lia). rewrite Step by lia. ring.
Qed.
