(** The basis of the exact collision decisions, over the real numbers. A collision is one of the cases that
    ccd/exact/reference.cpp and ccd/exact/interior_contact.hpp test.

    Points move from start to finish in t from 0 to 1. A query collides if the closed features share a point at some
    t in [0, 1] (include/ccd/query.hpp), including degenerate triangles and edges. Results:
        vertex_edge_contact, vertex_vertex_contact   the code's tests are equivalent to contact
        vertex_face_union, edge_edge_union   contact with a nonzero normal, or vertex/edge contact
        face_inside, edges_inside            without vertex/edge contact: all weights are positive
        face_coplanar, edges_coplanar        Y = 0 throughout: contact at t = 0, or vertex/edge contact
        query_...       the same for either query *)

From Coq Require Import Reals Lra Psatz List FunctionalExtensionality.
Import ListNotations.
Open Scope R_scope.

(** ** Space *)

Record point := Point { x : R; y : R; z : R }.
Definition minus (p q : point) : point := Point (x p - x q) (y p - y q) (z p - z q).
(** p + s v *)
Definition along (p : point) (s : R) (v : point) : point := Point (x p + s * x v) (y p + s * y v) (z p +
  s * z v).
Definition dot (p q : point) : R := x p * x q + y p * y q + z p * z q.
Definition cross (p q : point) : point :=
  Point (y p * z q - z p * y q) (z p * x q - x p * z q) (x p * y q - y p * x q).
Definition origin : point := Point 0 0 0.

Definition in_segment (p a b : point) : Prop := exists u, 0 <= u <= 1 /\ p = along a u (minus b a).
Definition in_triangle (p a b c : point) : Prop :=
  exists u v, 0 <= u /\ 0 <= v /\ u + v <= 1 /\ p = along (along a u (minus b a)) v (minus c a).
Definition segments_meet (a0 a1 b0 b1 : point) : Prop := exists p, in_segment p a0 a1 /\ in_segment p b0
  b1.

Ltac coordinates := unfold along, minus, cross, dot, origin in *; cbn [x y z] in *.
Lemma same_point p q : x p = x q -> y p = y q -> z p = z q -> p = q.
Proof. destruct p, q. simpl. now intros -> -> ->. Qed.
Lemma point_eq p q : p = q -> x p = x q /\ y p = y q /\ z p = z q.
Proof. now intros ->. Qed.
(** Proves equations of vectors or of their products, also from such equations. *)
Ltac vector := repeat match goal with H : @eq point _ _ |- _ => apply point_eq in H end;
  coordinates; try apply same_point; cbn [x y z]; ring || lra.

Lemma square_0 v : dot v v = 0 -> v = origin.
Proof. destruct v as [a b c]. coordinates. intros H. apply same_point; simpl; nra. Qed.
Lemma square_positive v : v <> origin -> 0 < dot v v.
Proof.
  intros N. destruct (Rle_lt_or_eq_dec 0 (dot v v)) as [| E]; [unfold dot; nra | easy |].
  now rewrite (square_0 v (eq_sym E)) in N.
Qed.
Lemma origin_dec v : v = origin \/ v <> origin.
Proof.
  destruct (Req_dec (dot v v) 0) as [E | E]; [left; now apply square_0 | right].
  intros ->. apply E. coordinates. ring.
Qed.

(** A point of a triangle or of a segment is as far along n as one of the corners. *)
Lemma dot_minus n p q : dot n (minus p q) = dot n p - dot n q.
Proof. coordinates. ring. Qed.
Lemma dot_opposite n q : dot (along origin (-1) n) q = - dot n q.
Proof. coordinates. ring. Qed.
Lemma triangle_beyond n r p a b c : in_triangle p a b c -> r < dot n a -> r < dot n b -> r < dot n c -> r < dot n p.
Proof.
  intros (u & v & U & V & W & ->) A B C. set (e := Rmin (dot n a) (Rmin (dot n b) (dot n c))).
  assert (L : r < e) by now repeat apply Rmin_glb_lt. apply Rlt_le_trans with (1 := L).
  pose proof (Rmin_l (dot n a) (Rmin (dot n b) (dot n c))) as Ea. fold e in Ea.
  pose proof (Rmin_r (dot n a) (Rmin (dot n b) (dot n c))) as Er. fold e in Er.
  pose proof (Rmin_l (dot n b) (dot n c)). pose proof (Rmin_r (dot n b) (dot n c)).
  replace (dot n (along _ _ _)) with ((1 - u - v) * (dot n a - e) + u * (dot n b - e) + v * (dot n c - e) + e)
    by (clearbody e; coordinates; ring).
  assert (0 <= (1 - u - v) * (dot n a - e)) by (apply Rmult_le_pos; lra).
  assert (0 <= u * (dot n b - e)) by (apply Rmult_le_pos; lra).
  assert (0 <= v * (dot n c - e)) by (apply Rmult_le_pos; lra). lra.
Qed.
Lemma segment_beyond n r p a b : in_segment p a b -> r < dot n a -> r < dot n b -> r < dot n p.
Proof.
  intros (u & U & ->) A B. apply (triangle_beyond n r _ a b a); auto. exists u, 0. repeat split; try lra. vector.
Qed.
Lemma segments_apart n a0 a1 b0 b1 : dot n a0 < dot n b0 -> dot n a0 < dot n b1 -> dot n a1 < dot n b0 ->
  dot n a1 < dot n b1 -> ~ segments_meet a0 a1 b0 b1.
Proof.
  intros A00 A01 A10 A11 (p & A & B). apply (Rlt_irrefl (- dot n p)). rewrite <- dot_opposite at 2.
  apply segment_beyond with (1 := A); rewrite dot_opposite; apply Ropp_lt_contravar, segment_beyond with (1 := B); auto.
Qed.

(** Vectors whose cross product vanishes are parallel. *)
Lemma parallel v w : v <> origin -> cross v w = origin -> exists k, w = along origin k v.
Proof.
  intros N H. apply square_positive in N. exists (dot v w / dot v v). apply point_eq in H.
  destruct v as [a b c], w as [d e f]. coordinates. destruct H as (H0 & H1 & H2).
  apply same_point; simpl; apply Rmult_eq_reg_r with (a * a + b * b + c * c); try lra; field_simplify;
    try lra;
    apply Rminus_diag_uniq.
  - transitivity (c * (c * d - a * f) - b * (a * e - b * d)); [ring | rewrite H1, H2; ring].
  - transitivity (a * (a * e - b * d) - c * (b * f - c * e)); [ring | rewrite H0, H2; ring].
  - transitivity (b * (b * f - c * e) - a * (c * d - a * f)); [ring | rewrite H0, H1; ring].
Qed.

(** ** Contact at one time *)

(** B, C, P as in the paper, and N = B x C. *)
Definition det (b c p : point) : R := dot (cross b c) p.

