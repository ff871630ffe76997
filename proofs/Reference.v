(** The reference (ccd/exact/reference.cpp): every decision is right, given doubles, common_factor and
  real_roots
    as in UnboundedIntegers.v. Results:
        reference_face, reference_edges, reference_vertex_edge, reference_vertex_vertex   it decides
                                  `collides` exactly if the features do *)

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

(** What it asks of the finder. *)
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
    { intros g I. destruct (T g (or_intror I)) as (C & R). destruct (sign_there g); simpl in *; split; easy ||
      lra. }
    split; intros H g I; now apply E, H. }
  destruct (T n2 (or_introl eq_refl)) as (C & R). destruct (sign_there n2); simpl in *; try easy; rewrite A; split; try
    tauto; intuition lra.
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
    rewrite Forall_forall in G. specialize (G g I). pose proof (@sign_throughout_right integers g t T)
      as R.
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
  { split; auto. intros _. apply andb_prop in E0. exists 0. split; [lra |]. split; [now apply Z0 | now
    apply At0]. }
  destruct (Z.eqb (last y 0%Z) 0 && contact_at at_end n2 gs) eqn:E1.
  { split; auto. intros _. apply andb_prop in E1. exists 1. split; [lra |]. split; [now apply Z1 | now
    apply At1]. }
  assert (Inside : forall t, 0 <= t <= 1 -> regular_at y gs n2 t -> 0 < t < 1).
  { intros t T (Z & G). destruct (Req_dec t 0) as [-> |]; [apply Z0 in Z; apply At0 in G; now rewrite Z,
    G in E0 |].
    destruct (Req_dec t 1) as [-> |]; [apply Z1 in Z; apply At1 in G; now rewrite Z, G in E1 |]. lra. }
  clear At0 At1 Z0 Z1 E0 E1 Y0 Y1 O C.
  assert (Ny : y <> []) by now destruct y.
  pose proof (fun t => inner_signs y t Ny) as Root. pose proof (without_end_roots_trimmed y) as Tr.
  pose proof (without_end_roots_start y) as Start. pose proof (without_end_roots_empty y) as Empty.
  destruct (without_end_roots y) as [| a [| c l]].
  - split; [easy |]. intros t T R. right. split; auto. intros u. specialize (Empty eq_refl). unfold
    at_time.
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

Definition reference_decides_face (v f0 f1 f2 : given) : bool :=
  let i := to_integers [v; f0; f1; f2] in
  let b := difference (i f1) (i f0) in
  let c := difference (i f2) (i f0) in
  let p := difference (i v) (i f0) in
  regular_contact (y_form b c p) (inside_face_forms b c p) (normal_squared b c) || face_border finder v
    f0 f1 f2.
Definition reference_decides_edges (a0 a1 b0 b1 : given) : bool :=
  let i := to_integers [a0; a1; b0; b1] in
  let b := difference (i a1) (i a0) in
  let c := difference (i b1) (i b0) in
  let p := difference (i b0) (i a0) in
  regular_contact (y_form b c p) (inside_edges_forms b c p) (normal_squared b c) || edges_border finder
    a0 a1 b0 b1.

(** What they ask of the finder. *)
Definition reference_face_meets (d : demands) (v f0 f1 f2 : given) : Prop :=
  let i := to_integers [v; f0; f1; f2] in
  let b := difference (i f1) (i f0) in
  let c := difference (i f2) (i f0) in
  let p := difference (i v) (i f0) in
  regular_meets d (y_form b c p) (inside_face_forms b c p) (normal_squared b c) /\
  face_border_meets finder d v f0 f1 f2.
Definition reference_edges_meets (d : demands) (a0 a1 b0 b1 : given) : Prop :=
  let i := to_integers [a0; a1; b0; b1] in
  let b := difference (i a1) (i a0) in
  let c := difference (i b1) (i b0) in
  let p := difference (i b0) (i a0) in
  regular_meets d (y_form b c p) (inside_edges_forms b c p) (normal_squared b c) /\
  edges_border_meets finder d a0 a1 b0 b1.

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

