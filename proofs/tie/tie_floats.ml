(* Writes the results of the proofs' definitions (floats.ml, extracted by TieFloats.v) for queries: sizes, error
   bounds and control values, each test of the filter, subdivision, and the axes in single precision.
   tests/proofs/tie_floats.cpp does the same with the C++ templates, on the same queries. *)
open Tie_hash
open Tie_queries
open Floats

let direction : float -> int = fun _ -> 0

let finite q = Array.for_all (fun v -> Float.abs v < infinity) q.given

let point q p e : point =
  { x = q.given.((6 * p) + (3 * e)); y = q.given.((6 * p) + (3 * e) + 1); z0 = q.given.((6 * p) + (3 * e) + 2) }
let moving q p : moving = { start = point q p 0; finish = point q p 1 }

(* Ends and starts of b, c, p. *)
let pairs q = if q.two_edges then [ 1, 0; 3, 2; 2, 0 ] else [ 2, 1; 3, 1; 0, 1 ]
let inside q = if q.two_edges then edge_edge_inside else vertex_face_inside
let sides q = if q.two_edges then edge_sides direction else face_sides direction

type filter = { y : float list; gs : float list list; y_error : float; g_error : float;
                y_errors : float; g_errors : float }

let filter_of q (sizes : point) =
  let moving_of (a, b) = moving_difference sizes (moving q a) (moving q b) in
  let forms = match List.map moving_of (pairs q) with
    | [ b; c; p ] -> { b_ = b; c_ = c; p_ = p }
    | _ -> assert false in
  let value = value 53 (-1074) direction in
  let y = List.map value (cubic (coplanarity forms)) in
  let gs = List.map (fun f -> List.map value (quartic f)) (inside q forms) in
  let y_error = error_of_y direction sizes.x sizes.y sizes.z0 in
  let g_error = error_of_g direction (inside q) sizes.x sizes.y sizes.z0 in
  let largest = List.fold_right (fun g m -> Float.max (size_of g) m) gs 0. in
  { y; gs; y_error; g_error; y_errors = error_of_parts direction y_error (size_of y) 3;
    g_errors = error_of_parts direction g_error largest 4 }

let put_outcome = function Separate -> put_word 0 | Collides -> put_word 1 | Undecided -> put_word 2

(* True if coordinates at both ends separate the first points from the others. *)
let compared_apart q =
  let count = if q.two_edges then 2 else 1 in
  let beyond k e side =
    let along p = side *. q.given.((6 * p) + (3 * e) + k) in
    List.for_all (fun p -> List.for_all (fun r -> along p > along r)
                     (List.init (4 - count) (fun i -> count + i))) (List.init count Fun.id) in
  List.exists (fun k -> List.exists (fun side -> beyond k 0 side && beyond k 1 side) [ 1.; -1. ]) [ 0; 1; 2 ]

let differences_of_query q =
  match List.map (fun (a, b) -> moving q a, moving q b) (pairs q) with
  | [ b1, b0; c1, c0; p1, p0 ] -> differences_of direction b1 b0 c1 c0 p1 p0
  | _ -> assert false

let rootless f = above (certain f.y_error) f.y || below (certain f.y_error) f.y
let outside f = List.exists (below (certain f.g_errors)) f.gs
let subdivided deepest f =
  subdivide 0. (midpoint direction) (certain f.y_errors) (certain f.g_errors)
    (hopeless_before deepest f.y_errors) deepest f.y f.gs

let put_tests q differences (m : point) =
  put_double m.x; put_double m.y; put_double m.z0;
  let coordinates = separated (sides q differences) (coordinate_axes m.x m.y m.z0) in
  let diagonals = separated (sides q differences) (diagonal_axes direction m.x m.y m.z0) in
  put_bool coordinates; put_bool diagonals; put_bool (coordinates || diagonals);
  let f = filter_of q m in
  List.iter put_double [ f.y_error; f.g_error; f.y_errors; f.g_errors ];
  List.iter put_double f.y;
  List.iter (List.iter put_double) f.gs;
  put_bool (rootless f);
  put_bool (outside f);
  let left, right = halves_in_doubles direction f.y in
  List.iter put_double left;
  List.iter put_double right;
  List.iter (fun deepest -> put_outcome (subdivided deepest f)) [ max_depth; 6; 0 ]

(* The decision of one query, and for each stage whether it was entered and its answer. It tests the coordinate axes
   only by comparisons. *)
