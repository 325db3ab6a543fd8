(** The theorem: a list that the checker accepts is right and complete. *)
From Coq Require Import ZArith NArith QArith Qpower Lqa Lia List Bool Setoid Morphisms.
Require Import Spec Checker Geometry Points Descent Pairs Scaling.
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
  set (common := (match shared with [] => (0 <? D)%Z && has_near (are_within (D * D) 1) a b | _ => false end ||
                  has_common (off_shared shared) a b)%bool) in *.
  assert (M : common = true -> count #D one (qtri a) (qtri b)).
  { unfold common. intros C. apply orb_prop in C. destruct C as [C | C].
    - right. destruct shared; [|discriminate]. apply andb_prop in C. destruct C as [_ C].
      split; [|now apply none].
      apply (has_near_sound (fun a b => near #D (qtri a) (qtri b)) (are_within (D * D) 1));
        [intros; now apply near_sym | intros; eapply are_near_sound; eassumption | exact C].
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
Lemma judge_all_proved D c l : forall es t rs, judge_all D c l es t = Proved rs ->
  forall r, In r rs <->
    In r (rows t) \/ exists a b, In (a, b) l /\ r = name_of a b /\ items_count D a b.
Proof.
  induction l as [|[a b] l IH]; intros es t rs H r; destruct es as [|e es]; cbn [judge_all] in H;
    try discriminate.
  - destruct (refuting t) as [[? ?]|]; [discriminate|]. destruct (weak t) as [[? ?]|]; [discriminate|].
    destruct (counts_are c t); [|discriminate]. injection H as <-.
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
Lemma judge_all_once D c l : forall es t rs, judge_all D c l es t = Proved rs ->
  NoDup (rows t) -> NoDup l ->
  (forall a b a' b', In (a, b) l -> In (a', b') l -> name_of a b = name_of a' b' ->
                     (a, b) = (a', b')) ->
  (forall a b, In (a, b) l -> ~ In (name_of a b) (rows t)) -> NoDup rs.
Proof.
  induction l as [|[a b] l IH]; intros es t rs H T L I E; destruct es as [|e es];
    cbn [judge_all] in H; try discriminate.
  - destruct (refuting t) as [[? ?]|]; [discriminate|].
    destruct (weak t) as [[? ?]|]; [discriminate|].
    destruct (counts_are c t); [|discriminate]. injection H as <-.
    rewrite rev_append_rev, app_nil_r. now apply NoDup_rev.
  - destruct (judge D a b e) as [[k f]|]; [|discriminate]. inversion_clear L as [|? ? N L'].
    apply (IH _ _ _ H); unfold enter; cbn [rows]; auto.
    + destruct (is_kind k Meeting); [|exact T]. constructor; [apply E; now left | exact T].
    + intros a' b' a'' b'' A B. apply I; now right.
    + intros a' b' A. destruct (is_kind k Meeting); [|apply E; now right].
      intros [M | M]; [|revert M; apply E; now right].
      apply I in M; [congruence | now left | now right].
Qed.
Lemma judge_all_refuted D c l : forall es t r f, judge_all D c l es t = Refuted r f ->
  refuting t = Some (r, f) \/ exists a b, In (a, b) l /\ r = name_of a b /\
    (f = Said_to_meet /\ ~ items_count D a b \/
     (f = Culled_meets \/ f = Said_disjoint) /\ items_count D a b).
Proof.
  induction l as [|[a b] l IH]; intros es t r f H; destruct es as [|e es]; cbn [judge_all] in H;
    try discriminate.
  - destruct (refuting t) as [[? ?]|]; [left; congruence|]. destruct (weak t) as [[? ?]|]; [discriminate|].
    destruct (counts_are c t); discriminate.
  - destruct (judge D a b e) as [[k g]|] eqn:J; [|discriminate].
    apply judge_sound in J. destruct J as (J & J1 & J2).
    destruct (IH _ _ _ _ H) as [R | (a' & b' & P & R)].
    + unfold enter in R. cbn [refuting] in R. unfold note in R.
      destruct (refuting t) as [[r' f']|]; [left; assumption|]. right.
      destruct (refutes g) eqn:G; [|discriminate]. injection R as <- <-.
      exists a, b. simpl. repeat split; auto. destruct g; try discriminate; rewrite <- J; auto.
    + right. exists a', b'. simpl. tauto.
Qed.

Lemma count_prop d P P' a b : (P <-> P') -> count d P a b -> count d P' a b.
Proof.
  intros E [(p & A & B & O) | [N S]]; [left; exists p | right]; tauto.
Qed.

(** * The answer, in terms of the pairs that the checker enumerates *)
Section Scene.
Variables (s : scene) (piece : tile) (clearance reach : double) (less : bool).
Let l := gathered piece reach s.
Let e := lower_place (lower_place (lower (lower 0 clearance) reach) (tile_begin piece)) (tile_end piece).
Let f := lowest l e.
Let D := scaled f clearance.
Let r := (scaled f reach - (if less then 1 else 0))%Z.
Let decided := pairs (is_of f piece) (fun _ => r) (items_of f l).
Context (D_positive : (0 <= D)%Z).
Context (D_reached : (D <= r)%Z).

Lemma exponents : (f <= exponent clearance)%Z /\ (f <= exponent reach)%Z /\
  (forall p, tile_begin piece = Some p -> (f <= exponent p)%Z) /\
  (forall p, tile_end piece = Some p -> (f <= exponent p)%Z).
Proof.
  pose proof (proj1 (lowest_all l e)) as L. fold f in L. unfold e, lower in L.
  repeat split; [| | intros p P | intros p P]; try rewrite P in L;
    destruct (tile_begin piece), (tile_end piece); cbn [lower_place] in L; unfold lower in L; try congruence;
    try (injection P as <-); lia.
Qed.
Lemma gathered_triangle n : In n l -> at_most_triangle f (corners n).
Proof. apply (proj2 (lowest_all l e)). Qed.
Lemma item_of o i t : is_triangle s o i t -> is_needed piece reach t = true -> exists ob,
  nth_error s o = Some ob /\ at_most_triangle f t /\
  In (make_item f (Named (Z.of_nat o) (Z.of_nat i) (self ob) t)) (items_of f l).
Proof.
  intros (ob & O & I) N. exists ob. split; [assumption|].
  assert (G : In (Named (Z.of_nat o) (Z.of_nat i) (self ob) t) l) by (apply gathered_all; eauto 8).
  split; [apply (gathered_triangle _ G)|]. apply items_all. eauto.
Qed.
Lemma of_item it : In it (items_of f l) -> exists o ob i t,
  nth_error s o = Some ob /\ is_triangle s o i t /\ at_most_triangle f t /\
  it = make_item f (Named (Z.of_nat o) (Z.of_nat i) (self ob) t).
Proof.
  intros I. apply items_all in I. destruct I as (n & N & ->). pose proof (gathered_triangle _ N) as A.
  apply gathered_all in N. destruct N as (o & ob & i & t & O & I & _ & ->).
  exists o, ob, i, t. split; [assumption|]. split; [exists ob; auto | auto].
Qed.
(** [is_of] is true exactly for the pairs that belong to the tile. *)
Lemma is_of_belongs o i inner o' i' inner' t t' : at_most_triangle f t -> at_most_triangle f t' ->
  is_of f piece (make_item f (Named o i inner t)) (make_item f (Named o' i' inner' t')) = true <->
  belongs piece t t'.
Proof.
  intros A A'. destruct exponents as (_ & _ & B & E). unfold is_of, belongs, both_before.
  cbn [lo make_item corners]. rewrite andb_true_iff.
  destruct (tile_end piece) as [p|]; destruct (tile_begin piece) as [q|];
    rewrite ?negb_true_iff, ?andb_false_iff, ?andb_true_iff, ?Z.ltb_lt, ?Z.ltb_ge;
    try specialize (E p eq_refl); try specialize (B q eq_refl).
  - rewrite !before_box by assumption. rewrite <- !Z.nlt_ge, !before_box by assumption.
    split.
    + intros [H G]. split; intros p' P; injection P as <-; [assumption|]. tauto.
    + intros [H G]. specialize (H p eq_refl). specialize (G q eq_refl). split; [assumption|].
      destruct (Z_lt_dec (coordinate (tile_axis piece) (least (map_triangle (scaled f) t))) (scaled f q))
        as [Y | Y]; rewrite before_box in Y by assumption; tauto.
  - rewrite !before_box by assumption. split.
    + intros [H _]. split; intros p' P; [injection P as <-; assumption | discriminate].
    + intros [H _]. specialize (H p eq_refl). tauto.
  - rewrite <- !Z.nlt_ge, !before_box by assumption. split.
    + intros [_ G]. split; intros p' P; [discriminate | injection P as <-]. tauto.
    + intros [_ G]. specialize (G q eq_refl). split; [reflexivity|].
      destruct (Z_lt_dec (coordinate (tile_axis piece) (least (map_triangle (scaled f) t))) (scaled f q))
        as [Y | Y]; rewrite before_box in Y by assumption; tauto.
  - split; [intros _; split; discriminate | auto].
Qed.
(** Both triangles of a pair that counts and belongs to the tile are needed, so they are kept. *)
Lemma belongs_needed one t t' : belongs piece t t' ->
  count (value clearance) one (map_triangle value t) (map_triangle value t') ->
  is_needed piece reach t = true /\ is_needed piece reach t' = true.
Proof.
  intros W M. destruct exponents as (LC & LR & LB & LE).
  set (g := lower_triangle (lower_triangle f t) t').
  destruct (lower_triangle_sound f t) as [G1 A], (lower_triangle_sound (lower_triangle f t) t') as [G2 A'].
  fold g in G2, A'. apply (at_most_less _ g) in A; [|assumption].
  assert (LC' : (g <= exponent clearance)%Z) by lia. assert (LR' : (g <= exponent reach)%Z) by lia.
  assert (P : (0 <= scaled g clearance)%Z) by (apply (scaled_positive f); auto).
  assert (R : (scaled g clearance <= scaled g reach)%Z).
  { apply scaled_at_most; [assumption|assumption|]. apply (scaled_at_most f); auto.
    fold D. unfold r in D_reached. destruct less; lia. }
  assert (V : (coordinate (tile_axis piece) (least (map_triangle (scaled g) t)) <=
               coordinate (tile_axis piece) (greatest (map_triangle (scaled g) t')) + scaled g reach /\
               coordinate (tile_axis piece) (least (map_triangle (scaled g) t')) <=
               coordinate (tile_axis piece) (greatest (map_triangle (scaled g) t)) + scaled g reach)%Z).
  { apply overlap_axis. destruct (overlap _ _ _ _) eqn:V; [reflexivity|]. exfalso.
    apply (far_boxes _ _ _ _ P R V). apply (proj1 (count_value g clearance t t' one LC' A A')) in M.
    destruct M as [(p & B & B' & _) | [N2 _]]; [eapply near_of_common; eauto | exact N2]. }
  pose proof (least_at_most_greatest (tile_axis piece) (map_triangle (scaled g) t)).
  pose proof (least_at_most_greatest (tile_axis piece) (map_triangle (scaled g) t')).
  destruct W as [WE WB]. unfold is_needed. rewrite !andb_true_iff.
  destruct (tile_end piece) as [p|]; destruct (tile_begin piece) as [q|];
    try specialize (LE p eq_refl); try specialize (LB q eq_refl);
    try specialize (WE p eq_refl); try specialize (WB q eq_refl);
    rewrite ?before_needed; (split; split; try tauto);
    apply (reached_needed g); auto; try lia;
    rewrite <- !(before_box g) in WB by (assumption || lia); lia.
Qed.

Lemma answer_pairs o i o' i' : answer s clearance o i o' i' /\ in_tile piece s o i o' i' <->
  exists a b, In (a, b) decided /\ names (name_of a b) o i o' i' /\ items_count D a b.
Proof.
  destruct exponents as (LC & _). split.
  - intros [(Q & t & t' & T & T' & M) (u & u' & U & U' & W)].
    assert (u = t) by (destruct T as (? & ? & ?), U as (? & ? & ?); congruence). subst u.
    assert (u' = t') by (destruct T' as (? & ? & ?), U' as (? & ? & ?); congruence). subst u'.
    destruct (belongs_needed _ _ _ W M) as [N N'].
    destruct (item_of o i t T N) as (ob & O & A & I), (item_of o' i' t' T' N') as (ob' & O' & A' & I').
    eexists _, _.
    assert (IM : items_count D (make_item f (Named (Z.of_nat o) (Z.of_nat i) (self ob) t))
                               (make_item f (Named (Z.of_nat o') (Z.of_nat i') (self ob') t'))).
    { unfold items_count. cbn [obj shape make_item of_object corners].
      apply (proj1 (count_value f clearance t t' _ LC A A')) in M.
      apply (count_prop _ (o = o')); [now rewrite Nat2Z.inj_iff | exact M]. }
    split; [|split; [|exact IM]]; [|repeat split].
    apply pairs_all. split; [exact I|]. split; [exact I'|]. split; [|now apply is_of_belongs].
    apply grow_candidate. split.
    + unfold comes_before. cbn [obj num own make_item of_object number inner]. apply orb_true_intro.
      destruct Q as [Q | (<- & Q & ob2 & O2 & S)]; [left; apply Z.ltb_lt; lia | right].
      rewrite Z.eqb_refl. assert (ob2 = ob) by congruence. subst ob2. rewrite S. apply Z.ltb_lt. lia.
    + cbn [lo hi make_item corners].
      destruct (overlap _ _ _ _) eqn:V; [reflexivity|]. exfalso.
      apply (far_boxes D r _ _ D_positive D_reached V).
      destruct IM as [(p & B & B' & _) | [N2 _]]; [eapply near_of_common; eauto | exact N2].
  - intros (a & b & P & N & M). apply pairs_all in P. destruct P as (A & B & C & W).
    apply grow_candidate in C. destruct C as [C _].
    apply of_item in A, B. destruct A as (m & ob & n & t & O & T & A & ->).
    destruct B as (m' & ob' & n' & t' & O' & T' & A' & ->).
    unfold items_count in M. cbn [obj shape make_item of_object corners] in M.
    destruct N as (N1 & N2 & N3 & N4). cbn in N1, N2, N3, N4.
    apply Nat2Z.inj in N1, N2, N3, N4. subst m n m' n'.
    apply is_of_belongs in W; [|assumption|assumption]. split; [split|].
    + unfold comes_before in C. cbn [obj num own make_item of_object number inner] in C.
      apply orb_prop in C. destruct C as [C | C]; tests.
      * left. lia.
      * right. split; [lia|]. split; [lia|]. exists ob. auto.
    + exists t, t'. split; [assumption|]. split; [assumption|].
      apply (proj2 (count_value f clearance t t' _ LC A A')).
      apply (count_prop _ (Z.of_nat o = Z.of_nat o')); [now rewrite Nat2Z.inj_iff | exact M].
    + exists t, t'. auto.
Qed.

(** * The column [neighbours] *)
Lemma name_flag a b : neighbours (name_of a b) = true <->
  obj a = obj b /\ exists c, is_shared (qtri (shape a)) (qtri (shape b)) c.
Proof.
  unfold name_of, row_of. cbn [neighbours]. destruct (shared_of_cases a b) as [S1 S0].
  destruct (Z.eq_dec (obj a) (obj b)) as [E | E].
  - rewrite (S1 E). destruct (shared_corners (shape a) (shape b)) as [|k m] eqn:C.
    + split; [discriminate|]. intros (_ & c & H). apply is_shared_corners in H.
      rewrite C in H. destruct H as (k & [] & _).
    + split; [|reflexivity]. intros _. split; [assumption|]. exists (qvec k).
      apply is_shared_corners. exists k. rewrite C. split; [now left | apply same_refl].
  - rewrite (S0 E). split; [discriminate | now intros [? _]].
Qed.
Lemma is_triangle_unique o i t u : is_triangle s o i t -> is_triangle s o i u -> t = u.
Proof. intros (ob & O & T) (ob' & O' & U). congruence. Qed.
Lemma neighbours_pairs a b o i o' i' : In (a, b) decided -> names (name_of a b) o i o' i' ->
  (neighbours (name_of a b) = true <-> are_neighbours s o i o' i').
Proof.
  intros P (N1 & N2 & N3 & N4). rewrite name_flag. apply pairs_all in P. destruct P as (I & I' & _).
  apply of_item in I, I'. destruct I as (m & ob & n & t & O & T & A & ->).
  destruct I' as (m' & ob' & n' & t' & O' & T' & A' & ->). cbn in N1, N2, N3, N4.
  apply Nat2Z.inj in N1, N2, N3, N4. subst m n m' n'. cbn [obj shape make_item of_object corners].
  pose proof (shared_sized _ _ _ _ _ (power_positive f) (sized_value _ _ A) (sized_value _ _ A')) as S.
  rewrite Nat2Z.inj_iff, <- S. unfold are_neighbours.
  split; intros (E & H); (split; [exact E|]).
  - destruct H as (c & H). exists t, t', c. auto.
  - destruct H as (u & u' & c & U & U' & H). exists c.
    rewrite (is_triangle_unique _ _ _ _ T U), (is_triangle_unique _ _ _ _ T' U'). exact H.
Qed.
Lemma one_item u v : In u (items_of f l) -> In v (items_of f l) -> obj u = obj v -> num u = num v -> u = v.
Proof.
  intros U V E F. apply of_item in U, V.
  destruct U as (m & ob & n & t & O & T & _ & ->), V as (m' & ob' & n' & t' & O' & T' & _ & ->).
  cbn in E, F. apply Nat2Z.inj in E, F. subst m' n'.
  assert (ob' = ob) by congruence. subst ob'. now rewrite (is_triangle_unique _ _ _ _ T T').
Qed.
Lemma decided_in_tile a b o i o' i' : In (a, b) decided -> names (name_of a b) o i o' i' ->
  in_tile piece s o i o' i'.
Proof.
  intros P (N1 & N2 & N3 & N4). apply pairs_all in P. destruct P as (I & I' & _ & W).
  apply of_item in I, I'. destruct I as (m & ob & n & t & O & T & A & ->).
  destruct I' as (m' & ob' & n' & t' & O' & T' & A' & ->). cbn in N1, N2, N3, N4.
  apply Nat2Z.inj in N1, N2, N3, N4. subst m n m' n'.
  apply is_of_belongs in W; [|assumption|assumption]. exists t, t'. auto.
Qed.
(** The checker decides no pair twice. *)
Lemma decided_once : NoDup decided.
Proof.
  apply pairs_once. rewrite items_map. apply map_once; [|apply gathered_once].
  intros n n' N N' E. apply gathered_all in N, N'.
  destruct N as (o & ob & i & t & O & T & _ & ->), N' as (o' & ob' & i' & t' & O' & T' & _ & ->).
  apply (f_equal (fun it => (obj it, num it))) in E. cbn in E. injection E as E F.
  apply Nat2Z.inj in E, F. congruence.
Qed.
Lemma decided_name a b a' b' : In (a, b) decided -> In (a', b') decided ->
  name_of a b = name_of a' b' -> (a, b) = (a', b').
Proof.
  intros P P' E. apply pairs_all in P, P'. destruct P as (A & B & _), P' as (A' & B' & _).
  unfold name_of, row_of in E. injection E as E1 E2 E3 E4 _. f_equal; now apply one_item.
Qed.
Lemma decided_names a b : In (a, b) decided -> exists o i o' i', names (name_of a b) o i o' i'.
Proof.
  intros P. apply pairs_all in P. destruct P as (A & B & _). apply of_item in A, B.
  destruct A as (o & ob & i & t & _ & _ & _ & ->), B as (o' & ob' & i' & t' & _ & _ & _ & ->).
  exists o, i, o', i'. now repeat split.
Qed.
End Scene.

(** * Tiles that together cover an axis *)
Lemma NoDup_app_disjoint {A} (l m : list A) : NoDup l -> NoDup m ->
  (forall a, In a l -> ~ In a m) -> NoDup (l ++ m).
Proof.
  induction 1 as [|a l H N IH]; intros M E; cbn [app]; [exact M|]. constructor.
  - rewrite in_app_iff. intros [I | I]; [contradiction | now apply (E a); [left|]].
  - apply IH; [exact M|]. intros b B. apply E. now right.
Qed.
Lemma before_dec k p t : before k p t \/ ~ before k p t.
Proof.
  rewrite before_corner.
  destruct (Qlt_le_dec (value (coordinate k (p1 t))) (value p)) as [A | A]; [tauto|].
  destruct (Qlt_le_dec (value (coordinate k (p2 t))) (value p)) as [B | B]; [tauto|].
  destruct (Qlt_le_dec (value (coordinate k (p3 t))) (value p)) as [C | C]; [tauto|].
  right. intros [D | [D | D]]; lra.
Qed.
Lemma join_step b k place :
  (same_axis (tile_axis b) k && same_place (tile_begin b) place &&
   negb (is_backwards b))%bool = true ->
  tile_axis b = k /\ tile_begin b = place /\
  forall p q, tile_begin b = Some p -> tile_end b = Some q -> value p <= value q.
Proof.
  rewrite !andb_true_iff. intros [[K P] B]. split; [|split].
  - destruct (tile_axis b), k; congruence || discriminate.
  - destruct (tile_begin b) as [[m x]|], place as [[m' x']|]; try discriminate; [|reflexivity].
    unfold same_place in P. cbn [mantissa exponent] in P. tests. congruence.
  - intros p q E F. unfold is_backwards in B. rewrite E, F in B. apply Qnot_lt_le.
    rewrite <- is_below_sound. now destruct (is_below q p).
Qed.
Lemma join_all k rest : forall place done all, join k place rest done = Some all -> forall r,
  In r all <-> In r done \/ exists b rows, In (b, rows) rest /\ In r rows.
Proof.
  induction rest as [|[b rows] rest IH]; intros place done all J r; cbn [join] in J; [discriminate|].
  destruct (_ && _)%bool in J; [|discriminate].
  assert (R : In r (rev_append rows done) <-> In r rows \/ In r done).
  { rewrite rev_append_rev, in_app_iff, <- in_rev. tauto. }
  destruct (tile_end b) as [p|], rest as [|c rest]; try discriminate.
  - rewrite (IH _ _ _ J), R. split.
    + intros [[H | H] | (b' & rows' & I & H)]; [right; exists b, rows; simpl; auto | auto | right].
      exists b', rows'. simpl in *. tauto.
    + intros [H | (b' & rows' & [I | I] & H)]; [auto | injection I as -> ->; auto | eauto].
  - injection J as <-. rewrite R. split.
    + intros [H | H]; [right; exists b, rows; simpl; auto | auto].
    + intros [H | (b' & rows' & [I | []] & H)]; [auto | injection I as -> ->; auto].
Qed.
(** Each pair belongs to one of the tiles, unless both triangles have a corner before [place]. *)
Lemma join_covers k t t' rest : forall place done all, join k place rest done = Some all ->
  (forall p, place = Some p -> ~ (before k p t /\ before k p t')) ->
  exists b rows, In (b, rows) rest /\ belongs b t t'.
Proof.
  induction rest as [|[b rows] rest IH]; intros place done all J N; cbn [join] in J; [discriminate|].
  destruct (_ && _)%bool eqn:S in J; [|discriminate].
  apply join_step in S. destruct S as (AK & AP & _).
  assert (B : (forall e, tile_end b = Some e -> before k e t /\ before k e t') ->
              exists b' rows', In (b', rows') ((b, rows) :: rest) /\ belongs b' t t').
  { intros E. exists b, rows. split; [now left|]. unfold belongs. rewrite AK, AP. auto. }
  destruct (tile_end b) as [p|]; [|apply B; discriminate].
  destruct (before_dec k p t) as [T | T], (before_dec k p t') as [T' | T'];
    [apply B; intros e E; injection E as <-; auto | | |];
    (destruct rest as [|c rest]; [discriminate|];
     destruct (IH _ _ _ J) as (b' & rows' & I & W);
     [intros p' E; injection E as <-; tauto | exists b', rows'; simpl in *; tauto]).
Qed.
Lemma before_less k p q t : value p <= value q -> before k p t -> before k q t.
Proof. intros L (c & C & B). exists c. split; [exact C|]. eapply Qlt_le_trans; eassumption. Qed.
Lemma names_unique r o i o' i' m n m' n' : names r o i o' i' -> names r m n m' n' ->
  o = m /\ i = n /\ o' = m' /\ i' = n'.
Proof. unfold names. lia. Qed.
(** No pair belongs to two of the tiles, so no row occurs twice. *)
Lemma join_once s right k rest : forall place done all, join k place rest done = Some all ->
  (forall b rows, In (b, rows) rest ->
    lists (fun o i o' i' => right o i o' i' /\ in_tile b s o i o' i') s rows) ->
  NoDup done ->
  (forall r, In r done -> exists p o i o' i' t t', place = Some p /\ names r o i o' i' /\
    is_triangle s o i t /\ is_triangle s o' i' t' /\ before k p t /\ before k p t') ->
  NoDup all.
Proof.
  induction rest as [|[b rows] rest IH]; intros place done all J T N E; cbn [join] in J;
    [discriminate|].
  destruct (_ && _)%bool eqn:S in J; [|discriminate].
  apply join_step in S. destruct S as (AK & AP & O).
  destruct (T b rows) as (R & W & _); [now left|].
  assert (U : NoDup (rev_append rows done)).
  { rewrite rev_append_rev. apply NoDup_app_disjoint; [now apply NoDup_rev | exact N|].
    intros r I D. apply in_rev, W in I.
    destruct I as (o & i & o' & i' & M & (_ & t & t' & A & A' & _ & B) & _).
    apply E in D. destruct D as (p & m & n & m' & n' & u & u' & P & M' & V & V' & C).
    destruct (names_unique _ _ _ _ _ _ _ _ _ M M') as (<- & <- & <- & <-).
    rewrite (is_triangle_unique _ _ _ _ _ A V), (is_triangle_unique _ _ _ _ _ A' V'), AK in B.
    now apply (B p); [congruence|]. }
  destruct (tile_end b) as [q|] eqn:F, rest as [|c rest]; try discriminate; [|congruence].
  apply (IH _ _ _ J); [intros; apply T; now right | exact U|].
  intros r I. rewrite rev_append_rev, in_app_iff, <- in_rev in I. exists q. destruct I as [I | I].
  - apply W in I. destruct I as (o & i & o' & i' & M & (_ & t & t' & A & A' & B & _) & _).
    rewrite AK in B. exists o, i, o', i', t, t'. specialize (B q F). tauto.
  - apply E in I. destruct I as (p & o & i & o' & i' & t & t' & P & M & A & A' & B & B').
    exists o, i, o', i', t, t'. assert (L : value p <= value q) by (apply O; congruence).
    repeat split; auto; try apply M; eapply before_less; eauto.
Qed.
Lemma triangles_of_answer s clearance o i o' i' : answer s clearance o i o' i' ->
  exists t t', is_triangle s o i t /\ is_triangle s o' i' t'.
Proof. intros (_ & t & t' & T & T' & _). eauto. Qed.

(** * The theorems *)
(** An accepted list is right and complete for its tile. The triangles that are kept suffice. *)
Theorem accepted_tile_is_right_and_complete s piece clearance reach less c es l :
  check (gathered piece reach s) piece clearance reach less c es = Proved l ->
  right_and_complete_in piece s clearance l.
Proof.
  unfold check. intros H. destruct (_ && _)%bool eqn:R in H; [|discriminate]. tests.
  pose proof (judge_all_proved _ _ _ _ _ _ H) as L. cbn [rows] in L. split; [|split].
  - apply (judge_all_once _ _ _ _ _ _ H); cbn [rows]; [constructor | apply decided_once | | auto].
    intros a b a' b'. apply decided_name.
  - intros r In_l. apply L in In_l. destruct In_l as [[] | (a & b & P & -> & M)].
    destruct (decided_names _ _ _ _ _ _ _ P) as (o & i & o' & i' & N). exists o, i, o', i'.
    split; [exact N|]. split; [|eapply neighbours_pairs; eauto].
    apply (answer_pairs s piece clearance reach less); eauto.
  - intros o i o' i' W. apply (answer_pairs s piece clearance reach less) in W; try assumption.
    destruct W as (a & b & P & N & M). exists (name_of a b). split; [|exact N].
    apply L. right. exists a, b. auto.
Qed.

(** If the tiles cover an axis, their lists together are right and complete for the whole scene. *)
Theorem merged_list_is_right_and_complete s clearance tiles l :
  merge_tiles tiles = Some l ->
  (forall piece rows, In (piece, rows) tiles -> right_and_complete_in piece s clearance rows) ->
  right_and_complete s clearance l.
Proof.
  unfold merge_tiles. destruct tiles as [|[b0 rows0] tiles]; [discriminate|]. intros J T.
  pose proof (join_all _ _ _ _ _ J) as A. simpl (In _ []) in A. split; [|split].
  - apply (join_once _ _ _ _ _ _ _ J T); [constructor | intros r []].
  - intros r R. apply A in R. destruct R as [[] | (b & rows & I & R)].
    apply (T b rows I) in R. destruct R as (o & i & o' & i' & N & [W _] & F). eauto 8.
  - intros o i o' i' W. destruct (triangles_of_answer _ _ _ _ _ _ W) as (t & t' & U & U').
    destruct (join_covers _ t t' _ _ _ _ J) as (b & rows & I & B); [discriminate|].
    destruct (proj2 (proj2 (T b rows I)) o i o' i') as (r & R & N).
    { split; [assumption|]. exists t, t'. auto. }
    exists r. split; [|assumption]. apply A. right. eauto.
Qed.

(** Without tiles, an accepted list is right and complete for the whole scene. *)
Theorem accepted_list_is_right_and_complete s clearance reach less c es l :
  check (gathered everything reach s) everything clearance reach less c es = Proved l ->
  right_and_complete s clearance l.
Proof.
  intros H. apply accepted_tile_is_right_and_complete in H. destruct H as (N & R & C).
  split; [exact N|]. split.
  - intros r I. apply R in I. destruct I as (o & i & o' & i' & M & [W _] & F). eauto 8.
  - intros o i o' i' W. apply C. split; [exact W|].
    destruct (triangles_of_answer _ _ _ _ _ _ W) as (t & t' & U & U'). exists t, t'.
    repeat split; auto; discriminate.
Qed.

(** In a list that is right and complete, two rows that name the same pair are equal. *)
Theorem pair_has_one_row s clearance l r r' o i o' i' : right_and_complete s clearance l ->
  In r l -> In r' l -> names r o i o' i' -> names r' o i o' i' -> r = r'.
Proof.
  intros (_ & R & _) I I' N N'. apply R in I, I'.
  destruct I as (a & b & a' & b' & M & _ & F), I' as (d & e & d' & e' & M' & _ & F').
  destruct (names_unique _ _ _ _ _ _ _ _ _ N M) as (<- & <- & <- & <-).
  destruct (names_unique _ _ _ _ _ _ _ _ _ N' M') as (<- & <- & <- & <-).
  rewrite <- F' in F. destruct r as [p q p' q' n], r' as [u v u' v' n'].
  unfold names in *. cbn in *. f_equal; try lia. destruct n, n'; intuition congruence.
Qed.

(** A refuted certificate makes a false claim about the pair that the verdict names. *)
Theorem refuted_pair_is_claimed_wrongly s piece clearance reach less c es r f o i o' i' :
  check (gathered piece reach s) piece clearance reach less c es = Refuted r f -> names r o i o' i' ->
  f = Said_to_meet /\ ~ answer s clearance o i o' i' \/
  (f = Culled_meets \/ f = Said_disjoint) /\ answer s clearance o i o' i'.
Proof.
  unfold check. intros H N. destruct (_ && _)%bool eqn:R in H; [|discriminate]. tests.
  apply judge_all_refuted in H. cbn [refuting] in H.
  destruct H as [H | (a & b & P & -> & H)]; [discriminate|].
  assert (W : answer s clearance o i o' i' <-> answer s clearance o i o' i' /\ in_tile piece s o i o' i').
  { split; [|tauto]. split; [assumption|]. eapply decided_in_tile; eauto. }
  rewrite W, (answer_pairs s piece clearance reach less) by assumption.
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
Check accepted_tile_is_right_and_complete.
Print Assumptions accepted_tile_is_right_and_complete.
Check merged_list_is_right_and_complete.
Print Assumptions merged_list_is_right_and_complete.
Check pair_has_one_row.
Print Assumptions pair_has_one_row.
Check refuted_pair_is_claimed_wrongly.
Print Assumptions refuted_pair_is_claimed_wrongly.
