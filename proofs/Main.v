(** The main theorems, restated in one place for readers: the bounds of tracked numbers, signs, filters, and collision
    decisions from a query's doubles to the answer. checker.py compares each text with what Coq prints for the original,
    so no notation hides anything. The original's file has the definitions, related theorems and the proof.

    Numbers with an error bound: `..._known` theorems are about IEEE formats of p bits with exponents up to emax, rounded
    to nearest, with overflow and underflow. `known p emax a s x`: if the bound s is finite, so is the number a, and
    |a - x| <= s. `..._sound` theorems have no largest number. *)
From Coq Require Import ZArith Reals.
From Flocq Require Import Core BinarySingleNaN.
From Errbound Require IeeeRules Tight IeeeSafe IeeeInterval IeeeResidual IeeeRelative IeeeAffine IeeeAffineFunctions
  IeeeFunctions IeeeCompound IeeeDotProduct ComputedComparison Sign StaticFilter SemiStatic Predicates Intersections
  ErrorFree Words CommonFactor RootFinder Bsc TrackedBsc RoundedAxes Extents SeparatingAxis FilterStages
  InteriorContact CloseContact Exact VertexEdgeTime InteriorTime ContactPart CandidateTimes Distance Separation
  ContactWeights.
Open Scope R_scope.

(** ---- Rule `tight` (include/errbound/rules/tight.hpp), and the sign of a known number ---- *)

Theorem tight_exact_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax) (a : binary_float p emax),
  IeeeRules.known p emax a (Code.tight_exact (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a)
    (@B2R p emax a).
Proof. exact @IeeeRules.tight_exact_known. Qed.

Theorem tight_within_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a error : binary_float p emax) (x : R),
  (@is_finite p emax error = true -> 0 <= @B2R p emax error -> Rabs (@B2R p emax a - x) <= @B2R p emax error) ->
  IeeeRules.known p emax a
    (Code.tight_within (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a error) x.
Proof. exact @IeeeRules.tight_within_known. Qed.

Theorem tight_add_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a sa : binary_float p emax) (x : R) (b sb : binary_float p emax) (y : R), IeeeRules.known p emax a sa x ->
  IeeeRules.known p emax b sb y ->
  IeeeRules.known p emax (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.tight_add (binary_float p emax) (@Ieee.floats p emax p_positive p_below)
       (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) sa sb)
    (x + y).
Proof. exact @IeeeRules.tight_add_known. Qed.

