(** The floating-point stages of `exact` (ccd/exact/stages.cpp) for one query, from floats to contact: in double,
    rounded in any direction. The compiler computes constants to nearest. Results:
        halving_error_enough   `halving_error` covers the error of 12 halvings
        filter_face_separate, filter_face_collides, filter_edges_separate, filter_edges_collide
                               answers of the stages are right
        filter_bounded         if the filter is usable, no number of a form exceeds 2^900, far from overflow *)

From Coq Require Import Reals ZArith List Lia Lra Psatz Bool.
From Flocq Require Import Core Mult_error.
From Errbound Require Import Format ErrorCount CcdFilter.
From Errbound Require Sign Bernstein Contact Decisions Subdivision SeparatingAxis.
Import ListNotations.
Open Scope R_scope.

(** ** The forms: those of Decisions.v *)

Definition reals : Bernstein.scalar.
Proof.
  refine {| Bernstein.number := R; Bernstein.add := Rplus; Bernstein.sub := Rminus;
            Bernstein.mul := Rmult; Bernstein.opp := Ropp; Bernstein.whole := IZR;
            Bernstein.twice := fun x => 2 * x; Bernstein.normalized := fun p => p;
            Bernstein.sign_of := fun _ => Sign.uncertain; Bernstein.exact := fun x => x |}; auto.
  - intros p. exists 1. split; [lra |]. induction p as [| a p IH]; simpl; [easy |].
    now rewrite <- IH, Rmult_1_l.
  - easy.
Defined.
Definition exact_form (f : form) : list (Bernstein.number reals) := map exact f.
Definition exact_vector (v : vector) : @Decisions.vector_form reals :=
  Decisions.VectorForm (exact_form (x_ v)) (exact_form (y_ v)) (exact_form (z_ v)).
(** Vectors with n coefficients each. *)
Definition of_length (n : nat) (v : vector) : Prop :=
  length (x_ v) = n /\ length (y_ v) = n /\ length (z_ v) = n.

Lemma exact_times f g n : length g = S n -> (length f = 2%nat /\ n = 1%nat) \/ (length f = 3%nat /\
  (n = 1%nat \/ n = 2%nat)) ->
  exact_form (times f g) = @Bernstein.product reals (exact_form f) (exact_form g).
Proof.
  intros G L. destruct f as [| a [| b [| c [|]]]]; try (simpl in L; lia);
    destruct g as [| d [| e [| h [|]]]]; simpl in G, L; try lia; cbn;
    repeat (apply (f_equal2 (@cons R)); [ring |]); easy.
Qed.
Lemma exact_minus f g : length f = length g ->
  exact_form (minus f g) = @Decisions.minus_form reals (exact_form f) (exact_form g).
Proof.
  unfold minus, zip. revert g. induction f as [| a f IH]; intros [| b g] L; try discriminate; [easy |].
  injection L as L. cbn [length seq map exact_form Decisions.minus_form]. cbn. f_equal.
  rewrite <- seq_shift, !map_map. etransitivity; [| apply (IH g L)].
  unfold exact_form. rewrite map_map. now apply map_ext.
Qed.
Lemma exact_plus f g : length f = length g ->
  exact_form (plus f g) = @Decisions.plus_form reals (exact_form f) (exact_form g).
Proof.
  unfold plus, zip. revert g. induction f as [| a f IH]; intros [| b g] L; try discriminate; [easy |].
  injection L as L. cbn [length seq map exact_form Decisions.plus_form]. cbn. f_equal.
  rewrite <- seq_shift, !map_map. etransitivity; [| apply (IH g L)].
  unfold exact_form. rewrite map_map. now apply map_ext.
Qed.
Lemma exact_cross v w : of_length 2 v -> of_length 2 w ->
  exact_vector (cross v w) = Decisions.cross_form (exact_vector v) (exact_vector w) /\ of_length 3 (cross v w).
Proof.
  intros (A & B & C) (D & E & F). unfold exact_vector, Decisions.cross_form, cross, of_length. cbn [x_ y_ z_].
  unfold minus at 4 5 6. rewrite !zip_length, !times_length, A, B, C, D, E, F. split; [| auto].
  rewrite !exact_minus by (rewrite !times_length; congruence).
  rewrite !exact_times with (n := 1%nat) by auto. reflexivity.
Qed.
Lemma exact_dot v w n : of_length 3 v -> of_length (S n) w -> n = 1%nat \/ n = 2%nat ->
  exact_form (dot v w) = Decisions.dot_form (exact_vector v) (exact_vector w) /\ length (dot v w) = (3 + n)%nat.
Proof.
  intros (A & B & C) (D & E & F) N. unfold dot, Decisions.dot_form, exact_vector.
  cbn [Decisions.vx Decisions.vy Decisions.vz].
  split; [| unfold plus; rewrite !zip_length, !times_length, A, D; lia].
  rewrite !exact_plus by (unfold plus; rewrite ?zip_length, !times_length; congruence).
  rewrite !exact_times with (n := n) by auto. reflexivity.
Qed.

Section Query.

Context (q : query) (b_length : of_length 2 (b_ q)) (c_length : of_length 2 (c_ q)) (p_length : of_length 2 (p_ q)).
Notation b := (exact_vector (b_ q)).
Notation c := (exact_vector (c_ q)).
Notation p := (exact_vector (p_ q)).

Lemma exact_coplanarity : exact_form (coplanarity q) = Decisions.y_form b c p /\ length (coplanarity q) = 4%nat.
Proof.
  destruct (exact_cross _ _ b_length c_length) as (E & L). unfold coplanarity, normal.
  destruct (exact_dot _ _ 1 L p_length) as (F & K); auto. split; [rewrite F, E; reflexivity | exact K].
Qed.
Lemma exact_inside :
  map exact_form (vertex_face_inside q) = Decisions.inside_face_forms b c p /\
  map exact_form (edge_edge_inside q) = Decisions.inside_edges_forms b c p /\
  (forall f, In f (vertex_face_inside q) \/ In f (edge_edge_inside q) -> length f = 5%nat).
Proof.
  destruct (exact_cross _ _ b_length c_length) as (E & L).
  destruct (exact_cross _ _ b_length p_length) as (Ebp & Lbp).
  destruct (exact_cross _ _ p_length c_length) as (Epc & Lpc).
  destruct (exact_cross _ _ p_length b_length) as (Epb & Lpb).
  destruct (exact_dot _ _ 2 L L) as (F & K); auto. destruct (exact_dot _ _ 2 Lbp L) as (Fbp & Kbp); auto.
  destruct (exact_dot _ _ 2 Lpc L) as (Fpc & Kpc); auto. destruct (exact_dot _ _ 2 Lpb L) as (Fpb & Kpb); auto.
  rewrite E in F, Fbp, Fpc, Fpb. rewrite Ebp in Fbp. rewrite Epc in Fpc. rewrite Epb in Fpb.
  unfold vertex_face_inside, edge_edge_inside, normal, Decisions.inside_face_forms,
    Decisions.inside_edges_forms,
    Decisions.normal_squared. cbv zeta. cbn [map].
  assert (M : forall f g, length (minus f g) = length f) by (intros; apply zip_length).
  rewrite !exact_minus by (rewrite ?M; congruence). rewrite F, Fbp, Fpc, Fpb. repeat split.
  simpl. intros f H. repeat (destruct H as [H | H]; try contradiction; try (subst f; rewrite ?M; auto)).
Qed.

End Query.

