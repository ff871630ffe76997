(** Comparisons of a step's search (ccd/step/extents_pack.hpp and ccd/step/search_kernels.cpp): extents of elements
    and groups along nine axes at both ends of the step. They are in single precision, with coordinates rounded as in
    RoundedAxes.v, in any direction, the same in both formats. All positions are in the frame's box. Results:
        coordinate_extents_hold   along x, y, z extents contain the rounded coordinates of all vertices
        diagonal_extents_hold     along x ± y, y ± z, z ± x they contain the exact projections, moved and scaled like
                                  coordinates: the margin of 7 eps covers all roundings, including its own
        extents_tell              if one element's most is below another's least, all vertices of the first come
                                  before all of the second in exact arithmetic
        group_extents_hold, group_extents_apart   a group's extents contain those of all members, at any depth; if
                                  extents around two elements are apart, so are the elements' extents
        apart_face_separate, apart_edges_separate   a pair skipped by its extents, or by those of groups around
                                  one or both, has no contact in the step *)

From Coq Require Import Reals ZArith List Lia Lra Bool.
From Flocq Require Import Core.
From Errbound Require Import Format Contact Decisions SeparatingAxis RoundedAxes.
Import ListNotations.
Open Scope R_scope.

#[local] Instance float_precision : Prec_gt_0 24 := eq_refl.
#[local] Instance double_precision : Prec_gt_0 53 := eq_refl.

Section Extents.

Variable direction : R -> Z.
Context {direction_valid : Valid_rnd direction}.
Notation single := (rnd 24 (-149) direction).
Notation number := (Format.number 53 (-1074)).
Notation float := (Format.number 24 (-149)).
Notation eps := (eps 24).

Variables low high : point.
Hypothesis low_numbers : number (x low) /\ number (y low) /\ number (z low).
Hypothesis high_numbers : number (x high) /\ number (y high) /\ number (z high).
Hypothesis low_bounded : bounded low.
Hypothesis high_bounded : bounded high.
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

