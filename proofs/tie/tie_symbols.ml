(* Writes the results of the proofs' definitions (symbols.ml, extracted by TieSymbols.v) for symbols: names of the
   computed expressions, and conclusions from signs that are random functions of the names.
   tests/proofs/tie_symbols.cpp does the same with the C++ templates. *)
open Tie_hash
open Symbols

let modulus = (1 lsl 62) - 1
let mixed a b c =
  let h = (a * 3935559000370003845 + b * 2691343689449507681 + c * 2177342782468422677 + 1) land modulus in
  let h = h lxor (h lsr 31) in
  let h = h * 3935559000370003845 land modulus in
  h lxor (h lsr 30)

type rates = { zero : int; uncertain : int; positive : int; of_difference : int }
let seed = ref 0
let rates = ref { zero = 0; uncertain = 0; positive = 0; of_difference = 0 }

let named operation a b = (mixed a b operation land lnot 7) lor operation
let sign_of_name x =
  let drawn = mixed x !seed 9 lsr 20 in
  let r = !rates in
  let uncertain = if x land 7 = 1 then r.of_difference else r.uncertain in
  let first = drawn land 63 and second = (drawn lsr 6) land 63 in
  if first < r.zero then Zero
  else if first < r.zero + uncertain then Uncertain
  else if second < r.positive then Positive else Negative
let given i = named 7 !seed i

let s : scalar =
  { add0 = Obj.magic (named 0); sub0 = Obj.magic (named 1); mul0 = Obj.magic (named 2);
    opp0 = Obj.magic (fun a -> named 3 a 0); whole = Obj.magic (fun n -> named 4 n 0);
    twice = Obj.magic (fun a -> named 5 a 1);
    normalized = Obj.magic (List.map (fun a -> named 6 a 0));
    sign_of = Obj.magic sign_of_name; exact = (fun _ -> ()) }

let families =
  let rates zero uncertain positive of_difference = { zero; uncertain; positive; of_difference } in
  [ "exact", rates 2 0 32 0; "certain", rates 2 2 32 2; "uncertain", rates 10 10 32 10;
    "strict", rates 0 1 32 1; "halved", rates 2 1 32 48; "excluded", rates 1 1 50 48 ]

let form degree first : number list = List.init (degree + 1) (fun i -> Obj.magic (given (first + i)))
let put_name (x : number) = put_both (Obj.magic x)
let put = List.iter put_name

let put_root constraints =
  let g = List.init constraints (fun i -> form 4 (10 + (5 * i))) in
  put_word (match root_with_nonnegative s (form 3 0) g with
      | No -> 0 | Yes -> 1 | Maybe_root -> 2 | Maybe_inside -> 3)

let put_polynomial n =
  let p = form n 0 in
  let v : number = Obj.magic (given 20) and w : number = Obj.magic (given 21) in
  put_name (value_at s p v w);
  put_name (value_at s p (s.sub0 (s.whole 1) v) v);
  put (product s p (form 2 30));
  put (elevated s p);
  if n > 0 then put (derivative s p);
  List.iter (fun (left, right) -> put left; put right) [ split s p v w; halves s p ];
  put (List.map s.opp0 p)

let put_sign = function
  | Negative -> put_word 0 | Zero -> put_word 1 | Positive -> put_word 2 | Uncertain -> put_word 3
let put_signs n =
  let p = form n 0 in
  put_sign (sign_inside s p);
  put_sign (sign_throughout s p);
  put_word (if certainly_rootless s p then 1 else 0)

let moving first : moving_point =
  let at i : position =
    { px = Obj.magic (given i); py = Obj.magic (given (i + 1)); pz = Obj.magic (given (i + 2)) } in
  { t0 = at first; t1 = at (first + 3) }
let put_forms edges =
  let q = Array.init 4 (fun i -> moving (6 * i)) in
  let difference a b = forms_difference s q.(a) q.(b) in
  let b, c, p =
    if edges then difference 1 0, difference 3 2, difference 2 0
    else difference 2 1, difference 3 1, difference 0 1 in
  put (forms_y s b c p);
  List.iter put ((if edges then forms_inside_edges else forms_inside_face) s b c p)

(* The expression whose sign the predicate returns. *)
let rec named_expression = function
  | Coordinate c -> (Obj.magic c : int)
  | Difference (a, b) -> named 1 (Obj.magic a) (Obj.magic b)
  | Constant n -> named 4 n 0
  | Sum (a, b) -> named 0 (named_expression a) (named_expression b)
  | Minus (a, b) -> named 1 (named_expression a) (named_expression b)
  | Product (a, b) -> named 2 (named_expression a) (named_expression b)
  | Negation a -> named 3 (named_expression a) 0
let sign_of_expression e = sign_of_name (named_expression e)
let point k i = Obj.magic (given ((10 * k) + i))
(* A predicate's expression or its sign, and the degrees of coordinates, if not all are 1. *)
let put_expression e = put_both (named_expression e)
let put_weighted e count dimension = put_expression e; List.iter put_word (weighted_degrees count dimension)

let () =
  let begin_case family i = rates := List.assoc family families; seed := i in
  let once name put_case = line ("symbol " ^ name) 1 (fun i -> begin_case "exact" i; put_case ()) in
  let drawn name cases put_case =
    List.iter (fun (family, _) ->
        line ("symbol " ^ name ^ "." ^ family) cases (fun i -> begin_case family i; put_case ()))
      families in
  List.iter (fun n -> once (Printf.sprintf "polynomial<%d>" n) (fun () -> put_polynomial n))
    [ 0; 1; 2; 3; 4; 7 ];
  once "vertex_face_forms" (fun () -> put_forms false);
  once "edge_edge_forms" (fun () -> put_forms true);
  let expression name of_points = once name (fun () -> put_expression (of_points ())) in
  let p = point in
  expression "orient2d" (fun () -> area (p 0) (p 1) (p 2));
  expression "orient3d" (fun () -> volume (p 0) (p 1) (p 2) (p 3));
  expression "incircle" (fun () -> lifted_area (p 0) (p 1) (p 2) (p 3) unweighted);
  expression "insphere" (fun () -> lifted_volume (p 0) (p 1) (p 2) (p 3) (p 4) unweighted);
  once "power_incircle" (fun () -> put_weighted (power_incircle (p 0) (p 1) (p 2) (p 3)) 4 3);
  once "power_insphere" (fun () -> put_weighted (power_insphere (p 0) (p 1) (p 2) (p 3) (p 4)) 5 4);
  expression "compare_distances2d" (fun () -> compare_distances2d (p 0) (p 1) (p 2));
  expression "compare_distances3d" (fun () -> compare_distances3d (p 0) (p 1) (p 2));
  let sign name of_points = drawn name 1000 (fun () -> put_sign (of_points sign_of_expression)) in
  sign "orient2d_line_line" (fun s -> orient2d_line_line s (p 0) (p 1) (p 2) (p 3) (p 4) (p 5));
  sign "orient3d_line_plane" (fun s -> orient3d_line_plane s (p 0) (p 1) (p 2) (p 3) (p 4) (p 5) (p 6) (p 7));
  sign "compare_x_line_line" (fun s -> compare_x_line_line s (p 0) (p 1) (p 2) (p 3) (p 4) (p 5) (p 6) (p 7));
  List.iter (fun n -> drawn (Printf.sprintf "signs<%d>" n) 1000 (fun () -> put_signs n)) [ 1; 2; 3; 4 ];
  drawn "root_with_nonnegative<3>" 40000 (fun () -> put_root 3);
  drawn "root_with_nonnegative<4>" 40000 (fun () -> put_root 4)
