(** Margins of Y and the G_i for which features are farther apart than a distance d
    (ccd/exact/static_filter/distance_margins.hpp), over the real numbers. Results:
        plane_face_apart, plane_edges_apart       |Y| > d |N|: farther apart than d
        outside_face_apart, outside_edges_apart   the same if G_i < - d |N| L, with the length L of its direction
        normal_below, length_below                |N| is at most its longest control vector, a difference at most the
                                                  longer of its ends
        margins_face_apart, margins_edges_apart   consequences of control values beyond the margins, on the step or
                                                  a subinterval *)

From Coq Require Import Reals Lra Psatz List.
From Errbound Require Import Contact Distance Subdivision Separation FirstContact.
Import ListNotations.
Open Scope R_scope.

(** ** At a time *)

Definition opposite_of (v : point) : point := minus origin v.
Lemma beyond v m d k : 0 <= d -> norm m <= k -> d * k < dot v m -> d * d < dot v v.
Proof.
  intros D K H. pose proof (dot_below v m) as B. pose proof (norm_nonnegative m) as M. pose proof (norm_nonnegative v) as V.
  rewrite <- norm_square. assert (d < norm v); [| nra]. apply Rnot_le_lt. intros L.
  assert (norm v * norm m <= d * k) by (apply Rmult_le_compat; auto). lra.
Qed.
Lemma norm_opposite v : norm (opposite_of v) = norm v.
Proof. unfold norm, opposite_of. f_equal. coordinates. ring. Qed.
Lemma beyond_either v m d k : 0 <= d -> norm m <= k -> d * k < Rabs (dot v m) -> d * d < dot v v.
Proof.
  intros D K H. unfold Rabs in H. destruct (Rcase_abs (dot v m)) as [N | N].
  - apply (beyond v (opposite_of m) d k); auto; [now rewrite norm_opposite |].
    replace (dot v (opposite_of m)) with (- dot v m) by (unfold opposite_of; coordinates; ring). lra.
  - now apply (beyond v m d k).
Qed.
Lemma norm_cross v w : norm (cross v w) <= norm v * norm w.
Proof.
  apply norm_below; [apply Rmult_le_pos; apply norm_nonnegative |].
  replace (norm v * norm w * (norm v * norm w)) with ((norm v * norm v) * (norm w * norm w)) by ring.
  rewrite !norm_square. replace (dot v v * dot w w) with (dot (cross v w) (cross v w) + dot v w * dot v w)
    by (coordinates; ring). assert (0 <= dot v w * dot v w) by apply Rle_0_sqr. lra.
Qed.
Lemma norm_cross_below v w k l : norm v <= k -> norm w <= l -> norm (cross v w) <= k * l.
Proof.
  intros K L. eapply Rle_trans; [apply norm_cross |].
  apply Rmult_le_compat; auto using norm_nonnegative.
Qed.

Section Face.

Variables v f0 f1 f2 : point.
Let B := minus f1 f0.
Let C := minus f2 f0.
Let P := minus v f0.
Let N := cross B C.

(** The distance from a point of the triangle. *)
Lemma from_triangle q : in_triangle q f0 f1 f2 -> exists u w, 0 <= u /\ 0 <= w /\ 0 <= 1 - u - w /\
  minus v q = along (along P (- u) B) (- w) C.
Proof.
  intros (u & w & U & W & S & ->). exists u, w. repeat split; auto; try lra.
  unfold P, B, C. coordinates. apply same_point; simpl; ring.
Qed.
Theorem plane_face_apart d n : 0 <= d -> norm N <= n -> d * n < Rabs (det B C P) -> ~ face_near (d * d) v f0 f1 f2.
Proof.
  intros D Hn H (q & T & Near). destruct (from_triangle q T) as (u & w & _ & _ & _ & E).
  enough (d * d < dot (minus v q) (minus v q)) by (unfold near in Near; lra).
  apply (beyond_either _ N d n); auto. rewrite E. unfold N.
  replace (dot _ _) with (det B C P) by (unfold det; coordinates; ring). auto.
Qed.
Theorem outside_face_apart d n l : 0 <= d -> norm N <= n -> norm B <= l -> norm C <= l -> norm (minus C B) <= l ->
  Exists (fun g => g < - (d * (n * l))) [weight_2 B C P; weight_1 B C P; weight_0 B C P] -> ~ face_near (d * d) v f0 f1 f2.
