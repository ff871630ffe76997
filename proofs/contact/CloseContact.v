(** Roots that nearly coincide (ccd/exact/close_contact.hpp), and both stages in integers (ccd/exact/integers.cpp):
    certain answers are right. Estimates of positions are arbitrary functions. Results:
        as_many_changes, opposite_inside   which subintervals of an interval have all its roots
        sub_part_right         coefficients are those of Y on the subinterval, times a positive number
        inside_from_right      signs of G_i that are certain throughout an interval are right
        by_narrowing_right     the meaning of the loop's answers
        three_close_parts_wait, close_contact_ends   at most three intervals wait, and the loop ends
        close_contact_right    collides: Y = 0 and all G_i > 0 at some t in [0, 1]; separate: at none in (0, 1)
                               except multiple roots of Y
        decided_inside         if interior_contact is undecided, separate means nowhere in [0, 1]
        face_to_the_end_right, edges_to_the_end_right   certain answers of decide_to_the_end are right
        close_widths, narrowed_fits   all numbers fit their types *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool Classical.
From Flocq Require Import Core.
From Errbound Require Import Sign Bernstein Subdivision Contact VertexEdge Decisions AxisUnits CubicRoots InteriorContact.
From Errbound Require BoundedInteger FixedWidths.
Import ListNotations.
Open Scope R_scope.

(** ** Subintervals of a cubic *)

(** The form after substitution of s0 s + s1 t for s and t0 s + t1 t for t. *)
Definition substituted (y : list R) (s0 s1 t0 t1 : R) : list R :=
  match y with
  | [y0; y1; y2; y3] =>
      [y0 * s0 ^ 3 + y1 * (s0 ^ 2 * t0) + y2 * (s0 * t0 ^ 2) + y3 * t0 ^ 3;
       3 * y0 * (s0 ^ 2 * s1) + y1 * (2 * s0 * s1 * t0 + s0 ^ 2 * t1) +
         y2 * (s1 * t0 ^ 2 + 2 * s0 * t0 * t1) + 3 * y3 * (t0 ^ 2 * t1);
       3 * y0 * (s0 * s1 ^ 2) + y1 * (s1 ^ 2 * t0 + 2 * s0 * s1 * t1) +
         y2 * (2 * s1 * t0 * t1 + s0 * t1 ^ 2) + 3 * y3 * (t0 * t1 ^ 2);
       y0 * s1 ^ 3 + y1 * (s1 ^ 2 * t1) + y2 * (s1 * t1 ^ 2) + y3 * t1 ^ 3]
  | _ => []
  end.
Lemma substituted_form y s0 s1 t0 t1 s t : length y = 4%nat ->
  form (substituted y s0 s1 t0 t1) s t = form y (s0 * s + s1 * t) (t0 * s + t1 * t).
Proof. intros L. four y L. simpl. ring. Qed.

(** The form on [a, b]. *)
Definition part_of (y : list R) (a b : R) : list R := substituted y (1 - a) (1 - b) a b.
Lemma part_of_length y a b : length y = 4%nat -> length (part_of y a b) = 4%nat.
Proof. intros L. now four y L. Qed.
Lemma part_of_at y a b u : length y = 4%nat -> at_ (part_of y a b) u = at_ y (a + u * (b - a)).
Proof. intros L. unfold at_, part_of. rewrite substituted_form by easy. f_equal; ring. Qed.
Lemma part_of_part y a b c d : length y = 4%nat ->
  part_of (part_of y a b) c d = part_of y (a + c * (b - a)) (a + d * (b - a)).
Proof. intros L. four y L. unfold part_of, substituted. apply same_four; ring. Qed.
Lemma part_of_all y : length y = 4%nat -> part_of y 0 1 = y.
Proof. intros L. four y L. unfold part_of, substituted. apply same_four; ring. Qed.
Lemma substituted_scaled k y s0 s1 t0 t1 : length y = 4%nat ->
  substituted (map (Rmult k) y) s0 s1 t0 t1 = map (Rmult k) (substituted y s0 s1 t0 t1).
Proof. intros L. four y L. unfold substituted. cbn [map]. apply same_four; ring. Qed.

Lemma discriminant_substituted y s0 s1 t0 t1 : length y = 4%nat ->
  discriminant (substituted y s0 s1 t0 t1) = (s0 * t1 - s1 * t0) ^ 6 * discriminant y.
Proof. intros L. four y L. unfold discriminant, hessian, substituted. cbn [c0 c1 c2]. ring. Qed.
Lemma discriminant_part y a b : length y = 4%nat -> discriminant (part_of y a b) = (b - a) ^ 6 * discriminant y.
Proof. intros L. unfold part_of. rewrite discriminant_substituted by easy. f_equal. f_equal. ring. Qed.
Lemma changes_scaled k y : 0 < k -> inner_sign_changes (map (Rmult k) y) = inner_sign_changes y.
Proof.
  intros K. unfold inner_sign_changes. rewrite map_map. f_equal. apply map_ext. intros x.
  rewrite sign_product, (sign_positive k K). cases_of_sign x; easy.
Qed.

Lemma zeros_part y a b : Forall (eq 0) y -> Forall (eq 0) (part_of y a b).
Proof.
  intros F. unfold part_of, substituted. destruct y as [| y0 [| y1 [| y2 [| y3 [|]]]]]; auto.
  repeat match goal with H : Forall _ (_ :: _) |- _ => inversion_clear H end. subst.
  repeat constructor; ring.
Qed.
Lemma moving_part y a b : length y = 4%nat -> a < b -> ~ Forall (eq 0) y -> ~ Forall (eq 0) (part_of y a b).
Proof.
  intros L O N F. apply N.
  assert (E : part_of (part_of y a b) (- a / (b - a)) ((1 - a) / (b - a)) = y).
  { rewrite part_of_part by easy. rewrite <- (part_of_all y L) at 2. f_equal; field; lra. }
  rewrite <- E. now apply zeros_part.
Qed.
Lemma at_part y a b t : length y = 4%nat -> a < b -> at_ y t = at_ (part_of y a b) ((t - a) / (b - a)).
Proof. intros L O. rewrite part_of_at by easy. f_equal. field. lra. Qed.
Lemma place_in a b t : a < b -> (a < t < b <-> 0 < (t - a) / (b - a) < 1).
Proof.
  intros O. assert (E : (t - a) / (b - a) * (b - a) = t - a) by (field; lra).
  set (u := (t - a) / (b - a)) in *. split; intros (T & U).
  - split; apply Rmult_lt_reg_r with (b - a); lra.
  - apply (Rmult_lt_compat_r (b - a)) in T, U; lra.
Qed.

(** Signs just inside the ends of a subinterval. *)
Notation changes_in y a b := (inner_sign_changes (part_of y a b)).
Lemma signs_in y a b : length y = 4%nat -> a < b -> ~ Forall (eq 0) y -> let c := changes_in y a b in
  sign_after (first c) (at_ y) a /\ sign_before (if opposite c then opposed (first c) else first c) (at_ y) b /\
  strict (first c).
Proof.
  intros L O N c. destruct (changes_first _ (part_of_length y a b L) (moving_part y a b L O N)) as ((d & D & A) & (e & D' & B) & F).
  fold c in A, B, F. split; [| split; auto].
  - exists (d * (b - a)). split; [apply Rmult_lt_0_compat; lra |]. intros t T. rewrite (at_part y a b) by easy.
    apply A. assert (E : (t - a) / (b - a) * (b - a) = t - a) by (field; lra).
    split; apply Rmult_lt_reg_r with (b - a); lra.
  - exists (e * (b - a)). split; [apply Rmult_lt_0_compat; lra |]. intros t T. rewrite (at_part y a b) by easy.
    apply B. assert (E : (t - a) / (b - a) * (b - a) = t - a) by (field; lra).
    split; apply Rmult_lt_reg_r with (b - a); lra.
Qed.
Lemma none_in y a b t : length y = 4%nat -> a < b -> ~ Forall (eq 0) y -> count (changes_in y a b) = 0%nat ->
  a < t < b -> at_ y t <> 0.
Proof.
  intros L O N C T. destruct (no_changes _ (part_of_length y a b L) C) as [F | F].
  - now destruct (moving_part y a b L O N).
  - rewrite (at_part y a b) by easy. apply F. now apply (place_in a b t O).
Qed.
Lemma one_in y a b Q : length y = 4%nat -> a < b -> count (changes_in y a b) = 1%nat ->
  crosses_once a b (at_ y) Q.
Proof.
  intros L O C. destruct (one_change_crosses _ (part_of_length y a b L) C) as (l0 & l1 & q & One).
  exists (l0 - l1 * a / (b - a)), (l1 / (b - a)), (fun t => q ((t - a) / (b - a))). intros t T.
  apply (proj1 (place_in a b t O)) in T. destruct (One _ T) as (V & P & N).
  split; [rewrite (at_part y a b t L O), V; field; lra |]. split; auto. intros Z. destruct (N Z).
Qed.
Lemma root_in (three : bool) y a b : length y = 4%nat -> a < b -> (three = true -> 0 < discriminant y) ->
  any_root three (changes_in y a b) = true -> exists t, a < t < b /\ at_ y t = 0.
Proof.
  intros L O D A. pose proof (part_of_length y a b L) as Lp.
  assert (Ru : exists u, 0 < u < 1 /\ at_ (part_of y a b) u = 0).
  { unfold any_root in A. apply orb_prop in A. destruct A as [Op | A]; [now apply odd_changes |].
    apply andb_prop in A. destruct A as (-> & C). apply Nat.ltb_lt in C. apply any_change; auto.
    rewrite discriminant_part by easy. apply Rmult_lt_0_compat; auto. apply pow_lt. lra. }
  destruct Ru as (u & U & Z). exists (a + u * (b - a)). rewrite part_of_at in Z by easy. split; auto.
  assert (0 < u * (b - a)) by (apply Rmult_lt_0_compat; lra).
  assert (0 < (1 - u) * (b - a)) by (apply Rmult_lt_0_compat; lra). lra.
Qed.

(** ** Subintervals together have no more sign changes than their union, and one less if they are split at a simple
    root *)

Lemma split_changes y p : length y = 4%nat -> 0 < p < 1 ->
  (count (changes_in y 0 p) + count (changes_in y p 1) <= count (inner_sign_changes y))%nat /\
  (0 < discriminant y -> at_ y p = 0 ->
    (count (changes_in y 0 p) + count (changes_in y p 1) < count (inner_sign_changes y))%nat).
Proof.
  intros L (P & V). set (v := 1 - p) in *. assert (0 < v) as Pv by (unfold v; lra). clear V.
  assert (D0 := discriminant_part y 0 p L). four y L.
  set (ab := 3 * v * y0 + p * y1). set (bc := v * y1 + p * y2). set (cd := v * y2 + 3 * p * y3).
  set (abc := v * ab + p * bc). set (bcd := v * bc + p * cd). set (m := v / 3 * abc + p / 3 * bcd).
  assert (El : part_of [y0; y1; y2; y3] 0 p = [y0; ab; abc; m]).
  { unfold part_of, substituted, m, abc, bcd, ab, bc, cd, v. apply same_four; field. }
  assert (Er : part_of [y0; y1; y2; y3] p 1 = [m; bcd; cd; y3]).
  { unfold part_of, substituted, m, abc, bcd, ab, bc, cd, v. apply same_four; field. }
  assert (Em : at_ [y0; y1; y2; y3] p = m).
  { unfold at_, m, abc, bcd, ab, bc, cd, v. simpl. field. }
  assert (Ed : m = 0 -> 0 < discriminant [y0; y1; y2; y3] -> abc <> 0).
  { intros Zm D Za. rewrite El, Za, Zm in D0.
    replace (discriminant [y0; ab; 0; 0]) with 0 in D0 by (unfold discriminant, hessian; cbn [c0 c1 c2]; ring).
    assert (0 < (p - 0) ^ 6 * discriminant [y0; y1; y2; y3]) by (apply Rmult_lt_0_compat; auto; apply pow_lt; lra).
    lra. }
  assert (C := parts_change y0 y1 y2 y3 ab bc cd abc bcd m). rewrite El, Er, Em. clear El Er Em D0.
  repeat match type of C with positive_sum ?a ?b _ -> _ =>
    specialize (C ltac:(eexists _, _; split; [| split; [| reflexivity]]; lra)) end.
  split; [lia |]. intros D Zm. specialize (Ed Zm D). rewrite (sign_zero m Zm) in *. clearbody abc.
  cases_of_sign abc; try contradiction; cbn [same_sign negb andb] in C; lia.
Qed.

Lemma parts_changes y a m b : length y = 4%nat -> a < m < b ->
  (count (changes_in y a m) + count (changes_in y m b) <= count (changes_in y a b))%nat /\
  (0 < discriminant y -> at_ y m = 0 ->
    (count (changes_in y a m) + count (changes_in y m b) < count (changes_in y a b))%nat).
Proof.
  intros L M. assert (O : a < b) by lra. pose proof (proj1 (place_in a b m O) M) as P.
  destruct (split_changes (part_of y a b) _ (part_of_length y a b L) P) as (Le & Lt).
  rewrite !part_of_part in Le, Lt by easy.
  replace (a + 0 * (b - a)) with a in Le, Lt by ring. replace (a + 1 * (b - a)) with b in Le, Lt by ring.
  replace (a + (m - a) / (b - a) * (b - a)) with m in Le, Lt by (field; lra).
  split; auto. intros D Z. apply Lt.
  - rewrite discriminant_part by easy. apply Rmult_lt_0_compat; auto. apply pow_lt. lra.
  - now rewrite <- at_part.
Qed.
(** Descartes' rule is exact if all roots are real: a subinterval with as many sign changes has all the roots. *)
Lemma fewer_changes y a a' b' b : length y = 4%nat -> a <= a' -> a' < b' -> b' <= b ->
  (count (changes_in y a' b') <= count (changes_in y a b))%nat.
Proof.
  intros L A O B.
  assert (H : (count (changes_in y a' b') <= count (changes_in y a' b))%nat).
  { destruct B as [B | ->]; auto. destruct (parts_changes y a' b' b L ltac:(lra)) as (H & _). lia. }
  destruct A as [A | ->]; auto. destruct (parts_changes y a a' b L ltac:(lra)) as (K & _). lia.
Qed.
Theorem as_many_changes y a a' b' b t : length y = 4%nat -> 0 < discriminant y -> ~ Forall (eq 0) y ->
  a <= a' -> a' < b' -> b' <= b -> count (changes_in y a' b') = count (changes_in y a b) ->
  a < t < b -> at_ y t = 0 -> a' < t < b'.
Proof.
  intros L D N A O B C T Z.
  pose proof (fewer_changes y a' a' b' b L ltac:(lra) O B) as C1.
  pose proof (fewer_changes y a a' b b L A ltac:(lra) ltac:(lra)) as C2. split; apply Rnot_le_lt; intros K.
  - assert (A' : a < a') by lra. destruct (parts_changes y a a' b L ltac:(lra)) as (H & H').
    destruct K as [K | <-]; [| specialize (H' D Z); lia].
    apply (none_in y a a' t L A' N); auto; [lia | lra].
  - assert (B' : b' < b) by lra. destruct (parts_changes y a' b' b L ltac:(lra)) as (H & H').
    destruct K as [K | <-]; [| specialize (H' D Z); lia].
    apply (none_in y b' b t L B' N); auto; [lia | lra].
Qed.
(** If an interval has one crossing, a subinterval with opposite signs of Y at its ends has that crossing. *)
Theorem opposite_inside y a a' b' b Q : length y = 4%nat -> ~ Forall (eq 0) y ->
  a <= a' -> a' < b' -> b' <= b -> opposite (changes_in y a' b') = true -> crosses_once a b (at_ y) Q ->
  exists r, a' < r < b' /\ at_ y r = 0 /\ forall t, a < t < b -> at_ y t = 0 -> t = r \/ Q t.
Proof.
  intros L N A O B Op One. destruct (signs_in y a' b' L O N) as (S0 & S1 & St). rewrite Op in S1.
  set (s := first (changes_in y a' b')) in *. set (m := (a' + b') / 2).
  destruct (just_after s (at_ y) a' m S0 ltac:(unfold m; lra)) as (u & U & Pu).
  destruct (just_before (opposed s) (at_ y) m b' S1 ltac:(unfold m; lra)) as (w & W & Pw).
  destruct (crossed a b (at_ y) Q s u w One) as (r & R & Z & Only).
  - lra.
  - unfold m in *. lra.
  - lra.
  - destruct (Req_EM_T u a); [exfalso; lra | easy].
  - destruct (Req_EM_T w b); [exfalso; unfold m in *; lra |]. destruct St as [St | St]; rewrite St in *; simpl in *; lra.
  - exists r. split; [unfold m in *; lra |]. auto.
Qed.
(** ** Coefficients as integers *)

(** sub_part's y: the power coefficients at a/2^n by Horner's rule, times 2^(3n). *)
Definition power_coefficients (y0 y1 y2 y3 v : Z) : Z * Z * Z * Z :=
  let thrice := (y0 + y0 + y0)%Z in
  (y0 * (v * v * v), (y1 - thrice) * (v * v), (y2 - y1 - y1 + thrice) * v, y3 - y2 + y1 - y0)%Z.
Definition moved (c : Z * Z * Z * Z) (a : Z) : Z * Z * Z * Z :=
  let '(c0, c1, c2, c3) := c in
  let c2 := (c2 + c3 * a)%Z in
  let c1 := (c1 + c2 * a)%Z in
  let c0 := (c0 + c1 * a)%Z in
  let c2 := (c2 + c3 * a)%Z in
  let c1 := (c1 + c2 * a)%Z in
  (c0, c1, c2 + c3 * a, c3)%Z.
Definition widened (c : Z * Z * Z * Z) (q : Z) : Z * Z * Z * Z :=
  let '(c0, c1, c2, c3) := c in (c0, c1 * q, c2 * (q * q), c3 * (q * q * q))%Z.
Definition from_power (c : Z * Z * Z * Z) : list Z :=
  let '(c0, c1, c2, c3) := c in
  let twice := (c0 + c0 + c1)%Z in [c0; twice + c0; twice + c0 + c1 + c2; c0 + c1 + c2 + c3]%Z.
Definition sub_y (y : list Z) (n a w : Z) : list Z :=
  match y with
  | [y0; y1; y2; y3] => from_power (widened (moved (power_coefficients y0 y1 y2 y3 (2 ^ n)) a) (2 ^ w))
  | _ => []
  end.

Lemma sub_y_substituted y n a w : length y = 4%nat -> map IZR (sub_y y n a w) =
  substituted (map IZR y) (IZR (2 ^ n - a)) (IZR (2 ^ n - (a + 2 ^ w))) (IZR a) (IZR (a + 2 ^ w)).
Proof.
  intros L. destruct y as [| y0 [| y1 [| y2 [| y3 [|]]]]]; try discriminate.
  unfold sub_y, from_power, widened, moved, power_coefficients. cbv zeta beta iota.
  generalize (2 ^ n)%Z (2 ^ w)%Z. intros v q. cbn [map]. unfold substituted.
  apply same_four; repeat rewrite ?plus_IZR, ?mult_IZR, ?minus_IZR; ring.
Qed.

(** The coefficients are those on [a/2^n, (a + 2^w)/2^n], times 2^(3n). *)
Theorem sub_part_right y n a w : length y = 4%nat -> (0 <= n)%Z -> map IZR (sub_y y n a w) =
  map (Rmult (IZR (2 ^ n) ^ 3)) (part_of (map IZR y) (over a n) (over (a + 2 ^ w) n)).
Proof.
  intros L N. rewrite sub_y_substituted by easy. apply power_positive in N.
  assert (L' : length (map IZR y) = 4%nat) by now rewrite map_length. revert L'.
  generalize (map IZR y). intros r L'. four r L'. unfold part_of, substituted, over. cbn [map].
  rewrite !minus_IZR. set (v := IZR (2 ^ n)) in *. apply same_four; field; lra.
Qed.
Lemma sub_y_length y n a w : length y = 4%nat -> length (sub_y y n a w) = 4%nat.
Proof. intros L. destruct y as [| y0 [| y1 [| y2 [| y3 [|]]]]]; try discriminate. reflexivity. Qed.

(** ** Intervals *)

(** close_contact::part: from low/2^unit_bits, 2^width_bits units wide. *)
Record close_part := ClosePart { close_y : list Z; close_roots : sign_changes; low : Z; unit_bits : Z;
  width_bits : Z; test_from : Z }.
Definition bits (q : close_part) : Z := (unit_bits q - width_bits q)%Z.
Definition close_start (q : close_part) : R := over (low q) (unit_bits q).
Definition close_end (q : close_part) : R := over (low q + 2 ^ width_bits q) (unit_bits q).
Definition sub_part (q : close_part) (n a w : Z) : close_part :=
  let y := sub_y (close_y q) n a w in
  ClosePart y (inner_sign_changes (map IZR y)) (low q * 2 ^ (n - width_bits q) + a)%Z
    (unit_bits q + n - width_bits q)%Z w (test_from q).
(** The position times 2^n, rounded, is `middle`. *)
Definition around (q : close_part) (middle n : Z) : close_part :=
  sub_part q n (Z.max 0 (Z.min (middle - 1) (2 ^ n - 2))) 1.

(** Its coefficients are a positive multiple of those of y there. *)
Definition is_close_part (y : list R) (q : close_part) : Prop :=
  length (close_y q) = 4%nat /\ close_roots q = inner_sign_changes (map IZR (close_y q)) /\
  (0 <= width_bits q <= 1 /\ width_bits q <= unit_bits q /\ 0 <= low q /\ low q + 2 ^ width_bits q <= 2 ^ unit_bits q)%Z /\
  exists k, 0 < k /\ map IZR (close_y q) = map (Rmult k) (part_of y (close_start q) (close_end q)).

Lemma close_inside y q : is_close_part y q -> 0 <= close_start q < close_end q /\ close_end q <= 1.
Proof.
  intros (_ & _ & (W & U & L & H) & _). assert (Hu : (0 <= unit_bits q)%Z) by lia.
  pose proof (power_positive _ Hu) as P. pose proof (Z.pow_pos_nonneg 2 (width_bits q) ltac:(lia) ltac:(lia)).
  unfold close_start, close_end. split; [split; [| apply over_less; lia] |].
  - replace 0 with (over 0 (unit_bits q)) by (unfold over; lra). now apply over_le.
  - replace 1 with (over (2 ^ unit_bits q) (unit_bits q)) by (unfold over; field; lra). now apply over_le.
Qed.
Lemma close_changes y q : is_close_part y q -> close_roots q = changes_in y (close_start q) (close_end q).
Proof. intros (_ & -> & _ & k & K & ->). now apply changes_scaled. Qed.

(** sub_part returns a subinterval if a >= 0 and a + 2^w <= 2^n. *)
Lemma over_within low wb ub n a : (0 <= wb <= n)%Z -> (0 <= ub)%Z -> (wb <= ub)%Z ->
  over (low * 2 ^ (n - wb) + a) (ub + n - wb) =
  over low ub + over a n * (over (low + 2 ^ wb) ub - over low ub).
Proof.
  intros W U V. unfold over. replace (ub + n - wb)%Z with (ub + (n - wb))%Z by ring.
  rewrite Z.pow_add_r, !plus_IZR, !mult_IZR by lia.
  replace (2 ^ n)%Z with (2 ^ wb * 2 ^ (n - wb))%Z by (rewrite <- Z.pow_add_r by lia; f_equal; lia).
  rewrite mult_IZR. pose proof (power_positive wb ltac:(lia)). pose proof (power_positive ub ltac:(lia)).
  pose proof (power_positive (n - wb) ltac:(lia)). field. repeat split; lra.
Qed.
Lemma sub_part_is_part y q n a w : length y = 4%nat -> is_close_part y q ->
  (width_bits q <= n /\ 0 <= w <= 1 /\ w < n /\ 0 <= a /\ a + 2 ^ w <= 2 ^ n)%Z ->
  let r := sub_part q n a w in
  is_close_part y r /\ close_start q <= close_start r /\ close_end r <= close_end q /\
  close_start r = close_start q + over a n * (close_end q - close_start q) /\
  close_end r = close_start q + over (a + 2 ^ w) n * (close_end q - close_start q).
Proof.
  intros Ly H (Wn & W & Nw & A & B) r. pose proof (close_inside y q H) as In.
  pose proof H as (L & R & (Wq & Uq & Lq & Hq) & k & K & E).
  assert (Es : close_start r = close_start q + over a n * (close_end q - close_start q))
    by (unfold close_start, close_end, r, sub_part; cbn [low unit_bits width_bits]; apply over_within; lia).
  assert (Ee : close_end r = close_start q + over (a + 2 ^ w) n * (close_end q - close_start q)).
  { unfold close_start, close_end, r, sub_part. cbn [low unit_bits width_bits]. rewrite <- Z.add_assoc. apply over_within; lia. }
  assert (P2 : (0 < 2 ^ w)%Z) by (apply Z.pow_pos_nonneg; lia). assert (Hn : (0 <= n)%Z) by lia.
  assert (Oa : 0 <= over a n).
  { replace 0 with (over 0 n) by (unfold over; lra). now apply over_le. }
  assert (Ob : over (a + 2 ^ w) n <= 1).
  { pose proof (power_positive n Hn). replace 1 with (over (2 ^ n) n) by (unfold over; field; lra). now apply over_le. }
  assert (0 <= over a n * (close_end q - close_start q)) by (apply Rmult_le_pos; lra).
  assert (0 <= (1 - over (a + 2 ^ w) n) * (close_end q - close_start q)) by (apply Rmult_le_pos; lra).
  split; [| repeat split; lra].
  split; [now apply sub_y_length |]. split; [reflexivity |]. split.
  { unfold r, sub_part. cbn [low unit_bits width_bits].
    assert (Q : (2 ^ (unit_bits q + n - width_bits q) = 2 ^ unit_bits q * 2 ^ (n - width_bits q))%Z)
      by (rewrite <- Z.pow_add_r by lia; f_equal; lia).
    assert (N2 : (2 ^ n = 2 ^ width_bits q * 2 ^ (n - width_bits q))%Z)
      by (rewrite <- Z.pow_add_r by lia; f_equal; lia).
    repeat split; try lia; nia. }
  exists (IZR (2 ^ n) ^ 3 * k). split; [apply Rmult_lt_0_compat; auto; apply pow_lt; now apply power_positive |].
  change (close_y r) with (sub_y (close_y q) n a w). rewrite sub_part_right, E by easy. unfold part_of at 1.
  rewrite substituted_scaled by now apply part_of_length.
  fold (part_of (part_of y (close_start q) (close_end q)) (over a n) (over (a + 2 ^ w) n)).
  rewrite part_of_part, map_map by easy. rewrite Es, Ee. apply map_ext. intros x. ring.
Qed.

(** ** G_i over an interval *)

(** inside_from with exact differences. Without a width it is at low/2^bits. *)
Definition close_component (low bits : Z) (width : option Z) (l : list Z) : known :=
  let slope := (nth 1 l 0 - nth 0 l 0)%Z in
  BoundedInteger.Bounded (nth 0 l 0 * (2 ^ bits - low) + nth 1 l 0 * low)%Z
    (match width with
     | Some width_bits => if slope =? 0 then BoundedInteger.exact else BoundedInteger.bit_length slope + width_bits
     | None => BoundedInteger.exact
     end)%Z.
Lemma close_component_stands low bits width_bits l t : length l = 2%nat -> (0 <= bits)%Z -> (0 <= width_bits)%Z ->
  over low bits <= t < over (low + 2 ^ width_bits) bits ->
  stands (close_component low bits (Some width_bits) l) (IZR (2 ^ bits) * form (map IZR l) (1 - t) t).
Proof.
  intros L Hb Hw Ht. destruct l as [| x0 [| x1 [|]]]; try discriminate. clear L.
  pose proof (power_positive _ Hb) as P. set (w := IZR (2 ^ bits)) in *. set (u := t * w - IZR low).
  assert (U : 0 <= u < IZR (2 ^ width_bits)).
  { unfold over in Ht. fold w in Ht. rewrite plus_IZR in Ht. unfold u.
    assert (IZR low / w * w = IZR low) by (field; lra).
    assert ((IZR low + IZR (2 ^ width_bits)) / w * w = IZR low + IZR (2 ^ width_bits)) by (field; lra).
    destruct Ht as (Ht & Ht'). apply (Rmult_le_compat_r w) in Ht; [| lra]. apply (Rmult_lt_compat_r w) in Ht'; lra. }
  unfold close_component. cbn [nth]. cbv zeta. set (v := (x0 * (2 ^ bits - low) + x1 * low)%Z). set (slope := (x1 - x0)%Z).
  assert (E : w * form (map IZR [x0; x1]) (1 - t) t - IZR v = IZR slope * u).
  { unfold v, slope, u, w. rewrite plus_IZR, !mult_IZR, !minus_IZR. simpl. ring. }
  destruct (BoundedInteger.bit_length_bounds slope) as (Bl & Bs & _). set (n := BoundedInteger.bit_length slope) in *.
  unfold stands, BoundedInteger.is_exact. cbn [BoundedInteger.error_bits BoundedInteger.value].
  destruct (Z.eqb_spec slope 0) as [Z0 | NZ].
  - change (BoundedInteger.exact <? BoundedInteger.exact / 2)%Z with true. cbv iota. rewrite Z0 in E. lra.
  - destruct (Z.ltb_spec (n + width_bits) (BoundedInteger.exact / 2)) as [X | _].
    { exfalso. change (BoundedInteger.exact / 2)%Z with (-524288)%Z in X. lia. }
    rewrite E, Rabs_mult, (Rabs_pos_eq u), <- abs_IZR, bpow_plus, <- !(IZR_Zpower radix2) by (lra || lia).
    change (Zpower radix2) with (Z.pow 2). pose proof (power_positive n Bl).
    apply Rle_lt_trans with (IZR (2 ^ n) * u).
    + apply Rmult_le_compat_r; [lra | now apply IZR_le].
    + apply Rmult_lt_compat_l; lra.
Qed.

(** At a position, numbers of less than 2000 bits are exact. *)
Definition near_exact (m e : Z) (x : known) : Prop :=
  (Z.abs (BoundedInteger.value x) <= 2 ^ m /\ 0 <= m /\ BoundedInteger.error_bits x <= BoundedInteger.exact + e)%Z.
Lemma near_sum m e m' e' x y : near_exact m e x -> near_exact m' e' y ->
  near_exact (Z.max m m' + 1) (Z.max e e' + 1) (BoundedInteger.add x y) /\
  near_exact (Z.max m m' + 1) (Z.max e e' + 1) (BoundedInteger.sub x y).
Proof.
  intros (A & M & E) (A' & M' & E').
  assert (P : (2 ^ (Z.max m m' + 1) = 2 * 2 ^ Z.max m m')%Z) by (rewrite Z.pow_add_r by lia; ring).
  pose proof (Z.pow_le_mono_r 2 m (Z.max m m') ltac:(lia) ltac:(lia)).
  pose proof (Z.pow_le_mono_r 2 m' (Z.max m m') ltac:(lia) ltac:(lia)).
  unfold near_exact. cbn [BoundedInteger.add BoundedInteger.sub BoundedInteger.value BoundedInteger.error_bits].
  split; (split; [clear M M' E E'; lia | split; [clear - M M'; lia | clear - E E'; lia]]).
Qed.
Lemma near_product m e m' e' x y : (0 <= e)%Z -> (0 <= e')%Z -> near_exact m e x -> near_exact m' e' y ->
  near_exact (m + m') (m + m' + e + e' + 3) (BoundedInteger.mul x y).
Proof.
  intros N N' (A & M & E) (A' & M' & E').
  assert (Bits : forall a k, (0 <= k)%Z -> (Z.abs a <= 2 ^ k)%Z -> (BoundedInteger.bit_length a <= k + 1)%Z).
  { intros a k K H. destruct (BoundedInteger.bit_length_bounds a) as (B0 & _ & B1).
    destruct (Z.eq_dec (BoundedInteger.bit_length a) 0) as [| Z0]; [lia |]. specialize (B1 ltac:(lia)).
    apply Z.nlt_ge. intros L. assert (2 ^ k < 2 ^ (BoundedInteger.bit_length a - 1))%Z by (apply Z.pow_lt_mono_r; lia). lia. }
  pose proof (Bits _ _ M A) as Ba. pose proof (Bits _ _ M' A') as Bb. clear Bits.
  unfold near_exact. cbn [BoundedInteger.mul BoundedInteger.value BoundedInteger.error_bits].
  assert (BoundedInteger.exact < 0)%Z by reflexivity.
  split; [| lia]. rewrite Z.abs_mul, Z.pow_add_r by lia. apply Z.mul_le_mono_nonneg; lia.
Qed.
Definition near_vector (m e : Z) (v : known_vector) : Prop :=
  near_exact m e (kx v) /\ near_exact m e (ky v) /\ near_exact m e (kz v).
Lemma near_weaker m e m' e' x : (m <= m')%Z -> (e <= e')%Z -> near_exact m e x -> near_exact m' e' x.
Proof.
  intros M E (A & N & H). pose proof (Z.pow_le_mono_r 2 m m' ltac:(lia) M). unfold near_exact. lia.
Qed.
Lemma near_cross m e p q : (0 <= e)%Z -> near_vector m e p -> near_vector m e q ->
  near_vector (2 * m + 1) (2 * m + 2 * e + 4) (cross_known p q).
Proof.
  intros N (P0 & P1 & P2) (Q0 & Q1 & Q2).
  assert (S : forall x y z w, near_exact m e x -> near_exact m e y -> near_exact m e z -> near_exact m e w ->
    near_exact (2 * m + 1) (2 * m + 2 * e + 4) (BoundedInteger.sub (BoundedInteger.mul x y) (BoundedInteger.mul z w))).
  { intros x y z w X Y Z W. pose proof (near_product _ _ _ _ _ _ N N X Y) as A. pose proof (near_product _ _ _ _ _ _ N N Z W) as B.
    eapply near_weaker; [| | exact (proj2 (near_sum _ _ _ _ _ _ A B))]; lia. }
  unfold near_vector, cross_known. cbn [kx ky kz]. auto 8.
Qed.
Lemma near_dot m e p q : (0 <= e)%Z -> near_vector m e p -> near_vector m e q ->
  near_exact (2 * m + 2) (2 * m + 2 * e + 5) (dot_known p q).
Proof.
  intros N (P0 & P1 & P2) (Q0 & Q1 & Q2). unfold dot_known.
  pose proof (near_product _ _ _ _ _ _ N N P0 Q0) as A0. pose proof (near_product _ _ _ _ _ _ N N P1 Q1) as A1.
  pose proof (near_product _ _ _ _ _ _ N N P2 Q2) as A2. pose proof (proj1 (near_sum _ _ _ _ _ _ A0 A1)) as B.
  eapply near_weaker; [| | exact (proj1 (near_sum _ _ _ _ _ _ B A2))]; lia.
Qed.
Lemma near_weights edges m b c p : near_vector m 0 b -> near_vector m 0 c -> near_vector m 0 p ->
  Forall (near_exact (4 * m + 6) (8 * m + 19)) (known_weights edges b c p).
Proof.
  intros Hb Hc Hp.
  assert (D : forall x y z w, near_vector m 0 x -> near_vector m 0 y -> near_vector m 0 z -> near_vector m 0 w ->
    near_exact (4 * m + 4) (8 * m + 17) (dot_known (cross_known x y) (cross_known z w))).
  { intros x y z w X Y Z W. pose proof (near_cross m 0 _ _ ltac:(lia) X Y) as A. pose proof (near_cross m 0 _ _ ltac:(lia) Z W) as B.
    destruct Hb as ((_ & M & _) & _). 
    eapply near_weaker; [| | exact (near_dot (2 * m + 1) (2 * m + 2 * 0 + 4) _ _ ltac:(lia) A B)]; lia. }
  assert (S : forall k l x y, near_exact (4 * m + k) (8 * m + l) x -> near_exact (4 * m + k) (8 * m + l) y ->
    near_exact (4 * m + (k + 1)) (8 * m + (l + 1)) (BoundedInteger.sub x y)).
  { intros k l x y A B. eapply near_weaker; [| | exact (proj2 (near_sum _ _ _ _ _ _ A B))]; lia. }
  assert (W : forall k l x, (k <= 6)%Z -> (l <= 19)%Z -> near_exact (4 * m + k) (8 * m + l) x -> near_exact (4 * m + 6) (8 * m + 19) x)
    by (intros k l x K L; apply near_weaker; lia).
  unfold known_weights. cbv zeta.
  destruct edges; repeat apply Forall_cons; try apply Forall_nil.
  1, 3, 5, 6: apply (W 4 17)%Z; try lia; now apply D.
  1, 2: apply (W 5 18)%Z; try lia; apply (S 4 17)%Z; now apply D.
  apply (W 6 19)%Z; try lia. apply (S 5 18)%Z; [apply (S 4 17)%Z; now apply D |].
  apply near_weaker with (4 * m + 4)%Z (8 * m + 17)%Z; try lia. now apply D.
Qed.
(** Then no sign is uncertain. *)
Lemma conclusion_exact gs ws found m e : (e <= 500000)%Z -> Forall2 stands gs ws -> Forall (near_exact m e) gs ->
  Forall (Rlt 0) ws -> conclusion found gs = found.
Proof.
  intros L F. induction F as [| g w gs ws S F IH]; intros N W; [easy |]. inversion_clear N as [| ? ? Ng N'].
  inversion_clear W as [| ? ? Wg W']. cbn [conclusion].
  assert (X : BoundedInteger.is_exact g = true).
  { unfold BoundedInteger.is_exact. apply Z.ltb_lt. destruct Ng as (_ & _ & Ng).
    change BoundedInteger.exact with (-1048576)%Z in *. change (-1048576 / 2)%Z with (-524288)%Z. lia. }
  assert (P : BoundedInteger.sign_of g = positive).
  { unfold BoundedInteger.sign_of. rewrite X. cbn [negb andb]. unfold stands in S. rewrite X in S. subst w.
    apply lt_IZR in Wg. unfold BoundedInteger.sign_of_integer. apply Z.compare_gt_iff in Wg. now rewrite Wg. }
  rewrite P. now apply IH.
Qed.

(** ** close_contact *)

Definition below (k : Z) (v : @vector_form integers) : Prop :=
  Forall (fun x => (Z.abs x <= 2 ^ k)%Z) (vx v ++ vy v ++ vz v).
Definition is_single (three : bool) (changes : sign_changes) : bool :=
  opposite changes && (Nat.eqb (count changes) 1 || negb three).
Definition max_bits : Z := 1534.
Definition most_y_bits : Z := 64 * 88 - 188.
Definition can_be_narrowed (q : close_part) : bool :=
  (unit_bits q + 60 <=? max_bits)%Z &&
  forallb (fun h => BoundedInteger.bit_length h <=? most_y_bits)%Z (close_y q).

Section Query.

Context (edges : bool) (b c p : @vector_form integers) (degree_b : degree b 1) (degree_c : degree c 1)
  (degree_p : degree p 1).
(** The hypotheses that extent_limit gives for four words. *)
Hypotheses (below_b : below 253 b) (below_c : below 253 c) (below_p : below 253 p).
Let y : list R := map IZR (y_form b c p).
Let Inside (t : R) : Prop := weights_positive edges (vector_at b t) (vector_at c t) (vector_at p t).
Let y_length : length y = 4%nat := InteriorContact.y_length b c p degree_b degree_c degree_p.

Definition close_known (low bits : Z) (width : option Z) (v : @vector_form integers) : known_vector :=
  KnownVector (close_component low bits width (vx v)) (close_component low bits width (vy v))
    (close_component low bits width (vz v)).
Definition inside_from (low bits : Z) (width : option Z) : outcome :=
  conclusion collides (known_weights edges (close_known low bits width b) (close_known low bits width c)
    (close_known low bits width p)).

Lemma homogeneous_inside k t : 0 < k -> Forall (Rlt 0) (weights edges (stretched (Point k k k) (vector_at b t))
  (stretched (Point k k k) (vector_at c t)) (stretched (Point k k k) (vector_at p t))) <-> Inside t.
Proof. intros K. rewrite (weights_homogeneous edges b c p), inside_scaled by now apply pow_lt. easy. Qed.

(** Certain signs on an interval are right inside it. *)
Theorem inside_from_right q t : is_close_part y q -> close_start q < t < close_end q ->
  let known := inside_from (low q) (unit_bits q) (Some (width_bits q)) in
  (known = collides -> Inside t) /\ (known = separate -> ~ Inside t).
Proof.
  intros (_ & _ & (W & U & _) & _) T. assert (Hu : (0 <= unit_bits q)%Z) by lia. set (k := IZR (2 ^ unit_bits q)).
  assert (V : forall v, degree v 1 -> vector_stands (close_known (low q) (unit_bits q) (Some (width_bits q)) v)
    (stretched (Point k k k) (vector_at v t))).
  { intros v (L0 & L1 & L2). unfold close_start, close_end in T.
    repeat split; cbn [close_known kx ky kz]; apply close_component_stands; auto; lra || lia. }
  pose proof (weights_stand edges _ _ _ _ _ _ (V b degree_b) (V c degree_c) (V p degree_p)) as F.
  pose proof (homogeneous_inside k t (power_positive _ Hu)) as H.
  destruct (conclusion_right _ _ collides F) as (Yes & No). cbv zeta. unfold inside_from. split; intros O.
  - now apply H, Yes.
  - intros I. destruct (No O) as [| N]; [discriminate |]. now apply N, H.
Qed.
(** Signs at one position are certain. *)
Lemma inside_from_place n bits : (0 <= n <= 2 ^ bits)%Z -> (0 <= bits <= 1535)%Z ->
  inside_from n bits None = collides <-> Inside (over n bits).
Proof.
  intros N Hb. assert (H0 : (0 <= bits)%Z) by lia. set (k := IZR (2 ^ bits)). set (t := over n bits).
  pose proof (power_positive _ H0) as P.
  assert (V : forall v, degree v 1 -> vector_stands (close_known n bits None v) (stretched (Point k k k) (vector_at v t))).
  { intros v (L0 & L1 & L2).
    assert (E : forall l : list Z, length l = 2%nat ->
      stands (close_component n bits None l) (k * form (map IZR l) (1 - t) t)).
    { intros l L. destruct l as [| x0 [| x1 [|]]]; try discriminate. unfold stands, close_component, BoundedInteger.is_exact.
      cbn [BoundedInteger.error_bits BoundedInteger.value nth].
      change (BoundedInteger.exact <? BoundedInteger.exact / 2)%Z with true. cbv iota.
      rewrite plus_IZR, !mult_IZR, minus_IZR. unfold t, over. fold k. simpl. field. unfold k. lra. }
    repeat split; cbn [close_known kx ky kz]; now apply E. }
  assert (M : forall v, degree v 1 -> below 253 v -> near_vector (253 + 1535) 0 (close_known n bits None v)).
  { intros v (L0 & L1 & L2) S. unfold below in S. apply Forall_app in S. destruct S as (S0 & S). apply Forall_app in S.
    destruct S as (S1 & S2).
    assert (E : forall l : list Z, length l = 2%nat -> Forall (fun x => (Z.abs x <= 2 ^ 253)%Z) l ->
      near_exact (253 + 1535) 0 (close_component n bits None l)).
    { intros l L F. destruct l as [| x0 [| x1 [|]]]; try discriminate.
      inversion_clear F as [| ? ? F0 F']. inversion_clear F' as [| ? ? F1 _].
      unfold near_exact, close_component. cbn [BoundedInteger.error_bits BoundedInteger.value nth]. split; [| lia].
      rewrite Z.pow_add_r by lia. pose proof (Z.pow_le_mono_r 2 bits 1535 ltac:(lia) ltac:(lia)) as Mono.
      apply Z.le_trans with (2 ^ 253 * 2 ^ bits)%Z; [| apply Z.mul_le_mono_nonneg_l; [lia | easy]].
      set (B := (2 ^ 253)%Z) in *. set (C := (2 ^ bits)%Z) in *. clearbody B C. nia. }
    split; [| split]; cbn [close_known kx ky kz]; now apply E. }
  pose proof (weights_stand edges _ _ _ _ _ _ (V b degree_b) (V c degree_c) (V p degree_p)) as F.
  pose proof (near_weights edges _ _ _ _ (M b degree_b below_b) (M c degree_c below_c) (M p degree_p below_p)) as Near.
  pose proof (homogeneous_inside k t P) as H. unfold inside_from. split; intros O.
  - now apply H, (conclusion_right _ _ collides F).
  - apply conclusion_exact with (2 := F) (3 := Near); [easy | now apply H].
Qed.

(** The only root of an interval, which is not a contact. *)
Definition normal_vanishes_at_root (distinct three : bool) (q : close_part) : bool :=
  is_single three (close_roots q) && (distinct || Nat.eqb (count (close_roots q)) 1) &&
  normal_vanishes b c (low q) (low q + 2 ^ width_bits q) (unit_bits q).
Definition contact_in_middle (q : close_part) : bool :=
  match inside_from (low q * 2 + 2 ^ width_bits q) (unit_bits q + 1) None with collides => true | _ => false end.

(** Arbitrary estimates: of a root's position times 2^n, rounded; of the least n such that roots t/s are below 2^n;
    of an extremum's position; and of the exponent of its roots' distance from it. *)
Context (estimated_root : list Z -> Z -> Z) (root_exponent : list Z -> Z)
  (estimated_pair : list Z -> option ((Z -> Z) * Z)).

Definition narrowed (three : bool) (q : close_part) : option close_part :=
  let h := close_y q in
  if is_single three (close_roots q) then
    find (fun narrow => opposite (close_roots narrow)) (map (fun n => around q (estimated_root h n) n) [41; 20; 10]%Z)
  else
    let has_all narrow := Nat.eqb (count (close_roots narrow)) (count (close_roots q)) in
    let n := Z.min (- root_exponent h) 60 in
    let m := Z.min (- root_exponent (rev h)) 60 in
    if (1 <? n)%Z && has_all (sub_part q n 0 0) then Some (sub_part q n 0 0)
    else if (1 <? m)%Z && has_all (sub_part q m (2 ^ m - 1) 0) then Some (sub_part q m (2 ^ m - 1) 0)
    else if Nat.eqb (count (close_roots q)) 2 then
      match estimated_pair h with
      | Some (middle, exponent) =>
          let n := Z.min (- exponent - 3) 22 in
          if (exponent <? -5)%Z && has_all (around q (middle n) n) then Some (around q (middle n) n) else None
      | None => None
      end
    else None.

(** The result of a waiting interval: an answer, or the intervals that wait next. *)
Definition next_of (distinct three : bool) (q : close_part) : outcome + list close_part :=
  let test := (test_from q <=? bits q)%Z in
  let known := if test then inside_from (low q) (unit_bits q) (Some (width_bits q)) else undecided in
  let tested := ClosePart (close_y q) (close_roots q) (low q) (unit_bits q) (width_bits q)
    (if test then bits q + bits q / 2 else test_from q) in
  match known with
  | collides => inl collides
  | separate => inl separate
  | undecided =>
      if test && normal_vanishes_at_root distinct three q then inl separate
      else if negb (can_be_narrowed tested) then inl undecided
      else
        match narrowed three tested with
        | Some narrow => inr [narrow]
        | None =>
            let h := close_y q in
            if (nth 0 h 0 + nth 1 h 0 + nth 2 h 0 + nth 3 h 0 =? 0)%Z && contact_in_middle tested then inl collides
            else inr [sub_part tested 1 0 0; sub_part tested 1 1 0]
        end
  end.

(** decide with a number of steps; the interval that is tested next comes first. *)
Definition that_wait (three : bool) (parts : list close_part) : list close_part :=
  filter (fun q => any_root three (close_roots q)) parts.
Fixpoint by_narrowing (distinct three : bool) (steps : nat) (waiting : list close_part) (found : outcome) : outcome :=
  match steps, waiting with
  | O, _ => undecided
  | _, [] => found
  | Datatypes.S steps, q :: rest =>
      match next_of distinct three q with
      | inl collides => collides
      | inl undecided => by_narrowing distinct three steps rest undecided
      | inl separate => by_narrowing distinct three steps rest found
      | inr parts => by_narrowing distinct three steps (that_wait three parts ++ rest) found
      end
  end.
Definition whole_part : close_part := ClosePart (y_form b c p) (inner_sign_changes y) 0 0 0 40.
Definition close_contact (steps : nat) : outcome :=
  let discriminant := sign_of_real (discriminant y) in
  let distinct := negb (same_sign discriminant zero) in
  let three := same_sign discriminant positive in
  by_narrowing distinct three steps (that_wait three [whole_part]) separate.

(** ** Its answers *)

(** Times that need no test: multiple roots, and times at which not all G_i > 0. *)
Variable told : R -> Prop.
Definition close_answers (a b : R) (o : outcome) : Prop :=
  match o with
  | collides => exists t, 0 <= t <= 1 /\ at_ y t = 0 /\ Inside t
  | separate => forall t, a < t < b -> at_ y t = 0 -> told t \/ ~ Inside t
  | undecided => True
  end.
Definition close_known_roots (distinct three : bool) : Prop :=
  ~ Forall (eq 0) y /\ (three = true -> 0 < discriminant y) /\
  (three = false -> crosses_once 0 1 (at_ y) (fun t => told t /\ distinct = false)).
Definition close_good (q : close_part) : Prop := is_close_part y q /\ (unit_bits q <= max_bits)%Z.

Section Known.

Context (distinct three : bool) (known_y : close_known_roots distinct three).

Lemma single_once q : close_good q -> is_single three (close_roots q) = true ->
  crosses_once (close_start q) (close_end q) (at_ y) (fun t => told t /\ distinct = false).
Proof.
  intros (H & _) S. pose proof (close_inside y q H) as In. apply andb_prop in S. destruct S as (_ & S).
  destruct three eqn:T.
  - rewrite orb_false_r in S. apply Nat.eqb_eq in S. rewrite (close_changes y q H) in S. apply one_in; auto. lra.
  - apply (restricted 0 1); [now apply known_y | lra | lra].
Qed.
Lemma rootless_part q : close_good q -> any_root three (close_roots q) = false ->
  forall t, close_start q < t < close_end q -> at_ y t = 0 -> told t.
Proof.
  intros (H & _) A t T Z. pose proof (close_inside y q H) as In. rewrite (close_changes y q H) in A.
  unfold any_root in A. apply orb_false_iff in A. destruct A as (O & A). destruct known_y as (N & D & One).
  destruct (signs_in y (close_start q) (close_end q) y_length ltac:(lra) N) as (S0 & S1 & _). rewrite O in S1.
  destruct three.
  - simpl in A. apply Nat.ltb_ge in A. exfalso.
    apply (none_in y (close_start q) (close_end q) t y_length ltac:(lra) N ltac:(lia) T Z).
  - destruct (uncrossed (close_start q) (close_end q) (at_ y) (fun t => told t /\ distinct = false) _ t
      ltac:(apply (restricted 0 1); [now apply One | lra | lra]) S0 S1 T Z). easy.
Qed.
Lemma rooted_part q : close_good q -> any_root three (close_roots q) = true ->
  exists t, close_start q < t < close_end q /\ at_ y t = 0.
Proof.
  intros (H & _) A. pose proof (close_inside y q H) as In. rewrite (close_changes y q H) in A.
  destruct known_y as (_ & D & _). apply (root_in three); auto. lra.
Qed.

Lemma vanishes_right q : close_good q -> normal_vanishes_at_root distinct three q = true ->
  forall t, close_start q < t < close_end q -> at_ y t = 0 -> ~ Inside t.
Proof.
  intros G V t T Z. unfold normal_vanishes_at_root in V. apply andb_prop in V. destruct V as (V & Nv).
  apply andb_prop in V. destruct V as (S & V). pose proof G as (H & _). pose proof (close_inside y q H) as In.
  pose proof H as (_ & _ & (W & U & L & B) & _).
  pose proof (Z.pow_pos_nonneg 2 (width_bits q) ltac:(lia) ltac:(lia)).
  destruct (normal_vanishes_right edges b c p degree_b degree_c degree_p (low q) (low q + 2 ^ width_bits q) (unit_bits q))
    as (s & Hs & Zs & Ns); auto; try lia.
  fold (close_start q) (close_end q) in Hs. destruct known_y as (N & _).
  destruct (signs_in y (close_start q) (close_end q) y_length ltac:(lra) N) as (S0 & _).
  assert (Once : crosses_once (close_start q) (close_end q) (at_ y) (fun _ => False)).
  { apply orb_prop in V. destruct V as [V | V].
    - destruct (single_once q G S) as (l0 & l1 & f & E). exists l0, l1, f. intros u Hu. destruct (E u Hu) as (A & B' & C).
      split; auto. split; auto. intros Zf. destruct (C Zf). congruence.
    - apply Nat.eqb_eq in V. rewrite (close_changes y q H) in V. apply one_in; auto. lra. }
  destruct (only_crossing _ _ _ _ _ t s Once S0 T Hs Z Zs) as [-> | [[] | []]]. exact Ns.
Qed.

(** A narrowed interval has all roots that must be tested. *)
Definition narrower (q r : close_part) : Prop :=
  close_good r /\ close_start q <= close_start r /\ close_end r <= close_end q /\ (bits q < bits r)%Z /\
  (count (close_roots r) <= count (close_roots q))%nat.
Lemma sub_part_narrower q n a w : close_good q -> can_be_narrowed q = true ->
  (1 <= n <= 60 /\ 0 <= w <= 1 /\ w < n /\ 0 <= a /\ a + 2 ^ w <= 2 ^ n)%Z -> narrower q (sub_part q n a w).
Proof.
  intros (H & _) C N. apply andb_prop in C. destruct C as (C & _). apply Z.leb_le in C.
  pose proof H as (_ & _ & (W & U & _) & _).
  destruct (sub_part_is_part y q n a w y_length H ltac:(lia)) as (R & S & E & _).
  split; [split; [exact R |] |].
  - unfold sub_part. cbn [unit_bits]. unfold max_bits in *. lia.
  - split; auto. split; auto. split; [unfold bits, sub_part; cbn [unit_bits width_bits]; lia |].
    rewrite (close_changes y q H), (close_changes y _ R). pose proof (close_inside y _ R).
    apply fewer_changes; auto. lra.
Qed.
Lemma around_narrower q middle n : close_good q -> can_be_narrowed q = true -> (2 <= n <= 60)%Z ->
  narrower q (around q middle n).
Proof.
  intros G C N. apply sub_part_narrower; auto.
  assert (2 ^ 2 <= 2 ^ n)%Z by (apply Z.pow_le_mono_r; lia). change (2 ^ 2)%Z with 4%Z in *. change (2 ^ 1)%Z with 2%Z. lia.
Qed.

Lemma single_narrowed q r : close_good q -> is_single three (close_roots q) = true -> narrower q r ->
  opposite (close_roots r) = true -> forall t, close_start q < t < close_end q -> at_ y t = 0 ->
  close_start r < t < close_end r \/ told t.
Proof.
  intros G S ((R & _) & A & B & _) O t T Z. rewrite (close_changes y r R) in O. pose proof (close_inside y r R).
  destruct known_y as (N & _).
  destruct (opposite_inside y (close_start q) (close_start r) (close_end r) (close_end q) _ y_length N A
    ltac:(lra) B O (single_once q G S)) as (s & Hs & _ & Only).
  destruct (Only t T Z) as [-> | (K & _)]; auto.
Qed.
Lemma counted_narrowed q r : close_good q -> any_root three (close_roots q) = true ->
  is_single three (close_roots q) = false -> narrower q r ->
  Nat.eqb (count (close_roots r)) (count (close_roots q)) = true ->
  forall t, close_start q < t < close_end q -> at_ y t = 0 -> close_start r < t < close_end r \/ told t.
Proof.
  intros (H & _) A S ((R & _) & B & C & _) E t T Z. left. apply Nat.eqb_eq in E. pose proof (close_inside y r R).
  rewrite (close_changes y q H), (close_changes y r R) in E. destruct known_y as (N & D & _).
  assert (three = true) as T3.
  { unfold any_root, is_single in *. destruct three; auto. destruct (opposite (close_roots q)); [| discriminate].
    rewrite orb_true_r in S. discriminate. }
  apply (as_many_changes y (close_start q) (close_start r) (close_end r) (close_end q)); auto. lra.
Qed.
Lemma narrowed_narrower q r : close_good q -> can_be_narrowed q = true -> narrowed three q = Some r ->
  narrower q r /\ (if is_single three (close_roots q) then opposite (close_roots r)
                   else Nat.eqb (count (close_roots r)) (count (close_roots q))) = true.
Proof.
  intros G C. unfold narrowed. cbv zeta. destruct (is_single three (close_roots q)).
  { intros F. apply find_some in F. destruct F as (I & O). split; [| exact O].
    destruct I as [<- | [<- | [<- | []]]]; apply around_narrower; auto; lia. }
  set (n := Z.min (- root_exponent (close_y q)) 60). set (m := Z.min (- root_exponent (rev (close_y q))) 60).
  destruct ((1 <? n)%Z && _) eqn:E0.
  { apply andb_prop in E0. destruct E0 as (L & E0). apply Z.ltb_lt in L. intros I. injection I as <-.
    split; [| exact E0].
    assert (2 ^ 1 <= 2 ^ n)%Z by (apply Z.pow_le_mono_r; lia). change (2 ^ 1)%Z with 2%Z in *.
    apply sub_part_narrower; auto. change (2 ^ 0)%Z with 1%Z. lia. }
  destruct ((1 <? m)%Z && _) eqn:E1.
  { apply andb_prop in E1. destruct E1 as (L & E1). apply Z.ltb_lt in L. intros I. injection I as <-.
    split; [| exact E1].
    assert (2 ^ 1 <= 2 ^ m)%Z by (apply Z.pow_le_mono_r; lia). change (2 ^ 1)%Z with 2%Z in *.
    apply sub_part_narrower; auto. change (2 ^ 0)%Z with 1%Z. lia. }
  destruct (Nat.eqb (count (close_roots q)) 2); [| discriminate].
  destruct (estimated_pair (close_y q)) as [[middle exponent] |]; [| discriminate].
  destruct ((exponent <? -5)%Z && _) eqn:E2; [| discriminate].
  apply andb_prop in E2. destruct E2 as (L & E2). apply Z.ltb_lt in L. intros I. injection I as <-. split; [| exact E2].
  apply around_narrower; auto. lia.
Qed.
Lemma narrowed_right q r : close_good q -> can_be_narrowed q = true -> any_root three (close_roots q) = true ->
  narrowed three q = Some r -> narrower q r /\
  forall t, close_start q < t < close_end q -> at_ y t = 0 -> close_start r < t < close_end r \/ told t.
Proof.
  intros G C A F. destruct (narrowed_narrower q r G C F) as (Nr & O). split; auto.
  destruct (is_single three (close_roots q)) eqn:S; [now apply single_narrowed | now apply counted_narrowed].
Qed.

(** The common end of the halves. *)
Lemma middle_of q : is_close_part y q -> let h := close_y q in
  let m := close_start q + / 2 * (close_end q - close_start q) in
  over (low q * 2 + 2 ^ width_bits q) (unit_bits q + 1) = m /\
  ((nth 0 h 0 + nth 1 h 0 + nth 2 h 0 + nth 3 h 0 =? 0)%Z = true <-> at_ y m = 0).
Proof.
  intros H h m. pose proof (close_inside y q H) as In. destruct H as (L & _ & (W & U & _) & k & K & E). split.
  - unfold m, close_start, close_end, over. rewrite Z.pow_add_r, !plus_IZR, !mult_IZR by lia. change (2 ^ 1)%Z with 2%Z.
    pose proof (power_positive (unit_bits q) ltac:(lia)). field. lra.
  - assert (A : k * at_ y m = / 8 * IZR (nth 0 h 0 + nth 1 h 0 + nth 2 h 0 + nth 3 h 0)%Z).
    { unfold m. rewrite <- (part_of_at y _ _ _ y_length).
      assert (F : at_ (map IZR h) (/ 2) = k * at_ (part_of y (close_start q) (close_end q)) (/ 2))
        by (unfold h; rewrite E; unfold at_; apply form_scaled).
      rewrite <- F. unfold h. clear - L. destruct (close_y q) as [| h0 [| h1 [| h2 [| h3 [|]]]]]; try discriminate.
      cbn [nth]. rewrite !plus_IZR. unfold at_. simpl. field. }
    rewrite Z.eqb_eq. split; intros Z0.
    + rewrite Z0, Rmult_0_r in A. apply Rmult_integral in A. destruct A; [lra | easy].
    + rewrite Z0, Rmult_0_r in A. apply eq_IZR. lra.
Qed.

Lemma halves_of q : is_close_part y q -> let m := close_start q + / 2 * (close_end q - close_start q) in
  let first := sub_part q 1 0 0 in let second := sub_part q 1 1 0 in is_close_part y first /\ is_close_part y second /\
  close_start first = close_start q /\ close_end first = m /\ close_start second = m /\ close_end second = close_end q.
Proof.
  intros H m first second. pose proof H as (_ & _ & (W & U & _) & _).
  destruct (sub_part_is_part y q 1 0 0 y_length H) as (P0 & _ & _ & S0 & E0); [lia |].
  destruct (sub_part_is_part y q 1 1 0 y_length H) as (P1 & _ & _ & S1 & E1); [lia |].
  change (0 + 2 ^ 0)%Z with 1%Z in E0. change (1 + 2 ^ 0)%Z with 2%Z in E1.
  unfold over in *. change (2 ^ 1)%Z with 2%Z in *. unfold m, first, second.
  split; [exact P0 |]. split; [exact P1 |]. repeat split; lra.
Qed.

Lemma next_of_right q : close_good q -> any_root three (close_roots q) = true ->
  match next_of distinct three q with
  | inl o => close_answers (close_start q) (close_end q) o
  | inr parts => Forall (narrower q) parts /\
      forall t, close_start q < t < close_end q -> at_ y t = 0 ->
        (exists r, In r parts /\ close_start r < t < close_end r) \/ told t \/ ~ Inside t
  end.
Proof.
  intros G A. pose proof G as (H & Max). pose proof (close_inside y q H) as In01. unfold next_of. cbv zeta.
  set (test := (test_from q <=? bits q)%Z). clearbody test.
  set (tested := ClosePart _ _ _ _ _ _).
  assert (Ga : close_good tested) by exact G. assert (Na : forall r, narrower tested r -> narrower q r) by (intros r n; exact n).
  assert (Known : forall o, (if test then inside_from (low q) (unit_bits q) (Some (width_bits q)) else undecided) = o ->
    close_answers (close_start q) (close_end q) o).
  { intros o E. destruct test; [| now subst].
    pose proof (fun t T => inside_from_right q t H T) as R. cbv zeta in R. rewrite E in R. destruct o; simpl; auto.
    - intros t T _. right. now apply (R t T).
    - destruct (rooted_part q G A) as (t & T & Z). exists t. split; [lra |]. split; auto. now apply (R t T). }
  destruct (if test then _ else undecided); try (now apply Known). clear Known.
  destruct (test && normal_vanishes_at_root distinct three q) eqn:V.
  { apply andb_prop in V. destruct V as (_ & V). intros t T Z. right. now apply (vanishes_right q). }
  clear V. destruct (can_be_narrowed tested) eqn:C; cbn [negb]; [| easy].
  destruct (narrowed three tested) as [r |] eqn:E.
  { destruct (narrowed_right tested r Ga C A E) as (Nr & All). split; [constructor; [now apply Na | constructor] |].
    intros t T Z. destruct (All t T Z); auto. left. exists r. split; [now left | easy]. }
  destruct (middle_of q H) as (Em & Zm). set (m := close_start q + / 2 * (close_end q - close_start q)) in *.
  pose proof H as (_ & _ & (W & U & Lo & Hi) & _).
  assert (Inm : contact_in_middle tested = true <-> Inside m).
  { unfold contact_in_middle, tested. cbn [low unit_bits width_bits]. rewrite <- Em, <- inside_from_place.
    - destruct (inside_from _ _ _); split; intros X; try discriminate X; easy.
    - rewrite Z.pow_add_r by lia. pose proof (Z.pow_pos_nonneg 2 (width_bits q)). lia.
    - unfold max_bits in *. lia. }
  destruct (halves_of tested H) as (_ & _ & S0 & E0 & S1 & E1).
  change (close_start tested) with (close_start q) in *. change (close_end tested) with (close_end q) in *. fold m in E0, S1.
  destruct ((_ =? 0)%Z && contact_in_middle tested) eqn:M.
  - apply andb_prop in M. destruct M as (M0 & M1). exists m. split; [unfold m; lra |]. split; [now apply Zm | now apply Inm].
  - split.
    + constructor; [| constructor; [| constructor]]; apply Na, sub_part_narrower; auto; cbn; lia.
    + intros t T Z. destruct (Rtotal_order t m) as [L | [-> | L]].
      * left. exists (sub_part tested 1 0 0). split; [now left | lra].
      * right. right. intros I. apply Zm in Z. apply Inm in I. rewrite Z, I in M. discriminate.
      * left. exists (sub_part tested 1 1 0). split; [right; now left | lra].
Qed.

Theorem by_narrowing_right steps waiting found :
  Forall (fun q => close_good q /\ any_root three (close_roots q) = true) waiting ->
  (by_narrowing distinct three steps waiting found = collides ->
     found = collides \/ exists t, 0 <= t <= 1 /\ at_ y t = 0 /\ Inside t) /\
  (by_narrowing distinct three steps waiting found = separate ->
     found = separate /\ forall q, In q waiting -> close_answers (close_start q) (close_end q) separate).
Proof.
  revert waiting found. induction steps as [| steps IH]; intros waiting found G; [easy |].
  destruct waiting as [| q rest]; cbn [by_narrowing]; [split; intros E; [now left | split; [easy | intros q []]] |].
  inversion_clear G as [| ? ? (Gq & Aq) Gr]. pose proof (next_of_right q Gq Aq) as W.
  destruct (next_of distinct three q) as [[ | | ] | parts].
  - destruct (IH rest found Gr) as (Yes & No). split; auto. intros E. destruct (No E) as (F & A). split; auto.
    intros q' [<- | I]; auto.
  - split; [auto | discriminate].
  - destruct (IH rest undecided Gr) as (Yes & No). split; intros E.
    + destruct (Yes E); auto. discriminate.
    + destruct (No E). discriminate.
  - destruct W as (N & All). assert (Gn : Forall (fun q => close_good q /\ any_root three (close_roots q) = true)
      (that_wait three parts ++ rest)).
    { apply Forall_app. split; auto. apply Forall_forall. intros r I. apply filter_In in I. destruct I as (I & Ar).
      rewrite Forall_forall in N. split; auto. now destruct (N r I). }
    destruct (IH _ found Gn) as (Yes & No). split; auto. intros E. destruct (No E) as (F & A). split; auto.
    intros q' [<- | I]; [| apply A, in_or_app; now right]. intros t T Z.
    destruct (All t T Z) as [(r & I & Tr) | K]; auto. destruct (any_root three (close_roots r)) eqn:Ar.
    + apply (A r); auto. apply in_or_app. left. now apply filter_In.
    + left. apply (rootless_part r); auto. rewrite Forall_forall in N. now destruct (N r I).
Qed.

End Known.

Lemma whole_is_close_part : is_close_part y whole_part /\ close_start whole_part = 0 /\ close_end whole_part = 1.
Proof.
  assert (S : close_start whole_part = 0) by (unfold close_start, over; cbn; lra).
  assert (E : close_end whole_part = 1) by (unfold close_end, over; cbn; lra).
  split; [| easy]. split; [unfold whole_part; cbn; now rewrite <- y_length; unfold y; rewrite map_length |].
  split; [reflexivity |]. split; [cbn; lia |]. exists 1. split; [lra |]. rewrite S, E, part_of_all by easy.
  cbn [whole_part close_y]. fold y. rewrite <- (map_id y) at 1. apply map_ext. intros x. ring.
Qed.
Definition distinct_flag : bool := negb (same_sign (sign_of_real (discriminant y)) zero).
Definition three_flag : bool := same_sign (sign_of_real (discriminant y)) positive.
Lemma flags_right : (distinct_flag = true -> discriminant y <> 0) /\ (three_flag = true -> 0 < discriminant y) /\
  (three_flag = false -> discriminant y <= 0).
Proof.
  unfold distinct_flag, three_flag. cases_of_sign (discriminant y); simpl; repeat split; intros; try discriminate; lra.
Qed.

Lemma close_contact_answers steps : close_known_roots distinct_flag three_flag -> close_answers 0 1 (close_contact steps).
Proof.
  intros K. destruct whole_is_close_part as (W & S & E). assert (G : close_good whole_part) by (split; [exact W | easy]).
  unfold close_contact. fold distinct_flag three_flag. cbv zeta.
  destruct (by_narrowing_right distinct_flag three_flag K steps (that_wait three_flag [whole_part]) separate) as (Yes & No).
  { apply Forall_forall. intros q I. apply filter_In in I. destruct I as ([<- | []] & A). auto. }
  destruct (by_narrowing _ _ _ _ _).
  - destruct (No eq_refl) as (_ & A). destruct (any_root three_flag (close_roots whole_part)) eqn:R.
    + specialize (A whole_part ltac:(apply filter_In; split; [now left | easy])). now rewrite S, E in A.
    + intros t T Z. left. apply (rootless_part _ _ K whole_part G R); auto. lra.
  - now destruct (Yes eq_refl).
  - exact I.
Qed.

(** ** Waiting intervals *)

Definition all_changes (parts : list close_part) : nat := list_sum (map (fun q => count (close_roots q)) parts).
Lemma all_changes_cons q l : all_changes (q :: l) = (count (close_roots q) + all_changes l)%nat.
Proof. reflexivity. Qed.
Lemma next_narrower distinct three q parts : close_good q -> next_of distinct three q = inr parts ->
  Forall (narrower q) parts /\ (length parts <= 2)%nat /\ (all_changes parts <= count (close_roots q))%nat.
Proof.
  intros G. pose proof G as (H & _). pose proof (close_inside y q H) as In01. unfold next_of. cbv zeta.
  set (test := (test_from q <=? bits q)%Z). clearbody test. set (tested := ClosePart _ _ _ _ _ _).
  assert (Ga : close_good tested) by exact G. assert (Na : forall r, narrower tested r -> narrower q r) by (intros r n; exact n).
  destruct (if test then _ else undecided); try discriminate. destruct (test && _); [discriminate |].
  destruct (can_be_narrowed tested) eqn:C; cbn [negb]; [| discriminate].
  destruct (narrowed three tested) as [r |] eqn:E.
  { apply narrowed_narrower in E; auto. apply proj1, Na in E. intros I. injection I as <-. split; [constructor; auto |].
    split; [simpl; lia |]. rewrite all_changes_cons. destruct E as (_ & _ & _ & _ & E). cbn. lia. }
  destruct ((_ =? 0)%Z && _); [discriminate |]. intros I. injection I as <-.
  pose proof H as (_ & _ & (W & U & _) & _). destruct (halves_of tested H) as (P0 & P1 & S0 & E0 & S1 & E1).
  change (close_start tested) with (close_start q) in *. change (close_end tested) with (close_end q) in *.
  split; [| split; [simpl; lia |]].
  - constructor; [| constructor; [| constructor]]; apply Na, sub_part_narrower; auto; cbn; lia.
  - rewrite !all_changes_cons, Nat.add_0_r, (close_changes y _ P0), (close_changes y _ P1), (close_changes y q H).
    rewrite S0, E0, S1, E1.
    destruct (parts_changes y (close_start q) (close_start q + / 2 * (close_end q - close_start q)) (close_end q) y_length
      ltac:(lra)) as (Le & _). lia.
Qed.

(** At most three intervals fit in the code's array. *)
Definition close_waiting_fits (waiting : list close_part) : Prop :=
  Forall (fun q => close_good q /\ (0 < count (close_roots q))%nat) waiting /\ (all_changes waiting <= 3)%nat.
Theorem three_close_parts_wait distinct three q rest parts : close_waiting_fits (q :: rest) ->
  next_of distinct three q = inr parts ->
  close_waiting_fits (that_wait three parts ++ rest) /\ (length (that_wait three parts ++ rest) <= 3)%nat.
Proof.
  intros (F & S) E. inversion_clear F as [| ? ? (G & _) Fr]. destruct (next_narrower _ _ _ _ G E) as (N & _ & C).
  rewrite all_changes_cons in S.
  assert (Sum : forall a b, all_changes (a ++ b) = (all_changes a + all_changes b)%nat).
  { intros a1 b1. unfold all_changes. now rewrite map_app, list_sum_app. }
  assert (Fewer : (all_changes (that_wait three parts) <= all_changes parts)%nat).
  { unfold that_wait. clear. induction parts as [| r parts IH]; [easy |]. cbn [filter].
    destruct (any_root three (close_roots r)); rewrite !all_changes_cons; lia. }
  assert (W : close_waiting_fits (that_wait three parts ++ rest)).
  { split; [| rewrite Sum; lia]. apply Forall_app. split; auto. apply Forall_forall. intros r I. apply filter_In in I.
    destruct I as (I & A). rewrite Forall_forall in N. destruct (N r I) as (Gr & _). split; auto.
    pose proof Gr as ((L & Er & _) & _). rewrite Er in *. apply (any_root_count three); auto. now rewrite map_length. }
  split; [exact W |]. destruct W as (Fw & Sw). clear - Fw Sw. revert Sw.
  enough (length (that_wait three parts ++ rest) <= all_changes (that_wait three parts ++ rest))%nat by lia.
  induction Fw as [| r l (_ & P) Fw IH]; [easy |]. rewrite all_changes_cons. cbn [length]. lia.
Qed.

(** ** The loop ends *)

Definition close_work (waiting : list close_part) : Z :=
  fold_right (fun q sum => 3 ^ (max_bits + 1 - bits q) + sum)%Z 0%Z waiting.
Lemma close_work_positive waiting : (0 <= close_work waiting)%Z.
Proof.
  induction waiting as [| q rest IH]; [easy |]. cbn [close_work fold_right] in *.
  pose proof (Z.pow_nonneg 3 (max_bits + 1 - bits q)). unfold close_work in IH. lia.
Qed.
Lemma close_next_work distinct three q rest parts : close_good q -> Forall close_good rest ->
  next_of distinct three q = inr parts ->
  Forall close_good (that_wait three parts ++ rest) /\
  (close_work (that_wait three parts ++ rest) < close_work (q :: rest))%Z.
Proof.
  intros G Gr E. destruct (next_narrower _ _ _ _ G E) as (N & L & _). split.
  - apply Forall_app. split; auto. apply Forall_forall. intros r I. apply filter_In in I. destruct I as (I & _).
    rewrite Forall_forall in N. now destruct (N r I).
  - assert (Sum : forall a1 b1, close_work (a1 ++ b1) = (close_work a1 + close_work b1)%Z).
    { intros a1 b1. unfold close_work. induction a1 as [| r a1 IH]; [easy |]. cbn [app fold_right]. rewrite IH. ring. }
    change (close_work (q :: rest)) with (3 ^ (max_bits + 1 - bits q) + close_work rest)%Z. rewrite Sum.
    enough (close_work (that_wait three parts) < 3 ^ (max_bits + 1 - bits q))%Z by lia.
    destruct G as ((_ & _ & (W & U & _) & _) & M).
    set (k := (max_bits - bits q)%Z). assert (K : (0 <= k)%Z) by (unfold k, bits; lia).
    replace (max_bits + 1 - bits q)%Z with (k + 1)%Z by (unfold k; ring).
    assert (P : (0 < 3 ^ k)%Z) by (apply Z.pow_pos_nonneg; lia). rewrite Z.pow_add_r by lia. change (3 ^ 1)%Z with 3%Z.
    enough (close_work (that_wait three parts) <= Z.of_nat (length parts) * 3 ^ k)%Z by nia.
    clear E L. induction N as [| r parts Nr N IH]; [easy |]. cbn [that_wait filter length]. rewrite Nat2Z.inj_succ.
    destruct Nr as (_ & _ & _ & B & _).
    assert (Le : (3 ^ (max_bits + 1 - bits r) <= 3 ^ k)%Z) by (apply Z.pow_le_mono_r; unfold k; lia).
    unfold that_wait in IH. destruct (any_root three (close_roots r)); [| lia].
    cbn [close_work fold_right]. unfold close_work in IH. lia.
Qed.
Lemma enough_close_steps distinct three steps : forall waiting found more, Forall close_good waiting ->
  (close_work waiting < Z.of_nat steps)%Z -> (steps <= more)%nat ->
  by_narrowing distinct three more waiting found = by_narrowing distinct three steps waiting found.
Proof.
  induction steps as [| steps IH]; intros waiting found more F W M.
  { pose proof (close_work_positive waiting). lia. }
  destruct more as [| more]; [lia |]. destruct waiting as [| q rest]; [easy |]. cbn [by_narrowing].
  inversion_clear F as [| ? ? Fq Fr].
  change (close_work (q :: rest)) with (3 ^ (max_bits + 1 - bits q) + close_work rest)%Z in W.
  assert (P : (0 < 3 ^ (max_bits + 1 - bits q))%Z).
  { destruct Fq as ((_ & _ & (Wq & Uq & _) & _) & Mq). apply Z.pow_pos_nonneg; unfold bits; lia. }
  destruct (next_of distinct three q) as [[ | | ] | parts] eqn:E; try (apply IH; auto; lia); [easy |].
  destruct (close_next_work _ _ _ rest _ Fq Fr E) as (Fn & Wn).
  change (close_work (q :: rest)) with (3 ^ (max_bits + 1 - bits q) + close_work rest)%Z in Wn.
  apply IH; auto; lia.
Qed.
Theorem close_contact_ends : exists enough, forall steps, (enough <= steps)%nat ->
  close_contact steps = close_contact enough.
Proof.
  exists (Datatypes.S (Z.to_nat (close_work [whole_part]))). intros steps M. unfold close_contact. cbv zeta.
  destruct whole_is_close_part as (W & _). assert (G : close_good whole_part) by (split; [exact W | easy]).
  pose proof (close_work_positive [whole_part]). set (work := close_work [whole_part]) in *.
  assert (Le : forall three, (close_work (that_wait three [whole_part]) <= work)%Z).
  { intros three. unfold that_wait. cbn [filter]. destruct (any_root three (close_roots whole_part)); [unfold work; lia | easy]. }
  apply enough_close_steps; [| | exact M].
  - apply Forall_forall. intros q I. apply filter_In in I. now destruct I as ([<- | []] & _).
  - clearbody work. rewrite Nat2Z.inj_succ, Z2Nat.id by easy. specialize (Le (same_sign (sign_of_real (discriminant y)) positive)). lia.
Qed.

End Query.

Section Answers.

Context (edges : bool) (b c p : @vector_form integers) (degree_b : degree b 1) (degree_c : degree c 1)
  (degree_p : degree p 1) (below_b : below 253 b) (below_c : below 253 c) (below_p : below 253 p)
  (estimated_root : list Z -> Z -> Z) (root_exponent : list Z -> Z) (estimated_pair : list Z -> option ((Z -> Z) * Z)).
Let y : list R := map IZR (y_form b c p).
Let contact := close_contact edges b c p estimated_root root_exponent estimated_pair.
Let y_length : length y = 4%nat := InteriorContact.y_length b c p degree_b degree_c degree_p.
Let y_at t : at_ y t = det (vector_at b t) (vector_at c t) (vector_at p t) :=
  InteriorContact.y_at b c p degree_b degree_c degree_p t.

(** The stage alone. *)
Theorem close_contact_right steps :
  (contact steps = collides -> contact_inside edges b c p) /\
  (contact steps = separate -> forall t, 0 < t < 1 -> at_ y t = 0 -> ~ multiple_root y t ->
    ~ weights_positive edges (vector_at b t) (vector_at c t) (vector_at p t)).
Proof.
  destruct (classic (Forall (eq 0) y)) as [F | N].
  { assert (M : forall t, multiple_root y t).
    { intros t. exists 0, 0. revert F. generalize y y_length. intros w L. four w L. intros F.
      repeat match goal with H : Forall _ (_ :: _) |- _ => inversion_clear H end. subst.
      unfold double_times, linear_times. apply same_four; ring. }
    split; [| intros _ t _ _ K; now destruct (K (M t))]. intros E. exfalso.
    assert (C : inner_sign_changes y = SignChanges 0 false zero).
    { revert F. generalize y y_length. intros w L. four w L. intros F.
      repeat match goal with H : Forall _ (_ :: _) |- _ => inversion_clear H end. subst.
      unfold inner_sign_changes. cbn [map]. now rewrite (sign_zero 0 eq_refl). }
    unfold contact, close_contact, that_wait, whole_part in E. fold y in E. cbn [filter close_roots] in E. rewrite C in E.
    unfold any_root in E. cbn [opposite count Nat.ltb Nat.leb orb] in E. rewrite andb_false_r in E.
    destruct steps; discriminate E. }
  destruct (flags_right b c p) as (Di & Tr & Le).
  assert (K : close_known_roots b c p (multiple_root y) (distinct_flag b c p) (three_flag b c p)).
  { split; [exact N |]. split; [exact Tr |]. intros E. destruct (one_real_root y y_length (Le E)) as (l0 & l1 & q & H).
    exists l0, l1, q. intros t T. destruct (H t T) as (A & B & Z). split; auto. split; auto. intros Zq. destruct (Z Zq) as (M & D).
    split; auto. destruct (distinct_flag b c p); auto. now apply Di in D. }
  pose proof (close_contact_answers edges b c p degree_b degree_c degree_p below_b below_c below_p
    estimated_root root_exponent estimated_pair _ steps K) as A. fold contact in A.
  destruct (contact steps); (split; [intros E; try discriminate E | intros E; try discriminate E]).
  - intros t T Z M I. destruct (A t T Z); auto.
  - destruct A as (t & T & Z & I). exists t. split; [easy |]. split; [now rewrite <- y_at | exact I].
Qed.

(** Facts that hold if interior_contact is uncertain. *)
Lemma uncertain_interior extent_x extent_y extent_z estimate refine steps :
  interior_contact edges b c p extent_x extent_y extent_z estimate refine steps = undecided ->
  (forall t, t = 0 \/ t = 1 -> at_ y t = 0 ->
    ~ weights_positive edges (vector_at b t) (vector_at c t) (vector_at p t)) /\
  known_roots edges b c p (distinct_flag b c p) (three_flag b c p).
Proof.
  unfold interior_contact. fold y.
  assert (Ends : at_ y 0 = nth 0 y 0 /\ at_ y 1 = nth 3 y 0).
  { generalize y y_length. intros w L. four w L. unfold at_. simpl. split; ring. }
  destruct Ends as (E0 & E1).
  pose proof (positive_at_right edges b c p degree_b degree_c degree_p 1 0 ltac:(lra)) as I0. replace (0 / (1 + 0)) with 0 in I0 by field.
  pose proof (positive_at_right edges b c p degree_b degree_c degree_p 0 1 ltac:(lra)) as I1. replace (1 / (0 + 1)) with 1 in I1 by field.
  destruct (is_0 (nth 0 y 0) && _) eqn:S0; [discriminate |]. destruct (is_0 (nth 3 y 0) && _) eqn:S1; [discriminate |].
  cbv zeta. destruct (Nat.eqb_spec (count (inner_sign_changes y)) 0) as [| N]; [discriminate |]. intros U. split.
  { intros t [-> | ->] Z I.
    - rewrite E0 in Z. apply is_0_true in Z. apply I0 in I. rewrite Z, I in S0. discriminate.
    - rewrite E1 in Z. apply is_0_true in Z. apply I1 in I. rewrite Z, I in S1. discriminate. }
  destruct (flags_right b c p) as (Di & Tr & Le).
  destruct (Nat.ltb_spec 1 (count (inner_sign_changes y))) as [Many | One].
  - pose proof (at_multiple_root_right edges b c p degree_b degree_c degree_p Many) as M.
    assert (F : at_multiple_root edges b c p =
      (fst (fst (at_multiple_root edges b c p)), distinct_flag b c p, three_flag b c p)).
    { unfold at_multiple_root, linear_of_multiple, distinct_flag, three_flag. fold y. fold (discriminant y).
      cbv zeta. destruct (negb (same_sign (sign_of_real (discriminant y)) zero)); [reflexivity |].
      destruct (is_0 (c2 (hessian y))); [reflexivity |]. destruct (below_0 (c1 (hessian y))); reflexivity. }
    rewrite F in M, U. destruct M as (A & K). apply K. destruct (fst (fst _)); try discriminate; auto.
  - split; [apply changes_moving; [exact y_length | fold y; lia] |]. split; [exact Tr |]. intros _.
    destruct (one_change_crosses y y_length ltac:(lia)) as (l0 & l1 & q & H). exists l0, l1, q. intros t T.
    destruct (H t T) as (A & B' & F). split; auto. split; auto. intros Z. destruct (F Z).
Qed.
Theorem decided_inside extent_x extent_y extent_z estimate refine steps more :
  interior_contact edges b c p extent_x extent_y extent_z estimate refine steps = undecided ->
  (contact more = collides -> contact_inside edges b c p) /\
  (contact more = separate -> ~ contact_inside edges b c p).
Proof.
  intros U. apply uncertain_interior in U. destruct U as (Ends & K).
  split; [apply close_contact_right |]. intros E.
  pose proof (close_contact_answers edges b c p degree_b degree_c degree_p below_b below_c below_p
    estimated_root root_exponent estimated_pair
    (fun t => ~ weights_positive edges (vector_at b t) (vector_at c t) (vector_at p t)) more K) as A.
  fold contact in A. rewrite E in A. intros (t & T & Z & I). rewrite <- y_at in Z.
  destruct (Req_dec t 0) as [-> |]; [now apply (Ends 0 (or_introl eq_refl)) |].
  destruct (Req_dec t 1) as [-> |]; [now apply (Ends 1 (or_intror eq_refl)) |].
  destruct (A t ltac:(lra) Z) as [N | N]; now apply N.
Qed.

End Answers.

(** ** Queries *)

(** decide_to_the_end of ccd/exact/integers.cpp. *)
Definition decide_to_the_end (edges : bool) (extent_x extent_y extent_z : Z)
    (estimate : part -> Z) (refine : Z -> part -> Z -> Z -> Z -> Z) (steps : nat)
    (estimated_root : list Z -> Z -> Z) (root_exponent : list Z -> Z)
    (estimated_pair : list Z -> option ((Z -> Z) * Z)) (more : nat)
    (m0 m1 m2 m3 : moving) (q0 q1 q2 q3 : integer_motion) : outcome :=
  let b := side_b edges difference q0 q1 q2 q3 in
  let c := side_c edges difference q0 q1 q2 q3 in
  let p := side_p edges difference q0 q1 q2 q3 in
  match contact_of edges extent_x extent_y extent_z estimate refine steps m0 m1 m2 m3 q0 q1 q2 q3 with
  | undecided => close_contact edges b c p estimated_root root_exponent estimated_pair more
  | found => found
  end.

Section Decisions.

Context (unit : point) (U : units unit) (extent_x extent_y extent_z : Z) (estimate : part -> Z)
  (refine : Z -> part -> Z -> Z -> Z -> Z) (steps more : nat) (estimated_root : list Z -> Z -> Z)
  (root_exponent : list Z -> Z) (estimated_pair : list Z -> option ((Z -> Z) * Z)).
Let decide edges := decide_to_the_end edges extent_x extent_y extent_z estimate refine steps
  estimated_root root_exponent estimated_pair more.

Lemma query_to_the_end_right edges m0 m1 m2 m3 q0 q1 q2 q3 : in_integers unit m0 q0 -> in_integers unit m1 q1 ->
  in_integers unit m2 q2 -> in_integers unit m3 q3 -> below 253 (side_b edges difference q0 q1 q2 q3) ->
  below 253 (side_c edges difference q0 q1 q2 q3) -> below 253 (side_p edges difference q0 q1 q2 q3) ->
  let found := decide edges m0 m1 m2 m3 q0 q1 q2 q3 in
  (found = collides -> query_collides edges m0 m1 m2 m3) /\ (found = separate -> ~ query_collides edges m0 m1 m2 m3).
Proof.
  intros I0 I1 I2 I3 Bb Bc Bp. cbv zeta. unfold decide, decide_to_the_end. cbv zeta.
  pose proof (query_decision_right unit U extent_x extent_y extent_z estimate refine steps edges m0 m1 m2 m3 q0 q1 q2 q3
    I0 I1 I2 I3) as R.
  cbv beta zeta in R. destruct (contact_of _ _ _ _ _ _ _ _ _ _ _ _ _ _ _) eqn:E; [exact R | exact R |]. clear R.
  unfold contact_of in E. cbv zeta in E. destruct (certainly_rootless _); [discriminate |].
  pose proof (queries_contact unit U edges m0 m1 m2 m3 q0 q1 q2 q3 I0 I1 I2 I3) as Border.
  destruct (existsb _ _); [discriminate |]. destruct (query_degrees edges q0 q1 q2 q3) as (Db & Dc & Dp).
  destruct (decided_inside edges _ _ _ Db Dc Dp Bb Bc Bp estimated_root root_exponent estimated_pair
    extent_x extent_y extent_z estimate refine steps more E) as (Yes & No).
  rewrite <- (query_border_units unit) in Border by easy. rewrite <- (query_units unit) by easy.
  unfold in_integers in *. rewrite <- I0, <- I1, <- I2, <- I3 in *.
  rewrite <- query_contact_inside by (intros H; now apply Border in H). auto.
Qed.
Theorem face_to_the_end_right m0 m1 m2 m3 v f0 f1 f2 : in_integers unit m0 v -> in_integers unit m1 f0 ->
  in_integers unit m2 f1 -> in_integers unit m3 f2 ->
  below 253 (difference f1 f0) -> below 253 (difference f2 f0) -> below 253 (difference v f0) ->
  let found := decide false m0 m1 m2 m3 v f0 f1 f2 in
  (found = collides -> vertex_face_collides m0 m1 m2 m3) /\ (found = separate -> ~ vertex_face_collides m0 m1 m2 m3).
Proof. exact (query_to_the_end_right false m0 m1 m2 m3 v f0 f1 f2). Qed.
Theorem edges_to_the_end_right m0 m1 m2 m3 a0 a1 b0 b1 : in_integers unit m0 a0 -> in_integers unit m1 a1 ->
  in_integers unit m2 b0 -> in_integers unit m3 b1 ->
  below 253 (difference a1 a0) -> below 253 (difference b1 b0) -> below 253 (difference b0 a0) ->
  let found := decide true m0 m1 m2 m3 a0 a1 b0 b1 in
  (found = collides -> edge_edge_collides m0 m1 m2 m3) /\ (found = separate -> ~ edge_edge_collides m0 m1 m2 m3).
Proof. exact (query_to_the_end_right true m0 m1 m2 m3 a0 a1 b0 b1). Qed.

End Decisions.

(** ** Widths *)

(** Expressions of proofs/integers/FixedWidths.v, with differences below 2^253: s and t of 24 words, at most 2^max_bits.
    These are the numbers that inside_from and normal_vanishes compute. *)
Section Widths.
Import FixedWidths.
Definition place_number (x : list Z) : expression := Given 24 1 max_bits x.
Definition place_numbers (b c p : vector) (s t s' t' : list Z) : list expression :=
  let s := place_number s in
  let t := place_number t in
  let s' := place_number s' in
  let t' := place_number t' in
  let n := components (cross_form b c) in
  inside_at b c p s t ++
  flat_map (fun pq : polynomial * polynomial =>
    let m := map Opposite (FixedWidths.cross_product (fst pq) (snd pq)) in
    [nth 1 m (Whole 0) ⊗ s ⊖ nth 0 m (Whole 0) ⊗ t; nth 0 m (Whole 0) ⊗ t' ⊖ nth 1 m (Whole 0) ⊗ s']) (pairs n) ++
  common_roots_numbers n ++ map (fun f => value_at f s t) n ++ map (fun f => value_at f s' t') n.
(** The number of words of the sum of Y's coefficients on an interval. *)
Definition y_words : nat := 88.
Definition sum_of_coefficients (y : list (list Z)) : expression :=
  let y := map (Given y_words 1 most_y_bits) y in
  nth 0 y (Whole 0) ⊕ nth 1 y (Whole 0) ⊕ nth 2 y (Whole 0) ⊕ nth 3 y (Whole 0).
Theorem close_widths b c p s t s' t' y0 y1 y2 y3 :
  forallb fine (interior_numbers (moving 4 b) (moving 4 c) (moving 4 p)) = true /\
  forallb fine (place_numbers (moving 4 b) (moving 4 c) (moving 4 p) s t s' t') = true /\
  forallb fine [sum_of_coefficients [y0; y1; y2; y3]] = true.
Proof. split; [apply interior_widths; simpl; auto | split]; apply all_measured; vm_cast_no_check (eq_refl true). Qed.
End Widths.

(** All numbers that sub_part computes fit the words of the interval's coefficients. *)
Section Narrowed.
Variables m v : Z.
(** At most k times m·v^e. *)
Definition within_units (k : Z) (e : nat) (x : Z) : Prop := (0 <= k /\ Z.abs x <= k * (m * v ^ Z.of_nat e))%Z.
Lemma within_sum k l e x y : within_units k e x -> within_units l e y -> within_units (k + l) e (x + y).
Proof. unfold within_units. generalize (m * v ^ Z.of_nat e)%Z. intros. lia. Qed.
Lemma within_difference k l e x y : within_units k e x -> within_units l e y -> within_units (k + l) e (x - y).
Proof. unfold within_units. generalize (m * v ^ Z.of_nat e)%Z. intros. lia. Qed.
Lemma within_product k e x a : (0 <= a <= v)%Z -> within_units k e x -> within_units k (S e) (x * a).
Proof.
  unfold within_units. intros A (K & H). split; [easy |].
  rewrite Nat2Z.inj_succ, Z.pow_succ_r, Z.abs_mul, (Z.abs_eq a) by lia.
  replace (k * (m * (v * v ^ Z.of_nat e)))%Z with (k * (m * v ^ Z.of_nat e) * v)%Z by ring.
  apply Z.mul_le_mono_nonneg; lia.
Qed.
Lemma within_more k e d x : (1 <= v)%Z -> within_units k e x -> within_units k (d + e) x.
Proof.
  intros V H. induction d as [| d IH]; [exact H |]. pose proof (within_product k (d + e) x 1 ltac:(lia) IH) as P.
  now rewrite Z.mul_1_r in P.
Qed.
End Narrowed.

(** All intermediate numbers, in sub_part's order. *)
Definition sub_numbers (y0 y1 y2 y3 v a q : Z) : list Z :=
  let thrice := (y0 + y0 + y0)%Z in
  let '(c0, c1, c2, c3) := power_coefficients y0 y1 y2 y3 v in
  let d2 := (c2 + c3 * a)%Z in
  let d1 := (c1 + d2 * a)%Z in
  let d0 := (c0 + d1 * a)%Z in
  let e2 := (d2 + c3 * a)%Z in
  let e1 := (d1 + e2 * a)%Z in
  let f2 := (e2 + c3 * a)%Z in
  let w1 := (e1 * q)%Z in
  let w2 := (f2 * (q * q))%Z in
  let w3 := (c3 * (q * q * q))%Z in
  [y0 + y0; thrice; c0; y1 - thrice; c1; y2 - y1; y2 - y1 - y1; y2 - y1 - y1 + thrice; c2; y3 - y2; y3 - y2 + y1; c3;
   c3 * a; d2; d2 * a; d1; d1 * a; d0; e2; e2 * a; e1; f2; w1; w2; w3;
   d0 + d0; d0 + d0 + w1; d0 + d0 + w1 + d0; d0 + d0 + w1 + d0 + w1; d0 + d0 + w1 + d0 + w1 + w2;
   d0 + w1; d0 + w1 + w2; d0 + w1 + w2 + w3]%Z.
Theorem narrowed_fits y0 y1 y2 y3 n a w : (0 <= n <= 60)%Z -> (0 <= a)%Z -> (0 <= w)%Z -> (a + 2 ^ w <= 2 ^ n)%Z ->
  Forall (fun h => BoundedInteger.bit_length h <= most_y_bits)%Z [y0; y1; y2; y3] ->
  Forall (fun h => Z.abs h < 2 ^ (64 * Z.of_nat y_words - 1))%Z (sub_numbers y0 y1 y2 y3 (2 ^ n) a (2 ^ w)).
Proof.
  intros N A W B F.
  assert (F' : Forall (fun h => Z.abs h <= 2 ^ most_y_bits)%Z [y0; y1; y2; y3]).
  { eapply Forall_impl; [| exact F]. intros h H. cbv beta in H. destruct (BoundedInteger.bit_length_bounds h) as (H0 & H1 & _).
    apply Z.le_trans with (1 := H1). now apply Z.pow_le_mono_r. }
  clear F. assert (Q : (0 < 2 ^ w)%Z) by (apply Z.pow_pos_nonneg; lia).
  assert (V1 : (2 ^ n <= 2 ^ 60)%Z) by (apply Z.pow_le_mono_r; lia).
  assert (V0 : (1 <= 2 ^ n)%Z) by lia.
  revert V1 V0 Q B. generalize (2 ^ n)%Z (2 ^ w)%Z. intros v q V1 V0 Q B.
  assert (PM : (0 < 2 ^ most_y_bits)%Z) by (apply Z.pow_pos_nonneg; unfold most_y_bits; lia).
  assert (Lim : (128 * (2 ^ most_y_bits * v ^ 3) <= 2 ^ (64 * Z.of_nat y_words - 1))%Z).
  { apply Z.le_trans with (128 * (2 ^ most_y_bits * (2 ^ 60) ^ 3))%Z; [| apply Zle_bool_imp_le; vm_compute; reflexivity].
    apply Z.mul_le_mono_nonneg_l; [lia |]. apply Z.mul_le_mono_nonneg_l; [lia |]. apply Z.pow_le_mono_l. lia. }
  revert PM Lim F'. generalize (2 ^ most_y_bits)%Z. intros m PM Lim F'.
  assert (Small : forall k d e x, (d + e = 3)%nat -> (k < 128)%Z -> within_units m v k e x ->
    (Z.abs x < 2 ^ (64 * Z.of_nat y_words - 1))%Z).
  { intros k d e x D K H. apply (within_more m v k e d x V0) in H. rewrite D in H. destruct H as (K0 & H).
    change (Z.of_nat 3) with 3%Z in H.
    assert (0 < m * v ^ 3)%Z by (apply Z.mul_pos_pos; [lia | apply Z.pow_pos_nonneg; lia]).
    apply Z.le_lt_trans with (1 := H). apply Z.lt_le_trans with (128 * (m * v ^ 3))%Z; [| exact Lim].
    apply Z.mul_lt_mono_pos_r; lia. }
  assert (Y : forall y, In y [y0; y1; y2; y3] -> within_units m v 1 0 y).
  { intros y H. rewrite Forall_forall in F'. specialize (F' y H). unfold within_units. cbn [Z.of_nat]. rewrite Z.pow_0_r. lia. }
  assert (Y0 := Y y0 ltac:(cbn; tauto)). assert (Y1 := Y y1 ltac:(cbn; tauto)).
  assert (Y2 := Y y2 ltac:(cbn; tauto)). assert (Y3 := Y y3 ltac:(cbn; tauto)). clear Y F'.
  assert (Sum := within_sum m v). assert (Less := within_difference m v).
  assert (Times := within_product m v).
  assert (Av : (0 <= a <= v)%Z) by lia. assert (Qv : (0 <= q <= v)%Z) by lia. assert (Vv : (0 <= v <= v)%Z) by lia.
  unfold sub_numbers, power_coefficients. rewrite !Z.mul_assoc.
  assert (T2 := Sum _ _ _ _ _ Y0 Y0). assert (T3 := Sum _ _ _ _ _ T2 Y0).
  set (thrice := (y0 + y0 + y0)%Z) in *.
  assert (C0 := Times _ _ _ _ Vv (Times _ _ _ _ Vv (Times _ _ _ _ Vv Y0))).
  assert (L1 := Less _ _ _ _ _ Y1 T3).
  assert (C1 := Times _ _ _ _ Vv (Times _ _ _ _ Vv L1)).
  assert (L2 := Less _ _ _ _ _ Y2 Y1). assert (L3 := Less _ _ _ _ _ L2 Y1). assert (L4 := Sum _ _ _ _ _ L3 T3).
  assert (C2 := Times _ _ _ _ Vv L4).
  assert (L5 := Less _ _ _ _ _ Y3 Y2). assert (L6 := Sum _ _ _ _ _ L5 Y1). assert (C3 := Less _ _ _ _ _ L6 Y0).
  set (c0 := (y0 * v * v * v)%Z) in *. set (c1 := ((y1 - thrice) * v * v)%Z) in *.
  set (c2 := ((y2 - y1 - y1 + thrice) * v)%Z) in *. set (c3 := (y3 - y2 + y1 - y0)%Z) in *.
  assert (P3 := Times _ _ _ _ Av C3).
  assert (D2 := Sum _ _ _ _ _ C2 P3). set (d2 := (c2 + c3 * a)%Z) in *.
  assert (PD2 := Times _ _ _ _ Av D2).
  assert (D1 := Sum _ _ _ _ _ C1 PD2). set (d1 := (c1 + d2 * a)%Z) in *.
  assert (PD1 := Times _ _ _ _ Av D1).
  assert (D0 := Sum _ _ _ _ _ C0 PD1). set (d0 := (c0 + d1 * a)%Z) in *.
  assert (E2 := Sum _ _ _ _ _ D2 P3). set (e2 := (d2 + c3 * a)%Z) in *.
  assert (PE2 := Times _ _ _ _ Av E2).
  assert (E1 := Sum _ _ _ _ _ D1 PE2). set (e1 := (d1 + e2 * a)%Z) in *.
  assert (F2 := Sum _ _ _ _ _ E2 P3). set (f2 := (e2 + c3 * a)%Z) in *.
  assert (W1 := Times _ _ _ _ Qv E1). set (w1 := (e1 * q)%Z) in *.
  assert (W2 := Times _ _ _ _ Qv (Times _ _ _ _ Qv F2)). set (w2 := (f2 * q * q)%Z) in *.
  assert (W3 := Times _ _ _ _ Qv (Times _ _ _ _ Qv (Times _ _ _ _ Qv C3))).
  set (w3 := (c3 * q * q * q)%Z) in *.
  assert (R0 := Sum _ _ _ _ _ D0 D0). assert (R1 := Sum _ _ _ _ _ R0 W1). assert (R2 := Sum _ _ _ _ _ R1 D0).
  assert (R3 := Sum _ _ _ _ _ R2 W1). assert (R4 := Sum _ _ _ _ _ R3 W2).
  assert (U0 := Sum _ _ _ _ _ D0 W1). assert (U1 := Sum _ _ _ _ _ U0 W2). assert (U2 := Sum _ _ _ _ _ U1 W3).
  clear - Small T2 T3 C0 L1 C1 L2 L3 L4 C2 L5 L6 C3 P3 D2 PD2 D1 PD1 D0 E2 PE2 E1 F2 W1 W2 W3 R0 R1 R2 R3 R4 U0 U1 U2.
  repeat apply Forall_cons; try apply Forall_nil;
    match goal with H : within_units _ _ ?k ?e ?x |- (Z.abs ?x < _)%Z => exact (Small k (3 - e)%nat e x eq_refl ltac:(lia) H) end.
Qed.
