(** Theorem 2 of the TightCCD paper: TightBound never exceeds SafeBound. Bounds as printed, in exact arithmetic, for
    + − ×. Results:
        tight_at_most_safe     it holds if SafeBound's magnitudes are chosen as the paper requires next to the
            theorem:
                               B >= |v|/(1 - eps) for every number v of the expression
        tight_may_exceed_safe  it does not hold if only B = |a|: a = b = 1 is a counterexample *)

From Coq Require Import Reals Lra Lia Psatz.
Open Scope R_scope.

Section Comparison.

Context (eps : R) (eps_range : 0 < eps < 1).

Definition tight_sum (v sa sb : R) : R := Rabs v * eps / (1 - eps) + sa + sb.
Definition tight_product (v a sa b sb : R) : R :=
  Rabs v * eps / (1 - eps) + Rabs a * sb + sa * Rabs b + sa * sb.
Definition safe (B : R) (k : nat) : R := B * ((1 + eps) ^ k - 1).

(** v, computed by an expression, has TightBound s and SafeBound (B, k). Differences are sums with the opposite of an
    operand, which changes neither bound. *)
Inductive bounded : R -> R -> R -> nat -> Prop :=
| exact_number v B : Rabs v / (1 - eps) <= B -> bounded v 0 B 0
| sum a sa Ba ka b sb Bb kb v :
    bounded a sa Ba ka -> bounded b sb Bb kb -> Rabs v / (1 - eps) <= Ba + Bb ->
    bounded v (tight_sum v sa sb) (Ba + Bb) (S (Nat.max ka kb))
| product a sa Ba ka b sb Bb kb v :
    bounded a sa Ba ka -> bounded b sb Bb kb -> Rabs v / (1 - eps) <= Ba * Bb ->
    bounded v (tight_product v a sa b sb) (Ba * Bb) (S (ka + kb)).

Lemma power_1 k : 1 <= (1 + eps) ^ k.
Proof. apply pow_R1_Rle. lra. Qed.
Lemma power_le k l : (k <= l)%nat -> (1 + eps) ^ k <= (1 + eps) ^ l.
Proof. apply Rle_pow. lra. Qed.
Lemma magnitude v B : Rabs v / (1 - eps) <= B -> Rabs v <= B.
Proof.
  intros H. apply Rle_trans with (2 := H). generalize (Rabs_pos v). intros P.
  apply Rmult_le_reg_r with (1 - eps); [lra |].
  unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. nra.
Qed.

Lemma bounded_range v s B k : bounded v s B k -> 0 <= s /\ Rabs v <= B.
Proof.
  assert (Q : forall v, 0 <= Rabs v * eps / (1 - eps)).
  { intros w. unfold Rdiv. repeat apply Rmult_le_pos; try lra. apply Rabs_pos.
    apply Rlt_le, Rinv_0_lt_compat. lra. }
  induction 1 as [v B H | a sa Ba ka b sb Bb kb v _ [A1 A2] _ [B1 B2] H
                  | a sa Ba ka b sb Bb kb v _ [A1 A2] _ [B1 B2] H];
    (split; [| now apply magnitude]).
  - lra.
  - unfold tight_sum. generalize (Q v). lra.
  - unfold tight_product. generalize (Q v). intros.
    generalize (Rabs_pos a) (Rabs_pos b). intros.
    assert (0 <= Rabs a * sb) by (apply Rmult_le_pos; auto).
    assert (0 <= sa * Rabs b) by (apply Rmult_le_pos; auto).
    assert (0 <= sa * sb) by (apply Rmult_le_pos; auto). lra.
Qed.

Theorem tight_at_most_safe v s B k : bounded v s B k -> s <= safe B k.
Proof.
  unfold safe.
  induction 1 as [v B H | a sa Ba ka b sb Bb kb v HA IHA HB IHB H
                  | a sa Ba ka b sb Bb kb v HA IHA HB IHB H].
  - simpl. lra.
  - apply bounded_range in HA, HB. destruct HA as [A1 A2], HB as [B1 B2].
    generalize (Rabs_pos a) (Rabs_pos b). intros.
    set (G := (1 + eps) ^ Nat.max ka kb).
    assert ((1 + eps) ^ ka <= G) by (apply power_le; lia).
    assert ((1 + eps) ^ kb <= G) by (apply power_le; lia).
    assert (1 <= G) by apply power_1.
    rewrite <- tech_pow_Rmult. fold G. unfold tight_sum.
    assert (V : Rabs v * eps / (1 - eps) <= (Ba + Bb) * eps).
    { replace (Rabs v * eps / (1 - eps)) with (Rabs v / (1 - eps) * eps) by (field; lra).
      apply Rmult_le_compat_r; lra. }
    assert (Ba * ((1 + eps) ^ ka - 1) <= Ba * (G - 1)) by (apply Rmult_le_compat_l; lra).
    assert (Bb * ((1 + eps) ^ kb - 1) <= Bb * (G - 1)) by (apply Rmult_le_compat_l; lra).
    assert ((Ba + Bb) * eps * 1 <= (Ba + Bb) * eps * G).
    { apply Rmult_le_compat_l; [| lra]. apply Rmult_le_pos; lra. }
    lra.
  - apply bounded_range in HA, HB. destruct HA as [A1 A2], HB as [B1 B2].
    generalize (Rabs_pos a) (Rabs_pos b). intros.
    set (Ga := (1 + eps) ^ ka) in *. set (Gb := (1 + eps) ^ kb) in *.
    assert (1 <= Ga) by apply power_1. assert (1 <= Gb) by apply power_1.
    rewrite <- tech_pow_Rmult, pow_add. fold Ga Gb. unfold tight_product.
    assert (V : Rabs v * eps / (1 - eps) <= Ba * Bb * eps).
    { replace (Rabs v * eps / (1 - eps)) with (Rabs v / (1 - eps) * eps) by (field; lra).
      apply Rmult_le_compat_r; lra. }
    assert (Rabs a * sb <= Ba * (Bb * (Gb - 1))) by (apply Rmult_le_compat; lra).
    assert (sa * Rabs b <= Ba * (Ga - 1) * Bb) by (apply Rmult_le_compat; lra).
    assert (sa * sb <= Ba * (Ga - 1) * (Bb * (Gb - 1))) by (apply Rmult_le_compat; lra).
    assert (0 <= Ba * Bb * eps) by (repeat apply Rmult_le_pos; lra).
    assert (1 * 1 <= Ga * Gb) by (apply Rmult_le_compat; lra).
    assert (Ba * Bb * eps * 1 <= Ba * Bb * eps * (Ga * Gb)) by (apply Rmult_le_compat_l; lra).
    lra.
Qed.

(** 1 + 1 = 2 without any error: TightBound is 2 eps/(1 - eps), SafeBound (|1| + |1|, 1) is 2 eps. *)
Theorem tight_may_exceed_safe : safe (Rabs 1 + Rabs 1) 1 < tight_sum (1 + 1) 0 0.
Proof.
  unfold safe, tight_sum. rewrite (Rabs_pos_eq 1), (Rabs_pos_eq (1 + 1)) by lra. simpl.
  apply Rmult_lt_reg_r with (1 - eps); [lra |].
  replace (((1 + 1) * eps / (1 - eps) + 0 + 0) * (1 - eps)) with ((1 + 1) * eps) by (field; lra).
  nra.
Qed.

End Comparison.
