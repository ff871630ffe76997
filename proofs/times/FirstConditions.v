(** Candidates of ccd/contact/condition.cpp for the first time at which one of several conditions holds, over the
    real numbers. Continuous functions of t stand for polynomials. Results:
        candidate_holds        a condition holds at each of its candidates
        first_is_candidate     the first time, if not 0, is a candidate of some condition
        vertices_candidate, vertex_edge_candidate, face_planar_candidate, edges_planar_candidate   for contact
        vertices_near_candidate, vertex_edge_near_candidate, face_near_candidate, edges_near_candidate   for a
                               distance *)

From Coq Require Import Reals Lra Psatz List.
From Errbound Require Import Contact Distance Separation FirstContact.
Import ListNotations.
Open Scope R_scope.

(** ** Conditions: ccd/contact/condition.hpp *)

Record condition_in_time := ConditionInTime { vanishing : list (R -> R); nonnegative : list (R -> R);
  not_all_zero : list (R -> R); also_below : bool }.
Definition sides_hold (c : condition_in_time) (t : R) : Prop :=
  (forall p, In p (nonnegative c) -> 0 <= p t) /\
  (not_all_zero c = [] \/ exists p, In p (not_all_zero c) /\ p t <> 0).
Definition is_met (c : condition_in_time) (t : R) : Prop :=
  (forall p, In p (vanishing c) -> p t = 0 \/ (also_below c = true /\ p t < 0)) /\ sides_hold c t.
Definition vanish_at (c : condition_in_time) (t : R) : Prop := forall p, In p (vanishing c) -> p t = 0.

Definition identically_0 (p : R -> R) : Prop := forall t, p t = 0.
(** A root of the result of `candidates` (for several vanishing polynomials, of their common factor) at which the
    sides hold. *)
Definition candidate (c : condition_in_time) (t : R) : Prop :=
  vanishing c <> [] /\ sides_hold c t /\ vanish_at c t /\
  ((exists p, In p (vanishing c) /\ ~ identically_0 p) \/
   exists p, In p (nonnegative c) /\ ~ identically_0 p /\ p t = 0).

Theorem candidate_holds c t : candidate c t -> is_met c t.
Proof. intros (_ & S & V & _). split; auto. Qed.

Lemma near_positive p t : continuity p -> p t <> 0 -> exists e, 0 < e /\ forall s, Rabs (s - t) < e -> 0 < p s * p t.
Proof.
  intros C N. destruct (C t (Rabs (p t)) (Rabs_pos_lt _ N)) as (e & E & H). exists e. split; auto.
  intros s S. assert (D : Rabs (p s - p t) < Rabs (p t)).
  { destruct (Req_dec s t) as [-> | Ne]; [rewrite Rminus_diag_eq, Rabs_R0 by easy; now apply Rabs_pos_lt |].
    apply H. split; [split; [exact I | congruence] | exact S]. }
  destruct (Rlt_or_le (p t) 0) as [L | L].
  - rewrite (Rabs_left (p t)) in D by easy. apply Rabs_def2 in D. nra.
  - rewrite (Rabs_pos_eq (p t)) in D by easy. apply Rabs_def2 in D. nra.
Qed.
Lemma all_near (ps : list (R -> R)) t : (forall p, In p ps -> continuity p) ->
  exists e, 0 < e /\ forall p s, In p ps -> p t <> 0 -> Rabs (s - t) < e -> 0 < p s * p t.
Proof.
  induction ps as [| p ps IH]; intros C; [exists 1; split; [lra | easy] |].
  destruct IH as (e & E & H); [intros q Q; apply C; now right |].
  destruct (Req_dec (p t) 0) as [Z | N].
  { exists e. split; auto. intros q s [<- | Q] Nq; [easy | now apply H]. }
  destruct (near_positive p t (C p (or_introl eq_refl)) N) as (d & D & G).
  exists (Rmin d e). split; [now apply Rmin_glb_lt |]. pose proof (Rmin_l d e). pose proof (Rmin_r d e).
  intros q s [<- | Q] Nq S; [apply G; lra | apply H; auto; lra].
