(** Tests in single precision: ccd/batch/rounded_axes.hpp, ccd/batch/rounded_positions.hpp and the swept boxes of
    ccd/step/swept_boxes.hpp. Coordinates in double are mapped by a translation per axis and one scale, and rounded
    to float, in any direction, the same in both formats. Results:
        rounded_monotone          rounding preserves the order, not strictly
        rounded_face_separate, rounded_edges_separate   an axis that separates them as computed in float does so
            exactly
        swept_face_separate, swept_edges_separate   if rounded swept boxes do not touch, there is no contact
        swept_rounded_first       rounding before the minimum and maximum gives the same boxes
        converted_difference_near   a difference in units of a power of two, rounded to double and then to float,
                                  differs by at most eps of itself or by eta
        swept_boxes_touch         rounded boxes that touch without a common end touch before rounding *)

From Coq Require Import Reals ZArith List Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format Contact Decisions SeparatingAxis.
Import ListNotations.
Open Scope R_scope.

#[local] Instance float_precision : Prec_gt_0 24 := eq_refl.
#[local] Instance double_precision : Prec_gt_0 53 := eq_refl.

(** A fold is beyond its start and all members if each step is beyond its member and what came before. *)
Lemma fold_beyond {A} (f : R -> A -> R) (beyond : R -> A -> Prop) first others m :
  (forall m q, beyond (f m q) q) -> (forall m q r, beyond m r -> beyond (f m q) r) -> beyond m first ->
  forall q, In q (first :: others) -> beyond (fold_left f others m) q.
Proof.
  intros Own Kept. revert first m. induction others as [| r l IH]; intros first m M q; cbn [fold_left].
  - now intros [<- | []].
  - intros [<- | I]; [apply (IH first); [now apply Kept | now left] | now apply (IH r); [apply Own |]].
Qed.
Ltac beyond_all property := apply (fold_beyond _ property); intros; cbv beta in *; unfold Rmin, Rmax in *;
  repeat destruct Rle_dec; lra.

Section RoundedAxes.

