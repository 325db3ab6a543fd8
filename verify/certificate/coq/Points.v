(** Common points, and the shared part of neighbours. *)
From Coq Require Import ZArith NArith QArith Lqa Lia List Bool Setoid Morphisms.
Require Import Spec Checker Geometry.
Import ListNotations.
Open Scope Q_scope.

(** * A point that the checker finds is a common point *)
Lemma are_weights_total w : are_weights w = true -> (0 < total w)%Z.
Proof. unfold are_weights. intros H. now tests. Qed.
Lemma is_common_sound a b u v :
  is_common a b u v = true ->
  inside (qtri a) (over (weigh u a) (total u)) /\ inside (qtri b) (over (weigh u a) (total u)).
Proof.
  unfold is_common. intros H. apply andb_prop in H. destruct H as [H E].
  apply andb_prop in H. destruct H as [U V]. apply equal_eq in E.
  split; [now apply weigh_inside|].
  rewrite (scaled_over _ (weigh v b) _ (total v)); auto using are_weights_total.
  now apply weigh_inside.
Qed.
Lemma shows_sound good a b p :
  shows good a b p = true -> exists q m, (0 < m)%Z /\ good q m = true /\
    inside (qtri a) (over q m) /\ inside (qtri b) (over q m).
Proof.
  unfold shows. set (u := probe_weights a b p). intros H. apply andb_prop in H. destruct H as [W H].
  apply existsb_exists in H. destruct H as (v & _ & H). apply andb_prop in H. destruct H as [C G].
  apply is_common_sound in C. exists (weigh u a), (total u).
  repeat split; try apply C; auto using are_weights_total.
Qed.
Lemma has_common_sound good a b :
  has_common good a b = true -> exists q m, (0 < m)%Z /\ good q m = true /\
    inside (qtri a) (over q m) /\ inside (qtri b) (over q m).
Proof.
  unfold has_common. intros H. apply orb_prop in H. rewrite !existsb_exists in H.
  destruct H as [(p & _ & H) | (p & _ & H)]; apply shows_sound in H;
    destruct H as (q & m & M & G & A & B); exists q, m; auto.
Qed.

Definition near_squares (n m : Z) (a b : triangle Z) : Prop :=
  exists p q, inside (qtri a) p /\ inside (qtri b) q /\ #m * squared_distance p q <= #n.
