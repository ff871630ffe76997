(* Writes the results of the proofs' definitions (words.ml, extracted by TieIntegers.v) for integers of variable
   length, whose words are often all zeros or all ones. tests/proofs/tie_words.cpp does the same with the C++ code. *)
module Whole = Z
open Tie_hash
open Words
module Z = Whole

let z = Z.of_int
let ones = Z.pred (Z.shift_left Z.one 64)
let put_whole w =
  put_word (Z.to_int (Z.shift_right w 32));
  put_word (Z.to_int (Z.logand w (z 0xffffffff)))
let put_words x = put_int (List.length x); List.iter put_whole x

(* Without sign extensions (trim_exact). *)
let trimmed x =
  let rec from_last = function
    | last :: (next :: _ as rest) when Z.equal last (if Z.testbit next 63 then ones else Z.zero) -> from_last rest
    | x -> x in
  List.rev (from_last (List.rev x))

let capacity = 12
let random_word () =
  let upper = draw (1 lsl 32) in
  let lower = draw (1 lsl 32) in
  Z.add (Z.shift_left (z upper) 32) (z lower)
let word seldom =
  if draw seldom > 0 then if draw 2 = 0 then Z.zero else ones
  else match draw 4 with 0 -> Z.one | 1 -> Z.shift_left Z.one 63 | _ -> random_word ()
let number () =
  let seldom = 1 + draw 6 in
  let size = 1 + draw capacity in
  trimmed (List.init size (fun _ -> word seldom))

let put_fitting x = let x = trimmed x in if List.length x <= capacity then put_words x
let put_case () =
  let a = number () in
  let b = number () in
  put_words a; put_words b;
  List.iter (fun x -> put_words (trimmed x); put_fitting x) [ long_sum a b; long_difference a b ];
  put_words (trimmed (long_difference [ Z.zero ] a));
  put_words (trimmed (any_product a b));
  if List.length (trimmed (any_product a b)) <= capacity then put_words (trimmed (long_product capacity a b));
  put_word (match sign_of a with Lt -> 0 | Eq -> 1 | Gt -> 2);
  put_word (if a = b then 1 else 0);
  put_word (if trimmed (long_difference (trimmed (long_sum a b)) b) = a then 1 else 0);
  put_int (Z.to_int (long_bit_length a));
  put_words (word_from_bit a (z (draw (64 * (capacity + 1)))));
  let bits = draw (64 * 9) in
  let power = trimmed (long_shifted Z.one (z bits) false ((bits / 64) + 3)) in
  put_words (trimmed (any_product a power));
  put_int (Z.to_int (count_filled a));
  List.iter (fun (i, w) -> put_int (Z.to_int i); put_whole (Z.abs w); put_word (if Z.sign w < 0 then 1 else 0))
    (signed_words a Z.zero Z.zero);
  let magnitude = word 2 in
  let shift = draw (64 * capacity) in
  let negative = draw 2 = 1 in
  let wide = trimmed (long_shifted magnitude (z shift) negative ((shift / 64) + 3)) in
  put_words wide;
  if List.length wide <= capacity then
    put_words (trimmed (long_shifted magnitude (z shift) negative (min ((shift / 64) + 3) capacity)))

let () =
  state := 1;
  line "long_integer all" 30000 (fun _ -> put_case ())
