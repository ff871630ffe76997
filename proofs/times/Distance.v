(** Distance of two closed features at one time, over the real numbers: the conditions of
    ccd/contact/feature_conditions.hpp are complete.

    Each condition means that two points of the features are within d: corners, a vertex and the interior of an edge,
    or the interiors of both features. Degenerate triangles and edges are included. D is d squared. Separation.v has
    times. Results:
        vertex_edge_within, face_within_union, edges_within_union   within d exactly if a condition holds
        vertex_edge_distance, face_distance, edges_distance         there is a least distance *)

From Coq Require Import Reals Lra Psatz List.
From Errbound Require Import Contact.
Import ListNotations.
Open Scope R_scope.

(** ** Conditions *)

(** Z = top - D weight. If the sides hold, the weight is positive. *)
Record condition := Condition { sides : Prop; top : R; weight : R }.
Definition excess (D : R) (c : condition) : R := top c - D * weight c.
Definition holds (D : R) (c : condition) : Prop := sides c /\ excess D c <= 0.
Definition well_formed (c : condition) : Prop := sides c -> 0 < weight c.

Definition corner_condition (v w : point) : condition := Condition True (dot (minus v w) (minus v w)) 1.
Definition edge_condition (v e0 e1 : point) : condition :=
  let W := minus v e0 in let E := minus e1 e0 in
  Condition (E <> origin /\ 0 <= dot W E /\ 0 <= dot (minus e1 v) E)
    (dot (cross E W) (cross E W)) (dot E E).
Definition face_condition (v f0 f1 f2 : point) : condition :=
  let B := minus f1 f0 in let C := minus f2 f0 in let P := minus v f0 in
  Condition (cross B C <> origin /\ 0 <= weight_2 B C P /\ 0 <= weight_1 B C P /\ 0 <= weight_0 B C P)
    (det B C P * det B C P) (square_normal B C).
Definition edges_condition (a0 a1 b0 b1 : point) : condition :=
  let B := minus a1 a0 in let C := minus b1 b0 in let P := minus b0 a0 in
  Condition (cross B C <> origin /\ 0 <= on_a B C P /\ 0 <= square_normal B C - on_a B C P /\
      0 <= on_b B C P /\ 0 <= square_normal B C - on_b B C P)
    (det B C P * det B C P) (square_normal B C).

(** distance_conditions *)
Definition vertex_edge_conditions (v e0 e1 : point) : list condition :=
  [corner_condition v e0; corner_condition v e1; edge_condition v e0 e1].
Definition face_conditions (v f0 f1 f2 : point) : list condition :=
  [corner_condition v f0; corner_condition v f1; corner_condition v f2;
   edge_condition v f0 f1; edge_condition v f1 f2; edge_condition v f2 f0; face_condition v f0 f1 f2].
Definition edges_conditions (a0 a1 b0 b1 : point) : list condition :=
  [corner_condition a0 b0; corner_condition a0 b1; corner_condition a1 b0; corner_condition a1 b1;
   edge_condition a0 b0 b1; edge_condition a1 b0 b1; edge_condition b0 a0 a1; edge_condition b1 a0 a1;
   edges_condition a0 a1 b0 b1].

(** ** Two closed features within d *)

Definition near (D : R) (p q : point) : Prop := dot (minus p q) (minus p q) <= D.
Definition vertex_edge_near (D : R) (v e0 e1 : point) : Prop := exists q, in_segment q e0 e1 /\ near D v q.
Definition face_near (D : R) (v f0 f1 f2 : point) : Prop := exists q, in_triangle q f0 f1 f2 /\ near D v q.
Definition edges_near (D : R) (a0 a1 b0 b1 : point) : Prop :=
  exists p q, in_segment p a0 a1 /\ in_segment q b0 b1 /\ near D p q.

Lemma square_nonnegative v : 0 <= dot v v.
Proof. unfold dot. nra. Qed.
Lemma near_sym D p q : near D p q -> near D q p.
Proof. unfold near. intros H. replace (dot _ _) with (dot (minus p q) (minus p q)) by (coordinates; ring). easy. Qed.
Lemma corner_holds D v w : holds D (corner_condition v w) <-> near D v w.
Proof.
  unfold holds, excess, near. cbn [sides top weight corner_condition].
  split; [intros (_ & H) | intros H; split; auto]; lra.
Qed.

Lemma edge_well_formed v e0 e1 : well_formed (edge_condition v e0 e1).
Proof. intros (N & _). cbn [weight edge_condition]. now apply square_positive. Qed.

(** |W - u E| squared *)
Lemma from_edge v e0 e1 u : let W := minus v e0 in let E := minus e1 e0 in
  dot (minus v (along e0 u E)) (minus v (along e0 u E)) = dot W W - 2 * u * dot W E + u * u * dot E E.
Proof. intros W E. unfold W, E. coordinates. ring. Qed.

