(** `separated_by_axes` of ccd/exact/static_filter/separating_axes.hpp: its margin covers the rounding errors of the
    compared numbers, including underflow. In double, any direction; the compiler computes the constant to nearest.
    Results:
        separated_face_separate, separated_edges_separate    features that an axis separates as computed, with sizes
            that
                                  cover the computed differences, do not collide *)

From Coq Require Import Reals ZArith List Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format Contact Decisions.
Import ListNotations.
Open Scope R_scope.

Notation p := 53%Z (only parsing).
Notation emin := (-1074)%Z (only parsing).
#[local] Instance double_precision : Prec_gt_0 p := eq_refl.

Section SeparatingAxis.

Context (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation fl := (rnd p emin direction).
Notation flc := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).

(** ** The code *)

Definition margin : R := flc (flc 9.2 * eps).

(** difference, at one end of the step *)
Definition difference_of (q p : point) : point := Point (fl (x q - x p)) (fl (y q - y p)) (fl (z q - z p)).

(** An axis: its computed projection of a difference, the axis itself, and the computed size. *)
Record axis := Axis { project : point -> R; along_axis : point; size : R }.
Definition coordinate_axes (mx my mz : R) : list axis :=
  [Axis x (Point 1 0 0) mx; Axis y (Point 0 1 0) my; Axis z (Point 0 0 1) mz].
Definition diagonal_axes (mx my mz : R) : list axis :=
  [Axis (fun d => fl (x d + y d)) (Point 1 1 0) (fl (mx + my));
   Axis (fun d => fl (x d - y d)) (Point 1 (-1) 0) (fl (mx + my));
   Axis (fun d => fl (y d + z d)) (Point 0 1 1) (fl (my + mz));
   Axis (fun d => fl (y d - z d)) (Point 0 1 (-1)) (fl (my + mz));
   Axis (fun d => fl (z d + x d)) (Point 1 0 1) (fl (mz + mx));
   Axis (fun d => fl (z d - x d)) (Point (-1) 0 1) (fl (mz + mx))].

(** The differences b, c and p at an end of the step: `false` is the start. *)
Record differences := Differences { b : bool -> point; c : bool -> point; p_ : bool -> point }.
Definition separated_along (sides : bool -> bool * bool) : bool :=
  (fst (sides false) && fst (sides true)) || (snd (sides false) && snd (sides true)).
Definition face_sides (d : differences) (a : axis) (finish : bool) : bool * bool :=
  let e := fl (size a * margin) in
  let b := project a (b d finish) in let c := project a (c d finish) in let v := project a (p_ d finish) in
  (Rlt_bool (fl (Rmax (Rmax b c) 0 + e)) v, Rlt_bool v (fl (Rmin (Rmin b c) 0 - e))).
Definition edge_sides (d : differences) (a : axis) (finish : bool) : bool * bool :=
  let e := fl (size a * margin) in
  let a1 := project a (b d finish) in let b0 := project a (p_ d finish) in
  let b1 := fl (b0 + project a (c d finish)) in
  (Rlt_bool (fl (Rmax a1 0 + e)) (Rmin b0 b1), Rlt_bool (Rmax b0 b1) (fl (Rmin a1 0 - e))).
Definition separated (sides : axis -> bool -> bool * bool) (axes : list axis) : bool :=
  existsb (fun a => separated_along (sides a)) axes.

(** ** Errors: zero, or at most a bound minus one smallest number *)

Definition near (bound r : R) : Prop := r = 0 \/ Rabs r <= bound - eta.
Lemma near_more a b r : a <= b -> near a r -> near b r.
Proof. intros L [-> | H]; [now left | right; lra]. Qed.
Lemma near_sum a b r s : 0 <= a -> 0 <= b -> near a r -> near b s -> near (a + b) (r + s).
Proof.
  generalize (eta_positive emin). intros P A B [-> | H] [-> | K].
  - left. ring.
  - right. rewrite Rplus_0_l. lra.
  - right. rewrite Rplus_0_r. lra.
  - right. apply Rle_trans with (1 := Rabs_triang r s). lra.
Qed.
Lemma near_opp a r : near a r -> near a (- r).
Proof. intros [-> | H]; [left; ring | right; now rewrite Rabs_Ropp]. Qed.
Lemma near_size a r : 0 <= a -> near a r -> Rabs r <= a.
Proof. generalize (eta_positive emin). intros P A [-> | H]; [rewrite Rabs_R0; lra | lra]. Qed.

