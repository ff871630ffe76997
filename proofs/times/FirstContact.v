(** The first time of contact, over the real numbers, as ccd/contact/ computes it. Results:
        face_contact_root, edges_contact_root   in contact, on the border or inside, Y = 0 and no weight is negative
        face_times, edges_times     the times of contact are those inside and those of the border
        vertices_first, vertex_edge_first, face_first, edges_first   if there is contact, there is a first time of it
        face_times_closed, edges_times_closed    without contact at a time, there is none shortly before and after
        face_planar, edges_planar   if Y = 0 up to a contact, there was one inside at t = 0 or at the border since
        face_planar_first, edges_planar_first    so the first contact is at t = 0 or at the border *)

From Coq Require Import Reals Lra Psatz List.
From Errbound Require Import Contact Distance Separation.
Import ListNotations.
Open Scope R_scope.

(** ** Necessary conditions *)

Theorem face_contact_root p a b c : in_triangle p a b c ->
  let B := minus b a in let C := minus c a in let P := minus p a in
  det B C P = 0 /\ 0 <= weight_2 B C P /\ 0 <= weight_1 B C P /\ 0 <= weight_0 B C P.
Proof. exact (touching_conditions p a b c). Qed.
Theorem edges_contact_root a0 a1 b0 b1 : segments_meet a0 a1 b0 b1 ->
  let B := minus a1 a0 in let C := minus b1 b0 in let P := minus b0 a0 in
  det B C P = 0 /\ 0 <= on_a B C P /\ 0 <= square_normal B C - on_a B C P /\ 0 <= on_b B C P /\
  0 <= square_normal B C - on_b B C P.
Proof. exact (meeting_conditions a0 a1 b0 b1). Qed.

(** ** Times *)

Definition face_touches (v f0 f1 f2 : moving) (t : R) : Prop :=
  in_triangle (place v t) (place f0 t) (place f1 t) (place f2 t).
Definition edges_touch (a0 a1 b0 b1 : moving) (t : R) : Prop :=
  segments_meet (place a0 t) (place a1 t) (place b0 t) (place b1 t).
Definition vertex_on_edge (v e0 e1 : moving) (t : R) : Prop := in_segment (place v t) (place e0 t) (place e1 t).
Definition on_face_border (v f0 f1 f2 : moving) (t : R) : Prop :=
  vertex_on_edge v f0 f1 t \/ vertex_on_edge v f1 f2 t \/ vertex_on_edge v f2 f0 t.
Definition on_edges_border (a0 a1 b0 b1 : moving) (t : R) : Prop :=
  vertex_on_edge a0 b0 b1 t \/ vertex_on_edge a1 b0 b1 t \/ vertex_on_edge b0 a0 a1 t \/ vertex_on_edge b1 a0 a1 t.
Definition face_inside_at (v f0 f1 f2 : moving) (t : R) : Prop :=
  inside_face (place v t) (place f0 t) (place f1 t) (place f2 t).
Definition edges_inside_at (a0 a1 b0 b1 : moving) (t : R) : Prop :=
  inside_edges (place a0 t) (place a1 t) (place b0 t) (place b1 t).
(** Y *)
Definition face_y (v f0 f1 f2 : moving) (t : R) : R :=
  det (minus (place f1 t) (place f0 t)) (minus (place f2 t) (place f0 t)) (minus (place v t) (place f0 t)).
Definition edges_y (a0 a1 b0 b1 : moving) (t : R) : R :=
  det (minus (place a1 t) (place a0 t)) (minus (place b1 t) (place b0 t)) (minus (place b0 t) (place a0 t)).

(** All weights are positive, also with Y = 0. *)
Definition query_y (edges : bool) (m0 m1 m2 m3 : moving) (t : R) : R :=
  det (side_b edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t))
    (side_c edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t))
    (side_p edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t)).
Definition query_on_border (edges : bool) : moving -> moving -> moving -> moving -> R -> Prop :=
  if edges then on_edges_border else on_face_border.
Lemma query_times edges m0 m1 m2 m3 t : query_touches edges m0 m1 m2 m3 t <->
  (query_y edges m0 m1 m2 m3 t = 0 /\ query_inside_at edges m0 m1 m2 m3 t) \/ query_on_border edges m0 m1 m2 m3 t.
Proof.
  assert (Same : query_border_at edges m0 m1 m2 m3 t = query_on_border edges m0 m1 m2 m3 t) by now destruct edges.
  rewrite query_at_a_time, Same. split.
  - intros [H | H]; [| now right]. assert (Y := proj1 (proj2 (proj1 (query_regular _ _ _ _ _ t) H))).
    apply query_regular_border in H. rewrite Same in H. destruct H as [H | H]; [left; now split | now right].
  - intros [(Y & H) | H]; [left; now apply query_inside_regular | now right].
Qed.
Theorem face_times v f0 f1 f2 t : face_touches v f0 f1 f2 t <->
  (face_y v f0 f1 f2 t = 0 /\ face_inside_at v f0 f1 f2 t) \/ on_face_border v f0 f1 f2 t.
