(** Bound rule `relative` (include/errbound/rules/relative.hpp) over IEEE formats (Ieee.v), to nearest, including
    overflow: the functions of RelativeCode.v. Numbers have p >= 4 digits, emax > p. Counts have q digits, q >= p, q
    >= 24, qmax >= emax, qmax >= 5q + 3: double in the code, up to 53 digits and emax 1024
    (relative_keeps_operations_doubles). A number is known by a value and a nonnegative count if the count is
    infinite, or the value finite and `holds` of Relative.v. Steps that cannot overflow are proved forwards; after
    others, a finite result implies finite operands. Results:
        relative_exact_known, relative_within_known, relative_negate_known, relative_add_known,
            relative_subtract_known,
        relative_multiply_known, relative_divide_known, relative_scale_known   the count that the code returns holds
        relative_error_known, relative_sign_known   a finite error bounds |v - x|; the sign is right or uncertain
        relative_promises, relative_keeps_operations, relative_dot_known   functions (IeeeFunctions.v,
            IeeeCompound.v), and
            dot products by the rule's dot_bound *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool List.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code CompoundCode RelativeCode Ieee IeeeRules IeeeFunctions IeeeCompound DotProduct.
From Errbound Require Format ErrorFree Upper IeeeInterval Relative.
Import ListNotations.
Open Scope R_scope.

(** Facts about one format. *)
Section Format.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_3 : (3 <= p)%Z).
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation number := (Format.number p emin).
Notation nonnegative := (nonnegative p emax).

Lemma less_finite_left x y : nonnegative x -> less _ F x y = true -> finite x.
Proof. destruct x as [| s | |]; try easy. cbn [Ieee.nonnegative]. intros ->. now destruct y as [| [|] | | [|]]. Qed.
Lemma upper_finite x : finite (upper _ F x) -> finite x /\ B2R (upper _ F x) = Upper.upper p emin (B2R x).
Proof.
  unfold upper, Upper.upper. intros H. apply times_finite in H. destruct H as (X & H & ->).
  apply plus_finite in H. destruct H as (_ & _ & ->). split; auto.
  now rewrite (proj2 (integer_value p emax p_3 1 ltac:(lia))), (proj2 (eps_value p emax p_3)).
Qed.
Lemma nonnegative_upper x : nonnegative x -> nonnegative (upper _ F x).
Proof. intros. unfold upper. positive. Qed.

(** A number of at most the size of a number of the format does not overflow. *)
Definition fitting (y : R) : Prop := number y /\ y < bpow radix2 emax.
Lemma fitting_power e : (emin <= e < emax)%Z -> fitting (bpow radix2 e).
Proof. intros H. split; [apply Format.number_power; auto; lia | apply bpow_lt; lia]. Qed.
Lemma fitting_value (x : float) : fitting (Rabs (B2R x)).
Proof. split; [apply Format.number_abs, number_B2R | apply abs_B2R_lt_emax]. Qed.
Lemma rounded_fits z y : fitting y -> Rabs z <= y -> Rabs (fl z) < bpow radix2 emax.
Proof.
  intros [N L] H. apply Rle_lt_trans with (2 := L). now apply (Format.rnd_abs_below p emin Format.nearest).
Qed.
Lemma plus_fits x y t : finite x -> finite y -> fitting t -> Rabs (B2R x + B2R y) <= t ->
  finite (x ⊕ y) /\ B2R (x ⊕ y) = fl (B2R x + B2R y).
Proof.
  intros X Y T H. generalize (Bplus_correct p emax _ _ mode_NE x y X Y).
  rewrite Rlt_bool_true; [now intros (E & G & _) | exact (rounded_fits _ t T H)].
Qed.
Lemma minus_fits x y t : finite x -> finite y -> fitting t -> Rabs (B2R x - B2R y) <= t ->
  finite (x ⊖ y) /\ B2R (x ⊖ y) = fl (B2R x - B2R y).
Proof.
  intros X Y T H. generalize (Bminus_correct p emax _ _ mode_NE x y X Y).
  rewrite Rlt_bool_true; [now intros (E & G & _) | exact (rounded_fits _ t T H)].
Qed.
Lemma times_fits x y t : finite x -> finite y -> fitting t -> Rabs (B2R x * B2R y) <= t ->
  finite (x ⊗ y) /\ B2R (x ⊗ y) = fl (B2R x * B2R y).
Proof.
  intros X Y T H. generalize (Bmult_correct p emax _ _ mode_NE x y).
  rewrite Rlt_bool_true; [| exact (rounded_fits _ t T H)]. intros (E & G & _). rewrite X, Y in G. now split.
Qed.
Lemma over_fits x y t : finite x -> B2R y <> 0 -> fitting t -> Rabs (B2R x / B2R y) <= t ->
  finite (x ⊘ y) /\ B2R (x ⊘ y) = fl (B2R x / B2R y).
Proof.
  intros X N T H. generalize (Bdiv_correct p emax _ _ mode_NE x y N).
  rewrite Rlt_bool_true; [| exact (rounded_fits _ t T H)]. intros (E & G & _). rewrite X in G. now split.
Qed.

(** Neither negative nor NaN, but possibly infinite. *)
Definition is_count (k : float) : Prop := nonnegative k /\ BinarySingleNaN.is_nan k = false.
Lemma finite_no_nan (x : float) : finite x -> BinarySingleNaN.is_nan x = false.
Proof. now destruct x. Qed.
Lemma count_intro x : finite x -> 0 <= B2R x -> is_count x.
Proof. intros X P. split; [now apply nonnegative_intro | now apply finite_no_nan]. Qed.
Lemma infinite_count : is_count (infinity _ F).
Proof. now split. Qed.
Lemma integer_count n : (0 <= n <= 8)%Z -> is_count (integer _ F n).
Proof.
  intros H. destruct (integer_value p emax p_3 n ltac:(lia)) as [N V]. apply count_intro; auto.
  rewrite V. apply IZR_le. lia.
Qed.
Lemma count_cases k : is_count k -> finite k \/ k = B754_infinity false.
Proof. intros [P N]. destruct k as [| s | |]; try discriminate; auto. cbn in P. subst s. now right. Qed.
Lemma overflow_no_nan (x : float) s : B2SF x = binary_overflow p emax mode_NE s -> BinarySingleNaN.is_nan x = false.
Proof. now destruct x. Qed.
Lemma count_plus j k : is_count j -> is_count k -> is_count (j ⊕ k).
Proof.
  intros J K. split; [apply nonnegative_plus; [apply J | apply K] |].
  destruct (count_cases j J) as [FJ | ->]; [| now destruct (count_cases k K) as [FK | ->]; [destruct k |]].
  destruct (count_cases k K) as [FK | ->]; [| now destruct j].
  generalize (Bplus_correct p emax _ _ mode_NE j k FJ FK). case Rlt_bool.
  - intros (_ & H & _). now apply finite_no_nan.
  - intros [H _]. now apply overflow_no_nan in H.
Qed.
Lemma count_times j c : is_count j -> finite c -> 0 < B2R c -> is_count (j ⊗ c).
Proof.
  intros J FC PC. assert (NC : nonnegative c) by (apply nonnegative_intro; auto; lra).
  split; [apply nonnegative_times; [apply J | exact NC] |].
  destruct (count_cases j J) as [FJ | ->].
  - generalize (Bmult_correct p emax _ _ mode_NE j c). case Rlt_bool.
    + intros (_ & H & _). rewrite FJ, FC in H. now apply finite_no_nan.
    + intros H. now apply overflow_no_nan in H.
  - destruct c as [| | |]; try easy. cbn in PC. lra.
Qed.
Lemma count_upper k : is_count k -> is_count (upper _ F k).
Proof.
  intros K. unfold upper. destruct (integer_value p emax p_3 1 ltac:(lia)) as [F1 V1].
  destruct (eps_value p emax p_3) as [FE VE]. generalize (p_emax p emax) (Format.eps_positive p). intros L EP.
  assert (E1 : Format.eps p <= 1) by (change 1 with (bpow radix2 0); apply bpow_le; lia).
  destruct (plus_fits (integer _ F 1) (epsilon _ F) (bpow radix2 1)) as [FS VS]; auto.
  - apply fitting_power. lia.
  - rewrite V1, VE, Rabs_pos_eq by lra. simpl. lra.
  - apply count_times; auto. rewrite VS, V1, VE. apply Rlt_le_trans with 1; [lra |].
    apply (Format.rnd_above p emin Format.nearest); [| lra].
    change 1 with (bpow radix2 0). apply Format.number_power; auto. lia.
Qed.
Lemma minus_is_plus x y : x ⊖ y = x ⊕ opposite _ F y.
Proof. destruct x, y; reflexivity. Qed.

End Format.

(** Conversion to another format, rounded to nearest. *)
Section Conversion.

Context (p emax q qmax : Z) {q_positive : Prec_gt_0 q} {q_below : Prec_lt_emax q qmax}.
Notation emin := (3 - emax - p)%Z.
Notation qmin := (3 - qmax - q)%Z.
Notation dl := (Format.rnd q qmin Format.nearest).

