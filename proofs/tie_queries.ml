(* Queries in integers, and floating-point estimates of their roots, copied from ccd/exact/cubic_roots.hpp, since
   theorems hold for any estimates. Shared by tie_integers.ml and tie_times.ml. *)
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

(* ---- Queries, as in whole_query.hpp ---- *)

let sizes = [| 1; 2; 3; 5; 9; 30; 1000; 1 lsl 20; 1 lsl 40 |]
let pick size = draw ((2 * size) + 1) - size

(* The position at t = k/8, times 8. *)
let place c k p x = ((8 - k) * c.((6 * p) + x)) + (k * c.((6 * p) + 3 + x))

(* Point 0 is at a position of the face, or the edges cross there, at t = k/8; or they miss it slightly. *)
let meet c edges size sometimes_off on_border =
  let k = draw 9 in
  let a = if on_border then 0 else draw 5 in
  let b = if edges then 1 + draw 4 else draw (5 - a) in
  let off () = if sometimes_off && draw 8 = 0 then pick 1 else 0 in
  let moved = if edges then 3 else 0 in
  for x = 0 to 2 do
    let at p = place c k p x in
    let target, factor =
      if edges then ((4 - a) * at 0) + (a * at 1) - ((4 - b) * at 2), 8 * b
      else ((4 - a - b) * at 1) + (a * at 2) + (b * at 3), 32 in
    for p = 0 to 3 do
      if p <> moved then begin
        c.((6 * p) + x) <- factor * c.((6 * p) + x);
        c.((6 * p) + 3 + x) <- factor * c.((6 * p) + 3 + x)
      end
    done;
    let m = pick size in
    let at_start = target + (k * m) + off () in
    let at_end = target - ((8 - k) * m) + off () in
    c.((6 * moved) + x) <- at_start;
    c.((6 * moved) + 3 + x) <- at_end
  done

(* Y is almost the product of three linear forms of the rows P, B and C, with roots close to k/8. Other entries of
   the rows are small. *)
let near_roots c edges =
  let k = draw 9 in
  let large = 1 lsl draw 31 in
  let rows = Array.init 3 (fun _ -> Array.make 6 0) in
  for i = 0 to 2 do
    for x = 0 to 2 do
      for e = 0 to 1 do
        let little = if draw 2 = 0 then 0 else pick 2 in
        rows.(i).((3 * e) + x) <- little + (if i = x then large * (k - (8 * e)) else 0)
      done
    done
  done;
  let place p from row = for i = 0 to 5 do c.((6 * p) + i) <- c.((6 * from) + i) + rows.(row).(i) done in
  if edges then begin place 1 0 1; place 2 0 0; place 3 2 2 end
  else begin place 0 1 0; place 2 1 1; place 3 1 2 end

let whole_query mode edges =
  let size = match mode with
    | 0 | 1 | 2 -> sizes.(draw 4) | 3 -> sizes.(draw 9) | 4 | 5 | 6 | 7 | 8 -> sizes.(3 + draw 6)
    | _ -> 1 + draw 8 in
  let c = Array.make 24 0 in
  for i = 0 to 23 do c.(i) <- if mode >= 9 && draw 2 = 0 then 0 else pick size done;
  (match mode with
   | 4 -> for i = 0 to 7 do c.((3 * i) + 2) <- if draw 4 = 0 then pick 1 else 0 done
   | 5 -> meet c edges size true false
   | 6 ->
       let p = draw 4 in
       let q = draw 4 in
       for i = 0 to 5 do c.((6 * p) + i) <- c.((6 * q) + i) + (if draw 3 = 0 then pick 1 else 0) done
   | 7 ->
       let d0 = pick size in
       let d1 = pick size in
       let d2 = pick size in
       let d = [| d0; d1; d2 |] in
       for p = 0 to 3 do
         for x = 0 to 2 do c.((6 * p) + 3 + x) <- c.((6 * p) + x) + d.(x) + pick 2 done
       done
   | 8 ->
       for p = 0 to 3 do
         for x = 0 to 2 do
           let sign = if draw 2 = 0 then 1 else -1 in
           c.((6 * p) + 3 + x) <- (sign * c.((6 * p) + x)) + (if draw 4 = 0 then pick 1 else 0)
         done
       done
   | 9 | 10 | 11 | 12 -> meet c edges size false (draw 2 = 0)
   | 15 -> near_roots c edges
   | _ -> ());
  c

