(** The first contact of vertex and edge, and of two vertices, in closed form (ccd/contact/vertex_edge_time.hpp), over
    the real numbers: the code's integers are exact, and so are their signs.

    Results:
        first_root_right      `first_root_nonpositive`: the first root of f in (0, 1) where b <= 0, every branch
        first_contact_right   `first_vertex_edge_contact` tells the first contact, or that there is none
        first_bracket_right   the bracket of what it tells is that of the first contact
        vertices_time_right   likewise `first_vertex_vertex_contact` *)

From Coq Require Import Reals Lra Psatz List Bool.
From Errbound Require Import Sign Bernstein Contact VertexEdge Separation FirstContact TimeBrackets.
Import ListNotations.
Open Scope R_scope.

(** Where the first time is: the root of a linear form, or a root of a quadratic one. *)
Inductive place_in_time :=
  | nowhere | start_time | end_time | linear_root (k0 k1 : R) | quadratic_root (f : quadratic) (which : which_root).

(** ** first_root_nonpositive *)

Definition opposite_sign (s : sign) : sign :=
  match s with positive => negative | negative => positive | _ => s end.
Definition first_root_nonpositive (f b : quadratic) : place_in_time :=
  let at_rational k0 k1 :=
    if nonpositive (code_value b (Rabs k1) (Rabs k0)) then linear_root k0 k1 else nowhere in
  let first := sign_of_real (c0 f) in
  let last := sign_of_real (c2 f) in
  if same_sign first zero then at_rational (c1 f) (c2 f)
  else if same_sign last zero then at_rational (c0 f) (c1 f)
  else
    let two_roots := same_sign first last in
    let discriminant := sign_of_real (c1 f * c1 f - 4 * (c0 f * c2 f)) in
    if two_roots && same_sign discriminant negative then nowhere
    else if two_roots && same_sign discriminant zero then at_rational (c1 f) (2 * c2 f)
    else
      let l0 := c2 f * c0 b - c2 b * c0 f in
      let l1 := c2 f * c1 b - c2 b * c1 f in
      let nonpositive_at of_l := certainly_nonpositive (times last of_l) in
      let first_root := quadratic_root f (if two_roots then first_root_of else only_root_of) in
      let everywhere := sign_inside (S := reals) [l0; l1] in
      if certain everywhere then (if nonpositive_at everywhere then first_root else nowhere)
      else
        let s := Rabs l1 in
        let t := Rabs l0 in
        let there := sign_of_real (code_value f s t) in
        if negb two_roots then
          if same_sign there zero then first_root
          else if nonpositive_at (sign_of_real (if same_sign there first then l1 else l0)) then first_root
          else nowhere
        else if same_sign there (opposite_sign first) then
          (if nonpositive_at (sign_of_real l0) then quadratic_root f first_root_of
           else quadratic_root f second_root_of)
        else
          let before_both := same_sign (sign_of_real (linear_value (c1 f - 2 * c0 f) (2 * c2 f - c1 f) s t))
            (opposite_sign first) in
          if same_sign there zero then
            if before_both then quadratic_root f first_root_of
            else if nonpositive_at (sign_of_real l0) then quadratic_root f first_root_of
            else quadratic_root f second_root_of
          else if nonpositive_at (sign_of_real (if before_both then l1 else l0)) then quadratic_root f first_root_of
          else nowhere.

(** In x = t/s: f = f2 (x - p)(x - q), its greater root positive. *)
Definition ratio_right (f b : quadratic) (p q : R) (place : place_in_time) : Prop :=
  match place with
  | nowhere => (0 < p -> 0 < at_ratio b p) /\ 0 < at_ratio b q
  | quadratic_root g only_root_of => g = f /\ p < 0 /\ at_ratio b q <= 0
  | quadratic_root g first_root_of => g = f /\ 0 < p /\ at_ratio b p <= 0
  | quadratic_root g second_root_of => g = f /\ 0 < p /\ 0 < at_ratio b p /\ at_ratio b q <= 0
  | _ => False
  end.

Lemma first_of_two f2 p q b : f2 <> 0 -> p < q -> p <> 0 -> 0 < q ->
  let f := Quadratic (f2 * (p * q)) (- (f2 * (p + q))) f2 in
  ratio_right f b p q (first_root_nonpositive f b).
