(** Rounding errors in the separation of two features by more than a distance along an axis
    (ccd/contact/separation_filter.hpp). double, to nearest. Results:
        scaled_near          differences of coordinates in units of a power of two
        projection_near      projections to an axis of about unit length
        separated_right      a gap beyond above_ at a time: points are more than d apart along the axis
        separated_part       so `separated` on a subinterval of the step gives an axis as in Separation.v
        axis_length, distance_rounded, size_rounded   the operands *)

From Coq Require Import Reals ZArith Lia Lra Psatz List.
From Flocq Require Import Core.
From Errbound Require Import Contact Distance Separation Format.
From Errbound Require RoundedAxes.
Import ListNotations.
Open Scope R_scope.

#[local] Instance double_precision : Prec_gt_0 53 := eq_refl.
Notation fl := (rnd 53 (-1074) nearest).
Notation double := (number 53 (-1074)).
Notation u := (u 53).
Notation eta := (eta (-1074)).

Lemma u_small : 0 < u <= / 1048576.
Proof. split; [apply u_positive |]. unfold Format.u. apply Rle_trans with (bpow radix2 (-20)); [apply bpow_le; lia | simpl; lra]. Qed.
Lemma fl_number x : double (fl x).
Proof. apply rnd_number; auto with typeclass_instances. Qed.
Lemma fl_any x : Rabs (fl x - x) <= u * Rabs x + eta.
Proof.
  pose proof (error_any _ _ _ _ _ (rounding_error_nearest 53 (-1074) ltac:(lia)) x). pose proof (eta_positive (-1074)). lra.
Qed.
(** fl x for |x| <= m. *)
Lemma fl_within x m : Rabs x <= m -> Rabs (fl x - x) <= u * m + eta /\ Rabs (fl x) <= m + u * m + eta.
Proof.
  intros H. pose proof (fl_any x) as F. pose proof u_small. assert (u * Rabs x <= u * m) by (apply Rmult_le_compat_l; lra).
  split; [lra |]. replace (fl x) with (fl x - x + x) by ring. eapply Rle_trans; [apply Rabs_triang |]. lra.
Qed.
Lemma product_within x y A B : Rabs x <= A -> Rabs y <= B -> Rabs (x * y) <= A * B.
Proof. intros X Y. rewrite Rabs_mult. apply Rmult_le_compat; auto using Rabs_pos. Qed.

(** features::features: a coordinate minus the origin's, times a power of two. It is exact or, below normal numbers,
    has an error of eta. *)
Theorem scaled_near q o k m : double q -> double o -> 0 < k -> let s := fl (k * fl (q - o)) in
  Rabs (s - k * fl (q - o)) <= eta -> Rabs s <= m -> Rabs (s - k * (q - o)) <= u * m + 2 * (u * (u * m)) + 3 * eta.
Proof.
  intros Q O K s H M. pose proof u_small as U. pose proof (eta_positive (-1074)) as E.
  pose proof (sum_error 53 (-1074) nearest _ _ (rounding_error_nearest 53 (-1074) ltac:(lia)) q (- o) Q
    ltac:(now apply number_opp)) as R. change (q + - o) with (q - o) in R. set (d := fl (q - o)) in *.
  assert (Rk : Rabs (k * d - k * (q - o)) <= u * Rabs (k * (q - o))).
  { rewrite <- Rmult_minus_distr_l, !Rabs_mult, (Rabs_pos_eq k) by lra.
    replace (u * (k * Rabs (q - o))) with (k * (u * Rabs (q - o))) by ring. apply Rmult_le_compat_l; lra. }
  set (X := k * (q - o)) in *. set (Y := k * d) in *.
  assert (B : Rabs X <= m + eta + u * Rabs X).
  { replace X with (s + - (s - Y) + - (Y - X)) at 1 by ring.
    eapply Rle_trans; [apply Rabs_triang |]. rewrite Rabs_Ropp. pose proof (Rabs_triang s (- (s - Y))) as T.
    rewrite Rabs_Ropp in T. lra. }
  assert (M0 : 0 <= m) by (pose proof (Rabs_pos s); lra).
  assert (B2 : u * Rabs X <= u * m + 2 * (u * (u * m)) + 2 * eta).
  { assert (Q1 : Rabs X * (1 - u) <= m + eta) by lra.
    assert (Q2 : Rabs X <= (m + eta) * (1 + 2 * u)).
    { apply Rmult_le_reg_r with (1 - u); [lra |]. apply Rle_trans with (1 := Q1).
      assert (0 <= (m + eta) * u * (1 - 2 * u)) by (apply Rmult_le_pos; [apply Rmult_le_pos |]; lra). lra. }
    apply (Rmult_le_compat_l u) in Q2; [| lra].
    assert (u * eta <= / 4 * eta) by (apply Rmult_le_compat_r; lra).
    assert (0 <= u * eta) by (apply Rmult_le_pos; lra).
    assert (u * (u * eta) <= / 4 * eta) by (apply Rle_trans with (1 * (u * eta)); [apply Rmult_le_compat_r; lra | lra]). lra. }
  replace (s - X) with (s - Y + (Y - X)) by ring. eapply Rle_trans; [apply Rabs_triang |]. lra.
Qed.

Section Filter.

(** The largest sizes of scaled coordinates. Their sum is at least 1, except in scenes below 2^-1000. *)
Context (mx my mz : R) (mx_0 : 0 <= mx) (my_0 : 0 <= my) (mz_0 : 0 <= mz).
Let S : R := mx + my + mz.
Hypothesis not_tiny : bpow radix2 (-900) <= S.

