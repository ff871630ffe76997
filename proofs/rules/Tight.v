(** Bound rule `tight` (include/errbound/rules/tight.hpp): TightBound, as the C++ code computes it.

    A number x has a value a and a bound sa, |a - x| <= sa. u is a number (emin <= -p), as in every IEEE format.
    Results:
        tight_add_sound, tight_subtract_sound, tight_multiply_sound, tight_divide_sound, tight_scale_sound
            rounding in any one direction, from 5 bits on
        tight_add_sound_nearest, tight_subtract_sound_nearest, tight_multiply_sound_nearest,
        tight_divide_sound_nearest, tight_scale_sound_nearest
            rounding to nearest, ties to even, from 3 bits on
        tight_exact_sound, tight_within_sound   exact numbers, and numbers within a given error
        tight_add_number, tight_multiply_number, tight_divide_number   the bound is a number of the format *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format.
From Errbound Require Upper.
Open Scope R_scope.

(** Errors of negations, of sums, and by an intermediate value. *)
Lemma within_opp b y s : Rabs (b - y) <= s -> Rabs (- b - - y) <= s.
Proof. replace (- b - - y) with (- (b - y)) by ring. now rewrite Rabs_Ropp. Qed.
Lemma within_through m v x r s : Rabs (v - m) <= r -> Rabs (m - x) <= s -> Rabs (v - x) <= r + s.
Proof. intros R S. apply Rabs_le_inv in R, S. apply Rabs_le. lra. Qed.
Lemma within_sum a x sa b y sb : Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> Rabs (a + b - (x + y)) <= sa + sb.
Proof. intros A B. apply Rabs_le_inv in A, B. apply Rabs_le. lra. Qed.

Section Tight.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (direction : R -> Z) {direction_valid : Valid_rnd direction}.

Notation fl := (rnd p emin direction).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).

(** The code, in its order of evaluation. *)
Definition rounding (v : R) : R := fl (Rabs v * fl (eps * fl (1 + eps))).
Definition inflated (bound : R) : R := fl (bound * fl (1 + fl (8 * eps))).
Definition is_zero (a sa : R) : bool := Req_bool a 0 && Req_bool sa 0.

Definition tight_exact (a : R) : R := fl (a - a).
(** For error >= 0. *)
Definition tight_within (a error : R) : R := fl (error + fl (a - a)).
Definition tight_enlarged (v sa sb : R) : R := inflated (fl (rounding v + fl (sa + sb))).
Definition tight_add (v sa sb : R) : R :=
  Upper.sum_of_bounds p emin direction (tight_enlarged v sa sb) (rounding v) sa sb.
Definition tight_multiply (v a sa b sb : R) : R :=
  if is_zero a sa || is_zero b sb then rounding v
  else
    let inherited := fl (fl (Rabs a * sb) + fl (sa * fl (Rabs b + sb))) in
    inflated (fl (fl (rounding v + inherited) + fl (4 * eta))).
(** None: the result is unknown (the bound is infinite). *)
Definition tight_divide (v a sa b sb : R) : option R :=
  let distance := fl (Rabs b - sb) in
  if negb (Rlt_bool 0 distance) then None
  else if is_zero a sa then Some (rounding v)
  else
    let quotient := inflated (fl (Rabs v + eta)) in
    let lost := if Rlt_bool 0 sb then fl (4 * eta) else 0 in
    let inherited := fl (fl (fl (sa + fl (quotient * sb)) + lost) / distance) in
    Some (inflated (fl (fl (rounding v + inflated inherited) + fl (4 * eta)))).

Definition tight_scale (v a sa : R) (e : Z) : R :=
  scaled_error p emin direction (fun scaled => inflated (fl (scaled + fl (2 * eta)))) v a sa e.

(** Facts about the format, for this direction. *)
Let rnd_exact := Format.rnd_exact p emin direction.
Let rnd_number := Format.rnd_number p emin direction.
Let rnd_le := Format.rnd_le p emin direction.
Let rnd_above := Format.rnd_above p emin direction.
Let rnd_below := Format.rnd_below p emin direction.
Let rnd_nonnegative := Format.rnd_nonnegative p emin direction.
Let rnd_0 := Format.rnd_0 p emin direction.
Let rnd_subnormal := Format.rnd_subnormal p emin direction.
Let sum_subnormal := Format.sum_subnormal p emin direction.
Let scaled_up := Format.scaled_up p emin direction.

(** The proof for a rounding with a relative error r, or an error h below the smallest normal number. *)
Section Proof.

