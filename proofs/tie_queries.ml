(* Queries in whole numbers, and where floating point estimates their roots to be, taken as the code has it
   (ccd/exact/cubic_roots.hpp), since theorems hold whatever it is: what tie_integers.ml and tie_times.ml share. *)
open Tie_hash

(* ---- Estimates ---- *)

let bit_length x = Z.numbits (if Z.sign x < 0 then Z.lognot x else x)

(* All numbers, in floating point, times one power of two. *)
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
(* A form's value: Horner's rule. *)
let value_at form s t =
  let rec from_term sum power = function
    | [] -> sum
    | a :: rest -> from_term (Z.add (Z.mul sum s) (Z.mul a power)) (Z.mul power t) rest in
  from_term (List.hd form) t (List.tl form)

(* The place from a bracket, as refined_place has it. *)
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

(* ---- Queries, as whole_query.hpp draws them ---- *)

let sizes = [| 1; 2; 3; 5; 9; 30; 1000; 1 lsl 20; 1 lsl 40 |]
let pick size = draw ((2 * size) + 1) - size

(* Times 1 - t and t, of t = k/8. *)
let place c k p x = ((8 - k) * c.((6 * p) + x)) + (k * c.((6 * p) + 3 + x))

(* Point 0 is at a place of the face, or edges cross there, at t = k/8; or they miss it by a little. *)
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
   | _ -> ());
  c

(* In doubles, some of them in other units and a little off. *)
let query_in_doubles mode c =
  let x = Array.map float_of_int c in
  if mode >= 10 then begin
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

(* ---- Units, as axis_units.hpp has them ---- *)

let last_bit x =
  let mantissa, exponent = Float.frexp x in
  let n = Z.of_float (ldexp mantissa 53) in
  exponent - 53 + Z.trailing_zeros n

(* Of so many points. *)
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
      unit, (if extent = 0. then 0 else max 0 (snd (Float.frexp extent) - unit))

type decided = { edges : bool; units : (int * int) array; whole : Z.t array }

let integers_of ?(count = 4) edges x =
  let units = Array.init 3 (axis count x) in
  { edges; units; whole = Array.mapi (fun i v -> Z.of_float (ldexp v (- fst units.(i mod 3)))) x }
