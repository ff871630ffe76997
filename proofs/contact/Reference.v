(** The reference (ccd/exact/reference.cpp): every decision is right, given doubles, common_factor and real_roots as
    in UnboundedIntegers.v. Results:
        reference_face, reference_edges, reference_vertex_edge, reference_vertex_vertex   it returns `collides`
            exactly
                                    if the features collide *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Errbound Require Import RootIsolation Sign Bernstein Bsc Contact Decisions AxisUnits UnboundedIntegers.
From Errbound Require VertexEdge.
Import ListNotations.
Open Scope R_scope.

Section Reference.

Variable finder : root_finder.
Notation form_at := (@at_time integers).
Notation five gs := (Forall (fun g : list integers => length g = 5%nat) gs).
Implicit Types (y g n f : list integers) (gs : list (list integers)).

(** ** regular_contact *)

Definition contact_at (sign_there : list integers -> sign) (n2 : list integers) gs : bool :=
  if same_sign (sign_there n2) zero then false
  else forallb (fun f => negb (same_sign (sign_there f) negative)) gs.
Definition at_start f : sign := @sign_of integers (hd 0%Z f).
Definition at_end f : sign := @sign_of integers (last f 0%Z).
Definition at_root (k : root finder) f : sign := sign_at_root finder (without_end_roots f) k.

Definition regular_contact y gs (n2 : list integers) : bool :=
  if @certainly_rootless integers y then false
  else if existsb (fun f => same_sign (@sign_throughout integers f) negative) gs then false
  else if Z.eqb (hd 0%Z y) 0 && contact_at at_start n2 gs then true
  else if Z.eqb (last y 0%Z) 0 && contact_at at_end n2 gs then true
  else match without_end_roots y with
    | [] | [_] => false
    | inner => existsb (fun k => contact_at (at_root k) n2 gs) (real_roots finder inner)
    end.

(** The hypotheses about the finder. *)
Definition regular_meets (d : demands) y gs (n2 : list integers) : Prop :=
  let inner := without_end_roots y in
  of_roots d inner /\ Forall (fun f => of_signs d inner (without_end_roots f)) (n2 :: gs).

Definition regular_at y gs (n2 : list integers) (t : R) : Prop :=
  form_at y t = 0 /\ form_at n2 t <> 0 /\ Forall (fun g => 0 <= form_at g t) gs.

Lemma contact_at_right sign_there n2 gs t :
  (forall f, In f (n2 :: gs) -> tells (sign_there f) (form_at f t)) -> contact_at sign_there n2 gs = true <-> form_at n2 t <> 0 /\ Forall (fun g => 0 <= form_at g t) gs.
Proof.
  intros T. unfold contact_at.
  assert (A : forallb (fun f => negb (same_sign (sign_there f) negative)) gs = true <-> Forall (fun g =>
    0 <= form_at g t) gs).
  { rewrite forallb_forall, Forall_forall. assert (E : forall g, In g gs ->
      negb (same_sign (sign_there g) negative) = true <-> 0 <= form_at g t).
    { intros g I. destruct (T g (or_intror I)) as (C & R).
      destruct (sign_there g); simpl in *; split; easy || lra. }
    split; intros H g I; now apply E, H. }
  destruct (T n2 (or_introl eq_refl)) as (C & R).
  destruct (sign_there n2); simpl in *; try easy; rewrite A; split; try tauto; intuition lra.
Qed.

Lemma ends_of f : length f = 4%nat \/ length f = 5%nat ->
  form_at f 0 = IZR (hd 0%Z f) /\ form_at f 1 = IZR (last f 0%Z).
Proof.
  intros [L | L]; [destruct (length_4 f L) as (? & ? & ? & ? & ->) | destruct (length_5 f L) as (? & ? &
    ? & ? & ? & ->)];
    unfold at_time; simpl; split; ring.
Qed.
Lemma end_tells f : length f = 5%nat -> tells (at_start f) (form_at f 0) /\ tells (at_end f) (form_at f
  1).
Proof. intros L. destruct (ends_of f (or_intror L)) as (-> & ->). split; apply integer_tells. Qed.

Lemma regular_contact_right y gs n2 : regular_meets (promises finder) y gs n2 -> length y = 4%nat -> five gs -> length n2 = 5%nat ->
  (regular_contact y gs n2 = true -> exists t, 0 <= t <= 1 /\ regular_at y gs n2 t) /\
  (forall t, 0 <= t <= 1 -> regular_at y gs n2 t -> regular_contact y gs n2 = true \/
    0 < t < 1 /\ forall u, form_at y u = 0).
Proof.
  intros (Roots & Signs) L F N. unfold regular_contact, regular_at. destruct (ends_of y (or_introl L)) as (Y0 & Y1).
  destruct (@certainly_rootless integers y) eqn:C.
  { split; [easy |]. intros t T (Z & _). now apply (@rootless_hull integers y t C T) in Z. }
  destruct (existsb _ gs) eqn:O.
  { split; [easy |]. intros t T (_ & _ & G). apply existsb_exists in O. destruct O as (g & I & O).
    rewrite Forall_forall in G. specialize (G g I).
    pose proof (@sign_throughout_right integers g t T) as R.
    destruct (@sign_throughout integers g); try easy. simpl in R. lra. }
  assert (Len : forall f, In f (n2 :: gs) -> length f = 5%nat)
    by (intros f [<- | I]; [exact N | now apply (proj1 (Forall_forall _ _) F)]).
  assert (At0 := contact_at_right at_start n2 gs 0 (fun f I => proj1 (end_tells f (Len f I)))).
  assert (At1 := contact_at_right at_end n2 gs 1 (fun f I => proj2 (end_tells f (Len f I)))).
  assert (Z0 : Z.eqb (hd 0%Z y) 0 = true <-> form_at y 0 = 0)
    by (rewrite Y0, Z.eqb_eq; split; [now intros -> | now intros H; apply eq_IZR in H]).
  assert (Z1 : Z.eqb (last y 0%Z) 0 = true <-> form_at y 1 = 0)
    by (rewrite Y1, Z.eqb_eq; split; [now intros -> | now intros H; apply eq_IZR in H]).
  destruct (Z.eqb (hd 0%Z y) 0 && contact_at at_start n2 gs) eqn:E0.
  { split; auto. intros _. apply andb_prop in E0. exists 0. split; [lra |].
    split; [now apply Z0 | now apply At0]. }
  destruct (Z.eqb (last y 0%Z) 0 && contact_at at_end n2 gs) eqn:E1.
  { split; auto. intros _. apply andb_prop in E1. exists 1. split; [lra |].
    split; [now apply Z1 | now apply At1]. }
  assert (Inside : forall t, 0 <= t <= 1 -> regular_at y gs n2 t -> 0 < t < 1).
  { intros t T (Z & G).
    destruct (Req_dec t 0) as [-> |]; [apply Z0 in Z; apply At0 in G; now rewrite Z, G in E0 |].
    destruct (Req_dec t 1) as [-> |]; [apply Z1 in Z; apply At1 in G; now rewrite Z, G in E1 |]. lra. }
  clear At0 At1 Z0 Z1 E0 E1 Y0 Y1 O C.
  assert (Ny : y <> []) by now destruct y.
  pose proof (fun t => inner_signs y t Ny) as Root. pose proof (without_end_roots_trimmed y) as Tr.
  pose proof (without_end_roots_start y) as Start. pose proof (without_end_roots_empty y) as Empty.
  destruct (without_end_roots y) as [| a [| c l]].
  - split; [easy |]. intros t T R. right. split; auto. intros u. specialize (Empty eq_refl).
    unfold at_time.
    clear - Empty. induction Empty as [| a l <- _ IH]; [easy |]. cbn [map form]. rewrite IH. simpl.
      ring.
  - split; [easy |]. intros t T R. pose proof (proj1 (proj1 (Root t (Inside t T R))) (proj1 R)) as Z.
    destruct Start as [| N0]; [easy |]. unfold poly in *. simpl in *. lra.
  - destruct Start as [| Start]; [easy |].
    assert (Two : (2 <= length (a :: c :: l))%nat) by (simpl; lia). remember (a :: c :: l) as p eqn:Ep.
      clear Ep Empty.
    assert (There : forall t k, 0 < t < 1 -> In k (real_roots finder p) -> where_is finder k = t / (1 -
      t) ->
      contact_at (at_root k) n2 gs = true <-> form_at n2 t <> 0 /\ Forall (fun g => 0 <= form_at g t)
        gs).
    { intros t k T I W. apply contact_at_right. intros f If. pose proof (Len f If) as Lf.
      apply inner_signs; [now destruct f | easy |]. rewrite <- W.
      apply (proj1 (Forall_forall _ _) Signs f If); auto using without_end_roots_trimmed. }
    split.
    + intros E. apply existsb_exists in E. destruct E as (k & I & E).
      destruct (proj1 (Roots Tr Two Start (where_is finder k))) as (X & Z); [now exists k |].
      destruct (proj2 (VertexEdge.by_ratio (fun x => x = where_is finder k))) as (t & T & W); [now
        exists (where_is finder k) |].
      exists t. split; [lra |]. split; [apply Root; auto; now rewrite W | now apply (There t k)].
    + intros t T R. left. pose proof (Inside t T R) as It. destruct R as (Z & G). apply existsb_exists.
      apply (Root t It) in Z.
      destruct (proj2 (Roots Tr Two Start (t / (1 - t)))) as (k & I & W);
        [split; auto; apply Rdiv_lt_0_compat; lra |].
      exists k. split; auto. now apply (There t k).
Qed.

(** ** The decisions *)

Definition reference_decides (edges : bool) (q0 q1 q2 q3 : given) : bool :=
  let i := to_integers [q0; q1; q2; q3] in
  let b := side_b edges difference (i q0) (i q1) (i q2) (i q3) in
  let c := side_c edges difference (i q0) (i q1) (i q2) (i q3) in
  let p := side_p edges difference (i q0) (i q1) (i q2) (i q3) in
  regular_contact (y_form b c p) (inside_forms edges b c p) (normal_squared b c) ||
  query_border_touched finder edges q0 q1 q2 q3.
Definition reference_decides_face : given -> given -> given -> given -> bool := reference_decides false.
Definition reference_decides_edges : given -> given -> given -> given -> bool := reference_decides true.

(** The hypotheses about the finder. *)
Definition reference_meets (edges : bool) (d : demands) (q0 q1 q2 q3 : given) : Prop :=
  let i := to_integers [q0; q1; q2; q3] in
  let b := side_b edges difference (i q0) (i q1) (i q2) (i q3) in
  let c := side_c edges difference (i q0) (i q1) (i q2) (i q3) in
  let p := side_p edges difference (i q0) (i q1) (i q2) (i q3) in
  regular_meets d (y_form b c p) (inside_forms edges b c p) (normal_squared b c) /\
  query_border_meets finder edges d q0 q1 q2 q3.
Definition reference_face_meets : demands -> given -> given -> given -> given -> Prop := reference_meets false.
Definition reference_edges_meets : demands -> given -> given -> given -> given -> Prop := reference_meets true.

Lemma normal_form (b c : @vector_form integers) t : degree b 1 -> degree c 1 ->
  form_at (normal_squared b c) t = square_normal (vector_at b t) (vector_at c t) /\ length
    (normal_squared b c) = 5%nat.
Proof.
  intros B C. destruct (cross_at b c 1 1 t B C) as (E & D). destruct (dot_at _ _ 2 2 t D D) as (Q & L).
  unfold normal_squared, square_normal. now rewrite Q, E.
Qed.
Lemma normal_vanishes b c : square_normal b c <> 0 <-> cross b c <> origin.
Proof.
  unfold square_normal. split; intros N E; apply N; [now apply square_origin | now apply square_0].
Qed.

Lemma query_decides edges (q0 q1 q2 q3 : @moving_point integers) border :
  let m0 := exact_motion q0 in let m1 := exact_motion q1 in let m2 := exact_motion q2 in let m3 := exact_motion q3 in
  border = true <-> query_border edges m0 m1 m2 m3 ->
  let b := side_b edges difference q0 q1 q2 q3 in let c := side_c edges difference q0 q1 q2 q3 in
  let p := side_p edges difference q0 q1 q2 q3 in
  regular_meets (promises finder) (y_form b c p) (inside_forms edges b c p) (normal_squared b c) ->
  regular_contact (y_form b c p) (inside_forms edges b c p) (normal_squared b c) || border = true <->
  query_collides edges m0 m1 m2 m3.
Proof.
  intros m0 m1 m2 m3 Border b c p Valid.
  destruct (query_degrees edges q0 q1 q2 q3) as (Db & Dc & Dp), (query_lengths edges q0 q1 q2 q3) as (L & F).
  fold b c p in Db, Dc, Dp, L, F. destruct (normal_form b c 0 Db Dc) as (_ & N).
  destruct (regular_contact_right _ _ _ Valid L F N) as (To & From).
  pose proof (query_sides_at edges q0 q1 q2 q3) as Sides. fold b c p m0 m1 m2 m3 in Sides.
  assert (R : forall t, regular_at (y_form b c p) (inside_forms edges b c p) (normal_squared b c) t <->
    query_regular_at edges m0 m1 m2 m3 t).
  { intros t. destruct (Sides t) as (Eb & Ec & Ep). rewrite query_regular, <- Eb, <- Ec, <- Ep. unfold regular_at.
    rewrite (proj1 (normal_form b c t Db Dc)), normal_vanishes, (proj1 (forms_y b c p t Db Dc Dp)).
    unfold b, c, p at 2. rewrite (query_weights_at edges q0 q1 q2 q3 (Rle 0) t). tauto. }
  rewrite orb_true_iff, Border, query_union. split.
  - intros [H | H]; [left | now right]. destruct (To H) as (t & T & H'). exists t. split; auto. now apply R.
  - intros [(t & T & H) | H]; [| now right]. apply R in H. destruct (From t T H) as [| (_ & Z)]; [now left |].
    assert (Y : forall u, det (side_b edges minus (place m0 u) (place m1 u) (place m2 u) (place m3 u))
      (side_c edges minus (place m0 u) (place m1 u) (place m2 u) (place m3 u))
      (side_p edges minus (place m0 u) (place m1 u) (place m2 u) (place m3 u)) = 0).
    { intros u. destruct (Sides u) as (<- & <- & <-). now rewrite <- (proj1 (forms_y b c p u Db Dc Dp)). }
    assert (C : query_collides edges m0 m1 m2 m3) by (apply query_union; left; exists t; split; auto; now apply R).
    apply query_coplanar in C; [| easy]. destruct C as [I | B]; [left | now right].
    destruct (From 0 ltac:(lra)) as [| (X & _)]; auto; [| lra]. now apply R, query_inside_regular.
Qed.
Lemma query_reference edges (q0 q1 q2 q3 : given) : reference_meets edges (promises finder) q0 q1 q2 q3 ->
  reference_decides edges q0 q1 q2 q3 = true <->
  query_collides edges (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3).
Proof.
  intros (Regular & Border). destruct (query_in_integers q0 q1 q2 q3) as (K & E0 & E1 & E2 & E3).
  unfold in_integers in *. rewrite <- (query_units _ edges _ _ _ _ K), <- E0, <- E1, <- E2, <- E3.
  apply query_decides; [| exact Regular]. rewrite query_border_right by exact Border.
  rewrite E0, E1, E2, E3. symmetry. now apply query_border_units.
Qed.
Theorem reference_face (v f0 f1 f2 : given) : reference_face_meets (promises finder) v f0 f1 f2 ->
  reference_decides_face v f0 f1 f2 = true <->
  vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof. exact (query_reference false v f0 f1 f2). Qed.
Theorem reference_edges (a0 a1 b0 b1 : given) : reference_edges_meets (promises finder) a0 a1 b0 b1 ->
  reference_decides_edges a0 a1 b0 b1 = true <->
  edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof. exact (query_reference true a0 a1 b0 b1). Qed.

Definition reference_decides_vertex_edge (v e0 e1 : given) : bool :=
  edge_contact finder [v; e0; e1] v e0 e1.
Theorem reference_vertex_edge (v e0 e1 : given) :
  edge_contact_meets finder (promises finder) [v; e0; e1] v e0 e1 -> reference_decides_vertex_edge v e0 e1 = true <->
  vertex_edge_collides (given_motion v) (given_motion e0) (given_motion e1).
Proof.
  intros M. unfold reference_decides_vertex_edge. rewrite edge_contact_right by (exact M || (simpl; auto)). easy.
Qed.

End Reference.

Definition reference_decides_vertices (v w : given) : bool :=
  let i := to_integers [v; w] in vertices_contact (i v) (i w).
Theorem reference_vertex_vertex v w : reference_decides_vertices v w = true <->
  vertex_vertex_collides (given_motion v) (given_motion w).
Proof.
  unfold reference_decides_vertices. set (q := [v; w]). assert (In v q /\ In w q) as (I & J) by (simpl; tauto).
  destruct (to_integers_right q v I) as (K & V). destruct (to_integers_right q w J) as (_ & W).
  now apply (vertices_contact_right (unit_of q)).
Qed.
