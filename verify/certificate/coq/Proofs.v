(** The theorem: a list that the checker accepts is right and complete. *)
From Coq Require Import ZArith NArith QArith Qpower Lqa Lia List Bool Setoid Morphisms.
Require Import Spec Checker Geometry Points Descent Pairs.
Import ListNotations.
Open Scope Q_scope.

(** * The decision of a pair is right *)
Lemma decide_sound (one : Prop) first D shared a b k :
  (one -> shared = shared_corners a b) -> (~ one -> shared = []) -> one \/ ~ one ->
  decide first D shared a b = Some k -> (k = Meeting <-> count #D one (qtri a) (qtri b)).
Proof.
  intros S1 S0 DEC H.
  assert (none : shared = [] -> ~ (one /\ exists c, is_shared (qtri a) (qtri b) c)).
  { intros E (Y & c & C). rewrite (S1 Y) in E. apply is_shared_corners in C.
    destruct C as (k' & C & _). rewrite E in C. destruct C. }
  set (common := (match shared with [] => (0 <? D)%Z && has_near D a b | _ => false end ||
                  has_common (off_shared shared) a b)%bool) in *.
  assert (M : common = true -> count #D one (qtri a) (qtri b)).
  { unfold common. intros C. apply orb_prop in C. destruct C as [C | C].
    - right. destruct shared; [|discriminate]. apply andb_prop in C. destruct C as [_ C].
      split; [now apply has_near_sound | now apply none].
    - left. apply has_common_sound in C. destruct C as (q & m & M & G & A & B).
      exists (over q m). repeat split; auto. intros O. rewrite (S1 O) in G.
      now apply off_shared_sound. }
  assert (N : forall k', (match shared with
      | [] => if separated D a b then Some Separated else None
      | _ => if only_shared 7 a b shared indices indices then Some Only_shared else None
      end) = Some k' -> k' <> Meeting /\ ~ count #D one (qtri a) (qtri b)).
  { intros k' E. destruct shared as [|c shared].
    - destruct (separated D a b) eqn:F; [|discriminate]. injection E as <-. split; [discriminate|].
      apply separated_sound in F. intros [(p & A & B & _) | [G _]]; apply F; [|assumption].
      eapply near_of_common; eauto.
    - destruct (only_shared 7 a b (c :: shared) indices indices) eqn:F; [|discriminate].
      injection E as <-. split; [discriminate|].
      destruct DEC as [Y | Y]; [|discriminate (S0 Y)]. specialize (S1 Y).
      intros [(p & A & B & O) | [_ G]].
      + apply (O Y). rewrite S1 in F. eapply only_shared_sound; eauto.
      + apply G. split; [assumption|]. exists (qvec c). apply is_shared_corners. exists c.
        rewrite <- S1. split; [now left | apply same_refl]. }
  unfold decide in H. cbv beta zeta in H. fold common in H. clearbody common.
  set (apart := match shared with [] => _ | _ => _ end) in *.
  destruct common eqn:C, apart as [k'|] eqn:E, first;
    try discriminate; injection H as <-;
    try (destruct (N _ eq_refl) as [N1 N2]; split; [now intros ->|now intros]);
    try (split; [intros _; auto | reflexivity]).
Qed.

Definition items_count (D : Z) (a b : item) : Prop :=
  count #D (obj a = obj b) (qtri (shape a)) (qtri (shape b)).
Lemma shared_of_cases a b :
  (obj a = obj b -> shared_of a b = shared_corners (shape a) (shape b)) /\
  (obj a <> obj b -> shared_of a b = []).
Proof. unfold shared_of. destruct (Z.eqb_spec (obj a) (obj b)); split; intros; tauto. Qed.
Lemma judge_sound D a b e k f :
  judge D a b e = Some (k, f) ->
  (k = Meeting <-> items_count D a b) /\ (f = Said_to_meet -> k <> Meeting) /\
  (f = Culled_meets \/ f = Said_disjoint -> k = Meeting).
Proof.
  unfold judge. destruct (shared_of_cases a b) as [S1 S0].
  set (by_claim := match shared_of a b with [] => _ | _ => _ end).
  set (n := match shared_of a b with [] => false | _ => true end).
  set (first := match claimed e with Meets => true | _ => false end).
  assert (F : forall k, (find e by_claim n k = Said_to_meet -> k <> Meeting) /\
            (find e by_claim n k = Culled_meets \/ find e by_claim n k = Said_disjoint -> k = Meeting)).
  { intros k'. unfold find. split; [intros E -> | intros E].
    - destruct (kept e), (claimed e), n; discriminate.
    - destruct k'; [| | reflexivity]; destruct (claimed e), by_claim; destruct E; discriminate. }
  destruct (if by_claim then Some Separated else _) as [k'|] eqn:G; [|discriminate].
  intros E. assert (k = k' /\ f = find e by_claim n k') as [-> ->] by (split; congruence).
  split; [|apply F]. clear E F. destruct by_claim eqn:B; subst by_claim.
  - assert (k' = Separated) as -> by congruence. split; [discriminate|]. intros C. exfalso.
    destruct (shared_of a b), (claimed e); try discriminate. apply separates_sound in B. apply B.
    destruct C as [(p & I & J & _) | [C _]]; [eapply near_of_common; eauto | assumption].
  - apply (decide_sound (obj a = obj b)) in G; auto. destruct (Z.eq_dec (obj a) (obj b)); auto.
Qed.

(** * All pairs *)
Lemma judge_all_proved D s c l : forall es t rs, judge_all D s c l es t = Proved rs ->
  forall r, In r rs <->
    In r (rows t) \/ exists a b, In (a, b) l /\ r = name_of a b /\ items_count D a b.
Proof.
  induction l as [|[a b] l IH]; intros es t rs H r; destruct es as [|e es]; cbn [judge_all] in H;
    try discriminate.
  - destruct (refuting t) as [[? ?]|]; [discriminate|]. destruct (weak t) as [[? ?]|]; [discriminate|].
    destruct (counts_are c s t); [|discriminate]. injection H as <-.
    rewrite rev_append_rev, app_nil_r, <- in_rev. split; [auto|].
    intros [R | (a & b & [] & _)]. assumption.
  - destruct (judge D a b e) as [[k f]|] eqn:J; [|discriminate].
    apply judge_sound in J. destruct J as [J _]. rewrite (IH _ _ _ H). unfold enter. cbn [rows].
    assert (K : is_kind k Meeting = true <-> items_count D a b).
    { rewrite <- J. destruct k; simpl; split; congruence. }
    destruct (is_kind k Meeting); split.
    + intros [[<- | R] | (a' & b' & P & R)]; [right | auto | right].
      * exists a, b. simpl. tauto.
      * exists a', b'. simpl. tauto.
    + intros [R | (a' & b' & [E | P] & -> & M)]; [simpl; auto | | right; eauto].
      injection E as -> ->. simpl. auto.
    + intros [R | (a' & b' & P & R)]; [auto | right]. exists a', b'. simpl. tauto.
    + intros [R | (a' & b' & [E | P] & -> & M)]; [auto | | right; eauto].
      injection E as -> ->. apply K in M. discriminate.
Qed.
Lemma judge_all_refuted D s c l : forall es t r f, judge_all D s c l es t = Refuted r f ->
  refuting t = Some (r, f) \/ exists a b, In (a, b) l /\ r = name_of a b /\
    (f = Said_to_meet /\ ~ items_count D a b \/
     (f = Culled_meets \/ f = Said_disjoint) /\ items_count D a b).
Proof.
  induction l as [|[a b] l IH]; intros es t r f H; destruct es as [|e es]; cbn [judge_all] in H;
    try discriminate.
  - destruct (refuting t) as [[? ?]|]; [left; congruence|]. destruct (weak t) as [[? ?]|]; [discriminate|].
    destruct (counts_are c s t); discriminate.
  - destruct (judge D a b e) as [[k g]|] eqn:J; [|discriminate].
    apply judge_sound in J. destruct J as (J & J1 & J2).
    destruct (IH _ _ _ _ H) as [R | (a' & b' & P & R)].
    + unfold enter in R. cbn [refuting] in R. unfold note in R.
      destruct (refuting t) as [[r' f']|]; [left; assumption|]. right.
      destruct (refutes g) eqn:G; [|discriminate]. injection R as <- <-.
      exists a, b. simpl. repeat split; auto. destruct g; try discriminate; rewrite <- J; auto.
    + right. exists a', b'. simpl. tauto.
Qed.

(** * From doubles to integers: one power of two does not matter *)
Definition sized (k : Q) (t t' : triangle Q) : Prop :=
  same (p1 t) (times k (p1 t')) /\ same (p2 t) (times k (p2 t')) /\ same (p3 t) (times k (p3 t')).
Ltac coordinates :=
  unfold sized, same, mix, plus, times in *; cbn [x y z] in *;
  repeat match goal with H : _ /\ _ |- _ => destruct H end.
Lemma sized_inverse k t t' : 0 < k -> sized k t t' -> sized (/ k) t' t.
Proof.
  intros K S. assert (N : ~ k == 0) by lra. coordinates.
  repeat split;
    match goal with |- ?a == _ * ?b => match goal with E : b == _ |- _ => rewrite E; field; assumption end end.
Qed.
Lemma inside_sized k t t' p : sized k t t' -> inside t' p -> inside t (times k p).
Proof.
  intros S (u & v & w & U & V & W & T & P). exists u, v, w. repeat split; auto; coordinates;
  match goal with |- _ * ?c == _ => match goal with E : c == _ |- _ => rewrite E end end;
  repeat match goal with H : _ == k * _ |- _ => rewrite H; clear H end; ring.
Qed.
Lemma corner_sized k t t' c : sized k t t' -> is_corner t' c -> is_corner t (times k c).
Proof.
  intros S [H | [H | H]]; [left | right; left | right; right]; coordinates; repeat split;
  match goal with |- _ * ?c == _ => match goal with E : c == _ |- _ => rewrite E end end;
  repeat match goal with H : _ == k * _ |- _ => rewrite H; clear H end; reflexivity.
Qed.
Lemma shared_part_sized k a a' b b' p : sized k a a' -> sized k b b' ->
  in_shared_part a' b' p -> in_shared_part a b (times k p).
Proof.
  intros A B (c & d & [CA CB] & [DA DB] & (t & T0 & T1 & P)).
  exists (times k c), (times k d). split; [split; eapply corner_sized; eauto|].
  split; [split; eapply corner_sized; eauto|]. exists t. repeat split; auto; coordinates;
  match goal with |- _ * ?c == _ => match goal with E : c == _ |- _ => rewrite E end end; ring.
Qed.
Lemma in_shared_part_same a b p q : same p q -> in_shared_part a b p -> in_shared_part a b q.
Proof.
  intros E (c & d & C & D & S). exists c, d. repeat split; try apply C; try apply D.
  eapply on_segment_same; eauto.
Qed.
Lemma times_inverse k p : 0 < k -> same (times (/ k) (times k p)) p.
Proof. intros K. assert (~ k == 0) by lra. coordinates. repeat split; field; assumption. Qed.
Lemma meet_sized one k a a' b b' : 0 < k -> sized k a a' -> sized k b b' ->
  meet one a' b' -> meet one a b.
Proof.
  intros K A B (p & PA & PB & O). exists (times k p).
  split; [eapply inside_sized; eauto|]. split; [eapply inside_sized; eauto|].
  intros Y S. apply (O Y). eapply in_shared_part_same; [apply (times_inverse k); assumption|].
  eapply shared_part_sized; [| |exact S]; now apply sized_inverse.
Qed.
Lemma squared_sized k p q : squared_distance (times k p) (times k q) == k * k * squared_distance p q.
Proof. unfold squared_distance, times. cbn [x y z]. ring. Qed.
Lemma near_sized k d d' a a' b b' : 0 < k -> d == k * d' -> sized k a a' -> sized k b b' ->
  near d' a' b' -> near d a b.
Proof.
  intros K E A B (p & q & P & Q & L). exists (times k p), (times k q).
  split; [eapply inside_sized; eauto|]. split; [eapply inside_sized; eauto|].
  rewrite squared_sized, E.
  assert (0 <= k * k * (d' * d' - squared_distance p q)) by (apply Qmult_le_0_compat; [apply square | lra]).
  lra.
Qed.
Lemma inverse_positive k : 0 < k -> 0 < / k.
Proof. apply Qinv_lt_0_compat. Qed.
Lemma shared_sized k a a' b b' : 0 < k -> sized k a a' -> sized k b b' ->
  (exists c, is_shared a b c) <-> (exists c, is_shared a' b' c).
Proof.
  intros K A B. split; intros (c & C & D).
  - exists (times (/ k) c). split.
    + apply (corner_sized (/ k) a' a); auto using sized_inverse.
    + apply (corner_sized (/ k) b' b); auto using sized_inverse.
  - exists (times k c). split; eapply corner_sized; eauto.
Qed.
Lemma count_sized k d d' one a a' b b' : 0 < k -> d == k * d' -> sized k a a' -> sized k b b' ->
  (count d one a b <-> count d' one a' b').
Proof.
  intros K E A B. unfold count. rewrite (shared_sized k a a' b b') by assumption.
  assert (E' : d' == / k * d) by (rewrite E; field; lra).
  split; (intros [M | [N S]]; [left | right; split; [|exact S]]).
  - apply (meet_sized one (/ k) a' a b' b); auto using inverse_positive, sized_inverse.
  - apply (near_sized (/ k) d' d a' a b' b); auto using inverse_positive, sized_inverse.
  - now apply (meet_sized one k a a' b b').
  - now apply (near_sized k d d' a a' b b').
Qed.

Lemma power_positive e : 0 < 2 ^ e.
Proof. apply Qpower_0_lt. reflexivity. Qed.
Lemma value_scaled e d : (e <= exponent d)%Z -> value d == 2 ^ e * #(scaled e d).
Proof.
  intros L. unfold value, scaled. rewrite N.shiftl_1_l, N2Z.inj_pow, Z2N.id by lia. simpl Z.of_N.
  rewrite inject_Z_mult, Zpower_Qpower by lia. change #2 with 2.
  setoid_replace (2 ^ exponent d) with (2 ^ e * 2 ^ (exponent d - e)); [ring|].
  rewrite <- Qpower_plus by discriminate. now replace (e + (exponent d - e))%Z with (exponent d) by lia.
Qed.
Lemma sized_value e t : at_most_triangle e t ->
  sized (2 ^ e) (map_triangle value t) (qtri (map_triangle (scaled e) t)).
Proof.
  intros ((A & B & C) & (A' & B' & C') & (A'' & B'' & C'')).
  unfold sized, same, times, qtri, map_triangle, map_vec. cbn [x y z p1 p2 p3].
  repeat split; now apply value_scaled.
Qed.
Lemma count_value s e d o i o' i' t t' one : (lowest s e <= exponent d)%Z ->
  is_triangle s o i t -> is_triangle s o' i' t' ->
  count (value d) one (map_triangle value t) (map_triangle value t') <->
  count #(scaled (lowest s e) d) one (qtri (map_triangle (scaled (lowest s e)) t))
        (qtri (map_triangle (scaled (lowest s e)) t')).
Proof.
  intros L T T'. apply (count_sized (2 ^ lowest s e)); auto using power_positive, value_scaled.
  - apply sized_value. eapply lowest_sound, T.
  - apply sized_value. eapply lowest_sound, T'.
Qed.

Lemma count_prop d P P' a b : (P <-> P') -> count d P a b -> count d P' a b.
Proof.
  intros E [(p & A & B & O) | [N S]]; [left; exists p | right]; tauto.
Qed.

(** * The answer in terms of what the checker enumerates *)
Section Scene.
Variables (s : scene) (clearance reach : double) (less : bool).
Let e := lower (lower 0 clearance) reach.
Let f := lowest s e.
Let D := scaled f clearance.
Let r := (scaled f reach - (if less then 1 else 0))%Z.
Context (D_positive : (0 <= D)%Z).
Context (D_reached : (D <= r)%Z).

Lemma exponent_of_clearance : (f <= exponent clearance)%Z.
Proof. pose proof (proj1 (lowest_all s e)) as L. fold f in L. unfold e, lower in L. lia. Qed.

Lemma answer_pairs o i o' i' : answer s clearance o i o' i' <->
  exists a b, In (a, b) (pairs e r s) /\ names (name_of a b) o i o' i' /\ items_count D a b.
Proof.
  pose proof exponent_of_clearance as L. split.
  - intros (Q & t & t' & T & T' & M). pose proof T as (ob & O & I). pose proof T' as (ob' & O' & I').
    exists (make_item f (Z.of_nat o) (Z.of_nat i) (self ob) t),
           (make_item f (Z.of_nat o') (Z.of_nat i') (self ob') t').
    assert (IM : items_count D (make_item f (Z.of_nat o) (Z.of_nat i) (self ob) t)
                               (make_item f (Z.of_nat o') (Z.of_nat i') (self ob') t')).
    { unfold items_count. cbn [obj shape make_item].
      apply (proj1 (count_value s e clearance o i o' i' t t' _ L T T')) in M.
      apply (count_prop _ (o = o')); [now rewrite Nat2Z.inj_iff | exact M]. }
    split; [|split; [repeat split | exact IM]].
    apply pairs_all. split; [apply items_all; eauto 8|]. split; [apply items_all; eauto 8|].
    apply grow_candidate. split.
    + unfold comes_before. cbn [obj num own make_item]. apply orb_true_intro.
      destruct Q as [Q | (<- & Q & ob2 & O2 & S)]; [left; apply Z.ltb_lt; lia | right].
      rewrite Z.eqb_refl. assert (ob2 = ob) by congruence. subst ob2. rewrite S. apply Z.ltb_lt. lia.
    + cbn [lo hi make_item].
      destruct (overlap _ _ _ _) eqn:V; [reflexivity|]. exfalso.
      apply (far_boxes D r _ _ D_positive D_reached V).
      destruct IM as [(p & A & B & _) | [N _]]; [eapply near_of_common; eauto | exact N].
  - intros (a & b & P & N & M). apply pairs_all in P. destruct P as (A & B & C).
    apply grow_candidate in C. destruct C as [C _].
    apply items_all in A, B. destruct A as (m & ob & n & t & O & I & ->).
    destruct B as (m' & ob' & n' & t' & O' & I' & ->).
    unfold items_count in M. cbn [obj shape make_item] in M.
    destruct N as (N1 & N2 & N3 & N4). cbn in N1, N2, N3, N4.
    apply Nat2Z.inj in N1, N2, N3, N4. subst m n m' n'.
    assert (T : is_triangle s o i t) by (exists ob; auto).
    assert (T' : is_triangle s o' i' t') by (exists ob'; auto).
    split.
    + unfold comes_before in C. cbn [obj num own make_item] in C.
      apply orb_prop in C. destruct C as [C | C]; tests.
      * left. lia.
      * right. split; [lia|]. split; [lia|]. exists ob. auto.
    + exists t, t'. split; [assumption|]. split; [assumption|].
      apply (proj2 (count_value s e clearance o i o' i' t t' _ L T T')).
      apply (count_prop _ (Z.of_nat o = Z.of_nat o')); [now rewrite Nat2Z.inj_iff | exact M].
Qed.

(** * The column of neighbours *)
Lemma name_flag a b : neighbours (name_of a b) = true <->
  obj a = obj b /\ exists c, is_shared (qtri (shape a)) (qtri (shape b)) c.
Proof.
  unfold name_of, row_of. cbn [neighbours]. destruct (shared_of_cases a b) as [S1 S0].
  destruct (Z.eq_dec (obj a) (obj b)) as [E | E].
  - rewrite (S1 E). destruct (shared_corners (shape a) (shape b)) as [|k l] eqn:C.
    + split; [discriminate|]. intros (_ & c & H). apply is_shared_corners in H.
      rewrite C in H. destruct H as (k & [] & _).
    + split; [|reflexivity]. intros _. split; [assumption|]. exists (qvec k).
      apply is_shared_corners. exists k. rewrite C. split; [now left | apply same_refl].
  - rewrite (S0 E). split; [discriminate | now intros [? _]].
Qed.
Lemma is_triangle_unique o i t u : is_triangle s o i t -> is_triangle s o i u -> t = u.
Proof. intros (ob & O & T) (ob' & O' & U). congruence. Qed.
Lemma neighbours_pairs a b o i o' i' : In (a, b) (pairs e r s) -> names (name_of a b) o i o' i' ->
  (neighbours (name_of a b) = true <-> are_neighbours s o i o' i').
Proof.
  intros P (N1 & N2 & N3 & N4). rewrite name_flag. apply pairs_all in P. destruct P as (A & B & _).
  apply items_all in A, B. destruct A as (m & ob & n & t & O & I & ->).
  destruct B as (m' & ob' & n' & t' & O' & I' & ->). cbn in N1, N2, N3, N4.
  apply Nat2Z.inj in N1, N2, N3, N4. subst m n m' n'. cbn [obj shape make_item].
  assert (T : is_triangle s o i t) by (exists ob; auto).
  assert (T' : is_triangle s o' i' t') by (exists ob'; auto).
  pose proof (shared_sized _ _ _ _ _ (power_positive (lowest s e))
                (sized_value _ _ (lowest_sound _ _ _ _ _ T))
                (sized_value _ _ (lowest_sound _ _ _ _ _ T'))) as S.
  rewrite Nat2Z.inj_iff, <- S. unfold are_neighbours.
  split; intros (E & H); (split; [exact E|]).
  - destruct H as (c & H). exists t, t', c. auto.
  - destruct H as (u & u' & c & U & U' & H). exists c.
    rewrite (is_triangle_unique _ _ _ _ T U), (is_triangle_unique _ _ _ _ T' U'). exact H.
Qed.
Lemma one_item u v : In u (items_of e s) -> In v (items_of e s) -> obj u = obj v -> num u = num v -> u = v.
Proof.
  intros U V E F. apply items_all in U, V.
  destruct U as (m & ob & n & t & O & I & ->), V as (m' & ob' & n' & t' & O' & I' & ->).
  cbn in E, F. apply Nat2Z.inj in E, F. subst m' n'.
  assert (ob' = ob) by congruence. subst ob'. assert (t' = t) by congruence. now subst t'.
Qed.
End Scene.

(** * The theorems *)
Theorem accepted_list_is_right_and_complete s clearance reach less c es l :
  check s clearance reach less c es = Proved l -> right_and_complete s clearance l.
Proof.
  unfold check. intros H o i o' i'. destruct (_ && _)%bool eqn:R in H; [|discriminate]. tests.
  pose proof (judge_all_proved _ _ _ _ _ _ _ H) as L. cbn [rows] in L.
  rewrite (answer_pairs s clearance reach less) by assumption. split; [split|].
  - intros (a & b & P & N & M). exists (name_of a b). split; [|exact N].
    apply L. right. exists a, b. auto.
  - intros (r & In_l & N). apply L in In_l. destruct In_l as [[] | (a & b & P & -> & M)]. eauto.
  - intros r In_l N. apply L in In_l. destruct In_l as [[] | (a & b & P & -> & M)].
    eapply neighbours_pairs; eauto.
Qed.

(** A refuted certificate says something false of the pair that is named. *)
Theorem refuted_pair_is_claimed_wrongly s clearance reach less c es r f o i o' i' :
  check s clearance reach less c es = Refuted r f -> names r o i o' i' ->
  f = Said_to_meet /\ ~ answer s clearance o i o' i' \/
  (f = Culled_meets \/ f = Said_disjoint) /\ answer s clearance o i o' i'.
Proof.
  unfold check. intros H N. destruct (_ && _)%bool eqn:R in H; [|discriminate]. tests.
  apply judge_all_refuted in H. cbn [refuting] in H.
  destruct H as [H | (a & b & P & -> & H)]; [discriminate|].
  rewrite (answer_pairs s clearance reach less) by assumption.
  destruct H as [[F M] | [F M]]; [left | right]; split; auto; [|eauto].
  intros (a' & b' & P' & N' & M'). apply M.
  enough (a' = a /\ b' = b) as [-> ->] by assumption.
  apply pairs_all in P, P'. destruct P as (A & B & _), P' as (A' & B' & _).
  destruct N as (N1 & N2 & N3 & N4), N' as (N1' & N2' & N3' & N4'). cbn in N1, N2, N3, N4, N1', N2', N3', N4'.
  split; eapply one_item; eauto; congruence.
Qed.

Set Printing Width 90.
Check accepted_list_is_right_and_complete.
Print Assumptions accepted_list_is_right_and_complete.
Check refuted_pair_is_claimed_wrongly.
Print Assumptions refuted_pair_is_claimed_wrongly.
