(** The C++ code, line by line, over any number type, as in Code.v: functions of include/errbound/functions.hpp that
    consist of a rule's operations (midpoint, pow, dot, horner), and those without a rule (lerp, hypot, copysign).
    Also the running bounds of dot products (detail/running_bound.hpp, rules/tight.hpp, rules/sharp.hpp). Nothing is
    proved here. *)

From Coq Require Import ZArith Bool List.
From Errbound Require Import Code.
Import ListNotations.

Section Compound.

Context (T : Type) (A : arithmetic T) (has_fast_fma : bool).

Notation ε := (epsilon T A).
Notation η := (underflow_unit T A).
Notation abs := (abs T A).
Notation is_finite := (is_finite T A).
Open Scope code.

(** detail/running_bound.hpp: the sums over terms that are not closed yet, and the closed sum. *)
Fixpoint most_terms (bits : Z) (m : nat) : nat :=
  match m with
  | O => O
  | S n => if ((bits <? 8) && (2 ^ bits <? Z.of_nat (m + 6) * Z.of_nat (m + 6)))%Z
           then most_terms bits n else m
  end.
Definition terms_at_once (bits : Z) : nat := most_terms bits 8.

Record running := {
  closed : T;
  own : T;
  inherited : T;
  terms : nat;
  uncertain_terms : nat
}.

Section Running_bound.

Context (most : nat) (factor_units : nat -> Z) (underflows : nat -> nat -> Z).