Context (p_3 : (3 <= p)%Z) (emin_p : (emin <= - p)%Z) (r h : R) (E : rounding_error p emin direction r h).
Let sum_relative := Format.sum_relative p emin direction r h E.
Let rnd_absolute := Format.rnd_absolute p emin direction r h E.
Let rnd_lower := Format.rnd_lower p emin direction r h E.
Let rnd_relative := Format.rnd_relative p emin direction r h E.
Let sum_error := Format.sum_error p emin direction r h E.
Let inflated_relative := Format.inflated_relative p emin direction r h E.
Let f := 1 + 8 * eps.
Let q := 1 - r.
Context (f_q6 : 1 <= f * (q * q * q * q * q * q)) (h_f : h * (2 + f) <= 4 * eta).

Lemma f_1 : 1 <= f.
Proof. unfold f. generalize (eps_positive p). lra. Qed.
Lemma q_1 : 0 < q <= 1.
Proof. unfold q. generalize (error_r _ _ _ _ _ E) (error_r_1 _ _ _ _ _ E). lra. Qed.

Lemma number_1 : number 1.
Proof. change 1 with (bpow radix2 0). apply number_power; auto. unfold Prec_gt_0 in *. lia. Qed.
Lemma number_eps : number eps.
Proof. apply number_power; auto. lia. Qed.
Lemma number_4_eta : number (4 * eta).
Proof. exact (number_eta_times p emin 2 ltac:(lia)). Qed.
Lemma number_2_eta : number (2 * eta).
Proof. exact (number_eta_times p emin 1 ltac:(lia)). Qed.

(** The factor 1 + 8 eps is a number, even with three bits (it is 3 then). *)
Lemma number_f : number f.
Proof.
  unfold f, Format.eps. replace (8 * bpow radix2 (1 - p)) with (bpow radix2 (4 - p)).
  - apply number_1_power; auto; lia.
  - replace (4 - p)%Z with (3 + (1 - p))%Z by lia. now rewrite bpow_plus.
Qed.

Lemma inflated_exact x : inflated x = fl (x * f).
Proof.
  unfold inflated. rewrite (rnd_exact (8 * eps)).
  - now rewrite (rnd_exact (1 + 8 * eps) number_f).
  - replace (8 * eps) with (bpow radix2 (3 + (1 - p))).
    + apply number_power; auto. lia.
    + rewrite bpow_plus. reflexivity.
Qed.

