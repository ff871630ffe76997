(** The code and the proofs that the rules `tight` and `sharp` share (include/errbound/rules/tight.hpp, sharp.hpp).
    Their constants and theorems are in Tight.v and Sharp.v.

    A number x has a value a and a bound sa, |a - x| <= sa. A rule has these parts, and `rule` lists their properties:
        rounding          a term for the rounding error of an operation, from the result v
        inflated          the bound times a factor f that covers the bound's own roundings
        underflow, lost   multiples of eta for underflows: in the bound, and in the numerator of a quotient's bound
        early             true if these are added before the last term of a sum
    A bound is the rounding term and the error inherited from the operands, inflated. r and h are the largest errors of a
    rounding, relative and of small numbers (`rounding_error` in Format.v); a rounding leaves at least the share q of a
    normal number. Results: add_sound, multiply_sound, divide_sound, scale_sound *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format.
From Errbound Require Upper.
Open Scope R_scope.

(** The errors of exact products and quotients. *)
Lemma product_inherits a x sa b y sb :
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> Rabs (a * b - x * y) <= Rabs a * sb + sa * (Rabs b + sb).
Proof.
  intros HA HB. replace (a * b - x * y) with (a * (b - y) + (a - x) * y) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult. apply Rplus_le_compat.
  - apply Rmult_le_compat_l; auto. apply Rabs_pos.
  - apply Rmult_le_compat; auto using Rabs_pos. generalize (Rabs_triang_inv y b). rewrite (Rabs_minus_sym y). lra.
Qed.
(** The error that an exact quotient inherits. *)
Lemma quotient_inherits a x sa b y sb :
  Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> 0 < Rabs b - sb ->
  Rabs (a / b - x / y) <= (sa + Rabs (a / b) * sb) / (Rabs b - sb).
Proof.
  intros HA HB D. assert (PB := within_positive _ _ _ HB).
  assert (Y : Rabs b - sb <= Rabs y) by (generalize (Rabs_triang_inv b y); lra).
  assert (B0 : b <> 0) by (intros ->; rewrite Rabs_R0 in D; lra).
  assert (Y0 : y <> 0) by (intros ->; rewrite Rabs_R0 in Y; lra).
  replace (a / b - x / y) with (((a - x) + a / b * (y - b)) * / y) by (field; auto).
  rewrite Rabs_mult, Rabs_inv. apply Rmult_le_compat.
  - apply Rabs_pos.
  - apply Rlt_le, Rinv_0_lt_compat, Rabs_pos_lt; auto.
  - apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_mult, (Rabs_minus_sym y b).
    apply Rplus_le_compat; auto. apply Rmult_le_compat_l; auto. apply Rabs_pos.
  - apply Rinv_le; auto.
Qed.

(** An exact zero. *)
Definition is_zero (a sa : R) : bool := Req_bool a 0 && Req_bool sa 0.
Lemma is_zero_true a sa : is_zero a sa = true -> a = 0 /\ sa = 0.
Proof. intros H. apply andb_prop in H. destruct H as [A S]. revert A S. now repeat case Req_bool_spec. Qed.
Lemma zero_within a x sa : Rabs (a - x) <= sa -> is_zero a sa = true -> a = 0 /\ x = 0.
Proof. intros H Z. apply is_zero_true in Z. destruct Z as [-> ->]. apply within_0 in H. auto. Qed.
Lemma product_with_zero a x sa b y sb : Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  is_zero a sa || is_zero b sb = true -> a * b = 0 /\ x * y = 0.
Proof.
  intros HA HB Z. apply orb_prop in Z.
  destruct Z as [Z | Z]; eapply zero_within in Z; eauto; destruct Z as [-> ->]; lra.
Qed.

(** The code, in its order of evaluation. *)
Section Code.

Context (p emin : Z) (direction : R -> Z) (rounding inflated : R -> R) (early : bool) (underflow lost : R).
Notation fl := (rnd p emin direction).

Definition total (own inherited : R) : R :=
  if early then fl (fl (own + underflow) + inherited) else fl (fl (own + inherited) + underflow).
Definition numerator (sa product more : R) : R :=
  if early then fl (sa + fl (product + more)) else fl (fl (sa + product) + more).
Definition multiply (v a sa b sb : R) : R :=
  if is_zero a sa || is_zero b sb then rounding v
  else
    let inherited := fl (fl (Rabs a * sb) + fl (sa * fl (Rabs b + sb))) in
    inflated (total (rounding v) inherited).
(** None: the result is unknown (the bound is infinite). *)
Definition divide (v a sa b sb : R) : option R :=
  let distance := fl (Rabs b - sb) in
  if negb (Rlt_bool 0 distance) then None
  else if is_zero a sa then Some (rounding v)
  else
    let quotient := inflated (fl (Rabs v + eta emin)) in
    let more := if Rlt_bool 0 sb then lost else 0 in
    let inherited := fl (numerator sa (fl (quotient * sb)) more / distance) in
    Some (inflated (total (rounding v) (inflated inherited))).

End Code.

(** The share that the sums of `total` leave of the inherited error. *)
Definition last (early : bool) (q : R) : R := if early then q else q * q.

Section Rule.

Context {p emin : Z} {p_positive : Prec_gt_0 p} {direction : R -> Z} {direction_valid : Valid_rnd direction}.
Context {rounding inflated : R -> R} {early : bool} {underflow lost : R}.

Notation fl := (rnd p emin direction).
Notation number := (number p emin).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).

