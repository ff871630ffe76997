(** Exact real roots of polynomials of any degree (include/errbound/roots/root_isolation.hpp, descartes_search.hpp):
    if the algorithm ends, its answer is right. Polynomials are ascending lists of coefficients in the power basis.
    The proofs allow any points at which intervals are split, so any floating-point hints. They are over the real
    numbers, since the code's points are exact. Results:
        on_part_right        each root between two points is in exactly one of the intervals found
        isolate_right        the same for all roots in [low, high]
        keep_part_right      narrowing keeps the root
        secant_part_right    the secant selects one of the 2^bits subintervals
        sign_at_root_right   the sign of g at a root of a square-free polynomial
        squarefree_part_roots, real_roots_right   the roots of p in (0, oo), by those of its square-free part *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool Sorted.
From Errbound Require Import Sign Bernstein SignVariations.
Import ListNotations.
Open Scope R_scope.

(** ** Polynomials *)

(** With integer coefficients (include/errbound/roots/integer_polynomial.hpp): the last one is not zero; empty
    is identically zero. *)
Notation reals_of := (map IZR).
Definition poly (p : list Z) (x : R) : R := power_form (reals_of p) x.
Definition trimmed (p : list Z) : Prop := p = [] \/ last p 0%Z <> 0%Z.

Lemma without_root p c : exists q, length q = pred (length p) /\
  forall x, power_form p x = power_form p c + (x - c) * power_form q x.
Proof.
  induction p as [| a l (q & L & E)]; [exists []; split; [easy | intros; simpl; ring] |].
  destruct l as [| b l]; [exists []; split; [easy | intros; simpl; ring] |].
  exists (power_form (b :: l) c :: q). split; [simpl in *; lia |]. intros x.
  change (power_form (a :: b :: l) x) with (a + x * power_form (b :: l) x).
  change (power_form (a :: b :: l) c) with (a + c * power_form (b :: l) c). rewrite E. simpl. ring.
Qed.
(** Zero between two points implies zero everywhere. *)
Lemma zero_between p lo hi : lo < hi -> (forall x, lo < x < hi -> power_form p x = 0) -> forall x, power_form p x = 0.
Proof.
  remember (length p) as n eqn:N. revert p N lo. induction n as [| n IH]; intros p N lo L Z x.
  - destruct p; [easy | discriminate].
  - set (c := (lo + hi) / 2). assert (C : lo < c < hi) by (unfold c; lra).
    destruct (without_root p c) as (q & Lq & E). rewrite E, (Z c C), (IH q ltac:(simpl; lia) c (proj2 C)); [ring |].
    intros y Y. specialize (E y). rewrite (Z y ltac:(lra)), (Z c C) in E.
    apply Rmult_eq_reg_l with (y - c); lra.
Qed.

Definition not_zero (p : list R) : Prop := exists x, power_form p x <> 0.

(** Coefficients h of a positive multiple of p on [lo, hi]; and control values b. *)
Definition stands_for (h p : list R) (lo hi : R) : Prop :=
  exists c, 0 < c /\ forall t, on_unit h t = c * power_form p (lo + t * (hi - lo)).
Definition controls (b p : list R) (lo hi : R) : Prop := stands_for (scaled_coefficients b) p lo hi.

Lemma sgn_multiple c x : 0 < c -> sgn (c * x) = sgn x.
Proof. intros C. destruct (sgn_cases x) as [(L & ->) | [(L & ->) | (L & ->)]], (sgn_cases (c * x)) as [(K & ->) | [(K & ->) | (K & ->)]]; auto; exfalso; nra. Qed.
Lemma binomials_positive n : Forall (Rlt 0) (binomials n).
Proof.
  induction n as [| n IH]; [repeat constructor; lra |]. simpl.
  assert (G : forall a b, 0 <= b -> Forall (Rlt 0) a -> Forall (Rlt 0)
    (map (fun xy => fst xy + snd xy) (combine (a ++ [0]) (b :: a))) \/ (a = [] /\ b = 0)).
  { induction a as [| x a IHa]; intros b B F.
    - destruct (Rle_lt_or_eq_dec 0 b B) as [P | P]; [left; repeat constructor; simpl; lra | now right].
    - inversion_clear F as [| ? ? X F']. left. simpl. constructor; [simpl; lra |].
      destruct (IHa x ltac:(lra) F') as [G | (_ & K)]; [easy | lra]. }
  destruct (G (binomials n) 0) as [H | (H & _)]; auto; [lra |]. pose proof (length_binomials n) as L. rewrite H in L. discriminate.
Qed.
Lemma signs_of_products c b : Forall (Rlt 0) c -> length c = length b -> map sgn (products c b) = map sgn b.
Proof.
  intros F. revert b. induction F as [| x c X F IH]; intros [| y b] L; try discriminate; [easy |].
  injection L as L. simpl. rewrite IH, sgn_multiple; auto.
Qed.
Lemma scaled_signs b : map sgn (scaled_coefficients b) = map sgn b.
Proof.
  destruct b as [| x b]; [easy |]. apply signs_of_products; [apply binomials_positive |].
  rewrite length_binomials. simpl. lia.
Qed.
Lemma sgn_0 : sgn 0 = 0%Z.
Proof. destruct (sgn_cases 0) as [(L & _) | [(L & _) | (_ & E)]]; auto; lra. Qed.
Lemma signs_hd_last h : sgn (hd 0 h) = hd 0%Z (map sgn h) /\ sgn (last h 0) = last (map sgn h) 0%Z.
Proof.
  split; [destruct h; [apply sgn_0 | easy] |].
  induction h as [| a [| b h] IH]; [apply sgn_0 | easy |]. exact IH.
Qed.
Lemma scaled_ends b : sgn (hd 0 (scaled_coefficients b)) = sgn (hd 0 b) /\
  sgn (last (scaled_coefficients b) 0) = sgn (last b 0).
Proof.
  destruct (signs_hd_last b) as (-> & ->). destruct (signs_hd_last (scaled_coefficients b)) as (-> & ->). now rewrite scaled_signs.
Qed.
Lemma sgn_not_0 x : sgn x <> 0%Z <-> x <> 0.
Proof. destruct (sgn_cases x) as [(L & ->) | [(L & ->) | (L & ->)]]; split; intros; lra || easy. Qed.
Lemma sgn_opposite x y : sgn x <> 0%Z -> sgn y = (- sgn x)%Z -> x * y < 0.
Proof. destruct (sgn_cases x) as [(L & ->) | [(L & ->) | (L & ->)]], (sgn_cases y) as [(K & ->) | [(K & ->) | (K & ->)]]; try easy; intros; nra. Qed.
Lemma sgn_equal x y : sgn x <> 0%Z -> sgn y = sgn x -> 0 < x * y.
Proof. destruct (sgn_cases x) as [(L & ->) | [(L & ->) | (L & ->)]], (sgn_cases y) as [(K & ->) | [(K & ->) | (K & ->)]]; try easy; intros; nra. Qed.

(** ** Isolation *)

Record interval := Interval { low : R; high : R }.

(** The root of an interval: it is the point low = high, or strictly between, the only one in [low, high],
    and p changes its sign there. *)
Definition isolates (p : list R) (i : interval) (r : R) : Prop :=
  power_form p r = 0 /\
  (low i = r /\ high i = r \/
   low i < r < high i /\ (forall x, low i <= x <= high i -> power_form p x = 0 -> x = r) /\
   power_form p (low i) * power_form p (high i) < 0).
(** The intervals contain each root with this property once, in ascending order. *)
Definition isolated (p : list R) (where_ : R -> Prop) (found : list interval) : Prop :=
  exists roots, Forall2 (isolates p) found roots /\ StronglySorted Rlt roots /\
    forall x, In x roots <-> where_ x /\ power_form p x = 0.

(** Signs of coefficients as the code computes them (fixed_row, or local_form; LocalForm.v): 0 if uncertain. *)
Definition row_of (p : list R) (lo hi : R) (signs : list Z) : Prop :=
  exists h, stands_for h p lo hi /\ Forall2 sign_seen signs (map sgn h).
(** The row to count, without ends that are known to be zero. *)
Definition without_ends {A} (low_end high_end : bool) (row : list A) : list A :=
  let row := if low_end then tl row else row in if high_end then removelast row else row.

Definition point_if_root (p : list R) (x : R) : list interval :=
  if Req_EM_T (power_form p x) 0 then [Interval x x] else [].

(** The sign changes of a subinterval: those of exact coefficients, or the most that computed signs allow, since
    uncertain ones may add changes. *)
Inductive counted (p : list R) (lo hi : R) : nat -> Prop :=
| of_exact b : controls b p lo hi -> counted p lo hi (sign_variations (map sgn b))
| of_seen signs root_at_low root_at_high : row_of p lo hi signs ->
    (root_at_low = true -> power_form p lo = 0) -> (root_at_high = true -> power_form p hi = 0) ->
    counted p lo hi (match without_ends root_at_low root_at_high signs with [] => 0 | inner => max_sign_variations inner end).

(** descartes_search, which stores the subintervals on a stack: the cases in which a subinterval is finished, and its
    division at any point strictly inside: the middle, a point between exponents, or one of Newton's method. (If a
    subinterval is narrowed, it is divided at one or two points, and the other pieces are `rootless`, by
    surely_rootless.) *)
Inductive on_part (p : list R) : R -> R -> list interval -> Prop :=
| no_variation lo hi : counted p lo hi 0 -> on_part p lo hi []
| rootless lo hi : (forall x, lo <= x <= hi -> power_form p x <> 0) -> on_part p lo hi []
| one_variation lo hi : counted p lo hi 1 -> power_form p lo <> 0 -> power_form p hi <> 0 -> on_part p lo hi [Interval lo hi]
| pair lo hi signs x : counted p lo hi 2 -> row_of p lo hi signs -> hd 0%Z signs <> 0%Z -> power_form p hi <> 0 ->
    lo < x < hi -> sgn (power_form p x) = (- hd 0 signs)%Z -> on_part p lo hi [Interval lo x; Interval x hi]
| parts lo x hi left right : lo < x < hi -> on_part p lo x left -> on_part p x hi right ->
    on_part p lo hi (left ++ point_if_root p x ++ right).

Lemma sorted_app (a b : list R) : StronglySorted Rlt a -> StronglySorted Rlt b ->
  (forall x y, In x a -> In y b -> x < y) -> StronglySorted Rlt (a ++ b).
Proof.
  induction 1 as [| x a S IH F]; intros B L; simpl; auto. constructor.
  - apply IH; auto. intros y z Y Z. apply L; [now right | easy].
  - apply Forall_app. split; auto. apply Forall_forall. intros y Y. apply L; [now left | easy].
Qed.
Lemma isolated_app p (u v : R -> Prop) f g : isolated p u f -> isolated p v g -> (forall x y, u x -> v y -> x < y) ->
  isolated p (fun x => u x \/ v x) (f ++ g).
Proof.
  intros (a & Fa & Sa & Ia) (b & Fb & Sb & Ib) L. exists (a ++ b). split; [now apply Forall2_app |]. split.
  - apply sorted_app; auto. intros x y X Y. apply L; [now apply Ia | now apply Ib].
  - intros x. rewrite in_app_iff, Ia, Ib. tauto.
Qed.
Lemma isolated_same p (u v : R -> Prop) f : (forall x, power_form p x = 0 -> (u x <-> v x)) -> isolated p u f -> isolated p v f.
Proof.
  intros E (a & F & S & I). exists a. repeat (split; [easy |]). intros x. rewrite I.
  split; intros (A & B); split; auto; now apply E.
Qed.
Lemma isolated_none p (u : R -> Prop) : (forall x, u x -> power_form p x <> 0) -> isolated p u [].
Proof. 
  intros N. exists []. split; [constructor |]. split; [constructor |].
  intros x. split; [intros [] |]. intros (A & B). exact (N x A B).
Qed.
Lemma isolated_point p x : isolated p (fun y => y = x) (point_if_root p x).
Proof.
  unfold point_if_root. destruct Req_EM_T as [Z | Z].
  - exists [x]. split; [constructor; [split; [easy | left; now split] | constructor] |].
    split; [repeat constructor |]. intros y. simpl. split; [intros [-> | []]; now split | intros (-> & _); now left].
  - apply isolated_none. now intros y ->.
Qed.
Lemma isolated_one p lo hi r : isolates p (Interval lo hi) r -> lo < hi ->
  isolated p (fun x => lo < x < hi) [Interval lo hi].
Proof.
  intros (Z & [(A & B) | (A & Only & S)]) L; cbn [low high] in *; [lra |].
  exists [r]. split; [constructor; [split; [easy | right; now repeat split] | constructor] |].
  split; [repeat constructor |]. intros x. simpl. split.
  - intros [<- | []]. now split.
  - intros (X & Zx). left. symmetry. apply Only; auto. lra.
Qed.

Section Part.

Context (p h : list R) (lo hi : R) (L : lo < hi) (S : stands_for h p lo hi).
Let place (t : R) := lo + t * (hi - lo).
Let time (x : R) := (x - lo) / (hi - lo).

Lemma place_time x : place (time x) = x.
Proof. unfold place, time. field. lra. Qed.
Lemma times_order x y : x < y <-> time x < time y.
Proof.
  unfold time. split; intros H.
  - apply Rmult_lt_compat_r; [apply Rinv_0_lt_compat |]; lra.
  - apply Rmult_lt_reg_r with (/ (hi - lo)); [apply Rinv_0_lt_compat; lra |]. unfold Rdiv in H. lra.
Qed.
Lemma times_le x y : x <= y -> time x <= time y.
Proof. intros [H | ->]; [left; now apply (proj1 (times_order x y)) | lra]. Qed.
Lemma time_ends : time lo = 0 /\ time hi = 1.
Proof. unfold time. split; field; lra. Qed.
Lemma value_multiple : exists c, 0 < c /\ forall x, on_unit h (time x) = c * power_form p x.
Proof. destruct S as (c & C & E). exists c. split; auto. intros x. rewrite E. fold (place (time x)). now rewrite place_time. Qed.
Lemma root_time x : on_unit h (time x) = 0 <-> power_form p x = 0.
Proof.
  destruct value_multiple as (c & C & E). rewrite E. split; intros H; [| rewrite H; ring].
  apply Rmult_eq_reg_l with c; lra.
Qed.
Lemma sign_time x : sgn (on_unit h (time x)) = sgn (power_form p x).
Proof. destruct value_multiple as (c & C & E). rewrite E. now apply sgn_multiple. Qed.
Lemma ends_signs : sgn (hd 0 h) = sgn (power_form p lo) /\ sgn (last h 0) = sgn (power_form p hi).
Proof.
  destruct time_ends as (E0 & E1), (on_unit_ends h) as (F0 & F1).
  rewrite <- F0, <- F1, <- E0, <- E1. split; apply sign_time.
Qed.

Lemma one_root_isolates u v : lo <= u < v -> v <= hi ->
  sgn (power_form p u) <> 0%Z -> sgn (power_form p v) = (- sgn (power_form p u))%Z ->
  (exists r, time u < r < time v /\ on_unit h r = 0 /\
    forall t, time u <= t <= time v -> on_unit h t = 0 -> t = r) ->
  exists r, isolates p (Interval u v) r.
Proof.
  intros U V N O (r & R & Z & Only). exists (place r). unfold isolates. cbn [low high].
  assert (E : time (place r) = r) by (unfold time, place; field; lra).
  rewrite <- E in Z, R, Only. rewrite root_time in Z. split; auto. right.
  rewrite <- !times_order in R. split; auto. split; [| now apply sgn_opposite].
  intros x X Zx. rewrite <- (place_time x). f_equal. rewrite Only with (t := time x); auto; [| now apply root_time].
  split; apply times_le; lra.
Qed.
Lemma one_root_part (V : sign_variations (map sgn h) = 1%nat) : hd 0 h <> 0 -> last h 0 <> 0 ->
  exists r, isolates p (Interval lo hi) r.
Proof.
  intros H K. destruct (one_variation_one_root h V H K) as (O & Root). destruct time_ends as (E0 & E1).
  destruct ends_signs as (F0 & F1). destruct (on_unit_ends h) as (G0 & G1). rewrite G0, G1 in O.
  apply one_root_isolates; try lra.
  - rewrite <- F0. now apply sgn_not_0.
  - rewrite <- F0, <- F1. destruct (sgn_cases (hd 0 h)) as [(A & ->) | [(A & ->) | (A & ->)]],
      (sgn_cases (last h 0)) as [(B & ->) | [(B & ->) | (B & ->)]]; auto; exfalso; nra.
  - now rewrite E0, E1.
Qed.
Lemma two_roots_part x : (sign_variations (map sgn h) <= 2)%nat -> hd 0 h <> 0 ->
  sgn (last h 0) = sgn (hd 0 h) -> lo < x < hi -> sgn (power_form p x) = (- sgn (hd 0%R h))%Z ->
  (exists r, isolates p (Interval lo x) r) /\ (exists r, isolates p (Interval x hi) r).
Proof.
  intros V N E X O. apply sgn_not_0 in N. destruct time_ends as (E0 & E1). destruct ends_signs as (F0 & F1).
  destruct (two_variations_two_roots h (time x) V) as (A & B).
  - rewrite Rmult_comm. rewrite Rmult_comm. apply sgn_equal; auto.
  - rewrite <- E0, <- E1. split; apply (proj1 (times_order _ _)); lra.
  - apply sgn_opposite; auto. now rewrite sign_time.
  - split; apply one_root_isolates; try lra.
    + now rewrite <- F0.
    + now rewrite <- F0.
    + now rewrite E0.
    + rewrite O. destruct (sgn_cases (hd 0 h)) as [(_ & Q) | [(_ & Q) | (_ & Q)]]; rewrite Q in *; easy.
    + rewrite <- F1, O, E. lia.
    + now rewrite E1.
Qed.

Lemma no_root_part (V : sign_variations (map sgn h) = 0%nat) x : not_zero p -> lo < x < hi -> power_form p x <> 0.
Proof.
  intros (y & Y) X Z. destruct (Exists_dec (fun x => x <> 0) h) as [E | E].
  - intros z. destruct (Req_EM_T z 0); [right | left]; auto.
  - apply (no_variation_no_root h (time x) V E).
    + destruct time_ends as (E0 & E1). rewrite <- E0, <- E1. split; apply (proj1 (times_order _ _)); lra.
    + now apply root_time.
  - assert (All : forall t, on_unit h t = 0).
    { intros t. unfold on_unit. clear - E. induction h as [| a l IH]; simpl; [easy |].
      rewrite IH by (intros K; apply E; now right). destruct (Req_dec a 0) as [-> | N]; [ring |].
      exfalso. apply E. now left. }
    apply Y, (zero_between p lo hi L). intros z _. apply root_time, All.
Qed.

End Part.

(** With an even number of changes, the ends' signs are equal. *)
Lemma changes_even s signs : plain s -> Forall (fun v => plain v \/ v = 0%Z) signs -> last (s :: signs) 0%Z <> 0%Z ->
  Nat.even (changes_after s signs) = (last (s :: signs) 0 =? s)%Z.
Proof.
  intros P F L. destruct signs as [| v l _] using rev_ind; [simpl; now rewrite Z.eqb_refl |].
  change (s :: l ++ [v]) with ((s :: l) ++ [v]) in *. rewrite last_last in *. apply Forall_app in F.
  destruct F as (F & G). inversion_clear G as [| ? ? V _]. destruct V as [V | V]; [| easy].
  destruct (run l s v [] P V F) as (c & Q & _ & E). rewrite Q. cbn [changes_after]. rewrite Nat.add_0_r. exact E.
Qed.
Lemma sgn_plain h : Forall (fun v => plain v \/ v = 0%Z) (map sgn h).
Proof.
  apply Forall_map, Forall_forall. intros x _. unfold plain.
  destruct (sgn_cases x) as [(_ & ->) | [(_ & ->) | (_ & ->)]]; auto.
Qed.
Lemma equal_ends h : sgn (hd 0 h) <> 0%Z -> sgn (last h 0) <> 0%Z ->
  Nat.even (sign_variations (map sgn h)) = true -> sgn (last h 0) = sgn (hd 0 h).
Proof.
  destruct h as [| x l]; [intros N; exfalso; apply N, sgn_0 |]. intros N K E.
  destruct (signs_hd_last (x :: l)) as (_ & El). rewrite El in *. cbn [hd map] in *.
  unfold sign_variations in E. cbn [changes_after] in E.
  destruct (Z.eqb_spec (sgn x) 0); [easy |]. destruct (Z.eqb_spec (sgn x) (- 0)); [easy |]. cbn [Nat.add] in E.
  rewrite changes_even in E; auto; [now apply Z.eqb_eq | | apply sgn_plain].
  pose proof (sgn_plain [x]) as F. inversion_clear F as [| ? ? [V | V] _]; easy.
Qed.
(** Zeros at the ends change nothing. *)
Lemma changes_before_0 last signs : changes_after last (signs ++ [0%Z]) = changes_after last signs.
Proof. revert last. induction signs as [| s l IH]; intros last; [easy |]. cbn [app changes_after]. now rewrite !IH. Qed.
Lemma variations_without_ends low_end high_end row :
  (low_end = true -> hd 0%Z row = 0%Z) -> (high_end = true -> last row 0%Z = 0%Z) ->
  sign_variations (without_ends low_end high_end row) = sign_variations row.
Proof.
  intros Low High. unfold without_ends, sign_variations.
  transitivity (changes_after 0 (if low_end then tl row else row)).
  - destruct high_end; [| easy]. specialize (High eq_refl).
    assert (E : last (if low_end then tl row else row) 0%Z = 0%Z)
      by (destruct low_end; [destruct row as [| a [| b l]]; easy | easy]).
    destruct (if low_end then tl row else row) as [| s l _] using rev_ind; [easy |].
    rewrite last_last in E. rewrite E, removelast_last. symmetry. apply changes_before_0.
  - destruct low_end; [| easy]. specialize (Low eq_refl). destruct row as [| s l]; [easy |].
    simpl in Low. now rewrite Low.
Qed.
Lemma seen_without_ends low_end high_end signs truth : Forall2 sign_seen signs truth ->
  Forall2 sign_seen (without_ends low_end high_end signs) (without_ends low_end high_end truth).
Proof.
  intros F. unfold without_ends.
  assert (G : Forall2 sign_seen (if low_end then tl signs else signs) (if low_end then tl truth else truth))
    by (destruct low_end; [destruct F; [constructor | easy] | easy]).
  destruct high_end; [| exact G]. induction G as [| s t signs' truth' S G IH]; [constructor |].
  destruct G; simpl in *; constructor; auto.
Qed.

Lemma counted_right p lo hi n : lo < hi -> counted p lo hi n -> (n < 3)%nat -> exists h, stands_for h p lo hi /\
  (sign_variations (map sgn h) <= n)%nat /\ Nat.even (sign_variations (map sgn h)) = Nat.even n.
Proof.
  intros L C. destruct C as [b C | signs low_end high_end (h & C & R) Low High]; intros B.
  - exists (scaled_coefficients b). rewrite scaled_signs. now repeat split.
  - exists h. split; auto. destruct (ends_signs p h lo hi L C) as (Eh & El). destruct (signs_hd_last h) as (Fh & Fl).
    rewrite <- (variations_without_ends low_end high_end (map sgn h)).
    + apply (seen_without_ends low_end high_end) in R.
      destruct (without_ends low_end high_end signs) as [| s l]; [now inversion_clear R |]. now apply max_variations_right.
    + intros E. rewrite <- Fh, Eh, (Low E). apply sgn_0.
    + intros E. rewrite <- Fl, El, (High E). apply sgn_0.
Qed.

Theorem on_part_right p lo hi found : not_zero p -> lo < hi -> on_part p lo hi found ->
  isolated p (fun x => lo < x < hi) found.
Proof.
  intros NZ L P. revert L.
  induction P as [lo hi V | lo hi N | lo hi V Nl Nh | lo hi signs x V (k & Ck & R) Nl Nh X O
    | lo x hi left right X P IHP Q IHQ]; intros L.
  - destruct (counted_right p lo hi 0 L V) as (h & C & W & _); [lia |]. apply isolated_none. intros x X.
    apply (no_root_part p h lo hi L C); auto. lia.
  - apply isolated_none. intros x X. apply N. lra.
  - destruct (counted_right p lo hi 1 L V) as (h & C & W & E); [lia |]. destruct (ends_signs p h lo hi L C) as (Eh & El).
    destruct (one_root_part p h lo hi L C) as (r & I).
    + destruct (sign_variations (map sgn h)) as [| [|]]; [discriminate | easy | lia].
    + apply sgn_not_0. rewrite Eh. now apply sgn_not_0.
    + apply sgn_not_0. rewrite El. now apply sgn_not_0.
    + now apply isolated_one with r.
  - destruct (counted_right p lo hi 2 L V) as (h & C & W & E); [lia |]. destruct (ends_signs p h lo hi L C) as (Eh & El).
    assert (S : hd 0%Z signs = sgn (power_form p lo)).
    { destruct (ends_signs p k lo hi L Ck) as (<- & _). rewrite (proj1 (signs_hd_last k)).
      destruct R as [| s t signs truth (_ & T) R]; [easy | now apply T]. }
    rewrite S in Nl, O. apply sgn_not_0 in Nh.
    destruct (two_roots_part p h lo hi L C x W) as ((r & A) & (q & B)); auto.
    + apply sgn_not_0. now rewrite Eh.
    + apply equal_ends; [now rewrite Eh | now rewrite El | easy].
    + now rewrite Eh.
    + apply isolated_one in A, B; try lra. apply isolated_same with (fun y => lo < y < x \/ x < y < hi).
      * intros y Z. assert (y <> x); [| lra]. intros ->. rewrite Z, sgn_0 in O. lia.
      * apply (isolated_app p _ _ [Interval lo x] [Interval x hi]); auto. intros; lra.
  - specialize (IHP ltac:(lra)). specialize (IHQ ltac:(lra)).
    apply isolated_same with (fun y => lo < y < x \/ (y = x \/ x < y < hi)); [intros; lra |].
    apply isolated_app; auto; [apply isolated_app; auto; [apply isolated_point | intros; lra] | intros; lra].
Qed.

(** ** All roots *)

(** The roots strictly between, 0 <= low < high. `least` and `greatest` are the points beyond the bounds of the
    positive roots, if the code has bounds. Descartes' rule on the positive numbers is used first. If it leaves one
    root, the signs at both ends determine if it is between. *)
Inductive inside (p : list R) (bounds : option (R * R)) (lo hi : R) : list interval -> Prop :=
| no_positive_roots : bounds = None -> inside p bounds lo hi []
| nothing_left least greatest : bounds = Some (least, greatest) -> ~ Rmax lo least < Rmin greatest hi ->
    inside p bounds lo hi []
| no_change least greatest : bounds = Some (least, greatest) -> sign_variations (map sgn p) = 0%nat ->
    inside p bounds lo hi []
| one_change least greatest : bounds = Some (least, greatest) -> lo <= least -> greatest <= hi ->
    sign_variations (map sgn p) = 1%nat -> inside p bounds lo hi [Interval least greatest]
| one_change_between least greatest : bounds = Some (least, greatest) -> sign_variations (map sgn p) = 1%nat ->
    Rmax lo least < Rmin greatest hi -> power_form p (Rmax lo least) <> 0 -> power_form p (Rmin greatest hi) <> 0 ->
    sgn (power_form p (Rmax lo least)) <> sgn (power_form p (Rmin greatest hi)) ->
    inside p bounds lo hi [Interval (Rmax lo least) (Rmin greatest hi)]
| one_change_beside least greatest : bounds = Some (least, greatest) -> sign_variations (map sgn p) = 1%nat ->
    Rmax lo least < Rmin greatest hi ->
    power_form p (Rmax lo least) = 0 \/ power_form p (Rmin greatest hi) = 0 \/
      sgn (power_form p (Rmax lo least)) = sgn (power_form p (Rmin greatest hi)) ->
    inside p bounds lo hi []
| between_bounds least greatest found : bounds = Some (least, greatest) -> Rmax lo least < Rmin greatest hi ->
    on_part p (Rmax lo least) (Rmin greatest hi) found -> inside p bounds lo hi found.

Definition bounds_right (p : list R) (bounds : option (R * R)) : Prop :=
  forall x, 0 < x -> power_form p x = 0 -> exists least greatest, bounds = Some (least, greatest) /\ least < x < greatest.

(** Descartes' rule on the positive numbers. *)
Lemma no_change_no_root p x : sign_variations (map sgn p) = 0%nat -> hd 0 p <> 0 -> 0 < x -> power_form p x <> 0.
Proof.
  intros V N X Z. set (t := x / (1 + x)). assert (E : t / (1 - t) = x) by (unfold t; field; lra).
  assert (T : 0 < t < 1).
  { unfold t. split; [apply Rmult_lt_0_compat; [easy | apply Rinv_0_lt_compat; lra] |].
    apply Rmult_lt_reg_r with (1 + x); [lra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. }
  destruct (on_unit_ratio p t T) as (c & C & F). apply (no_variation_no_root p t V); auto; [destruct p; [now destruct N | now left] |].
  now rewrite F, E, Z, Rmult_0_r.
Qed.
Lemma one_change_one_root p u v : sign_variations (map sgn p) = 1%nat -> hd 0 p <> 0 -> last p 0 <> 0 -> 0 <= u ->
  (forall x, 0 < x -> power_form p x = 0 -> u < x < v) ->
  exists r, u < r < v /\ isolates p (Interval u v) r.
Proof.
  assert (G : forall p, sign_variations (map sgn p) = 1%nat -> 0 < hd 0 p -> last p 0 <> 0 -> 0 <= u ->
    (forall x, 0 < x -> power_form p x = 0 -> u < x < v) ->
    exists r, u < r < v /\ isolates p (Interval u v) r).
  { clear p. intros p V P N U B. destruct (one_variation_one_root p V ltac:(lra) N) as (_ & t & T & Z & _).
    destruct (on_unit_ratio p t T) as (c & C & F). set (r := t / (1 - t)) in *.
    assert (R : 0 < r) by (unfold r; apply Rmult_lt_0_compat; [| apply Rinv_0_lt_compat]; lra).
    assert (Zr : power_form p r = 0) by (apply Rmult_eq_reg_l with c; lra). pose proof (B r R Zr) as Br.
    assert (Falls : forall x y, 0 < x < y -> power_form p x <= 0 -> power_form p y < 0).
    { pose proof (first_alternation p P) as A. rewrite V in A.
      destruct (alternates_1 p A P) as (a & b & -> & Fa & Ea & Fb & _). intros x y. now apply falls_once. }
    assert (Only : forall x, 0 < x -> power_form p x = 0 -> x = r).
    { intros x X Zx. destruct (Rtotal_order x r) as [H | [H | H]]; auto; exfalso;
        [pose proof (Falls x r ltac:(lra) ltac:(lra)) | pose proof (Falls r x ltac:(lra) ltac:(lra))]; lra. }
    assert (Low : 0 < power_form p u).
    { destruct (Rle_lt_or_eq_dec 0 u U) as [U' | <-].
      - destruct (Rle_lt_dec (power_form p u) 0) as [H | H]; auto. pose proof (Falls u r ltac:(lra) H). lra.
      - destruct p as [| a l]; simpl in *; lra. }
    pose proof (Falls r v ltac:(lra) ltac:(lra)) as High.
    exists r. split; auto. split; auto. right. cbn [low high]. split; auto. split; [| nra].
    intros x X Zx. apply Only; auto. destruct (Rle_lt_or_eq_dec 0 x ltac:(lra)) as [H | <-]; auto.
    assert (u = 0) by lra. subst u. lra. }
  intros V N L U B. destruct (Rtotal_order (hd 0 p) 0) as [H | [H | H]]; [| easy | now apply G].
  destruct (hd_last_opp p) as (Eh & El).
  destruct (G (map Ropp p)) as (r & R & Z & I).
  - now rewrite variations_opp.
  - lra.
  - lra.
  - easy.
  - intros x X Zx. apply B; auto. rewrite power_form_opp in Zx. lra.
  - exists r. split; auto. split; [rewrite power_form_opp in Z; lra |].
    destruct I as [I | (A & O & S)]; [now left | right]. split; auto. split.
    + intros x X Zx. apply O; auto. rewrite power_form_opp. lra.
    + rewrite !power_form_opp in S. lra.
Qed.

(** On each side of its root, the sign is that of the end there. *)
Lemma sign_beside p u v r x : isolates p (Interval u v) r -> u < v -> u <= x <= v ->
  (x < r -> 0 < power_form p u * power_form p x) /\ (r < x -> 0 < power_form p x * power_form p v).
Proof.
  intros (Z & [(A & B) | (A & Only & S)]) L X; cbn [low high] in *; [lra |]. split; intros H.
  - assert (Nu : power_form p u <> 0) by (intros F; pose proof (Only u ltac:(lra) F); lra).
    assert (Nx : power_form p x <> 0) by (intros F; pose proof (Only x ltac:(lra) F); lra).
    destruct (Rle_lt_or_eq_dec u x (proj1 X)) as [U | <-]; [| nra].
    destruct (Rtotal_order (power_form p u * power_form p x) 0) as [F | [F | F]]; auto; exfalso.
    + destruct (root_between (power_form p) u x) as (q & Q & Zq); auto; [apply continuous_power_form |].
      pose proof (Only q ltac:(lra) Zq). lra.
    + apply Rmult_integral in F. tauto.
  - assert (Nv : power_form p v <> 0) by (intros F; pose proof (Only v ltac:(lra) F); lra).
    assert (Nx : power_form p x <> 0) by (intros F; pose proof (Only x ltac:(lra) F); lra).
    destruct (Rle_lt_or_eq_dec x v (proj2 X)) as [U | ->]; [| nra].
    destruct (Rtotal_order (power_form p x * power_form p v) 0) as [F | [F | F]]; auto; exfalso.
    + destruct (root_between (power_form p) x v) as (q & Q & Zq); auto; [apply continuous_power_form |].
      pose proof (Only q ltac:(lra) Zq). lra.
    + apply Rmult_integral in F. tauto.
Qed.
Lemma equal_signs x y z : 0 < x * z -> 0 < y * z -> sgn x = sgn y.
Proof.
  intros H K. destruct (sgn_cases x) as [(A & ->) | [(A & ->) | (A & ->)]],
    (sgn_cases y) as [(B & ->) | [(B & ->) | (B & ->)]]; auto; exfalso; try (subst; lra); nra.
Qed.

Lemma inside_right p bounds lo hi found : hd 0 p <> 0 -> last p 0 <> 0 -> not_zero p -> bounds_right p bounds -> 0 <= lo ->
  inside p bounds lo hi found -> isolated p (fun x => lo < x < hi) found.
Proof.
  intros H0 Hn NZ B P I.
  assert (Within : forall least greatest x, bounds = Some (least, greatest) -> power_form p x = 0 ->
    (lo < x < hi <-> Rmax lo least < x < Rmin greatest hi /\ 0 < x)).
  { intros least greatest x E Z. split.
    - intros X. destruct (B x ltac:(lra) Z) as (l & g & E' & H). rewrite E in E'. injection E' as <- <-.
      split; [| lra]. split; [apply Rmax_lub_lt | apply Rmin_glb_lt]; lra.
    - intros ((X & Y) & X0). pose proof (Rmax_l lo least). pose proof (Rmin_r greatest hi). lra. }
  assert (One : forall least greatest, bounds = Some (least, greatest) -> sign_variations (map sgn p) = 1%nat ->
    exists r, Rmax 0 least < r < greatest /\ isolates p (Interval (Rmax 0 least) greatest) r).
  { intros least greatest E V.
    destruct (one_change_one_root p (Rmax 0 least) greatest V H0 Hn (Rmax_l 0 least)) as (r & R & J); [| now exists r].
    intros x X Z. destruct (B x ltac:(lra) Z) as (l & g & E' & K). rewrite E in E'. injection E' as <- <-.
    split; [apply Rmax_lub_lt |]; lra. }
  assert (Ends : forall least greatest, Rmax 0 least <= Rmax lo least /\ Rmin greatest hi <= greatest).
  { intros least greatest. split; [| apply Rmin_l]. pose proof (Rmax_l lo least). pose proof (Rmax_r lo least).
    apply Rmax_lub; lra. }
  destruct I as [E | least greatest E N | least greatest E V | least greatest E A C V | least greatest E V L Na Nb Sg
    | least greatest E V L C | least greatest found E L I].
  - apply isolated_none. intros x X Z. destruct (B x ltac:(lra) Z) as (l & g & E' & _). congruence.
  - apply isolated_none. intros x X Z. rewrite (Within _ _ _ E Z) in X. lra.
  - apply isolated_none. intros x X. apply no_change_no_root; auto. lra.
  - assert (Bounds : forall x, 0 < x -> power_form p x = 0 -> least < x < greatest).
    { intros x X Z. destruct (B x X Z) as (l & g & E' & H). rewrite E in E'. now injection E' as -> ->. }
    destruct (one_change_one_root p least greatest V H0 Hn ltac:(lra) Bounds) as (r & R & I).
    apply isolated_same with (fun x => least < x < greatest); [| apply isolated_one with r; [easy | lra]].
    intros x Z. split; intros X; [lra |]. apply Bounds; auto. lra.
  - destruct (One _ _ E V) as (r & R & J), (Ends least greatest) as (Ea & Eb).
    set (a := Rmax lo least) in *. set (b := Rmin greatest hi) in *. set (u := Rmax 0 least) in *.
    destruct (sign_beside p u greatest r a J ltac:(lra) ltac:(lra)) as (_ & Aa).
    destruct (sign_beside p u greatest r b J ltac:(lra) ltac:(lra)) as (Bb & Ab).
    destruct (sign_beside p u greatest r a J ltac:(lra) ltac:(lra)) as (Ba & _).
    destruct J as (Z & [(P1 & P2) | (P1 & Only & S)]); cbn [low high] in *; [lra |].
    assert (Lr : a < r < b).
    { assert (a <> r) by (intros ->; lra). assert (b <> r) by (intros K; rewrite K in Nb; lra). split.
      - destruct (Rtotal_order a r) as [K | [K | K]]; auto; [lra |]. exfalso. apply Sg.
        apply equal_signs with (power_form p greatest); [apply Aa; lra | apply Ab; lra].
      - destruct (Rtotal_order b r) as [K | [K | K]]; auto; [| lra]. exfalso. apply Sg.
        apply equal_signs with (power_form p u); rewrite Rmult_comm; [apply Ba; lra | apply Bb; lra]. }
    specialize (Ba ltac:(lra)). specialize (Ab ltac:(lra)).
    apply isolated_same with (fun x => a < x < b).
    + intros x X. rewrite (Within _ _ _ E X). fold a b. split; [| tauto]. intros; split; auto. pose proof (Rmax_l lo least). fold a in H1. lra.
    + apply isolated_one with r; [| lra]. split; auto. right. cbn [low high]. split; auto. split; [intros x X; apply Only; lra |].
      nra.
  - destruct (One _ _ E V) as (r & R & J), (Ends least greatest) as (Ea & Eb).
    apply isolated_none. intros x X Z. rewrite (Within _ _ _ E Z) in X. destruct X as (X & X0).
    set (a := Rmax lo least) in *. set (b := Rmin greatest hi) in *. set (u := Rmax 0 least) in *.
    destruct (sign_beside p u greatest r a J ltac:(lra) ltac:(lra)) as (Ba & _).
    destruct (sign_beside p u greatest r b J ltac:(lra) ltac:(lra)) as (_ & Ab).
    destruct J as (Zr & [(P1 & P2) | (P1 & Only & S)]); cbn [low high] in *; [lra |].
    pose proof (Only x ltac:(lra) Z) as ->. destruct C as [C | [C | C]].
    + pose proof (Only a ltac:(lra) C). lra.
    + pose proof (Only b ltac:(lra) C). lra.
    + specialize (Ba ltac:(lra)). specialize (Ab ltac:(lra)).
      assert (O : 0 < power_form p a * power_form p b).
      { apply sgn_equal; [| easy]. apply sgn_not_0. intros K. rewrite K in Ba. lra. }
      nra.
  - apply isolated_same with (fun x => Rmax lo least < x < Rmin greatest hi).
    + intros x Z. rewrite (Within _ _ _ E Z). pose proof (Rmax_l lo least). split; [| tauto]. intros; split; auto; lra.
    + now apply on_part_right.
Qed.

(** p(-x) *)
Fixpoint mirrored (p : list R) : list R :=
  match p with a :: b :: l => a :: - b :: mirrored l | l => l end.
Lemma mirrored_value p x : power_form (mirrored p) x = power_form p (- x).
Proof.
  enough (G : forall n p, (length p <= n)%nat -> power_form (mirrored p) x = power_form p (- x)) by (eapply G; auto).
  clear p. induction n as [| n IH]; intros [| a [| b l]] L; simpl in *; try lia; try ring.
  rewrite IH by lia. ring.
Qed.

Definition reflected (i : interval) : interval := Interval (- high i) (- low i).

(** isolate *)
Inductive isolate (p : list R) (right left : option (R * R)) (lo hi : R) : list interval -> Prop :=
| one_point : ~ lo < hi -> isolate p right left lo hi (point_if_root p lo)
| both_sides negative positive : lo < hi ->
    (if Rlt_dec lo 0
     then inside (mirrored p) left (if Rlt_dec hi 0 then - hi else 0) (- lo) negative
     else negative = []) ->
    (if Rlt_dec 0 hi then inside p right (if Rlt_dec lo 0 then 0 else lo) hi positive else positive = []) ->
    isolate p right left lo hi
      (point_if_root p lo ++ rev (map reflected negative) ++ positive ++ point_if_root p hi).

Lemma isolated_reflected p (u : R -> Prop) found : isolated (mirrored p) u found ->
  isolated p (fun x => u (- x)) (rev (map reflected found)).
Proof.
  intros (a & F & S & I). exists (rev (map Ropp a)). split; [| split].
  - clear - F. induction F as [| i x found a (Z & C) F IH]; [constructor |]. cbn [map rev].
    apply Forall2_app; auto. constructor; [| constructor]. rewrite mirrored_value in Z. split; auto.
    unfold reflected. cbn [low high]. destruct C as [(-> & ->) | (L & Only & Sg)]; [left; split; ring |].
    right. rewrite !mirrored_value in Sg. split; [lra |]. split; [| lra].
    intros y Y Zy. rewrite <- (Only (- y)); [ring | lra |]. now rewrite mirrored_value, Ropp_involutive.
  - clear - S. induction S as [| x a S IH F]; [constructor |]. cbn [map rev]. apply sorted_app; auto.
    + repeat constructor.
    + intros y z Y [<- | []]. apply in_rev, in_map_iff in Y. destruct Y as (w & <- & W).
      rewrite Forall_forall in F. specialize (F w W). lra.
  - intros x. rewrite <- in_rev, in_map_iff.
    assert (E : power_form p x = power_form (mirrored p) (- x)) by now rewrite mirrored_value, Ropp_involutive.
    rewrite E, <- I. split.
    + intros (y & <- & Y). now rewrite Ropp_involutive.
    + intros X. exists (- x). split; [ring | easy].
Qed.

Lemma mirrored_ends_real p : hd 0 (mirrored p) = hd 0 p /\ (last p 0 <> 0 -> last (mirrored p) 0 <> 0).
Proof.
  split; [now destruct p as [| a [| b l]] |].
  enough (G : forall n p, (length p <= n)%nat -> last p 0 <> 0 -> last (mirrored p) 0 <> 0) by (eapply G; auto).
  clear p. induction n as [| n IH]; intros [| a [| b l]] L; try (simpl in L; lia); auto.
  simpl in L. specialize (IH l ltac:(lia)). destruct l as [| c l]; [simpl; lra |]. intros H. specialize (IH H).
  destruct l as [| d l]; exact IH.
Qed.

Theorem isolate_right p right left lo hi found : power_form p 0 <> 0 -> last p 0 <> 0 -> lo <= hi ->
  bounds_right p right -> bounds_right (mirrored p) left -> isolate p right left lo hi found ->
  isolated p (fun x => lo <= x <= hi) found.
Proof.
  intros N0 Nn L Br Bl I.
  assert (NZ : not_zero p) by now exists 0. destruct (mirrored_ends_real p) as (Mh & Ml). specialize (Ml Nn).
  assert (Nh : hd 0 p <> 0) by (intros K; apply N0; destruct p; simpl in *; lra).
  assert (NM : not_zero (mirrored p)) by (exists 0; now rewrite mirrored_value, Ropp_0).
  destruct I as [E | negative positive H Neg Pos].
  - apply isolated_same with (fun x => x = lo); [intros; lra | apply isolated_point].
  - set (below := fun x => lo < x < (if Rlt_dec hi 0 then hi else 0) /\ lo < 0).
    set (above := fun x => (if Rlt_dec lo 0 then 0 else lo) < x < hi /\ 0 < hi).
    assert (In : isolated p below (rev (map reflected negative))).
    { unfold below. destruct (Rlt_dec lo 0).
      - apply isolated_same with (fun x => (if Rlt_dec hi 0 then - hi else 0) < - x < - lo).
        + intros x _. destruct (Rlt_dec hi 0); lra.
        + apply (isolated_reflected p (fun x => (if Rlt_dec hi 0 then - hi else 0) < x < - lo)). apply inside_right with (bounds := left); auto; [now rewrite Mh | destruct (Rlt_dec hi 0); lra].
      - subst negative. apply isolated_none. intros x X. lra. }
    assert (Ip : isolated p above positive).
    { unfold above. destruct (Rlt_dec 0 hi).
      - apply isolated_same with (fun x => (if Rlt_dec lo 0 then 0 else lo) < x < hi); [intros; tauto |].
        apply inside_right with (bounds := right); auto. destruct (Rlt_dec lo 0); lra.
      - subst positive. apply isolated_none. intros x X. lra. }
    apply isolated_same with (fun x => x = lo \/ below x \/ above x \/ x = hi).
    + intros x Z. assert (x <> 0) by now intros ->. unfold below, above.
      destruct (Rlt_dec hi 0), (Rlt_dec lo 0); lra.
    + assert (Order : forall x y, below x -> above y -> x < y).
      { unfold below, above. intros x y X Y. destruct (Rlt_dec hi 0), (Rlt_dec lo 0); lra. }
      repeat (apply isolated_app; auto using isolated_point); unfold below, above;
        intros x y X Y; destruct (Rlt_dec hi 0), (Rlt_dec lo 0); try lra.
Qed.

(** ** Narrowing *)

(** keep_part, with the ends of the subinterval that the secant selects. *)
Definition keep_right_side (p : list R) (i : interval) (before : Z) (right : R) : interval :=
  if Rlt_dec right (high i) then
    let s := sgn (power_form p right) in
    if (s =? 0)%Z then Interval right right
    else if (s =? before)%Z then Interval right (high i)
    else Interval (low i) right
  else i.
Definition keep_part (p : list R) (i : interval) (left right : R) : interval :=
  let before := sgn (power_form p (low i)) in
  if Rlt_dec (low i) left then
    let s := sgn (power_form p left) in
    if (s =? 0)%Z then Interval left left
    else if negb (s =? before)%Z then Interval (low i) left
    else keep_right_side p (Interval left (high i)) before right
  else keep_right_side p i before right.

Lemma one_side p i r x : isolates p i r -> low i < x < high i -> power_form p x <> 0 ->
  (sgn (power_form p x) = sgn (power_form p (low i)) /\ isolates p (Interval x (high i)) r) \/
  (sgn (power_form p x) <> sgn (power_form p (low i)) /\ isolates p (Interval (low i) x) r).
Proof.
  intros (Z & [(A & B) | (A & Only & S)]) X N; [lra |].
  assert (Root : forall u v, low i <= u < v -> v <= high i -> power_form p u * power_form p v < 0 -> u < r < v).
  { intros u v U V O. destruct (root_between (power_form p) u v) as (q & Q & Zq); auto;
      [apply continuous_power_form | lra |]. rewrite <- (Only q); auto. lra. }
  destruct (Rlt_or_le (power_form p x * power_form p (high i)) 0) as [H | H].
  - left. assert (0 < power_form p x * power_form p (low i)).
    { destruct (Rtotal_order (power_form p x) 0) as [F | [F | F]], (Rtotal_order (power_form p (high i)) 0) as [G | [G | G]];
        try lra; try nra; rewrite G in S; lra. }
    split; [destruct (sgn_cases (power_form p x)) as [(L & ->) | [(L & ->) | (L & ->)]],
      (sgn_cases (power_form p (low i))) as [(K & ->) | [(K & ->) | (K & ->)]]; auto; exfalso; nra |].
    split; auto. right. cbn [low high]. split; [apply Root; lra |]. split; auto. intros y Y. apply Only. lra.
  - right. assert (O : power_form p (low i) * power_form p x < 0).
    { destruct (Rtotal_order (power_form p x) 0) as [F | [F | F]], (Rtotal_order (power_form p (high i)) 0) as [G | [G | G]];
        try lra; try nra; rewrite G in S; lra. }
    split; [destruct (sgn_cases (power_form p x)) as [(L & ->) | [(L & ->) | (L & ->)]],
      (sgn_cases (power_form p (low i))) as [(K & ->) | [(K & ->) | (K & ->)]]; try easy; exfalso; nra |].
    split; auto. right. cbn [low high]. split; [apply Root; lra |]. split; auto. intros y Y. apply Only. lra.
Qed.
Lemma point_isolates p i r x : isolates p i r -> low i < x < high i -> sgn (power_form p x) = 0%Z ->
  isolates p (Interval x x) r.
Proof.
  intros (Z & [(A & B) | (A & Only & S)]) X N; [lra |].
  assert (x = r) as ->; [apply Only; [lra |] | split; [easy | now left]].
  destruct (Req_dec (power_form p x) 0) as [|K]; auto. now apply sgn_not_0 in K.
Qed.
Lemma keep_right_side_right p i r right : isolates p i r -> low i < right ->
  isolates p (keep_right_side p i (sgn (power_form p (low i))) right) r.
Proof.
  intros I L. unfold keep_right_side. destruct (Rlt_dec right (high i)) as [H |]; [| easy]. cbv zeta.
  destruct (Z.eqb_spec (sgn (power_form p right)) 0) as [E | E]; [now apply (point_isolates p i) |].
  apply sgn_not_0 in E. destruct (one_side p i r right I (conj L H) E) as [(S & J) | (S & J)];
    destruct (Z.eqb_spec (sgn (power_form p right)) (sgn (power_form p (low i)))); easy.
Qed.

Theorem keep_part_right p i r left right : isolates p i r -> low i <= left < high i -> left < right ->
  isolates p (keep_part p i left right) r.
Proof.
  intros I L H. unfold keep_part. destruct (Rlt_dec (low i) left) as [K | K]; [| apply keep_right_side_right; auto; lra].
  cbv zeta. destruct (Z.eqb_spec (sgn (power_form p left)) 0) as [E | E]; [apply (point_isolates p i); auto; lra |].
  apply sgn_not_0 in E. destruct (one_side p i r left I ltac:(lra) E) as [(S & J) | (S & J)];
    destruct (Z.eqb_spec (sgn (power_form p left)) (sgn (power_form p (low i)))) as [Q | Q]; try easy; cbn [negb].
  rewrite <- S. now apply (keep_right_side_right p (Interval left (high i))).
Qed.

(** The subinterval's index, from a = |p(low)| and b = |p(high)| in a common unit. *)
Definition secant_part (a b parts : Z) : Z := a * parts / (a + b).
Theorem secant_part_right a b parts : (0 <= a)%Z -> (0 < b)%Z -> (0 < parts)%Z ->
  (0 <= secant_part a b parts < parts)%Z.
Proof.
  intros A B P. unfold secant_part. split; [apply Z.div_pos; nia |]. apply Z.div_lt_upper_bound; nia.
Qed.
(** Its ends satisfy the hypotheses of keep_part_right. *)
Lemma part_ends lo hi k parts : (0 <= k < parts)%Z -> lo < hi ->
  let place n := lo + (hi - lo) * (IZR n / IZR parts) in lo <= place k < hi /\ place k < place (k + 1)%Z.
Proof.
  intros K L place. unfold place. destruct K as (K & P). pose proof (IZR_lt _ _ P). apply IZR_le in K.
  assert (D : 0 <= IZR k / IZR parts) by (apply Rmult_le_pos; [| left; apply Rinv_0_lt_compat]; lra).
  assert (U : IZR k / IZR parts < 1) by (apply Rmult_lt_reg_r with (IZR parts); [lra |]; field_simplify; lra).
  assert (V : IZR k / IZR parts < IZR (k + 1) / IZR parts).
  { apply Rmult_lt_compat_r; [apply Rinv_0_lt_compat; lra |]. rewrite plus_IZR. lra. }
  assert (0 <= (hi - lo) * (IZR k / IZR parts)) by (apply Rmult_le_pos; lra).
  assert ((hi - lo) * (IZR k / IZR parts) < (hi - lo) * 1) by (apply Rmult_lt_compat_l; lra).
  assert ((hi - lo) * (IZR k / IZR parts) < (hi - lo) * (IZR (k + 1) / IZR parts)) by (apply Rmult_lt_compat_l; lra). lra.
Qed.

(** refine: subintervals are kept until the interval is narrow enough. *)
Inductive refined (p : list R) : interval -> interval -> Prop :=
| narrow_enough i : refined p i i
| keep i k parts j : low i < high i -> (0 <= k < parts)%Z ->
    let place n := low i + (high i - low i) * (IZR n / IZR parts) in
    refined p (keep_part p i (place k) (place (k + 1)%Z)) j -> refined p i j.
Lemma refined_right p i j r : isolates p i r -> refined p i j -> isolates p j r.
Proof.
  intros I R. induction R as [i | i k parts j L K place R IH]; [easy |]. apply IH.
  destruct (part_ends _ _ _ _ K L) as (A & B). now apply keep_part_right.
Qed.

(** ** Signs at roots *)

Definition divides (c p : list R) : Prop := exists q, forall x, power_form p x = power_form c x * power_form q x.

(** sign_at_root *)
Inductive sign_at_root (p g : list R) : interval -> Z -> Prop :=
| at_point i : low i = high i -> sign_at_root p g i (sgn (power_form g (low i)))
| identically_zero i : g = [] -> sign_at_root p g i 0
| one_sign i b : low i < high i -> controls b g (low i) (high i) -> hd 0 b <> 0 ->
    Forall (fun x => sgn x = sgn (hd 0 b)) b -> sign_at_root p g i (sgn (hd 0 b))
| common_root i c : low i < high i -> divides c p -> divides c g -> (2 <= length c)%nat ->
    sgn (power_form c (low i)) <> sgn (power_form c (high i)) -> sign_at_root p g i 0
| after_refining i j s : refined p i j -> sign_at_root p g j s -> sign_at_root p g i s.

Lemma on_unit_one_sign h t : 0 <= t <= 1 -> hd 0 h <> 0 -> Forall (fun x => sgn x = sgn (hd 0 h)) h ->
  sgn (on_unit h t) = sgn (hd 0 h).
Proof.
  intros T N F. destruct h as [| x l]; [easy |]. cbn [hd] in *.
  destruct (sgn_cases x) as [(L & E) | [(L & E) | (L & E)]]; [| | lra]; rewrite E in *.
  - assert (P : 0 < on_unit (x :: l) t).
    { apply hull_positive; try lra. eapply Forall_impl; [| exact F]. simpl. intros y Y.
      destruct (sgn_cases y) as [(K & _) | [(K & D) | (K & D)]]; auto; rewrite D in Y; easy. }
    destruct (sgn_cases (on_unit (x :: l) t)) as [(K & D) | [(K & D) | (K & D)]]; auto; lra.
  - assert (P : 0 < on_unit (map Ropp (x :: l)) t).
    { apply hull_positive; try lra. change (Forall (Rlt 0) (map Ropp (x :: l))). apply Forall_map.
      eapply Forall_impl; [| exact F]. simpl. intros y Y.
      destruct (sgn_cases y) as [(K & D) | [(K & D) | (K & D)]]; try lra; rewrite D in Y; easy. }
    rewrite on_unit_opp in P.
    destruct (sgn_cases (on_unit (x :: l) t)) as [(K & D) | [(K & D) | (K & D)]]; auto; lra.
Qed.
(** If all control values have one sign, g has it throughout. *)
Lemma one_sign_throughout b g lo hi x : lo < hi -> controls b g lo hi -> hd 0 b <> 0 ->
  Forall (fun y => sgn y = sgn (hd 0 b)) b -> lo <= x <= hi -> sgn (power_form g x) = sgn (hd 0 b).
Proof.
  intros L C N F X. rewrite <- (sign_time g _ lo hi L C).
  destruct (scaled_ends b) as (Eh & _). rewrite <- Eh. apply on_unit_one_sign.
  - destruct (time_ends lo hi L) as (E0 & E1). rewrite <- E0, <- E1. split; apply times_le; lra.
  - apply sgn_not_0. rewrite Eh. now apply sgn_not_0.
  - rewrite Eh. apply Forall_forall. intros y Y. apply (in_map sgn) in Y. rewrite scaled_signs in Y.
    apply in_map_iff in Y. destruct Y as (z & <- & Z). rewrite Forall_forall in F. now apply F.
Qed.

(** `vanishes`: if a divisor changes its sign, it has a root, the only one of p. This needs no other property of
    common_factor; the loop ends since it is the greatest divisor. *)
Lemma divisor_changes_sign p c i r : divides c p -> isolates p i r -> low i < high i ->
  sgn (power_form c (low i)) <> sgn (power_form c (high i)) -> power_form c r = 0.
Proof.
  intros (q & E) (Z & [(A & B) | (A & Only & S)]) L V; [lra |]. rewrite !E in S.
  assert (O : power_form c (low i) * power_form c (high i) < 0).
  { destruct (sgn_cases (power_form c (low i))) as [(H & U) | [(H & U) | (H & U)]],
      (sgn_cases (power_form c (high i))) as [(K & W) | [(K & W) | (K & W)]]; rewrite U, W in V;
      try easy; try nra; try (rewrite H in S; lra); rewrite K in S; lra. }
  destruct (root_between (power_form c) (low i) (high i)) as (x & X & Zx); auto; [apply continuous_power_form |].
  rewrite <- (Only x); auto; [lra |]. rewrite E, Zx. ring.
Qed.

Theorem sign_at_root_right p g i r s : isolates p i r -> sign_at_root p g i s -> s = sgn (power_form g r).
Proof.
  intros I S. induction S as [i E | i E | i b L C N F | i c L Dp (q & E) _ V | i j s R S IH].
  - destruct I as (_ & [(A & _) | (A & _)]); [now rewrite A | lra].
  - subst g. simpl. symmetry. apply sgn_0.
  - destruct I as (_ & [(A & B) | (A & _)]); [lra |]. symmetry. apply (one_sign_throughout b g (low i) (high i)); auto. lra.
  - apply (divisor_changes_sign p c i r Dp I L) in V. rewrite E, V, Rmult_0_l. symmetry. apply sgn_0.
  - apply IH. now apply refined_right with i.
Qed.

(** ** Without multiple roots: squarefree_chain of include/errbound/roots/integer_polynomial.hpp *)

Fixpoint derivative_from (i : R) (p : list R) : list R :=
  match p with [] => [] | a :: l => a * i :: derivative_from (i + 1) l end.
Definition derivative (p : list R) : list R := derivative_from 1 (tl p).
Lemma derivative_slope p x : power_form (derivative p) x = slope_at p x.
Proof.
  assert (G : forall l i, power_form (derivative_from i l) x = i * power_form l x + x * slope_at l x).
  { induction l as [| a l IH]; intros i; simpl; [ring |]. rewrite IH. ring. }
  unfold derivative. destruct p as [| a l]; simpl; [easy |]. rewrite G. ring.
Qed.
Lemma slope_product p c q x : (forall x, power_form p x = c x * power_form q x) -> forall d,
  derivable_pt_lim c x d -> slope_at p x = d * power_form q x + c x * slope_at q x.
Proof.
  intros E d D. apply (uniqueness_limite (power_form p) x); [apply derivable_power_form |].
  replace (power_form p) with (c * power_form q)%F
    by (apply FunctionalExtensionality.functional_extensionality; intros y; now rewrite E).
  apply derivable_pt_lim_mult; [easy | apply derivable_power_form].
Qed.
Lemma multiplicity p r : not_zero p -> exists k u, power_form u r <> 0 /\
  forall x, power_form p x = (x - r) ^ k * power_form u x.
Proof.
  remember (length p) as n eqn:N. revert p N. induction n as [| n IH]; intros p N (y & Y).
  - destruct p; [now destruct Y | discriminate].
  - destruct (Req_dec (power_form p r) 0) as [Z | Z]; [| exists 0%nat, p; split; [easy | intros; simpl; ring]].
    destruct (without_root p r) as (q & L & E).
    destruct (IH q) as (k & u & U & F); [lia | exists y; intros K; apply Y; rewrite E, Z, K; ring |].
    exists (S k), u. split; auto. intros x. rewrite E, Z, F. simpl. ring.
Qed.
Lemma zero_beside f r : continuity f -> (forall x, x <> r -> f x = 0) -> f r = 0.
Proof.
  intros C Z. destruct (Req_dec (f r) 0) as [| N]; auto. exfalso.
  destruct (C r (Rabs (f r)) (Rabs_pos_lt _ N)) as (d & D & H). specialize (H (r + d / 2)).
  assert (K : Rabs (f (r + d / 2) - f r) < Rabs (f r)).
  { apply H. split; [split; [exact I | intros K; lra] |]. simpl. unfold R_dist. rewrite Rabs_pos_eq; lra. }
  rewrite Z in K by lra. rewrite Rminus_0_l, Rabs_Ropp in K. lra.
Qed.

(** The quotient of p by a divisor of p and p' keeps all roots of p. *)
Theorem squarefree_part_roots p m f : not_zero p -> (forall x, power_form p x = power_form m x * power_form f x) ->
  divides m (derivative p) -> forall r, power_form p r = 0 <-> power_form f r = 0.
Proof.
  intros NZ E (g & G) r. split; [| intros Z; rewrite E, Z; ring]. intros Z.
  destruct (multiplicity p r NZ) as ([| k] & u & U & F); [exfalso; rewrite F in Z; simpl in Z; lra |].
  set (h := fun x => INR (S k) * power_form u x * power_form f x +
    (x - r) * (power_form (derivative u) x * power_form f x - power_form u x * power_form g x)).
  assert (H : h r = 0).
  { apply zero_beside.
    - unfold h. apply (continuity_plus (fun x => INR (S k) * power_form u x * power_form f x)
        (fun x => (x - r) * (power_form (derivative u) x * power_form f x - power_form u x * power_form g x))).
      + apply (continuity_mult (fun x => INR (S k) * power_form u x) (power_form f)); [| apply continuous_power_form].
        apply (continuity_scal (power_form u)), continuous_power_form.
      + apply (continuity_mult (fun x => x - r)
          (fun x => power_form (derivative u) x * power_form f x - power_form u x * power_form g x)).
        * apply (continuity_minus id (fct_cte r)); [apply derivable_continuous, derivable_id | now apply continuity_const].
        * apply (continuity_minus (fun x => power_form (derivative u) x * power_form f x) (fun x => power_form u x * power_form g x));
            [apply (continuity_mult (power_form (derivative u)) (power_form f)) | apply (continuity_mult (power_form u) (power_form g))];
            apply continuous_power_form.
    - intros x N.
      assert (D : slope_at p x = INR (S k) * (x - r) ^ k * power_form u x + (x - r) ^ S k * slope_at u x).
      { apply (slope_product p (fun y => (y - r) ^ S k) u x F).
        replace (INR (S k) * (x - r) ^ k) with (INR (S k) * (x - r) ^ pred (S k) * (1 - 0)) by (simpl pred; ring).
        apply (derivable_pt_lim_comp (fun y => y - r) (fun y => y ^ S k)); [| apply derivable_pt_lim_pow].
        apply (derivable_pt_lim_minus id (fct_cte r)); [apply derivable_pt_lim_id | apply derivable_pt_lim_const]. }
      rewrite <- derivative_slope, G, <- derivative_slope in D.
      assert (Q : power_form p x * power_form g x = power_form m x * power_form g x * power_form f x) by (rewrite E; ring).
      rewrite D, F in Q. unfold h. apply Rmult_eq_reg_l with ((x - r) ^ k); [| apply pow_nonzero; lra].
      simpl in Q. rewrite Rmult_0_r. simpl. lra. }
  unfold h in H. rewrite Rminus_diag_eq, Rmult_0_l, Rplus_0_r in H by easy.
  pose proof (lt_0_INR (S k) ltac:(lia)).
  apply Rmult_integral in H. destruct H as [H | H]; [| easy]. apply Rmult_integral in H. destruct H; lra.
Qed.

(** The first polynomial of the chain: p divided by its content, or that divided by the result of common_factor. *)
Inductive first_of_chain (p : list R) : list R -> Prop :=
| primitive c f : c <> 0 -> (forall x, power_form p x = c * power_form f x) -> first_of_chain p f
| quotient c q m f : c <> 0 -> (forall x, power_form p x = c * power_form q x) ->
    (forall x, power_form q x = power_form m x * power_form f x) -> divides m (derivative q) -> first_of_chain p f.

Lemma first_of_chain_roots p f : not_zero p -> first_of_chain p f ->
  forall x, power_form p x = 0 <-> power_form f x = 0.
Proof.
  intros NZ C x.
  assert (S : forall c q, c <> 0 -> (forall x, power_form p x = c * power_form q x) ->
    (power_form p x = 0 <-> power_form q x = 0) /\ not_zero q).
  { intros c q N E. split; [rewrite E; split; intros H; [apply Rmult_eq_reg_l with c |]; try lra; rewrite H; ring |].
    destruct NZ as (y & Y). exists y. intros K. apply Y. rewrite E, K. ring. }
  destruct C as [c f N E | c q m f N E F D].
  - now apply (S c).
  - destruct (S c q N E) as (A & B). rewrite A. now apply squarefree_part_roots with m.
Qed.

(** real_roots of coefficients p with p(0) <> 0: the intervals for the roots in (0, oo). `upper` is upper_bound(). *)
Inductive real_roots (p f : list R) : list interval -> Prop :=
| isolated_roots right left upper found : first_of_chain p f -> last f 0 <> 0 ->
    bounds_right f right -> bounds_right (mirrored f) left -> 0 < upper ->
    (forall x, 0 < x -> power_form f x = 0 -> x < upper) ->
    isolate f right left 0 upper found -> real_roots p f found.

Theorem real_roots_right p f found : power_form p 0 <> 0 -> real_roots p f found ->
  exists roots, Forall2 (isolates f) found roots /\ StronglySorted Rlt roots /\
    forall x, In x roots <-> 0 < x /\ power_form p x = 0.
Proof.
  intros N [right left upper l C Nf Br Bl U Top I].
  assert (NZ : not_zero p) by now exists 0. pose proof (first_of_chain_roots p f NZ C) as E.
  apply isolate_right in I; auto; [| now rewrite <- E | lra].
  destruct (isolated_same f (fun x => 0 <= x <= upper) (fun x => 0 < x) l) with (2 := I) as (roots & F & S & H).
  - intros x Z. specialize (Top x). split; [| intros; split; [| left; apply Top]; auto; lra].
    intros ([X | X] & _); auto. subst x. apply E in Z. easy.
  - exists roots. repeat (split; [easy |]). intros x. now rewrite H, E.
Qed.