(** The rule's rounding term is at least the error of its operation. *)
Lemma rounding_factor : eps <= fl (eps * fl (1 + eps)).
Proof.
  assert (1 <= fl (1 + eps)).
  { apply rnd_above; auto using number_1. generalize (eps_positive p). lra. }
  apply rnd_above; auto using number_eps. generalize (eps_positive p). nra.
Qed.
Lemma rounding_nonnegative v : 0 <= rounding v.
Proof.
  apply rounding_term_nonnegative; auto. generalize (eps_positive p) rounding_factor. lra.
Qed.
Lemma rounding_sum x y :
  number x -> number y -> Rabs (fl (x + y) - (x + y)) <= rounding (fl (x + y)).
Proof. intros. apply rounding_of_sum; auto. apply rounding_factor. Qed.
Lemma rounding_any s : Rabs (fl s - s) <= rounding (fl s) + h.
Proof. apply rounding_of_any with r; auto. apply rounding_factor. Qed.
Lemma rounding_0 : rounding (fl 0) = 0.
Proof. unfold rounding. rewrite rnd_0, Rabs_R0, Rmult_0_l by auto. now apply rnd_0. Qed.

(** With fewer than six roundings. *)
Lemma f_q5 : 1 <= f * (q * q * q * q * q).
Proof. generalize f_1. intros. apply (fewer_roundings f q); [lra | apply q_1 | exact f_q6]. Qed.
Lemma f_q4 : 1 <= f * (q * q * q * q).
Proof. generalize f_1. intros. apply (fewer_roundings f q); [lra | apply q_1 | exact f_q5]. Qed.
Lemma f_q3 : 1 <= f * (q * q * q).
Proof. generalize f_1. intros. apply (fewer_roundings f q); [lra | apply q_1 | exact f_q4]. Qed.

Let leaves := leaves_of_error p emin direction r h E.
Let sum_left := Format.sum_left p emin direction q q_1 (proj1 leaves).
Let scaled_left := Format.scaled_left p emin direction q (proj1 leaves).

(** A sum of three, inflated, is at least the exact sum: nothing is lost below the smallest normal number, and the
    factor covers three roundings above. *)
Lemma inflated_sum_left x y z :
  number x -> number y -> number z -> 0 <= x -> 0 <= y -> 0 <= z ->
  x + y + z <= inflated (fl (fl (x + y) + z)).
Proof.
  intros. rewrite inflated_exact. apply (sum_of_three p emin direction q q_1 (proj1 leaves)); auto using f_1, f_q3.
Qed.
Lemma inflated_sum_right x y z :
  number x -> number y -> number z -> 0 <= x -> 0 <= y -> 0 <= z ->
  x + (y + z) <= inflated (fl (x + fl (y + z))).
Proof.
  intros. rewrite (Rplus_comm x (fl _)), (Rplus_comm x).
  now apply inflated_sum_left.
Qed.

(** The error of a sum, and its bounds. *)
Lemma sum_error_at_most a x sa b y sb :
  number a -> number b -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= rounding (fl (a + b)) + (sa + sb).
Proof. intros. apply within_through with (a + b); [now apply rounding_sum | now apply within_sum]. Qed.
Lemma enlarged_sound v sa sb : number sa -> number sb -> 0 <= sa -> 0 <= sb ->
  rounding v + (sa + sb) <= tight_enlarged v sa sb.
Proof. intros. apply inflated_sum_right; auto using rounding_nonnegative. apply rnd_number; auto. Qed.
Lemma add_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= tight_add (fl (a + b)) sa sb.
Proof.
  intros A B SA SB HA HB.
  assert (PA : 0 <= sa) by (generalize (Rabs_pos (a - x)); lra).
  assert (PB : 0 <= sb) by (generalize (Rabs_pos (b - y)); lra).
  assert (H := sum_error_at_most a x sa b y sb A B HA HB).
  apply Upper.sum_of_bounds_sound; auto using rounding_nonnegative; try lia; [apply rnd_number |].
  apply Rle_trans with (1 := H). now apply enlarged_sound.
Qed.

(** The error of an exact product from the operands' bounds. *)
Lemma product_inherits a x sa b y sb :
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (a * b - x * y) <= Rabs a * sb + sa * (Rabs b + sb).
Proof.
  intros HA HB.
  replace (a * b - x * y) with (a * (b - y) + (a - x) * y) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult. apply Rplus_le_compat.
  - apply Rmult_le_compat_l; auto. apply Rabs_pos.
  - apply Rmult_le_compat; auto using Rabs_pos.
    replace y with (b - (b - y)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra.
Qed.

Lemma is_zero_true a sa : is_zero a sa = true -> a = 0 /\ sa = 0.
Proof.
  unfold is_zero. intros H. apply andb_prop in H. destruct H as [H1 H2]. split.
  - revert H1. now case Req_bool_spec.
  - revert H2. now case Req_bool_spec.
Qed.
Lemma within_0 a x : Rabs (a - x) <= 0 -> a = x.
Proof.
  intros H. generalize (Rabs_pos (a - x)); intros. enough (a - x = 0) by lra.
  destruct (Req_dec (a - x) 0); auto. apply Rabs_no_R0 in H1. lra.
Qed.
Lemma product_with_zero a x sa b y sb : Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  is_zero a sa || is_zero b sb = true -> a * b = 0 /\ x * y = 0.
Proof.
  intros HA HB Zero. apply orb_prop in Zero. destruct Zero as [Zero | Zero]; apply is_zero_true in Zero; destruct Zero as [-> ->].
  - apply within_0 in HA. rewrite <- HA. lra.
  - apply within_0 in HB. rewrite <- HB. lra.
Qed.

Lemma multiply_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a * b) - x * y) <= tight_multiply (fl (a * b)) a sa b sb.
Proof.
  intros A B SA SB HA HB.
  assert (PA : 0 <= sa) by (generalize (Rabs_pos (a - x)); lra).
  assert (PB : 0 <= sb) by (generalize (Rabs_pos (b - y)); lra).
  unfold tight_multiply. cbv zeta.
  destruct (is_zero a sa || is_zero b sb) eqn:Zero.
  { destruct (product_with_zero a x sa b y sb HA HB Zero) as [-> ->].
    rewrite rounding_0, rnd_0, Rminus_0_r, Rabs_R0. lra. }
  rewrite (rnd_exact (4 * eta) number_4_eta), inflated_exact.
  set (v := fl (a * b)). set (R := rounding v).
  generalize (eta_positive emin) (error_h _ _ _ _ _ E) (error_r _ _ _ _ _ E) f_1 q_1; intros.
  destruct (product_inherited p emin direction q h q_1 (error_h _ _ _ _ _ E) (proj1 leaves) (proj2 leaves)
    (Rabs a) (Rabs b) sa sb eta) as (PI & Small & Large); auto using Rabs_pos.
  { now apply number_abs. }
  { intros z w Pz Zw C. assert (smallest_normal * r <= eta).
    { rewrite <- (smallest_normal_eps p emin).
      apply Rmult_le_compat_l; [apply Rlt_le, smallest_normal_positive | lra]. }
    unfold q in *. destruct (Rle_or_lt z smallest_normal) as [S | S]; [nra |].
    assert (smallest_normal * (1 - r) <= z * (1 - r)) by (apply Rmult_le_compat_r; lra). lra. }
  revert PI Small Large. set (I := fl (fl (Rabs a * sb) + fl (sa * fl (Rabs b + sb)))).
  set (X := Rabs a * sb + sa * (Rabs b + sb)). intros PI Small Large.
  assert (NR : number R) by apply rnd_number. assert (PR : 0 <= R) by apply rounding_nonnegative.
  assert (NI : number I) by apply rnd_number.
  assert (PX : 0 <= X) by (generalize (Rabs_pos a) (Rabs_pos b); intros; unfold X; nra).
  (* the exact bound *)
  apply Rle_trans with (R + h + X).
  { apply within_through with (a * b); [apply rounding_any | now apply product_inherits]. }
  set (S := fl (fl (R + I) + 4 * eta)).
  assert (PRI : 0 <= fl (R + I)) by (apply rnd_nonnegative; auto; lra).
  assert (LRI : fl (R + I) <= S) by (apply rnd_above; [apply rnd_number | lra]).
  destruct (Rlt_or_le S smallest_normal) as [C | C].
  - (* all sums are exact; the products lose at most 4 eta *)
    apply Rle_trans with S; [| apply scaled_up; [apply rnd_number | lra ..]].
    assert (ER : fl (R + I) = R + I) by (apply (sum_subnormal R I); auto; lra).
    assert (ES : S = fl (R + I) + 4 * eta) by (apply (sum_subnormal _ (4 * eta)); auto using number_4_eta, rnd_number;
      lra).
    specialize (Small ltac:(lra)). lra.
  - (* six roundings at most *)
    apply Rle_trans with (2 := scaled_left S f C f_1).
    generalize (sum_left R I NR NI ltac:(lra)). intros D4.
    generalize (sum_left (fl (R + I)) (4 * eta) (rnd_number _) number_4_eta ltac:(lra)). fold S. intros D5.
    assert (G : (R + X) * (q * q * q * q * q) + 2 * eta * q <= S).
    { apply Rle_trans with (2 := D5).
      apply Rle_trans with (((R + (X * (q * q) - 2 * h) * q) * q + 4 * eta) * q).
      - assert (q * q <= 1) by nra. assert (0 <= q * q) by nra.
        assert (Q3 : q * q * q <= 1) by nra. assert (0 <= q * q * q) by nra.
        assert (R * (q * q * q * q * q) <= R * (q * q)).
        { apply Rmult_le_compat_l; auto.
          replace (q * q * q * q * q) with (q * q * (q * q * q)) by ring. nra. }
        assert (h * (q * q * q) <= eta * q).
        { apply Rle_trans with (eta * (q * q * q)); [apply Rmult_le_compat_r; lra |].
          replace (eta * (q * q * q)) with (eta * q * (q * q)) by ring.
          assert (0 <= eta * q) by (apply Rmult_le_pos; lra). nra. }
        lra.
      - apply Rmult_le_compat_r; [lra |]. apply Rplus_le_compat_r.
        apply Rle_trans with (2 := D4). apply Rmult_le_compat_r; [lra |]. apply Rplus_le_compat_l; auto. }
    generalize f_q6 (fewer_roundings f q (q * q) ltac:(lra) q_1 f_q3); intros.
    apply Rle_trans with (((R + X) * (q * q * q * q * q) + 2 * eta * q) * (f * q)).
    + replace (((R + X) * (q * q * q * q * q) + 2 * eta * q) * (f * q))
        with ((R + X) * (f * (q * q * q * q * q * q)) + 2 * eta * (f * (q * q))) by ring. nra.
    + apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra.
Qed.

(** The printed rule's bound of an exact quotient, multiplied by the denominators. *)
Lemma quotient_inherits a x sa b y sb :
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> 0 < Rabs b - sb ->
  Rabs (a / b - x / y) <= (sa + Rabs (a / b) * sb) / (Rabs b - sb).
Proof.
  intros HA HB D.
  assert (PB : 0 <= sb) by (generalize (Rabs_pos (b - y)); lra).
  assert (Y : Rabs b - sb <= Rabs y).
  { assert (Rabs b <= Rabs (b - y) + Rabs y).
    { replace b with ((b - y) + y) at 1 by ring. apply Rabs_triang. }
    lra. }
  assert (B0 : b <> 0).
  { intros ->. rewrite Rabs_R0 in D. lra. }
  assert (Y0 : y <> 0).
  { intros ->. rewrite Rabs_R0 in Y. lra. }
  replace (a / b - x / y) with (((a - x) + a / b * (y - b)) * / y) by (field; auto).
  rewrite Rabs_mult, Rabs_inv. apply Rmult_le_compat.
  - apply Rabs_pos.
  - apply Rlt_le, Rinv_0_lt_compat, Rabs_pos_lt; auto.
  - apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_mult.
    rewrite (Rabs_minus_sym y b). apply Rplus_le_compat; auto.
    apply Rmult_le_compat_l; auto. apply Rabs_pos.
  - apply Rinv_le; auto.
Qed.

(** The code's bound of |a/b|. *)
Lemma quotient_covered s : Rabs s <= inflated (fl (Rabs (fl s) + eta)).
Proof.
  rewrite inflated_exact.
  apply (covered_by_rounded p emin direction q h q_1 (error_h _ _ _ _ _ E) (proj1 leaves) (proj2 leaves));
    [apply f_1 | apply f_q3].
Qed.

Lemma divide_sound a x sa b y sb bound :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  tight_divide (fl (a / b)) a sa b sb = Some bound ->
  y <> 0 /\ Rabs (fl (a / b) - x / y) <= bound.
Proof.
  intros A B SA SB HA HB HT.
  assert (PA : 0 <= sa) by (generalize (Rabs_pos (a - x)); lra).
  assert (PB : 0 <= sb) by (generalize (Rabs_pos (b - y)); lra).
  generalize (eta_positive emin) (error_h _ _ _ _ _ E) (error_r _ _ _ _ _ E) f_1 q_1; intros.
  revert HT. unfold tight_divide. cbv zeta. set (d := fl (Rabs b - sb)). set (D := Rabs b - sb).
  destruct (Rlt_bool_spec 0 d) as [Pd | Pd]; simpl; [| discriminate].
  assert (PD : 0 < D).
  { apply Rnot_le_lt. intros C. apply (rnd_below _ 0) in C; auto using number_0.
    fold d in C. unfold D in C. fold d in C. lra. }
  assert (Y : y <> 0).
  { intros ->. unfold D in PD. rewrite Rminus_0_r in HB. lra. }
  assert (dD : d <= D * (1 + r)).
  { generalize (sum_error (Rabs b) (- sb) ltac:(now apply number_abs) ltac:(now apply number_opp)).
    change (Rabs b + - sb) with D. change (fl D) with d. rewrite (Rabs_pos_eq D) by lra.
    intros G. apply Rabs_le_inv in G. lra. }
  destruct (is_zero a sa) eqn:Zero.
  { (* an exact zero *)
    intros G. injection G as <-. apply is_zero_true in Zero. destruct Zero as [Z1 Z2].
    rewrite Z2 in HA. apply within_0 in HA. rewrite <- HA, Z1. unfold Rdiv.
    rewrite !Rmult_0_l, rounding_0, rnd_0, Rminus_0_r, Rabs_R0. split; auto. lra. }
  rewrite (rnd_exact (4 * eta) number_4_eta).
  set (v := fl (a / b)). set (R := rounding v). set (k := inflated (fl (Rabs v + eta))).
  set (lost := if Rlt_bool 0 sb then 4 * eta else 0).
  set (N := fl (fl (sa + fl (k * sb)) + lost)). set (I := fl (N / d)).
  set (Z := (sa + Rabs (a / b) * sb) / D).
  intros G. injection G as <-. split; auto.
  generalize (Rabs_pos (a / b)); intros.
  assert (PZ : 0 <= Z).
  { apply Rmult_le_pos. nra. now apply Rlt_le, Rinv_0_lt_compat. }
  assert (HK : Rabs (a / b) <= k) by apply quotient_covered.
  (* the numerator *)
  assert (HN : (sa + Rabs (a / b) * sb) * (q * q * q) <= N).
  { unfold N, lost. destruct (Rlt_bool_spec 0 sb) as [S | S].
    - assert (PP : 0 <= fl (k * sb)) by (apply rnd_nonnegative; nra).
      generalize (rnd_lower (k * sb) ltac:(nra)). fold q. intros D1.
      generalize (sum_relative sa (fl (k * sb)) SA (rnd_number _) PA PP). fold q. intros D2.
      generalize (sum_relative (fl (sa + fl (k * sb))) (4 * eta) (rnd_number _) number_4_eta
                    ltac:(apply rnd_nonnegative; lra) ltac:(lra)). fold q. intros D3.
      apply Rle_trans with (2 := D3).
      apply Rle_trans with (((sa + (Rabs (a / b) * sb * q - h)) * q + 4 * eta) * q).
      + set (T := Rabs (a / b) * sb). assert (0 <= T) by (apply Rmult_le_pos; lra).
        replace ((sa + T) * (q * q * q)) with ((sa + T) * (q * q) * q) by ring.
        apply Rmult_le_compat_r; [lra |].
        assert (sa * (q * q) <= sa * q) by (apply Rmult_le_compat_l; nra).
        assert (h * q <= eta) by nra. lra.
      + apply Rmult_le_compat_r; [lra |]. apply Rplus_le_compat_r.
        apply Rle_trans with (2 := D2). apply Rmult_le_compat_r; [lra |].
        apply Rplus_le_compat_l. apply Rle_trans with (2 := D1).
        apply Rplus_le_compat_r, Rmult_le_compat_r; [lra |].
        apply Rmult_le_compat_r; lra.
    - assert (E0 : sb = 0) by lra. rewrite E0, !Rmult_0_r, !Rplus_0_r.
      rewrite rnd_0, !Rplus_0_r, (rnd_exact sa SA), (rnd_exact sa SA).
      assert (q * q <= 1) by nra. assert (q * q * q <= 1) by nra. nra. }
  assert (PN : 0 <= N).
  { apply Rle_trans with (2 := HN). apply Rmult_le_pos. nra. repeat apply Rmult_le_pos; lra. }
  (* and the quotient by the distance *)
  assert (HI : Z * (q * q * q * q) <= N / d).
  { apply Rle_trans with ((sa + Rabs (a / b) * sb) * (q * q * q) / (D * (1 + r))).
    - unfold Z.
      replace ((sa + Rabs (a / b) * sb) * (q * q * q) / (D * (1 + r)))
        with ((sa + Rabs (a / b) * sb) / D * (q * q * q) * / (1 + r)) by (field; lra).
      fold Z. replace (Z * (q * q * q * q)) with (Z * (q * q * q) * q) by ring.
      apply Rmult_le_compat_l.
      + apply Rmult_le_pos; auto. repeat apply Rmult_le_pos; lra.
      + apply Rmult_le_reg_r with (1 + r); [lra |]. rewrite Rinv_l by lra. unfold q. nra.
    - apply Rmult_le_compat; auto.
      + apply Rmult_le_pos. nra. repeat apply Rmult_le_pos; lra.
      + apply Rlt_le, Rinv_0_lt_compat. nra.
      + apply Rinv_le; auto. }
  assert (PI : 0 <= N / d).
  { apply Rmult_le_pos; auto. now apply Rlt_le, Rinv_0_lt_compat. }
  assert (PIr : 0 <= I) by now apply rnd_nonnegative.
  assert (HJ : Z - h * (1 + f) <= inflated I).
  { rewrite inflated_exact. destruct (quotient_inflated p emin direction q h q_1 (error_h _ _ _ _ _ E) (proj1 leaves)
      (proj2 leaves) Z (N / d) f PZ f_1 f_q5 HI PI) as (Below & Above).
    destruct (Rlt_or_le I smallest_normal) as [C | C]; [now apply Below |]. specialize (Above C). fold I in Above.
    assert (Z * 1 <= Z * (f * (q * q * q * q * q * q))) by (apply Rmult_le_compat_l; auto).
    assert (0 <= h * (1 + f)) by (apply Rmult_le_pos; lra). lra. }
  (* all together *)
  apply Rle_trans with (R + inflated I + 4 * eta).
  - apply Rle_trans with (R + h + Z).
    + apply within_through with (a / b); [apply rounding_any | now apply quotient_inherits].
    + lra.
  - apply inflated_sum_left; try apply rnd_number; auto using number_4_eta; try lra.
    + apply rounding_nonnegative.
    + rewrite inflated_exact. apply rnd_nonnegative. apply Rmult_le_pos; lra.
Qed.

Lemma scale_sound a x sa e :
  number a -> number sa -> Rabs (a - x) <= sa ->
  Rabs (fl (a * bpow radix2 e) - x * bpow radix2 e) <= tight_scale (fl (a * bpow radix2 e)) a sa e.
Proof.
  apply (scaled_error_sound p emin direction r h E). intros s S P.
  generalize (error_h _ _ _ _ _ E) (eta_positive emin). intros Ph Pe.
  rewrite (rnd_exact (2 * eta) number_2_eta).
  rewrite <- (rnd_exact (fl (s + 2 * eta))) by apply rnd_number.
  rewrite <- (Rplus_0_r (fl (s + 2 * eta))). apply Rle_trans with (s + 2 * eta + 0); [lra |].
  apply inflated_sum_left; auto using number_2_eta, number_0; lra.
Qed.

End Proof.

(** The factor 1 + 8 eps covers six roundings: of eps each from 5 bits on, of u from 3 bits on. *)
Lemma six_roundings_any e : 0 <= e <= / 16 -> 1 <= (1 + 8 * e) * (1 - e) ^ 6.
Proof. intros H. nra. Qed.
Lemma six_roundings_nearest e : 0 <= e <= / 8 -> 1 <= (1 + 16 * e) * (1 - e) ^ 6.
Proof. intros H. nra. Qed.

Theorem tight_exact_sound x : Rabs (x - x) <= tight_exact x.
Proof.
  unfold tight_exact. replace (x - x) with 0 by ring. rewrite Rabs_R0, rnd_0. lra.
Qed.
Theorem tight_within_sound a x error :
  number error -> Rabs (a - x) <= error -> Rabs (a - x) <= tight_within a error.
Proof.
  intros N H. unfold tight_within. replace (a - a) with 0 by ring.
  now rewrite rnd_0, Rplus_0_r, rnd_exact.
Qed.

(** The code's bounds are numbers, so results may be operands. *)
Theorem tight_add_number v sa sb : number (tight_add v sa sb).
Proof. apply Upper.sum_of_bounds_number, rnd_number; auto. Qed.
Theorem tight_multiply_number v a sa b sb : number (tight_multiply v a sa b sb).
Proof. unfold tight_multiply. destruct (_ || _); apply rnd_number. Qed.
Theorem tight_divide_number v a sa b sb bound :
  tight_divide v a sa b sb = Some bound -> number bound.
Proof.
  unfold tight_divide. cbv zeta. destruct (negb _); [discriminate |].
  destruct (is_zero a sa); intros G; injection G as <-; apply rnd_number.
Qed.

End Tight.

(** The theorems: the returned bound holds for the computed value. *)
Section Sound.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (emin_p : (emin <= - p)%Z).
Notation number := (number p emin).

Section Any_direction.

Context (p_5 : (5 <= p)%Z) (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation fl := (rnd p emin direction).

Lemma eps_16 : 0 <= eps p <= / 16.
Proof. generalize (eps_positive p) (eps_le p 5 p_5). simpl. lra. Qed.
Let error : rounding_error p emin direction (eps p) (eta emin) :=
  rounding_error_any p emin direction ltac:(lia).
Lemma any_q6 : 1 <= (1 + 8 * eps p) * ((1 - eps p) * (1 - eps p) * (1 - eps p) *
                                        (1 - eps p) * (1 - eps p) * (1 - eps p)).
Proof. apply Rle_trans with (1 := six_roundings_any _ eps_16). right. ring. Qed.
Lemma any_h : eta emin * (2 + (1 + 8 * eps p)) <= 4 * eta emin.
Proof. generalize eps_16 (eta_positive emin). nra. Qed.

Theorem tight_add_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= tight_add p emin direction (fl (a + b)) sa sb.
Proof. apply (add_sound p emin direction ltac:(lia) emin_p _ _ error any_q6). Qed.

Theorem tight_subtract_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a - b) - (x - y)) <= tight_add p emin direction (fl (a - b)) sa sb.
Proof. intros. apply tight_add_sound; auto using number_opp, within_opp. Qed.

Theorem tight_multiply_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a * b) - x * y) <= tight_multiply p emin direction (fl (a * b)) a sa b sb.
Proof. apply (multiply_sound p emin direction ltac:(lia) emin_p _ _ error any_q6). Qed.

Theorem tight_divide_sound a x sa b y sb bound :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  tight_divide p emin direction (fl (a / b)) a sa b sb = Some bound ->
  y <> 0 /\ Rabs (fl (a / b) - x / y) <= bound.
Proof. apply (divide_sound p emin direction ltac:(lia) emin_p _ _ error any_q6 any_h). Qed.

Theorem tight_scale_sound a x sa e :
  number a -> number sa -> Rabs (a - x) <= sa ->
  Rabs (fl (a * bpow radix2 e) - x * bpow radix2 e) <=
    tight_scale p emin direction (fl (a * bpow radix2 e)) a sa e.
Proof. apply (scale_sound p emin direction ltac:(lia) emin_p _ _ error any_q6). Qed.

End Any_direction.

Section To_nearest.

Hypothesis p_3 : (3 <= p)%Z.
Notation fl := (rnd p emin nearest).

Lemma u_8 : 0 <= u p <= / 8.
Proof.
  generalize (u_positive p) (eps_le p 3 p_3) (eps_2u p). simpl. lra.
Qed.
Let error : rounding_error p emin nearest (u p) (eta emin / 2) :=
  rounding_error_nearest p emin ltac:(lia).
Lemma nearest_q6 : 1 <= (1 + 8 * eps p) * ((1 - u p) * (1 - u p) * (1 - u p) *
                                            (1 - u p) * (1 - u p) * (1 - u p)).
Proof.
  rewrite eps_2u. apply Rle_trans with (1 := six_roundings_nearest _ u_8). right. ring.
Qed.
Lemma nearest_h : eta emin / 2 * (2 + (1 + 8 * eps p)) <= 4 * eta emin.
Proof. rewrite eps_2u. generalize u_8 (eta_positive emin). nra. Qed.

Theorem tight_add_sound_nearest a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= tight_add p emin nearest (fl (a + b)) sa sb.
Proof. apply (add_sound p emin nearest p_3 emin_p _ _ error nearest_q6). Qed.

(** The sum in the code, and the first of its two bounds. *)
Lemma tight_sum_error_nearest a x sa b y sb :
  number a -> number b -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= rounding p emin nearest (fl (a + b)) + (sa + sb).
Proof. exact (sum_error_at_most p emin nearest p_3 emin_p a x sa b y sb). Qed.
Lemma tight_difference_error_nearest a x sa b y sb :
  number a -> number b -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a - b) - (x - y)) <= rounding p emin nearest (fl (a - b)) + (sa + sb).
