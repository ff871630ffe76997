(* Writes the results of the proofs' definitions (code.ml, extracted from Code.v) for every case of tiny formats, and
   for selected cases of float and double: a line for each operation of each rule, with the number of cases and a
   hash of all results. tests/errbound/validation/tie_test.cpp does the same with the C++ code. *)
open Code
open Tie_hash

(* Coq's integers. *)
let rec positive n =
  if n = 1 then XH else if n land 1 = 1 then XI (positive (n lsr 1)) else XO (positive (n lsr 1))
let z n = if n = 0 then Z0 else if n > 0 then Zpos (positive n) else Zneg (positive (-n))
let rec of_positive = function XH -> 1 | XO q -> 2 * of_positive q | XI q -> (2 * of_positive q) + 1
let of_z = function Z0 -> 0 | Zpos q -> of_positive q | Zneg q -> - of_positive q

(* All cases of an operation if there are at most `exhaustive`, otherwise `samples` random ones. *)
type selection = { exhaustive : int; samples : int }

type 't format = {
  name : string;
  a : 't arithmetic;
  exponent : 't -> z;
  fused : bool;  (* has_fast_fma *)
  values : 't array;
  bounds : 't array;  (* nonnegative ones *)
  put : 't -> unit;  (* equal for both zeros, and for all NaN *)
  of_rules : selection;
  of_functions : selection;
  lists : int;  (* for lists of numbers: sums of products, polynomials *)
  to_double : 't -> Float.t;
  of_double : Float.t -> 't;
}

