(** TightCCD loses no collision, nor does BSC over any other bound rule: rules over IEEE formats, including overflow
    (IeeeRules.v, IeeeSafe.v, IeeeInterval.v, IeeeResidual.v), under BSC (Decisions.v); to nearest, p >= 3, emax > p.
    A tracked number is a computed value with a computed bound, and its real number. The theorems hold for every
    `rule`: tight_rule, sharp_rule, safe_rule, interval_rule, residual_rule, and kept_rule of any that keeps its
    operations (IeeeCompound.v), such as `relative` (IeeeRelative.v). Coordinates are those of tracked_query:
    floating-point numbers, or these times any power of two. Results:
        tracked_face_separate, tracked_edges_separate   a "no" is right
        tracked_face_collides, tracked_edges_collide    a "yes" is right *)

From Coq Require Import Reals ZArith Lia Lra List Bool.
From Flocq Require Import Core IEEE754.BinarySingleNaN.
From Errbound Require Import Code Ieee IeeeRules.
From Errbound Require Sign Bernstein BscCode Contact Decisions AxisUnits IeeeSafe IeeeInterval IeeeResidual
  CompoundCode IeeeFunctions IeeeCompound.
Import ListNotations.
Open Scope R_scope.

(** ** BSC over any scalar, as decide_bsc evaluates it *)

Section Any.
Context {S : Bernstein.scalar}.
Definition face_answer (v f0 f1 f2 : @Decisions.moving_point S) : BscCode.existence :=
  let b := Decisions.difference f1 f0 in
  let c := Decisions.difference f2 f0 in
  let q := Decisions.difference v f0 in
  BscCode.root_with_nonnegative (Decisions.y_form b c q) (Decisions.inside_face_forms b c q).
Definition edges_answer (a0 a1 b0 b1 : @Decisions.moving_point S) : BscCode.existence :=
  let b := Decisions.difference a1 a0 in
  let c := Decisions.difference b1 b0 in
  let q := Decisions.difference b0 a0 in
  BscCode.root_with_nonnegative (Decisions.y_form b c q) (Decisions.inside_edges_forms b c q).
Notation exactly := Decisions.exact_motion.
Lemma face_answer_separate v f0 f1 f2 : face_answer v f0 f1 f2 = BscCode.no ->
  ~ Contact.vertex_face_collides (exactly v) (exactly f0) (exactly f1) (exactly f2).
Proof. exact (Decisions.bsc_face_separate v f0 f1 f2). Qed.
Lemma face_answer_collides v f0 f1 f2 : face_answer v f0 f1 f2 = BscCode.yes ->
  Contact.vertex_face_collides (exactly v) (exactly f0) (exactly f1) (exactly f2).
Proof. exact (Decisions.bsc_face_collides v f0 f1 f2). Qed.
Lemma edges_answer_separate a0 a1 b0 b1 : edges_answer a0 a1 b0 b1 = BscCode.no ->
  ~ Contact.edge_edge_collides (exactly a0) (exactly a1) (exactly b0) (exactly b1).
Proof. exact (Decisions.bsc_edges_separate a0 a1 b0 b1). Qed.
Lemma edges_answer_collide a0 a1 b0 b1 : edges_answer a0 a1 b0 b1 = BscCode.yes ->
  Contact.edge_edge_collides (exactly a0) (exactly a1) (exactly b0) (exactly b1).
Proof. exact (Decisions.bsc_edges_collide a0 a1 b0 b1). Qed.
End Any.

Section Tracked.

Context (p emax : Z) {p_positive : Prec_gt_0 p} {p_below : Prec_lt_emax p emax} (p_3 : (3 <= p)%Z).
Notation float := (binary_float p emax).
Notation F := (floats p emax).

Definition sign_given (s : sign_type) : Sign.sign :=
  match s with
  | negative => Sign.negative
  | zero => Sign.zero
  | positive => Sign.positive
  | uncertain => Sign.uncertain
  end.

(** The functions of a rule that tracked.hpp uses, and their promise. *)
Record rule := Rule {
  bound : Type;
  known : float -> bound -> R -> Prop;
  exact : float -> bound;
  within : float -> float -> bound;
  negate : bound -> bound;
  add : float -> float -> bound -> float -> bound -> bound;
  subtract : float -> float -> bound -> float -> bound -> bound;
  multiply : float -> float -> bound -> float -> bound -> bound;
  rescale : float -> float -> bound -> Z -> bound;
  sign : float -> bound -> sign_type;
  exact_known : forall a, known a (exact a) (B2R a);
  within_known : forall a error x, (finite error -> 0 <= B2R error -> Rabs (B2R a - x) <= B2R error) ->
    known a (within a error) x;
  negate_known : forall a A x, known a A x -> known (opposite _ F a) (negate A) (- x);
  add_known : forall a A x b B y, known a A x -> known b B y ->
    known (a ⊕ b) (add (a ⊕ b) a A b B) (x + y);
  subtract_known : forall a A x b B y, known a A x -> known b B y ->
    known (a ⊖ b) (subtract (a ⊖ b) a A b B) (x - y);
  multiply_known : forall a A x b B y, known a A x -> known b B y ->
    known (a ⊗ b) (multiply (a ⊗ b) a A b B) (x * y);
  rescale_known : forall a A x e, known a A x ->
    known (scale _ F a e) (rescale (scale _ F a e) a A e) (x * bpow radix2 e);
  sign_known : forall a A x, known a A x -> Sign.sign_is_right (sign_given (sign a A)) x
}.

