(** Bound rule `affine` (include/errbound/rules/affine.hpp) over IEEE formats (Ieee.v), to nearest, including
    overflow: the functions of AffineCode.v, with p >= 4, emax > p, and any limit on terms. A source s has a number e
    s of size at most 1, as in Affine.v. A number x is known by its value v and a bound if the radius holds
    (IeeeRules.v). If rest and terms are finite, also |x - v - sum of c (e s)| <= rest. An operation has a new source
    or none. If the radius is finite, nothing before overflowed (except sums of discarded terms), so the floats are
    the real numbers of Affine.v. Results: a number of the new source exists (`made`) for which the returned bound
    holds:
        affine_exact_known, affine_within_known, affine_negate_known, affine_add_known, affine_subtract_known,
        affine_multiply_known, affine_divide_known (with fused multiply-add and without, `fused`), affine_scale_known
        affine_error_known   the radius is an error, in the sense of IeeeRules.v
        affine_known_stays   bounds still hold if other sources get other numbers *)

From Coq Require Import Reals ZArith Lia Lra Psatz Bool List.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code CompoundCode AffineCode Ieee IeeeRules.
From Errbound Require Format ErrorFree Residual Upper Affine IeeeInterval IeeeResidual.
Import ListNotations.
Open Scope R_scope.

(** A list whose items are processed one after the other. If the result is good, all items were, and the result
    stands for the processed real items. *)