Lemma are_within_sound n m a b u v : are_within n m a b u v = true -> near_squares n m a b.
Proof.
  unfold are_within. intros H. apply andb_prop in H. destruct H as [H N].
  apply andb_prop in H. destruct H as [U V]. apply Z.leb_le in N.
  exists (over (weigh u a) (total u)), (over (weigh v b) (total v)).
  split; [now apply weigh_inside|]. split; [now apply weigh_inside|].
  apply are_weights_total in U, V. apply -> inject_lt in U. apply -> inject_lt in V.
  apply -> inject_le in N. change #0 with 0 in *. unfold squared_distance, over. cbn [x y z].
  unfold dot, sub, scale in N. cbn [x y z] in N. inject.
  set (k := #(total u)) in *. set (l := #(total v)) in *.
  assert (K' : ~ k == 0) by lra. assert (L' : ~ l == 0) by lra.
  assert (KL : 0 < k * l) by nra. assert (S : 0 < (k * l) * (k * l)) by nra.
  apply (Qmult_lt_0_le_reg_r _ _ _ S). clear S KL U V.
  match goal with |- ?g <= _ =>
    match type of N with ?h <= _ => setoid_replace g with h by (field; split; assumption) end end.
  lra.
Qed.
Lemma are_near_sound D a b u v :
  are_within (D * D) 1 a b u v = true -> near #D (qtri a) (qtri b).
Proof.
  intros H. destruct (are_within_sound _ _ _ _ _ _ H) as (p & q & P & Q & N). exists p, q.
  split; [exact P|]. split; [exact Q|]. inject. change #1 with 1 in N. lra.
Qed.
Lemma has_near_sound (P : triangle Z -> triangle Z -> Prop) good a b :
  (forall a b, P a b -> P b a) -> (forall a b u v, good a b u v = true -> P a b) ->
  has_near good a b = true -> P a b.
Proof.
  intros S G.
  assert (C : forall a b, near_corner good a b = true -> P a b).
  { clear a b. unfold near_corner. intros a b H. apply existsb_exists in H. destruct H as (j & _ & H).
    apply existsb_exists in H. destruct H as (u & _ & H). eapply G, H. }
  unfold has_near. rewrite !orb_true_iff. intros [[H | H] | H].
  - auto.
  - auto.
  - unfold near_edges in H. apply existsb_exists in H. destruct H as (i & _ & H).
    apply existsb_exists in H. destruct H as (j & _ & H). eapply G, H.
Qed.

(** * Points of a segment *)
Lemma on_segment_same c d p q : same p q -> on_segment c d p -> on_segment c d q.
Proof.
  intros E (t & A & B & P). exists t. repeat split; auto;
  destruct E as (E1 & E2 & E3), P as (P1 & P2 & P3); simpl in *; lra.
Qed.
Lemma on_segment_ends c d c' d' p :
  same c c' -> same d d' -> on_segment c d p -> on_segment c' d' p.
Proof.
  intros (C1 & C2 & C3) (D1 & D2 & D3) (t & A & B & (P1 & P2 & P3)).
  exists t. repeat split; auto; simpl in *.
  - now rewrite P1, C1, D1.
  - now rewrite P2, C2, D2.
  - now rewrite P3, C3, D3.
Qed.

(** If q / m lies on the segment from c to d, then q - m c = s (d - c) with 0 <= s <= m. *)
Lemma segment_offset c d q m :
  (0 < m)%Z -> on_segment (qvec c) (qvec d) (over q m) ->
  exists s, 0 <= s /\ s <= #m /\
    #(x q - m * x c) == s * #(x d - x c) /\ #(y q - m * y c) == s * #(y d - y c) /\
    #(z q - m * z c) == s * #(z d - z c).
Proof.
  intros M (t & A & B & (P1 & P2 & P3)). apply -> inject_lt in M. change #0 with 0 in M.
  assert (N : ~ #m == 0) by lra.
  exists (#m * t). simpl in *. inject.
  assert (Q1 : #(x q) == #m * ((1 - t) * #(x c) + t * #(x d))) by (rewrite <- P1; field; assumption).
  assert (Q2 : #(y q) == #m * ((1 - t) * #(y c) + t * #(y d))) by (rewrite <- P2; field; assumption).
  assert (Q3 : #(z q) == #m * ((1 - t) * #(z c) + t * #(z d))) by (rewrite <- P3; field; assumption).
  repeat split.
  - apply Qmult_le_0_compat; lra.
  - assert (0 <= #m * (1 - t)) by (apply Qmult_le_0_compat; lra). lra.
  - rewrite Q1. ring.
  - rewrite Q2. ring.
  - rewrite Q3. ring.
Qed.

Lemma square_nonneg e : (0 <= dot e e)%Z.
Proof. unfold dot. nia. Qed.

Lemma off_segment_sound c d q m :
  (0 < m)%Z -> off_segment c d q m = true -> ~ on_segment (qvec c) (qvec d) (over q m).
Proof.
  intros M H S. destruct (segment_offset c d q m M S) as (s & A & B & X & Y & Z). clear S.
  unfold off_segment in H. set (e := sub d c) in *. set (r := sub q (scale m c)) in *.
  change (x q - m * x c)%Z with (x r) in X. change (x d - x c)%Z with (x e) in X.
  change (y q - m * y c)%Z with (y r) in Y. change (y d - y c)%Z with (y e) in Y.
  change (z q - m * z c)%Z with (z r) in Z. change (z d - z c)%Z with (z e) in Z.
  clearbody e r.
  assert (D : #(dot e r) == s * #(dot e e)) by (unfold dot; inject; rewrite X, Y, Z; ring).
  assert (P : 0 <= #(dot e e)) by (change 0 with #0; apply -> inject_le; apply square_nonneg).
  rewrite !orb_true_iff in H. destruct H as [[[H | H] | H] | H]; tests.
  - apply not_true_iff_false in H. apply H. apply equal_eq.
    unfold cross, origin. f_equal; apply <- inject_eq; inject; rewrite ?X, ?Y, ?Z; ring.
  - apply -> inject_lt in H. assert (0 <= s * #(dot e e)) by (apply Qmult_le_0_compat; lra).
    change #0 with 0 in H. lra.
  - apply -> inject_lt in H. inject.
    assert (0 <= (#m - s) * #(dot e e)) by (apply Qmult_le_0_compat; lra). lra.
  - apply equal_eq in H. subst e. unfold origin in *. cbn [x y z] in *.
    apply not_true_iff_false in H0. apply H0. apply equal_eq.
    destruct r as [r1 r2 r3]; cbn [x y z] in *. f_equal; apply <- inject_eq; change #0 with 0 in *; lra.
Qed.

Lemma lies_on_sound c d q : lies_on c d q = true -> on_segment (qvec c) (qvec d) (qvec q).
Proof.
  unfold lies_on. set (e := sub d c). set (r := sub q c).
  assert (X : #(x q) == #(x c) + #(x r)) by (unfold r, sub; cbn [x y z]; inject; ring).
  assert (Y : #(y q) == #(y c) + #(y r)) by (unfold r, sub; cbn [x y z]; inject; ring).
  assert (Z : #(z q) == #(z c) + #(z r)) by (unfold r, sub; cbn [x y z]; inject; ring).
  assert (X' : #(x d) == #(x c) + #(x e)) by (unfold e, sub; cbn [x y z]; inject; ring).
  assert (Y' : #(y d) == #(y c) + #(y e)) by (unfold e, sub; cbn [x y z]; inject; ring).
  assert (Z' : #(z d) == #(z c) + #(z e)) by (unfold e, sub; cbn [x y z]; inject; ring).
  clearbody e r. pose proof (square_nonneg e) as P.
  destruct (dot e e =? 0)%Z eqn:N; intros H.
  - apply equal_eq in H. subst r. unfold origin in *. cbn [x y z] in *. change #0 with 0 in *.
    exists 0. unfold qvec, same, plus, times, map_vec; cbn [x y z]. repeat split; lra.
  - tests. apply equal_eq in H0.
    assert (L : 0 < #(dot e e)) by (change 0 with #0; apply -> inject_lt; lia).
    assert (N' : ~ #(dot e e) == 0) by lra.
    unfold scale in H0. inversion H0 as [[X0 Y0 Z0]].
    apply -> inject_eq in X0. apply -> inject_eq in Y0. apply -> inject_eq in Z0. 
    rewrite !inject_Z_mult in X0, Y0, Z0.
    exists (#(dot e r) / #(dot e e)).
    unfold qvec, same, plus, times, map_vec; cbn [x y z]. repeat split.
    + apply Qle_shift_div_l; [assumption|]. rewrite Qmult_0_l. change 0 with #0. now apply -> inject_le.
    + apply Qle_shift_div_r; [assumption|]. rewrite Qmult_1_l. now apply -> inject_le.
    + rewrite X, X'. setoid_replace (#(x r)) with (#(dot e r) * #(x e) / #(dot e e)); [field; assumption|].
      rewrite <- X0. field. assumption.
    + rewrite Y, Y'. setoid_replace (#(y r)) with (#(dot e r) * #(y e) / #(dot e e)); [field; assumption|].
      rewrite <- Y0. field. assumption.
    + rewrite Z, Z'. setoid_replace (#(z r)) with (#(dot e r) * #(z e) / #(dot e e)); [field; assumption|].
      rewrite <- Z0. field. assumption.
Qed.

(** * The shared part *)
Lemma is_corner_of_sound t c : is_corner_of t c = true <-> c = p1 t \/ c = p2 t \/ c = p3 t.
Proof. unfold is_corner_of. rewrite !orb_true_iff, !equal_eq. tauto. Qed.
Lemma is_corner_qtri t c : is_corner (qtri t) c <->
  exists k, is_corner_of t k = true /\ same c (qvec k).
Proof.
  unfold is_corner, qtri, map_triangle; cbn [p1 p2 p3]. split.
  - intros [H | [H | H]]; [exists (p1 t) | exists (p2 t) | exists (p3 t)];
      rewrite is_corner_of_sound; auto.
  - intros (k & K & E). apply is_corner_of_sound in K. destruct K as [-> | [-> | ->]]; auto.
Qed.
Lemma in_shared_corners a b c :
  In c (shared_corners a b) <-> is_corner_of a c = true /\ is_corner_of b c = true.
Proof.
  unfold shared_corners. rewrite filter_In, (is_corner_of_sound a). simpl.
  split.
  - intros [[E | [E | [E | []]]] H]; subst c; auto.
  - intros [[E | [E | E]] H]; subst c; auto 6.
Qed.
Lemma is_shared_corners a b c :
  is_shared (qtri a) (qtri b) c <-> exists k, In k (shared_corners a b) /\ same c (qvec k).
Proof.
  unfold is_shared. rewrite !is_corner_qtri. split.
  - intros [(k & A & E) (k' & B & E')]. exists k. split; auto. apply in_shared_corners.
    assert (k = k') by (apply same_qvec; eauto using same_trans, same_sym). now subst.
  - intros (k & I & E). apply in_shared_corners in I. destruct I. split; exists k; auto.
Qed.
Lemma in_shared_part_corners a b p :
  in_shared_part (qtri a) (qtri b) p <->
  exists c d, In c (shared_corners a b) /\ In d (shared_corners a b) /\
              on_segment (qvec c) (qvec d) p.
Proof.
  split.
  - intros (c & d & C & D & S). apply is_shared_corners in C, D.
    destruct C as (c' & C & EC), D as (d' & D & ED). exists c', d'.
    repeat split; auto. eapply on_segment_ends; eauto.
  - intros (c & d & C & D & S). exists (qvec c), (qvec d).
    split; [|split]; auto; apply is_shared_corners; eauto using same_refl.
Qed.
Lemma off_shared_sound a b q m :
  (0 < m)%Z -> off_shared (shared_corners a b) q m = true ->
  ~ in_shared_part (qtri a) (qtri b) (over q m).
Proof.
  intros M H P. apply in_shared_part_corners in P. destruct P as (c & d & C & D & S).
  unfold off_shared in H. rewrite forallb_forall in H. specialize (H _ C).
  rewrite forallb_forall in H. specialize (H _ D). now apply (off_segment_sound c d q m).
Qed.
