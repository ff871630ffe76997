(** The interval of the step in which floating point finds the first contact: `found` of `subdivide`
    (ccd/exact/static_filter/subdivision.hpp), over numbers that stand for control values as in Subdivision.v.
    Results:
        changes_sign_once_right   then Y has exactly one root in the interval, where it changes its sign
        part_found                if the answer is "collides", there is such an interval
        first_part_right          before it some G is negative wherever Y = 0, and in it all G are positive
        first_root_in_part        it has the first root of Y at which no G is negative; if Y has one root there, it
            is
                                  this one
        face_part_bracket, edges_part_bracket    the bracket of this root is that of the first contact *)

From Coq Require Import Reals Lia Lra Psatz List Bool.
From Errbound Require Import Sign Bernstein VertexEdge CubicRoots Subdivision Contact Separation FirstContact TimeBrackets.
Import ListNotations.
Open Scope R_scope.

(** ** One root *)

Lemma control_at_ends a b c d :
  control_at [a; b; c; d] 0 = a /\ control_at [a; b; c; d] 1 = d.
Proof. rewrite !control_cubic. simpl. split; ring. Qed.
Lemma once a b c d : a * d < 0 -> 0 < a * b \/ a * c < 0 ->
  exists r, 0 < r < 1 /\ control_at [a; b; c; d] r = 0 /\ forall t, 0 <= t <= 1 ->
    (t < r -> 0 < control_at [a; b; c; d] t * a) /\ (r < t -> control_at [a; b; c; d] t * a < 0).
Proof.
  intros Ends Inner. set (y := [a; 3 * b; 3 * c; d]).
  assert (E : forall t, control_at [a; b; c; d] t = at_ y t) by (intros t; apply control_cubic).
  assert (C : CubicRoots.count (inner_sign_changes y) = 1%nat /\
    CubicRoots.first (inner_sign_changes y) = sign_of_real a).
  { unfold y, inner_sign_changes. cbn [map].
    assert (I : 0 < a * (3 * b) \/ a * (3 * c) < 0) by lra. clear Inner E y.
    set (b' := 3 * b) in *. set (c' := 3 * c) in *. clearbody b' c'.
    cases_of_sign a; cases_of_sign d; try nra; cases_of_sign b'; cases_of_sign c'; try nra; cbn; auto. }
  destruct C as (C & F). destruct (one_change y eq_refl C) as (r & R0 & Z & Signs).
  exists r. split; auto. rewrite E. split; auto. rewrite F in Signs.
  assert (U : a = unit_of (sign_of_real a) * Rabs a /\ 0 < Rabs a).
  { split; [| apply Rabs_pos_lt; intros A; rewrite A in Ends; lra].
    destruct (Rtotal_order a 0) as [A | [A | A]].
    - rewrite (sign_negative a A), (Rabs_left a A). simpl. ring.
    - rewrite A in Ends. lra.
    - rewrite (sign_positive a A), (Rabs_pos_eq a) by lra. simpl. ring. }
  assert (Rel : forall t, control_at [a; b; c; d] t * a = unit_of (sign_of_real a) * at_ y t * Rabs a).
  { intros t. rewrite E. transitivity (at_ y t * (unit_of (sign_of_real a) * Rabs a)); [| ring].
    now rewrite <- (proj1 U). }
  destruct (control_at_ends a b c d) as (E0 & E1). intros t T.
  destruct (Req_dec t 0) as [-> | N0]; [split; [rewrite E0; intros; nra | lra] |].
  destruct (Req_dec t 1) as [-> | N1]; [split; [lra | rewrite E1; intros; lra] |].
  destruct (Signs t ltac:(lra)) as (Before & After). rewrite Rel. destruct U as (_ & U). split; intros L.
  - apply Rmult_lt_0_compat; auto.
  - specialize (After L). nra.
Qed.

Section Part.

Context {S : Type} (none : S) (midpoint : S -> S -> S).
Notation halves := (halves none midpoint).

(** The signs at the ends are certainly opposite. *)
Definition changes_sign_once (sign_of : S -> sign) (p : list S) : bool :=
  match p with
  | [a; b; c; d] =>
      match sign_of a with
      | positive => same_sign (sign_of b) positive || same_sign (sign_of c) negative
      | _ => same_sign (sign_of b) negative || same_sign (sign_of c) positive
      end
  | _ => false
  end.

