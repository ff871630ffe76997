(** Bound rule `affine` (include/errbound/rules/affine.hpp), as the C++ code computes it. Rounding is to nearest,
    ties to even, with at least 4 bits, and u is a number (emin <= -p-1). Results:
        affine_exact_sound, affine_within_sound, affine_negate_sound, affine_add_sound, affine_subtract_sound,
        affine_multiply_sound, affine_divide_sound, affine_scale_sound   the bound that the code returns holds
        affine_keeps         bounds still hold when a source is new
        affine_error_sound   the error that the code reports is a bound

    A source s has a number e s of size at most 1. A number x has a value v, terms, a rest and a radius: |x - v - sum
    of c (e s) over the terms| <= rest and |x - v| <= radius. An operation has a new source f for its own error. The
    theorems prove that a number of f exists for which the result is right. Without sources (None) that error goes to
    the rest. *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool List.
From Flocq Require Import Core.
From Errbound Require Import Format ErrorFree Upper.
From Errbound Require Residual.
Import ListNotations.
Open Scope R_scope.

Section Affine.

Context (p emin : Z) {p_positive : Prec_gt_0 p}.

Notation fl := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).
Notation upper := (upper p emin).
Notation half_ulp := (Residual.half_ulp p emin).

(** The code, in its order of evaluation. *)
Definition terms : Set := list (Z * R).
Definition upper_sum (x y : R) : R :=
  if Req_bool x 0 then y else if Req_bool y 0 then x else upper (fl (x + y)).
Definition upper_product (x y : R) : R :=
  if Req_bool x 0 || Req_bool y 0 then 0 else fl (upper (fl (x * y)) + eta).
Definition upper_quotient (x y : R) : R :=
  if Req_bool x 0 then 0 else fl (upper (fl (x / y)) + eta).

(** The error that is left so far, and the terms in order. *)
Definition builder : Set := R * terms.
Definition nothing : builder := (0, []).
Definition add (s : Z) (c : R) (B : builder) : builder :=
  if Req_bool c 0 then B else (fst B, snd B ++ [(s, c)]).
Definition add_left (x : R) (B : builder) : builder := (upper_sum (fst B) x, snd B).
Definition radius_of (B : builder) : R :=
  fold_left (fun r (t : Z * R) => upper_sum r (Rabs (snd t))) (snd B) 0.
(** The first of the smallest terms, and the others. *)
Fixpoint least (t : Z * R) (l : terms) : (Z * R) * terms :=
  match l with
  | [] => (t, [])
  | x :: l' => let (m, r) := least x l' in if Rlt_bool (Rabs (snd m)) (Rabs (snd t)) then (m, t :: r) else (t, l)
  end.
Fixpoint shorten (limit fuel : nat) (B : builder) : builder :=
  match fuel, snd B with
  | S n, t :: l =>
    if (limit <=? length (snd B))%nat then
      let (m, r) := least t l in shorten limit n (add_left (Rabs (snd m)) (fst B, r))
    else B
  | _, _ => B
  end.
(** The search for the position starts at the last term. *)
Fixpoint placed (t : Z * R) (l : terms) : terms :=
  match l with
  | [] => [t]
  | x :: l' => if (fst t <? fst x)%Z then x :: placed t l' else t :: l
  end.
Record bound : Set := { radius : R; rest : R; of : terms }.
Definition finished (limit : nat) (B : builder) (f : option Z) : bound :=
  let all := upper_sum (radius_of B) (fst B) in
  let room := if Req_bool (fst B) 0 then limit else Nat.pred limit in
  let B := if (room <? length (snd B))%nat then shorten limit (length (snd B)) B else B in
  if Req_bool (fst B) 0 then {| radius := all; rest := 0; of := snd B |}
  else
    match f with
    | Some f => {| radius := all; rest := 0; of := rev (placed (f, fst B) (rev (snd B))) |}
    | None => {| radius := all; rest := fst B; of := snd B |}
    end.
(** The terms of two numbers, by ascending source. *)
Fixpoint merged (a : terms) : terms -> list (Z * (R * R)) :=
  fix with_a (b : terms) :=
    match a, b with
    | [], [] => []
    | [], (t, y) :: b' => (t, (0, y)) :: with_a b'
    | (s, x) :: a', [] => (s, (x, 0)) :: merged a' []
    | (s, x) :: a', (t, y) :: b' =>
      if (s <? t)%Z then (s, (x, 0)) :: merged a' b
      else if (t <? s)%Z then (t, (0, y)) :: with_a b'
      else (s, (x, y)) :: merged a' b'
    end.

Definition affine_exact : bound := {| radius := 0; rest := 0; of := [] |}.
Definition affine_within limit (error : R) f : bound := finished limit (add_left error nothing) f.
Definition negated (b : bound) : bound :=
  {| radius := radius b; rest := rest b; of := map (fun t => (fst t, - snd t)) (of b) |}.
Definition sum_step (B : builder) (t : Z * (R * R)) : builder :=
  let c := two_sum p emin (fst (snd t)) (snd (snd t)) in
  add_left (Rabs (snd c)) (add (fst t) (fst c) B).
Definition affine_add limit (a : R) (A : bound) (b : R) (B : bound) f : bound :=
  let r := add_left (Rabs (snd (two_sum p emin a b))) nothing in
  let r := fold_left sum_step (merged (of A) (of B)) r in
  finished limit (add_left (rest B) (add_left (rest A) r)) f.
Definition affine_subtract limit (a : R) (A : bound) (b : R) (B : bound) f : bound :=
  affine_add limit a A (- b) (negated B) f.
Definition is_zero (a : R) (A : bound) : bool := Req_bool a 0 && Req_bool (radius A) 0.
Definition product_step (a b : R) (r : builder) (t : Z * (R * R)) : builder :=
  let x := fl (a * snd (snd t)) in
  let y := fl (fst (snd t) * b) in
  let c := two_sum p emin x y in
  let r := add (fst t) (fst c) r in
  let r := if Req_bool (snd (snd t)) 0 || Req_bool a 0 then r else add_left (half_ulp x) r in
  let r := if Req_bool (fst (snd t)) 0 || Req_bool b 0 then r else add_left (half_ulp y) r in
  add_left (Rabs (snd c)) r.
