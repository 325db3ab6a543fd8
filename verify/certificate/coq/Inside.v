(** What the checker says about one object inside another is true. *)
From Coq Require Import ZArith NArith QArith Qpower Lqa Lia List Bool Permutation Setoid Morphisms.
Require Import Spec Checker InsideChecker Geometry Points Pairs Scaling.
Import ListNotations.
Open Scope Q_scope.

(** * A ray and a triangle *)
Lemma qdot_ray n p d r : qdot n (plus p (times r d)) == qdot n p + r * qdot n d.
Proof. unfold qdot, plus, times. cbn [x y z]. ring. Qed.
Lemma dot_sub n a p : dot n (sub a p) = (dot n a - dot n p)%Z.
Proof. unfold dot, sub. cbn [x y z]. ring. Qed.
Lemma missed_by n p d t :
  (dot n p < dot n (p1 t))%Z -> (dot n p < dot n (p2 t))%Z -> (dot n p < dot n (p3 t))%Z ->
  (dot n d <= 0)%Z -> crossing (qvec p) (qvec d) (qtri t) 0.
Proof.
  intros A B C D. apply Misses. intros r R I.
  assert (L : #(dot n p + 1) <= qdot n (plus (qvec p) (times r (qvec d)))) by (apply (dot_at_least n t); auto; lia).
  rewrite qdot_ray, !qdot_qvec, inject_Z_plus in L. change #1 with 1 in L.
  apply -> inject_le in D. change #0 with 0 in D.
  assert (0 <= r * (- #(dot n d))) by (apply Qmult_le_0_compat; lra). lra.
Qed.
(** Cramer's rule finds where the line of the ray crosses the plane. *)
Lemma crosses p d t k : let a := sub (p1 t) p in let b := sub (p2 t) p in let c := sub (p3 t) p in
  k = 1%Z \/ k = (-1)%Z -> (0 < k * dot d (cross a b))%Z -> (0 < k * dot d (cross b c))%Z ->
  (0 < k * dot d (cross c a))%Z -> (0 < k * dot a (cross b c))%Z ->
  crossing (qvec p) (qvec d) (qtri t) k.
Proof.
  intros a b c K AB BC CA V.
  assert (EX : (dot a (cross b c) * x d = dot d (cross b c) * x a + dot d (cross c a) * x b + dot d (cross a b) * x c)%Z)
    by (unfold dot, cross; cbn [x y z]; ring).
  assert (EY : (dot a (cross b c) * y d = dot d (cross b c) * y a + dot d (cross c a) * y b + dot d (cross a b) * y c)%Z)
    by (unfold dot, cross; cbn [x y z]; ring).
  assert (EZ : (dot a (cross b c) * z d = dot d (cross b c) * z a + dot d (cross c a) * z b + dot d (cross a b) * z c)%Z)
    by (unfold dot, cross; cbn [x y z]; ring).
  assert (W : volume (qvec d) (p1 (qtri t)) (p2 (qtri t)) + volume (qvec d) (p2 (qtri t)) (p3 (qtri t)) +
              volume (qvec d) (p3 (qtri t)) (p1 (qtri t)) ==
              #(dot d (cross a b)) + #(dot d (cross b c)) + #(dot d (cross c a))).
  { unfold volume, dot, cross, a, b, c, sub, qtri, qvec, map_triangle, map_vec. cbn [x y z p1 p2 p3].
    inject. ring. }
  set (ab := dot d (cross a b)) in *. set (bc := dot d (cross b c)) in *.
  set (ca := dot d (cross c a)) in *. set (v := dot a (cross b c)) in *.
  apply -> inject_lt in AB. apply -> inject_lt in BC. apply -> inject_lt in CA. apply -> inject_lt in V.
  apply -> inject_eq in EX. apply -> inject_eq in EY. apply -> inject_eq in EZ.
  unfold a, b, c, sub in EX, EY, EZ. cbn [x y z] in EX, EY, EZ. clearbody ab bc ca v. clear a b c.
  inject. change #0 with 0 in *.
  assert (S : 0 < #k * (#ab + #bc + #ca)) by lra.
  assert (N : ~ #ab + #bc + #ca == 0) by (intros N; rewrite N in S; lra).
  assert (M : ~ #k == 0) by (destruct K as [-> | ->]; discriminate).
  assert (P : forall g, 0 < #k * g -> 0 < #k * g / (#k * (#ab + #bc + #ca))).
  { intros g G. apply Qlt_shift_div_l; [assumption|]. now rewrite Qmult_0_l. }
  apply (Crosses _ _ _ _ _ _ _ k (P _ V) (P _ BC) (P _ CA) (P _ AB)); [field; auto | assumption | |].
  - assert (L : forall p0 d0 a0 b0 c0, #v * d0 == #bc * (a0 - p0) + #ca * (b0 - p0) + #ab * (c0 - p0) ->
      p0 + #k * #v / (#k * (#ab + #bc + #ca)) * d0 ==
      #k * #bc / (#k * (#ab + #bc + #ca)) * a0 + #k * #ca / (#k * (#ab + #bc + #ca)) * b0 +
      #k * #ab / (#k * (#ab + #bc + #ca)) * c0).
    { intros p0 d0 a0 b0 c0 E.
      setoid_replace (#k * #v / (#k * (#ab + #bc + #ca)) * d0) with ((#v * d0) / (#ab + #bc + #ca)) by (field; auto).
      rewrite E. field. auto. }
    unfold same, mix, plus, times, qtri, qvec, map_triangle, map_vec. cbn [x y z p1 p2 p3].
    repeat split; apply L; assumption.
  - now rewrite W.
Qed.
Lemma crossing_of_sound p d t k : crossing_of p d t = Some k -> crossing (qvec p) (qvec d) (qtri t) k.
Proof.
  unfold crossing_of. cbv zeta. destruct (_ && _ && _ && _)%bool eqn:P.
  - intros E. injection E as <-. tests. apply crosses; auto; rewrite Z.mul_1_l; assumption.
  - clear P. destruct (_ && _ && _ && _)%bool eqn:P.
    + intros E. injection E as <-. tests. apply crosses; auto; lia.
    + destruct (existsb _ _) eqn:X; [|discriminate]. intros E. injection E as <-.
      apply existsb_exists in X. destruct X as (n & _ & X). unfold parts in X. tests.
      rewrite dot_sub in *. apply (missed_by n); lia.
Qed.

(** * A ray and a tree *)
Definition boxed (a : item) : Prop := lo a = least (shape a) /\ hi a = greatest (shape a).
Lemma lowest_along_sound n l h q : (x l <= x q <= x h)%Z -> (y l <= y q <= y h)%Z -> (z l <= z q <= z h)%Z ->
  (lowest_along n l h <= dot n q)%Z.
Proof.
  assert (M : forall m i j k, (i <= j <= k)%Z -> (Z.min (m * i) (m * k) <= m * j)%Z).
  { intros m i j k H. destruct (Z_le_dec 0 m) as [S | S].
    - etransitivity; [apply Z.le_min_l | apply Z.mul_le_mono_nonneg_l; lia].
    - etransitivity; [apply Z.le_min_r | apply Z.mul_le_mono_nonpos_l; lia]. }
  intros X Y Z. apply (M (x n)) in X. apply (M (y n)) in Y. apply (M (z n)) in Z.
  unfold lowest_along, dot. lia.
Qed.
Lemma beside_sound p d r a : beside p d r = true -> within r a -> boxed a ->
  crossing (qvec p) (qvec d) (qtri (shape a)) 0.
Proof.
  unfold beside. intros H W [L U]. apply existsb_exists in H. destruct H as (n & _ & H). tests.
  unfold within in W. rewrite L, U in W. unfold least, greatest, min3, max3 in W. cbn [x y z] in W.
  assert (C : forall q, q = p1 (shape a) \/ q = p2 (shape a) \/ q = p3 (shape a) -> (dot n p < dot n q)%Z).
  { intros q Q. enough (0 < dot n (sub q p))%Z by (rewrite dot_sub in *; lia).
    eapply Z.lt_le_trans; [eassumption|]. apply lowest_along_sound; unfold sub; cbn [x y z];
      destruct Q as [-> | [-> | ->]]; lia. }
  apply (missed_by n); auto.
Qed.
Definition qshape (a : item) : triangle Q := qtri (shape a).
Lemma all_missed p d l : (forall a, In a l -> crossing p d (qshape a) 0) ->
  exists ks, Forall2 (crossing p d) (map qshape l) ks /\ Forall (eq 0%Z) ks.
Proof.
  induction l as [|a l IH]; intros H; [exists []; split; constructor|].
  destruct IH as (ks & F & Z); [intros b B; apply H; now right|].
  exists (0%Z :: ks). split; constructor; auto. apply H. now left.
Qed.
Lemma zero_sum ks : Forall (eq 0%Z) ks -> fold_right Z.add 0%Z ks = 0%Z.
Proof. induction 1 as [|k ks K _ IH]; cbn [fold_right]; [reflexivity | lia]. Qed.
Lemma fold_sum_app ks ks' :
  fold_right Z.add 0%Z (ks ++ ks') = (fold_right Z.add 0 ks + fold_right Z.add 0 ks')%Z.
Proof. induction ks as [|k ks IH]; cbn [fold_right app]; lia. Qed.
Lemma all_beside p d t : sound_tree t -> (forall a, In a (leaves t) -> boxed a) ->
  beside p d (around t) = true ->
  exists ks, Forall2 (crossing (qvec p) (qvec d)) (map qshape (leaves t)) ks /\ Forall (eq 0%Z) ks.
Proof.
  intros S B H. apply all_missed. intros a A. apply (beside_sound p d (around t)); auto.
  destruct t; apply S; assumption.
Qed.
Lemma wind_sound p d t : sound_tree t -> (forall a, In a (leaves t) -> boxed a) ->
  forall k, wind p d t = Some k -> exists ks,
    Forall2 (crossing (qvec p) (qvec d)) (map qshape (leaves t)) ks /\ fold_right Z.add 0%Z ks = k.
Proof.
  induction t as [r held | r one IH1 other IH2]; intros S B k; cbn [wind];
    (destruct (beside p d (around _)) eqn:X;
     [intros E; injection E as <-; destruct (all_beside _ _ _ S B X) as (ks & F & Z);
      exists ks; auto using zero_sum|]); clear X.
  - clear S B. cbn [leaves]. revert k.
    induction held as [|a held IH]; intros k E; cbn [fold_right] in E.
    + injection E as <-. exists []. split; [constructor | reflexivity].
    + destruct (crossing_of p d (shape a)) as [i|] eqn:C; [|discriminate].
      destruct (fold_right _ _ held) as [j|]; [|discriminate]. injection E as <-.
      destruct (IH j eq_refl) as (ks & F & Z). exists (i :: ks). split; [|cbn [fold_right]; lia].
      constructor; [now apply crossing_of_sound | assumption].
  - destruct S as (_ & S1 & S2). cbn [leaves] in *.
    destruct (wind p d one) as [i|]; [|discriminate]. destruct (wind p d other) as [j|]; [|discriminate].
    intros E. injection E as <-.
    destruct (IH1 S1 (fun a A => B a (in_or_app _ _ _ (or_introl A))) i eq_refl) as (ks & F & Z).
    destruct (IH2 S2 (fun a A => B a (in_or_app _ _ _ (or_intror A))) j eq_refl) as (ks' & F' & Z').
    exists (ks ++ ks'). rewrite map_app, fold_sum_app. split; [now apply Forall2_app | lia].
Qed.

(** * The scene *)
Lemma crossing_sized k t t' P p D d c : 0 < k -> sized k t t' -> same P (times k p) -> same D (times k d) ->
  crossing p d t' c -> crossing P D t c.
Proof.
  intros K S SP SD H. assert (KN : ~ k == 0) by lra.
  destruct H as [H | r u v w c R U V W T C E L].
  - apply Misses. intros r R I. apply (H r R).
    apply (inside_sized (/ k) t' t) in I; [|now apply sized_inverse].
    assert (E : same (times (/ k) (plus P (times r D))) (plus p (times r d))).
    { coordinates. repeat split; match goal with |- _ * (?a + _ * ?b) == _ =>
        match goal with X : a == _ |- _ => rewrite X end; match goal with X : b == _ |- _ => rewrite X end end;
        field; assumption. }
    now rewrite <- E.
  - apply (Crosses _ _ _ r u v w c R U V W T C).
    + assert (G : forall i j i' j' a b e a' b' e', i == k * i' -> j == k * j' -> a == k * a' -> b == k * b' ->
        e == k * e' -> i' + r * j' == u * a' + v * b' + w * e' -> i + r * j == u * a + v * b + w * e).
      { clear. intros i j i' j' a b e a' b' e' -> -> -> -> -> H.
        setoid_replace (k * i' + r * (k * j')) with (k * (i' + r * j')) by ring. rewrite H. ring. }
      coordinates. repeat split; eapply G; eassumption.
    + assert (Y : volume D (p1 t) (p2 t) + volume D (p2 t) (p3 t) + volume D (p3 t) (p1 t) ==
        k * k * k * (volume d (p1 t') (p2 t') + volume d (p2 t') (p3 t') + volume d (p3 t') (p1 t'))).
      { unfold volume. coordinates.
        repeat match goal with X : ?a == k * _ |- _ => rewrite X; clear X end. ring. }
      rewrite Y. set (g := volume d _ _ + _ + _) in *.
      setoid_replace (#c * (k * k * k * g)) with (k * k * k * (#c * g)) by ring.
      assert (0 < k * k) by nra. assert (0 < k * k * k) by nra. nra.
Qed.

Definition triangles_at (s : scene) (o : nat) : list (triangle double) :=
  match nth_error s o with Some ob => triangles ob | None => [] end.
Lemma mesh_at s o : mesh s o = map exact (triangles_at s o).
Proof. unfold mesh, triangles_at. now destruct (nth_error s o). Qed.
Definition of_number (o : Z) (l : list named) : list (triangle double) :=
  map corners (filter (fun n => of_object n =? o)%Z l).
Lemma keep_triangles_number r o o' inner ts : forall i done,
  of_number o (keep_triangles everything r o' i inner ts done) =
  (if (o' =? o)%Z then rev ts else []) ++ of_number o done.
Proof.
  induction ts as [|t ts IH]; intros i done; cbn [keep_triangles]; [now destruct (_ =? _)%Z|].
  rewrite IH. unfold keep. change (is_needed everything r t) with true. cbv iota.
  unfold of_number. cbn [filter of_object]. destruct (o' =? o)%Z; cbn [map rev corners]; [|reflexivity].
  now rewrite <- app_assoc.
Qed.
Lemma keep_objects_before r s : forall o k done, (o < k)%Z ->
  of_number o (keep_objects everything r k s done) = of_number o done.
Proof.
  induction s as [|ob s IH]; intros o k done L; cbn [keep_objects]; [reflexivity|].
  rewrite IH by lia. rewrite keep_triangles_number. destruct (Z.eqb_spec k o); [lia | reflexivity].
Qed.
Lemma keep_objects_number r s : forall k j done,
  of_number (k + Z.of_nat j) (keep_objects everything r k s done) =
  rev (triangles_at s j) ++ of_number (k + Z.of_nat j) done.
Proof.
  induction s as [|ob s IH]; intros k j done; cbn [keep_objects]; [now destruct j|]. destruct j as [|j].
  - rewrite keep_objects_before by lia. rewrite keep_triangles_number.
    replace (k + Z.of_nat 0)%Z with k by lia. now rewrite Z.eqb_refl.
  - replace (k + Z.of_nat (S j))%Z with (k + 1 + Z.of_nat j)%Z by lia.
    rewrite IH, keep_triangles_number. destruct (Z.eqb_spec k (k + 1 + Z.of_nat j)); [lia | reflexivity].
Qed.
Lemma items_of_map f l : items_of f l = map (make_item f) l.
Proof.
  unfold items_of. rewrite rev_append_rev, app_nil_r.
  assert (F : forall l done, fold_left (fun done n => make_item f n :: done) l done =
                             rev (map (make_item f) l) ++ done).
  { clear l. induction l as [|n l IH]; intros done; cbn [fold_left map rev]; [reflexivity|].
    now rewrite IH, <- app_assoc. }
  now rewrite F, app_nil_r, map_rev, rev_involutive.
Qed.

Lemma count_permutation {A} (f : A -> bool) l l' : Permutation l l' ->
  length (filter f l) = length (filter f l').
Proof.
  induction 1 as [|a l l' _ IH|a b l|l m n _ IH1 _ IH2]; cbn [filter]; [reflexivity | | |congruence].
  - destruct (f a); cbn [length]; congruence.
  - destruct (f a), (f b); reflexivity.
Qed.
Lemma is_same p q : is p q = true <-> same p q.
Proof.
  unfold is. rewrite Qeq_bool_iff. unfold same, squared_distance. split.
  - intros E. pose proof (square (x p - x q)). pose proof (square (y p - y q)). pose proof (square (z p - z q)).
    assert (N : forall a : Q, a * a <= 0 -> a == 0).
    { intros a L. destruct (Qeq_dec a 0) as [Y | Y]; [assumption|]. exfalso.
      destruct (Qlt_le_dec a 0); [nra|]. assert (0 < a) by (apply Qle_lt_or_eq in q0; destruct q0; [assumption | exfalso; apply Y; now symmetry]). nra. }
    assert (x p - x q == 0) by (apply N; lra). assert (y p - y q == 0) by (apply N; lra).
    assert (z p - z q == 0) by (apply N; lra). repeat split; lra.
  - intros (X & Y & Z). rewrite X, Y, Z. ring.
Qed.

#[local] Opaque build.
Section Scene.
Variables (s : scene) (reach : double) (f : Z).
Let l := gathered everything reach s.
Let items := items_of f l.
Context (A : forall n, In n l -> at_most_triangle f (corners n)).
Let k := 2 ^ f.
Definition grid (p : vec Z) : vec Q := times k (qvec p).

Section Object.
Variable o : nat.
Let m := members (surface_of (Z.of_nat o) items).
Lemma members_are : map shape m = map (map_triangle (scaled f)) (rev (triangles_at s o)).
Proof.
  assert (E : of_number (Z.of_nat o) l = rev (triangles_at s o)).
  { unfold l, gathered. change (Z.of_nat o) with (0 + Z.of_nat o)%Z. rewrite keep_objects_number.
    unfold of_number. cbn [filter map]. apply app_nil_r. }
  rewrite <- E. unfold m, surface_of, items, of_number. cbn [members]. rewrite items_of_map.
  generalize l. intros ns. induction ns as [|n l' IH]; cbn [map filter]; [reflexivity|].
  destruct (of_object n =? Z.of_nat o)%Z eqn:X; unfold make_item at 1; cbn [obj]; rewrite X;
    cbn [map shape]; [now rewrite IH | exact IH].
Qed.
Lemma at_most_members t : In t (triangles_at s o) -> at_most_triangle f t.
Proof.
  intros T. unfold triangles_at in T. destruct (nth_error s o) as [ob|] eqn:O; [|destruct T].
  apply In_nth_error in T. destruct T as (i & T).
  apply (A (Named (Z.of_nat o) (Z.of_nat i) (self ob) t)). apply gathered_all. exists o, ob, i, t. auto.
Qed.
Lemma members_boxed a : In a m -> boxed a.
Proof.
  unfold m, surface_of, items. cbn [members]. intros I. apply filter_In in I. destruct I as [I _].
  apply items_all in I. destruct I as (n & _ & ->). split; reflexivity.
Qed.
Let tree_of := held (surface_of (Z.of_nat o) items).
Lemma tree_sound : sound_tree tree_of /\ Permutation (leaves tree_of) m /\
  forall a, In a (leaves tree_of) -> boxed a.
Proof.
  change tree_of with (build 64 m). destruct (build_sound 64 m) as [S I].
  split; [assumption|]. split; [apply build_permutation|]. intros a H. apply members_boxed, I. exact H.
Qed.
(** What a ray shows of the integers it shows of the scene. *)
Lemma ray_of_mesh p d ks P : d <> origin -> same P (grid p) ->
  Forall2 (crossing (qvec p) (qvec d)) (map qshape (leaves tree_of)) ks ->
  exists ks', ray (mesh s o) P ks' /\ Permutation ks ks'.
Proof.
  intros N E F. destruct tree_sound as (_ & Q & _).
  assert (Q' : Permutation (map qshape (leaves tree_of)) (map qtri (map (map_triangle (scaled f)) (triangles_at s o)))).
  { rewrite Q. unfold qshape. rewrite <- (map_map shape qtri), members_are. apply Permutation_map.
    apply Permutation_map. symmetry. apply Permutation_rev. }
  destruct (Permutation_Forall2 Q' F) as (ks' & K & F'). exists ks'. split; [|assumption].
  pose proof (power_positive f) as KP. fold k in KP.
  exists (times k (qvec d)). split.
  - intros (X & Y & Z). apply N. unfold plus, times, qvec, map_vec in X, Y, Z. cbn [x y z] in X, Y, Z.
    assert (Z0 : forall i j, i + k * #j == i -> j = 0%Z).
    { intros i j H. apply inject_eq. change #0 with 0. assert (k * #j == 0) by lra.
      apply Qmult_integral in H0. destruct H0; [lra | assumption]. }
    destruct d as [d1 d2 d3]. cbn [x y z] in *. unfold origin.
    now rewrite (Z0 _ _ X), (Z0 _ _ Y), (Z0 _ _ Z).
  - rewrite mesh_at. clear - F' E A KP. pose proof at_most_members as M. revert F' M.
    generalize (triangles_at s o). intros ts. revert ks'.
    induction ts as [|t ts IH]; intros ks' F' M; cbn [map] in *; inversion F'; subst; constructor.
    + apply (crossing_sized k _ (qtri (map_triangle (scaled f) t)) P (qvec p) _ (qvec d)); auto using same_refl.
      apply sized_value. apply M. now left.
    + apply IH; [assumption|]. intros u U. apply M. now right.
Qed.
Lemma sum_permutation ks ks' : Permutation ks ks' -> fold_right Z.add 0%Z ks = fold_right Z.add 0%Z ks'.
Proof. induction 1; cbn [fold_right]; lia. Qed.
Lemma wind_ray p d j P : d <> origin -> same P (grid p) -> wind p d tree_of = Some j ->
  exists ks, ray (mesh s o) P ks /\ fold_right Z.add 0%Z ks = j.
Proof.
  intros N E W. destruct tree_sound as (S & _ & B). destruct (wind_sound _ _ _ S B _ W) as (ks & F & Z).
  destruct (ray_of_mesh _ _ _ _ N E F) as (ks' & R & Q). exists ks'. split; [assumption|].
  now rewrite <- (sum_permutation _ _ Q).
Qed.

(** * Edges *)
Let es := edge_items m.
Definition edges_of (a : item) : list item :=
  let t := shape a in [edge_item (p1 t) (p2 t); edge_item (p2 t) (p3 t); edge_item (p3 t) (p1 t)].
Definition goes (a b : vec Q) (e : item) : bool := is (grid (p1 (shape e))) a && is (grid (p2 (shape e))) b.
Definition goes_in (a b : vec Q) (h : list item) : nat := length (filter (goes a b) h).
Lemma is_value t : at_most_triangle f t -> let u := map_triangle (scaled f) t in forall a,
  is (p1 (exact t)) a = is (grid (p1 u)) a /\ is (p2 (exact t)) a = is (grid (p2 u)) a /\
  is (p3 (exact t)) a = is (grid (p3 u)) a.
Proof.
  intros T u a. destruct (sized_value f t T) as (S1 & S2 & S3).
  repeat split; apply eq_true_iff_eq; rewrite !is_same; split; intros H; eapply same_trans; eauto using same_sym.
Qed.
Lemma passes_goes a b : passes (mesh s o) a b = goes_in a b es.
Proof.
  assert (E : Permutation es (flat_map edges_of m)).
  { unfold es, edge_items.
    assert (F : forall n done, Permutation (fold_left (fun done a => edges_of a ++ done) n done)
                                           (flat_map edges_of n ++ done)).
    { induction n as [|c n IH]; intros done; cbn [fold_left flat_map]; [reflexivity|].
      rewrite IH, <- app_assoc, !app_assoc. apply Permutation_app_tail, Permutation_app_comm. }
    rewrite <- (app_nil_r (flat_map edges_of m)). apply F. }
  unfold goes_in. rewrite (count_permutation _ _ _ E). rewrite mesh_at. unfold passes.
  rewrite (count_permutation _ (flat_map _ (map exact (triangles_at s o)))
             (flat_map (fun t => [(p1 t, p2 t); (p2 t, p3 t); (p3 t, p1 t)]) (map exact (rev (triangles_at s o)))))
    by (apply Permutation_flat_map, Permutation_map, Permutation_rev).
  pose proof members_are as M.
  assert (T : forall t, In t (rev (triangles_at s o)) -> at_most_triangle f t)
    by (intros t I; apply at_most_members; now apply in_rev).
  clear E. revert M T. generalize (rev (triangles_at s o)). generalize m.
  intros n ts. revert n. induction ts as [|t ts IH]; intros [|c n] M T; try discriminate; [reflexivity|].
  cbn [map] in M. injection M as M0 M. cbn [map flat_map]. rewrite !filter_app, !app_length, (IH n); auto.
  2: { intros u U. apply T. now right. }
  f_equal. assert (T0 : at_most_triangle f t) by (apply T; now left).
  unfold edges_of, goes. rewrite M0. unfold edge_item. cbn [filter fst snd shape p1 p2].
  destruct (is_value t T0 a) as (-> & -> & ->), (is_value t T0 b) as (-> & -> & ->).
  destruct (is _ _ && is _ _), (is _ _ && is _ _), (is _ _ && is _ _); reflexivity.
Qed.
Lemma grid_injective p q : same (grid p) (grid q) <-> p = q.
Proof.
  split; [|intros ->; apply same_refl]. intros H. apply same_qvec. pose proof (power_positive f) as K.
  eapply same_trans; [apply same_sym, (times_inverse k); assumption|].
  eapply same_trans; [|apply (times_inverse k); assumption].
  unfold grid in H. destruct H as (X & Y & Z). unfold same, times in *. cbn [x y z] in *.
  now rewrite X, Y, Z.
Qed.
Lemma is_grid p a : is (grid p) a = true -> forall q, is (grid q) a = equal q p.
Proof.
  intros H q. apply is_same in H. apply eq_true_iff_eq. rewrite is_same, equal_eq, <- grid_injective. split; intros E.
  - eapply same_trans; [exact E | now apply same_sym].
  - eapply same_trans; eassumption.
Qed.
Lemma goes_passed a b e h : goes a b e = true ->
  goes_in a b h = times_passed (p1 (shape e)) (p2 (shape e)) h /\
  goes_in b a h = times_passed (p2 (shape e)) (p1 (shape e)) h.
Proof.
  intros G. apply andb_prop in G. destruct G as [G1 G2]. unfold goes_in, times_passed.
  split; f_equal; apply filter_ext; intros c; unfold goes;
    now rewrite (is_grid _ _ G1), (is_grid _ _ G2).
Qed.
Lemma goes_none a b h : existsb (goes a b) h = false -> goes_in a b h = 0%nat.
Proof.
  unfold goes_in. induction h as [|e h IH]; cbn [existsb filter]; [reflexivity|].
  intros H. apply orb_false_iff in H. destruct H as [-> H]. auto.
Qed.
Lemma goes_app a b h h' : goes_in a b (h ++ h') = (goes_in a b h + goes_in a b h')%nat.
Proof. unfold goes_in. now rewrite filter_app, app_length. Qed.
Lemma leaf_goes (P : nat -> nat -> Prop) good a b h : P 0%nat 0%nat -> (forall i j, P i j -> P j i) ->
  (forall e, In e h -> good h e = true -> goes a b e = true \/ goes b a e = true -> 
             P (times_passed (p1 (shape e)) (p2 (shape e)) h) (times_passed (p2 (shape e)) (p1 (shape e)) h)) ->
  (forall e, In e h -> good h e = true) -> P (goes_in a b h) (goes_in b a h).
Proof.
  intros Z S Y G. destruct (existsb (goes a b) h) eqn:X.
  - apply existsb_exists in X. destruct X as (e & E & X). destruct (goes_passed _ _ _ h X) as [-> ->]. auto.
  - destruct (existsb (goes b a) h) eqn:X'.
    + apply existsb_exists in X'. destruct X' as (e & E & X'). destruct (goes_passed _ _ _ h X') as [-> ->].
      apply S. auto.
    + now rewrite !goes_none.
Qed.
Lemma tree_goes (P : nat -> nat -> Prop) good a b t : P 0%nat 0%nat -> (forall i j, P i j -> P j i) ->
  (forall i j i' j', P i j -> P i' j' -> P (i + i')%nat (j + j')%nat) ->
  (forall h e, In e h -> good h e = true -> goes a b e = true \/ goes b a e = true ->
             P (times_passed (p1 (shape e)) (p2 (shape e)) h) (times_passed (p2 (shape e)) (p1 (shape e)) h)) ->
  bad_edge good t = None -> P (goes_in a b (leaves t)) (goes_in b a (leaves t)).
Proof.
  intros Z S D Y. induction t as [r h | r one IH1 other IH2]; cbn [bad_edge leaves].
  - intros N. apply (leaf_goes P good); auto. intros e E.
    pose proof (find_none _ _ N e E) as G. now apply negb_false_iff in G.
  - destruct (bad_edge good one); [discriminate|]. intros N. rewrite !goes_app. auto.
Qed.
Lemma es_leaves a b : goes_in a b es = goes_in a b (leaves (build 64 es)).
Proof. apply count_permutation. symmetry. apply build_permutation. Qed.
Lemma bad_of_all good t b : all_good good t es = Some b ->
  b = true /\ bad_edge good t = None \/ b = false /\ exists e, good es e = false.
Proof.
  unfold all_good. destruct (bad_edge good t) as [e|]; [|intros E; injection E as <-; auto].
  destruct (good es e) eqn:G; [discriminate|]. intros E. injection E as <-. eauto.
Qed.
Lemma goes_self p q : goes (grid p) (grid q) (edge_item p q) = true.
Proof. unfold goes, edge_item. cbn [shape p1 p2]. apply andb_true_intro. rewrite !is_same. auto using same_refl. Qed.
Lemma closed_sound b : is_closed (surface_of (Z.of_nat o) items) = Some b -> if b then closed (mesh s o) else ~ closed (mesh s o).
Proof.
  intros H. change (all_good is_even (build 64 es) es = Some b) in H. apply bad_of_all in H.
  destruct H as [[-> H] | [-> (e & H)]].
  - intros a b N. rewrite !passes_goes, !es_leaves.
    apply (tree_goes (fun i j => Nat.Even (i + j)) is_even a b); [exists 0%nat; reflexivity | | | | exact H].
    + intros i j. now rewrite Nat.add_comm.
    + intros i j i' j' [u U] [v V]. exists (u + v)%nat. lia.
    + intros h c _ G Y. unfold is_even in G. apply orb_prop in G.
      destruct G as [G | G]; [|now apply Nat.even_spec]. exfalso. apply equal_eq in G.
      apply not_true_iff_false in N. apply N. apply is_same. unfold goes in Y. rewrite !andb_true_iff, !is_same, G in Y.
      destruct Y as [[U V] | [U V]]; eapply same_trans; eauto using same_sym.
  - intros C. unfold is_even in H. apply orb_false_iff in H. destruct H as [N H].
    set (p := p1 (shape e)) in *. set (q := p2 (shape e)) in *.
    assert (X : Nat.Even (passes (mesh s o) (grid p) (grid q) + passes (mesh s o) (grid q) (grid p))).
    { apply C. apply not_true_iff_false. intros I. apply is_same, grid_injective in I.
      apply equal_eq in I. congruence. }
    rewrite !passes_goes in X. destruct (goes_passed _ _ _ es (goes_self p q)) as [E1 E2].
    rewrite E1, E2 in X. cbn [edge_item shape p1 p2] in X. apply Nat.even_spec in X. congruence.
Qed.
Lemma oriented_sound b : is_oriented (surface_of (Z.of_nat o) items) = Some b -> if b then oriented (mesh s o) else ~ oriented (mesh s o).
Proof.
  intros H. change (all_good is_balanced (build 64 es) es = Some b) in H. apply bad_of_all in H.
  destruct H as [[-> H] | [-> (e & H)]].
  - intros a b. rewrite !passes_goes, !es_leaves.
    apply (tree_goes (fun i j => i = j) is_balanced a b); [reflexivity | auto | auto | | exact H].
    intros h c _ G _. unfold is_balanced in G. now apply Nat.eqb_eq.
  - intros C. unfold is_balanced in H. apply Nat.eqb_neq in H.
    set (p := p1 (shape e)) in *. set (q := p2 (shape e)) in *. apply H.
    pose proof (C (grid p) (grid q)) as X. rewrite !passes_goes in X.
    destruct (goes_passed _ _ _ es (goes_self p q)) as [E1 E2]. rewrite E1, E2 in X. exact X.
Qed.

Lemma rays_directed d : In d rays -> d <> origin.
Proof. intros I E. subst. cbn in I. unfold origin in I. repeat (destruct I as [I | I]; [discriminate|]). assumption. Qed.
Lemma axes_directed d : In d (opposed axes) -> d <> origin.
Proof. intros I E. subst. cbn in I. unfold origin in I. repeat (destruct I as [I | I]; [discriminate|]). assumption. Qed.
Lemma tells_of_sound p P b : tells_of (surface_of (Z.of_nat o) items) p b = true -> same P (grid p) ->
  exists ks, ray (mesh s o) P ks /\ if b then tells (mesh s o) ks else ~ tells (mesh s o) ks.
Proof.
  unfold tells_of. intros H E. apply existsb_exists in H. destruct H as (d & D & H).
  destruct (wind p d (held _)) as [j|] eqn:W; [|discriminate].
  destruct (tell _ j) as [c|] eqn:T; [|discriminate]. apply eqb_prop in H. subst c.
  destruct (wind_ray _ _ _ _ (rays_directed _ D) E W) as (ks & R & K). exists ks. split; [assumption|].
  unfold tell in T. unfold tells. cbv zeta. rewrite K. destruct (Z.odd j) eqn:O.
  - injection T as <-. left. now apply Z.odd_spec.
  - assert (NO : ~ Z.Odd j) by (intros Y; apply Z.odd_spec in Y; congruence).
    destruct (Z.eqb_spec j 0) as [-> | J]; [injection T as <-; tauto|].
    pose proof (oriented_sound b T) as S. destruct b; tauto.
Qed.
End Object.

Lemma member_of o i : In i (members (surface_of (Z.of_nat o) items)) ->
  exists t, In (exact t) (mesh s o) /\ shape i = map_triangle (scaled f) t /\ at_most_triangle f t.
Proof.
  intros I. apply (in_map shape) in I. rewrite members_are in I. apply in_map_iff in I.
  destruct I as (t & E & I). exists t. apply in_rev in I. split; [rewrite mesh_at; now apply in_map|].
  split; [now symmetry | eapply at_most_members; eassumption].
Qed.
Lemma corner_of o i (g : vec Z -> bool) : In i (members (surface_of (Z.of_nat o) items)) ->
  some_corner_of g i = true ->
  exists t p q, In t (mesh s o) /\ is_corner t p /\ same p (grid q) /\ g q = true.
Proof.
  intros I G. destruct (member_of o i I) as (t & T & S & M). destruct (sized_value f t M) as (S1 & S2 & S3).
  unfold some_corner_of in G. rewrite S in G. rewrite !orb_true_iff in G. fold k in S1, S2, S3.
  destruct G as [[G | G] | G]; exists (exact t).
  - exists (p1 (exact t)), (p1 (map_triangle (scaled f) t)). split; [assumption|]. split; [left; apply same_refl|]. auto.
  - exists (p2 (exact t)), (p2 (map_triangle (scaled f) t)). split; [assumption|]. split; [right; left; apply same_refl|]. auto.
  - exists (p3 (exact t)), (p3 (map_triangle (scaled f) t)). split; [assumption|]. split; [right; right; apply same_refl|]. auto.
Qed.
Lemma corners_of o (g : vec Z -> bool) :
  forallb (fun i => negb (some_corner_of (fun p => negb (g p)) i)) (members (surface_of (Z.of_nat o) items)) = true ->
  forall t p, In t (mesh s o) -> is_corner t p -> exists q, same p (grid q) /\ g q = true.
Proof.
  intros G t p T C. rewrite mesh_at in T. apply in_map_iff in T. destruct T as (u & <- & T).
  pose proof (at_most_members o u T) as M. destruct (sized_value f u M) as (S1 & S2 & S3).
  assert (I : In (map_triangle (scaled f) u) (map shape (members (surface_of (Z.of_nat o) items)))).
  { rewrite members_are. apply in_map. now apply -> in_rev. }
  apply in_map_iff in I. destruct I as (i & E & I). rewrite forallb_forall in G. specialize (G i I).
  apply negb_true_iff in G. unfold some_corner_of in G. rewrite !orb_false_iff, !negb_false_iff, E in G.
  destruct G as [[G1 G2] G3]. destruct C as [C | [C | C]].
  - exists (p1 (map_triangle (scaled f) u)). split; [eapply same_trans; eauto | assumption].
  - exists (p2 (map_triangle (scaled f) u)). split; [eapply same_trans; eauto | assumption].
  - exists (p3 (map_triangle (scaled f) u)). split; [eapply same_trans; eauto | assumption].
Qed.

Lemma all_inside_sound o o' :
  all_inside (surface_of (Z.of_nat o) items) (surface_of (Z.of_nat o') items) = true -> is_in s o o'.
Proof.
  unfold all_inside. intros H. apply andb_prop in H. destruct H as [C H].
  destruct (is_closed _) as [[|]|] eqn:CL; try discriminate. apply closed_sound in CL.
  split; [assumption|]. intros t p T I. destruct (corners_of o _ H t p T I) as (q & E & G).
  exact (tells_of_sound o' q p true G E).
Qed.
Lemma not_inside_sound o o' b :
  not_inside (surface_of (Z.of_nat o) items) (surface_of (Z.of_nat o') items) = Some b ->
  if b then not_in s o o' else ~ closed (mesh s o').
Proof.
  unfold not_inside. destruct (has_free_ray _ _) eqn:F.
  - intros E. injection E as <-. unfold has_free_ray in F. apply existsb_exists in F. destruct F as (i & I & F).
    destruct (corner_of o i _ I F) as (t & p & q & T & C & S & G). apply existsb_exists in G.
    destruct G as (d & D & G). destruct (tree_sound o') as (ST & _ & B).
    destruct (all_beside q d _ ST B G) as (ks & K & Z).
    destruct (ray_of_mesh o' q d ks p (axes_directed _ D) S K) as (ks' & R & Q).
    exists t, p, ks'. split; [assumption|]. split; [assumption|]. split; [assumption|]. left.
    eapply Permutation_Forall; eassumption.
  - destruct (is_closed _) as [[|]|] eqn:CL; [| |discriminate]; apply closed_sound in CL.
    + destruct (existsb _ _) eqn:X; [|discriminate]. intros E. injection E as <-.
      apply existsb_exists in X. destruct X as (i & I & X).
      destruct (corner_of o i _ I X) as (t & p & q & T & C & S & G).
      destruct (tells_of_sound o' q p false G S) as (ks & R & N). exists t, p, ks. auto 6.
    + intros E. now injection E as <-.
Qed.
Lemma is_said_rightly_sound w o o' :
  is_said_rightly items w (Z.of_nat o) (Z.of_nat o') = true -> right_word s w o o'.
Proof.
  unfold is_said_rightly, right_word. destruct w; cbv zeta; auto using all_inside_sound.
  - destruct (not_inside _ _) as [[|]|] eqn:X; try discriminate.
    destruct (not_inside (surface_of (Z.of_nat o') items) _) as [[|]|] eqn:Y; try discriminate.
    apply not_inside_sound in X, Y. auto.
  - destruct (not_inside _ _) as [i|] eqn:X; [|discriminate].
    destruct (not_inside (surface_of (Z.of_nat o') items) _) as [j|] eqn:Y; [|discriminate].
    apply not_inside_sound in X, Y. destruct i, j; try discriminate; tauto.
Qed.
End Scene.
