(** The reference decisions (ccd/reference.cpp, ccd/unbounded_integers.hpp) by the exact roots of
    RootIsolation.v, over the real numbers: the code's integers are exact.

    Results:
        without_end_roots_right     the form's roots but for t = 0 and t = 1, and its signs between
        regular_contact_right       Y = 0, N <> 0 and all G >= 0 at some t in [0, 1]
        vertex_edge_roots_right     contact of a vertex with an edge
        reference_face_right, reference_edges_right     `contact` of VF and EE is collision *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool Sorted.
From Errbound Require Import Sign Bernstein Contact VertexEdge Decisions SignVariations RootIsolation.
Import ListNotations.
Open Scope R_scope.

(** ** Forms without roots at the ends *)

Fixpoint drop_zeros (h : list R) : list R :=
  match h with a :: l => if Req_EM_T a 0 then drop_zeros l else h | [] => [] end.
Definition without_end_roots (h : list R) : list R := rev (drop_zeros (rev (drop_zeros h))).

Lemma drop_zeros_before h : exists k, h = repeat 0 k ++ drop_zeros h /\ (drop_zeros h <> [] -> hd 0 (drop_zeros h) <> 0).
Proof.
  induction h as [| a l (k & E & N)]; [now exists 0%nat |]. simpl. destruct (Req_EM_T a 0) as [-> | A].
  - exists (S k). simpl. now rewrite <- E.
  - now exists 0%nat.
Qed.
Lemma power_form_zeros k x : power_form (repeat 0 k) x = 0.
Proof. induction k as [| k IH]; simpl; [| rewrite IH]; ring. Qed.
Lemma repeat_rev (k : nat) : rev (repeat 0 k) = repeat 0 k.
Proof.
  induction k as [| k IH]; [easy |]. simpl. rewrite IH. clear IH. induction k as [| k IH]; [easy |]. simpl. now rewrite IH.
Qed.

Lemma end_roots h : exists k m, h = repeat 0 k ++ without_end_roots h ++ repeat 0 m /\
  (without_end_roots h <> [] -> hd 0 (without_end_roots h) <> 0).
Proof.
  unfold without_end_roots. destruct (drop_zeros_before h) as (k & E & N). set (l := drop_zeros h) in *.
  destruct (drop_zeros_before (rev l)) as (m & F & M). set (q := drop_zeros (rev l)) in *.
  assert (L : l = rev q ++ repeat 0 m) by (rewrite <- (rev_involutive l), F, rev_app_distr, repeat_rev; easy).
  exists k, m. rewrite <- L. split; auto. intros Q. rewrite L in N.
  destruct (rev q); [easy |]. now apply N.
Qed.
Lemma without_end_roots_value h : exists k, forall x, power_form h x = x ^ k * power_form (without_end_roots h) x.
Proof.
  destruct (end_roots h) as (k & m & E & _). exists k. intros x. rewrite E at 1.
  rewrite !power_form_app, !power_form_zeros, repeat_length. ring.
Qed.
Theorem without_end_roots_right h : (without_end_roots h = [] <-> Forall (eq 0) h) /\
  (without_end_roots h <> [] -> power_form (without_end_roots h) 0 <> 0) /\
  forall t, 0 < t < 1 -> sgn (on_unit h t) = sgn (power_form (without_end_roots h) (t / (1 - t))).
Proof.
  destruct (end_roots h) as (k & m & E & N). split; [| split].
  - split; intros H.
    + rewrite H in E. rewrite E. apply Forall_forall. intros x X. simpl in X. apply in_app_or in X.
      destruct X as [X | X]; now apply repeat_spec in X.
    + destruct (without_end_roots h) as [| a l]; [easy |]. exfalso. apply N; [easy |].
      rewrite E in H. apply Forall_app in H. destruct H as (_ & H). simpl in *. now inversion H.
  - intros H. specialize (N H). destruct (without_end_roots h); [easy |]. simpl in *. now rewrite Rmult_0_l, Rplus_0_r.
  - intros t T. destruct (without_end_roots_value h) as (j & V). destruct (on_unit_ratio h t T) as (c & C & ->).
    rewrite V. assert (0 < t / (1 - t)) by (apply Rdiv_lt_0_compat; lra).
    rewrite !sgn_multiple; auto. apply pow_lt; auto.
Qed.

(** ** regular_contact *)

(** Forms are lists of numbers, which are real. *)
Definition is_zero (x : R) : bool := if Req_EM_T x 0 then true else false.
Definition contact_at (sign_there : list R -> Z) (n2 : list R) (gs : list (list R)) : bool :=
  negb (sign_there n2 =? 0)%Z && forallb (fun f => negb (sign_there f =? -1)%Z) gs.
(** `found` and `sign_there` are what real_roots has and answers of Y without end roots. *)
Definition regular_contact (y n2 : list R) (gs : list (list R)) (found : list interval)
    (sign_there : interval -> list R -> Z) : bool :=
  if certainly_rootless (S := reals) y then false
  else if existsb (fun g => same_sign (sign_throughout (S := reals) g) negative) gs then false
  else if is_zero (hd 0 y) && contact_at (fun f => sgn (hd 0 f)) n2 gs then true
  else if is_zero (last y 0) && contact_at (fun f => sgn (last f 0)) n2 gs then true
  else if (length (without_end_roots y) <? 2)%nat then false
  else existsb (fun i => contact_at (sign_there i) n2 gs) found.

(** What real_roots answers of the roots of p in (0, oo). *)
Definition answers (p : list R) (found : list interval) (asked : list (list R)) (sign_there : interval -> list R -> Z) : Prop :=
  exists f, real_roots p f found /\ forall i g, In i found -> In g asked -> sign_at_root f (without_end_roots g) i (sign_there i g).

Lemma contact_at_true (sign_there : list R -> Z) n2 gs (value : list R -> R) :
  (forall f, In f (n2 :: gs) -> sign_there f = sgn (value f)) ->
  contact_at sign_there n2 gs = true <-> value n2 <> 0 /\ Forall (fun g => 0 <= value g) gs.
Proof.
  intros S. unfold contact_at. rewrite andb_true_iff, forallb_forall, Forall_forall.
  rewrite (S n2) by now left. rewrite negb_true_iff, Z.eqb_neq, sgn_not_0.
  split; intros (A & B); split; auto; intros g G; specialize (B g G); rewrite (S g) in * by now right.
  - apply negb_true_iff, Z.eqb_neq in B. destruct (sgn_cases (value g)) as [(L & E) | [(L & E) | (L & E)]]; try lra. now rewrite E in B.
  - apply negb_true_iff, Z.eqb_neq. destruct (sgn_cases (value g)) as [(L & ->) | [(L & ->) | (L & ->)]]; try easy; lra.
Qed.

(** The roots t = x/(1 + x) of a form, x > 0. *)
Lemma ratio_back x : 0 < x -> let t := x / (1 + x) in 0 < t < 1 /\ t / (1 - t) = x.
Proof.
  intros X t. assert (T : 0 < t < 1).
  { unfold t. split; [apply Rdiv_lt_0_compat; lra |]. apply Rmult_lt_reg_r with (1 + x); [lra |]. field_simplify; lra. }
  split; auto. unfold t. field. lra.
Qed.
Lemma value_zero x : sgn x = 0%Z <-> x = 0.
Proof. destruct (sgn_cases x) as [(L & ->) | [(L & ->) | (L & ->)]]; split; intros; easy || lra. Qed.
Lemma inner_root y t : 0 < t < 1 -> on_unit y t = 0 <-> power_form (without_end_roots y) (t / (1 - t)) = 0.
Proof. intros T. destruct (without_end_roots_right y) as (_ & _ & V). now rewrite <- value_zero, V, value_zero. Qed.

(** What is asked at the roots that are found, is asked of all roots inside. *)
Lemma asked_at_roots p found asked sign_there (test : (list R -> Z) -> bool) (holds : R -> Prop) :
  power_form p 0 <> 0 -> answers p found asked sign_there ->
  (forall t s, 0 < t < 1 -> (forall g, In g asked -> s g = sgn (on_unit g t)) -> (test s = true <-> holds t)) ->
  existsb (fun i => test (sign_there i)) found = true <->
  exists t, 0 < t < 1 /\ power_form p (t / (1 - t)) = 0 /\ holds t.
Proof.
  intros N0 (f & Real & Signs) Test.
  destruct (real_roots_right _ _ _ N0 Real) as (roots & F & _ & In_roots).
  assert (At : forall i x, In i found -> isolates f i x -> 0 < x -> test (sign_there i) = true <-> holds (x / (1 + x))).
  { intros i x I J X. destruct (ratio_back x X) as (T & E). apply Test; auto. intros g G.
    rewrite (sign_at_root_right f _ i x _ J (Signs i g I G)).
    destruct (without_end_roots_right g) as (_ & _ & Vg). rewrite Vg by auto. now rewrite E. }
  rewrite existsb_exists. split.
  - intros (i & I & H).
    assert (R : exists x, In x roots /\ isolates f i x).
    { clear - F I. induction F as [| j x l m J F IH]; [easy |]. destruct I as [<- | I]; [exists x; split; [now left | easy] |].
      destruct (IH I) as (z & Z & K). exists z. split; [now right | easy]. }
    destruct R as (x & X & J). apply In_roots in X. destruct X as (X & Z).
    destruct (ratio_back x X) as (T & E). exists (x / (1 + x)). rewrite E. repeat (split; [easy |]). now apply (At i x).
  - intros (t & T & Z & H). set (x := t / (1 - t)) in *.
    assert (X : 0 < x) by (apply Rdiv_lt_0_compat; lra).
    assert (R : In x roots) by now apply In_roots.
    assert (I : exists i, In i found /\ isolates f i x).
    { clear - F R. induction F as [| j z l m J F IH]; [easy |]. destruct R as [-> | R]; [exists j; split; [now left | easy] |].
      destruct (IH R) as (i & I & K). exists i. split; [now right | easy]. }
    destruct I as (i & I & J). exists i. split; auto. apply (At i x); auto.
    replace (x / (1 + x)) with t; auto. unfold x. field. lra.
Qed.

Definition identically_zero (y : list R) : Prop := Forall (eq 0) y.

Lemma identically_zero_value h t : identically_zero h -> on_unit h t = 0.
Proof. intros F. unfold on_unit. induction F as [| a l <- F IH]; simpl; [easy | rewrite IH; ring]. Qed.

Lemma on_unit_at_time p t : at_time (S := reals) p t = on_unit p t.
Proof. unfold at_time, on_unit. f_equal. simpl. apply map_id. Qed.

(** All G >= 0, N <> 0. *)
Definition regular_at (n2 : list R) (gs : list (list R)) (t : R) : Prop :=
  on_unit n2 t <> 0 /\ Forall (fun g => 0 <= on_unit g t) gs.

Theorem regular_contact_right y n2 gs found sign_there :
  ((2 <= length (without_end_roots y))%nat -> answers (without_end_roots y) found (n2 :: gs) sign_there) ->
  regular_contact y n2 gs found sign_there = true <->
  exists t, 0 <= t <= 1 /\ on_unit y t = 0 /\ regular_at n2 gs t /\ (identically_zero y -> t = 0 \/ t = 1).
Proof.
  intros Ans. unfold regular_contact.
  destruct (certainly_rootless (S := reals) y) eqn:Rootless.
  { split; [discriminate |]. intros (t & T & Z & _). destruct (rootless_hull _ t Rootless T). now rewrite on_unit_at_time. }
  destruct (existsb (fun g => same_sign (sign_throughout (S := reals) g) negative) gs) eqn:Out.
  { split; [discriminate |]. intros (t & T & _ & (_ & G) & _). apply existsb_exists in Out. destruct Out as (g & I & E).
    pose proof (sign_throughout_right (S := reals) g t T) as V. rewrite on_unit_at_time in V.
    rewrite Forall_forall in G. specialize (G g I). destruct (sign_throughout (S := reals) g); try discriminate.
    simpl in V. lra. }
  assert (Start : is_zero (hd 0 y) && contact_at (fun f => sgn (hd 0 f)) n2 gs = true <-> on_unit y 0 = 0 /\ regular_at n2 gs 0).
  { rewrite andb_true_iff, (contact_at_true _ n2 gs (fun f => on_unit f 0)) by (intros f _; now rewrite (proj1 (on_unit_ends f))).
    rewrite (proj1 (on_unit_ends y)). unfold is_zero, regular_at. destruct Req_EM_T; intuition discriminate. }
  assert (End : is_zero (last y 0) && contact_at (fun f => sgn (last f 0)) n2 gs = true <-> on_unit y 1 = 0 /\ regular_at n2 gs 1).
  { rewrite andb_true_iff, (contact_at_true _ n2 gs (fun f => on_unit f 1)) by (intros f _; now rewrite (proj2 (on_unit_ends f))).
    rewrite (proj2 (on_unit_ends y)). unfold is_zero, regular_at. destruct Req_EM_T; intuition discriminate. }
  destruct (is_zero (hd 0 y) && contact_at (fun f => sgn (hd 0 f)) n2 gs).
  { split; auto. intros _. destruct (proj1 Start eq_refl) as (Z & G). exists 0. repeat split; auto; try lra; apply G. }
  destruct (is_zero (last y 0) && contact_at (fun f => sgn (last f 0)) n2 gs).
  { split; auto. intros _. destruct (proj1 End eq_refl) as (Z & G). exists 1. repeat split; auto; try lra; apply G. }
  destruct (without_end_roots_right y) as (Zero & N0 & V).
  assert (Inside : (exists t, 0 <= t <= 1 /\ on_unit y t = 0 /\ regular_at n2 gs t /\ (identically_zero y -> t = 0 \/ t = 1)) <->
    without_end_roots y <> [] /\ exists t, 0 < t < 1 /\ on_unit y t = 0 /\ regular_at n2 gs t).
  { split.
    - intros (t & T & Z & G & I).
      destruct (Req_dec t 0) as [-> | A]; [discriminate (proj2 Start (conj Z G)) |].
      destruct (Req_dec t 1) as [-> | B]; [discriminate (proj2 End (conj Z G)) |]. split.
      + intros E. apply Zero in E. destruct (I E); easy.
      + exists t. repeat split; auto; try lra; apply G.
    - intros (N & t & T & Z & G). exists t. repeat split; auto; try lra; try apply G. intros I. now apply Zero in I. }
  rewrite Inside. destruct (Nat.ltb_spec (length (without_end_roots y)) 2) as [L | L].
  - split; [discriminate |]. intros (N & t & T & Z & _). exfalso. specialize (V t T). rewrite Z, sgn_0 in V.
    destruct (without_end_roots y) as [| a [| b l]]; [easy | | simpl in L; lia]. specialize (N0 N). simpl in *.
    rewrite !Rmult_0_r, Rplus_0_r in *. apply sgn_not_0 in N0. now rewrite <- V in N0.
  - assert (N : without_end_roots y <> []) by (intros E; rewrite E in L; simpl in L; lia).
    rewrite (asked_at_roots _ found (n2 :: gs) sign_there (fun s => contact_at s n2 gs) (regular_at n2 gs) (N0 N) (Ans L)).
    + split; [intros (t & T & Z & G); split; auto | intros (_ & t & T & Z & G)]; exists t;
        (split; [easy |]; split; [now apply inner_root | easy]).
    + intros t s T S. apply contact_at_true with (value := fun g => on_unit g t). exact S.
Qed.

(** ** Vertex/edge: the roots of a common factor of three quadratics *)

(** What is asked of common_factor(a, b): its roots are the common ones, and it is empty only if both are. *)
Definition common_factor (a b c : list R) : Prop :=
  (c = [] <-> a = [] /\ b = []) /\ forall x, power_form c x = 0 <-> power_form a x = 0 /\ power_form b x = 0.

Definition contact_by_roots (f0 f1 f2 b : quadratic) (on_line : list R) (found : list interval)
    (sign_there : interval -> list R -> Z) : bool :=
  if certainly_rootless (coefficients f0) then false
  else if certainly_rootless (coefficients f1) then false
  else if certainly_rootless (coefficients f2) then false
  else if touches f0 f1 f2 b c0 || touches f0 f1 f2 b c2 then true
  else match on_line with
    | [] => below_0 (c1 b) && nonpositive (4 * (c0 b * c2 b) - c1 b * c1 b)
    | [_] => false
    | _ => existsb (fun i => negb (sign_there i (coefficients b) =? 1)%Z) found
    end.

Lemma on_unit_quadratic f t : on_unit (coefficients f) t = quadratic_at f t.
Proof. rewrite <- on_unit_at_time. apply at_time_quadratic. Qed.

(** The common factor of the three, which the loop makes. *)
Definition common_of_three (f0 f1 f2 : quadratic) (on_line : list R) : Prop := exists d0 d1,
  common_factor [] (without_end_roots (coefficients f0)) d0 /\
  common_factor d0 (without_end_roots (coefficients f1)) d1 /\
  common_factor d1 (without_end_roots (coefficients f2)) on_line.

Lemma common_of_three_right f0 f1 f2 on_line : common_of_three f0 f1 f2 on_line ->
  (on_line <> [] -> power_form on_line 0 <> 0) /\
  (forall t, 0 < t < 1 -> (power_form on_line (t / (1 - t)) = 0 <-> all_vanish [f0; f1; f2] t)).
Proof.
  intros (d0 & d1 & (E0 & H0) & (E1 & H1) & (E2 & H2)). split.
  - intros N Z. apply H2 in Z. destruct Z as (Z & Z2). apply H1 in Z. destruct Z as (Z & Z1). apply H0 in Z. destruct Z as (_ & Z0).
    apply N, E2. split; [apply E1; split; [apply E0; split; [easy |] |] |];
      match goal with |- without_end_roots ?h = [] => destruct (without_end_roots_right h) as (_ & V & _);
        destruct (without_end_roots h); [easy | now destruct V] end.
  - intros t T. unfold all_vanish. rewrite !Forall_cons_iff, H2, H1, H0, <- !inner_root, !on_unit_quadratic by auto.
    simpl power_form. intuition.
Qed.

Lemma contact_by_roots_right f0 f1 f2 b on_line found sign_there : common_of_three f0 f1 f2 on_line ->
  ((2 <= length on_line)%nat -> answers on_line found [coefficients b] sign_there) ->
  contact_by_roots f0 f1 f2 b on_line found sign_there = true <-> exists t, 0 <= t <= 1 /\ meets f0 f1 f2 b t.
Proof.
  intros Common Ans. unfold contact_by_roots.
  assert (Rootless : forall f, certainly_rootless (coefficients f) = true -> In f [f0; f1; f2] ->
    false = true <-> exists t, 0 <= t <= 1 /\ meets f0 f1 f2 b t).
  { intros f C I. split; [discriminate |]. intros (t & T & V & _).
    destruct (rootless_hull _ t C T). rewrite at_time_quadratic. now apply (proj1 (Forall_forall _ _) V). }
  destruct (certainly_rootless (coefficients f0)) eqn:R0; [apply (Rootless f0); simpl; auto |].
  destruct (certainly_rootless (coefficients f1)) eqn:R1; [apply (Rootless f1); simpl; auto |].
  destruct (certainly_rootless (coefficients f2)) eqn:R2; [apply (Rootless f2); simpl; auto |].
  clear Rootless R0 R1 R2. destruct (touches_true f0 f1 f2 b) as (T0 & T1).
  destruct (touches f0 f1 f2 b c0).
  { cbn [orb]. split; auto. intros _. exists 0. split; [lra | now apply T0]. }
  destruct (touches f0 f1 f2 b c2).
  { cbn [orb]. split; auto. intros _. exists 1. split; [lra | now apply T1]. }
  cbn [orb].
  assert (Inside : (exists t, 0 <= t <= 1 /\ meets f0 f1 f2 b t) <-> exists t, 0 < t < 1 /\ meets f0 f1 f2 b t).
  { split; intros (t & T & M); exists t; split; auto; [| lra].
    destruct (Req_dec t 0) as [-> | N0]; [now apply T0 in M |].
    destruct (Req_dec t 1) as [-> | N1]; [now apply T1 in M |]. lra. }
  rewrite Inside. clear Inside. destruct (common_of_three_right _ _ _ _ Common) as (N0 & V). unfold meets in *.
  destruct on_line as [| a [| a' l]].
  - assert (All : all_vanish [f0; f1; f2] 0 /\ all_vanish [f0; f1; f2] 1).
    { destruct Common as (d0 & d1 & (E0 & _) & (E1 & _) & (E2 & _)).
      destruct (proj1 E2 eq_refl) as (-> & Z2). destruct (proj1 E1 eq_refl) as (-> & Z1). destruct (proj1 E0 eq_refl) as (_ & Z0).
      apply without_end_roots_right in Z0, Z1, Z2. unfold all_vanish. rewrite !Forall_cons_iff, <- !on_unit_quadratic.
      rewrite !identically_zero_value by easy. repeat split; constructor. }
    assert (B0 : 0 < c0 b /\ 0 < c2 b).
    { rewrite <- (proj1 (at_ends b)), <- (proj2 (at_ends b)). split; apply Rnot_le_lt; intros B.
      - discriminate (proj2 T0 (conj (proj1 All) B)).
      - discriminate (proj2 T1 (conj (proj2 All) B)). }
    destruct B0 as (B0 & B2). rewrite andb_true_iff, nonpositive_true.
    assert (E : below_0 (c1 b) = true <-> c1 b < 0) by (unfold below_0; destruct Rlt_dec; split; easy).
    rewrite E, (dips b B0 B2), <- (by_ratio (fun x => at_ratio b x <= 0)).
    split; intros (t & T & B); exists t; split; auto.
    + split; [now apply V | now apply inside_ratio].
    + destruct B as (_ & B). now apply inside_ratio.
  - split; [discriminate |]. intros (t & T & A & _). apply V in A; auto. specialize (N0 ltac:(easy)). simpl in *. lra.
  - rewrite (asked_at_roots _ found [coefficients b] sign_there (fun s => negb (s (coefficients b) =? 1)%Z)
      (fun t => quadratic_at b t <= 0) (N0 ltac:(easy)) (Ans ltac:(simpl; lia))).
    + split; intros (t & T & Z & B); exists t; (split; [easy |]; split; [now apply V | easy]).
    + intros t s T S. rewrite S by now left. rewrite on_unit_quadratic, negb_true_iff, Z.eqb_neq.
      destruct (sgn_cases (quadratic_at b t)) as [(L & ->) | [(L & ->) | (L & ->)]]; split; intros; easy || lra.
Qed.

(** `contact` of a vertex and an edge *)
Theorem vertex_edge_roots_right v e0 e1 on_line found sign_there :
  common_of_three (cross_x v e0 e1) (cross_y v e0 e1) (cross_z v e0 e1) on_line ->
  ((2 <= length on_line)%nat -> answers on_line found [coefficients (between v e0 e1)] sign_there) ->
  contact_by_roots (cross_x v e0 e1) (cross_y v e0 e1) (cross_z v e0 e1) (between v e0 e1) on_line found sign_there = true
  <-> vertex_edge_collides v e0 e1.
Proof. intros Common Ans. rewrite (contact_by_roots_right _ _ _ _ _ _ _ Common Ans), <- contact_of_quadratics. apply contact_right. Qed.

(** ** Vertex/face and edge/edge *)

Definition number_point := @moving_point reals.

Section Forms.

Variables b c p : @vector_form reals.
Hypothesis Db : degree b 1.
Hypothesis Dc : degree c 1.
Hypothesis Dp : degree p 1.

Lemma y_value t : on_unit (y_form b c p) t = det (vector_at b t) (vector_at c t) (vector_at p t).
Proof. rewrite <- on_unit_at_time. apply (forms_y b c p t Db Dc Dp). Qed.
Lemma normal_value t : on_unit (normal_squared b c) t = square_normal (vector_at b t) (vector_at c t).
Proof.
  rewrite <- on_unit_at_time. destruct (cross_at b c 1 1 t Db Dc) as (E & D).
  destruct (dot_at _ _ 2 2 t D D) as (F & _). unfold normal_squared, square_normal. now rewrite F, E.
Qed.
Lemma normal_not_zero t : on_unit (normal_squared b c) t <> 0 <-> cross (vector_at b t) (vector_at c t) <> origin.
Proof.
  rewrite normal_value. split; intros N E; apply N; [now apply square_origin | now apply square_0].
Qed.
Lemma all_nonnegative gs t : Forall (fun g => 0 <= on_unit g t) gs <->
  Forall (Rle 0) (map (fun g => at_time (S := reals) g t) gs).
Proof. rewrite Forall_map. split; apply Forall_impl; intros g; now rewrite on_unit_at_time. Qed.
Lemma face_weights t : Forall (fun g => 0 <= on_unit g t) (inside_face_forms b c p) <->
  0 <= weight_2 (vector_at b t) (vector_at c t) (vector_at p t) /\
  0 <= weight_1 (vector_at b t) (vector_at c t) (vector_at p t) /\
  0 <= weight_0 (vector_at b t) (vector_at c t) (vector_at p t).
Proof.
  destruct (forms_weights b c p t Db Dc Dp) as (W & _).
  rewrite all_nonnegative, W, !Forall_cons_iff. intuition.
Qed.
Lemma edges_weights t : Forall (fun g => 0 <= on_unit g t) (inside_edges_forms b c p) <->
  0 <= on_a (vector_at b t) (vector_at c t) (vector_at p t) /\
  0 <= square_normal (vector_at b t) (vector_at c t) - on_a (vector_at b t) (vector_at c t) (vector_at p t) /\
  0 <= on_b (vector_at b t) (vector_at c t) (vector_at p t) /\
  0 <= square_normal (vector_at b t) (vector_at c t) - on_b (vector_at b t) (vector_at c t) (vector_at p t).
Proof.
  destruct (forms_weights b c p t Db Dc Dp) as (_ & W & _).
  rewrite all_nonnegative, W, !Forall_cons_iff. intuition.
Qed.

End Forms.

Section Decisions.

Variables (found : list interval) (sign_there : interval -> list R -> Z).
(** What contact_at_border answers. *)
Variable border : bool.

(** What real_roots has and answers, where it is asked. *)
Definition roots_asked (y n2 : list R) (gs : list (list R)) : Prop :=
  (2 <= length (without_end_roots y))%nat -> answers (without_end_roots y) found (n2 :: gs) sign_there.

Section Face.

Variables v f0 f1 f2 : number_point.
Let b := difference f1 f0.
Let c := difference f2 f0.
Let p := difference v f0.

Lemma face_regular t : on_unit (y_form b c p) t = 0 /\ regular_at (normal_squared b c) (inside_face_forms b c p) t <->
  face_regular_at (exact_motion v) (exact_motion f0) (exact_motion f1) (exact_motion f2) t.
Proof.
  destruct (degrees_face v f0 f1 f2) as (Db & Dc & Dp). unfold regular_at, face_regular_at, regular_face.
  rewrite y_value, normal_not_zero, face_weights by easy. unfold b, c, p. rewrite !difference_at. cbv zeta. tauto.
Qed.

(** `contact` of a vertex and a face *)
Definition reference_face : bool :=
  regular_contact (y_form b c p) (normal_squared b c) (inside_face_forms b c p) found sign_there || border.

Theorem reference_face_right :
  roots_asked (y_form b c p) (normal_squared b c) (inside_face_forms b c p) ->
  (border = true <-> face_border_collides (exact_motion v) (exact_motion f0) (exact_motion f1) (exact_motion f2)) ->
  reference_face = true <-> face_collides v f0 f1 f2.
Proof.
  intros Asked Border. unfold reference_face, face_collides. rewrite orb_true_iff, (regular_contact_right _ _ _ _ _ Asked), Border.
  split.
  - intros [(t & T & Z & G & _) | H]; apply vertex_face_union; [left | now right]. exists t. split; auto. now apply face_regular.
  - intros H. destruct (Forall_dec (eq 0) (Req_EM_T 0) (y_form b c p)) as [I | I].
    + apply face_coplanar in H.
      * destruct H as [H | H]; [left | now right]. exists 0. split; [lra |]. rewrite <- and_assoc. split; [| now left].
        apply face_regular, inside_face_regular; auto.
        rewrite <- !difference_at, <- y_value by easy. now apply identically_zero_value.
      * intros t T. rewrite <- !difference_at, <- y_value by easy. now apply identically_zero_value.
    + apply vertex_face_union in H. destruct H as [(t & T & H) | H]; [left | now right].
      apply face_regular in H. exists t. split; auto. split; [apply H |]. split; [apply H |]. now intros K.
Qed.

End Face.

Section Edges.

Variables a0 a1 b0 b1 : number_point.
Let b := difference a1 a0.
Let c := difference b1 b0.
Let p := difference b0 a0.

Lemma edges_regular t : on_unit (y_form b c p) t = 0 /\ regular_at (normal_squared b c) (inside_edges_forms b c p) t <->
  edges_regular_at (exact_motion a0) (exact_motion a1) (exact_motion b0) (exact_motion b1) t.
Proof.
  destruct (degrees_edges a0 a1 b0 b1) as (Db & Dc & Dp). unfold regular_at, edges_regular_at, regular_edges.
  rewrite y_value, normal_not_zero, edges_weights by easy. unfold b, c, p. rewrite !difference_at. cbv zeta. intuition lra.
Qed.

Definition reference_edges : bool :=
  regular_contact (y_form b c p) (normal_squared b c) (inside_edges_forms b c p) found sign_there || border.

Theorem reference_edges_right :
  roots_asked (y_form b c p) (normal_squared b c) (inside_edges_forms b c p) ->
  (border = true <-> edges_border_collides (exact_motion a0) (exact_motion a1) (exact_motion b0) (exact_motion b1)) ->
  reference_edges = true <-> edges_collide a0 a1 b0 b1.
Proof.
  intros Asked Border. unfold reference_edges, edges_collide. rewrite orb_true_iff, (regular_contact_right _ _ _ _ _ Asked), Border.
  split.
  - intros [(t & T & Z & G & _) | H]; apply edge_edge_union; [left | now right]. exists t. split; auto. now apply edges_regular.
  - intros H. destruct (Forall_dec (eq 0) (Req_EM_T 0) (y_form b c p)) as [I | I].
    + apply edges_coplanar in H.
      * destruct H as [H | H]; [left | now right]. exists 0. split; [lra |]. rewrite <- and_assoc. split; [| now left].
        apply edges_regular, inside_edges_regular; auto.
        rewrite <- !difference_at, <- y_value by easy. now apply identically_zero_value.
      * intros t T. rewrite <- !difference_at, <- y_value by easy. now apply identically_zero_value.
    + apply edge_edge_union in H. destruct H as [(t & T & H) | H]; [left | now right].
      apply edges_regular in H. exists t. split; auto. split; [apply H |]. split; [apply H |]. now intros K.
Qed.

End Edges.

End Decisions.
