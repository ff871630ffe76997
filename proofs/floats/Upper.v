(** Sums, products and quotients rounded upwards without a change of the rounding mode, as in the rules `affine` and
    `relative` (include/errbound/rules/affine.hpp, relative.hpp). x times 1 + eps, rounded to nearest, is at least
    the successor of a normal x. A subnormal number gets eta more, or was exact. Lemmas for Affine.v and Relative.v.

    Sums of bounds, rounded in any one direction, as in detail/sum_of_bounds.hpp for the rules `tight`, `sharp` and
    `residual`: sum_above x y is x + y if that is a number. Otherwise it is the rounded sum or, if that is less, the
    rounded sum times 1 + eps. Results:
        sum_above_sound, sum_above_exact, sum_above_least   it is at least x + y, equal if that is a number, and at
            most the rounded z(1 + eps) for any number z >= x + y
        sum_of_bounds_sound, sum_of_bounds_at_most   `sum_of_bounds` covers a sum of bounds, and is at most the
            bound with a factor for its roundings *)

From Coq Require Import Reals ZArith Lia Lra Psatz.
From Flocq Require Import Core Sterbenz.
From Errbound Require Import Format.
Open Scope R_scope.

Section Upper.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.

Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).
Notation ulp := (ulp radix2 (FLT_exp emin p)).

Definition upper (x : R) : R := fl (x * fl (1 + eps)).

Context (emin_p : (emin <= - p - 1)%Z) (p_2 : (2 <= p)%Z).

Lemma one_plus_eps : fl (1 + eps) = 1 + eps.
Proof. apply rnd_exact; auto with typeclass_instances. apply (number_1_power p emin 1); auto; lia. Qed.
Lemma upper_number x : number (upper x).
Proof. apply rnd_number; auto with typeclass_instances. Qed.
Lemma upper_le x : number x -> 0 <= x -> x <= upper x.
Proof.
  intros N P. unfold upper. rewrite one_plus_eps. apply rnd_above; auto with typeclass_instances.
  generalize (eps_positive p). nra.
Qed.
Lemma upper_succ x : number x -> smallest_normal <= x -> x + ulp x <= upper x.
Proof.
  intros N H. generalize (smallest_normal_positive p emin). intros P. unfold upper.
  rewrite one_plus_eps. rewrite <- succ_eq_pos by lra. apply rnd_above; auto with typeclass_instances.
  - apply generic_format_succ; auto with typeclass_instances.
  - rewrite succ_eq_pos by lra. rewrite Rmult_plus_distr_l, Rmult_1_r. apply Rplus_le_compat_l.
    rewrite <- (Rabs_pos_eq x) at 2 by lra. apply ulp_FLT_le.
    rewrite Rabs_pos_eq by lra. unfold Format.smallest_normal in H.
    now replace (emin + p - 1)%Z with (emin + p - 1)%Z by lia.
Qed.
Lemma half_ulp z : Rabs (fl z - z) <= / 2 * ulp (fl z).
Proof. apply error_le_half_ulp_round; auto with typeclass_instances. Qed.

Lemma upper_covers z : smallest_normal <= fl z -> z <= upper (fl z).
Proof.
  intros H. generalize (half_ulp z) (ulp_ge_0 radix2 (FLT_exp emin p) (fl z)). intros E U.
  apply Rabs_le_inv in E. apply Rle_trans with (fl z + ulp (fl z)); [lra |].
  apply upper_succ; auto. apply rnd_number; auto with typeclass_instances.
Qed.
Lemma upper_covers_sum x y : number x -> number y -> 0 <= x + y -> x + y <= upper (fl (x + y)).
Proof.
  intros X Y P. destruct (Rle_or_lt smallest_normal (fl (x + y))) as [H | H]; [now apply upper_covers |].
  assert (E : fl (x + y) = x + y).
  { apply sum_exact_below; auto with typeclass_instances. rewrite Rabs_pos_eq by auto. apply Rnot_le_lt. intros C.
    assert (smallest_normal <= fl (x + y)); [| lra].
    apply (rnd_above p emin nearest); [apply number_smallest_normal; exact p_positive | exact C]. }
  rewrite E. apply upper_le; auto. rewrite <- E. apply rnd_number; auto with typeclass_instances.