Proof.
  intros N O P Q f. destruct b as [b0 b1 b2].
  destruct (both_roots f2 p q b0 b1 b2) as (El0 & El1 & Ef & Eb). fold f in El0, El1, Ef, Eb.
  set (b := Quadratic b0 b1 b2) in *. set (L0 := b0 - b2 * (p * q)) in *. set (L1 := b1 + b2 * (p + q)) in *.
  assert (Bp : at_ratio b p = L0 + L1 * p) by (apply Eb; auto; rewrite Ef; ring).
  assert (Bq : at_ratio b q = L0 + L1 * q) by (apply Eb; auto; rewrite Ef; ring).
  assert (D : sign_of_real (c1 f * c1 f - 4 * (c0 f * c2 f)) = positive).
  { apply sign_positive. unfold f. cbn [c0 c1 c2].
    replace (_ - _) with ((f2 * (q - p)) * (f2 * (q - p))) by ring.
    assert (f2 * (q - p) <> 0) by (apply Rmult_integral_contrapositive; lra). nra. }
  assert (There : forall c a, sign_of_real (code_value f (Rabs f2 * c) (Rabs f2 * a))
    = times (sign_of_real f2) (times (sign_of_real (a - p * c)) (sign_of_real (a - q * c)))).
  { intros c a. unfold code_value. rewrite value_of_code. rewrite <- !sign_product.
    transitivity (sign_of_real (Rabs f2 * Rabs f2 * (f2 * ((a - p * c) * (a - q * c))))).
    - f_equal. unfold value, f. cbn [c0 c1 c2]. ring.
    - rewrite sign_product, (sign_positive (Rabs f2 * Rabs f2)).
      + now destruct (sign_of_real (f2 * _)).
      + assert (0 < Rabs f2) by now apply Rabs_pos_lt. nra. }
  assert (Slope : forall c a,
    sign_of_real (linear_value (c1 f - 2 * c0 f) (2 * c2 f - c1 f) (Rabs f2 * c) (Rabs f2 * a))
    = times (sign_of_real f2) (sign_of_real ((1 + p) * (a - q * c) + (1 + q) * (a - p * c)))).
  { intros c a. rewrite <- !sign_product.
    transitivity (sign_of_real (Rabs f2 * (f2 * ((1 + p) * (a - q * c) + (1 + q) * (a - p * c))))).
    - f_equal. unfold linear_value, f. cbn. ring.
    - rewrite sign_product, (sign_positive (Rabs f2)) by now apply Rabs_pos_lt.
      now destruct (sign_of_real (f2 * _)). }
  unfold first_root_nonpositive. cbv zeta. rewrite D, El0, El1, !Rabs_mult, There, Slope.
  assert (First : sign_of_real (c0 f) = times (sign_of_real f2) (sign_of_real p)).
  { unfold f. cbn [c0]. rewrite !sign_product, (sign_positive q Q).
    now destruct (sign_of_real f2), (sign_of_real p). }
  rewrite First. change (c2 f) with f2.
  unfold sign_inside. cbn [sign_inside_from sign_of reals]. rewrite !sign_product.
  assert (Later : forall g : bool, sign_of_real (if g then f2 * L1 else f2 * L0)
     = times (sign_of_real f2) (if g then sign_of_real L1 else sign_of_real L0))
    by (intros []; apply sign_product).
  rewrite !Later. clear Later.
  assert (Up : Rabs L0 - q * Rabs L1 <= Rabs L0 - p * Rabs L1) by (pose proof (Rabs_pos L1); nra).
  set (u := Rabs L0 - p * Rabs L1) in *. set (v := Rabs L0 - q * Rabs L1) in *.
  assert (E : u = Rabs L0 - p * Rabs L1 /\ v = Rabs L0 - q * Rabs L1) by (split; reflexivity).
  assert (Earlier : 0 < p -> 0 <= u -> 0 <= v -> 0 < u -> 0 < (1 + p) * v + (1 + q) * u).
  { clear - Q. intros. assert (0 <= p * v) by (apply Rmult_le_pos; lra).
    assert (0 < q * u) by (now apply Rmult_lt_0_compat). lra. }
  assert (After : 0 < p -> u <= 0 -> v <= 0 -> v < 0 -> (1 + p) * v + (1 + q) * u < 0).
  { clear - Q. intros. assert (0 <= p * - v) by (apply Rmult_le_pos; lra).
    assert (0 <= q * - u) by (apply Rmult_le_pos; lra). lra. }
  assert (Apart : 0 < Rabs L1 -> v < u).
  { destruct E as (-> & ->). clear - O. intros. assert (0 < (q - p) * Rabs L1) by (apply Rmult_lt_0_compat; lra). lra. }
  assert (Single : p < 0 -> 0 < Rabs L0 -> 0 < u).
  { destruct E as (-> & _). clear. intros. assert (0 <= - p * Rabs L1)
      by (apply Rmult_le_pos; [lra | apply Rabs_pos]). lra. }
  assert (Falling : L0 < 0 -> 0 < L1 -> u = - (L0 + L1 * p) /\ v = - (L0 + L1 * q) /\ 0 < Rabs L0 /\ 0 < Rabs L1).
  { destruct E as (-> & ->). clear. intros. rewrite (Rabs_left L0), (Rabs_pos_eq L1) by lra. lra. }
  assert (Rising : 0 < L0 -> L1 < 0 -> u = L0 + L1 * p /\ v = L0 + L1 * q /\ 0 < Rabs L0 /\ 0 < Rabs L1).
  { destruct E as (-> & ->). clear. intros. rewrite (Rabs_left L1), (Rabs_pos_eq L0) by lra. lra. }
  assert (Same : 0 <= L0 -> 0 <= L1 -> 0 < L0 + L1 -> (0 < p -> 0 < L0 + L1 * p) /\ 0 < L0 + L1 * q).
  { assert (H : forall r, 0 < r -> 0 <= L0 -> 0 <= L1 -> 0 < L0 + L1 -> 0 < L0 + L1 * r).
    { clear. intros. assert (0 <= L1 * r) by (apply Rmult_le_pos; lra).
      destruct (Req_dec L0 0); [| lra]. assert (0 < L1 * r) by (apply Rmult_lt_0_compat; lra). lra. }
    auto. }
  assert (Below : forall r, 0 < r -> L0 <= 0 -> L1 <= 0 -> L0 + L1 * r <= 0).
  { clear. intros. assert (0 <= - L1 * r) by (apply Rmult_le_pos; lra). lra. }
  unfold ratio_right. fold f. rewrite Bp, Bq.
  assert (Itself : f = f) by reflexivity. revert Itself.
  clear There Slope First D Ef El0 El1 E Eb Bp Bq. clearbody L0 L1 u v f. intros Itself.
  cases_of_sign f2; [| easy |]; (cases_of_sign p; [| easy |]); cases_of_sign L0; cases_of_sign L1.
  all: cbn [times same_sign sign_inside_from certain certainly_nonpositive andb orb negb opposite_sign].
  all: try (apply Same; lra).
  all: try (split; [reflexivity |]; split; [lra |]; apply Below; lra).
  all: first [destruct (Falling ltac:(assumption) ltac:(assumption)) as (U & V & A & A1)
             | destruct (Rising ltac:(assumption) ltac:(assumption)) as (U & V & A & A1)].
  all: specialize (Apart A1); clear Falling Rising Same Below; set (gp := L0 + L1 * p) in *;
    set (gq := L0 + L1 * q) in *; clearbody gp gq.
  all: cases_of_sign u; cases_of_sign v; try lra;
    try (exfalso; assert (0 < u) by (apply Single; assumption); lra).
  all: try rewrite (sign_positive _ (Earlier ltac:(assumption) ltac:(lra) ltac:(lra) ltac:(lra)));
    try rewrite (sign_negative _ (After ltac:(assumption) ltac:(lra) ltac:(lra) ltac:(lra))).
  all: cbn [times same_sign certain certainly_nonpositive andb orb negb opposite_sign].
  all: repeat split; try reflexivity; lra.