Lemma fold_backward {S X S' X'} (good : S -> Prop) (fine : X -> Prop) (read : S -> S') (item : X -> X')
    (step : S -> X -> S) (step' : S' -> X' -> S') :
  (forall s t, good (step s t) -> good s /\ fine t /\ read (step s t) = step' (read s) (item t)) ->
  forall l s, good (fold_left step l s) ->
    good s /\ Forall fine l /\ read (fold_left step l s) = fold_left step' (map item l) (read s).
Proof.
  intros H. induction l as [| t l IH]; intros s G; simpl in *; auto.
  destruct (IH _ G) as (G1 & F & E). destruct (H _ _ G1) as (G2 & FT & E'). rewrite <- E', E. auto.
Qed.

Section Rules.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_4 : (4 <= p)%Z).
Variable fused : bool.  (* has_fast_fma *)
Variable limit : nat.
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation fl := (Format.rnd p emin Format.nearest).
Notation number := (Format.number p emin).
Notation nonnegative := (nonnegative p emax).
Notation known := (known p emax).
Notation terms := (terms float).
Notation builder := (builder float).
Notation affine := (affine float).
Notation radius := (radius float).
Notation rest := (rest float).
Notation parts := (parts float).
Notation zero := (integer _ F 0).

Lemma at_least_3 : (3 <= p)%Z.
Proof. lia. Qed.
Lemma emin_below : (emin <= - p - 1)%Z.
Proof. generalize (p_emax p emax). lia. Qed.
Lemma zero_is_0 : finite zero /\ B2R zero = 0.
Proof. apply (zero_value p emax at_least_3). Qed.

Ltac split_finite := finite_parts p emax at_least_3.
Ltac values := known_values p emax at_least_3.

(** The real numbers of the code's floats. *)
Definition real_terms (l : terms) : Affine.terms := map (fun t => (fst t, B2R (snd t))) l.
Definition real (B : builder) : Affine.builder := (B2R (fst B), real_terms (snd B)).
Definition real_pair (t : Z * (float * float)) : Z * (R * R) := (fst t, (B2R (fst (snd t)), B2R (snd (snd t)))).
Definition real_bound (A : affine) : Affine.bound :=
  {| Affine.radius := B2R (radius A); Affine.rest := B2R (rest A); Affine.of := real_terms (parts A) |}.
Definition all_finite (l : terms) : Prop := Forall (fun t => finite (snd t)) l.
Definition fine (B : builder) : Prop := finite (fst B) /\ all_finite (snd B).
Definition fine_pair (t : Z * (float * float)) : Prop := finite (fst (snd t)) /\ finite (snd (snd t)).

Lemma equal_zero x : finite x -> equal _ F x zero = Req_bool (B2R x) 0.
Proof. intros H. destruct zero_is_0 as [Z0 Z]. now rewrite (equal_finite p emax), Z. Qed.
Lemma equals_zero x : equal _ F x zero = true -> finite x /\ B2R x = 0.
Proof. intros H. now apply (equal_true p emax) in H. Qed.
Lemma factor_value : finite (integer _ F 1 ⊕ epsilon _ F) /\
  B2R (integer _ F 1 ⊕ epsilon _ F) = fl (1 + Format.eps p).
Proof.
  destruct (integer_value p emax at_least_3 1 ltac:(lia)) as [F1 V1]. destruct (eps_value p emax at_least_3) as [F2 V2].
  generalize (Bplus_correct p emax _ _ mode_NE _ _ F1 F2). rewrite Rlt_bool_true.
  - intros (E & H & _). split; [exact H |]. rewrite V1, V2 in E. exact E.
  - rewrite V1, V2. apply Rle_lt_trans with (bpow radix2 1); [| apply bpow_lt; generalize (p_emax p emax); lia].
    apply (Format.rnd_abs_below p emin Format.nearest).
    + apply Format.number_power; auto; generalize emin_below; lia.
    + generalize (Format.eps_le p 4 p_4) (Format.eps_positive p). simpl. intros. rewrite Rabs_pos_eq; lra.
Qed.
Lemma sum_finite x y : finite (upper_sum _ F x y) ->
  finite x /\ finite y /\ B2R (upper_sum _ F x y) = Affine.upper_sum p emin (B2R x) (B2R y).
Proof.
  unfold upper_sum, Affine.upper_sum. destruct (equal _ F x zero) eqn:X.
  - apply equals_zero in X. destruct X as [FX X]. intros H. now rewrite Req_bool_true.
  - destruct (equal _ F y zero) eqn:Y; intros H.
    + apply equals_zero in Y. destruct Y as [FY Y]. rewrite equal_zero in X by auto.
      now rewrite X, (Req_bool_true (B2R y)).
    + split_finite. rewrite equal_zero in X, Y by auto. rewrite X, Y. repeat split; auto.
      unfold Upper.upper. values. rewrite <- (proj2 factor_value). now values.
Qed.
(** If one factor is 0, the other may be anything. *)
Lemma product_finite x y r s : (finite x -> B2R x = r) -> (finite y -> B2R y = s) -> finite (upper_product _ F x y) ->
  B2R (upper_product _ F x y) = Affine.upper_product p emin r s /\
  (finite x /\ finite y \/ finite x /\ B2R x = 0 \/ finite y /\ B2R y = 0).
Proof.
  intros X Y. unfold upper_product, Affine.upper_product. destruct (equal _ F x zero) eqn:X0; cbn [orb].
  - apply equals_zero in X0. destruct X0 as [FX X0]. intros _. rewrite <- X, X0, Req_bool_true by auto. cbn [orb].
    split; [apply zero_is_0 | auto].
  - destruct (equal _ F y zero) eqn:Y0; intros H.
    + apply equals_zero in Y0. destruct Y0 as [FY Y0]. rewrite <- Y, Y0, (Req_bool_true 0), orb_true_r by auto.
      split; [apply zero_is_0 | auto].
    + split_finite. rewrite equal_zero in X0, Y0 by auto. rewrite <- X, <- Y, X0, Y0 by auto. split; auto.
      unfold Upper.upper. cbn [orb]. values. rewrite <- (proj2 factor_value). now values.
Qed.
Lemma quotient_finite x y : finite y -> B2R y <> 0 -> finite (upper_quotient _ F x y) ->
  finite x /\ B2R (upper_quotient _ F x y) = Affine.upper_quotient p emin (B2R x) (B2R y).
Proof.
  intros FY NY. unfold upper_quotient, Affine.upper_quotient. destruct (equal _ F x zero) eqn:X0; intros H.
  - apply equals_zero in X0. destruct X0 as [FX X0]. rewrite X0, Req_bool_true by auto. split; [auto | apply zero_is_0].
  - split_finite. match goal with H : finite (_ ⊘ _) |- _ => apply over_finite in H; auto; destruct H end.
    rewrite equal_zero in X0 by auto. rewrite X0. split; auto.
    unfold Upper.upper. values. rewrite <- (proj2 factor_value). now values.
Qed.

(** A result's terms and rest. *)
Lemma real_length B : length (snd (real B)) = length (snd B).
Proof. apply map_length. Qed.
Lemma nothing_real : real (nothing _ F) = Affine.nothing.
Proof. unfold real, nothing, Affine.nothing. cbn [fst snd real_terms map]. now rewrite (proj2 zero_is_0). Qed.
Lemma add_fine s c B : fine (add _ F s c B) ->
  finite c /\ fine B /\ real (add _ F s c B) = Affine.add s (B2R c) (real B).
Proof.
  unfold add, Affine.add. destruct (equal _ F c zero) eqn:C.
  - apply equals_zero in C. destruct C as [FC C]. rewrite C, Req_bool_true by auto. auto.
  - unfold fine, all_finite. cbn [fst snd]. intros [FB FS]. apply Forall_app in FS. destruct FS as [FS FC].
    inversion FC as [| ? ? FC' _]. subst. cbn [snd] in FC'. rewrite equal_zero in C by auto. rewrite C.
    repeat split; auto. unfold real, real_terms. cbn [fst snd]. now rewrite map_app.
Qed.
Lemma add_left_fine x B : fine (add_left _ F x B) ->
  finite x /\ fine B /\ real (add_left _ F x B) = Affine.add_left p emin (B2R x) (real B).
Proof.
  unfold fine, add_left, Affine.add_left. cbn [fst snd]. intros [H FS]. apply sum_finite in H.
  destruct H as (FB & FX & E). repeat split; auto. unfold real. cbn [fst snd]. now rewrite E.
Qed.
Lemma abs_value x : finite (abs _ F x) -> finite x /\ B2R (abs _ F x) = Rabs (B2R x).
Proof. apply (abs_finite p emax at_least_3). Qed.
Lemma radius_finite B : finite (fold_left (fun r (t : Z * float) => upper_sum _ F r (abs _ F (snd t))) (snd B) zero) ->
  all_finite (snd B) /\ B2R (radius_of _ F B) = Affine.radius_of p emin (real B).
Proof.
  intros H.
  destruct (fold_backward (fun r : float => finite r) (fun t : Z * float => finite (snd t)) (fun r => B2R r)
    (fun t => (fst t, B2R (snd t))) (fun r t => upper_sum _ F r (abs _ F (snd t)))
    (fun r (t : Z * R) => Affine.upper_sum p emin r (Rabs (snd t)))) with (l := snd B) (s := zero)
    as (_ & A & E); auto.
  intros r t G. apply sum_finite in G. destruct G as (FR & FA & E). apply abs_value in FA. destruct FA as [FA EA].
  rewrite EA in E. auto.
Qed.

Lemma least_real t l : finite (snd t) -> all_finite l -> let (m, r) := least _ F t l in
  finite (snd m) /\ all_finite r /\
  Affine.least (fst t, B2R (snd t)) (real_terms l) = ((fst m, B2R (snd m)), real_terms r).
Proof.
  revert t. induction l as [| x l IH]; intros t FT FL; cbn [least real_terms map Affine.least].
  - repeat split; auto.
  - inversion FL as [| ? ? FX FL']. subst. specialize (IH x FX FL'). destruct (least _ F x l) as [m r].
    destruct IH as (FM & FR & E). fold (real_terms l). rewrite E. cbn [snd].
    assert (L : less _ F (abs _ F (snd m)) (abs _ F (snd t)) = Rlt_bool (Rabs (B2R (snd m))) (Rabs (B2R (snd t)))).
    { generalize (abs_finite_intro p emax _ FM) (abs_finite_intro p emax _ FT). intros A1 A2.
      rewrite (less_finite p emax) by auto. apply abs_value in A1, A2.
      now destruct A1 as [_ ->], A2 as [_ ->]. }
    rewrite L. destruct (Rlt_bool _ _); repeat split; auto; constructor; auto.
Qed.
Lemma shorten_real fuel B : all_finite (snd B) -> let C := shorten _ F limit fuel B in
  all_finite (snd C) /\ (finite (fst C) -> finite (fst B) /\ real C = Affine.shorten p emin limit fuel (real B)).
Proof.
  revert B. induction fuel as [| n IH]; intros [left l] FB; cbn [shorten Affine.shorten]; auto.
  unfold real at 2. cbn [fst snd] in *. destruct l as [| t l]; [cbn [snd real_terms map]; auto |].
  cbn [real_terms map]. fold (real_terms l). unfold real_terms at 1.
  rewrite <- (map_length (fun t => (fst t, B2R (snd t))) (t :: l)).
  cbn [map]. fold (real_terms l). destruct (limit <=? _)%nat; [| auto].
  inversion FB as [| ? ? FT FL]. subst. assert (L := least_real t l FT FL). destruct (least _ F t l) as [m r].
  destruct L as (FM & FR & ->). destruct (IH (add_left _ F (abs _ F (snd m)) (left, r)) FR) as [A E].
  split; auto. intros H. destruct (E H) as [H' ->].
  destruct (add_left_fine (abs _ F (snd m)) (left, r)) as (FA & FB' & E').
  - now split.
  - split; [apply FB' |]. rewrite E'. cbn [snd]. now rewrite (proj2 (abs_value _ FA)).
Qed.
Lemma placed_real t l : real_terms (placed _ t l) = Affine.placed (fst t, B2R (snd t)) (real_terms l).
Proof.
  induction l as [| x l IH]; [reflexivity |]. cbn [placed]. unfold real_terms at 2. cbn [map Affine.placed fst].
  destruct (fst t <? fst x)%Z; [| reflexivity]. fold (real_terms l). rewrite <- IH. reflexivity.
Qed.
Lemma placed_finite t l : all_finite (placed _ t l) -> finite (snd t).
Proof.
  induction l as [| x l IH]; simpl; intros H; [now inversion H |].
  destruct (fst t <? fst x)%Z; inversion H; auto.
Qed.

(** The meaning of a number's value and bound for x, with the numbers e of the sources (Affine.v). If the radius is
    finite, it bounds the error; if rest and terms are, they do. *)
Definition affine_known (e : Z -> R) (v : float) (A : affine) (x : R) : Prop :=
  known v (radius A) x /\
  (finite (rest A) -> all_finite (parts A) -> finite (radius A) /\ Affine.holds p emin e (B2R v) (real_bound A) x).
Definition is_new (f : Z) (A : affine) : Prop := Forall (fun t => fst t <> f) (parts A).
(** The result holds with some number of the new source, or without sources. *)
Definition made (e : Z -> R) (v : float) (A : affine) (x : R) (g : option Z) : Prop :=
  match g with
  | Some f => exists t, Rabs t <= 1 /\ affine_known (Affine.set e f t) v A x
  | None => affine_known e v A x
  end.

Lemma unknown_known e v x : affine_known e v (unknown_number _ F) x.
Proof. split; [split; [reflexivity |] |]; discriminate. Qed.
Lemma always_made v A x : (forall e, affine_known e v A x) -> forall e g, made e v A x g.
Proof. intros K e [f |]; [exists 0; rewrite Rabs_R0; split; [lra |] |]; apply K. Qed.

Lemma finished_known e f v B x g :
  (finite v -> fine B -> Affine.made p emin e f (B2R v) (Affine.finished p emin limit (real B) g) x g) ->
  made e v (finished _ F limit v B g) x g.
Proof.
  intros H. unfold finished. cbv zeta. set (all := upper_sum _ F (radius_of _ F B) (fst B)).
  destruct (is_finite _ F v) eqn:CV; [| apply always_made; intros; apply unknown_known].
  destruct (is_finite _ F all) eqn:CA; [| apply always_made; intros; apply unknown_known].
  cbn [negb orb]. apply (IeeeInterval.is_finite_true p emax) in CV, CA. assert (FA := CA).
  apply sum_finite in CA as (FR & FL & EA).
  apply radius_finite in FR. destruct FR as [FP ER]. rewrite ER in EA. fold all in EA. specialize (H CV (conj FL FP)).
  set (room := if equal _ F (fst B) zero then limit else Nat.pred limit).
  set (C := if (room <? length (snd B))%nat then shorten _ F limit (length (snd B)) B else B).
  set (done := if equal _ F (fst C) zero then _ else _).
  assert (Radius : radius done = all).
  { unfold done. destruct (equal _ F (fst C) zero); [| destruct g]; reflexivity. }
  assert (SC : all_finite (snd C) /\ (finite (fst C) -> real C =
    (if ((if Req_bool (fst (real B)) 0 then limit else Nat.pred limit) <? length (snd (real B)))%nat
     then Affine.shorten p emin limit (length (snd (real B))) (real B) else real B))).
  { unfold C, room. rewrite real_length, equal_zero by auto. change (fst (real B)) with (B2R (fst B)).
    case (_ <? _)%nat; [| auto]. destruct (shorten_real (length (snd B)) B FP) as [A E]. split; auto.
    intros FC. now destruct (E FC). }
  destruct SC as [FC EC].
  assert (RR : forall c, Affine.radius (Affine.finished p emin limit c g) =
                 Affine.upper_sum p emin (Affine.radius_of p emin c) (fst c)).
  { intros c. unfold Affine.finished. cbv zeta.
    match goal with |- Affine.radius (if ?c then _ else _) = _ => case c end; [| case g]; reflexivity. }
  assert (Real : finite (rest done) -> all_finite (parts done) -> finite (fst C)).
  { unfold done. destruct (equal _ F (fst C) zero) eqn:C0; [intros; now apply equals_zero |].
    destruct g as [s |]; cbn [rest parts]; auto. intros _ P. apply Forall_rev in P. rewrite rev_involutive in P.
    now apply placed_finite in P. }
  assert (Same : finite (fst C) -> real_bound done = Affine.finished p emin limit (real B) g).
  { intros FF. unfold Affine.finished. cbv zeta. rewrite <- (EC FF). unfold done, real_bound.
    rewrite equal_zero by auto. cbn [real fst snd].
    destruct (Req_bool (B2R (fst C)) 0); [| destruct g]; cbn [radius rest parts]; rewrite EA.
    - now rewrite (proj2 zero_is_0).
    - rewrite (proj2 zero_is_0). f_equal. unfold real_terms. rewrite map_rev.
      fold (real_terms (placed _ (z, fst C) (rev (snd C)))). rewrite placed_real.
      unfold real_terms. now rewrite map_rev.
    - reflexivity. }
  assert (K : forall e, Affine.holds p emin e (B2R v) (Affine.finished p emin limit (real B) g) x ->
    affine_known e v done x).
  { intros e' He. assert (He' := He). destruct He' as (_ & _ & _ & (_ & PR & D)). rewrite RR in PR, D.
    cbn [real fst] in PR, D. fold (real B) in PR, D. rewrite <- EA in PR, D. split.
    - rewrite Radius. split; [now apply nonnegative_intro |]. intros _. split; auto. now rewrite Rabs_minus_sym.
    - intros R P. rewrite Radius. split; auto. rewrite Same by auto.
      exact He. }
  destruct g as [s |]; cbn [made Affine.made] in *; [| now apply K].
  destruct H as (-> & t & T & H). exists t. auto.
Qed.
(** The terms of two numbers. *)
Lemma merged_real a b : map real_pair (merged _ F a b) = Affine.merged (real_terms a) (real_terms b) /\
  (Forall fine_pair (merged _ F a b) -> all_finite a /\ all_finite b).
Proof.
  assert (Z := proj2 zero_is_0).
  assert (L : forall t x y, real_pair (t, (x, y)) = (t, (B2R x, B2R y))) by reflexivity.
  assert (Step : forall s (x y : float) l (P Q : Prop), (Forall fine_pair l -> P) -> (finite x -> finite y -> P -> Q) ->
    Forall fine_pair ((s, (x, y)) :: l) -> Q).
  { intros s x y l P Q LP PQ H. inversion H as [| ? ? [H1 H2] H3]. auto. }
  revert b. induction a as [| [s x] a IHa].
  - induction b as [| [t y] b [E M]]; [repeat split; constructor |]. split.
    + change (real_pair (t, (zero, y)) :: map real_pair (merged _ F [] b) =
        (t, (0, B2R y)) :: Affine.merged (real_terms []) (real_terms b)). now rewrite E, L, Z.
    + apply Step with (1 := M). intros _ FY [A B]. split; auto. now constructor.
  - induction b as [| [t y] b [E M]].
    + destruct (IHa []) as [E M]. split.
      * change (real_pair (s, (x, zero)) :: map real_pair (merged _ F a []) =
          (s, (B2R x, 0)) :: Affine.merged (real_terms a) (real_terms [])). now rewrite E, L, Z.
      * apply Step with (1 := M). intros FX _ [A B]. split; auto. now constructor.
    + destruct (IHa ((t, y) :: b)) as [E1 M1], (IHa b) as [E2 M2]. split.
      * change (map real_pair (if (s <? t)%Z then (s, (x, zero)) :: merged _ F a ((t, y) :: b)
            else if (t <? s)%Z then (t, (zero, y)) :: merged _ F ((s, x) :: a) b else (s, (x, y)) :: merged _ F a b) =
          if (s <? t)%Z then (s, (B2R x, 0)) :: Affine.merged (real_terms a) (real_terms ((t, y) :: b))
          else if (t <? s)%Z then (t, (0, B2R y)) :: Affine.merged (real_terms ((s, x) :: a)) (real_terms b)
          else (s, (B2R x, B2R y)) :: Affine.merged (real_terms a) (real_terms b)).
        destruct (s <? t)%Z; [| destruct (t <? s)%Z]; cbn [map]; now rewrite ?E, ?E1, ?E2, L, ?Z.
      * change (Forall fine_pair (if (s <? t)%Z then (s, (x, zero)) :: merged _ F a ((t, y) :: b)
            else if (t <? s)%Z then (t, (zero, y)) :: merged _ F ((s, x) :: a) b else (s, (x, y)) :: merged _ F a b) ->
          all_finite ((s, x) :: a) /\ all_finite ((t, y) :: b)).
        destruct (s <? t)%Z; [| destruct (t <? s)%Z].
        -- apply Step with (1 := M1). intros FX _ [A B]. split; auto. now constructor.
        -- apply Step with (1 := M). intros _ FY [A B]. split; auto. now constructor.
        -- apply Step with (1 := M2). intros FX FY [A B]. split; now constructor.
Qed.

Lemma sum_step_fine B t : fine (sum_step _ F B t) ->
  fine B /\ fine_pair t /\ real (sum_step _ F B t) = Affine.sum_step p emin (real B) (real_pair t).
Proof.
  unfold sum_step, Affine.sum_step. cbv zeta. intros H. apply add_left_fine in H. destruct H as (FE & H & ->).
  apply add_fine in H. destruct H as (_ & H & ->). apply abs_value in FE. destruct FE as [FE ->].
  apply (IeeeResidual.two_sum_finite p emax) in FE. destruct FE as (F1 & F2 & E1 & E2). rewrite E1, E2.
  repeat split; auto; apply H.
Qed.
Lemma half_ulp_value v : finite (half_ulp _ F v) ->
  finite v /\ B2R (half_ulp _ F v) = Residual.half_ulp p emin (B2R v).
Proof. apply (IeeeResidual.half_ulp_finite p emax at_least_3). Qed.
Lemma product_step_fine a b B t : fine (product_step _ F a b B t) ->
  fine B /\ fine_pair t /\
  real (product_step _ F a b B t) = Affine.product_step p emin (B2R a) (B2R b) (real B) (real_pair t).
Proof.
  unfold product_step, Affine.product_step. cbv zeta. destruct t as [s [of_a of_b]]. cbn [real_pair fst snd].
  intros H. apply add_left_fine in H. destruct H as (FE & H & ->). apply abs_value in FE. destruct FE as [FE ->].
  apply (IeeeResidual.two_sum_finite p emax) in FE. destruct FE as (F1 & F2 & E1 & E2). rewrite E2. revert H.
  set (c := two_sum _ F (a ⊗ of_b) (of_a ⊗ b)) in *. intros H.
  assert (G1 := times_finite p emax _ _ F1). destruct G1 as (FA & FB & EX). rewrite EX in E1, E2 |- *.
  assert (G2 := times_finite p emax _ _ F2). destruct G2 as (FA' & FB' & EY). rewrite EY in E1, E2 |- *.
  rewrite (equal_zero of_a), (equal_zero of_b), (equal_zero a), (equal_zero b) in * by auto.
  assert (Maybe : forall (q : bool) x r, fine (if q then r else add_left _ F (half_ulp _ F x) r) -> fine r /\
    real (if q then r else add_left _ F (half_ulp _ F x) r) =
    if q then real r else Affine.add_left p emin (Residual.half_ulp p emin (B2R x)) (real r)).
  { intros [|] x r G; auto. apply add_left_fine in G. destruct G as (FH & G & ->).
    apply half_ulp_value in FH. destruct FH as [_ ->]. auto. }
  apply Maybe in H. destruct H as [H ->]. apply Maybe in H. destruct H as [H ->].
  apply add_fine in H. destruct H as (_ & H & ->). rewrite E1, EX, EY. repeat split; auto; apply H.
Qed.
Definition fine_quotient (r : float * builder) : Prop := finite (fst r) /\ fine (snd r).
Definition real_quotient (r : float * builder) : R * Affine.builder := (B2R (fst r), real (snd r)).
Lemma quotient_step_fine v b r t : finite b -> B2R b <> 0 -> fine_quotient (quotient_step _ F v b r t) ->
  fine_quotient r /\ fine_pair t /\
  real_quotient (quotient_step _ F v b r t) =
    Affine.quotient_step p emin (B2R v) (B2R b) (real_quotient r) (real_pair t).
Proof.
  intros FB NB. unfold quotient_step, Affine.quotient_step, fine_quotient, real_quotient. cbv zeta.
  destruct t as [s [of_a of_b]]. destruct r as [left B]. cbn [real_pair fst snd].
  set (x := v ⊗ of_b). set (n := two_sum _ F of_a (opposite _ F x)). set (c := fst n ⊘ b).
  intros [HL HB].
  assert (GB : finite c /\ finite (fst n) /\ fine B /\ real (if equal _ F (fst n) zero then add _ F s c B
      else add_left _ F (half_ulp _ F c) (add _ F s c B)) =
    if equal _ F (fst n) zero then Affine.add s (B2R c) (real B)
    else Affine.add_left p emin (Residual.half_ulp p emin (B2R c)) (Affine.add s (B2R c) (real B))).
  { assert (N : finite c -> finite (fst n)) by (intros G; now apply over_finite in G).
    destruct (equal _ F (fst n) zero).
    - apply add_fine in HB. destruct HB as (FC & G & ->). auto.
    - apply add_left_fine in HB. destruct HB as (FH & G & ->). apply half_ulp_value in FH. destruct FH as [_ ->].
      apply add_fine in G. destruct G as (FC & G & ->). auto. }
  destruct GB as (FC & FN & FB' & ->). assert (EC : B2R c = fl (B2R (fst n) / B2R b)) by now apply over_finite in FC.
  assert (GL : finite left /\ finite (snd n) /\
    (B2R (if equal _ F of_b zero then upper_sum _ F left (abs _ F (snd n))
     else upper_sum _ F (upper_sum _ F left (abs _ F (snd n))) (half_ulp _ F x)) =
     if equal _ F of_b zero then Affine.upper_sum p emin (B2R left) (Rabs (B2R (snd n)))
     else Affine.upper_sum p emin (Affine.upper_sum p emin (B2R left) (Rabs (B2R (snd n))))
            (Residual.half_ulp p emin (B2R x)))).
  { destruct (equal _ F of_b zero).
    - apply sum_finite in HL. destruct HL as (G & GA & ->). apply abs_value in GA. destruct GA as [GA ->]. auto.
    - apply sum_finite in HL. destruct HL as (HL & GH & ->). apply half_ulp_value in GH. destruct GH as [_ ->].
      apply sum_finite in HL. destruct HL as (G & GA & ->). apply abs_value in GA. destruct GA as [GA ->]. auto. }
  destruct GL as (FL & FE & ->). apply (IeeeResidual.two_sum_finite p emax) in FE. destruct FE as (F1 & F2 & E1 & E2).
  fold n in E1, E2. apply opposite_finite in F2. assert (G := times_finite p emax _ _ F2). destruct G as (_ & F3 & EX).
  fold x in EX. rewrite opposite_value, EX in E1, E2. rewrite E1 in EC. rewrite !equal_zero, EC, E1, E2, EX by auto.
  repeat split; auto; apply FB'.
Qed.
Lemma lost_real c x k : finite c -> finite x -> finite (lost _ F c x k) /\
  B2R (lost _ F c x k) = Affine.lost p emin (B2R c) (B2R x) k.
Proof.
  intros FC FX. unfold lost, Affine.lost. rewrite (scale_equal p emax) by auto.
  destruct (_ || _); [apply zero_is_0 | apply (eta_value p emax at_least_3)].
Qed.
Lemma scale_step_fine k B t : fine (scale_step _ F k B t) ->
  fine B /\ finite (snd t) /\
  real (scale_step _ F k B t) = Affine.scale_step p emin k (real B) (fst t, B2R (snd t)).
Proof.
  unfold scale_step, Affine.scale_step. cbv zeta. intros H. apply add_left_fine in H. destruct H as (_ & H & ->).
  apply add_fine in H. destruct H as (FC & H & ->). assert (FS := scale_finite p emax _ _ FC). destruct FS as [FT ->].
  destruct (lost_real (scale _ F (snd t) k) (snd t) k FC FT) as [_ ->].
  apply scale_finite in FC. destruct FC as [_ ->]. auto.
Qed.

(** A lower bound of a divisor's distance from zero. *)
Lemma shrinking_value : finite (integer _ F 1 ⊖ epsilon _ F) /\
  B2R (integer _ F 1 ⊖ epsilon _ F) = fl (1 - Format.eps p) /\ 0 < fl (1 - Format.eps p) <= 1.
Proof.
  destruct (integer_value p emax at_least_3 1 ltac:(lia)) as [F1 V1]. destruct (eps_value p emax at_least_3) as [F2 V2].
  assert (L := Format.eps_le p 4 p_4). assert (P := Format.eps_positive p). simpl in L.
  assert (B : 0 < fl (1 - Format.eps p) <= 1).
  { split.
    - apply Rlt_le_trans with (bpow radix2 (-1)); [apply bpow_gt_0 |]. apply (Format.rnd_above p emin Format.nearest).
      + apply Format.number_power; auto; generalize emin_below; lia.
      + simpl. lra.
    - apply (Format.rnd_below p emin Format.nearest); [| lra]. change 1 with (bpow radix2 0).
      apply Format.number_power; auto; generalize emin_below; lia. }
  generalize (Bminus_correct p emax _ _ mode_NE _ _ F1 F2). rewrite V1, V2, Rlt_bool_true.
  - intros (E & H & _). auto.
  - change (Rabs (fl (1 - Format.eps p)) < bpow radix2 emax). rewrite Rabs_pos_eq by lra.
    apply Rle_lt_trans with (1 := proj2 B). change 1 with (bpow radix2 0). apply bpow_lt.
    generalize (p_emax p emax). lia.
Qed.
Lemma shrunk_finite d : finite d -> finite (d ⊗ (integer _ F 1 ⊖ epsilon _ F)).
Proof.
  destruct shrinking_value as (FS & VS & S). intros FD.
  generalize (Bmult_correct p emax _ _ mode_NE d (integer _ F 1 ⊖ epsilon _ F)). rewrite Rlt_bool_true.
  - intros (_ & H & _). simpl times. simpl in H, FD, FS. now rewrite H, FD, FS.
  - apply Rle_lt_trans with (Rabs (B2R d)); [| apply abs_B2R_lt_emax].
    apply (Format.rnd_abs_below p emin Format.nearest); [apply Format.number_abs, number_B2R |].
    rewrite VS, Rabs_mult, (Rabs_pos_eq (fl _)) by lra. rewrite <- (Rmult_1_r (Rabs (B2R d))) at 2.
    apply Rmult_le_compat_l; [apply Rabs_pos | lra].
Qed.
Lemma less_of_shrunk d : less _ F zero (d ⊗ (integer _ F 1 ⊖ epsilon _ F)) = true -> less _ F zero d = true.
Proof.
  destruct shrinking_value as (FS & VS & S). destruct zero_is_0 as [Z0 Z]. intros C.
  destruct (BinarySingleNaN.is_finite d) eqn:FD.
  - assert (FP := shrunk_finite d FD). rewrite (less_finite p emax), Z in C by auto.
    rewrite (less_finite p emax), Z by auto.
    destruct (times_finite p emax _ _ FP) as (_ & _ & E). rewrite E, VS in C. revert C.
    case Rlt_bool_spec; [| discriminate]. intros C _. apply Rlt_bool_true. apply Rnot_le_lt. intros D.
    apply (Rlt_not_le _ _ C). apply (Format.rnd_below p emin Format.nearest); [apply Format.number_0 |]. nra.
  - revert C FS VS. generalize (integer _ F 1 ⊖ epsilon _ F). intros c C FC VC.
    destruct d as [| [|] | |]; try discriminate; [| reflexivity]. exfalso.
    assert (N : Bsign c = false).
    { apply (nonnegative_sign p emax); [apply nonnegative_intro; auto |]; lra. }
    destruct c as [| | | t m n q]; try discriminate; simpl in *; subst; try discriminate; lra.
Qed.

(** Operations, with the numbers e of the sources so far, and a new source f. *)
Section Operation.

Context (e : Z -> R) (e_units : Affine.units e) (f : Z) (g : option Z) (g_f : g = Some f \/ g = None).

(** The meaning of terms with an infinite rest: any large enough radius holds. *)
Lemma known_within v A x : affine_known e v A x -> finite (radius A) -> all_finite (parts A) -> exists r,
  (finite (rest A) -> B2R (rest A) = r) /\ 0 <= r /\
  Affine.holds p emin e (B2R v)
    {| Affine.radius := B2R (radius A); Affine.rest := r; Affine.of := real_terms (parts A) |} x.
Proof.
  intros [[PR KR] K] FR FP. destruct (BinarySingleNaN.is_finite (rest A)) eqn:FT.
  - exists (B2R (rest A)). destruct (K eq_refl FP) as [_ H]. assert (G := H).
    destruct G as (_ & _ & (_ & P & _) & _). auto.
  - set (d := x - B2R v - Affine.sum_of e (real_terms (parts A))).
    set (k := Z.max emin (mag radix2 d)). exists (bpow radix2 k).
    assert (L : Rabs d <= bpow radix2 k).
    { apply Rlt_le, Rlt_le_trans with (1 := bpow_mag_gt radix2 d). apply bpow_le. apply Z.le_max_r. }
    assert (P : 0 <= bpow radix2 k) by apply bpow_ge_0. split; [discriminate |]. split; auto.
    destruct (KR FR) as [FV D]. split; [apply number_B2R |]. split.
    + apply Forall_forall. intros t T. apply in_map_iff in T. destruct T as (s & <- & _). apply number_B2R.
    + repeat split; cbn [Affine.rest Affine.radius Affine.of]; auto using number_B2R.
      * apply Format.number_power; auto. apply Z.le_max_l.
      * now apply (nonnegative_value p emax).
      * now rewrite Rabs_minus_sym.
Qed.
Lemma real_new A : is_new f A -> forall r s,
  Affine.is_new f {| Affine.radius := r; Affine.rest := s; Affine.of := real_terms (parts A) |}.
Proof.
  intros N r s. apply Forall_forall. intros t T. apply in_map_iff in T. destruct T as (q & <- & Q).
  now apply (proj1 (Forall_forall _ _) N).
Qed.

Theorem affine_exact_known v : affine_known e v (affine_exact _ F v) (B2R v).
Proof.
  destruct (tight_exact_known p emax v) as [P K]. split; [now split |]. intros FR _. split; auto.
  assert (E : real_bound (affine_exact _ F v) = Affine.affine_exact).
  { assert (E0 : B2R (v ⊖ v) = 0).
    { apply minus_finite in FR. destruct FR as (_ & _ & ->). rewrite Rminus_eq_0.
      apply (Format.rnd_0 p emin Format.nearest). }
    unfold real_bound, affine_exact, Affine.affine_exact. cbn [AffineCode.radius AffineCode.rest AffineCode.parts].
    now rewrite E0. }
  rewrite E. apply Affine.affine_exact_sound. apply number_B2R.
Qed.
(** A negative, infinite or NaN error gives an unknown number. *)
Theorem affine_within_known v error x :
  (finite error -> 0 <= B2R error -> Rabs (B2R v - x) <= B2R error) ->
  made e v (affine_within _ F limit v error g) x g.
Proof.
  intros K. unfold affine_within. destruct (at_most _ F zero error) eqn:C;
    [| apply always_made; intros; apply unknown_known].
  apply finished_known with f. intros FV FB. apply add_left_fine in FB. destruct FB as (FE & _ & ->).
  destruct zero_is_0 as [Z0 Z]. rewrite (at_most_finite p emax), Z in C by auto. revert C.
  case Rle_bool_spec; [| discriminate]. intros P _. rewrite nothing_real.
  apply (Affine.affine_within_sound p emin p_4 emin_below); auto using number_B2R.
Qed.
Theorem affine_negate_known v A x : affine_known e v A x -> affine_known e (opposite _ F v) (affine_negate _ F A) (- x).
Proof.
  intros [KR K]. split; [now apply (tight_negate_known p emax) |]. intros FR FP.
  assert (FP' : all_finite (parts A)).
  { apply Forall_forall. intros t T. apply (opposite_finite p emax).
    apply (proj1 (Forall_forall _ _) FP (fst t, opposite _ F (snd t))). apply in_map_iff. now exists t. }
  destruct (K FR FP') as [FD H]. split; auto. rewrite opposite_value.
  replace (real_bound (affine_negate _ F A)) with (Affine.negated (real_bound A)).
  - now apply Affine.affine_negate_sound.
  - unfold Affine.negated, real_bound, affine_negate, real_terms.
    cbn [AffineCode.radius AffineCode.rest AffineCode.parts Affine.radius Affine.rest Affine.of].
    f_equal. rewrite !map_map. apply map_ext. intros t. cbn [fst snd]. now rewrite opposite_value.
Qed.

(** Hypotheses on two operands. *)
Context (a b : float) (sa sb : affine) (x y : R) (of_a : affine_known e a sa x) (of_b : affine_known e b sb y)
  (new_a : is_new f sa) (new_b : is_new f sb).

Lemma sum_known v : (finite v -> finite a /\ finite b /\ B2R v = fl (B2R a + B2R b)) ->
  made e v (affine_add _ F limit v a sa b sb g) (x + y) g.
Proof.
  intros V. unfold affine_add. cbv zeta. apply finished_known with f. intros FV FB.
  destruct (V FV) as (FA & FB' & ->). apply add_left_fine in FB. destruct FB as (RB & FB & ->).
  apply add_left_fine in FB. destruct FB as (RA & FB & ->).
  apply (fold_backward fine fine_pair real real_pair _ (Affine.sum_step p emin)) in FB; [| apply sum_step_fine].
  destruct FB as (FB & FM & ->). destruct (merged_real (parts sa) (parts sb)) as [-> M]. destruct (M FM) as [PA PB].
  apply add_left_fine in FB. destruct FB as (FE & _ & ->). apply abs_value in FE. destruct FE as [FE ->].
  apply (IeeeResidual.two_sum_finite p emax) in FE. destruct FE as (_ & _ & _ & ->). rewrite nothing_real.
  destruct (proj2 of_a RA PA) as [_ HA], (proj2 of_b RB PB) as [_ HB].
  apply (Affine.affine_add_sound p emin p_4 emin_below e f e_units _ _ _ _ _ _ HA HB); auto; now apply real_new.
Qed.
Theorem affine_add_known : made e (a ⊕ b) (affine_add _ F limit (a ⊕ b) a sa b sb g) (x + y) g.
Proof. apply sum_known. apply plus_finite. Qed.

(** A value that is certainly zero. *)
Lemma exact_zero_known v sv z : affine_known e v sv z -> is_exact_zero _ F v sv = true -> B2R v = 0 /\ z = 0.
Proof.
  intros [[_ K] _] H. apply andb_prop in H. destruct H as [H1 H2]. apply equals_zero in H1, H2.
  destruct H1 as [_ V], H2 as [FR R]. destruct (K FR) as [_ D]. rewrite V, R in D. split; auto.
  apply Rabs_le_inv in D. lra.
Qed.
Lemma zero_made v : (finite v -> B2R v = 0) -> made e v (affine_exact _ F v) 0 g.
Proof.
  intros Z. apply always_made. intros e'. destruct (BinarySingleNaN.is_finite v) eqn:FV.
  - rewrite <- (Z eq_refl). apply affine_exact_known.
  - assert (N : ~ finite (v ⊖ v)) by (intros H; apply minus_finite in H; destruct H as [H _]; congruence).
    split; [| intros H; now destruct N]. split; [apply nonnegative_nothing; auto; lia | intros H; now destruct N].
Qed.
Lemma is_exact_zero_real v sv r l : finite v -> finite (radius sv) -> is_exact_zero _ F v sv =
  Affine.is_zero (B2R v) {| Affine.radius := B2R (radius sv); Affine.rest := r; Affine.of := l |}.
Proof. intros FV FR. unfold is_exact_zero, Affine.is_zero. cbn [Affine.radius]. now rewrite !equal_zero. Qed.
Theorem affine_multiply_known : made e (a ⊗ b) (affine_multiply _ F fused limit (a ⊗ b) a sa b sb g) (x * y) g.
Proof.
  unfold affine_multiply. destruct (is_exact_zero _ F a sa || is_exact_zero _ F b sb) eqn:CZ.
  { assert (P : x * y = 0 /\ (B2R a = 0 \/ B2R b = 0)).
    { apply orb_prop in CZ. destruct CZ as [C | C].
      - destruct (exact_zero_known _ _ _ of_a C) as [A ->]. split; [ring | auto].
      - destruct (exact_zero_known _ _ _ of_b C) as [B ->]. split; [ring | auto]. }
    destruct P as [-> P]. apply zero_made. intros H. now apply (zero_times p emax). }
  cbv zeta. apply finished_known with f. intros FV FB.
  destruct (times_finite p emax _ _ FV) as (FA & FB' & EV). rewrite EV.
  apply add_left_fine in FB. destruct FB as (F3 & FB & ->).
  apply add_left_fine in FB. destruct FB as (F2 & FB & ->).
  apply add_left_fine in FB. destruct FB as (F1 & FB & ->).
  apply (fold_backward fine fine_pair real real_pair _ (Affine.product_step p emin (B2R a) (B2R b))) in FB;
    [| apply product_step_fine].
  destruct FB as (FB & FM & ->). destruct (merged_real (parts sa) (parts sb)) as [-> M]. destruct (M FM) as [PA PB].
  apply add_left_fine in FB. destruct FB as (FE & _ & ->). rewrite nothing_real.
  assert (AA := abs_value _ (abs_finite_intro p emax _ FA)). assert (AB := abs_value _ (abs_finite_intro p emax _ FB')).
  destruct AA as [_ AA], AB as [_ AB].
  apply orb_false_iff in CZ. destruct CZ as [CA CB].
  destruct (product_finite (abs _ F a) (rest sb) _ _ (fun _ => eq_refl) (fun _ => eq_refl) F1) as [_ D1].
  destruct (product_finite (rest sa) (abs _ F b) _ _ (fun _ => eq_refl) (fun _ => eq_refl) F2) as [_ D2].
  destruct (product_finite (radius sa) (radius sb) _ _ (fun _ => eq_refl) (fun _ => eq_refl) F3) as [_ D3].
  rewrite AA in D1. rewrite AB in D2.
  assert (Rests : (finite (rest sb) -> finite (radius sb)) /\ (finite (rest sa) -> finite (radius sa))).
  { split; intros H; [now apply of_b | now apply of_a]. }
  assert (Zero : forall v s, finite v -> is_exact_zero _ F v s = false -> Rabs (B2R v) = 0 -> finite (radius s) ->
      B2R (radius s) = 0 -> False).
  { intros v s FV' C V FR R. revert C. unfold is_exact_zero. rewrite !equal_zero, R by auto.
    rewrite !Req_bool_true; [discriminate | auto |]. destruct (Req_dec (B2R v) 0); auto. now apply Rabs_no_R0 in V. }
  assert (Radii : finite (radius sa) /\ finite (radius sb)).
  { destruct D3 as [? | [[G1 G2] | [G1 G2]]]; auto; split; auto.
    - destruct D1 as [[_ H] | [[_ H] | [H _]]]; try now apply Rests. now destruct (Zero a sa).
    - destruct D2 as [[H _] | [[H _] | [_ H]]]; try now apply Rests. now destruct (Zero b sb). }
  destruct Radii as [RA RB].
  destruct (known_within _ _ _ of_a RA PA) as (ra & TA & _ & HA), (known_within _ _ _ of_b RB PB) as (rb & TB & _ & HB).
  destruct (product_finite (abs _ F a) (rest sb) _ _ (fun _ => AA) TB F1) as [-> _].
  destruct (product_finite (rest sa) (abs _ F b) _ _ TA (fun _ => AB) F2) as [-> _].
  destruct (product_finite (radius sa) (radius sb) _ _ (fun _ => eq_refl) (fun _ => eq_refl) F3) as [-> _].
  set (known := product_error_is_exact _ F fused a b (two_product _ F fused a b)) in *.
  set (error := snd (two_product _ F fused a b)) in *.
  assert (T := Affine.affine_multiply_sound p emin p_4 emin_below e f e_units _ _ _ _ _ _ HA HB (real_new _ new_a _ _)
    (real_new _ new_b _ _) limit g g_f (if known then Some (B2R error) else None)).
  unfold Affine.affine_multiply in T. rewrite <- !is_exact_zero_real, CA, CB in T by auto. cbn [orb] in T.
  cbn [Affine.radius Affine.rest Affine.of] in T.
  destruct known eqn:CK.
  - apply (IeeeInterval.product_known p emax at_least_3) in CK. destruct CK as (_ & _ & _ & _ & E & _). rewrite EV in E.
    apply abs_value in FE. destruct FE as [_ ->]. apply T. intros k [= <-]. split; [apply number_B2R | exact E].
  - apply half_ulp_value in FE. destruct FE as [_ ->]. rewrite EV. apply T. discriminate.
Qed.

Theorem affine_divide_known :
  made e (a ⊘ b) (affine_divide _ F fused limit (a ⊘ b) a sa b sb g) (x / y) g /\
  (finite (radius (affine_divide _ F fused limit (a ⊘ b) a sa b sb g)) -> y <> 0).
Proof.
  unfold affine_divide. cbv zeta. set (d := abs _ F b ⊖ radius sb).
  destruct (less _ F zero (d ⊗ (integer _ F 1 ⊖ epsilon _ F))) eqn:C; cbn [negb];
    [| split; [apply always_made; intros; apply unknown_known | discriminate]].
  destruct (distance_positive p emax at_least_3 b (radius sb) y (proj1 of_b) (less_of_shrunk _ C))
    as (FB & RB & FD & PD & NB & NY).
  fold d in FD, PD. split; [| auto].
  assert (FQ := shrunk_finite d FD). destruct (times_finite p emax _ _ FQ) as (_ & _ & EQ).
  rewrite (proj1 (proj2 shrinking_value)) in EQ. set (distance := d ⊗ _) in *.
  assert (PQ : 0 < B2R distance).
  { revert C. destruct zero_is_0 as [Z0 Z]. rewrite (less_finite p emax), Z by auto. now case Rlt_bool_spec. }
  assert (ED : B2R d = fl (Rabs (B2R b) - B2R (radius sb))).
  { destruct (minus_finite _ _ _ _ FD) as (FAB & _ & E). apply abs_value in FAB. now rewrite (proj2 FAB) in E. }
  rewrite ED in EQ.
  assert (AB := abs_value _ (abs_finite_intro p emax _ FB)). destruct AB as [_ AB].
  destruct (is_exact_zero _ F a sa) eqn:CZ.
  { destruct (exact_zero_known _ _ _ of_a CZ) as [A ->]. unfold Rdiv. rewrite Rmult_0_l. apply zero_made.
    now apply (zero_over p emax). }
  assert (KR := IeeeInterval.remainder_known p emax at_least_3 fused a b).
  destruct (remainder_of_division _ F fused a b (a ⊘ b)) as [remainder known]. cbn [fst snd] in KR.
  set (r0 := if known then nothing _ F else add_left _ F (half_ulp _ F (a ⊘ b)) (nothing _ F)).
  set (left0 := upper_sum _ F (upper_product _ F (abs _ F (a ⊘ b)) (rest sb)) (rest sa)).
  set (left1 := if known then upper_sum _ F left0 (abs _ F remainder) else left0).
  destruct (fold_left (quotient_step _ F (a ⊘ b) b) (merged _ F (parts sa) (parts sb)) (left1, r0))
    as [left2 r2] eqn:Fold.
  set (r3 := add_left _ F (upper_quotient _ F left2 (abs _ F b)) r2).
  set (quotient := upper_sum _ F (radius_of _ F r3) (fst r3)).
  apply finished_known with f. intros FV FB'.
  destruct (over_finite p emax _ _ FB NB FV) as [FA EV].
  assert (G3 : fine r3 /\
    real (if less _ F zero (radius sb)
          then add_left _ F (upper_quotient _ F (upper_product _ F quotient (radius sb)) distance) r3 else r3) =
    if Rlt_bool 0 (B2R (radius sb))
    then Affine.add_left p emin (Affine.upper_quotient p emin (Affine.upper_product p emin
           (Affine.upper_sum p emin (Affine.radius_of p emin (real r3)) (fst (real r3)))
           (B2R (radius sb))) (B2R distance)) (real r3)
    else real r3).
  { assert (L : less _ F zero (radius sb) = Rlt_bool 0 (B2R (radius sb))).
    { destruct zero_is_0 as [Z0 Z]. now rewrite (less_finite p emax), Z. }
    revert FB'. rewrite L. destruct (Rlt_bool _ _); intros G; auto. apply add_left_fine in G.
    destruct G as (GQ & G & ->). split; auto. apply quotient_finite in GQ; auto; [| lra]. destruct GQ as [GP ->].
    destruct (product_finite quotient (radius sb)
      (Affine.upper_sum p emin (Affine.radius_of p emin (real r3)) (fst (real r3))) (B2R (radius sb))) as [-> _]; auto.
    intros GS. unfold quotient in *. apply sum_finite in GS. destruct GS as (GR & _ & ->). apply radius_finite in GR.
    destruct GR as [_ ->]. reflexivity. }
  destruct G3 as [G3 ->]. apply add_left_fine in G3. fold r3 in G3. destruct G3 as (GQ & G2 & E3).
  rewrite E3. clear quotient E3 r3 FB'.
  apply quotient_finite in GQ; [| now apply abs_finite_intro | rewrite AB; now apply Rabs_no_R0].
  destruct GQ as [GL ->]. rewrite AB.
  destruct (fold_backward fine_quotient fine_pair real_quotient real_pair (quotient_step _ F (a ⊘ b) b)
    (Affine.quotient_step p emin (B2R (a ⊘ b)) (B2R b)))
    with (l := merged _ F (parts sa) (parts sb)) (s := (left1, r0)) as (G0 & FM & EF).
  { intros r t. now apply quotient_step_fine. }
  { rewrite Fold. now split. }
  rewrite Fold in EF. destruct (merged_real (parts sa) (parts sb)) as [EM M].
  rewrite EM in EF. destruct (M FM) as [PA PB].
  destruct G0 as [GL1 G0]. cbn [fst snd] in GL1, G0.
  assert (G1 : finite left0 /\ (known = true -> finite remainder) /\ B2R left1 =
      match (if known then Some (B2R remainder) else None) with
      | Some r => Affine.upper_sum p emin (B2R left0) (Rabs r)
      | None => B2R left0
      end /\
      real r0 = match (if known then Some (B2R remainder) else None) with
      | Some _ => Affine.nothing
      | None => Affine.add_left p emin (Residual.half_ulp p emin (B2R (a ⊘ b))) Affine.nothing
      end).
  { revert GL1 G0. unfold left1, r0. destruct known.
    - intros H _. apply sum_finite in H. destruct H as (H1 & H2 & ->). apply abs_value in H2. destruct H2 as [H2 ->].
      rewrite nothing_real. auto.
    - intros H G. apply add_left_fine in G. destruct G as (G & _ & ->). apply half_ulp_value in G. destruct G as [_ ->].
      rewrite nothing_real. repeat split; auto. discriminate. }
  destruct G1 as (GL0 & _ & E1 & E0). apply sum_finite in GL0. destruct GL0 as (GP & RR & E2).
  destruct (proj2 of_a RR PA) as [RA HA]. destruct (known_within _ _ _ of_b RB PB) as (rb & TB & _ & HB).
  assert (AV := abs_value _ (abs_finite_intro p emax _ FV)). destruct AV as [_ AV].
  destruct (product_finite _ _ _ _ (fun _ => AV) TB GP) as [E4 _]. rewrite E4 in E2. fold left0 in E2.
  assert (T := Affine.affine_divide_sound p emin p_4 emin_below e f e_units _ _ _ _ _ _ HA HB (real_new _ new_a _ _)
    (real_new _ new_b _ _) limit g g_f (if known then Some (B2R remainder) else None)).
  unfold Affine.affine_divide in T. cbv zeta in T. cbn [Affine.radius Affine.rest Affine.of real_bound] in T.
  rewrite <- EQ, Rlt_bool_true in T by auto. cbn [negb] in T.
  unfold real_bound in T. rewrite <- is_exact_zero_real, CZ in T by auto.
  rewrite <- EV, <- E2, <- E1, <- E0 in T. unfold real_quotient in EF at 2. cbn [fst snd] in EF. rewrite <- EF in T.
  cbn [real_quotient fst snd] in T. refine (proj2 (T _ _ eq_refl)).
  intros k K. destruct known; [| discriminate]. injection K as <-. split; [apply number_B2R | now apply KR].
Qed.
Theorem affine_scale_known k :
  made e (scale _ F a k) (affine_scale _ F limit (scale _ F a k) a sa k g) (x * bpow radix2 k) g.
Proof.
  unfold affine_scale. cbv zeta. apply finished_known with f. intros FV FB.
  destruct (scale_finite p emax _ _ FV) as [FA EV].
  apply add_left_fine in FB. destruct FB as (_ & FB & ->).
  apply add_left_fine in FB. destruct FB as (FS & FB & ->). destruct (scale_finite p emax _ _ FS) as [FR ES].
  rewrite (proj2 (lost_real _ _ k FS FR)), ES.
  apply (fold_backward fine (fun t => finite (snd t)) real (fun t => (fst t, B2R (snd t))) _
    (Affine.scale_step p emin k)) in FB; [| apply scale_step_fine].
  destruct FB as (FB & FP & ->). apply add_left_fine in FB. destruct FB as (_ & _ & ->). rewrite nothing_real.
  rewrite (proj2 (lost_real _ _ k FV FA)), EV. destruct (proj2 of_a FR FP) as [_ HA].
  apply (Affine.affine_scale_sound p emin p_4 emin_below e f e_units _ _ _ HA (real_new _ new_a _ _) limit g g_f).
Qed.
End Operation.

Theorem affine_subtract_known e f a b sa sb x y : Affine.units e -> affine_known e a sa x -> affine_known e b sb y ->
  is_new f sa -> is_new f sb -> forall g, g = Some f \/ g = None ->
  made e (a ⊖ b) (affine_subtract _ F limit (a ⊖ b) a sa b sb g) (x - y) g.
Proof.
  intros U KA KB NA NB g G. unfold affine_subtract, Rminus. apply sum_known with f; auto.
  - now apply affine_negate_known.
  - unfold is_new, affine_negate. cbn [AffineCode.parts]. apply Forall_forall. intros t T. apply in_map_iff in T.
    destruct T as (s & <- & S). exact (proj1 (Forall_forall _ _) NB s S).
  - intros H. apply minus_finite in H. destruct H as (FA & FB & E). rewrite opposite_value. split; auto. split; auto.
    simpl. now rewrite is_finite_Bopp.
Qed.
(** Bounds still hold if the number's sources have the same numbers. *)
Theorem affine_known_stays e e' v A x : (forall s t, In (s, t) (parts A) -> e' s = e s) ->
  affine_known e v A x -> affine_known e' v A x.
Proof.
  intros S [KR K]. split; auto. intros FR FP. destruct (K FR FP) as (FD & N & NA & (R1 & R2 & R) & D). split; auto.
  repeat (split; auto). cbn [Affine.of real_bound] in R |- *. replace (Affine.sum_of e' (real_terms (parts A))) with
    (Affine.sum_of e (real_terms (parts A))); [exact R |].
  clear - S. induction (parts A) as [| [s t] l IH]; [reflexivity |].
  cbn [real_terms map Affine.sum_of fold_right fst snd]. rewrite (S s t) by now left.
  f_equal. apply IH. intros q w Q. apply S with w. now right.
Qed.
Theorem affine_error_known e v A x : affine_known e v A x -> known v (radius A) x.
Proof. intros K. apply K. Qed.

End Rules.
