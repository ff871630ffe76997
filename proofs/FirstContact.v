(** The first time of contact, over the real numbers: what ccd/contact/ asks for it.

    Results:
        face_contact_root, edges_contact_root   in contact, border contacts included, Y = 0 and no weight is negative
        face_times, edges_times     the times of contact are those inside and those of the border
        vertices_first, vertex_edge_first, face_first, edges_first   if there is contact, there is a first time of it
        face_times_closed, edges_times_closed    no contact at one time: none shortly before and after
        face_planar, edges_planar   Y = 0 up to a contact: it was there inside at t = 0, or at the border meanwhile
        face_planar_first, edges_planar_first    so the first contact is at t = 0 or at the border *)

From Coq Require Import Reals Lra Psatz List.
From Errbound Require Import Contact Distance Separation.
Import ListNotations.
Open Scope R_scope.

(** ** Where it can be *)

Theorem face_contact_root p a b c : in_triangle p a b c ->
  let B := minus b a in let C := minus c a in let P := minus p a in
  det B C P = 0 /\ 0 <= weight_2 B C P /\ 0 <= weight_1 B C P /\ 0 <= weight_0 B C P.
Proof.
  intros (u & v & U & V & W & E) B C P. destruct (weights_of a b c p u v E) as (Y & W1 & W2). fold B C P in Y, W1, W2.
  split; auto. unfold weight_0. fold (square_normal B C). rewrite W1, W2.
  assert (0 <= square_normal B C) by apply square_nonnegative.
  repeat split; try (now apply Rmult_le_pos).
  replace (square_normal B C - _ - _) with ((1 - u - v) * square_normal B C) by ring. apply Rmult_le_pos; lra.
Qed.
Theorem edges_contact_root a0 a1 b0 b1 : segments_meet a0 a1 b0 b1 ->
  let B := minus a1 a0 in let C := minus b1 b0 in let P := minus b0 a0 in
  det B C P = 0 /\ 0 <= on_a B C P /\ 0 <= square_normal B C - on_a B C P /\ 0 <= on_b B C P /\
  0 <= square_normal B C - on_b B C P.
Proof.
  intros (p & (s & S & Ea) & (t & T & Eb)) B C P.
  destruct (weights_at_meeting a0 a1 b0 b1 s t) as (Y & A & O); [congruence |]. fold B C P in Y, A, O.
  rewrite A, O. assert (0 <= square_normal B C) by apply square_nonnegative.
  split; auto. repeat split; nra.
Qed.

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

(** The inside strictly, and with Y = 0. *)
Theorem face_times v f0 f1 f2 t : face_touches v f0 f1 f2 t <->
  (face_y v f0 f1 f2 t = 0 /\ face_inside_at v f0 f1 f2 t) \/ on_face_border v f0 f1 f2 t.
Proof.
  unfold face_touches, face_y, face_inside_at, on_face_border, vertex_on_edge. rewrite face_at_a_time.
  fold (face_border (place v t) (place f0 t) (place f1 t) (place f2 t)). split.
  - intros [H | H]; [| now right]. pose proof H as (_ & Y & _). apply regular_face_border in H. tauto.
  - intros [(Y & H) | H]; [| now right]. left. now apply inside_face_regular.
Qed.
Theorem edges_times a0 a1 b0 b1 t : edges_touch a0 a1 b0 b1 t <->
  (edges_y a0 a1 b0 b1 t = 0 /\ edges_inside_at a0 a1 b0 b1 t) \/ on_edges_border a0 a1 b0 b1 t.
Proof.
  unfold edges_touch, edges_y, edges_inside_at, on_edges_border, vertex_on_edge. rewrite edges_at_a_time.
  fold (edges_border (place a0 t) (place a1 t) (place b0 t) (place b1 t)). split.
  - intros [H | H]; [| now right]. pose proof H as (_ & Y & _). apply regular_edges_border in H. tauto.
  - intros [(Y & H) | H]; [| now right]. left. now apply inside_edges_regular.
Qed.

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

Theorem face_planar v f0 f1 f2 b : 0 <= b <= 1 -> (forall t, 0 <= t <= b -> face_y v f0 f1 f2 t = 0) ->
  face_touches v f0 f1 f2 b ->
  face_inside_at v f0 f1 f2 0 \/ exists s, 0 <= s <= b /\ on_face_border v f0 f1 f2 s.