(** The code's inside() of a face, as functions of b, c, p: the weights of f2, f1, f0 times |N|^2. *)
Definition weight_2 (b c p : point) : R := dot (cross b p) (cross b c).
Definition weight_1 (b c p : point) : R := dot (cross p c) (cross b c).
Definition weight_0 (b c p : point) : R := dot (cross b c) (cross b c) - weight_1 b c p - weight_2 b c
  p.
(** The code's inside() of two edges. *)
Definition on_a (b c p : point) : R := dot (cross p c) (cross b c).
Definition on_b (b c p : point) : R := dot (cross p b) (cross b c).
Definition square_normal (b c : point) : R := dot (cross b c) (cross b c).

(** P in the basis B, C, N. *)
Lemma decomposed b c p : let n := cross b c in
  along (along (along origin (- dot n n) p) (weight_1 b c p) b) (weight_2 b c p) c = along origin (- det
    b c p) n.
Proof.
  unfold weight_1, weight_2, det. vector.
Qed.

Lemma face_at_normal p a b c : let B := minus b a in let C := minus c a in let P := minus p a in
  cross B C <> origin -> det B C P = 0 ->
  p = along (along a (weight_1 B C P / square_normal B C) B) (weight_2 B C P / square_normal B C) C.
Proof.
  intros B C P N Y. apply square_positive in N. pose proof (decomposed B C P) as D. cbv zeta in D.
  rewrite Y in D. apply point_eq in D. unfold square_normal.
  set (n2 := dot (cross B C) (cross B C)) in *.
  set (u := weight_1 B C P) in *. set (v := weight_2 B C P) in *.
  destruct D as (D0 & D1 & D2). unfold along, origin in D0, D1, D2. cbn [x y z] in D0, D1, D2.
  assert (Ep : x p = x a + x P /\ y p = y a + y P /\ z p = z a + z P) by (unfold P, minus; simpl; lra).
  destruct Ep as (E0 & E1 & E2).
  unfold along. apply same_point; cbn [x y z]; apply Rmult_eq_reg_r with n2; try lra;
    [rewrite E0 | rewrite E1 | rewrite E2]; field_simplify; lra.
Qed.

(** The weights of a point of the triangle. *)
Lemma weights_of a b c p u v : p = along (along a u (minus b a)) v (minus c a) ->
  let B := minus b a in let C := minus c a in let P := minus p a in
  det B C P = 0 /\ weight_1 B C P = u * square_normal B C /\ weight_2 B C P = v * square_normal B C.
Proof.
  intros -> B C P. unfold B, C, P, det, weight_1, weight_2, square_normal.
  destruct a, b, c. coordinates. repeat split; ring.
Qed.

(** A degenerate triangle is one of its edges. *)
Lemma degenerate a b c : cross (minus b a) (minus c a) = origin ->
  in_segment c a b \/ in_segment b a c \/ in_segment a b c.
Proof.
  intros H. destruct (origin_dec (minus b a)) as [E | N].
  - right. left. exists 0. split; [lra |]. vector.
  - destruct (parallel _ _ N H) as (k & E). apply point_eq in E.
    destruct a as [a0 a1 a2], b as [b0 b1 b2], c as [c0 c1 c2].
    coordinates. destruct E as (E0 & E1 & E2).
    destruct (Rle_or_lt 0 k) as [K | K]; [destruct (Rle_or_lt k 1) as [L | L] |].
    + left. exists k. split; [lra |]. apply same_point; simpl; lra.
    + right. left. exists (/ k). split.
      { split; [left; apply Rinv_0_lt_compat; lra |]. rewrite <- Rinv_1. apply Rinv_le_contravar; lra. }
      apply same_point; simpl; apply Rmult_eq_reg_r with k; try lra; field_simplify; try lra.
    + right. right. exists (/ (1 - k)). split.
      { split; [left; apply Rinv_0_lt_compat; lra |]. rewrite <- Rinv_1. apply Rinv_le_contravar; lra. }
      apply same_point; simpl; apply Rmult_eq_reg_r with (1 - k); try lra; field_simplify; try lra.
Qed.

Lemma segment_sym p a b : in_segment p a b -> in_segment p b a.
Proof.
  intros (u & U & ->). exists (1 - u). split; [lra |]. vector.
Qed.
(** A triangle one of whose vertices lies on the opposite edge is that edge. *)
Lemma covered p a b c : in_triangle p a b c -> in_segment c a b -> in_segment p a b.
Proof.
  intros (u & v & U & V & W & ->) (k & K & ->). exists (u + v * k). split; [nra |].
  vector.
Qed.
Lemma triangle_swap p a b c : in_triangle p a b c -> in_triangle p a c b.
Proof.
  intros (u & v & U & V & W & ->). exists v, u. repeat split; try lra.
  vector.
Qed.
Lemma triangle_turn p a b c : in_triangle p a b c -> in_triangle p b c a.
Proof.
  intros (u & v & U & V & W & ->). exists v, (1 - u - v). repeat split; try lra.
  vector.
Qed.

(** Contact in the interior of a face, as the code tests it. *)
Definition regular_face (p a b c : point) : Prop :=
  let B := minus b a in let C := minus c a in let P := minus p a in
  cross B C <> origin /\ det B C P = 0 /\ 0 <= weight_2 B C P /\ 0 <= weight_1 B C P /\ 0 <= weight_0 B
    C P.
Definition face_border (p a b c : point) : Prop := in_segment p a b \/ in_segment p b c \/ in_segment p
  c a.

Lemma face_at_a_time p a b c : in_triangle p a b c <-> regular_face p a b c \/ face_border p a b c.
Proof.
  split.
  - intros T. destruct (origin_dec (cross (minus b a) (minus c a))) as [E | N].
    + right. destruct (degenerate a b c E) as [D | [D | D]].
      * left. now apply covered with c.
      * right. right. apply segment_sym. apply covered with b; auto. now apply triangle_swap.
      * right. left. apply covered with a; auto. now apply triangle_turn.
    + left. destruct T as (u & v & U & V & W & E). split; auto.
      destruct (weights_of a b c p u v E) as (Y & W1 & W2). split; auto. unfold weight_0.
      rewrite W1, W2. apply square_positive in N. unfold square_normal in *.
      assert (0 <= (1 - u - v) * dot (cross (minus b a) (minus c a)) (cross (minus b a) (minus c a)))
        by (apply Rmult_le_pos; lra). repeat split; nra.
  - intros [(N & Y & W2 & W1 & W0) | [(u & U & E) | [(u & U & E) | (u & U & E)]]].
    + pose proof (face_at_normal p a b c N Y) as E. apply square_positive in N.
      fold (square_normal (minus b a) (minus c a)) in N.
      set (n2 := square_normal (minus b a) (minus c a)) in *. unfold weight_0 in W0. fold (square_normal
        (minus b a) (minus c a)) in W0.
      fold n2 in W0. do 2 eexists. repeat split; [| | | exact E];
        try (apply Rmult_le_pos; auto; left; now apply Rinv_0_lt_compat).
      apply Rmult_le_reg_r with n2; auto. field_simplify; lra.
    + exists u, 0. repeat split; try lra. rewrite E. vector.
    + exists (1 - u), u. repeat split; try lra. rewrite E. vector.
    + exists 0, (1 - u). repeat split; try lra. rewrite E. vector.
Qed.

(** Contact in the interior of two edges, as the code tests it. *)
Definition regular_edges (a0 a1 b0 b1 : point) : Prop :=
  let B := minus a1 a0 in let C := minus b1 b0 in let P := minus b0 a0 in
  cross B C <> origin /\ det B C P = 0 /\ 0 <= on_a B C P /\ 0 <= square_normal B C - on_a B C P /\
  0 <= on_b B C P /\ 0 <= square_normal B C - on_b B C P.
Definition edges_border (a0 a1 b0 b1 : point) : Prop :=
  in_segment a0 b0 b1 \/ in_segment a1 b0 b1 \/ in_segment b0 a0 a1 \/ in_segment b1 a0 a1.

Lemma edges_at_normal a0 a1 b0 b1 : let B := minus a1 a0 in let C := minus b1 b0 in let P := minus b0 a0
  in
  cross B C <> origin -> det B C P = 0 ->
  along a0 (on_a B C P / square_normal B C) B = along b0 (on_b B C P / square_normal B C) C.
Proof.
  intros B C P N Y. assert (Tip : forall v, minus (along a0 1 v) a0 = v) by (intros v; vector).
  pose proof (face_at_normal b0 a0 (along a0 1 B) (along a0 1 C)) as E. cbv zeta in E. rewrite !Tip in E.
  specialize (E N Y). fold P in E. replace (on_b B C P) with (- weight_2 B C P) by (unfold on_b, weight_2; vector).
  unfold on_a. fold (weight_1 B C P). unfold Rdiv in *. clearbody P. vector.
Qed.

Lemma weights_at_meeting a0 a1 b0 b1 s t : along a0 s (minus a1 a0) = along b0 t (minus b1 b0) ->
  let B := minus a1 a0 in let C := minus b1 b0 in let P := minus b0 a0 in
  det B C P = 0 /\ on_a B C P = s * square_normal B C /\ on_b B C P = t * square_normal B C.
Proof.
  intros E B C P. fold B C in E. apply point_eq in E.
  assert (Ep : P = along (along origin s B) (- t) C).
  { unfold P. clearbody B C. destruct E as (E0 & E1 & E2). vector. }
  rewrite Ep. clearbody B C. unfold det, on_a, on_b, square_normal. destruct B, C. coordinates.
  repeat split; ring.
Qed.

(** In contact, Y = 0 and no weight is negative. *)
Lemma touching_conditions p a b c : in_triangle p a b c ->
  let B := minus b a in let C := minus c a in let P := minus p a in
  det B C P = 0 /\ 0 <= weight_2 B C P /\ 0 <= weight_1 B C P /\ 0 <= weight_0 B C P.
Proof.
  intros (u & w & U & W & UW & E) B C P. destruct (weights_of a b c p u w E) as (Y & W1 & W2).
  fold B C P in Y, W1, W2. unfold weight_0. fold (square_normal B C). rewrite W1, W2.
  assert (0 <= square_normal B C) by (unfold square_normal, dot; nra).
  assert (0 <= (1 - u - w) * square_normal B C) by (apply Rmult_le_pos; lra).
  repeat split; auto; nra.
Qed.
Lemma meeting_conditions a0 a1 b0 b1 : segments_meet a0 a1 b0 b1 ->
  let B := minus a1 a0 in let C := minus b1 b0 in let P := minus b0 a0 in
  det B C P = 0 /\ 0 <= on_a B C P /\ 0 <= square_normal B C - on_a B C P /\
  0 <= on_b B C P /\ 0 <= square_normal B C - on_b B C P.
Proof.
  intros M B C P. destruct M as (q & (s & S & Ea) & (t & T & Eb)).
  destruct (weights_at_meeting a0 a1 b0 b1 s t) as (Y & Oa & Ob); [now rewrite <- Ea |].
  fold B C P in Y, Oa, Ob. rewrite Oa, Ob.
  assert (0 <= square_normal B C) by (unfold square_normal, dot; nra).
  repeat split; auto; nra.
Qed.

(** On a line, with edge a from 0 to 1 and edge b from m to m + k. *)
Lemma line_meeting s t m k : 0 <= s <= 1 -> 0 <= t <= 1 -> s = m + t * k -> k <> 0 ->
  0 <= m <= 1 \/ 0 <= - m / k <= 1 \/ 0 <= (1 - m) / k <= 1.
Proof.
  intros S T E K.
  assert (Q : forall a q, q * k = a -> (0 <= a <= k \/ k <= a <= 0) -> 0 <= q <= 1).
  { intros a q <- H. destruct (Rtotal_order k 0) as [N | [N | N]]; try easy; split; nra. }
  destruct (Rle_or_lt 0 m) as [M | M]; [destruct (Rle_or_lt m 1) as [L | L]; [now left |] |].
  - right. right. apply (Q (1 - m)); [now field |]. right. nra.
  - right. left. apply (Q (- m)); [now field |]. left. nra.
Qed.

Lemma edges_at_a_time a0 a1 b0 b1 :
  segments_meet a0 a1 b0 b1 <-> regular_edges a0 a1 b0 b1 \/ edges_border a0 a1 b0 b1.
Proof.
  split.
  - intros (p & (s & S & Ea) & (t & T & Eb)).
    destruct (origin_dec (cross (minus a1 a0) (minus b1 b0))) as [E | N].
    + right. destruct (origin_dec (minus a1 a0)) as [Ez | Na].
      { left. exists t. split; auto. rewrite <- Eb, Ea. apply point_eq in Ez.
        destruct Ez as (Z0 & Z1 & Z2).
        unfold along. rewrite Z0, Z1, Z2. destruct a0. simpl. apply same_point; simpl; ring. }
      destruct (origin_dec (minus b1 b0)) as [Ez | Nb].
      { right. right. left. exists s. split; auto. rewrite <- Ea, Eb. apply point_eq in Ez.
        destruct Ez as (Z0 & Z1 & Z2).
        unfold along. rewrite Z0, Z1, Z2. destruct b0. simpl. apply same_point; simpl; ring. }
      destruct (parallel _ _ Na E) as (k & Ek).
      assert (K : k <> 0) by (intros ->; apply Nb; rewrite Ek; vector).
      rewrite Ea in Eb. apply point_eq in Eb, Ek.
      destruct a0 as [p0 p1 p2], a1 as [q0 q1 q2], b0 as [r0 r1 r2], b1 as [w0 w1 w2]. coordinates.
      destruct Eb as (E0 & E1 & E2), Ek as (K0 & K1 & K2).
      destruct (line_meeting s t (s - t * k) k S T ltac:(ring) K) as [M | [M | M]].
      * right. right. left. exists (s - t * k). split; auto. coordinates.
        rewrite K0 in E0. rewrite K1 in E1. rewrite K2 in E2. apply same_point; simpl; lra.
      * left. exists (- (s - t * k) / k). split; auto. coordinates.
        rewrite K0 in *. rewrite K1 in *. rewrite K2 in *. apply same_point; simpl;
          field_simplify; try easy; try lra; rewrite ?Rplus_0_l in *; nra.
      * right. left. exists ((1 - (s - t * k)) / k). split; auto. coordinates.
        rewrite K0 in *. rewrite K1 in *. rewrite K2 in *. apply same_point; simpl;
          field_simplify; try easy; try lra; rewrite ?Rplus_0_l in *; nra.
    + left. split; auto.
      destruct (weights_at_meeting a0 a1 b0 b1 s t) as (Y & Oa & Ob); [now rewrite <- Ea |]. rewrite Oa,
        Ob. apply square_positive in N. fold (square_normal (minus a1 a0) (minus b1 b0)) in N.
      repeat split; auto; nra.
  - intros [(N & Y & A0 & A1 & B0 & B1) | [M | [M | [M | M]]]].
    + pose proof (edges_at_normal a0 a1 b0 b1 N Y) as E. apply square_positive in N. fold (square_normal
        (minus a1 a0) (minus b1 b0)) in N.
      set (n2 := square_normal (minus a1 a0) (minus b1 b0)) in *. cbv zeta in E. fold n2 in E.
      eexists. split; [eexists; split; [| reflexivity] | eexists; split; [| exact E]];
        (split; [apply Rmult_le_pos; auto; left; now apply Rinv_0_lt_compat |
                 apply Rmult_le_reg_r with n2; auto; field_simplify; lra]).
    + exists a0. split; auto. exists 0. split; [lra |]. vector.
    + exists a1. split; auto. exists 1. split; [lra |]. vector.
    + exists b0. split; auto. exists 0. split; [lra |]. vector.
    + exists b1. split; auto. exists 1. split; [lra |]. vector.
Qed.

(** Vertex/edge contact as the code tests it: W x E = 0 and W X <= 0, with W = v - e0, X = v - e1. *)
Definition vertex_edge_test (v e0 e1 : point) : Prop :=
  cross (minus v e0) (minus e1 e0) = origin /\ dot (minus v e0) (minus v e1) <= 0.

Theorem vertex_edge_contact v e0 e1 : in_segment v e0 e1 <-> vertex_edge_test v e0 e1.
Proof.
  split.
  - intros (u & U & ->). unfold vertex_edge_test. split.
    + vector.
    + replace (dot _ _) with (- (u * (1 - u) * dot (minus e1 e0) (minus e1 e0)))
        by (destruct e0, e1; coordinates; ring).
      assert (0 <= dot (minus e1 e0) (minus e1 e0)) by (unfold dot; nra).
      assert (0 <= u * (1 - u) * dot (minus e1 e0) (minus e1 e0)) by (apply Rmult_le_pos; nra). lra.
  - intros (C & D). destruct (origin_dec (minus e1 e0)) as [E | N].
    + assert (Z : minus v e0 = origin).
      { apply square_0.
        replace (dot (minus v e0) (minus v e0)) with (dot (minus v e0) (minus v e1)) in *.
        - assert (0 <= dot (minus v e0) (minus v e0)) by (unfold dot; nra).
          assert (X : minus v e1 = minus v e0).
          { vector. }
          rewrite X in *. lra.
        - f_equal. vector. }
      exists 0. split; [lra |]. vector.
    + assert (C' : cross (minus e1 e0) (minus v e0) = origin).
      { vector. }
      destruct (parallel _ _ N C') as (k & K). exists k.
      assert (Ev : v = along e0 k (minus e1 e0)).
      { vector. }
      split; auto. apply square_positive in N. rewrite Ev in D.
      replace (dot _ _) with (- (k * (1 - k) * dot (minus e1 e0) (minus e1 e0))) in D
        by (destruct e0, e1; coordinates; ring).
      assert (0 <= k * (1 - k)) by (apply Rmult_le_reg_r with (dot (minus e1 e0) (minus e1 e0)); lra).
        nra.
Qed.

(** ** Queries: include/ccd/query.hpp *)

Record moving := Moving { start : point; finish : point }.
Definition place (m : moving) (t : R) : point := Point
  ((1 - t) * x (start m) + t * x (finish m)) ((1 - t) * y (start m) + t * y (finish m))
  ((1 - t) * z (start m) + t * z (finish m)).

Definition sometime (contact : R -> Prop) : Prop := exists t, 0 <= t <= 1 /\ contact t.
Definition vertex_face_collides (v f0 f1 f2 : moving) : Prop :=
  sometime (fun t => in_triangle (place v t) (place f0 t) (place f1 t) (place f2 t)).
Definition edge_edge_collides (a0 a1 b0 b1 : moving) : Prop :=
  sometime (fun t => segments_meet (place a0 t) (place a1 t) (place b0 t) (place b1 t)).
Definition vertex_edge_collides (v e0 e1 : moving) : Prop :=
  sometime (fun t => in_segment (place v t) (place e0 t) (place e1 t)).
Definition vertex_vertex_collides (v w : moving) : Prop := sometime (fun t => place v t = place w t).

(** vertex_edge_queries of include/ccd/methods/transform.hpp *)
Definition face_border_collides (v f0 f1 f2 : moving) : Prop :=
  vertex_edge_collides v f0 f1 \/ vertex_edge_collides v f1 f2 \/ vertex_edge_collides v f2 f0.
Definition edges_border_collides (a0 a1 b0 b1 : moving) : Prop :=
  vertex_edge_collides a0 b0 b1 \/ vertex_edge_collides a1 b0 b1 \/
  vertex_edge_collides b0 a0 a1 \/ vertex_edge_collides b1 a0 a1.
(** regular_contact of ccd/exact/reference.cpp, at all times *)
Definition face_regular_at (v f0 f1 f2 : moving) (t : R) : Prop :=
  regular_face (place v t) (place f0 t) (place f1 t) (place f2 t).
Definition edges_regular_at (a0 a1 b0 b1 : moving) (t : R) : Prop :=
  regular_edges (place a0 t) (place a1 t) (place b0 t) (place b1 t).

Theorem vertex_face_union v f0 f1 f2 : vertex_face_collides v f0 f1 f2 <->
  sometime (face_regular_at v f0 f1 f2) \/ face_border_collides v f0 f1 f2.
Proof.
  unfold vertex_face_collides, face_border_collides, vertex_edge_collides, face_regular_at, sometime.
    split.
  - intros (t & T & C). apply face_at_a_time in C. unfold face_border in C.
    destruct C as [C | [C | [C | C]]]; eauto 8.
  - intros [(t & T & C) | [(t & T & C) | [(t & T & C) | (t & T & C)]]]; exists t; split; auto;
      apply face_at_a_time; unfold face_border; auto.
Qed.
Theorem edge_edge_union a0 a1 b0 b1 : edge_edge_collides a0 a1 b0 b1 <->
  sometime (edges_regular_at a0 a1 b0 b1) \/ edges_border_collides a0 a1 b0 b1.
Proof.
  unfold edge_edge_collides, edges_border_collides, vertex_edge_collides, edges_regular_at, sometime.
    split.
  - intros (t & T & C). apply edges_at_a_time in C. unfold edges_border in C.
    destruct C as [C | [C | [C | [C | C]]]]; eauto 9.
  - intros [(t & T & C) | [(t & T & C) | [(t & T & C) | [(t & T & C) | (t & T & C)]]]]; exists t; split;
      auto;
      apply edges_at_a_time; unfold edges_border; auto.
Qed.

(** W(t) = 0 for a linear W: the ends are antiparallel, or one of them is zero. *)
Theorem vertex_vertex_contact v w : vertex_vertex_collides v w <->
  cross (minus (start v) (start w)) (minus (finish v) (finish w)) = origin /\
  dot (minus (start v) (start w)) (minus (finish v) (finish w)) <= 0.
Proof.
  assert (E : forall t, place v t = place w t <->
    along (along origin (1 - t) (minus (start v) (start w))) t (minus (finish v) (finish w)) = origin).
  { intros t. split; intros H; apply point_eq in H; unfold place, along, minus, origin in *; cbn [x y z]
      in *;
      apply same_point; cbn [x y z]; lra. }
  set (p := minus (start v) (start w)) in *. set (q := minus (finish v) (finish w)) in *. clearbody p q.
  unfold vertex_vertex_collides, sometime. split.
  - intros (t & T & H). apply E, point_eq in H. destruct p as [a b c], q as [d e f]. coordinates.
    destruct H as (H0 & H1 & H2). destruct (Req_dec t 0) as [-> | Nt].
    { assert (a = 0) by lra. assert (b = 0) by lra. assert (c = 0) by lra. subst.
      split; [apply same_point; simpl; ring | lra]. }
    assert (Q : forall g h, 0 + (1 - t) * g + t * h = 0 -> h = - ((1 - t) / t) * g)
      by (intros g h Z; apply Rmult_eq_reg_r with t; auto; field_simplify; auto; lra).
    rewrite (Q _ _ H0), (Q _ _ H1), (Q _ _ H2). split; [apply same_point; simpl; ring |].
    assert (0 <= (1 - t) / t) by (apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra]).
    assert (0 <= (1 - t) / t * (a * a + b * b + c * c)) by (apply Rmult_le_pos; nra). lra.
  - intros (C & D). destruct (origin_dec p) as [-> | N].
    { exists 0. split; [lra |]. apply E. vector. }
    destruct (parallel _ _ N C) as (k & K). subst q. apply square_positive in N.
    assert (k <= 0) by (destruct p; coordinates; nra).
    exists (1 / (1 - k)). split.
    { split; [apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra] |].
      apply Rmult_le_reg_r with (1 - k); [lra |]. field_simplify; lra. }
    apply E. destruct p. coordinates. apply same_point; simpl; field; lra.
Qed.

(** ** Coplanar motion: contact is followed back in time *)

(** From a time with f > 0 back to the last one at which f = 0. *)
Lemma last_zero f b : continuity f -> 0 <= b -> f 0 <= 0 -> 0 < f b ->
  exists s, 0 <= s < b /\ f s = 0 /\ forall t, s < t <= b -> 0 < f t.
Proof.
  intros C B F0 Fb. set (E := fun t => 0 <= t <= b /\ f t <= 0).
  destruct (completeness E) as (s & Up & Least).
  { exists b. intros t (T & _). lra. }
  { exists 0. split; [lra | easy]. }
  assert (S0 : 0 <= s) by (apply Up; split; [lra | easy]).
  assert (Sb : s <= b) by (apply Least; intros t (T & _); lra).
  assert (Near : f s <> 0 -> exists d, 0 < d /\ forall t, Rabs (t - s) < d -> Rabs (f t - f s) < Rabs (f
    s)).
  { intros N. destruct (C s (Rabs (f s)) (Rabs_pos_lt _ N)) as (d & D & H). exists d. split; auto.
    intros t T. destruct (Req_dec t s) as [-> | Ne]; [rewrite Rminus_diag_eq, Rabs_R0 by easy; now apply
      Rabs_pos_lt |].
    apply H. split; [split; [exact I | congruence] | exact T]. }
  assert (After : forall t, s < t <= b -> 0 < f t).
  { intros t T. destruct (Rlt_or_le 0 (f t)) as [| H]; auto.
    assert (t <= s) by (apply Up; split; [lra | easy]). lra. }
  assert (Zs : f s = 0).
  { destruct (Req_dec (f s) 0) as [| N]; auto. destruct (Near N) as (d & D & H).
    destruct (Rlt_or_le (f s) 0) as [L | L].
    - assert (s <> b) by (intros ->; lra). set (t := Rmin b (s + d / 2)).
      assert (T : s < t <= b /\ t <= s + d / 2) by (unfold t, Rmin; destruct (Rle_dec b (s + d / 2));
        lra).
      specialize (After t (proj1 T)). specialize (H t ltac:(rewrite Rabs_pos_eq; lra)).
      rewrite (Rabs_left (f s)) in H by easy. apply Rabs_def2 in H. lra.
    - assert (P : 0 < f s) by lra. exfalso. enough (s <= s - d / 2) by lra. apply Least.
      intros t (T & Ft). destruct (Rle_or_lt t (s - d / 2)); auto.
      assert (t <= s) by (apply Up; now split). specialize (H t ltac:(rewrite Rabs_left1; lra)).
      rewrite (Rabs_pos_eq (f s)) in H by lra. apply Rabs_def2 in H. lra. }
  exists s. repeat split; auto. destruct Sb as [| ->]; auto. lra.
Qed.

(** Contact that does not hold at t = 0 began at a time with f = 0. *)
Lemma begins f (contact : R -> Prop) b : continuity f -> 0 <= b <= 1 -> 0 < f b -> f 0 <= 0 ->
  (forall t, 0 <= t <= 1 -> 0 < f t -> contact t) ->
  (forall s, 0 <= s < b -> f s = 0 -> (forall t, s < t <= b -> contact t) -> contact s) ->
  exists s, 0 <= s <= 1 /\ f s = 0 /\ contact s.
Proof.
  intros C B Fb F0 P Closed. destruct (last_zero f b C ltac:(lra) F0 Fb) as (s & Hs & Z & After).
  exists s. split; [lra |]. split; auto. apply Closed; auto. intros t T. apply P; [lra | auto].
Qed.

(** A point off a segment is separated from it by a plane. *)
Lemma off_segment p a b : in_segment p a b \/ exists n, 0 < dot n (minus a p) /\ 0 < dot n (minus b p).
Proof.
  set (e := minus b a). set (w := minus a p).
  assert (Eb : minus b p = along w 1 e) by (unfold e, w, along, minus; simpl; apply same_point; simpl;
    ring).
  assert (Ep : forall u, p = along a u e <-> along origin (- u) e = w).
  { intros u. unfold w, along, minus, origin.
    split; intros H; apply point_eq in H; cbn [x y z] in H; apply same_point; cbn [x y z]; lra. }
  rewrite Eb. unfold in_segment. fold e. clearbody e w. clear Eb.
  destruct (origin_dec e) as [-> | N].
  { destruct (origin_dec w) as [-> | Nw].
    - left. exists 0. split; [lra |]. apply Ep. vector.
    - right. exists w. apply square_positive in Nw. split; auto.
      replace (dot w (along w 1 origin)) with (dot w w); auto. vector. }
  apply square_positive in N. set (m := dot w e / dot e e). set (n := along w (- m) e).
  assert (Pn : dot n e = 0) by (unfold n, m, dot, along in *; simpl in *; field; lra).
  destruct (origin_dec n) as [Z | Nn].
  - assert (Ew : w = along origin m e).
    { unfold n in Z. vector. }
    assert (D0 : dot e w = m * dot e e) by (rewrite Ew; vector).
    assert (D1 : dot e (along w 1 e) = (m + 1) * dot e e) by (rewrite Ew; vector).
    assert (Opp : forall q, dot (along origin (-1) e) q = - dot e q) by (intros q; vector).
    destruct (Rlt_or_le 0 m) as [M | M]; [right; exists e; rewrite D0, D1; split; apply
      Rmult_lt_0_compat; lra |].
    destruct (Rlt_or_le m (-1)) as [L | L].
    + right. exists (along origin (-1) e). rewrite !Opp, D0, D1. split; nra.
    + left. exists (- m). split; [lra |]. apply Ep. rewrite Ew. f_equal. ring.
  - right. exists n. apply square_positive in Nn.
    assert (D : dot n w = dot n n).
    { transitivity (dot n n + m * dot n e); [unfold n, dot, along; simpl; ring | rewrite Pn; ring]. }
    split; [lra |]. replace (dot n (along w 1 e)) with (dot n w + dot n e) by vector. lra.
Qed.

Lemma off_degenerate p a b c : cross (minus b a) (minus c a) = origin ->
  in_triangle p a b c \/ exists n, 0 < dot n (minus a p) /\ 0 < dot n (minus b p) /\ 0 < dot n (minus c
    p).
Proof.
  intros D.
  assert (Between : forall n q r s, in_segment s q r -> 0 < dot n (minus q p) -> 0 < dot n (minus r p)
    -> 0 < dot n (minus s p)).
  { intros n q r s (u & U & ->) A B.
    replace (dot _ _) with ((1 - u) * dot n (minus q p) + u * dot n (minus r p)) by vector.
    destruct (Req_dec u 0) as [-> | Nu]; [lra |].
    assert (0 < u * dot n (minus r p)) by (apply Rmult_lt_0_compat; lra).
    assert (0 <= (1 - u) * dot n (minus q p)) by (apply Rmult_le_pos; lra). lra. }
  destruct (degenerate a b c D) as [S | [S | S]].
  - destruct (off_segment p a b) as [I | (n & A & B)]; [left; apply face_at_a_time; right; now left |].
    right. exists n. eauto.
  - destruct (off_segment p a c) as [I | (n & A & C)];
      [left; apply face_at_a_time; right; right; right; now apply segment_sym |]. right. exists n.
        eauto.
  - destruct (off_segment p b c) as [I | (n & B & C)]; [left; apply face_at_a_time; right; right; now
      left |].
    right. exists n. eauto.
Qed.

Lemma off_parallel a0 a1 b0 b1 : cross (minus a1 a0) (minus b1 b0) = origin ->
  segments_meet a0 a1 b0 b1 \/ exists n, 0 < dot n (minus b0 a0) /\ 0 < dot n (minus b1 a0) /\
    0 < dot n (minus b0 a1) /\ 0 < dot n (minus b1 a1).
Proof.
  intros H. destruct (origin_dec (minus a1 a0)) as [E | N].
  { assert (a1 = a0) by (apply point_eq in E; destruct a0, a1; vector). subst a1.
    destruct (off_segment a0 b0 b1) as [I | (n & A & B)]; [left; apply edges_at_a_time; right; now left
      |].
    right. exists n. auto. }
  destruct (parallel _ _ N H) as (k & K).
  set (e := minus a1 a0) in *. set (w := minus b0 a0).
  assert (E1 : minus b1 a0 = along w k e).
  { apply point_eq in K. unfold w, along, minus, origin in *. cbn [x y z] in *.
    apply same_point; cbn [x y z]; lra. }
  assert (E2 : minus b0 a1 = along w (-1) e).
  { unfold w, e, along, minus. cbn [x y z]. apply same_point; cbn [x y z]; ring. }
  assert (E3 : minus b1 a1 = along w (k - 1) e).
  { apply point_eq in K, E1. unfold w, along, minus, origin in *. cbn [x y z] in *.
    apply same_point; cbn [x y z]; unfold e in *; cbn [x y z minus] in *; lra. }
  assert (Meet : forall s t m, 0 <= s <= 1 -> 0 <= t <= 1 -> s = m + t * k -> w = along origin m e ->
    segments_meet a0 a1 b0 b1).
  { intros s t m S T E Ew. exists (along a0 s e). split; [exists s; now split |]. exists t. split; auto.
      rewrite K.
    apply point_eq in Ew. unfold w, along, minus, origin in *. cbn [x y z] in *. rewrite E.
    apply same_point; cbn [x y z]; lra. }
  rewrite E1, E2, E3. clear E1 E2 E3. apply square_positive in N.
  set (m := dot w e / dot e e). set (n := along w (- m) e).
  assert (Pn : dot n e = 0) by (unfold n, m; clearbody e w; unfold dot, along in *; simpl in *; field;
    lra).
  assert (Along : forall p j, dot p (along w j e) = dot p w + j * dot p e)
    by (intros p j; clearbody e w; vector).
  destruct (origin_dec n) as [Z | Nn].
  - assert (Ew : w = along origin m e).
    { unfold n in Z. apply point_eq in Z. clearbody w e m. vector. }
    assert (D0 : dot e w = m * dot e e).
    { transitivity (dot e (along origin m e)); [now rewrite <- Ew | clearbody e; vector]. }
    assert (Opp : forall q, dot (along origin (-1) e) q = - dot e q)
      by (intros q; clearbody e; vector).
    destruct (Rlt_or_le 1 m) as [M | M]; [| destruct (Rlt_or_le m 0) as [M0 | M0]].
    + destruct (Rlt_or_le 1 (m + k)) as [L | L].
      * right. exists e. rewrite !Along, D0. repeat split; nra.
      * left. assert (k <> 0) by lra. apply (Meet 1 ((1 - m) / k) m); auto; [lra | | field; auto].
        assert (Q : (1 - m) / k * k = 1 - m) by now field. split; nra.
    + destruct (Rlt_or_le (m + k) 0) as [L | L].
      * right. exists (along origin (-1) e). rewrite !Opp, !Along, D0. repeat split; nra.
      * left. assert (k <> 0) by lra. apply (Meet 0 (- m / k) m); auto; [lra | | field; auto].
        assert (Q : - m / k * k = - m) by now field. split; nra.
    + left. apply (Meet m 0 m); auto; lra.
  - right. exists n. apply square_positive in Nn.
    assert (D : dot n w = dot n n).
    { transitivity (dot n n + m * dot n e); [| rewrite Pn; ring].
      unfold n. clearbody m w e. vector. }
    rewrite !Along, Pn, D. repeat split; lra.
Qed.

Lemma cont_plus f g : continuity f -> continuity g -> continuity (fun t => f t + g t).
Proof. exact (continuity_plus f g). Qed.
Lemma cont_minus f g : continuity f -> continuity g -> continuity (fun t => f t - g t).
Proof. exact (continuity_minus f g). Qed.
Lemma cont_mult f g : continuity f -> continuity g -> continuity (fun t => f t * g t).
Proof. exact (continuity_mult f g). Qed.
Lemma cont_const c : continuity (fun _ => c).
Proof. apply continuity_const. now intros a b. Qed.
Lemma cont_id : continuity (fun t => t).
Proof. exact (derivable_continuous id derivable_id). Qed.
Lemma cont_min f g : continuity f -> continuity g -> continuity (fun t => Rmin (f t) (g t)).
Proof.
  intros F G.
  assert (E : forall a b, Rmin a b = (a + b - Rabs (a - b)) * / 2).
  { intros a b. unfold Rmin. destruct (Rle_dec a b); [rewrite Rabs_left1 | rewrite Rabs_pos_eq]; lra. }
  replace (fun t => Rmin (f t) (g t)) with (fun t => (f t + g t - Rabs (f t - g t)) * / 2)
    by (apply functional_extensionality; intros t; now rewrite E).
  apply cont_mult; [| apply cont_const]. apply cont_minus; [now apply cont_plus |].
  exact (continuity_comp (fun t => f t - g t) Rabs (cont_minus f g F G) Rcontinuity_abs).
Qed.
Definition smooth (v : R -> point) : Prop :=
  continuity (fun t => x (v t)) /\ continuity (fun t => y (v t)) /\ continuity (fun t => z (v t)).
Lemma smooth_difference p q : smooth (fun t => minus (place p t) (place q t)).
Proof.
  assert (H : forall a b, continuity (fun t => (1 - t) * a + t * b)).
  { intros a b. apply cont_plus; apply cont_mult; try apply cont_const; try apply cont_id.
    apply cont_minus; [apply cont_const | apply cont_id]. }
  repeat split; cbn [x y z minus place]; apply cont_minus; apply H.
Qed.
Lemma smooth_cross v w : smooth v -> smooth w -> smooth (fun t => cross (v t) (w t)).
Proof.
  intros (V0 & V1 & V2) (W0 & W1 & W2).
  repeat split; cbn [x y z cross]; apply cont_minus; now apply cont_mult.
Qed.
Lemma cont_dot v w : smooth v -> smooth w -> continuity (fun t => dot (v t) (w t)).
Proof.
  intros (V0 & V1 & V2) (W0 & W1 & W2). unfold dot. repeat apply cont_plus; now apply cont_mult.
Qed.
Ltac continuous := unfold on_a, on_b, square_normal, weight_0, weight_1, weight_2;
  repeat (apply cont_min || apply cont_dot || apply smooth_cross || apply smooth_difference || apply
    cont_minus || apply cont_const).

(** A plane that separates two moving points at one time separates them for a while. *)
Lemma stays_separated n p q s : 0 < dot n (minus (place q s) (place p s)) ->
  exists e, s < e /\ forall t, s <= t < e -> 0 < dot n (minus (place q t) (place p t)).
Proof.
  set (f0 := dot n (minus (start q) (start p))). set (f1 := dot n (minus (finish q) (finish p))).
  assert (E : forall t, dot n (minus (place q t) (place p t)) = f0 + t * (f1 - f0))
    by (intros t; unfold f0, f1, dot, minus, place; simpl; ring).
  rewrite E. intros P. pose proof (Rabs_pos (f1 - f0)) as A. pose proof (Rle_abs (- (f1 - f0))) as B.
    rewrite Rabs_Ropp in B.
  set (k := Rabs (f1 - f0) + 1) in *. set (v := f0 + s * (f1 - f0)) in *.
  exists (s + v / k). assert (Q : 0 < v / k) by (apply Rdiv_lt_0_compat; unfold k; lra). split; [lra |].
  intros t T. rewrite E. assert (Ev : v = v / k * k) by (field; unfold k; lra).
  assert (Kp : 0 < k) by (unfold k; lra).
  assert ((t - s) * k < v / k * k) by (apply Rmult_lt_compat_r; [exact Kp | lra]).
  assert (- ((t - s) * k) <= (t - s) * (f1 - f0)) by (unfold k; nra).
  rewrite <- Ev in H. unfold v in H. lra.
Qed.

Lemma all_stay_separated n s b l : s < b -> Forall (fun c => 0 < dot n (minus (place (fst c) s) (place (snd c) s))) l ->
  exists e, s < e <= b /\ forall t, s < t < e -> Forall (fun c => 0 < dot n (minus (place (fst c) t) (place (snd c) t))) l.
Proof.
  intros B. induction 1 as [| c l P _ (e & E & IH)]; [exists b; split; [lra | auto] |].
  apply stays_separated in P. destruct P as (d & D & P). exists (Rmin d e).
  pose proof (Rmin_l d e). pose proof (Rmin_r d e). pose proof (Rmin_glb_lt d e s D (proj1 E)). split; [lra |].
  intros t T. constructor; [apply P | apply IH]; lra.
Qed.

(** Contact of a face that degenerates at time s, if there is contact right after s. *)
Lemma face_closed v f0 f1 f2 s b : s < b ->
  cross (minus (place f1 s) (place f0 s)) (minus (place f2 s) (place f0 s)) = origin ->
  (forall t, s < t <= b -> in_triangle (place v t) (place f0 t) (place f1 t) (place f2 t)) ->
  in_triangle (place v s) (place f0 s) (place f1 s) (place f2 s).
Proof.
  intros B D H. destruct (off_degenerate (place v s) _ _ _ D) as [| (n & P0 & P1 & P2)]; auto. exfalso.
  destruct (all_stay_separated n s b [(f0, v); (f1, v); (f2, v)] B) as (e & E & P); [now repeat constructor |].
  set (t := (s + e) / 2). specialize (P t ltac:(unfold t; lra)). rewrite !Forall_cons_iff, !dot_minus in P.
  apply (Rlt_irrefl (dot n (place v t))), triangle_beyond with (1 := H t ltac:(unfold t; lra)); apply Rminus_gt_0_lt, P.
Qed.
Lemma edges_closed a0 a1 b0 b1 s b : s < b ->
  cross (minus (place a1 s) (place a0 s)) (minus (place b1 s) (place b0 s)) = origin ->
  (forall t, s < t <= b -> segments_meet (place a0 t) (place a1 t) (place b0 t) (place b1 t)) ->
  segments_meet (place a0 s) (place a1 s) (place b0 s) (place b1 s).
Proof.
  intros B D H. destruct (off_parallel _ _ _ _ D) as [| (n & P0 & P1 & P2 & P3)]; auto. exfalso.
  destruct (all_stay_separated n s b [(b0, a0); (b1, a0); (b0, a1); (b1, a1)] B) as (e & E & P); [now repeat constructor |].
  set (t := (s + e) / 2). specialize (P t ltac:(unfold t; lra)). rewrite !Forall_cons_iff, !dot_minus in P.
  generalize (H t ltac:(unfold t; lra)).
  apply (segments_apart n); apply Rminus_gt_0_lt, P.
Qed.

(** All weights are positive, as interior_contact tests. *)
Definition inside_face (p a b c : point) : Prop :=
  let B := minus b a in let C := minus c a in let P := minus p a in
  0 < weight_2 B C P /\ 0 < weight_1 B C P /\ 0 < weight_0 B C P.
Definition inside_edges (a0 a1 b0 b1 : point) : Prop :=
  let B := minus a1 a0 in let C := minus b1 b0 in let P := minus b0 a0 in
  0 < on_a B C P /\ 0 < square_normal B C - on_a B C P /\ 0 < on_b B C P /\ 0 < square_normal B C - on_b
    B C P.

Lemma square_origin v : v = origin -> dot v v = 0.
Proof. intros ->. coordinates. ring. Qed.

Lemma inside_face_regular p a b c : det (minus b a) (minus c a) (minus p a) = 0 -> inside_face p a b c
  ->
  regular_face p a b c.
Proof.
  intros Y (W2 & W1 & W0). split; [| repeat split; auto; lra]. intros E. apply square_origin in E.
  unfold weight_0 in W0. lra.
Qed.
Lemma inside_edges_regular a0 a1 b0 b1 : det (minus a1 a0) (minus b1 b0) (minus b0 a0) = 0 ->
  inside_edges a0 a1 b0 b1 ->
  regular_edges a0 a1 b0 b1.
Proof.
  intros Y (A0 & A1 & B0 & B1). split; [| repeat split; auto; lra]. intros E. apply square_origin in E.
  unfold square_normal in *. lra.
Qed.

(** A contact with a weight of zero is on the border. *)
Lemma regular_face_border p a b c : regular_face p a b c -> inside_face p a b c \/ face_border p a b c.
Proof.
  intros (N & Y & W2 & W1 & W0). pose proof (face_at_normal p a b c N Y) as E. cbv zeta in E.
  set (B := minus b a) in *. set (C := minus c a) in *. set (P := minus p a) in *.
  assert (Q : 0 < square_normal B C) by now apply square_positive. set (n2 := square_normal B C) in *.
  assert (Bound : forall w, 0 <= w <= n2 -> 0 <= w / n2 <= 1).
  { intros w W. split; [apply Rmult_le_pos; [lra | left; now apply Rinv_0_lt_compat] |].
    apply Rmult_le_reg_r with n2; auto. field_simplify; lra. }
  unfold weight_0 in *. fold (square_normal B C) in *. fold n2 in W0.
  destruct (Req_dec (weight_2 B C P) 0) as [Z2 | Z2]; [| destruct (Req_dec (weight_1 B C P) 0) as [Z1 |
    Z1];
    [| destruct (Req_dec (n2 - weight_1 B C P - weight_2 B C P) 0) as [Z0 | Z0]]].
  - right. left. exists (weight_1 B C P / n2). split; [apply Bound; lra |]. rewrite E at 1. rewrite Z2.
    unfold along, Rdiv. rewrite Rmult_0_l. cbn [x y z]. apply same_point; cbn [x y z]; unfold B; ring.
  - right. right. right. apply segment_sym. exists (weight_2 B C P / n2). split; [apply Bound; lra |].
    rewrite E at 1. rewrite Z1. unfold along, Rdiv. rewrite Rmult_0_l. cbn [x y z].
    apply same_point; cbn [x y z]; unfold C; ring.
  - right. right. left. exists (weight_2 B C P / n2). split; [apply Bound; lra |].
    assert (E1 : weight_1 B C P / n2 = 1 - weight_2 B C P / n2).
    { apply Rmult_eq_reg_r with n2; [field_simplify; lra | lra]. }
    rewrite E at 1. rewrite E1. unfold along, B, C, minus. cbn [x y z].
    apply same_point; cbn [x y z]; ring.
  - left. unfold inside_face, weight_0. fold B C P. fold (square_normal B C). fold n2.
    repeat split; lra.
Qed.
Lemma regular_edges_border a0 a1 b0 b1 : regular_edges a0 a1 b0 b1 -> inside_edges a0 a1 b0 b1 \/
  edges_border a0 a1 b0 b1.
Proof.
  intros (N & Y & A0 & A1 & B0 & B1). pose proof (edges_at_normal a0 a1 b0 b1 N Y) as E. cbv zeta in E.
  set (B := minus a1 a0) in *. set (C := minus b1 b0) in *. set (P := minus b0 a0) in *.
  assert (Q : 0 < square_normal B C) by now apply square_positive. set (n2 := square_normal B C) in *.
  assert (Bound : forall w, 0 <= w <= n2 -> 0 <= w / n2 <= 1).
  { intros w W. split; [apply Rmult_le_pos; [lra | left; now apply Rinv_0_lt_compat] |].
    apply Rmult_le_reg_r with n2; auto. field_simplify; lra. }
  assert (Zero : forall q v, along q 0 v = q) by (intros q v; unfold along; apply same_point; cbn [x y
    z]; ring).
  assert (Za : along a0 1 B = a1) by (unfold along, B, minus; apply same_point; cbn [x y z]; ring).
  assert (Zb : along b0 1 C = b1) by (unfold along, C, minus; apply same_point; cbn [x y z]; ring).
  assert (One : n2 / n2 = 1) by (field; lra). assert (Nul : 0 / n2 = 0) by (field; lra).
  unfold edges_border, in_segment. fold B C.
  destruct (Req_dec (on_a B C P) 0) as [Z | Za0]; [| destruct (Req_dec (n2 - on_a B C P) 0) as [Z |
    Za1];
    [| destruct (Req_dec (on_b B C P) 0) as [Z | Zb0]; [| destruct (Req_dec (n2 - on_b B C P) 0) as [Z |
      Zb1]]]].
  - right. left. exists (on_b B C P / n2). split; [apply Bound; lra |]. now rewrite <- E, Z, Nul, Zero.
  - right. right. left. exists (on_b B C P / n2). split; [apply Bound; lra |].
    rewrite <- E. replace (on_a B C P) with n2 by lra. now rewrite One, Za.
  - right. right. right. left. exists (on_a B C P / n2). split; [apply Bound; lra |].
    now rewrite E, Z, Nul, Zero.
  - right. right. right. right. exists (on_a B C P / n2). split; [apply Bound; lra |].
    rewrite E. replace (on_b B C P) with n2 by lra. now rewrite One, Zb.
  - left. unfold inside_edges. fold B C P. fold n2. repeat split; lra.
Qed.

(** ** Either query: q0 to q3 are a vertex and the vertices of a face, or the ends of two edges *)

(** The points whose differences are B, C and P. *)
Definition side_b {A V : Type} (edges : bool) (minus : A -> A -> V) (q0 q1 q2 q3 : A) : V :=
  if edges then minus q1 q0 else minus q2 q1.
Definition side_c {A V : Type} (edges : bool) (minus : A -> A -> V) (q0 q1 q2 q3 : A) : V :=
  if edges then minus q3 q2 else minus q3 q1.
Definition side_p {A V : Type} (edges : bool) (minus : A -> A -> V) (q0 q1 q2 q3 : A) : V :=
  if edges then minus q2 q0 else minus q0 q1.

(** inside() of vertex_face_forms and of edge_edge_forms, of degree 0. *)
Definition weights (edges : bool) (b c p : point) : list R :=
  if edges then [on_a b c p; square_normal b c - on_a b c p; on_b b c p; square_normal b c - on_b b c p]
  else [weight_2 b c p; weight_1 b c p; weight_0 b c p].
Definition weights_positive (edges : bool) (b c p : point) : Prop := Forall (Rlt 0) (weights edges b c p).

Definition least_weight (l : list R) : R := fold_right Rmin 1 l.
Lemma least_weight_right l : (0 < least_weight l <-> Forall (Rlt 0) l) /\ (0 <= least_weight l -> Forall (Rle 0) l).
Proof.
  induction l as [| w l (Lt & Le)]; cbn [least_weight fold_right].
  - split; [split; [constructor | lra] | constructor].
  - rewrite !Forall_cons_iff, <- Lt. fold (least_weight l). pose proof (Rmin_l w (least_weight l)).
    pose proof (Rmin_r w (least_weight l)).
    split; [split; [lra | intros (W & L); now apply Rmin_glb_lt] | intros; split; [lra | apply Le; lra]].
Qed.

Section Query.

Context (edges : bool) (m0 m1 m2 m3 : moving).
Let B (t : R) := side_b edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t).
Let C (t : R) := side_c edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t).
Let P (t : R) := side_p edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t).