Lemma default_sign_right (a s : float) x : IeeeRules.known p emax a s x ->
  Sign.sign_is_right (sign_given (sign_of _ F a s)) x.
Proof. intros K. generalize (sign_of_known p emax p_3 a s x K). now destruct (sign_of _ F a s). Qed.

Definition tight_rule : rule.
Proof.
  refine {| bound := float; known := IeeeRules.known p emax; exact := tight_exact _ F;
    within := tight_within _ F; negate := fun s => s;
    add := fun v _ sa _ sb => tight_add _ F v sa sb; subtract := fun v _ sa _ sb => tight_add _ F v sa sb;
    multiply := tight_multiply _ F; rescale := tight_scale _ F; sign := sign_of _ F |};
    auto using tight_exact_known, tight_within_known, tight_negate_known, tight_add_known,
      tight_subtract_known, tight_multiply_known, tight_scale_known, default_sign_right.
Defined.
Definition sharp_rule : rule.
Proof.
  refine {| bound := float; known := IeeeRules.known p emax; exact := tight_exact _ F;
    within := tight_within _ F; negate := fun s => s;
    add := fun v _ sa _ sb => sharp_add _ F v sa sb; subtract := fun v _ sa _ sb => sharp_add _ F v sa sb;
    multiply := sharp_multiply _ F; rescale := sharp_scale _ F; sign := sign_of _ F |};
    auto using tight_exact_known, tight_within_known, tight_negate_known, sharp_add_known,
      sharp_subtract_known, sharp_multiply_known, sharp_scale_known, default_sign_right.
Defined.
Definition safe_rule : rule.
Proof.
  refine {| bound := float * Z; known := IeeeSafe.safe_known p emax; exact := safe_exact _ F;
    within := safe_within _ F; negate := fun b => b;
    add := fun _ _ A _ B => safe_add _ F (fst A) (snd A) (fst B) (snd B);
    subtract := fun _ _ A _ B => safe_add _ F (fst A) (snd A) (fst B) (snd B);
    multiply := fun _ a A b B => safe_multiply _ F a (fst A) (snd A) b (fst B) (snd B);
    rescale := fun v a A e => safe_scale _ F v a (fst A) (snd A) e;
    sign := fun a A => sign_of _ F a (safe_error _ F a (fst A) (snd A)) |};
    auto using IeeeSafe.safe_exact_known, IeeeSafe.safe_within_known, IeeeSafe.safe_negate_known,
      IeeeSafe.safe_add_known, IeeeSafe.safe_subtract_known, IeeeSafe.safe_multiply_known,
      IeeeSafe.safe_scale_known, default_sign_right, IeeeSafe.safe_error_known.
Defined.
Definition interval_rule (fused : bool) : rule.
Proof.
  refine {| bound := float * float; known := IeeeInterval.interval_known p emax; exact := interval_exact _ F;
    within := interval_within _ F; negate := interval_negate _ F;
    add := fun v _ A _ B => interval_add _ F v A B; subtract := fun v _ A _ B => interval_subtract _ F v A B;
    multiply := interval_multiply _ F fused; rescale := fun v _ A e => interval_scale _ F v A e;
    sign := fun _ A => interval_sign _ F A |};
    auto using IeeeInterval.interval_exact_known, IeeeInterval.interval_within_known,
      IeeeInterval.interval_negate_known, IeeeInterval.interval_add_known,
      IeeeInterval.interval_subtract_known, IeeeInterval.interval_multiply_known,
      IeeeInterval.interval_scale_known.
  intros a A x K. generalize (IeeeInterval.interval_sign_known p emax p_3 a A x K).
  now destruct (interval_sign _ F A).
Defined.
Definition residual_rule (fused : bool) : rule.
Proof.
  refine {| bound := float * float; known := IeeeResidual.residual_known p emax; exact := residual_exact _ F;
    within := residual_within _ F; negate := residual_negate _ F;
    add := residual_add _ F; subtract := residual_subtract _ F;
    multiply := residual_multiply _ F fused; rescale := residual_scale _ F;
    sign := residual_sign _ F |};
    auto using IeeeResidual.residual_exact_known, IeeeResidual.residual_within_known,
      IeeeResidual.residual_negate_known, IeeeResidual.residual_add_known,
      IeeeResidual.residual_subtract_known, IeeeResidual.residual_multiply_known,
      IeeeResidual.residual_scale_known.
  intros a A x K. generalize (IeeeResidual.residual_sign_known p emax p_3 a A x K).
  now destruct (residual_sign _ F a A).