Qed.

(** ** In time *)

(** The time that a place tells, with what the search for its bracket needs. *)
Definition tells (place : place_in_time) (r : R) : Prop :=
  match place with
  | nowhere => False
  | start_time => r = 0
  | end_time => r = 1
  | linear_root k0 k1 => k0 * k1 <= 0 /\ (k0 <> 0 \/ k1 <> 0) /\ linear_at k0 k1 r = 0
  | quadratic_root f only_root_of => 0 < r < 1 /\ quadratic_at f r = 0 /\
      (forall t, 0 < t < r -> 0 < quadratic_at f t * c0 f) /\ (forall t, r < t < 1 -> quadratic_at f t * c0 f < 0)
  | quadratic_root f first_root_of => exists k q, k <> 0 /\ (0 < r < q /\ q < 1) /\
      forall t, quadratic_at f t = k * ((t - r) * (t - q))
  | quadratic_root f second_root_of => exists k p, k <> 0 /\ (0 < p < r /\ r < 1) /\
      forall t, quadratic_at f t = k * ((t - p) * (t - r))
  end.
Definition first_nonpositive (f b : quadratic) (r : R) : Prop :=
  0 < r < 1 /\ quadratic_at f r = 0 /\ quadratic_at b r <= 0 /\
  forall t, 0 < t < r -> quadratic_at f t = 0 -> 0 < quadratic_at b t.
Definition root_told (f b : quadratic) (place : place_in_time) : Prop :=
  (place = nowhere /\ forall t, 0 < t < 1 -> quadratic_at f t = 0 -> 0 < quadratic_at b t) \/
  exists r, tells place r /\ first_nonpositive f b r.

Lemma rational_told f b k0 k1 : k0 * k1 < 0 ->
  (forall t, 0 < t < 1 -> (quadratic_at f t = 0 <-> linear_at k0 k1 t = 0)) ->
  root_told f b (if nonpositive (code_value b (Rabs k1) (Rabs k0)) then linear_root k0 k1 else nowhere).
