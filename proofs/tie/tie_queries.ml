(* Inputs of ties, and floating-point estimates of roots, copied from ccd/exact/cubic_roots.hpp, since theorems hold for
   any estimates. Shared by tie_integers.ml, tie_floats.ml and tie_times.ml. *)
open Tie_hash

(* ---- Estimates ---- *)

let bit_length x = Z.numbits (if Z.sign x < 0 then Z.lognot x else x)

(* All numbers in floating point, times one power of two. *)
let approximated numbers =
  let bits = List.fold_left (fun m x -> max m (bit_length x)) 0 numbers in
  let shift = max 0 (bits - 63) in
  Array.of_list (List.map (fun x -> Int64.to_float (Z.to_int64 (Z.shift_right x shift))) numbers)

let cubic_at h s t = ((((h.(0) *. s) +. (h.(1) *. t)) *. s +. (h.(2) *. t *. t)) *. s) +. (h.(3) *. t *. t *. t)

let estimated_root h =
  let precision = ldexp 1. (-52) and converged = ldexp 1. (-30) in
  let rising = h.(3) > h.(0) in
  let rec step k low high t =
    if k >= 60 || not (high -. low > precision) then t
    else
      let s = 1. -. t in
      let value = cubic_at h s t in
      let slope = ((h.(1) -. (3. *. h.(0))) *. s *. s) +. (2. *. (h.(2) -. h.(1)) *. s *. t)
                  +. (((3. *. h.(3)) -. h.(2)) *. t *. t) in
      if value = 0. then t
      else
        let low, high = if value < 0. = rising then t, high else low, t in
        let newton = t -. (value /. slope) in
        let inside = newton > low && newton < high in
        let next = if inside then newton else (low +. high) /. 2. in
        if abs_float (next -. t) <= (if inside then converged else precision) then next
        else step (k + 1) low high next in
  step 0 0. 1. (if h.(0) = 0. || h.(3) = 0. then 0.5 else h.(0) /. (h.(0) -. h.(3)))

let whole_part x = Z.of_int64 (Int64.of_float x)

let estimated_place level index part_y =
  let to_bits = min (level + 48) 62 - level in
  Z.add (Z.shift_left index to_bits) (whole_part (ldexp (estimated_root (approximated part_y)) to_bits))

let thrice x = Z.mul (Z.of_int 3) x
(* A form's value, by Horner's rule. *)
let value_at form s t =
  let rec from_term sum power = function
    | [] -> sum
    | a :: rest -> from_term (Z.add (Z.mul sum s) (Z.mul a power)) (Z.mul power t) rest in
  from_term (List.hd form) t (List.tl form)

(* refined_place: the position from a bracket. *)
let refined_place y low high bits =
  let end_ = Z.shift_left Z.one bits in
  let y0, y1, y2, y3 = match y with [ a; b; c; d ] -> a, b, c, d | _ -> assert false in
  let slope = [ Z.sub y1 (thrice y0); Z.shift_left (Z.sub y2 y1) 1; Z.sub (thrice y3) y2 ] in
  let width = Z.sub high low in
  let value form place = value_at form (Z.sub end_ place) place in
  let y_low = value y low and y_high = value y high in
  let h = [ y_low; Z.add (thrice y_low) (Z.mul width (value slope low));
            Z.sub (thrice y_high) (Z.mul width (value slope high)); y_high ] in
  let more = 46 - Z.numbits width in
  Z.add (Z.shift_left low more)
    (whole_part (ldexp (Z.to_float width *. estimated_root (approximated h)) more))

(* ---- Inputs, written by tests/proofs/tie_inputs.cpp ---- *)