Qed.
Lemma ulp_small x : 0 <= x -> x < smallest_normal -> ulp x = eta.
Proof.
  intros P B. apply ulp_FLT_small; auto. rewrite Rabs_pos_eq by auto.
  apply Rlt_le_trans with (1 := B). apply bpow_le. lia.
Qed.
Lemma upper_eta_small x : number x -> 0 <= x -> x < smallest_normal -> x + eta <= fl (upper x + eta).
Proof.
  intros N P B. apply rnd_above; auto with typeclass_instances.
  - rewrite <- (ulp_small x), <- succ_eq_pos by auto. apply generic_format_succ; auto with typeclass_instances.
  - apply Rplus_le_compat_r. now apply upper_le.
Qed.
(** For any nonnegative number. *)
Lemma upper_eta_covers z : 0 <= z -> z <= fl (upper (fl z) + eta).
Proof.
  intros P. generalize (eta_positive emin) (half_ulp z). intros E H. apply Rabs_le_inv in H.
  assert (F : 0 <= fl z) by (apply rnd_nonnegative; auto with typeclass_instances).
  assert (N : number (fl z)) by (apply rnd_number; auto with typeclass_instances).
  destruct (Rle_or_lt smallest_normal (fl z)) as [B | B].
  - apply Rle_trans with (upper (fl z)); [now apply upper_covers |].
    apply rnd_above; auto with typeclass_instances; [apply upper_number | lra].
  - rewrite (ulp_small (fl z)) in H by auto. generalize (upper_eta_small (fl z) N F B). lra.
Qed.

(** Below its exact value, if the rounded number is normal. *)
Lemma lower_sum_sound a b : number a -> number b -> fl (a + b) <> a + b ->
  fl (Rabs (fl (a + b)) * fl (1 - eps)) <= Rabs (a + b).
Proof.
  intros A B H. generalize (smallest_normal_positive p emin) (eps_positive p). intros SP EP.
  assert (N : smallest_normal <= Rabs (a + b)).
  { apply Rnot_lt_le. intros C. apply H. now apply sum_exact_below; auto with typeclass_instances. }
  assert (E : fl (1 - eps) = 1 - eps).
  { apply rnd_exact; auto with typeclass_instances.
    replace (1 - eps) with (IZR (2 ^ (p - 1) - 1) * bpow radix2 (1 - p)).
    - apply number_integer; auto; [lia |].
      assert (2 ^ p = 2 * 2 ^ (p - 1))%Z.
      { replace p with (1 + (p - 1))%Z at 1 by lia. rewrite Z.pow_add_r by lia. reflexivity. }
      assert (2 ^ 1 <= 2 ^ (p - 1))%Z by (apply Z.pow_le_mono_r; lia). lia.
    - rewrite minus_IZR. change 2%Z with (radix_val radix2) at 1. rewrite IZR_Zpower by lia.
      rewrite Rmult_minus_distr_r, <- bpow_plus. replace (p - 1 + (1 - p))%Z with 0%Z by lia.
      unfold Format.eps. change (bpow radix2 0) with 1. ring. }
  rewrite E. assert (S : Rabs (fl (a + b)) = fl (Rabs (a + b))).
  { symmetry. apply round_NE_abs; auto with typeclass_instances. }
  rewrite S. set (s := Rabs (a + b)) in *.
  assert (V : smallest_normal <= fl s).
  { apply rnd_above; auto with typeclass_instances. now apply number_smallest_normal. }
  apply Rnot_lt_le. intros C.
  assert (Y : fl s <= fl (fl s * (1 - eps))) by (apply rnd_below; auto using rnd_number with typeclass_instances; lra).
  assert (Z : fl (fl s * (1 - eps)) <= fl s).
  { apply rnd_below; auto using rnd_number with typeclass_instances.
    apply Rle_trans with (fl s * 1); [apply Rmult_le_compat_l; lra | lra]. }
  assert (T : fl (fl s * (1 - eps)) = fl s) by lra.
  generalize (half_ulp (fl s * (1 - eps))). rewrite T. intros D.
  assert (U : ulp (fl s) <= fl s * eps).
  { rewrite <- (Rabs_pos_eq (fl s)) at 2 by lra. apply ulp_FLT_le. rewrite Rabs_pos_eq by lra. exact V. }
  assert (P : 0 < fl s * eps) by (apply Rmult_lt_0_compat; lra).
  apply Rabs_le_inv in D. lra.