Context (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation double := (rnd 53 (-1074) direction).
Notation single := (rnd 24 (-149) direction).
Notation number := (number 53 (-1074)).
Notation float := (Format.number 24 (-149)).
Notation eps := (eps 24).

(** ** The code *)

(** One coordinate, with the axis's middle c and the scale s. *)
Definition rounded (c s r : R) : R := single (double (double (r - c) * s)).

(** frame, of the box around all positions *)
Record frame := Frame { middle : point; scale : R }.
Definition middle_of (low high : R) : R := double (double (low / 2) + double (high / 2)).
Definition frame_of (low high : point) : frame :=
  let c := Point (middle_of (x low) (x high)) (middle_of (y low) (y high)) (middle_of (z low) (z high)) in
  let farther radius coordinate :=
    Rmax radius (Rmax (double (coordinate high - coordinate c)) (double (coordinate c - coordinate low))) in
  let radius := farther (farther (farther 0 x) y) z in
  Frame c (double (1 / Rmax radius (bpow radix2 (-1000)))).
Definition rounded_point (f : frame) (p : point) : point :=
  Point (rounded (x (middle f)) (scale f) (x p)) (rounded (y (middle f)) (scale f) (y p))
        (rounded (z (middle f)) (scale f) (z p)).

(** gap_between, of projections of the points in the order of the indices *)
Definition face_gap (v f0 f1 f2 : R) : R * R :=
  (single (v - Rmax (Rmax f0 f1) f2), single (Rmin (Rmin f0 f1) f2 - v)).
Definition edges_gap (a0 a1 b0 b1 : R) : R * R :=
  (single (Rmin b0 b1 - Rmax a0 a1), single (Rmin a0 a1 - Rmax b0 b1)).
(** separated_by, of the gaps at both ends of the step *)
Definition separated_by (gap : bool -> R * R) : R :=
  Rmax (Rmin (fst (gap false)) (fst (gap true))) (Rmin (snd (gap false)) (snd (gap true))).

(** An axis: its computed projection of rounded coordinates, and the axis itself. *)
Definition float_axis : Type := (point -> R) * point.
Definition coordinates_in_float : list float_axis :=
  [(x, Point 1 0 0); (y, Point 0 1 0); (z, Point 0 0 1)].
Definition diagonals_in_float : list float_axis :=
  [(fun d => single (x d + y d), Point 1 1 0); (fun d => single (x d - y d), Point 1 (-1) 0);
   (fun d => single (y d + z d), Point 0 1 1); (fun d => single (y d - z d), Point 0 1 (-1));
   (fun d => single (z d + x d), Point 1 0 1); (fun d => single (z d - x d), Point (-1) 0 1)].
Definition float_margin : R := 13 * eps.
Definition largest_gap (gap : float_axis -> bool -> R * R) (axes : list float_axis) : R :=
  fold_left (fun m a => Rmax m (separated_by (gap a))) axes (-1).
Definition separated_in_float (gap : float_axis -> bool -> R * R) : bool :=
  Rlt_bool 0 (largest_gap gap coordinates_in_float) || Rlt_bool float_margin (largest_gap gap
    diagonals_in_float).

(** ** Rounding *)

Lemma double_error : rounding_error 53 (-1074) direction (Format.eps 53) (eta (-1074)).
Proof. exact (rounding_error_any 53 (-1074) direction ltac:(lia)). Qed.
Lemma single_error : rounding_error 24 (-149) direction eps (eta (-149)).
Proof. exact (rounding_error_any 24 (-149) direction ltac:(lia)). Qed.
Lemma double_le r s : r <= s -> double r <= double s.
Proof. apply rnd_le; auto with typeclass_instances. Qed.
Lemma single_le r s : r <= s -> single r <= single s.
Proof. apply rnd_le; auto with typeclass_instances. Qed.
Lemma double_number r : number (double r).
Proof. apply rnd_number; auto with typeclass_instances. Qed.
Lemma single_number r : float (single r).
Proof. apply rnd_number; auto with typeclass_instances. Qed.
(** The rounding error of any number: relative, or absolute after an underflow. *)
Lemma double_near r : Rabs (double r - r) <= Format.eps 53 * Rabs r + eta (-1074).
Proof. apply (error_any _ _ _ _ _ double_error). Qed.
Lemma single_near r : Rabs (single r - r) <= eps * Rabs r + eta (-149).
Proof. apply (error_any _ _ _ _ _ single_error). Qed.

Theorem rounded_monotone c s r t : 0 <= s -> r <= t -> rounded c s r <= rounded c s t.
Proof.
  intros S L. apply single_le, double_le, Rmult_le_compat_r; auto. apply double_le. lra.
Qed.
Lemma rounded_less c s r t : 0 <= s -> rounded c s r < rounded c s t -> r < t.
Proof. intros S L. apply Rnot_le_lt. intros C. pose proof (rounded_monotone c s t r S C). lra. Qed.

(** ** The frame *)

Lemma tiny_constants : Format.eps 53 <= eps / 100000000 /\ 0 < Format.eps 53 /\ eps <= / 1000000 /\ 0 < eps /\
  eta (-149) <= eps / 100000000 /\ 0 < eta (-149) /\ eta (-1074) <= eps / 100000000 /\ 0 < eta (-1074).
Proof.
  assert (H : forall e, (e <= -23 - 28)%Z -> bpow radix2 e <= eps / 100000000).
  { intros e L. apply Rle_trans with (bpow radix2 (-23 + -28)); [apply bpow_le; lia |]. rewrite bpow_plus.
    unfold Rdiv. apply Rmult_le_compat_l; [apply bpow_ge_0 |]. simpl. lra. }
  repeat split; try apply H; try apply bpow_gt_0; try lia.
  apply Rle_trans with (bpow radix2 (-23)); [apply Rle_refl |]. simpl. lra.
Qed.

Section Frame.

Context (low high : point) (low_numbers : number (x low) /\ number (y low) /\ number (z low))
  (high_numbers : number (x high) /\ number (y high) /\ number (z high)).
(** Any finite double. *)
Definition bounded (p : point) : Prop :=
  Rabs (x p) <= bpow radix2 1024 /\ Rabs (y p) <= bpow radix2 1024 /\ Rabs (z p) <= bpow radix2 1024.
Context (low_bounded : bounded low) (high_bounded : bounded high).
Notation f := (frame_of low high).

Definition inside_box (p : point) : Prop :=
  x low <= x p <= x high /\ y low <= y p <= y high /\ z low <= z p <= z high.

Lemma double_below r e : (-1074 <= e)%Z -> Rabs r <= bpow radix2 e -> Rabs (double r) <= bpow radix2 e.
Proof. intros L H. apply rnd_abs_below; auto with typeclass_instances.
apply number_power; [exact eq_refl | lia]. Qed.
Lemma half_below r : Rabs r <= bpow radix2 1024 -> Rabs (double (r / 2)) <= bpow radix2 1023.
Proof.
  intros H. apply double_below; [lia |]. unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ 2)) by lra.
  replace (bpow radix2 1023) with (bpow radix2 1024 * / 2); [apply Rmult_le_compat_r; lra |].
  change (/ 2) with (bpow radix2 (-1)). rewrite <- bpow_plus. reflexivity.
Qed.
Lemma sum_below r s e : (-1074 <= e)%Z -> Rabs r <= bpow radix2 e -> Rabs s <= bpow radix2 e ->
  Rabs (double (r + s)) <= bpow radix2 (e + 1).
Proof.
  intros L A B. apply double_below; [lia |]. apply Rle_trans with (1 := Rabs_triang r s).
  rewrite bpow_plus. change (bpow radix2 1) with 2. lra.
Qed.
Lemma middle_below a b : Rabs a <= bpow radix2 1024 -> Rabs b <= bpow radix2 1024 ->
  Rabs (middle_of a b) <= bpow radix2 1024.
Proof. intros A B. exact (sum_below _ _ 1023 ltac:(lia) (half_below a A) (half_below b B)). Qed.
Lemma distance_below r s : Rabs r <= bpow radix2 1024 -> Rabs s <= bpow radix2 1024 ->
  double (r - s) <= bpow radix2 1025.
Proof.
  intros A B. apply Rle_trans with (1 := Rle_abs _). apply (sum_below r (- s) 1024); auto; [lia |].
  now rewrite Rabs_Ropp.
Qed.

(** Points in the box are at most 1 from the middle after scaling, except for roundings. *)
Lemma scale_bounds : 0 <= scale f /\ forall p, inside_box p ->
  Rabs (x p - x (middle f)) * scale f <= 1 + eps / 500 /\
  Rabs (y p - y (middle f)) * scale f <= 1 + eps / 500 /\
  Rabs (z p - z (middle f)) * scale f <= 1 + eps / 500.