Lemma decides_face (v f0 f1 f2 : @moving_point integers) border :
  let v' := exact_motion v in let f0' := exact_motion f0 in let f1' := exact_motion f1 in let f2' :=
    exact_motion f2 in
  border = true <-> face_border_collides v' f0' f1' f2' ->
  let b := difference f1 f0 in let c := difference f2 f0 in let p := difference v f0 in
  regular_meets (promises finder) (y_form b c p) (inside_face_forms b c p) (normal_squared b c) ->
  regular_contact (y_form b c p) (inside_face_forms b c p) (normal_squared b c) || border = true <->
  vertex_face_collides v' f0' f1' f2'.
Proof.
  intros v' f0' f1' f2' Border b c p Asked. destruct (degrees_face v f0 f1 f2) as (Db & Dc & Dp). fold b c p
    in Db, Dc, Dp.
  destruct (forms_y b c p 0 Db Dc Dp) as (_ & L). destruct (forms_weights b c p 0 Db Dc Dp) as (_ & _ &
    F & _).
  destruct (normal_form b c 0 Db Dc) as (_ & N).
  destruct (regular_contact_right _ _ _ Asked L F N) as (To & From).
  assert (R : forall t, regular_at (y_form b c p) (inside_face_forms b c p) (normal_squared b c) t <->
    face_regular_at v' f0' f1' f2' t).
  { intros t. unfold regular_at, face_regular_at, regular_face, v', f0', f1', f2'. rewrite <-
    !difference_at. fold b c p.
    rewrite (proj1 (normal_form b c t Db Dc)), normal_vanishes, (proj1 (forms_y b c p t Db Dc Dp)).
    rewrite <- (Forall_map (fun g => form_at g t) (Rle 0)), (proj1 (forms_weights b c p t Db Dc Dp)),
      !Forall_cons_iff.
    intuition. }
  rewrite orb_true_iff, Border, vertex_face_union. split.
  - intros [H | H]; [left | now right]. destruct (To H) as (t & T & H'). exists t. split; auto. now
    apply R.
  - intros [(t & T & H) | H]; [| now right]. apply R in H. destruct (From t T H) as [| (_ & Z)]; [now
    left |].
    assert (Y : forall u, 0 <= u <= 1 -> det (minus (place f1' u) (place f0' u)) (minus (place f2' u)
      (place f0' u))
      (minus (place v' u) (place f0' u)) = 0).
    { intros u _. unfold v', f0', f1', f2'. rewrite <- !difference_at. fold b c p. now rewrite <- (proj1
      (forms_y b c p u Db Dc Dp)). }
    assert (C : vertex_face_collides v' f0' f1' f2') by (apply vertex_face_union; left; exists t; split;
      auto; now apply R).
    apply (face_coplanar v' f0' f1' f2' Y) in C. destruct C as [I | B]; [left | now right].
    destruct (From 0 ltac:(lra)) as [| (X & _)]; auto; [| lra].
    apply R, inside_face_regular; auto. apply Y. lra.
Qed.
Lemma decides_edges (a0 a1 b0 b1 : @moving_point integers) border :
  let a0' := exact_motion a0 in let a1' := exact_motion a1 in let b0' := exact_motion b0 in let b1' :=
    exact_motion b1 in
  border = true <-> edges_border_collides a0' a1' b0' b1' ->
  let b := difference a1 a0 in let c := difference b1 b0 in let p := difference b0 a0 in
  regular_meets (promises finder) (y_form b c p) (inside_edges_forms b c p) (normal_squared b c) ->
  regular_contact (y_form b c p) (inside_edges_forms b c p) (normal_squared b c) || border = true <->
  edge_edge_collides a0' a1' b0' b1'.
Proof.
  intros a0' a1' b0' b1' Border b c p Asked. destruct (degrees_edges a0 a1 b0 b1) as (Db & Dc & Dp). fold b c
    p in Db, Dc, Dp.
  destruct (forms_y b c p 0 Db Dc Dp) as (_ & L). destruct (forms_weights b c p 0 Db Dc Dp) as (_ & _ &
    _ & F).
  destruct (normal_form b c 0 Db Dc) as (_ & N).
  destruct (regular_contact_right _ _ _ Asked L F N) as (To & From).
  assert (R : forall t, regular_at (y_form b c p) (inside_edges_forms b c p) (normal_squared b c) t <->
    edges_regular_at a0' a1' b0' b1' t).
  { intros t. unfold regular_at, edges_regular_at, regular_edges, a0', a1', b0', b1'. rewrite <-
    !difference_at. fold b c p.
    rewrite (proj1 (normal_form b c t Db Dc)), normal_vanishes, (proj1 (forms_y b c p t Db Dc Dp)).
    rewrite <- (Forall_map (fun g => form_at g t) (Rle 0)), (proj1 (proj2 (forms_weights b c p t Db Dc
      Dp))), !Forall_cons_iff.
    intuition. }
  rewrite orb_true_iff, Border, edge_edge_union. split.
  - intros [H | H]; [left | now right]. destruct (To H) as (t & T & H'). exists t. split; auto. now
    apply R.
  - intros [(t & T & H) | H]; [| now right]. apply R in H. destruct (From t T H) as [| (_ & Z)]; [now
    left |].
    assert (Y : forall u, 0 <= u <= 1 -> det (minus (place a1' u) (place a0' u)) (minus (place b1' u)
      (place b0' u))
      (minus (place b0' u) (place a0' u)) = 0).
    { intros u _. unfold a0', a1', b0', b1'. rewrite <- !difference_at. fold b c p. now rewrite <-
      (proj1 (forms_y b c p u Db Dc Dp)). }
    assert (C : edge_edge_collides a0' a1' b0' b1') by (apply edge_edge_union; left; exists t; split;
      auto; now apply R).
    apply (edges_coplanar a0' a1' b0' b1' Y) in C. destruct C as [I | B]; [left | now right].
    destruct (From 0 ltac:(lra)) as [| (X & _)]; auto; [| lra].
    apply R, inside_edges_regular; auto. apply Y. lra.
Qed.

Theorem reference_face (v f0 f1 f2 : given) : reference_face_meets (promises finder) v f0 f1 f2 ->
  reference_decides_face v f0 f1 f2 = true <->
  vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof.
  intros (Regular & Border). unfold reference_decides_face. set (q := [v; f0; f1; f2]).
  assert (In v q /\ In f0 q /\ In f1 q /\ In f2 q) as (I & I0 & I1 & I2) by (simpl; tauto).
  destruct (to_integers_right q v I) as (K & E). destruct (to_integers_right q f0 I0) as (_ & E0).
  destruct (to_integers_right q f1 I1) as (_ & E1). destruct (to_integers_right q f2 I2) as (_ & E2).
  unfold in_integers in *. rewrite <- (face_units (unit_of q)) by exact K. rewrite <- E, <- E0, <- E1,
    <- E2.
  apply decides_face; [| exact Regular]. rewrite face_border_right by exact Border. unfold face_border_collides.
  now rewrite E, E0, E1, E2, !(vertex_edge_units (unit_of q)).
Qed.
Theorem reference_edges (a0 a1 b0 b1 : given) : reference_edges_meets (promises finder) a0 a1 b0 b1 ->
  reference_decides_edges a0 a1 b0 b1 = true <->
  edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof.
  intros (Regular & Border). unfold reference_decides_edges. set (q := [a0; a1; b0; b1]).
  assert (In a0 q /\ In a1 q /\ In b0 q /\ In b1 q) as (I0 & I1 & I2 & I3) by (simpl; tauto).
  destruct (to_integers_right q a0 I0) as (K & E0). destruct (to_integers_right q a1 I1) as (_ & E1).
  destruct (to_integers_right q b0 I2) as (_ & E2). destruct (to_integers_right q b1 I3) as (_ & E3).
  unfold in_integers in *. rewrite <- (edges_units (unit_of q)) by exact K. rewrite <- E0, <- E1, <- E2,
    <- E3.
  apply decides_edges; [| exact Regular]. rewrite edges_border_right by exact Border. unfold edges_border_collides.
  now rewrite E0, E1, E2, E3, !(vertex_edge_units (unit_of q)).
Qed.

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
