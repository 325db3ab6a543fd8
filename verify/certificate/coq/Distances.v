(** The theorem about distances: answers that the checker accepts are right and complete. *)
From Coq Require Import ZArith NArith QArith Qpower Lqa Lia List Bool Setoid Morphisms.
Require Import Spec Checker Geometry Points Descent Pairs Proofs DistanceChecker.
Import ListNotations.
Open Scope Q_scope.

(** * Squares of distances of triangles with whole coordinates *)
Lemma squared_positive p q : 0 <= squared_distance p q.
Proof.
  unfold squared_distance. pose proof (square (x p - x q)). pose proof (square (y p - y q)).
  pose proof (square (z p - z q)). lra.
Qed.
Lemma squared_swap p q : squared_distance p q == squared_distance q p.
Proof. unfold squared_distance. ring. Qed.
Definition far_squares (n m : Z) (a b : triangle Z) : Prop :=
  forall p q, inside (qtri a) p -> inside (qtri b) q -> #n <= #m * squared_distance p q.

Lemma keeps_off_sound n m a b d : (0 < m)%Z -> keeps_off n m a b d = true -> far_squares n m a b.
Proof.
  unfold keeps_off, gap_along. intros M H p q A B. tests.
  set (g1 := (min3 (dot d (p1 b)) _ _ - _)%Z) in *. set (g2 := (min3 (dot d (p1 a)) _ _ - _)%Z) in *.
  assert (G : forall g, (0 < g)%Z -> (n * dot d d <= m * (g * g))%Z ->
    #g * #g <= #(dot d d) * squared_distance p q -> #n <= #m * squared_distance p q).
  { intros g G L C. apply -> inject_lt in M. apply -> inject_lt in G. apply -> inject_le in L.
    change #0 with 0 in *. inject. pose proof (dot_positive d) as P. set (s := squared_distance p q) in *.
    assert (GG : 0 < #g * #g) by nra.
    assert (DD : 0 < #(dot d d)).
    { destruct (Qlt_le_dec 0 #(dot d d)) as [Y | Y]; [assumption|].
      assert (E : #(dot d d) == 0) by lra. rewrite E in C. lra. }
    apply (Qmult_le_l _ _ _ DD).
    assert (0 <= #m * (#(dot d d) * s - #g * #g)) by (apply Qmult_le_0_compat; lra). lra. }
  destruct (Z.max_spec g1 g2) as [[_ E] | [_ E]]; rewrite E in *.
  - apply (G g2); auto. rewrite squared_swap. now apply (gap_below d b a g2).
  - apply (G g1); auto. now apply (gap_below d a b g1).
Qed.
Lemma is_at_least_sound n m a b : (0 < m)%Z -> is_at_least n m a b = true -> far_squares n m a b.
Proof.
  unfold is_at_least. intros M H. apply orb_prop in H. destruct H as [H | H].
  - tests. intros p q _ _. apply -> inject_le in H. apply -> inject_lt in M. change #0 with 0 in *.
    assert (0 <= #m * squared_distance p q) by (apply Qmult_le_0_compat; [lra | apply squared_positive]).
    lra.
  - apply existsb_exists in H. destruct H as (d & _ & H). eapply keeps_off_sound; eauto.
Qed.

Lemma is_at_most_sound n m a b : is_at_most n m a b = true -> near_squares n m a b.
Proof.
  unfold is_at_most. intros H. apply orb_prop in H. destruct H as [H | H].
  - apply (has_near_sound (near_squares n m) (are_within n m)); auto.
    + intros c d (p & q & P & Q & L). exists q, p. rewrite squared_swap. auto.
    + intros. eapply are_within_sound. eassumption.
  - apply andb_prop in H. destruct H as [N H]. tests. apply has_common_sound in H.
    destruct H as (q & k & K & _ & A & B). exists (over q k), (over q k).
    split; [assumption|]. split; [assumption|]. apply -> inject_le in N. change #0 with 0 in *.
    setoid_replace (squared_distance (over q k) (over q k)) with 0; [lra|].
    unfold squared_distance. ring.
Qed.

(** * In the units of the scene *)
Lemma square_scaled f q : (f <= 0)%Z ->
  q * #(denominator q) == 2 ^ f * 2 ^ f * #(numerator f q).
Proof.
  intros F. unfold numerator, denominator.
  rewrite N.shiftl_1_l, N2Z.inj_pow, Z2N.id by lia. simpl Z.of_N.
  rewrite inject_Z_mult, Zpower_Qpower by lia. change #2 with 2.
  assert (E : 2 ^ f * 2 ^ f * 2 ^ (-2 * f) == 1).
  { rewrite <- !Qpower_plus by discriminate. replace (f + f + -2 * f)%Z with 0%Z by lia. reflexivity. }
  setoid_replace (2 ^ f * 2 ^ f * (#(Qnum q) * 2 ^ (-2 * f))) with (2 ^ f * 2 ^ f * 2 ^ (-2 * f) * #(Qnum q)) by ring.
  rewrite E. destruct q as [n d]. cbn [Qnum Qden]. unfold Qeq, Qmult, inject_Z. cbn [Qnum Qden]. nia.
Qed.
Lemma denominator_positive q : (0 < denominator q)%Z.
Proof. reflexivity. Qed.
Section Units.
Variables (f : Z) (q : Q) (t t' : triangle double).
Context (F : (f <= 0)%Z) (T : at_most_triangle f t) (T' : at_most_triangle f t').
Let a := map_triangle (scaled f) t.
Let b := map_triangle (scaled f) t'.
Lemma at_least_value : far_squares (numerator f q) (denominator q) a b ->
  no_nearer q (map_triangle value t) (map_triangle value t').
Proof.
  intros S p r P R. pose proof (power_positive f) as K.
  pose proof (sized_value f t T) as A. pose proof (sized_value f t' T') as B.
  pose proof (inside_sized _ _ _ _ (sized_inverse _ _ _ K A) P) as P'.
  pose proof (inside_sized _ _ _ _ (sized_inverse _ _ _ K B) R) as R'.
  specialize (S _ _ P' R'). rewrite squared_sized in S.
  pose proof (square_scaled f q F) as E. set (k := 2 ^ f) in *.
  set (m := #(denominator q)) in *. set (n := #(numerator f q)) in *.
  assert (M : 0 < m) by reflexivity. set (s := squared_distance p r) in *.
  assert (KN : ~ k == 0) by lra.
  assert (KK : 0 < k * k) by nra.
  assert (L : k * k * n <= m * s).
  { setoid_replace (m * s) with (k * k * (m * (/ k * / k * s))) by (field; assumption).
    apply Qmult_le_l; assumption. }
  rewrite <- E in L. apply (Qmult_le_l _ _ m M). lra.
Qed.
Lemma squared_is_value : far_squares (numerator f q) (denominator q) a b ->
  near_squares (numerator f q) (denominator q) a b ->
  squared_is q (map_triangle value t) (map_triangle value t').
Proof.
  intros S (p & r & P & R & L). pose proof (at_least_value S) as G. split; [assumption|].
  pose proof (power_positive f) as K.
  pose proof (inside_sized _ _ _ _ (sized_value f t T) P) as P'.
  pose proof (inside_sized _ _ _ _ (sized_value f t' T') R) as R'.
  exists (times (2 ^ f) p), (times (2 ^ f) r). split; [assumption|]. split; [assumption|].
  specialize (G _ _ P' R'). rewrite squared_sized in *.
  pose proof (square_scaled f q F) as E. set (k := 2 ^ f) in *.
  set (m := #(denominator q)) in *. set (n := #(numerator f q)) in *.
  assert (M : 0 < m) by reflexivity. set (s := squared_distance p r) in *.
  assert (KK : 0 < k * k) by nra.
  apply Qle_antisym; [|assumption]. apply (Qmult_le_l _ _ m M).
  setoid_replace (m * q) with (k * k * n) by (rewrite <- E; ring).
  setoid_replace (m * (k * k * s)) with (k * k * (m * s)) by ring.
  apply Qmult_le_l; assumption.
Qed.
End Units.

(** * Reaches *)
Lemma root_above_sound n m : (0 < m)%Z -> (0 < root_above n m)%Z /\
  (n <= m * (root_above n m * root_above n m))%Z.
Proof.
  intros M. unfold root_above. set (x := (Z.max 0 n / m)%Z).
  assert (X : (0 <= x)%Z) by (apply Z.div_pos; lia).
  pose proof (Z.sqrt_spec x X) as [_ S]. pose proof (Z.sqrt_nonneg x). split; [lia|].
  assert (B : (Z.max 0 n < m * (x + 1))%Z).
  { pose proof (Z.mul_succ_div_gt (Z.max 0 n) m M) as G. fold x in G. unfold Z.succ in G. exact G. }
  assert (x + 1 <= (Z.sqrt x + 1) * (Z.sqrt x + 1))%Z by (unfold Z.succ in S; lia).
  assert (m * (x + 1) <= m * ((Z.sqrt x + 1) * (Z.sqrt x + 1)))%Z by (apply Z.mul_le_mono_nonneg_l; lia).
  lia.
Qed.
Lemma reach_for_all f es a : forall w, (w <= reach_for f es w a)%Z /\
  forall e, In e es -> object_a (nearest e) = obj a ->
    (root_above (numerator f (squared e)) (denominator (squared e)) <= reach_for f es w a)%Z.
Proof.
  unfold reach_for. induction es as [|e es IH]; intros w; cbn [fold_left]; [split; [lia | intros ? []]|].
  set (w' := if (object_a (nearest e) =? obj a)%Z then _ else w).
  assert (W : (w <= w')%Z) by (unfold w'; destruct (_ =? _)%Z; lia).
  destruct (IH w') as [L A]. split; [lia|]. intros e' [<- | I] O; [|auto].
  unfold w' in L at 1. rewrite O, Z.eqb_refl in L. lia.
Qed.

(** * The entries *)
Lemma is_for_sound o o' e : is_for o o' e = true <-> object_a (nearest e) = o /\ object_b (nearest e) = o'.
Proof. unfold is_for. rewrite andb_true_iff, !Z.eqb_eq. tauto. Qed.
Lemma once_find es : once es = true -> forall e o o', In e es -> is_for o o' e = true ->
  List.find (is_for o o') es = Some e.
Proof.
  induction es as [|e es IH]; intros O e' o o' I F; [destruct I|]. cbn [once] in O.
  apply andb_prop in O. destruct O as [N O]. apply negb_true_iff in N. cbn [List.find].
  destruct I as [<- | I]; [now rewrite F|]. destruct (is_for o o' e) eqn:F'; [|auto].
  exfalso. apply is_for_sound in F'. destruct F' as [<- <-].
  apply not_true_iff_false in N. apply N. apply existsb_exists. eauto.
Qed.
Lemma first_items_all l : forall seen, (forall a, In a seen -> In a (first_items l seen)) /\
  forall a, In a l -> exists b, In b (first_items l seen) /\ obj b = obj a.
Proof.
  induction l as [|c l IH]; intros seen; cbn [first_items]; [split; [auto | intros a []]|].
  set (seen' := if existsb (fun b => (obj b =? obj c)%Z) (firstn 1 seen) then seen else c :: seen).
  assert (K : (forall a, In a seen -> In a seen') /\ exists b, In b seen' /\ obj b = obj c).
  { unfold seen'. destruct (existsb _ _) eqn:X; [split; [auto|] | simpl; split; [auto | exists c; auto]].
    apply existsb_exists in X. destruct X as (b & B & E). apply Z.eqb_eq in E.
    exists b. split; [|assumption]. destruct seen as [|d seen]; [destruct B|]. destruct B as [<- | []]. now left. }
  destruct (IH seen') as [A B], K as [K1 (b & K2 & K3)]. split; [auto|].
  intros a [<- | I]; [exists b; auto | auto].
Qed.

(** * The triangles *)
Section Scene.
Variables (s : scene) (reach : double) (f : Z).
Let l := gathered everything reach s.
Let items := items_of f l.
Context (F : (f <= 0)%Z).
Context (A : forall n, In n l -> at_most_triangle f (corners n)).

Definition is_item (a : item) (o i : nat) (t : triangle double) : Prop :=
  exists ob, nth_error s o = Some ob /\ nth_error (triangles ob) i = Some t /\ at_most_triangle f t /\
             a = make_item f (Named (Z.of_nat o) (Z.of_nat i) (self ob) t).
Lemma items_are a : In a items <-> exists o i t, is_item a o i t.
Proof.
  unfold items. rewrite items_all. split.
  - intros (n & N & ->). pose proof (A _ N) as M. apply gathered_all in N.
    destruct N as (o & ob & i & t & O & I & _ & ->). exists o, i, t, ob. auto.
  - intros (o & i & t & ob & O & I & _ & ->). eexists. split; [|reflexivity].
    apply gathered_all. exists o, ob, i, t. auto.
Qed.
Lemma item_neighbours a b o i o' i' t t' : is_item a o i t -> is_item b o' i' t' ->
  (shared_of a b = [] <-> ~ are_neighbours s o i o' i').
Proof.
  intros (ob & O & I & M & ->) (ob' & O' & I' & M' & ->).
  set (a := make_item _ _). set (b := make_item _ (Named (Z.of_nat o') _ _ _)).
  assert (E : neighbours (name_of a b) = true <-> are_neighbours s o i o' i').
  { rewrite name_flag. unfold a, b. cbn [obj shape make_item of_object corners].
    assert (T : is_triangle s o i t) by (exists ob; auto).
    assert (T' : is_triangle s o' i' t') by (exists ob'; auto).
    pose proof (shared_sized _ _ _ _ _ (power_positive f) (sized_value _ _ M) (sized_value _ _ M')) as S.
    rewrite Nat2Z.inj_iff, <- S. unfold are_neighbours. split; intros (X & H); (split; [exact X|]).
    - destruct H as (c & H). exists t, t', c. auto.
    - destruct H as (u & u' & c & U & U' & H). exists c.
      rewrite (is_triangle_unique _ _ _ _ _ T U), (is_triangle_unique _ _ _ _ _ T' U'). exact H. }
  rewrite <- E. unfold name_of, row_of. cbn [neighbours]. destruct (shared_of a b); split; congruence.
Qed.
Lemma item_before a b o i o' i' t t' : is_item a o i t -> is_item b o' i' t' ->
  (comes_before a b = true <-> asked s o i o' i').
Proof.
  intros (ob & O & I & M & ->) (ob' & O' & I' & M' & ->). unfold comes_before, asked.
  cbn [obj num own make_item of_object number inner].
  rewrite orb_true_iff, !andb_true_iff, !Z.ltb_lt, Z.eqb_eq, !Nat2Z.inj_iff, <- !Nat2Z.inj_lt. split.
  - intros [H | [[H S] N]]; [auto | right]. eauto.
  - intros [H | (H & N & ob2 & O2 & S)]; [auto | right]. rewrite O2 in O. injection O as ->. auto.
Qed.
Lemma measured_items o i o' i' t t' : measured s o i o' i' t t' -> exists a b,
  In a items /\ In b items /\ is_item a o i t /\ is_item b o' i' t' /\
  comes_before a b = true /\ shared_of a b = [].
Proof.
  intros (Q & (ob & O & I) & (ob' & O' & I') & N).
  assert (X : is_item (make_item f (Named (Z.of_nat o) (Z.of_nat i) (self ob) t)) o i t).
  { exists ob. repeat split; auto.
    all: apply (A (Named (Z.of_nat o) (Z.of_nat i) (self ob) t)); apply gathered_all; eauto 8. }
  assert (Y : is_item (make_item f (Named (Z.of_nat o') (Z.of_nat i') (self ob') t')) o' i' t').
  { exists ob'. repeat split; auto.
    all: apply (A (Named (Z.of_nat o') (Z.of_nat i') (self ob') t')); apply gathered_all; eauto 8. }
  eexists _, _. split; [apply items_are; exists o, i, t; exact X|].
  split; [apply items_are; exists o', i', t'; exact Y|]. split; [exact X|]. split; [exact Y|].
  split; [now apply (item_before _ _ _ _ _ _ _ _ X Y) | now apply (item_neighbours _ _ _ _ _ _ _ _ X Y)].
Qed.

(** A pair that the tree leaves out is farther apart than the reach. *)
Variables (within : option double) (es : list entry) (d : Z).
Let decided := pairs (fun _ _ => true) (reach_for f es d) items.
Context (D : (0 <= d)%Z).
Lemma left_out a b : In a items -> In b items -> comes_before a b = true ->
  In (a, b) decided \/ ~ near #(reach_for f es d a) (qtri (shape a)) (qtri (shape b)).
Proof.
  intros I I' C. destruct (candidate (grow (reach_for f es d a) a) b) eqn:G.
  - left. apply pairs_all. auto.
  - right. pose proof (proj1 (reach_for_all f es a d)) as R.
    apply items_are in I, I'. destruct I as (o & i & t & ob & _ & _ & _ & ->).
    destruct I' as (o' & i' & t' & ob' & _ & _ & _ & ->).
    apply (far_boxes _ (reach_for f es d (make_item f (Named (Z.of_nat o) (Z.of_nat i) (self ob) t))));
      [lia | lia|].
    apply not_true_iff_false. intros V. apply not_true_iff_false in G. apply G.
    apply grow_candidate. auto.
Qed.
End Scene.

(** * The theorem *)
Theorem accepted_distances_are_right s reach within es :
  check_distances (gathered everything reach s) within es = Distances_proved ->
  right_distances s within es.
Proof.
  unfold check_distances. set (l := gathered everything reach s).
  set (f := lowest l (lower_place 0 within)). set (items := items_of f l).
  set (d := match within with Some w => Some (scaled f w) | None => None end).
  set (least := match d with Some d => d | None => 0%Z end).
  destruct (least <? 0)%Z eqn:D; [discriminate|]. apply Z.ltb_ge in D.
  destruct (negb _) eqn:OC; [discriminate|]. apply negb_false_iff, andb_prop in OC.
  destruct OC as [ONCE CLOSE]. rewrite forallb_forall in CLOSE.
  destruct (List.find _ es) eqn:ME; [discriminate|].
  destruct (List.find _ (pairs _ _ _)) as [[? ?]|] eqn:FAR; [discriminate|].
  destruct (match d with Some _ => true | None => all_given es items end) eqn:GIVEN; [|discriminate].
  intros _.
  assert (F : (f <= 0)%Z).
  { pose proof (proj1 (lowest_all l (lower_place 0 within))) as L. fold f in L.
    destruct within; cbn [lower_place] in L; unfold lower in L; lia. }
  assert (A : forall n, In n l -> at_most_triangle f (corners n)) by apply (proj2 (lowest_all l _)).
  assert (W : forall w, within = Some w -> (f <= exponent w)%Z /\ d = Some (scaled f w) /\ least = scaled f w).
  { intros w E. pose proof (proj1 (lowest_all l (lower_place 0 within))) as L. fold f in L.
    unfold least, d. rewrite E in *. cbn [lower_place] in L. unfold lower in L. split; [lia | auto]. }
  assert (MEAS : forall e, In e es -> exists o i o' i' t t' a b, names (nearest e) o i o' i' /\
    is_item s f a o i t /\ is_item s f b o' i' t' /\ measured s o i o' i' t t' /\
    squared_is (squared e) (map_triangle value t) (map_triangle value t')).
  { intros e I. pose proof (find_none _ _ ME _ I) as M. apply negb_false_iff in M. unfold measures in M.
    apply existsb_exists in M. destruct M as (a & IA & M). apply andb_prop in M. destruct M as [MA M].
    apply existsb_exists in M. destruct M as (b & IB & M). tests.
    apply (items_are s reach f A) in IA, IB. destruct IA as (o & i & t & IA), IB as (o' & i' & t' & IB).
    exists o, i, o', i', t, t', a, b.
    assert (SH : shared_of a b = []) by (destruct (shared_of a b); congruence).
    assert (N : names (nearest e) o i o' i').
    { destruct IA as (? & _ & _ & _ & ->), IB as (? & _ & _ & _ & ->). cbn in *. unfold names. auto. }
    split; [assumption|]. split; [assumption|]. split; [assumption|].
    assert (X : at_most_triangle f t) by (destruct IA as (? & _ & _ & X & _); exact X).
    assert (Y : at_most_triangle f t') by (destruct IB as (? & _ & _ & Y & _); exact Y).
    assert (SA : shape a = map_triangle (scaled f) t) by (destruct IA as (? & _ & _ & _ & ->); reflexivity).
    assert (SB : shape b = map_triangle (scaled f) t') by (destruct IB as (? & _ & _ & _ & ->); reflexivity).
    split.
    - repeat split.
      + eapply (item_before s f a b); eauto.
      + destruct IA as (ob & O & T & _). exists ob. auto.
      + destruct IB as (ob & O & T & _). exists ob. auto.
      + eapply (item_neighbours s f a b); eauto.
    - rewrite SA, SB in *. apply (squared_is_value f); auto.
      + apply is_at_least_sound; [apply denominator_positive | assumption].
      + now apply is_at_most_sound. }
  split.
  - intros e I. destruct (MEAS e I) as (o & i & o' & i' & t & t' & a & b & N & IA & IB & M & S).
    exists o, i, o', i'. split; [split; [assumption|]; split; [eauto|]|].
    + intros j j' u u' MU.
      destruct (measured_items s reach f A _ _ _ _ _ _ MU) as (c & c' & I1 & I2 & J1 & J2 & C & SH).
      assert (O : obj c = object_a (nearest e) /\ obj c' = object_b (nearest e)).
      { destruct J1 as (? & _ & _ & _ & ->), J2 as (? & _ & _ & _ & ->), N as (N1 & N2 & N3 & N4). cbn. auto. }
      destruct O as [O1 O2].
      assert (SA : shape c = map_triangle (scaled f) u) by (destruct J1 as (? & _ & _ & _ & ->); reflexivity).
      assert (SB : shape c' = map_triangle (scaled f) u') by (destruct J2 as (? & _ & _ & _ & ->); reflexivity).
      apply (at_least_value f); auto.
      { destruct J1 as (? & _ & _ & X & _). exact X. }
      { destruct J2 as (? & _ & _ & X & _). exact X. }
      rewrite <- SA, <- SB.
      destruct (left_out s reach f A es least D c c' I1 I2 C) as [P | P].
      * pose proof (find_none _ _ FAR _ P) as H. apply negb_false_iff in H. unfold is_far in H.
        rewrite SH in H. rewrite (once_find es ONCE e) in H by (auto; apply is_for_sound; auto).
        apply is_at_least_sound; [apply denominator_positive | exact H].
      * destruct (root_above_sound (numerator f (squared e)) (denominator (squared e))
                    (denominator_positive _)) as [R0 R].
        pose proof (proj2 (reach_for_all f es c least) e I (eq_sym O1)) as RL.
        intros p q IP IQ.
        set (r := reach_for f es least c) in *. set (r0 := root_above _ _) in *.
        assert (B : #r * #r < squared_distance p q).
        { apply Qnot_le_lt. intros Y. apply P. exists p, q. auto. }
        assert (RR : (numerator f (squared e) <= denominator (squared e) * (r * r))%Z).
        { pose proof (denominator_positive (squared e)). assert (r0 * r0 <= r * r)%Z by nia.
          etransitivity; [exact R|]. apply Z.mul_le_mono_nonneg_l; lia. }
        apply -> inject_le in RR. inject. assert (M0 : 0 < #(denominator (squared e))) by reflexivity.
        assert (0 <= #(denominator (squared e)) * (squared_distance p q - #r * #r))
          by (apply Qmult_le_0_compat; lra). lra.
    + intros w E. destruct (W w E) as (LW & EW & _). specialize (CLOSE e I). unfold is_close in CLOSE.
      rewrite EW in CLOSE. apply Z.leb_le in CLOSE. apply -> inject_le in CLOSE. inject.
      pose proof (square_scaled f (squared e) F) as Q. rewrite (value_scaled f w LW).
      set (k := 2 ^ f) in *. set (m := #(denominator (squared e))) in *.
      assert (M0 : 0 < m) by reflexivity. apply (Qmult_le_l _ _ m M0).
      setoid_replace (m * squared e) with (k * k * #(numerator f (squared e))) by (rewrite <- Q; ring).
      setoid_replace (m * (k * #(scaled f w) * (k * #(scaled f w))))
        with (k * k * (m * (#(scaled f w) * #(scaled f w)))) by ring.
      pose proof (power_positive f). apply Qmult_le_l; [fold k in H; nra | assumption].
  - intros o i o' i' t t' M NEAR.
    destruct (measured_items s reach f A _ _ _ _ _ _ M) as (a & b & I1 & I2 & J1 & J2 & C & SH).
    assert (G : forall e, In e es -> is_for (obj a) (obj b) e = true ->
                exists e j j', In e es /\ names (nearest e) o j o' j').
    { intros e I E. destruct (MEAS e I) as (u & j & u' & j' & ? & ? & ? & ? & N & _).
      exists e, j, j'. split; [assumption|]. apply is_for_sound in E. destruct E as [E1 E2].
      destruct J1 as (? & _ & _ & _ & ->), J2 as (? & _ & _ & _ & ->), N as (N1 & N2 & N3 & N4).
      cbn in E1, E2. unfold names. rewrite E1, E2. auto. }
    destruct within as [w|] eqn:EW.
    + destruct (W w eq_refl) as (LW & ED & EL). specialize (NEAR w eq_refl).
      assert (NI : near #(scaled f w) (qtri (shape a)) (qtri (shape b))).
      { destruct J1 as (? & _ & _ & X & ->), J2 as (? & _ & _ & Y & ->). cbn [shape make_item corners].
        apply (near_sized (/ 2 ^ f) _ (value w) _ (map_triangle value t) _ (map_triangle value t'));
          auto using inverse_positive, power_positive.
        - rewrite (value_scaled f w LW). field. pose proof (power_positive f). lra.
        - apply sized_inverse; auto using power_positive, sized_value.
        - apply sized_inverse; auto using power_positive, sized_value. }
      destruct (left_out s reach f A es least D a b I1 I2 C) as [P | P].
      * pose proof (find_none _ _ FAR _ P) as H. apply negb_false_iff in H. unfold is_far in H.
        rewrite SH in H. destruct (List.find (is_for (obj a) (obj b)) es) as [e|] eqn:FI.
        -- apply find_some in FI. destruct FI as [IE X]. exact (G e IE X).
        -- rewrite ED in H. apply separated_sound in H. contradiction.
      * exfalso. apply P. destruct NI as (p & q & IP & IQ & L). exists p, q. split; [assumption|].
        split; [assumption|]. pose proof (proj1 (reach_for_all f es a least)) as R. rewrite EL in R, D.
        assert (RR : (scaled f w * scaled f w <= reach_for f es (scaled f w) a * reach_for f es (scaled f w) a)%Z) by nia.
        rewrite EL. apply -> inject_le in RR. inject. lra.
    + unfold d in GIVEN. unfold all_given in GIVEN. apply andb_prop in GIVEN. destruct GIVEN as [G1 G2].
      destruct (Z.eq_dec (obj a) (obj b)) as [E | E].
      * rewrite forallb_forall in G2. specialize (G2 a I1). apply orb_prop in G2.
        destruct G2 as [G2 | G2].
        -- apply orb_prop in G2. destruct G2 as [G2 | G2].
           ++ apply negb_true_iff in G2. unfold comes_before in C. rewrite E, Z.ltb_irrefl, G2 in C.
              rewrite andb_false_r in C. discriminate.
           ++ apply existsb_exists in G2. destruct G2 as (e & IE & X). rewrite <- E in G. exact (G e IE X).
        -- rewrite forallb_forall in G2. specialize (G2 b I2). rewrite C, E, Z.eqb_refl, SH in G2. discriminate.
      * assert (LT : (obj a < obj b)%Z).
        { unfold comes_before in C. apply orb_prop in C. destruct C as [C | C]; tests; [assumption | congruence]. }
        destruct (proj2 (first_items_all items []) a I1) as (a0 & A0 & EA).
        destruct (proj2 (first_items_all items []) b I2) as (b0 & B0 & EB).
        rewrite forallb_forall in G1. specialize (G1 a0 A0). rewrite forallb_forall in G1.
        specialize (G1 b0 B0). apply orb_prop in G1. destruct G1 as [G1 | G1].
        -- apply negb_true_iff, Z.ltb_ge in G1. lia.
        -- apply existsb_exists in G1. destruct G1 as (e & IE & X). rewrite EA, EB in X. exact (G e IE X).
Qed.

Set Printing Width 90.
Check accepted_distances_are_right.
Print Assumptions accepted_distances_are_right.
