(** Arithmetic modulo an odd p < 2^62 (include/errbound/roots/prime_field.hpp), in Montgomery's form: a residue x is
    stored as a, 0 <= a < p, with a = x R modulo p, R = 2^64. Words are those of Words.v. Results:
        negative_inverse_right    p negative_inverse = -1 modulo R
        constants_right           one and square are R and R^2 modulo p
        field_add, field_subtract, field_multiply, field_multiply_and_subtract, field_forms
                                  each returns the form of the result, and no number exceeds 128 bits
        nonzero_form              the form of a residue is zero exactly if the residue is
        power_right               power
        value_modulo_right        if a polynomial's value modulo p is not zero, the value is not zero *)

From Coq Require Import ZArith Znumtheory List Lia.
From Errbound Require Import Words.
Import ListNotations.
Open Scope Z_scope.

Section Field.

Context (p : Z) (p_range : 2 < p < 2 ^ 62) (p_odd : Z.Odd p).

(** The code, with double words modulo 2^128. *)
Definition better (inverse : Z) : Z := inverse * ((2 - p * inverse mod B) mod B) mod B.
Definition inverse_of_p : Z := better (better (better (better (better p)))).
Definition negative_inverse : Z := (0 - inverse_of_p) mod B.
Definition one : Z := (0 - p) mod B mod p.
Definition square : Z := one * one mod (B * B) mod p.
Definition add (a b : Z) : Z := if p <=? (a + b) mod B then ((a + b) mod B - p) mod B else (a + b) mod B.
Definition subtract (a b : Z) : Z := if b <=? a then (a - b) mod B else ((a + p) mod B - b) mod B.
Definition reduced (t : Z) : Z :=
  let m := t mod B * negative_inverse mod B in
  let r := (t + m * p) mod (B * B) / B mod B in
  if p <=? r then (r - p) mod B else r.
Definition multiply (a b : Z) : Z := reduced (a * b mod (B * B)).
Definition multiply_and_subtract (a b c d : Z) : Z :=
  reduced ((a * b mod (B * B) + c * ((p - d) mod B) mod (B * B)) mod (B * B)).
Definition to_form (a : Z) : Z := multiply a square.
Definition from_form (a : Z) : Z := multiply a 1.

(** a is the form of x. *)
Definition form (a x : Z) : Prop := 0 <= a < p /\ (p | a - x * B).

Lemma B_is : B = 4 * 2 ^ 62.
Proof. reflexivity. Qed.

(** Each step doubles the number of right bits. *)
Lemma better_right k x : 0 <= k <= 32 -> (2 ^ k | 1 - p * x) -> (2 ^ (2 * k) | 1 - p * better x).
Proof.
  intros K [q H]. assert (M : forall z, (2 ^ (2 * k) | z - z mod B)).
  { intros z. exists (2 ^ (64 - 2 * k) * (z / B)). generalize (Z.div_mod z B). intros D.
    replace (2 ^ (64 - 2 * k) * (z / B) * 2 ^ (2 * k)) with (2 ^ (64 - 2 * k + 2 * k) * (z / B)) by (rewrite Z.pow_add_r by lia; ring).
    replace (64 - 2 * k + 2 * k) with 64 by ring. change (2 ^ 64) with B. specialize (D ltac:(discriminate)). lia. }
  unfold better. set (u := p * x mod B). set (v := (2 - u) mod B).
  assert (D : (2 ^ (2 * k) | x * (2 - p * x) - x * v mod B)).
  { replace (x * (2 - p * x) - x * v mod B)
      with ((x * v - x * v mod B) + x * ((2 - u) - v) + x * (- (p * x - u))) by ring.
    apply Z.divide_add_r; [apply Z.divide_add_r; [apply M |] |]; apply Z.divide_mul_r; [apply M |].
    apply Z.divide_opp_r, M. }
  replace (1 - p * (x * v mod B)) with ((1 - p * x) * (1 - p * x) + p * (x * (2 - p * x) - x * v mod B)) by ring.
  apply Z.divide_add_r; [| now apply Z.divide_mul_r]. rewrite H. exists (q * q).
  replace (2 * k) with (k + k) by ring. rewrite Z.pow_add_r by lia. ring.
Qed.
Lemma fewer_bits k l z : 0 <= l <= k -> (2 ^ k | z) -> (2 ^ l | z).
Proof.
  intros L. apply Z.divide_trans. exists (2 ^ (k - l)). rewrite <- Z.pow_add_r by lia. f_equal. lia.
Qed.
Theorem negative_inverse_right : word negative_inverse /\ (B | p * negative_inverse + 1).
Proof.
  split; [apply Z.mod_pos_bound; exact B_positive |].
  assert (H3 : (2 ^ 3 | 1 - p * p)).
  { destruct p_odd as [q ->]. destruct (Z.Even_or_Odd q) as [[s ->] | [s ->]].
    - exists (- (s * (2 * s + 1))). change (2 ^ 3) with 8. ring.
    - exists (- ((2 * s + 1) * (s + 1))). change (2 ^ 3) with 8. ring. }
  assert (I : (2 ^ 64 | 1 - p * inverse_of_p)).
  { unfold inverse_of_p. apply (fewer_bits 64 64); [lia |]. apply (better_right 32); [lia |].
    apply (fewer_bits 48 32); [lia |]. apply (better_right 24); [lia |]. apply (better_right 12); [lia |].
    apply (better_right 6); [lia |]. apply (better_right 3); [lia |]. exact H3. }
  revert I. unfold negative_inverse. generalize inverse_of_p. intros v [q I].
  assert (N := Z.div_mod (0 - v) B ltac:(discriminate)). set (n := (0 - v) mod B) in *. set (e := (0 - v) / B) in *.
  clearbody n e. exists (q - p * e). replace (p * n + 1) with (1 - p * v + p * (n + v)) by ring. rewrite I.
  replace (n + v) with (- (B * e)) by lia. change (2 ^ 64) with B. ring.
Qed.

Lemma reduced_right t : 0 <= t < 3 * p * p -> 0 <= reduced t < p /\ (p | t - reduced t * B).
Proof.
  intros T. unfold reduced. cbv zeta. destruct negative_inverse_right as [W I]. generalize B_is p_range. intros EB PR.
  set (m := t mod B * negative_inverse mod B). assert (M : 0 <= m < B) by (apply Z.mod_pos_bound; lia).
  assert (PP : 3 * p * p < B * p) by nia. assert (MP : m * p <= (B - 1) * p) by nia.
  assert (S : 0 <= t + m * p < 2 * B * p) by nia. assert (BP : 2 * B * p < B * B) by nia.
  rewrite (Z.mod_small (t + m * p)) by lia.
  (* t + m p is a multiple of R *)
  assert (Div : (B | t + m * p)).
  { destruct I as [q I]. unfold m. set (t0 := t mod B).
    generalize (Z.div_mod t B ltac:(lia)) (Z.div_mod (t0 * negative_inverse) B ltac:(lia)). fold t0.
    set (h := t / B). set (n := negative_inverse) in *. set (l := t0 * n / B). set (r := t0 * n mod B).
    intros D1 D2. exists (h + t0 * q - p * l).
    assert (S' : t + r * p = B * h + t0 * (p * n + 1) - B * l * p).
    { replace r with (t0 * n - B * l) by lia. rewrite D1 at 1. ring. }
    rewrite S', I. ring. }
  destruct Div as [r E]. rewrite E, Z.div_mul by lia.
  assert (R : 0 <= r < 2 * p) by nia. rewrite (Z.mod_small r) by lia.
  destruct (Z.leb_spec p r).
  - rewrite Z.mod_small by lia. split; [lia |]. exists (B - m). nia.
  - split; [lia |]. exists (- m). nia.
Qed.

Lemma cancel_R z : (p | z * B) -> (p | z).
Proof.
  intros H. apply Gauss with B; [now rewrite Z.mul_comm |]. apply rel_prime_sym.
  assert (G : forall n, 0 <= n -> rel_prime (2 ^ n) p).
  { apply natlike_ind; [apply rel_prime_1 |]. intros n N IH. rewrite Z.pow_succ_r by auto.
    apply rel_prime_sym, rel_prime_mult; [| now apply rel_prime_sym]. apply rel_prime_sym.
    apply prime_rel_prime; [exact prime_2 |]. intros [q Q]. destruct p_odd as [s S]. lia. }
  exact (G 64 ltac:(lia)).
Qed.

Theorem field_add a x b y : form a x -> form b y -> form (add a b) (x + y).
Proof.
  intros [A [q Q]] [D [r R]]. unfold add. generalize B_is p_range. intros. rewrite (Z.mod_small (a + b)) by lia.
  destruct (Z.leb_spec p (a + b)); [rewrite Z.mod_small by lia |].
  - split; [lia |]. exists (q + r - 1). lia.
  - split; [lia |]. exists (q + r). lia.
Qed.
Theorem field_subtract a x b y : form a x -> form b y -> form (subtract a b) (x - y).
Proof.
  intros [A [q Q]] [D [r R]]. unfold subtract. generalize B_is p_range. intros. destruct (Z.leb_spec b a).
  - rewrite Z.mod_small by lia. split; [lia |]. exists (q - r). lia.
  - rewrite (Z.mod_small (a + p)), Z.mod_small by lia. split; [lia |]. exists (q - r + 1). lia.
Qed.
Lemma reduced_form t z : 0 <= t < 3 * p * p -> (p | t - z * B * B) -> form (reduced t) z.
Proof.
  intros T [q Q]. destruct (reduced_right t T) as [R [s S]]. split; auto. apply cancel_R. exists (q - s). lia.
Qed.
Theorem field_multiply a x b y : form a x -> form b y -> form (multiply a b) (x * y).
Proof.
  intros [A [q Q]] [D [r R]]. unfold multiply. generalize B_is p_range. intros. rewrite Z.mod_small by nia.
  apply reduced_form; [nia |]. exists (q * b + x * B * r).
  replace (a * b - x * y * B * B) with ((a - x * B) * b + x * B * (b - y * B)) by ring. rewrite Q, R. ring.
Qed.
Theorem field_multiply_and_subtract a x b y c z d w : form a x -> form b y -> form c z -> form d w ->
  form (multiply_and_subtract a b c d) (x * y - z * w).
Proof.
  intros [A [q Q]] [D [r R]] [C [s S]] [F [t T]]. unfold multiply_and_subtract. generalize B_is p_range. intros EB PR.
  rewrite (Z.mod_small (p - d)) by lia.
  assert (P1 : 0 <= a * b <= p * p) by (split; [apply Z.mul_nonneg_nonneg | apply Z.mul_le_mono_nonneg]; lia).
  assert (P2 : 0 <= c * (p - d) <= p * p) by (split; [apply Z.mul_nonneg_nonneg | apply Z.mul_le_mono_nonneg]; lia).
  assert (PP : 3 * (p * p) < B * B) by nia.
  rewrite (Z.mod_small (a * b)), (Z.mod_small (c * (p - d))), Z.mod_small by lia.
  apply reduced_form; [nia |]. exists (q * b + x * B * r + c - s * d - z * B * t).
  replace (a * b + c * (p - d) - (x * y - z * w) * B * B)
    with ((a - x * B) * b + x * B * (b - y * B) + c * p - (c - z * B) * d - z * B * (d - w * B)) by ring.
  rewrite Q, R, S, T. ring.
Qed.

Theorem constants_right : form one 1 /\ 0 <= square < p /\ (p | square - B * B).
Proof.
  generalize B_is p_range. intros EB PR.
  assert (O : 0 <= one < p /\ (p | one - B)).
  { unfold one. split; [apply Z.mod_pos_bound; lia |].
    assert (E : (0 - p) mod B = B - p).
    { replace (0 - p) with (B - p + (-1) * B) by ring. rewrite Z.mod_add by lia. apply Z.mod_small. lia. }
    rewrite E. generalize (Z.div_mod (B - p) p ltac:(lia)). intros D. exists (- ((B - p) / p) - 1). lia. }
  destruct O as [O [q Q]]. split; [split; [exact O | exists q; lia] |].
  unfold square. assert (P1 : 0 <= one * one < B * B) by nia. rewrite (Z.mod_small (one * one)) by auto.
  split; [apply Z.mod_pos_bound; lia |]. generalize (Z.div_mod (one * one) p ltac:(lia)). intros D.
  exists (q * (one + B) - one * one / p).
  replace (one * one mod p - B * B) with ((one - B) * (one + B) - p * (one * one / p)) by lia. rewrite Q. ring.
Qed.
(** Conversion into the form and back, a < p. *)
Theorem field_forms a x : (0 <= a < p -> form (to_form a) a) /\
  (form a x -> 0 <= from_form a < p /\ (p | from_form a - x)).
Proof.
  generalize B_is p_range. intros EB PR. split.
  - intros A. destruct constants_right as (_ & S & [q Q]). unfold to_form, multiply. rewrite Z.mod_small by nia.
    apply reduced_form; [nia |]. exists (a * q). replace (a * square - a * B * B) with (a * (square - B * B)) by ring.
    rewrite Q. ring.
  - intros [A [q Q]]. unfold from_form, multiply. rewrite Z.mul_1_r, Z.mod_small by nia.
    destruct (reduced_right a ltac:(nia)) as [R [s S]]. split; auto. apply cancel_R. exists (q - s). lia.
Qed.
Theorem nonzero_form a x : form a x -> (a = 0 <-> (p | x)).
Proof.
  intros [A [q Q]]. split.
  - intros ->. apply cancel_R. exists (- q). lia.
  - intros [r ->]. assert (H : a = (q + r * B) * p) by lia. assert (q + r * B = 0) by nia. lia.
Qed.

(** power: a^n, n > 0, times `result`. *)
Fixpoint power_from (result a : Z) (n : positive) : Z :=
  match n with
  | xH => multiply result a
  | xO n => power_from result (multiply a a) n
  | xI n => power_from (multiply result a) (multiply a a) n
  end.
Definition power (a n : Z) : Z := match n with Zpos n => power_from one a n | _ => one end.
Theorem power_right a x n : 0 <= n -> form a x -> form (power a n) (x ^ n).
Proof.
  assert (G : forall n result a y x, form result y -> form a x -> form (power_from result a n) (y * x ^ Zpos n)).
  { clear - p_range p_odd. induction n as [n IH | n IH |]; intros result a y x R A; cbn [power_from].
    - rewrite Pos2Z.inj_xI, Z.pow_add_r, Z.pow_mul_r, Z.pow_2_r, Z.pow_1_r, (Z.mul_comm _ x), Z.mul_assoc by lia.
      apply IH; now apply field_multiply.
    - rewrite Pos2Z.inj_xO, Z.pow_mul_r, Z.pow_2_r by lia. apply IH; [easy | now apply field_multiply].
    - rewrite Z.pow_1_r. now apply field_multiply. }
  intros N A. destruct constants_right as (O & _). destruct n as [| n |]; [easy | | lia].
  rewrite <- (Z.mul_1_l (x ^ _)). now apply G.
Qed.

(** Ordinary residues z, not in the form. *)
Definition residue_of (a z : Z) : Prop := 0 <= a < p /\ (p | a - z).
Lemma plain_multiply a z b y : residue_of a z -> form b y -> residue_of (multiply a b) (z * y).
Proof.
  intros [A [q Q]] F. generalize p_range. intros PR. destruct (reduced_right a ltac:(nia)) as [R [s S]].
  destruct (field_multiply a (reduced a) b y (conj A (ex_intro _ s S)) F) as [M [r E]]. split; [easy |].
  exists (r - y * s + y * q).
  replace (multiply a b - z * y) with (multiply a b - reduced a * y * B - y * (a - reduced a * B) + y * (a - z)) by ring.
  rewrite E, S, Q. ring.
Qed.
Lemma plain_add a z b y : residue_of a z -> residue_of b y -> residue_of (add a b) (z + y).
Proof.
  intros [A [q Q]] [C [r R]]. generalize p_range. intros PR. destruct (reduced_right a ltac:(nia)) as [_ [s S]].
  destruct (reduced_right b ltac:(nia)) as [_ [t T]].
  destruct (field_add a (reduced a) b (reduced b) (conj A (ex_intro _ s S)) (conj C (ex_intro _ t T))) as [M [u U]].
  split; [easy |]. exists (u - s - t + q + r).
  replace (add a b - (z + y)) with (add a b - (reduced a + reduced b) * B - (a - reduced a * B) - (b - reduced b * B) + (a - z) + (b - y)) by ring.
  rewrite U, S, T, Q, R. ring.
Qed.

(** The value at num/den times den^degree, by coefficients from the last to the first: in integers, and from their
    residues as in value_at of include/errbound/roots/integer_polynomial.hpp. *)
Fixpoint homogeneous (num den sum scale : Z) (coefficients : list Z) : Z :=
  match coefficients with [] => sum | c :: l => homogeneous num den (sum * num + c * scale) (scale * den) l end.
Fixpoint value_from (m : Z) (next_scale : Z -> Z) (sum scale : Z) (residues : list Z) : Z :=
  match residues with
  | [] => sum
  | r :: l => value_from m next_scale (add (multiply sum m) (multiply r scale)) (next_scale scale) l
  end.
Definition value_modulo (n e : Z) (coefficients : list Z) : Z :=
  let two := power (add one one) (Z.abs e) in let m := to_form (n mod p) in
  value_from (if 0 <=? e then multiply m two else m) (fun scale => if e <? 0 then multiply scale two else scale) 0 one
    (map (fun c => c mod p) coefficients).

Theorem value_modulo_right n e coefficients : value_modulo n e coefficients <> 0 ->
  homogeneous (if 0 <=? e then n * 2 ^ e else n) (if 0 <=? e then 1 else 2 ^ (- e)) 0 1 coefficients <> 0.
Proof.
  generalize p_range. intros PR N V. apply N. clear N.
  set (num := if 0 <=? e then n * 2 ^ e else n) in *. set (den := if 0 <=? e then 1 else 2 ^ (- e)) in *.
  destruct constants_right as (O & _).
  assert (Mod : forall c, residue_of (c mod p) c).
  { intros c. split; [apply Z.mod_pos_bound; lia |]. exists (- (c / p)). pose proof (Z.div_mod c p ltac:(lia)). lia. }
  assert (Two : form (power (add one one) (Z.abs e)) (2 ^ Z.abs e)) by (apply power_right; [lia | now apply (field_add one 1 one 1)]).
  assert (Same : forall a x y, form a x -> (p | x - y) -> form a y).
  { intros a x y [A [q Q]] [r R]. split; [easy |]. exists (q + r * B). replace (a - y * B) with (a - x * B + (x - y) * B) by ring. rewrite Q, R. ring. }
  assert (M0 : form (to_form (n mod p)) n).
  { destruct (Mod n) as (A & D). apply Same with (n mod p); [exact (proj1 (field_forms _ 0) A) | exact D]. }
  assert (G : forall l m next_scale, form m num -> (forall s k, form s k -> form (next_scale s) (k * den)) ->
    forall sum z scale k, residue_of sum z -> form scale k ->
    residue_of (value_from m next_scale sum scale (map (fun c => c mod p) l)) (homogeneous num den z k l)).
  { intros l m next_scale M Next. induction l as [| c l IH]; intros sum z scale k S K; [exact S |]. cbn [map value_from homogeneous].
    apply IH; [| now apply Next]. apply plain_add; apply plain_multiply; auto. }
  assert (R : residue_of (value_modulo n e coefficients) (homogeneous num den 0 1 coefficients)).
  { apply G; [| | split; [lia | apply Z.divide_0_r] | exact O].
    - unfold num. destruct (Z.leb_spec 0 e); [| exact M0].
      replace (2 ^ e) with (2 ^ Z.abs e) by (f_equal; lia). now apply field_multiply.
    - intros s k F. unfold den. destruct (Z.leb_spec 0 e), (Z.ltb_spec e 0); try lia; [now rewrite Z.mul_1_r |].
      replace (2 ^ (- e)) with (2 ^ Z.abs e) by (f_equal; lia). now apply field_multiply. }
  rewrite V in R. destruct R as [R [q Q]]. rewrite Z.sub_0_r in Q.
  assert (q = 0) as -> by (clear - R Q PR; nia). lia.
Qed.

End Field.