Theorem tight_multiply_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a sa : binary_float p emax) (x : R) (b sb : binary_float p emax) (y : R), IeeeRules.known p emax a sa x ->
  IeeeRules.known p emax b sb y ->
  IeeeRules.known p emax (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.tight_multiply (binary_float p emax) (@Ieee.floats p emax p_positive p_below)
       (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a sa b sb)
    (x * y).
Proof. exact @IeeeRules.tight_multiply_known. Qed.

Theorem tight_divide_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a sa : binary_float p emax) (x : R) (b sb : binary_float p emax) (y : R), IeeeRules.known p emax a sa x ->
  IeeeRules.known p emax b sb y ->
  IeeeRules.known p emax (Code.over (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.tight_divide (binary_float p emax) (@Ieee.floats p emax p_positive p_below)
       (Code.over (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a sa b sb)
    (x / y) /\
  (@is_finite p emax
     (Code.tight_divide (binary_float p emax) (@Ieee.floats p emax p_positive p_below)
        (Code.over (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a sa b sb) = true ->
   y <> 0).
Proof. exact @IeeeRules.tight_divide_known. Qed.

Theorem sign_of_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a s : binary_float p emax) (x : R), IeeeRules.known p emax a s x ->
  match Code.sign_of (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a s with
  | Code.negative => x < 0
  | Code.zero => x = 0
  | Code.positive => 0 < x
  | Code.uncertain => True
  end.
Proof. exact @IeeeRules.sign_of_known. Qed.

(** ---- The same rule in any rounding direction, without overflow ---- *)

Theorem tight_add_sound :
  forall p emin : Z, Prec_gt_0 p -> (emin <= - p)%Z -> (5 <= p)%Z -> forall direction : R -> Z, Valid_rnd direction ->
  forall a x sa b y sb : R, Format.number p emin a -> Format.number p emin b -> Format.number p emin sa ->
  Format.number p emin sb -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (Format.rnd p emin direction (a + b) - (x + y)) <=
  Tight.tight_add p emin direction (Format.rnd p emin direction (a + b)) sa sb.
Proof. exact @Tight.tight_add_sound. Qed.

Theorem tight_multiply_sound :
  forall p emin : Z, Prec_gt_0 p -> (emin <= - p)%Z -> (5 <= p)%Z -> forall direction : R -> Z, Valid_rnd direction ->
  forall a x sa b y sb : R, Format.number p emin a -> Format.number p emin b -> Format.number p emin sa ->
  Format.number p emin sb -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Rabs (Format.rnd p emin direction (a * b) - x * y) <=
  Tight.tight_multiply p emin direction (Format.rnd p emin direction (a * b)) a sa b sb.
Proof. exact @Tight.tight_multiply_sound. Qed.

Theorem tight_divide_sound :
  forall p emin : Z, Prec_gt_0 p -> (emin <= - p)%Z -> (5 <= p)%Z -> forall direction : R -> Z, Valid_rnd direction ->
  forall a x sa b y sb bound : R, Format.number p emin a -> Format.number p emin b -> Format.number p emin sa ->
  Format.number p emin sb -> Rabs (a - x) <= sa -> Rabs (b - y) <= sb ->
  Tight.tight_divide p emin direction (Format.rnd p emin direction (a / b)) a sa b sb = @Some R bound ->
  y <> 0 /\ Rabs (Format.rnd p emin direction (a / b) - x / y) <= bound.
Proof. exact @Tight.tight_divide_sound. Qed.

(** ---- Rules `sharp` and `safe` ---- *)

Theorem sharp_add_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a sa : binary_float p emax) (x : R) (b sb : binary_float p emax) (y : R), IeeeRules.known p emax a sa x ->
  IeeeRules.known p emax b sb y ->
  IeeeRules.known p emax (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.sharp_add (binary_float p emax) (@Ieee.floats p emax p_positive p_below)
       (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) sa sb)
    (x + y).
Proof. exact @IeeeRules.sharp_add_known. Qed.

Theorem sharp_multiply_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a sa : binary_float p emax) (x : R) (b sb : binary_float p emax) (y : R), IeeeRules.known p emax a sa x ->
  IeeeRules.known p emax b sb y ->
  IeeeRules.known p emax (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.sharp_multiply (binary_float p emax) (@Ieee.floats p emax p_positive p_below)
       (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a sa b sb)
    (x * y).
Proof. exact @IeeeRules.sharp_multiply_known. Qed.

Theorem safe_add_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a : binary_float p emax) (A : binary_float p emax * Z) (x : R) (b : binary_float p emax)
    (B : binary_float p emax * Z) (y : R),
  IeeeSafe.safe_known p emax a A x -> IeeeSafe.safe_known p emax b B y ->
  IeeeSafe.safe_known p emax (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.safe_add (binary_float p emax) (@Ieee.floats p emax p_positive p_below)
       (@fst (binary_float p emax) Z A) (@snd (binary_float p emax) Z A) (@fst (binary_float p emax) Z B)
       (@snd (binary_float p emax) Z B)) (x + y).
Proof. exact @IeeeSafe.safe_add_known. Qed.

Theorem safe_multiply_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a : binary_float p emax) (A : binary_float p emax * Z) (x : R) (b : binary_float p emax)
    (B : binary_float p emax * Z) (y : R),
  IeeeSafe.safe_known p emax a A x -> IeeeSafe.safe_known p emax b B y ->
  IeeeSafe.safe_known p emax (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.safe_multiply (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a
       (@fst (binary_float p emax) Z A) (@snd (binary_float p emax) Z A) b (@fst (binary_float p emax) Z B)
       (@snd (binary_float p emax) Z B)) (x * y).
Proof. exact @IeeeSafe.safe_multiply_known. Qed.

Theorem safe_error_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a : binary_float p emax) (A : binary_float p emax * Z) (x : R), IeeeSafe.safe_known p emax a A x ->
  IeeeRules.known p emax a
    (Code.safe_error (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a
       (@fst (binary_float p emax) Z A) (@snd (binary_float p emax) Z A)) x.
Proof. exact @IeeeSafe.safe_error_known. Qed.

(** ---- Rules `interval`, `residual`, `relative` and `affine` ---- *)

Theorem interval_add_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a : binary_float p emax) (A : binary_float p emax * binary_float p emax) (x : R)
    (b : binary_float p emax) (B : binary_float p emax * binary_float p emax) (y : R),
  IeeeInterval.interval_known p emax a A x -> IeeeInterval.interval_known p emax b B y ->
  IeeeInterval.interval_known p emax
    (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.interval_add (binary_float p emax) (@Ieee.floats p emax p_positive p_below)
       (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) A B)
    (x + y).
Proof. exact @IeeeInterval.interval_add_known. Qed.

Theorem interval_multiply_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (fused : bool) (a : binary_float p emax) (A : binary_float p emax * binary_float p emax)
    (x : R) (b : binary_float p emax) (B : binary_float p emax * binary_float p emax)
    (y : R),
  IeeeInterval.interval_known p emax a A x -> IeeeInterval.interval_known p emax b B y ->
  IeeeInterval.interval_known p emax
    (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.interval_multiply (binary_float p emax) (@Ieee.floats p emax p_positive p_below) fused
       (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a A b B)
    (x * y).
Proof. exact @IeeeInterval.interval_multiply_known. Qed.

Theorem residual_add_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (a : binary_float p emax) (sa : binary_float p emax * binary_float p emax)
    (x : R) (b : binary_float p emax) (sb : binary_float p emax * binary_float p emax)
    (y : R),
  IeeeResidual.residual_known p emax a sa x -> IeeeResidual.residual_known p emax b sb y ->
  IeeeResidual.residual_known p emax
    (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.residual_add (binary_float p emax) (@Ieee.floats p emax p_positive p_below)
       (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a sa b sb)
    (x + y).
Proof. exact @IeeeResidual.residual_add_known. Qed.

Theorem residual_multiply_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (fused : bool) (a : binary_float p emax) (sa : binary_float p emax * binary_float p emax)
    (x : R) (b : binary_float p emax) (sb : binary_float p emax * binary_float p emax)
    (y : R),
  IeeeResidual.residual_known p emax a sa x -> IeeeResidual.residual_known p emax b sb y ->
  IeeeResidual.residual_known p emax
    (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (Code.residual_multiply (binary_float p emax) (@Ieee.floats p emax p_positive p_below) fused
       (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a sa b sb)
    (x * y).
Proof. exact @IeeeResidual.residual_multiply_known. Qed.

Theorem relative_add_known :
  forall (p emax q qmax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax)
    (q_positive : Prec_gt_0 q) (q_below : Prec_lt_emax q qmax),
  (4 <= p <= q)%Z -> (24 <= q)%Z -> (emax <= qmax)%Z -> (5 * q + 3 <= qmax)%Z ->
  forall (a : binary_float p emax) (ka : binary_float q qmax) (x : R) (b : binary_float p emax)
    (kb : binary_float q qmax) (y : R),
  IeeeRelative.relative_known p emax q qmax a ka x -> IeeeRelative.relative_known p emax q qmax b kb y ->
  IeeeRelative.relative_known p emax q qmax
    (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (RelativeCode.relative_add (binary_float p emax) (binary_float q qmax)
       (@Ieee.floats p emax p_positive p_below) (@Ieee.floats q qmax q_positive q_below)
       (@IeeeRelative.converted p emax q qmax q_positive q_below)
       (@IeeeRelative.converted q qmax p emax p_positive p_below)
       (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a ka b kb)
    (x + y).
Proof. exact @IeeeRelative.relative_add_known. Qed.

Theorem relative_multiply_known :
  forall (p emax q qmax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax)
    (q_positive : Prec_gt_0 q) (q_below : Prec_lt_emax q qmax),
  (4 <= p <= q)%Z -> (24 <= q)%Z -> (5 * q + 3 <= qmax)%Z ->
  forall (fused : bool) (a : binary_float p emax) (ka : binary_float q qmax) (x : R)
    (b : binary_float p emax) (kb : binary_float q qmax) (y : R),
  IeeeRelative.relative_known p emax q qmax a ka x -> IeeeRelative.relative_known p emax q qmax b kb y ->
  IeeeRelative.relative_known p emax q qmax
    (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (RelativeCode.relative_multiply (binary_float p emax) (binary_float q qmax)
       (@Ieee.floats p emax p_positive p_below) (@Ieee.floats q qmax q_positive q_below) fused
       (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a ka b kb)
    (x * y).
Proof. exact @IeeeRelative.relative_multiply_known. Qed.

Theorem affine_add_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (4 <= p)%Z ->
  forall (limit : nat) (e : Z -> R), Affine.units e -> forall (f : Z) (g : option Z), g = @Some Z f \/ g = @None Z ->
  forall (a b : binary_float p emax) (sa sb : AffineCode.affine (binary_float p emax)) (x y : R),
  IeeeAffine.affine_known p emax e a sa x -> IeeeAffine.affine_known p emax e b sb y ->
  IeeeAffine.is_new p emax f sa -> IeeeAffine.is_new p emax f sb ->
  IeeeAffine.made p emax e (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (AffineCode.affine_add (binary_float p emax) (@Ieee.floats p emax p_positive p_below) limit
       (Code.plus (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a sa b sb g)
    (x + y) g.
Proof. exact @IeeeAffine.affine_add_known. Qed.

Theorem affine_multiply_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (4 <= p)%Z ->
  forall (fused : bool) (limit : nat) (e : Z -> R), Affine.units e -> forall (f : Z) (g : option Z),
  g = @Some Z f \/ g = @None Z ->
  forall (a b : binary_float p emax) (sa sb : AffineCode.affine (binary_float p emax)) (x y : R),
  IeeeAffine.affine_known p emax e a sa x -> IeeeAffine.affine_known p emax e b sb y ->
  IeeeAffine.is_new p emax f sa -> IeeeAffine.is_new p emax f sb ->
  IeeeAffine.made p emax e (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b)
    (AffineCode.affine_multiply (binary_float p emax) (@Ieee.floats p emax p_positive p_below) fused limit
       (Code.times (binary_float p emax) (@Ieee.floats p emax p_positive p_below) a b) a sa b sb g)
    (x * y) g.
Proof. exact @IeeeAffine.affine_multiply_known. Qed.

Theorem computed_error :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (4 <= p)%Z ->
  forall (fused : bool) (limit : nat) (l : IeeeAffineFunctions.list_of_numbers p emax)
    (n : binary_float p emax * AffineCode.affine (binary_float p emax)) (x : R),
  @IeeeAffineFunctions.computed p emax p_positive p_below fused limit
    (@nil (binary_float p emax * AffineCode.affine (binary_float p emax) * R)) l ->
  @List.In (binary_float p emax * AffineCode.affine (binary_float p emax) * R) (n, x) l ->
  IeeeRules.known p emax (@fst (binary_float p emax) (AffineCode.affine (binary_float p emax)) n)
    (AffineCode.radius (binary_float p emax)
       (@snd (binary_float p emax) (AffineCode.affine (binary_float p emax)) n)) x.
Proof. exact @IeeeAffineFunctions.computed_error. Qed.

(** ---- Functions under every rule (include/errbound/functions.hpp) ---- *)

Theorem sqrt_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (fused : bool) (B : Type) (rule : Code.rule (binary_float p emax) B)
    (holds : binary_float p emax -> B -> R -> Prop),
  @IeeeFunctions.promises p emax p_positive p_below B rule holds -> forall (x : binary_float p emax * B) (r : R),
  IeeeFunctions.tracked_known p emax B holds x r -> IeeeFunctions.tracked_known p emax B holds
    (Code.tracked_sqrt (binary_float p emax) (@Ieee.floats p emax p_positive p_below) fused B rule x)
    (sqrt r) /\
  (@is_finite p emax
     (Code.tracked_error (binary_float p emax) (@Ieee.floats p emax p_positive p_below) B rule
        (Code.tracked_sqrt (binary_float p emax) (@Ieee.floats p emax p_positive p_below) fused B rule x)) =
   true -> 0 <= r).
Proof. exact @IeeeFunctions.sqrt_known. Qed.

Theorem fma_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (B : Type) (rule : Code.rule (binary_float p emax) B) (holds : binary_float p emax -> B -> R -> Prop),
  @IeeeFunctions.promises p emax p_positive p_below B rule holds ->
  forall (x : binary_float p emax * B) (r : R) (y : binary_float p emax * B) (s : R)
    (z : binary_float p emax * B) (t : R),
  IeeeFunctions.tracked_known p emax B holds x r -> IeeeFunctions.tracked_known p emax B holds y s ->
  IeeeFunctions.tracked_known p emax B holds z t -> IeeeFunctions.tracked_known p emax B holds
    (Code.tracked_fma (binary_float p emax) (@Ieee.floats p emax p_positive p_below) B rule x y z)
    (r * s + t).
Proof. exact @IeeeFunctions.fma_known. Qed.

Theorem dot_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (B : Type) (by_rule : CompoundCode.operations (binary_float p emax) B)
    (holds : binary_float p emax -> B -> R -> Prop),
  @IeeeCompound.keeps_operations p emax p_positive p_below B by_rule holds ->
  forall (pairs : list (binary_float p emax * B * (binary_float p emax * B))) (exacts : list (R * R)),
  @List.Forall2 (binary_float p emax * B * (binary_float p emax * B)) (R * R)
    (fun (pair : binary_float p emax * B * (binary_float p emax * B)) (exact : R * R) =>
     IeeeFunctions.tracked_known p emax B holds (@fst (binary_float p emax * B) (binary_float p emax * B) pair)
       (@fst R R exact) /\
     IeeeFunctions.tracked_known p emax B holds (@snd (binary_float p emax * B) (binary_float p emax * B) pair)
       (@snd R R exact)) pairs exacts ->
  IeeeFunctions.tracked_known p emax B holds
    (CompoundCode.tracked_dot (binary_float p emax) (@Ieee.floats p emax p_positive p_below) B by_rule pairs)
    (DotProduct.exact_dot exacts).
Proof. exact @IeeeCompound.dot_known. Qed.

Theorem horner_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (3 <= p)%Z ->
  forall (B : Type) (by_rule : CompoundCode.operations (binary_float p emax) B)
    (holds : binary_float p emax -> B -> R -> Prop),
  @IeeeCompound.keeps_operations p emax p_positive p_below B by_rule holds ->
  forall (c : list (binary_float p emax * B)) (exact : list R) (x : binary_float p emax * B) (r : R),
  @List.Forall2 (binary_float p emax * B) R (IeeeFunctions.tracked_known p emax B holds) c exact ->
  IeeeFunctions.tracked_known p emax B holds x r -> IeeeFunctions.tracked_known p emax B holds
    (CompoundCode.tracked_horner (binary_float p emax) (@Ieee.floats p emax p_positive p_below) B by_rule c x)
    (Compound.exact_horner exact r).
Proof. exact @IeeeCompound.horner_known. Qed.

Theorem tight_dot_known :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax), (5 <= p)%Z -> forall
    (pairs : list (binary_float p emax * binary_float p emax * (binary_float p emax * binary_float p emax)))
    (exacts : list (R * R)),
  (8 <= p)%Z ->
  @List.Forall2 (binary_float p emax * binary_float p emax * (binary_float p emax * binary_float p emax))
    (R * R) (IeeeDotProduct.known_pair p emax) pairs exacts ->
  let
  '(sum, bound) := CompoundCode.tight_dot (binary_float p emax) (@Ieee.floats p emax p_positive p_below) pairs
   in IeeeRules.known p emax sum bound (DotProduct.exact_dot exacts).
Proof. exact @IeeeDotProduct.tight_dot_known. Qed.

(** ---- The papers' bounds: `tight` is at most `safe` up to a factor ---- *)

Theorem tight_at_most_safe_computed :
  forall p emin : Z, Prec_gt_0 p -> (8 <= p)%Z -> (emin <= 2 - 2 * p)%Z -> forall (least v s B : R) (k : Z) (e : R),
  Format.smallest_normal p emin <= least -> ComputedComparison.computed p emin least v s B k ->
  Safe.safe_error p emin ZnearestE B k = @Some R e ->
  s <= (1 + 6 * Format.smallest_normal p emin / least) * (1 + 22 * Format.eps p) ^ Z.to_nat k * e.
Proof. exact @ComputedComparison.tight_at_most_safe_computed. Qed.

(** ---- Filters and predicates (include/errbound/filters/, predicates.hpp) ---- *)

Theorem sign_certain :
  forall v x e : R, Rabs (v - x) <= e -> Sign.sign_is_right (Sign.sign_of (Sign.finite v) (Sign.finite e)) x.
Proof. exact @Sign.sign_certain. Qed.

Theorem filter_sign_certain :
  forall p emin : Z, Prec_gt_0 p -> (2 <= p)%Z -> (emin <= 1 - 2 * p)%Z -> forall e : StaticFilter.expression,
  StaticFilter.admissible p emin e -> 64 * INR (StaticFilter.roundings p e + 2) * Format.u p <= 1 ->
  Sign.sign_is_right (StaticFilter.filter_sign p emin e) (StaticFilter.exact e).
Proof. exact @StaticFilter.filter_sign_certain. Qed.

Theorem semi_static_sign_certain :
  forall p emin : Z, Prec_gt_0 p -> forall M : R, 0 <= M -> Format.number p emin M -> (2 <= p)%Z ->
  (emin <= -4 * p - 5)%Z -> forall e : StaticFilter.expression, StaticFilter.admissible p emin e ->
  SemiStatic.homogeneous p emin M e -> (1 <= SemiStatic.whole_allowances e)%Z -> (1 <= SemiStatic.degree e)%nat ->
  (Z.of_nat (SemiStatic.degree e) <= 2 ^ (p - 6))%Z -> (1 <= StaticFilter.roundings p e)%nat ->
  64 * INR (StaticFilter.roundings p e + 3) * Format.u p <= 1 ->
  Sign.sign_is_right (SemiStatic.semi_static_sign p emin M e) (StaticFilter.exact e).
Proof. exact @SemiStatic.semi_static_sign_certain. Qed.

Theorem orient2d_sign_certain :
  forall p emin : Z, Prec_gt_0 p -> (emin <= 1 - 2 * p)%Z -> forall a b c : Predicates.point, (9 <= p)%Z ->
  Predicates.representable p emin a -> Predicates.representable p emin b -> Predicates.representable p emin c ->
  StaticFilter.roundings p (Predicates.area a b c) = (3 + 1)%nat /\
  Sign.sign_is_right (StaticFilter.filter_sign p emin (Predicates.area a b c))
    (Predicates.det2 (a 0%nat - c 0%nat) (a 1%nat - c 1%nat) (b 0%nat - c 0%nat) (b 1%nat - c 1%nat)).
Proof. exact @Predicates.orient2d_sign_certain. Qed.

Theorem orient3d_sign_certain :
  forall p emin : Z, Prec_gt_0 p -> (emin <= 1 - 2 * p)%Z -> forall a b c d : Predicates.point, (10 <= p)%Z ->
  Predicates.representable p emin a -> Predicates.representable p emin b -> Predicates.representable p emin c ->
  Predicates.representable p emin d ->
  let row := fun x : Predicates.point => (x 0%nat - d 0%nat, x 1%nat - d 1%nat, x 2%nat - d 2%nat) in
  StaticFilter.roundings p (Predicates.volume a b c d) = (7 + 1)%nat /\
  Sign.sign_is_right (StaticFilter.filter_sign p emin (Predicates.volume a b c d))
    (Predicates.det3 (row a) (row b) (row c)).
Proof. exact @Predicates.orient3d_sign_certain. Qed.

Theorem incircle_sign_certain :
  forall p emin : Z, Prec_gt_0 p -> (emin <= 1 - 2 * p)%Z -> forall a b c d : Predicates.point, (10 <= p)%Z ->
  Predicates.representable p emin a -> Predicates.representable p emin b -> Predicates.representable p emin c ->
  Predicates.representable p emin d ->
  StaticFilter.roundings p (Predicates.lifted_area a b c d Predicates.unweighted) = (10 + 1)%nat /\
  Sign.sign_is_right (StaticFilter.filter_sign p emin (Predicates.lifted_area a b c d Predicates.unweighted))
    (Predicates.det3 (Predicates.lifted2 a d) (Predicates.lifted2 b d) (Predicates.lifted2 c d)).
Proof. exact @Predicates.incircle_sign_certain. Qed.

Theorem insphere_sign_certain :
  forall p emin : Z, Prec_gt_0 p -> (emin <= 1 - 2 * p)%Z -> forall a b c d e : Predicates.point, (11 <= p)%Z ->
  Predicates.representable p emin a -> Predicates.representable p emin b -> Predicates.representable p emin c ->
  Predicates.representable p emin d -> Predicates.representable p emin e ->
  StaticFilter.roundings p (Predicates.lifted_volume a b c d e Predicates.unweighted) = (15 + 1)%nat /\
  Sign.sign_is_right
    (StaticFilter.filter_sign p emin (Predicates.lifted_volume a b c d e Predicates.unweighted))
    (Predicates.det4 (Predicates.lifted3 a e) (Predicates.lifted3 b e) (Predicates.lifted3 c e)
       (Predicates.lifted3 d e)).
Proof. exact @Predicates.insphere_sign_certain. Qed.

Theorem triangles_meet :
  forall a0 a1 a2 b0 b1 b2 : Contact.point,
  (exists p : Contact.point, Contact.in_triangle p a0 a1 a2 /\ Contact.in_triangle p b0 b1 b2) <->
  Intersections.some_edge_meets a0 a1 a2 b0 b1 b2 \/ Intersections.some_edge_meets b0 b1 b2 a0 a1 a2.
Proof. exact @Intersections.triangles_meet. Qed.

(** ---- Error-free transformations and integers of words ---- *)

Theorem two_sum_exact :
  forall p emin : Z, (emin < 0)%Z -> forall a b : R, (2 <= p)%Z -> Format.number p emin a -> Format.number p emin b ->
  @fst R R (ErrorFree.two_sum p emin a b) + @snd R R (ErrorFree.two_sum p emin a b) = a + b.
Proof. exact @ErrorFree.two_sum_exact. Qed.

Theorem two_product_exact :
  forall p emin : Z, Prec_gt_0 p -> (emin < 0)%Z -> forall a b : R, (4 <= p)%Z -> Format.number p emin a ->
  Format.number p emin b -> ErrorFree.product_error_is_exact p emin a b (ErrorFree.two_product p emin a b) ->
  @fst R R (ErrorFree.two_product p emin a b) + @snd R R (ErrorFree.two_product p emin a b) = a * b.
Proof. exact @ErrorFree.two_product_exact. Qed.

Theorem sum_exact :
  forall a b : list Z, @length Z a = @length Z b -> a <> @nil Z -> Words.words a -> Words.words b ->
  Words.fits (@length Z a) (Words.signed a + Words.signed b) ->
  Words.signed (Words.sum a b) = (Words.signed a + Words.signed b)%Z.
Proof. exact @Words.sum_exact. Qed.

Theorem product_exact :
  forall a b : list Z, a <> @nil Z -> b <> @nil Z ->
  Words.words a -> Words.words b -> Words.signed (Words.product a b) = (Words.signed a * Words.signed b)%Z.
Proof. exact @Words.product_exact. Qed.

(** ---- Roots of polynomials with integer coefficients (include/errbound/roots/) ---- *)

Theorem common_factor_right :
  forall a b c : list Z, RootIsolation.trimmed a -> RootIsolation.trimmed b -> CommonFactor.common_factor a b c ->
  RootIsolation.trimmed c /\
  (c = @nil Z <-> a = @nil Z /\ b = @nil Z) /\
  (forall x : R, RootIsolation.poly c x = 0 <-> RootIsolation.poly a x = 0 /\ RootIsolation.poly b x = 0).
Proof. exact @CommonFactor.common_factor_right. Qed.

Theorem found_roots_right :
  forall (p f : list Z) (found : list RootIsolation.interval), RootIsolation.trimmed p -> RootIsolation.poly p 0 <> 0 ->
  RootFinder.found_roots p f found -> exists roots : list R,
    @List.Forall2 RootIsolation.interval R (RootIsolation.isolates (@List.map Z R IZR f)) found roots /\
    @Sorted.StronglySorted R Rlt roots /\
    (forall x : R, @List.In R x roots <-> 0 < x /\ RootIsolation.poly p x = 0).
Proof. exact @RootFinder.found_roots_right. Qed.

(** ---- Bernstein sign classification (include/errbound/bsc.hpp) and the methods that use it ---- *)

Theorem bsc_no :
  forall (S0 : Bernstein.scalar) (y : list (Bernstein.number S0)) (gs : list (list (Bernstein.number S0)))
    (t : R),
  @length (Bernstein.number S0) y = 4%nat -> @List.Forall (list (Bernstein.number S0))
    (fun g : list (Bernstein.number S0) => @length (Bernstein.number S0) g = 5%nat) gs ->
  @BscCode.root_with_nonnegative S0 y gs = BscCode.no -> 0 <= t <= 1 -> @Bernstein.at_time S0 y t = 0 ->
  exists g : list (Bernstein.number S0),
    @List.In (list (Bernstein.number S0)) g gs /\ @Bernstein.at_time S0 g t < 0.
Proof. exact @Bsc.bsc_no. Qed.

Theorem bsc_yes :
  forall (S0 : Bernstein.scalar) (y : list (Bernstein.number S0)) (gs : list (list (Bernstein.number S0))),
  @length (Bernstein.number S0) y = 4%nat -> @List.Forall (list (Bernstein.number S0))
    (fun g : list (Bernstein.number S0) => @length (Bernstein.number S0) g = 5%nat) gs ->
  @BscCode.root_with_nonnegative S0 y gs = BscCode.yes -> exists t : R,
    0 <= t <= 1 /\
    @Bernstein.at_time S0 y t = 0 /\
    (forall g : list (Bernstein.number S0),
     @List.In (list (Bernstein.number S0)) g gs -> 0 < @Bernstein.at_time S0 g t).
Proof. exact @Bsc.bsc_yes. Qed.

Theorem tracked_face_separate :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax)
    (r : @TrackedBsc.rule p emax p_positive p_below) (chosen : option Z)
    (v f0 f1 f2 : TrackedBsc.float_motion p emax),
  @TrackedBsc.face_answer (@TrackedBsc.rule_scalar p emax p_positive p_below r)
    (@TrackedBsc.moves p emax p_positive p_below r chosen v)
    (@TrackedBsc.moves p emax p_positive p_below r chosen f0)
    (@TrackedBsc.moves p emax p_positive p_below r chosen f1)
    (@TrackedBsc.moves p emax p_positive p_below r chosen f2) = BscCode.no ->
  ~
  Contact.vertex_face_collides (TrackedBsc.motion p emax v) (TrackedBsc.motion p emax f0)
    (TrackedBsc.motion p emax f1) (TrackedBsc.motion p emax f2).
Proof. exact @TrackedBsc.tracked_face_separate. Qed.

Theorem tracked_face_collides :
  forall (p emax : Z) (p_positive : Prec_gt_0 p) (p_below : Prec_lt_emax p emax)
    (r : @TrackedBsc.rule p emax p_positive p_below) (chosen : option Z)
    (v f0 f1 f2 : TrackedBsc.float_motion p emax),
  @TrackedBsc.face_answer (@TrackedBsc.rule_scalar p emax p_positive p_below r)
    (@TrackedBsc.moves p emax p_positive p_below r chosen v)
    (@TrackedBsc.moves p emax p_positive p_below r chosen f0)
    (@TrackedBsc.moves p emax p_positive p_below r chosen f1)
    (@TrackedBsc.moves p emax p_positive p_below r chosen f2) = BscCode.yes ->
  Contact.vertex_face_collides (TrackedBsc.motion p emax v) (TrackedBsc.motion p emax f0)
    (TrackedBsc.motion p emax f1) (TrackedBsc.motion p emax f2).
Proof. exact @TrackedBsc.tracked_face_collides. Qed.

Theorem bsc_exact_face_by_isolation :
  forall (common : list Z -> list Z -> list Z) (squarefree : list Z -> list Z)
    (intervals : list Z -> list RootIsolation.interval)
    (sign_there : list Z -> list Z -> RootIsolation.interval -> Sign.sign)
    (v f0 f1 f2 : UnboundedIntegers.given),
  UnboundedIntegers.face_border_meets (RootFinder.isolation common squarefree intervals sign_there)
    (RootFinder.returned common squarefree intervals sign_there) v f0 f1 f2 ->
  BscExact.bsc_exact_decides_face (RootFinder.isolation common squarefree intervals sign_there) v f0 f1 f2 =
  true <-> Contact.vertex_face_collides (UnboundedIntegers.given_motion v) (UnboundedIntegers.given_motion f0)
    (UnboundedIntegers.given_motion f1) (UnboundedIntegers.given_motion f2).
Proof. exact @RootFinder.bsc_exact_face_by_isolation. Qed.

(** ---- The stages of `exact`, from the first test to the last; each file has the same theorem for two edges ---- *)

Theorem swept_face_separate :
  forall direction : R -> Z, Valid_rnd direction -> forall c s : R, 0 <= s ->
  forall (k : nat) (v f0 f1 f2 : Contact.moving),
  RoundedAxes.ends_before direction c s k v (@nil Contact.moving) f0 (f1 :: f2 :: @nil Contact.moving) \/
  RoundedAxes.ends_before direction c s k f0 (f1 :: f2 :: @nil Contact.moving) v (@nil Contact.moving) ->
  ~ Contact.vertex_face_collides v f0 f1 f2.
Proof. exact @RoundedAxes.swept_face_separate. Qed.

Theorem rounded_face_separate :
  forall direction : R -> Z, Valid_rnd direction -> forall low high : Contact.point,
  Format.number 53 (-1074) (Contact.x low) /\
  Format.number 53 (-1074) (Contact.y low) /\ Format.number 53 (-1074) (Contact.z low) ->
  Format.number 53 (-1074) (Contact.x high) /\
  Format.number 53 (-1074) (Contact.y high) /\ Format.number 53 (-1074) (Contact.z high) -> RoundedAxes.bounded low ->
  RoundedAxes.bounded high -> forall v f0 f1 f2 : Contact.moving, RoundedAxes.in_frame low high v ->
  RoundedAxes.in_frame low high f0 -> RoundedAxes.in_frame low high f1 -> RoundedAxes.in_frame low high f2 ->
  RoundedAxes.separated_in_float direction
    (fun (a : RoundedAxes.float_axis) (e : bool) =>
     let at_ :=
       fun q : Contact.moving =>
       @fst (Contact.point -> R) Contact.point a
         (RoundedAxes.rounded_point direction (RoundedAxes.frame_of direction low high)
            (SeparatingAxis.at_end q e)) in
     RoundedAxes.face_gap direction (at_ v) (at_ f0) (at_ f1) (at_ f2)) = true ->
  ~ Contact.vertex_face_collides v f0 f1 f2.
Proof. exact @RoundedAxes.rounded_face_separate. Qed.

Theorem apart_face_separate :
  forall direction : R -> Z, Valid_rnd direction -> forall low high : Contact.point,
  Format.number 53 (-1074) (Contact.x low) /\
  Format.number 53 (-1074) (Contact.y low) /\ Format.number 53 (-1074) (Contact.z low) ->
  Format.number 53 (-1074) (Contact.x high) /\
  Format.number 53 (-1074) (Contact.y high) /\ Format.number 53 (-1074) (Contact.z high) -> RoundedAxes.bounded low ->
  RoundedAxes.bounded high -> forall (v f0 f1 f2 : Contact.moving) (G H : Extents.extents),
  RoundedAxes.in_frame low high v -> RoundedAxes.in_frame low high f0 -> RoundedAxes.in_frame low high f1 ->
  RoundedAxes.in_frame low high f2 ->
  Extents.holds G (Extents.of_element direction low high v (@nil Contact.moving)) ->
  Extents.holds H (Extents.of_element direction low high f0 (f1 :: f2 :: @nil Contact.moving)) ->
  Extents.apart direction G H = true \/ Extents.apart direction H G = true ->
  ~ Contact.vertex_face_collides v f0 f1 f2.
Proof. exact @Extents.apart_face_separate. Qed.

Theorem separated_face_separate :
  forall direction : R -> Z, Valid_rnd direction -> forall m : Contact.point, Format.number 53 (-1074) (Contact.x m) /\
  Format.number 53 (-1074) (Contact.y m) /\ Format.number 53 (-1074) (Contact.z m) ->
  0 <= Contact.x m /\ 0 <= Contact.y m /\ 0 <= Contact.z m -> forall v f0 f1 f2 : Contact.moving,
  SeparatingAxis.numbers v -> SeparatingAxis.numbers f0 -> SeparatingAxis.numbers f1 -> SeparatingAxis.numbers f2 ->
  SeparatingAxis.sized m (SeparatingAxis.differences_of direction f1 f0 f2 f0 v f0) -> SeparatingAxis.separated
    (SeparatingAxis.face_sides direction (SeparatingAxis.differences_of direction f1 f0 f2 f0 v f0))
    (SeparatingAxis.coordinate_axes (Contact.x m) (Contact.y m) (Contact.z m)) = true \/
  SeparatingAxis.separated
    (SeparatingAxis.face_sides direction (SeparatingAxis.differences_of direction f1 f0 f2 f0 v f0))
    (SeparatingAxis.diagonal_axes direction (Contact.x m) (Contact.y m) (Contact.z m)) = true ->
  ~ Contact.vertex_face_collides v f0 f1 f2.
Proof. exact @SeparatingAxis.separated_face_separate. Qed.

Theorem filter_face_separate :
  forall direction : R -> Z, Valid_rnd direction -> forall v f0 f1 f2 : Contact.moving, SeparatingAxis.numbers v ->
  SeparatingAxis.numbers f0 -> SeparatingAxis.numbers f1 -> SeparatingAxis.numbers f2 ->
  FilterStages.filter_face direction v f0 f1 f2 = Subdivision.separate -> ~ Contact.vertex_face_collides v f0 f1 f2.
Proof. exact @FilterStages.filter_face_separate. Qed.

Theorem filter_face_collides :
  forall direction : R -> Z, Valid_rnd direction -> forall v f0 f1 f2 : Contact.moving, SeparatingAxis.numbers v ->
  SeparatingAxis.numbers f0 -> SeparatingAxis.numbers f1 -> SeparatingAxis.numbers f2 ->
  FilterStages.filter_face direction v f0 f1 f2 = Subdivision.collides -> Contact.vertex_face_collides v f0 f1 f2.
Proof. exact @FilterStages.filter_face_collides. Qed.

Theorem face_decision_right :
  forall unit : Contact.point, AxisUnits.units unit ->
  forall (extent_x extent_y extent_z : Z) (estimate : CubicRoots.part -> Z)
    (refine : Z -> CubicRoots.part -> Z -> Z -> Z -> Z) (steps : nat) (m0 m1 m2 m3 : Contact.moving)
    (v f0 f1 f2 : @Decisions.moving_point AxisUnits.integers),
  AxisUnits.in_integers unit m0 v -> AxisUnits.in_integers unit m1 f0 -> AxisUnits.in_integers unit m2 f1 ->
  AxisUnits.in_integers unit m3 f2 -> let found :=
    InteriorContact.contact_of false extent_x extent_y extent_z estimate refine steps m0 m1 m2 m3 v f0 f1 f2 in
  (found = Subdivision.collides -> Contact.vertex_face_collides m0 m1 m2 m3) /\
  (found = Subdivision.separate -> ~ Contact.vertex_face_collides m0 m1 m2 m3).
Proof. exact @InteriorContact.face_decision_right. Qed.

Theorem face_to_the_end_right :
  forall unit : Contact.point, AxisUnits.units unit ->
  forall (extent_x extent_y extent_z : Z) (estimate : CubicRoots.part -> Z)
    (refine : Z -> CubicRoots.part -> Z -> Z -> Z -> Z) (steps more : nat) (estimated_root : list Z -> Z -> Z)
    (root_exponent : list Z -> Z) (estimated_pair : list Z -> option ((Z -> Z) * Z))
    (m0 m1 m2 m3 : Contact.moving) (v f0 f1 f2 : @Decisions.moving_point AxisUnits.integers),
  AxisUnits.in_integers unit m0 v -> AxisUnits.in_integers unit m1 f0 -> AxisUnits.in_integers unit m2 f1 ->
  AxisUnits.in_integers unit m3 f2 -> CloseContact.below 253 (@Decisions.difference AxisUnits.integers f1 f0) ->
  CloseContact.below 253 (@Decisions.difference AxisUnits.integers f2 f0) ->
  CloseContact.below 253 (@Decisions.difference AxisUnits.integers v f0) -> let found :=
    CloseContact.decide_to_the_end false extent_x extent_y extent_z estimate refine steps estimated_root
      root_exponent estimated_pair more m0 m1 m2 m3 v f0 f1 f2 in
  (found = Subdivision.collides -> Contact.vertex_face_collides m0 m1 m2 m3) /\
  (found = Subdivision.separate -> ~ Contact.vertex_face_collides m0 m1 m2 m3).
Proof. exact @CloseContact.face_to_the_end_right. Qed.

Theorem reference_face_by_isolation :
  forall (common : list Z -> list Z -> list Z) (squarefree : list Z -> list Z)
    (intervals : list Z -> list RootIsolation.interval)
    (sign_there : list Z -> list Z -> RootIsolation.interval -> Sign.sign)
    (v f0 f1 f2 : UnboundedIntegers.given),
  Reference.reference_face_meets (RootFinder.isolation common squarefree intervals sign_there)
    (RootFinder.returned common squarefree intervals sign_there) v f0 f1 f2 ->
  Reference.reference_decides_face (RootFinder.isolation common squarefree intervals sign_there) v f0 f1 f2 =
  true <-> Contact.vertex_face_collides (UnboundedIntegers.given_motion v) (UnboundedIntegers.given_motion f0)
    (UnboundedIntegers.given_motion f1) (UnboundedIntegers.given_motion f2).
Proof. exact @RootFinder.reference_face_by_isolation. Qed.

(** ---- The answer of `exact`, by any stage ---- *)

Theorem exact_face_right :
  forall direction : R -> Z, Valid_rnd direction ->
  forall (extent_x extent_y extent_z : Z) (estimate : CubicRoots.part -> Z)
    (refine : Z -> CubicRoots.part -> Z -> Z -> Z -> Z) (steps more : nat) (estimated_root : list Z -> Z -> Z)
    (root_exponent : list Z -> Z) (estimated_pair : list Z -> option ((Z -> Z) * Z))
    (common : list Z -> list Z -> list Z) (squarefree : list Z -> list Z)
    (intervals : list Z -> list RootIsolation.interval)
    (sign_there : list Z -> list Z -> RootIsolation.interval -> Sign.sign)
    (v f0 f1 f2 : UnboundedIntegers.given),
  SeparatingAxis.numbers (UnboundedIntegers.given_motion v) ->
  SeparatingAxis.numbers (UnboundedIntegers.given_motion f0) ->
  SeparatingAxis.numbers (UnboundedIntegers.given_motion f1) ->
  SeparatingAxis.numbers (UnboundedIntegers.given_motion f2) -> (Exact.all_undecided
     (Exact.face_stages direction extent_x extent_y extent_z estimate refine steps more estimated_root
        root_exponent estimated_pair v f0 f1 f2) ->
   Reference.reference_face_meets (RootFinder.isolation common squarefree intervals sign_there)
     (RootFinder.returned common squarefree intervals sign_there) v f0 f1 f2) ->
  Exact.exact_face direction extent_x extent_y extent_z estimate refine steps more estimated_root root_exponent
    estimated_pair common squarefree intervals sign_there v f0 f1 f2 = true <->
  Contact.vertex_face_collides (UnboundedIntegers.given_motion v) (UnboundedIntegers.given_motion f0)
    (UnboundedIntegers.given_motion f1) (UnboundedIntegers.given_motion f2).
Proof. exact @Exact.exact_face_right. Qed.

Theorem exact_edges_right :
  forall direction : R -> Z, Valid_rnd direction ->
  forall (extent_x extent_y extent_z : Z) (estimate : CubicRoots.part -> Z)
    (refine : Z -> CubicRoots.part -> Z -> Z -> Z -> Z) (steps more : nat) (estimated_root : list Z -> Z -> Z)
    (root_exponent : list Z -> Z) (estimated_pair : list Z -> option ((Z -> Z) * Z))
    (common : list Z -> list Z -> list Z) (squarefree : list Z -> list Z)
    (intervals : list Z -> list RootIsolation.interval)
    (sign_there : list Z -> list Z -> RootIsolation.interval -> Sign.sign)
    (a0 a1 b0 b1 : UnboundedIntegers.given),
  SeparatingAxis.numbers (UnboundedIntegers.given_motion a0) ->
  SeparatingAxis.numbers (UnboundedIntegers.given_motion a1) ->
  SeparatingAxis.numbers (UnboundedIntegers.given_motion b0) ->
  SeparatingAxis.numbers (UnboundedIntegers.given_motion b1) -> (Exact.all_undecided
     (Exact.edges_stages direction extent_x extent_y extent_z estimate refine steps more estimated_root
        root_exponent estimated_pair a0 a1 b0 b1) ->
   Reference.reference_edges_meets (RootFinder.isolation common squarefree intervals sign_there)
     (RootFinder.returned common squarefree intervals sign_there) a0 a1 b0 b1) ->
  Exact.exact_edges direction extent_x extent_y extent_z estimate refine steps more estimated_root root_exponent
    estimated_pair common squarefree intervals sign_there a0 a1 b0 b1 = true <->
  Contact.edge_edge_collides (UnboundedIntegers.given_motion a0) (UnboundedIntegers.given_motion a1)
    (UnboundedIntegers.given_motion b0) (UnboundedIntegers.given_motion b1).
Proof. exact @Exact.exact_edges_right. Qed.

Theorem batch_face_right :
  forall direction : R -> Z, Valid_rnd direction ->
  forall (extent_x extent_y extent_z : Z) (estimate : CubicRoots.part -> Z)
    (refine : Z -> CubicRoots.part -> Z -> Z -> Z -> Z) (steps more : nat) (estimated_root : list Z -> Z -> Z)
    (root_exponent : list Z -> Z) (estimated_pair : list Z -> option ((Z -> Z) * Z))
    (common : list Z -> list Z -> list Z) (squarefree : list Z -> list Z)
    (intervals : list Z -> list RootIsolation.interval)
    (sign_there : list Z -> list Z -> RootIsolation.interval -> Sign.sign) (culls : list Subdivision.outcome)
    (v f0 f1 f2 : UnboundedIntegers.given),
  SeparatingAxis.numbers (UnboundedIntegers.given_motion v) ->
  SeparatingAxis.numbers (UnboundedIntegers.given_motion f0) ->
  SeparatingAxis.numbers (UnboundedIntegers.given_motion f1) ->
  SeparatingAxis.numbers (UnboundedIntegers.given_motion f2) -> @List.Forall Subdivision.outcome
    (Exact.sound
       (Contact.vertex_face_collides (UnboundedIntegers.given_motion v) (UnboundedIntegers.given_motion f0)
          (UnboundedIntegers.given_motion f1) (UnboundedIntegers.given_motion f2))) culls ->
  (Exact.all_undecided
     (culls ++
      Exact.face_stages direction extent_x extent_y extent_z estimate refine steps more estimated_root
        root_exponent estimated_pair v f0 f1 f2) ->
   Reference.reference_face_meets (RootFinder.isolation common squarefree intervals sign_there)
     (RootFinder.returned common squarefree intervals sign_there) v f0 f1 f2) ->
  Exact.first_certain
    (culls ++
     Exact.face_stages direction extent_x extent_y extent_z estimate refine steps more estimated_root
       root_exponent estimated_pair v f0 f1 f2)
    (Reference.reference_decides_face (RootFinder.isolation common squarefree intervals sign_there) v f0 f1 f2) =
  true <-> Contact.vertex_face_collides (UnboundedIntegers.given_motion v) (UnboundedIntegers.given_motion f0)
    (UnboundedIntegers.given_motion f1) (UnboundedIntegers.given_motion f2).
Proof. exact @Exact.batch_face_right. Qed.

(** ---- First times and distances (ccd/contact/); each file has the same theorem for two edges ---- *)

Theorem first_bracket_right :
  forall double : R -> Prop, double 0 -> double 1 -> forall v e0 e1 : Contact.moving,
  let place := VertexEdgeTime.first_vertex_edge_contact v e0 e1 in
  place = VertexEdge.nowhere /\ ~ Contact.vertex_edge_collides v e0 e1 \/
  place <> VertexEdge.nowhere /\
  (exists t : R,
     Separation.first (FirstContact.vertex_on_edge v e0 e1) t /\
     (forall b : TimeBrackets.bracket,
      VertexEdgeTime.place_bracket double place b -> TimeBrackets.holds_time double b t)).
Proof. exact @VertexEdgeTime.first_bracket_right. Qed.

Theorem face_time_right :
  forall double : R -> Prop,
  (forall n bits : Z, (0 <= bits <= 40)%Z -> (0 <= n <= 2 ^ bits)%Z -> double (CubicRoots.over n bits)) -> double 2 ->
  (forall t : R, 0 <= t <= 1 -> exists b : TimeBrackets.bracket, TimeBrackets.holds_time double b t) ->
  forall (part_root : list R -> CubicRoots.part -> option TimeBrackets.bracket)
    (linear_root : R -> R -> option TimeBrackets.bracket),
  (forall (y : list R) (q : CubicRoots.part) (found : TimeBrackets.bracket),
   part_root y q = @Some TimeBrackets.bracket found ->
   TimeBrackets.search double (CubicRoots.at_ y) (CubicRoots.unit_of (CubicRoots.first (CubicRoots.roots q)))
     (CubicRoots.part_start q) (CubicRoots.part_end q) found) ->
  (forall (p0 p1 : R) (found : TimeBrackets.bracket),
   linear_root p0 p1 = @Some TimeBrackets.bracket found -> TimeBrackets.linear_bracket double p0 p1 found) ->
  forall (extent_x extent_y extent_z : Z) (estimate : CubicRoots.part -> Z)
    (refine : Z -> CubicRoots.part -> Z -> Z -> Z -> Z) (place_of : R -> Z -> Z) (steps : nat)
    (unit : Contact.point),
  AxisUnits.units unit ->
  forall (m0 m1 m2 m3 : Contact.moving) (v f0 f1 f2 : @Decisions.moving_point AxisUnits.integers)
    (o0 o1 o2 : option TimeBrackets.bracket),
  AxisUnits.in_integers unit m0 v -> AxisUnits.in_integers unit m1 f0 -> AxisUnits.in_integers unit m2 f1 ->
  AxisUnits.in_integers unit m3 f2 -> InteriorTime.border_time double m0 m1 m2 v f0 f1 o0 ->
  InteriorTime.border_time double m0 m2 m3 v f1 f2 o1 -> InteriorTime.border_time double m0 m3 m1 v f2 f0 o2 ->
  let o := IntegerTimes.earlier (IntegerTimes.earlier o0 o1) o2 in
  let s :=
    InteriorTime.find false (@Decisions.difference AxisUnits.integers f1 f0)
      (@Decisions.difference AxisUnits.integers f2 f0) (@Decisions.difference AxisUnits.integers v f0) extent_x
      extent_y extent_z estimate refine
      (part_root
         (@List.map Z R IZR
            (@Decisions.y_form AxisUnits.integers (@Decisions.difference AxisUnits.integers f1 f0)
               (@Decisions.difference AxisUnits.integers f2 f0) (@Decisions.difference AxisUnits.integers v f0))))
      linear_root place_of steps (IntegerTimes.last_of o) in
  IntegerTimes.unplaced s = false -> IntegerTimes.found s <> Subdivision.undecided ->
  IntegerTimes.told double (FirstContact.face_touches m0 m1 m2 m3)
    (IntegerTimes.composed o (InteriorTime.inside_time s)).
Proof. exact @InteriorTime.face_time_right. Qed.

Theorem face_part_bracket :
  forall (S : Type) (none : S) (midpoint : S -> S -> S) (sign_y : S -> Sign.sign)
    (stands_y : nat -> S -> R -> Prop) (max_y : nat),
  @Subdivision.reads S midpoint sign_y stands_y max_y ->
  forall (double : R -> Prop) (v f0 f1 f2 : Contact.moving) (Y : list R) (Gs : list (list R))
    (k l low high : R) (p : list S) (before : R) (b : TimeBrackets.bracket),
  0 < k -> 0 < l -> (forall t : R, Subdivision.control_at Y t = k * FirstContact.face_y v f0 f1 f2 t) ->
  (forall t : R,
   @List.map (list R) R (fun G : list R => Subdivision.control_at G t) Gs =
   @List.map R R (Rmult l)
     (let B := Contact.minus (Contact.place f1 t) (Contact.place f0 t) in
      let C := Contact.minus (Contact.place f2 t) (Contact.place f0 t) in
      let P := Contact.minus (Contact.place v t) (Contact.place f0 t) in
      Contact.weight_2 B C P :: Contact.weight_1 B C P :: Contact.weight_0 B C P :: @nil R)) ->
  @ContactPart.part_is S none sign_y stands_y max_y Y Gs low high p ->
  @ContactPart.changes_sign_once S sign_y p = true -> 0 < before * FirstContact.face_y v f0 f1 f2 low ->
  TimeBrackets.search double (FirstContact.face_y v f0 f1 f2) before low high b -> exists r : R,
    Separation.first (FirstContact.face_touches v f0 f1 f2) r /\
    low < r < high /\ TimeBrackets.holds_time double b r.
Proof. exact @ContactPart.face_part_bracket. Qed.

Theorem first_time_of_right :
  forall double : R -> Prop,
  (forall t : R, 0 <= t <= 1 -> exists b : TimeBrackets.bracket, TimeBrackets.holds_time double b t) ->
  forall last : R, double last -> forall (H : R -> Prop) (parts : list (R -> Prop)) (o : option TimeBrackets.bracket),
  0 <= last <= 1 -> ~ H 0 -> (Contact.sometime H -> exists t : R, Separation.first H t) ->
  (forall t : R, Separation.first H t -> t <> 0 -> exists P : R -> Prop, @List.In (R -> Prop) P parts /\ P t) ->
  (forall (t : R) (P : R -> Prop), 0 <= t <= 1 -> @List.In (R -> Prop) P parts -> P t -> H t) ->
  CandidateTimes.loop double last (@None TimeBrackets.bracket) parts o -> CandidateTimes.told_until double last H o.
Proof. exact @CandidateTimes.first_time_of_right. Qed.

Theorem face_near_time_of :
  forall double : R -> Prop,
  (forall t : R, 0 <= t <= 1 -> exists b : TimeBrackets.bracket, TimeBrackets.holds_time double b t) ->
  forall last : R, double last ->
  forall (D : R) (v f0 f1 f2 : Contact.moving) (parts : list (R -> Prop)) (o : option TimeBrackets.bracket),
  0 <= last <= 1 ->
  ~ Distance.face_near D (Contact.place v 0) (Contact.place f0 0) (Contact.place f1 0) (Contact.place f2 0) ->
  CandidateTimes.parts_of (FirstConditions.all_face_near_in_time D v f0 f1 f2) parts ->
  CandidateTimes.loop double last (@None TimeBrackets.bracket) parts o -> CandidateTimes.told_until double last
    (fun t : R =>
     Distance.face_near D (Contact.place v t) (Contact.place f0 t) (Contact.place f1 t) (Contact.place f2 t)) o.
Proof. exact @CandidateTimes.face_near_time_of. Qed.

Theorem face_within_union :
  forall (D : R) (v f0 f1 f2 : Contact.point), Distance.face_near D v f0 f1 f2 <->
  @List.Exists Distance.condition (Distance.holds D) (Distance.face_conditions v f0 f1 f2).
Proof. exact @Distance.face_within_union. Qed.

Theorem coordinates_apart :
  forall fexp : Z -> Z, Valid_exp fexp -> forall direction : R -> Z, Valid_rnd direction ->
  forall (c : Separation.coordinate) (d0 d1 : R) (ps qs : list Contact.moving),
  let distance := succ radix2 fexp (round radix2 fexp direction (d0 + d1)) in
  Separation.coordinates_above fexp direction c distance ps qs ->
  Separation.above_along (Separation.unit_axis c) (d0 + d1) ps qs.
Proof. exact @Separation.coordinates_apart. Qed.

Theorem weights_right :
  forall (told : list (R * R)) (weights : list R), @List.Forall2 (R * R) R ContactWeights.told_right told weights ->
  (1 <= @length (R * R) told <= 2)%nat ->
  @List.Forall (R * R) (fun t : R * R => Format.number 53 (-1074) (@snd R R t)) told ->
  ContactWeights.sum weights <= 1 -> let
  '(found, first, error) := ContactWeights.cut told 1 0 in
   @List.Forall2 R R (fun f w : R => 0 <= f <= 1 /\ Rabs (f - w) <= ContactWeights.weight_error error) found
     weights /\
   0 <= first <= 1 /\ Rabs (first - (1 - ContactWeights.sum weights)) <= ContactWeights.weight_error error.
Proof. exact @ContactWeights.weights_right. Qed.
