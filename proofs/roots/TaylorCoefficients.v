(** The constructor of local_form (include/errbound/roots/local_form.hpp): the Taylor coefficients of a polynomial on
    an interval, from powers and quotients that are rounded to a number of bits. Results:
        terms_right         terms: each within 3 of c_i low^i in a common unit, with that number of bits
        error_bits_right    error_bits: C(n + 1, j + 1) (width/low)^j is at most 2^error_bits
        taylor_right        the constructor: the hypotheses of LocalForm.v on the integers and their error *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Flocq Require Import Core.
From Errbound Require Import Sign Bernstein SignVariations RootIsolation ControlValues LocalForm.
Import ListNotations.
Open Scope R_scope.

(** ** Rounded numbers: mantissa 2^exponent *)

Definition number : Set := (Z * Z)%type.
Definition value (x : number) : R := IZR (fst x) * pow2 (snd x).
Definition times (x y : number) : number := (fst x * fst y, snd x + snd y)%Z.
(** floor_log2, and cut *)
Definition bits_of (m : Z) : Z := if (m =? 0)%Z then 0%Z else (Z.log2 (Z.abs m) + 1)%Z.
Definition cut_to (bits : Z) (x : number) : number :=
  let excess := (bits_of (fst x) - bits)%Z in
  if ((fst x =? 0) || (excess <=? 0))%Z then x else (cut_shift (- excess) (fst x), snd x + excess)%Z.

(** v is X except for k relative errors of size r, and at most X. *)
Definition below (k r v X : R) : Prop := X * (1 - k * r) <= v <= X.

Lemma pow2_shifted a b : pow2 a * pow2 b = pow2 (a + b).
Proof. symmetry. apply bpow_plus. Qed.
Lemma value_times x y : value (times x y) = value x * value y.
Proof. unfold value, times. cbn [fst snd]. rewrite mult_IZR, bpow_plus. ring. Qed.
Lemma value_positive x : (0 < fst x)%Z -> 0 < value x.
Proof. intros P. apply Rmult_lt_0_compat; [now apply IZR_lt | apply bpow_gt_0]. Qed.
Lemma below_times a b r v w X Y : 0 <= r -> 0 <= b -> b * r <= 1 -> 0 <= a -> 0 < X -> 0 < Y -> 0 <= v -> 0 <= w ->
  below a r v X -> below b r w Y -> below (a + b) r (v * w) (X * Y).
Proof.
  intros Pr Pb Pbr Pa PX PY Pv Pw (V0 & V1) (W0 & W1). split.
  - apply Rle_trans with (v * (Y * (1 - b * r))); [| now apply Rmult_le_compat_l].
    apply Rle_trans with (X * (1 - a * r) * (Y * (1 - b * r))).
    + assert (0 <= X * Y * (a * r * (b * r))) by (repeat apply Rmult_le_pos; lra). lra.
    + apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra.
  - now apply Rmult_le_compat.
Qed.
Lemma below_cut a r w v X : 0 <= r <= 1 -> 0 <= a -> 0 < X -> below a r v X -> below 1 r w v -> below (a + 1) r w X.
Proof.
  intros R A P (V0 & V1) (W0 & W1). split; [| lra]. apply Rle_trans with (2 := W0).
  assert (0 <= X * (a * r * r)) by (repeat apply Rmult_le_pos; lra).
  assert (X * (1 - a * r) * (1 - 1 * r) <= v * (1 - 1 * r)) by (apply Rmult_le_compat_r; lra). lra.
Qed.
Lemma cut_to_below bits x : (0 < bits)%Z -> (0 < fst x)%Z -> (0 < fst (cut_to bits x))%Z /\
  below 1 (pow2 (1 - bits)) (value (cut_to bits x)) (value x).
Proof.
  destruct x as (m, e). cbn [fst]. intros B M. pose proof (bpow_gt_0 radix2 (1 - bits)) as R.
  pose proof (value_positive (m, e) M) as V. unfold cut_to. cbn [fst snd].
  destruct (Z.eqb_spec m 0) as [K | _]; [lia |]. cbn [orb]. set (excess := (bits_of m - bits)%Z).
  destruct (Z.leb_spec excess 0) as [L | L].
  - split; auto. split; [| lra]. assert (0 <= value (m, e) * pow2 (1 - bits)) by (apply Rmult_le_pos; lra). lra.
  - destruct (Z.log2_spec m M) as (L0 & _).
    assert (Ex : excess = (Z.log2 m + 1 - bits)%Z).
    { unfold excess, bits_of. destruct (Z.eqb_spec m 0) as [K | _]; [lia |]. now rewrite Z.abs_eq by lia. }
    assert (Size : pow2 excess <= IZR m * pow2 (1 - bits)).
    { apply Rmult_le_reg_r with (pow2 (bits - 1)); [apply bpow_gt_0 |]. rewrite Rmult_assoc, !pow2_shifted.
      replace (1 - bits + (bits - 1))%Z with 0%Z by ring. replace (excess + (bits - 1))%Z with (Z.log2 m) by (rewrite Ex; ring).
      simpl bpow at 2. rewrite Rmult_1_r, <- pow2_integer by apply Z.log2_nonneg. now apply IZR_le. }
    pose proof (cut_shift_near (- excess) m) as C. pose proof (cut_shift_below (- excess) m ltac:(lia)) as D.
    assert (P : (0 < cut_shift (- excess) m)%Z).
    { unfold cut_shift. destruct (Z.leb_spec 0 (- excess)); [lia |]. rewrite Z.opp_involutive. unfold cut.
      rewrite Z.sgn_pos, Z.mul_1_l, Z.abs_eq by lia. apply Z.div_str_pos. split; [apply Z.pow_pos_nonneg; lia |].
      apply Z.le_trans with (2 ^ Z.log2 m)%Z; auto. apply Z.pow_le_mono_r; lia. }
    cbn [fst]. split; auto. unfold below, value. cbn [fst snd]. rewrite bpow_plus.
    set (q := IZR (cut_shift (- excess) m)) in *. apply Rabs_le_inv in C.
    assert (Inv : pow2 (- excess) * pow2 excess = 1).
    { rewrite pow2_shifted. now replace (- excess + excess)%Z with 0%Z by ring. }
    pose proof (bpow_gt_0 radix2 e) as Pe. pose proof (bpow_gt_0 radix2 excess) as Px.
    assert (G : forall a b, a <= b -> a * (pow2 e * pow2 excess) <= b * (pow2 e * pow2 excess)).
    { intros a b H. apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra. }
    assert (I : IZR m * pow2 (- excess) * (pow2 e * pow2 excess) = IZR m * pow2 e)
      by (rewrite <- (Rmult_1_r (IZR m * pow2 e)), <- Inv; ring).
    split.
    + destruct C as (C & _). apply G in C. assert (pow2 e * pow2 excess <= pow2 e * (IZR m * pow2 (1 - bits))) by (apply Rmult_le_compat_l; lra). lra.
    + apply G in D. lra.
Qed.

(** ** terms *)

Fixpoint products_from (bits : Z) (base power : number) (p : list Z) : list number :=
  match p with
  | [] => []
  | c :: p => (c * fst power, snd power)%Z :: products_from bits base (cut_to bits (times power base)) p
  end.
Definition high (x : number) (otherwise : Z) : Z := if (fst x =? 0)%Z then otherwise else (bits_of (fst x) + snd x)%Z.
Definition top_of (all : list number) : Z :=
  match all with [] => 0 | x :: all => fold_left (fun top y => Z.max top (high y top)) all (high x 0) end.
Definition in_unit_of (unit : Z) (x : number) : Z := cut_shift (snd x - unit) (fst x).
Definition terms (bits count_bits : Z) (low : number) (p : list Z) : list Z :=
  let all := products_from (bits + count_bits + 1) low (1, 0)%Z p in map (in_unit_of (top_of all - bits)) all.

Lemma fold_high all : forall top, (top <= fold_left (fun top y => Z.max top (high y top)) all top)%Z /\
  Forall (fun x => fst x <> 0%Z -> (bits_of (fst x) + snd x <= fold_left (fun top y => Z.max top (high y top)) all top)%Z) all.
Proof.
  induction all as [| x all IH]; intros top; cbn [fold_left]; [split; [lia | constructor] |].
  destruct (IH (Z.max top (high x top))) as (A & B). split; [lia |]. constructor; auto. intros N.
  unfold high in *. destruct (Z.eqb_spec (fst x) 0); [easy | lia].
Qed.
Lemma bits_enough x : Rabs (IZR x) <= pow2 (bits_of x).
Proof.
  unfold bits_of. destruct (Z.eqb_spec x 0) as [-> | N]; [rewrite Rabs_R0; simpl; lra |]. rewrite <- abs_IZR.
  destruct (Z.log2_spec (Z.abs x) ltac:(lia)) as (_ & B). pose proof (Z.log2_nonneg (Z.abs x)).
  rewrite <- pow2_integer by lia. apply IZR_le. replace (Z.log2 (Z.abs x) + 1)%Z with (Z.succ (Z.log2 (Z.abs x))) by lia. lia.
Qed.
Lemma top_enough all : Forall (fun x => Rabs (IZR (fst x)) * pow2 (snd x) <= pow2 (top_of all)) all.
Proof.
  assert (G : Forall (fun x => fst x <> 0%Z -> (bits_of (fst x) + snd x <= top_of all)%Z) all).
  { destruct all as [| x all]; [constructor |]. cbn [top_of]. destruct (fold_high all (high x 0)) as (A & B). constructor; auto.
    intros N. unfold high in A at 1. destruct (Z.eqb_spec (fst x) 0); [easy | lia]. }
  eapply Forall_impl; [| exact G]. intros x H. cbv beta in H. destruct (Z.eq_dec (fst x) 0) as [E | N].
  - rewrite E, Rabs_R0, Rmult_0_l. apply bpow_ge_0.
  - apply Rle_trans with (pow2 (bits_of (fst x)) * pow2 (snd x)); [apply Rmult_le_compat_r; [apply bpow_ge_0 | apply bits_enough] |].
    rewrite pow2_shifted. now apply bpow_le, H.
Qed.
Lemma cut_shift_opp shift x : cut_shift shift (- x) = (- cut_shift shift x)%Z.
Proof. unfold cut_shift, cut. destruct (0 <=? shift)%Z; [ring |]. rewrite Z.sgn_opp, Z.abs_opp. ring. Qed.
Lemma cut_shift_size shift x : Rabs (IZR (cut_shift shift x)) <= Rabs (IZR x) * pow2 shift.
Proof.
  assert (G : forall x, (0 <= x)%Z -> Rabs (IZR (cut_shift shift x)) <= Rabs (IZR x) * pow2 shift).
  { intros y Y. pose proof (cut_shift_nonnegative shift y Y). rewrite !Rabs_pos_eq by now apply IZR_le. now apply cut_shift_below. }
  destruct (Z.le_ge_cases 0 x) as [P | P]; [now apply G |]. specialize (G (- x)%Z ltac:(lia)).
  rewrite cut_shift_opp, !opp_IZR, !Rabs_Ropp in G. exact G.
Qed.

(** A number of the row, and the real number that it stands for. *)
Definition term_right (bits : Z) (t : Z) (exact : R) : Prop := Rabs (IZR t - exact) <= 3 /\ Rabs (IZR t) <= pow2 bits.
Lemma products_right width base bits top p : (0 < width)%Z -> (0 < bits)%Z -> (0 < fst base)%Z -> let r := pow2 (1 - width) in forall power k X,
  (0 < fst power)%Z -> 0 <= k -> 0 < X -> below k r (value power) X -> (k + INR (length p)) * r * pow2 bits <= 1 ->
  Forall (fun x => Rabs (IZR (fst x)) * pow2 (snd x) <= pow2 top) (products_from width base power p) ->
  Forall2 (term_right bits) (map (in_unit_of (top - bits)) (products_from width base power p))
    (times_powers (value base) (X * pow2 (bits - top)) (map IZR p)).
Proof.
  intros W B Pb r. pose proof (bpow_gt_0 radix2 (1 - width)) as R. fold r in R. pose proof (bpow_gt_0 radix2 bits) as Pbits.
  assert (Two : 2 <= pow2 bits) by (change 2 with (pow2 1); apply bpow_le; lia).
  induction p as [| c p IH]; intros power k X Pp K PX V Count F; [constructor |]. cbn [products_from map times_powers] in *.
  inversion_clear F as [| ? ? H F']. cbn [fst snd length] in *. rewrite S_INR in Count. pose proof (pos_INR (length p)) as Pn.
  assert (Kr : k * r * pow2 bits <= 1).
  { assert (0 <= (INR (length p) + 1) * r * pow2 bits) by (repeat apply Rmult_le_pos; lra). lra. }
  constructor.
  - unfold term_right, in_unit_of. cbn [fst snd]. set (u := pow2 (bits - top)). pose proof (bpow_gt_0 radix2 (bits - top)) as U. fold u in U.
    replace (snd power - (top - bits))%Z with (snd power + (bits - top))%Z by ring.
    pose proof (cut_shift_near (snd power + (bits - top)) (c * fst power)) as C. pose proof (cut_shift_size (snd power + (bits - top)) (c * fst power)) as Z.
    rewrite bpow_plus in C, Z. fold u in C, Z. set (v := value power) in *. assert (PV : 0 < v) by now apply value_positive.
    assert (E : IZR (c * fst power) * (pow2 (snd power) * u) = IZR c * v * u) by (rewrite mult_IZR; unfold v, value; ring).
    assert (Size : Rabs (IZR c) * v * u <= pow2 bits).
    { apply Rmult_le_compat_r with (r := u) in H; [| lra]. unfold u in H at 2. rewrite pow2_shifted in H.
      replace (top + (bits - top))%Z with bits in H by ring. rewrite mult_IZR, Rabs_mult, (Rabs_pos_eq (IZR (fst power))) in H by (apply IZR_le; lia).
      unfold v, value. lra. }
    split.
    + rewrite E in C. set (t := IZR (cut_shift (snd power + (bits - top)) (c * fst power))) in *.
      replace (t - IZR c * (X * u)) with ((t - IZR c * v * u) + IZR c * u * (v - X)) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult, (Rabs_pos_eq u), (Rabs_left1 (v - X)) by (destruct V; lra).
      destruct V as (V0 & V1).
      assert (Half : k * r <= / 2).
      { apply Rmult_le_reg_r with (pow2 bits); auto. lra. }
      assert (X2 : X <= 2 * v) by (assert (X * (k * r) <= X * / 2) by (apply Rmult_le_compat_l; lra); lra).
      assert (Gap : X - v <= 2 * (k * r) * v).
      { assert (X * (k * r) <= 2 * v * (k * r)) by (apply Rmult_le_compat_r; [apply Rmult_le_pos; lra | easy]). lra. }
      pose proof (Rabs_pos (IZR c)) as Pc.
      assert (Rabs (IZR c) * u * (X - v) <= Rabs (IZR c) * u * (2 * (k * r) * v)) by (apply Rmult_le_compat_l; [apply Rmult_le_pos |]; lra).
      assert (2 * (k * r) * (Rabs (IZR c) * v * u) <= 2 * (k * r) * pow2 bits)
        by (apply Rmult_le_compat_l; [repeat apply Rmult_le_pos |]; lra). lra.
    + apply Rle_trans with (1 := Z). rewrite mult_IZR, Rabs_mult, (Rabs_pos_eq (IZR (fst power))) by (apply IZR_le; lia).
      unfold v, value in Size. lra.
  - assert (Pt : (0 < fst (times power base))%Z) by (cbn; nia). destruct (cut_to_below width _ W Pt) as (Pc & Bc). fold r in Bc.
    pose proof (value_positive _ Pb) as PV. replace (X * pow2 (bits - top) * value base) with (X * value base * pow2 (bits - top)) by ring.
    apply IH with (k + 1); auto; [lra | now apply Rmult_lt_0_compat | | lra].
    rewrite value_times in Bc. apply below_cut with (value power * value base); auto; [| now apply Rmult_lt_0_compat |].
    + split; [lra |]. assert (r <= / 2); [| lra]. apply Rmult_le_reg_r with (pow2 bits); auto.
      assert (0 <= k * r * pow2 bits) by (repeat apply Rmult_le_pos; lra).
      assert (0 <= INR (length p) * r * pow2 bits) by (repeat apply Rmult_le_pos; lra). lra.
    + destruct V as (V0 & V1). split; [| apply Rmult_le_compat_r; [now left | exact V1]].
      replace (X * value base * (1 - k * r)) with (X * (1 - k * r) * value base) by ring. apply Rmult_le_compat_r; [now left | exact V0].
Qed.

Definition count_bits (p : list Z) : Z := bits_of (Z.of_nat (length p)).
Lemma count_enough p : p <> [] -> (1 <= count_bits p)%Z /\ INR (length p) <= pow2 (count_bits p).
Proof.
  intros N. unfold count_bits. pose proof (bits_enough (Z.of_nat (length p))) as B. rewrite Rabs_pos_eq, <- INR_IZR_INZ in B by (apply IZR_le; lia).
  split; auto. unfold bits_of. destruct (Z.eqb_spec (Z.of_nat (length p)) 0); [destruct p; [easy | simpl in *; lia] |].
  pose proof (Z.log2_nonneg (Z.abs (Z.of_nat (length p)))). lia.
Qed.

Theorem terms_right bits low p : p <> [] -> (0 < fst low)%Z -> (0 < bits)%Z -> exists unit,
  Forall2 (term_right bits) (terms bits (count_bits p) low p) (times_powers (value low) (pow2 unit) (map IZR p)).
Proof.
  intros N L B. destruct (count_enough p N) as (C1 & C). unfold terms. set (all := products_from _ _ _ _).
  exists (bits - top_of all)%Z. rewrite <- (Rmult_1_l (pow2 (bits - top_of all))).
  apply products_right with (k := 0); try lra; try lia; auto; cbn [fst].
  - lia.
  - unfold below, value. simpl. lra.
  - rewrite Rplus_0_l, Rmult_assoc, pow2_shifted. replace (1 - (bits + count_bits p + 1) + bits)%Z with (- count_bits p)%Z by ring.
    pose proof (bpow_gt_0 radix2 (- count_bits p)) as P. apply Rle_trans with (pow2 (count_bits p) * pow2 (- count_bits p));
      [apply Rmult_le_compat_r; lra |]. rewrite pow2_shifted. replace (count_bits p + - count_bits p)%Z with 0%Z by ring. simpl. lra.
  - apply top_enough.
Qed.

(** ** The shift by 1 *)

(** Whole numbers: horner_cut of LocalForm.v without rounding. *)
Lemma horner_next x a : horner_cut 1 0 (x :: a) = (x + hd 0 (horner_cut 1 0 a))%Z :: horner_cut 1 0 a.
Proof. cbn [horner_cut]. rewrite Z.mul_1_r. now rewrite cut_shift_0. Qed.

Lemma horner_near e h k ms : rows_near e h k ms -> rows_near e (horner_cut 1 0 h) (horner 1 k) (horner_cut 1 0 ms).
Proof.
  induction 1 as [| x y m h k ms H N IH]; [constructor |]. rewrite !horner_next, horner_cons, Rmult_1_r. constructor; auto.
  assert (T : Rabs (IZR (hd 0%Z (horner_cut 1 0 h)) - hd 0 (horner 1 k)) <= e * IZR (hd 0%Z (horner_cut 1 0 ms))).
  { destruct IH; [simpl; rewrite Rminus_0_r, Rabs_R0; lra | easy]. }
  rewrite !plus_IZR. set (u := IZR (hd 0%Z (horner_cut 1 0 h))) in *. set (v := hd 0 (horner 1 k)) in *.
  replace (IZR x + u - (y + v)) with ((IZR x - y) + (u - v)) by ring. apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.
Lemma shifted_near e n : forall h k ms, rows_near e h k ms ->
  rows_near e (shifted_cut n 1 0 h) (shifted n 1 k) (shifted_cut n 1 0 ms).
Proof.
  induction n as [| n IH]; intros h k ms N; [easy |]. cbn [shifted_cut shifted]. apply horner_near in N.
  destruct N; constructor; auto.
Qed.
(** n passes turn a row of ones into sums of columns of Pascal's triangle. *)
Fixpoint column (k m : nat) : list Z := match m with O => [] | S m => choose (m + k) k :: column k m end.
Lemma column_0 m : column 0 m = repeat 1%Z m.
Proof. induction m as [| m IH]; [easy |]. cbn [column repeat]. rewrite IH. f_equal. now destruct m. Qed.
Lemma horner_column k m : horner_cut 1 0 (column k m) = column (S k) m.
Proof.
  induction m as [| m IH]; [easy |]. cbn [column]. rewrite horner_next, IH. f_equal.
  destruct m as [| m].
  - cbn [column hd]. rewrite !Nat.add_0_l, !choose_all. easy.
  - cbn [column hd]. replace (S m + S k)%nat with (S (m + S k)) by lia. replace (S m + k)%nat with (m + S k)%nat by lia. easy.
Qed.
Lemma shifted_column n m : forall k j, (m <= n)%nat -> nth j (shifted_cut n 1 0 (column k m)) 0%Z = choose (m + k) (S (k + j)).
Proof.
  revert m. induction n as [| n IH]; intros m k j L.
  - assert (m = 0)%nat as -> by lia. simpl. rewrite choose_beyond by lia. now destruct j.
  - cbn [shifted_cut]. rewrite horner_column. destruct m as [| m]; [simpl; rewrite choose_beyond by lia; now destruct j |].
    cbn [column]. destruct j as [| j]; cbn [nth]; [f_equal; lia |]. rewrite IH by lia. f_equal; lia.
Qed.
(** Only the first passes are made. *)
Lemma first_passes k : forall n h, (k <= n)%nat -> firstn k (shifted_cut k 1 0 h) = firstn k (shifted_cut n 1 0 h).
Proof.
  induction k as [| k IH]; intros n h L; [easy |]. destruct n as [| n]; [lia |]. cbn [shifted_cut].
  destruct (horner_cut 1 0 h) as [| x l]; [easy |]. cbn [firstn]. f_equal. apply IH. lia.
Qed.

(** ** error_bits *)

Definition error_bits (n count ratio : Z) : Z :=
  if (ratio + count <=? 0)%Z then count
  else if (0 <=? ratio)%Z then (n * (ratio + 1))%Z
  else (3 * n / 2 ^ (1 - ratio) + 1 - ratio)%Z.

Lemma exp_third : exp (2 / 3) <= 2.
Proof.
  pose proof (exp_ineq1_le (- (1 / 15))) as H. rewrite exp_Ropp in H. pose proof (exp_pos (1 / 15)) as P.
  assert (B : exp (1 / 15) <= 15 / 14).
  { apply Rmult_le_reg_r with (/ exp (1 / 15)); [now apply Rinv_0_lt_compat |]. rewrite Rinv_r by lra. lra. }
  assert (E : exp (2 / 3) = exp (1 / 15) ^ 10).
  { simpl. rewrite Rmult_1_r, <- !exp_plus. f_equal. field. }
  rewrite E. apply Rle_trans with ((15 / 14) ^ 10); [apply pow_incr; lra | lra].
Qed.
Lemma exp_times x n : exp (INR n * x) = exp x ^ n.
Proof. induction n as [| n IH]; [rewrite Rmult_0_l; apply exp_0 |]. rewrite S_INR, Rmult_plus_distr_r, exp_plus, IH, Rmult_1_l. simpl. ring. Qed.
Lemma choose_power n x : 0 <= x -> forall k, IZR (choose n k) * x ^ k <= (1 + x) ^ n.
Proof.
  intros X. induction n as [| n IH]; intros [| k].
  - simpl. lra.
  - simpl. lra.
  - change (choose (S n) 0) with 1%Z. apply Rle_trans with (1 ^ S n); [rewrite pow1; simpl; lra | apply pow_incr; lra].
  - change (choose (S n) (S k)) with (choose n k + choose n (S k))%Z. rewrite plus_IZR. pose proof (IH k) as A. pose proof (IH (S k)) as B.
    assert (x * (IZR (choose n k) * x ^ k) <= x * (1 + x) ^ n) by (now apply Rmult_le_compat_l). cbn [pow] in *. lra.
Qed.
Lemma choose_count n k : (choose n k <= Z.of_nat n ^ Z.of_nat k)%Z.
Proof.
  induction k as [| k IH]; [destruct n; simpl; lia |]. rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia.
  pose proof (choose_next n k) as C. pose proof (choose_nonnegative n k). pose proof (choose_nonnegative n (S k)). nia.
Qed.

Theorem error_bits_right n ratio x j : (1 <= n)%nat -> 0 < x <= pow2 ratio ->
  IZR (choose n (S j)) * x ^ j <= pow2 (error_bits (Z.of_nat n) (bits_of (Z.of_nat n)) ratio) /\
  (1 <= error_bits (Z.of_nat n) (bits_of (Z.of_nat n)) ratio)%Z.
Proof.
  intros N (X0 & X). set (count := bits_of (Z.of_nat n)).
  pose proof (bits_enough (Z.of_nat n)) as C. fold count in C. rewrite Rabs_pos_eq in C by (apply IZR_le; lia).
  assert (C1 : (1 <= count)%Z).
  { unfold count, bits_of. destruct (Z.eqb_spec (Z.of_nat n) 0); [lia |]. pose proof (Z.log2_nonneg (Z.abs (Z.of_nat n))). lia. }
  pose proof (IZR_le _ _ (choose_nonnegative n (S j))) as Pc.
  assert (Mono : forall y, x <= y -> IZR (choose n (S j)) * x ^ j <= IZR (choose n (S j)) * y ^ j)
    by (intros y Y; apply Rmult_le_compat_l; [easy | apply pow_incr; lra]).
  assert (Power : forall y, 0 < y -> x <= y -> y * (IZR (choose n (S j)) * x ^ j) <= (1 + y) ^ n).
  { intros y Y XY. apply Rle_trans with (2 := choose_power n y (Rlt_le _ _ Y) (S j)). specialize (Mono y XY).
    apply Rmult_le_compat_l with (r := y) in Mono; [simpl in *; lra | lra]. }
  unfold error_bits. destruct (Z.leb_spec (ratio + count) 0) as [L | L]; [| destruct (Z.leb_spec 0 ratio) as [P | P]].
  - split; [| easy]. apply Rle_trans with (1 := Mono _ X).
    apply Rle_trans with (IZR (Z.of_nat n) ^ S j * pow2 ratio ^ j).
    + apply Rmult_le_compat_r; [apply pow_le, bpow_ge_0 |]. rewrite pow_IZR. apply IZR_le, choose_count.
    + simpl. rewrite Rmult_assoc, <- Rpow_mult_distr. assert (Q : 0 <= IZR (Z.of_nat n) * pow2 ratio <= 1).
      { split; [apply Rmult_le_pos; [apply IZR_le; lia | apply bpow_ge_0] |].
        apply Rle_trans with (pow2 count * pow2 ratio); [apply Rmult_le_compat_r; [apply bpow_ge_0 | easy] |]. rewrite pow2_shifted.
        change 1 with (pow2 0). apply bpow_le. lia. }
      pose proof (pow_incr _ _ j Q) as B. rewrite pow1 in B.
      apply Rle_trans with (IZR (Z.of_nat n) * 1); [apply Rmult_le_compat_l; [apply IZR_le; lia | easy] | lra].
  - split; [| nia]. assert (One : 1 <= pow2 ratio) by (change 1 with (pow2 0); apply bpow_le; lia).
    specialize (Power (pow2 ratio) ltac:(lra) X). pose proof (Rmult_le_pos _ _ Pc (pow_le x j (Rlt_le _ _ X0))) as Q.
    apply Rle_trans with ((1 + pow2 ratio) ^ n).
    + assert (1 * (IZR (choose n (S j)) * x ^ j) <= pow2 ratio * (IZR (choose n (S j)) * x ^ j)) by (apply Rmult_le_compat_r; lra). lra.
    + apply Rle_trans with (pow2 (ratio + 1) ^ n); [apply pow_incr; rewrite bpow_plus; simpl (pow2 1); lra |].
      rewrite pow2_power. apply bpow_le. nia.
  - pose proof (Z.div_pos (3 * Z.of_nat n) (2 ^ (1 - ratio)) ltac:(lia) ltac:(apply Z.pow_pos_nonneg; lia)) as D. split; [| lia].
    set (q := (3 * Z.of_nat n / 2 ^ (1 - ratio))%Z) in *. set (y := pow2 ratio) in *. assert (Y : 0 < y) by apply bpow_gt_0.
    specialize (Power y Y X). replace (q + 1 - ratio)%Z with (q + 1 + - ratio)%Z by ring. rewrite bpow_plus, bpow_opp. fold y.
    apply Rmult_le_reg_l with y; auto. apply Rle_trans with (1 := Power).
    replace (y * (pow2 (q + 1) * / y)) with (pow2 (q + 1)) by (field; lra).
    assert (Small : INR n * y <= INR (Z.to_nat (q + 1)) * (2 / 3)).
    { pose proof (Z.mul_succ_div_gt (3 * Z.of_nat n) (2 ^ (1 - ratio)) ltac:(apply Z.pow_pos_nonneg; lia)) as G. fold q in G.
      apply IZR_lt in G. rewrite !mult_IZR, pow2_integer, succ_IZR in G by lia. rewrite !INR_IZR_INZ, Z2Nat.id, plus_IZR by lia.
      assert (E : pow2 (1 - ratio) * y = 2).
      { unfold y. rewrite pow2_shifted. now replace (1 - ratio + ratio)%Z with 1%Z by ring. }
      apply Rmult_lt_compat_r with (r := y) in G; auto.
      replace (pow2 (1 - ratio) * (IZR q + 1) * y) with ((pow2 (1 - ratio) * y) * (IZR q + 1)) in G by ring. rewrite E in G. lra. }
    apply Rle_trans with (exp (INR n * y)).
    + rewrite exp_times. apply pow_incr. split; [lra | apply exp_ineq1_le].
    + apply Rle_trans with (exp (INR (Z.to_nat (q + 1)) * (2 / 3))).
      * destruct Small as [Small | ->]; [left; now apply exp_increasing | lra].
      * rewrite exp_times. apply Rle_trans with (2 ^ Z.to_nat (q + 1)).
        -- apply pow_incr. split; [left; apply exp_pos | apply exp_third].
        -- change 2 with (pow2 1) at 1. rewrite pow2_power, Z2Nat.id by lia. apply bpow_le. lia.
Qed.

(** ** scale: the powers of width/low *)

Definition number_log2 (x : number) : Z := (Z.log2 (fst x) + snd x)%Z.
Definition quotient_of (bits : Z) (low width : number) : number :=
  let shift := (bits + Z.log2 (fst low) - Z.log2 (fst width))%Z in
  (cut_shift shift (fst width) / fst low, snd width - snd low - shift)%Z.
Fixpoint scaled_by (bits : Z) (ratio power : number) (a : list Z) : list Z :=
  match a with
  | [] => []
  | x :: a => cut_shift (snd power) (x * fst power) :: scaled_by bits ratio (cut_to bits (times power ratio)) a
  end.
Definition scale (bits : Z) (ratio : number) (a : list Z) : list Z :=
  match a with [] => [] | x :: a => x :: scaled_by bits ratio ratio a end.

Lemma log2_size m : (0 < m)%Z -> pow2 (Z.log2 m) <= IZR m < 2 * pow2 (Z.log2 m).
Proof.
  intros M. destruct (Z.log2_spec m M) as (A & B). pose proof (Z.log2_nonneg m). apply IZR_le in A. apply IZR_lt in B.
  rewrite pow2_integer in A, B by lia. rewrite <- Z.add_1_r, bpow_plus in B. simpl (pow2 1) in B. lra.
Qed.
Lemma quotient_right bits low width : (0 < fst low)%Z -> (0 < fst width)%Z -> (1 < bits)%Z ->
  (0 < fst (quotient_of bits low width))%Z /\
  below 1 (pow2 (1 - bits)) (value (quotient_of bits low width)) (value width / value low).
Proof.
  destruct low as (lm, le), width as (wm, we). cbn [fst]. intros L W B. unfold quotient_of. cbn [fst snd].
  set (s := (bits + Z.log2 lm - Z.log2 wm)%Z). set (z := cut_shift s wm). set (q := (z / lm)%Z).
  pose proof (IZR_lt _ _ L) as Pl. pose proof (IZR_lt _ _ W) as Pw.
  pose proof (cut_shift_below s wm ltac:(lia)) as Z1. pose proof (cut_shift_near s wm) as Z2. fold z in Z1, Z2. apply Rabs_le_inv in Z2.
  pose proof (Z.mul_div_le z lm L) as Q1. pose proof (Z.mul_succ_div_gt z lm L) as Q2. fold q in Q1, Q2.
  assert (Q3 : (z + 1 <= lm * (q + 1))%Z) by lia. apply IZR_le in Q1, Q3. rewrite mult_IZR in Q1. rewrite plus_IZR, mult_IZR, plus_IZR in Q3.
  set (y := IZR wm * pow2 s / IZR lm).
  assert (Y : IZR lm * y = IZR wm * pow2 s) by (unfold y; field; lra).
  assert (Q : y - 1 <= IZR q <= y).
  { split; apply Rmult_le_reg_l with (IZR lm); auto; rewrite ?Y; lra. }
  assert (Big : 1 <= y * pow2 (1 - bits)).
  { destruct (log2_size lm L) as (_ & Lb). destruct (log2_size wm W) as (Wb & _).
    apply Rmult_le_reg_l with (IZR lm); auto. rewrite <- Rmult_assoc, Y, Rmult_1_r.
    apply Rle_trans with (pow2 (Z.log2 wm) * pow2 s * pow2 (1 - bits)).
    - rewrite !pow2_shifted. replace (Z.log2 wm + s + (1 - bits))%Z with (Z.log2 lm + 1)%Z by (unfold s; ring).
      rewrite bpow_plus. simpl (pow2 1). lra.
    - apply Rmult_le_compat_r; [apply bpow_ge_0 |]. now apply Rmult_le_compat_r; [apply bpow_ge_0 |]. }
  assert (P : 0 < IZR q).
  { assert (R : pow2 (1 - bits) <= / 2) by (change (/ 2) with (pow2 (- 1)); apply bpow_le; lia).
    assert (0 < y) by (unfold y; apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; [easy | apply bpow_gt_0] | now apply Rinv_0_lt_compat]).
    assert (y * pow2 (1 - bits) <= y * / 2) by (apply Rmult_le_compat_l; lra). lra. }
  split; [now apply lt_IZR |].
  assert (E : value (wm, we) / value (lm, le) = y * pow2 (we - le - s)).
  { unfold value, y. cbn [fst snd]. unfold Z.sub. rewrite !bpow_plus, !bpow_opp. pose proof (bpow_gt_0 radix2 le). pose proof (bpow_gt_0 radix2 s). field. lra. }
  unfold below. rewrite E. unfold value. cbn [fst snd]. pose proof (bpow_gt_0 radix2 (we - le - s)) as U.
  split; [| apply Rmult_le_compat_r; lra].
  apply Rle_trans with ((y - 1) * pow2 (we - le - s)); [| apply Rmult_le_compat_r; lra].
  replace (y * pow2 (we - le - s) * (1 - 1 * pow2 (1 - bits))) with ((y - y * pow2 (1 - bits)) * pow2 (we - le - s)) by ring.
  apply Rmult_le_compat_r; lra.
Qed.
Definition sized (e : R) (x m : Z) : Prop := Rabs (IZR x) <= e * IZR m /\ (0 <= m)%Z.
Lemma scaled_by_right width bits ratio rho G : (0 < width)%Z -> (0 < fst ratio)%Z -> 0 < rho -> let r := pow2 (1 - width) in
  r <= 1 -> below 1 r (value ratio) rho -> forall h k ms, rows_near 3 h k ms -> Forall2 (sized (pow2 bits)) h ms ->
  forall power n X, (0 < fst power)%Z -> 0 <= n -> 0 < X -> below n r (value power) X ->
  (n + 2 * INR (length h)) * r * pow2 bits <= / 2 -> (forall j, IZR (nth j ms 0%Z) * (X * rho ^ j) <= G) ->
  Forall2 (fun x y => Rabs (IZR x - y) <= 7 / 2 * G + 1) (scaled_by width ratio power h) (times_powers rho X k).
Proof.
  intros W Pr Rho r R1 Br. pose proof (bpow_gt_0 radix2 (1 - width)) as R0. fold r in R0. pose proof (bpow_gt_0 radix2 bits) as B0.
  induction 1 as [| x y m h k ms H N IH]; intros S power n X Pp Pn PX V Count Most; [constructor |].
  inversion_clear S as [| ? ? ? ? (Sx & Sm) S']. cbn [scaled_by times_powers length] in *. rewrite S_INR in Count.
  pose proof (pos_INR (length h)) as Pl. constructor.
  - specialize (Most 0%nat). cbn [nth pow] in Most. rewrite Rmult_1_r in Most. apply IZR_le in Sm.
    pose proof (cut_shift_near (snd power) (x * fst power)) as C. set (v := value power) in *.
    assert (E : IZR (x * fst power) * pow2 (snd power) = IZR x * v) by (rewrite mult_IZR; unfold v, value; ring). rewrite E in C.
    set (t := IZR (cut_shift (snd power) (x * fst power))) in *.
    replace (t - y * X) with ((t - IZR x * v) + ((IZR x - y) * X + IZR x * (v - X))) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). pose proof (Rabs_triang ((IZR x - y) * X) (IZR x * (v - X))) as T.
    destruct V as (V0 & V1). rewrite !Rabs_mult, (Rabs_pos_eq X), (Rabs_left1 (v - X)) in T by lra.
    assert (A : Rabs (IZR x - y) * X <= 3 * IZR m * X) by (apply Rmult_le_compat_r; lra).
    assert (D : Rabs (IZR x) * - (v - X) <= pow2 bits * IZR m * (X * (n * r))) by (apply Rmult_le_compat; try lra; apply Rabs_pos).
    assert (K : n * r * pow2 bits <= / 2).
    { assert (0 <= 2 * (INR (length h) + 1) * r * pow2 bits) by (repeat apply Rmult_le_pos; lra). lra. }
    assert (IZR m * X * (n * r * pow2 bits) <= IZR m * X * / 2) by (apply Rmult_le_compat_l; [apply Rmult_le_pos |]; lra). lra.
  - assert (Pt : (0 < fst (times power ratio))%Z) by (cbn; nia). destruct (cut_to_below width _ W Pt) as (Pc & Bc). fold r in Bc.
    rewrite value_times in Bc. pose proof (value_positive _ Pr) as Vr. pose proof (value_positive _ Pp) as Vp.
    apply IH with (n + 1 + 1); auto; [lra | now apply Rmult_lt_0_compat | | lra |].
    + apply below_cut with (value power * value ratio); try lra; [now apply Rmult_lt_0_compat | | exact Bc].
      apply below_times; try lra; auto.
    + intros j. specialize (Most (S j)). cbn [nth pow] in Most. now rewrite !Rmult_assoc in *.
Qed.

(** ** The constructor *)

Definition kept_terms (n bits count ratio : Z) : Z :=
  let falling := (- (ratio + count))%Z in if (falling <=? 0)%Z then n else Z.min n ((bits + count) / falling + 2).
Definition taylor (p : list Z) (low width : number) (bits : Z) : list Z * Z :=
  let n := Z.of_nat (length p) in let ratio := (number_log2 width - number_log2 low + 1)%Z in
  let lost := error_bits n (count_bits p) ratio in let precision := (bits + lost)%Z in
  let kept := Z.to_nat (kept_terms n precision (count_bits p) ratio) in
  let a := firstn kept (shifted_cut kept 1 0 (terms precision (count_bits p) low p)) in
  let digits := (precision + count_bits p + 3)%Z in
  (scale digits (quotient_of digits low width) a, 4 * 2 ^ lost)%Z.

Lemma rows_index e h k ms : rows_near e h k ms -> (forall i, Rabs (IZR (nth i h 0%Z) - nth i k 0) <= e * IZR (nth i ms 0%Z)) /\
  length h = length k /\ length h = length ms.
Proof.
  induction 1 as [| x y m h k ms H N (IH & L & L')]; [| repeat split; simpl; auto; intros [| i]; simpl; auto].
  repeat split. intros [| i]; simpl; rewrite Rminus_0_r, Rabs_R0; lra.
Qed.
Lemma shifted_zeros n m : shifted n 1 (repeat 0 m) = repeat 0 m.
Proof.
  assert (H : forall m, horner 1 (repeat 0 m) = repeat 0 m).
  { induction m0 as [| k IH]; [easy |]. change (repeat 0 (S k)) with (0 :: repeat 0 k). rewrite horner_cons, IH. f_equal. destruct k; simpl; ring. }
  revert m. induction n as [| n IH]; intros m; [easy |]. cbn [shifted]. rewrite H. destruct m as [| m]; [easy |]. cbn [repeat]. now rewrite IH.
Qed.
Lemma times_powers_index r p i : forall w, nth i (times_powers r w p) 0 = nth i p 0 * (w * r ^ i).
Proof.
  revert i. induction p as [| a p IH]; intros [| i] w; cbn [times_powers nth pow]; try ring. rewrite IH. ring.
Qed.
Lemma scaled_by_first bits ratio k : forall power a, scaled_by bits ratio power (firstn k a) = firstn k (scaled_by bits ratio power a).
Proof. induction k as [| k IH]; intros power [| x a]; [easy .. |]. cbn [firstn scaled_by]. now rewrite IH. Qed.
Lemma scale_first bits ratio k a : scale bits ratio (firstn k a) = firstn k (scale bits ratio a).
Proof. destruct k as [| k], a as [| x a]; try easy. cbn [firstn scale]. now rewrite scaled_by_first. Qed.
Lemma scaled_by_length bits ratio a : forall power, length (scaled_by bits ratio power a) = length a.
Proof. induction a; intros; simpl; auto. Qed.

Theorem taylor_right p low width bits : p <> [] -> (0 < fst low)%Z -> (0 < fst width)%Z -> (0 <= bits)%Z ->
  local_form (map IZR p) (value low) (value width) (length p - 1) (fst (taylor p low width bits)) (snd (taylor p low width bits)).
Proof.
  intros Np Pl Pw Pb. unfold taylor. cbn [fst snd]. set (n := Z.of_nat (length p)). set (count := count_bits p).
  set (ratio := (number_log2 width - number_log2 low + 1)%Z). set (lost := error_bits n count ratio). set (precision := (bits + lost)%Z).
  set (kept := Z.to_nat (kept_terms n precision count ratio)). set (digits := (precision + count + 3)%Z).
  assert (N1 : (1 <= length p)%nat) by (destruct p; [easy | simpl; lia]).
  destruct (count_enough p Np) as (C1 & C). fold count in C1, C.
  pose proof (value_positive low Pl) as Vl. pose proof (value_positive width Pw) as Vw. set (rho := value width / value low).
  assert (Rho : 0 < rho <= pow2 ratio).
  { split; [apply Rmult_lt_0_compat; [easy | now apply Rinv_0_lt_compat] |]. apply Rmult_le_reg_r with (value low); auto.
    unfold rho, Rdiv. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra. unfold value, ratio, number_log2.
    destruct (log2_size _ Pl) as (Lb & _). destruct (log2_size _ Pw) as (_ & Wb). pose proof (bpow_gt_0 radix2 (snd low)) as Q.
    apply Rle_trans with (pow2 (Z.log2 (fst width) + snd width - (Z.log2 (fst low) + snd low) + 1) * (pow2 (Z.log2 (fst low)) * pow2 (snd low))).
    - rewrite !pow2_shifted. replace (Z.log2 (fst width) + snd width - (Z.log2 (fst low) + snd low) + 1 + (Z.log2 (fst low) + snd low))%Z
        with (1 + Z.log2 (fst width) + snd width)%Z by ring. rewrite !bpow_plus. simpl (pow2 1). apply Rmult_le_compat_r; [apply bpow_ge_0 | lra].
    - apply Rmult_le_compat_l; [apply bpow_ge_0 |]. apply Rmult_le_compat_r; lra. }
  pose proof (fun j => error_bits_right (length p) ratio rho j N1 Rho) as Lost. fold n in Lost. change (bits_of n) with count in Lost. fold lost in Lost.
  set (G := pow2 lost) in *. destruct (Lost 0%nat) as (_ & L1).
  assert (G2 : 2 <= G) by (unfold G; change 2 with (pow2 1); apply bpow_le; lia).
  assert (Pp : (0 < precision)%Z) by (unfold precision; lia).
  destruct (terms_right precision low p Np Pl Pp) as (unit & F). fold count in F. set (t := terms precision count low p) in *.
  set (T := times_powers (value low) (pow2 unit) (map IZR p)) in *.
  assert (Lt : length T = length p) by (unfold T; now rewrite times_powers_length, map_length).
  assert (Rows : rows_near 3 t T (repeat 1%Z (length p)) /\ rows_near (pow2 precision) t (repeat 0 (length p)) (repeat 1%Z (length p))).
  { rewrite <- Lt. clear - F. induction F as [| x y t T (A & B) F (I & J)]; cbn [length repeat]; split; constructor; auto; [lra |].
    rewrite Rminus_0_r. lra. }
  destruct Rows as (Rows & Sizes). apply (shifted_near _ (length p)) in Rows, Sizes. rewrite shifted_zeros in Sizes.
  rewrite <- column_0 in Rows, Sizes. set (H := shifted_cut (length p) 1 0 t) in *. set (A := shifted (length p) 1 T) in *.
  set (M := shifted_cut (length p) 1 0 (column 0 (length p))) in *.
  assert (Margins : forall j, nth j M 0%Z = choose (length p) (S j)).
  { intros j. unfold M. rewrite shifted_column by lia. now rewrite Nat.add_0_r. }
  destruct (rows_index _ _ _ _ Rows) as (Near & La & Lm). destruct (rows_index _ _ _ _ Sizes) as (Size & Lh & _). rewrite repeat_length in Lh.
  assert (Big : forall j, IZR (nth j M 0%Z) * rho ^ j <= G) by (intros j; rewrite Margins; apply Lost).
  destruct (quotient_right digits low width Pl Pw ltac:(unfold digits; lia)) as (Pq & Bq). fold rho in Bq. set (q := quotient_of digits low width) in *.
  assert (Whole : forall i, (i < length p)%nat -> Rabs (IZR (nth i (scale digits q H) 0%Z) - nth i (times_powers rho 1 A) 0) <= 4 * G).
  { assert (Sized : Forall2 (sized (pow2 precision)) H M).
    { assert (G' : forall h ms, length h = length ms -> (forall j, Rabs (IZR (nth j h 0%Z)) <= pow2 precision * IZR (nth j ms 0%Z)) ->
        (forall j, (0 <= nth j ms 0)%Z) -> Forall2 (sized (pow2 precision)) h ms).
      { clear. induction h as [| x h IH]; intros [| m ms] L S P; try discriminate; constructor.
        - split; [apply (S 0%nat) | apply (P 0%nat)].
        - apply IH; [now injection L | intros j; apply (S (Datatypes.S j)) | intros j; apply (P (Datatypes.S j))]. }
      apply G'; [easy | | intros j; rewrite Margins; apply choose_nonnegative]. intros j. specialize (Size j).
      now rewrite nth_repeat, Rminus_0_r in Size. }
    clearbody H A M. destruct Rows as [| x y m h k ms Hx Rows]; [intros i I; simpl in Lh; lia |].
    inversion_clear Sized as [| ? ? ? ? S0 S'].
    assert (Tail : Forall2 (fun x y => Rabs (IZR x - y) <= 7 / 2 * G + 1) (scaled_by digits q q h) (times_powers rho (1 * rho) k)).
    { apply scaled_by_right with (bits := precision) (ms := ms) (n := 1); try lra; auto.
      - unfold digits. lia.
      - change 1 with (pow2 0). apply bpow_le. unfold digits. lia.
      - now rewrite Rmult_1_l.
      - simpl in Lh. assert (E : 1 + 2 * INR (length h) <= 2 * pow2 count) by (rewrite <- Lh, S_INR in C; lra).
        rewrite Rmult_assoc, pow2_shifted. replace (1 - digits + precision)%Z with (- (count + 2))%Z by (unfold digits; ring).
        apply Rle_trans with (2 * pow2 count * pow2 (- (count + 2))); [apply Rmult_le_compat_r; [apply bpow_ge_0 | easy] |].
        rewrite Rmult_assoc, pow2_shifted. replace (count + - (count + 2))%Z with (- 2)%Z by ring. simpl. lra.
      - intros j. specialize (Big (S j)). cbn [nth pow] in Big. now rewrite Rmult_1_l. }
    intros [| i] I; cbn [scale times_powers nth].
    - specialize (Big 0%nat). cbn [nth pow] in Big. rewrite Rmult_1_r in *. lra.
    - assert (Each : forall a b, Forall2 (fun x y => Rabs (IZR x - y) <= 7 / 2 * G + 1) a b -> Rabs (IZR (nth i a 0%Z) - nth i b 0) <= 7 / 2 * G + 1).
      { clear - G2. intros a b F. revert i. induction F as [| u v a b U F IH]; intros [| i]; simpl; auto; rewrite Rminus_0_r, Rabs_R0; lra. }
      specialize (Each _ _ Tail). lra. }
  assert (Kept : (1 <= kept <= length p)%nat /\ (forall i, (kept <= i < length p)%nat -> Rabs (nth i (times_powers rho 1 A) 0) <= 4 * G)).
  { unfold kept, kept_terms. destruct (Z.leb_spec (- (ratio + count)) 0) as [D | D]; [split; [unfold n; lia | intros i I; unfold n in I; lia] |].
    set (falling := (- (ratio + count))%Z) in *. pose proof (Z.div_pos (precision + count) falling ltac:(lia) D) as Q.
    split; [unfold n; lia |]. intros i I.
    assert (Fi : (precision + count <= falling * Z.of_nat i)%Z).
    { pose proof (Z.mul_succ_div_gt (precision + count) falling D). unfold n in I. nia. }
    rewrite times_powers_index, Rmult_1_l, Rabs_mult, (Rabs_pos_eq (rho ^ i)) by (apply pow_le; lra).
    specialize (Near i). specialize (Size i). rewrite nth_repeat, Rminus_0_r in Size. rewrite Margins in Near, Size.
    pose proof (IZR_le _ _ (choose_nonnegative (length p) (S i))) as Pc. set (c := IZR (choose (length p) (S i))) in *.
    assert (Ai : Rabs (nth i A 0) <= (3 + pow2 precision) * c).
    { replace (nth i A 0) with (IZR (nth i H 0%Z) + - (IZR (nth i H 0%Z) - nth i A 0)) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra. }
    assert (P1 : 1 <= pow2 precision) by (change 1 with (pow2 0); apply bpow_le; lia).
    assert (Pi : 0 <= rho ^ i) by (apply pow_le; lra).
    assert (Ci : c * rho ^ i <= pow2 (- precision)).
    { apply Rle_trans with (pow2 (count * Z.of_nat (S i)) * pow2 (ratio * Z.of_nat i)).
      - apply Rmult_le_compat; auto.
        + apply Rle_trans with (INR (length p) ^ S i).
          * unfold c. rewrite INR_IZR_INZ, pow_IZR. apply IZR_le, choose_count.
          * rewrite <- pow2_power. apply pow_incr. split; [apply pos_INR | easy].
        + rewrite <- pow2_power. apply pow_incr. lra.
      - rewrite pow2_shifted. apply bpow_le. unfold falling in Fi. nia. }
    assert (Rabs (nth i A 0) * rho ^ i <= (3 + pow2 precision) * c * rho ^ i) by (apply Rmult_le_compat_r; easy).
    assert ((3 + pow2 precision) * (c * rho ^ i) <= 4 * pow2 precision * pow2 (- precision)).
    { apply Rmult_le_compat; try lra. now apply Rmult_le_pos. }
    rewrite Rmult_assoc, pow2_shifted in *. replace (precision + - precision)%Z with 0%Z in * by ring. simpl (pow2 0) in *. lra. }
  destruct Kept as ((K1 & Kn) & Rest).
  assert (First : scale digits q (firstn kept (shifted_cut kept 1 0 t)) = firstn kept (scale digits q H)).
  { unfold H. rewrite (first_passes kept (length p)) by easy. apply scale_first. }
  assert (Ls : length (scale digits q H) = length p).
  { rewrite <- Lh. destruct H; simpl; auto. now rewrite scaled_by_length. }
  rewrite First. split; [intros E; apply (f_equal (@length Z)) in E; rewrite firstn_length, Ls in E; simpl in E; lia |].
  destruct (shifted_value 1 (length p) T ltac:(lia)) as (_ & Vs). fold A in Vs.
  exists (times_powers rho 1 A), (pow2 unit). rewrite times_powers_length. repeat split.
  - rewrite <- La, Lh. lia.
  - apply bpow_gt_0.
  - intros u. rewrite times_powers_value, Vs. unfold T. rewrite times_powers_value.
    replace (value low * (1 + rho * u)) with (value low + value width * u) by (unfold rho; field; lra). ring.
  - rewrite mult_IZR, pow2_integer by lia. fold G. apply near_index. rewrite firstn_length, Ls, times_powers_length, <- La, Lh.
    split; [lia |]. intros i I. destruct (Nat.lt_ge_cases i kept) as [B | B].
    + rewrite <- (firstn_skipn kept (scale digits q H)) in Whole. specialize (Whole i I).
      rewrite app_nth1 in Whole by (rewrite firstn_length; lia). exact Whole.
    + rewrite nth_overflow by (rewrite firstn_length; lia). unfold Rminus. rewrite Rplus_0_l, Rabs_Ropp. now apply Rest.
Qed.