Lemma eta_little : 0 < eta <= / 4096 * (u * S).
Proof.
  split; [apply eta_positive |]. apply Rle_trans with (/ 4096 * (u * bpow radix2 (-900))).
  - unfold Format.eta, Format.u. replace (/ 4096) with (bpow radix2 (-12)) by (simpl; lra). rewrite <- !bpow_plus. apply bpow_le. lia.
  - pose proof u_small. repeat (apply Rmult_le_compat_l; [lra |]). exact not_tiny.
Qed.

(** A point in doubles and its exact position: scaled_near on each axis. *)
Definition off (m s t : R) : Prop := Rabs s <= m /\ Rabs (s - t) <= u * m + 2 * (u * (u * m)) + 3 * eta.
Definition near_point (s t : point) : Prop := off mx (x s) (x t) /\ off my (y s) (y t) /\ off mz (z s) (z t).

Context (a : point) (axis_length : norm a <= 1 + 8 * u).
Lemma axis_component : Rabs (x a) <= 1025 / 1024 /\ Rabs (y a) <= 1025 / 1024 /\ Rabs (z a) <= 1025 / 1024.
Proof.
  pose proof u_small. assert (L : norm a <= 1025 / 1024) by lra. pose proof (norm_nonnegative a) as N.
  pose proof (norm_square a) as Q. unfold dot in Q.
  assert (C : forall c, c * c <= norm a * norm a -> Rabs c <= 1025 / 1024).
  { intros c Hc. apply Rle_trans with (2 := L). apply Rsqr_le_abs_0 in Hc. rewrite (Rabs_pos_eq (norm a)) in Hc; auto. }
  repeat split; apply C; rewrite Q; nra.
Qed.
(** dot *)
Definition projected (s : point) : R := fl (fl (fl (x a * x s) + fl (y a * y s)) + fl (z a * z s)).

Ltac distribute := rewrite ?Rmult_plus_distr_l in *.
Theorem projection_near s t : near_point s t ->
  Rabs (projected s - dot a t) <= 405 / 100 * (u * S) /\ Rabs (projected s) <= 101 / 100 * S.
Proof.
  intros ((Sx & Ox) & (Sy & Oy) & (Sz & Oz)). pose proof u_small as U. pose proof eta_little as E.
  unfold projected. destruct axis_component as (Ax & Ay & Az). pose proof (product_within _ _ _ _ Ax Sx) as Px.
  pose proof (product_within _ _ _ _ Ay Sy) as Py. pose proof (product_within _ _ _ _ Az Sz) as Pz.
  assert (S0 : 0 <= S) by (unfold S; lra). assert (Us : u * S <= / 1048576 * S) by (apply Rmult_le_compat_r; lra).
  assert (Uu : forall m, 0 <= m -> u * (u * m) <= / 1048576 * (u * m)).
  { intros m M. apply Rmult_le_compat_r; [apply Rmult_le_pos; lra | lra]. }
  pose proof (Uu mx mx_0). pose proof (Uu my my_0). pose proof (Uu mz mz_0).
  destruct (fl_within _ _ Px) as (Rx & Bx). destruct (fl_within _ _ Py) as (Ry & By). destruct (fl_within _ _ Pz) as (Rz & Bz).
  set (px := fl (x a * x s)) in *. set (py := fl (y a * y s)) in *. set (pz := fl (z a * z s)) in *.
  assert (Small : forall m, 0 <= m -> u * m <= / 1048576 * m) by (intros m M; apply Rmult_le_compat_r; lra).
  pose proof (Small mx mx_0). pose proof (Small my my_0). pose proof (Small mz mz_0).
  assert (Bx' : Rabs px <= 1002 / 1000 * mx + eta) by lra. assert (By' : Rabs py <= 1002 / 1000 * my + eta) by lra.
  assert (B1 : Rabs (px + py) <= 1002 / 1000 * (mx + my) + 2 * eta) by (pose proof (Rabs_triang px py); lra).
  destruct (fl_within _ _ B1) as (R1 & C1). set (q := fl (px + py)) in *.
  assert (Ue : 0 <= u * eta <= / 1048576 * eta) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; lra).
  assert (B2 : Rabs (q + pz) <= 1004 / 1000 * S + 5 * eta) by (pose proof (Rabs_triang q pz); unfold S; lra).
  destruct (fl_within _ _ B2) as (R2 & C2). set (P := fl (q + pz)) in *.
  split; [| assert (Rabs P <= 1004 / 1000 * S + 5 * eta + (u * (1004 / 1000 * S + 5 * eta) + eta)) by lra; lra].
  pose proof (product_within _ _ _ _ Ax Ox) as Dx. pose proof (product_within _ _ _ _ Ay Oy) as Dy.
  pose proof (product_within _ _ _ _ Az Oz) as Dz.
  assert (Eq : P - dot a t = (P - (q + pz)) + (q - (px + py)) + (px - x a * x s) + (py - y a * y s) + (pz - z a * z s) +
    x a * (x s - x t) + y a * (y s - y t) + z a * (z s - z t)) by (unfold dot; ring).
  rewrite Eq. apply Rabs_le_inv in R1, R2, Rx, Ry, Rz, Dx, Dy, Dz. apply Rabs_le.
  distribute. unfold S in *. distribute. split; lra.
Qed.