Qed.

(** If the first time at which one of the conditions holds is not 0, it is a candidate. Hypotheses: if a condition
    without `vanishing` holds then, another one does; if one holds that is `also_below`, its polynomial is zero, not
    negative. *)
Theorem first_is_candidate (cs : list condition_in_time) t :
  (forall c p, In c cs -> In p (vanishing c) \/ In p (nonnegative c) \/ In p (not_all_zero c) -> continuity p) ->
  first (fun s => exists c, In c cs /\ is_met c s) t -> t <> 0 ->
  (forall c, In c cs -> is_met c t -> vanishing c = [] ->
    exists c', In c' cs /\ is_met c' t /\ vanishing c' <> []) ->
  (forall c, In c cs -> is_met c t -> vanish_at c t) ->
  exists c, In c cs /\ candidate c t.
Proof.
  intros Continuous (T & (c0 & I0 & M0) & Before) T0 Covered Zero.
  assert (exists c, In c cs /\ is_met c t /\ vanishing c <> []) as (c & I & M & V).
  { destruct (vanishing c0) eqn:E; [now apply Covered with c0 |]. exists c0. split; auto. split; auto. congruence. }
  exists c. split; auto. pose proof (Zero c I M) as Z. destruct M as (_ & S). split; auto. split; auto. split; auto.
  destruct (Classical_Prop.classic (exists p, In p (vanishing c) /\ ~ identically_0 p)) as [| NV]; [now left | right].
  apply Classical_Prop.NNPP. intros NN.
  assert (AllZero : forall p, In p (vanishing c) -> identically_0 p).
  { intros p P. apply Classical_Prop.NNPP. intros Q. apply NV. eauto. }
  destruct (all_near (nonnegative c) t) as (d & D & Dp); [intros p P; apply (Continuous c); auto |].
  destruct (all_near (not_all_zero c) t) as (e & E & Ep); [intros p P; apply (Continuous c); auto |].
  set (s := Rmax 0 (t - Rmin d e / 2)). pose proof (Rmin_l d e). pose proof (Rmin_r d e).
  assert (0 < Rmin d e) by now apply Rmin_glb_lt.
  assert (Hs : 0 <= s < t /\ t - Rmin d e < s).
  { unfold s. pose proof (Rmax_l 0 (t - Rmin d e / 2)). pose proof (Rmax_r 0 (t - Rmin d e / 2)).
    assert (Rmax 0 (t - Rmin d e / 2) < t) by (apply Rmax_lub_lt; lra). lra. }
  apply (Before s (proj1 Hs)). exists c. split; auto. split.
  { intros p P. left. now apply AllZero. }
  destruct S as (N & A). split.
  - intros p P. destruct (Classical_Prop.classic (identically_0 p)) as [Zp | Zp]; [rewrite (Zp s); lra |].
    specialize (N p P). assert (p t <> 0) by (intros Q; apply NN; exists p; auto).
    assert (0 < p s * p t) by (apply Dp; auto; rewrite Rabs_left; lra). nra.
  - destruct A as [A | (p & P & Np)]; [now left | right]. exists p. split; auto. intros Q.
    assert (G : 0 < p s * p t) by (apply Ep; auto; rewrite Rabs_left; lra). rewrite Q in G. lra.
Qed.

(** ** Contact: contact_condition of ccd/contact/feature_conditions.hpp *)

Definition components (v : R -> point) : list (R -> R) := [fun t => x (v t); fun t => y (v t); fun t => z (v t)].
Lemma components_0 v t : (forall p, In p (components v) -> p t = 0) <-> v t = origin.
Proof.
  unfold components, origin. split.
  - intros H. apply same_point; cbn [x y z]; [apply (H (fun t => x (v t))) | apply (H (fun t => y (v t))) |
      apply (H (fun t => z (v t)))]; simpl; auto.
  - intros E p [<- | [<- | [<- | []]]]; now rewrite E.
