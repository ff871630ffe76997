(** The C++ code, line by line, over any number type: include/errbound/rules/*.hpp, the default sign_of of
    tracked.hpp, error_free.hpp and functions.hpp, with the operations of `arithmetic`.

    Nothing is proved here. Ieee.v takes IEEE floats as the numbers, and IeeeRules.v and other files prove theorems about
    these functions on them. TieProgram.v makes a program of them, with which tests/errbound/validation/tie_test.cpp
    compares the C++ code. *)

From Coq Require Import ZArith Bool.

(** The operations of a number type T and its number_traits that the code uses. Comparisons with NaN are false. *)
Record arithmetic (T : Type) := {
  plus : T -> T -> T;
  minus : T -> T -> T;
  times : T -> T -> T;
  over : T -> T -> T;
  fma : T -> T -> T -> T;
  root : T -> T;
  opposite : T -> T;
  less : T -> T -> bool;
  at_most : T -> T -> bool;
  equal : T -> T -> bool;
  scale : T -> Z -> T;
  integer : Z -> T;
  five_quarters : T;
  digits : Z;
  epsilon : T;
  unit_roundoff : T;
  underflow_unit : T;
  smallest_normal : T;
  largest : T;
  infinity : T
}.

(** The notation of the C++ code. The operations are those of the section's `arithmetic`. *)
Existing Class arithmetic.
Declare Scope code.
Infix "+" := (plus _ _) : code.
Infix "-" := (minus _ _) : code.
Infix "*" := (times _ _) : code.
Infix "/" := (over _ _) : code.
Notation "- x" := (opposite _ _ x) : code.
Infix "<" := (less _ _) : code.
Infix "<=" := (at_most _ _) : code.
Infix "==" := (equal _ _) (at level 70) : code.
Notation "# n" := (integer _ _ n%Z) (at level 1, n at level 0, format "# n") : code.
Notation "∞" := (infinity _ _) : code.

Inductive sign_type := negative | zero | positive | uncertain.

Section Code.

Context (T : Type) (A : arithmetic T).
(** True if fma is one instruction. In constant expressions two_product does not use fma, but product_error_is_exact
    still tests has_fast_fma. From 4 digits on both give the same for every product. *)
Variable has_fast_fma : bool.

Notation ε := (epsilon T A).
Notation u := (unit_roundoff T A).
Notation η := (underflow_unit T A).
Open Scope code.

(** number_traits.hpp *)
Definition abs (x : T) : T := if x < #0 then - x else x.
Definition max (x y : T) : T := if x < y then y else x.
Definition is_finite (x : T) : bool := abs x <= largest T A.
Definition least (m n : T) : T := if n < m then n else m.

(** tracked.hpp, for rules without a sign of their own *)
Definition sign_of (value error : T) : sign_type :=
  if error < value then positive
  else if value < - error then negative
  else if (value == #0) && (error == #0) then zero
  else uncertain.

(** error_free.hpp *)
Definition two_sum (a b : T) : T * T :=
  let sum := a + b in
  let b_in_sum := sum - a in
  (sum, (a - (sum - b_in_sum)) + (b - b_in_sum)).
Definition split (x : T) : T * T :=
  let s := ((digits T A + 1) / 2)%Z in
  let c := (#(2 ^ s) + #1) * x in
  let high := c - (c - x) in
  (high, x - high).
Definition two_product (a b : T) : T * T :=
  let v := a * b in
  if has_fast_fma then (v, fma T A a b (- v))
  else
    let (a_high, a_low) := split a in
    let (b_high, b_low) := split b in
    let first := a_high * b_high - v in
    let middle := (first + a_high * b_low) + a_low * b_high in
    (v, middle + a_low * b_low).
Definition product_error_is_exact (a b : T) (product : T * T) : bool :=
  let (value, error) := product in
  if negb (is_finite value) || negb (is_finite error) then false
  else
    let s := ((digits T A + 1) / 2)%Z in
    let most := largest T A / #(2 ^ (s + 2)) in
    if (most < abs a) || (most < abs b) then false
    else if (a == #0) || (b == #0) then true
    else if negb has_fast_fma && (digits T A <? 4)%Z then false
    else if largest T A / #4 < abs value then false
    else η / u / u <= abs value.
Definition remainder_of_division (a b q : T) : T * bool :=
  if a == #0 then (#0, is_finite q)
  else
    let product := two_product q b in
    let exact := negb (q == #0) && product_error_is_exact q b product in
    ((a - fst product) - snd product, exact).

(** rules/none.hpp *)
Definition none_error (value : T) : T := if is_finite value then #0 else ∞.

(** detail/sum_of_bounds.hpp *)
Definition sum_above (x y : T) : T :=
  let sum := x + y in
  if sum - max x y < least x y then sum * (#1 + ε) else sum.
Definition sum_of_bounds (enlarged own x y : T) : T :=
  if (40 <=? digits T A)%Z then enlarged
  else if own * #(2 ^ Z.max 0 (digits T A - 11)) < x + y then
    least enlarged (sum_above own (sum_above x y))
  else enlarged.

(** rules/tight.hpp *)
Definition tight_exact (value : T) : T := value - value.
Definition tight_within (value error : T) : T :=
  if #0 <= error then error + (value - value) else ∞.
Definition tight_rounding (v : T) : T := abs v * (ε * (#1 + ε)).
Definition tight_inflated (bound : T) : T := bound * (#1 + #8 * ε).
Definition is_zero (a sa : T) : bool := (a == #0) && (sa == #0).
Definition tight_add (v sa sb : T) : T :=
  sum_of_bounds (tight_inflated (tight_rounding v + (sa + sb))) (tight_rounding v) sa sb.
Definition tight_multiply (v a sa b sb : T) : T :=
  if is_zero a sa || is_zero b sb then tight_rounding v
  else
    let inherited := abs a * sb + sa * (abs b + sb) in
    tight_inflated (tight_rounding v + inherited + #4 * η).
Definition tight_divide (v a sa b sb : T) : T :=
  let distance := abs b - sb in
  if negb (#0 < distance) then ∞
  else if is_zero a sa then tight_rounding v
  else
    let quotient := tight_inflated (abs v + η) in
    let lost := if #0 < sb then #4 * η else #0 in
    let inherited := (sa + quotient * sb + lost) / distance in
    tight_inflated (tight_rounding v + tight_inflated inherited + #4 * η).
Definition tight_scale (v a sa : T) (e : Z) : T :=
  let scaled := scale T A sa e in
  let lossless := (0 <=? e)%Z ||
    ((scale T A v (- e)%Z == a) && (scale T A scaled (- e)%Z == sa)) in
  if lossless then scaled + (v - v) else tight_inflated (scaled + #2 * η).

(** rules/sharp.hpp; exact, within and is_zero are tight's. *)
Definition sharp_rounding (v : T) : T := abs v * u.
Definition sharp_inflated (bound : T) : T := bound * (#1 + #4 * ε).
Definition sharp_add (v sa sb : T) : T :=
  sum_of_bounds ((sharp_rounding v + (sa + sb)) * (#1 + #2 * ε)) (sharp_rounding v) sa sb.
Definition sharp_multiply (v a sa b sb : T) : T :=
  if is_zero a sa || is_zero b sb then sharp_rounding v
  else
    let inherited := abs a * sb + sa * (abs b + sb) in
    sharp_inflated ((sharp_rounding v + #2 * η) + inherited).
Definition sharp_divide (v a sa b sb : T) : T :=
  let distance := abs b - sb in
  if negb (#0 < distance) then ∞
  else if is_zero a sa then sharp_rounding v
  else
    let quotient := sharp_inflated (abs v + η) in
    let lost := if #0 < sb then η else #0 in
    let inherited := (sa + (quotient * sb + lost)) / distance in
    sharp_inflated ((sharp_rounding v + #2 * η) + sharp_inflated inherited).
Definition sharp_scale (v a sa : T) (e : Z) : T :=
  let scaled := scale T A sa e in
  let lossless := (0 <=? e)%Z ||
    ((scale T A v (- e)%Z == a) && (scale T A scaled (- e)%Z == sa)) in
  if lossless then scaled + (v - v) else sharp_inflated (scaled + η).

(** rules/safe.hpp *)
Definition too_many : Z := (2 ^ 29)%Z.
Definition counted (k : Z) : Z := if (k <? too_many - 1)%Z then (k + 1)%Z else too_many.
Definition safe_enlarged (x : T) : T := x * (#1 + #4 * ε).
Definition safe_is_zero (a : T) (k : Z) : bool := (a == #0) && (k =? 0)%Z.
Definition safe_exact (value : T) : T * Z := (abs value, 0%Z).
Definition safe_within (value error : T) : T * Z :=
  if error == #0 then safe_exact value
  else if negb (#0 < error) then (∞, 1%Z)
  else (safe_enlarged (max (abs value + error) (error / ε)), 1%Z).
Definition safe_error (value B : T) (k : Z) : T :=
  let x := #k * ε in
  if negb (x <= #1) || (k =? too_many)%Z || negb (is_finite value) then ∞
  else if (k =? 0)%Z then #0
  else safe_enlarged (B * safe_enlarged (x * (#1 + x)) + η).
Definition safe_add (Ba : T) (ka : Z) (Bb : T) (kb : Z) : T * Z :=
  (safe_enlarged (Ba + Bb), counted (if (ka <? kb)%Z then kb else ka)).
Definition safe_multiply (a Ba : T) (ka : Z) (b Bb : T) (kb : Z) : T * Z :=
  if safe_is_zero a ka || safe_is_zero b kb then (#0, 0%Z)
  else (max (safe_enlarged (Ba * Bb)) (smallest_normal T A), counted (ka + kb)).
Definition safe_scale (v a B : T) (k e : Z) : T * Z :=
  let scaled := scale T A B e in
  if (0 <=? e)%Z || ((scale T A v (- e)%Z == a) && (scale T A scaled (- e)%Z == B))
  then (scaled, k)
  else (max (safe_enlarged scaled) (smallest_normal T A), counted k).

(** rules/interval.hpp *)
Definition interval_unknown : T * T := (- ∞, ∞).
Definition interval_checked (value lower upper : T) : T * T :=
  if (- ∞ < lower) && (lower <= value) && (value <= upper) && (upper < ∞) then (lower, upper)
  else interval_unknown.
Definition step (c : T) : T := abs c * u * five_quarters T A + η.
Definition below (c : T) : T := c - step c.
Definition above (c : T) : T := c + step c.
Definition interval_exact (value : T) : T * T := interval_checked value value value.
Definition interval_within (value error : T) : T * T :=
  if error == #0 then interval_exact value
  else if negb (#0 < error) then interval_unknown
  else interval_checked value (below (value - error)) (above (value + error)).
Definition interval_sign (b : T * T) : sign_type :=
  if #0 < fst b then positive
  else if snd b < #0 then negative
  else if (fst b == #0) && (snd b == #0) then zero
  else uncertain.
Definition interval_error (value : T) (b : T * T) : T :=
  let off := max (snd b - value) (value - fst b) in
  if off == #0 then off
  else
    let enough := above off in
    let certain := match interval_sign b with uncertain => false | _ => true end in
    if certain && negb (enough < largest T A) then largest T A else enough.
Definition interval_negate (b : T * T) : T * T := (- snd b, - fst b).
Definition interval_nearest (v error : T) : T * T :=
  interval_checked v (if error < #0 then below v else v) (if #0 < error then above v else v).
Definition interval_add (v : T) (a b : T * T) : T * T :=
  let (lower, below_error) := two_sum (fst a) (fst b) in
  let (upper, above_error) := two_sum (snd a) (snd b) in
  interval_checked v (if #0 <= below_error then lower else below lower)
                     (if above_error <= #0 then upper else above upper).
Definition interval_subtract (v : T) (a b : T * T) : T * T :=
  interval_add v a (interval_negate b).
Definition most (m n : T) : T := if m < n then n else m.
Definition hull (v w x y z : T) : T * T :=
  interval_checked v (below (least (least w x) (least y z))) (above (most (most w x) (most y z))).
Definition is_point (b : T * T) : bool := fst b == snd b.
Definition is_zero_interval (b : T * T) : bool := (fst b == #0) && (snd b == #0).
Definition interval_multiply (v av : T) (a : T * T) (bv : T) (b : T * T) : T * T :=
  if is_zero_interval a || is_zero_interval b then interval_checked v v v
  else if is_point a && is_point b then
    let p := two_product av bv in
    if product_error_is_exact av bv p then interval_nearest v (snd p)
    else interval_checked v (below v) (above v)
  else hull v (fst a * fst b) (fst a * snd b) (snd a * fst b) (snd a * snd b).
Definition interval_divide (v av : T) (a : T * T) (bv : T) (b : T * T) : T * T :=
  if negb (#0 < fst b) && negb (snd b < #0) then interval_unknown
  else if is_point a && is_point b then
    let (r, exact) := remainder_of_division av bv v in
    if exact then interval_nearest v (if bv < #0 then - r else r)
    else interval_checked v (below v) (above v)
  else hull v (fst a / fst b) (fst a / snd b) (snd a / fst b) (snd a / snd b).
Definition interval_scale (v : T) (a : T * T) (e : Z) : T * T :=
  let lower := scale T A (fst a) e in
  let upper := scale T A (snd a) e in
  let lossless := (0 <=? e)%Z ||
    ((scale T A lower (- e)%Z == fst a) && (scale T A upper (- e)%Z == snd a)) in
  if lossless then interval_checked v lower upper
  else interval_checked v (below lower) (above upper).

(** rules/residual.hpp: a bound is (correction, remainder). *)
Definition residual_inflated (bound : T) : T := bound * (#1 + #8 * ε).
Definition residual_exact (value : T) : T * T := (#0, value - value).
Definition residual_within (value error : T) : T * T :=
  (#0, if #0 <= error then error + (value - value) else ∞).
Definition residual_error (b : T * T) : T :=
  if snd b == #0 then abs (fst b) else residual_inflated (abs (fst b) + snd b).
Definition residual_sign (value : T) (b : T * T) : sign_type :=
  let corrected := value + fst b in
  if (corrected == #0) && (snd b == #0) then zero
  else if negb (residual_inflated (snd b) < abs corrected) || negb (is_finite (residual_error b))
  then uncertain
  else if #0 < corrected then positive else negative.
Definition residual_negate (b : T * T) : T * T := (- fst b, snd b).
Definition residual_is_exact (b : T * T) : bool := (fst b == #0) && (snd b == #0).
Definition residual_is_zero (a : T) (b : T * T) : bool := (a == #0) && residual_is_exact b.
Definition half_ulp (v : T) : T := abs v * u + η.
Definition roundings (x y first second : T) : T :=
  ((abs x + abs y) + (abs first + abs second)) * u + #4 * η.
Definition residual_add (v a : T) (sa : T * T) (b : T) (sb : T * T) : T * T :=
  let own := snd (two_sum a b) in
  let inherited := two_sum (fst sa) (fst sb) in
  let correction := two_sum own (fst inherited) in
  let lost := abs (snd inherited) + abs (snd correction) in
  (fst correction,
   sum_of_bounds (residual_inflated ((snd sa + snd sb) + lost)) (residual_inflated lost) (snd sa) (snd sb)
     + (v - v)).
Definition residual_subtract (v a : T) (sa : T * T) (b : T) (sb : T * T) : T * T :=
  residual_add v a sa (- b) (residual_negate sb).
Definition residual_multiply (v a : T) (sa : T * T) (b : T) (sb : T * T) : T * T :=
  if residual_is_zero a sa || residual_is_zero b sb then residual_exact v
  else
    let product := two_product a b in
    let known := product_error_is_exact a b product in
    let own := if known then snd product else #0 in
    let unknown := if known then #0 else half_ulp v in
    if residual_is_exact sa && residual_is_exact sb then (own, unknown)
    else
      let ca := abs (fst sa) in
      let cb := abs (fst sb) in
      let x := a * fst sb in
      let y := fst sa * b in
      let inherited := x + y in
      let correction := own + inherited in
      let remainder := (abs a + ca) * snd sb + ((abs b + cb + snd sb) * snd sa + ca * cb) in
      (correction, residual_inflated (remainder + roundings x y inherited correction + unknown)).
Definition residual_divide (v a : T) (sa : T * T) (b : T) (sb : T * T) : T * T :=
  let off := residual_error sb in
  let distance := abs b - off in
  if negb (#0 < distance) then (#0, ∞)
  else if residual_is_zero a sa then residual_exact v
  else
    let (value, known) := remainder_of_division a b v in
    let own := if known then value else #0 in
    let unknown := if known then #0 else half_ulp v in
    if (own == #0) && residual_is_exact sa && residual_is_exact sb then (#0, unknown + (v - v))
    else
      let x := v * fst sb in
      let inherited := fst sa - x in
      let numerator := own + inherited in
      let correction := numerator / b in
      let lost := unknown + η in
      let c := abs correction + lost in
      let q := abs v in
      let left := (c * off + (q * snd sb + snd sa)) + roundings x #0 inherited numerator in
      (correction, residual_inflated (residual_inflated left / distance + half_ulp correction + lost)).
Definition residual_scale (v a : T) (sa : T * T) (e : Z) : T * T :=
  let correction := scale T A (fst sa) e in
  let remainder := scale T A (snd sa) e in
  let lossless := (0 <=? e)%Z ||
    ((scale T A v (- e)%Z == a) && (scale T A correction (- e)%Z == fst sa) &&
     (scale T A remainder (- e)%Z == snd sa)) in
  (correction,
   if lossless then remainder + (v - v) else residual_inflated (remainder + #2 * η)).

(** The functions of a rule that functions.hpp uses; B is a bound. *)
Record rule (B : Type) := {
  rule_exact : T -> B;
  rule_within : T -> T -> B;
  rule_error : T -> B -> T;
  rule_subtract : T -> T -> B -> T -> B -> B;
  rule_negate : B -> B;
  rule_sign : T -> B -> sign_type
}.
Definition tight_rule : rule T := {|
  rule_exact := tight_exact;
  rule_within := tight_within;
  rule_error _ b := b;
  rule_subtract v _ sa _ sb := tight_add v sa sb;
  rule_negate b := b;
  rule_sign := sign_of
|}.
Definition sharp_rule : rule T := {|
  rule_exact := tight_exact;
  rule_within := tight_within;
  rule_error _ b := b;
  rule_subtract v _ sa _ sb := sharp_add v sa sb;
  rule_negate b := b;
  rule_sign := sign_of
|}.
Definition safe_rule : rule (T * Z) := {|
  rule_exact := safe_exact;
  rule_within := safe_within;
  rule_error v b := safe_error v (fst b) (snd b);
  rule_subtract _ _ sa _ sb := safe_add (fst sa) (snd sa) (fst sb) (snd sb);
  rule_negate b := b;
  rule_sign v b := sign_of v (safe_error v (fst b) (snd b))
|}.
Definition interval_rule : rule (T * T) := {|
  rule_exact := interval_exact;
  rule_within := interval_within;
  rule_error := interval_error;
  rule_subtract v _ sa _ sb := interval_subtract v sa sb;
  rule_negate := interval_negate;
  rule_sign _ b := interval_sign b
|}.
Definition residual_rule : rule (T * T) := {|
  rule_exact := residual_exact;
  rule_within := residual_within;
  rule_error _ b := residual_error b;
  rule_subtract := residual_subtract;
  rule_negate := residual_negate;
  rule_sign := residual_sign
|}.

(** functions.hpp, for tracked numbers: a value and a bound. *)
Section Functions.

Context (B : Type) (R : rule B).

Definition tracked_exactly (v : T) : T * B := (v, rule_exact B R v).
Definition tracked_within (v e : T) : T * B := (v, rule_within B R v e).
Definition tracked_error (x : T * B) : T :=
  let error := rule_error B R (fst x) (snd x) in if error == error then error else ∞.
Definition tracked_sign (x : T * B) : sign_type := rule_sign B R (fst x) (snd x).
Definition tracked_negate (x : T * B) : T * B := (- fst x, rule_negate B R (snd x)).
Definition tracked_subtract (a b : T * B) : T * B :=
  let v := fst a - fst b in (v, rule_subtract B R v (fst a) (snd a) (fst b) (snd b)).
Definition tracked_compare (a b : T * B) : sign_type := tracked_sign (tracked_subtract a b).

Definition enlarged (bound : T) : T := bound * (#1 + #8 * ε).
Definition rounding_of (v : T) : T := abs v * (ε * (#1 + ε)) + η.
Definition larger_error (a b : T * B) : T :=
  let x := tracked_error a in
  let y := tracked_error b in
  if x <= y then y else if y <= x then x else ∞.
Definition lesser_or_either (a b : T * B) : T * B :=
  match tracked_compare a b with
  | negative | zero => a
  | _ => tracked_within (fst a) (larger_error a b)
  end.

Definition tracked_sqrt (x : T * B) : T * B :=
  let v := root T A (fst x) in
  let e := tracked_error x in
  if negb (e <= fst x) then tracked_within v ∞
  else if e == #0 then
    let square := two_product v v in
    if product_error_is_exact v v square && (snd square == #0) && (fst square == fst x)
    then tracked_exactly v
    else tracked_within v (enlarged (rounding_of v))
  else
    let divisor := v + root T A (fst x - e) in
    tracked_within v (enlarged (e / divisor + (rounding_of v + η))).
Definition tracked_abs (x : T * B) : T * B :=
  let below_0 := fst x < #0 in
  let kept := if below_0 then tracked_negate x else x in
  match tracked_sign x with
  | zero => kept
  | negative => if below_0 then kept else tracked_within (abs (fst x)) (tracked_error x)
  | positive => if below_0 then tracked_within (abs (fst x)) (tracked_error x) else kept
  | uncertain => tracked_within (abs (fst x)) (tracked_error x)
  end.
Definition tracked_min (a b : T * B) : T * B :=
  if fst b < fst a then lesser_or_either b a else lesser_or_either a b.
Definition tracked_max (a b : T * B) : T * B :=
  tracked_negate (if fst a < fst b then lesser_or_either (tracked_negate b) (tracked_negate a)
                  else lesser_or_either (tracked_negate a) (tracked_negate b)).
Definition tracked_fma (a b c : T * B) : T * B :=
  let v := fma T A (fst a) (fst b) (fst c) in
  let of_a := tracked_error a in
  let of_b := tracked_error b in
  let of_c := tracked_error c in
  let product_is_zero := ((fst a == #0) && (of_a == #0)) || ((fst b == #0) && (of_b == #0)) in
  if product_is_zero && is_finite v then c
  else
    let products := abs (fst a) * of_b + of_a * (abs (fst b) + of_b) in
    tracked_within v (enlarged (rounding_of v + (products + (of_c + #3 * η)))).

End Functions.

End Code.
