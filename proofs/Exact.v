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
Definition face_fits (v f0 f1 f2 : given) : Prop :=
  let i := to_integers [v; f0; f1; f2] in
  CloseContact.below 253 (difference (i f1) (i f0)) /\ CloseContact.below 253 (difference (i f2) (i f0)) /\
  CloseContact.below 253 (difference (i v) (i f0)).
Definition edges_fit (a0 a1 b0 b1 : given) : Prop :=
  let i := to_integers [a0; a1; b0; b1] in
  CloseContact.below 253 (difference (i a1) (i a0)) /\ CloseContact.below 253 (difference (i b1) (i b0)) /\
  CloseContact.below 253 (difference (i b0) (i a0)).

Definition face_stages (fits : bool) (v f0 f1 f2 : given) : list answer :=
  [FilterStages.filter_face direction (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2);
   in_integers_decided false fits v f0 f1 f2].
Definition edges_stages (fits : bool) (a0 a1 b0 b1 : given) : list answer :=
  [FilterStages.filter_edges direction (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1);
   in_integers_decided true fits a0 a1 b0 b1].

Definition exact_face (fits : bool) (v f0 f1 f2 : given) : bool :=
  first_certain (face_stages fits v f0 f1 f2) (reference_decides_face finder v f0 f1 f2).
Definition exact_edges (fits : bool) (a0 a1 b0 b1 : given) : bool :=
  first_certain (edges_stages fits a0 a1 b0 b1) (reference_decides_edges finder a0 a1 b0 b1).

Lemma integers_face_sound fits v f0 f1 f2 : (fits = true -> face_fits v f0 f1 f2) ->
  sound (vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2))
    (in_integers_decided false fits v f0 f1 f2).
Proof.
  intros F. unfold in_integers_decided. destruct fits; [| exact I]. destruct (F eq_refl) as (B & C & P). clear F.
  set (q := [v; f0; f1; f2]) in *. assert (In v q /\ In f0 q /\ In f1 q /\ In f2 q) as (Iv & I0 & I1 & I2) by (simpl; tauto).
  destruct (to_integers_right q v Iv) as (K & E). destruct (to_integers_right q f0 I0) as (_ & E0).
  destruct (to_integers_right q f1 I1) as (_ & E1). destruct (to_integers_right q f2 I2) as (_ & E2).
  destruct (CloseContact.face_to_the_end_right (unit_of q) K extent_x extent_y extent_z estimate refine steps more
    estimated_root root_exponent estimated_pair _ _ _ _ _ _ _ _ E E0 E1 E2 B C P) as (Yes & No).
  cbv zeta. destruct (CloseContact.decide_to_the_end _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _); [now apply No | now apply Yes | exact I].
Qed.
Lemma integers_edges_sound fits a0 a1 b0 b1 : (fits = true -> edges_fit a0 a1 b0 b1) ->
  sound (edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1))
    (in_integers_decided true fits a0 a1 b0 b1).
Proof.
  intros F. unfold in_integers_decided. destruct fits; [| exact I]. destruct (F eq_refl) as (B & C & P). clear F.
  set (q := [a0; a1; b0; b1]) in *. assert (In a0 q /\ In a1 q /\ In b0 q /\ In b1 q) as (I0 & I1 & I2 & I3) by (simpl; tauto).
  destruct (to_integers_right q a0 I0) as (K & E0). destruct (to_integers_right q a1 I1) as (_ & E1).
  destruct (to_integers_right q b0 I2) as (_ & E2). destruct (to_integers_right q b1 I3) as (_ & E3).
  destruct (CloseContact.edges_to_the_end_right (unit_of q) K extent_x extent_y extent_z estimate refine steps more
    estimated_root root_exponent estimated_pair _ _ _ _ _ _ _ _ E0 E1 E2 E3 B C P) as (Yes & No).
  cbv zeta. destruct (CloseContact.decide_to_the_end _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _); [now apply No | now apply Yes | exact I].
Qed.

Lemma face_stages_sound fits v f0 f1 f2 : numbers v -> numbers f0 -> numbers f1 -> numbers f2 ->
  (fits = true -> face_fits v f0 f1 f2) ->
  Forall (sound (vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2)))
    (face_stages fits v f0 f1 f2).
Proof.
  intros V F0 F1 F2 F. constructor; [| constructor; [now apply integers_face_sound | constructor]].
  destruct (FilterStages.filter_face _ _ _ _ _) eqn:E; [| | exact I].
  - now apply (FilterStages.filter_face_separate direction _ _ _ _ V F0 F1 F2).
  - now apply (FilterStages.filter_face_collides direction _ _ _ _ V F0 F1 F2).
Qed.
Lemma edges_stages_sound fits a0 a1 b0 b1 : numbers a0 -> numbers a1 -> numbers b0 -> numbers b1 ->
  (fits = true -> edges_fit a0 a1 b0 b1) ->
  Forall (sound (edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1)))
    (edges_stages fits a0 a1 b0 b1).
Proof.
  intros A0 A1 B0 B1 F. constructor; [| constructor; [now apply integers_edges_sound | constructor]].
  destruct (FilterStages.filter_edges _ _ _ _ _) eqn:E; [| | exact I].
  - now apply (FilterStages.filter_edges_separate direction _ _ _ _ A0 A1 B0 B1).
  - now apply (FilterStages.filter_edges_collide direction _ _ _ _ A0 A1 B0 B1).
Qed.

Theorem batch_face_right culls fits v f0 f1 f2 : numbers v -> numbers f0 -> numbers f1 -> numbers f2 ->
  (fits = true -> face_fits v f0 f1 f2) ->
  Forall (sound (vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2))) culls ->
  (all_undecided (culls ++ face_stages fits v f0 f1 f2) -> reference_face_meets finder returned v f0 f1 f2) ->
  first_certain (culls ++ face_stages fits v f0 f1 f2) (reference_decides_face finder v f0 f1 f2) = true <->
  vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof.
  intros V F0 F1 F2 F C M. apply in_any_order.
  - apply Forall_app. split; [exact C | now apply face_stages_sound].
  - intros U. now apply reference_face_by_isolation, M.
Qed.
Theorem batch_edges_right culls fits a0 a1 b0 b1 : numbers a0 -> numbers a1 -> numbers b0 -> numbers b1 ->
  (fits = true -> edges_fit a0 a1 b0 b1) ->
  Forall (sound (edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1))) culls ->
  (all_undecided (culls ++ edges_stages fits a0 a1 b0 b1) -> reference_edges_meets finder returned a0 a1 b0 b1) ->
  first_certain (culls ++ edges_stages fits a0 a1 b0 b1) (reference_decides_edges finder a0 a1 b0 b1) = true <->
  edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof.
  intros A0 A1 B0 B1 F C M. apply in_any_order.
  - apply Forall_app. split; [exact C | now apply edges_stages_sound].
  - intros U. now apply reference_edges_by_isolation, M.
Qed.

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
