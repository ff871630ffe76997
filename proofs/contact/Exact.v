(** `exact` as a whole: ccd/exact/exact.cpp, ccd/exact/stages.cpp, ccd/exact/integers.cpp. Whatever stage answers a
    query of finite coordinates, the answer is right. Results:
        in_any_order        tests whose certain answers are right may run in any order until one is certain
        differences_fit     differences of whole coordinates are within the bits that extents give
        exact_face_right, exact_edges_right   the filter in doubles, integers if their widths suffice, the reference:
                            `collides` exactly if the features collide. Hypotheses about the reference's algorithms
                            concern only the calls of this query, and only if it reaches the reference
        batch_face_right, batch_edges_right   the same with the earlier tests of batches and steps, in any order *)

From Coq Require Import Reals ZArith List Bool Lia.
From Flocq Require Import Core.
From Errbound Require Import Format Contact AxisUnits UnboundedIntegers Reference RootFinder.
From Errbound Require IntegerUnits Subdivision SeparatingAxis FilterStages Decisions InteriorContact CloseContact.
Import ListNotations.

(** ** Tests in any order *)

Notation answer := Subdivision.outcome.

(** A certain answer to "does K hold" is right. *)
Definition sound (K : Prop) (a : answer) : Prop :=
  match a with Subdivision.separate => ~ K | Subdivision.collides => K | Subdivision.undecided => True end.

