(** The last stage of the floating-point filter: ccd/subdivision.hpp on control values, that is
    plain Bernstein coefficients (include/errbound/control_values.hpp), over every scalar. There a
    number stands for a control value known to within the error that all parts share.

    Results: halves_cubic, halves_quartic       halves are the parts on [0, 1/2] and [1/2, 1]
             subdivision_separate   the answer "separate": where Y = 0 in [0, 1], some G is negative
             subdivision_collides   the answer "collides": Y = 0 and all G > 0 at some t in [0, 1] *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Errbound Require Import Sign Bernstein.
Import ListNotations.
Open Scope R_scope.

Inductive outcome := separate | collides | undecided.

Section Subdivision.

Context {S : scalar}.
Variable midpoint : S -> S -> S.  (** (a + b)*S(0.5) *)
Hypothesis exact_midpoint : forall a b, exact (midpoint a b) = (exact a + exact b) / 2.

(** The polynomial of the control values p. *)
Definition control_at (p : list S) (t : R) : R := form (scaled_coefficients (map exact p)) (1 - t) t.

(** halves: each pass of the loop replaces the row by the midpoints of neighbours; the left half has
    the first of each row, the right half the last. *)
Fixpoint next_row (p : list S) : list S :=
  match p with a :: (b :: _) as l => midpoint a b :: next_row l | _ => [] end.
Fixpoint rows (n : nat) (p : list S) : list (list S) :=
  match n with O => [] | Datatypes.S n => p :: rows n (next_row p) end.
Definition halves (p : list S) : list S * list S :=
  (map (fun row => hd (whole 0) row) (rows (length p) p),
   rev (map (fun row => last row (whole 0)) (rows (length p) p))).

Lemma control_cubic a b c d t : control_at [a; b; c; d] t = form [exact a; 3 * exact b; 3 * exact c;
  exact d] (1 - t) t.
Proof. unfold control_at. cbn [map]. now rewrite scaled_cubic. Qed.
Lemma control_quartic a b c d e t : control_at [a; b; c; d; e] t =
  form [exact a; 4 * exact b; 6 * exact c; 4 * exact d; exact e] (1 - t) t.
Proof. unfold control_at. cbn [map]. now rewrite scaled_quartic. Qed.

Theorem halves_cubic p t : length p = 4%nat ->
  control_at (fst (halves p)) t = control_at p (t / 2) /\ control_at (snd (halves p)) t = control_at p
    ((1 + t) / 2) /\
  length (fst (halves p)) = 4%nat /\ length (snd (halves p)) = 4%nat.
Proof.
  destruct p as [| a [| b [| c [| d [|]]]]]; try discriminate. intros _. unfold halves.
  cbn [length rows next_row map hd last fst snd rev app]. rewrite !control_cubic.
  repeat rewrite exact_midpoint. simpl. repeat split; field.
Qed.
Theorem halves_quartic p t : length p = 5%nat ->
  control_at (fst (halves p)) t = control_at p (t / 2) /\ control_at (snd (halves p)) t = control_at p
    ((1 + t) / 2) /\
  length (fst (halves p)) = 5%nat /\ length (snd (halves p)) = 5%nat.
Proof.
  destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try discriminate. intros _. unfold halves.
  cbn [length rows next_row map hd last fst snd rev app]. rewrite !control_quartic.
  repeat rewrite exact_midpoint. simpl. repeat split; field.
Qed.

(** above, below, changes_sign *)
Definition above (p : list S) : bool := forallb (fun a => same_sign (sign_of a) positive) p.
Definition below (p : list S) : bool := forallb (fun a => same_sign (sign_of a) negative) p.
Definition changes_sign (p : list S) : bool :=
  match sign_of (hd (whole 0) p), sign_of (last p (whole 0)) with
  | positive, negative | negative, positive => true
  | _, _ => false
  end.

(** The loop: a part's left half is asked before its right half, and the first answer but "separate"
    ends it. `hopeless` is the test that hands parts on before the last halving. *)
Variable hopeless : nat -> list S -> bool.
Fixpoint subdivide (halvings_left : nat) (y : list S) (gs : list (list S)) : outcome :=
  if (above y || below y) || existsb below gs then separate
  else if changes_sign y && forallb above gs then collides
  else match halvings_left with
    | O => undecided
    | Datatypes.S more =>
        if hopeless more y then undecided
        else
          match subdivide more (fst (halves y)) (map (fun g => fst (halves g)) gs) with
          | separate => subdivide more (snd (halves y)) (map (fun g => snd (halves g)) gs)
          | answer => answer
          end
    end.

Lemma signs_of_all (s : sign) (p : list S) (a : S) : forallb (fun a => same_sign (sign_of a) s) p = true
  -> In a p ->
  sign_is_right s (exact a).
Proof.
  intros F I. rewrite forallb_forall in F. specialize (F a I). pose proof (sign_right S a) as A.
  destruct (sign_of a), s; simpl in *; easy.
Qed.
Lemma above_positive p t : length p = 4%nat \/ length p = 5%nat -> above p = true -> 0 <= t <= 1 -> 0 <
  control_at p t.
Proof.
  intros L A T. assert (H : forall a, In a p -> 0 < exact a) by (intros a I; exact (signs_of_all
    positive p a A I)).
  destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try (destruct L; discriminate); simpl in H;
    [rewrite control_cubic | rewrite control_quartic]; (apply hull_positive; [| lra | lra | lra]);
    repeat apply Forall_cons; try apply Forall_nil;
    repeat (apply Rmult_lt_0_compat; [lra |]); apply H; auto 7.
Qed.
Lemma below_negative p t : length p = 4%nat \/ length p = 5%nat -> below p = true -> 0 <= t <= 1 ->
  control_at p t < 0.
Proof.
  intros L A T. assert (H : forall a, In a p -> 0 < - exact a)
    by (intros a I; pose proof (signs_of_all negative p a A I) as N; simpl in N; lra).
  enough (0 < - control_at p t) by lra. unfold control_at. rewrite <- form_opp.
  destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try (destruct L; discriminate); simpl in H; cbn
    [map];
    [rewrite scaled_cubic | rewrite scaled_quartic]; cbn [map]; (apply hull_positive; [| lra | lra |
      lra]);
    repeat apply Forall_cons; try apply Forall_nil; rewrite ?Ropp_mult_distr_r;
    repeat (apply Rmult_lt_0_compat; [lra |]); apply H; auto 7.
Qed.

Lemma root_between p : length p = 4%nat -> changes_sign p = true -> exists t, 0 <= t <= 1 /\ control_at
  p t = 0.
Proof.
  intros L C. destruct (IVT_cor (control_at p) 0 1) as (t & T & Z); eauto; [| lra |].
  - intros t. apply derivable_continuous_pt. exists (slope (scaled_coefficients (map exact p)) t). apply
      derivable_form.
  - destruct p as [| a [| b [| c [| d [|]]]]]; try discriminate. rewrite !control_cubic. simpl.
    unfold changes_sign in C. simpl in C. pose proof (sign_right S a) as A. pose proof (sign_right S d)
      as D.
    destruct (sign_of a), (sign_of d); try discriminate; simpl in *; nra.
Qed.

Lemma subdivision_right n : forall y gs, length y = 4%nat -> Forall (fun g => length g = 5%nat) gs ->
  (subdivide n y gs = separate -> forall t, 0 <= t <= 1 -> control_at y t = 0 ->
     exists g, In g gs /\ control_at g t < 0) /\
  (subdivide n y gs = collides -> exists t, 0 <= t <= 1 /\ control_at y t = 0 /\
     forall g, In g gs -> 0 < control_at g t).
Proof.
  induction n as [| n IH]; intros y gs L F; cbn [subdivide].
  all: destruct ((above y || below y) || existsb below gs) eqn:X.
  1, 3: split; [intros _ t T Z | easy]; apply orb_prop in X; destruct X as [X | X];
    [apply orb_prop in X; destruct X as [X | X];
       [pose proof (above_positive y t (or_introl L) X T) | pose proof (below_negative y t (or_introl L)
         X T)]; lra |
     apply existsb_exists in X; destruct X as (g & I & N); exists g; split; auto;
       apply below_negative; auto; right; now apply (proj1 (Forall_forall _ _) F)].
  all: destruct (changes_sign y && forallb above gs) eqn:Q.
  1, 3: split; [easy | intros _]; apply andb_prop in Q; destruct Q as (Q & A); rewrite forallb_forall in
    A;
    destruct (root_between y L Q) as (t & T & Z); exists t; repeat split; auto; try apply T;
    intros g I; apply above_positive; auto; right; now apply (proj1 (Forall_forall _ _) F).
  - split; discriminate.
  - destruct (hopeless n y); [split; discriminate |].
    destruct (halves_cubic y 0 L) as (_ & _ & L0 & L1).
    assert (F0 : Forall (fun g => length g = 5%nat) (map (fun g => fst (halves g)) gs))
      by (rewrite Forall_map; eapply Forall_impl; [| exact F]; simpl; intros g Lg; apply (halves_quartic
        g 0 Lg)).
    assert (F1 : Forall (fun g => length g = 5%nat) (map (fun g => snd (halves g)) gs))
      by (rewrite Forall_map; eapply Forall_impl; [| exact F]; simpl; intros g Lg; apply (halves_quartic
        g 0 Lg)).
    destruct (IH _ _ L0 F0) as (No0 & Yes0). destruct (IH _ _ L1 F1) as (No1 & Yes1). rewrite
      Forall_forall in F.
    assert (Left : subdivide n (fst (halves y)) (map (fun g => fst (halves g)) gs) = collides ->
      exists t, 0 <= t <= 1 /\ control_at y t = 0 /\ forall g, In g gs -> 0 < control_at g t).
    { intros E. destruct (Yes0 E) as (t & T & Z & G). exists (t / 2). split; [lra |]. split.
      - now rewrite <- (proj1 (halves_cubic y t L)).
      - intros g I. rewrite <- (proj1 (halves_quartic g t (F g I))). apply G. apply in_map_iff. eauto. }
    assert (Right : subdivide n (snd (halves y)) (map (fun g => snd (halves g)) gs) = collides ->
      exists t, 0 <= t <= 1 /\ control_at y t = 0 /\ forall g, In g gs -> 0 < control_at g t).
    { intros E. destruct (Yes1 E) as (t & T & Z & G). exists ((1 + t) / 2). split; [lra |]. split.
      - now rewrite <- (proj1 (proj2 (halves_cubic y t L))).
      - intros g I. rewrite <- (proj1 (proj2 (halves_quartic g t (F g I)))). apply G. apply in_map_iff.
          eauto. }
    destruct (subdivide n (fst (halves y)) (map (fun g => fst (halves g)) gs)) eqn:E0;
      [| split; [discriminate | auto] | split; discriminate].
    split; auto. intros E1 t T Z. destruct (Rle_or_lt t (1 / 2)) as [H | H].
    + destruct (No0 eq_refl (2 * t)) as (f & I & N); [lra | |].
      { rewrite (proj1 (halves_cubic y (2 * t) L)). now replace (2 * t / 2) with t by field. }
      apply in_map_iff in I. destruct I as (g & <- & I). exists g. split; auto.
      rewrite (proj1 (halves_quartic g (2 * t) (F g I))) in N. now replace (2 * t / 2) with t in N by
        field.
    + destruct (No1 E1 (2 * t - 1)) as (f & I & N); [lra | |].
      { rewrite (proj1 (proj2 (halves_cubic y (2 * t - 1) L))). now replace ((1 + (2 * t - 1)) / 2) with
          t by field. }
      apply in_map_iff in I. destruct I as (g & <- & I). exists g. split; auto.
      rewrite (proj1 (proj2 (halves_quartic g (2 * t - 1) (F g I)))) in N.
      now replace ((1 + (2 * t - 1)) / 2) with t in N by field.
Qed.

Theorem subdivision_separate n y gs t : length y = 4%nat -> Forall (fun g => length g = 5%nat) gs ->
  subdivide n y gs = separate -> 0 <= t <= 1 -> control_at y t = 0 -> exists g, In g gs /\ control_at g
    t < 0.
Proof. intros L F E. now apply (proj1 (subdivision_right n y gs L F)). Qed.
Theorem subdivision_collides n y gs : length y = 4%nat -> Forall (fun g => length g = 5%nat) gs ->
  subdivide n y gs = collides ->
  exists t, 0 <= t <= 1 /\ control_at y t = 0 /\ forall g, In g gs -> 0 < control_at g t.
Proof. intros L F E. now apply (proj2 (subdivision_right n y gs L F)). Qed.

End Subdivision.
