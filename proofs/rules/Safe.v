(** Bound rule `safe` (include/errbound/rules/safe.hpp): SafeBound, as the C++ code computes it.

    A number x with computed value a has (B, k): |x| <= B and |a - x| <= B((1 + eps)^k - 1). Counts must be below
    2^29, where the code stops counting and returns no finite error. Results, rounding in any one direction from 4
    bits on (to nearest from 3):
        safe_exact_sound, safe_within_sound, safe_add_sound, safe_subtract_sound, safe_multiply_sound,
        safe_scale_sound   the bound that the code returns holds
        safe_error_sound   the error that the code reports is a bound *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core Mult_error.
From Errbound Require Import Format.
Open Scope R_scope.

Section Safe.

Context (p emin : Z) {p_positive : Prec_gt_0 p} (direction : R -> Z) {direction_valid : Valid_rnd direction}.

Notation fl := (rnd p emin direction).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).
Notation smallest_normal := (smallest_normal p emin).

(** The code, in its order of evaluation. *)
Definition enlarged (x : R) : R := fl (x * fl (1 + fl (4 * eps))).
Definition too_many : Z := (2 ^ 29)%Z.
Definition counted (k : Z) : Z := if (k <? too_many - 1)%Z then (k + 1)%Z else too_many.
Definition is_zero (a : R) (k : Z) : bool := Req_bool a 0 && (k =? 0)%Z.

Definition safe_exact (a : R) : R * Z := (Rabs a, 0%Z).
(** For error > 0. *)
Definition safe_within (a error : R) : R * Z :=
  (enlarged (Rmax (fl (Rabs a + error)) (fl (error / eps))), 1%Z).
Definition safe_add (Ba : R) (ka : Z) (Bb : R) (kb : Z) : R * Z :=
  (enlarged (fl (Ba + Bb)), counted (Z.max ka kb)).
Definition safe_multiply (a Ba : R) (ka : Z) (b Bb : R) (kb : Z) : R * Z :=
  if is_zero a ka || is_zero b kb then (0, 0%Z)
  else (Rmax (enlarged (fl (Ba * Bb))) smallest_normal, counted (ka + kb)).
(** v = a 2^e as computed. *)
Definition safe_scale (v a B : R) (k e : Z) : R * Z :=
  let scaled := fl (B * bpow radix2 e) in
  if (0 <=? e)%Z ||
     (Req_bool (fl (v * bpow radix2 (- e))) a && Req_bool (fl (scaled * bpow radix2 (- e))) B)
  then (scaled, k)
  else (Rmax (enlarged scaled) smallest_normal, counted k).
(** None: infinite. *)
Definition safe_error (B : R) (k : Z) : option R :=
  let x := fl (fl (IZR k) * eps) in
  if negb (Rle_bool x 1) || (k =? too_many)%Z then None
  else if (k =? 0)%Z then Some 0
  else Some (enlarged (fl (fl (B * enlarged (fl (x * fl (1 + x)))) + eta))).

Lemma counted_below k : (k < 2 ^ 29)%Z -> counted k = (k + 1)%Z.
Proof.
  unfold counted, too_many. change (2 ^ 29)%Z with 536870912%Z.
  intros. destruct (Z.ltb_spec k (536870912 - 1)); lia.
Qed.

(** The meaning of (B, k). *)
Definition growth (k : Z) : R := (1 + eps) ^ Z.to_nat k.
Definition known (a x : R) (bound : R * Z) : Prop :=
  number (fst bound) /\ (0 <= snd bound)%Z /\ Rabs x <= fst bound /\
  Rabs (a - x) <= fst bound * (growth (snd bound) - 1).

Let rnd_exact := Format.rnd_exact p emin direction.
Let rnd_number := Format.rnd_number p emin direction.
Let rnd_above := Format.rnd_above p emin direction.
Let rnd_nonnegative := Format.rnd_nonnegative p emin direction.
Let rnd_0 := Format.rnd_0 p emin direction.
Let rnd_subnormal := Format.rnd_subnormal p emin direction.
Let sum_subnormal := Format.sum_subnormal p emin direction.

