(** `exact` as one: ccd/exact/exact.cpp, ccd/exact/stages.cpp, ccd/exact/integers.cpp. Whatever stage answers a query
    of finite coordinates, the answer is right.

    Results:
        in_any_order        tests whose certain answers are right, asked in any order until one is certain
        exact_face_right, exact_edges_right
                            the filter in doubles, integers where their widths suffice, the reference: `collides`
                            exactly if the features collide. Of what the reference's algorithms return, only what
                            this query asks is supposed, and only if it comes to that
        batch_face_right, batch_edges_right
                            likewise with the culls of batches and steps before, in any order *)

From Coq Require Import Reals ZArith List Bool.
From Flocq Require Import Core.
From Errbound Require Import Format Contact AxisUnits UnboundedIntegers Reference RootFinder.
From Errbound Require Subdivision SeparatingAxis FilterStages Decisions InteriorContact CloseContact.
Import ListNotations.

(** ** Tests in any order *)

Notation answer := Subdivision.outcome.

(** What is certain is right: of whether K. *)
Definition sound (K : Prop) (a : answer) : Prop :=
  match a with Subdivision.separate => ~ K | Subdivision.collides => K | Subdivision.undecided => True end.

(** The first certain answer, or the last question's. *)
Fixpoint first_certain (tests : list answer) (last : bool) : bool :=
  match tests with
  | [] => last
  | Subdivision.separate :: _ => false
  | Subdivision.collides :: _ => true
  | Subdivision.undecided :: rest => first_certain rest last
  end.
Definition all_undecided (tests : list answer) : Prop := Forall (eq Subdivision.undecided) tests.

Theorem in_any_order K tests last : Forall (sound K) tests -> (all_undecided tests -> last = true <-> K) ->
  first_certain tests last = true <-> K.
Proof.
  intros F. induction F as [| a tests S F IH]; intros L; cbn [first_certain].
  - apply L. constructor.
  - destruct a; cbn [sound] in S; [split; [discriminate | easy] | split; [easy | reflexivity] |].
    apply IH. intros U. apply L. now constructor.
Qed.

(** ** One query *)

Section Exact.

(** The rounding of the filter, which is to nearest: any is right. *)
Variable direction : R -> Z.
Context {direction_valid : Valid_rnd direction}.

(** Estimates in integers: whatever they are. *)
Variables extent_x extent_y extent_z : Z.
Variable estimate : CubicRoots.part -> Z.
Variable refine : Z -> CubicRoots.part -> Z -> Z -> Z -> Z.
Variables steps more : nat.
Variable estimated_root : list Z -> Z -> Z.
Variable root_exponent : list Z -> Z.
Variable estimated_pair : list Z -> option ((Z -> Z) * Z).

(** What the reference's algorithms return. *)
Variable common : list Z -> list Z -> list Z.
Variable squarefree : list Z -> list Z.
Variable intervals : list Z -> list RootIsolation.interval.
Variable sign_there : list Z -> list Z -> RootIsolation.interval -> Sign.sign.
Notation finder := (isolation common squarefree intervals sign_there).
Notation returned := (returned common squarefree intervals sign_there).

Notation numbers q := (SeparatingAxis.numbers (given_motion q)).
Notation difference := (@Decisions.difference integers).

(** decide_in_integers: `fits` where differences are below 2^253, as the extents tell. *)
Definition in_integers_decided (edges fits : bool) (q0 q1 q2 q3 : given) : answer :=
  let i := to_integers [q0; q1; q2; q3] in
  if fits then CloseContact.decide_to_the_end edges extent_x extent_y extent_z estimate refine steps estimated_root
    root_exponent estimated_pair more (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3)
    (i q0) (i q1) (i q2) (i q3)
  else Subdivision.undecided.
Definition query_fits (edges : bool) (q0 q1 q2 q3 : given) : Prop :=
  let i := to_integers [q0; q1; q2; q3] in
  CloseContact.below 253 (side_b edges difference (i q0) (i q1) (i q2) (i q3)) /\
  CloseContact.below 253 (side_c edges difference (i q0) (i q1) (i q2) (i q3)) /\
  CloseContact.below 253 (side_p edges difference (i q0) (i q1) (i q2) (i q3)).
Definition face_fits : given -> given -> given -> given -> Prop := query_fits false.
Definition edges_fit : given -> given -> given -> given -> Prop := query_fits true.

Definition query_stages (edges fits : bool) (q0 q1 q2 q3 : given) : list answer :=
  [(if edges then FilterStages.filter_edges else FilterStages.filter_face) direction
     (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3);
   in_integers_decided edges fits q0 q1 q2 q3].
Definition face_stages : bool -> given -> given -> given -> given -> list answer := query_stages false.
Definition edges_stages : bool -> given -> given -> given -> given -> list answer := query_stages true.

Definition exact_face (fits : bool) (v f0 f1 f2 : given) : bool :=
  first_certain (face_stages fits v f0 f1 f2) (reference_decides_face finder v f0 f1 f2).
Definition exact_edges (fits : bool) (a0 a1 b0 b1 : given) : bool :=
  first_certain (edges_stages fits a0 a1 b0 b1) (reference_decides_edges finder a0 a1 b0 b1).

Lemma query_stages_sound edges fits q0 q1 q2 q3 : numbers q0 -> numbers q1 -> numbers q2 -> numbers q3 ->
  (fits = true -> query_fits edges q0 q1 q2 q3) ->
  Forall (sound (query_collides edges (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3)))
    (query_stages edges fits q0 q1 q2 q3).
Proof.
  intros N0 N1 N2 N3 F. constructor; [| constructor; [| constructor]].
  - destruct edges.
    + destruct (FilterStages.filter_edges _ _ _ _ _) eqn:E; [| | exact I].
      * now apply (FilterStages.filter_edges_separate direction _ _ _ _ N0 N1 N2 N3).
      * now apply (FilterStages.filter_edges_collide direction _ _ _ _ N0 N1 N2 N3).
    + destruct (FilterStages.filter_face _ _ _ _ _) eqn:E; [| | exact I].
      * now apply (FilterStages.filter_face_separate direction _ _ _ _ N0 N1 N2 N3).
      * now apply (FilterStages.filter_face_collides direction _ _ _ _ N0 N1 N2 N3).
  - unfold in_integers_decided. destruct fits; [| exact I]. destruct (F eq_refl) as (B & C & P).
    destruct (query_in_integers q0 q1 q2 q3) as (K & I0 & I1 & I2 & I3).
    destruct (CloseContact.query_to_the_end_right (unit_of [q0; q1; q2;
      q3]) K extent_x extent_y extent_z estimate refine
      steps more estimated_root root_exponent estimated_pair edges _ _ _ _ _ _ _ _ I0 I1 I2 I3 B C P) as (Yes & No).
    cbv zeta. destruct (CloseContact.decide_to_the_end _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _);
      [now apply No | now apply Yes | exact I].
Qed.

Lemma query_batch_right edges culls fits q0 q1 q2 q3 : numbers q0 -> numbers q1 -> numbers q2 -> numbers q3 ->
  (fits = true -> query_fits edges q0 q1 q2 q3) ->
  Forall (sound (query_collides edges (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3))) culls ->
  (all_undecided (culls ++ query_stages edges fits q0 q1 q2 q3) -> reference_meets finder edges returned q0 q1 q2 q3) ->
  first_certain (culls ++ query_stages edges fits q0 q1 q2 q3) (reference_decides finder edges q0 q1 q2 q3) = true <->
  query_collides edges (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3).
Proof.
  intros N0 N1 N2 N3 F C M. apply in_any_order.
  - apply Forall_app. split; [exact C | now apply query_stages_sound].
  - intros U. now apply query_reference_by_isolation, M.
Qed.
Theorem batch_face_right culls fits v f0 f1 f2 : numbers v -> numbers f0 -> numbers f1 -> numbers f2 ->
  (fits = true -> face_fits v f0 f1 f2) ->
  Forall (sound (vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2))) culls ->
  (all_undecided (culls ++ face_stages fits v f0 f1 f2) -> reference_face_meets finder returned v f0 f1 f2) ->
  first_certain (culls ++ face_stages fits v f0 f1 f2) (reference_decides_face finder v f0 f1 f2) = true <->
  vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof. exact (query_batch_right false culls fits v f0 f1 f2). Qed.
Theorem batch_edges_right culls fits a0 a1 b0 b1 : numbers a0 -> numbers a1 -> numbers b0 -> numbers b1 ->
  (fits = true -> edges_fit a0 a1 b0 b1) ->
  Forall (sound (edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1))) culls ->
  (all_undecided (culls ++ edges_stages fits a0 a1 b0 b1) -> reference_edges_meets finder returned a0 a1 b0 b1) ->
  first_certain (culls ++ edges_stages fits a0 a1 b0 b1) (reference_decides_edges finder a0 a1 b0 b1) = true <->
  edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof. exact (query_batch_right true culls fits a0 a1 b0 b1). Qed.

Theorem exact_face_right fits v f0 f1 f2 : numbers v -> numbers f0 -> numbers f1 -> numbers f2 ->
  (fits = true -> face_fits v f0 f1 f2) ->
  (all_undecided (face_stages fits v f0 f1 f2) -> reference_face_meets finder returned v f0 f1 f2) ->
  exact_face fits v f0 f1 f2 = true <->
  vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof. intros V F0 F1 F2 F M. apply (batch_face_right [] fits v f0 f1 f2 V F0 F1 F2 F (Forall_nil _) M). Qed.
Theorem exact_edges_right fits a0 a1 b0 b1 : numbers a0 -> numbers a1 -> numbers b0 -> numbers b1 ->
  (fits = true -> edges_fit a0 a1 b0 b1) ->
  (all_undecided (edges_stages fits a0 a1 b0 b1) -> reference_edges_meets finder returned a0 a1 b0 b1) ->
  exact_edges fits a0 a1 b0 b1 = true <->
  edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof. intros A0 A1 B0 B1 F M. apply (batch_edges_right [] fits a0 a1 b0 b1 A0 A1 B0 B1 F (Forall_nil _) M). Qed.

End Exact.