(** The code's control values are times 3 and 12. *)
Lemma control_cubic f t : length f = 4%nat ->
  Subdivision.control_at (map exact (cubic f)) t = 3 * @Bernstein.at_time reals (exact_form f) t.
Proof.
  destruct f as [| g0 [| g1 [| g2 [| g3 [|]]]]]; try discriminate. intros _.
    cbn [cubic controlled length seq map nth at_].
  cbn [exact]. rewrite Subdivision.control_cubic. unfold Bernstein.at_time, exact_form. cbn. ring.
Qed.
Lemma control_quartic f t : length f = 5%nat ->
  Subdivision.control_at (map exact (quartic f)) t = 12 * @Bernstein.at_time reals (exact_form f) t.
Proof.
  destruct f as [| g0 [| g1 [| g2 [| g3 [| g4 [|]]]]]]; try discriminate. intros _.
    cbn [quartic controlled length seq map nth at_].
  cbn [exact]. rewrite Subdivision.control_quartic. unfold Bernstein.at_time, exact_form. cbn. ring.
Qed.

(** ** Halvings *)

Section Halvings.

Context (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation fl := (rnd p emin direction).
Notation flc := (rnd p emin nearest).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).

(** The code: halving_error, over counts. *)
Definition max_depth : nat := 12.
Definition none : error_count := {| magnitude := 0; error := 0; underflow := 0 |}.
Definition count_midpoint (a b : error_count) : error_count :=
  count_product p emin (count_sum p emin a b) {| magnitude := 1 / 2; error := 0; underflow := 0 |}.
Definition worst_error (l : list error_count) : R := fold_right (fun c m => Rmax (error c) m) 0 l.
Definition next_error (n : nat) (e : R) : R :=
  let c := repeat {| magnitude := 1; error := e; underflow := 0 |} (S n) in
  let both := Subdivision.halves none count_midpoint c in
  Rmax (worst_error (fst both)) (worst_error (snd both)).
Definition halving_error (n : nat) : R := Nat.iter max_depth (next_error n) 0.

Definition at_least (k : Z) (c : error_count) : Prop := 1 <= magnitude c /\ IZR k <= error c.

Lemma flc_whole k r : (0 <= k <= 1000000)%Z -> IZR k <= r -> IZR k <= flc r.
Proof.
  intros K L. apply flc_above; auto. rewrite <- (Rmult_1_r (IZR k)). change 1 with (bpow radix2 0).
  apply number_integer; [exact eq_refl | lia |]. change (2 ^ 53)%Z with 9007199254740992%Z. lia.
Qed.
Lemma rounded_whole k r : (0 <= k <= 1000000)%Z -> IZR k <= r -> IZR k <= rounded p emin r.
Proof.
  intros K L. apply flc_whole; auto. assert (0 <= IZR k) by now apply (IZR_le 0).
  assert (1 <= flc (1 + flc (16 * eps))).
  { apply (flc_whole 1); [lia |]. generalize (flc_whole 0 (16 * eps) ltac:(lia)) eps_tiny. lra. }
  apply Rle_trans with (r * 1); [lra |]. apply Rmult_le_compat_l; lra.
Qed.
Lemma midpoint_at_least k a b : (0 <= k <= 10000)%Z -> at_least k a -> at_least k b ->
  at_least (k + 2) (count_midpoint a b).
Proof.
  intros K (MA & EA) (MB & EB). unfold count_midpoint, at_least.
  set (s := count_sum p emin a b).
  assert (MS : 2 <= magnitude s).
  { apply (rounded_whole 2); [lia |]. apply (flc_whole 2); [lia | lra]. }
  assert (ES : IZR (2 * k + 2) <= error s).
  { apply (rounded_whole (2 * k + 2)); [lia |]. apply flc_whole; [lia |]. rewrite plus_IZR.
    apply Rplus_le_compat; [| exact MS]. apply flc_whole; [lia |]. rewrite mult_IZR. lra. }
  cbn [count_product magnitude error]. rewrite plus_IZR, mult_IZR in ES.
  assert (M : 1 <= rounded p emin (flc (magnitude s * (1 / 2)))).
  { apply (rounded_whole 1); [lia |]. apply (flc_whole 1); [lia | lra]. }
  split; [exact M |]. apply rounded_whole; [lia |]. apply flc_whole; [lia |]. rewrite plus_IZR.
  rewrite !Rmult_0_r, rnd_0, Rmult_0_l, rnd_0, Rplus_0_l, Rplus_0_r by auto with typeclass_instances.
  apply Rle_trans with (IZR (k + 1) + 1); [rewrite plus_IZR; lra |]. apply Rplus_le_compat; [| exact M].
  apply flc_whole; [lia |]. apply flc_whole; [lia |]. apply flc_whole; [lia |]. rewrite plus_IZR. lra.
Qed.
Lemma worst_error_covers c l : In c l -> error c <= worst_error l.
Proof.
  induction l as [| a l IH]; [easy |]. intros [-> | I]; cbn [worst_error fold_right].
  - apply Rmax_l.
  - apply Rle_trans with (1 := IH I). apply Rmax_r.
Qed.
Lemma next_error_enough n k e : n = 3%nat \/ n = 4%nat -> (0 <= k <= 9000)%Z -> IZR k <= e ->
  IZR (k + 2 * Z.of_nat n) <= next_error n e.
Proof.
  intros N K E. unfold next_error. eapply Rle_trans; [| apply Rmax_r].
  set (c := {| magnitude := 1; error := e; underflow := 0 |}).
  assert (C : at_least k c) by (split; simpl; lra).
  destruct N as [-> | ->].
  - set (d := count_midpoint c c). set (h := count_midpoint d d).
    assert (D : at_least (k + 2) d) by (apply midpoint_at_least; auto; lia).
    assert (H : at_least (k + 2 + 2) h) by (apply midpoint_at_least; auto; lia).
    apply Rle_trans with (error (count_midpoint h h)).
    + destruct (midpoint_at_least (k + 2 + 2) h h ltac:(lia) H H) as (_ & Q). apply Rle_trans with (2 := Q).
      apply IZR_le. lia.
    + apply worst_error_covers. left. reflexivity.
  - set (d := count_midpoint c c). set (h := count_midpoint d d). set (i := count_midpoint h h).
    assert (D : at_least (k + 2) d) by (apply midpoint_at_least; auto; lia).
    assert (H : at_least (k + 2 + 2) h) by (apply midpoint_at_least; auto; lia).
    assert (I : at_least (k + 2 + 2 + 2) i) by (apply midpoint_at_least; auto; lia).
    apply Rle_trans with (error (count_midpoint i i)).
    + destruct (midpoint_at_least (k + 2 + 2 + 2) i i ltac:(lia) I I) as (_ & Q). apply Rle_trans with (2 := Q).
      apply IZR_le. lia.
    + apply worst_error_covers. left. reflexivity.
Qed.
(** Each midpoint adds an error of eps times the largest value, and the constant has 2 eps. *)
Lemma halving_error_counts n : n = 3%nat \/ n = 4%nat -> IZR (2 * Z.of_nat (n * max_depth)) <= halving_error n.
Proof.
  intros N. unfold halving_error.
  assert (I : forall d, (d <= max_depth)%nat -> IZR (2 * Z.of_nat (n * d)) <= Nat.iter d (next_error n) 0).
  { induction d as [| d IH]; intros L; [rewrite Nat.mul_0_r; simpl; lra |].
    cbn [Nat.iter nat_rect]. fold (Nat.iter d (next_error n) 0). unfold max_depth in L.
    replace (2 * Z.of_nat (n * S d))%Z with (2 * Z.of_nat (n * d) + 2 * Z.of_nat n)%Z by lia.
    apply next_error_enough; auto; [destruct N; subst n; lia |]. apply IH. unfold max_depth. lia. }
  now apply I.
Qed.

(** The code: constants_of's third constant, and the errors of whole_step. *)
Definition halvings (n : nat) : R := relative (halving_error n).
Definition size_of (l : list R) : R := fold_right (fun a m => Rmax (Rabs a) m) 0 l.
Definition error_of_parts (bound largest : R) (n : nat) : R := fl (bound + fl (largest * halvings n)).

Lemma flc_le r s : r <= s -> flc r <= flc s.
Proof. apply rnd_le; auto with typeclass_instances. Qed.
Lemma halvings_enough n : n = 3%nat \/ n = 4%nat -> INR (n * max_depth) * eps <= 0.51 * halvings n.
Proof.
  intros N. pose proof (halving_error_counts n N) as H. generalize eps_tiny slack_enough. intros P S.
  set (k := IZR (2 * Z.of_nat (n * max_depth))) in *.
  assert (K : 1 <= k <= 200).
  { unfold k, max_depth. destruct N as [-> | ->]; simpl; lra. }
  assert (E : relative k <= halvings n).
  { unfold halvings, relative. apply flc_le, Rmult_le_compat_r; [lra |]. apply flc_le, Rmult_le_compat_l; lra. }
  destruct (relative_enough k 8) as (Lo & _); [right; lra | simpl; lra | lia |].
  assert (I : INR (n * max_depth) = k / 2).
  { unfold k. rewrite INR_IZR_INZ, mult_IZR. field. }
  assert (0 <= k * eps) by (apply Rmult_le_pos; lra). rewrite I. lra.
Qed.

(** Numbers of the code that stand for x after i midpoints, with sizes of at most M. *)
Definition stands (M E : R) (i : nat) (a r : R) : Prop :=
  number a /\ Rabs a <= M /\ Rabs (a - r) <= E + INR i * (eps * M + eta).
Definition midpoint (a b : R) : R := fl (fl (a + b) * (1 / 2)).
Definition certain (error a : R) : Sign.sign :=
  if Rlt_bool error a then Sign.positive else if Rlt_bool a (- error) then Sign.negative else Sign.uncertain.

Lemma midpoint_stands M E i a b r s : number M -> 0 <= M -> stands M E i a r -> stands M E i b s ->
  stands M E (S i) (midpoint a b) (Subdivision.exact_midpoint r s).
Proof.
  intros NM PM (Na & La & Ea) (Nb & Lb & Eb). unfold midpoint, Subdivision.exact_midpoint.
  generalize eps_tiny (eta_positive emin). intros P Q. pose proof (Rabs_triang a b) as T.
  assert (N2 : number (2 * M)).
  { replace (2 * M) with (M * bpow radix2 1) by (change (bpow radix2 1) with 2; ring).
    apply mult_bpow_pos_exact_FLT; [exact NM | lia]. }
  assert (L : Rabs (fl (a + b)) <= 2 * M) by (apply rnd_abs_below; auto with typeclass_instances; lra).
  assert (S1 : Rabs (fl (a + b) - (a + b)) <= 2 * (eps * M)).
  { apply Rle_trans with (1 := sum_error p emin direction eps eta (any_error direction) a b Na Nb).
    apply Rle_trans with (eps * (2 * M)); [apply Rmult_le_compat_l; lra | lra]. }
  set (c := fl (a + b)) in *.
  assert (S2 : Rabs (fl (c * (1 / 2)) - c * (1 / 2)) <= eta).
  { replace (1 / 2) with (bpow radix2 (-1)) by (change (bpow radix2 (-1)) with (/ 2); field).
    apply (scale_error p emin direction eps eta (any_error direction)).
    apply rnd_number; auto with typeclass_instances. }
  split; [apply rnd_number; auto with typeclass_instances |]. split.
  - apply rnd_abs_below; auto with typeclass_instances. rewrite Rabs_mult, (Rabs_pos_eq (1 / 2)) by lra. lra.
  - rewrite S_INR. apply Rabs_le_inv in S1, S2, Ea, Eb. apply Rabs_le. lra.
Qed.
Lemma stands_read M E error most : number M -> 0 <= M -> E + INR most * (eps * M + eta) <= error ->
  Subdivision.reads midpoint (certain error) (stands M E) most.
Proof.
  intros NM PM H. generalize eps_tiny (eta_positive emin). intros P Q.
  assert (PE : 0 <= eps * M + eta) by (assert (0 <= eps * M) by (apply Rmult_le_pos; lra); lra).
  assert (More : forall i j, (i <= j)%nat -> INR i * (eps * M + eta) <= INR j * (eps * M + eta)).
  { intros i j L. apply Rmult_le_compat_r; auto. now apply le_INR. }
  split.
  - intros i j a r L (A & B & C). specialize (More i j L). repeat split; auto. lra.
  - intros i a b r s. now apply midpoint_stands.
  - intros i a r L (_ & _ & C). specialize (More i most L). apply Rabs_le_inv in C. unfold certain.
    destruct (Rlt_bool_spec error a); [simpl; lra |]. destruct (Rlt_bool_spec a (- error)); simpl; [lra | easy].
Qed.

(** halving_error: the error of all subintervals covers E, that of the whole step, and 12 halvings. *)
Theorem halving_error_enough E bound largest n : n = 3%nat \/ n = 4%nat ->
  number bound -> number largest -> 0 <= largest -> 0 <= E -> E + tiny / 1000 <= bound * (1 - eps) ->
  E + INR (n * max_depth) * (eps * largest + eta) <= error_of_parts bound largest n.
Proof.
  intros N NB NL PL PE B. generalize eps_tiny (eta_positive emin). intros P Q.
  pose proof (halvings_enough n N) as H.
  assert (K : 0 <= INR (n * max_depth) <= 48).
  { split; [apply pos_INR |]. destruct N as [-> | ->]; simpl; lra. }
  assert (Small : 50 * eta <= tiny / 1000).
  { apply Rmult_le_reg_r with 1000; [lra |]. unfold Rdiv. rewrite (Rmult_assoc tiny), Rinv_l, Rmult_1_r by lra.
    apply Rle_trans with (bpow radix2 20 * eta).
    - replace (50 * eta * 1000) with (50000 * eta) by ring. apply Rmult_le_compat_r; [lra | simpl; lra].
    - unfold tiny, Format.eta. rewrite <- bpow_plus. apply bpow_le. lia. }
  assert (PH : 0 <= halvings n) by (assert (0 <= INR (n * max_depth) * eps) by (apply Rmult_le_pos; lra); lra).
  assert (PD : 0 <= largest * halvings n) by now apply Rmult_le_pos.
  assert (PB : 0 <= bound) by (apply Rmult_le_reg_r with (1 - eps); lra).
  pose proof (rnd_lower p emin direction eps eta (any_error direction) _ PD) as L1.
  assert (N1 : number (fl (largest * halvings n))) by (apply rnd_number; auto with typeclass_instances).
  assert (P1 : 0 <= fl (largest * halvings n)) by (apply rnd_nonnegative; auto with typeclass_instances).
  pose proof (sum_relative p emin direction eps eta (any_error direction) _ _ NB N1 PB P1) as L2.
  fold (error_of_parts bound largest n) in L2. set (d := fl (largest * halvings n)) in *.
  assert (D : INR (n * max_depth) * (eps * largest) <= 0.51 * (largest * halvings n)).
  { replace (INR (n * max_depth) * (eps * largest)) with (INR (n * max_depth) * eps * largest) by ring.
    replace (0.51 * (largest * halvings n)) with (0.51 * halvings n * largest) by ring.
    now apply Rmult_le_compat_r. }
  assert (INR (n * max_depth) * eta <= 48 * eta) by (apply Rmult_le_compat_r; lra).
  assert (0.9 * (largest * halvings n) - 1.1 * eta <= d * (1 - eps)) by nra.
  lra.
Qed.

End Halvings.

(** ** The stages *)

Section Stages.

Context (direction : R -> Z) {direction_valid : Valid_rnd direction}.
Notation fl := (rnd p emin direction).
Notation number := (number p emin).
Notation eps := (eps p).
Notation eta := (eta emin).
Notation value := (value p emin direction).
Notation W := largest_difference.
Notation midpoint := (midpoint direction).
Notation subdivide := (Subdivision.subdivide 0 midpoint).
Notation sides_of := (SeparatingAxis.differences -> SeparatingAxis.axis -> bool -> bool * bool).
Notation differences_of := (SeparatingAxis.differences_of direction).

(** sizes *)
Definition largest (coordinate : Contact.point -> R) (d : SeparatingAxis.differences) : R :=
  fold_left (fun m v => Rmax m (Rabs (coordinate v)))
    [SeparatingAxis.b d true; SeparatingAxis.c d false; SeparatingAxis.c d true; SeparatingAxis.p_ d false; SeparatingAxis.p_ d true]
    (Rabs (coordinate (SeparatingAxis.b d false))).
Definition sizes (d : SeparatingAxis.differences) : Contact.point :=
  Contact.Point (largest Contact.x d) (largest Contact.y d) (largest Contact.z d).
Definition usable (m : Contact.point) : bool :=
  Rle_bool (Rmax (Rmax (Contact.x m) (Contact.y m)) (Contact.z m)) W.

(** The forms' differences, from points and a bound on their sizes. *)
Definition moving_difference (m : Contact.point) (q r : Contact.moving) : vector :=
  let of coordinate size :=
    [Difference (coordinate (Contact.start q)) (coordinate (Contact.start r)) size;
     Difference (coordinate (Contact.finish q)) (coordinate (Contact.finish r)) size] in
  {| x_ := of Contact.x (Contact.x m); y_ := of Contact.y (Contact.y m); z_ := of Contact.z (Contact.z m) |}.

Definition within_error (error : R) (l : list R) : bool := Rle_bool (size_of l) error.
(** patient_depth is 3. *)
Definition hopeless (error : R) (more : nat) (y : list R) : bool :=
  (3 <=? max_depth - S more)%nat && within_error error y.

(** axes_to_subdivision after its comparison of coordinates (`packs_separated_by_coordinates`): `sides` is separated's, b
    to p the ends and starts of the differences. *)
Definition filter (sides : sides_of) (inside : query -> list form)
    (b_end b_start c_end c_start p_end p_start : Contact.moving) : Subdivision.outcome :=
  let d := differences_of b_end b_start c_end c_start p_end p_start in
  let m := sizes d in
  let mx := Contact.x m in let my := Contact.y m in let mz := Contact.z m in
  let q := {| b_ := moving_difference m b_end b_start; c_ := moving_difference m c_end c_start;
              p_ := moving_difference m p_end p_start |} in
  let y := map value (cubic (coplanarity q)) in
  let y_error := error_of_y direction mx my mz in
  let gs := map (fun f => map value (quartic f)) (inside q) in
  let largest_g := fold_right (fun g m => Rmax (size_of g) m) 0 gs in
  let y_errors := error_of_parts direction y_error (size_of y) 3 in
  let g_errors := error_of_parts direction (error_of_g direction inside mx my mz) largest_g 4 in
  if negb (usable m) then Subdivision.undecided
  else if SeparatingAxis.separated (sides d) (SeparatingAxis.coordinate_axes mx my mz) then Subdivision.separate
  else if Subdivision.above (certain y_error) y || Subdivision.below (certain y_error) y then
    Subdivision.separate
  else if SeparatingAxis.separated (sides d) (SeparatingAxis.diagonal_axes direction mx my mz) then Subdivision.separate
  else if existsb (Subdivision.below (certain g_errors)) gs then Subdivision.separate
  else subdivide (certain y_errors) (certain g_errors) (hopeless y_errors) max_depth y gs.

Definition filter_face (v f0 f1 f2 : Contact.moving) : Subdivision.outcome :=
  filter (SeparatingAxis.face_sides direction) vertex_face_inside f1 f0 f2 f0 v f0.
Definition filter_edges (a0 a1 b0 b1 : Contact.moving) : Subdivision.outcome :=
  filter (SeparatingAxis.edge_sides direction) edge_edge_inside a1 a0 b1 b0 b0 a0.

(** ** Control values and the numbers that they stand for *)

Lemma size_of_bounds l : Forall number l ->
  number (size_of l) /\ 0 <= size_of l /\ forall a, In a l -> Rabs a <= size_of l.
Proof.
  intros F. induction F as [| a l A F (IH1 & IH2 & IH3)]; cbn [size_of fold_right].
  - split; [apply number_0 | split; [lra | easy]].
  - fold (size_of l). split; [| split].
    + unfold Rmax. destruct Rle_dec; auto. now apply number_abs.
    + apply Rle_trans with (1 := IH2), Rmax_r.
    + intros b [<- | I]; [apply Rmax_l | apply Rle_trans with (1 := IH3 b I), Rmax_r].
Qed.
Lemma largest_size gs : Forall (Forall number) gs ->
  let m := fold_right (fun g m => Rmax (size_of g) m) 0 gs in
  number m /\ 0 <= m /\ forall g a, In g gs -> In a g -> Rabs a <= m.
Proof.
  intros F. induction F as [| g gs G F (IH1 & IH2 & IH3)]; cbn zeta; cbn [fold_right].
  - split; [apply number_0 | split; [lra | easy]].
  - destruct (size_of_bounds g G) as (N & P & B). split; [| split].
    + unfold Rmax. now destruct Rle_dec.
    + apply Rle_trans with (1 := IH2), Rmax_r.
    + intros f a [<- | I] J; [apply Rle_trans with (1 := B a J), Rmax_l |
                              apply Rle_trans with (1 := IH3 f a I J), Rmax_r].
Qed.
Lemma values_stand M E l : Forall (fun e => number (value e) /\ Rabs (value e) <= M /\
    Rabs (value e - exact e) <= E) l ->
  Forall2 (stands M E 0) (map value l) (map exact l).
Proof.
  intros F. induction F as [| e l (N & B & D) F IH]; constructor; auto. split; [| split]; auto.
  simpl INR. lra.
Qed.
(** If the assumed error is at least the real one, signs are right without a halving. *)
Lemma signs_read M E error : number M -> 0 <= M -> E <= error ->
  Subdivision.reads midpoint (certain error) (stands M E) 0.
Proof. intros N P L. apply stands_read; auto. simpl INR. lra. Qed.

Section Query.

Context (q : query) (mx my mz : R) (b_moving : moving direction mx my mz (b_ q))
  (c_moving : moving direction mx my mz (c_ q)) (p_moving : moving direction mx my mz (p_ q))
  (inside : query -> list form).
Notation g_error := (error_of_g direction inside mx my mz).
Context (inside_fits : inside_fit direction mx my mz (inside q)) (inside_error : forall f e, In f (inside q) -> In e
    (quartic f) -> Rabs (value e - exact e) + tiny / 1000 <= g_error * (1 - eps)) (inside_some : inside q <> []).

Notation y := (map value (cubic (coplanarity q))).
Notation Y := (map exact (cubic (coplanarity q))).
Notation gs := (map (fun f => map value (quartic f)) (inside q)).
Notation Gs := (map (fun f => map exact (quartic f)) (inside q)).
Notation y_error := (error_of_y direction mx my mz).
Notation largest_g := (fold_right (fun g m => Rmax (size_of g) m) 0 gs).
Notation y_errors := (error_of_parts direction y_error (size_of y) 3).
Notation g_errors := (error_of_parts direction g_error largest_g 4).
Definition own_error (bound : R) : R := bound * (1 - eps) - tiny / 1000.

Lemma cubic_numbers e : In e (cubic (coplanarity q)) -> number (value e).
Proof.
  intros I. pose proof (cubic_fits direction mx my mz q b_moving c_moving p_moving) as F.
  apply (proj1 (Forall_forall _ _) F) in I. destruct I as (A & _). exact (value_number p emin direction W e A).
Qed.
Lemma quartic_numbers f e : In f (inside q) -> In e (quartic f) -> number (value e).
Proof.
  intros I J. pose proof (quartic_fits direction mx my mz _ f inside_fits I) as F.
  apply (proj1 (Forall_forall _ _) F) in J. destruct J as (A & _). exact (value_number p emin direction W e A).
Qed.
Lemma own_error_nonnegative bound e : Rabs (value e - exact e) + tiny / 1000 <= bound * (1 - eps) ->
  Rabs (value e - exact e) <= own_error bound /\ 0 <= own_error bound <= bound.
Proof.
  intros H. unfold own_error. generalize eps_tiny (Rabs_pos (value e - exact e)). intros P Q.
  assert (0 < tiny) by apply bpow_gt_0.
  assert (0 <= bound) by (apply Rmult_le_reg_r with (1 - eps); lra).
  assert (0 <= bound * eps) by (apply Rmult_le_pos; lra). lra.
Qed.

Lemma y_stands : length y = 4%nat /\ Forall2 (stands (size_of y) (own_error y_error) 0) y Y.
Proof.
  split; [reflexivity |]. apply values_stand, Forall_forall. intros e I.
  split; [now apply cubic_numbers |]. split.
  - apply size_of_bounds; [| now apply in_map]. apply Forall_map, Forall_forall. exact cubic_numbers.
  - apply own_error_nonnegative. now apply error_of_y_sound with (q := q).
Qed.
Lemma y_bounds : number (size_of y) /\ 0 <= size_of y /\ 0 <= own_error y_error <= y_error.
Proof.
  destruct (size_of_bounds y) as (N & P & _).
  { apply Forall_map, Forall_forall. exact cubic_numbers. }
  split; [easy |]. split; [easy |].
  apply (own_error_nonnegative y_error (at_ (cubic (coplanarity q)) 0)).
  apply error_of_y_sound with (q := q); auto. now left.
Qed.
Lemma y_reads : Subdivision.reads midpoint (certain y_error) (stands (size_of y) (own_error y_error)) 0.
Proof. destruct y_bounds as (N & P & E). apply signs_read; [exact N | exact P | apply E]. Qed.
Lemma y_parts_read : Subdivision.reads midpoint (certain y_errors) (stands (size_of y) (own_error y_error))
  (3 * max_depth).
Proof.
  destruct y_bounds as (N & P & E). apply stands_read; auto.
  apply halving_error_enough; auto; try lra.
  - apply rnd_number; auto with typeclass_instances.
  - unfold own_error. lra.
Qed.

Lemma gs_numbers : Forall (Forall number) gs.
Proof.
  apply Forall_map, Forall_forall. intros f I. apply Forall_map, Forall_forall. intros e.
    now apply quartic_numbers.
Qed.
Lemma gs_stand : Subdivision.quartics (stands largest_g (own_error g_error)) 0 gs Gs.
Proof.
  unfold Subdivision.quartics. destruct (largest_size gs gs_numbers) as (_ & _ & B). cbv zeta in B.
  assert (G : forall l, (forall f, In f l -> In f (inside q)) ->
    Forall2 (fun g G => length g = 5%nat /\ Forall2 (stands largest_g (own_error g_error) 0) g G)
      (map (fun f => map value (quartic f)) l) (map (fun f => map exact (quartic f)) l)).
  { induction l as [| f l IH]; intros I; constructor; [| apply IH; intros; apply I; now right].
    split; [reflexivity |]. apply values_stand, Forall_forall. intros e J.
    pose proof (I f (or_introl eq_refl)) as K. split; [now apply quartic_numbers with f |]. split.
    - apply B with (map value (quartic f)); [now apply (in_map (fun f => map value (quartic f))) | now
      apply in_map].
    - apply own_error_nonnegative. now apply inside_error with f. }
  now apply G.
Qed.
Lemma g_parts_read : Subdivision.reads midpoint (certain g_errors) (stands largest_g (own_error g_error))
  (4 * max_depth).
Proof.
  destruct (largest_size gs gs_numbers) as (N & P & _).
  assert (E : 0 <= own_error g_error <= g_error).
  { destruct (inside q) as [| f l] eqn:I; [easy |]. apply (own_error_nonnegative g_error (at_ (quartic f) 0)).
    apply inside_error with f; [rewrite ?I; now left | now left]. }
  apply stands_read; auto. apply halving_error_enough; auto; try lra.
  - apply rnd_number; auto with typeclass_instances.
  - unfold own_error. lra.
Qed.

Lemma rootless_right t : Subdivision.above (certain y_error) y || Subdivision.below (certain y_error) y =
  true ->
  0 <= t <= 1 -> Subdivision.control_at Y t <> 0.
Proof.
  intros H T. destruct y_stands as (L & F). apply orb_prop in H. destruct H as [H | H].
  - pose proof (Subdivision.above_positive _ _ _ _ y_reads 0 y Y t (or_introl L) (le_n 0) F H T). lra.
  - pose proof (Subdivision.below_negative _ _ _ _ y_reads 0 y Y t (or_introl L) (le_n 0) F H T). lra.
Qed.
Lemma outside_right t : existsb (Subdivision.below (certain g_errors)) gs = true -> 0 <= t <= 1 ->
  exists G, In G Gs /\ Subdivision.control_at G t < 0.
Proof.
  intros H T. apply existsb_exists in H. destruct H as (g & I & B).
  destruct (proj1 (Subdivision.quartics_in _ _ _ _ gs_stand) g I) as (G & J & L & F). exists G. split; auto.
  exact (Subdivision.below_negative _ _ _ _ g_parts_read 0 g G t (or_intror L) (Nat.le_0_l _) F B T).
Qed.

Lemma subdivided_right (answer : Subdivision.outcome) :
  subdivide (certain y_errors) (certain g_errors) (hopeless y_errors) max_depth y gs = answer ->
  match answer with
  | Subdivision.separate => forall t, 0 <= t <= 1 -> Subdivision.control_at Y t = 0 ->
      exists G, In G Gs /\ Subdivision.control_at G t < 0
  | Subdivision.collides => exists t, 0 <= t <= 1 /\ Subdivision.control_at Y t = 0 /\
      forall G, In G Gs -> 0 < Subdivision.control_at G t
  | Subdivision.undecided => True
  end.
Proof.
  intros E. destruct y_stands as (L & F).
  destruct (Subdivision.subdivision_right 0 midpoint (certain y_errors) (certain g_errors) (hopeless y_errors)
    _ _ _ _ y_parts_read g_parts_read max_depth 0 0 y Y gs Gs L F gs_stand) as (A & B); [unfold max_depth;
      lia .. |].
  destruct answer; auto.
Qed.

End Query.

(** ** From floats to contact *)

Lemma largest_covers coordinate d : let m := largest coordinate d in
  (forall e, Rabs (coordinate (SeparatingAxis.b d e)) <= m) /\ (forall e, Rabs (coordinate (SeparatingAxis.c d e)) <= m) /\
  (forall e, Rabs (coordinate (SeparatingAxis.p_ d e)) <= m).
Proof.
  cbv zeta. unfold largest. cbn [fold_left].
  set (b0 := Rabs (coordinate (SeparatingAxis.b d false))). set (b1 := Rabs (coordinate (SeparatingAxis.b d true))).
  set (c0 := Rabs (coordinate (SeparatingAxis.c d false))). set (c1 := Rabs (coordinate (SeparatingAxis.c d true))).
  set (p0 := Rabs (coordinate (SeparatingAxis.p_ d false))). set (p1 := Rabs (coordinate (SeparatingAxis.p_ d true))).
  pose proof (Rmax_l b0 b1). pose proof (Rmax_r b0 b1). set (m1 := Rmax b0 b1) in *.
  pose proof (Rmax_l m1 c0). pose proof (Rmax_r m1 c0). set (m2 := Rmax m1 c0) in *.
  pose proof (Rmax_l m2 c1). pose proof (Rmax_r m2 c1). set (m3 := Rmax m2 c1) in *.
  pose proof (Rmax_l m3 p0). pose proof (Rmax_r m3 p0). set (m4 := Rmax m3 p0) in *.
  pose proof (Rmax_l m4 p1). pose proof (Rmax_r m4 p1).
  repeat split; intros []; fold b0 b1 c0 c1 p0 p1; lra.
Qed.
Lemma largest_number coordinate d : (forall e, number (coordinate (SeparatingAxis.b d e))) ->
  (forall e, number (coordinate (SeparatingAxis.c d e))) -> (forall e, number (coordinate (SeparatingAxis.p_ d e))) ->
  number (largest coordinate d).
Proof.
  intros B C P. unfold largest. cbn [fold_left].
  assert (M : forall r s, number r -> number s -> number (Rmax r (Rabs s))).
  { intros r s Nr Ns. unfold Rmax. destruct Rle_dec; auto. now apply number_abs. }
  repeat apply M; auto. now apply number_abs.
Qed.

Section Sized.

Variables b1 b0 c1 c0 p1 p0 : Contact.moving.
Notation numbers := SeparatingAxis.numbers.
Context (b1_numbers : numbers b1) (b0_numbers : numbers b0) (c1_numbers : numbers c1) (c0_numbers : numbers c0)
  (p1_numbers : numbers p1) (p0_numbers : numbers p0).
Notation d := (differences_of b1 b0 c1 c0 p1 p0).
Notation m := (sizes d).
Notation q := {| b_ := moving_difference m b1 b0; c_ := moving_difference m c1 c0;
  p_ := moving_difference m p1 p0 |}.

Lemma sizes_cover : SeparatingAxis.sized m d.
Proof.
  unfold SeparatingAxis.sized, SeparatingAxis.within, sizes. cbn [Contact.x Contact.y Contact.z].
  pose proof (largest_covers Contact.x d) as (X1 & X2 & X3).
  pose proof (largest_covers Contact.y d) as (Y1 & Y2 & Y3).
  pose proof (largest_covers Contact.z d) as (Z1 & Z2 & Z3). auto 10.
Qed.
Lemma sizes_number : (number (Contact.x m) /\ number (Contact.y m) /\ number (Contact.z m)) /\
  (0 <= Contact.x m /\ 0 <= Contact.y m /\ 0 <= Contact.z m).
Proof.
  split; [repeat split; apply largest_number; intros e; apply rnd_number; auto with typeclass_instances |].
  destruct sizes_cover as (B & _). destruct (B false) as (X & Y & Z).
  repeat split; (eapply Rle_trans; [apply Rabs_pos | eassumption]).
Qed.
Lemma usable_moving : usable m = true ->
  let moving := moving direction (Contact.x m) (Contact.y m) (Contact.z m) in
  moving (b_ q) /\ moving (c_ q) /\ moving (p_ q).
Proof.
  intros U. unfold usable in U. destruct (Rle_bool_spec (Rmax (Rmax (Contact.x m) (Contact.y m)) (Contact.z
    m)) W)
    as [L |]; [| discriminate].
  pose proof (Rmax_l (Rmax (Contact.x m) (Contact.y m)) (Contact.z m)).
  pose proof (Rmax_r (Rmax (Contact.x m) (Contact.y m)) (Contact.z m)).
  pose proof (Rmax_l (Contact.x m) (Contact.y m)). pose proof (Rmax_r (Contact.x m) (Contact.y m)).
  assert (G : forall q r, numbers q -> numbers r ->
    SeparatingAxis.within m (fun e => SeparatingAxis.difference_of direction (SeparatingAxis.at_end q e) (SeparatingAxis.at_end r e)) ->
    moving direction (Contact.x m) (Contact.y m) (Contact.z m) (moving_difference m q r)).
  { intros q r Q R' V. destruct (Q false) as (? & ? & ?), (Q true) as (? & ? & ?), (R' false) as (? & ? & ?),
      (R' true) as (? & ? & ?), (V false) as (? & ? & ?), (V true) as (? & ? & ?).
    unfold moving, moving_difference, differences_fit. cbn [x_ y_ z_].
    split; [| split]; (split; [reflexivity |]); intros e [<- | [<- | []]]; do 2 eexists; split; try reflexivity;
      repeat split; auto; lra. }
  destruct sizes_cover as (B & C & P). cbn [b_ c_ p_]. repeat split; apply G; auto.
Qed.

(** The forms of the differences, as functions of time. *)
Lemma vector_at q' r t : Decisions.vector_at (exact_vector (moving_difference m q' r)) t =
  Contact.minus (Contact.place q' t) (Contact.place r t).
Proof.
  unfold Decisions.vector_at, exact_vector, moving_difference, exact_form, Bernstein.at_time, Contact.minus,
    Contact.place. apply Contact.same_point; cbn; ring.
Qed.
Lemma degrees q' r : Decisions.degree (exact_vector (moving_difference m q' r)) 1.
Proof. repeat split. Qed.
Lemma lengths q' r : of_length 2 (moving_difference m q' r).
Proof. repeat split. Qed.

