(** TightCCD loses no collision: the rule tight (Tight.v) under BSC (Decisions.v), to nearest.

    A tracked number is a computed value with a computed bound, and the real number that it stands for,
    of which the value is known to within the bound. Overflow is left out, as in Tight.v, and so is the
    rescaling of forms far from 1 (`normalized`, the identity here: scale of the rule is not proved).
    Results: tightccd_face_separate, tightccd_edges_separate   a "no" on floating-point coordinates
             is right; so is a "yes" (bsc_face_collides, bsc_edges_collide of this scalar) *)

From Coq Require Import Reals ZArith Lia Lra List.
From Flocq Require Import Core.
From Errbound Require Import Format Tight Sign Bernstein Bsc Contact Decisions.
Open Scope R_scope.

Section Tightccd.

Variables p emin : Z.
Context {p_positive : Prec_gt_0 p}.
Hypothesis emin_p : (emin <= - p)%Z.
Hypothesis p_3 : (3 <= p)%Z.
Notation fl := (rnd p emin nearest).
Notation is_number := (Format.number p emin).

Record tracked := Tracked {
  value : R;
  bound : R;
  meant : R;
  value_number : is_number value;
  bound_number : is_number bound;
  within : Rabs (value - meant) <= bound
}.

Definition tracked_add (a b : tracked) : tracked := Tracked
  (fl (value a + value b)) (tight_add p emin nearest (fl (value a + value b)) (bound a) (bound b))
    (meant a + meant b)
  (rnd_number _ _ _ _) (tight_add_number _ _ _ _ _ _)
  (tight_add_sound_nearest p emin emin_p p_3 _ _ _ _ _ _ (value_number a) (value_number b) (bound_number
    a)
     (bound_number b) (within a) (within b)).
Definition tracked_sub (a b : tracked) : tracked := Tracked
  (fl (value a - value b)) (tight_add p emin nearest (fl (value a - value b)) (bound a) (bound b))
    (meant a - meant b)
  (rnd_number _ _ _ _) (tight_add_number _ _ _ _ _ _)
  (tight_subtract_sound_nearest p emin emin_p p_3 _ _ _ _ _ _ (value_number a) (value_number b)
    (bound_number a)
     (bound_number b) (within a) (within b)).
Definition tracked_mul (a b : tracked) : tracked := Tracked
  (fl (value a * value b))
  (tight_multiply p emin nearest (fl (value a * value b)) (value a) (bound a) (value b) (bound b))
    (meant a * meant b)
  (rnd_number _ _ _ _) (tight_multiply_number _ _ _ _ _ _ _ _)
  (tight_multiply_sound_nearest p emin emin_p p_3 _ _ _ _ _ _ (value_number a) (value_number b)
    (bound_number a)
     (bound_number b) (within a) (within b)).

Lemma within_opp a : Rabs (- value a - - meant a) <= bound a.
Proof. replace (- value a - - meant a) with (- (value a - meant a)) by ring. rewrite Rabs_Ropp. apply
  within. Qed.
Definition tracked_opp (a : tracked) : tracked := Tracked
  (- value a) (bound a) (- meant a) (number_opp _ _ _ (value_number a)) (bound_number a) (within_opp a).

Lemma number_twice x : is_number x -> is_number (2 * x).
Proof.
  intros N. apply FLT_format_generic in N; [| exact p_positive]. destruct N as [[m e] E M L]. simpl in
    *. subst x.
  apply generic_format_FLT. exists (Float radix2 m (e + 1)); cbn [Fnum Fexp]; [| exact M | lia].
  unfold F2R. cbn [Fnum Fexp]. rewrite bpow_plus. change (bpow radix2 1) with 2. ring.
Qed.
Lemma within_twice a : Rabs (2 * value a - 2 * meant a) <= 2 * bound a.
Proof.
  replace (2 * value a - 2 * meant a) with (2 * (value a - meant a)) by ring.
  rewrite Rabs_mult, (Rabs_pos_eq 2) by lra. generalize (within a). lra.
Qed.
Definition tracked_twice (a : tracked) : tracked := Tracked (2 * value a) (2 * bound a) (2 * meant a)
  (number_twice _ (value_number a)) (number_twice _ (bound_number a)) (within_twice a).

Lemma within_exact x : Rabs (x - x) <= 0.
Proof. replace (x - x) with 0 by ring. rewrite Rabs_R0. lra. Qed.
(** A floating-point number: bound tight_exact, which is 0. *)
Definition tracked_exact (x : R) (N : is_number x) : tracked := Tracked x 0 x N (number_0 p emin)
  (within_exact x).

