(** The filter in doubles, the axes in single precision, and the filters of predicates' expressions as programs. Real
    numbers are OCaml's floats. A rounding to double is the identity, since their operations round to double; a
    rounding to float is one. Sums and products of floats are the same if rounded to double before.
    tests/proofs/tie_floats.cpp and tie_filters.cpp compare the C++ templates with the results. *)

From Coq Require Import Reals Qreals ZArith Extraction ExtrOcamlBasic ExtrOcamlNatInt ExtrOcamlZInt.
From Flocq Require Import Core.
From Errbound Require Format ErrorCount CcdFilter FilterStages RoundedAxes ContactPart
  StaticFilter SemiStatic Predicates.

(** Coq's construction of real numbers is extracted with their name; none of it is computed. *)
Extract Constant ClassicalDedekindReals.sig_forall_dec => "(fun _ -> assert false)".
Extract Inlined Constant R => "float".
Extract Inlined Constant IZR => "float_of_int".
Extract Inlined Constant Q2R => "(fun q -> float_of_int q.qnum /. float_of_int q.qden)".
Extract Inlined Constant Rlt_dec => "(fun (a : float) b -> a < b)".
Extract Inlined Constant Rle_dec => "(fun (a : float) b -> a <= b)".
Extract Inlined Constant Rlt_bool => "(fun (a : float) b -> a < b)".
Extract Inlined Constant Rle_bool => "(fun (a : float) b -> a <= b)".
Extract Inlined Constant Req_bool => "(fun (a : float) b -> a = b)".
Extract Inlined Constant INR => "float_of_int".
Extract Inlined Constant Rabs => "abs_float".
Extract Inlined Constant Rmax => "(fun (a : float) b -> if a <= b then b else a)".
Extract Inlined Constant Rmin => "(fun (a : float) b -> if a <= b then a else b)".
Extract Inlined Constant Rplus => "(+.)".
Extract Inlined Constant Rminus => "(-.)".
Extract Inlined Constant Rmult => "( *. )".
Extract Inlined Constant Rdiv => "(/.)".
Extract Inlined Constant Ropp => "(~-.)".
Extract Inlined Constant bpow => "(fun _ e -> ldexp 1. e)".
Extract Inlined Constant Format.rnd =>
  "(fun p _ _ x -> if p = 24 then Int32.float_of_bits (Int32.bits_of_float x) else x)".
Extract Inlined Constant Znearest => "(fun _ (_ : float) -> 0)".

Definition halves_in_doubles (direction : R -> Z) := Subdivision.halves 0%R (FilterStages.midpoint direction).
(** FilterStages.hopeless with `deepest` allowed halvings. *)
Definition hopeless_before (deepest : nat) (error : R) (more : nat) (y : list R) : bool :=
  ((3 <=? deepest - S more)%nat && FilterStages.within_error error y)%bool.

Extraction "floats.ml" FilterStages.filter_face FilterStages.filter_edges hopeless_before FilterStages.halvings
  CcdFilter.y_relative CcdFilter.y_absolute CcdFilter.g_relative CcdFilter.g_absolute
  halves_in_doubles ContactPart.changes_sign_once RoundedAxes.separated_in_float RoundedAxes.frame_of
  RoundedAxes.rounded_point RoundedAxes.face_gap RoundedAxes.edges_gap.

Extraction "filters.ml" StaticFilter.roundings StaticFilter.products StaticFilter.plain StaticFilter.value
  StaticFilter.size StaticFilter.full StaticFilter.bound StaticFilter.machine_sign
  SemiStatic.degree SemiStatic.mass SemiStatic.allowances SemiStatic.constants_not_zero SemiStatic.trusted
  SemiStatic.semi_static_bound
  Predicates.area Predicates.volume Predicates.lifted_area Predicates.lifted_volume
  Predicates.unweighted.