Definition query_touches (t : R) : Prop :=
  (if edges then segments_meet else in_triangle) (place m0 t) (place m1 t) (place m2 t) (place m3 t).
Definition query_collides : Prop := sometime query_touches.
Definition query_border_at (t : R) : Prop :=
  (if edges then edges_border else face_border) (place m0 t) (place m1 t) (place m2 t) (place m3 t).
Definition query_border : Prop := (if edges then edges_border_collides else face_border_collides) m0 m1 m2 m3.
Definition query_regular_at (t : R) : Prop := (if edges then edges_regular_at else face_regular_at) m0 m1 m2 m3 t.

Definition query_inside_at (t : R) : Prop :=
  (if edges then inside_edges else inside_face) (place m0 t) (place m1 t) (place m2 t) (place m3 t).

Lemma query_regular t : query_regular_at t <->
  cross (B t) (C t) <> origin /\ det (B t) (C t) (P t) = 0 /\ Forall (Rle 0) (weights edges (B t) (C t) (P t)).
Proof.
  unfold query_regular_at, B, C, P. destruct edges; cbn [side_b side_c side_p weights];
    rewrite !Forall_cons_iff; unfold edges_regular_at, regular_edges, face_regular_at, regular_face; intuition.
Qed.
Lemma query_inside_same t : weights_positive edges (B t) (C t) (P t) <-> query_inside_at t.
Proof.
  unfold weights_positive, query_inside_at, B, C, P. destruct edges; cbn [side_b side_c side_p weights];
    rewrite !Forall_cons_iff; unfold inside_edges, inside_face; intuition.
