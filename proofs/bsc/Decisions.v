(** Collision decisions of the floating-point methods, over every scalar (Bernstein.v): the forms of
    include/ccd/methods/forms.hpp, BSC on them (include/ccd/methods/bsc.hpp), and tests that separate two features.
    Results:
        forms_y, forms_weights      the forms are Y and the weights of Contact.v at every t
        bsc_face_separate, bsc_face_collides, bsc_edges_separate, bsc_edges_collide
                                    answers of decide_bsc are right
        face_rootless_separate, face_outside_separate, edges_rootless_separate, edges_outside_separate
                                    one strict sign of Y, or no G >= 0: no collision
        face_separated, edges_separated, vertex_edge_separated   a fixed axis that separates the features in the
                                    same direction at both ends of the step separates them throughout *)

From Coq Require Import Reals ZArith Lia Lra Psatz List.
From Errbound Require Import Sign Bernstein Bsc Contact.
Import ListNotations.
Open Scope R_scope.

(** ** The forms *)

Section Forms.

Context {S : scalar}.
Notation form_at := (@at_time S).

Record position := Position { px : S; py : S; pz : S }.
Record moving_point := MovingPoint { t0 : position; t1 : position }.
Definition exact_position (p : position) : point := Point (exact (px p)) (exact (py p)) (exact (pz p)).
Definition exact_motion (m : moving_point) : moving := Moving (exact_position (t0 m)) (exact_position
  (t1 m)).

Record vector_form := VectorForm { vx : list S; vy : list S; vz : list S }.
Definition difference (q p : moving_point) : vector_form := VectorForm
  [sub (px (t0 q)) (px (t0 p)); sub (px (t1 q)) (px (t1 p))]
  [sub (py (t0 q)) (py (t0 p)); sub (py (t1 q)) (py (t1 p))]
  [sub (pz (t0 q)) (pz (t0 p)); sub (pz (t1 q)) (pz (t1 p))].
(** + and - of forms of one degree *)
Fixpoint plus_form (p q : list S) : list S :=
  match p, q with a :: p, b :: q => add a b :: plus_form p q | _, _ => [] end.
Fixpoint minus_form (p q : list S) : list S :=
  match p, q with a :: p, b :: q => sub a b :: minus_form p q | _, _ => [] end.
Definition cross_form (p q : vector_form) : vector_form := VectorForm
  (minus_form (product (vy p) (vz q)) (product (vz p) (vy q)))
  (minus_form (product (vz p) (vx q)) (product (vx p) (vz q)))
  (minus_form (product (vx p) (vy q)) (product (vy p) (vx q))).
Definition dot_form (p q : vector_form) : list S :=
  plus_form (plus_form (product (vx p) (vx q)) (product (vy p) (vy q))) (product (vz p) (vz q)).

Definition y_form (b c p : vector_form) : list S := dot_form (cross_form b c) p.
Definition normal_squared (b c : vector_form) : list S := dot_form (cross_form b c) (cross_form b c).
Definition inside_face_forms (b c p : vector_form) : list (list S) :=
  let w2 := dot_form (cross_form b p) (cross_form b c) in
  let w1 := dot_form (cross_form p c) (cross_form b c) in
  [w2; w1; minus_form (minus_form (normal_squared b c) w1) w2].
Definition inside_edges_forms (b c p : vector_form) : list (list S) :=
  let a := dot_form (cross_form p c) (cross_form b c) in
  let b' := dot_form (cross_form p b) (cross_form b c) in
  let n2 := normal_squared b c in
  [a; minus_form n2 a; b'; minus_form n2 b'].

Definition vector_at (v : vector_form) (t : R) : point :=
  Point (form_at (vx v) t) (form_at (vy v) t) (form_at (vz v) t).
Definition degree (v : vector_form) (n : nat) : Prop :=
  length (vx v) = Datatypes.S n /\ length (vy v) = Datatypes.S n /\ length (vz v) = Datatypes.S n.

Lemma difference_at q p t : vector_at (difference q p) t = minus (place (exact_motion q) t) (place
  (exact_motion p) t).
