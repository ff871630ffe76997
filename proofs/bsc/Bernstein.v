(** Polynomials in Bernstein form (include/errbound/bernstein.hpp), over every scalar of the library. A scalar is a
    number x of the C++ templates that represents a real number, exact x (tracked numbers of any rule, integers,
    rationals). Its operations are those of the real numbers, and its signs are right or uncertain. Each rule's
    file and Sign.v prove this for tracked numbers. A list h of scaled coefficients is the form h_0 s^N + h_1
    s^(N-1) t + ... + h_N t^N, the polynomial's value if s = 1 - t. Results:
        value_at_form, product_form, elevated_form, derivative_form   operations give the forms that they name
        left_part_form, left_half_form, reversed_form   subdivision, and the exchange of s and t
        scaled_cubic, scaled_quartic   coefficients of given control values
        form_ends, power_basis   end coefficients are end values; coefficients are those of powers of x = t/s
        hull_bounds, rootless_hull   min b_i <= p(t) <= max b_i for the control values b_i = h_i/C(N, i); with one
            strict sign of all coefficients there is no root in [0, 1]
        sign_inside_right, sign_throughout_right   conclusions of the code from signs of coefficients *)

From Coq Require Import Reals ZArith Lia Lra List.
From Errbound Require Import Sign.
Import ListNotations.
Open Scope R_scope.

Record scalar := {
  number :> Type;
  add : number -> number -> number;
  sub : number -> number -> number;
  mul : number -> number -> number;
  opp : number -> number;
  whole : Z -> number;                          (** S(n) *)
  twice : number -> number;                     (** scale(x, 1) *)
  normalized : list number -> list number;
  sign_of : number -> sign;
  exact : number -> R;
  exact_add : forall x y, exact (add x y) = exact x + exact y;
  exact_sub : forall x y, exact (sub x y) = exact x - exact y;
  exact_mul : forall x y, exact (mul x y) = exact x * exact y;
  exact_opp : forall x, exact (opp x) = - exact x;
  exact_whole : forall n, exact (whole n) = IZR n;
  exact_twice : forall x, exact (twice x) = 2 * exact x;
  normalized_right : forall p, exists c, 0 < c /\ map exact (normalized p) = map (Rmult c) (map exact
    p);
  sign_right : forall x, sign_is_right (sign_of x) (exact x)
}.
Arguments add {s}. Arguments sub {s}. Arguments mul {s}. Arguments opp {s}. Arguments whole {s}.
Arguments twice {s}. Arguments normalized {s}. Arguments sign_of {s}. Arguments exact {s}.

Fixpoint form (h : list R) (s t : R) : R :=
  match h with
  | [] => 0
  | a :: l => a * s ^ length l + t * form l s t
  end.

(** The polynomial that a form of the code represents. *)
Definition at_time {S : scalar} (p : list S) (t : R) : R := form (map exact p) (1 - t) t.

Ltac exacts := repeat rewrite ?exact_add, ?exact_sub, ?exact_mul, ?exact_opp, ?exact_whole,
  ?exact_twice.

(** ** Facts of forms *)

Lemma form_scaled c h s t : form (map (Rmult c) h) s t = c * form h s t.
Proof. induction h as [| a l IH]; simpl; [| rewrite IH, map_length]; ring. Qed.

Lemma form_opp h s t : form (map Ropp h) s t = - form h s t.
Proof. induction h as [| a l IH]; simpl; [| rewrite IH, map_length]; ring. Qed.

Lemma form_homogeneous a h c s t : form (a :: h) (c * s) (c * t) = c ^ length h * form (a :: h) s t.
Proof.
  revert a. induction h as [| b l IH]; intros a; simpl; [ring |].
  specialize (IH b). simpl in IH. rewrite Rpow_mult_distr in *.
  replace (c * t * (b * (c ^ length l * s ^ length l) + c * t * form l (c * s) (c * t)))
    with (c * t * (c ^ length l * (b * s ^ length l + t * form l s t))) by (rewrite <- IH; ring).
  ring.
Qed.

Theorem form_ends a l b : form (a :: l) 1 0 = a /\ form (l ++ [b]) 0 1 = b.
Proof.
  split; [simpl; rewrite pow1; ring |].
  induction l as [| c l IH]; simpl; [ring |].
  rewrite IH, app_length, Nat.add_comm. simpl. ring.
Qed.