Definition converted (x : binary_float p emax) : binary_float q qmax :=
  match x with
  | B754_zero s => B754_zero s
  | B754_infinity s => B754_infinity s
  | B754_nan => B754_nan
  | B754_finite s m e _ => binary_normalize q qmax q_positive q_below mode_NE (cond_Zopp s (Zpos m)) e s
  end.

Lemma converted_correct x : finite x ->
  if Rlt_bool (Rabs (dl (B2R x))) (bpow radix2 qmax)
  then finite (converted x) /\ B2R (converted x) = dl (B2R x)
  else B2SF (converted x) = binary_overflow q qmax mode_NE (Rlt_bool (B2R x) 0).
Proof.
  destruct x as [s | | | s m e b]; try easy; intros _; cbn [converted B2R].
  - rewrite Format.rnd_0, Rabs_R0, Rlt_bool_true by (auto with typeclass_instances; apply bpow_gt_0). auto.
  - generalize (binary_normalize_correct q qmax _ _ mode_NE (cond_Zopp s (Zpos m)) e s). cbv zeta.
    change (round radix2 (SpecFloat.fexp q qmax) (round_mode mode_NE)) with dl. case Rlt_bool; tauto.
Qed.
Lemma converted_finite x : finite (converted x) -> finite x /\ B2R (converted x) = dl (B2R x).
Proof.
  intros H. assert (X : finite x) by now destruct x. split; auto. generalize (converted_correct x X).
  case Rlt_bool; [tauto |]. intros O. exfalso. revert H O. now destruct (converted x).
Qed.
Lemma converted_exact x : finite x -> Format.number q qmin (B2R x) -> Rabs (B2R x) < bpow radix2 qmax ->
  finite (converted x) /\ B2R (converted x) = B2R x.
Proof.
  intros X N L. generalize (converted_correct x X). rewrite (Format.rnd_exact q qmin Format.nearest) by exact N.
  now rewrite Rlt_bool_true.
Qed.
Lemma converted_nonnegative x : nonnegative p emax x -> nonnegative q qmax (converted x).
Proof.
  intros P. destruct (BinarySingleNaN.is_finite x) eqn:X; [| now destruct x].
  generalize (converted_correct x X) (nonnegative_value p emax x P). intros H V. revert H. case Rlt_bool.
  - intros [FC E]. apply nonnegative_intro; auto. rewrite E. now apply (Format.rnd_nonnegative q qmin Format.nearest).
  - intros O. apply (nonnegative_overflow _ _ _ _ O). now apply Rlt_bool_false.
Qed.

End Conversion.

Section Rule.

Context (p emax q qmax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} {q_positive : Prec_gt_0 q}
  {q_below : Prec_lt_emax q qmax} (p_q : (4 <= p <= q)%Z) (q_24 : (24 <= q)%Z) (emax_qmax : (emax <= qmax)%Z)
  (q_qmax : (5 * q + 3 <= qmax)%Z).
Variable fused : bool.  (* has_fast_fma *)
Notation float := (binary_float p emax).
Notation double := (binary_float q qmax).
Notation F := (floats p emax).
Notation C := (floats q qmax).
Notation emin := (3 - emax - p)%Z.
Notation qmin := (3 - qmax - q)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation dl := (Format.rnd q qmin Format.nearest).
Notation number := (Format.number p emin).
Notation is_count := (is_count q qmax).
Notation to_count := (converted p emax q qmax).
Notation from_count := (converted q qmax p emax).
Notation holds := (Relative.holds p emin q qmin).

Lemma p_3 : (3 <= p)%Z. Proof. lia. Qed.
Lemma q_3 : (3 <= q)%Z. Proof. lia. Qed.
Lemma emin_p : (emin <= - p - 1)%Z. Proof. generalize (p_emax p emax). lia. Qed.
Lemma qmin_q : (qmin <= - 6 * q)%Z. Proof. lia. Qed.

Lemma to_count_exact x : finite x -> finite (to_count x) /\ B2R (to_count x) = B2R x.
Proof.
  intros X. apply converted_exact; auto.
  - apply generic_inclusion_mag with (2 := number_B2R p emax x). intros _. unfold FLT_exp. lia.
  - apply Rlt_le_trans with (1 := abs_B2R_lt_emax p emax x). apply bpow_le. lia.
Qed.

(** Arithmetic of counts. *)
Notation u := (u_of_counts _ _ F to_count).
Notation up := (Format.u p).
Notation fits := (fitting q qmax).
Infix "+#" := (plus double C) (at level 50, left associativity).
Infix "-#" := (minus double C) (at level 50, left associativity).
Infix "*#" := (times double C) (at level 40, left associativity).
Infix "/#" := (over double C) (at level 40, left associativity).
Notation count n := (integer double C n).

Lemma u_of_counts_value : finite u /\ B2R u = up.
Proof.
  destruct (u_value p emax p_3) as [U V]. unfold u_of_counts. rewrite <- V. now apply to_count_exact.
Qed.
Lemma count_value n : (Z.abs n <= 8)%Z -> finite (count n) /\ B2R (count n) = IZR n.
Proof. apply (integer_value q qmax q_3). Qed.
Lemma fits_power e : (- q - q - 10 <= e <= q + q + 10)%Z -> fits (bpow radix2 e).
Proof. intros H. apply fitting_power; auto using q_3. lia. Qed.
Lemma double_power e : (- q - q - 10 <= e <= q + q + 10)%Z -> Format.number q qmin (bpow radix2 e).
Proof. intros H. apply (fits_power e H). Qed.
Lemma double_integer n : (Z.abs n <= 16)%Z -> Format.number q qmin (IZR n).
Proof. apply Relative.number_small; auto using qmin_q. Qed.
(** Between numbers, and rounded. *)
Lemma between a b x : Format.number q qmin a -> Format.number q qmin b -> a <= x <= b -> a <= dl x <= b.
Proof.
  intros A B [H1 H2]. split.
  - now apply (Format.rnd_above q qmin Format.nearest).
  - now apply (Format.rnd_below q qmin Format.nearest).
Qed.
Ltac small_double := first [apply double_integer; simpl; lia | apply number_B2R].

