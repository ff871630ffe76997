(* Writes the decisions of the proofs' definitions (integers.ml, extracted by TieIntegers.v) on queries in integers,
   in fixed width and to the end. tests/proofs/tie_integers.cpp does the same with the C++ code.
   Floating-point estimates of close roots are copied from ccd/exact/close_contact.hpp, since the theorems hold for
   any estimates. *)
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

let moving d p : moving =
  let point e : point =
    let coordinate k = d.whole.((6 * p) + (3 * e) + k) in
    { x = coordinate 0; y = coordinate 1; z0 = coordinate 2 } in
  { start = point 0; finish = point 1 }
let bits_of d = Array.fold_left (fun most (_, bits) -> max most bits) 0 d.units
let refine y _ _ low high bits = refined_place y low high (Z.to_int bits)
let place_of q = estimated_place (Z.to_int q.level) q.index q.part_y
let y_of b c p = (Obj.magic (y_form integers b c p) : Z.t list)

(* The decision on four moving points, in real numbers and in integers. *)
let of_points decide d =
  let extent k = Z.of_int (snd d.units.(k)) in
  let y = let b, c, p = differences d in y_of b c p in
  let real = moving d and whole = whole d in
  decide d.edges (extent 0) (extent 1) (extent 2) place_of (refine y) steps
    (real 0) (real 1) (real 2) (real 3) (whole 0) (whole 1) (whole 2) (whole 3)
let decided_once = of_points decide_once
let decided_to_the_end =
  of_points (fun edges x y z place_of refine steps ->
    decide_to_the_end edges x y z place_of refine steps root_middle root_exponent estimated_pair steps)
let vertex_touches_edge d v e0 e1 =
  edge_contact (((moving d v, moving d e0), moving d e1), ((whole d v, whole d e0), whole d e1))
let contact found = if found then Collides else Separate

let put_decision d =
  put_word (bits_of d);
  put_outcome (decided_once d);
  put_outcome (decided_to_the_end d);
  put_outcome (contact (vertex_touches_edge d 0 1 2));
  put_outcome (contact (vertices_contact (whole d 0) (whole d 1)))

(* Decisions that only few queries need, since roots nearly coincide. *)
let put_close d =
  let b, c, p = differences d in
  put_outcome (close_contact d.edges b c p root_middle root_exponent estimated_pair steps)

(* True if the first points are on one side of the others on an axis, the same at both ends of the step. It is tested
   beyond four words, and for separated borders. *)
let apart first count x =
  let side k e =
    let at p = x.((6 * p) + (3 * e) + k) in
    let some from till = List.init (till - from) (fun i -> at (from + i)) in
    let least l = List.fold_left Float.min infinity l and most l = List.fold_left Float.max neg_infinity l in
    let a = some 0 first and b = some first count in
    if least a > most b then 1 else if most a < least b then -1 else 0 in
  List.exists (fun k -> side k 0 <> 0 && side k 0 = side k 1) [ 0; 1; 2 ]

(* For all extents, also infinite ones: `count` points, of which `first` belong to the first feature. *)
let put_wide first count edges x decide =
  let finite = Array.for_all Float.is_finite (Array.sub x 0 (6 * count)) in
  put_bool finite;
  let units = if finite then Array.init 3 (axis count x) else [||] in
  Array.iter (fun (unit, bits) -> put_word (unit land 0xffffffff); put_word bits) units;
  let separated = finite && apart first count x in
  put_bool separated;
  let most = Array.fold_left (fun most (_, bits) -> max most bits) 0 units in
  let none = 0 and inside = 2 and range = 3 in
  let outcome, cause =
    if not finite then Undecided, range
    else if most > 253 then if separated then Separate, none else Undecided, range
    else
      let outcome = decide (integers_of ~count edges x) in
      outcome, if outcome = Undecided then inside else none in
  put_outcome outcome;
  put_word cause
let put_wide_query (edges, x) =
  put_wide (if edges then 2 else 1) 4 edges x decided_to_the_end;
  put_wide 1 3 edges x (fun d -> contact (vertex_touches_edge d 0 1 2));
  put_wide 1 2 edges x (fun d -> contact (vertices_contact (whole d 0) (whole d 1)))

