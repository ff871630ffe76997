(** The first contact inside a face or both edges in integers of fixed width (ccd/contact/interior_time.hpp). From it
    follows the first contact of vertex and face, or of two edges (ccd/contact/integer_first_contact.hpp). Estimates
    are arbitrary, as in InteriorContact.v. The search by signs has the properties that TimeSearch.v proves. Results:
        tested_root           an interval that `root_of` tests has one root of Y, where Y changes its sign
        in_parts_right        roots of Y in waiting intervals are tested, each with its bracket, or are later than
                              the result; except for a double root, which was tested before
        in_parts_ends         the loop ends (at most three intervals wait: three_parts_wait of InteriorContact.v)
        interior_time_right   `find` returns the first time with Y = 0 and all G_i > 0; if Y = 0 throughout, it tests
                              both ends
        face_time_right, edges_time_right   first_contact is right
        doubles_suffice       doubles have the properties that these theorems need *)

From Coq Require Import Reals ZArith Lia Lra List Bool Classical.
From Flocq Require Import Core.
From Errbound Require Import Sign Bernstein VertexEdge CubicRoots Subdivision Contact Decisions AxisUnits InteriorContact.
From Errbound Require Import Separation FirstContact TimeBrackets VertexEdgeTime IntegerTimes TimeSearch.
Import ListNotations.
Open Scope R_scope.

Section Query.

Context (edges : bool) (b c p : @vector_form integers) (degree_b : degree b 1) (degree_c : degree c 1)
  (degree_p : degree p 1) (extent_x extent_y extent_z : Z) (estimate : part -> Z)
  (refine : Z -> part -> Z -> Z -> Z -> Z).
Let y : list R := map IZR (y_form b c p).
Let Inside (t : R) : Prop := weights_positive edges (vector_at b t) (vector_at c t) (vector_at p t).
Let positive_at : R -> R -> bool := positive_at edges b c p.
Let near := near edges b c p extent_x extent_y extent_z refine.
Let good := good b c p.
Definition interior (t : R) : Prop := at_ y t = 0 /\ Inside t.

