(** Widths of the exact decisions in integers of fixed width (ccd/exact/integer_decision.hpp,
    vertex_edge_contact.hpp, common_roots.hpp, interior_contact.hpp, cubic_roots.hpp). If differences of coordinates
    are below D = 2^(64W - 3), W = 1, 2 or 4, every computed number fits the words of its type. Numbers are
    expressions with an upper bound and a number of words. Results:
        expression_exact       if no subexpression exceeds its width, the computed words (Words.v) are those of the
                               exact number
        vertex_edge_widths, vertex_vertex_widths   none does in vertex/edge and vertex/vertex contact
        interior_widths        nor in interior contact, except for halves of Y and brackets
        halving_widths, bracket_widths   nor in halves of Y, nor with brackets of T = 1, ..., 4 words
        cut_widths             nor in rounded forms with T words, if only a bracket is known *)

From Coq Require Import Reals ZArith List Lia Lra Bool.
From Errbound Require Import Sign Bernstein Decisions Words.
Import ListNotations.
Open Scope Z_scope.

(** A number with n words has a size of at most m 2^k; `Whole` has no fixed width. *)
Inductive expression :=
| Given (n : nat) (m k : Z) (x : list Z)
| Whole (n : Z)
| Plus (x y : expression)
| Less (x y : expression)
| Times (x y : expression)
| Shifted (x : expression) (bits : Z)
| Opposite (x : expression)
| Magnitude (x : expression)
| Longer (x : expression) (words : nat).

Fixpoint width (e : expression) : nat :=
  match e with
  | Given n _ _ _ => n
  | Whole _ => 0
  | Plus x _ | Less x _ | Shifted x _ | Opposite x | Magnitude x => width x
  | Times x y => width x + width y
  | Longer x words => width x + words
  end.
Fixpoint bound (e : expression) : Z :=
  match e with
  | Given _ m k _ => m * 2 ^ k
  | Whole n => Z.abs n
  | Plus x y | Less x y => bound x + bound y
  | Times x y => bound x * bound y
  | Shifted x bits => bound x * 2 ^ bits
  | Opposite x | Magnitude x | Longer x _ => bound x
  end.
Fixpoint number (e : expression) : Z :=
  match e with
  | Given _ _ _ x => signed x
  | Whole n => n
  | Plus x y => number x + number y
  | Less x y => number x - number y
  | Times x y => number x * number y
  | Shifted x bits => number x * 2 ^ bits
  | Opposite x => - number x
  | Magnitude x => Z.abs (number x)
  | Longer x _ => number x
  end.
(** The computed words. *)
Definition opposite (x : list Z) : list Z := difference (zeros (length x)) x.
Fixpoint computed (e : expression) : list Z :=
  match e with
  | Given _ _ _ x => x
  | Whole _ => []
  | Plus x y => sum (computed x) (computed y)
  | Less x y => difference (computed x) (computed y)
  | Times x y => product (computed x) (computed y)
  | Shifted x bits => shifted (computed x) bits
  | Opposite x => opposite (computed x)
  | Magnitude x => if negative (computed x) then opposite (computed x) else computed x
  | Longer x words => extended (computed x) (width x + words)
  end.

