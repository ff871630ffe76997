(** First times of packs of queries (ccd/batch/time_stage.hpp): roots of Y on two subintervals of the step, and the
    one that is the contact. double, to nearest, with rounded numbers; Twofold.v has the signs of Y at doubles.
    Results:
        lerp_near, value_near   de Casteljau's steps, and a value at t, in floating point
        parts_at                exactly, they are the control values of the subintervals before and after t
        quartic_slope           a quartic changes by at most 8 times its largest control value's size times the way
        only_root_first, first_of_two, second_of_two   the root that is the first contact
        root_reached            signs of Y before and after t: the first of two roots is within reach
        bracket_around          its bracket, by signs at adjacent doubles *)

From Coq Require Import Reals ZArith Lia Lra Psatz List.
From Flocq Require Import Core.
From Errbound Require Import Bernstein CubicRoots Subdivision Contact Separation TimeBrackets Format Twofold.
Import ListNotations.
Open Scope R_scope.

(** ** De Casteljau *)

Definition lerp (t a b : R) : R := fl (a + fl (t * fl (b - a))).
Definition exact_lerp (t a b : R) : R := a + t * (b - a).
Theorem lerp_near t a b m : double a -> double b -> 0 <= t <= 1 -> Rabs a <= m -> Rabs b <= m ->
  Rabs (lerp t a b - exact_lerp t a b) <= 51 / 10 * (u * m) + 2 * eta /\ Rabs (lerp t a b) <= m + 51 / 10 * (u * m) + 2 * eta.
Proof.
  intros A B T Ma Mb. pose proof u_small as U. pose proof (eta_positive (-1074)) as E. unfold lerp, exact_lerp.
  assert (M0 : 0 <= m) by (pose proof (Rabs_pos a); lra). assert (Um : 0 <= u * m) by (apply Rmult_le_pos; lra).
  assert (Uu : u * (u * m) <= / 4096 * (u * m)) by (apply Rmult_le_compat_r; lra).
  assert (Ue : 0 <= u * eta <= / 4096 * eta) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; lra).
  pose proof (fl_difference b a B A) as R1. set (d := fl (b - a)) in *.
  assert (D : Rabs (b - a) <= 2 * m).
  { pose proof (Rabs_triang b (- a)) as Q. rewrite Rabs_Ropp in Q. change (b + - a) with (b - a) in Q. lra. }
  assert (D1 : Rabs (d - (b - a)) <= 2 * (u * m)).
  { apply Rle_trans with (1 := R1). apply Rle_trans with (u * (2 * m)); [apply Rmult_le_compat_l; lra | lra]. }
  assert (D2 : Rabs d <= 2 * m + 2 * (u * m)).
  { replace d with (d - (b - a) + (b - a)) by ring. eapply Rle_trans; [apply Rabs_triang |]. lra. }
  assert (D3 : Rabs (t * d) <= 2 * m + 2 * (u * m)).
  { rewrite Rabs_mult, (Rabs_pos_eq t) by lra. apply Rle_trans with (1 * Rabs d); [apply Rmult_le_compat_r; [apply Rabs_pos | lra] | lra]. }
  pose proof (fl_any (t * d)) as R2. set (w := fl (t * d)) in *.
  assert (W : Rabs (w - t * d) <= 2 * (u * m) + 2 * (u * (u * m)) + eta).
  { apply Rle_trans with (1 := R2). apply Rplus_le_compat_r.
    apply Rle_trans with (u * (2 * m + 2 * (u * m))); [apply Rmult_le_compat_l; lra | lra]. }
  assert (Dt : Rabs (t * (d - (b - a))) <= 2 * (u * m)).
  { rewrite Rabs_mult, (Rabs_pos_eq t) by lra. apply Rle_trans with (1 * Rabs (d - (b - a)));
      [apply Rmult_le_compat_r; [apply Rabs_pos | lra] | lra]. }
  assert (X : Rabs (a + t * (b - a)) <= m).
  { replace (a + t * (b - a)) with ((1 - t) * a + t * b) by ring. apply Rabs_le_inv in Ma, Mb. apply Rabs_le. split; nra. }
  assert (Y : Rabs (a + w - (a + t * (b - a))) <= 401 / 100 * (u * m) + eta).
  { replace (a + w - (a + t * (b - a))) with (w - t * d + t * (d - (b - a))) by ring.
    eapply Rle_trans; [apply Rabs_triang |]. lra. }
  assert (Z : Rabs (a + w) <= m + 401 / 100 * (u * m) + eta).
  { replace (a + w) with (a + w - (a + t * (b - a)) + (a + t * (b - a))) by ring. eapply Rle_trans; [apply Rabs_triang |]. lra. }
  pose proof (fl_sum a w A (fl_number _)) as R3. set (r := fl (a + w)) in *.
  assert (V : Rabs (r - (a + w)) <= u * m + 5 * (u * (u * m)) + u * eta).
  { apply Rle_trans with (1 := R3). apply Rle_trans with (u * (m + 401 / 100 * (u * m) + eta)); [apply Rmult_le_compat_l; lra |].
    assert (0 <= u * (u * m)) by (apply Rmult_le_pos; lra). lra. }
  assert (N : Rabs (r - (a + t * (b - a))) <= 51 / 10 * (u * m) + 2 * eta).
  { replace (r - (a + t * (b - a))) with (r - (a + w) + (a + w - (a + t * (b - a)))) by ring.
    eapply Rle_trans; [apply Rabs_triang |]. lra. }
  split; auto. replace r with (r - (a + t * (b - a)) + (a + t * (b - a))) by ring.
  eapply Rle_trans; [apply Rabs_triang |]. lra.