let put_decision q differences (m : point) =
  let axes = ref (0, 0) and coplanarity = ref (0, 0) and inside = ref (0, 0) and subdivision = ref (0, 0, 0) in
  let filter = if q.two_edges then filter_edges else filter_face in
  let answer =
    if not (finite q) then Undecided
    else if compared_apart q then (axes := 1, 1; Separate)
    else begin
      axes := 1, 0;
      if usable m then begin
        let f = filter_of q m in
        coplanarity := 1, Bool.to_int (rootless f);
        if not (rootless f) then begin
          let diagonals = separated (sides q differences) (diagonal_axes direction m.x m.y m.z0) in
          axes := 1, Bool.to_int diagonals;
          if not diagonals then begin
            inside := 1, Bool.to_int (outside f);
            if not (outside f) then
              subdivision := (match subdivided max_depth f with
                  | Separate -> 1, 1, 0 | Collides -> 1, 0, 1 | Undecided -> 1, 0, 0)
          end
        end
      end;
      filter direction (moving q 0) (moving q 1) (moving q 2) (moving q 3)
    end in
  put_outcome answer;
  List.iter (fun (entered, separate) -> put_word entered; put_word separate) [ !axes; !coplanarity; !inside ];
  let entered, separate, collides = !subdivision in
  put_word entered; put_word separate; put_word collides

let put_filter q =
  let differences = differences_of_query q in
  let m = sizes differences in
  if finite q then begin
    put_bool (usable m);
    if usable m then put_tests q differences m
  end;
  put_decision q differences m

(* The constants from the forms' error counts. *)
let put_constants edges =
  let inside = if edges then edge_edge_inside else vertex_face_inside in
  List.iter put_double [ y_relative; y_absolute; halvings 3; g_relative inside; g_absolute inside; halvings 4 ]

(* Small whole control values, and errors that are equal to some of them. *)
let small () = float_of_int (draw 7 - 3)
let values count = List.init count (fun _ -> small ())
let put_signs () =
  let y = values 4 in
  let g = values 5 in
  let error = float_of_int (draw 3) in
  let certain = certain error in
  List.iter (fun c ->
      put_bool (above certain c); put_bool (below certain c); put_bool (changes_sign 0. certain c);
      put_bool (within_error error c))
    [ y; g ];
  put_bool (changes_sign 0. certain y && changes_sign_once certain y)

(* Subintervals with a small or a large Y, and G_i of either sign. *)
let put_subdivision edges =
  let y = if draw 2 = 0 then values 4 else List.init 4 (fun _ -> small () /. 8.) in
  let gs = List.init (if edges then 4 else 3) (fun _ -> List.init 5 (fun _ -> float_of_int (draw 40 - 25))) in
  let y_error = float_of_int (draw 2) /. 2. in
  let g_error = float_of_int (draw 2) in
  let deepest = match draw 4 with 0 -> 2 | 1 -> 5 | _ -> max_depth in
  put_outcome (subdivide 0. (midpoint direction) (certain y_error) (certain g_error)
                 (hopeless_before deepest y_error) deepest y gs)

let put_axes q = if finite q then begin
  let ends e : point = { x = e.(0); y = e.(1); z0 = e.(2) } in
  let f = frame_of direction (ends q.box_low) (ends q.box_high) in
  for p = 0 to 3 do
    for e = 0 to 1 do
      let r = rounded_point direction f (point q p e) in
      put_double r.x; put_double r.y; put_double r.z0
    done
  done;
  let gap (axis : float_axis) e =
    let at p = fst axis (rounded_point direction f (point q p (if e then 1 else 0))) in
    if q.two_edges then edges_gap direction (at 0) (at 1) (at 2) (at 3)
    else face_gap direction (at 0) (at 1) (at 2) (at 3) in
  put_bool (separated_in_float direction gap) end

let () =
  line "filter vertex_face_constants" 1 (fun _ -> put_constants false);
  line "filter edge_edge_constants" 1 (fun _ -> put_constants true);
  state := 1;
  line "filter signs" 4000 (fun _ -> put_signs ());
  state := 1;
  line "filter vertex_face_subdivision" 4000 (fun _ -> put_subdivision false);
  line "filter edge_edge_subdivision" 4000 (fun _ -> put_subdivision true);
  for i = 0 to 9 do
    let queries = read_all 2000 read_query in
    line (Printf.sprintf "filter tests.%d" i) 2000 (fun k -> put_filter queries.(k));
    line (Printf.sprintf "rounded_axes separated.%d" i) 2000 (fun k -> put_axes queries.(k))
  done
