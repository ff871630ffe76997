(** Queries in integers, with a separate unit for each axis, and decisions by the coordinates themselves. Results:
        face_units, edges_units, vertex_edge_units   collisions do not depend on the axes' units
        vertices_contact_right   `vertices_touch` (ccd/exact/features.hpp) is true exactly if they meet
        separated_right          if `separated_by_coordinates` (ccd/exact/features.hpp) is true, vertex and edge do
                                 not meet *)

From Coq Require Import Reals ZArith Lra List Bool.
From Errbound Require Import Sign Bernstein Contact Decisions.
From Errbound Require BoundedInteger.
Import ListNotations.
Open Scope R_scope.

(** Exact integers as scalars of Bernstein.v. *)
Program Definition integers : scalar := {|
  number := Z; add := Z.add; sub := Z.sub; mul := Z.mul; opp := Z.opp; whole := fun n => n;
  twice := Z.mul 2; normalized := fun p => p; sign_of := BoundedInteger.sign_of_integer; exact := IZR;
  exact_add := plus_IZR; exact_sub := minus_IZR; exact_mul := mult_IZR; exact_opp := opp_IZR;
  exact_whole := fun n => eq_refl; exact_twice := mult_IZR 2;
  sign_right := BoundedInteger.sign_of_integer_right |}.
Next Obligation.
  exists 1. split; [lra |]. rewrite <- (map_id (map IZR p)) at 1. apply map_ext. intros. ring.
Qed.

(** ** Units *)

(** Every axis in a separate unit. *)
Definition stretched (k p : point) : point := Point (x k * x p) (y k * y p) (z k * z p).
Definition stretched_motion (k : point) (m : moving) : moving :=
  Moving (stretched k (start m)) (stretched k (finish m)).
Definition units (k : point) : Prop := 0 < x k /\ 0 < y k /\ 0 < z k.

Lemma place_stretched k m t : place (stretched_motion k m) t = stretched k (place m t).
Proof. unfold place, stretched_motion, stretched. apply same_point; simpl; ring. Qed.
Lemma stretched_same k p q : units k -> stretched k p = stretched k q <-> p = q.
Proof.
  intros (Kx & Ky & Kz). split; [| now intros ->]. intros E.
  apply point_eq in E. destruct E as (X & Y & Z). simpl in *.
  apply same_point; eapply Rmult_eq_reg_l; eauto; lra.
Qed.
Lemma stretched_along k p s a b :
  stretched k (along p s (minus a b)) = along (stretched k p) s (minus (stretched k a) (stretched k b)).
Proof. unfold stretched. coordinates. apply same_point; simpl; ring. Qed.
Lemma segment_stretched k p a b : units k ->
  in_segment (stretched k p) (stretched k a) (stretched k b) <-> in_segment p a b.
Proof.
  intros K. split; intros (u & U & E); exists u; split; auto; rewrite <- stretched_along in *;
    first [now apply -> (stretched_same k) in E | now rewrite E].
Qed.

Lemma triangle_stretched k p a b c : units k ->
  in_triangle (stretched k p) (stretched k a) (stretched k b) (stretched k c) <-> in_triangle p a b c.
Proof.
  intros K. split; intros (u & w & U & W & V & E); exists u, w; repeat (split; auto); rewrite <- !stretched_along in *;
    first [now apply -> (stretched_same k) in E | now rewrite E].
Qed.
Lemma segments_stretched k a0 a1 b0 b1 : units k ->
  segments_meet (stretched k a0) (stretched k a1) (stretched k b0) (stretched k b1) <-> segments_meet a0 a1 b0 b1.
Proof.
  intros K. split; intros (p & A & B).
  - destruct A as (u & U & ->). exists (along a0 u (minus a1 a0)). split; [now exists u |].
    rewrite <- stretched_along in B. now apply segment_stretched in B.
  - exists (stretched k p). now split; apply segment_stretched.
Qed.

Lemma sometime_same (H G : R -> Prop) : (forall t, H t <-> G t) -> sometime H <-> sometime G.
Proof. intros E. split; intros (t & T & X); exists t; (split; [exact T | now apply E]). Qed.
Theorem face_units k v f0 f1 f2 : units k -> let in_units := stretched_motion k in
  vertex_face_collides (in_units v) (in_units f0) (in_units f1) (in_units f2) <->
  vertex_face_collides v f0 f1 f2.
Proof. intros K. apply sometime_same. intros t. rewrite !place_stretched. now apply triangle_stretched. Qed.
Theorem edges_units k a0 a1 b0 b1 : units k -> let in_units := stretched_motion k in
  edge_edge_collides (in_units a0) (in_units a1) (in_units b0) (in_units b1) <->
  edge_edge_collides a0 a1 b0 b1.
Proof. intros K. apply sometime_same. intros t. rewrite !place_stretched. now apply segments_stretched. Qed.
Theorem vertex_edge_units k v e0 e1 : units k -> let in_units := stretched_motion k in
  vertex_edge_collides (in_units v) (in_units e0) (in_units e1) <-> vertex_edge_collides v e0 e1.
Proof. intros K. apply sometime_same. intros t. rewrite !place_stretched. now apply segment_stretched. Qed.

Lemma query_units k edges m0 m1 m2 m3 : units k -> let in_units := stretched_motion k in
  query_collides edges (in_units m0) (in_units m1) (in_units m2) (in_units m3) <-> query_collides edges m0 m1 m2 m3.
Proof. destruct edges; [exact (edges_units k m0 m1 m2 m3) | exact (face_units k m0 m1 m2 m3)]. Qed.
Lemma query_border_units k edges m0 m1 m2 m3 : units k -> let in_units := stretched_motion k in
  query_border edges (in_units m0) (in_units m1) (in_units m2) (in_units m3) <-> query_border edges m0 m1 m2 m3.
