(** Sums, products and quotients rounded upwards without touching the rounding mode, as the rules `affine`
    and `relative` do (include/errbound/rules/affine.hpp, relative.hpp): x times 1 + eps, rounded to nearest,
    is at least the successor of a normal x. What is subnormal gets eta more, or was exact. Lemmas for
    Affine.v and Relative.v. *)

From Coq Require Import Reals ZArith Lia Lra Psatz.
From Flocq Require Import Core.
From Errbound Require Import Format.
Open Scope R_scope.

Section Upper.

Variables p emin : Z.
Context {p_positive : Prec_gt_0 p}.

Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).
Notation ulp := (ulp radix2 (FLT_exp emin p)).

Definition upper (x : R) : R := fl (x * fl (1 + eps)).

Hypothesis emin_p : (emin <= - p - 1)%Z.
Hypothesis p_2 : (2 <= p)%Z.

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
Lemma ulp_nonnegative x : 0 <= ulp x.
Proof. apply ulp_ge_0. Qed.

Lemma upper_covers z : smallest_normal <= fl z -> z <= upper (fl z).
Proof.
  intros H. generalize (half_ulp z) (ulp_nonnegative (fl z)). intros E U.
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
(** Of anything that is not negative. *)
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

(** Below its exact value, once what is rounded is normal. *)
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
