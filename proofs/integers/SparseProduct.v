(** Products by nonzero words (include/errbound/integers/long_integer.hpp); words as in Words.v. Results:
        sparse_product_exact   multiply_sparse: the product of m and n words, in m + n words
        any_product_exact      multiply_any, by either algorithm
        long_product_exact     long_integer's product, if it fits *)

From Coq Require Import ZArith List Lia Bool.
From Errbound Require Import Words.
Import ListNotations.
Open Scope Z_scope.

(** r - a b in the words of b, and the rest to be subtracted beyond. *)
Fixpoint subtract_multiple (r : list Z) (a : Z) (b : list Z) (carry : Z) : list Z * Z :=
  match r, b with
  | x :: r, y :: b =>
      let product := (a * y + carry) mod (B * B) in
      let difference := (x - product mod B) mod B in
      let carry := (product / B + (if x <? difference then 1 else 0)) mod B in
      let (t, c) := subtract_multiple r a b carry in (difference :: t, c)
  | _, _ => ([], carry)
  end.

(** `r` up to `end`, and `beyond`; one word of the first number, with its position and sign. *)
Definition visit (low : nat) (b : list Z) (state : list Z * Z) (visited : Z * Z) : list Z * Z :=
  let (i, w) := visited in
  let (r, beyond) := state in
  let r := r ++ repeat beyond (Z.to_nat i + length b + 1 - length r) in
  let first := firstn (Z.to_nat i + low) r in
  let sum := skipn (Z.to_nat i + low) r in
  let filled := skipn low b in
  let top := last sum 0 in
  if w <? 0 then
    let (s, carry) := subtract_multiple (removelast sum) (- w) filled 0 in
    (first ++ s ++ [(top - carry) mod B], B - 1)
  else
    let (s, carry) := add_multiple (removelast sum) w filled 0 in
    (first ++ s ++ [(top + carry) mod B], 0).
Fixpoint leading_zeros (b : list Z) : nat :=
  match b with w :: b => if w =? 0 then S (leading_zeros b) else O | [] => O end.
Definition sparse_product (a b : list Z) : list Z :=
  let low := leading_zeros b in
  let (r, beyond) := fold_left (visit low b) (signed_words a 0 0) (zeros low, 0) in
  let r := r ++ repeat beyond (length a + length b - length r) in
  subtract_from (length b) r a (negative b).

(** multiply_any: the number with fewer words that are neither 0 nor all ones goes first. *)
Definition count_filled (x : list Z) : Z :=
  fold_right (fun w count => (if 1 <? (w + 1) mod B then 1 else 0) + count) 0 x.
Definition is_sparse (x : list Z) : bool := 4 * count_filled x <? size x.
Definition not_zero (x : list Z) : bool := (1 <? size x) || negb (hd 0 x =? 0).
Definition any_product (a b : list Z) : list Z :=
  if is_sparse a && not_zero b then sparse_product a b
  else if is_sparse b && not_zero a then sparse_product b a
  else product a b.

Lemma subtract_multiple_exact r a b carry : length r = length b -> words r -> words b -> word a ->
  word carry ->
  let (s, c) := subtract_multiple r a b carry in
  length s = length r /\ words s /\ word c /\
  value s - B ^ size r * c = value r - a * value b - carry.
Proof.
  revert b carry. induction r as [| x r IH]; destruct b as [| y b]; try easy.
  - intros carry _ _ _ _ C. cbn [subtract_multiple length value]. change (B ^ Z.of_nat 0) with 1.
    split; [easy |]. split; [constructor |]. split; [exact C | lia].
  - intros carry L R D A C. inversion_clear R as [| ? ? X R']. inversion_clear D as [| ? ? Y D'].
    cbn [subtract_multiple]. unfold word in A, C, X, Y. generalize B_positive; intros P. cbv zeta.
    rewrite (Z.mod_small (a * y + carry) (B * B)) by nia. set (s := a * y + carry).
    assert (Hs : 0 <= s <= (B - 1) * B) by (unfold s; nia).
    generalize (Z.div_mod s B ltac:(lia)) (Z.mod_pos_bound s B P). set (h := s / B). set (l := s mod B).
    intros Es Hl. assert (Hh : 0 <= h <= B - 1) by (split; [apply Z.div_pos; lia | nia]).
    assert (Hh' : h = B - 1 -> l = 0) by nia.
    set (d := (x - l) mod B). set (c := (h + (if x <? d then 1 else 0)) mod B).
    assert (Q : word d /\ word c /\ d - B * c = x - s).
    { assert (Ed : d = if x <? l then x - l + B else x - l).
      { unfold d. destruct (Z.ltb_spec x l).
        - rewrite <- (Z.mod_add _ 1) by lia. rewrite Z.mod_small; lia.
        - apply Z.mod_small. lia. }
      assert (Ex : (x <? d) = (x <? l)).
      { rewrite Ed. destruct (Z.ltb_spec x l); [apply Z.ltb_lt | apply Z.ltb_ge]; lia. }
      unfold c, word. rewrite Ex, Ed. destruct (Z.ltb_spec x l).
      - rewrite Z.mod_small by lia. nia.
      - rewrite Z.mod_small by lia. nia. }
    clearbody d c. destruct Q as (Wd & Wc & E).
    specialize (IH b c ltac:(simpl in L; lia) R' D' A Wc).
    destruct (subtract_multiple r a b c) as [t c']. destruct IH as (L' & T & W & F).
    split; [simpl; lia |]. split; [now constructor |]. split; auto.
    cbn [value length]. rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia. unfold s in E. nia.
Qed.

Lemma value_repeat_ones n : value (repeat (B - 1) n) = B ^ Z.of_nat n - 1.
Proof.
  induction n as [| n IH]; [reflexivity |]. cbn [repeat value]. rewrite IH, Nat2Z.inj_succ, Z.pow_succ_r by lia. ring.
Qed.
Lemma words_repeat w n : word w -> words (repeat w n).
Proof. intros W. apply Forall_forall. intros v I. now apply repeat_spec in I as ->. Qed.

(** The state is `z`: words up to `end`, and the value of all words beyond. *)
Definition stands_for (state : list Z * Z) (z : Z) : Prop :=
  let (r, beyond) := state in
  words r /\ (beyond = 0 /\ z = value r \/ beyond = B - 1 /\ z = value r - B ^ size r).
Lemma stands_longer r beyond z n : stands_for (r, beyond) z -> stands_for (r ++ repeat beyond n, beyond) z.
Proof.
  intros [W H]. assert (Wb : word beyond) by (unfold word; generalize B_positive; lia). split.
  - apply words_app; auto using words_repeat.
  - rewrite value_app, app_length, repeat_length, Nat2Z.inj_add, Z.pow_add_r by lia.
    destruct H as [[-> ->] | [-> ->]].
    + left. split; auto. fold (zeros n). rewrite value_zeros. ring.
    + right. split; auto. rewrite value_repeat_ones. ring.
Qed.
(** Numbers of n words that are equal modulo 2^(64n). *)
Lemma stands_modulo r (up : bool) z k : words r -> value r = z + k * B ^ size r ->
  (if up then 0 <= z < B ^ size r else - B ^ size r <= z < 0) ->
  stands_for (r, if up then 0 else B - 1) z.
Proof.
  intros W E F. split; auto. generalize (value_bounds r W). intros V. generalize (power_positive (length r)). intros P.
  destruct up; [left | right]; split; auto.
  - assert (k = 0) by nia. nia.
  - assert (k = 1) by nia. nia.
Qed.
Lemma stands_value r beyond z : stands_for (r, beyond) z -> exists k, value r = z + k * B ^ size r.
Proof. intros [_ [[_ ->] | [_ ->]]]; [exists 0 | exists 1]; ring. Qed.

Lemma leading_zeros_exact b : words b ->
  (leading_zeros b <= length b)%nat /\ value b = B ^ Z.of_nat (leading_zeros b) * value (skipn (leading_zeros b) b) /\
  (value b <> 0 -> (leading_zeros b < length b)%nat).
Proof.
  induction 1 as [| w b W H IH]; [simpl; lia |]. cbn [leading_zeros].
  destruct (Z.eqb_spec w 0) as [-> | N].
  - destruct IH as (L & V & S). cbn [skipn value length]. rewrite V, Nat2Z.inj_succ, Z.pow_succ_r by lia.
    split; [lia |]. split; [ring |]. rewrite <- V. intros. assert (value b <> 0) by nia. lia.
  - cbn [skipn length]. change (B ^ Z.of_nat 0) with 1. split; [lia |]. split; [ring | lia].
Qed.

(** One word: z becomes z + w 2^(64i) b. *)
Lemma visit_exact b low r beyond z i w :
  words b -> low = leading_zeros b -> value b <> 0 -> stands_for (r, beyond) z -> 0 <= i ->
  (length r <= Z.to_nat i + length b)%nat -> w <> 0 -> Z.abs w < B ->
  (if w <? 0 then - B ^ (i + size b + 1) <= z + w * B ^ i * value b < 0
   else 0 <= z + w * B ^ i * value b < B ^ (i + size b + 1)) ->
  stands_for (visit low b (r, beyond) (i, w)) (z + w * B ^ i * value b) /\
  length (fst (visit low b (r, beyond) (i, w))) = (Z.to_nat i + length b + 1)%nat.
Proof.
  intros Wb -> NB H I L NW HW Range. unfold visit. destruct (leading_zeros_exact b Wb) as (L1 & V1 & S1). specialize (S1 NB).
  set (low := leading_zeros b) in *. set (n := (Z.to_nat i + length b + 1)%nat).
  apply (stands_longer _ _ _ (n - length r)) in H. set (y := r ++ repeat beyond (n - length r)) in *.
  assert (Ly : length y = n) by (unfold y; rewrite app_length, repeat_length; unfold n; lia).
  destruct (stands_value _ _ _ H) as [k K]. destruct H as [Wy _]. clearbody y. clear r L.
  set (e := (Z.to_nat i + low)%nat).
  assert (Split : exists m t, skipn e y = m ++ [t] /\ length m = (length b - low)%nat).
  { assert (Ls : length (skipn e y) = S (length b - low)) by (rewrite skipn_length; unfold n, e in *; lia).
    destruct (exists_last (l := skipn e y)) as (m & t & E); [intros E; rewrite E in Ls; discriminate |].
    exists m, t. split; auto. rewrite E, app_length in Ls. simpl in Ls. lia. }
  destruct Split as (m & t & E & Lm). rewrite E, removelast_last, last_last.
  set (first := firstn e y). assert (Ey : y = first ++ m ++ [t]) by (unfold first; rewrite <- E; symmetry; apply firstn_skipn).
  assert (Lf : length first = e) by (unfold first; rewrite firstn_length; unfold n, e in *; lia). clearbody first. clear E.
  subst y. apply Forall_app in Wy. destruct Wy as [Wf Wy]. apply Forall_app in Wy. destruct Wy as [Wm Wt].
  inversion_clear Wt as [| ? ? Ht _]. set (f := skipn low b) in *.
  assert (Wg : words f) by (unfold f; rewrite <- (firstn_skipn low b) in Wb; apply Forall_app in Wb; tauto).
  assert (Lg : length m = length f) by (unfold f; rewrite skipn_length; exact Lm).
  generalize B_positive. intros P.
  assert (Size : forall s v, length s = length m -> length (first ++ s ++ [v]) = n).
  { intros s v Ls. rewrite !app_length. simpl. unfold n, e in *. lia. }
  assert (Power : B ^ Z.of_nat n = B ^ i * B ^ Z.of_nat low * B ^ size m * B).
  { rewrite <- (Z.pow_1_r B) at 5. rewrite <- !Z.pow_add_r by lia. f_equal. unfold n, e in *. lia. }
  assert (Place : B ^ size first = B ^ i * B ^ Z.of_nat low).
  { rewrite Lf, <- Z.pow_add_r by lia. f_equal. unfold e. lia. }
  assert (End : B ^ (i + size b + 1) = B ^ Z.of_nat n) by (f_equal; unfold n; lia).
  rewrite End in Range. rewrite Ly in K. rewrite !value_app in K. cbn [value] in K. rewrite Place in K.
  destruct (Z.ltb_spec w 0) as [C | C].
  - generalize (subtract_multiple_exact m (- w) f 0 Lg Wm Wg ltac:(unfold word; lia) ltac:(unfold word; lia)).
    destruct (subtract_multiple m (- w) f 0) as [s c]. intros (Ls & Ws & Wc & Es). cbn [fst].
    split; [| now apply Size]. apply (stands_modulo _ false) with (k := k - ((t - c) / B)).
    + repeat apply words_app; auto. repeat constructor; apply Z.mod_pos_bound; lia.
    + rewrite Size, !value_app, Place, Power, V1, Ls by auto. cbn [value].
      rewrite Power in K. generalize (Z.div_mod (t - c) B). nia.
    + rewrite Size by auto. exact Range.
  - generalize (add_multiple_exact m w f 0 Lg Wm Wg ltac:(unfold word; lia) ltac:(unfold word; lia)).
    destruct (add_multiple m w f 0) as [s c]. intros (Ls & Ws & Wc & Es). cbn [fst].
    split; [| now apply Size]. apply (stands_modulo _ true) with (k := k - ((t + c) / B)).
    + repeat apply words_app; auto. repeat constructor; apply Z.mod_pos_bound; lia.
    + rewrite Size, !value_app, Place, Power, V1, Ls by auto. cbn [value].
      rewrite Power in K. generalize (Z.div_mod (t + c) B). nia.
    + rewrite Size by auto. exact Range.
Qed.

(** Words come in ascending order, and none is zero, so their sum has the sign of the last. *)
Fixpoint ascending (l : list (Z * Z)) (start stop : Z) : Prop :=
  match l with
  | [] => True
  | (i, w) :: l => start <= i < stop /\ w <> 0 /\ Z.abs w < B /\ ascending l (i + 1) stop
  end.
Lemma ascending_earlier l start start' stop : start <= start' -> ascending l start' stop -> ascending l start stop.
Proof. intros L. destruct l as [| [i w] l]; [easy |]. cbn [ascending]. intros (H & H'). split; [lia | exact H']. Qed.
Lemma signed_words_ascending x carry i : ascending (signed_words x carry i) i (i + size x).
Proof.
  revert carry i. induction x as [| w0 x IH]; [easy |]. intros carry i. cbn [signed_words length].
  rewrite Nat2Z.inj_succ. replace (i + Z.succ (size x)) with (i + 1 + size x) by lia.
  generalize (Z.mod_pos_bound (w0 + carry) B B_positive). set (w := (w0 + carry) mod B). intros W.
  destruct (Z.eqb_spec w 0) as [E | E]; [apply ascending_earlier with (i + 1); [lia | apply IH] |].
  cbn [ascending]. split; [lia |]. rewrite <- Z.sub_0_l at 1.
  assert (M : (0 - w) mod B = B - w).
  { replace (0 - w) with (B - w + (-1) * B) by ring. rewrite Z.mod_add by lia. apply Z.mod_small. lia. }
  destruct (_ =? 0); [| rewrite M]; (split; [lia | split; [lia | apply IH]]).
Qed.
Lemma visits_exact b low l : words b -> low = leading_zeros b -> value b <> 0 ->
  forall r beyond s start stop, stands_for (r, beyond) (s * value b) -> 0 <= start <= stop -> Z.abs s < B ^ start ->
  (length r <= Z.to_nat start + length b)%nat -> ascending l start stop ->
  stands_for (fold_left (visit low b) l (r, beyond)) ((s + total l) * value b) /\
  (length (fst (fold_left (visit low b) l (r, beyond))) <= Z.to_nat stop + length b)%nat.
Proof.
  intros Wb EL NB. induction l as [| [i w] l IH]; intros r beyond s start stop H P S L A.
  { cbn [fold_left total fst]. rewrite Z.add_0_r. split; [exact H | lia]. }
  destruct A as (I & NW & HW & A). cbn [fold_left total]. assert (I0 : 0 <= i) by lia.
  assert (Li : (length r <= Z.to_nat i + length b)%nat) by (clear - L I S; lia).
  assert (Si : Z.abs s < B ^ i).
  { apply Z.lt_le_trans with (1 := S). apply Z.pow_le_mono_r; [exact B_positive | lia]. }
  assert (Pi : 0 < B ^ i) by (apply Z.pow_pos_nonneg; [exact B_positive | lia]).
  assert (Step : Z.abs (s + w * B ^ i) < B ^ (i + 1) /\ (if w <? 0 then s + w * B ^ i < 0 else 0 <= s + w * B ^ i)).
  { rewrite Z.pow_add_r, Z.pow_1_r by lia. set (q := B ^ i) in *. generalize B_large. intros PB.
    destruct (Z.ltb_spec w 0).
    - assert (w * q <= -1 * q) by (apply Z.mul_le_mono_nonneg_r; lia).
      assert ((1 - B) * q <= w * q) by (apply Z.mul_le_mono_nonneg_r; lia). lia.
    - assert (1 * q <= w * q) by (apply Z.mul_le_mono_nonneg_r; lia).
      assert (w * q <= (B - 1) * q) by (apply Z.mul_le_mono_nonneg_r; lia). lia. }
  destruct Step as [S1 S2]. assert (V := value_bounds b Wb).
  assert (E : s * value b + w * B ^ i * value b = (s + w * B ^ i) * value b) by ring.
  assert (Range : if w <? 0 then - B ^ (i + size b + 1) <= s * value b + w * B ^ i * value b < 0
                  else 0 <= s * value b + w * B ^ i * value b < B ^ (i + size b + 1)).
  { replace (i + size b + 1) with (i + 1 + size b) by lia. rewrite E, Z.pow_add_r by (clear - I0; lia).
    set (q := B ^ (i + 1)) in *. set (m := B ^ size b) in *. set (z := s + w * B ^ i) in *. clearbody q m z.
    clear - S1 S2 V NB. assert (Z.abs z * value b <= q * m) by (apply Z.mul_le_mono_nonneg; lia).
    assert (Z.abs z * value b < q * m) by (apply Z.lt_le_trans with (q * value b); [apply Z.mul_lt_mono_pos_r; lia | apply Z.mul_le_mono_nonneg_l; lia]).
    destruct (w <? 0).
    - assert (z * value b < 0) by (apply Z.mul_neg_pos; lia). rewrite Z.abs_neq in * by lia. lia.
    - rewrite Z.abs_eq in * by lia. split; [apply Z.mul_nonneg_nonneg; lia | lia]. }
  destruct (visit_exact b low r beyond (s * value b) i w Wb EL NB H I0 Li NW HW Range) as [H1 L1].
  rewrite E in H1. destruct (visit low b (r, beyond) (i, w)) as [r1 beyond1]. cbn [fst] in L1.
  replace (s + (w * B ^ i + total l)) with (s + w * B ^ i + total l) by ring.
  apply (IH r1 beyond1 (s + w * B ^ i) (i + 1) stop); auto; clear - I I0 L1; lia.
Qed.

Theorem sparse_product_exact a b : a <> [] -> words a -> words b -> signed b <> 0 ->
  length (sparse_product a b) = (length a + length b)%nat /\ words (sparse_product a b) /\
  signed (sparse_product a b) = signed a * signed b.
Proof.
  intros Na Wa Wb N0. assert (Nb : b <> []) by (intros ->; now apply N0).
  assert (NB : value b <> 0).
  { intros V. apply N0. unfold signed. generalize (negative_spec b Wb Nb) (power_positive (length b)).
    destruct (negative b); lia. }
  unfold sparse_product. set (low := leading_zeros b).
  assert (H0 : stands_for (zeros low, 0) (0 * value b)).
  { split; [apply words_zeros |]. left. split; auto. now rewrite value_zeros. }
  destruct (leading_zeros_exact b Wb) as (L0 & _ & _). fold low in L0.
  destruct (visits_exact b low (signed_words a 0 0) Wb eq_refl NB (zeros low) 0 0 0 (size a) H0) as [H L];
    [lia | reflexivity | rewrite length_zeros; lia | apply (signed_words_ascending a 0 0) |].
  rewrite signed_words_exact in H by (auto; lia).
  replace ((0 + (signed a + 0) * B ^ 0) * value b) with (signed a * value b) in H by ring.
  destruct (fold_left (visit low b) (signed_words a 0 0) (zeros low, 0)) as [r beyond]. cbn [fst] in L.
  rewrite Nat2Z.id in L. apply (stands_longer _ _ _ (length a + length b - length r)) in H.
  set (y := r ++ repeat beyond (length a + length b - length r)) in *.
  assert (Ly : length y = (length a + length b)%nat) by (unfold y; rewrite app_length, repeat_length; lia).
  destruct (stands_value _ _ _ H) as [k K]. destruct H as [Wy _]. clearbody y.
  destruct (subtract_from_exact (length b) y a (negative b) Wy Wa ltac:(lia)) as (L2 & W2 & j & E2).
  set (t := subtract_from (length b) y a (negative b)) in *.
  assert (Lt : length t = (length a + length b)%nat) by lia. split; [exact Lt |]. split; [exact W2 |].
  destruct (signed_modulo a) as [i I].
  apply signed_is with (k := j + k + (if negative b then i else 0)); auto.
  - intros E. rewrite E in Lt. destruct a; easy.
  - rewrite Lt. apply product_fits; now apply signed_fits.
  - rewrite E2, K, Ly, Lt, Nat2Z.inj_add, Z.pow_add_r, I by lia. unfold signed. destruct (negative b); ring.
Qed.

(** Numbers are trimmed: a last word that only extends the sign is removed. *)
Definition trimmed (x : list Z) : Prop := length x = 1%nat \/ last x 0 <> sign_word (removelast x).
Lemma not_zero_exact b : words b -> b <> [] -> trimmed b -> not_zero b = true -> signed b <> 0.
Proof.
  intros W N T H Z. assert (V : value b = 0).
  { generalize (negative_spec b W N) (value_bounds b W). unfold signed in Z. destruct (negative b); lia. }
  assert (A : forallb (Z.eqb 0) b = true) by (rewrite value_zero, V by auto; reflexivity).
  destruct T as [L | T].
  - destruct b as [| w [|]]; try discriminate. unfold not_zero in H. cbn [forallb] in A.
    rewrite andb_true_r in A. apply Z.eqb_eq in A. now subst w.
  - apply T. destruct (exists_last N) as (y & w & ->). rewrite last_last, removelast_last.
    rewrite forallb_app in A. apply andb_prop in A. destruct A as [Ay Aw]. cbn [forallb] in Aw.
    rewrite andb_true_r in Aw. apply Z.eqb_eq in Aw. subst w. unfold sign_word.
    destruct (negative y) eqn:Ny; auto. exfalso. destruct y as [| v y _] using rev_ind; [discriminate |].
    unfold negative in Ny. rewrite last_last in Ny. rewrite forallb_app in Ay. apply andb_prop in Ay.
    destruct Ay as [_ Av]. cbn [forallb] in Av. rewrite andb_true_r in Av. apply Z.eqb_eq in Av. now subst v.
Qed.
Theorem any_product_exact a b : a <> [] -> b <> [] -> words a -> words b -> trimmed a -> trimmed b ->
  signed (any_product a b) = signed a * signed b.
Proof.
  intros Na Nb Wa Wb Ta Tb. unfold any_product.
  destruct (is_sparse a && not_zero b) eqn:C1.
  { apply andb_prop in C1. apply sparse_product_exact; auto. now apply not_zero_exact. }
  destruct (is_sparse b && not_zero a) eqn:C2.
  { apply andb_prop in C2. rewrite Z.mul_comm. apply sparse_product_exact; auto. now apply not_zero_exact. }
  now apply product_exact.
Qed.

(** long_integer's product, of at most n words; sign extensions are removed then (trim_exact). *)
Definition long_product (n : nat) (a b : list Z) : list Z := firstn n (any_product a b).
Lemma any_product_words a b : a <> [] -> b <> [] -> words a -> words b -> trimmed a -> trimmed b ->
  words (any_product a b) /\ length (any_product a b) = (length a + length b)%nat.
Proof.
  intros Na Nb Wa Wb Ta Tb. unfold any_product.
  destruct (is_sparse a && not_zero b) eqn:C1.
  { apply andb_prop in C1. destruct (sparse_product_exact a b) as (L & W & _); auto. now apply not_zero_exact. }
  destruct (is_sparse b && not_zero a) eqn:C2.
  { apply andb_prop in C2. destruct (sparse_product_exact b a) as (L & W & _); auto; [now apply not_zero_exact |].
    split; auto. lia. }
  now apply product_words.
Qed.
Theorem long_product_exact n a b : n <> 0%nat -> a <> [] -> b <> [] -> words a -> words b -> trimmed a -> trimmed b ->
  fits n (signed a * signed b) -> signed (long_product n a b) = signed a * signed b.
Proof.
  intros N Na Nb Wa Wb Ta Tb F. destruct (any_product_words a b) as [W L]; auto.
  pose proof (any_product_exact a b Na Nb Wa Wb Ta Tb) as E. unfold long_product. set (r := any_product a b) in *.
  destruct (Nat.le_gt_cases (length r) n) as [C | C]; [now rewrite firstn_all2 |].
  assert (Wr : words (firstn n r) /\ words (skipn n r)) by (apply Forall_app; now rewrite firstn_skipn).
  assert (Lf : length (firstn n r) = n) by (rewrite firstn_length; lia).
  destruct (signed_modulo r) as [k K]. rewrite <- (firstn_skipn n r), value_app, Lf in K.
  apply signed_is with (k := - (value (skipn n r) + k * B ^ Z.of_nat (length r - n))); try tauto.
  - intros Z0. rewrite Z0 in Lf. simpl in Lf. lia.
  - now rewrite Lf.
  - rewrite Lf, <- E, (firstn_skipn n r) in *. rewrite K.
    replace (size r) with (Z.of_nat n + Z.of_nat (length r - n)) by lia. rewrite Z.pow_add_r by lia. ring.
Qed.