Proof.
  intros B Y H. pose proof (face_coplanar (until b v) (until b f0) (until b f1) (until b f2)) as C. cbv zeta in C.
  assert (Planar : forall t, 0 <= t <= 1 -> det (minus (place (until b f1) t) (place (until b f0) t))
    (minus (place (until b f2) t) (place (until b f0) t)) (minus (place (until b v) t) (place (until b f0) t)) = 0).
  { intros t T. rewrite !place_until. apply (Y (b * t)). nra. }
  destruct (proj1 (C Planar)) as [I | I].
  - exists 1. split; [lra |]. rewrite !place_until, Rmult_1_r. exact H.
  - left. unfold face_inside_at. rewrite !place_until, Rmult_0_r in I. exact I.
  - right. unfold face_border_collides, vertex_edge_collides, sometime in I.
    destruct I as [(t & T & S) | [(t & T & S) | (t & T & S)]]; rewrite !place_until in S; exists (b * t);
      (split; [nra |]); unfold on_face_border, vertex_on_edge; auto.
Qed.
Theorem edges_planar a0 a1 b0 b1 b : 0 <= b <= 1 -> (forall t, 0 <= t <= b -> edges_y a0 a1 b0 b1 t = 0) ->
  edges_touch a0 a1 b0 b1 b ->
  edges_inside_at a0 a1 b0 b1 0 \/ exists s, 0 <= s <= b /\ on_edges_border a0 a1 b0 b1 s.
Proof.
  intros B Y H. pose proof (edges_coplanar (until b a0) (until b a1) (until b b0) (until b b1)) as C. cbv zeta in C.
  assert (Planar : forall t, 0 <= t <= 1 -> det (minus (place (until b a1) t) (place (until b a0) t))
    (minus (place (until b b1) t) (place (until b b0) t)) (minus (place (until b b0) t) (place (until b a0) t)) = 0).
  { intros t T. rewrite !place_until. apply (Y (b * t)). nra. }
  destruct (proj1 (C Planar)) as [I | I].
  - exists 1. split; [lra |]. rewrite !place_until, Rmult_1_r. exact H.
  - left. unfold edges_inside_at. rewrite !place_until, Rmult_0_r in I. exact I.
  - right. unfold edges_border_collides, vertex_edge_collides, sometime in I.
    destruct I as [(t & T & S) | [(t & T & S) | [(t & T & S) | (t & T & S)]]]; rewrite !place_until in S;
      exists (b * t); (split; [nra |]); unfold on_edges_border, vertex_on_edge; auto.
Qed.

Theorem face_planar_first v f0 f1 f2 t : (forall s, 0 <= s <= 1 -> face_y v f0 f1 f2 s = 0) ->
  first (face_touches v f0 f1 f2) t -> t = 0 \/ on_face_border v f0 f1 f2 t.
Proof.
  intros Y (T & H & Before).
  destruct (face_planar v f0 f1 f2 t T) as [I | (s & S & I)]; auto; [intros s S; apply Y; lra | |].
  - left. destruct (Req_dec t 0); auto. exfalso. apply (Before 0); [lra |]. apply face_times. left.
    split; auto. apply Y. lra.
  - right. destruct (Req_dec s t) as [<- |]; auto. exfalso. apply (Before s); [lra |]. apply face_times. now right.
Qed.
Theorem edges_planar_first a0 a1 b0 b1 t : (forall s, 0 <= s <= 1 -> edges_y a0 a1 b0 b1 s = 0) ->
  first (edges_touch a0 a1 b0 b1) t -> t = 0 \/ on_edges_border a0 a1 b0 b1 t.
Proof.
  intros Y (T & H & Before).
  destruct (edges_planar a0 a1 b0 b1 t T) as [I | (s & S & I)]; auto; [intros s S; apply Y; lra | |].
  - left. destruct (Req_dec t 0); auto. exfalso. apply (Before 0); [lra |]. apply edges_times. left.
    split; auto. apply Y. lra.
  - right. destruct (Req_dec s t) as [<- |]; auto. exfalso. apply (Before s); [lra |]. apply edges_times. now right.
Qed.
