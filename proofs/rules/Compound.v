(** Functions of tracked numbers that consist of a rule's operations (include/errbound/functions.hpp): midpoint,
    whole powers, dot products by single operations, Horner's rule, as in CompoundCode.v. Over any number type and
    every rule whose operations preserve its bounds (`keeps`):
        midpoint_kept, power_kept, dot_kept, horner_kept

    IeeeCompound.v takes IEEE floats as the numbers. Over the real numbers of DotProduct.v, rounded in any one
    direction, from p = 5 on:
        tight_keeps, tight_horner_sound *)

From Coq Require Import Reals ZArith Lia Lra Bool List.
From Flocq Require Import Core.
From Errbound Require Import Code CompoundCode DotProduct.
From Errbound Require Format Tight Upper.
Import ListNotations.
Open Scope R_scope.

Lemma Forall2_rev {X Y} (P : X -> Y -> Prop) l m : Forall2 P l m -> Forall2 P (rev l) (rev m).
Proof. induction 1; simpl; auto. apply Forall2_app; auto. Qed.

Definition exact_horner (c : list R) (x : R) : R := fold_right (fun a sum => a + x * sum) 0 c.

Section Compound.

Context (T : Type) (A : arithmetic T) (B : Type) (by_rule : operations T B).
Notation rule := (the_rule T B by_rule).

(** The real number of a number, and the meaning of a value and a bound for it. *)
Context (real : T -> R) (holds : T -> B -> R -> Prop).
Definition tracked_holds (x : T * B) (r : R) : Prop := holds (fst x) (snd x) r.

Record keeps : Prop := {
  keeps_zero : holds (integer T A 0%Z) (rule_exact _ _ rule (integer T A 0%Z)) 0;
  keeps_one : holds (integer T A 1%Z) (rule_exact _ _ rule (integer T A 1%Z)) 1;
  keeps_value a b x : holds a b x -> holds a (rule_exact _ _ rule a) (real a);
  keeps_add a sa x b sb y : holds a sa x -> holds b sb y ->
    holds (plus _ A a b) (rule_add _ _ by_rule (plus _ A a b) a sa b sb) (x + y);
  keeps_subtract a sa x b sb y : holds a sa x -> holds b sb y ->
    holds (minus _ A a b) (rule_subtract _ _ rule (minus _ A a b) a sa b sb) (x - y);
  keeps_multiply a sa x b sb y : holds a sa x -> holds b sb y ->
    holds (times _ A a b) (rule_multiply _ _ by_rule (times _ A a b) a sa b sb) (x * y);
  keeps_scale a sa x e : holds a sa x ->
    holds (scale _ A a e) (rule_scale _ _ by_rule (scale _ A a e) a sa e) (x * bpow radix2 e);
  (** A bound also holds for a number that is a zero of the other sign. *)
  keeps_beside_zero a b x : holds a b x -> holds (plus _ A (integer T A 0%Z) a) b x;
  keeps_without_zero a sa x b c d r e : holds a sa x ->
    let v := plus _ A a (times _ A b (minus _ A c c)) in
    holds v d r -> less _ A (tracked_error T A B rule (v, d)) e = true -> holds a d r
}.
Hypothesis K : keeps.

Lemma add_kept x r y s : tracked_holds x r -> tracked_holds y s ->
  tracked_holds (tracked_add T A B by_rule x y) (r + s).
Proof. apply (keeps_add K). Qed.
Lemma multiply_kept x r y s : tracked_holds x r -> tracked_holds y s ->
  tracked_holds (tracked_multiply T A B by_rule x y) (r * s).
Proof. apply (keeps_multiply K). Qed.
Lemma scale_kept x r e : tracked_holds x r -> tracked_holds (tracked_scale T A B by_rule x e) (r * bpow radix2 e).
Proof. apply (keeps_scale K). Qed.

(** The sum need not be finite. *)
Theorem midpoint_kept x r y s : tracked_holds x r -> tracked_holds y s ->
  tracked_holds (tracked_midpoint T A B by_rule x y) ((r + s) / 2).
Proof.
  intros X Y. unfold tracked_midpoint. cbv zeta.
  replace ((r + s) / 2) with ((r + s) * bpow radix2 (-1)) by (change (bpow radix2 (-1)) with (/ 2); reflexivity).
  destruct (_ && _).
  - apply scale_kept. now apply add_kept.
  - rewrite Rmult_plus_distr_r. apply add_kept; now apply scale_kept.
Qed.

