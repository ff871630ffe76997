(** The last stage of the floating-point filter (ccd/exact/static_filter/subdivision.hpp) on control values, which
    are plain Bernstein coefficients (include/errbound/roots/control_values.hpp). They are numbers that stand for
    real ones exactly, or within an error (FilterStages.v) that midpoints may increase. Results:
        halves_cubic, halves_quartic   halves are the polynomials on [0, 1/2] and [1/2, 1]
        subdivision_separate   the answer "separate": wherever Y = 0 in [0, 1], some G is negative
        subdivision_collides   the answer "collides": Y = 0 and all G > 0 at some t in [0, 1] *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Errbound Require Import Sign Bernstein.
Import ListNotations.
Open Scope R_scope.

Inductive outcome := separate | collides | undecided.

(** halves: each pass of the loop replaces the row by the midpoints of neighbours. The left half has the first of
    each row, the right half the last. *)
Section Halves.

Context {S : Type}.
Variable none : S.  (** of no row *)
Variable midpoint : S -> S -> S.

Fixpoint next_row (p : list S) : list S :=
  match p with a :: (b :: _) as l => midpoint a b :: next_row l | _ => [] end.
Fixpoint rows (n : nat) (p : list S) : list (list S) :=
  match n with O => [] | Datatypes.S n => p :: rows n (next_row p) end.
Definition halves (p : list S) : list S * list S :=
  (map (fun row => hd none row) (rows (length p) p),
   rev (map (fun row => last row none) (rows (length p) p))).

End Halves.

(** ** Polynomials *)

(** The polynomial of the control values p. *)
Definition control_at (p : list R) (t : R) : R := form (scaled_coefficients p) (1 - t) t.
Definition exact_midpoint (a b : R) : R := (a + b) / 2.
Notation exact_halves := (halves 0 exact_midpoint).

Lemma control_cubic a b c d t : control_at [a; b; c; d] t = form [a; 3 * b; 3 * c; d] (1 - t) t.
Proof. unfold control_at. now rewrite scaled_cubic. Qed.
Lemma control_quartic a b c d e t : control_at [a; b; c; d; e] t =
  form [a; 4 * b; 6 * c; 4 * d; e] (1 - t) t.
Proof. unfold control_at. now rewrite scaled_quartic. Qed.

Theorem halves_cubic p t : length p = 4%nat ->
  control_at (fst (exact_halves p)) t = control_at p (t / 2) /\
  control_at (snd (exact_halves p)) t = control_at p ((1 + t) / 2) /\
  length (fst (exact_halves p)) = 4%nat /\ length (snd (exact_halves p)) = 4%nat.
Proof.
  destruct p as [| a [| b [| c [| d [|]]]]]; try discriminate. intros _. unfold halves.
  cbn [length rows next_row map hd last fst snd rev app]. rewrite !control_cubic.
  unfold exact_midpoint. simpl. repeat split; field.
Qed.
Theorem halves_quartic p t : length p = 5%nat ->
  control_at (fst (exact_halves p)) t = control_at p (t / 2) /\
  control_at (snd (exact_halves p)) t = control_at p ((1 + t) / 2) /\
  length (fst (exact_halves p)) = 5%nat /\ length (snd (exact_halves p)) = 5%nat.
Proof.
  destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try discriminate. intros _. unfold halves.
  cbn [length rows next_row map hd last fst snd rev app]. rewrite !control_quartic.
  unfold exact_midpoint. simpl. repeat split; field.
Qed.

Lemma control_continuous p : continuity (control_at p).
Proof.
  intros t. apply derivable_continuous_pt. exists (slope (scaled_coefficients p) t). apply derivable_form.
Qed.
Lemma all_positive p t : length p = 4%nat \/ length p = 5%nat -> Forall (Rlt 0) p -> 0 <= t <= 1 ->
  0 < control_at p t.
Proof.
  intros L F T. rewrite Forall_forall in F.
  destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try (destruct L; discriminate); simpl in F;
    [rewrite control_cubic | rewrite control_quartic]; (apply hull_positive; [| lra | lra | lra]);
    repeat apply Forall_cons; try apply Forall_nil;
    repeat (apply Rmult_lt_0_compat; [lra |]); apply F; auto 7.
Qed.
Lemma all_negative p t : length p = 4%nat \/ length p = 5%nat -> Forall (fun a => a < 0) p -> 0 <= t <= 1 ->
  control_at p t < 0.
Proof.
  intros L F T. enough (0 < - control_at p t) by lra. unfold control_at. rewrite <- form_opp.
  rewrite Forall_forall in F.
  assert (G : forall a, In a p -> 0 < - a) by (intros a I; specialize (F a I); lra).
  destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try (destruct L; discriminate); simpl in G; cbn [map];
    [rewrite scaled_cubic | rewrite scaled_quartic]; cbn [map]; (apply hull_positive; [| lra | lra | lra]);
    repeat apply Forall_cons; try apply Forall_nil; rewrite ?Ropp_mult_distr_r;
    repeat (apply Rmult_lt_0_compat; [lra |]); apply G; auto 7.
Qed.

Lemma same_length {A B : Type} {P : A -> B -> Prop} {p q} : Forall2 P p q -> length p = length q.
Proof. intros F. induction F; simpl; congruence. Qed.

Section Subdivision.

Context {S : Type} (none : S).
Variable midpoint : S -> S -> S.  (** (a + b)*S(0.5) *)
Notation halves := (halves none midpoint).

(** Signs of numbers of one kind, and the real numbers that they stand for after some midpoints: signs are right for
    up to `most` midpoints. *)
Record reads (sign_of : S -> sign) (stands : nat -> S -> R -> Prop) (most : nat) : Prop := {
  reads_more : forall i j a x, (i <= j)%nat -> stands i a x -> stands j a x;
  reads_midpoint : forall i a b x y, stands i a x -> stands i b y ->
    stands (Datatypes.S i) (midpoint a b) (exact_midpoint x y);
  reads_sign : forall i a x, (i <= most)%nat -> stands i a x -> sign_is_right (sign_of a) x
}.

(** above, below, changes_sign *)
Definition above (sign_of : S -> sign) (p : list S) : bool :=
  forallb (fun a => same_sign (sign_of a) positive) p.
Definition below (sign_of : S -> sign) (p : list S) : bool :=
  forallb (fun a => same_sign (sign_of a) negative) p.
Definition changes_sign (sign_of : S -> sign) (p : list S) : bool :=
  match sign_of (hd none p), sign_of (last p none) with
  | positive, negative | negative, positive => true
  | _, _ => false
  end.

Section OneKind.

Context (sign_of : S -> sign) (stands : nat -> S -> R -> Prop) (most : nat) (signs_read : reads sign_of stands most).

Lemma signs_of_all s i p P : (i <= most)%nat -> Forall2 (stands i) p P ->
  forallb (fun a => same_sign (sign_of a) s) p = true -> Forall (sign_is_right s) P.
Proof.
  intros L F H. induction F as [| a x p P A F IH]; [constructor |].
  simpl in H. apply andb_prop in H. destruct H as (H & K). constructor; auto.
  pose proof (reads_sign _ _ _ signs_read i a x L A) as Q. destruct (sign_of a), s; simpl in *; easy.
Qed.
Lemma above_positive i p P t : length p = 4%nat \/ length p = 5%nat -> (i <= most)%nat ->
  Forall2 (stands i) p P -> above sign_of p = true -> 0 <= t <= 1 -> 0 < control_at P t.
Proof.
  intros L I F A T. rewrite (same_length F) in L. apply all_positive; auto.
  exact (signs_of_all positive i p P I F A).
Qed.
Lemma below_negative i p P t : length p = 4%nat \/ length p = 5%nat -> (i <= most)%nat ->
  Forall2 (stands i) p P -> below sign_of p = true -> 0 <= t <= 1 -> control_at P t < 0.
Proof.
  intros L I F A T. rewrite (same_length F) in L. apply all_negative; auto.
  exact (signs_of_all negative i p P I F A).
Qed.
Lemma root_between i p P : length p = 4%nat -> (i <= most)%nat -> Forall2 (stands i) p P ->
  changes_sign sign_of p = true -> exists t, 0 <= t <= 1 /\ control_at P t = 0.
Proof.
  intros L I F C. enough (control_at P 0 * control_at P 1 <= 0) as D.
  { destruct (IVT_cor (control_at P) 0 1 (control_continuous P) Rle_0_1 D) as (t & T & Z). eauto. }
  destruct p as [| a' [| b' [| c' [| d' [|]]]]]; try discriminate.
  inversion F as [| ? a ? ? A F1]. inversion F1 as [| ? b ? ? _ F2]. inversion F2 as [| ? c ? ? _ F3].
  inversion F3 as [| ? d ? ? D F4]. inversion F4. rewrite !control_cubic. simpl.
  unfold changes_sign in C. simpl in C. apply (reads_sign _ _ _ signs_read i) in A, D; auto.
  destruct (sign_of a'), (sign_of d'); try discriminate; simpl in *; nra.
