(** Vertex/edge contact in closed form (ccd/exact/vertex_edge_contact.hpp, ccd/exact/common_roots.hpp), over the real
    numbers, since the code's integers and signs are exact. Results:
        common_roots_right              the common roots of quadratics inside (0, 1)
        first_root_told                 the first root of f in (0, 1) with b <= 0, every branch (VertexEdgeTime.v)
        nonpositive_at_a_root_right     b <= 0 at some root of f in (0, 1): there is a first one
        contact_right                   `vertex_touches_edge` is true exactly if vertex and edge meet in [0, 1] *)

From Coq Require Import Reals ZArith Lra Psatz List Bool.
From Errbound Require Import Sign Bernstein Contact.
Import ListNotations.
Open Scope R_scope.

(** ** Exact numbers *)

Definition sign_of_real (x : R) : sign :=
  if Rlt_dec 0 x then positive else if Rlt_dec x 0 then negative else zero.
Lemma sign_of_real_right x : sign_is_right (sign_of_real x) x.
Proof. unfold sign_of_real. destruct Rlt_dec; [easy |]. destruct Rlt_dec; simpl; lra. Qed.
Program Definition reals : scalar := {|
  number := R; add := Rplus; sub := Rminus; mul := Rmult; opp := Ropp; whole := IZR;
  twice := fun x => 2 * x; normalized := fun p => p; sign_of := sign_of_real; exact := fun x => x;
  sign_right := sign_of_real_right |}.
Next Obligation.
  exists 1. split; [lra |]. rewrite map_id. induction p as [| a l IH]; simpl; [easy |].
  rewrite <- IH. f_equal. ring.
Qed.

Definition times (a b : sign) : sign :=
  match a, b with
  | zero, _ | _, zero => zero
  | uncertain, _ | _, uncertain => uncertain
  | positive, positive | negative, negative => positive
  | _, _ => negative
  end.
Definition certainly_nonpositive (s : sign) : bool :=
  match s with zero | negative => true | _ => false end.
Definition certain (s : sign) : bool := match s with uncertain => false | _ => true end.
(** x <= 0, x < 0 and x = 0 for numbers. *)
Definition nonpositive (x : R) : bool := if Rle_dec x 0 then true else false.
Definition below_0 (x : R) : bool := if Rlt_dec x 0 then true else false.
Definition is_0 (x : R) : bool := if Req_EM_T x 0 then true else false.
Lemma nonpositive_true x : nonpositive x = true <-> x <= 0.
Proof. unfold nonpositive. destruct Rle_dec; split; easy. Qed.
Lemma is_0_true x : is_0 x = true <-> x = 0.
Proof. unfold is_0. destruct Req_EM_T; split; easy. Qed.

Lemma sign_positive x : 0 < x -> sign_of_real x = positive.
Proof. unfold sign_of_real. destruct Rlt_dec; easy. Qed.
Lemma sign_negative x : x < 0 -> sign_of_real x = negative.
Proof. unfold sign_of_real. intros. destruct Rlt_dec; [lra |]. destruct Rlt_dec; easy. Qed.
Lemma sign_zero x : x = 0 -> sign_of_real x = zero.
Proof. unfold sign_of_real. intros. destruct Rlt_dec; [lra |]. destruct Rlt_dec; [lra | easy]. Qed.
Lemma sign_product a b : sign_of_real (a * b) = times (sign_of_real a) (sign_of_real b).
Proof.
  destruct (Rtotal_order a 0) as [A | [A | A]], (Rtotal_order b 0) as [B | [B | B]].
  all: first [rewrite (sign_negative a A) | rewrite (sign_zero a A) | rewrite (sign_positive a A)].
  all: first [rewrite (sign_negative b B) | rewrite (sign_zero b B) | rewrite (sign_positive b B)].
  all: simpl; first [apply sign_positive | apply sign_negative | apply sign_zero]; subst; nra.
Qed.

(** ** Quadratics *)

Record quadratic := Quadratic { c0 : R; c1 : R; c2 : R }.
Definition coefficients (f : quadratic) : list reals := [c0 f; c1 f; c2 f].
(** The form, and its polynomial in x = t/s. *)
Definition value (f : quadratic) (s t : R) : R := c0 f * s ^ 2 + c1 f * s * t + c2 f * t ^ 2.
Definition at_ratio (f : quadratic) (x : R) : R := c0 f + c1 f * x + c2 f * x ^ 2.
Definition quadratic_at (f : quadratic) (t : R) : R := value f (1 - t) t.

Lemma value_of_code f s t : value_at (S := reals) (coefficients f) s t = value f s t.
Proof. unfold value. cbn. ring. Qed.
Lemma at_time_quadratic f t : at_time (coefficients f) t = quadratic_at f t.
Proof. unfold at_time, quadratic_at, value. simpl. ring. Qed.
Lemma value_ratio f s t : s <> 0 -> value f s t = s ^ 2 * at_ratio f (t / s).
Proof. intros. unfold value, at_ratio. field. easy. Qed.
Lemma ratio_sign f s t : 0 < s -> (value f s t = 0 <-> at_ratio f (t / s) = 0) /\
  (value f s t <= 0 <-> at_ratio f (t / s) <= 0).
Proof.
  intros S. rewrite value_ratio by lra. assert (0 < s ^ 2) by (apply pow_lt; lra).
  split; split; intros; nra.
Qed.
(** t in (0, 1) and x > 0 *)
Lemma by_ratio (P : R -> Prop) : (exists t, 0 < t < 1 /\ P (t / (1 - t))) <-> exists x, 0 < x /\ P x.
Proof.
  split.
  - intros (t & T & H). exists (t / (1 - t)). split; [apply Rdiv_lt_0_compat; lra | easy].
  - intros (x & X & H). exists (x / (1 + x)).
    replace (x / (1 + x) / (1 - x / (1 + x))) with x by (field; lra). split; [| easy].
    split; [apply Rdiv_lt_0_compat; lra |]. apply Rmult_lt_reg_r with (1 + x); [lra |].
    field_simplify; lra.
Qed.

Lemma never_uncertain x : sign_of_real x <> uncertain.
Proof. unfold sign_of_real. repeat destruct Rlt_dec; discriminate. Qed.
Ltac cases_of_sign x := let H := fresh "Z" in
  destruct (Rtotal_order x 0) as [H | [H | H]];
  [rewrite ?(sign_negative x H) in * | rewrite ?(sign_zero x H) in * | rewrite ?(sign_positive x H) in *].

Lemma both_signs f : sign_inside (coefficients f) = uncertain ->
  (0 < c0 f \/ 0 < c1 f \/ 0 < c2 f) /\ (c0 f < 0 \/ c1 f < 0 \/ c2 f < 0).
Proof.
  unfold sign_inside, coefficients. cbn [sign_inside_from sign_of reals].
  cases_of_sign (c0 f); cases_of_sign (c1 f); cases_of_sign (c2 f);
    cbn [sign_inside_from]; try discriminate; intros _; split; tauto.
Qed.
Lemma one_sign f : c0 f * c1 f > 0 -> c0 f * c2 f > 0 ->
  sign_throughout (coefficients f) = sign_of_real (c0 f).
Proof.
  intros A B. unfold sign_throughout, coefficients. cbn [forallb sign_of reals].
  cases_of_sign (c0 f); cases_of_sign (c1 f); cases_of_sign (c2 f); try nra; reflexivity.
Qed.

(** ** common_roots *)

Definition value_at_squares (f m : quadratic) : R := c0 f * c0 m + c1 f * c1 m + c2 f * c2 m.
Definition cross_product (f g : quadratic) : quadratic := Quadratic
  (c1 f * c2 g - c2 f * c1 g) (c2 f * c0 g - c0 f * c2 g) (c0 f * c1 g - c1 f * c0 g).
Definition opposite (m : quadratic) : quadratic := Quadratic (- c0 m) (- c1 m) (- c2 m).

Inductive kind_of_roots := none | one (squares : quadratic) | of_quadratic (f : quadratic) | everywhere.

(** The loop that collects those not identically zero; none if one of them has constant sign. *)
Fixpoint moving_forms (fs : list quadratic) : option (list quadratic) :=
  match fs with
  | [] => Some []
  | f :: fs =>
      match sign_inside (coefficients f) with
      | zero => moving_forms fs
      | uncertain => option_map (cons f) (moving_forms fs)
      | _ => None
      end
  end.
Fixpoint roots_among (first : quadratic) (others : list quadratic) : kind_of_roots :=
  match others with
  | [] => of_quadratic first
  | other :: rest =>
      let m := cross_product first other in
      match sign_throughout (coefficients m) with
      | zero => roots_among first rest
      | uncertain => none
      | s =>
          if existsb (fun g => negb (is_0 (value_at_squares g m))) rest then none
          else if negb (is_0 (c1 m * c1 m - c0 m * c2 m)) then none
          else one (match s with negative => opposite m | _ => m end)
      end
  end.
Definition common_roots (fs : list quadratic) : kind_of_roots :=
  match moving_forms fs with
  | None => none
  | Some [] => everywhere
  | Some (first :: others) => roots_among first others
  end.

Definition all_vanish (fs : list quadratic) (t : R) : Prop := Forall (fun f => quadratic_at f t = 0) fs.