Section At.

Variable t : R.
Notation B := (Contact.minus (Contact.place b1 t) (Contact.place b0 t)).
Notation C := (Contact.minus (Contact.place c1 t) (Contact.place c0 t)).
Notation P := (Contact.minus (Contact.place p1 t) (Contact.place p0 t)).

Lemma cubic_at : Subdivision.control_at (map exact (cubic (coplanarity q))) t = 3 * Contact.det B C P.
Proof.
  destruct (exact_coplanarity q (lengths _ _) (lengths _ _) (lengths _ _)) as (E & L).
  rewrite control_cubic by exact L. rewrite E.
  destruct (Decisions.forms_y _ _ _ t (degrees b1 b0) (degrees c1 c0) (degrees p1 p0)) as (F & _).
  rewrite !vector_at in F. f_equal. exact F.
Qed.
Lemma quartics_at :
  map (fun f => Subdivision.control_at (map exact (quartic f)) t) (vertex_face_inside q) =
    map (Rmult 12) [Contact.weight_2 B C P; Contact.weight_1 B C P; Contact.weight_0 B C P] /\
  map (fun f => Subdivision.control_at (map exact (quartic f)) t) (edge_edge_inside q) =
    map (Rmult 12) [Contact.on_a B C P; Contact.square_normal B C - Contact.on_a B C P;
                    Contact.on_b B C P; Contact.square_normal B C - Contact.on_b B C P].
