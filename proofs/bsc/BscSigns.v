(** Bernstein sign classification: lemmas on its signs at roots, over every scalar of Bernstein.v. BscCode.v has
    the code. Y is a cubic and each G a quartic, as lists of scaled coefficients; f(t) is at_time f t. Results, for
    any uncertain signs:
        sign_determination_1   the sign of a linear form at the only inner root of Y
        sign_determination_2   the sign at either of two inner roots of a convex Y
        reduction              y0 y3 G = s t J at a root of Y, up to a positive factor
        polynomial_decomposition   M J = - s t R at a root of Y, up to positive factors
        root_finding           the sign of Y at its only inner extremum *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Errbound Require Import Sign Bernstein.
From Errbound Require Export BscCode.
Import ListNotations.
Open Scope R_scope.

Lemma length_2 {A} (l : list A) : length l = 2%nat -> exists a b, l = [a; b].
Proof. destruct l as [| a [| b [|]]]; try discriminate. eauto. Qed.
Lemma length_3 {A} (l : list A) : length l = 3%nat -> exists a b c, l = [a; b; c].
Proof. destruct l as [| a [| b [| c [|]]]]; try discriminate. eauto. Qed.
Lemma length_4 {A} (l : list A) : length l = 4%nat -> exists a b c e, l = [a; b; c; e].
Proof. destruct l as [| a [| b [| c [| d [|]]]]]; try discriminate. eauto 6. Qed.
Lemma length_5 {A} (l : list A) : length l = 5%nat -> exists a b c e f, l = [a; b; c; e; f].
Proof. destruct l as [| a [| b [| c [| d [| e [|]]]]]]; try discriminate. eauto 7. Qed.

Ltac four y H :=
  let a := fresh y "0" in let b := fresh y "1" in let c := fresh y "2" in let d := fresh y "3" in
  destruct (length_4 y H) as (a & b & c & d & ->).
Ltac values := unfold at_time, derivative; cbn [map derivative_from nth]; repeat (progress exacts ||
  rewrite exact_times);
  simpl.

Section Signs.

Context {S : scalar}.
Notation exacts := (map (@exact S)).
Notation "p '#' i" := (nth i p (whole 0)) (at level 20).
Notation form_at := (@at_time S).
Notation dy y := (derivative y).
Notation ddy y := (derivative (derivative y)).
Implicit Types (y g l d j : list S).

(** ** Cubics and their derivatives *)

Lemma taylor y a b : length y = 4%nat ->
  form_at y b = form_at y a + form_at (dy y) a * (b - a)
                + (b - a) * (b - a) * (2 * form_at (ddy y) a + form_at (ddy y) b) / 6.
Proof. intros L. four y L. values. field. Qed.
Lemma simpson y a b : length y = 4%nat ->
  form_at y b - form_at y a =
  (b - a) * (form_at (dy y) a + 4 * form_at (dy y) ((a + b) / 2) + form_at (dy y) b) / 6.
Proof. intros L. four y L. values. field. Qed.
Lemma trapezoid y a b : length y = 4%nat ->
  form_at (dy y) b - form_at (dy y) a = (b - a) * (form_at (ddy y) a + form_at (ddy y) b) / 2.
Proof. intros L. four y L. values. field. Qed.
Lemma second_difference y x h : length y = 4%nat ->
  form_at y (x + h) + form_at y (x - h) - 2 * form_at y x = h * h * form_at (ddy y) x.
Proof. intros L. four y L. values. ring. Qed.


(** The used properties of a curve without inflection: it lies above its tangents, and its slope increases. *)
Definition convex (Y D : R -> R) : Prop :=
  (forall a b, 0 <= a <= 1 -> 0 <= b <= 1 -> a <> b -> Y a + D a * (b - a) < Y b) /\
  (forall a b, 0 <= a <= 1 -> 0 <= b <= 1 -> a < b -> D a < D b).

Lemma convex_by_signs y : length y = 4%nat -> signs_inside positive (exacts (ddy y)) ->
  convex (form_at y) (form_at (dy y)).
Proof.
  intros L. simpl. intros (F & E).
  assert (H : exists l0 l1 : R, exacts (ddy y) = [l0; l1]) by (four y L; simpl; eauto).
  destruct H as (l0 & l1 & H). rewrite H in F, E.
  assert (N : 0 <= l0 /\ 0 <= l1 /\ (0 < l0 \/ 0 < l1)).
  { inversion_clear F as [| ? ? A F']. inversion_clear F' as [| ? ? B _]. repeat split; auto.
    inversion_clear E as [? ? P | ? ? E']; auto. inversion_clear E' as [? ? P | ? ? E'']; auto.
    inversion E''. }
  assert (V : forall t, form_at (ddy y) t = l0 * (1 - t) + l1 * t)
    by (intros t; unfold at_time; rewrite H; simpl; ring).
  split; intros a b A B AB.
  - rewrite (taylor y a b L), !V.
    assert (0 < (b - a) * (b - a)) by nra.
    assert (0 < 2 * (l0 * (1 - a) + l1 * a) + (l0 * (1 - b) + l1 * b)) by nra.
    assert (0 < (b - a) * (b - a) * (2 * (l0 * (1 - a) + l1 * a) + (l0 * (1 - b) + l1 * b)))
      by (apply Rmult_lt_0_compat; auto). lra.
  - pose proof (trapezoid y a b L) as T. rewrite !V in T.
    assert (0 < l0 * (1 - a) + l1 * a + (l0 * (1 - b) + l1 * b)) by nra.
    assert (0 < (b - a) * (l0 * (1 - a) + l1 * a + (l0 * (1 - b) + l1 * b)))
      by (apply Rmult_lt_0_compat; lra). lra.
Qed.

Lemma below_chord Y D a m b : convex Y D -> 0 <= a -> a < m < b -> b <= 1 ->
  (b - a) * Y m < (b - m) * Y a + (m - a) * Y b.
Proof.
  intros (T & _) A M B.
  pose proof (T m a ltac:(lra) ltac:(lra) ltac:(lra)) as P.
  pose proof (T m b ltac:(lra) ltac:(lra) ltac:(lra)) as Q.
  apply (Rmult_lt_compat_l (b - m)) in P; [| lra]. apply (Rmult_lt_compat_l (m - a)) in Q; [| lra]. lra.
Qed.

(** At the root r, Y changes from the sign of sigma to the opposite one. *)
Definition crossing (Y : R -> R) (sigma r : R) : Prop :=
  0 < r < 1 /\ Y r = 0 /\ (forall t, 0 < t < r -> 0 < sigma * Y t) /\ (forall t, r < t < 1 -> sigma * Y
    t < 0)
  /\ 0 <= sigma * Y 0 /\ sigma * Y 1 <= 0.

(** If Y(0) <= 0, then Y(1) > 0 and there is one inner root. The other end is symmetric. *)
Lemma rising_crossing Y D r : convex Y D -> 0 < r < 1 -> Y r = 0 -> Y 0 <= 0 -> crossing Y (-1) r /\ 0 <
  Y 1.
Proof.
  intros C I Z N.
  assert (After : forall t, r < t <= 1 -> 0 < Y t).
  { intros t T. pose proof (below_chord Y D 0 r t C ltac:(lra) ltac:(lra) ltac:(lra)). rewrite Z in H.
      nra. }
  repeat split; try tauto; try lra; try (apply After; lra).
  - intros t T. pose proof (below_chord Y D 0 t r C ltac:(lra) ltac:(lra) ltac:(lra)). rewrite Z in H.
      nra.
  - intros t T. specialize (After t ltac:(lra)). lra.
  - specialize (After 1 ltac:(lra)). lra.
Qed.
Lemma falling_crossing Y D r : convex Y D -> 0 < r < 1 -> Y r = 0 -> Y 1 <= 0 -> crossing Y 1 r /\ 0 < Y
  0.
Proof.
  intros C I Z N.
  assert (Before : forall t, 0 <= t < r -> 0 < Y t).
  { intros t T. pose proof (below_chord Y D t r 1 C ltac:(lra) ltac:(lra) ltac:(lra)). rewrite Z in H.
      nra. }
  repeat split; try tauto; try lra; try (apply Before; lra).
  - intros t T. specialize (Before t ltac:(lra)). lra.
  - intros t T. pose proof (below_chord Y D r t 1 C ltac:(lra) ltac:(lra) ltac:(lra)). rewrite Z in H.
      nra.
  - specialize (Before 0 ltac:(lra)). lra.
Qed.

Lemma monotone_by_signs y : length y = 4%nat -> signs_inside positive (exacts (dy y)) ->
  forall a b, 0 <= a -> a < b -> b <= 1 -> form_at y a < form_at y b.
Proof.
  intros L (F & E) a b A AB B. pose proof (simpson y a b L) as T.
  assert (0 <= form_at (dy y) a) by (apply hull_nonnegative; auto; lra).
  assert (0 <= form_at (dy y) b) by (apply hull_nonnegative; auto; lra).
  assert (0 < form_at (dy y) ((a + b) / 2)) by (apply hull_inside; auto; lra).
  assert (0 < (b - a) * (form_at (dy y) a + 4 * form_at (dy y) ((a + b) / 2) + form_at (dy y) b))
    by (apply Rmult_lt_0_compat; lra). lra.
Qed.

(** ** Linear forms *)

Lemma value_near_root p s t : p <> [] -> 0 < s -> 0 < t ->
  exists c, 0 < c /\ form (exacts p) s t = c * form_at p (t / (s + t)).
Proof.
  intros N Hs Ht. destruct p as [| a l]; [easy |]. exists ((s + t) ^ length (exacts l)).
  split; [apply pow_lt; lra |]. unfold at_time. cbn [map].
  rewrite <- form_homogeneous. f_equal; field; lra.
Qed.

Lemma sign_scaled s c x : 0 < c -> sign_is_right s (c * x) -> sign_is_right s x.
Proof. intros C. destruct s; simpl; auto; nra. Qed.

(** An opposite form has an inner root r, and sign_at_root_of is right there. *)
Lemma opposite_root l : length l = 2%nat -> opposite l = true ->
  exists r, 0 < r < 1 /\ form_at l r = 0 /\
    (forall t, t < r -> sign_is_right (sign_of (l#0)) (form_at l t)) /\
    (forall t, r < t -> sign_is_right (sign_of (l#1)) (form_at l t)) /\
    (forall p, p <> [] -> sign_is_right (sign_at_root_of l p) (form_at p r)) /\
    exists v w, linear_root l = (v, w) /\ 0 < exact v /\ 0 < exact w /\ r = exact w / (exact v + exact
      w).
Proof.
  intros L O. destruct (length_2 l L) as (l0 & l1 & ->).
  assert (H : exists v w, linear_root [l0; l1] = (v, w) /\ 0 < exact v /\ 0 < exact w /\
    (sign_of l0 = positive /\ sign_of l1 = negative /\ exact l1 = - exact v /\ exact l0 = exact w \/
     sign_of l0 = negative /\ sign_of l1 = positive /\ exact l1 = exact v /\ exact l0 = - exact w)).
  { unfold opposite in O. unfold linear_root. simpl in *.
    pose proof (sign_right S l0) as A. pose proof (sign_right S l1) as B.
    destruct (sign_of l0), (sign_of l1); try discriminate; simpl in *; do 2 eexists;
      (split; [reflexivity | exacts; repeat split; try lra; intuition lra]). }
  destruct H as (v & w & R & V & W & H). exists (exact w / (exact v + exact w)).
  set (r := exact w / (exact v + exact w)).
  assert (Er : exact w = r * (exact v + exact w)) by (unfold r; field; lra).
  assert (I : 0 < r < 1).
  { split; [apply Rdiv_lt_0_compat; lra |]. apply Rmult_lt_reg_r with (exact v + exact w); lra. }
  assert (At : forall t, form_at [l0; l1] t = exact l0 * (1 - t) + exact l1 * t)
    by (intros t; unfold at_time; simpl; ring).
  set (k := exact v + exact w) in *. assert (K : 0 < k) by (unfold k; lra).
  assert (Ev : exact v = k * (1 - r)) by (unfold k in *; lra).
  repeat split; try tauto.
  - rewrite At. destruct H as [(_ & _ & -> & ->) | (_ & _ & -> & ->)]; rewrite Ev, Er; ring.
  - intros t T. rewrite At. simpl.
    destruct H as [(-> & _ & -> & ->) | (-> & _ & -> & ->)]; simpl; rewrite Ev, Er.
    + replace (_ + _) with (k * (r - t)) by ring. apply Rmult_lt_0_compat; lra.
    + replace (_ + _) with (- (k * (r - t))) by ring.
      assert (0 < k * (r - t)) by (apply Rmult_lt_0_compat; lra). lra.
  - intros t T. rewrite At. simpl.
    destruct H as [(_ & -> & -> & ->) | (_ & -> & -> & ->)]; simpl; rewrite Ev, Er.
    + replace (_ + _) with (- (k * (t - r))) by ring.
      assert (0 < k * (t - r)) by (apply Rmult_lt_0_compat; lra). lra.
    + replace (_ + _) with (k * (t - r)) by ring. apply Rmult_lt_0_compat; lra.
  - intros p N. unfold sign_at_root_of. rewrite R. pose proof (sign_right S (value_at p v w)) as P.
    rewrite value_at_form in P. destruct (value_near_root p (exact v) (exact w) N V W) as (c & C & E).
    rewrite E in P. eapply sign_scaled; eauto.
  - exists v, w. auto.
Qed.

Lemma inside_right l t : length l = 2%nat -> opposite l = false -> 0 < t < 1 ->
  sign_is_right (inside l) (form_at l t).
Proof.
  intros L O T. destruct (length_2 l L) as (l0 & l1 & ->). unfold opposite, inside, at_time in *.
  simpl in *. pose proof (sign_right S l0) as A. pose proof (sign_right S l1) as B.
  destruct (sign_of l0), (sign_of l1); try discriminate; simpl in *; auto; nra.
Qed.


(** ** Sign determination *)

Definition unit (s : sign) : R := match s with negative => -1 | positive => 1 | _ => 0 end.

Theorem sign_determination_1 y before l r : length l = 2%nat -> y <> [] ->
  before = negative \/ before = positive -> crossing (form_at y) (unit before) r ->
  sign_is_right (linear_at_crossing y before l) (form_at l r).
Proof.
  intros L N B (I & Z & Before & After & _). unfold linear_at_crossing.
  destruct (opposite l) eqn:O; simpl; [| now apply inside_right].
  destruct (opposite_root l L O) as (x & X & Zx & Left & Right & Sign & _).
  specialize (Sign y N). destruct (sign_at_root_of l y) eqn:E; simpl in *; auto.
  2: { destruct (Rtotal_order x r) as [T | [-> | T]]; auto;
       [specialize (Before x ltac:(lra)) | specialize (After x ltac:(lra))]; rewrite Sign in *; lra. }
  all: assert (x <> r) by (intros ->; lra).
  all: destruct B as [-> | ->]; simpl in *; destruct (Rlt_or_le x r);
    try (specialize (Before x ltac:(lra)); lra); try (specialize (After x ltac:(lra)); lra);
    try (apply Right; lra); try (apply Left; lra).
Qed.

(** At the root r to the left of the extremum, and at the one to the right; a double root is both. *)
Theorem sign_determination_2 y d l r : length l = 2%nat -> y <> [] -> d <> [] ->
  convex (form_at y) (form_at d) -> 0 < r < 1 -> form_at y r = 0 ->
  (form_at d r <= 0 -> sign_is_right (fst (linear_at_pair y d l)) (form_at l r)) /\
  (0 <= form_at d r -> sign_is_right (snd (linear_at_pair y d l)) (form_at l r)).
Proof.
  intros L Ny Nd (T & M) I Z. unfold linear_at_pair.
  destruct (opposite l) eqn:O; simpl; [| split; intros _; now apply inside_right].
  destruct (opposite_root l L O) as (x & X & Zx & Left & Right & Sign & _).
  pose proof (Sign y Ny) as Sy. pose proof (Sign d Nd) as Sd.
  (* which side of r the root x of l lies on *)
  assert (Ty : x <> r -> form_at d r * (x - r) < form_at y x)
    by (intros D; specialize (T r x ltac:(lra) ltac:(lra) ltac:(lra)); lra).
  assert (Tx : x <> r -> form_at y x + form_at d x * (r - x) < 0)
    by (intros D; specialize (T x r ltac:(lra) ltac:(lra) D); lra).
  assert (Md : forall a b, 0 <= a <= 1 -> 0 <= b <= 1 -> form_at d a < form_at d b -> a < b).
  { intros a b A B D. destruct (Rtotal_order a b) as [| [-> |]]; auto; [lra |].
    specialize (M b a B A H). lra. }
  assert (Negative : form_at y x < 0 -> (form_at d r <= 0 -> r < x) /\ (0 <= form_at d r -> x < r)).
  { intros Y. assert (x <> r) by (intros ->; lra). specialize (Ty H). split; intros D.
    - destruct (Rlt_or_le r x); auto. assert (0 <= form_at d r * (x - r)) by nra. lra.
    - destruct (Rlt_or_le x r); auto. assert (0 <= form_at d r * (x - r)) by nra. lra. }
  assert (Falling : form_at d x < 0 -> (0 < form_at y x -> x < r) /\ (0 <= form_at d r -> x < r)
                    /\ (form_at y x = 0 -> form_at d r <= 0 -> x = r)).
  { intros D. split; [| split].
    - intros Y. assert (x <> r) by (intros ->; lra). specialize (Tx H).
      destruct (Rlt_or_le x r); auto. assert (0 <= form_at d x * (r - x)) by nra. lra.
    - intros R. apply Md; lra.
    - intros Y R. nra. }
  assert (Rising : 0 < form_at d x -> (0 < form_at y x -> r < x) /\ (form_at d r <= 0 -> r < x)
                   /\ (form_at y x = 0 -> 0 <= form_at d r -> x = r)).
  { intros D. split; [| split].
    - intros Y. assert (x <> r) by (intros ->; lra). specialize (Tx H).
      destruct (Rlt_or_le r x); auto. assert (0 <= form_at d x * (r - x)) by nra. lra.
    - intros R. apply Md; lra.
    - intros Y R. nra. }
  assert (Zero : form_at d x = 0 -> form_at y x = 0 -> x = r).
  { intros D Y. destruct (Req_dec x r) as [| H]; auto. specialize (Tx H). rewrite D, Y in Tx. lra. }
  destruct (sign_at_root_of l y), (sign_at_root_of l d); simpl in *;
    split; intros D; auto; try (now apply Right; intuition lra); try (now apply Left; intuition lra).
  all: try (replace r with x by intuition; auto).
Qed.


(** ** Reduction and decomposition *)

Lemma length_normalized (p : list S) : length (normalized p) = length p.
Proof.
  destruct (normalized_right S p) as (c & _ & E). apply (f_equal (@length R)) in E.
  now rewrite !map_length in E.
Qed.
Lemma normalized_at (p : list S) : exists c, 0 < c /\ forall t, form_at (normalized p) t = c * form_at p
  t.
Proof.
  destruct (normalized_right S p) as (c & C & E). exists c. split; auto.
  intros t. unfold at_time. now rewrite E, form_scaled.
Qed.

Theorem reduction y g r : length y = 4%nat -> length g = 5%nat -> form_at y r = 0 ->
  exists c, 0 < c /\
    c * (exact (y#0) * exact (y#3) * form_at g r) = (1 - r) * r * form_at (reduced y g) r.
Proof.
  intros Ly Lg Z. four y Ly. destruct (length_5 g Lg) as (g0 & g1 & g2 & g3 & g4 & ->).
  unfold reduced.
  match goal with |- context [normalized ?p] => destruct (normalized_at p) as (c & C & E) end.
  exists c. split; auto. rewrite E.
  replace (exact _ * exact _ * _) with (exact (y0) * exact (y3) * form_at [g0; g1; g2; g3; g4] r
    - form_at [y0; y1; y2; y3] r * (exact y3 * exact g0 * (1 - r) + exact y0 * exact g4 * r))
    by (rewrite Z; simpl; ring).
  unfold at_time. simpl. exacts. ring.
Qed.

Theorem polynomial_decomposition y j r : length y = 4%nat -> length j = 3%nat -> form_at y r = 0 ->
  exists b c, 0 < b /\ 0 < c /\
    b * (form_at (decomposition_m y j) r * form_at j r) = - ((1 - r) * r * (c * form_at (decomposition_r
      y j) r)).
Proof.
  intros Ly Lj Z. four y Ly. destruct (length_3 j Lj) as (j0 & j1 & j2 & ->).
  unfold decomposition_m, decomposition_r.
  match goal with |- context [normalized ?p] => destruct (normalized_at p) as (c & C & E); rewrite E
    end.
  match goal with |- context [normalized ?p] => destruct (normalized_at p) as (b & B & F); rewrite F
    end.
  exists b, c. repeat split; auto.
  replace (b * (c * form_at [mul ([y0; y1; y2; y3] # 0) ([j0; j1; j2] # 2); mul ([y0; y1; y2; y3] # 3)
    ([j0; j1; j2] # 0)] r * form_at [j0; j1; j2] r)) with
    (b * c * (form_at [mul ([y0; y1; y2; y3] # 0) ([j0; j1; j2] # 2); mul ([y0; y1; y2; y3] # 3) ([j0;
      j1; j2] # 0)] r * form_at [j0; j1; j2] r
      - exact j0 * exact j2 * form_at [y0; y1; y2; y3] r)) by (rewrite Z; ring).
  unfold at_time. simpl. exacts. ring.
Qed.

Definition not_wrong (s : sign) (x : R) : Prop :=
  match s with negative => x < 0 | positive => 0 < x | _ => True end.
Lemma right_not_wrong s x : sign_is_right s x -> not_wrong s x.
Proof. destruct s; simpl; auto. Qed.

(** The sign of J from those of M and R: never a wrong strict sign, and right if M's sign is certain. *)
Lemma combined_right y j r m_sign r_sign : length y = 4%nat -> length j = 3%nat -> form_at y r = 0 -> 0
  < r < 1 ->
  sign_is_right m_sign (form_at (decomposition_m y j) r) ->
  sign_is_right r_sign (form_at (decomposition_r y j) r) ->
  let s := combined m_sign r_sign (decomposition_m y j) j in
  not_wrong s (form_at j r) /\ (m_sign <> uncertain -> sign_is_right s (form_at j r)).
Proof.
  intros Ly Lj Z I M Rr s. unfold s, combined.
  destruct (polynomial_decomposition y j r Ly Lj Z) as (b & c & B & C & E).
  set (x := form_at (decomposition_m y j) r) in *. set (z := form_at (decomposition_r y j) r) in *.
  set (v := form_at j r) in *.
  assert (P : 0 < (1 - r) * r) by nra.
  assert (Pos : 0 < z -> x * v < 0).
  { intros H. assert (0 < (1 - r) * r * (c * z)) by (repeat apply Rmult_lt_0_compat; lra). nra. }
  assert (Neg : z < 0 -> 0 < x * v).
  { intros H. assert (0 < (1 - r) * r * (c * - z)) by (repeat apply Rmult_lt_0_compat; lra). nra. }
  assert (Nul : z = 0 -> x * v = 0) by (intros ->; nra).
  destruct (same_sign m_sign zero) eqn:Q; simpl.
  - assert (m_sign = zero) by (destruct m_sign; easy). subst m_sign. simpl in M.
    destruct (opposite (decomposition_m y j)) eqn:O; simpl; auto.
    assert (L2 : length (decomposition_m y j) = 2%nat) by (unfold decomposition_m; now rewrite
      length_normalized).
    destruct (opposite_root _ L2 O) as (w & W & _ & Left & Right & Sign & _).
    assert (w = r).
    { destruct (Rtotal_order r w) as [T | [-> | T]]; auto; [specialize (Left r T) | specialize (Right r
        T)];
        fold x in Left, Right; unfold opposite in O;
        destruct (sign_of (decomposition_m y j # 0)), (sign_of (decomposition_m y j # 1));
        try discriminate; simpl in *; lra. }
    subst w. assert (N : j <> []) by (destruct j; easy). specialize (Sign j N). fold v in Sign.
    split; auto using right_not_wrong.
  - destruct m_sign, r_sign; try discriminate; simpl in *; split; auto; try easy; intros; nra.
Qed.

(** ** Signs of a quartic at roots of Y *)

Lemma signs_of_end_values x z a b v w : 0 < a -> 0 < b -> a * (x * z * v) = b * w ->
  (x * z <= 0 -> (0 < w -> v < 0) /\ (w < 0 -> 0 < v)) /\
  (0 < x * z -> (0 < w -> 0 < v) /\ (w < 0 -> v < 0)) /\
  (x * z <> 0 -> w = 0 -> v = 0).
Proof.
  intros A B E. set (k := x * z) in *. repeat split; intros.
  - assert (0 < b * w) by nra. destruct (Rlt_or_le v 0); auto. assert (k * v <= 0) by nra. nra.
  - assert (b * w < 0) by nra. destruct (Rlt_or_le 0 v); auto. assert (0 <= k * v) by nra. nra.
  - assert (0 < b * w) by nra. destruct (Rlt_or_le 0 v); auto. assert (k * v <= 0) by nra. nra.
  - assert (b * w < 0) by nra. destruct (Rlt_or_le v 0); auto. assert (0 <= k * v) by nra. nra.
  - subst w. assert (k * v = 0) by nra. apply Rmult_integral in H0. lra.
Qed.

Lemma length_reduced y g : length (reduced y g) = 3%nat.
Proof. unfold reduced. now rewrite length_normalized. Qed.

Lemma ends_of_crossing y before r : length y = 4%nat -> before = negative \/ before = positive ->
  crossing (form_at y) (unit before) r -> exact (y#0) * exact (y#3) <= 0.
Proof.
  intros L B (_ & _ & _ & _ & P & Q). four y L. unfold at_time in *. simpl in *.
  destruct B as [-> | ->]; simpl in *; nra.
Qed.

Lemma quartic_at_crossing_right y before g r : length y = 4%nat -> length g = 5%nat ->
  before = negative \/ before = positive -> crossing (form_at y) (unit before) r ->
  not_wrong (quartic_at_crossing y before g) (form_at g r).
Proof.
  intros Ly Lg B C. pose proof (ends_of_crossing y before r Ly B C) as K.
  pose proof C as (I & Z & _). unfold quartic_at_crossing.
  destruct (certain (sign_inside g)) eqn:Cg; [now apply right_not_wrong, sign_inside_right |].
  destruct (reduction y g r Ly Lg Z) as (c & Pc & E).
  assert (P : 0 < (1 - r) * r) by nra.
  destruct (signs_of_end_values _ _ _ _ _ _ Pc P E) as (H & _). specialize (H K).
  assert (Q : forall s, not_wrong s (form_at (reduced y g) r) -> not_wrong (negate s) (form_at g r)).
  { intros s W. destruct s; simpl in *; tauto. }
  destruct (certain (sign_inside (reduced y g))).
  - apply Q, right_not_wrong, sign_inside_right; auto.
  - assert (N : y <> []) by (destruct y; easy).
    apply Q, (combined_right y (reduced y g) r); auto using length_reduced;
      apply sign_determination_1; auto; unfold decomposition_m, decomposition_r; now rewrite
        length_normalized.
Qed.

Lemma quartic_at_pair_right y d g r : length y = 4%nat -> d <> [] -> length g = 5%nat ->
  convex (form_at y) (form_at d) -> 0 < r < 1 -> form_at y r = 0 -> 0 < form_at y 0 -> 0 < form_at y 1
    ->
  (form_at d r <= 0 -> not_wrong (fst (quartic_at_pair y d g)) (form_at g r)) /\
  (0 <= form_at d r -> not_wrong (snd (quartic_at_pair y d g)) (form_at g r)).
Proof.
  intros Ly Nd Lg C I Z Y0 Y1. unfold quartic_at_pair.
  destruct (certain (sign_inside g)) eqn:Cg; [split; intros _; now apply right_not_wrong,
    sign_inside_right |].
  destruct (reduction y g r Ly Lg Z) as (c & Pc & E).
  assert (K : 0 < exact (y#0) * exact (y#3)).
  { clear -Ly Y0 Y1. four y Ly. unfold at_time in *. simpl in *. apply Rmult_lt_0_compat; lra. }
  assert (P : 0 < (1 - r) * r) by nra.
  destruct (signs_of_end_values _ _ _ _ _ _ Pc P E) as (_ & H & _). specialize (H K).
  assert (Q : forall s, not_wrong s (form_at (reduced y g) r) -> not_wrong s (form_at g r)).
  { intros s W. destruct s; simpl in *; tauto. }
  destruct (certain (sign_inside (reduced y g))).
  - split; intros _; apply Q, right_not_wrong, sign_inside_right; auto.
  - assert (N : y <> []) by (destruct y; easy). set (j := reduced y g) in *.
    assert (Lm : length (decomposition_m y j) = 2%nat) by (unfold decomposition_m; now rewrite
      length_normalized).
    assert (Lr : length (decomposition_r y j) = 2%nat) by (unfold decomposition_r; now rewrite
      length_normalized).
    destruct (sign_determination_2 y d _ r Lm N Nd C I Z) as (M0 & M1).
    destruct (sign_determination_2 y d _ r Lr N Nd C I Z) as (R0 & R1).
    assert (Lj : length j = 3%nat) by apply length_reduced.
    split; intros D; apply Q.
    + exact (proj1 (combined_right y j r _ _ Ly Lj Z I (M0 D) (R0 D))).
    + exact (proj1 (combined_right y j r _ _ Ly Lj Z I (M1 D) (R1 D))).
Qed.

(** ** The root-finding lemma *)

Lemma linear_at_extremum_right d form x : length form = 2%nat -> d <> [] -> 0 < x < 1 -> form_at d x = 0
  ->
  (forall a b, 0 <= a <= 1 -> 0 <= b <= 1 -> a < b -> form_at d a < form_at d b) ->
  sign_is_right (linear_at_extremum d form) (form_at form x).
Proof.
  intros L Nd X Z M. unfold linear_at_extremum.
  destruct (normalized_at form) as (c & C & E).
  assert (Ln : length (normalized form) = 2%nat) by now rewrite length_normalized.
  apply sign_scaled with c; auto. rewrite <- E.
  destruct (opposite (normalized form)) eqn:O; simpl; [| now apply inside_right].
  destruct (opposite_root _ Ln O) as (w & W & Zw & Left & Right & Sign & _).
  specialize (Sign d Nd).
  assert (A : form_at d w < 0 -> w < x).
  { intros D. destruct (Rtotal_order w x) as [| [-> | T]]; auto; [lra |].
    specialize (M x w ltac:(lra) ltac:(lra) T). lra. }
  assert (B : 0 < form_at d w -> x < w).
  { intros D. destruct (Rtotal_order w x) as [T | [-> | T]]; auto; [| lra].
    specialize (M w x ltac:(lra) ltac:(lra) T). lra. }
  assert (N : form_at d w = 0 -> w = x).
  { intros D. destruct (Rtotal_order w x) as [T | [-> | T]]; auto;
      [specialize (M w x ltac:(lra) ltac:(lra) T) | specialize (M x w ltac:(lra) ltac:(lra) T)]; lra. }
  destruct (sign_at_root_of (normalized form) d); simpl in *; auto.
  now rewrite <- N.
Qed.

Theorem root_finding y d x : length y = 4%nat -> length d = 3%nat -> exacts d = exacts (dy y) ->
  0 < x < 1 -> form_at d x = 0 ->
  (forall a b, 0 <= a <= 1 -> 0 <= b <= 1 -> a < b -> form_at d a < form_at d b) ->
  sign_is_right (sign_at_extremum y d) (form_at y x).
Proof.
  intros Ly Ld Ed X Z M. four y Ly. destruct (length_3 d Ld) as (d0 & d1 & d2 & ->).
  assert (N : [d0; d1; d2] <> []) by discriminate.
  assert (D0 : exact d0 < 0).
  { specialize (M 0 x ltac:(lra) ltac:(lra) ltac:(lra)). rewrite Z in M. unfold at_time in M.
    simpl in M. lra. }
  assert (D2 : 0 < exact d2).
  { specialize (M x 1 ltac:(lra) ltac:(lra) ltac:(lra)). rewrite Z in M. unfold at_time in M.
    simpl in M. lra. }
  unfold sign_at_extremum.
  match goal with |- context [negate (linear_at_extremum _ ?f)] => set (f0 := f) end.
  match goal with |- context [if _ then _ else linear_at_extremum _ ?f] => set (f1 := f) end.
  pose proof (linear_at_extremum_right [d0; d1; d2] f0 x eq_refl N X Z M) as Left.
  pose proof (linear_at_extremum_right [d0; d1; d2] f1 x eq_refl N X Z M) as Right.
  assert (E0 : 3 * exact d0 * form_at [y0; y1; y2; y3] x = x * form_at f0 x).
  { unfold f0, at_time in *. injection Ed as E0 E1 E2.
    assert (Eq : 3 * exact d0 * form (exacts [y0; y1; y2; y3]) (1 - x) x =
      x * form (exacts [sub (mul (whole 2) (mul d0 y1)) (mul (whole 3) (mul y0 d1)); sub (mul d0 y2)
        (mul (whole 3) (mul y0 d2))]) (1 - x) x
      + (3 * exact y0 + exact d0 * x) * form (exacts [d0; d1; d2]) (1 - x) x).
    { revert E0 E1 E2. simpl. repeat (progress exacts || rewrite exact_times). simpl. intros -> -> ->.
        ring. }
    rewrite Eq, Z. simpl. ring. }
  assert (E1 : 3 * exact d2 * form_at [y0; y1; y2; y3] x = (1 - x) * form_at f1 x).
  { unfold f1, at_time in *. injection Ed as E0' E1 E2.
    assert (Eq : 3 * exact d2 * form (exacts [y0; y1; y2; y3]) (1 - x) x =
      (1 - x) * form (exacts [sub (mul d2 y1) (mul (whole 3) (mul y3 d0)); sub (mul (whole 2) (mul d2
        y2)) (mul (whole 3) (mul y3 d1))]) (1 - x) x
      + (3 * exact y3 - exact d2 * (1 - x)) * form (exacts [d0; d1; d2]) (1 - x) x).
    { revert E0' E1 E2. simpl. repeat (progress exacts || rewrite exact_times). simpl. intros -> -> ->.
        ring. }
    rewrite Eq, Z. simpl. ring. }
  set (v := form_at [y0; y1; y2; y3] x) in *.
  destruct (linear_at_extremum [d0; d1; d2] f0); simpl in *; try (simpl; nra).
  destruct (linear_at_extremum [d0; d1; d2] f1); simpl in *; auto; nra.
Qed.

End Signs.
