(** The C++ code of the rule `relative` (include/errbound/rules/relative.hpp), line by line, over any number type, as
    in Code.v. Counts have another number type, double in the code. Nothing is proved here. *)

From Coq Require Import ZArith Bool List.
From Errbound Require Import Code CompoundCode.
Import ListNotations.

(** Code for counts of either type. *)
Section Counts.

Context (D : Type) (A : arithmetic D).

Open Scope code.

(** At least the successor of x >= 0, or x itself if that is subnormal. *)
Definition upper (x : D) : D := x * (#1 + epsilon D A).
Definition slack : D := #1 + #8 * epsilon D A.

(** u is the unit roundoff of the numbers. *)
Definition of_one_factor (u : D) : D := u * (#1 - u / #2) / (#1 - u) * slack.
Definition count_sum (j k : D) : D :=
  let sum := two_sum D A j k in if #0 < snd sum then upper (fst sum) else fst sum.
Definition count_of_share (u r : D) : D := r * (#6 - #5 * r) / (#2 * (#1 - r) * (#3 - r) * u) * slack.
Definition length_of_count (u k : D) : D := upper (k * of_one_factor u) + underflow_unit D A.
Definition share_of_length (l : D) : D := l / (#1 - l / #2) * slack.

End Counts.

Section Relative.

Context (T D : Type) (A : arithmetic T) (C : arithmetic D) (to_count : T -> D) (from_count : D -> T)
  (has_fast_fma : bool).

Notation count n := (integer D C n%Z).
Notation ε := (epsilon T A).
Notation η := (underflow_unit T A).
Notation abs := (abs T A).
Notation is_finite := (is_finite T A).
Notation upper := (upper T A).
Notation count_sum := (count_sum D C).
Open Scope code.

Definition unknown : D := infinity D C.
Definition u_of_counts : D := to_count (unit_roundoff T A).

Definition factors_of (error size : T) : D :=
  if negb (#0 < size) then unknown
  else
    let share := upper (error / size) + η in
    if negb (share < #1) then unknown
    else
      let r := RelativeCode.upper D C (to_count share) + underflow_unit D C in
      if negb (r < count 1) then unknown else count_of_share D C u_of_counts r.
Definition relative_exact (value : T) : D := if is_finite value then count 0 else unknown.
Definition relative_within (value error : T) : D :=
  if error == #0 then relative_exact value
  else if negb (#0 < error) || negb (is_finite value) then unknown
  else factors_of error (abs value).
Definition relative_error (value : T) (k : D) : T :=
  if k == count 0 then #0
  else
    let l := length_of_count D C u_of_counts k in
    if negb (l < count 7 / count 4) then ∞
    else
      let r := share_of_length D C l in
      let share := from_count r in
      let enough := if to_count share < r then upper share + η else share in
      upper (abs value * enough) + η.
Definition relative_sign (value : T) (k : D) : sign_type :=
  if negb (is_finite (relative_error value k)) then uncertain
  else if value == #0 then zero
  else if #0 < value then positive else negative.

Definition is_exact_zero (a : T) (k : D) : bool := (a == #0) && (k == count 0).
Definition rounded_to (v : T) (k : D) (is_exact : bool) : D :=
  if negb (is_finite v) then unknown
  else if is_exact then k
  else if smallest_normal T A <= abs v then count_sum k (count 1) else unknown.
Definition rounded_sum (v : T) (k : D) (is_exact : bool) : D :=
  if negb (is_finite v) then unknown else if is_exact then k else count_sum k (count 1).
Definition relative_add (v a : T) (ka : D) (b : T) (kb : D) : D :=
  let is_exact := snd (two_sum T A a b) == #0 in
  let k := if ka < kb then kb else ka in
  if (k == count 0) || ((#0 <= a) && (#0 <= b)) || ((a <= #0) && (b <= #0)) then rounded_sum v k is_exact
  else
    let off := upper (relative_error a ka + relative_error b kb) in
    let size := abs v in
    let least := if is_exact then size else size * (#1 - ε) in
    if negb (is_finite v) || negb (off < least) then unknown
    else rounded_sum v (factors_of off least) is_exact.
Definition relative_subtract (v a : T) (ka : D) (b : T) (kb : D) : D := relative_add v a ka (- b) kb.
Definition relative_multiply (v a : T) (ka : D) (b : T) (kb : D) : D :=
  if is_exact_zero a ka || is_exact_zero b kb then relative_exact v
  else
    let product := two_product T A has_fast_fma a b in
    let is_exact := product_error_is_exact T A has_fast_fma a b product && (snd product == #0) in
    rounded_to v (count_sum ka kb) is_exact.
Definition relative_divide (v a : T) (ka : D) (b : T) (kb : D) : D :=
  if (b == #0) || negb (kb < unknown) then unknown
  else if is_exact_zero a ka then relative_exact v
  else
    let (remainder, known) := remainder_of_division T A has_fast_fma a b v in
    rounded_to v (count_sum ka kb) (known && (remainder == #0)).
Definition relative_scale (v a : T) (ka : D) (e : Z) : D :=
  rounded_to v ka ((0 <=? e)%Z || (scale T A v (Z.opp e) == a)).

Definition relative_rule : rule T D := {|
  rule_exact := relative_exact;
  rule_within := relative_within;
  rule_error := relative_error;
  rule_subtract := relative_subtract;
  rule_negate k := k;
  rule_sign := relative_sign
|}.
Definition relative_operations : operations T D := {|
  the_rule := relative_rule;
  rule_add := relative_add;
  rule_multiply := relative_multiply;
  rule_divide := Some relative_divide;
  rule_scale := relative_scale
|}.

(** The rule's dot_bound: the sum, its error, and the count of single operations. *)
Definition relative_dot_step (s : T * T * D) (pair : (T * D) * (T * D)) : T * T * D :=
  let '(before, off, counted) := s in
  let '((a, ka), (b, kb)) := pair in
  let product := a * b in
  let sum := before + product in
  let of_product := relative_multiply product a ka b kb in
  let rounded_off := abs (snd (two_sum T A before product)) in
  (sum, upper (off + upper (relative_error product of_product + rounded_off)),
   relative_add sum before counted product of_product).
Definition relative_dot (pairs : list ((T * D) * (T * D))) : T * D :=
  let '(sum, off, counted) := fold_left relative_dot_step pairs (#0, #0, count 0) in
  let by_size := relative_within sum off in
  (sum, if by_size < counted then by_size else counted).

End Relative.