Defined.
Definition kept_rule B by_rule holds (kept : IeeeCompound.keeps_operations p emax B by_rule holds) : rule.
Proof.
  refine {| bound := B; known := holds; exact := rule_exact _ _ (CompoundCode.the_rule _ _ by_rule);
    within := rule_within _ _ (CompoundCode.the_rule _ _ by_rule);
    negate := rule_negate _ _ (CompoundCode.the_rule _ _ by_rule);
    add := CompoundCode.rule_add _ _ by_rule; subtract := rule_subtract _ _ (CompoundCode.the_rule _ _ by_rule);
    multiply := CompoundCode.rule_multiply _ _ by_rule; rescale := CompoundCode.rule_scale _ _ by_rule;
    sign := rule_sign _ _ (CompoundCode.the_rule _ _ by_rule) |};
    destruct kept as [[] ? ? _ ? _]; auto.
  intros a A x K. generalize (promise_sign a A x K). now destruct (rule_sign _ _ _ a A).
Defined.

(** ** Tracked numbers as scalars *)

Variable r : rule.

Record tracked := Tracked {
  value : float;
  bound_of : bound r;
  meant : R;
  is_known : known r value bound_of meant
}.
Definition tracked_add (a b : tracked) : tracked :=
  Tracked _ _ _ (add_known r _ _ _ _ _ _ (is_known a) (is_known b)).
Definition tracked_sub (a b : tracked) : tracked :=
  Tracked _ _ _ (subtract_known r _ _ _ _ _ _ (is_known a) (is_known b)).
Definition tracked_mul (a b : tracked) : tracked :=
  Tracked _ _ _ (multiply_known r _ _ _ _ _ _ (is_known a) (is_known b)).
Definition tracked_opp (a : tracked) : tracked := Tracked _ _ _ (negate_known r _ _ _ (is_known a)).
Definition tracked_scale (a : tracked) (e : Z) : tracked :=
  Tracked _ _ _ (rescale_known r _ _ _ e (is_known a)).
Definition exactly (a : float) : tracked := Tracked _ _ _ (exact_known r a).

