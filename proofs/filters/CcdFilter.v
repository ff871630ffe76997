(** The bounds of the collision filter (ccd/exact/static_filter/difference_extents.hpp), in double, rounded in any
    direction. The compiler computes constants to nearest.

    Y, a cubic, and the inside forms G_i, quartics, are stored as control values times 3 and 12. Differences on an
    axis are at most m_x, m_y or m_z, each at most 2^200. Results:
        error_of_y_sound             the control values of Y are within error_of_y() of the exact ones
        error_of_vertex_face_sound   the control values of the G_i are within error_of_g() of the exact ones
        error_of_edge_edge_sound     the same for edges, with a margin for halvings *)

From Coq Require Import Reals ZArith List Lia Lra Psatz.
From Flocq Require Import Core.
From Errbound Require Import Format ErrorCount.
Import ListNotations.
Open Scope R_scope.

Notation p := 53%Z (only parsing).
Notation emin := (-1074)%Z (only parsing).
#[global] Instance double_precision : Prec_gt_0 p := eq_refl.

(** Polynomials of errbound::bernstein over expressions: products are convolutions, and the first term of each sum
    is stored. *)
Definition form := list counted.
Definition at_ (f : form) (i : nat) : counted := nth i f (Constant 0).
Definition convolved (f g : form) (k : nat) : counted :=
  let first := (k - (length g - 1))%nat in
  let last := Nat.min (length f - 1) k in
  let term i := Product (at_ f i) (at_ g (k - i)) in
  fold_left (fun sum i => Sum sum (term i)) (seq (S first) (last - first)) (term first).
Definition times (f g : form) : form := map (convolved f g) (seq 0 (length f + length g - 1)).
Definition zip (op : counted -> counted -> counted) (f g : form) : form :=
  map (fun i => op (at_ f i) (at_ g i)) (seq 0 (length f)).
Definition plus := zip Sum.
Definition minus := zip Minus.

Record vector := { x_ : form; y_ : form; z_ : form }.
Definition cross (a b : vector) : vector :=
  {| x_ := minus (times (y_ a) (z_ b)) (times (z_ a) (y_ b));
     y_ := minus (times (z_ a) (x_ b)) (times (x_ a) (z_ b));
     z_ := minus (times (x_ a) (y_ b)) (times (y_ a) (x_ b)) |}.
Definition dot (a b : vector) : form :=
  plus (plus (times (x_ a) (x_ b)) (times (y_ a) (y_ b))) (times (z_ a) (z_ b)).

(** Forms of a query from its vectors b, c and p (include/ccd/methods/forms.hpp). *)
Record query := { b_ : vector; c_ : vector; p_ : vector }.
Definition normal (q : query) := cross (b_ q) (c_ q).
Definition coplanarity (q : query) : form := dot (normal q) (p_ q).
Definition vertex_face_inside (q : query) : list form :=
  let n := normal q in
  let w2 := dot (cross (b_ q) (p_ q)) n in
  let w1 := dot (cross (p_ q) (c_ q)) n in
  [w2; w1; minus (minus (dot n n) w1) w2].
Definition edge_edge_inside (q : query) : list form :=
  let n := normal q in
  let on_a := dot (cross (p_ q) (c_ q)) n in
  let on_b := dot (cross (p_ q) (b_ q)) n in
  [on_a; minus (dot n n) on_a; on_b; minus (dot n n) on_b].
(** Control values times 3 or 12: multiple(N) / C(N, i). *)
Definition controlled (factors : list Z) (f : form) : form :=
  map (fun i => match nth i factors 1%Z with
                | 1%Z => at_ f i
                | factor => Product (at_ f i) (Constant factor)
                end) (seq 0 (length factors)).
Definition cubic := controlled [3; 1; 1; 3]%Z.
Definition quartic := controlled [12; 3; 2; 3; 12]%Z.

(** The number type over which the code evaluates the forms to count. *)
Definition any_difference : vector :=
  let d := [Difference 0 0 0; Difference 0 0 0] in {| x_ := d; y_ := d; z_ := d |}.
Definition any_query : query :=
  {| b_ := any_difference; c_ := any_difference; p_ := any_difference |}.

(** The shape of an expression, without its values. *)
Fixpoint shape (e : counted) : counted :=
  match e with
  | Exact _ _ => Exact 0 0
  | Difference _ _ _ => Difference 0 0 0
  | Constant c => Constant c
  | Sum x y => Sum (shape x) (shape y)
  | Minus x y => Minus (shape x) (shape y)
  | Product x y => Product (shape x) (shape y)
  | Negation x => Negation (shape x)
  | Converted _ _ _ => Converted 0 0 0
  end.
Notation count := (count p emin).
Lemma count_shape e : count (shape e) = count e.
Proof. induction e; simpl; congruence. Qed.

Section CcdFilter.

