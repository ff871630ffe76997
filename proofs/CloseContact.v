(** Where brackets of fixed width cannot tell (ccd/exact/close_contact.hpp, ccd/exact/integers.cpp): certain
    answers are right. Estimates of places are arbitrary functions: nothing depends on them.
    Results:
        as_many_changes, opposite_inside   what parts of a part have all its roots
        sub_part_right      its coefficients are those of Y on that part, times a positive number *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool Classical.
From Flocq Require Import Core.
From Errbound Require Import Sign Bernstein Subdivision Contact VertexEdge Decisions AxisUnits CubicRoots InteriorContact.
From Errbound Require BoundedInteger.
Import ListNotations.
Open Scope R_scope.

(** ** Parts of a cubic *)

(** The form at s0 s + s1 t and t0 s + t1 t. *)
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

(** The part between a and b. *)
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
Lemma discriminant_scaled k y : length y = 4%nat -> discriminant (map (Rmult k) y) = k ^ 4 * discriminant y.
Proof. intros L. four y L. unfold discriminant, hessian. cbn [map c0 c1 c2]. ring. Qed.
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

(** Signs just inside the ends of a part. *)
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

(** ** Two parts of a part change their signs no more often together, and once less if they part at a simple root *)

Definition parts_change_no_more : bool :=
  let all := [negative; zero; positive] in
  forallb (fun a => forallb (fun b => forallb (fun c => forallb (fun d =>
    forallb (fun ab => forallb (fun bc => forallb (fun cd =>
      forallb (fun abc => forallb (fun bcd => forallb (fun m =>
        Nat.leb (count (changes_of [a; ab; abc; m]) + count (changes_of [m; bcd; cd; d]) +
            (if same_sign m zero && negb (same_sign abc zero) then 1 else 0))
          (count (changes_of [a; b; c; d])))
      (signs_between abc bcd)) (signs_between bc cd)) (signs_between ab bc))
    (signs_between c d)) (signs_between b c)) (signs_between a b)) all) all) all) all.

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
  rewrite El, Er, Em. unfold inner_sign_changes. cbn [map]. clear El Er Em D0.
  assert (All : forall x, In (sign_of_real x) [negative; zero; positive]).
  { intros x. cases_of_sign x; simpl; auto. }
  assert (C : parts_change_no_more = true) by (vm_compute; reflexivity).
  unfold parts_change_no_more in C.
  assert (E : forall (P : sign -> bool) l x, forallb P l = true -> In x l -> P x = true)
    by (intros Pr l x F; now apply (proj1 (forallb_forall Pr l) F)).
  pose proof (E _ _ _ C (All y0)) as C1. pose proof (E _ _ _ C1 (All y1)) as C2.
  pose proof (E _ _ _ C2 (All y2)) as C3. pose proof (E _ _ _ C3 (All y3)) as C4. clear C C1 C2 C3.
  cbv beta in C4.
  assert (B : forall k l a b c, 0 < k -> 0 < l -> c = k * a + l * b ->
    In (sign_of_real c) (signs_between (sign_of_real a) (sign_of_real b)))
    by (intros; apply sign_between; eauto 6).
  pose proof (E _ _ _ C4 (B (3 * v) p y0 y1 ab ltac:(lra) P eq_refl)) as C5. clear C4. cbv beta in C5.
  pose proof (E _ _ _ C5 (B v p y1 y2 bc Pv P eq_refl)) as C6. clear C5. cbv beta in C6.
  pose proof (E _ _ _ C6 (B v (3 * p) y2 y3 cd Pv ltac:(lra) eq_refl)) as C7. clear C6. cbv beta in C7.
  pose proof (E _ _ _ C7 (B v p ab bc abc Pv P eq_refl)) as C8. clear C7. cbv beta in C8.
  pose proof (E _ _ _ C8 (B v p bc cd bcd Pv P eq_refl)) as C9. clear C8. cbv beta in C9.
  pose proof (E _ _ _ C9 (B (v / 3) (p / 3) abc bcd m ltac:(lra) ltac:(lra) eq_refl)) as C10.
  apply Nat.leb_le in C10. clear C9 All E B. split; [lia |]. intros D Zm. specialize (Ed Zm D).
  rewrite (sign_zero m Zm) in *. clearbody abc. cases_of_sign abc; try contradiction; cbn [same_sign negb andb] in C10; lia.
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
(** Descartes' rule is exact where all roots are real: a part of a part that changes its sign as often has
    all its roots. *)
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
(** And a part of a part with one crossing, at whose ends Y has opposite signs, has the crossing. *)
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
(** ** Their coefficients as integers *)

Section Forms.

Context {S : scalar}.

(** value_at(p, s, t) where p's coefficients and s, t are forms: Horner's rule, power is t^i. *)
Fixpoint form_from_term (sum p s t power : list S) : list S :=
  match p with
  | [] => sum
  | a :: l =>
      let next := plus_form (product sum s) (product [a] power) in
      match l with [] => next | _ => form_from_term next l s t (product power t) end
  end.
Definition value_at_forms (p s t : list S) : list S :=
  match p with [] => [] | a :: l => form_from_term [a] l s t t end.
(** sub_part's y: s and t are linear forms, whose end coefficients are those places in units of 2^-n. *)
Definition sub_form (whole : Z -> S) (y : list S) (n a w : Z) : list S :=
  let b := (a + 2 ^ w)%Z in
  value_at_forms y [whole (2 ^ n - a)%Z; whole (2 ^ n - b)%Z] [whole a; whole b].

End Forms.
Definition sub_y (y : list Z) (n a w : Z) : list Z := @sub_form integers (fun x => x) y n a w.

Lemma sub_y_substituted y n a w : length y = 4%nat -> map IZR (sub_y y n a w) =
  substituted (map IZR y) (IZR (2 ^ n - a)) (IZR (2 ^ n - (a + 2 ^ w))) (IZR a) (IZR (a + 2 ^ w)).
Proof.
  intros L. destruct y as [| y0 [| y1 [| y2 [| y3 [|]]]]]; try discriminate.
  unfold sub_y, sub_form. cbv zeta. generalize (2 ^ n - a)%Z (2 ^ n - (a + 2 ^ w))%Z a (a + 2 ^ w)%Z.
  intros s0 s1 t0 t1. cbn. rewrite ?plus_IZR, ?mult_IZR. rewrite ?plus_IZR, ?mult_IZR.
  apply same_four; repeat rewrite ?plus_IZR, ?mult_IZR; ring.
Qed.

(** What the coefficients are: those of the part between a/2^n and (a + 2^w)/2^n, times 2^3n. *)
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

(** ** Parts *)

(** close_contact::part: from low/2^unit_bits, 2^width_bits units wide. *)
Record close_part := ClosePart { close_y : list Z; close_roots : sign_changes; low : Z; unit_bits : Z;
  width_bits : Z; ask_from : Z }.
Definition bits (q : close_part) : Z := (unit_bits q - width_bits q)%Z.
Definition close_start (q : close_part) : R := over (low q) (unit_bits q).
Definition close_end (q : close_part) : R := over (low q + 2 ^ width_bits q) (unit_bits q).
Definition sub_part (q : close_part) (n a w : Z) : close_part :=
  let y := sub_y (close_y q) n a w in
  ClosePart y (inner_sign_changes (map IZR y)) (low q * 2 ^ (n - width_bits q) + a)%Z
    (unit_bits q + n - width_bits q)%Z w (ask_from q).
(** The place times 2^n, rounded, is `middle`. *)
Definition around (q : close_part) (middle n : Z) : close_part :=
  sub_part q n (Z.max 0 (Z.min (middle - 1) (2 ^ n - 2))) 1.

(** Its coefficients are those of y there, times a positive number. *)
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

(** sub_part is a part of the part, where a >= 0 and a + 2^w <= 2^n. *)
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
  { unfold r, sub_part. cbn [low unit_bits width_bits]. assert (Q : (2 ^ (unit_bits q + n - width_bits q) = 2 ^ unit_bits q * 2 ^ (n - width_bits q))%Z)
      by (rewrite <- Z.pow_add_r by lia; f_equal; lia).
    assert (N2 : (2 ^ n = 2 ^ width_bits q * 2 ^ (n - width_bits q))%Z)
      by (rewrite <- Z.pow_add_r by lia; f_equal; lia).
    assert (Pn : (0 < 2 ^ (n - width_bits q))%Z) by (apply Z.pow_pos_nonneg; lia).
    repeat split; try lia; nia. }
  exists (IZR (2 ^ n) ^ 3 * k). split; [apply Rmult_lt_0_compat; auto; apply pow_lt; now apply power_positive |].
  change (close_y r) with (sub_y (close_y q) n a w). rewrite sub_part_right, E by easy. unfold part_of at 1. rewrite substituted_scaled by now apply part_of_length.
  fold (part_of (part_of y (close_start q) (close_end q)) (over a n) (over (a + 2 ^ w) n)).
  rewrite part_of_part, map_map by easy. rewrite Es, Ee. apply map_ext. intros x. ring.
Qed.