Lemma proportional f g t : (c0 f <> 0 \/ c1 f <> 0 \/ c2 f <> 0) ->
  c0 (cross_product f g) = 0 -> c1 (cross_product f g) = 0 -> c2 (cross_product f g) = 0 ->
  quadratic_at f t = 0 -> quadratic_at g t = 0.
Proof.
  destruct f as [f0 f1 f2], g as [g0 g1 g2]. unfold cross_product, quadratic_at, value. cbn [c0 c1 c2].
  intros N Z0 Z1 Z2 F.
  assert (E : forall a b, a <> 0 -> a * b = 0 -> b = 0) by (intros a b A H; apply Rmult_integral in H; tauto).
  destruct N as [N | [N | N]]; [apply (E f0) | apply (E f1) | apply (E f2)]; auto.
  - transitivity (g0 * (f0 * (1 - t) ^ 2 + f1 * (1 - t) * t + f2 * t ^ 2)
      + (f0 * g1 - f1 * g0) * (1 - t) * t - (f2 * g0 - f0 * g2) * t ^ 2); [ring |].
    rewrite F, Z1, Z2. ring.
  - transitivity (g1 * (f0 * (1 - t) ^ 2 + f1 * (1 - t) * t + f2 * t ^ 2)
      - (f0 * g1 - f1 * g0) * (1 - t) ^ 2 + (f1 * g2 - f2 * g1) * t ^ 2); [ring |].
    rewrite F, Z0, Z2. ring.
  - transitivity (g2 * (f0 * (1 - t) ^ 2 + f1 * (1 - t) * t + f2 * t ^ 2)
      + (f2 * g0 - f0 * g2) * (1 - t) ^ 2 - (f1 * g2 - f2 * g1) * (1 - t) * t); [ring |].
    rewrite F, Z0, Z1. ring.
Qed.

(** m is a multiple of (s^2, st, t^2). *)
Definition squares_at (m : quadratic) (k t : R) : Prop :=
  c0 m = k * (1 - t) ^ 2 /\ c1 m = k * ((1 - t) * t) /\ c2 m = k * t ^ 2.
Lemma value_squares f m k t : squares_at m k t -> value_at_squares f m = k * quadratic_at f t.
Proof.
  intros (A & B & C). unfold value_at_squares, quadratic_at, value. rewrite A, B, C. ring.
Qed.
Lemma root_of_both f g t : 0 < t < 1 ->
  (let m := cross_product f g in c0 m <> 0 \/ c1 m <> 0 \/ c2 m <> 0) ->
  quadratic_at f t = 0 -> quadratic_at g t = 0 -> exists k, k <> 0 /\ squares_at (cross_product f g) k t.
Proof.
  intros T N F G. cbv zeta in N. set (m := cross_product f g) in *.
  assert (S1 : (1 - t) * c1 m = t * c0 m).
  { apply Rmult_eq_reg_l with (1 - t); [| lra]. apply Rminus_diag_uniq.
    transitivity (c2 f * quadratic_at g t - c2 g * quadratic_at f t); [| rewrite F, G; ring].
    unfold m, cross_product, quadratic_at, value. cbn [c0 c1 c2]. ring. }
  assert (S2 : (1 - t) * c2 m = t * c1 m).
  { apply Rmult_eq_reg_l with t; [| lra]. apply Rminus_diag_uniq.
    transitivity (c0 f * quadratic_at g t - c0 g * quadratic_at f t); [| rewrite F, G; ring].
    unfold m, cross_product, quadratic_at, value. cbn [c0 c1 c2]. ring. }
  assert (E0 : c0 m = c1 m / t * (1 - t)) by (apply Rmult_eq_reg_l with t; [field_simplify |]; lra).
  assert (E2 : c2 m = c1 m / (1 - t) * t) by (apply Rmult_eq_reg_l with (1 - t); [field_simplify |]; lra).
  exists (c1 m / ((1 - t) * t)). split.
  - intros Z. assert (Z1 : c1 m = 0).
    { replace (c1 m) with (c1 m / ((1 - t) * t) * ((1 - t) * t)) by (field; lra). rewrite Z. ring. }
    rewrite Z1 in E0, E2. unfold Rdiv in E0, E2. lra.
  - split; [| split]; [rewrite E0 | | rewrite E2]; field; lra.
Qed.
Lemma squares_unique m k k' t r : k <> 0 -> 0 < t < 1 -> 0 < r < 1 ->
  squares_at m k t -> squares_at m k' r -> r = t.