Qed.
Lemma query_inside_regular t : det (B t) (C t) (P t) = 0 -> query_inside_at t -> query_regular_at t.
Proof.
  unfold query_inside_at, query_regular_at, B, C, P.
  destruct edges; [apply inside_edges_regular | apply inside_face_regular].
Qed.
Lemma query_at_a_time t : query_touches t <-> query_regular_at t \/ query_border_at t.
Proof.
  unfold query_touches, query_regular_at, query_border_at.
  destruct edges; [apply edges_at_a_time | apply face_at_a_time].
Qed.
Lemma query_regular_border t : query_regular_at t -> query_inside_at t \/ query_border_at t.
Proof.
  unfold query_regular_at, query_inside_at, query_border_at.
  destruct edges; [apply regular_edges_border | apply regular_face_border].
Qed.
Lemma query_border_collides t : 0 <= t <= 1 -> query_border_at t -> query_border.
Proof.
  intros T. unfold query_border_at, query_border. destruct edges.
  - intros [H | [H | [H | H]]]; [left | right; left | right; right; left | right; right; right]; exists t; now split.
  - intros [H | [H | H]]; [left | right; left | right; right]; exists t; now split.
Qed.
Lemma query_union : query_collides <-> sometime query_regular_at \/ query_border.
Proof.
  unfold query_collides, query_touches, query_regular_at, query_border.
  destruct edges; [exact (edge_edge_union m0 m1 m2 m3) | exact (vertex_face_union m0 m1 m2 m3)].