(* Counts of the rule `relative` are OCaml's doubles for all formats. *)
let doubles = {
  plus = ( +. ); minus = ( -. ); times = ( *. ); over = ( /. ); fma = Float.fma; root = sqrt; opposite = Float.neg;
  less = (fun (x : Float.t) y -> x < y); at_most = (fun (x : Float.t) y -> x <= y); equal = (fun (x : Float.t) y -> x = y);
  scale = (fun x e -> ldexp x (of_z e)); integer = (fun n -> Float.of_int (of_z n)); five_quarters = 1.25; digits = z 53;
  epsilon = epsilon_float; unit_roundoff = ldexp 1. (-53); underflow_unit = ldexp 1. (-1074);
  smallest_normal = min_float; largest = max_float; infinity = Float.infinity }
let put_double x =
  put_double (if Float.is_nan x then Int64.float_of_bits (Int64.succ (Int64.bits_of_float Float.infinity)) else x)
let double_of_float = function
  | B754_zero _ -> 0.
  | B754_infinity s -> if s then Float.neg_infinity else Float.infinity
  | B754_nan -> Float.nan
  | B754_finite (s, m, e) ->
      let x = ldexp (Float.of_int (of_positive m)) (of_z e) in
      if s then -. x else x
(* Precondition: x >= 0, finite. *)
let float_of_double p emax x =
  let m, e = Float.frexp x in
  constant p emax (z (int_of_float (ldexp m 53))) (z (e - 53))

(* Numbers are codes. Operations look up tables of all results of Flocq's operations. *)
let tiny p exponent_bits =
  let emax = 1 lsl (exponent_bits - 1) and codes = 1 lsl (p + exponent_bits) in
  let f = floats (z p) (z emax) in
  let decoded = Array.init codes (fun c -> float_of_code (z p) (z emax) (z c)) in
  let encode x = of_z (code_of_float (z p) (z emax) x) in
  let nan = encode (f.minus f.infinity f.infinity) in
  let table2 operation =
    let t = Array.init (codes * codes) (fun i -> operation decoded.(i / codes) decoded.(i mod codes)) in
    fun x y -> t.((x * codes) + y) in
  let results operation = table2 (fun x y -> encode (operation x y)) in
  let roots = Array.map (fun x -> encode (f.root x)) decoded in
  let opposites = Array.map (fun x -> encode (f.opposite x)) decoded in
  let known = 256 in  (* a table of the most frequent integers *)
  let integers = Array.init known (fun n -> encode (f.integer (z n))) in
  let integer n =
    let i = of_z n in
    if 0 <= i && i < known then integers.(i) else encode (f.integer n) in
  let max_scale = 64 in
  let scaled =
    Array.map (fun x -> Array.init ((2 * max_scale) + 1)
                          (fun e -> encode (f.scale x (z (e - max_scale))))) decoded in
  let values =
    List.filter (fun c -> c <= nan || (c >= codes / 2 && c < nan + (codes / 2))) (List.init codes Fun.id) in
  { name = Printf.sprintf "tiny_float<%d,%d>" p exponent_bits;
    fused = false;
    a = {
      plus = results f.plus; minus = results f.minus; times = results f.times; over = results f.over;
      fma = (fun x y v -> encode (f.fma decoded.(x) decoded.(y) decoded.(v)));
      root = (fun x -> roots.(x));
      opposite = (fun x -> opposites.(x));
      less = table2 f.less; at_most = table2 f.at_most; equal = table2 f.equal;
      scale = (fun x e -> scaled.(x).(of_z e + max_scale));
      integer; digits = f.digits;
      five_quarters = encode f.five_quarters; epsilon = encode f.epsilon;
      unit_roundoff = encode f.unit_roundoff; underflow_unit = encode f.underflow_unit;
      smallest_normal = encode f.smallest_normal; largest = encode f.largest;
      infinity = encode f.infinity };
    values = Array.of_list values;
    bounds = Array.of_list (List.filter (fun c -> c < codes / 2) values);
    put = (fun x -> put_word (if x = codes / 2 then 0 else x));
    exponent = (fun x -> exponent (z p) (z emax) decoded.(x));
    of_rules = { exhaustive = if p + exponent_bits = 6 then 1 lsl 24 else 1 lsl 20; samples = 1 lsl 20 };
    of_functions = { exhaustive = 1 lsl 18; samples = 1 lsl 18 }; lists = 20000;
    to_double = (let doubles = Array.map double_of_float decoded in fun x -> doubles.(x));
    of_double = (fun x -> encode (float_of_double (z p) (z emax) x)) }

(* float and double by Flocq's operations. Words: 1 or 2 of 32 bits, the upper first. *)
let ieee name p exponent_bits words =
  let emax = 1 lsl (exponent_bits - 1) in
  let p' = z p and emax' = z emax in
  let a = floats p' emax' in
  let rec join = function [] -> Z0 | w :: rest -> Z.add (z w) (Z.mul (z (1 lsl 32)) (join rest)) in
  let decode upper_first = float_of_code p' emax' (join (List.rev upper_first)) in
  let rec bits i = function
    | XH -> [ i ] | XI q -> i :: bits (i + 1) q | XO q -> bits (i + 1) q in
  let put x =
    let set = match code_of_float p' emax' x with
      | Zpos q -> bits 0 q
      | _ -> [] in
    let set = if set = [ (32 * words) - 1 ] then [] (* minus zero *) else set in
    for w = words - 1 downto 0 do
      put_word (List.fold_left (fun sum i -> if i / 32 = w then sum + (1 lsl (i mod 32)) else sum) 0 set)
    done in
  let bias = emax - 1 and upper_bits = 31 - exponent_bits in
  let number with_sign =
    let exponent = match draw 8 with
      | 0 | 1 | 2 -> bias - 2 + draw 5
      | 3 | 4 -> bias - p - 2 + draw 5
      | 5 -> draw 4
      | 6 -> (bias / 2) - p + draw (2 * p)
      | _ -> (2 * bias) - draw 4 in
    let sign = if with_sign then draw 2 else 0 in
    let short = draw 4 = 0 in
    let upper = draw (1 lsl upper_bits) in
    let lower = draw (1 lsl 32) in
    let fraction = if short then 0 else upper in
    let first = (sign lsl 31) lor (exponent lsl upper_bits) lor fraction in
    decode (if words = 1 then [ first ] else [ first; (if short then 0 else lower) ]) in
  let special = [ a.integer Z0; a.infinity; a.minus a.infinity a.infinity; a.largest; a.underflow_unit;
                  a.smallest_normal; a.integer (z 1) ] in
  state := 1;
  let signed = List.init 150 (fun _ -> number true) in
  let unsigned = List.init 100 (fun _ -> number false) in
  { name; a; exponent = exponent p' emax'; put; fused = false;
    of_rules = { exhaustive = 0; samples = 2000 }; of_functions = { exhaustive = 0; samples = 1000 }; lists = 250;
    to_double = double_of_float; of_double = float_of_double p' emax';
    values = Array.of_list (special @ [ a.opposite a.infinity; a.opposite a.largest ] @ signed);
    bounds = Array.of_list (special @ unsigned) }

let put_sign = function
  | Negative -> put_word 0 | Zero -> put_word 1 | Positive -> put_word 2 | Uncertain -> put_word 3

(* At most ten thousand states, evenly spread, so that triples can be numbered. *)
let spread states =
  let n = Array.length states in
  let most = min n 10007 in
  Array.init most (fun i -> states.(i * n / most))

let exponents = Array.init 25 (fun i -> i - 12)
let powers = Array.append (Array.init 22 (fun i -> i - 9)) [| -(1 lsl 31) |]

(* Random numbers of three kinds: any; exact ones; exact and small ones with small errors, so that some results are
   finite. *)
let number_draws f rule states =
  let a = f.a in
  let is_small x = a.at_most (abs a x) (a.integer (z 2)) in
  let filter condition all = Array.of_list (List.filter condition (Array.to_list all)) in
  let well_known x = is_small (fst x) && a.at_most (tracked_error a rule x) (a.integer (z 1)) in
  let exact = Array.map (tracked_exactly rule) (filter is_small f.values) in
  let small = filter well_known states in
  fun kind ->
    let from all = all.(draw (Array.length all)) in
    match kind with
    | 0 -> from states
    | 1 -> from exact
    | _ -> if draw 2 = 0 then from small else from exact

let relative_counts p =
  [| 0.; 1.; 2.; 0.75; 3.5; 1. +. epsilon_float; 100.; ldexp 1. (p - 1); ldexp 1.5 p; ldexp 1.75 p; ldexp 1. 60;
     ldexp 1. (-1074); Float.infinity |]

(* The rule `affine` with at most three terms. New sources come after all others, in order. *)
let limit = S (S (S O))
let affine_operations a fused =
  let last = ref 100 in
  let fresh () = incr last; Some (z !last) in
  { the_rule = {
      rule_exact = affine_exact a;
      rule_within = (fun v e -> affine_within a limit v e (fresh ()));
      rule_error = (fun _ b -> b.radius);
      rule_subtract = (fun v x s y t -> affine_subtract a limit v x s y t (fresh ()));
      rule_negate = affine_negate a;
      rule_sign = (fun v b -> sign_of a v b.radius) };
    rule_add = (fun v x s y t -> affine_add a limit v x s y t (fresh ()));
    rule_multiply = (fun v x s y t -> affine_multiply a fused limit v x s y t (fresh ()));
    rule_divide = Some (fun v x s y t -> affine_divide a fused limit v x s y t (fresh ()));
    rule_scale = (fun v x s e -> affine_scale a limit v x s e (fresh ())) }

(* Numbers with up to three terms of few sources, so that they share some. Some sources come after all new ones. *)
let late = 1 lsl 40
let affine_states f =
  let a = f.a in
  let small = Array.of_list (List.filter (fun x -> a.at_most (abs a x) (a.integer (z 2))) (Array.to_list f.values)) in
  let number () =
    let from = if draw 4 = 0 then f.values else small in
    from.(draw (Array.length from)) in
  let rec terms kind n source =
    if n = 0 then []
    else
      let source = source + 1 + draw 2 in
      let source = if kind = 3 && source < late && draw 2 = 0 then late else source in
      let c = number () in
      let c = if a.equal c (a.integer Z0) then a.integer (z 1) else c in
      (z source, c) :: terms kind (n - 1) source in
  state := 1;
  Array.init 600 (fun _ ->
      let value = number () in
      match draw 8 with
      | 0 -> (value, { radius = a.infinity; rest = a.infinity; parts = [] })
      | 1 -> (value, affine_exact a value)
      | kind ->
          let terms = let count = draw 4 in terms kind count 0 in
          let rest = if kind = 2 then abs a (number ()) else a.integer Z0 in
          let radius = List.fold_left (fun sum (_, c) -> a.plus sum (abs a c)) rest terms in
          (value, { radius; rest; parts = terms }))
let put_source source = put_word (if source >= late then source - late + 200 else min source 100)
let put_affine put b =
  put b.radius; put b.rest; put_word (List.length b.parts);
  List.iter (fun (source, c) -> put_source (of_z source); put c) b.parts

(* The i-th list of pairs. One in four is the previous list with its first number negated. *)
let drawn_pairs f rule number i =
  state := i + 1;
  let kind = draw 4 in
  let count = draw 20 in
  let rec pairs n before =
    if n = 0 then []
    else
      let again = draw 4 = 0 in
      let pair = match before with
        | Some (x, y) when again -> (tracked_negate f.a rule x, y)
        | _ -> let x = number kind in let y = number kind in (x, y) in
      pair :: pairs (n - 1) (Some pair) in
  pairs count None

(* A polynomial's coefficients, and the argument. *)
let drawn_polynomial number i =
  state := i + 1;
  let kind = draw 4 in
  let count = draw 7 in
  let x = number kind in
  (List.init count (fun _ -> number kind), x)

(* Every operation of rules, and every function by them: its name, its number of cases, and a function that puts a
   case's results. *)
let operations f =
  let a = f.a and put = f.put and fused = f.fused in
  let put2 (x, y) = put x; put y in
  let count = Array.length in
  let of_two name first second case =
    (name, count first * count second,
     fun i -> case first.(i / count second) second.(i mod count second)) in
  let pairs first second =
    Array.concat (Array.to_list (Array.map (fun x -> Array.map (fun y -> (x, y)) second) first)) in
  let error_states = pairs f.values f.bounds in
  let safe_values = [| a.integer Z0; a.integer (z 1); a.opposite a.largest; a.infinity;
                       a.minus a.infinity a.infinity |] in
  let safe_counts = Array.map z [| 0; 1; 2; 5; (1 lsl 29) - 1; 1 lsl 29 |] in
  let safe_states = pairs safe_values (pairs f.bounds safe_counts) in
  let put_safe (b, k) = put b; put_word (of_z k) in
  (* lower <= upper, and a value equal to one of them; and unknown *)
  let interval_states =
    let unknown = Array.map (fun x -> (x, (a.opposite a.infinity, a.infinity))) f.values in
    Array.append unknown
      (Array.of_list (List.concat_map (fun (l, u) ->
         if a.at_most l u then [ (l, (l, u)); (u, (l, u)) ] else [])
         (Array.to_list (pairs f.values f.values)))) in
  let residual_bounds = pairs f.values f.bounds in
  let interval = interval_operations a fused and residual = residual_operations a fused in
  let relative = relative_operations a doubles f.to_double f.of_double fused in
  let relative_states = pairs f.values (relative_counts (of_z a.digits)) in
  let affine = affine_operations a fused and affine_states = affine_states f in
  let residual_states = pairs f.values residual_bounds in
  let of_one name states case = (name, count states, fun i -> case states.(i)) in
  (* exact operands, of which selected states have few *)
  let of_exact name operations exact put_bound =
    let divide = Option.get operations.rule_divide in
    let named operation = name ^ "." ^ operation ^ "_exact" in
    [ of_two (named "multiply") f.values f.values (fun x y ->
          put_bound (operations.rule_multiply (a.times x y) x (exact x) y (exact y)));
      of_two (named "divide") f.values f.values (fun x y ->
          put_bound (divide (a.over x y) x (exact x) y (exact y))) ] in
  (* all operations of a rule on its states, values with bounds *)
  let of_rule operations ?errors ?(signed = false) name states put_bound =
    let rule = operations.the_rule in
    let named operation = name ^ "." ^ operation in
    let errors = Option.value errors ~default:states in
    let of_states operation result =
      of_two (named operation) states states (fun (x, s) (y, t) -> put_bound (result x s y t)) in
    [ of_one (named "exact") f.values (fun v -> put_bound (rule.rule_exact v));
      of_two (named "within") f.values f.values (fun v e -> put_bound (rule.rule_within v e)) ]
    @ (if errors = [||] then [] else [ of_one (named "error") errors (fun (v, b) -> put (rule.rule_error v b)) ])
    @ (if signed then [ of_one (named "sign") states (fun (v, b) -> put_sign (rule.rule_sign v b)) ] else [])
    @ [ of_states "add" (fun x s y t -> operations.rule_add (a.plus x y) x s y t);
        of_states "subtract" (fun x s y t -> rule.rule_subtract (a.minus x y) x s y t);
        of_states "multiply" (fun x s y t -> operations.rule_multiply (a.times x y) x s y t) ]
    @ (match operations.rule_divide with
       | None -> []
       | Some divide -> [ of_states "divide" (fun x s y t -> divide (a.over x y) x s y t) ])
    @ [ of_two (named "scale") states exponents (fun (x, s) e ->
            put_bound (operations.rule_scale (a.scale x (z e)) x s (z e))) ] in
  (* functions of tracked numbers under a rule; `dot`, `sqrt` and `fma` are the rule's, if it has them *)
  let functions operations ?dot ?sqrt ?fma name states put_bound =
    let rule = operations.the_rule in
    let put_number (v, b) = put v; put_bound b in
    let named operation = name ^ "." ^ operation in
    let one name states operation = of_one (named name) states (fun x -> put_number (operation x)) in
    let two name first second operation =
      of_two (named name) first second (fun x y -> put_number (operation x y)) in
    let three name first second third operation =
      let n = count third in
      let m = count second * n in
      (named name, count first * m,
       fun i -> put_number (operation first.(i / m) second.(i / n mod count second) third.(i mod n))) in
    let exactly = tracked_exactly rule in
    let some = spread states and exact = Array.map exactly f.values in
    let of_value zero = Array.of_list (List.filter (fun x -> a.equal (fst x) zero) (Array.to_list some)) in
    let sqrt = Option.value sqrt ~default:(tracked_sqrt a fused rule) in
    let fma = Option.value fma ~default:(tracked_fma a rule) and lerp = tracked_lerp a operations in
    let number = number_draws f rule some in
    let dot = Option.value dot ~default:(tracked_dot a operations) in
    [ one "sqrt" states sqrt;
      of_one (named "sqrt_exact") f.values (fun v ->
          put_number (sqrt (exactly v));
          put_number (sqrt (exactly (a.times v v))));
      one "abs" states (tracked_abs a rule);
      two "min" states states (tracked_min a rule);
      two "max" states states (tracked_max a rule);
      three "fma" some some some fma;
      three "fma_exact" exact exact exact fma;
      two "midpoint" states states (tracked_midpoint a operations);
      three "lerp" some some some lerp;
      three "lerp_at_exact" some some exact lerp;
      two "copysign" states states (tracked_copysign a operations);
      two "pow" some powers (fun x n -> tracked_pow a operations x (z n));
      (named "dot", f.lists, fun i -> put_number (dot (drawn_pairs f rule number i)));
      (named "horner", f.lists, fun i ->
          let c, x = drawn_polynomial number i in
          put_number (tracked_horner a operations c x)) ]
    @ (if of_z a.digits < 8 then []
       else
         let hypot = tracked_hypot a operations f.exponent in
         let zeros = of_value (a.integer Z0) in
         [ two "hypot" states states hypot; two "hypot_of_zeros" zeros zeros hypot ]) in
  (* with the rule's dot bound, if one factor covers at least one term *)
  let own_dot most dot = if most a = O then None else Some (dot a) in
  let of_rules =
    [ of_two "sign_of" f.values f.values (fun v e -> put_sign (sign_of a v e));
      of_two "two_sum" f.values f.values (fun x y -> put2 (two_sum a x y));
      of_two "two_product" f.values f.values (fun x y ->
          let product = two_product a fused x y in
          put2 product;
          put_word (if product_error_is_exact a fused x y product then 1 else 0));
      of_two "remainder_of_division" f.values f.values (fun x y ->
          let r, exact = remainder_of_division a fused x y (a.over x y) in
          put r; put_word (if exact then 1 else 0));
      of_one "none.error" f.values (fun v -> put (none_error a v)) ]
    @ of_rule (tight_operations a) ~errors:[||] "tight" error_states put
    @ of_rule (sharp_operations a) ~errors:[||] "sharp" error_states put
    @ of_rule (safe_operations a) "safe" safe_states put_safe
    @ of_rule interval ~signed:true "interval" interval_states put2
    @ of_exact "interval" interval (fun x -> (x, x)) put2
    @ of_rule residual ~signed:true ~errors:(Array.map (fun b -> (a.integer Z0, b)) residual_bounds) "residual"
        residual_states put2
    @ of_exact "residual" residual (fun _ -> (a.integer Z0, a.integer Z0)) put2
    @ of_rule relative ~signed:true "relative" relative_states put_double
    @ of_exact "relative" relative (fun _ -> 0.) put_double
    @ of_rule affine "affine" affine_states (put_affine put)
    @ of_exact "affine" affine affine.the_rule.rule_exact (put_affine put) in
  let by_slope operations crowded =
    functions operations ~sqrt:(slope_sqrt a fused operations crowded) ~fma:(slope_fma a fused operations) in
  let at_limit b = List.length b.parts = 3 in
  let of_functions =
    functions (tight_operations a) ?dot:(own_dot tight_most tight_dot) "tight" error_states put
    @ functions (sharp_operations a) ?dot:(own_dot sharp_most sharp_dot) "sharp" error_states put
    @ functions (safe_operations a) "safe" safe_states put_safe
    @ functions interval ~sqrt:(interval_sqrt a fused) ~fma:(interval_fma a) "interval" interval_states put2
    @ by_slope residual (fun _ -> false) ?dot:None "residual" residual_states put2
    @ functions relative ~dot:(relative_dot a doubles f.to_double f.of_double fused) "relative" relative_states put_double
    @ by_slope affine at_limit ?dot:None "affine" affine_states (put_affine put) in
  (of_rules, of_functions)

let write ?(only = fun _ -> true) f =
  let write_each { exhaustive; samples } =
    List.iter (fun (name, total, case) -> if only name then begin
        let cases = if total <= exhaustive then total else min total samples in
        state := 1;
        line (f.name ^ " " ^ name) cases (fun i -> case (if cases = total then i else draw total)) end) in
  let of_rules, of_functions = operations f in
  write_each f.of_rules of_rules;
  write_each f.of_functions of_functions

(* Operations that differ with fused multiply-add. *)
let write_fused f =
  let fused = { f with name = f.name ^ ",fma"; fused = true } in
  let chosen name =
    List.mem name [ "two_product"; "remainder_of_division" ] ||
    List.exists (fun rule ->
        List.exists (fun operation -> List.mem name [ rule ^ operation; rule ^ operation ^ "_exact" ])
          [ ".multiply"; ".divide"; ".pow"; ".dot"; ".horner" ])
      [ "interval"; "residual"; "relative"; "affine" ] ||
    List.exists (fun rule -> List.mem name [ rule ^ ".sqrt"; rule ^ ".sqrt_exact" ])
      [ "tight"; "sharp"; "safe"; "interval"; "residual"; "relative"; "affine" ] ||
    List.mem name [ "residual.fma"; "residual.fma_exact"; "affine.fma"; "affine.fma_exact" ] in
  write ~only:chosen fused

(* Integers of n words: words of zeros, of ones, with one bit, and random ones. Each word is put as two of 32 bits,
   the upper first. *)
let words n =
  let word () =
    let kind = draw 8 in
    let upper = draw (1 lsl 32) in
    let lower = draw (1 lsl 32) in
    let join upper lower = Z.add (Z.mul (z upper) (z (1 lsl 32))) (z lower) in
    let ones = (1 lsl 32) - 1 in
    match kind with
    | 0 | 1 -> Z0 | 2 | 3 -> join ones ones | 4 -> z 1 | 5 -> join (1 lsl 31) 0
    | _ -> join upper lower in
  let put_words =
    let rec bits i = function
      | XH -> [ i ] | XI q -> i :: bits (i + 1) q | XO q -> bits (i + 1) q in
    List.iter (fun w ->
        let set = match w with Zpos q -> bits 0 q | _ -> [] in
        for half = 1 downto 0 do
          put_word (List.fold_left
                      (fun sum i -> if i / 32 = half then sum + (1 lsl (i mod 32)) else sum) 0 set)
        done) in
  let rec nat n = if n = 0 then O else S (nat (n - 1)) in
  state := n;
  let values = Array.init 24 (fun _ -> List.init n (fun _ -> word ())) in
  let write name cases put =
    line (Printf.sprintf "fixed_integer<%d> %s" n name) (Array.length cases) (fun i -> put cases.(i)) in
  let pairs first second =
    Array.concat (Array.to_list (Array.map (fun x -> Array.map (fun y -> (x, y)) second) first)) in
  let both = pairs values values in
  let with_bits most = pairs values (Array.init (most + 1) Fun.id) in
  write "sum" both (fun (x, y) -> put_words (words_sum x y));
  write "difference" both (fun (x, y) -> put_words (words_difference x y));
  write "product" both (fun (x, y) -> put_words (words_product x y));
  write "sparse_product" both (fun (x, y) ->
      if List.exists (fun w -> w <> Z0) y then put_words (words_sparse_product x y));
  write "compare" both (fun (x, y) ->
      put_word (match words_compare x y with Lt -> 0 | Eq -> 1 | Gt -> 2));
  write "bit_length" values (fun x -> put_word (of_z (words_bit_length x)));
  write "shift" (with_bits 63) (fun (x, bits) -> put_words (words_shift x (z bits)));
  write "from_bit" (with_bits ((64 * n) + 70)) (fun (x, bits) ->
      put_words (words_from_bit x (z bits) (nat n));
      put_words (words_from_bit x (z bits) (nat 1)));
  write "shifted" (with_bits ((64 * n) + 70)) (fun (x, bits) ->
      put_words (words_shifted (List.hd x) (z bits) (nat n)))

(* Writes one part: check.py runs all parts in parallel. *)
let () =
  match Sys.argv.(1) with
  | "words" -> List.iter words [ 1; 2; 3; 4 ]
  | "tiny_3_3" -> write (tiny 3 3)
  | "tiny_5_3" -> write (tiny 5 3)
  | "tiny_4_4" -> write (tiny 4 4)
  | "floats" ->
      let float = ieee "float" 24 8 1 and double = ieee "double" 53 11 2 in
      write float; write_fused float;
      write double; write_fused double
  | part -> failwith ("no part " ^ part)
