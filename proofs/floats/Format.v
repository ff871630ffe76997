(** The floating-point format, its roundings, and the error of one operation.

    A format has radix 2, precision p, and the smallest positive number eta = 2^emin (Flocq's FLT: gradual
    underflow). It has no largest number: a computation without overflow gives the same numbers in a format with one.
    These files do not cover overflow. "direction" is any monotone rounding to a neighbour (up, down, to zero, to nearest);
    results for nearest say so. Notation, as in the C++ headers:
        eps = 2^(1-p)     the largest relative error of a rounding in any direction
        u   = 2^-p        the largest relative error to nearest
        eta = 2^emin      the smallest positive number
        smallest_normal = 2^(emin+p-1); its ulp, and that of all smaller numbers, is eta *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool.
From Flocq Require Import Core Relative Plus_error Mult_error.
Open Scope R_scope.

(** Errors of negations, of sums, and by an intermediate value. *)
Lemma within_opp b y s : Rabs (b - y) <= s -> Rabs (- b - - y) <= s.
Proof. replace (- b - - y) with (- (b - y)) by ring. now rewrite Rabs_Ropp. Qed.
Lemma within_through m v x r s : Rabs (v - m) <= r -> Rabs (m - x) <= s -> Rabs (v - x) <= r + s.
Proof. intros R S. apply Rabs_le_inv in R, S. apply Rabs_le. lra. Qed.
Lemma within_sum a x sa b y sb : Rabs (a - x) <= sa -> Rabs (b - y) <= sb -> Rabs (a + b - (x + y)) <= sa + sb.
Proof. intros A B. apply Rabs_le_inv in A, B. apply Rabs_le. lra. Qed.
Lemma within_positive a x s : Rabs (a - x) <= s -> 0 <= s.
Proof. generalize (Rabs_pos (a - x)). lra. Qed.
Lemma within_0 a x : Rabs (a - x) <= 0 -> a = x.
Proof. intros H. apply Rabs_le_inv in H. lra. Qed.

(** (1 + e)^k <= 1 + ke + (ke)^2 for ke <= 1. *)
Lemma power_quadratic e n : 0 <= e -> INR n * e <= 1 ->
  (1 + e) ^ n <= 1 + INR n * e + (INR n * e) * (INR n * e).
Proof.
  intros P. induction n as [| n IH]; intros H.
  - simpl. lra.
  - rewrite S_INR in *. rewrite <- tech_pow_Rmult. set (x := INR n * e) in *.
    replace ((INR n + 1) * e) with (x + e) in * by (unfold x; ring).
    assert (0 <= x) by (apply Rmult_le_pos; auto; apply pos_INR).
    assert (IH' : (1 + e) ^ n <= 1 + x + x * x) by (apply IH; lra).
    apply Rle_trans with ((1 + e) * (1 + x + x * x)).
    + apply Rmult_le_compat_l; lra.
    + assert (x * x <= x) by nra.
      assert (0 <= e * (x + e - x * x)) by (apply Rmult_le_pos; lra). nra.
Qed.

Section Format.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.

Notation format := (FLT_exp emin p).
Definition number (x : R) : Prop := generic_format radix2 format x.
Definition eps : R := bpow radix2 (1 - p).
Definition u : R := bpow radix2 (- p).
Definition eta : R := bpow radix2 emin.
Definition smallest_normal : R := bpow radix2 (emin + p - 1).

Lemma eps_positive : 0 < eps.
Proof. apply bpow_gt_0. Qed.
Lemma u_positive : 0 < u.
Proof. apply bpow_gt_0. Qed.
Lemma eta_positive : 0 < eta.
Proof. apply bpow_gt_0. Qed.
Lemma smallest_normal_positive : 0 < smallest_normal.
Proof. apply bpow_gt_0. Qed.

Lemma eps_2u : eps = 2 * u.
Proof.
  unfold eps, u. replace (1 - p)%Z with (1 + - p)%Z by lia. now rewrite bpow_plus.
Qed.

Lemma smallest_normal_eps : smallest_normal * eps = eta.
Proof. unfold smallest_normal, eps, eta. rewrite <- bpow_plus. f_equal. lia. Qed.

Lemma eta_le_smallest_normal : eta <= smallest_normal.
Proof. apply bpow_le. unfold Prec_gt_0 in p_positive. lia. Qed.

(** eps <= 2^(1-k) from k bits on. *)
Lemma eps_le (k : Z) : (k <= p)%Z -> eps <= bpow radix2 (1 - k).
Proof. intros H. apply bpow_le. lia. Qed.

Lemma number_0 : number 0.
Proof. apply generic_format_0. Qed.
Lemma number_power (e : Z) : (emin <= e)%Z -> number (bpow radix2 e).
Proof. apply generic_format_FLT_bpow. exact p_positive. Qed.
Lemma number_eta : number eta.
Proof. apply number_power. lia. Qed.
Lemma number_smallest_normal : number smallest_normal.
Proof. apply number_power. unfold Prec_gt_0 in p_positive. lia. Qed.
Lemma number_opp x : number x -> number (- x).
Proof. apply generic_format_opp. Qed.
Lemma number_abs x : number x -> number (Rabs x).
Proof. apply generic_format_abs. Qed.

(** Integers of at most p bits times a power of two. *)
Lemma number_integer (n e : Z) :
  (emin <= e)%Z -> (Z.abs n <= 2 ^ p)%Z -> number (IZR n * bpow radix2 e).
Proof.
  intros He Hn. unfold Prec_gt_0 in p_positive.
  destruct (Z.eq_dec (Z.abs n) (2 ^ p)) as [E | E].
  - destruct (Z.abs_spec n) as [[_ A] | [_ A]].
    + rewrite <- A, E. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
      rewrite <- bpow_plus. apply number_power. lia.
    + replace n with (- Z.abs n)%Z by lia. rewrite E, opp_IZR, <- Ropp_mult_distr_l.
      apply number_opp. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
      rewrite <- bpow_plus. apply number_power. lia.
  - apply generic_format_FLT. exists (Float radix2 n e); simpl; auto.
    change 2%Z with (radix_val radix2) in E. simpl in *. lia.
Qed.

(** Factors of the rules, and multiples of eta. *)
Lemma number_1_power (k : Z) : (2 <= p)%Z -> (emin <= 1 - p)%Z -> (1 <= k <= p + 1)%Z ->
  number (1 + bpow radix2 (k - p)).
Proof.
  intros P2 L K. destruct (Z.eq_dec k (p + 1)) as [-> | N].
  - replace (1 + bpow radix2 (p + 1 - p)) with (IZR 3 * bpow radix2 0)
      by (replace (p + 1 - p)%Z with 1%Z by lia; simpl; lra).
    apply number_integer; [lia |]. generalize (Z.pow_le_mono_r 2 2 p ltac:(lia) P2). simpl. lia.
  - replace (1 + bpow radix2 (k - p)) with (IZR (2 ^ (p - k) + 1) * bpow radix2 (k - p)).
    + apply number_integer; [lia |]. replace p with (1 + (p - 1))%Z at 2 by lia. rewrite Z.pow_add_r by lia.
      generalize (Z.pow_le_mono_r 2 (p - k) (p - 1) ltac:(lia) ltac:(lia)) (Z.pow_le_mono_r 2 1 (p - 1) ltac:(lia)
        ltac:(lia))
        (Z.pow_nonneg 2 (p - k) ltac:(lia)). simpl (2 ^ 1)%Z. lia.
    + rewrite plus_IZR, Rmult_plus_distr_r. change 2%Z with (radix_val radix2). rewrite IZR_Zpower, <- bpow_plus by lia.
      replace (p - k + (k - p))%Z with 0%Z by lia. simpl. lra.
Qed.
Lemma number_eta_times (k : Z) : (0 <= k)%Z -> number (IZR (2 ^ k) * eta).
Proof.
  intros K. change 2%Z with (radix_val radix2). unfold eta. rewrite IZR_Zpower, <- bpow_plus by easy.
  apply number_power. lia.
Qed.

Section Rounding.

Context (direction : R -> Z) {direction_valid : Valid_rnd direction}.

(** The rounded value of a real number: fl(x). *)
Definition rnd (x : R) : R := round radix2 format direction x.

Lemma rnd_number x : number (rnd x).
Proof. apply generic_format_round; auto with typeclass_instances. Qed.
Lemma rnd_exact x : number x -> rnd x = x.
Proof. intros H. apply round_generic; auto with typeclass_instances. Qed.
Lemma rnd_le x y : x <= y -> rnd x <= rnd y.
Proof. apply round_le; auto with typeclass_instances. Qed.
Lemma rnd_0 : rnd 0 = 0.
Proof. apply rnd_exact, number_0. Qed.
Lemma rnd_above x y : number x -> x <= y -> x <= rnd y.
Proof. intros N H. rewrite <- (rnd_exact x N). now apply rnd_le. Qed.
Lemma rnd_below x y : number y -> x <= y -> rnd x <= y.
Proof. intros N H. rewrite <- (rnd_exact y N). now apply rnd_le. Qed.
Lemma rnd_nonnegative x : 0 <= x -> 0 <= rnd x.
Proof. apply rnd_above, number_0. Qed.
Lemma rnd_abs_above x y : number x -> x <= Rabs y -> x <= Rabs (rnd y).
Proof. apply abs_round_ge_generic; auto with typeclass_instances. Qed.
Lemma rnd_abs_below x y : number y -> Rabs x <= y -> Rabs (rnd x) <= y.
Proof. apply abs_round_le_generic; auto with typeclass_instances. Qed.

(** One rounding in any direction: within eps of the exact result, relative, or within eta below the smallest normal
    number. *)
Lemma relative_error_any x : smallest_normal <= Rabs x -> Rabs (rnd x - x) <= eps * Rabs x.
Proof.
  intros H. unfold eps. replace (1 - p)%Z with (- p + 1)%Z by lia.
  apply Rlt_le, relative_error_FLT; auto with typeclass_instances.
Qed.
Lemma absolute_error_any x : Rabs x < smallest_normal -> Rabs (rnd x - x) <= eta.
Proof.
  intros H. unfold eta. rewrite <- (ulp_FLT_small radix2 emin p x).
  - apply error_le_ulp; auto with typeclass_instances.
  - apply Rlt_le_trans with (1 := H). apply bpow_le. lia.
Qed.

(** Scaling up is exact, and scaling down was if scaling up restores the number. *)
Lemma scale_up x e : number x -> (0 <= e)%Z -> rnd (x * bpow radix2 e) = x * bpow radix2 e.
Proof. intros. apply rnd_exact, mult_bpow_pos_exact_FLT; auto. Qed.
Lemma scale_back v a e : number v -> (e < 0)%Z -> rnd (v * bpow radix2 (- e)) = a ->
  v = a * bpow radix2 e.
Proof.
  intros N H. rewrite scale_up by (auto; lia). intros <-.
  rewrite Rmult_assoc, <- bpow_plus. replace (- e + e)%Z with 0%Z by lia. simpl. ring.
Qed.

(** The bound of rules with an error after scaling by 2^e; v is 2^e as computed. *)
Definition scaled_error (inflate : R -> R) (v a sa : R) (e : Z) : R :=
  let scaled := rnd (sa * bpow radix2 e) in
  let lossless := (0 <=? e)%Z ||
    (Req_bool (rnd (v * bpow radix2 (- e))) a && Req_bool (rnd (scaled * bpow radix2 (- e))) sa) in
  if lossless then rnd (scaled + rnd (v - v)) else inflate scaled.

(** Properties of a rounding: r is its largest relative error, h its largest error below the smallest normal number. *)
Record rounding_error (r h : R) : Prop := {
  error_relative : forall x, smallest_normal <= Rabs x -> Rabs (rnd x - x) <= r * Rabs x;
  error_absolute : forall x, Rabs x < smallest_normal -> Rabs (rnd x - x) <= h;
  error_r : 0 <= r <= eps;
  error_r_1 : r < 1;
  error_h : 0 <= h <= eta
}.

(** For any number, the sum of both errors is a bound. *)
Lemma error_any r h : rounding_error r h -> forall x, Rabs (rnd x - x) <= r * Rabs x + h.
Proof.
  intros E x. generalize (error_r r h E) (error_h r h E) (Rabs_pos x). intros.
  assert (0 <= r * Rabs x) by (apply Rmult_le_pos; lra). destruct (Rlt_or_le (Rabs x) smallest_normal) as [S | S];
    [generalize (error_absolute r h E x S) | generalize (error_relative r h E x S)]; lra.
Qed.

Lemma rounding_error_any : (2 <= p)%Z -> rounding_error eps eta.
Proof.
  intros P. split.
  - apply relative_error_any.
  - apply absolute_error_any.
  - generalize eps_positive; lra.
  - apply Rle_lt_trans with (1 := eps_le 2 P). simpl. lra.
  - generalize eta_positive; lra.
Qed.

(** The factors of the rules, 1 + 2^k eps, are numbers. *)
Lemma rnd_factor (k : Z) : (2 <= p)%Z -> (emin <= - p)%Z -> (0 <= k <= p)%Z ->
  rnd (1 + rnd (bpow radix2 k * eps)) = 1 + bpow radix2 k * eps.
Proof.
  intros P L K. unfold eps. rewrite <- bpow_plus. replace (k + (1 - p))%Z with (k + 1 - p)%Z by lia.
  rewrite (rnd_exact (bpow _ _)) by (apply number_power; lia). apply rnd_exact, number_1_power; lia.
Qed.

(** Sums that underflow are exact: up to 2^p eta, twice the smallest normal number. *)
Lemma sum_exact x y :
  number x -> number y -> Rabs (x + y) <= bpow radix2 (p + emin) -> number (x + y).
Proof. apply FLT_format_plus_small. exact p_positive. Qed.

Lemma twice_smallest_normal : bpow radix2 (p + emin) = 2 * smallest_normal.
Proof.
  unfold smallest_normal. replace (p + emin)%Z with (1 + (emin + p - 1))%Z by lia.
  now rewrite bpow_plus.
Qed.

Lemma sum_exact_below x y :
  number x -> number y -> Rabs (x + y) < smallest_normal -> rnd (x + y) = x + y.
Proof.
  intros X Y H. apply rnd_exact, sum_exact; auto. rewrite twice_smallest_normal.
  generalize smallest_normal_positive. lra.
Qed.

(** The rule's term for its rounding, fl(|v| c) with c >= eps, is at least the error of a sum rounded to v. For a
    product or quotient, this holds together with h. *)
Lemma ulp_covered v c :
  eps <= c -> smallest_normal <= Rabs v -> ulp radix2 format v <= rnd (Rabs v * c).
Proof.
  intros C V. apply rnd_above.
  - apply generic_format_ulp; auto with typeclass_instances.
  - apply Rle_trans with (Rabs v * eps).
    + apply ulp_FLT_le; auto.
    + apply Rmult_le_compat_l; auto. apply Rabs_pos.
Qed.

Lemma rounding_of_normal s c :
  eps <= c -> smallest_normal <= Rabs s -> Rabs (rnd s - s) <= rnd (Rabs (rnd s) * c).
Proof.
  intros C S. apply Rle_trans with (ulp radix2 format (rnd s)).
  - apply error_le_ulp_round; auto with typeclass_instances.
  - apply ulp_covered; auto. apply rnd_abs_above; auto. apply number_smallest_normal.
Qed.

Lemma rounding_term_nonnegative v c : 0 <= c -> 0 <= rnd (Rabs v * c).
Proof. intros C. apply rnd_nonnegative. apply Rmult_le_pos; auto. apply Rabs_pos. Qed.

Lemma rounding_of_sum x y c :
  number x -> number y -> eps <= c ->
  Rabs (rnd (x + y) - (x + y)) <= rnd (Rabs (rnd (x + y)) * c).
Proof.
  intros X Y C. destruct (Rlt_or_le (Rabs (x + y)) smallest_normal) as [S | S].
  - rewrite (sum_exact_below x y X Y S) at 1.
    replace (x + y - (x + y)) with 0 by ring. rewrite Rabs_R0.
    apply rounding_term_nonnegative. generalize eps_positive; lra.
  - now apply rounding_of_normal.
Qed.

Lemma rounding_of_any s c r h :
  rounding_error r h -> eps <= c -> Rabs (rnd s - s) <= rnd (Rabs (rnd s) * c) + h.
Proof.
  intros E C. destruct (Rlt_or_le (Rabs s) smallest_normal) as [S | S].
  - generalize (error_absolute r h E s S).
    assert (0 <= rnd (Rabs (rnd s) * c)).
    { apply rounding_term_nonnegative. generalize eps_positive; lra. }
    lra.
  - generalize (rounding_of_normal s c C S) (error_h r h E). lra.
Qed.

(** Lower bounds of a rounded nonnegative number. *)
Section Lower.

Context (r h : R) (E : rounding_error r h).

Lemma rnd_relative x : smallest_normal <= x -> x * (1 - r) <= rnd x.
Proof.
  intros H. generalize smallest_normal_positive; intros M.
  assert (A : Rabs x = x) by (apply Rabs_pos_eq; lra).
  generalize (error_relative r h E x). rewrite A. intros B. specialize (B H).
  apply Rabs_le_inv in B. lra.
Qed.

Lemma rnd_absolute x : 0 <= x -> x < smallest_normal -> x - h <= rnd x <= x + h.
Proof.
  intros P H. assert (A : Rabs x = x) by (apply Rabs_pos_eq; lra).
  generalize (error_absolute r h E x). rewrite A. intros B. specialize (B H).
  apply Rabs_le_inv in B. lra.
Qed.

(** For any number, one of both errors applies. *)
Lemma rnd_lower x : 0 <= x -> x * (1 - r) - h <= rnd x.
Proof.
  intros P. generalize (error_r r h E) (error_r_1 r h E) (error_h r h E); intros.
  destruct (Rlt_or_le x smallest_normal) as [S | S].
  - generalize (rnd_absolute x P S). nra.
  - generalize (rnd_relative x S). lra.
Qed.

Lemma rnd_normal x : smallest_normal <= x -> smallest_normal <= rnd x.
Proof. apply rnd_above, number_smallest_normal. Qed.

Lemma rnd_subnormal x : rnd x < smallest_normal -> x < smallest_normal.
Proof.
  intros H. apply Rnot_le_lt. intros C. apply rnd_normal in C. lra.
Qed.

(** Scaling by a power of two is exact unless it underflows; then the error is at most h. *)
Lemma scale_error x e : number x -> Rabs (rnd (x * bpow radix2 e) - x * bpow radix2 e) <= h.
Proof.
  intros N. destruct (Rlt_or_le (Rabs (x * bpow radix2 e)) smallest_normal) as [S | S].
  - now apply (error_absolute r h E).
  - rewrite rnd_exact.
    + replace (x * bpow radix2 e - x * bpow radix2 e) with 0 by ring. rewrite Rabs_R0.
      apply (error_h r h E).
    + apply mult_bpow_exact_FLT; auto. rewrite Rabs_mult, (Rabs_pos_eq (bpow _ _)) in S by apply bpow_ge_0.
      assert (M : bpow radix2 (emin + p - e - 1) <= Rabs x).
      { replace (emin + p - e - 1)%Z with (emin + p - 1 + - e)%Z by lia.
        rewrite bpow_plus, bpow_opp. unfold smallest_normal in S.
        apply Rmult_le_reg_r with (bpow radix2 e); [apply bpow_gt_0 |].
        rewrite Rmult_assoc, Rinv_l, Rmult_1_r; auto. apply Rgt_not_eq, bpow_gt_0. }
      apply mag_ge_bpow in M. lia.
Qed.

Lemma scaled_error_sound inflate a x sa e :
  (forall s, number s -> 0 <= s -> s + 2 * h <= inflate s) ->
  number a -> number sa -> Rabs (a - x) <= sa ->
  Rabs (rnd (a * bpow radix2 e) - x * bpow radix2 e) <=
    scaled_error inflate (rnd (a * bpow radix2 e)) a sa e.
Proof.
  intros I A SA H. unfold scaled_error. cbv zeta.
  set (v := rnd (a * bpow radix2 e)). set (s := rnd (sa * bpow radix2 e)).
  generalize (bpow_ge_0 radix2 e). intros PB.
  assert (PA : 0 <= sa) by (generalize (Rabs_pos (a - x)); lra).
  assert (D : Rabs (a * bpow radix2 e - x * bpow radix2 e) <= sa * bpow radix2 e).
  { rewrite <- Rmult_minus_distr_r, Rabs_mult, (Rabs_pos_eq (bpow _ _)) by auto.
    now apply Rmult_le_compat_r. }
  assert (Ns : number s) by apply rnd_number. assert (Nv : number v) by apply rnd_number.
  assert (Z : rnd (s + rnd (v - v)) = s).
  { replace (v - v) with 0 by ring. rewrite rnd_0, Rplus_0_r. now apply rnd_exact. }
  destruct (Z.leb_spec 0 e) as [P | P]; cbn [orb].
  { rewrite Z. unfold v, s. now rewrite !scale_up. }
  assert (L : Rabs (v - x * bpow radix2 e) <= inflate s).
  { apply Rle_trans with (s + 2 * h); [| apply I; auto; now apply rnd_nonnegative, Rmult_le_pos].
    generalize (scale_error a e A) (scale_error sa e SA). fold v s. intros DA DS.
    apply Rabs_le_inv in DA, DS, D. apply Rabs_le. lra. }
  destruct (Req_bool_spec (rnd (v * bpow radix2 (- e))) a) as [B | B]; auto.
  destruct (Req_bool_spec (rnd (s * bpow radix2 (- e))) sa) as [C | C]; auto.
  cbn [andb]. rewrite Z. apply scale_back in B, C; auto. now rewrite B, C.
Qed.

(** A sum of nonnegative numbers has the relative error r, and none below the smallest normal number. *)
Lemma sum_relative x y :
  number x -> number y -> 0 <= x -> 0 <= y -> (x + y) * (1 - r) <= rnd (x + y).
Proof.
  intros X Y PX PY. destruct (Rlt_or_le (x + y) smallest_normal) as [S | S].
  - rewrite sum_exact_below; auto.
    + generalize (error_r r h E). nra.
    + rewrite Rabs_pos_eq; lra.
  - now apply rnd_relative.
Qed.

Lemma sum_subnormal x y :
  number x -> number y -> 0 <= x -> 0 <= y -> rnd (x + y) < smallest_normal ->
  rnd (x + y) = x + y.
Proof.
  intros X Y PX PY H. apply rnd_subnormal in H. apply sum_exact_below; auto.
  rewrite Rabs_pos_eq; lra.
Qed.

(** The error of a sum in units of the exact sum. *)
Lemma sum_error x y : number x -> number y -> Rabs (rnd (x + y) - (x + y)) <= r * Rabs (x + y).
Proof.
  intros X Y. destruct (Rlt_or_le (Rabs (x + y)) smallest_normal) as [S | S].
  - rewrite sum_exact_below; auto. replace (x + y - (x + y)) with 0 by ring.
    rewrite Rabs_R0. apply Rmult_le_pos. apply (error_r r h E). apply Rabs_pos.
  - now apply (error_relative r h E).
Qed.

(** A product with a factor f >= 1 is no smaller below the smallest normal number. *)
Lemma scaled_up x f : number x -> 0 <= x -> 1 <= f -> x <= rnd (x * f).
Proof. intros X P H. apply rnd_above; auto. nra. Qed.

End Lower.

(** A rounding leaves at least the share q of a normal number, and all but h of a smaller one. *)
Section Share.

Context (q h : R) (q_1 : 0 < q <= 1) (h_0 : 0 <= h) (normal : forall x, smallest_normal <= x -> x * q <= rnd x)
  (small : forall x, 0 <= x -> x < smallest_normal -> x - h <= rnd x).

Lemma any_left x : 0 <= x -> x * q - h <= rnd x.
Proof.
  intros P. destruct (Rlt_or_le x smallest_normal) as [C | C].
  - generalize (small x P C). nra.
  - generalize (normal x C). lra.
Qed.
Lemma sum_left x y : number x -> number y -> 0 <= x + y -> (x + y) * q <= rnd (x + y).
Proof.
  intros X Y P. destruct (Rlt_or_le (x + y) smallest_normal) as [C | C]; [| now apply normal].
  rewrite sum_exact_below by (auto; rewrite Rabs_pos_eq; lra). nra.
Qed.

(** If s is at least k x, and the factor g covers k and one more rounding, s g as computed is at least x. *)
Lemma scaled_left s g : smallest_normal <= s -> 1 <= g -> s * (g * q) <= rnd (s * g).
Proof. intros M G. rewrite <- Rmult_assoc. apply normal. generalize smallest_normal_positive. nra. Qed.
Lemma scaled_covers x s k g : number s -> 0 <= x -> 0 <= s -> 1 <= g -> 1 <= g * (k * q) -> x * k <= s ->
  (s < smallest_normal -> x <= s) -> x <= rnd (s * g).
Proof.
  intros N X S G K L Small. destruct (Rlt_or_le s smallest_normal) as [C | C].
  - apply Rle_trans with s; auto. apply scaled_up; auto.
  - apply Rle_trans with (2 := scaled_left s g C G). apply Rle_trans with (x * k * (g * q)).
    + replace (x * k * (g * q)) with (x * (g * (k * q))) by ring. nra.
    + apply Rmult_le_compat_r; auto. apply Rmult_le_pos; lra.
Qed.

(** The error that a product inherits from its factors' bounds, as the rules compute it. *)
Lemma product_left a sa b sb : number b -> number sb -> 0 <= a -> 0 <= b -> 0 <= sa -> 0 <= sb ->
  let inherited := rnd (rnd (a * sb) + rnd (sa * rnd (b + sb))) in
  let exactly := a * sb + sa * (b + sb) in
  0 <= exactly /\ 0 <= inherited /\ (exactly * (q * q) - 2 * h) * q <= inherited /\
  (inherited < smallest_normal -> exists w, sa * (b + sb) * q <= w <= inherited + h /\ a * sb + w <= inherited + 2 * h).
Proof.
  intros B SB PA PB PSa PSb. cbv zeta. set (w := sa * rnd (b + sb)). set (K := a * sb). set (T := sa * (b + sb)).
  set (P1 := rnd K). set (P2 := rnd w). set (I := rnd (P1 + P2)).
  assert (PK : 0 <= K) by now apply Rmult_le_pos. assert (PT : 0 <= T) by (apply Rmult_le_pos; lra).
  assert (Pw : 0 <= w) by (apply Rmult_le_pos; auto; apply rnd_nonnegative; lra).
  assert (Pos1 : 0 <= P1) by now apply rnd_nonnegative. assert (Pos2 : 0 <= P2) by now apply rnd_nonnegative.
  assert (N1 : number P1) by apply rnd_number. assert (N2 : number P2) by apply rnd_number.
  assert (Hw : T * q <= w).
  { unfold T, w. rewrite Rmult_assoc. apply Rmult_le_compat_l; auto. apply sum_left; auto. lra. }
  split; [lra |]. split; [apply rnd_nonnegative; lra |]. split.
  - generalize (any_left K PK) (any_left w Pw) (sum_left P1 P2 N1 N2 ltac:(lra)). fold P1 P2 I. intros D1 D2 D3.
    apply Rle_trans with (2 := D3). apply Rmult_le_compat_r; [lra |].
    assert (K * (q * q) <= K * q) by (apply Rmult_le_compat_l; nra).
    assert (T * (q * q) <= w * q) by (rewrite <- Rmult_assoc; apply Rmult_le_compat_r; lra). lra.
  - intros C. assert (L1 : P1 <= I) by (apply rnd_above; auto; lra).
    assert (L2 : P2 <= I) by (apply rnd_above; auto; lra).
    assert (EI : I = P1 + P2) by (apply (sum_subnormal P1 P2); auto; fold I; lra).
    assert (D1 : K - h <= P1) by (apply small; auto; apply rnd_subnormal; fold P1; lra).
    assert (D2 : w - h <= P2) by (apply small; auto; apply rnd_subnormal; fold P2; lra).
    exists w. lra.
Qed.

End Share.

End Rounding.

(** A factor that covers some roundings covers fewer. *)
Lemma fewer_roundings f q fewer : 0 <= f -> 0 < q <= 1 -> 1 <= f * (fewer * q) -> 1 <= f * fewer.
Proof. intros F Q H. rewrite <- Rmult_assoc in H. nra. Qed.

(** Rounding to nearest, ties to even. *)
Notation nearest := (Znearest (fun n => negb (Z.even n))).
Definition rnd_nearest (x : R) : R := rnd nearest x.

Lemma rounding_error_nearest : (1 <= p)%Z -> rounding_error nearest u (eta / 2).
Proof.
  intros P. split.
  - intros x H. replace u with (/ 2 * bpow radix2 (- p + 1)).
    + apply relative_error_N_FLT; auto.
    + rewrite bpow_plus. change (bpow radix2 1) with 2. unfold u. field.
  - intros x H. replace (eta / 2) with (/ 2 * ulp radix2 format x).
    + apply error_le_half_ulp; auto with typeclass_instances.
    + unfold eta. rewrite ulp_FLT_small; auto. field.
      apply Rlt_le_trans with (1 := H). apply bpow_le. lia.
  - rewrite eps_2u. generalize u_positive. lra.
  - generalize (eps_le 1 P) eps_2u u_positive. simpl. lra.
  - generalize eta_positive. lra.
Qed.

(** The error in units of the result, for large and small results. *)
Lemma error_of_large s : bpow radix2 (p + emin) <= Rabs (rnd nearest s) ->
  Rabs (rnd nearest s - s) <= rnd nearest (Rabs (rnd nearest s) * u).
Proof.
  intros V. apply Rle_trans with (/ 2 * ulp radix2 format (rnd nearest s)).
  - apply error_le_half_ulp_round; auto with typeclass_instances.
  - assert (NZ : rnd nearest s <> 0).
    { intros Z. rewrite Z, Rabs_R0 in V. generalize (bpow_gt_0 radix2 (p + emin)). lra. }
    apply rnd_above; auto with typeclass_instances.
    + rewrite ulp_neq_0; auto. replace (/ 2) with (bpow radix2 (-1)) by reflexivity.
      rewrite <- bpow_plus. apply number_power.
      assert (p + emin < mag radix2 (rnd nearest s))%Z by (apply mag_gt_bpow; auto).
      unfold cexp, FLT_exp. lia.
    + assert (ulp radix2 format (rnd nearest s) <= Rabs (rnd nearest s) * bpow radix2 (1 - p)).
      { apply ulp_FLT_le; auto. apply Rle_trans with (2 := V). apply bpow_le. lia. }
      change (bpow radix2 (1 - p)) with eps in *. rewrite eps_2u in *. lra.
Qed.
Lemma error_of_small s : Rabs (rnd nearest s) < bpow radix2 (p + emin) -> Rabs (rnd nearest s - s) <= eta / 2.
Proof.
  intros C. replace (eta / 2) with (/ 2 * ulp radix2 format (rnd nearest s)).
  - apply error_le_half_ulp_round; auto with typeclass_instances.
  - rewrite ulp_FLT_small; auto. unfold eta. field. rewrite Z.add_comm. exact C.
Qed.

(** In units of the result: x is at most (1 + u) fl(x). *)
Lemma nearest_relative_to_result x :
  smallest_normal <= Rabs x -> Rabs (rnd_nearest x - x) <= u * Rabs (rnd_nearest x).
Proof.
  intros H. replace u with (/ 2 * bpow radix2 (- p + 1)).
  - apply relative_error_N_FLT_round; auto.
  - rewrite bpow_plus. change (bpow radix2 1) with 2. unfold u. field.
Qed.

Lemma sum_relative_to_result x y : number x -> number y ->
  Rabs (rnd nearest (x + y) - (x + y)) <= u * Rabs (rnd nearest (x + y)).
Proof.
  intros X Y. destruct (Rlt_or_le (Rabs (x + y)) smallest_normal) as [C | C]; [| now apply nearest_relative_to_result].
  rewrite (sum_exact_below nearest x y X Y C) at 1. replace (x + y - (x + y)) with 0 by ring. rewrite Rabs_R0.
  apply Rmult_le_pos; [apply bpow_ge_0 | apply Rabs_pos].
Qed.

(** The smallest positive number disappears in a sum with 1. *)
Lemma eta_lost : (3 <= p)%Z -> (emin <= - p - 1)%Z -> rnd nearest (1 + eta) = 1.
Proof.
  intros P L.
  assert (N1 : number 1) by (change 1 with (bpow radix2 0); apply number_power; lia).
  generalize u_positive eta_positive eps_2u. intros Pu Pe E2.
  assert (U : u <= / 8) by (generalize (eps_le 3 P); simpl; lra).
  assert (H : 2 * eta <= u).
  { change 2 with (bpow radix2 1). unfold eta, u. rewrite <- bpow_plus. apply bpow_le. lia. }
  assert (L1 : 1 <= rnd nearest (1 + eta)) by (apply rnd_above; auto with typeclass_instances; lra).
  destruct (Rle_lt_or_eq_dec _ _ L1) as [C | C]; [exfalso | auto].
  apply (succ_le_lt radix2 format) in C; auto with typeclass_instances.
  2: apply rnd_number; auto with typeclass_instances.
  rewrite succ_eq_pos in C by lra. change 1 with (bpow radix2 0) in C at 2. rewrite ulp_bpow in C.
  replace (format (0 + 1)) with (1 - p)%Z in C by (unfold FLT_exp; lia).
  change (bpow radix2 (1 - p)) with eps in C.
  assert (D : Rabs (rnd nearest (1 + eta) - (1 + eta)) <= u * Rabs (1 + eta)).
  { apply (error_relative nearest _ _ (rounding_error_nearest ltac:(lia))).
    rewrite Rabs_pos_eq by lra. assert (smallest_normal <= 1); [| lra].
    change 1 with (bpow radix2 0). apply bpow_le. lia. }
  rewrite (Rabs_pos_eq (1 + _)) in D by lra. apply Rabs_le_inv in D. nra.
Qed.

End Format.

Notation nearest := (Znearest (fun n => negb (Z.even n))).