let put_sign : sign -> unit = function Negative -> put_word 0 | Zero -> put_word 1 | Positive -> put_word 2 | _ -> put_word 3
let put_number n =
  put_sign (sign_of_real n);
  put_word (Tie_queries.bit_length n);
  let low = Z.logand n (Z.pred (Z.shift_left Z.one 64)) in
  put_word (Z.to_int (Z.shift_right low 32));
  put_word (Z.to_int (Z.logand low (Z.of_int 0xffffffff)))
let put_if_any put = function None -> put_word 0 | Some found -> put_word 1; put found

(* The subinterval after `level` halvings: that with a sign change of Y, else that of `path`. *)
let rec part_at level path q =
  if Z.to_int q.level = level then q
  else
    let left = left_of q and right = right_of q in
    let to_right = not left.roots.opposite0 && (right.roots.opposite0 || path land 1 = 1) in
    part_at level (path lsr 1) (if to_right then right else left)

let vectors_of drawn =
  let vector i : vector_form =
    let component x = let a, b = drawn.(i).(x) in (Obj.magic [ a; b ] : number list) in
    { vx = component 0; vy = component 1; vz = component 2 } in
  vector 0, vector 1, vector 2
let put_forms f =
  let extent x = Z.of_int (bits_along f x) in
  let b, c, p = vectors_of f.vectors and edges = f.on_edges in
  let y = y_of b c p in
  let refine = refine y in
  put_outcome (interior_contact edges b c p (extent 0) (extent 1) (extent 2) place_of refine steps);
  put_outcome (close_contact edges b c p root_middle root_exponent estimated_pair steps);
  let multiple, ((distinct, three), _) = linear_of_multiple b c p in
  put_if_any (fun (c0, c1) -> put_number c0; put_number c1) multiple;

  let whole = { part_y = y; roots = inner_sign_changes y; index = Z.zero; level = Z.zero } in
  let some = part_at f.part_level f.path whole in
  let without_halving =
    without_halving edges b c p (extent 0) (extent 1) (extent 2) place_of refine in
  put_if_any put_outcome (without_halving distinct three some);
  (* Subintervals around the root, with more than one root, at the limit of halvings. *)
  let near_root bits = Z.div (Z.shift_left f.root bits) f.root_unit in
  for i = 0 to 39 do
    let index = Z.logxor (near_root 40) (Z.shift_left Z.one i) in
    let last = { part_y = y; roots = { count = 2; opposite0 = false; first = Zero }; index; level = Z.of_int 40 } in
    put_if_any put_outcome (without_halving distinct true last)
  done;
  let bits = max 1 (min ((64 * f.words) - 4 - bits_along f 0 + f.cut) ((64 * f.words) - 2)) in
  for width_bits = 0 to 39 do
    put_outcome (throughout edges b c p (extent 0) (extent 1) (extent 2) (Z.of_int f.words) (near_root bits)
                   (Z.of_int bits) (Z.of_int width_bits))
  done;
  if some.roots.opposite0 then begin
    let place = Z.add (place_of some) (Z.of_int f.off) and bits = Z.of_int (min (f.part_level + 48) 62) in
    put_if_any put_outcome
      (near edges b c p (extent 0) (extent 1) (extent 2) refine distinct 3 Z.one some place bits);
    put_if_any (fun (low, high) ->
        put_number low;
        put_number high;
        if not (Z.equal low high) then put_bool (normal_vanishes b c low high bits))
      (bracket_near y some place bits)
  end

let put_part q =
  List.iter put_number q.close_y;
  put_number q.low;
  put_word q.close_roots.count;
  List.iter (fun n -> put_word (Z.to_int n)) [ q.unit_bits; q.width_bits; q.test_from; bits q ];
  put_bool (can_be_narrowed q)