Qed.

(** Rows: each pass computes the steps between neighbours. *)
Theorem parts_at a b c d t v : let l := exact_lerp t in
  let ab := l a b in let bc := l b c in let cd := l c d in let abc := l ab bc in let bcd := l bc cd in let m := l abc bcd in
  control_at [a; ab; abc; m] v = control_at [a; b; c; d] (t * v) /\
  control_at [m; bcd; cd; d] v = control_at [a; b; c; d] (t + (1 - t) * v) /\ m = control_at [a; b; c; d] t.
Proof. cbv zeta. rewrite !control_cubic. unfold exact_lerp. simpl. repeat split; ring. Qed.

(** Rows of doubles near rows of numbers; each pass adds e. *)
Definition row_near (e m : R) (p q : list R) : Prop := Forall2 (fun a b => double a /\ Rabs a <= m /\ Rabs (a - b) <= e) p q.
Lemma row_wider e m n p q : m <= n -> row_near e m p q -> row_near e n p q.
Proof. intros L F. induction F as [| a b p q (A & M & N) F IH]; constructor; auto. repeat split; auto. lra. Qed.
Lemma row_step t e m p q : 0 <= t <= 1 -> row_near e m p q ->
  row_near (e + 51 / 10 * (u * m) + 2 * eta) (m + 51 / 10 * (u * m) + 2 * eta) (next_row (lerp t) p) (next_row (exact_lerp t) q).
Proof.
  intros T F. induction F as [| a x p q (A & Ma & Na) F IH]; [constructor |]. destruct F as [| b y p q (B & Mb & Nb) F]; [constructor |].
  cbn [next_row] in *. constructor; auto. destruct (lerp_near t a b m A B T Ma Mb) as (N & S).
  split; [apply fl_number |]. split; auto.
  replace (lerp t a b - exact_lerp t x y) with (lerp t a b - exact_lerp t a b + ((1 - t) * (a - x) + t * (b - y)))
    by (unfold exact_lerp; ring).
  eapply Rle_trans; [apply Rabs_triang |]. assert (Rabs ((1 - t) * (a - x) + t * (b - y)) <= e); [| lra].
  apply Rabs_le_inv in Na, Nb. apply Rabs_le. split; nra.
