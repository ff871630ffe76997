(** The first contact of vertex and edge, and of two vertices, in closed form (ccd/contact/vertex_edge_time.hpp). It
    is over the real numbers, since the code's integers and signs are exact. Results:
        first_root_right      `first_root_nonpositive`: the first root of f in (0, 1) with b <= 0, every branch
        first_contact_right   `first_vertex_edge_contact` returns the first contact, or that there is none
        first_bracket_right   the bracket of its result is that of the first contact
        vertices_time_right   the same for `first_vertex_vertex_contact` *)

From Coq Require Import Reals Lra Psatz List Bool.
From Errbound Require Import Sign Bernstein Contact VertexEdge Separation FirstContact TimeBrackets.
Import ListNotations.
Open Scope R_scope.

(** ** first_root_nonpositive *)

Theorem first_root_right f b : sign_inside (coefficients f) = uncertain ->
  root_told f b (first_root_nonpositive f b).
Proof. exact (first_root_told f b). Qed.

(** ** Vertex and edge *)

Definition first_of_quadratics (f0 f1 f2 b : quadratic) : place_in_time :=
  if certainly_rootless (coefficients f0) then nowhere
  else if certainly_rootless (coefficients f1) then nowhere
  else if certainly_rootless (coefficients f2) then nowhere
  else if same_sign (sign_throughout (coefficients b)) positive then nowhere
  else if touches f0 f1 f2 b c0 then start_time
  else
    let at_end := if touches f0 f1 f2 b c2 then end_time else nowhere in
    let or_at_end inside := match inside with nowhere => at_end | _ => inside end in
    if same_sign (sign_inside (coefficients b)) positive then at_end
    else match common_roots [f0; f1; f2] with
      | none => at_end
      | one m => or_at_end (if nonpositive (value_at_squares b m) then linear_root (- c1 m) (c0 m) else nowhere)
      | of_quadratic f => or_at_end (first_root_nonpositive f b)
      | everywhere =>
          if nonpositive (c2 b) || (below_0 (c1 b) && nonpositive (4 * (c0 b * c2 b) - c1 b * c1 b))
          then first_root_nonpositive b b
          else at_end
      end.
Definition first_vertex_edge_contact (v e0 e1 : moving) : place_in_time :=
  first_of_quadratics (cross_x v e0 e1) (cross_y v e0 e1) (cross_z v e0 e1) (VertexEdge.between v e0 e1).

Definition time_told (H : R -> Prop) (place : place_in_time) : Prop :=
  (place = nowhere /\ forall t, 0 <= t <= 1 -> ~ H t) \/ exists r, tells place r /\ first H r.
(** The same in (0, 1). *)
Definition inside_told (H : R -> Prop) (place : place_in_time) : Prop :=
  (place = nowhere /\ forall t, 0 < t < 1 -> ~ H t) \/
  exists r, tells place r /\ 0 < r < 1 /\ H r /\ forall t, 0 < t < r -> ~ H t.

Lemma or_at_end_told H place (at_1 : bool) : ~ H 0 -> (at_1 = true <-> H 1) -> inside_told H place ->
  time_told H (match place with nowhere => if at_1 then end_time else nowhere | _ => place end).
Proof.
  intros N0 A1 [(-> & No) | (r & Told & R0 & Hr & Before)].
  - destruct at_1.
    + right. exists 1. split; [easy |]. split; [lra |]. split; [now apply A1 |]. intros s S Hs.
      destruct (Req_dec s 0) as [-> |]; [easy |]. apply (No s); auto. lra.
    + left. split; auto. intros t T Ht. destruct (Req_dec t 0) as [-> |]; [easy |].
      destruct (Req_dec t 1) as [-> |]; [apply A1 in Ht; discriminate |]. apply (No t); auto. lra.
  - right. exists r. assert (F : first H r).
    { split; [lra |]. split; auto. intros s S Hs. destruct (Req_dec s 0) as [-> |]; [easy |]. apply (Before s); auto.
      lra. }
    destruct place; try easy; now split.
Qed.

