(** Relations of closed triangles and segments at rest (include/errbound/simplices/relation.hpp), over exact signs of
    orient3d. Degenerate triangles are the segments or points that they span. Results:
        triangles_meet            two triangles share a point if and only if an edge of one meets the other
        edge_meets_in_plane, triangles_meet_in_plane   in one plane: an end is in the triangle, or edges meet; for two
                                  triangles, a vertex of one is in the other, or edges meet
        edge_meets_face, edge_crosses_face   a segment whose ends are on sides of the plane that differ: its signs
                                  with the triangle's edges decide if they meet; if none is zero, interiors do
        one_side_apart            vertices strictly on one side of the other's plane: no shared point
        section_ends              the section that the code computes is where the triangle meets the plane
        sections_right            two triangles in different planes share a point if and only if the code's two
                                  comparisons of the sections' ends do not exclude it *)

From Coq Require Import Reals ZArith List Lia Lra Psatz Bool.
From Errbound Require Import Contact.
Import ListNotations.
Open Scope R_scope.

(** ** The code *)

(** forms::volume: the sign of orient3d *)
Definition volume (a b c d : point) : R := det (minus a d) (minus b d) (minus c d).

Definition edge_meets (p q a b c : point) : Prop := exists s, in_segment s p q /\ in_triangle s a b c.
Definition some_edge_meets (a0 a1 a2 b0 b1 b2 : point) : Prop :=
  edge_meets a0 a1 b0 b1 b2 \/ edge_meets a1 a2 b0 b1 b2 \/ edge_meets a2 a0 b0 b1 b2.

(** A tactic for identities of coordinates. *)
Ltac by_coordinates := unfold volume, det, along, minus, cross, dot, origin in *; cbn [x y z] in *;
  try apply same_point; cbn [x y z]; try ring.

(** ** A point moves until it leaves *)

(** Numbers u that are not negative, and their changes: they stay so until one is zero. *)
Lemma first_zero (l : list (R * R)) : Forall (fun w => 0 <= fst w) l -> Exists (fun w => snd w < 0) l ->
  exists t, 0 <= t /\ Forall (fun w => 0 <= fst w + t * snd w) l /\ Exists (fun w => fst w + t * snd w = 0) l.
Proof.
  assert (Zero : forall u d, 0 <= u -> d < 0 -> 0 <= - u / d /\ u + - u / d * d = 0).
  { intros u d U D. split; [| field; lra]. replace (- u / d) with (u * / - d) by (field; lra).
    apply Rmult_le_pos; [easy | apply Rlt_le, Rinv_0_lt_compat; lra]. }
  induction l as [| (u, d) l IH]; intros F N; [inversion N |].
  apply Forall_cons_iff in F. destruct F as (U & F). cbn [fst snd] in *.
  assert (D : Exists (fun w => snd w < 0) l \/ ~ Exists (fun w => snd w < 0) l) by apply Classical_Prop.classic.
  destruct D as [D | D].
  - destruct (IH F D) as (t & T & P & Z). destruct (Rle_or_lt 0 (u + t * d)) as [C | C].
    + exists t. repeat split; auto.
    + assert (Nd : d < 0) by (apply Rnot_le_lt; intros H; pose proof (Rmult_le_pos t d T H); lra).
      destruct (Zero u d U Nd) as (S & Z'). set (s := - u / d) in *. exists s. split; [easy |].
      split; [constructor; [cbn; lra |] | now constructor].
      assert (L : s <= t). { apply Rnot_lt_le. intros H. apply (Rmult_lt_gt_compat_neg_l d) in H; auto. lra. }
      clear IH. rewrite Forall_forall in *. intros (v, e) I. specialize (F _ I). specialize (P _ I). cbn [fst snd] in *.
      destruct (Rle_or_lt 0 e) as [E | E]; [pose proof (Rmult_le_pos s e S E); lra |].
      apply Rle_trans with (1 := P), Rplus_le_compat_l. apply Ropp_le_cancel. rewrite !Ropp_mult_distr_r.
      apply Rmult_le_compat_r; lra.
  - inversion N as [w l' Nd | w l' Nl]; subst; [| easy]. cbn [snd] in Nd. destruct (Zero u d U Nd) as (S & Z).
    exists (- u / d). split; [easy |]. split; [constructor; [cbn; lra |] | now constructor].
    rewrite Forall_forall in *. intros (v, e) I. specialize (F _ I). cbn [fst snd] in *.
    assert (E : 0 <= e).
    { apply Rnot_lt_le. intros H. apply D, Exists_exists. exists (v, e). split; auto. }
    pose proof (Rmult_le_pos _ e S E). lra.
Qed.

(** The point with weights 1 - u - v, u, v. *)
Definition weighted (a b c : point) (u v : R) : point := along (along a u (minus b a)) v (minus c a).
Lemma on_border a b c u v : 0 <= u -> 0 <= v -> 0 <= 1 - u - v -> u = 0 \/ v = 0 \/ 1 - u - v = 0 ->
  face_border (weighted a b c u v) a b c.
Proof.
  intros U V W [-> | [-> | Z]].
  - right. right. exists (1 - v). split; [lra |]. unfold weighted. by_coordinates.
  - left. exists u. split; [lra |]. unfold weighted. by_coordinates.
  - right. left. exists v. split; [lra |]. replace u with (1 - v) by lra. unfold weighted. by_coordinates.
Qed.
Lemma degenerate_border p a b c : cross (minus b a) (minus c a) = origin -> in_triangle p a b c ->
  face_border p a b c.
Proof. intros E T. apply face_at_a_time in T. destruct T as [(N & _) | B]; [now rewrite E in N | exact B]. Qed.

(** A direction in the plane, as changes of u and v. *)
Lemma direction_weights a b c d : cross (minus b a) (minus c a) <> origin ->
  det (minus b a) (minus c a) d = 0 -> exists m n, d = along (along origin m (minus b a)) n (minus c a).
Proof.
  intros N Z. pose proof (face_at_normal (along a 1 d) a b c N) as F. cbv zeta in F.
  assert (E : minus (along a 1 d) a = d) by (destruct d; by_coordinates). rewrite E in F. specialize (F Z).
  apply point_eq in F. set (m := weight_1 _ _ d / _) in F. set (n := weight_2 _ _ d / _) in F. exists m, n.
  clearbody m n. destruct F as (F0 & F1 & F2). unfold along, minus, origin in *. cbn [x y z] in *.
  apply same_point; cbn [x y z]; lra.
Qed.

(** A common point moves in both planes until one of the six weights is zero. *)
Lemma common_moves a0 a1 a2 b0 b1 b2 p d :
  in_triangle p a0 a1 a2 -> in_triangle p b0 b1 b2 ->
  cross (minus a1 a0) (minus a2 a0) <> origin -> cross (minus b1 b0) (minus b2 b0) <> origin ->
  det (minus a1 a0) (minus a2 a0) d = 0 -> det (minus b1 b0) (minus b2 b0) d = 0 -> d <> origin ->
  exists q, in_triangle q a0 a1 a2 /\ in_triangle q b0 b1 b2 /\ (face_border q a0 a1 a2 \/ face_border q b0 b1 b2).
Proof.
  intros (u & v & U & V & W & Ea) (u' & v' & U' & V' & W' & Eb) Na Nb Da Db D.
  destruct (direction_weights a0 a1 a2 d Na Da) as (m & n & Ed).
  destruct (direction_weights b0 b1 b2 d Nb Db) as (m' & n' & Ed').
  destruct (first_zero [(u, m); (v, n); (1 - u - v, - m - n); (u', m'); (v', n'); (1 - u' - v', - m' - n')])
    as (t & T & F & Z).
  - repeat (apply Forall_cons; [cbn [fst]; lra |]). apply Forall_nil.
  - rewrite !Exists_cons. cbn [snd]. destruct (Rlt_or_le m 0); auto. destruct (Rlt_or_le n 0); auto.
    destruct (Rlt_or_le (- m - n) 0); auto. exfalso. apply D. rewrite Ed. replace m with 0 by lra.
    replace n with 0 by lra. by_coordinates.
  - rewrite !Forall_cons_iff in F. cbn [fst snd] in F. destruct F as (F1 & F2 & F3 & F4 & F5 & F6 & _).
    exists (along p t d).
    assert (Pa : along p t d = weighted a0 a1 a2 (u + t * m) (v + t * n))
      by (rewrite Ea, Ed; unfold weighted; by_coordinates).
    assert (Pb : along p t d = weighted b0 b1 b2 (u' + t * m') (v' + t * n'))
      by (rewrite Eb, Ed'; unfold weighted; by_coordinates).
    split; [exists (u + t * m), (v + t * n); repeat split; try lra; exact Pa |].
    split; [exists (u' + t * m'), (v' + t * n'); repeat split; try lra; exact Pb |].
    rewrite !Exists_cons in Z. cbn [fst snd] in Z.
    assert (C : (u + t * m = 0 \/ v + t * n = 0 \/ 1 - (u + t * m) - (v + t * n) = 0) \/
                (u' + t * m' = 0 \/ v' + t * n' = 0 \/ 1 - (u' + t * m') - (v' + t * n') = 0)).
    { destruct Z as [Z | [Z | [Z | [Z | [Z | [Z | Z]]]]]]; [.. | inversion Z]; lra. }
    destruct C as [C | C]; [left; rewrite Pa | right; rewrite Pb]; apply on_border; auto; lra.
Qed.

Theorem triangles_meet a0 a1 a2 b0 b1 b2 : (exists p, in_triangle p a0 a1 a2 /\ in_triangle p b0 b1 b2) <->
  some_edge_meets a0 a1 a2 b0 b1 b2 \/ some_edge_meets b0 b1 b2 a0 a1 a2.
Proof.
  assert (Border : forall q c0 c1 c2 d0 d1 d2, in_triangle q d0 d1 d2 -> face_border q c0 c1 c2 ->
    some_edge_meets c0 c1 c2 d0 d1 d2).
  { intros q c0 c1 c2 d0 d1 d2 T [B | [B | B]]; [left | right; left | right; right]; now exists q. }
  split.
  - intros (p & A & B).
    destruct (origin_dec (cross (minus a1 a0) (minus a2 a0))) as [Ea | Na].
    { left. apply (Border p); auto. now apply degenerate_border. }
    destruct (origin_dec (cross (minus b1 b0) (minus b2 b0))) as [Eb | Nb].
    { right. apply (Border p); auto. now apply degenerate_border. }
    assert (D : exists d, det (minus a1 a0) (minus a2 a0) d = 0 /\ det (minus b1 b0) (minus b2 b0) d = 0 /\
      d <> origin).
    { unfold det. set (n := cross (minus a1 a0) (minus a2 a0)) in *. set (m := cross (minus b1 b0) (minus b2 b0)) in *.
      destruct (origin_dec (cross n m)) as [E | N].
      - (* parallel planes: along an edge *)
        exists (minus a1 a0). assert (Z : dot n (minus a1 a0) = 0) by (unfold n; by_coordinates).
        split; [easy |]. destruct (parallel n m Na E) as (k & Ek). split.
        + rewrite Ek. replace (dot _ _) with (k * dot n (minus a1 a0)) by (by_coordinates). rewrite Z. ring.
        + intros H. apply Na. unfold n. rewrite H. by_coordinates.
      - exists (cross n m). repeat split; [by_coordinates | by_coordinates | easy]. }
    destruct D as (d & Da & Db & D).
    destruct (common_moves a0 a1 a2 b0 b1 b2 p d A B Na Nb Da Db D) as (q & Qa & Qb & [C | C]);
      [left | right]; now apply (Border q).
  - assert (Edge : forall p q c0 c1 c2 d0 d1 d2, edge_meets p q d0 d1 d2 ->
      (forall s, in_segment s p q -> face_border s c0 c1 c2) ->
      exists s, in_triangle s c0 c1 c2 /\ in_triangle s d0 d1 d2).
    { intros p q c0 c1 c2 d0 d1 d2 (s & S & T) F. exists s. split; auto. apply face_at_a_time. right. auto. }
    unfold face_border in Edge.
    intros [[M | [M | M]] | [M | [M | M]]];
      [apply (Edge _ _ a0 a1 a2) in M | apply (Edge _ _ a0 a1 a2) in M | apply (Edge _ _ a0 a1 a2) in M |
       apply (Edge _ _ b0 b1 b2) in M | apply (Edge _ _ b0 b1 b2) in M | apply (Edge _ _ b0 b1 b2) in M]; auto;
      destruct M as (s & M1 & M2); now exists s.
Qed.

(** ** One plane *)

Definition edge_meets_border (p q a b c : point) : Prop :=
  segments_meet p q a b \/ segments_meet p q b c \/ segments_meet p q c a.
Lemma border_meets s p q a b c : in_segment s p q -> face_border s a b c -> edge_meets_border p q a b c.
Proof. intros S [B | [B | B]]; [left | right; left | right; right]; now exists s. Qed.

Theorem edge_meets_in_plane p q a b c : volume a b c p = 0 -> volume a b c q = 0 ->
  edge_meets p q a b c <-> in_triangle p a b c \/ edge_meets_border p q a b c.
Proof.
  intros P Q. split.
  - intros (s & S & T). destruct (origin_dec (cross (minus b a) (minus c a))) as [E | N].
    { right. apply (border_meets s); auto. now apply degenerate_border. }
    destruct S as (r & R' & Es). destruct T as (u & v & U & V & W & Et).
    assert (D : det (minus b a) (minus c a) (minus p s) = 0).
    { replace (det _ _ _) with (r * (volume a b c q - volume a b c p)); [rewrite P, Q; ring |]. rewrite Es.
      by_coordinates. }
    destruct (direction_weights a b c _ N D) as (m & n & Ed).
    destruct (first_zero [(u, m); (v, n); (1 - u - v, - m - n); (1, - 1)]) as (t & T & F & Z).
    + repeat (apply Forall_cons; [cbn [fst]; lra |]). apply Forall_nil.
    + rewrite !Exists_cons. cbn [snd]. right. right. right. left. lra.
    + rewrite !Forall_cons_iff in F. rewrite !Exists_cons in Z. cbn [fst snd] in F, Z.
      destruct F as (F1 & F2 & F3 & F4 & _).
      assert (Pt : along s t (minus p s) = weighted a b c (u + t * m) (v + t * n)).
      { rewrite Ed, Et. unfold weighted. by_coordinates. }
      assert (C : t = 1 \/ u + t * m = 0 \/ v + t * n = 0 \/ 1 - (u + t * m) - (v + t * n) = 0).
      { destruct Z as [Z | [Z | [Z | [Z | Z]]]]; [.. | inversion Z]; lra. }
      destruct C as [-> | C].
      * left. exists (u + 1 * m), (v + 1 * n). repeat split; try lra. fold (weighted a b c (u + 1 * m) (v + 1 * n)).
        rewrite <- Pt. destruct p, s. by_coordinates.
      * right. apply (border_meets (along s t (minus p s))); [| rewrite Pt; apply on_border; auto; lra].
        exists (r - t * r). split; [nra |]. rewrite Es. by_coordinates.
  - intros [T | M].
    + exists p. split; auto. exists 0. split; [lra |]. destruct p. by_coordinates.
    + destruct M as [(s & S & M) | [(s & S & M) | (s & S & M)]]; exists s; (split; [exact S |]); apply face_at_a_time;
        right; unfold face_border; auto.
Qed.

Definition borders_meet (a0 a1 a2 b0 b1 b2 : point) : Prop :=
  edge_meets_border a0 a1 b0 b1 b2 \/ edge_meets_border a1 a2 b0 b1 b2 \/ edge_meets_border a2 a0 b0 b1 b2.
Definition vertex_inside (a0 a1 a2 b0 b1 b2 : point) : Prop :=
  in_triangle a0 b0 b1 b2 \/ in_triangle a1 b0 b1 b2 \/ in_triangle a2 b0 b1 b2.
Theorem triangles_meet_in_plane a0 a1 a2 b0 b1 b2 :
  (forall a, In a [a0; a1; a2] -> volume b0 b1 b2 a = 0) -> (forall b, In b [b0; b1; b2] -> volume a0 a1 a2 b = 0) ->
  (exists p, in_triangle p a0 a1 a2 /\ in_triangle p b0 b1 b2) <->
  borders_meet a0 a1 a2 b0 b1 b2 \/ vertex_inside a0 a1 a2 b0 b1 b2 \/ vertex_inside b0 b1 b2 a0 a1 a2.
Proof.
  intros A B. rewrite triangles_meet. unfold some_edge_meets.
  rewrite (edge_meets_in_plane a0 a1), (edge_meets_in_plane a1 a2), (edge_meets_in_plane a2 a0),
    (edge_meets_in_plane b0 b1), (edge_meets_in_plane b1 b2), (edge_meets_in_plane b2 b0)
    by (apply A || apply B; simpl; auto).
  unfold borders_meet, vertex_inside, edge_meets_border.
  assert (S : forall p q r s, segments_meet p q r s -> segments_meet r s p q)
    by (intros p q r s (o & O); exists o; tauto).
  split; [| tauto]. intros [M | M]; [tauto |].
  repeat match goal with H : _ \/ _ |- _ => destruct H as [H | H] end; try apply S in M; tauto.
Qed.

(** ** A segment and a triangle in different planes *)

(** meet_edge, of a segment p q whose ends have different sides *)
Definition edge_signs (p q a b c : point) : list R := [volume p q a b; volume p q b c; volume p q c a].
Definition open_segment (s p q : point) : Prop := exists t, 0 < t < 1 /\ s = along p t (minus q p).
Definition open_triangle (s a b c : point) : Prop :=
  exists u v, 0 < u /\ 0 < v /\ u + v < 1 /\ s = weighted a b c u v.

Definition combination (l m n : R) (b c d : point) : point := along (along (along origin l b) m c) n d.
Lemma det_of_combinations l m n l' m' n' l'' m'' n'' b c d :
  det (combination l m n b c d) (combination l' m' n' b c d) (combination l'' m'' n'' b c d) =
    (l * (m' * n'' - n' * m'') - m * (l' * n'' - n' * l'') + n * (l' * m'' - m' * l'')) * det b c d.
Proof. unfold combination. by_coordinates. Qed.
Lemma meeting_signs p q a b c t u v : along p t (minus q p) = weighted a b c u v ->
  let k := volume a b c p - volume a b c q in
  volume a b c p = t * k /\ volume a b c q = (t - 1) * k /\
  edge_signs p q a b c = [v * - k; (1 - u - v) * - k; u * - k].
Proof.
  intros E. unfold edge_signs, volume. unfold weighted in E.
  assert (D : exists B C d, B = minus b a /\ C = minus c a /\ d = minus q p) by (do 3 eexists; auto).
  destruct D as (B & C & d & EB & EC & Ed). rewrite <- EB, <- EC, <- Ed in E. apply point_eq in E, EB, EC, Ed.
  destruct E as (E0 & E1 & E2), EB as (B0 & B1 & B2), EC as (C0 & C1 & C2), Ed as (D0 & D1 & D2).
  unfold along, minus in E0, E1, E2, B0, B1, B2, C0, C1, C2, D0, D1, D2.
  cbn [x y z] in E0, E1, E2, B0, B1, B2, C0, C1, C2, D0, D1, D2.
  assert (L : forall r s l m n, x r - x s = l * x B + m * x C + n * x d -> y r - y s = l * y B + m * y C + n * y d ->
    z r - z s = l * z B + m * z C + n * z d -> minus r s = combination l m n B C d).
  { intros r s l m n X Y Z. unfold combination, minus, along, origin. apply same_point; cbn [x y z]; lra. }
  rewrite (L a p (- u) (- v) t), (L b p (1 - u) (- v) t), (L c p (- u) (1 - v) t) by lra.
  rewrite (L a q (- u) (- v) (t - 1)), (L b q (1 - u) (- v) (t - 1)), (L c q (- u) (1 - v) (t - 1)) by lra.
  rewrite (L p b (u - 1) v (- t)), (L q b (u - 1) v (1 - t)), (L a b (- 1) 0 0) by lra.
  rewrite (L p c u (v - 1) (- t)), (L q c u (v - 1) (1 - t)), (L b c 1 (- 1) 0) by lra.
  rewrite (L p a u v (- t)), (L q a u v (1 - t)), (L c a 0 1 0) by lra.
  rewrite !det_of_combinations. repeat split; [ring | ring |]. f_equal; [| f_equal; [| f_equal]]; ring.
Qed.
Lemma line_meets_plane p q a b c : volume a b c p <> volume a b c q ->
  exists t u v, along p t (minus q p) = weighted a b c u v.
Proof.
  intros N. set (k := volume a b c p - volume a b c q). assert (K : k <> 0) by (unfold k; lra).
  exists (volume a b c p / k), (- volume p q c a / k), (- volume p q a b / k).
  assert (I : along (along origin k p) (volume a b c p) (minus q p) =
    along (along (along origin k a) (- volume p q c a) (minus b a)) (- volume p q a b) (minus c a))
    by (unfold k; by_coordinates).
  clearbody k. revert I. generalize (volume a b c p), (volume p q c a), (volume p q a b). intros h f g I.
  apply point_eq in I. destruct I as (I0 & I1 & I2). unfold weighted, along, minus, origin in *. cbn [x y z] in *.
  apply same_point; cbn [x y z]; apply Rmult_eq_reg_r with k; auto; field_simplify; auto; lra.
Qed.
Lemma fraction m k : 0 <= m * k -> k <> 0 -> 0 <= m / k.
Proof.
  intros M K. replace (m / k) with (m * k * / (k * k)) by (field; auto). apply Rmult_le_pos; auto.
  apply Rlt_le, Rinv_0_lt_compat. nra.
Qed.

Theorem edge_meets_face p q a b c : volume a b c p <> volume a b c q -> volume a b c p * volume a b c q <= 0 ->
  edge_meets p q a b c <-> Forall (Rle 0) (edge_signs p q a b c) \/ Forall (Rge 0) (edge_signs p q a b c).
Proof.
  intros N S. split.
  - intros (s & (t & T & Es) & u & v & U & V & W & E). rewrite Es in E.
    destruct (meeting_signs p q a b c t u v E) as (_ & _ & ->). set (k := volume a b c p - volume a b c q) in *.
    destruct (Rle_or_lt 0 (- k)) as [K | K]; [left | right]; repeat (apply Forall_cons; [| try apply Forall_nil]); nra.
  - intros H. destruct (line_meets_plane p q a b c N) as (t & u & v & E).
    destruct (meeting_signs p q a b c t u v E) as (P & Q & Signs). rewrite Signs, !Forall_cons_iff in H.
    set (k := volume a b c p - volume a b c q) in *. assert (K : k <> 0) by (unfold k; lra).
    assert (W : 0 <= v /\ 0 <= 1 - u - v /\ 0 <= u).
    { destruct H as [(A & B & C & _) | (A & B & C & _)]; [assert (0 < - k) by lra | assert (0 < k) by lra];
        repeat split; nra. }
    rewrite P, Q in S. assert (0 < k * k) by nra. assert (t * (t - 1) <= 0) by nra.
    eexists. split; [exists t; split; [nra | reflexivity] |]. exists u, v. repeat split; [| | | exact E]; lra.
Qed.
Theorem edge_crosses_face p q a b c : volume a b c p <> 0 \/ volume a b c q <> 0 ->
  (exists s, open_segment s p q /\ open_triangle s a b c) <-> volume a b c p * volume a b c q < 0 /\
    (Forall (Rlt 0) (edge_signs p q a b c) \/ Forall (Rgt 0) (edge_signs p q a b c)).
Proof.
  intros N. split.
  - intros (s & (t & T & Es) & u & v & U & V & W & E). rewrite Es in E.
    destruct (meeting_signs p q a b c t u v E) as (P & Q & ->). set (k := volume a b c p - volume a b c q) in *.
    assert (K : k <> 0) by (intros Z; rewrite Z in P, Q; lra). split.
    + rewrite P, Q. assert (0 < t * (1 - t)) by nra. assert (0 < k * k) by nra. nra.
    + destruct (Rlt_or_le 0 (- k)) as [L | L]; [left | right];
        repeat (apply Forall_cons; [| try apply Forall_nil]); nra.
  - intros (S & H). assert (D : volume a b c p <> volume a b c q) by (intros Z; rewrite Z in S; nra).
    destruct (line_meets_plane p q a b c D) as (t & u & v & E).
    destruct (meeting_signs p q a b c t u v E) as (P & Q & Signs). rewrite Signs, !Forall_cons_iff in H.
    set (k := volume a b c p - volume a b c q) in *. assert (K : k <> 0) by (unfold k; lra).
    assert (W : 0 < v /\ 0 < 1 - u - v /\ 0 < u).
    { destruct H as [(A & B & C & _) | (A & B & C & _)]; [assert (0 < - k) by lra | assert (0 < k) by lra];
        repeat split; nra. }
    rewrite P, Q in S. assert (0 < k * k) by nra. assert (t * (t - 1) < 0) by nra.
    eexists. split; [exists t; split; [nra | reflexivity] |]. exists u, v. repeat split; [| | | exact E]; lra.
Qed.

(** Vertices strictly on one side: on_one_side. An edge b0 b1 is the triangle b0 b1 b1. *)
Theorem one_side_apart a0 a1 a2 b0 b1 b2 :
  (let sides := [volume a0 a1 a2 b0; volume a0 a1 a2 b1; volume a0 a1 a2 b2] in
   Forall (Rlt 0) sides \/ Forall (Rgt 0) sides) ->
  ~ exists p, in_triangle p a0 a1 a2 /\ in_triangle p b0 b1 b2.
Proof.
  intros S (p & (u & v & _ & _ & _ & Ea) & u' & v' & U & V & W & Eb). cbv zeta in S. rewrite !Forall_cons_iff in S.
  assert (Z : volume a0 a1 a2 p = 0) by (rewrite Ea; by_coordinates).
  assert (C : volume a0 a1 a2 p =
    (1 - u' - v') * volume a0 a1 a2 b0 + u' * volume a0 a1 a2 b1 + v' * volume a0 a1 a2 b2)
    by (rewrite Eb; by_coordinates).
  rewrite Z in C. clear Z Ea Eb p. revert S C.
  generalize (volume a0 a1 a2 b0), (volume a0 a1 a2 b1), (volume a0 a1 a2 b2). intros k l m S C.
  assert (G : forall w s, 0 <= w -> 0 < s -> w * s <= 0 -> w = 0).
  { intros w s P Q H. apply Rle_antisym; auto. apply Rmult_le_reg_r with s; lra. }
  assert (P : forall w s, 0 <= w -> 0 < s -> 0 <= w * s) by (intros; apply Rmult_le_pos; lra).
  destruct S as [(K & L & M & _) | (K & L & M & _)].
  - pose proof (P (1 - u' - v') k ltac:(lra) K). pose proof (P u' l U L). pose proof (P v' m V M).
    pose proof (G u' l U L ltac:(lra)). pose proof (G v' m V M ltac:(lra)).
    pose proof (G (1 - u' - v') k ltac:(lra) K ltac:(lra)). lra.
  - pose proof (P (1 - u' - v') (- k) ltac:(lra) ltac:(lra)). pose proof (P u' (- l) U ltac:(lra)).
    pose proof (P v' (- m) V ltac:(lra)). pose proof (G u' (- l) U ltac:(lra) ltac:(lra)).
    pose proof (G v' (- m) V ltac:(lra) ltac:(lra)).
    pose proof (G (1 - u' - v') (- k) ltac:(lra) ltac:(lra) ltac:(lra)). lra.
Qed.

(** ** Two triangles in different planes *)

(** section: vertices are 0, 1 and 2, and s their sides *)
Definition next (i : nat) : nat := match i with O => 1%nat | S O => 2%nat | _ => O end.
Definition previous (i : nat) : nat := next (next i).
Record crossing_edge := Crossing { from : nat; to : nat }.
Definition alone_vertex (s : nat -> Z) : nat * Z :=
  let alone i := (negb (s i =? 0) && negb (s (next i) =? s i) && negb (s (previous i) =? s i))%Z in
  if alone 2%nat then (2%nat, s 2%nat) else if alone 1%nat then (1%nat, s 1%nat) else
  if alone 0%nat then (0%nat, s 0%nat) else
  let one := if (s 0%nat =? 0)%Z then 0%nat else if (s 1%nat =? 0)%Z then 1%nat else 2%nat in
  (one, (- s (next one))%Z).
Definition section_of (s : nat -> Z) : crossing_edge * crossing_edge :=
  let (one, side) := alone_vertex s in
  if (0 <? side)%Z then (Crossing one (previous one), Crossing one (next one))
  else (Crossing (next one) one, Crossing (previous one) one).
Definition sign (r : R) : Z := if Rlt_dec 0 r then 1 else if Rlt_dec r 0 then -1 else 0.

(** Sides that are neither all zero nor strictly one. *)
Definition meets_plane (s : nat -> R) : Prop := ~ (s 0%nat = 0 /\ s 1%nat = 0 /\ s 2%nat = 0) /\
  ~ (0 < s 0%nat /\ 0 < s 1%nat /\ 0 < s 2%nat) /\ ~ (s 0%nat < 0 /\ s 1%nat < 0 /\ s 2%nat < 0).

Lemma alone_sides s : meets_plane s -> let (one, side) := alone_vertex (fun i => sign (s i)) in
  (one < 3)%nat /\ ((0 < side)%Z /\ 0 <= s one /\ s (next one) <= 0 /\ s (previous one) <= 0 /\
      0 < s one - s (next one) /\ 0 < s one - s (previous one) \/
    (side < 0)%Z /\ s one <= 0 /\ 0 <= s (next one) /\ 0 <= s (previous one) /\
      s one - s (next one) < 0 /\ s one - s (previous one) < 0).
Proof.
  unfold meets_plane. intros (Z & P & N). cbv beta iota zeta delta [alone_vertex sign previous next].
  destruct (Rlt_dec 0 (s 0%nat)), (Rlt_dec 0 (s 1%nat)), (Rlt_dec 0 (s 2%nat));
    try destruct (Rlt_dec (s 0%nat) 0); try destruct (Rlt_dec (s 1%nat) 0); try destruct (Rlt_dec (s 2%nat) 0);
    try lra; try (exfalso; first [apply Z | apply P | apply N]; repeat split; lra);
    cbn; repeat match goal with |- context [Rlt_dec ?r ?t] => destruct (Rlt_dec r t); try lra end;
    (split; [lia |]); first [left; repeat split; lia || lra | right; repeat split; lia || lra].
Qed.

Section Sections.

(** The triangle o p q meets the plane of b0 b1 b2 in a segment; o is alone on its side. *)
Variables o p q b0 b1 b2 : point.
Notation side := (volume b0 b1 b2).
Notation n := (cross (minus b1 b0) (minus b2 b0)).
Notation m := (cross (minus p o) (minus q o)).

Lemma side_difference r s : side r - side s = dot n (minus s r).
Proof. by_coordinates. Qed.
Lemma double_cross : cross n m = along (along origin (side o - side q) (minus p o)) (- (side o - side p)) (minus q o).
Proof.
  rewrite !side_difference. generalize (cross (minus b1 b0) (minus b2 b0)), (minus p o), (minus q o). intros.
  by_coordinates.
Qed.

(** r and t are the positions on the edges; k is the section's length along n x m. *)
Lemma alone_section : side o - side p <> 0 -> side o - side q <> 0 ->
  0 <= side o /\ side p <= 0 /\ side q <= 0 \/ side o <= 0 /\ 0 <= side p /\ 0 <= side q ->
  exists r t k, let P := along o r (minus p o) in let Q := along o t (minus q o) in
  P = along Q k (cross n m) /\ 0 <= k * side o /\ (side o = 0 -> k = 0) /\
  forall s, in_triangle s o p q /\ side s = 0 <-> in_segment s P Q.
Proof.
  intros E0 F0 S. rewrite double_cross.
  assert (At : forall u v, side (weighted o p q u v) = side o - u * (side o - side p) - v * (side o - side q))
    by (intros; rewrite !side_difference; unfold weighted; by_coordinates).
  set (c := side o) in *. set (E := c - side p) in *. set (F := c - side q) in *.
  assert (Sign : 0 <= c /\ c <= E /\ c <= F /\ 0 < E /\ 0 < F \/ c <= 0 /\ E <= c /\ F <= c /\ E < 0 /\ F < 0).
  { unfold E, F in *. destruct S as [S | S]; [left | right]; lra. }
  assert (Unit : forall G, G <> 0 -> (0 <= c /\ c <= G \/ c <= 0 /\ G <= c) -> 0 <= c / G <= 1).
  { intros G NG H. split; [apply fraction; auto; nra |]. assert (0 <= (G - c) / G) by (apply fraction; auto; nra).
    replace ((G - c) / G) with (1 - c / G) in * by (field; auto). lra. }
  pose proof (Unit E E0 ltac:(lra)) as R0. pose proof (Unit F F0 ltac:(lra)) as T0.
  exists (c / E), (c / F), (c / (E * F)). cbv zeta.
  assert (Er : c / E * E = c) by (field; auto). assert (Ft : c / F * F = c) by (field; auto).
  assert (Kr : c / (E * F) * F = c / E) by (field; auto). assert (Kt : c / (E * F) * E = c / F) by (field; auto).
  assert (K : 0 <= c / (E * F) * c).
  { replace (c / (E * F) * c) with (c * c / (E * F)) by (field; auto). apply fraction; [| nra].
    apply Rmult_le_pos; nra. }
  assert (Kc : c = 0 -> c / (E * F) = 0) by (intros ->; unfold Rdiv; ring).
  set (r := c / E) in *. set (t := c / F) in *. set (k := c / (E * F)) in *. clearbody r t k.
  split; [| split; [exact K | split; [exact Kc |]]].
  { rewrite <- Kr, <- Kt. generalize (minus p o), (minus q o). intros. by_coordinates. }
  assert (Point : forall w, along (along o r (minus p o)) w (minus (along o t (minus q o)) (along o r (minus p o))) =
    weighted o p q ((1 - w) * r) (w * t)).
  { intros w. unfold weighted. generalize (minus p o), (minus q o). intros. by_coordinates. }
  intros s. split.
  - intros ((u & v & U & V & W & Es) & Z). fold (weighted o p q u v) in Es. rewrite Es, At in Z. fold c E F in Z.
    destruct (Req_dec c 0) as [C | C].
    + assert (UV : u = 0 /\ v = 0).
      { pose proof (Rmult_le_pos u (Rabs E) U (Rabs_pos E)). pose proof (Rmult_le_pos v (Rabs F) V (Rabs_pos F)).
        assert (Both : u * Rabs E + v * Rabs F = 0).
        { destruct Sign as [H1 | H1]; [rewrite !Rabs_pos_eq by lra | rewrite !Rabs_left by lra]; lra. }
        split; [apply Rmult_eq_reg_r with (Rabs E) | apply Rmult_eq_reg_r with (Rabs F)];
          try (apply Rabs_no_R0; auto); lra. }
      destruct UV as (-> & ->). assert (Rz : r = 0) by (apply Rmult_eq_reg_r with E; lra). exists 0. split; [lra |].
      rewrite Point, Rz, Es. f_equal; ring.
    + assert (Rz : 0 < r) by (destruct (proj1 R0) as [| Z0]; [easy | rewrite <- Z0, Rmult_0_l in Er; lra]).
      assert (Tz : 0 < t) by (destruct (proj1 T0) as [| Z0]; [easy | rewrite <- Z0, Rmult_0_l in Ft; lra]).
      exists (v / t). assert (Wt : v / t * t = v) by (field; lra).
      assert (Wr : (1 - v / t) * r = u).
      { apply Rmult_eq_reg_r with E; auto. replace ((1 - v / t) * r * E) with (c - v / t * c) by (rewrite <- Er; ring).
        replace (v / t * c) with (v / t * t * F) by (rewrite <- Ft; ring). rewrite Wt. lra. }
      split; [split |].
      * apply Rmult_le_reg_r with t; lra.
      * assert (0 <= 1 - v / t) by (apply Rmult_le_reg_r with r; lra). lra.
      * now rewrite Point, Wt, Wr.
  - intros (w & W & ->). rewrite Point. split.
    + exists ((1 - w) * r), (w * t). pose proof (Rmult_le_pos (1 - w) r ltac:(lra) (proj1 R0)).
      pose proof (Rmult_le_pos w t ltac:(lra) (proj1 T0)).
      pose proof (Rmult_le_compat_l (1 - w) r 1 ltac:(lra) (proj2 R0)).
      pose proof (Rmult_le_compat_l w t 1 ltac:(lra) (proj2 T0)). repeat split; auto. lra.
    + rewrite At. fold c E F. replace ((1 - w) * r * E) with ((1 - w) * c) by (rewrite <- Er at 1; ring).
      replace (w * t * F) with (w * c) by (rewrite <- Ft at 1; ring). ring.
Qed.

End Sections.

Definition in_face (p : point) (a : nat -> point) : Prop := in_triangle p (a 0%nat) (a 1%nat) (a 2%nat).
Definition normal (a : nat -> point) : point := cross (minus (a 1%nat) (a 0%nat)) (minus (a 2%nat) (a 0%nat)).
Definition sides (b a : nat -> point) (i : nat) : R := volume (b 0%nat) (b 1%nat) (b 2%nat) (a i).
Definition on_edge (a : nat -> point) (e : crossing_edge) (p : point) : Prop :=
  exists r, p = along (a (from e)) r (minus (a (to e)) (a (from e))).
(** An edge of a, from a higher to a lower side of b's plane. *)
Definition descends (b a : nat -> point) (e : crossing_edge) : Prop := sides b a (to e) < sides b a (from e) /\
  dot (normal a) (minus (a (to e)) (a (from e))) = 0.

Lemma from_one one a p : (one < 3)%nat ->
  (in_triangle p (a one) (a (next one)) (a (previous one)) <-> in_face p a) /\
  cross (minus (a (next one)) (a one)) (minus (a (previous one)) (a one)) = normal a.
Proof.
  intros L. assert (T : forall q r s, in_triangle p q r s <-> in_triangle p r s q).
  { intros q r s. split; intros H; [now apply triangle_turn | now apply triangle_turn, triangle_turn]. }
  unfold in_face, normal. destruct one as [| [| [| one]]]; [.. | lia]; cbn [next previous]; unfold previous; cbn [next].
  - easy.
  - split; [symmetry; apply T | by_coordinates].
  - split; [apply T | by_coordinates].
Qed.
Lemma other_end o p r : along o r (minus p o) = along p (1 - r) (minus o p).
Proof. by_coordinates. Qed.

Theorem section_ends a b : meets_plane (sides b a) -> let (low, high) := section_of (fun i => sign (sides b a i)) in
  exists p k, let q := along p k (cross (normal b) (normal a)) in
  0 <= k /\ on_edge a low p /\ on_edge a high q /\ descends b a low /\ descends b a high /\
  forall s, in_face s a /\ volume (b 0%nat) (b 1%nat) (b 2%nat) s = 0 <-> in_segment s p q.
Proof.
  intros M. pose proof (alone_sides _ M) as A. unfold section_of.
  destruct (alone_vertex (fun i => sign (sides b a i))) as (one & side). destruct A as (L & A).
  assert (F := fun p => from_one one a p L). destruct (F origin) as (_ & N).
  destruct (alone_section (a one) (a (next one)) (a (previous one)) (b 0%nat) (b 1%nat) (b 2%nat))
    as (r & t & k & E & K & Z & S); try (unfold sides in A; lra).
  rewrite N in E. change (cross (minus (b 1%nat) (b 0%nat)) (minus (b 2%nat) (b 0%nat))) with (normal b) in E.
  change (volume (b 0%nat) (b 1%nat) (b 2%nat) (a one)) with (sides b a one) in K, Z.
  set (o := a one) in *. set (p := a (next one)) in *. set (q := a (previous one)) in *.
  assert (Dp : dot (normal a) (minus p o) = 0) by (rewrite <- N; by_coordinates).
  assert (Dq : dot (normal a) (minus q o) = 0) by (rewrite <- N; by_coordinates).
  assert (Opp : forall v w, dot v (minus o w) = - dot v (minus w o)) by (intros; by_coordinates).
  assert (S' : forall s, in_face s a /\ volume (b 0%nat) (b 1%nat) (b 2%nat) s = 0 <->
    in_segment s (along o r (minus p o)) (along o t (minus q o))) by (intros s; rewrite <- S, (proj1 (F s)); easy).
  clear S F N. destruct A as [(P & A1 & A2 & A3 & A4 & A5) | (P & A1 & A2 & A3 & A4 & A5)].
  - rewrite (proj2 (Z.ltb_lt 0 side) P). exists (along o t (minus q o)), k. cbv zeta. rewrite <- E.
    split; [| split; [| split; [| split; [| split]]]].
    + destruct A1 as [A1 | A1]; [| rewrite (Z (eq_sym A1)); lra]. apply Rmult_le_reg_r with (1 := A1). lra.
    + now exists t.
    + now exists r.
    + split; [cbn [from to]; lra | exact Dq].
    + split; [cbn [from to]; lra | exact Dp].
    + intros s. rewrite S'. split; apply segment_sym.
  - rewrite (proj2 (Z.ltb_ge 0 side)) by lia. exists (along o r (minus p o)), (- k). cbv zeta.
    assert (Eq : along (along o r (minus p o)) (- k) (cross (normal b) (normal a)) = along o t (minus q o)).
    { rewrite E. generalize (along o t (minus q o)), (cross (normal b) (normal a)). intros [] []. by_coordinates. }
    rewrite Eq. split; [| split; [| split; [| split; [| split]]]].
    + destruct A1 as [A1 | A1]; [| rewrite (Z A1); lra]. apply Rmult_le_reg_r with (- sides b a one); lra.
    + exists (1 - r). apply other_end.
    + exists (1 - t). apply other_end.
    + split; [cbn [from to]; lra | cbn [from to]; fold o p; rewrite Opp, Dp; ring].
    + split; [cbn [from to]; lra | cbn [from to]; fold o q; rewrite Opp, Dq; ring].
    + exact S'.
Qed.

(** The order of a point of edge x of a and one of edge y of b: two_sections::order. *)
Definition order (a b : nat -> point) (x y : crossing_edge) : Z :=
  (- sign (volume (a (from x)) (a (to x)) (b (from y)) (b (to y))))%Z.

Lemma volume_on_edges p q r s i j : let c := minus q p in let d := minus s r in
  volume p q r s = det (minus (along r j d) (along p i c)) c d.
Proof.
  intros c d. set (w := minus (along r j d) (along p i c)). unfold volume.
  assert (E : minus p s = combination (-1) (- i) (- (1 - j)) w c d /\
    minus q s = combination (-1) (1 - i) (- (1 - j)) w c d /\
    minus r s = combination 0 0 (-1) w c d).
  { unfold combination, w, c, d. repeat split; by_coordinates. }
  destruct E as (-> & -> & ->). rewrite det_of_combinations. ring.
Qed.
Lemma det_of_line n m c d k : dot m c = 0 -> det (along origin k (cross n m)) c d = k * (dot n c * dot m d).
Proof.
  intros Z. replace (det _ c d) with (k * (dot n c * dot m d - dot m c * dot n d)) by by_coordinates.
  rewrite Z. ring.
Qed.
Lemma sign_negative r : (sign r < 0)%Z <-> r < 0.
Proof. unfold sign. destruct (Rlt_dec 0 r), (Rlt_dec r 0); split; intros; lia || lra. Qed.
Lemma sign_positive r : (0 < sign r)%Z <-> 0 < r.
Proof. unfold sign. destruct (Rlt_dec 0 r), (Rlt_dec r 0); split; intros; lia || lra. Qed.
(** Along descending edges, one of each triangle, the normals have positive components. *)
Lemma descent a b x : descends b a x -> 0 < dot (normal b) (minus (a (to x)) (a (from x))).
Proof. intros (L & _). unfold normal. rewrite <- side_difference. unfold sides in L. lra. Qed.
Lemma planes_differ a b x y : descends b a x -> descends a b y -> cross (normal b) (normal a) <> origin.
Proof.
  intros X Y Z. pose proof (Rmult_lt_0_compat _ _ (descent a b x X) (descent b a y Y)) as P.
  pose proof (det_of_line (normal b) (normal a) (minus (a (to x)) (a (from x))) (minus (b (to y)) (b (from y))) 1
    (proj2 X)) as E. rewrite Z in E. replace (det _ _ _) with 0 in E by by_coordinates. lra.
Qed.
Lemma order_of_points a b x y p k : descends b a x -> descends a b y -> on_edge a x p ->
  on_edge b y (along p k (cross (normal b) (normal a))) ->
  ((order a b x y < 0)%Z <-> 0 < k) /\ ((0 < order a b x y)%Z <-> k < 0).
Proof.
  intros X Y (i & Px) (j & Py). pose proof (Rmult_lt_0_compat _ _ (descent a b x X) (descent b a y Y)) as P.
  unfold order. set (l := cross (normal b) (normal a)) in *.
  assert (V : volume (a (from x)) (a (to x)) (b (from y)) (b (to y)) = k *
    (dot (normal b) (minus (a (to x)) (a (from x))) * dot (normal a) (minus (b (to y)) (b (from y))))).
  { rewrite (volume_on_edges _ _ _ _ i j). rewrite <- Px, <- Py.
    replace (minus (along p k l) p) with (along origin k l) by (clearbody l; by_coordinates).
    apply det_of_line, X. }
  rewrite V. revert P. generalize (dot (normal b) (minus (a (to x)) (a (from x))) *
    dot (normal a) (minus (b (to y)) (b (from y)))). intros r P.
  assert (Up : 0 < k * r <-> 0 < k) by (split; intros H; [apply Rmult_lt_reg_r with r | apply Rmult_lt_0_compat]; lra).
  assert (Down : k * r < 0 <-> k < 0).
  { split; intros H; [apply Rmult_lt_reg_r with r | rewrite <- (Rmult_0_l r); apply Rmult_lt_compat_r]; lra. }
  split; [rewrite <- Up, <- sign_positive | rewrite <- Down, <- sign_negative]; lia.
Qed.

Lemma own_plane p a : in_face p a -> volume (a 0%nat) (a 1%nat) (a 2%nat) p = 0.
Proof. intros (u & v & _ & _ & _ & ->). by_coordinates. Qed.
(** A point of both planes, from another one. *)
Lemma on_common_line n m v : cross n m <> origin -> dot n v = 0 -> dot m v = 0 ->
  exists k, v = along origin k (cross n m).
Proof.
  intros N Z Z'. apply parallel; auto.
  replace (cross (cross n m) v) with (along (along origin (dot n v) m) (- dot m v) n) by by_coordinates.
  rewrite Z, Z'. by_coordinates.
Qed.
Lemma ratio w k : 0 <= w <= k -> exists u, 0 <= u <= 1 /\ u * k = w.
Proof.
  intros W. destruct (Req_dec k 0) as [Z | Z]; [exists 0; split; lra |]. exists (w / k). split; [| field; auto].
  assert (E : w / k * k = w) by (field; auto). split; apply Rmult_le_reg_r with k; lra.
Qed.
Lemma along_along p k l u : along p u (minus (along p k l) p) = along p (u * k) l.
Proof. by_coordinates. Qed.
Lemma along_opposite p k k' n m : along (along p k (cross n m)) k' (cross m n) = along p (k - k') (cross n m).
Proof. by_coordinates. Qed.
Lemma along_injective p k k' l : l <> origin -> along p k l = along p k' l -> k = k'.
Proof.
  intros N E. apply Rminus_diag_uniq. apply point_eq in E. destruct (Req_dec (k - k') 0) as [Z | Z]; auto.
  exfalso. apply N. unfold along, origin in *. cbn [x y z] in E. destruct E as (E0 & E1 & E2).
  apply same_point; cbn [x y z]; apply Rmult_eq_reg_l with (k - k'); auto; lra.
Qed.

(** relation_of_triangles: triangles without a common vertex are disjoint if the order of the high ends is negative,
    or that of the low ends positive. *)
Theorem sections_right a b : meets_plane (sides b a) -> meets_plane (sides a b) ->
  let (low, high) := section_of (fun i => sign (sides b a i)) in
  let (low_b, high_b) := section_of (fun i => sign (sides a b i)) in
  (exists p, in_face p a /\ in_face p b) <-> ~ (order a b high high_b < 0)%Z /\ ~ (0 < order a b low low_b)%Z.
Proof.
  intros Ma Mb. pose proof (section_ends a b Ma) as A. pose proof (section_ends b a Mb) as B.
  destruct (section_of _) as (low, high). destruct (section_of _) as (low_b, high_b).
  destruct A as (p & k & K & Lp & Hp & Dl & Dh & S). destruct B as (q & j & J & Lq & Hq & Dl' & Dh' & T).
  set (n := normal b) in *. set (m := normal a) in *.
  assert (P : in_face p a /\ volume (b 0%nat) (b 1%nat) (b 2%nat) p = 0)
    by (apply S; exists 0; split; [lra | rewrite along_along; destruct p; by_coordinates]).
  assert (Q : in_face q b /\ volume (a 0%nat) (a 1%nat) (a 2%nat) q = 0)
    by (apply T; exists 0; split; [lra | rewrite along_along; destruct q; by_coordinates]).
  destruct P as (Pa & Pb), Q as (Qb & Qa). pose proof (own_plane p a Pa) as Pa'. pose proof (own_plane q b Qb) as Qb'.
  pose proof (planes_differ a b low low_b Dl Dl') as N. fold n m in N.
  destruct (on_common_line n m (minus q p) N) as (i & Ei).
  { unfold n, normal. rewrite <- side_difference, Pb, Qb'. ring. }
  { unfold m, normal. rewrite <- side_difference, Pa', Qa. ring. }
  assert (Eq : q = along p i (cross n m)).
  { apply point_eq in Ei. unfold along, minus, origin in *. cbn [x y z] in Ei. apply same_point; cbn [x y z]; lra. }
  clear Ei. rewrite Eq in Lq, Hq, T. rewrite along_opposite in Hq, T.
  destruct (order_of_points a b low low_b p i Dl Dl' Lp Lq) as (_ & Low).
  assert (Top : along p (i - j) (cross n m) = along (along p k (cross n m)) (i - j - k) (cross n m))
    by (generalize (cross n m); intros; by_coordinates).
  rewrite Top in Hq. destruct (order_of_points a b high high_b _ (i - j - k) Dh Dh' Hp Hq) as (High & _).
  rewrite Low, High.
  assert (Back : forall u,
    along (along p i (cross n m)) u (minus (along p (i - j) (cross n m)) (along p i (cross n m))) =
    along p (i - u * j) (cross n m)) by (intros; generalize (cross n m); intros; by_coordinates).
  split.
  - intros (s & Sa & Sb). pose proof (proj1 (S s) (conj Sa (own_plane s b Sb))) as (u & U & Es).
    pose proof (proj1 (T s) (conj Sb (own_plane s a Sa))) as (v & V & Et).
    rewrite along_along in Es. rewrite Back, Es in Et. apply along_injective in Et; auto.
    pose proof (Rmult_le_pos u k (proj1 U) K). pose proof (Rmult_le_pos v j (proj1 V) J).
    pose proof (Rmult_le_compat_r k u 1 K (proj2 U)). pose proof (Rmult_le_compat_r j v 1 J (proj2 V)). lra.
  - intros (H & L). assert (W : exists w, 0 <= w <= k /\ 0 <= i - w <= j)
      by (destruct (Rle_or_lt i k); [exists i | exists k]; lra).
    destruct W as (w & Wk & Wj). exists (along p w (cross n m)).
    destruct (ratio w k Wk) as (u & U & Eu). destruct (ratio (i - w) j Wj) as (v & V & Ev). split.
    + apply (S _). exists u. split; auto. now rewrite along_along, Eu.
    + apply (T _). exists v. split; auto. rewrite Back. f_equal. lra.
Qed.