Qed.
End Upper.

Section Sum_of_bounds.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (direction : R -> Z) {direction_valid : Valid_rnd direction}.

Notation fl := (rnd p emin direction).
Notation number := (number p emin).
Notation eps := (eps p).
Notation smallest_normal := (smallest_normal p emin).
Notation ulp := (ulp radix2 (FLT_exp emin p)).
Notation succ := (succ radix2 (FLT_exp emin p)).

(** The code, in its order of evaluation. *)
Definition sum_above (x y : R) : R :=
  let sum := fl (x + y) in
  if Rlt_bool (fl (sum - Rmax x y)) (Rmin x y) then fl (sum * fl (1 + eps)) else sum.
Definition sum_of_bounds (enlarged own x y : R) : R :=
  if (40 <=? p)%Z then enlarged
  else if Rlt_bool (fl (own * bpow radix2 (Z.max 0 (p - 11)))) (fl (x + y)) then
    let careful := sum_above own (sum_above x y) in
    if Rlt_bool careful enlarged then careful else enlarged
  else enlarged.

Context (p_2 : (2 <= p)%Z) (emin_p : (emin <= - p)%Z).

Lemma one_and_eps : fl (1 + eps) = 1 + eps.
Proof. apply rnd_exact; auto. apply (number_1_power p emin 1); auto; lia. Qed.
Lemma sum_above_number x y : number (sum_above x y).
Proof. unfold sum_above. cbv zeta. destruct Rlt_bool; now apply rnd_number. Qed.

(** The successor of a normal number. *)
Lemma succ_below s : number s -> smallest_normal <= s -> succ s <= fl (s * (1 + eps)).
Proof.
  intros N H. generalize (smallest_normal_positive p emin). intros P. apply rnd_above; auto.
  - apply generic_format_succ; auto with typeclass_instances.
  - rewrite succ_eq_pos by lra. rewrite Rmult_plus_distr_l, Rmult_1_r. apply Rplus_le_compat_l.
    rewrite <- (Rabs_pos_eq s) at 2 by lra. apply ulp_FLT_le.
    rewrite Rabs_pos_eq by lra. unfold Format.smallest_normal in H.
    now replace (emin + p - 1)%Z with (emin + p - 1)%Z by lia.
Qed.

