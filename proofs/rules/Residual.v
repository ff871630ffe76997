(** Bound rule `residual` (include/errbound/rules/residual.hpp), as the C++ code computes it, to nearest, ties to
    even, from 3 bits on, with u a number (emin <= -p). A number x has a value v, correction c and remainder r, |v +
    c - x| <= r. `covered k h exact computed` counts the rule's own roundings: exact <= computed (1 + u)^k + h. h is
    negative if the code has added numbers eta that are unused so far. Sums do not underflow: `summed k exact
    computed`. `inflated` covers eight roundings and its own. Results:
        residual_exact_sound, residual_within_sound, residual_negate_sound, residual_add_sound,
        residual_subtract_sound, residual_scale_sound   the bound that the code returns holds
        residual_displacement_sound   a number that is 0, by any value and `displacement`
        residual_error_sound   the returned error is a bound
        residual_sign_sound    the sign is right or uncertain *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format ErrorFree.
From Errbound Require Code Upper.
Open Scope R_scope.

Section Residual.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.

Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation u := (u p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).

(** The code, in its order of evaluation. *)
Definition inflated (bound : R) : R := fl (bound * fl (1 + fl (8 * eps))).
Definition half_ulp (v : R) : R := fl (fl (Rabs v * u) + eta).
Definition roundings (x y first second : R) : R :=
  fl (fl (fl (fl (Rabs x + Rabs y) + fl (Rabs first + Rabs second)) * u) + fl (4 * eta)).

Definition residual_error (c r : R) : R :=
  if Req_bool r 0 then Rabs c else inflated (fl (Rabs c + r)).
Definition residual_sign (v c r : R) : Code.sign_type :=
  let corrected := fl (v + c) in
  if Req_bool corrected 0 && Req_bool r 0 then Code.zero
  else if negb (Rlt_bool (inflated r) (Rabs corrected)) then Code.uncertain
  else if Rlt_bool 0 corrected then Code.positive else Code.negative.
Definition residual_exact (v : R) : R * R := (0, fl (v - v)).
(** For error >= 0. *)
Definition residual_within (v error : R) : R * R := (0, fl (error + fl (v - v))).
Definition residual_add (v a ca ra b cb rb : R) : R * R :=
  let own := snd (two_sum p emin a b) in
  let inherited := two_sum p emin ca cb in
  let correction := two_sum p emin own (fst inherited) in
  let lost := fl (Rabs (snd inherited) + Rabs (snd correction)) in
  (fst correction,
   fl (Upper.sum_of_bounds p emin nearest (inflated (fl (fl (ra + rb) + lost))) (inflated lost) ra rb +
       fl (v - v))).
Definition residual_scale (v a ca ra : R) (e : Z) : R * R :=
  let c := fl (ca * bpow radix2 e) in
  let r := fl (ra * bpow radix2 e) in
  let lossless := (0 <=? e)%Z ||
    (Req_bool (fl (v * bpow radix2 (- e))) a && Req_bool (fl (c * bpow radix2 (- e))) ca &&
     Req_bool (fl (r * bpow radix2 (- e))) ra) in
  (c, if lossless then fl (r + fl (v - v)) else inflated (fl (r + fl (2 * eta)))).
Definition is_exact (c r : R) : bool := Req_bool c 0 && Req_bool r 0.
Definition is_zero (v c r : R) : bool := Req_bool v 0 && is_exact c r.

(** The meaning of v, c and r for x. *)
Definition holds (v c r x : R) : Prop :=
  number v /\ number c /\ number r /\ Rabs (v + c - x) <= r.

Lemma holds_nonnegative v c r x : holds v c r x -> 0 <= r.
Proof. intros (_ & _ & _ & H). generalize (Rabs_pos (v + c - x)). lra. Qed.
Lemma holds_exact v c r x : holds v c r x -> is_exact c r = true -> x = v.
Proof.
  intros (_ & _ & _ & H) E. apply andb_prop in E. destruct E as [E1 E2]. revert E1 E2.
  do 2 (case Req_bool_spec; [| discriminate]). intros -> -> _ _.
  apply Rabs_le_inv in H. lra.
Qed.

Context (p_3 : (3 <= p)%Z) (emin_p : (emin <= - p)%Z).

Let an_error := rounding_error_nearest p emin ltac:(lia).
Let rnd_exact := Format.rnd_exact p emin nearest.
Let rnd_number := Format.rnd_number p emin nearest.
Let rnd_above := Format.rnd_above p emin nearest.
Let rnd_nonnegative := Format.rnd_nonnegative p emin nearest.
Let sum_subnormal := Format.sum_subnormal p emin nearest.
Let scaled_up := Format.scaled_up p emin nearest.

Lemma u_8 : 0 < u <= / 8.
Proof. generalize (u_positive p) (eps_le p 3 p_3) (eps_2u p). simpl. lra. Qed.

(** One rounding, in units of its result. *)
Lemma rounding_any s : Rabs (fl s - s) <= u * Rabs (fl s) + eta / 2.
Proof.
  generalize u_8 (eta_positive emin) (Rabs_pos (fl s)). intros.
  destruct (Rlt_or_le (Rabs s) smallest_normal) as [S | S].
  - apply Rle_trans with (eta / 2); [now apply (error_absolute _ _ _ _ _ an_error) | nra].
  - generalize (nearest_relative_to_result p emin s S). unfold rnd_nearest. lra.
Qed.
Lemma rounding_sum x y : number x -> number y ->
  Rabs (fl (x + y) - (x + y)) <= u * Rabs (fl (x + y)).
Proof. now apply sum_relative_to_result. Qed.
Lemma sum_lower x y : number x -> number y -> 0 <= x -> 0 <= y -> x + y <= fl (x + y) * (1 + u).
Proof.
  intros X Y PX PY. generalize (rounding_sum x y X Y).
  rewrite (Rabs_pos_eq (fl (x + y))) by (apply rnd_nonnegative; lra). intros H.
  apply Rabs_le_inv in H. lra.
Qed.
Lemma any_lower s : 0 <= s -> s <= fl s * (1 + u) + eta / 2.
Proof.
  intros P. generalize (rounding_any s). rewrite (Rabs_pos_eq (fl s)) by now apply rnd_nonnegative.
  intros H. apply Rabs_le_inv in H. lra.
Qed.

(** The factor covers nine roundings. *)
Lemma power_1 k : 1 <= (1 + u) ^ k.
Proof. apply pow_R1_Rle. generalize u_8. lra. Qed.
Lemma power_le k l : (k <= l)%nat -> (1 + u) ^ k <= (1 + u) ^ l.
Proof. intros. apply Rle_pow; auto. generalize u_8. lra. Qed.
Lemma nine_roundings : (1 + u) ^ 9 <= 1 + 16 * u.
Proof.
  generalize u_8. intros U. assert (U2 : u * u <= u / 8) by nra.
  assert (U3 : u * u * u <= u / 64) by nra.
  assert (S : (1 + u) ^ 2 <= 1 + 17 / 8 * u).
  { replace ((1 + u) ^ 2) with (1 + 2 * u + u * u) by ring. lra. }
  assert (T : (1 + u) ^ 4 <= 1 + 5 * u).
  { replace ((1 + u) ^ 4) with ((1 + u) ^ 2 * (1 + u) ^ 2) by ring.
    apply Rle_trans with ((1 + 17 / 8 * u) * (1 + 17 / 8 * u)).
    - apply Rmult_le_compat; auto; apply pow_le; lra.
    - lra. }
  assert (V : (1 + u) ^ 8 <= (1 + 5 * u) * (1 + 5 * u)).
  { replace ((1 + u) ^ 8) with ((1 + u) ^ 4 * (1 + u) ^ 4) by ring.
    apply Rmult_le_compat; auto; apply pow_le; lra. }
  replace ((1 + u) ^ 9) with ((1 + u) ^ 8 * (1 + u)) by ring.
  apply Rle_trans with ((1 + 5 * u) * (1 + 5 * u) * (1 + u)).
  - apply Rmult_le_compat_r; lra.
  - lra.
Qed.
Lemma inflated_exact x : inflated x = fl (x * (1 + 16 * u)).
Proof.
  unfold inflated. do 2 f_equal. replace (16 * u) with (8 * eps) by (rewrite eps_2u; ring).
  apply (rnd_factor p emin nearest 3); auto; lia.
Qed.
Lemma inflated_number x : number (inflated x).
Proof. apply rnd_number. Qed.
Lemma inflated_above x : number x -> 0 <= x -> x <= inflated x.
Proof. intros X P. rewrite inflated_exact. apply scaled_up; auto. generalize u_8. lra. Qed.

(** The exact number of a computed one. *)
Definition covered (k : nat) (h exact computed : R) : Prop :=
  number computed /\ 0 <= computed /\ exact <= computed * (1 + u) ^ k + h.

Lemma covered_number x : number x -> 0 <= x -> covered 0 0 x x.
Proof. intros. repeat split; auto. simpl. lra. Qed.
(** Numbers eta that the code adds. *)
Lemma covered_nothing x : number x -> 0 <= x -> covered 0 (- x) 0 x.
Proof. intros. repeat split; auto. simpl. lra. Qed.
Lemma covered_weaken k h X l j Y x : covered k h X x -> (k <= l)%nat -> h <= j -> Y <= X ->
  covered l j Y x.
Proof.
  intros (N & P & H) L J D. repeat split; auto. generalize (power_le k l L). intros.
  assert (x * (1 + u) ^ k <= x * (1 + u) ^ l) by (apply Rmult_le_compat_l; auto). lra.
Qed.
Lemma covered_plus k h X x l j Y y : covered k h X x -> covered l j Y y ->
  covered (S (max k l)) (h + j) (X + Y) (fl (x + y)).
Proof.
  intros C D. apply (covered_weaken k h X (max k l) h X) in C; [| lia | lra | lra].
  apply (covered_weaken l j Y (max k l) j Y) in D; [| lia | lra | lra].
  destruct C as (NX & PX & C), D as (NY & PY & D). repeat split.
  - apply rnd_number.
  - apply rnd_nonnegative. lra.
  - generalize (sum_lower x y NX NY PX PY) (power_1 (max k l)). intros S G.
    assert (E : (x + y) * (1 + u) ^ max k l <= fl (x + y) * (1 + u) * (1 + u) ^ max k l).
    { apply Rmult_le_compat_r; lra. }
    rewrite <- tech_pow_Rmult. lra.
Qed.
Lemma covered_times k X x l Y y : covered k 0 X x -> covered l 0 Y y -> 0 <= X -> 0 <= Y ->
  covered (S (k + l)) (eta / 2 * (1 + u) ^ (k + l)) (X * Y) (fl (x * y)).
Proof.
  intros (NX & PX & C) (NY & PY & D) PX' PY'. assert (P : 0 <= x * y) by now apply Rmult_le_pos.
  repeat split.
  - apply rnd_number.
  - now apply rnd_nonnegative.
  - apply Rle_trans with (x * y * (1 + u) ^ (k + l)).
    + rewrite pow_add. replace (x * y * ((1 + u) ^ k * (1 + u) ^ l))
        with (x * (1 + u) ^ k * (y * (1 + u) ^ l)) by ring.
      apply Rmult_le_compat; lra.
    + rewrite <- tech_pow_Rmult. generalize (any_lower _ P) (power_1 (k + l)). intros S G.
      assert (E : x * y * (1 + u) ^ (k + l) <= (fl (x * y) * (1 + u) + eta / 2) * (1 + u) ^ (k + l)).
      { apply Rmult_le_compat_r; lra. }
      lra.
Qed.
Lemma inflated_covers k h X x : covered k h X x -> (k <= 8)%nat -> h <= - (eta / 2) ->
  X <= inflated x.
Proof.
  intros C K H. apply (covered_weaken k h X 8 (- (eta / 2)) X) in C; [| lia | lra | lra].
  destruct C as (N & P & C). rewrite inflated_exact. generalize u_8 nine_roundings. intros U F.
  assert (S : x * (1 + 16 * u) <= fl (x * (1 + 16 * u)) * (1 + u) + eta / 2).
  { apply any_lower. apply Rmult_le_pos; lra. }
  assert (T : x * (1 + u) ^ 8 * (1 + u) <= x * (1 + 16 * u)).
  { replace (x * (1 + u) ^ 8 * (1 + u)) with (x * (1 + u) ^ 9) by ring.
    now apply Rmult_le_compat_l. }
  apply Rmult_le_reg_r with (1 + u); [lra |]. generalize (eta_positive emin). intros.
  apply Rle_trans with ((x * (1 + u) ^ 8 + - (eta / 2)) * (1 + u)).
  - apply Rmult_le_compat_r; lra.
  - assert (0 <= eta / 2 * u) by (apply Rmult_le_pos; lra). lra.
Qed.

(** Sums only. *)
Definition summed (k : nat) (exact computed : R) : Prop :=
  covered k 0 exact computed /\ (computed < smallest_normal -> exact <= computed).

Lemma summed_number x : number x -> 0 <= x -> summed 0 x x.
Proof. intros. split; [now apply covered_number | lra]. Qed.
Lemma summed_plus k X x l Y y : summed k X x -> summed l Y y ->
  summed (S (max k l)) (X + Y) (fl (x + y)).
Proof.
  intros [C SX] [D SY]. split.
  - rewrite <- (Rplus_0_r 0). now apply covered_plus.
  - destruct C as (NX & PX & _), D as (NY & PY & _). intros H.
    rewrite sum_subnormal in * by auto. generalize (SX ltac:(lra)) (SY ltac:(lra)). lra.
Qed.
Lemma inflated_summed k X x : summed k X x -> (k <= 8)%nat -> X <= inflated x.
Proof.
  intros [C S] K. apply (covered_weaken k 0 X 8 0 X) in C; [| lia | lra | lra].
  destruct C as (N & P & C). generalize u_8 nine_roundings (smallest_normal_positive p emin). intros U F M.
  destruct (Rlt_or_le x smallest_normal) as [L | L].
  { apply Rle_trans with (1 := S L). now apply inflated_above. }
  rewrite inflated_exact. assert (A : x <= x * (1 + 16 * u)) by nra.
  assert (B : smallest_normal <= Rabs (x * (1 + 16 * u))) by (rewrite Rabs_pos_eq; lra).
  generalize (nearest_relative_to_result p emin _ B). unfold rnd_nearest.
  rewrite (Rabs_pos_eq (fl _)) by (apply rnd_nonnegative; lra). intros H. apply Rabs_le_inv in H.
  apply Rmult_le_reg_r with (1 + u); [lra |].
  apply Rle_trans with (x * (1 + u) ^ 9).
  - replace (x * (1 + u) ^ 9) with (x * (1 + u) ^ 8 * (1 + u)) by ring. apply Rmult_le_compat_r; lra.
  - apply Rle_trans with (x * (1 + 16 * u)); [now apply Rmult_le_compat_l | lra].
Qed.

Lemma error_above c r : number c -> number r -> 0 <= r -> Rabs c + r <= residual_error c r.
Proof.
  intros C N P. unfold residual_error. case Req_bool_spec; [lra |]. intros _.
  apply inflated_summed with 1%nat; [| lia].
  apply (summed_plus 0 _ _ 0); apply summed_number; auto using number_abs, Rabs_pos.
Qed.
Lemma error_number c r : number c -> number (residual_error c r).
Proof.
  intros C. unfold residual_error. case Req_bool; [now apply number_abs | apply inflated_number].
Qed.

(** At least the error of a result rounded to v. *)
Lemma half_ulp_number v : number (half_ulp v).
Proof. apply rnd_number. Qed.
Lemma half_ulp_nonnegative v : 0 <= half_ulp v.
Proof.
  generalize u_8 (Rabs_pos v) (eta_positive emin). intros. apply rnd_nonnegative.
  apply Rplus_le_le_0_compat; [| lra]. apply rnd_nonnegative, Rmult_le_pos; lra.
Qed.
Lemma half_ulp_above s : Rabs (fl s - s) <= half_ulp (fl s).
Proof.
  generalize u_8 (eta_positive emin). intros U P. unfold half_ulp. set (v := fl s).
  assert (W : 0 <= fl (Rabs v * u)) by (apply rnd_nonnegative, Rmult_le_pos; [apply Rabs_pos | lra]).
  destruct (Rle_or_lt (bpow radix2 (p + emin)) (Rabs v)) as [C | C].
  - apply Rle_trans with (fl (Rabs v * u)); [now apply error_of_large | apply rnd_above; [apply rnd_number | lra]].
  - apply Rle_trans with eta; [| apply rnd_above; [now apply number_eta | lra]].
    generalize (error_of_small p emin s C). fold v. lra.
Qed.

(** An upper bound of the roundings of two products and two sums. *)
Lemma number_4_eta : number (4 * eta).
Proof. exact (number_eta_times p emin 2 ltac:(lia)). Qed.
Lemma roundings_cover X Y a b c d : number a -> number b -> number c -> number d ->
  covered 3 (- (9 / 4 * eta))
    (Rabs (fl X - X) + Rabs (fl Y - Y) + (Rabs (fl (a + b) - (a + b)) + Rabs (fl (c + d) - (c + d))))
    (roundings (fl X) (fl Y) (fl (a + b)) (fl (c + d))).
Proof.
  intros A B C D. generalize u_8 (eta_positive emin). intros U P.
  generalize (rounding_any X) (rounding_any Y) (rounding_sum a b A B) (rounding_sum c d C D).
  unfold roundings. rewrite (rnd_exact (4 * eta)) by apply number_4_eta.
  set (x := fl X). set (y := fl Y). set (f := fl (a + b)). set (s := fl (c + d)).
  assert (N : forall z, covered 0 0 (Rabs (fl z)) (Rabs (fl z))).
  { intros z. apply covered_number; [apply number_abs, rnd_number | apply Rabs_pos]. }
  generalize (covered_plus _ _ _ _ _ _ _ _ (covered_plus _ _ _ _ _ _ _ _ (N X) (N Y))
                (covered_plus _ _ _ _ _ _ _ _ (N (a + b)) (N (c + d)))).
  fold x y f s. cbn [max]. set (t := fl (fl (Rabs x + Rabs y) + fl (Rabs f + Rabs s))).
  set (T := Rabs x + Rabs y + (Rabs f + Rabs s)). intros (Nt & Pt & Ht) HX HY HA HC.
  assert (Tu : covered 2 (eta / 2 * (1 + u) ^ 2) (T * u) (fl (t * u))).
  { repeat split; [apply rnd_number | apply rnd_nonnegative, Rmult_le_pos; lra |].
    generalize (scale_error p emin nearest _ _ an_error t (- p) Nt). change (bpow radix2 (- p)) with u.
    intros E. apply Rabs_le_inv in E.
    apply Rle_trans with (t * u * (1 + u) ^ 2).
    - replace (t * u * (1 + u) ^ 2) with ((t * (1 + u) ^ 2 + (0 + 0 + (0 + 0))) * u) by ring.
      apply Rmult_le_compat_r; lra.
    - rewrite <- Rmult_plus_distr_r. apply Rmult_le_compat_r; [apply pow_le |]; lra. }
  generalize (covered_plus _ _ _ _ _ _ _ _ Tu (covered_nothing (4 * eta) number_4_eta ltac:(lra))).
  intros (NG & PG & G). repeat split; auto. cbn [max] in G.
  apply Rle_trans with (T * u + eta); [unfold T; lra |].
  assert ((1 + u) ^ 2 <= 3 / 2) by nra.
  assert (eta / 2 * (1 + u) ^ 2 <= eta / 2 * (3 / 2)) by (apply Rmult_le_compat_l; lra). lra.
Qed.

(** The operations. *)
Lemma nothing v : fl (v - v) = 0.
Proof. replace (v - v) with 0 by ring. apply (Format.rnd_0 p emin nearest). Qed.

Theorem residual_exact_sound v : number v ->
  holds v (fst (residual_exact v)) (snd (residual_exact v)) v.
Proof.
  intros N. unfold residual_exact. cbn [fst snd]. rewrite nothing.
  repeat split; auto using number_0. replace (v + 0 - v) with 0 by ring. rewrite Rabs_R0. lra.
Qed.
Theorem residual_within_sound v error x : number v -> number error -> Rabs (v - x) <= error ->
  holds v (fst (residual_within v error)) (snd (residual_within v error)) x.
Proof.
  intros N E H. unfold residual_within. cbn [fst snd]. rewrite nothing, Rplus_0_r, (rnd_exact _ E).
  repeat split; auto using number_0. now rewrite Rplus_0_r.
Qed.
Theorem residual_negate_sound v c r x : holds v c r x -> holds (- v) (- c) r (- x).
Proof.
  intros (V & C & N & H). repeat split; auto using number_opp.
  replace (- v + - c - - x) with (- (v + c - x)) by ring. now rewrite Rabs_Ropp.
Qed.

(** The errors of the sums that make a correction are all that the code adds to the remainders. *)
Lemma residual_sum_error a ca ra x b cb rb y : holds a ca ra x -> holds b cb rb y ->
  let inherited := two_sum p emin ca cb in
  let correction := two_sum p emin (snd (two_sum p emin a b)) (fst inherited) in
  Rabs (fl (a + b) + fst correction - (x + y)) <= ra + rb + (Rabs (snd inherited) + Rabs (snd correction)).
Proof.
  intros (A & CA & RA & HA) (B & CB & RB & HB). cbv zeta.
  assert (E : forall s t, number s -> number t ->
    number (fst (two_sum p emin s t)) /\ number (snd (two_sum p emin s t)) /\
    fst (two_sum p emin s t) + snd (two_sum p emin s t) = s + t).
  { intros s t S T. split; [apply rnd_number |]. split; [apply rnd_number |].
    apply two_sum_exact; auto; lia. }
  destruct (E a b A B) as (_ & NO & EO). change (fst (two_sum p emin a b)) with (fl (a + b)) in EO.
  set (v := fl (a + b)) in *. set (own := snd (two_sum p emin a b)) in *.
  destruct (E ca cb CA CB) as (NI & NF & EI). set (inherited := two_sum p emin ca cb) in *.
  destruct (E own (fst inherited) NO NI) as (NC & NG & EC).
  set (correction := two_sum p emin own (fst inherited)) in *.
  replace (v + fst correction - (x + y))
    with ((a + ca - x) + (b + cb - y) + (- snd inherited + - snd correction)) by lra.
  apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat.
  - apply Rle_trans with (1 := Rabs_triang _ _). lra.
  - apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_Ropp. lra.
Qed.
(** Both bounds in the code of a sum of remainders ra and rb and errors e and f. *)
Lemma inflated_remainders ra rb e f : number ra -> number rb -> number e -> number f ->
  0 <= ra -> 0 <= rb -> 0 <= e -> 0 <= f -> ra + rb + (e + f) <= inflated (fl (fl (ra + rb) + fl (e + f))).
Proof.
  intros. apply inflated_summed with 2%nat; [| lia].
  apply (summed_plus 1 _ _ 1); apply (summed_plus 0 _ _ 0); apply summed_number; auto.
Qed.
Lemma inflated_losses e f : number e -> number f -> 0 <= e -> 0 <= f -> e + f <= inflated (fl (e + f)).
Proof. intros. apply inflated_summed with 1%nat; [| lia]. apply (summed_plus 0 _ _ 0); now apply summed_number. Qed.
Theorem residual_add_sound a ca ra x b cb rb y : holds a ca ra x -> holds b cb rb y ->
  let bound := residual_add (fl (a + b)) a ca ra b cb rb in
  holds (fl (a + b)) (fst bound) (snd bound) (x + y).
Proof.
  intros KA KB. generalize (holds_nonnegative _ _ _ _ KA) (holds_nonnegative _ _ _ _ KB). intros PA PB.
  assert (H := residual_sum_error _ _ _ _ _ _ _ _ KA KB). cbv zeta in H.
  destruct KA as (_ & _ & RA & _), KB as (_ & _ & RB & _).
  unfold residual_add. cbv zeta. cbn [fst snd]. rewrite nothing, Rplus_0_r.
  set (e := Rabs (snd (two_sum p emin ca cb))) in *.
  set (correction := two_sum p emin (snd (two_sum p emin a b)) (fst (two_sum p emin ca cb))) in *.
  set (f := Rabs (snd correction)) in *.
  assert (NE : number e) by (apply number_abs, rnd_number).
  assert (NF : number f) by (apply number_abs, rnd_number).
  assert (PE : 0 <= e) by apply Rabs_pos. assert (PF : 0 <= f) by apply Rabs_pos.
  generalize (inflated_losses e f NE NF PE PF). intros L.
  repeat split; try apply rnd_number.
  match goal with |- _ <= fl ?bound =>
    replace (fl bound) with bound
      by (symmetry; apply rnd_exact, Upper.sum_of_bounds_number, inflated_number; auto with typeclass_instances)
  end.
  apply Upper.sum_of_bounds_sound; auto using inflated_number with typeclass_instances; try lia; try lra.
  apply Rle_trans with (1 := H). now apply inflated_remainders.
Qed.
(** A number with value d that is known to be 0. *)
Theorem residual_displacement_sound d : number d -> holds d (- d) 0 0.
Proof.
  intros N. repeat split; auto using number_opp, number_0. replace (d + - d - 0) with 0 by ring.
  rewrite Rabs_R0. lra.
Qed.
Theorem residual_subtract_sound a ca ra x b cb rb y : holds a ca ra x -> holds b cb rb y ->
  let bound := residual_add (fl (a - b)) a ca ra (- b) (- cb) rb in
  holds (fl (a - b)) (fst bound) (snd bound) (x - y).
Proof. intros KA KB. apply residual_add_sound; auto using residual_negate_sound. Qed.

Theorem residual_scale_sound a ca ra x e : holds a ca ra x ->
  let v := fl (a * bpow radix2 e) in
  let bound := residual_scale v a ca ra e in
  holds v (fst bound) (snd bound) (x * bpow radix2 e).
Proof.
  intros K. generalize (holds_nonnegative _ _ _ _ K). intros PA. destruct K as (A & C & N & H).
  unfold residual_scale. cbv zeta. cbn [fst snd]. rewrite nothing, Rplus_0_r, (rnd_exact _ (rnd_number _)).
  set (v := fl (a * bpow radix2 e)). set (c := fl (ca * bpow radix2 e)). set (r := fl (ra * bpow radix2 e)).
  generalize (bpow_ge_0 radix2 e). intros PB.
  assert (D : Rabs (a * bpow radix2 e + ca * bpow radix2 e - x * bpow radix2 e) <= ra * bpow radix2 e).
  { replace (a * bpow radix2 e + ca * bpow radix2 e - x * bpow radix2 e)
      with ((a + ca - x) * bpow radix2 e) by ring.
    rewrite Rabs_mult, (Rabs_pos_eq (bpow _ _)) by auto. now apply Rmult_le_compat_r. }
  assert (Nv : number v) by apply rnd_number. assert (Nc : number c) by apply rnd_number.
  assert (Nr : number r) by apply rnd_number.
  repeat split; auto.
  { case orb; [exact Nr | apply inflated_number]. }
  destruct (Z.leb_spec 0 e) as [P | P]; cbn [orb].
  { unfold v, c, r. now rewrite !(scale_up p emin nearest). }
  assert (L : Rabs (v + c - x * bpow radix2 e) <= inflated (fl (r + fl (2 * eta)))).
  { assert (N2 : number (2 * eta)).
    { replace (2 * eta) with (bpow radix2 (1 + emin)); [apply number_power; auto; lia |].
      now rewrite bpow_plus. }
    generalize (eta_positive emin). intros. rewrite (rnd_exact _ N2). apply Rle_trans with (r + 2 * eta).
    - generalize (scale_error p emin nearest _ _ an_error a e A)
        (scale_error p emin nearest _ _ an_error ca e C) (scale_error p emin nearest _ _ an_error ra e N).
      fold v c r. intros DA DC DR. apply Rabs_le_inv in DA, DC, DR, D. apply Rabs_le. lra.
    - apply inflated_summed with 1%nat; [| lia].
      apply (summed_plus 0 _ _ 0); apply summed_number; auto; [| lra].
      apply rnd_nonnegative. now apply Rmult_le_pos. }
  destruct (Req_bool_spec (fl (v * bpow radix2 (- e))) a) as [B1 | B1]; auto.
  destruct (Req_bool_spec (fl (c * bpow radix2 (- e))) ca) as [B2 | B2]; auto.
  destruct (Req_bool_spec (fl (r * bpow radix2 (- e))) ra) as [B3 | B3]; auto.
  cbn [andb]. apply (scale_back p emin nearest) in B1, B2, B3; auto. now rewrite B1, B2, B3.
Qed.

Theorem residual_error_sound v c r x : holds v c r x -> Rabs (v - x) <= residual_error c r.
Proof.
  intros K. generalize (holds_nonnegative _ _ _ _ K). intros P. destruct K as (V & C & N & H).
  apply Rle_trans with (2 := error_above c r C N P).
  replace (v - x) with (- c + (v + c - x)) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
  rewrite Rabs_Ropp. lra.
Qed.

(** If the corrected value exceeds the inflated remainder, so did the exact sum. *)
Lemma corrected_above v c r : number v -> number c -> number r -> 0 <= r ->
  inflated r < Rabs (fl (v + c)) -> r < Rabs (v + c).
Proof.
  intros V C N P H. generalize u_8 (inflated_above r N P) (smallest_normal_positive p emin). intros U A M.
  destruct (Rlt_or_le (Rabs (v + c)) smallest_normal) as [S | S].
  { rewrite (sum_exact_below p emin nearest) in H by auto. lra. }
  destruct (Rlt_or_le r smallest_normal) as [L | L]; [lra |].
  assert (T : r * (1 + 16 * u) <= inflated r * (1 + u)).
  { rewrite inflated_exact. assert (0 <= 16 * u * r) by (apply Rmult_le_pos; lra).
    assert (B : smallest_normal <= Rabs (r * (1 + 16 * u))) by (rewrite Rabs_pos_eq; lra).
    generalize (nearest_relative_to_result p emin _ B). unfold rnd_nearest.
    rewrite (Rabs_pos_eq (fl _)) by (apply rnd_nonnegative; lra). intros E. apply Rabs_le_inv in E. lra. }
  assert (W : Rabs (fl (v + c)) * (1 - u) <= Rabs (v + c)).
  { generalize (rounding_sum v c V C) (Rabs_triang_inv (fl (v + c)) (v + c)). lra. }
  apply Rlt_le_trans with (2 := W). apply Rmult_lt_reg_r with (1 + u); [lra |].
  apply Rlt_le_trans with (Rabs (fl (v + c)) * (1 + u) * (1 - u)); [| right; ring].
  apply Rle_lt_trans with (inflated r * (1 + u) * (1 - u)).
  - apply Rle_trans with (r * (1 + 16 * u) * (1 - u)); [| apply Rmult_le_compat_r; lra].
    rewrite Rmult_assoc. apply Rmult_le_compat_l; auto. assert (u * u <= u / 8) by nra. lra.
  - apply Rmult_lt_compat_r; [lra |]. apply Rmult_lt_compat_r; lra.
Qed.
Theorem residual_sign_sound v c r x : holds v c r x ->
  match residual_sign v c r with
  | Code.negative => x < 0
  | Code.zero => x = 0
  | Code.positive => 0 < x
  | Code.uncertain => True
  end.
Proof.
  intros K. generalize (holds_nonnegative _ _ _ _ K). intros P. destruct K as (V & C & N & H).
  unfold residual_sign. cbv zeta. apply Rabs_le_inv in H.
  destruct (Req_bool (fl (v + c)) 0 && Req_bool r 0) eqn:Z.
  { apply andb_prop in Z. destruct Z as [Z1 Z2]. revert Z1 Z2.
    do 2 (case Req_bool_spec; [| discriminate]). intros R0 Z _ _.
    generalize (rounding_sum v c V C). rewrite Z, Rabs_R0, Rmult_0_r. intros E. apply Rabs_le_inv in E. lra. }
  destruct (Rlt_bool_spec (inflated r) (Rabs (fl (v + c)))) as [L | L]; cbn [negb]; auto.
  generalize (corrected_above v c r V C N P L) (inflated_above r N P). intros A I.
  case Rlt_bool_spec; intros S.
  - assert (0 < v + c); [| rewrite Rabs_pos_eq in A; lra].
    apply Rnot_le_lt. intros D. apply (rnd_below p emin nearest _ 0) in D; [lra | apply number_0].
  - rewrite (Rabs_left1 (fl _)) in L by auto.
    assert (v + c < 0); [| rewrite Rabs_left in A; lra].
    apply Rnot_le_lt. intros D. apply rnd_nonnegative in D. lra.
Qed.

End Residual.