(* In doubles; some have other units and are slightly changed. *)
let query_in_doubles mode c =
  let x = Array.map float_of_int c in
  if mode >= 10 && mode < 15 then begin
    let q0 = draw 110 in
    let q1 = draw 110 in
    let q2 = draw 110 in
    let q = [| q0; q1; q2 |] in
    let same = draw 2 = 0 in
    let seldom = draw 6 + 2 in
    for i = 0 to 23 do
      x.(i) <- ldexp x.(i) (if same then q0 else q.(i mod 3));
      if draw seldom = 0 then begin
        if x.(i) = 0. then
          let d = float_of_int (pick 1) in
          x.(i) <- ldexp d (if draw 3 > 0 then 0 else draw 40)
        else if draw 4 = 0 then x.(i) <- (if draw 2 = 0 then Float.succ x.(i) else Float.pred x.(i))
      end
    done
  end;
  x

(* Some coordinates are so large that integers of 1, 2 or 4 words just hold them, or do not; some are not finite. *)
let wide_query () =
  let mode = draw 16 in
  let edges = draw 2 = 1 in
  let x = query_in_doubles mode (whole_query mode edges) in
  let kind = draw 8 in
  let exponent = if kind = 6 then 120 + draw 904 else [| 60; 61; 124; 125; 252; 253 |].(kind mod 6) in
  let along = draw 2 = 0 in
  let axis = draw 3 in
  for i = 0 to 23 do
    if draw 4 = 0 && (not along || i mod 3 = axis) then begin
      let size = draw 3 in
      x.(i) <- ldexp (float_of_int size) (exponent - draw 2)
    end
  done;
  if kind = 7 && draw 2 = 0 then begin
    let which = draw 3 in
    x.(draw 24) <- [| infinity; neg_infinity; nan |].(which)
  end;
  edges, x

(* ---- Vectors b, c and p, as in whole_forms.hpp ---- *)

let rec drawn_below bits =
  if bits <= 30 then Z.of_int (draw (1 lsl bits))
  else
    let high = drawn_below (bits - 30) in
    Z.add (Z.shift_left high 30) (Z.of_int (draw (1 lsl 30)))
let drawn_within bits =
  let size = drawn_below bits in
  if draw 2 = 0 then size else Z.neg size

(* vectors.(i).(x): from start to end. A subinterval of the step: its level, the path to it if no sign change
   determines it, and the distance from the root's expected position there. The root of all as a quotient. A position
   there: its number of words, and `cut`. *)
type drawn_forms = { on_edges : bool; vectors : (Z.t * Z.t) array array; part_level : int; path : int; off : int;
                     root : Z.t; root_unit : Z.t; words : int; cut : int }

let orders = [| [| 0; 1; 2 |]; [| 1; 2; 0 |]; [| 2; 0; 1 |]; [| 0; 2; 1 |]; [| 1; 0; 2 |]; [| 2; 1; 0 |] |]

(* The coordinates have given values, over d, at a root u/d, d = (q + 1)*u + 1: draws sizes, u and q. *)
let draw_place () =
  let bits = match draw 4 with
    | 0 -> 2 + draw 12 | 1 -> 12 + draw 60 | 2 -> 72 + draw 130 | _ -> 202 + draw 46 in
  let dyadic = draw 6 = 0 in
  let of_u = if dyadic then 1 + draw (min (2 * bits / 3) 50) else draw ((2 * bits / 3) + 1) in
  let of_q = if dyadic then 0 else if draw 4 = 0 then draw ((bits / 6) + 1) else draw 3 in
  let u = if dyadic then Z.of_int ((1 lsl of_u) - 1) else Z.succ (drawn_below of_u) in
  let q = drawn_below of_q in
  u, q, max 0 (bits - of_q), max 1 (bits - of_q - of_u)

(* At the root the vectors are in a plane, or almost, with p*b and c*b nearly parallel. *)
let in_a_plane values value_bits =
  let of_h = draw (value_bits + 1) in
  let more = value_bits - of_h in
  let h = drawn_below of_h in
  let factor () = if draw 3 = 0 then drawn_within (draw (more + 1)) else Z.of_int (pick 1) in
  let g = factor () in
  let j = factor () in
  let k = drawn_within (draw (value_bits + 1)) in
  let d = Z.of_int (pick 3) in
  values.(0) <- [| h; Z.one; Z.zero |];
  values.(1) <- [| Z.sub (Z.mul h j) k; j; Z.zero |];
  values.(2) <- [| Z.add (Z.mul h g) d; g; Z.zero |];
  for i = 0 to 2 do values.(i).(2) <- if draw 4 = 0 then Z.of_int (pick 1) else Z.zero done

