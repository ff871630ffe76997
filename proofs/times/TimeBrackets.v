(** Brackets of times between adjacent doubles (ccd/contact/time_bracket.hpp), over the real numbers. Any set of
    numbers stands for the doubles. Results:
        lesser_bracket        the lesser of two different brackets has the earlier time
        least_bracket         the least bracket of several times is that of the least time
        first_of_union        the first time of a union is the least of the first times
        bracket_of_first      consequences of the bracket of a first time
        search_right          the search by signs at doubles
        linear_bracket_right, quadratic_only_right, quadratic_first_right, quadratic_second_right
                              brackets of roots of linear and quadratic forms *)

From Coq Require Import Reals Lra Psatz List.
From Errbound Require Import Contact VertexEdge Separation.
Import ListNotations.
Open Scope R_scope.

Section Doubles.

Variable double : R -> Prop.

Definition neighbours (l h : R) : Prop := double l /\ double h /\ l < h /\ forall x, double x -> ~ l < x < h.
Definition bracket : Type := R * R.
Definition holds_time (b : bracket) (t : R) : Prop :=
  (double t /\ fst b = t /\ snd b = t) \/ (neighbours (fst b) (snd b) /\ fst b < t < snd b).
(** operator<=> *)
Definition lesser (a b : bracket) : Prop := fst a < fst b \/ (fst a = fst b /\ snd a < snd b).

Lemma lesser_total a b : lesser a b \/ a = b \/ lesser b a.
Proof.
  unfold lesser. destruct a as [l h], b as [m k]. cbn [fst snd].
  destruct (Rtotal_order l m) as [| [-> |]]; auto. destruct (Rtotal_order h k) as [| [-> |]]; auto 6.
Qed.
Theorem lesser_bracket a b s t : holds_time a s -> holds_time b t -> lesser a b -> s < t.
Proof.
  unfold lesser. destruct a as [l h], b as [m k]. cbn [fst snd].
  intros [(Ds & E1 & E2) | ((Dl & Dh & LH & NoA) & S)] [(Dt & F1 & F2) | ((Dm & Dk & MK & NoB) & T)];
    cbn [fst snd] in *; intros [L | (E & L)]; try lra.
  - destruct (Rlt_or_le t h) as [Q |]; [| lra]. exfalso. apply (NoA t Dt). lra.
  - destruct (Rlt_or_le m h) as [Q |]; [| lra]. exfalso. apply (NoA m Dm). lra.
  - exfalso. apply (NoB h Dh). lra.
Qed.
(** Equal brackets need no comparison: the least bracket is that of the least time. *)
Theorem least_bracket (times : list (R * bracket)) s a : Forall (fun p => holds_time (snd p) (fst p)) times ->
  In (s, a) times -> (forall t b, In (t, b) times -> s <= t) ->
  forall t b, In (t, b) times -> (forall r c, In (r, c) times -> ~ lesser c b) -> b = a.
Proof.
  intros F Is Least t b It No. rewrite Forall_forall in F.
  pose proof (F _ Is) as Hs. pose proof (F _ It) as Ht. cbn [fst snd] in Hs, Ht.
  destruct (lesser_total a b) as [L | [E | L]]; auto; [exfalso; exact (No s a Is L) |].
  pose proof (lesser_bracket b a t s Ht Hs L). specialize (Least t b It). lra.
Qed.

(** ** First times *)

Theorem first_of_union (parts : list (R -> Prop)) t : (exists H, In H parts /\ first H t) ->
  (forall H s, In H parts -> first H s -> t <= s) ->
  (forall H, In H parts -> sometime H -> exists s, first H s) ->
  first (fun s => exists H, In H parts /\ H s) t.
Proof.
  intros (H & I & (T & Ht & _)) Least Exist. split; auto. split; [eauto |]. intros s S (G & J & Gs).
  destruct (Exist G J) as (r & Fr); [exists s; split; [lra | auto] |].
  pose proof (Least G r J Fr). destruct Fr as (R0 & _ & Before).
  apply (Before s); auto. lra.