(** Powers with a positive whole exponent. *)
Lemma power_loop_kept x r : forall bits first result s power t k,
  tracked_holds power t -> (first = false -> tracked_holds result s) ->
  t = r ^ k -> (first = true -> s = 1) ->
  tracked_holds x r -> tracked_holds (power_loop T A B by_rule bits first result power) (s * r ^ (k * Pos.to_nat bits)).
Proof.
  intros bits. induction bits as [bits IH | bits IH |]; intros first result s power t k P Q E F X; cbn [power_loop].
  - assert (S : tracked_holds (if first then power else tracked_multiply T A B by_rule result power) (s * t)).
    { destruct first; [rewrite (F eq_refl), Rmult_1_l; exact P | apply multiply_kept; auto]. }
    replace (s * r ^ (k * Pos.to_nat bits~1)) with (s * t * r ^ (k * 2 * Pos.to_nat bits)).
    + apply IH with (t * t); auto; try discriminate; [now apply multiply_kept |].
      rewrite E, <- pow_add. f_equal. lia.
    + rewrite E, Rmult_assoc, <- pow_add. do 2 f_equal. rewrite Pos2Nat.inj_xI. lia.
  - replace (s * r ^ (k * Pos.to_nat bits~0)) with (s * r ^ (k * 2 * Pos.to_nat bits)).
    + apply IH with (t * t); auto; [now apply multiply_kept |]. rewrite E, <- pow_add. f_equal. lia.
    + do 2 f_equal. rewrite Pos2Nat.inj_xO. lia.
  - replace (k * Pos.to_nat 1)%nat with k by lia. rewrite <- E.
    destruct first; [rewrite (F eq_refl), Rmult_1_l; exact P | apply multiply_kept; auto].
Qed.
Theorem power_kept x r n : (0 <= n)%Z -> tracked_holds x r ->
  tracked_holds (tracked_pow T A B by_rule x n) (r ^ Z.to_nat n).
Proof.
  intros N X. destruct n as [| bits | bits]; [apply (keeps_one K) | | lia].
  cbn [tracked_pow Z.to_nat]. rewrite <- (Rmult_1_l (r ^ _)).
  replace (Pos.to_nat bits) with (1 * Pos.to_nat bits)%nat by lia.
  apply power_loop_kept with x r; auto; [discriminate | simpl; ring].
Qed.

(** Dot products under rules without a dot_bound. *)
Definition tracked_pair (pair : (T * B) * (T * B)) (exact : R * R) : Prop :=
  tracked_holds (fst pair) (fst exact) /\ tracked_holds (snd pair) (snd exact).
Theorem dot_kept pairs exacts : Forall2 tracked_pair pairs exacts ->
  tracked_holds (tracked_dot T A B by_rule pairs) (exact_dot exacts).
Proof.
  assert (L : forall l e, Forall2 tracked_pair l e -> forall s r, tracked_holds s r ->
    tracked_holds (fold_left (fun sum pair =>
      tracked_add T A B by_rule sum (tracked_multiply T A B by_rule (fst pair) (snd pair))) l s) (r + exact_dot e)).
  { induction 1 as [| pair exact l e [P1 P2] _ IH]; intros s r S; simpl; [now rewrite Rplus_0_r |].
    rewrite <- Rplus_assoc. apply IH, add_kept; auto. now apply multiply_kept. }
  intros H. destruct H as [| pair exact l e [P1 P2] H]; [apply (keeps_zero K) |].
  cbn [tracked_dot exact_dot fold_right]. apply L; auto. apply (keeps_beside_zero K). now apply multiply_kept.
Qed.