Proof. exact (query_times false v f0 f1 f2 t). Qed.
Theorem edges_times a0 a1 b0 b1 t : edges_touch a0 a1 b0 b1 t <->
  (edges_y a0 a1 b0 b1 t = 0 /\ edges_inside_at a0 a1 b0 b1 t) \/ on_edges_border a0 a1 b0 b1 t.
Proof. exact (query_times true a0 a1 b0 b1 t). Qed.

(** Contact is distance 0. *)
Lemma near_0 p q : near 0 p q <-> p = q.
Proof.
  unfold near. split.
  - intros H. pose proof (square_nonnegative (minus p q)). assert (E : minus p q = origin) by (apply square_0; lra).
    apply point_eq in E. destruct p, q. coordinates. apply same_point; simpl; lra.
  - intros ->. right. coordinates. ring.
Qed.
Lemma edge_near_0 v e0 e1 : vertex_edge_near 0 v e0 e1 <-> in_segment v e0 e1.
Proof.
  split.
  - intros (q & S & N). apply near_0 in N. now subst.
  - intros S. exists v. split; auto. now apply near_0.
Qed.
Lemma face_near_0 v f0 f1 f2 : face_near 0 v f0 f1 f2 <-> in_triangle v f0 f1 f2.
Proof.
  split.
  - intros (q & S & N). apply near_0 in N. now subst.
  - intros S. exists v. split; auto. now apply near_0.
Qed.
Lemma edges_near_0 a0 a1 b0 b1 : edges_near 0 a0 a1 b0 b1 <-> segments_meet a0 a1 b0 b1.
Proof.
  split.
  - intros (p & q & S & T & N). apply near_0 in N. subst q. now exists p.
  - intros (p & S & T). exists p, p. split; auto. split; auto. now apply near_0.
Qed.
Lemma same_first (H G : R -> Prop) : (forall t, H t <-> G t) -> (sometime H -> exists t, first H t) ->
  sometime G -> exists t, first G t.
Proof.
  intros E F (b & B & Gb). destruct F as (t & T & Ht & Before).
  { exists b. split; auto. now apply E. }
  exists t. split; auto. split; [now apply E |]. intros s S Gs. apply (Before s S). now apply E.
Qed.

Theorem vertices_first v w : vertex_vertex_collides v w -> exists t, first (fun t => place v t = place w t) t.
Proof.
  apply (same_first (fun t => near 0 (place v t) (place w t))); [intros t; apply near_0 |].
  intros H. destruct (vertices_first_within v w 0 H) as (t & F & _). eauto.
Qed.
Theorem vertex_edge_first v e0 e1 : vertex_edge_collides v e0 e1 -> exists t, first (vertex_on_edge v e0 e1) t.
Proof.
  apply (same_first (fun t => vertex_edge_near 0 (place v t) (place e0 t) (place e1 t)));
    [intros t; apply edge_near_0 |].
  intros H. destruct (vertex_edge_first_within v e0 e1 0 H) as (t & F & _). eauto.
Qed.
Theorem face_first v f0 f1 f2 : vertex_face_collides v f0 f1 f2 -> exists t, first (face_touches v f0 f1 f2) t.
Proof.
  apply (same_first (fun t => face_near 0 (place v t) (place f0 t) (place f1 t) (place f2 t)));
    [intros t; apply face_near_0 |].
  intros H. destruct (face_first_within v f0 f1 f2 0 H) as (t & F & _). eauto.
Qed.
Theorem edges_first a0 a1 b0 b1 : edge_edge_collides a0 a1 b0 b1 -> exists t, first (edges_touch a0 a1 b0 b1) t.
Proof.
  apply (same_first (fun t => edges_near 0 (place a0 t) (place a1 t) (place b0 t) (place b1 t)));
    [intros t; apply edges_near_0 |].
  intros H. destruct (edges_first_within a0 a1 b0 b1 0 H) as (t & F & _). eauto.
Qed.
Lemma query_first edges m0 m1 m2 m3 :
  query_collides edges m0 m1 m2 m3 -> exists t, first (query_touches edges m0 m1 m2 m3) t.
Proof. destruct edges; [exact (edges_first m0 m1 m2 m3) | exact (face_first m0 m1 m2 m3)]. Qed.
Theorem face_times_closed v f0 f1 f2 s : ~ face_touches v f0 f1 f2 s ->
  exists e, 0 < e /\ forall t, Rabs (t - s) < e -> ~ face_touches v f0 f1 f2 t.
Proof.
  assert (E : forall t, face_touches v f0 f1 f2 t <-> family_near (face_family v f0 f1 f2) 0 t)
    by (intros t; rewrite face_family_near; symmetry; apply face_near_0).
  intros N. rewrite E in N.
  destruct (stays_apart _ _ (face_slow v f0 f1 f2) (face_measured v f0 f1 f2) 0 s N) as (e & E0 & F).
  exists e. split; auto. intros t T. rewrite E. now apply F.
