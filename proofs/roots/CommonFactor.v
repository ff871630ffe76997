(** Common factors by images modulo primes (include/errbound/roots/integer_polynomial.hpp, prime_field.hpp):
    polynomials with integer coefficients, as lists, ascending. Results:
        images_in_ideal       a result of Euclid's algorithm modulo a prime is u a + v b modulo it
        divided_right         a returned quotient is right
        common_factor_right   the roots of common_factor's result are the common roots
        common_factor_divides, cofactors_rootless   it divides both, and the quotients have no common root
        chain_multiplicities  squarefree_chain: a root of multiplicity k is one of the first k polynomials
        vanishes_right        the polynomials' sign changes give these multiplicities *)

From Coq Require Import Reals ZArith Znumtheory Lia Lra List Classical Wf_nat.
From Errbound Require Import Sign Bernstein SignVariations RootIsolation.
Import ListNotations.
Open Scope Z_scope.

Definition coefficient (f : list Z) (i : nat) : Z := nth i f 0.
Definition same (f g : list Z) : Prop := forall i, coefficient f i = coefficient g i.
Fixpoint sum (f g : list Z) : list Z :=
  match f, g with a :: f, b :: g => a + b :: sum f g | [], g => g | f, [] => f end.
Definition multiple (c : Z) (f : list Z) : list Z := map (Z.mul c) f.
Fixpoint product (f g : list Z) : list Z :=
  match f with [] => [] | a :: l => sum (multiple a g) (0 :: product l g) end.

Lemma coefficient_sum f g i : coefficient (sum f g) i = coefficient f i + coefficient g i.
Proof.
  unfold coefficient. revert g i. induction f as [| a f IH]; intros [| b g] [| i]; simpl; try ring; try apply IH; destruct i; simpl; ring.
Qed.
Lemma coefficient_multiple c f i : coefficient (multiple c f) i = c * coefficient f i.
Proof. unfold coefficient, multiple. revert i. induction f as [| a f IH]; intros [| i]; simpl; try ring. apply IH. Qed.
Lemma coefficient_product a f g i : coefficient (product (a :: f) g) i =
  a * coefficient g i + match i with O => 0 | S i => coefficient (product f g) i end.
Proof. simpl. rewrite coefficient_sum, coefficient_multiple. now destruct i. Qed.
Lemma coefficient_nil i : coefficient [] i = 0.
Proof. now destruct i. Qed.

Lemma sum_at f g r : poly (sum f g) r = (poly f r + poly g r)%R.
Proof.
  unfold poly. revert g. induction f as [| a f IH]; intros [| b g]; simpl; try ring. rewrite IH, plus_IZR. ring.
Qed.
Lemma multiple_at c f r : poly (multiple c f) r = (IZR c * poly f r)%R.
Proof. unfold poly, multiple. induction f as [| a f IH]; simpl; [ring |]. rewrite IH, mult_IZR. ring. Qed.
Lemma product_at f g r : poly (product f g) r = (poly f r * poly g r)%R.
Proof.
  induction f as [| a f IH]; [unfold poly; simpl; ring |]. cbn [product]. rewrite sum_at, multiple_at.
  change (poly (0 :: product f g) r) with (0 + r * poly (product f g) r)%R. rewrite IH.
  change (poly (a :: f) r) with (IZR a + r * poly f r)%R. ring.
Qed.
Lemma zero_at f r : (forall i, coefficient f i = 0) -> poly f r = 0%R.
Proof.
  intros Z. induction f as [| a f IH]; [easy |]. change (poly (a :: f) r) with (IZR a + r * poly f r)%R.
  rewrite IH by (intros i; apply (Z (S i))). pose proof (Z 0%nat) as E. unfold coefficient in E. simpl in E. rewrite E. ring.
Qed.

(** ** Degrees modulo p, which is prime or 0 *)

Definition zero_or_prime (p : Z) : Prop := p = 0 \/ prime p.
(** d is the index of the last coefficient that p does not divide. *)
Definition degree (p : Z) (f : list Z) (d : nat) : Prop :=
  ~ (p | coefficient f d) /\ forall i, (d < i)%nat -> (p | coefficient f i).

Lemma divides_product p x y : zero_or_prime p -> (p | x * y) -> (p | x) \/ (p | y).
Proof.
  intros [-> | P] D; [| now apply prime_mult]. apply Z.divide_0_l in D. apply Z.mul_eq_0 in D.
  destruct D as [-> | ->]; [left | right]; apply Z.divide_refl.
Qed.
Lemma degree_unique p f d e : degree p f d -> degree p f e -> d = e.
Proof. intros (A & B) (C & D). destruct (lt_eq_lt_dec d e) as [[L | L] | L]; auto; exfalso; [now apply C, B | now apply A, D]. Qed.
Lemma degree_same p f g d : same f g -> degree p f d -> degree p g d.
Proof. intros E (A & B). split; [now rewrite <- E |]. intros i I. rewrite <- E. now apply B. Qed.
Lemma some_degree p f : (forall i, (p | coefficient f i)) \/ exists d, degree p f d.
Proof.
  induction f as [| a f [IH | (d & A & B)]].
  - left. intros i. rewrite coefficient_nil. apply Z.divide_0_r.
  - destruct (Zdivide_dec p a) as [D | N].
    + left. intros [| i]; [easy | apply IH].
    + right. exists 0%nat. split; auto. intros [| i] I; [lia | apply IH].
  - right. exists (S d). split; auto. intros [| i] I; [lia | apply B; lia].
Qed.
Lemma zero_product p f g : (forall i, (p | coefficient f i)) -> forall i, (p | coefficient (product f g) i).
Proof.
  induction f as [| a f IH]; intros Z i; [rewrite coefficient_nil; apply Z.divide_0_r |].
  rewrite coefficient_product. apply Z.divide_add_r; [apply Z.divide_mul_l, (Z 0%nat) |].
  destruct i; [apply Z.divide_0_r |]. apply IH. intros j. apply (Z (S j)).
Qed.
(** The degree and the last coefficient of a product. *)
Lemma degree_product p f g d e : zero_or_prime p -> degree p f d -> degree p g e -> degree p (product f g) (d + e) .
Proof.
  intros P. revert d. induction f as [| a f IH]; intros d (A & B) G; [exfalso; apply A; rewrite coefficient_nil; apply Z.divide_0_r |].
  destruct d as [| d].
  - assert (F : forall i, (p | coefficient f i)) by (intros i; apply (B (S i)); lia).
    pose proof (zero_product p f g F) as Zp. destruct G as (C & D). split.
    + rewrite coefficient_product. intros H. destruct (divides_product p a (coefficient g e) P) as [K | K]; auto.
      simpl in H.
      apply (Z.divide_add_cancel_r p (match e with O => 0 | S i => coefficient (product f g) i end)).
      * destruct e; [apply Z.divide_0_r | apply Zp].
      * now rewrite Z.add_comm.
    + intros i I. rewrite coefficient_product. apply Z.divide_add_r; [apply Z.divide_mul_r, D; lia |].
      destruct i; [apply Z.divide_0_r | apply Zp].
  - assert (F : degree p f d) by (split; [exact A | intros i I; apply (B (S i)); lia]).
    destruct (IH d F G) as (C & D). destruct G as (_ & G). split.
    + rewrite coefficient_product. simpl. intros H. apply C.
      apply (Z.divide_add_cancel_r p (a * coefficient g (S (d + e)))); auto. apply Z.divide_mul_r, G. lia.
    + intros i I. rewrite coefficient_product. apply Z.divide_add_r; [apply Z.divide_mul_r, G; lia |].
      destruct i; [lia | apply D; lia].
Qed.

Lemma last_of_product f g d e : (forall i, (d < i)%nat -> coefficient f i = 0) -> (forall i, (e < i)%nat -> coefficient g i = 0) ->
  coefficient (product f g) (d + e) = coefficient f d * coefficient g e.
Proof.
  revert d. induction f as [| a f IH]; intros d F G; [rewrite !coefficient_nil; ring |]. rewrite coefficient_product.
  destruct d as [| d].
  - assert (Z : forall i, (0 | coefficient (product f g) i)).
    { apply zero_product. intros i. pose proof (F (S i) ltac:(lia)) as E. change (coefficient (a :: f) (S i)) with (coefficient f i) in E.
      rewrite E. apply Z.divide_0_r. }
    replace (match (0 + e)%nat with O => 0 | S i => coefficient (product f g) i end) with 0; [simpl; unfold coefficient; simpl; ring |].
    destruct e; [easy |]. simpl. specialize (Z e). apply Z.divide_0_l in Z. easy.
  - simpl. rewrite (G (S (d + e))) by lia. change (coefficient (a :: f) (S d)) with (coefficient f d).
    rewrite <- (IH d); auto; [ring |]. intros i I. apply (F (S i)). lia.
Qed.

(** Polynomials that are equal everywhere have the same coefficients. *)
Lemma zero_everywhere f : (forall x, poly f x = 0%R) -> forall i, coefficient f i = 0.
Proof.
  induction f as [| a f IH]; intros Z i; [apply coefficient_nil |].
  assert (A : a = 0).
  { apply eq_IZR. specialize (Z 0%R). change (poly (a :: f) 0) with (IZR a + 0 * poly f 0)%R in Z. lra. }
  destruct i as [| i]; [exact A |]. apply IH. apply (zero_between (map IZR f) 0 1); [lra |]. intros x X.
  specialize (Z x). change (poly (a :: f) x) with (IZR a + x * power_form (map IZR f) x)%R in Z. rewrite A in Z.
  apply Rmult_eq_reg_l with x; lra.
Qed.
Lemma equal_same f g : (forall x, poly f x = poly g x) -> same f g.
Proof.
  intros E i. assert (H : forall i, coefficient (sum f (multiple (-1) g)) i = 0).
  { apply zero_everywhere. intros x. rewrite sum_at, multiple_at, E. ring. }
  specialize (H i). rewrite coefficient_sum, coefficient_multiple in H. lia.
Qed.

Lemma divide_out p f : (forall i, (p | coefficient f i)) -> exists g, forall x, poly f x = (IZR p * poly g x)%R.
Proof.
  induction f as [| a f IH]; intros D; [exists []; intros x; unfold poly; simpl; ring |].
  destruct IH as (g & E); [intros i; apply (D (S i)) |]. destruct (D 0%nat) as (q & Q). unfold coefficient in Q. simpl in Q.
  exists (q :: g). intros x. change (poly (a :: f) x) with (IZR a + x * poly f x)%R.
  change (poly (q :: g) x) with (IZR q + x * poly g x)%R. rewrite E, Q, mult_IZR. ring.
Qed.
Lemma least (P : nat -> Prop) : (exists n, P n) -> exists k, P k /\ forall j, (j < k)%nat -> ~ P j.
Proof.
  intros (n & N). induction n as [n IH] using lt_wf_ind.
  destruct (classic (exists j, (j < n)%nat /\ P j)) as [(j & J & Pj) | No]; [now apply (IH j) |].
  exists n. split; auto. intros j J Pj. apply No. now exists j.
Qed.
Lemma degree_0 f d : degree 0 f d <-> coefficient f d <> 0 /\ forall i, (d < i)%nat -> coefficient f i = 0.
Proof.
  unfold degree. split; intros (A & B); split.
  - intros E. apply A. rewrite E. apply Z.divide_refl.
  - intros i I. now apply Z.divide_0_l, B.
  - intros E. now apply A, Z.divide_0_l.
  - intros i I. rewrite B by easy. apply Z.divide_refl.
Qed.

Section Root.

Context (p : Z) (r : R) (P : prime p).
Let prime_p : zero_or_prime p := or_intror P.

(** A polynomial of least degree with the root r. *)
Definition minimal (g : list Z) (k : nat) : Prop := degree 0 g k /\ poly g r = 0%R /\
  forall f j, degree 0 f j -> poly f r = 0%R -> (k <= j)%nat.

Lemma not_all_divisible g k : degree 0 g k -> poly g r = 0%R ->
  exists h, degree 0 h k /\ poly h r = 0%R /\ exists e, degree p h e.
Proof.
  pose proof (prime_ge_2 p P) as Two. remember (Z.abs_nat (coefficient g k)) as n eqn:N. revert g N.
  induction n as [n IH] using lt_wf_ind. intros g N D Z.
  destruct (some_degree p g) as [All | E]; [| now exists g].
  destruct (divide_out p g All) as (h & E).
  assert (C : forall i, coefficient g i = p * coefficient h i).
  { intros i. rewrite <- coefficient_multiple. apply equal_same. intros x. now rewrite multiple_at. }
  apply degree_0 in D. destruct D as (D & Up).
  apply (IH (Z.abs_nat (coefficient h k))) with (g := h); auto.
  - rewrite N, C. assert (coefficient h k <> 0) by (intros K; apply D; rewrite C, K; ring). nia.
  - apply degree_0. split; [intros K; apply D; rewrite C, K; ring |]. intros i I. specialize (Up i I). rewrite C in Up. nia.
  - rewrite E in Z. apply Rmult_eq_reg_l with (IZR p); [rewrite Z; ring |]. apply IZR_neq. lia.
Qed.
Lemma minimal_exists f j : degree 0 f j -> poly f r = 0%R -> exists g k e, minimal g k /\ degree p g e.
Proof.
  intros D Z. destruct (least (fun k => exists g, degree 0 g k /\ poly g r = 0%R)) as (k & (g & Dg & Zg) & Least); [now exists j, f |].
  destruct (not_all_divisible g k Dg Zg) as (h & Dh & Zh & e & E). exists h, k, e. split; auto. split; auto. split; auto.
  intros f' j' Df Zf. destruct (le_lt_dec k j'); auto. exfalso. apply (Least j'); auto. now exists f'.
Qed.

Definition monomial (c : Z) (k : nat) : list Z := repeat 0 k ++ [c].
Lemma monomial_product c k g i : coefficient (product (monomial c k) g) i = if (i <? k)%nat then 0 else c * coefficient g (i - k).
Proof.
  unfold monomial. revert i. induction k as [| k IH]; intros i.
  - cbn [repeat app]. rewrite coefficient_product. replace (match i with O => 0 | S i => coefficient (product [] g) i end) with 0
      by (destruct i; [easy |]; now rewrite coefficient_nil). rewrite Nat.sub_0_r. simpl. ring.
  - change (repeat 0 (S k) ++ [c]) with (0 :: (repeat 0 k ++ [c])). rewrite coefficient_product. destruct i as [| i]; [simpl; ring |].
    rewrite IH. change (S i <? S k)%nat with (i <? k)%nat. cbn [Nat.sub]. destruct (i <? k)%nat; ring.
Qed.

(** It divides every other such polynomial, up to a factor. *)
Lemma pseudo_quotient g k : minimal g k -> forall n f, (forall i, (n <= i)%nat -> coefficient f i = 0) -> poly f r = 0%R ->
  exists m q, m <> 0 /\ forall x, (IZR m * poly f x = poly q x * poly g x)%R.
Proof.
  intros (D & Z & Least). induction n as [| n IH]; intros f Up Zf.
  - exists 1, []. split; [lia |]. intros x. rewrite (zero_at f x) by (intros i; apply Up; lia). unfold poly. simpl. ring.
  - destruct (Z.eq_dec (coefficient f n) 0) as [E | N].
    + apply IH; auto. intros i I. destruct (Nat.eq_dec i n) as [-> |]; [easy | apply Up; lia].
    + assert (K : (k <= n)%nat) by (apply (Least f); auto; apply degree_0; split; [easy | intros i I; apply Up; lia]).
      apply degree_0 in D. destruct D as (D & Upg). set (c := coefficient g k) in *. set (t := coefficient f n) in *.
      set (h := product (monomial t (n - k)) g).
      destruct (IH (sum (multiple c f) (multiple (-1) h))) as (m & q & M & E).
      * intros i I. rewrite coefficient_sum, !coefficient_multiple. unfold h. rewrite monomial_product.
        destruct (Nat.ltb_spec i (n - k)); [lia |].
        destruct (Nat.eq_dec i n) as [-> |]; [fold t; replace (n - (n - k))%nat with k by lia; fold c; ring |].
        rewrite Up by lia. rewrite Upg by lia. ring.
      * rewrite sum_at, !multiple_at. unfold h. rewrite product_at, Z, Zf. ring.
      * exists (m * c), (sum q (multiple m (monomial t (n - k)))). split; [nia |]. intros x. specialize (E x).
        rewrite sum_at, !multiple_at in E. unfold h in E. rewrite product_at in E.
        rewrite sum_at, multiple_at, mult_IZR, Rmult_plus_distr_r, <- E. ring.
Qed.
Lemma without_prime g e f : degree p g e -> forall m q, m <> 0 -> (forall x, (IZR m * poly f x = poly q x * poly g x)%R) ->
  exists m q, ~ (p | m) /\ forall x, (IZR m * poly f x = poly q x * poly g x)%R.
Proof.
  intros D m. remember (Z.abs_nat m) as n eqn:N. revert m N. induction n as [n IH] using lt_wf_ind. intros m N q M E.
  pose proof (prime_ge_2 p P) as Two.
  destruct (Zdivide_dec p m) as [(m' & ->) | No]; [| now exists m, q].
  assert (Eq : same (multiple (m' * p) f) (product q g)) by (apply equal_same; intros x; now rewrite multiple_at, product_at).
  destruct (some_degree p q) as [All | (d & Dq)].
  - destruct (divide_out p q All) as (q' & Q). apply (IH (Z.abs_nat m')) with (m := m') (q := q'); auto; [nia | intros ->; lia |].
    intros x. specialize (E x). rewrite Q, mult_IZR in E. apply Rmult_eq_reg_l with (IZR p); [lra |]. apply IZR_neq. lia.
  - exfalso. pose proof (degree_product p q g d e prime_p Dq D) as (A & _). apply A.
    rewrite <- Eq, coefficient_multiple. exists (m' * coefficient f (d + e)). ring.
Qed.

(** image = u a + v b modulo p has degree k, p does not divide a's last coefficient, and a divisor of both has degree
    k. Then the quotients by the divisor have no common root. *)
Lemma no_common_root (a b divisor image u v w fa fb : list Z) (n k : nat) :
  degree 0 a n -> ~ (p | coefficient a n) ->
  (forall x, poly a x = poly divisor x * poly fa x)%R -> (forall x, poly b x = poly divisor x * poly fb x)%R ->
  (forall x, poly image x = poly u x * poly a x + poly v x * poly b x + IZR p * poly w x)%R ->
  degree p image k -> degree 0 divisor k -> ~ (poly fa r = 0%R /\ poly fb r = 0%R).
Proof.
  intros Da La Ea Eb Ei Di Dd (Zfa & Zfb).
  assert (Sa : same a (product divisor fa)) by (apply equal_same; intros x; now rewrite product_at).
  destruct (some_degree 0 fa) as [All | (j & Dj)].
  { apply La. rewrite Sa. assert (Z : forall x, poly (product divisor fa) x = 0%R).
    { intros x. rewrite product_at, (zero_at fa); [ring |]. intros i. apply Z.divide_0_l, All. }
    rewrite (zero_everywhere _ Z). apply Z.divide_0_r. }
  assert (Zero : zero_or_prime 0) by now left.
  assert (En : n = (k + j)%nat).
  { apply (degree_unique 0 a); auto. apply (degree_same 0 (product divisor fa)); [intros i; symmetry; apply Sa |].
    now apply degree_product. }
  pose proof (proj1 (degree_0 _ _) Dd) as (Nd & Ud). pose proof (proj1 (degree_0 _ _) Dj) as (Nj & Uj).
  assert (Lead : coefficient a n = coefficient divisor k * coefficient fa j) by (rewrite Sa, En; now apply last_of_product).
  destruct (minimal_exists fa j Dj Zfa) as (g & l & e & Min & De). pose proof Min as (Dg & Zg & _).
  pose proof (proj1 (degree_0 _ _) Dg) as (Ng & Ug).
  assert (Quotient : forall f, poly f r = 0%R -> exists m q, ~ (p | m) /\ forall x, (IZR m * poly f x = poly q x * poly g x)%R).
  { intros f Zf. destruct (pseudo_quotient g l Min (length f) f) as (m & q & M & E); auto.
    - intros i I. unfold coefficient. now apply nth_overflow.
    - now apply (without_prime g e f De m q). }
  destruct (Quotient fa Zfa) as (m1 & q1 & M1 & E1). destruct (Quotient fb Zfb) as (m2 & q2 & M2 & E2).
  (* p does not divide g's last coefficient *)
  assert (Lg : ~ (p | coefficient g l)).
  { assert (S1 : same (multiple m1 fa) (product q1 g)) by (apply equal_same; intros x; now rewrite multiple_at, product_at).
    destruct (some_degree 0 q1) as [All | (i & Dq)].
    - exfalso. apply Nj. assert (Z : coefficient (multiple m1 fa) j = 0).
      { rewrite S1. apply zero_everywhere. intros x. rewrite product_at, (zero_at q1); [ring |]. intros i. apply Z.divide_0_l, All. }
      rewrite coefficient_multiple in Z. apply Z.mul_eq_0 in Z. destruct Z as [-> |]; [exfalso; apply M1, Z.divide_0_r | easy].
    - pose proof (proj1 (degree_0 _ _) Dq) as (_ & Uq). pose proof (last_of_product q1 g i l Uq Ug) as Lp.
      assert (Ej : j = (i + l)%nat).
      { apply (degree_unique 0 (multiple m1 fa)).
        - apply degree_0. split; [rewrite coefficient_multiple; intros K; apply Z.mul_eq_0 in K; destruct K as [-> |]; [apply M1, Z.divide_0_r | easy] |].
          intros i' I. rewrite coefficient_multiple, Uj by easy. ring.
        - apply (degree_same 0 (product q1 g)); [intros i'; symmetry; apply S1 | now apply degree_product]. }
      rewrite <- Ej, <- S1, coefficient_multiple in Lp. intros (y & Y).
      assert (Dv : (p | m1 * coefficient fa j)) by (rewrite Lp, Y; exists (coefficient q1 i * y); ring).
      apply divides_product in Dv; auto. destruct Dv as [Dv | Dv]; [easy |]. apply La. rewrite Lead. now apply Z.divide_mul_r. }
  assert (Dpg : degree p g l) by (split; auto; intros i I; rewrite Ug by easy; apply Z.divide_0_r).
  assert (Dpd : degree p divisor k).
  { split; [intros K; apply La; rewrite Lead; now apply Z.divide_mul_l |]. intros i I. rewrite Ud by easy. apply Z.divide_0_r. }
  set (h := sum (multiple m2 (product u q1)) (multiple m1 (product v q2))).
  assert (Main : same (multiple (m1 * m2) image) (sum (product (product divisor g) h) (multiple (p * (m1 * m2)) w))).
  { apply equal_same. intros x. unfold h. rewrite sum_at, !multiple_at, !product_at, sum_at, !multiple_at, !product_at, Ei, Ea, Eb, !mult_IZR.
    transitivity (poly divisor x * (IZR m2 * poly u x * (IZR m1 * poly fa x) + IZR m1 * poly v x * (IZR m2 * poly fb x))
      + IZR p * (IZR m1 * IZR m2) * poly w x)%R; [ring |]. rewrite E1, E2. ring. }
  assert (Dprod : degree p (product (product divisor g) h) k).
  { assert (C : forall i, (p | coefficient (product (product divisor g) h) i) <-> (p | coefficient image i)).
    { intros i. specialize (Main i). rewrite coefficient_sum, !coefficient_multiple in Main.
      assert (Ep : coefficient (product (product divisor g) h) i = m1 * m2 * coefficient image i - p * (m1 * m2 * coefficient w i)) by lia.
      rewrite Ep. split; intros K.
      - apply (Z.divide_add_r p _ (p * (m1 * m2 * coefficient w i))) in K; [| apply Z.divide_factor_l].
        replace (_ - _ + _) with (m1 * m2 * coefficient image i) in K by ring.
        apply divides_product in K; auto. destruct K as [K | K]; auto. apply divides_product in K; auto. tauto.
      - apply Z.divide_sub_r; [now apply Z.divide_mul_r | apply Z.divide_factor_l]. }
    destruct Di as (A & B). split; [now rewrite C | intros i I; now apply C, B]. }
  destruct (some_degree p h) as [All | (y & Dh)].
  { destruct Dprod as (A & _). apply A.
    assert (Co : same (product (product divisor g) h) (product h (product divisor g))) by (apply equal_same; intros x; rewrite !product_at; ring).
    rewrite Co. now apply zero_product. }
  pose proof (degree_product p _ h _ y prime_p (degree_product p divisor g k l prime_p Dpd Dpg) Dh) as Dall.
  pose proof (degree_unique p _ _ _ Dprod Dall) as El. assert (l = 0%nat) as -> by lia.
  apply Ng. apply eq_IZR. rewrite <- Zg. symmetry.
  destruct g as [| c g]; [now destruct Ng |]. change (poly (c :: g) r) with (IZR c + r * poly g r)%R.
  rewrite (zero_at g r) by (intros i; apply (Ug (S i)); lia). unfold coefficient. simpl. ring.
Qed.

End Root.

(** ** The code *)

(** Euclid's algorithm modulo p: multiples of the images of a and b. Each step subtracts a shifted multiple of one
    polynomial from a multiple of another. *)
Definition congruent (p : Z) (f g : list Z) : Prop := forall i, (p | coefficient f i - coefficient g i).
Inductive reached (p : Z) (a b : list Z) : list Z -> Prop :=
| image_of_a s f : congruent p f (multiple s a) -> reached p a b f
| image_of_b s f : congruent p f (multiple s b) -> reached p a b f
| euclid_step f g s t k h : reached p a b f -> reached p a b g ->
    congruent p h (sum (multiple s f) (product (monomial t k) g)) -> reached p a b h.

Definition in_ideal (p : Z) (a b f : list Z) : Prop := exists u v w, forall x,
  poly f x = (poly u x * poly a x + poly v x * poly b x + IZR p * poly w x)%R.
Lemma congruent_values p f g : congruent p f g -> exists w, forall x, poly f x = (poly g x + IZR p * poly w x)%R.
Proof.
  intros C. destruct (divide_out p (sum f (multiple (-1) g))) as (w & E).
  - intros i. rewrite coefficient_sum, coefficient_multiple. replace (_ + _) with (coefficient f i - coefficient g i) by ring. apply C.
  - exists w. intros x. rewrite <- E, sum_at, multiple_at. ring.
Qed.
Theorem images_in_ideal p a b f : reached p a b f -> in_ideal p a b f.
Proof.
  assert (C : forall s x, poly [s] x = IZR s) by (intros; unfold poly; simpl; ring).
  assert (O : forall x, poly [] x = 0%R) by easy.
  induction 1 as [s f H | s f H | f g s t k h _ (u & v & w & F) _ (u' & v' & w' & G) H].
  - destruct (congruent_values _ _ _ H) as (w & E). exists [s], [], w. intros x. rewrite E, multiple_at, C, O. ring.
  - destruct (congruent_values _ _ _ H) as (w & E). exists [], [s], w. intros x. rewrite E, multiple_at, C, O. ring.
  - destruct (congruent_values _ _ _ H) as (z & E). set (m := monomial t k) in *.
    exists (sum (multiple s u) (product m u')), (sum (multiple s v) (product m v')), (sum (sum (multiple s w) (product m w')) z).
    intros x. rewrite E, !sum_at, !multiple_at, !product_at, F, G. ring.
Qed.

(** divided: quotients of last coefficients, until nothing remains. *)
Inductive divided (b : list Z) : list Z -> list Z -> Prop :=
| nothing_left a : (forall i, coefficient a i = 0) -> divided b a []
| next_factor a c k q : divided b (sum a (multiple (-1) (product (monomial c k) b))) q ->
    divided b a (sum q (monomial c k)).
Theorem divided_right b a q : divided b a q -> forall x, poly a x = (poly b x * poly q x)%R.
Proof.
  induction 1 as [a Z | a c k q D IH]; intros x; [rewrite (zero_at a) by easy; unfold poly at 2; simpl; ring |].
  specialize (IH x). rewrite sum_at, multiple_at, product_at in IH. rewrite sum_at, Rmult_plus_distr_l, <- IH. ring.
Qed.

(** make_primitive *)
Definition primitive (f g : list Z) : Prop := exists c, c <> 0 /\ f = multiple c g.

(** common_factor: if a or b is empty, the other. Otherwise a divisor of both with the size of the image modulo the
    last prime ([1] if the image is constant). The last prime does not divide a's last coefficient. *)
Inductive common_factor (a b : list Z) : list Z -> Prop :=
| other_empty c : a = [] -> primitive b c -> common_factor a b c
| no_other c : b = [] -> primitive a c -> common_factor a b c
| by_images a' b' c p image qa qb : primitive a a' -> primitive b b' -> a <> [] -> b <> [] ->
    prime p -> ~ (p | last a' 0) -> reached p a' b' image -> degree p image (length c - 1) -> c <> [] -> last c 0 <> 0 ->
    divided c a' qa -> divided c b' qb -> common_factor a b c.

Lemma last_coefficient f : coefficient f (length f - 1) = last f 0.
Proof.
  unfold coefficient. induction f as [| a [| b f] IH]; [easy | easy |]. simpl in *. now rewrite Nat.sub_0_r in IH.
Qed.
Lemma trimmed_degree f : f <> [] -> last f 0 <> 0 -> degree 0 f (length f - 1).
Proof.
  intros N L. apply degree_0. split; [now rewrite last_coefficient |]. intros i I. unfold coefficient. apply nth_overflow.
  destruct f; [easy | simpl in *; lia].
Qed.
Lemma primitive_right f g : primitive f g -> (g = [] <-> f = []) /\ (trimmed f -> trimmed g) /\
  forall x, poly g x = 0%R <-> poly f x = 0%R.
Proof.
  intros (c & C & ->). assert (E : g = [] <-> multiple c g = []) by (destruct g; simpl; split; easy).
  split; [easy |]. split.
  - intros [N | T]; [left; now apply E | right]. rewrite <- last_coefficient in *. intros Z. apply T.
    unfold multiple at 2. rewrite map_length, coefficient_multiple, Z. ring.
  - intros x. rewrite multiple_at. split; intros H; [rewrite H; ring |]. apply Rmult_integral in H.
    destruct H as [H |]; auto. now apply eq_IZR in H.
Qed.

(** The quotients of both by the divisor have no common root. chain_step uses this for p and p', chain_squarefree
    (surely_squarefree) with the divisor [1]. *)
Theorem cofactors_rootless a' b' c p image qa qb : a' <> [] -> last a' 0 <> 0 -> prime p -> ~ (p | last a' 0) ->
  reached p a' b' image -> degree p image (length c - 1) -> c <> [] -> last c 0 <> 0 -> divided c a' qa -> divided c b' qb ->
  forall x, ~ (poly qa x = 0%R /\ poly qb x = 0%R).
Proof.
  intros Na Ta P La R Di Nc Lc Da Db x. destruct (images_in_ideal _ _ _ _ R) as (u & v & w & I).
  pose proof (divided_right _ _ _ Da) as Fa. pose proof (divided_right _ _ _ Db) as Fb.
  apply (no_common_root p x P a' b' c image u v w qa qb (length a' - 1) (length c - 1)); auto.
  - now apply trimmed_degree.
  - now rewrite last_coefficient.
  - now apply trimmed_degree.
Qed.

Theorem common_factor_right a b c : trimmed a -> trimmed b -> common_factor a b c ->
  trimmed c /\ (c = [] <-> a = [] /\ b = []) /\
  forall x, poly c x = 0%R <-> poly a x = 0%R /\ poly b x = 0%R.
Proof.
  intros Ta Tb [c' E Q | c' E Q | a' b' c' p image qa qb Qa Qb Na Nb P La R Di Nc Lc Da Db].
  - subst a. destruct (primitive_right _ _ Q) as (A & B & C). split; [now apply B |]. split; [tauto |].
    intros x. rewrite C. unfold poly at 2. simpl. tauto.
  - subst b. destruct (primitive_right _ _ Q) as (A & B & C). split; [now apply B |]. split; [tauto |].
    intros x. rewrite C. unfold poly at 3. simpl. tauto.
  - destruct (primitive_right _ _ Qa) as (Ea & Pa & Za). destruct (primitive_right _ _ Qb) as (_ & _ & Zb).
    split; [now right |]. split; [tauto |]. intros x. rewrite <- Za, <- Zb.
    pose proof (divided_right _ _ _ Da) as Fa. pose proof (divided_right _ _ _ Db) as Fb. split.
    + intros Z. rewrite Fa, Fb, Z. split; ring.
    + intros (A & B). assert (Na' : a' <> []) by (rewrite Ea; easy).
      assert (Ta' : last a' 0 <> 0) by now destruct (Pa Ta).
      pose proof (cofactors_rootless a' b' c' p image qa qb Na' Ta' P La R Di Nc Lc Da Db x) as No.
      rewrite Fa in A. rewrite Fb in B. apply Rmult_integral in A, B. tauto.
Qed.

Theorem common_factor_divides a b c : common_factor a b c ->
  divides (reals_of c) (reals_of a) /\ divides (reals_of c) (reals_of b).
Proof.
  assert (D : forall c f f' q, primitive f f' -> (forall x, poly f' x = (poly c x * poly q x)%R) ->
    divides (reals_of c) (reals_of f)).
  { intros d f f' q (k & _ & ->) E. exists (reals_of (multiple k q)). intros x.
    change (poly (multiple k f') x = poly d x * poly (multiple k q) x)%R. rewrite !multiple_at, E. ring. }
  assert (Z : forall c, divides (reals_of c) []) by (intros d; exists []; intros x; simpl; ring).
  assert (I : forall c x, poly c x = (poly c x * poly [1%Z] x)%R) by (intros d x; unfold poly at 3; simpl; ring).
  intros M. destruct M as [c -> Q | c -> Q | a' b' c p image qa qb Qa Qb _ _ _ _ _ _ _ _ Da Db].
  - split; [apply Z | exact (D _ _ _ _ Q (I c))].
  - split; [exact (D _ _ _ _ Q (I c)) | apply Z].
  - split; [exact (D _ _ _ _ Qa (divided_right _ _ _ Da)) | exact (D _ _ _ _ Qb (divided_right _ _ _ Db))].
Qed.

(** ** Multiplicities: squarefree_chain *)

Open Scope R_scope.
Definition multiplicity (p : list R) (r : R) (k : nat) : Prop :=
  exists u, power_form u r <> 0 /\ forall x, power_form p x = (x - r) ^ k * power_form u x.
Definition rootless_together (f g : list R) : Prop := forall x, ~ (power_form f x = 0 /\ power_form g x = 0).

(** Each polynomial of the chain is p divided by the greatest common divisor m of p and p'; then m replaces p. The
    last one has no multiple roots (surely_squarefree, or a constant m). *)
Inductive chain : list R -> list (list R) -> Prop :=
| chain_constant p : (forall x, power_form p x <> 0) -> chain p []
| chain_squarefree p : rootless_together p (RootIsolation.derivative p) -> chain p [p]
| chain_step p m f g l : (forall x, power_form p x = power_form m x * power_form f x) ->
    (forall x, power_form (RootIsolation.derivative p) x = power_form m x * power_form g x) ->
    rootless_together f g -> chain m l -> chain p (f :: l).

Lemma product_multiplicity p f g r j k : (forall x, power_form p x = power_form f x * power_form g x) ->
  multiplicity f r j -> multiplicity g r k -> exists u : R -> R, continuity u /\ u r <> 0 /\
  forall x, power_form p x = (x - r) ^ (j + k) * u x.
Proof.
  intros E (u & U & F) (v & V & G). exists (fun x => power_form u x * power_form v x). split; [| split].
  - apply (continuity_mult (power_form u) (power_form v)); apply continuous_power_form.
  - now apply Rmult_integral_contrapositive.
  - intros x. rewrite E, F, G, pow_add. ring.
Qed.
(** There is at most one multiplicity. *)
Lemma power_unique r j k (u v : R -> R) : continuity u -> continuity v -> u r <> 0 -> v r <> 0 ->
  (forall x, (x - r) ^ j * u x = (x - r) ^ k * v x) -> j = k.
Proof.
  assert (G : forall j k (u v : R -> R), (j < k)%nat -> continuity u -> continuity v -> u r <> 0 ->
    (forall x, (x - r) ^ j * u x = (x - r) ^ k * v x) -> False).
  { clear. intros j k u v L Cu Cv U E. apply U.
    assert (C : continuity (fun x => u x - (x - r) ^ (k - j) * v x)).
    { apply (continuity_minus u (fun x => (x - r) ^ (k - j) * v x)); auto. apply (continuity_mult (fun x => (x - r) ^ (k - j)) v); auto.
      intros x. apply (continuity_pt_comp (fun x => x - r) (fun x => x ^ (k - j))).
      - apply (continuity_pt_minus id (fct_cte r)); [apply derivable_continuous_pt, derivable_pt_id | now apply continuity_pt_const].
      - apply derivable_continuous_pt. exists (INR (k - j) * (x - r) ^ Nat.pred (k - j)). apply derivable_pt_lim_pow. }
    pose proof (zero_beside _ r C) as Z. cbv beta in Z.
    assert (H : u r - (r - r) ^ (k - j) * v r = 0).
    { apply Z. intros x N. apply Rmult_eq_reg_l with ((x - r) ^ j); [| apply pow_nonzero; lra].
      rewrite Rmult_0_r, Rmult_minus_distr_l, <- Rmult_assoc, <- pow_add. replace (j + (k - j))%nat with k by lia. rewrite E. ring. }
    rewrite (Rminus_diag_eq r r), pow_i in H by (easy || lia). lra. }
  intros Cu Cv U V E. destruct (lt_eq_lt_dec j k) as [[L | L] | L]; auto; exfalso.
  - now apply (G j k u v).
  - apply (G k j v u); auto.
Qed.
Lemma derivative_multiplicity p r k : multiplicity p r (S k) -> exists u : R -> R, continuity u /\ u r <> 0 /\
  forall x, power_form (RootIsolation.derivative p) x = (x - r) ^ k * u x.
Proof.
  intros (u & U & F). exists (fun x => INR (S k) * power_form u x + (x - r) * power_form (RootIsolation.derivative u) x).
  split; [| split].
  - apply (continuity_plus (fun x => INR (S k) * power_form u x) (fun x => (x - r) * power_form (RootIsolation.derivative u) x)).
    + apply (continuity_scal (power_form u)), continuous_power_form.
    + apply (continuity_mult (fun x => x - r) (power_form (RootIsolation.derivative u))); [| apply continuous_power_form].
      apply (continuity_minus id (fct_cte r)); [apply derivable_continuous, derivable_id | now apply continuity_const].
  - rewrite Rminus_diag_eq, Rmult_0_l, Rplus_0_r by easy. apply Rmult_integral_contrapositive. split; auto.
    apply not_0_INR. lia.
  - intros x. rewrite !derivative_slope.
    rewrite (slope_product p (fun y => (y - r) ^ S k) u x F (INR (S k) * (x - r) ^ k)).
    + simpl. ring.
    + replace (INR (S k) * (x - r) ^ k) with (INR (S k) * (x - r) ^ Nat.pred (S k) * (1 - 0)) by (simpl Nat.pred; ring).
      apply (derivable_pt_lim_comp (fun y => y - r) (fun y => y ^ S k)); [| apply derivable_pt_lim_pow].
      apply (derivable_pt_lim_minus id (fct_cte r)); [apply derivable_pt_lim_id | apply derivable_pt_lim_const].
Qed.

Lemma multiplicity_root p r k : multiplicity p r k -> (power_form p r = 0 <-> (0 < k)%nat).
Proof.
  intros (u & U & E). rewrite E. destruct k as [| k]; [simpl; split; [lra | lia] |]. rewrite Rminus_diag_eq, pow_i by (easy || lia).
  split; [lia | intros; ring].
Qed.
Lemma multiplicity_0 p r : power_form p r <> 0 -> multiplicity p r 0.
Proof. intros N. exists p. split; auto. intros x. simpl. ring. Qed.
Lemma factored_not_zero p r k (u : R -> R) : continuity u -> u r <> 0 -> (forall x, power_form p x = (x - r) ^ k * u x) -> not_zero p.
Proof.
  intros C U E. apply NNPP. intros N. apply U, zero_beside; auto. intros x X.
  destruct (Req_dec (power_form p x) 0) as [Z | Z]; [| exfalso; apply N; now exists x].
  rewrite E in Z. apply Rmult_integral in Z. destruct Z as [Z |]; auto. exfalso. revert Z. apply pow_nonzero. lra.
Qed.
Lemma factor_not_zero p f g : not_zero p -> (forall x, power_form p x = power_form f x * power_form g x) -> not_zero f /\ not_zero g.
Proof. intros (x & X) E. split; exists x; intros Z; apply X; rewrite E, Z; ring. Qed.

Lemma step_multiplicities p m f g r k : (forall x, power_form p x = power_form m x * power_form f x) ->
  (forall x, power_form (RootIsolation.derivative p) x = power_form m x * power_form g x) ->
  rootless_together f g -> multiplicity p r (S k) -> multiplicity m r k /\ multiplicity f r 1.
Proof.
  intros E D No M. destruct (derivative_multiplicity p r k M) as (d & Cd & Nd & Ed). destruct M as (u & U & Eu).
  destruct (factor_not_zero p m f (factored_not_zero p r (S k) _ (continuous_power_form u) U Eu) E) as (Nm & Nf).
  destruct (factor_not_zero _ m g (factored_not_zero _ r k d Cd Nd Ed) D) as (_ & Ng).
  destruct (RootIsolation.multiplicity m r Nm) as (j & Mm). destruct (RootIsolation.multiplicity f r Nf) as (i & Mf).
  destruct (RootIsolation.multiplicity g r Ng) as (i' & Mg). fold (multiplicity m r j) in Mm. fold (multiplicity f r i) in Mf. fold (multiplicity g r i') in Mg.
  destruct (product_multiplicity p m f r j i E Mm Mf) as (v & Cv & Nv & Ev).
  destruct (product_multiplicity _ m g r j i' D Mm Mg) as (w & Cw & Nw & Ew).
  assert (A : (j + i = S k)%nat).
  { apply (power_unique r _ _ v (power_form u)); auto; [apply continuous_power_form |]. intros x. now rewrite <- Ev, Eu. }
  assert (B : (j + i' = k)%nat) by (apply (power_unique r _ _ w d); auto; intros x; now rewrite <- Ew, Ed).
  destruct i' as [| i']; [| exfalso; apply (No r); split; [apply (multiplicity_root f r i); auto; lia | apply (multiplicity_root g r (S i')); auto; lia]].
  replace j with k in Mm by lia. replace i with 1%nat in Mf by lia. now split.
Qed.

(** A root of multiplicity k is a root of exactly the first k polynomials of the chain, and simple there. *)
Theorem chain_multiplicities p l r : chain p l -> forall k, multiplicity p r k -> (k <= length l)%nat /\
  forall i, (i < length l)%nat -> (power_form (nth i l []) r = 0 <-> (i < k)%nat) /\ ((i < k)%nat -> multiplicity (nth i l []) r 1).
Proof.
  induction 1 as [p N | p No | p m f g l E D No C IH]; intros k M.
  - assert (k = 0%nat) as -> by (destruct k; auto; exfalso; apply (N r), (multiplicity_root p r (S k)); auto; lia).
    split; [auto |]. intros i I. simpl in I. lia.
  - assert (K : (k <= 1)%nat).
    { destruct k as [| [| k]]; auto. exfalso. apply (No r). split; [apply (multiplicity_root p r _ M); lia |].
      destruct (derivative_multiplicity p r (S k) M) as (d & _ & _ & Ed). rewrite Ed, Rminus_diag_eq, pow_i by (easy || lia). ring. }
    split; [easy |]. intros [| i] I; [| simpl in I; lia]. cbn [nth]. split; [now apply multiplicity_root |]. intros P.
    now replace k with 1%nat in M by lia.
  - destruct k as [| k].
    + assert (N : power_form p r <> 0) by (intros Z; apply (multiplicity_root p r 0 M) in Z; lia).
      rewrite E in N. assert (Nm : power_form m r <> 0) by (intros Z; apply N; rewrite Z; ring).
      assert (Nf : power_form f r <> 0) by (intros Z; apply N; rewrite Z; ring).
      destruct (IH 0%nat (multiplicity_0 m r Nm)) as (_ & H). split; [lia |].
      intros [| i] I; cbn [nth]; [split; [split; [easy | lia] | lia] |]. simpl in I. destruct (H i ltac:(lia)) as (A & _).
      split; [rewrite A; lia | lia].
    + destruct (step_multiplicities p m f g r k E D No M) as (Mm & Mf). destruct (IH k Mm) as (L & H). split; [simpl; lia |].
      intros [| i] I; cbn [nth].
      * split; [rewrite (multiplicity_root f r 1 Mf); split; lia | easy].
      * simpl in I. destruct (H i ltac:(lia)) as (A & B). split; [rewrite A; lia | intros; apply B; lia].
Qed.

(** `vanishes` tests for a sign change over the root's interval, for polynomials without another root there. So
    `multiplicity` counts the polynomials of the chain that have the root. *)
Theorem vanishes_right c lo hi r : lo < r < hi -> (forall x, lo <= x <= hi -> power_form c x = 0 -> x = r) ->
  (power_form c r = 0 -> multiplicity c r 1) ->
  (sgn (power_form c lo) <> sgn (power_form c hi) <-> power_form c r = 0).
Proof.
  intros L Only Simple.
  assert (Nl : power_form c lo <> 0) by (intros Z; apply Only in Z; lra).
  assert (Nh : power_form c hi <> 0) by (intros Z; apply Only in Z; lra).
  assert (D : sgn (power_form c lo) <> sgn (power_form c hi) <-> power_form c lo * power_form c hi < 0).
  { destruct (sgn_cases (power_form c lo)) as [(H & ->) | [(H & ->) | (H & ->)]],
      (sgn_cases (power_form c hi)) as [(K & ->) | [(K & ->) | (K & ->)]]; try lra;
      split; intros; try easy; try nra; exfalso; nra. }
  rewrite D. split.
  - intros O. destruct (root_between (power_form c) lo hi) as (x & X & Z); auto; [apply continuous_power_form | lra |].
    rewrite <- (Only x); auto. lra.
  - intros Z. destruct (Simple Z) as (u & U & E). rewrite !E in *. simpl pow in *. rewrite !Rmult_1_r in *.
    destruct (Rlt_or_le (power_form u lo * power_form u hi) 0) as [O | O].
    + exfalso. destruct (root_between (power_form u) lo hi) as (x & X & Zx); auto; [apply continuous_power_form | lra |].
      apply U. rewrite <- (Only x); auto; [lra |]. rewrite E, Zx. ring.
    + assert (P : 0 < power_form u lo * power_form u hi).
      { destruct O as [O | O]; auto. symmetry in O. apply Rmult_integral in O. destruct O as [O | O]; rewrite O in *; lra. }
      replace ((lo - r) * power_form u lo * ((hi - r) * power_form u hi)) with ((lo - r) * (hi - r) * (power_form u lo * power_form u hi)) by ring.
      assert (Q : 0 < (r - lo) * (hi - r) * (power_form u lo * power_form u hi)) by (apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; lra | exact P]).
      lra.
Qed.