(** at(i), if 1 - t is a double. *)
Definition at_time (s e : point) (t : R) : R := fl (fl ((1 - t) * projected s) + fl (t * projected e)).
Lemma at_time_near s e p0 p1 t : near_point s p0 -> near_point e p1 -> 0 <= t <= 1 ->
  Rabs (at_time s e t - ((1 - t) * dot a p0 + t * dot a p1)) <= 61 / 10 * (u * S) /\ Rabs (at_time s e t) <= 102 / 100 * S.
Proof.
  intros N0 N1 T. pose proof u_small as U. pose proof eta_little as E.
  destruct (projection_near _ _ N0) as (D0 & B0). destruct (projection_near _ _ N1) as (D1 & B1). unfold at_time.
  set (P0 := projected s) in *. set (P1 := projected e) in *. assert (S0 : 0 <= S) by (unfold S; lra).
  assert (Us : u * S <= / 1048576 * S) by (apply Rmult_le_compat_r; lra). assert (Us0 : 0 <= u * S) by (apply Rmult_le_pos; lra).
  assert (Uus : u * (u * S) <= / 1048576 * (u * S)) by (apply Rmult_le_compat_r; lra).
  assert (A0 : Rabs ((1 - t) * P0) <= (1 - t) * (101 / 100 * S)).
  { rewrite Rabs_mult, (Rabs_pos_eq (1 - t)) by lra. apply Rmult_le_compat_l; lra. }
  assert (A1 : Rabs (t * P1) <= t * (101 / 100 * S)).
  { rewrite Rabs_mult, (Rabs_pos_eq t) by lra. apply Rmult_le_compat_l; lra. }
  destruct (fl_within _ _ A0) as (R0 & F0). destruct (fl_within _ _ A1) as (R1 & F1).
  set (q0 := fl ((1 - t) * P0)) in *. set (q1 := fl (t * P1)) in *.
  assert (Sum : Rabs (q0 + q1) <= 101 / 100 * S + 101 / 100 * (u * S) + 2 * eta).
  { pose proof (Rabs_triang q0 q1). lra. }
  destruct (fl_within _ _ Sum) as (R2 & F2). set (r := fl (q0 + q1)) in *.
  assert (Ue : 0 <= u * eta <= / 1048576 * eta) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; lra). distribute.
  split; [| lra]. replace (r - _) with ((r - (q0 + q1)) + (q0 - (1 - t) * P0) + (q1 - t * P1) +
    ((1 - t) * (P0 - dot a p0) + t * (P1 - dot a p1))) by ring.
  assert (M0 : Rabs ((1 - t) * (P0 - dot a p0)) <= (1 - t) * (405 / 100 * (u * S))).
  { rewrite Rabs_mult, (Rabs_pos_eq (1 - t)) by lra. apply Rmult_le_compat_l; lra. }
  assert (M1 : Rabs (t * (P1 - dot a p1)) <= t * (405 / 100 * (u * S))).
  { rewrite Rabs_mult, (Rabs_pos_eq t) by lra. apply Rmult_le_compat_l; lra. }
  apply Rabs_le_inv in R0, R1, R2, M0, M1. apply Rabs_le. split; lra.
Qed.

(** above_, for a distance D in scaled units; `sum` and `size` are rounded. *)
Context (D sum size : R) (D_0 : 0 <= D) (sum_near : D * (1 - 2 * u) - eta <= sum) (sum_0 : 0 <= sum)
  (size_near : S * (1 - 4 * u) <= size).
