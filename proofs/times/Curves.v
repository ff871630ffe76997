(** First times of points that move continuously, on any curves (ccd/contact/first_times.cpp). Times of contact, and of a
    distance, are closed, so there is a first one. Results:
        first_of_closed      a nonempty closed set of times has a first one
        face_near_after_moving, edges_near_after_moving   points within a distance that move by d are within that and
            2d
        face_curves_closed, edges_curves_closed, face_curves_first, edges_curves_first   times of contact are closed
        smooth_continuous    paths are continuous if their coordinates are, like polynomials *)

From Coq Require Import Reals Lra Psatz List.
From Errbound Require Import Contact Distance Separation FirstContact.
Open Scope R_scope.

Definition closed_times (H : R -> Prop) : Prop :=
  forall s, ~ H s -> exists e, 0 < e /\ forall t, Rabs (t - s) < e -> ~ H t.
Theorem first_of_closed H : closed_times H -> sometime H -> exists t, first H t.
Proof.
  intros C S. apply least_time; auto. intros s _ N. destruct (C s N) as (e & E & F). exists (s + e). split; [lra |].
  intros t T. apply F. rewrite Rabs_pos_eq; lra.
Qed.

(** A path of each point. *)
Definition path : Type := R -> point.
Definition continuous (p : path) : Prop :=
  forall s d, 0 < d -> exists e, 0 < e /\ forall t, Rabs (t - s) < e -> norm (minus (p t) (p s)) <= d.
Definition moved (d : R) (p q : point) : Prop := norm (minus p q) <= d.

Lemma norm_triangle p q : norm (along p 1 q) <= norm p + norm q.
Proof. eapply Rle_trans; [apply norm_along |]. rewrite Rabs_R1. lra. Qed.
Lemma norm_times k p : norm (along origin k p) <= Rabs k * norm p.
Proof.
  eapply Rle_trans; [apply norm_along |]. assert (norm origin = 0); [| lra].
  unfold norm. replace (dot origin origin) with 0 by (coordinates; ring). apply sqrt_0.
Qed.
(** Points between them move by no more. *)
Lemma moved_between d a b c e u : 0 <= u <= 1 -> moved d a c -> moved d b e ->
  moved d (along a u (minus b a)) (along c u (minus e c)).
Proof.
  unfold moved. intros U A B.
  replace (minus (along a u (minus b a)) (along c u (minus e c))) with
    (along (along origin (1 - u) (minus a c)) 1 (along origin u (minus b e))) by (coordinates; apply same_point; simpl; ring).
  eapply Rle_trans; [apply norm_triangle |].
  pose proof (norm_times (1 - u) (minus a c)) as P. pose proof (norm_times u (minus b e)) as Q.
  rewrite Rabs_pos_eq in P, Q by lra. nra.
Qed.
Definition farther (D d : R) : R := (sqrt D + 2 * d) * (sqrt D + 2 * d).
Lemma near_moved D d p q r s : near D p q -> moved d p r -> moved d q s -> near (farther D d) r s.
Proof.
  unfold near, moved, farther. intros H A B. rewrite <- norm_square. pose proof (norm_nonnegative (minus r s)) as N.
  assert (C : norm (minus p q) <= sqrt D) by now apply sqrt_le_1_alt.
  assert (norm (minus r s) <= sqrt D + 2 * d); [| apply Rmult_le_compat; lra].
  replace (minus r s) with (minus (along (minus p q) 1 (minus q s)) (minus p r)) by (coordinates; apply same_point; simpl; ring).
  eapply Rle_trans; [apply norm_minus |]. pose proof (norm_triangle (minus p q) (minus q s)). lra.
Qed.

Theorem face_near_after_moving D d v f0 f1 f2 v' f0' f1' f2' : face_near D v f0 f1 f2 -> moved d v v' -> moved d f0 f0' ->
  moved d f1 f1' -> moved d f2 f2' -> face_near (farther D d) v' f0' f1' f2'.