Proof.
  unfold vector_at, difference, at_time, minus, place, exact_motion. cbn [vx vy vz x y z start finish
    exact_position map form length].
  repeat rewrite exact_sub. apply same_point; cbn [x y z]; ring.
Qed.

Lemma plus_form_at p q t : length p = length q ->
  form_at (plus_form p q) t = form_at p t + form_at q t /\ length (plus_form p q) = length p.
Proof.
  unfold at_time. revert q.
  induction p as [| a p IH]; intros [| b q] L; try discriminate; simpl; [split; [ring | easy] |].
  injection L as L. destruct (IH q L) as (E & K). rewrite E, !map_length, K, exact_add, L.
  split; [ring | easy].
Qed.
Lemma minus_form_at p q t : length p = length q ->
  form_at (minus_form p q) t = form_at p t - form_at q t /\ length (minus_form p q) = length p.
Proof.
  unfold at_time. revert q.
  induction p as [| a p IH]; intros [| b q] L; try discriminate; simpl; [split; [ring | easy] |].
  injection L as L. destruct (IH q L) as (E & K). rewrite E, !map_length, K, exact_sub, L.
  split; [ring | easy].
Qed.
Lemma product_at p q m n t : length p = Datatypes.S m -> length q = Datatypes.S n ->
  form_at (product p q) t = form_at p t * form_at q t /\ length (product p q) = Datatypes.S (m + n).
Proof.
  intros L K. split; [apply product_form |]. destruct q as [| b q]; [discriminate |].
  destruct (product_both p b q 1 1) as (_ & E). rewrite E by now destruct p. simpl in K. lia.
Qed.

Lemma cross_at b c m n t : degree b m -> degree c n ->
  vector_at (cross_form b c) t = cross (vector_at b t) (vector_at c t) /\ degree (cross_form b c) (m +
    n).
Proof.
  intros (B0 & B1 & B2) (C0 & C1 & C2).
  assert (D : forall p q r s, length p = Datatypes.S m -> length q = Datatypes.S n -> length r =
    Datatypes.S m ->
    length s = Datatypes.S n -> form_at (minus_form (product p q) (product r s)) t
      = form_at p t * form_at q t - form_at r t * form_at s t /\
    length (minus_form (product p q) (product r s)) = Datatypes.S (m + n)).
  { intros p q r s Lp Lq Lr Ls. destruct (product_at p q m n t Lp Lq) as (E & L).
    destruct (product_at r s m n t Lr Ls) as (F & K).
    destruct (minus_form_at (product p q) (product r s) t) as (G & J); [congruence |]. rewrite G, E, F.
      split; congruence. }
  destruct (D (vy b) (vz c) (vz b) (vy c)) as (E0 & L0); auto.
  destruct (D (vz b) (vx c) (vx b) (vz c)) as (E1 & L1); auto.
  destruct (D (vx b) (vy c) (vy b) (vx c)) as (E2 & L2); auto.
  split; [| now repeat split]. unfold vector_at, cross, cross_form. cbn [vx vy vz x y z].
  now rewrite E0, E1, E2.
Qed.
Lemma dot_at b c m n t : degree b m -> degree c n ->
  form_at (dot_form b c) t = dot (vector_at b t) (vector_at c t) /\ length (dot_form b c) = Datatypes.S
    (m + n).
Proof.
  intros (B0 & B1 & B2) (C0 & C1 & C2).
  destruct (product_at (vx b) (vx c) m n t B0 C0) as (E0 & L0).
  destruct (product_at (vy b) (vy c) m n t B1 C1) as (E1 & L1).
  destruct (product_at (vz b) (vz c) m n t B2 C2) as (E2 & L2). unfold dot_form.
  destruct (plus_form_at (product (vx b) (vx c)) (product (vy b) (vy c)) t) as (E3 & L3); [congruence
    |].
  destruct (plus_form_at (plus_form (product (vx b) (vx c)) (product (vy b) (vy c))) (product (vz b) (vz
    c)) t)
    as (E4 & L4); [congruence |].
  rewrite E4, E3, E0, E1, E2. split; [easy | congruence].
Qed.

