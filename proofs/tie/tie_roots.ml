(* Writes the results of the proofs' definitions (roots.ml, extracted by TieRoots.v) for the components of root
   isolation. They are dyadic numbers, residues, sign variations, rows of Bernstein coefficients, polynomials, bounds
   of roots and their refinement, and local forms. tests/proofs/tie_roots.cpp does the same with the C++ code. *)
module Whole = Z
module Rational = Q
open Tie_hash
open Roots
module Z = Whole
module Q = Rational

let z = Z.of_int
(* Puts the sign, and words of 32 bits from the last. *)
let put_whole n =
  put_word (Z.sign n + 1);
  let rest = ref (Z.abs n) in
  while Z.sign !rest > 0 do
    put_word (Z.to_int (Z.logand !rest (z 0xffffffff)));
    rest := Z.shift_right !rest 32
  done
let put_all l = put_int (List.length l); List.iter put_whole l
let put_dyadic (n, e) = put_whole n; put_int (Z.to_int e)

(* Numbers: of `bits` bits, nonnegative; small, one word, longer, and zero. *)
let rec natural bits = if bits <= 0 then Z.zero else let upper = natural (bits - 30) in
    Z.add (Z.shift_left upper 30) (z (draw (1 lsl 30)))
let signed n = if draw 2 = 0 then n else Z.neg n
let whole () = match draw 5 with
  | 0 -> Z.zero | 1 | 2 -> z (draw 7 - 3) | 3 -> let n = natural 60 in signed n
  | _ -> let n = natural (30 * (1 + draw 10)) in signed n
let polynomial degree =
  let lower = List.init degree (fun _ -> whole ()) in
  let last = whole () in
  lower @ [ if Z.sign last = 0 then Z.one else last ]
let exponent () = z (draw 81 - 40)
let point () = let n = whole () in let e = exponent () in dyadic_made n e
let positive () = let n = natural 60 in let e = exponent () in dyadic_made (Z.succ n) e

let put_order c = put_word (match c with Lt -> 0 | Eq -> 1 | Gt -> 2)

let put_dyadics () =
  let n = whole () in
  let e = exponent () in
  let a = dyadic_made n e in
  let b = match draw 4 with 0 -> a | 1 -> dyadic_sum a (Z.one, exponent ()) | _ -> point () in
  List.iter put_dyadic
    [ a; dyadic_opposite a; dyadic_sum a b; dyadic_difference a b; dyadic_product a b; dyadic_made Z.one e;
      dyadic_scale (dyadic_sum a b) (z (-1)) ];
  put_dyadic (dyadic_scale a (exponent ()));
  put_bool (dyadic_equal a b);
  put_order (dyadic_order a b);
  if Z.sign n <> 0 then put_int (Z.to_int (dyadic_floor_log2 a));
  put_whole (dyadic_in_units a (Z.sub (snd a) (z (draw 50))));
  let u = positive () in
  let v = positive () in
  put_dyadic (let n, e = local_quotient (z (draw 100)) u v in dyadic_made n e)

let moduli = Array.map (fun k -> Z.sub (Z.shift_left Z.one 62) (z k)) [| 57; 87; 117; 143 |]
let modulus () = match draw 8 with
  | 4 -> z 3 | 5 -> z 5 | 6 -> Z.succ (Z.shift_left (Z.succ (z (draw (1 lsl 30)))) 1)
  | 7 -> Z.sub (Z.shift_left (Z.succ (natural 60)) 1) (z (-1)) | k -> moduli.(k)
let put_field () =
  let p = modulus () in
  let word () = match draw 5 with
    | 0 -> Z.zero | 1 -> Z.one | 2 -> Z.pred p | _ -> Z.rem (natural 60) p in
  let a = word () in
  let b = word () in
  let c = word () in
  let d = word () in
  List.iter put_whole
    [ field_one p; field_add p a b; field_subtract p a b; field_multiply p a b;
      field_multiply_and_subtract p a b c d; field_to_form p a; field_from_form p a ];
  let n = if draw 2 = 0 then z (draw 70) else natural 60 in
  put_whole (field_power p a n)
(* Residues that are factors of the modulus. *)
let put_zero_divisors () =
  let odd () = z ((2 * draw (1 lsl 29)) + 3) in
  let a = odd () in
  let b = odd () in
  put_whole (field_multiply (Z.mul a b) a b)
(* Residues of a multiple of the modulus, or next to one. *)
let put_residue () =
  let p = moduli.(draw 4) in
  let multiple = Z.mul (z (draw 5 - 2)) p in
  put_whole (Z.erem (Z.add multiple (z (draw 3 - 1))) p)