Theorem changes_sign_once_right sign_of stands most i p P : reads midpoint sign_of stands most ->
  (i <= most)%nat -> length p = 4%nat -> Forall2 (stands i) p P ->
  changes_sign none sign_of p = true -> changes_sign_once sign_of p = true ->
  exists r, 0 < r < 1 /\ control_at P r = 0 /\ forall t, 0 <= t <= 1 ->
    (t < r -> 0 < control_at P t * control_at P 0) /\ (r < t -> control_at P t * control_at P 0 < 0).
Proof.
  intros Reads I L F Change Once. destruct p as [| a' [| b' [| c' [| d' [|]]]]]; try discriminate.
  inversion F as [| ? a ? ? A F1]. inversion F1 as [| ? b ? ? B F2]. inversion F2 as [| ? c ? ? C F3].
  inversion F3 as [| ? d ? ? D F4]. inversion F4. subst. clear F F1 F2 F3 F4.
  rewrite (proj1 (control_at_ends a b c d)). unfold changes_sign in Change. cbn [hd last] in Change.
  cbn [changes_sign_once] in Once.
  pose proof (reads_sign _ _ _ _ Reads i) as Sign.
  pose proof (Sign _ _ I A) as SA. pose proof (Sign _ _ I B) as SB. pose proof (Sign _ _ I C) as SC.
  pose proof (Sign _ _ I D) as SD. clear Sign A B C D.
  apply once.
  - destruct (sign_of a'), (sign_of d'); try discriminate; simpl in SA, SD; nra.
  - destruct (sign_of a'), (sign_of d'); try discriminate; apply orb_true_iff in Once;
      (destruct Once as [O | O]; [left; destruct (sign_of b'); try discriminate; simpl in SA, SB; nra |
         right; destruct (sign_of c'); try discriminate; simpl in SA, SC; nra]).
Qed.

(** ** The interval *)

Context (sign_y sign_g : S -> sign) (hopeless : nat -> list S -> bool).
Notation subdivide := (subdivide none midpoint sign_y sign_g hopeless).
Definition excluded (y : list S) (gs : list (list S)) : bool :=
  (above sign_y y || below sign_y y) || existsb (below sign_g) gs.
Definition certain_contact (y : list S) (gs : list (list S)) : bool :=
  changes_sign none sign_y y && forallb (above sign_g) gs.
Definition lefts (gs : list (list S)) := map (fun g => fst (halves g)) gs.
Definition rights (gs : list (list S)) := map (fun g => snd (halves g)) gs.

(** found: the interval from low to high, with Y's control values. *)
Inductive first_part : nat -> list S -> list (list S) -> R -> R -> list S -> Prop :=
  | whole_part n y gs : excluded y gs = false -> certain_contact y gs = true -> first_part n y gs 0 1 y
  | left_part n y gs low high p : excluded y gs = false -> certain_contact y gs = false ->
      first_part n (fst (halves y)) (lefts gs) low high p -> first_part (Datatypes.S n) y gs (low / 2) (high / 2) p
  | right_part n y gs low high p : excluded y gs = false -> certain_contact y gs = false ->
      subdivide n (fst (halves y)) (lefts gs) = separate ->
      first_part n (snd (halves y)) (rights gs) low high p ->
      first_part (Datatypes.S n) y gs ((1 + low) / 2) ((1 + high) / 2) p.

Theorem part_found n y gs : subdivide n y gs = collides -> exists low high p, first_part n y gs low high p.
Proof.
  revert y gs. induction n as [| n IH]; intros y gs; cbn [Subdivision.subdivide];
    fold (excluded y gs); fold (certain_contact y gs);
    destruct (excluded y gs) eqn:X; try discriminate; destruct (certain_contact y gs) eqn:C.
  1, 3: intros _; exists 0, 1, y; now constructor.
  - discriminate.
  - destruct (hopeless n y); try discriminate. fold (lefts gs) (rights gs).
    destruct (subdivide n (fst (halves y)) (lefts gs)) eqn:Left; try discriminate; intros H.
    + destruct (IH _ _ H) as (l & h & p & Q). do 3 eexists. now apply right_part; eauto.
    + destruct (IH _ _ Left) as (l & h & p & Q). do 3 eexists. now apply left_part; eauto.
Qed.

Context (stands_y stands_g : nat -> S -> R -> Prop) (max_y max_g : nat)
  (reads_y : reads midpoint sign_y stands_y max_y) (reads_g : reads midpoint sign_g stands_g max_g).

(** Y's control values on the interval, and facts about all G. *)
Definition part_is (Y : list R) (Gs : list (list R)) (low high : R) (p : list S) : Prop :=
  0 <= low < high /\ high <= 1 /\
  (forall t, 0 <= t <= low -> control_at Y t = 0 -> exists G, In G Gs /\ control_at G t < 0) /\
  (forall t G, low <= t <= high -> In G Gs -> 0 < control_at G t) /\
  length p = 4%nat /\ changes_sign none sign_y p = true /\
  exists i P, (i <= max_y)%nat /\ Forall2 (stands_y i) p P /\
    forall u, control_at P u = control_at Y (low + u * (high - low)).

Lemma ends_change i p P : (i <= max_y)%nat -> length p = 4%nat -> Forall2 (stands_y i) p P ->
  changes_sign none sign_y p = true -> control_at P 0 * control_at P 1 < 0.
Proof.
  intros I L F C. destruct p as [| a' [| b' [| c' [| d' [|]]]]]; try discriminate.
  inversion F as [| ? a ? ? A F1]. inversion F1 as [| ? b ? ? _ F2]. inversion F2 as [| ? c ? ? _ F3].
  inversion F3 as [| ? d ? ? D F4]. inversion F4. subst.
  destruct (control_at_ends a b c d) as (-> & ->).
  unfold changes_sign in C. simpl in C. apply (reads_sign _ _ _ _ reads_y i) in A, D; auto.
  destruct (sign_y a'), (sign_y d'); try discriminate; simpl in *; nra.
Qed.

Theorem first_part_right n y gs low high p : first_part n y gs low high p ->
  forall i j Y Gs, length y = 4%nat -> Forall2 (stands_y i) y Y -> quartics stands_g j gs Gs ->
  (i + 3 * n <= max_y)%nat -> (j + 4 * n <= max_g)%nat -> part_is Y Gs low high p.
Proof.
  intros Part. induction Part as [n y gs X C | n y gs low high p X C Part IH | n y gs low high p X C Left Part IH];
    intros i j Y Gs L F Q MY MG.
  - apply andb_prop in C. destruct C as (C & A).
    assert (E : forall u, control_at Y u = control_at Y (0 + u * (1 - 0))) by (intros u; f_equal; ring).
    split; [lra |]. split; [lra |]. split; [| split; [| split; [auto | split; [auto |]]]].
    + intros t T Z. exfalso. pose proof (ends_change i y Y ltac:(lia) L F C) as N. replace t with 0 in Z by lra.
      rewrite Z in N. lra.
    + intros t G T I. destruct (quartics_in stands_g j gs Gs Q) as (_ & Q2). destruct (Q2 G I) as (g & Ig & Lg & Fg).
      rewrite forallb_forall in A.
      exact (above_positive _ _ _ _ reads_g j g G t (or_intror Lg) ltac:(lia) Fg (A g Ig) T).
    + exists i, Y. split; [lia |]. split; auto.
  - assert (LY : length Y = 4%nat) by now rewrite <- (same_length F).
    destruct (halves_stand none _ _ _ _ reads_y i y Y (or_introl L) F) as (F0 & _ & L0 & _).
    rewrite L in *. cbn [Nat.sub] in F0.
    destruct (quartics_halves none _ _ _ _ reads_g j gs Gs Q) as (G0 & _).
    destruct (quartics_in stands_g j gs Gs Q) as (_ & Q2).
    assert (LG : forall G, In G Gs -> length G = 5%nat).
    { intros G IG. destruct (Q2 G IG) as (g & _ & Lg & Fg). now rewrite <- (same_length Fg). }
    destruct (IH _ _ _ _ L0 F0 G0 ltac:(lia) ltac:(lia)) as (O & H & Before & In_ & Lp & Cp & k & P & K & Fp & E).
    split; [lra |]. split; [lra |]. split; [| split; [| split; [auto | split; [auto |]]]].
    + intros t T Z. destruct (Before (2 * t)) as (f & I & N); [lra | |].
      { rewrite (proj1 (halves_cubic Y (2 * t) LY)). now replace (2 * t / 2) with t by field. }
      apply in_map_iff in I. destruct I as (G & <- & I). exists G. split; auto.
      rewrite (proj1 (halves_quartic G (2 * t) (LG G I))) in N. now replace (2 * t / 2) with t in N by field.
    + intros t G T I. replace t with (2 * t / 2) by field. rewrite <- (proj1 (halves_quartic G (2 * t) (LG G I))).
      apply In_; [lra |]. apply in_map_iff. eauto.
    + exists k, P. split; auto. split; auto. intros u. rewrite E, (proj1 (halves_cubic Y _ LY)). f_equal. field.
  - assert (LY : length Y = 4%nat) by now rewrite <- (same_length F).
    destruct (halves_stand none _ _ _ _ reads_y i y Y (or_introl L) F) as (F0 & F1 & L0 & L1).
    rewrite L in *. cbn [Nat.sub] in F0, F1.
    destruct (quartics_halves none _ _ _ _ reads_g j gs Gs Q) as (G0 & G1).
    destruct (quartics_in stands_g j gs Gs Q) as (_ & Q2).
    assert (LG : forall G, In G Gs -> length G = 5%nat).
    { intros G IG. destruct (Q2 G IG) as (g & _ & Lg & Fg). now rewrite <- (same_length Fg). }
    destruct (IH _ _ _ _ L1 F1 G1 ltac:(lia) ltac:(lia)) as (O & H & Before & In_ & Lp & Cp & k & P & K & Fp & E).
    split; [lra |]. split; [lra |]. split; [| split; [| split; [auto | split; [auto |]]]].
    + intros t T Z. destruct (Rle_or_lt t (1 / 2)) as [Half | Half].
      * destruct (subdivision_separate none midpoint sign_y sign_g hopeless stands_y stands_g max_y max_g reads_y reads_g
          n (i + 3) (j + 4) _ _ _ _ (2 * t) L0 F0 G0 ltac:(lia) ltac:(lia) Left) as (f & I & N); [lra | |].
        { rewrite (proj1 (halves_cubic Y (2 * t) LY)). now replace (2 * t / 2) with t by field. }
        apply in_map_iff in I. destruct I as (G & <- & I). exists G. split; auto.
        rewrite (proj1 (halves_quartic G (2 * t) (LG G I))) in N. now replace (2 * t / 2) with t in N by field.
      * destruct (Before (2 * t - 1)) as (f & I & N); [lra | |].
        { rewrite (proj1 (proj2 (halves_cubic Y (2 * t - 1) LY))).
          now replace ((1 + (2 * t - 1)) / 2) with t by field. }
        apply in_map_iff in I. destruct I as (G & <- & I). exists G. split; auto.
        rewrite (proj1 (proj2 (halves_quartic G (2 * t - 1) (LG G I)))) in N.
        now replace ((1 + (2 * t - 1)) / 2) with t in N by field.
    + intros t G T I. replace t with ((1 + (2 * t - 1)) / 2) by field.
      rewrite <- (proj1 (proj2 (halves_quartic G (2 * t - 1) (LG G I)))). apply In_; [lra |]. apply in_map_iff. eauto.
    + exists k, P. split; auto. split; auto. intros u. rewrite E, (proj1 (proj2 (halves_cubic Y _ LY))). f_equal. field.
Qed.

(** There is contact in the interval. If Y has one root there, the first contact is the root, at which Y changes its
    sign. *)
Theorem first_root_in_part Y Gs low high p : part_is Y Gs low high p ->
  (exists r, low < r < high /\ control_at Y r = 0 /\ forall G, In G Gs -> 0 < control_at G r) /\
  (changes_sign_once sign_y p = true -> exists r, low < r < high /\ control_at Y r = 0 /\
    (forall G, In G Gs -> 0 < control_at G r) /\
    (forall t, low <= t <= high -> (t < r -> 0 < control_at Y t * control_at Y low) /\
      (r < t -> control_at Y t * control_at Y low < 0)) /\
    (forall t, 0 <= t < r -> control_at Y t = 0 -> exists G, In G Gs /\ control_at G t < 0)).
Proof.
  intros (O & H & Before & In_ & Lp & Cp & k & P & K & Fp & E).
  pose proof (ends_change k p P K Lp Fp Cp) as Ends.
  assert (At : forall t, control_at Y t = control_at P ((t - low) / (high - low)))
    by (intros t; rewrite E; f_equal; field; lra).
  assert (E0 : control_at Y low = control_at P 0) by (rewrite E; f_equal; ring).
  assert (W : forall u, 0 < u < 1 -> low < low + u * (high - low) < high) by (intros u U; split; nra).
  split.
  - destruct (IVT_cor (control_at P) 0 1 (control_continuous P) Rle_0_1 ltac:(lra)) as (u & U & Z).
    assert (u <> 0) by (intros ->; rewrite Z in Ends; lra). assert (u <> 1) by (intros ->; rewrite Z in Ends; lra).
    exists (low + u * (high - low)). assert (0 < u < 1) by lra. split; [now apply W |].
    split; [now rewrite <- E |]. intros G I. apply In_; auto. specialize (W u ltac:(lra)). lra.
  - intros Once. destruct (changes_sign_once_right sign_y stands_y max_y k p P reads_y K Lp Fp Cp Once)
      as (u & U & Z & Signs).
    set (r := low + u * (high - low)). pose proof (W u U) as R0. fold r in R0. exists r. split; auto.
    split; [unfold r; now rewrite <- E |]. split; [intros G I; apply In_; auto; lra |].
    assert (Place : forall t, (t - low) / (high - low) * (high - low) = t - low) by (intros t; field; lra).
    assert (Part : forall t, low <= t <= high -> (t < r -> 0 < control_at Y t * control_at Y low) /\
      (r < t -> control_at Y t * control_at Y low < 0)).
    { intros t T. rewrite (At t), E0. specialize (Place t). set (w := (t - low) / (high - low)) in *.
      destruct (Signs w) as (A & B); [split; nra |]. unfold r. split; intros L; [apply A | apply B]; nra. }
    split; auto. intros t T Zt. destruct (Rle_or_lt t low) as [L | L]; [apply Before; auto; lra |].
    exfalso. destruct (Part t) as (A & _); [lra |]. specialize (A ltac:(lra)). rewrite Zt in A. lra.
Qed.

(** ** Contact *)

Variable double : R -> Prop.

(** Y and the G_i are k and l times the functions that are zero and not negative in contact. root_in_integers
    searches with exact signs; `before` is the sign of Y at low. *)
Lemma part_bracket (touches inside : R -> Prop) (y : R -> R) Y Gs k low high p before b :
  (forall t, touches t -> y t = 0 /\ forall G, In G Gs -> 0 <= control_at G t) ->
  (forall t, y t = 0 -> (forall G, In G Gs -> 0 < control_at G t) -> touches t) ->
  0 < k -> (forall t, control_at Y t = k * y t) -> part_is Y Gs low high p -> changes_sign_once sign_y p = true ->
  0 < before * y low -> search double y before low high b ->
  exists r, first touches r /\ low < r < high /\ holds_time double b r.
Proof.
  intros Necessary Sufficient K E Part Once Sign Search. pose proof Part as (O & H & _).
  destruct (proj2 (first_root_in_part Y Gs low high p Part) Once) as (r & R0 & Z & Pos & Signs & Before).
  assert (Y0 : forall t, control_at Y t = 0 -> y t = 0).
  { intros t Zt. rewrite E in Zt. apply Rmult_integral in Zt. destruct Zt; lra. }
  assert (Rel : forall t, control_at Y t * control_at Y low * (before * before) = k * k * (y t * before) * (before * y low))
    by (intros t; rewrite !E; ring).
  assert (B2 : 0 < before * before) by (assert (before <> 0) by (intros ->; lra); nra).
  assert (K2 : 0 < k * k) by nra.
  assert (Pm : forall t, 0 < control_at Y t * control_at Y low <-> 0 < y t * before).
  { intros t. specialize (Rel t). set (a := control_at Y t * control_at Y low) in *. set (c := y t * before) in *.
    set (d := before * y low) in *. assert (0 < k * k * d) by now apply Rmult_lt_0_compat.
    replace (k * k * c * d) with (k * k * d * c) in Rel by ring. clearbody a c d. split; intros Q; nra. }
  assert (Nm : forall t, control_at Y t * control_at Y low < 0 <-> y t * before < 0).
  { intros t. specialize (Rel t). set (a := control_at Y t * control_at Y low) in *. set (c := y t * before) in *.
    set (d := before * y low) in *. assert (0 < k * k * d) by now apply Rmult_lt_0_compat.
    replace (k * k * c * d) with (k * k * d * c) in Rel by ring. clearbody a c d. split; intros Q; nra. }
  exists r. split; [| split; auto].
  - split; [lra |]. split; [now apply Sufficient; auto |]. intros s Hs T. destruct (Necessary s T) as (Ys & G).
    destruct (Before s Hs) as (g & I & N); [rewrite E, Ys; ring |]. specialize (G g I). lra.
  - apply (search_only double y before low high r b Search R0).
    + intros t T Q. apply Pm in Q. destruct (Rtotal_order t r) as [L | [-> | L]]; auto; [rewrite Z in Q; lra |].
      destruct (Signs t ltac:(lra)) as (_ & A). specialize (A L). lra.
    + intros t T Q. apply Nm in Q. destruct (Rtotal_order t r) as [L | [-> | L]]; auto; [| rewrite Z in Q; lra].
      destruct (Signs t ltac:(lra)) as (A & _). specialize (A L). lra.
    + intros t T Zt. destruct (Rtotal_order t r) as [L | [-> | L]]; auto; destruct (Signs t ltac:(lra)) as (A & B);
        [specialize (A L) | specialize (B L)]; rewrite E, Zt in *; lra.
Qed.

Lemma query_part_bracket edges m0 m1 m2 m3 Y Gs k l low high p before b : 0 < k -> 0 < l ->
  (forall t, control_at Y t = k * query_y edges m0 m1 m2 m3 t) ->
  (forall t, map (fun G => control_at G t) Gs = map (Rmult l) (weights edges
     (side_b edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t))
     (side_c edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t))
     (side_p edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t)))) ->
  part_is Y Gs low high p -> changes_sign_once sign_y p = true -> 0 < before * query_y edges m0 m1 m2 m3 low ->
  search double (query_y edges m0 m1 m2 m3) before low high b ->
  exists r, first (query_touches edges m0 m1 m2 m3) r /\ low < r < high /\ holds_time double b r.
Proof.
  intros K L E W.
  assert (Scaled : forall (Q : R -> Prop) t, (forall w, Q (l * w) <-> Q w) -> (forall G, In G Gs ->
    Q (control_at G t)) <->
    Forall Q (weights edges (side_b edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t))
      (side_c edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t))
      (side_p edges minus (place m0 t) (place m1 t) (place m2 t) (place m3 t)))).
  { intros Q t Same. rewrite <- Forall_forall, <- (Forall_map (fun G => control_at G t)), W, Forall_map.
    split; apply Forall_impl; intros w; apply Same. }
  apply (part_bracket _ (query_inside_at edges m0 m1 m2 m3)) with (k := k); auto.
  - intros t T. destruct (query_conditions _ _ _ _ _ _ T) as (Yt & F). split; [exact Yt |].
    apply (Scaled (Rle 0)); [| exact F]. intros w. split; intros H; nra.
  - intros t Yt Pos. apply query_times. left. split; auto. apply query_inside_same, (Scaled (Rlt 0)); [| exact Pos].
    intros w. split; intros H; nra.