Lemma vertex_edge_complete D v e0 e1 : vertex_edge_near D v e0 e1 ->
  Exists (holds D) (vertex_edge_conditions v e0 e1).
Proof.
  intros (q & (u & U & ->) & H). unfold near in H. rewrite from_edge in H.
  set (W := minus v e0) in *. set (E := minus e1 e0) in *.
  destruct (origin_dec E) as [O | N].
  { apply Exists_cons_hd, corner_holds. unfold near. fold W. rewrite O in H.
    replace (dot W origin) with 0 in H by (coordinates; ring).
    replace (dot origin origin) with 0 in H by (coordinates; ring). lra. }
  pose proof (square_positive _ N) as B.
  assert (E1 : dot (minus e1 v) E = dot E E - dot W E) by (unfold W, E; coordinates; ring).
  destruct (Rlt_or_le (dot W E) 0) as [A | A].
  { apply Exists_cons_hd, corner_holds. unfold near. fold W.
    assert (0 <= - (u * dot W E)) by nra. assert (0 <= u * u * dot E E) by (apply Rmult_le_pos; nra). lra. }
  destruct (Rlt_or_le (dot E E) (dot W E)) as [A1 | A1].
  { apply Exists_cons_tl, Exists_cons_hd, corner_holds. unfold near.
    replace (dot _ _) with (dot W W - 2 * dot W E + dot E E) by (unfold W, E; coordinates; ring).
    assert (0 <= (1 - u) * (2 * dot W E - dot E E * (1 + u))); [| lra].
    apply Rmult_le_pos; [lra |]. assert (dot E E * (1 + u) <= dot E E * 2) by (apply Rmult_le_compat_l; lra). lra. }
  apply Exists_cons_tl, Exists_cons_tl, Exists_cons_hd. split.
  { cbn [sides edge_condition]. fold W E. rewrite E1. repeat split; auto; lra. }
  unfold excess. cbn [top weight edge_condition]. fold W E.
  replace (dot (cross E W) (cross E W)) with (dot E E * dot W W - dot W E * dot W E)
    by (clearbody W E; coordinates; ring).
  assert (dot E E * (dot W W - 2 * u * dot W E + u * u * dot E E) <= dot E E * D) by (apply Rmult_le_compat_l; lra).
  assert (0 <= (dot W E - u * dot E E) * (dot W E - u * dot E E)) by apply Rle_0_sqr. lra.
Qed.
Lemma corner_near D v e0 e1 w : w = e0 \/ w = e1 -> near D v w -> vertex_edge_near D v e0 e1.
Proof.
  intros E H. exists w. split; auto. destruct E as [-> | ->]; [exists 0 | exists 1]; split; try lra;
    destruct e0, e1; coordinates; apply same_point; simpl; ring.
Qed.
Lemma edge_sound D v e0 e1 : holds D (edge_condition v e0 e1) -> vertex_edge_near D v e0 e1.
Proof.
  intros ((N & A & A1) & H). unfold excess in H. cbn [top weight edge_condition] in H. cbn in A1.
  set (W := minus v e0) in *. set (E := minus e1 e0) in *. pose proof (square_positive _ N) as B.
  replace (dot (minus e1 v) E) with (dot E E - dot W E) in A1 by (unfold W, E; coordinates; ring).
  exists (along e0 (dot W E / dot E E) E). split.
  - exists (dot W E / dot E E). split; [| easy]. split.
    + apply Rmult_le_pos; [easy | left; now apply Rinv_0_lt_compat].
    + apply Rmult_le_reg_r with (dot E E); auto. field_simplify; lra.
  - unfold near, E. rewrite from_edge. fold W E. apply Rmult_le_reg_r with (dot E E); auto.
    replace (dot (cross E W) (cross E W)) with (dot E E * dot W W - dot W E * dot W E) in H
      by (clearbody W E; coordinates; ring).
    field_simplify; lra.
Qed.

Theorem vertex_edge_within D v e0 e1 :
  vertex_edge_near D v e0 e1 <-> Exists (holds D) (vertex_edge_conditions v e0 e1).