Proof.
  destruct (exact_inside q (lengths _ _) (lengths _ _) (lengths _ _)) as (E & F & L).
  destruct (Decisions.forms_weights _ _ _ t (degrees b1 b0) (degrees c1 c0) (degrees p1 p0)) as (G & H & _).
  cbv zeta in G, H. rewrite !vector_at in G, H. rewrite <- G, <- H.
  cbn [b_ c_ p_] in E, F. rewrite <- E, <- F, !map_map.
  split; apply map_ext_in; intros f I; apply control_quartic, L; auto.
Qed.

End At.

(** Hypotheses on a kind of query; K means that it collides. *)
Context (inside : query -> list form) (sides : sides_of) (K : Prop).
Notation Y := (map exact (cubic (coplanarity q))).
Notation Gs := (map (fun f => map exact (quartic f)) (inside q)).
Notation parts axes := (SeparatingAxis.separated (sides d) axes).
Context (parts_right : parts (SeparatingAxis.coordinate_axes (Contact.x m) (Contact.y m) (Contact.z m)) = true \/ parts
    (SeparatingAxis.diagonal_axes direction (Contact.x m) (Contact.y m) (Contact.z m)) = true -> ~ K) (inside_right :
    let moving := moving direction (Contact.x m) (Contact.y m) (Contact.z m) in moving (b_ q) -> moving (c_ q) ->
    moving (p_ q) -> inside_fit direction (Contact.x m) (Contact.y m) (Contact.z m) (inside q) /\ forall f e, In f
    (inside q) -> In e (quartic f) -> Rabs (value e - exact e) + tiny / 1000 <= error_of_g direction inside (Contact.x
    m) (Contact.y m) (Contact.z m) * (1 - eps)) (inside_some : inside q <> []) (necessary : K -> exists t, 0 <= t <= 1
    /\ Subdivision.control_at Y t = 0 /\ forall G, In G Gs -> 0 <= Subdivision.control_at G t) (sufficient : forall t,
    0 <= t <= 1 -> Subdivision.control_at Y t = 0 -> (forall G, In G Gs -> 0 < Subdivision.control_at G t) -> K).