Qed.
Fixpoint after_rows (n : nat) (lerp : R -> R -> R) (p : list R) : list R :=
  match n with O => p | S n => after_rows n lerp (next_row lerp p) end.
(** Each row adds an error of about 5.2u of the largest size. *)
Lemma rows_near t m n : 0 <= t <= 1 -> 0 <= m -> (n <= 4)%nat -> forall e k p q, 0 <= k ->
  (k <= 4 - INR n)%R -> row_near e (m + 52 / 10 * k * (u * m) + 3 * k * eta) p q -> e <= 52 / 10 * k * (u * m) + 3 * k * eta ->
  exists e' m', row_near e' m' (after_rows n (lerp t) p) (after_rows n (exact_lerp t) q) /\
    e' <= 52 / 10 * (k + INR n) * (u * m) + 3 * (k + INR n) * eta.
Proof.
  intros T M. pose proof u_small as U. pose proof (eta_positive (-1074)) as E. assert (Um : 0 <= u * m) by (apply Rmult_le_pos; lra).
  assert (Uu : u * (u * m) <= / 4096 * (u * m)) by (apply Rmult_le_compat_r; lra).
  assert (Ue : 0 <= u * eta <= / 4096 * eta) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; lra).
  induction n as [| n IH]; intros N e k p q K L F H.
  - exists e, (m + 52 / 10 * k * (u * m) + 3 * k * eta). split; auto. change (INR 0) with 0. rewrite Rplus_0_r. exact H.
  - rewrite S_INR in *. pose proof (pos_INR n) as N0. pose proof (row_step t _ _ _ _ T F) as G.
    assert (K4 : k <= 3) by lra. cbn [after_rows].
    assert (Q : u * (m + 52 / 10 * k * (u * m) + 3 * k * eta) <= u * m + / 100 * (u * m) + / 100 * eta).
    { assert (k * (u * (u * m)) <= 3 * (u * (u * m))) by (apply Rmult_le_compat_r; [apply Rmult_le_pos |]; lra).
      assert (k * (u * eta) <= 3 * (u * eta)) by (apply Rmult_le_compat_r; lra). lra. }
    destruct (IH ltac:(lia) (e + 51 / 10 * (u * (m + 52 / 10 * k * (u * m) + 3 * k * eta)) + 2 * eta) (k + 1)
      (next_row (lerp t) p) (next_row (exact_lerp t) q)) as (e' & m' & R & B); [lra | lra | | lra |].
    + apply row_wider with (2 := G). lra.
    + exists e', m'. split; auto. lra.
Qed.
Theorem value_near t m p : 0 <= t <= 1 -> length p = 4%nat \/ length p = 5%nat -> Forall (fun a => double a /\ Rabs a <= m) p ->
  exists v, after_rows (length p - 1) (lerp t) p = [v] /\ Rabs (v - control_at p t) <= 21 * (u * m) + 12 * eta.
