(** The search by signs at doubles (root_search::between of ccd/contact/time_bracket.hpp), over the ordered indices
    of doubles. The estimate of the root and Newton's steps are arbitrary. Results:
        between_searches      its result is one of `search` (TimeBrackets.v), for which search_right holds
        search_ends           it evaluates at most 100 signs
        double_numbers        doubles in [0, 1] have ordered indices below 2^62
        search_widths         the polynomial's values fit the words of their type
        first_root_widths     so do the numbers of first_root_nonpositive and of bracket_of_quadratic_root *)

From Coq Require Import Reals ZArith Lia Lra List Bool.
From Flocq Require Import Core.
From Errbound Require Import Sign Bernstein VertexEdge CubicRoots TimeBrackets Decisions Words FixedWidths.
Import ListNotations.
Open Scope R_scope.

(** ** The loop *)

Section Search.

Variable double : R -> Prop.
(** double_of_order, from 0 to the index of 1 *)
Context (double_of : Z -> R) (one : Z)
  (numbered : forall x, double x /\ 0 <= x <= 1 <-> exists n, (0 <= n <= one)%Z /\ x = double_of n)
  (increasing : forall m n, (0 <= m < n)%Z -> (n <= one)%Z -> double_of m < double_of n).

Variable p : R -> R.
(** value_at's sign; none if fixed widths do not suffice. *)
Context (sign_of_value : Z -> option sign)
  (certain_sign : forall n s, sign_of_value n = Some s -> s = sign_of_real (p (double_of n))) (before : sign)
  (strict_before : strict before).
(** order_of(next), where `next` is not NaN *)
Variable newton : Z -> option Z.

Definition farthest_step : Z := 2 ^ 60.
Definition next_place (a b x step : Z) : Z :=
  if ((x <=? a) || (b <=? x))%Z
  then if (step =? 1)%Z then Z.max (a + 1) (Z.min x (b - 1)) else (a + (b - a) / 2)%Z
  else x.
(** Running out of steps, which the code does not, gives no answer. *)
Fixpoint between (steps : nat) (a b x step : Z) (corrections : nat) : option bracket :=
  match steps with
  | O => None
  | Datatypes.S steps =>
      if (b - a <=? 1)%Z then Some (double_of a, double_of b)
      else
        let x := next_place a b x step in
        match sign_of_value x with
        | None => None
        | Some zero => Some (double_of x, double_of x)
        | Some s =>
            let earlier := same_sign s before in
            let a := if earlier then x else a in
            let b := if earlier then b else x in
            let beside := between steps a b (if earlier then x + step else x - step)%Z (Z.min (4 * step) farthest_step)
              (Datatypes.S corrections) in
            match newton x with
            | Some next =>
                if Nat.ltb corrections 3 && (a <? next)%Z && (next <? b)%Z
                then between steps a b next step (Datatypes.S corrections) else beside
            | None => beside
            end
        end
  end.

Lemma place_inside a b x step : (1 < b - a)%Z -> (a < next_place a b x step < b)%Z.
Proof.
  intros W. unfold next_place.
  destruct (Z.leb_spec x a), (Z.leb_spec b x); cbn [orb]; try lia;
    (destruct (Z.eqb_spec step 1); [lia |]; pose proof (Z.div_mod (b - a) 2 ltac:(lia));
     pose proof (Z.mod_pos_bound (b - a) 2 ltac:(lia)); lia).
Qed.
Lemma double_is n : (0 <= n <= one)%Z -> double (double_of n).
Proof. intros N. apply (proj2 (numbered (double_of n))). eauto. Qed.
Lemma next_to_each_other a : (0 <= a)%Z -> (a + 1 <= one)%Z -> neighbours double (double_of a) (double_of (a + 1)).
Proof.
  intros A O. split; [apply double_is; lia |]. split; [apply double_is; lia |]. split; [apply increasing; lia |].
  intros x D X. assert (0 <= double_of a /\ double_of (a + 1) <= 1) as (A0 & A1).
  { split; apply numbered; [exists a | exists (a + 1)%Z]; (split; [lia | easy]). }
  destruct (proj1 (numbered x)) as (n & N & ->); [split; [auto | lra] |].
  destruct (Z_lt_le_dec n (a + 1)) as [L | L]; [destruct (Z.eq_dec n a) as [-> | K]; [lra |] |].
  - pose proof (increasing n a ltac:(lia) ltac:(lia)). lra.
  - destruct (Z.eq_dec n (a + 1)) as [-> | K]; [lra |]. pose proof (increasing (a + 1) n ltac:(lia) ltac:(lia)). lra.
Qed.

Theorem between_searches steps a b x step corrections found : (0 <= a < b)%Z -> (b <= one)%Z ->
  between steps a b x step corrections = Some found ->
  search double p (unit_of before) (double_of a) (double_of b) found.
Proof.
  revert a b x step corrections. induction steps as [| steps IH]; intros a b x step corrections A O; [discriminate |].
  cbn [between]. destruct (Z.leb_spec (b - a) 1) as [W | W].
  { intros X. injection X as <-. replace b with (a + 1)%Z by lia. apply neighbours_left, next_to_each_other; lia. }
  cbv zeta. pose proof (place_inside a b x step W) as I. set (m := next_place a b x step) in *. clearbody m.
  assert (M : double_of a < double_of m < double_of b) by (split; apply increasing; lia).
  assert (D : double (double_of m)) by (apply double_is; lia).
  destruct (sign_of_value m) as [s |] eqn:V; [| discriminate]. apply certain_sign in V.
  pose proof (sign_of_real_right (p (double_of m))) as R. pose proof (never_uncertain (p (double_of m))) as U.
  rewrite <- V in R, U. clear V.
  destruct s; [| intros X; injection X as <-; now apply root_found | | easy]; simpl in R;
    destruct strict_before as [B | B]; rewrite B in *; cbn [same_sign]; intros X.
  1, 4: apply root_earlier with (double_of m); [auto .. | simpl; lra |].
  3, 4: apply root_later with (double_of m); [auto .. | simpl; lra |].
  all: destruct (newton m) as [next |]; [destruct (Nat.ltb corrections 3 && _ && _) |]; apply IH in X; auto; lia.
Qed.

(** ** It ends *)

(** More steps do not change the answer. *)
Definition ends (steps : nat) (a b x step : Z) (corrections : nat) : Prop :=
  forall more, (steps <= more)%nat ->
    between more a b x step corrections = between steps a b x step corrections.
Lemma step_ends steps a b x step corrections :
  (forall a' b' x' step', let m := next_place a b x step in (1 < b - a)%Z ->
     (a' = m /\ b' = b \/ a' = a /\ b' = m) ->
     (x' = m + step /\ a' = m \/ x' = m - step /\ b' = m)%Z /\ step' = Z.min (4 * step) farthest_step \/
     (corrections < 3)%nat /\ step' = step ->
     ends steps a' b' x' step' (Datatypes.S corrections)) ->
  ends (Datatypes.S steps) a b x step corrections.
Proof.
  intros H more L. destruct more as [| more]; [lia |]. cbn [between].
  destruct (Z.leb_spec (b - a) 1) as [| W]; auto. cbv zeta in H |- *. set (m := next_place a b x step) in *.
  destruct (sign_of_value m) as [s |]; auto.
  assert (Same : forall a' b' x' step', (a' = m /\ b' = b \/ a' = a /\ b' = m) ->
     (x' = m + step /\ a' = m \/ x' = m - step /\ b' = m)%Z /\ step' = Z.min (4 * step) farthest_step \/
     (corrections < 3)%nat /\ step' = step ->
     between more a' b' x' step' (Datatypes.S corrections) = between steps a' b' x' step' (Datatypes.S corrections))
    by (intros; apply H; auto; lia).
  destruct s; auto; destruct (same_sign _ before);
    (destruct (newton m) as [next |]; [destruct (Nat.ltb_spec corrections 3); cbn [andb];
       [destruct ((_ <? next)%Z && (next <? _)%Z) |] |]); apply Same; auto 6.
Qed.

(** From the farthest step on, each step halves the width or reduces it by the farthest step. *)
Definition left_to_do (w : Z) : Z := Z.log2_up w + w / farthest_step.
Lemma halved w v : (1 < w)%Z -> (1 <= v)%Z -> (2 * v <= w + 1)%Z -> (left_to_do v < left_to_do w)%Z.
Proof.
  intros W V H. unfold left_to_do. assert (v / farthest_step <= w / farthest_step)%Z by (apply Z.div_le_mono; [easy | lia]).
  enough (Z.log2_up v < Z.log2_up w)%Z by lia. pose proof (Z.log2_up_spec w W) as (_ & U).
  pose proof (Z.log2_up_pos w W). assert (E : (2 ^ Z.log2_up w = 2 * 2 ^ (Z.log2_up w - 1))%Z)
    by (rewrite <- Z.pow_succ_r by lia; f_equal; lia).
  assert (Hv : (v <= 2 ^ (Z.log2_up w - 1))%Z) by lia. pose proof (Z.log2_up_le_mono v _ Hv) as K.
  rewrite Z.log2_up_pow2 in K by lia. lia.
Qed.
Lemma far_off w v : (farthest_step < w)%Z -> (1 <= v)%Z -> (v = farthest_step \/ v = w - farthest_step)%Z ->
  (left_to_do v < left_to_do w)%Z.
Proof.
  intros W V [-> | ->]; unfold left_to_do.
  - assert (farthest_step / farthest_step <= w / farthest_step)%Z by (apply Z.div_le_mono; [easy | lia]).
    enough (Z.log2_up farthest_step < Z.log2_up w)%Z by lia. unfold farthest_step in *.
    rewrite Z.log2_up_pow2 by lia. apply Z.log2_up_lt_pow2; lia.
  - pose proof (Z.log2_up_le_mono (w - farthest_step) w ltac:(unfold farthest_step; lia)).
    replace w with (w - farthest_step + 1 * farthest_step)%Z at 4 by ring. rewrite Z.div_add by easy. lia.
Qed.
Lemma far_ends steps : forall a b x corrections, (a < b)%Z -> (left_to_do (b - a) < Z.of_nat steps)%Z ->
  (3 <= corrections)%nat -> (x <= a \/ b <= x \/ x - a = farthest_step \/ b - x = farthest_step)%Z ->
  ends steps a b x farthest_step corrections.
Proof.
  induction steps as [| steps IH]; intros a b x corrections O L C X.
  { exfalso. unfold left_to_do in L. pose proof (Z.log2_up_nonneg (b - a)).
    pose proof (Z.div_pos (b - a) farthest_step ltac:(lia) ltac:(easy)). lia. }
  apply step_ends. intros a' b' x' step' m W A [(X' & ->) | (? & _)]; [| lia].
  change (Z.min (4 * farthest_step) farthest_step) with farthest_step.
  pose proof (place_inside a b x farthest_step W) as I. fold m in I.
  apply IH; [lia | | lia | lia]. enough (left_to_do (b' - a') < left_to_do (b - a))%Z by lia.
  unfold m, next_place in A, I. change (farthest_step =? 1)%Z with false in A, I.
  destruct ((x <=? a) || (b <=? x))%Z eqn:K.
  - pose proof (Z.div_mod (b - a) 2 ltac:(lia)). pose proof (Z.mod_pos_bound (b - a) 2 ltac:(lia)).
    apply halved; lia.
  - apply orb_false_iff in K. destruct K as (K0 & K1). apply Z.leb_gt in K0, K1. apply far_off; lia.
Qed.
(** Before that, the step grows. *)
Lemma growing_ends r : (r <= 30)%nat -> forall a b x corrections, (a < b)%Z -> (b - a <= 2 ^ 62)%Z ->
  (3 <= corrections)%nat -> ends (r + 68) a b x (4 ^ (30 - Z.of_nat r)) corrections.
Proof.
  intros Hr. induction r as [| r IH]; intros a b x corrections O W C.
  - change (4 ^ (30 - Z.of_nat 0))%Z with farthest_step. apply step_ends.
    intros a' b' x' step' m W' A [(X' & ->) | (? & _)]; [| lia].
    change (Z.min (4 * farthest_step) farthest_step) with farthest_step.
    pose proof (place_inside a b x farthest_step W') as I. fold m in I.
    apply far_ends; [lia | | lia | lia]. apply Z.le_lt_trans with (left_to_do (2 ^ 62)); [| reflexivity].
    unfold left_to_do. pose proof (Z.log2_up_le_mono (b' - a') (2 ^ 62) ltac:(lia)).
    pose proof (Z.div_le_mono (b' - a') (2 ^ 62) farthest_step ltac:(easy) ltac:(lia)). lia.
  - apply step_ends. intros a' b' x' step' m W' A [(X' & ->) | (? & _)]; [| lia].
    pose proof (place_inside a b x (4 ^ (30 - Z.of_nat (Datatypes.S r)))%Z W') as I. fold m in I.
    replace (Z.min (4 * 4 ^ (30 - Z.of_nat (Datatypes.S r))) farthest_step) with (4 ^ (30 - Z.of_nat r))%Z.
    + apply IH; lia.
    + replace (30 - Z.of_nat r)%Z with (Z.succ (30 - Z.of_nat (Datatypes.S r))) by lia. rewrite Z.pow_succ_r by lia.
      assert (4 ^ (30 - Z.of_nat (Datatypes.S r)) <= 4 ^ 29)%Z by (apply Z.pow_le_mono_r; lia).
      rewrite Z.min_l; [easy |]. unfold farthest_step. change (2 ^ 60)%Z with (4 * 4 ^ 29)%Z. lia.
Qed.
(** From 0 corrections and step 1; the first three steps may be those of Newton's method. *)
Lemma early_ends k : (k <= 3)%nat -> forall a b x j, (j + k <= 3)%nat -> (a < b)%Z -> (b - a <= 2 ^ 62)%Z ->
  ends (k + 98) a b x (4 ^ Z.of_nat j) (3 - k).
Proof.
  intros K. induction k as [| k IH]; intros a b x j J O W.
  - replace (Z.of_nat j) with (30 - Z.of_nat (30 - j))%Z by lia. change (3 - 0)%nat with 3%nat. intros more L.
    assert (E : forall n, (30 - j + 68 <= n)%nat ->
      between n a b x (4 ^ (30 - Z.of_nat (30 - j))) 3 = between (30 - j + 68) a b x (4 ^ (30 - Z.of_nat (30 - j))) 3)
      by (apply growing_ends; lia).
    rewrite (E more), (E (0 + 98)%nat); [easy | lia | lia].
  - apply step_ends. intros a' b' x' step' m W' A B.
    pose proof (place_inside a b x (4 ^ Z.of_nat j)%Z W') as I. fold m in I.
    replace (Datatypes.S (3 - Datatypes.S k)) with (3 - k)%nat by lia.
    destruct B as [(_ & ->) | (_ & ->)]; [| apply IH; lia].
    replace (Z.min (4 * 4 ^ Z.of_nat j) farthest_step) with (4 ^ Z.of_nat (Datatypes.S j))%Z; [apply IH; lia |].
    rewrite Nat2Z.inj_succ, Z.pow_succ_r by lia. assert (4 ^ Z.of_nat j <= 4 ^ 29)%Z by (apply Z.pow_le_mono_r; lia).
    rewrite Z.min_l; [easy |]. unfold farthest_step. change (2 ^ 60)%Z with (4 * 4 ^ 29)%Z. lia.
Qed.
Theorem search_ends a b x : (0 <= a < b)%Z -> (b <= 2 ^ 62)%Z -> forall more, (101 <= more)%nat ->
  between more a b x 1 0 = between 101 a b x 1 0.
Proof. intros A B. exact (early_ends 3 ltac:(lia) a b x 0%nat ltac:(lia) ltac:(lia) ltac:(lia)). Qed.

End Search.

(** ** Doubles *)

Notation is_double := (generic_format radix2 (FLT_exp (-1074) 53)).
(** The double with those bits, up to infinity. *)
Definition double_of_order (n : Z) : R :=
  let e := (n / 2 ^ 52)%Z in
  if (e =? 0)%Z then IZR n * bpow radix2 (-1074) else IZR (2 ^ 52 + n mod 2 ^ 52) * bpow radix2 (e - 1075).
Definition order_of_1 : Z := 1023 * 2 ^ 52.

Lemma next_double n : (0 <= n)%Z ->
  double_of_order (n + 1) = double_of_order n + bpow radix2 (Z.max 1 (n / 2 ^ 52) - 1075).
Proof.
  intros N. unfold double_of_order. pose proof (Z.div_mod n (2 ^ 52) ltac:(easy)) as D.
  pose proof (Z.mod_pos_bound n (2 ^ 52) ltac:(easy)) as M.
  pose proof (Z.div_pos n (2 ^ 52) N ltac:(easy)) as E.
  set (e := (n / 2 ^ 52)%Z) in *. set (m := (n mod 2 ^ 52)%Z) in *.
  destruct (Z.eq_dec (m + 1) (2 ^ 52)) as [F | F].
  - assert (Q : ((n + 1) / 2 ^ 52 = e + 1)%Z) by (symmetry; apply Z.div_unique with 0%Z; lia).
    assert (R : ((n + 1) mod 2 ^ 52 = 0)%Z) by (symmetry; apply Z.mod_unique with (e + 1)%Z; lia).
    rewrite Q, R. destruct (Z.eqb_spec (e + 1) 0); [lia |]. destruct (Z.eqb_spec e 0) as [-> | E0].
    + change (Z.max 1 0 - 1075)%Z with (-1074)%Z. change (0 + 1 - 1075)%Z with (-1074)%Z.
      replace n with (2 ^ 52 - 1)%Z by lia. rewrite minus_IZR, Z.add_0_r. ring.
    + rewrite Z.max_r by lia. replace (e + 1 - 1075)%Z with (1 + (e - 1075))%Z by ring. rewrite bpow_plus.
      change (bpow radix2 1) with 2. replace (2 ^ 52 + m)%Z with (2 * 2 ^ 52 - 1)%Z by lia.
      rewrite minus_IZR, mult_IZR, Z.add_0_r. ring.
  - assert (Q : ((n + 1) / 2 ^ 52 = e)%Z) by (symmetry; apply Z.div_unique with (m + 1)%Z; lia).
    assert (R : ((n + 1) mod 2 ^ 52 = m + 1)%Z) by (symmetry; apply Z.mod_unique with e; lia).
    rewrite Q, R. destruct (Z.eqb_spec e 0) as [-> | E0].
    + change (Z.max 1 0 - 1075)%Z with (-1074)%Z. rewrite plus_IZR. ring.
    + rewrite Z.max_r by lia. rewrite Z.add_assoc, (plus_IZR _ 1). ring.
Qed.
Lemma doubles_increase m n : (0 <= m < n)%Z -> double_of_order m < double_of_order n.
Proof.
  intros (M & L). replace n with (m + 1 + Z.of_nat (Z.to_nat (n - m - 1)))%Z by lia.
  induction (Z.to_nat (n - m - 1)) as [| k IH].
  - rewrite Z.add_0_r, next_double by lia. pose proof (bpow_gt_0 radix2 (Z.max 1 (m / 2 ^ 52) - 1075)). lra.
  - rewrite Nat2Z.inj_succ. unfold Z.succ. rewrite Z.add_assoc, next_double by lia.
    pose proof (bpow_gt_0 radix2 (Z.max 1 ((m + 1 + Z.of_nat k) / 2 ^ 52) - 1075)). lra.
Qed.
Lemma first_double : double_of_order 0 = 0.
Proof. unfold double_of_order. simpl. ring. Qed.
Lemma last_double : double_of_order order_of_1 = 1.
Proof.
  unfold double_of_order, order_of_1. change (1023 * 2 ^ 52 / 2 ^ 52)%Z with 1023%Z. cbn [Z.eqb].
  change (1023 * 2 ^ 52 mod 2 ^ 52)%Z with 0%Z. change (1023 - 1075)%Z with (-52)%Z.
  change (IZR (2 ^ 52 + 0)) with (bpow radix2 52). now rewrite <- bpow_plus.
Qed.
Theorem double_numbers x : is_double x /\ 0 <= x <= 1 <->
  exists n, (0 <= n <= order_of_1)%Z /\ x = double_of_order n.
Proof.
  split.
  - intros (D & X0 & X1). destruct (Req_dec x 0) as [-> | N].
    { exists 0%Z. split; [easy |]. now rewrite first_double. }
    enough (exists n, (0 <= n)%Z /\ x = double_of_order n) as (n & N0 & E).
    { exists n. split; auto. split; auto. apply Z.nlt_ge. intros L.
      pose proof (doubles_increase order_of_1 n ltac:(easy)). rewrite last_double in H. lra. }
    unfold generic_format in D. set (e := cexp radix2 (FLT_exp (-1074) 53) x) in *.
    set (m := Ztrunc (scaled_mantissa radix2 (FLT_exp (-1074) 53) x)) in *.
    assert (E : x = IZR m * bpow radix2 e) by exact D.
    assert (Ee : e = Z.max (mag radix2 x - 53) (-1074)) by reflexivity.
    pose proof (bpow_gt_0 radix2 e) as Pe.
    assert (Pm : (0 < m)%Z).
    { apply lt_IZR. apply Rmult_lt_reg_r with (bpow radix2 e); auto. rewrite <- E. lra. }
    destruct (mag radix2 x) as (k & K). cbn [mag_val] in *. specialize (K N). rewrite Rabs_pos_eq in K by lra.
    destruct K as (K0 & K1).
    assert (M1 : (m < 2 ^ 53)%Z).
    { apply lt_IZR. change (2 ^ 53)%Z with (Zpower radix2 53). rewrite IZR_Zpower by easy.
      apply Rmult_lt_reg_r with (bpow radix2 e); auto. rewrite <- E, <- bpow_plus.
      apply Rlt_le_trans with (1 := K1). apply bpow_le. lia. }
    destruct (Z_lt_le_dec m (2 ^ 52)) as [S | S].
    + assert (Es : e = (-1074)%Z).
      { destruct (Z.max_spec (k - 53) (-1074)) as [(_ & G) | (G & G')]; [congruence |]. exfalso.
        assert (e = k - 53)%Z by lia. apply (Rlt_irrefl x).
        apply Rlt_le_trans with (bpow radix2 (k - 1)); auto. rewrite E.
        replace (k - 1)%Z with (52 + e)%Z by lia. rewrite bpow_plus. apply Rmult_lt_compat_r; auto.
        apply IZR_lt in S. exact S. }
      exists m. split; [lia |]. unfold double_of_order. rewrite Z.div_small by lia. cbn [Z.eqb]. now rewrite <- Es.
    + exists ((e + 1074) * 2 ^ 52 + m)%Z. split; [lia |]. unfold double_of_order.
      assert (Q : (((e + 1074) * 2 ^ 52 + m) / 2 ^ 52 = e + 1075)%Z)
        by (symmetry; apply Z.div_unique with (m - 2 ^ 52)%Z; lia).
      assert (R : (((e + 1074) * 2 ^ 52 + m) mod 2 ^ 52 = m - 2 ^ 52)%Z)
        by (symmetry; apply Z.mod_unique with (e + 1075)%Z; lia).
      rewrite Q, R. destruct (Z.eqb_spec (e + 1075) 0); [lia |].
      replace (2 ^ 52 + (m - 2 ^ 52))%Z with m by ring. now replace (e + 1075 - 1075)%Z with e by ring.
  - intros (n & (N0 & N1) & ->). split; [| split].
    + unfold double_of_order. apply generic_format_FLT.
      pose proof (Z.div_mod n (2 ^ 52) ltac:(easy)). pose proof (Z.mod_pos_bound n (2 ^ 52) ltac:(easy)).
      pose proof (Z.div_pos n (2 ^ 52) N0 ltac:(easy)). destruct (Z.eqb_spec (n / 2 ^ 52) 0) as [E | E].
      * exists (Float radix2 n (-1074)); unfold F2R; cbn [Fnum Fexp]; [easy | | lia].
        change (Zpower radix2 53) with (2 ^ 53)%Z. lia.
      * exists (Float radix2 (2 ^ 52 + n mod 2 ^ 52) (n / 2 ^ 52 - 1075)); unfold F2R; cbn [Fnum Fexp]; [easy | | lia].
        change (Zpower radix2 53) with (2 ^ 53)%Z. lia.
    + destruct (Z.eq_dec n 0) as [-> | N]; [rewrite first_double; lra |].
      pose proof (doubles_increase 0 n ltac:(lia)). rewrite first_double in H. lra.
    + destruct (Z.eq_dec n order_of_1) as [-> | N]; [rewrite last_double; lra |].
      pose proof (doubles_increase n order_of_1 ltac:(lia)). rewrite last_double in H. lra.
Qed.

(** ** Widths *)

Local Open Scope Z_scope.

(** The value at t/2^bits of a form with W words, bits <= 64T - 2 and s = 2^bits - t. *)
Definition search_numbers (W T N : nat) (p : list (list Z)) (s t : list Z) : list expression :=
  let of_bits x := Given T 1 (64 * Z.of_nat T - 2) x in
  [of_bits s; of_bits t; @Bernstein.value_at expressions
    (map (fun i => Given W (2 ^ (64 * Z.of_nat W - 1) - 1) 0 (nth i p [])) (seq 0 (Datatypes.S N))) (of_bits s) (of_bits t)].
(** Y has 3 or 6 words, a multiple root's linear form 6 or 12, and others are between these. *)
Theorem search_widths W T N p s t : (1 <= W <= 12)%nat -> In T [1; 2]%nat -> In N [1; 2; 3]%nat ->
  forallb fine (search_numbers W T N p s t) = true.
Proof.
  intros HW HT HN.
  assert (F : forallb (fun W => forallb (fun T => forallb (fun N => forallb is_measured (search_numbers W T N p s t))
    [1; 2; 3]%nat) [1; 2]%nat) (seq 1 12) = true) by (vm_compute; reflexivity).
  rewrite forallb_forall in F. specialize (F W ltac:(apply in_seq; lia)). rewrite forallb_forall in F.
  specialize (F T HT). rewrite forallb_forall in F. now apply all_measured, F.
Qed.
(** The numbers of first_root_nonpositive(f, b), and of bracket_of_quadratic_root, if f is a component of W × E, or
    b. *)
Definition first_root_numbers (b f : list expression) : list expression :=
  Shifted (nth 2 f (Whole 0)) 1 :: at_a_root_numbers b f.
Theorem first_root_widths W w e x : W = 1%nat \/ W = 2%nat ->
  let b := dot_form (moving W w) (moving W x) in
  forallb fine (flat_map (first_root_numbers b) (b :: components (cross_form (moving W w) (moving W e)))) = true.
Proof. intros [-> | ->]; apply all_measured; vm_cast_no_check (eq_refl true). Qed.