(** `known` is the product's rounding error, if the transformations of error_free.hpp give it. *)
Definition affine_multiply limit (v a : R) (A : bound) (b : R) (B : bound) (known : option R) f : bound :=
  if is_zero a A || is_zero b B then affine_exact
  else
    let r := add_left (match known with Some e => Rabs e | None => half_ulp v end) nothing in
    let r := fold_left (product_step a b) (merged (of A) (of B)) r in
    let r := add_left (upper_product (Rabs a) (rest B)) r in
    let r := add_left (upper_product (rest A) (Rabs b)) r in
    finished limit (add_left (upper_product (radius A) (radius B)) r) f.
(** A pair of terms: the rest of the numerator's term, and the builder. *)
Definition quotient_step (v b : R) (r : R * builder) (t : Z * (R * R)) : R * builder :=
  let x := fl (v * snd (snd t)) in
  let n := two_sum p emin (fst (snd t)) (- x) in
  let left := upper_sum (fst r) (Rabs (snd n)) in
  let left := if Req_bool (snd (snd t)) 0 then left else upper_sum left (half_ulp x) in
  let c := fl (fst n / b) in
  let r := add (fst t) c (snd r) in
  (left, if Req_bool (fst n) 0 then r else add_left (half_ulp c) r).
(** `known` is the remainder, if it is exact. *)
Definition affine_divide limit (v a : R) (A : bound) (b : R) (B : bound) (known : option R) f :
  option bound :=
  let distance := fl (fl (Rabs b - radius B) * fl (1 - eps)) in
  if negb (Rlt_bool 0 distance) then None
  else if is_zero a A then Some affine_exact
  else
    let r := match known with Some _ => nothing | None => add_left (half_ulp v) nothing end in
    let left := upper_sum (upper_product (Rabs v) (rest B)) (rest A) in
    let left := match known with Some r => upper_sum left (Rabs r) | None => left end in
    let (left, r) := fold_left (quotient_step v b) (merged (of A) (of B)) (left, r) in
    let r := add_left (upper_quotient left (Rabs b)) r in
    let quotient := upper_sum (radius_of r) (fst r) in
    let r := if Rlt_bool 0 (radius B)
             then add_left (upper_quotient (upper_product quotient (radius B)) distance) r else r in
    Some (finished limit r f).
Definition lost (scaled x : R) (e : Z) : R :=
  if (0 <=? e)%Z || Req_bool (fl (scaled * bpow radix2 (- e))) x then 0 else eta.
Definition scale_step (e : Z) (r : builder) (t : Z * R) : builder :=
  let c := fl (snd t * bpow radix2 e) in
  add_left (lost c (snd t) e) (add (fst t) c r).
Definition affine_scale limit (v a : R) (A : bound) (e : Z) f : bound :=
  let r := add_left (lost v a e) nothing in
  let r := fold_left (scale_step e) (of A) r in
  let scaled := fl (rest A * bpow radix2 e) in
  finished limit (add_left (lost scaled (rest A) e) (add_left scaled r)) f.

(** The meaning of a number's value and bound for x, with the numbers e of the sources. *)
Definition sum_of (e : Z -> R) (l : terms) : R := fold_right (fun t s => snd t * e (fst t) + s) 0 l.
Definition holds (e : Z -> R) (v : R) (A : bound) (x : R) : Prop :=
  number v /\ Forall (fun t => number (snd t)) (of A) /\
  (number (rest A) /\ 0 <= rest A /\ Rabs (x - v - sum_of e (of A)) <= rest A) /\
  (number (radius A) /\ 0 <= radius A /\ Rabs (x - v) <= radius A).
Definition units (e : Z -> R) : Prop := forall s, Rabs (e s) <= 1.
Definition set (e : Z -> R) (f : Z) (t : R) : Z -> R := fun s => if (s =? f)%Z then t else e s.
(** f is not a source of these terms. *)
Definition is_new (f : Z) (A : bound) : Prop := Forall (fun t => fst t <> f) (of A).

Context (p_4 : (4 <= p)%Z) (emin_p : (emin <= - p - 1)%Z).

Lemma number_fl x : number (fl x).
Proof. apply rnd_number; auto with typeclass_instances. Qed.
Lemma fl_nonnegative x : 0 <= x -> 0 <= fl x.
Proof. apply rnd_nonnegative; auto with typeclass_instances. Qed.

Lemma upper_nonnegative x : number x -> 0 <= x -> 0 <= upper x.
Proof. intros N P. apply Rle_trans with x; auto. apply upper_le; auto; lia. Qed.
Definition amount (x : R) : Prop := number x /\ 0 <= x.
Lemma amount_0 : amount 0.
Proof. split; [apply number_0 | lra]. Qed.
Lemma amount_abs x : number x -> amount (Rabs x).
Proof. split; [now apply number_abs | apply Rabs_pos]. Qed.
Lemma amount_half_ulp v : amount (half_ulp v).
Proof.
  split; [exact (Residual.half_ulp_number p emin v) |].
  exact (Residual.half_ulp_nonnegative p emin ltac:(lia) v).
Qed.
Lemma upper_sum_sound x y : amount x -> amount y -> amount (upper_sum x y) /\ x + y <= upper_sum x y.
Proof.
  intros [NX X] [NY Y]. unfold upper_sum.
  case Req_bool_spec; intros H; [split; [split |]; auto; lra |].
  case Req_bool_spec; intros H'; [split; [split |]; auto; lra |].
  split; [| apply upper_covers_sum; auto; lia || lra].
  split; [apply upper_number; auto |]. apply upper_nonnegative; [apply number_fl | apply fl_nonnegative; lra].
Qed.
Lemma up_eta_sound z : 0 <= z -> amount (fl (upper (fl z) + eta)) /\ z <= fl (upper (fl z) + eta).
Proof.
  intros P. assert (H := upper_eta_covers p emin ltac:(lia) ltac:(lia) z P).
  split; [split; [apply number_fl | lra] | exact H].
Qed.
Lemma upper_product_sound x y : 0 <= x -> 0 <= y -> amount (upper_product x y) /\ x * y <= upper_product x y.
Proof.
  intros X Y. unfold upper_product. case_eq (Req_bool x 0 || Req_bool y 0).
  - intros H. split; [apply amount_0 |]. apply orb_prop in H.
    destruct H as [H | H]; revert H; (case Req_bool_spec; [| discriminate]); intros ->; lra.
  - intros _. apply up_eta_sound. now apply Rmult_le_pos.
Qed.
Lemma upper_quotient_sound x y : 0 <= x -> 0 < y -> amount (upper_quotient x y) /\ x / y <= upper_quotient x y.
Proof.
  intros X Y. unfold upper_quotient. case Req_bool_spec; intros H.
  - split; [apply amount_0 |]. rewrite H. unfold Rdiv. lra.
  - apply up_eta_sound. unfold Rdiv. apply Rmult_le_pos; auto. left. now apply Rinv_0_lt_compat.
Qed.

(** The builder's terms and rest give d, except for what is left. Its terms have sources other than f. *)
Definition accounts (e : Z -> R) (f : Z) (d : R) (B : builder) : Prop :=
  amount (fst B) /\ Forall (fun t => fst t <> f /\ number (snd t)) (snd B) /\
  Rabs (d - sum_of e (snd B)) <= fst B.

Lemma sum_of_app e k l : sum_of e (k ++ l) = sum_of e k + sum_of e l.
Proof. induction k as [| t k IH]; simpl; [ring |]. rewrite IH. ring. Qed.
Lemma sum_of_rev e l : sum_of e (rev l) = sum_of e l.
Proof. induction l as [| t l IH]; simpl; auto. rewrite sum_of_app, IH. simpl. ring. Qed.
Lemma sum_of_set e f t l : Forall (fun t => fst t <> f) l -> sum_of (set e f t) l = sum_of e l.
Proof.
  induction 1 as [| x l H _ IH]; simpl; auto. rewrite IH. unfold set.
  destruct (Z.eqb_spec (fst x) f); [contradiction | reflexivity].
Qed.
Lemma sum_of_opp e l : sum_of e (map (fun t => (fst t, - snd t)) l) = - sum_of e l.
Proof. induction l as [| t l IH]; simpl; [ring |]. rewrite IH. ring. Qed.

Lemma accounts_nothing e f : accounts e f 0 nothing.
Proof.
  split; [apply amount_0 |]. split; [constructor |]. simpl. rewrite Rminus_0_r, Rabs_R0. lra.
Qed.
Lemma accounts_add e f d B s c : accounts e f d B -> s <> f -> number c ->
  accounts e f (d + c * e s) (add s c B).
Proof.
  intros (A & F & H) S C. unfold add. case Req_bool_spec; intros Z.
  - split; auto. split; auto. rewrite Z. now replace (d + 0 * e s) with d by ring.
  - split; auto. split.
    + simpl. apply Forall_app. split; auto.
    + simpl. rewrite sum_of_app. simpl.
      now replace (d + c * e s - (sum_of e (snd B) + (c * e s + 0))) with (d - sum_of e (snd B)) by ring.
Qed.
Lemma accounts_add_left e f d B x t : accounts e f d B -> amount x -> Rabs t <= x ->
  accounts e f (d + t) (add_left x B).
Proof.
  intros (A & F & H) X T. destruct (upper_sum_sound (fst B) x A X) as [A' S].
  split; [exact A' |]. split; auto. simpl.
  replace (d + t - sum_of e (snd B)) with ((d - sum_of e (snd B)) + t) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.
Lemma accounts_eq e f d d' B : accounts e f d B -> d = d' -> accounts e f d' B.
Proof. now intros H <-. Qed.

Section Operation.

Context (e : Z -> R) (f : Z) (e_units : units e).
Notation accounts := (accounts e f).

Lemma fold_sum l r : Forall (fun t : Z * R => number (snd t)) l -> amount r ->
  amount (fold_left (fun r (t : Z * R) => upper_sum r (Rabs (snd t))) l r) /\
  r + Rabs (sum_of e l) <= fold_left (fun r (t : Z * R) => upper_sum r (Rabs (snd t))) l r.
Proof.
  revert r. induction l as [| t l IH]; intros r F A.
  - simpl. rewrite Rabs_R0. split; auto. lra.
  - inversion F as [| ? ? N F']. subst. simpl.
    destruct (upper_sum_sound r (Rabs (snd t)) A (amount_abs _ N)) as [A' S].
    destruct (IH _ F' A') as [A2 S2]. split; auto.
    assert (Rabs (snd t * e (fst t)) <= Rabs (snd t)).
    { rewrite Rabs_mult. rewrite <- (Rmult_1_r (Rabs (snd t))) at 2.
      apply Rmult_le_compat_l; [apply Rabs_pos | apply e_units]. }
    generalize (Rabs_triang (snd t * e (fst t)) (sum_of e l)). lra.
Qed.
Lemma numbers_of l : Forall (fun t : Z * R => fst t <> f /\ number (snd t)) l ->
  Forall (fun t => number (snd t)) l /\ Forall (fun t => fst t <> f) l.
Proof. intros F. split; apply Forall_impl with (2 := F); tauto. Qed.
Lemma radius_sound B d : accounts d B -> amount (upper_sum (radius_of B) (fst B)) /\
  Rabs d <= upper_sum (radius_of B) (fst B).
Proof.
  intros (A & F & H). destruct (numbers_of _ F) as [N _].
  destruct (fold_sum (snd B) 0 N amount_0) as [A' S]. fold (radius_of B) in A', S.
  destruct (upper_sum_sound _ _ A' A) as [A2 S2]. split; auto.
  replace d with ((d - sum_of e (snd B)) + sum_of e (snd B)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.

Lemma least_terms_sound t l : let (m, r) := least t l in
  sum_of e (t :: l) = snd m * e (fst m) + sum_of e r /\
  forall P : Z * R -> Prop, P t -> Forall P l -> P m /\ Forall P r.
Proof.
  revert t. induction l as [| x l IH]; intros t; simpl.
  - split; [ring | auto].
  - specialize (IH x). destruct (least x l) as [m r]. destruct IH as [E F].
    case Rlt_bool_spec; intros _; [| now split; [| intros P T H]].
    split.
    + simpl in *. rewrite E. ring.
    + intros P T H. inversion H. subst. destruct (F P); auto.
Qed.
Lemma shorten_sound limit fuel B d : accounts d B -> accounts d (shorten limit fuel B).
Proof.
  revert B. induction fuel as [| n IH]; intros B A; auto. simpl.
  destruct (snd B) as [| t l] eqn:E; auto.
  destruct (limit <=? length (t :: l))%nat; auto.
  assert (L := least_terms_sound t l). destruct (least t l) as [m r]. destruct L as [S F].
  apply IH. destruct A as (A & N & H). rewrite E in N, H.
  inversion N as [| ? ? Nt Nl]. subst. destruct (F _ Nt Nl) as [Nm Nr].
  apply accounts_eq with ((d - snd m * e (fst m)) + snd m * e (fst m)); [| ring].
  apply accounts_add_left.
  - split; auto. split; auto. simpl. rewrite S in H.
    now replace (d - snd m * e (fst m) - sum_of e r) with (d - (snd m * e (fst m) + sum_of e r)) by ring.
  - apply amount_abs. tauto.
  - rewrite Rabs_mult. rewrite <- (Rmult_1_r (Rabs (snd m))) at 2.
    apply Rmult_le_compat_l; [apply Rabs_pos | apply e_units].
Qed.
Lemma placed_sound t l e' : sum_of e' (placed t l) = snd t * e' (fst t) + sum_of e' l /\
  forall P : Z * R -> Prop, P t -> Forall P l -> Forall P (placed t l).
Proof.
  induction l as [| x l [IH F]]; simpl; [split; [ring | auto] |].
  destruct (fst t <? fst x)%Z.
  - split; [simpl; rewrite IH; ring |]. intros P T H. inversion H. subst. auto.
  - split; [simpl; ring |]. intros P T H. inversion H. subst. auto.
Qed.

(** The result holds with some number of f, or without sources. *)
Definition made (v : R) (A : bound) (x : R) (g : option Z) : Prop :=
  match g with
  | Some g => g = f /\ exists t, Rabs t <= 1 /\ holds (set e f t) v A x
  | None => holds e v A x
  end.
Lemma finished_sound limit B v x g : number v -> accounts (x - v) B -> g = Some f \/ g = None ->
  made v (finished limit B g) x g.
Proof.
  intros V A G. destruct (radius_sound B _ A) as [RA RS]. unfold finished.
  set (all := upper_sum (radius_of B) (fst B)) in *.
  set (room := if Req_bool (fst B) 0 then limit else Nat.pred limit).
  set (C := if (room <? length (snd B))%nat then shorten limit (length (snd B)) B else B).
  assert (AC : accounts (x - v) C).
  { unfold C. destruct (room <? length (snd B))%nat; auto. now apply shorten_sound. }
  cbv zeta. fold C. destruct AC as ([NL PL] & F & H). destruct (numbers_of _ F) as [N S].
  destruct RA as [NA PA].
  case Req_bool_spec; intros Z.
  - assert (E : forall t, holds (set e f t) v {| radius := all; rest := 0; of := snd C |} x).
    { intros t. split; auto. split; auto. split; [| split; auto].
      simpl. rewrite sum_of_set by auto. rewrite Z in H. split; [apply number_0 | split; [lra | exact H]]. }
    destruct G as [-> | ->]; simpl.
    + split; auto. exists 0. rewrite Rabs_R0. split; [lra | apply E].
    + split; auto. split; auto. split; [| split; auto]. simpl. rewrite Z in H.
      split; [apply number_0 | split; [lra | exact H]].
  - destruct G as [-> | ->]; simpl.
    + split; auto. exists ((x - v - sum_of e (snd C)) / fst C). split.
      { unfold Rdiv. rewrite Rabs_mult, Rabs_inv, (Rabs_pos_eq (fst C)) by auto.
        apply Rmult_le_reg_r with (fst C); [lra |]. rewrite Rmult_assoc, Rinv_l, !Rmult_1_r, Rmult_1_l by auto.
        exact H. }
      set (t := (x - v - sum_of e (snd C)) / fst C).
      destruct (placed_sound (f, fst C) (rev (snd C)) (set e f t)) as [P Q].
      split; auto. split.
      { simpl. apply Forall_rev, Q; [exact NL |]. now apply Forall_rev. }
      split; [| split; auto]. simpl. rewrite sum_of_rev, P, sum_of_rev, sum_of_set by auto.
      split; [apply number_0 |]. split; [lra |]. simpl. unfold set at 1. rewrite Z.eqb_refl.
      replace (x - v - (fst C * t + sum_of e (snd C))) with 0 by (unfold t; field; exact Z).
      rewrite Rabs_R0. lra.
    + repeat split; auto.
Qed.

Lemma merged_sound a b : (forall x y, sum_of e (map (fun t : Z * (R * R) => (fst t, x * fst (snd t) + y * snd (snd t))) (merged a b)) =
    x * sum_of e a + y * sum_of e b) /\
  forall P : Z * R -> Prop, (forall s, P (s, 0)) -> Forall P a -> Forall P b ->
    Forall (fun t => P (fst t, fst (snd t)) /\ P (fst t, snd (snd t))) (merged a b).
Proof.
  revert b. induction a as [| [s x] a IHa].
  - induction b as [| [t y] b [IH F]].
    + split; [intros; simpl; ring | constructor].
    + split.
      * intros. simpl. simpl in IH. rewrite IH. ring.
      * intros P P0 Fa Fb. inversion Fb. subst. constructor; [simpl; auto |]. now apply F.
  - induction b as [| [t y] b [IH F]].
    + split.
      * intros. simpl. destruct (IHa []) as [E _]. rewrite E. simpl. ring.
      * intros P P0 Fa Fb. inversion Fa. subst. constructor; [simpl; auto |]. now apply IHa.
    + cbn [merged]. destruct (Z.ltb_spec s t); [| destruct (Z.ltb_spec t s)].
      * split.
        -- intros. cbn [map sum_of fold_right fst snd]. destruct (IHa ((t, y) :: b)) as [E _].
           unfold sum_of in E. rewrite E. simpl. ring.
        -- intros P P0 Fa Fb. inversion Fa. subst. constructor; [simpl; auto |]. now apply IHa.
      * split.
        -- intros. cbn [map sum_of fold_right fst snd]. unfold sum_of in IH. rewrite IH. simpl. ring.
        -- intros P P0 Fa Fb. inversion Fb. subst. constructor; [simpl; auto |]. now apply F.
      * assert (s = t) as -> by lia. split.
        -- intros. cbn [map sum_of fold_right fst snd]. destruct (IHa b) as [E _].
           unfold sum_of in E. rewrite E. simpl. ring.
        -- intros P P0 Fa Fb. inversion Fa. inversion Fb. subst. constructor; [simpl; auto |]. now apply IHa.
Qed.

Definition weighed (x y : R) (l : list (Z * (R * R))) : terms :=
  map (fun t => (fst t, x * fst (snd t) + y * snd (snd t))) l.
Definition fit (t : Z * (R * R)) : Prop :=
  fst t <> f /\ number (fst (snd t)) /\ number (snd (snd t)).
Lemma fold_step (step : builder -> Z * (R * R) -> builder) x y :
  (forall B d t, fit t -> accounts d B ->
     accounts (d + (x * fst (snd t) + y * snd (snd t)) * e (fst t)) (step B t)) ->
  forall l B d, Forall fit l -> accounts d B ->
    accounts (d + sum_of e (weighed x y l)) (fold_left step l B).
Proof.
  intros S. induction l as [| t l IH]; intros B d F A.
  - simpl. apply accounts_eq with d; auto. ring.
  - inversion F. subst. simpl. eapply accounts_eq; [apply IH; [auto |]; apply S; eauto |]. simpl. ring.
Qed.

(** Hypotheses on two operands. *)
Context (a x b y : R) (A B : bound) (of_a : holds e a A x) (of_b : holds e b B y) (new_a : is_new f A)
  (new_b : is_new f B) (limit : nat) (g : option Z) (g_f : g = Some f \/ g = None).

Lemma merged_fit : Forall fit (merged (of A) (of B)).
Proof.
  destruct of_a as (_ & NA & _), of_b as (_ & NB & _).
  destruct (merged_sound (of A) (of B)) as [_ F]. unfold is_new in *.
  assert (F1 := F (fun t => number (snd t)) (fun _ => number_0 p emin) NA NB).
  assert (F2 : Forall (fun t => fst t <> f) (merged (of A) (of B))).
  { clear - new_a new_b. generalize (of A) (of B) new_a new_b. clear. intros k l.
    revert l. induction k as [| [s x] k IHk].
    - induction l as [| [t y] l IH]; intros K L; [constructor |]. inversion L. subst.
      constructor; auto.
    - induction l as [| [t y] l IH]; intros K L.
      + inversion K. subst. constructor; auto.
      + inversion K. inversion L. subst. cbn [merged].
        destruct (s <? t)%Z; [| destruct (t <? s)%Z]; constructor; simpl; auto. }
  apply Forall_forall. intros t T.
  assert (T1 := proj1 (Forall_forall _ _) F1 t T). assert (T2 := proj1 (Forall_forall _ _) F2 t T).
  simpl in T1. split; tauto.
Qed.
Lemma emin_negative : (emin < 0)%Z.
Proof. lia. Qed.
Lemma two_sum_numbers s t : number (fst (two_sum p emin s t)) /\ number (snd (two_sum p emin s t)).
Proof. split; apply number_fl. Qed.

Lemma sum_step_sound r d t : fit t -> accounts d r ->
  accounts (d + (1 * fst (snd t) + 1 * snd (snd t)) * e (fst t)) (sum_step r t).
Proof.
  intros (F & N1 & N2) H. unfold sum_step.
  destruct (two_sum_numbers (fst (snd t)) (snd (snd t))) as [S1 S2].
  assert (E := two_sum_exact p emin emin_negative (fst (snd t)) (snd (snd t)) ltac:(lia) N1 N2).
  set (c := two_sum p emin (fst (snd t)) (snd (snd t))) in *.
  apply accounts_eq with (d + fst c * e (fst t) + snd c * e (fst t)).
  - apply accounts_add_left; [now apply accounts_add | now apply amount_abs |].
    rewrite Rabs_mult. rewrite <- (Rmult_1_r (Rabs (snd c))) at 2.
    apply Rmult_le_compat_l; [apply Rabs_pos | apply e_units].
  - replace (1 * fst (snd t) + 1 * snd (snd t)) with (fst c + snd c) by lra. ring.
Qed.
Theorem affine_add_sound : made (fl (a + b)) (affine_add limit a A b B g) (x + y) g.
Proof.
  assert (F := merged_fit). destruct of_a as (Na & NA & (RA1 & RA2 & RA) & _).
  destruct of_b as (Nb & NB & (RB1 & RB2 & RB) & _). unfold affine_add.
  apply finished_sound; auto; [apply number_fl |].
  assert (E := two_sum_exact p emin emin_negative a b ltac:(lia) Na Nb).
  change (fst (two_sum p emin a b)) with (fl (a + b)) in E.
  destruct (two_sum_numbers a b) as [_ S2].
  set (SA := sum_of e (of A)) in *. set (SB := sum_of e (of B)) in *.
  eapply accounts_eq.
  - apply accounts_add_left with (t := y - b - SB); [| split; auto | exact RB].
    apply accounts_add_left with (t := x - a - SA); [| split; auto | exact RA].
    apply (fold_step sum_step 1 1 sum_step_sound); [exact F |].
    apply accounts_add_left with (t := snd (two_sum p emin a b));
      [apply accounts_nothing | now apply amount_abs | apply Rle_refl].
  - destruct (merged_sound (of A) (of B)) as [M _]. unfold weighed. rewrite M. fold SA SB.
    replace (snd (two_sum p emin a b)) with (a + b - fl (a + b)) by lra. ring.
Qed.

Lemma is_zero_sound v C z : holds e v C z -> is_zero v C = true -> v = 0 /\ z = 0.
Proof.
  intros (_ & _ & _ & (_ & _ & H)) I. unfold is_zero in I. apply andb_prop in I. destruct I as [I1 I2].
  revert I1 I2. case Req_bool_spec; [| discriminate]. intros -> _.
  case Req_bool_spec; [| discriminate]. intros R _. split; auto. rewrite R in H. apply Rabs_le_inv in H. lra.
Qed.
Lemma zero_made : made 0 affine_exact 0 g.
Proof.
  assert (E : forall e, holds e 0 affine_exact 0).
  { intros e'. unfold affine_exact.
    repeat split; simpl; auto using number_0; try lra; rewrite ?Rminus_0_r, Rabs_R0; lra. }
  destruct g_f as [-> | ->]; simpl; auto. split; auto. exists 0. rewrite Rabs_R0. split; auto. lra.
Qed.

Lemma fl_error z : Rabs (z - fl z) <= half_ulp (fl z).
Proof. rewrite Rabs_minus_sym. exact (Residual.half_ulp_above p emin ltac:(lia) z). Qed.
Lemma times_unit c s : Rabs (c * e s) <= Rabs c.
Proof.
  rewrite Rabs_mult. rewrite <- (Rmult_1_r (Rabs c)) at 2.
  apply Rmult_le_compat_l; [apply Rabs_pos | apply e_units].
Qed.

Lemma product_step_sound r d t : fit t -> accounts d r ->
  accounts (d + (b * fst (snd t) + a * snd (snd t)) * e (fst t)) (product_step a b r t).
Proof.
  intros (F & N1 & N2) H. unfold product_step.
  set (s := fl (a * snd (snd t))). set (u := fl (fst (snd t) * b)).
  destruct (two_sum_numbers s u) as [S1 S2].
  assert (E := two_sum_exact p emin emin_negative s u ltac:(lia) (number_fl _) (number_fl _)).
  set (c := two_sum p emin s u) in *.
  apply accounts_eq with (d + fst c * e (fst t) + (a * snd (snd t) - s) * e (fst t) +
    (fst (snd t) * b - u) * e (fst t) + snd c * e (fst t)).
  - apply accounts_add_left; [| now apply amount_abs | apply times_unit].
    assert (H1 : accounts (d + fst c * e (fst t)) (add (fst t) (fst c) r)) by now apply accounts_add.
    assert (Z : forall w, w = 0 -> fl w - 0 = 0) by (intros w ->; rewrite rnd_0; auto with typeclass_instances; ring).
    set (r2 := if Req_bool (snd (snd t)) 0 || Req_bool a 0 then _ else _).
    assert (H2 : accounts (d + fst c * e (fst t) + (a * snd (snd t) - s) * e (fst t)) r2).
    { unfold r2. case_eq (Req_bool (snd (snd t)) 0 || Req_bool a 0).
      - intros I. assert (W : a * snd (snd t) = 0).
        { apply orb_prop in I. destruct I as [I | I]; revert I; (case Req_bool_spec; [| discriminate]);
            intros -> _; ring. }
        apply accounts_eq with (1 := H1). unfold s. generalize (Z _ W). rewrite W. intros Q.
        replace (fl 0) with 0 by lra. ring.
      - intros _. apply accounts_add_left; [exact H1 | apply amount_half_ulp |].
        apply Rle_trans with (1 := times_unit _ _). apply fl_error. }
    case_eq (Req_bool (fst (snd t)) 0 || Req_bool b 0).
    + intros I. assert (W : fst (snd t) * b = 0).
      { apply orb_prop in I. destruct I as [I | I]; revert I; (case Req_bool_spec; [| discriminate]);
          intros -> _; ring. }
      apply accounts_eq with (1 := H2). unfold u. generalize (Z _ W). rewrite W. intros Q.
      replace (fl 0) with 0 by lra. ring.
    + intros _. apply accounts_add_left; [exact H2 | apply amount_half_ulp |].
      apply Rle_trans with (1 := times_unit _ _). apply fl_error.
  - replace (snd c) with (s + u - fst c) by lra. ring.
Qed.
(** `known` is the rounding error. *)
Theorem affine_multiply_sound known : (forall k, known = Some k -> number k /\ fl (a * b) + k = a * b) ->
  made (fl (a * b)) (affine_multiply limit (fl (a * b)) a A b B known g) (x * y) g.
Proof.
  intros K. assert (F := merged_fit). unfold affine_multiply.
  case_eq (is_zero a A || is_zero b B).
  { intros I. apply orb_prop in I. assert (P : fl (a * b) = 0 /\ x * y = 0).
    { destruct I as [I | I].
      - destruct (is_zero_sound _ _ _ of_a I) as [-> ->]. rewrite !Rmult_0_l, rnd_0; auto with typeclass_instances.
      - destruct (is_zero_sound _ _ _ of_b I) as [-> ->]. rewrite !Rmult_0_r, rnd_0; auto with typeclass_instances. }
    destruct P as [-> ->]. apply zero_made. }
  intros _. destruct of_a as (Na & NA & (RA1 & RA2 & RA) & (DA1 & DA2 & DA)).
  destruct of_b as (Nb & NB & (RB1 & RB2 & RB) & (DB1 & DB2 & DB)).
  apply finished_sound; auto; [apply number_fl |].
  destruct (upper_product_sound (Rabs a) (rest B) ltac:(apply Rabs_pos) RB2) as [P1 Q1].
  destruct (upper_product_sound (rest A) (Rabs b) RA2 ltac:(apply Rabs_pos)) as [P2 Q2].
  destruct (upper_product_sound (radius A) (radius B) DA2 DB2) as [P3 Q3].
  set (SA := sum_of e (of A)) in *. set (SB := sum_of e (of B)) in *.
  eapply accounts_eq.
  - apply accounts_add_left with (t := (x - a) * (y - b)); [| exact P3 |].
    + apply accounts_add_left with (t := (x - a - SA) * b); [| exact P2 |].
      * apply accounts_add_left with (t := a * (y - b - SB)); [| exact P1 |].
        -- apply (fold_step (product_step a b) b a product_step_sound); [exact F |].
           apply accounts_add_left with (t := a * b - fl (a * b)); [apply accounts_nothing | |].
           ++ destruct known as [k |]; [apply amount_abs; now apply K | apply amount_half_ulp].
           ++ destruct known as [k |]; [| apply fl_error].
              replace (a * b - fl (a * b)) with k by (generalize (proj2 (K k eq_refl)); lra). lra.
        -- rewrite Rabs_mult. apply Rle_trans with (2 := Q1). apply Rmult_le_compat_l; auto. apply Rabs_pos.
      * rewrite Rabs_mult. apply Rle_trans with (2 := Q2). apply Rmult_le_compat_r; auto. apply Rabs_pos.
    + rewrite Rabs_mult. apply Rle_trans with (2 := Q3). apply Rmult_le_compat; auto; apply Rabs_pos.
  - destruct (merged_sound (of A) (of B)) as [M _]. unfold weighed. rewrite M. fold SA SB. ring.
Qed.

Lemma distance_sound s t : number s -> number t -> 0 < fl (fl (s - t) * fl (1 - eps)) ->
  fl (fl (s - t) * fl (1 - eps)) <= s - t.
Proof.
  intros S T P.
  assert (E : 0 <= fl (1 - eps) <= 1).
  { generalize (eps_le p 4 p_4) (eps_positive p). simpl. intros. split; [apply fl_nonnegative; lra |].
    apply rnd_below; auto with typeclass_instances; [| lra].
    change 1 with (bpow radix2 0). apply number_power; auto. lia. }
  assert (F : 0 < fl (s - t)).
  { apply Rnot_le_lt. intros C. apply (Rlt_not_le _ _ P).
    apply rnd_below; auto with typeclass_instances; [apply number_0 |].
    rewrite <- (Rmult_0_l (fl (1 - eps))). apply Rmult_le_compat_r; lra. }
  destruct (Req_dec (fl (s - t)) (s - t)) as [X | X].
  - apply rnd_below; auto with typeclass_instances; [rewrite <- X; apply number_fl |]. rewrite X in *.
    apply Rle_trans with ((s - t) * 1); [apply Rmult_le_compat_l; lra | lra].
  - assert (L := lower_sum_sound p emin ltac:(lia) ltac:(lia) s (- t) S (number_opp p emin t T) X).
    change (s + - t) with (s - t) in L. rewrite (Rabs_pos_eq (fl (s - t))) in L by lra.
    apply Rle_trans with (1 := L). right. apply Rabs_pos_eq. apply Rnot_lt_le. intros C.
    apply (Rlt_not_le _ _ F). apply rnd_below; auto with typeclass_instances; [apply number_0 | lra].
Qed.

(** The quotient's terms D and the rest of the numerator give all of m. *)
Definition divides (d m : R) (r : R * builder) : Prop :=
  amount (fst r) /\ exists D, accounts D (snd r) /\ Rabs (m - b * (D - d)) <= fst r.
Lemma quotient_step_sound v d m r t : b <> 0 -> fit t -> divides d m r ->
  divides d (m + (1 * fst (snd t) + - v * snd (snd t)) * e (fst t)) (quotient_step v b r t).
Proof.
  intros Z (F & N1 & N2) (P & D & H & Q). unfold quotient_step.
  set (s := fl (v * snd (snd t))).
  assert (NS : number (- s)) by (apply number_opp, number_fl).
  destruct (two_sum_numbers (fst (snd t)) (- s)) as [S1 S2].
  assert (E := two_sum_exact p emin emin_negative (fst (snd t)) (- s) ltac:(lia) N1 NS).
  set (n := two_sum p emin (fst (snd t)) (- s)) in *.
  set (left := upper_sum (fst r) (Rabs (snd n))).
  destruct (upper_sum_sound (fst r) (Rabs (snd n)) P (amount_abs _ S2)) as [P1 L1]. fold left in P1, L1.
  set (left' := if Req_bool (snd (snd t)) 0 then left else upper_sum left (half_ulp s)).
  assert (L2 : amount left' /\ left + Rabs (v * snd (snd t) - s) <= left').
  { unfold left'. case Req_bool_spec; intros W.
    - split; auto. assert (S0 : s = 0).
      { unfold s. rewrite W, Rmult_0_r. apply rnd_0; auto with typeclass_instances. }
      rewrite S0, W, Rmult_0_r, Rminus_0_r, Rabs_R0. lra.
    - destruct (upper_sum_sound left (half_ulp s) P1 (amount_half_ulp _)) as [P2 L2]. split; auto.
      assert (G : Rabs (v * snd (snd t) - s) <= half_ulp s) by apply fl_error. lra. }
  destruct L2 as [P2 L2]. cbv zeta. split; [exact P2 |].
  exists (D + fst n / b * e (fst t)). split.
  - set (c := fl (fst n / b)).
    assert (H1 : accounts (D + c * e (fst t)) (add (fst t) c (snd r))) by (apply accounts_add; auto; apply number_fl).
    match goal with |- accounts _ (snd (_, ?z)) => change (accounts (D + fst n / b * e (fst t)) z) end.
    case Req_bool_spec; intros W.
    + apply accounts_eq with (1 := H1). assert (W' : fst n = 0) by exact W.
      assert (C0 : c = 0).
      { unfold c. rewrite W'. unfold Rdiv. rewrite Rmult_0_l. apply rnd_0; auto with typeclass_instances. }
      rewrite C0, W'. unfold Rdiv. ring.
    + apply accounts_eq with (D + c * e (fst t) + (fst n / b - c) * e (fst t)); [| ring].
      apply accounts_add_left; [exact H1 | apply amount_half_ulp |].
      apply Rle_trans with (1 := times_unit _ _). apply fl_error.
  - match goal with |- ?z <= fst _ => change (z <= left') end.
    replace (m + (1 * fst (snd t) + - v * snd (snd t)) * e (fst t) - b * (D + fst n / b * e (fst t) - d))
      with ((m - b * (D - d)) + (snd n * e (fst t) - (v * snd (snd t) - s) * e (fst t))).
    + apply Rle_trans with (1 := Rabs_triang _ _).
      assert (T := Rabs_triang (snd n * e (fst t)) (- ((v * snd (snd t) - s) * e (fst t)))).
      rewrite Rabs_Ropp in T. fold (snd n * e (fst t) - (v * snd (snd t) - s) * e (fst t)) in T.
      generalize (times_unit (snd n) (fst t)) (times_unit (v * snd (snd t) - s) (fst t)). lra.
    + replace (fst (snd t)) with (fst n + snd n + s) by lra. field. exact Z.
Qed.
Lemma quotient_fold v d l : b <> 0 -> forall m r, Forall fit l -> divides d m r ->
  divides d (m + sum_of e (weighed 1 (- v) l)) (fold_left (quotient_step v b) l r).
Proof.
  intros Z. induction l as [| t l IH]; intros m r F H.
  - simpl. now rewrite Rplus_0_r.
  - inversion F. subst. simpl.
    replace (m + ((1 * fst (snd t) + - v * snd (snd t)) * e (fst t) + sum_of e (weighed 1 (- v) l))) with
      (m + (1 * fst (snd t) + - v * snd (snd t)) * e (fst t) + sum_of e (weighed 1 (- v) l)) by ring.
    apply IH; auto. now apply quotient_step_sound.
Qed.

(** `known` is the remainder. *)
Theorem affine_divide_sound known q : (forall k, known = Some k -> number k /\ k = a - fl (a / b) * b) ->
  affine_divide limit (fl (a / b)) a A b B known g = Some q -> y <> 0 /\ made (fl (a / b)) q (x / y) g.
Proof.
  intros K. assert (F := merged_fit). unfold affine_divide.
  assert (of_a' := of_a). assert (of_b' := of_b).
  destruct of_a' as (Na & NA & (RA1 & RA2 & RA) & (DA1 & DA2 & DA)).
  destruct of_b' as (Nb & NB & (RB1 & RB2 & RB) & (DB1 & DB2 & DB)).
  set (v := fl (a / b)) in *.
  case Rlt_bool_spec; intros P; [| discriminate]. cbn [negb].
  assert (L := distance_sound (Rabs b) (radius B) (number_abs p emin b Nb) DB1 P).
  set (distance := fl (fl (Rabs b - radius B) * fl (1 - eps))) in *.
  assert (Y : distance <= Rabs y).
  { apply Rle_trans with (1 := L). assert (Rabs b <= Rabs y + Rabs (y - b)); [| lra].
    replace b with (y + - (y - b)) at 1 by ring. apply Rle_trans with (1 := Rabs_triang _ _).
    rewrite Rabs_Ropp. lra. }
  assert (Y0 : y <> 0) by (intros Z; rewrite Z, Rabs_R0 in Y; lra).
  assert (B0 : b <> 0) by (intros Z; rewrite Z, Rabs_R0 in L; lra).
  assert (BP : 0 < Rabs b) by now apply Rabs_pos_lt.
  intros Q. split; auto. revert Q.
  case_eq (is_zero a A).
  { intros I Q. injection Q. intros <-. destruct (is_zero_sound _ _ _ of_a I) as [-> ->]. unfold v, Rdiv.
    rewrite !Rmult_0_l, rnd_0 by auto with typeclass_instances. apply zero_made. }
  intros _. set (SA := sum_of e (of A)) in *. set (SB := sum_of e (of B)) in *.
  set (left := upper_sum (upper_product (Rabs v) (rest B)) (rest A)).
  set (left' := match known with Some r => upper_sum left (Rabs r) | None => left end).
  set (r0 := match known with Some _ => nothing | None => add_left (half_ulp v) nothing end).
  set (d := match known with Some _ => 0 | None => a / b - v end).
  set (m := match known with Some k => k | None => 0 end + ((x - a - SA) - v * (y - b - SB))).
  destruct (upper_product_sound (Rabs v) (rest B) ltac:(apply Rabs_pos) RB2) as [P1 Q1].
  destruct (upper_sum_sound _ (rest A) P1 (conj RA1 RA2)) as [P2 Q2]. fold left in P2, Q2.
  assert (W : Rabs ((x - a - SA) - v * (y - b - SB)) <= left).
  { apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp, Rabs_mult.
    assert (Rabs v * Rabs (y - b - SB) <= Rabs v * rest B) by (apply Rmult_le_compat_l; auto; apply Rabs_pos).
    lra. }
  assert (D : divides d m (left', r0)).
  { unfold divides, left', r0, d, m. destruct known as [k |]; simpl.
    - destruct (K k eq_refl) as [NK _].
      destruct (upper_sum_sound left (Rabs k) P2 (amount_abs _ NK)) as [P3 Q3]. split; auto.
      exists 0. split; [apply accounts_nothing |]. replace (b * (0 - 0)) with 0 by ring. rewrite Rminus_0_r.
      apply Rle_trans with (1 := Rabs_triang _ _). lra.
    - split; auto. exists (a / b - v). split.
      + apply accounts_eq with (0 + (a / b - v)); [| ring].
        apply accounts_add_left; [apply accounts_nothing | apply amount_half_ulp | apply fl_error].
      + replace (b * (a / b - v - (a / b - v))) with 0 by ring. now rewrite Rminus_0_r, Rplus_0_l. }
  assert (E := quotient_fold v d (merged (of A) (of B)) B0 m (left', r0) F D).
  destruct (merged_sound (of A) (of B)) as [M _]. unfold weighed in E. rewrite M in E. fold SA SB in E.
  destruct (fold_left (quotient_step v b) (merged (of A) (of B)) (left', r0)) as [l r].
  destruct E as (PL & C & AC & H). cbn [fst snd] in PL, AC, H.
  set (n := x - v * y).
  assert (N : n = m + (1 * SA + - v * SB) + b * d).
  { unfold n, m, d. destruct known as [k |].
    - rewrite (proj2 (K k eq_refl)). fold v. ring.
    - field. exact B0. }
  assert (AL : accounts (n / b) (add_left (upper_quotient l (Rabs b)) r)).
  { destruct (upper_quotient_sound l (Rabs b) (proj2 PL) BP) as [PQ QQ].
    apply accounts_eq with (C + (m + (1 * SA + - v * SB) - b * (C - d)) / b).
    - apply accounts_add_left; auto. unfold Rdiv. rewrite Rabs_mult, Rabs_inv.
      apply Rle_trans with (2 := QQ). apply Rmult_le_compat_r; auto. left. now apply Rinv_0_lt_compat.
    - rewrite N. field. exact B0. }
  set (r2 := add_left (upper_quotient l (Rabs b)) r) in *.
  destruct (radius_sound _ _ AL) as [PR QR]. set (quotient := upper_sum (radius_of r2) (fst r2)) in *.
  intros Q. injection Q. intros <-. apply finished_sound; auto; [apply number_fl |].
  assert (T : x / y - v = n / b + n / b * (b - y) / y) by (unfold n; field; auto).
  case Rlt_bool_spec; intros RP.
  - destruct (upper_product_sound quotient (radius B) (proj2 PR) DB2) as [P5 Q5].
    destruct (upper_quotient_sound _ distance (proj2 P5) P) as [P6 Q6].
    apply accounts_eq with (n / b + n / b * (b - y) / y); [| now rewrite T].
    apply accounts_add_left; auto. apply Rle_trans with (2 := Q6).
    unfold Rdiv. rewrite Rabs_mult, Rabs_inv. apply Rmult_le_compat.
    + apply Rabs_pos.
    + left. apply Rinv_0_lt_compat. lra.
    + apply Rle_trans with (2 := Q5). rewrite Rabs_mult. apply Rmult_le_compat; try apply Rabs_pos; auto.
      rewrite Rabs_minus_sym. exact DB.
    + apply Rinv_le; auto.
  - apply accounts_eq with (1 := AL). rewrite T.
    assert (y = b) as -> by (assert (radius B = 0) as R0 by lra; rewrite R0 in DB; apply Rabs_le_inv in DB; lra).
    field. exact B0.
Qed.

(** Operations of one operand. *)
Theorem affine_scale_sound k :
  made (fl (a * bpow radix2 k)) (affine_scale limit (fl (a * bpow radix2 k)) a A k g) (x * bpow radix2 k) g.
Proof.
  destruct of_a as (Na & NA & (RA1 & RA2 & RA) & _). unfold affine_scale.
  assert (L : forall c, number c -> amount (lost (fl (c * bpow radix2 k)) c k) /\
                        Rabs (c * bpow radix2 k - fl (c * bpow radix2 k)) <= lost (fl (c * bpow radix2 k)) c k).
  { intros c C. unfold lost. generalize (eta_positive emin). intros EP.
    case_eq ((0 <=? k)%Z || Req_bool (fl (fl (c * bpow radix2 k) * bpow radix2 (- k))) c); intros I.
    - split; [apply amount_0 |].
      assert (X : fl (c * bpow radix2 k) = c * bpow radix2 k).
      { destruct (Z_le_gt_dec 0 k) as [E | E]; [apply scale_up; auto with typeclass_instances |].
        apply orb_prop in I. destruct I as [I | I]; [apply Zle_bool_imp_le in I; lia |].
        revert I. case Req_bool_spec; [| discriminate]. intros I _.
        exact (scale_back p emin nearest (fl (c * bpow radix2 k)) c k (number_fl _) ltac:(lia) I). }
      rewrite X, Rminus_diag_eq, Rabs_R0 by auto. lra.
    - split; [split; [now apply number_eta | lra] |]. rewrite Rabs_minus_sym.
      assert (S := scale_error p emin nearest _ _ (rounding_error_nearest p emin ltac:(lia)) c k C). lra. }
  assert (F : Forall (fun t => fst t <> f /\ number (snd t)) (of A)).
  { apply Forall_forall. intros t T. split; [now apply (proj1 (Forall_forall _ _) new_a) |
      now apply (proj1 (Forall_forall _ _) NA)]. }
  assert (S : forall l r d, Forall (fun t => fst t <> f /\ number (snd t)) l -> accounts d r ->
    accounts (d + sum_of e l * bpow radix2 k) (fold_left (scale_step k) l r)).
  { induction l as [| t l IH]; intros r d G H; simpl.
    - apply accounts_eq with (1 := H). ring.
    - inversion G as [| ? ? [G1 G2] G3]. subst. destruct (L _ G2) as [L1 L2].
      eapply accounts_eq.
      + apply IH; auto. unfold scale_step.
        apply accounts_add_left with
          (t := (snd t * bpow radix2 k - fl (snd t * bpow radix2 k)) * e (fst t)); auto.
        * apply accounts_add with (1 := H); auto. apply number_fl.
        * apply Rle_trans with (1 := times_unit _ _). exact L2.
      + ring. }
  apply finished_sound; auto; [apply number_fl |].
  destruct (L _ Na) as [L1 L2]. destruct (L _ RA1) as [L3 L4].
  set (scaled := fl (rest A * bpow radix2 k)) in *.
  assert (SP : amount scaled).
  { split; [apply number_fl |]. apply fl_nonnegative, Rmult_le_pos; auto. apply bpow_ge_0. }
  set (SA := sum_of e (of A)) in *. set (rho := (x - a - SA) * bpow radix2 k).
  assert (RHO : Rabs rho <= scaled + lost scaled (rest A) k).
  { unfold rho. rewrite Rabs_mult, (Rabs_pos_eq (bpow radix2 k)) by apply bpow_ge_0.
    apply Rle_trans with (rest A * bpow radix2 k); [apply Rmult_le_compat_r; auto; apply bpow_ge_0 |].
    apply Rabs_le_inv in L4. lra. }
  (* subtract the scaled rest from rho as far as possible, then the error of that *)
  set (part := Rmax (- scaled) (Rmin scaled rho)).
  assert (PART : Rabs part <= scaled /\ Rabs (rho - part) <= lost scaled (rest A) k).
  { destruct SP as [_ SP]. destruct L3 as [_ L3]. apply Rabs_le_inv in RHO. unfold part, Rmax, Rmin.
    destruct (Rle_dec scaled rho); [destruct (Rle_dec (- scaled) scaled) | destruct (Rle_dec (- scaled) rho)];
      split; apply Rabs_le; lra. }
  eapply accounts_eq.
  - apply accounts_add_left with (t := rho - part); [| exact L3 | exact (proj2 PART)].
    apply accounts_add_left with (t := part); [| exact SP | exact (proj1 PART)].
    apply S; [exact F |].
    apply accounts_add_left with (t := a * bpow radix2 k - fl (a * bpow radix2 k));
      [apply accounts_nothing | exact L1 | exact L2].
  - fold SA. unfold rho. ring.
Qed.

End Operation.

Theorem affine_exact_sound e v : number v -> holds e v affine_exact v.
Proof.
  intros N. unfold affine_exact. repeat split; simpl; auto using number_0; try lra;
    replace (v - v) with 0 by ring; rewrite ?Rminus_0_r, Rabs_R0; lra.
Qed.
Theorem affine_within_sound e f limit v x error g : units e -> number v -> number error -> 0 <= error ->
  Rabs (v - x) <= error -> g = Some f \/ g = None -> made e f v (affine_within limit error g) x g.
Proof.
  intros U V N P H G. unfold affine_within. apply finished_sound; auto.
  apply accounts_eq with (0 + (x - v)); [| ring].
  apply accounts_add_left; [apply accounts_nothing | split; auto |]. now rewrite Rabs_minus_sym.
Qed.
Theorem affine_negate_sound e v A x : holds e v A x -> holds e (- v) (negated A) (- x).
Proof.
  intros (N & NA & (R1 & R2 & R) & (D1 & D2 & D)). unfold negated. repeat split; simpl; auto.
  - now apply number_opp.
  - apply Forall_forall. intros t T. apply in_map_iff in T. destruct T as (s & <- & S). simpl.
    apply number_opp. now apply (proj1 (Forall_forall _ _) NA).
  - rewrite sum_of_opp. replace (- x - - v - - sum_of e (of A)) with (- (x - v - sum_of e (of A))) by ring.
    now rewrite Rabs_Ropp.
  - replace (- x - - v) with (- (x - v)) by ring. now rewrite Rabs_Ropp.
Qed.
Theorem affine_subtract_sound e f : units e -> forall a x b y A B, holds e a A x -> holds e b B y ->
  is_new f A -> is_new f B -> forall limit g, g = Some f \/ g = None ->
  made e f (fl (a - b)) (affine_subtract limit a A b B g) (x - y) g.
Proof.
  intros U a x b y A B HA HB FA FB limit g G. unfold affine_subtract, Rminus.
  apply affine_add_sound; auto; [now apply affine_negate_sound |].
  unfold is_new, negated. simpl. apply Forall_forall. intros t T. apply in_map_iff in T.
  destruct T as (s & <- & S). simpl. now apply (proj1 (Forall_forall _ _) FB).
Qed.
(** Bounds still hold when a source is new. *)
Theorem affine_keeps e f t v A x : is_new f A -> holds e v A x -> holds (set e f t) v A x.
Proof.
  intros F (N & NA & (R1 & R2 & R) & D). split; auto. split; auto. split; auto. split; auto. split; auto.
  now rewrite sum_of_set.
Qed.
Theorem affine_error_sound e v A x : holds e v A x -> Rabs (v - x) <= radius A.
Proof. intros (_ & _ & _ & (_ & _ & D)). now rewrite Rabs_minus_sym. Qed.

End Affine.