Proof.
  destruct low_bounded as (Lx & Ly & Lz), high_bounded as (Hx & Hy & Hz).
  destruct low_numbers as (Nlx & Nly & Nlz), high_numbers as (Nhx & Nhy & Nhz).
  pose proof (middle_below _ _ Lx Hx) as Mx. pose proof (middle_below _ _ Ly Hy) as My.
  pose proof (middle_below _ _ Lz Hz) as Mz.
  unfold frame_of. cbv zeta. cbn [middle scale x y z].
  assert (Nc : forall a b, number (middle_of a b)) by (intros; apply double_number).
  pose proof (Nc (x low) (x high)) as Ncx. pose proof (Nc (y low) (y high)) as Ncy.
  pose proof (Nc (z low) (z high)) as Ncz.
  set (cx := middle_of (x low) (x high)) in *. set (cy := middle_of (y low) (y high)) in *.
  set (cz := middle_of (z low) (z high)) in *.
  pose proof (distance_below _ _ Hx Mx) as D1. pose proof (distance_below _ _ Mx Lx) as D2.
  pose proof (distance_below _ _ Hy My) as D3. pose proof (distance_below _ _ My Ly) as D4.
  pose proof (distance_below _ _ Hz Mz) as D5. pose proof (distance_below _ _ Mz Lz) as D6.
  destruct tiny_constants as (E1 & E2 & E3 & E4 & _).
  set (r := Rmax _ (bpow radix2 (-1000))).
  assert (B0 : 0 < bpow radix2 (-1000)) by apply bpow_gt_0.
  assert (B1 : bpow radix2 (-1000) <= bpow radix2 1025) by (apply bpow_le; lia).
  assert (R1 : r <= bpow radix2 1025) by (unfold r; repeat apply Rmax_lub; lra).
  assert (R0 : bpow radix2 (-1000) <= r) by apply Rmax_r.
  assert (Rx : double (x high - cx) <= r /\ double (cx - x low) <= r /\ double (y high - cy) <= r /\
    double (cy - y low) <= r /\ double (z high - cz) <= r /\ double (cz - z low) <= r).
  { unfold r. generalize (bpow radix2 (-1000)) (double (x high - cx)) (double (cx - x low)) (double (y high
    - cy))
      (double (cy - y low)) (double (z high - cz)) (double (cz - z low)). intros a b c d e g h.
    repeat split; unfold Rmax; repeat destruct Rle_dec; lra. }
  clearbody r. clear D1 D2 D3 D4 D5 D6. destruct Rx as (D1 & D2 & D3 & D4 & D5 & D6).
  assert (P : 0 < 1 / r) by (apply Rdiv_lt_0_compat; lra).
  assert (S0 : 0 <= double (1 / r)) by (apply rnd_nonnegative; auto with typeclass_instances; lra).
  assert (S1 : r * double (1 / r) <= 1 + eps / 1000).
  { pose proof (double_near (1 / r)) as A. rewrite (Rabs_pos_eq (1 / r)) in A by lra. apply Rabs_le_inv in A.
    apply Rle_trans with (r * (1 / r * (1 + Format.eps 53) + eta (-1074))); [apply Rmult_le_compat_l; lra |].
    replace (r * (1 / r * (1 + Format.eps 53) + eta (-1074))) with (1 + Format.eps 53 + r * eta (-1074))
      by (field; lra).
    assert (r * eta (-1074) <= bpow radix2 1025 * eta (-1074)) by (apply Rmult_le_compat_r;
      [apply bpow_ge_0 | lra]).
    assert (Q : bpow radix2 1025 * eta (-1074) <= eps / 100000).
    { unfold eta. rewrite <- bpow_plus. apply Rle_trans with (bpow radix2 (-23 + -17)); [apply bpow_le; lia |].
      rewrite bpow_plus. unfold Rdiv. apply Rmult_le_compat_l; [apply bpow_ge_0 |]. simpl. lra. }
    lra. }
  split; [exact S0 |].
  assert (Far : forall a b, number a -> number b -> double (a - b) <= r -> (a - b) * (1 - Format.eps 53) <= r).
  { intros a b A B D. destruct (Rlt_or_le (a - b) 0) as [N | N].
    - assert (0 <= (b - a) * (1 - Format.eps 53)) by (apply Rmult_le_pos; lra). lra.
    - pose proof (sum_error _ _ direction _ _ double_error a (- b) A (number_opp _ _ _ B)) as E.
      fold (a - b) in E. rewrite (Rabs_pos_eq (a - b)) in E by lra. apply Rabs_le_inv in E. lra. }
  assert (G : forall a c l h, number l -> number h -> number c -> l <= a <= h -> double (h - c) <= r ->
    double (c - l) <= r -> Rabs (a - c) * double (1 / r) <= 1 + eps / 500).
  { intros a c l h Nl Nh N B H L. apply Far in H, L; auto.
    assert (A : Rabs (a - c) * (1 - Format.eps 53) <= r).
    { apply Rle_trans with (Rmax (h - c) (c - l) * (1 - Format.eps 53)).
      - apply Rmult_le_compat_r; [lra |]. pose proof (Rmax_l (h - c) (c - l)).
        pose proof (Rmax_r (h - c) (c - l)).
        apply Rabs_le. lra.
      - unfold Rmax. destruct Rle_dec; lra. }
    apply (Rmult_le_compat_r _ _ _ S0) in A.
    assert (B' : Rabs (a - c) * double (1 / r) * (1 - Format.eps 53) <= 1 + eps / 1000) by lra.
    apply Rmult_le_reg_r with (1 - Format.eps 53); [lra |]. apply Rle_trans with (1 := B'). nra. }
  intros p (X & Y & Z).
  split; [| split]; [apply (G _ _ (x low) (x high)) | apply (G _ _ (y low) (y high)) | apply (G _ _ (z low)
    (z high))]; auto.
Qed.

(** A coordinate within the box as a float. *)
Lemma rounded_near a c s : number a -> number c -> 0 <= s -> Rabs (a - c) * s <= 1 + eps / 500 ->
  Rabs (rounded c s a) <= 1.001 /\ Rabs (rounded c s a - (a - c) * s) <= 1.01 * eps.
Proof.
  intros A C S H. destruct tiny_constants as (E1 & E2 & E3 & E4 & E5 & E6 & E7 & E8). unfold rounded.
  pose proof (sum_error _ _ direction _ _ double_error a (- c) A (number_opp _ _ _ C)) as D.
  fold (a - c) in D. set (d := double (a - c)) in *.
  assert (D1 : Rabs (d * s - (a - c) * s) <= eps / 1000000).
  { rewrite <- Rmult_minus_distr_r, Rabs_mult, (Rabs_pos_eq s) by easy.
    apply Rle_trans with (Format.eps 53 * (Rabs (a - c) * s)).
    - rewrite <- Rmult_assoc. now apply Rmult_le_compat_r.
    - apply Rle_trans with (Format.eps 53 * 2); [apply Rmult_le_compat_l; lra | lra]. }
  assert (X : Rabs ((a - c) * s) <= 1 + eps / 500) by (now rewrite Rabs_mult, (Rabs_pos_eq s)).
  pose proof (double_near (d * s)) as D2.
  assert (Y : Rabs (d * s) <= 1 + eps / 400).
  { pose proof (Rabs_triang (d * s - (a - c) * s) ((a - c) * s)) as T.
    replace (d * s - (a - c) * s + (a - c) * s) with (d * s) in T by ring. lra. }
  assert (D3 : Rabs (double (d * s) - d * s) <= eps / 1000000).
  { apply Rle_trans with (1 := D2). assert (Format.eps 53 * Rabs (d * s) <= Format.eps 53 * 2)
      by (apply Rmult_le_compat_l; lra). lra. }
  set (g := double (d * s)) in *.
  assert (Z : Rabs g <= 1 + eps / 300).
  { pose proof (Rabs_triang (g - d * s) (d * s)) as T. replace (g - d * s + d * s) with g in T by ring. lra. }
  pose proof (single_near g) as D4.
  assert (D5 : Rabs (single g - g) <= 1.001 * eps).
  { apply Rle_trans with (1 := D4).
    assert (eps * Rabs g <= eps * 1.0001) by (apply Rmult_le_compat_l; lra). lra. }
  apply Rabs_le_inv in D1, D3, D5, Z. split; apply Rabs_le; lra.
Qed.

(** ** Axes *)

(** If computed projections of rounded points differ by more than t, the projections of the points differ in the same
    direction. *)
Definition tells (t : R) (a : float_axis) : Prop := forall p q,
  number (x p) -> number (y p) -> number (z p) -> number (x q) -> number (y q) -> number (z q) ->
  inside_box p -> inside_box q ->
  t < fst a (rounded_point f q) - fst a (rounded_point f p) ->
  dot (snd a) p < dot (snd a) q.

Lemma coordinates_tell a : In a coordinates_in_float -> tells 0 a.
Proof.
  destruct scale_bounds as (S & _).
  intros [<- | [<- | [<- | []]]] p q _ _ _ _ _ _ _ _; unfold rounded_point, dot; cbn [fst snd x y z]; intros L;
    [enough (x p < x q) by lra | enough (y p < y q) by lra | enough (z p < z q) by lra];
    eapply rounded_less; [exact S | apply Rminus_gt_0_lt; exact L | exact S | apply Rminus_gt_0_lt; exact L |
                          exact S | apply Rminus_gt_0_lt; exact L].
Qed.

Lemma sum_in_float r s r' s' : Rabs r' <= 1.001 -> Rabs s' <= 1.001 ->
  Rabs (r' - r) <= 1.01 * eps -> Rabs (s' - s) <= 1.01 * eps ->
  Rabs (single (r' + s')) <= 2.003 /\ Rabs (single (r' + s') - (r + s)) <= 4.05 * eps.
Proof.
  intros A B C D. destruct tiny_constants as (E1 & E2 & E3 & E4 & E5 & E6 & _).
  pose proof (single_near (r' + s')) as N. pose proof (Rabs_triang r' s') as T.
  assert (eps * Rabs (r' + s') <= eps * 2.002) by (apply Rmult_le_compat_l; lra).
  assert (M : Rabs (single (r' + s') - (r' + s')) <= 2.01 * eps) by lra.
  assert (S : Rabs (r' + s') <= 2.002) by lra.
  apply Rabs_le_inv in C, D, M, S. split; apply Rabs_le; lra.
Qed.
Lemma difference_in_float r s r' s' : Rabs r' <= 1.001 -> Rabs s' <= 1.001 ->
  Rabs (r' - r) <= 1.01 * eps -> Rabs (s' - s) <= 1.01 * eps ->
  Rabs (single (r' - s')) <= 2.003 /\ Rabs (single (r' - s') - (r - s)) <= 4.05 * eps.
Proof.
  intros A B C D. apply (sum_in_float r (- s) r' (- s')); auto; [now rewrite Rabs_Ropp |].
  replace (- s' - - s) with (- (s' - s)) by ring. now rewrite Rabs_Ropp.
Qed.

(** A rounded point of the box, and its projections. *)
Lemma rounded_point_near p : number (x p) -> number (y p) -> number (z p) -> inside_box p ->
  let near r v := Rabs r <= 1.001 /\ Rabs (r - v * scale f) <= 1.01 * eps in
  near (x (rounded_point f p)) (x p - x (middle f)) /\ near (y (rounded_point f p)) (y p - y (middle f)) /\
  near (z (rounded_point f p)) (z p - z (middle f)).
Proof.
  intros Px Py Pz B. destruct scale_bounds as (S & H). destruct (H p B) as (Hx & Hy & Hz).
  repeat split; apply rounded_near; auto; apply double_number.
Qed.
Lemma projection_near a p : In a diagonals_in_float ->
  number (x p) -> number (y p) -> number (z p) -> inside_box p ->
  Rabs (fst a (rounded_point f p)) <= 2.003 /\
  Rabs (fst a (rounded_point f p) - dot (snd a) (minus p (middle f)) * scale f) <= 4.05 * eps.
Proof.
  intros I Px Py Pz B. destruct (rounded_point_near p Px Py Pz B) as ((Lx & Ex) & (Ly & Ey) & (Lz & Ez)).
  set (r := rounded_point f p) in *. unfold dot, minus. set (c := middle f) in *. set (s := scale f) in *.
  clearbody c s r.
  destruct I as [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]; cbn [fst snd x y z];
    match goal with
    | A : Rabs (?a - ?r) <= _, B : Rabs (?b - ?t) <= _ |- _ /\ Rabs (_ (?a + ?b) - ?v) <= _ =>
        replace v with (r + t) by ring; now apply sum_in_float
    | A : Rabs (?a - ?r) <= _, B : Rabs (?b - ?t) <= _ |- _ /\ Rabs (_ (?a - ?b) - ?v) <= _ =>
        replace v with (r - t) by ring; now apply difference_in_float
    end.
Qed.
Lemma diagonals_tell a : In a diagonals_in_float -> tells float_margin a.
Proof.
  intros I p q Px Py Pz Qx Qy Qz Bp Bq L. destruct scale_bounds as (S & _).
  destruct (projection_near a p I Px Py Pz Bp) as (_ & Ep), (projection_near a q I Qx Qy Qz Bq) as (_ & Eq).
  assert (M : forall r, dot (snd a) (minus r (middle f)) = dot (snd a) r - dot (snd a) (middle f))
    by (intros; unfold dot, minus; cbn [x y z]; ring).
  rewrite M in Ep, Eq. apply Rabs_le_inv in Ep, Eq. unfold float_margin in L.
  destruct tiny_constants as (_ & _ & _ & E4 & _). apply Rnot_le_lt. intros C.
  assert (0 <= (dot (snd a) p - dot (snd a) q) * scale f) by (apply Rmult_le_pos; lra). lra.
Qed.

(** ** Queries *)

Definition in_frame (q : moving) : Prop := numbers q /\ forall e, inside_box (at_end q e).

Lemma gap_of t r s : float t -> t < single (r - s) -> t < r - s.
Proof.
  intros N L. apply Rnot_le_lt. intros C. apply (Rlt_not_le _ _ L).
  apply rnd_below; auto with typeclass_instances.
Qed.
Lemma largest_of t gap axes : -1 <= t -> t < largest_gap gap axes -> exists a, In a axes /\
  t < separated_by (gap a).
Proof.
  intros T. unfold largest_gap.
  assert (G : forall l m, m <= t -> t < fold_left (fun m a => Rmax m (separated_by (gap a))) l m ->
    exists a, In a l /\ t < separated_by (gap a)).
  { induction l as [| a l IH]; intros m M L; simpl in L; [lra |].
    destruct (Rle_or_lt (separated_by (gap a)) t) as [C | C]; [| exists a; simpl; auto].
    destruct (IH _ (Rmax_lub _ _ _ M C) L) as (b & I & H). exists b. simpl. auto. }
  apply G. lra.
Qed.
Lemma both_ends t gap : t < separated_by gap -> (forall e, t < fst (gap e)) \/ (forall e, t < snd (gap e)).
Proof.
  unfold separated_by. intros L.
  destruct (Rlt_or_le t (Rmin (fst (gap false)) (fst (gap true)))) as [A | A];
    [left | right; destruct (Rlt_or_le t (Rmin (snd (gap false)) (snd (gap true)))) as [B | B];
              [| pose proof (Rmax_lub _ _ _ A B); lra]]; intros [].
  - pose proof (Rmin_r (fst (gap false)) (fst (gap true))). lra.
  - pose proof (Rmin_l (fst (gap false)) (fst (gap true))). lra.
  - pose proof (Rmin_r (snd (gap false)) (snd (gap true))). lra.
  - pose proof (Rmin_l (snd (gap false)) (snd (gap true))). lra.
Qed.
Lemma separated_axis gap : separated_in_float gap = true -> exists a t, float t /\ tells t a /\
  ((forall e, t < fst (gap a e)) \/ (forall e, t < snd (gap a e))).
Proof.
  assert (N : float 0 /\ float float_margin).
  { split; [apply number_0 |]. unfold float_margin, Format.eps. apply number_integer; [exact eq_refl | lia |].
    change (2 ^ 24)%Z with 16777216%Z. lia. }
  assert (M : 0 <= float_margin) by (unfold float_margin; generalize (bpow_gt_0 radix2 (1 - 24));
    unfold Format.eps; lra).
  intros H. apply orb_prop in H. destruct H as [H | H]; apply less_of, largest_of in H; try lra;
    destruct H as (a & I & L); apply both_ends in L.
  - exists a, 0. repeat split; auto; [apply N | now apply coordinates_tell].
  - exists a, float_margin. repeat split; auto; [apply N | now apply diagonals_tell].
Qed.

(** The order of two points along such an axis. *)
Lemma told t a q r e : tells t a -> in_frame q -> in_frame r ->
  t < fst a (rounded_point f (at_end r e)) - fst a (rounded_point f (at_end q e)) ->
  dot (snd a) (at_end q e) < dot (snd a) (at_end r e).
Proof.
  intros T (Nq & Bq) (Nr & Br). destruct (Nq e) as (? & ? & ?), (Nr e) as (? & ? & ?). now apply T.
Qed.

Ltac by_gap t H := intros e; apply told with t; auto; specialize (H e); apply gap_of in H; auto; revert H;
  unfold Rmax, Rmin; repeat match goal with |- context [Rle_dec ?r ?s] =>
    lazymatch constr:((r, s)) with context [Rle_dec] => fail | _ => destruct (Rle_dec r s) end end; lra.
Theorem rounded_face_separate v f0 f1 f2 : in_frame v -> in_frame f0 -> in_frame f1 -> in_frame f2 ->
  separated_in_float (fun a e => let at_ q := fst a (rounded_point f (at_end q e)) in
                              face_gap (at_ v) (at_ f0) (at_ f1) (at_ f2)) = true ->
  ~ vertex_face_collides v f0 f1 f2.
Proof.
  intros V F0 F1 F2 H. apply separated_axis in H. destruct H as (a & t & N & T & H). unfold face_gap in H.
    cbv zeta in H.
  cbn [fst snd] in H. destruct H as [H | H].
  - apply (face_separated (minus origin (snd a))); apply before_opposite, before_of; by_gap t H.
  - apply (face_separated (snd a)); apply before_of; by_gap t H.
Qed.
Theorem rounded_edges_separate a0 a1 b0 b1 : in_frame a0 -> in_frame a1 -> in_frame b0 -> in_frame b1 ->
  separated_in_float (fun a e => let at_ q := fst a (rounded_point f (at_end q e)) in
                              edges_gap (at_ a0) (at_ a1) (at_ b0) (at_ b1)) = true ->
  ~ edge_edge_collides a0 a1 b0 b1.
Proof.
  intros A0 A1 B0 B1 H. apply separated_axis in H. destruct H as (a & t & N & T & H). unfold edges_gap in H.
    cbv zeta in H.
  cbn [fst snd] in H. destruct H as [H | H].
  - apply (edges_separated (snd a)); apply before_of; by_gap t H.
  - apply (edges_separated (minus origin (snd a))); apply before_opposite, before_of; by_gap t H.
Qed.

End Frame.

(** ** Swept boxes *)

(** One axis of swept_box: the minimum and maximum coordinate of an element's vertices at both ends of the step,
    exact and of rounded coordinates. c and s are the axis's middle and scale. *)
Definition sweep (least : R -> R -> R) (coordinate : point -> R) (first : moving) (others : list moving) : R :=
  fold_left (fun m q => least (least m (coordinate (start q))) (coordinate (finish q))) others
    (least (coordinate (start first)) (coordinate (finish first))).
Notation low coordinate first others := (sweep Rmin coordinate first others).
Notation high coordinate first others := (sweep Rmax coordinate first others).

Lemma low_below coordinate first others q : In q (first :: others) ->
  low coordinate first others <= coordinate (start q) /\ low coordinate first others <= coordinate (finish q).
Proof. unfold sweep. beyond_all (fun r q => r <= coordinate (start q) /\ r <= coordinate (finish q)). Qed.
Lemma high_above coordinate first others q : In q (first :: others) ->
  coordinate (start q) <= high coordinate first others /\ coordinate (finish q) <= high coordinate first others.
Proof. unfold sweep. beyond_all (fun r q => coordinate (start q) <= r /\ coordinate (finish q) <= r). Qed.

Section Boxes.

(** box_pack: rounded boxes do not touch if on some axis one ends before the other begins. *)
Context (c s : R) (s_0 : 0 <= s).
Definition coordinate_of (n : nat) : point -> R := match n with 0%nat => x | 1%nat => y | _ => z end.
Definition axis_of (n : nat) : point := match n with 0%nat => Point 1 0 0 | 1%nat => Point 0 1 0 | _ =>
  Point 0 0 1 end.
Definition ends_before (k : nat) (a : moving) (others : list moving) (b : moving) (b_others : list moving)
  : Prop :=
  rounded c s (high (coordinate_of k) a others) < rounded c s (low (coordinate_of k) b b_others).

Lemma coordinate_along k p : dot (axis_of k) p = coordinate_of k p.
Proof. destruct k as [| [|]]; unfold dot; simpl; ring. Qed.
Lemma swept_before k a l b m q r : ends_before k a l b m -> In q (a :: l) -> In r (b :: m) ->
  before (axis_of k) q r.
Proof.
  intros H Q R'. apply rounded_less in H; auto.
  destruct (high_above (coordinate_of k) a l q Q), (low_below (coordinate_of k) b m r R').
  split; rewrite !coordinate_along; lra.
Qed.

Theorem swept_face_separate k v f0 f1 f2 : ends_before k v [] f0 [f1; f2] \/ ends_before k f0 [f1; f2] v [] ->
  ~ vertex_face_collides v f0 f1 f2.
Proof.
  intros [H | H]; [apply (face_separated (axis_of k)) | apply (face_separated (minus origin (axis_of k)))];
    try apply before_opposite; eapply swept_before; try exact H; simpl; auto.
Qed.
Theorem swept_edges_separate k a0 a1 b0 b1 : ends_before k a0 [a1] b0 [b1] \/ ends_before k b0 [b1] a0 [a1] ->
  ~ edge_edge_collides a0 a1 b0 b1.
Proof.
  intros [H | H]; [apply (edges_separated (axis_of k)) | apply (edges_separated (minus origin (axis_of k)))];
    try apply before_opposite; eapply swept_before; try exact H; simpl; auto.
Qed.
Theorem swept_boxes_touch k a l b m :
  rounded c s (low (coordinate_of k) a l) < rounded c s (high (coordinate_of k) b m) ->
  low (coordinate_of k) a l <= high (coordinate_of k) b m.
Proof. intros H. apply rounded_less in H; auto. lra. Qed.

(** ccd/cuda/step.hpp rounds first and takes the minimum or maximum then. *)
Theorem swept_rounded_first least coordinate a l : least = Rmin \/ least = Rmax ->
  rounded c s (sweep least coordinate a l) = sweep least (fun p => rounded c s (coordinate p)) a l.
Proof.
  intros L. assert (C : forall r t, rounded c s (least r t) = least (rounded c s r) (rounded c s t)).
  { intros r t. destruct L as [-> | ->]; unfold Rmin, Rmax;
      destruct (Rle_dec r t) as [H | H], (Rle_dec (rounded c s r) (rounded c s t)) as [K | K]; try easy;
      pose proof (rounded_monotone c s r t s_0); pose proof (rounded_monotone c s t r s_0);
      try (exfalso; apply K; auto; lra); apply Rle_antisym; try lra; apply H1 || apply H0; lra. }
  unfold sweep. rewrite <- C. generalize (least (coordinate (start a)) (coordinate (finish a))).
  induction l as [| q l IH]; intros m; cbn [fold_left]; [easy |]. now rewrite IH, !C.
Qed.

End Boxes.
(** ** Differences that become floats *)

(** forms_of_query of ccd/cuda/exact_stages.hpp: a difference of doubles, in units of a power of two. The result is
    that of one rounding to a neighbouring float. *)
Definition converted_difference (a b : R) (e : Z) : R := single (double (double (a - b) * bpow radix2 (- e))).

Notation down r := (round radix2 (FLT_exp (-149) 24) Zfloor r).
Notation up r := (round radix2 (FLT_exp (-149) 24) Zceil r).
Lemma neighbour_near r c : c = down r \/ c = up r -> Rabs (c - r) <= eps * Rabs c + eta (-149).
Proof.
  assert (G : forall d (V : Valid_rnd d), Rabs (rnd 24 (-149) d r - r) <= eps * Rabs (rnd 24 (-149) d r) +
    eta (-149)).
  { intros d V. pose proof (bpow_gt_0 radix2 (-149)) as Q. fold (eta (-149)) in Q.
    destruct (Rlt_or_le (Rabs r) (smallest_normal 24 (-149))) as [S | S].
    - pose proof (absolute_error_any 24 (-149) d r S).
      assert (0 <= eps * Rabs (rnd 24 (-149) d r)) by (apply Rmult_le_pos;
        [apply bpow_ge_0 | apply Rabs_pos]). lra.
    - apply Rle_trans with (ulp radix2 (FLT_exp (-149) 24) (rnd 24 (-149) d r)).
      + apply error_le_ulp_round; auto with typeclass_instances.
      + apply Rle_trans with (Rabs (rnd 24 (-149) d r) * eps); [| lra].
        apply ulp_FLT_le. apply rnd_abs_above; auto with typeclass_instances.
        apply number_smallest_normal; auto with typeclass_instances. }
  intros [-> | ->]; [exact (G Zfloor _) | exact (G Zceil _)].
Qed.
(** A float on the grid of r is a double after scaling. *)
Lemma neighbour_number d (V : Valid_rnd d) r e : (-1074 <= cexp radix2 (FLT_exp (-149) 24) r + e)%Z ->
  number (rnd 24 (-149) d r * bpow radix2 e).
Proof.
  intros C. pose proof (rnd_number 24 (-149) d r) as N.
  destruct (Req_dec (rnd 24 (-149) d r) 0) as [Z | Z]; [rewrite Z, Rmult_0_l; apply number_0 |].
  assert (M : (cexp radix2 (FLT_exp (-149) 24) r <= cexp radix2 (FLT_exp (-149) 24) (rnd 24 (-149) d r))%Z).
  { apply monotone_exp; [auto with typeclass_instances |]. apply mag_round_ge; auto with typeclass_instances. }
  rewrite N. unfold F2R. simpl. rewrite Rmult_assoc, <- bpow_plus.
  apply number_integer; [exact eq_refl | lia |].
  assert (L : (Z.abs (Ztrunc (scaled_mantissa radix2 (FLT_exp (-149) 24) (rnd 24 (-149) d r))) < 2 ^ 24)%Z).
  { apply lt_IZR. rewrite abs_IZR, <- scaled_mantissa_generic by exact N.
    change (IZR (2 ^ 24)) with (bpow radix2 24).
    apply Rlt_le_trans with (1 := scaled_mantissa_lt_bpow radix2 (FLT_exp (-149) 24) _).
    apply bpow_le. unfold cexp, FLT_exp. lia. }
  change (2 ^ 53)%Z with 9007199254740992%Z. change (2 ^ 24)%Z with 16777216%Z in L. lia.
Qed.

Theorem converted_difference_near a b e : number a -> number b ->
  Rabs (converted_difference a b e - (a - b) * bpow radix2 (- e)) <=
    eps * Rabs (converted_difference a b e) + eta (-149).
Proof.
  intros A B. set (r := (a - b) * bpow radix2 (- e)). apply neighbour_near.
  pose proof (bpow_gt_0 radix2 e) as Pe. pose proof (bpow_gt_0 radix2 (- e)) as Pn.
  assert (Ee : bpow radix2 (- e) * bpow radix2 e = 1) by (rewrite <- bpow_plus, Z.add_opp_diag_l; reflexivity).
  assert (Er : r * bpow radix2 e = a - b) by (unfold r; rewrite Rmult_assoc, Ee; ring).
  destruct (Z_le_gt_dec (-1074) (cexp radix2 (FLT_exp (-149) 24) r + e)) as [C | C].
  - apply (Only_DN_or_UP (generic_format radix2 (FLT_exp (-149) 24)) r).
    + apply round_DN_pt; auto with typeclass_instances.
    + apply round_UP_pt; auto with typeclass_instances.
    + apply single_number.
    + pose proof (neighbour_number Zfloor _ r e C) as Nd. pose proof (neighbour_number Zceil _ r e C) as Nu.
      assert (Ld : down r <= r) by (apply round_DN_pt; auto with typeclass_instances).
      assert (Lu : r <= up r) by (apply round_UP_pt; auto with typeclass_instances).
      change (rnd 24 (-149) Zfloor r) with (down r) in Nd. change (rnd 24 (-149) Zceil r) with (up r) in Nu.
      assert (D1 : down r * bpow radix2 e <= double (a - b) <= up r * bpow radix2 e).
      { split; [apply rnd_above | apply rnd_below]; auto with typeclass_instances; rewrite <- Er;
          apply Rmult_le_compat_r; lra. }
      assert (Back : forall t, t * bpow radix2 e * bpow radix2 (- e) = t).
      { intros t. rewrite Rmult_assoc, (Rmult_comm (bpow radix2 e)), Ee. ring. }
      assert (D2 : down r <= double (a - b) * bpow radix2 (- e) <= up r).
      { rewrite <- (Back (down r)), <- (Back (up r)). split; apply Rmult_le_compat_r; lra. }
      assert (Wide : forall t, float t -> number t).
      { intros t. apply generic_inclusion_mag. intros _. unfold FLT_exp. lia. }
      assert (Nd' : float (down r)) by (apply (rnd_number 24 (-149) Zfloor)).
      assert (Nu' : float (up r)) by (apply (rnd_number 24 (-149) Zceil)).
      assert (D3 : down r <= double (double (a - b) * bpow radix2 (- e)) <= up r)
        by (split; [apply rnd_above | apply rnd_below]; auto with typeclass_instances; lra).
      split; [apply rnd_above | apply rnd_below]; auto with typeclass_instances; lra.
  - (* if that grid is finer than the doubles, the difference is exact *)
    unfold cexp, FLT_exp in C. assert (Small : Rabs (a - b) < smallest_normal 53 (-1074)).
    { rewrite <- Er, Rabs_mult, (Rabs_pos_eq (bpow radix2 e)) by lra.
      apply Rlt_le_trans with (bpow radix2 (mag radix2 r) * bpow radix2 e).
      - apply Rmult_lt_compat_r; [lra | apply bpow_mag_gt].
      - rewrite <- bpow_plus. apply bpow_le. lia. }
    assert (Nab : number (a - b)).
    { change (a - b) with (a + - b).
      rewrite <- (sum_exact_below 53 (-1074) direction a (- b) A (number_opp _ _ _ B) Small).
        apply double_number. }
    unfold converted_difference. rewrite (rnd_exact _ _ direction (a - b) Nab).
    rewrite (scale_up _ _ direction (a - b) (- e) Nab) by lia. fold r.
    apply round_DN_or_UP. auto with typeclass_instances.
Qed.

End RoundedAxes.