Lemma multiple r : number r -> exists n, r = IZR n * eta.
Proof.
  intros N. apply generic_format_FIX_FLT in N. apply FIX_format_generic in N.
  destruct N as [[n e] E F]. simpl in F. exists n. rewrite E, F. reflexivity.
Qed.
Lemma number_fl r : number (fl r).
Proof. apply rnd_number; auto with typeclass_instances. Qed.

(** The error of a sum is a multiple of eta and less than an ulp, which is a multiple, too. *)
Lemma sum_near r s : number r -> number s -> near (eps * Rabs (r + s)) (fl (r + s) - (r + s)).
Proof.
  intros X Y. destruct (Rlt_or_le (Rabs (r + s)) (smallest_normal p emin)) as [S | S].
  { left. rewrite (sum_exact_below p emin direction r s X Y S). ring. }
  right. assert (N : r + s <> 0).
  { intros Z. rewrite Z, Rabs_R0 in S. generalize (smallest_normal_positive p emin). lra. }
  assert (L : Rabs (fl (r + s) - (r + s)) < ulp radix2 (FLT_exp emin p) (r + s)).
  { apply error_lt_ulp; auto with typeclass_instances. }
  assert (U : ulp radix2 (FLT_exp emin p) (r + s) <= Rabs (r + s) * eps).
  { apply ulp_FLT_le. exact S. }
  rewrite ulp_neq_0 in L, U by easy. unfold cexp, FLT_exp in L, U.
  set (e := Z.max (mag radix2 (r + s) - p) emin) in *.
  assert (G : bpow radix2 e = IZR (2 ^ (e - emin)) * eta).
  { unfold Format.eta. rewrite (IZR_Zpower radix2) by lia. rewrite <- bpow_plus. f_equal. lia. }
  destruct (multiple r X) as (a & A). destruct (multiple s Y) as (b & B).
  destruct (multiple (fl (r + s)) (number_fl _)) as (c & C).
  assert (E : fl (r + s) - (r + s) = IZR (c - a - b) * eta)
    by (rewrite C, A, B, !minus_IZR; ring).
  generalize (eta_positive emin). intros P. rewrite E, Rabs_mult, (Rabs_pos_eq eta) in * by lra.
  rewrite <- abs_IZR in *. rewrite G in L, U. apply Rmult_lt_reg_r in L; auto.
  apply lt_IZR in L. assert (M : (Z.abs (c - a - b) + 1 <= 2 ^ (e - emin))%Z) by lia.
  apply IZR_le in M. rewrite plus_IZR in M.
  assert ((IZR (Z.abs (c - a - b)) + 1) * eta <= IZR (2 ^ (e - emin)) * eta)
    by (apply Rmult_le_compat_r; lra). lra.
Qed.
Lemma difference_near r s : number r -> number s -> near (eps * Rabs (r - s)) (fl (r - s) - (r - s)).
Proof. intros X Y. apply (sum_near r (- s)); auto. now apply number_opp. Qed.

Lemma eps_tiny : 0 < eps <= / 1000000.
Proof.
  split; [apply bpow_gt_0 |]. apply Rle_trans with (bpow radix2 (- 20)); [apply bpow_le; lia |].
  simpl. lra.
Qed.
(** The error in terms of the result. *)
Lemma near_result r m : near (eps * Rabs r) (fl r - r) -> Rabs (fl r) <= m ->
  near (1.01 * eps * m) (fl r - r).
Proof.
  intros N L. generalize eps_tiny. intros P. apply near_more with (2 := N).
  apply near_size in N; [| apply Rmult_le_pos; [lra | apply Rabs_pos]].
  assert (Rabs r - Rabs (fl r) <= Rabs (fl r - r)).
  { rewrite (Rabs_minus_sym (fl r)). apply Rabs_triang_inv. }
  assert (eps * Rabs r <= / 1000000 * Rabs r) by (apply Rmult_le_compat_r; [apply Rabs_pos | lra]).
  pose proof (Rabs_pos (fl r)). apply Rle_trans with (eps * (1.01 * m)); [| lra].
  apply Rmult_le_compat_l; lra.
Qed.

(** ** The margin *)

Lemma nearest_error : rounding_error p emin nearest (u p) (eta / 2).
Proof. exact (rounding_error_nearest p emin ltac:(lia)). Qed.
Lemma any_error : rounding_error p emin direction eps eta.
Proof. exact (rounding_error_any p emin direction ltac:(lia)). Qed.

