(** The theorem about distances: answers that the checker accepts are right and complete. *)
From Coq Require Import ZArith NArith QArith Qpower Lqa Lia List Bool Setoid Morphisms FinFun.
Require Import Spec Checker InsideChecker DistanceChecker Geometry Points Pairs Scaling Proofs Inside Distances.
Import ListNotations.
Open Scope Q_scope.

(** * Orders and lists *)
Lemma up_to_true u v : up_to u v = true <-> fst u < fst v \/ (fst u == fst v /\ (snd u <= snd v)%Z).
Proof.
  unfold up_to. destruct (Qcompare (fst u) (fst v)) eqn:C.
  - apply Qeq_alt in C. rewrite Z.leb_le. split; [auto|]. intros [L | [_ L]]; [lra | assumption].
  - apply Qlt_alt in C. tauto.
  - apply Qgt_alt in C. split; [discriminate|]. intros [L | [L _]]; lra.
Qed.
Lemma distinct_sound l : distinct l = true -> NoDup l.
Proof.
  induction l as [|o l IH]; cbn [distinct]; [constructor|]. intros H. apply andb_prop in H. destruct H as [N H].
  constructor; [|auto]. intros I. apply negb_true_iff, not_true_iff_false in N. apply N.
  apply existsb_exists. exists o. split; [assumption | apply Z.eqb_refl].
Qed.
Lemma distinct_filter {A B} (g : A -> B) (h : A -> bool) l : NoDup (map g l) -> NoDup (map g (filter h l)).
Proof.
  induction l as [|a l IH]; cbn [map filter]; [auto|]. intros N. inversion N; subst.
  destruct (h a); cbn [map]; [|auto]. constructor; [|auto]. intros I. apply H1.
  apply in_map_iff in I. destruct I as (b & E & I). apply filter_In in I. rewrite <- E. now apply in_map.
Qed.
Lemma distinct_nat l : (forall j, In j l -> 0 <= j)%Z -> NoDup l -> NoDup (map Z.to_nat l).
Proof.
  induction l as [|j l IH]; cbn [map]; intros P N; [constructor|]. inversion N; subst.
  constructor; [|apply IH; auto using in_cons]. intros I. apply in_map_iff in I. destruct I as (i & E & I).
  apply H1. replace j with i; [assumption|]. apply Z2Nat.inj; auto using in_cons, in_eq.
Qed.
Lemma partner_of o e v : In v (partner o e) <-> fst v = squared e /\
  (object_a (nearest e) = o /\ snd v = object_b (nearest e) \/
   object_a (nearest e) <> o /\ object_b (nearest e) = o /\ snd v = object_a (nearest e)).
Proof.
  unfold partner. cbv zeta. destruct v as [q p]. cbn [fst snd].
  destruct (Z.eqb_spec (object_a (nearest e)) o) as [E | E];
    [|destruct (Z.eqb_spec (object_b (nearest e)) o) as [E' | E']]; cbn [In].
  - split.
    + intros [H | []]. injection H as <- <-. auto.
    + intros [-> [[_ ->] | [X _]]]; [left; reflexivity | contradiction].
  - split.
    + intros [H | []]. injection H as <- <-. auto.
    + intros [-> [[X _] | (_ & _ & ->)]]; [contradiction | left; reflexivity].
  - split; [intros []|]. intros [_ [[X _] | (_ & X & _)]]; contradiction.
Qed.
Lemma comes_first_true a b r i i' j j' : num a = Z.of_nat j -> num b = Z.of_nat j' ->
  triangle_a r = Z.of_nat i -> triangle_b r = Z.of_nat i' ->
  (comes_first a b r = true <-> (j < i \/ j = i /\ j' < i')%nat).
Proof.
  intros A B X Y. unfold comes_first. rewrite A, B, X, Y, orb_true_iff, andb_true_iff, !Z.ltb_lt, Z.eqb_eq. lia.
Qed.
Lemma less_of (strict : bool) q r (tie : Prop) : (if strict then q < r else q <= r) -> (strict = false -> tie) -> less q r tie.
Proof.
  unfold less. destruct strict; [auto|]. intros L T. apply Qle_lt_or_eq in L. destruct L; auto.
Qed.

#[local] Opaque build pairs gathered items_of lowest scaled first_items root_above separated is_at_least.
Lemma first_corner c : inside c (p1 c).
Proof.
  exists 1, 0, 0. split; [lra|]. split; [lra|]. split; [lra|]. split; [reflexivity|].
  unfold same, mix, plus, times. cbn [x y z]. split; [ring | split; ring].
Qed.

Section Scene.
Variables (s : scene) (reach : double) (q : question) (within : option double) (es : list entry).
Let l := gathered everything reach s.
Let f := lowest l (lower_place 0 within).
Let items := items_of f l.
Let d := match within with Some w => Some (scaled f w) | None => None end.
Let least := match d with Some d => d | None => 0%Z end.
Context (POSITIVE : (0 <= least)%Z).
Context (CLOSE : forallb (is_close f d) es = true).
Context (WORDS : List.find (fun e => negb (has_right_word q items e)) es = None).

Lemma limit_cases : (exists w, within = Some w) \/ within = None.
Proof. destruct within; eauto. Qed.
Lemma question_cases : q = Of_objects \/ (exists k, q = Of_nearest k) \/ q = Of_all.
Proof. destruct q; eauto. Qed.
Lemma f_negative : (f <= 0)%Z.
Proof.
  pose proof (proj1 (lowest_all l (lower_place 0 within))) as L. fold f in L.
  destruct within; cbn [lower_place] in L; unfold lower in L; lia.