Qed.
(** There is no contact before the bracket, nor at its lower end if it has positive length, and there is one inside. *)
Theorem bracket_of_first (H : R -> Prop) t b : first H t -> holds_time b t ->
  (forall s, 0 <= s < fst b -> ~ H s) /\ (0 <= fst b < snd b -> ~ H (fst b)) /\
  exists s, fst b <= s <= snd b /\ H s.
Proof.
  intros (T & Ht & Before) B.
  assert (E : fst b <= t <= snd b /\ (fst b < snd b -> fst b < t)) by (destruct B as [(_ & E & F) | (_ & S)]; lra).
  split; [| split].
  - intros s S. apply Before. lra.
  - intros S. apply Before. lra.
  - exists t. split; [lra | auto].
Qed.

(** ** The search *)

(** root_search::between: the next double is arbitrary. `before` has the sign that is expected above low. *)
Inductive search (p : R -> R) (before : R) : R -> R -> bracket -> Prop :=
  | neighbours_left a b : neighbours a b -> search p before a b (a, b)
  | root_found a b x : double x -> a < x < b -> p x = 0 -> search p before a b (x, x)
  | root_later a b x r : double x -> a < x < b -> 0 < p x * before -> search p before x b r ->
      search p before a b r
  | root_earlier a b x r : double x -> a < x < b -> p x * before < 0 -> search p before a x r ->
      search p before a b r.

(** Y may have other roots there, at which it does not change its sign. *)
Theorem search_right p before low high r b : search p before low high b -> low < r < high ->
  (forall x, low < x < high -> 0 < p x * before -> x < r) ->
  (forall x, low < x < high -> p x * before < 0 -> r < x) ->
  holds_time b r \/ (low < fst b < high /\ double (fst b) /\ snd b = fst b /\ p (fst b) = 0).
Proof.
  intros B. induction B as [a b N | a b x D X Z | a b x c D X S B IH | a b x c D X S B IH]; intros R0 Later Earlier.
  - left. right. now split.
  - right. cbn [fst snd]. auto.
  - destruct IH as [| (L & Q)]; auto; [split; [now apply Later | lra] | intros y Y; apply Later; lra |
      intros y Y; apply Earlier; lra |]. right. split; [lra | auto].
  - destruct IH as [| (L & Q)]; auto; [split; [lra | now apply Earlier] | intros y Y; apply Later; lra |
      intros y Y; apply Earlier; lra |]. right. split; [lra | auto].
Qed.
Lemma search_only p before low high r b : search p before low high b -> low < r < high ->
  (forall x, low < x < high -> 0 < p x * before -> x < r) ->
  (forall x, low < x < high -> p x * before < 0 -> r < x) ->
  (forall x, low < x < high -> p x = 0 -> x = r) -> holds_time b r.
Proof.
  intros B R0 Later Earlier Only.
  destruct (search_right p before low high r b B R0 Later Earlier) as [| (L & D & E & Z)]; auto.
  pose proof (Only _ L Z) as F. left. rewrite E, <- F. auto.
Qed.

(** ** Linear forms *)

Context (double_0 : double 0) (double_1 : double 1).

(** bracket_of_linear_root *)
Definition linear_bracket (p0 p1 : R) (b : bracket) : Prop :=
  (p0 = 0 /\ b = (0, 0)) \/ (p0 <> 0 /\ p1 = 0 /\ b = (1, 1)) \/
  (p0 <> 0 /\ p1 <> 0 /\ search (linear_at p0 p1) p0 0 1 b).

Theorem linear_bracket_right p0 p1 b : p0 * p1 <= 0 -> p0 <> 0 \/ p1 <> 0 -> linear_bracket p0 p1 b ->
  exists r, 0 <= r <= 1 /\ holds_time b r /\ forall t, linear_at p0 p1 t = 0 <-> t = r.