(* The subintervals of a decision to the end, one after the other, and its result from the last one. *)
let put_parts f =
  let b, c, p = vectors_of f.vectors and edges = f.on_edges in
  let _, ((distinct, three), _) = linear_of_multiple b c p in
  let rec go_on path q =
    put_part q;
    if not (any_root three q.close_roots && can_be_narrowed q) then begin
      let from_last = { q with test_from = Z.add (bits q) (Z.of_int (path land 1)) } in
      put_outcome
        (by_narrowing edges b c p root_middle root_exponent estimated_pair distinct three steps
           (that_wait three [ from_last ]) Separate)
    end else begin
      put_outcome (inside_from edges b c p q.low q.unit_bits (Some q.width_bits));
      put_bool (contact_in_middle edges b c p q);
      put_bool (normal_vanishes_at_root b c distinct three q);
      let before = { q with low = Z.sub q.low (Z.shift_left Z.one (Z.to_int q.width_bits)) } in
      put_bool (normal_vanishes_at_root b c distinct three before);
      let narrow = narrowed root_middle root_exponent estimated_pair three q in
      put_bool (narrow <> None);
      let half side = sub_part q Z.one (Z.of_int side) Z.zero in
      go_on (path lsr 1)
        (match narrow with
         | Some narrow -> narrow
         | None ->
             let one = half (path land 1) in
             if any_root three one.close_roots then one else half (1 - (path land 1)))
    end in
  go_on f.path (Integers.whole_part b c p)

let put_deep d =
  let b, c, p = vectors_of d.small and edges = d.deep_edges in
  let _, ((distinct, three), _) = linear_of_multiple b c p in
  let part y bits from =
    { close_y = y; close_roots = inner_sign_changes y; low = Z.zero; unit_bits = Z.of_int bits; width_bits = Z.zero;
      test_from = Z.of_int from } in
  let deep = part [ Z.minus_one; Z.shift_left Z.one d.root_bits; Z.zero; Z.one ] d.deep_bits d.deep_from in
  put_outcome
    (by_narrowing edges b c p root_middle root_exponent estimated_pair distinct three steps [ deep ] Separate);
  let size = Z.shift_left Z.one d.limit_bits in
  let y = List.init 4 (fun i -> if i <> d.limit_index then Z.zero else if d.limit_negative then Z.neg size else size) in
  put_bool (can_be_narrowed (part y d.limit_unit_bits 0));
  let pair = part d.pair 0 40 in
  if pair.close_roots.count = 2 then
    put_if_any put_part (narrowed root_middle root_exponent estimated_pair three pair)

let put_roots (forms, other) =
  let quadratic f = { c0 = Z.of_int f.(0); c1 = Z.of_int f.(1); c2 = Z.of_int f.(2) } in
  let forms = List.map quadratic forms in
  let f = List.hd forms in
  if sign_inside reals (coefficients f) = Uncertain then
    put_bool (nonpositive_at_a_root f (quadratic other));
  let put_quadratic q = put_number q.c0; put_number q.c1; put_number q.c2 in
  match common_roots forms with
  | `None -> put_word 0
  | `One squares -> put_word 1; put_quadratic squares
  | `Of_quadratic f -> put_word 2; put_quadratic f
  | `Everywhere -> put_word 3

let put_bounded ((a, a_bits), (b, b_bits)) =
  let put x =
    put_number x.value0;
    put_word (Z.to_int x.error_bits land 0xffffffff);
    put_sign (bounded_sign x) in
  let a = { value0 = a; error_bits = Z.of_int a_bits } and b = { value0 = b; error_bits = Z.of_int b_bits } in
  put a;
  put (bounded_sum a b);
  put (bounded_difference a b);
  put (bounded_product a b)

let read_line name cases read put = line ("integers " ^ name) cases (fun _ -> put (read ()))

let () =
  for i = 0 to 19 do
    let queries = read_all 4000 (fun () -> let edges, x = read_whole_query () in integers_of edges x) in
    line (Printf.sprintf "integers decide.%d" i) 4000 (fun k -> put_decision queries.(k));
    line (Printf.sprintf "integers close.%d" i) 1000 (fun k -> put_close queries.(k))
  done;
  read_line "wide" 4000 read_whole_query put_wide_query;
  read_line "forms" 4000 read_forms put_forms;
  read_line "parts" 1000 read_forms put_parts;
  read_line "deep" 2000 read_deep put_deep;
  read_line "roots" 4000 read_quadratics put_roots;
  read_line "bounded" 4000 read_bounded put_bounded
