(** The loop of `first_time_of` (ccd/contact/condition.cpp), over the real numbers. It tests the roots of one
    candidate polynomial after the other, up to the time found so far. A polynomial is represented by the times at
    which it is zero and the sides of its condition hold. Results:
        code_comparison      the comparison of two brackets is that of TimeBrackets.v
        first_time_of_right  the bracket returned is that of the first time, or none if this is after t_max
        vertices_time_of, vertex_edge_time_of, face_planar_time_of, edges_planar_time_of   for contact
        vertices_near_time_of, vertex_edge_near_time_of, face_near_time_of, edges_near_time_of   for a distance *)

From Coq Require Import Reals Lra List.
From Errbound Require Import Contact Distance Separation FirstContact FirstConditions TimeBrackets IntegerTimes.
Import ListNotations.
Open Scope R_scope.

Section Doubles.

Variable double : R -> Prop.
Notation holds_time := (holds_time double).
Hypothesis bracketed : forall t, 0 <= t <= 1 -> exists b, holds_time b t.

Lemma bracket_ends b t : holds_time b t ->
  double (fst b) /\ fst b <= snd b /\ forall x, double x -> ~ fst b < x < snd b.
Proof.
  intros [(D & E & E') | ((Dl & Dh & L & N) & S)].
  - rewrite E, E'. split; auto. split; [lra |]. intros x _. lra.
  - split; auto. split; [lra | auto].
Qed.
Theorem code_comparison a b s t : holds_time a s -> holds_time b t ->
  (fst a < fst b \/ snd a < snd b <-> lesser a b).
Proof.
  intros A B. destruct (bracket_ends a s A) as (Da & La & _). destruct (bracket_ends b t B) as (_ & _ & Nb).
  unfold lesser. split; [| tauto]. intros [L | L]; [now left |].
  destruct (Rtotal_order (fst a) (fst b)) as [Q | [Q | Q]]; auto. exfalso. apply (Nb (fst a) Da). lra.
Qed.

Variable last : R.  (** min(t_max, 1) *)
Hypothesis last_double : double last.

Definition end_of (s : option bracket) : R := match s with Some b => snd b | None => last end.
Inductive loop : option bracket -> list (R -> Prop) -> option bracket -> Prop :=
  | all_tested s : loop s [] s
  | no_root s (P : R -> Prop) rest s' : (forall r, 0 < r <= end_of s -> ~ P r) -> loop s rest s' -> loop s (P :: rest) s'
  | first_root s (P : R -> Prop) rest s' r b : 0 < r <= end_of s -> P r -> (forall q, 0 < q < r -> ~ P q) -> holds_time b r ->
      loop (earlier s (Some b)) rest s' -> loop s (P :: rest) s'.

(** The property after all of D was tested. *)
Definition tested_all (D : R -> Prop) (s : option bracket) : Prop :=
  match s with
  | None => forall q, 0 < q <= last -> ~ D q
  | Some b => (exists t, 0 < t <= last /\ D t /\ holds_time b t) /\
      forall q c, 0 < q <= last -> D q -> holds_time c q -> ~ lesser c b
  end.
Lemma end_before D s : tested_all D s -> end_of s <= last.
Proof.
  destruct s as [b |]; cbn [tested_all end_of]; [| lra].
  intros ((t & T & _ & [(_ & _ & E) | ((_ & _ & _ & N) & S)]) & _); [lra |].
  apply Rnot_lt_le. intros L. apply (N last last_double). lra.
Qed.
Lemma more_tested (D P : R -> Prop) s : tested_all D s -> (forall r, 0 < r <= end_of s -> ~ P r) ->
  tested_all (fun t => D t \/ P t) s.
Proof.
  destruct s as [b |]; cbn [tested_all end_of]; intros A N.
  - destruct A as ((t & T & Dt & B) & Least). split; [exists t; auto |].
    intros q c Q [Dq | Pq] C; [now apply (Least q c) |]. intros L.
    pose proof (lesser_bracket double c b q t C B L).
    assert (t <= snd b) by (destruct B as [(_ & _ & E) | (_ & S)]; lra). apply (N q); auto. lra.
  - intros q Q [Dq | Pq]; [now apply (A q) | now apply (N q)].
Qed.
Lemma found_tested (D P : R -> Prop) s r b : tested_all D s -> 0 < r <= end_of s -> P r ->
  (forall q, 0 < q < r -> ~ P q) -> holds_time b r -> tested_all (fun t => D t \/ P t) (earlier s (Some b)).
Proof.
  intros A R0 Pr First B. pose proof (end_before D s A) as En.
  assert (New : forall q c, 0 < q <= last -> P q -> holds_time c q -> ~ lesser c b).
  { intros q c Q Pq C. apply (not_lesser double) with (1 := B) (2 := C). apply Rnot_lt_le. intros L.
    apply (First q); auto. lra. }
  destruct s as [a |]; cbn [tested_all end_of earlier] in *.
  - destruct A as ((t & T & Dt & At) & Least). destruct (lesser_dec b a) as [L | L]; cbn [tested_all].
    + split; [exists r; split; [lra | auto] |]. intros q c Q [Dq | Pq] C; [| now apply (New q c)].
      intros M. apply (Least q c Q Dq C). now apply lesser_trans with b.
    + split; [exists t; auto |]. intros q c Q [Dq | Pq] C; [now apply (Least q c) |]. intros M.
      apply (New q c Q Pq C). destruct (lesser_total a b) as [K | [<- | K]]; auto; [| easy].
      now apply lesser_trans with a.
  - split; [exists r; split; [lra | auto] |]. intros q c Q [Dq | Pq] C; [now apply A in Dq | now apply (New q c)].
Qed.
Lemma tested_same (D E : R -> Prop) s : (forall t, D t <-> E t) -> tested_all D s -> tested_all E s.
Proof.
  intros S. destruct s as [b |]; cbn [tested_all].
  - intros ((t & T & Dt & B) & Least). split; [exists t; split; auto; split; auto; now apply S |].
    intros q c Q Eq. apply Least; auto. now apply S.
  - intros A q Q Eq. apply (A q Q). now apply S.
Qed.
Lemma loop_tests s parts s' : loop s parts s' -> forall D, tested_all D s ->
  tested_all (fun t => D t \/ exists P, In P parts /\ P t) s'.
Proof.
  intros L. induction L as [s | s P rest s' N L IH | s P rest s' r b R0 Pr First B L IH]; intros D A.
  - revert A. apply tested_same. intros t. split; [now left | intros [H | (P & [] & _)]; auto].
  - pose proof (IH _ (more_tested D P s A N)) as Q. revert Q. apply tested_same. intros t. simpl. split.
    + intros [[H | H] | (P' & I & H)]; eauto.
    + intros [H | (P' & [<- | I] & H)]; eauto.
  - pose proof (IH _ (found_tested D P s r b A R0 Pr First B)) as Q. revert Q. apply tested_same. intros t. simpl. split.
    + intros [[H | H] | (P' & I & H)]; eauto.
    + intros [H | (P' & [<- | I] & H)]; eauto.
Qed.

(** The result, if H does not hold at t = 0. *)
Definition told_until (H : R -> Prop) (o : option bracket) : Prop :=
  match o with
  | None => forall t, 0 <= t <= last -> ~ H t
  | Some b => exists t, first H t /\ t <= last /\ holds_time b t
  end.
Theorem first_time_of_right (H : R -> Prop) parts o : 0 <= last <= 1 -> ~ H 0 ->
  (sometime H -> exists t, first H t) ->
  (forall t, first H t -> t <> 0 -> exists P, In P parts /\ P t) ->
  (forall t P, 0 <= t <= 1 -> In P parts -> P t -> H t) ->
  loop None parts o -> told_until H o.
Proof.
  intros L01 H0 Exist Candidate Sound L.
  assert (A : tested_all (fun t => False \/ exists P, In P parts /\ P t) o)
    by (apply (loop_tests _ _ _ L (fun _ => False)); cbn [tested_all]; auto).
  assert (At : forall t, first H t -> t <= last -> 0 < t <= last /\ (False \/ exists P, In P parts /\ P t)).
  { intros t F Tl. pose proof F as (T & Ht & _). assert (t <> 0) by (intros ->; easy).
    split; [lra |]. right. now apply Candidate. }
  destruct o as [b |]; cbn [tested_all told_until] in *.
  - destruct A as ((t & T & [[] | (P & I & Pt)] & B) & Least).
    assert (Ht : H t) by (apply (Sound t P); auto; lra).
    destruct Exist as (r & F); [exists t; split; auto; lra |]. pose proof F as (R0 & Hr & Before).
    assert (Rt : r <= t) by (apply Rnot_lt_le; intros Q; apply (Before t); auto; lra).
    exists r. split; auto. split; [lra |]. destruct (At r F ltac:(lra)) as (Rl & C).
    destruct (bracketed r R0) as (c & Hc). rewrite <- (same_bracket double c b r t); auto. now apply (Least r c).
  - intros t T Ht. destruct Exist as (r & F); [exists t; split; auto; lra |]. pose proof F as (R0 & Hr & Before).
    assert (Rt : r <= t) by (apply Rnot_lt_le; intros Q; apply (Before t); auto; lra).
    destruct (At r F ltac:(lra)) as (Rl & C). now apply (A r).
Qed.

(** ** Contact and distance. `candidates` returns one polynomial for each condition, with its sides *)

Definition parts_of (cs : list condition_in_time) (parts : list (R -> Prop)) : Prop :=
  forall t, (exists P, In P parts /\ P t) <-> exists c, In c cs /\ candidate c t.
Lemma time_of cs (H : R -> Prop) parts o : 0 <= last <= 1 -> ~ H 0 -> (sometime H -> exists t, first H t) ->
  (forall t, first H t -> t <> 0 -> exists c, In c cs /\ candidate c t) ->
  (forall t c, 0 <= t <= 1 -> In c cs -> is_met c t -> H t) -> parts_of cs parts -> loop None parts o ->
  told_until H o.
Proof.
  intros L H0 Exist Candidate Sound Parts Loop. apply first_time_of_right with parts; auto.
  - intros t F N. apply Parts. now apply Candidate.
  - intros t P T I Pt. destruct (proj1 (Parts t)) as (c & J & C); [eauto |]. apply (Sound t c); auto.
    now apply candidate_holds.
Qed.

Theorem vertices_time_of v w parts o : 0 <= last <= 1 -> place v 0 <> place w 0 ->
  parts_of [vertices_in_time v w] parts -> loop None parts o -> told_until (fun t => place v t = place w t) o.
Proof.
  intros L N. apply time_of; auto.
  - apply vertices_first.
  - intros t F T. exists (vertices_in_time v w). split; [now left | now apply vertices_candidate].
  - intros t c _ [<- | []]. apply vertices_met.
Qed.
Theorem vertex_edge_time_of v e0 e1 parts o : 0 <= last <= 1 -> ~ vertex_on_edge v e0 e1 0 ->
  parts_of [vertex_edge_in_time v e0 e1] parts -> loop None parts o -> told_until (vertex_on_edge v e0 e1) o.
Proof.
  intros L N. apply time_of; auto.
  - apply vertex_edge_first.
  - intros t F T. exists (vertex_edge_in_time v e0 e1). split; [now left | now apply vertex_edge_candidate].
  - intros t c _ [<- | []]. apply vertex_edge_met.
Qed.
(** If Y = 0 throughout, the inner condition has no candidates. *)
Lemma query_planar_time_of edges m0 m1 m2 m3 parts o : (forall s, 0 <= s <= 1 -> query_y edges m0 m1 m2 m3 s = 0) ->
  0 <= last <= 1 -> ~ query_touches edges m0 m1 m2 m3 0 -> parts_of (query_border_in_time edges m0 m1 m2 m3) parts ->
  loop None parts o -> told_until (query_touches edges m0 m1 m2 m3) o.
Proof.
  intros Y L N. apply time_of; auto.
  - apply query_first.
  - intros t. now apply query_planar_candidate.
  - intros t c _ I M. apply query_times. right. apply query_border_met. eauto.
Qed.
Theorem face_planar_time_of v f0 f1 f2 parts o : (forall s, 0 <= s <= 1 -> face_y v f0 f1 f2 s = 0) ->
  0 <= last <= 1 -> ~ face_touches v f0 f1 f2 0 -> parts_of (face_border_in_time v f0 f1 f2) parts ->
  loop None parts o -> told_until (face_touches v f0 f1 f2) o.
Proof. exact (query_planar_time_of false v f0 f1 f2 parts o). Qed.
Theorem edges_planar_time_of a0 a1 b0 b1 parts o : (forall s, 0 <= s <= 1 -> edges_y a0 a1 b0 b1 s = 0) ->
  0 <= last <= 1 -> ~ edges_touch a0 a1 b0 b1 0 -> parts_of (edges_border_in_time a0 a1 b0 b1) parts ->
  loop None parts o -> told_until (edges_touch a0 a1 b0 b1) o.
Proof. exact (query_planar_time_of true a0 a1 b0 b1 parts o). Qed.

Lemma near_sound D t cs ks (near_then : Prop) c : Forall2 (same_at D t) cs ks ->
  (near_then <-> Exists (holds D) ks) -> In c cs -> is_met c t -> near_then.
Proof. intros A N I M. apply N, (same_at_pairs D t cs ks A). eauto. Qed.
Lemma some_first (H : R -> Prop) (Q : R -> Prop) : (sometime H -> exists t, first H t /\ Q t) ->
  sometime H -> exists t, first H t.
Proof. intros E S. destruct (E S) as (t & F & _). eauto. Qed.

Theorem vertices_near_time_of D v w parts o : 0 <= last <= 1 -> ~ near D (place v 0) (place w 0) ->
  parts_of [corner_in_time D v w] parts -> loop None parts o -> told_until (fun t => near D (place v t) (place w t)) o.
Proof.
  intros L N. apply time_of; auto.
  - eapply some_first. apply vertices_first_within.
  - intros t F T. exists (corner_in_time D v w). split; [now left | now apply vertices_near_candidate].
  - intros t c _ [<- | []] M. now apply corner_holds, (same_at_met D t _ _ (same_at_corner D v w t)).
Qed.
Ltac near_time_of candidates within conditions union :=
  intros L N; apply time_of; auto;
  [ eapply some_first; apply within
  | intros t; apply candidates
  | intros t c _; eapply near_sound with (ks := conditions t); [| apply union];
    repeat (apply Forall2_cons; [auto using same_at_corner, same_at_edge, same_at_face, same_at_edges |]); apply Forall2_nil ].
Theorem vertex_edge_near_time_of D v e0 e1 parts o : 0 <= last <= 1 ->
  ~ vertex_edge_near D (place v 0) (place e0 0) (place e1 0) -> parts_of (vertex_edge_near_in_time D v e0 e1) parts ->
  loop None parts o -> told_until (fun t => vertex_edge_near D (place v t) (place e0 t) (place e1 t)) o.
Proof.
  near_time_of vertex_edge_near_candidate vertex_edge_first_within
    (fun t => vertex_edge_conditions (place v t) (place e0 t) (place e1 t)) vertex_edge_within.
Qed.
Theorem face_near_time_of D v f0 f1 f2 parts o : 0 <= last <= 1 ->
  ~ face_near D (place v 0) (place f0 0) (place f1 0) (place f2 0) ->
  parts_of (all_face_near_in_time D v f0 f1 f2) parts -> loop None parts o ->
  told_until (fun t => face_near D (place v t) (place f0 t) (place f1 t) (place f2 t)) o.
Proof.
  near_time_of face_near_candidate face_first_within
    (fun t => face_conditions (place v t) (place f0 t) (place f1 t) (place f2 t)) face_within_union.
Qed.
Theorem edges_near_time_of D a0 a1 b0 b1 parts o : 0 <= last <= 1 ->
  ~ edges_near D (place a0 0) (place a1 0) (place b0 0) (place b1 0) ->
  parts_of (all_edges_near_in_time D a0 a1 b0 b1) parts -> loop None parts o ->
  told_until (fun t => edges_near D (place a0 t) (place a1 t) (place b0 t) (place b1 t)) o.
Proof.
  near_time_of edges_near_candidate edges_first_within
    (fun t => edges_conditions (place a0 t) (place a1 t) (place b0 t) (place b1 t)) edges_within_union.
Qed.

End Doubles.