Theorem forms_y b c p t : degree b 1 -> degree c 1 -> degree p 1 ->
  form_at (y_form b c p) t = det (vector_at b t) (vector_at c t) (vector_at p t) /\ length (y_form b c
    p) = 4%nat.
Proof.
  intros B C P. destruct (cross_at b c 1 1 t B C) as (E & D).
  destruct (dot_at _ p 2 1 t D P) as (F & L). unfold y_form, det. now rewrite F, E.
Qed.
Theorem forms_weights b c p t : degree b 1 -> degree c 1 -> degree p 1 ->
  let B := vector_at b t in let C := vector_at c t in let P := vector_at p t in
  map (fun g => form_at g t) (inside_face_forms b c p) = [weight_2 B C P; weight_1 B C P; weight_0 B C
    P] /\
  map (fun g => form_at g t) (inside_edges_forms b c p) =
    [on_a B C P; square_normal B C - on_a B C P; on_b B C P; square_normal B C - on_b B C P] /\
  Forall (fun g => length g = 5%nat) (inside_face_forms b c p) /\
  Forall (fun g => length g = 5%nat) (inside_edges_forms b c p).
Proof.
  intros Db Dc Dp B C P. destruct (cross_at b c 1 1 t Db Dc) as (En & Dn).
  assert (Q : forall v w, degree v 1 -> degree w 1 ->
    form_at (dot_form (cross_form v w) (cross_form b c)) t = dot (cross (vector_at v t) (vector_at w t))
      (cross B C) /\
    length (dot_form (cross_form v w) (cross_form b c)) = 5%nat).
  { intros v w V W. destruct (cross_at v w 1 1 t V W) as (E & D).
    destruct (dot_at _ _ 2 2 t D Dn) as (F & L). rewrite F, E, En. now split. }
  destruct (Q b p Db Dp) as (E2 & L2). destruct (Q p c Dp Dc) as (E1 & L1).
  destruct (Q b c Db Dc) as (E0 & L0).
  destruct (Q p b Dp Db) as (Eb & Lb). fold B C P in E2, E1, E0, Eb.
  unfold inside_face_forms, inside_edges_forms, normal_squared, weight_0, weight_1, weight_2, on_a,
    on_b, square_normal.
  cbv zeta. cbn [map].
  destruct (minus_form_at (dot_form (cross_form b c) (cross_form b c)) (dot_form (cross_form p c)
    (cross_form b c)) t)
    as (F1 & M1); [congruence |].
  destruct (minus_form_at (minus_form (dot_form (cross_form b c) (cross_form b c)) (dot_form (cross_form
    p c) (cross_form b c)))
    (dot_form (cross_form b p) (cross_form b c)) t) as (F0 & M0); [congruence |].
  destruct (minus_form_at (dot_form (cross_form b c) (cross_form b c)) (dot_form (cross_form p b)
    (cross_form b c)) t)
    as (F2 & M2); [congruence |].
  rewrite F0, F1, F2, E0, E1, E2, Eb. repeat split; repeat constructor; congruence.
Qed.

(** ** Decisions *)

Definition inside_forms (edges : bool) (b c p : vector_form) : list (list S) :=
  if edges then inside_edges_forms b c p else inside_face_forms b c p.

Section Query.

Context (edges : bool) (q0 q1 q2 q3 : moving_point).
Let b := side_b edges difference q0 q1 q2 q3.
Let c := side_c edges difference q0 q1 q2 q3.
Let p := side_p edges difference q0 q1 q2 q3.
Let m0 := exact_motion q0.
Let m1 := exact_motion q1.
Let m2 := exact_motion q2.
Let m3 := exact_motion q3.

Lemma query_degrees : degree b 1 /\ degree c 1 /\ degree p 1.
Proof. unfold b, c, p. destruct edges; now repeat split. Qed.
Lemma query_sides_at t :
  vector_at b t = side_b edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t) /\
  vector_at c t = side_c edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t) /\
  vector_at p t = side_p edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t).
