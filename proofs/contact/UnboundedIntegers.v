(** Queries in integers of unbounded size (ccd/exact/unbounded_integers.hpp), shared by the reference, `bsc-exact`
    and `root-parity`: the conversion, and contact of a vertex with an edge by common factors and real roots of
    integer polynomials. common_factor and real_roots are represented by their promises (root_finder); all else is
    restated. Results:
        to_integers_right       the integers are the coordinates, in units of their axes
        without_end_roots_value   p(t) is that form at t/(1 - t), up to a positive factor
        integer_contact_right   `vertex_touches_edge` is true exactly if vertex and edge meet in [0, 1]
        face_border_right, edges_border_right   `touches_at_border` is true exactly if they touch at the border *)

From Coq Require Import Reals ZArith Lia Lra Psatz List Bool.
From Errbound Require Import RootIsolation Sign Bernstein Bsc Contact Decisions AxisUnits.
From Errbound Require VertexEdge.
Import ListNotations.
Open Scope R_scope.

(** s is the sign of v. *)
Definition tells (s : sign) (v : R) : Prop := s <> uncertain /\ sign_is_right s v.

(** ** Integers *)

Lemma integer_tells (n : integers) : tells (sign_of n) (exact n).
Proof. split; [now destruct n | apply sign_right]. Qed.

(** ** to_integers *)

