(** Bernstein sign classification, polynomials, and the forms of queries and of predicates as a program, over the
    scalar of tie_symbols.ml. tests/proofs/tie_symbols.cpp compares the C++ templates with the results. No real
    number is computed. *)

From Coq Require Import Reals Extraction ExtrOcamlBasic ExtrOcamlNatInt ExtrOcamlZInt.
From Errbound Require Import Sign Bernstein BscCode.
From Errbound Require Decisions Predicates ImplicitPoints.

(** Coq's construction of real numbers is extracted with their name; none of it is computed. *)
Extract Constant ClassicalDedekindReals.sig_forall_dec => "(fun _ -> assert false)".
Extract Inlined Constant R => "unit".

Definition forms_difference := @Decisions.difference.
Definition forms_y := @Decisions.y_form.
Definition forms_inside_face := @Decisions.inside_face_forms.
Definition forms_inside_edges := @Decisions.inside_edges_forms.

Extraction "symbols.ml" root_with_nonnegative value_at product elevated derivative split halves sign_inside
  sign_throughout certainly_rootless forms_difference forms_y forms_inside_face forms_inside_edges
  Predicates.area Predicates.volume Predicates.lifted_area Predicates.lifted_volume Predicates.unweighted
  Predicates.power_incircle Predicates.power_insphere Predicates.weighted_degrees
  Predicates.compare_distances2d Predicates.compare_distances3d
  ImplicitPoints.orient2d_line_line ImplicitPoints.orient3d_line_plane ImplicitPoints.compare_x_line_line.
