(** The C++ code, line by line, over any number type, as in CompoundCode.v: functions of tracked numbers under rules
    whose operations differ from call to call (include/errbound/functions.hpp, detail/sources.hpp). For `affine`,
    each operation has its own source. The operation after k others is that of `by_rule k`. If operations are the
    same at each call, the functions are those of CompoundCode.v, which is all that is proved here:
        numbered_min_constant, numbered_max_constant, numbered_midpoint_constant, numbered_pow_constant,
        numbered_dot_constant, numbered_horner_constant, numbered_copysign_constant *)

From Coq Require Import ZArith Bool List.
From Errbound Require Import Code CompoundCode.
Import ListNotations.

(** A result of operations, as a function of the number of earlier operations, which it continues to count. *)
Definition counted (X : Type) : Type := nat -> X * nat.
Definition at_once {X} (x : X) : counted X := fun k => (x, k).
Definition after {X Y} (m : counted X) (f : X -> counted Y) : counted Y := fun k => let (x, j) := m k in f x j.
Notation "'let*' x := m 'in' n" := (after m (fun x => n)) (at level 200, x name, m at level 100, n at level 200).
Fixpoint each {S X} (f : S -> X -> counted S) (l : list X) (s : S) : counted S :=
  match l with
  | [] => at_once s
  | x :: l' => let* t := f s x in each f l' t
  end.

Section Numbered.

Context (T : Type) (A : arithmetic T) (has_fast_fma : bool) (B : Type) (by_rule : nat -> operations T B).

Notation is_finite := (is_finite T A).
Open Scope code.

(** Functions that are not operations are the same at each call. *)
Notation rule := (the_rule T B (by_rule O)).
Notation number := (T * B)%type.
Notation exactly := (tracked_exactly T B rule).
Notation error_of := (tracked_error T A B rule).
Notation sign := (tracked_sign T B rule).
Notation negate := (tracked_negate T A B rule).

Definition once (f : operations T B -> number) : counted number := fun k => (f (by_rule k), S k).
Definition numbered_within (v error : T) : counted number :=
  once (fun R => tracked_within T B (the_rule T B R) v error).
Definition numbered_add (a b : number) : counted number := once (fun R => tracked_add T A B R a b).
Definition numbered_subtract (a b : number) : counted number :=
  once (fun R => tracked_subtract T A B (the_rule T B R) a b).
Definition numbered_multiply (a b : number) : counted number := once (fun R => tracked_multiply T A B R a b).
Definition numbered_scale (a : number) (e : Z) : counted number := once (fun R => tracked_scale T A B R a e).
(** Unknown under a rule without quotients. *)
Definition numbered_divide (a b : number) : counted number := once (fun R =>
  let v := over T A (fst a) (fst b) in
  match rule_divide T B R with
  | Some divide => (v, divide v (fst a) (snd a) (fst b) (snd b))
  | None => tracked_within T B (the_rule T B R) (fst b) (infinity T A)
  end).
(** Functions with at most one operation, which is the last. *)
Definition numbered_sqrt (x : number) : counted number :=
  once (fun R => tracked_sqrt T A has_fast_fma B (the_rule T B R) x).
Definition numbered_abs (x : number) : counted number := once (fun R => tracked_abs T A B (the_rule T B R) x).
Definition numbered_fma (a b c : number) : counted number := once (fun R => tracked_fma T A B (the_rule T B R) a b c).
Definition numbered_lerp (a b t : number) : counted number := once (fun R => tracked_lerp T A B R a b t).
Definition numbered_hypot (exponent : T -> Z) (x y : number) : counted number :=
  once (fun R => tracked_hypot T A B R exponent x y).

Definition numbered_lesser_or_either (a b : number) : counted number :=
  let* difference := numbered_subtract a b in
  match sign difference with
  | negative | zero => at_once a
  | _ => numbered_within (fst a) (larger_error T A B rule a b)
  end.
Definition numbered_min (a b : number) : counted number :=
  if fst b < fst a then numbered_lesser_or_either b a else numbered_lesser_or_either a b.
Definition numbered_max (a b : number) : counted number :=
  let* lesser := if fst a < fst b then numbered_lesser_or_either (negate b) (negate a)
                 else numbered_lesser_or_either (negate a) (negate b) in
  at_once (negate lesser).

Definition numbered_midpoint (a b : number) : counted number :=
  let* sum := numbered_add a b in
  if is_finite (fst sum) && is_finite (error_of sum) then numbered_scale sum (-1)
  else
    let* half := numbered_scale a (-1) in
    let* other := numbered_scale b (-1) in
    numbered_add half other.

