(** Numbers with twice double's precision (ccd/batch/twofold.hpp), and the sign of Y at any time of the step that
    ccd/batch/time_stage.hpp computes from them. double, to nearest. Results:
        fast_two_sum_near    fast_two_sum of any two numbers has an error of at most 2u of the second
        sum_near             a sum adds an error of 5u² of its operands' sizes
        product_near         a product adds 13u², if it is far from underflow
        product_rounded, product_rounded_fma   results of both algorithms for a product's error, including underflow
        difference_exact     differences of coordinates are exact
        y_near, time_stage_sign, error_enough   if the value exceeds error(), Y has its sign *)

From Coq Require Import Reals ZArith Lia Lra Psatz List.
From Flocq Require Import Core.
From Errbound Require Import Format ErrorFree.
Import ListNotations.
Open Scope R_scope.

#[local] Instance double_precision : Prec_gt_0 53 := eq_refl.
Notation fl := (rnd 53 (-1074) nearest).
Notation double := (number 53 (-1074)).
Notation u := (u 53).
Notation eta := (eta (-1074)).
Notation two_sum := (two_sum 53 (-1074)).
Notation fast_two_sum := (fast_two_sum 53 (-1074)).

Lemma u_small : 0 < u <= / 1099511627776.
Proof. split; [apply u_positive |]. unfold Format.u. apply Rle_trans with (bpow radix2 (-40)); [apply bpow_le; lia | simpl; lra]. Qed.
Lemma fl_number x : double (fl x).
Proof. apply rnd_number; auto with typeclass_instances. Qed.
Lemma fl_sum x y : double x -> double y -> Rabs (fl (x + y) - (x + y)) <= u * Rabs (x + y).
Proof. apply (sum_error 53 (-1074) nearest _ _ (rounding_error_nearest 53 (-1074) ltac:(lia))). Qed.
Lemma fl_difference x y : double x -> double y -> Rabs (fl (x - y) - (x - y)) <= u * Rabs (x - y).
Proof. intros X Y. apply (fl_sum x (- y)); auto. now apply number_opp. Qed.
Lemma fl_any x : Rabs (fl x - x) <= u * Rabs x + eta.
Proof.
  pose proof (error_any _ _ _ _ _ (rounding_error_nearest 53 (-1074) ltac:(lia)) x). pose proof (eta_positive (-1074)). lra.
Qed.

(** |x| <= m as an interval, so that lra can add. *)
Ltac unabs := repeat match goal with
  | H : Rabs _ <= _ |- _ => apply Rabs_le_inv in H
  | |- Rabs _ <= _ => apply Rabs_le
  end.
Lemma triangle x y m n : Rabs x <= m -> Rabs y <= n -> Rabs (x + y) <= m + n.
Proof. intros X Y. pose proof (Rabs_triang x y). lra. Qed.

Theorem fast_two_sum_near x y : double x -> double y -> Rabs x <= Rabs y -> let r := fast_two_sum x y in
  Rabs (fst r + snd r - (x + y)) <= 2 * u * Rabs y /\ Rabs (snd r) <= 5 * u * Rabs y.
Proof.
  intros X Y L. unfold ErrorFree.fast_two_sum. cbn [fst snd]. pose proof u_small as U. pose proof (Rabs_pos y) as Y0.
  set (s := fl (x + y)). set (z := fl (s - x)). set (e := fl (y - z)).
  pose proof (fl_sum x y X Y) as H1. fold s in H1.
  pose proof (fl_difference s x (fl_number _) X) as H2. fold z in H2.
  pose proof (fl_difference y z Y (fl_number _)) as H3. fold e in H3. set (m := Rabs y) in *.
  assert (B1 : Rabs (x + y) <= 2 * m) by (pose proof (Rabs_triang x y); fold m in H; lra).
  assert (R : Rabs (s - (x + y)) <= 2 * (u * m)) by nra.
  assert (B2 : Rabs (s - x) <= m + 2 * (u * m)).
  { replace (s - x) with (y + (s - (x + y))) by ring. apply triangle; auto. fold m. lra. }
  assert (D2 : Rabs (z - (s - x)) <= u * m + 2 * (u * (u * m))) by nra.
  assert (B3 : Rabs (y - z) <= 3 * (u * m) + 2 * (u * (u * m))).
  { replace (y - z) with (- (s - (x + y)) + - (z - (s - x))) by ring.
    eapply Rle_trans; [apply Rabs_triang |]. rewrite !Rabs_Ropp. lra. }
  assert (D3 : Rabs (e - (y - z)) <= 3 * (u * (u * m)) + 2 * (u * (u * (u * m)))) by nra.
  assert (Um : 0 <= u * m) by (apply Rmult_le_pos; lra).
  assert (U1 : u * (u * m) <= / 1024 * (u * m)) by (apply Rmult_le_compat_r; lra).
  assert (U2 : u * (u * (u * m)) <= / 1024 * (u * m)).
  { assert (0 <= u * (u * m)) by (apply Rmult_le_pos; lra).
    assert (u * (u * (u * m)) <= / 1024 * (u * (u * m))); [apply Rmult_le_compat_r |]; lra. }
  split.
  - replace (s + e - (x + y)) with (e - (y - z) + - (z - (s - x))) by ring.
    eapply Rle_trans; [apply Rabs_triang |]. rewrite Rabs_Ropp. lra.
  - replace e with (e - (y - z) + (y - z)) by ring. eapply Rle_trans; [apply Rabs_triang |]. lra.
Qed.

(** ** Operations *)