(** Horner's rule. *)
Lemma step_kept x r s p c t : tracked_holds x r -> tracked_holds s p -> tracked_holds c t ->
  tracked_holds (horner_step T A B by_rule x s c) (p * r + t).
Proof. intros X S C. unfold horner_step. apply add_kept; auto. now apply multiply_kept. Qed.
Lemma steps_kept x r l e : tracked_holds x r -> Forall2 tracked_holds l e -> forall s p, tracked_holds s p ->
  tracked_holds (fold_left (horner_step T A B by_rule x) l s) (fold_left (fun sum a => sum * r + a) e p).
Proof. intros X. induction 1; intros s p S; simpl; auto. apply IHForall2. now apply step_kept. Qed.
(** If p has value v at x and slope q: p(x) x = p(v) v + q(x) (x - v). *)
Lemma slope_kept at_value v x r l e : tracked_holds at_value v -> tracked_holds x r -> Forall2 tracked_holds l e ->
  forall s p t q, tracked_holds (fst s) t -> tracked_holds (snd s) q -> p * r = t * v + q * (r - v) ->
  exists t' q', tracked_holds (fst (fold_left (slope_step T A B by_rule at_value x) l s)) t' /\
    tracked_holds (snd (fold_left (slope_step T A B by_rule at_value x) l s)) q' /\
    fold_left (fun sum a => sum * r + a) e p * r = t' * v + q' * (r - v).
Proof.
  intros V X. induction 1 as [| c a l e C _ IH]; intros s p t q S1 S2 E; simpl; [now exists t, q |].
  apply IH with (t * v + a) (q * r + (t * v + a)); unfold slope_step; cbn [fst snd].
  - now apply step_kept.
  - apply add_kept; [now apply multiply_kept | now apply step_kept].
  - rewrite E. ring.
Qed.
Lemma same_values at_value x l : fst at_value = fst x -> forall s t, fst (fst s) = fst t ->
  fst (fst (fold_left (slope_step T A B by_rule at_value x) l s)) = fst (fold_left (horner_step T A B by_rule x) l t).
Proof.
  intros V. induction l as [| c l IH]; intros s t S; simpl; auto. apply IH. unfold slope_step. simpl.
  now rewrite S, V.
Qed.
Theorem horner_kept c exact x r : Forall2 tracked_holds c exact -> tracked_holds x r ->
  tracked_holds (tracked_horner T A B by_rule c x) (exact_horner exact r).
Proof.
  intros H X. destruct H as [| c0 a0 higher e C0 H]; [apply (keeps_zero K) |].
  cbn [tracked_horner exact_horner fold_right]. fold (exact_horner e r).
  assert (EX : exact_horner e r = fold_left (fun sum a => sum * r + a) (rev e) 0).
  { unfold exact_horner. rewrite <- fold_left_rev_right, rev_involutive.
    induction e as [| a e' IH'] in |- *; simpl; auto. rewrite IH'. ring. }
  apply Forall2_rev in H. rewrite EX. clear EX.
  destruct H as [| top b middle m Top H]; [simpl; now rewrite Rmult_0_r, Rplus_0_r |].
  cbn [fold_left]. rewrite Rmult_0_l, Rplus_0_l. set (p := fold_left _ m b).
  replace (a0 + r * p) with (p * r + a0) by ring. cbv zeta.
  set (result := horner_step T A B by_rule x (fold_left (horner_step T A B by_rule x) middle top) c0).
  assert (KR : tracked_holds result (p * r + a0)) by (apply step_kept; auto; now apply steps_kept).
  destruct (_ || _); [exact KR |].
  set (at_value := tracked_exactly T B rule (fst x)).
  assert (V : tracked_holds at_value (real (fst x))) by (apply (keeps_value K) with (1 := X)).
  destruct (slope_kept at_value _ x r middle m V X H (top, top) b b b Top Top ltac:(ring)) as (t & q & KT & KQ & E).
  fold p in E.
  assert (SV := same_values at_value x middle eq_refl (top, top) top eq_refl).
  set (s := fold_left _ middle (top, top)) in *.
  destruct (_ && _) eqn:C; [| exact KR]. apply andb_prop in C. destruct C as [C _].
  assert (KS : tracked_holds (tracked_add T A B by_rule (horner_step T A B by_rule at_value (fst s) c0)
      (tracked_multiply T A B by_rule (snd s) (tracked_subtract T A B rule x at_value))) (p * r + a0)).
  { replace (p * r + a0) with ((t * real (fst x) + a0) + q * (r - real (fst x))) by (rewrite E; ring).
    apply add_kept; [now apply step_kept |]. apply multiply_kept; auto. apply (keeps_subtract K); auto. }
  assert (EV : fst (horner_step T A B by_rule at_value (fst s) c0) = fst result).
  { unfold horner_step, result. simpl. now rewrite SV. }
  unfold tracked_holds in *. set (added := tracked_add T A B by_rule (horner_step _ _ _ _ _ _ _) _) in *.
  assert (EA : added = (plus T A (fst result) (times T A (fst (snd s)) (minus T A (fst x) (fst x))), snd added)).
  { rewrite (surjective_pairing added) at 1. f_equal. unfold added, tracked_add. cbn [fst]. rewrite EV. reflexivity. }
  rewrite EA in KS, C. cbn [fst snd] in KS. exact (keeps_without_zero K _ _ _ _ _ _ _ _ KR KS C).
Qed.

End Compound.

(** The rule tight over the real numbers, rounded in any one direction. *)
Section Tight_keeps.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (emin_p : (emin <= - p)%Z) (p_5 : (5 <= p)%Z) (direction : R -> Z)
  {direction_valid : Valid_rnd direction}.
Notation fl := (Format.rnd p emin direction).
Notation number := (Format.number p emin).
Notation rounded := (reals p emin direction).

Definition known_within (a s x : R) : Prop := number a /\ number s /\ Rabs (a - x) <= s.

Lemma exactly_known a : number a -> known_within a (tight_exact R rounded a) a.
Proof.
  intros N. unfold tight_exact. cbn [minus reals]. rewrite Rminus_eq_0, Format.rnd_0 by auto.
  split; [exact N |]. split; [apply Format.number_0 |]. rewrite Rminus_eq_0, Rabs_R0. lra.
Qed.
Lemma sum_of_bounds_reals enlarged own x y :
  sum_of_bounds R rounded enlarged own x y = Upper.sum_of_bounds p emin direction enlarged own x y.
Proof.
  unfold sum_of_bounds, Upper.sum_of_bounds.
  replace (integer R rounded (2 ^ Z.max 0 (digits R rounded - 11))) with (bpow radix2 (Z.max 0 (p - 11))).
  2: { cbn [integer digits reals]. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia. reflexivity. }
  assert (S : forall s t, sum_above R rounded s t = Upper.sum_above p emin direction s t).
  { intros s t. unfold sum_above, Upper.sum_above, Code.max, Code.least. cbn [plus minus times less integer epsilon reals].
    replace (if Rlt_bool s t then t else s) with (Rmax s t)
      by (unfold Rmax; destruct (Rle_dec s t); case Rlt_bool_spec; lra).
    replace (if Rlt_bool t s then t else s) with (Rmin s t)
      by (unfold Rmin; destruct (Rle_dec s t); case Rlt_bool_spec; lra).
    reflexivity. }
  rewrite !S. reflexivity.
Qed.
Theorem tight_keeps : keeps R rounded R (tight_operations R rounded) (fun x => x) known_within.
Proof.
  assert (N : forall x, number (fl x)) by (intros; now apply Format.rnd_number).
  assert (Rounding : forall v, tight_rounding R rounded v = Tight.rounding p emin direction v).
  { intros v. unfold tight_rounding. rewrite abs_reals. reflexivity. }
  split; cbn [tight_operations the_rule tight_rule rule_exact rule_subtract rule_add rule_multiply rule_scale rule_error
    plus minus times scale integer reals].
  - apply exactly_known, Format.number_0.
  - apply exactly_known. change 1 with (bpow radix2 0). apply Format.number_power; auto. lia.
  - intros a b x H. apply exactly_known, H.
  - intros a sa x b sb y (A & SA & HA) (B & SB & HB). unfold tight_add. rewrite sum_of_bounds_reals, Rounding.
    split; [apply N |]. split; [apply (Tight.tight_add_number p emin direction) |]. now apply Tight.tight_add_sound.
  - intros a sa x b sb y (A & SA & HA) (B & SB & HB). unfold tight_add. rewrite sum_of_bounds_reals, Rounding.
    split; [apply N |]. split; [apply (Tight.tight_add_number p emin direction) |]. now apply Tight.tight_subtract_sound.
  - intros a sa x b sb y (A & SA & HA) (B & SB & HB). unfold tight_multiply. rewrite Rounding, !abs_reals.
    split; [apply N |]. split; [apply (Tight.tight_multiply_number p emin direction (fl (a * b)) a sa b sb) |].
    now apply Tight.tight_multiply_sound.
  - intros a sa x e (A & SA & HA). split; [apply N |]. split; [| now apply Tight.tight_scale_sound].
    unfold tight_scale. cbv zeta. destruct (_ || _); apply N.
  - intros a b x (A & SB & H). rewrite Rplus_0_l, Format.rnd_exact by auto. now split.
  - intros a sa x b c d r e (A & _). rewrite Rminus_eq_0, Format.rnd_0, Rmult_0_r, Format.rnd_0, Rplus_0_r, Format.rnd_exact by auto.
    auto.
Qed.
Theorem tight_horner_sound c exact x sx r :
  Forall2 (fun a t => known_within (fst a) (snd a) t) c exact -> known_within x sx r ->
  let result := tracked_horner R rounded R (tight_operations R rounded) c (x, sx) in
  known_within (fst result) (snd result) (exact_horner exact r).
Proof. intros H X. exact (horner_kept _ _ _ _ _ _ tight_keeps c exact (x, sx) r H X). Qed.

End Tight_keeps.