Proof.
  intros T L F. assert (M : 0 <= m).
  { destruct p as [| a p]; [destruct L; discriminate |]. inversion_clear F as [| ? ? (_ & A) _]. pose proof (Rabs_pos a). lra. }
  assert (Row : row_near 0 (m + 52 / 10 * 0 * (u * m) + 3 * 0 * eta) p p).
  { clear L. induction F as [| a p (A & B) F IH]; constructor; auto. rewrite Rminus_diag_eq, Rabs_R0 by easy. repeat split; auto; lra. }
  pose proof u_small as U. pose proof (eta_positive (-1074)) as E. assert (Um : 0 <= u * m) by (apply Rmult_le_pos; lra).
  assert (Ex : after_rows (length p - 1) (exact_lerp t) p = [control_at p t]).
  { destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try (destruct L; discriminate); cbn [length Nat.sub after_rows next_row];
      [rewrite control_cubic | rewrite control_quartic]; f_equal; unfold exact_lerp; simpl; ring. }
  destruct (rows_near t m (length p - 1) T M ltac:(destruct L as [-> | ->]; simpl; lia) 0 0 p p) as (e & m' & R & B);
    [lra | destruct L as [-> | ->]; simpl; lra | exact Row | lra |].
  rewrite Ex in R. inversion R as [| v x l l' (_ & _ & V) R' E1 E2]. inversion R'. subst l. exists v. split; auto.
  assert (N : INR (length p - 1) <= 4) by (destruct L as [-> | ->]; simpl; lra).
  apply Rle_trans with (1 := V). apply Rle_trans with (1 := B). pose proof (pos_INR (length p - 1)).
  assert (INR (length p - 1) * (u * m) <= 4 * (u * m)) by (apply Rmult_le_compat_r; lra).
  assert (INR (length p - 1) * eta <= 4 * eta) by (apply Rmult_le_compat_r; lra). lra.
Qed.

(** ** The change of a quartic near a time *)

Theorem quartic_slope p m s t : length p = 5%nat -> Forall (fun a => Rabs a <= m) p -> 0 <= s <= 1 -> 0 <= t <= 1 ->
  Rabs (control_at p t - control_at p s) <= 8 * m * Rabs (t - s).
Proof.
  intros L F S T. destruct p as [| a [| b [| c [| d [| e [|]]]]]]; try discriminate. clear L.
  repeat match goal with H : Forall _ (_ :: _) |- _ => inversion_clear H end.
  set (q := [a; 4 * b; 6 * c; 4 * d; e]). assert (E : forall w, control_at [a; b; c; d; e] w = form q (1 - w) w)
    by (intros w; apply control_quartic). rewrite !E.
  assert (B : forall w, 0 <= w <= 1 -> Rabs (slope q w) <= 8 * m).
  { intros w W. replace (slope q w) with (4 * ((1 - w) ^ 3 * (b - a) + 3 * (1 - w) ^ 2 * w * (c - b) + 3 * (1 - w) * w ^ 2 * (d - c) +
      w ^ 3 * (e - d))) by (unfold q; simpl; ring).
    assert (D : forall g h, Rabs g <= m -> Rabs h <= m -> - (2 * m) <= g - h <= 2 * m)
      by (intros g h G H'; apply Rabs_le_inv in G, H'; lra).
    assert (P : forall k g, 0 <= k -> - (2 * m) <= g <= 2 * m -> - (k * (2 * m)) <= k * g <= k * (2 * m)) by (intros; nra).
    assert (W1 : 0 <= 1 - w) by lra. destruct W as (W0 & _).
    pose proof (P ((1 - w) ^ 3) _ ltac:(now apply pow_le) (D b a ltac:(auto) ltac:(auto))).
    pose proof (P (3 * (1 - w) ^ 2 * w) _ ltac:(repeat apply Rmult_le_pos; auto using pow_le; lra) (D c b ltac:(auto) ltac:(auto))).
    pose proof (P (3 * (1 - w) * w ^ 2) _ ltac:(repeat apply Rmult_le_pos; auto using pow_le; lra) (D d c ltac:(auto) ltac:(auto))).
    pose proof (P (w ^ 3) _ ltac:(now apply pow_le) (D e d ltac:(auto) ltac:(auto))).
    replace (8 * m) with (4 * ((1 - w) ^ 3 * (2 * m) + 3 * (1 - w) ^ 2 * w * (2 * m) + 3 * (1 - w) * w ^ 2 * (2 * m) + w ^ 3 * (2 * m)))
      by ring. apply Rabs_le. lra. }
  assert (Way : forall g h, 0 <= g -> g < h -> h <= 1 ->
    Rabs (form q (1 - h) h - form q (1 - g) g) <= 8 * m * (h - g)).
  { intros g h G GH H'. destruct (MVT_cor2 (fun w => form q (1 - w) w) (slope q) g h GH) as (w & Ew & W).
    { intros w _. apply derivable_form. }
    rewrite Ew, Rabs_mult, (Rabs_pos_eq (h - g)) by lra. apply Rmult_le_compat_r; [lra |]. apply B. lra. }
  destruct (Rtotal_order s t) as [G | [-> | G]].
  - rewrite (Rabs_pos_eq (t - s)) by lra. apply Way; lra.
  - rewrite !Rminus_diag_eq, !Rabs_R0 by easy. lra.
  - rewrite (Rabs_left (t - s)) by lra. rewrite <- Rabs_Ropp. replace (- (t - s)) with (s - t) by ring.
    replace (- (form q (1 - t) t - form q (1 - s) s)) with (form q (1 - s) s - form q (1 - t) t) by ring. apply Way; lra.
Qed.

(** ** Selection of the root *)

Section Roots.

Variable H : R -> Prop.  (** contact *)
Variable f : R -> R.     (** Y *)
Context (at_roots : forall t, 0 <= t <= 1 -> H t -> f t = 0) (collides : sometime H).

(** `early` and `late` *)
Theorem only_root_first r : (forall t, 0 <= t <= 1 -> f t = 0 -> t = r) -> first H r.
Proof.
  intros Only. destruct collides as (t & T & Ht). pose proof (Only t T (at_roots t T Ht)) as E. subst t.
  split; auto. split; auto. intros s S Hs. pose proof (Only s ltac:(lra) (at_roots s ltac:(lra) Hs)). lra.
Qed.
Context (r1 r2 : R) (in_order : 0 <= r1 < r2) (two_roots : forall t, 0 <= t <= 1 -> f t = 0 -> t = r1 \/ t = r2).
Theorem first_of_two : r1 <= 1 -> H r1 -> first H r1.
Proof.
  intros L H1. split; [lra |]. split; auto. intros s S Hs.
  destruct (two_roots s ltac:(lra) (at_roots s ltac:(lra) Hs)); lra.
Qed.
Theorem second_of_two : ~ H r1 -> first H r2.
Proof.
  intros N. destruct collides as (t & T & Ht). destruct (two_roots t T (at_roots t T Ht)) as [E | E]; [now subst |]. subst t.
  split; auto. split; auto. intros s S Hs. destruct (two_roots s ltac:(lra) (at_roots s ltac:(lra) Hs)) as [E | E]; [now subst | lra].
Qed.
(** signs_at_root: the first root is within reach of t, for any t. *)
Theorem root_reached b t reach : (forall s, 0 <= s <= 1 -> 0 < f s * b -> s < r1 \/ r2 < s) ->
  (forall s, 0 <= s <= 1 -> f s * b < 0 -> r1 < s < r2) -> 0 < reach -> 0 <= t <= 1 ->
  0 < f (Rmax (t - reach) 0) * b -> f (Rmin (t + reach) 1) * b < 0 -> Rabs (r1 - t) <= reach.
Proof.
  intros Before Between P T B A. assert (L : 0 <= Rmax (t - reach) 0 <= 1 /\ t - reach <= Rmax (t - reach) 0 <= t)
    by (unfold Rmax; destruct Rle_dec; lra).
  assert (G : 0 <= Rmin (t + reach) 1 <= 1 /\ t <= Rmin (t + reach) 1 <= t + reach) by (unfold Rmin; destruct Rle_dec; lra).
  destruct (Before _ (proj1 L) B); pose proof (Between _ (proj1 G) A); apply Rabs_le; lra.
Qed.

End Roots.

(** bracket_of_root: adjacent doubles in an interval with one root, at which Y's signs are opposite. *)
Theorem bracket_around (number : R -> Prop) f b from to r low high : (forall t, from <= t <= to -> 0 < f t * b -> t < r) ->
  (forall t, from <= t <= to -> f t * b < 0 -> r < t) -> neighbours number low high -> from <= low -> high <= to ->
  0 < f low * b -> f high * b < 0 -> holds_time number (low, high) r.
Proof.
  intros Before After N L H Fl Fh. pose proof N as (_ & _ & O & _). right. cbn [fst snd]. split; auto.
  split; [apply Before | apply After]; auto; lra.
Qed.
