(* Writes what the proofs' definitions (code.ml, extracted from Code.v) make of every case of tiny
   formats, and of a selection of cases of float and double: a line for each operation of each rule, with
   the number of cases and a hash of all results. tests/errbound/validation/tie_test.cpp does the same with the C++ code. *)
open Code
open Tie_hash

(* Coq's integers. *)
let rec positive n =
  if n = 1 then XH else if n land 1 = 1 then XI (positive (n lsr 1)) else XO (positive (n lsr 1))
let z n = if n = 0 then Z0 else if n > 0 then Zpos (positive n) else Zneg (positive (-n))
let rec of_positive = function XH -> 1 | XO q -> 2 * of_positive q | XI q -> (2 * of_positive q) + 1
let of_z = function Z0 -> 0 | Zpos q -> of_positive q | Zneg q -> - of_positive q

type 't format = {
  name : string;
  a : 't arithmetic;
  fused : bool;  (* has_fast_fma *)
  values : 't array;
  bounds : 't array;  (* those that are not negative *)
  put : 't -> unit;  (* zeros alike, NaN alike *)
  samples : int;
}

(* Numbers are codes; operations are looked up in tables, of every result of Flocq's. *)
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
  let integers = Hashtbl.create 100 in
  let integer = function
    | Z0 -> 0
    | n -> (
        match Hashtbl.find_opt integers n with
        | Some c -> c
        | None ->
            let c = encode (f.integer n) in
            Hashtbl.add integers n c; c) in
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
    samples = 1 lsl 20 }