(** The properties of a rule's parts. *)
Record rule {r h q f : R} : Prop := {
  error : rounding_error p emin direction r h;
  share : 0 < q <= 1;
  share_error : q * (1 + r) <= 1;
  (* a rounding leaves at least the share q of a normal number *)
  share_left : forall x, smallest_normal <= Rabs x -> Rabs x * q <= Rabs (fl x);
  (* the rounding term is at least the error of its operation *)
  rounding_number : forall v, number (rounding v);
  rounding_nonnegative : forall v, 0 <= rounding v;
  rounding_0 : rounding (fl 0) = 0;
  rounding_sum : forall x y, number x -> number y -> Rabs (fl (x + y) - (x + y)) <= rounding (fl (x + y));
  rounding_any : forall s, Rabs (fl s - s) <= rounding (fl s) + h;
  (* the factor f covers six roundings, or five if the underflows are added early *)
  factor : forall x, inflated x = fl (x * f);
  factor_1 : 1 <= f;
  factor_roundings : 1 <= f * (q * q * q * last early q * q);
  (* underflows: of a product and of the products in its bound, of a quotient and of its bound, and in its numerator *)
  underflow_number : number underflow;
  underflow_2 : 2 * eta <= underflow;
  (* |b| + sb may be rounded, which takes up to 1 - q of a number below smallest_normal *)
  underflow_products : (smallest_normal - eta) * (1 - q) <= (underflow - 3 * h) * q;
  underflow_quotients : h * (2 + f) <= underflow;
  lost_number : number lost;
  lost_product : h <= lost
}.
Context {r h q f : R} (B : @rule r h q f).

Let E := error B.
Let q_1 := share B.
Let h_eta := error_h _ _ _ _ _ E.
Let rnd_number := Format.rnd_number p emin direction.
Let rnd_above := Format.rnd_above p emin direction.
Let rnd_nonnegative := Format.rnd_nonnegative p emin direction.
Let rnd_0 := Format.rnd_0 p emin direction.
Let sum_subnormal := Format.sum_subnormal p emin direction.

(** Numbers and sums after a rounding. *)
Lemma normal_left x : smallest_normal <= x -> x * q <= fl x.
Proof.
  intros C. generalize (smallest_normal_positive p emin) (share_left B x). intros P.
  rewrite (Rabs_pos_eq x), (Rabs_pos_eq (fl x)) by (try apply rnd_nonnegative; lra). auto.
Qed.
Lemma small_left x : 0 <= x -> x < smallest_normal -> x - h <= fl x.
Proof. intros P C. now apply (rnd_absolute p emin direction r h E). Qed.
Let any_left := Format.any_left p emin direction q h q_1 (proj1 h_eta) normal_left small_left.
Let product_left := Format.product_left p emin direction q h q_1 (proj1 h_eta) normal_left small_left.
Definition sum_left := Format.sum_left p emin direction q q_1 normal_left.
Let scaled_left := Format.scaled_left p emin direction q normal_left.
Let scaled_covers := Format.scaled_covers p emin direction q q_1 normal_left.

(** Sums of three terms. *)
Lemma sum_of_three x y z : number x -> number y -> number z -> 0 <= x -> 0 <= y -> 0 <= z ->
  let s := fl (fl (x + y) + z) in
  number s /\ y <= s /\ z <= s /\ (x + y) * (q * q) + z * q <= s /\ (s < smallest_normal -> s = x + y + z).
Proof.
  intros X Y Z PX PY PZ s. assert (P : y <= fl (x + y)) by (apply rnd_above; auto; lra).
  assert (N : fl (x + y) <= s) by (apply rnd_above; [apply rnd_number | lra]).
  split; [apply rnd_number |]. split; [lra |]. split; [apply rnd_above; auto; lra |]. split.
  - generalize (sum_left x y X Y ltac:(lra)) (sum_left (fl (x + y)) z (rnd_number _) Z ltac:(lra)). fold s. intros A D.
    apply (Rmult_le_compat_r q) in A; lra.
  - intros C. unfold s. rewrite (sum_subnormal _ z), (sum_subnormal x y); auto using rnd_number; lra.
Qed.
Lemma three_covered x y z g : 1 <= g -> 1 <= g * (q * q * q) -> number x -> number y -> number z ->
  0 <= x -> 0 <= y -> 0 <= z -> x + y + z <= fl (fl (fl (x + y) + z) * g).
Proof.
  intros. destruct (sum_of_three x y z) as (N & P & _ & L & S); auto.
  assert (z * (q * q) <= z * q) by (apply Rmult_le_compat_l; nra).
  apply scaled_covers with (q * q); auto; lra.
Qed.

(** The factor covers fewer roundings, too. *)
Lemma last_q : q * q <= last early q <= q.
Proof. unfold last. destruct early; nra. Qed.
Lemma factor_5 : 1 <= f * (q * q * q * q * q).
Proof.
  apply Rle_trans with (1 := factor_roundings B). generalize (factor_1 B) last_q. intros F L.
  apply Rmult_le_compat_l; [lra |]. apply Rmult_le_compat_r; [lra |]. apply Rmult_le_compat_l; [| lra].
  repeat apply Rmult_le_pos; lra.
Qed.
Lemma factor_4 : 1 <= f * (q * q * q * q).
Proof. generalize (factor_1 B). intros. apply (fewer_roundings f q); [lra | apply q_1 | exact factor_5]. Qed.
Lemma factor_3 : 1 <= f * (q * q * q).
Proof. generalize (factor_1 B). intros. apply (fewer_roundings f q); [lra | apply q_1 | exact factor_4]. Qed.

(** Addition: the error of a sum, and its bounds. *)
Lemma sum_error_at_most a x sa b y sb : number a -> number b -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a + b) - (x + y)) <= rounding (fl (a + b)) + (sa + sb).
Proof. intros. apply within_through with (a + b); [now apply (rounding_sum B) | now apply within_sum]. Qed.
Lemma enlarged_sound g v sa sb : 1 <= g -> 1 <= g * (q * q * q) -> number sa -> number sb -> 0 <= sa -> 0 <= sb ->
  rounding v + (sa + sb) <= fl (fl (rounding v + fl (sa + sb)) * g).