Proof.
  intros D Hn Hb Hc He H (q & T & Near). destruct (from_triangle q T) as (u & w & U & W & S & E).
  enough (d * d < dot (minus v q) (minus v q)) by (unfold near in Near; lra).
  assert (N2 : 0 <= dot N N) by apply square_nonnegative.
  rewrite !Exists_cons, Exists_nil in H. destruct H as [H | [H | [H | []]]].
  - apply (beyond _ (opposite_of (cross N B)) d (n * l)); auto; [rewrite norm_opposite; now apply norm_cross_below |].
    rewrite E. replace (dot _ _) with (w * dot N N - weight_2 B C P)
      by (unfold weight_2, opposite_of, N; coordinates; ring). nra.
  - apply (beyond _ (opposite_of (cross C N)) d (n * l)); auto;
      [rewrite norm_opposite, Rmult_comm; now apply norm_cross_below |].
    rewrite E. replace (dot _ _) with (u * dot N N - weight_1 B C P)
      by (unfold weight_1, opposite_of, N; coordinates; ring). nra.
  - apply (beyond _ (cross (minus C B) N) d (n * l)); auto; [rewrite Rmult_comm; now apply norm_cross_below |].
    rewrite E. replace (dot _ _) with ((1 - u - w) * dot N N - weight_0 B C P)
      by (unfold weight_0, weight_1, weight_2, N; coordinates; ring). nra.
Qed.

End Face.

Section Edges.

Variables a0 a1 b0 b1 : point.
Let B := minus a1 a0.
Let C := minus b1 b0.
Let P := minus b0 a0.
Let N := cross B C.

Lemma from_segments p q : in_segment p a0 a1 -> in_segment q b0 b1 -> exists s t, 0 <= s <= 1 /\ 0 <= t <= 1 /\
  minus q p = along (along P (- s) B) t C.
Proof.
  intros (s & S & ->) (t & T & ->). exists s, t. repeat split; try lra.
  unfold P, B, C. coordinates. apply same_point; simpl; ring.
Qed.
Lemma apart_edges d : (forall p q, in_segment p a0 a1 -> in_segment q b0 b1 -> d * d < dot (minus q p) (minus q p)) ->
  ~ edges_near (d * d) a0 a1 b0 b1.
Proof. intros H (p & q & S & T & Near). specialize (H p q S T). apply near_sym in Near. unfold near in Near. lra. Qed.
Theorem plane_edges_apart d n : 0 <= d -> norm N <= n -> d * n < Rabs (det B C P) -> ~ edges_near (d * d) a0 a1 b0 b1.
Proof.
  intros D Hn H. apply apart_edges. intros p q Sp Sq. destruct (from_segments p q Sp Sq) as (s & t & _ & _ & E).
  apply (beyond_either _ N d n); auto. rewrite E. unfold N.
  replace (dot _ _) with (det B C P) by (unfold det; coordinates; ring). auto.
Qed.
Theorem outside_edges_apart d n l : 0 <= d -> norm N <= n -> norm B <= l -> norm C <= l ->
  Exists (fun g => g < - (d * (n * l)))
    [on_a B C P; square_normal B C - on_a B C P; on_b B C P; square_normal B C - on_b B C P] ->
  ~ edges_near (d * d) a0 a1 b0 b1.
Proof.
  intros D Hn Hb Hc H. apply apart_edges. intros p q Sp Sq. destruct (from_segments p q Sp Sq) as (s & t & S & T & E).
  assert (N2 : 0 <= square_normal B C) by apply square_nonnegative.
  assert (Kc : norm (cross C N) <= n * l) by (rewrite Rmult_comm; now apply norm_cross_below).
  assert (Kb : norm (cross B N) <= n * l) by (rewrite Rmult_comm; now apply norm_cross_below).
  rewrite !Exists_cons, Exists_nil in H. destruct H as [H | [H | [H | [H | []]]]].
  - apply (beyond _ (opposite_of (cross C N)) d (n * l)); auto; [now rewrite norm_opposite |].
    rewrite E. replace (dot _ _) with (s * square_normal B C - on_a B C P)
      by (unfold on_a, square_normal, opposite_of, N; coordinates; ring). nra.
  - apply (beyond _ (cross C N) d (n * l)); auto.
    rewrite E. replace (dot _ _) with ((1 - s) * square_normal B C - (square_normal B C - on_a B C P))
      by (unfold on_a, square_normal, N; coordinates; ring). nra.
  - apply (beyond _ (opposite_of (cross B N)) d (n * l)); auto; [now rewrite norm_opposite |].
    rewrite E. replace (dot _ _) with (t * square_normal B C - on_b B C P)
      by (unfold on_b, square_normal, opposite_of, N; coordinates; ring). nra.
  - apply (beyond _ (cross B N) d (n * l)); auto.
    rewrite E. replace (dot _ _) with ((1 - t) * square_normal B C - (square_normal B C - on_b B C P))
      by (unfold on_b, square_normal, N; coordinates; ring). nra.
