(** Whole computations by the rule `affine` over IEEE formats, including overflow: AffineCode.v's operations, each
    with a source or none, and functions of tracked numbers (functions.hpp). p >= 4, emax > p, to nearest, any limit
    on terms. Results:
        affine_promises, affine_keeps_operations   without sources, IeeeFunctions.v and IeeeCompound.v apply
        next_known, computed_known, computed_error   an assignment of the sources' numbers that makes all numbers
            known has
            an extension after each operation; for numbers made of nothing, the radius is an error
        affine_midpoint_gives, affine_min_gives, affine_max_gives, affine_pow_gives, affine_dot_gives,
        affine_horner_gives, affine_copysign_gives, affine_sqrt_gives, affine_abs_gives, affine_fma_gives,
        affine_lerp_gives, and from p = 8 on affine_hypot_gives
            `gives l k m r`: from numbers of l, after k operations, m computes a number that stands for r
        gives_known, gives_error   it is known by an assignment as in next_known, and its radius is an error *)

From Coq Require Import Reals ZArith Lia Lra Bool List.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code CompoundCode AffineCode NumberedCode Ieee IeeeRules IeeeAffine IeeeFunctions
  IeeeCompound.
From Errbound Require Format Tight Functions Affine DotProduct Compound.
Import ListNotations.
Open Scope R_scope.

(** A result's sources are those of its operands, and its own. *)
Section Sources.

Context (T : Type) (A : arithmetic T) (fused : bool) (limit : nat) (P : Z -> Prop).

Definition all_from {X} (l : list (Z * X)) : Prop := Forall (fun t => P (fst t)) l.
Lemma add_from s c (B : builder T) : P s -> all_from (snd B) -> all_from (snd (add T A s c B)).
Proof.
  intros S H. unfold add. destruct (equal T A c _); auto. cbn [snd]. apply Forall_app. split; auto.
Qed.
Lemma least_from t l : P (fst t) -> all_from l -> P (fst (fst (least T A t l))) /\ all_from (snd (least T A t l)).
Proof.
  revert t. induction l as [| x l IH]; intros t H L; [simpl; auto |]. inversion L. subst. cbn [least].
  destruct (IH x) as [HM HR]; auto. destruct (least T A x l) as [m r].
  destruct (less T A _ _); cbn [fst snd] in *; auto.
  split; auto. now constructor.
Qed.
Lemma shorten_from fuel (B : builder T) : all_from (snd B) -> all_from (snd (shorten T A limit fuel B)).
Proof.
  revert B. induction fuel as [| n IH]; intros B H; cbn [shorten]; auto. destruct (snd B) as [| t l] eqn:E.
  - now rewrite E.
  - destruct (limit <=? _)%nat; [| now rewrite E]. inversion H. subst. destruct (least_from t l) as [_ L]; auto.
    destruct (least T A t l) as [m r]. now apply IH.
Qed.
Lemma placed_from t l : P (fst t) -> all_from l -> all_from (placed T t l).
Proof.
  intros H. induction 1 as [| x l X L IH]; cbn [placed]; [repeat constructor; auto |].
  destruct (fst t <? fst x)%Z; constructor; auto.
Qed.
Lemma finished_from v (B : builder T) g : all_from (snd B) -> (forall s, g = Some s -> P s) ->
  all_from (parts T (finished T A limit v B g)).
Proof.
  intros H G. unfold finished. cbv zeta. destruct (_ || _); [constructor |].
  set (C := if (_ <? _)%nat then _ else B). assert (HC : all_from (snd C)).
  { unfold C. destruct (_ <? _)%nat; auto. now apply shorten_from. }
  destruct (equal T A (fst C) _); auto. destruct g as [s |]; auto. apply Forall_rev, placed_from; [now apply G |].
  now apply Forall_rev.
Qed.
Lemma merged_from a b : all_from a -> all_from b -> all_from (merged T A a b).
Proof.
  revert b. induction a as [| [s x] a IHa].
  - induction b as [| [t y] b IH]; intros HA HB; [constructor |]. inversion HB. constructor; [easy | now apply IH].
  - induction b as [| [t y] b IH]; intros HA HB; inversion HA as [| ? ? H1 H2]; subst.
    + constructor; [easy | now apply IHa].
    + inversion HB. subst. cbn [merged]. destruct (s <? t)%Z; [| destruct (t <? s)%Z];
        (constructor; [easy |]); [now apply IHa | now apply IH | now apply IHa].
Qed.
Lemma fold_from {S X} (read : S -> terms T) (step : S -> Z * X -> S) :
  (forall s t, P (fst t) -> all_from (read s) -> all_from (read (step s t))) ->
  forall l s, all_from l -> all_from (read s) -> all_from (read (fold_left step l s)).
Proof. intros H. induction l as [| t l IH]; intros s L R; simpl; auto. inversion L. subst. auto. Qed.

Lemma negate_from b : all_from (parts T b) -> all_from (parts T (affine_negate T A b)).
Proof. intros H. unfold affine_negate. cbn [parts]. apply Forall_map. exact H. Qed.
Context (g : option Z) (own : forall s, g = Some s -> P s).
Lemma within_from v error : all_from (parts T (affine_within T A limit v error g)).
Proof. unfold affine_within. destruct (negb _); [constructor |]. apply finished_from; auto. constructor. Qed.
Context (sa sb : affine T) (of_a : all_from (parts T sa)) (of_b : all_from (parts T sb)).
Lemma sum_from v a b : all_from (parts T (affine_add T A limit v a sa b sb g)).
Proof.
  unfold affine_add. cbv zeta. apply finished_from; auto. unfold add_left at 1 2. cbn [snd].
  apply (fold_from snd); [| now apply merged_from | constructor]. intros B t H R. unfold sum_step. cbv zeta.
  unfold add_left. cbn [snd]. now apply add_from.
Qed.
Lemma product_from v a b : all_from (parts T (affine_multiply T A fused limit v a sa b sb g)).
Proof.
  unfold affine_multiply. cbv zeta. destruct (_ || _); [constructor |]. apply finished_from; auto.
  unfold add_left at 1 2 3. cbn [snd]. apply (fold_from snd); [| now apply merged_from | constructor].
  intros B t H R. unfold product_step. cbv zeta. unfold add_left at 1. cbn [snd].
  do 2 (destruct (_ || _); unfold add_left; cbn [snd]); now apply add_from.
Qed.
Lemma quotient_from v a b : all_from (parts T (affine_divide T A fused limit v a sa b sb g)).
Proof.
  unfold affine_divide. cbv zeta. destruct (negb _); [constructor |]. destruct (is_exact_zero _ _ _ _); [constructor |].
  destruct (remainder_of_division _ _ _ _ _ _) as [remainder known].
  match goal with |- context [fold_left ?f ?l ?s] =>
    assert (H : all_from (snd (snd (fold_left f l s)))); [| destruct (fold_left f l s) as [left r]] end.
  - apply (fold_from (fun s => snd (snd s))); [| now apply merged_from |].
    + intros B t H R. unfold quotient_step. cbv zeta. cbn [snd].
      destruct (equal _ _ _ _); unfold add_left; cbn [snd]; now apply add_from.
    + cbn [snd]. destruct known; constructor.
  - apply finished_from; auto. destruct (less _ _ _ _); exact H.
Qed.
Lemma scaled_from v a e : all_from (parts T (affine_scale T A limit v a sa e g)).
Proof.
  unfold affine_scale. cbv zeta. apply finished_from; auto. unfold add_left at 1 2. cbn [snd].
  apply (fold_from snd); [| exact of_a | constructor]. intros B t H R. unfold scale_step. cbv zeta.
  unfold add_left. cbn [snd]. now apply add_from.
Qed.
End Sources.

Section Functions.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_4 : (4 <= p)%Z).
Variable fused : bool.  (* has_fast_fma *)
Variable limit : nat.
Notation float := (binary_float p emax).
Notation F := (floats p emax).
Notation emin := (3 - emax - p)%Z.
Notation affine := (affine float).
Notation radius := (radius float).
Notation parts := (parts float).
Notation known := (known p emax).
Notation affine_known := (affine_known p emax).
Notation is_new := (is_new p emax).
Notation made := (made p emax).
Notation p_3 := (at_least_3 p p_4).
Notation by_rule := (affine_operations float F fused limit).
Notation rule := (affine_rule float F limit).
Notation number := (float * affine)%type.

