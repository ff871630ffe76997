(** `bsc-exact` (ccd/methods/bsc_exact.cpp): Bernstein sign classification over a scalar whose signs are never
    uncertain (integers), and the contacts that decide its "maybe". Results, for a cubic Y and quartics G as in
    Bsc.v:
        bsc_exact_root     the answer "maybe_root": Y = 0 at every t
        bsc_exact_inside   the answer "maybe_inside": at some root of Y in [0, 1] no G is negative and one is zero,
                           and at none are all positive
        bsc_exact_face, bsc_exact_edges   bsc_exact.cpp returns `collides` exactly if the features do, given
                           doubles, common_factor and real_roots as in UnboundedIntegers.v *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Errbound Require Import RootIsolation Sign Bernstein Bsc Contact Decisions AxisUnits UnboundedIntegers.
Import ListNotations.
Open Scope R_scope.

Section Exact.

Context {S : scalar} (Exact : forall x : S, sign_of x <> uncertain).
Notation exacts := (map (@exact S)).
Notation "p '#' i" := (nth i p (whole 0)) (at level 20).
Notation form_at := (@at_time S).
Notation dy y := (derivative y).
Notation ddy y := (derivative (derivative y)).
Notation five gs := (Forall (fun g : list S => length g = 5%nat) gs).
Implicit Types (y g l d j : list S) (gs : list (list S)).

(** ** Signs *)

Lemma sign_tells (x : S) : tells (sign_of x) (exact x).
Proof. split; [apply Exact | apply sign_right]. Qed.
Lemma always_certain (x : S) : certain (sign_of x) = true.
Proof. pose proof (Exact x). now destruct (sign_of x). Qed.

Lemma inside_certain l : inside l <> uncertain.
Proof.
  unfold inside. pose proof (Exact (l#0)). pose proof (Exact (l#1)).
  now destruct (sign_of (l#0)), (sign_of (l#1)).
Qed.
Lemma at_root_certain l p : sign_at_root_of l p <> uncertain.
Proof. unfold sign_at_root_of. destruct (linear_root l). apply Exact. Qed.
Lemma at_crossing_certain y before l : linear_at_crossing y before l <> uncertain.
Proof.
  unfold linear_at_crossing. destruct (negb (opposite l)); [apply inside_certain |].
  pose proof (at_root_certain l y). destruct (sign_at_root_of l y); try easy;
    destruct (same_sign _ before); apply Exact.
Qed.
Lemma at_extremum_certain d form : linear_at_extremum d form <> uncertain.
Proof.
  unfold linear_at_extremum. destruct (negb _); [apply inside_certain |].
  pose proof (at_root_certain (normalized form) d).
  destruct (sign_at_root_of _ d); try easy; apply Exact.
Qed.
Lemma extremum_certain y d : certain (sign_at_extremum y d) = true.
Proof.
  unfold sign_at_extremum. set (f := linear_at_extremum d _).
  destruct (certain (negate f)) eqn:E; auto.
  assert (f <> uncertain) by apply at_extremum_certain. now destruct f.
Qed.

(** If Y has a root and no positive value at the extremum, no sign at a pair is uncertain. *)
Lemma at_pair_certain y d l r : length l = 2%nat -> y <> [] -> d <> [] ->
  convex (form_at y) (form_at d) -> 0 < r < 1 -> form_at y r = 0 ->
  fst (linear_at_pair y d l) <> uncertain /\ snd (linear_at_pair y d l) <> uncertain.
Proof.
  intros L Ny Nd (T & _) I Z. unfold linear_at_pair.
  destruct (opposite l) eqn:O; simpl; [| split; apply inside_certain].
  destruct (opposite_root l L O) as (x & X & _ & _ & _ & Sign & _).
  pose proof (Sign y Ny) as Sy. pose proof (Sign d Nd) as Sd.
  pose proof (at_root_certain l y). pose proof (at_root_certain l d).
  pose proof (Exact (l#0)). pose proof (Exact (l#1)).
  destruct (sign_at_root_of l y), (sign_at_root_of l d); simpl; try easy; exfalso; simpl in *.
  assert (N : x <> r) by (intros ->; lra). specialize (T x r ltac:(lra) ltac:(lra) N).
  rewrite Sd, Z in T. lra.
Qed.

Lemma zero_form l : length l = 2%nat -> opposite l = false -> inside l = zero ->
  Forall (eq 0) (exacts l).
Proof. intros L O E. pose proof (inside_signs l L O) as H. now rewrite E in H. Qed.
Lemma normalized_zero (p : list S) : Forall (eq 0) (exacts (normalized p)) -> Forall (eq 0) (exacts p).
Proof.
  destruct (normalized_right S p) as (c & C & ->). rewrite !Forall_map. apply Forall_impl. intros a H.
  symmetry in H. apply Rmult_integral in H. lra.
Qed.

(** M does not vanish at a root at which J is evaluated, unless coefficients give J a certain sign. *)
Lemma combined_tells y j r m s : length y = 4%nat -> length j = 3%nat -> form_at y r = 0 -> 0 < r < 1 ->
  exact (y#0) * exact (y#3) <> 0 -> certain (sign_inside j) = false ->
  tells m (form_at (decomposition_m y j) r) -> tells s (form_at (decomposition_r y j) r) ->
  tells (combined m s (decomposition_m y j) j) (form_at j r).
Proof.
  intros Ly Lj Z I N J (Cm & M) (Cs & Rs).
  destruct (combined_right y j r m s Ly Lj Z I M Rs) as (_ & R). split; auto. unfold combined.
  destruct (same_sign m zero) eqn:Q; simpl; [| now destruct m, s].
  destruct (opposite (decomposition_m y j)) eqn:O; simpl; [apply at_root_certain |]. intros _.
  assert (m = zero) by now destruct m. subst m. simpl in M.
  assert (Lm : length (decomposition_m y j) = 2%nat) by (unfold decomposition_m; now rewrite
    length_normalized).
  pose proof (inside_right _ r Lm O I) as E. pose proof (inside_certain (decomposition_m y j)) as C.
  assert (E0 : inside (decomposition_m y j) = zero).
  { destruct (inside (decomposition_m y j)); try easy; simpl in E; lra. }
  pose proof (normalized_zero _ (zero_form _ Lm O E0)) as F. clear - Exact F N J Ly Lj.
  destruct (length_3 j Lj) as (a & b & c & ->). simpl in F. rewrite !exact_mul in F.
  inversion_clear F as [| ? ? F0 F']. inversion_clear F' as [| ? ? F1 _].
  assert (exact (y#0) <> 0) by (intros H; apply N; rewrite H; ring).
  assert (exact (y#3) <> 0) by (intros H0; apply N; rewrite H0; ring).
  symmetry in F0, F1. apply Rmult_integral in F0, F1. destruct F0 as [| F0], F1 as [| F1]; try easy.
  unfold sign_inside in J. cbn [sign_inside_from] in J.
  pose proof (sign_tells a) as (Ca & Ra). pose proof (sign_tells b) as (Cb & _).
  pose proof (sign_tells c) as (Cc & Rc).
  destruct (sign_of a), (sign_of c), (sign_of b); simpl in *; try easy; lra.
Qed.

(** The sign of G from the sign of J. *)
Lemma reduced_tells y g r s : length y = 4%nat -> length g = 5%nat -> form_at y r = 0 -> 0 < r < 1 ->
  tells s (form_at (reduced y g) r) ->
  (exact (y#0) * exact (y#3) < 0 -> tells (negate s) (form_at g r)) /\
  (0 < exact (y#0) * exact (y#3) -> tells s (form_at g r)).
Proof.
  intros Ly Lg Z I (C & T). destruct (reduction y g r Ly Lg Z) as (c & Pc & E).
  assert (P : 0 < (1 - r) * r) by nra. destruct (signs_of_end_values _ _ _ _ _ _ Pc P E) as (A & B & D).
  split; intros K; (split; [destruct s; easy |]); [specialize (A ltac:(lra)) | specialize (B K)];
    specialize (D ltac:(lra)); destruct s; simpl in *; tauto.
Qed.

Lemma hull_tells (p : list S) t : 0 < t < 1 -> certain (sign_inside p) = true ->
  tells (sign_inside p) (form_at p t).
Proof. intros T C. split; [now destruct (sign_inside p) | now apply sign_inside_right]. Qed.
Lemma length_parts y j : length (decomposition_m y j) = 2%nat /\ length (decomposition_r y j) = 2%nat.
Proof. unfold decomposition_m, decomposition_r. now rewrite !length_normalized. Qed.

Lemma at_crossing_tells y before g r : length y = 4%nat -> length g = 5%nat ->
  before = negative \/ before = positive -> crossing (form_at y) (unit before) r ->
  exact (y#0) * exact (y#3) < 0 -> tells (quartic_at_crossing y before g) (form_at g r).
Proof.
  intros Ly Lg B C K. pose proof C as (I & Z & _). unfold quartic_at_crossing.
  destruct (certain (sign_inside g)) eqn:Cg; [now apply hull_tells |].
  assert (Ny : y <> []) by now destruct y. destruct (length_parts y (reduced y g)) as (Lm & Lr).
  destruct (certain (sign_inside (reduced y g))) eqn:Cj;
    refine (proj1 (reduced_tells y g r _ Ly Lg Z I _) K); [now apply hull_tells |].
  apply combined_tells; auto using length_reduced; [lra | |]; split; auto using at_crossing_certain;
    now apply sign_determination_1.
Qed.

Lemma at_pair_tells y d g r : length y = 4%nat -> d <> [] -> length g = 5%nat ->
  convex (form_at y) (form_at d) -> 0 < r < 1 -> form_at y r = 0 -> 0 < exact (y#0) * exact (y#3) ->
  (form_at d r <= 0 -> tells (fst (quartic_at_pair y d g)) (form_at g r)) /\
  (0 <= form_at d r -> tells (snd (quartic_at_pair y d g)) (form_at g r)).
Proof.
  intros Ly Nd Lg C I Z K. unfold quartic_at_pair.
  destruct (certain (sign_inside g)) eqn:Cg; [split; intros _; now apply hull_tells |].
  assert (Ny : y <> []) by now destruct y. destruct (length_parts y (reduced y g)) as (Lm & Lr).
  destruct (certain (sign_inside (reduced y g))) eqn:Cj.
  - split; intros _; refine (proj2 (reduced_tells y g r _ Ly Lg Z I _) K); now apply hull_tells.
  - destruct (sign_determination_2 y d _ r Lm Ny Nd C I Z) as (M0 & M1).
    destruct (sign_determination_2 y d _ r Lr Ny Nd C I Z) as (R0 & R1).
    destruct (at_pair_certain y d _ r Lm Ny Nd C I Z).
    destruct (at_pair_certain y d _ r Lr Ny Nd C I Z).
    split; intros D; refine (proj2 (reduced_tells y g r _ Ly Lg Z I _) K); apply combined_tells; auto
      using length_reduced; try lra;
      split; auto.
Qed.

(** ** Answers *)

Definition touching gs (t : R) : Prop :=
  Forall (fun g => 0 <= form_at g t) gs /\ Exists (fun g => form_at g t = 0) gs.

(** The meaning of an answer for the roots of Y that were tested. *)
Definition answers (e : existence) (root : R -> Prop) gs : Prop :=
  match e with
  | no => forall t, root t -> excluded gs t
  | yes => exists t, root t /\ all_positive gs t
  | maybe_inside => (exists t, root t /\ touching gs t) /\ forall t, root t -> ~ all_positive gs t
  | maybe_root => False
  end.

Lemma excluded_not_positive gs t : excluded gs t -> ~ all_positive gs t.
Proof.
  intros E P. apply Exists_exists in E. destruct E as (g & I & N). unfold all_positive in P.
  rewrite Forall_forall in P. specialize (P g I). lra.
Qed.

Lemma answers_same e (P Q : R -> Prop) gs : (forall t, P t <-> Q t) -> answers e P gs -> answers e Q gs.
Proof.
  intros H. destruct e; simpl; auto.
  - intros A t T. now apply A, H.
  - intros (t & T & A). exists t. split; auto. now apply H.
  - intros ((t & T & A) & B). split; [exists t; split; auto; now apply H |]. intros u U. now apply B, H.
Qed.
Lemma answers_no (P : R -> Prop) gs : (forall t, ~ P t) -> answers no P gs.
Proof. intros N t T. now destruct (N t). Qed.
Lemma answers_either a b (P Q R : R -> Prop) gs : (forall t, R t <-> P t \/ Q t) ->
  answers a P gs -> answers b Q gs -> answers (either a b) R gs.
Proof.
  intros H A B. apply (answers_same _ (fun t => P t \/ Q t)); [intros t; now rewrite H |]. clear H R.
  pose proof excluded_not_positive.
  destruct a, b; simpl in *; try easy; try (destruct A as (t & T & A); exists t; auto; fail);
    try (destruct B as (t & T & B); exists t; auto; fail).
  - intros t [T | T]; auto.
  - destruct B as ((t & T & B) & N). split; [exists t; auto |]. intros u [U | U]; auto.
  - destruct A as ((t & T & A) & N). split; [exists t; auto |]. intros u [U | U]; auto.
  - destruct A as ((t & T & A) & N). split; [exists t; auto |]. destruct B as (_ & B).
    intros u [U | U]; auto.
Qed.

Lemma verdict_answers gs t (f : list S -> sign) : Forall (fun g => tells (f g) (form_at g t)) gs ->
  answers (verdict true (map f gs)) (eq t) gs.
Proof.
  intros T. assert (N : Forall (fun g => not_wrong (f g) (form_at g t)) gs)
    by (eapply Forall_impl; [| exact T]; intros g (_ & G); now apply right_not_wrong).
  destruct (verdict_right true gs t f N) as (No & Yes). rewrite Forall_forall in T.
  unfold verdict in *. cbn [negb] in *.
  destruct (existsb (same_sign negative) (map f gs)) eqn:E; [intros u <-; auto |].
  destruct (forallb (same_sign positive) (map f gs)) eqn:A; [exists t; auto |].
  assert (M : forall g, In g gs -> 0 <= form_at g t).
  { intros g I. destruct (T g I) as (C & R). destruct (f g) eqn:F; simpl in R; try easy; try lra.
    assert (X : existsb (same_sign negative) (map f gs) = true)
      by (apply existsb_exists; exists negative; split; auto; rewrite <- F; now apply in_map).
        congruence. }
  assert (P : ~ all_positive gs t).
  { intros P. unfold all_positive in P. rewrite Forall_forall in P.
    assert (X : forallb (same_sign positive) (map f gs) = true).
    { apply forallb_forall. intros s I. apply in_map_iff in I. destruct I as (g & <- & I).
      specialize (P g I). destruct (T g I) as (C & R). destruct (f g); simpl in *; try easy; lra. }
    congruence. }
  split; [| now intros u <-]. exists t. split; auto. split; [now apply Forall_forall |].
  apply Exists_Forall_neg in P; [| intros g; destruct (Rlt_dec 0 (form_at g t)); auto].
  apply Exists_exists in P. destruct P as (g & I & P). apply Exists_exists. exists g. split; auto.
  specialize (M g I). lra.
Qed.

(** Roots of Y in [0, 1], and interior ones. *)
Definition roots y (t : R) : Prop := 0 <= t <= 1 /\ form_at y t = 0.
Definition inner y (t : R) : Prop := 0 < t < 1 /\ form_at y t = 0.

Lemma at_end_answers y gs k t : five gs -> (k = 0%nat /\ t = 0 \/ k = 4%nat /\ t = 1) ->
  forall x : S, exact x = form_at y t ->
  answers (at_end (sign_of x) gs k) (fun u => t = u /\ form_at y t = 0) gs.
Proof.
  intros F K x E. unfold at_end. destruct (sign_tells x) as (C & X). rewrite E in X.
  destruct (sign_of x); simpl in X; try easy; try (apply answers_no; intros u (_ & Z); lra).
  apply (answers_same _ (eq t)); [intuition |]. apply verdict_answers.
  eapply Forall_impl; [| exact F]. simpl. intros g Lg.
  replace (form_at g t) with (exact (g#k)); [apply sign_tells |].
  destruct K as [(-> & ->) | (-> & ->)]; symmetry; [apply at_start; now destruct g | now apply
    at_finish].
Qed.

Lemma ends_answer y gs : length y = 4%nat -> five gs ->
  answers (either (at_end (sign_of (y#0)) gs 0) (at_end (sign_of (y#3)) gs 4))
    (fun t => (t = 0 \/ t = 1) /\ form_at y t = 0) gs.
Proof.
  intros L F. assert (N : y <> []) by now destruct y.
  apply (answers_either _ _ (fun t => 0 = t /\ form_at y 0 = 0) (fun t => 1 = t /\ form_at y 1 = 0)).
  - intros t. split; [intros ([-> | ->] & Z); auto | intros [(<- & Z) | (<- & Z)]; auto].
  - apply at_end_answers; auto. symmetry. now apply at_start.
  - apply at_end_answers; auto. symmetry. now apply at_finish.
Qed.
Lemma with_inner y gs e f : answers e (fun t => (t = 0 \/ t = 1) /\ form_at y t = 0) gs ->
  answers f (inner y) gs -> answers (either e f) (roots y) gs.
Proof.
  intros E F. eapply answers_either; [| exact E | exact F]. intros t. unfold roots, inner. split.
  - intros (T & Z). destruct (Req_dec t 0); auto. destruct (Req_dec t 1); auto. right. split; auto. lra.
  - intros [([-> | ->] & Z) | (T & Z)]; split; auto; lra.
Qed.
Lemma without_inner y gs e : answers e (fun t => (t = 0 \/ t = 1) /\ form_at y t = 0) gs ->
  (forall t, ~ inner y t) -> answers e (roots y) gs.
Proof.
  intros E N. replace e with (either e no) by now destruct e. apply with_inner; auto.
  now apply answers_no.
Qed.

Lemma at_crossing_answers y before gs r : length y = 4%nat -> five gs ->
  before = negative \/ before = positive -> crossing (form_at y) (unit before) r ->
  exact (y#0) * exact (y#3) < 0 -> answers (at_crossing y before true gs) (eq r) gs.
Proof.
  intros L F B C K. apply verdict_answers. eapply Forall_impl; [| exact F]. simpl. intros g Lg.
  now apply at_crossing_tells.
Qed.
Lemma crossing_inner y before r : before = negative \/ before = positive ->
  crossing (form_at y) (unit before) r -> forall t, inner y t <-> r = t.
Proof.
  intros B (I & Z & Before & After & _) t. split; [| now intros <-]. intros (T & Zt).
  destruct (Rtotal_order t r) as [H | [H | H]]; auto;
    [specialize (Before t ltac:(lra)) | specialize (After t ltac:(lra))]; rewrite Zt in *; lra.
Qed.

Lemma at_ends y : length y = 4%nat -> form_at y 0 = exact (y#0) /\ form_at y 1 = exact (y#3).
Proof. intros L. split; [apply at_start; now destruct y | now apply at_finish]. Qed.

Lemma on_increasing_answers y gs : length y = 4%nat -> five gs ->
  (forall a b, 0 <= a -> a < b -> b <= 1 -> form_at y a < form_at y b) ->
  answers (on_increasing y gs) (roots y) gs.
Proof.
  intros L F M. destruct (at_ends y L) as (E0 & E3). pose proof (ends_answer y gs L F) as Ends.
  unfold on_increasing. rewrite !always_certain. cbn [andb].
  destruct (sign_tells (y#0)) as (C0 & S0). destruct (sign_tells (y#3)) as (C3 & S3).
  rewrite <- E0 in S0. rewrite <- E3 in S3.
  assert (None : 0 <= form_at y 0 \/ form_at y 1 <= 0 -> forall t, ~ inner y t).
  { intros N t (T & Z). pose proof (M 0 t). pose proof (M t 1). lra. }
  destruct (possibly_negative (sign_of (y#0)) && possibly_positive (sign_of (y#3))) eqn:B.
  - apply with_inner; auto. clear Ends.
    assert (N0 : form_at y 0 < 0) by (destruct (sign_of (y#0)); easy).
    assert (N3 : 0 < form_at y 1) by (destruct (sign_of (y#0)), (sign_of (y#3)); easy).
    destruct (strict_root y) as (r & I & Z); [nra |].
    assert (K : crossing (form_at y) (unit negative) r).
    { repeat split; simpl; try tauto; try lra; intros t T; [pose proof (M t r) | pose proof (M r t)];
      lra. }
    apply (answers_same _ (eq r)); [intros t; symmetry; apply (crossing_inner y negative); auto |].
    apply at_crossing_answers; auto. rewrite <- E0, <- E3. nra.
  - apply without_inner; auto. apply None.
    destruct (sign_of (y#0)), (sign_of (y#3)); simpl in *; try easy; lra.
Qed.


Lemma at_pair_answers y d gs : length y = 4%nat -> length d = 3%nat -> exacts d = exacts (dy y) ->
  five gs -> convex (form_at y) (form_at d) -> 0 < exact (y#0) -> 0 < exact (y#3) ->
  answers (at_pair y d true gs) (inner y) gs.
Proof.
  intros L Ld Ed F C Y0 Y3. pose proof C as (T & M). destruct (at_ends y L) as (E0 & E3).
  assert (Nd : d <> []) by now destruct d.
  pose proof (at_start d Nd) as D0. pose proof (at_finish d 2 Ld) as D2.
  unfold at_pair. rewrite !always_certain, extremum_certain. cbn [andb].
  destruct (sign_tells (d#0)) as (C0 & S0). destruct (sign_tells (d#2)) as (C2 & S2).
  rewrite <- D0 in S0. rewrite <- D2 in S2.
  destruct (certainly_nonnegative (sign_of (d#0)) || certainly_nonpositive (sign_of (d#2))) eqn:Q.
  { apply answers_no. intros t (I & Z).
    pose proof (T 0 t ltac:(lra) ltac:(lra) ltac:(lra)).
    pose proof (T 1 t ltac:(lra) ltac:(lra) ltac:(lra)).
    assert (form_at d 0 < 0) by nra. assert (0 < form_at d 1) by nra.
    destruct (sign_of (d#0)), (sign_of (d#2)); simpl in *; easy || lra. }
  assert (N0 : form_at d 0 < 0) by (destruct (sign_of (d#0)); easy).
  assert (N2 : 0 < form_at d 1) by (destruct (sign_of (d#0)), (sign_of (d#2)); easy).
  clear C0 S0 C2 S2 Q D0 D2. destruct (strict_root d) as (x & X & Zx); [nra |].
  pose proof (root_finding y d x L Ld Ed X Zx M) as Low. pose proof (extremum_certain y d) as Cl.
  assert (Above : forall t, 0 <= t <= 1 -> form_at y x <= form_at y t).
  { intros t I. destruct (Req_dec x t) as [-> | N]; [lra |]. specialize (T x t ltac:(lra) I N).
    rewrite Zx in T. lra. }
  destruct (same_sign (sign_at_extremum y d) positive) eqn:P.
  { apply answers_no. intros t (I & Z). specialize (Above t ltac:(lra)).
    destruct (sign_at_extremum y d); try easy. simpl in Low. lra. }
  assert (Yx : form_at y x <= 0) by (destruct (sign_at_extremum y d); simpl in *; easy || lra).
  assert (Side : forall u v, 0 <= u <= 1 -> 0 <= v <= 1 -> u <= v -> form_at d u <= form_at d v).
  { intros u v U V [W | ->]; [left; now apply M | lra]. }
  destruct (between y 0 x) as (a & A & Za); [lra | nra |].
  destruct (between y x 1) as (b & B & Zb); [lra | nra |].
  assert (a <> 0) by (intros ->; lra). assert (b <> 1) by (intros ->; lra).
  assert (K : 0 < exact (y#0) * exact (y#3)) by nra.
  pose proof (Side a x ltac:(lra) ltac:(lra) ltac:(lra)) as Da.
  pose proof (Side x b ltac:(lra) ltac:(lra) ltac:(lra)) as Db. rewrite Zx in Da, Db.
  assert (Left : forall u v, 0 <= u < v -> v <= x -> form_at y u = 0 -> form_at y v <> 0).
  { intros u v U V Zu Zv. specialize (T v u ltac:(lra) ltac:(lra) ltac:(lra)).
    pose proof (Side v x ltac:(lra) ltac:(lra) V). nra. }
  assert (Right : forall u v, x <= u < v -> v <= 1 -> form_at y u = 0 -> form_at y v <> 0).
  { intros u v U V Zu Zv. specialize (T u v ltac:(lra) ltac:(lra) ltac:(lra)).
    pose proof (Side x u ltac:(lra) ltac:(lra) ltac:(lra)). nra. }
  apply (answers_either _ _ (eq a) (eq b)).
  - intros t. split; [| intros [<- | <-]; split; auto; lra]. intros (I & Z).
    destruct (Rle_or_lt t x) as [W | W].
    + left. destruct (Rtotal_order a t) as [G | [G | G]]; auto; exfalso; [now apply (Left a t) | apply
      (Left t a); lra].
    + right. destruct (Rtotal_order b t) as [G | [G | G]]; auto; exfalso; [apply (Right b t); lra |
      apply (Right t b); lra].
  - apply verdict_answers. eapply Forall_impl; [| exact F]. simpl. intros g Lg.
    apply (at_pair_tells y d g a); auto; lra.
  - apply verdict_answers. eapply Forall_impl; [| exact F]. simpl. intros g Lg.
    apply (at_pair_tells y d g b); auto; lra.
Qed.

Lemma on_convex_answers y d gs : length y = 4%nat -> length d = 3%nat -> exacts d = exacts (dy y) ->
  five gs -> convex (form_at y) (form_at d) -> answers (on_convex y d gs) (roots y) gs.
Proof.
  intros L Ld Ed F C. destruct (at_ends y L) as (E0 & E3). pose proof (ends_answer y gs L F) as Ends.
  pose proof (at_pair_answers y d gs L Ld Ed F C) as Pair.
  assert (D0 : form_at d 0 = exact (y#1) - 3 * exact (y#0))
    by (rewrite (at_time_by d (dy y) 0 Ed); clear -L; four y L; values; ring).
  assert (D1 : form_at d 1 = 3 * exact (y#3) - exact (y#2))
    by (rewrite (at_time_by d (dy y) 1 Ed); clear -L; four y L; values; ring).
  assert (Rise : form_at y 0 < 0 -> 0 < form_at y 1 -> answers (at_crossing y negative true gs) (inner
    y) gs).
  { intros Y0 Y1. destruct (strict_root y) as (r & I & Z); [nra |].
    destruct (rising_crossing _ _ r C I Z ltac:(lra)) as (K & _).
    apply (answers_same _ (eq r)); [intros t; symmetry; apply (crossing_inner y negative); auto |].
    apply at_crossing_answers; auto. rewrite <- E0, <- E3. nra. }
  assert (Fall : 0 < form_at y 0 -> form_at y 1 < 0 -> answers (at_crossing y positive true gs) (inner
    y) gs).
  { intros Y0 Y1. destruct (strict_root y) as (r & I & Z); [nra |].
    destruct (falling_crossing _ _ r C I Z ltac:(lra)) as (K & _).
    apply (answers_same _ (eq r)); [intros t; symmetry; apply (crossing_inner y positive); auto |].
    apply at_crossing_answers; auto. rewrite <- E0, <- E3. nra. }
  assert (Start : form_at y 0 = 0 -> exact (y#1) < 0 -> 0 < form_at y 1 ->
    answers (at_crossing (elevated [y#1; y#2; y#3]) negative true gs) (inner y) gs).
  { intros Y0 Y1 Y3. set (e := elevated [y#1; y#2; y#3]). destruct (at_ends e eq_refl) as (A & B).
    simpl in A, B. destruct (strict_root e) as (r & I & Z); [rewrite A, B; nra |].
    assert (Zy : form_at y r = 0) by (rewrite <- (without_start y r L Y0); fold e; rewrite Z; ring).
    destruct (rising_crossing _ _ r C I Zy ltac:(lra)) as (K & _).
    destruct (crossing_without_start y _ r L C D0 Y0 K) as (_ & Ke).
    apply (answers_same _ (eq r)); [intros t; symmetry; apply (crossing_inner y negative); auto |].
    apply at_crossing_answers; auto. simpl. rewrite <- E3. nra. }
  assert (Finish : 0 < form_at y 0 -> form_at y 1 = 0 -> exact (y#2) < 0 ->
    answers (at_crossing (elevated [y#0; y#1; y#2]) positive true gs) (inner y) gs).
  { intros Y0 Y3 Y2. set (e := elevated [y#0; y#1; y#2]). destruct (at_ends e eq_refl) as (A & B).
    simpl in A, B. destruct (strict_root e) as (r & I & Z); [rewrite A, B; nra |].
    assert (Zy : form_at y r = 0) by (rewrite <- (without_finish y r L Y3); fold e; rewrite Z; ring).
    destruct (falling_crossing _ _ r C I Zy ltac:(lra)) as (K & _).
    destruct (crossing_without_finish y _ r L C D1 Y3 K) as (_ & Ke).
    apply (answers_same _ (eq r)); [intros t; symmetry; apply (crossing_inner y positive); auto |].
    apply at_crossing_answers; auto. simpl. rewrite <- E0. nra. }
  assert (Below : form_at y 0 <= 0 -> form_at y 1 <= 0 -> forall t, ~ inner y t).
  { intros Y0 Y1 t (I & Z). pose proof (below_chord _ _ 0 t 1 C ltac:(lra) ltac:(lra) ltac:(lra)).
    rewrite Z in H. nra. }
  assert (Climbs : form_at y 0 = 0 -> 0 <= exact (y#1) -> forall t, ~ inner y t).
  { intros Y0 Y1 t (I & Z). pose proof (proj1 C 0 t ltac:(lra) ltac:(lra) ltac:(lra)). rewrite E0 in Y0.
    rewrite D0, E0, Y0, Z in H. nra. }
  assert (Descends : form_at y 1 = 0 -> 0 <= exact (y#2) -> forall t, ~ inner y t).
  { intros Y1 Y2 t (I & Z). pose proof (proj1 C 1 t ltac:(lra) ltac:(lra) ltac:(lra)). rewrite E3 in Y1.
    rewrite D1, E3, Y1, Z in H. nra. }
  assert (C2 : certain (negate (sign_of (y#2))) = true) by (pose proof (Exact (y#2)); now destruct
    (sign_of (y#2))).
  unfold on_convex. rewrite !always_certain, C2. cbn [andb]. clear C2 Ed F C D0 D1 Ld.
  revert Ends. generalize (either (at_end (sign_of (y#0)) gs 0) (at_end (sign_of (y#3)) gs 4)).
  intros found Ends.
  destruct (sign_tells (y#0)) as (C0 & S0). destruct (sign_tells (y#3)) as (C3 & S3).
  rewrite <- E0 in S0. rewrite <- E3 in S3.
  destruct (sign_tells (y#1)) as (C1 & S1). destruct (sign_tells (y#2)) as (C2 & S2).
  rewrite <- E0, <- E3 in Pair.
  destruct (sign_of (y#0)), (sign_of (y#3)); try easy; cbn [same_sign possibly_negative
    possibly_positive orb andb];
    rewrite ?andb_false_r, ?andb_true_r; cbn [sign_is_right] in S0, S3;
    try (apply with_inner; auto; fail); try (apply without_inner; [exact Ends | exact (Below ltac:(lra)
      ltac:(lra))]).
  - destruct (sign_of (y#1)); try easy; cbn [same_sign possibly_negative possibly_positive orb andb];
    cbn [sign_is_right] in S1;
      [apply with_inner; auto | |]; apply without_inner; auto; apply Climbs; lra.
  - destruct (sign_of (y#2)); try easy; cbn [negate same_sign possibly_negative possibly_positive orb
    andb]; cbn [sign_is_right] in S2;
      [apply with_inner; auto | |]; apply without_inner; auto; apply Descends; lra.
Qed.


(** ** A subinterval of the step *)

(** The answer of a subinterval in which Y may be zero throughout. *)
Definition answered (e : existence) y gs : Prop :=
  e = maybe_root /\ (forall t, form_at y t = 0) \/ answers e (roots y) gs.

Lemma answers_opp e y gs : answers e (roots (map opp y)) gs -> answers e (roots y) gs.
Proof.
  apply answers_same. intros t. unfold roots, at_time. rewrite exacts_opp, form_opp.
  split; intros (T & Z); split; auto; lra.
Qed.

(** Without inflection and curvature, Y is linear. *)
Lemma linear_slope d : length d = 3%nat -> Forall (eq 0) (exacts (dy d)) -> sign_inside d <> uncertain.
Proof.
  intros L F. destruct (length_3 d L) as (a & b & c & ->). revert F. unfold derivative.
  cbn [map derivative_from]. repeat (progress exacts || rewrite exact_times). simpl. intros F.
  inversion_clear F as [| ? ? F0 F']. inversion_clear F' as [| ? ? F1 _].
  unfold sign_inside. cbn [sign_inside_from].
  destruct (sign_tells a) as (Ca & A), (sign_tells b) as (Cb & B), (sign_tells c) as (Cc & C).
  destruct (sign_of a), (sign_of b), (sign_of c); simpl in *; easy || lra.
Qed.

Lemma on_whole_part_answered y gs curvature parts : length y = 4%nat -> five gs ->
  signs_inside curvature (exacts (ddy y)) -> curvature <> zero ->
  (opposite (ddy y) = true -> curvature = uncertain -> answers (parts (ddy y)) (roots y) gs) ->
  answered (on_whole_part y gs curvature parts) y gs.
Proof.
  intros L F K Nz Parts. apply (on_whole_part_cases (fun e y => answered e y gs)); auto.
  - intros No. right. intros t (T & Z). auto.
  - intros e [(E & Z) | A]; [left; split; auto; intros t; specialize (Z t) | right; now apply answers_opp].
    unfold at_time in *. rewrite exacts_opp, form_opp in Z. lra.
  - intros. right. now apply on_increasing_answers.
  - intros. right. now apply on_convex_answers.
  - intros Y. destruct (sign_tells (y#0)) as (C & R). unfold answered.
    destruct (sign_of (y#0)); try easy; simpl in *; [right | left; split; auto; intros t; now rewrite Y | right];
      intros t (_ & Z); rewrite Y in Z; lra.
  - intros Es C Inside. assert (Ls : length (ddy y) = 2%nat) by now four y L.
    assert (Ld : length (dy y) = 3%nat) by now four y L.
    right. destruct (opposite (ddy y)) eqn:O; [auto | exfalso]. destruct (Inside eq_refl) as [E | E].
    + now apply (linear_slope (dy y) Ld) in Es; [| apply zero_form].
    + now apply inside_certain in E.
Qed.

Lemma on_curved_answers y gs curvature : length y = 4%nat -> five gs ->
  signs_inside curvature (exacts (ddy y)) -> curvature = negative \/ curvature = positive -> answers (on_curved y gs curvature) (roots y) gs.
Proof.
  intros L F K C.
  destruct (on_whole_part_answered y gs curvature (fun _ => maybe_root) L F K) as [(_ & Z) | A]; auto;
    try (destruct C; congruence).
  exfalso. rewrite (second_of_cubic y L) in K.
  assert (N : forall t, form_at (ddy y) t = 0) by (intros t; pose proof (second_difference y t 1 L) as
    D; rewrite !Z in D; lra).
  rewrite !N in K. destruct C as [-> | ->]; destruct K as (_ & E); simpl in E;
    inversion_clear E as [? ? P | ? ? E']; try lra; inversion_clear E' as [? ? P | ? ? E'']; try lra;
      easy.
Qed.

Lemma same_signs gs (f : list S -> list S) u t :
  Forall (fun g => exists c, 0 < c /\ form_at (f g) u = c * form_at g t) gs ->
  (excluded (map f gs) u <-> excluded gs t) /\ (all_positive (map f gs) u <-> all_positive gs t) /\
  (touching (map f gs) u <-> touching gs t).
Proof.
  intros H. unfold touching, excluded, all_positive.
  assert (Each : forall P Q : R -> Prop, (forall c x, 0 < c -> (P (c * x) <-> Q x)) ->
    (Forall (fun g => P (form_at g u)) (map f gs) <-> Forall (fun g => Q (form_at g t)) gs) /\
    (Exists (fun g => P (form_at g u)) (map f gs) <-> Exists (fun g => Q (form_at g t)) gs)).
  { intros P Q PQ. induction H as [| g l (c & C & E) _ (IH & IH')]; simpl; [split; split; easy |].
    rewrite !Forall_cons_iff, !Exists_cons, IH, IH', E, (PQ c _ C). easy. }
  destruct (Each (fun x => x < 0) (fun x => x < 0)) as (_ & A); [intros; split; nra |].
  destruct (Each (Rlt 0) (Rlt 0)) as (B & _); [intros; split; nra |].
  destruct (Each (Rle 0) (Rle 0)) as (C & _); [intros; split; nra |].
  destruct (Each (fun x => x = 0) (fun x => x = 0)) as (_ & D); [intros; split; nra |].
  tauto.
Qed.

Lemma answers_part e y q gs (f : list S -> list S) a b : a < b -> is_part y q a b ->
  Forall (fun g => is_part g (f g) a b) gs -> answers e (roots q) (map f gs) ->
  answers e (fun t => a <= t <= b /\ form_at y t = 0) gs.
Proof.
  intros W (_ & c & C & E) G.
  assert (Same : forall u, (excluded (map f gs) u <-> excluded gs (a + (b - a) * u)) /\
    (all_positive (map f gs) u <-> all_positive gs (a + (b - a) * u)) /\
    (touching (map f gs) u <-> touching gs (a + (b - a) * u))).
  { intros u. apply same_signs. eapply Forall_impl; [| exact G]. simpl. intros g (_ & k & K & Eg).
    exists k. now split. }
  assert (To : forall u, roots q u -> a <= a + (b - a) * u <= b /\ form_at y (a + (b - a) * u) = 0).
  { intros u (U & Z). rewrite E in Z. split; [nra |]. apply Rmult_integral in Z. destruct Z; auto. lra.
    }
  assert (From : forall t, a <= t <= b /\ form_at y t = 0 -> exists u, roots q u /\ t = a + (b - a) *
    u).
  { intros t (T & Z). exists ((t - a) / (b - a)).
    assert (X : t = a + (b - a) * ((t - a) / (b - a))) by (field; lra).
    split; auto. split; [| rewrite E, <- X, Z; ring].
    split; [apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra] |].
    apply Rmult_le_reg_r with (b - a); [lra |].
    replace ((t - a) / (b - a) * (b - a)) with (t - a) by (field; lra). lra. }
  destruct e; simpl; auto.
  - intros A t T. destruct (From t T) as (u & U & ->). now apply Same, A.
  - intros (u & U & A). exists (a + (b - a) * u). split; auto. now apply Same.
  - intros ((u & U & A) & N). split; [exists (a + (b - a) * u); split; auto; now apply Same |].
    intros t T P. destruct (From t T) as (v & V & ->). apply (N v V). now apply Same.
Qed.

(** Y is split at its inflection into two subintervals of known curvature. *)
Lemma split_answers y gs : length y = 4%nat -> five gs -> opposite (ddy y) = true ->
  let (v, w) := linear_root (ddy y) in
  let parts_of f := let (a, b) := split f v w in (normalized a, normalized b) in
  answers
    (either (on_curved (fst (parts_of y)) (map (fun f => fst (parts_of f)) gs) (sign_of (ddy y # 0)))
            (on_curved (snd (parts_of y)) (map (fun f => snd (parts_of f)) gs) (sign_of (ddy y # 1))))
    (roots y) gs.
Proof.
  intros L F O. pose proof (split_at_inflection y L O) as H. destruct (linear_root (ddy y)) as (v, w).
  intros parts_of. cbv zeta in H.
  change (fun f : list S => let (a, b) := split f v w in (normalized a, normalized b)) with parts_of in H.
  destruct H as (m & M & P & S0 & S1), (opposite_signs _ O) as (C0 & C1), (P y (or_introl L)) as (P0 & P1).
  assert (G0 : Forall (fun g => is_part g (fst (parts_of g)) 0 m) gs)
    by (eapply Forall_impl; [| exact F]; intros g Lg; apply P; now right).
  assert (G1 : Forall (fun g => is_part g (snd (parts_of g)) m 1) gs)
    by (eapply Forall_impl; [| exact F]; intros g Lg; apply P; now right).
  assert (Five : forall f a b, Forall (fun g => is_part g (f g) a b) gs -> five (map f gs)).
  { intros f a b G. apply Forall_map. rewrite Forall_forall in *. intros g I.
    destruct (G g I) as (-> & _). auto. }
  assert (L0 := proj1 P0). assert (L1 := proj1 P1). rewrite L in L0, L1.
  apply (answers_either _ _ (fun t => 0 <= t <= m /\ form_at y t = 0) (fun t => m <= t <= 1 /\ form_at y
    t = 0)).
  - intros t. unfold roots. split; [| intros [(T & Z) | (T & Z)]; split; auto; lra]. intros (T & Z).
    destruct (Rle_or_lt t m); [left | right]; split; auto; lra.
  - apply (answers_part _ y (fst (parts_of y)) _ (fun f => fst (parts_of f))); auto; [lra |].
    apply on_curved_answers; auto. now apply (Five _ 0 m).
  - apply (answers_part _ y (snd (parts_of y)) _ (fun f => snd (parts_of f))); auto; [lra |].
    apply on_curved_answers; auto. now apply (Five _ m 1).
Qed.

(** No subinterval is halved. *)
Lemma on_part_answered y gs halvings : length y = 4%nat -> five gs ->
  answered (on_part y gs halvings) y gs.
Proof.
  intros L F. destruct halvings; (apply on_whole_part_answered; simpl; auto; [discriminate |]); intros O
    _; rewrite O;
    pose proof (split_answers y gs L F O) as A; destruct (linear_root (ddy y)); exact A.
Qed.

Lemma root_with_nonnegative_answered y gs : length y = 4%nat -> five gs ->
  answered (root_with_nonnegative y gs) y gs.
Proof.
  intros L F. unfold root_with_nonnegative.
  assert (Whole : forall p : list S, is_part p (normalized p) 0 1).
  { intros p. apply part_normalized. split; auto. exists 1. split; [lra |]. intros t.
    replace (0 + (1 - 0) * t) with t by ring. ring. }
  assert (Back : forall e, answers e (roots (normalized y)) (map normalized gs) -> answers e (roots y)
    gs).
  { intros e. apply answers_part; auto; [lra |]. apply Forall_forall. auto. }
  destruct (certainly_rootless (normalized y)) eqn:N.
  - right. apply Back, answers_no. intros t (T & Z). now apply rootless_hull with (t := t) in N.
  - destruct (on_part_answered (normalized y) (map normalized gs) max_halvings) as [(E & Z) | A].
    + now rewrite length_normalized.
    + apply Forall_map. eapply Forall_impl; [| exact F]. simpl. intros g Lg.
      now rewrite length_normalized.
    + left. split; auto. intros t. destruct (normalized_at y) as (c & C & En). specialize (Z t).
      rewrite En in Z. apply Rmult_integral in Z. destruct Z; auto. lra.
    + right. auto.
Qed.

Theorem bsc_exact_root y gs t : length y = 4%nat -> five gs ->
  root_with_nonnegative y gs = maybe_root -> form_at y t = 0.
Proof.
  intros L F E. destruct (root_with_nonnegative_answered y gs L F) as [(_ & Z) | A]; auto.
  now rewrite E in A.
Qed.

Theorem bsc_exact_inside y gs : length y = 4%nat -> five gs ->
  root_with_nonnegative y gs = maybe_inside ->
  (exists t, 0 <= t <= 1 /\ form_at y t = 0 /\ (forall g, In g gs -> 0 <= form_at g t) /\
    exists g, In g gs /\ form_at g t = 0) /\
  forall t, 0 <= t <= 1 -> form_at y t = 0 -> ~ forall g, In g gs -> 0 < form_at g t.
Proof.
  intros L F E. destruct (root_with_nonnegative_answered y gs L F) as [(N & _) | A]; [congruence |].
  rewrite E in A. destruct A as ((t & (T & Z) & P & Q) & N). split.
  - exists t. repeat split; try tauto; [now apply Forall_forall | now apply Exists_exists].
  - intros u U Zu G. apply (N u); [now split |]. now apply Forall_forall.
Qed.

(** ** The decision *)

(** `collides`; border: what touches_at_border returns. *)
Definition decision y gs (border : bool) : bool :=
  match root_with_nonnegative y gs with
  | no => false
  | yes => true
  | maybe_root => forallb (fun g => same_sign (sign_of (g#0)) positive) gs || border
  | maybe_inside => border
  end.

Lemma all_at_start gs : five gs ->
  forallb (fun g => same_sign (sign_of (g#0)) positive) gs = true <-> all_positive gs 0.
Proof.
  intros F. rewrite forallb_forall. unfold all_positive. rewrite Forall_forall in *.
  assert (A : forall g, In g gs -> same_sign (sign_of (g#0)) positive = true <-> 0 < form_at g 0).
  { intros g I. rewrite at_start by (specialize (F g I); now destruct g).
    destruct (sign_tells (g#0)) as (C & R).
    destruct (sign_of (g#0)); simpl in *; split; easy || lra. }
  split; intros H g I; now apply A, H.
Qed.

Lemma query_decision edges (q0 q1 q2 q3 : moving_point) border :
  let m0 := exact_motion q0 in let m1 := exact_motion q1 in let m2 := exact_motion q2 in let m3 := exact_motion q3 in
  border = true <-> query_border edges m0 m1 m2 m3 ->
  let b := side_b edges difference q0 q1 q2 q3 in let c := side_c edges difference q0 q1 q2 q3 in
  let p := side_p edges difference q0 q1 q2 q3 in
  decision (y_form b c p) (inside_forms edges b c p) border = true <-> query_collides edges m0 m1 m2 m3.
Proof.
  intros m0 m1 m2 m3 Border b c p. unfold decision. destruct (query_lengths edges q0 q1 q2 q3) as (L & F).
  pose proof (query_sides_at edges q0 q1 q2 q3) as Sides. pose proof (query_forms_at edges q0 q1 q2 q3) as Forms.
  cbv zeta in Forms. fold b c p m0 m1 m2 m3 in L, F, Sides, Forms.
  assert (G : forall t, all_positive (inside_forms edges b c p) t <-> query_inside_at edges m0 m1 m2 m3 t).
  { intros t. destruct (Sides t) as (Eb & Ec & Ep). rewrite <- query_inside_same, <- Eb, <- Ec, <- Ep.
    apply (query_weights_at _ _ _ _ _ (Rlt 0)). }
  destruct (root_with_nonnegative (y_form b c p) (inside_forms edges b c p)) eqn:E.
  - split; [easy | intros H; now apply query_bsc_separate in E].
  - split; [intros _; now apply query_bsc_collides | easy].
  - rewrite query_coplanar, orb_true_iff, (all_at_start _ F), Border, G; [easy |].
    intros t _. destruct (Sides t) as (<- & <- & <-). rewrite <- (proj1 (Forms t)).
    now apply (bsc_exact_root _ _ t L F).
  - destruct (bsc_exact_inside _ _ L F E) as (_ & N). split; [intros H; now apply query_border_collision, Border |].
    destruct border; [easy |]. intros H. exfalso. apply query_inside in H; [| rewrite <- Border; easy].
    destruct H as (t & T & Z & I). destruct (Sides t) as (Eb & Ec & Ep). rewrite <- Eb, <- Ec, <- Ep in *.
    rewrite <- (proj1 (Forms t)) in Z. apply (N t T Z). apply Forall_forall. now apply G.
Qed.

End Exact.

(** ** The decision in integers *)

Definition bsc_exact_decides (edges : bool) (finder : root_finder) (q0 q1 q2 q3 : given) : bool :=
  let i := to_integers [q0; q1; q2; q3] in
  let b := side_b edges difference (i q0) (i q1) (i q2) (i q3) in
  let c := side_c edges difference (i q0) (i q1) (i q2) (i q3) in
  let p := side_p edges difference (i q0) (i q1) (i q2) (i q3) in
  decision (y_form b c p) (inside_forms edges b c p) (query_border_touched finder edges q0 q1 q2 q3).
Definition bsc_exact_decides_face : root_finder -> given -> given -> given -> given -> bool := bsc_exact_decides false.
Definition bsc_exact_decides_edges : root_finder -> given -> given -> given -> given -> bool := bsc_exact_decides true.

Lemma integers_exact (n : integers) : sign_of n <> uncertain.
Proof. apply integer_tells. Qed.

Lemma query_bsc_exact edges finder q0 q1 q2 q3 : query_border_meets finder edges (promises finder) q0 q1 q2 q3 ->
  bsc_exact_decides edges finder q0 q1 q2 q3 = true <->
  query_collides edges (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3).
Proof.
  intros Border. destruct (query_in_integers q0 q1 q2 q3) as (K & E0 & E1 & E2 & E3).
  unfold in_integers in *. rewrite <- (query_units _ edges _ _ _ _ K), <- E0, <- E1, <- E2, <- E3.
  apply query_decision; [apply integers_exact |]. rewrite query_border_right by exact Border.
  rewrite E0, E1, E2, E3. symmetry. now apply query_border_units.
Qed.
Theorem bsc_exact_face finder v f0 f1 f2 : face_border_meets finder (promises finder) v f0 f1 f2 ->
  bsc_exact_decides_face finder v f0 f1 f2 = true <->
  vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof. exact (query_bsc_exact false finder v f0 f1 f2). Qed.
Theorem bsc_exact_edges finder a0 a1 b0 b1 : edges_border_meets finder (promises finder) a0 a1 b0 b1 ->
  bsc_exact_decides_edges finder a0 a1 b0 b1 = true <->
  edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof. exact (query_bsc_exact true finder a0 a1 b0 b1). Qed.