(** The first certain answer, or the last test's. *)
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

(** ** Extents *)

(** axis_extent and integer_units::bits on one axis: `E` has 2^E above every difference at either end, as computed in
    doubles. Then whole numbers are below 2^(E - unit). An infinite difference has the exponent 1025 here and in the
    code. *)
Definition least (l : list R) : R := fold_left Rmin l (hd 0%R l).
Definition most (l : list R) : R := fold_left Rmax l (hd 0%R l).
Definition spread (l : list R) : R := rnd 53 (-1074) nearest (most l - least l).
(** binary_double::end_bit; for a double other than 0 it is at least -1073 *)
Definition end_bit (x : R) : Z := if Req_bool x 0 then -1074 else Z.max (-1074) (mag radix2 x).
Definition along (axis : doubles -> dyadic) (e : given -> doubles) (query : list given) : list R :=
  map (fun m => double (axis (e m))) query.
Definition axis_bits (axis : doubles -> dyadic) (query : list given) : Z :=
  Z.max 0 (end_bit (Rmax (spread (along axis at0 query)) (spread (along axis at1 query))) - lowest axis query).
Definition query_bits (query : list given) : Z :=
  Z.max (Z.max (axis_bits dx query) (axis_bits dy query)) (axis_bits dz query).

Notation double_number := (Format.number 53 (-1074)).

(** Rmin and Rmax, and the order in which their result comes first. *)
Lemma extreme_in (f : R -> R -> R) (first : R -> R -> Prop) :
  (forall x, first x x) -> (forall x y z, first x y -> first y z -> first x z) ->
  (forall x y, (f x y = x \/ f x y = y) /\ first (f x y) x /\ first (f x y) y) ->
  forall l x, In (fold_left f l x) (x :: l) /\ forall y, In y (x :: l) -> first (fold_left f l x) y.
Proof.
  intros Same Then Of l. induction l as [| z l IH]; intros x; cbn [fold_left].
  - split; [now left |]. now intros y [<- | []].
  - destruct (IH (f x z)) as [I L]. pose proof (L _ (or_introl eq_refl)) as M. destruct (Of x z) as (O & X & Z). split.
    + destruct I as [<- | I]; [| now right; right]. destruct O as [-> | ->]; [now left | now right; left].
    + intros y [<- | [<- | Y]]; [eauto | eauto | now apply L; right].
Qed.
Lemma ends l : l <> [] -> In (least l) l /\ In (most l) l /\ forall y, In y l -> (least l <= y <= most l)%R.
Proof.
  destruct l as [| x l]; [easy | intros _]. unfold least, most. cbn [hd].
  destruct (extreme_in Rmin Rle) with (l := x :: l) (x := x) as [I L];
    [apply Rle_refl | apply Rle_trans | intros y z; repeat split; [| apply Rmin_l | apply Rmin_r] |].
  { unfold Rmin. destruct (Rle_dec y z); tauto. }
  destruct (extreme_in Rmax Rge) with (l := x :: l) (x := x) as [J M];
    [apply Rge_refl | apply Rge_trans | intros y z; repeat split; [| apply Rle_ge, Rmax_l | apply Rle_ge, Rmax_r] |].
  { unfold Rmax. destruct (Rle_dec y z); tauto. }
  split; [destruct I as [<- | I]; [now left | exact I] |]. split; [destruct J as [<- | J]; [now left | exact J] |].
  intros y Y. split; [apply L | apply Rge_le, M]; now right.
Qed.

Theorem differences_fit axis e query m m' : e = at0 \/ e = at1 ->
  (forall n, In n query -> double_number (double (axis (e n)))) -> In m query -> In m' query ->
  (Z.abs (to_integer (axis (e m)) (lowest axis query) - to_integer (axis (e m')) (lowest axis query)) <=
   2 ^ axis_bits axis query)%Z.
Proof.
  intros E N I I'. set (unit := lowest axis query). set (l := along axis e query).
  assert (Il : forall n, In n query -> In (double (axis (e n))) l) by (intros n In; now apply in_map with (f := fun m => double (axis (e m)))).
  destruct (ends l) as (L & M & B). { intros A. specialize (Il _ I). rewrite A in Il. exact Il. }
  assert (Nl : forall x, In x l -> double_number x) by (intros x X; apply in_map_iff in X; destruct X as (n & <- & X); now apply N).
  set (largest := Rmax (spread (along axis at0 query)) (spread (along axis at1 query))).
  assert (S : (spread l <= largest)%R) by (unfold l, largest; destruct E as [-> | ->]; auto using Rmax_l, Rmax_r).
  assert (Below : (spread l < bpow radix2 (end_bit largest))%R).
  { unfold end_bit. destruct (Req_bool_spec largest 0) as [Z0 | Z0].
    - rewrite Z0 in S. eapply Rle_lt_trans; [exact S | apply bpow_gt_0].
    - eapply Rle_lt_trans; [exact S |]. eapply Rle_lt_trans; [apply Rle_abs |]. eapply Rlt_le_trans; [apply bpow_mag_gt |].
      apply bpow_le. lia. }
  assert (P : (-1074 <= end_bit largest)%Z) by (unfold end_bit; destruct (Req_bool largest 0); lia).
  pose proof (IntegerUnits.extent_bits_enough (least l) (most l) _ _ _ unit (Nl _ L) (Nl _ M) (B _ (Il _ I)) (B _ (Il _ I')) P
    (or_introl Below)) as D.
  fold largest in D. change (Z.max 0 (end_bit largest - unit)) with (axis_bits axis query) in D.
  assert (W : forall n, In n query -> IZR (to_integer (axis (e n)) unit) = (powerRZ 2 (- unit) * double (axis (e n)))%R).
  { intros n In. apply to_integer_right. destruct (lowest_right axis query n In). now destruct E as [-> | ->]. }
  apply le_IZR. rewrite abs_IZR, minus_IZR, !W by assumption. rewrite <- Rmult_minus_distr_l, Rabs_mult.
  assert (U : powerRZ 2 (- unit) = bpow radix2 (- unit)) by (now rewrite bpow_powerRZ).
  rewrite U, (Rabs_pos_eq (bpow radix2 (- unit))) by apply bpow_ge_0.
  change 2%Z with (radix_val radix2). rewrite IZR_Zpower by (unfold axis_bits; lia).
  apply Rmult_le_reg_l with (bpow radix2 unit); [apply bpow_gt_0 |].
  rewrite <- Rmult_assoc, <- !bpow_plus, Z.add_opp_diag_r, Rmult_1_l. now apply Rlt_le.
Qed.

(** ** One query *)

Section Exact.

(** The rounding direction of the filter, which is to nearest; any is right. *)
Context (direction : R -> Z) {direction_valid : Valid_rnd direction}.

(** Arbitrary estimates in integers. *)
Context (extent_x extent_y extent_z : Z) (estimate : CubicRoots.part -> Z)
  (refine : Z -> CubicRoots.part -> Z -> Z -> Z -> Z) (steps more : nat) (estimated_root : list Z -> Z -> Z)
  (root_exponent : list Z -> Z) (estimated_pair : list Z -> option ((Z -> Z) * Z)).

(** Results of the reference's algorithms. *)
Context (common : list Z -> list Z -> list Z) (squarefree : list Z -> list Z)
  (intervals : list Z -> list RootIsolation.interval)
  (sign_there : list Z -> list Z -> RootIsolation.interval -> Sign.sign).
Notation finder := (isolation common squarefree intervals sign_there).
Notation returned := (returned common squarefree intervals sign_there).

Notation numbers q := (SeparatingAxis.numbers (given_motion q)).
Notation difference := (@Decisions.difference integers).

(** decide_in_integers, if extents show that differences are below 2^253. *)
Definition in_integers_decided (edges : bool) (q0 q1 q2 q3 : given) : answer :=
  let i := to_integers [q0; q1; q2; q3] in
  if (query_bits [q0; q1; q2; q3] <=? 253)%Z then CloseContact.decide_to_the_end edges extent_x extent_y extent_z estimate refine steps estimated_root
    root_exponent estimated_pair more (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3)
    (i q0) (i q1) (i q2) (i q3)
  else Subdivision.undecided.
Lemma query_fits edges q0 q1 q2 q3 : numbers q0 -> numbers q1 -> numbers q2 -> numbers q3 ->
  (query_bits [q0; q1; q2; q3] <= 253)%Z -> let i := to_integers [q0; q1; q2; q3] in
  CloseContact.below 253 (side_b edges difference (i q0) (i q1) (i q2) (i q3)) /\
  CloseContact.below 253 (side_c edges difference (i q0) (i q1) (i q2) (i q3)) /\
  CloseContact.below 253 (side_p edges difference (i q0) (i q1) (i q2) (i q3)).
Proof.
  intros N0 N1 N2 N3 L i. set (query := [q0; q1; q2; q3]) in *.
  assert (N : forall m, In m query -> numbers m) by (intros m [<- | [<- | [<- | [<- | []]]]]; assumption).
  assert (D : forall m m', In m query -> In m' query -> CloseContact.below 253 (difference (i m) (i m'))).
  { intros m m' I I'.
    assert (A : forall axis e, e = at0 \/ e = at1 -> (forall n, In n query -> double_number (double (axis (e n)))) ->
      (axis_bits axis query <= 253)%Z -> (Z.abs (to_integer (axis (e m)) (lowest axis query) -
        to_integer (axis (e m')) (lowest axis query)) <= 2 ^ 253)%Z).
    { intros axis e E M B. etransitivity; [now apply differences_fit |]. apply Z.pow_le_mono_r; lia. }
    unfold query_bits in L.
    assert (Start : forall n, In n query -> double_number (double (dx (at0 n))) /\ double_number (double (dy (at0 n))) /\
      double_number (double (dz (at0 n)))) by (intros n In; exact (N n In false)).
    assert (Finish : forall n, In n query -> double_number (double (dx (at1 n))) /\ double_number (double (dy (at1 n))) /\
      double_number (double (dz (at1 n)))) by (intros n In; exact (N n In true)).
    unfold CloseContact.below, i, to_integers.
    cbn [Decisions.difference Decisions.vx Decisions.vy Decisions.vz Decisions.t0 Decisions.t1 Decisions.px Decisions.py
      Decisions.pz Bernstein.sub integers app].
    repeat constructor; apply A; auto; try lia; intros n In; now destruct (Start n In) as (? & ? & ?), (Finish n In) as (? & ? & ?). }
  unfold side_b, side_c, side_p. destruct edges; repeat split; apply D; cbn; tauto.
Qed.

Definition query_stages (edges : bool) (q0 q1 q2 q3 : given) : list answer :=
  [(if edges then FilterStages.filter_edges else FilterStages.filter_face) direction
     (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3);
   in_integers_decided edges q0 q1 q2 q3].
Definition face_stages : given -> given -> given -> given -> list answer := query_stages false.
Definition edges_stages : given -> given -> given -> given -> list answer := query_stages true.

Definition exact_face (v f0 f1 f2 : given) : bool :=
  first_certain (face_stages v f0 f1 f2) (reference_decides_face finder v f0 f1 f2).
Definition exact_edges (a0 a1 b0 b1 : given) : bool :=
  first_certain (edges_stages a0 a1 b0 b1) (reference_decides_edges finder a0 a1 b0 b1).

Lemma query_stages_sound edges q0 q1 q2 q3 : numbers q0 -> numbers q1 -> numbers q2 -> numbers q3 ->
  Forall (sound (query_collides edges (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3)))
    (query_stages edges q0 q1 q2 q3).
Proof.
  intros N0 N1 N2 N3. constructor; [| constructor; [| constructor]].
  - destruct edges.
    + destruct (FilterStages.filter_edges _ _ _ _ _) eqn:E; [| | exact I].
      * now apply (FilterStages.filter_edges_separate direction _ _ _ _ N0 N1 N2 N3).
      * now apply (FilterStages.filter_edges_collide direction _ _ _ _ N0 N1 N2 N3).
    + destruct (FilterStages.filter_face _ _ _ _ _) eqn:E; [| | exact I].
      * now apply (FilterStages.filter_face_separate direction _ _ _ _ N0 N1 N2 N3).
      * now apply (FilterStages.filter_face_collides direction _ _ _ _ N0 N1 N2 N3).
  - unfold in_integers_decided. destruct (Z.leb_spec (query_bits [q0; q1; q2; q3]) 253) as [L | _]; [| exact I].
    destruct (query_fits edges q0 q1 q2 q3 N0 N1 N2 N3 L) as (B & C & P).
    destruct (query_in_integers q0 q1 q2 q3) as (K & I0 & I1 & I2 & I3).
    destruct (CloseContact.query_to_the_end_right (unit_of [q0; q1; q2;
      q3]) K extent_x extent_y extent_z estimate refine
      steps more estimated_root root_exponent estimated_pair edges _ _ _ _ _ _ _ _ I0 I1 I2 I3 B C P) as (Yes & No).
    cbv zeta. destruct (CloseContact.decide_to_the_end _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _);
      [now apply No | now apply Yes | exact I].
Qed.

Lemma query_batch_right edges culls q0 q1 q2 q3 : numbers q0 -> numbers q1 -> numbers q2 -> numbers q3 ->
  Forall (sound (query_collides edges (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3))) culls ->
  (all_undecided (culls ++ query_stages edges q0 q1 q2 q3) -> reference_meets finder edges returned q0 q1 q2 q3) ->
  first_certain (culls ++ query_stages edges q0 q1 q2 q3) (reference_decides finder edges q0 q1 q2 q3) = true <->
  query_collides edges (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3).
Proof.
  intros N0 N1 N2 N3 C M. apply in_any_order.
  - apply Forall_app. split; [exact C | now apply query_stages_sound].
  - intros U. now apply query_reference_by_isolation, M.
Qed.
Theorem batch_face_right culls v f0 f1 f2 : numbers v -> numbers f0 -> numbers f1 -> numbers f2 ->
  Forall (sound (vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2))) culls ->
  (all_undecided (culls ++ face_stages v f0 f1 f2) -> reference_face_meets finder returned v f0 f1 f2) ->
  first_certain (culls ++ face_stages v f0 f1 f2) (reference_decides_face finder v f0 f1 f2) = true <->
  vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof. exact (query_batch_right false culls v f0 f1 f2). Qed.
Theorem batch_edges_right culls a0 a1 b0 b1 : numbers a0 -> numbers a1 -> numbers b0 -> numbers b1 ->
  Forall (sound (edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1))) culls ->
  (all_undecided (culls ++ edges_stages a0 a1 b0 b1) -> reference_edges_meets finder returned a0 a1 b0 b1) ->
  first_certain (culls ++ edges_stages a0 a1 b0 b1) (reference_decides_edges finder a0 a1 b0 b1) = true <->
  edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof. exact (query_batch_right true culls a0 a1 b0 b1). Qed.

Theorem exact_face_right v f0 f1 f2 : numbers v -> numbers f0 -> numbers f1 -> numbers f2 ->
  (all_undecided (face_stages v f0 f1 f2) -> reference_face_meets finder returned v f0 f1 f2) ->
  exact_face v f0 f1 f2 = true <->
  vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof. intros V F0 F1 F2 M. apply (batch_face_right [] v f0 f1 f2 V F0 F1 F2 (Forall_nil _) M). Qed.
Theorem exact_edges_right a0 a1 b0 b1 : numbers a0 -> numbers a1 -> numbers b0 -> numbers b1 ->
  (all_undecided (edges_stages a0 a1 b0 b1) -> reference_edges_meets finder returned a0 a1 b0 b1) ->
  exact_edges a0 a1 b0 b1 = true <->
  edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof. intros A0 A1 B0 B1 M. apply (batch_edges_right [] a0 a1 b0 b1 A0 A1 B0 B1 (Forall_nil _) M). Qed.

End Exact.