Lemma margin_bounds : 9.19 * eps <= margin <= 16 * eps.
Proof.
  generalize eps_tiny (eps_2u p) (u_positive p). intros P E2 U. unfold margin.
  assert (A : 9.2 * (1 - u p) <= flc 9.2).
  { apply (rnd_relative p emin nearest (u p) (eta / 2) nearest_error).
    apply Rle_trans with (bpow radix2 0); [apply bpow_le; lia | simpl; lra]. }
  assert (B : flc 9.2 <= 16).
  { apply rnd_below; auto with typeclass_instances; [| lra]. change 16 with (bpow radix2 4).
    apply number_power; [exact eq_refl | lia]. }
  split.
  - apply Rle_trans with (flc 9.2 * eps * (1 - u p)).
    + replace (flc 9.2 * eps * (1 - u p)) with (flc 9.2 * (1 - u p) * eps) by ring.
      apply Rmult_le_compat_r; nra.
    + apply (rnd_relative p emin nearest (u p) (eta / 2) nearest_error).
      apply Rle_trans with (1 * eps); [rewrite Rmult_1_l; apply bpow_le; lia |].
      apply Rmult_le_compat_r; nra.
  - apply rnd_below; auto with typeclass_instances.
    + change 16 with (bpow radix2 4). unfold Format.eps. rewrite <- bpow_plus.
      apply number_power; [exact eq_refl | lia].
    + apply Rmult_le_compat_r; lra.
Qed.

Section Margin.

(** M is the size, Mc its computed value. *)
Context (M Mc : R) (M_0 : 0 <= M) (Mc_size : M * (1 - eps) <= Mc <= M * (1 + eps)).
Notation allowed := (fl (Mc * margin)).

Lemma allowed_bounds : 0 <= allowed /\ 9.18 * eps * M - eta <= allowed <= 17 * eps * M + eta.
Proof.
  destruct margin_bounds as (L & H). generalize eps_tiny (eta_positive emin). intros P Q.
  assert (C : 0 <= Mc) by (assert (0 <= M * (1 - eps)) by (apply Rmult_le_pos; lra); lra).
  assert (D : 0 <= Mc * margin) by (apply Rmult_le_pos; lra).
  assert (EM : 0 <= eps * M) by (apply Rmult_le_pos; lra).
  assert (E2 : eps * (eps * M) <= / 1000000 * (eps * M)) by (apply Rmult_le_compat_r; lra).
  assert (X : Mc * margin <= 16.1 * (eps * M)).
  { apply Rle_trans with (M * (1 + eps) * (16 * eps)); [apply Rmult_le_compat; lra |].
    replace (M * (1 + eps) * (16 * eps)) with (16 * (eps * M) + 16 * (eps * (eps * M))) by ring. lra. }
  assert (Y : 9.19 * (eps * M) - 9.19 * (eps * (eps * M)) <= Mc * margin).
  { apply Rle_trans with (M * (1 - eps) * (9.19 * eps)).
    - right. ring.
    - apply Rmult_le_compat; try lra. apply Rmult_le_pos; lra. }
  split; [apply rnd_nonnegative; auto with typeclass_instances |].
  generalize (rnd_lower p emin direction eps eta any_error (Mc * margin) D). intros Lo.
  assert (Up : fl (Mc * margin) <= Mc * margin * (1 + eps) + eta).
  { destruct (Rlt_or_le (Rabs (Mc * margin)) (smallest_normal p emin)) as [S | S].
    - generalize (error_absolute p emin direction eps eta any_error _ S). intros K.
      apply Rabs_le_inv in K. assert (0 <= Mc * margin * eps) by (apply Rmult_le_pos; lra). lra.
    - generalize (error_relative p emin direction eps eta any_error _ S). intros K.
      rewrite (Rabs_pos_eq (Mc * margin)) in K by easy. apply Rabs_le_inv in K. lra. }
  assert (Mc * margin * eps <= 16.1 * (eps * (eps * M))).
  { replace (16.1 * (eps * (eps * M))) with (16.1 * (eps * M) * eps) by ring.
    apply Rmult_le_compat_r; lra. }
  split; lra.
Qed.

(** The rounding of a bound: r with its margin added or subtracted. *)
Lemma bound_near r s : number r -> Rabs r <= 1.01 * M -> s = allowed \/ s = - allowed ->
  near (1.02 * eps * M) (fl (r + s) - (r + s)).