Definition above : R := fl (fl (fl (sum * (1 + 48 * u)) + fl (20 * u * size)) + bpow radix2 (-500)).
Lemma above_enough : D * (1 + 8 * u) + 15 * (u * S) <= above.
Proof.
  pose proof u_small as U. pose proof eta_little as E. assert (S0 : 0 <= S) by (unfold S; lra).
  assert (Us0 : 0 <= u * S) by (apply Rmult_le_pos; lra).
  assert (Uus : 0 <= u * (u * S) <= / 1048576 * (u * S)) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; lra).
  assert (Low : forall q, 0 <= q -> q * (1 - u) - eta <= fl q).
  { intros q Q. pose proof (fl_any q) as F. rewrite (Rabs_pos_eq q) in F by auto. apply Rabs_le_inv in F. lra. }
  assert (Pos : forall q, 0 <= q -> 0 <= fl q) by (intros q Q; apply rnd_nonnegative; auto with typeclass_instances).
  assert (Z0 : 0 <= size) by (apply Rle_trans with (2 := size_near); apply Rmult_le_pos; lra).
  assert (Q1 : 0 <= sum * (1 + 48 * u)) by (apply Rmult_le_pos; lra).
  assert (Q2 : 0 <= 20 * u * size) by (apply Rmult_le_pos; lra).
  pose proof (Low _ Q1) as L1. pose proof (Low _ Q2) as L2. pose proof (Pos _ Q1) as P1. pose proof (Pos _ Q2) as P2.
  unfold above. set (a1 := fl (sum * (1 + 48 * u))) in *. set (a2 := fl (20 * u * size)) in *.
  pose proof (Low (a1 + a2) ltac:(lra)) as L3. pose proof (Pos (a1 + a2) ltac:(lra)) as P3. set (a3 := fl (a1 + a2)) in *.
  pose proof (bpow_gt_0 radix2 (-500)) as T. pose proof (Low (a3 + bpow radix2 (-500)) ltac:(lra)) as L4.
  apply Rle_trans with (2 := L4).
  assert (B2 : 199 / 10 * (u * S) - eta <= a2).
  { assert (20 * u * (S * (1 - 4 * u)) <= 20 * u * size) by (apply Rmult_le_compat_l; lra).
    assert (20 * u * (S * (1 - 4 * u)) * (1 - u) <= 20 * u * size * (1 - u)) by (apply Rmult_le_compat_r; lra).
    assert (199 / 10 * (u * S) <= 20 * u * (S * (1 - 4 * u)) * (1 - u)); [| lra].
    replace (20 * u * (S * (1 - 4 * u)) * (1 - u)) with (20 * (u * S) - 100 * (u * (u * S)) + 80 * (u * (u * (u * S)))) by ring.
    assert (0 <= u * (u * (u * S))) by (apply Rmult_le_pos; lra). lra. }
  assert (B1 : D * (1 + 40 * u) - 3 * eta <= a1).
  { assert (H : (D * (1 - 2 * u) - eta) * ((1 + 48 * u) * (1 - u)) <= sum * ((1 + 48 * u) * (1 - u))).
    { apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra. }
    assert (F : 1 + 40 * u <= (1 - 2 * u) * ((1 + 48 * u) * (1 - u))) by nra.
    apply (Rmult_le_compat_l D) in F; auto. assert (G : (1 + 48 * u) * (1 - u) <= 2) by nra.
    apply (Rmult_le_compat_l eta) in G; lra. }
  assert (B3 : D * (1 + 30 * u) + 19 * (u * S) <= a3).
  { apply Rle_trans with ((a1 + a2) * (1 - u) - eta); auto.
    assert ((D * (1 + 40 * u) - 3 * eta + (199 / 10 * (u * S) - eta)) * (1 - u) <= (a1 + a2) * (1 - u))
      by (apply Rmult_le_compat_r; lra).
    assert (F : 1 + 30 * u <= (1 + 40 * u) * (1 - u)) by nra. apply (Rmult_le_compat_l D) in F; auto.
    assert (0 <= u * eta) by (apply Rmult_le_pos; lra). lra. }
  assert ((D * (1 + 30 * u) + 19 * (u * S)) * (1 - u) <= (a3 + bpow radix2 (-500)) * (1 - u)) by (apply Rmult_le_compat_r; lra).
  assert (F : 1 + 8 * u <= (1 + 30 * u) * (1 - u)) by nra. apply (Rmult_le_compat_l D) in F; auto. lra.
Qed.

(** A pair of points at one time, with a gap that exceeds above_. *)
Theorem separated_right s0 s1 r0 r1 p0 p1 q0 q1 t : near_point s0 p0 -> near_point s1 p1 -> near_point r0 q0 ->
  near_point r1 q1 -> 0 <= t <= 1 -> above < fl (at_time r0 r1 t - at_time s0 s1 t) ->
  D * norm a < dot a (minus (along q0 t (minus q1 q0)) (along p0 t (minus p1 p0))).
Proof.
  intros N0 N1 M0 M1 T H. pose proof u_small as U. pose proof eta_little as E. pose proof above_enough as A.
  destruct (at_time_near _ _ _ _ t N0 N1 T) as (Dp & Bp). destruct (at_time_near _ _ _ _ t M0 M1 T) as (Dq & Bq).
  set (P := at_time s0 s1 t) in *. set (Q := at_time r0 r1 t) in *.
  assert (S0 : 0 <= S) by (unfold S; lra). assert (Us0 : 0 <= u * S) by (apply Rmult_le_pos; lra).
  assert (B : Rabs (Q - P) <= 204 / 100 * S).
  { pose proof (Rabs_triang Q (- P)) as Tr. rewrite Rabs_Ropp in Tr. change (Q + - P) with (Q - P) in Tr. lra. }
  destruct (fl_within _ _ B) as (R1 & _).
  replace (dot a _) with ((1 - t) * dot a q0 + t * dot a q1 - ((1 - t) * dot a p0 + t * dot a p1))
    by (coordinates; ring).
  assert (L : D * norm a <= D * (1 + 8 * u)) by (apply Rmult_le_compat_l; auto).
  apply Rabs_le_inv in Dp, Dq, R1. lra.
Qed.

(** A point in the code at both ends of the step, and its exact position. *)
Record tracked := Tracked { at_start : point; at_end : point; path : moving }.
Definition right (m : tracked) : Prop := near_point (at_start m) (start (path m)) /\ near_point (at_end m) (finish (path m)).
Definition at_ (t : R) (m : tracked) : R := at_time (at_start m) (at_end m) t.
(** gap: the minimum of one feature minus the maximum of the other. *)
Definition gap (p : tracked) (ps : list tracked) (q : tracked) (qs : list tracked) (t : R) : R :=
  fl (fold_left Rmin (map (at_ t) qs) (at_ t q) - fold_left Rmax (map (at_ t) ps) (at_ t p)).
Definition part_of (low high : R) (m : tracked) : moving := Moving (place (path m) low) (place (path m) high).

Lemma gap_of_pair p ps q qs t m n : In m (p :: ps) -> In n (q :: qs) -> gap p ps q qs t <= fl (at_ t n - at_ t m).
Proof.
  intros M N. apply (in_map (at_ t)) in M, N. unfold gap. apply rnd_le; auto with typeclass_instances.
  apply Rplus_le_compat; [| apply Ropp_le_contravar].
  - revert N. apply (RoundedAxes.fold_beyond Rmin (fun r e => r <= e)); intros; cbv beta; unfold Rmin; try destruct Rle_dec; lra.
  - revert M. apply (RoundedAxes.fold_beyond Rmax (fun r e => e <= r)); intros; cbv beta; unfold Rmax; try destruct Rle_dec; lra.