Qed.
Lemma query_border_collision : query_border -> query_collides.
Proof. intros H. apply query_union. now right. Qed.
Lemma query_inside : ~ query_border ->
  (query_collides <-> sometime (fun t => det (B t) (C t) (P t) = 0 /\ query_inside_at t)).
Proof.
  intros N. split.
  - intros H. apply query_union in H. destruct H as [(t & T & H) | H]; [| easy]. exists t. split; auto.
    split; [now apply query_regular in H |]. apply query_regular_border in H. destruct H as [| H]; auto.
    now apply query_border_collides in H.
  - intros (t & T & Y & I). exists t. split; auto. apply query_at_a_time. left. now apply query_inside_regular.
Qed.

Lemma query_closed s b : s < b -> cross (B s) (C s) = origin -> (forall t, s < t <= b -> query_touches t) ->
  query_touches s.
Proof. unfold B, C, query_touches. destruct edges; [apply edges_closed | apply face_closed]. Qed.
Lemma query_coplanar : (forall t, 0 <= t <= 1 -> det (B t) (C t) (P t) = 0) ->
  (query_collides <-> query_inside_at 0 \/ query_border).
Proof.
  intros Y. split.
  2: { intros [I | H]; [| now apply query_border_collision]. exists 0. split; [lra |].
       apply query_at_a_time. left. apply query_inside_regular; auto. apply Y. lra. }
  assert (Either : forall t, 0 <= t <= 1 -> query_touches t -> query_inside_at t \/ query_border).
  { intros t T H. apply query_at_a_time in H. destruct H as [H | H]; [| right; now apply query_border_collides in H].
    apply query_regular_border in H. destruct H as [H | H]; [now left | right; now apply query_border_collides in H]. }
  intros (b & Hb & H). destruct (Either b Hb H) as [I |]; [| now right].
  set (f := fun t => least_weight (weights edges (B t) (C t) (P t))).
  assert (F : forall t, 0 < f t <-> query_inside_at t) by (intros t; rewrite <- query_inside_same;
    apply least_weight_right).
  destruct (Rlt_or_le 0 (f 0)) as [F0 | F0]; [left; now apply F | right].
  destruct (begins f query_touches b) as (s & S & Z & K); auto.
  - unfold f, least_weight, B, C, P. destruct edges; cbn [weights fold_right side_b side_c side_p]; continuous.
  - now apply F.
  - intros t T G. apply query_at_a_time. left. apply query_inside_regular; [now apply Y | now apply F].
  - intros s S Z After. destruct (origin_dec (cross (B s) (C s))) as [E | N]; [apply query_closed with b; auto; lra |].
    apply query_at_a_time. left. apply query_regular. split; auto. split; [apply Y; lra |].
    apply least_weight_right. unfold f in Z. lra.
  - destruct (Either s S K) as [I' |]; auto. apply F in I'. lra.
Qed.

(** In contact Y vanishes and no weight is negative. *)
Lemma query_conditions t : query_touches t ->
  det (B t) (C t) (P t) = 0 /\ Forall (Rle 0) (weights edges (B t) (C t) (P t)).
Proof.
  unfold query_touches, B, C, P.
  destruct edges; cbn [side_b side_c side_p weights]; intros H; rewrite !Forall_cons_iff;
    [apply meeting_conditions in H | apply touching_conditions in H]; intuition.
Qed.

End Query.

Section Face.

Variables v f0 f1 f2 : moving.
Let B (t : R) := minus (place f1 t) (place f0 t).
Let C (t : R) := minus (place f2 t) (place f0 t).
Let P (t : R) := minus (place v t) (place f0 t).
Let inside (t : R) := inside_face (place v t) (place f0 t) (place f1 t) (place f2 t).

(** In a query without vertex/edge contact, contact is equivalent to Y = 0 with all weights positive. *)
Theorem face_inside : ~ face_border_collides v f0 f1 f2 ->
  (vertex_face_collides v f0 f1 f2 <-> sometime (fun t => det (B t) (C t) (P t) = 0 /\ inside t)).
Proof. exact (query_inside false v f0 f1 f2). Qed.
(** If Y = 0 throughout, only t = 0 must be tested. *)
Theorem face_coplanar : (forall t, 0 <= t <= 1 -> det (B t) (C t) (P t) = 0) ->
  (vertex_face_collides v f0 f1 f2 <-> inside 0 \/ face_border_collides v f0 f1 f2).
Proof. exact (query_coplanar false v f0 f1 f2). Qed.

End Face.

Section Edges.

Variables a0 a1 b0 b1 : moving.
Let B (t : R) := minus (place a1 t) (place a0 t).
Let C (t : R) := minus (place b1 t) (place b0 t).
Let P (t : R) := minus (place b0 t) (place a0 t).
Let inside (t : R) := inside_edges (place a0 t) (place a1 t) (place b0 t) (place b1 t).

Theorem edges_inside : ~ edges_border_collides a0 a1 b0 b1 ->
  (edge_edge_collides a0 a1 b0 b1 <-> sometime (fun t => det (B t) (C t) (P t) = 0 /\ inside t)).
Proof. exact (query_inside true a0 a1 b0 b1). Qed.
Theorem edges_coplanar : (forall t, 0 <= t <= 1 -> det (B t) (C t) (P t) = 0) ->
  (edge_edge_collides a0 a1 b0 b1 <-> inside 0 \/ edges_border_collides a0 a1 b0 b1).
Proof. exact (query_coplanar true a0 a1 b0 b1). Qed.

End Edges.