Proof.
  intros. rewrite (Rplus_comm _ (fl _)), (Rplus_comm (rounding v)).
  apply three_covered; auto using (rounding_number B), (rounding_nonnegative B).
Qed.
Lemma add_sound enlarged a x sa b y sb : (2 <= p)%Z -> (emin <= - p)%Z ->
  number a -> number b -> number sa -> number sb -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  rounding (fl (a + b)) + (sa + sb) <= enlarged ->
  Rabs (fl (a + b) - (x + y)) <= Upper.sum_of_bounds p emin direction enlarged (rounding (fl (a + b))) sa sb.
Proof.
  intros P L A D SA SB HA HB H. assert (K := sum_error_at_most a x sa b y sb A D HA HB).
  apply Upper.sum_of_bounds_sound; auto; eauto using within_positive, (rounding_number B), (rounding_nonnegative B).
  lra.
Qed.

(** The sum of an operation's rounding term and the inherited error. *)
Lemma total_left own inherited : number own -> number inherited -> 0 <= own -> 0 <= inherited ->
  let s := total p emin direction early underflow own inherited in
  number s /\ inherited <= s /\ (own + underflow) * (q * q) + inherited * last early q <= s /\
  (s < smallest_normal -> s = own + inherited + underflow).
Proof.
  intros NO NI PO PI. generalize (underflow_number B) (underflow_2 B) (eta_positive emin). intros NU U PE.
  unfold total, last. destruct early.
  - destruct (sum_of_three own underflow inherited) as (N & _ & P & L & S); auto; try lra.
    repeat split; auto. intros C. rewrite (S C). ring.
  - destruct (sum_of_three own inherited underflow) as (N & P & _ & L & S); auto; try lra.
    repeat split; auto. assert (underflow * (q * q) <= underflow * q) by (apply Rmult_le_compat_l; nra). lra.
Qed.

(** Multiplication: below the smallest normal number, the inherited error loses `underflow` less h. *)
Lemma product_small a sa b sb : number b -> number sb -> 0 <= a -> 0 <= b -> 0 <= sa -> 0 <= sb ->
  let inherited := fl (fl (a * sb) + fl (sa * fl (b + sb))) in
  inherited + 2 * eta < smallest_normal -> a * sb + sa * (b + sb) <= inherited + underflow - h.
Proof.
  intros ND NSb PA PD PSa PSb I C. generalize (eta_positive emin). intros PE.
  destruct (product_left a sa b sb) as (_ & _ & _ & S); auto. fold I in S. destruct S as (w & W & K); [lra |].
  enough (sa * (b + sb) - w <= underflow - 3 * h) by lra. apply Rmult_le_reg_r with q; [lra |].
  apply Rle_trans with (2 := underflow_products B).
  assert (w * (1 - q) <= (smallest_normal - eta) * (1 - q)) by (apply Rmult_le_compat_r; lra). lra.
Qed.
Lemma multiply_sound a x sa b y sb :
  number a -> number b -> number sa -> number sb -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (fl (a * b) - x * y) <= multiply p emin direction rounding inflated early underflow (fl (a * b)) a sa b sb.
Proof.
  intros A D SA SB HA HB. assert (PA := within_positive _ _ _ HA). assert (PB := within_positive _ _ _ HB).
  unfold multiply. cbv zeta. destruct (is_zero a sa || is_zero b sb) eqn:Zero.
  { destruct (product_with_zero a x sa b y sb HA HB Zero) as [-> ->].
    rewrite (rounding_0 B), rnd_0, Rminus_0_r, Rabs_R0. lra. }
  destruct (product_left (Rabs a) sa (Rabs b) sb) as (PX & PI & Large & _); auto using number_abs, Rabs_pos.
  assert (Small := product_small (Rabs a) sa (Rabs b) sb (number_abs _ _ _ D) SB (Rabs_pos a) (Rabs_pos b) PA PB).
  revert PX PI Large Small. cbv zeta. set (I := fl (fl (Rabs a * sb) + fl (sa * fl (Rabs b + sb)))).
  set (X := Rabs a * sb + sa * (Rabs b + sb)). intros PX PI Large Small.
  set (R := rounding (fl (a * b))). assert (PR : 0 <= R) by apply (rounding_nonnegative B).
  apply Rle_trans with (R + h + X).
  { apply within_through with (a * b); [apply (rounding_any B) | now apply product_inherits]. }
  destruct (total_left R I) as (N & L & G & S); auto; [apply (rounding_number B) | apply rnd_number |].
  generalize (underflow_2 B) (underflow_products B) (eta_le_smallest_normal p emin) last_q. intros U2 UP ES Q.
  set (s := total _ _ _ _ _ R I) in *. set (l := last early q) in *. rewrite (factor B).
  (* below the smallest normal number all sums are exact, except |b| + sb; the products lose at most `underflow` *)
  apply scaled_covers with (q * q * q * l); auto using (factor_1 B), (factor_roundings B); try lra.
  assert (U3 : 3 * h <= underflow) by nra.
  assert (Q1 : q * l <= q * q) by nra. assert (Q2 : q * q * q * l <= q * q) by nra.
  apply (Rmult_le_compat_l (R + h)) in Q2; [| lra]. apply (Rmult_le_compat_l (2 * h)) in Q1; [| lra].
  apply (Rmult_le_compat_r l) in Large; [| nra]. apply (Rmult_le_compat_r (q * q)) in U3; [| nra]. lra.
Qed.

(** Division: the code's bound of |a/b|, and the distance of b from zero. *)
Lemma quotient_covered s : Rabs s <= inflated (fl (Rabs (fl s) + eta)).
Proof.
  generalize (eta_positive emin) (Rabs_pos s) (Rabs_pos (fl s)). intros.
  assert (N : number (Rabs (fl s))) by (apply number_abs, rnd_number). rewrite (factor B).
  assert (V : Rabs (fl s) <= fl (Rabs (fl s) + eta)) by (apply rnd_above; auto; lra).
  apply scaled_covers with (q * q); auto using (factor_1 B), factor_3; try lra.
  - apply Rle_trans with ((Rabs (fl s) + eta) * q); [| apply sum_left; auto using number_eta; lra].
    rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [lra |].
    destruct (Rlt_or_le (Rabs s) smallest_normal) as [S | S]; [| generalize (share_left B s S); lra].
    generalize (error_absolute _ _ _ _ _ E s S) (Rabs_triang_inv s (fl s)). rewrite (Rabs_minus_sym s). nra.
  - intros C. rewrite sum_subnormal; auto using number_eta; try lra.
    assert (S : Rabs s < smallest_normal).
    { apply Rnot_le_lt. intros S. apply (rnd_abs_above p emin direction) in S; auto using number_smallest_normal. lra. }
    generalize (error_absolute _ _ _ _ _ E s S) (Rabs_triang_inv s (fl s)). rewrite (Rabs_minus_sym s). lra.
Qed.
Lemma distance_left b sb : number b -> number sb -> 0 < fl (Rabs b - sb) ->
  0 < Rabs b - sb /\ fl (Rabs b - sb) * q <= Rabs b - sb.
Proof.
  intros D SB P. assert (PD : 0 < Rabs b - sb).
  { apply Rnot_le_lt. intros C. apply (rnd_below p emin direction _ 0) in C; auto using number_0. lra. }
  split; auto.
  generalize (sum_error p emin direction r h E (Rabs b) (- sb) ltac:(now apply number_abs) ltac:(now apply number_opp)).
  change (Rabs b + - sb) with (Rabs b - sb). rewrite (Rabs_pos_eq (Rabs b - sb)) by lra. intros G.
  apply Rabs_le_inv in G. generalize (share_error B). intros S. set (d := fl (Rabs b - sb)) in *.
  apply Rle_trans with ((Rabs b - sb) * (q * (1 + r))); [| nra].
  replace ((Rabs b - sb) * (q * (1 + r))) with ((Rabs b - sb) * (1 + r) * q) by ring. apply Rmult_le_compat_r; lra.
Qed.
(** The numerator of the inherited error, as computed. *)
Lemma numerator_left sa sb k s : number sa -> number sb -> 0 <= sa -> 0 <= sb -> 0 <= s <= k ->
  (sa + s * sb) * (q * q * q) <=
    numerator p emin direction early sa (fl (k * sb)) (if Rlt_bool 0 sb then lost else 0).
Proof.
  intros SA SB PA PB S. set (more := if Rlt_bool 0 sb then lost else 0).
  generalize (lost_number B) (lost_product B). intros.
  assert (K : 0 <= k * sb) by (apply Rmult_le_pos; lra).
  assert (M : number more /\ 0 <= more /\ s * sb * q <= fl (k * sb) + more).
  { unfold more. destruct (Rlt_bool_spec 0 sb) as [C | C].
    - repeat split; auto; [lra |]. assert (s * sb * q <= k * sb * q) by (repeat apply Rmult_le_compat_r; lra).
      generalize (any_left (k * sb) K). lra.
    - replace sb with 0 by lra. rewrite !Rmult_0_r, rnd_0. repeat split; auto using number_0; lra. }
  destruct M as (NM & PM & M). assert (NP : number (fl (k * sb))) by apply rnd_number.
  assert (PP : 0 <= fl (k * sb)) by now apply rnd_nonnegative.
  apply Rle_trans with ((sa + fl (k * sb) + more) * (q * q)).
  { replace ((sa + s * sb) * (q * q * q)) with ((sa * q + s * sb * q) * (q * q)) by ring.
    apply Rmult_le_compat_r; nra. }
  unfold numerator. assert (Q : q * q <= q) by nra. destruct early.
  - rewrite (Rplus_comm sa (fl (_ + more))). destruct (sum_of_three (fl (k * sb)) more sa) as (_ & _ & _ & L & _); auto.
    apply (Rmult_le_compat_l sa) in Q; lra.
  - destruct (sum_of_three sa (fl (k * sb)) more) as (_ & _ & _ & L & _); auto.
    apply (Rmult_le_compat_l more) in Q; lra.
Qed.
(** A quotient w that four roundings made less than Z, rounded and inflated. *)
Lemma quotient_inflated Z w : 0 <= Z -> 0 <= w -> Z * (q * q * q * q) <= w ->
  (fl w < smallest_normal -> Z - h * (1 + f) <= inflated (fl w)) /\
  (smallest_normal <= fl w -> Z * (q * q * q * q) * q * (f * q) <= inflated (fl w)).
Proof.
  intros PZ Pw W. generalize (factor_1 B). intros F. rewrite (factor B). set (I := fl w).
  assert (PI : 0 <= I) by now apply rnd_nonnegative. split; intros C.
  - assert (D1 : w - h <= I) by (apply small_left; auto; now apply (rnd_subnormal p emin direction)).
    generalize (any_left (I * f) ltac:(apply Rmult_le_pos; lra)). intros D2.
    assert (D3 : (Z * (q * q * q * q) - h) * (f * q) <= I * (f * q)) by (apply Rmult_le_compat_r; nra).
    assert (Z * 1 <= Z * (f * (q * q * q * q * q))) by (apply Rmult_le_compat_l; auto using factor_5).
    assert (h * f * q <= h * f * 1) by (apply Rmult_le_compat_l; [apply Rmult_le_pos |]; lra). lra.
  - apply Rle_trans with (2 := scaled_left I f C F). apply Rmult_le_compat_r; [apply Rmult_le_pos; lra |].
    apply Rle_trans with (w * q); [apply Rmult_le_compat_r; lra |].
    destruct (Rlt_or_le w smallest_normal) as [Cw | Cw]; [| now apply normal_left].
    apply Rle_trans with smallest_normal; auto. assert (w * q <= w * 1) by (apply Rmult_le_compat_l; lra). lra.
Qed.
(** The inflated sum of the rounding term and that quotient. *)
Lemma quotient_total own Z w : number own -> 0 <= own -> 0 <= Z -> 0 <= w -> Z * (q * q * q * q) <= w ->
  own + h + Z <= inflated (total p emin direction early underflow own (inflated (fl w))).
Proof.
  intros NO PO PZ Pw W. destruct (quotient_inflated Z w PZ Pw W) as (Below & Above).
  generalize (factor_1 B) factor_3 factor_4 factor_5 last_q (underflow_quotients B). intros F F3 F4 F5 Q U.
  assert (PI : 0 <= fl w) by now apply rnd_nonnegative. assert (Ph : 0 <= h * f) by (apply Rmult_le_pos; lra).
  assert (LJ : fl w <= inflated (fl w)) by (rewrite (factor B); apply scaled_up; auto).
  assert (NJ : number (inflated (fl w))) by (rewrite (factor B); apply rnd_number).
  set (J := inflated (fl w)) in *. destruct (total_left own J) as (N & L & G & S); auto; try lra.
  set (s := total _ _ _ _ _ own J) in *. rewrite (factor B).
  assert (K : (own + J + underflow) * (q * q) <= s).
  { assert (J * (q * q) <= J * last early q) by (apply Rmult_le_compat_l; lra). lra. }
  destruct (Rlt_or_le (fl w) smallest_normal) as [C | C].
  - (* `underflow` covers underflows inside *)
    specialize (Below C). apply Rle_trans with (own + J + underflow); [lra |].
    apply scaled_covers with (q * q); auto; lra.
  - (* eight roundings at most, or nine, and two factors *)
    specialize (Above C). apply Rle_trans with (2 := scaled_left s f ltac:(lra) F).
    assert (Pfq : 0 <= q * q * (f * q)) by (repeat apply Rmult_le_pos; lra).
    apply Rle_trans with ((own + J + underflow) * (q * q) * (f * q));
      [| apply Rmult_le_compat_r; auto; apply Rmult_le_pos; lra].
    apply (Rmult_le_compat_r _ _ _ Pfq) in Above.
    assert ((own + underflow) * 1 <= (own + underflow) * (f * (q * q * q))) by (apply Rmult_le_compat_l; lra).
    assert (1 <= f * (q * q * q * q * q) * (f * (q * q * q * q))) by nra.
    assert (Z * 1 <= Z * (f * (q * q * q * q * q) * (f * (q * q * q * q)))) by (apply Rmult_le_compat_l; lra).
    lra.
Qed.
Lemma divide_sound a x sa b y sb bound :
  number a -> number b -> number sa -> number sb -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  divide p emin direction rounding inflated early underflow lost (fl (a / b)) a sa b sb = Some bound ->
  y <> 0 /\ Rabs (fl (a / b) - x / y) <= bound.
Proof.
  intros A D SA SB HA HB. assert (PA := within_positive _ _ _ HA). assert (PB := within_positive _ _ _ HB).
  unfold divide. cbv zeta. destruct (Rlt_bool_spec 0 (fl (Rabs b - sb))) as [Pd | Pd]; simpl; [| discriminate].
  destruct (distance_left b sb D SB Pd) as (PD & L). set (d := fl (Rabs b - sb)) in *. set (dist := Rabs b - sb) in *.
  assert (Y : y <> 0) by (intros ->; unfold dist in PD; rewrite Rminus_0_r in HB; lra).
  destruct (is_zero a sa) eqn:Zero; intros G; injection G as <-; split; auto.
  { (* an exact zero *)
    destruct (zero_within a x sa HA Zero) as [-> ->]. unfold Rdiv.
    rewrite !Rmult_0_l, (rounding_0 B), rnd_0, Rminus_0_r, Rabs_R0. lra. }
  set (k := inflated (fl (Rabs (fl (a / b)) + eta))). set (n := numerator _ _ _ _ _ _ _).
  set (Z := (sa + Rabs (a / b) * sb) / dist). generalize (Rabs_pos (a / b)). intros PQ.
  assert (PS : 0 <= sa + Rabs (a / b) * sb) by (apply Rplus_le_le_0_compat, Rmult_le_pos; lra).
  assert (Q3 : 0 <= q * q * q) by (repeat apply Rmult_le_pos; lra).
  assert (HN : (sa + Rabs (a / b) * sb) * (q * q * q) <= n)
    by (apply numerator_left; auto; split; [auto | apply quotient_covered]).
  assert (Id : q * / dist <= / d).
  { apply Rmult_le_reg_l with (d * dist); [now apply Rmult_lt_0_compat |].
    replace (d * dist * (q * / dist)) with (d * q) by (field; lra).
    now replace (d * dist * / d) with dist by (field; lra). }
  assert (PI : 0 < / dist) by now apply Rinv_0_lt_compat.
  assert (HI : Z * (q * q * q * q) <= n / d).
  { replace (Z * (q * q * q * q)) with ((sa + Rabs (a / b) * sb) * (q * q * q) * (q * / dist))
      by (unfold Z; field; lra).
    apply Rmult_le_compat; auto; apply Rmult_le_pos; lra. }
  assert (PZ : 0 <= Z) by (apply Rmult_le_pos; lra).
  apply Rle_trans with (rounding (fl (a / b)) + h + Z).
  { apply within_through with (a / b); [apply (rounding_any B) | now apply quotient_inherits]. }
  apply quotient_total; auto using (rounding_number B), (rounding_nonnegative B).
  apply Rle_trans with (2 := HI). apply Rmult_le_pos; [lra | nra].
Qed.

(** Scaling, with `more` for two underflows. *)
Lemma scale_sound more a x sa e : number more -> 2 * h <= more -> number a -> number sa -> Rabs (a - x) <= sa ->
  Rabs (fl (a * bpow radix2 e) - x * bpow radix2 e) <= scaled_error p emin direction
    (fun scaled => inflated (fl (scaled + more))) (fl (a * bpow radix2 e)) a sa e.
Proof.
  intros N M. apply (scaled_error_sound p emin direction r h E). intros s S P. rewrite (factor B).
  assert (L : s <= fl (s + more)) by (apply rnd_above; auto; lra).
  apply scaled_covers with (q * q); auto using (factor_1 B), factor_3; try lra.
  - apply Rle_trans with (2 := sum_left s more S N ltac:(lra)). rewrite <- Rmult_assoc.
    apply Rmult_le_compat_r; [lra |]. nra.
  - intros C. rewrite sum_subnormal; auto; lra.
Qed.

End Rule.
