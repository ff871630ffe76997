(** Comparisons of a step's search (ccd/step/trees/extents_pack.hpp and ccd/step/search_kernels.cpp): extents of elements
    and groups along nine axes at both ends of the step. They are in single precision, with coordinates rounded as in
    RoundedAxes.v, in any direction, the same in both formats. All positions are in the frame's box. Results:
        coordinate_extents_hold   along x, y, z extents contain the rounded coordinates of all vertices
        diagonal_extents_hold     along x ± y, y ± z, z ± x they contain the exact projections, moved and scaled like
                                  coordinates: the margin of 7 eps covers all roundings, including its own
        extents_tell              if one element's most is below another's least, all vertices of the first come
                                  before all of the second in exact arithmetic
        group_extents_hold, group_extents_apart   a group's extents contain those of all members, at any depth; if
                                  extents around two elements are apart, so are the elements' extents
        swept_extents_hold        hulls of both ends, and groups of them, contain an element's extents at both ends
        apart_face_separate, apart_edges_separate   a pair skipped by its extents, or by those of groups around
                                  one or both, has no contact in the step
    The search until a time t_max < 1 has rounded positions at the end, off by at most d in each coordinate. Margins,
    computed from d, move extents outwards (ccd/step/swept_boxes.hpp, short_way). Results:
        wide_extents_hold         along all nine axes extents contain the exact projections, moved and scaled like
                                  coordinates: the margins, if below the largest, cover d and all roundings,
                                  including their own; with the largest, no two extents are apart
        until_face_separate, until_edges_separate   a pair skipped by its extents, or by those of groups, has no
                                  contact in [0, t_max]
        shorter_face_separate, shorter_edges_separate   nor on ways that end near one fraction of the way until then
        widened_holds, until_boxes_face_separate, until_boxes_edges_separate   the same for boxes in doubles
        after_near                the rounded position at t_max is a double between both ends of the step, off by at
                                  most the computed error; to nearest *)

From Coq Require Import Reals ZArith List Lia Lra Bool.
From Flocq Require Import Core.
From Errbound Require Import Format Contact Decisions SeparatingAxis RoundedAxes.
Import ListNotations.
Open Scope R_scope.

#[local] Instance float_precision : Prec_gt_0 24 := eq_refl.
#[local] Instance double_precision : Prec_gt_0 53 := eq_refl.

Section Extents.

