(** Counterexamples to statements of the published BSC (TTWM14; TightCCD paper, Sections 3 and 5.2): cubics that
    include/errbound/bsc.hpp decides rightly (Bsc.v).
        inflection_loses_roots   "Y' at the ends implies at most one extremum": wrong with an inflection inside,
            however
                                 near to an end, as after a rounded split
        extremum_not_at_start    "the sign of the extreme point is that of T(0)": wrong
        decomposition_zero       "sign G = - sign M sign R": wrong if M vanishes with Y *)

From Coq Require Import Reals Lra Psatz.
Open Scope R_scope.

(** Y' is negative and Y positive at both ends, so the classification finds no extremum and no root. But Y has two
    roots. Its inflection is at 1 - 4e. *)
Theorem inflection_loses_roots e : 0 < e <= 1 / 10 ->
  let u t := t - (1 - 7 * e) in
  let Y t := 9 * e * u t ^ 2 - u t ^ 3 - 49 * e ^ 3 in
  let Y' t := 18 * e * u t - 3 * u t ^ 2 in
  let Y'' t := 18 * e - 6 * u t in
  (forall t, derivable_pt_lim Y t (Y' t) /\ derivable_pt_lim Y' t (Y'' t)) /\ Y'' (1 - 4 * e) = 0 /\
  Y' 0 < 0 /\ Y' 1 < 0 /\ 0 < Y 0 /\ 0 < Y 1 /\
  exists t0 t1, 0 < t0 < t1 /\ t1 < 1 /\ Y t0 = 0 /\ Y t1 = 0.
Proof.
  intros E u Y Y' Y''.
  assert (D : forall t, derivable_pt_lim Y t (Y' t)).
  { intros t. replace (Y' t) with (9 * e * (INR 2 * u t ^ pred 2 * (1 - 0)) - INR 3 * u t ^ pred 3 * (1
      - 0) - 0)
      by (unfold Y'; simpl; ring).
    assert (U : forall n, derivable_pt_lim (fun t => u t ^ n) t (INR n * u t ^ pred n * (1 - 0))).
    { intros n. apply (derivable_pt_lim_comp u (fun x => x ^ n)).
      - apply (derivable_pt_lim_minus id (fun _ => 1 - 7 * e)); [apply derivable_pt_lim_id | apply
          derivable_pt_lim_const].
      - apply derivable_pt_lim_pow. }
    apply (derivable_pt_lim_minus (fun t => 9 * e * u t ^ 2 - u t ^ 3) (fun _ => 49 * e ^ 3));
      [| apply derivable_pt_lim_const].
    apply (derivable_pt_lim_minus (fun t => 9 * e * u t ^ 2) (fun t => u t ^ 3)); [| apply U].
    apply (derivable_pt_lim_scal (fun t => u t ^ 2)). apply U. }
  assert (D' : forall t, derivable_pt_lim Y' t (Y'' t)).
  { intros t. replace (Y'' t) with (18 * e * (1 - 0) - 3 * (INR 2 * u t ^ pred 2 * (1 - 0))) by (unfold
      Y''; simpl; ring).
    assert (U : derivable_pt_lim u t (1 - 0))
      by (apply (derivable_pt_lim_minus id (fun _ => 1 - 7 * e)); [apply derivable_pt_lim_id | apply
        derivable_pt_lim_const]).
    apply (derivable_pt_lim_minus (fun t => 18 * e * u t) (fun t => 3 * u t ^ 2)).
    - now apply (derivable_pt_lim_scal u).
    - apply (derivable_pt_lim_scal (fun t => u t ^ 2)).
      apply (derivable_pt_lim_comp u (fun x => x ^ 2)); [exact U | apply derivable_pt_lim_pow]. }
  assert (E3 : 0 < e ^ 3) by (apply pow_lt; lra).
  assert (Y0 : 0 < Y 0).
  { replace (Y 0) with (9 * e * (1 - 7 * e) ^ 2 + (1 - 7 * e) ^ 3 - 49 * e ^ 3) by (unfold Y, u; ring).
    assert (9 * e * (3 * e) ^ 2 <= 9 * e * (1 - 7 * e) ^ 2) by (apply Rmult_le_compat_l; [lra | apply
      pow_incr; lra]).
    assert (0 <= (1 - 7 * e) ^ 3) by (apply pow_le; lra). lra. }
  assert (Y1 : Y 1 = 49 * e ^ 3) by (unfold Y, u; ring).
  assert (Ym : Y (1 - 7 * e) = - 49 * e ^ 3) by (unfold Y, u; ring).
  assert (C : continuity Y) by (intros t; apply derivable_continuous_pt; exists (Y' t); apply D).
  split; [auto |]. split; [unfold Y'', u; ring |].
  split; [unfold Y', u; nra |]. split; [unfold Y', u; nra |]. split; [auto |]. split; [lra |].
  destruct (IVT_cor Y 0 (1 - 7 * e) C ltac:(lra)) as (t0 & T0 & Z0); [rewrite Ym; nra |].
  destruct (IVT_cor Y (1 - 7 * e) 1 C ltac:(lra)) as (t1 & T1 & Z1); [rewrite Ym, Y1; nra |].
  assert (t0 <> 0) by (intros ->; lra). assert (t0 <> 1 - 7 * e) by (intros ->; lra).
  assert (t1 <> 1 - 7 * e) by (intros ->; lra). assert (t1 <> 1) by (intros ->; lra).
  exists t0, t1. repeat split; auto; lra.
Qed.

(** Y = Y' S + T without inflection inside, and a negative minimum at 1/2. If the signs of Y'(0) and Y'(1) are
    uncertain, Section 5.2 uses the sign of T(0) for the extremum: no root. *)
Theorem extremum_not_at_start :
  let Y t := 8 * t ^ 3 - 6 * t + 1 in
  let Y' t := 24 * t ^ 2 - 6 in
  let T t := 1 - 4 * t in
  (forall t, Y t = Y' t * (t / 3) + T t) /\ (forall s t, 0 <= s < t -> Y' s < Y' t) /\
  0 < Y 0 /\ 0 < Y 1 /\ 0 < T 0 /\ Y' (1 / 2) = 0 /\ Y (1 / 2) < 0.
Proof.
  intros Y Y' T. unfold Y, Y', T. repeat split; intros; try field; try lra; simpl; nra.
Qed.

(** Y = M J + R, and J is positive where Y, M and R vanish. *)
Theorem decomposition_zero :
  let Y t := (1 - 2 * t) * (2 + t ^ 2) in
  let M t := 1 - 2 * t in
  let J t := 1 + t ^ 2 in
  let R t := 1 - 2 * t in
  (forall t, Y t = M t * J t + R t) /\ Y (1 / 2) = 0 /\ M (1 / 2) * R (1 / 2) = 0 /\ 0 < J (1 / 2).
Proof. intros Y M J R. unfold Y, M, J, R. repeat split; intros; try field; lra. Qed.
