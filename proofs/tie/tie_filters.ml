(* Writes the results of the proofs' definitions (filters.ml, extracted by TieFloats.v) for expressions of
   coordinates under static and semi-static filters: error counts of types, values, sizes, bounds and signs.
   tests/proofs/tie_filters.cpp does the same with the C++ templates, on the same numbers. *)
open Tie_hash
open Filters

type format = { name : string; p : int; emin : int; largest_exponent : int }
let formats =
  [ { name = "double"; p = 53; emin = -1074; largest_exponent = 1024 };
    { name = "float"; p = 24; emin = -149; largest_exponent = 128 } ]
let rounded f x = if f.p = 24 then Int32.float_of_bits (Int32.bits_of_float x) else x

(* Equal for both zeros, and for all NaN. *)
let put_number x = put_double (if Float.is_nan x then Int64.float_of_bits 0x7ff8000000000000L else x)
let put_sign = function
  | Negative -> put_word 0 | Zero -> put_word 1 | Positive -> put_word 2 | Uncertain -> put_word 3

let unit () = ldexp (float_of_int (draw (1 lsl 40))) (-40)

(* Three coordinates of each of five points: small and whole, of one size, about 1 except for a few ulps, with
   products that underflow or overflow, of every size; one NaN or the largest number. *)
let draw_numbers f =
  let mode = draw 8 in
  let e = match mode with
    | 2 -> draw 20 - 10 | 3 | 7 -> - draw f.largest_exponent | 4 -> draw f.largest_exponent | _ -> 0 in
  let number () = match mode with
    | 0 -> float_of_int (draw 7 - 3)
    | 1 -> 1. +. ldexp (float_of_int (draw 9)) (1 - f.p)
    | 2 | 3 | 4 -> ldexp (unit () -. 0.5) e
    | 5 -> let x = unit () -. 0.5 in ldexp x (draw (f.largest_exponent / 2) - (f.largest_exponent / 4))
    | 6 -> unit () -. 0.5
    | _ -> ldexp (float_of_int (draw 7 - 3)) e in
  let x = Array.make 15 0. in
  for i = 0 to 14 do x.(i) <- rounded f (number ()) done;
  if mode = 6 then begin
    let i = draw 15 in
    x.(i) <- (match draw 4 with
        | 0 -> infinity | 1 -> neg_infinity | 2 -> nan
        | _ -> ldexp (2. -. ldexp 1. (1 - f.p)) (f.largest_exponent - 1))
  end;
  x

let points x : point array = Array.init 5 (fun k -> fun i -> x.((3 * k) + i))

(* The number as an OCaml float. *)
let ieee x =
  if Float.is_nan x then Nan else if x = infinity then Plus_infinity
  else if x = neg_infinity then Minus_infinity else Finite x

let put_static f e =
  put_word (roundings f.p e); put_word (products e); put_bool (plain e);
  let value = value f.p f.emin e and size = size f.p f.emin e and bound = bound f.p f.emin e in
  put_number value; put_number size; put_number (full f.p f.emin size (products e)); put_number bound;
  put_sign (machine_sign f.p e (ieee value) (ieee bound))

(* The largest difference or single coordinate. *)
let rec largest f = function
  | Coordinate c -> if Float.is_nan c then 0. else abs_float c
  | Difference (a, b) -> let d = rounded f (a -. b) in if Float.is_nan d then 0. else abs_float d
  | Constant _ -> 0.
  | Sum (x, y) | Minus (x, y) | Product (x, y) -> Float.max (largest f x) (largest f y)
  | Negation x -> largest f x

let put_semi_static f e =
  put_word (roundings f.p e); put_word (degree e);
  put_number (value f.p f.emin e);
  if constants_not_zero e then begin
    put_number (mass f.p f.emin e);
    put_number (allowances f.p f.emin e)
  end;
  let m = largest f e in
  put_number m;
  put_number (if trusted f.p f.emin e then semi_static_bound f.p f.emin m e else infinity)

