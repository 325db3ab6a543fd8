(** What the checker of distances shows about two triangles and about all pairs. Nearest.v has the theorem. *)
From Coq Require Import ZArith NArith QArith Qpower Lqa Lia List Bool Setoid Morphisms.
Require Import Spec Checker InsideChecker DistanceChecker Geometry Points Pairs Scaling Proofs Inside.
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
(** The square n / m is at most s; [strict]: less. *)
Definition at_most (strict : bool) (n m s : Q) : Prop := if strict then n < m * s else n <= m * s.
Definition far_squares (strict : bool) (n m : Z) (a b : triangle Z) : Prop :=
  forall p q, inside (qtri a) p -> inside (qtri b) q -> at_most strict #n #m (squared_distance p q).

Lemma keeps_off_sound strict n m a b d : (0 < m)%Z -> keeps_off strict n m a b d = true ->
  far_squares strict n m a b.
Proof.
  unfold keeps_off, gap_along. cbv zeta. intros M H p q A B. apply andb_prop in H. destruct H as [P L]. apply Z.ltb_lt in P.
  set (g1 := (min3 (dot d (p1 b)) _ _ - _)%Z) in *. set (g2 := (min3 (dot d (p1 a)) _ _ - _)%Z) in *.
  assert (G : forall g, (0 < g)%Z ->
    (if strict then (n * dot d d <? m * (g * g))%Z else (n * dot d d <=? m * (g * g))%Z) = true ->
    #g * #g <= #(dot d d) * squared_distance p q -> at_most strict #n #m (squared_distance p q)).
  { clear - M. intros g G L C. apply -> inject_lt in M. apply -> inject_lt in G. change #0 with 0 in *.
    pose proof (dot_positive d) as P. set (s := squared_distance p q) in *.
    assert (GG : 0 < #g * #g) by nra.
    assert (DD : 0 < #(dot d d)).
    { destruct (Qlt_le_dec 0 #(dot d d)) as [Y | Y]; [assumption|].
      assert (E : #(dot d d) == 0) by lra. rewrite E in C. lra. }
    assert (X : 0 <= #m * (#(dot d d) * s - #g * #g)) by (apply Qmult_le_0_compat; lra).
    unfold at_most. destruct strict; tests.
    - apply -> inject_lt in L. inject. apply (Qmult_lt_l _ _ _ DD). lra.
    - apply -> inject_le in L. inject. apply (Qmult_le_l _ _ _ DD). lra. }
  destruct (Z.max_spec g1 g2) as [[_ E] | [_ E]]; rewrite E in *.
  - apply (G g2); auto. rewrite squared_swap. now apply (gap_below d b a g2).
  - apply (G g1); auto. now apply (gap_below d a b g1).
Qed.
Lemma is_at_least_sound strict n m a b : (0 < m)%Z -> is_at_least strict n m a b = true ->
  far_squares strict n m a b.
Proof.
  unfold is_at_least. intros M H. apply orb_prop in H. destruct H as [H | H].
  - destruct strict; [discriminate|]. cbn [negb andb] in H. apply Z.leb_le in H. intros p q _ _.
    apply -> inject_le in H. apply -> inject_lt in M. change #0 with 0 in *. unfold at_most.
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
Lemma at_least_value strict : far_squares strict (numerator f q) (denominator q) a b ->
  forall p r, inside (exact t) p -> inside (exact t') r ->
  if strict then q < squared_distance p r else q <= squared_distance p r.
Proof.
  intros S p r P R. pose proof (power_positive f) as K.
  pose proof (sized_value f t T) as A. pose proof (sized_value f t' T') as B.
  pose proof (inside_sized _ _ _ _ (sized_inverse _ _ _ K A) P) as P'.
  pose proof (inside_sized _ _ _ _ (sized_inverse _ _ _ K B) R) as R'.
  specialize (S _ _ P' R'). unfold at_most in S.
  pose proof (square_scaled f q F) as E. set (k := 2 ^ f) in *.
  set (m := #(denominator q)) in *. set (n := #(numerator f q)) in *.
  assert (M : 0 < m) by reflexivity.
  assert (KN : ~ k == 0) by lra.
  assert (KK : 0 < k * k) by nra.
  assert (L : k * k * (m * squared_distance (times (/ k) p) (times (/ k) r)) == m * squared_distance p r)
    by (rewrite squared_sized; field; assumption).
  destruct strict.
  - apply (Qmult_lt_l _ _ (k * k) KK) in S. rewrite L, <- E in S. apply (Qmult_lt_l _ _ m M). lra.
  - apply (Qmult_le_l _ _ (k * k) KK) in S. rewrite L, <- E in S. apply (Qmult_le_l _ _ m M). lra.
Qed.
Lemma at_most_value : near_squares (numerator f q) (denominator q) a b ->
  exists p r, inside (exact t) p /\ inside (exact t') r /\ squared_distance p r <= q.
Proof.
  intros (p & r & P & R & L). pose proof (power_positive f) as K.
  pose proof (inside_sized _ _ _ _ (sized_value f t T) P) as P'.
  pose proof (inside_sized _ _ _ _ (sized_value f t' T') R) as R'.
  exists (times (2 ^ f) p), (times (2 ^ f) r). split; [assumption|]. split; [assumption|].
  rewrite squared_sized. pose proof (square_scaled f q F) as E. set (k := 2 ^ f) in *.
  set (m := #(denominator q)) in *. set (n := #(numerator f q)) in *.
  assert (M : 0 < m) by reflexivity. set (s := squared_distance p r) in *.
  assert (KK : 0 < k * k) by nra. apply (Qmult_le_l _ _ m M).
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
Lemma reach_for_all f picks es : forall w, (w <= reach_for f picks es w)%Z /\
  forall e, In e es -> picks e = true ->
    (root_above (numerator f (squared e)) (denominator (squared e)) <= reach_for f picks es w)%Z.
Proof.
  unfold reach_for. induction es as [|e es IH]; intros w; cbn [fold_left]; [split; [lia | intros ? []]|].
  set (w' := if picks e then _ else w).
  assert (W : (w <= w')%Z) by (unfold w'; destruct (picks e); lia).
  destruct (IH w') as [L A]. split; [lia|]. intros e' [<- | I] O; [|auto].
  unfold w' in L at 1. rewrite O in L. lia.
Qed.
(** Points that are farther apart than a reach are farther apart than each square it was made of. *)
Lemma beyond_root f q t t' r : (f <= 0)%Z -> at_most_triangle f t -> at_most_triangle f t' ->
  (root_above (numerator f q) (denominator q) <= r)%Z ->
  ~ near #r (qtri (map_triangle (scaled f) t)) (qtri (map_triangle (scaled f) t')) ->
  forall p p', inside (exact t) p -> inside (exact t') p' -> q < squared_distance p p'.
Proof.
  intros F T T' R N p p' P P'. apply (at_least_value f q t t' F T T' true); auto.
  intros c c' C C'. unfold at_most.
  destruct (root_above_sound (numerator f q) (denominator q) eq_refl) as [R0 RR].
  set (n := numerator f q) in *. set (m := denominator q) in *. set (r0 := root_above n m) in *.
  assert (M : (0 < m)%Z) by reflexivity.
  assert (B : #r * #r < squared_distance c c').
  { apply Qnot_le_lt. intros Y. apply N. exists c, c'. auto. }
  assert (Y : (n <= m * (r * r))%Z).
  { assert (r0 * r0 <= r * r)%Z by nia. etransitivity; [exact RR|]. apply Z.mul_le_mono_nonneg_l; lia. }
  apply -> inject_le in Y. apply -> inject_lt in M. inject. change #0 with 0 in M.
  assert (#m * (#r * #r) < #m * squared_distance c c') by (apply Qmult_lt_l; assumption). lra.
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
  (has_no_shared a b = true <-> ~ are_neighbours s o i o' i').
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
  rewrite <- E. unfold has_no_shared, name_of, row_of. cbn [neighbours].
  destruct (shared_of a b); split; congruence.
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
  comes_before a b = true /\ has_no_shared a b = true.
Proof.
  intros (Q & N & (ob & O & I) & (ob' & O' & I')).
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
Lemma left_out r a b : (forall c, 0 <= r c)%Z -> In a items -> In b items -> comes_before a b = true ->
  In (a, b) (pairs (fun _ _ => true) r items) \/ ~ near #(r a) (qtri (shape a)) (qtri (shape b)).
Proof.
  intros R I I' C. destruct (candidate (grow (r a) a) b) eqn:G.
  - left. apply pairs_all. auto.
  - right. apply items_are in I, I'. specialize (R a). destruct I as (o & i & t & ob & _ & _ & _ & E).
    destruct I' as (o' & i' & t' & ob' & _ & _ & _ & E').
    apply (far_boxes _ (r a)); [assumption | lia|].
    apply not_true_iff_false. intros V. apply not_true_iff_false in G. apply G.
    apply grow_candidate. split; [assumption|]. rewrite E, E' in V |- *. exact V.
Qed.
(** An entry names its pair, and the square is right. *)
Lemma measures_sound a b e : In a items -> In b items -> measures f e a b = true ->
  exists o i o' i' t t', names (nearest e) o i o' i' /\ is_item a o i t /\ is_item b o' i' t' /\
    measured s o i o' i' t t' /\
    (forall p r, inside (exact t) p -> inside (exact t') r -> squared e <= squared_distance p r) /\
    exists p r, inside (exact t) p /\ inside (exact t') r /\ squared_distance p r == squared e.
Proof.
  intros IA IB M. unfold measures in M. cbv zeta in M. tests.
  apply items_are in IA, IB. destruct IA as (o & i & t & IA), IB as (o' & i' & t' & IB).
  exists o, i, o', i', t, t'.
  assert (N : names (nearest e) o i o' i').
  { destruct IA as (? & _ & _ & _ & ->), IB as (? & _ & _ & _ & ->). cbn in *. unfold names. auto. }
  split; [assumption|]. split; [assumption|]. split; [assumption|].
  assert (X : at_most_triangle f t) by (destruct IA as (? & _ & _ & X & _); exact X).
  assert (Y : at_most_triangle f t') by (destruct IB as (? & _ & _ & Y & _); exact Y).
  assert (SA : shape a = map_triangle (scaled f) t) by (destruct IA as (? & _ & _ & _ & ->); reflexivity).
  assert (SB : shape b = map_triangle (scaled f) t') by (destruct IB as (? & _ & _ & _ & ->); reflexivity).
  split.
  { repeat split.
    - eapply (item_before a b); eauto.
    - eapply (item_neighbours a b); eauto.
    - destruct IA as (ob & O & T & _). exists ob. auto.
    - destruct IB as (ob & O & T & _). exists ob. auto. }
  rewrite SA, SB in *.
  assert (L : forall p r, inside (exact t) p -> inside (exact t') r -> squared e <= squared_distance p r).
  { apply (at_least_value f (squared e) t t' F X Y false). apply is_at_least_sound; [reflexivity | assumption]. }
  split; [exact L|].
  destruct (at_most_value f (squared e) t t' F X Y) as (p & r & P & R & U); [now apply is_at_most_sound|].
  exists p, r. split; [assumption|]. split; [assumption|]. apply Qle_antisym; auto.
Qed.
(** Within the limit. *)
Lemma is_close_sound w e : (f <= exponent w)%Z -> is_close f (Some (scaled f w)) e = true ->
  squared e <= value w * value w.
Proof.
  unfold is_close. intros LW C. apply Z.leb_le in C. apply -> inject_le in C. inject.
  pose proof (square_scaled f (squared e) F) as Q. rewrite (value_scaled f w LW).
  set (k := 2 ^ f) in *. set (m := #(denominator (squared e))) in *.
  assert (M0 : 0 < m) by reflexivity. apply (Qmult_le_l _ _ m M0).
  setoid_replace (m * squared e) with (k * k * #(numerator f (squared e))) by (rewrite <- Q; ring).
  setoid_replace (m * (k * #(scaled f w) * (k * #(scaled f w))))
    with (k * k * (m * (#(scaled f w) * #(scaled f w)))) by ring.
  pose proof (power_positive f). apply Qmult_le_l; [fold k in H; nra | assumption].
Qed.
(** A pair beyond the limit, scaled or not. *)
Lemma near_value w a b o i o' i' t t' : (f <= exponent w)%Z -> is_item a o i t -> is_item b o' i' t' ->
  near (value w) (exact t) (exact t') -> near #(scaled f w) (qtri (shape a)) (qtri (shape b)).
Proof.
  intros LW (? & _ & _ & X & ->) (? & _ & _ & Y & ->) N. cbn [shape make_item corners].
  apply (near_sized (/ 2 ^ f) _ (value w) _ (exact t) _ (exact t'));
    auto using inverse_positive, power_positive.
  - rewrite (value_scaled f w LW). field. pose proof (power_positive f). lra.
  - apply sized_inverse; auto using power_positive, sized_value.
  - apply sized_inverse; auto using power_positive, sized_value.
Qed.
Lemma word_sound q e o i o' i' : has_right_word q items e = true -> names (nearest e) o i o' i' ->
  right_word s (says e) o o'.
Proof.
  unfold has_right_word. intros H (N1 & _ & N2 & _). apply orb_prop in H. destruct H as [H | H].
  - unfold is_unsaid in H. destruct (says e); try discriminate. exact I.
  - apply andb_prop in H. destruct H as [_ H]. rewrite N1, N2 in H.
    now apply (is_said_rightly_sound s reach f A).
Qed.
End Scene.

(** * All triangles *)
Lemma all_triangles_sound f d l : forall es, all_triangles f d l es = None ->
  (forall e, In e es -> exists a b, In (a, b) l /\ measures f e a b = true) /\
  (forall a b, In (a, b) l -> (exists e, In e es /\ is_named a b e = true) \/
     has_no_shared a b = false \/ separated d (shape a) (shape b) = true).
Proof.
  induction l as [|[a b] l IH]; intros es H; destruct es as [|e es]; cbn [all_triangles] in H; try discriminate.
  - split; [intros ? [] | intros ? ? []].
  - destruct (negb _ || _)%bool eqn:X; [|discriminate]. destruct (IH _ H) as [_ I2].
    split; [intros ? []|]. intros a' b' [E | J]; [|destruct (I2 _ _ J) as [(? & [] & _) | Y]; auto].
    injection E as <- <-. right. apply orb_prop in X. rewrite negb_true_iff in X. exact X.
  - destruct (is_named a b e) eqn:N.
    + destruct (measures f e a b) eqn:M; [|discriminate]. destruct (IH _ H) as [I1 I2]. split.
      * intros e' [<- | J]; [exists a, b; simpl; auto|]. destruct (I1 _ J) as (a' & b' & P & Q).
        exists a', b'. simpl. auto.
      * intros a' b' [E | J]; [injection E as <- <-; left; exists e; simpl; auto|].
        destruct (I2 _ _ J) as [(e' & K & L) | Y]; [left; exists e'; simpl; auto | auto].
    + destruct (negb _ || _)%bool eqn:X; [|discriminate]. destruct (IH _ H) as [I1 I2]. split.
      * intros e' J. destruct (I1 _ J) as (a' & b' & P & Q). exists a', b'. simpl. auto.
      * intros a' b' [E | J]; [|auto]. injection E as <- <-. right. apply orb_prop in X.
        rewrite negb_true_iff in X. exact X.
Qed.