Definition no_terms : running :=
  {| closed := #0; own := #0; inherited := #0; terms := O; uncertain_terms := O |}.
Definition close_terms (s : running) : running :=
  let lost := #(underflows (terms s) (uncertain_terms s)) * η in
  let factor := #1 + #(factor_units (terms s)) * ε in
  {| closed := ((own s + (inherited s + closed s)) + lost) * factor;
     own := #0; inherited := #0; terms := O; uncertain_terms := O |}.
Definition add_term (s : running) (v a sa b sb : T) : running :=
  let exact := (sa == #0) && (sb == #0) in
  let r := {|
    closed := closed s;
    own := own s + v;
    inherited := if exact then inherited s
                 else inherited s + (abs a * sb + sa * (abs b + sb));
    terms := S (terms s);
    uncertain_terms := if exact then uncertain_terms s else S (uncertain_terms s) |} in
  if Nat.eqb (terms r) most then close_terms r else r.
Definition closed_bound (s : running) : T :=
  closed (if Nat.ltb 0 (terms s) then close_terms s else s).

(** A rule's dot_bound with dot_of. `own_of` gets true for the first term that is not zero, the product, and the sum
    before and after. A number is a value and an error. *)
Variable own_of : bool -> T -> T -> T -> T.
Definition dot_step (s : T * bool * running) (pair : (T * T) * (T * T)) : T * bool * running :=
  let '(before, first, bound) := s in
  let '((a, sa), (b, sb)) := pair in
  let product := a * b in
  let sum := before + product in
  if is_zero T A a sa || is_zero T A b sb then (sum, first, bound)
  else (sum, false, add_term bound (own_of first product before sum) a sa b sb).
Definition dot_of (pairs : list ((T * T) * (T * T))) : T * T :=
  let '(sum, _, bound) := fold_left dot_step pairs (#0, true, no_terms) in
  (sum, closed_bound bound + (sum - sum)).

End Running_bound.

(** rules/tight.hpp *)
Definition tight_most : nat := terms_at_once (digits T A - 2).
Definition tight_units (terms : nat) : Z := Z.of_nat (terms + 7).
Definition tight_underflows (terms uncertain : nat) : Z := Z.of_nat (terms + 2 * uncertain + 1).
Definition tight_own (first : bool) (product before sum : T) : T :=
  tight_rounding T A product + (if first then #0 else tight_rounding T A sum).
Definition tight_dot := dot_of tight_most tight_units tight_underflows tight_own.

(** rules/sharp.hpp *)
Definition sharp_most : nat := terms_at_once (digits T A + 1).
Definition sharp_units (terms : nat) : Z := (Z.of_nat (terms + 7) / 2 + 1)%Z.
Definition sharp_underflows (terms uncertain : nat) : Z := Z.of_nat (terms + uncertain + 1).
Definition sharp_own (first : bool) (product before sum : T) : T :=
  let smaller := least T A (abs product) (abs before) in
  sharp_rounding T A product + least T A (sharp_rounding T A sum) smaller.
Definition sharp_dot := dot_of sharp_most sharp_units sharp_underflows sharp_own.

(** The functions of a rule that tracked.hpp uses, in addition to `rule`. Arguments are the result's value, and each
    operand's value and bound. *)
Record operations (B : Type) := {
  the_rule : rule T B;
  rule_add : T -> T -> B -> T -> B -> B;
  rule_multiply : T -> T -> B -> T -> B -> B;
  rule_divide : option (T -> T -> B -> T -> B -> B);
  rule_scale : T -> T -> B -> Z -> B
}.
Definition tight_operations : operations T := {|
  the_rule := tight_rule T A;
  rule_add v _ sa _ sb := tight_add T A v sa sb;
  rule_multiply := tight_multiply T A;
  rule_divide := Some (tight_divide T A);
  rule_scale := tight_scale T A
|}.
Definition sharp_operations : operations T := {|
  the_rule := sharp_rule T A;
  rule_add v _ sa _ sb := sharp_add T A v sa sb;
  rule_multiply := sharp_multiply T A;
  rule_divide := Some (sharp_divide T A);
  rule_scale := sharp_scale T A
|}.
Definition safe_operations : operations (T * Z) := {|
  the_rule := safe_rule T A;
  rule_add _ _ sa _ sb := safe_add T A (fst sa) (snd sa) (fst sb) (snd sb);
  rule_multiply _ a sa b sb := safe_multiply T A a (fst sa) (snd sa) b (fst sb) (snd sb);
  rule_divide := None;
  rule_scale v a sa e := safe_scale T A v a (fst sa) (snd sa) e
|}.
Definition interval_operations : operations (T * T) := {|
  the_rule := interval_rule T A;
  rule_add v _ sa _ sb := interval_add T A v sa sb;
  rule_multiply := interval_multiply T A has_fast_fma;
  rule_divide := Some (interval_divide T A has_fast_fma);
  rule_scale v _ sa e := interval_scale T A v sa e
|}.
Definition residual_operations : operations (T * T) := {|
  the_rule := residual_rule T A;
  rule_add := residual_add T A;
  rule_multiply := residual_multiply T A has_fast_fma;
  rule_divide := Some (residual_divide T A has_fast_fma);
  rule_scale := residual_scale T A
|}.

(** functions.hpp, for tracked numbers: a value and a bound. *)
Section Functions.

Context (B : Type) (R : operations B).
Notation rule := (the_rule B R).
Notation number := (T * B)%type.
Notation exactly := (tracked_exactly T B rule).
Notation within := (tracked_within T B rule).
Notation error_of := (tracked_error T A B rule).
Notation sign := (tracked_sign T B rule).
Notation subtract := (tracked_subtract T A B rule).
Notation negate := (tracked_negate T A B rule).

Definition tracked_add (a b : number) : number :=
  let v := fst a + fst b in (v, rule_add B R v (fst a) (snd a) (fst b) (snd b)).
Definition tracked_multiply (a b : number) : number :=
  let v := fst a * fst b in (v, rule_multiply B R v (fst a) (snd a) (fst b) (snd b)).
Definition tracked_scale (a : number) (e : Z) : number :=
  let v := scale T A (fst a) e in (v, rule_scale B R v (fst a) (snd a) e).

Definition tracked_midpoint (a b : number) : number :=
  let sum := tracked_add a b in
  if is_finite (fst sum) && is_finite (error_of sum) then tracked_scale sum (-1)
  else let half := tracked_scale a (-1) in tracked_add half (tracked_scale b (-1)).

(** The loop over the exponent's bits, from the last. *)
Fixpoint power_loop (bits : BinNums.positive) (first : bool) (result power : number) : number :=
  match bits with
  | xH => if first then power else tracked_multiply result power
  | xO rest => power_loop rest first result (tracked_multiply power power)
  | xI rest =>
      let next := if first then power else tracked_multiply result power in
      power_loop rest false next (tracked_multiply power power)
  end.
Definition tracked_pow (x : number) (n : Z) : number :=
  match n with
  | Z0 => exactly #1
  | Zpos bits => power_loop bits true (exactly #1) x
  | Zneg bits =>
      let result := power_loop bits true (exactly #1) x in
      match rule_divide B R with
      | Some divide =>
          let v := over T A #1 (fst result) in
          (v, divide v #1 (rule_exact T B rule #1) (fst result) (snd result))
      | None => within (fst result) (infinity T A)
      end
  end.

(** For rules without a dot_bound. *)
Definition tracked_dot (pairs : list (number * number)) : number :=
  match pairs with
  | [] => exactly #0
  | first :: rest =>
      let product := tracked_multiply (fst first) (snd first) in
      fold_left (fun sum pair => tracked_add sum (tracked_multiply (fst pair) (snd pair))) rest
                (#0 + fst product, snd product)
  end.

Definition is_certain (s : sign_type) : bool := match s with uncertain => false | _ => true end.
Definition horner_step (x result c : number) : number := tracked_add (tracked_multiply result x) c.
(** Partial results at `at_value`, and of the slope. *)
Definition slope_step (at_value x : number) (s : number * number) (c : number) : number * number :=
  let there := horner_step at_value (fst s) c in
  (there, tracked_add (tracked_multiply (snd s) x) there).
Definition tracked_horner (c : list number) (x : number) : number :=
  match c with
  | [] => exactly #0
  | c0 :: higher =>
      match rev higher with
      | [] => c0
      | top :: middle =>
          let result := horner_step x (fold_left (horner_step x) middle top) c0 in
          if Nat.eqb (length middle) 0 || (error_of x == #0) then result
          else
            let at_value := exactly (fst x) in
            let s := fold_left (slope_step at_value x) middle (top, top) in
            let change := tracked_multiply (snd s) (subtract x at_value) in
            let by_slope := tracked_add (horner_step at_value (fst s) c0) change in
            let loses_sign := is_certain (sign result) && negb (is_certain (sign by_slope)) in
            if (error_of by_slope < error_of result) && negb loses_sign then (fst result, snd by_slope)
            else result
      end
  end.

Definition tracked_lerp (a b t : number) : number :=
  let of_a := error_of a in
  let of_b := error_of b in
  let of_t := error_of t in
  if (of_t == #0) && (fst t == #0) then a
  else if (of_t == #0) && (fst t == #1) then b
  else
    let d := fst b - fst a in
    let v := fma T A (fst t) d (fst a) in
    let of_d := rounding_of T A d in
    let size := abs (fst t) in
    let from_ends := enlarged T A ((abs (#1 - fst t) + of_t) * of_a + (size + of_t) * of_b) in
    let from_t := enlarged T A ((abs d + of_d) * of_t + size * of_d) in
    within v (enlarged T A (rounding_of T A v + (from_ends + (from_t + #8 * η)))).

(** `exponent` is the function of number_traits. *)
Definition tracked_hypot (exponent : T -> Z) (x y : number) : number :=
  let larger := max T A (abs (fst x)) (abs (fst y)) in
  let inherited := error_of x + error_of y in
  if negb (is_finite inherited) then within larger (infinity T A)
  else if larger == #0 then within #0 (enlarged T A inherited)
  else
    let e := exponent larger in
    let a := scale T A (fst x) (- e)%Z in
    let b := scale T A (fst y) (- e)%Z in
    let root := root T A (a * a + b * b) in
    let v := scale T A root e in
    let relative := #3 * ε + #8 * η in
    within v (enlarged T A (v * relative + (inherited + #2 * η))).

Definition tracked_copysign (x y : number) : number :=
  let size := tracked_abs T A B rule x in
  match sign y with
  | negative => negate size
  | zero | positive => size
  | uncertain =>
      let v := if fst y < #0 then - fst size else fst size in
      if negb (is_finite (fst y)) || negb (is_finite (error_of y)) then within v (infinity T A)
      else within v (enlarged T A (#2 * fst size + error_of size))
  end.

End Functions.
End Compound.
