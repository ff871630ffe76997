(** Bounds of the positive roots, and control values of any degree, as include/errbound/roots/root_isolation.hpp
    computes them in integers. Results:
        root_exponent_right        no root of p is at or above 2^(positive_root_exponent(p))
        half_line_right            all positive roots lie strictly between the points used as bounds
        control_values_on_right    control_values_on is a positive multiple of p's control values
        found_in_integers_right    real_roots finds intervals of integer polynomials as RootIsolation.v requires
        row_cut_right, row_uncertain, row_signs_right, row_halves_right
                                   fixed_row: errors, signs, halves
        weights_right, weights_fit  inverse_binomials, which fit in 64 bits *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Flocq Require Import Core.
From Errbound Require Import Sign Bernstein VertexEdge SignVariations RootIsolation.
Import ListNotations.
Open Scope R_scope.

(** ** Kioustelidis' bound *)

Definition floor_log2 (c : Z) : Z := Z.log2 (Z.abs c).
(** One coefficient's exponent, at the distance d from the last one. *)
Definition exponent_of (c last d : Z) : Z :=
  let quotient := (floor_log2 c + 1 - floor_log2 last)%Z in
  ((if 0 <? quotient then (quotient + d - 1) / d else Z.quot quotient d) + 1)%Z.
(** positive_root_exponent; None stands for INT_MIN. *)
Fixpoint root_exponent (last : Z) (p : list Z) : option Z :=
  match p with
  | c :: (_ :: _) as l =>
      let others := root_exponent last l in
      if (c =? 0)%Z || Bool.eqb (c <? 0)%Z (last <? 0)%Z then others
      else
        let e := exponent_of c last (Z.of_nat (length l)) in
        match others with Some m => Some (Z.max m e) | None => Some e end
  | _ => None
  end.
Definition positive_root_exponent (p : list Z) : option Z := root_exponent (List.last p 0%Z) p.

Notation pow2 e := (bpow radix2 e).

Lemma log2_bounds c : (c <> 0)%Z -> pow2 (floor_log2 c) <= IZR (Z.abs c) < pow2 (floor_log2 c + 1).
Proof.
  intros N. unfold floor_log2. pose proof (Z.log2_spec (Z.abs c) ltac:(lia)) as (A & B).
  pose proof (Z.log2_nonneg (Z.abs c)). rewrite <- !IZR_Zpower by lia.
  split; [now apply IZR_le | apply IZR_lt]. exact B.
Qed.
Lemma pow2_next e : pow2 e = 2 * pow2 (e - 1).
Proof. replace e with (1 + (e - 1))%Z at 1 by ring. now rewrite bpow_plus. Qed.
Lemma pow2_power e (d : nat) : pow2 e ^ d = pow2 (e * Z.of_nat d).
Proof.
  induction d as [| d IH]; [now rewrite Z.mul_0_r |]. cbn [pow]. rewrite IH, <- bpow_plus. f_equal. lia.
Qed.
Lemma exponent_enough c last (d : nat) : (c <> 0)%Z -> (last <> 0)%Z -> (0 < d)%nat ->
  IZR (Z.abs c) <= IZR (Z.abs last) * pow2 (exponent_of c last (Z.of_nat d) - 1) ^ d.
Proof.
  intros C L D. destruct (log2_bounds c C) as (_ & Uc). destruct (log2_bounds last L) as (Ll & _).
  unfold exponent_of. set (q := (floor_log2 c + 1 - floor_log2 last)%Z).
  set (root := (if (0 <? q)%Z then ((q + Z.of_nat d - 1) / Z.of_nat d)%Z else Z.quot q (Z.of_nat d))).
  cbv zeta. replace (root + 1 - 1)%Z with root by lia. rewrite pow2_power.
  assert (Q : (q <= root * Z.of_nat d)%Z).
  { unfold root. destruct (Z.ltb_spec 0 q) as [H | H].
    - pose proof (Z.div_mod (q + Z.of_nat d - 1) (Z.of_nat d) ltac:(lia)).
      pose proof (Z.mod_pos_bound (q + Z.of_nat d - 1) (Z.of_nat d) ltac:(lia)). nia.
    - pose proof (Z.quot_rem q (Z.of_nat d) ltac:(lia)).
      pose proof (Z.rem_bound_pos_pos (- q) (Z.of_nat d) ltac:(lia) ltac:(lia)).
      rewrite Z.rem_opp_l in H1 by lia. nia. }
  apply Rle_trans with (pow2 (floor_log2 c + 1)); [lra |].
  apply Rle_trans with (pow2 (floor_log2 last) * pow2 (root * Z.of_nat d)).
  - rewrite <- bpow_plus. apply bpow_le. lia.
  - apply Rmult_le_compat_r; [apply bpow_ge_0 | easy].
Qed.

Definition sign_factor (z : Z) : R := if (z <? 0)%Z then -1 else 1.

Lemma above_the_bound last : (last <> 0)%Z -> forall p x, 0 < x -> p <> [] -> List.last p 0%Z = last ->
  (forall e, root_exponent last p = Some e -> pow2 e <= x) ->
  IZR (Z.abs last) * (x / 2) ^ (length p - 1) <= sign_factor last * poly p x.
Proof.
  intros L p x X. assert (Pl : 0 < IZR (Z.abs last)) by (apply IZR_lt; lia).
  assert (Abs : sign_factor last * IZR last = IZR (Z.abs last)).
  { unfold sign_factor. destruct (Z.ltb_spec last 0); rewrite ?Z.abs_neq, ?Z.abs_eq, ?opp_IZR by lia; ring. }
  induction p as [| c [| c' l] IH]; intros N E B; [easy | |].
  - cbn [List.last] in E. subst c. unfold poly. simpl. lra.
  - change (List.last (c :: c' :: l) 0%Z) with (List.last (c' :: l) 0%Z) in E. set (p := c' :: l) in *.
    set (d := length p). assert (D : (0 < d)%nat) by (unfold d, p; simpl; lia).
    assert (B' : forall e, root_exponent last p = Some e -> pow2 e <= x).
    { intros e F. cbn [root_exponent] in B. fold p in B. rewrite F in B. unfold p in B. destruct ((c =? 0)%Z || _); [now apply B |].
      specialize (B _ eq_refl). apply Rle_trans with (2 := B). apply bpow_le. lia. }
    specialize (IH ltac:(easy) E B'). change (poly (c :: p) x) with (IZR c + x * poly p x). cbn [length].
    fold d. fold d in IH. replace (S d - 1)%nat with (S (d - 1)) by lia. cbn [pow]. set (h := (x / 2) ^ (d - 1)) in *.
    assert (H : 0 < h) by (apply pow_lt; lra).
    assert (Main : - (IZR (Z.abs last) * (x / 2 * h)) <= sign_factor last * IZR c).
    { assert (0 <= IZR (Z.abs last) * (x / 2 * h)) by (apply Rmult_le_pos; [| apply Rmult_le_pos]; lra).
      destruct (Z.eq_dec c 0) as [-> | C]; [lra |].
      destruct (Bool.eqb (c <? 0)%Z (last <? 0)%Z) eqn:S.
      - unfold sign_factor. revert S. destruct (Z.ltb_spec c 0) as [K | K], (Z.ltb_spec last 0); intros S; try discriminate;
          [apply IZR_lt in K | apply IZR_le in K]; lra.
      - assert (M : IZR (Z.abs c) <= IZR (Z.abs last) * (x / 2 * h)).
        { apply Rle_trans with (1 := exponent_enough c last d C L D).
          replace (x / 2 * h) with ((x / 2) ^ d) by (unfold h; rewrite tech_pow_Rmult; f_equal; lia).
          apply Rmult_le_compat_l; [lra |]. apply pow_incr. split; [apply bpow_ge_0 |].
          set (e := exponent_of c last (Z.of_nat d)).
          assert (F : pow2 e <= x).
          { cbn [root_exponent] in B. fold p in B. destruct (Z.eqb_spec c 0) as [| _]; [easy |]. rewrite S in B. cbn [orb] in B.
            fold d in B. fold e in B. unfold p in B. fold p in B. destruct (root_exponent last p); specialize (B _ eq_refl); auto.
            apply Rle_trans with (2 := B). apply bpow_le. lia. }
          rewrite pow2_next in F. lra. }
        assert (A : sign_factor last * IZR c = - IZR (Z.abs c)).
        { unfold sign_factor. revert S. destruct (Z.ltb_spec c 0), (Z.ltb_spec last 0); intros S; try discriminate;
            rewrite ?Z.abs_neq, ?Z.abs_eq, ?opp_IZR by lia; ring. }
        lra. }
    apply Rle_trans with (- (IZR (Z.abs last) * (x / 2 * h)) + x * (IZR (Z.abs last) * h)); [lra |].
    rewrite Rmult_plus_distr_l. apply Rplus_le_compat; auto.
    replace (sign_factor last * (x * poly p x)) with (x * (sign_factor last * poly p x)) by ring.
    apply Rmult_le_compat_l; lra.
Qed.
Theorem root_exponent_right p x : 0 < x -> List.last p 0%Z <> 0%Z -> poly p x = 0 ->
  exists e, positive_root_exponent p = Some e /\ x < pow2 e.
Proof.
  intros X L Z. unfold positive_root_exponent.
  assert (N : p <> []) by (intros ->; easy).
  assert (No : ~ (forall e, root_exponent (List.last p 0%Z) p = Some e -> pow2 e <= x)).
  { intros B. pose proof (above_the_bound _ L p x X N eq_refl B) as H. rewrite Z, Rmult_0_r in H.
    assert (0 < IZR (Z.abs (List.last p 0%Z))) by (apply IZR_lt; lia).
    assert (0 < (x / 2) ^ (length p - 1)) by (apply pow_lt; lra).
    assert (0 < IZR (Z.abs (List.last p 0%Z)) * (x / 2) ^ (length p - 1)) by now apply Rmult_lt_0_compat. lra. }
  destruct (root_exponent (List.last p 0%Z) p) as [e |].
  - exists e. split; auto. destruct (Rlt_or_le x (pow2 e)); auto. exfalso. apply No. now intros ? [= <-].
  - exfalso. apply No. discriminate.
Qed.

(** Bounds on both sides: half_line, and the points beyond them that `inside` uses (unlikely_root). *)
Definition unlikely_root (e : Z) : R := 45 * pow2 (e - 5).
Definition half_line (p : list Z) : option (R * R) :=
  match positive_root_exponent p, positive_root_exponent (rev p) with
  | Some upper, Some inverse =>
      let lower := (- inverse)%Z in
      if (upper <? lower)%Z then None else Some (unlikely_root (lower - 1), unlikely_root upper)
  | _, _ => None
  end.

Lemma unlikely_bounds e : pow2 e < unlikely_root e < 2 * pow2 e.
Proof.
  unfold unlikely_root. replace (pow2 e) with (32 * pow2 (e - 5)).
  - pose proof (bpow_gt_0 radix2 (e - 5)). lra.
  - rewrite (pow2_next e), (pow2_next (e - 1)), (pow2_next (e - 1 - 1)), (pow2_next (e - 1 - 1 - 1)), (pow2_next (e - 1 - 1 - 1 - 1)).
    replace (e - 1 - 1 - 1 - 1 - 1)%Z with (e - 5)%Z by ring. ring.
Qed.
Lemma reversed_root p x : 0 < x -> p <> [] -> poly p x = 0 -> poly (rev p) (/ x) = 0.
Proof.
  unfold poly. intros X N Z. assert (I : 0 < / x) by now apply Rinv_0_lt_compat.
  pose proof (reversed_form (S := reals) (reals_of p) 1 (/ x)) as H. simpl exact in H. rewrite !map_id in H.
  change (form (rev (reals_of p)) 1 (/ x) = form (reals_of p) (/ x) 1) in H.
  assert (E : forall q s t, s <> 0 -> q <> [] -> exists k, form q s t = s ^ k * power_form q (t / s)).
  { intros q s t S. destruct q as [| a l]; [easy |]. intros _. exists (length l). now apply power_basis. }
  destruct (E (rev (reals_of p)) 1 (/ x)) as (k & K); [lra | destruct p; [easy |]; simpl; now destruct (rev (reals_of p)) |].
  destruct (E (reals_of p) (/ x) 1) as (m & M); [lra | now destruct p |].
  rewrite K, M, pow1, Rmult_1_l in H. unfold Rdiv in H. rewrite Rinv_1, Rmult_1_r, Rinv_inv, Rmult_1_l, Z, Rmult_0_r in H.
  now rewrite map_rev.
Qed.
Theorem half_line_right p : List.last p 0%Z <> 0%Z -> hd 0%Z p <> 0%Z -> bounds_right (reals_of p) (half_line p) /\
  forall x, 0 < x -> poly p x = 0 -> exists e, positive_root_exponent p = Some e /\ x < unlikely_root e.
Proof.
  intros L H. assert (N : p <> []) by (intros ->; easy). split.
  - intros x X Z. destruct (root_exponent_right p x X L Z) as (e & E & U).
    destruct (root_exponent_right (rev p) (/ x)) as (i & I & V).
    + now apply Rinv_0_lt_compat.
    + destruct p as [| a l]; [easy |]. simpl. now rewrite last_last.
    + now apply reversed_root.
    + unfold half_line. rewrite E, I. cbv zeta.
      assert (Lo : pow2 (- i) < x).
      { rewrite bpow_opp. rewrite <- (Rinv_inv x). apply Rinv_lt_contravar; auto.
        apply Rmult_lt_0_compat; [now apply Rinv_0_lt_compat | apply bpow_gt_0]. }
      destruct (Z.ltb_spec e (- i)) as [K | K].
      * exfalso. pose proof (bpow_lt radix2 e (- i) K). lra.
      * do 2 eexists. split; [reflexivity |]. pose proof (unlikely_bounds (- i - 1)). pose proof (unlikely_bounds e).
        rewrite (pow2_next (- i)) in Lo. lra.
  - intros x X Z. destruct (root_exponent_right p x X L Z) as (e & E & U). exists e. split; auto.
    pose proof (unlikely_bounds e). lra.
Qed.

(** ** Control values *)

(** The value of a form with the n + 1 control values f 0, ..., f n, by de Casteljau's rule. *)
Fixpoint casteljau (n : nat) (f : nat -> R) (s t : R) : R :=
  match n with O => f O | S n => s * casteljau n f s t + t * casteljau n (fun i => f (S i)) s t end.

Lemma casteljau_same n f g s t : (forall i, (i <= n)%nat -> f i = g i) -> casteljau n f s t = casteljau n g s t.
Proof.
  revert f g. induction n as [| n IH]; intros f g E; simpl; [apply E; lia |].
  rewrite (IH f g), (IH (fun i => f (S i)) (fun i => g (S i))); auto; intros; apply E; lia.
Qed.
Lemma casteljau_plus n f g s t : casteljau n (fun i => f i + g i) s t = casteljau n f s t + casteljau n g s t.
Proof.
  revert f g. induction n as [| n IH]; intros f g; simpl; [easy |].
  rewrite IH, (IH (fun i => f (S i)) (fun i => g (S i))). ring.
Qed.
(** Weights 2^(n - i) double s. *)
Lemma casteljau_powers n f s t : casteljau n (fun i => f i * 2 ^ (n - i)) s t = casteljau n f (2 * s) t.
Proof.
  revert f. induction n as [| n IH]; intros f; [simpl; ring |].
  cbn [casteljau]. rewrite <- (IH f), <- (IH (fun i => f (S i))).
  rewrite (casteljau_same n (fun i => f i * 2 ^ (S n - i)) (fun i => f i * 2 ^ (n - i) + f i * 2 ^ (n - i))).
  - rewrite casteljau_plus. cbn [Nat.sub]. ring.
  - intros i I. replace (S n - i)%nat with (S (n - i)) by lia. simpl. ring.
Qed.
Lemma casteljau_last n f s t : casteljau (S n) f s t = s * casteljau n f s t + t * casteljau n (fun i => f (S i)) s t.
Proof. easy. Qed.
Lemma casteljau_reversed n f s t : casteljau n (fun i => f (n - i)%nat) s t = casteljau n f t s.
Proof.
  revert f. induction n as [| n IH]; intros f; [easy |]. rewrite casteljau_last.
  rewrite (casteljau_same n (fun i => f (S n - i)%nat) (fun i => (fun j => f (S j)) (n - i)%nat)).
  - rewrite (IH (fun j => f (S j))). cbn [Nat.sub]. rewrite (IH f). simpl. ring.
  - intros i I. f_equal. lia.
Qed.

Definition at_index (b : list R) (i : nat) : R := nth i b 0.

(** The scaled coefficients of the code's forms are those of the control values. *)
Lemma products_length c b : length c = length b -> length (products c b) = length b.
Proof. revert b. induction c as [| x c IH]; intros [| y b] L; try discriminate; [easy |]. simpl. f_equal. apply IH. now injection L. Qed.
Lemma products_sum c d b s t : length c = length b -> length d = length b ->
  form (products (map (fun xy => fst xy + snd xy) (combine c d)) b) s t = form (products c b) s t + form (products d b) s t.
Proof.
  revert d b. induction c as [| x c IH]; intros [| y d] [| z b] C D; try discriminate; [simpl; ring |].
  injection C as C. injection D as D. cbn [combine map products fst snd form].
  rewrite (IH d b C D), !products_length; auto; [ring |].
  rewrite map_length, combine_length. lia.
Qed.
Lemma products_last c b x y : length c = length b -> products (c ++ [x]) (b ++ [y]) = products c b ++ [x * y].
Proof.
  revert b. induction c as [| z c IH]; intros [| w b] L; try discriminate; [easy |]. simpl. rewrite IH; auto.
Qed.
Lemma control_form b n s t : length b = S n -> form (scaled_coefficients b) s t = casteljau n (at_index b) s t.
Proof.
  unfold scaled_coefficients. intros L. rewrite L. replace (S n - 1)%nat with n by lia. revert b L.
  induction n as [| n IH]; intros b L.
  - destruct b as [| a [|]]; try discriminate. cbn. ring.
  - cbn [binomials casteljau]. pose proof (length_binomials n) as Lb.
    rewrite products_sum by (rewrite ?app_length, ?Lb; simpl; lia).
    assert (E : b = removelast b ++ [last b 0]) by (apply app_removelast_last; now intros ->).
    assert (Lr : length (removelast b) = S n) by (apply (f_equal (@length R)) in E; rewrite app_length in E; simpl in E; lia).
    assert (Lt : length (tl b) = S n) by (destruct b; simpl in *; lia).
    rewrite E at 1. rewrite products_last by lia. rewrite Rmult_0_l, form_append_0, (IH _ Lr).
    replace (products (0 :: binomials n) b) with (0 :: products (binomials n) (tl b))
      by (destruct b; [discriminate |]; simpl; f_equal; ring).
    cbn [form]. rewrite (IH _ Lt), Rmult_0_l, Rplus_0_l. f_equal.
    + f_equal. apply casteljau_same. intros i I. unfold at_index. rewrite E at 2. rewrite app_nth1; auto. lia.
    + f_equal. apply casteljau_same. intros i I. unfold at_index. now destruct b.
Qed.

(** Sums of neighbours: one pass of the code's loops. *)
Fixpoint pairs (l : list R) : list R := match l with a :: (b :: _) as r => a + b :: pairs r | _ => [] end.
(** The first value of each row after n passes. *)
Fixpoint first_of_rows (n : nat) (l : list R) : list R :=
  match n with O => [] | S n => hd 0 l :: first_of_rows n (pairs l) end.

Lemma pairs_length l : length (pairs l) = Nat.pred (length l).
Proof. induction l as [| a [| b l] IH]; simpl in *; auto. Qed.
Lemma pairs_index l i : (S i < length l)%nat -> at_index (pairs l) i = at_index l i + at_index l (S i).
Proof.
  unfold at_index. revert i. induction l as [| a [| b l] IH]; intros i L; simpl in L; try lia.
  destruct i as [| i]; [easy |]. change (nth (S i) (pairs (a :: b :: l)) 0) with (nth i (pairs (b :: l)) 0).
  rewrite IH by (simpl; lia). easy.
Qed.
Lemma first_of_rows_length n l : length (first_of_rows n l) = n.
Proof. revert l. induction n as [| n IH]; intros l; simpl; auto. Qed.
Fixpoint row_first (f : nat -> R) (j : nat) : R :=
  match j with O => f O | S j => row_first (fun i => f i + f (S i)) j end.
Lemma row_first_same f g i : (forall j, (j <= i)%nat -> f j = g j) -> row_first f i = row_first g i.
Proof.
  revert f g. induction i as [| i IH]; intros f g E; simpl; [apply E; lia |]. apply IH. intros j J. rewrite !E by lia. easy.
Qed.
Lemma first_of_rows_index i : forall m l, (i < m)%nat -> (i < length l)%nat ->
  at_index (first_of_rows m l) i = row_first (at_index l) i.
Proof.
  induction i as [| i IH]; intros [| m] l M L; try lia; [now destruct l |].
  change (at_index (first_of_rows (S m) l) (S i)) with (at_index (first_of_rows m (pairs l)) i).
  rewrite IH by (rewrite ?pairs_length; lia). simpl. apply row_first_same. intros j J. apply pairs_index. lia.
Qed.
Lemma row_first_form n f s t : casteljau n (row_first f) s t = casteljau n f (s + t) t.
Proof.
  revert f. induction n as [| n IH]; intros f; [easy |]. cbn [casteljau]. rewrite IH.
  change (fun i => row_first f (S i)) with (row_first (fun i => f i + f (S i))).
  rewrite IH, casteljau_plus. ring.
Qed.
Lemma rows_form n l s t : length l = S n ->
  casteljau n (at_index (first_of_rows (S n) l)) s t = casteljau n (at_index l) (s + t) t.
Proof.
  intros L. rewrite <- row_first_form. apply casteljau_same. intros i I. apply first_of_rows_index; lia.
Qed.

(** control_values_on. Its passes over the array, in order: powers of 2^e; Taylor's shift by `start`, by Horner's
    rule on shorter and shorter lists; weights and powers of `length`; sums. *)
Fixpoint times_powers (r power : R) (p : list R) : list R :=
  match p with [] => [] | a :: l => a * power :: times_powers r (power * r) l end.
Fixpoint times_descending (r : R) (p : list R) : list R :=
  match p with [] => [] | a :: l => a * r ^ length l :: times_descending r l end.
Definition in_unit (e : Z) (p : list R) : list R :=
  if (0 <=? e)%Z then times_powers (pow2 e) 1 p else times_descending (pow2 (- e)) p.
Fixpoint horner (start : R) (p : list R) : list R :=
  match p with
  | [] => []
  | a :: l => match horner start l with [] => [a] | b :: r => a + b * start :: b :: r end
  end.
Fixpoint shifted (n : nat) (start : R) (p : list R) : list R :=
  match n with
  | O => p
  | S n => match horner start p with [] => [] | a :: l => a :: shifted n start l end
  end.
Definition control_values_on (weights : list R) (e : Z) (start len : R) (p : list R) : list R :=
  first_of_rows (length p)
    (times_powers len 1 (products (shifted (length p) start (in_unit e p)) weights)).

Lemma times_powers_value r w p x : power_form (times_powers r w p) x = w * power_form p (r * x).
Proof. revert w. induction p as [| a l IH]; intros w; simpl; [ring |]. rewrite IH. ring. Qed.
Lemma times_powers_length r w p : length (times_powers r w p) = length p.
Proof. revert w. induction p as [| a l IH]; intros w; simpl; auto. Qed.
Lemma times_descending_value r p x : r <> 0 ->
  power_form (times_descending r p) x = r ^ (length p - 1) * power_form p (x / r).
Proof.
  intros N. induction p as [| a [| b l] IH]; simpl in *; [ring | ring |]. rewrite IH. rewrite Nat.sub_0_r. field. easy.
Qed.
Lemma in_unit_value e p : length (in_unit e p) = length p /\
  exists c, 0 < c /\ forall x, power_form (in_unit e p) x = c * power_form p (pow2 e * x).
Proof.
  unfold in_unit. destruct (0 <=? e)%Z.
  - split; [apply times_powers_length |]. exists 1. split; [lra |]. intros x. apply times_powers_value.
  - pose proof (bpow_gt_0 radix2 (- e)). split; [induction p; simpl; auto |].
    exists (pow2 (- e) ^ (length p - 1)). split; [now apply pow_lt |]. intros x. rewrite times_descending_value by lra.
    f_equal. f_equal. rewrite <- (Z.opp_involutive e) at 2. rewrite (bpow_opp _ (- e)). unfold Rdiv. ring.
Qed.
Lemma horner_value start p : match horner start p with
  | [] => p = []
  | a :: l => a = power_form p start /\ length p = S (length l) /\
      forall x, power_form p x = a + (x - start) * power_form l x
  end.
Proof.
  induction p as [| a l IH]; [easy |]. simpl. destruct (horner start l) as [| b r].
  - subst l. simpl. repeat split; intros; ring.
  - destruct IH as (-> & L & E). split; [ring |]. split; [simpl; now rewrite L |]. intros x. rewrite (E x). simpl. ring.
Qed.
Lemma shifted_value start n : forall p, (length p <= n)%nat -> length (shifted n start p) = length p /\
  forall x, power_form (shifted n start p) x = power_form p (start + x).
Proof.
  induction n as [| n IH]; intros p L; [destruct p; [easy | simpl in L; lia] |]. simpl.
  pose proof (horner_value start p) as H. destruct (horner start p) as [| a l]; [now subst p |].
  destruct H as (-> & K & E). destruct (IH l) as (J & F); [lia |]. simpl. split; [lia |]. intros x.
  rewrite F, (E (start + x)). ring.
Qed.

(** The weights are a common multiple of all binomials, divided by each (inverse_binomials). *)
Definition inverse_binomials (multiple : R) (weights : list R) (n : nat) : Prop :=
  Forall2 (fun c w => c * w = multiple) (binomials n) weights.
Lemma weighted_products multiple c w : Forall2 (fun c w => c * w = multiple) c w -> forall len power a, length a = length c ->
  products c (times_powers len power (products a w)) = map (Rmult multiple) (times_powers len power a).
Proof.
  induction 1 as [| x y c w E F IH]; intros len power [| a l] L; try discriminate; [easy |]. simpl.
  rewrite IH by (now injection L). f_equal. rewrite <- E. ring.
Qed.
Lemma power_form_scaled c p x : power_form (map (Rmult c) p) x = c * power_form p x.
Proof. induction p as [| a l IH]; simpl; [| rewrite IH]; ring. Qed.

Theorem control_values_on_right p weights multiple n e start len : length p = S n -> 0 < multiple ->
  inverse_binomials multiple weights n ->
  controls (control_values_on weights e start len p) p (pow2 e * start) (pow2 e * (start + len)).
Proof.
  intros L M W. unfold controls, stands_for, control_values_on.
  destruct (in_unit_value e p) as (Lu & c & C & U). destruct (shifted_value start (length p) (in_unit e p)) as (Ls & S); [lia |].
  set (q := shifted (length p) start (in_unit e p)) in *.
  set (a := times_powers len 1 (products q weights)).
  assert (Lw : length weights = Datatypes.S n) by (rewrite <- (length_binomials n); clear - W; induction W; simpl; auto).
  assert (La : length a = Datatypes.S n).
  { unfold a. rewrite times_powers_length, products_length; lia. }
  exists (multiple * c). split; [now apply Rmult_lt_0_compat |]. intros t. unfold on_unit.
  rewrite L, (control_form _ n) by apply first_of_rows_length. rewrite (rows_form n a) by easy.
  replace (1 - t + t) with 1 by ring. rewrite <- control_form by easy.
  unfold scaled_coefficients. rewrite La. replace (Datatypes.S n - 1)%nat with n by lia. unfold a.
  rewrite (weighted_products multiple _ _ W) by (rewrite length_binomials; lia).
  assert (E : forall h, form h 1 t = power_form h t).
  { intros [| b h]; [easy |]. rewrite power_basis by lra. rewrite pow1. unfold Rdiv. now rewrite Rinv_1, Rmult_1_r, Rmult_1_l. }
  rewrite E, power_form_scaled, times_powers_value, S, U, Rmult_1_l, <- Rmult_assoc. do 2 f_equal. ring.
Qed.

(** De Casteljau's rule: each row's first and last value, times powers of two that compensate the halvings. *)
Definition left_half (n : nat) (b : list R) : list R := times_descending 2 (first_of_rows (S n) b).
Definition right_half (n : nat) (b : list R) : list R := rev (times_descending 2 (first_of_rows (S n) (rev b))).

Lemma times_descending_index r l i : (i < length l)%nat -> at_index (times_descending r l) i = at_index l i * r ^ (length l - 1 - i).
Proof.
  unfold at_index. revert i. induction l as [| a l IH]; intros i L; simpl in L; [lia |].
  destruct i as [| i]; simpl; [now rewrite !Nat.sub_0_r |]. rewrite IH by lia. do 2 f_equal. lia.
Qed.
Lemma times_descending_length r l : length (times_descending r l) = length l.
Proof. induction l; simpl; auto. Qed.
Lemma left_half_form n b s t : length b = S n ->
  casteljau n (at_index (left_half n b)) s t = casteljau n (at_index b) (2 * s + t) t.
Proof.
  intros L. unfold left_half. rewrite <- (rows_form n b) by easy. rewrite <- casteljau_powers. apply casteljau_same.
  intros i I. rewrite times_descending_index by (rewrite first_of_rows_length; lia). rewrite first_of_rows_length.
  do 2 f_equal. lia.
Qed.
Lemma rev_index l n i : length l = S n -> (i <= n)%nat -> at_index (rev l) i = at_index l (n - i)%nat.
Proof. intros L I. unfold at_index. rewrite rev_nth by lia. f_equal. lia. Qed.
Lemma rev_form l n s t : length l = S n -> casteljau n (at_index (rev l)) s t = casteljau n (at_index l) t s.
Proof.
  intros L. symmetry. rewrite <- casteljau_reversed. apply casteljau_same. intros i I. symmetry. now apply rev_index.
Qed.

Lemma halves_right p lo hi n b : length b = S n -> controls b p lo hi ->
  controls (left_half n b) p lo ((lo + hi) / 2) /\ controls (right_half n b) p ((lo + hi) / 2) hi.
Proof.
  intros L (c & C & E). unfold controls, stands_for, on_unit in *.
  assert (Hom : forall f r s t, casteljau n f (r * s) (r * t) = r ^ n * casteljau n f s t).
  { clear. induction n as [| n IH]; intros f r s t; [simpl; ring |]. cbn [casteljau pow]. rewrite !IH. ring. }
  assert (Pn : 0 < 2 ^ n) by (apply pow_lt; lra).
  split; exists (c * 2 ^ n); (split; [now apply Rmult_lt_0_compat |]); intros t.
  - rewrite (control_form _ n) by (unfold left_half; now rewrite times_descending_length, first_of_rows_length).
    rewrite left_half_form by easy.
    replace (2 * (1 - t) + t) with (2 * (1 - t / 2)) by field. replace t with (2 * (t / 2)) at 2 by field.
    rewrite Hom, <- control_form, E by easy.
    replace (lo + t / 2 * (hi - lo)) with (lo + t * ((lo + hi) / 2 - lo)) by field. ring.
  - assert (Lr : length (rev b) = S n) by now rewrite rev_length.
    rewrite (control_form _ n) by (unfold right_half; now rewrite rev_length, times_descending_length, first_of_rows_length).
    unfold right_half. fold (left_half n (rev b)).
    rewrite (rev_form (left_half n (rev b)) n) by (unfold left_half; now rewrite times_descending_length, first_of_rows_length).
    rewrite left_half_form, rev_form by easy.
    replace (1 - t) with (2 * (1 - (1 + t) / 2)) at 1 by field. replace (2 * t + (1 - t)) with (2 * ((1 + t) / 2)) by field.
    rewrite Hom, <- control_form, E by easy.
    replace (lo + (1 + t) / 2 * (hi - lo)) with ((lo + hi) / 2 + t * (hi - (lo + hi) / 2)) by field. ring.
Qed.

(** ** The constructor of real_roots of integer coefficients *)

Fixpoint mirrored_integers (p : list Z) : list Z :=
  match p with a :: b :: l => a :: (- b)%Z :: mirrored_integers l | l => l end.
Definition upper_bound (p : list Z) : R :=
  unlikely_root (match positive_root_exponent p with Some e => e | None => 0%Z end).

Lemma pairs_induction (P : list Z -> Prop) : P [] -> (forall a, P [a]) -> (forall a b l, P l -> P (a :: b :: l)) -> forall l, P l.
Proof.
  intros N O T l. enough (H : forall n l, (length l <= n)%nat -> P l) by now apply (H (length l)).
  induction n as [| n IH]; intros [| a [| b m]] L; simpl in L; try lia; auto. apply T, IH. lia.
Qed.
Lemma mirrored_reals p : mirrored (reals_of p) = reals_of (mirrored_integers p).
Proof. induction p as [| a | a b l IH] using pairs_induction; try easy. simpl. rewrite IH, opp_IZR. easy. Qed.
Lemma mirrored_ends p : hd 0%Z (mirrored_integers p) = hd 0%Z p /\
  (List.last p 0%Z <> 0%Z -> List.last (mirrored_integers p) 0%Z <> 0%Z).
Proof.
  split; [now destruct p as [| a [| b l]] |].
  induction p as [| a | a b l IH] using pairs_induction; try easy. destruct l as [| c l]; [simpl; lia |].
  intros H. specialize (IH H). destruct l as [| d l]; exact IH.
Qed.

Lemma last_reals (p : list Z) : List.last (reals_of p) (IZR 0) = IZR (List.last p 0%Z).
Proof. induction p as [| a [| b p] IH]; [easy | easy |]. exact IH. Qed.

(** f is the first polynomial of p's chain. *)
Definition found_in_integers (p f : list Z) (found : list interval) : Prop :=
  first_of_chain (reals_of p) (reals_of f) /\ List.last f 0%Z <> 0%Z /\
  isolate (reals_of f) (half_line f) (half_line (mirrored_integers f)) 0 (upper_bound f) found.

Theorem found_in_integers_right p f found : hd 0%Z p <> 0%Z -> found_in_integers p f found ->
  real_roots (reals_of p) (reals_of f) found.
Proof.
  intros H (C & L & I).
  assert (V : forall q, power_form (reals_of q) 0 = IZR (hd 0%Z q)) by (intros [| a q]; simpl; [easy | ring]).
  assert (N : power_form (reals_of p) 0 <> 0) by (rewrite V; now apply not_0_IZR).
  assert (Hf : hd 0%Z f <> 0%Z).
  { intros Z. apply N. apply (first_of_chain_roots _ _ (ex_intro _ 0 N) C). now rewrite V, Z. }
  destruct (half_line_right f L Hf) as (B & U). destruct (mirrored_ends f) as (Mh & Ml).
  apply isolated_roots with (half_line f) (half_line (mirrored_integers f)) (upper_bound f); auto.
  - change 0 with (IZR 0). rewrite last_reals. now apply not_0_IZR.
  - rewrite mirrored_reals. apply half_line_right; [now apply Ml | now rewrite Mh].
  - unfold upper_bound, unlikely_root. apply Rmult_lt_0_compat; [lra | apply bpow_gt_0].
  - intros x X Z. destruct (U x X Z) as (e & E & Lt). unfold upper_bound. now rewrite E.
Qed.

(** ** Rows rounded to a fixed number of bits: fixed_row *)

(** Multiples of one unit, each within `error` units of a control value. *)
Definition within (row : list Z) (error : Z) (unit : R) (b : list R) : Prop :=
  Forall2 (fun x c => Rabs (IZR x * unit - c) <= IZR error * unit) row b.
Definition row_sign (error x : Z) : Z :=
  if (x <? 0)%Z then (if (error <? - x)%Z then -1 else 0)%Z else if (error <? x)%Z then 1%Z else 0%Z.

Theorem row_signs_right row error unit b : 0 < unit -> (0 <= error)%Z -> within row error unit b ->
  Forall2 sign_seen (map (row_sign error) row) (map sgn b).
Proof.
  intros U E W. induction W as [| x c row b C W IH]; [constructor |]. constructor; auto. split.
  - pose proof (sgn_plain [c]) as F. now inversion_clear F.
  - unfold row_sign. apply Rabs_le_inv in C.
    assert (K : forall n, (error < n)%Z -> IZR error * unit < IZR n * unit) by (intros n N; apply Rmult_lt_compat_r; [easy | now apply IZR_lt]).
    destruct (Z.ltb_spec x 0); [destruct (Z.ltb_spec error (- x)) as [H1 | H1] | destruct (Z.ltb_spec error x) as [H1 | H1]]; intros N; try easy;
      apply K in H1; rewrite ?opp_IZR in H1; destruct (sgn_cases c) as [(L & ->) | [(L & ->) | (L & ->)]]; auto; exfalso; lra.
Qed.
(** Rounds an array of integers by whole bits, with an error below one unit of 2^excess, or not at all. *)
Definition cut (excess c : Z) : Z := (Z.sgn c * (Z.abs c / 2 ^ excess))%Z.
Lemma cut_within excess c : (0 < excess)%Z -> Rabs (IZR (cut excess c) * IZR (2 ^ excess) - IZR c) <= 1 * IZR (2 ^ excess).
Proof.
  intros E. pose proof (Z.pow_pos_nonneg 2 excess ltac:(lia) ltac:(lia)) as P. set (u := (2 ^ excess)%Z) in *.
  rewrite Rmult_1_l, <- mult_IZR, <- minus_IZR, <- abs_IZR. apply IZR_le. unfold cut. fold u.
  pose proof (Z.div_mod (Z.abs c) u ltac:(lia)). pose proof (Z.mod_pos_bound (Z.abs c) u P).
  set (q := (Z.abs c / u)%Z) in *. apply Z.abs_le. pose proof (Z.sgn_abs c).
  destruct (Z.sgn_spec c) as [(B & E') | [(B & E') | (B & E')]]; rewrite E' in *; nia.
Qed.

(** x·2^shift, rounded towards zero (`shifted` of include/errbound/integers/dyadic.hpp). *)
Definition cut_shift (shift x : Z) : Z := if (0 <=? shift)%Z then (x * 2 ^ shift)%Z else cut (- shift) x.
Lemma pow2_integer e : (0 <= e)%Z -> IZR (2 ^ e) = pow2 e.
Proof. exact (IZR_Zpower radix2 e). Qed.
Lemma cut_shift_near shift x : Rabs (IZR (cut_shift shift x) - IZR x * pow2 shift) <= 1.
Proof.
  unfold cut_shift. destruct (Z.leb_spec 0 shift) as [P | P].
  - rewrite mult_IZR, pow2_integer, Rminus_diag_eq, Rabs_R0 by easy. lra.
  - pose proof (cut_within (- shift) x ltac:(lia)) as H. rewrite pow2_integer, bpow_opp in H by lia.
    pose proof (bpow_gt_0 radix2 shift) as Q. rewrite (Rmult_comm 1), Rmult_1_r in H.
    replace (IZR (cut (- shift) x) - IZR x * pow2 shift) with (pow2 shift * (IZR (cut (- shift) x) * / pow2 shift - IZR x))
      by (field; lra).
    rewrite Rabs_mult, Rabs_pos_eq by lra. apply Rmult_le_reg_l with (/ pow2 shift); [now apply Rinv_0_lt_compat |].
    rewrite <- Rmult_assoc, Rinv_l, Rmult_1_l, Rmult_1_r by lra. exact H.
Qed.
Lemma cut_shift_0 x : cut_shift 0 x = x.
Proof. unfold cut_shift. simpl. ring. Qed.
Lemma cut_shift_nonnegative shift x : (0 <= x)%Z -> (0 <= cut_shift shift x)%Z.
Proof.
  intros X. unfold cut_shift, cut. destruct (Z.leb_spec 0 shift); [apply Z.mul_nonneg_nonneg; [easy | apply Z.pow_nonneg; lia] |].
  apply Z.mul_nonneg_nonneg; [lia |]. apply Z.div_pos; [lia | apply Z.pow_pos_nonneg; lia].
Qed.
Lemma cut_shift_below shift x : (0 <= x)%Z -> IZR (cut_shift shift x) <= IZR x * pow2 shift.
Proof.
  intros X. unfold cut_shift. destruct (Z.leb_spec 0 shift) as [P | P]; [rewrite mult_IZR, pow2_integer by easy; lra |].
  unfold cut. assert (Q : (0 < 2 ^ (- shift))%Z) by (apply Z.pow_pos_nonneg; lia).
  assert (E : (Z.sgn x * (Z.abs x / 2 ^ (- shift)) = x / 2 ^ (- shift))%Z).
  { rewrite Z.abs_eq by easy. destruct (Z.eq_dec x 0) as [-> | N]; [now rewrite Z.div_0_l by lia |]. rewrite Z.sgn_pos by lia. ring. }
  rewrite E. pose proof (Z.mul_div_le x _ Q) as H. apply IZR_le in H. rewrite mult_IZR, pow2_integer, bpow_opp in H by lia.
  pose proof (bpow_gt_0 radix2 shift) as R. apply Rmult_le_compat_l with (r := pow2 shift) in H; [| lra].
  rewrite <- Rmult_assoc, Rinv_r, Rmult_1_l in H by lra. lra.
Qed.

(** The constructor, from numbers with errors up to `error`: rounded by `excess` bits, or shifted exactly. *)
Definition cut_row (excess : Z) (b : list Z) : list Z := map (cut_shift (- excess)) b.
Definition cut_error (excess error : Z) : Z := (cut_shift (- excess) error + 2)%Z.
Theorem row_cut_right excess error b truth : (0 <= error)%Z -> within b error 1 truth ->
  (0 <= cut_error excess error)%Z /\ within (cut_row excess b) (cut_error excess error) (pow2 excess) truth.
Proof.
  intros E W. pose proof (cut_shift_nonnegative (- excess) error E) as N.
  split; [unfold cut_error; lia |]. unfold cut_row. induction W as [| x c b truth C W IH]; constructor; auto.
  pose proof (cut_shift_near (- excess) x) as Hx. pose proof (cut_shift_near (- excess) error) as He.
  rewrite bpow_opp in Hx, He. pose proof (bpow_gt_0 radix2 excess) as P. unfold cut_error. rewrite plus_IZR, !Rmult_1_r in *.
  set (u := pow2 excess) in *. set (y := IZR (cut_shift (- excess) x)) in *. set (e := IZR (cut_shift (- excess) error)) in *.
  apply Rabs_le_inv in Hx, He, C. apply Rabs_le.
  assert (G : forall a b, a <= b -> a * u <= b * u) by (intros; apply Rmult_le_compat_r; lra).
  assert (Kx : IZR x * / u * u = IZR x) by (field; lra). assert (Ke : IZR error * / u * u = IZR error) by (field; lra).
  destruct Hx as (X1 & X2), He as (E1 & E2). apply G in X1, X2, E1, E2. lra.
Qed.
(** If errors are too large, all numbers become zero, and all their signs uncertain. *)
Theorem row_uncertain b truth : length b = length truth ->
  Forall2 sign_seen (map (fun _ : Z => row_sign 0 0) b) (map sgn truth).
Proof.
  revert truth. induction b as [| x b IH]; intros [| c truth] L; try discriminate; [constructor |].
  injection L as L. constructor; [| now apply IH]. split; [| easy]. pose proof (sgn_plain [c]) as F. now inversion_clear F.
Qed.

(** Halving: each step takes sums of neighbours without their last bit (from_bit), with an error of half a unit. The
    left half has the first of each row, the right half the last. *)
Fixpoint next_row (row : list Z) : list Z :=
  match row with a :: (b :: _) as l => ((a + b) / 2)%Z :: next_row l | _ => [] end.
Fixpoint first_of_cut_rows (n : nat) (row : list Z) : list Z :=
  match n with O => [] | S n => hd 0%Z row :: first_of_cut_rows n (next_row row) end.

Definition number_at (row : list Z) (i : nat) : Z := nth i row 0%Z.
Fixpoint cut_first (g : nat -> Z) (j : nat) : Z :=
  match j with O => g O | S j => cut_first (fun i => (g i + g (S i)) / 2)%Z j end.

Lemma row_first_halved j f : row_first (fun i => f i / 2) j = row_first f j / 2.
Proof.
  revert f. induction j as [| j IH]; intros f; [easy |]. cbn [row_first]. rewrite <- IH.
  apply row_first_same. intros i _. lra.
Qed.
Lemma cut_first_near unit j : 0 < unit -> forall g f e, (forall i, (i <= j)%nat -> Rabs (IZR (g i) * unit - f i) <= e) ->
  Rabs (IZR (cut_first g j) * unit - row_first f j / 2 ^ j) <= e + INR j * (unit / 2).
Proof.
  intros U. induction j as [| j IH]; intros g f e B.
  - simpl. specialize (B 0%nat ltac:(lia)). unfold Rdiv. rewrite Rinv_1, Rmult_1_r. lra.
  - cbn [cut_first row_first]. rewrite S_INR.
    replace (row_first (fun i => f i + f (S i)) j / 2 ^ S j) with (row_first (fun i => (f i + f (S i)) / 2) j / 2 ^ j).
    + apply Rle_trans with (e + unit / 2 + INR j * (unit / 2)); [| lra]. apply IH. intros i I.
      pose proof (B i ltac:(lia)) as A. pose proof (B (S i) ltac:(lia)) as C. apply Rabs_le_inv in A, C. apply Rabs_le.
      pose proof (Z.div_mod (g i + g (S i)) 2 ltac:(lia)) as D. pose proof (Z.mod_pos_bound (g i + g (S i)) 2 ltac:(lia)) as M.
      set (q := ((g i + g (S i)) / 2)%Z) in *. set (m := ((g i + g (S i)) mod 2)%Z) in *.
      apply (f_equal IZR) in D. rewrite !plus_IZR, mult_IZR in D.
      assert (M' : 0 <= IZR m <= 1) by (split; apply IZR_le; lia).
      assert (0 <= IZR m * unit <= unit) by (split; [apply Rmult_le_pos; lra |]; rewrite <- (Rmult_1_l unit) at 2; apply Rmult_le_compat_r; lra).
      assert (IZR (g i) * unit + IZR (g (S i)) * unit = 2 * (IZR q * unit) + IZR m * unit) by (rewrite <- Rmult_plus_distr_r, D; ring). lra.
    + rewrite (row_first_halved j (fun i => f i + f (S i))). simpl. field. apply pow_nonzero. lra.
Qed.

Lemma cut_first_same f g i : (forall j, (j <= i)%nat -> f j = g j) -> cut_first f i = cut_first g i.
Proof.
  revert f g. induction i as [| i IH]; intros f g E; simpl; [apply E; lia |]. apply IH. intros j J. now rewrite !E by lia.
Qed.
Lemma next_row_length l : length (next_row l) = Nat.pred (length l).
Proof. induction l as [| a [| b l] IH]; simpl in *; auto. Qed.
Lemma next_row_index l i : (S i < length l)%nat -> number_at (next_row l) i = ((number_at l i + number_at l (S i)) / 2)%Z.
Proof.
  unfold number_at. revert i. induction l as [| a [| b l] IH]; intros i L; simpl in L; try lia.
  destruct i as [| i]; [easy |]. change (nth (S i) (next_row (a :: b :: l)) 0%Z) with (nth i (next_row (b :: l)) 0%Z).
  rewrite IH by (simpl; lia). easy.
Qed.
Lemma first_of_cut_rows_index i : forall m l, (i < m)%nat -> (i < length l)%nat ->
  number_at (first_of_cut_rows m l) i = cut_first (number_at l) i.
Proof.
  induction i as [| i IH]; intros [| m] l M L; try lia; [now destruct l |].
  change (number_at (first_of_cut_rows (S m) l) (S i)) with (number_at (first_of_cut_rows m (next_row l)) i).
  rewrite IH by (rewrite ?next_row_length; lia). simpl. apply cut_first_same. intros j J. apply next_row_index. lia.
Qed.
Lemma first_of_cut_rows_length n l : length (first_of_cut_rows n l) = n.
Proof. revert l. induction n as [| n IH]; intros l; simpl; auto. Qed.

Lemma within_index row e unit b : within row e unit b <-> length row = length b /\
  forall i, (i < length row)%nat -> Rabs (IZR (number_at row i) * unit - at_index b i) <= IZR e * unit.
Proof.
  split.
  - intros W. induction W as [| x c row b C W (L & IH)]; [split; [easy | simpl; lia] |]. split; [simpl; lia |].
    intros [| i] I; [exact C | apply IH; simpl in I; lia].
  - revert b. induction row as [| x row IH]; intros [| c b] (L & H); try discriminate; constructor.
    + apply (H 0%nat). simpl. lia.
    + apply IH. split; [now injection L |]. intros i I. apply (H (S i)). simpl. lia.
Qed.

(** error_ += (n + 1)/2 *)
Definition error_after (n : nat) (error : Z) : Z := (error + (Z.of_nat n + 1) / 2)%Z.
Definition left_row (n : nat) (row : list Z) : list Z := first_of_cut_rows (S n) row.
Definition right_row (n : nat) (row : list Z) : list Z := rev (first_of_cut_rows (S n) (rev row)).

Lemma left_row_within n row error unit b : 0 < unit -> length b = S n -> within row error unit b ->
  within (left_row n row) (error_after n error) unit (map (Rmult (/ 2 ^ n)) (left_half n b)).
Proof.
  intros U L W. apply within_index in W. destruct W as (Lr & W). apply within_index. unfold left_row, left_half.
  rewrite map_length, times_descending_length, first_of_rows_length, first_of_cut_rows_length. split; auto. intros i I.
  rewrite first_of_cut_rows_index by lia. unfold at_index.
  replace (nth i (map (Rmult (/ 2 ^ n)) (times_descending 2 (first_of_rows (S n) b))) 0)
    with (/ 2 ^ n * at_index (times_descending 2 (first_of_rows (S n) b)) i).
  2: { unfold at_index. rewrite <- (map_nth (Rmult (/ 2 ^ n))). rewrite Rmult_0_r. easy. }
  rewrite times_descending_index, first_of_rows_index by (rewrite ?first_of_rows_length; lia). rewrite first_of_rows_length.
  replace (/ 2 ^ n * (row_first (at_index b) i * 2 ^ (S n - 1 - i))) with (row_first (at_index b) i / 2 ^ i).
  - apply Rle_trans with (1 := cut_first_near unit i U (number_at row) (at_index b) (IZR error * unit) ltac:(intros j J; apply W; lia)).
    unfold error_after. rewrite plus_IZR, Rmult_plus_distr_r. apply Rplus_le_compat_l.
    assert (H : IZR (Z.of_nat n) <= 2 * IZR ((Z.of_nat n + 1) / 2)).
    { rewrite <- mult_IZR. apply IZR_le. pose proof (Z.div_mod (Z.of_nat n + 1) 2 ltac:(lia)).
      pose proof (Z.mod_pos_bound (Z.of_nat n + 1) 2 ltac:(lia)). lia. }
    assert (K : INR i <= IZR (Z.of_nat n)) by (rewrite <- INR_IZR_INZ; apply le_INR; lia).
    replace (INR i * (unit / 2)) with (INR i / 2 * unit) by field. apply Rmult_le_compat_r; lra.
  - replace n with (i + (S n - 1 - i))%nat at 1 by lia. rewrite pow_add. field. split; apply pow_nonzero; lra.
Qed.
Lemma within_rev row e unit b : within row e unit b -> within (rev row) e unit (rev b).
Proof.
  intros W. induction W as [| x c row b C W IH]; [constructor |]. simpl. apply Forall2_app; auto.
Qed.
Lemma controls_scaled c b p lo hi : 0 < c -> controls b p lo hi -> controls (map (Rmult c) b) p lo hi.
Proof.
  intros C (d & D & E). exists (c * d). split; [now apply Rmult_lt_0_compat |]. intros t. rewrite Rmult_assoc, <- E.
  unfold on_unit, scaled_coefficients. rewrite map_length.
  assert (G : forall k b, products k (map (Rmult c) b) = map (Rmult c) (products k b)).
  { induction k as [| x k IH]; intros [| y m]; simpl; auto. rewrite IH. f_equal. ring. }
  rewrite G. apply form_scaled.
Qed.

(** fixed_row::halves *)
Theorem row_halves_right p lo hi n row error unit b : 0 < unit -> length b = S n -> controls b p lo hi ->
  within row error unit b -> exists left right,
    controls left p lo ((lo + hi) / 2) /\ within (left_row n row) (error_after n error) unit left /\
    controls right p ((lo + hi) / 2) hi /\ within (right_row n row) (error_after n error) unit right.
Proof.
  intros U L C W. destruct (halves_right p lo hi n b L C) as (Cl & Cr).
  assert (P : 0 < / 2 ^ n) by (apply Rinv_0_lt_compat, pow_lt; lra).
  exists (map (Rmult (/ 2 ^ n)) (left_half n b)), (map (Rmult (/ 2 ^ n)) (right_half n b)).
  split; [now apply controls_scaled |]. split; [now apply left_row_within |]. split; [now apply controls_scaled |].
  unfold right_row, right_half. rewrite map_rev. apply within_rev. fold (left_half n (rev b)). fold (left_row n (rev row)).
  apply left_row_within; auto; [now rewrite rev_length | now apply within_rev].
Qed.

Local Open Scope Z_scope.

(** ** The weights

    inverse_binomials: C(n, i) from C(n, i - 1), the least common multiple step by step, and quotients. *)
Fixpoint row_from (n i : Z) (c : Z) (rest : nat) : list Z :=
  match rest with O => [c] | S rest => c :: row_from n (i + 1) (c * (n - i) / (i + 1)) rest end.
Definition binomial_row (n : nat) : list Z := row_from (Z.of_nat n) 0 1 n.
Fixpoint common_multiple (m : Z) (l : list Z) : Z :=
  match l with [] => m | c :: l => common_multiple (m * (c / Z.gcd m c)) l end.
Definition weights (n : nat) : list Z :=
  let b := binomial_row n in let m := common_multiple 1 b in map (fun c => m / c) b.

Lemma common_multiple_right l : Forall (fun c => 0 < c) l -> forall m, 0 < m ->
  (m | common_multiple m l) /\ 0 < common_multiple m l /\ Forall (fun c => (c | common_multiple m l)) l.
Proof.
  induction 1 as [| c l C F IH]; intros m M; [repeat split; [apply Z.divide_refl | easy | constructor] |]. cbn [common_multiple].
  pose proof (Z.gcd_divide_l m c) as (a & A). pose proof (Z.gcd_divide_r m c) as (b & B).
  pose proof (Z.gcd_nonneg m c) as G. set (g := Z.gcd m c) in *.
  assert (Gp : 0 < g) by (assert (g <> 0) by (intros E; rewrite E in B; lia); lia). assert (Q : c / g = b) by (rewrite B; apply Z.div_mul; lia). rewrite Q.
  assert (Bp : 0 < b) by nia. destruct (IH (m * b)) as (D & P & Fd); [nia |].
  split; [apply Z.divide_trans with (2 := D); apply Z.divide_factor_l |]. split; auto. constructor; auto.
  apply Z.divide_trans with (2 := D). exists a. clearbody g. transitivity (a * g * b); [now rewrite <- A | transitivity (a * (b * g)); [ring | now rewrite <- B]].
Qed.

Fixpoint choose (n k : nat) : Z :=
  match n, k with _, O => 1 | O, S _ => 0 | S n, S k => choose n k + choose n (S k) end.
Lemma choose_next n : forall k, (Z.of_nat k + 1) * choose n (S k) = (Z.of_nat n - Z.of_nat k) * choose n k.
Proof.
  induction n as [| n IH]; intros [| k]; try (cbn [choose]; ring).
  - specialize (IH 0%nat). change (choose (S n) 1) with (choose n 0 + choose n 1). change (choose (S n) 0) with 1.
    replace (choose n 0) with 1 in * by (now destruct n). lia.
  - pose proof (IH k) as A. pose proof (IH (S k)) as B. change (choose (S n) (S (S k))) with (choose n (S k) + choose n (S (S k))).
    change (choose (S n) (S k)) with (choose n k + choose n (S k)). lia.
Qed.
Lemma choose_nonnegative n : forall k, 0 <= choose n k.
Proof. induction n as [| n IH]; intros [| k]; simpl; try lia. pose proof (IH k). pose proof (IH (S k)). lia. Qed.
Lemma choose_positive n : forall k, (k <= n)%nat -> 0 < choose n k.
Proof. induction n as [| n IH]; intros [| k] K; simpl; try lia. pose proof (IH k ltac:(lia)). pose proof (choose_nonnegative n (S k)). lia. Qed.
Lemma choose_beyond n : forall k, (n < k)%nat -> choose n k = 0.
Proof. induction n as [| n IH]; intros [| k] K; try lia; [easy |]. simpl. rewrite !IH by lia. ring. Qed.

Lemma row_from_right n rest : forall i, (i + rest = n)%nat ->
  row_from (Z.of_nat n) (Z.of_nat i) (choose n i) rest = map (choose n) (seq i (S rest)).
Proof.
  induction rest as [| rest IH]; intros i E; [easy |]. cbn [row_from seq map]. f_equal.
  replace (Z.of_nat i + 1) with (Z.of_nat (S i)) by lia. rewrite Z.mul_comm, <- choose_next.
  replace (Z.of_nat i + 1) with (Z.of_nat (S i)) by lia. rewrite Z.mul_comm, Z.div_mul by lia. apply (IH (S i)). lia.
Qed.
Lemma pascal_row n m : forall i c, (i + m = S n)%nat -> c = (match i with O => 0 | S j => IZR (choose n j) end)%R ->
  map (fun xy => fst xy + snd xy)%R (combine (map (fun k => IZR (choose n k)) (seq i m) ++ [0%R])
    (c :: map (fun k => IZR (choose n k)) (seq i m))) = map (fun k => IZR (choose (S n) k)) (seq i (S m)).
Proof.
  induction m as [| m IH]; intros i c E C.
  - assert (i = S n) as -> by lia. rewrite C. cbn [seq map app combine fst snd choose]. rewrite plus_IZR, (choose_beyond n (S n)) by lia. f_equal. ring.
  - cbn [seq map app combine fst snd]. f_equal.
    + rewrite C. destruct i as [| j]; cbn [choose]; [destruct n; simpl; ring | rewrite plus_IZR; ring].
    + apply (IH (S i)); [lia | easy].
Qed.
Lemma binomial_row_right n : map IZR (binomial_row n) = binomials n /\ Forall (fun c => 0 < c) (binomial_row n).
Proof.
  assert (E : binomial_row n = map (choose n) (seq 0 (S n))).
  { unfold binomial_row. replace 1 with (choose n 0) by (now destruct n). now apply (row_from_right n n 0). }
  rewrite E, map_map. split.
  - clear E. induction n as [| n IH]; [easy |]. cbn [binomials]. rewrite <- IH. symmetry. now apply pascal_row.
  - apply Forall_map, Forall_forall. intros k K. apply in_seq in K. apply choose_positive. lia.
Qed.

Theorem weights_right n : exists multiple, (0 < multiple)%R /\ inverse_binomials multiple (map IZR (weights n)) n.
Proof.
  destruct (binomial_row_right n) as (E & P). destruct (common_multiple_right _ P 1 ltac:(lia)) as (_ & M & D).
  exists (IZR (common_multiple 1 (binomial_row n))). split; [now apply IZR_lt |].
  unfold inverse_binomials, weights. rewrite <- E. cbv zeta. clear E.
  set (m := common_multiple 1 (binomial_row n)) in *. clearbody m. induction P as [| c l C P IH]; [constructor |].
  inversion_clear D as [| ? ? (q & Q) D']. constructor; auto. rewrite <- mult_IZR. f_equal. rewrite Q, Z.div_mul by lia. ring.
Qed.

(** The products of both loops that must fit in 64 bits for n <= 40. *)
Fixpoint row_products (n i c : Z) (rest : nat) : list Z :=
  match rest with O => [] | S rest => c * (n - i) :: row_products n (i + 1) (c * (n - i) / (i + 1)) rest end.
Fixpoint multiples (m : Z) (l : list Z) : list Z :=
  match l with [] => [] | c :: l => let m := m * (c / Z.gcd m c) in m :: multiples m l end.
Theorem weights_fit n : (n <= 40)%nat ->
  Forall (fun z => z < 2 ^ 64) (row_products (Z.of_nat n) 0 1 n ++ multiples 1 (binomial_row n) ++ weights n).
Proof.
  intros N. assert (H : forallb (fun n => forallb (fun z => z <? 2 ^ 64)
    (row_products (Z.of_nat n) 0 1 n ++ multiples 1 (binomial_row n) ++ weights n)) (seq 0 41) = true).
  { change (2 ^ 64) with 18446744073709551616. now vm_compute. }
  rewrite forallb_forall in H. specialize (H n ltac:(apply in_seq; lia)). rewrite forallb_forall in H.
  apply Forall_forall. intros z Z. now apply Z.ltb_lt, H.
Qed.