Context (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation fl := (rnd p emin direction).
Notation flc := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation u := (u p).
Notation eta := (eta emin).
Notation value := (value p emin direction).

Definition largest_difference : R := bpow radix2 200.
Notation W := largest_difference.
Notation admissible := (admissible p emin direction W).

(** The code: constants_of. *)
Definition slack : R := flc (101 / 100).
Definition tiny : R := bpow radix2 (- 1000).
Fixpoint scaled_up (n : nat) (x : R) : R :=
  match n with O => x | S n => scaled_up n (flc (x * W)) end.
Definition relative (error : R) : R := flc (flc (slack * error) * eps).
Definition absolute (underflow : R) (degree : nat) : R :=
  flc (slack * flc (flc (scaled_up (degree - 1) underflow * eta) + tiny)).
Definition worst (count_of : error_count -> R) (l : list counted) : R :=
  fold_right (fun e m => Rmax (count_of (count e)) m) 0 l.
Definition any_cubic : form := cubic (coplanarity any_query).
Definition y_relative : R := relative (worst error any_cubic).
Definition y_absolute : R := absolute (worst underflow any_cubic) 3.
Definition g_relative (inside : query -> list form) : R :=
  relative (worst error (concat (map quartic (inside any_query)))).
Definition g_absolute (inside : query -> list form) : R :=
  absolute (worst underflow (concat (map quartic (inside any_query)))) 4.

(** difference_extents::error_of_y and error_of_g. *)
Definition error_of_y (mx my mz : R) : R :=
  fl (fl (fl (fl (mx * my) * mz) * y_relative) + y_absolute).
Definition error_of_g (inside : query -> list form) (mx my mz : R) : R :=
  let area := Rmax (Rmax (fl (mx * my)) (fl (my * mz))) (fl (mz * mx)) in
  fl (fl (fl (area * area) * g_relative inside) + g_absolute inside).

Lemma p_10 : (10 <= p)%Z. Proof. lia. Qed.
Lemma emin_p : (emin <= 1 - 2 * p)%Z. Proof. lia. Qed.
Lemma W_1 : 1 <= W.
Proof. change 1 with (bpow radix2 0). apply bpow_le. lia. Qed.

(** A common bound of a form's coefficients. *)
Definition fits (U : R) (k h : nat) (e : counted) : Prop :=
  admissible e /\ unit e <= U /\ degree e = k /\ (height e <= h)%nat.
Definition all_fit (U : R) (k h : nat) (f : form) : Prop := Forall (fits U k h) f.

Lemma unit_nonnegative e : admissible e -> 0 <= unit e.
Proof. intros A. apply (unit_power p emin direction W W_1 e A). Qed.
Lemma fits_sum (op : counted -> counted -> counted) U k h x y :
  op = Sum \/ op = Minus ->
  fits U k h x -> fits U k h y -> fits U k (4 + h) (op x y).
Proof.
  intros O (A1 & A2 & A3 & A4) (B1 & B2 & B3 & B4).
  assert (M : Rmax (unit x) (unit y) <= U) by (apply Rmax_lub; auto).
  unfold fits. destruct O as [-> | ->]; simpl; repeat split; auto; lia.
Qed.
Lemma fits_product U k h x V l i y : (1 <= k + l)%nat ->
  fits U k h x -> fits V l i y -> fits (U * V) (k + l) (4 + (h + i)) (Product x y).
Proof.
  intros L (A1 & A2 & A3 & A4) (B1 & B2 & B3 & B4).
  unfold fits. simpl. repeat split; auto; try lia.
  apply Rmult_le_compat; auto using unit_nonnegative.
Qed.
Lemma fits_more U V k h i e : U <= V -> (h <= i)%nat -> fits U k h e -> fits V k i e.
Proof. intros L M (A1 & A2 & A3 & A4). unfold fits. repeat split; auto; try lia. lra. Qed.
Lemma fits_at U k h f i : all_fit U k h f -> (i < length f)%nat -> fits U k h (at_ f i).
Proof. intros F L. apply (proj1 (Forall_forall _ _) F). now apply nth_In. Qed.

Lemma zip_fits op U k h f g : op = Sum \/ op = Minus -> length f = length g ->
  all_fit U k h f -> all_fit U k h g -> all_fit U k (4 + h) (zip op f g).
Proof.
  intros O L F G. apply Forall_forall. intros e I. apply in_map_iff in I.
  destruct I as (i & <- & I). apply in_seq in I. apply fits_sum; auto; apply fits_at; auto; lia.
Qed.
Lemma times_fits U k h f V l i g n : (1 <= k + l)%nat -> f <> [] -> g <> [] ->
  (length f <= S n)%nat ->
  all_fit U k h f -> all_fit V l i g ->
  all_fit (U * V) (k + l) (4 * (1 + n) + (h + i)) (times f g).
Proof.
  intros K NF NG N F G. apply Forall_forall. intros e I. apply in_map_iff in I.
  destruct I as (j & <- & I). apply in_seq in I.
  assert (LF : (1 <= length f)%nat) by (destruct f; [easy | simpl; lia]).
  assert (LG : (1 <= length g)%nat) by (destruct g; [easy | simpl; lia]).
  unfold convolved. set (first := (j - (length g - 1))%nat).
  set (last := Nat.min (length f - 1) j).
  assert (T : forall a, (first <= a <= last)%nat ->
    fits (U * V) (k + l) (4 + (h + i)) (Product (at_ f a) (at_ g (j - a)))).
  { intros a B. apply fits_product; auto; apply fits_at; auto; lia. }
  assert (S : forall m a s h', (forall b, (a <= b < a + m)%nat -> (first <= b <= last)%nat) ->
    (4 + (h + i) <= h')%nat -> fits (U * V) (k + l) h' s ->
    fits (U * V) (k + l) (4 * m + h')
      (fold_left (fun sum i => Sum sum (Product (at_ f i) (at_ g (j - i)))) (seq a m) s)).
  { induction m as [| m IH]; intros a s h' B L H; [exact H |].
    cbn [seq fold_left]. replace (4 * S m + h')%nat with (4 * m + (4 + h'))%nat by lia.
    apply IH; try lia.
    - intros b Hb. apply B. lia.
    - apply fits_sum; auto. apply fits_more with (3 := T a (B a ltac:(lia))); try lia. lra. }
  assert (first <= last)%nat by lia.
  apply fits_more with (U * V) (4 * (last - first) + (4 + (h + i)))%nat; try lra; try lia.
  apply S; try lia. apply T. lia.
Qed.

Lemma times_length f g : length (times f g) = (length f + length g - 1)%nat.
Proof. unfold times. now rewrite map_length, seq_length. Qed.
Lemma zip_length op f g : length (zip op f g) = length f.
Proof. unfold zip. now rewrite map_length, seq_length. Qed.

(** Components of vectors: m coefficients each, x, y and z of sizes X, Y and Z. *)
Definition vector_fits (m : nat) (X Y Z : R) (k h : nat) (v : vector) : Prop :=
  (length (x_ v) = m /\ length (y_ v) = m /\ length (z_ v) = m) /\
  all_fit X k h (x_ v) /\ all_fit Y k h (y_ v) /\ all_fit Z k h (z_ v).

Lemma nonempty (f : form) n : length f = S n -> f <> [].
Proof. destruct f; easy. Qed.

Section Query.

Context (mx my mz : R) (q : query).
(** Components are differences at both ends of the step. *)
Definition differences_fit (m : R) (f : form) : Prop :=
  length f = 2%nat /\ forall e, In e f ->
    exists a b, e = Difference a b m /\ number a /\ number b /\ Rabs (fl (a - b)) <= m <= W.
Definition moving (v : vector) : Prop :=
  differences_fit mx (x_ v) /\ differences_fit my (y_ v) /\ differences_fit mz (z_ v).
Context (b_moving : moving (b_ q)) (c_moving : moving (c_ q)) (p_moving : moving (p_ q)).

Lemma differences_all_fit m f : differences_fit m f -> all_fit m 1 0 f.
Proof.
  intros [_ H]. apply Forall_forall. intros e I. destruct (H e I) as (a & b & -> & A & B & L).
  unfold fits. simpl. repeat split; auto; lra.
Qed.
Lemma differences_size m f : differences_fit m f -> 0 <= m <= W.
Proof.
  intros [L H]. destruct f as [| e f]; [easy |]. destruct (H e) as (a & b & _ & _ & _ & B).
  - now left.
  - generalize (Rabs_pos (fl (a - b))). lra.
Qed.
Lemma moving_fits v : moving v -> vector_fits 2 mx my mz 1 0 v.
Proof.
  intros (X & Y & Z). unfold vector_fits. repeat split; auto using differences_all_fit; apply X || apply Y || apply Z.
Qed.
Lemma sizes_nonnegative : 0 <= mx <= W /\ 0 <= my <= W /\ 0 <= mz <= W.
Proof.
  destruct b_moving as (X & Y & Z). repeat split; (eapply differences_size; [eassumption]) || idtac;
  generalize (differences_size _ _ X) (differences_size _ _ Y) (differences_size _ _ Z); lra.
Qed.

Lemma cross_fits v w : vector_fits 2 mx my mz 1 0 v -> vector_fits 2 mx my mz 1 0 w ->
  vector_fits 3 (my * mz) (mz * mx) (mx * my) 2 12 (cross v w).
Proof.
  intros ((X1 & Y1 & Z1) & X & Y & Z) ((X2 & Y2 & Z2) & X' & Y' & Z').
  unfold cross, vector_fits, minus. cbn [x_ y_ z_]. rewrite !zip_length, !times_length.
  split; [lia |].
  assert (P : forall U V f g f' g', all_fit U 1 0 f -> all_fit V 1 0 g -> all_fit V 1 0 f' ->
    all_fit U 1 0 g' -> length f = 2%nat -> length g = 2%nat -> length f' = 2%nat ->
    length g' = 2%nat -> all_fit (U * V) 2 12 (zip Minus (times f g) (times f' g'))).
  { intros U V f g f' g' F G F' G' LF LG LF' LG'. apply (zip_fits Minus _ 2 8); auto.
    - rewrite !times_length. lia.
    - apply (times_fits U 1 0 f V 1 0 g 1); eauto using nonempty; lia.
    - rewrite Rmult_comm. apply (times_fits V 1 0 f' U 1 0 g' 1); eauto using nonempty; lia. }
  repeat split; apply P; auto.
Qed.

(** A scalar product with three terms of one size. *)
Lemma dot_fits m n U h h' v w X Y Z X' Y' Z' k l : (1 <= k + l)%nat -> (m <= 2)%nat ->
  vector_fits (S m) X Y Z k h v -> vector_fits (S n) X' Y' Z' l h' w ->
  X * X' <= U -> Y * Y' <= U -> Z * Z' <= U ->
  all_fit U (k + l) (20 + (h + h')) (dot v w) /\ length (dot v w) = (m + n + 1)%nat.
Proof.
  intros K M ((X1 & Y1 & Z1) & FX & FY & FZ) ((X2 & Y2 & Z2) & FX' & FY' & FZ') HX HY HZ.
  unfold dot, plus. rewrite !zip_length, !times_length. split; [| lia].
  assert (P : forall f g A B, length f = S m -> length g = S n -> all_fit A k h f ->
    all_fit B l h' g -> A * B <= U -> all_fit U (k + l) (12 + (h + h')) (times f g)).
  { intros f g A B LF LG F G L.
    generalize (times_fits A k h f B l h' g 2 K (nonempty _ _ LF) (nonempty _ _ LG) ltac:(lia) F G).
    apply Forall_impl. intros e. apply fits_more; auto; lia. }
  apply (zip_fits Sum _ _ (4 + (12 + (h + h')))); auto.
  - rewrite !zip_length, !times_length. lia.
  - apply (zip_fits Sum); auto; [rewrite !times_length; lia | |]; eapply P; eauto.
  - eapply Forall_impl; [| eapply P; eauto]. intros e. apply fits_more; [lra | lia].
Qed.
Lemma controlled_fits U k h factors f : (1 <= k)%nat -> length factors = length f ->
  Forall (fun c => 1 <= c <= 12)%Z factors -> 0 <= U ->
  all_fit U k h f -> all_fit U k (8 + h) (controlled factors f).
Proof.
  intros K L B P F. apply Forall_forall. intros e I. apply in_map_iff in I.
  destruct I as (i & <- & I). apply in_seq in I.
  assert (A : fits U k h (at_ f i)) by (apply fits_at; auto; lia).
  assert (C : (1 <= nth i factors 1 <= 12)%Z).
  { apply (proj1 (Forall_forall _ _) B). apply nth_In. lia. }
  assert (Q : fits U k (8 + h) (Product (at_ f i) (Constant (nth i factors 1%Z)))).
  { apply fits_more with (U * 1) (4 + (h + 4))%nat; try lra; try lia.
    replace k with (k + 0)%nat by lia. apply fits_product; [lia | exact A |].
    unfold fits. cbn [ErrorCount.admissible unit degree height]. repeat split; try lra; try lia.
    - rewrite <- (Rmult_1_r (IZR _)). change 1 with (bpow radix2 0).
      apply number_integer; [exact eq_refl | lia |].
      change (2 ^ p)%Z with 9007199254740992%Z. lia.
    - apply Nat2Z.inj_le. rewrite Z2Nat.id by apply Z.log2_up_nonneg. rewrite Z.abs_eq by lia.
      apply Z.le_trans with (Z.log2_up 12); [apply Z.log2_up_le_mono; lia | now vm_compute]. }
  assert (D : fits U k (8 + h) (at_ f i)) by (apply fits_more with (3 := A); try lra; lia).
  destruct (nth i factors 1%Z) as [| [| |] |]; auto.
Qed.

(** The code's worst count is a maximum over counts that include each control value's. *)
Lemma worst_covers count_of l e : In e l -> count_of (count e) <= worst count_of l.
Proof.
  induction l as [| a l IH]; simpl; [easy |]. intros [-> | I].
  - apply Rmax_l.
  - apply Rle_trans with (1 := IH I). apply Rmax_r.
Qed.
Lemma worst_shape count_of l : worst count_of (map shape l) = worst count_of l.
Proof. induction l as [| a l IH]; simpl; auto. now rewrite count_shape, IH. Qed.
Lemma worst_among count_of l (P : R -> Prop) :
  P 0 -> (forall e, In e l -> P (count_of (count e))) -> P (worst count_of l).
Proof.
  intros Z H. induction l as [| a l IH]; simpl; auto.
  unfold Rmax. destruct (Rle_dec _ _); [apply IH | apply H]; intros; try apply H; simpl; auto.
Qed.

Lemma eps_tiny : 0 < eps <= / 1000000.
Proof.
  split; [apply bpow_gt_0 |]. apply Rle_trans with (bpow radix2 (- 20)); [apply bpow_le; lia |].
  simpl. lra.
Qed.
Lemma any_error : rounding_error p emin direction eps eta.
Proof. exact (rounding_error_any p emin direction ltac:(lia)). Qed.
Lemma nearest_error : rounding_error p emin nearest u (eta / 2).
Proof. exact (rounding_error_nearest p emin ltac:(lia)). Qed.
Lemma flc_lower x : x = 0 \/ bpow radix2 (- 1022) <= x -> x * (1 - eps) <= flc x.
Proof.
  intros [-> | H].
  - rewrite rnd_0; auto with typeclass_instances. lra.
  - apply Rle_trans with (x * (1 - u)).
    + apply Rmult_le_compat_l; [generalize (bpow_ge_0 radix2 (- 1022)); lra |].
      generalize (eps_2u p) (u_positive p). lra.
    + apply (rnd_relative p emin nearest u (eta / 2) nearest_error). exact H.
Qed.
Lemma flc_upper x y : number y -> x <= y -> flc x <= y.
Proof. intros. apply rnd_below; auto with typeclass_instances. Qed.
Lemma flc_above x y : number x -> x <= y -> x <= flc y.
Proof. intros. apply rnd_above; auto with typeclass_instances. Qed.
Lemma number_bpow e : (-1074 <= e)%Z -> number (bpow radix2 e).
Proof. intros. apply number_power; auto. exact eq_refl. Qed.
Lemma bpow_small e : (e <= -22)%Z -> bpow radix2 e <= / 1000000.
Proof.
  intros H. apply Rle_trans with (bpow radix2 (- 22)); [now apply bpow_le |]. simpl. lra.
Qed.

Lemma slack_enough : 1.0099 <= slack <= 2.
Proof.
  unfold slack. generalize eps_tiny; intros. split.
  - apply Rle_trans with (101 / 100 * (1 - eps)); [lra |]. apply flc_lower. right.
    apply Rle_trans with 1; [change 1 with (bpow radix2 0); apply bpow_le; lia | lra].
  - apply flc_upper; [change 2 with (bpow radix2 1); apply number_bpow; lia | lra].
Qed.
Lemma relative_enough E n : E = 0 \/ 1 <= E -> E <= bpow radix2 n -> (-500 <= n <= 500)%Z ->
  1.009 * (E * eps) <= relative E <= bpow radix2 (n - 51).
Proof.
  intros Z H N. generalize eps_tiny slack_enough; intros P S. unfold relative.
  assert (B : flc (slack * E) <= bpow radix2 (n + 1)).
  { apply flc_upper; [apply number_bpow; lia |]. rewrite bpow_plus. simpl (bpow radix2 1). nra. }
  assert (Pos : bpow radix2 (- 1022) <= eps) by (apply bpow_le; lia).
  split.
  - destruct Z as [-> | Z].
    + replace (1.009 * (0 * eps)) with 0 by ring.
      apply rnd_nonnegative; auto with typeclass_instances. apply Rmult_le_pos; [| lra].
      apply rnd_nonnegative; auto with typeclass_instances. lra.
    + assert (L : slack * E * (1 - eps) <= flc (slack * E)) by (apply flc_lower; right; nra).
      assert (1 <= flc (slack * E)).
      { apply flc_above; [change 1 with (bpow radix2 0); apply number_bpow; lia | nra]. }
      apply Rle_trans with (flc (slack * E) * eps * (1 - eps)).
      * apply Rle_trans with (slack * E * (1 - eps) * eps * (1 - eps)).
        -- replace (slack * E * (1 - eps) * eps * (1 - eps))
             with (slack * ((1 - eps) * (1 - eps)) * (E * eps)) by ring.
           apply Rmult_le_compat_r; [nra |]. nra.
        -- apply Rmult_le_compat_r; [lra |]. apply Rmult_le_compat_r; lra.
      * apply flc_lower. right. nra.
  - apply flc_upper; [apply number_bpow; lia |].
    replace (n - 51)%Z with (n + 1 + (1 - 53))%Z by lia. rewrite (bpow_plus radix2 (n + 1)).
    apply Rmult_le_compat_r; [apply bpow_ge_0 | exact B].
Qed.
Lemma scaled_up_lower n x : 1 <= x -> x * W ^ n * (1 - eps) ^ n <= scaled_up n x /\ 1 <= scaled_up n x.
Proof.
  generalize eps_tiny W_1; intros P H. revert x. induction n as [| n IH]; intros x X; simpl.
  - lra.
  - assert (L : x * W * (1 - eps) <= flc (x * W)).
    { apply flc_lower. right. apply Rle_trans with 1; [| nra].
      change 1 with (bpow radix2 0). apply bpow_le. lia. }
    assert (O : 1 <= flc (x * W)).
    { apply flc_above; [change 1 with (bpow radix2 0); apply number_bpow; lia | nra]. }
    destruct (IH _ O) as [I1 I2]. split; auto.
    apply Rle_trans with (2 := I1).
    replace (x * (W * W ^ n) * ((1 - eps) * (1 - eps) ^ n))
      with (x * W * (1 - eps) * (W ^ n * (1 - eps) ^ n)) by ring.
    rewrite (Rmult_assoc (flc _)). apply Rmult_le_compat_r; auto.
    apply Rmult_le_pos; apply pow_le; lra.
Qed.
Lemma tiny_normal : bpow radix2 (- 1022) <= tiny.
Proof. apply bpow_le. lia. Qed.
Lemma absolute_enough Un k : (k <= 5)%nat -> 1 <= Un ->
  1.009 * (Un * (eta * W ^ (k - 1)) + tiny) <= absolute Un k + eta.
Proof.
  intros K H. unfold absolute. generalize eps_tiny slack_enough W_1 tiny_normal; intros P S HW T.
  generalize (bpow_gt_0 radix2 (- 1022)); intros T0.
  destruct (scaled_up_lower (k - 1) Un H) as [L1 L2]. set (x := scaled_up (k - 1) Un) in *.
  assert (Q : 0.99999 <= (1 - eps) ^ (k - 1)).
  { assert (B : forall n, 1 - INR n * eps <= (1 - eps) ^ n).
    { induction n as [| n IH]; [simpl; lra |]. rewrite <- tech_pow_Rmult, S_INR.
      generalize (pos_INR n). intros.
      assert (0 <= INR n * eps) by (apply Rmult_le_pos; lra).
      assert (0 <= INR n * eps * eps) by (apply Rmult_le_pos; lra).
      apply Rle_trans with ((1 - eps) * (1 - INR n * eps)); [lra |].
      apply Rmult_le_compat_l; lra. }
    apply Rle_trans with (2 := B (k - 1)%nat).
    assert (INR (k - 1) <= 4) by (change 4 with (IZR 4); rewrite INR_IZR_INZ; apply IZR_le; lia).
    nra. }
  assert (X : 0.99999 * (Un * W ^ (k - 1)) <= x).
  { apply Rle_trans with (2 := L1). rewrite (Rmult_comm _ ((1 - eps) ^ _)).
    apply Rmult_le_compat_r; auto. apply Rmult_le_pos; [lra | apply pow_le; lra]. }
  generalize (eta_positive emin); intros E.
  (* to nearest, below the normal numbers, by at most half of eta *)
  assert (Y : x * eta * (1 - eps) - eta / 2 <= flc (x * eta)).
  { apply Rle_trans with (x * eta * (1 - u) - eta / 2).
    - generalize (eps_2u p) (u_positive p). intros. assert (0 <= x * eta) by nra. nra.
    - apply (rnd_lower p emin nearest u (eta / 2) nearest_error). nra. }
  assert (Z0 : 0 <= flc (x * eta)).
  { apply rnd_nonnegative; auto with typeclass_instances. nra. }
  assert (Z : (flc (x * eta) + tiny) * (1 - eps) <= flc (flc (x * eta) + tiny)).
  { apply flc_lower. right. lra. }
  assert (V : tiny <= flc (flc (x * eta) + tiny)).
  { apply flc_above; [apply number_bpow; lia | lra]. }
  set (y := flc (flc (x * eta) + tiny)) in *.
  assert (F : slack * y * (1 - eps) <= flc (slack * y)).
  { apply flc_lower. right. nra. }
  assert (F' : 1.00989 * y <= slack * y * (1 - eps)).
  { replace (slack * y * (1 - eps)) with (slack * (1 - eps) * y) by ring.
    apply Rmult_le_compat_r; nra. }
  apply Rle_trans with (1.00989 * y + eta); [| lra].
  set (g := Un * W ^ (k - 1)) in *.
  assert (G : 0.99999 * (eta * g) <= x * eta) by nra.
  replace (Un * (eta * W ^ (k - 1))) with (eta * g) by (unfold g; ring).
  assert (0 <= x * eta) by nra.
  assert (YY : 0.999989 * (eta * g) - eta / 2 <= flc (x * eta)) by nra.
  assert (0.99999 * (0.999989 * (eta * g) - eta / 2 + tiny) <= y) by nra.
  nra.
Qed.

(** The bound as evaluated: V is the unit, V' its computed value plus eta K. The last summand is left for the
    halvings. *)
Lemma bound_enough E Un n k V V' K :
  E = 0 \/ 1 <= E -> E <= bpow radix2 n -> (0 <= n <= 61)%Z -> (k <= 5)%nat -> 1 <= Un ->
  number V' -> 0 <= V -> 0 <= V' -> 0 <= K -> V * (1 - 4 * eps) <= V' + eta * K ->
  K <= W ^ (k - 1) * bpow radix2 (- 20) ->
  E * (eps * V) + Un * (eta * W ^ (k - 1)) + tiny / 1000 <=
    fl (fl (V' * relative E) + absolute Un k) * (1 - eps).
Proof.
  intros ZE HE Hn Hk HU NV PV PV' PK HV HK.
  destruct (relative_enough E n ZE HE ltac:(lia)) as [R1 R2].
  generalize (absolute_enough Un k Hk HU). intros A1.
  generalize eps_tiny W_1 tiny_normal (bpow_gt_0 radix2 (- 1022)) (eta_positive emin).
  intros P HW T T0 PE.
  assert (R0 : 0 <= relative E) by (assert (0 <= E * eps) by nra; lra).
  assert (NA : number (absolute Un k)) by (apply rnd_number; auto with typeclass_instances).
  set (rel := relative E) in *. set (ab := absolute Un k) in *.
  set (h := W ^ (k - 1)) in *.
  assert (Ph : 1 <= h) by (apply pow_R1_Rle; auto).
  (* eta is negligible compared with tiny *)
  assert (Small : eta <= tiny / 1000000).
  { apply Rle_trans with (tiny * bpow radix2 (- 22)).
    - unfold tiny, Format.eta. rewrite <- bpow_plus. apply bpow_le. lia.
    - generalize (bpow_small (- 22) ltac:(lia)). intros. unfold Rdiv.
      apply Rmult_le_compat_l; lra. }
  set (th := eta * h) in *. assert (Pth : eta <= th) by (unfold th; nra).
  assert (Pab : 0 <= ab).
  { assert (0 <= Un * th) by nra. nra. }
  (* the share of K *)
  assert (KS : eta * K * rel <= th / 1000).
  { apply Rle_trans with (eta * (h * bpow radix2 (- 20)) * bpow radix2 10).
    - assert (R3 : rel <= bpow radix2 10) by (apply Rle_trans with (1 := R2); apply bpow_le; lia).
      apply Rmult_le_compat; auto.
      + apply Rmult_le_pos; lra.
      + apply Rmult_le_compat_l; lra.
    - replace (eta * (h * bpow radix2 (- 20)) * bpow radix2 10)
        with (th * (bpow radix2 (- 20) * bpow radix2 10)) by (unfold th; ring).
      rewrite <- bpow_plus. unfold Rdiv. apply Rmult_le_compat_l; [lra |]. simpl. lra. }
  (* the product *)
  assert (PA : 0 <= V' * rel) by (apply Rmult_le_pos; auto).
  generalize (rnd_lower p emin direction eps eta any_error (V' * rel) PA). intros L1.
  assert (N1 : number (fl (V' * rel))) by (apply rnd_number; auto with typeclass_instances).
  assert (P1 : 0 <= fl (V' * rel)) by (apply rnd_nonnegative; auto with typeclass_instances).
  generalize (sum_relative p emin direction eps eta any_error _ _ N1 NA P1 Pab). intros L2.
  set (a := fl (V' * rel)) in *. set (b := fl (a + ab)) in *.
  assert (A2 : V * rel * (1 - 4 * eps) - th / 1000 <= V' * rel).
  { apply Rle_trans with ((V' + eta * K) * rel - eta * K * rel); [| lra].
    assert (V * (1 - 4 * eps) * rel <= (V' + eta * K) * rel) by (apply Rmult_le_compat_r; auto).
    lra. }
  assert (A3 : 1.009 * (E * (eps * V)) <= V * rel).
  { replace (1.009 * (E * (eps * V))) with (V * (1.009 * (E * eps))) by ring.
    apply Rmult_le_compat_l; auto. }
  set (x := E * (eps * V)) in *.
  assert (Px : 0 <= x) by (unfold x; assert (0 <= eps * V) by (apply Rmult_le_pos; lra); apply Rmult_le_pos; lra).
  assert (A4 : 1.008 * x <= V * rel * (1 - 4 * eps)) by nra.
  assert (A5 : 1.0079 * x - th / 999 - eta <= a) by nra.
  set (y := Un * th) in *. assert (Py : th <= y) by (unfold y; nra).
  assert (A7 : 1.0078 * x + 1.007 * (y + tiny) <= a + ab) by lra.
  assert (A8 : (a + ab) * 0.99999 <= b * (1 - eps)).
  { apply Rle_trans with ((a + ab) * (1 - eps) * (1 - eps)).
    - rewrite Rmult_assoc. apply Rmult_le_compat_l; nra.
    - apply Rmult_le_compat_r; lra. }
  lra.
Qed.

Lemma W_power n : W ^ n = bpow radix2 (200 * Z.of_nat n).
Proof.
  induction n as [| n IH]; [reflexivity |]. simpl pow. rewrite IH. unfold W. rewrite <- bpow_plus.
  f_equal. lia.
Qed.
Lemma underflow_of_product x y : admissible (Product x y) -> 1 <= underflow (count (Product x y)).
Proof.
  intros (A & B & _).
  generalize (product_proper p emin p_10 emin_p _ _ (count_proper p emin direction W p_10 emin_p x A)
                (count_proper p emin direction W p_10 emin_p y B)).
  intros ((_ & _ & _ & _ & _ & [Z | Z]) & _ & _ & H); [| exact Z].
  exfalso. rewrite Z in H.
  destruct (count_proper p emin direction W p_10 emin_p x A) as (_ & _ & _ & M1 & E1 & U1).
  destruct (count_proper p emin direction W p_10 emin_p y B) as (_ & _ & _ & M2 & E2 & U2).
  generalize eps_tiny. intros.
  assert (Q : forall c d, 0 <= c -> 0 <= d -> 0 <= c * d) by (intros; now apply Rmult_le_pos).
  generalize (Q (magnitude (count x)) (underflow (count y)))
    (Q (underflow (count x)) (magnitude (count y)))
    (Q (error (count x)) (underflow (count y))) (Q (underflow (count x)) (error (count y))).
  intros.
  assert (0 <= (error (count x) * underflow (count y) + underflow (count x) * error (count y)) *
               (2 * eps)) by (apply Q; lra).
  assert (S0 : 0 <= magnitude (count x) * underflow (count y) + underflow (count x) * magnitude (count y) +
    (error (count x) * underflow (count y) + underflow (count x) * error (count y)) * (2 * eps)) by lra.
  set (s := magnitude (count x) * underflow (count y) + _ + _) in *.
  assert (0 <= eps * s) by (apply Q; lra). lra.
Qed.

(** The worst count of all expressions of one kind of form gives a bound for each. *)
Lemma all_within (all : list counted) (shapes : list counted) V V' k h K :
  map shape all = shapes -> (2 <= k <= 5)%nat -> (h <= 61)%nat ->
  all_fit V k h all -> (exists x y, In (Product x y) all) ->
  number V' -> 0 <= V -> 0 <= V' -> 0 <= K -> V * (1 - 4 * eps) <= V' + eta * K ->
  K <= W ^ (k - 1) * bpow radix2 (- 20) ->
  forall e, In e all ->
  Rabs (value e - exact e) + tiny / 1000 <=
    fl (fl (V' * relative (worst error shapes)) + absolute (worst underflow shapes) k) * (1 - eps).
Proof.
  intros <- Hk Hh F (x & y & I) NV PV PV' PK HV HK e J. rewrite !worst_shape.
  assert (A : forall e, In e all -> fits V k h e) by (apply Forall_forall; exact F).
  assert (Pr : forall e, In e all -> proper p emin (count e)).
  { intros e' I'. destruct (A e' I') as [A' _]. now apply (count_proper p emin direction W p_10 emin_p). }
  assert (Hi : forall e, In e all -> error (count e) <= bpow radix2 (Z.of_nat h)).
  { intros e' I'. destruct (A e' I') as (A' & _ & _ & H').
    generalize (count_height p emin direction W p_10 emin_p e' A'). intros (_ & L & _).
    apply Rle_trans with (1 := L). apply bpow_le. lia. }
  apply Rle_trans with (2 := bound_enough (worst error all) (worst underflow all) (Z.of_nat h) k V V' K
    ltac:(apply (worst_among error all (fun r => r = 0 \/ 1 <= r)); [now left |];
          intros e' I'; apply (Pr e' I'))
    ltac:(apply (worst_among error all (fun r => r <= bpow radix2 (Z.of_nat h)));
          [apply bpow_ge_0 | exact Hi])
    ltac:(lia) ltac:(lia)
    ltac:(apply Rle_trans with (2 := worst_covers underflow all _ I);
          apply underflow_of_product, (A _ I))
    NV PV PV' PK HV HK).
  apply Rplus_le_compat_r. destruct (A e J) as (Ae & Ue & De & He).
  generalize (count_sound p emin direction W W_1 p_10 emin_p e Ae ltac:(lia)). rewrite De.
  replace (Nat.pred k) with (k - 1)%nat by lia. intros [_ S]. apply Rle_trans with (1 := S).
  generalize (worst_covers error all e J) (worst_covers underflow all e J) (unit_nonnegative e Ae)
    eps_tiny (eta_positive emin) W_1. intros.
  destruct (Pr e J) as (_ & _ & _ & _ & E1 & U1).
  assert (0 <= eta * W ^ (k - 1)) by (apply Rmult_le_pos; [lra | apply pow_le; lra]).
  apply Rplus_le_compat.
  - apply Rmult_le_compat; try lra; [apply Rmult_le_pos; lra |]. apply Rmult_le_compat_l; lra.
  - apply Rmult_le_compat_r; auto.
Qed.

(** Sizes in the code's order of products. *)
Lemma product_lower a b : 0 <= a * b -> a * b * (1 - eps) - eta <= fl (a * b).
Proof. intros H. exact (rnd_lower p emin direction eps eta any_error (a * b) H). Qed.


Lemma two_differences m f : differences_fit m f ->
  exists a b c d, f = [Difference a b m; Difference c d m].
Proof.
  intros [L H]. destruct f as [| e [| g [|]]]; try discriminate.
  destruct (H e) as (a & b & -> & _); [simpl; auto |].
  destruct (H g) as (c & d & -> & _); [simpl; auto |]. now exists a, b, c, d.
Qed.
(** The forms have the shape that was counted. *)
Lemma query_shape (f : query -> list counted) :
  (forall b1 b2 b3 b4 b5 b6 b7 b8 b9 b10 b11 b12 c1 c2 c3 c4 c5 c6 c7 c8 c9 c10 c11 c12
          p1 p2 p3 p4 p5 p6 p7 p8 p9 p10 p11 p12,
   let v (a1 a2 a3 a4 a5 a6 a7 a8 a9 a10 a11 a12 : R) :=
     {| x_ := [Difference a1 a2 mx; Difference a3 a4 mx];
        y_ := [Difference a5 a6 my; Difference a7 a8 my];
        z_ := [Difference a9 a10 mz; Difference a11 a12 mz] |} in
   map shape (f {| b_ := v b1 b2 b3 b4 b5 b6 b7 b8 b9 b10 b11 b12;
                   c_ := v c1 c2 c3 c4 c5 c6 c7 c8 c9 c10 c11 c12;
                   p_ := v p1 p2 p3 p4 p5 p6 p7 p8 p9 p10 p11 p12 |}) = f any_query) ->
  map shape (f q) = f any_query.
Proof.
  intros H.
  destruct b_moving as (B1 & B2 & B3), c_moving as (C1 & C2 & C3), p_moving as (P1 & P2 & P3).
  destruct (two_differences _ _ B1) as (? & ? & ? & ? & E1), (two_differences _ _ B2) as (? & ? & ? & ? & E2),
    (two_differences _ _ B3) as (? & ? & ? & ? & E3), (two_differences _ _ C1) as (? & ? & ? & ? & E4),
    (two_differences _ _ C2) as (? & ? & ? & ? & E5), (two_differences _ _ C3) as (? & ? & ? & ? & E6),
    (two_differences _ _ P1) as (? & ? & ? & ? & E7), (two_differences _ _ P2) as (? & ? & ? & ? & E8),
    (two_differences _ _ P3) as (? & ? & ? & ? & E9).
  destruct q as [[bx by_ bz] [cx cy cz] [px py pz]]. simpl in E1, E2, E3, E4, E5, E6, E7, E8, E9.
  subst. apply H.
Qed.

Lemma normal_fits : vector_fits 3 (my * mz) (mz * mx) (mx * my) 2 12 (normal q).
Proof. apply cross_fits; now apply moving_fits. Qed.

Lemma cubic_fits : all_fit (mx * my * mz) 3 40 (cubic (coplanarity q)).
Proof.
  destruct sizes_nonnegative as (SX & SY & SZ).
  assert (0 <= mx * my) by (apply Rmult_le_pos; lra).
  destruct (dot_fits 2 1 (mx * my * mz) 12 0 (normal q) (p_ q) _ _ _ _ _ _ 2 1
              ltac:(lia) ltac:(lia) normal_fits (moving_fits _ p_moving)
              ltac:(right; ring) ltac:(right; ring) ltac:(right; ring)) as [F L].
  apply (controlled_fits _ 3 32); auto; try lia; [repeat constructor; lia | apply Rmult_le_pos; lra].
Qed.

Theorem error_of_y_sound e : In e (cubic (coplanarity q)) ->
  Rabs (value e - exact e) + tiny / 1000 <= error_of_y mx my mz * (1 - eps).
Proof.
  destruct sizes_nonnegative as (SX & SY & SZ). generalize eps_tiny W_1 (eta_positive emin).
  intros P HW PE. assert (Pxy : 0 <= mx * my) by (apply Rmult_le_pos; lra).
  assert (PV : 0 <= mx * my * mz) by (apply Rmult_le_pos; lra).
  assert (N1 : 0 <= fl (mx * my)) by (apply rnd_nonnegative; auto with typeclass_instances).
  assert (N2 : 0 <= fl (mx * my) * mz) by (apply Rmult_le_pos; lra).
  apply (all_within (cubic (coplanarity q)) any_cubic (mx * my * mz) (fl (fl (mx * my) * mz))
           3 40 (W + 1)).
  - apply (query_shape (fun q => cubic (coplanarity q))). reflexivity.
  - lia.
  - lia.
  - exact cubic_fits.
  - unfold cubic, controlled. simpl. eauto.
  - apply rnd_number; auto with typeclass_instances.
  - exact PV.
  - apply rnd_nonnegative; auto with typeclass_instances.
  - lra.
  - generalize (product_lower mx my Pxy) (product_lower _ mz N2). intros L1 L2.
    assert (L3 : (mx * my * (1 - eps) - eta) * mz <= fl (mx * my) * mz)
      by (apply Rmult_le_compat_r; lra).
    assert (L4 : eta * mz <= eta * W) by (apply Rmult_le_compat_l; lra).
    assert (0 <= eta * mz) by (apply Rmult_le_pos; lra).
    assert (L5 : (mx * my * mz * (1 - eps) - eta * mz) * (1 - eps) <= fl (mx * my) * mz * (1 - eps))
      by (apply Rmult_le_compat_r; lra).
    set (v := mx * my * mz) in *. nra.
  - change (3 - 1)%nat with 2%nat. rewrite W_power. unfold W.
    apply Rle_trans with (bpow radix2 200 + bpow radix2 200).
    + apply Rplus_le_compat_l. exact HW.
    + replace (bpow radix2 200 + bpow radix2 200) with (bpow radix2 1 * bpow radix2 200) 
        by (change (bpow radix2 1) with 2; ring).
      rewrite <- !bpow_plus. apply bpow_le. simpl. lia.
Qed.

Definition area : R := Rmax (Rmax (mx * my) (my * mz)) (mz * mx).
Lemma area_bounds :
  0 <= mx * my <= area /\ 0 <= my * mz <= area /\ 0 <= mz * mx <= area.
Proof.
  destruct sizes_nonnegative as (SX & SY & SZ). unfold area.
  generalize (Rmax_l (Rmax (mx * my) (my * mz)) (mz * mx)) (Rmax_r (Rmax (mx * my) (my * mz)) (mz * mx))
    (Rmax_l (mx * my) (my * mz)) (Rmax_r (mx * my) (my * mz)).
  assert (Q : forall c d, 0 <= c -> 0 <= d -> 0 <= c * d) by (intros; now apply Rmult_le_pos).
  generalize (Q mx my) (Q my mz) (Q mz mx). lra.
Qed.
Lemma square_le a b : 0 <= a <= b -> a * a <= b * b.
Proof. intros. apply Rmult_le_compat; lra. Qed.
Definition inside_fit (inside : list form) : Prop :=
  Forall (fun f => all_fit (area * area) 4 52 f /\ length f = 5%nat) inside.
Lemma inside_term v w : moving v -> moving w ->
  all_fit (area * area) 4 44 (dot (cross v w) (normal q)) /\
  length (dot (cross v w) (normal q)) = 5%nat.
Proof.
  intros Hv Hw. generalize area_bounds. intros (A1 & A2 & A3).
  apply (dot_fits 2 2 (area * area) 12 12 (cross v w) (normal q)
           (my * mz) (mz * mx) (mx * my) (my * mz) (mz * mx) (mx * my) 2 2); try lia;
    auto using square_le, normal_fits.
  apply cross_fits; now apply moving_fits.
Qed.
Lemma normal_squared_fits :
  all_fit (area * area) 4 44 (dot (normal q) (normal q)) /\
  length (dot (normal q) (normal q)) = 5%nat.
Proof. now apply inside_term. Qed.
Lemma all_fit_more U k h i f : (h <= i)%nat -> all_fit U k h f -> all_fit U k i f.
Proof. intros L. apply Forall_impl. intros e. apply fits_more; auto. lra. Qed.
Lemma vertex_face_inside_fit : inside_fit (vertex_face_inside q).
Proof.
  destruct normal_squared_fits as [N LN].
  destruct (inside_term _ _ b_moving p_moving) as [B LB].
  destruct (inside_term _ _ p_moving c_moving) as [C LC].
  assert (M : all_fit (area * area) 4 48 (minus (dot (normal q) (normal q))
                (dot (cross (p_ q) (c_ q)) (normal q)))).
  { apply (zip_fits Minus _ 4 44); auto. now rewrite LN, LC. }
  unfold inside_fit, vertex_face_inside.
  assert (Up : forall f, all_fit (area * area) 4 44 f -> all_fit (area * area) 4 52 f).
  { intros f. apply all_fit_more. lia. }
  apply Forall_cons; [auto |]. apply Forall_cons; [auto |]. apply Forall_cons; [| apply Forall_nil].
  split.
  - apply (zip_fits Minus _ 4 48); auto.
    + unfold minus. now rewrite zip_length, LN, LB.
    + apply all_fit_more with 44%nat; [lia | exact B].
  - unfold minus. now rewrite !zip_length, LN.
Qed.
Lemma edge_edge_inside_fit : inside_fit (edge_edge_inside q).
Proof.
  destruct normal_squared_fits as [N LN].
  destruct (inside_term _ _ p_moving c_moving) as [A LA].
  destruct (inside_term _ _ p_moving b_moving) as [B LB].
  assert (M : forall f, all_fit (area * area) 4 44 f -> length f = 5%nat ->
    all_fit (area * area) 4 48 (minus (dot (normal q) (normal q)) f)).
  { intros f F L. apply (zip_fits Minus _ 4 44); auto. now rewrite LN, L. }
  unfold inside_fit, edge_edge_inside.
  assert (Up : forall h f, (h <= 52)%nat -> all_fit (area * area) 4 h f ->
                 all_fit (area * area) 4 52 f).
  { intros h f. apply all_fit_more. }
  assert (L : forall f, length (minus (dot (normal q) (normal q)) f) = 5%nat).
  { intros f. unfold minus. now rewrite zip_length, LN. }
  repeat apply Forall_cons; [| | | | apply Forall_nil]; split; auto;
    (apply Up with 48%nat; [lia | now apply M]) || (apply Up with 44%nat; [lia | assumption]).
Qed.

Lemma quartic_fits inside f : inside_fit inside -> In f inside -> all_fit (area * area) 4 60 (quartic f).
Proof.
  intros F I. destruct (proj1 (Forall_forall _ _) F f I) as [F1 F2].
  apply (controlled_fits _ 4 52 [12; 3; 2; 3; 12]%Z f ltac:(lia) (eq_sym F2)); auto.
  - repeat constructor; lia.
  - apply Rle_0_sqr.
Qed.

Lemma error_of_g_sound (inside : query -> list form) :
  map shape (concat (map quartic (inside q))) = concat (map quartic (inside any_query)) ->
  inside_fit (inside q) -> inside q <> [] ->
  forall f e, In f (inside q) -> In e (quartic f) ->
  Rabs (value e - exact e) + tiny / 1000 <= error_of_g inside mx my mz * (1 - eps).
Proof.
  intros Shape F NE f e If Ie.
  destruct sizes_nonnegative as (SX & SY & SZ). generalize eps_tiny W_1 (eta_positive emin).
  intros P HW PE. generalize area_bounds. intros (A1 & A2 & A3).
  set (computed := Rmax (Rmax (fl (mx * my)) (fl (my * mz))) (fl (mz * mx))).
  assert (E1 : eta <= 1) by (change 1 with (bpow radix2 0); apply bpow_le; lia).
  assert (NW : number (W * W)).
  { unfold W. rewrite <- bpow_plus. apply number_bpow. lia. }
  assert (B : forall a b, 0 <= a <= W -> 0 <= b <= W -> 0 <= fl (a * b) <= W * W).
  { intros a b Ha Hb. split.
    - apply rnd_nonnegative; auto with typeclass_instances. apply Rmult_le_pos; lra.
    - apply rnd_below; auto with typeclass_instances. apply Rmult_le_compat; lra. }
  generalize (B mx my SX SY) (B my mz SY SZ) (B mz mx SZ SX). intros B1 B2 B3.
  assert (C : number computed /\ 0 <= computed <= W * W /\ area * (1 - eps) <= computed + eta).
  { generalize (product_lower mx my (proj1 A1)) (product_lower my mz (proj1 A2))
      (product_lower mz mx (proj1 A3)). intros L1 L2 L3.
    unfold computed, area.
    assert (N : forall x, number (fl x)) by (intros; apply rnd_number; auto with typeclass_instances).
    unfold Rmax. repeat destruct Rle_dec; (split; [apply N | split; [lra | nra]]). }
  destruct C as (C1 & C2 & C3). unfold error_of_g. fold computed.
  assert (PA : 0 <= area * area) by (apply Rle_0_sqr).
  assert (PC : 0 <= computed * computed) by (apply Rle_0_sqr).
  apply (all_within (concat (map quartic (inside q))) (concat (map quartic (inside any_query)))
           (area * area) (fl (computed * computed)) 4 60 (2 * (W * W) + 2)); auto; try lia.
  - apply Forall_forall. intros e' I. apply in_concat in I. destruct I as (g & Ig & Ie').
    apply in_map_iff in Ig. destruct Ig as (f' & <- & If').
    exact (proj1 (Forall_forall _ _) (quartic_fits _ f' F If') e' Ie').
  - destruct (inside q) as [| f' l]; [easy |].
    exists (at_ f' 0), (Constant 12). simpl. now left.
  - apply rnd_number; auto with typeclass_instances.
  - apply rnd_nonnegative; auto with typeclass_instances.
  - nra.
  - generalize (product_lower _ _ PC). intros L1.
    assert (Pa : 0 <= area) by lra.
    assert (S : area * (1 - eps) * (area * (1 - eps)) <= (computed + eta) * (computed + eta)).
    { apply square_le. split; auto. apply Rmult_le_pos; lra. }
    assert (S2 : (computed + eta) * (computed + eta) <=
                 computed * computed + eta * (2 * (W * W) + 1)).
    { assert (eta * computed <= eta * (W * W)) by (apply Rmult_le_compat_l; lra).
      assert (eta * eta <= eta * 1) by (apply Rmult_le_compat_l; lra). lra. }
    assert (S3 : (area * area) * (1 - 2 * eps) <= area * (1 - eps) * (area * (1 - eps))).
    { replace (area * (1 - eps) * (area * (1 - eps))) with ((area * area) * ((1 - eps) * (1 - eps))) by ring.
      apply Rmult_le_compat_l; auto. nra. }
    set (v := area * area) in *. set (w := eta * (2 * (W * W) + 1)) in *.
    assert (Pw : 0 <= w) by (unfold w; nra).
    assert (S4 : v * (1 - 2 * eps) * (1 - eps) <= (computed * computed + w) * (1 - eps)).
    { apply Rmult_le_compat_r; lra. }
    replace (eta * (2 * (W * W) + 2)) with (w + eta) by (unfold w; ring).
    assert (S5 : v * (1 - 4 * eps) <= v * (1 - 2 * eps) * (1 - eps)).
    { rewrite Rmult_assoc. apply Rmult_le_compat_l; auto. nra. }
    assert (0 <= w * eps) by (apply Rmult_le_pos; lra). lra.
  - change (4 - 1)%nat with 3%nat. rewrite W_power. unfold W. rewrite <- bpow_plus.
    apply Rle_trans with (bpow radix2 2 * bpow radix2 400).
    + change (bpow radix2 2) with 4. change (200 + 200)%Z with 400%Z.
      assert (1 <= bpow radix2 400) by (change 1 with (bpow radix2 0); apply bpow_le; lia). lra.
    + rewrite <- !bpow_plus. apply bpow_le. simpl. lia.
  - apply in_concat. exists (quartic f). split; auto. now apply in_map.
Qed.

Theorem error_of_vertex_face_sound f e :
  In f (vertex_face_inside q) -> In e (quartic f) ->
  Rabs (value e - exact e) + tiny / 1000 <= error_of_g vertex_face_inside mx my mz * (1 - eps).
Proof.
  apply error_of_g_sound; [| apply vertex_face_inside_fit | discriminate].
  apply (query_shape (fun q => concat (map quartic (vertex_face_inside q)))). reflexivity.
Qed.
Theorem error_of_edge_edge_sound f e :
  In f (edge_edge_inside q) -> In e (quartic f) ->
  Rabs (value e - exact e) + tiny / 1000 <= error_of_g edge_edge_inside mx my mz * (1 - eps).
Proof.
  apply error_of_g_sound; [| apply edge_edge_inside_fit | discriminate].
  apply (query_shape (fun q => concat (map quartic (edge_edge_inside q)))). reflexivity.
Qed.

End Query.
End CcdFilter.
