(** The C++ code, line by line, over any number type, as in CompoundCode.v: square roots and ab + c rounded once
    (include/errbound/functions.hpp), under rules with first-order errors, `residual` and `affine`, and under
    `interval` (include/errbound/rules/interval.hpp). The functions `numbered_...` use operations that differ from
    call to call, as in NumberedCode.v. Nothing is proved here. *)

From Coq Require Import ZArith Bool.
From Errbound Require Import Code CompoundCode NumberedCode.

Section Slopes.

Context (T : Type) (A : arithmetic T) (has_fast_fma : bool).

Notation is_finite := (is_finite T A).
Notation root := (root T A).
Open Scope code.

(** error_free.hpp *)
Definition remainder_of_root (x v : T) : T * bool := remainder_of_division T A has_fast_fma x v v.

(** rules/interval.hpp *)
Definition interval_square_root (v : T) (a : T * T) : T * T :=
  if negb (#0 <= fst a) then interval_unknown T A
  else
    let lower := root (fst a) in
    let upper := root (snd a) in
    let of_lower := remainder_of_root (fst a) lower in
    let of_upper := remainder_of_root (snd a) upper in
    interval_checked T A v (if snd of_lower && (#0 <= fst of_lower) then lower else below T A lower)
                           (if snd of_upper && (fst of_upper <= #0) then upper else above T A upper).
Definition fused_end (choice : T -> T -> T) (a b : T * T) (c : T) : T :=
  choice (choice (fma T A (fst a) (fst b) c) (fma T A (fst a) (snd b) c))
         (choice (fma T A (snd a) (fst b) c) (fma T A (snd a) (snd b) c)).
Definition interval_fused (v : T) (a b c : T * T) : T * T :=
  if negb (is_finite (fst a)) || negb (is_finite (fst b)) || negb (is_finite (fst c)) then interval_unknown T A
  else interval_checked T A v (below T A (fused_end (least T A) a b (fst c)))
                              (above T A (fused_end (most T A) a b (snd c))).
Definition interval_sqrt (x : T * (T * T)) : T * (T * T) :=
  let v := root (fst x) in (v, interval_square_root v (snd x)).
(** For every rule. *)
Definition product_is_zero (B : Type) (rule : rule T B) (a b : T * B) : bool :=
  is_zero T A (fst a) (tracked_error T A B rule a) || is_zero T A (fst b) (tracked_error T A B rule b).
Definition interval_fma (a b c : T * (T * T)) : T * (T * T) :=
  let v := fma T A (fst a) (fst b) (fst c) in
  if product_is_zero _ (interval_rule T A) a b && is_finite v then c
  else (v, interval_fused v (snd a) (snd b) (snd c)).

Section Functions.

Variable B : Type.

Section One_rule.

Variable R : operations T B.
Notation rule := (the_rule T B R).
Notation number := (T * B)%type.
Notation exactly := (tracked_exactly T B rule).
Notation error_of := (tracked_error T A B rule).
Notation subtract := (tracked_subtract T A B rule).
Notation add := (tracked_add T A B R).
Notation multiply := (tracked_multiply T A B R).

(** For a rule with quotients. *)
Definition tracked_divide (a b : number) : number :=
  let v := fst a / fst b in
  match rule_divide T B R with
  | Some divide => (v, divide v (fst a) (snd a) (fst b) (snd b))
  | None => tracked_within T B rule (fst b) (infinity T A)
  end.

Definition closer (by_error by_slope : number) : number :=
  let most := error_of by_error in
  if (fst by_slope == fst by_error) && (error_of by_slope <= most + most / #8) then by_slope else by_error.

Definition no_root_slope (x root : number) : bool :=
  negb (snd (remainder_of_root (fst x) (fst root))) || (fst root == #0) || negb (is_finite (error_of root)).
Definition sqrt_by_slope (x root : number) : number :=
  if no_root_slope x root then root
  else
    let v := exactly (fst root) in
    let inherited := subtract x (exactly (fst x)) in
    let change := add inherited (exactly (fst (remainder_of_root (fst x) (fst root)))) in
    let divisor := add root v in
    let quotient := tracked_divide change divisor in
    add v quotient.

Definition no_fma_slope (a b c : number) : bool :=
  let product := two_product T A has_fast_fma (fst a) (fst b) in
  negb (product_error_is_exact T A has_fast_fma (fst a) (fst b) product) ||
  negb (is_finite (snd (two_sum T A (fst product) (fst c)))).
Definition fma_by_slope (a b c sum : number) : number :=
  if no_fma_slope a b c then sum
  else
    let product := two_product T A has_fast_fma (fst a) (fst b) in
    let total := two_sum T A (fst product) (fst c) in
    let v := exactly (fst sum) in
    let difference := subtract (exactly (fst total)) v in
    let partial := add difference (exactly (snd total)) in
    let rounding := add partial (exactly (snd product)) in
    let change_of_b := subtract b (exactly (fst b)) in
    let of_b := multiply a change_of_b in
    let change_of_a := subtract a (exactly (fst a)) in
    let of_a := multiply change_of_a (exactly (fst b)) in
    let change_of_c := subtract c (exactly (fst c)) in
    let products := add of_a of_b in
    let inherited := add products change_of_c in
    let change := add inherited rounding in
    add v change.

(** `crowded`: true if a bound becomes one source. *)
Definition slope_sqrt (crowded : B -> bool) (x : number) : number :=
  let root := tracked_sqrt T A has_fast_fma B rule x in
  let best := closer root (sqrt_by_slope x root) in
  if crowded (snd best) then tracked_within T B rule (fst best) (error_of best) else best.
Definition slope_fma (a b c : number) : number :=
  let v := fma T A (fst a) (fst b) (fst c) in
  if product_is_zero B rule a b && is_finite v then c
  else
    let sum := tracked_fma T A B rule a b c in
    closer sum (fma_by_slope a b c sum).

End One_rule.

Variable by_rule : nat -> operations T B.
Notation R := (by_rule O).
Notation rule := (the_rule T B R).
Notation number := (T * B)%type.
Notation exactly := (tracked_exactly T B rule).
Notation subtract := (numbered_subtract T A B by_rule).
Notation add := (numbered_add T A B by_rule).
Notation multiply := (numbered_multiply T A B by_rule).
Notation divide := (numbered_divide T A B by_rule).

Definition numbered_sqrt_by_slope (x root : number) : counted number :=
  if no_root_slope R x root then at_once root
  else
    let v := exactly (fst root) in
    let* inherited := subtract x (exactly (fst x)) in
    let* change := add inherited (exactly (fst (remainder_of_root (fst x) (fst root)))) in
    let* divisor := add root v in
    let* quotient := divide change divisor in
    add v quotient.
Definition numbered_slope_sqrt (crowded : B -> bool) (x : number) : counted number :=
  let* root := numbered_sqrt T A has_fast_fma B by_rule x in
  let* by_slope := numbered_sqrt_by_slope x root in
  let best := closer R root by_slope in
  if crowded (snd best) then numbered_within T B by_rule (fst best) (tracked_error T A B rule best) else at_once best.

Definition numbered_fma_by_slope (a b c sum : number) : counted number :=
  if no_fma_slope a b c then at_once sum
  else
    let product := two_product T A has_fast_fma (fst a) (fst b) in
    let total := two_sum T A (fst product) (fst c) in
    let v := exactly (fst sum) in
    let* difference := subtract (exactly (fst total)) v in
    let* partial := add difference (exactly (snd total)) in
    let* rounding := add partial (exactly (snd product)) in
    let* change_of_b := subtract b (exactly (fst b)) in
    let* of_b := multiply a change_of_b in
    let* change_of_a := subtract a (exactly (fst a)) in
    let* of_a := multiply change_of_a (exactly (fst b)) in
    let* change_of_c := subtract c (exactly (fst c)) in
    let* products := add of_a of_b in
    let* inherited := add products change_of_c in
    let* change := add inherited rounding in
    add v change.
Definition numbered_slope_fma (a b c : number) : counted number :=
  let v := fma T A (fst a) (fst b) (fst c) in
  if product_is_zero B rule a b && is_finite v then at_once c
  else
    let* sum := numbered_fma T A B by_rule a b c in
    let* by_slope := numbered_fma_by_slope a b c sum in
    at_once (closer R sum by_slope).

End Functions.
End Slopes.