Qed.
Theorem separated_part p ps q qs low high : Forall right (p :: ps) -> Forall right (q :: qs) -> 0 <= low <= 1 -> 0 <= high <= 1 ->
  above < gap p ps q qs low -> above < gap p ps q qs high ->
  above_along a D (map (part_of low high) (q :: qs)) (map (part_of low high) (p :: ps)).
Proof.
  intros Fp Fq L H Gl Gh m' n' M N. apply in_map_iff in M, N. destruct M as (m & <- & M), N as (n & <- & N).
  rewrite Forall_forall in Fp, Fq. destruct (Fq m M) as (M0 & M1), (Fp n N) as (N0 & N1).
  assert (At : forall t, 0 <= t <= 1 -> above < gap p ps q qs t ->
    D * norm a < dot a (minus (place (path m) t) (place (path n) t))).
  { intros t T G. pose proof (gap_of_pair p ps q qs t n m N M) as P.
    pose proof (separated_right _ _ _ _ _ _ _ _ t N0 N1 M0 M1 T (Rlt_le_trans _ _ _ G P)) as Q.
    eapply Rlt_le_trans; [exact Q |]. right. unfold place. coordinates. ring. }
  split; now apply At.
Qed.

End Filter.

(** ** The operands *)

(** decide: the vector between two points, divided by its rounded length. *)
Definition length_of (b : point) : R := fl (sqrt (fl (fl (fl (x b * x b) + fl (y b * y b)) + fl (z b * z b)))).
Definition axis_of (b : point) : point :=
  let r := fl (1 / length_of b) in Point (fl (r * x b)) (fl (r * y b)) (fl (r * z b)).
Lemma norm_sum v p q r : Rabs (x v) <= p -> Rabs (y v) <= q -> Rabs (z v) <= r -> dot v v <= p * p + q * q + r * r.
Proof.
  assert (Sq : forall c m, Rabs c <= m -> c * c <= m * m).
  { intros c m H. pose proof (Rabs_pos c). replace (c * c) with (Rabs c * Rabs c) by (rewrite <- Rabs_mult; apply Rabs_pos_eq; nra).
    apply Rmult_le_compat; lra. }
  intros P Q W. unfold dot. pose proof (Sq _ _ P). pose proof (Sq _ _ Q). pose proof (Sq _ _ W). lra.
Qed.
(** |b|² is slightly more than the rounded square. *)
Lemma square_rounded b : let q := fl (fl (fl (x b * x b) + fl (y b * y b)) + fl (z b * z b)) in
  bpow radix2 (-1010) <= q -> dot b b <= q * (1 + 4 * u).
Proof.
  intros q Q. pose proof u_small as U.
  assert (E : eta <= / 1024 * (u * q)).
  { apply Rle_trans with (/ 1024 * (u * bpow radix2 (-1010))).
    - unfold Format.eta, Format.u. replace (/ 1024) with (bpow radix2 (-10)) by (simpl; lra). rewrite <- !bpow_plus. apply bpow_le. lia.
    - repeat (apply Rmult_le_compat_l; [lra |]). exact Q. }
  pose proof (eta_positive (-1074)) as E0.
  assert (Low : forall v, 0 <= v -> v * (1 - u) - eta <= fl v /\ 0 <= fl v).
  { intros v V. pose proof (fl_any v) as F. rewrite (Rabs_pos_eq v) in F by auto. apply Rabs_le_inv in F.
    split; [lra | apply rnd_nonnegative; auto with typeclass_instances]. }
  assert (Sq : forall c, 0 <= c * c) by (intros; nra).
  destruct (Low _ (Sq (x b))) as (L0 & P0). destruct (Low _ (Sq (y b))) as (L1 & P1). destruct (Low _ (Sq (z b))) as (L2 & P2).
  unfold q in *. set (s0 := fl (x b * x b)) in *. set (s1 := fl (y b * y b)) in *. set (s2 := fl (z b * z b)) in *.
  destruct (Low (s0 + s1) ltac:(lra)) as (L3 & P3). set (s3 := fl (s0 + s1)) in *.
  destruct (Low (s3 + s2) ltac:(lra)) as (L4 & P4). set (s4 := fl (s3 + s2)) in *. unfold dot.
  set (X := x b * x b) in *. set (Y := y b * y b) in *. set (Z := z b * z b) in *.
  pose proof (Sq (x b)) as X0. pose proof (Sq (y b)) as Y0. pose proof (Sq (z b)) as Z0. fold X in X0. fold Y in Y0. fold Z in Z0. clearbody X Y Z.
  assert (W : 0 <= 1 - u) by lra.
  assert (B1 : (X + Y) * (1 - u) - 2 * eta <= s0 + s1) by lra.
  assert (B2 : (X + Y) * (1 - u) * (1 - u) - 3 * eta <= s3).
  { apply (Rmult_le_compat_r (1 - u)) in B1; auto. assert (0 <= u * eta) by (apply Rmult_le_pos; lra). lra. }
  assert (B3 : (X + Y + Z) * (1 - u) * (1 - u) - 4 * eta <= s3 + s2).
  { assert (0 <= Z * (1 - u) * u) by (repeat apply Rmult_le_pos; lra). lra. }
  assert (B4 : (X + Y + Z) * (1 - u) * (1 - u) * (1 - u) <= s4 * (1 + / 128 * u)).
  { apply (Rmult_le_compat_r (1 - u)) in B3; auto. assert (0 <= u * eta) by (apply Rmult_le_pos; lra). lra. }
  apply Rmult_le_reg_r with ((1 - u) * (1 - u) * (1 - u)); [repeat apply Rmult_lt_0_compat; lra |].
  replace ((X + Y + Z) * ((1 - u) * (1 - u) * (1 - u))) with ((X + Y + Z) * (1 - u) * (1 - u) * (1 - u)) by ring.
  apply Rle_trans with (1 := B4). rewrite Rmult_assoc. apply Rmult_le_compat_l; auto.
  assert (C : 1 - 3 * u <= (1 - u) * (1 - u) * (1 - u)).
  { assert (0 <= u * u * (3 - u)) by (repeat apply Rmult_le_pos; lra). lra. }
  apply (Rmult_le_compat_l (1 + 4 * u)) in C; [| lra]. assert (u * u <= / 1048576 * u) by (apply Rmult_le_compat_r; lra). lra.
