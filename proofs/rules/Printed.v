(** Counterexamples to the rule as the TightCCD paper prints it, compared with theorems of Tight.v and Sign.v about
    the code. Rounding to nearest, from p = 3. Results:
        printed_sign_at_zero    Sign returns positive for an exact zero
        printed_sign_at_bound   and for a number that may be zero
        printed_product_lost    the bound of a product that underflows is wrong
        printed_sum_rounded     so is that of a sum whose bound is rounded *)

From Coq Require Import Reals ZArith Lia Lra.
From Flocq Require Import Core.
From Errbound Require Import Format Sign Comparison.
Open Scope R_scope.

Section Printed.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (p_3 : (3 <= p)%Z) (emin_p : (emin <= - p - 1)%Z).
Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).

(** Section 4.1: 1 from sigma on, -1 from -sigma down, otherwise 0, which means undetermined. *)
Definition printed_sign (value error : R) : sign :=
  if Rle_bool error value then positive
  else if Rle_bool value (- error) then negative
  else uncertain.

Theorem printed_sign_at_zero : ~ sign_is_right (printed_sign 0 0) 0.
Proof. unfold printed_sign. rewrite Rle_bool_true by lra. simpl. lra. Qed.
Theorem printed_sign_at_bound e : 0 <= e ->
  exists v x, Rabs (v - x) <= e /\ ~ sign_is_right (printed_sign v e) x.
Proof.
  intros P. exists e, 0. rewrite Rminus_0_r, Rabs_pos_eq by auto. split; [lra |].
  unfold printed_sign. rewrite Rle_bool_true by lra. simpl. lra.
Qed.

(** eta eta with exact factors: the product underflows to 0, and the printed bound is 0. *)
Theorem printed_product_lost : number eta /\
  tight_product eps (fl (eta * eta)) eta 0 eta 0 = 0 /\ 0 < Rabs (fl (eta * eta) - eta * eta).
Proof.
  generalize (number_eta p emin) (eta_positive emin). intros N P.
  assert (Z : fl (eta * eta) = 0).
  { unfold Format.eta. rewrite <- bpow_plus.
    apply round_N_small_pos with (emin + emin + 1)%Z; auto with typeclass_instances.
    - split; [apply bpow_le | apply bpow_lt]; lia.
    - unfold FLT_exp. lia. }
  split; auto. rewrite Z. unfold tight_product.
  replace (0 - eta * eta) with (- (eta * eta)) by ring. assert (0 < eta * eta) by nra.
  rewrite Rabs_Ropp, Rabs_R0, (Rabs_pos_eq (eta * eta)) by lra.
  split; [unfold Rdiv; ring | lra].
Qed.

(** 1 and -1, known to within 1 and eta, stand for 0 and -1 - eta: the bound is rounded to 1, the error is 1 + eta. *)
Theorem printed_sum_rounded (a := 1) (x := 0) (sa := 1) (b := -1) (y := -1 - eta) (sb := eta) :
  number a /\ number b /\ number sa /\ number sb /\ Rabs (a - x) <= sa /\ Rabs (b - y) <= sb /\
  fl (fl (fl (fl (Rabs (fl (a + b)) * eps) / fl (1 - eps)) + sa) + sb) = 1 /\
  Rabs (fl (a + b) - (x + y)) = 1 + eta.
Proof.
  subst a x sa b y sb.
  assert (N1 : number 1) by (change 1 with (bpow radix2 0); apply number_power; auto; lia).
  generalize (number_eta p emin) (eta_positive emin) (Format.rnd_0 p emin nearest). intros N P Z.
  split; [auto |]. split; [now apply number_opp |]. split; [auto |]. split; [auto |].
  replace (1 - 0) with 1 by ring. replace (-1 - (-1 - eta)) with eta by ring.
  rewrite Rabs_R1, Rabs_pos_eq by lra. split; [lra |]. split; [lra |].
  replace (1 + -1) with 0 by ring. rewrite Z, Rabs_R0, Rmult_0_l, Z. unfold Rdiv. rewrite Rmult_0_l, Z.
  rewrite Rplus_0_l, (rnd_exact p emin nearest 1 N1).
  rewrite eta_lost by auto. split; [easy |].
  replace (0 - (0 + (-1 - eta))) with (1 + eta) by ring. rewrite Rabs_pos_eq; lra.
Qed.

End Printed.
