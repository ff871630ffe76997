(* Writes the first contacts of the proofs' definitions (times.ml, extracted by TieRoots.v) in integers: if there is
   one, and the doubles around it. tests/proofs/tie_times.cpp does the same with the C++ code, on the same queries.
   Copied from ccd/contact/time_bracket.hpp are floating-point estimates of roots, since theorems hold for any, and
   the selection of a quadratic's root, since quadratic_bracket is a relation. *)
module Whole = Z
module Rational = Q
open Tie_hash
open Times
module Z = Whole
module Q = Rational
open Tie_queries

(* ---- Searches ---- *)

(* The index of a double in ascending order. *)
let order_of t =
  let size = Z.of_int64 (Int64.bits_of_float (Float.abs t)) in
  if t < 0. then Z.neg size else size
let double_of n = Int64.float_of_bits (Z.to_int64 n)
let scaled x exponent =
  let cut = max 0 (bit_length x - 63) in
  ldexp (Int64.to_float (Z.to_int64 (Z.shift_right x cut))) (cut + exponent)
let sign n : sign = match Z.sign n with 0 -> Zero | 1 -> Positive | _ -> Negative

type search = { p : Z.t array; unit : int; floating : float array; slope : float array }
let search p =
  let n = Array.length p - 1 in
  let unit = Array.fold_left (fun m h -> max m (bit_length h)) 0 p in
  let floating = Array.map (fun h -> scaled h (- unit)) p in
  let times x k = if k = 1 then x else x *. float_of_int k in
  { p; unit; floating;
    slope = Array.init n (fun i -> times floating.(i + 1) (i + 1) -. times floating.(i) (n - i)) }
let slope_at s t =
  let sum = ref s.slope.(0) and power = ref t in
  for i = 1 to Array.length s.slope - 1 do
    sum := (!sum *. (1. -. t)) +. (s.slope.(i) *. !power);
    power := !power *. t
  done;
  !sum
(* The value, and a double near it; none if fixed widths do not suffice. *)
let value s t =
  let n = Array.length s.p - 1 in
  if t = 0. then Some (s.p.(0), scaled s.p.(0) (- s.unit))
  else
    let bits = - (last_bit t) in
    if bits > 126 then None
    else
      let numerator = Z.of_float (ldexp t bits) in
      let v = value_at (Array.to_list s.p) (Z.sub (Z.shift_left Z.one bits) numerator) numerator in
      Some (v, scaled v ((- n * bits) - s.unit))
let between s low high before estimate =
  let estimate =
    if estimate > low && estimate < high then estimate
    else
      let step = s.floating.(0) /. -. s.slope.(0) in
      if low = 0. && step > 0. && step < high then step else low +. ((high -. low) /. 2.) in
  let sign_of_value n = Option.map (fun (v, _) -> sign v) (value s (double_of n)) in
  let newton n =
    let t = double_of n in
    match value s t with
    | None -> None
    | Some (_, size) ->
        let next = t -. (size /. slope_at s t) in
        if Float.is_nan next then None else Some (order_of next) in
  search_between double_of_order sign_of_value before newton 1000 (order_of low) (order_of high) (order_of estimate)
    Z.one 0

let linear_bracket p0 p1 =
  if Z.sign p0 = 0 then Some (Q.zero, Q.zero)
  else if Z.sign p1 = 0 then Some (Q.one, Q.one)
  else
    let s = search [| p0; p1 |] in
    between s 0. 1. (sign p0) (s.floating.(0) /. (s.floating.(0) -. s.floating.(1)))
let opposite : sign -> sign = function Positive -> Negative | Negative -> Positive | s -> s
let estimates f =
  let root = sqrt (Float.max 0. ((f.(1) *. f.(1)) -. (4. *. f.(0) *. f.(2)))) in
  let q = -. (f.(1) +. (if f.(1) < 0. then -. root else root)) /. 2. in
  let x = q /. (f.(2) +. q) and y = f.(0) /. (q +. f.(0)) in
  (if y < x then y else x), (if x < y then y else x)
let quadratic_bracket f which =
  let s = search f in
  let first = sign f.(0) in
  let lesser, greater = estimates s.floating in
  let twice x = Z.shift_left x 1 in
  let beside_extreme earlier =
    match linear_bracket (Z.sub f.(1) (twice f.(0))) (Z.sub (twice f.(2)) f.(1)) with
    | None -> None
    | Some (low, high) as extreme ->
        let beside = Q.to_float (if earlier then low else high) in
        match value s beside with
        | None -> None
        | Some (v, _) when Z.sign v = 0 -> let t = Q.of_float beside in Some (t, t)
        | Some (v, _) when sign v = first -> extreme
        | _ -> if earlier then between s 0. beside first lesser else between s beside 1. (opposite first) greater in
  match which with
  | Only_root_of -> between s 0. 1. first (if lesser > 0. then lesser else greater)
  | First_root_of -> beside_extreme true
  | Second_root_of -> beside_extreme false

(* The result for a position in time: no contact, unknown, or its bracket. *)
type told = Never | Unknown | At of bracket
let told = function None -> Unknown | Some b -> At b
let bracket_of = function
  | Nowhere -> Never
  | Start_time -> At (Q.zero, Q.zero)
  | End_time -> At (Q.one, Q.one)
  | Linear_root (k0, k1) -> told (linear_bracket (Q.num k0) (Q.num k1))
  | Quadratic_root (f, which) -> told (quadratic_bracket (Array.map Q.num [| f.c0; f.c1; f.c2 |]) which)

(* ---- Queries ---- *)

let point d p e : point =
  let coordinate k = Q.of_bigint d.whole.((6 * p) + (3 * e) + k) in
  { x = coordinate 0; y = coordinate 1; z0 = coordinate 2 }
let moving d p : moving = { start = point d p 0; finish = point d p 1 }
let position d p e : position =
  let coordinate k = Obj.magic d.whole.((6 * p) + (3 * e) + k) in
  { px = coordinate 0; py = coordinate 1; pz = coordinate 2 }
let moving_point d p : moving_point = { t0 = position d p 0; t1 = position d p 1 }

let inside d b c p y last =
  let y_array = Array.of_list y in
  let s = search y_array in
  let whole_part_y q = List.map Q.num q.part_y in
  let estimate q = estimated_place (Z.to_int q.level) q.index (whole_part_y q) in
  let refine _ _ low high bits = refined_place y low high (Z.to_int bits) in
  let part_root q =
    let level = Z.to_int q.level in
    let place index = ldexp (Z.to_float index) (- level) in
    between s (place q.index) (place (Z.succ q.index)) q.roots.first
      (ldexp (Int64.to_float (Z.to_int64 (estimate q))) (- (min (level + 48) 62))) in
  let linear_root p0 p1 = linear_bracket (Q.num p0) (Q.num p1) in
  let place_of t bits = Z.fdiv (Z.shift_left (Q.num t) (Z.to_int bits)) (Q.den t) in
  let extent k = Z.of_int (snd d.units.(k)) in
  find d.edges b c p (extent 0) (extent 1) (extent 2) estimate refine part_root linear_root place_of 100000 last

let differences d =
  let difference i j = difference integers (moving_point d i) (moving_point d j) in
  if d.edges then difference 1 0, difference 3 2, difference 2 0
  else difference 2 1, difference 3 1, difference 0 1
let first_time d =
  let b, c, p = differences d in
  let y = y_form integers b c p in
  if certainly_rootless integers y then Never
  else
    let point = moving d in
    let borders = List.map (fun ((v, e0), e1) -> bracket_of (first_vertex_edge_contact v e0 e1))
        (vertex_edge_queries d.edges (point 0) (point 1) (point 2) (point 3)) in
    if List.mem Unknown borders then Unknown
    else
      let on_border = List.fold_left (fun first border ->
          earlier first (match border with At b -> Some b | _ -> None)) None borders in
      let s = inside d b c p (Obj.magic y : Z.t list) (last_of on_border) in
      if s.unplaced || s.found = Undecided then Unknown
      else match composed on_border (inside_time s) with None -> Never | Some b -> At b

let put_told = function
  | Never -> put_word 0
  | Unknown -> put_word 2
  | At (low, high) -> put_word 1; put_bits (Q.to_float low); put_bits (Q.to_float high)
(* True if integers of two words hold all numbers. *)
let fits d = Array.for_all (fun (_, bits) -> bits <= 125) d.units
let put_if_fitting d tell = put_told (if fits d then tell d else Unknown)

(* The root in a subinterval where Y changes its sign, as if the filter had found contact in it. The case's index
   determines the subinterval and the shape of Y. *)
let put_part d k =
  let depth = k mod 4 in
  let index = k / 4 mod (1 lsl depth) in
  let y = let b, c, p = differences d in (Obj.magic (y_form integers b c p) : Z.t list) in
  let sign_at i = sign (value_at y (Z.of_int ((1 lsl depth) - i)) (Z.of_int i)) in
  let before = sign_at index in
  if before <> Zero && sign_at (index + 1) = opposite before then
    put_if_fitting d (fun _ ->
        let start = if before = Positive then 1. else -1. in
        let place = estimated_root
            [| start; 3. *. float_of_int ((k mod 5) - 2); 3. *. float_of_int ((k mod 7) - 3); -. start |] in
        let low = ldexp (float_of_int index) (- depth) and high = ldexp (float_of_int (index + 1)) (- depth) in
        told (between (search (Array.of_list y)) low high before (low +. (place *. (high -. low)))))

let put_fewer (edges, x) =
  put_if_fitting (integers_of ~count:3 edges x)
    (fun d -> bracket_of (first_vertex_edge_contact (moving d 0) (moving d 1) (moving d 2)));
  put_if_fitting (integers_of ~count:2 edges x) (fun d ->
      if not (vertices_contact (moving_point d 0) (moving_point d 1)) then Never
      else bracket_of (moving_component (moving d 0) (moving d 1)))
let put_times (edges, x) k =
  put_part (integers_of edges x) k;
  put_if_fitting (integers_of edges x) first_time;
  put_fewer (edges, x)

(* For all extents. *)
let put_wide (edges, x) _ =
  if Array.for_all Float.is_finite x then begin
    let d = integers_of edges x in
    if fits d then put_part d 0 else put_told Unknown;
    put_if_fitting d first_time;
    put_fewer (edges, x)
  end

(* For queries that fit in doubles: points relative to one of them. *)
let put_of_forms f k =
  let bits = max (bits_along f 0) (max (bits_along f 1) (bits_along f 2)) in
  if bits <= 50 then begin
    let x = Array.make 24 0. in
    let place p v =
      Array.iteri (fun i (start, finish) ->
          x.((6 * p) + i) <- Z.to_float start;
          x.((6 * p) + 3 + i) <- Z.to_float finish) v in
    let b = f.vectors.(0) and c = f.vectors.(1) and p = f.vectors.(2) in
    let sum = Array.map2 (fun (a, b) (c, d) -> Z.add a c, Z.add b d) in
    place (if f.on_edges then 1 else 2) b;
    place 3 (if f.on_edges then sum p c else c);
    place (if f.on_edges then 2 else 0) p;
    put_times (f.on_edges, x) k
  end

(* All vertices and edges from 0 with coordinates -1 to 1 in a plane, or edges along an axis; on a line, with
   coordinates -3 to 3. *)
let put_small k =
  let each = 6561 in
  let x = Array.make 24 0. in
  let rec put_digits places digits size =
    match places with
    | [] -> ()
    | i :: rest ->
        x.(i) <- float_of_int ((digits mod ((2 * size) + 1)) - size);
        put_digits rest (digits / ((2 * size) + 1)) size in
  if k < each then put_digits [ 0; 1; 3; 4; 12; 13; 15; 16 ] k 1
  else if k < 2 * each then put_digits [ 0; 1; 2; 3; 4; 5; 12; 15 ] (k - each) 1
  else put_digits [ 0; 3; 12; 15 ] (k - (2 * each)) 3;
  put_if_fitting (integers_of ~count:3 false x)
    (fun d -> bracket_of (first_vertex_edge_contact (moving d 0) (moving d 1) (moving d 2)))

let put_search d _ =
  let whole_end = Z.shift_left Z.one d.search_bits in
  let times p root =
    let root = Z.of_int root in
    let by c = List.map (Z.mul c) p in
    List.map2 Z.add (by (Z.neg root) @ [ Z.zero ]) (Z.zero :: by (Z.sub whole_end root)) in
  let p = List.fold_left times [ (if d.search_negative then Z.minus_one else Z.one) ] d.search_roots in
  let later = List.length (List.filter (fun root -> root > d.search_low) d.search_roots) in
  let before : sign = if (later land 1 = 1) <> d.search_negative then Negative else Positive in
  let place x = ldexp (float_of_int x) (- d.search_bits) in
  put_told
    (told
       (between (search (Array.of_list p)) (place d.search_low) (place d.search_high) before (place d.search_estimate)))

let read_line name cases read put = line ("times " ^ name) cases (fun k -> put (read ()) k)

let () =
  for i = 0 to 9 do read_line (Printf.sprintf "first.%d" i) 1000 read_whole_query put_times done;
  read_line "wide" 1000 read_whole_query put_wide;
  read_line "forms" 4000 read_forms put_of_forms;
  line "times small" ((2 * 6561) + 2401) put_small;
  read_line "search" 8000 read_search put_search