Proof. intros. apply tight_sum_error_nearest; auto using number_opp, within_opp. Qed.
Lemma tight_enlarged_sound_nearest v sa sb : number sa -> number sb -> 0 <= sa -> 0 <= sb ->
  rounding p emin nearest v + (sa + sb) <= tight_enlarged p emin nearest v sa sb.
Proof. apply (enlarged_sound p emin nearest p_3 emin_p _ _ error nearest_q6). Qed.

Theorem tight_subtract_sound_nearest a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a - b) - (x - y)) <= tight_add p emin nearest (fl (a - b)) sa sb.
Proof. intros. apply tight_add_sound_nearest; auto using number_opp, within_opp. Qed.

Theorem tight_multiply_sound_nearest a x sa b y sb :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a * b) - x * y) <= tight_multiply p emin nearest (fl (a * b)) a sa b sb.
Proof. apply (multiply_sound p emin nearest p_3 emin_p _ _ error nearest_q6). Qed.

Theorem tight_divide_sound_nearest a x sa b y sb bound :
  number a -> number b -> number sa -> number sb ->
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  tight_divide p emin nearest (fl (a / b)) a sa b sb = Some bound ->
  y <> 0 /\ Rabs (fl (a / b) - x / y) <= bound.
Proof. apply (divide_sound p emin nearest p_3 emin_p _ _ error nearest_q6 nearest_h). Qed.

Theorem tight_scale_sound_nearest a x sa e :
  number a -> number sa -> Rabs (a - x) <= sa ->
  Rabs (fl (a * bpow radix2 e) - x * bpow radix2 e) <=
    tight_scale p emin nearest (fl (a * bpow radix2 e)) a sa e.
Proof. apply (scale_sound p emin nearest p_3 emin_p _ _ error nearest_q6). Qed.

End To_nearest.
End Sound.