(** A double's mantissa and exponent, as odd_part and last_bit of `binary_double` return them; mantissa 0 for zero. *)
Record dyadic := Dyadic { mantissa : Z; exponent : Z }.
Definition double (d : dyadic) : R := IZR (mantissa d) * powerRZ 2 (exponent d).
Record doubles := Doubles { dx : dyadic; dy : dyadic; dz : dyadic }.
Record given := Given { at0 : doubles; at1 : doubles }.
Definition given_point (p : doubles) : point := Point (double (dx p)) (double (dy p)) (double (dz p)).
Definition given_motion (m : given) : moving := Moving (given_point (at0 m)) (given_point (at1 m)).

Definition lower (bound : Z) (d : dyadic) : Z :=
  if Z.eqb (mantissa d) 0 then bound else Z.min bound (exponent d).
Definition lowest (axis : doubles -> dyadic) (query : list given) : Z :=
  fold_left (fun bound m => lower (lower bound (axis (at0 m))) (axis (at1 m))) query (2 ^ 31 - 1)%Z.
Definition to_integer (d : dyadic) (unit : Z) : Z :=
  if Z.eqb (mantissa d) 0 then 0%Z else Z.shiftl (mantissa d) (exponent d - unit).
Definition to_integers (query : list given) (m : given) : @moving_point integers :=
  let ux := lowest dx query in let uy := lowest dy query in let uz := lowest dz query in
  let convert (p : doubles) :=
    @Position integers (to_integer (dx p) ux) (to_integer (dy p) uy) (to_integer (dz p) uz) in
  MovingPoint (convert (at0 m)) (convert (at1 m)).
Definition unit_of (query : list given) : point := Point
  (powerRZ 2 (- lowest dx query)) (powerRZ 2 (- lowest dy query)) (powerRZ 2 (- lowest dz query)).

Lemma lowest_right axis query m : In m query ->
  (mantissa (axis (at0 m)) = 0%Z \/ (lowest axis query <= exponent (axis (at0 m)))%Z) /\
  (mantissa (axis (at1 m)) = 0%Z \/ (lowest axis query <= exponent (axis (at1 m)))%Z).
Proof.
  unfold lowest. generalize (2 ^ 31 - 1)%Z.
  assert (Lower : forall bound d, (lower bound d <= bound)%Z /\ (mantissa d = 0%Z \/ (lower bound d <=
    exponent d)%Z)).
  { intros bound d. unfold lower. destruct (Z.eqb_spec (mantissa d) 0); split; auto; lia. }
  assert (Down : forall q bound, (fold_left (fun bound m => lower (lower bound (axis (at0 m))) (axis
    (at1 m))) q bound <= bound)%Z).
  { induction q as [| n q IH]; intros bound; simpl; [lia |]. etransitivity; [apply IH |].
    destruct (Lower bound (axis (at0 n))), (Lower (lower bound (axis (at0 n))) (axis (at1 n))). lia. }
  induction query as [| n q IH]; [easy |]. intros bound [-> | I]; [| now apply IH]. simpl.
  pose proof (Down q (lower (lower bound (axis (at0 m))) (axis (at1 m)))).
  destruct (Lower bound (axis (at0 m))), (Lower (lower bound (axis (at0 m))) (axis (at1 m))). lia.
Qed.
Lemma to_integer_right d unit : mantissa d = 0%Z \/ (unit <= exponent d)%Z ->
  IZR (to_integer d unit) = powerRZ 2 (- unit) * double d.
Proof.
  unfold to_integer, double. destruct (Z.eqb_spec (mantissa d) 0) as [-> | N]; [intros; ring |].
  intros [| H]; [easy |]. rewrite Z.shiftl_mul_pow2, mult_IZR by lia.
  replace (IZR (2 ^ (exponent d - unit))) with (powerRZ 2 (exponent d - unit)).
  - replace (exponent d - unit)%Z with (- unit + exponent d)%Z by ring. rewrite powerRZ_add by lra.
    ring.
  - rewrite <- (Z2Nat.id (exponent d - unit)) by lia. now rewrite <- pow_powerRZ, <- pow_IZR.
Qed.

Theorem to_integers_right query m : In m query ->
  units (unit_of query) /\ in_integers (unit_of query) (given_motion m) (to_integers query m).
Proof.
  intros I. split; [repeat split; apply powerRZ_lt; lra |].
  destruct (lowest_right dx query m I), (lowest_right dy query m I), (lowest_right dz query m I).
  unfold in_integers, exact_motion, exact_position, to_integers, stretched_motion, stretched,
    given_motion, given_point.
  cbn [t0 t1 px py pz start finish x y z unit_of].
  f_equal; apply same_point; cbn [x y z]; now apply to_integer_right.
Qed.

Lemma query_in_integers q0 q1 q2 q3 : let q := [q0; q1; q2; q3] in let k := unit_of q in units k /\
  in_integers k (given_motion q0) (to_integers q q0) /\ in_integers k (given_motion q1) (to_integers q q1) /\
  in_integers k (given_motion q2) (to_integers q q2) /\ in_integers k (given_motion q3) (to_integers q q3).
Proof. repeat split; apply to_integers_right || (apply powerRZ_lt; lra); simpl; tauto. Qed.

(** ** Integer forms in x = t/s *)

(** Coefficients ascend. *)
Fixpoint without_zeros (p : list Z) : list Z := match p with Z0 :: l => without_zeros l | _ => p end.
Definition without_end_roots (p : list Z) : list Z := rev (without_zeros (rev (without_zeros p))).

Lemma without_zeros_poly p : exists n, forall x, poly p x = x ^ n * poly (without_zeros p) x.
Proof.
  unfold poly. induction p as [| a l (n & E)]; [exists 0%nat; intros; simpl; ring |].
  destruct a; [| exists 0%nat; intros; simpl; ring | exists 0%nat; intros; simpl; ring].
  exists (S n). intros x. simpl. rewrite E. ring.
Qed.
Lemma poly_without_last l x : poly (l ++ [0%Z]) x = poly l x.
Proof. unfold poly. induction l as [| a l IH]; simpl; [ring | rewrite IH; ring]. Qed.
Lemma poly_trimmed l x : poly (rev (without_zeros l)) x = poly (rev l) x.
Proof. induction l as [| a l IH]; [easy |]. destruct a; [| easy | easy]. simpl.
now rewrite IH, poly_without_last. Qed.
Lemma without_zeros_head p :
  without_zeros p = [] /\ Forall (eq 0%Z) p \/ hd 0%Z (without_zeros p) <> 0%Z.
Proof.
  induction p as [| a l IH]; [left; auto |]. destruct a; [| right; easy | right; easy].
  simpl. destruct IH as [(-> & F) |]; auto.
Qed.
Lemma poly_at_0 p : poly p 0 = IZR (hd 0%Z p).
Proof. destruct p; unfold poly; simpl; [easy | ring]. Qed.
Lemma last_rev (l : list Z) : last (rev l) 0%Z = hd 0%Z l.
Proof. destruct l; [easy |]. simpl. apply last_last. Qed.

Lemma without_end_roots_trimmed p : trimmed (without_end_roots p).
Proof.
  unfold trimmed, without_end_roots. rewrite last_rev.
  destruct (without_zeros_head (rev (without_zeros p))) as [(-> & _) |]; auto.
Qed.
Lemma without_end_roots_start p : without_end_roots p = [] \/ poly (without_end_roots p) 0 <> 0.
Proof.
  unfold without_end_roots. destruct (without_zeros_head p) as [(-> & _) | N]; [now left | right].
  rewrite poly_trimmed, rev_involutive, poly_at_0. now apply not_0_IZR.
Qed.
Lemma without_end_roots_empty p : without_end_roots p = [] -> Forall (eq 0%Z) p.
Proof.
  unfold without_end_roots. intros E.
  apply (f_equal (@rev Z)) in E. rewrite rev_involutive in E. simpl in E.
  destruct (without_zeros_head (rev (without_zeros p))) as [(_ & F) | N]; [| now rewrite E in N].
  destruct (without_zeros_head p) as [(_ & G) | N]; auto.
  destruct (without_zeros p) as [| a l]; [easy |].
  simpl in *. apply Forall_app in F. destruct F as (_ & F). inversion_clear F. now subst.
Qed.

Theorem without_end_roots_value (p : list integers) t : p <> [] -> 0 < t < 1 ->
  exists c, 0 < c /\ at_time p t = c * poly (without_end_roots p) (t / (1 - t)).
Proof.
  intros N T. set (r := t / (1 - t)). assert (X : 0 < r) by (apply Rdiv_lt_0_compat; lra).
  destruct (without_zeros_poly p) as (n & E). exists ((1 - t) ^ (length p - 1) * r ^ n).
  split; [apply Rmult_lt_0_compat; apply pow_lt; lra |].
  unfold without_end_roots. rewrite poly_trimmed, rev_involutive, Rmult_assoc, <- E.
  destruct p as [| a l]; [easy |]. unfold at_time, poly. cbn [map]. rewrite power_basis by lra.
  rewrite map_length. now replace (length (a :: l) - 1)%nat with (length l) by (simpl; lia).
Qed.
Lemma inner_signs (p : list integers) t : p <> [] -> 0 < t < 1 ->
  let v := poly (without_end_roots p) (t / (1 - t)) in
  (at_time p t = 0 <-> v = 0) /\ forall s, tells s v -> tells s (at_time p t).
Proof.
  intros N T. cbv zeta. destruct (without_end_roots_value p t N T) as (c & C & ->). split.
  - split; [intros E; apply Rmult_integral in E; lra | intros ->; ring].
  - intros s (U & R). split; auto. destruct s; simpl in *; nra.
Qed.

(** ** Promises of common_factor and real_roots *)

Record root_finder := {
  common_factor : list Z -> list Z -> list Z;
  root : Type;
  real_roots : list Z -> list root;             (** those in x > 0 *)
  sign_at_root : list Z -> root -> sign;
  where_is : root -> R
}.

(** The arguments of a query's calls: two polynomials, one, and one at another's roots. The query calls them only
    with its own polynomials, so its answer does not depend on results for others. *)
Record demands := Demands {
  of_factor : list Z -> list Z -> Prop;
  of_roots : list Z -> Prop;
  of_signs : list Z -> list Z -> Prop          (** p, whose roots are used, and the other *)
}.
Definition promises (finder : root_finder) : demands := {|
  of_factor := fun f g => trimmed f -> trimmed g ->
    let h := common_factor finder f g in
    trimmed h /\ (h = [] <-> f = [] /\ g = []) /\ forall x, poly h x = 0 <-> poly f x = 0 /\ poly g x = 0;
  of_roots := fun p => trimmed p -> (2 <= length p)%nat -> poly p 0 <> 0 -> forall x,
    (exists k, In k (real_roots finder p) /\ where_is finder k = x) <-> 0 < x /\ poly p x = 0;
  of_signs := fun p g => trimmed p -> (2 <= length p)%nat -> poly p 0 <> 0 -> trimmed g -> forall k,
    In k (real_roots finder p) -> tells (sign_at_root finder g k) (poly g (where_is finder k))
|}.

Section Contact.

Variable finder : root_finder.
Notation "p '#' i" := (nth i p 0%Z) (at level 20).
Notation form_at := (@at_time integers).
Implicit Types (f b : list Z) (fs : list (list Z)).

Definition on_line fs : list Z :=
  fold_left (fun all f => common_factor finder all (without_end_roots f)) fs [].

(** The factors that on_line computes. *)
Fixpoint factors_meet (d : demands) (all : list Z) fs : Prop :=
  match fs with
  | [] => True
  | f :: rest => of_factor d all (without_end_roots f) /\
      factors_meet d (common_factor finder all (without_end_roots f)) rest
  end.

Lemma on_line_right fs : factors_meet (promises finder) [] fs -> trimmed (on_line fs) /\
  (on_line fs = [] <-> Forall (fun f => without_end_roots f = []) fs) /\
  forall x, poly (on_line fs) x = 0 <-> Forall (fun f => poly (without_end_roots f) x = 0) fs.
Proof.
  unfold on_line. assert (H : forall fs all, factors_meet (promises finder) all fs -> trimmed all ->
    let r := fold_left (fun all f => common_factor finder all (without_end_roots f)) fs all in
    trimmed r /\ (r = [] <-> all = [] /\ Forall (fun f => without_end_roots f = []) fs) /\
    forall x, poly r x = 0 <-> poly all x = 0 /\ Forall (fun f => poly (without_end_roots f) x = 0) fs).
  { clear fs. induction fs as [| f fs IH]; intros all M T; cbn [fold_left].
    - split; auto. split; [intuition | intros; intuition].
    - destruct M as (P & M). destruct (P T (without_end_roots_trimmed f)) as (Tc & E & R).
      destruct (IH (common_factor finder all (without_end_roots f)) M Tc) as (Tr & Er & Rr). cbv zeta.
        split; auto.
      split; [rewrite Er, E, Forall_cons_iff; tauto |]. intros x. rewrite Rr, R, Forall_cons_iff. tauto.
        }
  intros M. destruct (H fs [] M (or_introl eq_refl)) as (T & E & R). cbv zeta in *. split; auto.
  split; [rewrite E; tauto |]. intros x. rewrite R. unfold poly at 1. simpl. tauto.
Qed.

(** The contact of a vertex with an edge: fs is W x E, b is W (W - E). *)
Definition on_line_at fs (i : nat) : bool := forallb (fun f => Z.eqb (f#i) 0) fs.
Definition touches fs b : bool :=
  if existsb (@certainly_rootless integers) fs then false
  else if on_line_at fs 0 && (b#0 <=? 0)%Z then true
  else if on_line_at fs 2 && (b#2 <=? 0)%Z then true
  else match on_line fs with
    | [] => (b#1 <? 0)%Z && (4 * (b#0) * (b#2) <=? (b#1) * (b#1))%Z
    | [_] => false
    | p =>
        existsb (fun k => negb (same_sign (sign_at_root finder (without_end_roots b) k) positive))
          (real_roots finder p)
    end.

(** The hypotheses about the finder. *)
Definition touches_meets (d : demands) fs b : Prop :=
  factors_meet d [] fs /\ of_roots d (on_line fs) /\ of_signs d (on_line fs) (without_end_roots b).

Definition meets fs b (t : R) : Prop := Forall (fun f => form_at f t = 0) fs /\ form_at b t <= 0.

Lemma quadratic_ends f : length f = 3%nat -> form_at f 0 = IZR (f#0) /\ form_at f 1 = IZR (f#2).
Proof.
  intros L. split; [now apply (@at_start integers); destruct f | now apply (@at_finish integers)].
Qed.
Lemma at_an_end fs b i t : Forall (fun f => length f = 3%nat) fs -> length b = 3%nat ->
  i = 0%nat /\ t = 0 \/ i = 2%nat /\ t = 1 -> on_line_at fs i && (b#i <=? 0)%Z = true <-> meets fs b t.
Proof.
  intros F B I.
  assert (V : forall f, length f = 3%nat -> form_at f t = IZR (f#i))
    by (intros f L; destruct (quadratic_ends f L), I as [(-> & ->) | (-> & ->)]; auto).
  unfold on_line_at, meets. rewrite andb_true_iff, Z.leb_le, forallb_forall, (V b B), Forall_forall.
  rewrite Forall_forall in F. split; intros (A & C).
  - split; [| now apply IZR_le]. intros f J. rewrite V by auto. specialize (A f J). apply Z.eqb_eq in A.
    now rewrite A.
  - split; [| now apply le_IZR]. intros f J. apply Z.eqb_eq, eq_IZR. rewrite <- V by auto. now apply A.
Qed.

Lemma inner_all_vanish fs t : factors_meet (promises finder) [] fs -> Forall (fun f => length f = 3%nat) fs ->
  0 < t < 1 -> Forall (fun f => form_at f t = 0) fs <-> poly (on_line fs) (t / (1 - t)) = 0.
Proof.
  intros M F T. rewrite (proj2 (proj2 (on_line_right fs M))). rewrite !Forall_forall.
  rewrite Forall_forall in F.
  split; intros A f I; specialize (A f I); specialize (F f I);
    (apply (proj1 (inner_signs f t ltac:(now destruct f) T)); exact A).
Qed.

Lemma touches_right fs b : touches_meets (promises finder) fs b -> Forall (fun f => length f = 3%nat) fs ->
  length b = 3%nat -> touches fs b = true <-> exists t, 0 <= t <= 1 /\ meets fs b t.
Proof.
  intros (Factors & Roots & Signs) F B. unfold touches. destruct (existsb (@certainly_rootless integers) fs) eqn:Rootless.
  { split; [easy |]. intros (t & T & V & _). apply existsb_exists in Rootless.
    destruct Rootless as (f & I & R).
    rewrite Forall_forall in V. specialize (V f I). now apply (@rootless_hull integers f t R T) in V. }
  clear Rootless. pose proof (at_an_end fs b 0 0 F B ltac:(auto)) as At0.
  pose proof (at_an_end fs b 2 1 F B ltac:(auto)) as At1.
  destruct (on_line_at fs 0 && (b#0 <=? 0)%Z).
  { split; auto. intros _. exists 0. split; [lra | now apply At0]. }
  destruct (on_line_at fs 2 && (b#2 <=? 0)%Z).
  { split; auto. intros _. exists 1. split; [lra | now apply At1]. }
  assert (Inside : (exists t, 0 <= t <= 1 /\ meets fs b t) <-> exists t, 0 < t < 1 /\ meets fs b t).
  { split; intros (t & T & M); exists t; split; auto; [| lra].
    destruct (Req_dec t 0) as [-> | N0]; [now apply At0 in M |].
    destruct (Req_dec t 1) as [-> | N1]; [now apply At1 in M |]. lra. }
  rewrite Inside. clear Inside.
  assert (Nb : b <> []) by now destruct b.
  destruct (on_line_right fs Factors) as (Tr & Empty & At).
  pose proof (fun t => inner_all_vanish fs t Factors F) as Vanish.
  destruct (on_line fs) as [| a [| c l]] eqn:E.
  - (* on the line throughout *)
    assert (Z : Forall (fun f => forall i, f#i = 0%Z) fs).
    { eapply Forall_impl; [| apply Empty; auto]. intros f H i. apply without_end_roots_empty in H.
      rewrite Forall_forall in H. destruct (nth_in_or_default i f 0%Z) as [I | I]; auto.
      now rewrite <- (H _ I). }
    assert (Always : forall t, 0 <= t <= 1 -> Forall (fun f => form_at f t = 0) fs).
    { intros t _. rewrite Forall_forall in *. intros f I. specialize (Z f I). specialize (F f I).
      destruct (length_3 f F) as (f0 & f1 & f2 & ->). unfold at_time. cbn [map form].
      rewrite (Z 0%nat : f0 = 0%Z), (Z 1%nat : f1 = 0%Z), (Z 2%nat : f2 = 0%Z). simpl. ring. }
    destruct (quadratic_ends b B) as (B0 & B2).
    assert (P : 0 < IZR (b#0) /\ 0 < IZR (b#2)).
    { rewrite <- B0, <- B2. split; apply Rnot_le_lt; intros H;
        [assert (M : meets fs b 0) by (split; auto; apply Always; lra); now apply At0 in M |
         assert (M : meets fs b 1) by (split; auto; apply Always; lra); now apply At1 in M]. }
    pose proof (VertexEdge.dips (VertexEdge.Quadratic (IZR (b#0)) (IZR (b#1)) (IZR (b#2))) (proj1 P)
      (proj2 P)) as D.
    simpl VertexEdge.c0 in D. simpl VertexEdge.c1 in D. simpl VertexEdge.c2 in D.
    rewrite <- (VertexEdge.by_ratio (fun x => VertexEdge.at_ratio _ x <= 0)) in D.
    rewrite andb_true_iff, Z.ltb_lt, Z.leb_le.
    assert (G : ((b#1 < 0)%Z /\ (4 * (b#0) * (b#2) <= (b#1) * (b#1))%Z) <->
      (IZR (b#1) < 0 /\ 4 * (IZR (b#0) * IZR (b#2)) - IZR (b#1) * IZR (b#1) <= 0)).
    { split; intros (A & C).
      - apply IZR_lt in A. apply IZR_le in C. rewrite !mult_IZR in C. split; lra.
      - split; [now apply lt_IZR | apply le_IZR]. rewrite !mult_IZR. lra. }
    rewrite G, D.
    assert (V : forall t, 0 < t < 1 -> VertexEdge.at_ratio
      (VertexEdge.Quadratic (IZR (b#0)) (IZR (b#1)) (IZR (b#2))) (t / (1 - t)) <= 0 <-> form_at b t <=
        0).
    { intros t T. destruct (length_3 b B) as (b0 & b1 & b2 & ->). unfold at_time. cbn [map nth].
      rewrite power_basis by lra.
      unfold VertexEdge.at_ratio. simpl VertexEdge.c0. simpl VertexEdge.c1. simpl VertexEdge.c2.
      set (r := t / (1 - t)). simpl length. assert (0 < (1 - t) ^ 2) by (apply pow_lt; lra).
      cbn [exact integers power_form]. split; intros; nra. }
    split; intros (t & T & H); exists t; split; auto; [split; [apply Always; lra | now apply V] | apply
      V; auto; apply H].
  - (* nowhere *)
    split; [easy |]. intros (t & T & A & _). apply Vanish in A; auto. unfold poly in A. simpl in A.
    destruct Tr as [| N]; [easy |]. simpl in N. apply not_0_IZR in N. exfalso. apply N. lra.
  - assert (Start : poly (a :: c :: l) 0 <> 0).
    { rewrite At. intros H.
      assert (N : Forall (fun f => without_end_roots f = []) fs).
      { eapply Forall_impl; [| exact H]. intros f Z. destruct (without_end_roots_start f); easy. }
      now apply Empty in N. }
    assert (Two : (2 <= length (a :: c :: l))%nat) by (simpl; lia).
    remember (a :: c :: l) as p eqn:Ep. clear Ep.
    rewrite existsb_exists. split.
    + intros (k & I & S).
      destruct (proj1 (Roots Tr Two Start (where_is finder k))) as (X & Z); [now exists k |].
      destruct (proj2 (VertexEdge.by_ratio (fun x => x = where_is finder k))) as (t & T & W); [now
        exists (where_is finder k) |].
      exists t. split; auto. split; [apply Vanish; auto; now rewrite W |].
      pose proof (Signs Tr Two Start (without_end_roots_trimmed b) k I) as Tell.
        rewrite <- W in Tell.
      apply (proj2 (inner_signs b t Nb T)) in Tell. destruct Tell as (C & R).
      destruct (sign_at_root finder (without_end_roots b) k); simpl in *; try easy; lra.
    + intros (t & T & A & H). apply Vanish in A; auto.
      destruct (proj2 (Roots Tr Two Start (t / (1 - t)))) as (k & I & W);
        [split; auto; apply Rdiv_lt_0_compat; lra |].
      exists k. split; auto.
      pose proof (Signs Tr Two Start (without_end_roots_trimmed b) k I) as Tell.
        rewrite W in Tell.
      apply (proj2 (inner_signs b t Nb T)) in Tell. destruct Tell as (C & R).
      destruct (sign_at_root finder (without_end_roots b) k); simpl in *; try easy; lra.
Qed.

(** contact(vertex_edge<integer>) *)
Definition contact (v e0 e1 : @moving_point integers) : bool :=
  let e := difference e1 e0 in
  let w := difference v e0 in
  let off_line := cross_form w e in
  let beyond := dot_form w (difference v e1) in
  touches [vx off_line; vy off_line; vz off_line] beyond.

Definition contact_meets (d : demands) (v e0 e1 : @moving_point integers) : Prop :=
  let off_line := cross_form (difference v e0) (difference e1 e0) in
  touches_meets d [vx off_line; vy off_line; vz off_line] (dot_form (difference v e0) (difference v e1)).

Theorem integer_contact_right v e0 e1 : contact_meets (promises finder) v e0 e1 -> contact v e0 e1 = true <->
  vertex_edge_collides (exact_motion v) (exact_motion e0) (exact_motion e1).
Proof.
  intros Valid. unfold contact. assert (D : forall q p : @moving_point integers, degree (difference q p) 1) by easy.
  rewrite touches_right by (exact Valid || (repeat constructor; auto) || exact B).
  assert (E : forall t, meets [vx (cross_form (difference v e0) (difference e1 e0)); vy (cross_form
    (difference v e0)
    (difference e1 e0)); vz (cross_form (difference v e0) (difference e1 e0))] (dot_form (difference v
      e0) (difference v e1)) t <->
    in_segment (place (exact_motion v) t) (place (exact_motion e0) t) (place (exact_motion e1) t)).
  { intros t. rewrite vertex_edge_contact. unfold vertex_edge_test, meets.
    destruct (cross_at (difference v e0) (difference e1 e0) 1 1 t (D _ _) (D _ _)) as (C & _).
    rewrite (proj1 (dot_at (difference v e0) (difference v e1) 1 1 t (D _ _) (D _ _))).
    rewrite !difference_at in *. rewrite <- C, !Forall_cons_iff. unfold vector_at, origin. split.
    - intros ((X & Y & Z & _) & P). split; auto. now apply same_point.
    - intros (X & P). apply point_eq in X. cbn [x y z] in X. repeat split; tauto || constructor. }
  split; intros (t & T & H); exists t; split; auto; now apply E.
Qed.

(** ** Contact at the border *)

(** touches_at_border: the query as given, and in integers. *)
Definition edge_contact (query : list given) (v e0 e1 : given) : bool :=
  let integer := to_integers query in
  negb (separated (given_motion v) (given_motion e0) (given_motion e1)) &&
  contact (integer v) (integer e0) (integer e1).
Definition face_border (v f0 f1 f2 : given) : bool :=
  let on := edge_contact [v; f0; f1; f2] in on v f0 f1 || on v f1 f2 || on v f2 f0.
Definition edges_border (a0 a1 b0 b1 : given) : bool :=
  let on := edge_contact [a0; a1; b0; b1] in on a0 b0 b1 || on a1 b0 b1 || on b0 a0 a1 || on b1 a0 a1.

Definition edge_contact_meets (d : demands) (query : list given) (v e0 e1 : given) : Prop :=
  let integer := to_integers query in contact_meets d (integer v) (integer e0) (integer e1).
Definition face_border_meets (d : demands) (v f0 f1 f2 : given) : Prop :=
  let on := edge_contact_meets d [v; f0; f1; f2] in on v f0 f1 /\ on v f1 f2 /\ on v f2 f0.
Definition edges_border_meets (d : demands) (a0 a1 b0 b1 : given) : Prop :=
  let on := edge_contact_meets d [a0; a1; b0; b1] in on a0 b0 b1 /\ on a1 b0 b1 /\ on b0 a0 a1 /\ on b1 a0 a1.

Lemma edge_contact_right query (v e0 e1 : given) : edge_contact_meets (promises finder) query v e0 e1 ->
  In v query -> In e0 query -> In e1 query ->
  edge_contact query v e0 e1 = true <->
  vertex_edge_collides (given_motion v) (given_motion e0) (given_motion e1).
Proof.
  intros Valid V E0 E1. destruct (to_integers_right query v V) as (K & Vi).
  destruct (to_integers_right query e0 E0) as (_ & E0i).
  destruct (to_integers_right query e1 E1) as (_ & E1i). unfold edge_contact, in_integers in *.
  rewrite andb_true_iff, negb_true_iff, (integer_contact_right _ _ _ Valid), Vi, E0i, E1i, (vertex_edge_units (unit_of
    query)) by exact K.
  split; [tauto |]. intros H. split; auto. destruct (separated _ _ _) eqn:P; auto.
  now apply separated_right in P.
Qed.
Theorem face_border_right (v f0 f1 f2 : given) : face_border_meets (promises finder) v f0 f1 f2 ->
  face_border v f0 f1 f2 = true <->
  face_border_collides (given_motion v) (given_motion f0) (given_motion f1) (given_motion f2).
Proof.
  intros (M0 & M1 & M2). unfold face_border, face_border_collides.
  rewrite !orb_true_iff, !edge_contact_right by (assumption || (simpl; auto)). tauto.
Qed.
Theorem edges_border_right (a0 a1 b0 b1 : given) : edges_border_meets (promises finder) a0 a1 b0 b1 ->
  edges_border a0 a1 b0 b1 = true <->
  edges_border_collides (given_motion a0) (given_motion a1) (given_motion b0) (given_motion b1).
Proof.
  intros (M0 & M1 & M2 & M3). unfold edges_border, edges_border_collides.
  rewrite !orb_true_iff, !edge_contact_right by (assumption || (simpl; auto)). tauto.
Qed.

Definition query_border_touched (edges : bool) := if edges then edges_border else face_border.
Definition query_border_meets (edges : bool) := if edges then edges_border_meets else face_border_meets.
Lemma query_border_right edges q0 q1 q2 q3 : query_border_meets edges (promises finder) q0 q1 q2 q3 ->
  query_border_touched edges q0 q1 q2 q3 = true <->
  query_border edges (given_motion q0) (given_motion q1) (given_motion q2) (given_motion q3).
Proof. destruct edges; [exact (edges_border_right q0 q1 q2 q3) | exact (face_border_right q0 q1 q2 q3)]. Qed.

End Contact.