Theorem sum_above_sound x y : number x -> number y -> 0 <= x -> 0 <= y -> x + y <= sum_above x y.
Proof.
  intros X Y PX PY. unfold sum_above. cbv zeta. set (l := Rmax x y). set (m := Rmin x y).
  assert (E : x + y = l + m) by (unfold l, m, Rmax, Rmin; destruct (Rle_dec x y); lra).
  assert (L : number l) by (unfold l, Rmax; now destruct (Rle_dec x y)).
  assert (B : 0 <= m <= l) by (unfold l, m, Rmax, Rmin; destruct (Rle_dec x y); lra).
  rewrite E. set (s := fl (l + m)). assert (S : number s) by now apply rnd_number.
  assert (D : fl (s - l) = s - l).
  { apply rnd_exact; auto. apply sterbenz; auto with typeclass_instances.
    assert (l <= s) by (apply rnd_above; auto; lra).
    assert (s <= 2 * l); [| lra]. apply rnd_below; auto; [| lra].
    rewrite Rmult_comm. change 2 with (bpow radix2 1). rewrite <- (scale_up p emin direction) by (auto; lia).
    now apply rnd_number. }
  rewrite D, one_and_eps. case Rlt_bool_spec; intros C; [| lra].
  assert (N : smallest_normal <= s).
  { apply Rnot_lt_le. intros K. enough (s = l + m) by lra. unfold s. apply sum_exact_below; auto.
    - unfold m, Rmin. now destruct (Rle_dec x y).
    - rewrite Rabs_pos_eq by lra. apply Rnot_le_lt. intros F.
      assert (smallest_normal <= s); [| lra]. apply rnd_above; auto. now apply number_smallest_normal. }
  apply Rle_trans with (2 := succ_below s S N). apply Rnot_lt_le. intros F.
  assert (succ s <= s).
  { apply (rnd_above p emin direction); auto; [| lra]. apply generic_format_succ; auto with typeclass_instances. }
  assert (s < succ s); [| lra]. apply succ_gt_id. generalize (smallest_normal_positive p emin). lra.
Qed.

(** It exceeds the least bound of the format by at most one last place. *)
Theorem sum_above_exact x y : number x -> number y -> 0 <= x -> 0 <= y -> number (x + y) -> sum_above x y = x + y.
Proof.
  intros X Y PX PY N. unfold sum_above. cbv zeta. rewrite (rnd_exact p emin direction (x + y) N).
  rewrite Rlt_bool_false; auto.
  replace (x + y - Rmax x y) with (Rmin x y) by (unfold Rmax, Rmin; destruct (Rle_dec x y); lra).
  rewrite rnd_exact; auto; [apply Rle_refl |]. unfold Rmin. now destruct (Rle_dec x y).
Qed.
Theorem sum_above_least x y z : 0 <= x -> 0 <= y -> number z -> x + y <= z -> sum_above x y <= fl (z * (1 + eps)).
Proof.
  intros PX PY Z H. unfold sum_above. cbv zeta. rewrite one_and_eps.
  assert (S : fl (x + y) <= z) by now apply rnd_below.
  assert (0 <= fl (x + y)) by (apply rnd_nonnegative; auto; lra). generalize (eps_positive p). intros P.
  destruct Rlt_bool.
  - apply rnd_le; auto. apply Rmult_le_compat_r; lra.
  - apply Rle_trans with (1 := S). apply rnd_above; auto. nra.
Qed.

Theorem sum_of_bounds_at_most enlarged own x y : sum_of_bounds enlarged own x y <= enlarged.
Proof.
  unfold sum_of_bounds. cbv zeta. destruct (40 <=? p)%Z; [apply Rle_refl |].
  destruct Rlt_bool; [| apply Rle_refl]. case Rlt_bool_spec; lra.
Qed.
Theorem sum_of_bounds_sound enlarged own x y e : number own -> number x -> number y ->
  0 <= own -> 0 <= x -> 0 <= y -> e <= own + (x + y) -> e <= enlarged -> e <= sum_of_bounds enlarged own x y.
Proof.
  intros O X Y PO PX PY H L. unfold sum_of_bounds. cbv zeta. destruct (40 <=? p)%Z; auto.
  destruct Rlt_bool; auto. destruct Rlt_bool; auto. apply Rle_trans with (1 := H).
  generalize (sum_above_sound x y X Y PX PY). intros S.
  apply Rle_trans with (own + sum_above x y); [lra |].
  apply sum_above_sound; auto using sum_above_number; lra.
Qed.
Lemma sum_of_bounds_number enlarged own x y : number enlarged -> number (sum_of_bounds enlarged own x y).
Proof.
  intros N. unfold sum_of_bounds. cbv zeta. destruct (40 <=? p)%Z; auto. destruct Rlt_bool; auto.
  destruct Rlt_bool; auto. apply sum_above_number.
Qed.

End Sum_of_bounds.