Qed.
Lemma all_at_most n : In n l -> at_most_triangle f (corners n).
Proof. apply (proj2 (lowest_all l _)). Qed.
Lemma limit_is w : within = Some w -> (f <= exponent w)%Z /\ d = Some (scaled f w) /\ least = scaled f w.
Proof.
  intros E. pose proof (proj1 (lowest_all l (lower_place 0 within))) as L. fold f in L.
  unfold least, d. rewrite E in *. cbn [lower_place] in L. unfold lower in L. split; [lia | auto].
Qed.
Lemma entry_close e : In e es -> forall w, within = Some w -> squared e <= value w * value w.
Proof.
  intros I w E. destruct (limit_is w E) as (L & D & _). pose proof CLOSE as C.
  rewrite forallb_forall in C. specialize (C e I). rewrite D in C. apply (is_close_sound f f_negative w e L C).
Qed.
Lemma entry_word e o i o' i' : In e es -> names (nearest e) o i o' i' -> right_word s (says e) o o'.
Proof.
  intros I N. pose proof (find_none _ _ WORDS e I) as W. apply negb_false_iff in W.
  exact (word_sound s reach f all_at_most q e o i o' i' W N).
Qed.
Lemma is_item_triangle a o i t : is_item s f a o i t -> is_triangle s o i t.
Proof. intros (ob & O & T & _). exists ob. auto. Qed.
Lemma is_item_names a o i t : is_item s f a o i t -> obj a = Z.of_nat o /\ num a = Z.of_nat i.
Proof. intros (ob & _ & _ & _ & ->). auto. Qed.
Lemma is_item_shape a o i t : is_item s f a o i t -> shape a = map_triangle (scaled f) t /\ at_most_triangle f t.
Proof. intros (ob & _ & _ & M & ->). auto. Qed.
Lemma beyond_limit a b o i o' i' t t' w : within = Some w -> is_item s f a o i t -> is_item s f b o' i' t' ->
  ~ near #(scaled f w) (qtri (shape a)) (qtri (shape b)) ->
  forall p r, inside (exact t) p -> inside (exact t') r -> value w * value w < squared_distance p r.
Proof.
  intros E IA IB N p r P R. apply Qnot_le_lt. intros Y. apply N.
  apply (near_value s f w a b o i o' i' t t' (proj1 (limit_is w E)) IA IB). exists p, r. auto.
Qed.

(** * All triangles *)
Lemma all_triangles_are_right e0 : q = Of_all -> d = Some e0 ->
  all_triangles f e0 (pairs (fun _ _ => true) (fun _ => e0) items) es = None -> right_distances s q within es.
Proof.
  intros Q D H. destruct (all_triangles_sound _ _ _ _ H) as [I1 I2].
  destruct limit_cases as [[w EW] | EW]; [|unfold d in D; rewrite EW in D; discriminate].
  destruct (limit_is w EW) as (LW & D' & EL). rewrite D' in D. injection D as <-.
  assert (PW : (0 <= scaled f w)%Z) by (rewrite <- EL; assumption). split.
  - intros e I. destruct (I1 _ I) as (a & b & P & M). apply pairs_all in P. destruct P as (IA & IB & _).
    destruct (measures_sound s reach f f_negative all_at_most a b e IA IB M)
      as (o & i & o' & i' & t & t' & N & JA & JB & ME & LO & p & r & U & V & X).
    exists o, i, o', i'. split; [split; [assumption|]; split; [|split; [eauto using entry_word|split]]|].
    + intros k K. congruence.
    + exists t, t', p, r. auto.
    + intros j j' u u' p' r' MU [NQ | [-> ->]] P' R'; [congruence|].
      destruct ME as (_ & _ & T & T'), MU as (_ & _ & W & W').
      rewrite (is_triangle_unique _ _ _ _ _ W T) in P'. rewrite (is_triangle_unique _ _ _ _ _ W' T') in R'.
      apply (less_of false); [now apply LO | lia].
    + apply (entry_close e I).
  - intros o i o' i' t t' M _ N. specialize (N w EW).
    destruct (measured_items s reach f all_at_most _ _ _ _ _ _ M) as (a & b & IA & IB & JA & JB & C & S).
    pose proof (near_value s f w a b _ _ _ _ _ _ LW JA JB N) as NI.
    destruct (left_out s reach f all_at_most (fun _ => scaled f w) a b) as [P | P]; auto; [|contradiction].
    destruct (I2 _ _ P) as [(e & I & X) | [X | X]]; [| congruence | apply separated_sound in X; contradiction].
    exists e, i, i'. split; [assumption|]. split; [|auto]. unfold is_named in X. cbv zeta in X. tests.
    destruct (is_item_names _ _ _ _ JA), (is_item_names _ _ _ _ JB). unfold names. repeat split; congruence.
Qed.

(** * Objects *)
Let firsts := first_items items [].
Let t := ends_of q es firsts.
Context (ONCE : once es = true).
Context (WANTED : forallb (is_wanted q es t) es = true).
Context (MEASURED : List.find (fun e => negb (is_measured f items e)) es = None).
Context (FAR : List.find (fun p => negb (is_far f q es t d p))
                         (pairs (fun _ _ => true) (reach_in f q es least) items) = None).
Context (GIVEN : match d with Some _ => true | None => all_given q es t items firsts end = true).

Lemma reach_at_least a : (least <= reach_in f q es least a)%Z /\
  forall e, In e es -> object_a (nearest e) = obj a \/ (exists k, q = Of_nearest k) ->
    (root_above (numerator f (squared e)) (denominator (squared e)) <= reach_in f q es least a)%Z.
Proof.
  unfold reach_in. destruct question_cases as [-> | [[k ->] | ->]]; (split; [apply reach_for_all|]); intros e I H;
    apply reach_for_all; auto; destruct H as [H | [k' H]]; try discriminate; now apply Z.eqb_eq.
Qed.
Lemma reach_positive a : (0 <= reach_in f q es least a)%Z.
Proof. pose proof (proj1 (reach_at_least a)). lia. Qed.
Lemma entry_right e : In e es -> exists o i o' i' u u', names (nearest e) o i o' i' /\
  measured s o i o' i' u u' /\
  (exists p r, inside (exact u) p /\ inside (exact u') r /\ squared_distance p r == squared e).
Proof.
  intros I. pose proof (find_none _ _ MEASURED e I) as M. apply negb_false_iff in M. unfold is_measured in M.
  apply existsb_exists in M. destruct M as (a & IA & M). apply andb_prop in M. destruct M as [_ M].
  apply existsb_exists in M. destruct M as (b & IB & M).
  destruct (measures_sound s reach f f_negative all_at_most a b e IA IB M)
    as (o & i & o' & i' & u & u' & N & _ & _ & ME & _ & X). exists o, i, o', i', u, u'. auto.
Qed.
(** Of two objects with an entry no pair of triangles is nearer, or as near and before. *)
Lemma entry_least e o i o' i' : In e es -> names (nearest e) o i o' i' ->
  forall j j' u u' p r, measured s o j o' j' u u' -> inside (exact u) p -> inside (exact u') r ->
  less (squared e) (squared_distance p r) (~ (j < i \/ j = i /\ j' < i')%nat).
Proof.
  intros I (N1 & N2 & N3 & N4) j j' u u' p r M P R.
  destruct (measured_items s reach f all_at_most _ _ _ _ _ _ M) as (a & b & IA & IB & JA & JB & C & S).
  destruct (is_item_names _ _ _ _ JA) as [A1 A2], (is_item_names _ _ _ _ JB) as [B1 B2].
  destruct (is_item_shape _ _ _ _ JA) as [SA MA], (is_item_shape _ _ _ _ JB) as [SB MB].
  destruct (left_out s reach f all_at_most (reach_in f q es least) a b reach_positive IA IB C) as [H | H].
  - pose proof (find_none _ _ FAR _ H) as X. apply negb_false_iff in X. unfold is_far in X.
    rewrite S in X. cbn [negb orb] in X.
    rewrite (once_find es ONCE e) in X by (auto; apply is_for_sound; split; congruence).
    rewrite SA, SB in X. apply is_at_least_sound in X; [|reflexivity].
    apply (less_of (comes_first a b (nearest e))).
    + apply (at_least_value f (squared e) u u' f_negative MA MB _ X p r P R).
    + intros E. apply not_true_iff_false in E. intros Y. apply E.
      now apply (comes_first_true a b (nearest e) i i' j j').
  - left. rewrite SA, SB in H. apply (beyond_root f (squared e) u u' (reach_in f q es least a) f_negative MA MB); auto.
    apply reach_at_least; [assumption | left; congruence].
Qed.
(** What is beyond the end of an object, or beyond the limit if there is no end. *)
Definition is_past (o other : Z) (r : Q) : Prop :=
  match end_at t o with
  | Some (e, last) => less e r (last < other)%Z
  | None => forall w, within = Some w -> value w * value w < r
  end.
Lemma is_past_equal o other r r' : r == r' -> is_past o other r -> is_past o other r'.
Proof.
  unfold is_past, less. intros E. destruct (end_at t o) as [[e last]|].
  - intros [L | [L T]]; [left; lra | right; split; [lra | assumption]].
  - intros L w W. specialize (L w W). lra.
Qed.
Lemma end_is o v : end_at t o = Some v -> exists k, q = Of_nearest k /\ end_of k es o = Some v.
Proof.
  unfold end_at. destruct (List.find _ t) as [[o' v']|] eqn:F; [|discriminate]. cbn [snd]. intros ->.
  apply find_some in F. destruct F as [I E]. cbn [fst] in E. apply Z.eqb_eq in E. subst o'.
  unfold t, ends_of in I. destruct question_cases as [Q | [[k Q] | Q]]; rewrite Q in I; try (destruct I; fail).
  apply in_map_iff in I. destruct I as (a & E & _). injection E as <- E. exists k. auto.
Qed.
Lemma end_entry o v : end_at t o = Some v -> In v (partners es o).
Proof.
  intros E. apply end_is in E. destruct E as (k & _ & E). unfold end_of in E. cbv zeta in E.
  destruct (distinct _); [|discriminate]. apply find_some in E. tauto.
Qed.
Lemma beyond_sound a b i j u v o other (x := Z.of_nat o) (y := Z.of_nat other) w1 w2 :
  is_item s f a w1 i u -> is_item s f b w2 j v ->
  is_beyond f t d a b x y = true ->
  forall p r, inside (exact u) p -> inside (exact v) r -> is_past x y (squared_distance p r).
Proof.
  intros JA JB H p r P R. destruct (is_item_shape _ _ _ _ JA) as [SA MA], (is_item_shape _ _ _ _ JB) as [SB MB].
  unfold is_beyond in H. unfold is_past. destruct (end_at t x) as [[e last]|] eqn:E.
  - rewrite SA, SB in H. apply is_at_least_sound in H; [|reflexivity].
    apply (less_of (negb (last <? y)%Z)).
    + apply (at_least_value f e u v f_negative MA MB _ H p r P R).
    + intros X. apply negb_false_iff, Z.ltb_lt in X. exact X.
  - intros w W. destruct (limit_is w W) as (_ & D & _). rewrite D in H. cbn [is_apart] in H.
    apply separated_sound in H. exact (beyond_limit a b w1 i w2 j u v w W JA JB H p r P R).
Qed.
Lemma unlisted k o i o' i' u u' : q = Of_nearest k -> measured s o i o' i' u u' -> o <> o' ->
  List.find (is_for (Z.of_nat o) (Z.of_nat o')) es = None ->
  forall p r, inside (exact u) p -> inside (exact u') r ->
    is_past (Z.of_nat o) (Z.of_nat o') (squared_distance p r) /\
    is_past (Z.of_nat o') (Z.of_nat o) (squared_distance p r).
Proof.
  intros K M NE FI p r P R.
  destruct (measured_items s reach f all_at_most _ _ _ _ _ _ M) as (a & b & IA & IB & JA & JB & C & S).
  destruct (is_item_names _ _ _ _ JA) as [A1 A2], (is_item_names _ _ _ _ JB) as [B1 B2].
  destruct (is_item_shape _ _ _ _ JA) as [SA MA], (is_item_shape _ _ _ _ JB) as [SB MB].
  destruct (left_out s reach f all_at_most (reach_in f q es least) a b reach_positive IA IB C) as [H | H].
  - pose proof (find_none _ _ FAR _ H) as X. apply negb_false_iff in X. unfold is_far in X.
    rewrite S, A1, B1, FI in X. rewrite K in X. cbn [negb orb] in X. apply orb_prop in X.
    destruct X as [X | X]; [apply Z.eqb_eq in X; lia|]. apply andb_prop in X. destruct X as [X Y].
    split; [exact (beyond_sound a b i i' u u' o o' o o' JA JB X p r P R) |
            exact (beyond_sound a b i i' u u' o' o o o' JA JB Y p r P R)].
  - assert (Y : forall x y, is_past x y (squared_distance p r)).
    { intros x y. unfold is_past. destruct (end_at t x) as [[e last]|] eqn:E.
      - left. apply end_entry in E. apply in_flat_map in E. destruct E as (e' & I & E).
        apply partner_of in E. destruct E as [E _]. cbn [fst] in E. subst e. rewrite SA, SB in H.
        apply (beyond_root f (squared e') u u' (reach_in f q es least a) f_negative MA MB); auto.
        apply reach_at_least; eauto.
      - intros w W. destruct (limit_is w W) as (_ & _ & EL).
        apply (beyond_limit a b o i o' i' u u' w W JA JB); auto. intros N. apply H. destruct N as (c & c' & IC & IC' & L). exists c, c'. split; [assumption|]. split; [assumption|].
        pose proof (proj1 (reach_at_least a)) as RL. pose proof POSITIVE as PL. rewrite EL in PL.
        set (g := reach_in f q es least a) in *. rewrite EL in RL.
        assert (RR : (scaled f w * scaled f w <= g * g)%Z) by nia.
        apply -> inject_le in RR. inject. lra. }
    auto.
Qed.

(** Without a limit, two objects are listed or both have an end. *)
Lemma listed_or_ends o p c c' : within = None -> point_of s o c -> point_of s p c' -> (o < p)%nat ->
  (exists e, In e es /\ is_for (Z.of_nat o) (Z.of_nat p) e = true) \/
  (end_at t (Z.of_nat o) <> None /\ end_at t (Z.of_nat p) <> None).
Proof.
  intros W (i & u & T & _) (i' & u' & T' & _) L. pose proof GIVEN as G. unfold d in G. rewrite W in G.
  unfold all_given in G. apply andb_prop in G. destruct G as [G1 _].
  assert (M : measured s o i p i' u u').
  { split; [now left|]. split; [intros [X _]; lia|]. split; assumption. }
  destruct (measured_items s reach f all_at_most _ _ _ _ _ _ M) as (a & b & IA & IB & JA & JB & _).
  destruct (is_item_names _ _ _ _ JA) as [A1 _], (is_item_names _ _ _ _ JB) as [B1 _].
  destruct (proj2 (first_items_all items []) a IA) as (a0 & A0 & EA).
  destruct (proj2 (first_items_all items []) b IB) as (b0 & B0 & EB).
  rewrite forallb_forall in G1. specialize (G1 a0 A0). rewrite forallb_forall in G1. specialize (G1 b0 B0).
  rewrite EA, EB, A1, B1 in G1. unfold is_given in G1. rewrite EA, EB, A1, B1 in G1.
  apply orb_prop in G1. destruct G1 as [G1 | G1]; [apply negb_true_iff, Z.ltb_ge in G1; lia|].
  apply orb_prop in G1. destruct G1 as [G1 | G1].
  - left. apply existsb_exists in G1. exact G1.
  - right. apply andb_prop in G1. unfold has_end in G1. destruct G1 as [X Y].
    split; intros Z; rewrite Z in *; discriminate.
Qed.

(** * The nearest objects *)
Section Nearest.
Variable k : Z.
Context (K : q = Of_nearest k).
Lemma entry_objects e : In e es -> exists o o', object_a (nearest e) = Z.of_nat o /\
  object_b (nearest e) = Z.of_nat o' /\ (o < o')%nat /\
  (exists c c', point_of s o c /\ point_of s o' c' /\ squared_distance c c' == squared e) /\
  forall c c', point_of s o c -> point_of s o' c' -> squared e <= squared_distance c c'.
Proof.
  intros I. destruct (entry_right e I) as (o & i & o' & i' & u & u' & N & M & p & r & P & R & E).
  pose proof WANTED as D. rewrite forallb_forall in D. specialize (D e I). unfold is_wanted in D. rewrite K in D.
  apply andb_prop in D. destruct D as [D _]. apply negb_true_iff, Z.eqb_neq in D.
  pose proof N as (N1 & _ & N3 & _). exists o, o'. split; [assumption|]. split; [assumption|].
  pose proof M as (Q & NN & T & T'). assert (L : (o < o')%nat).
  { destruct Q as [Q | (Q & _)]; [assumption|]. subst. congruence. }
  split; [assumption|]. split.
  - exists p, r. split; [exists i, u; auto|]. split; [exists i', u'; auto | assumption].
  - intros c c' (j & v & V & C) (j' & v' & V' & C').
    assert (MV : measured s o j o' j' v v').
    { split; [now left|]. split; [intros [X _]; lia|]. split; assumption. }
    destruct (entry_least e o i o' i' I N j j' v v' c c' MV C C') as [X | [X _]]; lra.
Qed.
(** The partners of an object, and their distances. *)
Lemma partner_right o v : In v (partners es (Z.of_nat o)) -> exists p, snd v = Z.of_nat p /\ p <> o /\
  (exists c c', point_of s o c /\ point_of s p c' /\ squared_distance c c' == fst v) /\
  forall c c', point_of s o c -> point_of s p c' -> fst v <= squared_distance c c'.
Proof.
  intros I. apply in_flat_map in I. destruct I as (e & I & V). apply partner_of in V. destruct V as [-> V].
  destruct (entry_objects e I) as (a & b & A & B & L & (c & c' & C & C' & E) & G). rewrite A, B in V.
  destruct V as [[X Y] | (_ & X & Y)]; apply Nat2Z.inj in X; subst o.
  - exists b. split; [assumption|]. split; [lia|]. split; [exists c, c'; auto | assumption].
  - exists a. split; [assumption|]. split; [lia|]. split.
    + exists c', c. rewrite squared_swap. auto.
    + intros g g' H H'. rewrite squared_swap. auto.
Qed.
Lemma listed_or_past o p : o <> p -> (exists v, In v (partners es (Z.of_nat o)) /\ snd v = Z.of_nat p) \/
  (forall c c', point_of s o c -> point_of s p c' -> is_past (Z.of_nat o) (Z.of_nat p) (squared_distance c c')).
Proof.
  intros NE.
  destruct (List.find (is_for (Z.of_nat o) (Z.of_nat p)) es) as [e|] eqn:F1.
  { left. apply find_some in F1. destruct F1 as [I X]. apply is_for_sound in X. exists (squared e, Z.of_nat p).
    split; [|reflexivity]. apply in_flat_map. exists e. split; [assumption|]. apply partner_of. cbn [fst snd].
    split; [reflexivity|]. left. destruct X. auto. }
  destruct (List.find (is_for (Z.of_nat p) (Z.of_nat o)) es) as [e|] eqn:F2.
  { left. apply find_some in F2. destruct F2 as [I X]. apply is_for_sound in X. destruct X as [X Y].
    exists (squared e, Z.of_nat p).
    split; [|reflexivity]. apply in_flat_map. exists e. split; [assumption|]. apply partner_of. cbn [fst snd].
    split; [reflexivity|]. right. split; [|split; congruence]. rewrite X. intros Z. apply NE. lia. }
  right. intros c c' (i & u & T & C) (i' & u' & T' & C'). destruct (Nat.lt_total o p) as [L | [L | L]]; [|contradiction|].
  - assert (M : measured s o i p i' u u').
    { split; [now left|]. split; [intros [X _]; contradiction|]. split; assumption. }
    apply (unlisted k o i p i' u u' K M NE F1 c c' C C').
  - assert (M : measured s p i' o i u' u).
    { split; [now left|]. split; [intros [X _]; lia|]. split; assumption. }
    assert (Y : is_past (Z.of_nat o) (Z.of_nat p) (squared_distance c' c)).
    { apply (unlisted k p i' o i u' u K M (not_eq_sym NE) F2 c' c C' C). }
    revert Y. apply is_past_equal, squared_swap.
Qed.
Lemma listed_or_end o p c c' : within = None -> point_of s o c -> point_of s p c' -> o <> p ->
  (exists v, In v (partners es (Z.of_nat o)) /\ snd v = Z.of_nat p) \/ end_at t (Z.of_nat o) <> None.
Proof.
  intros W C C' NE. destruct (Nat.lt_total o p) as [L | [L | L]]; [|contradiction|].
  - destruct (listed_or_ends o p c c' W C C' L) as [(e & I & X) | [X _]]; [left | auto].
    apply is_for_sound in X. exists (squared e, Z.of_nat p). split; [|reflexivity]. apply in_flat_map. exists e.
    split; [assumption|]. apply partner_of. cbn [fst snd]. destruct X. auto.
  - destruct (listed_or_ends p o c' c W C' C L) as [(e & I & X) | [_ X]]; [left | auto].
    apply is_for_sound in X. destruct X as [X Y]. exists (squared e, Z.of_nat p). split; [|reflexivity].
    apply in_flat_map. exists e. split; [assumption|]. apply partner_of. cbn [fst snd].
    split; [reflexivity|]. right. split; [lia | auto].
Qed.
(** An object of rank k or less, not beyond the end, is among the k nearest. *)
Lemma is_among_sound e o o' : In e es -> is_among k es t (Z.of_nat o) e = true ->
  (object_a (nearest e) = Z.of_nat o /\ object_b (nearest e) = Z.of_nat o' \/
   object_a (nearest e) = Z.of_nat o' /\ object_b (nearest e) = Z.of_nat o) -> o <> o' ->
  among k s o o'.
Proof.
  intros I H N NE. assert (PV : partner (Z.of_nat o) e = [(squared e, Z.of_nat o')]).
  { unfold partner. cbv zeta. destruct N as [[-> ->] | [-> ->]]; [now rewrite Z.eqb_refl|].
    destruct (Z.eqb_spec (Z.of_nat o') (Z.of_nat o)); [lia | now rewrite Z.eqb_refl]. }
  unfold is_among in H. rewrite PV in H. apply andb_prop in H. destruct H as [R E]. apply Z.leb_le in R.
  set (v := (squared e, Z.of_nat o')) in *.
  assert (V : In v (partners es (Z.of_nat o))) by (apply in_flat_map; exists e; rewrite PV; simpl; auto).
  destruct (partner_right o v V) as (p0 & P0 & _ & (c0 & d0 & C0 & D0 & E0) & G0). cbn [fst snd v] in *.
  apply Nat2Z.inj in P0. subst p0.
  intros ps ND NR.
  assert (CL : forall p, In p ps -> p <> o' /\ exists u, In u (partners es (Z.of_nat o)) /\ snd u = Z.of_nat p /\ up_to u v = true).
  { intros p P. destruct (NR p P) as (NO & c & c' & C & C' & L).
    pose proof (L c0 d0 C0 D0) as L0. unfold less in L0. rewrite E0 in L0.
    assert (PO : p <> o').
    { intros ->. pose proof (G0 c c' C C'). destruct L0 as [L0 | [_ L0]]; [lra | lia]. }
    split; [assumption|].
    destruct (listed_or_past o p (not_eq_sym NO)) as [(u & U & SU) | X].
    - exists u. split; [assumption|]. split; [assumption|]. apply up_to_true. cbn [fst snd v]. rewrite SU.
      destruct (partner_right o u U) as (p1 & P1 & _ & _ & G1). rewrite SU in P1. apply Nat2Z.inj in P1. subst p1.
      specialize (G1 c c' C C'). destruct L0 as [L0 | [L0 T0]]; [left; lra|].
      apply Qle_lt_or_eq in G1. destruct G1 as [G1 | G1]; [left; lra | right; split; [lra | lia]].
    - specialize (X c c' C C'). unfold is_past in X. destruct (end_at t (Z.of_nat o)) as [[qe last]|] eqn:EN.
      + exfalso. apply up_to_true in E. cbn [fst snd v] in E. unfold less in X.
        destruct X as [X | [X X']], E as [E | [E E']], L0 as [L0 | [L0 L0']]; try lra. lia.
      + destruct limit_cases as [[w W] | W].
        * exfalso. specialize (X w W). pose proof (entry_close e I w W). destruct L0 as [L0 | [L0 _]]; lra.
        * destruct (listed_or_end o p c c' W C C' (not_eq_sym NO)) as [(u & U & SU) | Y]; [|congruence].
          exists u. split; [assumption|]. split; [assumption|]. apply up_to_true. cbn [fst snd v]. rewrite SU.
          destruct (partner_right o u U) as (p1 & P1 & _ & _ & G1). rewrite SU in P1. apply Nat2Z.inj in P1. subst p1.
          specialize (G1 c c' C C'). destruct L0 as [L0 | [L0 T0]]; [left; lra|].
          apply Qle_lt_or_eq in G1. destruct G1 as [G1 | G1]; [left; lra | right; split; [lra | lia]]. }
  assert (L : (length (o' :: ps) <= length (filter (fun u => up_to u v) (partners es (Z.of_nat o))))%nat).
  { rewrite <- (map_length Z.of_nat (o' :: ps)), <- (map_length snd (filter _ _)). apply NoDup_incl_length.
    - apply Injective_map_NoDup; [exact Nat2Z.inj|]. constructor; [|assumption]. intros X. now destruct (CL o' X).
    - intros z Z. apply in_map_iff in Z. destruct Z as (p & <- & P). apply in_map_iff. destruct P as [<- | P].
      + exists v. split; [reflexivity|]. apply filter_In. split; [assumption|]. apply up_to_true. right. split; [reflexivity | lia].
      + destruct (CL p P) as (_ & u & U & SU & UP). exists u. split; [assumption|]. apply filter_In. auto. }
  unfold rank in R. cbn [length] in L. lia.
Qed.
(** What is past the end of an object is not among its nearest ones. *)
Lemma not_among o o' v : o <> o' -> end_at t (Z.of_nat o) = Some v ->
  (forall c c', point_of s o c -> point_of s o' c' -> is_past (Z.of_nat o) (Z.of_nat o') (squared_distance c c')) ->
  ~ among k s o o'.
Proof.
  intros NE E X AM. destruct (end_is _ _ E) as (k' & K' & F). assert (k' = k) as -> by congruence.
  unfold end_of in F. cbv zeta in F. destruct (distinct _) eqn:DI; [|discriminate]. apply distinct_sound in DI.
  apply find_some in F. destruct F as [_ R]. apply Z.eqb_eq in R.
  unfold is_past in X. rewrite E in X. destruct v as [qe last].
  set (near_ones := filter (fun u => up_to u (qe, last)) (partners es (Z.of_nat o))) in *.
  assert (IN : forall u, In u near_ones -> In u (partners es (Z.of_nat o)) /\ up_to u (qe, last) = true)
    by (intros u U; apply filter_In in U; exact U).
  assert (L : (Z.of_nat (length (map Z.to_nat (map snd near_ones))) < k)%Z).
  { apply AM.
    - apply distinct_nat; [|now apply distinct_filter]. intros j J. apply in_map_iff in J. destruct J as (u & <- & U).
      apply IN in U. destruct (partner_right o u (proj1 U)) as (p & -> & _). lia.
    - intros p P. apply in_map_iff in P. destruct P as (j & <- & J). apply in_map_iff in J. destruct J as (u & <- & U).
      apply IN in U. destruct U as [U UP].
      destruct (partner_right o u U) as (p & SU & NO & (c & c' & C & C' & EQ) & _). rewrite SU, Nat2Z.id.
      split; [assumption|]. exists c, c'. split; [assumption|]. split; [assumption|]. intros g g' G G'.
      specialize (X g g' G G'). apply up_to_true in UP. cbn [fst snd] in UP. unfold less in *. rewrite EQ. rewrite SU in UP.
      destruct X as [X | [X X']], UP as [UP | [UP UP']]; try (left; lra). right. split; [lra | lia]. }
  unfold rank in R. fold near_ones in R. rewrite !map_length in L. lia.
Qed.
End Nearest.

(** * The answers *)
Lemma entry_wanted e o i o' i' : In e es -> names (nearest e) o i o' i' -> wanted s q o o'.
Proof.
  intros I (N1 & _ & N3 & _) k K. pose proof WANTED as W. rewrite forallb_forall in W. specialize (W e I).
  unfold is_wanted in W. rewrite K in W. cbv zeta in W. apply andb_prop in W. destruct W as [NE W].
  apply negb_true_iff, Z.eqb_neq in NE. assert (O : o <> o') by (intros ->; congruence).
  split; [assumption|]. apply orb_prop in W. rewrite N1, N3 in W. destruct W as [W | W]; [left | right].
  - apply (is_among_sound k K e o o'); auto.
  - apply (is_among_sound k K e o' o); auto.
Qed.
(** Two objects without an entry have no pair that is asked for. *)
Lemma none_missing o i o' i' u u' : q <> Of_all -> measured s o i o' i' u u' -> wanted s q o o' ->
  (forall w, within = Some w -> near (value w) (exact u) (exact u')) ->
  List.find (is_for (Z.of_nat o) (Z.of_nat o')) es = None -> False.
Proof.
  intros NA M W N FI. destruct question_cases as [Q | [[k Q] | Q]]; [| |contradiction].
  - clear W NA.
    destruct (measured_items s reach f all_at_most _ _ _ _ _ _ M) as (a & b & IA & IB & JA & JB & C & S).
    destruct (is_item_names _ _ _ _ JA) as [A1 A2], (is_item_names _ _ _ _ JB) as [B1 B2].
    destruct limit_cases as [[w EW] | EW].
    + destruct (limit_is w EW) as (LW & ED & EL). pose proof (near_value s f w a b _ _ _ _ _ _ LW JA JB (N w EW)) as NI.
        destruct (left_out s reach f all_at_most (reach_in f q es least) a b reach_positive IA IB C) as [H | H].
      * pose proof (find_none _ _ FAR _ H) as X. apply negb_false_iff in X. unfold is_far in X.
           rewrite S, A1, B1, FI, Q, ED in X. cbn [negb orb is_apart] in X.
           apply separated_sound in X. contradiction.
      * apply H. destruct NI as (c & c' & IC & IC' & L). exists c, c'. split; [assumption|]. split; [assumption|].
           pose proof (proj1 (reach_at_least a)) as RL. pose proof POSITIVE as PL. rewrite EL in PL.
           set (g := reach_in f q es least a) in *. rewrite EL in RL.
           assert (RR : (scaled f w * scaled f w <= g * g)%Z) by nia.
           apply -> inject_le in RR. inject. lra.
    + destruct (Nat.eq_dec o o') as [E | E].
      * pose proof GIVEN as H. unfold d in H. rewrite EW in H. unfold all_given in H. rewrite Q in H.
           apply andb_prop in H. destruct H as [_ H]. rewrite forallb_forall in H. specialize (H a IA).
           apply orb_prop in H. destruct H as [H | H]; [apply orb_prop in H; destruct H as [H | H]|].
        -- apply negb_true_iff in H. unfold comes_before in C. rewrite A1, B1, E, Z.ltb_irrefl, H in C.
              rewrite andb_false_r in C. discriminate.
        -- apply existsb_exists in H. destruct H as (e & I & X). rewrite A1 in X. rewrite <- E in FI.
              rewrite (find_none _ _ FI e I) in X. discriminate.
        -- rewrite forallb_forall in H. specialize (H b IB). rewrite C, A1, B1, E, Z.eqb_refl, S in H. discriminate.
      * destruct M as (AS & _ & T & T'). destruct AS as [AS | [AS _]]; [|contradiction].
           assert (CO : forall m j v, is_triangle s m j v -> point_of s m (p1 (exact v))).
           { intros m j v V. exists j, v. split; [assumption | apply first_corner]. }
           destruct (listed_or_ends o o' _ _ EW (CO _ _ _ T) (CO _ _ _ T') AS) as [(e & I & X) | [X _]].
        -- rewrite (find_none _ _ FI e I) in X. discriminate.
        -- destruct (end_at t (Z.of_nat o)) as [v|] eqn:EN; [|congruence].
              apply end_is in EN. destruct EN as (k & EN & _). congruence.
  - destruct (W k Q) as [NE AM].
      assert (U : forall c c', point_of s o c -> point_of s o' c' ->
        is_past (Z.of_nat o) (Z.of_nat o') (squared_distance c c') /\
        is_past (Z.of_nat o') (Z.of_nat o) (squared_distance c c')).
      { intros c c' (j & v & V & IC) (j' & v' & V' & IC'). apply (unlisted k o j o' j' v v' Q); auto.
        destruct M as (AS & _). destruct AS as [AS | [AS _]]; [|contradiction].
        split; [now left|]. split; [intros [X _]; contradiction|]. split; assumption. }
      destruct M as (AS & _ & T & T'). destruct AS as [AS | [AS _]]; [|contradiction].
      assert (CO : forall m j v, is_triangle s m j v -> point_of s m (p1 (exact v))).
      { intros m j v V. exists j, v. split; [assumption | apply first_corner]. }
      assert (NOEND : end_at t (Z.of_nat o) = None \/ end_at t (Z.of_nat o') = None -> False).
      { intros EN. destruct limit_cases as [[w EW] | EW].
        - destruct (N w EW) as (c & c' & IC & IC' & L).
          destruct (U c c') as [U1 U2]; [exists i, u; auto | exists i', u'; auto|].
          unfold is_past in U1, U2. destruct EN as [EN | EN]; rewrite EN in *.
          + specialize (U1 w EW). lra.
          + specialize (U2 w EW). lra.
        - destruct (listed_or_ends o o' _ _ EW (CO _ _ _ T) (CO _ _ _ T') AS) as [(e & I & X) | [X Y]].
          + rewrite (find_none _ _ FI e I) in X. discriminate.
          + destruct EN; contradiction. }
      destruct AM as [AM | AM].
      + destruct (end_at t (Z.of_nat o)) as [v|] eqn:EN; [|auto].
        apply (not_among k Q o o' v NE EN); [|assumption]. intros c c' IC IC'. now apply U.
      + destruct (end_at t (Z.of_nat o')) as [v|] eqn:EN; [|auto].
        apply (not_among k Q o' o v (not_eq_sym NE) EN); [|assumption]. intros c c' IC IC'.
        destruct (U c' c IC' IC) as [_ X]. revert X. apply is_past_equal, squared_swap.
Qed.
Lemma objects_are_right : q <> Of_all -> right_distances s q within es.
Proof.
  intros NA. split.
  - intros e I. destruct (entry_right e I) as (o & i & o' & i' & u & u' & N & M & p & r & P & R & E).
    exists o, i, o', i'. split; [|now apply entry_close].
    split; [assumption|]. split; [eapply entry_wanted; eauto|]. split; [eapply entry_word; eauto|]. split.
    + exists u, u', p, r. auto.
    + intros j j' v v' c c' MV _ C C'. eapply entry_least; eauto.
  - intros o i o' i' u u' M W N.
    assert (G : forall e, In e es -> is_for (Z.of_nat o) (Z.of_nat o') e = true ->
      exists e j j', In e es /\ names (nearest e) o j o' j' /\ (q = Of_all -> j = i /\ j' = i')).
    { intros e I X. destruct (entry_right e I) as (x & j & x' & j' & ? & ? & NN & _).
      exists e, j, j'. split; [assumption|]. split; [|contradiction]. apply is_for_sound in X.
      destruct X as [X1 X2], NN as (N1 & N2 & N3 & N4). unfold names. rewrite X1, X2. auto. }
    destruct (List.find (is_for (Z.of_nat o) (Z.of_nat o')) es) as [e|] eqn:FI.
    { apply find_some in FI. destruct FI as [I X]. exact (G e I X). }
    exfalso. exact (none_missing o i o' i' u u' NA M W N FI).
Qed.
End Scene.

(** * The theorem *)
Theorem accepted_distances_are_right s reach q within es :
  check_distances (gathered everything reach s) q within es = Distances_proved ->
  right_distances s q within es.
Proof.
  unfold check_distances. cbv zeta. set (l := gathered everything reach s).
  set (f := lowest l (lower_place 0 within)). set (items := items_of f l).
  set (d := match within with Some w => Some (scaled f w) | None => None end).
  destruct (match d with Some d => (d <? 0)%Z | None => false end) eqn:P; [discriminate|].
  assert (POSITIVE : (0 <= match d with Some d => d | None => 0 end)%Z).
  { destruct d; [now apply Z.ltb_ge in P | lia]. }
  destruct (forallb (is_close f d) es) eqn:CLOSE; cbn [negb]; [|discriminate].
  destruct (List.find _ es) eqn:WORDS; [discriminate|].
  assert (OBJECTS : q <> Of_all -> check_objects f q items d es = Distances_proved -> right_distances s q within es).
  { intros NA. unfold check_objects. cbv zeta.
    destruct (once es && forallb _ es)%bool eqn:OW; cbn [negb]; [|discriminate].
    apply andb_prop in OW. destruct OW as [ONCE WANTED].
    destruct (List.find (fun e => negb (is_measured f items e)) es) eqn:MEASURED; [discriminate|].
    destruct (List.find _ (pairs _ _ _)) as [[? ?]|] eqn:FAR; [discriminate|].
    intros G. apply (objects_are_right s reach q within es POSITIVE CLOSE WORDS ONCE WANTED MEASURED FAR); [|assumption].
    fold l f items d. destruct d; [reflexivity|]. destruct (all_given _ _ _ _ _); [reflexivity | discriminate]. }
  pose proof (fun e => all_triangles_are_right s reach q within es POSITIVE CLOSE WORDS e) as ALL. fold l f items d in ALL.
  destruct q as [|k|]; [apply OBJECTS; discriminate | apply OBJECTS; discriminate|].
  destruct d as [e|] eqn:D; [|discriminate]. destruct (all_triangles _ _ _ _) eqn:T; [discriminate|].
  intros _. now apply (ALL e).
Qed.

Set Printing Width 90.
Check accepted_distances_are_right.
Print Assumptions accepted_distances_are_right.