Qed.

(** Halves of control values stand for the halves of their real polynomials. *)
Lemma halves_stand i p P : length p = 4%nat \/ length p = 5%nat -> Forall2 (stands i) p P ->
  let n := (i + (length p - 1))%nat in
  Forall2 (stands n) (fst (halves p)) (fst (exact_halves P)) /\
  Forall2 (stands n) (snd (halves p)) (snd (exact_halves P)) /\
  length (fst (halves p)) = length p /\ length (snd (halves p)) = length p.
Proof.
  intros L F n.
  assert (M : forall i a b x y, stands i a x -> stands i b y ->
    stands (Datatypes.S i) (midpoint a b) (exact_midpoint x y)) by apply (reads_midpoint _ _ _ signs_read).
  assert (K : forall j a x, (j <= n)%nat -> stands j a x -> stands n a x)
    by (intros j a x; apply (reads_more _ _ _ signs_read)).
  assert (Q : forall p, length p = 4%nat \/ length p = 5%nat ->
    length (fst (halves p)) = length p /\ length (snd (halves p)) = length p).
  { intros [| a [| b [| c [| d [| e [|]]]]]] H; try (destruct H; discriminate); split; reflexivity. }
  split; [| split; [| now apply Q]]; clear Q; subst n;
    destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try (destruct L; discriminate);
    repeat match goal with H : Forall2 _ (_ :: _) _ |- _ => inversion_clear H
                         | H : Forall2 _ [] _ |- _ => inversion_clear H end;
    cbn [Subdivision.halves length rows next_row map hd last fst snd rev app] in *;
    repeat apply Forall2_cons; try apply Forall2_nil;
    first [apply (K i); [lia | now auto] | apply (K (Datatypes.S i)); [lia | now auto 10] |
           apply (K (Datatypes.S (Datatypes.S i))); [lia | now auto 20] | apply (K (Datatypes.S
             (Datatypes.S (Datatypes.S i)))); [lia | now auto 20] |
           apply (K (Datatypes.S (Datatypes.S (Datatypes.S (Datatypes.S i))))); [lia | now auto 40]].