Proof.
  intros S N B. set (r := p0 / (p0 - p1)). assert (D : p0 - p1 <> 0) by nra.
  assert (E : r * (p0 - p1) = p0) by (unfold r; field; auto).
  assert (L : forall t, linear_at p0 p1 t = (p0 - p1) * (r - t)) by (intros t; unfold linear_at; lra).
  assert (Root : forall t, linear_at p0 p1 t = 0 <-> t = r).
  { intros t. rewrite L. split; [| intros ->; ring]. intros Z. apply Rmult_integral in Z. destruct Z; lra. }
  exists r. destruct B as [(Z & ->) | [(N0 & Z & ->) | (N0 & N1 & B)]].
  - assert (Er : r = 0) by (unfold r; rewrite Z; field; lra). rewrite Er in *. split; [lra |]. split; auto.
    left. auto.
  - assert (Er : r = 1) by (unfold r; rewrite Z; field; lra). rewrite Er in *. split; [lra |]. split; auto.
    left. auto.
  - assert (O : p0 * p1 < 0) by (destruct (Req_dec (p0 * p1) 0) as [Q |]; [apply Rmult_integral in Q; tauto | lra]).
    assert (P : 0 < p0 * (p0 - p1)) by nra. assert (P1 : 0 < - p1 * (p0 - p1)) by nra.
    assert (R0 : 0 < r < 1).
    { destruct (Rlt_or_le 0 (p0 - p1)) as [Q | Q].
      - assert (0 < p0) by nra. assert (0 < - p1) by nra. split; nra.
      - assert (p0 < 0) by nra. assert (- p1 < 0) by nra. split; nra. }
    split; [lra |]. split; auto. apply (search_only _ _ _ _ r b B); auto.
    + intros x X. rewrite L. intros Q. assert (0 < (p0 * (p0 - p1)) * (r - x)) by lra.
      apply Rnot_le_lt. intros C. nra.
    + intros x X. rewrite L. intros Q. assert ((p0 * (p0 - p1)) * (r - x) < 0) by lra.
      apply Rnot_le_lt. intros C. nra.
    + intros x X Z. now apply Root.
Qed.

(** ** Quadratic forms *)

(** bracket_of_quadratic_root *)
Definition quadratic_bracket (f : quadratic) (which : which_root) (b : bracket) : Prop :=
  match which with
  | only_root_of => search (quadratic_at f) (c0 f) 0 1 b
  | _ =>
      exists extreme, linear_bracket (c1 f - 2 * c0 f) (2 * c2 f - c1 f) extreme /\
      let beside := match which with first_root_of => fst extreme | _ => snd extreme end in
      (quadratic_at f beside = 0 /\ b = (beside, beside)) \/
      (0 < quadratic_at f beside * c0 f /\ b = extreme) \/
      (quadratic_at f beside * c0 f < 0 /\
       match which with
       | first_root_of => search (quadratic_at f) (c0 f) 0 beside b
       | _ => search (quadratic_at f) (- c0 f) beside 1 b
       end)
  end.

Theorem quadratic_only_right f r b : 0 < r < 1 ->
  (forall t, 0 < t < r -> 0 < quadratic_at f t * c0 f) -> quadratic_at f r = 0 ->
  (forall t, r < t < 1 -> quadratic_at f t * c0 f < 0) ->
  quadratic_bracket f only_root_of b -> holds_time b r.
Proof.
  intros R0 Before Z After B. apply (search_only _ _ _ _ r b B); auto.
  - intros x X Q. destruct (Rtotal_order x r) as [L | [-> | L]]; auto; [rewrite Z in Q; lra |].
    specialize (After x). lra.
  - intros x X Q. destruct (Rtotal_order x r) as [L | [-> | L]]; auto; [| rewrite Z in Q; lra].
    specialize (Before x). lra.
  - intros x X Q. destruct (Rtotal_order x r) as [L | [-> | L]]; auto.
    + specialize (Before x). rewrite Q in Before. lra.
    + specialize (After x). rewrite Q in After. lra.
Qed.

Section TwoRoots.

Context (f : quadratic) (k p q : R) (nonzero : k <> 0) (in_order : 0 < p < q /\ q < 1)
  (product : forall t, quadratic_at f t = k * ((t - p) * (t - q))).