let put_value_modulo () =
  let p = moduli.(draw 4) in
  let f = polynomial (draw 6) in
  let n, e = point () in
  let put f = (* also its residues *)
    List.iter (fun c -> put_whole (Z.erem c p)) f;
    put_whole (field_value p n e (List.rev f)) in
  put f;
  (* A polynomial that is zero there: the power of two is a coefficient. *)
  let power = Z.shift_left Z.one (abs (Z.to_int e)) in
  put (if Z.sign e < 0 then [ Z.neg n; power ] else [ Z.neg (Z.mul n power); Z.one ])

let put_variations () =
  let count = 1 + draw 9 in
  let seldom = 2 + draw 6 in
  let signs = List.init count (fun _ -> z (if draw seldom = 0 then 0 else (2 * draw 2) - 1)) in
  put_int (sign_variations signs);
  put_int (max_sign_variations signs)

(* ---- Rows ---- *)

let bits_of x = Z.numbits (Z.abs x)
let words = 4
(* The constructor: rows of numbers of W words, rounded if they are longer, extended otherwise; zeros if the error is
   large. *)
let row_of b error =
  let excess = z (List.fold_left (fun m c -> max m (bits_of c)) 0 b - ((64 * words) - 3)) in
  let error = row_cut_error excess error in
  if Z.lt error (Z.shift_left Z.one 60) then row_cut excess b, error else List.map (fun _ -> Z.zero) b, Z.zero
(* The double of the number, by words from the first. *)
let nearby x =
  let rec sum n = if Z.sign n = 0 then 0. else
      (sum (Z.shift_right n 64) *. ldexp 1. 64) +. Z.to_float (Z.logand n (Z.pred (Z.shift_left Z.one 64))) in
  if Z.sign x < 0 then -. sum (Z.neg x) else sum x
let put_fixed_row (row, error) =
  put_int (List.length row);
  List.iter (fun x -> put_int (Z.to_int (row_sign error x)); put_double (nearby x)) row
(* Puts the row, and its halves a few times. *)
let put_halves b error =
  let degree = List.length b - 1 in
  let row = ref (row_of b error) in
  put_fixed_row !row;
  for _ = 1 to 1 + draw 6 do
    let row', error = !row in
    let error = row_error_after degree error in
    let left = row_left degree row', error and right = row_right degree row', error in
    put_fixed_row left; put_fixed_row right;
    row := if draw 2 = 0 then left else right
  done
let put_rows () =
  let b = polynomial (draw 9) in
  let b = if draw 3 = 0 then List.map (fun c -> Z.shift_left c 200) b else b in
  put_halves b (match draw 4 with 0 -> Z.zero | 1 -> z (draw 5) | 2 -> natural 60 | _ -> natural 270)
(* Errors that are small, or about once or twice the largest that a row keeps, and coefficients of that size. The
   last row is not rounded. *)
let put_row_edges () =
  let kind = draw 3 in
  let error = if kind = 0 then z (draw 5) else Z.add (Z.shift_left Z.one (59 + kind)) (z (draw 4 - 4)) in
  let count = 1 + draw 8 in
  let b = List.init count (fun _ -> let size = Z.add error (z (draw 16)) in signed size) in
  put_halves (b @ [ Z.shift_left Z.one 252 ]) error

(* ---- Polynomials ---- *)

let q_of (n, e) =
  let e = Z.to_int e in
  if e < 0 then Q.div_2exp (Q.of_bigint n) (- e) else Q.mul_2exp (Q.of_bigint n) e
let of_q x = dyadic_made (Q.num x) (z (1 - Z.numbits (Q.den x)))
let put_q x = put_dyadic (of_q x)
let less a b = dyadic_order a b = Lt
let put_exponent = function None -> put_word 0x80000000 | Some e -> put_int (Z.to_int e)
let put_of_degree degree =
  let p = polynomial degree in
  put_all (form_derivative p);
  put_all (form_mirrored p);
  put_exponent (form_root_exponent p);
  let x = point () in
  let value = form_value p (q_of x) in
  put_q value;
  put_word (Q.sign value + 1);
  let y = match draw 3 with 0 -> z 0, z 0 | 1 -> dyadic_sum x (Z.one, exponent ()) | _ -> point () in
  if not (dyadic_equal x y) then begin
    let low, high = if less x y then x, y else y, x in
    let width = dyadic_difference high low in
    let e = if Z.sign (fst low) = 0 then snd width else Z.min (snd low) (snd width) in
    let weights = List.map Q.of_bigint (form_weights (List.length p - 1)) in
    let units x = Q.of_bigint (dyadic_in_units x e) in
    put_all (List.map Q.num (form_control_values weights e (units low) (units width) (List.map Q.of_bigint p)))
  end