(** separated, of a pack's member E and of F *)
Definition apart (E F : extents) : bool := existsb (fun a => separated_along (fun e =>
  (Rlt_bool (most (F a e)) (least (E a e)), Rlt_bool (most (E a e)) (least (F a e))))) search_axes.

(** ** Elements *)

Lemma fold_min_below (value : moving -> R) others m :
  let r := fold_left (fun m q => Rmin m (value q)) others m in
  r <= m /\ forall q, In q others -> r <= value q.
Proof.
  revert m. induction others as [| q l IH]; intros m; cbn zeta; cbn [fold_left]; [split; [lra | easy] |].
  destruct (IH (Rmin m (value q))) as (A & B).
  pose proof (Rmin_l m (value q)). pose proof (Rmin_r m (value q)).
  split; [lra |]. intros r [<- | I]; [lra | now apply B].
Qed.
Lemma fold_max_above (value : moving -> R) others m :
  let r := fold_left (fun m q => Rmax m (value q)) others m in
  m <= r /\ forall q, In q others -> value q <= r.
Proof.
  revert m. induction others as [| q l IH]; intros m; cbn zeta; cbn [fold_left]; [split; [lra | easy] |].
  destruct (IH (Rmax m (value q))) as (A & B).
  pose proof (Rmax_l m (value q)). pose proof (Rmax_r m (value q)).
  split; [lra |]. intros r [<- | I]; [lra | now apply B].
Qed.
(** Extents are at least as wide as those of a single vertex. *)
Lemma wider_than_vertex first others a e q : In q (first :: others) ->
  least (of_element first others a e) <= single (computed a e q - snd a) /\
  single (computed a e q + snd a) <= most (of_element first others a e).
Proof.
  intros I. cbn [of_element least most].
  destruct (fold_min_below (computed a e) others (computed a e first)) as (A & B).
  destruct (fold_max_above (computed a e) others (computed a e first)) as (C & D).
  split; apply single_le; auto.
  - destruct I as [<- | I]; [lra | specialize (B q I); lra].
  - destruct I as [<- | I]; [lra | specialize (D q I); lra].
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

Lemma sum_size r s : Rabs r <= 1.001 -> Rabs s <= 1.001 -> Rabs (single (r + s)) <= 2.003.
Proof.
  intros A B. destruct tiny_constants as (_ & _ & E3 & E4 & E5 & _).
  pose proof (single_near direction (r + s)) as N. pose proof (Rabs_triang r s) as T.
  assert (eps * Rabs (r + s) <= eps * 2.002) by (apply Rmult_le_compat_l; lra).
  assert (M : Rabs (single (r + s) - (r + s)) <= 0.001) by lra.
  assert (C : Rabs (r + s) <= 2.002) by lra.
  apply Rabs_le_inv in M, C. apply Rabs_le. lra.
Qed.
Lemma difference_size r s : Rabs r <= 1.001 -> Rabs s <= 1.001 -> Rabs (single (r - s)) <= 2.003.
Proof. intros A B. apply (sum_size r (- s)); auto. now rewrite Rabs_Ropp. Qed.

Lemma diagonal_near a p : In a (diagonals_in_float direction) ->
  number (x p) -> number (y p) -> number (z p) -> inside_box low high p ->
  Rabs (fst a (rounded_point direction f p)) <= 2.003 /\
  Rabs (fst a (rounded_point direction f p) - scaled (snd a) p) <= 4.05 * eps.
Proof.
  intros I Px Py Pz B.
  destruct (scale_bounds direction low high low_numbers high_numbers low_bounded high_bounded) as (S & H).
  destruct (H p B) as (Hx & Hy & Hz).
  assert (N : number (x (middle f)) /\ number (y (middle f)) /\ number (z (middle f)))
    by (repeat split; apply double_number; auto). destruct N as (Cx & Cy & Cz).
  pose proof (rounded_near direction _ _ _ Px Cx S Hx) as (Lx & Ex).
  pose proof (rounded_near direction _ _ _ Py Cy S Hy) as (Ly & Ey).
  pose proof (rounded_near direction _ _ _ Pz Cz S Hz) as (Lz & Ez).
  unfold rounded_point, scaled, dot, minus. set (c := middle f) in *. set (s := scale f) in *. clearbody c s.
  destruct I as [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]; cbn [fst snd x y z].
  - split; [now apply sum_size |].
    match goal with |- Rabs (_ - ?r) <= _ => replace r with ((x p - x c) * s + (y p - y c) * s) by ring end.
    now apply sum_in_float.
  - split; [now apply difference_size |].
    match goal with |- Rabs (_ - ?r) <= _ => replace r with ((x p - x c) * s - (y p - y c) * s) by ring end.
    now apply difference_in_float.
  - split; [now apply sum_size |].
    match goal with |- Rabs (_ - ?r) <= _ => replace r with ((y p - y c) * s + (z p - z c) * s) by ring end.
    now apply sum_in_float.
  - split; [now apply difference_size |].
    match goal with |- Rabs (_ - ?r) <= _ => replace r with ((y p - y c) * s - (z p - z c) * s) by ring end.
    now apply difference_in_float.
  - split; [now apply sum_size |].
    match goal with |- Rabs (_ - ?r) <= _ => replace r with ((z p - z c) * s + (x p - x c) * s) by ring end.
    now apply sum_in_float.
  - split; [now apply difference_size |].
    match goal with |- Rabs (_ - ?r) <= _ => replace r with ((z p - z c) * s - (x p - x c) * s) by ring end.
    now apply difference_in_float.
Qed.

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

Lemma apart_axis E F : apart E F = true <-> exists a, In a search_axes /\
  ((forall e, most (F a e) < least (E a e)) \/ (forall e, most (E a e) < least (F a e))).
Proof.
  unfold apart. rewrite existsb_exists. split.
  - intros (a & I & H). exists a. split; auto. apply separated_sides in H. cbn [fst snd] in H.
    destruct H as [H | H]; [left | right]; intros e; now apply less_of.
  - intros (a & I & H). exists a. split; auto. unfold separated_along. cbn [fst snd]. apply orb_true_iff.
    destruct H as [H | H]; [left | right]; apply andb_true_iff; split; now apply Rlt_bool_true.
Qed.
Lemma apart_symmetric E F : apart E F = true -> apart F E = true.
Proof.
  rewrite !apart_axis. intros (a & I & H). exists a. split; auto. destruct H as [H | H]; auto.
Qed.
Theorem group_extents_apart G H E F : holds G E -> holds H F -> apart G H = true -> apart E F = true.
Proof.
  intros A B. rewrite !apart_axis. intros (a & I & C). exists a. split; auto.
  destruct C as [C | C]; [left | right]; intros e; specialize (C e); destruct (A a e), (B a e); lra.
Qed.

(** ** Pairs *)

(** Two elements are apart if all vertices of one come before all of the other along an axis. *)
Lemma apart_before p l r m : apart (of_element p l) (of_element r m) = true ->
  (forall q, In q (p :: l) -> in_frame q) -> (forall t, In t (r :: m) -> in_frame t) ->
  exists n, forall q t, In q (p :: l) -> In t (r :: m) -> before n q t.
Proof.
  rewrite apart_axis. intros (a & I & H) P R'. destruct H as [H | H].
  - exists (minus origin (snd (fst a))). intros q t Q T. apply before_opposite, before_of. intros e.
    now apply (extents_tell a e r m p l t q); auto.
  - exists (snd (fst a)). intros q t Q T. apply before_of. intros e.
    now apply (extents_tell a e p l r m q t); auto.
Qed.

Theorem apart_face_separate v f0 f1 f2 G H : in_frame v -> in_frame f0 -> in_frame f1 -> in_frame f2 ->
  holds G (of_element v []) -> holds H (of_element f0 [f1; f2]) -> apart G H = true \/ apart H G = true ->
  ~ vertex_face_collides v f0 f1 f2.
Proof.
  intros V F0 F1 F2 Gv Hf A. assert (B : apart G H = true) by (destruct A; auto using apart_symmetric).
  apply (group_extents_apart G H _ _ Gv Hf), apart_before in B.
  - destruct B as (n & B). apply (face_separated n); apply B; simpl; auto.
  - intros q [<- | []]. exact V.
  - intros q [<- | [<- | [<- | []]]]; auto.
Qed.
Theorem apart_edges_separate a0 a1 b0 b1 G H : in_frame a0 -> in_frame a1 -> in_frame b0 -> in_frame b1 ->
  holds G (of_element a0 [a1]) -> holds H (of_element b0 [b1]) -> apart G H = true \/ apart H G = true ->
  ~ edge_edge_collides a0 a1 b0 b1.
Proof.
  intros A0 A1 B0 B1 Ga Hb A. assert (B : apart G H = true) by (destruct A; auto using apart_symmetric).
  apply (group_extents_apart G H _ _ Ga Hb), apart_before in B.
  - destruct B as (n & B). apply (edges_separated n); apply B; simpl; auto.
  - intros q [<- | [<- | []]]; auto.
  - intros q [<- | [<- | []]]; auto.
Qed.

End Extents.