Lemma end_value : c0 f = k * (p * q).
Proof. rewrite <- (proj1 (at_ends f)), product. ring. Qed.
Lemma relative_sign t : quadratic_at f t * c0 f = k * k * (p * q) * ((t - p) * (t - q)).
Proof. rewrite end_value, product. ring. Qed.
Lemma unit_positive : 0 < k * k * (p * q).
Proof. assert (0 < k * k) by nra. assert (0 < p * q) by nra. now apply Rmult_lt_0_compat. Qed.
Lemma slope_value : c1 f - 2 * c0 f = - (k * (p + q)) /\ 2 * c2 f - c1 f = k * (2 - (p + q)).
Proof.
  pose proof (product 0) as E0. pose proof (product 1) as E1. pose proof (product (1 / 2)) as E2.
  unfold quadratic_at, value in *. split; lra.
Qed.
Lemma extreme_between e : linear_bracket (c1 f - 2 * c0 f) (2 * c2 f - c1 f) e -> holds_time e ((p + q) / 2).
Proof.
  destruct slope_value as (-> & ->). intros B. apply linear_bracket_right in B.
  - destruct B as (r & R0 & H & Only). replace ((p + q) / 2) with r; auto. symmetry. apply Only.
    unfold linear_at. field.
  - assert (0 < k * k) by nra. assert (0 <= (k * k) * ((p + q) * (2 - (p + q)))); [| nra].
    apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra].
  - left. intros Z. assert (k * (p + q) = 0) as Z' by lra. apply Rmult_integral in Z'. destruct Z'; lra.
Qed.
Lemma outside t : 0 < quadratic_at f t * c0 f <-> t < p \/ q < t.
Proof.
  rewrite relative_sign. pose proof unit_positive as U. split.
  - intros H. assert (0 < (t - p) * (t - q)) by nra. destruct (Rlt_or_le t p); auto.
    destruct (Rlt_or_le q t); auto. exfalso. nra.
  - intros H. apply Rmult_lt_0_compat; auto. destruct H; nra.
Qed.
Lemma inside t : quadratic_at f t * c0 f < 0 <-> p < t < q.
Proof.
  rewrite relative_sign. pose proof unit_positive as U. split.
  - intros H. assert ((t - p) * (t - q) < 0) by nra. split; nra.
  - intros H. assert (0 < k * k * (p * q) * ((t - p) * (q - t))) by (apply Rmult_lt_0_compat; nra). nra.
Qed.
Lemma zeros t : quadratic_at f t = 0 <-> t = p \/ t = q.
Proof.
  rewrite product. split.
  - intros Z. apply Rmult_integral in Z. destruct Z as [| Z]; [easy |]. apply Rmult_integral in Z. lra.
  - intros [-> | ->]; ring.
Qed.

(** next to r, on the side of the root with the extreme *)
Ltac beside_extreme r :=
  intros (e & E & C); apply extreme_between in E; assert (M : p < (p + q) / 2 < q) by lra; cbn zeta in C;
  destruct C as [(Z & ->) | [(S & ->) | (S & B)]];
  [ apply zeros in Z; destruct E as [(D & F & G) | ((D & D' & _) & T)]; destruct Z as [Z | Z]; try lra;
    left; rewrite <- Z; auto
  | apply outside in S; destruct E as [(D & F & G) | (N & T)]; destruct S as [S | S]; try lra; right; split; auto; lra
  | apply inside in S; destruct E as [(D & F & G) | (N & T)]; (apply (search_only _ _ _ _ r _ B); [lra | | |]);
    intros x X Q; solve [apply zeros in Q; lra
      | assert (Q' : 0 < quadratic_at f x * c0 f) by lra; apply outside in Q'; lra
      | assert (Q' : quadratic_at f x * c0 f < 0) by lra; apply inside in Q'; lra] ].
Theorem quadratic_first_right b : quadratic_bracket f first_root_of b -> holds_time b p.
Proof. beside_extreme p. Qed.
Theorem quadratic_second_right b : quadratic_bracket f second_root_of b -> holds_time b q.
Proof. beside_extreme q. Qed.

End TwoRoots.

End Doubles.
