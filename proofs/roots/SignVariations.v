(** Descartes' rule as the code counts it (include/errbound/roots/sign_variations.hpp), over the real numbers: for
    forms of any degree, on the open interval where s and t are positive. Results:
        no_variation_no_root     without a sign change there is no root inside
        one_variation_one_root   with one, and no root at the ends, there is one root inside, where the sign changes
        two_variations_two_roots with at most two, equal signs at the ends and another sign at a position between,
            there
                                 is one root on each side of that position
        max_variations_right     the count of uncertain signs is not below the true number if it is below 3, and both
                                 are even or both odd *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Errbound Require Import Sign Bernstein.
Import ListNotations.
Open Scope R_scope.

(** ** The code: signs are 1, -1 and 0 *)

Definition sgn (x : R) : Z := if Rlt_dec 0 x then 1 else if Rlt_dec x 0 then -1 else 0.

Fixpoint changes_after (last : Z) (signs : list Z) : nat :=
  match signs with
  | [] => 0
  | s :: l =>
      if (s =? 0)%Z then changes_after last l
      else (if (s =? - last)%Z then 1 else 0) + changes_after s l
  end.
Definition sign_variations (signs : list Z) : nat := changes_after 0 signs.

Fixpoint max_after (last : Z) (most open : nat) (signs : list Z) : nat :=
  match signs with
  | [] => if (0 <? open)%nat then 3 else most
  | s :: l =>
      if (s =? 0)%Z then max_after last most (S open) l
      else
        let most := (most + if (s =? last)%Z then (open + 1) / 2 * 2 else open / 2 * 2 + 1)%nat in
        if (2 <? most)%nat then 3 else max_after s most 0 l
  end.
Definition max_sign_variations (signs : list Z) : nat :=
  match signs with
  | [] => 3
  | s :: l => if (s =? 0)%Z then 3 else max_after s 0 0 l
  end.

Lemma sgn_cases x : (0 < x /\ sgn x = 1%Z) \/ (x < 0 /\ sgn x = (-1)%Z) \/ (x = 0 /\ sgn x = 0%Z).
Proof. unfold sgn. destruct Rlt_dec; [now left |]. destruct Rlt_dec; [right; now left |]. right. right. split; [lra | easy]. Qed.
Ltac sgn_of x := let H := fresh "L" in let E := fresh "E" in
  destruct (sgn_cases x) as [(H & E) | [(H & E) | (H & E)]]; rewrite ?E in *.

(** ** Uncertain signs *)

Definition plain (s : Z) : Prop := s = 1%Z \/ s = (-1)%Z.
(** A known sign s, where 0 is uncertain. *)
Definition sign_seen (s : Z) (true_sign : Z) : Prop :=
  (plain true_sign \/ true_sign = 0%Z) /\ (s <> 0%Z -> s = true_sign).

Lemma run u last s rest : plain last -> plain s -> Forall (fun v => plain v \/ v = 0%Z) u ->
  exists c, changes_after last (u ++ s :: rest) = (c + changes_after s rest)%nat /\
    (c <= length u + 1)%nat /\ Nat.even c = (s =? last)%Z.
Proof.
  intros L P F. revert last L. induction F as [| v u V F IH]; intros last L.
  - simpl. exists (if (s =? - last)%Z then 1 else 0)%nat.
    destruct L as [-> | ->], P as [-> | ->]; simpl; repeat split; lia.
  - simpl. destruct V as [V | ->].
    + destruct (IH v V) as (c & E & Le & Ev). rewrite E.
      exists ((if (v =? - last)%Z then 1 else 0) + c)%nat.
      destruct L as [-> | ->], V as [-> | ->], P as [-> | ->]; cbn [Z.eqb Pos.eqb Z.opp] in *;
        rewrite ?Nat.even_add, ?Ev; repeat split; try (simpl; lia); now rewrite Ev.
    + destruct (IH last L) as (c & E & Le & Ev). exists c. simpl. repeat split; auto; lia.
Qed.

Lemma even_sum a b c d : Nat.even a = Nat.even b -> Nat.even c = Nat.even d ->
  Nat.even (a + c) = Nat.even (b + d).
Proof. intros H K. now rewrite !Nat.even_add, H, K. Qed.

Lemma max_after_right signs truth : Forall2 sign_seen signs truth ->
  forall u last most open, plain last -> Forall (fun v => plain v \/ v = 0%Z) u -> length u = open ->
  (max_after last most open signs < 3)%nat ->
  (most + changes_after last (u ++ truth) <= max_after last most open signs)%nat /\
  Nat.even (most + changes_after last (u ++ truth)) = Nat.even (max_after last most open signs).
Proof.
  induction 1 as [| s t signs truth (T & K) F IH]; intros u last most open L U O.
  - simpl. destruct open; simpl; intros B; [| lia]. destruct u; [| discriminate]. simpl. split; [lia | f_equal; lia].
  - cbn [max_after]. destruct (Z.eqb_spec s 0) as [-> | N].
    + intros B. destruct (IH (u ++ [t]) last most (S open)) as (A & E); auto.
      * apply Forall_app. split; auto.
      * rewrite app_length, O. simpl. lia.
      * rewrite <- app_assoc in A, E. now split.
    + specialize (K N). subst t. assert (P : plain s) by (destruct T; [easy | now subst]).
      cbv zeta. set (more := if (s =? last)%Z then ((open + 1) / 2 * 2)%nat else (open / 2 * 2 + 1)%nat).
      destruct (Nat.ltb_spec 2 (most + more)); [lia |]. intros B.
      destruct (IH [] s (most + more)%nat 0%nat P (Forall_nil _) eq_refl B) as (A & E). cbn [app] in A, E.
      destruct (run u last s truth L P U) as (c & Ec & Le & Ev). rewrite Ec.
      assert (M : (c <= more)%nat /\ Nat.even c = Nat.even more).
      { pose proof (Nat.div_mod open 2 ltac:(lia)). pose proof (Nat.mod_upper_bound open 2 ltac:(lia)).
        pose proof (Nat.div_mod (open + 1) 2 ltac:(lia)). pose proof (Nat.mod_upper_bound (open + 1) 2 ltac:(lia)).
        rewrite O in Le. rewrite Ev. unfold more in *. destruct (s =? last)%Z.
        - apply Nat.even_spec in Ev. destruct Ev as (d & D).
          split; [lia |]. now rewrite Nat.even_mul, orb_true_r.
        - assert (Od : Nat.odd c = true) by (unfold Nat.odd; now rewrite Ev).
          apply Nat.odd_spec in Od. destruct Od as (d & D).
          split; [lia |]. now rewrite Nat.even_add, Nat.even_mul, orb_true_r. }
      split; [lia |]. rewrite <- E, !Nat.add_assoc.
      apply even_sum; auto. now apply even_sum.
Qed.

Theorem max_variations_right signs truth : Forall2 sign_seen signs truth ->
  (max_sign_variations signs < 3)%nat ->
  (sign_variations truth <= max_sign_variations signs)%nat /\
  Nat.even (sign_variations truth) = Nat.even (max_sign_variations signs).
Proof.
  intros F. destruct F as [| s t signs truth (T & K) F]; [simpl; lia |].
  unfold max_sign_variations. destruct (Z.eqb_spec s 0) as [-> | N]; [lia |].
  specialize (K N). subst t. assert (P : plain s) by (destruct T; [easy | now subst]). intros B.
  destruct (max_after_right _ _ F [] s 0 0 P (Forall_nil _) eq_refl B) as (A & E).
  cbn [app] in A, E. unfold sign_variations. cbn [changes_after].
  destruct (Z.eqb_spec s 0); [easy |]. destruct (Z.eqb_spec s (- 0)); [easy |]. now split.
Qed.

(** ** Consequences of the number of changes for the coefficients *)

(** n changes, starting with the sign sg. *)
Inductive alternates : Z -> nat -> list R -> Prop :=
| one_block sg a : Forall (fun x => 0 <= IZR sg * x) a -> alternates sg 0 a
| next_block sg n a b l : Forall (fun x => 0 <= IZR sg * x) a -> IZR sg * b < 0 ->
    alternates (- sg) n (b :: l) -> alternates sg (S n) (a ++ b :: l).

Lemma alternates_cons sg n x l : 0 <= IZR sg * x -> alternates sg n l -> alternates sg n (x :: l).
Proof.
  intros P A. destruct A.
  - constructor. now constructor.
  - apply next_block with (a := x :: a); auto.
Qed.
Lemma changes_alternate sg l : plain sg -> alternates sg (changes_after sg (map sgn l)) l.
Proof.
  revert sg. induction l as [| x l IH]; intros sg P; simpl; [constructor; constructor |].
  destruct P as [-> | ->]; sgn_of x; cbn [Z.eqb Pos.eqb Z.opp Nat.add].
  - apply alternates_cons; [lra |]. apply IH. now left.
  - apply (next_block 1 _ [] x l); [constructor | lra |]. apply alternates_cons; [simpl; lra |]. apply IH. now right.
  - apply alternates_cons; [lra |]. apply IH. now left.
  - apply (next_block (-1) _ [] x l); [constructor | lra |]. apply alternates_cons; [simpl; lra |]. apply IH. now left.
  - apply alternates_cons; [lra |]. apply IH. now right.
  - apply alternates_cons; [lra |]. apply IH. now right.
Qed.
Lemma variations_alternate x l : x <> 0 ->
  alternates (sgn x) (sign_variations (map sgn (x :: l))) (x :: l) /\ plain (sgn x).
Proof.
  intros N. unfold sign_variations. cbn [map changes_after].
  sgn_of x; try easy; cbn [Z.eqb Pos.eqb Z.opp Nat.add].
  - split; [| now left]. apply alternates_cons; [lra |]. apply changes_alternate. now left.
  - split; [| now right]. apply alternates_cons; [lra |]. apply changes_alternate. now right.
Qed.

(** ** Polynomials in x > 0 *)

Lemma power_form_app a b x : power_form (a ++ b) x = power_form a x + x ^ length a * power_form b x.
Proof. induction a as [| c a IH]; simpl; [| rewrite IH]; ring. Qed.
Lemma power_form_opp a x : power_form (map Ropp a) x = - power_form a x.
Proof. induction a as [| c a IH]; simpl; [| rewrite IH]; ring. Qed.
Lemma power_form_nonnegative a x : Forall (Rle 0) a -> 0 <= x -> 0 <= power_form a x.
Proof.
  intros F X. induction F as [| c a C F IH]; simpl; [lra |]. assert (0 <= x * power_form a x) by (apply Rmult_le_pos; lra). lra.
Qed.

Lemma rises b x y : Forall (Rle 0) b -> 0 < x <= y -> power_form b x <= power_form b y.
Proof.
  intros F (X & Y). induction F as [| c b C F IH]; simpl; [lra |].
  apply Rplus_le_compat_l, Rmult_le_compat; try lra. apply power_form_nonnegative; auto. lra.
Qed.
Lemma below_a_power a x y : Forall (Rle 0) a -> 0 < x < y ->
  x ^ length a * power_form a y <= y ^ length a * power_form a x /\
  (Exists (Rlt 0) a -> x ^ length a * power_form a y < y ^ length a * power_form a x).
Proof.
  intros F (X & Y). induction F as [| c a C F (W & S)]; simpl; [split; [lra | intros E; inversion E] |].
  assert (Px : 0 < x ^ length a) by (apply pow_lt; lra). assert (Py : 0 < y ^ length a) by (apply pow_lt; lra).
  assert (Q : x ^ length a <= y ^ length a) by (apply pow_incr; lra).
  set (f := power_form a x) in *. set (g := power_form a y) in *.
  set (v := x ^ length a) in *. set (w := y ^ length a) in *.
  assert (XY : 0 < x * y) by (apply Rmult_lt_0_compat; lra).
  assert (V : x * v < y * w) by (apply Rlt_le_trans with (y * v); [apply Rmult_lt_compat_r; lra | apply Rmult_le_compat_l; lra]).
  assert (K : x * v * c <= y * w * c) by (apply Rmult_le_compat_r; lra).
  split.
  - assert (x * y * (v * g) <= x * y * (w * f)) by (apply Rmult_le_compat_l; lra). lra.
  - intros E. inversion_clear E as [? ? Cp | ? ? E'].
    + assert (x * v * c < y * w * c) by (apply Rmult_lt_compat_r; lra).
      assert (x * y * (v * g) <= x * y * (w * f)) by (apply Rmult_le_compat_l; lra). lra.
    + assert (x * y * (v * g) < x * y * (w * f)) by (apply Rmult_lt_compat_l; auto). lra.
Qed.

(** Coefficients >= 0, then <= 0: divided by a power of x, p decreases. *)
Lemma falls_once a b x y : Forall (Rle 0) a -> Exists (Rlt 0) a -> Forall (fun c => c <= 0) b ->
  0 < x < y -> power_form (a ++ b) x <= 0 -> power_form (a ++ b) y < 0.
Proof.
  intros A E B H L. rewrite power_form_app in *.
  destruct (below_a_power a x y A H) as (_ & S). specialize (S E).
  assert (M : power_form b y <= power_form b x).
  { assert (Forall (Rle 0) (map Ropp b)) by (apply Forall_map; eapply Forall_impl; [| exact B]; simpl; intros; lra).
    pose proof (rises (map Ropp b) x y H0 ltac:(lra)). rewrite !power_form_opp in H1. lra. }
  assert (Px : 0 < x ^ length a) by (apply pow_lt; lra). assert (Py : 0 < y ^ length a) by (apply pow_lt; lra).
  set (v := x ^ length a) in *. set (w := y ^ length a) in *.
  apply Rmult_lt_reg_l with v; auto. rewrite Rmult_0_r.
  assert (w * (power_form a x + v * power_form b x) <= 0) by (apply Rle_trans with (w * 0); [apply Rmult_le_compat_l |]; lra).
  assert (v * w * power_form b y <= v * w * power_form b x) by (apply Rmult_le_compat_l; [apply Rmult_le_pos |]; lra).
  lra.
Qed.

(** x dp/dx - k p, the derivative of p/x^k up to a positive factor. *)
Fixpoint slope_at (p : list R) (x : R) : R :=
  match p with [] => 0 | a :: l => power_form l x + x * slope_at l x end.
Lemma derivable_power_form p x : derivable_pt_lim (power_form p) x (slope_at p x).
Proof.
  induction p as [| a l IH]; simpl; [apply derivable_pt_lim_const |].
  replace (power_form l x + x * slope_at l x) with (0 + (1 * power_form l x + x * slope_at l x)) by ring.
  apply (derivable_pt_lim_plus (fct_cte a) (fun y => y * power_form l y)); [apply derivable_pt_lim_const |].
  apply (derivable_pt_lim_mult id (power_form l)); [apply derivable_pt_lim_id | exact IH].
Qed.
Lemma continuous_power_form p : continuity (power_form p).
Proof. intros x. apply derivable_continuous_pt. exists (slope_at p x). apply derivable_power_form. Qed.

Fixpoint weighted (k : R) (p : list R) : list R :=
  match p with [] => [] | a :: l => - k * a :: weighted (k - 1) l end.
Lemma weighted_slope k p x : x * slope_at p x - k * power_form p x = power_form (weighted k p) x.
Proof. revert k. induction p as [| a l IH]; intros k; simpl; [ring |]. rewrite <- IH. ring. Qed.
Lemma weighted_app k a b : weighted k (a ++ b) = weighted k a ++ weighted (k - INR (length a)) b.
Proof.
  revert k. induction a as [| c a IH]; intros k; [now rewrite Rminus_0_r |].
  cbn [app weighted length]. rewrite IH, S_INR. cbn [app]. do 2 f_equal. f_equal. ring.
Qed.
Lemma weighted_before k a : INR (length a) <= k -> Forall (Rle 0) a ->
  Forall (Rle 0) (map Ropp (weighted k a)) /\
  (Exists (Rlt 0) a -> Exists (Rlt 0) (map Ropp (weighted k a))).
Proof.
  intros K F. revert k K. induction F as [| c a C F IH]; intros k K; [split; [constructor | intros E; inversion E] |].
  cbn [length] in K. rewrite S_INR in K. pose proof (pos_INR (length a)).
  destruct (IH (k - 1) ltac:(lra)) as (W & S). cbn [weighted map]. split.
  - constructor; auto. assert (0 <= k * c) by (apply Rmult_le_pos; lra). lra.
  - intros E. inversion_clear E as [? ? P | ? ? E']; [left | right; auto].
    assert (0 < k * c) by (apply Rmult_lt_0_compat; lra). lra.
Qed.
Lemma weighted_after k b : k <= 0 -> Forall (Rle 0) b -> Forall (Rle 0) (weighted k b).
Proof.
  intros K F. revert k K. induction F as [| c b C F IH]; intros k K; simpl; constructor; [| apply IH; lra].
  assert (0 <= - k * c) by (apply Rmult_le_pos; lra). lra.
Qed.

Definition over_power (p : list R) (k : nat) (x : R) : R := power_form p x / x ^ k.
Definition over_power_slope (p : list R) (k : nat) (x : R) : R :=
  (slope_at p x * x ^ k - (INR k * x ^ pred k) * power_form p x) / Rsqr (x ^ k).
Lemma derivable_over_power p k x : 0 < x -> derivable_pt_lim (over_power p k) x (over_power_slope p k x).
Proof.
  intros X. apply (derivable_pt_lim_div (power_form p) (fun y => y ^ k));
    [apply derivable_power_form | apply derivable_pt_lim_pow |]. apply pow_nonzero. lra.
Qed.
Lemma over_power_slope_sign p k x : 0 < x ->
  over_power_slope p k x * (x * x ^ k) = power_form (weighted (INR k) p) x.
Proof.
  intros X. rewrite <- weighted_slope. unfold over_power_slope, Rsqr. destruct k as [| k]; [simpl; field |].
  cbn [pred]. change (x ^ S k) with (x * x ^ k) in *. field. split; [apply pow_nonzero |]; lra.
Qed.

(** With two changes, p divided by a power of x keeps rising once it rises. *)
Lemma rises_on a b c x y z : Forall (Rle 0) a -> Exists (Rlt 0) a -> Forall (fun v => v <= 0) b ->
  Forall (Rle 0) c -> 0 < x < y -> y < z ->
  power_form (a ++ b ++ c) x <= 0 -> 0 <= power_form (a ++ b ++ c) y -> 0 < power_form (a ++ b ++ c) z.
Proof.
  intros A E B C H Z Px Py. set (p := a ++ b ++ c) in *. set (k := length a).
  assert (W : forall u v, 0 < u < v -> 0 <= power_form (weighted (INR k) p) u -> 0 < power_form (weighted (INR k) p) v).
  { intros u v V U. unfold p in *. rewrite weighted_app, weighted_app in *.
    replace (INR k - INR (length a)) with 0 in * by (unfold k; ring).
    set (wa := weighted (INR k) a) in *. set (wb := weighted 0 b) in *. set (wc := weighted _ c) in *.
    destruct (weighted_before (INR k) a ltac:(unfold k; lra) A) as (Wa & Sa). specialize (Sa E).
    assert (Wb : Forall (Rle 0) (map Ropp wb)).
    { unfold wb. clear - B. assert (G : forall k, k <= 0 -> Forall (Rle 0) (map Ropp (weighted k b))); [| apply G; lra].
      induction B as [| d b D B IH]; intros k K; simpl; constructor; [| apply IH; lra].
      assert (0 <= - k * - d) by (apply Rmult_le_pos; lra). lra. }
    assert (Wc : Forall (Rle 0) wc) by (apply weighted_after; auto; pose proof (pos_INR (length b)); lra).
    pose proof (falls_once (map Ropp (wa ++ wb)) (map Ropp wc) u v) as G.
    rewrite <- map_app, !power_form_opp, <- app_assoc in G.
    enough (- power_form (wa ++ wb ++ wc) v < 0) by lra. apply G; auto; try lra.
    - rewrite map_app. apply Forall_app. now split.
    - rewrite map_app. apply Exists_app. now left.
    - apply Forall_map. eapply Forall_impl; [| exact Wc]. simpl. intros. lra. }
  assert (M : forall u v, 0 < u < v -> exists w, u < w < v /\ 0 < w * w ^ k /\
    (over_power p k v - over_power p k u) * (w * w ^ k) = power_form (weighted (INR k) p) w * (v - u)).
  { intros u v V. destruct (MVT_cor2 (over_power p k) (over_power_slope p k) u v) as (w & Ew & Hw); [lra | |].
    - intros w Hw. apply derivable_over_power. lra.
    - exists w. assert (0 < w ^ k) by (apply pow_lt; lra).
      split; [easy |]. split; [apply Rmult_lt_0_compat; lra |].
      rewrite Ew, <- over_power_slope_sign by lra. ring. }
  assert (Q : forall u, 0 < u -> power_form p u = over_power p k u * u ^ k /\ 0 < u ^ k).
  { intros u U. assert (0 < u ^ k) by (apply pow_lt; lra). split; auto. unfold over_power. field. lra. }
  destruct (M x y H) as (u & Hu & Pu & Eu). destruct (M y z ltac:(lra)) as (v & Hv & Pv & Ev).
  destruct (Q x) as (Ex & Kx); [lra |]. destruct (Q y) as (Ey & Ky); [lra |]. destruct (Q z) as (Ez & Kz); [lra |].
  rewrite Ex in Px. rewrite Ey in Py. rewrite Ez.
  assert (Qx : over_power p k x <= 0) by (apply Rmult_le_reg_r with (x ^ k); lra).
  assert (Qy : 0 <= over_power p k y) by (apply Rmult_le_reg_r with (y ^ k); lra).
  assert (U : 0 <= power_form (weighted (INR k) p) u).
  { apply Rmult_le_reg_r with (y - x); [lra |]. rewrite <- Eu. rewrite Rmult_0_l. apply Rmult_le_pos; lra. }
  assert (V : 0 < power_form (weighted (INR k) p) v) by (apply W with u; auto; lra).
  apply Rmult_lt_0_compat; auto. enough (0 < over_power p k z - over_power p k y) by lra.
  apply Rmult_lt_reg_r with (v * v ^ k); auto. rewrite Ev, Rmult_0_l. apply Rmult_lt_0_compat; lra.
Qed.

(** ** Forms with s = 1 - t *)

Definition on_unit (h : list R) (t : R) : R := form h (1 - t) t.

Lemma on_unit_opp h t : on_unit (map Ropp h) t = - on_unit h t.
Proof. apply form_opp. Qed.
Lemma on_unit_ratio h t : 0 < t < 1 -> exists c, 0 < c /\ on_unit h t = c * power_form h (t / (1 - t)).
Proof.
  intros T. destruct h as [| a l]; [exists 1; split; [lra | unfold on_unit; simpl; ring] |].
  exists ((1 - t) ^ length l). split; [apply pow_lt; lra |]. apply power_basis. lra.
Qed.
Lemma ratio_order t u : 0 < t < u -> u < 1 -> 0 < t / (1 - t) < u / (1 - u).
Proof.
  intros T U. split; [apply Rdiv_lt_0_compat; lra |].
  apply Rmult_lt_reg_r with ((1 - t) * (1 - u)); [apply Rmult_lt_0_compat; lra |].
  replace (t / (1 - t) * ((1 - t) * (1 - u))) with (t * (1 - u)) by (field; lra).
  replace (u / (1 - u) * ((1 - t) * (1 - u))) with (u * (1 - t)) by (field; lra). lra.
Qed.
Lemma form_continuous h : continuity (on_unit h).
Proof. intros t. apply derivable_continuous_pt. exists (slope h t). apply derivable_form. Qed.
Lemma on_unit_ends h : on_unit h 0 = hd 0 h /\ on_unit h 1 = last h 0.
Proof.
  unfold on_unit. rewrite Rminus_0_r, Rminus_diag_eq by easy. split.
  - destruct h as [| a l]; simpl; [easy |]. rewrite pow1. ring.
  - destruct h as [| a l] using rev_ind; [easy |]. rewrite last_last. destruct l as [| b l]; [simpl; ring |].
    apply (form_ends b (b :: l) a).
Qed.

Lemma root_between f u v : continuity f -> u < v -> f u * f v < 0 -> exists r, u < r < v /\ f r = 0.
Proof.
  intros C L N. assert (A : (f u < 0 /\ 0 < f v) \/ (0 < f u /\ f v < 0)).
  { destruct (Rtotal_order (f u) 0) as [H | [H | H]]; [left | exfalso; rewrite H in N; lra | right]; split; nra. }
  assert (G : forall g, continuity g -> g u < 0 -> 0 < g v -> exists r, u < r < v /\ g r = 0).
  { intros g Cg Gu Gv. destruct (IVT g u v Cg L Gu Gv) as (r & Hr & Z). exists r. split; auto.
    split; (destruct Hr as ([H | H] & [K | K]); subst; lra). }
  destruct A as [(Fu & Fv) | (Fu & Fv)]; [now apply G |].
  destruct (G (- f)%F) as (r & Hr & Z); [now apply continuity_opp | unfold opp_fct; lra | unfold opp_fct; lra |].
  exists r. split; auto. unfold opp_fct in Z. lra.
Qed.

Lemma no_change_sign a : Forall (Rle 0) a -> Exists (Rlt 0) a -> forall t, 0 < t < 1 -> 0 < on_unit a t.
Proof. intros F E t T. apply hull_inside; auto; lra. Qed.

Lemma hd_last_opp (h : list R) : hd 0 (map Ropp h) = - hd 0 h /\ last (map Ropp h) 0 = - last h 0.
Proof.
  split; [destruct h; simpl; ring |]. induction h as [| a [| b l] IH]; [simpl; ring | easy | exact IH].
Qed.

Lemma changes_opp sg h : changes_after (- sg) (map sgn (map Ropp h)) = changes_after sg (map sgn h).
Proof.
  revert sg. induction h as [| x h IH]; intros sg; [easy |]. cbn [map changes_after].
  assert (E : sgn (- x) = (- sgn x)%Z).
  { destruct (sgn_cases x) as [(L & ->) | [(L & ->) | (L & ->)]], (sgn_cases (- x)) as [(K & ->) | [(K & ->) | (K & ->)]]; lra || easy. }
  rewrite E, !IH. destruct (Z.eqb_spec (sgn x) 0), (Z.eqb_spec (- sgn x) 0); try lia.
  destruct (Z.eqb_spec (sgn x) (- sg)), (Z.eqb_spec (- sgn x) (- - sg)); lia.
Qed.
Lemma variations_opp h : sign_variations (map sgn (map Ropp h)) = sign_variations (map sgn h).
Proof. apply (changes_opp 0). Qed.

Lemma some_alternation h : exists sg, plain sg /\ alternates sg (sign_variations (map sgn h)) h.
Proof.
  induction h as [| x l (sg & P & IH)]; [exists 1%Z; split; [now left | repeat constructor] |].
  destruct (Req_dec x 0) as [-> | N].
  - exists sg. split; auto. unfold sign_variations. cbn [map changes_after].
    destruct (sgn_cases 0) as [(L & _) | [(L & _) | (_ & ->)]]; try lra. apply alternates_cons; [lra | easy].
  - exists (sgn x). destruct (variations_alternate x l N). now split.
Qed.
Lemma first_alternation h : 0 < hd 0 h -> alternates 1 (sign_variations (map sgn h)) h.
Proof.
  destruct h as [| x l]; simpl hd; [lra |]. intros P. destruct (variations_alternate x l) as (A & _); [lra |].
  destruct (sgn_cases x) as [(L & E) | [(L & E) | (L & E)]]; try lra. now rewrite E in A.
Qed.
Lemma alternates_0 sg h : alternates sg 0 h -> Forall (fun x => 0 <= IZR sg * x) h.
Proof. intros A. now inversion A. Qed.
Lemma alternates_next sg n h : alternates sg (S n) h -> exists a b l, h = a ++ b :: l /\
  Forall (fun x => 0 <= IZR sg * x) a /\ IZR sg * b < 0 /\ alternates (- sg) n (b :: l).
Proof. intros A. inversion A as [| s m a b l F B N]. now exists a, b, l. Qed.
Lemma alternates_1 h : alternates 1 1 h -> 0 < hd 0 h ->
  exists a b, h = a ++ b /\ Forall (Rle 0) a /\ Exists (Rlt 0) a /\ Forall (fun x => x <= 0) b /\ hd 0 b < 0.
Proof.
  intros A P. apply alternates_next in A. destruct A as (a & b & l & -> & F & B & N). apply alternates_0 in N.
  exists a, (b :: l). split; [easy |]. split; [eapply Forall_impl; [| exact F]; simpl; intros; lra |].
  split; [destruct a as [| x a]; simpl in P; [lra | now left] |].
  split; [eapply Forall_impl; [| exact N]; simpl; intros; lra | simpl; lra].
Qed.
Lemma alternates_2 h : alternates 1 2 h -> 0 < hd 0 h ->
  exists a b c, h = a ++ b ++ c /\ Forall (Rle 0) a /\ Exists (Rlt 0) a /\ Forall (fun x => x <= 0) b /\ Forall (Rle 0) c.
Proof.
  intros A P. apply alternates_next in A. destruct A as (a & b & l & -> & F & B & N).
  apply alternates_next in N. destruct N as (b' & c & m & E & G & C & M). rewrite E in *. apply alternates_0 in M.
  exists a, b', (c :: m). split; [easy |]. split; [eapply Forall_impl; [| exact F]; simpl; intros; lra |].
  split; [destruct a as [| x a]; simpl in P; [rewrite <- E in P; simpl in P; lra | now left] |].
  split; [eapply Forall_impl; [| exact G] | eapply Forall_impl; [| exact M]]; simpl; intros; lra.
Qed.

Theorem no_variation_no_root h t : sign_variations (map sgn h) = 0%nat -> Exists (fun x => x <> 0) h ->
  0 < t < 1 -> on_unit h t <> 0.
Proof.
  intros V E T. destruct (some_alternation h) as (sg & P & A). rewrite V in A. apply alternates_0 in A.
  rewrite Exists_exists in E. destruct E as (x & I & N). rewrite Forall_forall in A.
  destruct P as [-> | ->].
  - apply Rgt_not_eq, no_change_sign; auto.
    + apply Forall_forall. intros y J. specialize (A y J). lra.
    + apply Exists_exists. exists x. split; auto. specialize (A x I). lra.
  - assert (0 < on_unit (map Ropp h) t); [| rewrite on_unit_opp in *; lra].
    apply no_change_sign; auto.
    + apply Forall_map, Forall_forall. intros y J. specialize (A y J). lra.
    + apply Exists_exists. exists (- x). split; [now apply in_map |]. specialize (A x I). lra.
Qed.

(** One change, from positive to negative. *)
Lemma falls_inside h t u : 0 < hd 0 h -> sign_variations (map sgn h) = 1%nat -> 0 < t < u -> u < 1 ->
  on_unit h t <= 0 -> on_unit h u < 0.
Proof.
  intros P V T U L. pose proof (first_alternation h P) as A. rewrite V in A.
  destruct (alternates_1 h A P) as (a & b & -> & Fa & Ea & Fb & _).
  destruct (on_unit_ratio (a ++ b) t) as (c & C & Et); [lra |].
  destruct (on_unit_ratio (a ++ b) u) as (d & D & Eu); [lra |].
  rewrite Et in L. rewrite Eu. apply Ropp_lt_cancel. rewrite Ropp_0, Ropp_mult_distr_r. apply Rmult_lt_0_compat; auto.
  enough (power_form (a ++ b) (u / (1 - u)) < 0) by lra.
  apply falls_once with (t / (1 - t)); auto; [now apply ratio_order | apply Rmult_le_reg_l with c; lra].
Qed.
Lemma last_in (l : list R) : l <> [] -> In (last l 0) l.
Proof.
  intros N. destruct l as [| x l] using rev_ind; [easy |]. rewrite last_last. apply in_or_app. right. now left.
Qed.
Lemma last_app (a b : list R) : b <> [] -> last (a ++ b) 0 = last b 0.
Proof.
  intros N. induction a as [| x a IH]; [easy |]. simpl. destruct (a ++ b) eqn:E; [| easy].
  apply app_eq_nil in E. now destruct E.
Qed.
Lemma falls_ends h : 0 < hd 0 h -> sign_variations (map sgn h) = 1%nat -> last h 0 <> 0 -> last h 0 < 0.
Proof.
  intros P V N. pose proof (first_alternation h P) as A. rewrite V in A.
  destruct (alternates_1 h A P) as (a & b & -> & Fa & Ea & Fb & Hb).
  assert (Nb : b <> []) by (intros ->; simpl in Hb; lra). rewrite last_app in * by auto.
  rewrite Forall_forall in Fb. specialize (Fb _ (last_in b Nb)). simpl in Fb. lra.
Qed.

Theorem one_variation_one_root h : sign_variations (map sgn h) = 1%nat -> hd 0 h <> 0 -> last h 0 <> 0 ->
  on_unit h 0 * on_unit h 1 < 0 /\
  exists r, 0 < r < 1 /\ on_unit h r = 0 /\ forall t, 0 <= t <= 1 -> on_unit h t = 0 -> t = r.
Proof.
  assert (G : forall h, sign_variations (map sgn h) = 1%nat -> 0 < hd 0 h -> last h 0 <> 0 ->
    on_unit h 0 * on_unit h 1 < 0 /\
    exists r, 0 < r < 1 /\ on_unit h r = 0 /\ forall t, 0 <= t <= 1 -> on_unit h t = 0 -> t = r).
  { clear h. intros h V P L. pose proof (falls_ends h P V L) as N.
    destruct (on_unit_ends h) as (E0 & E1).
    assert (S : on_unit h 0 * on_unit h 1 < 0) by (rewrite E0, E1; nra). split; auto.
    destruct (root_between (on_unit h) 0 1) as (r & Hr & Z); [apply form_continuous | lra | easy |].
    exists r. split; auto. split; auto. intros t T Zt.
    assert (t <> 0) by (intros ->; lra). assert (t <> 1) by (intros ->; lra).
    destruct (Rtotal_order t r) as [H1 | [H1 | H1]]; auto; exfalso.
    - pose proof (falls_inside h t r P V ltac:(lra) ltac:(lra) ltac:(lra)). lra.
    - pose proof (falls_inside h r t P V ltac:(lra) ltac:(lra) ltac:(lra)). lra. }
  intros V H L. destruct (Rtotal_order (hd 0 h) 0) as [N | [N | N]]; [| easy | now apply G].
  destruct (hd_last_opp h) as (Eh & El).
  destruct (G (map Ropp h)) as (S & r & Hr & Z & Only).
  - now rewrite variations_opp.
  - rewrite Eh. lra.
  - rewrite El. lra.
  - rewrite !on_unit_opp in *. split; [lra |]. exists r. split; auto. split; [lra |].
    intros t T Zt. apply Only; auto. rewrite on_unit_opp. lra.
Qed.

Theorem two_variations_two_roots h m : (sign_variations (map sgn h) <= 2)%nat -> 0 < hd 0 h * last h 0 ->
  0 < m < 1 -> hd 0 h * on_unit h m < 0 ->
  (exists r, 0 < r < m /\ on_unit h r = 0 /\ forall t, 0 <= t <= m -> on_unit h t = 0 -> t = r) /\
  (exists r, m < r < 1 /\ on_unit h r = 0 /\ forall t, m <= t <= 1 -> on_unit h t = 0 -> t = r).
Proof.
  assert (G : forall h, (sign_variations (map sgn h) <= 2)%nat -> 0 < hd 0 h -> 0 < last h 0 ->
    0 < m < 1 -> on_unit h m < 0 ->
    (exists r, 0 < r < m /\ on_unit h r = 0 /\ forall t, 0 <= t <= m -> on_unit h t = 0 -> t = r) /\
    (exists r, m < r < 1 /\ on_unit h r = 0 /\ forall t, m <= t <= 1 -> on_unit h t = 0 -> t = r)).
  { clear h. intros h V P L M N. destruct (on_unit_ends h) as (E0 & E1).
    destruct (root_between (on_unit h) 0 m) as (r & Hr & Zr); [apply form_continuous | lra | rewrite E0; nra |].
    destruct (root_between (on_unit h) m 1) as (q & Hq & Zq); [apply form_continuous | lra | rewrite E1; nra |].
    pose proof (first_alternation h P) as A.
    assert (V2 : sign_variations (map sgn h) = 2%nat).
    { destruct (sign_variations (map sgn h)) as [| [| [| n]]] eqn:E; try lia; exfalso.
      - apply (no_variation_no_root h r E); auto; [| lra]. destruct h; simpl in P; [lra |]. left. lra.
      - pose proof (falls_inside h m q P E ltac:(lra) ltac:(lra) ltac:(lra)). lra. }
    rewrite V2 in A. destruct (alternates_2 h A P) as (a & b & c & -> & Fa & Ea & Fb & Fc).
    set (h := a ++ b ++ c) in *.
    assert (Up : forall t u v, 0 < t < u -> u < v < 1 -> on_unit h t <= 0 -> 0 <= on_unit h u -> 0 < on_unit h v).
    { intros t u v T U Lt Lu.
      destruct (on_unit_ratio h t) as (ct & Ct & Et); [lra |]. destruct (on_unit_ratio h u) as (cu & Cu & Eu); [lra |].
      destruct (on_unit_ratio h v) as (cv & Cv & Ev); [lra |]. rewrite Et in Lt. rewrite Eu in Lu. rewrite Ev.
      apply Rmult_lt_0_compat; auto. apply rises_on with (t / (1 - t)) (u / (1 - u)); auto.
      - apply ratio_order; lra.
      - apply (ratio_order u v); lra.
      - fold h. apply Rmult_le_reg_l with ct; lra.
      - fold h. apply Rmult_le_reg_l with cu; lra. }
    split.
    - exists r. split; auto. split; auto. intros t T Zt.
      assert (t <> 0) by (intros ->; lra). assert (t <> m) by (intros ->; lra).
      destruct (Rtotal_order t r) as [H1 | [H1 | H1]]; auto; exfalso.
      + pose proof (Up t r m ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)). lra.
      + pose proof (Up r t m ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)). lra.
    - exists q. split; auto. split; auto. intros t T Zt.
      assert (t <> 1) by (intros ->; lra). assert (t <> m) by (intros ->; lra).
      destruct (Rtotal_order t q) as [H1 | [H1 | H1]]; auto; exfalso.
      + pose proof (Up m t q ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)). lra.
      + pose proof (Up m q t ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)). lra. }
  intros V E M N. destruct (Rtotal_order (hd 0 h) 0) as [H | [H | H]]; [| rewrite H in E; lra | apply G; auto; nra].
  destruct (hd_last_opp h) as (Eh & El).
  destruct (G (map Ropp h)) as ((r & Hr & Zr & Or) & (q & Hq & Zq & Oq)); auto.
  - now rewrite variations_opp.
  - rewrite Eh. lra.
  - rewrite El. nra.
  - rewrite on_unit_opp. nra.
  - rewrite on_unit_opp in Zr, Zq. split; [exists r | exists q]; (split; [easy |]; split; [lra |]); intros t T Zt;
      [apply Or | apply Oq]; auto; rewrite on_unit_opp; lra.
Qed.