Lemma growth_0 : growth 0 = 1.
Proof. reflexivity. Qed.
Lemma growth_1 k : 1 <= growth k.
Proof. apply pow_R1_Rle. generalize (eps_positive p). lra. Qed.
Lemma growth_succ k : (0 <= k)%Z -> growth (k + 1) = growth k * (1 + eps).
Proof. intros H. unfold growth. rewrite Z2Nat.inj_add, pow_add by lia. simpl. ring. Qed.
Lemma growth_plus k l : (0 <= k)%Z -> (0 <= l)%Z -> growth (k + l) = growth k * growth l.
Proof. intros. unfold growth. now rewrite Z2Nat.inj_add, pow_add by lia. Qed.
Lemma growth_le k l : (k <= l)%Z -> growth k <= growth l.
Proof. intros. apply Rle_pow. generalize (eps_positive p). lra. lia. Qed.

Lemma known_value a x B k : known a x (B, k) -> Rabs a <= B * growth k.
Proof.
  intros (_ & _ & X & A). cbn [fst snd] in *.
  replace a with (x + (a - x)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.

Section Proof.

Context (p_3 : (3 <= p)%Z) (emin_p : (emin <= - p)%Z) (r h : R) (E : rounding_error p emin direction r h).
Let g := 1 + 4 * eps.
Let q := 1 - r.
Hypothesis g_q3 : 1 <= g * (q * q * q).

Let sum_relative := Format.sum_relative p emin direction r h E.
Let rnd_absolute := Format.rnd_absolute p emin direction r h E.
Let rnd_lower := Format.rnd_lower p emin direction r h E.
Let rnd_relative := Format.rnd_relative p emin direction r h E.
Let sum_error := Format.sum_error p emin direction r h E.

Lemma g_1 : 1 <= g.
Proof. unfold g. generalize (eps_positive p). lra. Qed.
Lemma q_1 : 0 < q <= 1.
Proof. unfold q. generalize (error_r _ _ _ _ _ E) (error_r_1 _ _ _ _ _ E). lra. Qed.
Let scaled_covers := Format.scaled_covers p emin direction q q_1 rnd_relative.
Lemma g_q2 : 1 <= g * (q * q).
Proof. generalize g_1. intros. apply (fewer_roundings g q); [lra | apply q_1 | exact g_q3]. Qed.

Lemma enlarged_exact x : enlarged x = fl (x * g).
Proof. unfold enlarged. do 2 f_equal. apply (rnd_factor p emin direction 2); auto; lia. Qed.

(** An enlarged number is at least the number rounded to it, a normal product or any sum. *)
Lemma enlarged_above w x :
  number w -> 0 <= x -> x * q <= w -> (w < smallest_normal -> x <= w) -> x <= enlarged w.
Proof.
  intros. rewrite enlarged_exact. apply scaled_covers with q; auto using g_1, g_q2.
  apply Rle_trans with (x * q); auto. apply Rmult_le_pos; auto. generalize q_1. lra.
Qed.
Lemma enlarged_sum x y :
  number x -> number y -> 0 <= x -> 0 <= y -> x + y <= enlarged (fl (x + y)).
Proof.
  intros. apply enlarged_above; auto; try lra.
  intros. right. symmetry. now apply sum_subnormal.
Qed.

Lemma exact_sound x : number x -> known x x (safe_exact x).
Proof.
  intros N. unfold known, safe_exact. simpl. rewrite growth_0.
  replace (x - x) with 0 by ring. rewrite Rabs_R0.
  repeat split; try lia; try lra. now apply number_abs.
Qed.

Lemma within_sound a x error :
  number a -> number error -> 0 < error -> Rabs (a - x) <= error ->
  known a x (safe_within a error).
Proof.
  intros A N P H. unfold known, safe_within. cbn [fst snd].
  generalize (eps_positive p) q_1 (Rabs_pos a); intros.
  set (w := Rmax (fl (Rabs a + error)) (fl (error / eps))).
  assert (S : Rabs a + error <= enlarged w).
  { apply enlarged_above; [| lra | |].
    - unfold w. apply Rmax_case; apply rnd_number.
    - apply Rle_trans with (2 := Rmax_l _ _). apply sum_relative; auto using number_abs; lra.
    - intros C. apply Rle_trans with (2 := Rmax_l _ _). right. symmetry.
      apply sum_subnormal; auto using number_abs; try lra.
      apply Rle_lt_trans with (2 := C). apply Rmax_l. }
  assert (D : error / eps <= enlarged w).
  { assert (NE : number (error / eps)).
    { unfold Rdiv, Format.eps. rewrite <- bpow_opp. apply mult_bpow_pos_exact_FLT; auto. lia. }
    apply enlarged_above.
    - unfold w. apply Rmax_case; apply rnd_number.
    - apply Rmult_le_pos; [lra |]. now apply Rlt_le, Rinv_0_lt_compat.
    - apply Rle_trans with (2 := Rmax_r _ _). rewrite (rnd_exact _ NE).
      assert (0 <= error / eps).
      { apply Rmult_le_pos; [lra |]. now apply Rlt_le, Rinv_0_lt_compat. }
      nra.
    - intros _. apply Rle_trans with (2 := Rmax_r _ _). rewrite (rnd_exact _ NE). lra. }
  repeat split; try lia.
  - apply rnd_number.
  - replace x with (a - (a - x)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra.
  - apply Rle_trans with (1 := H). unfold growth. simpl.
    replace ((1 + eps) * 1 - 1) with eps by ring.
    replace error with (error / eps * eps) at 1 by (field; lra).
    apply Rmult_le_compat_r; lra.
Qed.

Lemma add_sound a x Ba ka b y Bb kb :
  number a -> number b -> known a x (Ba, ka) -> known b y (Bb, kb) ->
  (Z.max ka kb < 2 ^ 29)%Z ->
  known (fl (a + b)) (x + y) (safe_add Ba ka Bb kb).
Proof.
  intros A B KA KB Few. generalize (known_value _ _ _ _ KA) (known_value _ _ _ _ KB); intros VA VB.
  destruct KA as (NA & PA & XA & HA). destruct KB as (NB & PB & XB & HB). cbn [fst snd] in *.
  unfold known, safe_add. cbn [fst snd].
  rewrite (counted_below _ Few).
  generalize (Rabs_pos x) (Rabs_pos y); intros.
  assert (S : Ba + Bb <= enlarged (fl (Ba + Bb))) by (apply enlarged_sum; auto; lra).
  repeat split; try lia.
  - apply rnd_number.
  - apply Rle_trans with (1 := Rabs_triang _ _). lra.
  - rewrite growth_succ by lia. set (G := growth (Z.max ka kb)).
    assert (Ga : growth ka <= G) by (apply growth_le; lia).
    assert (Gb : growth kb <= G) by (apply growth_le; lia).
    generalize (growth_1 (Z.max ka kb)) (eps_positive p). fold G. intros G1 Pe.
    assert (SE : Rabs (fl (a + b) - (a + b)) <= eps * ((Ba + Bb) * G)).
    { apply Rle_trans with (1 := sum_error a b A B).
      generalize (error_r _ _ _ _ _ E). intros.
      apply Rmult_le_compat; try lra. apply Rabs_pos.
      apply Rle_trans with (1 := Rabs_triang _ _). nra. }
    apply Rle_trans with ((Ba + Bb) * (G * (1 + eps) - 1)).
    + replace (fl (a + b) - (x + y)) with ((fl (a + b) - (a + b)) + ((a - x) + (b - y))) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _).
      apply Rle_trans with (eps * ((Ba + Bb) * G) + (Ba * (G - 1) + Bb * (G - 1))); [| lra].
      apply Rplus_le_compat; auto.
      apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat.
      * apply Rle_trans with (1 := HA). apply Rmult_le_compat_l; lra.
      * apply Rle_trans with (1 := HB). apply Rmult_le_compat_l; lra.
    + apply Rmult_le_compat_r; nra.
Qed.

Lemma multiply_sound a x Ba ka b y Bb kb :
  number a -> number b -> known a x (Ba, ka) -> known b y (Bb, kb) ->
  (ka + kb < 2 ^ 29)%Z ->
  known (fl (a * b)) (x * y) (safe_multiply a Ba ka b Bb kb).
Proof.
  intros A B KA KB Few. generalize (known_value _ _ _ _ KA) (known_value _ _ _ _ KB); intros VA VB.
  destruct KA as (NA & PA & XA & HA). destruct KB as (NB & PB & XB & HB). cbn [fst snd] in *.
  generalize (Rabs_pos x) (Rabs_pos y); intros.
  unfold safe_multiply. destruct (is_zero a ka || is_zero b kb) eqn:Zero.
  { (* an exact zero *)
    assert (Z0 : forall c z C k, is_zero c k = true -> Rabs (c - z) <= C * (growth k - 1) -> c = 0 /\ z = 0).
    { intros c z C k Z D. apply andb_prop in Z. destruct Z as [Z1 Z2]. apply Z.eqb_eq in Z2.
      rewrite Z2, growth_0, Rminus_eq_0, Rmult_0_r in D. apply within_0 in D. subst z. revert Z1.
      now case Req_bool_spec. }
    assert (Z1 : a * b = 0 /\ x * y = 0).
    { apply orb_prop in Zero. destruct Zero as [Zero | Zero]; eapply Z0 in Zero; eauto; destruct Zero as [-> ->]; lra. }
    destruct Z1 as [-> ->]. rewrite rnd_0. unfold known. simpl.
    rewrite Rminus_0_r, Rabs_R0. repeat split; try lia; try lra. apply number_0. }
  unfold known. cbn [fst snd]. rewrite (counted_below _ Few).
  set (B' := Rmax (enlarged (fl (Ba * Bb))) smallest_normal).
  assert (PP : 0 <= Ba * Bb) by (apply Rmult_le_pos; lra).
  assert (M : smallest_normal <= B') by apply Rmax_r.
  assert (S : Ba * Bb <= B').
  { destruct (Rlt_or_le (Ba * Bb) smallest_normal) as [C | C]; [lra |].
    apply Rle_trans with (2 := Rmax_l _ _). apply enlarged_above; auto.
    intros D. apply rnd_subnormal in D. lra. }
  repeat split; try lia.
  - apply Rmax_case. apply rnd_number. now apply number_smallest_normal.
  - rewrite Rabs_mult. apply Rle_trans with (2 := S). apply Rmult_le_compat; lra.
  - rewrite growth_succ, growth_plus by lia.
    set (Ga := growth ka) in *. set (Gb := growth kb) in *.
    assert (1 <= Ga) by apply growth_1. assert (1 <= Gb) by apply growth_1.
    generalize (eps_positive p) (Rabs_pos a) (Rabs_pos b) (smallest_normal_positive p emin); intros.
    assert (G1 : 1 <= Ga * Gb) by nra.
    assert (HP : Rabs (a * b - x * y) <= Ba * Bb * (Ga * Gb - 1)).
    { replace (a * b - x * y) with (a * (b - y) + (a - x) * y) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult.
      apply Rle_trans with (Ba * Ga * (Bb * (Gb - 1)) + Ba * (Ga - 1) * Bb).
      - apply Rplus_le_compat; apply Rmult_le_compat; auto using Rabs_pos.
      - right. ring. }
    assert (V : Rabs (a * b) <= Ba * Bb * (Ga * Gb)).
    { rewrite Rabs_mult. apply Rle_trans with (Ba * Ga * (Bb * Gb)).
      - apply Rmult_le_compat; auto.
      - right. ring. }
    assert (HR : Rabs (fl (a * b) - a * b) <= B' * (Ga * Gb) * eps).
    { generalize (error_r _ _ _ _ _ E) (error_h _ _ _ _ _ E). intros.
      destruct (Rlt_or_le (Rabs (a * b)) smallest_normal) as [C | C].
      - apply Rle_trans with (1 := error_absolute _ _ _ _ _ E _ C).
        apply Rle_trans with eta; [lra |]. rewrite <- (smallest_normal_eps p emin).
        apply Rmult_le_compat_r; [lra |].
        apply Rle_trans with (1 := M). assert (0 <= B') by lra. nra.
      - apply Rle_trans with (1 := error_relative _ _ _ _ _ E _ C).
        rewrite Rmult_comm. apply Rmult_le_compat; try lra.
        apply Rle_trans with (1 := V). apply Rmult_le_compat_r; lra. }
    replace (fl (a * b) - x * y) with ((fl (a * b) - a * b) + (a * b - x * y)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _).
    apply Rle_trans with (B' * (Ga * Gb) * eps + B' * (Ga * Gb - 1)).
    + apply Rplus_le_compat; auto. apply Rle_trans with (1 := HP).
      apply Rmult_le_compat_r; lra.
    + right. ring.
Qed.

Lemma known_scale a x B k e : number (B * bpow radix2 e) -> known a x (B, k) ->
  known (a * bpow radix2 e) (x * bpow radix2 e) (B * bpow radix2 e, k).
Proof.
  intros N (_ & K & X & H). unfold known. cbn [fst snd] in *. generalize (bpow_ge_0 radix2 e). intros P.
  rewrite <- Rmult_minus_distr_r, !Rabs_mult, (Rabs_pos_eq (bpow _ _)) by auto.
  repeat split; auto.
  - now apply Rmult_le_compat_r.
  - replace (B * bpow radix2 e * (growth k - 1)) with (B * (growth k - 1) * bpow radix2 e) by ring.
    now apply Rmult_le_compat_r.
Qed.
Lemma scale_sound a x B k e :
  number a -> known a x (B, k) -> (k < 2 ^ 29)%Z ->
  known (fl (a * bpow radix2 e)) (x * bpow radix2 e) (safe_scale (fl (a * bpow radix2 e)) a B k e).
Proof.
  intros A K Few. generalize K. intros (NB & Pk & X & H). cbn [fst snd] in *. unfold safe_scale. cbv zeta.
  set (v := fl (a * bpow radix2 e)). set (s := fl (B * bpow radix2 e)).
  generalize (bpow_ge_0 radix2 e) (Rabs_pos x) (growth_1 k) (eps_positive p). intros PB PX G1 Pe.
  assert (Exact : v = a * bpow radix2 e -> s = B * bpow radix2 e ->
                  known v (x * bpow radix2 e) (s, k)).
  { intros -> S. rewrite S. apply known_scale; auto. rewrite <- S. apply rnd_number. }
  assert (Inexact : known v (x * bpow radix2 e) (Rmax (enlarged s) smallest_normal, counted k)).
  { set (B' := Rmax (enlarged s) smallest_normal).
    assert (M : smallest_normal <= B') by apply Rmax_r.
    assert (S : B * bpow radix2 e <= B').
    { destruct (Rlt_or_le (B * bpow radix2 e) smallest_normal) as [C | C]; [lra |].
      apply Rle_trans with (2 := Rmax_l _ _). apply enlarged_above.
      - apply rnd_number.
      - generalize (smallest_normal_positive p emin). lra.
      - now apply rnd_relative.
      - intros D. apply rnd_subnormal in D. lra. }
    assert (D : Rabs (v - a * bpow radix2 e) <= h) by now apply (scale_error p emin direction r h E).
    unfold known. cbn [fst snd]. rewrite (counted_below k) by (unfold too_many in *; lia).
    repeat split; try lia.
    - apply Rmax_case. apply rnd_number. now apply number_smallest_normal.
    - rewrite Rabs_mult, (Rabs_pos_eq (bpow _ _)) by auto. apply Rle_trans with (2 := S).
      now apply Rmult_le_compat_r.
    - rewrite growth_succ by lia.
      replace (v - x * bpow radix2 e) with ((v - a * bpow radix2 e) + (a - x) * bpow radix2 e) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_mult, (Rabs_pos_eq (bpow _ _)) by auto.
      apply Rle_trans with (smallest_normal * eps + B * bpow radix2 e * (growth k - 1)).
      + rewrite smallest_normal_eps. generalize (error_h _ _ _ _ _ E). intros Ph.
        assert (Rabs (a - x) * bpow radix2 e <= B * (growth k - 1) * bpow radix2 e) by
          now apply Rmult_le_compat_r.
        lra.
      + generalize (smallest_normal_positive p emin). intros Pm.
        assert (smallest_normal * eps <= B' * eps) by (apply Rmult_le_compat_r; lra).
        assert (B * bpow radix2 e * (growth k - 1) <= B' * (growth k - 1)) by
          (apply Rmult_le_compat_r; lra).
        assert (B' * eps * 1 <= B' * eps * growth k).
        { apply Rmult_le_compat_l; auto. apply Rmult_le_pos; lra. }
        lra. }
  destruct (Z.leb_spec 0 e) as [P | P]; cbn [orb].
  { apply Exact; apply scale_up; auto. }
  destruct (Req_bool_spec (fl (v * bpow radix2 (- e))) a) as [C | C]; auto.
  destruct (Req_bool_spec (fl (s * bpow radix2 (- e))) B) as [D | D]; auto.
  cbn [andb]. apply Exact; apply (scale_back p emin direction); auto; apply rnd_number.
Qed.

Hypothesis emin_2p : (emin <= 2 - 2 * p)%Z.

Lemma error_sound a x B k bound :
  known a x (B, k) -> safe_error B k = Some bound -> Rabs (a - x) <= bound.
Proof.
  intros (NB & Pk & XB & H). cbn [fst snd] in *. unfold safe_error. cbv zeta.
  destruct (k =? too_many)%Z.
  { rewrite orb_true_r. discriminate. }
  rewrite orb_false_r.
  generalize (Rabs_pos x) (eps_positive p) g_1 q_1 (error_h _ _ _ _ _ E); intros PB Pe G1 Q1 Ph.
  destruct (Z.le_gt_cases k (2 ^ p)) as [K | K].
  - assert (Nk : number (IZR k)).
    { rewrite <- (Rmult_1_r (IZR k)). change 1 with (bpow radix2 0).
      apply number_integer; auto; lia. }
    assert (Nx : number (IZR k * eps)) by (apply number_integer; auto; lia).
    rewrite (rnd_exact _ Nk), (rnd_exact _ Nx). set (s := IZR k * eps) in *.
    destruct (Rle_bool_spec s 1) as [S1 | S1]; simpl; [| discriminate].
    destruct (Z.eqb_spec k 0) as [K0 | K0]; intros G; injection G as <-.
    { rewrite K0, growth_0 in H. lra. }
    assert (N1 : number (1 + s)).
    { replace (1 + s) with (IZR (2 ^ (p - 1) + k) * bpow radix2 (1 - p)).
      - apply number_integer; auto; try lia.
        assert (D : (2 ^ p = 2 * 2 ^ (p - 1))%Z).
        { replace p with (Z.succ (p - 1)) at 1 by lia. apply Z.pow_succ_r. lia. }
        rewrite Z.abs_eq by (generalize (Z.pow_nonneg 2 (p - 1)); lia).
        enough (k <= 2 ^ (p - 1))%Z by lia. apply le_IZR.
        change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
        replace (p - 1)%Z with (- (1 - p))%Z by lia. rewrite bpow_opp.
        apply Rmult_le_reg_r with eps; auto. unfold Format.eps at 2.
        rewrite Rinv_l; [exact S1 | apply Rgt_not_eq, bpow_gt_0].
      - rewrite plus_IZR, Rmult_plus_distr_r. fold eps.
        change (bpow radix2 (1 - p)) with eps. fold s. f_equal.
        change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia. unfold Format.eps.
        rewrite <- bpow_plus. replace (p - 1 + (1 - p))%Z with 0%Z by lia. reflexivity. }
    rewrite (rnd_exact _ N1).
    assert (Ss : eps <= s).
    { unfold s. assert (1 <= IZR k) by (apply IZR_le; lia). nra. }
    assert (M : smallest_normal <= s * (1 + s)).
    { apply Rle_trans with eps.
      - apply bpow_le. lia.
      - generalize (Rle_0_sqr s). unfold Rsqr. lra. }
    set (y := enlarged (fl (s * (1 + s)))).
    assert (Y : s * (1 + s) <= y).
    { apply enlarged_above; auto.
      - generalize (smallest_normal_positive p emin). lra.
      - intros D. apply rnd_subnormal in D. lra. }
    assert (Grow : growth k - 1 <= s * (1 + s)).
    { unfold growth. assert (I : INR (Z.to_nat k) = IZR k).
      { rewrite INR_IZR_INZ, Z2Nat.id; auto. }
      generalize (power_quadratic eps (Z.to_nat k)). rewrite I. fold s. intros Q.
      specialize (Q ltac:(lra) S1). lra. }
    apply Rle_trans with (B * y).
    { apply Rle_trans with (1 := H). apply Rmult_le_compat_l; lra. }
    assert (PBy : 0 <= B * y).
    { apply Rmult_le_pos; [lra |]. generalize (smallest_normal_positive p emin). lra. }
    rewrite enlarged_exact. set (P := fl (B * y)). set (w := fl (P + eta)).
    assert (NP : number P) by apply rnd_number.
    assert (PP : 0 <= P) by now apply rnd_nonnegative.
    assert (Nw : number w) by apply rnd_number.
    assert (PW : P <= w) by (apply rnd_above; auto; lra).
    apply scaled_covers with (q * q); auto; try lra.
    + apply Rle_trans with (2 := sum_relative P eta NP (number_eta p emin) PP ltac:(lra)). fold q.
      rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [lra |]. generalize (rnd_lower (B * y) PBy). fold P q. lra.
    + intros C. unfold w. rewrite sum_subnormal; auto using number_eta; try lra.
      enough (B * y - h <= P) by lra. apply rnd_absolute; auto. apply rnd_subnormal. fold P. lra.
  - (* such counts are refused *)
    assert (T : 2 <= fl (fl (IZR k) * eps)).
    { assert (N2 : forall e, (0 <= e)%Z -> number (bpow radix2 e)).
      { intros e He. apply number_power; auto. lia. }
      change 2 with (bpow radix2 1). apply rnd_above; [apply N2; lia |].
      replace 1%Z with (p + (1 - p))%Z by lia. rewrite bpow_plus.
      apply Rmult_le_compat_r; [apply bpow_ge_0 |].
      apply rnd_above; [apply N2; lia |]. rewrite <- IZR_Zpower by lia. apply IZR_le. simpl. lia. }
    destruct (Rle_bool_spec (fl (fl (IZR k) * eps)) 1) as [L | L]; simpl; [lra | discriminate].
Qed.

End Proof.

(** The theorems on the code's results. *)
Context (enough_bits : (4 <= p)%Z \/ ((3 <= p)%Z /\ direction = nearest)) (emin_p : (emin <= - p)%Z).

Lemma three_roundings_any e : 0 <= e <= / 8 -> 1 <= (1 + 4 * e) * ((1 - e) * (1 - e) * (1 - e)).
Proof. intros H. nra. Qed.
Lemma three_roundings_nearest e :
  0 <= e <= / 8 -> 1 <= (1 + 8 * e) * ((1 - e) * (1 - e) * (1 - e)).
Proof. intros H. nra. Qed.

Lemma a_rounding : exists r h, rounding_error p emin direction r h /\
  1 <= (1 + 4 * eps) * ((1 - r) * (1 - r) * (1 - r)).
Proof.
  destruct enough_bits as [P | [P ->]].
  - exists eps, eta. split.
    + apply rounding_error_any; auto; lia.
    + apply three_roundings_any. generalize (eps_positive p) (eps_le p 4 P). simpl. lra.
  - exists (u p), (eta / 2). split.
    + apply rounding_error_nearest; auto; lia.
    + rewrite eps_2u. replace (1 + 4 * (2 * u p)) with (1 + 8 * u p) by ring.
      apply three_roundings_nearest.
      generalize (u_positive p) (eps_le p 3 P) (eps_2u p). simpl. lra.
Qed.
Lemma three_bits : (3 <= p)%Z.
Proof. destruct enough_bits; lia. Qed.

Theorem safe_exact_sound x : number x -> known x x (safe_exact x).
Proof. apply exact_sound. Qed.

Theorem safe_within_sound a x error :
  number a -> number error -> 0 < error -> Rabs (a - x) <= error ->
  known a x (safe_within a error).
Proof. destruct a_rounding as (r & h & E & G). apply (within_sound three_bits emin_p r h E G). Qed.

Theorem safe_add_sound a x Ba ka b y Bb kb :
  number a -> number b -> known a x (Ba, ka) -> known b y (Bb, kb) ->
  (Z.max ka kb < 2 ^ 29)%Z ->
  known (fl (a + b)) (x + y) (safe_add Ba ka Bb kb).
Proof. destruct a_rounding as (r & h & E & G). apply (add_sound three_bits emin_p r h E G). Qed.

Lemma known_opp a x bound : known a x bound -> known (- a) (- x) bound.
Proof.
  intros (N & K & X & A). unfold known. rewrite Rabs_Ropp.
  replace (- a - - x) with (- (a - x)) by ring. rewrite Rabs_Ropp. auto.
Qed.

Theorem safe_subtract_sound a x Ba ka b y Bb kb :
  number a -> number b -> known a x (Ba, ka) -> known b y (Bb, kb) ->
  (Z.max ka kb < 2 ^ 29)%Z ->
  known (fl (a - b)) (x - y) (safe_add Ba ka Bb kb).
Proof. intros. apply safe_add_sound; auto using number_opp, known_opp. Qed.

Theorem safe_multiply_sound a x Ba ka b y Bb kb :
  number a -> number b -> known a x (Ba, ka) -> known b y (Bb, kb) ->
  (ka + kb < 2 ^ 29)%Z ->
  known (fl (a * b)) (x * y) (safe_multiply a Ba ka b Bb kb).
Proof. destruct a_rounding as (r & h & E & G). apply (multiply_sound three_bits emin_p r h E G). Qed.

Theorem safe_scale_sound a x B k e :
  number a -> known a x (B, k) -> (k < 2 ^ 29)%Z ->
  known (fl (a * bpow radix2 e)) (x * bpow radix2 e) (safe_scale (fl (a * bpow radix2 e)) a B k e).
Proof. destruct a_rounding as (r & h & E & G). apply (scale_sound three_bits emin_p r h E G). Qed.

(** eps^2 must be a number too, as in every IEEE format. *)
Theorem safe_error_sound a x B k bound :
  (emin <= 2 - 2 * p)%Z ->
  known a x (B, k) -> safe_error B k = Some bound -> Rabs (a - x) <= bound.
Proof.
  intros L. destruct a_rounding as (r & h & E & G).
  now apply (error_sound three_bits emin_p r h E G).
Qed.

End Safe.
