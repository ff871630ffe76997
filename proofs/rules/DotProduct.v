(** Running error bounds of dot products (include/errbound/detail/running_bound.hpp; `dot_bound` of the rules tight
    and sharp), as the C++ code computes them: CompoundCode.v over the real numbers, with each operation rounded to
    the format.

    A number x has a value a and a bound sa, |a - x| <= sa. For lists of such a_i and b_i of any length, |computed
    dot product - exact one| is at most the computed bound:
        tight_dot_sound   rounding in any one direction, from 8 bits on
        sharp_dot_sound   to nearest, ties to even, from 5 bits on, the least with such bounds in the code; u is a
                          number (emin <= -p) *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool List.
From Flocq Require Import Core.
From Errbound Require Import Code CompoundCode.
From Errbound Require Format AbsoluteBound Tight Sharp.
Import ListNotations.
Open Scope R_scope.

Section Rounded.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (direction : R -> Z) {direction_valid : Valid_rnd direction}.

Notation fl := (Format.rnd p emin direction).
Notation number := (Format.number p emin).
Notation eps := (Format.eps p).
Notation eta := (Format.eta emin).
Notation smallest_normal := (Format.smallest_normal p emin).

(** The real numbers as a number type whose operations round. They have no largest number and no infinity, which no
    definition here uses. *)
Definition reals : arithmetic R := {|
  plus x y := fl (x + y);
  minus x y := fl (x - y);
  times x y := fl (x * y);
  over x y := fl (x / y);
  fma x y z := fl (x * y + z);
  root x := fl (sqrt x);
  opposite := Ropp;
  less := Rlt_bool;
  at_most := Rle_bool;
  equal := Req_bool;
  scale x e := fl (x * bpow radix2 e);
  integer := IZR;
  five_quarters := 5 / 4;
  digits := p;
  epsilon := eps;
  unit_roundoff := Format.u p;
  underflow_unit := eta;
  Code.smallest_normal := smallest_normal;
  largest := 0;
  infinity := 0
|}.

Lemma abs_reals x : Code.abs R reals x = Rabs x.
Proof.
  unfold Code.abs. cbn [less opposite integer reals]. case Rlt_bool_spec; intros.
  - now rewrite Rabs_left.
  - now rewrite Rabs_pos_eq.
Qed.
Lemma is_zero_reals a sa : Code.is_zero R reals a sa = true -> a = 0 /\ sa = 0.
Proof. apply AbsoluteBound.is_zero_true. Qed.
Lemma zero_is_zero : Code.is_zero R reals 0 0 = true.
Proof. unfold Code.is_zero. cbn [equal reals integer]. now rewrite Req_bool_true. Qed.

(** Operands of a dot product. If a factor is exactly 0, the other may be anything. *)
Definition pair_known (pair : (R * R) * (R * R)) (exact : R * R) : Prop :=
  let '((a, sa), (b, sb)) := pair in
  let '(x, y) := exact in
  number a /\ number b /\
  ((a = 0 /\ sa = 0 /\ x = 0) \/ (b = 0 /\ sb = 0 /\ y = 0) \/
   (number sa /\ number sb /\ Rabs (a - x) <= sa /\ Rabs (b - y) <= sb)).
Definition exact_dot (pairs : list (R * R)) : R := fold_right (fun xy sum => fst xy * snd xy + sum) 0 pairs.

Section Running.

(** q is the part that remains after a rounding, h the part that it takes. *)
Context (q h : R) (q_1 : 0 < q <= 1) (h_0 : 0 <= h)
  (normal : forall x, Format.smallest_normal p emin <= x -> x * q <= fl x)
  (small : forall x, 0 <= x -> x < Format.smallest_normal p emin -> x - h <= fl x).

Context (most : nat) (factor_units : nat -> Z) (underflows : nat -> nat -> Z) (own_of : bool -> R -> R -> R -> R).

Definition factor (m : nat) : R := 1 + IZR (factor_units m) * eps.
Context (factor_exact : forall m, (1 <= m <= most)%nat -> fl (1 + fl (IZR (factor_units m) * eps)) = factor m)
  (factor_pays : forall m, (1 <= m <= most)%nat -> 1 <= factor m * q ^ (m + 6))
  (lost_exact : forall m k, (k <= m <= most)%nat -> number (IZR (underflows m k) * eta))
  (lost_pays : forall m k, (INR m + 1 + 2 * INR k) * h <= IZR (underflows m k) * eta).
(** A term's own error covers the roundings of product and sum, except for h. *)
Hypothesis own_pays : forall (first : bool) a b s, number a -> number b -> number s -> (first = true -> s = 0) ->
  let product := fl (a * b) in
  let v := own_of first product s (fl (s + product)) in
  number v /\ 0 <= v /\
  exists w, 0 <= w /\ w * q <= v /\
    Rabs (product - a * b) + Rabs (fl (s + product) - (s + product)) <= w + h.

Notation running := (running R).
Notation closed := (closed R).
Notation own := (own R).
Notation inherited := (inherited R).
Notation terms := (terms R).
Notation uncertain_terms := (uncertain_terms R).
Notation close_terms := (close_terms R reals factor_units underflows).
Notation add_term := (add_term R reals most factor_units underflows).

Let rnd_number := Format.rnd_number p emin direction.
Let rnd_nonnegative := Format.rnd_nonnegative p emin direction.
Let rnd_exact := Format.rnd_exact p emin direction.
Let rnd_0 := Format.rnd_0 p emin direction.

(** Invariant: the difference D is covered by the terms' own errors W and the inherited error E, of which q^n remains
    after n roundings. *)
Record covers (r : running) (D : R) : Prop := {
  closed_number : number (closed r);
  own_number : number (own r);
  inherited_number : number (inherited r);
  closed_nonnegative : 0 <= closed r;
  own_nonnegative : 0 <= own r;
  inherited_nonnegative : 0 <= inherited r;
  few_uncertain : (uncertain_terms r <= terms r)%nat;
  none_yet : terms r = O -> own r = 0 /\ inherited r = 0;
  what_covers : exists W E, 0 <= W /\ 0 <= E /\
    W * q ^ terms r <= own r /\
    E * q ^ (terms r + 2) - 2 * INR (uncertain_terms r) * h <= inherited r /\
    D <= closed r + W + E + INR (terms r) * h
}.

Lemma power_q n : 0 < q ^ n <= 1.
Proof.
  induction n as [| n IH]; simpl; [lra |]. split; [apply Rmult_lt_0_compat; lra |].
  rewrite <- (Rmult_1_r 1). apply Rmult_le_compat; lra.
Qed.
Lemma more_roundings m n : (m <= n)%nat -> q ^ n <= q ^ m.
Proof.
  intros L. replace n with (m + (n - m))%nat by lia. rewrite pow_add.
  rewrite <- (Rmult_1_r (q ^ m)) at 2. apply Rmult_le_compat_l; [| apply power_q]. generalize (power_q m). lra.
Qed.
Lemma no_less x c : 0 <= x -> 1 <= c -> x <= x * c.
Proof. intros X C. rewrite <- (Rmult_1_r x) at 1. apply Rmult_le_compat_l; lra. Qed.
Lemma less_q x : 0 <= x -> x * q <= x.
Proof. intros P. rewrite <- (Rmult_1_r x) at 2. apply Rmult_le_compat_l; lra. Qed.
Lemma sum_lower x y : number x -> number y -> 0 <= x -> 0 <= y -> (x + y) * q <= fl (x + y).
Proof. intros. apply (Format.sum_left p emin direction q q_1 normal); auto; lra. Qed.

(** One factor covers the roundings of m terms. *)
Lemma factor_pays_less m n : (1 <= m <= most)%nat -> (n <= m + 6)%nat -> 1 <= factor m * q ^ n.
Proof.
  intros M N. apply Rle_trans with (1 := factor_pays m M). apply Rmult_le_compat_l.
  - generalize (factor_pays m M) (power_q (m + 6)). intros. apply Rnot_lt_le. intros C.
    assert (factor m * q ^ (m + 6) <= 0 * q ^ (m + 6)) by (apply Rmult_le_compat_r; lra). lra.
  - now apply more_roundings.
Qed.

Lemma close_covers r D : (1 <= terms r <= most)%nat -> covers r D ->
  covers (close_terms r) D /\ D <= closed (close_terms r).
Proof.
  intros M [Nc No Ni Pc Po Pi U _ (W & E & PW & PE & HW & HE & HD)].
  set (m := terms r) in *. set (k := uncertain_terms r) in *.
  set (S1 := fl (inherited r + closed r)). set (S2 := fl (own r + S1)).
  set (lost := IZR (underflows m k) * eta). set (S := fl (S2 + lost)).
  assert (EQ : closed (close_terms r) = fl (S * factor m)).
  { unfold CompoundCode.close_terms. cbn [CompoundCode.closed plus times integer epsilon underflow_unit reals].
    fold m k. rewrite factor_exact by exact M. rewrite (rnd_exact (IZR (underflows m k) * eta)) by (apply lost_exact; lia).
    reflexivity. }
  assert (L0 : (INR m + 1 + 2 * INR k) * h <= lost) by apply lost_pays.
  generalize (pos_INR m) (pos_INR k). intros Pm Pk.
  assert (PH : 0 <= (INR m + 1) * h) by (apply Rmult_le_pos; lra).
  assert (PK : 0 <= 2 * INR k * h) by (apply Rmult_le_pos; lra).
  assert (PL : 0 <= lost) by lra.
  assert (P1 : 0 <= S1) by (apply rnd_nonnegative; lra).
  assert (P2 : 0 <= S2) by (apply rnd_nonnegative; lra).
  assert (PS : 0 <= S) by (apply rnd_nonnegative; lra).
  assert (PF : 1 <= factor m) by (generalize (factor_pays_less m 0 M ltac:(lia)); simpl; lra).
  assert (L1 : (inherited r + closed r) * q <= S1) by (apply sum_lower; auto).
  assert (L2 : (own r + S1) * q <= S2) by (apply sum_lower; auto; apply rnd_number).
  assert (L3 : (S2 + lost) * q <= S).
  { apply sum_lower; auto; [apply rnd_number | apply lost_exact; lia]. }
  (* the remains after the sums *)
  assert (Q2 := power_q 2). assert (Q3 := power_q 3).
  assert (LS : W * q ^ (m + 2) + E * q ^ (m + 5) + closed r * q ^ 3 + (lost - 2 * INR k * h) * q <= S).
  { apply Rle_trans with (own r * q ^ 2 + inherited r * q ^ 3 + closed r * q ^ 3 + lost * q).
    - assert (W * q ^ m * q ^ 2 <= own r * q ^ 2) by (apply Rmult_le_compat_r; lra).
      assert ((E * q ^ (m + 2) - 2 * INR k * h) * q ^ 3 <= inherited r * q ^ 3) by (apply Rmult_le_compat_r; lra).
      assert (2 * INR k * h * q ^ 3 <= 2 * INR k * h * q).
      { apply Rmult_le_compat_l; auto. replace q with (q ^ 1) at 2 by ring. apply more_roundings. lia. }
      replace (W * q ^ (m + 2)) with (W * q ^ m * q ^ 2) by (rewrite pow_add; ring).
      replace (E * q ^ (m + 5)) with (E * q ^ (m + 2) * q ^ 3)
        by (replace (m + 5)%nat with ((m + 2) + 3)%nat by lia; rewrite !pow_add; ring).
      lra.
    - nra. }
  set (G := closed r + W + E + (lost - 2 * INR k * h)).
  assert (LF : G <= S * factor m /\ G <= S * factor m * q).
  { assert (Pays : forall n, (n <= m + 6)%nat -> 1 <= factor m * q ^ n) by (intros; now apply factor_pays_less).
    assert (All : forall i, (i <= 1)%nat -> G <= S * (factor m * q ^ i)).
    { intros i I. apply Rle_trans with ((W * q ^ (m + 2) + E * q ^ (m + 5) + closed r * q ^ 3 +
                         (lost - 2 * INR k * h) * q) * (factor m * q ^ i)).
      - replace ((W * q ^ (m + 2) + E * q ^ (m + 5) + closed r * q ^ 3 + (lost - 2 * INR k * h) * q) * (factor m * q ^ i))
          with (W * (factor m * q ^ (m + 2 + i)) + E * (factor m * q ^ (m + 5 + i)) +
                closed r * (factor m * q ^ (3 + i)) + (lost - 2 * INR k * h) * (factor m * q ^ (1 + i)))
          by (rewrite !pow_add; ring).
        generalize (no_less W _ PW (Pays (m + 2 + i)%nat ltac:(lia)))
          (no_less E _ PE (Pays (m + 5 + i)%nat ltac:(lia)))
          (no_less _ _ Pc (Pays (3 + i)%nat ltac:(lia)))
          (no_less (lost - 2 * INR k * h) _ ltac:(lra) (Pays (1 + i)%nat ltac:(lia))). unfold G. lra.
      - apply Rmult_le_compat_r; [| exact LS]. apply Rmult_le_pos; [lra |]. generalize (power_q i). lra. }
    split.
    - generalize (All 0%nat ltac:(lia)). simpl. now rewrite Rmult_1_r.
    - generalize (All 1%nat ltac:(lia)). simpl. now rewrite Rmult_1_r, Rmult_assoc. }
  assert (LC : D <= fl (S * factor m)).
  { destruct (Rlt_or_le (S * factor m) (Format.smallest_normal p emin)) as [C | C]; unfold G in *;
      [apply small in C; [lra | apply Rmult_le_pos; lra] | apply normal in C; lra]. }
  rewrite <- EQ in LC. split; [| exact LC].
  assert (NC : number (closed (close_terms r))) by (rewrite EQ; apply rnd_number).
  assert (PC : 0 <= closed (close_terms r)) by (rewrite EQ; apply rnd_nonnegative, Rmult_le_pos; lra).
  split; auto; cbn [CompoundCode.own CompoundCode.inherited CompoundCode.terms CompoundCode.uncertain_terms
                      CompoundCode.close_terms integer reals]; try apply Format.number_0; try lra; try lia; auto.
  exists 0, 0. cbn [INR]. repeat split; lra.
Qed.

(** The inherited error of an uncertain product is computed with five roundings. *)
Lemma inherited_lower a sa b sb : number a -> number b -> number sa -> number sb -> 0 <= sa -> 0 <= sb ->
  let I := fl (fl (Rabs a * sb) + fl (sa * fl (Rabs b + sb))) in
  0 <= I /\ (Rabs a * sb + sa * (Rabs b + sb)) * q ^ 3 - 2 * h <= I.
Proof.
  intros A B SA SB PA PB. cbv zeta.
  destruct (Format.product_left p emin direction q h q_1 h_0 normal small (Rabs a) sa (Rabs b) sb) as (_ & P & L & _);
    auto using Rabs_pos, Format.number_abs.
  split; auto. apply Rle_trans with (2 := L). generalize (less_q h h_0). simpl. lra.
Qed.

Lemma add_covers r D v w a sa b sb : (terms r < most)%nat -> covers r D ->
  number v -> 0 <= v -> 0 <= w -> w * q <= v ->
  number a -> number b -> number sa -> number sb -> 0 <= sa -> 0 <= sb ->
  covers (add_term r v a sa b sb) (D + w + h + (Rabs a * sb + sa * (Rabs b + sb))) /\
  (terms (add_term r v a sa b sb) < most)%nat.
Proof.
  intros M [Nc No Ni Pc Po Pi U Z (W & E & PW & PE & HW & HE & HD)] Nv Pv Pw Hw A B SA SB PA PB.
  set (t := Rabs a * sb + sa * (Rabs b + sb)).
  assert (Pt : 0 <= t).
  { generalize (Rabs_pos a) (Rabs_pos b). intros. apply Rplus_le_le_0_compat; apply Rmult_le_pos; lra. }
  destruct (inherited_lower a sa b sb A B SA SB PA PB) as [PI LI]. cbv zeta in PI, LI. fold t in LI.
  set (I := fl (fl (Rabs a * sb) + fl (sa * fl (Rabs b + sb)))) in *.
  set (m := terms r) in *. set (k := uncertain_terms r) in *.
  set (exact := Req_bool sa 0 && Req_bool sb 0).
  set (r' := {| CompoundCode.closed := closed r;
    CompoundCode.own := fl (own r + v);
    CompoundCode.inherited := if exact then inherited r else fl (inherited r + I);
    CompoundCode.terms := S m;
    CompoundCode.uncertain_terms := if exact then k else S k |} : running).
  assert (EQ : add_term r v a sa b sb = if Nat.eqb (S m) most then close_terms r' else r').
  { unfold CompoundCode.add_term. rewrite !abs_reals. reflexivity. }
  generalize (pos_INR k) (power_q m). intros Pk Qm.
  assert (C : covers r' (D + w + h + t)).
  { assert (Ex : exact = true -> t = 0).
    { unfold exact, t. intros X. apply andb_prop in X. destruct X as [X1 X2].
      revert X1 X2. case Req_bool_spec; [intros -> _ | discriminate]. case Req_bool_spec; [intros -> _ | discriminate].
      ring. }
    split; unfold r'; cbn [CompoundCode.closed CompoundCode.own CompoundCode.inherited CompoundCode.terms
      CompoundCode.uncertain_terms]; auto.
    - destruct exact; [exact Ni | apply rnd_number].
    - apply rnd_nonnegative. lra.
    - destruct exact; [exact Pi | apply rnd_nonnegative; lra].
    - destruct exact; lia.
    - discriminate.
    - exists (W + w), (E + t). split; [lra |]. split; [lra |]. split; [| split].
      + destruct m as [| m'] eqn:M0.
        * destruct (Z eq_refl) as [Z1 _]. rewrite Z1 in *. rewrite Rplus_0_l, rnd_exact by auto.
          simpl in HW |- *. assert (W0 : W = 0) by lra. rewrite W0. lra.
        * rewrite <- M0 in *. assert (L : (own r + v) * q <= fl (own r + v)) by (apply sum_lower; auto).
          apply Rle_trans with (2 := L). simpl.
          assert (W * q ^ m * q <= own r * q) by (apply Rmult_le_compat_r; lra).
          assert (w * q ^ m <= w * q).
          { apply Rmult_le_compat_l; auto. replace q with (q ^ 1) at 2 by ring. apply more_roundings. lia. }
          assert (w * q ^ m * q <= v * q) by (apply Rmult_le_compat_r; lra). lra.
      + destruct exact.
        * rewrite (Ex eq_refl), Rplus_0_r.
          assert (E * q ^ (S m + 2) <= E * q ^ (m + 2)) by (apply Rmult_le_compat_l; [auto | apply more_roundings; lia]).
          lra.
        * rewrite S_INR. destruct m as [| m'] eqn:M0.
          -- destruct (Z eq_refl) as [_ Z2]. rewrite Z2 in *. rewrite Rplus_0_l, rnd_exact by apply rnd_number.
             assert (K0 : k = O) by lia. rewrite K0 in *. simpl in HE, LI |- *.
             assert (P2 : 0 < q * (q * 1)) by (generalize (power_q 2); simpl; lra).
             assert (E0 : E = 0) by nra. rewrite E0. lra.
          -- rewrite <- M0 in *.
             assert (L : (inherited r + I) * q <= fl (inherited r + I)) by (apply sum_lower; auto; apply rnd_number).
             apply Rle_trans with (2 := L).
             assert (H1 : (E * q ^ (m + 2) - 2 * INR k * h) * q <= inherited r * q) by (apply Rmult_le_compat_r; lra).
             assert (H2 : (t * q ^ 3 - 2 * h) * q <= I * q) by (apply Rmult_le_compat_r; lra).
             assert (H3 : t * q ^ (S m + 2) <= t * q ^ 4) by (apply Rmult_le_compat_l; [auto | apply more_roundings; lia]).
             assert (H4 : 2 * (INR k + 1) * h * q <= 2 * (INR k + 1) * h).
             { apply less_q. apply Rmult_le_pos; lra. }
             replace ((E + t) * q ^ (S m + 2)) with (E * q ^ (m + 2) * q + t * q ^ (S m + 2)) by (simpl; ring).
             replace (t * q ^ 4) with (t * q ^ 3 * q) in H3 by ring. lra.
      + rewrite S_INR. lra. }
  rewrite EQ. destruct (Nat.eqb_spec (S m) most) as [EM | EM].
  - split; [apply close_covers; auto; unfold r'; cbn [CompoundCode.terms]; lia |].
    unfold CompoundCode.close_terms. cbn [CompoundCode.terms]. lia.
  - split; [exact C |]. unfold r'. cbn [CompoundCode.terms]. lia.
Qed.

(** The loop. *)
Definition in_loop (s : R * bool * running) (X : R) : Prop :=
  let '(sum, first, r) := s in
  number sum /\ (first = true -> sum = 0) /\ covers r (Rabs (sum - X)) /\ (terms r < most)%nat.

Lemma covers_less r D D' : D' <= D -> covers r D -> covers r D'.
Proof.
  intros L [? ? ? ? ? ? ? ? (W & E & H1 & H2 & H3 & H4 & H5)]. split; auto.
  exists W, E. repeat split; auto. lra.
Qed.
Lemma step_covers s X pair exact : in_loop s X -> pair_known pair exact ->
  in_loop (dot_step R reals most factor_units underflows own_of s pair) (X + fst exact * snd exact).
Proof.
  destruct s as [[sum first] r], pair as [[a sa] [b sb]], exact as [x y].
  intros (Ns & Z & C & M) (A & B & K). unfold dot_step. cbn [fst snd plus times reals].
  set (product := fl (a * b)). set (after := fl (sum + product)).
  assert (Zero : forall c d, c = 0 \/ d = 0 -> c * d = 0) by (intros c d [-> | ->]; ring).
  destruct (is_zero R reals a sa || is_zero R reals b sb) eqn:C0.
  - (* nothing is added *)
    assert (H : a * b = 0 /\ x * y = 0).
    { apply orb_prop in C0. destruct C0 as [C0 | C0]; apply is_zero_reals in C0; destruct C0 as [V S0].
      - split; [now rewrite V, Rmult_0_l |]. apply Zero. destruct K as [(_ & _ & K) | [(_ & _ & K) | (_ & _ & K & _)]]; auto.
        left. rewrite S0 in K. apply Format.within_0 in K. congruence.
      - split; [now rewrite V, Rmult_0_r |]. apply Zero. destruct K as [(_ & _ & K) | [(_ & _ & K) | (_ & _ & _ & K)]]; auto.
        right. rewrite S0 in K. apply Format.within_0 in K. congruence. }
    destruct H as [H1 H2]. assert (EA : after = sum).
    { unfold after, product. rewrite H1, rnd_0, Rplus_0_r. now apply rnd_exact. }
    rewrite EA, H2, Rplus_0_r. split; [exact Ns |]. split; [exact Z |]. now split.
  - (* a term *)
    assert (K' : number sa /\ number sb /\ Rabs (a - x) <= sa /\ Rabs (b - y) <= sb).
    { destruct K as [(-> & -> & _) | [(-> & -> & _) | K]]; auto; exfalso; revert C0; rewrite zero_is_zero;
        [discriminate | now rewrite orb_true_r]. }
    destruct K' as (SA & SB & HA & HB).
    assert (PA : 0 <= sa) by (generalize (Rabs_pos (a - x)); lra).
    assert (PB : 0 <= sb) by (generalize (Rabs_pos (b - y)); lra).
    destruct (own_pays first a b sum A B Ns Z) as (Nv & Pv & w & Pw & Lw & Hw).
    fold product in Nv, Pv, Lw, Hw. fold after in Nv, Pv, Lw, Hw.
    destruct (add_covers r _ (own_of first product sum after) w a sa b sb M C Nv Pv Pw Lw A B SA SB PA PB) as [C' M'].
    split; [apply rnd_number |]. split; [discriminate |]. split; [| exact M'].
    apply covers_less with (2 := C').
    replace (after - (X + x * y)) with
      ((after - (sum + product)) + ((product - a * b) + ((a * b - x * y) + (sum - X)))) by ring.
    generalize (AbsoluteBound.product_inherits a x sa b y sb HA HB)
      (Rabs_triang (after - (sum + product)) ((product - a * b) + ((a * b - x * y) + (sum - X))))
      (Rabs_triang (product - a * b) ((a * b - x * y) + (sum - X))) (Rabs_triang (a * b - x * y) (sum - X)). lra.
Qed.
Lemma loop_covers pairs exacts : Forall2 pair_known pairs exacts -> forall s X, in_loop s X ->
  in_loop (fold_left (dot_step R reals most factor_units underflows own_of) pairs s) (X + exact_dot exacts).
Proof.
  induction 1 as [| pair exact pairs exacts K _ IH]; intros s X L; simpl.
  - now rewrite Rplus_0_r.
  - rewrite <- Rplus_assoc. apply IH, step_covers; auto.
Qed.

Lemma dot_covered pairs exacts : (1 <= most)%nat -> Forall2 pair_known pairs exacts ->
  let '(sum, bound) := dot_of R reals most factor_units underflows own_of pairs in
  number bound /\ Rabs (sum - exact_dot exacts) <= bound.
Proof.
  intros M K. unfold dot_of.
  assert (L : in_loop (0, true, no_terms R reals) 0).
  { split; [apply Format.number_0 |]. split; [auto |]. split; [| exact M].
    rewrite Rminus_0_r, Rabs_R0.
    split; cbn; try apply Format.number_0; try lra; try lia; auto. exists 0, 0. repeat split; lra. }
  apply (loop_covers _ _ K) in L. rewrite Rplus_0_l in L. cbn [integer reals].
  destruct (fold_left _ pairs _) as [[sum first] r]. destruct L as (Ns & _ & C & T).
  cbn [plus minus reals]. replace (sum - sum) with 0 by ring. rewrite rnd_0, Rplus_0_r.
  assert (H : number (closed_bound R reals factor_units underflows r) /\
              Rabs (sum - exact_dot exacts) <= closed_bound R reals factor_units underflows r).
  { unfold closed_bound. destruct (Nat.ltb_spec 0 (terms r)) as [P | P].
    - destruct (close_covers r _ ltac:(lia) C) as [C' L]. split; [apply (closed_number _ _ C') | exact L].
    - split; [apply (closed_number _ _ C) |].
      destruct C as [Nc No Ni Pc Po Pi U Z (W & E & PW & PE & HW & HE & HD)].
      assert (T0 : terms r = O) by lia. destruct (Z T0) as [Z1 Z2]. rewrite T0, Z1, Z2 in *.
      assert (U0 : uncertain_terms r = O) by lia. rewrite U0 in *. simpl in HW, HE, HD.
      assert (W0 : W = 0) by lra. generalize (power_q 2). simpl. intros Q2.
      assert (E0 : E = 0) by nra. rewrite W0, E0 in HD. lra. }
  destruct H as [H1 H2]. rewrite rnd_exact by auto. split; auto.
Qed.

End Running.
End Rounded.

(** A number of terms with (m + 6)^2 <= 2^bits, and at least one from 6 bits on. *)
Lemma terms_squared bits m : (1 <= m <= terms_at_once bits)%nat ->
  (m <= 8)%nat /\ (INR m + 6) * (INR m + 6) <= bpow radix2 bits.
Proof.
  assert (G : forall n, (n <= 8)%nat -> (most_terms bits n <= n)%nat /\
    (most_terms bits n = O \/ Z.of_nat (most_terms bits n + 6) * Z.of_nat (most_terms bits n + 6) <= 2 ^ bits)%Z).
  { induction n as [| n IH]; intros N; cbn [most_terms]; [split; auto |].
    destruct ((bits <? 8) && _)%Z eqn:C.
    - destruct IH as [I1 I2]; [lia |]. split; [lia | exact I2].
    - split; [lia |]. right. apply andb_false_iff in C. destruct C as [C | C].
      + apply Z.ltb_ge in C. apply Z.le_trans with (2 ^ 8)%Z; [| apply Z.pow_le_mono_r; lia].
        apply Z.le_trans with (Z.of_nat 14 * Z.of_nat 14)%Z; [apply Z.mul_le_mono_nonneg; lia | simpl; lia].
      + now apply Z.ltb_ge in C. }
  intros H. destruct (G 8%nat ltac:(lia)) as [G1 G2]. fold (terms_at_once bits) in G1, G2.
  split; [lia |]. destruct G2 as [G2 | G2]; [lia |].
  assert (B : (0 <= bits)%Z).
  { destruct (Z.neg_nonneg_cases bits) as [N | N]; auto. rewrite (Z.pow_neg_r 2 bits N) in G2. lia. }
  rewrite <- IZR_Zpower by exact B. change (radix_val radix2) with 2%Z.
  rewrite INR_IZR_INZ, <- plus_IZR, <- mult_IZR. apply IZR_le. apply Z.le_trans with (2 := G2).
  apply Z.mul_le_mono_nonneg; lia.
Qed.
Lemma one_at_least bits : (6 <= bits)%Z -> (1 <= terms_at_once bits)%nat.
Proof.
  intros B. destruct (Z.eq_dec bits 6) as [-> | N6]; [unfold terms_at_once; simpl; lia |].
  destruct (Z.eq_dec bits 7) as [-> | N7]; [unfold terms_at_once; simpl; lia |].
  unfold terms_at_once. cbn [most_terms]. rewrite (proj2 (Z.ltb_ge bits 8)) by lia. simpl. lia.
Qed.

(** Constants are exact. *)
Section Constants.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation fl := (Format.rnd p emin direction).

Lemma small_units_exact n : (emin <= 1 - p)%Z -> (0 <= n <= 2 ^ (p - 1))%Z ->
  fl (1 + fl (IZR n * Format.eps p)) = 1 + IZR n * Format.eps p.
Proof.
  intros H N. assert (P : (0 < p)%Z) by exact p_positive.
  assert (T : (2 ^ p = 2 * 2 ^ (p - 1))%Z).
  { replace p with (1 + (p - 1))%Z at 1 by lia. rewrite Z.pow_add_r by lia. reflexivity. }
  rewrite (Format.rnd_exact p emin direction (IZR n * Format.eps p)) by (apply Format.number_integer; auto; lia).
  apply Format.rnd_exact; auto. unfold Format.eps.
  replace (1 + IZR n * bpow radix2 (1 - p)) with (IZR (2 ^ (p - 1) + n) * bpow radix2 (1 - p)).
  - apply Format.number_integer; auto; lia.
  - rewrite plus_IZR, Rmult_plus_distr_r. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
    rewrite <- bpow_plus. replace (p - 1 + (1 - p))%Z with 0%Z by lia. reflexivity.
Qed.
Lemma small_multiple n : (0 <= n <= 2 ^ p)%Z -> Format.number p emin (IZR n * Format.eta emin).
Proof. intros N. apply Format.number_integer; auto; lia. Qed.

End Constants.

(** Rule tight. *)
Section Tight_dot.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (emin_p : (emin <= - p)%Z) (p_8 : (8 <= p)%Z) (direction : R -> Z)
  {direction_valid : Valid_rnd direction}.
Notation fl := (Format.rnd p emin direction).
Notation r := (Format.eps p).
Notation h := (Format.eta emin).
Let E : Format.rounding_error p emin direction r h := Format.rounding_error_any p emin direction ltac:(lia).

Lemma power_linear e n : 0 <= e <= 1 -> 1 - INR n * e <= (1 - e) ^ n.
Proof.
  intros H. induction n as [| n IH]; [simpl; lra |]. rewrite S_INR, <- tech_pow_Rmult.
  apply Rle_trans with ((1 - e) * (1 - INR n * e)); [| apply Rmult_le_compat_l; lra].
  generalize (pos_INR n). intros P. assert (0 <= INR n * (e * e)) by (apply Rmult_le_pos; nra). nra.
Qed.
Lemma tight_factor_pays m : (1 <= m <= tight_most R (reals p emin direction))%nat ->
  1 <= factor p tight_units m * (1 - r) ^ (m + 6).
Proof.
  intros M. apply terms_squared in M. destruct M as [M L]. cbn [digits reals] in L.
  generalize (Format.error_r _ _ _ _ _ E) (Format.error_r_1 _ _ _ _ _ E) (Format.eps_positive p) (pos_INR m).
  intros Rr R1 Pe Pm.
  assert (SQ : (INR m + 6) * (INR m + 6) * Format.eps p <= / 2).
  { apply Rle_trans with (bpow radix2 (p - 2) * Format.eps p); [apply Rmult_le_compat_r; lra |].
    unfold Format.eps. rewrite <- bpow_plus. replace (p - 2 + (1 - p))%Z with (-1)%Z by lia. simpl. lra. }
  apply Rle_trans with (factor p tight_units m * (1 - INR (m + 6) * r)).
  2: { apply Rmult_le_compat_l; [| apply power_linear; lra].
       unfold factor, tight_units. rewrite <- INR_IZR_INZ. generalize (pos_INR (m + 7)). intros.
       assert (0 <= INR (m + 7) * Format.eps p) by (apply Rmult_le_pos; lra). lra. }
  unfold factor, tight_units. rewrite <- INR_IZR_INZ, !plus_INR.
  replace (INR 7) with 7 by (simpl; ring). replace (INR 6) with 6 by (simpl; ring).
  set (j := INR m + 6) in *. replace (INR m + 7) with (j + 1) by (unfold j; ring).
  assert (J : 6 <= j) by (unfold j; lra). set (e := Format.eps p) in *.
  replace ((1 + (j + 1) * e) * (1 - j * e)) with (1 + e * (1 - (j * j * e + j * e))) by ring.
  assert (j * e <= j * j * e) by (apply Rmult_le_compat_r; nra).
  assert (0 <= e * (1 - (j * j * e + j * e))) by (apply Rmult_le_pos; lra). lra.
Qed.

Lemma two_p : (2 ^ 8 <= 2 ^ p)%Z /\ (2 ^ 7 <= 2 ^ (p - 1))%Z.
Proof. split; apply Z.pow_le_mono_r; lia. Qed.

Lemma tight_dot_covered pairs exacts : Forall2 (pair_known p emin) pairs exacts ->
  let '(sum, bound) := tight_dot R (reals p emin direction) pairs in
  Format.number p emin bound /\ Rabs (sum - exact_dot exacts) <= bound.
Proof.
  generalize (Format.error_r _ _ _ _ _ E) (Format.error_r_1 _ _ _ _ _ E) (Format.error_h _ _ _ _ _ E)
    (Format.eta_positive emin) two_p. change (2 ^ 8)%Z with 256%Z. change (2 ^ 7)%Z with 128%Z. intros Rr R1 Rh Pe [T8 T7].
  assert (P3 : (3 <= p)%Z) by lia.
  apply dot_covered with (1 - r) h; auto; try lra.
  - apply (Format.rnd_relative p emin direction r h E).
  - intros x P C. apply (Format.rnd_absolute p emin direction r h E x P C).
  - intros m M. apply terms_squared in M. unfold factor, tight_units. apply small_units_exact; auto; lia.
  - apply tight_factor_pays.
  - intros m k L. assert (m <= 8)%nat.
    { destruct m as [| m']; [lia |]. apply (terms_squared (p - 2) (S m')). change (p - 2)%Z with (digits R (reals p emin direction) - 2)%Z. fold (tight_most R (reals p emin direction)). lia. }
    unfold tight_underflows. apply small_multiple; auto; lia.
  - intros m k. unfold tight_underflows. rewrite <- INR_IZR_INZ, !plus_INR, mult_INR. simpl (INR 1). simpl (INR 2).
    generalize (pos_INR m) (pos_INR k). intros.
    apply Rle_trans with ((INR m + 1 + 2 * INR k) * Format.eta emin); [apply Rmult_le_compat_l | right; ring]; lra.
  - intros first a b s A B S Z. cbv zeta. set (product := fl (a * b)). set (after := fl (s + product)).
    unfold tight_own. cbn [plus integer reals].
    assert (RT : forall v, tight_rounding R (reals p emin direction) v = Tight.rounding p emin direction v).
    { intros v. unfold tight_rounding. rewrite abs_reals. reflexivity. }
    rewrite !RT. set (R2 := if first then 0 else Tight.rounding p emin direction after).
    generalize (Tight.rounding_nonnegative p emin direction P3 emin_p product). intros PR1.
    assert (PR2 : 0 <= R2) by (unfold R2; destruct first; [lra | now apply Tight.rounding_nonnegative]).
    assert (NR2 : Format.number p emin R2).
    { unfold R2. destruct first; [apply Format.number_0 | now apply Format.rnd_number]. }
    assert (NP : Format.number p emin product) by now apply Format.rnd_number.
    split; [now apply Format.rnd_number |]. split; [apply Format.rnd_nonnegative; auto; lra |].
    exists (Tight.rounding p emin direction product + R2). split; [lra |]. split.
    + apply (Format.sum_relative p emin direction r h E); auto. now apply Format.rnd_number.
    + generalize (Tight.rounding_any p emin direction P3 emin_p r h E (a * b)). fold product. intros D1.
      enough (Rabs (after - (s + product)) <= R2) by lra. unfold R2, after. destruct first.
      * rewrite (Z eq_refl), Rplus_0_l, (Format.rnd_exact p emin direction product NP), Rminus_eq_0, Rabs_R0. lra.
      * now apply Tight.rounding_sum.
  - apply one_at_least. cbn [digits reals]. lia.
Qed.

End Tight_dot.

(** Rule sharp. *)
Section Sharp_dot.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (emin_p : (emin <= - p)%Z) (p_5 : (5 <= p)%Z).
Notation nearest := Format.nearest.
Notation fl := (Format.rnd p emin nearest).
Notation u := (Format.u p).
Notation number := (Format.number p emin).

Lemma sharp_factor_pays m : (1 <= m <= sharp_most R (reals p emin nearest))%nat ->
  1 <= factor p sharp_units m * (/ (1 + u)) ^ (m + 6).
Proof.
  intros M. apply terms_squared in M. destruct M as [M L]. cbn [digits reals] in L.
  generalize (Format.u_positive p) (Format.eps_2u p) (pos_INR m) (Format.eps_le p 5 p_5). simpl (bpow radix2 (1 - 5)).
  intros Pu E2 Pm P5.
  set (j := INR (m + 6)). assert (EJ : j = INR m + 6) by (unfold j; rewrite plus_INR; simpl (INR 6); ring).
  assert (SQ : j * u * (j * u) <= 2 * u).
  { rewrite EJ. replace ((INR m + 6) * u * ((INR m + 6) * u)) with ((INR m + 6) * (INR m + 6) * (u * u)) by ring.
    apply Rle_trans with (bpow radix2 (p + 1) * (u * u)); [apply Rmult_le_compat_r; nra |].
    right. unfold Format.u. rewrite <- !bpow_plus. change 2 with (bpow radix2 1). rewrite <- bpow_plus. f_equal. lia. }
  assert (J1 : j * u <= 1).
  { assert (0 <= j * u) by (apply Rmult_le_pos; lra). nra. }
  assert (Q := Format.power_quadratic u (m + 6) ltac:(lra) J1). fold j in Q.
  rewrite pow_inv. apply Rmult_le_reg_r with ((1 + u) ^ (m + 6)); [apply pow_lt; lra |].
  rewrite Rmult_1_l, Rmult_assoc, Rinv_l, Rmult_1_r by (apply pow_nonzero; lra).
  apply Rle_trans with (1 := Q). unfold factor, sharp_units. rewrite E2, plus_IZR.
  assert (H : j <= 2 * IZR (Z.of_nat (m + 7) / 2)).
  { unfold j. rewrite INR_IZR_INZ. change 2 with (IZR 2). rewrite <- mult_IZR. apply IZR_le.
    generalize (Z.div_mod (Z.of_nat (m + 7)) 2) (Z.mod_pos_bound (Z.of_nat (m + 7)) 2). lia. }
  assert (j * u <= 2 * IZR (Z.of_nat (m + 7) / 2) * u) by (apply Rmult_le_compat_r; lra). lra.
Qed.

Lemma sharp_dot_covered pairs exacts : Forall2 (pair_known p emin) pairs exacts ->
  let '(sum, bound) := sharp_dot R (reals p emin nearest) pairs in
  number bound /\ Rabs (sum - exact_dot exacts) <= bound.
Proof.
  assert (P3 : (3 <= p)%Z) by lia.
  generalize (Format.u_positive p) (Format.eta_positive emin) (Sharp.u_8 p P3) (Sharp.q_1 p P3). intros Pu Pe U8 Q1.
  assert (E := Format.rounding_error_nearest p emin ltac:(lia)).
  assert (T5 : (2 ^ 5 <= 2 ^ p)%Z) by (apply Z.pow_le_mono_r; lia). change (2 ^ 5)%Z with 32%Z in T5.
  assert (T4 : (2 ^ 4 <= 2 ^ (p - 1))%Z) by (apply Z.pow_le_mono_r; lia). change (2 ^ 4)%Z with 16%Z in T4.
  apply dot_covered with (/ (1 + u)) (Format.eta emin / 2); auto with typeclass_instances; try lra.
  - now apply (Sharp.normal_relative p emin P3).
  - intros x P C. apply (Format.rnd_absolute p emin nearest _ _ E x P C).
  - intros m M. apply terms_squared in M. unfold factor, sharp_units.
    assert (Z.of_nat (m + 7) / 2 < 8)%Z by (apply Z.div_lt_upper_bound; lia).
    assert (0 <= Z.of_nat (m + 7) / 2)%Z by (apply Z.div_pos; lia).
    apply small_units_exact; auto with typeclass_instances; lia.
  - apply sharp_factor_pays.
  - intros m k L. assert (m <= 8)%nat.
    { destruct m as [| m']; [lia |]. apply (terms_squared (p + 1) (S m')).
      change (p + 1)%Z with (digits R (reals p emin nearest) + 1)%Z. fold (sharp_most R (reals p emin nearest)). lia. }
    unfold sharp_underflows. apply small_multiple; auto; lia.
  - intros m k. unfold sharp_underflows. rewrite <- INR_IZR_INZ, !plus_INR. simpl (INR 1).
    generalize (pos_INR m) (pos_INR k). intros.
    assert (0 <= INR m * Format.eta emin) by (apply Rmult_le_pos; lra). lra.
  - intros first a b s A B S _. cbv zeta. set (product := fl (a * b)). set (after := fl (s + product)).
    unfold sharp_own. cbn [plus integer reals].
    assert (RT : forall v, sharp_rounding R (reals p emin nearest) v = Sharp.rounding p emin v).
    { intros v. unfold sharp_rounding. rewrite abs_reals. reflexivity. }
    rewrite !RT, !abs_reals.
    assert (LM : forall m n, least R (reals p emin nearest) m n = Rmin m n).
    { intros m n. unfold least. cbn [less reals]. case Rlt_bool_spec; intros; [rewrite Rmin_right | rewrite Rmin_left]; lra. }
    rewrite !LM.
    set (R1 := Sharp.rounding p emin product). set (R2 := Rmin _ _).
    assert (PR1 : 0 <= R1) by apply (Sharp.rounding_nonnegative p emin P3).
    assert (NP : number product) by apply (Format.rnd_number p emin nearest).
    assert (NR2 : number R2).
    { unfold R2. apply Rmin_case; [apply (Format.rnd_number p emin nearest) |].
      apply Rmin_case; now apply Format.number_abs. }
    assert (D2 : Rabs (after - (s + product)) <= R2).
    { (* s and the product are possible values of the sum *)
      assert (Near : forall g, number g -> Rabs (after - (s + product)) <= Rabs (g - (s + product))).
      { intros g G. apply (round_N_pt radix2 (FLT_exp emin p) (fun n => negb (Z.even n)) (s + product)); auto. }
      unfold R2. apply Rmin_glb; [now apply (Sharp.rounding_sum p emin P3) |]. apply Rmin_glb.
      - apply Rle_trans with (1 := Near s S). right. rewrite <- (Rabs_Ropp product). f_equal. ring.
      - apply Rle_trans with (1 := Near product NP). right. rewrite <- (Rabs_Ropp s). f_equal. ring. }
    assert (PR2 : 0 <= R2) by (generalize (Rabs_pos (after - (s + product))); lra).
    split; [now apply Format.rnd_number, valid_rnd_N |]. split; [apply (Format.rnd_nonnegative p emin nearest); lra |].
    exists (R1 + R2). split; [lra |]. split.
    + apply (Sharp.sum_relative p emin P3); auto; [apply (Format.rnd_number p emin nearest) | lra].
    + generalize (Sharp.rounding_any p emin P3 (a * b)). fold product. fold R1. lra.
  - apply one_at_least. cbn [digits reals]. lia.
Qed.

End Sharp_dot.

(** The theorems. *)
Section Sound.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (emin_p : (emin <= - p)%Z).

Theorem tight_dot_sound (direction : R -> Z) {direction_valid : Valid_rnd direction} pairs exacts : (8 <= p)%Z ->
  Forall2 (pair_known p emin) pairs exacts ->
  let '(sum, bound) := tight_dot R (reals p emin direction) pairs in
  Format.number p emin bound /\ Rabs (sum - exact_dot exacts) <= bound.
Proof. intros P. now apply tight_dot_covered. Qed.
Theorem sharp_dot_sound pairs exacts : (5 <= p)%Z ->
  Forall2 (pair_known p emin) pairs exacts ->
  let '(sum, bound) := sharp_dot R (reals p emin Format.nearest) pairs in
  Format.number p emin bound /\ Rabs (sum - exact_dot exacts) <= bound.
Proof. intros P. now apply sharp_dot_covered. Qed.

End Sound.