Proof.
  intros K. unfold query_border, edges_border_collides, face_border_collides.
  destruct edges; cbv zeta; now rewrite !(vertex_edge_units k).
Qed.

(** The motion m in integers. *)
Definition in_integers (k : point) (m : moving) (i : @moving_point integers) : Prop :=
  exact_motion i = stretched_motion k m.

(** ** Two vertices *)

(** vertices_touch of ccd/exact/features.hpp *)
Definition vertices_contact (v w : @moving_point integers) : bool :=
  let d := difference v w in
  let at_end (i : nat) :=
    @VectorForm integers [nth i (vx d) 0%Z] [nth i (vy d) 0%Z] [nth i (vz d) 0%Z] in
  let c := cross_form (at_end 0%nat) (at_end 1%nat) in
  let zero_first (f : list Z) := Z.eqb (nth 0 f 0%Z) 0 in
  zero_first (vx c) && zero_first (vy c) && zero_first (vz c) &&
    (nth 0 (dot_form (at_end 0%nat) (at_end 1%nat)) 0%Z <=? 0)%Z.
Theorem vertices_contact_right k m n v w : units k -> in_integers k m v -> in_integers k n w ->
  vertices_contact v w = true <-> vertex_vertex_collides m n.
Proof.
  intros K V W. assert (U : vertex_vertex_collides (exact_motion v) (exact_motion w) <-> vertex_vertex_collides m n).
  { rewrite V, W. split; intros (t & T & H); exists t; (split; [exact T |]); rewrite ?place_stretched in *;
      now apply (stretched_same k). }
  rewrite <- U, vertex_vertex_contact. clear.
  unfold vertices_contact, difference. cbn [vx vy vz nth].
  set (p0 := VectorForm _ _ _). set (p1 := VectorForm _ _ _).
  destruct (cross_at p0 p1 0 0 0) as (C & D); [now repeat split | now repeat split |].
  destruct (dot_at p0 p1 0 0 0) as (E & F); [now repeat split | now repeat split |].
  assert (At : forall f : list integers, length f = 1%nat -> at_time f 0 = IZR (nth 0 f 0%Z))
    by (intros f L; apply (@Bsc.at_start integers); now destruct f).
  replace (minus (start (exact_motion v)) (start (exact_motion w))) with (vector_at p0 0)
    by (unfold vector_at, p0, at_time, minus; apply same_point; cbn [x y z vx vy vz map form length];
      rewrite exact_sub; simpl; ring).
  replace (minus (finish (exact_motion v)) (finish (exact_motion w))) with (vector_at p1 0)
    by (unfold vector_at, p1, at_time, minus; apply same_point; cbn [x y z vx vy vz map form length];
      rewrite exact_sub; simpl; ring).
  rewrite <- C, <- E, At by exact F. destruct D as (Dx & Dy & Dz). unfold vector_at.
  rewrite !At by assumption. rewrite !andb_true_iff, !Z.eqb_eq, Z.leb_le. split.
  - intros (((X & Y) & Z) & P). split; [| now apply IZR_le].
    apply same_point; cbn [x y z origin]; apply (f_equal IZR); assumption.
  - intros (O & P). apply point_eq in O. cbn [x y z origin] in O. destruct O as (X & Y & Z).
    repeat split; [now apply eq_IZR | now apply eq_IZR | now apply eq_IZR | now apply le_IZR].
Qed.

(** ** SeparatingAxis *)

(** separated_by_coordinates (ccd/exact/features.hpp), of the coordinates as given *)
Definition less (a b : R) : bool := if Rlt_dec a b then true else false.
Definition separated_along (axis : point -> R) (v e0 e1 : moving) : bool :=
  let v0 := axis (start v) in let v1 := axis (finish v) in
  let a0 := axis (start e0) in let a1 := axis (finish e0) in
  let b0 := axis (start e1) in let b1 := axis (finish e1) in
  less a0 v0 && less a1 v1 && less b0 v0 && less b1 v1 ||
  less v0 a0 && less v1 a1 && less v0 b0 && less v1 b1.
Definition separated (v e0 e1 : moving) : bool :=
  separated_along x v e0 e1 || separated_along y v e0 e1 || separated_along z v e0 e1.

Theorem separated_right v e0 e1 : separated v e0 e1 = true -> ~ vertex_edge_collides v e0 e1.
Proof.
  assert (Less : forall c d, less c d = true -> c < d) by (intros c d; unfold less; now destruct
    Rlt_dec).
  assert (Along : forall axis n, (forall p, dot n p = axis p) -> separated_along axis v e0 e1 = true -> ~
    vertex_edge_collides v e0 e1).
  { intros axis n E P. unfold separated_along in P. apply orb_prop in P.
    assert (O : forall p, dot (minus origin n) p = - axis p) by (intros p; rewrite <- E; unfold minus,
      dot, origin; simpl; ring).
    destruct P as [P | P]; rewrite !andb_true_iff in P; destruct P as (((A & B) & C) & D); apply Less in
      A, B, C, D.
    - apply (vertex_edge_separated (minus origin n)); unfold before; rewrite !O; lra.
    - apply (vertex_edge_separated n); unfold before; rewrite !E; lra. }
  unfold separated. intros P. apply orb_prop in P.
  destruct P as [P | P]; [apply orb_prop in P; destruct P as [P | P] |].
  - apply (Along x (Point 1 0 0)); auto. intros p. unfold dot. simpl. ring.
  - apply (Along y (Point 0 1 0)); auto. intros p. unfold dot. simpl. ring.
  - apply (Along z (Point 0 0 1)); auto. intros p. unfold dot. simpl. ring.
Qed.