(* Expressions of points. *)
let predicates : (string * (point array -> expression)) list =
  [ "area", (fun q -> area q.(0) q.(1) q.(2));
    "volume", (fun q -> volume q.(0) q.(1) q.(2) q.(3));
    "lifted_area", (fun q -> lifted_area q.(0) q.(1) q.(2) q.(3) unweighted);
    "lifted_volume", (fun q -> lifted_volume q.(0) q.(1) q.(2) q.(3) q.(4) unweighted) ]

let c q k = Coordinate (q.(k) 0)
let d q k i = Difference (q.(k) i, q.(k + 1) i)
let whole n = Constant n
let homogeneous : (point array -> expression) list =
  [ (fun q -> c q 0);
    (fun q -> Negation (c q 0));
    (fun q -> d q 0 0);
    (fun q -> Negation (d q 0 0));
    (fun q -> Sum (c q 0, d q 0 1));
    (fun q -> Minus (d q 0 1, c q 0));
    (fun q -> Product (c q 0, c q 1));
    (fun q -> Negation (Minus (Product (c q 0, c q 0), Product (d q 0 1, c q 1))));
    (fun q -> Product (Product (c q 0, d q 0 1), Negation (c q 2)));
    (fun q -> Product (Sum (c q 0, Negation (d q 0 1)), Product (d q 1 0, d q 1 1)));
    (fun q ->
       let s = Sum (Product (c q 0, c q 1), Product (d q 0 1, d q 1 2)) in
       Product (Product (s, Minus (Product (c q 3, d q 0 2), Product (d q 1 1, d q 2 0))), s));
    (fun q ->
       let square = Product (d q 0 0, d q 0 0) in
       Product (Product (Product (square, square), square), d q 0 1));
    (fun q -> Product (d q 0 0, whole 3));
    (fun q -> Minus (Product (c q 0, whole (-7)), Product (d q 0 1, whole 16777217)));
    (fun q -> Product (Sum (Product (d q 0 0, whole 3), d q 0 1), whole 0));
    (fun q -> Product (Product (d q 0 0, whole 1048576), Product (d q 0 1, whole 8)));
    (fun q -> Product (Product (d q 0 0, whole 1048576), Product (d q 0 1, whole 16)));
    (fun q -> Product (Product (d q 0 0, whole 1048576), Product (d q 0 1, whole 32)));
    (* Allowances of 2^24. *)
    (fun q ->
       Sum (Product (Product (d q 0 0, d q 0 1), whole 2097152), Product (Product (d q 1 0, d q 1 1), whole 2097151)));
    (fun q ->
       let e = Product (Product (d q 0 0, whole 1048576), Product (d q 0 1, whole 1048576)) in
       Product (e, Product (e, d q 1 1))) ]
(* Expressions of mixed degree, which only static filters bound. *)
let mixed : (point array -> expression) list =
  [ (fun q -> Sum (c q 0, whole 5));
    (fun q -> Minus (c q 0, whole 16777217));
    (fun q -> Minus (whole 3, c q 1));
    (fun q -> Minus (Sum (Product (c q 0, c q 1), whole (-1)), whole 1));
    (fun q -> Minus (whole 1, Product (d q 0 0, d q 0 1)));
    (fun q -> Product (Sum (Product (c q 0, c q 1), whole 2147483647), Sum (d q 0 0, whole 0))) ]

let cases = 2000
let () =
  state := 1;
  List.iter (fun f ->
      let tied name put expression =
        line (Printf.sprintf "expression %s.%s" name f.name) cases
          (fun _ -> put f (expression (points (draw_numbers f)))) in
      let numbered name put =
        List.iteri (fun i e -> tied (Printf.sprintf "%s<%d>" name i) put e) in
      List.iter (fun (name, e) -> tied name put_static e) predicates;
      numbered "homogeneous" put_static homogeneous;
      numbered "mixed" put_static mixed;
      List.iter (fun (name, e) -> tied ("semi_static." ^ name) put_semi_static e) predicates;
      numbered "semi_static.homogeneous" put_semi_static homogeneous)
    formats