Qed.
Theorem face_part_bracket v f0 f1 f2 Y Gs k l low high p before b : 0 < k -> 0 < l ->
  (forall t, control_at Y t = k * face_y v f0 f1 f2 t) ->
  (forall t, map (fun G => control_at G t) Gs = map (Rmult l)
     (let B := minus (place f1 t) (place f0 t) in let C := minus (place f2 t) (place f0 t) in
      let P := minus (place v t) (place f0 t) in [weight_2 B C P; weight_1 B C P; weight_0 B C P])) ->
  part_is Y Gs low high p -> changes_sign_once sign_y p = true -> 0 < before * face_y v f0 f1 f2 low ->
  search double (face_y v f0 f1 f2) before low high b ->
  exists r, first (face_touches v f0 f1 f2) r /\ low < r < high /\ holds_time double b r.
Proof. exact (query_part_bracket false v f0 f1 f2 Y Gs k l low high p before b). Qed.
Theorem edges_part_bracket a0 a1 b0 b1 Y Gs k l low high p before b : 0 < k -> 0 < l ->
  (forall t, control_at Y t = k * edges_y a0 a1 b0 b1 t) ->
  (forall t, map (fun G => control_at G t) Gs = map (Rmult l)
     (let B := minus (place a1 t) (place a0 t) in let C := minus (place b1 t) (place b0 t) in
      let P := minus (place b0 t) (place a0 t) in
      [on_a B C P; square_normal B C - on_a B C P; on_b B C P; square_normal B C - on_b B C P])) ->
  part_is Y Gs low high p -> changes_sign_once sign_y p = true -> 0 < before * edges_y a0 a1 b0 b1 low ->
  search double (edges_y a0 a1 b0 b1) before low high b ->
  exists r, first (edges_touch a0 a1 b0 b1) r /\ low < r < high /\ holds_time double b r.
Proof. exact (query_part_bracket true a0 a1 b0 b1 Y Gs k l low high p before b). Qed.

End Part.