Proof.
  split; [apply vertex_edge_complete |]. intros H. inversion_clear H as [? ? H' | ? ? H'].
  { apply corner_holds in H'. apply corner_near with e0; auto. }
  inversion_clear H' as [? ? H | ? ? H].
  { apply corner_holds in H. apply corner_near with e1; auto. }
  inversion_clear H as [? ? H' | ? ? H']; [now apply edge_sound | inversion H'].
Qed.

(** ** Interior of a face and interiors of both edges *)

(** P in the basis of the plane's two directions and its normal. *)
Lemma in_basis B C P : cross B C <> origin -> exists h k n,
  P = along (along (along origin h B) k C) n (cross B C) /\ h * square_normal B C = weight_1 B C P /\
  k * square_normal B C = weight_2 B C P /\ n * square_normal B C = det B C P.
Proof.
  intros N. apply square_positive in N. fold (square_normal B C) in N.
  exists (weight_1 B C P / square_normal B C), (weight_2 B C P / square_normal B C),
    (det B C P / square_normal B C).
  split; [| repeat split; field; lra].
  pose proof (decomposed B C P) as H. cbv zeta in H. apply point_eq in H.
  fold (square_normal B C) in H. set (n2 := square_normal B C) in *.
  set (a := weight_1 B C P) in *. set (b := weight_2 B C P) in *. set (d := det B C P) in *. clearbody n2 a b d.
  destruct (cross B C) as [c0 c1 c2]. unfold along, origin in *. cbn [x y z] in *. destruct H as (H0 & H1 & H2).
  apply same_point; cbn [x y z]; apply Rmult_eq_reg_r with n2; try lra; field_simplify; lra.
Qed.
Definition flat (a b : R) (B C : point) : R := dot (along (along origin a B) b C) (along (along origin a B) b C).
Lemma from_basis h k n u v B C : let P := along (along (along origin h B) k C) n (cross B C) in
  let X := along (along P (- u) B) (- v) C in
  dot X X = flat (h - u) (k - v) B C + n * n * square_normal B C.
Proof. cbv zeta. unfold flat, square_normal. destruct B, C. coordinates. ring. Qed.
Lemma flat_scaled l a b B C : flat (l * a) (l * b) B C = l * l * flat a b B C.
Proof. unfold flat. destruct B, C. coordinates. ring. Qed.
Lemma flat_nonnegative a b B C : 0 <= flat a b B C.
Proof. apply square_nonnegative. Qed.

(** From numbers >= 0 towards others: until the others are reached or one number becomes zero, all stay >= 0. *)
Definition between (l : R) (a : R * R) : R := fst a + l * (snd a - fst a).
Lemma leaving pairs : Forall (fun a => 0 <= fst a) pairs ->
  exists l, 0 <= l <= 1 /\ Forall (fun a => 0 <= between l a) pairs /\
    (l = 1 \/ Exists (fun a => between l a = 0) pairs).
Proof.
  intros F. induction F as [| (u, h) pairs U F (l & L & All & End)]; [exists 1; repeat split; auto; lra |].
  cbn [fst] in U. destruct (Rle_or_lt 0 (between l (u, h))) as [G | G].
  { exists l. split; auto. split; [constructor; auto |]. destruct End as [-> | E]; auto. }
  unfold between in G. cbn [fst snd] in G. assert (0 < u - h) by nra.
  exists (u / (u - h)). assert (Q : u / (u - h) * (u - h) = u) by (field; lra).
  assert (0 <= u / (u - h)) by (apply Rmult_le_pos; [lra | left; now apply Rinv_0_lt_compat]).
  assert (u / (u - h) < l) by (apply Rmult_lt_reg_r with (u - h); lra). split; [lra |]. split.
  - constructor; [unfold between; cbn [fst snd]; lra |]. rewrite Forall_forall in *. intros a I.
    specialize (F a I). specialize (All a I). unfold between in *. set (m := u / (u - h)) in *. nra.
  - right. apply Exists_cons_hd. unfold between. cbn [fst snd]. lra.
Qed.

(** Square of P - u B - w C. From (u, w) towards its least value, linear bounds hold until one becomes an equality. *)
Definition apart (P B C : point) (u w : R) : R :=
  dot (along (along P (- u) B) (- w) C) (along (along P (- u) B) (- w) C).
Definition bound_at (u w : R) (f : R * R * R) : R := let '(c, a, b) := f in c + a * u + b * w.
Lemma towards_least D B C P u w bounds : cross B C <> origin -> apart P B C u w <= D ->
  Forall (fun f => 0 <= bound_at u w f) bounds ->
  (exists h k, h * square_normal B C = weight_1 B C P /\ k * square_normal B C = weight_2 B C P /\
     Forall (fun f => 0 <= bound_at h k f) bounds /\ det B C P * det B C P <= D * square_normal B C) \/
  exists h k, Forall (fun f => 0 <= bound_at h k f) bounds /\ Exists (fun f => bound_at h k f = 0) bounds /\
    apart P B C h k <= D.
Proof.
  intros N H F. destruct (in_basis B C P N) as (h & k & n & EP & Eh & Ek & En).
  pose proof (square_positive _ N) as N2. fold (square_normal B C) in N2.
  assert (Apart : forall u w, apart P B C u w = flat (h - u) (k - w) B C + n * n * square_normal B C).
  { intros u' w'. unfold apart. rewrite EP. apply from_basis. }
  rewrite Apart in H. pose proof (flat_nonnegative (h - u) (k - w) B C) as Flat.
  destruct (leaving (map (fun f => (bound_at u w f, bound_at h k f)) bounds)) as (l & L & All & End);
    [now apply Forall_map |].
  assert (Move : forall f, between l (bound_at u w f, bound_at h k f) = bound_at (u + l * (h - u)) (w + l * (k - w)) f).
  { intros ((c, a), b). unfold between, bound_at. cbn [fst snd]. ring. }
  assert (All' : Forall (fun f => 0 <= bound_at (u + l * (h - u)) (w + l * (k - w)) f) bounds).
  { rewrite Forall_forall in *. intros f I. rewrite <- Move. apply All, in_map_iff. now exists f. }
  destruct End as [-> | End].
  - left. exists h, k. replace (u + 1 * (h - u)) with h in All' by ring. replace (w + 1 * (k - w)) with k in All' by ring.
    repeat split; auto. rewrite <- En.
    assert (n * n * square_normal B C * square_normal B C <= D * square_normal B C)
      by (apply Rmult_le_compat_r; lra). lra.
  - right. exists (u + l * (h - u)), (w + l * (k - w)). split; [exact All' |]. split.
    + apply Exists_exists in End. destruct End as (a & I & Z). apply in_map_iff in I. destruct I as (f & <- & I).
      apply Exists_exists. exists f. rewrite <- Move. auto.
    + rewrite Apart. replace (h - (u + l * (h - u))) with ((1 - l) * (h - u)) by ring.
      replace (k - (w + l * (k - w))) with ((1 - l) * (k - w)) by ring. rewrite flat_scaled.
      assert ((1 - l) * (1 - l) * flat (h - u) (k - w) B C <= 1 * flat (h - u) (k - w) B C)
        by (apply Rmult_le_compat_r; nra). lra.
Qed.

Lemma face_well_formed v f0 f1 f2 : well_formed (face_condition v f0 f1 f2).
Proof. intros (N & _). cbn [weight face_condition]. now apply square_positive. Qed.
Lemma edges_well_formed a0 a1 b0 b1 : well_formed (edges_condition a0 a1 b0 b1).
Proof. intros (N & _). cbn [weight edges_condition]. now apply square_positive. Qed.

Definition border_near (D : R) (v f0 f1 f2 : point) : Prop :=
  vertex_edge_near D v f0 f1 \/ vertex_edge_near D v f1 f2 \/ vertex_edge_near D v f2 f0.
Lemma border_point D v f0 f1 f2 u w : 0 <= u -> 0 <= w -> 0 <= 1 - u - w -> u = 0 \/ w = 0 \/ 1 - u - w = 0 ->
  near D v (along (along f0 u (minus f1 f0)) w (minus f2 f0)) -> border_near D v f0 f1 f2.
Proof.
  intros U W S Zero H. destruct Zero as [-> | [-> | Q]].
  - right. right. eexists. split; [| exact H]. exists (1 - w). split; [lra |].
    destruct f0, f2. coordinates. apply same_point; simpl; ring.
  - left. eexists. split; [| exact H]. exists u. split; [lra |].
    destruct f0, f1. coordinates. apply same_point; simpl; ring.
  - right. left. eexists. split; [| exact H]. exists w. split; [lra |].
    assert (E : u = 1 - w) by lra. rewrite E. destruct f0, f1, f2. coordinates. apply same_point; simpl; ring.
Qed.

Lemma face_complete D v f0 f1 f2 : face_near D v f0 f1 f2 ->
  holds D (face_condition v f0 f1 f2) \/ border_near D v f0 f1 f2.
Proof.
  intros (q & (u & w & U & W & S & ->) & H).
  set (B := minus f1 f0) in *. set (C := minus f2 f0) in *. set (P := minus v f0).
  destruct (origin_dec (cross B C)) as [O | N].
  { right. assert (T : in_triangle (along (along f0 u B) w C) f0 f1 f2) by (exists u, w; auto).
    apply face_at_a_time in T. destruct T as [(T & _) | T]; [easy |].
    destruct T as [T | [T | T]]; [left | right; left | right; right]; eexists; split; eauto. }
  assert (Square : forall u w, dot (minus v (along (along f0 u B) w C)) (minus v (along (along f0 u B) w C)) =
    apart P B C u w) by (intros u' w'; unfold apart, P; clearbody B C; coordinates; ring).
  unfold near in H. rewrite Square in H.
  destruct (towards_least D B C P u w [(0, 1, 0); (0, 0, 1); (1, -1, -1)] N H) as
    [(h & k & Eh & Ek & F & Y) | (h & k & F & Zero & A)];
    [repeat apply Forall_cons; try apply Forall_nil; cbn [bound_at]; lra | |];
    rewrite !Forall_cons_iff in F; cbn [bound_at] in F.
  - left. split; [| unfold excess; cbn [top weight face_condition]; fold B C P; lra].
    cbn [sides face_condition]. fold B C P. unfold weight_0. fold (square_normal B C). rewrite <- Eh, <- Ek.
    split; auto. apply square_positive in N. fold (square_normal B C) in N.
    assert (0 <= h * square_normal B C /\ 0 <= k * square_normal B C /\ 0 <= (1 - h - k) * square_normal B C)
      by (repeat split; apply Rmult_le_pos; lra). lra.
  - right. apply border_point with h k; try lra; [| unfold near; fold B C; now rewrite Square].
    rewrite !Exists_cons, Exists_nil in Zero. cbn [bound_at] in Zero.
    destruct Zero as [Z | [Z | [Z | []]]]; [left | right; left | right; right]; lra.
Qed.
Lemma face_sound D v f0 f1 f2 : holds D (face_condition v f0 f1 f2) -> face_near D v f0 f1 f2.
Proof.
  intros ((N & W2 & W1 & W0) & H). unfold excess in H. cbn [top weight face_condition] in H.
  set (B := minus f1 f0) in *. set (C := minus f2 f0) in *. set (P := minus v f0) in *.
  destruct (in_basis B C P N) as (h & k & n & EP & Eh & Ek & En).
  pose proof (square_positive _ N) as N2. fold (square_normal B C) in N2.
  unfold weight_0 in W0. fold (square_normal B C) in W0. rewrite <- Eh, <- Ek in W0. rewrite <- Eh in W1.
  rewrite <- Ek in W2. rewrite <- En in H.
  exists (along (along f0 h B) k C). split.
  - exists h, k. repeat split; [| |]; apply Rmult_le_reg_r with (square_normal B C); lra.
  - unfold near. replace (dot _ _) with (dot (along (along P (- h) B) (- k) C) (along (along P (- h) B) (- k) C))
      by (unfold P; clearbody B C; coordinates; ring).
    rewrite EP, from_basis. apply Rmult_le_reg_r with (square_normal B C); auto.
    replace (flat (h - h) (k - k) B C) with 0 by (unfold flat; coordinates; ring). lra.
Qed.
Lemma border_face D v f0 f1 f2 : border_near D v f0 f1 f2 -> face_near D v f0 f1 f2.
Proof.
  intros H. enough (exists q, face_border q f0 f1 f2 /\ near D v q) as (q & Q & K).
  { exists q. split; auto. apply face_at_a_time. now right. }
  unfold face_border. destruct H as [(q & S & K) | [(q & S & K) | (q & S & K)]]; eauto 6.
Qed.

Theorem face_within_union D v f0 f1 f2 :
  face_near D v f0 f1 f2 <-> Exists (holds D) (face_conditions v f0 f1 f2).
Proof.
  assert (Border : border_near D v f0 f1 f2 <-> Exists (holds D) (vertex_edge_conditions v f0 f1) \/
    Exists (holds D) (vertex_edge_conditions v f1 f2) \/ Exists (holds D) (vertex_edge_conditions v f2 f0))
    by (unfold border_near; now rewrite !vertex_edge_within).
  unfold face_conditions, vertex_edge_conditions in *. split.
  - intros H. apply face_complete in H. rewrite Border in H. rewrite !Exists_cons in *. tauto.
  - intros H. enough (holds D (face_condition v f0 f1 f2) \/ border_near D v f0 f1 f2) as [K | K];
      [now apply face_sound | now apply border_face |].
    rewrite Border. rewrite !Exists_cons in *. tauto.
Qed.

Definition edges_border_near (D : R) (a0 a1 b0 b1 : point) : Prop :=
  vertex_edge_near D a0 b0 b1 \/ vertex_edge_near D a1 b0 b1 \/
  vertex_edge_near D b0 a0 a1 \/ vertex_edge_near D b1 a0 a1.
Lemma edges_border_point D a0 a1 b0 b1 s t : 0 <= s -> 0 <= 1 - s -> 0 <= t -> 0 <= 1 - t ->
  s = 0 \/ 1 - s = 0 \/ t = 0 \/ 1 - t = 0 ->
  near D (along a0 s (minus a1 a0)) (along b0 t (minus b1 b0)) -> edges_border_near D a0 a1 b0 b1.
Proof.
  intros S S1 T T1 Zero H. unfold edges_border_near, vertex_edge_near.
  assert (At0 : forall p e, along p 0 e = p) by (intros p e; destruct p; coordinates; apply same_point; simpl; ring).
  assert (At1 : forall p q, along p 1 (minus q p) = q)
    by (intros p q; destruct q; coordinates; apply same_point; simpl; ring).
  destruct Zero as [-> | [E | [-> | E]]].
  - left. rewrite At0 in H. eexists. split; [| exact H]. exists t. split; [lra | easy].
  - right. left. replace s with 1 in H by lra. rewrite At1 in H. eexists. split; [| exact H].
    exists t. split; [lra | easy].
  - right. right. left. rewrite At0 in H. eexists. split; [| apply near_sym, H]. exists s. split; [lra | easy].
  - right. right. right. replace t with 1 in H by lra. rewrite At1 in H.
    eexists. split; [| apply near_sym, H]. exists s. split; [lra | easy].
Qed.

(** The difference of a point of one edge and a point of the other. *)
Lemma between_edges a0 a1 b0 b1 s t : let B := minus a1 a0 in let C := minus b1 b0 in
  let X := along (along (minus b0 a0) (- s) B) (- - t) C in
  dot (minus (along a0 s B) (along b0 t C)) (minus (along a0 s B) (along b0 t C)) = dot X X.
Proof. intros B C X. unfold X. clearbody B C. coordinates. ring. Qed.

(** Parallel edges: a pair of points can be shifted at equal distance until one edge ends. *)
Lemma parallel_near D a0 a1 b0 b1 : cross (minus a1 a0) (minus b1 b0) = origin ->
  edges_near D a0 a1 b0 b1 -> edges_border_near D a0 a1 b0 b1.
Proof.
  intros O (p & q & (s & S & ->) & (t & T & ->) & H).
  destruct (origin_dec (minus a1 a0)) as [OB | NB].
  { apply edges_border_point with 0 t; try lra. rewrite OB in *.
    replace (along a0 0 origin) with (along a0 s origin); auto. coordinates. apply same_point; simpl; ring. }
  destruct (parallel _ _ NB O) as (k & K).
  destruct (leaving [(s, s - k * t); (1 - s, 1 - (s - k * t)); (t, 0); (1 - t, 1)]) as (l & L & All & End).
  { repeat (apply Forall_cons; [cbn [fst]; lra |]). apply Forall_nil. }
  rewrite Forall_forall in All.
  pose proof (All _ (or_introl eq_refl)) as A0. pose proof (All _ (or_intror (or_introl eq_refl))) as A1.
  pose proof (All _ (or_intror (or_intror (or_introl eq_refl)))) as A2.
  pose proof (All _ (or_intror (or_intror (or_intror (or_introl eq_refl))))) as A3.
  unfold between in A0, A1, A2, A3. cbn [fst snd] in A0, A1, A2, A3.
  apply edges_border_point with (s - l * (k * t)) (t - l * t); try lra.
  - destruct End as [-> | End]; [right; right; left; ring |].
    rewrite !Exists_cons, Exists_nil in End. unfold between in End. cbn [fst snd] in End.
    destruct End as [E | [E | [E | [E | []]]]]; [left | right; left | right; right; left | right; right; right]; lra.
  - unfold near in *. rewrite between_edges in *. rewrite K in *. set (B := minus a1 a0) in *.
    set (P := minus b0 a0) in *. clearbody B P.
    replace (along (along P (- (s - l * (k * t))) B) (- - (t - l * t)) (along origin k B))
      with (along (along P (- s) B) (- - t) (along origin k B)); auto.
    coordinates. apply same_point; simpl; ring.
Qed.

Lemma edges_complete D a0 a1 b0 b1 : edges_near D a0 a1 b0 b1 ->
  holds D (edges_condition a0 a1 b0 b1) \/ edges_border_near D a0 a1 b0 b1.
Proof.
  intros H. destruct (origin_dec (cross (minus a1 a0) (minus b1 b0))) as [O | N];
    [right; now apply parallel_near |].
  destruct H as (p & q & (s & S & ->) & (t & T & ->) & H). unfold near in H. rewrite between_edges in H.
  set (B := minus a1 a0) in *. set (C := minus b1 b0) in *. set (P := minus b0 a0) in *.
  destruct (towards_least D B C P s (- t) [(0, 1, 0); (1, -1, 0); (0, 0, -1); (1, 0, 1)] N H) as
    [(h & k & Eh & Ek & F & Y) | (h & k & F & Zero & A)];
    [repeat apply Forall_cons; try apply Forall_nil; cbn [bound_at]; lra | |];
    rewrite !Forall_cons_iff in F; cbn [bound_at] in F.
  - left. split; [| unfold excess; cbn [top weight edges_condition]; fold B C P; lra].
    cbn [sides edges_condition]. fold B C P. split; auto. apply square_positive in N. fold (square_normal B C) in N.
    replace (on_b B C P) with (- weight_2 B C P) by (unfold on_b, weight_2, dot, cross; simpl; ring).
    unfold on_a. fold (weight_1 B C P). rewrite <- Eh, <- Ek. set (n2 := square_normal B C) in *.
    assert (0 <= h * n2 /\ 0 <= (1 - h) * n2 /\ 0 <= - k * n2 /\ 0 <= (1 + k) * n2)
      by (repeat split; apply Rmult_le_pos; lra). lra.
  - right. apply edges_border_point with h (- k); try lra.
    + rewrite !Exists_cons, Exists_nil in Zero. cbn [bound_at] in Zero.
      destruct Zero as [Z | [Z | [Z | [Z | []]]]]; [left | right; left | right; right; left | right; right; right]; lra.
    + unfold near. rewrite between_edges. fold B C P. now rewrite Ropp_involutive.
Qed.
Lemma edges_sound D a0 a1 b0 b1 : holds D (edges_condition a0 a1 b0 b1) -> edges_near D a0 a1 b0 b1.
Proof.
  intros ((N & A0 & A1 & B0 & B1) & H). unfold excess in H. cbn [top weight edges_condition] in H.
  destruct (in_basis _ _ (minus b0 a0) N) as (h & k & n & EP & Eh & Ek & En).
  pose proof (square_positive _ N) as N2. fold (square_normal (minus a1 a0) (minus b1 b0)) in N2.
  replace (on_b _ _ _) with (- weight_2 (minus a1 a0) (minus b1 b0) (minus b0 a0)) in B0, B1
    by (unfold on_b, weight_2, dot, cross; simpl; ring).
  unfold on_a in A0, A1. fold (weight_1 (minus a1 a0) (minus b1 b0) (minus b0 a0)) in A0, A1.
  rewrite <- Eh in A0, A1. rewrite <- Ek in B0, B1. rewrite <- En in H.
  set (n2 := square_normal (minus a1 a0) (minus b1 b0)) in *.
  exists (along a0 h (minus a1 a0)), (along b0 (- k) (minus b1 b0)).
  assert (In : forall u, 0 <= u * n2 -> 0 <= n2 - u * n2 -> 0 <= u <= 1)
    by (intros u U V; split; apply Rmult_le_reg_r with n2; lra).
  split; [exists h; split; auto |]. split; [exists (- k); split; auto; apply In; lra |].
  unfold near. rewrite between_edges, EP, from_basis. fold n2. apply Rmult_le_reg_r with n2; auto.
  replace (flat (h - h) (k - - - k) (minus a1 a0) (minus b1 b0)) with 0 by (unfold flat; coordinates; ring). lra.
Qed.
Lemma border_edges D a0 a1 b0 b1 : edges_border_near D a0 a1 b0 b1 -> edges_near D a0 a1 b0 b1.
Proof.
  assert (E0 : forall p q, in_segment p p q) by (intros p q; exists 0; split; [lra |]; destruct p; coordinates;
    apply same_point; simpl; ring).
  assert (E1 : forall p q, in_segment q p q) by (intros p q; exists 1; split; [lra |]; destruct q; coordinates;
    apply same_point; simpl; ring).
  intros [(q & S & K) | [(q & S & K) | [(q & S & K) | (q & S & K)]]];
    [exists a0, q | exists a1, q | exists q, b0 | exists q, b1]; auto using near_sym.
Qed.

Theorem edges_within_union D a0 a1 b0 b1 :
  edges_near D a0 a1 b0 b1 <-> Exists (holds D) (edges_conditions a0 a1 b0 b1).
Proof.
  assert (Border : edges_border_near D a0 a1 b0 b1 <-> Exists (holds D) (vertex_edge_conditions a0 b0 b1) \/
    Exists (holds D) (vertex_edge_conditions a1 b0 b1) \/ Exists (holds D) (vertex_edge_conditions b0 a0 a1) \/
    Exists (holds D) (vertex_edge_conditions b1 a0 a1))
    by (unfold edges_border_near; now rewrite !vertex_edge_within).
  assert (Sym : forall v w, holds D (corner_condition v w) <-> holds D (corner_condition w v))
    by (intros v w; rewrite !corner_holds; split; apply near_sym).
  unfold edges_conditions, vertex_edge_conditions in *. rewrite !Exists_cons in Border.
  rewrite (Sym b0 a0), (Sym b0 a1), (Sym b1 a0), (Sym b1 a1) in Border. clear Sym. rewrite !Exists_cons.
  split.
  - intros Q. apply edges_complete in Q. rewrite Border in Q. clear Border. tauto.
  - intros Q. enough (holds D (edges_condition a0 a1 b0 b1) \/ edges_border_near D a0 a1 b0 b1) as [K | K];
      [now apply edges_sound | now apply border_edges |].
    rewrite Border. clear Border. rewrite Exists_nil in *. tauto.
Qed.

(** ** The least distance *)

Definition distances (near : R -> Prop) (squared : R) : Prop :=
  0 <= squared /\ forall D, near D <-> squared <= D.

Lemma nearest conditions : Forall well_formed conditions ->
  (forall D, ~ Exists (holds D) conditions) \/
  exists m, forall D, Exists (holds D) conditions <-> m <= D.
Proof.
  intros F. induction F as [| c conditions W F IH].
  { left. intros D H. inversion H. }
  assert (One : (forall D, ~ holds D c) \/ exists m, forall D, holds D c <-> m <= D).
  { destruct (Classical_Prop.classic (sides c)) as [S | S]; [right | left; now intros D (H & _)].
    specialize (W S). exists (top c / weight c). intros D. unfold holds, excess.
    assert (E : top c = top c / weight c * weight c) by (field; lra).
    split; [intros (_ & H); apply Rmult_le_reg_r with (weight c); lra |].
    intros H. split; auto. apply (Rmult_le_compat_r (weight c)) in H; lra. }
  destruct One as [No | (m & M)], IH as [None | (n & N)].
  - left. intros D H. apply Exists_cons in H. firstorder.
  - right. exists n. intros D. rewrite Exists_cons, N. firstorder.
  - right. exists m. intros D. rewrite Exists_cons, M. firstorder.
  - right. exists (Rmin m n). intros D. rewrite Exists_cons, M, N. split.
    + pose proof (Rmin_l m n). pose proof (Rmin_r m n). lra.
    + unfold Rmin. destruct (Rle_dec m n); tauto.
Qed.
Lemma least_distance near conditions : Forall well_formed conditions ->
  (forall D, near D <-> Exists (holds D) conditions) -> (forall D, near D -> 0 <= D) -> (exists D, near D) ->
  exists m, distances near m.
Proof.
  intros F E Positive (D & H). destruct (nearest conditions F) as [None | (m & M)].
  { apply E, None in H. easy. }
  exists m. assert (Q : forall D, near D <-> m <= D) by (intros D'; now rewrite E). split; auto.
  apply Positive, Q. lra.
Qed.
(** If Z < 0, the points are nearer than d. *)
Lemma nearer near conditions m D c : distances near m -> (forall D, near D <-> Exists (holds D) conditions) ->
  In c conditions -> well_formed c -> sides c -> excess D c < 0 -> m < D.
Proof.
  intros (_ & M) E I W S H. specialize (W S). unfold excess in H.
  assert (Q : top c = top c / weight c * weight c) by (field; lra).
  assert (top c / weight c < D) by (apply Rmult_lt_reg_r with (weight c); lra).
  enough (m <= top c / weight c) by lra. apply M, E, Exists_exists. exists c. split; auto. split; auto.
  unfold excess. lra.
Qed.

Lemma corner_well_formed v w : well_formed (corner_condition v w).
Proof. intros _. cbn. lra. Qed.
Lemma vertex_edge_well_formed v e0 e1 : Forall well_formed (vertex_edge_conditions v e0 e1).
Proof. repeat constructor; auto using corner_well_formed, edge_well_formed. Qed.
Lemma all_face_well_formed v f0 f1 f2 : Forall well_formed (face_conditions v f0 f1 f2).
Proof.
  unfold face_conditions.
  repeat (apply Forall_cons; [auto using corner_well_formed, edge_well_formed, face_well_formed |]). apply Forall_nil.
Qed.
Lemma all_edges_well_formed a0 a1 b0 b1 : Forall well_formed (edges_conditions a0 a1 b0 b1).
Proof.
  unfold edges_conditions.
  repeat (apply Forall_cons; [auto using corner_well_formed, edge_well_formed, edges_well_formed |]). apply Forall_nil.
Qed.

Lemma near_positive D p q : near D p q -> 0 <= D.
Proof. unfold near. pose proof (square_nonnegative (minus p q)). lra. Qed.
Lemma near_itself p q : near (dot (minus p q) (minus p q)) p q.
Proof. unfold near. lra. Qed.

Theorem vertex_edge_distance v e0 e1 : exists m, distances (fun D => vertex_edge_near D v e0 e1) m.
Proof.
  apply least_distance with (vertex_edge_conditions v e0 e1); [apply vertex_edge_well_formed | | |].
  - intros D. apply vertex_edge_within.
  - intros D (q & _ & H). exact (near_positive _ _ _ H).
  - eexists. apply vertex_edge_within, Exists_cons_hd, corner_holds, near_itself.
Qed.
Theorem face_distance v f0 f1 f2 : exists m, distances (fun D => face_near D v f0 f1 f2) m.
Proof.
  apply least_distance with (face_conditions v f0 f1 f2); [apply all_face_well_formed | | |].
  - intros D. apply face_within_union.
  - intros D (q & _ & H). exact (near_positive _ _ _ H).
  - eexists. apply face_within_union, Exists_cons_hd, corner_holds, near_itself.
Qed.
Theorem edges_distance a0 a1 b0 b1 : exists m, distances (fun D => edges_near D a0 a1 b0 b1) m.
Proof.
  apply least_distance with (edges_conditions a0 a1 b0 b1); [apply all_edges_well_formed | | |].
  - intros D. apply edges_within_union.
  - intros D (p & q & _ & _ & H). exact (near_positive _ _ _ H).
  - eexists. apply edges_within_union, Exists_cons_hd, corner_holds, near_itself.
Qed.