Lemma slack_value : finite (slack _ C) /\ B2R (slack _ C) = Relative.slack q qmin.
Proof.
  destruct (count_value 1 ltac:(lia)) as [F1 V1], (count_value 8 ltac:(lia)) as [F8 V8],
    (eps_value q qmax q_3) as [FE VE].
  assert (S := Relative.slack_is q qmin q_24 qmin_q). assert (V := Relative.v_small q q_24).
  assert (E2 := Format.eps_2u q).
  unfold slack. destruct (times_fits q qmax (count 8) (epsilon _ C) (bpow radix2 0)) as [FT VT]; auto.
  - apply fits_power. lia.
  - change (bpow radix2 0) with 1. rewrite V8, VE, Rabs_pos_eq; lra.
  - rewrite V8, VE in VT.
    destruct (plus_fits q qmax (count 1) (count 8 *# epsilon _ C) (bpow radix2 1)) as [FS VS]; auto.
    + apply fits_power. lia.
    + rewrite V1, VT. destruct (between 0 1 (8 * Format.eps q)); [small_double | small_double | lra |].
      change (bpow radix2 1) with 2. rewrite Rabs_pos_eq; lra.
    + split; auto. rewrite VS, V1, VT. reflexivity.
Qed.
Lemma slack_bounds : 1 <= Relative.slack q qmin <= 2.
Proof. rewrite (Relative.slack_is q qmin q_24 qmin_q). generalize (Relative.v_small q q_24). lra. Qed.

(** Forwards: if the exact value of a step is between 0 and 2^e, the result is finite and known. *)
Lemma forward_times x y e : finite x -> finite y -> (- q - q - 10 <= e <= q + q + 10)%Z ->
  0 <= B2R x * B2R y <= bpow radix2 e ->
  finite (x *# y) /\ B2R (x *# y) = dl (B2R x * B2R y) /\ 0 <= B2R (x *# y) <= bpow radix2 e.
Proof.
  intros X Y E H. destruct (times_fits q qmax x y (bpow radix2 e)) as [G V]; auto using fits_power.
  - rewrite Rabs_pos_eq; lra.
  - split; auto. split; auto. rewrite V. apply between; auto using double_power. apply Format.number_0.
Qed.
Lemma forward_over x y e : finite x -> B2R y <> 0 -> (- q - q - 10 <= e <= q + q + 10)%Z ->
  0 <= B2R x / B2R y <= bpow radix2 e ->
  finite (x /# y) /\ B2R (x /# y) = dl (B2R x / B2R y) /\ 0 <= B2R (x /# y) <= bpow radix2 e.
Proof.
  intros X Y E H. destruct (over_fits q qmax x y (bpow radix2 e)) as [G V]; auto using fits_power.
  - rewrite Rabs_pos_eq; lra.
  - split; auto. split; auto. rewrite V. apply between; auto using double_power. apply Format.number_0.
Qed.
Lemma forward_minus x y e : finite x -> finite y -> (- q - q - 10 <= e <= q + q + 10)%Z ->
  0 <= B2R x - B2R y <= bpow radix2 e ->
  finite (x -# y) /\ B2R (x -# y) = dl (B2R x - B2R y) /\ 0 <= B2R (x -# y) <= bpow radix2 e.
Proof.
  intros X Y E H. destruct (minus_fits q qmax x y (bpow radix2 e)) as [G V]; auto using fits_power.
  - rewrite Rabs_pos_eq; lra.
  - split; auto. split; auto. rewrite V. apply between; auto using double_power. apply Format.number_0.
Qed.
Lemma quotient_between x y e f : 0 <= x <= bpow radix2 e -> bpow radix2 f <= y -> 0 <= x / y <= bpow radix2 (e - f).
Proof.
  intros X Y. generalize (bpow_gt_0 radix2 f). intros P. split.
  - apply Rmult_le_pos; [lra |]. apply Rlt_le, Rinv_0_lt_compat. lra.
  - apply Rmult_le_reg_r with y; [lra |]. replace (x / y * y) with x by (field; lra).
    apply Rle_trans with (bpow radix2 (e - f) * bpow radix2 f).
    + rewrite <- bpow_plus. replace (e - f + f)%Z with e by lia. lra.
    + apply Rmult_le_compat_l; [apply bpow_ge_0 | exact Y].
Qed.
Lemma product_between x y e f : 0 <= x <= bpow radix2 e -> 0 <= y <= bpow radix2 f -> 0 <= x * y <= bpow radix2 (e + f).
Proof.
  intros X Y. rewrite bpow_plus. split; [apply Rmult_le_pos; lra | apply Rmult_le_compat; lra].
Qed.
Lemma up_bounds : bpow radix2 (- q) <= up <= / 16.
Proof. exact (Relative.u_bounds q p p_q). Qed.
Lemma up_1 : 0 <= up <= bpow radix2 0.
Proof. generalize up_bounds (bpow_gt_0 radix2 (- q)). simpl (bpow radix2 0). lra. Qed.
Lemma slack_2 : 0 <= B2R (slack _ C) <= bpow radix2 1.
Proof. rewrite (proj2 slack_value). generalize slack_bounds. simpl (bpow radix2 1). lra. Qed.

Lemma of_one_factor_value : finite (of_one_factor _ C u) /\
  B2R (of_one_factor _ C u) = Relative.of_one_factor q qmin p /\
  0 <= B2R (of_one_factor _ C u) <= bpow radix2 2.
Proof.
  destruct u_of_counts_value as [FU VU], slack_value as [FS VS], (count_value 1 ltac:(lia)) as [F1 V1],
    (count_value 2 ltac:(lia)) as [F2 V2].
  generalize up_bounds up_1 (bpow_gt_0 radix2 (- q)) slack_2. intros B B1 P S2. unfold of_one_factor.
  destruct (forward_over u (count 2) 0) as (G1 & E1 & R1);
    [auto | rewrite V2; lra | lia | rewrite VU, V2; simpl; lra |].
  set (x1 := u /# count 2) in *.
  destruct (forward_minus (count 1) x1 0) as (G2 & E2 & R2); [auto | auto | lia | rewrite V1; simpl in *; lra |].
  set (x2 := count 1 -# x1) in *.
  destruct (forward_times u x2 0) as (G3 & E3 & R3); [auto | auto | lia | |].
  { rewrite VU. now apply (product_between _ _ 0 0). }
  set (x3 := u *# x2) in *.
  destruct (forward_minus (count 1) u 0) as (G4 & E4 & _); [auto | auto | lia | rewrite V1, VU; simpl; lra |].
  assert (R4 : bpow radix2 (-1) <= B2R (count 1 -# u)).
  { rewrite E4, V1, VU. apply (Format.rnd_above q qmin Format.nearest); [apply double_power; lia | simpl; lra]. }
  set (x4 := count 1 -# u) in *.
  destruct (forward_over x3 x4 1) as (G5 & E5 & R5); [auto | simpl in R4; lra | lia | |].
  { now apply (quotient_between _ _ 0 (-1)). }
  set (x5 := x3 /# x4) in *.
  destruct (forward_times x5 (slack _ C) 2) as (G6 & E6 & R6);
    [auto | auto | lia | now apply (product_between _ _ 1 1) |].
  split; [exact G6 |]. split; [| exact R6].
  unfold Relative.of_one_factor. rewrite E6, E5, E4, E3, E2, E1, V1, V2, VU, VS. reflexivity.
Qed.

Lemma count_of_share_value r : finite r -> 0 <= B2R r < 1 ->
  finite (count_of_share _ C u r) /\ B2R (count_of_share _ C u r) = Relative.count_of_share q qmin p (B2R r).
Proof.
  intros FR HR. assert (HR' := Relative.below_1 q qmin q_24 qmin_q (B2R r) (number_B2R _ _ r) (proj2 HR)).
  destruct u_of_counts_value as [FU VU], slack_value as [FS VS], (count_value 1 ltac:(lia)) as [F1 V1],
    (count_value 2 ltac:(lia)) as [F2 V2], (count_value 3 ltac:(lia)) as [F3 V3], (count_value 5 ltac:(lia)) as [F5 V5],
    (count_value 6 ltac:(lia)) as [F6 V6].
  generalize up_bounds up_1 (bpow_gt_0 radix2 (- q)) slack_2. intros B B1 P S2. unfold count_of_share.
  assert (R0 : 0 <= B2R r <= bpow radix2 0) by (simpl; lra).
  destruct (forward_times (count 5) r 3) as (G1 & E1 & _); [auto | auto | lia | rewrite V5; simpl; lra |].
  assert (R1 : 0 <= B2R (count 5 *# r) <= 5).
  { rewrite E1, V5. apply between; [apply Format.number_0 | apply double_integer; simpl; lia | lra]. }
  set (x1 := count 5 *# r) in *.
  destruct (forward_minus (count 6) x1 3) as (G2 & E2 & R2); [auto | auto | lia | rewrite V6; simpl in *; lra |].
  set (x2 := count 6 -# x1) in *.
  destruct (forward_times r x2 3) as (G3 & E3 & R3); [auto | auto | lia | now apply (product_between _ _ 0 3) |].
  set (x3 := r *# x2) in *.
  destruct (forward_minus (count 1) r 0) as (G4 & E4 & R4); [auto | auto | lia | rewrite V1; simpl; lra |].
  assert (L4 : bpow radix2 (- q) <= B2R (count 1 -# r)).
  { rewrite E4, V1. apply (Format.rnd_above q qmin Format.nearest); [apply double_power; lia |].
    unfold Format.u in HR'. lra. }
  set (x4 := count 1 -# r) in *.
  destruct (forward_times (count 2) x4 1) as (G5 & E5 & R5); [auto | auto | lia | rewrite V2; simpl in *; lra |].
  assert (L5 : bpow radix2 (- q) <= B2R (count 2 *# x4)).
  { rewrite E5, V2. apply (Format.rnd_above q qmin Format.nearest); [apply double_power; lia | lra]. }
  set (x5 := count 2 *# x4) in *.
  destruct (forward_minus (count 3) r 2) as (G6 & E6 & R6); [auto | auto | lia | rewrite V3; simpl; lra |].
  assert (L6 : bpow radix2 0 <= B2R (count 3 -# r)).
  { rewrite E6, V3. apply (Format.rnd_above q qmin Format.nearest); [apply double_power; lia | simpl; lra]. }
  set (x6 := count 3 -# r) in *.
  destruct (forward_times x5 x6 3) as (G7 & E7 & R7); [auto | auto | lia | now apply (product_between _ _ 1 2) |].
  assert (L7 : bpow radix2 (- q) <= B2R (x5 *# x6)).
  { rewrite E7. apply (Format.rnd_above q qmin Format.nearest); [apply double_power; lia |].
    rewrite <- (Rmult_1_r (bpow _ _)). apply Rmult_le_compat; simpl in *; lra. }
  set (x7 := x5 *# x6) in *.
  destruct (forward_times x7 u 3) as (G8 & E8 & R8);
    [auto | auto | lia | rewrite VU; now apply (product_between _ _ 3 0) |].
  assert (L8 : bpow radix2 (- q + - q) <= B2R (x7 *# u)).
  { rewrite E8, VU. apply (Format.rnd_above q qmin Format.nearest); [apply double_power; lia |].
    rewrite bpow_plus. apply Rmult_le_compat; lra. }
  set (x8 := x7 *# u) in *.
  destruct (forward_over x3 x8 (3 - (- q + - q))) as (G9 & E9 & R9);
    [auto | generalize (bpow_gt_0 radix2 (- q + - q)); lra | lia | now apply quotient_between |].
  set (x9 := x3 /# x8) in *.
  destruct (forward_times x9 (slack _ C) (3 - (- q + - q) + 1)) as (G10 & E10 & R10);
    [auto | auto | lia | now apply product_between |].
  split; [exact G10 |]. unfold Relative.count_of_share.
  rewrite E10, E9, E8, E7, E6, E5, E4, E3, E2, E1, V1, V2, V3, V5, V6, VU, VS. reflexivity.
Qed.

Lemma share_of_length_value l : finite l -> 0 <= B2R l < 7 / 4 ->
  finite (share_of_length _ C l) /\
  B2R (share_of_length _ C l) = dl (dl (B2R l / dl (1 - dl (B2R l / 2))) * Relative.slack q qmin) /\
  0 <= B2R (share_of_length _ C l).
Proof.
  intros FL HL. destruct slack_value as [FS VS], (count_value 1 ltac:(lia)) as [F1 V1],
    (count_value 2 ltac:(lia)) as [F2 V2].
  generalize slack_2. intros S2. unfold share_of_length.
  destruct (forward_over l (count 2) 0) as (G1 & E1 & _); [auto | rewrite V2; lra | lia | rewrite V2; simpl; lra |].
  assert (R1 : 0 <= B2R (l /# count 2) <= 7 * bpow radix2 (-3)).
  { rewrite E1, V2. apply between; [apply Format.number_0 | | simpl; lra].
    apply Format.number_integer; auto; [lia |].
    apply (Z.le_trans _ (2 ^ 3)); [simpl; lia | apply Z.pow_le_mono_r; lia]. }
  set (x1 := l /# count 2) in *.
  destruct (forward_minus (count 1) x1 0) as (G2 & E2 & _); [auto | auto | lia | rewrite V1; simpl in *; lra |].
  assert (R2 : bpow radix2 (-3) <= B2R (count 1 -# x1)).
  { rewrite E2, V1. apply (Format.rnd_above q qmin Format.nearest); [apply double_power; lia | simpl in *; lra]. }
  set (x2 := count 1 -# x1) in *.
  destruct (forward_over l x2 (1 - -3)) as (G3 & E3 & R3); [auto | simpl in R2; lra | lia | |].
  { apply quotient_between; [simpl; lra | exact R2]. }
  set (x3 := l /# x2) in *.
  destruct (forward_times x3 (slack _ C) (1 - -3 + 1)) as (G4 & E4 & R4);
    [auto | auto | lia | now apply product_between |].
  split; [exact G4 |]. split; [| apply R4]. rewrite E4, E3, E2, E1, V1, V2, VS. reflexivity.
Qed.

(** Sums of counts. *)
Lemma two_sum_of_counts j k : finite (j +# k) -> 0 <= B2R j -> 0 <= B2R k ->
  finite (snd (two_sum _ C j k)) /\ B2R (snd (two_sum _ C j k)) = snd (ErrorFree.two_sum q qmin (B2R j) (B2R k)).
Proof.
  intros S J K. assert (S' := plus_finite q qmax _ _ S). destruct S' as (FJ & FK & ES).
  assert (Exact := ErrorFree.two_sum_exact q qmin ltac:(lia) (B2R j) (B2R k) ltac:(lia)
                     (number_B2R _ _ j) (number_B2R _ _ k)).
  change (fst (ErrorFree.two_sum q qmin (B2R j) (B2R k))) with (dl (B2R j + B2R k)) in Exact.
  destruct (IeeeInterval.two_sum_known q qmax q_3 j k S) as [N | [FE E]]; [exfalso | split; [exact FE | lra]].
  assert (Less : forall x y, finite x -> finite y -> 0 <= B2R x -> 0 <= B2R y ->
    finite (x -# y) /\ B2R (x -# y) = dl (B2R x - B2R y)).
  { intros x y X Y PX PY.
    assert (D : finite (x -# y)) by (apply (minus_nonnegative_finite q qmax); auto; now apply nonnegative_intro).
    split; [exact D |]. now apply minus_finite in D. }
  assert (SJ : B2R j <= B2R (j +# k)).
  { rewrite ES. apply (Format.rnd_above q qmin Format.nearest); [apply number_B2R | lra]. }
  destruct (Less (j +# k) j) as [F1 E1]; auto; [lra |].
  assert (P1 : 0 <= B2R (j +# k -# j)) by (rewrite E1; apply (Format.rnd_nonnegative q qmin Format.nearest); lra).
  assert (U1 : B2R (j +# k -# j) <= B2R (j +# k)).
  { rewrite E1. apply (Format.rnd_below q qmin Format.nearest); [apply number_B2R | lra]. }
  destruct (Less (j +# k) (j +# k -# j)) as [F2 E2]; auto; [lra |].
  assert (P2 : 0 <= B2R (j +# k -# (j +# k -# j))).
  { rewrite E2. apply (Format.rnd_nonnegative q qmin Format.nearest). lra. }
  destruct (Less j (j +# k -# (j +# k -# j))) as [F3 _]; auto.
  destruct (Less k (j +# k -# j)) as [F4 _]; auto.
  revert N. unfold two_sum. cbn [snd].
  generalize (Bplus_correct q qmax _ _ mode_NE _ _ F3 F4). case Rlt_bool.
  - intros (_ & H & _) N. apply finite_no_nan in H. discriminate (eq_trans (eq_sym N) H).
  - intros [H _] N. apply overflow_no_nan in H. discriminate (eq_trans (eq_sym N) H).
Qed.
Lemma count_sum_known j k : is_count j -> is_count k -> is_count (count_sum _ C j k) /\
  (finite (count_sum _ C j k) -> finite j /\ finite k /\
   B2R (count_sum _ C j k) = Relative.count_sum q qmin (B2R j) (B2R k)).
Proof.
  intros J K. assert (S := count_plus q qmax j k J K). unfold count_sum, Relative.count_sum. cbv zeta.
  change (fst (two_sum _ C j k)) with (j +# k). split.
  - destruct (less _ C _ _); [now apply (count_upper q qmax q_3) | exact S].
  - set (e := snd (two_sum _ C j k)). intros H.
    assert (FS : finite (j +# k)) by (destruct (less _ C _ e); [now apply (upper_finite q qmax q_3) in H | exact H]).
    assert (G := plus_finite q qmax _ _ FS). destruct G as (FJ & FK & ES). split; [exact FJ |]. split; [exact FK |].
    destruct (two_sum_of_counts j k FS) as [FE EE]; [apply nonnegative_value, J | apply nonnegative_value, K |].
    destruct (zero_value q qmax q_3) as [Z0 Z]. fold e in FE, EE. revert H.
    rewrite (less_finite q qmax), Z, EE by auto.
    change (fst (ErrorFree.two_sum q qmin (B2R j) (B2R k))) with (dl (B2R j + B2R k)).
    case Rlt_bool; intros H; [| exact ES]. apply (upper_finite q qmax q_3) in H. now rewrite (proj2 H), ES.
Qed.

(** A number x is known by a value and a count. *)
Definition relative_known (v : float) (k : double) (x : R) : Prop :=
  is_count k /\ (finite k -> finite v /\ holds (B2R v) (B2R k) x).

Notation relative_exact := (relative_exact float double F C).
Notation relative_within := (relative_within float double F C to_count).
Notation relative_error := (relative_error float double F C to_count from_count).
Notation relative_sign := (relative_sign float double F C to_count from_count).
Notation relative_add := (relative_add float double F C to_count from_count).
Notation relative_subtract := (relative_subtract float double F C to_count from_count).
Notation relative_multiply := (relative_multiply float double F C fused).
Notation relative_divide := (relative_divide float double F C fused).
Notation relative_scale := (relative_scale float double F C).
Notation factors_of := (factors_of float double F C to_count).
Notation real_error := (Relative.relative_error p emin q qmin).
Notation real_factors := (Relative.factors_of p emin q qmin).
Notation of_reals theorem := (theorem p emin q qmin _ _ p_q q_24 qmin_q).
Notation of_sums theorem := (theorem p emin q qmin _ _ p_q emin_p q_24 qmin_q).

Lemma unknown_known v x : relative_known v (unknown _ C) x.
Proof. split; [apply infinite_count | discriminate]. Qed.
Lemma zero_count : is_count (count 0).
Proof. apply (integer_count q qmax q_3). lia. Qed.
Lemma one_count : is_count (count 1).
Proof. apply (integer_count q qmax q_3). lia. Qed.
Lemma value_0 : B2R (count 0) = 0.
Proof. apply (zero_value q qmax q_3). Qed.

Theorem relative_exact_known v : relative_known v (relative_exact v) (B2R v).
Proof.
  unfold RelativeCode.relative_exact. destruct (is_finite _ F v) eqn:FV; [| apply unknown_known].
  split; [apply zero_count |]. intros _. split; [now apply (IeeeInterval.is_finite_true p emax) |].
  rewrite value_0. apply Relative.relative_exact_sound, number_B2R.
Qed.
Theorem relative_negate_known v k x : relative_known v k x -> relative_known (opposite _ F v) k (- x).
Proof.
  intros [K H]. split; [exact K |]. intros FK. destruct (H FK) as [FV HV]. split; [simpl; now rewrite is_finite_Bopp |].
  rewrite opposite_value. now apply Relative.relative_negate_sound.
Qed.

(** The error. *)
Lemma count_is_zero k : is_count k -> equal _ C k (count 0) = true -> finite k /\ B2R k = 0.
Proof.
  intros K E. apply (equal_true q qmax) in E; [| apply (zero_value q qmax q_3)]. now rewrite value_0 in E.
Qed.
Lemma length_finite k : finite (length_of_count _ C u k) -> finite k /\
  B2R (length_of_count _ C u k) =
  dl (Upper.upper q qmin (dl (B2R k * Relative.of_one_factor q qmin p)) + Format.eta qmin).
Proof.
  unfold length_of_count. intros H. apply plus_finite in H. destruct H as (H & _ & ->).
  apply (upper_finite q qmax q_3) in H. destruct H as (H & ->). apply times_finite in H. destruct H as (K & _ & ->).
  split; auto. now rewrite (proj2 (eta_value q qmax q_3)), (proj1 (proj2 of_one_factor_value)).
Qed.
Lemma nonnegative_length k : is_count k -> nonnegative q qmax (length_of_count _ C u k).
Proof.
  intros [K _]. assert (Q := q_3). destruct of_one_factor_value as (FO & _ & PO & _).
  unfold length_of_count. apply nonnegative_plus; [| now apply nonnegative_eta].
  apply nonnegative_upper; auto. apply nonnegative_times; auto. now apply nonnegative_intro.
Qed.
(** 7/4 *)
Lemma limit_value : finite (count 7 /# count 4) /\ B2R (count 7 /# count 4) = 7 / 4.
Proof.
  destruct (count_value 7 ltac:(lia)) as [F7 V7], (count_value 4 ltac:(lia)) as [F4 V4].
  destruct (forward_over (count 7) (count 4) 1) as (G & E & _);
    [auto | rewrite V4; lra | lia | rewrite V7, V4; simpl; lra |].
  split; [exact G |]. rewrite E, V7, V4. apply (Format.rnd_exact q qmin Format.nearest).
  replace (7 / 4) with (7 * bpow radix2 (-2)) by (simpl; lra).
  apply Format.number_integer; auto; [lia |].
  apply (Z.le_trans _ (2 ^ 3)); [simpl; lia | apply Z.pow_le_mono_r; lia].
Qed.
Lemma error_nonnegative v k : is_count k -> nonnegative p emax (relative_error v k).
Proof.
  intros K. assert (P := p_3). unfold RelativeCode.relative_error. cbv zeta.
  destruct (equal _ C k (count 0)) eqn:E; [now apply nonnegative_integer |].
  destruct (less _ C (length_of_count _ C u k) (count 7 /# count 4)) eqn:L; cbn [negb]; [| reflexivity].
  assert (N := nonnegative_length k K). assert (FL := less_finite_left q qmax _ _ N L).
  destruct limit_value as [F7 V7]. rewrite (less_finite q qmax), V7 in L by auto. revert L.
  case Rlt_bool_spec; [| discriminate]. intros L _. apply nonnegative_value in N.
  destruct (share_of_length_value _ FL (conj N L)) as (FS & _ & PS).
  assert (NS : nonnegative p emax (from_count (share_of_length _ C (length_of_count _ C u k)))).
  { apply converted_nonnegative. now apply nonnegative_intro. }
  apply nonnegative_plus; [| now apply nonnegative_eta]. apply nonnegative_upper; auto.
  apply nonnegative_times; [now apply nonnegative_abs |].
  destruct (less _ C _ _); auto. apply nonnegative_plus; [| now apply nonnegative_eta]. now apply nonnegative_upper.
Qed.
Lemma error_finite v k : is_count k -> finite (relative_error v k) ->
  finite k /\ real_error (B2R v) (B2R k) = Some (B2R (relative_error v k)).
Proof.
  intros K. assert (P := p_3).
  unfold RelativeCode.relative_error, Relative.relative_error, Relative.error_of_count. cbv zeta.
  destruct (equal _ C k (count 0)) eqn:E.
  { destruct (count_is_zero k K E) as [FK ->]. intros _. split; [exact FK |]. rewrite Req_bool_true by auto.
    destruct (zero_value p emax p_3) as [_ Z]. now rewrite Z. }
  destruct (less _ C (length_of_count _ C u k) (count 7 /# count 4)) eqn:L; cbn [negb]; [| discriminate].
  assert (N := nonnegative_length k K). assert (FL := less_finite_left q qmax _ _ N L).
  destruct limit_value as [F7 V7]. rewrite (less_finite q qmax), V7 in L by auto. revert L.
  case Rlt_bool_spec; [| discriminate]. intros L _. apply nonnegative_value in N.
  destruct (share_of_length_value _ FL (conj N L)) as (FS & ES & PS).
  assert (G := length_finite k FL). destruct G as [FK EL]. rewrite (equal_finite q qmax) in E;
    [| auto | apply (zero_value q qmax q_3)]. rewrite value_0 in E. rewrite E. rewrite <- EL, Rlt_bool_true by exact L.
  rewrite <- ES. set (r := share_of_length _ C (length_of_count _ C u k)) in *. set (share := from_count r).
  intros H. split; [exact FK |]. apply plus_finite in H. destruct H as (H & _ & ->).
  apply (upper_finite p emax p_3) in H. destruct H as (H & ->). apply times_finite in H. destruct H as (HA & H & ->).
  apply (abs_finite p emax p_3) in HA. destruct HA as [FV ->]. rewrite (proj2 (eta_value p emax p_3)).
  assert (FH : finite share).
  { destruct (less _ C (to_count share) r); [| exact H]. apply plus_finite in H. destruct H as (H & _).
    now apply (upper_finite p emax p_3) in H. }
  assert (G := converted_finite q qmax p emax r FH). destruct G as [_ EH]. fold share in EH.
  destruct (to_count_exact share FH) as [FT ET].
  rewrite (less_finite q qmax), ET in H |- * by auto. rewrite EH in H |- *.
  destruct (Rlt_bool (fl (B2R r)) (B2R r)); [| now rewrite EH].
  apply plus_finite in H. destruct H as (H & _ & ->). apply (upper_finite p emax p_3) in H. destruct H as (_ & ->).
  now rewrite EH, (proj2 (eta_value p emax p_3)).
Qed.
Theorem relative_error_known v k x : relative_known v k x -> known p emax v (relative_error v k) x.
Proof.
  intros [K H]. split; [now apply error_nonnegative |]. intros FE. destruct (error_finite v k K FE) as [FK E].
  destruct (H FK) as [FV HV]. split; [exact FV |].
  now destruct (of_sums Relative.relative_error_sound _ _ _ _ HV E) as (_ & _ & D).
Qed.
Theorem relative_sign_known v k x : relative_known v k x -> right_sign (relative_sign v k) x.
Proof.
  intros [K H]. unfold RelativeCode.relative_sign.
  destruct (is_finite _ F (relative_error v k)) eqn:FE; cbn [negb]; [| easy].
  apply (IeeeInterval.is_finite_true p emax) in FE. destruct (error_finite v k K FE) as [FK E].
  destruct (H FK) as [FV HV]. assert (T := Relative.relative_sign_sound p emin q qmin _ _ _ HV).
  unfold Relative.relative_sign in T. rewrite E in T. destruct (zero_value p emax p_3) as [Z0 Z].
  rewrite (equal_finite p emax), (less_finite p emax), Z by auto. exact T.
Qed.

(** Counts of absolute errors. *)
Lemma factors_known error size : nonnegative p emax error -> finite size -> is_count (factors_of error size) /\
  (finite (factors_of error size) -> finite error /\
   real_factors (B2R error) (B2R size) = Some (B2R (factors_of error size))).
Proof.
  intros PE FZ. assert (P := p_3). assert (Q := q_3). destruct (zero_value p emax p_3) as [Z0 Z].
  assert (Nothing : forall r, is_count (unknown _ C) /\ (finite (unknown _ C) -> finite error /\
    r = Some (B2R (unknown _ C)))) by (split; [apply infinite_count | discriminate]).
  unfold RelativeCode.factors_of. cbv zeta. unfold Relative.factors_of.
  destruct (less _ F (integer _ F 0) size) eqn:S; cbn [negb]; [| apply Nothing].
  rewrite (less_finite p emax), Z in S by auto. rewrite S. revert S. case Rlt_bool_spec; [| discriminate]. intros S _.
  set (share := upper _ F (error ⊘ size) ⊕ underflow_unit _ F).
  destruct (less _ F share (integer _ F 1)) eqn:L1; cbn [negb]; [| apply Nothing].
  destruct (integer_value p emax p_3 1 ltac:(lia)) as [F1 V1]. destruct (count_value 1 ltac:(lia)) as [G1 W1].
  assert (PS : nonnegative p emax share).
  { apply nonnegative_plus; [| now apply nonnegative_eta]. apply nonnegative_upper; auto.
    apply nonnegative_over; auto; [apply nonnegative_intro; auto; lra | lra]. }
  assert (FS := less_finite_left p emax _ _ PS L1).
  destruct (to_count_exact share FS) as [FT ET].
  set (r := upper _ C (to_count share) +# underflow_unit _ C).
  destruct (less _ C r (count 1)) eqn:L2; cbn [negb]; [| apply Nothing].
  assert (PR : nonnegative q qmax r).
  { apply nonnegative_plus; [| now apply nonnegative_eta]. apply nonnegative_upper; auto.
    now apply converted_nonnegative. }
  assert (FR := less_finite_left q qmax _ _ PR L2).
  rewrite (less_finite p emax), V1 in L1 by auto. rewrite (less_finite q qmax), W1 in L2 by auto.
  assert (VS := FS). apply plus_finite in VS. destruct VS as (VS & _ & ES). apply (upper_finite p emax p_3) in VS.
  destruct VS as (VS & EU). apply over_finite in VS; [| auto | lra]. destruct VS as [FE ED].
  rewrite EU, ED, (proj2 (eta_value p emax p_3)) in ES. fold share in ES. rewrite <- ES, L1.
  assert (VR := FR). apply plus_finite in VR. destruct VR as (VR & _ & ER). apply (upper_finite q qmax q_3) in VR.
  destruct VR as (_ & EV). rewrite EV, ET, (proj2 (eta_value q qmax q_3)) in ER. fold r in ER.
  assert (DS : dl (B2R share) = B2R share).
  { rewrite <- ET. apply (Format.rnd_exact q qmin Format.nearest), number_B2R. }
  rewrite DS, <- ER, L2. apply nonnegative_value in PR.
  assert (R1 : 0 <= B2R r < 1) by (revert L2; case Rlt_bool_spec; [auto | discriminate]).
  destruct (count_of_share_value r FR R1) as [FC EC]. split; [| intros _; split; [exact FE | now rewrite EC]].
  apply count_intro; auto. rewrite EC.
  apply (Relative.count_of_share_nonnegative q qmin q_24 qmin_q p p_q); auto using number_B2R.
Qed.

(** A negative, infinite or NaN error gives an unknown number. *)
Theorem relative_within_known v error x :
  (finite error -> 0 <= B2R error -> Rabs (B2R v - x) <= B2R error) -> relative_known v (relative_within v error) x.
Proof.
  intros K. destruct (zero_value p emax p_3) as [Z0 Z]. unfold RelativeCode.relative_within.
  destruct (equal _ F error (integer _ F 0)) eqn:E.
  { apply (equal_true p emax) in E; auto. destruct E as [FE E]. rewrite Z in E.
    specialize (K FE ltac:(lra)). rewrite E in K. apply Format.within_0 in K. rewrite <- K. apply relative_exact_known. }
  destruct (less _ F (integer _ F 0) error) eqn:L; cbn [negb orb]; [| apply unknown_known].
  destruct (is_finite _ F v) eqn:FV; cbn [negb]; [| apply unknown_known].
  apply (IeeeInterval.is_finite_true p emax) in FV. assert (FA := abs_finite_intro p emax v FV).
  assert (PE : nonnegative p emax error).
  { destruct (less_true_0 p emax p_3 _ L) as [PE | ->]; [| reflexivity].
    apply nonnegative_intro; [| lra]. destruct error; simpl in *; try lra; easy. }
  destruct (factors_known error (Code.abs _ F v) PE FA) as [CK HK]. split; [exact CK |]. intros FK. split; [exact FV |].
  destruct (HK FK) as [FE EK]. rewrite (proj2 (abs_finite p emax p_3 v FA)) in EK. apply nonnegative_value in PE.
  apply (of_sums Relative.relative_within_sound (B2R v) (B2R error)); auto using number_B2R.
  unfold Relative.relative_within. rewrite (equal_finite p emax), Z in E by auto. now rewrite E.
Qed.

(** Sums. *)
Lemma rounded_sum_known v k (is_exact : bool) x : is_count k ->
  (finite k -> finite v -> holds (B2R v) (Relative.rounded_sum q qmin (B2R k) is_exact) x) ->
  relative_known v (rounded_sum _ _ F C v k is_exact) x.
Proof.
  intros K H. unfold rounded_sum. destruct (is_finite _ F v) eqn:FV; cbn [negb]; [| apply unknown_known].
  apply (IeeeInterval.is_finite_true p emax) in FV. destruct (count_sum_known k (count 1) K one_count) as [S V].
  unfold Relative.rounded_sum in H. destruct is_exact; [split; auto |]. split; [exact S |]. intros FS.
  destruct (V FS) as (FK & _ & E). split; [exact FV |]. rewrite E, (proj2 (count_value 1 ltac:(lia))). auto.
Qed.
Lemma larger_count j k : is_count j -> is_count k -> let m := if less _ C j k then k else j in
  is_count m /\ (finite m -> finite j /\ finite k /\ B2R m = if Rlt_bool (B2R j) (B2R k) then B2R k else B2R j).
Proof.
  intros J K m. split; [unfold m; now destruct (less _ C j k) |]. unfold m. intros H.
  assert (B : finite j /\ finite k).
  { destruct (count_cases q qmax j J) as [FJ | ->], (count_cases q qmax k K) as [FK | ->];
      [now split | exfalso | exfalso | exfalso];
      [now destruct j as [| | | [|]] | now destruct k as [| | | [|]] | easy]. }
  destruct B as [FJ FK]. split; [exact FJ |]. split; [exact FK |].
  rewrite (less_finite q qmax) by auto. now case Rlt_bool.
Qed.

Lemma sum_known v a ka x b kb y : relative_known a ka x -> relative_known b kb y ->
  (finite v -> finite (a ⊕ b) /\ B2R v = B2R (a ⊕ b)) -> relative_known v (relative_add v a ka b kb) (x + y).
Proof.
  intros [CA KA] [CB KB] HV. assert (P := p_3). destruct (zero_value p emax p_3) as [Z0 Z].
  unfold RelativeCode.relative_add. cbv zeta. set (e := equal _ F (snd (two_sum _ F a b)) (integer _ F 0)).
  assert (Sum : finite v -> finite a /\ finite b /\ B2R v = fl (B2R a + B2R b)).
  { intros FV. destruct (HV FV) as [FS ->]. now apply plus_finite in FS. }
  assert (Exact : finite v -> e = true -> fl (B2R a + B2R b) = B2R a + B2R b).
  { intros FV E. destruct (HV FV) as [FS _]. apply (equal_true p emax) in E; auto. destruct E as [FE E]. rewrite Z in E.
    assert (G := plus_finite p emax _ _ FS). destruct G as (_ & _ & ES).
    destruct (IeeeInterval.two_sum_known p emax p_3 a b FS) as [N | [_ ER]].
    - now rewrite (finite_no_nan p emax _ FE) in N.
    - rewrite E, ES in ER. lra. }
  destruct (larger_count ka kb CA CB) as [CM HM]. set (m := if less _ C ka kb then kb else ka) in *.
  assert (Same : finite m -> finite a -> finite b ->
    equal _ C m (count 0) || at_most _ F (integer _ F 0) a && at_most _ F (integer _ F 0) b ||
      at_most _ F a (integer _ F 0) && at_most _ F b (integer _ F 0) =
    Req_bool (B2R m) 0 || Rle_bool 0 (B2R a) && Rle_bool 0 (B2R b) || Rle_bool (B2R a) 0 && Rle_bool (B2R b) 0).
  { intros FM FA FB. rewrite (equal_finite q qmax) by (auto; apply (zero_value q qmax q_3)).
    now rewrite !(at_most_finite p emax), value_0, Z by auto. }
  assert (Real : forall k, finite v -> finite ka -> finite kb ->
    Relative.relative_add p emin q qmin (B2R a) (B2R ka) (B2R b) (B2R kb) e = Some k -> holds (B2R v) k (x + y)).
  { intros k FV FKA FKB E. destruct (Sum FV) as (FA & FB & ->).
    apply (of_sums Relative.relative_add_sound (B2R a) (B2R ka) x (B2R b) (B2R kb) y e); auto.
    - now apply KA.
    - now apply KB. }
  unfold Relative.relative_add in Real. cbv zeta in Real.
  destruct (_ || _) eqn:One.
  - apply rounded_sum_known; [exact CM |]. intros FM FV. destruct (HM FM) as (FKA & FKB & EM).
    destruct (Sum FV) as (FA & FB & _). apply Real; auto. rewrite <- EM, <- Same by auto. reflexivity.
  - set (ea := relative_error a ka). set (eb := relative_error b kb). set (off := upper _ F (ea ⊕ eb)).
    set (least := if e then Code.abs _ F v else Code.abs _ F v ⊗ (integer _ F 1 ⊖ epsilon _ F)).
    destruct (is_finite _ F v) eqn:FV; cbn [negb orb]; [| apply unknown_known].
    apply (IeeeInterval.is_finite_true p emax) in FV.
    destruct (less _ F off least) eqn:L; cbn [negb]; [| apply unknown_known].
    assert (PO : nonnegative p emax off).
    { apply nonnegative_upper; auto. apply nonnegative_plus; now apply error_nonnegative. }
    assert (FO := less_finite_left p emax _ _ PO L).
    assert (VO := upper_finite p emax p_3 _ FO). destruct VO as [VO EO]. apply plus_finite in VO.
    destruct VO as (FEA & FEB & ES). rewrite ES in EO. fold off in EO.
    destruct (error_finite a ka CA FEA) as [FKA EA]. destruct (error_finite b kb CB FEB) as [FKB EB].
    destruct (Sum FV) as (FA & FB & EV). assert (FM : finite m) by (unfold m; now destruct (less _ C ka kb)).
    destruct (HM FM) as (_ & _ & EM).
    assert (AV := abs_finite_intro p emax v FV). destruct (abs_finite p emax p_3 v AV) as [_ EAV].
    assert (HL : finite least /\ B2R least =
      if e then Rabs (fl (B2R a + B2R b)) else fl (Rabs (fl (B2R a + B2R b)) * fl (1 - Format.eps p))).
    { unfold least. rewrite <- EV. destruct e; [split; auto |].
      destruct (integer_value p emax p_3 1 ltac:(lia)) as [F1 V1], (eps_value p emax p_3) as [FE VE].
      assert (E1 : 0 <= Format.eps p <= 1).
      { split; [apply bpow_ge_0 |]. change 1 with (bpow radix2 0). apply bpow_le. lia. }
      assert (PE := p_emax p emax).
      destruct (minus_fits p emax (integer _ F 1) (epsilon _ F) 1) as [FD VD]; auto.
      - apply (fitting_power p emax 0). lia.
      - rewrite V1, VE, Rabs_pos_eq; lra.
      - destruct (times_fits p emax (Code.abs _ F v) (integer _ F 1 ⊖ epsilon _ F) (Rabs (B2R v))) as [FT VT]; auto.
        + apply fitting_value.
        + rewrite EAV, Rabs_mult, Rabs_Rabsolu. rewrite <- (Rmult_1_r (Rabs (B2R v))) at 2.
          apply Rmult_le_compat_l; [apply Rabs_pos |]. rewrite VD, V1, VE.
          apply (Format.rnd_abs_below p emin Format.nearest); [| rewrite Rabs_pos_eq; lra].
          apply (fitting_power p emax 0). lia.
        + split; [exact FT |]. now rewrite VT, VD, V1, VE, EAV. }
    destruct HL as [FL EL].
    destruct (factors_known off least PO FL) as [CK HK]. apply rounded_sum_known; [exact CK |]. intros FK _.
    destruct (HK FK) as [_ EF]. apply Real; auto.
    fold ea in EA. fold eb in EB. rewrite <- EM, <- Same, EA, EB, <- EO, <- EL, <- (less_finite p emax), L, EF by auto.
    reflexivity.
Qed.
Theorem relative_add_known a ka x b kb y : relative_known a ka x -> relative_known b kb y ->
  relative_known (a ⊕ b) (relative_add (a ⊕ b) a ka b kb) (x + y).
Proof. intros A B. apply sum_known; auto. Qed.
Theorem relative_subtract_known a ka x b kb y : relative_known a ka x -> relative_known b kb y ->
  relative_known (a ⊖ b) (relative_subtract (a ⊖ b) a ka b kb) (x - y).
Proof.
  intros A B. apply sum_known; [exact A | now apply relative_negate_known |]. rewrite minus_is_plus. auto.
Qed.

(** Products, quotients, powers of two. *)
Lemma rounded_to_known v k (is_exact : bool) x : is_count k ->
  (forall n, finite k -> finite v -> Relative.rounded_to p emin q qmin (B2R v) (B2R k) is_exact = Some n ->
    holds (B2R v) n x) ->
  relative_known v (rounded_to _ _ F C v k is_exact) x.
Proof.
  intros K H. unfold rounded_to. unfold Relative.rounded_to in H.
  destruct (is_finite _ F v) eqn:FV; cbn [negb]; [| apply unknown_known].
  apply (IeeeInterval.is_finite_true p emax) in FV. destruct is_exact; [split; auto |].
  assert (AV := abs_finite_intro p emax v FV). destruct (smallest_normal_value p emax p_3) as [FN VN].
  rewrite (at_most_finite p emax), VN, (proj2 (abs_finite p emax p_3 v AV)) by auto.
  destruct (Rle_bool _ _); [| apply unknown_known].
  destruct (count_sum_known k (count 1) K one_count) as [S V]. split; [exact S |]. intros FS.
  destruct (V FS) as (FK & _ & E). split; [exact FV |]. rewrite E, (proj2 (count_value 1 ltac:(lia))). auto.
Qed.
Lemma exact_zero_known a ka x : relative_known a ka x -> is_exact_zero _ _ F C a ka = true ->
  finite a /\ finite ka /\ B2R a = 0 /\ B2R ka = 0 /\ x = 0.
Proof.
  intros [CA KA] H. apply andb_prop in H. destruct H as [H1 H2]. destruct (zero_value p emax p_3) as [Z0 Z].
  apply (equal_true p emax) in H1; auto. rewrite Z in H1. destruct (count_is_zero ka CA H2) as [FK EK].
  destruct (KA FK) as [FA HA]. repeat split; try tauto. apply (Relative.is_zero_tells p emin q qmin) with (1 := HA).
  unfold Relative.is_zero. now rewrite !Req_bool_true.
Qed.
Lemma exact_zero_value a ka : finite a -> finite ka ->
  is_exact_zero _ _ F C a ka = Relative.is_zero (B2R a) (B2R ka).
Proof.
  intros A K. unfold is_exact_zero, Relative.is_zero.
  destruct (zero_value p emax p_3) as [Z0 Z], (zero_value q qmax q_3) as [C0 Z'].
  now rewrite (equal_finite p emax), (equal_finite q qmax), Z, Z' by auto.
Qed.
(** A value that is certainly zero. *)
Lemma certain_zero_known v : (finite v -> B2R v = 0) -> relative_known v (relative_exact v) 0.
Proof.
  intros H. destruct (relative_exact_known v) as [K L]. split; [exact K |]. intros FK. destruct (L FK) as [FV HV].
  split; [exact FV |]. now rewrite (H FV) in HV |- *.
Qed.

Theorem relative_multiply_known a ka x b kb y : relative_known a ka x -> relative_known b kb y ->
  relative_known (a ⊗ b) (relative_multiply (a ⊗ b) a ka b kb) (x * y).
Proof.
  intros A B. unfold RelativeCode.relative_multiply. cbv zeta. destruct (_ || _) eqn:CZ.
  { assert (E : x * y = 0 /\ (B2R a = 0 \/ B2R b = 0)).
    { apply orb_prop in CZ. destruct CZ as [H | H].
      - destruct (exact_zero_known _ _ _ A H) as (_ & _ & E & _ & ->). split; [ring | auto].
      - destruct (exact_zero_known _ _ _ B H) as (_ & _ & E & _ & ->). split; [ring | auto]. }
    destruct E as [-> E]. apply certain_zero_known. intros H. now apply (zero_times p emax). }
  destruct A as [CA KA], B as [CB KB]. destruct (count_sum_known ka kb CA CB) as [CS HS].
  set (e := product_error_is_exact _ F fused a b (two_product _ F fused a b) && _).
  assert (Exact : e = true -> B2R (a ⊗ b) = B2R a * B2R b).
  { intros E. apply andb_prop in E. destruct E as [E1 E2]. destruct (zero_value p emax p_3) as [Z0 Z].
    apply (IeeeInterval.product_known p emax p_3 fused) in E1. destruct E1 as (_ & _ & _ & _ & E1 & _).
    apply (equal_true p emax) in E2; auto. rewrite Z in E2. destruct E2 as [_ E2]. rewrite E2 in E1. lra. }
  apply rounded_to_known; [exact CS |]. intros n FS FV E. destruct (HS FS) as (FKA & FKB & ES).
  destruct (KA FKA) as [FA HA], (KB FKB) as [FB HB]. apply times_finite in FV. destruct FV as (_ & _ & EV).
  rewrite EV in E, Exact |- *.
  apply (of_reals Relative.relative_multiply_sound (B2R a) (B2R ka) x (B2R b) (B2R kb) y e n HA HB Exact).
  unfold Relative.relative_multiply. rewrite <- !exact_zero_value, CZ, <- ES by auto. exact E.
Qed.
(** If the count is finite, y is not zero. *)
Theorem relative_divide_known a ka x b kb y : relative_known a ka x -> relative_known b kb y ->
  relative_known (a ⊘ b) (relative_divide (a ⊘ b) a ka b kb) (x / y) /\
  (finite (relative_divide (a ⊘ b) a ka b kb) -> y <> 0).
Proof.
  intros A B. unfold RelativeCode.relative_divide.
  assert (Nothing : relative_known (a ⊘ b) (unknown _ C) (x / y) /\ (finite (unknown _ C) -> y <> 0)).
  { split; [apply unknown_known | discriminate]. }
  destruct (equal _ F b (integer _ F 0)) eqn:BZ; cbn [orb]; [exact Nothing |].
  destruct (less _ C kb (unknown _ C)) eqn:L; cbn [negb]; [| exact Nothing]. clear Nothing.
  destruct B as [CB KB]. assert (FKB := less_finite_left q qmax _ _ (proj1 CB) L).
  destruct (KB FKB) as [FB HB]. destruct (zero_value p emax p_3) as [Z0 Z].
  rewrite (equal_finite p emax), Z in BZ by auto. assert (NB : B2R b <> 0) by (revert BZ; now case Req_bool_spec).
  assert (NY : y <> 0).
  { intros ->. apply NB. destruct HB as (_ & _ & _ & HB). now apply (Relative.close_0 _ _ _ HB). }
  split; [| auto]. destruct (is_exact_zero _ _ F C a ka) eqn:AZ.
  { destruct (exact_zero_known _ _ _ A AZ) as (_ & _ & EA & _ & ->). unfold Rdiv. rewrite Rmult_0_l.
    apply certain_zero_known. now apply (zero_over p emax). }
  assert (R := IeeeInterval.remainder_known p emax p_3 fused a b).
  destruct (remainder_of_division _ F fused a b (a ⊘ b)) as [remainder known]. cbn [fst snd] in R.
  set (e := known && equal _ F remainder (integer _ F 0)).
  destruct A as [CA KA]. destruct (count_sum_known ka kb CA CB) as [CS HS].
  apply rounded_to_known; [exact CS |]. intros n FS FV E. destruct (HS FS) as (FKA & _ & ES).
  destruct (KA FKA) as [FA HA].
  assert (Exact : e = true -> B2R (a ⊘ b) = B2R a / B2R b).
  { intros E'. apply andb_prop in E'. destruct E' as [E1 E2]. destruct (R FV FB NB E1) as [_ ER].
    apply (equal_true p emax) in E2; auto. rewrite Z in E2. destruct E2 as [_ E2].
    apply Rmult_eq_reg_r with (B2R b); [| exact NB]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by exact NB. lra. }
  apply over_finite in FV; auto. destruct FV as [_ EV]. rewrite EV in E, Exact |- *.
  apply (of_reals Relative.relative_divide_sound (B2R a) (B2R ka) x (B2R b) (B2R kb) y e n HA HB Exact).
  unfold Relative.relative_divide. rewrite BZ, <- exact_zero_value, AZ, <- ES by auto. exact E.
Qed.
Theorem relative_scale_known a ka x e : relative_known a ka x ->
  relative_known (scale _ F a e) (relative_scale (scale _ F a e) a ka e) (x * bpow radix2 e).
Proof.
  intros [CA KA]. unfold RelativeCode.relative_scale. apply rounded_to_known; [exact CA |]. intros n FK FV E.
  destruct (KA FK) as [FA HA]. rewrite (scale_equal p emax) in E by auto.
  apply scale_finite in FV. destruct FV as [_ EV].
  rewrite EV in E |- *. exact (of_reals Relative.relative_scale_sound (B2R a) (B2R ka) x e n HA E).
Qed.

(** So bounds of functions of known numbers hold. *)
Theorem relative_promises : promises p emax _ (relative_rule _ _ F C to_count from_count) relative_known.
Proof.
  split; cbn [relative_rule rule_exact rule_within rule_error rule_subtract rule_negate rule_sign].
  - apply relative_exact_known.
  - apply relative_within_known.
  - apply relative_error_known.
  - apply relative_subtract_known.
  - apply relative_negate_known.
  - apply relative_sign_known.
Qed.
Theorem relative_keeps_operations :
  keeps_operations p emax _ (relative_operations _ _ F C to_count from_count fused) relative_known.
Proof.
  split; cbn [relative_operations the_rule rule_add rule_multiply rule_divide rule_scale].
  - apply relative_promises.
  - apply relative_add_known.
  - apply relative_multiply_known.
  - intros divide a sa x b sb y E. injection E as <-. intros KA KB t Q.
    destruct (relative_divide_known a sa x b sb y KA KB) as [[K H] N].
    destruct Q as [Y | ->]; split; auto. intros FK. now apply N in FK.
  - apply relative_scale_known.
  - intros a c k x _ FC E [K H]. split; [exact K |]. rewrite <- E. intros FK. split; [exact FC | now apply H].
Qed.

(** Dot products: the sum of absolute errors, and the count of single operations. *)
Lemma rounded_off_known a b : finite (snd (two_sum _ F a b)) ->
  finite (a ⊕ b) /\ B2R (a ⊕ b) + B2R (snd (two_sum _ F a b)) = B2R a + B2R b.
Proof.
  intros H. assert (S : finite (a ⊕ b)).
  { apply plus_finite in H. destruct H as (_ & H & _). apply minus_finite in H. destruct H as (_ & H & _).
    now apply minus_finite in H. }
  split; [exact S |]. destruct (IeeeInterval.two_sum_known p emax p_3 a b S) as [N | [_ E]]; [| exact E].
  now rewrite (finite_no_nan p emax _ H) in N.
Qed.
Lemma upper_sum_covers x y : nonnegative p emax x -> nonnegative p emax y -> finite (upper _ F (x ⊕ y)) ->
  finite x /\ finite y /\ B2R x + B2R y <= B2R (upper _ F (x ⊕ y)).
Proof.
  intros X Y H. apply nonnegative_value in X, Y. apply (upper_finite p emax p_3) in H. destruct H as (H & ->).
  apply plus_finite in H. destruct H as (FX & FY & ->). split; [exact FX |]. split; [exact FY |].
  apply Upper.upper_covers_sum; auto using number_B2R, emin_p; [lia | lra].
Qed.
Definition known_pair (pair : (float * double) * (float * double)) (exact : R * R) : Prop :=
  relative_known (fst (fst pair)) (snd (fst pair)) (fst exact) /\
  relative_known (fst (snd pair)) (snd (snd pair)) (snd exact).
Definition state_known (s : float * float * double) (t : R) : Prop :=
  known p emax (fst (fst s)) (snd (fst s)) t /\ relative_known (fst (fst s)) (snd s) t.
Lemma dot_step_known s pair t exact : state_known s t -> known_pair pair exact ->
  state_known (relative_dot_step _ _ F C to_count from_count fused s pair) (t + fst exact * snd exact).
Proof.
  destruct s as [[before off] counted], pair as [[a ka] [b kb]]. unfold state_known, known_pair, relative_dot_step.
  cbn [fst snd]. intros [[PO KO] KC] [A B].
  set (product := a ⊗ b). set (of_product := relative_multiply product a ka b kb).
  assert (KP : relative_known product of_product (fst exact * snd exact)) by now apply relative_multiply_known.
  split; [| now apply relative_add_known].
  assert (KE := relative_error_known _ _ _ KP). destruct KE as [PE KE].
  set (lost := relative_error product of_product) in *.
  set (rounded_off := Code.abs _ F (snd (two_sum _ F before product))).
  assert (P := p_3). assert (PR : nonnegative p emax rounded_off) by now apply nonnegative_abs.
  assert (PU : nonnegative p emax (upper _ F (lost ⊕ rounded_off))).
  { apply nonnegative_upper; auto. now apply nonnegative_plus. }
  split; [apply nonnegative_upper; auto; now apply nonnegative_plus |]. intros H.
  destruct (upper_sum_covers _ _ PO PU H) as (FO & FU & L1). destruct (upper_sum_covers _ _ PE PR FU) as (FE & FR & L2).
  destruct (KO FO) as [_ D1], (KE FE) as [_ D2]. apply (abs_finite p emax p_3) in FR. destruct FR as [FR ER].
  fold rounded_off in ER. destruct (rounded_off_known _ _ FR) as [FS ES]. split; [exact FS |].
  assert (E : B2R (before ⊕ product) - (t + fst exact * snd exact) =
    (B2R before - t) + (B2R product - fst exact * snd exact) + - B2R (snd (two_sum _ F before product))) by lra.
  rewrite E. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp, <- ER.
  apply Rle_trans with (Rabs (B2R before - t) + Rabs (B2R product - fst exact * snd exact) + B2R rounded_off);
    [| lra]. apply Rplus_le_compat_r, Rabs_triang.
Qed.
Theorem relative_dot_known pairs exacts : Forall2 known_pair pairs exacts ->
  let '(sum, k) := relative_dot _ _ F C to_count from_count fused pairs in relative_known sum k (exact_dot exacts).
Proof.
  assert (Loop : forall l e, Forall2 known_pair l e -> forall s t, state_known s t ->
    state_known (fold_left (relative_dot_step _ _ F C to_count from_count fused) l s) (t + exact_dot e)).
  { induction 1 as [| pair exact l e K _ IH]; intros s t S; cbn [fold_left exact_dot fold_right].
    { now rewrite Rplus_0_r. }
    rewrite <- Rplus_assoc. apply IH. now apply dot_step_known. }
  intros H. destruct (zero_value p emax p_3) as [Z0 Z]. assert (P := p_3).
  assert (Start : state_known (integer _ F 0, integer _ F 0, count 0) 0).
  { split; cbn [fst snd].
    - split; [now apply nonnegative_integer |]. intros _. split; [exact Z0 |]. rewrite Z, Rminus_0_r, Rabs_R0. lra.
    - split; [apply zero_count |]. intros _. split; [exact Z0 |]. rewrite Z, value_0.
      apply Relative.relative_exact_sound, Format.number_0. }
  assert (L := Loop _ _ H _ _ Start). rewrite Rplus_0_l in L. unfold relative_dot.
  destruct (fold_left _ pairs _) as [[sum off] counted]. destruct L as [[_ KO] KC]. cbn [fst snd] in KO, KC.
  destruct (less _ C _ counted); [| exact KC]. apply relative_within_known. intros FO _. now apply KO.
Qed.

End Rule.

(** Counts in double. *)
Theorem relative_keeps_operations_doubles p emax (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax)
  (q_positive : Prec_gt_0 53) (q_below : Prec_lt_emax 53 1024) fused : (4 <= p <= 53)%Z -> (emax <= 1024)%Z ->
  keeps_operations p emax _
    (relative_operations _ _ (floats p emax) (floats 53 1024) (converted p emax 53 1024)
       (converted 53 1024 p emax) fused)
    (relative_known p emax 53 1024).
Proof. intros P E. apply relative_keeps_operations; auto; lia. Qed.