Context (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation single := (rnd 24 (-149) direction).
Notation number := (Format.number 53 (-1074)).
Notation float := (Format.number 24 (-149)).
Notation eps := (eps 24).

Context (low high : point) (low_numbers : number (x low) /\ number (y low) /\ number (z low))
  (high_numbers : number (x high) /\ number (y high) /\ number (z high)) (low_bounded : bounded low)
  (high_bounded : bounded high).
Notation f := (frame_of direction low high).
Notation in_frame := (in_frame low high).

(** ** The code *)

(** An axis, and the margin of its extents: extents_pack::margin or 0. *)
Definition search_axis : Type := float_axis * R.
Definition outwards : R := 7 * eps.
Definition search_axes : list search_axis :=
  map (fun a => (a, 0)) coordinates_in_float ++ map (fun a => (a, outwards)) (diagonals_in_float direction).

(** Extents on every axis at both ends of the step; `false` is the start. *)
Record extent := Extent { least : R; most : R }.
Definition extents : Type := search_axis -> bool -> extent.

(** set_extent, of an element's first vertex and its others *)
Definition computed (a : search_axis) (e : bool) (q : moving) : R :=
  fst (fst a) (rounded_point direction f (at_end q e)).
Definition of_element (first : moving) (others : list moving) : extents := fun a e => Extent
  (single (fold_left (fun m q => Rmin m (computed a e q)) others (computed a e first) - snd a))
  (single (fold_left (fun m q => Rmax m (computed a e q)) others (computed a e first) + snd a)).

(** fill_nodes, from a group's first member and its others, in any order, since minimum and maximum are exact. Lanes
    without a member are infinite and change nothing. *)
Definition hull (E F : extents) : extents := fun a e =>
  Extent (Rmin (least (E a e)) (least (F a e))) (Rmax (most (E a e)) (most (F a e))).
Definition of_group (first : extents) (others : list extents) : extents := fold_left hull others first.

(** touching, of a pack's member E and of F *)
Definition apart_along (axes : list search_axis) (E F : extents) : bool := existsb (fun a => separated_along (fun e =>
  (Rlt_bool (most (F a e)) (least (E a e)), Rlt_bool (most (E a e)) (least (F a e))))) axes.
Definition apart : extents -> extents -> bool := apart_along search_axes.

(** ** Elements *)

(** Extents are at least as wide as those of a single vertex. *)
Lemma wider_than_vertex first others a e q : In q (first :: others) ->
  least (of_element first others a e) <= single (computed a e q - snd a) /\
  single (computed a e q + snd a) <= most (of_element first others a e).
Proof.
  intros I. cbn [of_element least most]. split; apply single_le; auto; apply Rplus_le_compat_r; revert q I.
  - beyond_all (fun r q => r <= computed a e q).
  - beyond_all (fun r q => computed a e q <= r).
Qed.

Lemma computed_float a e q : In a coordinates_in_float -> float (computed (a, 0) e q).
Proof. intros [<- | [<- | [<- | []]]]; apply single_number; auto. Qed.
Theorem coordinate_extents_hold a e first others q : In a coordinates_in_float -> In q (first :: others) ->
  least (of_element first others (a, 0) e) <= computed (a, 0) e q <= most (of_element first others (a, 0) e).
Proof.
  intros A I. destruct (wider_than_vertex first others (a, 0) e q I) as (L & M). cbn [snd] in L, M.
  rewrite Rminus_0_r, (rnd_exact _ _ direction _ (computed_float a e q A)) in L.
  rewrite Rplus_0_r, (rnd_exact _ _ direction _ (computed_float a e q A)) in M. now split.
Qed.

(** A projection in the units of floats. *)
Definition scaled (n p : point) : R := dot n (minus p (middle f)) * scale f.

Lemma diagonal_near a p : In a (diagonals_in_float direction) ->
  number (x p) -> number (y p) -> number (z p) -> inside_box low high p ->
  Rabs (fst a (rounded_point direction f p)) <= 2.003 /\
  Rabs (fst a (rounded_point direction f p) - scaled (snd a) p) <= 4.05 * eps.
Proof. now apply projection_near. Qed.

(** Moved outwards and rounded, the computed projection is still beyond the exact one: 7 - 2.01 > 4.05. *)
Lemma moved_outwards r g : Rabs r <= 2.003 -> Rabs (r - g) <= 4.05 * eps ->
  single (r - outwards) <= g <= single (r + outwards).
Proof.
  intros A B. unfold outwards. destruct tiny_constants as (_ & _ & E3 & E4 & E5 & _).
  assert (N : forall t, Rabs t <= 2.004 -> Rabs (single t - t) <= 2.01 * eps).
  { intros t T. pose proof (single_near direction t) as M.
    assert (eps * Rabs t <= eps * 2.004) by (apply Rmult_le_compat_l; lra). lra. }
  apply Rabs_le_inv in A, B.
  pose proof (N (r - 7 * eps) ltac:(apply Rabs_le; lra)) as D.
  pose proof (N (r + 7 * eps) ltac:(apply Rabs_le; lra)) as U.
  apply Rabs_le_inv in D, U. lra.
Qed.

Theorem diagonal_extents_hold a e first others q : In a (diagonals_in_float direction) ->
  In q (first :: others) -> in_frame q ->
  least (of_element first others (a, outwards) e) <= scaled (snd a) (at_end q e)
    <= most (of_element first others (a, outwards) e).
Proof.
  intros A I (N & B). destruct (N e) as (Nx & Ny & Nz).
  destruct (diagonal_near a (at_end q e) A Nx Ny Nz (B e)) as (S & D).
  destruct (wider_than_vertex first others (a, outwards) e q I) as (L & M). cbn [snd] in L, M.
  destruct (moved_outwards _ _ S D) as (P & Q). unfold computed in L, M. cbn [fst] in L, M. lra.
Qed.

Theorem extents_tell a e p l r m q t : In a search_axes -> In q (p :: l) -> In t (r :: m) ->
  in_frame q -> in_frame t -> most (of_element p l a e) < least (of_element r m a e) ->
  dot (snd (fst a)) (at_end q e) < dot (snd (fst a)) (at_end t e).
Proof.
  intros A Q T Fq Ft L. apply in_app_or in A. destruct A as [A | A]; apply in_map_iff in A;
    destruct A as (b & <- & B); cbn [fst].
  - pose proof (coordinate_extents_hold b e p l q B Q). pose proof (coordinate_extents_hold b e r m t B T).
    unfold computed in *. cbn [fst] in *.
    apply (told direction low high 0); auto; [now apply coordinates_tell | lra].
  - pose proof (diagonal_extents_hold b e p l q B Q Fq). pose proof (diagonal_extents_hold b e r m t B T Ft).
    destruct (scale_bounds direction low high low_numbers high_numbers low_bounded high_bounded) as (S & _).
    apply Rnot_le_lt. intros C.
    assert (D : scaled (snd b) (at_end t e) <= scaled (snd b) (at_end q e)).
    { unfold scaled. apply Rmult_le_compat_r; auto. unfold dot, minus in *. cbn [x y z] in *. lra. }
    lra.
Qed.

(** ** Groups *)

Definition holds (G E : extents) : Prop := forall a e,
  least (G a e) <= least (E a e) /\ most (E a e) <= most (G a e).

(** G is E, or the extents of a group with a member around E. *)
Inductive around (E : extents) : extents -> Prop :=
  | around_itself : around E E
  | around_group first others F : In F (first :: others) -> around E F -> around E (of_group first others).

Lemma holds_itself E : holds E E.
Proof. intros a e. lra. Qed.
Lemma holds_all G F E : holds G F -> holds F E -> holds G E.
Proof. intros A B a e. destruct (A a e), (B a e). lra. Qed.
Lemma hull_holds E F : holds (hull E F) E /\ holds (hull E F) F.
Proof.
  split; intros a e; cbn [hull least most]; split; auto using Rmin_l, Rmin_r, Rmax_l, Rmax_r.
Qed.
Lemma of_group_holds first others E : In E (first :: others) -> holds (of_group first others) E.
Proof.
  unfold of_group. revert E first. induction others as [| F l IH]; intros E first; cbn [fold_left].
  - intros [<- | []]. apply holds_itself.
  - destruct (hull_holds first F) as (A & B). pose proof (IH _ (hull first F) (or_introl eq_refl)) as H.
    intros [<- | [<- | I]]; [now apply (holds_all _ (hull first F)) .. |]. apply IH. now right.
Qed.
Theorem group_extents_hold E G : around E G -> holds G E.
Proof.
  induction 1 as [| first others F I _ IH]; [apply holds_itself |].
  now apply (holds_all _ F); [apply of_group_holds |].
Qed.

(** fill_leaves of swept extents, in which each end has the hull of both: comparisons at the start suffice. *)
Definition swept (E : extents) : extents := fun a _ => Extent
  (Rmin (least (E a false)) (least (E a true))) (Rmax (most (E a false)) (most (E a true))).
Theorem swept_extents_hold E G : around (swept E) G -> holds G E.
Proof.
  intros A. apply (holds_all _ (swept E)); [now apply group_extents_hold |].
  intros a e. cbn [swept least most]. pose proof (Rmin_l (least (E a false)) (least (E a true))).
  pose proof (Rmin_r (least (E a false)) (least (E a true))). pose proof (Rmax_l (most (E a false)) (most (E a true))).
  pose proof (Rmax_r (most (E a false)) (most (E a true))). destruct e; lra.
Qed.

Lemma apart_axis axes E F : apart_along axes E F = true <-> exists a, In a axes /\
  ((forall e, most (F a e) < least (E a e)) \/ (forall e, most (E a e) < least (F a e))).
Proof.
  unfold apart_along. rewrite existsb_exists. split.
  - intros (a & I & H). exists a. split; auto. apply separated_sides in H. cbn [fst snd] in H.
    destruct H as [H | H]; [left | right]; intros e; now apply less_of.
  - intros (a & I & H). exists a. split; auto. unfold separated_along. cbn [fst snd]. apply orb_true_iff.
    destruct H as [H | H]; [left | right]; apply andb_true_iff; split; now apply Rlt_bool_true.
Qed.
Lemma apart_symmetric axes E F : apart_along axes E F = true -> apart_along axes F E = true.
Proof.
  rewrite !apart_axis. intros (a & I & H). exists a. split; auto. destruct H as [H | H]; auto.
Qed.
Lemma either_apart axes E F : apart_along axes E F = true \/ apart_along axes F E = true -> apart_along axes E F = true.
Proof. intros [A | A]; [easy | now apply apart_symmetric]. Qed.
Lemma group_apart_along axes G H E F : holds G E -> holds H F ->
  apart_along axes G H = true -> apart_along axes E F = true.
Proof.
  intros A B. rewrite !apart_axis. intros (a & I & C). exists a. split; auto.
  destruct C as [C | C]; [left | right]; intros e; specialize (C e); destruct (A a e), (B a e); lra.
Qed.

Theorem group_extents_apart G H E F : holds G E -> holds H F -> apart G H = true -> apart E F = true.
Proof. apply group_apart_along. Qed.

(** ** Pairs *)

(** Two elements are apart if all vertices of one come before all of the other along an axis. *)
Lemma apart_before p l r m G H : holds G (of_element p l) -> holds H (of_element r m) ->
  apart G H = true \/ apart H G = true -> Forall in_frame (p :: l) -> Forall in_frame (r :: m) ->
  exists n, forall q t, In q (p :: l) -> In t (r :: m) -> before n q t.
Proof.
  rewrite !Forall_forall. intros Gh Hh A P R'.
  apply (either_apart search_axes), (group_apart_along _ G H _ _ Gh Hh), apart_axis in A.
  destruct A as (a & I & A). destruct A as [A | A].
  - exists (minus origin (snd (fst a))). intros q t Q T. apply before_opposite, before_of. intros e.
    now apply (extents_tell a e r m p l t q); auto.
  - exists (snd (fst a)). intros q t Q T. apply before_of. intros e.
    now apply (extents_tell a e p l r m q t); auto.
Qed.

Theorem apart_face_separate v f0 f1 f2 G H : in_frame v -> in_frame f0 -> in_frame f1 -> in_frame f2 ->
  holds G (of_element v []) -> holds H (of_element f0 [f1; f2]) -> apart G H = true \/ apart H G = true ->
  ~ vertex_face_collides v f0 f1 f2.
Proof.
  intros V F0 F1 F2 Gv Hf A. destruct (apart_before _ _ _ _ _ _ Gv Hf A) as (n & B); auto.
  apply (face_separated n); apply B; simpl; auto.
Qed.
Theorem apart_edges_separate a0 a1 b0 b1 G H : in_frame a0 -> in_frame a1 -> in_frame b0 -> in_frame b1 ->
  holds G (of_element a0 [a1]) -> holds H (of_element b0 [b1]) -> apart G H = true \/ apart H G = true ->
  ~ edge_edge_collides a0 a1 b0 b1.
Proof.
  intros A0 A1 B0 B1 Ga Hb A. destruct (apart_before _ _ _ _ _ _ Ga Hb A) as (n & B); auto.
  apply (edges_separated n); apply B; simpl; auto.
Qed.

(** ** Until a time t_max < 1 *)

(** Positions at the end that are off by at most d, and the margin of extents along coordinate axes and across two:
    short_way::margin and fill_leaves. The compiler computes the constant to nearest. A margin of 8 proves nothing: all
    extents then contain 0. *)
Section Until.

Context (d : R) (d_0 : 0 <= d).
Notation double := (rnd 53 (-1074) direction).
Definition margin_in_double : R :=
  double (double (double (rnd 53 (-1074) nearest 1.0001 * d) * scale f) + 4 * eps).
Definition margin_along : R := single (Rmin 8 margin_in_double).
Definition margin_across : R := single (outwards + single (2 * margin_along)).
Definition wide_axes : list search_axis := map (fun a => (a, margin_along)) coordinates_in_float ++
  map (fun a => (a, margin_across)) (diagonals_in_float direction).
Definition apart_until : extents -> extents -> bool := apart_along wide_axes.

(** The exact motion q, and its motion as stored. *)
Definition off_by (q stored : moving) : Prop := forall e,
  Rabs (x (at_end q e) - x (at_end stored e)) <= d /\ Rabs (y (at_end q e) - y (at_end stored e)) <= d /\
  Rabs (z (at_end q e) - z (at_end stored e)) <= d.

Lemma scale_below : scale f <= bpow radix2 1000.
Proof.
  unfold frame_of. cbv zeta. cbn [scale]. set (r := Rmax _ (bpow radix2 (-1000))).
  apply rnd_below; auto with typeclass_instances; [apply number_power; [exact eq_refl | lia] |].
  assert (P : 0 < bpow radix2 (-1000)) by apply bpow_gt_0. assert (L : bpow radix2 (-1000) <= r) by apply Rmax_r.
  unfold Rdiv. rewrite Rmult_1_l. change (bpow radix2 1000) with (bpow radix2 (- (-1000))). rewrite bpow_opp.
  now apply Rinv_le.
Qed.

(** A product or sum of nonnegative numbers loses little. *)
Lemma double_lower r : 0 <= r -> r * (1 - / 100000000) - eta (-1074) <= double r.
Proof.
  intros P. destruct tiny_constants as (E1 & E2 & E3 & E4 & _). pose proof (double_near direction r) as N.
  rewrite (Rabs_pos_eq r P) in N. assert (Format.eps 53 * r <= / 100000000 * r) by (apply Rmult_le_compat_r; lra).
  apply Rabs_le_inv in N. lra.
Qed.
Lemma single_lower r : 0 <= r -> r * (1 - / 1000000) - eta (-149) <= single r.
Proof.
  intros P. destruct tiny_constants as (_ & _ & E3 & E4 & _). pose proof (single_near direction r) as N.
  rewrite (Rabs_pos_eq r P) in N. assert (eps * r <= / 1000000 * r) by (apply Rmult_le_compat_r; lra).
  apply Rabs_le_inv in N. lra.
Qed.

Lemma margin_lower : margin_in_double <= 8 -> 1.00005 * (d * scale f) + 3.99 * eps <= margin_along.
Proof.
  intros L. unfold margin_along. rewrite Rmin_right by auto. clear L. destruct tiny_constants as (E1 & E2 & E3 & E4 & E5 & E6 & E7 & E8).
  destruct (scale_bounds direction low high low_numbers high_numbers low_bounded high_bounded) as (S & _).
  pose proof scale_below as Q. unfold margin_in_double. set (s := scale f) in *. clearbody s.
  assert (C : 1.00009 <= rnd 53 (-1074) nearest 1.0001).
  { pose proof (double_near nearest 1.0001) as N. rewrite (Rabs_pos_eq 1.0001) in N by lra. apply Rabs_le_inv in N.
    lra. }
  set (c := rnd 53 (-1074) nearest 1.0001) in *. clearbody c.
  assert (Cd : 1.00009 * d <= c * d) by (apply Rmult_le_compat_r; lra).
  pose proof (double_lower (c * d) ltac:(lra)) as A. set (a := double (c * d)) in *.
  assert (A0 : 0 <= a) by (apply rnd_nonnegative; auto with typeclass_instances; lra). clearbody a.
  assert (As : (1.00008 * d - eta (-1074)) * s <= a * s) by (apply Rmult_le_compat_r; lra).
  assert (Es : eta (-1074) * s <= eps / 100000000).
  { apply Rle_trans with (eta (-1074) * bpow radix2 1000); [apply Rmult_le_compat_l; lra |].
    unfold Format.eta. rewrite <- bpow_plus. apply Rle_trans with (bpow radix2 (-23 + -28)); [apply bpow_le; lia |].
    rewrite bpow_plus. unfold Rdiv. apply Rmult_le_compat_l; [apply bpow_ge_0 |]. simpl. lra. }
  pose proof (Rmult_le_pos d s d_0 S) as D. pose proof (Rmult_le_pos a s A0 S) as P.
  rewrite Rmult_minus_distr_r, Rmult_assoc in As. set (ds := d * s) in *. clearbody ds.
  pose proof (double_lower (a * s) P) as B. set (b := double (a * s)) in *.
  assert (B0 : 0 <= b) by (apply rnd_nonnegative; auto with typeclass_instances). clearbody b.
  pose proof (double_lower (b + 4 * eps) ltac:(lra)) as M.
  assert (M0 : 0 <= double (b + 4 * eps)) by (apply rnd_nonnegative; auto with typeclass_instances; lra).
  pose proof (single_lower _ M0) as W. lra.
Qed.
Lemma across_lower : margin_in_double <= 8 -> 2.00005 * (d * scale f) + 14.9 * eps <= margin_across.
Proof.
  intros U. destruct tiny_constants as (E1 & E2 & E3 & E4 & E5 & E6 & E7 & E8). pose proof (margin_lower U) as M.
  destruct (scale_bounds direction low high low_numbers high_numbers low_bounded high_bounded) as (S & _).
  pose proof (Rmult_le_pos d _ d_0 S) as D. unfold margin_across, outwards. set (w := margin_along) in *. clearbody w.
  pose proof (single_lower (2 * w) ltac:(lra)) as A.
  assert (A0 : 0 <= single (2 * w)) by (apply rnd_nonnegative; auto with typeclass_instances; lra).
  pose proof (single_lower (7 * eps + single (2 * w)) ltac:(lra)) as B. lra.
Qed.

(** A margin that covers the error of r, and that of its own subtraction. *)
Lemma moved_enough w r g c : Rabs r <= 2.003 -> Rabs (r - g) <= c -> c + 2.004 * eps <= 0.99999 * w ->
  single (r - w) <= g <= single (r + w).
Proof.
  intros A B C. destruct tiny_constants as (_ & _ & E3 & E4 & E5 & _).
  pose proof (Rabs_pos (r - g)) as P. assert (W : 0 <= w) by lra.
  assert (N : forall t, Rabs t <= 2.003 + w -> Rabs (single t - t) <= 2.0031 * eps + 0.000001 * w).
  { intros t T. pose proof (single_near direction t) as M.
    assert (eps * Rabs t <= eps * (2.003 + w)) by (apply Rmult_le_compat_l; lra).
    assert (eps * w <= / 1000000 * w) by (apply Rmult_le_compat_r; lra). lra. }
  apply Rabs_le_inv in A, B.
  pose proof (N (r - w) ltac:(apply Rabs_le; lra)) as D. pose proof (N (r + w) ltac:(apply Rabs_le; lra)) as U.
  apply Rabs_le_inv in D, U. lra.
Qed.

Lemma scaled_off n p q : Rabs (x p - x q) <= d -> Rabs (y p - y q) <= d -> Rabs (z p - z q) <= d ->
  Rabs (scaled n q - scaled n p) <= (Rabs (x n) + Rabs (y n) + Rabs (z n)) * (d * scale f).
Proof.
  intros X Y Z. destruct (scale_bounds direction low high low_numbers high_numbers low_bounded high_bounded) as (S & _).
  replace (scaled n q - scaled n p) with
    (- (x n * (x p - x q) + y n * (y p - y q) + z n * (z p - z q)) * scale f)
    by (unfold scaled, dot, minus; cbn [x y z]; ring).
  rewrite Rabs_mult, Rabs_Ropp, (Rabs_pos_eq (scale f)), <- Rmult_assoc by easy. apply Rmult_le_compat_r; auto.
  assert (H : forall k m, Rabs m <= d -> Rabs (k * m) <= Rabs k * d)
    by (intros; rewrite Rabs_mult; apply Rmult_le_compat_l; auto using Rabs_pos).
  pose proof (H (x n) _ X). pose proof (H (y n) _ Y). pose proof (H (z n) _ Z).
  pose proof (Rabs_triang (x n * (x p - x q) + y n * (y p - y q)) (z n * (z p - z q))).
  pose proof (Rabs_triang (x n * (x p - x q)) (y n * (y p - y q))). lra.
Qed.

Lemma coordinate_near a p : In a coordinates_in_float ->
  number (x p) -> number (y p) -> number (z p) -> inside_box low high p ->
  Rabs (fst a (rounded_point direction f p)) <= 2.003 /\
  Rabs (fst a (rounded_point direction f p) - scaled (snd a) p) <= 1.01 * eps.
Proof.
  intros I Px Py Pz B.
  destruct (rounded_point_near direction low high low_numbers high_numbers low_bounded high_bounded p Px Py Pz B)
    as ((Lx & Ex) & (Ly & Ey) & (Lz & Ez)).
  set (r := rounded_point direction f p) in *. unfold scaled, dot, minus. clearbody r.
  destruct I as [<- | [<- | [<- | []]]]; cbn [fst snd x y z]; rewrite !Rmult_0_l, ?Rplus_0_l, ?Rplus_0_r, Rmult_1_l;
    split; lra || easy.
Qed.

Theorem wide_extents_hold a e first others stored q : margin_in_double <= 8 ->
  In a wide_axes -> In stored (first :: others) -> in_frame stored -> off_by q stored ->
  least (of_element first others a e) <= scaled (snd (fst a)) (at_end q e) <= most (of_element first others a e).
Proof.
  intros U A I (N & B) O. destruct (N e) as (Nx & Ny & Nz), (O e) as (Ox & Oy & Oz).
  destruct (wider_than_vertex first others a e stored I) as (L & M). unfold computed in L, M.
  enough (G : single (fst (fst a) (rounded_point direction f (at_end stored e)) - snd a) <=
    scaled (snd (fst a)) (at_end q e) <= single (fst (fst a) (rounded_point direction f (at_end stored e)) + snd a))
    by lra.
  destruct (scale_bounds direction low high low_numbers high_numbers low_bounded high_bounded) as (S & _).
  pose proof (Rmult_le_pos d _ d_0 S) as D. destruct tiny_constants as (_ & _ & _ & E4 & _).
  pose proof (scaled_off (snd (fst a)) _ _ Ox Oy Oz) as F.
  assert (T : forall r g h c, Rabs (r - g) <= c -> forall k, Rabs (g - h) <= k -> Rabs (r - h) <= c + k).
  { intros r g h c K k K'. apply Rabs_le_inv in K, K'. apply Rabs_le. lra. }
  apply in_app_or in A. destruct A as [A | A]; apply in_map_iff in A; destruct A as (b & <- & A); cbn [fst snd] in *.
  - destruct (coordinate_near b _ A Nx Ny Nz (B e)) as (R1 & R2).
    apply moved_enough with (1.01 * eps + 1 * (d * scale f)); auto.
    + apply (T _ _ _ _ R2). apply Rle_trans with (1 := F). apply Rmult_le_compat_r; auto.
      destruct A as [<- | [<- | [<- | []]]]; cbn [snd x y z]; rewrite Rabs_R0, Rabs_R1; lra.
    + pose proof (margin_lower U). lra.
  - destruct (diagonal_near b _ A Nx Ny Nz (B e)) as (R1 & R2).
    apply moved_enough with (4.05 * eps + 2 * (d * scale f)); auto.
    + apply (T _ _ _ _ R2). apply Rle_trans with (1 := F). apply Rmult_le_compat_r; auto.
      destruct A as [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]; cbn [snd x y z];
        rewrite ?Rabs_R0, ?Rabs_R1, ?(Rabs_left (-1)) by lra; lra.
    + pose proof (across_lower U). lra.
Qed.

(** The largest margin exceeds all projections. *)
Lemma largest_margin_extents_hold_0 a e first others : 8 < margin_in_double -> In a wide_axes -> in_frame first ->
  least (of_element first others a e) <= 0 <= most (of_element first others a e).
Proof.
  intros U A (N & B). destruct (N e) as (Nx & Ny & Nz).
  destruct (wider_than_vertex first others a e first (or_introl eq_refl)) as (L & M). unfold computed in L, M.
  destruct tiny_constants as (E1 & E2 & E3 & E4 & E5 & E6 & E7 & E8).
  assert (W : 7 <= margin_along).
  { unfold margin_along. rewrite Rmin_left by lra. pose proof (single_lower 8 ltac:(lra)). lra. }
  assert (V : 7 <= margin_across).
  { unfold margin_across, outwards. pose proof (single_lower (2 * margin_along) ltac:(lra)) as P.
    pose proof (single_lower (7 * eps + single (2 * margin_along)) ltac:(lra)). lra. }
  assert (C : Rabs (fst (fst a) (rounded_point direction f (at_end first e))) <= 2.003 /\ 7 <= snd a).
  { apply in_app_or in A. destruct A as [A | A]; apply in_map_iff in A; destruct A as (b & <- & A); cbn [fst snd].
    - now destruct (coordinate_near b _ A Nx Ny Nz (B e)).
    - now destruct (diagonal_near b _ A Nx Ny Nz (B e)). }
  destruct C as (C & D). apply Rabs_le_inv in C. set (r := fst (fst a) _) in *. clearbody r.
  assert (Z : float 0) by apply number_0. split.
  - apply Rle_trans with (1 := L). apply rnd_below; auto with typeclass_instances. lra.
  - apply Rle_trans with (2 := M). apply rnd_nonnegative; auto with typeclass_instances. lra.
Qed.

(** Vertices of the first element come before those of the second along an axis. *)
Lemma until_before p l r m G H : holds G (of_element p l) -> holds H (of_element r m) ->
  apart_until G H = true \/ apart_until H G = true -> Forall in_frame (p :: l) -> Forall in_frame (r :: m) ->
  exists n, forall q t s s', In s (p :: l) -> In s' (r :: m) -> off_by q s -> off_by t s' -> before n q t.
Proof.
  rewrite !Forall_forall. intros Gh Hh A P R'.
  apply either_apart, (group_apart_along _ G H _ _ Gh Hh), apart_axis in A.
  destruct A as (a & I & A). destruct (Rlt_or_le 8 margin_in_double) as [U | U].
  { pose proof (largest_margin_extents_hold_0 a false p l U I (P p (or_introl eq_refl))).
    pose proof (largest_margin_extents_hold_0 a false r m U I (R' r (or_introl eq_refl))).
    destruct A as [A | A]; specialize (A false); lra. }
  destruct (scale_bounds direction low high low_numbers high_numbers low_bounded high_bounded) as (S & _).
  assert (K : forall n v w, scaled n v < scaled n w -> dot n v < dot n w).
  { intros n v w L. apply Rnot_le_lt. intros C. assert (D : scaled n w <= scaled n v).
    { unfold scaled. apply Rmult_le_compat_r; auto. unfold dot, minus in *. cbn [x y z] in *. lra. }
    lra. }
  destruct A as [A | A].
  - exists (minus origin (snd (fst a))). intros q t s s' Q T Oq Ot. apply before_opposite, before_of. intros e.
    apply K. specialize (A e). pose proof (wide_extents_hold a e p l s q U I Q (P s Q) Oq).
    pose proof (wide_extents_hold a e r m s' t U I T (R' s' T) Ot). lra.
  - exists (snd (fst a)). intros q t s s' Q T Oq Ot. apply before_of. intros e.
    apply K. specialize (A e). pose proof (wide_extents_hold a e p l s q U I Q (P s Q) Oq).
    pose proof (wide_extents_hold a e r m s' t U I T (R' s' T) Ot). lra.
Qed.

(** The motion until a time, over the whole step's time, and the stored one. *)
Definition until (t : R) (q : moving) : moving := Moving (start q) (place q t).
Lemma place_until t s : 0 <= s <= t -> exists r, 0 <= r <= 1 /\ forall q, place q s = place (until t q) r.
Proof.
  intros (A & B). destruct (Req_dec t 0) as [-> | Z].
  - exists 0. split; [lra |]. intros p. replace s with 0 by lra. unfold until, place. cbn [start finish x y z].
    apply same_point; cbn [x y z]; ring.
  - exists (s / t). split.
    + split; [apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra] |].
      apply Rmult_le_reg_r with t; [lra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra.
    + intros p. unfold until, place. cbn [start finish x y z]. apply same_point; cbn [x y z]; field; auto.
Qed.
Definition stored_until (t : R) (q stored : moving) : Prop := in_frame stored /\ off_by (until t q) stored.

Theorem until_face_separate t v f0 f1 f2 v' f0' f1' f2' G H :
  stored_until t v v' -> stored_until t f0 f0' -> stored_until t f1 f1' -> stored_until t f2 f2' ->
  holds G (of_element v' []) -> holds H (of_element f0' [f1'; f2']) ->
  apart_until G H = true \/ apart_until H G = true ->
  ~ exists s, 0 <= s <= t /\ in_triangle (place v s) (place f0 s) (place f1 s) (place f2 s).
Proof.
  intros (V & Ov) (F0 & O0) (F1 & O1) (F2 & O2) Gv Hf A (s & T & C).
  destruct (until_before _ _ _ _ G H Gv Hf A) as (n & B); auto.
  destruct (place_until t s T) as (r & R1 & P). rewrite !P in C.
  apply (face_separated n (until t v) (until t f0) (until t f1) (until t f2));
    [apply (B _ _ v' f0') | apply (B _ _ v' f1') | apply (B _ _ v' f2') | now exists r]; simpl; auto.
Qed.
Theorem until_edges_separate t a0 a1 b0 b1 a0' a1' b0' b1' G H :
  stored_until t a0 a0' -> stored_until t a1 a1' -> stored_until t b0 b0' -> stored_until t b1 b1' ->
  holds G (of_element a0' [a1']) -> holds H (of_element b0' [b1']) ->
  apart_until G H = true \/ apart_until H G = true ->
  ~ exists s, 0 <= s <= t /\ segments_meet (place a0 s) (place a1 s) (place b0 s) (place b1 s).
Proof.
  intros (A0 & O0) (A1 & O1) (B0 & O2) (B1 & O3) Ga Hb A (s & T & C).
  destruct (until_before _ _ _ _ G H Ga Hb A) as (n & B); auto.
  destruct (place_until t s T) as (r & R1 & P). rewrite !P in C.
  apply (edges_separated n (until t a0) (until t a1) (until t b0) (until t b1));
    [apply (B _ _ a0' b0') | apply (B _ _ a0' b1') | apply (B _ _ a1' b0') | apply (B _ _ a1' b1') | now exists r];
    simpl; auto.
Qed.

(** A way that ends near the fraction s of the stored one: short_way with spare. Errors of its ends are within d. *)
Definition shorter (s : R) (w stored : moving) : Prop := in_frame stored /\
  off_by (Moving (start w) (finish stored)) stored /\ exists q, off_by q stored /\ finish w = place q s.

Lemma shorter_before s p l r m G H : 0 <= s <= 1 -> holds G (of_element p l) -> holds H (of_element r m) ->
  apart_until G H = true \/ apart_until H G = true -> Forall in_frame (p :: l) -> Forall in_frame (r :: m) ->
  exists n, forall w v c c', In c (p :: l) -> In c' (r :: m) -> shorter s w c -> shorter s v c' -> before n w v.
Proof.
  intros S Gh Hh A P R'. destruct (until_before p l r m G H Gh Hh A P R') as (n & B). exists n.
  intros w v c c' C C' (_ & W & q & Q & Fw) (_ & V & t & T & Fv).
  destruct (B _ _ c c' C C' W V) as (B0 & _). destruct (B _ _ c c' C C' Q T) as (B1 & B2).
  split; [exact B0 |]. rewrite Fw, Fv. unfold place, dot in *. cbn [start finish x y z] in *.
  destruct (Req_dec s 0) as [-> | Z]; [lra |].
  assert (0 <= (1 - s) * (x n * x (start t) + y n * y (start t) + z n * z (start t) -
    (x n * x (start q) + y n * y (start q) + z n * z (start q)))) by (apply Rmult_le_pos; lra).
  assert (0 < s * (x n * x (finish t) + y n * y (finish t) + z n * z (finish t) -
    (x n * x (finish q) + y n * y (finish q) + z n * z (finish q)))) by (apply Rmult_lt_0_compat; lra).
  lra.
Qed.
Theorem shorter_face_separate s v f0 f1 f2 v' f0' f1' f2' G H : 0 <= s <= 1 ->
  shorter s v v' -> shorter s f0 f0' -> shorter s f1 f1' -> shorter s f2 f2' ->
  holds G (of_element v' []) -> holds H (of_element f0' [f1'; f2']) ->
  apart_until G H = true \/ apart_until H G = true -> ~ vertex_face_collides v f0 f1 f2.
Proof.
  intros S V F0 F1 F2 Gv Hf A. destruct (shorter_before s _ _ _ _ G H S Gv Hf A) as (n & B).
  1, 2: destruct V, F0, F1, F2; auto.
  apply (face_separated n); [apply (B _ _ v' f0') | apply (B _ _ v' f1') | apply (B _ _ v' f2')]; simpl; auto.
Qed.
Theorem shorter_edges_separate s a0 a1 b0 b1 a0' a1' b0' b1' G H : 0 <= s <= 1 ->
  shorter s a0 a0' -> shorter s a1 a1' -> shorter s b0 b0' -> shorter s b1 b1' ->
  holds G (of_element a0' [a1']) -> holds H (of_element b0' [b1']) ->
  apart_until G H = true \/ apart_until H G = true -> ~ edge_edge_collides a0 a1 b0 b1.
Proof.
  intros S A0 A1 B0 B1 Ga Hb A. destruct (shorter_before s _ _ _ _ G H S Ga Hb A) as (n & B).
  1, 2: destruct A0, A1, B0, B1; auto.
  apply (edges_separated n); [apply (B _ _ a0' b0') | apply (B _ _ a0' b1') | apply (B _ _ a1' b0') |
    apply (B _ _ a1' b1')]; simpl; auto.
Qed.

(** swept_boxes::widen of ccd/step/swept_boxes.hpp: boxes of stored positions in doubles, widened by d. One step up
    follows each rounding. *)
Definition above (r : R) : R := succ radix2 (FLT_exp (-1074) 53) r.
Definition widened_low (m : R) : R := - above (double (d - m)).
Definition widened_high (m : R) : R := above (double (m + d)).
Theorem widened_holds m r : (m - d <= r -> widened_low m <= r) /\ (r <= m + d -> r <= widened_high m).
Proof.
  assert (A : forall t, t <= above (double t))
    by (intros t; apply succ_round_ge_id; auto with typeclass_instances).
  split; intros H; [pose proof (A (d - m)) | pose proof (A (m + d))]; unfold widened_low, widened_high; lra.
Qed.

Notation low_of k q l := (widened_low (sweep Rmin (coordinate_of k) q l)).
Notation high_of k q l := (widened_high (sweep Rmax (coordinate_of k) q l)).
Lemma boxes_before k t p l r m : high_of k p l < low_of k r m -> forall q s q' s',
  In q' (p :: l) -> In s' (r :: m) -> off_by (until t q) q' -> off_by (until t s) s' ->
  before (axis_of k) (until t q) (until t s).
Proof.
  intros L q s q' s' Q S Oq Os. apply before_of. intros e. rewrite !coordinate_along.
  assert (C : forall v v', off_by v v' ->
    Rabs (coordinate_of k (at_end v e) - coordinate_of k (at_end v' e)) <= d).
  { intros v v' O. destruct (O e) as (A & B & C). destruct k as [| [|]]; auto. }
  apply C, Rabs_le_inv in Oq, Os. destruct (high_above (coordinate_of k) p l q' Q) as (H1 & H2).
  destruct (low_below (coordinate_of k) r m s' S) as (L1 & L2).
  apply Rle_lt_trans with (high_of k p l); [| apply Rlt_le_trans with (1 := L)];
    apply widened_holds; destruct e; cbn [at_end] in *; lra.
Qed.
Theorem until_boxes_face_separate k t v f0 f1 f2 v' f0' f1' f2' :
  off_by (until t v) v' -> off_by (until t f0) f0' -> off_by (until t f1) f1' -> off_by (until t f2) f2' ->
  high_of k v' [] < low_of k f0' [f1'; f2'] \/ high_of k f0' [f1'; f2'] < low_of k v' [] ->
  ~ exists s, 0 <= s <= t /\ in_triangle (place v s) (place f0 s) (place f1 s) (place f2 s).
Proof.
  intros Ov O0 O1 O2 [B | B] (s & T & C); destruct (place_until t s T) as (r & R1 & P); rewrite !P in C;
    pose proof (boxes_before k t _ _ _ _ B) as O.
  - apply (face_separated (axis_of k) (until t v) (until t f0) (until t f1) (until t f2));
      [apply (O _ _ v' f0') | apply (O _ _ v' f1') | apply (O _ _ v' f2') | now exists r]; simpl; auto.
  - apply (face_separated (minus origin (axis_of k)) (until t v) (until t f0) (until t f1) (until t f2));
      [apply before_opposite, (O _ _ f0' v') | apply before_opposite, (O _ _ f1' v') |
       apply before_opposite, (O _ _ f2' v') | now exists r]; simpl; auto.
Qed.
Theorem until_boxes_edges_separate k t a0 a1 b0 b1 a0' a1' b0' b1' :
  off_by (until t a0) a0' -> off_by (until t a1) a1' -> off_by (until t b0) b0' -> off_by (until t b1) b1' ->
  high_of k a0' [a1'] < low_of k b0' [b1'] \/ high_of k b0' [b1'] < low_of k a0' [a1'] ->
  ~ exists s, 0 <= s <= t /\ segments_meet (place a0 s) (place a1 s) (place b0 s) (place b1 s).
Proof.
  intros A0 A1 B0 B1 [B | B] (s & T & C); destruct (place_until t s T) as (r & R1 & P); rewrite !P in C;
    pose proof (boxes_before k t _ _ _ _ B) as O.
  - apply (edges_separated (axis_of k) (until t a0) (until t a1) (until t b0) (until t b1));
      [apply (O _ _ a0' b0') | apply (O _ _ a0' b1') | apply (O _ _ a1' b0') | apply (O _ _ a1' b1') | now exists r];
      simpl; auto.
  - apply (edges_separated (minus origin (axis_of k)) (until t a0) (until t a1) (until t b0) (until t b1));
      [apply before_opposite, (O _ _ b0' a0') | apply before_opposite, (O _ _ b1' a0') |
       apply before_opposite, (O _ _ b0' a1') | apply before_opposite, (O _ _ b1' a1') | now exists r]; simpl; auto.
Qed.

End Until.

End Extents.

(** ** The end of the motion until a time *)

(** short_way::after: a coordinate from r to s at time t, and its part of the error. To nearest. *)
Section After.

Notation fl := (rnd 53 (-1074) nearest).
Notation number := (Format.number 53 (-1074)).
Notation eta := (eta (-1074)).
Notation u := (u 53).
Definition from_start (t r : R) : R := fl (fl (1 - t) * r).
Definition from_finish (t s : R) : R := fl (t * s).
Definition after (t r s : R) : R := Rmax (Rmin r s) (Rmin (Rmax r s) (fl (from_start t r + from_finish t s))).
Definition after_error (t r s : R) : R := fl (fl (bpow radix2 (-50) *
  fl (fl (Rabs (from_start t r) / 2) + fl (Rabs (from_finish t s) / 2))) + bpow radix2 (-1072)).

Lemma fl_error : rounding_error 53 (-1074) nearest u (eta / 2).
Proof. exact (rounding_error_nearest 53 (-1074) ltac:(lia)). Qed.
Lemma fl_near r : Rabs (fl r - r) <= u * Rabs r + eta / 2.
Proof. apply (error_any _ _ _ _ _ fl_error). Qed.
Lemma u_tiny : 0 < u <= / 1000000000.
Proof. split; [apply bpow_gt_0 |]. apply Rle_trans with (bpow radix2 (-30)); [apply bpow_le; lia | simpl; lra]. Qed.
Lemma fl_lower r : 0 <= r -> r * (1 - / 1000000000) - eta / 2 <= fl r.
Proof.
  intros P. pose proof u_tiny as U. pose proof (fl_near r) as N. rewrite (Rabs_pos_eq r P) in N.
  assert (u * r <= / 1000000000 * r) by (apply Rmult_le_compat_r; lra). apply Rabs_le_inv in N. lra.
Qed.

Lemma sum_after t r s : number t -> 0 <= t <= 1 ->
  Rabs (fl (from_start t r + from_finish t s) - ((1 - t) * r + t * s)) <= after_error t r s.
Proof.
  intros Nt T. pose proof u_tiny as U. pose proof (eta_positive (-1074)) as Q.
  assert (N1 : number 1) by (change 1 with (bpow radix2 0); apply number_power; [exact eq_refl | lia]).
  pose proof (sum_error _ _ nearest _ _ fl_error 1 (- t) N1 (number_opp _ _ _ Nt)) as K.
  fold (1 - t) in K. set (k := fl (1 - t)) in *.
  pose proof (fl_near (k * r)) as A. change (fl (k * r)) with (from_start t r) in A.
  pose proof (fl_near (t * s)) as B. change (fl (t * s)) with (from_finish t s) in B.
  pose proof (sum_error _ _ nearest _ _ fl_error (from_start t r) (from_finish t s)
    (rnd_number _ _ nearest _) (rnd_number _ _ nearest _)) as C.
  unfold after_error. set (a := from_start t r) in *. set (b := from_finish t s) in *. clearbody a b k.
  assert (K1 : Rabs (k * r - (1 - t) * r) <= u * Rabs ((1 - t) * r)).
  { rewrite <- Rmult_minus_distr_r, !Rabs_mult, <- Rmult_assoc. apply Rmult_le_compat_r; [apply Rabs_pos | exact K]. }
  set (v := (1 - t) * r) in *. set (w := t * s) in *. set (c := k * r) in *. clearbody v w c.
  (* sizes times u *)
  assert (Va : Rabs c <= Rabs v + u * Rabs v).
  { pose proof (Rabs_triang (c - v) v) as H. replace (c - v + v) with c in H by ring. lra. }
  assert (Ua : Rabs v <= Rabs a + 3 * (u * Rabs v) + eta / 2).
  { assert (u * Rabs c <= u * (Rabs v + u * Rabs v)) by (apply Rmult_le_compat_l; lra).
    assert (u * (u * Rabs v) <= / 1000000000 * (u * Rabs v))
      by (apply Rmult_le_compat_r; [apply Rmult_le_pos; [lra | apply Rabs_pos] | lra]).
    pose proof (Rabs_pos v). assert (0 <= u * Rabs v) by (apply Rmult_le_pos; lra).
    pose proof (Rabs_triang (v - c) (c - a)) as D1. pose proof (Rabs_triang (v - a) a) as D2.
    replace (v - c + (c - a)) with (v - a) in D1 by ring. replace (v - a + a) with v in D2 by ring.
    rewrite (Rabs_minus_sym v c), (Rabs_minus_sym c a) in D1. lra. }
  assert (Ub : Rabs w <= Rabs b + u * Rabs w + eta / 2).
  { pose proof (Rabs_triang (w - b) b) as H. replace (w - b + b) with w in H by ring.
    rewrite (Rabs_minus_sym w b) in H. lra. }
  assert (Small : forall m, 0 <= m -> 0 <= u * m <= / 1000000000 * m)
    by (intros m M; split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; lra).
  pose proof (Rabs_pos v) as Pv. pose proof (Rabs_pos w) as Pw. pose proof (Rabs_pos a) as Pa.
  pose proof (Rabs_pos b) as Pb.
  pose proof (Small _ Pv) as Sv. pose proof (Small _ Pw) as Sw. pose proof (Small _ Pa) as Sa.
  pose proof (Small _ Pb) as Sb.
  pose proof (Small (u * Rabs v) ltac:(lra)) as Suv. pose proof (Small (u * Rabs w) ltac:(lra)) as Suw.
  pose proof (Small eta ltac:(lra)) as Se.
  assert (Mv : u * Rabs v <= u * Rabs a + 3 * (u * (u * Rabs v)) + u * eta / 2).
  { apply (Rmult_le_compat_l u) in Ua; lra. }
  assert (Mw : u * Rabs w <= u * Rabs b + u * (u * Rabs w) + u * eta / 2).
  { apply (Rmult_le_compat_l u) in Ub; lra. }
  assert (Mc : u * Rabs c <= u * Rabs v + u * (u * Rabs v)).
  { apply (Rmult_le_compat_l u) in Va; lra. }
  assert (Ms : u * Rabs (a + b) <= u * Rabs a + u * Rabs b).
  { rewrite <- Rmult_plus_distr_l. apply Rmult_le_compat_l; [lra | apply Rabs_triang]. }
  assert (Total : Rabs (fl (a + b) - (v + w)) <= 3.001 * (u * Rabs a) + 2.001 * (u * Rabs b) + 1.001 * eta).
  { apply Rabs_le_inv in K1, A, B, C. apply Rabs_le. lra. }
  apply Rle_trans with (1 := Total).
  (* the computed bound *)
  pose proof (fl_lower (Rabs a / 2) ltac:(lra)) as Ha. pose proof (fl_lower (Rabs b / 2) ltac:(lra)) as Hb.
  assert (Na : 0 <= fl (Rabs a / 2)) by (apply rnd_nonnegative; auto with typeclass_instances; lra).
  assert (Nb : 0 <= fl (Rabs b / 2)) by (apply rnd_nonnegative; auto with typeclass_instances; lra).
  set (ha := fl (Rabs a / 2)) in *. set (hb := fl (Rabs b / 2)) in *. clearbody ha hb.
  pose proof (fl_lower (ha + hb) ltac:(lra)) as H.
  assert (N : 0 <= fl (ha + hb)) by (apply rnd_nonnegative; auto with typeclass_instances; lra).
  set (h := fl (ha + hb)) in *. clearbody h.
  assert (E8 : bpow radix2 (-50) = 8 * u).
  { change 8 with (bpow radix2 3). unfold Format.u. rewrite <- bpow_plus. reflexivity. }
  assert (E4 : bpow radix2 (-1072) = 4 * eta).
  { change 4 with (bpow radix2 2). unfold Format.eta. rewrite <- bpow_plus. reflexivity. }
  rewrite E8, E4. pose proof (Small _ N) as Sh.
  assert (Uh : 0.499 * (u * Rabs a) + 0.499 * (u * Rabs b) - 2 * (u * eta) <= u * h).
  { replace (0.499 * (u * Rabs a) + 0.499 * (u * Rabs b) - 2 * (u * eta)) with
      (u * (0.499 * Rabs a + 0.499 * Rabs b - 2 * eta)) by ring. apply Rmult_le_compat_l; lra. }
  pose proof (fl_lower (8 * u * h) ltac:(lra)) as F.
  assert (N' : 0 <= fl (8 * u * h)) by (apply rnd_nonnegative; auto with typeclass_instances; lra).
  pose proof (fl_lower (fl (8 * u * h) + 4 * eta) ltac:(lra)) as F'. lra.
Qed.

Theorem after_near t r s : number t -> 0 <= t <= 1 -> number r -> number s ->
  number (after t r s) /\ Rmin r s <= after t r s <= Rmax r s /\
  Rabs (after t r s - ((1 - t) * r + t * s)) <= after_error t r s.
Proof.
  intros Nt T Nr Ns. pose proof (sum_after t r s Nt T) as E.
  assert (I : Rmin r s <= (1 - t) * r + t * s <= Rmax r s).
  { pose proof (Rmin_l r s). pose proof (Rmin_r r s). pose proof (Rmax_l r s). pose proof (Rmax_r r s).
    nra. }
  unfold after. set (c := fl (from_start t r + from_finish t s)) in *.
  assert (Nc : number c) by exact (rnd_number _ _ nearest _). set (v := (1 - t) * r + t * s) in *. clearbody c v.
  apply Rabs_le_inv in E. split; [| split; [| apply Rabs_le]]; revert I; unfold Rmax, Rmin;
    repeat destruct Rle_dec; intros; auto; lra.
Qed.

End After.
