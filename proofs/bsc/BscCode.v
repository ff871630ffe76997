(** The code of Bernstein sign classification (include/errbound/bsc.hpp), in its order, over every scalar
    (Bernstein.v). Y is a cubic and each G a quartic, as lists of scaled coefficients. *)

From Coq Require Import Reals ZArith List Bool.
From Errbound Require Import Sign Bernstein.
Import ListNotations.
Open Scope R_scope.

(** ** Signs (include/errbound/sign.hpp) *)

Definition certain (s : sign) : bool := negb (same_sign s uncertain).
Definition negate (s : sign) : sign :=
  match s with negative => positive | positive => negative | _ => s end.
Definition times_sign (a b : sign) : sign :=
  match a, b with
  | zero, _ | _, zero => zero
  | uncertain, _ | _, uncertain => uncertain
  | _, _ => if same_sign a b then positive else negative
  end.
Definition possibly_positive (s : sign) : bool := same_sign s positive || same_sign s uncertain.
Definition possibly_negative (s : sign) : bool := same_sign s negative || same_sign s uncertain.
Definition possibly_zero (s : sign) : bool := same_sign s zero || same_sign s uncertain.
Definition certainly_nonnegative (s : sign) : bool := same_sign s zero || same_sign s positive.
Definition certainly_nonpositive (s : sign) : bool := same_sign s zero || same_sign s negative.

(** ** The code *)

Inductive existence := no | yes | maybe_root | maybe_inside.
Definition either (a b : existence) : existence :=
  match a, b with yes, _ | _, yes => yes | no, b => b | a, _ => a end.

(** A "maybe" ends the search. *)
Definition in_turn (a b : existence) : existence := match a with no => b | a => a end.

(** The verdict of class conjunction: signs of all G_i at one root. *)
Definition verdict (root_is_certain : bool) (signs : list sign) : existence :=
  if existsb (same_sign negative) signs then no
  else if negb root_is_certain then maybe_root
  else if forallb (same_sign positive) signs then yes else maybe_inside.

Section Code.

Context {S : scalar}.
Notation exacts := (map (@exact S)).
Notation "p '#' i" := (nth i p (whole 0)) (at level 20).
Implicit Types (y g l d j : list S).