(* float and double: Flocq's operations themselves. Words: 1 or 2 of 32 bits, the upper first. *)
let ieee name p exponent_bits words samples =
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
  { name; a; put; samples; fused = false;
    values = Array.of_list (special @ [ a.opposite a.infinity; a.opposite a.largest ] @ signed);
    bounds = Array.of_list (special @ unsigned) }

let put_sign = function
  | Negative -> put_word 0 | Zero -> put_word 1 | Positive -> put_word 2 | Uncertain -> put_word 3

(* At most ten thousand of them, evenly: the cases of three can be numbered. *)
let spread states =
  let n = Array.length states in
  let most = min n 10007 in
  Array.init most (fun i -> states.(i * n / most))

let exponents = Array.init 25 (fun i -> i - 12)

(* Every operation: its name, its number of cases, and what puts the results of one. *)
let operations f =
  let a = f.a and put = f.put and fused = f.fused in
  let put2 (x, y) = put x; put y in
  let count = Array.length in
  let of_two name first second case =
    (name, count first * count second,
     fun i -> case first.(i / count second) second.(i mod count second)) in
  let pairs first second =
    Array.concat (Array.to_list (Array.map (fun x -> Array.map (fun y -> (x, y)) second) first)) in
  (* states, the operands of a rule: the value, and the bound *)
  let arithmetic rule states add subtract multiply divide scale =
    let named operation = rule ^ "." ^ operation in
    [ of_two (named "add") states states (fun (x, s) (y, t) -> add (a.plus x y) x s y t);
      of_two (named "subtract") states states (fun (x, s) (y, t) -> subtract (a.minus x y) x s y t);
      of_two (named "multiply") states states (fun (x, s) (y, t) -> multiply (a.times x y) x s y t) ]
    @ (match divide with
       | None -> []
       | Some divide ->
           [ of_two (named "divide") states states (fun (x, s) (y, t) -> divide (a.over x y) x s y t) ])
    @ [ of_two (named "scale") states exponents (fun (x, s) e -> scale (a.scale x (z e)) x s (z e)) ] in
  let error_states = pairs f.values f.bounds in
  let safe_values = [| a.integer Z0; a.integer (z 1); a.opposite a.largest; a.infinity;
                       a.minus a.infinity a.infinity |] in
  let safe_counts = Array.map z [| 0; 1; 2; 5; (1 lsl 29) - 1; 1 lsl 29 |] in
  let safe_states = pairs safe_values (pairs f.bounds safe_counts) in
  let put_safe (b, k) = put b; put_word (of_z k) in
  (* lower <= upper, and a value that is one of them; and unknown *)
  let interval_states =
    let unknown = Array.map (fun x -> (x, (a.opposite a.infinity, a.infinity))) f.values in
    Array.append unknown
      (Array.of_list (List.concat_map (fun (l, u) ->
         if a.at_most l u then [ (l, (l, u)); (u, (l, u)) ] else [])
         (Array.to_list (pairs f.values f.values)))) in
  let residual_bounds = pairs f.values f.bounds in
  let residual_states = pairs f.values residual_bounds in
  let of_one name states case = (name, count states, fun i -> case states.(i)) in
  (* exact operands, of which a selection of all states has few *)
  let of_exact rule exact multiply divide =
    let named operation = rule ^ "." ^ operation ^ "_exact" in
    [ of_two (named "multiply") f.values f.values (fun x y ->
          put2 (multiply a fused (a.times x y) x (exact x) y (exact y)));
      of_two (named "divide") f.values f.values (fun x y ->
          put2 (divide a fused (a.over x y) x (exact x) y (exact y))) ] in
  (* functions of tracked numbers, by a rule *)
  let functions rule name states put_bound =
    let put_number (v, b) = put v; put_bound b in
    let named operation = name ^ "." ^ operation in
    let exactly v = tracked_exactly rule v in
    let three name states operation =
      let n = count states in
      (name, n * n * n,
       fun i -> put_number (operation states.(i / (n * n)) states.(i / n mod n) states.(i mod n))) in
    let fma = tracked_fma a rule in
    [ of_one (named "sqrt") states (fun x -> put_number (tracked_sqrt a fused rule x));
      of_one (named "sqrt_exact") f.values (fun v ->
          put_number (tracked_sqrt a fused rule (exactly v));
          put_number (tracked_sqrt a fused rule (exactly (a.times v v))));
      of_one (named "abs") states (fun x -> put_number (tracked_abs a rule x));
      of_two (named "min") states states (fun x y -> put_number (tracked_min a rule x y));
      of_two (named "max") states states (fun x y -> put_number (tracked_max a rule x y));
      three (named "fma") (spread states) fma;
      three (named "fma_exact") (Array.map exactly f.values) fma ] in
  [ of_two "sign_of" f.values f.values (fun v e -> put_sign (sign_of a v e));
    of_two "two_sum" f.values f.values (fun x y -> put2 (two_sum a x y));
    of_two "two_product" f.values f.values (fun x y ->
        let product = two_product a fused x y in
        put2 product;
        put_word (if product_error_is_exact a fused x y product then 1 else 0));
    of_two "remainder_of_division" f.values f.values (fun x y ->
        let r, exact = remainder_of_division a fused x y (a.over x y) in
        put r; put_word (if exact then 1 else 0));
    of_one "none.error" f.values (fun v -> put (none_error a v));
    of_one "tight.exact" f.values (fun v -> put (tight_exact a v));
    of_two "tight.within" f.values f.values (fun v e -> put (tight_within a v e)) ]
  @ arithmetic "tight" error_states
      (fun v _ s _ t -> put (tight_add a v s t))
      (fun v _ s _ t -> put (tight_add a v s t))
      (fun v x s y t -> put (tight_multiply a v x s y t))
      (Some (fun v x s y t -> put (tight_divide a v x s y t)))
      (fun v x s e -> put (tight_scale a v x s e))
  @ functions (tight_rule a) "tight" error_states put
  @ [ of_one "sharp.exact" f.values (fun v -> put (tight_exact a v));
      of_two "sharp.within" f.values f.values (fun v e -> put (tight_within a v e)) ]
  @ arithmetic "sharp" error_states
      (fun v _ s _ t -> put (sharp_add a v s t))
      (fun v _ s _ t -> put (sharp_add a v s t))
      (fun v x s y t -> put (sharp_multiply a v x s y t))
      (Some (fun v x s y t -> put (sharp_divide a v x s y t)))
      (fun v x s e -> put (sharp_scale a v x s e))
  @ functions (sharp_rule a) "sharp" error_states put
  @ [ of_one "safe.exact" f.values (fun v -> put_safe (safe_exact a v));
      of_two "safe.within" f.values f.values (fun v e -> put_safe (safe_within a v e));
      of_one "safe.error" safe_states (fun (v, (b, k)) -> put (safe_error a v b k)) ]
  @ arithmetic "safe" safe_states
      (fun _ _ (b, k) _ (c, l) -> put_safe (safe_add a b k c l))
      (fun _ _ (b, k) _ (c, l) -> put_safe (safe_add a b k c l))
      (fun _ x (b, k) y (c, l) -> put_safe (safe_multiply a x b k y c l))
      None
      (fun v x (b, k) e -> put_safe (safe_scale a v x b k e))
  @ functions (safe_rule a) "safe" safe_states put_safe
  @ [ of_one "interval.exact" f.values (fun v -> put2 (interval_exact a v));
      of_two "interval.within" f.values f.values (fun v e -> put2 (interval_within a v e));
      of_one "interval.error" interval_states (fun (v, b) -> put (interval_error a v b));
      of_one "interval.sign" interval_states (fun (_, b) -> put_sign (interval_sign a b)) ]
  @ arithmetic "interval" interval_states
      (fun v _ s _ t -> put2 (interval_add a v s t))
      (fun v _ s _ t -> put2 (interval_subtract a v s t))
      (fun v x s y t -> put2 (interval_multiply a fused v x s y t))
      (Some (fun v x s y t -> put2 (interval_divide a fused v x s y t)))
      (fun v _ s e -> put2 (interval_scale a v s e))
  @ of_exact "interval" (fun x -> (x, x)) interval_multiply interval_divide
  @ functions (interval_rule a) "interval" interval_states put2
  @ [ of_one "residual.exact" f.values (fun v -> put2 (residual_exact a v));
      of_two "residual.within" f.values f.values (fun v e -> put2 (residual_within a v e));
      of_one "residual.error" residual_bounds (fun b -> put (residual_error a b));
      of_one "residual.sign" residual_states (fun (v, b) -> put_sign (residual_sign a v b)) ]
  @ arithmetic "residual" residual_states
      (fun v x s y t -> put2 (residual_add a v x s y t))
      (fun v x s y t -> put2 (residual_subtract a v x s y t))
      (fun v x s y t -> put2 (residual_multiply a fused v x s y t))
      (Some (fun v x s y t -> put2 (residual_divide a fused v x s y t)))
      (fun v x s e -> put2 (residual_scale a v x s e))
  @ of_exact "residual" (fun _ -> (a.integer Z0, a.integer Z0)) residual_multiply residual_divide
  @ functions (residual_rule a) "residual" residual_states put2

(* All cases, or a selection where there are more than that. *)
let write ?(only = fun _ -> true) f exhaustive =
  List.iter (fun (name, total, case) -> if only name then begin
      let cases = if total <= exhaustive then total else min total f.samples in
      state := 1;
      line (f.name ^ " " ^ name) cases (fun i -> case (if cases = total then i else draw total)) end)
    (operations f)

(* With fused multiply-add: what differs. *)
let write_fused f =
  let fused = { f with name = f.name ^ ",fma"; fused = true } in
  let asks name =
    List.mem name [ "two_product"; "remainder_of_division" ] ||
    List.exists (fun rule ->
        List.exists (fun operation -> List.mem name [ rule ^ operation; rule ^ operation ^ "_exact" ])
          [ ".multiply"; ".divide" ])
      [ "interval"; "residual" ] ||
    List.exists (fun rule -> List.mem name [ rule ^ ".sqrt"; rule ^ ".sqrt_exact" ])
      [ "tight"; "sharp"; "safe"; "interval"; "residual" ] in
  write ~only:asks fused 0

(* Integers of n words: words of zeros, of ones, with one bit, and random ones. Words are put as two of
   32 bits, the upper first. *)
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

let () =
  List.iter words [ 1; 2; 3; 4 ];
  write (tiny 3 3) (1 lsl 24);
  write (tiny 5 3) (1 lsl 20);
  write (tiny 4 4) (1 lsl 20);
  let float = ieee "float" 24 8 1 2000 and double = ieee "double" 53 11 2 2000 in
  write float 0; write_fused float;
  write double 0; write_fused double