Proof.
  intros N L S. destruct allowed_bounds as (E0 & E1 & E2).
  generalize eps_tiny (eta_positive emin). intros P Q.
  assert (NS : number s) by (destruct S as [-> | ->]; [| apply number_opp]; apply number_fl).
  assert (LS : Rabs s = allowed) by (destruct S as [-> | ->]; rewrite ?Rabs_Ropp; now apply Rabs_pos_eq).
  assert (EM : eps * M <= / 1000000 * M) by (apply Rmult_le_compat_r; lra).
  pose proof (Rabs_triang r s) as T. rewrite LS in T.
  destruct (Rlt_or_le M (1000 * eta)) as [Tiny | Large].
  - left. rewrite (sum_exact_below p emin direction r s N NS); [ring |].
    apply Rle_lt_trans with (1 := T). apply Rlt_le_trans with (2000 * eta); [lra |].
    unfold smallest_normal, Format.eta. apply Rle_trans with (bpow radix2 11 * bpow radix2 (-1074)).
    + apply Rmult_le_compat_r; [apply bpow_ge_0 | simpl; lra].
    + rewrite <- bpow_plus. apply bpow_le. lia.
  - apply near_more with (2 := sum_near r s N NS).
    apply Rle_trans with (eps * (1.02 * M)); [apply Rmult_le_compat_l; lra | lra].
Qed.

(** r' and s' are the computed r and s, with errors of 8.1 eps M together. *)
Lemma after_margin r s r' s' A B : 0 <= A -> 0 <= B -> A + B <= 8.1 * eps * M ->
  number r' -> Rabs r' <= 1.01 * M -> near A (r' - r) -> near B (s' - s) ->
  (fl (r' + allowed) < s' -> r < s) /\ (s' < fl (r' - allowed) -> s < r).