Lemma filter_right : match filter sides inside b1 b0 c1 c0 p1 p0 with
  | Subdivision.separate => ~ K
  | Subdivision.collides => K
  | Subdivision.undecided => True
  end.
Proof.
  unfold filter. cbv zeta. destruct (usable m) eqn:U; [| easy]. cbn [negb].
  destruct (usable_moving U) as (Mb & Mc & Mp). destruct (inside_right Mb Mc Mp) as (Fit & Sound).
  destruct (parts (SeparatingAxis.coordinate_axes _ _ _)); [now apply parts_right; left |].
  match goal with |- context [if ?c then _ else _] => destruct c eqn:H end.
  { intros k. destruct (necessary k) as (t & T & Z & _). now apply (rootless_right q _ _ _ Mb Mc Mp t). }
  destruct (parts (SeparatingAxis.diagonal_axes _ _ _ _)); [now apply parts_right; right |].
  match goal with |- context [if ?c then _ else _] => destruct c eqn:O end.
  { intros k. destruct (necessary k) as (t & T & _ & G).
    destruct (outside_right q _ _ _ inside Fit Sound inside_some t O T) as (g & I & N).
    specialize (G g I). lra. }
  match goal with |- match ?s with _ => _ end =>
    pose proof (subdivided_right q _ _ _ Mb Mc Mp inside Fit Sound inside_some s eq_refl) as S;
      destruct s end; auto.
  - intros k. destruct (necessary k) as (t & T & Z & G). destruct (S t T Z) as (g & I & N).
    specialize (G g I). lra.
  - destruct S as (t & T & Z & G). exact (sufficient t T Z G).