Qed.

End OneKind.

(** The loop: the left half of an interval is tested before its right half, and the first answer except "separate"
    ends it. `hopeless` gives intervals to the next stage before the last halving. *)
Context (sign_y sign_g : S -> sign) (hopeless : nat -> list S -> bool).
Fixpoint subdivide (halvings_left : nat) (y : list S) (gs : list (list S)) : outcome :=
  if (above sign_y y || below sign_y y) || existsb (below sign_g) gs then separate
  else if changes_sign sign_y y && forallb (above sign_g) gs then collides
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

Context (stands_y stands_g : nat -> S -> R -> Prop) (max_y max_g : nat) (reads_y : reads sign_y stands_y max_y)
  (reads_g : reads sign_g stands_g max_g).

Definition quartics (j : nat) (gs : list (list S)) (Gs : list (list R)) : Prop :=
  Forall2 (fun g G => length g = 5%nat /\ Forall2 (stands_g j) g G) gs Gs.
Lemma quartics_halves j gs Gs : quartics j gs Gs ->
  quartics (j + 4) (map (fun g => fst (halves g)) gs) (map (fun G => fst (exact_halves G)) Gs) /\
  quartics (j + 4) (map (fun g => snd (halves g)) gs) (map (fun G => snd (exact_halves G)) Gs).