Proof.
  intros (q & (u & w & U & W & S & E) & Q) V A B C. set (q' := along (along f0' u (minus f1' f0')) w (minus f2' f0')).
  exists q'. split; [exists u, w; auto |]. apply near_moved with (1 := Q); auto. rewrite E. unfold moved, q'.
  replace (minus _ _) with (along (along (along origin (1 - u - w) (minus f0 f0')) 1 (along origin u (minus f1 f1'))) 1
    (along origin w (minus f2 f2'))) by (coordinates; apply same_point; simpl; ring).
  eapply Rle_trans; [apply norm_triangle |]. pose proof (norm_triangle (along origin (1 - u - w) (minus f0 f0')) (along origin u (minus f1 f1'))).
  pose proof (norm_times (1 - u - w) (minus f0 f0')) as P. pose proof (norm_times u (minus f1 f1')) as P1.
  pose proof (norm_times w (minus f2 f2')) as P2. rewrite Rabs_pos_eq in P, P1, P2 by lra. unfold moved in *. nra.
Qed.
Theorem edges_near_after_moving D d a0 a1 b0 b1 a0' a1' b0' b1' : edges_near D a0 a1 b0 b1 -> moved d a0 a0' -> moved d a1 a1' ->
  moved d b0 b0' -> moved d b1 b1' -> edges_near (farther D d) a0' a1' b0' b1'.
Proof.
  intros (p & q & (s & S & ->) & (t & T & ->) & Q) A0 A1 B0 B1.
  exists (along a0' s (minus a1' a0')), (along b0' t (minus b1' b0')). split; [now exists s |]. split; [now exists t |].
  apply near_moved with (1 := Q); now apply moved_between.
Qed.

(** Points that are farther apart stay so while no point has moved by a quarter of the difference. *)
Lemma apart_for_a_while (nearby : R -> Prop) D : 0 <= D -> (exists m, distances nearby m) -> ~ nearby D ->
  exists d, 0 < d /\ ~ nearby (farther D d).
Proof.
  intros D0 (m & M0 & M) N. assert (P : D < m) by (apply Rnot_le_lt; intros L; now apply N, M).
  exists ((sqrt m - sqrt D) / 4). assert (Q : sqrt D < sqrt m) by now apply sqrt_lt_1_alt. split; [lra |].
  intros H. apply M in H. unfold farther in H. pose proof (sqrt_sqrt m M0). pose proof (sqrt_pos D). nra.
Qed.
Lemma all_continuous (ps : list path) s d : Forall continuous ps -> 0 < d ->
  exists e, 0 < e /\ forall t, Rabs (t - s) < e -> Forall (fun p => moved d (p t) (p s)) ps.
Proof.
  intros F D. induction F as [| p ps C F (e & E & IH)]; [exists 1; split; [lra | constructor] |].
  destruct (C s d D) as (e' & E' & H). exists (Rmin e e'). split; [now apply Rmin_glb_lt |]. intros t T.
  pose proof (Rmin_l e e'). pose proof (Rmin_r e e'). constructor; [apply H | apply IH]; lra.
Qed.

Section Paths.

Variable D : R.  (** the square of the distance: 0 for contact *)
Context (D_0 : 0 <= D) (p0 p1 p2 p3 : path) (C0 : continuous p0) (C1 : continuous p1) (C2 : continuous p2)
  (C3 : continuous p3).
Definition face_in_contact (t : R) : Prop := face_near D (p0 t) (p1 t) (p2 t) (p3 t).
Definition edges_in_contact (t : R) : Prop := edges_near D (p0 t) (p1 t) (p2 t) (p3 t).

Lemma all_moved s d : 0 < d -> exists e, 0 < e /\ forall t, Rabs (t - s) < e ->
  moved d (p0 t) (p0 s) /\ moved d (p1 t) (p1 s) /\ moved d (p2 t) (p2 s) /\ moved d (p3 t) (p3 s).
Proof.
  intros H. destruct (all_continuous (p0 :: p1 :: p2 :: p3 :: nil) s d) as (e & E & M); auto. exists e. split; auto.
  intros t T. specialize (M t T). repeat match goal with H : Forall _ (_ :: _) |- _ => inversion_clear H end. auto.
Qed.
Theorem face_curves_closed : closed_times face_in_contact.
Proof.
  intros s N. destruct (apart_for_a_while _ D D_0 (face_distance (p0 s) (p1 s) (p2 s) (p3 s)) N) as (d & H & Far).
  destruct (all_moved s d H) as (e & E & M). exists e. split; auto. intros t T Q. apply Far.
  destruct (M t T) as (M0 & M1 & M2 & M3). now apply face_near_after_moving with (1 := Q).
Qed.
Theorem edges_curves_closed : closed_times edges_in_contact.
Proof.
  intros s N. destruct (apart_for_a_while _ D D_0 (edges_distance (p0 s) (p1 s) (p2 s) (p3 s)) N) as (d & H & Far).
  destruct (all_moved s d H) as (e & E & M). exists e. split; auto. intros t T Q. apply Far.
  destruct (M t T) as (M0 & M1 & M2 & M3). now apply edges_near_after_moving with (1 := Q).
Qed.
Theorem face_curves_first : sometime face_in_contact -> exists t, first face_in_contact t.
Proof. apply first_of_closed, face_curves_closed. Qed.
Theorem edges_curves_first : sometime edges_in_contact -> exists t, first edges_in_contact t.
Proof. apply first_of_closed, edges_curves_closed. Qed.

End Paths.

(** Coordinates are continuous, like polynomials. *)
Theorem smooth_continuous p : smooth p -> continuous p.
Proof.
  intros (X & Y & Z) s d D. assert (D4 : 0 < d / 4) by lra.
  destruct (X s (d / 4) D4) as (e0 & E0 & H0). destruct (Y s (d / 4) D4) as (e1 & E1 & H1). destruct (Z s (d / 4) D4) as (e2 & E2 & H2).
  exists (Rmin e0 (Rmin e1 e2)). split; [repeat apply Rmin_glb_lt; lra |]. intros t T.
  pose proof (Rmin_l e0 (Rmin e1 e2)). pose proof (Rmin_r e0 (Rmin e1 e2)). pose proof (Rmin_l e1 e2). pose proof (Rmin_r e1 e2).
  destruct (Req_dec t s) as [-> | N].
  { apply norm_below; [lra |]. replace (dot _ _) with 0 by (coordinates; ring). nra. }
  assert (Near : forall f e, (forall x, D_x no_cond s x /\ R_dist x s < e -> R_dist (f x) (f s) < d / 4) -> Rabs (t - s) < e ->
    - (d / 4) < f t - f s < d / 4).
  { intros f e H' L. specialize (H' t). unfold R_dist, D_x, no_cond in H'.
    assert (G : Rabs (f t - f s) < d / 4) by (apply H'; repeat split; auto). apply Rabs_def2 in G. lra. }
  pose proof (Near (fun t => x (p t)) e0 H0 ltac:(lra)) as A. pose proof (Near (fun t => y (p t)) e1 H1 ltac:(lra)) as B.
  pose proof (Near (fun t => z (p t)) e2 H2 ltac:(lra)) as C. apply norm_below; [lra |]. unfold dot, minus. cbn [x y z].
  assert (Sq : forall v, - (d / 4) < v < d / 4 -> v * v <= d / 4 * (d / 4)) by (intros v V; nra).
  pose proof (Sq _ A). pose proof (Sq _ B). pose proof (Sq _ C). nra.
Qed.