Definition linear_root l : S * S :=
  if same_sign (sign_of (l#0)) positive then (opp (l#1), l#0) else (l#1, opp (l#0)).
Definition opposite l : bool :=
  match sign_of (l#0), sign_of (l#1) with
  | negative, positive | positive, negative => true
  | _, _ => false
  end.
Definition inside l : sign :=
  match sign_of (l#0), sign_of (l#1) with
  | uncertain, _ | _, uncertain => uncertain
  | zero, at1 => at1
  | at0, _ => at0
  end.
(** The sign of the form p at l's root. *)
Definition sign_at_root_of l p : sign := let (s, t) := linear_root l in sign_of (value_at p s t).

(** sign_at_crossing and signs_at_pair of a linear form *)
Definition linear_at_crossing y (before : sign) l : sign :=
  if negb (opposite l) then inside l
  else match sign_at_root_of l y with
       | uncertain => uncertain
       | zero => zero
       | at_r => if same_sign at_r before then sign_of (l#1) else sign_of (l#0)
       end.
Definition linear_at_pair y d l : sign * sign :=
  if negb (opposite l) then (inside l, inside l)
  else
    let at_r := sign_at_root_of l y in
    if same_sign at_r negative then (sign_of (l#0), sign_of (l#1))
    else
      let slope := sign_at_root_of l d in
      let nearer := if same_sign at_r zero then zero else uncertain in
      match slope with
      | negative => (if same_sign at_r positive then sign_of (l#1) else nearer, sign_of (l#1))
      | positive => (sign_of (l#0), if same_sign at_r positive then sign_of (l#0) else nearer)
      | _ => if same_sign slope zero && same_sign at_r zero then (zero, zero) else (uncertain,
        uncertain)
      end.

Definition reduced y g : list S :=
  let e0 := sub (mul (y#0) (g#1)) (mul (g#0) (y#1)) in
  let e1 := sub (mul (y#0) (g#2)) (mul (g#0) (y#2)) in
  let e2 := sub (mul (y#0) (g#3)) (mul (g#0) (y#3)) in
  let e3 := mul (y#0) (g#4) in
  normalized [sub (mul (y#3) e0) (mul e3 (y#0)); sub (mul (y#3) e1) (mul e3 (y#1));
              sub (mul (y#3) e2) (mul e3 (y#2))].

(** M and R of the decomposition *)
Definition decomposition_m y j : list S := normalized [mul (y#0) (j#2); mul (y#3) (j#0)].
Definition decomposition_r y j : list S :=
  let jj := mul (j#0) (j#2) in
  let m0 := mul (y#0) (j#2) in
  let m1 := mul (y#3) (j#0) in
  normalized [sub (sub (mul jj (y#1)) (mul m0 (j#1))) (mul m1 (j#0));
              sub (sub (mul jj (y#2)) (mul m0 (j#2))) (mul m1 (j#1))].

Definition combined (m r : sign) (m_form : list S) j : sign :=
  if negb (same_sign m zero) then negate (times_sign m r)
  else if negb (opposite m_form) then uncertain
  else sign_at_root_of m_form j.

Definition quartic_at_crossing y (before : sign) g : sign :=
  if certain (sign_inside g) then sign_inside g
  else
    let j := reduced y g in
    if certain (sign_inside j) then negate (sign_inside j)
    else
      let m := decomposition_m y j in
      let r := decomposition_r y j in
      negate (combined (linear_at_crossing y before m) (linear_at_crossing y before r) m j).
Definition quartic_at_pair y d g : sign * sign :=
  if certain (sign_inside g) then (sign_inside g, sign_inside g)
  else
    let j := reduced y g in
    if certain (sign_inside j) then (sign_inside j, sign_inside j)
    else
      let m := decomposition_m y j in
      let r := decomposition_r y j in
      let ms := linear_at_pair y d m in
      let rs := linear_at_pair y d r in
      (combined (fst ms) (fst rs) m j, combined (snd ms) (snd rs) m j).

(** The sign of a linear form at the extremum: sign_at in sign_at_extremum. *)
Definition linear_at_extremum d (form : list S) : sign :=
  let l := normalized form in
  if negb (opposite l) then inside l
  else match sign_at_root_of l d with
       | negative => sign_of (l#1)
       | positive => sign_of (l#0)
       | s => s
       end.
Definition sign_at_extremum y d : sign :=
  let three := whole 3 in
  let two := whole 2 in
  let from_left := negate (linear_at_extremum d
    [sub (mul two (mul (d#0) (y#1))) (mul three (mul (y#0) (d#1)));
     sub (mul (d#0) (y#2)) (mul three (mul (y#0) (d#2)))]) in
  if certain from_left then from_left
  else linear_at_extremum d
    [sub (mul (d#2) (y#1)) (mul three (mul (y#3) (d#0)));
     sub (mul two (mul (d#2) (y#2))) (mul three (mul (y#3) (d#1)))].

Definition at_end (y_end : sign) (g : list (list S)) (coefficient : nat) : existence :=
  if negb (possibly_zero y_end) then no
  else verdict (same_sign y_end zero) (map (fun f => sign_of (f#coefficient)) g).

Definition at_crossing y (before : sign) (root_is_certain : bool) (g : list (list S)) : existence :=
  verdict root_is_certain (map (quartic_at_crossing y before) g).

Definition at_pair y d (ends_are_certain : bool) (g : list (list S)) : existence :=
  let d0 := sign_of (d#0) in
  let d2 := sign_of (d#2) in
  if certainly_nonnegative d0 || certainly_nonpositive d2 then no
  else
    let lowest := sign_at_extremum y d in
    if same_sign lowest positive then no
    else
      let roots_are_certain := ends_are_certain && certain d0 && certain d2 && certain lowest in
      either (verdict roots_are_certain (map (fun f => fst (quartic_at_pair y d f)) g))
             (verdict roots_are_certain (map (fun f => snd (quartic_at_pair y d f)) g)).

Definition on_increasing y (g : list (list S)) : existence :=
  let y0 := sign_of (y#0) in
  let y3 := sign_of (y#3) in
  let found := either (at_end y0 g 0) (at_end y3 g 4) in
  if possibly_negative y0 && possibly_positive y3
  then either found (at_crossing y negative (certain y0 && certain y3) g)
  else found.

Definition on_convex y d (g : list (list S)) : existence :=
  let y0 := sign_of (y#0) in
  let y3 := sign_of (y#3) in
  let ends_are_certain := certain y0 && certain y3 in
  let found := either (at_end y0 g 0) (at_end y3 g 4) in
  let found :=
    if same_sign y0 zero then
      let slope := sign_of (y#1) in
      if possibly_negative slope && possibly_positive y3
      then either found (at_crossing (elevated [y#1; y#2; y#3]) negative (ends_are_certain && certain
        slope) g)
      else found
    else if possibly_negative y0 && possibly_positive y3
    then either found (at_crossing y negative ends_are_certain g)
    else found in
  if possibly_positive y0 then
    let found :=
      if same_sign y3 zero then
        let slope := negate (sign_of (y#2)) in
        if possibly_positive slope
        then either found (at_crossing (elevated [y#0; y#1; y#2]) positive (ends_are_certain && certain
          slope) g)
        else found
      else if possibly_negative y3
      then either found (at_crossing y positive ends_are_certain g)
      else found in
    if possibly_positive y3 then either found (at_pair y d ends_are_certain g) else found
  else found.

Definition excluded_by_hull y (g : list (list S)) : bool :=
  certainly_rootless y || existsb (fun f => same_sign (sign_throughout f) negative) g.

(** without_curvature, then of_curvature. `parts` is the answer of splitting Y, whose second derivative is given. *)
Definition on_whole_part y (g : list (list S)) (curvature : sign) (parts : list S -> existence) :
  existence :=
  if excluded_by_hull y g then no
  else
    let d := derivative y in
    match sign_inside d with
    | positive => on_increasing y g
    | negative => on_increasing (map opp y) g
    | zero => if possibly_zero (sign_of (y#0)) then maybe_root else no
    | uncertain =>
        let second := derivative d in
        let curvature := if negb (certain curvature) && negb (opposite second) then inside second else
          curvature in
        match curvature with
        | positive => on_convex y d g
        | negative => on_convex (map opp y) (map opp d) g
        | _ => parts second
        end
    end.

(** A subinterval next to the inflection: its curvature is negative or positive, so it is not split. *)
Definition on_curved y (g : list (list S)) (curvature : sign) : existence :=
  on_whole_part y g curvature (fun _ => maybe_root).

(** without_halving and by_halving. The code stores waiting subintervals in an array, the earliest last, and stops
    at the first answer that is not "no". The recursion here takes them in that order. *)
Fixpoint on_part y (g : list (list S)) (halvings_left : nat) : existence :=
  on_whole_part y g uncertain (fun second =>
    if opposite second then
      let (v, w) := linear_root second in
      let parts_of f := let (a, b) := split f v w in (normalized a, normalized b) in
      either (on_curved (fst (parts_of y)) (map (fun f => fst (parts_of f)) g) (sign_of (second#0)))
             (on_curved (snd (parts_of y)) (map (fun f => snd (parts_of f)) g) (sign_of (second#1)))
    else match halvings_left with
      | O => maybe_root
      | Datatypes.S more =>
          let parts_of f := let (a, b) := halves f in (normalized a, normalized b) in
          in_turn (on_part (fst (parts_of y)) (map (fun f => fst (parts_of f)) g) more)
                  (on_part (snd (parts_of y)) (map (fun f => snd (parts_of f)) g) more)
      end).

Definition max_halvings : nat := 6.
Definition root_with_nonnegative y (g : list (list S)) : existence :=
  let cubic := normalized y in
  if certainly_rootless cubic then no else on_part cubic (map normalized g) max_halvings.

End Code.
