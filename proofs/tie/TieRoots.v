(** The components of root isolation, and first times in integers, as programs. Whole numbers are OCaml's big
    integers, and real numbers are Zarith's rationals. tests/proofs/tie_roots.cpp and tie_times.cpp compare the C++
    code with the results. (`none` of common roots is not the one of options: its constructors are polymorphic
    variants.) *)

From Coq Require Import Reals ZArith Extraction ExtrOcamlBasic ExtrOcamlNatInt ExtrOcamlZBigInt.
From Flocq Require Import Core.
From Errbound Require Dyadic PrimeField SignVariations ControlValues LocalForm TaylorCoefficients RootIsolation
  RootFinder TimeSearch VertexEdgeTime InteriorTime AxisUnits.

Extraction Blacklist Q.
(** Coq's construction of real numbers is extracted with their name; none of it is computed. *)
Extract Constant ClassicalDedekindReals.sig_forall_dec => "(fun _ -> assert false)".
Extract Inlined Constant R => "Q.t".
Extract Inlined Constant IZR => "Q.of_bigint".
Extract Inlined Constant Rlt_dec => "Q.lt".
Extract Inlined Constant Rle_dec => "Q.leq".
Extract Inlined Constant Req_EM_T => "Q.equal".
Extract Inlined Constant Rabs => "Q.abs".
Extract Inlined Constant Rdiv => "Q.div".
Extract Inlined Constant Rplus => "Q.add".
Extract Inlined Constant Rminus => "Q.sub".
Extract Inlined Constant Rmult => "Q.mul".
Extract Inlined Constant Ropp => "Q.neg".
Extract Inlined Constant pow => "(let rec pow x n = if n = 0 then Q.one else Q.mul x (pow x (n - 1)) in pow)".
Extract Inlined Constant bpow =>
  "(fun _ e -> let e = Big_int_Z.int_of_big_int e in if e < 0 then Q.div_2exp Q.one (- e) else Q.mul_2exp Q.one e)".
(** Faster than by single factors. *)
Extract Inlined Constant Z.pow => "(fun x n -> if Big_int_Z.sign_big_int n < 0 then Big_int_Z.zero_big_int
  else Big_int_Z.power_big_int_positive_big_int x n)".

Extract Inductive VertexEdge.kind_of_roots => "_" [ "`None" "`One" "`Of_quadratic" "`Everywhere" ].

Definition dyadic_made := Dyadic.made.
Definition dyadic_in_units := Dyadic.in_units.
Definition dyadic_opposite := Dyadic.opposite.
Definition dyadic_sum := Dyadic.sum.
Definition dyadic_difference := Dyadic.difference.
Definition dyadic_product := Dyadic.product.
Definition dyadic_scale := Dyadic.scale.
Definition dyadic_equal := Dyadic.equal.
Definition dyadic_order := Dyadic.order.
Definition dyadic_floor_log2 := Dyadic.floor_log2.

Definition field_one := PrimeField.one.
Definition field_add := PrimeField.add.
Definition field_subtract := PrimeField.subtract.
Definition field_multiply := PrimeField.multiply.
Definition field_multiply_and_subtract := PrimeField.multiply_and_subtract.
Definition field_to_form := PrimeField.to_form.
Definition field_from_form := PrimeField.from_form.
Definition field_power := PrimeField.power.
Definition field_value := PrimeField.value_modulo.

Definition row_cut := ControlValues.cut_row.
Definition row_cut_error := ControlValues.cut_error.
Definition row_left := ControlValues.left_row.
Definition row_right := ControlValues.right_row.
Definition row_error_after := ControlValues.error_after.

Definition form_derivative := RootFinder.derivative.
Definition form_mirrored := ControlValues.mirrored_integers.
Definition form_value := RootIsolation.poly.
Definition form_weights := ControlValues.weights.
Definition form_control_values := ControlValues.control_values_on.
Definition form_root_exponent := ControlValues.positive_root_exponent.
Definition form_half_line := ControlValues.half_line.
Definition form_upper_bound := ControlValues.upper_bound.
Definition form_keep_part (p : list Z) := RootIsolation.keep_part (RootIsolation.reals_of p).
Definition form_secant_part := RootIsolation.secant_part.

Definition local_taylor := TaylorCoefficients.taylor.
Definition local_bits_of := TaylorCoefficients.bits_of.
Definition local_quotient := TaylorCoefficients.quotient_of.
Definition local_part := LocalForm.part.
Definition local_part_error := LocalForm.part_error.
Definition local_cut := LocalForm.cut_all.
Definition local_cut_error := LocalForm.error_of_cut.
Definition local_row := LocalForm.integer_row.
Definition local_coefficients := LocalForm.coefficients.
Definition local_coefficients_error := LocalForm.coefficients_error.
Definition local_signs := LocalForm.signs.
Definition local_low_end := LocalForm.low_end_is_certain.
Definition local_high_end := LocalForm.high_end_is_certain.
Definition local_rootless := LocalForm.surely_rootless.

Extraction "roots.ml" dyadic_made dyadic_in_units dyadic_opposite dyadic_sum dyadic_difference dyadic_product
  dyadic_scale dyadic_equal dyadic_order dyadic_floor_log2
  field_one field_add field_subtract field_multiply field_multiply_and_subtract field_to_form field_from_form field_power
  field_value
  SignVariations.sign_variations SignVariations.max_sign_variations
  row_cut row_cut_error ControlValues.row_sign row_left row_right row_error_after
  form_derivative form_mirrored form_value form_weights form_control_values form_root_exponent form_half_line
  form_upper_bound form_keep_part form_secant_part
  local_taylor local_bits_of local_quotient local_part local_part_error local_cut local_cut_error local_row
  local_coefficients local_coefficients_error local_signs local_low_end local_high_end local_rootless.

Definition search_between := TimeSearch.between.

Extraction "times.ml" TimeSearch.double_of_order search_between VertexEdgeTime.first_vertex_edge_contact
  VertexEdgeTime.moving_component IntegerTimes.earlier IntegerTimes.composed IntegerTimes.last_of InteriorTime.find
  InteriorTime.inside_time InteriorContact.vertex_edge_queries AxisUnits.vertices_contact Decisions.difference
  Decisions.y_form Bernstein.certainly_rootless.
