(* Shared by the programs that write tie.txt, as in tests/proofs/table.hpp: hashes, a sequence of random numbers,
   lines of the table. *)

(* FNV-1a, of 32-bit words. *)
let hash = ref 0
let start () = hash := 2166136261
let put_word w = hash := ((!hash lxor w) * 16777619) land 0xffffffff
let put_both w = put_word (w lsr 32); put_word (w land 0xffffffff)
let put_int n = put_word (n land 0xffffffff)
let put_bool b = put_word (if b then 1 else 0)
let put_bits x =
  let bits = Int64.bits_of_float x in
  put_word (Int64.to_int (Int64.shift_right_logical bits 32));
  put_word (Int64.to_int bits land 0xffffffff)
(* Equal for both zeros. *)
let put_double x = put_bits (if x = 0. then 0. else x)

(* A sequence of random numbers; the upper bits are used. *)
let state = ref 0
let draw n =
  state := (!state * 3935559000370003845) + 2691343689449507681;
  (!state lsr 20) mod n

(* A line of `cases` cases: put hashes the results of a case, numbered from 0. *)
let line name cases put =
  start ();
  for i = 0 to cases - 1 do put i done;
  Printf.printf "%s %d %08x\n%!" name cases !hash