Lemma known_alike e a c A x : finite a -> finite c -> B2R a = B2R c -> affine_known e a A x -> affine_known e c A x.
Proof.
  intros FA FC E [KR K]. split; [now apply (known_same p emax) with a |]. now rewrite <- E.
Qed.
(** There is always another source. *)
Lemma another (l : list Z) : exists f, forall s, In s l -> s <> f.
Proof.
  exists (1 + fold_right Z.max 0 l)%Z. intros s H ->. revert H.
  assert (L : forall m, In m l -> (m <= fold_right Z.max 0 l)%Z).
  { induction l as [| t l IH]; simpl; [easy |]. intros m [-> | H]; [| apply IH in H]; lia. }
  intros H. apply L in H. lia.
Qed.
Definition sources (A : affine) : list Z := map fst (parts A).
Lemma new_intro f A : (forall s, In s (sources A) -> s <> f) -> is_new f A.
Proof. intros H. apply Forall_forall. intros t T. apply H. now apply in_map. Qed.

(** Without sources: results for any numbers of the operands' sources. *)
Section Without_sources.

Context (e : Z -> R) (e_units : Affine.units e).

Lemma new_to_both A B : exists f, is_new f A /\ is_new f B.
Proof.
  destruct (another (sources A ++ sources B)) as [f H]. exists f.
  split; apply new_intro; intros s S; apply H, in_or_app; auto.
Qed.
Theorem affine_promises : promises p emax affine (rule None) (affine_known e).
Proof.
  split; cbn [affine_rule rule_exact rule_within rule_error rule_subtract rule_negate rule_sign].
  - intros a. now apply affine_exact_known.
  - intros a error x K. now apply (affine_within_known p emax p_4 limit e e_units 0 None (or_intror eq_refl)).
  - intros a b x K. apply K.
  - intros a sa x b sb y KA KB. destruct (new_to_both sa sb) as (f & NA & NB).
    now apply (affine_subtract_known p emax p_4 limit e f a b sa sb x y e_units KA KB NA NB None (or_intror eq_refl)).
  - intros a b x K. now apply affine_negate_known.
  - intros a b x K. apply (sign_of_known p emax p_3). apply K.
Qed.
Lemma quotient_of_any v A x y g : made e v A (x / y) g /\ (finite (radius A) -> y <> 0) ->
  forall t, y = 0 \/ t = x / y -> made e v A t g.
Proof.
  intros [M N] t [Y | ->]; [| exact M].
  assert (K : forall e', affine_known e' v A (x / y) -> affine_known e' v A t).
  { intros e' [[P K] L]. split; [split; [exact P |] |]; intros H.
    - now apply N in H.
    - intros H'. destruct (L H H') as [FR _]. now apply N in FR. }
  destruct g as [f |]; [destruct M as (n & U & M); exists n; auto | now apply K].
Qed.
Theorem affine_keeps_operations : keeps_operations p emax affine (by_rule None) (affine_known e).
Proof.
  split; cbn [affine_operations the_rule rule_add rule_multiply rule_divide rule_scale].
  - apply affine_promises.
  - intros a sa x b sb y KA KB. destruct (new_to_both sa sb) as (f & NA & NB).
    apply (affine_add_known p emax p_4 limit e e_units f None (or_intror eq_refl) a b sa sb x y KA KB NA NB).
  - intros a sa x b sb y KA KB. destruct (new_to_both sa sb) as (f & NA & NB).
    apply (affine_multiply_known p emax p_4 fused limit e e_units f None (or_intror eq_refl) a b sa sb x y KA KB NA NB).
  - intros divide a sa x b sb y [= <-] KA KB t Q. destruct (new_to_both sa sb) as (f & NA & NB).
    apply (quotient_of_any _ _ x y None); auto.
    apply (affine_divide_known p emax p_4 fused limit e e_units f None (or_intror eq_refl) a b sa sb x y KA KB NA NB).
  - intros a sa x k KA. destruct (new_to_both sa sa) as (f & NA & _).
    apply (affine_scale_known p emax p_4 limit e e_units f None (or_intror eq_refl) a sa x KA NA).
  - intros a c b x. apply known_alike.
Qed.

End Without_sources.

(** Numbers made one after the other, each with its real number. *)
Definition list_of_numbers : Type := list (number * R).
Definition unused (f : Z) (l : list_of_numbers) : Prop := forall n x, In (n, x) l -> is_new f (snd n).
Definition used (l : list_of_numbers) (s : Z) : Prop := exists n x, In (n, x) l /\ In s (sources (snd n)).
(** A new source, if any. *)
Definition unused_source (g : option Z) (l : list_of_numbers) : Prop := forall f, g = Some f -> unused f l.

(** Results of an operation on numbers of the list, or of a function that ends in one, with g as the new source. *)
Inductive result (g : option Z) (l : list_of_numbers) : number -> R -> Prop :=
| of_exactly v : result g l (tracked_exactly _ _ (rule g) v) (B2R v)
| of_within v error x : (finite error -> 0 <= B2R error -> Rabs (B2R v - x) <= B2R error) ->
    result g l (tracked_within _ _ (rule g) v error) x
| of_alike a c A x : finite a -> finite c -> B2R a = B2R c -> In ((a, A), x) l -> result g l (c, A) x
| of_negate a x : In (a, x) l -> result g l (tracked_negate _ F _ (rule g) a) (- x)
| of_add a x b y : In (a, x) l -> In (b, y) l -> result g l (tracked_add _ F _ (by_rule g) a b) (x + y)
| of_subtract a x b y : In (a, x) l -> In (b, y) l -> result g l (tracked_subtract _ F _ (rule g) a b) (x - y)
| of_multiply a x b y : In (a, x) l -> In (b, y) l -> result g l (tracked_multiply _ F _ (by_rule g) a b) (x * y)
| of_divide a x b y t : In (a, x) l -> In (b, y) l -> y = 0 \/ t = x / y -> let v := fst a ⊘ fst b in
    result g l (v, affine_divide _ F fused limit v (fst a) (snd a) (fst b) (snd b) g) t
| of_scale a x k : In (a, x) l -> result g l (tracked_scale _ F _ (by_rule g) a k) (x * bpow radix2 k)
| of_sqrt a x : In (a, x) l -> result g l (tracked_sqrt _ F fused _ (rule g) a) (sqrt x)
| of_abs a x : In (a, x) l -> result g l (tracked_abs _ F _ (rule g) a) (Rabs x)
| of_fma a x b y c z : In (a, x) l -> In (b, y) l -> In (c, z) l ->
    result g l (tracked_fma _ F _ (rule g) a b c) (x * y + z)
| of_lerp a x b y c z : In (a, x) l -> In (b, y) l -> In (c, z) l ->
    result g l (tracked_lerp _ F _ (by_rule g) a b c) ((1 - z) * x + z * y)
| of_hypot exponent a x b y : (8 <= p)%Z ->
    (forall v, finite v -> B2R v <> 0 -> bpow radix2 (exponent v - 1) <= Rabs (B2R v) < bpow radix2 (exponent v)) ->
    In (a, x) l -> In (b, y) l -> result g l (tracked_hypot _ F _ (by_rule g) exponent a b) (sqrt (x * x + y * y)).
(** Any sequence of them, each with a source that no earlier number has, or with none. *)
Inductive computed (from : list_of_numbers) : list_of_numbers -> Prop :=
| nothing_more : computed from from
| one_more g l n x : computed from l -> unused_source g l -> result g l n x -> computed from ((n, x) :: l).

Definition all_known (e : Z -> R) (l : list_of_numbers) : Prop :=
  Affine.units e /\ forall n x, In (n, x) l -> affine_known e (fst n) (snd n) x.

(** Operations with at most one source: the others give unknown numbers. *)
Definition last_operation (g : option Z) : operations float affine := {|
  the_rule := {|
    rule_exact := affine_exact _ F;
    rule_within v error := affine_within _ F limit v error g;
    rule_error _ b := radius b;
    rule_subtract _ _ _ _ _ := unknown_number _ F;
    rule_negate := affine_negate _ F;
    rule_sign v b := sign_of _ F v (radius b)
  |};
  rule_add _ _ _ _ _ := unknown_number _ F;
  rule_multiply _ _ _ _ _ := unknown_number _ F;
  rule_divide := None;
  rule_scale _ _ _ _ := unknown_number _ F
|}.
Ltac only_last := unfold tracked_within, tracked_exactly, tracked_error, tracked_negate, tracked_sign, last_operation;
  cbn [affine_operations affine_rule the_rule rule_exact rule_within rule_error rule_negate rule_sign]; reflexivity.
Notation last_rule g := (the_rule _ _ (last_operation g)).
(** A finite error is the rule's own. *)
Lemma finite_error R x : finite (tracked_error float F affine R x) ->
  tracked_error _ F _ R x = rule_error _ _ R (fst x) (snd x).
Proof. unfold tracked_error. cbv zeta. destruct equal; [reflexivity | discriminate]. Qed.
Lemma last_sqrt g a : tracked_sqrt _ F fused _ (last_rule g) a = tracked_sqrt _ F fused _ (rule g) a.
Proof. unfold tracked_sqrt. only_last. Qed.
Lemma last_abs g a : tracked_abs _ F _ (last_rule g) a = tracked_abs _ F _ (rule g) a.
Proof. unfold tracked_abs. only_last. Qed.
Lemma last_fma g a b c : tracked_fma _ F _ (last_rule g) a b c = tracked_fma _ F _ (rule g) a b c.
Proof. unfold tracked_fma. only_last. Qed.
Lemma last_lerp g a b c : tracked_lerp _ F _ (last_operation g) a b c = tracked_lerp _ F _ (by_rule g) a b c.
Proof. unfold tracked_lerp. only_last. Qed.
Lemma last_hypot exponent g a b :
  tracked_hypot _ F _ (last_operation g) exponent a b = tracked_hypot _ F _ (by_rule g) exponent a b.
Proof. unfold tracked_hypot. only_last. Qed.
Lemma some_source (g : option Z) : exists f, g = Some f \/ g = None.
Proof. destruct g as [f |]; [exists f | exists 0%Z]; auto. Qed.
Lemma made_map e g v A x w B y : (forall e', affine_known e' v A x -> affine_known e' w B y) ->
  made e v A x g -> made e w B y g.
Proof. intros H. destruct g as [f |]; [intros (t & U & M); exists t; auto | apply H]. Qed.
Lemma made_error e g v A x : made e v A x g -> known v (radius A) x.
Proof. destruct g as [f |]; [intros (t & _ & M) | intros M]; apply M. Qed.
Lemma made_of_known e g v A x : Affine.units e -> affine_known e v A x -> made e v A x g.
Proof.
  intros U K. destruct g as [f |]; [| exact K]. exists (e f). split; [apply U |].
  apply affine_known_stays with e; auto. intros s _ _. unfold Affine.set. now destruct (Z.eqb_spec s f) as [-> |].
Qed.
Lemma last_operation_keeps e g : Affine.units e ->
  keeps_operations p emax affine (last_operation g) (fun v A x => made e v A x g).
Proof.
  intros U. assert (N : forall v x, made e v (unknown_number _ F) x g).
  { intros v x. apply always_made. intros. apply unknown_known. }
  split; cbn [last_operation the_rule rule_add rule_multiply rule_divide rule_scale]; auto; try discriminate.
  - split; cbn [last_operation the_rule rule_exact rule_within rule_error rule_subtract rule_negate rule_sign]; auto.
    + intros a. apply always_made. intros. now apply affine_exact_known.
    + intros a error x K. destruct (some_source g) as [f G].
      now apply (affine_within_known p emax p_4 limit e U f g G).
    + intros a b x. apply made_error.
    + intros a b x. apply made_map. intros. now apply affine_negate_known.
    + intros a b x K. apply (sign_of_known p emax p_3). now apply made_error in K.
  - intros a c b x FA FC E. apply made_map. intros. now apply known_alike with a.
Qed.

Lemma result_made e g l n x : all_known e l -> unused_source g l -> result g l n x -> made e (fst n) (snd n) x g.
Proof.
  intros [U K] New. assert (L : exists f, (g = Some f \/ g = None) /\ unused f l).
  { destruct g as [f |]; [exists f; auto |]. destruct (another (flat_map (fun n => sources (snd (fst n))) l)) as [f H].
    exists f. split; auto. intros n' x' I. apply new_intro. intros s S. apply H, in_flat_map. now exists (n', x'). }
  destruct L as (f & G & NF). clear New.
  assert (M : forall n x, In (n, x) l -> made e (fst n) (snd n) x g) by (intros; apply made_of_known; auto).
  assert (Last := last_operation_keeps e g U). assert (Rule := keeps_promises _ _ _ _ _ Last).
  destruct 1 as [v | v error x E | a c A x FA FC E I | a x I | a x b y I J | a x b y I J | a x b y I J | a x b y t
    I J Q w | a x k I | a x I | a x I | a x b y c z I J H | a x b y c z I J H | exponent a x b y P8 Exp I J];
    unfold tracked_exactly, tracked_within, tracked_negate, tracked_add, tracked_subtract, tracked_multiply,
      tracked_scale;
    cbn [fst snd affine_rule affine_operations the_rule rule_exact rule_within rule_negate rule_add rule_subtract
      rule_multiply rule_scale].
  - apply always_made. intros. now apply affine_exact_known.
  - now apply (affine_within_known p emax p_4 limit e U f g G).
  - apply made_of_known; auto. apply known_alike with a; auto. exact (K (a, A) x I).
  - apply made_of_known; auto. apply affine_negate_known; auto.
  - apply (affine_add_known p emax p_4 limit e U f g G); eauto.
  - apply (affine_subtract_known p emax p_4 limit e f); eauto.
  - apply (affine_multiply_known p emax p_4 fused limit e U f g G); eauto.
  - apply (quotient_of_any e _ _ x y g); auto.
    apply (affine_divide_known p emax p_4 fused limit e U f g G); eauto.
  - apply (affine_scale_known p emax p_4 limit e U f g G); eauto.
  - rewrite <- last_sqrt. apply (sqrt_known p emax p_3 fused affine _ _ Rule a x (M _ _ I)).
  - rewrite <- last_abs. apply (IeeeFunctions.abs_known p emax p_3 affine _ _ Rule a x (M _ _ I)).
  - rewrite <- last_fma. apply (fma_known p emax p_3 affine _ _ Rule a x b y c z (M _ _ I) (M _ _ J) (M _ _ H)).
  - rewrite <- last_lerp. apply (lerp_known p emax p_3 affine _ _ Last a x b y c z (M _ _ I) (M _ _ J) (M _ _ H)).
  - rewrite <- last_hypot. apply (hypot_known p emax p_3 affine _ _ Last exponent a x b y P8 Exp (M _ _ I) (M _ _ J)).
Qed.

(** An assignment that extends the previous one makes the next number known. *)
Theorem next_known e g l n x : all_known e l -> unused_source g l -> result g l n x ->
  exists e', all_known e' ((n, x) :: l) /\ forall s, used l s -> e' s = e s.
Proof.
  intros K New H. assert (M := result_made e g l n x K New H). destruct K as [U K].
  destruct g as [f |].
  - destruct M as (t & T & M). specialize (New f eq_refl).
    assert (S : forall s, used l s -> Affine.set e f t s = e s).
    { intros s (m & y & I & S). unfold Affine.set. destruct (Z.eqb_spec s f) as [-> |]; auto. exfalso.
      apply in_map_iff in S. destruct S as (q & Q & S). now apply (proj1 (Forall_forall _ _) (New m y I) q S). }
    exists (Affine.set e f t). split; [split |]; auto.
    + intros s. unfold Affine.set. destruct (s =? f)%Z; auto.
    + intros m y [[= <- <-] | I]; [exact M |]. apply affine_known_stays with e; auto. intros s c C. apply S.
      exists m, y. split; auto. apply in_map_iff. now exists (s, c).
  - exists e. split; [split |]; auto. intros m y [[= <- <-] | I]; auto.
Qed.
Lemma computed_incl from l : computed from l -> incl from l.
Proof. induction 1 as [| g l n x C IH]; [apply incl_refl | now apply incl_tl]. Qed.
(** The same for whole computations with any operations. *)
Theorem computed_known e from l : all_known e from -> computed from l ->
  exists e', all_known e' l /\ forall s, used from s -> e' s = e s.
Proof.
  intros K. induction 1 as [| g l n x C (e' & K' & S) New H]; [exists e; auto |].
  destruct (next_known e' g l n x K' New H) as (e2 & K2 & S2). exists e2. split; auto. intros s U.
  rewrite S2, S; auto. destruct U as (m & y & I & U). exists m, y. split; auto. now apply (computed_incl from).
Qed.
(** For numbers made of nothing, each is within its error, and its sign is right. *)
Theorem computed_error l n x : computed [] l -> In (n, x) l -> known (fst n) (radius (snd n)) x.
Proof.
  intros C I. destruct (computed_known (fun _ => 0) [] l) as (e & [_ K] & _); auto.
  - split; [| easy]. intros s. rewrite Rabs_R0. lra.
  - now apply K.
Qed.

(** A result's sources are those of its operands, and its own. *)
Lemma sources_from (P : Z -> Prop) A : all_from P (parts A) <-> forall s, In s (sources A) -> P s.
Proof.
  unfold all_from, sources. rewrite Forall_forall. split.
  - intros H s S. apply in_map_iff in S. destruct S as (t & <- & S). now apply H.
  - intros H t S. apply H. now apply in_map.
Qed.
Lemma result_sources g l n x : result g l n x -> forall s, In s (sources (snd n)) -> used l s \/ g = Some s.
Proof.
  intros H. apply sources_from. set (P := fun s => used l s \/ g = Some s).
  assert (Own : forall s, g = Some s -> P s) by (intros; now right).
  assert (Old : forall a y, In (a, y) l -> all_from P (parts (snd a))).
  { intros a y I. apply sources_from. intros s S. left. now exists a, y. }
  assert (W : forall v error, all_from P (parts (affine_within _ F limit v error g))).
  { intros. now apply within_from. }
  assert (E : forall v, all_from P (parts (affine_exact _ F v))) by (intros; constructor).
  destruct H as [v | v error x K | a c A x FA FC K I | a x I | a x b y I J | a x b y I J | a x b y I J | a x b y t
    I J Q w | a x k I | a x I | a x I | a x b y c z I J H | a x b y c z I J H | exponent a x b y P8 Exp I J].
  - apply E.
  - apply W.
  - apply (Old _ _ I).
  - apply negate_from. apply (Old _ _ I).
  - apply sum_from; eauto.
  - unfold tracked_subtract. cbn [snd affine_rule rule_subtract]. unfold affine_subtract. apply sum_from; eauto.
    apply negate_from. eauto.
  - apply product_from; eauto.
  - apply quotient_from; eauto.
  - apply scaled_from; eauto.
  - unfold tracked_sqrt. cbv zeta. repeat match goal with |- context [if ?c then _ else _] => destruct c end;
      first [apply W | apply E].
  - unfold tracked_abs. cbv zeta. assert (N : all_from P (parts (snd (tracked_negate _ F _ (rule g) a)))).
    { apply negate_from. apply (Old _ _ I). }
    destruct (tracked_sign _ _ (rule g) a); try destruct (less float F _ _);
      first [apply W | exact N | apply (Old _ _ I)].
  - unfold tracked_fma. cbv zeta. destruct (_ && _); [apply (Old _ _ H) | apply W].
  - unfold tracked_lerp. cbv zeta. destruct (_ && _); [apply (Old _ _ I) |]. destruct (_ && _); [apply (Old _ _ J) |].
    apply W.
  - unfold tracked_hypot. cbv zeta. destruct (negb _); [apply W |]. destruct (equal _ F _ _); apply W.
Qed.

(** Functions of several operations (NumberedCode.v): the operation after k others has the source `source k`. The
    sources to come are new and different. *)
Context (source : nat -> option Z) (all_different : forall i j s, source i = Some s -> source j = Some s -> i = j).
Notation operation := (fun k => by_rule (source k)).

Record ready (k : nat) (l : list_of_numbers) : Prop := {
  ready_known : exists e, all_known e l;
  ready_sources : forall j, (k <= j)%nat -> unused_source (source j) l
}.
(** From numbers of l and after k operations, the result of m has the property P. *)
Definition makes {X} (l : list_of_numbers) (k : nat) (m : counted X) (P : X -> list_of_numbers -> Prop) : Prop :=
  let (x, j) := m k in exists l', computed l l' /\ ready j l' /\ P x l'.
Definition gives l k (m : counted number) (r : R) : Prop := makes l k m (fun x l' => In (x, r) l').

Lemma computed_trans l m n : computed l m -> computed m n -> computed l n.
Proof. intros H. induction 1 as [| g m' x r C IH]; auto. now apply one_more with g. Qed.
Lemma makes_at_once {X} l k (x : X) (P : X -> _ -> Prop) : ready k l -> P x l -> makes l k (at_once x) P.
Proof. intros Ready H. exists l. split; [constructor | auto]. Qed.
Lemma makes_after {X Y} l k (m : counted X) (f : X -> counted Y) P Q : makes l k m P ->
  (forall x l' j, computed l l' -> ready j l' -> P x l' -> makes l' j (f x) Q) -> makes l k (after m f) Q.
Proof.
  unfold makes, after. destruct (m k) as [x j]. intros (l' & C & Ready & H) K. specialize (K x l' j C Ready H).
  destruct (f x j) as [y i]. destruct K as (l2 & C2 & K). exists l2. split; auto. now apply computed_trans with l'.
Qed.
Lemma ready_next k l n x : ready k l -> result (source k) l n x ->
  computed l ((n, x) :: l) /\ ready (S k) ((n, x) :: l).
Proof.
  intros [(e & K) New] H. assert (N := New k (le_n k)).
  split; [now apply one_more with (source k); [constructor | |] |].
  destruct (next_known e _ l n x K N H) as (e' & K' & _). split; [now exists e' |].
  intros j L f J m y [[= <- <-] | I].
  - apply new_intro. intros s S ->. destruct (result_sources _ _ _ _ H f S) as [(m & y & I & U) | U].
    + apply in_map_iff in U. destruct U as (t & T & U).
      now apply (proj1 (Forall_forall _ _) (New j ltac:(lia) f J m y I) t U).
    + generalize (all_different _ _ _ U J). lia.
  - apply (New j ltac:(lia) f J m y I).
Qed.
Lemma gives_once l k f x : ready k l -> result (source k) l (f (operation k)) x -> gives l k (once _ _ operation f) x.
Proof.
  intros Ready H. destruct (ready_next k l _ x Ready H) as [C Next]. exists ((f (operation k), x) :: l).
  split; auto. split; auto. now left.
Qed.
(** A result that has no source. *)
Lemma makes_beside {X} l k n x (m : counted X) P : ready k l -> result None l n x ->
  (ready k ((n, x) :: l) -> makes ((n, x) :: l) k m P) -> makes l k m P.
Proof.
  intros [(e & K) New] H G. assert (N : unused_source None l) by discriminate.
  assert (C : computed l ((n, x) :: l)) by (apply one_more with None; [constructor | |]; auto).
  destruct (next_known e _ l n x K N H) as (e' & K' & _).
  assert (Next : ready k ((n, x) :: l)).
  { split; [now exists e' |]. intros j L f J m' y [[= <- <-] | I]; [| apply (New j L f J m' y I)].
    apply new_intro. intros s S ->. destruct (result_sources _ _ _ _ H f S) as [(m' & y & I & U) | U]; [| discriminate].
    apply in_map_iff in U. destruct U as (t & T & U). now apply (proj1 (Forall_forall _ _) (New j L f J m' y I) t U). }
  specialize (G Next). unfold makes in *. destruct (m k) as [y j]. destruct G as (l' & C' & G). exists l'. split; auto.
  now apply computed_trans with ((n, x) :: l).
Qed.
(** Facts about the list's numbers under any assignment. *)
Lemma error_right k l n x : ready k l -> In (n, x) l -> known (fst n) (radius (snd n)) x.
Proof. intros [(e & _ & K) _] I. now apply K. Qed.
Notation the_rule := (the_rule _ _ (operation O)).
Lemma sign_right k l n x : ready k l -> In (n, x) l -> right_sign (tracked_sign _ _ the_rule n) x.
Proof. intros Ready I. apply (sign_of_known p emax p_3). now apply (error_right k l n). Qed.

Notation add := (numbered_add _ F _ operation).
Notation subtract := (numbered_subtract _ F _ operation).
Notation multiply := (numbered_multiply _ F _ operation).
Notation scale := (numbered_scale _ F _ operation).
Section Operations.
Context (l : list_of_numbers) (k : nat) (Ready : ready k l) (a b : number) (x y : R) (of_a : In (a, x) l)
  (of_b : In (b, y) l).
Lemma add_gives : gives l k (add a b) (x + y).
Proof. apply gives_once; auto. now apply of_add. Qed.
Lemma subtract_gives : gives l k (subtract a b) (x - y).
Proof. apply gives_once; auto. now apply of_subtract. Qed.
Lemma multiply_gives : gives l k (multiply a b) (x * y).
Proof. apply gives_once; auto. now apply of_multiply. Qed.
Lemma scale_gives e : gives l k (scale a e) (x * bpow radix2 e).
Proof. apply gives_once; auto. now apply of_scale. Qed.
End Operations.

(** The sum need not be finite. *)
Theorem affine_midpoint_gives l k x r y s : ready k l -> In (x, r) l -> In (y, s) l ->
  gives l k (numbered_midpoint _ F _ operation x y) ((r + s) / 2).
Proof.
  intros Ready X Y. unfold numbered_midpoint.
  replace ((r + s) / 2) with ((r + s) * bpow radix2 (-1)) by (change (bpow radix2 (-1)) with (/ 2); reflexivity).
  apply makes_after with (1 := add_gives l k Ready x y r s X Y). intros sum l1 j C R1 S. apply computed_incl in C.
  destruct (_ && _); [now apply scale_gives |]. rewrite Rmult_plus_distr_r.
  apply makes_after with (1 := scale_gives l1 j R1 x r (C _ X) (-1)). intros half l2 i C2 R2 H.
  apply computed_incl in C2.
  apply makes_after with (1 := scale_gives l2 i R2 y s (C2 _ (C _ Y)) (-1)). intros other l3 h C3 R3 O.
  apply computed_incl in C3. apply add_gives; auto.
Qed.

Lemma lesser_gives l k x r y s : ready k l -> In (x, r) l -> In (y, s) l ->
  (finite (fst x) -> finite (fst y) -> B2R (fst x) <= B2R (fst y)) ->
  gives l k (numbered_lesser_or_either _ F _ operation x y) (Rmin r s).
Proof.
  intros Ready X Y L. unfold numbered_lesser_or_either.
  apply makes_after with (1 := subtract_gives l k Ready x y r s X Y). intros difference l1 j C R1 D.
  apply computed_incl in C. assert (S := sign_right j l1 _ _ R1 D). apply C in X, Y.
  assert (W : gives l1 j (numbered_within _ _ operation (fst x) (larger_error _ F _ the_rule x y)) (Rmin r s)).
  { apply gives_once; auto. apply of_within. intros H _. destruct (ready_known _ _ R1) as (e & U & K).
    assert (Rule := keeps_promises _ _ _ _ _ (last_operation_keeps e None U)).
    destruct (larger_error_finite p emax affine _ _ Rule x r y s (K _ _ X) (K _ _ Y) H) as (FX & FY & LX & LY).
    assert (EX := finite_error _ x FX). assert (EY := finite_error _ y FY).
    change (rule_error _ _ _ (fst x) (snd x)) with (radius (snd x)) in EX.
    change (rule_error _ _ _ (fst y) (snd y)) with (radius (snd y)) in EY. rewrite EX in FX, LX. rewrite EY in FY, LY.
    destruct (proj2 (error_right j l1 _ _ R1 X) FX) as [AX DX], (proj2 (error_right j l1 _ _ R1 Y) FY) as [AY DY].
    specialize (L AX AY). apply Rabs_le_inv in DX, DY. apply Rabs_le.
    change (larger_error _ F _ (last_rule None) x y) with (larger_error _ F _ the_rule x y) in LX, LY.
    unfold Rmin. destruct (Rle_dec r s); lra. }
  destruct (tracked_sign _ _ _ difference); simpl in S; auto; rewrite Rmin_left by lra; now apply makes_at_once.
Qed.

Theorem affine_min_gives l k x r y s : ready k l -> In (x, r) l -> In (y, s) l ->
  gives l k (numbered_min _ F _ operation x y) (Rmin r s).
Proof.
  intros Ready X Y. unfold numbered_min. destruct (less _ F (fst y) (fst x)) eqn:C.
  - rewrite Rmin_comm. apply lesser_gives; auto. intros FY FX. revert C. rewrite (less_finite p emax) by auto.
    case Rlt_bool_spec; [lra | discriminate].
  - apply lesser_gives; auto. intros FX FY. revert C. rewrite (less_finite p emax) by auto.
    case Rlt_bool_spec; [discriminate | auto].
Qed.
Theorem affine_max_gives l k x r y s : ready k l -> In (x, r) l -> In (y, s) l ->
  gives l k (numbered_max _ F _ operation x y) (Rmax r s).
Proof.
  intros Ready X Y. unfold numbered_max.
  replace (Rmax r s) with (- Rmin (- r) (- s)) by (rewrite <- Ropp_Rmax; ring).
  apply makes_beside with (1 := Ready) (2 := of_negate None l x r X). intros R1.
  apply makes_beside with (1 := R1) (2 := of_negate None (_ :: l) y s (or_intror Y)). intros R2.
  set (nx := tracked_negate _ F _ (rule None) x) in *. set (ny := tracked_negate _ F _ (rule None) y) in *.
  set (l2 := (ny, - s) :: (nx, - r) :: l) in *.
  assert (NX : In (nx, - r) l2) by (right; now left). assert (NY : In (ny, - s) l2) by now left.
  assert (L : gives l2 k (if less _ F (fst x) (fst y) then numbered_lesser_or_either _ F _ operation ny nx
      else numbered_lesser_or_either _ F _ operation nx ny) (Rmin (- r) (- s))).
  { destruct (less _ F (fst x) (fst y)) eqn:C; [rewrite Rmin_comm |]; apply lesser_gives; auto;
      cbn [fst tracked_negate nx ny];
      intros F1 F2; apply (opposite_finite p emax) in F1, F2; rewrite !opposite_value; revert C;
      rewrite (less_finite p emax) by auto; case Rlt_bool_spec; try discriminate; lra. }
  apply makes_after with (1 := L). intros lesser l3 j C R3 M.
  apply makes_beside with (1 := R3) (2 := of_negate None l3 lesser _ M). intros R4.
  apply makes_at_once; auto. now left.
Qed.

(** Whole powers. For n < 0 it is 1/x^-n, and any number if x is zero. *)
Lemma power_gives r bits : forall l k first result power s t m, ready k l -> In (power, t) l ->
  (first = false -> In (result, s) l) -> t = r ^ m -> (first = true -> s = 1) ->
  gives l k (numbered_power _ F _ operation bits first result power) (s * r ^ (m * Pos.to_nat bits)).
Proof.
  induction bits as [bits IH | bits IH |]; intros l k first result power s t m Ready P S E One; cbn [numbered_power].
  - assert (N : gives l k (if first then at_once power else multiply result power) (s * t)).
    { destruct first; [rewrite (One eq_refl), Rmult_1_l; now apply makes_at_once | apply multiply_gives; auto]. }
    apply makes_after with (1 := N). intros next l1 j C1 R1 N1. apply computed_incl in C1.
    apply makes_after with (1 := multiply_gives l1 j R1 power power t t (C1 _ P) (C1 _ P)).
    intros square l2 i C2 R2 Q. apply computed_incl in C2.
    replace (s * r ^ (m * Pos.to_nat bits~1)) with (s * t * r ^ (m * 2 * Pos.to_nat bits)).
    + apply (IH l2 i false next square (s * t) (t * t) (m * 2)%nat); auto; try discriminate.
      rewrite E, <- pow_add. f_equal. lia.
    + rewrite E, Rmult_assoc, <- pow_add. do 2 f_equal. rewrite Pos2Nat.inj_xI. lia.
  - apply makes_after with (1 := multiply_gives l k Ready power power t t P P).
    intros square l2 i C2 R2 Q. apply computed_incl in C2.
    replace (s * r ^ (m * Pos.to_nat bits~0)) with (s * r ^ (m * 2 * Pos.to_nat bits)).
    + apply (IH l2 i first result square s (t * t) (m * 2)%nat); auto. rewrite E, <- pow_add. f_equal. lia.
    + do 2 f_equal. rewrite Pos2Nat.inj_xO. lia.
  - replace (m * Pos.to_nat 1)%nat with m by lia. rewrite <- E.
    destruct first; [rewrite (One eq_refl), Rmult_1_l; now apply makes_at_once | apply multiply_gives; auto].
Qed.
Lemma inverse_power_gives l k x r bits t : ready k l -> In (x, r) l -> r = 0 \/ t = / r ^ Pos.to_nat bits ->
  gives l k (numbered_pow _ F _ operation x (Zneg bits)) t.
Proof.
  intros Ready X Q. cbn [numbered_pow].
  assert (P := power_gives r bits l k true (tracked_exactly _ _ the_rule (integer _ F 1)) x 1 r 1 Ready X
    ltac:(discriminate) ltac:(simpl; ring) ltac:(reflexivity)).
  replace (1 * r ^ (1 * Pos.to_nat bits)) with (r ^ Pos.to_nat bits) in P by (rewrite Nat.mul_1_l; ring).
  apply makes_after with (1 := P). intros power l1 j C R1 W.
  apply makes_beside with (1 := R1) (2 := of_exactly None l1 (integer _ F 1)). intros R2.
  apply gives_once; auto.
  apply (of_divide _ _ _ (B2R (integer _ F 1)) _ (r ^ Pos.to_nat bits)); [now left | now right |].
  rewrite (proj2 (integer_value p emax p_3 1 ltac:(lia))).
  destruct Q as [-> | ->]; [left; apply pow_i; lia | right; unfold Rdiv; ring].
Qed.
Theorem affine_pow_gives l k x r n : ready k l -> In (x, r) l ->
  gives l k (numbered_pow _ F _ operation x n) (powerRZ r n) /\
  ((n < 0)%Z -> finite (radius (snd (fst (numbered_pow _ F _ operation x n k)))) -> r <> 0).
Proof.
  intros Ready X. destruct n as [| bits | bits].
  - split; [| lia]. apply makes_beside with (1 := Ready) (2 := of_exactly None l (integer _ F 1)). intros R1.
    apply makes_at_once; auto. left. cbn [powerRZ]. now rewrite (proj2 (integer_value p emax p_3 1 ltac:(lia))).
  - split; [| lia]. cbn [powerRZ numbered_pow].
    replace (r ^ Pos.to_nat bits) with (1 * r ^ (1 * Pos.to_nat bits)) by (rewrite Nat.mul_1_l; ring).
    apply power_gives with (t := r); auto; [discriminate | simpl; ring].
  - split; [apply (inverse_power_gives l k x r); auto; now right |]. intros _ H ->.
    assert (G : forall t, known (fst (fst (numbered_pow _ F _ operation x (Zneg bits) k)))
        (radius (snd (fst (numbered_pow _ F _ operation x (Zneg bits) k)))) t).
    { intros t. assert (G := inverse_power_gives l k x 0 bits t Ready X (or_introl eq_refl)). unfold gives, makes in G.
      destruct (numbered_pow _ F _ operation x (Zneg bits) k) as [power j]. destruct G as (l' & _ & R1 & I).
      now apply (error_right j l'). }
    set (power := fst (numbered_pow _ F _ operation x (Zneg bits) k)) in *.
    destruct (proj2 (G (B2R (fst power) + (Rabs (B2R (radius (snd power))) + 1))) H) as [_ D].
    revert D. generalize (B2R (fst power)) (B2R (radius (snd power))). intros v e D.
    generalize (Rle_abs e) (Rabs_pos e) (Rle_abs (- (v - (v + (Rabs e + 1))))). rewrite Rabs_Ropp. lra.
Qed.

(** Dot products. *)
Definition pair_in (l : list_of_numbers) (pair : number * number) (exact : R * R) : Prop :=
  In (fst pair, fst exact) l /\ In (snd pair, snd exact) l.
Lemma pairs_in l l' pairs exacts : incl l l' -> Forall2 (pair_in l) pairs exacts -> Forall2 (pair_in l') pairs exacts.
Proof. intros I H. induction H as [| pair exact pairs exacts [P1 P2] H IH]; constructor; auto. split; auto. Qed.
Lemma dot_loop pairs : forall exacts l k sum r, ready k l -> Forall2 (pair_in l) pairs exacts -> In (sum, r) l ->
  gives l k (each (numbered_dot_step _ F _ operation) pairs sum) (r + DotProduct.exact_dot exacts).
Proof.
  induction pairs as [| pair pairs IH]; intros exacts l k sum r Ready H S;
    inversion H as [| ? exact ? exacts' [P1 P2] H']; subst;
    cbn [each DotProduct.exact_dot fold_right].
  - rewrite Rplus_0_r. now apply makes_at_once.
  - apply makes_after with (P := fun x l' => In (x, r + fst exact * snd exact) l').
    + apply makes_after with (1 := multiply_gives l k Ready _ _ _ _ P1 P2). intros product l1 j C R1 M.
      apply computed_incl in C. apply add_gives; auto.
    + intros sum' l1 j C R1 S'. apply computed_incl in C. rewrite <- Rplus_assoc. apply IH; auto.
      now apply pairs_in with l.
Qed.
Theorem affine_dot_gives l k pairs exacts : ready k l -> Forall2 (pair_in l) pairs exacts ->
  gives l k (numbered_dot _ F _ operation pairs) (DotProduct.exact_dot exacts).
Proof.
  intros Ready H. destruct H as [| pair exact pairs exacts [P1 P2] H];
    cbn [numbered_dot DotProduct.exact_dot fold_right].
  - rewrite <- (proj2 (zero_value p emax p_3)).
    apply makes_beside with (1 := Ready) (2 := of_exactly None l (integer _ F 0)). intros R1.
    apply makes_at_once; auto. now left.
  - apply makes_after with (1 := multiply_gives l k Ready _ _ _ _ P1 P2). intros product l1 j C R1 M.
    apply computed_incl in C. assert (H' := pairs_in l l1 _ _ C H).
    destruct product as [v A]. cbn [fst snd]. destruct (zero_plus p emax p_3 v) as [FS | ->]; [| now apply dot_loop].
    assert (G := plus_finite p emax _ _ FS). destruct G as (_ & FV & E).
    apply makes_beside with (n := (integer _ F 0 ⊕ v, A)) (x := fst exact * snd exact) (1 := R1).
    + apply of_alike with v; auto. rewrite E, (proj2 (zero_value p emax p_3)), Rplus_0_l. symmetry.
      apply (Format.rnd_exact p emin Format.nearest), number_B2R.
    + intros R2. apply dot_loop; auto; [| now left]. apply pairs_in with l1; auto. now apply incl_tl, incl_refl.
Qed.

(** Horner's rule. *)
Definition number_in (l : list_of_numbers) (n : number) (x : R) : Prop := In (n, x) l.
Lemma numbers_in l l' c exact : incl l l' -> Forall2 (number_in l) c exact -> Forall2 (number_in l') c exact.
Proof. intros I H. induction H; constructor; auto. now apply I. Qed.
Notation horner_step := (numbered_horner_step _ F _ operation).
Notation slope_step := (numbered_slope_step _ F _ operation).
Lemma step_gives l k x r s q c t : ready k l -> In (x, r) l -> In (s, q) l -> In (c, t) l ->
  gives l k (horner_step x s c) (q * r + t).
Proof.
  intros Ready X S C. apply makes_after with (1 := multiply_gives l k Ready _ _ _ _ S X). intros product l1 j I R1 M.
  apply computed_incl in I. apply add_gives; auto.
Qed.
Lemma steps_give x r c : forall exact l k s q, ready k l -> In (x, r) l -> Forall2 (number_in l) c exact ->
  In (s, q) l ->
  gives l k (each (horner_step x) c s) (fold_left (fun sum a => sum * r + a) exact q).
Proof.
  induction c as [| a c IH]; intros exact l k s q Ready X H S; inversion H as [| ? t ? exact' A H']; subst;
    cbn [each fold_left]; [now apply makes_at_once |].
  apply makes_after with (1 := step_gives l k x r s q a t Ready X S A). intros next l1 j I R1 N.
  apply computed_incl in I. apply IH; auto. now apply numbers_in with l.
Qed.
Lemma slopes_give at_value v x r c : forall exact l k s o t q, ready k l -> In (at_value, v) l -> In (x, r) l ->
  Forall2 (number_in l) c exact -> In (fst s, t) l -> In (snd s, q) l -> o * r = t * v + q * (r - v) ->
  makes l k (each (slope_step at_value x) c s) (fun s' l' => exists t' q', In (fst s', t') l' /\ In (snd s', q') l' /\
    fold_left (fun sum a => sum * r + a) exact o * r = t' * v + q' * (r - v)).
Proof.
  induction c as [| a c IH]; intros exact l k s o t q Ready V X H S1 S2 E; inversion H as [| ? w ? exact' A H']; subst;
    cbn [each fold_left]; [apply makes_at_once; eauto |].
  apply makes_after with (P := fun s' l' => In (fst s', t * v + w) l' /\ In (snd s', q * r + (t * v + w)) l').
  - apply makes_after with (1 := step_gives l k at_value v _ t a w Ready V S1 A). intros there l1 j I1 R1 N1.
    apply computed_incl in I1.
    apply makes_after with (1 := multiply_gives l1 j R1 _ _ q r (I1 _ S2) (I1 _ X)). intros product l2 i I2 R2 N2.
    apply computed_incl in I2.
    apply makes_after with (1 := add_gives l2 i R2 _ _ _ _ N2 (I2 _ N1)). intros slope l3 h I3 R3 N3.
    apply computed_incl in I3. apply makes_at_once; auto.
  - intros s' l1 j I R1 [N1 N2]. apply computed_incl in I.
    apply (IH exact' l1 j s' (o * r + w) (t * v + w) (q * r + (t * v + w))); auto; [now apply numbers_in with l |].
    rewrite E. ring.
Qed.
(** Values do not depend on bounds. *)
Lemma steps_value x c : forall s k,
  fst (fst (each (horner_step x) c s k)) = fold_left (fun v a => v ⊗ fst x ⊕ fst a) c (fst s).
Proof. induction c as [| a c IH]; intros s k; [reflexivity |]. cbn [each fold_left]. apply IH. Qed.
Lemma slopes_value at_value x c : forall s k,
  fst (fst (fst (each (slope_step at_value x) c s k))) = fold_left (fun v a => v ⊗ fst at_value ⊕ fst a) c (fst (fst
    s)).
Proof. induction c as [| a c IH]; intros s k; [reflexivity |]. cbn [each fold_left]. apply IH. Qed.
Lemma makes_and {X} l k (m : counted X) P (Q : X -> Prop) :
  makes l k m P -> Q (fst (m k)) -> makes l k m (fun x l' => P x l' /\ Q x).
Proof. unfold makes. destruct (m k) as [x j]. intros (l' & C & Ready & H) HQ. exists l'. auto. Qed.
Theorem affine_horner_gives l k c exact x r : ready k l -> Forall2 (number_in l) c exact -> In (x, r) l ->
  gives l k (numbered_horner _ F _ operation c x) (Compound.exact_horner exact r).
Proof.
  intros Ready H X. destruct H as [| c0 a0 higher e C0 H].
  { cbn [numbered_horner Compound.exact_horner fold_right]. rewrite <- (proj2 (zero_value p emax p_3)).
    apply makes_beside with (1 := Ready) (2 := of_exactly None l (integer _ F 0)). intros R1.
    apply makes_at_once; auto. now left. }
  cbn [numbered_horner Compound.exact_horner fold_right]. fold (Compound.exact_horner e r).
  assert (EX : Compound.exact_horner e r = fold_left (fun sum a => sum * r + a) (rev e) 0).
  { unfold Compound.exact_horner. rewrite <- fold_left_rev_right, rev_involutive.
    induction e as [| a e' IH'] in |- *; simpl; auto. rewrite IH'. ring. }
  apply Compound.Forall2_rev in H. rewrite EX. clear EX.
  destruct H as [| top b middle m Top H]; [simpl; rewrite Rmult_0_r, Rplus_0_r; now apply makes_at_once |].
  cbn [fold_left]. rewrite Rmult_0_l, Rplus_0_l. set (o := fold_left _ m b).
  replace (a0 + r * o) with (o * r + a0) by ring. cbv zeta.
  apply makes_after with (1 := makes_and l k _ _ (fun y => fst y =
    fold_left (fun v a => v ⊗ fst x ⊕ fst a) middle (fst top))
    (steps_give x r middle m l k top b Ready X H Top) (steps_value x middle top k)).
  intros part l1 k1 I1 R1 [P1 V1]. apply computed_incl in I1.
  apply makes_after with (1 := makes_and l1 k1 _ _ (fun y => fst y = fst part ⊗ fst x ⊕ fst c0)
    (step_gives l1 k1 x r part o c0 a0 R1 (I1 _ X) P1 (I1 _ C0)) eq_refl).
  intros result l2 k2 I2 R2 [P2 V2]. apply computed_incl in I2.
  destruct (_ || _); [now apply makes_at_once |].
  set (at_value := tracked_exactly _ _ the_rule (fst x)).
  apply makes_beside with (1 := R2) (2 := of_exactly None l2 (fst x)). fold at_value.
  change (tracked_exactly _ _ (rule None) (fst x)) with at_value. set (l3 := (at_value, B2R (fst x)) :: l2). intros R3.
  assert (I3 : incl l l3) by (intros n N; right; auto). assert (V : In (at_value, B2R (fst x)) l3) by now left.
  apply makes_after with (1 := makes_and l3 k2 _ _
    (fun s => fst (fst s) = fold_left (fun v a => v ⊗ fst at_value ⊕ fst a) middle (fst top))
    (slopes_give at_value _ x r middle m l3 k2 (top, top) b b b R3 V (I3 _ X) (numbers_in _ _ _ _ I3 H) (I3 _ Top) (I3
      _ Top)
      ltac:(ring)) (slopes_value at_value x middle (top, top) k2)).
  intros s l4 k4 I4 R4 [(t & q & S1 & S2 & E) V4]. apply computed_incl in I4. fold o in E.
  apply makes_after with (1 := makes_and l4 k4 _ _ (fun y => fst y = fst x ⊖ fst x)
    (subtract_gives l4 k4 R4 x at_value r _ (I4 _ (I3 _ X)) (I4 _ V)) eq_refl).
  intros difference l5 k5 I5 R5 [D V5]. apply computed_incl in I5.
  apply makes_after with (1 := makes_and l5 k5 _ _ (fun y => fst y = fst (snd s) ⊗ fst difference)
    (multiply_gives l5 k5 R5 _ _ _ _ (I5 _ S2) D) eq_refl).
  intros change l6 k6 I6 R6 [M V6]. apply computed_incl in I6.
  apply makes_after with (1 := makes_and l6 k6 _ _ (fun y => fst y = fst (fst s) ⊗ fst x ⊕ fst c0)
    (step_gives l6 k6 at_value _ (fst s) t c0 a0 R6 (I6 _ (I5 _ (I4 _ V))) (I6 _ (I5 _ S1))
      (I6 _ (I5 _ (I4 _ (I3 _ C0))))) eq_refl).
  intros there l7 k7 I7 R7 [T V7]. apply computed_incl in I7.
  apply makes_after with (1 := makes_and l7 k7 _ _ (fun y => fst y = fst there ⊕ fst change)
    (add_gives l7 k7 R7 _ _ _ _ T (I7 _ M)) eq_refl).
  intros by_slope l8 k8 I8 R8 [W V8]. apply computed_incl in I8.
  assert (Result : In (result, o * r + a0) l8) by (apply I8, I7, I6, I5, I4; now right).
  destruct (_ && _) eqn:C; [| now apply makes_at_once]. apply andb_prop in C. destruct C as [C _].
  replace (t * B2R (fst x) + a0 + q * (r - B2R (fst x))) with (o * r + a0) in W by (rewrite E; ring).
  destruct (error_right k8 l8 _ _ R8 W) as [PE KE].
  assert (FE : finite (radius (snd by_slope))).
  { revert C. unfold tracked_error. cbv zeta.
    change (rule_error _ _ _ (fst by_slope) (snd by_slope)) with (radius (snd by_slope)).
    change (rule_error _ _ _ (fst result) (snd result)) with (radius (snd result)).
    destruct (radius (snd by_slope)) as [| g | |]; auto; [simpl in PE; subst g |].
    all: match goal with |- less _ _ _ ?error = _ -> _ => generalize error end;
      intros [| [|] | | [|]] Less; vm_compute in Less; discriminate. }
  destruct (KE FE) as [FV _]. assert (FV' := FV). rewrite V8 in FV'.
  destruct (plus_finite p emax _ _ FV') as (FT & FC & ET). rewrite V6 in FC, ET.
  destruct (times_finite p emax _ _ FC) as (_ & FD & EC). rewrite V5 in FD, EC.
  destruct (minus_finite p emax _ _ FD) as (_ & _ & ED).
  assert (Same : fst there = fst result) by (rewrite V7, V4, V2, V1; reflexivity).
  apply makes_beside with (n := (fst result, snd by_slope)) (x := o * r + a0) (1 := R8).
  - apply of_alike with (fst by_slope); auto; [now rewrite <- Same | | now rewrite <- surjective_pairing].
    rewrite V8, V6, ET, V5, EC, ED, Rminus_eq_0, (Format.rnd_0 p emin Format.nearest), Rmult_0_r,
      (Format.rnd_0 p emin Format.nearest), Rplus_0_r, <- Same.
      apply (Format.rnd_exact p emin Format.nearest), number_B2R.
  - intros R9. apply makes_at_once; auto. now left.
Qed.

(** A zero counts as positive. *)
Theorem affine_copysign_gives l k x r y s : ready k l -> In (x, r) l -> In (y, s) l ->
  gives l k (numbered_copysign _ F _ operation x y) (if Rlt_bool s 0 then - Rabs r else Rabs r).
Proof.
  intros Ready X Y. unfold numbered_copysign.
  assert (A : makes l k (numbered_abs _ F _ operation x) (fun size l' => In (size, Rabs r) l' /\
    size = tracked_abs _ F _ (rule (source k)) x)).
  { apply makes_and; [| reflexivity]. apply gives_once; auto. now apply of_abs. }
  apply makes_after with (1 := A). intros size l1 j C R1 [S Z]. apply computed_incl in C.
  assert (G := sign_right j l1 y s R1 (C _ Y)). destruct (tracked_sign _ _ _ y); cbn [right_sign] in G.
  - rewrite Rlt_bool_true by exact G. apply makes_beside with (1 := R1) (2 := of_negate None l1 _ _ S). intros R2.
    apply makes_at_once; auto. now left.
  - rewrite Rlt_bool_false by lra. now apply makes_at_once.
  - rewrite Rlt_bool_false by lra. now apply makes_at_once.
  - destruct (_ || _); apply gives_once; auto; apply of_within; intros H _; [discriminate H |].
    apply (IeeeFunctions.enlarged_finite p emax p_3) in H. destruct H as [H ->].
    apply plus_finite in H. destruct H as (H1 & H2 & ->). apply times_finite in H1. destruct H1 as (_ & FS & ->).
    assert (ES : B2R (fst size) = Rabs (B2R (fst x))).
    { rewrite Z in FS |- *. now apply (IeeeCompound.abs_value p emax p_3 affine (by_rule (source k)) x). }
    assert (E := finite_error _ size H2).
    change (rule_error _ _ _ (fst size) (snd size)) with (radius (snd size)) in E. rewrite E in H2 |- *.
    destruct (proj2 (error_right j l1 _ _ R1 S) H2) as [_ D]. rewrite (proj2 (integer_value p emax p_3 2 ltac:(lia))).
    apply (Functions.copysign_sound_nearest p emin p_3 (B2R (fst size)) _ r); auto using number_B2R.
    + apply (emin_p p emax p_3).
    + rewrite ES. apply Rabs_pos.
    + destruct (less _ F (fst y) (integer _ F 0)); rewrite ?opposite_value, ?Rabs_Ropp, ES, Rabs_Rabsolu; reflexivity.
    + destruct (Rlt_bool s 0); rewrite ?Rabs_Ropp; apply Rabs_Rabsolu.
Qed.

(** Functions of one operation. *)
Section One_operation.
Context (l : list_of_numbers) (k : nat) (Ready : ready k l) (a b c : number) (x y z : R) (of_a : In (a, x) l).
Theorem affine_sqrt_gives : gives l k (numbered_sqrt _ F fused _ operation a) (sqrt x) /\
  (finite (radius (snd (fst (numbered_sqrt _ F fused _ operation a k)))) -> 0 <= x).
Proof.
  split; [apply gives_once; auto; now apply of_sqrt |]. cbn [numbered_sqrt once fst]. intros H.
  destruct (ready_known _ _ Ready) as (e & U & K).
  assert (Rule := keeps_promises _ _ _ _ _ (last_operation_keeps e (source k) U)).
  apply (sqrt_known p emax p_3 fused affine _ _ Rule a x); [now apply made_of_known, K |]. rewrite last_sqrt.
  unfold tracked_error. cbv zeta. destruct equal eqn:E; [exact H |]. revert E.
  rewrite (equal_finite p emax) by exact H. now rewrite Req_bool_true.
Qed.
Theorem affine_abs_gives : gives l k (numbered_abs _ F _ operation a) (Rabs x).
Proof. apply gives_once; auto. now apply of_abs. Qed.
Hypothesis of_b : In (b, y) l.
Theorem affine_hypot_gives exponent : (8 <= p)%Z ->
  (forall v, finite v -> B2R v <> 0 -> bpow radix2 (exponent v - 1) <= Rabs (B2R v) < bpow radix2 (exponent v)) ->
  gives l k (numbered_hypot _ F _ operation exponent a b) (sqrt (x * x + y * y)).
Proof. intros P8 E. apply gives_once; auto. now apply of_hypot. Qed.
Hypothesis of_c : In (c, z) l.
Theorem affine_fma_gives : gives l k (numbered_fma _ F _ operation a b c) (x * y + z).
Proof. apply gives_once; auto. now apply of_fma. Qed.
Theorem affine_lerp_gives : gives l k (numbered_lerp _ F _ operation a b c) ((1 - z) * x + z * y).
Proof. apply gives_once; auto. now apply of_lerp. Qed.
End One_operation.

(** An extension of the assignment makes a function's result known, and the other numbers still are. *)
Theorem gives_known e l k m r : all_known e l -> gives l k m r ->
  exists e', all_known e' ((fst (m k), r) :: l) /\ forall s, used l s -> e' s = e s.
Proof.
  unfold gives, makes. destruct (m k) as [n j]. intros K (l' & C & _ & I).
  destruct (computed_known e l l' K C) as (e' & [U K'] & S). exists e'. split; [split |]; auto.
  apply computed_incl in C. intros n' x [[= <- <-] | H]; apply K'; auto.
Qed.
Theorem gives_error l k m r : gives l k m r -> known (fst (fst (m k))) (radius (snd (fst (m k)))) r.
Proof.
  unfold gives, makes. destruct (m k) as [n j]. intros (l' & _ & Ready & I). now apply (error_right j l').
Qed.

End Functions.
