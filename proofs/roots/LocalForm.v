(** A polynomial near a position (include/errbound/roots/local_form.hpp): integers for its first Taylor coefficients
    on an interval, all with one error bound, and conclusions from them. Rows shorter than the polynomial are
    extended by zeros. Results:
        part_right           part: the coefficients on a subinterval, with the new error
        dropped_right        also without those that do not exceed the error
        cut_right            also with fewer bits
        signs_right          the signs of Bernstein coefficients, 0 if uncertain
        coefficients_right   Bernstein coefficients, each within an error
        row_signs_of_coefficients   the signs of a fixed_row of them
        surely_rootless_right, low_end_right, high_end_right   no root on [0, 1], at 0, at 1 *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Flocq Require Import Core.
From Errbound Require Import Sign Bernstein SignVariations RootIsolation ControlValues.
Import ListNotations.
Open Scope R_scope.

(** ** The meaning of the integers *)

(** Each is within e of a real number; beyond their end it is 0. *)
Fixpoint near (e : R) (a : list Z) (exact : list R) : Prop :=
  match exact with
  | [] => a = []
  | y :: exact => Rabs (IZR (hd 0%Z a) - y) <= e /\ near e (tl a) exact
  end.
(** A form of p, of degree n: p(low + width u) = (sum of exact_j u^j)/c. *)
Definition local_form (p : list R) (low width : R) (n : nat) (a : list Z) (error : Z) : Prop :=
  a <> [] /\ exists exact c, length exact = S n /\ 0 < c /\
    (forall u, power_form exact u = c * power_form p (low + width * u)) /\ near (IZR error) a exact.

Lemma near_length e a exact : near e a exact -> (length a <= length exact)%nat.
Proof.
  revert a. induction exact as [| y exact IH]; intros a N; [now rewrite N |]. destruct N as (_ & N). apply IH in N.
  destruct a; simpl in *; lia.
Qed.
Lemma near_index e a exact : near e a exact <-> (length a <= length exact)%nat /\
  forall i, (i < length exact)%nat -> Rabs (IZR (nth i a 0%Z) - nth i exact 0) <= e.
Proof.
  split.
  - intros N. split; [now apply near_length with e |]. revert a N. induction exact as [| y exact IH]; intros a N i I; [simpl in I; lia |].
    destruct N as (H & N). destruct i as [| i]; [now destruct a |]. specialize (IH _ N i ltac:(simpl in I; lia)). destruct a; [now destruct i | easy].
  - revert a. induction exact as [| y exact IH]; intros a (L & H); [destruct a; [easy | simpl in L; lia] |]. split.
    + specialize (H 0%nat ltac:(simpl; lia)). now destruct a.
    + apply IH. split; [destruct a; simpl in *; lia |]. intros i I. specialize (H (S i) ltac:(simpl; lia)). destruct a; [now destruct i | easy].
Qed.
Lemma power_form_near e a exact u : 0 <= e -> 0 <= u <= 1 -> near e a exact ->
  Rabs (power_form (map IZR a) u - power_form exact u) <= e * INR (length exact).
Proof.
  intros E U. revert a. induction exact as [| y exact IH]; intros a N.
  - rewrite N. simpl. rewrite Rminus_0_r, Rabs_R0. lra.
  - destruct N as (H & N). specialize (IH _ N). cbn [length]. rewrite S_INR.
    replace (power_form (map IZR a) u) with (IZR (hd 0%Z a) + u * power_form (map IZR (tl a)) u) by (destruct a; simpl; ring).
    simpl power_form. set (f := power_form (map IZR (tl a)) u) in *. set (g := power_form exact u) in *.
    replace (IZR (hd 0%Z a) + u * f - (y + u * g)) with ((IZR (hd 0%Z a) - y) + u * (f - g)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_mult, (Rabs_pos_eq u) by lra.
    pose proof (Rabs_pos (f - g)). assert (u * Rabs (f - g) <= 1 * Rabs (f - g)) by (apply Rmult_le_compat_r; lra). lra.
Qed.

(** ** part: on u = (from + length v)/2^depth *)

(** The sum of all differences, the j-th multiplied by w^j. *)
Fixpoint distance (w : R) (a : list Z) (exact : list R) : R :=
  match exact with
  | [] => 0
  | y :: exact => Rabs (IZR (hd 0%Z a) - y) + w * distance w (tl a) exact
  end.

(** The code: the shift by from/2^depth, with each product rounded, then the powers of length/2^depth. *)
Fixpoint horner_cut (from depth : Z) (a : list Z) : list Z :=
  match a with
  | [] => []
  | x :: a => let after := horner_cut from depth a in (x + cut_shift (- depth) (hd 0 after * from))%Z :: after
  end.
Fixpoint shifted_cut (n : nat) (from depth : Z) (a : list Z) : list Z :=
  match n with
  | O => a
  | S n => match horner_cut from depth a with [] => [] | x :: a => x :: shifted_cut n from depth a end
  end.
Fixpoint scaled_cut (len depth power shift : Z) (a : list Z) : list Z :=
  match a with
  | [] => []
  | x :: a => cut_shift (- shift) (x * power) :: scaled_cut len depth (power * len) (shift + depth) a
  end.
Definition part (from len depth : Z) (a : list Z) : list Z :=
  scaled_cut len depth 1 0 (shifted_cut (length a) from depth a).
Definition part_error (n : nat) (size error : Z) : Z := (error * (Z.of_nat n + 1) + size * size)%Z.

Lemma distance_nonnegative w a exact : 0 <= w -> 0 <= distance w a exact.
Proof.
  intros W. revert a. induction exact as [| y exact IH]; intros a; simpl; [lra |].
  pose proof (Rabs_pos (IZR (hd 0%Z a) - y)). specialize (IH (tl a)).
  assert (0 <= w * distance w (tl a) exact) by (now apply Rmult_le_pos). lra.
Qed.
Lemma distance_open w a exact : (length a <= length exact)%nat ->
  distance w a exact = Rabs (IZR (hd 0%Z a) - hd 0 exact) + w * distance w (tl a) (tl exact).
Proof.
  intros L. destruct exact as [| y exact]; [| easy]. destruct a; [| simpl in L; lia]. simpl.
  rewrite Rminus_0_r, Rabs_R0. ring.
Qed.
Lemma distance_near e w a exact : 0 <= e -> 0 <= w <= 1 -> near e a exact -> distance w a exact <= e * INR (length exact).
Proof.
  intros E W. revert a. induction exact as [| y exact IH]; intros a N; [simpl; lra |].
  destruct N as (H & N). specialize (IH _ N). pose proof (distance_nonnegative w (tl a) exact ltac:(lra)).
  cbn [length distance]. rewrite S_INR.
  assert (w * distance w (tl a) exact <= 1 * distance w (tl a) exact) by (apply Rmult_le_compat_r; lra). lra.
Qed.

Lemma cut_shift_of_0 shift : cut_shift shift 0 = 0%Z.
Proof. unfold cut_shift, cut. now destruct (0 <=? shift)%Z. Qed.
Lemma horner_cons s y l : horner s (y :: l) = (y + hd 0 (horner s l) * s) :: horner s l.
Proof. simpl. destruct (horner s l); [simpl; f_equal; ring | easy]. Qed.
Lemma horner_length s l : length (horner s l) = length l.
Proof. induction l as [| y l IH]; [easy |]. rewrite horner_cons. simpl. now rewrite IH. Qed.
Lemma horner_cut_length from depth a : length (horner_cut from depth a) = length a.
Proof. induction a; simpl; auto. Qed.
Lemma shifted_cut_length from depth n : forall a, length (shifted_cut n from depth a) = length a.
Proof.
  induction n as [| n IH]; intros a; [easy |]. simpl. pose proof (horner_cut_length from depth a) as L.
  destruct (horner_cut from depth a) as [| x r]; [exact L |]. simpl in *. now rewrite IH.
Qed.
Lemma scaled_cut_length len depth a : forall power shift, length (scaled_cut len depth power shift a) = length a.
Proof. induction a; intros; simpl; auto. Qed.

Section Part.

Context (from len depth : Z) (from_range : (0 <= from)%Z) (len_range : (0 < len)%Z)
  (sum_range : (from + len <= 2 ^ depth)%Z) (depth_range : (0 <= depth)%Z).
Let s := IZR from * pow2 (- depth).
Let l := IZR len * pow2 (- depth).

Lemma part_place : 0 <= s /\ 0 < l /\ s + l <= 1.
Proof.
  unfold s, l. pose proof (bpow_gt_0 radix2 (- depth)) as P. apply IZR_le in from_range. apply IZR_lt in len_range.
  apply IZR_le in sum_range. rewrite plus_IZR, pow2_integer in sum_range by easy.
  repeat split; [apply Rmult_le_pos; lra | apply Rmult_lt_0_compat; lra |].
  rewrite <- Rmult_plus_distr_r. apply Rle_trans with (pow2 depth * pow2 (- depth)); [apply Rmult_le_compat_r; lra |].
  rewrite <- bpow_plus. replace (depth + - depth)%Z with 0%Z by ring. simpl. lra.
Qed.

Lemma horner_distance exact : forall a, (length a <= length exact)%nat ->
  let b := horner_cut from depth a in let h := horner s exact in
  Rabs (IZR (hd 0%Z b) - hd 0 h) + l * distance (s + l) (tl b) (tl h) <= distance (s + l) a exact + INR (Nat.pred (length a)).
Proof.
  destruct part_place as (S0 & L0 & SL). induction exact as [| y exact IH]; intros a La.
  - destruct a; [| simpl in La; lia]. simpl. rewrite Rminus_0_r, Rabs_R0. lra.
  - assert (Lt : (length (tl a) <= length exact)%nat) by (destruct a; simpl in *; lia).
    specialize (IH (tl a) Lt). cbv zeta in *. rewrite horner_cons. cbn [hd tl distance].
    set (r := horner_cut from depth (tl a)) in *. set (h := horner s exact) in *.
    assert (Lr : (length r <= length h)%nat) by (unfold r, h; rewrite horner_cut_length, horner_length; lia).
    set (d := if (length (tl a) =? 0)%nat then 0 else 1).
    assert (Head : Rabs (IZR (hd 0%Z (horner_cut from depth a)) - (y + hd 0 h * s)) <=
      Rabs (IZR (hd 0%Z a) - y) + s * Rabs (IZR (hd 0%Z r) - hd 0 h) + d /\ tl (horner_cut from depth a) = r /\
      INR (Nat.pred (length a)) = d + INR (Nat.pred (length (tl a)))).
    { destruct a as [| x a].
      - unfold r, d. cbn. repeat split; [| ring]. replace (0 - (y + hd 0 h * s)) with ((0 - y) + s * (0 - hd 0 h)) by ring.
        apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_mult, (Rabs_pos_eq s) by lra. lra.
      - cbn [horner_cut tl hd] in *. fold r. repeat split.
        + rewrite plus_IZR. set (z := hd 0%Z r) in *.
          assert (Cut : Rabs (IZR (cut_shift (- depth) (z * from)) - IZR z * s) <= d).
          { unfold d. destruct a as [| x' a].
            - unfold z, r. cbn [horner_cut hd tl length Nat.eqb]. rewrite Z.mul_0_l, cut_shift_of_0, Rmult_0_l, Rminus_0_r, Rabs_R0. lra.
            - simpl Nat.eqb. cbv iota. pose proof (cut_shift_near (- depth) (z * from)) as C. rewrite mult_IZR in C.
              unfold s. now rewrite <- Rmult_assoc. }
          replace (IZR x + IZR (cut_shift (- depth) (z * from)) - (y + hd 0 h * s))
            with ((IZR x - y) + (s * (IZR z - hd 0 h) + (IZR (cut_shift (- depth) (z * from)) - IZR z * s))) by ring.
          apply Rle_trans with (1 := Rabs_triang _ _).
          pose proof (Rabs_triang (s * (IZR z - hd 0 h)) (IZR (cut_shift (- depth) (z * from)) - IZR z * s)) as T.
          rewrite Rabs_mult, (Rabs_pos_eq s) in T by lra. lra.
        + unfold d. destruct a as [| x' a]; [simpl; ring |]. cbn [length Nat.pred Nat.eqb]. rewrite S_INR. ring. }
    destruct Head as (Head & -> & Count). rewrite Count, (distance_open (s + l) r h Lr).
    set (A := Rabs (IZR (hd 0%Z r) - hd 0 h)) in *. set (D := distance (s + l) (tl r) (tl h)) in *.
    pose proof (Rabs_pos (IZR (hd 0%Z r) - hd 0 h)) as PA. fold A in PA.
    assert (M : (s + l) * (A + l * D) <= (s + l) * (distance (s + l) (tl a) exact + INR (Nat.pred (length (tl a)))))
      by (apply Rmult_le_compat_l; lra).
    pose proof (pos_INR (Nat.pred (length (tl a)))) as PI.
    assert ((s + l) * INR (Nat.pred (length (tl a))) <= 1 * INR (Nat.pred (length (tl a)))) by (apply Rmult_le_compat_r; lra). lra.
Qed.

Lemma shifted_distance m : forall n a exact, (length a <= n)%nat -> (length exact <= m)%nat -> (length a <= length exact)%nat ->
  distance l (shifted_cut n from depth a) (shifted m s exact) <=
    distance (s + l) a exact + INR (length a) * INR (Nat.pred (length a)) / 2.
Proof.
  destruct part_place as (S0 & L0 & SL). induction m as [| m IH]; intros n a exact Ln Lm La.
  - destruct exact; [| simpl in Lm; lia]. destruct a; [| simpl in La; lia]. simpl. lra.
  - pose proof (horner_distance exact a La) as H. cbv zeta in H. cbn [shifted].
    pose proof (horner_length s exact) as Lh. destruct (horner s exact) as [| y h] eqn:Eh.
    + destruct exact; [| discriminate]. destruct a; [| simpl in La; lia]. simpl. lra.
    + pose proof (horner_cut_length from depth a) as Lc. destruct a as [| x a].
      * cbn [horner_cut hd tl] in H. assert (Es : shifted_cut n from depth [] = []) by (now destruct n).
        rewrite Es. cbn [distance tl hd]. specialize (IH O [] h ltac:(simpl; lia)). simpl in Lh, Lm.
        specialize (IH ltac:(lia) ltac:(simpl; lia)). cbn [shifted_cut length INR Nat.pred] in IH, H |- *.
        assert (l * distance l [] (shifted m s h) <= l * distance (s + l) [] h) by (apply Rmult_le_compat_l; lra). lra.
      * destruct n as [| n]; [simpl in Ln; lia |]. cbn [shifted_cut].
        destruct (horner_cut from depth (x :: a)) as [| x' r] eqn:Er; [discriminate |].
        cbn [distance hd tl] in *. simpl in Lc, Lh, La, Lm, Ln.
        specialize (IH n r h ltac:(lia) ltac:(lia) ltac:(lia)). assert (Lr : length r = length a) by lia. rewrite Lr in IH.
        cbn [length Nat.pred] in *. rewrite S_INR.
        pose proof (pos_INR (length a)) as P.
        assert (E : INR (length a) * INR (Nat.pred (length a)) = INR (length a) * (INR (length a) - 1)).
        { destruct a; [simpl; ring |]. cbn [length Nat.pred]. rewrite S_INR. ring. }
        rewrite E in IH.
        assert (K : l * distance l (shifted_cut n from depth r) (shifted m s h) <=
          l * (distance (s + l) r h + INR (length a) * (INR (length a) - 1) / 2)) by (apply Rmult_le_compat_l; lra).
        assert (Q : 0 <= INR (length a) * (INR (length a) - 1)).
        { rewrite <- E. apply Rmult_le_pos; apply pos_INR. }
        assert (l * (INR (length a) * (INR (length a) - 1)) <= 1 * (INR (length a) * (INR (length a) - 1))) by (apply Rmult_le_compat_r; lra).
        lra.
Qed.

Lemma scaled_cut_near e exact : forall a power shift, (length a <= length exact)%nat ->
  let w := IZR power * pow2 (- shift) in 0 <= w -> w * distance l a exact + 1 <= e ->
  near e (scaled_cut len depth power shift a) (times_powers l w exact).
Proof.
  destruct part_place as (S0 & L0 & SL). induction exact as [| y exact IH]; intros a power shift La w W E.
  - now destruct a; [| simpl in La; lia].
  - cbn [times_powers near distance] in *. pose proof (distance_nonnegative l (tl a) exact ltac:(lra)) as D.
    pose proof (Rmult_le_pos _ _ W (Rmult_le_pos _ _ (Rlt_le _ _ L0) D)) as WD. split.
    + assert (Eh : hd 0%Z (scaled_cut len depth power shift a) = cut_shift (- shift) (hd 0%Z a * power)).
      { destruct a; [| easy]. cbn [hd]. now rewrite Z.mul_0_l, cut_shift_of_0. }
      rewrite Eh. pose proof (cut_shift_near (- shift) (hd 0%Z a * power)) as C. rewrite mult_IZR, Rmult_assoc in C. fold w in C.
      replace (IZR (cut_shift (- shift) (hd 0%Z a * power)) - y * w) with
        ((IZR (cut_shift (- shift) (hd 0%Z a * power)) - IZR (hd 0%Z a) * w) + (IZR (hd 0%Z a) - y) * w) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _). rewrite (Rabs_mult (IZR (hd 0%Z a) - y)), (Rabs_pos_eq w) by lra. lra.
    + assert (Et : tl (scaled_cut len depth power shift a) = scaled_cut len depth (power * len) (shift + depth) (tl a)) by (now destruct a).
      assert (Ew : w * l = IZR (power * len) * pow2 (- (shift + depth))).
      { unfold w, l. rewrite mult_IZR. replace (- (shift + depth))%Z with (- shift + - depth)%Z by ring. rewrite bpow_plus. ring. }
      rewrite Et, Ew. apply IH; [destruct a; simpl in *; lia | |]; rewrite <- Ew; [apply Rmult_le_pos; lra |].
      pose proof (Rmult_le_pos _ _ W (Rabs_pos (IZR (hd 0%Z a) - y))). lra.
Qed.

Theorem part_right p low width n a error : (0 <= error)%Z -> local_form p low width n a error ->
  local_form p (low + width * s) (width * l) n (part from len depth a) (part_error n (Z.of_nat (length a)) error).
Proof.
  intros E (Na & exact & c & Le & C & V & N). destruct part_place as (S0 & L0 & SL).
  pose proof (near_length _ _ _ N) as La. split.
  { intros K. apply (f_equal (@length Z)) in K. unfold part in K. rewrite scaled_cut_length, shifted_cut_length in K. now destruct a. }
  destruct (shifted_value s (length exact) exact (Nat.le_refl _)) as (Ls & Vs).
  exists (times_powers l 1 (shifted (length exact) s exact)), c. rewrite times_powers_length, Ls. repeat split; auto.
  - intros u. rewrite times_powers_value, Vs, V. replace (low + width * (s + l * u)) with (low + width * s + width * l * u) by ring. ring.
  - replace 1 with (IZR 1 * pow2 (- 0)) by (simpl; ring). apply scaled_cut_near.
    + rewrite shifted_cut_length, Ls. exact La.
    + simpl. lra.
    + simpl (IZR 1 * pow2 (- 0)). rewrite Rmult_1_r, Rmult_1_l.
      pose proof (shifted_distance (length exact) (length a) a exact (Nat.le_refl _) (Nat.le_refl _) La) as D.
      apply IZR_le in E. pose proof (distance_near (IZR error) (s + l) a exact E ltac:(lra) N) as D'.
      unfold part_error. rewrite plus_IZR, !mult_IZR, plus_IZR, <- !INR_IZR_INZ. rewrite Le, S_INR in D'.
      destruct a as [| x a]; [easy |]. cbn [length Nat.pred] in *. rewrite S_INR in *. pose proof (pos_INR (length a)).
      assert (0 <= INR (length a) * INR (length a)) by (now apply Rmult_le_pos). lra.
Qed.

End Part.

(** drop_small_terms *)
Theorem dropped_right p low width n a small error : a <> [] -> Forall (fun x => (Z.abs x <= error)%Z) small ->
  local_form p low width n (a ++ small) error -> local_form p low width n a (2 * error).
Proof.
  intros Na F (_ & exact & c & Le & C & V & N). split; auto. exists exact, c. repeat split; auto.
  apply near_index in N. destruct N as (La & N). apply near_index. rewrite app_length in La. split; [lia |].
  intros i I. specialize (N i I). rewrite mult_IZR. pose proof (Rabs_pos (IZR (nth i (a ++ small) 0%Z) - nth i exact 0)).
  destruct (Nat.lt_ge_cases i (length a)) as [B | B]; [rewrite app_nth1 in * by easy; lra |].
  rewrite (nth_overflow a) by easy. rewrite app_nth2 in * by easy. set (x := nth (i - length a) small 0%Z) in *.
  assert (X : Rabs (IZR x) <= IZR error).
  { destruct (Nat.lt_ge_cases (i - length a) (length small)) as [B' | B'].
    - rewrite Forall_forall in F. rewrite <- abs_IZR. apply IZR_le, F. now apply nth_In.
    - unfold x. rewrite nth_overflow by easy. rewrite Rabs_R0. lra. }
  replace (0 - nth i exact 0) with ((IZR x - nth i exact 0) + - IZR x) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra.
Qed.

(** ** Fewer bits *)

Definition cut_all (excess : Z) (a : list Z) : list Z := map (cut_shift (- excess)) a.
Definition error_of_cut (excess error : Z) : Z := if (0 <? excess)%Z then cut_error excess error else error.

Theorem cut_right p low width n a error excess : (0 <= error)%Z -> (0 <= excess)%Z -> local_form p low width n a error ->
  (0 <= error_of_cut excess error)%Z /\ local_form p low width n (cut_all excess a) (error_of_cut excess error).
Proof.
  intros E X (Na & exact & c & Le & C & V & N). unfold error_of_cut, cut_all. destruct (Z.ltb_spec 0 excess) as [P | P].
  - pose proof (cut_shift_nonnegative (- excess) error E). split; [unfold cut_error; lia |].
    split; [destruct a; [easy | discriminate] |]. pose proof (bpow_gt_0 radix2 (- excess)) as Q. set (q := pow2 (- excess)) in *.
    exists (map (Rmult q) exact), (q * c). rewrite map_length. repeat split; auto; [now apply Rmult_lt_0_compat | |].
    + intros u. rewrite power_form_scaled, V. ring.
    + apply near_index in N. destruct N as (La & N). apply near_index. rewrite !map_length. split; auto. intros i I.
      specialize (N i I). rewrite <- (cut_shift_of_0 (- excess)) at 1. rewrite map_nth.
      replace (nth i (map (Rmult q) exact) 0) with (q * nth i exact 0) by (rewrite <- (map_nth (Rmult q)); now rewrite Rmult_0_r).
      set (x := nth i a 0%Z) in *. set (y := nth i exact 0) in *. pose proof (cut_shift_near (- excess) x) as Hx.
      pose proof (cut_shift_near (- excess) error) as He. unfold q in *. set (r := pow2 (- excess)) in *. apply Rabs_le_inv in He.
      unfold cut_error. rewrite plus_IZR.
      replace (IZR (cut_shift (- excess) x) - r * y) with ((IZR (cut_shift (- excess) x) - IZR x * r) + r * (IZR x - y)) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _). rewrite (Rabs_mult r), (Rabs_pos_eq r) by lra.
      assert (r * Rabs (IZR x - y) <= r * IZR error) by (apply Rmult_le_compat_l; lra). lra.
  - assert (excess = 0%Z) as -> by lia. split; auto. unfold local_form. simpl (- 0)%Z.
    assert (Same : map (cut_shift 0) a = a) by (clear; induction a as [| x a IH]; simpl; [easy | now rewrite cut_shift_0, IH]).
    rewrite Same. split; auto. now exists exact, c.
Qed.

(** ** Bernstein coefficients *)

(** A row of h_i times s + t, plus x in the last place: one pass of scaled_coefficients. *)
Section Rows.
Context {A : Type} (add : A -> A -> A) (zero : A).
Fixpoint raised (before : A) (h : list A) (x : A) : list A :=
  match h with [] => [add before x] | y :: h => add before y :: raised y h x end.
Fixpoint raised_by (n : nat) (h a : list A) : list A :=
  match n with O => h | S n => raised_by n (raised zero h (hd zero a)) (tl a) end.
Definition bernstein (n : nat) (a : list A) : list A := raised_by n [hd zero a] (tl a).
End Rows.
Notation integer_row := (bernstein Z.add 0%Z).
Notation exact_row := (bernstein Rplus 0).

Lemma raised_form h x s t : forall before, form (raised Rplus before h x) s t =
  before * s ^ length h + (s + t) * form h s t + x * t ^ length h /\ length (raised Rplus before h x) = S (length h).
Proof.
  induction h as [| y h IH]; intros before; [simpl; split; [ring | easy] |]. destruct (IH y) as (E & L).
  cbn [raised form length]. rewrite L, E. split; [simpl; ring | easy].
Qed.
Lemma raised_by_form t n : forall h a, (length a <= n)%nat -> form (raised_by Rplus 0 n h a) (1 - t) t =
  form h (1 - t) t + t ^ length h * power_form a t.
Proof.
  induction n as [| n IH]; intros h a L; [destruct a; [simpl; ring | simpl in L; lia] |].
  cbn [raised_by]. destruct (raised_form h (hd 0 a) (1 - t) t 0) as (E & Lr).
  rewrite IH by (destruct a; simpl in *; lia). rewrite E, Lr. destruct a; simpl; ring.
Qed.
(** It is the polynomial, for any assumed degree. *)
Lemma exact_row_value n a t : (length a <= S n)%nat -> on_unit (exact_row n a) t = power_form a t.
Proof.
  intros L. unfold on_unit, bernstein. rewrite raised_by_form by (destruct a; simpl in *; lia). destruct a; simpl; ring.
Qed.
Lemma raised_length h x : forall before, length (raised Z.add before h x) = S (length h).
Proof. induction h; intros; simpl; auto. Qed.
Lemma raised_by_length n : forall h a, length (raised_by Z.add 0%Z n h a) = (n + length h)%nat.
Proof. induction n as [| n IH]; intros h a; [easy |]. cbn [raised_by]. rewrite IH, raised_length. lia. Qed.
Lemma integer_row_reals n a : map IZR (integer_row n a) = exact_row n (map IZR a).
Proof.
  assert (R : forall h x before, map IZR (raised Z.add before h x) = raised Rplus (IZR before) (map IZR h) (IZR x)).
  { induction h as [| y h IH]; intros x before; simpl; rewrite plus_IZR; [easy | now rewrite IH]. }
  assert (G : forall n h a, map IZR (raised_by Z.add 0%Z n h a) = raised_by Rplus 0 n (map IZR h) (map IZR a)).
  { clear n a. induction n as [| n IH]; intros h a; [easy |]. cbn [raised_by]. rewrite IH, R. now destruct a. }
  unfold bernstein. rewrite G. now destruct a.
Qed.

(** Each h_i within e times a number m_i of its exact value. *)
Inductive rows_near (e : R) : list Z -> list R -> list Z -> Prop :=
| rows_end : rows_near e [] [] []
| rows_next x y m h k ms : Rabs (IZR x - y) <= e * IZR m -> rows_near e h k ms -> rows_near e (x :: h) (y :: k) (m :: ms).

Lemma raised_near e h k ms x y m : rows_near e h k ms -> Rabs (IZR x - y) <= e * IZR m -> forall bx b bm,
  Rabs (IZR bx - b) <= e * IZR bm -> rows_near e (raised Z.add bx h x) (raised Rplus b k y) (raised Z.add bm ms m).
Proof.
  intros N X. assert (Sum : forall u v p q i j, Rabs (IZR u - p) <= e * IZR i -> Rabs (IZR v - q) <= e * IZR j ->
    Rabs (IZR (u + v) - (p + q)) <= e * IZR (i + j)).
  { intros u v p q i j U V. rewrite !plus_IZR. replace (IZR u + IZR v - (p + q)) with ((IZR u - p) + (IZR v - q)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  induction N as [| x' y' m' h k ms H N IH]; intros bx b bm B; constructor; auto. constructor.
Qed.
Lemma raised_by_near e n : 0 <= e -> forall a exact h k ms, length exact = n -> near e a exact -> rows_near e h k ms ->
  rows_near e (raised_by Z.add 0%Z n h a) (raised_by Rplus 0 n k exact) (raised_by Z.add 0%Z n ms (repeat 1%Z n)).
Proof.
  intros E. induction n as [| n IH]; intros a exact h k ms L N H; [easy |]. destruct exact as [| y exact]; [discriminate |].
  destruct N as (Hd & N). cbn [raised_by hd tl repeat]. apply IH; auto. apply raised_near; auto; [lra |].
  rewrite Rminus_0_r, Rabs_R0. lra.
Qed.

(** The margins are C(n + 1, i). *)
Definition choices (n m : nat) : list Z := map (choose n) (seq 0 m).
Lemma choose_all n : choose n n = 1%Z.
Proof. induction n as [| n IH]; [easy |]. cbn [choose]. rewrite IH, choose_beyond by lia. easy. Qed.
Lemma raised_choices n : raised Z.add 0%Z (choices (S n) (S n)) 1%Z = choices (S (S n)) (S (S n)).
Proof.
  assert (G : forall k i, (i + k = S n)%nat ->
    raised Z.add (match i with O => 0 | S j => choose (S n) j end)%Z (map (choose (S n)) (seq i k)) 1%Z =
    map (choose (S (S n))) (seq i (S k))).
  { induction k as [| k IH]; intros i E.
    - assert (i = S n) as -> by lia. cbn [seq map raised]. f_equal.
      change (choose (S (S n)) (S n)) with (choose (S n) n + choose (S n) (S n))%Z. now rewrite choose_all.
    - change (seq i (S k)) with (i :: seq (S i) k). change (seq i (S (S k))) with (i :: seq (S i) (S k)). cbn [map raised].
      rewrite (IH (S i)) by lia. f_equal. destruct i as [| j]; [easy |].
      change (choose (S (S n)) (S j)) with (choose (S n) j + choose (S n) (S j))%Z. ring. }
  apply (G (S n) 0%nat). lia.
Qed.
Lemma raised_by_choices n : forall m, raised_by Z.add 0%Z n (choices (S m) (S m)) (repeat 1%Z n) = choices (S (m + n)) (S (m + n)).
Proof.
  induction n as [| n IH]; intros m; [now rewrite Nat.add_0_r |]. cbn [raised_by repeat hd tl].
  rewrite raised_choices, IH. do 2 f_equal; lia.
Qed.
Lemma bernstein_near e n a exact : 0 <= e -> length exact = S n -> near e a exact ->
  rows_near e (integer_row n a) (exact_row n exact) (choices (S n) (S n)).
Proof.
  intros E L N. destruct exact as [| y exact]; [discriminate |]. destruct N as (H & N).
  pose proof (raised_by_near e n E (tl a) exact [hd 0%Z a] [y] [1%Z] ltac:(simpl in L; lia) N) as G.
  change [1%Z] with (choices 1 1) in G. rewrite (raised_by_choices n 0) in G. apply G.
  change (choices 1 1) with [1%Z]. constructor; [lra | constructor].
Qed.
Lemma exact_row_stands p low width n exact c : length exact = S n -> 0 < c ->
  (forall u, power_form exact u = c * power_form p (low + width * u)) -> stands_for (exact_row n exact) p low (low + width).
Proof.
  intros L C V. exists c. split; auto. intros t. rewrite exact_row_value by lia. rewrite V. do 2 f_equal. ring.
Qed.

(** The code's loops over binomials, from a factor on. *)
Lemma choices_from factor n rest : forall i, (i + rest <= n)%nat -> row_from (Z.of_nat n) (Z.of_nat i) (factor * choose n i) rest =
  map (fun k => factor * choose n k)%Z (seq i (S rest)).
Proof.
  induction rest as [| rest IH]; intros i E; [easy |]. cbn [row_from]. change (seq i (S (S rest))) with (i :: seq (S i) (S rest)).
  cbn [map]. f_equal. replace (Z.of_nat i + 1)%Z with (Z.of_nat (S i)) by lia. rewrite <- (IH (S i)) by lia. f_equal.
  rewrite <- Z.mul_assoc, (Z.mul_comm (choose n i)), <- choose_next. replace (Z.of_nat i + 1)%Z with (Z.of_nat (S i)) by lia.
  rewrite Z.mul_assoc, (Z.mul_comm factor), <- Z.mul_assoc, Z.mul_comm, Z.div_mul by lia. easy.
Qed.

Lemma first_margins factor n : row_from (Z.of_nat n) 0 factor n = map (Z.mul factor) (choices n (S n)).
Proof.
  unfold choices. rewrite map_map. pose proof (choices_from factor n n 0 ltac:(lia)) as H.
  now replace (factor * choose n 0)%Z with factor in H by (destruct n; simpl; ring).
Qed.
Lemma margins_are factor n : row_from (Z.of_nat (S n)) 0 factor n = map (Z.mul factor) (choices (S n) (S n)).
Proof.
  unfold choices. rewrite map_map. pose proof (choices_from factor (S n) n 0 ltac:(lia)) as H.
  now replace (factor * choose (S n) 0)%Z with factor in H by (simpl; ring).
Qed.
Lemma choices_binomials n : map IZR (choices n (S n)) = binomials n.
Proof.
  rewrite <- (proj1 (binomial_row_right n)). f_equal. unfold choices, binomial_row. symmetry.
  replace 1%Z with (choose n 0) by (now destruct n). now apply (row_from_right n n 0).
Qed.

(** signs: certain beyond the margin *)
Definition sign_beyond (margin x : Z) : Z := if (margin <? x)%Z then 1 else if (margin <? - x)%Z then -1 else 0.
Fixpoint signs_beyond (margins h : list Z) : list Z :=
  match margins, h with m :: margins, x :: h => sign_beyond m x :: signs_beyond margins h | _, _ => [] end.
Definition signs (n : nat) (a : list Z) (error : Z) : list Z :=
  signs_beyond (row_from (Z.of_nat (S n)) 0 error n) (integer_row n a).

Theorem signs_right p low width n a error : (0 <= error)%Z -> local_form p low width n a error ->
  row_of p low (low + width) (signs n a error).
Proof.
  intros E (Na & exact & c & Le & C & V & N). exists (exact_row n exact). split; [now apply exact_row_stands with c |].
  pose proof E as E'. apply IZR_le in E'. apply (bernstein_near _ n a exact E' Le) in N. unfold signs.
  rewrite margins_are by lia. induction N as [| x y m h k ms H N IH]; [constructor |]. cbn [map signs_beyond]. constructor; auto.
  split; [pose proof (sgn_plain [y]) as F; now inversion_clear F |]. rewrite <- mult_IZR in H. apply Rabs_le_inv in H. unfold sign_beyond.
  destruct (Z.ltb_spec (error * m) x) as [B | B]; [| destruct (Z.ltb_spec (error * m) (- x)) as [B' | B']]; intros K; try easy;
    [apply IZR_lt in B | apply IZR_lt in B'; rewrite opp_IZR in B'];
    destruct (sgn_cases y) as [(L & ->) | [(L & ->) | (L & ->)]]; auto; exfalso; lra.
Qed.

(** coefficients: divided by C(n, i) *)
Fixpoint quotients (c h : list Z) : list Z :=
  match c, h with k :: c, x :: h => Z.quot x k :: quotients c h | _, _ => [] end.
Definition coefficients (n : nat) (a : list Z) : list Z := quotients (binomial_row n) (integer_row n a).
Definition coefficients_error (n : nat) (error : Z) : Z := (error * (Z.of_nat n + 1) + 1)%Z.

Lemma quot_near x k : (0 < k)%Z -> Rabs (IZR (Z.quot x k) - IZR x / IZR k) <= 1.
Proof.
  intros K. pose proof (Z.quot_rem x k ltac:(lia)) as D. pose proof (Z.rem_bound_abs x k ltac:(lia)) as B.
  set (q := Z.quot x k) in *. set (r := Z.rem x k) in *. apply (f_equal IZR) in D. rewrite plus_IZR, mult_IZR in D.
  pose proof (IZR_lt _ _ K) as P. replace (IZR q - IZR x / IZR k) with (- IZR r * / IZR k) by (rewrite D; field; lra).
  rewrite Rabs_mult, Rabs_Ropp, (Rabs_pos_eq (/ IZR k)) by (left; now apply Rinv_0_lt_compat). rewrite <- abs_IZR.
  apply Rmult_le_reg_r with (IZR k); [easy |]. rewrite Rmult_assoc, Rinv_l by lra. assert (IZR (Z.abs r) <= IZR k) by (apply IZR_le; lia). lra.
Qed.
Lemma choose_above n i : (i <= n)%nat -> (choose (S n) i <= (Z.of_nat n + 1) * choose n i)%Z.
Proof.
  intros I. destruct i as [| k]; [simpl; destruct n; simpl; lia |]. change (choose (S n) (S k)) with (choose n k + choose n (S k))%Z.
  pose proof (choose_next n k) as C. pose proof (choose_nonnegative n k). pose proof (choose_nonnegative n (S k)).
  assert (1 * choose n k <= (Z.of_nat n - Z.of_nat k) * choose n k)%Z by (apply Z.mul_le_mono_nonneg_r; lia).
  assert ((Z.of_nat k + 1) * choose n (S k) <= Z.of_nat n * choose n (S k))%Z by (apply Z.mul_le_mono_nonneg_r; lia). lia.
Qed.

Theorem coefficients_right p low width n a error : (0 <= error)%Z -> local_form p low width n a error ->
  exists b, controls b p low (low + width) /\ within (coefficients n a) (coefficients_error n error) 1 b.
Proof.
  intros E (Na & exact & c & Le & C & V & N). pose proof E as E'. apply IZR_le in E'. apply (bernstein_near _ n a exact E' Le) in N.
  assert (Row : binomial_row n = choices n (S n)).
  { unfold binomial_row, choices. replace 1%Z with (choose n 0) by (now destruct n). now apply (row_from_right n n 0). }
  assert (G : forall l h k, (forall i, In i l -> (i <= n)%nat) -> rows_near (IZR error) h k (map (choose (S n)) l) ->
    exists b, products (map IZR (map (choose n) l)) b = k /\ length b = length l /\
      within (quotients (map (choose n) l) h) (coefficients_error n error) 1 b).
  { clear - E'. induction l as [| i l IH]; intros h k I N; inversion N as [| x y m h' k' ms H N']; subst; [exists []; repeat split; constructor |].
    destruct (IH _ _ (fun i J => I i (or_intror J)) N') as (b & P & L & W). specialize (I i (or_introl eq_refl)).
    pose proof (choose_positive n i I) as K. pose proof (IZR_lt _ _ K) as K'. pose proof (choose_above n i I) as Q.
    exists (y / IZR (choose n i) :: b). cbn [map products length quotients]. rewrite P, L. split; [f_equal; field; lra |]. split; [easy |].
    constructor; [| exact W]. unfold coefficients_error. rewrite plus_IZR, mult_IZR, plus_IZR, !Rmult_1_r.
    pose proof (quot_near x _ K) as D. apply IZR_le in Q. rewrite mult_IZR, plus_IZR in Q.
    set (c := IZR (choose n i)) in *. set (m := IZR (choose (S n) i)) in *.
    replace (IZR (Z.quot x (choose n i)) - y / c) with ((IZR (Z.quot x (choose n i)) - IZR x / c) + (IZR x - y) * / c) by (field; lra).
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite (Rabs_mult (IZR x - y)), (Rabs_pos_eq (/ c)) by (left; now apply Rinv_0_lt_compat).
    assert (Rabs (IZR x - y) * / c <= IZR error * (IZR (Z.of_nat n) + 1)); [| lra].
    apply Rmult_le_reg_r with c; auto. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
    apply Rle_trans with (1 := H). rewrite Rmult_assoc. now apply Rmult_le_compat_l. }
  destruct (G (seq 0 (S n)) _ _ ltac:(intros i I; apply in_seq in I; lia) N) as (b & P & L & W).
  rewrite seq_length in L. fold (choices n (S n)) in P, W. rewrite <- Row in P, W. exists b. split; [| exact W]. unfold controls, scaled_coefficients. rewrite L.
  replace (S n - 1)%nat with n by lia. rewrite <- (proj1 (binomial_row_right n)), P. now apply exact_row_stands with c.
Qed.

(** The signs of a fixed_row of them. *)
Theorem row_signs_of_coefficients p low width n a error excess : (0 <= error)%Z -> local_form p low width n a error ->
  row_of p low (low + width)
    (map (row_sign (cut_error excess (coefficients_error n error))) (cut_row excess (coefficients n a))).
Proof.
  intros E F. destruct (coefficients_right p low width n a error E F) as (b & C & W).
  assert (P : (0 <= coefficients_error n error)%Z) by (unfold coefficients_error; nia).
  destruct (row_cut_right excess _ _ _ P W) as (Q & W'). exists (scaled_coefficients b). split; [exact C |].
  rewrite scaled_signs. apply row_signs_right with (pow2 excess); auto. apply bpow_gt_0.
Qed.

(** ** Subintervals without roots *)

Lemma value_near p low width n a error u : (0 <= error)%Z -> local_form p low width n a error -> 0 <= u <= 1 ->
  exists c v, 0 < c /\ v = c * power_form p (low + width * u) /\
    Rabs (power_form (map IZR a) u - v) <= IZR error * (IZR (Z.of_nat n) + 1).
Proof.
  intros E (Na & exact & c & Le & C & V & N) U. exists c, (power_form exact u). repeat split; auto.
  apply IZR_le in E. pose proof (power_form_near _ _ _ u E U N) as B. now rewrite Le, S_INR, INR_IZR_INZ in B.
Qed.
Lemma beyond_not_zero p low width n a error u : (0 <= error)%Z -> local_form p low width n a error -> 0 <= u <= 1 ->
  IZR error * (IZR (Z.of_nat n) + 1) < Rabs (power_form (map IZR a) u) -> power_form p (low + width * u) <> 0.
Proof.
  intros E F U B Z. destruct (value_near _ _ _ _ _ _ u E F U) as (c & v & C & -> & H). rewrite Z, Rmult_0_r, Rminus_0_r in H. lra.
Qed.

Definition low_end_is_certain (a : list Z) (error : Z) : bool := (error <? Z.abs (hd 0 a))%Z.
Definition high_end_is_certain (n : nat) (a : list Z) (error : Z) : bool :=
  (error * (Z.of_nat n + 1) <? Z.abs (fold_right Z.add 0 a))%Z.
Theorem low_end_right p low width n a error : local_form p low width n a error ->
  low_end_is_certain a error = true -> power_form p low <> 0.
Proof.
  intros (Na & exact & c & Le & C & V & N) B Z. apply Z.ltb_lt, IZR_lt in B. rewrite abs_IZR in B.
  specialize (V 0). rewrite Rmult_0_r, Rplus_0_r, Z, Rmult_0_r in V. destruct exact as [| y exact]; [discriminate |].
  destruct N as (H & _). simpl in V. assert (y = 0) as -> by lra. rewrite Rminus_0_r in H. lra.
Qed.
Theorem high_end_right p low width n a error : (0 <= error)%Z -> local_form p low width n a error ->
  high_end_is_certain n a error = true -> power_form p (low + width) <> 0.
Proof.
  intros E F B. apply Z.ltb_lt, IZR_lt in B. rewrite abs_IZR, mult_IZR, plus_IZR in B.
  rewrite <- (Rmult_1_r width). apply (beyond_not_zero p low width n a error 1 E F); [lra |].
  replace (power_form (map IZR a) 1) with (IZR (fold_right Z.add 0%Z a)); [easy |].
  clear. induction a as [| x a IH]; [easy |]. cbn [fold_right map power_form]. rewrite plus_IZR, IH. ring.
Qed.

(** surely_rootless: the Bernstein coefficients of the kept terms all exceed the margins on one side *)
Fixpoint all_beyond (negative : bool) (margins h : list Z) : bool :=
  match margins, h with
  | m :: margins, x :: h => (m <? (if negative then - x else x))%Z && all_beyond negative margins h
  | _, _ => true
  end.
Definition surely_rootless (n : nat) (a : list Z) (error : Z) : bool :=
  let m := (length a - 1)%nat in let h := integer_row m a in
  all_beyond (hd 0 h <? 0)%Z (row_from (Z.of_nat m) 0 (error * (Z.of_nat n + 1)) m) h.

Lemma form_above f g s t : Forall2 Rlt f g -> f <> [] -> 0 <= s -> 0 <= t -> 0 < s + t -> form f s t < form g s t.
Proof.
  intros F N S T P. assert (D : exists d, Forall (Rlt 0) d /\ length d = length f /\ length g = length f /\ form g s t = form f s t + form d s t).
  { clear N. induction F as [| x y f g L F (d & D & Ld & Lg & E)]; [exists []; repeat split; [constructor | simpl; ring] |].
    exists (y - x :: d). repeat split; [constructor; [lra | easy] | simpl; lia | simpl; lia |]. cbn [form]. rewrite E, Ld, Lg. ring. }
  destruct D as (d & D & Ld & _ & E). destruct d as [| x d]; [destruct f; [easy | discriminate] |].
  pose proof (hull_positive x d s t D S T P). lra.
Qed.

Theorem surely_rootless_right p low width n a error : (0 <= error)%Z -> 0 < width -> local_form p low width n a error ->
  surely_rootless n a error = true -> forall x, low <= x <= low + width -> power_form p x <> 0.
Proof.
  intros E W F B x X. set (u := (x - low) / width). assert (U : 0 <= u <= 1).
  { unfold u. split; [apply Rmult_le_pos; [lra | left; now apply Rinv_0_lt_compat] |].
    apply Rmult_le_reg_r with width; auto. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. }
  replace x with (low + width * u) by (unfold u; field; lra). apply (beyond_not_zero p low width n a error u E F U).
  destruct F as (Na & _). unfold surely_rootless in B. set (m := (length a - 1)%nat) in *.
  rewrite first_margins in B by lia. set (k := (error * (Z.of_nat n + 1))%Z) in *.
  assert (Lh : length (integer_row m a) = S m) by (unfold bernstein; rewrite raised_by_length; simpl; lia).
  assert (Value : on_unit (map IZR (integer_row m a)) u = power_form (map IZR a) u).
  { rewrite integer_row_reals. apply exact_row_value. rewrite map_length. destruct a; [easy | unfold m; simpl; lia]. }
  assert (Margin : on_unit (map IZR (map (Z.mul k) (choices m (S m)))) u = IZR k).
  { rewrite map_map, (map_ext _ (fun c => IZR k * IZR c)) by (intros; apply mult_IZR). rewrite <- map_map. unfold on_unit.
    rewrite form_scaled, choices_binomials, form_binomials. replace (1 - u + u) with 1 by ring. rewrite pow1. ring. }
  assert (Not : map IZR (map (Z.mul k) (choices m (S m))) <> []) by discriminate.
  replace (IZR error * (IZR (Z.of_nat n) + 1)) with (IZR k) by (unfold k; rewrite mult_IZR, plus_IZR; ring).
  rewrite <- Margin, <- Value. assert (Lm : length (choices m (S m)) = S m) by (unfold choices; now rewrite map_length, seq_length).
  destruct (hd 0 (integer_row m a) <? 0)%Z.
  - assert (Q : on_unit (map IZR (map (Z.mul k) (choices m (S m)))) u < on_unit (map Ropp (map IZR (integer_row m a))) u).
    { apply form_above; auto; try lra. rewrite <- Lm in Lh. clear - B Lh. revert B Lh. generalize (integer_row m a) (choices m (S m)).
      induction l as [| x h IH]; intros [| c l] B L; try discriminate; [constructor |]. cbn [map all_beyond] in *.
      apply andb_prop in B. destruct B as (B & B'). constructor; [| apply IH; auto]. apply Z.ltb_lt, IZR_lt in B. now rewrite opp_IZR in B. }
    rewrite on_unit_opp in Q. apply Rlt_le_trans with (1 := Q). rewrite <- Rabs_Ropp. apply Rle_abs.
  - assert (Q : on_unit (map IZR (map (Z.mul k) (choices m (S m)))) u < on_unit (map IZR (integer_row m a)) u).
    { apply form_above; auto; try lra. rewrite <- Lm in Lh. clear - B Lh. revert B Lh. generalize (integer_row m a) (choices m (S m)).
      induction l as [| x h IH]; intros [| c l] B L; try discriminate; [constructor |]. cbn [map all_beyond] in *.
      apply andb_prop in B. destruct B as (B & B'). constructor; [| apply IH; auto]. now apply Z.ltb_lt, IZR_lt in B. }
    apply Rlt_le_trans with (1 := Q). apply Rle_abs.
Qed.