let token () = Scanf.scanf " %s" Fun.id
(* In two's complement, of any number of words. *)
let read_whole () =
  let text = token () in
  let n = Z.of_string_base 16 text in
  if text.[0] >= '8' then Z.sub n (Z.shift_left Z.one (4 * String.length text)) else n
let read_int () = Z.to_int (read_whole ())
let read_bool () = read_int () = 1
let read_double () = Int64.float_of_bits (Int64.of_string ("0x" ^ token ()))
let read_all n read = Array.init n (fun _ -> read ())

(* given.(6 p + 3 e + k) is coordinate k of point p at end e; all are between both ends of the box. *)
type query = { two_edges : bool; given : float array; box_low : float array; box_high : float array }
let read_query () =
  let two_edges = read_bool () in
  let given = read_all 24 read_double in
  let box_low = read_all 3 read_double in
  { two_edges; given; box_low; box_high = read_all 3 read_double }
let read_whole_query () = let q = read_query () in q.two_edges, q.given

(* vectors.(i).(x): from start to end. A subinterval of the step: its level, the path to it if no sign change
   determines it, and the distance from the root's expected position there. The root of all as a quotient. A position
   there: its number of words, and `cut`. *)
type drawn_forms = { on_edges : bool; vectors : (Z.t * Z.t) array array; part_level : int; path : int; off : int;
                     root : Z.t; root_unit : Z.t; words : int; cut : int }
let read_vectors () =
  read_all 3 (fun () -> read_all 3 (fun () -> let start = read_whole () in start, read_whole ()))
let read_forms () =
  let on_edges = read_bool () in
  let vectors = read_vectors () in
  let part_level = read_int () in
  let path = read_int () in
  let off = read_int () in
  let root = read_whole () in
  let root_unit = read_whole () in
  let words = read_int () in
  { on_edges; vectors; part_level; path; off; root; root_unit; words; cut = read_int () }

(* Small vectors, p zero at the start. A subinterval from there: its bits, the position of a cubic's root in it, and
   the bits from which weights are tested. Numbers at the limit of can_be_narrowed, and a cubic with two close roots. *)
type drawn_deep = { deep_edges : bool; small : (Z.t * Z.t) array array; deep_bits : int; root_bits : int; deep_from : int;
                    limit_unit_bits : int; limit_bits : int; limit_index : int; limit_negative : bool; pair : Z.t list }
let read_deep () =
  let deep_edges = read_bool () in
  let small = read_vectors () in
  let n = read_all 6 read_int in
  let limit_negative = read_bool () in
  { deep_edges; small; deep_bits = n.(0); root_bits = n.(1); deep_from = n.(2); limit_unit_bits = n.(3);
    limit_bits = n.(4); limit_index = n.(5); limit_negative; pair = Array.to_list (read_all 4 read_whole) }

(* The most bits of an axis' coordinates. *)
let bits_along f x =
  Array.fold_left (fun most v -> let a, b = v.(x) in max most (max (bit_length a) (bit_length b))) 0 f.vectors

(* Three quadratics, and one more. *)
let read_quadratics () =
  let forms = read_all 3 (fun () -> read_all 3 read_int) in
  Array.to_list forms, read_all 3 read_int

(* The roots of a product of linear forms, over 2^bits, an interval with one sign change, and an estimate. *)
type drawn_search = { search_roots : int list; search_bits : int; search_low : int; search_high : int;
                      search_estimate : int; search_negative : bool }
let read_search () =
  let degree = read_int () in
  let search_roots = List.filteri (fun i _ -> i < degree) (Array.to_list (read_all 3 read_int)) in
  let n = read_all 4 read_int in
  { search_roots; search_bits = n.(0); search_low = n.(1); search_high = n.(2); search_estimate = n.(3);
    search_negative = read_bool () }

(* Two values and the bits of their errors. *)
let read_bounded () =
  let number () = let value = read_whole () in value, read_int () in
  let a = number () in
  a, number ()

(* ---- Units, as in axis_units.hpp ---- *)

let last_bit x =
  let mantissa, exponent = Float.frexp x in
  let n = Z.of_float (ldexp mantissa 53) in
  exponent - 53 + Z.trailing_zeros n

(* For `count` points. *)
let axis count x k =
  let at p e = x.((6 * p) + (3 * e) + k) in
  let all e = List.init count (fun p -> at p e) in
  let nonzero = List.filter (fun v -> v <> 0.) (all 0 @ all 1) in
  let extent e = List.fold_left Float.max neg_infinity (all e) -. List.fold_left Float.min infinity (all e) in
  match nonzero with
  | [] -> 0, 0
  | _ ->
      let unit = List.fold_left (fun m v -> min m (last_bit v)) max_int nonzero in
      let extent = Float.max (extent 0) (extent 1) in
      let end_bit = if extent = infinity then 1025 else snd (Float.frexp extent) in
      unit, (if extent = 0. then 0 else max 0 (end_bit - unit))

type decided = { edges : bool; units : (int * int) array; whole : Z.t array }

(* In integer units; the bits shifted out are zeros. *)
let in_units unit v =
  let mantissa, exponent = Float.frexp v in
  let size = Z.of_float (ldexp mantissa 53) and shift = exponent - 53 - unit in
  if shift < 0 then Z.shift_right size (- shift) else Z.shift_left size shift
let integers_of ?(count = 4) edges x =
  let units = Array.init 3 (axis count x) in
  { edges; units; whole = Array.mapi (fun i v -> in_units (fst units.(i mod 3)) v) (Array.sub x 0 (6 * count)) }
