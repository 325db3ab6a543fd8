(** Theorem 2, the lemmas of Quick-CULLIDE, theorem 3 and corollaries 3 and 4 (docs/reliability.md) for any
    number of items, any owners, any views and any schedule that the rules allow. *)
From Coq Require Import List Bool Arith Lia.
Import ListNotations.
Require Import Passes.

(** ** What a pass clears *)
Lemma mem_in t s : mem t s = true <-> In t s.
Proof.
  unfold mem. rewrite existsb_exists. split; [intros (x & H & E) | exists t].
  - now apply Nat.eqb_eq in E as ->.
  - now rewrite Nat.eqb_refl.
Qed.
Lemma not_mem t s : negb (mem t s) = true <-> ~ In t s.
Proof. now rewrite negb_true_iff, <- mem_in, not_true_iff_false. Qed.

Definition is_asked (p : pass) (t : nat) : Prop := asks p t = true /\ undrawable (along p) t = false.
(** No item of the group that is asked and shown is hidden by one of [stored]. *)
Definition none_seen (p : pass) (stored : nat -> Prop) (g : list nat) : Prop :=
  forall t u, In t g -> is_asked p t -> shown (along p) t = true -> stored u -> hides (along p) t u = false.

Lemma unseen_spec p stored g t :
  In t (unseen p stored g) <->
  In t g /\ is_asked p t /\ (shown (along p) t = false \/ none_seen p (fun u => In u stored) g).
Proof.
  unfold unseen, none_seen, is_asked.
  set (asked := filter _ g).
  assert (A : forall x, In x asked <-> In x g /\ asks p x = true /\ undrawable (along p) x = false).
  { intros x. unfold asked. now rewrite filter_In, andb_true_iff, negb_true_iff. }
  destruct existsb eqn:E.
  - apply existsb_exists in E as (x & Hx & E). apply andb_true_iff in E as [S E].
    apply existsb_exists in E as (u & Hu & E). apply A in Hx as [Hg Hx].
    rewrite filter_In, A, negb_true_iff. split; [tauto|].
    intros (G & K & [N | N]); [tauto|]. now rewrite (N x u) in E.
  - rewrite A. split; [|tauto]. intros (G & K). repeat (split; [tauto|]). right.
    intros x u Gx Kx S Hu. destruct (hides _ x u) eqn:H; [|reflexivity].
    enough (existsb (fun t => shown (along p) t && existsb (hides (along p) t) stored) asked = true) by congruence.
    apply existsb_exists. exists x. rewrite A, S. split; [tauto|]. apply existsb_exists. eauto.
Qed.

Ltac as_said N := repeat (apply conj; [now trivial|]); destruct N as [N | N]; [now left|right].

Lemma go_spec w p t order : forall stored,
  In t (go w p order stored) <->
  exists before o rest g, order = before ++ o :: rest /\ In g (groups p o) /\ In t g /\ is_asked p t /\
    (shown (along p) t = false \/
     none_seen p (fun u => In u stored \/ (In u (items w) /\ In (owner w u) before /\ stores p u = true)) g).