Proof. unfold b, c, p. destruct edges; repeat split; apply difference_at. Qed.
Lemma query_forms_at t : let B := vector_at b t in let C := vector_at c t in let P := vector_at p t in
  form_at (y_form b c p) t = det B C P /\ map (fun g => form_at g t) (inside_forms edges b c p) = weights edges B C P.
Proof.
  destruct query_degrees as (Db & Dc & Dp). split; [apply (forms_y b c p t Db Dc Dp) |].
  unfold inside_forms, weights. destruct edges; apply (forms_weights b c p t Db Dc Dp).
Qed.
Lemma query_lengths : length (y_form b c p) = 4%nat /\ Forall (fun g => length g = 5%nat) (inside_forms edges b c p).
Proof.
  destruct query_degrees as (Db & Dc & Dp). split; [apply (forms_y b c p 0 Db Dc Dp) |].
  unfold inside_forms. destruct edges; apply (forms_weights b c p 0 Db Dc Dp).
Qed.
(** Q is Rlt 0 or Rle 0. *)
Lemma query_weights_at (Q : R -> Prop) t : Forall (fun g => Q (form_at g t)) (inside_forms edges b c p) <->
  Forall Q (weights edges (vector_at b t) (vector_at c t) (vector_at p t)).
Proof. rewrite <- (proj2 (query_forms_at t)), Forall_map. reflexivity. Qed.

(** At a collision, Y vanishes and no weight is negative. *)
Lemma query_collision : query_collides edges m0 m1 m2 m3 -> exists t, 0 <= t <= 1 /\ form_at (y_form b c p) t = 0 /\
  Forall (fun g => 0 <= form_at g t) (inside_forms edges b c p).
Proof.
  intros (t & T & H). exists t. split; auto. apply query_conditions in H. destruct (query_sides_at t) as (Eb & Ec & Ep).
  rewrite <- Eb, <- Ec, <- Ep in H. rewrite (proj1 (query_forms_at t)). split; [apply H | now apply query_weights_at].
Qed.
Lemma query_bsc_separate : root_with_nonnegative (y_form b c p) (inside_forms edges b c p) = no ->
  ~ query_collides edges m0 m1 m2 m3.
Proof.
  intros E H. destruct (query_collision H) as (t & T & Z & G). destruct query_lengths as (L & F).
  destruct (bsc_no _ _ t L F E T Z) as (g & I & N). rewrite Forall_forall in G. specialize (G g I). lra.
Qed.
Lemma query_bsc_collides : root_with_nonnegative (y_form b c p) (inside_forms edges b c p) = yes ->
  query_collides edges m0 m1 m2 m3.
Proof.
  intros E. destruct query_lengths as (L & F). destruct (bsc_yes _ _ L F E) as (t & T & Z & G). exists t. split; auto.
  apply Forall_forall, query_weights_at in G. rewrite (proj1 (query_forms_at t)) in Z.
  destruct (query_sides_at t) as (Eb & Ec & Ep). rewrite Eb, Ec, Ep in *.
  apply query_at_a_time. left. now apply query_inside_regular, query_inside_same.
Qed.
Lemma query_rootless_separate : certainly_rootless (y_form b c p) = true -> ~ query_collides edges m0 m1 m2 m3.
Proof. intros E H. destruct (query_collision H) as (t & T & Z & _). now apply (rootless_hull _ t E T). Qed.
Lemma query_outside_separate g : In g (inside_forms edges b c p) -> sign_throughout g = negative ->
  ~ query_collides edges m0 m1 m2 m3.
Proof.
  intros I E H. destruct (query_collision H) as (t & T & _ & G). rewrite Forall_forall in G. specialize (G g I).
  pose proof (sign_throughout_right g t T) as R. rewrite E in R. simpl in R. lra.
Qed.

End Query.

Section Face.

Variables v f0 f1 f2 : moving_point.
Let b := difference f1 f0.
Let c := difference f2 f0.
Let p := difference v f0.
Definition face_collides : Prop :=
  vertex_face_collides (exact_motion v) (exact_motion f0) (exact_motion f1) (exact_motion f2).