Qed.
Theorem axis_length b : bpow radix2 (-500) < length_of b -> length_of b <= bpow radix2 400 -> norm (axis_of b) <= 1 + 8 * u.
Proof.
  intros L H. pose proof u_small as U. pose proof (eta_positive (-1074)) as E0. unfold axis_of.
  set (q := fl (fl (fl (x b * x b) + fl (y b * y b)) + fl (z b * z b))) in *.
  assert (Ed : length_of b = fl (sqrt q)) by easy. set (d := length_of b) in *.
  pose proof (bpow_gt_0 radix2 (-500)) as T. pose proof (sqrt_pos q) as Sq0.
  pose proof (fl_any (sqrt q)) as Fd. rewrite <- Ed, (Rabs_pos_eq (sqrt q)) in Fd by auto. apply Rabs_le_inv in Fd.
  assert (Et : eta <= / 4 * bpow radix2 (-500)).
  { change (/ 4) with (bpow radix2 (-2)). rewrite <- bpow_plus. unfold Format.eta. apply bpow_le. lia. }
  assert (Sq1 : / 2 * bpow radix2 (-500) <= sqrt q) by nra.
  assert (Q0 : 0 < q).
  { apply Rnot_le_lt. intros N. rewrite sqrt_neg_0 in Sq1 by auto. lra. }
  assert (Qs : q = sqrt q * sqrt q) by (symmetry; apply sqrt_sqrt; lra).
  assert (Q : bpow radix2 (-1010) <= q).
  { rewrite Qs. apply Rle_trans with (/ 2 * bpow radix2 (-500) * (/ 2 * bpow radix2 (-500))).
    - change (/ 2) with (bpow radix2 (-1)). rewrite <- !bpow_plus. apply bpow_le. lia.
    - apply Rmult_le_compat; lra. }
  pose proof (square_rounded b Q) as Sb. fold q in Sb.
  assert (Nb : norm b <= sqrt q * (1 + 2 * u)).
  { apply norm_below; [apply Rmult_le_pos; lra |]. apply Rle_trans with (1 := Sb). rewrite Qs at 1.
    assert (0 <= sqrt q * sqrt q * (u * u)) by (repeat apply Rmult_le_pos; lra). lra. }
  (* the quotients *)
  assert (Es : eta <= / 1024 * (u * sqrt q)).
  { apply Rle_trans with (/ 1024 * (u * (/ 2 * bpow radix2 (-500)))); [| repeat (apply Rmult_le_compat_l; [lra |]); exact Sq1].
    unfold Format.eta, Format.u. replace (/ 1024) with (bpow radix2 (-10)) by (simpl; lra). change (/ 2) with (bpow radix2 (-1)).
    rewrite <- !bpow_plus. apply bpow_le. lia. }
  assert (Dd : sqrt q * (1 - 2 * u) <= d) by lra. assert (D0 : 0 < d) by lra.
  assert (I0 : 0 < 1 / d) by (apply Rdiv_lt_0_compat; lra).
  assert (Il : bpow radix2 (-400) <= 1 / d).
  { change (-400)%Z with (- (400))%Z. rewrite bpow_opp. unfold Rdiv. rewrite Rmult_1_l. apply Rinv_le; auto. }
  assert (Ei : eta <= / 1024 * (u * (1 / d))).
  { apply Rle_trans with (/ 1024 * (u * bpow radix2 (-400))); [| repeat (apply Rmult_le_compat_l; [lra |]); exact Il].
    unfold Format.eta, Format.u. replace (/ 1024) with (bpow radix2 (-10)) by (simpl; lra). rewrite <- !bpow_plus. apply bpow_le. lia. }
  pose proof (fl_any (1 / d)) as Fr. rewrite (Rabs_pos_eq (1 / d)) in Fr by lra. apply Rabs_le_inv in Fr. set (r := fl (1 / d)) in *.
  assert (Ru : 0 <= r <= 1 / d * (1 + 1001 / 1000 * u)).
  { assert (u * (1 / d) <= / 1048576 * (1 / d)) by (apply Rmult_le_compat_r; lra). lra. }
  assert (Rb : r * norm b <= 1 + 53 / 10 * u).
  { apply Rle_trans with (1 / d * (1 + 1001 / 1000 * u) * (sqrt q * (1 + 2 * u))).
    - apply Rmult_le_compat; try lra. apply norm_nonnegative.
    - apply Rmult_le_reg_l with d; auto.
      replace (d * (1 / d * (1 + 1001 / 1000 * u) * (sqrt q * (1 + 2 * u)))) with
        (sqrt q * ((1 + 1001 / 1000 * u) * (1 + 2 * u))) by (field; lra).
      assert (F : (1 + 1001 / 1000 * u) * (1 + 2 * u) <= (1 - 2 * u) * (1 + 53 / 10 * u)).
      { assert (u * u <= / 1048576 * u) by (apply Rmult_le_compat_r; lra). lra. }
      apply (Rmult_le_compat_l (sqrt q)) in F; [| lra].
      apply Rle_trans with (1 := F). rewrite <- Rmult_assoc. apply Rmult_le_compat_r; lra. }
  (* a product's error is u of it and eta *)
  pose proof (norm_nonnegative b) as Nb0. set (n := r * norm b) in *.
  assert (N0 : 0 <= n) by (apply Rmult_le_pos; lra).
  assert (C : forall c, Rabs (fl (r * c)) <= (1 + u) * r * Rabs c + eta).
  { intros c. pose proof (fl_any (r * c)) as F. rewrite Rabs_mult, (Rabs_pos_eq r) in F by lra.
    replace (fl (r * c)) with (fl (r * c) - r * c + r * c) by ring. eapply Rle_trans; [apply Rabs_triang |].
    rewrite Rabs_mult, (Rabs_pos_eq r) by lra. lra. }
  apply norm_below; [lra |].
  eapply Rle_trans; [apply norm_sum; cbn [x y z]; apply C |].
  assert (Abs : forall c, Rabs c * Rabs c = c * c) by (intros; rewrite <- Rabs_mult; apply Rabs_pos_eq; nra).
  assert (Cm : forall c, c * c <= norm b * norm b -> r * Rabs c <= n).
  { intros c Hc. apply Rmult_le_compat_l; [lra |]. apply Rsqr_le_abs_0 in Hc. now rewrite (Rabs_pos_eq (norm b)) in Hc. }
  pose proof (norm_square b) as Nq. unfold dot in Nq.
  assert (Cx : r * Rabs (x b) <= n) by (apply Cm; rewrite Nq; nra).
  assert (Cy : r * Rabs (y b) <= n) by (apply Cm; rewrite Nq; nra).
  assert (Cz : r * Rabs (z b) <= n) by (apply Cm; rewrite Nq; nra).
  assert (Eu : eta <= / 1024 * u).
  { unfold Format.eta, Format.u. replace (/ 1024) with (bpow radix2 (-10)) by (simpl; lra). rewrite <- bpow_plus. apply bpow_le. lia. }
  assert (Expand : forall c, r * Rabs c <= n -> ((1 + u) * r * Rabs c + eta) * ((1 + u) * r * Rabs c + eta) <=
    (1 + u) * (1 + u) * (r * r * (c * c)) + 5 * eta).
  { intros c Hc. rewrite <- (Abs c). assert (r0 : 0 <= r * Rabs c) by (apply Rmult_le_pos; [lra | apply Rabs_pos]).
    set (w := r * Rabs c) in *. replace ((1 + u) * r * Rabs c) with ((1 + u) * w) by (unfold w; ring).
    replace (r * r * (Rabs c * Rabs c)) with (w * w) by (unfold w; ring).
    assert (w <= 2) by lra. assert (eta * w <= eta * 2) by (apply Rmult_le_compat_l; lra).
    assert (0 <= eta * w) by (apply Rmult_le_pos; lra). assert (u * (eta * w) <= / 4 * eta).
    { apply Rle_trans with (/ 1048576 * (eta * w)); [apply Rmult_le_compat_r |]; lra. }
    assert (eta * eta <= / 4 * eta) by (apply Rmult_le_compat_r; lra). lra. }
  pose proof (Expand _ Cx). pose proof (Expand _ Cy). pose proof (Expand _ Cz).
  assert (Nn : r * r * (x b * x b) + r * r * (y b * y b) + r * r * (z b * z b) = n * n)
    by (unfold n; replace (r * norm b * (r * norm b)) with (r * r * (norm b * norm b)) by ring; rewrite Nq; ring).
  assert (Last : (1 + u) * (1 + u) * (n * n) + 15 * eta <= (1 + 8 * u) * (1 + 8 * u)).
  { assert (n * n <= (1 + 53 / 10 * u) * (1 + 53 / 10 * u)) by (apply Rmult_le_compat; lra).
    assert (N4 : (1 + u) * (1 + u) * (n * n) <= (1 + u) * (1 + u) * ((1 + 53 / 10 * u) * (1 + 53 / 10 * u)))
      by (apply Rmult_le_compat_l; [apply Rmult_le_pos |]; lra).
    assert (U2 : 0 <= u * u <= / 1048576 * u) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; lra).
    assert (U3 : 0 <= u * (u * u) <= 1 * (u * u)) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; lra).
    assert (U4 : u * (u * (u * u)) <= 1 * (u * (u * u))) by (apply Rmult_le_compat_r; lra).
    clear - N4 U2 U3 U4 Eu U. lra. }
  assert (All : (1 + u) * (1 + u) * (r * r * (x b * x b)) + (1 + u) * (1 + u) * (r * r * (y b * y b)) +
    (1 + u) * (1 + u) * (r * r * (z b * z b)) = (1 + u) * (1 + u) * (n * n)) by (rewrite <- Nn; ring).
  lra.