Proof.
  intros K T U (A & B & _) (C & D & _). assert (k' <> 0) by (intros ->; assert (k * (1 - t) ^ 2 <> 0) by
    (apply Rmult_integral_contrapositive; split; [easy | apply pow_nonzero; lra]); lra).
  assert (E : k * k' * ((1 - t) * (1 - r)) * (r - t) = 0).
  { transitivity (k * (1 - t) ^ 2 * (k' * ((1 - r) * r)) - k * ((1 - t) * t) * (k' * (1 - r) ^ 2)); [ring |].
    rewrite <- A, <- B, <- C, <- D. ring. }
  apply Rmult_integral in E. destruct E as [E | E]; [| lra]. exfalso.
  apply Rmult_integral in E. destruct E as [E | E]; apply Rmult_integral in E; destruct E; lra.
Qed.

(** The meaning of the kinds for the roots in (0, 1). *)
Definition kind_is_right (kind : kind_of_roots) (vanish : R -> Prop) : Prop :=
  match kind with
  | none => forall r, 0 < r < 1 -> ~ vanish r
  | one m => exists k t, 0 < k /\ 0 < t < 1 /\ squares_at m k t /\
      forall r, 0 < r < 1 -> (vanish r <-> r = t)
  | of_quadratic f => sign_inside (coefficients f) = uncertain /\
      forall r, 0 < r < 1 -> (vanish r <-> quadratic_at f r = 0)
  | everywhere => forall r, vanish r
  end.
Lemma kind_of_same kind (p q : R -> Prop) :
  (forall r, p r <-> q r) -> kind_is_right kind p -> kind_is_right kind q.
Proof.
  intros E. destruct kind; simpl.
  - intros H r T Q. apply (H r T), E, Q.
  - intros (k & t & K & T & S & H). exists k, t. split; [auto | split; [auto | split; [auto |]]].
    intros r U. rewrite <- E. now apply H.
  - intros (S & H). split; auto. intros r T. rewrite <- E. now apply H.
  - intros H r. now apply E.
Qed.

Lemma roots_among_right first others : sign_inside (coefficients first) = uncertain ->
  kind_is_right (roots_among first others)
    (fun r => quadratic_at first r = 0 /\ all_vanish others r).
Proof.
  intros U. assert (N : c0 first <> 0 \/ c1 first <> 0 \/ c2 first <> 0)
    by (destruct (both_signs first U); lra).
  induction others as [| other rest IH]; cbn [roots_among]; cbv zeta.
  { simpl. split; auto. intros r T. split; [tauto |]. split; auto. constructor. }
  set (m := cross_product first other).
  assert (Zero : sign_throughout (coefficients m) = zero ->
    kind_is_right (roots_among first rest)
      (fun r => quadratic_at first r = 0 /\ all_vanish (other :: rest) r)).
  { intros S. revert IH. apply kind_of_same. intros r. split; intros (A & B); split; auto.
    - constructor; auto. pose proof (sign_throughout_coefficients (coefficients m)) as H. rewrite S in H.
      simpl in H. inversion_clear H as [| ? ? Z0 H']. inversion_clear H' as [| ? ? Z1 H].
      inversion_clear H as [| ? ? Z2 _]. apply (proportional first); auto; fold m; congruence.
    - now inversion_clear B. }
  assert (Root : forall r, sign_throughout (coefficients m) <> zero -> 0 < r < 1 ->
    quadratic_at first r = 0 /\ all_vanish (other :: rest) r -> exists k, k <> 0 /\ squares_at m k r).
  { intros r S T (A & B). inversion_clear B. apply root_of_both; auto. fold m. cbv zeta.
    destruct (Req_dec (c0 m) 0) as [Z0 | Z0]; [| tauto]. destruct (Req_dec (c1 m) 0) as [Z1 | Z1]; [| tauto].
    destruct (Req_dec (c2 m) 0) as [Z2 | Z2]; [| tauto]. exfalso. apply S. unfold sign_throughout, coefficients.
    cbn [forallb sign_of reals]. rewrite !sign_zero by easy. reflexivity. }
  assert (Signs : forall k r, k <> 0 -> 0 < r < 1 -> squares_at m k r ->
    sign_throughout (coefficients m) = sign_of_real (c0 m) /\ 0 < k * c0 m /\ c1 m * c1 m = c0 m * c2 m).
  { intros k r K T (A & B & C). assert (0 < k * k) by nra. assert (0 < (1 - r) ^ 2) by (apply pow_lt; lra).
    assert (0 < (1 - r) * r) by nra. assert (0 < r ^ 2) by (apply pow_lt; lra).
    split; [| split].
    - apply one_sign; [rewrite A, B | rewrite A, C].
      + replace (_ * _) with (k * k * ((1 - r) ^ 2 * ((1 - r) * r))) by ring.
        apply Rmult_lt_0_compat; [easy | now apply Rmult_lt_0_compat].
      + replace (_ * _) with (k * k * ((1 - r) ^ 2 * r ^ 2)) by ring.
        apply Rmult_lt_0_compat; [easy | now apply Rmult_lt_0_compat].
    - rewrite A, <- Rmult_assoc. now apply Rmult_lt_0_compat.
    - rewrite A, B, C. ring. }
  assert (Decided : sign_throughout (coefficients m) <> zero -> forall s,
    sign_throughout (coefficients m) = s -> s = positive \/ s = negative ->
    kind_is_right (if existsb (fun g => negb (is_0 (value_at_squares g m))) rest then none
                   else if negb (is_0 (c1 m * c1 m - c0 m * c2 m)) then none
                   else one (match s with negative => opposite m | _ => m end))
      (fun r => quadratic_at first r = 0 /\ all_vanish (other :: rest) r)).
  { intros NZ s S Cs.
    destruct (existsb _ rest) eqn:X; [| destruct (is_0 (c1 m * c1 m - c0 m * c2 m)) eqn:Q]; simpl.
    - intros r T H. destruct (Root r NZ T H) as (k & K & Sq). apply existsb_exists in X.
      destruct X as (g & I & G). destruct H as (_ & H). inversion_clear H as [| ? ? _ H'].
      rewrite (value_squares g m k r Sq), (proj1 (Forall_forall _ _) H' g I), Rmult_0_r in G.
      rewrite (proj2 (is_0_true 0) eq_refl) in G. discriminate.
    - apply is_0_true in Q. pose proof (sign_throughout_coefficients (coefficients m)) as H. rewrite S in H.
      assert (P : 0 < c0 m * c1 m /\ 0 < c0 m * c0 m).
      { destruct Cs as [-> | ->]; simpl in H; destruct H as (H & _); inversion_clear H as [| ? ? Z0 H'];
          inversion_clear H' as [| ? ? Z1 H]; simpl in *; split; nra. }
      destruct P as (P & P').
      set (t := c1 m / (c0 m + c1 m)). set (k := (c0 m + c1 m) * (c0 m + c1 m) / c0 m).
      assert (N0 : c0 m <> 0) by (intros Z; rewrite Z in P'; lra).
      assert (N1 : c0 m + c1 m <> 0) by (intros Z; replace (c1 m) with (- c0 m) in P by lra; nra).
      assert (T : 0 < t < 1).
      { assert (F : forall a b, 0 < a * b -> 0 < a * a -> 0 < b / (a + b)).
        { intros a b A B. assert (a + b <> 0) by (intros Z; replace b with (- a) in A by lra; lra).
          replace (b / (a + b)) with ((a * b + b * b) / ((a + b) * (a + b))) by (field; auto).
          apply Rdiv_lt_0_compat; nra. }
        split; [apply F; auto |]. enough (0 < 1 - t) by lra. unfold t.
        replace (1 - c1 m / (c0 m + c1 m)) with (c0 m / (c1 m + c0 m)) by (field; lra). apply F; [lra |].
        nra. }
      assert (Sq : squares_at m k t).
      { unfold squares_at, k, t. split; [field; auto | split; [field; auto |]].
        replace (_ * _) with (c1 m * c1 m / c0 m) by (field; auto).
        replace (c1 m * c1 m) with (c0 m * c2 m) by lra. field. auto. }
      assert (K : k <> 0).
      { intros Z. destruct Sq as (A & _). rewrite Z in A. lra. }
      assert (Only : forall r, 0 < r < 1 ->
        (quadratic_at first r = 0 /\ all_vanish (other :: rest) r <-> r = t)).
      { intros r T'. split.
        - intros V. destruct (Root r NZ T' V) as (k' & K' & Sq'). now apply (squares_unique m k k').
        - intros ->. assert (V : forall g, value_at_squares g m = 0 -> quadratic_at g t = 0).
          { intros g G. rewrite (value_squares g m k t Sq) in G. apply Rmult_integral in G. tauto. }
          split; [apply V; unfold m, value_at_squares, cross_product; cbn [c0 c1 c2]; ring |].
          constructor; [apply V; unfold m, value_at_squares, cross_product; cbn [c0 c1 c2]; ring |].
          apply Forall_forall. intros g I. apply V. destruct (is_0 (value_at_squares g m)) eqn:G.
          + now apply is_0_true.
          + exfalso. assert (E : existsb (fun g => negb (is_0 (value_at_squares g m))) rest = true)
              by (apply existsb_exists; exists g; rewrite G; auto). congruence. }
      assert (Pos : forall a b, 0 < a * b -> 0 < b -> 0 < a) by (intros; nra).
      assert (Kp : 0 < k * c0 m).
      { unfold k. replace (_ * _) with ((c0 m + c1 m) * (c0 m + c1 m)) by (field; auto). nra. }
      pose proof H as H'. destruct Cs as [-> | ->]; simpl in H; destruct H as (H & _);
        inversion_clear H as [| ? ? Z0 _].
      + exists k, t. split; [exact (Pos k (c0 m) Kp Z0) |]. auto.
      + exists (- k), t. split; [apply (Pos (- k) (- c0 m)); [rewrite Rmult_opp_opp |]; auto |].
        split; auto. split; auto.
        destruct Sq as (A & B & C). unfold squares_at, opposite. cbn [c0 c1 c2].
        rewrite A, B, C. repeat split; ring.
    - intros r T H. destruct (Root r NZ T H) as (k & K & Sq). destruct (Signs k r K T Sq) as (_ & _ & E).
      rewrite (proj2 (is_0_true (c1 m * c1 m - c0 m * c2 m))) in Q; [discriminate | lra]. }
  destruct (sign_throughout (coefficients m)) eqn:S; [| now apply Zero | |].
  - apply (Decided ltac:(discriminate) negative); auto.
  - apply (Decided ltac:(discriminate) positive); auto.
  - intros r T H. destruct (Root r ltac:(discriminate) T H) as (k & K & Sq).
    destruct (Signs k r K T Sq) as (E & _). symmetry in E. now apply never_uncertain in E.
Qed.

Theorem common_roots_right fs : kind_is_right (common_roots fs) (all_vanish fs).
Proof.
  assert (H : forall fs, match moving_forms fs with
    | None => forall r, 0 < r < 1 -> ~ all_vanish fs r
    | Some l => Forall (fun f => sign_inside (coefficients f) = uncertain) l /\
        forall r, all_vanish fs r <-> all_vanish l r
    end).
  { clear. induction fs as [| f fs IH]; simpl; [split; [constructor | easy] |].
    assert (Never : sign_inside (coefficients f) = positive \/ sign_inside (coefficients f) = negative ->
      forall r, 0 < r < 1 -> ~ all_vanish (f :: fs) r).
    { intros S r T V. inversion_clear V as [| ? ? Z _]. pose proof (sign_inside_right (coefficients f) r T) as Y.
      rewrite at_time_quadratic, Z in Y. destruct S as [S | S]; rewrite S in Y; simpl in Y; lra. }
    destruct (sign_inside (coefficients f)) eqn:S; auto.
    - destruct (moving_forms fs) as [l |].
      + destruct IH as (F & E). split; auto. intros r. rewrite <- E. split; intros V.
        * now inversion_clear V.
        * constructor; auto. pose proof (sign_inside_coefficients (coefficients f)) as Y. rewrite S in Y.
          simpl in Y. inversion_clear Y as [| ? ? Z0 Y']. inversion_clear Y' as [| ? ? Z1 Y].
          inversion_clear Y as [| ? ? Z2 _]. unfold quadratic_at, value. rewrite <- Z0, <- Z1, <- Z2. ring.
      + intros r T V. inversion_clear V. now apply (IH r T).
    - destruct (moving_forms fs) as [l |]; simpl.
      + destruct IH as (F & E). split; [now constructor |]. intros r.
        split; intros V; inversion_clear V; constructor; auto; now apply E.
      + intros r T V. inversion_clear V. now apply (IH r T). }
  specialize (H fs). unfold common_roots. destruct (moving_forms fs) as [[| first others] |]; auto.
  - simpl. intros r. apply H. constructor.
  - destruct H as (F & E). inversion_clear F as [| ? ? U _].
    apply kind_of_same with (2 := roots_among_right first others U). intros r. rewrite E. split.
    + intros (A & B). now constructor.
    + intros V. now inversion_clear V.
Qed.

(** ** Values and roots of quadratics *)

Definition code_value (f : quadratic) (s t : R) : R := value_at (S := reals) (coefficients f) s t.
(** The quadratic's derivative and the remainder l are linear forms. *)
Definition linear_value (h0 h1 s t : R) : R := value_at (S := reals) [h0; h1] s t.
Lemma factors f0 f1 f2 : f2 <> 0 -> 0 < f1 * f1 - 4 * (f0 * f2) ->
  exists p q, p < q /\ f0 = f2 * (p * q) /\ f1 = - (f2 * (p + q)).
Proof.
  intros N D. set (d := sqrt (f1 * f1 - 4 * (f0 * f2))).
  assert (P : 0 < d) by now apply sqrt_lt_R0.
  assert (Q : d * d = f1 * f1 - 4 * (f0 * f2)) by (apply sqrt_sqrt; lra).
  set (u := (- f1 - d) / (2 * f2)). set (v := (- f1 + d) / (2 * f2)).
  assert (E0 : f0 = f2 * (u * v)).
  { unfold u, v. replace (f2 * _) with ((f1 * f1 - d * d) / (4 * f2)) by (field; auto). rewrite Q. field.
    auto. }
  assert (E1 : f1 = - (f2 * (u + v))) by (unfold u, v; field; auto).
  assert (L : f2 * (v - u) = d) by (unfold u, v; field; auto).
  destruct (Rtotal_order f2 0) as [H | [H | H]]; [| easy |].
  - exists v, u. split; [nra |]. rewrite E0 at 1. rewrite E1 at 1. split; ring.
  - exists u, v. split; [nra |]. split; easy.
Qed.

(** The last part, for f = f2 (x - p)(x - q). *)
Lemma both_roots f2 p q b0 b1 b2 : let f := Quadratic (f2 * (p * q)) (- (f2 * (p + q))) f2 in
  let b := Quadratic b0 b1 b2 in
  let L0 := b0 - b2 * (p * q) in let L1 := b1 + b2 * (p + q) in
  c2 f * c0 b - c2 b * c0 f = f2 * L0 /\ c2 f * c1 b - c2 b * c1 f = f2 * L1 /\
  (forall x, at_ratio f x = f2 * ((x - p) * (x - q))) /\
  (forall x, at_ratio f x = 0 -> f2 <> 0 -> at_ratio b x = L0 + L1 * x).
Proof.
  intros f b L0 L1. unfold f, b, L0, L1, at_ratio. cbn [c0 c1 c2].
  split; [ring | split; [ring | split; [intros x; ring |]]].
  intros x Z N. assert (E : (x - p) * (x - q) = 0).
  { apply Rmult_eq_reg_l with f2; auto. rewrite Rmult_0_r, <- Z. ring. }
  transitivity (b0 - b2 * (p * q) + (b1 + b2 * (p + q)) * x + b2 * ((x - p) * (x - q))); [ring |].
  rewrite E. ring.
Qed.

Lemma inside_ratio f t : 0 < t < 1 ->
  (quadratic_at f t = 0 <-> at_ratio f (t / (1 - t)) = 0) /\
  (quadratic_at f t <= 0 <-> at_ratio f (t / (1 - t)) <= 0).
Proof. intros T. unfold quadratic_at. apply ratio_sign. lra. Qed.

(** ** first_root_nonpositive (ccd/contact/vertex_edge_time.hpp) *)

Inductive which_root := only_root_of | first_root_of | second_root_of.
Definition linear_at (p0 p1 t : R) : R := p0 * (1 - t) + p1 * t.
(** The first time: the root of a linear form, or a root of a quadratic one. *)
Inductive place_in_time :=
  | nowhere | start_time | end_time | linear_root (k0 k1 : R) | quadratic_root (f : quadratic) (which : which_root).

Definition opposite_sign (s : sign) : sign :=
  match s with positive => negative | negative => positive | _ => s end.
Definition first_root_nonpositive (f b : quadratic) : place_in_time :=
  let at_rational k0 k1 :=
    if nonpositive (code_value b (Rabs k1) (Rabs k0)) then linear_root k0 k1 else nowhere in
  let first := sign_of_real (c0 f) in
  let last := sign_of_real (c2 f) in
  if same_sign first zero then at_rational (c1 f) (c2 f)
  else if same_sign last zero then at_rational (c0 f) (c1 f)
  else
    let two_roots := same_sign first last in
    let discriminant := sign_of_real (c1 f * c1 f - 4 * (c0 f * c2 f)) in
    if two_roots && same_sign discriminant negative then nowhere
    else if two_roots && same_sign discriminant zero then at_rational (c1 f) (2 * c2 f)
    else
      let l0 := c2 f * c0 b - c2 b * c0 f in
      let l1 := c2 f * c1 b - c2 b * c1 f in
      let nonpositive_at of_l := certainly_nonpositive (times last of_l) in
      let first_root := quadratic_root f (if two_roots then first_root_of else only_root_of) in
      let everywhere := sign_inside (S := reals) [l0; l1] in
      if certain everywhere then (if nonpositive_at everywhere then first_root else nowhere)
      else
        let s := Rabs l1 in
        let t := Rabs l0 in
        let there := sign_of_real (code_value f s t) in
        if negb two_roots then
          if same_sign there zero then first_root
          else if nonpositive_at (sign_of_real (if same_sign there first then l1 else l0)) then first_root
          else nowhere
        else if same_sign there (opposite_sign first) then
          (if nonpositive_at (sign_of_real l0) then quadratic_root f first_root_of
           else quadratic_root f second_root_of)
        else
          let before_both := same_sign (sign_of_real (linear_value (c1 f - 2 * c0 f) (2 * c2 f - c1 f) s t))
            (opposite_sign first) in
          if same_sign there zero then
            if before_both then quadratic_root f first_root_of
            else if nonpositive_at (sign_of_real l0) then quadratic_root f first_root_of
            else quadratic_root f second_root_of
          else if nonpositive_at (sign_of_real (if before_both then l1 else l0)) then quadratic_root f first_root_of
          else nowhere.

(** In x = t/s: f = f2 (x - p)(x - q), its greater root positive. *)
Definition ratio_right (f b : quadratic) (p q : R) (place : place_in_time) : Prop :=
  match place with
  | nowhere => (0 < p -> 0 < at_ratio b p) /\ 0 < at_ratio b q
  | quadratic_root g only_root_of => g = f /\ p < 0 /\ at_ratio b q <= 0
  | quadratic_root g first_root_of => g = f /\ 0 < p /\ at_ratio b p <= 0
  | quadratic_root g second_root_of => g = f /\ 0 < p /\ 0 < at_ratio b p /\ at_ratio b q <= 0
  | _ => False
  end.

(** lra without the implications in the context, each of which multiplies its cases. *)
Ltac plain_lra := repeat match goal with H : _ -> _ |- _ => clear H end; lra.
Lemma first_of_two f2 p q b : f2 <> 0 -> p < q -> p <> 0 -> 0 < q ->
  let f := Quadratic (f2 * (p * q)) (- (f2 * (p + q))) f2 in
  ratio_right f b p q (first_root_nonpositive f b).
Proof.
  intros N O P Q f. destruct b as [b0 b1 b2].
  destruct (both_roots f2 p q b0 b1 b2) as (El0 & El1 & Ef & Eb). fold f in El0, El1, Ef, Eb.
  set (b := Quadratic b0 b1 b2) in *. set (L0 := b0 - b2 * (p * q)) in *. set (L1 := b1 + b2 * (p + q)) in *.
  assert (Bp : at_ratio b p = L0 + L1 * p) by (apply Eb; auto; rewrite Ef; ring).
  assert (Bq : at_ratio b q = L0 + L1 * q) by (apply Eb; auto; rewrite Ef; ring).
  assert (D : sign_of_real (c1 f * c1 f - 4 * (c0 f * c2 f)) = positive).
  { apply sign_positive. unfold f. cbn [c0 c1 c2].
    replace (_ - _) with ((f2 * (q - p)) * (f2 * (q - p))) by ring.
    assert (f2 * (q - p) <> 0) by (apply Rmult_integral_contrapositive; lra). nra. }
  assert (There : forall c a, sign_of_real (code_value f (Rabs f2 * c) (Rabs f2 * a))
    = times (sign_of_real f2) (times (sign_of_real (a - p * c)) (sign_of_real (a - q * c)))).
  { intros c a. unfold code_value. rewrite value_of_code. rewrite <- !sign_product.
    transitivity (sign_of_real (Rabs f2 * Rabs f2 * (f2 * ((a - p * c) * (a - q * c))))).
    - f_equal. unfold value, f. cbn [c0 c1 c2]. ring.
    - rewrite sign_product, (sign_positive (Rabs f2 * Rabs f2)).
      + now destruct (sign_of_real (f2 * _)).
      + assert (0 < Rabs f2) by now apply Rabs_pos_lt. nra. }
  assert (Slope : forall c a,
    sign_of_real (linear_value (c1 f - 2 * c0 f) (2 * c2 f - c1 f) (Rabs f2 * c) (Rabs f2 * a))
    = times (sign_of_real f2) (sign_of_real ((1 + p) * (a - q * c) + (1 + q) * (a - p * c)))).
  { intros c a. rewrite <- !sign_product.
    transitivity (sign_of_real (Rabs f2 * (f2 * ((1 + p) * (a - q * c) + (1 + q) * (a - p * c))))).
    - f_equal. unfold linear_value, f. cbn. ring.
    - rewrite sign_product, (sign_positive (Rabs f2)) by now apply Rabs_pos_lt.
      now destruct (sign_of_real (f2 * _)). }
  unfold first_root_nonpositive. cbv zeta. rewrite D, El0, El1, !Rabs_mult, There, Slope.
  assert (First : sign_of_real (c0 f) = times (sign_of_real f2) (sign_of_real p)).
  { unfold f. cbn [c0]. rewrite !sign_product, (sign_positive q Q).
    now destruct (sign_of_real f2), (sign_of_real p). }
  rewrite First. change (c2 f) with f2.
  unfold sign_inside. cbn [sign_inside_from sign_of reals]. rewrite !sign_product.
  assert (Later : forall g : bool, sign_of_real (if g then f2 * L1 else f2 * L0)
     = times (sign_of_real f2) (if g then sign_of_real L1 else sign_of_real L0))
    by (intros []; apply sign_product).
  rewrite !Later. clear Later.
  assert (Up : Rabs L0 - q * Rabs L1 <= Rabs L0 - p * Rabs L1) by (pose proof (Rabs_pos L1); nra).
  set (u := Rabs L0 - p * Rabs L1) in *. set (v := Rabs L0 - q * Rabs L1) in *.
  assert (E : u = Rabs L0 - p * Rabs L1 /\ v = Rabs L0 - q * Rabs L1) by (split; reflexivity).
  assert (Earlier : 0 < p -> 0 <= u -> 0 <= v -> 0 < u -> 0 < (1 + p) * v + (1 + q) * u).
  { clear - Q. intros. assert (0 <= p * v) by (apply Rmult_le_pos; lra).
    assert (0 < q * u) by (now apply Rmult_lt_0_compat). lra. }
  assert (After : 0 < p -> u <= 0 -> v <= 0 -> v < 0 -> (1 + p) * v + (1 + q) * u < 0).
  { clear - Q. intros. assert (0 <= p * - v) by (apply Rmult_le_pos; lra).
    assert (0 <= q * - u) by (apply Rmult_le_pos; lra). lra. }
  assert (Apart : 0 < Rabs L1 -> v < u).
  { destruct E as (-> & ->). clear - O. intros. assert (0 < (q - p) * Rabs L1) by (apply Rmult_lt_0_compat; lra). lra. }
  assert (Single : p < 0 -> 0 < Rabs L0 -> 0 < u).
  { destruct E as (-> & _). clear. intros.
    assert (0 <= - p * Rabs L1) by (apply Rmult_le_pos; [lra | apply Rabs_pos]). lra. }
  assert (Falling : L0 < 0 -> 0 < L1 -> u = - (L0 + L1 * p) /\ v = - (L0 + L1 * q) /\ 0 < Rabs L0 /\ 0 < Rabs L1).
  { destruct E as (-> & ->). clear. intros. rewrite (Rabs_left L0), (Rabs_pos_eq L1) by lra. lra. }
  assert (Rising : 0 < L0 -> L1 < 0 -> u = L0 + L1 * p /\ v = L0 + L1 * q /\ 0 < Rabs L0 /\ 0 < Rabs L1).
  { destruct E as (-> & ->). clear. intros. rewrite (Rabs_left L1), (Rabs_pos_eq L0) by lra. lra. }
  assert (Same : 0 <= L0 -> 0 <= L1 -> 0 < L0 + L1 -> (0 < p -> 0 < L0 + L1 * p) /\ 0 < L0 + L1 * q).
  { assert (H : forall r, 0 < r -> 0 <= L0 -> 0 <= L1 -> 0 < L0 + L1 -> 0 < L0 + L1 * r).
    { clear. intros. assert (0 <= L1 * r) by (apply Rmult_le_pos; lra).
      destruct (Req_dec L0 0); [| lra]. assert (0 < L1 * r) by (apply Rmult_lt_0_compat; lra). lra. }
    auto. }
  assert (Below : forall r, 0 < r -> L0 <= 0 -> L1 <= 0 -> L0 + L1 * r <= 0).
  { clear. intros. assert (0 <= - L1 * r) by (apply Rmult_le_pos; lra). lra. }
  unfold ratio_right. fold f. rewrite Bp, Bq.
  assert (Itself : f = f) by reflexivity. revert Itself.
  clear There Slope First D Ef El0 El1 E Eb Bp Bq. clearbody L0 L1 u v f. intros Itself.
  cases_of_sign f2; [| easy |]; (cases_of_sign p; [| easy |]); cases_of_sign L0; cases_of_sign L1.
  all: cbn [times same_sign sign_inside_from certain certainly_nonpositive andb orb negb opposite_sign].
  all: try (apply Same; plain_lra).
  all: try (split; [reflexivity |]; split; [plain_lra |]; apply Below; plain_lra).
  all: first [destruct (Falling ltac:(assumption) ltac:(assumption)) as (U & V & A & A1)
             | destruct (Rising ltac:(assumption) ltac:(assumption)) as (U & V & A & A1)].
  all: specialize (Apart A1); clear Falling Rising Same Below; set (gp := L0 + L1 * p) in *;
    set (gq := L0 + L1 * q) in *; clearbody gp gq.
  all: cases_of_sign u; cases_of_sign v; try plain_lra;
    try (exfalso; assert (0 < u) by (apply Single; assumption); plain_lra).
  all: try rewrite (sign_positive _ (Earlier ltac:(assumption) ltac:(plain_lra) ltac:(plain_lra) ltac:(plain_lra)));
    try rewrite (sign_negative _ (After ltac:(assumption) ltac:(plain_lra) ltac:(plain_lra) ltac:(plain_lra))).
  all: cbn [times same_sign certain certainly_nonpositive andb orb negb opposite_sign].
  all: repeat split; try reflexivity; plain_lra.
Qed.

(** The time of a `place_in_time`, and the facts that the search for its bracket needs. *)
Definition tells (place : place_in_time) (r : R) : Prop :=
  match place with
  | nowhere => False
  | start_time => r = 0
  | end_time => r = 1
  | linear_root k0 k1 => k0 * k1 <= 0 /\ (k0 <> 0 \/ k1 <> 0) /\ linear_at k0 k1 r = 0
  | quadratic_root f only_root_of => 0 < r < 1 /\ quadratic_at f r = 0 /\
      (forall t, 0 < t < r -> 0 < quadratic_at f t * c0 f) /\ (forall t, r < t < 1 -> quadratic_at f t * c0 f < 0)
  | quadratic_root f first_root_of => exists k q, k <> 0 /\ (0 < r < q /\ q < 1) /\
      forall t, quadratic_at f t = k * ((t - r) * (t - q))
  | quadratic_root f second_root_of => exists k p, k <> 0 /\ (0 < p < r /\ r < 1) /\
      forall t, quadratic_at f t = k * ((t - p) * (t - r))
  end.
Definition first_nonpositive (f b : quadratic) (r : R) : Prop :=
  0 < r < 1 /\ quadratic_at f r = 0 /\ quadratic_at b r <= 0 /\
  forall t, 0 < t < r -> quadratic_at f t = 0 -> 0 < quadratic_at b t.
Definition root_told (f b : quadratic) (place : place_in_time) : Prop :=
  (place = nowhere /\ forall t, 0 < t < 1 -> quadratic_at f t = 0 -> 0 < quadratic_at b t) \/
  exists r, tells place r /\ first_nonpositive f b r.

Lemma rational_told f b k0 k1 : k0 * k1 < 0 ->
  (forall t, 0 < t < 1 -> (quadratic_at f t = 0 <-> linear_at k0 k1 t = 0)) ->
  root_told f b (if nonpositive (code_value b (Rabs k1) (Rabs k0)) then linear_root k0 k1 else nowhere).
Proof.
  intros O Same. assert (N0 : k0 <> 0) by nra. assert (N1 : k1 <> 0) by nra.
  pose proof (Rabs_pos_lt _ N0) as P0. pose proof (Rabs_pos_lt _ N1) as P1.
  set (r := Rabs k0 / (Rabs k0 + Rabs k1)).
  assert (E : r * (Rabs k0 + Rabs k1) = Rabs k0) by (unfold r; field; lra).
  assert (R0 : 0 < r < 1) by (split; nra).
  assert (Linear : forall t, linear_at k0 k1 t = 0 <-> t = r).
  { assert (Q : k0 * Rabs k1 = - k1 * Rabs k0).
    { destruct (Rlt_or_le k0 0); [rewrite (Rabs_left k0), (Rabs_pos_eq k1) by nra |
        rewrite (Rabs_pos_eq k0), (Rabs_left k1) by nra]; ring. }
    assert (E' : r * (k0 - k1) = k0).
    { apply Rmult_eq_reg_r with (Rabs k0 + Rabs k1); [| lra].
      transitivity (r * (Rabs k0 + Rabs k1) * (k0 - k1)); [ring |]. rewrite E. lra. }
    assert (D : k0 - k1 <> 0) by nra.
    intros t. replace (linear_at k0 k1 t) with ((k0 - k1) * (r - t)) by (unfold linear_at; lra).
    split; [| intros ->; ring]. intros Z. apply Rmult_integral in Z. destruct Z; lra. }
  assert (V : code_value b (Rabs k1) (Rabs k0) = (Rabs k0 + Rabs k1) * (Rabs k0 + Rabs k1) * quadratic_at b r).
  { unfold code_value. rewrite value_of_code. unfold quadratic_at, value.
    set (m := Rabs k0 + Rabs k1) in *.
    transitivity (c0 b * (m - r * m) ^ 2 + c1 b * (m - r * m) * (r * m) + c2 b * (r * m) ^ 2); [| ring].
    rewrite E. unfold m. ring. }
  assert (M : 0 < (Rabs k0 + Rabs k1) * (Rabs k0 + Rabs k1)) by nra.
  destruct (nonpositive (code_value b (Rabs k1) (Rabs k0))) eqn:B.
  - right. exists r. apply nonpositive_true in B. rewrite V in B. split.
    + split; [lra |]. split; auto. now apply Linear.
    + split; auto. split; [now apply Same, Linear |]. split; [nra |].
      intros t T Z. apply Same, Linear in Z; lra.
  - left. split; auto. intros t T Z. apply Same, Linear in Z; auto. subst t.
    apply Rnot_le_lt. intros Q. enough (nonpositive (code_value b (Rabs k1) (Rabs k0)) = true) by congruence.
    apply nonpositive_true. rewrite V. nra.
Qed.

Lemma place_of_ratio x : 0 < x -> 0 < x / (1 + x) < 1 /\ x / (1 + x) / (1 - x / (1 + x)) = x.
Proof.
  intros X. assert (E : x / (1 + x) * (1 + x) = x) by (field; lra).
  split; [split; nra | field; lra].
Qed.
Lemma sign_of_ratio b x : 0 < x -> (quadratic_at b (x / (1 + x)) <= 0 <-> at_ratio b x <= 0).
Proof.
  intros X. destruct (place_of_ratio x X) as (T & E). rewrite (proj2 (inside_ratio b _ T)). now rewrite E.
Qed.

Lemma two_told f2 p q b : f2 <> 0 -> p < q -> p <> 0 -> 0 < q ->
  let f := Quadratic (f2 * (p * q)) (- (f2 * (p + q))) f2 in
  root_told f b (first_root_nonpositive f b).
Proof.
  intros N O P Q f. pose proof (first_of_two f2 p q b N O P Q) as H. cbv zeta in H. fold f in H.
  destruct (place_of_ratio q Q) as (Tq & _). pose proof (sign_of_ratio b q Q) as Sq.
  set (y := q / (1 + q)) in *. assert (Ey : y * (1 + q) = q) by (unfold y; field; lra).
  assert (Fy : forall t, t - q * (1 - t) = (1 + q) * (t - y)) by (intros t; lra).
  assert (F : forall t, quadratic_at f t = f2 * ((t - p * (1 - t)) * (t - q * (1 - t))))
    by (intros t; unfold quadratic_at, value, f; cbn [c0 c1 c2]; ring).
  assert (Nq : ~ at_ratio b q <= 0 <-> 0 < quadratic_at b y) by (rewrite <- Sq; split; lra).
  destruct (Rlt_or_le 0 p) as [Pp | Pn].
  - destruct (place_of_ratio p Pp) as (Tp & _). pose proof (sign_of_ratio b p Pp) as Sp.
    set (x := p / (1 + p)) in *. assert (Ex : x * (1 + p) = p) by (unfold x; field; lra).
    assert (XY : x < y) by nra. set (k := f2 * ((1 + p) * (1 + q))).
    assert (K : k <> 0) by (unfold k; repeat (apply Rmult_integral_contrapositive; split); lra).
    assert (G : forall t, quadratic_at f t = k * ((t - x) * (t - y))).
    { intros t. rewrite F, Fy. unfold k. replace (t - p * (1 - t)) with ((1 + p) * (t - x)) by lra. ring. }
    assert (Zeros : forall t, quadratic_at f t = 0 -> t = x \/ t = y).
    { intros t. rewrite G. intros Z. apply Rmult_integral in Z. destruct Z as [|Z]; [easy |].
      apply Rmult_integral in Z. lra. }
    assert (Zx : quadratic_at f x = 0) by (rewrite G; ring). assert (Zy : quadratic_at f y = 0) by (rewrite G; ring).
    destruct (first_root_nonpositive f b) as [| | | | g [| |]]; simpl in H; try easy.
    + left. split; auto. intros t T Z. destruct H as (H & I). specialize (H Pp).
      destruct (Zeros t Z); subst t; apply Rnot_le_lt; intros C; [apply Sp in C | apply Sq in C]; lra.
    + destruct H as (_ & H & _). lra.
    + destruct H as (-> & _ & H). right. exists x. split; [exists k, y; repeat split; auto; lra |].
      split; auto. split; auto. split; [now apply Sp |]. intros t T Z. destruct (Zeros t Z); lra.
    + destruct H as (-> & _ & H & I). right. exists y. split; [exists k, x; repeat split; auto; lra |].
      split; auto. split; auto. split; [now apply Sq |]. intros t T Z. destruct (Zeros t Z); subst t; [| lra].
      apply Rnot_le_lt. intros C. apply Sp in C. lra.
  - assert (Pm : p < 0) by lra.
    assert (Pos : forall t, 0 < t < 1 -> 0 < t - p * (1 - t)) by (intros t T; nra).
    assert (Zeros : forall t, 0 < t < 1 -> quadratic_at f t = 0 -> t = y).
    { intros t T. rewrite F, Fy. specialize (Pos t T). intros Z. apply Rmult_integral in Z.
      destruct Z as [| Z]; [easy |]. apply Rmult_integral in Z. destruct Z as [|Z]; [lra |].
      apply Rmult_integral in Z. lra. }
    assert (Zy : quadratic_at f y = 0) by (rewrite F, Fy; ring).
    assert (U : 0 < - (f2 * f2 * (p * q))).
    { assert (0 < f2 * f2) by nra. assert (0 < - p * q) by nra.
      replace (- (f2 * f2 * (p * q))) with (f2 * f2 * (- p * q)) by ring. now apply Rmult_lt_0_compat. }
    assert (G : forall t, quadratic_at f t * c0 f = - (f2 * f2 * (p * q)) * ((t - p * (1 - t)) * (1 + q)) * (y - t)).
    { intros t. rewrite F, Fy. unfold f. cbn [c0]. ring. }
    assert (W : forall t, 0 < t < 1 -> 0 < - (f2 * f2 * (p * q)) * ((t - p * (1 - t)) * (1 + q))).
    { intros t T. apply Rmult_lt_0_compat; auto. apply Rmult_lt_0_compat; [now apply Pos | lra]. }
    destruct (first_root_nonpositive f b) as [| | | | g [| |]]; simpl in H; try easy.
    + left. split; auto. intros t T Z. rewrite (Zeros t T Z). apply Rnot_le_lt. intros C. apply Sq in C. lra.
    + destruct H as (-> & _ & H). right. exists y. split.
      * split; auto. split; auto. split; intros t T; rewrite G.
        -- apply Rmult_lt_0_compat; [apply W; lra | lra].
        -- assert (0 < - (f2 * f2 * (p * q)) * ((t - p * (1 - t)) * (1 + q)) * (t - y)); [| lra].
           apply Rmult_lt_0_compat; [apply W; lra | lra].
      * split; auto. split; auto. split; [now apply Sq |]. intros t T Z. assert (t = y) by (apply Zeros; auto; lra).
        lra.
    + destruct H as (_ & H & _). lra.
    + destruct H as (_ & H & _). lra.
Qed.

Lemma first_root_told f b : sign_inside (coefficients f) = uncertain ->
  root_told f b (first_root_nonpositive f b).
Proof.
  intros U. apply both_signs in U. destruct f as [f0 f1 f2]. cbn [c0 c1 c2] in U.
  destruct (Req_dec f0 0) as [-> | N0].
  { unfold first_root_nonpositive. cbv zeta. cbn [c0 c1 c2]. rewrite (sign_zero 0) by easy. cbn [same_sign].
    apply rational_told; [nra |]. intros t T. unfold quadratic_at, value, linear_at. cbn [c0 c1 c2]. split; intros Z.
    - apply Rmult_eq_reg_l with t; lra.
    - transitivity (t * (f1 * (1 - t) + f2 * t)); [ring | rewrite Z; ring]. }
  destruct (Req_dec f2 0) as [-> | N2].
  { unfold first_root_nonpositive. cbv zeta. cbn [c0 c1 c2]. rewrite (sign_zero 0) by easy.
    replace (same_sign (sign_of_real f0) zero) with false by (cases_of_sign f0; easy). cbn [same_sign].
    apply rational_told; [nra |]. intros t T. unfold quadratic_at, value, linear_at. cbn [c0 c1 c2]. split; intros Z.
    - apply Rmult_eq_reg_l with (1 - t); lra.
    - transitivity ((1 - t) * (f0 * (1 - t) + f1 * t)); [ring | rewrite Z; ring]. }
  set (d := f1 * f1 - 4 * (f0 * f2)).
  destruct (Rlt_or_le 0 d) as [D | D].
  { destruct (factors f0 f1 f2 N2 D) as (p & q & O & -> & ->).
    assert (P : p * q <> 0) by (intros Z; rewrite Z in N0; lra).
    assert (p <> 0) by (intros Z; rewrite Z in P; lra).
    apply two_told; auto. clear d D N0. apply Rnot_le_lt. intros Q.
    assert (p < 0) by lra. assert (0 <= p * q) by nra. assert (p + q < 0) by lra. nra. }
  assert (S : 0 < f0 * f2) by (unfold d in D; assert (0 <= f1 * f1) by nra; nra).
  assert (same_sign (sign_of_real f0) (sign_of_real f2) = true /\ same_sign (sign_of_real f0) zero = false
    /\ same_sign (sign_of_real f2) zero = false) as (T1 & T2 & T3).
  { cases_of_sign f0; cases_of_sign f2; try nra; repeat split. }
  unfold first_root_nonpositive. cbv zeta. cbn [c0 c1 c2]. rewrite T1, T2, T3. fold d. cbn [andb].
  assert (Sq : forall t, 4 * f2 * quadratic_at (Quadratic f0 f1 f2) t =
    linear_at f1 (2 * f2) t * linear_at f1 (2 * f2) t - d * ((1 - t) * (1 - t)))
    by (intros t; unfold quadratic_at, value, linear_at, d; cbn [c0 c1 c2]; ring).
  destruct D as [D | D].
  - rewrite (sign_negative d D). cbn [same_sign]. left. split; auto. intros t T Z. exfalso.
    specialize (Sq t). rewrite Z, Rmult_0_r in Sq. pose proof (Rle_0_sqr (linear_at f1 (2 * f2) t)) as P.
    unfold Rsqr in P. assert (0 < - d * ((1 - t) * (1 - t))) by (apply Rmult_lt_0_compat; nra). lra.
  - rewrite (sign_zero d D). cbn [same_sign].
    assert (Op : f1 * (2 * f2) < 0) by (assert (f1 <> 0) by (intros ->; unfold d in D; lra); nra).
    apply rational_told; auto.
    intros t T. specialize (Sq t). rewrite D in Sq. split; intros Z.
    + rewrite Z in Sq. apply Rsqr_0_uniq. unfold Rsqr. lra.
    + rewrite Z in Sq. apply Rmult_eq_reg_l with (4 * f2); lra.
Qed.

(** ** nonpositive_at_a_root *)

Definition nonpositive_at_a_root (f b : quadratic) : bool :=
  let first := sign_of_real (c0 f) in
  let last := sign_of_real (c2 f) in
  if same_sign first zero then nonpositive (code_value b (Rabs (c2 f)) (Rabs (c1 f)))
  else if same_sign last zero then nonpositive (code_value b (Rabs (c1 f)) (Rabs (c0 f)))
  else
    let two_roots := same_sign first last in
    let discriminant := sign_of_real (c1 f * c1 f - 4 * (c0 f * c2 f)) in
    if two_roots && same_sign discriminant negative then false
    else if two_roots && same_sign discriminant zero
      then nonpositive (code_value b (2 * Rabs (c2 f)) (Rabs (c1 f)))
    else
      let l0 := c2 f * c0 b - c2 b * c0 f in
      let l1 := c2 f * c1 b - c2 b * c1 f in
      let answer of_l := certainly_nonpositive (times last of_l) in
      let everywhere := sign_inside (S := reals) [l0; l1] in
      if certain everywhere then answer everywhere
      else
        let s := Rabs l1 in
        let t := Rabs l0 in
        let there := sign_of_real (code_value f s t) in
        if same_sign there zero || (two_roots && negb (same_sign there first)) then true
        else
          let roots_are_later :=
            if two_roots
            then negb (same_sign (sign_of_real (linear_value (c1 f - 2 * c0 f) (2 * c2 f - c1 f) s t)) first)
            else same_sign there first in
          answer (sign_of_real (if roots_are_later then l1 else l0)).

Definition nonpositive_somewhere (f b : quadratic) : Prop :=
  exists x, 0 < x /\ at_ratio f x = 0 /\ at_ratio b x <= 0.

Definition told (place : place_in_time) : bool := match place with nowhere => false | _ => true end.
(** Outside of two roots, the derivative is not zero. *)
Lemma slope_outside f s t : (c0 f < 0 \/ c1 f < 0 \/ c2 f < 0) -> (0 < c0 f \/ 0 < c1 f \/ 0 < c2 f) ->
  0 < c0 f * c2 f -> 0 < c1 f * c1 f - 4 * (c0 f * c2 f) -> 0 < c0 f * code_value f s t ->
  linear_value (c1 f - 2 * c0 f) (2 * c2 f - c1 f) s t <> 0.
Proof.
  destruct f as [f0 f1 f2]. cbn [c0 c1 c2]. intros Neg Pos S D V.
  destruct (factors f0 f1 f2 ltac:(nra) D) as (p & q & O & E0 & E1).
  assert (N : f0 * f1 < 0) by nra. unfold code_value in V. rewrite value_of_code in V. unfold value in V.
  cbn [c0 c1 c2] in V.
  assert (F : 0 < f2 * f2) by nra. assert (PQ : 0 < p * q) by (rewrite E0 in S; nra).
  assert (0 < p + q) by (rewrite E0, E1 in N; nra). assert (0 < p) by nra. assert (0 < q) by nra.
  assert (W : 0 < (t - p * s) * (t - q * s)).
  { replace (f0 * _) with (f2 * f2 * (p * q) * ((t - p * s) * (t - q * s))) in V by (rewrite E0, E1; ring).
    assert (0 < f2 * f2 * (p * q)) by nra. nra. }
  unfold linear_value. cbn. rewrite E0, E1. intros Z.
  assert (Z' : (1 + p) * (t - q * s) = - ((1 + q) * (t - p * s))) by (apply Rmult_eq_reg_l with f2; [lra | nra]).
  assert (0 <= (1 + q) * ((t - p * s) * (t - p * s))) by (apply Rmult_le_pos; [lra | apply Rle_0_sqr]).
  assert (E : (1 + p) * ((t - p * s) * (t - q * s)) = - ((1 + q) * ((t - p * s) * (t - p * s)))).
  { transitivity ((t - p * s) * ((1 + p) * (t - q * s))); [ring | rewrite Z'; ring]. }
  assert (0 < (1 + p) * ((t - p * s) * (t - q * s))) by (apply Rmult_lt_0_compat; lra). lra.
Qed.
Lemma nonpositive_told f b : sign_inside (coefficients f) = uncertain ->
  nonpositive_at_a_root f b = told (first_root_nonpositive f b).
Proof.
  intros U. apply both_signs in U. destruct U as (Pos & Neg).
  assert (If : forall (c : bool) p, told p = true -> told (if c then p else nowhere) = c) by now intros [].
  unfold nonpositive_at_a_root, first_root_nonpositive. cbv zeta. rewrite Rabs_mult, (Rabs_pos_eq 2) by lra.
  set (l0 := c2 f * c0 b - c2 b * c0 f). set (l1 := c2 f * c1 b - c2 b * c1 f).
  pose proof (slope_outside f (Rabs l1) (Rabs l0) Neg Pos) as Slope.
  cases_of_sign (c0 f); cases_of_sign (c2 f); cbn [same_sign andb negb]; rewrite ?If by easy; try reflexivity;
    cases_of_sign (c1 f * c1 f - 4 * (c0 f * c2 f)); cbn [same_sign]; rewrite ?If by easy; try reflexivity;
    destruct (certain _); rewrite ?If by easy; try reflexivity;
    cases_of_sign (code_value f (Rabs l1) (Rabs l0)); cbn [same_sign andb orb negb opposite_sign];
    try specialize (Slope ltac:(nra) ltac:(assumption) ltac:(nra));
    try cases_of_sign (linear_value (c1 f - 2 * c0 f) (2 * c2 f - c1 f) (Rabs l1) (Rabs l0)); try contradiction;
    cbn [same_sign negb]; rewrite ?If by easy; try reflexivity;
    match goal with |- _ = told (if ?c then _ else _) => now destruct c end.
Qed.
Theorem nonpositive_at_a_root_right f b : sign_inside (coefficients f) = uncertain ->
  nonpositive_at_a_root f b = true <-> nonpositive_somewhere f b.
Proof.
  intros U. rewrite (nonpositive_told f b U).
  destruct (first_root_told f b U) as [(-> & No) | (r & T & R0 & Z & N & _)].
  - split; [discriminate |]. intros (x & X & Z & N). destruct (place_of_ratio x X) as (T & E).
    destruct (inside_ratio f _ T) as (F & _), (inside_ratio b _ T) as (_ & B). rewrite E in F, B.
    apply F in Z. apply B in N. specialize (No _ T Z). lra.
  - split; [intros _ | intros _; now destruct (first_root_nonpositive f b)].
    exists (r / (1 - r)). split; [apply Rdiv_lt_0_compat; lra |].
    split; [now apply inside_ratio | now apply inside_ratio].
Qed.

(** ** contact *)

(** The product of two linear forms, and the components of W x E and W X. *)
Definition product_of (a b : R * R) : quadratic :=
  Quadratic (fst a * fst b) (fst a * snd b + snd a * fst b) (snd a * snd b).
Definition plus (f g : quadratic) : quadratic := Quadratic (c0 f + c0 g) (c1 f + c1 g) (c2 f + c2 g).
Definition less (f g : quadratic) : quadratic := Quadratic (c0 f - c0 g) (c1 f - c1 g) (c2 f - c2 g).
Definition axis (component : point -> R) (p q : moving) : R * R :=
  (component (start p) - component (start q), component (finish p) - component (finish q)).
Definition cross_x (v e0 e1 : moving) : quadratic :=
  less (product_of (axis y v e0) (axis z e1 e0)) (product_of (axis z v e0) (axis y e1 e0)).
Definition cross_y (v e0 e1 : moving) : quadratic :=
  less (product_of (axis z v e0) (axis x e1 e0)) (product_of (axis x v e0) (axis z e1 e0)).
Definition cross_z (v e0 e1 : moving) : quadratic :=
  less (product_of (axis x v e0) (axis y e1 e0)) (product_of (axis y v e0) (axis x e1 e0)).
Definition between (v e0 e1 : moving) : quadratic :=
  plus (plus (product_of (axis x v e0) (axis x v e1)) (product_of (axis y v e0) (axis y v e1)))
    (product_of (axis z v e0) (axis z v e1)).

Definition touches (f0 f1 f2 b : quadratic) (c : quadratic -> R) : bool :=
  is_0 (c f0) && is_0 (c f1) && is_0 (c f2) && nonpositive (c b).
Definition touches_sometime (f0 f1 f2 b : quadratic) : bool :=
  if certainly_rootless (coefficients f0) then false
  else if certainly_rootless (coefficients f1) then false
  else if certainly_rootless (coefficients f2) then false
  else if same_sign (sign_throughout (coefficients b)) positive then false
  else if touches f0 f1 f2 b c0 || touches f0 f1 f2 b c2 then true
  else if same_sign (sign_inside (coefficients b)) positive then false
  else match common_roots [f0; f1; f2] with
    | none => false
    | one squares => nonpositive (value_at_squares b squares)
    | of_quadratic f => nonpositive_at_a_root f b
    | everywhere => below_0 (c1 b) && nonpositive (4 * (c0 b * c2 b) - c1 b * c1 b)
    end.
Definition contact (v e0 e1 : moving) : bool :=
  touches_sometime (cross_x v e0 e1) (cross_y v e0 e1) (cross_z v e0 e1) (between v e0 e1).

Definition meets (f0 f1 f2 b : quadratic) (t : R) : Prop :=
  all_vanish [f0; f1; f2] t /\ quadratic_at b t <= 0.
Lemma at_ends f : quadratic_at f 0 = c0 f /\ quadratic_at f 1 = c2 f.
Proof. unfold quadratic_at, value. split; ring. Qed.
Lemma touches_true f0 f1 f2 b :
  (touches f0 f1 f2 b c0 = true <-> meets f0 f1 f2 b 0) /\
  (touches f0 f1 f2 b c2 = true <-> meets f0 f1 f2 b 1).
Proof.
  unfold touches, meets, all_vanish.
  rewrite !andb_true_iff, !is_0_true, !nonpositive_true.
  rewrite !Forall_cons_iff. destruct (at_ends f0), (at_ends f1), (at_ends f2), (at_ends b).
  repeat match goal with H : quadratic_at _ _ = _ |- _ => rewrite H; clear H end.
  split; split; intuition.
Qed.

(** b0, b2 > 0, and b has a value <= 0 at some x > 0. *)
Lemma dips b : 0 < c0 b -> 0 < c2 b ->
  (c1 b < 0 /\ 4 * (c0 b * c2 b) - c1 b * c1 b <= 0) <-> exists x, 0 < x /\ at_ratio b x <= 0.
Proof.
  intros A B. unfold at_ratio. split.
  - intros (N & D). exists (- c1 b / (2 * c2 b)). split; [apply Rdiv_lt_0_compat; lra |].
    apply Rmult_le_reg_r with (4 * c2 b); [lra |].
    field_simplify; [| lra]. lra.
  - intros (x & X & L). assert (0 < c2 b * x ^ 2) by (apply Rmult_lt_0_compat; [| apply pow_lt]; easy).
    split; [nra |].
    assert (0 <= (2 * c2 b * x + c1 b) * (2 * c2 b * x + c1 b)) by apply Rle_0_sqr. nra.
Qed.

Lemma contact_of_quadratics f0 f1 f2 b :
  touches_sometime f0 f1 f2 b = true <-> exists t, 0 <= t <= 1 /\ meets f0 f1 f2 b t.
Proof.
  unfold touches_sometime.
  assert (Rootless : forall f, certainly_rootless (coefficients f) = true -> In f [f0; f1; f2] ->
    false = true <-> exists t, 0 <= t <= 1 /\ meets f0 f1 f2 b t).
  { intros f C I. split; [discriminate |]. intros (t & T & V & _).
    destruct (rootless_hull _ t C T). rewrite at_time_quadratic. now apply (proj1 (Forall_forall _ _) V). }
  destruct (certainly_rootless (coefficients f0)) eqn:R0; [apply (Rootless f0); simpl; auto |].
  destruct (certainly_rootless (coefficients f1)) eqn:R1; [apply (Rootless f1); simpl; auto |].
  destruct (certainly_rootless (coefficients f2)) eqn:R2; [apply (Rootless f2); simpl; auto |].
  clear Rootless R0 R1 R2.
  destruct (same_sign (sign_throughout (coefficients b)) positive) eqn:H.
  { split; [discriminate |]. intros (t & T & _ & B). pose proof (sign_throughout_right (coefficients b) t T) as S.
    destruct (sign_throughout (coefficients b)); try discriminate.
    rewrite at_time_quadratic in S. simpl in S. lra. }
  clear H. destruct (touches_true f0 f1 f2 b) as (T0 & T1).
  destruct (touches f0 f1 f2 b c0) eqn:S0.
  { cbn [orb]. split; auto. intros _. exists 0. split; [lra | now apply T0]. }
  destruct (touches f0 f1 f2 b c2) eqn:S1.
  { cbn [orb]. split; auto. intros _. exists 1. split; [lra | now apply T1]. }
  cbn [orb].
  assert (Inside : (exists t, 0 <= t <= 1 /\ meets f0 f1 f2 b t) <-> exists t, 0 < t < 1 /\ meets f0 f1 f2 b t).
  { split; intros (t & T & M); exists t; split; auto; [| lra].
    destruct (Req_dec t 0) as [-> | N0]; [now apply T0 in M |].
    destruct (Req_dec t 1) as [-> | N1]; [now apply T1 in M |]. lra. }
  rewrite Inside. clear Inside.
  destruct (same_sign (sign_inside (coefficients b)) positive) eqn:H.
  { split; [discriminate |]. intros (t & T & _ & B). pose proof (sign_inside_right (coefficients b) t T) as S.
    destruct (sign_inside (coefficients b)); try discriminate.
    rewrite at_time_quadratic in S. simpl in S. lra. }
  pose proof (common_roots_right [f0; f1; f2]) as K.
  destruct (common_roots [f0; f1; f2]) as [| m | f |]; simpl in K.
  - split; [discriminate |]. intros (t & T & V & _). now apply (K t T) in V.
  - destruct K as (k & t & P & T & Sq & Only). rewrite nonpositive_true, (value_squares b m k t Sq). split.
    + intros B. exists t. split; auto. split; [now apply Only | nra].
    + intros (r & U & V & B). apply Only in V; auto. subst r. nra.
  - destruct K as (U & Same). rewrite (nonpositive_at_a_root_right f b U). unfold nonpositive_somewhere.
    rewrite <- (by_ratio (fun x => at_ratio f x = 0 /\ at_ratio b x <= 0)).
    split; intros (t & T & A & B); exists t; split; auto.
    + split; [apply Same; auto |]; now apply inside_ratio.
    + split; [apply inside_ratio; auto; now apply Same | now apply inside_ratio].
  - assert (B0 : 0 < c0 b /\ 0 < c2 b).
    { rewrite <- (proj1 (at_ends b)), <- (proj2 (at_ends b)). split; apply Rnot_le_lt; intros B.
      - assert (M : meets f0 f1 f2 b 0) by now split. now apply T0 in M.
      - assert (M : meets f0 f1 f2 b 1) by now split. now apply T1 in M. }
    destruct B0 as (B0 & B2). rewrite andb_true_iff, nonpositive_true.
    assert (E : below_0 (c1 b) = true <-> c1 b < 0) by (unfold below_0; destruct Rlt_dec; split; easy).
    rewrite E, (dips b B0 B2), <- (by_ratio (fun x => at_ratio b x <= 0)).
    split; intros (t & T & B); exists t; split; auto.
    + split; [apply K | now apply inside_ratio].
    + destruct B as (_ & B). now apply inside_ratio.
Qed.

Lemma meets_contact v e0 e1 t :
  meets (cross_x v e0 e1) (cross_y v e0 e1) (cross_z v e0 e1) (between v e0 e1) t <->
  in_segment (place v t) (place e0 t) (place e1 t).
Proof.
  rewrite vertex_edge_contact. unfold vertex_edge_test, meets, all_vanish.
  rewrite !Forall_cons_iff.
  replace (quadratic_at (between v e0 e1) t) with
    (dot (minus (place v t) (place e0 t)) (minus (place v t) (place e1 t)))
    by (unfold quadratic_at, value, between, dot, minus, place; cbn; ring).
  replace (quadratic_at (cross_x v e0 e1) t) with
    (x (cross (minus (place v t) (place e0 t)) (minus (place e1 t) (place e0 t))))
    by (unfold quadratic_at, value, cross_x, cross, minus, place; cbn; ring).
  replace (quadratic_at (cross_y v e0 e1) t) with
    (y (cross (minus (place v t) (place e0 t)) (minus (place e1 t) (place e0 t))))
    by (unfold quadratic_at, value, cross_y, cross, minus, place; cbn; ring).
  replace (quadratic_at (cross_z v e0 e1) t) with
    (z (cross (minus (place v t) (place e0 t)) (minus (place e1 t) (place e0 t))))
    by (unfold quadratic_at, value, cross_z, cross, minus, place; cbn; ring).
  split.
  - intros ((A & B & C & _) & D). split; auto. now apply same_point.
  - intros (A & D). split; auto. rewrite A. repeat split. constructor.
Qed.

Theorem contact_right v e0 e1 : contact v e0 e1 = true <-> vertex_edge_collides v e0 e1.
Proof.
  unfold contact. rewrite contact_of_quadratics. unfold vertex_edge_collides, sometime.
  split; intros (t & T & H); exists t; split; auto; now apply meets_contact.
Qed.