Qed.
Theorem edges_times_closed a0 a1 b0 b1 s : ~ edges_touch a0 a1 b0 b1 s ->
  exists e, 0 < e /\ forall t, Rabs (t - s) < e -> ~ edges_touch a0 a1 b0 b1 t.
Proof.
  assert (E : forall t, edges_touch a0 a1 b0 b1 t <-> family_near (edges_family a0 a1 b0 b1) 0 t)
    by (intros t; rewrite edges_family_near; symmetry; apply edges_near_0).
  intros N. rewrite E in N.
  destruct (stays_apart _ _ (edges_slow a0 a1 b0 b1) (edges_measured a0 a1 b0 b1) 0 s N) as (e & E0 & F).
  exists e. split; auto. intros t T. rewrite E. now apply F.
Qed.

(** ** Planar motion *)

(** The motion up to time b is a motion, too. *)
Definition until (b : R) (m : moving) : moving := Moving (start m) (place m b).
Lemma place_until b m t : place (until b m) t = place m (b * t).
Proof. unfold until, place. cbn [start finish x y z]. apply same_point; cbn [x y z]; ring. Qed.

Lemma query_planar edges m0 m1 m2 m3 b : 0 <= b <= 1 -> (forall t, 0 <= t <= b -> query_y edges m0 m1 m2 m3 t = 0) ->
  query_touches edges m0 m1 m2 m3 b ->
  query_inside_at edges m0 m1 m2 m3 0 \/ exists s, 0 <= s <= b /\ query_on_border edges m0 m1 m2 m3 s.
Proof.
  intros B Y H. pose proof (query_coplanar edges (until b m0) (until b m1) (until b m2) (until b m3)) as C.
  assert (At : forall t, query_y edges (until b m0) (until b m1) (until b m2) (until b m3) t = query_y edges m0 m1 m2
    m3 (b * t))
    by (intros t; unfold query_y; now rewrite !place_until).
  destruct (proj1 (C (fun t T => eq_trans (At t) (Y (b * t) ltac:(nra))))) as [I | I].
  - exists 1. split; [lra |]. unfold query_touches in *. rewrite !place_until, Rmult_1_r. exact H.
  - left. unfold query_inside_at in *. rewrite !place_until, Rmult_0_r in I. exact I.
  - right. unfold query_border, edges_border_collides, face_border_collides, vertex_edge_collides, sometime in I.
    unfold query_on_border, on_edges_border, on_face_border, vertex_on_edge.
    destruct edges; repeat (destruct I as [(t & T & S) | I] || destruct I as (t & T & S)); rewrite !place_until in S;
      exists (b * t); (split; [nra | auto]).
Qed.
Theorem face_planar v f0 f1 f2 b : 0 <= b <= 1 -> (forall t, 0 <= t <= b -> face_y v f0 f1 f2 t = 0) ->
  face_touches v f0 f1 f2 b ->
  face_inside_at v f0 f1 f2 0 \/ exists s, 0 <= s <= b /\ on_face_border v f0 f1 f2 s.
Proof. exact (query_planar false v f0 f1 f2 b). Qed.
Theorem edges_planar a0 a1 b0 b1 b : 0 <= b <= 1 -> (forall t, 0 <= t <= b -> edges_y a0 a1 b0 b1 t = 0) ->
  edges_touch a0 a1 b0 b1 b ->
  edges_inside_at a0 a1 b0 b1 0 \/ exists s, 0 <= s <= b /\ on_edges_border a0 a1 b0 b1 s.
Proof. exact (query_planar true a0 a1 b0 b1 b). Qed.

Lemma query_planar_first edges m0 m1 m2 m3 t : (forall s, 0 <= s <= 1 -> query_y edges m0 m1 m2 m3 s = 0) ->
  first (query_touches edges m0 m1 m2 m3) t -> t = 0 \/ query_on_border edges m0 m1 m2 m3 t.
Proof.
  intros Y (T & H & Before).
  destruct (query_planar edges m0 m1 m2 m3 t T) as [I | (s & S & I)]; auto; [intros s S; apply Y; lra | |].
  - left. destruct (Req_dec t 0); auto. exfalso. apply (Before 0); [lra |]. apply query_times. left.
    split; auto. apply Y. lra.
  - right. destruct (Req_dec s t) as [<- |]; auto. exfalso. apply (Before s); [lra |]. apply query_times. now right.
Qed.
Theorem face_planar_first v f0 f1 f2 t : (forall s, 0 <= s <= 1 -> face_y v f0 f1 f2 s = 0) ->
  first (face_touches v f0 f1 f2) t -> t = 0 \/ on_face_border v f0 f1 f2 t.
Proof. exact (query_planar_first false v f0 f1 f2 t). Qed.
Theorem edges_planar_first a0 a1 b0 b1 t : (forall s, 0 <= s <= 1 -> edges_y a0 a1 b0 b1 s = 0) ->
  first (edges_touch a0 a1 b0 b1) t -> t = 0 \/ on_edges_border a0 a1 b0 b1 t.
Proof. exact (query_planar_first true a0 a1 b0 b1 t). Qed.