let put_polynomial () = put_of_degree (if draw 16 = 0 then 38 + draw 6 else draw 9)
(* A polynomial whose weights may exceed 64 bits. *)
let put_long_polynomial () = put_of_degree (44 + draw 8)
let put_empty_polynomial () =
  let value = form_value [] (q_of (if draw 2 = 0 then z 0, z 0 else point ())) in
  put_q value;
  put_word (Q.sign value + 1)

(* Irreducible by Eisenstein's criterion, so that no factor is removed. *)
let irreducible degree =
  let first = Z.succ (Z.mul (z 3) (z (draw 1000))) in
  let first = signed first in
  let between = List.init (degree - 1) (fun _ -> Z.mul (z 3) (whole ())) in
  let last = signed Z.one in
  (Z.mul (z 3) first :: between) @ [ last ]
let put_half_lines () =
  let p = irreducible (1 + draw 7) in
  put_q (form_upper_bound p);
  put_q (Q.neg (form_upper_bound (form_mirrored p)));
  (* Without bounds, it is computed from the root exponent only. *)
  let least p = match form_half_line p with
    | Some (low, _) -> low
    | None ->
      let lower = match form_root_exponent (List.rev p) with Some e -> Z.neg e | None -> Z.one in
      q_of (z 45, Z.sub lower (z 6)) in
  put_q (least p);
  put_q (Q.neg (least (form_mirrored p)))

(* True if refine keeps the subinterval, not its complement. *)
let keep p i bits =
  let value x = of_q (form_value p x) in
  let at_low = value i.low and at_high = value i.high in
  let unit = Z.min (snd at_low) (snd at_high) in
  let parts = Z.shift_left Z.one bits in
  let k = form_secant_part (Z.abs (dyadic_in_units at_low unit)) (Z.abs (dyadic_in_units at_high unit)) parts in
  let place k = Q.add i.low (Q.mul (Q.sub i.high i.low) (Q.div_2exp (Q.of_bigint k) bits)) in
  let left = place k and right = place (Z.succ k) in
  let kept = form_keep_part p i left right in
  kept, Q.leq left kept.low && Q.leq kept.high right
let rec refine p i width bits =
  if not (Q.lt width (Q.sub i.high i.low)) then i
  else
    let i, kept = keep p i bits in
    refine p i width (if kept then 2 * bits else max 1 (bits / 2))
let half i = Q.div_2exp (Q.sub i.high i.low) 1
let put_interval i = put_q i.low; put_q i.high
let put_refined_between p a b =
  let i = { low = Q.min a b; high = Q.max a b } in
  if Q.sign (form_value p i.low) * Q.sign (form_value p i.high) < 0 then begin
    let once = refine p i (half i) 1 in
    put_interval once;
    put_interval (refine p once (half once) 1);
    put_interval (refine p i (Q.div_2exp (Q.sub i.high i.low) (draw 200)) 1)
  end
let put_refined () =
  let p = irreducible (if draw 2 = 0 then 1 else 1 + draw 7) in
  let e = draw 30 - 20 in
  let a = draw 4000 - 2000 in
  let b = draw 4000 - 2000 in
  put_refined_between p (q_of (z a, z e)) (q_of (z b, z e))
(* A whole root, where two subintervals meet after halvings. *)
let put_whole_root () =
  let q = irreducible (2 + draw 3) in
  let root = z (draw 2000 - 1000) in
  let p = List.map2 (fun x y -> Z.sub x (Z.mul root y)) (Z.zero :: q) (q @ [ Z.zero ]) in
  let bits = draw 8 in
  let low = Z.sub root (z (1 + draw (1 lsl bits))) in
  put_refined_between p (Q.of_bigint low) (Q.of_bigint (Z.add low (z (2 lsl bits))))

(* ---- Local forms ---- *)

type local = { degree : int; a : Z.t list; error : Z.t }
let put_local f =
  let size = List.fold_left (fun m x -> max m (bits_of x)) 0 f.a in
  let row error a = put_all (local_row f.degree a); put_whole error in
  row f.error f.a;
  let bits = draw 120 in
  let excess = z (max 0 (size - bits)) in
  let a = local_cut excess f.a and error = local_cut_error excess f.error in
  row error a;
  put_all (local_coefficients f.degree a);
  put_whole (local_coefficients_error f.degree error);
  List.iter (fun s -> put_int (Z.to_int s)) (local_signs f.degree a error);
  put_bool (local_rootless f.degree f.a f.error);
  put_bool (local_low_end f.a f.error);
  put_bool (local_high_end f.degree f.a f.error)
(* part, and drop_small_terms (dropped_right). *)
let part f from length depth =
  let a = local_part from length (z depth) f.a in
  let error = local_part_error f.degree (z (List.length f.a)) f.error in
  let rec dropped = function
    | last :: (_ :: _ :: _ as rest) when Z.leq (Z.abs last) error -> dropped rest
    | a -> a in
  let kept = List.rev (dropped (List.rev a)) in
  { f with a = kept; error = if List.length kept < List.length a then Z.shift_left error 1 else error }
let draw_part f =
  let depth = 1 + draw 8 in
  let from = draw (1 lsl depth) in
  let length = 1 + draw ((1 lsl depth) - from) in
  part f (z from) (z length) depth
(* Subintervals, and subintervals of them. *)
let put_parts p low width bits =
  let a, error = local_taylor p low width (z bits) in
  let f = { degree = List.length p - 1; a; error } in
  put_local f;
  let once = draw_part f in
  put_local once;
  put_local (draw_part once)
let put_near () =
  let degree = if draw 10 = 0 then 30 else draw 9 in
  let p = polynomial degree in
  let low = positive () in
  let n = natural 30 in
  let ratio = draw 100 - 90 in
  let width = dyadic_made (Z.succ n) (Z.sub (Z.add (dyadic_floor_log2 low) (z ratio)) (z (Z.numbits (Z.succ n)))) in
  let bits = [| 0; 20; 64; 256 |].(draw 4) in
  put_parts p low width (bits + draw 10)
(* A polynomial of few bits, which the numerators of powers of `low` just exceed. *)
let put_near_small () =
  let p = polynomial (if draw 4 = 0 then 30 else draw 5) in
  let numerator = (2 * draw 4) + 1 in
  let low = z numerator, exponent () in
  let size = Z.sub (dyadic_floor_log2 low) (z (2 + draw 8)) in
  let width = dyadic_made (z (1 + draw 8)) size in
  put_parts p low width (draw 16)
(* c + 2^20·(x - 1), or its negative, whose values are about as large as the error. *)
let put_near_error () =
  let bits = 4 + draw 8 in
  let slope = signed (z (1 lsl 20)) in
  let c = z (draw 140 lsl (18 - bits)) in
  let width = dyadic_made (z (1 + draw 63)) (z (- bits - 2)) in
  put_parts [ Z.sub c slope; slope ] (Z.one, Z.zero) width bits
(* d·(x - 1)^2 + 2^20·(x - 1), whose last term is about as large as the error. *)
let put_near_small_term () =
  let size = z (1 + draw (1 lsl 20)) in
  let d = signed size in
  let slope = z (1 lsl 20) in
  let width = dyadic_made (z (1 + draw (1 lsl 10))) (z (-12)) in
  put_parts [ Z.sub d slope; Z.sub slope (Z.mul (z 2) d); d ] (Z.one, Z.zero) width (13 + draw 4)
(* 24·(x - c)^2 + d, or its negative. Its Bernstein coefficients have one sign if d is large; for smaller d, only
   those of higher degree. *)
let put_near_minimum () =
  let low = 1 + draw 1000 in
  let d = draw 32 in
  let c = low + 1 in
  let factor = signed Z.one in
  let p = List.map (fun x -> Z.mul factor (z x)) [ (24 * c * c) + d; -48 * c; 24 ] in
  put_parts p (dyadic_made (z low) Z.zero) (Z.one, Z.one) 40
(* (x - low)^3, whose signs are all uncertain. *)
let put_near_triple_root () =
  let low = 1 + draw 1000 in
  let width = Z.one, z (-90 - draw 10) in
  let p = List.map z [ - low * low * low; 3 * low * low; -3 * low; 1 ] in
  put_parts p (dyadic_made (z low) Z.zero) width (draw 8)

let () =
  state := 1;
  let tied name cases put = line ("roots " ^ name) cases (fun _ -> put ()) in
  tied "dyadic" 4000 put_dyadics;
  tied "field" 4000 put_field;
  tied "value_modulo" 1000 put_value_modulo;
  tied "variations" 5000 put_variations;
  tied "row" 1000 put_rows;
  tied "polynomial" 2000 put_polynomial;
  tied "half_line" 1000 put_half_lines;
  tied "refine" 2000 put_refined;
  tied "near" 1500 put_near;
  tied "zero_divisor" 100 put_zero_divisors;
  tied "residue" 100 put_residue;
  tied "row_edge" 1000 put_row_edges;
  tied "whole_root" 500 put_whole_root;
  tied "long_polynomial" 20 put_long_polynomial;
  tied "empty_polynomial" 10 put_empty_polynomial;
  tied "near_small" 1000 put_near_small;
  tied "near_error" 1000 put_near_error;
  tied "near_small_term" 3000 put_near_small_term;
  tied "near_minimum" 200 put_near_minimum;
  tied "near_triple_root" 500 put_near_triple_root
