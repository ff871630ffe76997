(** The first contact of vertex and face, or of two edges, from brackets in integers of fixed width
    (ccd/contact/integer_first_contact.hpp, ccd/contact/interior_time.hpp), over the real numbers. It combines the
    borders' brackets with roots of Y that may be earlier. Results:
        earlier_right         the lesser of two bracketed first times is that of the first time of both
        considered_right      `consider`, over all relevant roots, in any order
        composed_right, composed_first   borders first, then interior contacts before that: the bracket of the first
            contact
        format_bracketed      every number has a bracket between numbers of a floating-point format *)

From Coq Require Import Reals ZArith Lra List.
From Flocq Require Import Core.
From Errbound Require Import Subdivision Contact Separation FirstContact TimeBrackets.
Import ListNotations.
Open Scope R_scope.

Section Doubles.

Variable double : R -> Prop.
Notation holds_time := (holds_time double).
(** There are finitely many doubles between two numbers, so each time has its bracket. *)
Hypothesis bracketed : forall t, 0 <= t <= 1 -> exists b, holds_time b t.

Lemma lesser_dec a b : {lesser a b} + {~ lesser a b}.
Proof.
  unfold lesser. destruct (Rlt_dec (fst a) (fst b)) as [L | L]; [left; now left |].
  destruct (Req_EM_T (fst a) (fst b)) as [E | E]; [| right; tauto].
  destruct (Rlt_dec (snd a) (snd b)) as [M | M]; [left; now right | right; tauto].
Qed.
Lemma not_lesser a b s t : holds_time a s -> holds_time b t -> s <= t -> ~ lesser b a.
Proof. intros A B L Q. pose proof (lesser_bracket double b a t s B A Q). lra. Qed.
Lemma same_bracket a b s t : holds_time a s -> holds_time b t -> s <= t -> ~ lesser a b -> a = b.
Proof.
  intros A B L N. destruct (lesser_total a b) as [| [| Q]]; auto; [easy |]. now apply (not_lesser a b s t) in Q.
Qed.

Lemma one_bracket a b t : holds_time a t -> holds_time b t -> a = b.
Proof.
  intros A B. destruct (lesser_total a b) as [L | [| L]]; auto; exfalso.
  - pose proof (lesser_bracket double a b t t A B L). lra.
  - pose proof (lesser_bracket double b a t t B A L). lra.
