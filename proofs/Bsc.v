(** Bernstein sign classification (include/errbound/bsc.hpp), over every scalar whose operations are
    those of the numbers that it stands for and whose signs are right or uncertain (Bernstein.v).

    Y is a cubic and each G a quartic, as lists of scaled coefficients; f(t) is at_time f t. Results:
        sign_determination_1   the sign of a linear form at the only inner root of Y
        sign_determination_2   at either of two inner roots of a convex Y
        reduction              y0 y3 G = s t J at a root of Y, up to a positive factor
        polynomial_decomposition   M J = - s t R at a root of Y, up to positive factors
        root_finding           the sign of Y at its only inner extremum
        bsc_no     the answer "no": at every root of Y in [0, 1] some G is negative
        bsc_yes    the answer "yes": at some root of Y in [0, 1] every G is positive
    whatever signs stay uncertain. All of the decision's code is restated here, in its order. *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Errbound Require Import Sign Bernstein.
Import ListNotations.
Open Scope R_scope.

(** ** Signs (include/errbound/sign.hpp) *)

Definition certain (s : sign) : bool := negb (same_sign s uncertain).
Definition negate (s : sign) : sign :=
  match s with negative => positive | positive => negative | _ => s end.
Definition times_sign (a b : sign) : sign :=
  match a, b with
  | zero, _ | _, zero => zero
  | uncertain, _ | _, uncertain => uncertain
  | _, _ => if same_sign a b then positive else negative
  end.
Definition possibly_positive (s : sign) : bool := same_sign s positive || same_sign s uncertain.
Definition possibly_negative (s : sign) : bool := same_sign s negative || same_sign s uncertain.
Definition possibly_zero (s : sign) : bool := same_sign s zero || same_sign s uncertain.
Definition certainly_nonnegative (s : sign) : bool := same_sign s zero || same_sign s positive.
Definition certainly_nonpositive (s : sign) : bool := same_sign s zero || same_sign s negative.

(** ** The code *)

Inductive existence := no | yes | maybe_root | maybe_inside.
Definition either (a b : existence) : existence :=
  match a, b with yes, _ | _, yes => yes | no, b => b | a, _ => a end.

(** A "maybe" ends the search. *)
Definition in_turn (a b : existence) : existence := match a with no => b | a => a end.

(** The verdict of class conjunction: signs of all G_i at one root. *)
Definition verdict (root_is_certain : bool) (signs : list sign) : existence :=
  if existsb (same_sign negative) signs then no
  else if negb root_is_certain then maybe_root
  else if forallb (same_sign positive) signs then yes else maybe_inside.

Section Code.

Context {S : scalar}.
Notation exacts := (map (@exact S)).
Notation "p '#' i" := (nth i p (whole 0)) (at level 20).
Implicit Types (y g l d j : list S).

Definition linear_root l : S * S :=
  if same_sign (sign_of (l#0)) positive then (opp (l#1), l#0) else (l#1, opp (l#0)).
Definition opposite l : bool :=
  match sign_of (l#0), sign_of (l#1) with
  | negative, positive | positive, negative => true
  | _, _ => false
  end.
Definition inside l : sign :=
  match sign_of (l#0), sign_of (l#1) with
  | uncertain, _ | _, uncertain => uncertain
  | zero, at1 => at1
  | at0, _ => at0
  end.
(** The sign of the form p at l's root. *)
Definition sign_at_root_of l p : sign := let (s, t) := linear_root l in sign_of (value_at p s t).

(** sign_at_crossing and signs_at_pair of a linear form *)
Definition linear_at_crossing y (before : sign) l : sign :=
  if negb (opposite l) then inside l
  else match sign_at_root_of l y with
       | uncertain => uncertain
       | zero => zero
       | at_r => if same_sign at_r before then sign_of (l#1) else sign_of (l#0)
       end.
Definition linear_at_pair y d l : sign * sign :=
  if negb (opposite l) then (inside l, inside l)
  else
    let at_r := sign_at_root_of l y in
    if same_sign at_r negative then (sign_of (l#0), sign_of (l#1))
    else
      let slope := sign_at_root_of l d in
      let nearer := if same_sign at_r zero then zero else uncertain in
      match slope with
      | negative => (if same_sign at_r positive then sign_of (l#1) else nearer, sign_of (l#1))
      | positive => (sign_of (l#0), if same_sign at_r positive then sign_of (l#0) else nearer)
      | _ => if same_sign slope zero && same_sign at_r zero then (zero, zero) else (uncertain,
        uncertain)
      end.

Definition reduced y g : list S :=
  let e0 := sub (mul (y#0) (g#1)) (mul (g#0) (y#1)) in
  let e1 := sub (mul (y#0) (g#2)) (mul (g#0) (y#2)) in
  let e2 := sub (mul (y#0) (g#3)) (mul (g#0) (y#3)) in
  let e3 := mul (y#0) (g#4) in
  normalized [sub (mul (y#3) e0) (mul e3 (y#0)); sub (mul (y#3) e1) (mul e3 (y#1));
              sub (mul (y#3) e2) (mul e3 (y#2))].

(** M and R of the decomposition *)
Definition decomposition_m y j : list S := normalized [mul (y#0) (j#2); mul (y#3) (j#0)].
Definition decomposition_r y j : list S :=
  let jj := mul (j#0) (j#2) in
  let m0 := mul (y#0) (j#2) in
  let m1 := mul (y#3) (j#0) in
  normalized [sub (sub (mul jj (y#1)) (mul m0 (j#1))) (mul m1 (j#0));
              sub (sub (mul jj (y#2)) (mul m0 (j#2))) (mul m1 (j#1))].

Definition combined (m r : sign) (m_form : list S) j : sign :=
  if negb (same_sign m zero) then negate (times_sign m r)
  else if negb (opposite m_form) then uncertain
  else sign_at_root_of m_form j.

Definition quartic_at_crossing y (before : sign) g : sign :=
  if certain (sign_inside g) then sign_inside g
  else
    let j := reduced y g in
    if certain (sign_inside j) then negate (sign_inside j)
    else
      let m := decomposition_m y j in
      let r := decomposition_r y j in
      negate (combined (linear_at_crossing y before m) (linear_at_crossing y before r) m j).
Definition quartic_at_pair y d g : sign * sign :=
  if certain (sign_inside g) then (sign_inside g, sign_inside g)
  else
    let j := reduced y g in
    if certain (sign_inside j) then (sign_inside j, sign_inside j)
    else
      let m := decomposition_m y j in
      let r := decomposition_r y j in
      let ms := linear_at_pair y d m in
      let rs := linear_at_pair y d r in
      (combined (fst ms) (fst rs) m j, combined (snd ms) (snd rs) m j).

(** The sign of a linear form at the extremum: sign_at of sign_at_extremum. *)
Definition linear_at_extremum d (form : list S) : sign :=
  let l := normalized form in
  if negb (opposite l) then inside l
  else match sign_at_root_of l d with
       | negative => sign_of (l#1)
       | positive => sign_of (l#0)
       | s => s
       end.
Definition sign_at_extremum y d : sign :=
  let three := whole 3 in
  let two := whole 2 in
  let from_left := negate (linear_at_extremum d
    [sub (mul two (mul (d#0) (y#1))) (mul three (mul (y#0) (d#1)));
     sub (mul (d#0) (y#2)) (mul three (mul (y#0) (d#2)))]) in
  if certain from_left then from_left
  else linear_at_extremum d
    [sub (mul (d#2) (y#1)) (mul three (mul (y#3) (d#0)));
     sub (mul two (mul (d#2) (y#2))) (mul three (mul (y#3) (d#1)))].

Definition at_end (y_end : sign) (g : list (list S)) (coefficient : nat) : existence :=
  if negb (possibly_zero y_end) then no
  else verdict (same_sign y_end zero) (map (fun f => sign_of (f#coefficient)) g).

Definition at_crossing y (before : sign) (root_is_certain : bool) (g : list (list S)) : existence :=
  verdict root_is_certain (map (quartic_at_crossing y before) g).

Definition at_pair y d (ends_are_certain : bool) (g : list (list S)) : existence :=
  let d0 := sign_of (d#0) in
  let d2 := sign_of (d#2) in
  if certainly_nonnegative d0 || certainly_nonpositive d2 then no
  else
    let lowest := sign_at_extremum y d in
    if same_sign lowest positive then no
    else
      let roots_are_certain := ends_are_certain && certain d0 && certain d2 && certain lowest in
      either (verdict roots_are_certain (map (fun f => fst (quartic_at_pair y d f)) g))
             (verdict roots_are_certain (map (fun f => snd (quartic_at_pair y d f)) g)).

Definition on_increasing y (g : list (list S)) : existence :=
  let y0 := sign_of (y#0) in
  let y3 := sign_of (y#3) in
  let found := either (at_end y0 g 0) (at_end y3 g 4) in
  if possibly_negative y0 && possibly_positive y3
  then either found (at_crossing y negative (certain y0 && certain y3) g)
  else found.

Definition on_convex y d (g : list (list S)) : existence :=
  let y0 := sign_of (y#0) in
  let y3 := sign_of (y#3) in
  let ends_are_certain := certain y0 && certain y3 in
  let found := either (at_end y0 g 0) (at_end y3 g 4) in
  let found :=
    if same_sign y0 zero then
      let slope := sign_of (y#1) in
      if possibly_negative slope && possibly_positive y3
      then either found (at_crossing (elevated [y#1; y#2; y#3]) negative (ends_are_certain && certain
        slope) g)
      else found
    else if possibly_negative y0 && possibly_positive y3
    then either found (at_crossing y negative ends_are_certain g)
    else found in
  if possibly_positive y0 then
    let found :=
      if same_sign y3 zero then
        let slope := negate (sign_of (y#2)) in
        if possibly_positive slope
        then either found (at_crossing (elevated [y#0; y#1; y#2]) positive (ends_are_certain && certain
          slope) g)
        else found
      else if possibly_negative y3
      then either found (at_crossing y positive ends_are_certain g)
      else found in
    if possibly_positive y3 then either found (at_pair y d ends_are_certain g) else found
  else found.

Definition excluded_by_hull y (g : list (list S)) : bool :=
  certainly_rootless y || existsb (fun f => same_sign (sign_throughout f) negative) g.

(** without_curvature, then of_curvature; `parts` is the answer by splitting Y, whose second
    derivative is given. *)
Definition on_whole_part y (g : list (list S)) (curvature : sign) (parts : list S -> existence) :
  existence :=
  if excluded_by_hull y g then no
  else
    let d := derivative y in
    match sign_inside d with
    | positive => on_increasing y g
    | negative => on_increasing (map opp y) g
    | zero => if possibly_zero (sign_of (y#0)) then maybe_root else no
    | uncertain =>
        let second := derivative d in
        let curvature := if negb (certain curvature) && negb (opposite second) then inside second else
          curvature in
        match curvature with
        | positive => on_convex y d g
        | negative => on_convex (map opp y) (map opp d) g
        | _ => parts second
        end
    end.

(** A part beside the inflection: its curvature is negative or positive, so that it is not split. *)
Definition on_curved y (g : list (list S)) (curvature : sign) : existence :=
  on_whole_part y g curvature (fun _ => maybe_root).

(** without_halving and by_halving. The code keeps the parts that wait in an array, the earliest last,
    and stops at the first answer that is not "no": the recursion here takes them in that order. *)
Fixpoint on_part y (g : list (list S)) (halvings_left : nat) : existence :=
  on_whole_part y g uncertain (fun second =>
    if opposite second then
      let (v, w) := linear_root second in
      let parts_of f := let (a, b) := split f v w in (normalized a, normalized b) in
      either (on_curved (fst (parts_of y)) (map (fun f => fst (parts_of f)) g) (sign_of (second#0)))
             (on_curved (snd (parts_of y)) (map (fun f => snd (parts_of f)) g) (sign_of (second#1)))
    else match halvings_left with
      | O => maybe_root
      | Datatypes.S more =>
          let parts_of f := let (a, b) := halves f in (normalized a, normalized b) in
          in_turn (on_part (fst (parts_of y)) (map (fun f => fst (parts_of f)) g) more)
                  (on_part (snd (parts_of y)) (map (fun f => snd (parts_of f)) g) more)
      end).

Definition max_halvings : nat := 6.
Definition root_with_nonnegative y (g : list (list S)) : existence :=
  let cubic := normalized y in
  if certainly_rootless cubic then no else on_part cubic (map normalized g) max_halvings.


(** ** Cubics and their derivatives *)

Notation form_at := (@at_time S).
Notation dy y := (derivative y).
Notation ddy y := (derivative (derivative y)).

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


(** What is used of a curve without inflection: it lies above its tangents, and its slope increases. *)
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
    assert (0 < 2 * (l0 * (1 - a) + l1 * a) + (l0 * (1 - b) + l1 * b)).
    { destruct N as (N0 & N1 & [P | P]).
      - assert (0 <= l1 * (2 * a + b)) by (apply Rmult_le_pos; lra).
        assert (0 < l0 * (3 - 2 * a - b)) by (apply Rmult_lt_0_compat; lra). lra.
      - assert (0 <= l0 * (3 - 2 * a - b)) by (apply Rmult_le_pos; lra).
        assert (0 < l1 * (2 * a + b)) by (apply Rmult_lt_0_compat; lra). lra. }
    assert (0 < (b - a) * (b - a) * (2 * (l0 * (1 - a) + l1 * a) + (l0 * (1 - b) + l1 * b)))
      by (apply Rmult_lt_0_compat; auto). lra.
  - pose proof (trapezoid y a b L) as T. rewrite !V in T.
    assert (0 < l0 * (1 - a) + l1 * a + (l0 * (1 - b) + l1 * b)).
    { destruct N as (N0 & N1 & [P | P]).
      - assert (0 <= l1 * (a + b)) by (apply Rmult_le_pos; lra).
        assert (0 < l0 * (2 - a - b)) by (apply Rmult_lt_0_compat; lra). lra.
      - assert (0 <= l0 * (2 - a - b)) by (apply Rmult_le_pos; lra).
        assert (0 < l1 * (a + b)) by (apply Rmult_lt_0_compat; lra). lra. }
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

(** The root r, at which Y leaves the sign of sigma. *)
Definition crossing (Y : R -> R) (sigma r : R) : Prop :=
  0 < r < 1 /\ Y r = 0 /\ (forall t, 0 < t < r -> 0 < sigma * Y t) /\ (forall t, r < t < 1 -> sigma * Y
    t < 0)
  /\ 0 <= sigma * Y 0 /\ sigma * Y 1 <= 0.

(** Y(0) <= 0, then Y(1) > 0 and there is one inner root; likewise from the other end. *)
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

(** An opposite form has its root r inside; what sign_at_root_of says there. *)
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
    + replace (_ + _) with (- (k * (r - t))) by ring. assert (0 < k * (r - t)) by (apply
        Rmult_lt_0_compat; lra). lra.
  - intros t T. rewrite At. simpl.
    destruct H as [(_ & -> & -> & ->) | (_ & -> & -> & ->)]; simpl; rewrite Ev, Er.
    + replace (_ + _) with (- (k * (t - r))) by ring. assert (0 < k * (t - r)) by (apply
        Rmult_lt_0_compat; lra). lra.
    + replace (_ + _) with (k * (t - r)) by ring. apply Rmult_lt_0_compat; lra.
  - intros p N. unfold sign_at_root_of. rewrite R. pose proof (sign_right S (value_at p v w)) as P.
    rewrite value_at_form in P. destruct (value_near_root p (exact v) (exact w) N V W) as (c & C & E).
    rewrite E in P. eapply sign_scaled; eauto.
  - exists v, w. auto.
Qed.

Lemma inside_right l t : length l = 2%nat -> opposite l = false -> 0 < t < 1 ->
  sign_is_right (inside l) (form_at l t).
Proof.
  intros L O T. destruct (length_2 l L) as (l0 & l1 & ->). unfold opposite, inside, at_time in *. simpl
    in *.
  pose proof (sign_right S l0) as A. pose proof (sign_right S l1) as B.
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

(** At the root r left of the extremum, and at the one right of it; a double root is both. *)
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
    - intros Y R. destruct (Req_dec x r) as [| H]; auto. specialize (Tx H). specialize (Ty H).
      destruct (Rlt_or_le x r); [assert (0 <= form_at d r * (x - r)) by nra |
                                 assert (0 <= form_at d x * (r - x)) by nra]; lra. }
  assert (Rising : 0 < form_at d x -> (0 < form_at y x -> r < x) /\ (form_at d r <= 0 -> r < x)
                   /\ (form_at y x = 0 -> 0 <= form_at d r -> x = r)).
  { intros D. split; [| split].
    - intros Y. assert (x <> r) by (intros ->; lra). specialize (Tx H).
      destruct (Rlt_or_le r x); auto. assert (0 <= form_at d x * (r - x)) by nra. lra.
    - intros R. apply Md; lra.
    - intros Y R. destruct (Req_dec x r) as [| H]; auto. specialize (Tx H). specialize (Ty H).
      destruct (Rlt_or_le x r); [assert (0 <= form_at d x * (r - x)) by nra |
                                 assert (0 <= form_at d r * (x - r)) by nra]; lra. }
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
  unfold reduced. match goal with |- context [normalized ?p] => destruct (normalized_at p) as (c & C &
    E) end.
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

(** sign J from those of M and R: never a wrong strict sign; and right if M's sign is certain. *)
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
  { specialize (M 0 x ltac:(lra) ltac:(lra) ltac:(lra)). rewrite Z in M. unfold at_time in M. simpl in
      M. lra. }
  assert (D2 : 0 < exact d2).
  { specialize (M x 1 ltac:(lra) ltac:(lra) ltac:(lra)). rewrite Z in M. unfold at_time in M. simpl in
      M. lra. }
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


(** ** Answers *)

Implicit Types (gs : list (list S)).
Notation five gs := (Forall (fun g : list S => length g = 5%nat) gs).

Definition excluded gs (t : R) : Prop := Exists (fun g => form_at g t < 0) gs.
Definition all_positive gs (t : R) : Prop := Forall (fun g => 0 < form_at g t) gs.

(** What an answer promises of a root, and of a whole part. *)
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
    apply existsb_exists in E. destruct E as (s & I & N). apply in_map_iff in I. destruct I as (g & <- &
      I).
    apply Exists_exists. exists g. split; auto. rewrite Forall_forall in H. specialize (H g I).
    destruct (f g); easy.
  - destruct (existsb (same_sign negative) (map f gs)); [easy |]. destruct (negb c); [easy |].
    destruct (forallb (same_sign positive) (map f gs)) eqn:E; [intros _ | easy]. rewrite forallb_forall
      in E.
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
  { apply verdict_right. apply Forall_forall. intros g I. rewrite Forall_forall in F. specialize (F g
      I).
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

(** Certain strict signs of two ends: a root between them. *)
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
  { intros P E. unfold both in P. apply andb_prop in P. pose proof (verdict_yes _ _ E) as C. apply
      andb_prop in C.
    pose proof (proj1 (certainly (y#0) (proj1 C)) (proj1 P)). pose proof (proj2 (certainly (y#3) (proj2
      C)) (proj2 P)).
    destruct (between y 0 1) as (r & I & Z); [lra | rewrite S0, S3; nra |].
    assert (r <> 0) by (intros ->; lra). assert (r <> 1) by (intros ->; lra).
    exists r. split; [lra |]. split; auto.
    assert (Ir : 0 < r < 1) by lra.
    apply (proj2 (at_crossing_right y negative (certain (sign_of (y#0)) && certain (sign_of (y#3))) gs r
      L F (or_introl eq_refl) (Cross r Ir Z))). exact E. }
  assert (Inner : forall t, 0 <= t <= 1 -> form_at y t = 0 -> t <> 0 -> t <> 1 ->
    both = true).
  { intros t T Z T0 T1. pose proof (M 0 t). pose proof (M t 1).
    unfold both. destruct (possible (y#0)) as (P & _). destruct (possible (y#3)) as (_ & Q & _). rewrite
      P, Q; auto; lra. }
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
  { intros P Q. destruct (between d 0 1) as (x & X & Z); [lra | nra |]. exists x.
    assert (x <> 0) by (intros ->; lra). assert (x <> 1) by (intros ->; lra). split; auto; lra. }
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
    { destruct (Req_dec x t) as [-> | H]; [lra |]. specialize (T x t ltac:(lra) ltac:(lra) H). rewrite
        Zx in T. lra. }
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
    { rewrite D2. destruct S2 as (_ & _ & A). destruct (sign_of (d#0)), (sign_of (d#2)); try
        discriminate; auto. }
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


(** Y without its root at an end. *)
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
  (* both ends of a part, where the code asks for a crossing *)
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
      destruct (between y 0 1) as (r & I & Z); [lra | rewrite S0, S3; nra |].
      assert (r <> 0) by (intros ->; lra). assert (r <> 1) by (intros ->; lra). assert (Ir : 0 < r < 1)
        by lra.
      destruct (rising_crossing _ _ r C Ir Z ltac:(lra)) as (K & _).
      exists r. split; auto. split; auto.
      exact (proj2 (at_crossing_right y negative ec gs r L F (or_introl eq_refl) K) H). }
    assert (Positive : possibly_positive (sign_of (y#0)) = true -> possibly_negative (sign_of (y#3)) =
      true ->
      at_crossing y positive ec gs = yes -> answer).
    { intros P Q H. destruct (Ec (verdict_yes _ _ H)) as (C0 & C3).
      pose proof (proj2 (certainly _ C0) P). pose proof (proj1 (certainly _ C3) Q).
      destruct (between y 0 1) as (r & I & Z); [lra | rewrite S0, S3; nra |].
      assert (r <> 0) by (intros ->; lra). assert (r <> 1) by (intros ->; lra). assert (Ir : 0 < r < 1)
        by lra.
      destruct (falling_crossing _ _ r C Ir Z ltac:(lra)) as (K & _).
      exists r. split; auto. split; auto.
      exact (proj2 (at_crossing_right y positive ec gs r L F (or_intror eq_refl) K) H). }
    assert (Start : same_sign (sign_of (y#0)) zero = true ->
      possibly_negative (sign_of (y#1)) && possibly_positive (sign_of (y#3)) = true ->
      at_crossing (elevated [y#1; y#2; y#3]) negative (ec && certain (sign_of (y#1))) gs = yes ->
        answer).
    { intros Q P H. apply andb_prop in P. pose proof (verdict_yes _ _ H) as K. apply andb_prop in K.
      destruct K as (Ce & C1). destruct (Ec Ce) as (C0 & C3).
      pose proof (proj1 (certainly _ C1) (proj1 P)) as N1. pose proof (proj2 (certainly _ C3) (proj2 P))
        as N3.
      assert (Y0 : form_at y 0 = 0)
        by (rewrite S0; pose proof (signs_of (y#0)) as (_ & A & _); destruct (sign_of (y#0)); easy ||
          auto).
      set (e := elevated [y#1; y#2; y#3]) in *.
      assert (E0 : form_at e 0 = exact (y#1)) by (now rewrite at_start).
      assert (E1 : form_at e 1 = exact (y#3)) by (now rewrite (at_finish e 3)).
      destruct (between e 0 1) as (r & I & Z); [lra | rewrite E0, E1; nra |].
      assert (r <> 0) by (intros ->; lra). assert (r <> 1) by (intros ->; lra). assert (Ir : 0 < r < 1)
        by lra.
      assert (Zy : form_at y r = 0) by (rewrite <- (without_start y r L Y0); fold e; rewrite Z; ring).
      destruct (rising_crossing _ _ r C Ir Zy ltac:(lra)) as (Ky & _).
      destruct (crossing_without_start y _ r L C D0 Y0 Ky) as (_ & Ke).
      exists r. split; auto. split; auto.
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
      destruct (between e 0 1) as (r & I & Z); [lra | rewrite E0, E1; nra |].
      assert (r <> 0) by (intros ->; lra). assert (r <> 1) by (intros ->; lra). assert (Ir : 0 < r < 1)
        by lra.
      assert (Zy : form_at y r = 0) by (rewrite <- (without_finish y r L Y1); fold e; rewrite Z; ring).
      destruct (falling_crossing _ _ r C Ir Zy ltac:(lra)) as (Ky & _).
      destruct (crossing_without_finish y _ r L C D1 Y1 Ky) as (_ & Ke).
      exists r. split; auto. split; auto.
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


(** ** A part of the step *)

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

Lemma on_whole_part_sound y gs curvature parts : length y = 4%nat -> five gs ->
  signs_inside curvature (exacts (ddy y)) ->
  (opposite (ddy y) = true \/ curvature = uncertain -> sound (parts (ddy y)) y gs) ->
  curvature <> zero -> sound (on_whole_part y gs curvature parts) y gs.
Proof.
  intros L F K Parts Nz. unfold on_whole_part. destruct (excluded_by_hull y gs) eqn:H.
  { split; [| easy]. intros _ t T Z. apply orb_prop in H. destruct H as [H | H].
    - now apply rootless_hull with (t := t) in H.
    - apply existsb_exists in H. destruct H as (g & I & N). apply Exists_exists. exists g. split; auto.
      pose proof (sign_throughout_right g t T) as R. destruct (sign_throughout g); easy. }
  destruct (derivative_opp y L) as (Eo & Eoo).
  assert (Lo : length (map opp y) = 4%nat) by now rewrite map_length.
  pose proof (sign_inside_coefficients (dy y)) as Slope.
  destruct (sign_inside (dy y)).
  - apply sound_opp, on_increasing_sound; auto. apply monotone_by_signs; auto. rewrite Eo. exact Slope.
  - simpl in Slope. split.
    + intros E t T Z. exfalso. assert (Y : form_at y t = exact (y#0)).
      { rewrite <- at_start by now destruct y. pose proof (simpson y 0 t L) as Q.
        assert (Zero : forall x, form_at (dy y) x = 0).
        { intros x. unfold at_time. clear -Slope. induction Slope as [| a h <- _ IH]; simpl; [easy |].
            rewrite IH. ring. }
        rewrite !Zero in Q. lra. }
      rewrite Z in Y. pose proof (signs_of (y#0)) as (A & _ & B).
      destruct (sign_of (y#0)); simpl in E; try discriminate; [specialize (A eq_refl) | specialize (B
        eq_refl)]; lra.
    + now destruct (possibly_zero _).
  - apply on_increasing_sound; auto. now apply monotone_by_signs.
  - set (c := if negb (certain curvature) && negb (opposite (ddy y)) then inside (ddy y) else
      curvature).
    assert (Ls : length (ddy y) = 2%nat) by now four y L.
    assert (Kc : signs_inside c (exacts (ddy y))).
    { unfold c. destruct (negb (certain curvature)), (opposite (ddy y)) eqn:O; simpl; auto. now apply
        inside_signs. }
    assert (Ld : length (dy y) = 3%nat) by now four y L.
    assert (P : c = zero \/ c = uncertain -> sound (parts (ddy y)) y gs).
    { intros C. apply Parts. unfold c in C. destruct curvature, (opposite (ddy y)); simpl in C; auto;
        intuition discriminate. }
    destruct c eqn:Ec; auto.
    + apply sound_opp, on_convex_sound; auto; try (now rewrite map_length); [now rewrite exacts_opp, Eo
        |].
      replace (form_at (map opp (dy y))) with (form_at (dy (map opp y)))
        by (unfold at_time; now rewrite exacts_opp, Eo).
      apply convex_by_signs; auto. rewrite Eoo. exact Kc.
    + apply on_convex_sound; auto. now apply convex_by_signs.
Qed.

Lemma on_curved_sound y gs curvature : length y = 4%nat -> five gs ->
  signs_inside curvature (exacts (ddy y)) -> curvature <> zero -> sound (on_curved y gs curvature) y gs.
Proof. intros L F K N. apply on_whole_part_sound; auto. now split. Qed.

(** q is p on [a, b], times a positive number. *)
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
  intros N K. destruct p as [| a l]; [easy |]. unfold at_time. cbn [map]. rewrite form_homogeneous,
    map_length.
  simpl. now rewrite Nat.sub_0_r.
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
      { apply No0; auto; [| rewrite E0, <- X, Z; ring]. split; [apply Rmult_le_pos; [lra | left; apply
          Rinv_0_lt_compat; lra] |].
        apply Rmult_le_reg_r with m; [lra |]. replace (t / m * m) with t by (field; lra). lra. }
      unfold excluded in *. apply Exists_exists in Ex. destruct Ex as (f & I & N). apply in_map_iff in
        I.
      destruct I as (g & <- & I). apply Exists_exists. exists g. split; auto. rewrite X. now apply Sign.
    + assert (X : t = m + (1 - m) * ((t - m) / (1 - m))) by (field; lra).
      assert (Ex : excluded (map f1 gs) ((t - m) / (1 - m))).
      { apply No1; auto; [| rewrite E1, <- X, Z; ring]. split; [apply Rmult_le_pos; [lra | left; apply
          Rinv_0_lt_compat; lra] |].
        apply Rmult_le_reg_r with (1 - m); [lra |]. replace ((t - m) / (1 - m) * (1 - m)) with (t - m)
          by (field; lra). lra. }
      unfold excluded in *. apply Exists_exists in Ex. destruct Ex as (f & I & N). apply in_map_iff in
        I.
      destruct I as (g & <- & I). apply Exists_exists. exists g. split; auto. rewrite X. now apply Sign.
  - intros E. destruct (Yes E) as [Y | Y].
    + destruct (Yes0 Y) as (t & T & Z & P). exists (0 + (m - 0) * t). split; [nra |]. split.
      * rewrite E0 in Z. apply Rmult_integral in Z. destruct Z; lra.
      * unfold all_positive in *. rewrite Forall_map in P. rewrite Forall_forall in *. intros g I. apply
          Sign; auto.
    + destruct (Yes1 Y) as (t & T & Z & P). exists (m + (1 - m) * t). split; [nra |]. split.
      * rewrite E1 in Z. apply Rmult_integral in Z. destruct Z; lra.
      * unfold all_positive in *. rewrite Forall_map in P. rewrite Forall_forall in *. intros g I. apply
          Sign; auto.
Qed.

(** The second derivative of a part. *)
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
    assert (Ls : length (ddy y) = 2%nat) by now four y L.
    destruct (opposite (ddy y)) eqn:O.
    - destruct (opposite_root _ Ls O) as (m & M & Zm & _ & _ & _ & v & w & E & V & W & Em). rewrite E.
      set (parts_of := fun f : list S => let (a, b) := split f v w in (normalized a, normalized b)).
      assert (P : forall p, length p = 4%nat \/ length p = 5%nat ->
        is_part p (fst (parts_of p)) 0 m /\ is_part p (snd (parts_of p)) m 1).
      { intros p Lp. rewrite Em. destruct (split_parts p v w Lp V W) as (A & B). unfold parts_of.
        destruct (split p v w). split; now apply part_normalized. }
      destruct (Five gs m parts_of P F) as (F0 & F1 & G).
      destruct (P y (or_introl L)) as (P0 & P1).
      assert (L0 := proj1 P0). assert (L1 := proj1 P1). rewrite L in L0, L1.
      destruct (second_of_part y _ 0 m L P0) as (c0 & C0 & S0).
      destruct (second_of_part y _ m 1 L P1) as (c1 & C1 & S1).
      assert (At0 : form_at (ddy y) 0 = exact (ddy y # 0)) by (apply at_start; now destruct (ddy y)).
      assert (At1 : form_at (ddy y) 1 = exact (ddy y # 1)) by now apply at_finish.
      assert (K0 : 0 < c0 * ((m - 0) * (m - 0))) by (repeat apply Rmult_lt_0_compat; lra).
      assert (K1 : 0 < c1 * ((1 - m) * (1 - m))) by (repeat apply Rmult_lt_0_compat; lra).
      apply (sound_parts _ (on_curved (fst (parts_of y)) (map (fun f => fst (parts_of f)) gs) (sign_of
        (ddy y # 0)))
        (on_curved (snd (parts_of y)) (map (fun f => snd (parts_of f)) gs) (sign_of (ddy y # 1)))
        y gs (fst (parts_of y)) (snd (parts_of y)) (fun f => fst (parts_of f)) (fun f => snd (parts_of
          f)) m); auto.
      + apply on_curved_sound; auto.
        * rewrite (second_of_cubic _ L0), !S0.
          replace (0 + (m - 0) * 0) with 0 by ring. replace (0 + (m - 0) * 1) with m by ring. rewrite
            Zm, At0.
          rewrite <- !Rmult_assoc. rewrite (Rmult_assoc c0).
          apply (strict_beside_0 _ _ _ (proj1 (opposite_signs _ O)) (sign_right S (ddy y # 0)) K0).
        * destruct (proj1 (opposite_signs _ O)) as [-> | ->]; discriminate.
      + apply on_curved_sound; auto.
        * rewrite (second_of_cubic _ L1), !S1.
          replace (m + (1 - m) * 0) with m by ring. replace (m + (1 - m) * 1) with 1 by ring. rewrite
            Zm, At1.
          rewrite <- !Rmult_assoc. rewrite (Rmult_assoc c1).
          apply (strict_beside_0 _ _ _ (proj2 (opposite_signs _ O)) (sign_right S (ddy y # 1)) K1).
        * destruct (proj2 (opposite_signs _ O)) as [-> | ->]; discriminate.
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
    apply Exists_exists in No. destruct No as (f & I & P). apply in_map_iff in I. destruct I as (g & <-
      & I).
    apply Exists_exists. exists g. split; auto. now apply N.
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
    rewrite Forall_map. eapply Forall_impl; [| exact F]. simpl. intros g Lg. now rewrite
      length_normalized.
Qed.

(** A "no" is never wrong. *)
Theorem bsc_no y gs t : length y = 4%nat -> five gs -> root_with_nonnegative y gs = no ->
  0 <= t <= 1 -> form_at y t = 0 -> exists g, In g gs /\ form_at g t < 0.
Proof.
  intros L F E T Z. apply Exists_exists. now apply (proj1 (root_with_nonnegative_sound y gs L F)).
Qed.

(** Neither is a "yes". *)
Theorem bsc_yes y gs : length y = 4%nat -> five gs -> root_with_nonnegative y gs = yes ->
  exists t, 0 <= t <= 1 /\ form_at y t = 0 /\ forall g, In g gs -> 0 < form_at g t.
Proof.
  intros L F E. destruct (proj2 (root_with_nonnegative_sound y gs L F) E) as (t & T & Z & P).
  exists t. repeat split; try tauto. now apply Forall_forall.
Qed.

End Code.