Qed.

End Sized.

Lemma in_quartics (P : R -> Prop) t (fs : list form) w :
  map (fun f => Subdivision.control_at (map exact (quartic f)) t) fs = map (Rmult 12) w ->
  (forall G, In G (map (fun f => map exact (quartic f)) fs) -> P (Subdivision.control_at G t)) <->
  Forall (fun r => P (12 * r)) w.
Proof.
  intros E. rewrite <- (Forall_map (Rmult 12) P), <- E, Forall_map, Forall_forall. split.
  - intros H f I. apply H. now apply (in_map (fun f => map exact (quartic f))).
  - intros H G I. apply in_map_iff in I. destruct I as (f & <- & I). now apply H.
Qed.

Lemma filter_face_right v f0 f1 f2 : SeparatingAxis.numbers v -> SeparatingAxis.numbers f0 -> SeparatingAxis.numbers f1 ->
  SeparatingAxis.numbers f2 -> match filter_face v f0 f1 f2 with
  | Subdivision.separate => ~ Contact.vertex_face_collides v f0 f1 f2
  | Subdivision.collides => Contact.vertex_face_collides v f0 f1 f2
  | Subdivision.undecided => True
  end.
Proof.
  intros V F0 F1 F2.
  refine (filter_right f1 f0 f2 f0 v f0 F1 F0 F2 F0 V F0 vertex_face_inside (SeparatingAxis.face_sides direction)
    (Contact.vertex_face_collides v f0 f1 f2) _ _ _ _ _).
  - destruct (sizes_number f1 f0 f2 f0 v f0) as (N & P).
    exact (SeparatingAxis.separated_face_separate direction _ N P v f0 f1 f2 V F0 F1 F2 (sizes_cover f1 f0 f2 f0 v f0)).
  - intros moving B C P. split; [now apply vertex_face_inside_fit | now apply error_of_vertex_face_sound].
  - discriminate.
  - intros (t & T & H). exists t. apply Contact.touching_conditions in H. cbv zeta in H.
    destruct H as (Y & W2 & W1 & W0). split; [exact T |]. split; [rewrite cubic_at, Y; ring |].
    apply (in_quartics (Rle 0) _ _ _ (proj1 (quartics_at f1 f0 f2 f0 v f0 t))).
    repeat apply Forall_cons; try apply Forall_nil; lra.
  - intros t T Z G. exists t. split; [exact T |]. apply Contact.face_at_a_time. left.
    apply (in_quartics (Rlt 0) _ _ _ (proj1 (quartics_at f1 f0 f2 f0 v f0 t))) in G.
    inversion_clear G as [| ? ? G2 G']. inversion_clear G' as [| ? ? G1 G]. inversion_clear G as [| ? ? G0 _].
    rewrite cubic_at in Z. apply Contact.inside_face_regular; [lra |]. unfold Contact.inside_face.
    split; [| split]; lra.
Qed.
Lemma filter_edges_right a0 a1 b0 b1 : SeparatingAxis.numbers a0 -> SeparatingAxis.numbers a1 -> SeparatingAxis.numbers b0 ->
  SeparatingAxis.numbers b1 -> match filter_edges a0 a1 b0 b1 with
  | Subdivision.separate => ~ Contact.edge_edge_collides a0 a1 b0 b1
  | Subdivision.collides => Contact.edge_edge_collides a0 a1 b0 b1
  | Subdivision.undecided => True
  end.
Proof.
  intros A0 A1 B0 B1.
  refine (filter_right a1 a0 b1 b0 b0 a0 A1 A0 B1 B0 B0 A0 edge_edge_inside (SeparatingAxis.edge_sides direction)
    (Contact.edge_edge_collides a0 a1 b0 b1) _ _ _ _ _).
  - destruct (sizes_number a1 a0 b1 b0 b0 a0) as (N & P).
    exact (SeparatingAxis.separated_edges_separate direction _ N P a0 a1 b0 b1 A0 A1 B0 B1 (sizes_cover a1 a0 b1 b0 b0
      a0)).
  - intros moving B C P. split; [now apply edge_edge_inside_fit | now apply error_of_edge_edge_sound].
  - discriminate.
  - intros (t & T & H). exists t. apply Contact.meeting_conditions in H. cbv zeta in H.
    destruct H as (Y & W3 & W2 & W1 & W0). split; [exact T |]. split; [rewrite cubic_at, Y; ring |].
    apply (in_quartics (Rle 0) _ _ _ (proj2 (quartics_at a1 a0 b1 b0 b0 a0 t))).
    repeat apply Forall_cons; try apply Forall_nil; lra.
  - intros t T Z G. exists t. split; [exact T |]. apply Contact.edges_at_a_time. left.
    apply (in_quartics (Rlt 0) _ _ _ (proj2 (quartics_at a1 a0 b1 b0 b0 a0 t))) in G.
    inversion_clear G as [| ? ? G3 G']. inversion_clear G' as [| ? ? G2 G]. inversion_clear G as [| ? ? G1 G'].
    inversion_clear G' as [| ? ? G0 _]. rewrite cubic_at in Z.
    apply Contact.inside_edges_regular; [lra |]. unfold Contact.inside_edges. repeat split; lra.
Qed.

(** ** Overflow *)

(** All intermediate values of e. *)
Fixpoint steps (e : counted) : list counted :=
  e :: match e with
       | Sum x y | Minus x y | Product x y => steps x ++ steps y
       | Negation x => steps x
       | _ => []
       end.
Lemma step_bounded e f : admissible p emin direction W e -> (degree e <= 4)%nat -> (height e <= 60)%nat ->
  In f (steps e) -> Rabs (value f) <= bpow radix2 900.
Proof.
  assert (Self : forall e, admissible p emin direction W e -> (degree e <= 4)%nat -> (height e <= 60)%nat ->
    Rabs (value e) <= bpow radix2 900).
  { intros g A D H.
    destruct (count_sound p emin direction W W_1 p_10 emin_p g A ltac:(lia)) as (S & _).
    destruct (count_height p emin direction W p_10 emin_p g A) as (M & _ & U).
    pose proof (unit_power p emin direction W W_1 g A) as Un.
    assert (H60 : bpow radix2 (Z.of_nat (height g)) <= bpow radix2 60) by (apply bpow_le; lia).
    assert (W4 : forall n, (n <= 4)%nat -> 0 <= W ^ n <= bpow radix2 800).
    { intros n L. rewrite W_power. split; [apply bpow_ge_0 | apply bpow_le; lia]. }
    pose proof (W4 _ D) as W1. pose proof (W4 (Nat.pred (degree g)) ltac:(lia)) as W2.
    assert (E : 0 <= eta <= 1) by (split; [apply bpow_ge_0 | change 1 with (bpow radix2 0); apply bpow_le;
      lia]).
    apply Rle_trans with (1 := S).
    apply Rle_trans with (bpow radix2 60 * bpow radix2 800 + bpow radix2 60 * (1 * bpow radix2 800)).
    - destruct (count_proper p emin direction W p_10 emin_p g A) as (_ & _ & _ & M0 & _ & U0).
      assert (0 <= eta * W ^ Nat.pred (degree g)) by (apply Rmult_le_pos; lra).
      apply Rplus_le_compat; apply Rmult_le_compat; try lra. apply Rmult_le_compat; lra.
    - rewrite Rmult_1_l, <- bpow_plus. apply Rle_trans with (2 * bpow radix2 860); [simpl Z.add; lra |].
      change 2 with (bpow radix2 1). rewrite <- bpow_plus. apply bpow_le. lia. }
  induction e as [| | | x IHx y IHy | x IHx y IHy | x IHx y IHy | x IHx | ];
    cbn [steps In degree height admissible]; intros A D H I;
    (destruct I as [<- | I]; [apply Self; auto |]); try easy; try (apply in_app_iff in I).
  - destruct A, I; [apply IHx | apply IHy]; auto; lia.
  - destruct A, I; [apply IHx | apply IHy]; auto; lia.
  - destruct A as (A & B & _), I; [apply IHx | apply IHy]; auto; lia.
  - auto.
Qed.

(** If the filter is usable, no intermediate value of Y and the G_i exceeds 2^900. *)
Theorem filter_bounded inside b1 b0 c1 c0 p1 p0 f : SeparatingAxis.numbers b1 -> SeparatingAxis.numbers b0 ->
  SeparatingAxis.numbers c1 -> SeparatingAxis.numbers c0 -> SeparatingAxis.numbers p1 -> SeparatingAxis.numbers p0 ->
  inside = vertex_face_inside \/ inside = edge_edge_inside ->
  let m := sizes (differences_of b1 b0 c1 c0 p1 p0) in
  let q := {| b_ := moving_difference m b1 b0; c_ := moving_difference m c1 c0;
    p_ := moving_difference m p1 p0 |} in
  usable m = true -> In f (concat (map steps (concat (cubic (coplanarity q) :: map quartic (inside q))))) ->
  Rabs (value f) <= bpow radix2 900.
Proof.
  intros B1 B0 C1 C0 P1 P0 In m q U I.
  destruct (usable_moving b1 b0 c1 c0 p1 p0 B1 B0 C1 C0 P1 P0 U) as (Mb & Mc & Mp). fold m q in Mb, Mc, Mp.
  apply in_concat in I. destruct I as (l & I & J). apply in_map_iff in I. destruct I as (e & <- & I).
  assert (F : exists u k h, (k <= 4)%nat /\ (h <= 60)%nat /\ fits direction u k h e).
  { apply in_concat in I. destruct I as (l & [<- | K] & I).
    - pose proof (cubic_fits direction _ _ _ q Mb Mc Mp) as F. apply (proj1 (Forall_forall _ _) F) in I.
      do 3 eexists. split; [| split; [| exact I]]; lia.
    - apply in_map_iff in K. destruct K as (g & <- & K).
      assert (Fit : inside_fit direction (Contact.x m) (Contact.y m) (Contact.z m) (inside q))
        by (destruct In; subst inside; [now apply vertex_face_inside_fit | now apply edge_edge_inside_fit]).
      pose proof (quartic_fits direction _ _ _ _ g Fit K) as F. apply (proj1 (Forall_forall _ _) F) in I.
      do 3 eexists. split; [| split; [| exact I]]; lia. }
  destruct F as (u & k & h & Hk & Hh & (A & _ & D & H)). apply step_bounded with e; auto; lia.
Qed.

(** The theorems for floating-point coordinates. *)
Theorem filter_face_separate v f0 f1 f2 : SeparatingAxis.numbers v -> SeparatingAxis.numbers f0 -> SeparatingAxis.numbers f1 ->
  SeparatingAxis.numbers f2 -> filter_face v f0 f1 f2 = Subdivision.separate ->
  ~ Contact.vertex_face_collides v f0 f1 f2.
Proof. intros V F0 F1 F2 E. generalize (filter_face_right v f0 f1 f2 V F0 F1 F2). now rewrite E. Qed.
Theorem filter_face_collides v f0 f1 f2 : SeparatingAxis.numbers v -> SeparatingAxis.numbers f0 -> SeparatingAxis.numbers f1 ->
  SeparatingAxis.numbers f2 -> filter_face v f0 f1 f2 = Subdivision.collides ->
  Contact.vertex_face_collides v f0 f1 f2.
Proof. intros V F0 F1 F2 E. generalize (filter_face_right v f0 f1 f2 V F0 F1 F2). now rewrite E. Qed.
Theorem filter_edges_separate a0 a1 b0 b1 : SeparatingAxis.numbers a0 -> SeparatingAxis.numbers a1 -> SeparatingAxis.numbers b0 ->
  SeparatingAxis.numbers b1 -> filter_edges a0 a1 b0 b1 = Subdivision.separate ->
  ~ Contact.edge_edge_collides a0 a1 b0 b1.
Proof. intros A0 A1 B0 B1 E. generalize (filter_edges_right a0 a1 b0 b1 A0 A1 B0 B1). now rewrite E. Qed.
Theorem filter_edges_collide a0 a1 b0 b1 : SeparatingAxis.numbers a0 -> SeparatingAxis.numbers a1 -> SeparatingAxis.numbers b0 ->
  SeparatingAxis.numbers b1 -> filter_edges a0 a1 b0 b1 = Subdivision.collides ->
  Contact.edge_edge_collides a0 a1 b0 b1.
Proof. intros A0 A1 B0 B1 E. generalize (filter_edges_right a0 a1 b0 b1 A0 A1 B0 B1). now rewrite E. Qed.

End Stages.