Proof.
  intros Q. induction Q as [| g G gs Gs (L & F) Q (IH1 & IH2)]; [split; constructor |].
  destruct (halves_stand _ _ _ reads_g j g G (or_intror L) F) as (A & B & LA & LB).
  rewrite L in *. cbn [Nat.sub] in A, B. split; constructor; auto.
Qed.
(** Each g has an exact polynomial, and each polynomial a g. *)
Lemma quartics_in j gs Gs : quartics j gs Gs ->
  (forall g, In g gs -> exists G, In G Gs /\ length g = 5%nat /\ Forall2 (stands_g j) g G) /\
  (forall G, In G Gs -> exists g, In g gs /\ length g = 5%nat /\ Forall2 (stands_g j) g G).
Proof.
  intros Q. induction Q as [| g G gs Gs (L & F) Q (IH1 & IH2)]; [split; easy |].
  split; intros f [<- | I].
  - exists G. simpl. auto.
  - destruct (IH1 f I) as (H & K & P). exists H. simpl. auto.
  - exists g. simpl. auto.
  - destruct (IH2 f I) as (H & K & P). exists H. simpl. auto.
Qed.

Lemma subdivision_right n : forall i j y Y gs Gs, length y = 4%nat -> Forall2 (stands_y i) y Y ->
  quartics j gs Gs -> (i + 3 * n <= max_y)%nat -> (j + 4 * n <= max_g)%nat ->
  (subdivide n y gs = separate -> forall t, 0 <= t <= 1 -> control_at Y t = 0 ->
     exists G, In G Gs /\ control_at G t < 0) /\
  (subdivide n y gs = collides -> exists t, 0 <= t <= 1 /\ control_at Y t = 0 /\
     forall G, In G Gs -> 0 < control_at G t).