(** The code's whole numbers are numbers of the format. *)
Lemma known_equal v b x y : known r v b x -> x = y -> known r v b y.
Proof. now intros K <-. Qed.
Lemma known_unlimited a x : known r a (within r a (infinity _ F)) x.
Proof. apply within_known. discriminate. Qed.
Definition tracked_whole (n : Z) : tracked :=
  match Req_EM_T (B2R (integer _ F n)) (IZR n) with
  | left E => Tracked _ _ (IZR n) (known_equal _ _ _ _ (exact_known r (integer _ F n)) E)
  | right _ => Tracked _ _ (IZR n) (known_unlimited (integer _ F n) (IZR n))
  end.
Lemma meant_whole n : meant (tracked_whole n) = IZR n.
Proof. unfold tracked_whole. now destruct (Req_EM_T _ _). Qed.
Lemma meant_twice a : meant (tracked_scale a 1) = 2 * meant a.
Proof. apply Rmult_comm. Qed.

(** normalized(p). *)
Definition largest_of (l : list tracked) : float :=
  match l with
  | [] => integer _ F 0
  | a :: l => fold_left (fun m a => max _ F m (abs _ F (value a))) l (abs _ F (value a))
  end.
Definition exponent (x : float) : Z := mag radix2 (B2R x).
Definition normalized (l : list tracked) : list tracked :=
  let largest := largest_of l in
  let room := (emax / 16)%Z in
  if negb (less _ F (integer _ F 0) largest) || negb (is_finite _ F largest) then l
  else
    let e := exponent largest in
    if (- room <=? e)%Z && (e <=? room)%Z then l else map (fun a => tracked_scale a (- e)) l.
Lemma normalized_right l : exists c, 0 < c /\ map meant (normalized l) = map (Rmult c) (map meant l).
Proof.
  assert (Same : exists c, 0 < c /\ map meant l = map (Rmult c) (map meant l)).
  { exists 1. split; [lra |]. rewrite map_map. apply map_ext. intros. ring. }
  unfold normalized. cbv zeta. destruct (_ || _); [exact Same |]. destruct (_ && _); [exact Same |].
  exists (bpow radix2 (- exponent (largest_of l))). split; [apply bpow_gt_0 |].
  rewrite !map_map. apply map_ext. intros. apply Rmult_comm.
Qed.

Definition rule_scalar : Bernstein.scalar := {|
  Bernstein.number := tracked;
  Bernstein.add := tracked_add; Bernstein.sub := tracked_sub; Bernstein.mul := tracked_mul;
  Bernstein.opp := tracked_opp; Bernstein.whole := tracked_whole;
  Bernstein.twice := fun a => tracked_scale a 1; Bernstein.normalized := normalized;
  Bernstein.sign_of := fun a => sign_given (sign r (value a) (bound_of a)); Bernstein.exact := meant;
  Bernstein.exact_add := fun _ _ => eq_refl; Bernstein.exact_sub := fun _ _ => eq_refl;
  Bernstein.exact_mul := fun _ _ => eq_refl; Bernstein.exact_opp := fun _ => eq_refl;
  Bernstein.exact_whole := meant_whole; Bernstein.exact_twice := meant_twice;
  Bernstein.normalized_right := normalized_right;
  Bernstein.sign_right := fun a => sign_known r _ _ _ (is_known a) |}.

(** ** Queries *)

Record float_point := FloatPoint { fx : float; fy : float; fz : float }.
(** At the start and at the end of the step. *)
Definition float_motion := (float_point * float_point)%type.
Definition exact_point (q : float_point) : Contact.point := Contact.Point (B2R (fx q)) (B2R (fy q)) (B2R (fz q)).
Definition motion (m : float_motion) : Contact.moving :=
  Contact.Moving (exact_point (fst m)) (exact_point (snd m)).

(** tracked_query: unchanged coordinates, or all times 2^-e. *)
Variable chosen : option Z.
Definition coordinate (x : float) : tracked :=
  match chosen with None => exactly x | Some e => tracked_scale (exactly x) (- e) end.
Definition at_ (q : float_point) : @Decisions.position rule_scalar :=
  @Decisions.Position rule_scalar (coordinate (fx q)) (coordinate (fy q)) (coordinate (fz q)).
Definition moves (m : float_motion) : @Decisions.moving_point rule_scalar :=
  Decisions.MovingPoint (at_ (fst m)) (at_ (snd m)).

Definition unit : R := match chosen with None => 1 | Some e => bpow radix2 (- e) end.
Lemma unit_positive : 0 < unit.
Proof. unfold unit. destruct chosen; [apply bpow_gt_0 | lra]. Qed.
Lemma coordinate_meant x : meant (coordinate x) = unit * B2R x.
Proof. unfold coordinate, unit. destruct chosen; simpl; ring. Qed.
Definition all_units : Contact.point := Contact.Point unit unit unit.
Lemma moves_exactly m : Decisions.exact_motion (moves m) = AxisUnits.stretched_motion all_units (motion m).
Proof.
  destruct m as [s f]. unfold Decisions.exact_motion, Decisions.exact_position, moves, at_, motion.
  cbn [Decisions.t0 Decisions.t1 Decisions.px Decisions.py Decisions.pz fst snd Bernstein.exact rule_scalar].
  now rewrite !coordinate_meant.
Qed.
Lemma all_units_positive : AxisUnits.units all_units.
Proof. generalize unit_positive. now repeat split. Qed.

Ltac in_units units answer := intros E; rewrite <- (units _ _ _ _ _ all_units_positive); cbv zeta;
  rewrite <- !moves_exactly; exact (answer _ _ _ _ E).
Theorem tracked_face_separate v f0 f1 f2 :
  face_answer (moves v) (moves f0) (moves f1) (moves f2) = BscCode.no ->
  ~ Contact.vertex_face_collides (motion v) (motion f0) (motion f1) (motion f2).
Proof. in_units AxisUnits.face_units (@face_answer_separate rule_scalar). Qed.
Theorem tracked_face_collides v f0 f1 f2 :
  face_answer (moves v) (moves f0) (moves f1) (moves f2) = BscCode.yes ->
  Contact.vertex_face_collides (motion v) (motion f0) (motion f1) (motion f2).
Proof. in_units AxisUnits.face_units (@face_answer_collides rule_scalar). Qed.
Theorem tracked_edges_separate a0 a1 b0 b1 :
  edges_answer (moves a0) (moves a1) (moves b0) (moves b1) = BscCode.no ->
  ~ Contact.edge_edge_collides (motion a0) (motion a1) (motion b0) (motion b1).
Proof. in_units AxisUnits.edges_units (@edges_answer_separate rule_scalar). Qed.
Theorem tracked_edges_collide a0 a1 b0 b1 :
  edges_answer (moves a0) (moves a1) (moves b0) (moves b1) = BscCode.yes ->
  Contact.edge_edge_collides (motion a0) (motion a1) (motion b0) (motion b1).
Proof. in_units AxisUnits.edges_units (@edges_answer_collide rule_scalar). Qed.

End Tracked.