(* A double or triple root. *)
let of_rank_one values =
  if draw 3 = 0 then values.(0) <- Array.make 3 Z.zero;
  for i = 1 to 2 do
    let times = Z.of_int (pick 2) in
    values.(i) <- Array.map (Z.mul times) values.(0)
  done

(* b and c are in one plane throughout, whose normal vanishes together with their cross product. *)
let move_in_a_plane values slopes value_bits =
  for i = 0 to 1 do
    let x = drawn_within value_bits in
    let y = drawn_within value_bits in
    values.(i) <- [| x; y; Z.zero |];
    slopes.(i).(2) <- Z.zero
  done

(* A contact in the middle of both features, at a double or triple root, or at three close ones. *)
let meet_inside values slopes value_bits =
  let triple = draw 2 = 0 in
  let coincide = draw 2 = 0 in
  let side = if draw 2 = 0 then Z.one else Z.minus_one in
  let four x = Z.shift_left x 2 in
  let arrange rows along other edge =
    rows.(0) <- [| four along; four edge; Z.zero |];
    rows.(1) <- [| Z.zero; Z.mul side (four along); Z.mul side (four edge) |];
    rows.(2) <- [| along; Z.add edge along; Z.add edge other |] in
  let along = slopes.(0).(0) in
  arrange slopes along (if triple then along else slopes.(1).(1)) slopes.(2).(2);
  let at () = if coincide then Z.zero else Z.of_int (pick 1) in
  let first = at () in
  let second = at () in
  arrange values first second (drawn_within value_bits);
  if not coincide then
    for i = 0 to 2 do
      for x = 0 to 2 do
        if draw 6 = 0 then values.(i).(x) <- Z.add values.(i).(x) (Z.of_int (pick 1))
      done
    done

let forms () =
  let kind = draw 8 in
  let on_edges = draw 2 = 1 in
  let u, q, value_bits, slope_bits = draw_place () in
  let each drawn =
    let rows = Array.make_matrix 3 3 Z.zero in
    for i = 0 to 2 do for x = 0 to 2 do rows.(i).(x) <- drawn () done done;
    rows in
  let slopes = each (fun () -> drawn_within slope_bits) in
  let values = each (fun () -> if draw 2 = 0 then Z.zero else Z.of_int (pick 2)) in
  (match kind with
   | 0 -> in_a_plane values value_bits
   | 1 -> for i = 0 to 2 do for x = 0 to 2 do if i <> x then slopes.(i).(x) <- Z.zero done done
   | 2 -> of_rank_one values
   | 3 -> values.(1) <- Array.map (fun v -> Z.add v v) values.(0)
   | 4 -> move_in_a_plane values slopes value_bits
   | 5 ->
       let side = if draw 2 = 0 then 1 else -1 in
       Array.iteri (fun i row -> values.(i) <- Array.map Z.of_int row) [| [| 4; 0; 0 |]; [| 0; 4 * side; 0 |]; [| 1; 1; 0 |] |]
   | 6 | 7 -> meet_inside values slopes value_bits
   | _ -> ());
  let order = orders.(if kind < 5 then draw 6 else 0) in
  let back = draw 2 = 0 in
  let moved row x =
    let value = values.(row).(x) and slope = slopes.(row).(x) in
    let start = Z.add value (Z.mul slope u) in
    let finish = Z.neg (Z.add (Z.mul q value) (Z.mul slope (Z.succ (Z.mul q u)))) in
    if back then finish, start else start, finish in
  let root_unit = Z.succ (Z.mul (Z.succ q) u) in
  let root = if back then Z.sub root_unit u else u in
  let part_level = if draw 2 = 0 then 40 else draw 40 in
  let path = draw (1 lsl 40) in
  let reach = draw 6 in
  let off = if reach < 3 then pick 1 * (1 lsl [| 4; 14; 24 |].(reach)) else pick (1 lsl draw 27) in
  let words = 1 + draw 4 in
  let cut = if draw 2 = 0 then draw 3 else draw 64 in
  { on_edges; vectors = Array.init 3 (fun i -> Array.init 3 (moved order.(i))); part_level; path; off; root; root_unit;
    words; cut }

(* Small vectors, p zero at the start. A subinterval from there: its bits, the position of a cubic's root in it, and
   the bits from which weights are tested. Numbers at the limit of can_be_narrowed, and a cubic with two close roots. *)