Qed.

(** sum, for the distance D = k (d0 + d1). *)
Theorem distance_rounded k d0 d1 : 0 < k -> double d0 -> double d1 -> 0 <= d0 -> 0 <= d1 ->
  k * (d0 + d1) * (1 - 2 * u) - eta <= fl (k * fl (d0 + d1)).
Proof.
  intros K N0 N1 D0 D1. pose proof u_small as U.
  pose proof (sum_error 53 (-1074) nearest _ _ (rounding_error_nearest 53 (-1074) ltac:(lia)) d0 d1 N0 N1) as R.
  rewrite (Rabs_pos_eq (d0 + d1)) in R by lra. apply Rabs_le_inv in R. set (s := fl (d0 + d1)) in *.
  assert (Ks : k * (d0 + d1) * (1 - u) <= k * s) by (rewrite Rmult_assoc; apply Rmult_le_compat_l; lra).
  assert (P : 0 <= k * (d0 + d1)) by (apply Rmult_le_pos; lra).
  assert (P0 : 0 <= k * (d0 + d1) * (1 - u)) by (apply Rmult_le_pos; lra).
  pose proof (fl_any (k * s)) as F. rewrite (Rabs_pos_eq (k * s)) in F by lra. apply Rabs_le_inv in F.
  assert (k * (d0 + d1) * (1 - u) * (1 - u) <= k * s * (1 - u)) by (apply Rmult_le_compat_r; lra).
  assert (0 <= k * (d0 + d1) * (u * u)) by (repeat apply Rmult_le_pos; lra). lra.
