(** The definitions of Code.v, CompoundCode.v, SlopeCode.v, RelativeCode.v and AffineCode.v over IEEE floats, and
    those of integers of words, as a program. tie.ml evaluates them on tiny formats, float, double, and integers of
    up to four words. tests/errbound/validation/tie_test.cpp compares the C++ code with the results. *)

From Coq Require Import ZArith Extraction ExtrOcamlBasic.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code CompoundCode RelativeCode AffineCode SlopeCode Ieee.
From Errbound Require Words WordBits SparseProduct.

Section Bits.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax}.

(** The fields of an IEEE 754 float: sign, exponent, fraction. There is one NaN. *)
Definition least_normal : Z := 2 ^ (p - 1).
Definition sign_bit : Z := 2 * emax * least_normal.
Definition code_of_infinity : Z := sign_bit - least_normal.
Definition code_of_float (x : binary_float p emax) : Z :=
  let signed (s : bool) (n : Z) := if s then (sign_bit + n)%Z else n in
  match x with
  | B754_zero s => signed s 0%Z
  | B754_infinity s => signed s code_of_infinity
  | B754_nan => (code_of_infinity + 1)%Z
  | B754_finite s m e _ => signed s ((e - (3 - emax - p)) * least_normal + Zpos m)%Z
  end.
Definition float_of_code (c : Z) : binary_float p emax :=
  let s := (sign_bit <=? c)%Z in
  let n := if s then (c - sign_bit)%Z else c in
  if (code_of_infinity <? n)%Z then B754_nan
  else if (n =? code_of_infinity)%Z then B754_infinity s
  else
    let e := Z.max 1 (n / least_normal) in
    let m := (n - (e - 1) * least_normal)%Z in
    binary_normalize p emax p_positive p_below mode_NE (if s then (- m)%Z else m) (e - 1 + (3 - emax - p)) s.

End Bits.

Definition words_sum := Words.sum.
Definition words_difference := Words.difference.
Definition words_product := Words.product.
Definition words_sparse_product := SparseProduct.sparse_product.
Definition words_shift := Words.shifted.
Definition words_compare := Words.compare.
Definition words_bit_length := WordBits.bit_length.
Definition words_from_bit := WordBits.from_bit.
Definition words_shifted := WordBits.shifted.

Extraction "code.ml" code_of_float float_of_code floats
  sign_of none_error
  tight_exact tight_within tight_add tight_multiply tight_divide tight_scale
  sharp_add sharp_multiply sharp_divide sharp_scale
  safe_exact safe_within safe_error safe_add safe_multiply safe_scale
  interval_exact interval_within interval_error interval_sign interval_add interval_subtract
  interval_multiply interval_divide interval_scale
  residual_exact residual_within residual_error residual_sign residual_add residual_subtract
  residual_multiply residual_divide residual_scale
  two_sum two_product product_error_is_exact remainder_of_division
  tight_rule sharp_rule safe_rule interval_rule residual_rule
  tracked_exactly tracked_error tracked_negate tracked_sqrt tracked_abs tracked_min tracked_max tracked_fma
  tight_operations sharp_operations safe_operations interval_operations residual_operations
  interval_sqrt interval_fma slope_sqrt slope_fma
  tracked_midpoint tracked_lerp tracked_hypot tracked_copysign tracked_pow tracked_dot tracked_horner
  tight_most tight_dot sharp_most sharp_dot exponent
  constant relative_operations relative_dot
  affine_exact affine_within affine_negate affine_add affine_subtract affine_multiply affine_divide affine_scale
  words_sum words_difference words_product words_sparse_product words_shift words_compare
  words_bit_length words_from_bit words_shifted.
