(** The C++ code of the rule `affine` (include/errbound/rules/affine.hpp), line by line, over any number type, as
    in Code.v. It has at most `limit` terms. `f` is an operation's new source, if there are sources. Nothing is
    proved here. *)

From Coq Require Import ZArith Bool List.
From Errbound Require Import Code CompoundCode.
Import ListNotations.

Section Affine.

Context (T : Type) (A : arithmetic T) (has_fast_fma : bool) (limit : nat).

Notation ε := (epsilon T A).
Notation η := (underflow_unit T A).
Notation abs := (abs T A).
Notation is_finite := (is_finite T A).
Notation half_ulp := (half_ulp T A).
Open Scope code.

Definition terms : Type := list (Z * T).
Record affine := { radius : T; rest : T; parts : terms }.

Definition upper_sum (x y : T) : T := if x == #0 then y else if y == #0 then x else (x + y) * (#1 + ε).
Definition upper_product (x y : T) : T := if (x == #0) || (y == #0) then #0 else (x * y) * (#1 + ε) + η.
Definition upper_quotient (x y : T) : T := if x == #0 then #0 else (x / y) * (#1 + ε) + η.

(** The error that is left so far, and the terms in order. *)
Definition builder : Type := T * terms.
Definition nothing : builder := (#0, []).
Definition add (s : Z) (c : T) (B : builder) : builder := if c == #0 then B else (fst B, snd B ++ [(s, c)]).
Definition add_left (x : T) (B : builder) : builder := (upper_sum (fst B) x, snd B).
Definition radius_of (B : builder) : T := fold_left (fun r (t : Z * T) => upper_sum r (abs (snd t))) (snd B) #0.
(** The first of the smallest terms, and the others. *)
Fixpoint least (t : Z * T) (l : terms) : (Z * T) * terms :=
  match l with
  | [] => (t, [])
  | x :: l' => let (m, r) := least x l' in if abs (snd m) < abs (snd t) then (m, t :: r) else (t, l)
  end.
Fixpoint shorten (fuel : nat) (B : builder) : builder :=
  match fuel, snd B with
  | S n, t :: l =>
    if (limit <=? length (snd B))%nat then
      let (m, r) := least t l in shorten n (add_left (abs (snd m)) (fst B, r))
    else B
  | _, _ => B
  end.
(** The search for the position starts at the last term. *)
Fixpoint placed (t : Z * T) (l : terms) : terms :=
  match l with
  | [] => [t]
  | x :: l' => if (fst t <? fst x)%Z then x :: placed t l' else t :: l
  end.
Definition unknown_number : affine := {| radius := infinity T A; rest := infinity T A; parts := [] |}.
Definition finished (value : T) (B : builder) (f : option Z) : affine :=
  let all := upper_sum (radius_of B) (fst B) in
  if negb (is_finite value) || negb (is_finite all) then unknown_number
  else
    let room := if fst B == #0 then limit else Nat.pred limit in
    let B := if (room <? length (snd B))%nat then shorten (length (snd B)) B else B in
    if fst B == #0 then {| radius := all; rest := #0; parts := snd B |}
    else
      match f with
      | Some f => {| radius := all; rest := #0; parts := rev (placed (f, fst B) (rev (snd B))) |}
      | None => {| radius := all; rest := fst B; parts := snd B |}
      end.
(** The terms of two numbers, by ascending source. *)
Fixpoint merged (a : terms) : terms -> list (Z * (T * T)) :=
  fix with_a (b : terms) :=
    match a, b with
    | [], [] => []
    | [], (t, y) :: b' => (t, (#0, y)) :: with_a b'
    | (s, x) :: a', [] => (s, (x, #0)) :: merged a' []
    | (s, x) :: a', (t, y) :: b' =>
      if (s <? t)%Z then (s, (x, #0)) :: merged a' b
      else if (t <? s)%Z then (t, (#0, y)) :: with_a b'
      else (s, (x, y)) :: merged a' b'
    end.

Definition affine_exact (value : T) : affine := {| radius := value - value; rest := value - value; parts := [] |}.
Definition affine_within (value error : T) f : affine :=
  if negb (#0 <= error) then unknown_number else finished value (add_left error nothing) f.
Definition affine_negate (b : affine) : affine :=
  {| radius := radius b; rest := rest b; parts := map (fun t => (fst t, - snd t)) (parts b) |}.
Definition sum_step (B : builder) (t : Z * (T * T)) : builder :=
  let c := two_sum T A (fst (snd t)) (snd (snd t)) in add_left (abs (snd c)) (add (fst t) (fst c) B).
Definition affine_add (v a : T) (sa : affine) (b : T) (sb : affine) f : affine :=
  let r := add_left (abs (snd (two_sum T A a b))) nothing in
  let r := fold_left sum_step (merged (parts sa) (parts sb)) r in
  finished v (add_left (rest sb) (add_left (rest sa) r)) f.
Definition affine_subtract (v a : T) (sa : affine) (b : T) (sb : affine) f : affine :=
  affine_add v a sa (- b) (affine_negate sb) f.
Definition is_exact_zero (a : T) (sa : affine) : bool := (a == #0) && (radius sa == #0).
Definition product_step (a b : T) (r : builder) (t : Z * (T * T)) : builder :=
  let x := a * snd (snd t) in
  let y := fst (snd t) * b in
  let c := two_sum T A x y in
  let r := add (fst t) (fst c) r in
  let r := if (snd (snd t) == #0) || (a == #0) then r else add_left (half_ulp x) r in
  let r := if (fst (snd t) == #0) || (b == #0) then r else add_left (half_ulp y) r in
  add_left (abs (snd c)) r.
Definition affine_multiply (v a : T) (sa : affine) (b : T) (sb : affine) f : affine :=
  if is_exact_zero a sa || is_exact_zero b sb then affine_exact v
  else
    let product := two_product T A has_fast_fma a b in
    let known := product_error_is_exact T A has_fast_fma a b product in
    let r := add_left (if known then abs (snd product) else half_ulp v) nothing in
    let r := fold_left (product_step a b) (merged (parts sa) (parts sb)) r in
    let r := add_left (upper_product (abs a) (rest sb)) r in
    let r := add_left (upper_product (rest sa) (abs b)) r in
    finished v (add_left (upper_product (radius sa) (radius sb)) r) f.
(** A pair of terms: the rest of the numerator's term, and the builder. *)
Definition quotient_step (v b : T) (r : T * builder) (t : Z * (T * T)) : T * builder :=
  let x := v * snd (snd t) in
  let n := two_sum T A (fst (snd t)) (- x) in
  let left := upper_sum (fst r) (abs (snd n)) in
  let left := if snd (snd t) == #0 then left else upper_sum left (half_ulp x) in
  let c := fst n / b in
  let r := add (fst t) c (snd r) in
  (left, if fst n == #0 then r else add_left (half_ulp c) r).
Definition affine_divide (v a : T) (sa : affine) (b : T) (sb : affine) f : affine :=
  let distance := (abs b - radius sb) * (#1 - ε) in
  if negb (#0 < distance) then unknown_number
  else if is_exact_zero a sa then affine_exact v
  else
    let (remainder, known) := remainder_of_division T A has_fast_fma a b v in
    let r := if known then nothing else add_left (half_ulp v) nothing in
    let left := upper_sum (upper_product (abs v) (rest sb)) (rest sa) in
    let left := if known then upper_sum left (abs remainder) else left in
    let (left, r) := fold_left (quotient_step v b) (merged (parts sa) (parts sb)) (left, r) in
    let r := add_left (upper_quotient left (abs b)) r in
    let quotient := upper_sum (radius_of r) (fst r) in
    let r := if #0 < radius sb
             then add_left (upper_quotient (upper_product quotient (radius sb)) distance) r else r in
    finished v r f.
Definition lost (scaled x : T) (e : Z) : T := if (0 <=? e)%Z || (scale T A scaled (Z.opp e) == x) then #0 else η.
Definition scale_step (e : Z) (r : builder) (t : Z * T) : builder :=
  let c := scale T A (snd t) e in add_left (lost c (snd t) e) (add (fst t) c r).
Definition affine_scale (v a : T) (sa : affine) (e : Z) f : affine :=
  let r := add_left (lost v a e) nothing in
  let r := fold_left (scale_step e) (parts sa) r in
  let scaled := scale T A (rest sa) e in
  finished v (add_left (lost scaled (rest sa) e) (add_left scaled r)) f.

(** The functions of a rule that tracked.hpp needs. Here every operation has the same source, or none. *)
Definition affine_rule (f : option Z) : rule T affine := {|
  rule_exact := affine_exact;
  rule_within v error := affine_within v error f;
  rule_error _ b := radius b;
  rule_subtract v a sa b sb := affine_subtract v a sa b sb f;
  rule_negate := affine_negate;
  rule_sign v b := sign_of T A v (radius b)
|}.
Definition affine_operations (f : option Z) : operations T affine := {|
  the_rule := affine_rule f;
  rule_add v a sa b sb := affine_add v a sa b sb f;
  rule_multiply v a sa b sb := affine_multiply v a sa b sb f;
  rule_divide := Some (fun v a sa b sb => affine_divide v a sa b sb f);
  rule_scale v a sa e := affine_scale v a sa e f
|}.

End Affine.