Proof.
  induction n as [| n IH]; intros i j y Y gs Gs L F Q MY MG; cbn [subdivide];
    destruct (quartics_in j gs Gs Q) as (Q1 & Q2).
  all: destruct ((above sign_y y || below sign_y y) || existsb (below sign_g) gs) eqn:X.
  1, 3: split; [intros _ t T Z | easy]; apply orb_prop in X; destruct X as [X | X];
    [apply orb_prop in X; destruct X as [X | X];
       [pose proof (above_positive _ _ _ reads_y i y Y t (or_introl L) ltac:(lia) F X T) |
        pose proof (below_negative _ _ _ reads_y i y Y t (or_introl L) ltac:(lia) F X T)]; lra |
     apply existsb_exists in X; destruct X as (g & I & N); destruct (Q1 g I) as (G & IG & LG & FG);
       exists G; split; auto;
       exact (below_negative _ _ _ reads_g j g G t (or_intror LG) ltac:(lia) FG N T)].
  all: destruct (changes_sign sign_y y && forallb (above sign_g) gs) eqn:C.
  1, 3: split; [easy | intros _]; apply andb_prop in C; destruct C as (C & A); rewrite forallb_forall in A;
    destruct (root_between _ _ _ reads_y i y Y L ltac:(lia) F C) as (t & T & Z); exists t; repeat split; auto;
      try apply T;
    intros G IG; destruct (Q2 G IG) as (g & I & LG & FG);
    exact (above_positive _ _ _ reads_g j g G t (or_intror LG) ltac:(lia) FG (A g I) T).
  - split; discriminate.
  - destruct (hopeless n y); [split; discriminate |].
    assert (LY : length Y = 4%nat) by now rewrite <- (same_length F).
    assert (LG : forall G, In G Gs -> length G = 5%nat).
    { intros G IG. destruct (Q2 G IG) as (g & _ & Lg & Fg). now rewrite <- (same_length Fg). }
    destruct (halves_stand _ _ _ reads_y i y Y (or_introl L) F) as (F0 & F1 & L0 & L1).
    rewrite L in *. cbn [Nat.sub] in F0, F1. destruct (quartics_halves j gs Gs Q) as (G0 & G1).
    destruct (IH _ _ _ _ _ _ L0 F0 G0 ltac:(lia) ltac:(lia)) as (No0 & Yes0).
    destruct (IH _ _ _ _ _ _ L1 F1 G1 ltac:(lia) ltac:(lia)) as (No1 & Yes1).
    assert (Left : subdivide n (fst (halves y)) (map (fun g => fst (halves g)) gs) = collides ->
      exists t, 0 <= t <= 1 /\ control_at Y t = 0 /\ forall G, In G Gs -> 0 < control_at G t).
    { intros E. destruct (Yes0 E) as (t & T & Z & P). exists (t / 2). split; [lra |]. split.
      - now rewrite <- (proj1 (halves_cubic Y t LY)).
      - intros G I. rewrite <- (proj1 (halves_quartic G t (LG G I))). apply P. apply in_map_iff. eauto. }
    assert (Right : subdivide n (snd (halves y)) (map (fun g => snd (halves g)) gs) = collides ->
      exists t, 0 <= t <= 1 /\ control_at Y t = 0 /\ forall G, In G Gs -> 0 < control_at G t).
    { intros E. destruct (Yes1 E) as (t & T & Z & P). exists ((1 + t) / 2). split; [lra |]. split.
      - now rewrite <- (proj1 (proj2 (halves_cubic Y t LY))).
      - intros G I. rewrite <- (proj1 (proj2 (halves_quartic G t (LG G I)))). apply P. apply in_map_iff.
        eauto. }
    destruct (subdivide n (fst (halves y)) (map (fun g => fst (halves g)) gs)) eqn:E0;
      [| split; [discriminate | auto] | split; discriminate].
    split; auto. intros E1 t T Z. destruct (Rle_or_lt t (1 / 2)) as [H | H].
    + destruct (No0 eq_refl (2 * t)) as (f & I & N); [lra | |].
      { rewrite (proj1 (halves_cubic Y (2 * t) LY)). now replace (2 * t / 2) with t by field. }
      apply in_map_iff in I. destruct I as (G & <- & I). exists G. split; auto.
      rewrite (proj1 (halves_quartic G (2 * t) (LG G I))) in N.
      now replace (2 * t / 2) with t in N by field.
    + destruct (No1 E1 (2 * t - 1)) as (f & I & N); [lra | |].
      { rewrite (proj1 (proj2 (halves_cubic Y (2 * t - 1) LY))).
        now replace ((1 + (2 * t - 1)) / 2) with t by field. }
      apply in_map_iff in I. destruct I as (G & <- & I). exists G. split; auto.
      rewrite (proj1 (proj2 (halves_quartic G (2 * t - 1) (LG G I)))) in N.
      now replace ((1 + (2 * t - 1)) / 2) with t in N by field.
Qed.

Theorem subdivision_separate n i j y Y gs Gs t : length y = 4%nat -> Forall2 (stands_y i) y Y ->
  quartics j gs Gs -> (i + 3 * n <= max_y)%nat -> (j + 4 * n <= max_g)%nat ->
  subdivide n y gs = separate -> 0 <= t <= 1 -> control_at Y t = 0 ->
  exists G, In G Gs /\ control_at G t < 0.
Proof. intros L F Q MY MG E. now apply (proj1 (subdivision_right n i j y Y gs Gs L F Q MY MG)). Qed.
Theorem subdivision_collides n i j y Y gs Gs : length y = 4%nat -> Forall2 (stands_y i) y Y ->
  quartics j gs Gs -> (i + 3 * n <= max_y)%nat -> (j + 4 * n <= max_g)%nat ->
  subdivide n y gs = collides ->
  exists t, 0 <= t <= 1 /\ control_at Y t = 0 /\ forall G, In G Gs -> 0 < control_at G t.
Proof. intros L F Q MY MG E. now apply (proj2 (subdivision_right n i j y Y gs Gs L F Q MY MG)). Qed.

End Subdivision.