Lemma form_plus f g s t : length f = length g ->
  form (map (fun xy => fst xy + snd xy) (combine f g)) s t = form f s t + form g s t.
Proof.
  revert g. induction f as [| a f IH]; intros [| b g] L; try discriminate; simpl; [ring |].
  injection L as L. rewrite IH by easy. rewrite map_length, combine_length, L, Nat.min_id. ring.
Qed.

(** The form at x = t/s, with h_0 as the constant term. *)
Fixpoint power_form (h : list R) (x : R) : R :=
  match h with [] => 0 | a :: l => a + x * power_form l x end.
Theorem power_basis a l s t : s <> 0 -> form (a :: l) s t = s ^ length l * power_form (a :: l) (t / s).
Proof.
  intros Z. revert a. induction l as [| b l IH]; intros a.
  - simpl. ring.
  - change (form (a :: b :: l) s t) with (a * s ^ S (length l) + t * form (b :: l) s t).
    rewrite IH.
    change (power_form (a :: b :: l) (t / s)) with (a + t / s * power_form (b :: l) (t / s)).
    simpl. field. easy.
Qed.

(** ** The convex hull *)

Lemma hull_nonnegative h s t : Forall (Rle 0) h -> 0 <= s -> 0 <= t -> 0 <= form h s t.
Proof.
  intros F Hs Ht. induction F as [| a l P F IH]; simpl; [lra |].
  assert (0 <= a * s ^ length l) by (apply Rmult_le_pos; auto; apply pow_le; auto).
  assert (0 <= t * form l s t) by (apply Rmult_le_pos; auto). lra.
Qed.

Lemma hull_inside h s t : Forall (Rle 0) h -> Exists (Rlt 0) h -> 0 < s -> 0 < t -> 0 < form h s t.
Proof.
  intros F E Hs Ht. induction E as [a l P | a l E IH]; simpl; inversion_clear F.
  - assert (0 < a * s ^ length l) by (apply Rmult_lt_0_compat; auto; apply pow_lt; auto).
    assert (0 <= t * form l s t) by (apply Rmult_le_pos; try apply hull_nonnegative; auto; lra). lra.
  - assert (0 <= a * s ^ length l) by (apply Rmult_le_pos; auto; apply pow_le; lra).
    assert (0 < t * form l s t) by (apply Rmult_lt_0_compat; auto). lra.
Qed.

Lemma hull_positive a l s t : Forall (Rlt 0) (a :: l) -> 0 <= s -> 0 <= t -> 0 < s + t ->
  0 < form (a :: l) s t.
Proof.
  intros F Hs Ht P.
  assert (N : Forall (Rle 0) (a :: l)) by (eapply Forall_impl; [| exact F]; simpl; intros; lra).
  assert (A : 0 < a) by (inversion F; auto).
  destruct (Req_dec s 0) as [-> | Zs]; [| destruct (Req_dec t 0) as [-> | Zt]].
  - assert (T : 0 < t) by lra. clear Hs Ht P N A. revert a F.
    induction l as [| b l IH]; intros a F; inversion_clear F; [simpl; lra |].
    specialize (IH b H0).
    change (form (a :: b :: l) 0 t) with (a * 0 ^ S (length l) + t * form (b :: l) 0 t).
    rewrite pow_i by lia. assert (0 < t * form (b :: l) 0 t) by (apply Rmult_lt_0_compat; auto). lra.
  - simpl. assert (0 < a * s ^ length l) by (apply Rmult_lt_0_compat; auto; apply pow_lt; lra). lra.
  - apply hull_inside; auto; lra.
Qed.