type drawn_deep = { deep_edges : bool; small : (Z.t * Z.t) array array; deep_bits : int; root_bits : int; deep_from : int;
                    limit_unit_bits : int; limit_bits : int; limit_index : int; limit_negative : bool; pair : Z.t list }
let draw_deep () =
  let deep_edges = draw 2 = 1 in
  let small = Array.make_matrix 3 3 (Z.zero, Z.zero) in
  for i = 0 to 2 do
    for x = 0 to 2 do
      let start = pick 3 in
      let finish = pick 3 in
      small.(i).(x) <- Z.of_int (if i = 2 then 0 else start), Z.of_int finish
    done
  done;
  let deep_bits = draw 1535 in
  let root_bits = draw 700 in
  let deep_from = deep_bits + (if draw 2 = 0 then 0 else draw 200) in
  let limit_unit_bits = 1472 + draw 4 in
  let limit_bits = 5442 + draw 4 in
  let limit_index = draw 4 in
  let limit_negative = draw 2 = 0 in
  let a = 1 + draw 16 in
  let b = 1 + draw 16 in
  let c = 1 + draw 4 in
  let e = 1 + draw 4 in
  let bits = draw 63 in
  let pair =
    List.map2 (fun h little -> Z.sub (Z.shift_left (Z.of_int h) bits) (Z.of_int little))
      [ b * b * c; (b * b * e) - (2 * a * b * c); (a * a * c) - (2 * a * b * e); a * a * e ] [ 1; 3; 3; 1 ] in
  { deep_edges; small; deep_bits; root_bits; deep_from; limit_unit_bits; limit_bits; limit_index; limit_negative;
    pair }

(* The most bits of an axis' coordinates. *)
let bits_along f x =
  Array.fold_left (fun most v -> let a, b = v.(x) in max most (max (bit_length a) (bit_length b))) 0 f.vectors

(* ---- Quadratics, and integers with error bounds ---- *)

(* Three quadratics, of which the first often has common roots with the others, and one more. *)
let draw_quadratics () =
  let size = [| 1; 2; 5; 30; 1 lsl 20 |].(draw 5) in
  let kind = draw 4 in
  let any () =
    let f0 = pick size in
    let f1 = pick size in
    let f2 = pick size in
    [| f0; f1; f2 |] in
  let c0 = pick size in
  let c1 = pick size in
  let with_root () =
    let d0 = pick size in
    let d1 = pick size in
    [| c0 * d0; (c0 * d1) + (c1 * d0); c1 * d1 |] in
  let first = if kind = 0 then any () else with_root () in
  let next () =
    if draw 6 = 0 then any ()
    else if kind > 1 then with_root ()
    else let times = pick 2 in Array.map (fun c -> c * times) first in
  let second = next () in
  let third = next () in
  let other = if draw 3 = 0 then any () else with_root () in
  [ first; second; third ], other

(* The roots of a product of linear forms, over 2^bits, an interval a few doubles wide with one sign change, and an
   estimate. The ends may be roots, and there may be a double root. *)
type drawn_search = { search_roots : int list; search_bits : int; search_low : int; search_high : int;
                      search_estimate : int; search_negative : bool }
let draw_search () =
  let degree = 1 + draw 3 in
  let search_bits = 54 + (if draw 2 = 0 then 0 else draw 80) in
  let low = (1 lsl 53) + (2 * draw (1 lsl 40)) in
  let doubles = 2 + draw 39 in
  let high = low + (2 * doubles) in
  let root = low + 1 + draw ((2 * doubles) - 1) in
  let twice = draw 3 = 0 in
  let at_end () = if draw 2 = 0 then low else high in
  let second = if twice && degree = 3 then low + (2 * (1 + draw (doubles - 1))) else at_end () in
  let third = if twice then second else at_end () in
  let search_negative = draw 2 = 0 in
  let search_estimate = low + (2 * (draw (doubles + 3) - 1)) in
  let search_roots = List.filteri (fun i _ -> i < degree) [ root; second; third ] in
  { search_roots; search_bits; search_low = low; search_high = high; search_estimate; search_negative }

(* Two values and the bits of their errors. *)
let draw_bounded () =
  let bits () = if draw 4 = 0 then draw 2 - (1 lsl 20) else draw 20 - 5 in
  let number () = drawn_within (draw 20) in
  let a = number () in
  let b = number () in
  let a_bits = bits () in
  let b_bits = bits () in
  (a, a_bits), (b, b_bits)

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
