(** Rows of Bernstein coefficients rounded to W words (include/errbound/roots/fixed_row.hpp), as integers;
    ControlValues.v has their errors. Their words are exact integers here (Words.v). Results:
        row_fits     a row's numbers are below 2^(64W - 3)
        row_stays    halving does not enlarge them: sums of two fit *)

From Coq Require Import ZArith List Lia.
Import ListNotations.
Open Scope Z_scope.

(** The coefficient c in units of 2^excess, rounded towards zero. *)
Definition cut_to (excess c : Z) : Z :=
  let size := if 0 <? excess then Z.abs c / 2 ^ excess else Z.abs c * 2 ^ (- excess) in
  if c <? 0 then - size else size.
Theorem row_fits excess bits width c : Z.abs c < 2 ^ bits -> 0 <= bits -> excess = bits - (width - 3) ->
  3 <= width -> Z.abs (cut_to excess c) < 2 ^ (width - 3).
Proof.
  intros Hc Pb E Pw. unfold cut_to. assert (0 <= Z.abs c) by lia.
  destruct (Z.ltb_spec 0 excess) as [L | L].
  - assert (P : 0 < 2 ^ excess) by (apply Z.pow_pos_nonneg; lia).
    assert (0 <= Z.abs c / 2 ^ excess) by (apply Z.div_pos; lia).
    assert (Z.abs c / 2 ^ excess < 2 ^ (width - 3)).
    { apply Z.div_lt_upper_bound; [lia |]. rewrite <- Z.pow_add_r by lia.
      replace (excess + (width - 3)) with bits by lia. exact Hc. }
    destruct (c <? 0); lia.
  - assert (P : 0 < 2 ^ (- excess)) by (apply Z.pow_pos_nonneg; lia).
    assert (Z.abs c * 2 ^ (- excess) < 2 ^ (width - 3)).
    { replace (width - 3) with (bits + - excess) by lia. rewrite Z.pow_add_r by lia.
      apply Z.mul_lt_mono_pos_r; auto. }
    assert (0 <= Z.abs c * 2 ^ (- excess)) by lia. destruct (c <? 0); lia.
Qed.

(** One step of de Casteljau's rule: means of neighbours, rounded down. *)
Fixpoint means (row : list Z) : list Z :=
  match row with a :: (b :: _) as l => (a + b) / 2 :: means l | _ => [] end.
Fixpoint after (k : nat) (row : list Z) : list Z :=
  match k with O => row | S k => after k (means row) end.
Theorem row_stays most k row : (0 <= most)%Z -> Forall (fun v => Z.abs v <= most)%Z row ->
  Forall (fun v => Z.abs v <= most)%Z (after k row).
Proof.
  intros P. assert (Step : forall row, Forall (fun v => Z.abs v <= most)%Z row -> Forall (fun v => Z.abs v <= most)%Z (means row)).
  { induction 1 as [| a l H F IH]; [constructor |]. destruct F as [| b l H' F]; [constructor |].
    cbn [means] in *. constructor; auto. generalize (Z.div_mod (a + b) 2) (Z.mod_pos_bound (a + b) 2). lia. }
  revert row. induction k as [| k IH]; intros row F; [exact F |]. cbn [after]. apply IH, Step, F.
Qed.