Proof.
  induction order as [|o rest IH]; intros stored; simpl.
  { split; [tauto|]. intros ([|] & ? & ? & ? & E & _); discriminate. }
  rewrite in_app_iff, in_flat_map, IH. setoid_rewrite unseen_spec. split.
  - intros [(g & G & T & A & N) | (before & o' & rest' & g & -> & G & T & A & N)].
    + exists [], o, rest, g. as_said N.
      intros x u X Y Z [U | (_ & [] & _)]; now apply N.
    + exists (o :: before), o', rest', g. as_said N.
      intros x u X Y Z U. apply N; trivial. rewrite in_app_iff, filter_In, andb_true_iff, Nat.eqb_eq.
      simpl in U. intuition auto.
  - intros ([|o' before] & o'' & rest' & g & E & G & T & A & N); injection E as -> ->.
    + left. exists g. as_said N.
      intros x u X Y Z U. apply N; tauto.
    + right. exists before, o'', rest', g. as_said N.
      intros x u X Y Z U. apply N; trivial. rewrite in_app_iff, filter_In, andb_true_iff, Nat.eqb_eq in U.
      simpl. intuition auto.
Qed.

(** The owners that a pass stores before it asks owner o. *)
Definition ahead (second : bool) (o' o : nat) : Prop := if second then o < o' else o' < o.
Lemma owner_bound w u : In u (items w) -> owner w u < owners w.
Proof.
  intros H. unfold owners. apply Nat.lt_succ_r.
  assert (F : Forall (fun k => k <= list_max (map (owner w) (items w))) (map (owner w) (items w)))
    by now apply list_max_le.
  rewrite Forall_forall in F. apply F, in_map, H.
Qed.
Lemma seq_split n : forall start before o rest, seq start n = before ++ o :: rest ->
  start <= o < start + n /\ (forall x, start <= x < o -> In x before) /\ (forall x, o < x < start + n -> In x rest).
Proof.
  induction n as [|n IH]; intros start [|a before] o rest E; try discriminate; injection E as <- E.
  - subst. repeat split; try lia. intros x H. rewrite in_seq. lia.
  - apply IH in E as (O & B & R). repeat split; try lia; intros x H.
    + destruct (Nat.eq_dec x start); [now left|right]. apply B. lia.
    + apply R. lia.
Qed.

Lemma cleared_spec w p t :
  In t (cleared w p) <->
  exists o g, o < owners w /\ In g (groups p o) /\ In t g /\ is_asked p t /\
    (shown (along p) t = false \/
     none_seen p (fun u => In u (items w) /\ ahead (second p) (owner w u) o /\ stores p u = true) g).
Proof.
  unfold cleared. rewrite go_spec. split.
  - intros (before & o & rest & g & E & G & T & A & N). exists o, g.
    assert (B : o < owners w /\ forall u, In u (items w) -> ahead (second p) (owner w u) o -> In (owner w u) before).
    { unfold ahead. destruct (second p).
      - apply (f_equal (@rev nat)) in E. rewrite rev_involutive, rev_app_distr in E.
        cbn [rev] in E. rewrite <- app_assoc in E. apply seq_split in E as (O & _ & B). split; [lia|].
        intros u U L. apply owner_bound in U. apply in_rev, B. lia.
      - apply seq_split in E as (O & B & _). split; [lia|]. intros u U L. apply B. lia. }
    destruct B as [O B]. as_said N.
    intros x u X Y Z (U & V & W). apply N; auto.
  - intros (o & g & O & G & T & A & N).
    assert (Q : seq 0 (owners w) = seq 0 o ++ o :: seq (S o) (owners w - S o)).
    { replace (owners w) with (o + S (owners w - S o)) at 1 by lia. now rewrite seq_app. }
    unfold ahead in N. destruct (second p).
    + exists (rev (seq (S o) (owners w - S o))), o, (rev (seq 0 o)), g.
      rewrite Q, rev_app_distr. cbn [rev]. rewrite <- app_assoc. as_said N.
      intros x u X Y Z [[] | (U & V & W)]. apply N; trivial.
      apply in_rev in V. rewrite in_seq in V. repeat split; trivial; lia.
    + exists (seq 0 o), o, (seq (S o) (owners w - S o)), g. as_said N.
      intros x u X Y Z [[] | (U & V & W)]. apply N; trivial.
      rewrite in_seq in V. repeat split; trivial; lia.
Qed.

(** ** Theorem 2 *)
(** An item is not cleared if one that hides it was stored before. *)
Lemma not_cleared w p t u :
  of_one_owner w (groups p) -> sees (along p) t u -> In u (items w) ->
  ahead (second p) (owner w u) (owner w t) -> stores p u = true -> ~ In t (cleared w p).
Proof.
  intros G S U A E. rewrite cleared_spec. intros (o & g & _ & I & T & K & N).
  rewrite <- (G o g t I T) in N. destruct S as [S | [S H]]; [destruct K; congruence|].
  destruct N as [N | N]; [congruence|].
  assert (E' : hides (along p) t u = false) by (apply N; auto). unfold hides in E'.
  apply orb_false_iff in E' as []. destruct H; congruence.
Qed.

Lemma pass_keeps_facts w meet b p :
  take_part w meet -> allowed w meet b (Draw p) -> facts w meet b -> facts w meet (after w b p).
Proof.
  intros P (S & G & E) F u t M O. destruct (P u t M O) as [U T], (S u t M O), (F u t M O) as [L K].
  unfold stores_enough in E. unfold after.
  destruct (second p) eqn:D; simpl in *; rewrite in_app_iff; split; trivial; intros [C | C]; try tauto; revert C.
  - apply (not_cleared w p u t); auto. now rewrite D.
  - apply (not_cleared w p t u); auto. now rewrite D.
Qed.

Theorem what_meets_keeps_its_bits_unset w meet : take_part w meet ->
  forall ss b, facts w meet b -> allowed_run w meet b ss -> facts w meet (run w b ss).
Proof.
  intros P. induction ss as [|s ss IH]; intros b F; simpl; [trivial|]. intros [A R]. apply IH; [|trivial].
  destruct s as [p | kept | more]; [now apply pass_keeps_facts|..]; intros u t M O; destruct (F u t M O); simpl.
  - rewrite !filter_In. tauto.
  - destruct (A u t M O). rewrite !in_app_iff. tauto.
Qed.

(** Without bits at the beginning: nothing is assumed of them. So what is culled meets nothing. *)
Corollary what_is_culled_meets_nothing w meet ss : take_part w meet -> allowed_run w meet (Bits [] []) ss ->
  forall u t, meet u t -> owner w u < owner w t ->
    live (run w (Bits [] []) ss) u = true /\ live (run w (Bits [] []) ss) t = true.
Proof.
  intros P A u t M O. unfold live. rewrite !negb_true_iff, !andb_false_iff, <- !not_true_iff_false, !mem_in.
  apply (what_meets_keeps_its_bits_unset w meet P ss) in A; [destruct (A u t M O); tauto|]. simpl. firstorder.
Qed.

(** The passes of both methods are allowed: of plain CULLIDE, and of Quick-CULLIDE. *)
Lemma passes_are_allowed w meet b second v groups : shows w meet v -> of_one_owner w groups ->
  allowed w meet b (Draw (quick b second v groups)) /\ allowed w meet b (Draw (plain b second v groups)).
Proof.
  intros S G. unfold allowed, stores_enough. simpl. repeat (split; trivial); intros u _ N.
  - now apply not_mem.
  - unfold live. rewrite negb_true_iff, andb_false_iff, <- !not_true_iff_false, !mem_in.
    destruct second; simpl in N; tauto.
Qed.

(** ** What more bits, and what fewer questions and stored items, change *)
Definition within (a b : bits) : Prop := incl (f a) (f b) /\ incl (l a) (l b).

(** A pass that has the bit of what it does not ask, asks and stores less, sets at least the same bits. *)
Lemma less_asked_and_stored w b c p q : within b c ->
  second p = second q -> along p = along q -> groups p = groups q ->
  (forall t, asks q t = true -> asks p t = true) ->
  (forall t, asks p t = true -> In t (bit (second q) c) \/ asks q t = true) ->
  (forall u, stores q u = true -> stores p u = true) ->
  within (after w b p) (after w c q).
Proof.
  intros [BF BL] D V G A B S.
  assert (C : forall t, In t (cleared w p) -> In t (bit (second q) c) \/ In t (cleared w q)).
  { intros t. rewrite !cleared_spec. intros (o & g & O & I & T & [K U] & N).
    destruct (B t K) as [H | H]; [now left|right]. exists o, g. unfold is_asked. rewrite <- D, <- V, <- G.
    repeat (split; trivial). destruct N as [N | N]; [now left|right]. intros x u X [Y Z] W (J & J' & J'').
    rewrite <- V in *. rewrite <- D in *. apply N; auto. split; auto. }
  unfold after, within. rewrite D. destruct (second q); simpl in *; split; trivial; intros t;
    rewrite !in_app_iff; intros [H | H]; auto; destruct (C t H); auto.
Qed.

Lemma bit_within second a b : within a b -> incl (bit second a) (bit second b).
Proof. intros []. now destruct second. Qed.
Lemma live_or second b t : live b t = true <-> ~ In t (bit second b) \/ ~ In t (bit (negb second) b).
Proof.
  unfold live. rewrite negb_true_iff, andb_false_iff, <- !not_true_iff_false, !mem_in. destruct second; simpl; tauto.
Qed.

(** Theorem 3, the bits: whatever both do in the same order, those of Quick-CULLIDE contain those of
    plain CULLIDE. *)
Lemma quick_contains_plain w b c second v groups : within b c ->
  within (after w b (plain b second v groups)) (after w c (quick c second v groups)).
Proof.
  intros W. apply less_asked_and_stored; simpl; trivial; intros t; rewrite (live_or second), ?not_mem;
    pose proof (bit_within second b c W t); pose proof (bit_within (negb second) b c W t); try tauto.
  destruct (in_dec Nat.eq_dec t (bit second c)); tauto.
Qed.
Lemma quick_is_monotone w b c second v groups : within b c ->
  within (after w b (quick b second v groups)) (after w c (quick c second v groups)).
Proof.
  intros W. apply less_asked_and_stored; simpl; trivial; intros t; rewrite !not_mem;
    pose proof (bit_within second b c W t); pose proof (bit_within (negb second) b c W t); try tauto.
  destruct (in_dec Nat.eq_dec t (bit second c)); tauto.
Qed.
Lemma both_within b : within (both b) b.
Proof. split; intros t; simpl; rewrite filter_In, ?mem_in; tauto. Qed.
Lemma within_trans a b c : within a b -> within b c -> within a c.
Proof. intros [] []. split; eapply incl_tran; eauto. Qed.

(** A visit runs both passes at a level. Plain CULLIDE begins it without bits but those of culled items. *)
Definition visit_quick w b '(v, groups) : bits :=
  let c := after w b (quick b false v groups) in after w c (quick c true v groups).
Definition visit_plain w b '(v, groups) : bits :=
  let b := both b in
  let c := after w b (plain b false v groups) in both (after w c (plain c true v groups)).
Theorem quick_is_never_behind w visits : forall b c, within b c ->
  within (fold_left (visit_plain w) visits b) (fold_left (visit_quick w) visits c).
Proof.
  induction visits as [|[v groups] visits IH]; intros b c W; [trivial|]. apply IH. simpl.
  eapply within_trans; [apply both_within|].
  apply quick_contains_plain, quick_contains_plain. apply (within_trans _ b); [apply both_within | trivial].
Qed.

(** Corollary 3: let passes over single items along all views of a list set no bit from [e]. Then
    every schedule of Quick-CULLIDE along these views that starts within [e] stays within it, whatever
    its order and its groups (lemma 11). So two runs that go on until no bit is set end at one set. *)
Definition singles (w : world) (o : nat) : list (list nat) :=
  map (fun t => [t]) (filter (fun t => owner w t =? o) (items w)).
Definition at_end (w : world) (views : list view) (e : bits) : Prop :=
  forall second v, In v views -> within (after w e (quick e second v (singles w))) e.
Theorem the_end_holds_all w views e : at_end w views e ->
  forall b second v groups, In v views -> of_one_owner w groups ->
    (forall o g t, In g (groups o) -> In t g -> In t (items w)) ->
    within b e -> within (after w b (quick b second v groups)) e.
Proof.
  intros E b second v groups V G I W.
  assert (C : incl (cleared w (quick b second v groups)) (bit second e)).
  { intros t. rewrite cleared_spec. intros (o & g & O & J & T & [K U] & N). simpl in *.
    destruct (in_dec Nat.eq_dec t (bit second e)) as [H | H]; [trivial|].
    apply (bit_within second _ _ (E second v V)). unfold after.
    enough (In t (cleared w (quick e second v (singles w)))) by (simpl; destruct second; apply in_app_iff; auto).
    apply cleared_spec. exists o, [t]. simpl. apply conj; [trivial|].
      apply conj; [apply in_map_iff; exists t; rewrite filter_In, Nat.eqb_eq; eauto|].
      apply conj; [now left|]. apply conj; [apply conj; [now apply not_mem | trivial]|].
      destruct N as [N | N]; [now left|right]. intros x u [<- | []] Y Z (P & Q & R). apply N; auto.
      - split; trivial.
      - repeat (split; trivial). simpl in *. apply not_mem. apply not_mem in R.
        pose proof (bit_within (negb second) b e W u). tauto. }
  destruct W. unfold after, within. simpl. destruct second; simpl; split; trivial; now apply incl_app.
Qed.

(** A pass over single items that stores what it stored when it last ran in this view, before which the
    bits were [b], sets nothing now, so it may be left out. *)
Theorem a_pass_left_out_sets_nothing w b c second v :
  let p := quick b second v (singles w) in
  within (after w b p) c -> incl (bit (negb second) c) (bit (negb second) b) ->
  within (after w c (quick c second v (singles w))) c.
Proof.
  intros p W S.
  assert (C : incl (cleared w (quick c second v (singles w))) (bit second c)).
  { intros t T. apply (bit_within second _ _ W).
    enough (In t (cleared w p) \/ In t (bit second b)) by (unfold after; simpl; destruct second; apply in_app_iff; auto).
    destruct (in_dec Nat.eq_dec t (bit second b)) as [H | H]; [now right|left].
    rewrite cleared_spec in *. destruct T as (o & g & O & G & T & [K U] & N). exists o, g. simpl in *.
    repeat (apply conj; [now trivial|]). apply conj; [split; [now apply not_mem | exact U]|].
    apply in_map_iff in G as (t' & <- & _). destruct T as [-> | []].
    destruct N as [N | N]; [now left|right]. intros x u [<- | []] Y Z (I & A & R). apply N; auto; simpl.
    - now left.
    - now split.
    - repeat (split; trivial). apply not_mem. apply not_mem in R. auto. }
  unfold after, within. simpl. destruct second; simpl in *; split; try apply incl_refl; apply incl_app; trivial; apply incl_refl.
Qed.

(** A run of passes of Quick-CULLIDE along these views. *)
Inductive reaches (w : world) (views : list view) (b : bits) : bits -> Prop :=
| here : reaches w views b b
| further c second v groups : reaches w views b c -> In v views -> of_one_owner w groups ->
    (forall o g t, In g (groups o) -> In t g -> In t (items w)) ->
    reaches w views b (after w c (quick c second v groups)).
Lemma after_contains w b p : within b (after w b p).
Proof. unfold after. destruct (second p); split; simpl; try apply incl_refl; apply incl_appr, incl_refl. Qed.
Theorem all_runs_end_alike w views b e e' : reaches w views b e -> at_end w views e ->
  reaches w views b e' -> at_end w views e' -> within e e' /\ within e' e.
Proof.
  assert (A : forall e e', reaches w views b e -> reaches w views b e' -> at_end w views e' -> within e e').
  { intros x y R S E. induction R as [|c second v groups R IH V G I].
    - clear E. induction S; [split; apply incl_refl|]. eapply within_trans; [exact IHS | apply after_contains].
    - now apply (the_end_holds_all w views y E c second v groups). }
  auto.
Qed.

(** ** The five lemmas of Quick-CULLIDE, where they are not in the theorems above *)
(** 1: FFV and SFV are collision-free, also with BFV added. *)
Lemma quick_1 w meet b second : facts w meet b -> forall u t, meet u t -> owner w u < owner w t ->
  ~ (In u (bit second b) /\ In t (bit second b)).
Proof. intros F u t M O. destruct (F u t M O). destruct second; simpl; tauto. Qed.

(** 2 (first pass, FFV) and 4 (second pass, SFV): to ask also what has the bit of the pass adds no bit, and
    takes none away where each item is asked alone. *)
Definition asking_more (p : pass) (more : nat -> bool) : pass :=
  Pass (second p) (along p) (groups p) (fun t => asks p t || more t) (stores p).
Lemma quick_2_and_4 w b second v groups more :
  (forall t, more t = true -> In t (bit second b)) ->
  let p := quick b second v groups in
  within (after w b (asking_more p more)) (after w b p) /\
  ((forall o g, In g (groups o) -> exists t, g = [t]) -> within (after w b p) (after w b (asking_more p more))).
Proof.
  intros M p. split.
  - apply less_asked_and_stored; simpl; auto; [split; apply incl_refl|..]; intros t H; [now rewrite H|].
    apply orb_true_iff in H as [H | H]; auto.
  - intros One.
    assert (C : incl (cleared w p) (cleared w (asking_more p more))).
    { intros t. rewrite !cleared_spec. intros (o & g & O & G & T & [K U] & N). exists o, g. simpl in *.
      destruct (One o g G) as [x ->]. destruct T as [-> | []]. do 2 (apply conj; [trivial|]).
      apply conj; [now left|]. apply conj; [split; simpl; [now rewrite K | trivial]|].
      destruct N as [N | N]; [now left|right]. intros y u [<- | []] Y. apply N; [now left | split; trivial]. }
    unfold after. simpl. destruct second; split; simpl; try apply incl_refl;
      (apply incl_app; [now apply incl_appl | apply incl_appr, incl_refl]).
Qed.

(** 3 (second pass, FFV) and 5 (first pass, SFV): what has the other bit need not be stored, since the
    pass is allowed without ([passes_are_allowed]); and storing more, of which items ever, adds no bit. *)
Lemma quick_3_and_5 w b second v groups more :
  let p := quick b second v groups in
  within (after w b (Pass second v groups (asks p) (fun u => stores p u || more u))) (after w b p).
Proof.
  apply less_asked_and_stored; simpl; auto; [split; apply incl_refl|..]; intros u H. now rewrite H.
Qed.

(** ** Boxes before pixels *)
(** No pair whose boxes overlap and that meets is left out: whatever is drawn of it, and in whatever
    order the items of drawn pairs pass, if views show the contacts of drawn pairs. *)
Theorem no_pair_that_meets_is_left_out owner drawn boxes (meet : nat -> nat -> Prop) ss :
  let w := drawn_world owner drawn boxes in
  let drawn_meet u t := meet u t /\ In (u, t) boxes /\ drawn u t = true in
  allowed_run w drawn_meet (Bits [] []) ss ->
  forall u t, In (u, t) boxes -> owner u <= owner t -> meet u t ->
    In (u, t) (filter (tested w drawn (run w (Bits [] []) ss)) boxes).
Proof.
  intros w drawn_meet A u t B O M. rewrite filter_In. split; [trivial|]. unfold tested.
  destruct (drawn u t) eqn:D; [|trivial]. simpl. destruct (owner u =? owner t) eqn:E; [trivial|]. simpl.
  apply Nat.eqb_neq in E. rewrite andb_true_iff, !not_mem.
  apply (what_meets_keeps_its_bits_unset w drawn_meet) with (b := Bits [] []); trivial; [|firstorder| |simpl; lia].
  - intros x y (_ & X & Y) _. simpl. rewrite !in_flat_map. split; exists (x, y); rewrite Y; simpl; auto.
  - now repeat split.
Qed.

Check what_meets_keeps_its_bits_unset.
Print Assumptions what_meets_keeps_its_bits_unset.
Check what_is_culled_meets_nothing.
Print Assumptions what_is_culled_meets_nothing.
Check passes_are_allowed.
Print Assumptions passes_are_allowed.
Check no_pair_that_meets_is_left_out.
Print Assumptions no_pair_that_meets_is_left_out.
Check quick_1.
Print Assumptions quick_1.
Check quick_2_and_4.
Print Assumptions quick_2_and_4.
Check quick_3_and_5.
Print Assumptions quick_3_and_5.
Check quick_is_never_behind.
Print Assumptions quick_is_never_behind.
Check a_pass_left_out_sets_nothing.
Print Assumptions a_pass_left_out_sets_nothing.
Check all_runs_end_alike.
Print Assumptions all_runs_end_alike.