Qed.
(** size_, for the largest coordinates lx, ly, lz before scaling. *)
Theorem size_rounded k lx ly lz mx my mz : 0 < k -> double lx -> double ly -> double lz -> 0 <= lx -> 0 <= ly -> 0 <= lz ->
  mx <= k * lx + eta -> my <= k * ly + eta -> mz <= k * lz + eta -> bpow radix2 (-900) <= mx + my + mz ->
  (mx + my + mz) * (1 - 4 * u) <= fl (k * fl (fl (lx + ly) + lz)).
Proof.
  intros K Nx Ny Nz X Y Z Mx My Mz T. pose proof u_small as U. pose proof (eta_positive (-1074)) as E0.
  assert (E : eta <= / 4096 * (u * (mx + my + mz))).
  { apply Rle_trans with (/ 4096 * (u * bpow radix2 (-900))); [| repeat (apply Rmult_le_compat_l; [lra |]); exact T].
    unfold Format.eta, Format.u. replace (/ 4096) with (bpow radix2 (-12)) by (simpl; lra). rewrite <- !bpow_plus. apply bpow_le. lia. }
  assert (Low : forall v w, double v -> double w -> 0 <= v -> 0 <= w -> (v + w) * (1 - u) <= fl (v + w)).
  { intros v w V W V0 W0. pose proof (sum_error 53 (-1074) nearest _ _ (rounding_error_nearest 53 (-1074) ltac:(lia)) v w V W) as R.
    rewrite (Rabs_pos_eq (v + w)) in R by lra. apply Rabs_le_inv in R. lra. }
  pose proof (Low lx ly Nx Ny X Y) as L1. set (s := fl (lx + ly)) in *. assert (S0 : 0 <= s) by (assert (0 <= (lx + ly) * (1 - u)) by (apply Rmult_le_pos; lra); lra).
  pose proof (Low s lz (fl_number _) Nz S0 Z) as L2. set (w := fl (s + lz)) in *.
  set (L := lx + ly + lz). assert (L0 : 0 <= L) by (unfold L; lra).
  assert (W : L * (1 - 2 * u) <= w).
  { apply Rle_trans with (2 := L2). apply Rle_trans with (((lx + ly) * (1 - u) + lz) * (1 - u)); [| apply Rmult_le_compat_r; lra].
    assert (0 <= (lx + ly) * (u * u)) by (repeat apply Rmult_le_pos; lra). assert (0 <= lz * u) by (apply Rmult_le_pos; lra).
    unfold L. lra. }
  assert (Kw : k * L * (1 - 2 * u) <= k * w) by (rewrite Rmult_assoc; apply Rmult_le_compat_l; lra).
  assert (KL : 0 <= k * L) by (apply Rmult_le_pos; lra).
  assert (K0 : 0 <= k * L * (1 - 2 * u)) by (apply Rmult_le_pos; lra).
  pose proof (fl_any (k * w)) as F. rewrite (Rabs_pos_eq (k * w)) in F by lra. apply Rabs_le_inv in F.
  assert (F1 : k * L * (1 - 2 * u) * (1 - u) <= k * w * (1 - u)) by (apply Rmult_le_compat_r; lra).
  assert (F2 : k * L * (1 - 3 * u) <= k * L * (1 - 2 * u) * (1 - u)).
  { assert (0 <= k * L * (2 * (u * u))) by (apply Rmult_le_pos; [auto | nra]). lra. }
  assert (M : (mx + my + mz - 3 * eta) * (1 - 3 * u) <= k * L * (1 - 3 * u)) by (apply Rmult_le_compat_r; [lra | unfold L; lra]).
  assert (0 <= u * eta) by (apply Rmult_le_pos; lra). lra.
Qed.
