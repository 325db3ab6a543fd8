(** The checker decides all pairs whose boxes overlap. *)
From Coq Require Import ZArith NArith QArith Lqa Lia List Bool Permutation.
Require Import Spec Checker.
Import ListNotations.
Open Scope Z_scope.

(** * Boxes and trees *)
Lemma overlap_true l h l' h' : overlap l h l' h' = true <->
  x l <= x h' /\ x l' <= x h /\ y l <= y h' /\ y l' <= y h /\ z l <= z h' /\ z l' <= z h.
Proof. unfold overlap. rewrite !andb_true_iff, !Z.leb_le. tauto. Qed.

Definition within (r : bounds) (b : item) : Prop :=
  x (low r) <= x (lo b) /\ y (low r) <= y (lo b) /\ z (low r) <= z (lo b) /\
  x (hi b) <= x (high r) /\ y (hi b) <= y (high r) /\ z (hi b) <= z (high r) /\ obj b <= last r.
Fixpoint leaves (t : tree) : list item :=
  match t with Leaf _ held => held | Node _ one other => leaves one ++ leaves other end.
Fixpoint sound_tree (t : tree) : Prop :=
  (forall b, In b (leaves t) -> within (around t) b) /\
  match t with Leaf _ _ => True | Node _ one other => sound_tree one /\ sound_tree other end.

Definition below (p q : vec Z) : Prop := x p <= x q /\ y p <= y q /\ z p <= z q.
Lemma fold_down (l : list item) : forall p,
  below (fold_left (fun p b => down p (lo b)) l p) p /\
  forall b, In b l -> below (fold_left (fun p b => down p (lo b)) l p) (lo b).
Proof.
  induction l as [|a l IH]; intros p; cbn [fold_left].
  - split; [unfold below; lia | intros b []].
  - destruct (IH (down p (lo a))) as [D E]. unfold below, down in *. cbn [x y z] in *.
    split; [lia|]. intros b [<- | B]; [lia | auto].
Qed.
Lemma fold_up (l : list item) : forall p,
  below p (fold_left (fun p b => up p (hi b)) l p) /\
  forall b, In b l -> below (hi b) (fold_left (fun p b => up p (hi b)) l p).
Proof.
  induction l as [|a l IH]; intros p; cbn [fold_left].
  - split; [unfold below; lia | intros b []].
  - destruct (IH (up p (hi a))) as [D E]. unfold below, up in *. cbn [x y z] in *.
    split; [lia|]. intros b [<- | B]; [lia | auto].
Qed.
Lemma fold_last (l : list item) : forall n,
  n <= fold_left (fun n b => Z.max n (obj b)) l n /\
  forall b, In b l -> obj b <= fold_left (fun n b => Z.max n (obj b)) l n.
Proof.
  induction l as [|a l IH]; intros n; cbn [fold_left]; [split; [lia | intros b []]|].
  destruct (IH (Z.max n (obj a))) as [D E]. split; [lia|]. intros b [<- | B]; [lia | auto].
Qed.
Lemma leaf_sound l : sound_tree (leaf l) /\ leaves (leaf l) = l.
Proof.
  destruct l as [|a l]; [simpl; tauto|]. unfold leaf. cbn [sound_tree leaves around].
  split; [|reflexivity]. split; [|exact I]. intros b B.
  destruct (fold_down (a :: l) (lo a)) as [_ D]. specialize (D _ B).
  destruct (fold_up (a :: l) (hi a)) as [_ U]. specialize (U _ B).
  destruct (fold_last (a :: l) (obj a)) as [_ N]. specialize (N _ B).
  unfold below, within in *. cbn [low high last]. tauto.