(** Bounds are below half of the width's range, and operands of sums have one type. *)
Definition within (e : expression) : bool := 2 * bound e <? B ^ Z.of_nat (width e).
Fixpoint fine (e : expression) : bool :=
  within e &&
  match e with
  | Given n _ k _ => negb (n =? 0)%nat && (0 <=? k)
  | Whole _ => false
  | Plus x y | Less x y => fine x && fine y && (width x =? width y)%nat
  | Times x y => fine x && fine y
  | Shifted x bits => fine x && (0 <=? bits) && (bits <? 64)
  | Opposite x | Magnitude x | Longer x _ => fine x
  end.
Fixpoint given (e : expression) : Prop :=
  match e with
  | Given n m k x => words x /\ length x = n /\ Z.abs (signed x) <= m * 2 ^ k
  | Whole _ => True
  | Plus x y | Less x y | Times x y => given x /\ given y
  | Shifted x _ | Opposite x | Magnitude x | Longer x _ => given x
  end.

Lemma sum_words a b : length a = length b -> words a -> words b -> words (sum a b) /\ length (sum a b) = length a.
Proof.
  intros L A D. unfold sum. generalize (stepped_sum a b 0 L A D ltac:(lia)) (stepped_length add_with_carry a b 0 L).
  destruct (stepped add_with_carry a b 0). tauto.
Qed.
Lemma difference_words a b : length a = length b -> words a -> words b ->
  words (difference a b) /\ length (difference a b) = length a.
Proof.
  intros L A D. unfold difference.
  generalize (stepped_difference a b 0 L A D ltac:(lia)) (stepped_length subtract_with_borrow a b 0 L).
  destruct (stepped subtract_with_borrow a b 0). tauto.
Qed.
Lemma within_fits e : within e = true -> Z.abs (number e) <= bound e -> fits (width e) (number e).
Proof. unfold within, fits. intros H L. apply Z.ltb_lt in H. lia. Qed.
Lemma nonempty (x : list Z) n : length x = n -> n <> 0%nat -> x <> [].
Proof. intros L N E. subst x. now subst n. Qed.

Lemma opposite_exact x : words x -> x <> [] -> fits (length x) (- signed x) ->
  words (opposite x) /\ length (opposite x) = length x /\ signed (opposite x) = - signed x.
Proof.
  intros W N F. unfold opposite. assert (L : length (zeros (length x)) = length x) by apply length_zeros.
  assert (Z0 : signed (zeros (length x)) = 0).
  { unfold signed. rewrite value_zeros. assert (negative (zeros (length x)) = false) as ->; [| reflexivity].
    unfold negative. clear - N. destruct x as [| w x]; [easy |]. clear N. cbn [length].
    induction (length x) as [| n IH]; [reflexivity | exact IH]. }
  destruct (difference_words (zeros (length x)) x L (words_zeros _) W) as [W' L'].
  split; [exact W' |]. split; [now rewrite L' |]. rewrite difference_exact; auto using words_zeros.
  - now rewrite Z0.
  - intros E. apply N. rewrite E in L. now destruct x.
  - now rewrite L, Z0.
Qed.

Theorem expression_exact e : given e -> fine e = true ->
  signed (computed e) = number e /\ length (computed e) = width e /\ words (computed e) /\
  Z.abs (number e) <= bound e /\ width e <> 0%nat.
Proof.
  induction e as [n m k x | n | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx bits | x IHx | x IHx | x IHx more];
    cbn [given fine]; intros G F; apply andb_prop in F; destruct F as [F0 F].
  - destruct G as (W & L & H). apply andb_prop in F. destruct F as [F _]. apply negb_true_iff, Nat.eqb_neq in F. cbn. auto.
  - discriminate.
  - destruct G as [Gx Gy]. apply andb_prop in F. destruct F as [F E]. apply andb_prop in F. destruct F as [Fx Fy].
    apply Nat.eqb_eq in E. destruct (IHx Gx Fx) as (Sx & Lx & Wx & Bx & Nx), (IHy Gy Fy) as (Sy & Ly & Wy & By & _).
    assert (R : Z.abs (number (Plus x y)) <= bound (Plus x y)) by (cbn [number bound]; lia).
    assert (L : length (computed x) = length (computed y)) by congruence.
    destruct (sum_words _ _ L Wx Wy) as [W' L']. cbn [computed]. split; [| cbn [width]; rewrite L'; auto].
    cbn [number]. rewrite <- Sx, <- Sy. apply sum_exact; auto; [now apply nonempty with (2 := Nx) |].
    rewrite Sx, Sy, Lx. now apply (within_fits (Plus x y)).
  - destruct G as [Gx Gy]. apply andb_prop in F. destruct F as [F E]. apply andb_prop in F. destruct F as [Fx Fy].
    apply Nat.eqb_eq in E. destruct (IHx Gx Fx) as (Sx & Lx & Wx & Bx & Nx), (IHy Gy Fy) as (Sy & Ly & Wy & By & _).
    assert (R : Z.abs (number (Less x y)) <= bound (Less x y)) by (cbn [number bound]; lia).
    assert (L : length (computed x) = length (computed y)) by congruence.
    destruct (difference_words _ _ L Wx Wy) as [W' L']. cbn [computed]. split; [| cbn [width]; rewrite L'; auto].
    cbn [number]. rewrite <- Sx, <- Sy. apply difference_exact; auto; [now apply nonempty with (2 := Nx) |].
    rewrite Sx, Sy, Lx. now apply (within_fits (Less x y)).
  - destruct G as [Gx Gy]. apply andb_prop in F. destruct F as [Fx Fy].
    destruct (IHx Gx Fx) as (Sx & Lx & Wx & Bx & Nx), (IHy Gy Fy) as (Sy & Ly & Wy & By & Ny). cbn [computed number bound width].
    assert (Ey := nonempty _ _ Ly Ny). destruct (product_words (computed x) (computed y) Ey Wx Wy) as [W' L'].
    split; [| split; [lia | split; [exact W' | split; [| lia]]]].
    + rewrite <- Sx, <- Sy. apply product_exact; auto. now apply nonempty with (2 := Nx).
    + rewrite Z.abs_mul. apply Z.mul_le_mono_nonneg; lia.
  - apply andb_prop in F. destruct F as [F E2]. apply andb_prop in F. destruct F as [Fx E1].
    apply Z.leb_le in E1. apply Z.ltb_lt in E2. destruct (IHx G Fx) as (Sx & Lx & Wx & Bx & Nx).
    assert (P : 0 < 2 ^ bits) by (apply Z.pow_pos_nonneg; lia).
    assert (R : Z.abs (number (Shifted x bits)) <= bound (Shifted x bits)) by (cbn [number bound]; rewrite Z.abs_mul, (Z.abs_eq (2 ^ bits)) by lia; nia).
    assert (Ex := nonempty _ _ Lx Nx). assert (Hf := within_fits _ F0 R). cbn [computed number bound width] in *.
    assert (LW : length (shifted (computed x) bits) = width x /\ words (shifted (computed x) bits)).
    { unfold shifted. destruct (Z.eqb_spec bits 0); auto.
      destruct (shift_words_value 0 (computed x) bits ltac:(lia) ltac:(unfold word; generalize B_positive; lia) Wx) as (L & V & _).
      split; [congruence | exact V]. }
    split; [| split; [apply LW | split; [apply LW | auto]]].
    rewrite <- Sx. apply shift_exact; auto. now rewrite Sx, Lx.
  - destruct (IHx G F) as (Sx & Lx & Wx & Bx & Nx). cbn [computed number bound width].
    assert (R : Z.abs (number (Opposite x)) <= bound (Opposite x)) by (cbn [number bound]; lia).
    assert (Ex := nonempty _ _ Lx Nx). assert (Hf := within_fits _ F0 R). cbn [number width] in Hf.
    destruct (opposite_exact (computed x) Wx Ex ltac:(now rewrite Sx, Lx)) as (W' & L' & S').
    split; [now rewrite S', Sx | split; [now rewrite L' | split; [exact W' | split; [lia | exact Nx]]]].
  - destruct (IHx G F) as (Sx & Lx & Wx & Bx & Nx). cbn [computed number bound width].
    assert (R : Z.abs (number (Opposite x)) <= bound (Opposite x)) by (cbn [number bound]; lia).
    assert (Ex := nonempty _ _ Lx Nx). assert (Hf := within_fits (Opposite x) F0 R). cbn [number width] in Hf.
    assert (Sn : if negative (computed x) then number x < 0 else 0 <= number x).
    { rewrite <- Sx. generalize (negative_spec _ Wx Ex) (value_bounds _ Wx). unfold signed.
      destruct (negative (computed x)); lia. }
    destruct (negative (computed x)).
    + destruct (opposite_exact (computed x) Wx Ex ltac:(now rewrite Sx, Lx)) as (W' & L' & S').
      split; [rewrite S', Sx; lia | split; [now rewrite L' | split; [exact W' | split; [lia | exact Nx]]]].
    + split; [lia | split; [exact Lx | split; [exact Wx | split; [lia | exact Nx]]]].
  - destruct (IHx G F) as (Sx & Lx & Wx & Bx & Nx). cbn [computed number bound width].
    destruct (extended_exact (computed x) (width x + more) (nonempty _ _ Lx Nx) Wx ltac:(lia)) as (S' & W' & L').
    split; [now rewrite S' | split; [exact L' | split; [exact W' | split; [exact Bx | lia]]]].
Qed.

(** Expressions as a scalar of Bernstein.v, so that its code of forms applies. *)
Definition sign_of_number (z : Z) : sign :=
  match z ?= 0 with Lt => Sign.negative | Eq => Sign.zero | Gt => Sign.positive end.
Program Definition expressions : scalar := {|
  Bernstein.number := expression; add := Plus; sub := Less; mul := Times; opp := Opposite; whole := Whole;
  twice := fun x => Shifted x 1; normalized := fun p => p; Bernstein.sign_of := fun x => sign_of_number (number x);
  exact := fun x => IZR (number x) |}.
Next Obligation. apply plus_IZR. Qed.
Next Obligation. apply minus_IZR. Qed.
Next Obligation. apply mult_IZR. Qed.
Next Obligation. apply opp_IZR. Qed.
Next Obligation. change (Z.pow_pos 2 1) with 2. rewrite mult_IZR. apply Rmult_comm. Qed.
Next Obligation.
  exists 1%R. split; [lra |]. rewrite <- (map_id (map _ p)) at 1. apply map_ext. intros r. now rewrite Rmult_1_l.
Qed.
Next Obligation.
  unfold sign_of_number. destruct (Z.compare_spec (number x) 0) as [-> | H | H]; cbn; [easy | now apply IZR_lt ..].
Qed.

(** A faster version: the width, and the bound as m 2^k with a small m. *)
Definition checked (w : nat) (m k : Z) : option (nat * Z * Z) :=
  if (0 <=? k) && (Z.log2 m + k + 1 <? 64 * Z.of_nat w) then Some (w, m, k) else None.
Definition checked_sum (x y : option (nat * Z * Z)) : option (nat * Z * Z) :=
  match x, y with
  | Some (w, m, k), Some (v, n, l) =>
      if (w =? v)%nat then checked w (m * 2 ^ (k - Z.min k l) + n * 2 ^ (l - Z.min k l)) (Z.min k l) else None
  | _, _ => None
  end.
Fixpoint measured (e : expression) : option (nat * Z * Z) :=
  match e with
  | Given n m k _ => if (n =? 0)%nat then None else checked n m k
  | Whole _ => None
  | Plus x y | Less x y => checked_sum (measured x) (measured y)
  | Times x y =>
      match measured x, measured y with
      | Some (w, m, k), Some (v, n, l) => checked (w + v) (m * n) (k + l)
      | _, _ => None
      end
  | Shifted x bits =>
      match measured x with
      | Some (w, m, k) => if (0 <=? bits) && (bits <? 64) then checked w m (k + bits) else None
      | None => None
      end
  | Opposite x | Magnitude x => measured x
  | Longer x more =>
      match measured x with Some (w, m, k) => checked (w + more) m k | None => None end
  end.
Definition is_measured (e : expression) : bool := match measured e with Some _ => true | None => false end.

Lemma checked_within e w m k r : checked w m k = Some r -> width e = w -> bound e = m * 2 ^ k ->
  within e = true /\ r = (w, m, k) /\ 0 <= k.
Proof.
  unfold checked, within. destruct (Z.leb_spec 0 k) as [K |]; [| discriminate].
  destruct (Z.ltb_spec (Z.log2 m + k + 1) (64 * Z.of_nat w)) as [L |]; [| discriminate]. cbn [andb].
  pose proof (Z.log2_nonneg m) as M.
  assert (H : m < 2 ^ (64 * Z.of_nat w - 1 - k)).
  { destruct (Z.lt_ge_cases 0 m) as [P |]; [apply Z.log2_lt_pow2; lia |].
    assert (0 < 2 ^ (64 * Z.of_nat w - 1 - k)) by (apply Z.pow_pos_nonneg; lia). lia. }
  intros E W Bd. injection E as <-. split; auto. rewrite W, Bd. apply Z.ltb_lt. unfold base. rewrite <- Z.pow_mul_r by lia.
  replace (64 * Z.of_nat w) with (1 + (64 * Z.of_nat w - 1 - k) + k) by lia. rewrite !Z.pow_add_r by lia.
  assert (0 < 2 ^ k) by (apply Z.pow_pos_nonneg; lia). change (2 ^ 1) with 2. nia.
Qed.
Lemma measured_fine e w m k : measured e = Some (w, m, k) ->
  fine e = true /\ width e = w /\ bound e = m * 2 ^ k /\ 0 <= k.
Proof.
  assert (Sums : forall x y e, (width e = width x /\ bound e = bound x + bound y) ->
    (forall w m k, measured x = Some (w, m, k) -> fine x = true /\ width x = w /\ bound x = m * 2 ^ k /\ 0 <= k) ->
    (forall w m k, measured y = Some (w, m, k) -> fine y = true /\ width y = w /\ bound y = m * 2 ^ k /\ 0 <= k) ->
    forall w m k, checked_sum (measured x) (measured y) = Some (w, m, k) ->
    within e && (fine x && fine y && (width x =? width y)%nat) = true /\ width e = w /\ bound e = m * 2 ^ k /\ 0 <= k).
  { clear. intros x y e [We Be] IHx IHy w m k H. unfold checked_sum in H.
    destruct (measured x) as [[[v n] l] |]; [| discriminate]. destruct (measured y) as [[[v' n'] l'] |]; [| discriminate].
    destruct (IHx _ _ _ eq_refl) as (Fx & Wx & Bx & Kx), (IHy _ _ _ eq_refl) as (Fy & Wy & By & Ky).
    destruct (Nat.eqb_spec v v') as [<- |]; [| discriminate].
    assert (E : bound e = (n * 2 ^ (l - Z.min l l') + n' * 2 ^ (l' - Z.min l l')) * 2 ^ Z.min l l').
    { rewrite Be, Bx, By, Z.mul_add_distr_r, <- !Z.mul_assoc, <- !Z.pow_add_r by lia. do 3 f_equal; lia. }
    destruct (checked_within e _ _ _ _ H ltac:(congruence) E) as (F & R & K). injection R as -> -> ->.
    rewrite F, Fx, Fy, Wx, Wy, Nat.eqb_refl. split; auto. split; [congruence | auto]. }
  revert w m k. induction e as [n m0 k0 x | n | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx bits | x IHx | x IHx | x IHx more];
    intros w m k; cbn [measured fine].
  - destruct (Nat.eqb_spec n 0) as [| N]; [discriminate |]. intros H.
    destruct (checked_within (Given n m0 k0 x) _ _ _ _ H eq_refl eq_refl) as (F & R & K).
    injection R as -> -> ->. rewrite F. cbn [andb negb width bound]. apply Nat.eqb_neq in N. rewrite (proj2 (Z.leb_le 0 k0) K).
    repeat split; auto.
  - discriminate.
  - now apply (Sums x y).
  - now apply (Sums x y).
  - destruct (measured x) as [[[v n] l] |]; [| discriminate]. destruct (measured y) as [[[v' n'] l'] |]; [| discriminate].
    destruct (IHx _ _ _ eq_refl) as (Fx & Wx & Bx & Kx), (IHy _ _ _ eq_refl) as (Fy & Wy & By & Ky). intros H.
    assert (E : bound (Times x y) = n * n' * 2 ^ (l + l')) by (cbn [bound]; rewrite Bx, By, Z.pow_add_r by lia; ring).
    destruct (checked_within (Times x y) _ _ _ _ H ltac:(cbn [width]; congruence) E) as (F & R & K). injection R as -> -> ->.
    rewrite F, Fx, Fy. cbn [width]. repeat split; auto.
  - destruct (measured x) as [[[v n] l] |]; [| discriminate]. destruct (IHx _ _ _ eq_refl) as (Fx & Wx & Bx & Kx).
    destruct ((0 <=? bits) && (bits <? 64)) eqn:C; [| discriminate]. apply andb_prop in C. destruct C as [C1 C2]. intros H.
    assert (E : bound (Shifted x bits) = n * 2 ^ (l + bits)).
    { apply Z.leb_le in C1. cbn [bound]. rewrite Bx, Z.pow_add_r by lia. ring. }
    destruct (checked_within (Shifted x bits) _ _ _ _ H Wx E) as (F & R & K). injection R as -> -> ->.
    rewrite F, Fx, C1, C2. cbn [width]. repeat split; auto.
  - intros H. destruct (IHx _ _ _ H) as (Fx & Wx & Bx & Kx). cbn [width bound]. rewrite Fx, andb_true_r.
    repeat split; auto. revert Fx. unfold within. cbn [width bound]. destruct x; cbn [fine]; intros Fx; now apply andb_prop in Fx.
  - intros H. destruct (IHx _ _ _ H) as (Fx & Wx & Bx & Kx). cbn [width bound]. rewrite Fx, andb_true_r.
    repeat split; auto. revert Fx. unfold within. cbn [width bound]. destruct x; cbn [fine]; intros Fx; now apply andb_prop in Fx.
  - destruct (measured x) as [[[v n] l] |]; [| discriminate]. destruct (IHx _ _ _ eq_refl) as (Fx & Wx & Bx & Kx). intros H.
    destruct (checked_within (Longer x more) _ _ _ _ H ltac:(cbn [width]; congruence) Bx) as (F & R & K). injection R as -> -> ->.
    rewrite F, Fx. cbn [width]. repeat split; auto.
Qed.
Lemma all_measured l : forallb is_measured l = true -> forallb fine l = true.
Proof.
  rewrite !forallb_forall. intros H e I. specialize (H e I). unfold is_measured in H.
  destruct (measured e) as [[[w m] k] |] eqn:E; [| discriminate]. now apply measured_fine in E.
Qed.
Ltac widths := apply all_measured; vm_cast_no_check (eq_refl true).

(** ** The code's numbers *)

Notation polynomial := (list expression).
Notation vector := (@vector_form expressions).
Notation value_at := (@Bernstein.value_at expressions).
Notation "p # i" := (nth i p (Whole 0)) (at level 9, format "p # i").
Infix "⊕" := Plus (at level 50, left associativity).
Infix "⊖" := Less (at level 50, left associativity).
Infix "⊗" := Times (at level 40, left associativity).
Definition thrice (x : expression) : expression := Shifted x 1 ⊕ x.
(** The components one after the other. *)
Definition components (v : vector) : list polynomial := [vx v; vy v; vz v].
Definition all_of (v : vector) : list expression := vx v ++ vy v ++ vz v.

(** common_roots, of quadratics f *)
Definition cross_product (p q : polynomial) : polynomial :=
  [p#1 ⊗ q#2 ⊖ p#2 ⊗ q#1; p#2 ⊗ q#0 ⊖ p#0 ⊗ q#2; p#0 ⊗ q#1 ⊖ p#1 ⊗ q#0].
Definition value_at_squares (p m : polynomial) : expression := p#0 ⊗ m#0 ⊕ p#1 ⊗ m#1 ⊕ p#2 ⊗ m#2.
Definition pairs (f : list polynomial) : list (polynomial * polynomial) :=
  match f with [x; y; z] => [(x, y); (x, z); (y, z)] | _ => [] end.
Definition common_roots_numbers (f : list polynomial) : list expression :=
  flat_map (fun pq : polynomial * polynomial =>
    let m := cross_product (fst pq) (snd pq) in
    m ++ map Opposite m ++ map (fun g => value_at_squares g m) f ++ [m#1 ⊗ m#1; m#0 ⊗ m#2]) (pairs f).
(** nonpositive_at_a_root(f, b) *)
Definition at_a_root_numbers (b f : polynomial) : list expression :=
  let l := [f#2 ⊗ b#0 ⊖ b#2 ⊗ f#0; f#2 ⊗ b#1 ⊖ b#2 ⊗ f#1] in
  let s := Magnitude l#1 in
  let t := Magnitude l#0 in
  let slope := [f#1 ⊖ Shifted f#0 1; Shifted f#2 1 ⊖ f#1] in
  [value_at b (Magnitude f#2) (Magnitude f#1); value_at b (Magnitude f#1) (Magnitude f#0);
   f#1 ⊗ f#1 ⊖ Shifted (f#0 ⊗ f#2) 2;
   value_at b (Shifted (Magnitude f#2) 1) (Magnitude f#1)] ++
  l ++ [value_at f s t] ++ slope ++ [value_at slope s t].
(** contact(vertex_edge); w = v - e0, e = e1 - e0, x = v - e1 *)
Definition vertex_edge_numbers (w e x : vector) : list expression :=
  let f := components (cross_form w e) in
  let b := dot_form w x in
  concat f ++ b ++ common_roots_numbers f ++
  flat_map (fun pq : polynomial * polynomial => [value_at_squares b (cross_product (fst pq) (snd pq))]) (pairs f) ++
  flat_map (at_a_root_numbers b) f ++ [b#1 ⊗ b#1; Shifted (b#0 ⊗ b#2) 2].

(** contact(vertex_vertex) *)
Definition vertex_vertex_numbers (w0 w1 : vector) : list expression := all_of (cross_form w0 w1) ++ dot_form w0 w1.
(** The weights of either kind, with constant b, c and p. *)
Definition inside_numbers (b c p : vector) : list expression :=
  concat (inside_face_forms b c p) ++ concat (inside_edges_forms b c p).
Definition vector_at (v : vector) (s t : expression) : vector :=
  VectorForm [value_at (vx v) s t] [value_at (vy v) s t] [value_at (vz v) s t].
Definition inside_at (b c p : vector) (s t : expression) : list expression :=
  inside_numbers (vector_at b s t) (vector_at c s t) (vector_at p s t).
Definition coefficient (v : vector) (i : nat) : vector := VectorForm [(vx v)#i] [(vy v)#i] [(vz v)#i].
Definition inside_at_end (b c p : vector) (i : nat) : list expression :=
  inside_numbers (coefficient b i) (coefficient c i) (coefficient p i).
Definition hessian (y : polynomial) : polynomial :=
  [y#1 ⊗ y#1 ⊖ thrice (y#0 ⊗ y#2); y#1 ⊗ y#2 ⊖ thrice (thrice (y#0 ⊗ y#3)); y#2 ⊗ y#2 ⊖ thrice (y#1 ⊗ y#3)].
(** interior_contact before the halves; the quadratics of normal_vanishes are those of n. *)
Definition interior_numbers (b c p : vector) : list expression :=
  let y := y_form b c p in
  let h := hessian y in
  let s := thrice y#3 in
  y ++ inside_at_end b c p 0 ++ inside_at_end b c p 1 ++ h ++ [Shifted (h#0 ⊗ h#2) 2 ⊖ h#1 ⊗ h#1] ++
  inside_at b c p (Opposite s) (y#2) ++ inside_at b c p s (Opposite y#2) ++
  inside_at b c p (Shifted h#2 1) (Opposite h#1) ++ common_roots_numbers (components (cross_form b c)).

(** Halves of an interval of Y: its coefficients, at most 6 8^level (1, 3, 3, 1) D^3, with two more words. *)
Definition part (W : nat) (level : Z) (x : list (list Z)) : polynomial :=
  let coefficient i m := Given (3 * W + 2) m (3 * (64 * Z.of_nat W - 3) + 3 * level) (nth i x []) in
  [coefficient 0%nat 6; coefficient 1%nat 18; coefficient 2%nat 18; coefficient 3%nat 6].
Definition halving_numbers (y : polynomial) : list expression :=
  @left_half expressions y ++ @left_half expressions (rev y) ++ [y#0 ⊕ y#1 ⊕ y#2 ⊕ y#3].
(** Brackets of T words: t is an end of one, s = 2^bits - t, bits <= 64T - 2. The numbers are Y and its slope there,
    the weights if it is a root, those of `normal_vanishes`, and the next position. *)
Definition bracket_numbers (T : nat) (b c p : vector) (place reach s t width estimate : list Z) :
  list expression :=
  let of_bits x := Given T 1 (64 * Z.of_nat T - 2) x in
  let s := of_bits s in
  let t := of_bits t in
  let y := y_form b c p in
  let slope := [y#1 ⊖ thrice y#0; Shifted (y#2 ⊖ y#1) 1; thrice y#3 ⊖ y#2] in
  let y_t := value_at y s t in
  let rise := Longer (Given 1 1 26 width ⊗ value_at slope s t) (T - 1) in
  let n := components (cross_form b c) in
  let linear_forms := components b ++ components c ++ components p in
  [of_bits place ⊖ Given T 1 24 reach; of_bits place ⊕ Given T 1 24 reach; thrice y_t ⊕ rise; thrice y_t ⊖ rise;
   Shifted (Longer t 1) 45 ⊕ Longer (Given 1 1 46 estimate) T] ++
  inside_at b c p s t ++
  flat_map (fun pq : polynomial * polynomial =>
    let m := map Opposite (cross_product (fst pq) (snd pq)) in [m#1 ⊗ s; m#0 ⊗ t]) (pairs n) ++
  map (fun f => value_at f s t) n ++ map (fun x => x#1 ⊖ x#0) linear_forms.
(** If only a bracket is known: constants rounded to T words. *)
Definition cut_vector (T : nat) (x : list (list Z)) : vector :=
  let known i := [Given T 1 (64 * Z.of_nat T - 4) (nth i x [])] in
  @VectorForm expressions (known 0%nat) (known 1%nat) (known 2%nat).
(** Differences of coordinates, with W words. *)
Definition D_bits (W : nat) : Z := 64 * Z.of_nat W - 3.
Definition linear (W : nat) (x0 x1 : list Z) : polynomial := [Given W 1 (D_bits W) x0; Given W 1 (D_bits W) x1].
Definition moving (W : nat) (x : list (list Z)) : vector := @VectorForm expressions
  (linear W (nth 0 x []) (nth 1 x [])) (linear W (nth 2 x []) (nth 3 x [])) (linear W (nth 4 x []) (nth 5 x [])).

Theorem vertex_edge_widths W w e x : In W [1; 2; 4]%nat ->
  forallb fine (vertex_edge_numbers (moving W w) (moving W e) (moving W x)) = true.
Proof. intros [<- | [<- | [<- | []]]]; widths. Qed.
Theorem vertex_vertex_widths W w : In W [1; 2; 4]%nat ->
  forallb fine (vertex_vertex_numbers (coefficient (moving W w) 0) (coefficient (moving W w) 1)) = true.
Proof. intros [<- | [<- | [<- | []]]]; widths. Qed.
Theorem interior_widths W b c p : In W [1; 2; 4]%nat ->
  forallb fine (interior_numbers (moving W b) (moving W c) (moving W p)) = true.
Proof. intros [<- | [<- | [<- | []]]]; widths. Qed.

Definition levels : list Z := map Z.of_nat (seq 0 40).
Lemma levels_all level : 0 <= level < 40 -> In level levels.
Proof. intros H. apply in_map_iff. exists (Z.to_nat level). split; [lia | apply in_seq; lia]. Qed.
(** The whole is within the bounds of the first level's intervals, and halves are within those of the next level's. *)
Theorem halving_widths W level b c p x y : In W [1; 2; 4]%nat -> 0 <= level < 40 ->
  map bound (map (fun h => Longer h 2) (y_form (moving W b) (moving W c) (moving W p))) = map bound (part W 0 y) /\
  forallb fine (halving_numbers (part W level x)) = true /\
  map bound (@left_half expressions (part W level x)) = map bound (part W (level + 1) y) /\
  map bound (rev (@left_half expressions (rev (part W level x)))) = map bound (part W (level + 1) y).
Proof.
  intros HW L. split; [destruct HW as [<- | [<- | [<- | []]]]; vm_compute; reflexivity |].
  assert (F : forallb (fun l => forallb is_measured (halving_numbers (part W l x))) levels = true)
    by (destruct HW as [<- | [<- | [<- | []]]]; vm_compute; reflexivity).
  rewrite forallb_forall in F. specialize (F level (levels_all level L)).
  split; [now apply all_measured |]. clear F. cbn [In] in HW.
  assert (E : forall m, m * 2 ^ (3 * (64 * Z.of_nat W - 3) + 3 * (level + 1)) =
    m * 8 * 2 ^ (3 * (64 * Z.of_nat W - 3) + 3 * level)).
  { intros m. replace (3 * (64 * Z.of_nat W - 3) + 3 * (level + 1)) with (3 + (3 * (64 * Z.of_nat W - 3) + 3 * level)) by ring.
    rewrite Z.pow_add_r by lia. change (2 ^ 3) with 8. ring. }
  unfold part. cbn [map bound left_half fold_left next_half half_shifted rev app twice expressions add]. rewrite !E.
  set (u := 2 ^ (3 * (64 * Z.of_nat W - 3) + 3 * level)). change (2 ^ 1) with 2. split; repeat (apply (f_equal2 cons); [ring |]); reflexivity.
Qed.
Theorem bracket_widths W T b c p place reach s t width estimate :
  In W [1; 2; 4]%nat -> In T [1; 2; 3; 4]%nat ->
  forallb fine (bracket_numbers T (moving W b) (moving W c) (moving W p) place reach s t width estimate) = true.
Proof.
  intros [<- | [<- | [<- | []]]] H; repeat (destruct H as [<- | H]; [widths |]); contradiction.
Qed.
Theorem cut_widths T b c p : In T [1; 2; 3; 4]%nat ->
  forallb fine (inside_numbers (cut_vector T b) (cut_vector T c) (cut_vector T p)) = true.
Proof.
  intros H. repeat (destruct H as [<- | H]; [widths |]); contradiction.
Qed.
