(** Bound rule `residual` (include/errbound/rules/residual.hpp): products and quotients, as the C++ code computes
    them, to nearest, ties to even, from 3 bits on, with u a number (emin <= -p). Arguments are the error of a b, and
    the remainder of a / b, or that it is unknown (ErrorFree.v: two_product_exact, remainder_of_division_exact).
    Results, if |a + ca - x| <= ra and |b + cb - y| <= rb:
        residual_multiply_sound   |fl(a b) + c - x y| <= r for the returned c, r
        residual_divide_sound     |fl(a / b) + c - x / y| <= r, and y is not zero *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core.
From Errbound Require Import Format Residual.
Open Scope R_scope.

(** Bounds of absolute values. *)
Lemma within_plus [s t S T] : Rabs s <= S -> Rabs t <= T -> Rabs (s + t) <= S + T.
Proof. intros. apply Rle_trans with (1 := Rabs_triang _ _). lra. Qed.
Lemma within_times s t S T : Rabs s <= S -> Rabs t <= T -> Rabs (s * t) <= S * T.
Proof. intros. rewrite Rabs_mult. apply Rmult_le_compat; auto using Rabs_pos. Qed.

Section Product.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.

Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation u := (u p).
Notation eta := (eta emin).
Notation inflated := (inflated p emin).
Notation half_ulp := (half_ulp p emin).
Notation roundings := (roundings p emin).
Notation residual_error := (residual_error p emin).
Notation holds := (holds p emin).
Notation covered := (covered p emin).

(** The code, in its order of evaluation; v is the rounded product or quotient. *)
Definition residual_multiply (known : bool) (error v a ca ra b cb rb : R) : R * R :=
  if is_zero a ca ra || is_zero b cb rb then (0, fl (v - v))
  else
    let own := if known then error else 0 in
    let unknown := if known then 0 else half_ulp v in
    if is_exact ca ra && is_exact cb rb then (own, unknown)
    else
      let x := fl (a * cb) in
      let y := fl (ca * b) in
      let inherited := fl (x + y) in
      let correction := fl (own + inherited) in
      let remainder :=
        fl (fl (fl (Rabs a + Rabs ca) * rb) +
            fl (fl (fl (fl (Rabs b + Rabs cb) + rb) * ra) + fl (Rabs ca * Rabs cb))) in
      (correction, inflated (fl (fl (remainder + roundings x y inherited correction) + unknown))).
(** None: the result is unknown (the remainder is infinite). *)
Definition residual_divide (known : bool) (value v a ca ra b cb rb : R) : option (R * R) :=
  let off := residual_error cb rb in
  let distance := fl (Rabs b - off) in
  if negb (Rlt_bool 0 distance) then None
  else if is_zero a ca ra then Some (0, fl (v - v))
  else
    let own := if known then value else 0 in
    let unknown := if known then 0 else half_ulp v in
    if Req_bool own 0 && is_exact ca ra && is_exact cb rb then Some (0, fl (unknown + fl (v - v)))
    else
      let x := fl (v * cb) in
      let inherited := fl (ca - x) in
      let numerator := fl (own + inherited) in
      let correction := fl (numerator / b) in
      let lost := fl (unknown + eta) in
      let c := fl (Rabs correction + lost) in
      let q := Rabs v in
      let left := fl (fl (fl (c * off) + fl (fl (q * rb) + ra)) + roundings x 0 inherited numerator) in
      Some (correction,
            inflated (fl (fl (fl (inflated left / distance) + half_ulp correction) + lost))).

Context (p_3 : (3 <= p)%Z) (emin_p : (emin <= - p)%Z).

Let rnd_exact := Format.rnd_exact p emin nearest.
Let rnd_number := Format.rnd_number p emin nearest.
Let rnd_nonnegative := Format.rnd_nonnegative p emin nearest.
Let nothing := nothing p emin.
Let u_8 := u_8 p p_3.
Let covered_number := covered_number p emin.
Let plus := covered_plus p emin p_3.
Let times := covered_times p emin p_3.
Let weaken := covered_weaken p emin p_3.
Let pays := inflated_covers p emin p_3 emin_p.
Let half_ulp_above := half_ulp_above p emin p_3.

(** More rules for covered numbers. *)
Lemma sum k X x l Y y : covered k 0 X x -> covered l 0 Y y ->
  covered (S (max k l)) 0 (X + Y) (fl (x + y)).
Proof. rewrite <- (Rplus_0_r 0) at 3. apply plus. Qed.
Lemma covered_relative k h X x : covered k h X x -> h <= 0 -> covered (S k) h (X * (1 + u)) x.
Proof.
  intros (N & P & C) H. repeat split; auto. rewrite <- tech_pow_Rmult. generalize u_8. intros U.
  apply (Rmult_le_compat_r (1 + u)) in C; [| lra]. nra.
Qed.
Lemma covered_over L I D : 0 < fl D -> 0 < D -> fl D <= D * (1 + u) -> 0 <= L -> L * (1 + u) <= I ->
  covered 1 (eta / 2) (L / D) (fl (I / fl D)).
Proof.
  intros PF PD HD PL HI. generalize u_8. intros U.
  assert (PI : 0 <= I) by (apply Rle_trans with (2 := HI); apply Rmult_le_pos; lra).
  assert (Q : 0 <= I / fl D) by (apply Rmult_le_pos; auto; now apply Rlt_le, Rinv_0_lt_compat).
  split; [apply rnd_number |]. split; [now apply rnd_nonnegative |]. rewrite pow_1.
  apply Rle_trans with (2 := any_lower p emin p_3 _ Q).
  apply Rmult_le_reg_r with (D * fl D); [now apply Rmult_lt_0_compat |].
  replace (L / D * (D * fl D)) with (L * fl D) by (field; lra).
  replace (I / fl D * (D * fl D)) with (I * D) by (field; lra).
  apply Rle_trans with (L * (D * (1 + u))); [now apply Rmult_le_compat_l |].
  replace (L * (D * (1 + u))) with (L * (1 + u) * D) by ring. apply Rmult_le_compat_r; lra.
Qed.
Lemma holds_zero v c r x : holds v c r x -> is_zero v c r = true -> x = 0 /\ v = 0.
Proof.
  intros H Z. apply andb_prop in Z. destruct Z as [Z E]. revert Z. case Req_bool_spec; [| discriminate].
  intros V _. rewrite (holds_exact p emin _ _ _ _ H E). auto.
Qed.
Lemma holds_within v c r x : holds v c r x -> Rabs (x - v - c) <= r.
Proof.
  intros (_ & _ & _ & H). rewrite <- Rabs_Ropp. now replace (- (x - v - c)) with (v + c - x) by ring.
Qed.
(** The unknown error of an operation rounded to v. *)
Lemma own_error (known : bool) error s : number error -> (known = true -> fl s + error = s) ->
  let own := if known then error else 0 in
  let unknown := if known then 0 else half_ulp (fl s) in
  number own /\ number unknown /\ 0 <= unknown /\ Rabs (fl s + own - s) <= unknown.
Proof.
  intros N K. destruct known; cbv zeta.
  - specialize (K eq_refl). repeat split; auto using number_0; [lra |].
    replace (fl s + error - s) with 0 by lra. rewrite Rabs_R0. lra.
  - rewrite Rplus_0_r. repeat split; auto using number_0.
    + apply (half_ulp_number p emin).
    + now apply half_ulp_nonnegative.
Qed.

Theorem residual_multiply_sound known error a ca ra x b cb rb y :
  holds a ca ra x -> holds b cb rb y -> number error ->
  (known = true -> fl (a * b) + error = a * b) ->
  let (c, r) := residual_multiply known error (fl (a * b)) a ca ra b cb rb in
  holds (fl (a * b)) c r (x * y).
Proof.
  intros HA HB NE K. destruct (own_error known error (a * b) NE K) as (No & Nu & Pu & Ho).
  generalize (holds_nonnegative p emin _ _ _ _ HA) (holds_nonnegative p emin _ _ _ _ HB)
    (holds_within _ _ _ _ HA) (holds_within _ _ _ _ HB). intros Pra Prb EA EB.
  unfold residual_multiply. destruct (is_zero a ca ra || is_zero b cb rb) eqn:CZ.
  { rewrite nothing.
    assert (Z : a * b = 0 /\ x * y = 0).
    { apply orb_prop in CZ. destruct CZ as [C | C].
      - destruct (holds_zero _ _ _ _ HA C) as [-> ->]. lra.
      - destruct (holds_zero _ _ _ _ HB C) as [-> ->]. lra. }
    destruct Z as [-> ->]. rewrite (rnd_0 p emin nearest). repeat split; auto using number_0.
    rewrite Rplus_0_r, Rminus_0_r, Rabs_R0. lra. }
  cbv zeta. set (own := if known then error else 0) in *.
  set (unknown := if known then 0 else half_ulp (fl (a * b))) in *.
  destruct (is_exact ca ra && is_exact cb rb) eqn:CE.
  { apply andb_prop in CE. destruct CE as [C1 C2].
    rewrite (holds_exact p emin _ _ _ _ HA C1), (holds_exact p emin _ _ _ _ HB C2).
    now repeat split. }
  destruct HA as (Na & Nca & Nra & _), HB as (Nb & Ncb & Nrb & _). clear CZ CE.
  clearbody own unknown. generalize u_8 (eta_positive emin). intros U P.
  set (v := fl (a * b)) in *.
  assert (C0 : forall z, number z -> covered 0 0 (Rabs z) (Rabs z)).
  { intros z N. apply covered_number; [now apply number_abs | apply Rabs_pos]. }
  generalize (C0 a Na) (C0 b Nb) (C0 ca Nca) (C0 cb Ncb) (covered_number ra Nra Pra)
    (covered_number rb Nrb Prb) (Rabs_pos a) (Rabs_pos b) (Rabs_pos ca) (Rabs_pos cb).
  intros Ca Cb Cca Ccb Cra Crb P1 P2 P3 P4.
  generalize (roundings_cover p emin p_3 (a * cb) (ca * b) (fl (a * cb)) (fl (ca * b))
                own (fl (fl (a * cb) + fl (ca * b))) (rnd_number _) (rnd_number _) No (rnd_number _)).
  set (X := fl (a * cb)). set (Y := fl (ca * b)). set (inherited := fl (X + Y)).
  set (c := fl (own + inherited)). intros CR.
  generalize (pays _ _ _ _ (plus _ _ _ _ _ _ _ _ (plus _ _ _ _ _ _ _ _ (plus _ _ _ _ _ _ _ _
    (times _ _ _ _ _ _ (sum _ _ _ _ _ _ Ca Cca) Crb ltac:(lra) Prb)
    (plus _ _ _ _ _ _ _ _
      (times _ _ _ _ _ _ (sum _ _ _ _ _ _ (sum _ _ _ _ _ _ Cb Ccb) Crb) Cra ltac:(lra) Pra)
      (times _ _ _ _ _ _ Cca Ccb P3 P4))) CR) (covered_number unknown Nu Pu))).
  set (r := inflated _). intros H. cbn [max Nat.add] in H. specialize (H ltac:(lia)).
  rewrite !Rplus_0_r in H.
  assert (W : eta / 2 * (1 + u) ^ 1 + (eta / 2 * (1 + u) ^ 2 + eta / 2 * (1 + u) ^ 0) + - (9 / 4 * eta)
              <= - (eta / 2)).
  { assert ((1 + u) ^ 2 <= 5 / 4 + / 32) by (simpl; nra).
    assert (eta / 2 * (1 + u) ^ 2 <= eta / 2 * (5 / 4 + / 32)) by (apply Rmult_le_compat_l; lra).
    assert (eta / 2 * u <= eta / 2 * / 8) by (apply Rmult_le_compat_l; lra). simpl pow in *. lra. }
  specialize (H W). clear W Ca Cb Cca Ccb Cra Crb CR.
  split; [apply rnd_number |]. split; [apply rnd_number |]. split; [apply rnd_number |].
  set (ea := x - a - ca) in *. set (eb := y - b - cb) in *.
  replace (v + c - x * y) with
    (v + own - a * b + (c - (own + inherited)) + (inherited - (X + Y)) + (X - a * cb) + (Y - ca * b) +
     - (ca * cb) + - ((a + ca) * eb) + - ((b + cb + eb) * ea)) by (unfold ea, eb; ring).
  apply Rle_trans with (2 := H).
  assert (T1 : Rabs (- (ca * cb)) <= Rabs ca * Rabs cb) by (rewrite Rabs_Ropp, Rabs_mult; lra).
  assert (T2 : Rabs (- ((a + ca) * eb)) <= (Rabs a + Rabs ca) * rb).
  { rewrite Rabs_Ropp. apply within_times; auto. apply Rabs_triang. }
  assert (T3 : Rabs (- ((b + cb + eb) * ea)) <= (Rabs b + Rabs cb + rb) * ra).
  { rewrite Rabs_Ropp. apply within_times; auto. apply within_plus; auto. apply Rabs_triang. }
  apply Rle_trans with (1 := within_plus (within_plus (within_plus (within_plus (within_plus (within_plus
    (within_plus Ho (Rle_refl _)) (Rle_refl _)) (Rle_refl _)) (Rle_refl _)) T1) T2) T3). lra.
Qed.

(** A nonzero divisor, and its distance from zero. *)
Lemma divisor b cb rb y : holds b cb rb y -> 0 < fl (Rabs b - residual_error cb rb) ->
  let off := residual_error cb rb in
  let D := Rabs b - off in
  number off /\ 0 <= off /\ Rabs (b - y) <= off /\ 0 < D /\ D <= Rabs y /\ fl D <= D * (1 + u).
Proof.
  intros H C. generalize (holds_nonnegative p emin _ _ _ _ H) (holds_within _ _ _ _ H). intros Pr E.
  destruct H as (Nb & Nc & Nr & _). cbv zeta. generalize (error_above p emin p_3 emin_p cb rb Nc Nr Pr)
    (error_number p emin cb rb Nc) u_8 (Rabs_pos cb). set (off := residual_error cb rb) in *.
  intros A No U Pc.
  assert (HB : Rabs (b - y) <= off).
  { replace (b - y) with (- (cb + (y - b - cb))) by ring. rewrite Rabs_Ropp.
    apply Rle_trans with (2 := A). now apply within_plus; [apply Rle_refl |]. }
  assert (PD : 0 < Rabs b - off).
  { apply Rnot_le_lt. intros L.
    assert (fl (Rabs b - off) <= 0); [| lra].
    apply (rnd_below p emin nearest); auto using number_0. }
  repeat split; auto; try lra.
  - generalize (Rabs_triang (b - y) y). replace (b - y + y) with b by ring. lra.
  - generalize (sum_error p emin nearest _ _ (rounding_error_nearest p emin ltac:(lia)) (Rabs b) (- off)
                  ltac:(now apply number_abs) ltac:(now apply number_opp)).
    change (Rabs b + - off) with (Rabs b - off). rewrite (Rabs_pos_eq (Rabs b - off)) by lra.
    intros S. apply Rabs_le_inv in S. lra.
Qed.
(** The correction of a quotient: the rest of num / b + t with y instead of b. *)
Lemma quotient_left num e t ea v eb b y ra rb off N T E : b <> 0 -> y <> 0 ->
  Rabs (b - y) <= off -> Rabs (num / b) <= N -> Rabs t <= T -> Rabs e <= E -> Rabs ea <= ra -> Rabs eb <= rb ->
  Rabs ((num - e + b * t + ea - v * eb) / y - num / b - t) <=
    ((N + T) * off + (Rabs v * rb + ra) + E) / Rabs y.
Proof.
  intros NB NY HB HN HT HE HA HR.
  replace ((num - e + b * t + ea - v * eb) / y - num / b - t)
    with (((num / b + t) * (b - y) + (- (v * eb) + ea) + - e) / y) by (field; auto).
  unfold Rdiv. rewrite Rabs_mult, Rabs_inv. apply Rmult_le_compat_r.
  { apply Rlt_le, Rinv_0_lt_compat. now apply Rabs_pos_lt. }
  apply within_plus; [apply within_plus |].
  - apply within_times; auto. now apply within_plus.
  - apply within_plus; auto. rewrite Rabs_Ropp. apply within_times; auto. apply Rle_refl.
  - now rewrite Rabs_Ropp.
Qed.

Theorem residual_divide_sound known value a ca ra x b cb rb y :
  holds a ca ra x -> holds b cb rb y -> number value ->
  (known = true -> value = a - fl (a / b) * b) ->
  match residual_divide known value (fl (a / b)) a ca ra b cb rb with
  | None => True
  | Some (c, r) => y <> 0 /\ holds (fl (a / b)) c r (x / y)
  end.
Proof.
  intros HA HB NV K. unfold residual_divide. cbv zeta.
  destruct (Rlt_bool_spec 0 (fl (Rabs b - residual_error cb rb))) as [C | C]; cbn [negb]; auto.
  destruct (divisor _ _ _ _ HB C) as (Noff & Poff & EY & PD & DY & DD). cbv zeta in *.
  set (off := residual_error cb rb) in *. set (D := Rabs b - off) in *.
  assert (NY : y <> 0) by (intros Z; rewrite Z, Rabs_R0 in DY; lra).
  assert (NB : b <> 0) by (intros Z; unfold D in PD; rewrite Z, Rabs_R0 in PD; lra).
  destruct (is_zero a ca ra) eqn:CZ.
  { split; auto. rewrite nothing. destruct (holds_zero _ _ _ _ HA CZ) as [-> ->].
    unfold Rdiv. rewrite !Rmult_0_l, (rnd_0 p emin nearest).
    split; [| split; [| split]]; auto using number_0. rewrite Rplus_0_r, Rminus_0_r, Rabs_R0. lra. }
  set (v := fl (a / b)) in *. set (own := if known then value else 0).
  set (unknown := if known then 0 else half_ulp v). set (t := a / b - v - own / b).
  assert (Nv : number v) by apply rnd_number.
  assert (O : number own /\ number unknown /\ 0 <= unknown /\ Rabs t <= unknown).
  { unfold t, own, unknown. destruct known; repeat split; auto using number_0.
    - lra.
    - rewrite (K eq_refl). replace (a / b - v - (a - v * b) / b) with 0 by (field; auto). rewrite Rabs_R0. lra.
    - apply (half_ulp_number p emin).
    - now apply half_ulp_nonnegative.
    - replace (a / b - v - 0 / b) with (- (v - a / b)) by (field; auto). rewrite Rabs_Ropp.
      apply half_ulp_above. }
  destruct O as (No & Nu & Pu & Ht). clearbody own unknown.
  destruct (Req_bool own 0 && is_exact ca ra && is_exact cb rb) eqn:CE.
  { apply andb_prop in CE. destruct CE as [CE C2]. apply andb_prop in CE. destruct CE as [C1 CE].
    rewrite (holds_exact p emin _ _ _ _ HA CE), (holds_exact p emin _ _ _ _ HB C2). split; auto.
    rewrite nothing, Rplus_0_r, (rnd_exact unknown Nu). split; [| split; [| split]]; auto using number_0.
    revert C1. case Req_bool_spec; [| discriminate]. intros Z _.
    replace (v + 0 - a / b) with (- t) by (unfold t; rewrite Z; field; auto). now rewrite Rabs_Ropp. }
  split; auto. clear CZ CE.
  generalize (holds_nonnegative p emin _ _ _ _ HA) (holds_nonnegative p emin _ _ _ _ HB)
    (holds_within _ _ _ _ HA) (holds_within _ _ _ _ HB). intros Pra Prb EA EB.
  destruct HA as (Na & Nca & Nra & _), HB as (Nb & Ncb & Nrb & _).
  generalize u_8 (eta_positive emin). intros U P.
  generalize (roundings_cover p emin p_3 (v * cb) 0 ca (- fl (v * cb)) own (fl (ca - fl (v * cb)))
                Nca (number_opp _ _ _ (rnd_number _)) No (rnd_number _)).
  rewrite (rnd_0 p emin nearest). fold (Rminus ca (fl (v * cb))).
  set (X := fl (v * cb)). set (inherited := fl (ca - X)). set (num := fl (own + inherited)).
  generalize (rounding_any p emin p_3 (num / b)) (half_ulp_above (num / b)). set (c := fl (num / b)).
  intros EC HC CR. set (lost := fl (unknown + eta)).
  assert (Nl : number lost) by apply rnd_number. assert (Pl : 0 <= lost) by (apply rnd_nonnegative; lra).
  assert (Hl : unknown + eta <= lost * (1 + u)).
  { apply (sum_lower p emin); auto using number_eta. lra. }
  assert (Cl : covered 1 (- eta) unknown lost) by (repeat split; auto; rewrite pow_1; lra).
  set (N := Rabs c * (1 + u) + eta / 2).
  assert (PN : 0 <= N) by (unfold N; generalize (Rmult_le_pos _ (1 + u) (Rabs_pos c)); lra).
  assert (Cc : covered 2 0 (N + unknown) (fl (Rabs c + lost))).
  { assert (Nc : number (Rabs c)) by apply number_abs, rnd_number.
    split; [apply rnd_number |]. split; [apply rnd_nonnegative; generalize (Rabs_pos c); lra |].
    generalize (sum_lower p emin _ _ Nc Nl (Rabs_pos c) Pl). intros S.
    apply (Rmult_le_compat_r (1 + u)) in S; [| lra]. unfold N. simpl pow. lra. }
  generalize (plus _ _ _ _ _ _ _ _ (plus _ _ _ _ _ _ _ _
    (times _ _ _ _ _ _ Cc (covered_number off Noff Poff) ltac:(lra) Poff)
    (plus _ _ _ _ _ _ _ _
      (times _ _ _ _ _ _ (covered_number (Rabs v) (number_abs _ _ _ Nv) (Rabs_pos v))
        (covered_number rb Nrb Prb) (Rabs_pos v) Prb)
      (covered_number ra Nra Pra))) CR).
  cbn [max Nat.add]. set (left := fl (_ + roundings X 0 inherited num)).
  set (e := _ + _ + (Rabs (inherited - (ca - X)) + _)). set (L := _ + e). intros CL.
  assert (W : (1 + u) ^ 2 <= 5 / 4 + / 32) by (simpl; nra).
  assert (W2 : eta / 2 * (1 + u) ^ 2 <= eta / 2 * (5 / 4 + / 32)) by (apply Rmult_le_compat_l; lra).
  apply (weaken _ _ _ 5 (- (eta / 2)) L) in CL; [| lia | simpl pow in *; lra | lra].
  apply covered_relative in CL; [| lra]. apply pays in CL; [| lia | lra].
  assert (PL : 0 <= L).
  { unfold L, e. repeat apply Rplus_le_le_0_compat; auto using Rabs_pos.
    - apply Rmult_le_pos; lra.
    - apply Rmult_le_pos; auto using Rabs_pos. }
  set (H := half_ulp c) in *. assert (PH : 0 <= H) by now apply half_ulp_nonnegative.
  generalize (pays _ _ _ _ (plus _ _ _ _ _ _ _ _ (plus _ _ _ _ _ _ _ _
    (covered_over _ _ _ C PD DD PL CL) (covered_number H (half_ulp_number p emin c) PH))
    Cl)).
  set (r := inflated _). cbn [max]. intros R. specialize (R ltac:(lia) ltac:(lra)).
  split; [apply rnd_number |]. split; [apply rnd_number |]. split; [apply rnd_number |].
  set (ea := x - a - ca) in *. set (eb := y - b - cb) in *.
  set (f := num - (own + ca - v * cb)).
  assert (HF : Rabs f <= e).
  { unfold f. replace (num - (own + ca - v * cb))
      with (- (X - v * cb) + (0 - 0) + ((inherited - (ca - X)) + (num - (own + inherited)))) by ring.
    apply within_plus; apply within_plus; rewrite ?Rabs_Ropp; apply Rle_refl. }
  assert (HN : Rabs (num / b) <= N).
  { replace (num / b) with (c - (c - num / b)) by ring. unfold N.
    apply Rle_trans with (Rabs c + (u * Rabs c + eta / 2)); [| lra].
    apply within_plus; [apply Rle_refl | now rewrite Rabs_Ropp]. }
  generalize (quotient_left num f t ea v eb b y _ _ _ _ _ _ NB NY EY HN Ht HF EA EB). fold L. intros Q.
  replace (v + c - x / y) with
    (- ((num - f + b * t + ea - v * eb) / y - num / b - t) + (c - num / b) + - t).
  - apply Rle_trans with (2 := R).
    apply within_plus; [apply within_plus |]; rewrite ?Rabs_Ropp; auto.
    apply Rle_trans with (1 := Q). unfold Rdiv. apply Rmult_le_compat_l; auto.
    now apply Rinv_le.
  - replace (num - f + b * t + ea - v * eb) with (x - v * y); [field; auto |].
    unfold f, t, ea, eb. field. auto.
Qed.
End Product.