Fixpoint numbered_power (bits : BinNums.positive) (first : bool) (result power : number) : counted number :=
  match bits with
  | xH => if first then at_once power else numbered_multiply result power
  | xO rest => let* square := numbered_multiply power power in numbered_power rest first result square
  | xI rest =>
      let* next := if first then at_once power else numbered_multiply result power in
      let* square := numbered_multiply power power in
      numbered_power rest false next square
  end.
Definition numbered_pow (x : number) (n : Z) : counted number :=
  match n with
  | Z0 => at_once (exactly #1)
  | Zpos bits => numbered_power bits true (exactly #1) x
  | Zneg bits => let* result := numbered_power bits true (exactly #1) x in numbered_divide (exactly #1) result
  end.

(** For rules without a dot_bound. *)
Definition numbered_dot_step (sum : number) (pair : number * number) : counted number :=
  let* product := numbered_multiply (fst pair) (snd pair) in numbered_add sum product.
Definition numbered_dot (pairs : list (number * number)) : counted number :=
  match pairs with
  | [] => at_once (exactly #0)
  | first :: rest =>
      let* product := numbered_multiply (fst first) (snd first) in
      each numbered_dot_step rest (#0 + fst product, snd product)
  end.

Definition numbered_horner_step (x result c : number) : counted number :=
  let* product := numbered_multiply result x in numbered_add product c.
Definition numbered_slope_step (at_value x : number) (s : number * number) (c : number) : counted (number * number) :=
  let* there := numbered_horner_step at_value (fst s) c in
  let* product := numbered_multiply (snd s) x in
  let* slope := numbered_add product there in
  at_once (there, slope).
Definition numbered_horner (c : list number) (x : number) : counted number :=
  match c with
  | [] => at_once (exactly #0)
  | c0 :: higher =>
      match rev higher with
      | [] => at_once c0
      | top :: middle =>
          let* higher_part := each (numbered_horner_step x) middle top in
          let* result := numbered_horner_step x higher_part c0 in
          if Nat.eqb (length middle) 0 || (error_of x == #0) then at_once result
          else
            let at_value := exactly (fst x) in
            let* s := each (numbered_slope_step at_value x) middle (top, top) in
            let* difference := numbered_subtract x at_value in
            let* change := numbered_multiply (snd s) difference in
            let* there := numbered_horner_step at_value (fst s) c0 in
            let* by_slope := numbered_add there change in
            let loses_sign := is_certain (sign result) && negb (is_certain (sign by_slope)) in
            if (error_of by_slope < error_of result) && negb loses_sign then at_once (fst result, snd by_slope)
            else at_once result
      end
  end.

Definition numbered_copysign (x y : number) : counted number :=
  let* size := numbered_abs x in
  match sign y with
  | negative => at_once (negate size)
  | zero | positive => at_once size
  | uncertain =>
      let v := if fst y < #0 then - fst size else fst size in
      if negb (is_finite (fst y)) || negb (is_finite (error_of y)) then numbered_within v (infinity T A)
      else numbered_within v (enlarged T A (#2 * fst size + error_of size))
  end.

End Numbered.

(** The same operations at each call. *)
Section Constant.

Context (T : Type) (A : arithmetic T) (B : Type) (R : operations T B).
Notation rules := (fun _ : nat => R).

Lemma fst_after {X Y} (m : counted X) (f : X -> counted Y) (g : X -> Y) :
  (forall x k, fst (f x k) = g x) -> forall k, fst (after m f k) = g (fst (m k)).
Proof. intros H k. unfold after. destruct (m k) as [x j]. apply H. Qed.
Lemma fst_each {S X} (f : S -> X -> counted S) (g : S -> X -> S) :
  (forall s x k, fst (f s x k) = g s x) -> forall l s k, fst (each f l s k) = fold_left g l s.
Proof.
  intros H. induction l as [| x l IH]; intros s k; [reflexivity |]. cbn [each fold_left].
  rewrite (fst_after _ _ (fold_left g l)) by (intros; apply IH). now rewrite H.
Qed.

Lemma lesser_or_either_constant a b k : fst (numbered_lesser_or_either T A B rules a b k) =
  lesser_or_either T A B (the_rule T B R) a b.
Proof.
  unfold numbered_lesser_or_either, lesser_or_either, tracked_compare, after, numbered_subtract, once.
  now destruct (tracked_sign _ _ _ _).
Qed.
Theorem numbered_min_constant a b k : fst (numbered_min T A B rules a b k) = tracked_min T A B (the_rule T B R) a b.
Proof. unfold numbered_min, tracked_min. destruct (less T A _ _); apply lesser_or_either_constant. Qed.
Theorem numbered_max_constant a b k : fst (numbered_max T A B rules a b k) = tracked_max T A B (the_rule T B R) a b.
Proof.
  unfold numbered_max, tracked_max. rewrite (fst_after _ _ (tracked_negate T A B (the_rule T B R))) by reflexivity.
  destruct (less T A _ _); now rewrite lesser_or_either_constant.
Qed.
Theorem numbered_midpoint_constant a b k : fst (numbered_midpoint T A B rules a b k) = tracked_midpoint T A B R a b.
Proof.
  unfold numbered_midpoint, tracked_midpoint, after, numbered_add, numbered_scale, once. cbv zeta.
  now destruct (_ && _).
Qed.
Lemma power_constant bits : forall first result power k,
  fst (numbered_power T A B rules bits first result power k) = power_loop T A B R bits first result power.
Proof.
  induction bits as [bits IH | bits IH |]; intros first result power k; cbn [numbered_power power_loop].
  - destruct first; unfold after, at_once, numbered_multiply, once; apply IH.
  - unfold after, numbered_multiply, once. apply IH.
  - now destruct first.
Qed.
Theorem numbered_pow_constant x n k : fst (numbered_pow T A B rules x n k) = tracked_pow T A B R x n.
Proof.
  destruct n as [| bits | bits]; [reflexivity | apply power_constant |].
  cbn [numbered_pow tracked_pow]. set (exact := tracked_exactly _ _ _ _).
  rewrite (fst_after _ _ (fun result => fst (numbered_divide T A B rules exact result O))) by reflexivity.
  rewrite power_constant. unfold numbered_divide, once. cbn [fst]. now destruct (rule_divide T B R).
Qed.
Theorem numbered_dot_constant pairs k : fst (numbered_dot T A B rules pairs k) = tracked_dot T A B R pairs.
Proof.
  destruct pairs as [| first rest]; [reflexivity |]. cbn [numbered_dot tracked_dot].
  unfold after at 1, numbered_multiply at 1, once. cbv zeta. apply fst_each. reflexivity.
Qed.
Theorem numbered_horner_constant c x k : fst (numbered_horner T A B rules c x k) = tracked_horner T A B R c x.
Proof.
  destruct c as [| c0 higher]; [reflexivity |]. cbn [numbered_horner tracked_horner].
  destruct (rev higher) as [| top middle]; [reflexivity |]. cbv zeta.
  assert (Steps : forall s k, fst (each (numbered_horner_step T A B rules x) middle s k) =
    fold_left (horner_step T A B R x) middle s) by (intros; apply fst_each; reflexivity).
  assert (Slopes : forall v s k, fst (each (numbered_slope_step T A B rules v x) middle s k) =
    fold_left (slope_step T A B R v x) middle s) by (intros; apply fst_each; reflexivity).
  unfold after at 1. destruct (each _ middle top k) as [s j] eqn:E. assert (S := Steps top k). rewrite E in S.
  cbn [fst] in S. rewrite <- S. clear E S.
  unfold after at 1, numbered_horner_step at 1, after at 1, numbered_multiply at 1, numbered_add at 1, once.
  change (tracked_add T A B R (tracked_multiply T A B R s x) c0) with (horner_step T A B R x s c0).
  destruct (_ || _); [reflexivity |]. unfold after at 1.
  destruct (each _ middle (top, top) _) as [t i] eqn:E.
  assert (S := Slopes (tracked_exactly T B (the_rule T B R) (fst x)) (top, top) (Datatypes.S (Datatypes.S j))).
  rewrite E in S. cbn [fst] in S. rewrite <- S.
  unfold numbered_horner_step, numbered_subtract, numbered_multiply, numbered_add, after, once. cbn [fst snd].
  fold (horner_step T A B R (tracked_exactly T B (the_rule T B R) (fst x)) (fst t) c0). now destruct (_ && _).
Qed.
Theorem numbered_copysign_constant x y k : fst (numbered_copysign T A B rules x y k) = tracked_copysign T A B R x y.
Proof.
  unfold numbered_copysign, tracked_copysign, after, numbered_abs, numbered_within, once. cbv zeta.
  destruct (tracked_sign _ _ _ _); auto. now destruct (_ || _).
Qed.

End Constant.