Theorem bsc_face_separate : root_with_nonnegative (y_form b c p) (inside_face_forms b c p) = no -> ~ face_collides.
Proof. exact (query_bsc_separate false v f0 f1 f2). Qed.
Theorem bsc_face_collides : root_with_nonnegative (y_form b c p) (inside_face_forms b c p) = yes -> face_collides.
Proof. exact (query_bsc_collides false v f0 f1 f2). Qed.
Theorem face_rootless_separate : certainly_rootless (y_form b c p) = true -> ~ face_collides.
Proof. exact (query_rootless_separate false v f0 f1 f2). Qed.
Theorem face_outside_separate g : In g (inside_face_forms b c p) -> sign_throughout g = negative -> ~ face_collides.
Proof. exact (query_outside_separate false v f0 f1 f2 g). Qed.

End Face.

Section Edges.

Variables a0 a1 b0 b1 : moving_point.
Let b := difference a1 a0.
Let c := difference b1 b0.
Let p := difference b0 a0.
Definition edges_collide : Prop :=
  edge_edge_collides (exact_motion a0) (exact_motion a1) (exact_motion b0) (exact_motion b1).

Theorem bsc_edges_separate : root_with_nonnegative (y_form b c p) (inside_edges_forms b c p) = no -> ~ edges_collide.
Proof. exact (query_bsc_separate true a0 a1 b0 b1). Qed.
Theorem bsc_edges_collide : root_with_nonnegative (y_form b c p) (inside_edges_forms b c p) = yes -> edges_collide.
Proof. exact (query_bsc_collides true a0 a1 b0 b1). Qed.
Theorem edges_rootless_separate : certainly_rootless (y_form b c p) = true -> ~ edges_collide.
Proof. exact (query_rootless_separate true a0 a1 b0 b1). Qed.
Theorem edges_outside_separate g : In g (inside_edges_forms b c p) -> sign_throughout g = negative -> ~ edges_collide.
Proof. exact (query_outside_separate true a0 a1 b0 b1 g). Qed.

End Edges.

End Forms.

(** ** Axes that separate the features at both ends of the step: `separated` and swept boxes *)

(** The position of m along the axis n, at the start and at the end. *)
Definition before (n : point) (p q : moving) : Prop :=
  dot n (start p) < dot n (start q) /\ dot n (finish p) < dot n (finish q).

Lemma before_throughout n p q t : before n p q -> 0 <= t <= 1 -> 0 < dot n (minus (place q t) (place p
  t)).
Proof.
  intros (A & B) T.
  replace (dot _ _) with ((1 - t) * (dot n (start q) - dot n (start p)) + t * (dot n (finish q) - dot n
    (finish p)))
    by (unfold dot, minus, place; simpl; ring).
  destruct (Req_dec t 0) as [-> |]; [lra |].
  assert (0 <= (1 - t) * (dot n (start q) - dot n (start p))) by (apply Rmult_le_pos; lra).
  assert (0 < t * (dot n (finish q) - dot n (finish p))) by (apply Rmult_lt_0_compat; lra). lra.
Qed.

Theorem face_separated n v f0 f1 f2 : before n v f0 -> before n v f1 -> before n v f2 ->
  ~ vertex_face_collides v f0 f1 f2.
Proof.
  intros P0 P1 P2 (t & T & C). apply (Rlt_irrefl (dot n (place v t))), triangle_beyond with (1 := C);
    apply Rminus_gt_0_lt; rewrite <- dot_minus; now apply before_throughout.
Qed.

Theorem vertex_edge_separated n v e0 e1 : before n v e0 -> before n v e1 -> ~ vertex_edge_collides v e0 e1.
Proof.
  intros P0 P1 (t & T & H). apply (face_separated n v e0 e1 e1 P0 P1 P1). exists t. split; auto.
  apply face_at_a_time. right. now left.
Qed.

Theorem edges_separated n a0 a1 b0 b1 : before n a0 b0 -> before n a0 b1 -> before n a1 b0 -> before n a1
  b1 ->
  ~ edge_edge_collides a0 a1 b0 b1.
Proof.
  intros P00 P01 P10 P11 (t & T & M). revert M.
  apply (segments_apart n); apply Rminus_gt_0_lt; rewrite <- dot_minus; now apply before_throughout.
Qed.