Qed.

End Edges.

(** ** During the step *)

Lemma length_below (v w : moving) t k : 0 <= t <= 1 -> norm (minus (start v) (start w)) <= k ->
  norm (minus (finish v) (finish w)) <= k -> norm (minus (place v t) (place w t)) <= k.
Proof.
  intros T K0 K1.
  replace (minus (place v t) (place w t)) with
    (along (along origin (1 - t) (minus (start v) (start w))) t (minus (finish v) (finish w)))
    by (unfold place; coordinates; apply same_point; simpl; ring).
  eapply Rle_trans; [apply norm_along |].
  assert (norm (along origin (1 - t) (minus (start v) (start w))) <= norm origin + Rabs (1 - t) * norm (minus (start v) (start w)))
    by apply norm_along.
  assert (norm origin = 0) by (unfold norm; replace (dot origin origin) with 0 by (coordinates; ring); apply sqrt_0).
  rewrite (Rabs_pos_eq (1 - t)), (Rabs_pos_eq t) in * by lra.
  assert ((1 - t) * norm (minus (start v) (start w)) <= (1 - t) * k) by (apply Rmult_le_compat_l; lra).
  assert (t * norm (minus (finish v) (finish w)) <= t * k) by (apply Rmult_le_compat_l; lra). lra.
Qed.
(** N = s² N0 + s t N1 + t² N2; its control vectors are N0, N1/2 and N2. *)
Lemma normal_below (a b c e : moving) t n : 0 <= t <= 1 ->
  let B0 := minus (start a) (start b) in let B1 := minus (finish a) (finish b) in
  let C0 := minus (start c) (start e) in let C1 := minus (finish c) (finish e) in
  norm (cross B0 C0) <= n -> norm (along (cross B0 C1) 1 (cross B1 C0)) <= 2 * n -> norm (cross B1 C1) <= n ->
  norm (cross (minus (place a t) (place b t)) (minus (place c t) (place e t))) <= n.
Proof.
  intros T B0 B1 C0 C1 N0 N1 N2.
  replace (cross (minus (place a t) (place b t)) (minus (place c t) (place e t))) with
    (along (along (along origin ((1 - t) * (1 - t)) (cross B0 C0)) ((1 - t) * t) (along (cross B0 C1) 1 (cross B1 C0)))
      (t * t) (cross B1 C1))
    by (unfold B0, B1, C0, C1, place; coordinates; apply same_point; simpl; ring).
  assert (Z : norm origin = 0) by (unfold norm; replace (dot origin origin) with 0 by (coordinates; ring); apply sqrt_0).
  assert (P0 : 0 <= (1 - t) * (1 - t)) by nra. assert (P1 : 0 <= (1 - t) * t) by nra. assert (P2 : 0 <= t * t) by nra.
  eapply Rle_trans; [apply norm_along |]. rewrite (Rabs_pos_eq (t * t)) by auto.
  eapply Rle_trans; [apply Rplus_le_compat_r, norm_along |]. rewrite (Rabs_pos_eq ((1 - t) * t)) by auto.
  eapply Rle_trans; [apply Rplus_le_compat_r, Rplus_le_compat_r, norm_along |].
  rewrite (Rabs_pos_eq ((1 - t) * (1 - t))), Z by auto.
  apply (Rmult_le_compat_l _ _ _ P0) in N0. apply (Rmult_le_compat_l _ _ _ P1) in N1.
  apply (Rmult_le_compat_l _ _ _ P2) in N2. lra.
Qed.

(** Control values above or below a number, on the step or a subinterval. *)
Lemma control_above p m t : length p = 4%nat \/ length p = 5%nat -> Forall (Rlt m) p -> 0 <= t <= 1 -> m < control_at p t.
Proof.
  intros L F T.
  assert (E : control_at (map (fun a => a - m) p) t = control_at p t - m).
  { destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try (destruct L; discriminate); cbn [map];
      [rewrite !control_cubic | rewrite !control_quartic]; simpl; ring. }
  enough (0 < control_at (map (fun a => a - m) p) t) by lra. apply all_positive; auto.
  - now rewrite map_length.
  - rewrite Forall_map. revert F. apply Forall_impl. intros a A. lra.