(** Whole numbers; the code has those of at most p bits. *)
Lemma small_whole n : (Z.abs n <= 2 ^ p)%Z -> is_number (IZR n).
Proof.
  intros L. rewrite <- Rmult_1_r. change 1 with (bpow radix2 0). apply number_integer; auto.
  unfold Prec_gt_0 in p_positive. lia.
Qed.
Lemma large_whole n : ~ (Z.abs n <= 2 ^ p)%Z -> is_number (bpow radix2 (mag radix2 (IZR n))).
Proof.
  intros L. apply number_power; auto. unfold Prec_gt_0 in p_positive.
  assert (0 < mag radix2 (IZR n))%Z; [| lia]. apply mag_gt_bpow. simpl. rewrite <- abs_IZR. apply
    IZR_le. lia.
Qed.
Lemma within_large n : Rabs (0 - IZR n) <= bpow radix2 (mag radix2 (IZR n)).
Proof. rewrite Rminus_0_l, Rabs_Ropp. left. apply bpow_mag_gt. Qed.
Definition tracked_whole (n : Z) : tracked :=
  match Z_le_dec (Z.abs n) (2 ^ p) with
  | left L => tracked_exact (IZR n) (small_whole n L)
  | right L => Tracked 0 _ (IZR n) (number_0 p emin) (large_whole n L) (within_large n)
  end.
Lemma meant_whole n : meant (tracked_whole n) = IZR n.
Proof. unfold tracked_whole. destruct (Z_le_dec _ _); easy. Qed.

Lemma unchanged_right (l : list tracked) : exists c, 0 < c /\ map meant l = map (Rmult c) (map meant l).
Proof.
  exists 1. split; [lra |]. rewrite map_map. apply map_ext. intros. ring.
Qed.
Lemma tracked_sign_right a : sign_is_right (Sign.sign_of (finite (value a)) (finite (bound a))) (meant
  a).
Proof. apply sign_certain, within. Qed.

Definition tight_scalar : scalar := {|
  Bernstein.number := tracked;
  add := tracked_add; sub := tracked_sub; mul := tracked_mul; opp := tracked_opp;
  whole := tracked_whole; twice := tracked_twice; normalized := fun l => l;
  Bernstein.sign_of := fun a => Sign.sign_of (finite (value a)) (finite (bound a)); exact := meant;
  exact_add := fun _ _ => eq_refl; exact_sub := fun _ _ => eq_refl; exact_mul := fun _ _ => eq_refl;
  exact_opp := fun _ => eq_refl; exact_whole := meant_whole; exact_twice := fun _ => eq_refl;
  normalized_right := unchanged_right; sign_right := tracked_sign_right |}.

(** A position of floating-point coordinates. *)
Definition at_numbers (q : @position tight_scalar) (x : point) : Prop :=
  exists (X : is_number (Contact.x x)) (Y : is_number (Contact.y x)) (Z : is_number (Contact.z x)),
  q = @Position tight_scalar (tracked_exact _ X) (tracked_exact _ Y) (tracked_exact _ Z).
Definition moves (q : @moving_point tight_scalar) (m : moving) : Prop :=
  at_numbers (t0 q) (start m) /\ at_numbers (t1 q) (finish m).

Lemma moves_exactly q m : moves q m -> exact_motion q = m.
Proof.
  intros ((X & Y & Z & E) & (X' & Y' & Z' & E')). unfold exact_motion. rewrite E, E'.
  destruct m as [[] []]. reflexivity.
Qed.

Theorem tightccd_face_separate v f0 f1 f2 (V F0 F1 F2 : moving) :
  moves v V -> moves f0 F0 -> moves f1 F1 -> moves f2 F2 ->
  let b := difference f1 f0 in let c := difference f2 f0 in let q := difference v f0 in
  root_with_nonnegative (y_form b c q) (inside_face_forms b c q) = no -> ~ vertex_face_collides V F0 F1
    F2.
Proof.
  intros HV H0 H1 H2 b c q E. apply moves_exactly in HV, H0, H1, H2. subst. now apply bsc_face_separate.
Qed.
Theorem tightccd_edges_separate a0 a1 b0 b1 (A0 A1 B0 B1 : moving) :
  moves a0 A0 -> moves a1 A1 -> moves b0 B0 -> moves b1 B1 ->
  let b := difference a1 a0 in let c := difference b1 b0 in let q := difference b0 a0 in
  root_with_nonnegative (y_form b c q) (inside_edges_forms b c q) = no -> ~ edge_edge_collides A0 A1 B0
    B1.
Proof.
  intros HA0 HA1 HB0 HB1 b c q E. apply moves_exactly in HA0, HA1, HB0, HB1. subst. now apply
    bsc_edges_separate.
Qed.

End Tightccd.
