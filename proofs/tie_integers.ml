(* Writes what the proofs' definitions (integers.ml, extracted by TieIntegers.v) decide of queries in
   integers, in fixed width and to the end. tests/proofs/tie_integers.cpp does the same with the C++ code,
   on the same queries. What floating point estimates of close roots is taken as the code has it, since the
   theorems hold whatever it is: ccd/exact/close_contact.hpp. *)
module Whole = Z
open Tie_hash
open Integers
module Z = Whole
open Tie_queries

(* ---- Estimates ---- *)

let root_middle h n = whole_part (ldexp (estimated_root (approximated h)) (Z.to_int n) +. 0.5)

let root_exponent h =
  let y = Array.of_list h in
  let n = ref 3 in
  while Z.sign y.(!n) = 0 do decr n done;
  let exponent = ref min_int in
  for i = 0 to !n - 1 do
    if Z.sign y.(i) = - Z.sign y.(!n) then begin
      let quotient = bit_length y.(i) - (bit_length y.(!n) - 1) in
      let root = if quotient > 0 then (quotient + !n - i - 1) / (!n - i) else - (- quotient / (!n - i)) in
      exponent := max !exponent (root + 1)
    end
  done;
  Z.of_int !exponent

let estimated_pair numbers =
  let h = approximated numbers in
  let d0 = h.(1) -. (3. *. h.(0)) and d1 = 2. *. (h.(2) -. h.(1)) and d2 = (3. *. h.(3)) -. h.(2) in
  if not (d0 *. d2 < 0.) then None
  else
    let q = -. (d1 +. copysign (sqrt ((d1 *. d1) -. (4. *. d0 *. d2))) d1) /. 2. in
    let x = if q /. d2 > 0. then q /. d2 else d0 /. q in
    let t = x /. (1. +. x) in
    let s = 1. -. t in
    let value = cubic_at h s t in
    let bend = Float.max (abs_float (h.(0) -. value) /. (t *. t)) (abs_float (h.(3) -. value) /. (s *. s)) in
    let largest = Array.fold_left (fun m c -> Float.max m (abs_float c)) 0. h in
    let radius = sqrt ((abs_float value +. (ldexp 1. (-48) *. largest)) /. bend) in
    if not (radius < ldexp 1. (-5)) then None
    else Some ((fun n -> whole_part (ldexp t (Z.to_int n) +. 0.5)), Z.of_int (snd (Float.frexp radius) - 1))

let put_outcome = function Separate -> put_word 0 | Collides -> put_word 1 | Undecided -> put_word 2

let position d p e : position =
  let coordinate k = d.whole.((6 * p) + (3 * e) + k) in
  { px = Obj.magic (coordinate 0); py = Obj.magic (coordinate 1); pz = Obj.magic (coordinate 2) }
let whole d p : moving_point = { t0 = position d p 0; t1 = position d p 1 }
let differences d =
  let difference i j = difference integers (whole d i) (whole d j) in
  if d.edges then difference 1 0, difference 3 2, difference 2 0
  else difference 2 1, difference 3 1, difference 0 1
let steps = 100000

let put_decision d =
  let point p e : point =
    let coordinate k = d.whole.((6 * p) + (3 * e) + k) in
    { x = coordinate 0; y = coordinate 1; z0 = coordinate 2 } in
  let whole = whole d in
  let moving p : moving = { start = point p 0; finish = point p 1 } in
  let bits k = snd d.units.(k) in
  put_word (max (bits 0) (max (bits 1) (bits 2)));
  let extent k = Z.of_int (bits k) in
  let y = let b, c, p = differences d in (Obj.magic (y_form integers b c p) : Z.t list) in
  let refine _ _ low high bits = refined_place y low high (Z.to_int bits) in
  let place_of q = estimated_place (Z.to_int q.level) q.index q.part_y in
  put_outcome (decide_once d.edges (extent 0) (extent 1) (extent 2) place_of refine steps
                 (moving 0) (moving 1) (moving 2) (moving 3) (whole 0) (whole 1) (whole 2) (whole 3));
  put_outcome (decide_to_the_end d.edges (extent 0) (extent 1) (extent 2) place_of refine steps
                 root_middle root_exponent estimated_pair steps
                 (moving 0) (moving 1) (moving 2) (moving 3) (whole 0) (whole 1) (whole 2) (whole 3));
  let touches v e0 e1 =
    put_word (if edge_contact (((moving v, moving e0), moving e1), ((whole v, whole e0), whole e1)) then 1 else 0) in
  touches 0 1 2;
  put_word (if vertices_contact (whole 0) (whole 1) then 1 else 0)

(* What is else asked only of few: where roots nearly coincide. *)
let put_close d =
  let b, c, p = differences d in
  put_outcome (close_contact d.edges b c p root_middle root_exponent estimated_pair steps)

let () =
  state := 1;
  for i = 0 to 19 do
    let queries = Array.init 4000 (fun _ ->
        let mode = draw 15 in
        let edges = draw 2 = 1 in
        integers_of edges (query_in_doubles mode (whole_query mode edges))) in
    line (Printf.sprintf "integers decide.%d" i) 4000 (fun k -> put_decision queries.(k));
    line (Printf.sprintf "integers close.%d" i) 1000 (fun k -> put_close queries.(k))
  done