Qed.
Lemma control_below p m t : length p = 4%nat \/ length p = 5%nat -> Forall (fun a => a < m) p -> 0 <= t <= 1 ->
  control_at p t < m.
Proof.
  intros L F T. assert (E : control_at (map Ropp p) t = - control_at p t).
  { destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try (destruct L; discriminate); cbn [map];
      [rewrite !control_cubic | rewrite !control_quartic]; simpl; ring. }
  enough (- m < control_at (map Ropp p) t) by lra. apply control_above; auto.
  - now rewrite map_length.
  - rewrite Forall_map. revert F. apply Forall_impl. intros a A. lra.
Qed.

(** The code's control values are 3 times Y's and 12 times those of the G_i. *)
Definition excludes (d n l : R) (Y : list R) (Gs : list (list R)) : Prop :=
  Forall (Rlt (3 * (d * n))) Y \/ Forall (fun a => a < - (3 * (d * n))) Y \/
  Exists (Forall (fun a => a < - (12 * (d * (n * l))))) Gs.
Definition stand_for (u : R) (Y : list R) (Gs : list (list R)) (y : R) (gs : list R) : Prop :=
  length Y = 4%nat /\ control_at Y u = 3 * y /\ Forall2 (fun G g => length G = 5%nat /\ control_at G u = 12 * g) Gs gs.
Lemma excluded_at d n l Y Gs u y gs : 0 <= u <= 1 -> stand_for u Y Gs y gs -> excludes d n l Y Gs ->
  0 <= d * n -> d * n < Rabs y \/ Exists (fun g => g < - (d * (n * l))) gs.
Proof.
  intros U (L & Ey & F) [A | [A | A]] Dn.
  - left. apply control_above with (t := u) in A; auto. rewrite Rabs_pos_eq; lra.
  - left. apply control_below with (t := u) in A; auto. rewrite Rabs_left; lra.
  - right. induction F as [| G g Gs gs (Lg & Eg) F IH]; [now apply Exists_nil in A |].
    apply Exists_cons in A. apply Exists_cons. destruct A as [A | A]; auto. left.
    apply control_below with (t := u) in A; auto. lra.
Qed.

Theorem margins_face_apart v f0 f1 f2 d n l Y Gs t u : 0 <= t <= 1 -> 0 <= u <= 1 -> 0 <= d -> 0 <= n ->
  let at_time p q := minus (place p t) (place q t) in
  let B := at_time f1 f0 in let C := at_time f2 f0 in let P := at_time v f0 in
  norm (cross B C) <= n -> norm B <= l -> norm C <= l -> norm (at_time f2 f1) <= l ->
  stand_for u Y Gs (face_y v f0 f1 f2 t) [weight_2 B C P; weight_1 B C P; weight_0 B C P] -> excludes d n l Y Gs ->
  ~ face_near (d * d) (place v t) (place f0 t) (place f1 t) (place f2 t).
Proof.
  intros T U D N0 at_time B C P N Lb Lc Le S X.
  destruct (excluded_at d n l Y Gs u _ _ U S X) as [H | H]; [nra | |].
  - apply plane_face_apart with n; auto.
  - apply outside_face_apart with n l; auto.
    replace (minus (minus (place f2 t) (place f0 t)) (minus (place f1 t) (place f0 t))) with (at_time f2 f1); auto.
    unfold at_time. coordinates. apply same_point; simpl; ring.
Qed.
Theorem margins_edges_apart a0 a1 b0 b1 d n l Y Gs t u : 0 <= t <= 1 -> 0 <= u <= 1 -> 0 <= d -> 0 <= n ->
  let at_time p q := minus (place p t) (place q t) in
  let B := at_time a1 a0 in let C := at_time b1 b0 in let P := at_time b0 a0 in
  norm (cross B C) <= n -> norm B <= l -> norm C <= l ->
  stand_for u Y Gs (edges_y a0 a1 b0 b1 t)
    [on_a B C P; square_normal B C - on_a B C P; on_b B C P; square_normal B C - on_b B C P] -> excludes d n l Y Gs ->
  ~ edges_near (d * d) (place a0 t) (place a1 t) (place b0 t) (place b1 t).
Proof.
  intros T U D N0 at_time B C P N Lb Lc S X.
  destruct (excluded_at d n l Y Gs u _ _ U S X) as [H | H]; [nra | |].
  - apply plane_edges_apart with n; auto.
  - apply outside_edges_apart with n l; auto.
Qed.