Qed.
Lemma node_sound s t : sound_tree s -> sound_tree t -> sound_tree (node s t).
Proof.
  intros S T. unfold node. cbn [sound_tree leaves around]. split; [|auto].
  assert (S' : forall b, In b (leaves s) -> within (around s) b) by (destruct s; apply S).
  assert (T' : forall b, In b (leaves t) -> within (around t) b) by (destruct t; apply T).
  intros b B. apply in_app_or in B. unfold within, down, up in *. cbn [low high last x y z].
  destruct B as [B | B]; [specialize (S' b B) | specialize (T' b B)]; lia.
Qed.
Lemma divide_permutation f l : forall yes no yes' no', divide f l yes no = (yes', no') ->
  Permutation (yes' ++ no') (l ++ yes ++ no).
Proof.
  induction l as [|a l IH]; intros yes no yes' no' E; cbn [divide] in E.
  - injection E as <- <-. reflexivity.
  - destruct (f a); rewrite (IH _ _ _ _ E); cbn [app]; rewrite !app_assoc.
    + rewrite <- !app_assoc. cbn [app]. symmetry. apply Permutation_middle.
    + symmetry. apply Permutation_middle.
Qed.
Lemma build_sound n : forall l, sound_tree (build n l) /\ Permutation (leaves (build n l)) l.
Proof.
  assert (L : forall l, sound_tree (leaf l) /\ Permutation (leaves (leaf l)) l).
  { intros l. destruct (leaf_sound l) as [S E]. rewrite E. auto. }
  induction n as [|n IH]; intros l; [apply L|]. cbn [build].
  destruct l as [|a [|a2 [|a3 [|a4 [|a5 l]]]]]; try apply L.
  set (m := a :: a2 :: a3 :: a4 :: a5 :: l).
  destruct (divide (halve a m) m [] []) as [yes no] eqn:D.
  pose proof (divide_permutation _ _ _ _ _ _ D) as A. clearbody m.
  destruct yes as [|u yes]; [apply L|]. destruct no as [|v no]; [apply L|].
  destruct (IH (u :: yes)) as [S1 E1], (IH (v :: no)) as [S2 E2].
  split; [now apply node_sound|]. unfold node. cbn [leaves].
  rewrite E1, E2, A, app_nil_r. reflexivity.
Qed.

(** * The search for partners *)
Lemma pick_permutation a l : forall found,
  Permutation (pick a l found) (filter (candidate a) l ++ found).
Proof.
  induction l as [|b l IH]; intros found; cbn [pick filter]; [reflexivity|].
  rewrite IH. destruct (candidate a b); [|reflexivity]. symmetry. apply Permutation_middle.
Qed.
Lemma candidate_may_ask a r b : within r b -> candidate a b = true -> may_ask a r = true.
Proof.
  unfold candidate, comes_before, may_ask, within.
  rewrite !andb_true_iff, !orb_true_iff, !andb_true_iff, !overlap_true, !Z.ltb_lt, !Z.eqb_eq.
  intros W [[A | [[A O] N]] V]; (split; [|lia]); destruct (Z.eq_dec (obj a) (last r)); tauto || lia.
Qed.
Lemma none_filtered {A} (f : A -> bool) l : (forall b, In b l -> f b = false) -> filter f l = [].
Proof.
  induction l as [|b l IH]; intros H; cbn [filter]; [reflexivity|].
  rewrite (H b) by now left. apply IH. intros c C. apply H. now right.
Qed.
Lemma query_permutation a t : sound_tree t -> forall found,
  Permutation (query a t found) (filter (candidate a) (leaves t) ++ found).
Proof.
  assert (Q : forall t, sound_tree t -> may_ask a (around t) = false ->
              filter (candidate a) (leaves t) = []).
  { clear. intros t S O. apply none_filtered. intros b B.
    assert (W : within (around t) b) by (destruct t; now apply S).
    destruct (candidate a b) eqn:C; [|reflexivity].
    apply (candidate_may_ask _ _ _ W) in C. congruence. }
  induction t as [r held | r one IH1 other IH2]; intros S found; cbn [query];
    destruct (may_ask a (around _)) eqn:O; try (rewrite (Q _ S O); reflexivity).
  - apply pick_permutation.
  - destruct S as (_ & S1 & S2). cbn [leaves].
    rewrite (IH1 S1), (IH2 S2), filter_app, app_assoc. reflexivity.
Qed.
Lemma query_all a t : sound_tree t -> forall b,
  In b (query a t []) <-> In b (leaves t) /\ candidate a b = true.
Proof.
  intros S b. rewrite <- filter_In. pose proof (query_permutation a t S []) as P.
  rewrite app_nil_r in P. split; apply Permutation_in; [exact P | now symmetry].
Qed.
Lemma sort_permutation l : Permutation (Sorting.sort l) l.
Proof. symmetry. apply Sorting.Permuted_sort. Qed.
Lemma sort_all l b : In b (Sorting.sort l) <-> In b l.
Proof. split; apply Permutation_in; [|symmetry]; apply sort_permutation. Qed.
Lemma put_all mine a l : forall done p, In p (put mine a l done) <->
  In p done \/ exists b, In b l /\ mine a b = true /\ p = (a, b).
Proof.
  induction l as [|c l IH]; intros done p; cbn [put].
  - split; [auto | intros [D | (b & [] & _)]; assumption].
  - rewrite IH. simpl. destruct (mine a c) eqn:M; simpl; split.
    + intros [[<- | D] | (b & B & P)]; eauto 6.
    + intros [D | (b & [<- | B] & M' & ->)]; eauto 6.
    + intros [D | (b & B & P)]; eauto 6.
    + intros [D | (b & [<- | B] & M' & ->)]; [eauto | congruence | eauto 6].
Qed.
Lemma collect_all mine r t l : sound_tree t -> forall done a b,
  In (a, b) (collect mine r t l done) <->
  In (a, b) done \/
  (In a l /\ In b (leaves t) /\ candidate (grow (r a) a) b = true /\ mine a b = true).
Proof.
  intros S. induction l as [|c l IH]; intros done a b; cbn [collect]; [simpl; tauto|].
  rewrite IH, put_all. split.
  - intros [[D | (b' & B & M & E)] | H]; [auto | | simpl; tauto]. injection E as -> ->.
    apply sort_all, query_all in B; [|assumption]. simpl. tauto.
  - intros [D | ([<- | A] & L & C & M)]; [auto | | tauto]. left. right. exists b.
    split; [|auto]. apply sort_all, query_all; auto.
Qed.
Theorem pairs_all mine r l a b : In (a, b) (pairs mine r l) <->
  In a l /\ In b l /\ candidate (grow (r a) a) b = true /\ mine a b = true.
Proof.
  unfold pairs. destruct (build_sound 64 l) as [S L].
  assert (E : In b (leaves (build 64 l)) <-> In b l)
    by (split; apply Permutation_in; auto using Permutation_sym).
  rewrite (collect_all _ _ _ _ S), E. simpl. tauto.
Qed.
Lemma grow_candidate r a b : candidate (grow r a) b = true <->
  comes_before a b = true /\
  overlap (sub (lo a) (Vec r r r)) (add (hi a) (Vec r r r)) (lo b) (hi b) = true.
Proof.
  unfold candidate, grow. rewrite andb_true_iff. destruct (Z.eqb_spec r 0) as [-> | _].
  - rewrite !overlap_true. unfold sub, add. cbn [x y z]. rewrite !Z.sub_0_r, !Z.add_0_r. tauto.
  - reflexivity.
Qed.

(** * No pair occurs twice *)
Lemma put_once mine a l : NoDup l -> forall done, NoDup done ->
  (forall b, In b l -> ~ In (a, b) done) -> NoDup (put mine a l done).
Proof.
  induction 1 as [|c l C N IH]; intros done D E; cbn [put]; [exact D|].
  apply IH; destruct (mine a c); try (constructor; [apply E; now left | exact D]); try exact D.
  - intros b B [H | H]; [injection H as <-; contradiction | now apply (E b); [right|]].
  - intros b B. apply E. now right.
Qed.
Lemma collect_once mine r t l : sound_tree t -> NoDup (leaves t) -> NoDup l -> forall done,
  NoDup done -> (forall a b, In a l -> ~ In (a, b) done) -> NoDup (collect mine r t l done).
Proof.
  intros S L. induction 1 as [|c l C N IH]; intros done D E; cbn [collect]; [exact D|]. apply IH.
  - apply put_once; [|exact D | intros b _; apply E; now left].
    eapply Permutation_NoDup; [symmetry; apply sort_permutation|].
    eapply Permutation_NoDup; [symmetry; now apply query_permutation|].
    rewrite app_nil_r. now apply NoDup_filter.
  - intros a b A H. apply put_all in H. destruct H as [H | (b' & _ & _ & H)].
    + now apply (E a b); [right|].
    + injection H as -> _. contradiction.
Qed.
Theorem pairs_once mine r l : NoDup l -> NoDup (pairs mine r l).
Proof.
  intros N. unfold pairs. destruct (build_sound 64 l) as [S P]. apply collect_once; auto.
  - eapply Permutation_NoDup; [symmetry; exact P | exact N].
  - constructor.
Qed.

(** * The triangles *)
Lemma keep_all b r o i inner t done n : In n (keep b r o i inner t done) <->
  In n done \/ (is_needed b r t = true /\ n = Named o i inner t).
Proof.
  unfold keep. destruct (is_needed b r t); simpl; [intuition | intuition discriminate].
Qed.
Lemma keep_triangles_all b r o inner l : forall i done n,
  In n (keep_triangles b r o i inner l done) <->
  In n done \/ exists k t, nth_error l k = Some t /\ is_needed b r t = true /\
                n = Named o (i + Z.of_nat k) inner t.
Proof.
  induction l as [|t l IH]; intros i done n; cbn [keep_triangles].
  - split; [auto|]. intros [D | (k & t & N & _)]; [assumption | destruct k; discriminate].
  - rewrite IH, keep_all. split.
    + intros [[D | [M ->]] | (k & u & N & M & ->)]; [auto | right | right].
      * exists O, t. split; [reflexivity|]. split; [assumption|]. f_equal. lia.
      * exists (S k), u. split; [exact N|]. split; [assumption|]. f_equal. lia.
    + intros [D | (k & u & N & M & ->)]; [left; left; assumption|]. destruct k as [|k].
      * left. right. injection N as ->. split; [assumption|]. f_equal. lia.
      * right. exists k, u. split; [exact N|]. split; [assumption|]. f_equal. lia.
Qed.
Lemma keep_objects_all b r s : forall o done n,
  In n (keep_objects b r o s done) <->
  In n done \/ exists m ob k t, nth_error s m = Some ob /\ nth_error (triangles ob) k = Some t /\
                is_needed b r t = true /\ n = Named (o + Z.of_nat m) (Z.of_nat k) (self ob) t.
Proof.
  induction s as [|ob s IH]; intros o done n; cbn [keep_objects].
  - split; [auto|]. intros [D | (m & ? & ? & ? & N & _)]; [assumption | destruct m; discriminate].
  - rewrite IH, keep_triangles_all. split.
    + intros [[D | (k & t & N & M & ->)] | (m & ob' & k & t & O & N & M & ->)];
        [auto | right | right].
      * exists O, ob, k, t. repeat split; auto. f_equal; lia.
      * exists (S m), ob', k, t. repeat split; auto. f_equal; lia.
    + intros [D | (m & ob' & k & t & O & N & M & ->)]; [auto|]. destruct m as [|m].
      * left. right. injection O as ->. exists k, t. repeat split; auto. f_equal; lia.
      * right. exists m, ob', k, t. repeat split; auto. f_equal; lia.
Qed.
Theorem gathered_all b r s n : In n (gathered b r s) <->
  exists m ob k t, nth_error s m = Some ob /\ nth_error (triangles ob) k = Some t /\
                   is_needed b r t = true /\ n = Named (Z.of_nat m) (Z.of_nat k) (self ob) t.
Proof.
  unfold gathered. rewrite keep_objects_all. simpl. split; [intros [[] | H] | intros H; right]; exact H.
Qed.
Lemma keep_triangles_once b r o inner l : forall i done, NoDup done ->
  (forall n, In n done -> of_object n <> o \/ number n < i) ->
  NoDup (keep_triangles b r o i inner l done).
Proof.
  induction l as [|t l IH]; intros i done D E; cbn [keep_triangles]; [exact D|].
  unfold keep. apply IH; destruct (is_needed b r t).
  - constructor; [|exact D]. intros H. apply E in H. cbn [of_object number] in H. lia.
  - exact D.
  - intros n [<- | H]; cbn [of_object number]; [lia|]. apply E in H. lia.
  - intros n H. apply E in H. lia.
Qed.
Lemma keep_objects_once b r s : forall o done, NoDup done ->
  (forall n, In n done -> of_object n < o) -> NoDup (keep_objects b r o s done).
Proof.
  induction s as [|ob s IH]; intros o done D E; cbn [keep_objects]; [exact D|]. apply IH.
  - apply keep_triangles_once; [exact D|]. intros n H. apply E in H. lia.
  - intros n H. apply keep_triangles_all in H. destruct H as [H | (k & t & _ & _ & ->)].
    + apply E in H. lia.
    + cbn [of_object]. lia.
Qed.
Theorem gathered_once b r s : NoDup (gathered b r s).
Proof. apply keep_objects_once; [constructor | intros n []]. Qed.
Lemma items_map e l : items_of e l = map (make_item e) l.
Proof.
  assert (F : forall l done, fold_left (fun done n => make_item e n :: done) l done =
                        rev (map (make_item e) l) ++ done).
  { clear l. induction l as [|n l IH]; intros done; cbn [fold_left map rev app]; [reflexivity|].
    rewrite IH, <- app_assoc. reflexivity. }
  unfold items_of. rewrite F, rev_append_rev, !app_nil_r, map_rev, rev_involutive. reflexivity.
Qed.
Lemma items_all e l it : In it (items_of e l) <-> exists n, In n l /\ it = make_item e n.
Proof.
  rewrite items_map, in_map_iff. split; intros (n & A & B); exists n; auto.
Qed.
Lemma map_once {A B} (f : A -> B) l : (forall x y, In x l -> In y l -> f x = f y -> x = y) ->
  NoDup l -> NoDup (map f l).
Proof.
  intros I. induction 1 as [|a l H N IH]; cbn [map]; constructor.
  - intros M. apply in_map_iff in M. destruct M as (b & E & M).
    apply I in E; [subst b; contradiction | now right | now left].
  - apply IH. intros x y X Y. apply I; now right.
Qed.

(** * The common power of two *)
Definition at_most_vec (e : Z) (p : vec double) : Prop :=
  e <= exponent (x p) /\ e <= exponent (y p) /\ e <= exponent (z p).
Definition at_most_triangle (e : Z) (t : triangle double) : Prop :=
  at_most_vec e (p1 t) /\ at_most_vec e (p2 t) /\ at_most_vec e (p3 t).
Lemma lower_triangle_sound e t : lower_triangle e t <= e /\ at_most_triangle (lower_triangle e t) t.
Proof.
  unfold at_most_triangle, at_most_vec, lower_triangle, lower_vec, lower. lia.
Qed.
Lemma at_most_less e e' t : e' <= e -> at_most_triangle e t -> at_most_triangle e' t.
Proof. unfold at_most_triangle, at_most_vec. lia. Qed.
Lemma lowest_all l : forall e, lowest l e <= e /\
  forall n, In n l -> at_most_triangle (lowest l e) (corners n).
Proof.
  unfold lowest. induction l as [|n l IH]; intros e; cbn [fold_left]; [split; [lia | intros ? []]|].
  destruct (IH (lower_triangle e (corners n))) as [L A].
  destruct (lower_triangle_sound e (corners n)) as [L' A'].
  split; [lia|]. intros m [<- | M]; [eapply at_most_less, A'; lia | auto].
Qed.