Proof.
  intros O Same. assert (N0 : k0 <> 0) by nra. assert (N1 : k1 <> 0) by nra.
  pose proof (Rabs_pos_lt _ N0) as P0. pose proof (Rabs_pos_lt _ N1) as P1.
  set (r := Rabs k0 / (Rabs k0 + Rabs k1)).
  assert (E : r * (Rabs k0 + Rabs k1) = Rabs k0) by (unfold r; field; lra).
  assert (R0 : 0 < r < 1) by (split; nra).
  assert (Linear : forall t, linear_at k0 k1 t = 0 <-> t = r).
  { assert (Q : k0 * Rabs k1 = - k1 * Rabs k0).
    { destruct (Rlt_or_le k0 0); [rewrite (Rabs_left k0), (Rabs_pos_eq k1) by nra |
        rewrite (Rabs_pos_eq k0), (Rabs_left k1) by nra]; ring. }
    assert (E' : r * (k0 - k1) = k0).
    { apply Rmult_eq_reg_r with (Rabs k0 + Rabs k1); [| lra].
      transitivity (r * (Rabs k0 + Rabs k1) * (k0 - k1)); [ring |]. rewrite E. lra. }
    assert (D : k0 - k1 <> 0) by nra.
    intros t. replace (linear_at k0 k1 t) with ((k0 - k1) * (r - t)) by (unfold linear_at; lra).
    split; [| intros ->; ring]. intros Z. apply Rmult_integral in Z. destruct Z; lra. }
  assert (V : code_value b (Rabs k1) (Rabs k0) = (Rabs k0 + Rabs k1) * (Rabs k0 + Rabs k1) * quadratic_at b r).
  { unfold code_value. rewrite value_of_code. unfold quadratic_at, value.
    set (m := Rabs k0 + Rabs k1) in *.
    transitivity (c0 b * (m - r * m) ^ 2 + c1 b * (m - r * m) * (r * m) + c2 b * (r * m) ^ 2); [| ring].
    rewrite E. unfold m. ring. }
  assert (M : 0 < (Rabs k0 + Rabs k1) * (Rabs k0 + Rabs k1)) by nra.
  destruct (nonpositive (code_value b (Rabs k1) (Rabs k0))) eqn:B.
  - right. exists r. apply nonpositive_true in B. rewrite V in B. split.
    + split; [lra |]. split; auto. now apply Linear.
    + split; auto. split; [now apply Same, Linear |]. split; [nra |].
      intros t T Z. apply Same, Linear in Z; lra.
  - left. split; auto. intros t T Z. apply Same, Linear in Z; auto. subst t.
    apply Rnot_le_lt. intros Q. enough (nonpositive (code_value b (Rabs k1) (Rabs k0)) = true) by congruence.
    apply nonpositive_true. rewrite V. nra.
Qed.

Lemma place_of_ratio x : 0 < x -> 0 < x / (1 + x) < 1 /\ x / (1 + x) / (1 - x / (1 + x)) = x.
Proof.
  intros X. assert (E : x / (1 + x) * (1 + x) = x) by (field; lra).
  split; [split; nra | field; lra].
Qed.
Lemma sign_of_ratio b x : 0 < x -> (quadratic_at b (x / (1 + x)) <= 0 <-> at_ratio b x <= 0).
Proof.
  intros X. destruct (place_of_ratio x X) as (T & E). rewrite (proj2 (inside_ratio b _ T)). now rewrite E.
Qed.

Lemma two_told f2 p q b : f2 <> 0 -> p < q -> p <> 0 -> 0 < q ->
  let f := Quadratic (f2 * (p * q)) (- (f2 * (p + q))) f2 in
  root_told f b (first_root_nonpositive f b).
Proof.
  intros N O P Q f. pose proof (first_of_two f2 p q b N O P Q) as H. cbv zeta in H. fold f in H.
  destruct (place_of_ratio q Q) as (Tq & _). pose proof (sign_of_ratio b q Q) as Sq.
  set (y := q / (1 + q)) in *. assert (Ey : y * (1 + q) = q) by (unfold y; field; lra).
  assert (Fy : forall t, t - q * (1 - t) = (1 + q) * (t - y)) by (intros t; lra).
  assert (F : forall t, quadratic_at f t = f2 * ((t - p * (1 - t)) * (t - q * (1 - t))))
    by (intros t; unfold quadratic_at, value, f; cbn [c0 c1 c2]; ring).
  assert (Nq : ~ at_ratio b q <= 0 <-> 0 < quadratic_at b y) by (rewrite <- Sq; split; lra).
  destruct (Rlt_or_le 0 p) as [Pp | Pn].
  - destruct (place_of_ratio p Pp) as (Tp & _). pose proof (sign_of_ratio b p Pp) as Sp.
    set (x := p / (1 + p)) in *. assert (Ex : x * (1 + p) = p) by (unfold x; field; lra).
    assert (XY : x < y) by nra. set (k := f2 * ((1 + p) * (1 + q))).
    assert (K : k <> 0) by (unfold k; repeat (apply Rmult_integral_contrapositive; split); lra).
    assert (G : forall t, quadratic_at f t = k * ((t - x) * (t - y))).
    { intros t. rewrite F, Fy. unfold k. replace (t - p * (1 - t)) with ((1 + p) * (t - x)) by lra. ring. }
    assert (Zeros : forall t, quadratic_at f t = 0 -> t = x \/ t = y).
    { intros t. rewrite G. intros Z. apply Rmult_integral in Z. destruct Z as [|Z]; [easy |].
      apply Rmult_integral in Z. lra. }
    assert (Zx : quadratic_at f x = 0) by (rewrite G; ring). assert (Zy : quadratic_at f y = 0) by (rewrite G; ring).
    destruct (first_root_nonpositive f b) as [| | | | g [| |]]; simpl in H; try easy.
    + left. split; auto. intros t T Z. destruct H as (H & I). specialize (H Pp).
      destruct (Zeros t Z); subst t; apply Rnot_le_lt; intros C; [apply Sp in C | apply Sq in C]; lra.
    + destruct H as (_ & H & _). lra.
    + destruct H as (-> & _ & H). right. exists x. split; [exists k, y; repeat split; auto; lra |].
      split; auto. split; auto. split; [now apply Sp |]. intros t T Z. destruct (Zeros t Z); lra.
    + destruct H as (-> & _ & H & I). right. exists y. split; [exists k, x; repeat split; auto; lra |].
      split; auto. split; auto. split; [now apply Sq |]. intros t T Z. destruct (Zeros t Z); subst t; [| lra].
      apply Rnot_le_lt. intros C. apply Sp in C. lra.
  - assert (Pm : p < 0) by lra.
    assert (Pos : forall t, 0 < t < 1 -> 0 < t - p * (1 - t)) by (intros t T; nra).
    assert (Zeros : forall t, 0 < t < 1 -> quadratic_at f t = 0 -> t = y).
    { intros t T. rewrite F, Fy. specialize (Pos t T). intros Z. apply Rmult_integral in Z.
      destruct Z as [| Z]; [easy |]. apply Rmult_integral in Z. destruct Z as [|Z]; [lra |].
      apply Rmult_integral in Z. lra. }
    assert (Zy : quadratic_at f y = 0) by (rewrite F, Fy; ring).
    assert (U : 0 < - (f2 * f2 * (p * q))).
    { assert (0 < f2 * f2) by nra. assert (0 < - p * q) by nra.
      replace (- (f2 * f2 * (p * q))) with (f2 * f2 * (- p * q)) by ring. now apply Rmult_lt_0_compat. }
    assert (G : forall t, quadratic_at f t * c0 f = - (f2 * f2 * (p * q)) * ((t - p * (1 - t)) * (1 + q)) * (y - t)).
    { intros t. rewrite F, Fy. unfold f. cbn [c0]. ring. }
    assert (W : forall t, 0 < t < 1 -> 0 < - (f2 * f2 * (p * q)) * ((t - p * (1 - t)) * (1 + q))).
    { intros t T. apply Rmult_lt_0_compat; auto. apply Rmult_lt_0_compat; [now apply Pos | lra]. }
    destruct (first_root_nonpositive f b) as [| | | | g [| |]]; simpl in H; try easy.
    + left. split; auto. intros t T Z. rewrite (Zeros t T Z). apply Rnot_le_lt. intros C. apply Sq in C. lra.
    + destruct H as (-> & _ & H). right. exists y. split.
      * split; auto. split; auto. split; intros t T; rewrite G.
        -- apply Rmult_lt_0_compat; [apply W; lra | lra].
        -- assert (0 < - (f2 * f2 * (p * q)) * ((t - p * (1 - t)) * (1 + q)) * (t - y)); [| lra].
           apply Rmult_lt_0_compat; [apply W; lra | lra].
      * split; auto. split; auto. split; [now apply Sq |]. intros t T Z. assert (t = y) by (apply Zeros; auto; lra). lra.
    + destruct H as (_ & H & _). lra.
    + destruct H as (_ & H & _). lra.
Qed.

Theorem first_root_right f b : sign_inside (coefficients f) = uncertain ->
  root_told f b (first_root_nonpositive f b).
Proof.
  intros U. apply both_signs in U. destruct f as [f0 f1 f2]. cbn [c0 c1 c2] in U.
  destruct (Req_dec f0 0) as [-> | N0].
  { unfold first_root_nonpositive. cbv zeta. cbn [c0 c1 c2]. rewrite (sign_zero 0) by easy. cbn [same_sign].
    apply rational_told; [nra |]. intros t T. unfold quadratic_at, value, linear_at. cbn [c0 c1 c2]. split; intros Z.
    - apply Rmult_eq_reg_l with t; lra.
    - transitivity (t * (f1 * (1 - t) + f2 * t)); [ring | rewrite Z; ring]. }
  destruct (Req_dec f2 0) as [-> | N2].
  { unfold first_root_nonpositive. cbv zeta. cbn [c0 c1 c2]. rewrite (sign_zero 0) by easy.
    replace (same_sign (sign_of_real f0) zero) with false by (cases_of_sign f0; easy). cbn [same_sign].
    apply rational_told; [nra |]. intros t T. unfold quadratic_at, value, linear_at. cbn [c0 c1 c2]. split; intros Z.
    - apply Rmult_eq_reg_l with (1 - t); lra.
    - transitivity ((1 - t) * (f0 * (1 - t) + f1 * t)); [ring | rewrite Z; ring]. }
  set (d := f1 * f1 - 4 * (f0 * f2)).
  destruct (Rlt_or_le 0 d) as [D | D].
  { destruct (factors f0 f1 f2 N2 D) as (p & q & O & -> & ->).
    assert (P : p * q <> 0) by (intros Z; rewrite Z in N0; lra).
    assert (p <> 0) by (intros Z; rewrite Z in P; lra).
    apply two_told; auto. clear d D N0. apply Rnot_le_lt. intros Q.
    assert (p < 0) by lra. assert (0 <= p * q) by nra. assert (p + q < 0) by lra. nra. }
  assert (S : 0 < f0 * f2) by (unfold d in D; assert (0 <= f1 * f1) by nra; nra).
  assert (same_sign (sign_of_real f0) (sign_of_real f2) = true /\ same_sign (sign_of_real f0) zero = false
    /\ same_sign (sign_of_real f2) zero = false) as (T1 & T2 & T3).
  { cases_of_sign f0; cases_of_sign f2; try nra; repeat split. }
  unfold first_root_nonpositive. cbv zeta. cbn [c0 c1 c2]. rewrite T1, T2, T3. fold d. cbn [andb].
  assert (Sq : forall t, 4 * f2 * quadratic_at (Quadratic f0 f1 f2) t =
    linear_at f1 (2 * f2) t * linear_at f1 (2 * f2) t - d * ((1 - t) * (1 - t)))
    by (intros t; unfold quadratic_at, value, linear_at, d; cbn [c0 c1 c2]; ring).
  destruct D as [D | D].
  - rewrite (sign_negative d D). cbn [same_sign]. left. split; auto. intros t T Z. exfalso.
    specialize (Sq t). rewrite Z, Rmult_0_r in Sq. pose proof (Rle_0_sqr (linear_at f1 (2 * f2) t)) as P.
    unfold Rsqr in P. assert (0 < - d * ((1 - t) * (1 - t))) by (apply Rmult_lt_0_compat; nra). lra.
  - rewrite (sign_zero d D). cbn [same_sign].
    assert (Op : f1 * (2 * f2) < 0) by (assert (f1 <> 0) by (intros ->; unfold d in D; lra); nra).
    apply rational_told; auto.
    intros t T. specialize (Sq t). rewrite D in Sq. split; intros Z.
    + rewrite Z in Sq. apply Rsqr_0_uniq. unfold Rsqr. lra.
    + rewrite Z in Sq. apply Rmult_eq_reg_l with (4 * f2); lra.
Qed.

(** ** Vertex and edge *)

Definition first_of_quadratics (f0 f1 f2 b : quadratic) : place_in_time :=
  if certainly_rootless (coefficients f0) then nowhere
  else if certainly_rootless (coefficients f1) then nowhere
  else if certainly_rootless (coefficients f2) then nowhere
  else if same_sign (sign_throughout (coefficients b)) positive then nowhere
  else if touches f0 f1 f2 b c0 then start_time
  else
    let at_end := if touches f0 f1 f2 b c2 then end_time else nowhere in
    let or_at_end inside := match inside with nowhere => at_end | _ => inside end in
    if same_sign (sign_inside (coefficients b)) positive then at_end
    else match common_roots [f0; f1; f2] with
      | none => at_end
      | one m => or_at_end (if nonpositive (value_at_squares b m) then linear_root (- c1 m) (c0 m) else nowhere)
      | of_quadratic f => or_at_end (first_root_nonpositive f b)
      | everywhere =>
          if nonpositive (c2 b) || (below_0 (c1 b) && nonpositive (4 * (c0 b * c2 b) - c1 b * c1 b))
          then first_root_nonpositive b b
          else at_end
      end.
Definition first_vertex_edge_contact (v e0 e1 : moving) : place_in_time :=
  first_of_quadratics (cross_x v e0 e1) (cross_y v e0 e1) (cross_z v e0 e1) (VertexEdge.between v e0 e1).

Definition time_told (H : R -> Prop) (place : place_in_time) : Prop :=
  (place = nowhere /\ forall t, 0 <= t <= 1 -> ~ H t) \/ exists r, tells place r /\ first H r.
(** Likewise in (0, 1). *)
Definition inside_told (H : R -> Prop) (place : place_in_time) : Prop :=
  (place = nowhere /\ forall t, 0 < t < 1 -> ~ H t) \/
  exists r, tells place r /\ 0 < r < 1 /\ H r /\ forall t, 0 < t < r -> ~ H t.

Lemma or_at_end_told H place (at_1 : bool) : ~ H 0 -> (at_1 = true <-> H 1) -> inside_told H place ->
  time_told H (match place with nowhere => if at_1 then end_time else nowhere | _ => place end).
Proof.
  intros N0 A1 [(-> & No) | (r & Told & R0 & Hr & Before)].
  - destruct at_1.
    + right. exists 1. split; [easy |]. split; [lra |]. split; [now apply A1 |]. intros s S Hs.
      destruct (Req_dec s 0) as [-> |]; [easy |]. apply (No s); auto. lra.
    + left. split; auto. intros t T Ht. destruct (Req_dec t 0) as [-> |]; [easy |].
      destruct (Req_dec t 1) as [-> |]; [apply A1 in Ht; discriminate |]. apply (No t); auto. lra.
  - right. exists r. assert (F : first H r).
    { split; [lra |]. split; auto. intros s S Hs. destruct (Req_dec s 0) as [-> |]; [easy |]. apply (Before s); auto.
      lra. }
    destruct place; try easy; now split.
Qed.

Lemma quadratic_continuous b : continuity (quadratic_at b).
Proof. unfold quadratic_at, value. reg. Qed.
(** Positive at 0 and without roots up to t. *)
Lemma no_root_positive b t : 0 < c0 b -> 0 < t -> (forall s, 0 < s <= t -> quadratic_at b s <> 0) ->
  0 < quadratic_at b t.
Proof.
  intros B T No. apply Rnot_le_lt. intros L.
  destruct (IVT_cor (quadratic_at b) 0 t (quadratic_continuous b)) as (s & S & Z); [lra | |].
  - rewrite (proj1 (at_ends b)). nra.
  - destruct (Req_dec s 0) as [-> |]; [rewrite (proj1 (at_ends b)) in Z; lra |]. apply (No s); auto. lra.
Qed.

Lemma everywhere_told b : 0 < c0 b -> same_sign (sign_inside (coefficients b)) positive = false ->
  nonpositive (c2 b) || (below_0 (c1 b) && nonpositive (4 * (c0 b * c2 b) - c1 b * c1 b)) = true ->
  time_told (fun t => quadratic_at b t <= 0) (first_root_nonpositive b b).
Proof.
  intros B0 S C. assert (U : sign_inside (coefficients b) = uncertain).
  { assert (E : c1 b < 0 \/ c2 b <= 0).
    { apply orb_prop in C. destruct C as [C | C]; [right; now apply nonpositive_true |]. apply andb_prop in C.
      destruct C as (C & _). unfold below_0 in C. destruct (Rlt_dec (c1 b) 0); [now left | discriminate]. }
    revert S. unfold sign_inside, coefficients. cbn [sign_inside_from sign_of reals].
    rewrite (sign_positive (c0 b) B0). cases_of_sign (c1 b); cases_of_sign (c2 b); cbn; try easy; lra. }
  destruct (first_root_right b b U) as [(E & No) | (r & Told & R0 & Zr & _ & Before)].
  - left. split; auto.
    assert (Free : forall t, 0 < t < 1 -> quadratic_at b t <> 0) by (intros t T Z; specialize (No t T Z); lra).
    intros t T L. destruct (Req_dec t 0) as [-> | N0]; [rewrite (proj1 (at_ends b)) in L; lra |].
    destruct (Req_dec t 1) as [-> | N1].
    2: { enough (0 < quadratic_at b t) by lra. apply no_root_positive; auto; [lra |]. intros s Hs. apply Free. lra. }
    rewrite (proj2 (at_ends b)) in L. destruct (both_signs b U) as (_ & Neg). destruct L as [L | L].
    + destruct (IVT_cor (quadratic_at b) 0 1 (quadratic_continuous b)) as (s & Hs & Z); [lra | |].
      { rewrite (proj1 (at_ends b)), (proj2 (at_ends b)). nra. }
      destruct (Req_dec s 0) as [-> |]; [rewrite (proj1 (at_ends b)) in Z; lra |].
      destruct (Req_dec s 1) as [-> |]; [rewrite (proj2 (at_ends b)) in Z; lra |]. apply (Free s); auto. lra.
    + assert (N : c1 b < 0) by lra. set (s := c0 b / (c0 b - c1 b)).
      assert (Es : s * (c0 b - c1 b) = c0 b) by (unfold s; field; lra). apply (Free s); [split; nra |].
      unfold quadratic_at, value. rewrite L.
      transitivity ((1 - s) * (c0 b - s * (c0 b - c1 b))); [ring |]. rewrite Es. ring.
  - right. exists r. split; auto. split; [lra |]. split; [lra |]. intros s Hs L.
    destruct (Req_dec s 0) as [-> | N0]; [rewrite (proj1 (at_ends b)) in L; lra |].
    enough (0 < quadratic_at b s) by lra. apply no_root_positive; auto; [lra |]. intros t T Z.
    assert (0 < quadratic_at b t) by (apply Before; auto; lra). lra.
Qed.

Theorem first_contact_right f0 f1 f2 b : time_told (meets f0 f1 f2 b) (first_of_quadratics f0 f1 f2 b).
Proof.
  unfold first_of_quadratics.
  assert (Rootless : forall f, certainly_rootless (coefficients f) = true -> In f [f0; f1; f2] ->
    time_told (meets f0 f1 f2 b) nowhere).
  { intros f C I. left. split; auto. intros t T (V & _).
    destruct (rootless_hull _ t C T). rewrite at_time_quadratic. now apply (proj1 (Forall_forall _ _) V). }
  destruct (certainly_rootless (coefficients f0)) eqn:R0; [apply (Rootless f0); simpl; auto |].
  destruct (certainly_rootless (coefficients f1)) eqn:R1; [apply (Rootless f1); simpl; auto |].
  destruct (certainly_rootless (coefficients f2)) eqn:R2; [apply (Rootless f2); simpl; auto |].
  clear Rootless R0 R1 R2.
  destruct (same_sign (sign_throughout (coefficients b)) positive) eqn:H.
  { left. split; auto. intros t T (_ & B). pose proof (sign_throughout_right (coefficients b) t T) as S.
    destruct (sign_throughout (coefficients b)); try discriminate.
    rewrite at_time_quadratic in S. simpl in S. lra. }
  clear H. destruct (touches_true f0 f1 f2 b) as (T0 & T1).
  destruct (touches f0 f1 f2 b c0) eqn:S0.
  { right. exists 0. split; [easy |]. split; [lra |]. split; [now apply T0 | intros s S; lra]. }
  assert (N0 : ~ meets f0 f1 f2 b 0) by (intros M; apply T0 in M; discriminate).
  set (at_1 := touches f0 f1 f2 b c2) in *. clearbody at_1. clear S0. cbv zeta.
  assert (AtEnd : (forall t, 0 < t < 1 -> ~ meets f0 f1 f2 b t) ->
    time_told (meets f0 f1 f2 b) (if at_1 then end_time else nowhere)).
  { intros No. apply (or_at_end_told _ nowhere at_1 N0 T1). now left. }
  destruct (same_sign (sign_inside (coefficients b)) positive) eqn:H.
  { apply AtEnd. intros t T (_ & B). pose proof (sign_inside_right (coefficients b) t T) as S.
    destruct (sign_inside (coefficients b)); try discriminate.
    rewrite at_time_quadratic in S. simpl in S. lra. }
  pose proof (common_roots_right [f0; f1; f2]) as K.
  destruct (common_roots [f0; f1; f2]) as [| m | f |]; simpl in K.
  - apply AtEnd. intros t T (V & _). now apply (K t T) in V.
  - apply or_at_end_told; auto. destruct K as (k & t & P & T & Sq & Only).
    pose proof (value_squares b m k t Sq) as Vb. destruct Sq as (Q0 & Q1 & Q2).
    destruct (nonpositive (value_at_squares b m)) eqn:E.
    + apply nonpositive_true in E. rewrite Vb in E. right. exists t. split; [| split; auto; split].
      * assert (0 < c0 m) by (rewrite Q0; apply Rmult_lt_0_compat; [| apply pow_lt]; lra).
        assert (0 < c1 m) by (rewrite Q1; apply Rmult_lt_0_compat; [| apply Rmult_lt_0_compat]; lra).
        split; [nra |]. split; [right; lra |]. unfold linear_at. rewrite Q0, Q1. ring.
      * split; [now apply Only | nra].
      * intros s S (V & _). apply Only in V; lra.
    + left. split; auto. intros s S (V & B). apply Only in V; auto. subst s.
      enough (nonpositive (value_at_squares b m) = true) by congruence. apply nonpositive_true. rewrite Vb. nra.
  - apply or_at_end_told; auto. destruct K as (U & Same).
    destruct (first_root_right f b U) as [(E & No) | (r & Told & R0 & Z & B & Before)].
    + left. split; auto. intros t T (V & B). apply Same in V; auto. specialize (No t T V). lra.
    + right. exists r. split; auto. split; auto. split; [split; auto; now apply Same |].
      intros t T (V & B'). apply Same in V; [| lra]. specialize (Before t T V). lra.
  - assert (B0 : 0 < c0 b).
    { rewrite <- (proj1 (at_ends b)). apply Rnot_le_lt. intros B. apply N0. now split. }
    assert (M : forall t, meets f0 f1 f2 b t <-> quadratic_at b t <= 0)
      by (intros t; split; [now intros (_ & B) | now split]).
    destruct (nonpositive (c2 b) || _) eqn:C.
    + destruct (everywhere_told b B0 H C) as [(E & No) | (r & Told & T & B & Before)].
      * left. split; auto. intros t T. rewrite M. auto.
      * right. exists r. split; auto. split; auto. split; [now apply M |]. intros s S. rewrite M. auto.
    + apply AtEnd. intros t T. rewrite M, (proj2 (inside_ratio b t T)). intros L.
      apply orb_false_elim in C. destruct C as (C2 & C1).
      assert (B2 : 0 < c2 b).
      { apply Rnot_le_lt. intros Q. apply nonpositive_true in Q. congruence. }
      destruct (proj2 (dips b B0 B2)) as (D1 & D2).
      { exists (t / (1 - t)). split; auto. apply Rdiv_lt_0_compat; lra. }
      apply andb_false_elim in C1. destruct C1 as [C1 | C1].
      * unfold below_0 in C1. destruct (Rlt_dec (c1 b) 0); [discriminate | easy].
      * apply nonpositive_true in D2. congruence.
Qed.

(** ** Brackets *)

Section Brackets.

Variable double : R -> Prop.
Hypothesis double_0 : double 0.
Hypothesis double_1 : double 1.

Definition place_bracket (place : place_in_time) (b : bracket) : Prop :=
  match place with
  | nowhere => False
  | start_time => b = (0, 0)
  | end_time => b = (1, 1)
  | linear_root k0 k1 => linear_bracket double k0 k1 b
  | quadratic_root f which => quadratic_bracket double f which b
  end.
Lemma told_bracket place r b : tells place r -> place_bracket place b -> holds_time double b r.
Proof.
  destruct place as [| | | k0 k1 | f [| |]]; simpl.
  - easy.
  - intros -> ->. left. auto.
  - intros -> ->. left. auto.
  - intros (S & N & Z) B. destruct (linear_bracket_right double double_0 double_1 k0 k1 b S N B) as (t & _ & H & Only).
    apply Only in Z. now subst.
  - intros (R0 & Z & Before & After) B. exact (quadratic_only_right double f r b R0 Before Z After B).
  - intros (k & q & N & O & E) B. exact (quadratic_first_right double double_0 double_1 f k r q N O E b B).
  - intros (k & p & N & O & E) B. exact (quadratic_second_right double double_0 double_1 f k p r N O E b B).
Qed.

Theorem first_bracket_right v e0 e1 : let place := first_vertex_edge_contact v e0 e1 in
  (place = nowhere /\ ~ vertex_edge_collides v e0 e1) \/
  place <> nowhere /\
    exists t, first (vertex_on_edge v e0 e1) t /\ forall b, place_bracket place b -> holds_time double b t.
Proof.
  intros place. unfold place, first_vertex_edge_contact.
  destruct (first_contact_right (cross_x v e0 e1) (cross_y v e0 e1) (cross_z v e0 e1) (VertexEdge.between v e0 e1))
    as [(E & No) | (r & Told & T & H & Before)].
  - left. split; auto. intros (t & T & H). apply (No t T). now apply meets_contact.
  - right. split; [intros E; now rewrite E in Told |]. exists r.
    split; [| intros b B; now apply told_bracket with (2 := B)]. split; auto.
    split; [now apply meets_contact |]. intros s S Hs. apply (Before s S). now apply meets_contact.
Qed.

(** ** Two vertices *)

(** vertices_touch, then the first component of W that is not zero at t = 0. *)
Definition vertices_touch (v w : moving) : Prop :=
  cross (minus (start v) (start w)) (minus (finish v) (finish w)) = origin /\
  dot (minus (start v) (start w)) (minus (finish v) (finish w)) <= 0.
Definition moving_component (v w : moving) : place_in_time :=
  let p := minus (start v) (start w) in let q := minus (finish v) (finish w) in
  if negb (is_0 (x p)) then linear_root (x p) (x q)
  else if negb (is_0 (y p)) then linear_root (y p) (y q)
  else if negb (is_0 (z p)) then linear_root (z p) (z q)
  else start_time.

Lemma component_first (c : point -> R) v w t : (forall a b s, place a s = place b s ->
    linear_at (c (minus (start a) (start b))) (c (minus (finish a) (finish b))) s = 0) ->
  c (minus (start v) (start w)) <> 0 -> 0 <= t <= 1 -> place v t = place w t ->
  tells (linear_root (c (minus (start v) (start w))) (c (minus (finish v) (finish w)))) t /\
  first (fun s => place v s = place w s) t.
Proof.
  intros L N T E. pose proof (L v w t E) as Z. 
  set (k0 := c (minus (start v) (start w))) in *. set (k1 := c (minus (finish v) (finish w))) in *.
  unfold linear_at in Z.
  assert (T0 : t <> 0) by (intros ->; lra).
  assert (Ek : k1 * t = - (k0 * (1 - t))) by lra.
  assert (S : k0 * k1 <= 0).
  { assert (Sq : 0 <= k0 * k0 * (1 - t)) by (apply Rmult_le_pos; [apply Rle_0_sqr | lra]).
    assert (P : k0 * k1 * t = - (k0 * k0 * (1 - t))) by (rewrite Rmult_assoc, Ek; ring).
    apply Rnot_lt_le. intros Q. assert (0 < k0 * k1 * t) by (apply Rmult_lt_0_compat; lra). lra. }
  split; [repeat split; auto |]. split; auto. split; auto. intros s Hs Es. apply (L v w s) in Es. fold k0 k1 in Es.
  unfold linear_at in Es. assert (D : k0 - k1 <> 0) by nra.
  assert ((k0 - k1) * (t - s) = 0) as P by lra. apply Rmult_integral in P. destruct P; lra.
Qed.
Theorem vertices_time_right v w : (~ vertices_touch v w -> ~ vertex_vertex_collides v w) /\
  (vertices_touch v w -> exists t, first (fun s => place v s = place w s) t /\
    forall b, place_bracket (moving_component v w) b -> holds_time double b t).
Proof.
  split; intros H.
  { intros C. apply vertex_vertex_contact in C. easy. }
  apply vertex_vertex_contact in H. destruct H as (t & T & E).
  enough (exists t, tells (moving_component v w) t /\ first (fun s => place v s = place w s) t) as (r & Told & F).
  { exists r. split; auto. intros b B. now apply told_bracket with (2 := B). }
  unfold moving_component. cbv zeta.
  destruct (is_0 (x (minus (start v) (start w)))) eqn:X; cbn [negb].
  2: { exists t. apply (component_first x); auto.
       - intros a b s Q. apply point_eq in Q. unfold place, linear_at, minus in *. cbn [x y z] in *. lra.
       - intros Z. apply is_0_true in Z. congruence. }
  destruct (is_0 (y (minus (start v) (start w)))) eqn:Y; cbn [negb].
  2: { exists t. apply (component_first y); auto.
       - intros a b s Q. apply point_eq in Q. unfold place, linear_at, minus in *. cbn [x y z] in *. lra.
       - intros Z. apply is_0_true in Z. congruence. }
  destruct (is_0 (z (minus (start v) (start w)))) eqn:W; cbn [negb].
  2: { exists t. apply (component_first z); auto.
       - intros a b s Q. apply point_eq in Q. unfold place, linear_at, minus in *. cbn [x y z] in *. lra.
       - intros Z. apply is_0_true in Z. congruence. }
  exists 0. split; [easy |]. split; [lra |]. split; [| intros s S; lra].
  apply is_0_true in X, Y, W. unfold place, minus in *. cbn [x y z] in *. apply same_point; cbn [x y z]; lra.
Qed.

End Brackets.