Qed.
(** After a number not below a bracket's low end, no time has a smaller bracket. *)
Lemma later_bracket a b s t r : holds_time a s -> ~ r < fst a -> r < t -> holds_time b t -> ~ lesser b a.
Proof.
  intros A N L B Q. pose proof (lesser_bracket double b a t s B A Q) as T.
  destruct A as [(_ & E & _) | (Nb & S)]; [lra |].
  assert (A' : holds_time a t) by (right; split; auto; lra).
  pose proof (lesser_bracket double b a t t B A' Q). lra.
Qed.

(** The result for the times at which H holds: none, or the bracket of the first. *)
Definition told (H : R -> Prop) (o : option bracket) : Prop :=
  match o with
  | None => forall t, 0 <= t <= 1 -> ~ H t
  | Some b => exists t, first H t /\ holds_time b t
  end.
Definition earlier (first found : option bracket) : option bracket :=
  match first, found with
  | Some a, Some b => if lesser_dec b a then Some b else Some a
  | None, o | o, None => o
  end.
Definition either (H G : R -> Prop) (t : R) : Prop := H t \/ G t.

Lemma first_either H G s t : first H s -> first G t -> s <= t -> first (either H G) s.
Proof.
  intros (S & Hs & Before) (T & _ & Before') L. split; auto. split; [now left |].
  intros r R0 [Hr | Gr]; [now apply (Before r) | apply (Before' r); auto; lra].
Qed.
Lemma first_swapped H G t : first (either G H) t -> first (either H G) t.
Proof.
  unfold either. intros (T & Q & B). split; auto. split; [tauto |]. intros s S C. apply (B s S). tauto.
Qed.
Lemma first_alone (H G : R -> Prop) t : first H t -> (forall s, 0 <= s <= 1 -> ~ G s) -> first (either H G) t.
Proof.
  intros (T & Ht & Before) No. split; auto. split; [now left |].
  intros s S [Hs | Gs]; [now apply (Before s) | apply (No s); auto; lra].
Qed.

Theorem earlier_right H G a b : told H a -> told G b -> told (either H G) (earlier a b).
Proof.
  destruct a as [a |], b as [b |]; unfold told, earlier.
  - intros (s & Hs & A) (t & Gt & B). destruct (Rle_or_lt s t) as [L | L].
    + assert (F : first (either H G) s) by now apply first_either with t.
      destruct (lesser_dec b a) as [Q |]; [now apply (not_lesser a b s t) in Q | now exists s].
    + assert (F : first (either H G) t) by (apply first_swapped, first_either with s; auto; lra).
      destruct (lesser_dec b a) as [Q | Q]; exists t; split; auto.
      rewrite <- (same_bracket b a t s); auto. lra.
  - intros (s & Hs & A) No. exists s. split; auto. now apply first_alone.
  - intros No (t & Gt & B). exists t. split; auto. now apply first_swapped, first_alone.
  - intros NoH NoG t T [Ht | Gt]; [now apply (NoH t) | now apply (NoG t)].
Qed.

(** ** Interior contacts before the border's *)

Variable inside : R -> Prop.  (** Y = 0 and all G > 0 *)

(** The result for interior contacts before `end`. *)
Definition told_before (last : bracket) (o : option bracket) : Prop :=
  match o with
  | None => forall r b, 0 <= r <= 1 -> inside r -> holds_time b r -> ~ lesser b last
  | Some a => lesser a last /\ (exists r, 0 <= r <= 1 /\ inside r /\ holds_time a r) /\
      forall r b, 0 <= r <= 1 -> inside r -> holds_time b r -> ~ lesser b a
  end.

(** first_, found_ and unplaced_ *)
Record state := State { first_found : bracket; found : outcome; unplaced : bool }.
Definition consider (s : state) (root : option bracket) (answer : outcome) : state :=
  match root with
  | Some b =>
      if lesser_dec b (first_found s)
      then match answer with separate => s | _ => State b answer (unplaced s) end
      else s
  | None => match answer with separate => s | _ => State (first_found s) (found s) true end
  end.
(** A root r of Y and facts about it; or all times after one that is not before the start of `first_`. *)
Inductive step := considered (r : R) (root : option bracket) (answer : outcome) | later_than (start : R).
Definition step_right (x : step) : Prop :=
  match x with
  | considered r root answer => 0 <= r <= 1 /\ (forall b, root = Some b -> holds_time b r) /\
      (answer = collides -> inside r) /\ (answer = separate -> ~ inside r)
  | later_than _ => True
  end.
Inductive run : state -> list step -> state -> Prop :=
  | no_step s : run s [] s
  | one_root s r root answer steps s' : run (consider s root answer) steps s' ->
      run s (considered r root answer :: steps) s'
  | rest_later s start steps s' : ~ start < fst (first_found s) -> run s steps s' ->
      run s (later_than start :: steps) s'.
Definition covers (steps : list step) (r : R) : Prop :=
  (exists root answer, In (considered r root answer) steps) \/ exists start, In (later_than start) steps /\ start < r.

Lemma lesser_trans a b c : lesser a b -> lesser b c -> lesser a c.
Proof. unfold lesser. intros [A | (A & A')] [B | (B & B')]; [left | left | left | right]; lra. Qed.
Definition at_most (a b : bracket) : Prop := a = b \/ lesser a b.
Lemma at_most_lesser a b c : at_most a b -> lesser c a -> lesser c b.
Proof. intros [-> | L] Q; auto. now apply lesser_trans with a. Qed.

Lemma consider_less s root answer : at_most (first_found (consider s root answer)) (first_found s).
Proof.
  unfold consider, at_most. destruct root as [b |]; [destruct (lesser_dec b (first_found s)) |];
    destruct answer; cbn [first_found]; auto.
Qed.
Lemma run_less s steps s' : run s steps s' -> at_most (first_found s') (first_found s).
Proof.
  intros Rn. induction Rn as [s | s r root answer steps s' Rn IH | s start steps s' N Rn IH]; [now left | | auto].
  pose proof (consider_less s root answer) as C. destruct IH as [-> | L]; auto. right. now apply at_most_lesser with (1 := C).
Qed.
Lemma run_unplaced s steps s' : run s steps s' -> unplaced s' = false -> unplaced s = false.
Proof.
  intros Rn. induction Rn as [s | s r root answer steps s' Rn IH | s start steps s' N Rn IH]; auto.
  intros U. apply IH in U. unfold consider in U.
  destruct root as [b |]; [destruct (lesser_dec b (first_found s)) |]; destruct answer; auto; discriminate.
Qed.
(** No contact that is covered has a smaller bracket than the final result. *)
Definition is_bracket (b : bracket) : Prop := exists t, holds_time b t.
Lemma consider_bracket s r root answer : is_bracket (first_found s) -> step_right (considered r root answer) ->
  is_bracket (first_found (consider s root answer)).
Proof.
  intros V (_ & Root & _). unfold consider. destruct root as [b |]; [destruct (lesser_dec b (first_found s)) |];
    destruct answer; auto; exists r; now apply Root.
Qed.
(** No contact that is covered has a smaller bracket than the final result. *)
Lemma run_covers s steps s' r b : run s steps s' -> is_bracket (first_found s) -> Forall step_right steps ->
  unplaced s' = false -> covers steps r -> inside r -> holds_time b r -> ~ lesser b (first_found s').
Proof.
  intros Rn. induction Rn as [s | s x root answer steps s' Rn IH | s start steps s' N Rn IH]; intros V F U C I B Q.
  - destruct C as [(root & answer & []) | (start & [] & _)].
  - inversion_clear F as [| ? ? Fx Fs]. pose proof (consider_bracket s x root answer V Fx) as V'.
    destruct Fx as (X & Root & Yes & No).
    pose proof (run_unplaced _ _ _ Rn U) as U0. pose proof (run_less _ _ _ Rn) as Less.
    destruct C as [(root' & answer' & [E | J]) | (start & [E | J] & L)]; try discriminate.
    2: { apply IH; auto. left. eauto. }
    2: { apply IH; auto. right. eauto. }
    injection E as -> -> ->. destruct root' as [a |].
    + pose proof (one_bracket a b r (Root a eq_refl) B) as ->.
      apply (at_most_lesser _ _ _ Less) in Q. unfold consider in Q.
      destruct (lesser_dec b (first_found s)) as [D | D]; [| easy].
      destruct answer'; cbn [first_found] in Q; [now apply No in I | |]; unfold lesser in Q; lra.
    + unfold consider in U0. destruct answer'; [now apply No in I | discriminate | discriminate].
  - inversion_clear F as [| ? ? _ Fs].
    destruct C as [(root & answer & [E | J]) | (t & [E | J] & L)]; try discriminate.
    + apply IH; auto. left. eauto.
    + injection E as ->. apply (at_most_lesser _ _ _ (run_less _ _ _ Rn)) in Q.
      destruct V as (w & W). now apply (later_bracket (first_found s) b w r t).
    + apply IH; auto. right. eauto.
Qed.
Lemma run_found last s steps s' : run s steps s' -> Forall step_right steps ->
  (found s = separate -> first_found s = last) ->
  (found s = collides -> lesser (first_found s) last /\
    exists r, 0 <= r <= 1 /\ inside r /\ holds_time (first_found s) r) ->
  at_most (first_found s) last ->
  (found s' = separate -> first_found s' = last) /\
  (found s' = collides -> lesser (first_found s') last /\
    exists r, 0 <= r <= 1 /\ inside r /\ holds_time (first_found s') r).
Proof.
  intros Rn. induction Rn as [s | s x root answer steps s' Rn IH | s start steps s' N Rn IH]; intros F A B C.
  - now split.
  - inversion_clear F as [| ? ? Fx Fs]. destruct Fx as (X & Root & Yes & _). apply IH; auto.
    + unfold consider. destruct root as [b |]; [destruct (lesser_dec b (first_found s)) |]; destruct answer; auto;
        discriminate.
    + unfold consider. destruct root as [b |]; [destruct (lesser_dec b (first_found s)) as [L |] |];
        destruct answer; auto; try discriminate. cbn [found first_found]. intros _.
      split; [now apply (at_most_lesser _ _ _ C) |]. exists x. auto.
    + pose proof (consider_less s root answer) as L. destruct L as [-> | L]; auto. right.
      now apply (at_most_lesser _ _ _ C).
  - inversion_clear F. now apply IH.
Qed.

Theorem considered_right last steps s : is_bracket last -> run (State last separate false) steps s ->
  Forall step_right steps -> (forall r, 0 <= r <= 1 -> inside r -> covers steps r) -> unplaced s = false ->
  match found s with
  | separate => told_before last None
  | collides => told_before last (Some (first_found s))
  | undecided => True
  end.
Proof.
  intros V Rn F C U. pose proof (fun r b => run_covers _ _ _ r b Rn V F U) as Cover.
  destruct (run_found last _ _ _ Rn F) as (A & B); cbn [found first_found]; try easy; [now left |].
  destruct (found s); cbn [told_before]; auto.
  - intros r b R0 I H. rewrite <- (A eq_refl). apply (Cover r b); auto.
  - destruct (B eq_refl) as (L & r & R0 & I & H). split; auto. split; [eauto |]. intros q b Q J K. apply (Cover q b); auto.
Qed.

(** ** Both *)

Variable border : R -> Prop.
Definition never : bracket := (2, 2).
Definition last_of (o : option bracket) : bracket := match o with Some b => b | None => never end.
Definition composed (on_border before : option bracket) : option bracket :=
  match before with Some b => Some b | None => on_border end.

Theorem composed_right o i :
  (sometime (either inside border) -> exists t, first (either inside border) t) ->
  told border o -> told_before (last_of o) i -> told (either inside border) (composed o i).
Proof.
  intros Exists_ Border Inside.
  assert (NotLate : forall r b, 0 <= r <= 1 -> holds_time b r -> lesser b never).
  { intros r b R0 [(_ & E & _) | (_ & S)]; left; unfold never; cbn [fst]; lra. }
  destruct i as [a |]; cbn [composed told_before] in *.
  - destruct Inside as (L & (r & R0 & I & A) & Least).
    destruct Exists_ as (t & F); [exists r; split; auto; now left |]. exists t. split; auto.
    pose proof F as (T & [It | Bt] & Before).
    + destruct (bracketed t T) as (b & B).
      assert (T0 : t <= r) by (apply Rnot_lt_le; intros Q; apply (Before r); [lra | now left]).
      rewrite <- (same_bracket b a t r); auto. now apply (Least t b).
    + destruct (bracketed t T) as (b & B).
      assert (T0 : t <= r) by (apply Rnot_lt_le; intros Q; apply (Before r); [lra | now left]).
      destruct o as [e |]; cbn [told last_of] in *.
      * destruct Border as (u & Fu & E). pose proof (lesser_bracket double a e r u A E L) as Ru.
        destruct Fu as (U & _ & Bu). exfalso. apply (Bu t); [lra | easy].
      * now apply Border in Bt.
  - destruct o as [e |]; cbn [told last_of] in *.
    + destruct Border as (u & Fu & E). pose proof Fu as (U & Bu & NoB).
      destruct Exists_ as (t & F); [exists u; split; auto; now right |]. exists t. split; auto.
      pose proof F as (T & [It | Bt] & Before).
      * assert (T0 : t <= u) by (apply Rnot_lt_le; intros Q; apply (Before u); [lra | now right]).
        destruct (bracketed t T) as (b & B). rewrite <- (same_bracket b e t u); auto. now apply (Inside t b).
      * assert (t = u) as ->; [| easy].
        destruct (Rtotal_order t u) as [Q | [| Q]]; auto; exfalso; [apply (NoB t) | apply (Before u)]; auto; try lra.
        now right.
    + intros t T [It | Bt]; [| now apply (Border t)]. destruct (bracketed t T) as (b & B).
      apply (Inside t b T It B). now apply (NotLate t).
Qed.

(** If Y = 0 throughout, interior contact is tested only at the ends: `inside` need not be all of the contact. *)
Theorem composed_first (touches : R -> Prop) o i : (forall t, either inside border t -> touches t) ->
  (sometime touches -> exists t, first touches t /\ either inside border t) ->
  told border o -> told_before (last_of o) i -> told touches (composed o i).
Proof.
  intros Touch Exists_ Border Inside.
  assert (First : forall t, first touches t -> either inside border t -> first (either inside border) t).
  { intros t (T & _ & Before) E. split; auto. split; auto. intros s S H. apply (Before s S). now apply Touch. }
  assert (To : told (either inside border) (composed o i)).
  { apply composed_right; auto. intros (t & T & H). destruct Exists_ as (s & F & E); [exists t; auto |]. eauto. }
  destruct (composed o i) as [b |]; cbn [told] in *.
  - destruct To as (t & (T & H & Before) & B). exists t. split; auto.
    destruct Exists_ as (s & F & E); [exists t; auto |]. pose proof F as (S & _ & Before').
    destruct (Rtotal_order s t) as [L | [<- | L]]; auto; exfalso; [apply (Before s); auto; lra |].
    apply (Before' t); [lra | auto].
  - intros t T H. destruct Exists_ as (s & (S & _) & E); [exists t; auto |]. now apply (To s).
Qed.

Lemma told_same (H G : R -> Prop) o : (forall t, H t <-> G t) -> told H o -> told G o.
Proof.
  intros E. destruct o as [b |]; unfold told.
  - intros (t & (T & Ht & Before) & B). exists t. split; auto. split; auto. split; [now apply E |].
    intros s S Gs. apply (Before s S). now apply E.
  - intros No t T Gt. apply (No t T). now apply E.
Qed.

End Doubles.

(** Doubles are a format in which every number has a bracket. *)
Theorem format_bracketed emin p t : (0 < p)%Z ->
  exists b, holds_time (generic_format radix2 (FLT_exp emin p)) b t.
Proof.
  intros P. assert (Valid : Valid_exp (FLT_exp emin p)) by now apply FLT_exp_valid.
  set (F := generic_format radix2 (FLT_exp emin p)).
  destruct (Classical_Prop.classic (F t)) as [Ft | N]; [exists (t, t); left; auto |].
  destruct (round_DN_pt radix2 (FLT_exp emin p) t) as (D & Dt & Down).
  destruct (round_UP_pt radix2 (FLT_exp emin p) t) as (U & Ut & Up).
  set (d := round radix2 (FLT_exp emin p) Zfloor t) in *. set (u := round radix2 (FLT_exp emin p) Zceil t) in *.
  assert (d <> t) by (intros E; apply N; rewrite <- E; exact D).
  assert (u <> t) by (intros E; apply N; rewrite <- E; exact U).
  exists (d, u). right. cbn [fst snd]. split; [| lra]. split; [exact D |]. split; [exact U |]. split; [lra |].
  intros x Fx X. destruct (Rle_or_lt x t) as [L | L]; [specialize (Down x Fx L) | specialize (Up x Fx ltac:(lra))]; lra.
Qed.