Lemma quadratic_continuous b : continuity (quadratic_at b).
Proof. unfold quadratic_at, value. reg. Qed.
(** Positive at 0 and without roots up to t. *)
Lemma no_root_positive b t : 0 < c0 b -> 0 < t -> (forall s, 0 < s <= t -> quadratic_at b s <> 0) ->
  0 < quadratic_at b t.
Proof.
  intros B T No. apply Rnot_le_lt. intros L.
  destruct (IVT_cor (quadratic_at b) 0 t (quadratic_continuous b)) as (s & S & Z); [lra | |].
  - rewrite (proj1 (at_ends b)). nra.
  - destruct (Req_dec s 0) as [-> |]; [rewrite (proj1 (at_ends b)) in Z; lra |]. apply (No s); auto. lra.
Qed.

Lemma everywhere_told b : 0 < c0 b -> same_sign (sign_inside (coefficients b)) positive = false ->
  nonpositive (c2 b) || (below_0 (c1 b) && nonpositive (4 * (c0 b * c2 b) - c1 b * c1 b)) = true ->
  time_told (fun t => quadratic_at b t <= 0) (first_root_nonpositive b b).
Proof.
  intros B0 S C. assert (U : sign_inside (coefficients b) = uncertain).
  { assert (E : c1 b < 0 \/ c2 b <= 0).
    { apply orb_prop in C. destruct C as [C | C]; [right; now apply nonpositive_true |]. apply andb_prop in C.
      destruct C as (C & _). unfold below_0 in C. destruct (Rlt_dec (c1 b) 0); [now left | discriminate]. }
    revert S. unfold sign_inside, coefficients. cbn [sign_inside_from sign_of reals].
    rewrite (sign_positive (c0 b) B0). cases_of_sign (c1 b); cases_of_sign (c2 b); cbn; try easy; lra. }
  destruct (first_root_right b b U) as [(E & No) | (r & Told & R0 & Zr & _ & Before)].
  - left. split; auto.
    assert (Free : forall t, 0 < t < 1 -> quadratic_at b t <> 0) by (intros t T Z; specialize (No t T Z); lra).
    intros t T L. destruct (Req_dec t 0) as [-> | N0]; [rewrite (proj1 (at_ends b)) in L; lra |].
    destruct (Req_dec t 1) as [-> | N1].
    2: { enough (0 < quadratic_at b t) by lra. apply no_root_positive; auto; [lra |]. intros s Hs. apply Free. lra. }
    rewrite (proj2 (at_ends b)) in L. destruct (both_signs b U) as (_ & Neg). destruct L as [L | L].
    + destruct (IVT_cor (quadratic_at b) 0 1 (quadratic_continuous b)) as (s & Hs & Z); [lra | |].
      { rewrite (proj1 (at_ends b)), (proj2 (at_ends b)). nra. }
      destruct (Req_dec s 0) as [-> |]; [rewrite (proj1 (at_ends b)) in Z; lra |].
      destruct (Req_dec s 1) as [-> |]; [rewrite (proj2 (at_ends b)) in Z; lra |]. apply (Free s); auto. lra.
    + assert (N : c1 b < 0) by lra. set (s := c0 b / (c0 b - c1 b)).
      assert (Es : s * (c0 b - c1 b) = c0 b) by (unfold s; field; lra). apply (Free s); [split; nra |].
      unfold quadratic_at, value. rewrite L.
      transitivity ((1 - s) * (c0 b - s * (c0 b - c1 b))); [ring |]. rewrite Es. ring.
  - right. exists r. split; auto. split; [lra |]. split; [lra |]. intros s Hs L.
    destruct (Req_dec s 0) as [-> | N0]; [rewrite (proj1 (at_ends b)) in L; lra |].
    enough (0 < quadratic_at b s) by lra. apply no_root_positive; auto; [lra |]. intros t T Z.
    assert (0 < quadratic_at b t) by (apply Before; auto; lra). lra.
Qed.

