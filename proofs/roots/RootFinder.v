(** The hypotheses of the decisions about common_factor and real_roots (root_finder, UnboundedIntegers.v) hold for
    the code's algorithms (CommonFactor.v, RootIsolation.v). So the theorems of Reference.v and BscExact.v hold for
    the code, if it ends. Results:
        found_roots_right        for integer coefficients, real_roots finds the roots in (0, oo)
        reference_face_by_isolation, reference_edges_by_isolation, reference_vertex_edge_by_isolation,
        bsc_exact_face_by_isolation, bsc_exact_edges_by_isolation   the decisions are right with any functions that
                                 return results of the algorithms for the polynomials of the query *)

From Coq Require Import Reals ZArith Lia Lra List Sorted.
From Errbound Require Import RootIsolation ControlValues CommonFactor.
From Errbound Require Import Sign Contact UnboundedIntegers Reference BscExact.
From Errbound Require BoundedInteger.
Import ListNotations.
Open Scope R_scope.

(** ** The chain's first polynomial, in integers *)

Fixpoint derivative_from (i : Z) (p : list Z) : list Z :=
  match p with [] => [] | a :: l => (a * i)%Z :: derivative_from (i + 1) l end.
Definition derivative (p : list Z) : list Z := derivative_from 1 (tl p).

Lemma derivative_reals p : reals_of (derivative p) = RootIsolation.derivative (reals_of p).
Proof.
  assert (G : forall l i, reals_of (derivative_from i l) = RootIsolation.derivative_from (IZR i) (reals_of l)).
  { induction l as [| a l IH]; intros i; [easy |]. cbn [derivative_from map RootIsolation.derivative_from].
    now rewrite IH, mult_IZR, plus_IZR. }
  unfold derivative, RootIsolation.derivative. rewrite G. now destruct p.
Qed.
Lemma derivative_trimmed p : trimmed p -> trimmed (derivative p).
Proof.
  assert (G : forall l i, (0 < i)%Z -> trimmed l -> trimmed (derivative_from i l)).
  { induction l as [| a [| b l] IH]; intros i I [N | L]; try discriminate; [now left | now left | |].
    - right. simpl in *. lia.
    - right. destruct (IH (i + 1)%Z ltac:(lia) (or_intror L)) as [E | E]; [discriminate | exact E]. }
  intros T. apply G; [lia |]. destruct p as [| a [| b l]]; [now left | now left |].
  destruct T as [T | T]; [discriminate | now right].
Qed.

(** squarefree_chain's first polynomial: the primitive part, or its quotient by the common factor with its
    derivative. *)
Inductive first_of_chain (p : list Z) : list Z -> Prop :=
| itself f : primitive p f -> first_of_chain p f
| divided_once q m f : primitive p q -> CommonFactor.common_factor q (derivative q) m ->
    length f = (length q + 1 - length m)%nat -> divided m q f -> first_of_chain p f.

Lemma last_of_quotient q m f : q <> [] -> trimmed q -> m <> [] -> divided m q f ->
  length f = (length q + 1 - length m)%nat -> last f 0%Z <> 0%Z.
Proof.
  intros Nq [E | Lq] Nm D Lf; [easy |]. pose proof (divided_right _ _ _ D) as V.
  assert (S : same q (product m f)) by (apply equal_same; intros x; rewrite product_at; apply V).
  rewrite <- last_coefficient, S in Lq. rewrite <- last_coefficient. intros Z. apply Lq.
  assert (Over : forall l i, (length l - 1 < i)%nat -> coefficient l i = 0%Z)
    by (intros l i I; apply nth_overflow; lia).
  destruct f as [| a l].
  - rewrite <- S. apply zero_everywhere. intros x. rewrite V. unfold poly at 2. simpl. ring.
  - replace (length q - 1)%nat with (length m - 1 + (length (a :: l) - 1))%nat.
    + rewrite last_of_product by apply Over. rewrite Z. ring.
    + destruct m; [easy |]. simpl in *. lia.
Qed.
Lemma first_right p f : trimmed p -> poly p 0 <> 0 -> first_of_chain p f ->
  RootIsolation.first_of_chain (reals_of p) (reals_of f) /\ last f 0%Z <> 0%Z.
Proof.
  intros T N C. assert (Np : p <> []) by now intros ->.
  destruct C as [f Q | q m f Q M L D]; destruct (primitive_right _ _ Q) as (E & Tq & _); specialize (Tq T);
    destruct Q as (c & C & Ep).
  - split; [| destruct Tq as [Tq |]; [now apply E in Tq | easy]].
    apply RootIsolation.primitive with (IZR c); [now apply not_0_IZR |]. intros x. rewrite Ep. apply multiple_at.
  - assert (Nq : q <> []) by now rewrite E.
    destruct (CommonFactor.common_factor_right _ _ _ Tq (derivative_trimmed q Tq) M) as (_ & Em & _).
    split; [| apply (last_of_quotient q m); tauto].
    apply RootIsolation.quotient with (IZR c) (reals_of q) (reals_of m); [now apply not_0_IZR | | |].
    + intros x. rewrite Ep. apply multiple_at.
    + intros x. apply (divided_right _ _ _ D).
    + rewrite <- derivative_reals. apply (common_factor_divides _ _ _ M).
Qed.

(** ** real_roots *)

Definition found_roots (p f : list Z) (found : list interval) : Prop := first_of_chain p f /\
  isolate (reals_of f) (half_line f) (half_line (mirrored_integers f)) 0 (upper_bound f) found.

Theorem found_roots_right p f found : trimmed p -> poly p 0 <> 0 -> found_roots p f found ->
  exists roots, Forall2 (isolates (reals_of f)) found roots /\ StronglySorted Rlt roots /\
    forall x, In x roots <-> 0 < x /\ poly p x = 0.
Proof.
  intros T N (C & I). destruct (first_right p f T N C) as (F & L).
  apply (RootIsolation.real_roots_right (reals_of p) (reals_of f)); [exact N |].
  apply found_in_integers_right; [| easy]. rewrite poly_at_0 in N. intros Z. now rewrite Z in N.
Qed.

(** ** Functions that return the algorithms' results *)

(** A root: its polynomial and its interval. *)
Record located := Located { polynomial : list Z; place : interval }.

(** The root, if the interval has one. *)
Definition candidates (k : located) (x : R) : Prop :=
  x = low (place k) \/ low (place k) <= x <= high (place k) /\ poly (polynomial k) x = 0.
Lemma candidates_bound k : bound (candidates k).
Proof.
  exists (Rmax (low (place k)) (high (place k))). pose proof (Rmax_l (low (place k)) (high (place k))).
  pose proof (Rmax_r (low (place k)) (high (place k))). intros x [-> | (X & _)]; lra.
Qed.
Definition root_of (k : located) : R :=
  proj1_sig (completeness (candidates k) (candidates_bound k) (ex_intro _ _ (or_introl eq_refl))).
Lemma root_of_right f i r : isolates (reals_of f) i r -> root_of (Located f i) = r.
Proof.
  intros (Z & I). unfold root_of. destruct completeness as (m & Upper & Least). cbn [proj1_sig].
  assert (R : low i <= r <= high i) by (destruct I as [(-> & ->) | (I & _)]; lra).
  apply Rle_antisym.
  - apply Least. intros x [-> | (X & Zx)]; cbn [place polynomial] in *; [lra |].
    destruct I as [(A & B) | (_ & Only & _)]; [lra |]. rewrite (Only x); auto. lra.
  - apply Upper. right. split; [exact R | exact Z].
Qed.

Section Isolation.

Context (common : list Z -> list Z -> list Z) (squarefree : list Z -> list Z) (intervals : list Z -> list interval)
  (sign_there : list Z -> list Z -> interval -> sign).

Definition valid (p : list Z) : Prop := trimmed p /\ (2 <= length p)%nat /\ poly p 0 <> 0.
(** The results of the algorithms, for the given arguments. The interval may be one that earlier calls have refined:
    after_refining is a case of the relation. *)
Definition returned : demands := {|
  of_factor := fun f g => trimmed f -> trimmed g -> CommonFactor.common_factor f g (common f g);
  of_roots := fun p => valid p -> found_roots p (squarefree p) (intervals p);
  of_signs := fun p g => valid p -> trimmed g -> found_roots p (squarefree p) (intervals p) /\
    forall i, In i (intervals p) -> exists s,
      RootIsolation.sign_at_root (reals_of (squarefree p)) (reals_of g) i s /\
      sign_there (squarefree p) g i = BoundedInteger.sign_of_integer s
|}.

Let all_roots (p : list Z) : list located := map (Located (squarefree p)) (intervals p).

Lemma paired {A B} (P : A -> B -> Prop) a b : Forall2 P a b ->
  (forall x, In x a -> exists y, In y b /\ P x y) /\ (forall y, In y b -> exists x, In x a /\ P x y).
Proof.
  induction 1 as [| x y a b H F (L & R)]; [easy |]. simpl. split.
  - intros z [<- | I]; [exists y; auto |]. destruct (L z I) as (w & W & Q). exists w; auto.
  - intros z [<- | I]; [exists x; auto |]. destruct (R z I) as (w & W & Q). exists w; auto.
Qed.
Lemma located_right p k : valid p -> found_roots p (squarefree p) (intervals p) -> In k (all_roots p) -> polynomial k = squarefree p /\
  In (place k) (intervals p) /\ isolates (reals_of (squarefree p)) (place k) (root_of k).
Proof.
  intros A Returned I. apply in_map_iff in I. destruct I as (i & <- & I). split; [easy |]. split; [exact I |].
  destruct (found_roots_right p _ _ (proj1 A) (proj2 (proj2 A)) Returned) as (roots & F & _).
  destruct (proj1 (paired _ _ _ F) i I) as (r & _ & H). now rewrite (root_of_right _ _ r).
Qed.
Lemma all_roots_right p x : valid p -> found_roots p (squarefree p) (intervals p) -> (exists k, In k (all_roots p) /\ root_of k = x) <-> 0 < x /\ poly p x = 0.
Proof.
  intros A Returned. destruct (found_roots_right p _ _ (proj1 A) (proj2 (proj2 A)) Returned) as (roots & F & _ & R).
  rewrite <- R. destruct (paired _ _ _ F) as (To & From). split.
  - intros (k & I & <-). apply in_map_iff in I. destruct I as (i & <- & I). destruct (To i I) as (r & Ir & H).
    now rewrite (root_of_right _ _ r).
  - intros I. destruct (From x I) as (i & Ii & H). exists (Located (squarefree p) i).
    split; [now apply in_map | now apply root_of_right].
Qed.
Lemma sign_there_right p g k : valid p -> trimmed g -> of_signs returned p g -> In k (all_roots p) ->
  tells (sign_there (polynomial k) g (place k)) (poly g (root_of k)).
Proof.
  intros A T M I. destruct (M A T) as (Returned & Signs).
  destruct (located_right p k A Returned I) as (-> & Ii & H). destruct (Signs _ Ii) as (s & S & ->).
  apply (RootIsolation.sign_at_root_right _ _ _ _ _ H) in S. subst s. fold (poly g (root_of k)).
  destruct (SignVariations.sgn_cases (poly g (root_of k))) as [(L & ->) | [(L & ->) | (L & ->)]]; now split.
Qed.

Definition isolation : root_finder := {|
  common_factor := common; root := located; real_roots := all_roots;
  sign_at_root := fun g k => sign_there (polynomial k) g (place k); where_is := root_of |}.

(** The results have the promised properties. *)
Lemma factor_promised f g : of_factor returned f g -> of_factor (promises isolation) f g.
Proof. intros M F G. exact (CommonFactor.common_factor_right f g _ F G (M F G)). Qed.
Lemma roots_promised p : of_roots returned p -> of_roots (promises isolation) p.
Proof. intros M T L N x. exact (all_roots_right p x (conj T (conj L N)) (M (conj T (conj L N)))). Qed.
Lemma signs_promised p g : of_signs returned p g -> of_signs (promises isolation) p g.
Proof. intros M T L N G k I. exact (sign_there_right p g k (conj T (conj L N)) G M I). Qed.
Lemma factors_promised fs : forall all, factors_meet isolation returned all fs ->
  factors_meet isolation (promises isolation) all fs.
Proof. induction fs as [| f fs IH]; intros all M; [easy |]. destruct M as (P & M). split; [now apply factor_promised | now apply IH]. Qed.
Lemma edge_promised query v e0 e1 : edge_contact_meets isolation returned query v e0 e1 ->
  edge_contact_meets isolation (promises isolation) query v e0 e1.
Proof.
  intros (F & R & S). exact (conj (factors_promised _ _ F) (conj (roots_promised _ R) (signs_promised _ _ S))).
Qed.
Lemma face_border_promised v f0 f1 f2 : face_border_meets isolation returned v f0 f1 f2 ->
  face_border_meets isolation (promises isolation) v f0 f1 f2.
Proof. intros (A & B & C). exact (conj (edge_promised _ _ _ _ A) (conj (edge_promised _ _ _ _ B) (edge_promised _ _ _ _ C))). Qed.
Lemma edges_border_promised a0 a1 b0 b1 : edges_border_meets isolation returned a0 a1 b0 b1 ->
  edges_border_meets isolation (promises isolation) a0 a1 b0 b1.
Proof.
  intros (A & B & C & D). exact (conj (edge_promised _ _ _ _ A) (conj (edge_promised _ _ _ _ B)
    (conj (edge_promised _ _ _ _ C) (edge_promised _ _ _ _ D)))).
Qed.
Lemma regular_promised y gs n2 : regular_meets returned y gs n2 -> regular_meets (promises isolation) y gs n2.
Proof.
  intros (R & S). exact (conj (roots_promised _ R) (Forall_impl _ (fun f => signs_promised _ (without_end_roots f)) S)).
Qed.

Lemma query_border_promised edges q0 q1 q2 q3 : query_border_meets isolation edges returned q0 q1 q2 q3 ->
  query_border_meets isolation edges (promises isolation) q0 q1 q2 q3.
Proof. destruct edges; [exact (edges_border_promised q0 q1 q2 q3) | exact (face_border_promised q0 q1 q2 q3)]. Qed.
Lemma query_reference_by_isolation edges q0 q1 q2 q3 : reference_meets isolation edges returned q0 q1 q2 q3 ->
  reference_decides isolation edges q0 q1 q2 q3 = true <->
  query_collides edges (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3).
Proof.
  intros (R & B). apply query_reference. exact (conj (regular_promised _ _ _ R) (query_border_promised _ _ _ _ _ B)).
Qed.
Theorem reference_face_by_isolation v f0 f1 f2 : reference_face_meets isolation returned v f0 f1 f2 ->
  reference_decides_face isolation v f0 f1 f2 = true <->
  vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof. exact (query_reference_by_isolation false v f0 f1 f2). Qed.
Theorem reference_edges_by_isolation a0 a1 b0 b1 : reference_edges_meets isolation returned a0 a1 b0 b1 ->
  reference_decides_edges isolation a0 a1 b0 b1 = true <->
  edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof. exact (query_reference_by_isolation true a0 a1 b0 b1). Qed.
Theorem reference_vertex_edge_by_isolation v e0 e1 : edge_contact_meets isolation returned [v; e0; e1] v e0 e1 ->
  reference_decides_vertex_edge isolation v e0 e1 = true <->
  vertex_edge_collides (given_motion v) (given_motion e0) (given_motion e1).
Proof. intros M. apply reference_vertex_edge. exact (edge_promised _ _ _ _ M). Qed.
Theorem bsc_exact_face_by_isolation v f0 f1 f2 : face_border_meets isolation returned v f0 f1 f2 ->
  bsc_exact_decides_face isolation v f0 f1 f2 = true <->
  vertex_face_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof. intros B. apply bsc_exact_face. exact (face_border_promised _ _ _ _ B). Qed.
Theorem bsc_exact_edges_by_isolation a0 a1 b0 b1 : edges_border_meets isolation returned a0 a1 b0 b1 ->
  bsc_exact_decides_edges isolation a0 a1 b0 b1 = true <->
  edge_edge_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof. intros B. apply bsc_exact_edges. exact (edges_border_promised _ _ _ _ B). Qed.

End Isolation.
