(** Certain signs: sign_of of include/errbound/tracked.hpp. Results:
        sign_certain   negative, zero and positive are right if the error is a bound
        sign_unknown   with an infinite or NaN error, every sign is uncertain, for every value (also infinite and
            NaN). So
                       overflow, for which rules return such an error, gives uncertain signs *)

From Coq Require Import Reals Lra Bool.
From Flocq Require Import Core.
Open Scope R_scope.

Inductive sign := negative | zero | positive | uncertain.

(** A value of an IEEE format, and its comparisons. *)
Inductive ieee := finite (x : R) | plus_infinity | minus_infinity | nan.
Definition negated (x : ieee) : ieee :=
  match x with
  | finite x => finite (- x)
  | plus_infinity => minus_infinity
  | minus_infinity => plus_infinity
  | nan => nan
  end.
Definition less (x y : ieee) : bool :=
  match x, y with
  | finite x, finite y => Rlt_bool x y
  | finite _, plus_infinity | minus_infinity, finite _ | minus_infinity, plus_infinity => true
  | _, _ => false
  end.
Definition equals_0 (x : ieee) : bool :=
  match x with finite x => Req_bool x 0 | _ => false end.

(** The code. *)
Definition sign_of (value error : ieee) : sign :=
  if less error value then positive
  else if less value (negated error) then negative
  else if equals_0 value && equals_0 error then zero
  else uncertain.

Definition sign_is_right (s : sign) (x : R) : Prop :=
  match s with
  | negative => x < 0
  | zero => x = 0
  | positive => 0 < x
  | uncertain => True
  end.

Theorem sign_certain v x e : Rabs (v - x) <= e -> sign_is_right (sign_of (finite v) (finite e)) x.
Proof.
  intros H. apply Rabs_le_inv in H. unfold sign_of. simpl.
  destruct (Rlt_bool_spec e v); [simpl; lra |].
  destruct (Rlt_bool_spec v (- e)); [simpl; lra |].
  destruct (Req_bool_spec v 0), (Req_bool_spec e 0); simpl; auto. lra.
Qed.

Theorem sign_unknown v e : e = plus_infinity \/ e = nan -> sign_of v e = uncertain.
Proof. intros [-> | ->]; destruct v; simpl; auto; unfold sign_of; simpl; now rewrite andb_false_r. Qed.
