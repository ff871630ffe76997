(** Bernstein sign classification (include/errbound/bsc.hpp): its answers over every scalar of Bernstein.v.
    BscCode.v has the code, BscSigns.v the lemmas on its signs at roots. Results, for any uncertain signs:
        bsc_no     the answer "no": at every root of Y in [0, 1] some G is negative
        bsc_yes    the answer "yes": at some root of Y in [0, 1] every G is positive *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Errbound Require Import Sign Bernstein.
From Errbound Require Export BscSigns.
Import ListNotations.
Open Scope R_scope.

Section Answers.

Context {S : scalar}.
Notation exacts := (map (@exact S)).
Notation "p '#' i" := (nth i p (whole 0)) (at level 20).
Notation form_at := (@at_time S).
Notation dy y := (derivative y).
Notation ddy y := (derivative (derivative y)).
Implicit Types (y g l d j : list S).

(** ** Answers *)

Implicit Types (gs : list (list S)).
Notation five gs := (Forall (fun g : list S => length g = 5%nat) gs).

Definition excluded gs (t : R) : Prop := Exists (fun g => form_at g t < 0) gs.
Definition all_positive gs (t : R) : Prop := Forall (fun g => 0 < form_at g t) gs.

(** The meaning of an answer for a root, and for a whole interval. *)
Definition right_at (e : existence) gs (t : R) : Prop :=
  (e = no -> excluded gs t) /\ (e = yes -> all_positive gs t).
Definition sound (e : existence) y gs : Prop :=
  (e = no -> forall t, 0 <= t <= 1 -> form_at y t = 0 -> excluded gs t) /\
  (e = yes -> exists t, 0 <= t <= 1 /\ form_at y t = 0 /\ all_positive gs t).

Lemma either_no a b : either a b = no -> a = no /\ b = no.
Proof. destruct a, b; easy. Qed.
Lemma either_yes a b : either a b = yes -> a = yes \/ b = yes.
Proof. destruct a, b; auto; easy. Qed.

Lemma in_turn_no a b : in_turn a b = no -> a = no /\ b = no.
Proof. destruct a; easy. Qed.
Lemma in_turn_yes a b : in_turn a b = yes -> a = yes \/ b = yes.
Proof. destruct a; auto; easy. Qed.

Lemma verdict_right c gs t (f : list S -> sign) :
  Forall (fun g => not_wrong (f g) (form_at g t)) gs -> right_at (verdict c (map f gs)) gs t.
Proof.
  intros H. unfold verdict. split.
  - destruct (existsb _ _) eqn:E; [intros _ | destruct (negb c), (forallb (same_sign positive) (map f
      gs)); easy].
    apply existsb_exists in E. destruct E as (s & I & N). apply in_map_iff in I.
    destruct I as (g & <- & I).
    apply Exists_exists. exists g. split; auto. rewrite Forall_forall in H. specialize (H g I).
    destruct (f g); easy.
  - destruct (existsb (same_sign negative) (map f gs)); [easy |]. destruct (negb c); [easy |].
    destruct (forallb (same_sign positive) (map f gs)) eqn:E; [intros _ | easy].
    rewrite forallb_forall in E.
    apply Forall_forall. intros g I. rewrite Forall_forall in H. specialize (H g I).
    specialize (E (f g) (in_map _ _ _ I)). destruct (f g); easy.
Qed.
Lemma verdict_yes c signs : verdict c signs = yes -> c = true.
Proof. unfold verdict. destruct (existsb (same_sign negative) signs), c; easy. Qed.

Lemma at_start p : p <> [] -> form_at p 0 = exact (p#0).
Proof. destruct p as [| a l]; [easy |]. intros _. unfold at_time. simpl. rewrite Rminus_0_r, pow1. ring.
  Qed.
Lemma at_finish p n : length p = Datatypes.S n -> form_at p 1 = exact (p#n).
Proof.
  revert n. unfold at_time. rewrite Rminus_diag_eq by easy.
  induction p as [| a [| b l] IH]; intros [| n] L; try discriminate; simpl in *; try lra.
  injection L as L. rewrite (IH n) by (now simpl; rewrite L). destruct n; simpl; ring.
Qed.

Lemma at_end_right y gs k t : five gs -> (k = 0%nat /\ t = 0 \/ k = 4%nat /\ t = 1) ->
  forall x : S, exact x = form_at y t ->
  (at_end (sign_of x) gs k = no -> form_at y t = 0 -> excluded gs t) /\
  (at_end (sign_of x) gs k = yes -> form_at y t = 0 /\ all_positive gs t).
Proof.
  intros F K x E. unfold at_end. pose proof (sign_right S x) as X.
  assert (R : right_at (verdict (same_sign (sign_of x) zero) (map (fun f => sign_of (f#k)) gs)) gs t).
  { apply verdict_right. apply Forall_forall. intros g I. rewrite Forall_forall in F.
    specialize (F g I).
    apply right_not_wrong. replace (form_at g t) with (exact (g#k)); [apply sign_right |].
    destruct K as [(-> & ->) | (-> & ->)]; symmetry; [apply at_start; now destruct g | now apply
      at_finish]. }
  destruct R as (No & Yes). destruct (possibly_zero (sign_of x)) eqn:P; simpl.
  - split; auto. intros H. pose proof (verdict_yes _ _ H) as C. split; auto.
    destruct (sign_of x); try discriminate. simpl in X. lra.
  - split; [intros _ Z | easy]. destruct (sign_of x); try discriminate; simpl in X; lra.
Qed.

Lemma at_crossing_right y before c gs r : length y = 4%nat -> five gs ->
  before = negative \/ before = positive -> crossing (form_at y) (unit before) r ->
  right_at (at_crossing y before c gs) gs r.
Proof.
  intros L F B C. apply verdict_right. eapply Forall_impl; [| exact F].
  simpl. intros g Lg. now apply quartic_at_crossing_right.
Qed.

Lemma between (f : list S) a b : a <= b -> form_at f a * form_at f b <= 0 ->
  exists x, a <= x <= b /\ form_at f x = 0.
Proof.
  intros A N. destruct (IVT_cor (form_at f) a b) as (x & X & Z); eauto.
  intros t. apply derivable_continuous_pt. exists (form_at (derivative f) t). apply derivative_form.
Qed.
Lemma strict_root (y : list S) : form_at y 0 * form_at y 1 < 0 -> exists r, 0 < r < 1 /\ form_at y r = 0.
Proof.
  intros N. destruct (between y 0 1) as (r & I & Z); [lra | lra |]. exists r. split; auto.
  assert (r <> 0) by (intros ->; rewrite Z in N; lra). assert (r <> 1) by (intros ->; rewrite Z in N; lra). lra.
Qed.

(** If the signs of two ends are certain and opposite, there is a root between them. *)
Lemma signs_of (x : S) :
  (sign_of x = negative -> exact x < 0) /\ (sign_of x = zero -> exact x = 0) /\ (sign_of x = positive ->
    0 < exact x).
Proof. pose proof (sign_right S x). destruct (sign_of x); repeat split; intros; auto; discriminate. Qed.
Lemma possible (x : S) : (exact x < 0 -> possibly_negative (sign_of x) = true) /\
  (0 < exact x -> possibly_positive (sign_of x) = true) /\ (exact x <> 0 -> same_sign (sign_of x) zero =
    false).
Proof.
  pose proof (sign_right S x). destruct (sign_of x); repeat split; simpl in *; intros; auto; lra.
Qed.
Lemma certainly (x : S) : certain (sign_of x) = true ->
  (possibly_negative (sign_of x) = true -> exact x < 0) /\ (possibly_positive (sign_of x) = true -> 0 <
    exact x).
Proof. pose proof (sign_right S x). destruct (sign_of x); repeat split; simpl in *; intros; auto; easy.
  Qed.

Lemma on_increasing_sound y gs : length y = 4%nat -> five gs ->
  (forall a b, 0 <= a -> a < b -> b <= 1 -> form_at y a < form_at y b) -> sound (on_increasing y gs) y
    gs.
Proof.
  intros L F M. assert (N : y <> []) by now destruct y.
  pose proof (at_start y N) as S0. pose proof (at_finish y 3 L) as S3.
  destruct (at_end_right y gs 0 0 F ltac:(auto) (y#0) (eq_sym S0)) as (No0 & Yes0).
  destruct (at_end_right y gs 4 1 F ltac:(auto) (y#3) (eq_sym S3)) as (No3 & Yes3).
  assert (Cross : forall r, 0 < r < 1 -> form_at y r = 0 -> crossing (form_at y) (unit negative) r).
  { intros r I Z. pose proof (M 0 r). pose proof (M r 1). repeat split; simpl; try tauto; try lra;
      intros t T;
      [pose proof (M t r) | pose proof (M r t)]; lra. }
  unfold on_increasing.
  set (both := possibly_negative (sign_of (y#0)) && possibly_positive (sign_of (y#3))).
  set (crossed := at_crossing y negative (certain (sign_of (y#0)) && certain (sign_of (y#3))) gs).
  assert (No : crossed = no -> forall r, 0 < r < 1 -> form_at y r = 0 -> excluded gs r).
  { intros E r I Z. apply (proj1 (at_crossing_right y negative (certain (sign_of (y#0)) && certain
      (sign_of (y#3))) gs r L F (or_introl eq_refl) (Cross r I Z))). exact E. }
  assert (Yes : both = true -> crossed = yes ->
    exists t, 0 <= t <= 1 /\ form_at y t = 0 /\ all_positive gs t).
  { intros P E. unfold both in P. apply andb_prop in P. pose proof (verdict_yes _ _ E) as C.
    apply andb_prop in C.
    pose proof (proj1 (certainly (y#0) (proj1 C)) (proj1 P)).
    pose proof (proj2 (certainly (y#3) (proj2 C)) (proj2 P)).
    destruct (strict_root y) as (r & Ir & Z); [rewrite S0, S3; nra |]. exists r. split; [lra |]. split; auto.
    apply (proj2 (at_crossing_right y negative (certain (sign_of (y#0)) && certain (sign_of (y#3))) gs r
      L F (or_introl eq_refl) (Cross r Ir Z))). exact E. }
  assert (Inner : forall t, 0 <= t <= 1 -> form_at y t = 0 -> t <> 0 -> t <> 1 ->
    both = true).
  { intros t T Z T0 T1. pose proof (M 0 t). pose proof (M t 1).
    unfold both. destruct (possible (y#0)) as (P & _). destruct (possible (y#3)) as (_ & Q & _).
    rewrite P, Q; auto; lra. }
  split.
  - intros E t T Z. destruct (Req_dec t 0) as [-> | T0]; [| destruct (Req_dec t 1) as [-> | T1]].
    + apply No0; auto. destruct both; repeat (apply either_no in E; destruct E as (E & ?)); auto.
    + apply No3; auto. destruct both; repeat (apply either_no in E; destruct E as (E & ?)); auto.
    + rewrite (Inner t T Z T0 T1) in E. apply either_no in E. apply No; tauto || lra.
  - destruct both eqn:P; intros E.
    + apply either_yes in E. destruct E as [E | E]; auto. apply either_yes in E.
      destruct E as [E | E]; [exists 0; specialize (Yes0 E) | exists 1; specialize (Yes3 E)]; split; lra
        || tauto.
    + apply either_yes in E.
      destruct E as [E | E]; [exists 0; specialize (Yes0 E) | exists 1; specialize (Yes3 E)]; split; lra
        || tauto.
Qed.

Lemma at_pair_sound y d c gs : length y = 4%nat -> length d = 3%nat -> exacts d = exacts (dy y) -> five
  gs ->
  convex (form_at y) (form_at d) ->
  (at_pair y d c gs = no -> 0 < form_at y 0 -> 0 < form_at y 1 ->
     forall t, 0 < t < 1 -> form_at y t = 0 -> excluded gs t) /\
  (at_pair y d c gs = yes -> c = true /\ (0 < form_at y 0 -> 0 < form_at y 1 ->
     exists t, 0 <= t <= 1 /\ form_at y t = 0 /\ all_positive gs t)).
Proof.
  intros L Ld Ed F (T & M).
  assert (Nd : d <> []) by now destruct d.
  pose proof (at_start d Nd) as D0. pose proof (at_finish d 2 Ld) as D2.
  pose proof (signs_of (d#0)) as S0. pose proof (signs_of (d#2)) as S2.
  assert (Lowest : forall x, 0 < x < 1 -> form_at d x = 0 -> sign_is_right (sign_at_extremum y d)
    (form_at y x))
    by (intros x X Z; now apply root_finding).
  assert (Extremum : form_at d 0 < 0 -> 0 < form_at d 1 -> exists x, 0 < x < 1 /\ form_at d x = 0).
  { intros P Q. apply strict_root. nra. }
  assert (Pair : forall b k r, 0 < form_at y 0 -> 0 < form_at y 1 -> 0 < r < 1 -> form_at y r = 0 ->
     (form_at d r <= 0 -> right_at (verdict b (map (fun f => fst (quartic_at_pair y d f)) gs)) gs r) /\
     (0 <= form_at d r -> right_at (verdict k (map (fun f => snd (quartic_at_pair y d f)) gs)) gs r)).
  { intros b k r Y0 Y1 I Z. split; intros Dr; apply verdict_right; eapply Forall_impl; try exact F;
      simpl;
      intros g Lg; apply (quartic_at_pair_right y d g r); auto; now split. }
  unfold at_pair. set (lowest := sign_at_extremum y d) in *. split.
  - intros E Y0 Y1 t I Z.
    assert (N0 : form_at d 0 < 0) by (specialize (T 0 t ltac:(lra) ltac:(lra) ltac:(lra)); nra).
    assert (N1 : 0 < form_at d 1) by (specialize (T 1 t ltac:(lra) ltac:(lra) ltac:(lra)); nra).
    destruct (Extremum N0 N1) as (x & X & Zx). specialize (Lowest x X Zx).
    assert (Low : form_at y x <= 0).
    { destruct (Req_dec x t) as [-> | H]; [lra |]. specialize (T x t ltac:(lra) ltac:(lra) H).
      rewrite Zx in T. lra. }
    rewrite D0 in N0. rewrite D2 in N1.
    destruct (certainly_nonnegative _ || certainly_nonpositive _) eqn:Q.
    { exfalso. destruct S0 as (_ & A & B). destruct S2 as (A2 & B2 & _).
      destruct (sign_of (d#0)), (sign_of (d#2)); simpl in Q; try discriminate;
        try (specialize (A eq_refl)); try (specialize (B eq_refl)); try (specialize (A2 eq_refl));
        try (specialize (B2 eq_refl)); lra. }
    destruct (same_sign lowest positive) eqn:P; [destruct lowest; try discriminate; simpl in Lowest; lra
      |].
    apply either_no in E. destruct E as (E0 & E1).
    destruct (Rle_or_lt (form_at d t) 0) as [D | D].
    + destruct (Pair (c && certain (sign_of (d#0)) && certain (sign_of (d#2)) && certain lowest) true t
        Y0 Y1 I Z)
        as (R & _). exact (proj1 (R D) E0).
    + destruct (Pair true (c && certain (sign_of (d#0)) && certain (sign_of (d#2)) && certain lowest) t
        Y0 Y1 I Z)
        as (_ & R). apply (proj1 (R (Rlt_le _ _ D)) E1).
  - destruct (certainly_nonnegative _ || certainly_nonpositive _) eqn:Q; [easy |].
    destruct (same_sign lowest positive) eqn:P; [easy |]. intros E. apply either_yes in E.
    assert (C : c && certain (sign_of (d#0)) && certain (sign_of (d#2)) && certain lowest = true)
      by (destruct E as [E | E]; exact (verdict_yes _ _ E)).
    apply andb_prop in C. destruct C as (C & Cl). apply andb_prop in C. destruct C as (C & C2).
    apply andb_prop in C. destruct C as (C & C0). split; auto. intros Y0 Y1.
    assert (N0 : form_at d 0 < 0).
    { rewrite D0. destruct S0 as (A & _). destruct (sign_of (d#0)); try discriminate; auto. }
    assert (N1 : 0 < form_at d 1).
    { rewrite D2. destruct S2 as (_ & _ & A).
      destruct (sign_of (d#0)), (sign_of (d#2)); try discriminate; auto. }
    destruct (Extremum N0 N1) as (x & X & Zx). specialize (Lowest x X Zx).
    assert (Low : form_at y x <= 0) by (destruct lowest; try discriminate; simpl in Lowest; lra).
    assert (Side : forall u v, 0 <= u <= 1 -> 0 <= v <= 1 -> u <= v -> form_at d u <= form_at d v).
    { intros u v U V [W | ->]; [left; now apply M | lra]. }
    destruct E as [E | E].
    + destruct (between y 0 x) as (r & I & Z); [lra | nra |]. assert (r <> 0) by (intros ->; lra).
      exists r. split; [lra |]. split; auto.
      destruct (Pair (c && certain (sign_of (d#0)) && certain (sign_of (d#2)) && certain lowest) true r
        Y0 Y1) as (R & _);
        auto; [lra |]. apply R; auto. rewrite <- Zx. apply Side; lra.
    + destruct (between y x 1) as (r & I & Z); [lra | nra |]. assert (r <> 1) by (intros ->; lra).
      exists r. split; [lra |]. split; auto.
      destruct (Pair true (c && certain (sign_of (d#0)) && certain (sign_of (d#2)) && certain lowest) r
        Y0 Y1) as (_ & R);
        auto; [lra |]. apply R; auto. rewrite <- Zx. apply Side; lra.
Qed.


(** Y divided by its root at an end. *)
Lemma without_start y t : length y = 4%nat -> form_at y 0 = 0 ->
  t * form_at (elevated [y#1; y#2; y#3]) t = form_at y t.
Proof.
  intros L Z. rewrite at_start in Z by now destruct y. four y L. unfold at_time. rewrite elevated_form.
  simpl in *. rewrite Z. ring.
Qed.
Lemma without_finish y t : length y = 4%nat -> form_at y 1 = 0 ->
  (1 - t) * form_at (elevated [y#0; y#1; y#2]) t = form_at y t.
Proof.
  intros L Z. rewrite (at_finish y 3 L) in Z. four y L. unfold at_time. rewrite elevated_form.
  simpl in *. rewrite Z. ring.
Qed.
Lemma at_time_by p q t : exacts p = exacts q -> form_at p t = form_at q t.
Proof. unfold at_time. now intros ->. Qed.

Ltac in_no H :=
  repeat match type of H with
  | either _ _ = no => apply either_no in H; let G := fresh in destruct H as (H & G)
  | (if ?b then _ else _) = no => destruct b
  end.

Lemma crossing_without_start y D r : length y = 4%nat -> convex (form_at y) D -> D 0 = exact (y#1) - 3 *
  exact (y#0) ->
  form_at y 0 = 0 -> crossing (form_at y) (-1) r ->
  exact (y#1) < 0 /\ crossing (form_at (elevated [y#1; y#2; y#3])) (unit negative) r.
Proof.
  intros L (T & _) D0 Z (I & Zr & Before & After & _ & Y1).
  pose proof (fun t => without_start y t L Z) as E. set (e := form_at (elevated [y#1; y#2; y#3])) in *.
  assert (N : exact (y#1) < 0).
  { rewrite at_start in Z by now destruct y. specialize (T 0 r ltac:(lra) ltac:(lra) ltac:(lra)).
    rewrite at_start in T by now destruct y. rewrite D0, Z, Zr in T. nra. }
  split; auto. repeat split; simpl; try tauto.
  - specialize (E r). rewrite Zr in E. apply Rmult_integral in E. lra.
  - intros t t01. specialize (Before t t01). rewrite <- E in Before. nra.
  - intros t t01. specialize (After t t01). rewrite <- E in After. nra.
  - unfold e. rewrite at_start by easy. simpl. lra.
  - specialize (E 1). rewrite Rmult_1_l in E. rewrite E. exact Y1.
Qed.
Lemma crossing_without_finish y D r : length y = 4%nat -> convex (form_at y) D -> D 1 = 3 * exact (y#3)
  - exact (y#2) ->
  form_at y 1 = 0 -> crossing (form_at y) 1 r ->
  exact (y#2) < 0 /\ crossing (form_at (elevated [y#0; y#1; y#2])) (unit positive) r.
Proof.
  intros L (T & _) D1 Z (I & Zr & Before & After & Y0 & _).
  pose proof (fun t => without_finish y t L Z) as E. set (e := form_at (elevated [y#0; y#1; y#2])) in *.
  assert (N : exact (y#2) < 0).
  { rewrite (at_finish y 3 L) in Z. specialize (T 1 r ltac:(lra) ltac:(lra) ltac:(lra)).
    rewrite (at_finish y 3 L) in T. rewrite D1, Z, Zr in T. nra. }
  split; auto. repeat split; simpl; try tauto.
  - specialize (E r). rewrite Zr in E. apply Rmult_integral in E. lra.
  - intros t t01. specialize (Before t t01). rewrite <- E in Before. nra.
  - intros t t01. specialize (After t t01). rewrite <- E in After. nra.
  - specialize (E 0). rewrite Rminus_0_r, Rmult_1_l in E. rewrite E. exact Y0.
  - unfold e. rewrite (at_finish _ 3) by easy. simpl. lra.
Qed.

Lemma on_convex_sound y d gs : length y = 4%nat -> length d = 3%nat -> exacts d = exacts (dy y) -> five
  gs ->
  convex (form_at y) (form_at d) -> sound (on_convex y d gs) y gs.
Proof.
  intros L Ld Ed F C. assert (N : y <> []) by now destruct y.
  pose proof (at_start y N) as S0. pose proof (at_finish y 3 L) as S3.
  destruct (at_end_right y gs 0 0 F ltac:(auto) (y#0) (eq_sym S0)) as (No0 & Yes0).
  destruct (at_end_right y gs 4 1 F ltac:(auto) (y#3) (eq_sym S3)) as (No3 & Yes3).
  assert (D0 : form_at d 0 = exact (y#1) - 3 * exact (y#0))
    by (rewrite (at_time_by d (dy y) 0 Ed); clear -L; four y L; values; ring).
  assert (D1 : form_at d 1 = 3 * exact (y#3) - exact (y#2))
    by (rewrite (at_time_by d (dy y) 1 Ed); clear -L; four y L; values; ring).
  set (ec := certain (sign_of (y#0)) && certain (sign_of (y#3))).
  (* both ends of an interval in which the code needs a crossing *)
  assert (Ec : ec = true -> certain (sign_of (y#0)) = true /\ certain (sign_of (y#3)) = true)
    by apply andb_prop.
  destruct (at_pair_sound y d ec gs L Ld Ed F C) as (PairNo & PairYes).
  split.
  - intros E t T Z. unfold on_convex in E. fold ec in E.
    destruct (Req_dec t 0) as [-> | T0]; [apply No0; auto; now in_no E |].
    destruct (Req_dec t 1) as [-> | T1]; [apply No3; auto; now in_no E |].
    assert (I : 0 < t < 1) by lra.
    destruct (Rtotal_order (form_at y 0) 0) as [Y0 | [Y0 | Y0]].
    + destruct (rising_crossing _ _ t C I Z ltac:(lra)) as (K & Y1).
      rewrite S0 in Y0. rewrite S3 in Y1.
      destruct (possible (y#0)) as (P0 & _ & Z0). destruct (possible (y#3)) as (_ & P3 & Z3).
      rewrite P0, Z0, P3 in E by lra. simpl in E.
      apply (proj1 (at_crossing_right y negative ec gs t L F (or_introl eq_refl) K)). now in_no E.
    + destruct (rising_crossing _ _ t C I Z ltac:(lra)) as (K & Y1).
      destruct (crossing_without_start y _ t L C D0 Y0 K) as (Slope & Ke).
      rewrite S0 in Y0. rewrite S3 in Y1.
      destruct (possible (y#1)) as (P1 & _ & _). destruct (possible (y#3)) as (_ & P3 & Z3).
      rewrite P1, P3 in E by lra. cbn [andb] in E.
      destruct (same_sign (sign_of (y#0)) zero) eqn:Q.
      * apply (proj1 (at_crossing_right (elevated [y#1; y#2; y#3]) negative (ec && certain (sign_of
          (y#1))) gs t
          eq_refl F (or_introl eq_refl) Ke)). now in_no E.
      * assert (P0 : possibly_negative (sign_of (y#0)) = true)
          by (pose proof (signs_of (y#0)) as (A & _ & B); destruct (sign_of (y#0)); auto; try easy;
              specialize (B eq_refl); lra).
        rewrite P0 in E. simpl in E.
        apply (proj1 (at_crossing_right y negative ec gs t L F (or_introl eq_refl) K)). now in_no E.
    + destruct (possible (y#0)) as (_ & P0 & Z0). rewrite P0, Z0 in E by (rewrite <- S0; lra).
      destruct (Rtotal_order (form_at y 1) 0) as [Y1 | [Y1 | Y1]].
      * destruct (falling_crossing _ _ t C I Z ltac:(lra)) as (K & _).
        destruct (possible (y#3)) as (P3 & _ & Z3). rewrite P3, Z3 in E by (rewrite <- S3; lra).
        apply (proj1 (at_crossing_right y positive ec gs t L F (or_intror eq_refl) K)). now in_no E.
      * destruct (falling_crossing _ _ t C I Z ltac:(lra)) as (K & _).
        destruct (crossing_without_finish y _ t L C D1 Y1 K) as (Slope & Ke).
        destruct (same_sign (sign_of (y#3)) zero) eqn:Q.
        -- assert (P2 : possibly_positive (negate (sign_of (y#2))) = true)
             by (pose proof (signs_of (y#2)) as (_ & A & B); destruct (sign_of (y#2)); auto; try easy;
                 [specialize (A eq_refl) | specialize (B eq_refl)]; lra).
           rewrite P2 in E.
           apply (proj1 (at_crossing_right (elevated [y#0; y#1; y#2]) positive (ec && certain (negate
             (sign_of (y#2)))) gs t
             eq_refl F (or_intror eq_refl) Ke)). now in_no E.
        -- assert (P3 : possibly_negative (sign_of (y#3)) = true)
             by (pose proof (signs_of (y#3)) as (A & _ & B); destruct (sign_of (y#3)); auto; try easy;
                 specialize (B eq_refl); lra).
           rewrite P3 in E.
           apply (proj1 (at_crossing_right y positive ec gs t L F (or_intror eq_refl) K)). now in_no E.
      * destruct (possible (y#3)) as (_ & P3 & _). rewrite P3 in E by (rewrite <- S3; lra).
        apply PairNo; auto. now in_no E.
  - intros E. unfold on_convex in E. fold ec in E.
    set (answer := exists t, 0 <= t <= 1 /\ form_at y t = 0 /\ all_positive gs t).
    assert (Ends : either (at_end (sign_of (y#0)) gs 0) (at_end (sign_of (y#3)) gs 4) = yes -> answer).
    { intros H. apply either_yes in H.
      destruct H as [H | H]; [exists 0; specialize (Yes0 H) | exists 1; specialize (Yes3 H)]; split; lra
        || tauto. }
    assert (Negative : possibly_negative (sign_of (y#0)) && possibly_positive (sign_of (y#3)) = true ->
      at_crossing y negative ec gs = yes -> answer).
    { intros P H. apply andb_prop in P. destruct (Ec (verdict_yes _ _ H)) as (C0 & C3).
      pose proof (proj1 (certainly _ C0) (proj1 P)). pose proof (proj2 (certainly _ C3) (proj2 P)).
      destruct (strict_root y) as (r & Ir & Z); [rewrite S0, S3; nra |].
      destruct (rising_crossing _ _ r C Ir Z ltac:(lra)) as (K & _).
      exists r. split; [lra |]. split; auto.
      exact (proj2 (at_crossing_right y negative ec gs r L F (or_introl eq_refl) K) H). }
    assert (Positive : possibly_positive (sign_of (y#0)) = true -> possibly_negative (sign_of (y#3)) =
      true ->
      at_crossing y positive ec gs = yes -> answer).
    { intros P Q H. destruct (Ec (verdict_yes _ _ H)) as (C0 & C3).
      pose proof (proj2 (certainly _ C0) P). pose proof (proj1 (certainly _ C3) Q).
      destruct (strict_root y) as (r & Ir & Z); [rewrite S0, S3; nra |].
      destruct (falling_crossing _ _ r C Ir Z ltac:(lra)) as (K & _).
      exists r. split; [lra |]. split; auto.
      exact (proj2 (at_crossing_right y positive ec gs r L F (or_intror eq_refl) K) H). }
    assert (Start : same_sign (sign_of (y#0)) zero = true ->
      possibly_negative (sign_of (y#1)) && possibly_positive (sign_of (y#3)) = true ->
      at_crossing (elevated [y#1; y#2; y#3]) negative (ec && certain (sign_of (y#1))) gs = yes ->
        answer).
    { intros Q P H. apply andb_prop in P. pose proof (verdict_yes _ _ H) as K. apply andb_prop in K.
      destruct K as (Ce & C1). destruct (Ec Ce) as (C0 & C3).
      pose proof (proj1 (certainly _ C1) (proj1 P)) as N1.
      pose proof (proj2 (certainly _ C3) (proj2 P)) as N3.
      assert (Y0 : form_at y 0 = 0)
        by (rewrite S0; pose proof (signs_of (y#0)) as (_ & A & _); destruct (sign_of (y#0)); easy ||
          auto).
      set (e := elevated [y#1; y#2; y#3]) in *.
      assert (E0 : form_at e 0 = exact (y#1)) by (now rewrite at_start).
      assert (E1 : form_at e 1 = exact (y#3)) by (now rewrite (at_finish e 3)).
      destruct (strict_root e) as (r & Ir & Z); [rewrite E0, E1; nra |].
      assert (Zy : form_at y r = 0) by (rewrite <- (without_start y r L Y0); fold e; rewrite Z; ring).
      destruct (rising_crossing _ _ r C Ir Zy ltac:(lra)) as (Ky & _).
      destruct (crossing_without_start y _ r L C D0 Y0 Ky) as (_ & Ke).
      exists r. split; [lra |]. split; auto.
      exact (proj2 (at_crossing_right e negative _ gs r eq_refl F (or_introl eq_refl) Ke) H). }
    assert (Finish : possibly_positive (sign_of (y#0)) = true -> same_sign (sign_of (y#3)) zero = true
      ->
      possibly_positive (negate (sign_of (y#2))) = true ->
      at_crossing (elevated [y#0; y#1; y#2]) positive (ec && certain (negate (sign_of (y#2)))) gs = yes
        -> answer).
    { intros P Q R H. pose proof (verdict_yes _ _ H) as K. apply andb_prop in K.
      destruct K as (Ce & C2). destruct (Ec Ce) as (C0 & C3).
      pose proof (proj2 (certainly _ C0) P) as N0.
      assert (N2 : exact (y#2) < 0)
        by (pose proof (signs_of (y#2)) as (A & _ & _); destruct (sign_of (y#2)); easy || auto).
      assert (Y1 : form_at y 1 = 0)
        by (rewrite S3; pose proof (signs_of (y#3)) as (_ & A & _); destruct (sign_of (y#3)); easy ||
          auto).
      set (e := elevated [y#0; y#1; y#2]) in *.
      assert (E0 : form_at e 0 = exact (y#0)) by (now rewrite at_start).
      assert (E1 : form_at e 1 = exact (y#2)) by (now rewrite (at_finish e 3)).
      destruct (strict_root e) as (r & Ir & Z); [rewrite E0, E1; nra |].
      assert (Zy : form_at y r = 0) by (rewrite <- (without_finish y r L Y1); fold e; rewrite Z; ring).
      destruct (falling_crossing _ _ r C Ir Zy ltac:(lra)) as (Ky & _).
      destruct (crossing_without_finish y _ r L C D1 Y1 Ky) as (_ & Ke).
      exists r. split; [lra |]. split; auto.
      exact (proj2 (at_crossing_right e positive _ gs r eq_refl F (or_intror eq_refl) Ke) H). }
    assert (Two : possibly_positive (sign_of (y#0)) = true -> possibly_positive (sign_of (y#3)) = true
      ->
      at_pair y d ec gs = yes -> answer).
    { intros P Q H. destruct (PairYes H) as (Ce & K). destruct (Ec Ce) as (C0 & C3). apply K.
      - rewrite S0. exact (proj2 (certainly _ C0) P).
      - rewrite S3. exact (proj2 (certainly _ C3) Q). }
    clear Yes0 Yes3 No0 No3 PairNo PairYes.
    repeat match type of E with
    | either _ _ = yes => apply either_yes in E; destruct E as [E | E]
    | context [if ?b then _ else _] => destruct b eqn:?
    end; auto.
    all: apply Ends; rewrite E; destruct (at_end (sign_of (y#0)) gs 0); auto.
Qed.


(** ** A subinterval of the step *)

Lemma inside_signs l : length l = 2%nat -> opposite l = false -> signs_inside (inside l) (exacts l).
Proof.
  intros L O. destruct (length_2 l L) as (a & b & ->). unfold opposite, inside in *. simpl in *.
  pose proof (sign_right S a) as A. pose proof (sign_right S b) as B.
  destruct (sign_of a), (sign_of b); try discriminate; simpl in *; auto;
    try (split; [repeat constructor; lra |]); try (repeat constructor; lra);
    try (constructor 1; lra); constructor 2; constructor 1; lra.
Qed.

Lemma exacts_opp (p : list S) : exacts (map opp p) = map Ropp (exacts p).
Proof. rewrite !map_map. apply map_ext. intros x. apply exact_opp. Qed.
Lemma derivative_opp y : length y = 4%nat ->
  exacts (dy (map opp y)) = map Ropp (exacts (dy y)) /\ exacts (ddy (map opp y)) = map Ropp (exacts (ddy
    y)).
Proof.
  intros L. four y L. split; unfold derivative; cbn [map derivative_from];
    repeat (progress exacts || rewrite exact_times); simpl; repeat f_equal; ring.
Qed.

Lemma sound_opp e y gs : sound e (map opp y) gs -> sound e y gs.
Proof.
  assert (H : forall t, form_at (map opp y) t = - form_at y t)
    by (intros t; unfold at_time; now rewrite exacts_opp, form_opp).
  intros (No & Yes). split.
  - intros E t T Z. apply No; auto. rewrite H, Z. ring.
  - intros E. destruct (Yes E) as (t & T & Z & P). exists t. rewrite H in Z. repeat split; auto; lra.
Qed.

(** A property of each of its answers is one of on_whole_part. *)
Lemma on_whole_part_cases (Right : existence -> list S -> Prop) y gs curvature parts : length y = 4%nat ->
  signs_inside curvature (exacts (ddy y)) -> curvature <> zero ->
  ((forall t, 0 <= t <= 1 -> form_at y t = 0 -> excluded gs t) -> Right no y) ->
  (forall e, Right e (map opp y) -> Right e y) ->
  (forall y, length y = 4%nat -> (forall a b, 0 <= a -> a < b -> b <= 1 -> form_at y a < form_at y b) ->
     Right (on_increasing y gs) y) ->
  (forall y d, length y = 4%nat -> length d = 3%nat -> exacts d = exacts (dy y) -> convex (form_at y) (form_at d) ->
     Right (on_convex y d gs) y) ->
  ((forall t, form_at y t = exact (y#0)) -> Right (if possibly_zero (sign_of (y#0)) then maybe_root else no) y) ->
  (sign_inside (dy y) = uncertain -> curvature = uncertain ->
     (opposite (ddy y) = false -> inside (ddy y) = zero \/ inside (ddy y) = uncertain) -> Right (parts (ddy y)) y) ->
  Right (on_whole_part y gs curvature parts) y.
Proof.
  intros L K Nz No Opp Rising Curved Constant Parts. unfold on_whole_part. destruct (excluded_by_hull y gs) eqn:H.
  { apply No. intros t T Z. apply orb_prop in H. destruct H as [H | H].
    - now apply rootless_hull with (t := t) in H.
    - apply existsb_exists in H. destruct H as (g & I & N). apply Exists_exists. exists g. split; auto.
      pose proof (sign_throughout_right g t T) as R. destruct (sign_throughout g); easy. }
  destruct (derivative_opp y L) as (Eo & Eoo).
  assert (Lo : length (map opp y) = 4%nat) by now rewrite map_length.
  pose proof (sign_inside_coefficients (dy y)) as Slope.
  destruct (sign_inside (dy y)).
  - apply Opp, Rising; auto. apply monotone_by_signs; auto. rewrite Eo. exact Slope.
  - apply Constant. intros t. rewrite <- at_start by now destruct y. pose proof (simpson y 0 t L) as Q.
    assert (Zero : forall x, form_at (dy y) x = 0).
    { intros x. unfold at_time. clear -Slope. simpl in Slope.
      induction Slope as [| a h <- _ IH]; simpl; [easy |]. rewrite IH. ring. }
    rewrite !Zero in Q. lra.
  - apply Rising; auto. now apply monotone_by_signs.
  - assert (Ls : length (ddy y) = 2%nat) by now four y L. assert (Ld : length (dy y) = 3%nat) by now four y L.
    pose proof (inside_signs (ddy y) Ls) as Inside. clear Slope.
    set (c := if negb (certain curvature) && negb (opposite (ddy y)) then inside (ddy y) else curvature).
    assert (Kc : signs_inside c (exacts (ddy y))).
    { unfold c. destruct (negb (certain curvature)), (opposite (ddy y)); simpl; auto. }
    assert (P : c = zero \/ c = uncertain -> Right (parts (ddy y)) y).
    { unfold c. intros C. apply Parts; auto; destruct curvature, (opposite (ddy y)); simpl in C; intuition congruence. }
    destruct c; auto.
    + apply Opp, Curved; auto; try (now rewrite map_length); [now rewrite exacts_opp, Eo |].
      replace (form_at (map opp (dy y))) with (form_at (dy (map opp y)))
        by (unfold at_time; now rewrite exacts_opp, Eo).
      apply convex_by_signs; auto. rewrite Eoo. exact Kc.
    + apply Curved; auto. now apply convex_by_signs.
Qed.
Lemma on_whole_part_sound y gs curvature parts : length y = 4%nat -> five gs ->
  signs_inside curvature (exacts (ddy y)) ->
  (opposite (ddy y) = true \/ curvature = uncertain -> sound (parts (ddy y)) y gs) ->
  curvature <> zero -> sound (on_whole_part y gs curvature parts) y gs.
Proof.
  intros L F K Parts Nz. apply (on_whole_part_cases (fun e y => sound e y gs)); auto using sound_opp,
    on_increasing_sound, on_convex_sound; [now split |].
  intros Y. split; [| now destruct (possibly_zero _)]. intros E t _ Z. exfalso. rewrite Y in Z.
  pose proof (signs_of (y#0)) as (A & _ & C). destruct (sign_of (y#0)); try discriminate; intuition lra.
Qed.

Lemma on_curved_sound y gs curvature : length y = 4%nat -> five gs ->
  signs_inside curvature (exacts (ddy y)) -> curvature <> zero -> sound (on_curved y gs curvature) y gs.
Proof. intros L F K N. apply on_whole_part_sound; auto. now split. Qed.

(** q is a positive multiple of p on [a, b]. *)
Definition is_part (p q : list S) (a b : R) : Prop :=
  length q = length p /\ exists c, 0 < c /\ forall t, form_at q t = c * form_at p (a + (b - a) * t).

Lemma part_normalized p q a b : is_part p q a b -> is_part p (normalized q) a b.
Proof.
  intros (L & c & C & E). split; [now rewrite length_normalized |].
  destruct (normalized_at q) as (k & K & N). exists (k * c). split; [now apply Rmult_lt_0_compat |].
  intros t. rewrite N, E. ring.
Qed.

Lemma form_of_part (p : list S) k x : p <> [] -> 0 < k ->
  form (exacts p) (k * (1 - x)) (k * x) = k ^ (length p - 1) * form_at p x.
Proof.
  intros N K. destruct p as [| a l]; [easy |]. unfold at_time. cbn [map].
  rewrite form_homogeneous, map_length. simpl. now rewrite Nat.sub_0_r.
Qed.

Lemma length_part (p : list S) v w : (length p = 4%nat \/ length p = 5%nat) ->
  length (left_part p v w) = length p /\ length (left_half p) = length p.
Proof.
  intros [L | L]; [destruct (length_4 p L) as (? & ? & ? & ? & ->) |
                   destruct (length_5 p L) as (? & ? & ? & ? & ? & ->)]; easy.
Qed.

Lemma split_parts (p : list S) v w : (length p = 4%nat \/ length p = 5%nat) -> 0 < exact v -> 0 < exact
  w ->
  let m := exact w / (exact v + exact w) in
  is_part p (fst (split p v w)) 0 m /\ is_part p (snd (split p v w)) m 1.
Proof.
  intros L V W m. assert (N : p <> []) by (intros ->; destruct L; discriminate).
  assert (Lr : length (rev p) = 4%nat \/ length (rev p) = 5%nat) by now rewrite rev_length.
  set (k := exact v + exact w). assert (K : 0 < k) by (unfold k; lra).
  assert (M : exact w = k * m) by (unfold m, k; field; lra).
  assert (M' : exact v = k * (1 - m)) by (unfold k in *; lra).
  split; split; simpl; try (rewrite rev_length, (proj1 (length_part _ w v Lr)); apply rev_length);
    try apply (length_part p v w L);
    exists (k ^ (length p - 1)); (split; [now apply pow_lt |]); intros t; rewrite <- form_of_part by
      auto;
    unfold at_time; rewrite ?reversed_form, left_part_form, ?reversed_form, ?(Rplus_comm (exact w)
      (exact v));
    fold k; rewrite M, M'; f_equal; ring.
Qed.
Lemma half_parts (p : list S) : (length p = 4%nat \/ length p = 5%nat) ->
  is_part p (fst (halves p)) 0 (/ 2) /\ is_part p (snd (halves p)) (/ 2) 1.
Proof.
  intros L. assert (N : p <> []) by (intros ->; destruct L; discriminate).
  assert (Lr : length (rev p) = 4%nat \/ length (rev p) = 5%nat) by now rewrite rev_length.
  split; split; simpl;
    try (rewrite rev_length, (proj2 (length_part _ (whole 0) (whole 0) Lr)); apply rev_length);
    try apply (length_part p (whole 0) (whole 0) L);
    exists (2 ^ (length p - 1)); (split; [apply pow_lt; lra |]); intros t; rewrite <- form_of_part by
      (auto; lra);
    unfold at_time; rewrite ?reversed_form, left_half_form, ?reversed_form; f_equal; field.
Qed.

Lemma sound_parts e e0 e1 y gs y0 y1 (f0 f1 : list S -> list S) m : 0 < m < 1 ->
  is_part y y0 0 m -> is_part y y1 m 1 ->
  Forall (fun g => is_part g (f0 g) 0 m /\ is_part g (f1 g) m 1) gs ->
  sound e0 y0 (map f0 gs) -> sound e1 y1 (map f1 gs) ->
  (e = no -> e0 = no /\ e1 = no) -> (e = yes -> e0 = yes \/ e1 = yes) -> sound e y gs.
Proof.
  intros M (_ & c0 & C0 & E0) (_ & c1 & C1 & E1) G (No0 & Yes0) (No1 & Yes1) No Yes.
  rewrite Forall_forall in G.
  assert (Sign : forall g t, In g gs ->
    (form_at (f0 g) t < 0 -> form_at g (0 + (m - 0) * t) < 0) /\ (0 < form_at (f0 g) t -> 0 < form_at g
      (0 + (m - 0) * t)) /\
    (form_at (f1 g) t < 0 -> form_at g (m + (1 - m) * t) < 0) /\ (0 < form_at (f1 g) t -> 0 < form_at g
      (m + (1 - m) * t))).
  { intros g t I. destruct (G g I) as ((_ & a & A & EA) & (_ & b & B & EB)). rewrite EA, EB.
    repeat split; intros; nra. }
  split.
  - intros E t T Z. destruct (No E) as (N0 & N1).
    destruct (Rle_or_lt t m) as [H | H].
    + assert (X : t = 0 + (m - 0) * (t / m)) by (field; lra).
      assert (Ex : excluded (map f0 gs) (t / m)).
      { apply No0; auto; [| rewrite E0, <- X, Z; ring].
        split; [apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra] |].
        apply Rmult_le_reg_r with m; [lra |]. replace (t / m * m) with t by (field; lra). lra. }
      unfold excluded in *. apply Exists_exists in Ex. destruct Ex as (f & I & N).
      apply in_map_iff in I.
      destruct I as (g & <- & I). apply Exists_exists. exists g. split; auto. rewrite X. now apply Sign.
    + assert (X : t = m + (1 - m) * ((t - m) / (1 - m))) by (field; lra).
      assert (Ex : excluded (map f1 gs) ((t - m) / (1 - m))).
      { apply No1; auto; [| rewrite E1, <- X, Z; ring].
        split; [apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra] |].
        apply Rmult_le_reg_r with (1 - m); [lra |].
        replace ((t - m) / (1 - m) * (1 - m)) with (t - m) by (field; lra). lra. }
      unfold excluded in *. apply Exists_exists in Ex. destruct Ex as (f & I & N).
      apply in_map_iff in I.
      destruct I as (g & <- & I). apply Exists_exists. exists g. split; auto. rewrite X. now apply Sign.
  - intros E. destruct (Yes E) as [Y | Y].
    + destruct (Yes0 Y) as (t & T & Z & P). exists (0 + (m - 0) * t). split; [nra |]. split.
      * rewrite E0 in Z. apply Rmult_integral in Z. destruct Z; lra.
      * unfold all_positive in *. rewrite Forall_map in P. rewrite Forall_forall in *. intros g I.
        apply Sign; auto.
    + destruct (Yes1 Y) as (t & T & Z & P). exists (m + (1 - m) * t). split; [nra |]. split.
      * rewrite E1 in Z. apply Rmult_integral in Z. destruct Z; lra.
      * unfold all_positive in *. rewrite Forall_map in P. rewrite Forall_forall in *. intros g I.
        apply Sign; auto.
Qed.

(** The second derivative on a subinterval. *)
Lemma second_of_part y q a b : length y = 4%nat -> is_part y q a b ->
  exists c, 0 < c /\ forall t, form_at (ddy q) t = c * ((b - a) * (b - a) * form_at (ddy y) (a + (b - a)
    * t)).
Proof.
  intros L (Lq & c & C & E). exists c. split; auto. intros t. rewrite L in Lq.
  pose proof (second_difference q t 1 Lq) as Q. rewrite !E in Q.
  rewrite <- (second_difference y (a + (b - a) * t) (b - a) L).
  replace (a + (b - a) * t + (b - a)) with (a + (b - a) * (t + 1)) by ring.
  replace (a + (b - a) * t - (b - a)) with (a + (b - a) * (t - 1)) by ring. lra.
Qed.
Lemma second_of_cubic y : length y = 4%nat -> exacts (ddy y) = [form_at (ddy y) 0; form_at (ddy y) 1].
Proof. intros L. four y L. unfold at_time. simpl. repeat f_equal; ring. Qed.

Lemma opposite_signs l : opposite l = true ->
  (sign_of (l#0) = negative \/ sign_of (l#0) = positive) /\ (sign_of (l#1) = negative \/ sign_of (l#1) =
    positive).
Proof. unfold opposite. destruct (sign_of (l#0)), (sign_of (l#1)); try discriminate; auto. Qed.
Lemma strict_beside_0 s (x k : R) : s = negative \/ s = positive -> sign_is_right s x -> 0 < k ->
  signs_inside s [k * x; k * 0] /\ signs_inside s [k * 0; k * x].
Proof.
  intros H X K. rewrite Rmult_0_r.
  destruct H as [-> | ->]; simpl in *; [assert (0 < - (k * x)) by nra | assert (0 < k * x) by nra];
    (split; (split; [constructor; [lra | constructor; [lra | constructor]] |]));
    solve [constructor 1; lra | constructor 2; constructor 1; lra].
Qed.

(** The parts at the inflection, and their curvature. *)
Lemma split_at_inflection y : length y = 4%nat -> opposite (ddy y) = true ->
  let (v, w) := linear_root (ddy y) in
  let parts_of f := let (a, b) := split f v w in (normalized a, normalized b) in
  exists m, 0 < m < 1 /\
    (forall p, length p = 4%nat \/ length p = 5%nat ->
       is_part p (fst (parts_of p)) 0 m /\ is_part p (snd (parts_of p)) m 1) /\
    signs_inside (sign_of (ddy y # 0)) (exacts (ddy (fst (parts_of y)))) /\
    signs_inside (sign_of (ddy y # 1)) (exacts (ddy (snd (parts_of y)))).
Proof.
  intros L O. assert (Ls : length (ddy y) = 2%nat) by now four y L.
  destruct (opposite_root _ Ls O) as (m & M & Zm & _ & _ & _ & v & w & E & V & W & Em). rewrite E. intros parts_of.
  assert (P : forall p, length p = 4%nat \/ length p = 5%nat ->
    is_part p (fst (parts_of p)) 0 m /\ is_part p (snd (parts_of p)) m 1).
  { intros p Lp. rewrite Em. destruct (split_parts p v w Lp V W) as (A & B). unfold parts_of.
    destruct (split p v w). split; now apply part_normalized. }
  exists m. split; [easy |]. split; [exact P |]. destruct (P y (or_introl L)) as (P0 & P1).
  assert (L0 := proj1 P0). assert (L1 := proj1 P1). rewrite L in L0, L1.
  destruct (second_of_part y _ 0 m L P0) as (c0 & C0 & S0). destruct (second_of_part y _ m 1 L P1) as (c1 & C1 & S1).
  assert (At0 : form_at (ddy y) 0 = exact (ddy y # 0)) by (apply at_start; now destruct (ddy y)).
  assert (At1 : form_at (ddy y) 1 = exact (ddy y # 1)) by now apply at_finish.
  assert (K0 : 0 < c0 * ((m - 0) * (m - 0))) by (repeat apply Rmult_lt_0_compat; lra).
  assert (K1 : 0 < c1 * ((1 - m) * (1 - m))) by (repeat apply Rmult_lt_0_compat; lra).
  rewrite (second_of_cubic _ L0), !S0, (second_of_cubic _ L1), !S1.
  replace (0 + (m - 0) * 0) with 0 by ring. replace (0 + (m - 0) * 1) with m by ring.
  replace (m + (1 - m) * 0) with m by ring. replace (m + (1 - m) * 1) with 1 by ring.
  rewrite Zm, At0, At1, <- !Rmult_assoc, (Rmult_assoc c0), (Rmult_assoc c1). split.
  - apply (strict_beside_0 _ _ _ (proj1 (opposite_signs _ O)) (sign_right S (ddy y # 0)) K0).
  - apply (strict_beside_0 _ _ _ (proj2 (opposite_signs _ O)) (sign_right S (ddy y # 1)) K1).
Qed.

Lemma on_part_sound halvings : forall y gs, length y = 4%nat -> five gs -> sound (on_part y gs halvings)
  y gs.
Proof.
  assert (Five : forall gs m (f : list S -> list S * list S),
    (forall p, length p = 4%nat \/ length p = 5%nat -> is_part p (fst (f p)) 0 m /\ is_part p (snd (f
      p)) m 1) ->
    five gs -> five (map (fun p => fst (f p)) gs) /\ five (map (fun p => snd (f p)) gs) /\
    Forall (fun g => is_part g (fst (f g)) 0 m /\ is_part g (snd (f g)) m 1) gs).
  { intros gs m f P F. rewrite !Forall_map. repeat split; eapply Forall_impl; try exact F; simpl; intros
      g Lg;
      destruct (P g (or_intror Lg)) as ((L0 & _) & (L1 & _)); try congruence; now apply P; right. }
  assert (Case : forall y gs (more : list S -> list (list S) -> existence),
    length y = 4%nat -> five gs ->
    (forall y gs, length y = 4%nat -> five gs -> sound (more y gs) y gs) ->
    sound (on_whole_part y gs uncertain (fun second =>
      if opposite second then
        let (v, w) := linear_root second in
        let parts_of f := let (a, b) := split f v w in (normalized a, normalized b) in
        either (on_curved (fst (parts_of y)) (map (fun f => fst (parts_of f)) gs) (sign_of (second#0)))
               (on_curved (snd (parts_of y)) (map (fun f => snd (parts_of f)) gs) (sign_of (second#1)))
      else
        let parts_of f := let (a, b) := halves f in (normalized a, normalized b) in
        in_turn (more (fst (parts_of y)) (map (fun f => fst (parts_of f)) gs))
                (more (snd (parts_of y)) (map (fun f => snd (parts_of f)) gs)))) y gs).
  { intros y gs more L F More. apply on_whole_part_sound; simpl; auto; [| discriminate]. intros _.
    destruct (opposite (ddy y)) eqn:O.
    - pose proof (split_at_inflection y L O) as H. destruct (linear_root (ddy y)) as (v, w). cbv zeta in H.
      set (parts_of := fun f : list S => let (a, b) := split f v w in (normalized a, normalized b)) in *.
      destruct H as (m & M & P & S0 & S1), (opposite_signs _ O) as (C0 & C1).
      destruct (Five gs m parts_of P F) as (F0 & F1 & G). destruct (P y (or_introl L)) as (P0 & P1).
      assert (L0 := proj1 P0). assert (L1 := proj1 P1). rewrite L in L0, L1.
      apply (sound_parts _ (on_curved (fst (parts_of y)) (map (fun f => fst (parts_of f)) gs) (sign_of
        (ddy y # 0)))
        (on_curved (snd (parts_of y)) (map (fun f => snd (parts_of f)) gs) (sign_of (ddy y # 1)))
        y gs (fst (parts_of y)) (snd (parts_of y)) (fun f => fst (parts_of f)) (fun f => snd (parts_of
          f)) m); auto.
      + apply on_curved_sound; auto. destruct C0 as [-> | ->]; discriminate.
      + apply on_curved_sound; auto. destruct C1 as [-> | ->]; discriminate.
      + apply either_no.
      + apply either_yes.
    - set (parts_of := fun f : list S => let (a, b) := halves f in (normalized a, normalized b)).
      assert (P : forall p : list S, length p = 4%nat \/ length p = 5%nat ->
        is_part p (fst (parts_of p)) 0 (/ 2) /\ is_part p (snd (parts_of p)) (/ 2) 1).
      { intros p Lp. destruct (half_parts p Lp) as (A & B). unfold parts_of.
        destruct (halves p). split; now apply part_normalized. }
      destruct (Five gs (/ 2) parts_of P F) as (F0 & F1 & G).
      destruct (P y (or_introl L)) as (P0 & P1).
      assert (L0 := proj1 P0). assert (L1 := proj1 P1). rewrite L in L0, L1.
      apply (sound_parts _ (more (fst (parts_of y)) (map (fun f => fst (parts_of f)) gs))
        (more (snd (parts_of y)) (map (fun f => snd (parts_of f)) gs))
        y gs (fst (parts_of y)) (snd (parts_of y)) (fun f => fst (parts_of f)) (fun f => snd (parts_of
          f)) (/ 2));
        [lra | exact P0 | exact P1 | exact G | now apply More | now apply More | apply in_turn_no |
          apply in_turn_yes]. }
  induction halvings as [| more IH]; intros y gs L F.
  - apply (Case y gs (fun _ _ => maybe_root)); auto. now split.
  - apply (Case y gs (fun y gs => on_part y gs more)); auto.
Qed.

(** ** The decision *)

Lemma sound_normalized e y gs : sound e (normalized y) (map normalized gs) -> sound e y gs.
Proof.
  assert (N : forall p t, (form_at (normalized p) t = 0 <-> form_at p t = 0) /\
    (form_at (normalized p) t < 0 <-> form_at p t < 0) /\ (0 < form_at (normalized p) t <-> 0 < form_at
      p t)).
  { intros p t. destruct (normalized_at p) as (c & C & E). rewrite E. repeat split; intros; nra. }
  intros (No & Yes). split.
  - intros E t T Z. specialize (No E t T (proj2 (proj1 (N y t)) Z)). unfold excluded in *.
    apply Exists_exists in No. destruct No as (f & I & P). apply in_map_iff in I.
    destruct I as (g & <- & I). apply Exists_exists. exists g. split; auto. now apply N.
  - intros E. destruct (Yes E) as (t & T & Z & P). exists t. split; auto. split; [now apply N |].
    unfold all_positive in *. rewrite Forall_map in P. eapply Forall_impl; [| exact P]. simpl. intros g.
      apply N.
Qed.

Lemma root_with_nonnegative_sound y gs : length y = 4%nat -> five gs ->
  sound (root_with_nonnegative y gs) y gs.
Proof.
  intros L F. apply sound_normalized. unfold root_with_nonnegative.
  destruct (certainly_rootless (normalized y)) eqn:R.
  - split; [| easy]. intros _ t T Z. now apply rootless_hull with (t := t) in R.
  - apply on_part_sound; [now rewrite length_normalized |].
    rewrite Forall_map. eapply Forall_impl; [| exact F]. simpl. intros g Lg.
    now rewrite length_normalized.
Qed.

(** A "no" is never wrong. *)
Theorem bsc_no y gs t : length y = 4%nat -> five gs -> root_with_nonnegative y gs = no ->
  0 <= t <= 1 -> form_at y t = 0 -> exists g, In g gs /\ form_at g t < 0.
Proof.
  intros L F E T Z. apply Exists_exists. now apply (proj1 (root_with_nonnegative_sound y gs L F)).
Qed.

(** A "yes" is never wrong. *)
Theorem bsc_yes y gs : length y = 4%nat -> five gs -> root_with_nonnegative y gs = yes ->
  exists t, 0 <= t <= 1 /\ form_at y t = 0 /\ forall g, In g gs -> 0 < form_at g t.
Proof.
  intros L F E. destruct (proj2 (root_with_nonnegative_sound y gs L F) E) as (t & T & Z & P).
  exists t. repeat split; try tauto. now apply Forall_forall.
Qed.

End Answers.
