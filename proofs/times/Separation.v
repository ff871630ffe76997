(** Distance of two moving features in time, over the real numbers. ccd/contact/condition.cpp finds the first time at
    which they are within d, and ccd/contact/separation.cpp excludes such times. D is d squared. Results:
        distance_continuous       the distance changes by at most the features' speed multiplied by the time
        vertices_first_within, vertex_edge_first_within, face_first_within, edges_first_within   if they are ever
            within
            d, there is a first time: 0, or one with Z = 0 where the sides hold, for one of the conditions; and Z < 0
                for
            none of those whose sides hold
        face_apart, edges_apart, vertex_edge_apart, vertices_apart   features that an axis separates at both ends by
            more
            than d times its length are farther apart than d throughout
        coordinates_apart         the same for the code's rounded differences of coordinates *)

From Coq Require Import Reals ZArith Lra Psatz List.
From Flocq Require Import Core.
From Errbound Require Import Contact Distance.
Import ListNotations.
Open Scope R_scope.

(** ** Length *)

Definition norm (v : point) : R := sqrt (dot v v).
Lemma norm_nonnegative v : 0 <= norm v.
Proof. apply sqrt_pos. Qed.
Lemma norm_square v : norm v * norm v = dot v v.
Proof. apply sqrt_sqrt, square_nonnegative. Qed.
Lemma norm_below v r : 0 <= r -> dot v v <= r * r -> norm v <= r.
Proof. intros R0 H. pose proof (norm_nonnegative v). pose proof (norm_square v). nra. Qed.
Lemma dot_below v w : dot v w <= norm v * norm w.
Proof.
  pose proof (norm_nonnegative v) as V. pose proof (norm_nonnegative w) as W.
  assert (H : dot v w * dot v w <= (norm v * norm w) * (norm v * norm w)).
  { replace (norm v * norm w * (norm v * norm w)) with ((norm v * norm v) * (norm w * norm w)) by ring.
    rewrite !norm_square. pose proof (square_nonnegative (cross v w)) as C.
    replace (dot (cross v w) (cross v w)) with (dot v v * dot w w - dot v w * dot v w) in C
      by (coordinates; ring). lra. }
  assert (0 <= norm v * norm w) by now apply Rmult_le_pos. nra.
Qed.
Lemma norm_along p s v : norm (along p s v) <= norm p + Rabs s * norm v.
Proof.
  pose proof (norm_nonnegative p). pose proof (norm_nonnegative v). pose proof (Rabs_pos s).
  apply norm_below; [apply Rplus_le_le_0_compat; auto; now apply Rmult_le_pos |].
  replace (dot (along p s v) (along p s v)) with (dot p p + 2 * (s * dot p v) + s * s * dot v v)
    by (coordinates; ring).
  rewrite <- !norm_square.
  assert (s * dot p v <= Rabs s * (norm p * norm v)).
  { pose proof (dot_below p v). unfold Rabs. destruct (Rcase_abs s) as [N | N].
    - pose proof (dot_below p (along origin (-1) v)) as K.
      replace (dot p (along origin (-1) v)) with (- dot p v) in K by (coordinates; ring).
      replace (norm (along origin (-1) v)) with (norm v) in K by (unfold norm; f_equal; coordinates; ring). nra.
    - apply Rmult_le_compat_l; lra. }
  assert (s * s = Rabs s * Rabs s) by (rewrite <- Rabs_mult; symmetry; apply Rabs_pos_eq; nra). nra.
Qed.
Lemma norm_minus p q : norm (minus p q) <= norm p + norm q.
Proof.
  replace (minus p q) with (along p (-1) q) by (coordinates; apply same_point; simpl; ring).
  eapply Rle_trans; [apply norm_along |]. rewrite Rabs_left by lra. lra.
Qed.

(** ** Differences of two features: all pairs of their points, moving linearly *)

Definition family : Type := moving -> Prop.
Definition family_near (K : family) (D t : R) : Prop := exists m, K m /\ dot (place m t) (place m t) <= D.
Definition speed (m : moving) : R := norm (minus (finish m) (start m)).
Definition bounded (K : family) (L : R) : Prop := 0 <= L /\ forall m, K m -> speed m <= L.
Definition squared_distance (K : family) (t m : R) : Prop := distances (fun D => family_near K D t) m.

Theorem distance_continuous K L s t m n : bounded K L -> squared_distance K s m -> squared_distance K t n ->
  sqrt n <= sqrt m + L * Rabs (t - s).
Proof.
  intros (L0 & B) (M0 & M) (N0 & N). destruct (proj2 (M m) (Rle_refl m)) as (p & Kp & Hp).
  pose proof (B p Kp) as Sp. pose proof (Rabs_pos (t - s)) as T. pose proof (sqrt_pos m).
  assert (Ep : place p t = along (place p s) (t - s) (minus (finish p) (start p)))
    by (unfold place; coordinates; apply same_point; simpl; ring).
  assert (H1 : norm (place p t) <= sqrt m + L * Rabs (t - s)).
  { rewrite Ep. eapply Rle_trans; [apply norm_along |]. fold (speed p). apply Rplus_le_compat.
    - now apply sqrt_le_1_alt.
    - rewrite Rmult_comm. now apply Rmult_le_compat_r. }
  apply Rle_trans with (norm (place p t)); auto. apply sqrt_le_1_alt, N. exists p. split; auto. lra.
Qed.

(** ** The first time *)

Definition first (H : R -> Prop) (t : R) : Prop := 0 <= t <= 1 /\ H t /\ forall s, 0 <= s < t -> ~ H s.
(** If a property that holds at some time fails in an open set of times, it holds at a first time. *)
Lemma least_time (H : R -> Prop) : sometime H ->
  (forall s, 0 <= s <= 1 -> ~ H s -> exists e, s < e /\ forall t, s <= t < e -> ~ H t) ->
  exists t, first H t.
Proof.
  intros (b & B & Hb) Open. destruct (Classical_Prop.classic (H 0)) as [H0 | H0].
  { exists 0. split; [lra |]. split; auto. intros s S. lra. }
  set (E := fun t => 0 <= t <= 1 /\ forall r, 0 <= r <= t -> ~ H r).
  destruct (completeness E) as (s & Up & Least).
  { exists 1. intros t (T & _). lra. }
  { exists 0. split; [lra |]. intros r R0. replace r with 0 by lra. easy. }
  assert (S0 : 0 <= s). { apply Up. split; [lra |]. intros r R0. now replace r with 0 by lra. }
  assert (Sb : s <= b).
  { apply Least. intros t (T & F). destruct (Rle_or_lt t b); auto. exfalso. apply (F b); auto. lra. }
  assert (Before : forall t, 0 <= t < s -> ~ H t).
  { intros t T Ht. enough (s <= t) by lra. apply Least. intros r (R0 & F).
    destruct (Rle_or_lt r t); auto. exfalso. apply (F t); auto. lra. }
  exists s. split; [lra |]. split; auto. apply Classical_Prop.NNPP. intros N.
  destruct (Open s ltac:(lra) N) as (e & Ee & F). assert (s <> b) by now intros ->.
  set (t := Rmin ((s + e) / 2) b).
  assert (T : s < t /\ t <= (s + e) / 2 /\ t <= b)
    by (unfold t, Rmin; destruct (Rle_dec ((s + e) / 2) b); lra).
  enough (t <= s) by lra. apply Up. split; [lra |]. intros r R0.
  destruct (Rlt_or_le r s); [apply Before; lra | apply F; lra].
Qed.

Section First.

Context (K : family) (L : R) (slow : bounded K L) (measured : forall t, exists m, squared_distance K t m).

(** A distance above or below d stays so for a while, before and after. *)
Lemma stays_apart D s : ~ family_near K D s -> exists e, 0 < e /\ forall t, Rabs (t - s) < e -> ~ family_near K D t.
Proof.
  intros N. destruct (measured s) as (m & M). pose proof slow as (L0 & _).
  assert (Dm : D < m) by (apply Rnot_le_lt; intros H; apply N, M, H).
  destruct (Rlt_or_le D 0) as [Neg | D0].
  { exists 1. split; [lra |]. intros t _ Q. destruct Q as (p & _ & Q).
    pose proof (square_nonnegative (place p t)). lra. }
  assert (G : sqrt D < sqrt m) by now apply sqrt_lt_1_alt.
  exists ((sqrt m - sqrt D) / (L + 1)). split; [apply Rdiv_lt_0_compat; lra |]. intros t T Q.
  destruct (measured t) as (n & Nn). apply Nn in Q. apply sqrt_le_1_alt in Q.
  pose proof (distance_continuous K L t s n m slow Nn M) as C. rewrite Rabs_minus_sym in C.
  assert (E : (sqrt m - sqrt D) / (L + 1) * (L + 1) = sqrt m - sqrt D) by (field; lra).
  pose proof (Rabs_pos (t - s)). nra.
Qed.
Lemma stays_nearer D s m : 0 < s -> squared_distance K s m -> m < D -> exists t, 0 <= t < s /\ family_near K D t.
Proof.
  intros S M H. pose proof slow as (L0 & _). pose proof (proj1 M) as M0.
  assert (G : sqrt m < sqrt D) by (apply sqrt_lt_1_alt; lra). set (r := (sqrt D - sqrt m) / (L + 1)).
  assert (R0 : 0 < r) by (apply Rdiv_lt_0_compat; lra).
  assert (E : r * (L + 1) = sqrt D - sqrt m) by (unfold r; field; lra).
  exists (Rmax 0 (s - r)). pose proof (Rmax_l 0 (s - r)). pose proof (Rmax_r 0 (s - r)).
  set (t := Rmax 0 (s - r)) in *. assert (T : t < s) by (apply Rmax_lub_lt; lra). split; [lra |].
  destruct (measured t) as (n & Nn). apply Nn. pose proof (proj1 Nn) as N0. apply sqrt_le_0; try lra.
  pose proof (distance_continuous K L s t m n slow M Nn) as C. rewrite Rabs_left in C by lra.
  assert (L * - (t - s) <= L * r) by (apply Rmult_le_compat_l; lra). nra.
Qed.

Lemma first_near D : sometime (family_near K D) -> exists t, first (family_near K D) t.
Proof.
  intros H. apply least_time; auto. intros s _ N. destruct (stays_apart D s N) as (e & E & F).
  exists (s + e). split; [lra |]. intros t T. apply F. rewrite Rabs_pos_eq; lra.
Qed.

Context (near_at : R -> R -> Prop) (conditions : R -> list condition)
  (reads : forall D t, family_near K D t <-> near_at D t) (formed : forall t, Forall well_formed (conditions t))
  (complete : forall D t, near_at D t <-> Exists (holds D) (conditions t)).

(** A root of some Z at which its sides hold, where no Z whose sides hold is negative. *)
Definition met (D : R) (all : list condition) : Prop :=
  Exists (fun c => sides c /\ excess D c = 0) all /\ forall c, In c all -> sides c -> 0 <= excess D c.
Lemma first_within D : sometime (near_at D) ->
  exists t, first (near_at D) t /\ (t = 0 \/ met D (conditions t)).
Proof.
  intros (b & B & H). destruct (first_near D) as (t & T & N & First).
  { exists b. split; auto. now apply reads. }
  exists t. split. { split; auto. split; [now apply reads |]. intros s S Q. apply (First s S). now apply reads. }
  destruct (Req_dec t 0) as [E | E]; [now left | right]. destruct (measured t) as (m & M).
  assert (Far : forall c, In c (conditions t) -> sides c -> 0 <= excess D c).
  { intros c I S. apply Rnot_lt_le. intros Q. pose proof (formed t) as W. rewrite Forall_forall in W.
    assert (C : forall D', family_near K D' t <-> Exists (holds D') (conditions t))
      by (intros D'; rewrite reads; apply complete).
    pose proof (nearer _ (conditions t) m D c M C I (W c I) S Q) as Near.
    destruct (stays_nearer D t m ltac:(lra) M Near) as (s & Hs & Ns). now apply (First s). }
  split; auto. apply reads, complete, Exists_exists in N. destruct N as (c & I & S & Q). apply Exists_exists.
  exists c. split; auto. split; auto. specialize (Far c I S). lra.
Qed.

End First.

(** ** The families of the four kinds *)

Definition segment_of (e0 e1 : moving) (u : R) : moving := Moving
  (along (start e0) u (minus (start e1) (start e0))) (along (finish e0) u (minus (finish e1) (finish e0))).
Definition point_of_face (f0 f1 f2 : moving) (u w : R) : moving := Moving
  (along (along (start f0) u (minus (start f1) (start f0))) w (minus (start f2) (start f0)))
  (along (along (finish f0) u (minus (finish f1) (finish f0))) w (minus (finish f2) (finish f0))).
Definition difference (p q : moving) : moving :=
  Moving (minus (start p) (start q)) (minus (finish p) (finish q)).
Lemma place_difference p q t : place (difference p q) t = minus (place p t) (place q t).
Proof. unfold place. coordinates. apply same_point; simpl; ring. Qed.
Lemma place_segment e0 e1 u t :
  place (segment_of e0 e1 u) t = along (place e0 t) u (minus (place e1 t) (place e0 t)).
Proof. unfold place. coordinates. apply same_point; simpl; ring. Qed.
Lemma place_face f0 f1 f2 u w t : place (point_of_face f0 f1 f2 u w) t =
  along (along (place f0 t) u (minus (place f1 t) (place f0 t))) w (minus (place f2 t) (place f0 t)).
Proof. unfold place. coordinates. apply same_point; simpl; ring. Qed.

Lemma speed_difference p q : speed (difference p q) <= speed p + speed q.
Proof.
  unfold speed. eapply Rle_trans; [| apply norm_minus]. right. f_equal.
  unfold difference. coordinates. apply same_point; simpl; ring.
Qed.
Lemma speed_segment e0 e1 u : 0 <= u <= 1 -> speed (segment_of e0 e1 u) <= speed e0 + speed e1.
Proof.
  intros U. unfold speed. set (d0 := minus (finish e0) (start e0)). set (d1 := minus (finish e1) (start e1)).
  replace (minus (finish (segment_of e0 e1 u)) (start (segment_of e0 e1 u)))
    with (along (along origin (1 - u) d0) u d1)
    by (unfold segment_of, d0, d1; coordinates; apply same_point; simpl; ring).
  pose proof (norm_along (along origin (1 - u) d0) u d1) as A. pose proof (norm_along origin (1 - u) d0) as B.
  rewrite Rabs_pos_eq in A, B by lra. pose proof (norm_nonnegative d0). pose proof (norm_nonnegative d1).
  assert (norm origin = 0) by (unfold norm; replace (dot origin origin) with 0 by (coordinates; ring); apply sqrt_0).
  nra.
Qed.
Lemma speed_face f0 f1 f2 u w : 0 <= u -> 0 <= w -> u + w <= 1 ->
  speed (point_of_face f0 f1 f2 u w) <= speed f0 + speed f1 + speed f2.
Proof.
  intros U W S. unfold speed. set (d0 := minus (finish f0) (start f0)). set (d1 := minus (finish f1) (start f1)).
  set (d2 := minus (finish f2) (start f2)).
  replace (minus (finish (point_of_face f0 f1 f2 u w)) (start (point_of_face f0 f1 f2 u w)))
    with (along (along (along origin (1 - u - w) d0) u d1) w d2)
    by (unfold point_of_face, d0, d1, d2; coordinates; apply same_point; simpl; ring).
  pose proof (norm_along (along (along origin (1 - u - w) d0) u d1) w d2) as A.
  pose proof (norm_along (along origin (1 - u - w) d0) u d1) as B. pose proof (norm_along origin (1 - u - w) d0) as C.
  rewrite Rabs_pos_eq in A, B, C by lra.
  pose proof (norm_nonnegative d0). pose proof (norm_nonnegative d1). pose proof (norm_nonnegative d2).
  assert (norm origin = 0) by (unfold norm; replace (dot origin origin) with 0 by (coordinates; ring); apply sqrt_0).
  nra.
Qed.

Definition vertex_vertex_family (v w : moving) : family := fun m => m = difference v w.
Definition vertex_edge_family (v e0 e1 : moving) : family :=
  fun m => exists u, 0 <= u <= 1 /\ m = difference v (segment_of e0 e1 u).
Definition face_family (v f0 f1 f2 : moving) : family :=
  fun m => exists u w, 0 <= u /\ 0 <= w /\ u + w <= 1 /\ m = difference v (point_of_face f0 f1 f2 u w).
Definition edges_family (a0 a1 b0 b1 : moving) : family :=
  fun m => exists s t, 0 <= s <= 1 /\ 0 <= t <= 1 /\ m = difference (segment_of a0 a1 s) (segment_of b0 b1 t).

Lemma vertex_vertex_family_near v w D t :
  family_near (vertex_vertex_family v w) D t <-> near D (place v t) (place w t).
Proof.
  unfold family_near, vertex_vertex_family, near. rewrite <- place_difference. split.
  - now intros (m & -> & H).
  - intros H. eauto.
Qed.
Lemma vertex_edge_family_near v e0 e1 D t :
  family_near (vertex_edge_family v e0 e1) D t <-> vertex_edge_near D (place v t) (place e0 t) (place e1 t).
Proof.
  unfold family_near, vertex_edge_family, vertex_edge_near, near, in_segment. split.
  - intros (m & (u & U & ->) & H). rewrite place_difference, place_segment in H. eauto 6.
  - intros (q & (u & U & ->) & H). exists (difference v (segment_of e0 e1 u)).
    rewrite place_difference, place_segment. eauto.
Qed.
Lemma face_family_near v f0 f1 f2 D t : family_near (face_family v f0 f1 f2) D t <->
  face_near D (place v t) (place f0 t) (place f1 t) (place f2 t).
Proof.
  unfold family_near, face_family, face_near, near, in_triangle. split.
  - intros (m & (u & w & U & W & S & ->) & H). rewrite place_difference, place_face in H.
    eexists. split; [| exact H]. eauto 6.
  - intros (q & (u & w & U & W & S & ->) & H). exists (difference v (point_of_face f0 f1 f2 u w)).
    rewrite place_difference, place_face. split; auto. eauto 6.
Qed.
Lemma edges_family_near a0 a1 b0 b1 D t : family_near (edges_family a0 a1 b0 b1) D t <->
  edges_near D (place a0 t) (place a1 t) (place b0 t) (place b1 t).
Proof.
  unfold family_near, edges_family, edges_near, near, in_segment. split.
  - intros (m & (s & r & S & T & ->) & H). rewrite place_difference, !place_segment in H.
    do 2 eexists. split; [| split; [| exact H]]; eauto.
  - intros (p & q & (s & S & ->) & (r & T & ->) & H).
    exists (difference (segment_of a0 a1 s) (segment_of b0 b1 r)).
    rewrite place_difference, !place_segment. split; auto. eauto 6.
Qed.

Lemma vertex_vertex_slow v w : bounded (vertex_vertex_family v w) (speed v + speed w).
Proof.
  split; [apply Rplus_le_le_0_compat; apply norm_nonnegative |]. intros m ->. apply speed_difference.
Qed.
Lemma vertex_edge_slow v e0 e1 : bounded (vertex_edge_family v e0 e1) (speed v + (speed e0 + speed e1)).
Proof.
  split; [repeat apply Rplus_le_le_0_compat; apply norm_nonnegative |]. intros m (u & U & ->).
  eapply Rle_trans; [apply speed_difference |]. apply Rplus_le_compat_l. now apply speed_segment.
Qed.
Lemma face_slow v f0 f1 f2 : bounded (face_family v f0 f1 f2) (speed v + (speed f0 + speed f1 + speed f2)).
Proof.
  split; [repeat apply Rplus_le_le_0_compat; apply norm_nonnegative |]. intros m (u & w & U & W & S & ->).
  eapply Rle_trans; [apply speed_difference |]. apply Rplus_le_compat_l. now apply speed_face.
Qed.
Lemma edges_slow a0 a1 b0 b1 :
  bounded (edges_family a0 a1 b0 b1) (speed a0 + speed a1 + (speed b0 + speed b1)).
Proof.
  split; [repeat apply Rplus_le_le_0_compat; apply norm_nonnegative |]. intros m (s & t & S & T & ->).
  eapply Rle_trans; [apply speed_difference |]. apply Rplus_le_compat; now apply speed_segment.
Qed.

Lemma same_distances (P Q : R -> Prop) : (forall D, P D <-> Q D) ->
  (exists m, distances Q m) -> exists m, distances P m.
Proof. intros E (m & M0 & M). exists m. split; auto. intros D. now rewrite E. Qed.
Lemma vertex_vertex_measured v w t : exists m, squared_distance (vertex_vertex_family v w) t m.
Proof.
  exists (dot (minus (place v t) (place w t)) (minus (place v t) (place w t))).
  split; [apply square_nonnegative |]. intros D. apply vertex_vertex_family_near.
Qed.
Lemma vertex_edge_measured v e0 e1 t : exists m, squared_distance (vertex_edge_family v e0 e1) t m.
Proof. eapply same_distances; [intros D; apply vertex_edge_family_near | apply vertex_edge_distance]. Qed.
Lemma face_measured v f0 f1 f2 t : exists m, squared_distance (face_family v f0 f1 f2) t m.
Proof. eapply same_distances; [intros D; apply face_family_near | apply face_distance]. Qed.
Lemma edges_measured a0 a1 b0 b1 t : exists m, squared_distance (edges_family a0 a1 b0 b1) t m.
Proof. eapply same_distances; [intros D; apply edges_family_near | apply edges_distance]. Qed.

(** The condition W W - D, whose weight is 1. *)
Definition vertices_conditions (v w : point) : list condition := [corner_condition v w].

Theorem vertices_first_within v w D : sometime (fun t => near D (place v t) (place w t)) ->
  exists t, first (fun t => near D (place v t) (place w t)) t /\
    (t = 0 \/ met D (vertices_conditions (place v t) (place w t))).
Proof.
  apply (first_within _ _ (vertex_vertex_slow v w) (vertex_vertex_measured v w)
    (fun D t => near D (place v t) (place w t)) (fun t => vertices_conditions (place v t) (place w t))).
  - intros D' t. apply vertex_vertex_family_near.
  - intros t. repeat constructor. apply corner_well_formed.
  - intros D' t. unfold vertices_conditions. rewrite Exists_cons, Exists_nil, corner_holds. tauto.
Qed.
Ltac first_within_by slow measured near_at conditions_at family well_formed union :=
  apply (first_within _ _ slow measured near_at conditions_at);
  [intros D' t; apply family | intros t; apply well_formed | intros D' t; apply union].
Theorem vertex_edge_first_within v e0 e1 D :
  sometime (fun t => vertex_edge_near D (place v t) (place e0 t) (place e1 t)) ->
  exists t, first (fun t => vertex_edge_near D (place v t) (place e0 t) (place e1 t)) t /\
    (t = 0 \/ met D (vertex_edge_conditions (place v t) (place e0 t) (place e1 t))).
Proof.
  first_within_by (vertex_edge_slow v e0 e1) (vertex_edge_measured v e0 e1)
    (fun D t => vertex_edge_near D (place v t) (place e0 t) (place e1 t))
    (fun t => vertex_edge_conditions (place v t) (place e0 t) (place e1 t))
    vertex_edge_family_near vertex_edge_well_formed vertex_edge_within.
Qed.
Theorem face_first_within v f0 f1 f2 D :
  sometime (fun t => face_near D (place v t) (place f0 t) (place f1 t) (place f2 t)) ->
  exists t, first (fun t => face_near D (place v t) (place f0 t) (place f1 t) (place f2 t)) t /\
    (t = 0 \/ met D (face_conditions (place v t) (place f0 t) (place f1 t) (place f2 t))).
Proof.
  first_within_by (face_slow v f0 f1 f2) (face_measured v f0 f1 f2)
    (fun D t => face_near D (place v t) (place f0 t) (place f1 t) (place f2 t))
    (fun t => face_conditions (place v t) (place f0 t) (place f1 t) (place f2 t))
    face_family_near all_face_well_formed face_within_union.
Qed.
Theorem edges_first_within a0 a1 b0 b1 D :
  sometime (fun t => edges_near D (place a0 t) (place a1 t) (place b0 t) (place b1 t)) ->
  exists t, first (fun t => edges_near D (place a0 t) (place a1 t) (place b0 t) (place b1 t)) t /\
    (t = 0 \/ met D (edges_conditions (place a0 t) (place a1 t) (place b0 t) (place b1 t))).
Proof.
  first_within_by (edges_slow a0 a1 b0 b1) (edges_measured a0 a1 b0 b1)
    (fun D t => edges_near D (place a0 t) (place a1 t) (place b0 t) (place b1 t))
    (fun t => edges_conditions (place a0 t) (place a1 t) (place b0 t) (place b1 t))
    edges_family_near all_edges_well_formed edges_within_union.
Qed.

(** ** Axes *)

(** All of ps are above all of qs along n, by more than d times its length, at both ends. *)
Definition above_along (n : point) (d : R) (ps qs : list moving) : Prop :=
  forall p q, In p ps -> In q qs ->
    d * norm n < dot n (minus (start p) (start q)) /\ d * norm n < dot n (minus (finish p) (finish q)).

Lemma far_along n d w : 0 <= d -> d * norm n < dot n w -> d * d < dot w w.
Proof.
  intros D0 H. pose proof (dot_below n w) as B. pose proof (norm_nonnegative n) as N.
  pose proof (norm_nonnegative w) as W. rewrite <- norm_square.
  assert (d < norm w).
  { destruct (Rle_or_lt (norm w) d) as [Q |]; auto.
    pose proof (Rmult_le_compat_r (norm n) (norm w) d N Q). lra. }
  nra.
Qed.
Lemma above_place n d ps qs p q t : above_along n d ps qs -> In p ps -> In q qs -> 0 <= t <= 1 ->
  d * norm n < dot n (minus (place p t) (place q t)).
Proof.
  intros H P Q T. destruct (H p q P Q) as (S & F). apply segment_beyond with (2 := S) (3 := F).
  exists t. split; auto. unfold place. vector.
Qed.
Lemma above_triangle n r p q a b c : in_triangle q a b c -> r < dot n (minus p a) -> r < dot n (minus p b) ->
  r < dot n (minus p c) -> r < dot n (minus p q).
Proof.
  rewrite !dot_minus. intros Q A B C. pose proof (triangle_beyond (along origin (-1) n) (r - dot n p) q a b c Q) as H.
  rewrite !dot_opposite in H. lra.
Qed.
Lemma above_segment n r p q a b : in_segment q a b -> r < dot n (minus p a) -> r < dot n (minus p b) ->
  r < dot n (minus p q).
Proof.
  rewrite !dot_minus. intros Q A B. pose proof (segment_beyond (along origin (-1) n) (r - dot n p) q a b Q) as H.
  rewrite !dot_opposite in H. lra.
Qed.
Lemma either_way n d ps qs : above_along n d ps qs \/ above_along n d qs ps -> exists m, above_along m d ps qs.
Proof.
  intros [H | H]; [now exists n |]. exists (along origin (-1) n). intros p q P Q. destruct (H q p Q P) as (A & B).
  replace (norm (along origin (-1) n)) with (norm n) by (unfold norm; f_equal; coordinates; ring).
  split; [eapply Rlt_le_trans; [exact A |] | eapply Rlt_le_trans; [exact B |]]; right; coordinates; ring.
Qed.

Theorem vertices_apart n d v w t : 0 <= d -> 0 <= t <= 1 ->
  above_along n d [v] [w] \/ above_along n d [w] [v] -> ~ near (d * d) (place v t) (place w t).
Proof.
  intros D0 T A N. apply either_way in A. destruct A as (m & H).
  pose proof (above_place m d _ _ v w t H (or_introl eq_refl) (or_introl eq_refl) T) as F.
  apply far_along in F; auto. unfold near in N. lra.
Qed.
Theorem vertex_edge_apart n d v e0 e1 t : 0 <= d -> 0 <= t <= 1 ->
  above_along n d [v] [e0; e1] \/ above_along n d [e0; e1] [v] ->
  ~ vertex_edge_near (d * d) (place v t) (place e0 t) (place e1 t).
Proof.
  intros D0 T A (q & Q & N). apply either_way in A. destruct A as (m & H).
  assert (F : d * norm m < dot m (minus (place v t) q))
    by (apply above_segment with (1 := Q); eapply above_place; try eassumption; simpl; auto).
  apply far_along in F; auto. unfold near in N. lra.
Qed.
Theorem face_apart n d v f0 f1 f2 t : 0 <= d -> 0 <= t <= 1 ->
  above_along n d [v] [f0; f1; f2] \/ above_along n d [f0; f1; f2] [v] ->
  ~ face_near (d * d) (place v t) (place f0 t) (place f1 t) (place f2 t).
Proof.
  intros D0 T A (q & Q & N). apply either_way in A. destruct A as (m & H).
  assert (F : d * norm m < dot m (minus (place v t) q))
    by (apply above_triangle with (1 := Q); eapply above_place; try eassumption; simpl; auto).
  apply far_along in F; auto. unfold near in N. lra.
Qed.
Theorem edges_apart n d a0 a1 b0 b1 t : 0 <= d -> 0 <= t <= 1 ->
  above_along n d [a0; a1] [b0; b1] \/ above_along n d [b0; b1] [a0; a1] ->
  ~ edges_near (d * d) (place a0 t) (place a1 t) (place b0 t) (place b1 t).
Proof.
  intros D0 T A (p & q & P & Q & N). apply either_way in A. destruct A as (m & H).
  assert (Far : forall a, In a [a0; a1] -> d * norm m + dot m q < dot m (place a t)).
  { intros a I. enough (d * norm m < dot m (minus (place a t) q)) by (rewrite dot_minus in *; lra).
    apply above_segment with (1 := Q); eapply above_place; try eassumption; simpl; auto. }
  assert (F : d * norm m + dot m q < dot m p) by (apply segment_beyond with (1 := P); apply Far; simpl; auto).
  assert (F' : d * norm m < dot m (minus p q)) by (rewrite dot_minus; lra).
  apply far_along in F'; auto. unfold near in N. lra.
Qed.

(** ** Coordinates: separated_by_coordinates of ccd/contact/separation.cpp *)

Section Rounded.

Context (fexp : Z -> Z) {valid : Valid_exp fexp} (direction : R -> Z) {valid_direction : Valid_rnd direction}.
Notation fl := (round radix2 fexp direction).

(** If a rounded difference exceeds a number of the format, the difference does. *)
Lemma rounded_above distance a : generic_format radix2 fexp distance -> distance < fl a -> distance < a.
Proof.
  intros F L. apply Rnot_le_lt. intros Q. apply (round_le radix2 fexp direction) in Q.
  rewrite (round_generic radix2 fexp direction distance F) in Q. lra.
Qed.
(** The next number above a rounded one exceeds the number that was rounded. *)
Lemma next_above a : a <= succ radix2 fexp (fl a).
Proof. apply succ_round_ge_id; auto. Qed.

Inductive coordinate := x_axis | y_axis | z_axis.
Definition coordinate_of (c : coordinate) : point -> R := match c with x_axis => x | y_axis => y | z_axis => z end.
Definition unit_axis (c : coordinate) : point :=
  match c with x_axis => Point 1 0 0 | y_axis => Point 0 1 0 | z_axis => Point 0 0 1 end.
(** above *)
Definition coordinates_above (c : coordinate) (distance : R) (ps qs : list moving) : Prop :=
  forall p q, In p ps -> In q qs ->
    distance < fl (coordinate_of c (start p) - coordinate_of c (start q)) /\
    distance < fl (coordinate_of c (finish p) - coordinate_of c (finish q)).

(** The code's distance: the sum of both thicknesses, rounded, and the next number above it. *)
Theorem coordinates_apart c d0 d1 ps qs : let distance := succ radix2 fexp (fl (d0 + d1)) in
  coordinates_above c distance ps qs -> above_along (unit_axis c) (d0 + d1) ps qs.
Proof.
  intros distance A p q P Q. assert (F : generic_format radix2 fexp distance)
    by (apply generic_format_succ; auto; apply generic_format_round; auto). destruct (A p q P Q) as (S & T).
  apply (rounded_above distance) in S, T; auto. pose proof (next_above (d0 + d1)) as N. fold distance in N.
  assert (One : norm (unit_axis c) = 1).
  { unfold norm. replace (dot (unit_axis c) (unit_axis c)) with 1; [apply sqrt_1 |].
    destruct c; unfold unit_axis; coordinates; ring. }
  assert (Dot : forall a b, dot (unit_axis c) (minus a b) = coordinate_of c a - coordinate_of c b)
    by (intros a b; destruct c; unfold unit_axis, coordinate_of; coordinates; ring).
  rewrite One, !Dot. lra.
Qed.

End Rounded.
