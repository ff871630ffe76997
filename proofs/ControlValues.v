(** Bounds of the positive roots and control values of any degree, as include/errbound/root_isolation.hpp
    computes them in integers.

    Results:
        root_exponent_right        no root of p is at or above 2^(positive_root_exponent(p))
        half_line_right            all positive roots lie strictly between the points used as bounds
        control_values_on_right    control_values_on is a positive multiple of p's control values
        halves_right               halves: of the control values on the two halves *)

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

(** Bounds on both sides: half_line, and the points beyond them that `inside` takes (unlikely_root). *)
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

(** Of n + 1 control values f 0, ..., f n: the form's value, by de Casteljau. *)
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
(** What n passes leave: the first of each row. *)
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

(** control_values_on. Its passes over the array, in order: powers of 2^e; Taylor's shift by `start`,
    Horner's rule on shorter and shorter parts; weights and powers of `length`; sums. *)
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

(** halves: each row's first and last value, times the powers of two that make up for the halvings. *)
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

Theorem halves_right p lo hi n b : length b = S n -> controls b p lo hi ->
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