(** C(N, 0), ..., C(N, N) by Pascal's triangle. *)
Fixpoint binomials (n : nat) : list R :=
  match n with
  | O => [1]
  | S n => map (fun xy => fst xy + snd xy) (combine (binomials n ++ [0]) (0 :: binomials n))
  end.
Lemma length_binomials n : length (binomials n) = S n.
Proof.
  induction n as [| n IH]; [easy |]. simpl. rewrite map_length, combine_length, app_length. simpl. lia.
Qed.
Lemma form_append_0 h s t : form (h ++ [0]) s t = s * form h s t.
Proof.
  induction h as [| a l IH]; simpl; [ring |]. rewrite IH, app_length, Nat.add_comm. simpl. ring.
Qed.
Lemma form_binomials n s t : form (binomials n) s t = (s + t) ^ n.
Proof.
  induction n as [| n IH]; [simpl; ring |]. simpl binomials. rewrite form_plus.
  - rewrite form_append_0. simpl. rewrite IH. ring.
  - rewrite app_length. simpl. lia.
Qed.
Lemma binomials_nonnegative n : Forall (Rle 0) (binomials n).
Proof.
  induction n as [| n IH]; [repeat constructor; lra |]. simpl.
  apply Forall_forall. intros x I. apply in_map_iff in I. destruct I as ([y z] & <- & I). simpl.
  pose proof (in_combine_l _ _ _ _ I) as L. pose proof (in_combine_r _ _ _ _ I) as R0.
  rewrite Forall_forall in IH. apply in_app_or in L.
  assert (0 <= y) by (destruct L as [L | [<- | []]]; auto; lra).
  assert (0 <= z) by (destruct R0 as [<- | R0]; auto; lra). lra.
Qed.

Fixpoint products (c b : list R) : list R :=
  match c, b with x :: c, y :: b => x * y :: products c b | _, _ => [] end.
(** h_i = C(N, i) b_i *)
Definition scaled_coefficients (b : list R) : list R := products (binomials (length b - 1)) b.

Theorem scaled_cubic k0 k1 k2 k3 : scaled_coefficients [k0; k1; k2; k3] = [k0; 3 * k1; 3 * k2; k3].
Proof. unfold scaled_coefficients. simpl. repeat f_equal; ring. Qed.
Theorem scaled_quartic g0 g1 g2 g3 g4 :
  scaled_coefficients [g0; g1; g2; g3; g4] = [g0; 4 * g1; 6 * g2; 4 * g3; g4].
Proof. unfold scaled_coefficients. simpl. repeat f_equal; ring. Qed.

Lemma products_below c l k s t : Forall (Rle 0) c -> length c = length l -> Forall (Rle k) l ->
  0 <= s -> 0 <= t -> k * form c s t <= form (products c l) s t /\ length (products c l) = length l.
Proof.
  intros Fc L G Hs Ht. revert l L G.
  induction Fc as [| x c X Fc IH]; intros [| y l] L G; try discriminate.
  - simpl. split; [lra | easy].
  - injection L as L. inversion_clear G as [| ? ? K G']. destruct (IH l L G') as (I & E). simpl.
    rewrite E, L. split; [| easy].
    assert (0 <= x * s ^ length l) by (apply Rmult_le_pos; auto; apply pow_le; auto).
    assert (x * s ^ length l * k <= x * s ^ length l * y) by (apply Rmult_le_compat_l; auto).
    assert (t * (k * form c s t) <= t * form (products c l) s t) by (apply Rmult_le_compat_l; auto).
      lra.
Qed.
Lemma products_opp c b : products c (map Ropp b) = map Ropp (products c b).
Proof.
  revert b. induction c as [| x c IH]; intros [| y b]; simpl; auto. rewrite IH. f_equal. ring.
Qed.

Theorem hull_bounds b m M t : b <> [] -> Forall (fun x => m <= x <= M) b -> 0 <= t <= 1 ->
  m <= form (scaled_coefficients b) (1 - t) t <= M.
Proof.
  intros N F T. unfold scaled_coefficients. set (c := binomials (length b - 1)).
  assert (L : length c = length b) by (unfold c; rewrite length_binomials; destruct b; [easy | simpl;
    lia]).
  assert (One : form c (1 - t) t = 1)
    by (unfold c; rewrite form_binomials; replace (1 - t + t) with 1 by ring; apply pow1).
  assert (C : Forall (Rle 0) c) by apply binomials_nonnegative.
  destruct (products_below c b m (1 - t) t) as (Low & _); auto; try lra.
  { eapply Forall_impl; [| exact F]. simpl. intros; lra. }
  destruct (products_below c (map Ropp b) (- M) (1 - t) t) as (High & _); auto; try lra.
  { now rewrite map_length. }
  { apply Forall_map. eapply Forall_impl; [| exact F]. simpl. intros; lra. }
  rewrite products_opp, form_opp in High. rewrite One in *. lra.
Qed.

(** ** The code *)

Section Code.

Context {S : scalar}.
Notation exacts := (map (@exact S)).

(** value_at(p, s, t), by Horner's rule; power is t^i. *)
Fixpoint value_from_term (sum : S) (p : list S) (s t power : S) : S :=
  match p with
  | [] => sum
  | a :: l =>
      let next := add (mul sum s) (mul a power) in
      match l with [] => next | _ => value_from_term next l s t (mul power t) end
  end.
Definition value_at (p : list S) (s t : S) : S :=
  match p with [] => whole 0 | a :: l => value_from_term a l s t t end.

Theorem value_at_form p s t : exact (value_at p s t) = form (exacts p) (exact s) (exact t).
Proof.
  assert (H : forall l sum power, exact (value_from_term sum l s t power) =
    exact sum * exact s ^ length l + exact power * form (exacts l) (exact s) (exact t)).
  { induction l as [| a l IH]; intros sum power; [simpl; ring |]. cbn [value_from_term].
    destruct l as [| b l].
    - simpl. exacts. ring.
    - rewrite IH. exacts. change (form (exacts (a :: b :: l)) (exact s) (exact t))
        with (exact a * exact s ^ length (exacts (b :: l)) + exact t * form (exacts (b :: l)) (exact s)
          (exact t)).
      rewrite map_length. change (length (a :: b :: l)) with (Datatypes.S (length (b :: l))).
      rewrite <- tech_pow_Rmult. ring. }
  destruct p as [| a l]; simpl; [now exacts |]. now rewrite H, map_length.
Qed.

(** p * q, a convolution: the terms p_i q_(k-i) of a coefficient are added from the smallest i on, and the first
    one is stored. `sums` are the coefficients so far, from the first one of p_i on. *)
Fixpoint plus (p q : list S) : list S :=
  match p, q with
  | a :: p, b :: q => add a b :: plus p q
  | [], q => q
  | p, [] => p
  end.
Fixpoint product_after (sums p q : list S) : list S :=
  match p with
  | [] => sums
  | a :: l =>
      match plus sums (map (mul a) q) with
      | [] => []
      | b :: sums => b :: product_after sums l q
      end
  end.
Definition product : list S -> list S -> list S := product_after [].

Lemma plus_form p q s t : (length p <= length q)%nat ->
  form (exacts (plus p q)) s t = s ^ (length q - length p) * form (exacts p) s t + form (exacts q) s t
    /\
  length (plus p q) = length q.
Proof.
  revert q. induction p as [| a p IH]; intros [| b q] L; simpl in *; try (split; [ring | easy]).
  destruct (IH q ltac:(lia)) as (E & M). rewrite E, !map_length, M. split; [| easy].
  replace (length q) with (length q - length p + length p)%nat at 1 by lia. rewrite pow_add. exacts.
  replace (exact b * s ^ length q) with (exact b * (s ^ (length q - length p) * s ^ length p))
    by (rewrite <- pow_add; repeat f_equal; lia). ring.
Qed.

Lemma times_form a q s t : form (exacts (map (mul a) q)) s t = exact a * form (exacts q) s t.
Proof. induction q as [| c q IH]; simpl; [ring |]. rewrite IH, !map_length. exacts. ring. Qed.

Lemma product_after_form sums p b q s t : length sums = length q ->
  form (exacts (product_after sums p (b :: q))) s t =
    s ^ length p * form (exacts sums) s t + form (exacts p) s t * form (exacts (b :: q)) s t /\
  length (product_after sums p (b :: q)) = (length p + length q)%nat.
Proof.
  revert sums. induction p as [| a l IH]; intros sums L; [simpl; split; [ring | easy] |].
  destruct (plus_form sums (map (mul a) (b :: q)) s t) as (F & K).
  { rewrite map_length. cbn [length]. lia. }
  rewrite times_form, !map_length in F. rewrite map_length in K. cbn [product_after].
  destruct (plus sums (map (mul a) (b :: q))) as [| c rest]; [discriminate |]. injection K as K.
  destruct (IH rest K) as (E & N). cbn [length]. split; [| simpl; lia].
  replace (length (b :: q) - length sums)%nat with 1%nat in F by (cbn [length]; lia).
  cbn [map form] in F |- *. rewrite !map_length in *. rewrite E, N, pow_add. cbn [map form]. rewrite map_length.
  rewrite K in F. apply (f_equal (Rmult (s ^ length l))) in F. simpl in *. lra.
Qed.

Lemma product_both p b q s t :
  form (exacts (product p (b :: q))) s t = form (exacts p) s t * form (exacts (b :: q)) s t /\
  (p <> [] -> length (product p (b :: q)) = (length p + length q)%nat).
Proof.
  destruct p as [| a l]; [simpl; split; [ring | easy] |]. unfold product; cbn [product_after plus map].
  destruct (product_after_form (map (mul a) q) l b q s t (map_length _ _)) as (E & L).
  cbn [map form]. rewrite E, times_form, !map_length, L, exact_mul. cbn [map form]. rewrite map_length.
  split; [rewrite pow_add; ring | intros _; cbn [length]; rewrite L; lia].
Qed.

Theorem product_form p q s t :
  form (exacts (product p q)) s t = form (exacts p) s t * form (exacts q) s t.
Proof.
  destruct q as [| b q]; [| apply product_both]. destruct p; simpl; ring.
Qed.

(** elevated(p): p_0, p_1 + p_0, ..., p_N + p_(N-1), p_N. *)
Fixpoint elevated_after (before : S) (p : list S) : list S :=
  match p with [] => [before] | a :: l => add a before :: elevated_after a l end.
Definition elevated (p : list S) : list S :=
  match p with [] => [] | a :: l => a :: elevated_after a l end.

Theorem elevated_form p s t : form (exacts (elevated p)) s t = (s + t) * form (exacts p) s t.
Proof.
  assert (H : forall l b, form (exacts (elevated_after b l)) s t =
    exact b * s ^ length l + (s + t) * form (exacts l) s t).
  { induction l as [| a l IH]; intros b; [simpl; ring |]. simpl. rewrite IH. exacts.
    rewrite !map_length.
    replace (length (elevated_after a l)) with (Datatypes.S (length l)); [simpl; ring |].
    clear. revert a. induction l as [| c l IH]; intros a; simpl; auto. }
  destruct p as [| a l]; simpl; [ring |]. rewrite H, !map_length.
  replace (length (elevated_after a l)) with (Datatypes.S (length l)); [simpl; ring |].
  clear. revert a. induction l as [| c l IH]; intros a; simpl; auto.
Qed.

(** derivative(p): (i + 1) p_(i+1) - (N - i) p_i; `n` is N - i. *)
Definition times (x : S) (n : nat) : S := if (n =? 1)%nat then x else mul x (whole (Z.of_nat n)).
Fixpoint derivative_from (i : nat) (p : list S) : list S :=
  match p with
  | a :: (b :: rest) as l => sub (times b (i + 1)) (times a (length l)) :: derivative_from (i + 1) l
  | _ => []
  end.
Definition derivative (p : list S) : list S := derivative_from 0 p.

Lemma exact_times x n : exact (times x n) = exact x * INR n.
Proof.
  unfold times. destruct (Nat.eqb_spec n 1) as [-> | N]; [simpl; ring |].
  exacts. now rewrite INR_IZR_INZ.
Qed.
Lemma length_derivative_from i p : length (derivative_from i p) = (length p - 1)%nat.
Proof.
  revert i. induction p as [| a [| b l] IH]; intros i; auto.
  change (derivative_from i (a :: b :: l))
    with (sub (times b (i + 1)) (times a (length (b :: l))) :: derivative_from (i + 1) (b :: l)).
  simpl length in *. rewrite IH. lia.
Qed.

Fixpoint slope (h : list R) (t : R) : R :=
  match h with
  | [] => 0
  | a :: l => a * - (INR (length l) * (1 - t) ^ pred (length l)) + (1 * form l (1 - t) t + t * slope l
    t)
  end.
Lemma derivable_form h t : derivable_pt_lim (fun t => form h (1 - t) t) t (slope h t).
Proof.
  induction h as [| a l IH]; simpl; [apply derivable_pt_lim_const |].
  apply (derivable_pt_lim_plus (fun t => a * (1 - t) ^ length l) (fun t => t * form l (1 - t) t)).
  - apply derivable_pt_lim_scal with (f := fun t => (1 - t) ^ length l).
    replace (- (INR (length l) * (1 - t) ^ pred (length l)))
      with ((INR (length l) * (1 - t) ^ pred (length l)) * (0 - 1)) by ring.
    apply derivable_pt_lim_comp with (f1 := fun t => 1 - t) (f2 := fun s => s ^ length l).
    + apply derivable_pt_lim_minus; [apply derivable_pt_lim_const | apply derivable_pt_lim_id].
    + apply derivable_pt_lim_pow.
  - apply (derivable_pt_lim_mult id (fun t => form l (1 - t) t)); [apply derivable_pt_lim_id | exact
      IH].
Qed.

Theorem derivative_form p t :
  derivable_pt_lim (at_time p) t (at_time (derivative p) t).
Proof.
  assert (H : forall p i, at_time (derivative_from i p) t =
    slope (exacts p) t + INR i * form (exacts (tl p)) (1 - t) t).
  { unfold at_time. induction p0 as [| a l IH]; intros i; [simpl; ring |].
    destruct l as [| b l]; [simpl; ring |].
    change (derivative_from i (a :: b :: l))
      with (sub (times b (i + 1)) (times a (length (b :: l))) :: derivative_from (i + 1) (b :: l)).
    cbn [map form slope]. rewrite IH. exacts. rewrite !exact_times, plus_INR.
    rewrite !map_length, length_derivative_from. simpl tl. simpl length.
    replace (Datatypes.S (length l) - 1)%nat with (length l) by lia.
    rewrite S_INR. change (map exact (b :: l)) with (exact b :: exacts l).
    cbn [form slope]. rewrite !map_length. simpl. ring. }
  unfold derivative. rewrite H. simpl. rewrite Rmult_0_l, Rplus_0_r. apply derivable_form.
Qed.

(** left_part(p, v, w): Horner's rule for s -> (v + w)s + vt, t -> wt; a step multiplies the part by
    that s and adds the next term. *)
Fixpoint shifted (all v before : S) (part : list S) (term : S) : list S :=
  match part with
  | [] => [add (mul before v) term]
  | a :: l => add (mul a all) (mul before v) :: shifted all v a l term
  end.
Definition next_part (all v : S) (part : list S) (term : S) : list S :=
  match part with [] => [term] | a :: l => mul a all :: shifted all v a l term end.
Fixpoint part_from (all v w : S) (part : list S) (power : S) (p : list S) : list S :=
  match p with
  | [] => part
  | a :: l =>
      let part := next_part all v part (mul a power) in
      match l with [] => part | _ => part_from all v w part (mul power w) l end
  end.
Definition left_part (p : list S) (v w : S) : list S :=
  match p with [] => [] | a :: l => part_from (add v w) v w [a] w l end.

(** left_half(p): left_part with v = w = 1, and doublings. *)
Fixpoint half_shifted (before : S) (part : list S) (term : S) : list S :=
  match part with
  | [] => [add before term]
  | a :: l => add (twice a) before :: half_shifted a l term
  end.
Definition next_half (part : list S) (term : S) : list S :=
  match part with [] => [term] | a :: l => twice a :: half_shifted a l term end.
Definition left_half (p : list S) : list S :=
  match p with [] => [] | a :: l => fold_left next_half l [a] end.

Lemma shifted_form all v part : forall before term s t,
  form (exacts (shifted all v before part term)) s t =
  exact before * exact v * s ^ length part + form (exacts part) s t * (exact all * s + exact v * t)
  + exact term * t ^ length part /\
  length (shifted all v before part term) = Datatypes.S (length part).
Proof.
  induction part as [| a l IH]; intros before term s t; simpl; exacts; [split; [ring | easy] |].
  destruct (IH a term s t) as (E & L). rewrite E, !map_length, L. split; [simpl; ring | easy].
Qed.
Lemma next_part_form all v a part term s t :
  form (exacts (next_part all v (a :: part) term)) s t =
  form (exacts (a :: part)) s t * (exact all * s + exact v * t) + exact term * t ^ length (a :: part) /\
  length (next_part all v (a :: part) term) = Datatypes.S (length (a :: part)).
Proof.
  simpl. destruct (shifted_form all v part a term s t) as (E & L).
  rewrite E, !map_length, L. exacts. split; [simpl; ring | easy].
Qed.

Theorem left_part_form p v w s t :
  form (exacts (left_part p v w)) s t =
  form (exacts p) ((exact v + exact w) * s + exact v * t) (exact w * t).
Proof.
  set (s' := (exact v + exact w) * s + exact v * t). set (t' := exact w * t).
  assert (H : forall l a part power,
    form (exacts (part_from (add v w) v w (a :: part) power l)) s t =
    form (exacts (a :: part)) s t * s' ^ length l
    + exact power * t ^ length (a :: part) * form (exacts l) s' t').
  { induction l as [| b l IH]; intros a part power; [simpl; ring |].
    cbn [part_from]. destruct (next_part_form (add v w) v a part (mul b power) s t) as (E & L).
    rewrite exact_add in E. fold s' in E. rewrite exact_mul in E.
    destruct l as [| c l].
    - rewrite E. simpl. ring.
    - destruct (next_part (add v w) v (a :: part) (mul b power)) as [| d next]; [discriminate |].
      rewrite IH, E, L, exact_mul.
      change (form (exacts (b :: c :: l)) s' t')
        with (exact b * s' ^ length (exacts (c :: l)) + t' * form (exacts (c :: l)) s' t').
      rewrite map_length. unfold t'.
      change (length (b :: c :: l)) with (Datatypes.S (length (c :: l))).
      rewrite <- !tech_pow_Rmult. ring. }
  destruct p as [| a l]; [easy |]. unfold left_part. rewrite H. simpl. rewrite map_length.
  unfold t'. ring.
Qed.

Theorem left_half_form p s t :
  form (exacts (left_half p)) s t = form (exacts p) (2 * s + t) t.
Proof.
  assert (Sh : forall part before term,
    form (exacts (half_shifted before part term)) s t =
    exact before * s ^ length part + form (exacts part) s t * (2 * s + t) + exact term * t ^ length part
      /\
    length (half_shifted before part term) = Datatypes.S (length part)).
  { induction part as [| a l IH]; intros before term; simpl; exacts; [split; [ring | easy] |].
    destruct (IH a term) as (E & L). rewrite E, !map_length, L. split; [simpl; ring | easy]. }
  assert (H : forall l a part,
    form (exacts (fold_left next_half l (a :: part))) s t =
    form (exacts (a :: part)) s t * (2 * s + t) ^ length l
    + t ^ length (a :: part) * form (exacts l) (2 * s + t) t).
  { induction l as [| b l IH]; intros a part; [simpl; ring |].
    cbn [fold_left]. destruct (Sh part a b) as (E & L).
    change (next_half (a :: part) b) with (twice a :: half_shifted a part b). rewrite IH.
    cbn [map form length]. rewrite E, !map_length, L, exact_twice. simpl. ring. }
  destruct p as [| a l]; [easy |]. unfold left_half. rewrite H. simpl. rewrite map_length. ring.
Qed.

(** reversed(p); split and halves. *)
Theorem reversed_form p s t : form (exacts (rev p)) s t = form (exacts p) t s.
Proof.
  assert (A : forall h a, form (h ++ [a]) s t = s * form h s t + a * t ^ length h).
  { induction h as [| b l IH]; intros a; simpl; [ring |].
    rewrite IH, app_length, Nat.add_comm. simpl. ring. }
  induction p as [| a l IH]; [easy |].
  simpl. rewrite map_app. simpl. rewrite A, IH, !map_length, rev_length. ring.
Qed.
Definition split (p : list S) (v w : S) : list S * list S :=
  (left_part p v w, rev (left_part (rev p) w v)).
Definition halves (p : list S) : list S * list S := (left_half p, rev (left_half (rev p))).

(** ** Conclusions from signs of coefficients *)

Fixpoint sign_inside_from (all : sign) (p : list S) : sign :=
  match p with
  | [] => all
  | a :: l =>
      match sign_of a, all with
      | uncertain, _ => uncertain
      | zero, _ => sign_inside_from all l
      | negative, negative => sign_inside_from all l
      | positive, positive => sign_inside_from all l
      | s, zero => sign_inside_from s l
      | _, _ => uncertain
      end
  end.
Definition sign_inside (p : list S) : sign := sign_inside_from zero p.

Definition same_sign (a b : sign) : bool :=
  match a, b with
  | negative, negative | zero, zero | positive, positive | uncertain, uncertain => true
  | _, _ => false
  end.
(** sign_of_0 is sign_of(p_0). *)
Definition sign_throughout (p : list S) : sign :=
  match p with
  | [] => uncertain
  | a :: l => if forallb (fun b => same_sign (sign_of b) (sign_of a)) l then sign_of a else uncertain
  end.
Definition certainly_rootless (p : list S) : bool :=
  match sign_throughout p with positive | negative => true | _ => false end.

(** The meaning of the result of sign_inside for the coefficients. *)
Definition signs_inside (s : sign) (h : list R) : Prop :=
  match s with
  | negative => Forall (Rle 0) (map Ropp h) /\ Exists (Rlt 0) (map Ropp h)
  | zero => Forall (eq 0) h
  | positive => Forall (Rle 0) h /\ Exists (Rlt 0) h
  | uncertain => True
  end.
Lemma sign_inside_coefficients p : signs_inside (sign_inside p) (exacts p).
Proof.
  assert (H : forall p all,
    match sign_inside_from all p with
    | negative => (all = negative \/ all = zero /\ Exists (Rlt 0) (map Ropp (exacts p)))
                  /\ Forall (Rle 0) (map Ropp (exacts p))
    | zero => all = zero /\ Forall (eq 0) (exacts p)
    | positive => (all = positive \/ all = zero /\ Exists (Rlt 0) (exacts p)) /\ Forall (Rle 0) (exacts
      p)
    | uncertain => True
    end).
  { clear p. induction p as [| a l IH]; intros all; simpl; [destruct all; auto |].
    pose proof (sign_right S a) as A. destruct (sign_of a), all; simpl in A; auto;
      match goal with |- context [sign_inside_from ?x l] => specialize (IH x); destruct
        (sign_inside_from x l) end;
      intuition (try discriminate; try (constructor; auto; lra); auto).
    all: try (right; split; [easy | constructor 1; lra]).
    all: try (right; split; [easy | now constructor 2]). }
  specialize (H p zero). unfold sign_inside. destruct (sign_inside_from zero p); simpl in *;
    intuition (try discriminate; auto).
Qed.

Theorem sign_inside_right p t : 0 < t < 1 -> sign_is_right (sign_inside p) (at_time p t).
Proof.
  intros T. unfold at_time. pose proof (sign_inside_coefficients p) as H.
  destruct (sign_inside p); simpl in *; auto.
  - destruct H as (F & E). pose proof (hull_inside _ (1 - t) t F E) as P. rewrite form_opp in P. lra.
  - induction H as [| a l <- F IH]; simpl; [easy |]. rewrite IH. ring.
  - destruct H. apply hull_inside; auto; lra.
Qed.

Lemma sign_throughout_coefficients p :
  match sign_throughout p with
  | negative => Forall (Rlt 0) (map Ropp (exacts p)) /\ p <> []
  | zero => Forall (eq 0) (exacts p)
  | positive => Forall (Rlt 0) (exacts p) /\ p <> []
  | uncertain => True
  end.
Proof.
  destruct p as [| a l]; simpl; auto. pose proof (sign_right S a) as A.
  destruct (forallb _ l) eqn:F; auto. rewrite forallb_forall in F.
  assert (H : forall b, In b l -> sign_is_right (sign_of a) (exact b)).
  { intros b I. specialize (F b I). pose proof (sign_right S b) as B.
    destruct (sign_of b), (sign_of a); simpl in *; auto; discriminate. }
  destruct (sign_of a); simpl in *; auto; repeat split; try discriminate;
    constructor; try (simpl in A; lra); repeat rewrite Forall_map; apply Forall_forall; intros b I;
    specialize (H b I); simpl in H; lra.
Qed.

Theorem sign_throughout_right p t : 0 <= t <= 1 -> sign_is_right (sign_throughout p) (at_time p t).
Proof.
  intros T. unfold at_time. pose proof (sign_throughout_coefficients p) as H.
  destruct (sign_throughout p); cbn [sign_is_right]; auto.
  - destruct H as (F & N). destruct p as [| a l]; [easy |].
    pose proof (hull_positive (- exact a) (map Ropp (exacts l)) (1 - t) t F) as P.
    change (- exact a :: map Ropp (exacts l)) with (map Ropp (exacts (a :: l))) in P.
    rewrite form_opp in P. lra.
  - induction H as [| a l <- F IH]; simpl; [easy |]. rewrite IH. ring.
  - destruct H as (F & N). destruct p as [| a l]; [easy |]. apply (hull_positive _ _ (1 - t) t F); lra.
Qed.

Theorem rootless_hull p t : certainly_rootless p = true -> 0 <= t <= 1 -> at_time p t <> 0.
Proof.
  unfold certainly_rootless. intros C T. pose proof (sign_throughout_right p t T) as H.
  destruct (sign_throughout p); try discriminate; simpl in H; lra.
Qed.

End Code.
