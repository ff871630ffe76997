(** The decision in integers, and integers of words, as programs. Whole numbers, and real numbers that are whole, are
    OCaml's big integers. tests/proofs/tie_integers.cpp and tie_words.cpp compare the C++ code with the results.
    (`none` of roots is not the one of options: its constructors are polymorphic variants.) *)

From Coq Require Import Reals ZArith Extraction ExtrOcamlBasic ExtrOcamlNatInt ExtrOcamlZBigInt.
From Errbound Require VertexEdge InteriorContact CloseContact AxisUnits Words WordBits SparseProduct.

(** Coq's construction of real numbers is extracted with their name; none of it is computed. *)
Extract Constant ClassicalDedekindReals.sig_forall_dec => "(fun _ -> assert false)".
Extract Inlined Constant R => "Big_int_Z.big_int".
Extract Inlined Constant IZR => "(fun n -> n)".
Extract Inlined Constant Rlt_dec => "Big_int_Z.lt_big_int".
Extract Inlined Constant Rle_dec => "Big_int_Z.le_big_int".
Extract Inlined Constant Req_EM_T => "Big_int_Z.eq_big_int".
Extract Inlined Constant Rabs => "Big_int_Z.abs_big_int".
Extract Inlined Constant Rplus => "Big_int_Z.add_big_int".
Extract Inlined Constant Rminus => "Big_int_Z.sub_big_int".
Extract Inlined Constant Rmult => "Big_int_Z.mult_big_int".
Extract Inlined Constant Ropp => "Big_int_Z.minus_big_int".
Extract Inlined Constant pow => "Big_int_Z.power_big_int_positive_int".
(** Faster than by single factors and bits. *)
Extract Inlined Constant Z.pow => "(fun x n -> if Big_int_Z.sign_big_int n < 0 then Big_int_Z.zero_big_int
  else Big_int_Z.power_big_int_positive_big_int x n)".
Extract Inlined Constant Z.log2 => "(fun x ->
  let rec log2 x = if Big_int_Z.le_big_int x Big_int_Z.unit_big_int then 0
    else 1 + log2 (Big_int_Z.shift_right_big_int x 1) in
  let whole = 64 * (Big_int_Z.num_digits_big_int x - 1) in
  if Big_int_Z.sign_big_int x <= 0 then Big_int_Z.zero_big_int
  else Big_int_Z.big_int_of_int (whole + log2 (Big_int_Z.shift_right_big_int x whole)))".
Extract Inductive VertexEdge.kind_of_roots => "_" [ "`None" "`One" "`Of_quadratic" "`Everywhere" ].

Definition edge_contact := InteriorContact.edge_contact.
Definition decide_once := InteriorContact.contact_of.
Definition decide_to_the_end := CloseContact.decide_to_the_end.
Definition vertices_contact := AxisUnits.vertices_contact.
Definition bounded_sum := BoundedInteger.add.
Definition bounded_difference := BoundedInteger.sub.
Definition bounded_product := BoundedInteger.mul.
Definition bounded_sign := BoundedInteger.sign_of.

Extraction "integers.ml" decide_once decide_to_the_end edge_contact vertices_contact
  bounded_sum bounded_difference bounded_product bounded_sign.

(** Integers with as many words as necessary. *)
Definition word_from_bit (x : list Z) (shift : Z) := WordBits.from_bit x shift 1.

Extraction "words.ml" Words.long_sum Words.long_difference Words.sign_of Words.signed_words SparseProduct.count_filled
  SparseProduct.any_product SparseProduct.long_product WordBits.long_bit_length WordBits.long_shifted word_from_bit.