Theorem first_contact_right f0 f1 f2 b : time_told (meets f0 f1 f2 b) (first_of_quadratics f0 f1 f2 b).
Proof.
  unfold first_of_quadratics.
  assert (Rootless : forall f, certainly_rootless (coefficients f) = true -> In f [f0; f1; f2] ->
    time_told (meets f0 f1 f2 b) nowhere).
  { intros f C I. left. split; auto. intros t T (V & _).
    destruct (rootless_hull _ t C T). rewrite at_time_quadratic. now apply (proj1 (Forall_forall _ _) V). }
  destruct (certainly_rootless (coefficients f0)) eqn:R0; [apply (Rootless f0); simpl; auto |].
  destruct (certainly_rootless (coefficients f1)) eqn:R1; [apply (Rootless f1); simpl; auto |].
  destruct (certainly_rootless (coefficients f2)) eqn:R2; [apply (Rootless f2); simpl; auto |].
  clear Rootless R0 R1 R2.
  destruct (same_sign (sign_throughout (coefficients b)) positive) eqn:H.
  { left. split; auto. intros t T (_ & B). pose proof (sign_throughout_right (coefficients b) t T) as S.
    destruct (sign_throughout (coefficients b)); try discriminate.
    rewrite at_time_quadratic in S. simpl in S. lra. }
  clear H. destruct (touches_true f0 f1 f2 b) as (T0 & T1).
  destruct (touches f0 f1 f2 b c0) eqn:S0.
  { right. exists 0. split; [easy |]. split; [lra |]. split; [now apply T0 | intros s S; lra]. }
  assert (N0 : ~ meets f0 f1 f2 b 0) by (intros M; apply T0 in M; discriminate).
  set (at_1 := touches f0 f1 f2 b c2) in *. clearbody at_1. clear S0. cbv zeta.
  assert (AtEnd : (forall t, 0 < t < 1 -> ~ meets f0 f1 f2 b t) ->
    time_told (meets f0 f1 f2 b) (if at_1 then end_time else nowhere)).
  { intros No. apply (or_at_end_told _ nowhere at_1 N0 T1). now left. }
  destruct (same_sign (sign_inside (coefficients b)) positive) eqn:H.
  { apply AtEnd. intros t T (_ & B). pose proof (sign_inside_right (coefficients b) t T) as S.
    destruct (sign_inside (coefficients b)); try discriminate.
    rewrite at_time_quadratic in S. simpl in S. lra. }
  pose proof (common_roots_right [f0; f1; f2]) as K.
  destruct (common_roots [f0; f1; f2]) as [| m | f |]; simpl in K.
  - apply AtEnd. intros t T (V & _). now apply (K t T) in V.
  - apply or_at_end_told; auto. destruct K as (k & t & P & T & Sq & Only).
    pose proof (value_squares b m k t Sq) as Vb. destruct Sq as (Q0 & Q1 & Q2).
    destruct (nonpositive (value_at_squares b m)) eqn:E.
    + apply nonpositive_true in E. rewrite Vb in E. right. exists t. split; [| split; auto; split].
      * assert (0 < c0 m) by (rewrite Q0; apply Rmult_lt_0_compat; [| apply pow_lt]; lra).
        assert (0 < c1 m) by (rewrite Q1; apply Rmult_lt_0_compat; [| apply Rmult_lt_0_compat]; lra).
        split; [nra |]. split; [right; lra |]. unfold linear_at. rewrite Q0, Q1. ring.
      * split; [now apply Only | nra].
      * intros s S (V & _). apply Only in V; lra.
    + left. split; auto. intros s S (V & B). apply Only in V; auto. subst s.
      enough (nonpositive (value_at_squares b m) = true) by congruence. apply nonpositive_true. rewrite Vb. nra.
  - apply or_at_end_told; auto. destruct K as (U & Same).
    destruct (first_root_right f b U) as [(E & No) | (r & Told & R0 & Z & B & Before)].
    + left. split; auto. intros t T (V & B). apply Same in V; auto. specialize (No t T V). lra.
    + right. exists r. split; auto. split; auto. split; [split; auto; now apply Same |].
      intros t T (V & B'). apply Same in V; [| lra]. specialize (Before t T V). lra.
  - assert (B0 : 0 < c0 b).
    { rewrite <- (proj1 (at_ends b)). apply Rnot_le_lt. intros B. apply N0. now split. }
    assert (M : forall t, meets f0 f1 f2 b t <-> quadratic_at b t <= 0)
      by (intros t; split; [now intros (_ & B) | now split]).
    destruct (nonpositive (c2 b) || _) eqn:C.
    + destruct (everywhere_told b B0 H C) as [(E & No) | (r & Told & T & B & Before)].
      * left. split; auto. intros t T. rewrite M. auto.
      * right. exists r. split; auto. split; auto. split; [now apply M |]. intros s S. rewrite M. auto.
    + apply AtEnd. intros t T. rewrite M, (proj2 (inside_ratio b t T)). intros L.
      apply orb_false_elim in C. destruct C as (C2 & C1).
      assert (B2 : 0 < c2 b).
      { apply Rnot_le_lt. intros Q. apply nonpositive_true in Q. congruence. }
      destruct (proj2 (dips b B0 B2)) as (D1 & D2).
      { exists (t / (1 - t)). split; auto. apply Rdiv_lt_0_compat; lra. }
      apply andb_false_elim in C1. destruct C1 as [C1 | C1].
      * unfold below_0 in C1. destruct (Rlt_dec (c1 b) 0); [discriminate | easy].
      * apply nonpositive_true in D2. congruence.
Qed.

(** ** Brackets *)

Section Brackets.

Context (double : R -> Prop) (double_0 : double 0) (double_1 : double 1).

Definition place_bracket (place : place_in_time) (b : bracket) : Prop :=
  match place with
  | nowhere => False
  | start_time => b = (0, 0)
  | end_time => b = (1, 1)
  | linear_root k0 k1 => linear_bracket double k0 k1 b
  | quadratic_root f which => quadratic_bracket double f which b
  end.
Lemma told_bracket place r b : tells place r -> place_bracket place b -> holds_time double b r.
Proof.
  destruct place as [| | | k0 k1 | f [| |]]; simpl.
  - easy.
  - intros -> ->. left. auto.
  - intros -> ->. left. auto.
  - intros (S & N & Z) B. destruct (linear_bracket_right double double_0 double_1 k0 k1 b S N B) as (t & _ & H & Only).
    apply Only in Z. now subst.
  - intros (R0 & Z & Before & After) B. exact (quadratic_only_right double f r b R0 Before Z After B).
  - intros (k & q & N & O & E) B. exact (quadratic_first_right double double_0 double_1 f k r q N O E b B).
  - intros (k & p & N & O & E) B. exact (quadratic_second_right double double_0 double_1 f k p r N O E b B).
Qed.

Theorem first_bracket_right v e0 e1 : let place := first_vertex_edge_contact v e0 e1 in
  (place = nowhere /\ ~ vertex_edge_collides v e0 e1) \/
  place <> nowhere /\
    exists t, first (vertex_on_edge v e0 e1) t /\ forall b, place_bracket place b -> holds_time double b t.
Proof.
  intros place. unfold place, first_vertex_edge_contact.
  destruct (first_contact_right (cross_x v e0 e1) (cross_y v e0 e1) (cross_z v e0 e1) (VertexEdge.between v e0 e1))
    as [(E & No) | (r & Told & T & H & Before)].
  - left. split; auto. intros (t & T & H). apply (No t T). now apply meets_contact.
  - right. split; [intros E; now rewrite E in Told |]. exists r.
    split; [| intros b B; now apply told_bracket with (2 := B)]. split; auto.
    split; [now apply meets_contact |]. intros s S Hs. apply (Before s S). now apply meets_contact.
Qed.

(** ** Two vertices *)

(** vertices_touch, then the first component of W that is not zero at t = 0. *)
Definition vertices_touch (v w : moving) : Prop :=
  cross (minus (start v) (start w)) (minus (finish v) (finish w)) = origin /\
  dot (minus (start v) (start w)) (minus (finish v) (finish w)) <= 0.
Definition moving_component (v w : moving) : place_in_time :=
  let p := minus (start v) (start w) in let q := minus (finish v) (finish w) in
  if negb (is_0 (x p)) then linear_root (x p) (x q)
  else if negb (is_0 (y p)) then linear_root (y p) (y q)
  else if negb (is_0 (z p)) then linear_root (z p) (z q)
  else start_time.

Lemma component_first (c : point -> R) v w t : (forall a b s, place a s = place b s ->
    linear_at (c (minus (start a) (start b))) (c (minus (finish a) (finish b))) s = 0) ->
  c (minus (start v) (start w)) <> 0 -> 0 <= t <= 1 -> place v t = place w t ->
  tells (linear_root (c (minus (start v) (start w))) (c (minus (finish v) (finish w)))) t /\
  first (fun s => place v s = place w s) t.
Proof.
  intros L N T E. pose proof (L v w t E) as Z. 
  set (k0 := c (minus (start v) (start w))) in *. set (k1 := c (minus (finish v) (finish w))) in *.
  unfold linear_at in Z.
  assert (T0 : t <> 0) by (intros ->; lra).
  assert (Ek : k1 * t = - (k0 * (1 - t))) by lra.
  assert (S : k0 * k1 <= 0).
  { assert (Sq : 0 <= k0 * k0 * (1 - t)) by (apply Rmult_le_pos; [apply Rle_0_sqr | lra]).
    assert (P : k0 * k1 * t = - (k0 * k0 * (1 - t))) by (rewrite Rmult_assoc, Ek; ring).
    apply Rnot_lt_le. intros Q. assert (0 < k0 * k1 * t) by (apply Rmult_lt_0_compat; lra). lra. }
  split; [repeat split; auto |]. split; auto. split; auto. intros s Hs Es. apply (L v w s) in Es. fold k0 k1 in Es.
  unfold linear_at in Es. assert (D : k0 - k1 <> 0) by nra.
  assert ((k0 - k1) * (t - s) = 0) as P by lra. apply Rmult_integral in P. destruct P; lra.
Qed.
Theorem vertices_time_right v w : (~ vertices_touch v w -> ~ vertex_vertex_collides v w) /\
  (vertices_touch v w -> exists t, first (fun s => place v s = place w s) t /\
    forall b, place_bracket (moving_component v w) b -> holds_time double b t).
Proof.
  split; intros H.
  { intros C. apply vertex_vertex_contact in C. easy. }
  apply vertex_vertex_contact in H. destruct H as (t & T & E).
  enough (exists t, tells (moving_component v w) t /\ first (fun s => place v s = place w s) t) as (r & Told & F).
  { exists r. split; auto. intros b B. now apply told_bracket with (2 := B). }
  unfold moving_component. cbv zeta.
  destruct (is_0 (x (minus (start v) (start w)))) eqn:X; cbn [negb].
  2: { exists t. apply (component_first x); auto.
       - intros a b s Q. apply point_eq in Q. unfold place, linear_at, minus in *. cbn [x y z] in *. lra.
       - intros Z. apply is_0_true in Z. congruence. }
  destruct (is_0 (y (minus (start v) (start w)))) eqn:Y; cbn [negb].
  2: { exists t. apply (component_first y); auto.
       - intros a b s Q. apply point_eq in Q. unfold place, linear_at, minus in *. cbn [x y z] in *. lra.
       - intros Z. apply is_0_true in Z. congruence. }
  destruct (is_0 (z (minus (start v) (start w)))) eqn:W; cbn [negb].
  2: { exists t. apply (component_first z); auto.
       - intros a b s Q. apply point_eq in Q. unfold place, linear_at, minus in *. cbn [x y z] in *. lra.
       - intros Z. apply is_0_true in Z. congruence. }
  exists 0. split; [easy |]. split; [lra |]. split; [| intros s S; lra].
  apply is_0_true in X, Y, W. unfold place, minus in *. cbn [x y z] in *. apply same_point; cbn [x y z]; lra.
Qed.

End Brackets.