Qed.
Lemma components_not_0 v t : (components v = [] \/ exists p, In p (components v) /\ p t <> 0) <-> v t <> origin.
Proof.
  split.
  - intros [H | (p & P & N)] E; [discriminate |]. apply N. now apply (proj2 (components_0 v t)).
  - intros N. right. apply Classical_Prop.NNPP. intros H. apply N, components_0. intros p P.
    apply Classical_Prop.NNPP. intros Q. apply H. eauto.
Qed.
Lemma components_continuous v p : smooth v -> In p (components v) -> continuity p.
Proof. intros (S0 & S1 & S2) [<- | [<- | [<- | []]]]; auto. Qed.

(** A moving point's difference from another. *)
Definition from (p q : moving) (t : R) : point := minus (place p t) (place q t).
Definition vertices_in_time (v w : moving) : condition_in_time := ConditionInTime (components (from v w)) [] [] false.
Definition vertex_edge_in_time (v e0 e1 : moving) : condition_in_time := ConditionInTime
  (components (fun t => cross (from v e0 t) (from e1 e0 t))) [fun t => dot (from v e0 t) (from e1 v t)] [] false.
Definition face_weights (v f0 f1 f2 : moving) : list (R -> R) :=
  [fun t => weight_2 (from f1 f0 t) (from f2 f0 t) (from v f0 t);
   fun t => weight_1 (from f1 f0 t) (from f2 f0 t) (from v f0 t);
   fun t => weight_0 (from f1 f0 t) (from f2 f0 t) (from v f0 t)].
Definition edges_weights (a0 a1 b0 b1 : moving) : list (R -> R) :=
  [fun t => on_a (from a1 a0 t) (from b1 b0 t) (from b0 a0 t);
   fun t => square_normal (from a1 a0 t) (from b1 b0 t) - on_a (from a1 a0 t) (from b1 b0 t) (from b0 a0 t);
   fun t => on_b (from a1 a0 t) (from b1 b0 t) (from b0 a0 t);
   fun t => square_normal (from a1 a0 t) (from b1 b0 t) - on_b (from a1 a0 t) (from b1 b0 t) (from b0 a0 t)].
Definition face_normal (f0 f1 f2 : moving) (t : R) : point := cross (from f1 f0 t) (from f2 f0 t).
Definition edges_normal (a0 a1 b0 b1 : moving) (t : R) : point := cross (from a1 a0 t) (from b1 b0 t).

Lemma smooth_from p q : smooth (from p q).
Proof. apply smooth_difference. Qed.
Ltac from_continuous := unfold on_a, on_b, square_normal, weight_0, weight_1, weight_2;
  repeat (apply cont_dot || apply smooth_cross || apply smooth_from || apply cont_minus || apply cont_mult ||
    apply cont_const).
Lemma face_weights_continuous v f0 f1 f2 p : In p (face_weights v f0 f1 f2) -> continuity p.
Proof. intros [<- | [<- | [<- | []]]]; from_continuous. Qed.
Lemma edges_weights_continuous a0 a1 b0 b1 p : In p (edges_weights a0 a1 b0 b1) -> continuity p.
Proof. intros [<- | [<- | [<- | [<- | []]]]]; from_continuous. Qed.

Lemma vertices_met v w t : is_met (vertices_in_time v w) t <-> place v t = place w t.
Proof.
  unfold is_met, sides_hold. cbn [vanishing nonnegative not_all_zero also_below vertices_in_time]. split.
  - intros (V & _). assert (E : from v w t = origin).
    { apply components_0. intros p P. destruct (V p P) as [|(H & _)]; [easy | discriminate]. }
    apply near_0. unfold near. fold (from v w t). rewrite E. right. coordinates. ring.
  - intros E. split; [| split; [easy | now left]]. intros p P. left. revert p P. apply components_0.
    unfold from. rewrite E. coordinates. apply same_point; simpl; ring.
Qed.
Lemma vertex_edge_met v e0 e1 t : is_met (vertex_edge_in_time v e0 e1) t <-> vertex_on_edge v e0 e1 t.
Proof.
  unfold is_met, sides_hold, vertex_on_edge. rewrite vertex_edge_contact. unfold vertex_edge_test.
  cbn [vanishing nonnegative not_all_zero also_below vertex_edge_in_time].
  assert (D : dot (from v e0 t) (from e1 v t) = - dot (minus (place v t) (place e0 t)) (minus (place v t) (place e1 t)))
    by (unfold from; coordinates; ring).
  split.
  - intros (V & N & _). split.
    + apply (proj1 (components_0 (fun t => cross (from v e0 t) (from e1 e0 t)) t)).
      intros p P. destruct (V p P) as [|(H & _)]; [easy | discriminate].
    + specialize (N _ (or_introl eq_refl)). cbv beta in N. lra.
  - intros (E & N). split; [| split; [| now left]].
    + intros p P. left. revert p P. now apply (proj2 (components_0 (fun t => cross (from v e0 t) (from e1 e0 t)) t)).
    + intros p [<- | []]. lra.
Qed.
Lemma vertex_edge_in_time_continuous v e0 e1 p :
  In p (vanishing (vertex_edge_in_time v e0 e1)) \/ In p (nonnegative (vertex_edge_in_time v e0 e1)) \/
  In p (not_all_zero (vertex_edge_in_time v e0 e1)) -> continuity p.
Proof.
  intros [H | [[<- | []] | []]].
  - apply components_continuous in H; auto. from_continuous.
  - from_continuous.
Qed.

Lemma same_first_time (H G : R -> Prop) t : (forall s, 0 <= s <= 1 -> (H s <-> G s)) -> first H t -> first G t.
Proof.
  intros E (T & Ht & Before). split; auto. split; [now apply E |]. intros s S Gs. apply (Before s S), E; auto. lra.
Qed.
Lemma not_below c t : also_below c = false -> is_met c t -> vanish_at c t.
Proof. intros B (V & _) p P. destruct (V p P) as [| (H & _)]; auto. congruence. Qed.

Theorem vertices_candidate v w t : first (fun s => place v s = place w s) t -> t <> 0 ->
  candidate (vertices_in_time v w) t.
Proof.
  intros F N. destruct (first_is_candidate [vertices_in_time v w] t) as (c & [<- | []] & C); auto.
  - intros c p [<- | []] [H | [[] | []]]. apply components_continuous in H; auto. apply smooth_from.
  - revert F. apply same_first_time. intros s _. rewrite <- vertices_met. simpl.
    split; [intros H; eauto | intros (c & [<- | []] & H); exact H].
  - intros c [<- | []] _ E. discriminate.
  - intros c [<- | []]. now apply not_below.
Qed.
Theorem vertex_edge_candidate v e0 e1 t : first (vertex_on_edge v e0 e1) t -> t <> 0 ->
  candidate (vertex_edge_in_time v e0 e1) t.
Proof.
  intros F N. destruct (first_is_candidate [vertex_edge_in_time v e0 e1] t) as (c & [<- | []] & C); auto.
  - intros c p [<- | []]. apply vertex_edge_in_time_continuous.
  - revert F. apply same_first_time. intros s _. rewrite <- vertex_edge_met. simpl.
    split; [intros H; eauto | intros (c & [<- | []] & H); exact H].
  - intros c [<- | []] _ E. discriminate.
  - intros c [<- | []]. now apply not_below.
Qed.

(** contact_conditions, if Y = 0 throughout. *)
Definition face_border_in_time (v f0 f1 f2 : moving) : list condition_in_time :=
  [vertex_edge_in_time v f0 f1; vertex_edge_in_time v f1 f2; vertex_edge_in_time v f2 f0].
Definition edges_border_in_time (a0 a1 b0 b1 : moving) : list condition_in_time :=
  [vertex_edge_in_time a0 b0 b1; vertex_edge_in_time a1 b0 b1; vertex_edge_in_time b0 a0 a1; vertex_edge_in_time b1 a0 a1].
Definition query_border_in_time (edges : bool) : moving -> moving -> moving -> moving -> list condition_in_time :=
  if edges then edges_border_in_time else face_border_in_time.
Lemma query_border_in_time_of edges m0 m1 m2 m3 c : In c (query_border_in_time edges m0 m1 m2 m3) ->
  exists v e0 e1, c = vertex_edge_in_time v e0 e1.
Proof. destruct edges; intros I; repeat (destruct I as [<- | I]; [eauto |]); destruct I. Qed.
Lemma query_border_met edges m0 m1 m2 m3 t :
  (exists c, In c (query_border_in_time edges m0 m1 m2 m3) /\ is_met c t) <-> query_on_border edges m0 m1 m2 m3 t.
Proof.
  unfold query_on_border, on_edges_border, on_face_border. destruct edges; rewrite <- !vertex_edge_met;
    (split; [intros (c & I & H); repeat (destruct I as [<- | I]; [auto |]); destruct I |]);
    intros H; repeat (destruct H as [H | H]; [eexists; (split; [| exact H]); simpl; auto |]);
    eexists; (split; [| exact H]); simpl; auto 6.
Qed.
Lemma query_planar_candidate edges m0 m1 m2 m3 t : (forall s, 0 <= s <= 1 -> query_y edges m0 m1 m2 m3 s = 0) ->
  first (query_touches edges m0 m1 m2 m3) t -> t <> 0 ->
  exists c, In c (query_border_in_time edges m0 m1 m2 m3) /\ candidate c t.
Proof.
  intros Y F N. assert (B : query_on_border edges m0 m1 m2 m3 t)
    by (destruct (query_planar_first edges m0 m1 m2 m3 t Y F); easy).
  pose proof (query_border_in_time_of edges m0 m1 m2 m3) as Of. apply first_is_candidate; auto.
  - intros c p I. destruct (Of c I) as (v & e0 & e1 & ->). apply vertex_edge_in_time_continuous.
  - destruct F as (T & _ & Before). split; auto. split; [now apply query_border_met |].
    intros s S Q. apply query_border_met in Q. apply (Before s S), query_times. now right.
  - intros c I _ E. destruct (Of c I) as (v & e0 & e1 & ->). discriminate.
  - intros c I. destruct (Of c I) as (v & e0 & e1 & ->). now apply not_below.
Qed.
Theorem face_planar_candidate v f0 f1 f2 t : (forall s, 0 <= s <= 1 -> face_y v f0 f1 f2 s = 0) ->
  first (face_touches v f0 f1 f2) t -> t <> 0 -> exists c, In c (face_border_in_time v f0 f1 f2) /\ candidate c t.
Proof. exact (query_planar_candidate false v f0 f1 f2 t). Qed.
Theorem edges_planar_candidate a0 a1 b0 b1 t : (forall s, 0 <= s <= 1 -> edges_y a0 a1 b0 b1 s = 0) ->
  first (edges_touch a0 a1 b0 b1) t -> t <> 0 -> exists c, In c (edges_border_in_time a0 a1 b0 b1) /\ candidate c t.
Proof. exact (query_planar_candidate true a0 a1 b0 b1 t). Qed.

(** ** Distance: distance_condition of ccd/contact/feature_conditions.hpp *)

Definition corner_in_time (D : R) (v w : moving) : condition_in_time :=
  ConditionInTime [fun t => dot (from v w t) (from v w t) - D * 1] [] [] true.
Definition edge_in_time (D : R) (v e0 e1 : moving) : condition_in_time := ConditionInTime
  [fun t => dot (cross (from e1 e0 t) (from v e0 t)) (cross (from e1 e0 t) (from v e0 t))
     - D * dot (from e1 e0 t) (from e1 e0 t)]
  [fun t => dot (from v e0 t) (from e1 e0 t); fun t => dot (from e1 v t) (from e1 e0 t)]
  (components (from e1 e0)) true.
Definition face_near_in_time (D : R) (v f0 f1 f2 : moving) : condition_in_time := ConditionInTime
  [fun t => face_y v f0 f1 f2 t * face_y v f0 f1 f2 t - D * square_normal (from f1 f0 t) (from f2 f0 t)]
  (face_weights v f0 f1 f2) (components (face_normal f0 f1 f2)) true.
Definition edges_near_in_time (D : R) (a0 a1 b0 b1 : moving) : condition_in_time := ConditionInTime
  [fun t => edges_y a0 a1 b0 b1 t * edges_y a0 a1 b0 b1 t - D * square_normal (from a1 a0 t) (from b1 b0 t)]
  (edges_weights a0 a1 b0 b1) (components (edges_normal a0 a1 b0 b1)) true.
Definition vertex_edge_near_in_time (D : R) (v e0 e1 : moving) : list condition_in_time :=
  [corner_in_time D v e0; corner_in_time D v e1; edge_in_time D v e0 e1].
Definition all_face_near_in_time (D : R) (v f0 f1 f2 : moving) : list condition_in_time :=
  [corner_in_time D v f0; corner_in_time D v f1; corner_in_time D v f2;
   edge_in_time D v f0 f1; edge_in_time D v f1 f2; edge_in_time D v f2 f0; face_near_in_time D v f0 f1 f2].
Definition all_edges_near_in_time (D : R) (a0 a1 b0 b1 : moving) : list condition_in_time :=
  [corner_in_time D a0 b0; corner_in_time D a0 b1; corner_in_time D a1 b0; corner_in_time D a1 b1;
   edge_in_time D a0 b0 b1; edge_in_time D a1 b0 b1; edge_in_time D b0 a0 a1; edge_in_time D b1 a0 a1;
   edges_near_in_time D a0 a1 b0 b1].

(** The condition at time t is that of Distance.v. *)
Definition same_at (D t : R) (c : condition_in_time) (k : condition) : Prop :=
  (sides_hold c t <-> sides k) /\ also_below c = true /\ exists z, vanishing c = [z] /\ z t = excess D k.
Lemma same_at_met D t c k : same_at D t c k -> (is_met c t <-> holds D k).
Proof.
  intros (S & B & z & V & E). unfold is_met, holds. rewrite S, V, B, <- E. split; intros (P & Q).
  - split; auto. destruct (P z (or_introl eq_refl)) as [| (_ & L)]; lra.
  - split; auto. intros p [<- | []]. destruct (Req_dec (z t) 0); [now left | right]. split; auto. lra.
Qed.
Lemma same_at_corner D v w t : same_at D t (corner_in_time D v w) (corner_condition (place v t) (place w t)).
Proof.
  split; [| split; [easy | eexists; split; reflexivity]]. unfold sides_hold. cbn. split; [easy |].
  intros _. split; [easy | now left].
Qed.
Ltac asks_sides := split; [| split; [easy | eexists; split; reflexivity]]; unfold sides_hold;
  cbn [nonnegative not_all_zero edge_in_time face_near_in_time edges_near_in_time
    sides edge_condition face_condition edges_condition];
  unfold face_weights, edges_weights; rewrite <- Forall_forall, !Forall_cons_iff, components_not_0;
  unfold face_normal, edges_normal, from; intuition.
Lemma same_at_edge D v e0 e1 t :
  same_at D t (edge_in_time D v e0 e1) (edge_condition (place v t) (place e0 t) (place e1 t)).
Proof. asks_sides. Qed.
Lemma same_at_face D v f0 f1 f2 t : same_at D t (face_near_in_time D v f0 f1 f2)
  (face_condition (place v t) (place f0 t) (place f1 t) (place f2 t)).
Proof. asks_sides. Qed.
Lemma same_at_edges D a0 a1 b0 b1 t : same_at D t (edges_near_in_time D a0 a1 b0 b1)
  (edges_condition (place a0 t) (place a1 t) (place b0 t) (place b1 t)).
Proof. asks_sides. Qed.

Definition all_continuous (c : condition_in_time) : Prop := forall p,
  In p (vanishing c) \/ In p (nonnegative c) \/ In p (not_all_zero c) -> continuity p.
Lemma cont_excess f g D : continuity f -> continuity g -> continuity (fun t => f t - D * g t).
Proof. intros F G. apply cont_minus; auto. apply cont_mult; auto. apply cont_const. Qed.
Lemma corner_continuous D v w : all_continuous (corner_in_time D v w).
Proof. intros p [[<- | []] | [[] | []]]. apply cont_excess; [from_continuous | apply cont_const]. Qed.
Lemma edge_continuous D v e0 e1 : all_continuous (edge_in_time D v e0 e1).
Proof.
  intros p [[<- | []] | [[<- | [<- | []]] | H]].
  - apply cont_excess; from_continuous.
  - from_continuous.
  - from_continuous.
  - apply components_continuous in H; auto. apply smooth_from.
Qed.
Lemma face_continuous D v f0 f1 f2 : all_continuous (face_near_in_time D v f0 f1 f2).
Proof.
  intros p [[<- | []] | [H | H]].
  - assert (continuity (face_y v f0 f1 f2))
      by (apply (cont_dot (face_normal f0 f1 f2) (from v f0)); unfold face_normal; from_continuous).
    apply cont_excess; [now apply cont_mult | from_continuous].
  - now apply face_weights_continuous in H.
  - apply components_continuous in H; auto. unfold face_normal. from_continuous.
Qed.
Lemma edges_continuous D a0 a1 b0 b1 : all_continuous (edges_near_in_time D a0 a1 b0 b1).
Proof.
  intros p [[<- | []] | [H | H]].
  - assert (continuity (edges_y a0 a1 b0 b1))
      by (apply (cont_dot (edges_normal a0 a1 b0 b1) (from b0 a0)); unfold edges_normal; from_continuous).
    apply cont_excess; [now apply cont_mult | from_continuous].
  - now apply edges_weights_continuous in H.
  - apply components_continuous in H; auto. unfold edges_normal. from_continuous.
Qed.

Lemma first_unique (H : R -> Prop) s t : first H s -> first H t -> s = t.
Proof.
  intros (S & Hs & Fs) (T & Ht & Ft). destruct (Rtotal_order s t) as [L | [E | L]]; auto; exfalso.
  - apply (Ft s); auto. lra.
  - apply (Fs t); auto. lra.
Qed.
Lemma same_at_pairs D s cs ks : Forall2 (same_at D s) cs ks ->
  (forall c, In c cs -> exists k, In k ks /\ same_at D s c k) /\
  (Exists (holds D) ks <-> exists c, In c cs /\ is_met c s).
Proof.
  intros A. induction A as [| c k cs ks P F2 (IH1 & IH2)].
  - split; [easy |]. rewrite Exists_nil. split; [easy | now intros (c & [] & _)].
  - split.
    + intros c' [<- | I]; [exists k; simpl; auto |]. destruct (IH1 c' I) as (k' & Ik & Ask). exists k'. simpl. auto.
    + rewrite Exists_cons, IH2, <- (same_at_met D s c k P). simpl. split.
      * intros [H | (c' & I & H)]; eauto.
      * intros (c' & [<- | I] & H); eauto.
Qed.
Lemma near_candidate D (near_at : R -> Prop) cs conditions t : Forall all_continuous cs ->
  (forall s, Forall2 (same_at D s) cs (conditions s)) -> (forall s, near_at s <-> Exists (holds D) (conditions s)) ->
  (sometime near_at -> exists s, first near_at s /\ (s = 0 \/ met D (conditions s))) ->
  first near_at t -> t <> 0 -> exists c, In c cs /\ candidate c t.
Proof.
  intros C A Near Within F N. rewrite Forall_forall in C.
  assert (M : met D (conditions t)).
  { destruct Within as (s & Fs & M); [exists t; split; apply F |]. rewrite <- (first_unique _ _ _ Fs F) in *.
    now destruct M. }
  pose proof (fun s => same_at_pairs D s cs (conditions s) (A s)) as Pairs.
  apply first_is_candidate; auto.
  - intros c p I. now apply C.
  - revert F. apply same_first_time. intros s _. rewrite Near. apply Pairs.
  - intros c I _ E. destruct (proj1 (Pairs t) c I) as (k & _ & _ & _ & z & V & _). congruence.
  - intros c I Met p P. destruct (proj1 (Pairs t) c I) as (k & Ik & Ask).
    pose proof (proj1 (same_at_met D t c k Ask) Met) as (S & L). destruct Ask as (_ & _ & z & V & E).
    rewrite V in P. destruct P as [<- | []]. rewrite E. pose proof (proj2 M k Ik S). lra.
Qed.

Theorem vertices_near_candidate D v w t : first (fun s => near D (place v s) (place w s)) t -> t <> 0 ->
  candidate (corner_in_time D v w) t.
Proof.
  intros F N. enough (exists c, In c [corner_in_time D v w] /\ candidate c t) as (c & [<- | []] & C) by auto.
  apply near_candidate with (5 := F) (conditions := fun s => vertices_conditions (place v s) (place w s)) (D := D); auto.
  - apply Forall_cons; [apply corner_continuous | apply Forall_nil].
  - intros s. apply Forall2_cons; [apply same_at_corner | apply Forall2_nil].
  - intros s. unfold vertices_conditions. rewrite Exists_cons, Exists_nil, corner_holds. tauto.
  - apply vertices_first_within.
Qed.
Ltac near_candidate_of conditions_at union within :=
  intros F N; eapply near_candidate with (5 := F) (conditions := conditions_at);
  [ repeat (apply Forall_cons;
      [auto using corner_continuous, edge_continuous, face_continuous, edges_continuous |]); apply Forall_nil
  | intros s; repeat (apply Forall2_cons; [auto using same_at_corner, same_at_edge, same_at_face, same_at_edges |]);
      apply Forall2_nil
  | intros s; apply union
  | apply within
  | exact N ].
Theorem vertex_edge_near_candidate D v e0 e1 t :
  first (fun s => vertex_edge_near D (place v s) (place e0 s) (place e1 s)) t -> t <> 0 ->
  exists c, In c (vertex_edge_near_in_time D v e0 e1) /\ candidate c t.
Proof.
  near_candidate_of (fun s => vertex_edge_conditions (place v s) (place e0 s) (place e1 s))
    vertex_edge_within vertex_edge_first_within.
Qed.
Theorem face_near_candidate D v f0 f1 f2 t :
  first (fun s => face_near D (place v s) (place f0 s) (place f1 s) (place f2 s)) t -> t <> 0 ->
  exists c, In c (all_face_near_in_time D v f0 f1 f2) /\ candidate c t.
Proof.
  near_candidate_of (fun s => face_conditions (place v s) (place f0 s) (place f1 s) (place f2 s))
    face_within_union face_first_within.
Qed.
Theorem edges_near_candidate D a0 a1 b0 b1 t :
  first (fun s => edges_near D (place a0 s) (place a1 s) (place b0 s) (place b1 s)) t -> t <> 0 ->
  exists c, In c (all_edges_near_in_time D a0 a1 b0 b1) /\ candidate c t.
Proof.
  near_candidate_of (fun s => edges_conditions (place a0 s) (place a1 s) (place b0 s) (place b1 s))
    edges_within_union edges_first_within.
Qed.
