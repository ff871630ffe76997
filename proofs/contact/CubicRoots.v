(** Roots of a cubic in (0, 1) (ccd/exact/cubic_roots.hpp), over the real numbers, since the code's integers and
    signs are exact. The estimates in floating point are arbitrary here. Results:
        no_changes, one_change, odd_changes   consequences of the coefficients' sign changes (Descartes)
        any_change          with three distinct real roots, any sign change is a root
        one_real_root       otherwise at most one root is crossed, and others are multiple
        double_root_place, triple_root_place   the positions of multiple roots
        halves_at, halves_changes   halves of an interval together have no more sign changes than the whole
        bracket_near_right  a bracket contains the root that is crossed, or is a root *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool Classical.
From Errbound Require Import Sign Bernstein VertexEdge.
Import ListNotations.
Open Scope R_scope.

(** ** Signs of coefficients *)

(** inner_sign_changes: its loop, then opposite = first != last. *)
Record sign_changes := SignChanges { count : nat; opposite : bool; first : sign }.
Fixpoint changes_from (count : nat) (first last : sign) (signs : list sign) : sign_changes :=
  match signs with
  | [] => SignChanges count (negb (same_sign first last)) first
  | sign :: rest =>
      if same_sign sign zero then changes_from count first last rest
      else if same_sign last zero then changes_from count sign sign rest
      else changes_from (if same_sign sign last then count else S count) first sign rest
  end.
Definition changes_of (signs : list sign) : sign_changes := changes_from 0 zero zero signs.
Definition inner_sign_changes (y : list R) : sign_changes := changes_of (map sign_of_real y).

(** The polynomial, on [0, 1]. *)
Definition at_ (y : list R) (t : R) : R := form y (1 - t) t.
Definition unit_of (s : sign) : R := match s with negative => -1 | positive => 1 | _ => 0 end.
Definition opposed (s : sign) : sign :=
  match s with negative => positive | positive => negative | _ => s end.

(** The sign of f just after a, and just before b. *)
Definition sign_after (s : sign) (f : R -> R) (a : R) : Prop :=
  exists d, 0 < d /\ forall t, a < t < a + d -> 0 < unit_of s * f t.
Definition sign_before (s : sign) (f : R -> R) (b : R) : Prop :=
  exists d, 0 < d /\ forall t, b - d < t < b -> 0 < unit_of s * f t.

Lemma continuous_form y : continuity (at_ y).
Proof.
  intros t. apply derivable_continuous_pt. exists (slope y t). apply derivable_form.
Qed.

Fixpoint first_sign (y : list R) : sign :=
  match y with
  | [] => zero
  | a :: l => if same_sign (sign_of_real a) zero then first_sign l else sign_of_real a
  end.
Lemma sign_after_start y : first_sign y <> zero -> sign_after (first_sign y) (at_ y) 0.
Proof.
  induction y as [| a l IH]; [easy |]. simpl. intros N.
  destruct (Req_dec a 0) as [-> | A].
  - rewrite (sign_zero 0 eq_refl) in *. simpl in *. destruct (IH N) as (d & D & H). exists d. split; auto.
    intros u U. specialize (H u U). unfold at_ in *. simpl. rewrite Rmult_0_l, Rplus_0_l.
    replace (unit_of (first_sign l) * (u * form l (1 - u) u))
      with (u * (unit_of (first_sign l) * form l (1 - u) u)) by ring.
    apply Rmult_lt_0_compat; lra.
  - clear IH. assert (E : at_ (a :: l) 0 = a).
    { unfold at_. rewrite Rminus_0_r. apply (proj1 (form_ends a l 0)). }
    destruct (continuous_form (a :: l) 0 (Rabs a) ltac:(now apply Rabs_pos_lt)) as (d & D & H).
    exists d. split; auto. intros u U.
    specialize (H u). simpl in H. unfold R_dist, D_x, no_cond in H. rewrite E, Rminus_0_r in H.
    specialize (H ltac:(split; [split; [easy | lra] | rewrite Rabs_pos_eq; lra])).
    destruct (Rtotal_order a 0) as [L | [L | L]]; [| easy |].
    + rewrite (sign_negative a L) in *. simpl. rewrite (Rabs_left a) in H by easy. apply Rabs_def2 in H. lra.
    + rewrite (sign_positive a L) in *. simpl. rewrite (Rabs_pos_eq a) in H by lra. apply Rabs_def2 in H. lra.
Qed.
Lemma reversed_at y t : at_ (rev y) t = at_ y (1 - t).
Proof.
  unfold at_. pose proof (reversed_form (S := reals) y (1 - t) t) as E. simpl in E.
  rewrite !map_id in E. rewrite E. f_equal. ring.
Qed.
Lemma sign_before_end y : first_sign (rev y) <> zero -> sign_before (first_sign (rev y)) (at_ y) 1.
Proof.
  intros N. destruct (sign_after_start (rev y) N) as (d & D & H). exists d. split; auto.
  intros u U. replace u with (1 - (1 - u)) by ring. rewrite <- reversed_at. apply H. lra.
Qed.

(** Destructs a list of four coefficients. *)
Ltac four y L := destruct y as [| ?y0 [| ?y1 [| ?y2 [| ?y3 [|]]]]]; try discriminate L; clear L.
Ltac four_signs a b c d :=
  cases_of_sign a; cases_of_sign b; cases_of_sign c; cases_of_sign d.

Lemma same_four (a b c d a' b' c' d' : R) : a = a' -> b = b' -> c = c' -> d = d' -> [a; b; c; d] = [a'; b';
  c'; d'].
Proof. now intros -> -> -> ->. Qed.

Lemma changes_ends y : length y = 4%nat -> let c := inner_sign_changes y in
  first c = first_sign y /\ opposite c = negb (same_sign (first_sign y) (first_sign (rev y))) /\
  (first_sign y = zero <-> first_sign (rev y) = zero) /\
  (first_sign y = zero -> Forall (eq 0) y /\ count c = 0%nat) /\ (opposite c = true -> (0 < count c)%nat).
Proof.
  intros L. four y L. unfold inner_sign_changes. cbn [rev app map first_sign].
  four_signs y0 y1 y2 y3; cbn; repeat split; auto; try discriminate; try lia; repeat constructor; auto.
Qed.
(** Facts about the signs just inside the ends, unless Y is zero throughout. *)
Lemma changes_first y : length y = 4%nat -> ~ Forall (eq 0) y -> let c := inner_sign_changes y in
  sign_after (first c) (at_ y) 0 /\
  sign_before (if opposite c then opposed (first c) else first c) (at_ y) 1 /\
  (first c = positive \/ first c = negative).
Proof.
  intros L N c. destruct (changes_ends y L) as (F & O & Z & C & _). fold c in F, O, C.
  assert (Nz : first_sign y <> zero) by (intros E; now apply N, C). rewrite F.
  assert (U : forall l, first_sign l <> uncertain).
  { clear. induction l as [| a l IH]; simpl; [discriminate |]. pose proof (never_uncertain a).
    destruct (same_sign (sign_of_real a) zero); auto. }
  split; [now apply sign_after_start |].
  assert (Nl : first_sign (rev y) <> zero) by (intros E; apply Nz, Z, E).
  pose proof (sign_before_end y Nl) as E. pose proof (U y). pose proof (U (rev y)). rewrite O.
  destruct (first_sign y), (first_sign (rev y)); simpl; split; auto; easy.
Qed.
Lemma changes_moving y : length y = 4%nat -> (0 < count (inner_sign_changes y))%nat -> ~ Forall (eq 0) y.
Proof.
  intros L C Z. revert C. four y L.
  repeat match goal with H : Forall _ (_ :: _) |- _ => inversion_clear H end.
  subst. unfold inner_sign_changes. cbn [map]. rewrite (sign_zero 0 eq_refl). simpl. lia.
Qed.

(** ** Descartes' rule *)

Lemma unchanging y : length y = 4%nat -> count (inner_sign_changes y) = 0%nat ->
  Forall (Rle 0) y \/ Forall (Rle 0) (map Ropp y).
Proof.
  intros L. four y L. unfold inner_sign_changes. cbn [map].
  four_signs y0 y1 y2 y3; cbn; intros C; try discriminate C;
    first [left; repeat constructor; lra | right; repeat constructor; lra].
Qed.

Theorem no_changes y : length y = 4%nat -> count (inner_sign_changes y) = 0%nat ->
  Forall (eq 0) y \/ forall t, 0 < t < 1 -> at_ y t <> 0.
Proof.
  intros L C.
  assert (P : forall l, Forall (Rle 0) l -> Forall (eq 0) l \/ Exists (Rlt 0) l).
  { induction 1 as [| a l A F [IH | IH]]; [left; constructor | | right; now constructor 2].
    destruct A as [A | A]; [right; now constructor 1 | left; now constructor]. }
  destruct (unchanging y L C) as [F | F]; destruct (P _ F) as [Z | E].
  - now left.
  - right. intros t T. pose proof (hull_inside y (1 - t) t F E ltac:(lra) ltac:(lra)). unfold at_. lra.
  - left. clear - Z. induction y as [| a l IH]; constructor; inversion_clear Z; auto. lra.
  - right. intros t T. pose proof (hull_inside _ (1 - t) t F E ltac:(lra) ltac:(lra)) as H.
    rewrite form_opp in H. unfold at_. lra.
Qed.

Lemma between_signs f a b : continuity f -> a < b -> f a * f b < 0 -> exists t, a < t < b /\ f t = 0.
Proof.
  intros C L N. destruct (IVT_cor f a b C ltac:(lra) ltac:(lra)) as (t & T & Z). exists t.
  split; auto. destruct T as [[Ta | <-] [Tb | ->]]; try lra; rewrite Z in N; lra.
Qed.

(** A point just inside an interval. *)
Lemma just_after s f a b : sign_after s f a -> a < b -> exists t, a < t < b /\ 0 < unit_of s * f t.
Proof.
  intros (d & D & H) L. exists (a + Rmin d (b - a) / 2).
  assert (0 < Rmin d (b - a)) by (apply Rmin_glb_lt; lra).
  pose proof (Rmin_l d (b - a)). pose proof (Rmin_r d (b - a)). split; [lra |]. apply H. lra.
Qed.
Lemma just_before s f a b : sign_before s f b -> a < b -> exists t, a < t < b /\ 0 < unit_of s * f t.
Proof.
  intros (d & D & H) L. exists (b - Rmin d (b - a) / 2).
  assert (0 < Rmin d (b - a)) by (apply Rmin_glb_lt; lra).
  pose proof (Rmin_l d (b - a)). pose proof (Rmin_r d (b - a)). split; [lra |]. apply H. lra.
Qed.

Theorem odd_changes y : length y = 4%nat -> opposite (inner_sign_changes y) = true ->
  exists t, 0 < t < 1 /\ at_ y t = 0.
Proof.
  intros L O. destruct (changes_ends y L) as (_ & _ & _ & _ & C). specialize (C O).
  destruct (changes_first y L (changes_moving y L C)) as (A & B & F). rewrite O in B.
  destruct (just_after _ _ _ (1 / 2) A ltac:(lra)) as (t & T & P).
  destruct (just_before _ _ (1 / 2) _ B ltac:(lra)) as (u & U & M).
  destruct (between_signs (at_ y) t u) as (r & S & Z).
  - apply continuous_form.
  - lra.
  - destruct F as [F | F]; rewrite F in *; simpl in *; nra.
  - exists r. split; auto. lra.
Qed.

(** Between a and b, f is linear up to a factor of constant sign. It crosses zero at most once, and all other roots
    are in Q. *)
Definition crosses_once (a b : R) (f : R -> R) (Q : R -> Prop) : Prop :=
  exists l0 l1 q, forall t, a < t < b -> f t = (l0 + l1 * t) * q t /\ 0 <= q t /\ (q t = 0 -> Q t).

Lemma rootless_once f Q : continuity f -> (forall u, 0 < u < 1 -> f u <> 0) -> crosses_once 0 1 f Q.
Proof.
  intros C N. assert (M : f (1 / 2) <> 0) by (apply N; lra).
  exists (f (1 / 2)), 0, (fun u => f u / f (1 / 2)). intros u U. specialize (N u U) as Nu.
  assert (P : 0 < f u / f (1 / 2)).
  { apply Rnot_le_lt. intros L.
    assert (B : f u * f (1 / 2) < 0).
    { replace (f u * f (1 / 2)) with (f u / f (1 / 2) * (f (1 / 2) * f (1 / 2))) by now field.
      assert (f u / f (1 / 2) <> 0) by (apply Rmult_integral_contrapositive; split; auto;
        now apply Rinv_neq_0_compat).
      assert (0 < f (1 / 2) * f (1 / 2)) by nra. nra. }
    destruct (Rtotal_order u (1 / 2)) as [W | [-> | W]].
    - destruct (between_signs f u (1 / 2) C W B) as (t & T & Z). apply (N t); auto. lra.
    - nra.
    - destruct (between_signs f (1 / 2) u C W ltac:(lra)) as (t & T & Z). apply (N t); auto. lra. }
  split; [now field |]. split; lra.
Qed.

(** Division by a root. *)
Definition linear_times (r q0 q1 q2 : R) : list R :=
  [- r * q0; (1 - r) * q0 - r * q1; (1 - r) * q1 - r * q2; (1 - r) * q2].
Definition quadratic_value (q0 q1 q2 t : R) : R := q0 * (1 - t) ^ 2 + q1 * (1 - t) * t + q2 * t ^ 2.
Lemma divided y r : length y = 4%nat -> 0 < r < 1 -> at_ y r = 0 ->
  exists q0 q1 q2, y = linear_times r q0 q1 q2.
Proof.
  intros L U Z. four y L. exists (- y0 / r), (((1 - r) * (- y0 / r) - y1) / r), (y3 / (1 - r)).
  unfold linear_times. unfold at_ in Z. simpl in Z.
  assert (E : y2 = (1 - r) * (((1 - r) * (- y0 / r) - y1) / r) - r * (y3 / (1 - r))).
  { apply Rmult_eq_reg_r with ((1 - r) * r ^ 2); [| apply Rmult_integral_contrapositive; split; [lra |];
      apply pow_nonzero; lra].
    apply Rminus_diag_uniq. rewrite <- Z. field. lra. }
  rewrite <- E. repeat f_equal; field; lra.
Qed.
Lemma linear_times_at r q0 q1 q2 t : at_ (linear_times r q0 q1 q2) t = (t - r) * quadratic_value q0 q1 q2 t.
Proof. unfold at_, linear_times, quadratic_value. simpl. ring. Qed.

Lemma changing_once y0 y1 y2 y3 : count (inner_sign_changes [y0; y1; y2; y3]) = 1%nat ->
  (y0 <= 0 /\ 0 <= y3 /\ (0 <= y2 \/ y1 <= 0)) \/ (0 <= y0 /\ y3 <= 0 /\ (y2 <= 0 \/ 0 <= y1)).
Proof.
  unfold inner_sign_changes. cbn [map].
  four_signs y0 y1 y2 y3; cbn; intros C; try discriminate C; lra.
Qed.
Lemma positive_quadratic q0 q1 q2 u : 0 < u < 1 -> 0 <= q0 -> 0 <= q1 -> 0 <= q2 -> 0 < q0 + q1 + q2 ->
  0 < quadratic_value q0 q1 q2 u.
Proof.
  intros U A B C S. unfold quadratic_value. assert (0 < (1 - u) ^ 2) by (apply pow_lt; lra).
  assert (0 < u ^ 2) by (apply pow_lt; lra). assert (0 < (1 - u) * u) by (apply Rmult_lt_0_compat; lra).
  assert (0 <= q0 * (1 - u) ^ 2) by (apply Rmult_le_pos; lra).
  assert (0 <= q1 * ((1 - u) * u)) by (apply Rmult_le_pos; lra).
  assert (0 <= q2 * u ^ 2) by (apply Rmult_le_pos; lra).
  destruct (Req_dec q0 0) as [Z0 | Z0]; [destruct (Req_dec q1 0) as [Z1 | Z1] |].
  - assert (0 < q2 * u ^ 2) by (apply Rmult_lt_0_compat; lra). lra.
  - assert (0 < q1 * ((1 - u) * u)) by (apply Rmult_lt_0_compat; lra). lra.
  - assert (0 < q0 * (1 - u) ^ 2) by (apply Rmult_lt_0_compat; lra). lra.
Qed.
(** The product with a factor without roots, of any sign. *)
Lemma linear_times_once r q0 q1 q2 (Q : R -> Prop) :
  (forall u, 0 < u < 1 -> 0 <= quadratic_value q0 q1 q2 u /\ (quadratic_value q0 q1 q2 u = 0 -> Q u)) \/
  (forall u, 0 < u < 1 -> quadratic_value q0 q1 q2 u <= 0 /\ (quadratic_value q0 q1 q2 u = 0 -> Q u)) ->
  crosses_once 0 1 (at_ (linear_times r q0 q1 q2)) Q.
Proof.
  intros [H | H].
  - exists (- r), 1, (quadratic_value q0 q1 q2). intros u U. rewrite linear_times_at.
    destruct (H u U). split; [ring | auto].
  - exists r, (-1), (fun u => - quadratic_value q0 q1 q2 u). intros u U. rewrite linear_times_at.
    destruct (H u U). split; [ring | split; [lra |]]. intros Z. apply H1. lra.
Qed.

Lemma one_change_crosses y : length y = 4%nat -> count (inner_sign_changes y) = 1%nat ->
  crosses_once 0 1 (at_ y) (fun _ => False).
Proof.
  intros L C. destruct (classic (exists r, 0 < r < 1 /\ at_ y r = 0)) as [(r & U & Z) | N].
  2: { apply rootless_once; [apply continuous_form |]. intros u U Z. apply N. now exists u. }
  destruct (divided y r L U Z) as (q0 & q1 & q2 & ->). clear Z L.
  assert (N : q0 <> 0 \/ q1 <> 0 \/ q2 <> 0).
  { destruct (Req_dec q0 0) as [-> |]; auto. destruct (Req_dec q1 0) as [-> |]; auto.
    destruct (Req_dec q2 0) as [-> |]; auto. exfalso. revert C. unfold linear_times, inner_sign_changes.
    cbn [map]. rewrite !sign_zero by ring. discriminate. }
  apply changing_once in C.
  assert (R1 : 0 < 1 - r) by lra. destruct U as (U & _).
  assert (P : forall a b, 0 < a -> 0 <= a * b -> 0 <= b) by (clear; intros; nra).
  apply linear_times_once. destruct C as [(A & D & B) | (A & D & B)]; [left | right]; intros u V.
  - assert (Q0 : 0 <= q0) by (apply (P r); lra). assert (Q2 : 0 <= q2) by (apply (P (1 - r)); lra).
    assert (Q1 : 0 <= q1) by nra.
    pose proof (positive_quadratic q0 q1 q2 u V Q0 Q1 Q2 ltac:(lra)). split; [lra |]. intros. lra.
  - assert (Q0 : 0 <= - q0) by (apply (P r); lra). assert (Q2 : 0 <= - q2) by (apply (P (1 - r)); lra).
    assert (Q1 : 0 <= - q1) by nra.
    pose proof (positive_quadratic (- q0) (- q1) (- q2) u V Q0 Q1 Q2 ltac:(lra)) as H.
    replace (quadratic_value (- q0) (- q1) (- q2) u) with (- quadratic_value q0 q1 q2 u) in H
      by (unfold quadratic_value; ring). split; [lra |]. intros. lra.
Qed.
Lemma one_change_opposite y : length y = 4%nat -> count (inner_sign_changes y) = 1%nat ->
  opposite (inner_sign_changes y) = true.
Proof.
  intros L. four y L. unfold inner_sign_changes. cbn [map].
  four_signs y0 y1 y2 y3; cbn; intros C; congruence.
Qed.
(** There is exactly one root, at which Y changes its sign; Y may vanish at the ends. *)
Theorem one_change y : length y = 4%nat -> let c := inner_sign_changes y in count c = 1%nat ->
  exists r, 0 < r < 1 /\ at_ y r = 0 /\ forall t, 0 < t < 1 ->
    (t < r -> 0 < unit_of (first c) * at_ y t) /\ (r < t -> unit_of (first c) * at_ y t < 0).
Proof.
  intros L c C. destruct (one_change_crosses y L C) as (l0 & l1 & q & H).
  destruct (odd_changes y L (one_change_opposite y L C)) as (r & U & Z). exists r. do 2 (split; auto).
  assert (P : forall t, 0 < t < 1 -> 0 < q t).
  { intros t T. destruct (H t T) as (_ & [Q | Q] & N); [easy |]. now destruct N. }
  assert (E : l0 = - l1 * r).
  { destruct (H r U) as (E & _). rewrite Z in E. specialize (P r U).
    apply Rmult_eq_reg_r with (q r); [| lra]. lra. }
  assert (V : forall t, 0 < t < 1 ->
    unit_of (first c) * at_ y t = (- (unit_of (first c) * l1)) * ((r - t) * q t)).
  { intros t T. destruct (H t T) as (-> & _). rewrite E. ring. }
  destruct (changes_first y L (changes_moving y L ltac:(unfold c in C; lia))) as (A & _). fold c in A.
  destruct (just_after _ _ _ r A ltac:(lra)) as (t & T & S). rewrite V in S by lra.
  assert (K : 0 < - (unit_of (first c) * l1)).
  { assert (0 < (r - t) * q t) by (apply Rmult_lt_0_compat; [lra | apply P; lra]).
    apply Rnot_le_lt. intros N. nra. }
  intros u W. rewrite V by auto. specialize (P u W). split; intros B.
  - apply Rmult_lt_0_compat; auto. apply Rmult_lt_0_compat; lra.
  - assert (0 < (u - r) * q u) by (apply Rmult_lt_0_compat; lra). nra.
Qed.

(** ** The Hessian *)

Definition hessian (y : list R) : quadratic :=
  match y with
  | [y0; y1; y2; y3] =>
      Quadratic (y1 * y1 - 3 * (y0 * y2)) (y1 * y2 - 3 * (3 * (y0 * y3))) (y2 * y2 - 3 * (y1 * y3))
  | _ => Quadratic 0 0 0
  end.
Definition discriminant (y : list R) : R :=
  let h := hessian y in 4 * (c0 h * c2 h) - c1 h * c1 h.

(** (t - r)^2 (a (1 - t) + b t) *)
Definition double_times (r a b : R) : list R := linear_times r (- r * a) ((1 - r) * a - r * b) ((1 - r) * b).
Definition multiple_root (y : list R) (r : R) : Prop := exists a b, y = double_times r a b.

(** The Hessian is k times the square of the double root's linear form. *)
Lemma multiple_root_hessian y r : 0 < r < 1 -> multiple_root y r -> exists k, 0 <= k /\
  hessian y = Quadratic (k * r ^ 2) (- (2 * k * r * (1 - r))) (k * (1 - r) ^ 2).
Proof.
  intros U (a & b & ->). exists ((a * (1 - r) + b * r) ^ 2). split; [apply pow2_ge_0 |].
  unfold double_times, linear_times, hessian. f_equal; ring.
Qed.

Lemma discriminant_divided r q0 q1 q2 : discriminant (linear_times r q0 q1 q2) =
  3 * (q1 ^ 2 - 4 * q0 * q2) * quadratic_value q0 q1 q2 r ^ 2.
Proof. unfold discriminant, linear_times, hessian, quadratic_value. cbn [c0 c1 c2]. ring. Qed.

Lemma semidefinite q0 q1 q2 : q1 ^ 2 <= 4 * q0 * q2 ->
  (forall u, 0 < u < 1 -> 0 <= quadratic_value q0 q1 q2 u) \/
  (forall u, 0 < u < 1 -> quadratic_value q0 q1 q2 u <= 0).
Proof.
  intros D. assert (P : 0 <= q0 * q2) by nra.
  assert (E : forall u, 4 * q0 * quadratic_value q0 q1 q2 u =
    (2 * q0 * (1 - u) + q1 * u) ^ 2 + (4 * q0 * q2 - q1 ^ 2) * u ^ 2)
    by (intros; unfold quadratic_value; ring).
  assert (S : forall u, 0 <= 4 * q0 * quadratic_value q0 q1 q2 u).
  { intros u. rewrite E.
    assert (0 <= (4 * q0 * q2 - q1 ^ 2) * u ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]).
    pose proof (pow2_ge_0 (2 * q0 * (1 - u) + q1 * u)). lra. }
  destruct (Rtotal_order q0 0) as [N | [-> | N]].
  - right. intros u _. specialize (S u). nra.
  - assert (q1 = 0) as -> by nra. unfold quadratic_value.
    destruct (Rle_or_lt 0 q2); [left | right]; intros u _; pose proof (pow2_ge_0 u); nra.
  - left. intros u _. specialize (S u). nra.
Qed.
Lemma semidefinite_root q0 q1 q2 u : q1 ^ 2 <= 4 * q0 * q2 -> 0 < u < 1 -> quadratic_value q0 q1 q2 u = 0 ->
  exists c, q0 = c * u ^ 2 /\ q1 = - (2 * c * u * (1 - u)) /\ q2 = c * (1 - u) ^ 2.
Proof.
  intros D U Z. assert (N : (1 - u) ^ 2 <> 0) by (apply pow_nonzero; lra).
  assert (A : 2 * q0 * (1 - u) + q1 * u = 0 /\ (4 * q0 * q2 - q1 ^ 2) * u ^ 2 = 0).
  { assert (E : (2 * q0 * (1 - u) + q1 * u) ^ 2 + (4 * q0 * q2 - q1 ^ 2) * u ^ 2 = 0)
      by (transitivity (4 * q0 * quadratic_value q0 q1 q2 u); [unfold quadratic_value; ring | rewrite Z;
        ring]).
    assert (0 <= (4 * q0 * q2 - q1 ^ 2) * u ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]).
    pose proof (pow2_ge_0 (2 * q0 * (1 - u) + q1 * u)). split; [| lra].
    assert (B : (2 * q0 * (1 - u) + q1 * u) ^ 2 = 0) by lra. simpl in B. rewrite Rmult_1_r in B.
    apply Rmult_integral in B. tauto. }
  destruct A as (A & _). exists (q2 / (1 - u) ^ 2).
  assert (B : q1 * (1 - u) = - (2 * q2 * u)).
  { apply Rmult_eq_reg_r with u; [| lra]. unfold quadratic_value in Z. nra. }
  assert (E1 : q1 = - (2 * q2 * u) / (1 - u)) by (apply Rmult_eq_reg_r with (1 - u); [field_simplify |]; lra).
  assert (E0 : q0 = - (q1 * u) / (2 * (1 - u))) by (apply Rmult_eq_reg_r with (2 * (1 - u));
    [field_simplify |]; lra).
  repeat split; [rewrite E0, E1 | rewrite E1 |]; field; lra.
Qed.

(** If there are not three distinct real roots, Y crosses zero at most once, and other roots are multiple. *)
Theorem one_real_root y : length y = 4%nat -> discriminant y <= 0 ->
  crosses_once 0 1 (at_ y) (fun u => multiple_root y u /\ discriminant y = 0).
Proof.
  intros L D. destruct (classic (exists r, 0 < r < 1 /\ at_ y r = 0)) as [(r & U & Z) | N].
  2: { apply rootless_once; [apply continuous_form |]. intros u U Z. apply N. now exists u. }
  destruct (divided y r L U Z) as (q0 & q1 & q2 & ->). clear Z L.
  rewrite discriminant_divided in *.
  destruct (Req_dec (quadratic_value q0 q1 q2 r) 0) as [Zr | Nr].
  { (* r is multiple *)
    assert (E : exists a b, q0 = - r * a /\ q1 = (1 - r) * a - r * b /\ q2 = (1 - r) * b).
    { exists (- q0 / r), (q2 / (1 - r)). repeat split; [field; lra | | field; lra].
      apply Rmult_eq_reg_r with (r * (1 - r)); [| apply Rmult_integral_contrapositive; lra].
      apply Rminus_diag_uniq. rewrite <- Zr. unfold quadratic_value. field. lra. }
    rewrite Zr. destruct E as (a & b & -> & -> & ->). exists a, (b - a), (fun u => (u - r) ^ 2). intros u V.
    split; [rewrite linear_times_at; unfold quadratic_value; ring | split; [apply pow2_ge_0 |]].
    intros Z. assert (Eu : u = r) by (apply NNPP; intros K; apply (pow_nonzero (u - r) 2); lra). subst u.
    split; [now exists a, b | ring]. }
  assert (P : 0 < quadratic_value q0 q1 q2 r ^ 2) by (pose proof (pow2_ge_0 (quadratic_value q0 q1 q2 r));
    pose proof (pow_nonzero _ 2 Nr); lra).
  assert (S : q1 ^ 2 <= 4 * q0 * q2) by nra.
  assert (M : forall u, 0 < u < 1 -> quadratic_value q0 q1 q2 u = 0 ->
    multiple_root (linear_times r q0 q1 q2) u /\ 3 * (q1 ^ 2 - 4 * q0 * q2) * quadratic_value q0 q1 q2 r ^ 2
      = 0).
  { intros u V Z. destruct (semidefinite_root q0 q1 q2 u S V Z) as (c & -> & -> & ->). split; [| ring].
    exists (- r * c), ((1 - r) * c). unfold double_times, linear_times. apply same_four; ring. }
  apply linear_times_once. destruct (semidefinite q0 q1 q2 S) as [H | H]; [left | right]; auto.
Qed.

(** ** Positions of multiple roots in the code *)

Lemma cubic_at_ratio y0 y1 y2 y3 s t : s + t <> 0 ->
  form [y0; y1; y2; y3] s t = (s + t) ^ 3 * at_ [y0; y1; y2; y3] (t / (s + t)).
Proof. intros N. unfold at_. simpl. field. easy. Qed.

(** If the discriminant is zero and h2 is not, Y = 0 at t/s = -h1/(2 h2), and no other root is multiple. *)
Theorem double_root_place y : length y = 4%nat -> discriminant y = 0 -> let h := hessian y in c2 h <> 0 ->
  0 < c2 h /\ form y (2 * c2 h) (- c1 h) = 0 /\
  forall r, 0 < r < 1 -> multiple_root y r -> c1 h < 0 /\ r = - c1 h / (2 * c2 h - c1 h).
Proof.
  intros L D h N. split; [| split].
  - unfold h in *. four y L.
    assert (E : 4 * c2 (hessian [y0; y1; y2; y3]) ^ 3 =
      (2 * y2 ^ 3 - 9 * y1 * y2 * y3 + 27 * y0 * y3 ^ 2) ^ 2 + 9 * y3 ^ 2 * discriminant [y0; y1; y2; y3])
      by (unfold discriminant, hessian; cbn [c0 c1 c2]; ring).
    rewrite D in E. set (h2 := c2 (hessian [y0; y1; y2; y3])) in *. apply Rnot_le_lt. intros H.
    assert (0 < (- h2) ^ 3) by (apply pow_lt; lra). replace ((- h2) ^ 3) with (- h2 ^ 3) in * by ring.
    pose proof (pow2_ge_0 (2 * y2 ^ 3 - 9 * y1 * y2 * y3 + 27 * y0 * y3 ^ 2)). lra.
  - unfold h. four y L.
    transitivity ((- 9 * y0 * y3 ^ 2 + 3 * y1 * y2 * y3 - 2 / 3 * y2 ^ 3) * discriminant [y0; y1; y2; y3]).
    + unfold discriminant, hessian. cbn [c0 c1 c2]. simpl. field.
    + rewrite D. ring.
  - intros r U M. destruct (multiple_root_hessian y r U M) as (k & K & E). unfold h in *. rewrite E in *.
    cbn [c0 c1 c2] in *. assert (k <> 0) by (intros ->; apply N; ring).
    assert (0 < (1 - r) ^ 2) by (apply pow_lt; lra).
    assert (0 < r * (1 - r)) by (apply Rmult_lt_0_compat; lra).
    assert (0 < k * (1 - r) ^ 2) by (apply Rmult_lt_0_compat; lra).
    assert (0 < k * (r * (1 - r))) by (apply Rmult_lt_0_compat; lra).
    split; [lra |]. apply Rmult_eq_reg_r with (2 * (k * (1 - r) ^ 2) - - (2 * k * r * (1 - r))); [| lra].
    field. lra.
Qed.
(** If also h2 = 0, there is a triple root, inside if there is more than one sign change. *)
Theorem triple_root_place y : length y = 4%nat -> discriminant y = 0 -> c2 (hessian y) = 0 ->
  (1 < count (inner_sign_changes y))%nat -> let s := 3 * nth 3 y 0 in let t := nth 2 y 0 in
  (s < 0 -> 0 < t /\ forall u, at_ y u = 0 <-> u = t / (- s + t)) /\
  (0 <= s -> 0 < s /\ 0 < - t /\ forall u, at_ y u = 0 <-> u = - t / (s + - t)).
Proof.
  intros L. four y L. unfold discriminant, hessian. cbn [c0 c1 c2 nth]. intros D Z C. rewrite Z in D.
  assert (Z1 : y1 * y2 = 9 * (y0 * y3)) by nra. clear D.
  assert (N : y3 <> 0).
  { intros ->. assert (y2 = 0) as -> by nra. unfold inner_sign_changes in C. cbn [map] in C.
    rewrite (sign_zero 0 eq_refl) in C. cases_of_sign y0; cases_of_sign y1; simpl in C; lia. }
  set (x := - y2 / (3 * y3)).
  assert (E2 : y2 = - 3 * y3 * x) by (unfold x; field; auto).
  assert (E1 : y1 = 3 * y3 * x ^ 2) by (apply Rmult_eq_reg_r with (3 * y3); [| lra]; rewrite E2 in Z; nra).
  assert (E0 : y0 = - y3 * x ^ 3) by (apply Rmult_eq_reg_r with (9 * y3); [| lra]; rewrite E1, E2 in Z1; nra).
  clearbody x. subst y0 y1 y2. clear Z Z1.
  assert (X : 0 < x).
  { apply Rnot_le_lt. intros X. unfold inner_sign_changes in C. cbn [map] in C.
    assert (0 <= x ^ 2) by apply pow2_ge_0.
    assert (x ^ 3 <= 0) by (replace (x ^ 3) with (x * x ^ 2) by ring; nra).
    destruct (Rtotal_order y3 0) as [S | [S | S]]; [| lra |].
    - assert (- y3 * x ^ 3 <= 0) by nra. assert (3 * y3 * x ^ 2 <= 0) by nra.
        assert (- 3 * y3 * x <= 0) by nra.
      rewrite (sign_negative y3 S) in C.
      cases_of_sign (- y3 * x ^ 3); cases_of_sign (3 * y3 * x ^ 2); cases_of_sign (- 3 * y3 * x);
        try lra; simpl in C; lia.
    - assert (0 <= - y3 * x ^ 3) by nra. assert (0 <= 3 * y3 * x ^ 2) by nra.
        assert (0 <= - 3 * y3 * x) by nra.
      rewrite (sign_positive y3 S) in C.
      cases_of_sign (- y3 * x ^ 3); cases_of_sign (3 * y3 * x ^ 2); cases_of_sign (- 3 * y3 * x);
        try lra; simpl in C; lia. }
  assert (R0 : forall u, at_ [- y3 * x ^ 3; 3 * y3 * x ^ 2; - 3 * y3 * x; y3] u = 0 <-> u = x / (1 + x)).
  { intros u. unfold at_. simpl. split.
    - intros H. assert (H' : y3 * (u - x * (1 - u)) ^ 3 = 0) by (rewrite <- H; ring).
      apply Rmult_integral in H'. destruct H' as [| H']; [lra |].
      assert (u - x * (1 - u) = 0) by (apply NNPP; intros K; now apply (pow_nonzero _ 3) in K).
      apply Rmult_eq_reg_r with (1 + x); [field_simplify |]; lra.
    - intros ->. field. lra. }
  split; intros S.
  - assert (0 < - y3 * x) by (apply Rmult_lt_0_compat; lra). split; [lra |]. intros u. rewrite R0.
    replace (- 3 * y3 * x / (- (3 * y3) + - 3 * y3 * x)) with (x / (1 + x)); [easy | field; nra].
  - assert (0 < y3) by lra. assert (0 < y3 * x) by (apply Rmult_lt_0_compat; lra). split; [lra |].
    split; [lra |]. intros u. rewrite R0.
    replace (- (- 3 * y3 * x) / (3 * y3 + - (- 3 * y3 * x))) with (x / (1 + x)); [easy | field; nra].
Qed.

(** ** Three distinct real roots: each sign change is a root *)

Lemma opposite_changes y : length y = 4%nat -> let c := inner_sign_changes (map Ropp y) in
  count c = count (inner_sign_changes y) /\ opposite c = opposite (inner_sign_changes y) /\
  first c = opposed (first (inner_sign_changes y)).
Proof.
  intros L. four y L. unfold inner_sign_changes. cbn [map].
  assert (O : forall x, sign_of_real (- x) = opposed (sign_of_real x)).
  { intros x. cases_of_sign x; [apply sign_positive | apply sign_zero | apply sign_negative]; lra. }
  rewrite !O. four_signs y0 y1 y2 y3; cbn; repeat split.
Qed.

(** The value at the extremum t/s is negative if both ends are positive. *)
Lemma dips_between y : length y = 4%nat -> 0 < discriminant y -> first (inner_sign_changes y) = positive ->
  opposite (inner_sign_changes y) = false -> (0 < count (inner_sign_changes y))%nat ->
  exists s t, 0 < s /\ 0 < t /\ form y s t < 0.
Proof.
  intros L. four y L. intros D F O C.
  assert (S : 0 <= y3 /\ 0 <= y0 /\ (y3 = 0 -> 0 < y2 /\ y1 < 0 /\ 0 < y0) /\ (y1 < 0 \/ y2 < 0)).
  { clear D. unfold inner_sign_changes in *. cbn [map] in *. revert F O C.
    four_signs y0 y1 y2 y3; cbn; intros; try discriminate; try lia; lra. }
  clear F O C. destruct S as (Y3 & Y0 & Z & N). unfold discriminant, hessian in D. cbn [c0 c1 c2] in D.
  set (h2 := y2 * y2 - 3 * (y1 * y3)) in *.
  destruct Y3 as [Y3 | <-].
  - set (e := 2 * y2 ^ 3 - 9 * y1 * y2 * y3 + 27 * y0 * y3 ^ 2).
    set (d := 4 * ((y1 * y1 - 3 * (y0 * y2)) * h2) -
      (y1 * y2 - 3 * (3 * (y0 * y3))) * (y1 * y2 - 3 * (3 * (y0 * y3)))) in *.
    assert (E : 4 * h2 ^ 3 = e ^ 2 + 9 * y3 ^ 2 * d) by (unfold e, d, h2; ring).
    assert (0 < y3 ^ 2) by (apply pow_lt; easy).
    assert (0 < y3 ^ 2 * d) by (apply Rmult_lt_0_compat; easy).
    assert (P2 : 0 < h2).
    { apply Rnot_le_lt. intros N2. assert (h2 ^ 3 <= 0) by (pose proof (pow2_ge_0 h2);
        replace (h2 ^ 3) with (h2 * h2 ^ 2) by ring; nra). pose proof (pow2_ge_0 e). lra. }
    set (q := sqrt h2). assert (Q : q * q = h2) by (apply sqrt_sqrt; lra).
      assert (Pq : 0 < q) by (now apply sqrt_lt_R0).
    assert (B : e < 2 * q ^ 3).
    { assert (0 < q ^ 3) by (apply pow_lt; easy).
      assert (e ^ 2 < (2 * q ^ 3) ^ 2).
      { replace ((2 * q ^ 3) ^ 2) with (4 * (q * q) ^ 3) by ring. rewrite Q, E. lra. }
      nra. }
    exists (3 * y3), (- y2 + q). split; [lra |]. split.
    + destruct (Rlt_or_le y2 0); [lra |]. assert (y1 < 0) by lra.
        assert (0 < - y1 * y3) by (apply Rmult_lt_0_compat; lra).
      assert (y2 * y2 < q * q) by (rewrite Q; unfold h2; lra). apply Rnot_le_lt. intros W.
      assert (q * q <= y2 * y2) by (apply Rmult_le_compat; lra). lra.
    + replace (form [y0; y1; y2; y3] (3 * y3) (- y2 + q)) with (y3 * (e - 2 * q ^ 3)
        + 3 * q * y3 * (q * q - h2)).
      * rewrite (Rminus_diag_eq _ _ Q). assert (0 < y3 * (2 * q ^ 3 - e)) by (apply Rmult_lt_0_compat; lra).
          lra.
      * unfold e, h2. simpl. ring.
  - destruct (Z eq_refl) as (P2 & P1 & P0). exists (2 * y2), (- y1). split; [lra |]. split; [lra |].
    replace (form [y0; y1; y2; 0] (2 * y2) (- y1)) with (- (2 * (y2 * y2)) * (y1 * y1 - 4 * (y0 * y2))) by
      (simpl; ring).
    replace (4 * ((y1 * y1 - 3 * (y0 * y2)) * h2) - (y1 * y2 - 3 * (3 * (y0 * 0))) * (y1 * y2 - 3 * (3 * (y0
      * 0))))
      with (3 * (y2 * y2) * (y1 * y1 - 4 * (y0 * y2))) in D by (unfold h2; ring).
    nra.
Qed.

Theorem any_change y : length y = 4%nat -> 0 < discriminant y -> (0 < count (inner_sign_changes y))%nat ->
  exists t, 0 < t < 1 /\ at_ y t = 0.
Proof.
  intros L D C. destruct (opposite (inner_sign_changes y)) eqn:O; [now apply odd_changes |].
  assert (H : forall y, length y = 4%nat -> 0 < discriminant y -> (0 < count (inner_sign_changes y))%nat ->
    opposite (inner_sign_changes y) = false -> first (inner_sign_changes y) = positive ->
    exists t, 0 < t < 1 /\ at_ y t = 0).
  { clear. intros y L D C O F. destruct (dips_between y L D F O C) as (s & t & S & T & N).
    destruct (changes_first y L (changes_moving y L C)) as (B & _). rewrite F in B.
    assert (V : at_ y (t / (s + t)) < 0).
    { four y L. rewrite cubic_at_ratio in N by lra. assert (0 < (s + t) ^ 3) by (apply pow_lt; lra). nra. }
    assert (U : 0 < t / (s + t) < 1).
    { split; [apply Rdiv_lt_0_compat; lra |]. apply Rmult_lt_reg_r with (s + t); [lra |].
      field_simplify; lra. }
    destruct (just_after _ _ _ (t / (s + t)) B ltac:(lra)) as (u & Hu & P). simpl in P.
    destruct (between_signs (at_ y) u (t / (s + t))) as (r & Hr & Z); [apply continuous_form | lra | nra |].
    exists r. split; auto. lra. }
  destruct (changes_first y L (changes_moving y L C)) as (_ & _ & [F | F]); [now apply (H y) |].
  destruct (opposite_changes y L) as (Ec & Eo & Ef). rewrite F in Ef.
  destruct (H (map Ropp y)) as (t & T & Z).
  - now rewrite map_length.
  - four y L. replace (discriminant (map Ropp [y0; y1; y2; y3])) with (discriminant [y0; y1; y2; y3]);
      [easy |].
    unfold discriminant, hessian. cbn [map c0 c1 c2]. ring.
  - now rewrite Ec.
  - now rewrite Eo.
  - easy.
  - exists t. split; auto. unfold at_ in *. rewrite form_opp in Z. lra.
Qed.

(** ** Halves *)

Definition left_half_of (y : list R) : list R := left_half (S := reals) y.
Definition right_half_of (y : list R) : list R := rev (left_half (S := reals) (rev y)).

Lemma halves_of_four y0 y1 y2 y3 :
  left_half_of [y0; y1; y2; y3] =
    [8 * y0; 12 * y0 + 4 * y1; 6 * y0 + 4 * y1 + 2 * y2; y0 + y1 + y2 + y3] /\
  right_half_of [y0; y1; y2; y3] =
    [y0 + y1 + y2 + y3; 6 * y3 + 4 * y2 + 2 * y1; 12 * y3 + 4 * y2; 8 * y3].
Proof. split; unfold left_half_of, right_half_of, left_half; cbn; apply same_four; ring. Qed.

Theorem halves_at y u : length y = 4%nat -> length (left_half_of y) = 4%nat /\ length (right_half_of y) =
  4%nat /\
  at_ (left_half_of y) u = 8 * at_ y (u / 2) /\ at_ (right_half_of y) u = 8 * at_ y ((1 + u) / 2) /\
  discriminant (left_half_of y) = 64 * discriminant y /\ discriminant (right_half_of y) = 64 * discriminant y.
Proof.
  intros L. four y L. destruct (halves_of_four y0 y1 y2 y3) as (-> & ->). repeat split.
  1, 2: unfold at_; simpl; field. all: unfold discriminant, hessian; cbn [c0 c1 c2]; ring.
Qed.

(** Possible signs of a sum of positive multiples of two numbers. *)
Definition signs_between (a b : sign) : list sign :=
  match a, b with
  | zero, s | s, zero => [s]
  | negative, positive | positive, negative => [negative; zero; positive]
  | s, _ => [s]
  end.
Definition positive_sum (a b c : R) : Prop := exists k l, 0 < k /\ 0 < l /\ c = k * a + l * b.
Lemma sign_between a b c : positive_sum a b c ->
  In (sign_of_real c) (signs_between (sign_of_real a) (sign_of_real b)).
Proof.
  intros (k & l & K & L & ->).
  cases_of_sign a; cases_of_sign b; simpl; cases_of_sign (k * a + l * b); auto; exfalso; nra.
Qed.

(** Two subintervals together have no more sign changes than their union, and one less if they meet at a simple root. *)
Definition parts_change_no_more : bool :=
  let all := [negative; zero; positive] in
  forallb (fun a => forallb (fun b => forallb (fun c => forallb (fun d =>
    forallb (fun ab => forallb (fun bc => forallb (fun cd =>
      forallb (fun abc => forallb (fun bcd => forallb (fun m =>
        Nat.leb (count (changes_of [a; ab; abc; m]) + count (changes_of [m; bcd; cd; d]) +
            (if same_sign m zero && negb (same_sign abc zero) then 1 else 0))
          (count (changes_of [a; b; c; d])))
      (signs_between abc bcd)) (signs_between bc cd)) (signs_between ab bc))
    (signs_between c d)) (signs_between b c)) (signs_between a b)) all) all) all) all.
Ltac among C H := apply (fun F => proj1 (forallb_forall _ _) F _ H) in C; cbv beta in C.
Lemma parts_change a b c d ab bc cd abc bcd m : positive_sum a b ab -> positive_sum b c bc -> positive_sum c d cd ->
  positive_sum ab bc abc -> positive_sum bc cd bcd -> positive_sum abc bcd m ->
  (count (inner_sign_changes [a; ab; abc; m]) + count (inner_sign_changes [m; bcd; cd; d]) +
    (if same_sign (sign_of_real m) zero && negb (same_sign (sign_of_real abc) zero) then 1 else 0) <=
   count (inner_sign_changes [a; b; c; d]))%nat.
Proof.
  intros Ab Bc Cd Abc Bcd M. unfold inner_sign_changes. cbn [map].
  assert (All : forall x, In (sign_of_real x) [negative; zero; positive]).
  { intros x. cases_of_sign x; simpl; auto. }
  assert (C : parts_change_no_more = true) by (vm_compute; reflexivity). unfold parts_change_no_more in C.
  among C (All a). among C (All b). among C (All c). among C (All d).
  among C (sign_between _ _ _ Ab). among C (sign_between _ _ _ Bc). among C (sign_between _ _ _ Cd).
  among C (sign_between _ _ _ Abc). among C (sign_between _ _ _ Bcd). among C (sign_between _ _ _ M).
  now apply Nat.leb_le.
Qed.

(** So waiting intervals together have no more sign changes than the whole. *)
Theorem halves_changes y : length y = 4%nat ->
  (count (inner_sign_changes (left_half_of y)) + count (inner_sign_changes (right_half_of y)) <=
   count (inner_sign_changes y))%nat.
Proof.
  intros L. four y L. destruct (halves_of_four y0 y1 y2 y3) as (-> & ->).
  assert (Same : forall a, sign_of_real (8 * a) = sign_of_real a).
  { intros a. rewrite sign_product, (sign_positive 8) by lra. cases_of_sign a; easy. }
  assert (C := parts_change y0 y1 y2 y3 (12 * y0 + 4 * y1) (y1 + y2) (12 * y3 + 4 * y2)
    (6 * y0 + 4 * y1 + 2 * y2) (6 * y3 + 4 * y2 + 2 * y1) (y0 + y1 + y2 + y3)).
  unfold inner_sign_changes in *. cbn [map] in *. rewrite !Same.
  eapply Nat.le_trans; [apply Nat.le_add_r | apply C].
  - exists 12, 4. lra.
  - exists 1, 1. lra.
  - exists 4, 12. lra.
  - exists (/ 2), 2. lra.
  - exists 2, (/ 2). lra.
  - exists (/ 6), (/ 6). lra.
Qed.

(** ** Crossings *)

Definition strict (s : sign) : Prop := s = positive \/ s = negative.

Lemma restricted a b a' b' f Q : crosses_once a b f Q -> a <= a' -> b' <= b -> crosses_once a' b' f Q.
Proof. intros (l0 & l1 & q & H) A B. exists l0, l1, q. intros t T. apply H. lra. Qed.
Lemma linear_sign s l q : 0 < s * (l * q) -> 0 <= q -> 0 < s * l.
Proof. intros P Q. apply Rnot_le_lt. intros N. assert (0 <= - (s * l) * q) by (apply Rmult_le_pos; lra).
  lra. Qed.

(** With the same sign at both ends, there are only other roots. *)
Lemma uncrossed a b f Q s t : crosses_once a b f Q -> sign_after s f a -> sign_before s f b ->
  a < t < b -> f t = 0 -> Q t.
Proof.
  intros (l0 & l1 & q & H) A B T Z. destruct (just_after s f a t A ltac:(lra)) as (u & U & P).
  destruct (just_before s f t b B ltac:(lra)) as (w & W & P').
  destruct (H u ltac:(lra)) as (Eu & Qu & _), (H w ltac:(lra)) as (Ew & Qw & _), (H t T) as (Et & Qt & R).
  rewrite Eu in P. rewrite Ew in P'. apply linear_sign in P, P'; auto. rewrite Et in Z.
  apply Rmult_integral in Z. destruct Z as [Z | Z]; auto. exfalso.
  assert (E : (w - u) * (l0 + l1 * t) = (w - t) * (l0 + l1 * u) + (t - u) * (l0 + l1 * w)) by ring.
  rewrite Z, Rmult_0_r in E.
  assert (0 < (w - t) * (unit_of s * (l0 + l1 * u))) by (apply Rmult_lt_0_compat; lra).
  assert (0 < (t - u) * (unit_of s * (l0 + l1 * w))) by (apply Rmult_lt_0_compat; lra).
  assert (unit_of s * ((w - t) * (l0 + l1 * u) + (t - u) * (l0 + l1 * w)) = 0) by (rewrite <- E; ring). lra.
Qed.

(** With opposite signs at l and h, or just inside the ends, the crossing lies between them. *)
Lemma crossed a b f Q s l h : crosses_once a b f Q -> a <= l -> l < h -> h <= b ->
  (if Req_EM_T l a then sign_after s f a else 0 < unit_of s * f l) ->
  (if Req_EM_T h b then sign_before (opposed s) f b else unit_of s * f h < 0) ->
  exists r, l < r < h /\ f r = 0 /\ forall t, a < t < b -> f t = 0 -> t = r \/ Q t.
Proof.
  intros (l0 & l1 & q & H) Al Lh Hb L R. set (m := (l + h) / 2).
  assert (Left : exists u, l <= u < m /\ a < u /\ 0 < unit_of s * (l0 + l1 * u)).
  { destruct (Req_EM_T l a) as [-> | N].
    - destruct (just_after s f a m L ltac:(unfold m; lra)) as (u & U & P). exists u.
      split; [lra | split; [lra |]]. destruct (H u ltac:(unfold m in *; lra)) as (E & Qu & _). rewrite E in P.
      now apply linear_sign in P.
    - exists l. split; [unfold m; lra | split; [lra |]]. destruct (H l ltac:(lra)) as (E & Qu & _).
        rewrite E in L.
      now apply linear_sign in L. }
  assert (Right : exists u, m < u <= h /\ u < b /\ unit_of s * (l0 + l1 * u) < 0).
  { assert (O : unit_of (opposed s) = - unit_of s) by (destruct s; simpl; ring).
    destruct (Req_EM_T h b) as [-> | N].
    - destruct (just_before (opposed s) f m b R ltac:(unfold m; lra)) as (u & U & P). exists u.
      split; [lra | split; [lra |]]. destruct (H u ltac:(unfold m in *; lra)) as (E & Qu & _).
        rewrite E, O in P.
      apply linear_sign in P; auto. lra.
    - exists h. split; [unfold m; lra | split; [lra |]]. destruct (H h ltac:(lra)) as (E & Qu & _).
        rewrite E in R.
      assert (P : 0 < - unit_of s * ((l0 + l1 * h) * q h)) by lra. apply linear_sign in P; auto. lra. }
  destruct Left as (u & U & Ua & Pu), Right as (w & W & Wb & Pw). clear L R.
  assert (N : unit_of s * l1 < 0).
  { assert (unit_of s * l1 * (w - u) < 0) by lra. apply Rnot_le_lt. intros K.
    assert (0 <= unit_of s * l1 * (w - u)) by (apply Rmult_le_pos; lra). lra. }
  assert (N1 : l1 <> 0) by (intros ->; lra).
  set (r := - l0 / l1). assert (Zr : l0 + l1 * r = 0) by (unfold r; field; auto).
  assert (S : forall t, unit_of s * (l0 + l1 * t) = unit_of s * l1 * (t - r))
    by (intros t; transitivity (unit_of s * (l0 + l1 * t) - unit_of s * (l0 + l1 * r)); [rewrite Zr |]; ring).
  rewrite S in Pu, Pw.
  assert (u < r < w) by nra.
  exists r. split; [lra |]. split; [destruct (H r ltac:(lra)) as (-> & _); rewrite Zr; ring |].
  intros t T Z. destruct (H t T) as (E & _ & Qt). rewrite E in Z. apply Rmult_integral in Z.
  destruct Z as [Z | Z]; auto. left. assert (Z' : l1 * (t - r) = 0) by lra. apply Rmult_integral in Z'. lra.
Qed.

(** Two roots are equal, or are other roots. *)
Lemma only_crossing a b f Q s t u : crosses_once a b f Q -> sign_after s f a ->
  a < t < b -> a < u < b -> f t = 0 -> f u = 0 -> t = u \/ Q t \/ Q u.
Proof.
  intros (l0 & l1 & q & H) A T U Zt Zu.
  destruct (H t T) as (Et & _ & Qt), (H u U) as (Eu & _ & Qu). rewrite Et in Zt. rewrite Eu in Zu.
  apply Rmult_integral in Zt, Zu. destruct Zt as [Zt | Zt]; auto. destruct Zu as [Zu | Zu]; auto. left.
  destruct (Req_dec l1 0) as [-> | N].
  - exfalso. destruct (just_after s f a t A ltac:(lra)) as (w & W & P). destruct (H w ltac:(lra)) as (E & _).
    rewrite E in P. assert (l0 = 0) by lra. subst l0.
      rewrite !Rmult_0_l, Rplus_0_l, Rmult_0_l, Rmult_0_r in P. lra.
  - assert (Z : l1 * (t - u) = 0) by lra. apply Rmult_integral in Z. lra.
Qed.

(** ** Subintervals *)

(** `cubic_part`: a cubic on [index, index + 1]/2^level, times a positive number. *)
Record part := Part { part_y : list R; roots : sign_changes; index : Z; level : Z }.
Definition over (numerator : Z) (bits : Z) : R := IZR numerator / IZR (2 ^ bits).
Definition part_start (p : part) : R := over (index p) (level p).
Definition part_end (p : part) : R := over (index p + 1) (level p).
Definition is_part (y : list R) (p : part) : Prop :=
  length (part_y p) = 4%nat /\ roots p = inner_sign_changes (part_y p) /\
  (0 <= level p /\ 0 <= index p /\ index p + 1 <= 2 ^ level p)%Z /\ ~ Forall (eq 0) (part_y p) /\
  exists c, 0 < c /\ forall u, at_ (part_y p) u = c * at_ y ((IZR (index p) + u) / IZR (2 ^ level p)).

Lemma power_positive n : (0 <= n)%Z -> 0 < IZR (2 ^ n).
Proof. intros N. apply IZR_lt. now apply Z.pow_pos_nonneg. Qed.
Lemma over_less a b n : (0 <= n)%Z -> (a < b)%Z -> over a n < over b n.
Proof.
  intros N L. apply power_positive in N. unfold over. apply Rmult_lt_compat_r; [now apply Rinv_0_lt_compat |].
  now apply IZR_lt.
Qed.
Lemma over_le a b n : (0 <= n)%Z -> (a <= b)%Z -> over a n <= over b n.
Proof.
  intros N L. apply power_positive in N. unfold over.
  apply Rmult_le_compat_r; [left; now apply Rinv_0_lt_compat |]. now apply IZR_le.
Qed.
Lemma over_finer a n m : (0 <= n <= m)%Z -> over (a * 2 ^ (m - n)) m = over a n.
Proof.
  intros N. unfold over. replace m with (n + (m - n))%Z at 2 by lia. rewrite Z.pow_add_r, !mult_IZR by lia.
  pose proof (power_positive n ltac:(lia)). pose proof (power_positive (m - n) ltac:(lia)). field. lra.
Qed.
Lemma part_inside y p : is_part y p -> 0 <= part_start p < part_end p /\ part_end p <= 1.
Proof.
  intros (_ & _ & (L & I & J) & _). unfold part_start, part_end. pose proof (power_positive _ L) as W.
  split; [split; [| apply over_less; lia] |].
  - replace 0 with (over 0 (level p)) by (unfold over; lra). now apply over_le.
  - replace 1 with (over (2 ^ level p) (level p)) by (unfold over; field; lra). now apply over_le.
Qed.

(** The signs just inside its ends. *)
Lemma part_signs y p : is_part y p -> sign_after (first (roots p)) (at_ y) (part_start p) /\
  sign_before (if opposite (roots p) then opposed (first (roots p)) else first (roots p)) (at_ y) (part_end
    p) /\
  strict (first (roots p)).
Proof.
  intros (L & R & (Hl & _) & N & c & C & E). apply power_positive in Hl. rewrite R.
  destruct (changes_first _ L N) as ((d & D & A) & (e & D' & B) & F). set (w := IZR (2 ^ level p)) in *.
  unfold part_start, part_end, over. rewrite plus_IZR. fold w. set (i := IZR (index p)) in *.
  assert (P : forall s t, 0 < unit_of s * at_ (part_y p) (t * w - i) -> 0 < unit_of s * at_ y t).
  { intros s t P. rewrite E in P. replace ((i + (t * w - i)) / w) with t in P by (field; lra).
    apply Rmult_lt_reg_l with c; auto. lra. }
  split; [| split; auto].
  - exists (d / w). split; [now apply Rdiv_lt_0_compat |]. intros t T. apply P, A.
    assert (i / w * w = i) by (field; lra). assert (d / w * w = d) by (field; lra).
    assert (i / w * w < t * w) by (apply Rmult_lt_compat_r; lra).
    assert (t * w < (i / w + d / w) * w) by (apply Rmult_lt_compat_r; lra). lra.
  - exists (e / w). split; [now apply Rdiv_lt_0_compat |]. intros t T. apply P, B.
    assert ((i + 1) / w * w = i + 1) by (field; lra). assert (e / w * w = e) by (field; lra).
    assert (t * w < (i + 1) / w * w) by (apply Rmult_lt_compat_r; lra).
    assert (((i + 1) / w - e / w) * w < t * w) by (apply Rmult_lt_compat_r; lra). lra.
Qed.
Lemma part_place y p t : is_part y p -> part_start p < t < part_end p <->
  0 < t * IZR (2 ^ level p) - IZR (index p) < 1.
Proof.
  intros (_ & _ & (Hl & _) & _). apply power_positive in Hl. unfold part_start, part_end, over.
  rewrite plus_IZR. set (w := IZR (2 ^ level p)) in *. set (i := IZR (index p)).
  assert (A : i / w * w = i) by (field; lra). assert (B : (i + 1) / w * w = i + 1) by (field; lra).
  split; intros (T & U).
  - apply (Rmult_lt_compat_r w) in T, U; lra.
  - split; apply Rmult_lt_reg_r with w; lra.
Qed.
Lemma part_at y p : is_part y p -> exists c, 0 < c /\
  forall t, at_ y t = c * at_ (part_y p) (t * IZR (2 ^ level p) - IZR (index p)).
Proof.
  intros (_ & _ & (Hl & _) & _ & c & C & E). apply power_positive in Hl. exists (/ c).
  split; [now apply Rinv_0_lt_compat |]. intros t. rewrite E.
  replace ((IZR (index p) + (t * IZR (2 ^ level p) - IZR (index p))) / IZR (2 ^ level p)) with t by (field;
    lra).
  field. lra.
Qed.

Lemma whole_is_part y : length y = 4%nat -> ~ Forall (eq 0) y -> is_part y (Part y (inner_sign_changes y) 0
  0).
Proof.
  intros L N. unfold is_part. cbn [part_y roots index level]. repeat split; auto; try lia.
  exists 1. split; [lra |]. intros u. rewrite Rplus_0_l. change (2 ^ 0)%Z with 1%Z.
  replace (u / 1) with u by field. ring.
Qed.
Definition left_of (p : part) : part :=
  Part (left_half_of (part_y p)) (inner_sign_changes (left_half_of (part_y p))) (2 * index p) (level p + 1).
Definition right_of (p : part) : part :=
  Part (right_half_of (part_y p)) (inner_sign_changes (right_half_of (part_y p))) (2 * index p + 1) (level p
    + 1).

Lemma halves_are_parts y p : is_part y p -> is_part y (left_of p) /\ is_part y (right_of p) /\
  part_start (left_of p) = part_start p /\ part_end (right_of p) = part_end p /\
  part_end (left_of p) = over (2 * index p + 1) (level p + 1) /\
  part_start (right_of p) = over (2 * index p + 1) (level p + 1).
Proof.
  intros (L & R & (Hl & Hi & Hj) & N & c & C & E).
  assert (P : (2 ^ (level p + 1) = 2 * 2 ^ level p)%Z) by (rewrite Z.pow_add_r; lia).
  destruct (halves_at (part_y p) 0 L) as (L0 & L1 & _).
  assert (M : ~ Forall (eq 0) (left_half_of (part_y p)) /\ ~ Forall (eq 0) (right_half_of (part_y p))).
  { clear - L N. destruct (part_y p) as [| y0 [| y1 [| y2 [| y3 [|]]]]]; try discriminate.
    destruct (halves_of_four y0 y1 y2 y3) as (-> & ->).
    split; intros F; apply N; repeat match goal with H : Forall _ (_ :: _) |- _ => inversion_clear H end;
      repeat constructor; lra. }
  pose proof (power_positive _ Hl) as W.
  unfold left_of, right_of, is_part, part_start, part_end. cbn [part_y roots index level].
  split; [| split; [| split; [| split; [| split]]]]; auto.
  - repeat split; auto; try lia; try apply M. exists (8 * c). split; [lra |]. intros u.
    rewrite (proj1 (proj2 (proj2 (halves_at _ u L)))), E, P, !mult_IZR.
    replace ((2 * IZR (index p) + u) / (2 * IZR (2 ^ level p))) with ((IZR (index p) + u / 2) / IZR (2 ^
      level p))
      by (field; lra). ring.
  - repeat split; auto; try lia; try apply M. exists (8 * c). split; [lra |]. intros u.
    rewrite (proj1 (proj2 (proj2 (proj2 (halves_at _ u L))))), E, P, plus_IZR, !mult_IZR.
    replace ((2 * IZR (index p) + 1 + u) / (2 * IZR (2 ^ level p)))
      with ((IZR (index p) + (1 + u) / 2) / IZR (2 ^ level p)) by (field; lra). ring.
  - unfold over. rewrite P, !mult_IZR. field. lra.
  - unfold over. rewrite P, !plus_IZR, !mult_IZR. field. lra.
Qed.

(** A subinterval with one sign change has one root and no other. *)
Lemma one_change_part y p Q : is_part y p -> count (roots p) = 1%nat ->
  crosses_once (part_start p) (part_end p) (at_ y) Q.
Proof.
  intros H C. pose proof H as (L & R & _). rewrite R in C.
  destruct (one_change_crosses _ L C) as (l0 & l1 & q & One). destruct (part_at y p H) as (c & Hc & E).
  set (w := IZR (2 ^ level p)) in *. set (i := IZR (index p)) in *.
  exists (c * (l0 - l1 * i)), (c * (l1 * w)), (fun t => q (t * w - i)). intros t T.
  apply (part_place y p t H) in T. fold w i in T. destruct (One _ T) as (V & P & N).
  split; [rewrite E, V; ring |]. split; auto. intros Z. destruct (N Z).
Qed.

(** ** Brackets *)

(** bracket_near, for any estimate of the position. *)
Definition sign_at (y : list R) (numerator bits : Z) : sign :=
  sign_of_real (form y (IZR (2 ^ bits - numerator)) (IZR numerator)).
Definition bracket_within (y : list R) (p : part) (place bits radius : Z) : option (Z * Z) :=
  let begin := (index p * 2 ^ (bits - level p))%Z in
  let finish := ((index p + 1) * 2 ^ (bits - level p))%Z in
  let middle := Z.min (Z.max place begin) finish in
  let low := Z.max (middle - 2 ^ radius) begin in
  let high := Z.min (middle + 2 ^ radius) finish in
  let at_low := if (low =? begin)%Z then first (roots p) else sign_at y low bits in
  let at_high := if (high =? finish)%Z then opposed (first (roots p)) else sign_at y high bits in
  if same_sign at_low zero then Some (low, low)
  else if same_sign at_high zero then Some (high, high)
  else if negb (same_sign at_low (first (roots p))) || same_sign at_high (first (roots p)) then None
  else Some (low, high).
Fixpoint bracket_among (y : list R) (p : part) (place bits : Z) (radii : list Z) : option (Z * Z) :=
  match radii with
  | [] => None
  | radius :: wider =>
      match bracket_within y p place bits radius with
      | None => bracket_among y p place bits wider
      | found => found
      end
  end.
Definition bracket_near (y : list R) (p : part) (place bits : Z) : option (Z * Z) :=
  bracket_among y p place bits [4; 14; 24]%Z.

Lemma sign_at_right y n bits : length y = 4%nat -> (0 <= bits)%Z ->
  sign_at y n bits = sign_of_real (at_ y (over n bits)).
Proof.
  intros L B. apply power_positive in B. unfold sign_at. four y L.
  replace (form [y0; y1; y2; y3] (IZR (2 ^ bits - n)) (IZR n))
    with (IZR (2 ^ bits) ^ 3 * at_ [y0; y1; y2; y3] (over n bits)).
  - rewrite sign_product, (sign_positive (IZR (2 ^ bits) ^ 3)) by now apply pow_lt.
    destruct (sign_of_real _); easy.
  - unfold at_, over. rewrite minus_IZR. simpl. field. lra.
Qed.

(** A bracket is the root itself, or contains the subinterval's crossing strictly inside. *)
Definition brackets (y : list R) (p : part) (Q : R -> Prop) (low high bits : Z) : Prop :=
  (0 <= low <= high /\ high <= 2 ^ bits /\ high - low <= 2 ^ 25)%Z /\
  part_start p <= over low bits /\ over high bits <= part_end p /\
  ((low = high /\ part_start p < over low bits < part_end p /\ at_ y (over low bits) = 0) \/
   ((low < high)%Z /\ exists r, over low bits < r < over high bits /\ at_ y r = 0 /\
      forall t, part_start p < t < part_end p -> at_ y t = 0 -> t = r \/ Q t)).

Lemma bracket_within_right y p Q place bits radius low high : length y = 4%nat -> is_part y p ->
  (level p <= bits)%Z -> (0 <= radius <= 24)%Z -> opposite (roots p) = true ->
  crosses_once (part_start p) (part_end p) (at_ y) Q ->
  bracket_within y p place bits radius = Some (low, high) -> brackets y p Q low high bits.
Proof.
  intros L H B Hr O One. destruct (part_signs y p H) as (A & Z & F). rewrite O in Z.
  pose proof H as (_ & _ & (Hl & Hi & Hj) & _).
  unfold bracket_within. set (begin := (index p * 2 ^ (bits - level p))%Z).
  set (finish := ((index p + 1) * 2 ^ (bits - level p))%Z). set (middle := Z.min (Z.max place begin) finish).
  cbv zeta. set (lo := Z.max (middle - 2 ^ radius) begin). set (hi := Z.min (middle + 2 ^ radius) finish).
  assert (Es : over begin bits = part_start p) by (apply over_finer; lia).
  assert (Ef : over finish bits = part_end p) by (apply over_finer; lia).
  assert (W : (0 < 2 ^ (bits - level p))%Z) by (apply Z.pow_pos_nonneg; lia).
  assert (R : (1 <= 2 ^ radius <= 2 ^ 24)%Z).
  { split; [change 1%Z with (2 ^ 0)%Z |]; apply Z.pow_le_mono_r; lia. }
  assert (T : (2 ^ bits = 2 ^ level p * 2 ^ (bits - level p))%Z) by (rewrite <- Z.pow_add_r by lia; f_equal;
    lia).
  assert (Bounds : (0 <= begin <= lo /\ lo < hi /\ hi <= finish /\ finish <= 2 ^ bits /\ hi - lo <= 2 ^
    25)%Z).
  { change (2 ^ 25)%Z with (2 ^ 24 + 2 ^ 24)%Z. unfold lo, hi, middle. unfold begin, finish in *. rewrite T.
    nia. }
  destruct Bounds as (B0 & B1 & B2 & B3 & B4).
  assert (Pl : part_start p <= over lo bits) by (rewrite <- Es; apply over_le; lia).
  assert (Ph : over hi bits <= part_end p) by (rewrite <- Ef; apply over_le; lia).
  assert (Nl : first (roots p) <> zero /\ opposed (first (roots p)) <> zero)
    by (destruct F as [-> | ->]; split; discriminate).
  (* a position with a zero sign is inside *)
  assert (Inner : forall n, (begin < n < finish)%Z -> sign_at y n bits = zero ->
    part_start p < over n bits < part_end p /\ at_ y (over n bits) = 0).
  { intros n N S. split; [rewrite <- Es, <- Ef; split; apply over_less; lia |].
    rewrite sign_at_right in S by (auto; lia). pose proof (sign_of_real_right (at_ y (over n bits))) as V.
    now rewrite S in V. }
  destruct (same_sign (if (lo =? begin)%Z then first (roots p) else sign_at y lo bits) zero) eqn:S0.
  { intros E. injection E as <- <-. destruct (Z.eqb_spec lo begin) as [K | K].
    - exfalso. destruct F as [F | F]; rewrite F in S0; discriminate.
    - destruct (sign_at y lo bits) eqn:S; try discriminate. destruct (Inner lo ltac:(lia) S) as (P & V).
      split; [lia |]. split; [lra |]. split; [lra |]. left. auto. }
  destruct (same_sign (if (hi =? finish)%Z then opposed (first (roots p)) else sign_at y hi bits) zero)
    eqn:S1.
  { intros E. injection E as <- <-. destruct (Z.eqb_spec hi finish) as [K | K].
    - exfalso. destruct F as [F | F]; rewrite F in S1; discriminate.
    - destruct (sign_at y hi bits) eqn:S; try discriminate. destruct (Inner hi ltac:(lia) S) as (P & V).
      split; [lia |]. split; [lra |]. split; [lra |]. left. auto. }
  destruct (negb _ || same_sign _ (first (roots p))) eqn:S2; [discriminate |]. apply orb_false_iff in S2.
  destruct S2 as (S2 & S3). intros E. injection E as <- <-. split; [lia |]. split; auto. split; auto. right.
  split; [lia |]. apply (crossed (part_start p) (part_end p) (at_ y) Q (first (roots p))); auto.
  - apply over_less; lia.
  - destruct (Req_EM_T (over lo bits) (part_start p)) as [K | K]; auto.
    destruct (Z.eqb_spec lo begin) as [-> | N]; [now rewrite Es in K |].
    rewrite sign_at_right in * by (auto; lia). pose proof (sign_of_real_right (at_ y (over lo bits))) as V.
    destruct F as [F | F]; rewrite F in *; destruct (sign_of_real (at_ y (over lo bits))); try discriminate;
      simpl in *; lra.
  - destruct (Req_EM_T (over hi bits) (part_end p)) as [K | K]; auto.
    destruct (Z.eqb_spec hi finish) as [-> | N]; [now rewrite Ef in K |].
    rewrite sign_at_right in * by (auto; lia). pose proof (sign_of_real_right (at_ y (over hi bits))) as V.
    pose proof (never_uncertain (at_ y (over hi bits))).
    destruct F as [F | F]; rewrite F in *; destruct (sign_of_real (at_ y (over hi bits))); try discriminate;
      simpl in *; try easy; lra.
Qed.

Theorem bracket_near_right y p Q place bits low high : length y = 4%nat -> is_part y p ->
  (level p <= bits)%Z -> opposite (roots p) = true -> crosses_once (part_start p) (part_end p) (at_ y) Q ->
  bracket_near y p place bits = Some (low, high) -> brackets y p Q low high bits.
Proof.
  intros L H B O One. unfold bracket_near.
  assert (R : Forall (fun r => 0 <= r <= 24)%Z [4; 14; 24]%Z) by (repeat constructor; lia).
  induction R as [| r l R F IH]; [discriminate |]. cbn [bracket_among].
  destruct (bracket_within y p place bits r) as [[l0 h0] |] eqn:E; auto. intros K. injection K as <- <-.
  now apply bracket_within_right with (place := place) (radius := r).
Qed.