Variable double : R -> Prop.
Hypothesis dyadic : forall n bits, (0 <= bits <= 40)%Z -> (0 <= n <= 2 ^ bits)%Z -> double (over n bits).
(** root_search::between for an interval's root, and bracket_of_linear_root; none if fixed widths do not suffice. *)
Context (part_root : part -> option bracket) (linear_root : R -> R -> option bracket) (part_root_searched : forall q
    found, part_root q = Some found -> search double (at_ y) (unit_of (CubicRoots.first (roots q))) (part_start q)
    (part_end q) found) (linear_root_searched : forall p0 p1 found, linear_root p0 p1 = Some found -> linear_bracket
    double p0 p1 found).
(** place_of *)
Variable place_of : R -> Z -> Z.

(** ** Intervals *)

Definition strictly (s t : R) : outcome := if positive_at s t then collides else separate.
Definition tested (distinct three : bool) (q : part) : bool :=
  opposite (roots q) && negb (Nat.ltb 1 (count (roots q)) && (three || negb distinct)).
Definition root_answer (distinct : bool) (q : part) : outcome :=
  let bits := Z.min (level q + 48) 62 in
  match near distinct 3 1 q (estimate q) bits with
  | Some found => found
  | None =>
      match part_root q with
      | Some root =>
          match near distinct 3 1 q (place_of (fst root) bits) bits with Some found => found | None => undecided end
      | None => undecided
      end
  end.
(** The interval that is tested next comes first. Running out of steps, which the code does not, gives no answer. *)
Fixpoint in_parts (distinct three : bool) (steps : nat) (waiting : list part) (s : state) : state :=
  match steps, waiting with
  | O, _ => consider s None undecided
  | _, [] => s
  | Datatypes.S steps, q :: rest =>
      if Rlt_dec (part_start q) (fst (first_found s)) then
        if tested distinct three q then in_parts distinct three steps rest (consider s (part_root q) (root_answer distinct q))
        else if (level q =? max_halvings)%Z then in_parts distinct three steps rest (consider s None undecided)
        else
          let h := part_y q in
          let t := (2 * index q + 1)%Z in
          let middle := over t (level q + 1) in
          let s :=
            if same_sign (sign_of_real (nth 0 h 0 + nth 1 h 0 + nth 2 h 0 + nth 3 h 0)) zero
            then consider s (Some (middle, middle)) (strictly (IZR (2 ^ (level q + 1) - t)) (IZR t)) else s in
          in_parts distinct three steps (waiting_next three q rest) s
      else in_parts distinct three steps rest s
  end.

(** Facts about Y's roots: those that are not crossed are in D and were tested before. *)
Definition known_but (distinct three : bool) (D : R -> Prop) : Prop :=
  ~ Forall (eq 0) y /\ (three = true -> 0 < discriminant y) /\ (three = false -> crosses_once 0 1 (at_ y) D) /\
  (distinct = true -> forall t, 0 < t < 1 -> ~ D t).

Lemma strictly_right s t : 0 < s + t -> (strictly s t = collides -> Inside (t / (s + t))) /\
  (strictly s t = separate -> ~ Inside (t / (s + t))).
Proof.
  intros S. unfold strictly. pose proof (positive_at_right edges b c p degree_b degree_c degree_p s t S) as Q.
  fold positive_at in Q. unfold Inside. destruct (positive_at s t); split; try discriminate; intros _; [now apply Q |].
  intros I. apply Q in I. discriminate.
Qed.

Theorem tested_root distinct three D q : known_but distinct three D -> is_part y q -> tested distinct three q = true ->
  opposite (roots q) = true /\ (forall Q, crosses_once (part_start q) (part_end q) (at_ y) Q) /\
  exists r, part_start q < r < part_end q /\ at_ y r = 0 /\ forall t, part_start q < t < part_end q ->
    (at_ y t = 0 -> t = r) /\ (0 < at_ y t * unit_of (CubicRoots.first (roots q)) -> t < r) /\
    (at_ y t * unit_of (CubicRoots.first (roots q)) < 0 -> r < t).
Proof.
  intros (_ & _ & One & Dist) H A. unfold tested in A. apply andb_prop in A. destruct A as (O & A).
  pose proof (part_inside y q H) as In01.
  assert (Once : forall Q, crosses_once (part_start q) (part_end q) (at_ y) Q).
  { intros Q. apply negb_true_iff, andb_false_iff in A. destruct A as [A | A].
    - apply Nat.ltb_ge in A. apply one_change_part; auto. pose proof H as (L & R & _). rewrite R in *.
      pose proof (proj2 (proj2 (proj2 (proj2 (changes_ends _ L))))) as C. specialize (C O). lia.
    - apply orb_false_iff in A. destruct A as (-> & A). apply negb_false_iff in A.
      destruct (One eq_refl) as (l0 & l1 & q' & F). exists l0, l1, q'. intros t T.
      destruct (F t ltac:(lra)) as (E & P & Z). split; auto. split; auto. intros Zq. exfalso.
      apply (Dist A t); [lra | auto]. }
  split; auto. split; auto. destruct (part_signs y q H) as (S0 & S1 & F). rewrite O in S1.
  set (s := CubicRoots.first (roots q)) in *.
  destruct (crossed (part_start q) (part_end q) (at_ y) (fun _ => False) s (part_start q) (part_end q)) as
    (r & R0 & Z & Only); try lra; auto.
  { destruct Req_EM_T; [auto | congruence]. }
  { destruct Req_EM_T; [auto | congruence]. }
  assert (Opp : unit_of (opposed s) = - unit_of s) by (destruct s; simpl; ring).
  exists r. split; auto. split; auto. intros t T.
  split; [intros Zt; now destruct (Only t T Zt) |].
  split; intros S; (destruct (Rtotal_order t r) as [L | [-> | L]]; [| rewrite Z in S; lra |]); auto; exfalso.
  - destruct (just_before _ _ t _ S1 ltac:(lra)) as (u & U & P). rewrite Opp in P.
    destruct (between_signs (at_ y) t u) as (v & V & Zv); [apply continuous_form | lra | |].
    { destruct F as [F | F]; rewrite F in *; simpl in *; nra. }
    destruct (Only v ltac:(lra) Zv); [lra | easy].
  - destruct (just_after _ _ _ t S0 ltac:(lra)) as (u & U & P).
    destruct (between_signs (at_ y) u t) as (v & V & Zv); [apply continuous_form | lra | |].
    { destruct F as [F | F]; rewrite F in *; simpl in *; nra. }
    destruct (Only v ltac:(lra) Zv); [lra | easy].
Qed.

Lemma tested_step distinct three D q : known_but distinct three D -> good three q -> tested distinct three q = true ->
  exists r, step_right double interior (considered r (part_root q) (root_answer distinct q)) /\
    forall t, part_start q < t < part_end q -> at_ y t = 0 -> t = r.
Proof.
  intros K (H & Lv & _) A. destruct (tested_root distinct three D q K H A) as (O & Once & r & R0 & Z & Only).
  pose proof (part_inside y q H) as In01. exists r. split; [| intros t T; now apply Only]. split; [lra |]. split.
  { intros found E. apply part_root_searched in E.
    apply (search_only double _ _ _ _ r _ E); auto; intros t T; now apply Only. }
  assert (Right : forall place, let bits := Z.min (level q + 48) 62 in forall o, near distinct 3 1 q place bits = Some o ->
    (o = collides -> interior r) /\ (o = separate -> ~ interior r)).
  { intros place bits o N. assert (Hb : (level q <= bits)%Z) by (unfold max_halvings in Lv; unfold bits; lia).
    split; intros E; subst o.
    - destruct (near_here edges b c p degree_b degree_c degree_p extent_x extent_y extent_z refine distinct 3 1 q place
        bits H Hb O (Once _) N) as (t & T & Zt & I). fold y in Zt. destruct (Only t T) as (Only' & _).
      rewrite (Only' Zt) in *. now split.
    - pose proof (near_right edges b c p degree_b degree_c degree_p extent_x extent_y extent_z refine distinct 3 1 q place
        bits separate H Hb O (Once _) N) as Sep. intros (_ & I). exact (Sep r R0 Z I). }
  unfold root_answer. cbv zeta in *.
  destruct (near distinct 3 1 q (estimate q) _) as [o |] eqn:E; [now apply (Right (estimate q)) |].
  destruct (part_root q) as [root |]; [| easy].
  destruct (near distinct 3 1 q (place_of (fst root) _) _) as [o |] eqn:E'; [| easy].
  now apply (Right (place_of (fst root) (Z.min (level q + 48) 62))).
Qed.

Lemma covers_more x steps t : covers steps t -> covers (x :: steps) t.
Proof. intros [(r & a & I) | (s & I & L)]; [left | right]; eauto using in_cons. Qed.
Lemma unplaced_step s steps s' : run (consider s None undecided) steps s' -> unplaced s' = true.
Proof.
  intros R. destruct (unplaced s') eqn:U; auto. now apply run_unplaced in R.
Qed.
Theorem in_parts_right distinct three D steps : known_but distinct three D -> forall waiting s,
  Forall (good three) waiting -> exists tests, run s tests (in_parts distinct three steps waiting s) /\
  Forall (step_right double interior) tests /\
  (unplaced (in_parts distinct three steps waiting s) = false -> forall q t, In q waiting ->
     part_start q < t < part_end q -> at_ y t = 0 -> covers tests t \/ D t).
Proof.
  intros K. assert (Undecided : step_right double interior (considered 0 None undecided))
    by (split; [lra | split; [discriminate | split; discriminate]]).
  induction steps as [| steps IH]; intros waiting s G.
  { exists [considered 0 None undecided]. cbn [in_parts]. split; [repeat constructor |]. split; [auto |].
    intros U. discriminate. }
  destruct waiting as [| q rest]; cbn [in_parts].
  { exists []. split; [constructor |]. split; auto. intros _ q t []. }
  inversion_clear G as [| ? ? Gq Gr]. destruct (Rlt_dec (part_start q) (fst (first_found s))) as [L | L].
  2: { destruct (IH rest s Gr) as (l & Rn & F & C). exists (later_than (part_start q) :: l).
       split; [now constructor |]. split; [now constructor |]. intros U q' t [<- | I] T Z.
       - left. right. exists (part_start q). split; [now left | lra].
       - destruct (C U q' t I T Z); auto. left. now apply covers_more. }
  destruct (tested distinct three q) eqn:A.
  { destruct (tested_step distinct three D q K Gq A) as (r & Right & Only).
    destruct (IH rest (consider s (part_root q) (root_answer distinct q)) Gr) as (l & Rn & F & C).
    exists (considered r (part_root q) (root_answer distinct q) :: l).
    split; [now constructor |]. split; [now constructor |]. intros U q' t [<- | I] T Z.
    - left. left. rewrite (Only t T Z). eexists _, _. now left.
    - destruct (C U q' t I T Z); auto. left. now apply covers_more. }
  destruct (Z.eqb_spec (level q) max_halvings) as [M | M].
  { destruct (IH rest (consider s None undecided) Gr) as (l & Rn & F & C). exists (considered 0 None undecided :: l).
    split; [now constructor |]. split; [now constructor |]. intros U. apply unplaced_step in Rn. congruence. }
  cbv zeta. pose proof Gq as (H & Lv & _). destruct (halves_good b c p three q Gq ltac:(lia)) as (G0 & G1).
  destruct (halves_are_parts y q H) as (Hl & _ & Es & Ee & Em & Em').
  pose proof (part_inside y _ Hl) as Im. rewrite Em in Im. pose proof H as (_ & _ & (Hlv & Hi & Hj) & _).
  set (t := (2 * index q + 1)%Z) in *. set (middle := over t (level q + 1)) in *.
  pose proof (middle_sign b c p q H) as Ms. cbv zeta in Ms. fold y t middle in Ms.
  set (s' := if same_sign _ zero then _ else s).
  assert (Gn : Forall (good three) (waiting_next three q rest)).
  { unfold waiting_next. apply Forall_app. split; auto. apply Forall_forall. intros h I. apply filter_In in I.
    destruct I as ([<- | [<- | []]] & _); auto. }
  destruct (IH (waiting_next three q rest) s' Gn) as (l & Rn & F & C).
  assert (Halves : unplaced (in_parts distinct three steps (waiting_next three q rest) s') = false ->
    forall h u, h = left_of q \/ h = right_of q -> part_start h < u < part_end h -> at_ y u = 0 -> covers l u \/ D u).
  { intros U h u Eh T Z. assert (Gh : good three h) by (destruct Eh as [-> | ->]; auto).
    destruct (any_root three (roots h)) eqn:R.
    - apply (C U h u); auto. unfold waiting_next. apply in_or_app. left. apply filter_In. split; auto.
      simpl. intuition auto.
    - right. destruct K as (_ & _ & One & _). now apply (unasked b c p three h D One Gh R). }
  assert (Mid : exists l', run s l' (in_parts distinct three steps (waiting_next three q rest) s') /\
    Forall (step_right double interior) l' /\ (at_ y middle = 0 -> covers l' middle) /\
    forall u, covers l u -> covers l' u).
  { unfold s' in *. destruct (same_sign _ zero) eqn:S.
    - exists (considered middle (Some (middle, middle)) (strictly (IZR (2 ^ (level q + 1) - t)) (IZR t)) :: l).
      assert (P : 0 < IZR (2 ^ (level q + 1) - t) + IZR t).
      { rewrite <- plus_IZR. apply IZR_lt. assert (0 < 2 ^ (level q + 1))%Z by (apply Z.pow_pos_nonneg; lia). lia. }
      assert (E : IZR t / (IZR (2 ^ (level q + 1) - t) + IZR t) = middle).
      { rewrite <- plus_IZR. now replace (2 ^ (level q + 1) - t + t)%Z with (2 ^ (level q + 1))%Z by ring. }
      destruct (strictly_right _ _ P) as (Yes & No). rewrite E in Yes, No.
      split; [now constructor |]. split; [constructor; auto |].
      { split; [lra |]. split; [| split].
        - intros found X. injection X as <-. left. split; auto. apply dyadic; [unfold max_halvings in *; lia |].
          unfold t. rewrite Z.pow_add_r by lia. lia.
        - intros X. split; [now apply Ms | now apply Yes].
        - intros X (_ & I). now apply No. }
      split; [intros _; left; eexists _, _; now left |]. intros u. apply covers_more.
    - exists l. split; auto. split; auto. split; auto. intros Z. apply Ms in Z. congruence. }
  destruct Mid as (l' & Rn' & F' & Cm & More). exists l'. split; auto. split; auto.
  intros U q' u [<- | I] T Z.
  - destruct (Rtotal_order u middle) as [Lm | [-> | Lm]]; auto.
    + destruct (Halves U (left_of q) u) as [Q | Q]; auto. lra.
    + destruct (Halves U (right_of q) u) as [Q | Q]; auto. lra.
  - destruct (C U q' u) as [Q | Q]; auto. unfold waiting_next. apply in_or_app. now right.
Qed.
Theorem in_parts_ends distinct three steps : forall waiting s more,
  Forall (fun q => level q <= max_halvings)%Z waiting -> (work waiting < Z.of_nat steps)%Z -> (steps <= more)%nat ->
  in_parts distinct three more waiting s = in_parts distinct three steps waiting s.
Proof.
  induction steps as [| steps IH]; intros waiting s more F W M.
  { pose proof (work_positive waiting). lia. }
  destruct more as [| more]; [lia |]. destruct waiting as [| q rest]; [easy |]. cbn [in_parts].
  inversion_clear F as [| ? ? Fq Fr]. assert (Wr : (work rest < work (q :: rest))%Z).
  { unfold work. cbn [fold_right]. unfold max_halvings in Fq. pose proof (Z.pow_pos_nonneg 3 (41 - level q)). lia. }
  destruct (Rlt_dec _ _); [| apply IH; auto; lia]. destruct (tested distinct three q); [apply IH; auto; lia |].
  destruct (Z.eqb_spec (level q) max_halvings); [apply IH; auto; lia |].
  destruct (next_work three q rest) as (Fn & Wn); auto; [lia |]. apply IH; auto; lia.
Qed.

(** ** All roots *)

(** find(), with a number of steps of the loop. No vertex/edge contact is earlier than `last`. *)
Definition at_ends (s : state) : state :=
  let s := if is_0 (nth 0 y 0) then consider s (Some (0, 0)) (strictly 1 0) else s in
  if is_0 (nth 3 y 0) then consider s (Some (1, 1)) (strictly 0 1) else s.
Definition between_ends (steps : nat) (s : state) : state :=
  let changes := inner_sign_changes y in
  let whole := Part y changes 0 0 in
  if Nat.ltb 1 (count changes) then
    let '(multiple, (distinct, three, triple)) := linear_of_multiple b c p in
    let s := match multiple with Some (p0, p1) => consider s (linear_root p0 p1) (strictly p1 (- p0)) | None => s end in
    if triple then s else in_parts distinct three steps [whole] s
  else if Nat.ltb 0 (count changes) then in_parts true false steps [whole] s
  else s.
Definition find (steps : nat) (last : bracket) : state := between_ends steps (at_ends (State last separate false)).

Definition inside_time (s : state) : option bracket := match found s with collides => Some (first_found s) | _ => None end.

(** The contacts to find. *)
Definition wanted (t : R) : Prop := interior t /\ (zero_throughout b c p -> t = 0 \/ t = 1).

Lemma run_app s l s' l' s'' : run s l s' -> run s' l' s'' -> run s (l ++ l') s''.
Proof. intros R. induction R; intros R'; simpl; [auto | | ]; constructor; auto. Qed.
Lemma covers_app l l' t : covers l t \/ covers l' t -> covers (l ++ l') t.
Proof.
  intros [[(r & a & I) | (s & I & L)] | [(r & a & I) | (s & I & L)]]; [left | right | left | right];
    repeat eexists; eauto using in_or_app.
Qed.
Lemma one_step r root answer : (0 <= r <= 1) -> (forall found, root = Some found -> holds_time double found r) ->
  (answer = collides -> wanted r) -> (answer = separate -> ~ wanted r) -> forall s, exists l,
  run s l (consider s root answer) /\ Forall (step_right double wanted) l /\ covers l r.
Proof.
  intros R0 B Yes No s. exists [considered r root answer]. split; [repeat constructor |].
  split; [constructor; [now split | constructor] |]. left. eexists _, _. now left.
Qed.
Lemma double_end n : (n = 0 \/ n = 1)%Z -> double (IZR n).
Proof. intros N. replace (IZR n) with (over n 0) by (unfold over; simpl; field). apply dyadic; simpl; lia. Qed.
Lemma y_ends : at_ y 0 = nth 0 y 0 /\ at_ y 1 = nth 3 y 0.
Proof.
  assert (L : length y = 4%nat) by (apply y_length; auto). revert L. generalize y. intros w L. four w L.
  unfold at_. simpl. split; ring.
Qed.
Lemma at_ends_right s : exists l, run s l (at_ends s) /\ Forall (step_right double wanted) l /\
  (at_ y 0 = 0 -> covers l 0) /\ (at_ y 1 = 0 -> covers l 1).
Proof.
  destruct y_ends as (E0 & E1).
  assert (Ask : forall n t, (n = 0 \/ n = 1)%Z -> t = IZR n -> at_ y t = 0 -> forall s, exists l,
    run s l (consider s (Some (t, t)) (strictly (1 - t) t)) /\ Forall (step_right double wanted) l /\ covers l t).
  { intros n t N E Z. pose proof (double_end n N) as D. destruct (strictly_right (1 - t) t ltac:(lra)) as (Yes & No).
    assert (Et : t / (1 - t + t) = t) by (replace (1 - t + t) with 1 by ring; field). rewrite Et in Yes, No. apply one_step.
    - rewrite E. destruct N as [-> | ->]; lra.
    - intros found X. injection X as <-. left. rewrite E. auto.
    - intros X. split; [split; auto |]. intros _. rewrite E. destruct N as [-> | ->]; auto.
    - intros X ((_ & I) & _). now apply No. }
  assert (End : forall n t, (n = 0 \/ n = 1)%Z -> t = IZR n -> forall h, at_ y t = h -> forall s, exists l,
    run s l (if is_0 h then consider s (Some (t, t)) (strictly (1 - t) t) else s) /\
    Forall (step_right double wanted) l /\ (at_ y t = 0 -> covers l t)).
  { intros n t N E h Eh s'. destruct (is_0 h) eqn:Z.
    - apply is_0_true in Z. destruct (Ask n t N E ltac:(congruence) s') as (l & ? & ? & ?). eauto.
    - exists []. split; [constructor |]. split; auto. rewrite Eh. intros Zt. apply is_0_true in Zt. congruence. }
  destruct (End 0%Z 0 ltac:(auto) eq_refl _ E0 s) as (l & R0 & F0 & C0). rewrite Rminus_0_r in R0.
  destruct (End 1%Z 1 ltac:(auto) eq_refl _ E1 (if is_0 (nth 0 y 0) then consider s (Some (0, 0)) (strictly 1 0) else s))
    as (l' & R1 & F1 & C1). rewrite Rminus_diag_eq in R1 by easy.
  exists (l ++ l'). split; [now apply run_app with (1 := R0) |]. split; [now apply Forall_app |].
  split; intros Z; apply covers_app; auto.
Qed.
Lemma moving_wanted : ~ Forall (eq 0) y -> forall t, wanted t <-> interior t.
Proof. intros N t. split; [now intros (I & _) |]. split; auto. intros Z. now apply y_zero in Z. Qed.

Lemma between_ends_right steps s : exists l, run s l (between_ends steps s) /\ Forall (step_right double wanted) l /\
  (unplaced (between_ends steps s) = false -> ~ Forall (eq 0) y -> forall t, 0 < t < 1 -> at_ y t = 0 -> covers l t).
Proof.
  assert (L : length y = 4%nat) by (apply y_length; auto). unfold between_ends. cbv zeta.
  assert (Parts : forall distinct three D s, known_but distinct three D -> exists l,
    run s l (in_parts distinct three steps [Part y (inner_sign_changes y) 0 0] s) /\
    Forall (step_right double wanted) l /\
    (unplaced (in_parts distinct three steps [Part y (inner_sign_changes y) 0 0] s) = false ->
     forall t, 0 < t < 1 -> at_ y t = 0 -> covers l t \/ D t)).
  { intros distinct three D s' K. pose proof K as (N & Three & _).
    destruct (in_parts_right distinct three D steps K [Part y (inner_sign_changes y) 0 0] s') as (l & R & F & C).
    { constructor; [| constructor]. split; [now apply whole_is_part |]. split; auto. easy. }
    exists l. split; auto. split.
    - revert F. apply Forall_impl. intros [r root answer | start]; auto. cbn [step_right].
      rewrite (moving_wanted N). tauto.
    - intros U t T Z. apply (C U _ t (or_introl eq_refl)); auto. unfold part_start, part_end, over. cbn [index level].
      simpl. lra. }
  destruct (Nat.ltb_spec 1 (count (inner_sign_changes y))) as [Many | One].
  - pose proof (linear_of_multiple_right b c p degree_b degree_c degree_p Many) as M. fold y in M.
    destruct (linear_of_multiple b c p) as [multiple [[distinct three] triple]].
    destruct M as (N & Three & Few & Dist & Root). pose proof (moving_wanted N) as W.
    assert (K : known_but distinct three (fun t => multiple_root y t /\ discriminant y = 0)).
    { split; auto. split; auto. split; [intros E; apply one_real_root; auto |]. intros E t _ (_ & D). now apply Dist. }
    destruct multiple as [[p0 p1] |].
    + destruct Root as (P & Z & Only & Triple). set (r := - p0 / (p1 + - p0)) in *.
      assert (R0 : 0 <= r <= 1).
      { unfold r. split; [left; apply Rdiv_lt_0_compat; lra |]. apply Rmult_le_reg_r with (p1 + - p0); [lra |].
        field_simplify; lra. }
      destruct (strictly_right p1 (- p0) ltac:(lra)) as (Yes & No). fold r in Yes, No.
      destruct (one_step r (linear_root p0 p1) (strictly p1 (- p0)) R0) with (s := s) as (l & R & F & C).
      { intros found E. apply linear_root_searched in E.
        destruct (linear_bracket_right double (double_end 0 ltac:(auto)) (double_end 1 ltac:(auto)) p0 p1 found)
          as (r' & _ & H & O); auto; [nra | lra |]. replace r with r'; auto.
        symmetry. apply O. unfold linear_at, r. field. lra. }
      { intros E. apply W. split; auto. }
      { intros E I. apply W in I. now apply No, I. }
      destruct triple.
      * exists l. split; auto. split; auto. intros _ _ t T Zt. now rewrite (Triple eq_refl t Zt).
      * destruct (Parts distinct three _ (consider s (linear_root p0 p1) (strictly p1 (- p0))) K) as (l' & R' & F' & C').
        exists (l ++ l'). split; [now apply run_app with (1 := R) |]. split; [now apply Forall_app |].
        intros U _ t T Zt. apply covers_app. destruct (C' U t T Zt) as [Q | (Q & _)]; auto.
        left. now rewrite (Only t T Q).
    + destruct Root as (-> & None_). destruct (Parts distinct three _ s K) as (l & R & F & C).
      exists l. split; auto. split; auto. intros U _ t T Zt. destruct (C U t T Zt) as [Q | (Q & D)]; auto.
      now destruct (None_ t T D).
  - destruct (Nat.ltb_spec 0 (count (inner_sign_changes y))) as [Some_ | Zero].
    + destruct (Parts true false (fun _ => False) s) as (l & R & F & C).
      { split; [apply changes_moving; auto |]. split; [discriminate |]. split; [| easy]. intros _.
        apply one_change_crosses; auto. lia. }
      exists l. split; auto. split; auto. intros U _ t T Zt. now destruct (C U t T Zt).
    + exists []. split; [constructor |]. split; auto. intros _ N t T Zt.
      destruct (no_changes y L ltac:(lia)) as [Q | Q]; [easy |]. now apply Q in Zt.
Qed.

Theorem interior_time_right steps last : is_bracket double last -> let s := find steps last in unplaced s = false ->
  found s <> undecided -> told_before double wanted last (inside_time s).
Proof.
  intros V s U O. destruct (at_ends_right (State last separate false)) as (l & R & F & C0 & C1).
  destruct (between_ends_right steps (at_ends (State last separate false))) as (l' & R' & F' & C).
  assert (H := considered_right double wanted last (l ++ l') s). unfold inside_time.
  enough (G : match found s with separate => _ | collides => _ | undecided => True end)
    by (destruct (found s); [exact G .. | easy]).
  apply H; auto; [now apply run_app with (1 := R) | now apply Forall_app |]. clear H.
  intros t T ((Z & I) & W). apply covers_app. destruct (Req_dec t 0) as [-> |]; auto. destruct (Req_dec t 1) as [-> |]; auto.
  right. apply C; auto; [| lra]. intros N. apply y_zero in N; auto. now destruct (W N).
Qed.

End Query.

(** ** Queries *)

Section Kinds.

Context (double : R -> Prop) (dyadic : forall n bits, (0 <= bits <= 40)%Z -> (0 <= n <= 2 ^ bits)%Z -> double (over n
    bits)) (double_2 : double 2) (bracketed : forall t, 0 <= t <= 1 -> exists b, holds_time double b t).
(** Each for the given polynomial. *)
Context (part_root : list R -> part -> option bracket) (linear_root : R -> R -> option bracket) (part_root_searched :
    forall y q found, part_root y q = Some found -> search double (at_ y) (unit_of (CubicRoots.first (roots q)))
    (part_start q) (part_end q) found)
  (linear_root_searched : forall p0 p1 found, linear_root p0 p1 = Some found -> linear_bracket double p0 p1 found)
  (extent_x extent_y extent_z : Z) (estimate : part -> Z) (refine : Z -> part -> Z -> Z -> Z -> Z)
  (place_of : R -> Z -> Z) (steps : nat) (unit : point) (U : units unit).

(** The result for an edge of the border: first_vertex_edge_contact, or none if coordinates separate. *)
Definition border_time (m0 m1 m2 : moving) (v e0 e1 : integer_motion) (o : option bracket) : Prop :=
  let place := first_vertex_edge_contact (exact_motion v) (exact_motion e0) (exact_motion e1) in
  match o with
  | None => separated m0 m1 m2 = true \/ place = nowhere
  | Some found => place_bracket double place found
  end.
Lemma border_told m0 m1 m2 v e0 e1 o : in_integers unit m0 v -> in_integers unit m1 e0 -> in_integers unit m2 e1 ->
  border_time m0 m1 m2 v e0 e1 o -> told double (vertex_on_edge (exact_motion v) (exact_motion e0) (exact_motion e1)) o.
Proof.
  assert (double 0 /\ double 1) as (D0 & D1)
    by (split; [apply (double_end double dyadic 0) | apply (double_end double dyadic 1)]; auto).
  unfold in_integers, border_time. intros I0 I1 I2 H.
  destruct (first_bracket_right double D0 D1 (exact_motion v) (exact_motion e0) (exact_motion e1))
    as [(E & No) | (N & t & F & B)];
    destruct o as [found |]; cbn [told].
  - now rewrite E in H.
  - intros s S C. apply No. now exists s.
  - exists t. auto.
  - destruct H as [H | H]; [| easy]. intros s S C. apply separated_right in H. apply H, (vertex_edge_units unit); auto.
    rewrite <- I0, <- I1, <- I2. now exists s.
Qed.
Lemma bracket_of_told H o : told double H o -> is_bracket double (last_of o).
Proof.
  destruct o as [found |]; cbn [told last_of]; [intros (t & _ & B); now exists t |]. intros _. exists 2. left. auto.
Qed.

Notation find edges b c p := (find edges b c p extent_x extent_y extent_z estimate refine
  (part_root (map IZR (y_form b c p))) linear_root place_of steps).

Lemma wanted_first edges b c p touches border inside_at :
  (forall t, touches t <-> (det (vector_at b t) (vector_at c t) (vector_at p t) = 0 /\ inside_at t) \/ border t) ->
  degree b 1 -> degree c 1 -> degree p 1 ->
  (forall t, weights_positive edges (vector_at b t) (vector_at c t) (vector_at p t) <-> inside_at t) ->
  (sometime touches -> exists t, first touches t) ->
  (forall t, zero_throughout b c p -> first touches t -> t = 0 \/ border t) -> forall o, told double border o ->
  let s := find edges b c p (last_of o) in unplaced s = false -> found s <> undecided ->
  told double touches (composed o (inside_time s)).
Proof.
  intros Times Db Dc Dp Same First Planar o Border s Un O.
  pose proof (interior_time_right edges b c p Db Dc Dp extent_x extent_y extent_z estimate refine double dyadic _ linear_root
    (part_root_searched _) linear_root_searched place_of steps (last_of o) (bracket_of_told _ o Border) Un O) as Told.
  assert (I : forall t, interior edges b c p t <-> det (vector_at b t) (vector_at c t) (vector_at p t) = 0 /\ inside_at t)
    by (intros t; unfold interior; now rewrite y_at, Same).
  apply (composed_first double bracketed (wanted edges b c p) border); auto.
  - intros t [(W & _) | B]; apply Times; [left; now apply I | now right].
  - intros C. destruct (First C) as (t & F). exists t. split; auto. pose proof F as (_ & H & _). apply Times in H.
    destruct H as [H | H]; [| now right]. destruct (classic (zero_throughout b c p)) as [Z | N].
    + destruct (Planar t Z F) as [-> | B]; [| now right]. left. split; [now apply I | auto].
    + left. split; [now apply I | easy].
Qed.

Lemma query_time_right edges m0 m1 m2 m3 q0 q1 q2 q3 o : in_integers unit m0 q0 -> in_integers unit m1 q1 ->
  in_integers unit m2 q2 -> in_integers unit m3 q3 ->
  told double (query_on_border edges (exact_motion q0) (exact_motion q1) (exact_motion q2) (exact_motion q3)) o ->
  let s := find edges (side_b edges Decisions.difference q0 q1 q2 q3) (side_c edges Decisions.difference q0 q1 q2 q3)
    (side_p edges Decisions.difference q0 q1 q2 q3) (last_of o) in
  unplaced s = false -> found s <> undecided ->
    told double (query_touches edges m0 m1 m2 m3) (composed o (inside_time s)).
Proof.
  intros I0 I1 I2 I3 Border s Un O. pose proof (query_sides_at edges q0 q1 q2 q3) as Sides.
  apply (told_same double (query_touches edges (exact_motion q0) (exact_motion q1) (exact_motion q2) (exact_motion
    q3))).
  { intros t. unfold in_integers, query_touches in *. rewrite I0, I1, I2, I3, !place_stretched.
    destruct edges; [now apply segments_stretched | now apply triangle_stretched]. }
  destruct (query_degrees edges q0 q1 q2 q3) as (Db & Dc & Dp).
  apply wanted_first with (inside_at := query_inside_at edges (exact_motion q0) (exact_motion q1) (exact_motion q2)
    (exact_motion q3))
    (border := query_on_border edges (exact_motion q0) (exact_motion q1) (exact_motion q2) (exact_motion q3)); auto.
  - intros t. destruct (Sides t) as (-> & -> & ->). apply query_times.
  - intros t. destruct (Sides t) as (-> & -> & ->). apply query_inside_same.
  - apply query_first.
  - intros t Z F. apply query_planar_first; auto. intros r R0. specialize (Z r R0). cbv beta in Z.
    destruct (Sides r) as (Eb & Ec & Ep). now rewrite Eb, Ec, Ep in Z.
Qed.
Theorem face_time_right m0 m1 m2 m3 v f0 f1 f2 o0 o1 o2 : in_integers unit m0 v -> in_integers unit m1 f0 ->
  in_integers unit m2 f1 -> in_integers unit m3 f2 ->
  border_time m0 m1 m2 v f0 f1 o0 -> border_time m0 m2 m3 v f1 f2 o1 -> border_time m0 m3 m1 v f2 f0 o2 ->
  let o := earlier (earlier o0 o1) o2 in
  let s := find false (Decisions.difference f1 f0) (Decisions.difference f2 f0) (Decisions.difference v f0) (last_of o) in
  unplaced s = false -> found s <> undecided -> told double (face_touches m0 m1 m2 m3) (composed o (inside_time s)).
Proof.
  intros I0 I1 I2 I3 B0 B1 B2 o. apply (border_told _ _ _ _ _ _ _ I0 I1 I2) in B0.
  apply (border_told _ _ _ _ _ _ _ I0 I2 I3) in B1. apply (border_told _ _ _ _ _ _ _ I0 I3 I1) in B2.
  refine (query_time_right false m0 m1 m2 m3 v f0 f1 f2 o I0 I1 I2 I3 _).
  eapply (told_same double); [| unfold o; repeat eapply earlier_right; eassumption].
  intros t. unfold either, query_on_border, on_face_border. tauto.
Qed.
Theorem edges_time_right m0 m1 m2 m3 a0 a1 b0 b1 o0 o1 o2 o3 : in_integers unit m0 a0 -> in_integers unit m1 a1 ->
  in_integers unit m2 b0 -> in_integers unit m3 b1 ->
  border_time m0 m2 m3 a0 b0 b1 o0 -> border_time m1 m2 m3 a1 b0 b1 o1 ->
  border_time m2 m0 m1 b0 a0 a1 o2 -> border_time m3 m0 m1 b1 a0 a1 o3 ->
  let o := earlier (earlier (earlier o0 o1) o2) o3 in
  let s := find true (Decisions.difference a1 a0) (Decisions.difference b1 b0) (Decisions.difference b0 a0) (last_of o) in
  unplaced s = false -> found s <> undecided -> told double (edges_touch m0 m1 m2 m3) (composed o (inside_time s)).
Proof.
  intros I0 I1 I2 I3 B0 B1 B2 B3 o. apply (border_told _ _ _ _ _ _ _ I0 I2 I3) in B0.
  apply (border_told _ _ _ _ _ _ _ I1 I2 I3) in B1. apply (border_told _ _ _ _ _ _ _ I2 I0 I1) in B2.
  apply (border_told _ _ _ _ _ _ _ I3 I0 I1) in B3.
  refine (query_time_right true m0 m1 m2 m3 a0 a1 b0 b1 o I0 I1 I2 I3 _).
  eapply (told_same double); [| unfold o; repeat eapply earlier_right; eassumption].
  intros t. unfold either, query_on_border, on_edges_border. tauto.
Qed.

End Kinds.

(** Doubles are such numbers; the search is that of TimeSearch.v, between_searches. *)
Theorem doubles_suffice : (forall n bits, (0 <= bits <= 40)%Z -> (0 <= n <= 2 ^ bits)%Z -> is_double (over n bits)) /\
  is_double 2 /\ forall t, exists b, holds_time is_double b t.
Proof.
  assert (D : forall n bits, (0 <= bits <= 40)%Z -> (0 <= n <= 2 ^ 41)%Z -> is_double (over n bits)).
  { intros n bits Hb Hn. apply generic_format_FLT. exists (Float radix2 n (- bits)); unfold F2R; cbn [Fnum Fexp]; [| | lia].
    - unfold over. now rewrite bpow_opp, <- (IZR_Zpower radix2 bits) by lia.
    - apply Z.le_lt_trans with (2 ^ 41)%Z; [lia | easy]. }
  split; [| split].
  - intros n bits Hb Hn. apply D; auto. pose proof (Z.pow_le_mono_r 2 bits 40 ltac:(lia) ltac:(lia)). lia.
  - replace 2 with (over 2 0) by (unfold over; simpl; field). apply D; lia.
  - intros t. now apply format_bracketed.
Qed.