(** x is known by a within k; m bounds its size, and those of a's components. *)
Record known (a : R * R) (x m k : R) : Prop := {
  known_value : double (fst a); known_error : double (snd a); known_size : Rabs x <= m;
  known_first : Rabs (fst a) <= 33 / 32 * m; known_second : Rabs (snd a) <= 33 / 32 * (u * m);
  known_to : Rabs (fst a + snd a - x) <= k }.

(** twofold::normal; the error is below the value's last place, or both are tiny. *)
Lemma normal_near x y X m k : double x -> double y -> Rabs X <= m -> Rabs (x + y - X) <= k -> k <= / 64 * (u * m) ->
  (Rabs x < Rabs y -> Rabs y <= / 1024 * m) -> let r := fast_two_sum x y in
  (Rabs y <= Rabs x /\ known r X m k /\ Rabs (snd r) <= 2 * u * Rabs (fst r)) \/
  (Rabs x < Rabs y /\ known r X m (k + 2 * u * Rabs y) /\ Rabs (snd r) <= 5 * u * Rabs y).
Proof.
  intros Nx Ny Xm H K T r. pose proof u_small as U. pose proof (Rabs_pos X) as X0. assert (M : 0 <= m) by lra.
  assert (Um : 0 <= u * m) by (apply Rmult_le_pos; lra).
  assert (Us : u * m <= / 1024 * m) by (apply Rmult_le_compat_r; lra).
  assert (Sxy : Rabs (x + y) <= m + / 64 * (u * m)).
  { replace (x + y) with (X + (x + y - X)) by ring. apply triangle; lra. }
  pose proof (fl_sum x y Nx Ny) as R1.
  assert (Uxy : u * Rabs (x + y) <= u * m + / 64 * (/ 1024 * (u * m))).
  { assert (u * (u * m) <= / 1024 * (u * m)) by (apply Rmult_le_compat_r; lra).
    assert (u * Rabs (x + y) <= u * (m + / 64 * (u * m))) by (apply Rmult_le_compat_l; lra). lra. }
  assert (F : Rabs (fst r) <= 33 / 32 * m).
  { unfold r, ErrorFree.fast_two_sum. cbn [fst]. replace (fl (x + y)) with (fl (x + y) - (x + y) + (x + y)) by ring.
    eapply Rle_trans; [apply Rabs_triang |]. lra. }
  destruct (Rle_or_lt (Rabs y) (Rabs x)) as [L | L].
  - left. split; auto. assert (E : fst r + snd r = x + y).
    { apply fast_two_sum_exact; auto; lia. }
    assert (Es : Rabs (snd r) <= u * Rabs (x + y)).
    { replace (snd r) with (- (fst r - (x + y))) by lra. rewrite Rabs_Ropp. exact R1. }
    split; [constructor; auto; try apply fl_number; [lra | now rewrite E] |].
    assert (Rabs (x + y) <= Rabs (fst r) + Rabs (snd r)) by (rewrite <- E; apply Rabs_triang).
    pose proof (Rabs_pos (snd r)). pose proof (Rabs_pos (fst r)).
    assert (u * Rabs (x + y) <= u * (Rabs (fst r) + Rabs (snd r))) by (apply Rmult_le_compat_l; lra).
    assert (u * Rabs (snd r) <= / 2 * Rabs (snd r)) by (apply Rmult_le_compat_r; lra). lra.
  - right. split; auto. destruct (fast_two_sum_near x y Nx Ny ltac:(lra)) as (N & S). fold r in N, S.
    specialize (T L). assert (u * Rabs y <= u * (/ 1024 * m)) by (apply Rmult_le_compat_l; lra).
    split; [constructor; auto; try apply fl_number; [lra |] | auto].
    replace (fst r + snd r - X) with (fst r + snd r - (x + y) + (x + y - X)) by ring.
    eapply Rle_trans; [apply Rabs_triang |]. lra.
Qed.

Definition sum (a b : R * R) : R * R :=
  let s := two_sum (fst a) (fst b) in fast_two_sum (fst s) (fl (snd s + fl (snd a + snd b))).
Theorem sum_near a b x y A B k l m : known a x A k -> known b y B l -> Rabs (x + y) <= m -> A + B <= 64 * m ->
  k + l + 5 * (u * (u * (A + B))) <= / 64 * (u * m) ->
  known (sum a b) (x + y) m (k + l + 5 * (u * (u * (A + B)))) /\
  (Rabs (snd (sum a b)) <= 2 * u * Rabs (fst (sum a b)) \/ Rabs (snd (sum a b)) <= 6 * (u * (u * (A + B)))).
Proof.
  intros Ka Kb Hm HS Hk. unfold sum. destruct Ka as [Av Ae Ax A1 A2 A3], Kb as [Bv Be By B1 B2 B3].
  destruct a as (av, ae), b as (bv, be). cbn [fst snd] in *. pose proof u_small as U.
  set (S := A + B) in *. assert (S0 : 0 <= S) by (pose proof (Rabs_pos x); pose proof (Rabs_pos y); unfold S; lra).
  assert (Us : 0 <= u * S) by (apply Rmult_le_pos; lra).
  assert (Uus : 0 <= u * (u * S)) by (apply Rmult_le_pos; lra).
  assert (U3 : u * (u * (u * S)) <= / 1024 * (u * (u * S))) by (apply Rmult_le_compat_r; lra).
  pose proof (two_sum_exact 53 (-1074) ltac:(lia) av bv ltac:(lia) Av Bv) as E.
  assert (Ns : double (fst (two_sum av bv)) /\ double (snd (two_sum av bv))) by (split; apply fl_number).
  assert (Fs : fst (two_sum av bv) = fl (av + bv)) by easy.
  destruct (two_sum av bv) as (s, e). cbn [fst snd] in *. destruct Ns as (Ns & Ne).
  pose proof (fl_sum av bv Av Bv) as R1. rewrite <- Fs in R1.
  assert (Sv : Rabs (av + bv) <= 33 / 32 * S) by (eapply Rle_trans; [apply Rabs_triang |]; unfold S; lra).
  assert (E1 : Rabs e <= 33 / 32 * (u * S)).
  { replace e with (- (s - (av + bv))) by lra. rewrite Rabs_Ropp. nra. }
  pose proof (fl_sum ae be Ae Be) as R2. set (f := fl (ae + be)) in *.
  assert (Se : Rabs (ae + be) <= 33 / 32 * (u * S)).
  { eapply Rle_trans; [apply Rabs_triang |]. unfold S. rewrite Rmult_plus_distr_l. lra. }
  assert (R2' : Rabs (f - (ae + be)) <= 33 / 32 * (u * (u * S))) by nra.
  assert (F1 : Rabs f <= 34 / 32 * (u * S)).
  { replace f with (f - (ae + be) + (ae + be)) by ring. eapply Rle_trans; [apply Rabs_triang |].
    assert (u * (u * S) <= / 1024 * (u * S)) by (apply Rmult_le_compat_r; lra). lra. }
  pose proof (fl_sum e f Ne (fl_number _)) as R3. set (z := fl (e + f)) in *.
  assert (Small : u * S <= / 4096 * m * / 16384) by nra.
  assert (To : Rabs (s + z - (x + y)) <= k + l + 33 / 32 * (u * (u * S)) + u * Rabs (e + f)).
  { replace (s + z - (x + y)) with (av + ae - x + (bv + be - y) + (f - (ae + be)) + (z - (e + f))) by lra.
    repeat (eapply Rle_trans; [apply Rabs_triang |]; apply Rplus_le_compat; auto). }
  assert (Z1 : Rabs z <= (1 + u) * (Rabs e + Rabs f)).
  { replace z with (z - (e + f) + (e + f)) by ring. eapply Rle_trans; [apply Rabs_triang |].
    pose proof (Rabs_triang e f). nra. }
  assert (Ef : u * Rabs (e + f) <= 68 / 32 * (u * (u * S))).
  { pose proof (Rabs_triang e f). assert (Rabs (e + f) <= 68 / 32 * (u * S)) by lra. nra. }
  destruct (Rle_or_lt (Rabs z) (Rabs s)) as [L | L].
  - destruct (normal_near s z (x + y) m (k + l + 5 * (u * (u * S))) Ns (fl_number _)) as [(_ & K & R) | (L' & _)]; auto; lra.
  - (* the rest is tiny *)
    pose proof (Rabs_pos e) as E0. pose proof (Rabs_pos f) as F0. pose proof (Rabs_pos s) as S1.
    assert (Es : Rabs e <= 2 * u * Rabs z).
    { assert (Rabs e <= u * (Rabs s + Rabs e)).
      { replace e with (- (s - (av + bv))) at 1 by lra. rewrite Rabs_Ropp. apply Rle_trans with (1 := R1).
        apply Rmult_le_compat_l; [lra |]. rewrite <- E. apply Rabs_triang. }
      assert (u * Rabs e <= / 2 * Rabs e) by (apply Rmult_le_compat_r; lra).
      assert (u * Rabs s <= u * Rabs z) by (apply Rmult_le_compat_l; lra). lra. }
    assert (Zs : Rabs z <= 35 / 32 * (u * S)).
    { assert (u * Rabs z <= / 4096 * Rabs z) by (apply Rmult_le_compat_r; lra).
      assert (u * (Rabs e + Rabs f) <= / 4096 * (Rabs e + Rabs f)) by (apply Rmult_le_compat_r; lra). lra. }
    assert (Zu : u * Rabs z <= 35 / 32 * (u * (u * S))) by nra.
    assert (Ef' : u * Rabs (e + f) <= 36 / 32 * (u * (u * S))).
    { pose proof (Rabs_triang e f). assert (Rabs (e + f) <= 2 * (u * Rabs z) + 34 / 32 * (u * S)) by lra.
      assert (u * (u * Rabs z) <= / 1024 * (u * Rabs z)) by (apply Rmult_le_compat_r; nra). nra. }
    set (k' := k + l + 70 / 32 * (u * (u * S))).
    destruct (normal_near s z (x + y) m k' Ns (fl_number _)) as [(L' & _) | (_ & K & R)]; auto; unfold k' in *; try lra.
    split; [| right; lra]. destruct K as [K1 K2 K3 K4 K5 K6]. constructor; auto. lra.
Qed.

(** Products with any algorithm for their errors. *)
Section Products.

Context (two_product : R -> R -> R * R) (lost : R) (two_product_near : forall a b, double a -> double b -> fst
    (two_product a b) = fl (a * b) /\ double (snd (two_product a b)) /\ Rabs (fst (two_product a b) + snd (two_product
    a b) - a * b) <= lost).

Definition product (a b : R * R) : R * R :=
  let p := two_product (fst a) (fst b) in
  fast_two_sum (fst p) (fl (snd p + fl (fl (fst a * snd b) + fl (snd a * fst b)))).
Lemma product_of x y A B : Rabs x <= A -> Rabs y <= B -> Rabs (x * y) <= A * B.
Proof. intros X Y. rewrite Rabs_mult. apply Rmult_le_compat; auto using Rabs_pos. Qed.

Theorem product_near a b x y A B k l : known a x A k -> known b y B l ->
  lost <= / 64 * (u * (u * (A * B))) -> eta <= / 64 * (u * (u * (A * B))) ->
  A * l + B * k + k * l + 13 * (u * (u * (A * B))) <= / 64 * (u * (A * B)) ->
  known (product a b) (x * y) (A * B) (A * l + B * k + k * l + 13 * (u * (u * (A * B)))).
Proof.
  intros Ka Kb Hl He Hk. unfold product. destruct Ka as [Av Ae Ax A1 A2 A3], Kb as [Bv Be By B1 B2 B3].
  destruct a as (av, ae), b as (bv, be). cbn [fst snd] in *. pose proof u_small as U. pose proof (eta_positive (-1074)) as H0.
  destruct (two_product_near av bv Av Bv) as (Ep & Npe & Lp). destruct (two_product av bv) as (p, pe). cbn [fst snd] in *.
  assert (A0 : 0 <= A) by (pose proof (Rabs_pos x); lra). assert (B0 : 0 <= B) by (pose proof (Rabs_pos y); lra).
  set (P := A * B) in *. assert (P0 : 0 <= P) by (now apply Rmult_le_pos).
  assert (Up : 0 <= u * P) by (apply Rmult_le_pos; lra). assert (Uup : 0 <= u * (u * P)) by (apply Rmult_le_pos; lra).
  assert (U2 : u * (u * P) <= / 4096 * (u * P)) by (apply Rmult_le_compat_r; lra).
  assert (U1 : u * P <= / 4096 * P) by (apply Rmult_le_compat_r; lra).
  assert (Pv : Rabs (av * bv) <= 1089 / 1024 * P).
  { apply Rle_trans with (33 / 32 * A * (33 / 32 * B)); [now apply product_of | unfold P; lra]. }
  assert (Px : Rabs (av * be) <= 1089 / 1024 * (u * P)).
  { apply Rle_trans with (33 / 32 * A * (33 / 32 * (u * B))); [now apply product_of | unfold P; lra]. }
  assert (Py : Rabs (ae * bv) <= 1089 / 1024 * (u * P)).
  { apply Rle_trans with (33 / 32 * (u * A) * (33 / 32 * B)); [now apply product_of | unfold P; lra]. }
  assert (Pe : Rabs (ae * be) <= 1089 / 1024 * (u * (u * P))).
  { apply Rle_trans with (33 / 32 * (u * A) * (33 / 32 * (u * B))); [now apply product_of | unfold P; lra]. }
  assert (Scale : forall q r, Rabs q <= r -> u * Rabs q <= u * r) by (intros; apply Rmult_le_compat_l; lra).
  pose proof (fl_any (av * bv)) as Rp. rewrite <- Ep in Rp. pose proof (Scale _ _ Pv).
  pose proof (fl_any (av * be)) as Rx. pose proof (Scale _ _ Px). set (q := fl (av * be)) in *.
  pose proof (fl_any (ae * bv)) as Ry. pose proof (Scale _ _ Py). set (r := fl (ae * bv)) in *.
  assert (Qr : Rabs (q + r) <= 9 / 4 * (u * P)).
  { replace (q + r) with (q - av * be + av * be + (r - ae * bv + ae * bv)) by ring.
    eapply Rle_trans; [apply triangle; apply triangle; eassumption |]. lra. }
  pose proof (fl_sum q r (fl_number _) (fl_number _)) as Rg. pose proof (Scale _ _ Qr). set (g := fl (q + r)) in *.
  assert (G1 : Rabs g <= 37 / 16 * (u * P)).
  { replace g with (g - (q + r) + (q + r)) by ring. eapply Rle_trans; [apply triangle; eassumption |]. lra. }
  assert (Pe1 : Rabs pe <= u * Rabs (av * bv) + eta + lost).
  { replace pe with (p + pe - av * bv + - (p - av * bv)) by ring. eapply Rle_trans; [apply Rabs_triang |].
    rewrite Rabs_Ropp. lra. }
  pose proof (fl_sum pe g Npe (fl_number _)) as Rz. set (z := fl (pe + g)) in *.
  assert (To : Rabs (p + z - x * y) <= A * l + B * k + k * l + (lost + u * Rabs (pe + g) + u * (9 / 4 * (u * P)) +
      2 * (1089 / 1024 * (u * (u * P)) + eta) + 1089 / 1024 * (u * (u * P)))).
  { replace (p + z - x * y) with (p + pe - av * bv + (z - (pe + g)) + (g - (q + r)) + (q - av * be) + (r - ae * bv) -
      ae * be + ((av + ae - x) * (bv + be - y) + (av + ae - x) * y + x * (bv + be - y))) by ring.
    pose proof (product_of _ _ _ _ A3 B3). pose proof (product_of _ _ _ _ A3 By). pose proof (product_of _ _ _ _ Ax B3).
    unabs. lra. }
  assert (Z1 : Rabs z <= (1 + u) * (Rabs pe + Rabs g)).
  { replace z with (z - (pe + g) + (pe + g)) by ring. eapply Rle_trans; [apply Rabs_triang |].
    pose proof (Rabs_triang pe g). nra. }
  pose proof (Rabs_triang pe g) as Tg. pose proof (Rabs_pos pe) as Q0. pose proof (Rabs_pos g) as G0.
  set (K := A * l + B * k + k * l) in *.
  destruct (Rle_or_lt (Rabs z) (Rabs p)) as [L | L].
  - assert (Sg : Rabs (pe + g) <= 112 / 32 * (u * P)) by lra. pose proof (Scale _ _ Sg).
    destruct (normal_near p z (x * y) P (K + 13 * (u * (u * P)))) as [(_ & N & _) | (L' & _)]; auto;
      try (subst p z; apply fl_number); try lra. now apply product_of.
  - assert (Pp : u * Rabs (av * bv) <= u * (Rabs p + Rabs pe + lost)).
    { apply Rmult_le_compat_l; [lra |]. replace (av * bv) with (p + pe + - (p + pe - av * bv)) by ring.
      eapply Rle_trans; [apply Rabs_triang |]. rewrite Rabs_Ropp. pose proof (Rabs_triang p pe). lra. }
    assert (u * Rabs p <= u * Rabs z) by (apply Rmult_le_compat_l; lra).
    assert (u * Rabs pe <= / 4096 * Rabs pe) by (apply Rmult_le_compat_r; lra).
    assert (u * Rabs z <= / 4096 * Rabs z) by (apply Rmult_le_compat_r; [apply Rabs_pos | lra]).
    assert (L0 : 0 <= lost) by (eapply Rle_trans; [apply Rabs_pos | exact Lp]).
    assert (u * lost <= lost) by (rewrite <- (Rmult_1_l lost) at 2; apply Rmult_le_compat_r; lra).
    assert (u * (Rabs pe + Rabs g) <= / 4096 * (Rabs pe + Rabs g)) by (apply Rmult_le_compat_r; lra).
    assert (Zs : Rabs z <= 38 / 16 * (u * P)) by lra. pose proof (Scale _ _ (Rle_trans _ _ _ (Rle_refl (Rabs z)) Zs)) as Uz.
    assert (Sg : Rabs (pe + g) <= 38 / 16 * (u * P)) by lra. pose proof (Scale _ _ Sg).
    destruct (normal_near p z (x * y) P (K + 33 / 4 * (u * (u * P)))) as [(L' & _) | (_ & N & _)]; auto;
      try (subst p z; apply fl_number); try lra; [now apply product_of |].
    destruct N as [N1 N2 N3 N4 N5 N6]. constructor; auto. lra.
Qed.

End Products.

Definition negative_of (a : R * R) : R * R := (- fst a, - snd a).
Lemma negative_near a x A k : known a x A k -> known (negative_of a) (- x) A k.
Proof.
  intros [H1 H2 H3 H4 H5 H6]. constructor; cbn [negative_of fst snd]; rewrite ?Rabs_Ropp; auto using number_opp.
  replace (- fst a + - snd a - - x) with (- (fst a + snd a - x)) by ring. now rewrite Rabs_Ropp.
Qed.
Definition difference (a b : R * R) : R * R := sum a (negative_of b).
Lemma known_less a x A k l : known a x A k -> k <= l -> known a x A l.
Proof. intros [H1 H2 H3 H4 H5 H6] L. constructor; auto. lra. Qed.

(** Two coordinates, in doubles at most m apart. *)
Theorem difference_exact a b m : double a -> double b -> Rabs (fl (a - b)) <= m ->
  known (difference (a, 0) (b, 0)) (a - b) (m * (1 + 2 * u)) 0.
Proof.
  intros Na Nb Hm. pose proof u_small as U. unfold difference, negative_of, sum. cbn [fst snd].
  assert (Nm : double (- b)) by now apply number_opp.
  pose proof (two_sum_exact 53 (-1074) ltac:(lia) a (- b) ltac:(lia) Na Nm) as E.
  assert (Ne : double (snd (two_sum a (- b)))) by apply fl_number.
  assert (Es : fst (two_sum a (- b)) = fl (a - b)) by easy.
  destruct (two_sum a (- b)) as (s, e). cbn [fst snd] in *. pose proof (fl_difference a b Na Nb) as R1. rewrite <- Es in R1.
  rewrite Ropp_0, Rplus_0_l, (rnd_0 53 (-1074) nearest), Rplus_0_r, (rnd_exact 53 (-1074) nearest e Ne).
  assert (Fs : fl (s + e) = s) by (replace (s + e) with (a - b) by lra; now rewrite <- Es).
  unfold ErrorFree.fast_two_sum. rewrite Fs, (Rminus_diag_eq s s eq_refl), (rnd_0 53 (-1074) nearest), Rminus_0_r,
    (rnd_exact 53 (-1074) nearest e Ne).
  rewrite <- Es in Hm. assert (M : 0 <= m) by (pose proof (Rabs_pos s); lra).
  assert (Um : 0 <= m * u) by (apply Rmult_le_pos; lra).
  assert (D : Rabs (a - b) <= m * (1 + 2 * u)).
  { assert (Rabs (a - b) <= Rabs s + Rabs (s - (a - b))).
    { replace (a - b) with (s + - (s - (a - b))) at 1 by ring. rewrite <- (Rabs_Ropp (s - (a - b))). apply Rabs_triang. }
    assert (Q : Rabs (a - b) * (1 - u) <= m) by lra. apply Rmult_le_reg_r with (1 - u); [lra |].
    apply Rle_trans with (1 := Q). assert (0 <= m * u * (1 - 2 * u)) by (apply Rmult_le_pos; lra). lra. }
  constructor; cbn [fst snd]; auto; [rewrite Es; apply fl_number | lra | |].
  - replace e with (- (s - (a - b))) by lra. rewrite Rabs_Ropp. apply Rle_trans with (1 := R1).
    apply Rle_trans with (u * (m * (1 + 2 * u))); [apply Rmult_le_compat_l; lra |].
    assert (0 <= u * (m * (1 + 2 * u))) by (apply Rmult_le_pos; lra). lra.
  - rewrite Rminus_diag_eq, Rabs_R0 by lra. lra.
Qed.

(** ** Y at a time *)

Section Time.

Variable two_product : R -> R -> R * R.
Hypothesis two_product_near : forall a b, double a -> double b -> fst (two_product a b) = fl (a * b) /\
  double (snd (two_product a b)) /\ Rabs (fst (two_product a b) + snd (two_product a b) - a * b) <= bpow radix2 (-870).
Notation product := (product two_product).

(** Sizes of differences on an axis are at least 2^-150. *)
Definition moderate (m : R) : Prop := bpow radix2 (-150) <= m.
Lemma lost_little P : bpow radix2 (-450) <= P ->
  bpow radix2 (-870) <= / 64 * (u * (u * P)) /\ eta <= / 64 * (u * (u * P)).
Proof.
  intros H. assert (Q : bpow radix2 (-562) <= / 64 * (u * (u * P))).
  { replace (bpow radix2 (-562)) with (/ 64 * (u * (u * bpow radix2 (-450)))).
    - pose proof u_small. repeat (apply Rmult_le_compat_l; [lra |]). exact H.
    - unfold Format.u. replace (/ 64) with (bpow radix2 (-6)) by (simpl; lra). now rewrite <- !bpow_plus. }
  split; apply Rle_trans with (2 := Q); unfold Format.eta; apply bpow_le; lia.
Qed.
Lemma moderate_product m n : moderate m -> moderate n -> bpow radix2 (-300) <= m * n.
Proof.
  unfold moderate. intros M N. replace (bpow radix2 (-300)) with (bpow radix2 (-150) * bpow radix2 (-150))
    by now rewrite <- bpow_plus.
  apply Rmult_le_compat; auto; apply bpow_ge_0.
Qed.

Definition component (q0 p0 q1 p1 t : R) : R * R :=
  let start := difference (q0, 0) (p0, 0) in
  sum start (product (t, 0) (difference (difference (q1, 0) (p1, 0)) start)).

(** Y of vectors b, c and p, as coplanarity_forms has it. *)
Definition y_of (bx by_ bz cx cy cz px py pz : R * R) : R * R :=
  let nx := difference (product by_ cz) (product bz cy) in
  let ny := difference (product bz cx) (product bx cz) in
  let nz := difference (product bx cy) (product by_ cx) in
  sum (sum (product nx px) (product ny py)) (product nz pz).

Section Vectors.

Context (bx by_ bz cx cy cz px py pz : R * R) (Bx By Bz Cx Cy Cz Px Py Pz X Y Z : R).
Notation near a x m := (known a x m (51 * (u * (u * m)))).
Hypotheses (KBx : near bx Bx X) (KBy : near by_ By Y) (KBz : near bz Bz Z) (KCx : near cx Cx X) (KCy : near cy Cy Y)
  (KCz : near cz Cz Z) (KPx : near px Px X) (KPy : near py Py Y) (KPz : near pz Pz Z).
Hypotheses (MX : moderate X) (MY : moderate Y) (MZ : moderate Z).

Lemma cross_near a b c d x y z w m n : near a x m -> near b y n -> near c z n -> near d w m -> moderate m -> moderate n ->
  known (difference (product a b) (product c d)) (x * y - z * w) (2 * (m * n)) (243 * (u * (u * (m * n)))).
Proof.
  intros A B C D M N. pose proof u_small as U. pose proof (moderate_product m n M N) as Hp.
  assert (0 < m /\ 0 < n) as (M0 & N0) by (unfold moderate in *; pose proof (bpow_gt_0 radix2 (-150)); lra).
  set (P := m * n) in *. assert (P0 : 0 < P) by (now apply Rmult_lt_0_compat).
  destruct (lost_little P) as (L1 & L2); [apply Rle_trans with (2 := Hp); apply bpow_le; lia |].
  assert (Um : 0 < u * P) by (apply Rmult_lt_0_compat; lra).
  assert (U2 : u * (u * P) <= / 1099511627776 * (u * P)) by (apply Rmult_le_compat_r; lra).
  assert (U0 : 0 <= u * (u * P)) by (apply Rmult_le_pos; lra).
  assert (U4 : u * (u * (u * (u * P))) <= / 1099511627776 * (u * (u * P))) by nra.
  assert (Pr : forall q r s t, near q s m -> near r t n -> known (product q r) (s * t) P (116 * (u * (u * P)))).
  { intros q r s t Q R. apply known_less with (m * (51 * (u * (u * n))) + n * (51 * (u * (u * m))) +
      51 * (u * (u * m)) * (51 * (u * (u * n))) + 13 * (u * (u * P))).
    - apply (product_near two_product _ two_product_near); auto. unfold P in *. lra.
    - unfold P in *. lra. }
  pose proof (Pr _ _ _ _ A B) as AB.
  assert (CD : known (product c d) (z * w) P (116 * (u * (u * P)))).
  { apply known_less with (n * (51 * (u * (u * m))) + m * (51 * (u * (u * n))) +
      51 * (u * (u * n)) * (51 * (u * (u * m))) + 13 * (u * (u * P))).
    - unfold P. rewrite (Rmult_comm m n). apply (product_near two_product _ two_product_near); auto;
        rewrite (Rmult_comm n m); fold P; auto. unfold P in *. lra.
    - unfold P in *. lra. }
  unfold difference. apply known_less with (116 * (u * (u * P)) + 116 * (u * (u * P)) + 5 * (u * (u * (P + P)))); [| lra].
  apply (sum_near _ _ (x * y) (- (z * w)) P P); auto using negative_near; try lra.
  pose proof (known_size _ _ _ _ AB). pose proof (known_size _ _ _ _ CD). unabs. lra.
Qed.

Let M : R := X * Y * Z.
Theorem y_near : let r := y_of bx by_ bz cx cy cz px py pz in
  let y := (By * Cz - Bz * Cy) * Px + (Bz * Cx - Bx * Cz) * Py + (Bx * Cy - By * Cx) * Pz in
  known r y (6 * M) (1166 * (u * (u * M))) /\
  (Rabs (snd r) <= 2 * u * Rabs (fst r) \/ Rabs (snd r) <= 36 * (u * (u * M))).
Proof.
  pose proof u_small as U. intros r y.
  assert (0 < X /\ 0 < Y /\ 0 < Z) as (X0 & Y0 & Z0) by (unfold moderate in *; pose proof (bpow_gt_0 radix2 (-150)); lra).
  assert (Hm : bpow radix2 (-450) <= M).
  { unfold M. replace (bpow radix2 (-450)) with (bpow radix2 (-300) * bpow radix2 (-150)) by now rewrite <- bpow_plus.
    apply Rmult_le_compat; auto using bpow_ge_0. now apply moderate_product. }
  assert (M0 : 0 < M) by (unfold M; repeat apply Rmult_lt_0_compat; auto).
  destruct (lost_little (2 * M)) as (L1 & L2); [lra |].
  assert (Um : 0 < u * M) by (apply Rmult_lt_0_compat; lra).
  assert (U2 : u * (u * M) <= / 1099511627776 * (u * M)) by (apply Rmult_le_compat_r; lra).
  assert (U0 : 0 <= u * (u * M)) by (apply Rmult_le_pos; lra).
  assert (U4 : u * (u * (u * (u * M))) <= / 1099511627776 * (u * (u * M))) by nra.
  assert (Term : forall n v N V m k, 2 * (m * k) = 2 * M -> 0 < m -> 0 < k ->
    known n N (2 * m) (243 * (u * (u * m))) -> near v V k -> known (product n v) (N * V) (2 * M) (372 * (u * (u * M)))).
  { intros n v N V m k E Pm Pk Kn Kv. assert (E' : 2 * m * k = 2 * M) by lra. assert (Em : m * k = M) by lra.
    apply known_less with (2 * m * (51 * (u * (u * k))) + k * (243 * (u * (u * m))) +
      243 * (u * (u * m)) * (51 * (u * (u * k))) + 13 * (u * (u * (2 * m * k)))).
    - rewrite <- E'. apply (product_near two_product _ two_product_near); auto; rewrite ?E'; auto.
      replace (243 * (u * (u * m)) * (51 * (u * (u * k)))) with (12393 * (u * (u * (u * (u * (m * k)))))) by ring.
      replace (2 * m * (51 * (u * (u * k)))) with (102 * (u * (u * (m * k)))) by ring.
      replace (k * (243 * (u * (u * m)))) with (243 * (u * (u * (m * k)))) by ring. rewrite Em. lra.
    - nra. }
  pose proof (cross_near _ _ _ _ _ _ _ _ Y Z KBy KCz KBz KCy MY MZ) as Nx.
  pose proof (cross_near _ _ _ _ _ _ _ _ Z X KBz KCx KBx KCz MZ MX) as Ny.
  pose proof (cross_near _ _ _ _ _ _ _ _ X Y KBx KCy KBy KCx MX MY) as Nz.
  assert (P : 0 < Y * Z /\ 0 < Z * X /\ 0 < X * Y) by (repeat split; now apply Rmult_lt_0_compat).
  pose proof (Term _ _ _ _ (Y * Z) X ltac:(unfold M; ring) ltac:(tauto) X0 Nx KPx) as T0.
  pose proof (Term _ _ _ _ (Z * X) Y ltac:(unfold M; ring) ltac:(tauto) Y0 Ny KPy) as T1.
  pose proof (Term _ _ _ _ (X * Y) Z ltac:(unfold M; ring) ltac:(tauto) Z0 Nz KPz) as T2.
  set (nx := By * Cz - Bz * Cy) in *. set (ny := Bz * Cx - Bx * Cz) in *. set (nz := Bx * Cy - By * Cx) in *.
  pose proof (known_size _ _ _ _ T0) as S0. pose proof (known_size _ _ _ _ T1) as S1. pose proof (known_size _ _ _ _ T2) as S2.
  destruct (sum_near _ _ _ _ _ _ _ _ (4 * M) T0 T1) as (T01 & _); [unabs; lra | lra | lra |].
  destruct (sum_near _ _ _ _ _ _ _ _ (6 * M) T01 T2) as (T & E); [unabs; lra | lra | lra |].
  split; [apply known_less with (1 := T); lra |].
  destruct E as [E | E]; [now left | right]. unfold r, y_of. cbv zeta. lra.
Qed.
(** error() is 2^-94 of the product of the rounded sizes. *)
Theorem time_stage_sign error : 1210 * (u * (u * M)) <= error ->
  let v := fst (y_of bx by_ bz cx cy cz px py pz) in
  let y := (By * Cz - Bz * Cy) * Px + (Bz * Cx - Bx * Cz) * Py + (Bx * Cy - By * Cx) * Pz in
  (error < v -> 0 < y) /\ (v < - error -> y < 0).
Proof.
  intros E v y. destruct y_near as (K & S). fold v y in K, S. pose proof (known_to _ _ _ _ K) as T. fold v in T.
  pose proof u_small as U. set (w := snd (y_of bx by_ bz cx cy cz px py pz)) in *.
  assert (M0 : 0 <= u * (u * M)).
  { assert (0 < X /\ 0 < Y /\ 0 < Z) as (X0 & Y0 & Z0) by (unfold moderate in *; pose proof (bpow_gt_0 radix2 (-150)); lra).
    assert (0 < M) by (unfold M; repeat apply Rmult_lt_0_compat; auto). repeat apply Rmult_le_pos; lra. }
  apply Rabs_le_inv in T. split; intros H.
  - assert (Rabs v = v) as Ev by (apply Rabs_pos_eq; lra). destruct S as [S | S].
    + rewrite Ev in S. assert (2 * u * v <= / 1024 * v) by (apply Rmult_le_compat_r; lra). apply Rabs_le_inv in S. lra.
    + apply Rabs_le_inv in S. lra.
  - assert (Rabs v = - v) as Ev by (apply Rabs_left; lra). destruct S as [S | S].
    + rewrite Ev in S. assert (2 * u * - v <= / 1024 * - v) by (apply Rmult_le_compat_r; lra). apply Rabs_le_inv in S. lra.
    + apply Rabs_le_inv in S. lra.
Qed.

End Vectors.
End Time.

(** error(): sizes of rounded differences. *)
Theorem error_enough mx my mz : moderate mx -> moderate my -> moderate mz ->
  1210 * (u * (u * (mx * (1 + 2 * u) * (my * (1 + 2 * u)) * (mz * (1 + 2 * u))))) <=
  fl (fl (fl (mx * my) * mz) * bpow radix2 (-94)).
Proof.
  intros X Y Z. pose proof u_small as U.
  assert (0 < mx /\ 0 < my /\ 0 < mz) as (X0 & Y0 & Z0) by (unfold moderate in *; pose proof (bpow_gt_0 radix2 (-150)); lra).
  assert (Lower : forall x, bpow radix2 (-900) <= x -> x * (1 - u) <= fl x).
  { intros x Hx. pose proof (bpow_gt_0 radix2 (-900)).
    pose proof (error_relative _ _ _ _ _ (rounding_error_nearest 53 (-1074) ltac:(lia)) x) as E.
    rewrite (Rabs_pos_eq x) in E by lra. assert (S : smallest_normal 53 (-1074) <= x).
    { apply Rle_trans with (2 := Hx). unfold smallest_normal. apply bpow_le. lia. }
    apply E, Rabs_le_inv in S. lra. }
  pose proof (moderate_product mx my X Y) as P2.
  assert (P3 : bpow radix2 (-450) <= mx * my * mz).
  { replace (bpow radix2 (-450)) with (bpow radix2 (-300) * bpow radix2 (-150)) by now rewrite <- bpow_plus.
    apply Rmult_le_compat; auto using bpow_ge_0. }
  set (P := mx * my * mz) in *.
  assert (Half : forall x e, bpow radix2 e <= x -> bpow radix2 (e - 1) <= x * (1 - u)).
  { intros x e H. unfold Z.sub. rewrite bpow_plus. change (bpow radix2 (- (1))) with (/ 2).
    pose proof (bpow_gt_0 radix2 e). apply Rmult_le_compat; lra. }
  assert (A : mx * my * (1 - u) <= fl (mx * my)) by (apply Lower; apply Rle_trans with (2 := P2); apply bpow_le; lia).
  assert (B : P * (1 - u) <= fl (mx * my) * mz).
  { replace (P * (1 - u)) with (mx * my * (1 - u) * mz) by (unfold P; ring). apply Rmult_le_compat_r; lra. }
  assert (C : P * (1 - u) * (1 - u) <= fl (fl (mx * my) * mz)).
  { apply Rle_trans with (fl (mx * my) * mz * (1 - u)); [apply Rmult_le_compat_r; lra |]. apply Lower.
    apply Rle_trans with (2 := B). apply Rle_trans with (2 := Half _ _ P3). apply bpow_le. lia. }
  pose proof (bpow_gt_0 radix2 (-94)) as T. set (h := bpow radix2 (-94)) in *.
  assert (D : P * (1 - u) * (1 - u) * h * (1 - u) <= fl (fl (fl (mx * my) * mz) * h)).
  { apply Rle_trans with (fl (fl (mx * my) * mz) * h * (1 - u)); [apply Rmult_le_compat_r; [lra |]; apply Rmult_le_compat_r; lra |].
    apply Lower. apply Rle_trans with (P * (1 - u) * (1 - u) * h); [| apply Rmult_le_compat_r; lra].
    apply Rle_trans with (bpow radix2 (-450 - 1 - 1) * h).
    - unfold h. rewrite <- bpow_plus. apply bpow_le. lia.
    - apply Rmult_le_compat_r; [lra |]. now apply Half, Half. }
  apply Rle_trans with (2 := D). assert (P0 : 0 < P) by (pose proof (bpow_gt_0 radix2 (-450)); lra).
  assert (Uh : u * u = / 4096 * h) by (unfold Format.u, h; replace (/ 4096) with (bpow radix2 (-12)) by (simpl; lra);
    now rewrite <- !bpow_plus).
  replace (1210 * (u * (u * (mx * (1 + 2 * u) * (my * (1 + 2 * u)) * (mz * (1 + 2 * u)))))) with
    (1210 * (u * u) * ((1 + 2 * u) * (1 + 2 * u) * (1 + 2 * u)) * P) by (unfold P; ring).
  rewrite Uh. assert (H : 1210 * / 4096 * ((1 + 2 * u) * (1 + 2 * u) * (1 + 2 * u)) <= (1 - u) * (1 - u) * (1 - u)).
  { assert ((1 + 2 * u) * (1 + 2 * u) <= 11 / 10) by nra. assert (9 / 10 <= (1 - u) * (1 - u)) by nra.
    assert ((1 + 2 * u) * (1 + 2 * u) * (1 + 2 * u) <= 11 / 10 * (11 / 10)) by (apply Rmult_le_compat; nra).
    assert (9 / 10 * (9 / 10) <= (1 - u) * (1 - u) * (1 - u)) by (apply Rmult_le_compat; nra). lra. }
  assert (Hp : 0 < h * P) by (now apply Rmult_lt_0_compat).
  apply (Rmult_le_compat_r (h * P)) in H; [| lra].
  replace (1210 * (/ 4096 * h) * ((1 + 2 * u) * (1 + 2 * u) * (1 + 2 * u)) * P) with
    (1210 * / 4096 * ((1 + 2 * u) * (1 + 2 * u) * (1 + 2 * u)) * (h * P)) by ring.
  replace (P * (1 - u) * (1 - u) * h * (1 - u)) with ((1 - u) * (1 - u) * (1 - u) * (h * P)) by ring. exact H.
Qed.

(** ** Both algorithms for a product's error *)

Lemma fl_crude x : Rabs (fl x) <= 2 * Rabs x + eta.
Proof.
  pose proof (fl_any x). pose proof u_small. pose proof (Rabs_pos x). assert (u * Rabs x <= Rabs x) by nra.
  replace (fl x) with (fl x - x + x) by ring. eapply Rle_trans; [apply Rabs_triang |]. lra.
Qed.
Lemma at_least_eta x : double x -> x <> 0 -> eta <= Rabs x.
Proof.
  intros N Z. apply generic_format_ge_bpow with (FLT_exp (-1074) 53); [intros e; unfold FLT_exp; lia | now apply Rabs_pos_lt |].
  now apply generic_format_abs.
Qed.
(** If it is not exact, all numbers are below this. *)
Lemma tiny_product a b : double a -> double b -> a * b <> 0 -> Rabs (fl (a * b)) < bpow radix2 (-968) ->
  Rabs (a * b) <= 2 * bpow radix2 (-968) /\ eta <= bpow radix2 (-968).
Proof.
  intros A B Z H. assert (E : eta <= / 2 * bpow radix2 (-968)).
  { change (/ 2) with (bpow radix2 (-1)). rewrite <- bpow_plus. unfold Format.eta. apply bpow_le. lia. }
  pose proof (bpow_gt_0 radix2 (-968)). split; [| lra]. pose proof (fl_any (a * b)) as F. pose proof u_small.
  pose proof (Rabs_pos (a * b)). assert (u * Rabs (a * b) <= / 8 * Rabs (a * b)) by (apply Rmult_le_compat_r; lra).
  assert (Rabs (a * b) <= Rabs (fl (a * b)) + Rabs (fl (a * b) - a * b)).
  { replace (a * b) with (fl (a * b) + - (fl (a * b) - a * b)) at 1 by ring. eapply Rle_trans; [apply Rabs_triang |].
    rewrite Rabs_Ropp. lra. }
  lra.
Qed.
Lemma exact_or_tiny a b error : double a -> double b ->
  product_error_is_exact 53 (-1074) a b (fl (a * b), error) \/
  (a <> 0 /\ b <> 0 /\ Rabs (a * b) <= 2 * bpow radix2 (-968) /\ eta <= bpow radix2 (-968)).
Proof.
  intros A B. unfold product_error_is_exact. rewrite (threshold 53 (-1074)) by lia. cbn [fst].
  destruct (Req_dec a 0) as [-> | Na]; [auto |]. destruct (Req_dec b 0) as [-> | Nb]; [auto |].
  destruct (Rle_or_lt (bpow radix2 (-1074 + 2 * 53)) (Rabs (fl (a * b)))) as [L | L]; auto. right.
  change (-1074 + 2 * 53)%Z with (-968)%Z in L. split; auto. split; auto. apply tiny_product; auto using Rmult_integral_contrapositive_currified.
Qed.

Notation near_product two_product := (forall a b, double a -> double b -> fst (two_product a b) = fl (a * b) /\
  double (snd (two_product a b)) /\ Rabs (fst (two_product a b) + snd (two_product a b) - a * b) <= bpow radix2 (-870)).
Theorem product_rounded_fma : near_product (two_product_fma 53 (-1074)).
Proof.
  intros a b A B. split; [easy |]. split; [apply fl_number |].
  destruct (exact_or_tiny a b (fl (a * b - fl (a * b))) A B) as [E | (_ & _ & L & H)].
  - rewrite (two_product_fma_exact 53 (-1074) a b ltac:(lia) A B E), Rminus_diag_eq, Rabs_R0 by easy. apply bpow_ge_0.
  - unfold two_product_fma. cbn [fst snd]. pose proof (fl_any (a * b - fl (a * b))) as F. pose proof (fl_any (a * b)) as G.
    pose proof u_small. replace (a * b - fl (a * b)) with (- (fl (a * b) - a * b)) in F by ring. rewrite Rabs_Ropp in F.
    replace (fl (a * b) + fl (a * b - fl (a * b)) - a * b) with
      (fl (- (fl (a * b) - a * b)) - - (fl (a * b) - a * b)).
    2: { replace (- (fl (a * b) - a * b)) with (a * b - fl (a * b)) by ring. ring. }
    apply Rle_trans with (1 := F). pose proof (Rabs_pos (a * b)). pose proof (bpow_gt_0 radix2 (-968)).
    assert (u * Rabs (a * b) <= Rabs (a * b)) by nra. pose proof (Rabs_pos (fl (a * b) - a * b)).
    assert (u * Rabs (fl (a * b) - a * b) <= Rabs (fl (a * b) - a * b)) by nra.
    assert (T : 16 * bpow radix2 (-968) <= bpow radix2 (-870)).
    { change 16 with (bpow radix2 4). rewrite <- bpow_plus. apply bpow_le. lia. }
    lra.
Qed.
Lemma split_crude x : double x -> x <> 0 -> let s := split 53 (-1074) x in
  Rabs (fst s) <= bpow radix2 40 * Rabs x /\ Rabs (snd s) <= bpow radix2 40 * Rabs x.
Proof.
  intros N Z s. pose proof (at_least_eta x N Z) as E. unfold s, split. cbn [fst snd].
  change (half_bits 53) with 27%Z. set (c := fl ((bpow radix2 27 + 1) * x)).
  set (w := fl (c - x)). set (h := fl (c - w)). set (l := fl (x - h)).
  assert (P : Rabs ((bpow radix2 27 + 1) * x) <= bpow radix2 28 * Rabs x).
  { rewrite Rabs_mult, Rabs_pos_eq by (pose proof (bpow_gt_0 radix2 27); lra). apply Rmult_le_compat_r; [apply Rabs_pos |].
    simpl. lra. }
  pose proof (fl_crude ((bpow radix2 27 + 1) * x)) as C1. fold c in C1.
  pose proof (fl_crude (c - x)) as C2. fold w in C2. pose proof (fl_crude (c - w)) as C3. fold h in C3.
  pose proof (fl_crude (x - h)) as C4. fold l in C4.
  pose proof (triangle c (- x) _ _ (Rle_refl _) (Rle_refl _)) as T2. rewrite Rabs_Ropp in T2. change (c + - x) with (c - x) in T2.
  pose proof (triangle c (- w) _ _ (Rle_refl _) (Rle_refl _)) as T3. rewrite Rabs_Ropp in T3. change (c + - w) with (c - w) in T3.
  pose proof (triangle x (- h) _ _ (Rle_refl _) (Rle_refl _)) as T4. rewrite Rabs_Ropp in T4. change (x + - h) with (x - h) in T4.
  assert (E28 : bpow radix2 28 = 268435456) by reflexivity. assert (E40 : bpow radix2 40 = 1099511627776) by reflexivity.
  rewrite E28 in P. rewrite E40. clear - E P C1 C2 C3 C4 T2 T3 T4. clearbody l h w c. generalize (Rabs_pos x). lra.
Qed.
Theorem product_rounded : near_product (two_product 53 (-1074)).
Proof.
  intros a b A B. assert (F : fst (two_product 53 (-1074) a b) = fl (a * b)).
  { unfold two_product. now destruct (split _ _ a), (split _ _ b). }
  split; auto. split; [unfold two_product; destruct (split _ _ a), (split _ _ b); apply fl_number |].
  destruct (exact_or_tiny a b (snd (two_product 53 (-1074) a b)) A B) as [E | (Na & Nb & L & H)].
  - rewrite two_product_exact; auto; try lia; [rewrite Rminus_diag_eq, Rabs_R0 by easy; apply bpow_ge_0 |].
    rewrite <- F in E. now rewrite <- surjective_pairing in E.
  - destruct (split_crude a A Na) as (Ah & Al), (split_crude b B Nb) as (Bh & Bl). unfold two_product in *.
    destruct (split _ _ a) as (ah, al), (split _ _ b) as (bh, bl). cbn [fst snd] in *. clear F.
    assert (Part : forall x y, Rabs x <= bpow radix2 40 * Rabs a -> Rabs y <= bpow radix2 40 * Rabs b ->
      Rabs (fl (x * y)) <= bpow radix2 84 * bpow radix2 (-968)).
    { intros x y X Y. eapply Rle_trans; [apply fl_crude |].
      assert (Q : Rabs (x * y) <= bpow radix2 80 * Rabs (a * b)).
      { rewrite !Rabs_mult. apply Rle_trans with (bpow radix2 40 * Rabs a * (bpow radix2 40 * Rabs b)).
        - apply Rmult_le_compat; auto using Rabs_pos.
        - right. change 80%Z with (40 + 40)%Z. rewrite bpow_plus. ring. }
      apply Rle_trans with (2 * (bpow radix2 80 * (2 * bpow radix2 (-968))) + bpow radix2 (-968)).
      - apply Rplus_le_compat; auto. apply Rmult_le_compat_l; [lra |]. apply Rle_trans with (1 := Q).
        apply Rmult_le_compat_l; [apply bpow_ge_0 | exact L].
      - pose proof (bpow_gt_0 radix2 (-968)). set (t := bpow radix2 (-968)) in *. simpl. lra. }
    pose proof (Part _ _ Ah Bh) as P1. pose proof (Part _ _ Ah Bl) as P2. pose proof (Part _ _ Al Bh) as P3.
    pose proof (Part _ _ Al Bl) as P4. clear Part Ah Al Bh Bl. pose proof (fl_crude (a * b)) as V.
    set (D := bpow radix2 84 * bpow radix2 (-968)) in *. pose proof (bpow_gt_0 radix2 (-968)) as T0.
    assert (DT : 8 * bpow radix2 (-968) <= D).
    { unfold D. change 8 with (bpow radix2 3). apply Rmult_le_compat_r; [lra |]. apply bpow_le. lia. }
    set (v := fl (a * b)) in *. set (x1 := fl (ah * bh)) in *. set (x2 := fl (ah * bl)) in *. set (x3 := fl (al * bh)) in *.
    set (x4 := fl (al * bl)) in *.
    assert (Crude : forall x y m, Rabs x <= m -> Rabs y <= D -> D <= m -> Rabs (fl (x + y)) <= 5 * m).
    { intros x y m X Y M. eapply Rle_trans; [apply fl_crude |]. pose proof (Rabs_triang x y). lra. }
    assert (V' : Rabs v <= D) by lra.
    assert (C1 : Rabs (fl (x1 - v)) <= 5 * D) by (apply (Crude x1 (- v)); rewrite ?Rabs_Ropp; lra).
    pose proof (Crude _ _ _ C1 P2 ltac:(lra)) as C2. pose proof (Crude _ _ _ C2 P3 ltac:(lra)) as C3.
    pose proof (Crude _ _ _ C3 P4 ltac:(lra)) as C4.
    assert (Last : 1000 * D <= bpow radix2 (-870)).
    { unfold D. rewrite <- bpow_plus. apply Rle_trans with (bpow radix2 10 * bpow radix2 (84 + -968)).
      - apply Rmult_le_compat_r; [apply bpow_ge_0 | simpl; lra].
      - rewrite <- bpow_plus. apply bpow_le. lia. }
    match goal with |- Rabs (v + ?e - a * b) <= _ => set (low := e) in * end.
    assert (Rabs (v + low - a * b) <= Rabs v + Rabs low + Rabs (a * b)).
    { eapply Rle_trans; [apply Rabs_triang |]. rewrite Rabs_Ropp. pose proof (Rabs_triang v low). lra. }
    lra.
Qed.