Proof.
  intros PA PB S N L Nr Ns. destruct allowed_bounds as (E0 & E1 & E2).
  generalize eps_tiny (eta_positive emin). intros P Q.
  assert (Final : forall t, near (A + B + 1.02 * eps * M) t -> t <= allowed).
  { intros t [-> | H]; [easy |]. apply Rabs_le_inv in H. lra. }
  assert (D : near (A + B) ((r' - r) + - (s' - s))) by (apply near_sum; auto; now apply near_opp).
  split; intros H.
  - pose proof (bound_near r' allowed N L (or_introl eq_refl)) as R1.
    enough (- ((r' - r) + - (s' - s) + (fl (r' + allowed) - (r' + allowed))) <= allowed) by lra.
    apply Final, near_opp, near_sum; auto; lra.
  - pose proof (bound_near r' (- allowed) N L (or_intror eq_refl)) as R2.
    fold (r' - allowed) in R2.
    enough ((r' - r) + - (s' - s) + (fl (r' - allowed) - (r' - allowed)) <= allowed) by lra.
    apply Final, near_sum; auto; lra.
Qed.

End Margin.

(** ** The nine axes *)

(** The computed projection on an axis has an error of at most 2.02 eps M. *)
Definition measures_as (m : point) (a : axis) (M : R) : Prop := 0 <= M /\
  M * (1 - eps) <= size a <= M * (1 + eps) /\
  forall q p, number (x q) -> number (y q) -> number (z q) -> number (x p) -> number (y p) -> number (z p) ->
  let d := difference_of q p in
  Rabs (x d) <= x m -> Rabs (y d) <= y m -> Rabs (z d) <= z m ->
  number (project a d) /\ Rabs (project a d) <= 1.001 * M /\
  near (2.02 * eps * M) (project a d - dot (along_axis a) (minus q p)).
Definition measures (m : point) (a : axis) : Prop := exists M, measures_as m a M.

Lemma coordinate_measures m r s : number r -> number s -> Rabs (fl (r - s)) <= m ->
  number (fl (r - s)) /\ near (1.01 * eps * m) (fl (r - s) - (r - s)).
Proof. intros A B L. split; [apply number_fl |]. apply near_result; auto. now apply difference_near. Qed.
Lemma sum_measures m n r s r' s' : number r' -> number s' -> Rabs r' <= m -> Rabs s' <= n ->
  near (1.01 * eps * m) (r' - r) -> near (1.01 * eps * n) (s' - s) ->
  number (fl (r' + s')) /\ Rabs (fl (r' + s')) <= 1.001 * (m + n) /\
  near (2.02 * eps * (m + n)) (fl (r' + s') - (r + s)).
Proof.
  intros A B L K E F. generalize eps_tiny. intros P. pose proof (Rabs_pos r'). pose proof (Rabs_pos s').
  pose proof (sum_near r' s' A B) as N. pose proof (Rabs_triang r' s') as T.
  assert (EM : eps * (m + n) <= / 1000000 * (m + n)) by (apply Rmult_le_compat_r; lra).
  assert (0 <= eps * m) by (apply Rmult_le_pos; lra). assert (0 <= eps * n) by (apply Rmult_le_pos; lra).
  assert (Q : near (eps * (m + n)) (fl (r' + s') - (r' + s'))).
  { apply near_more with (2 := N). apply Rmult_le_compat_l; lra. }
  split; [apply number_fl |]. split.
  - pose proof (near_size (eps * (m + n)) _ ltac:(lra) Q) as S.
    pose proof (Rabs_triang (fl (r' + s') - (r' + s')) (r' + s')) as U.
    replace (fl (r' + s') - (r' + s') + (r' + s')) with (fl (r' + s')) in U by ring. lra.
  - replace (fl (r' + s') - (r + s)) with ((fl (r' + s') - (r' + s')) + ((r' - r) + (s' - s))) by ring.
    apply near_more with (eps * (m + n) + (1.01 * eps * m + 1.01 * eps * n)); [lra |].
    apply near_sum; auto; try lra. apply near_sum; auto; lra.
Qed.
Lemma size_sum m n : number m -> number n -> 0 <= m -> 0 <= n ->
  (m + n) * (1 - eps) <= fl (m + n) <= (m + n) * (1 + eps).
Proof.
  intros A B C D. generalize eps_tiny. intros P. pose proof (sum_near m n A B) as N.
  rewrite (Rabs_pos_eq (m + n)) in N by lra. apply near_size in N; [| apply Rmult_le_pos; lra].
    apply Rabs_le_inv in N. lra.
Qed.

Section Axes.

Context (m : point) (m_number : number (x m) /\ number (y m) /\ number (z m)) (m_0 : 0 <= x m /\ 0 <= y m /\ 0 <= z m).

Lemma axes_measure a : In a (coordinate_axes (x m) (y m) (z m) ++ diagonal_axes (x m) (y m) (z m)) ->
  measures m a.
Proof.
  generalize eps_tiny. intros P. destruct m_number as (NX & NY & NZ), m_0 as (X & Y & Z).
  assert (One : forall n, 0 <= n -> n * (1 - eps) <= n <= n * (1 + eps)).
  { intros n H. assert (0 <= n * eps) by (apply Rmult_le_pos; lra). lra. }
  assert (More : forall n r, 0 <= n -> near (1.01 * eps * n) r -> near (2.02 * eps * n) r).
  { intros n r H. apply near_more. assert (0 <= eps * n) by (apply Rmult_le_pos; lra). lra. }
  assert (Opp : forall n r s, near (1.01 * eps * n) (r - s) -> near (1.01 * eps * n) (- r - - s)).
  { intros n r s H. replace (- r - - s) with (- (r - s)) by ring. now apply near_opp. }
  intros I. cbn in I. unfold measures, measures_as.
  destruct I as [<- | [<- | [<- | [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]]]]];
    [exists (x m) | exists (y m) | exists (z m) | exists (x m + y m) | exists (x m + y m) |
     exists (y m + z m) | exists (y m + z m) | exists (z m + x m) | exists (z m + x m)];
    cbn [project along_axis size]; (split; [lra |]); (split; [auto using size_sum; fail |]);
    intros q r Qx Qy Qz Rx Ry Rz; cbn zeta; unfold difference_of, dot, minus; cbn [x y z];
    intros Lx Ly Lz;
    destruct (coordinate_measures _ _ _ Qx Rx Lx) as (Nx & Ex),
      (coordinate_measures _ _ _ Qy Ry Ly) as (Ny & Ey),
      (coordinate_measures _ _ _ Qz Rz Lz) as (Nz & Ez).
  1-3: split; [apply number_fl |]; split; [lra |]; rewrite ?Rmult_0_l, ?Rmult_1_l, ?Rplus_0_l, ?Rplus_0_r;
    now apply More.
  - replace (1 * (x q - x r) + 1 * (y q - y r) + 0 * (z q - z r)) with ((x q - x r) + (y q - y r)) by ring.
    now apply sum_measures.
  - replace (1 * (x q - x r) + -1 * (y q - y r) + 0 * (z q - z r)) with ((x q - x r) + - (y q - y r)) by ring.
    apply sum_measures; auto; [now apply number_opp | now rewrite Rabs_Ropp].
  - replace (0 * (x q - x r) + 1 * (y q - y r) + 1 * (z q - z r)) with ((y q - y r) + (z q - z r)) by ring.
    now apply sum_measures.
  - replace (0 * (x q - x r) + 1 * (y q - y r) + -1 * (z q - z r)) with ((y q - y r) + - (z q - z r)) by ring.
    apply sum_measures; auto; [now apply number_opp | now rewrite Rabs_Ropp].
  - replace (1 * (x q - x r) + 0 * (y q - y r) + 1 * (z q - z r)) with ((z q - z r) + (x q - x r)) by ring.
    now apply sum_measures.
  - replace (-1 * (x q - x r) + 0 * (y q - y r) + 1 * (z q - z r)) with ((z q - z r) + - (x q - x r)) by ring.
    apply sum_measures; auto; [now apply number_opp | now rewrite Rabs_Ropp].
Qed.

(** ** Queries *)

Definition at_end (q : moving) (finish : bool) : point := if finish then Contact.finish q else start q.
Definition numbers (q : moving) : Prop := forall e,
  number (x (at_end q e)) /\ number (y (at_end q e)) /\ number (z (at_end q e)).
Definition differences_of (b_end b_start c_end c_start p_end p_start : moving) : differences := Differences
  (fun e => difference_of (at_end b_end e) (at_end b_start e))
  (fun e => difference_of (at_end c_end e) (at_end c_start e))
  (fun e => difference_of (at_end p_end e) (at_end p_start e)).
Definition within (v : bool -> point) : Prop := forall e,
  Rabs (x (v e)) <= x m /\ Rabs (y (v e)) <= y m /\ Rabs (z (v e)) <= z m.
Definition sized (d : differences) : Prop := within (b d) /\ within (c d) /\ within (p_ d).

Lemma before_of n q r : (forall e, dot n (at_end q e) < dot n (at_end r e)) -> before n q r.
Proof. intros H. split; [apply (H false) | apply (H true)]. Qed.
Lemma before_opposite n q r : before n q r -> before (minus origin n) r q.
Proof. unfold before, dot, minus, origin. simpl. lra. Qed.

Lemma separated_sides sides : separated_along sides = true ->
  (forall e, fst (sides e) = true) \/ (forall e, snd (sides e) = true).
Proof.
  unfold separated_along. intros H. apply orb_prop in H. destruct H as [H | H]; apply andb_prop in H;
    [left | right]; intros []; apply H.
Qed.
Lemma separated_on sides :
  separated sides (coordinate_axes (x m) (y m) (z m)) = true \/ separated sides (diagonal_axes (x m) (y m) (z m)) =
    true ->
  exists a, In a (coordinate_axes (x m) (y m) (z m) ++ diagonal_axes (x m) (y m) (z m)) /\
    separated_along (sides a) = true.
Proof.
  intros [T | T]; apply existsb_exists in T; destruct T as (a & I & T); exists a; rewrite in_app_iff; auto.
Qed.
Lemma less_of a b : Rlt_bool a b = true -> a < b.
Proof. destruct (Rlt_bool_spec a b); [easy | discriminate]. Qed.
Lemma fl_le r s : r <= s -> fl r <= fl s.
Proof. apply rnd_le; auto with typeclass_instances. Qed.

(** Computed positions along an axis at one end of the step, from vertex o on. *)
Section Positions.

Context (a : axis) (M : R) (M_measures : measures_as m a M) (e : bool).
Notation D q := (dot (along_axis a) (at_end q e)).
Notation allowed := (fl (size a * margin)).

(** Computed from one difference, or as the sum of two. *)
Definition placed (o q : moving) (r : R) : Prop :=
  number r /\ Rabs r <= 1.01 * M /\ near (2.02 * eps * M) (r - (D q - D o)).
Definition placed_roughly (o q : moving) (r : R) : Prop := near (6.07 * eps * M) (r - (D q - D o)).

Lemma scale_0 : 0 <= M /\ 0 <= eps * M.
Proof. destruct M_measures as (H & _). generalize eps_tiny. intros P. split; [easy |]. apply Rmult_le_pos; lra. Qed.
Lemma placed_reference o : placed o o 0.
Proof. destruct scale_0. split; [apply number_0 |]. split; [rewrite Rabs_R0; lra |]. left. ring. Qed.
Lemma placed_by_difference o q : numbers o -> numbers q ->
  within (fun e => difference_of (at_end q e) (at_end o e)) ->
  placed o q (project a (difference_of (at_end q e) (at_end o e))).
Proof.
  intros O Q W. destruct M_measures as (M0 & _ & H), (O e) as (O1 & O2 & O3), (Q e) as (Q1 & Q2 & Q3),
    (W e) as (W1 & W2 & W3).
  destruct (H _ _ Q1 Q2 Q3 O1 O2 O3 W1 W2 W3) as (N & L & E). unfold placed. rewrite <- dot_minus.
  split; auto. split; [lra | exact E].
Qed.
Lemma placed_enough o q r : placed o q r -> placed_roughly o q r.
Proof. intros (_ & _ & E). destruct scale_0. apply near_more with (2 := E). lra. Qed.
Lemma placed_by_sum o n q r s : placed o n r -> placed n q s -> placed_roughly o q (fl (r + s)).
Proof.
  intros (Nr & Lr & Er) (Ns & Ls & Es). generalize eps_tiny. intros P. destruct scale_0 as (M0 & E0).
  unfold placed_roughly.
  replace (fl (r + s) - (D q - D o)) with ((fl (r + s) - (r + s)) + ((r - (D n - D o)) + (s - (D q - D n)))) by ring.
  apply near_more with (2.03 * eps * M + (2.02 * eps * M + 2.02 * eps * M)); [lra |].
  apply near_sum; try lra; [| apply near_sum; auto; lra].
  apply near_more with (2 := sum_near r s Nr Ns). pose proof (Rabs_triang r s).
  apply Rle_trans with (eps * (2.03 * M)); [apply Rmult_le_compat_l; lra | lra].
Qed.

(** Sides of an axis whose computed extremes are low and high. *)
Lemma sides_apart o q s r t low high low' high' : placed o q r -> placed_roughly o s t ->
  low <= r <= high -> low' <= t <= high' ->
  (Rlt_bool (fl (high + allowed)) low' = true -> D q < D s) /\
  (Rlt_bool high' (fl (low - allowed)) = true -> D s < D q).
Proof.
  intros (N & L & E) F Q S. destruct M_measures as (M0 & Ms & _), scale_0 as (_ & E0).
  destruct (after_margin M (size a) M0 Ms _ _ _ _ (2.02 * eps * M) (6.07 * eps * M)
    ltac:(lra) ltac:(lra) ltac:(lra) N L E F) as (A & B).
  pose proof (fl_le (r + allowed) (high + allowed) ltac:(lra)).
  pose proof (fl_le (low - allowed) (r - allowed) ltac:(lra)).
  split; intros K; apply less_of in K;
    [assert (D q - D o < D s - D o) by (apply A; lra) | assert (D s - D o < D q - D o) by (apply B; lra)]; lra.
Qed.

End Positions.

Lemma between_extremes r s : Rmin r s <= r <= Rmax r s /\ Rmin r s <= s <= Rmax r s.
Proof. pose proof (Rmin_l r s). pose proof (Rmin_r r s). pose proof (Rmax_l r s). pose proof (Rmax_r r s). lra. Qed.

Section Face.

Context (v f0 f1 f2 : moving) (v_numbers : numbers v) (f0_numbers : numbers f0) (f1_numbers : numbers f1)
  (f2_numbers : numbers f2).
Notation d := (differences_of f1 f0 f2 f0 v f0).
Hypothesis d_sized : sized d.

Lemma face_axis a : measures m a -> separated_along (face_sides d a) = true ->
  ~ vertex_face_collides v f0 f1 f2.
Proof.
  intros (M & H) T. destruct d_sized as (Wb & Wc & Wp).
  assert (Sides : forall f e, In f [f0; f1; f2] ->
    (fst (face_sides d a e) = true -> dot (along_axis a) (at_end f e) < dot (along_axis a) (at_end v e)) /\
    (snd (face_sides d a e) = true -> dot (along_axis a) (at_end v e) < dot (along_axis a) (at_end f e))).
  { intros f e I. pose proof (placed_reference a M H e f0) as P0.
    pose proof (placed_by_difference a M H e f0 f1 f0_numbers f1_numbers Wb) as P1.
    pose proof (placed_by_difference a M H e f0 f2 f0_numbers f2_numbers Wc) as P2.
    pose proof (placed_by_difference a M H e f0 v f0_numbers v_numbers Wp) as Pv. apply placed_enough in Pv; auto.
    unfold face_sides. cbn [b c p_ differences_of fst snd].
    set (b' := project a (difference_of (at_end f1 e) (at_end f0 e))) in *.
    set (c' := project a (difference_of (at_end f2 e) (at_end f0 e))) in *.
    set (v' := project a (difference_of (at_end v e) (at_end f0 e))) in *.
    pose proof (between_extremes b' c'). pose proof (between_extremes (Rmax b' c') 0).
    pose proof (between_extremes (Rmin b' c') 0). destruct I as [<- | [<- | [<- | []]]];
      [apply (sides_apart a M H e f0 _ _ 0 v') | apply (sides_apart a M H e f0 _ _ b' v') |
       apply (sides_apart a M H e f0 _ _ c' v')]; auto; lra. }
  apply separated_sides in T. destruct T as [T | T];
    [apply (face_separated (minus origin (along_axis a))); apply before_opposite |
     apply (face_separated (along_axis a))]; apply before_of; intros e; apply Sides; (apply T || (simpl; auto)).
Qed.

Theorem separated_face_separate :
  separated (face_sides d) (coordinate_axes (x m) (y m) (z m)) = true \/
  separated (face_sides d) (diagonal_axes (x m) (y m) (z m)) = true -> ~ vertex_face_collides v f0 f1 f2.
Proof. intros T. destruct (separated_on _ T) as (a & I & E). exact (face_axis a (axes_measure a I) E). Qed.

End Face.

Section Edges.

Context (a0 a1 b0 b1 : moving) (a0_numbers : numbers a0) (a1_numbers : numbers a1) (b0_numbers : numbers b0)
  (b1_numbers : numbers b1).
Notation d := (differences_of a1 a0 b1 b0 b0 a0).
Hypothesis d_sized : sized d.

Lemma edges_axis a : measures m a -> separated_along (edge_sides d a) = true ->
  ~ edge_edge_collides a0 a1 b0 b1.
Proof.
  intros (M & H) T. destruct d_sized as (Wb & Wc & Wp).
  assert (Sides : forall f g e, In f [a0; a1] -> In g [b0; b1] ->
    (fst (edge_sides d a e) = true -> dot (along_axis a) (at_end f e) < dot (along_axis a) (at_end g e)) /\
    (snd (edge_sides d a e) = true -> dot (along_axis a) (at_end g e) < dot (along_axis a) (at_end f e))).
  { intros f g e I J. pose proof (placed_reference a M H e a0) as P0.
    pose proof (placed_by_difference a M H e a0 a1 a0_numbers a1_numbers Wb) as P1.
    pose proof (placed_by_difference a M H e b0 b1 b0_numbers b1_numbers Wc) as Pc.
    pose proof (placed_by_difference a M H e a0 b0 a0_numbers b0_numbers Wp) as Pb.
    pose proof (placed_by_sum a M H e _ _ _ _ _ Pb Pc) as R1. apply placed_enough in Pb; auto.
    unfold edge_sides. cbn [b c p_ differences_of fst snd].
    set (a' := project a (difference_of (at_end a1 e) (at_end a0 e))) in *.
    set (b' := project a (difference_of (at_end b0 e) (at_end a0 e))) in *. set (b'' := fl (b' + _)) in *.
    pose proof (between_extremes a' 0). pose proof (between_extremes b' b'').
    destruct I as [<- | [<- | []]], J as [<- | [<- | []]];
      [apply (sides_apart a M H e a0 _ _ 0 b') | apply (sides_apart a M H e a0 _ _ 0 b'') |
       apply (sides_apart a M H e a0 _ _ a' b') | apply (sides_apart a M H e a0 _ _ a' b'')]; auto; lra. }
  apply separated_sides in T. destruct T as [T | T];
    [apply (edges_separated (along_axis a)) |
     apply (edges_separated (minus origin (along_axis a))); apply before_opposite];
    apply before_of; intros e;
    (refine (proj1 (Sides _ _ e _ _) (T e)) || refine (proj2 (Sides _ _ e _ _) (T e))); simpl; auto.
Qed.

Theorem separated_edges_separate :
  separated (edge_sides d) (coordinate_axes (x m) (y m) (z m)) = true \/
  separated (edge_sides d) (diagonal_axes (x m) (y m) (z m)) = true -> ~ edge_edge_collides a0 a1 b0 b1.
Proof. intros T. destruct (separated_on _ T) as (a & I & E). exact (edges_axis a (axes_measure a I) E). Qed.

End Edges.
End Axes.
End SeparatingAxis.
