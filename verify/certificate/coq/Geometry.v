(** Lemmas on what the tests of Checker.v imply about the points of two triangles. *)
From Coq Require Import ZArith NArith QArith Lqa Lia List Bool Permutation Setoid Morphisms.
Require Import Spec Checker.
Import ListNotations.
Open Scope Q_scope.

(** * From integers to rationals *)
Notation "# z" := (inject_Z z) (at level 1, format "# z").
Definition qvec (p : vec Z) : vec Q := map_vec inject_Z p.
Definition qtri (t : triangle Z) : triangle Q := map_triangle inject_Z t.

Lemma inject_sub a b : #(a - b) = #a - #b.
Proof. unfold Z.sub. now rewrite inject_Z_plus, inject_Z_opp. Qed.
Lemma inject_lt a b : (a < b)%Z <-> #a < #b.
Proof. now rewrite <- Zlt_Qlt. Qed.
Lemma inject_le a b : (a <= b)%Z <-> #a <= #b.
Proof. now rewrite <- Zle_Qle. Qed.
Lemma inject_eq a b : a = b <-> #a == #b.
Proof. symmetry. apply inject_Z_injective. Qed.
Ltac inject := repeat rewrite ?inject_sub, ?inject_Z_plus, ?inject_Z_mult, ?inject_Z_opp in *.

(** Turns the result of a test of the checker into facts about integers. *)
Ltac tests :=
  repeat match goal with
  | H : (_ && _)%bool = true |- _ => apply andb_prop in H; destruct H
  | H : negb _ = true |- _ => apply negb_true_iff in H
  | H : (_ =? _)%Z = true |- _ => apply Z.eqb_eq in H
  | H : (_ <=? _)%Z = true |- _ => apply Z.leb_le in H
  | H : (_ <? _)%Z = true |- _ => apply Z.ltb_lt in H
  | H : (_ =? _)%Z = false |- _ => apply Z.eqb_neq in H
  | H : (_ <=? _)%Z = false |- _ => apply Z.leb_gt in H
  | H : (_ <? _)%Z = false |- _ => apply Z.ltb_ge in H
  end.

Lemma equal_eq p q : equal p q = true <-> p = q.
Proof.
  unfold equal. destruct p, q; simpl. rewrite !andb_true_iff, !Z.eqb_eq. split.
  - intros [[-> ->] ->]. reflexivity.
  - intros H. now inversion H.
Qed.

Lemma same_refl p : same p p.
Proof. unfold same. repeat split; reflexivity. Qed.
Lemma same_sym p q : same p q -> same q p.
Proof. unfold same. intuition. Qed.
Lemma same_trans p q r : same p q -> same q r -> same p r.
Proof.
  unfold same. intros (A & B & C) (A' & B' & C').
  repeat split; etransitivity; eassumption.
Qed.
Lemma same_qvec p q : same (qvec p) (qvec q) <-> p = q.
Proof.
  unfold same, qvec, map_vec. destruct p, q; simpl. split.
  - intros (A & B & C). apply <- inject_eq in A; apply <- inject_eq in B; apply <- inject_eq in C. now subst.
  - intros H. inversion H. repeat split; reflexivity.
Qed.
#[export] Instance inside_same t : Proper (same ==> iff) (inside t).
Proof.
  intros p q E. split; intros (u & v & w & U & V & W & S & P); exists u, v, w;
    repeat split; try assumption; eapply same_trans; try apply P; auto using same_sym.
Qed.

(** The scalar product of d and a point p: a linear function of p. *)
Definition qdot (d : vec Z) (p : vec Q) : Q := #(x d) * x p + #(y d) * y p + #(z d) * z p.
Lemma qdot_qvec d p : qdot d (qvec p) == #(dot d p).
Proof. unfold qdot, dot. inject. reflexivity. Qed.
Lemma qdot_same d p q : same p q -> qdot d p == qdot d q.
Proof. intros (A & B & C). unfold qdot. now rewrite A, B, C. Qed.
Lemma qdot_mix d u v w t :
  qdot d (mix u v w (qtri t)) ==
  u * #(dot d (p1 t)) + v * #(dot d (p2 t)) + w * #(dot d (p3 t)).
Proof. rewrite <- !qdot_qvec. unfold qdot, mix, plus, times, qtri, map_triangle, qvec. simpl. ring. Qed.

(** At a point of a triangle, a linear function is a mean of its values at the corners. *)
Lemma inside_dot d t p :
  inside (qtri t) p -> exists u v w, 0 <= u /\ 0 <= v /\ 0 <= w /\ u + v + w == 1 /\
    qdot d p == u * #(dot d (p1 t)) + v * #(dot d (p2 t)) + w * #(dot d (p3 t)).
Proof.
  intros (u & v & w & U & V & W & S & P). exists u, v, w. repeat split; try assumption.
  rewrite (qdot_same _ _ _ P). apply qdot_mix.
Qed.
Lemma mean_le u v w a b c m :
  0 <= u -> 0 <= v -> 0 <= w -> u + v + w == 1 -> a <= m -> b <= m -> c <= m ->
  u * a + v * b + w * c <= m.
Proof.
  intros. setoid_replace m with ((u + v + w) * m) by (rewrite H2; ring).
  assert (0 <= u * (m - a)) by (apply Qmult_le_0_compat; lra).
  assert (0 <= v * (m - b)) by (apply Qmult_le_0_compat; lra).
  assert (0 <= w * (m - c)) by (apply Qmult_le_0_compat; lra).
  lra.
Qed.
Lemma le_mean u v w a b c m :
  0 <= u -> 0 <= v -> 0 <= w -> u + v + w == 1 -> m <= a -> m <= b -> m <= c ->
  m <= u * a + v * b + w * c.
Proof.
  intros. assert (u * (- a) + v * (- b) + w * (- c) <= - m) by (apply mean_le; auto; lra).
  lra.
Qed.
Lemma dot_at_most d t p m :
  inside (qtri t) p -> (dot d (p1 t) <= m)%Z -> (dot d (p2 t) <= m)%Z -> (dot d (p3 t) <= m)%Z ->
  qdot d p <= #m.
Proof.
  intros I A B C. destruct (inside_dot d _ _ I) as (u & v & w & U & V & W & S & ->).
  apply mean_le; auto; now apply -> inject_le.
Qed.
Lemma dot_at_least d t p m :
  inside (qtri t) p -> (m <= dot d (p1 t))%Z -> (m <= dot d (p2 t))%Z -> (m <= dot d (p3 t))%Z ->
  #m <= qdot d p.
Proof.
  intros I A B C. destruct (inside_dot d _ _ I) as (u & v & w & U & V & W & S & ->).
  apply le_mean; auto; now apply -> inject_le.
Qed.

(** * Distances *)
Lemma square (a : Q) : 0 <= a * a.
Proof. destruct (Qlt_le_dec a 0); nra. Qed.
Lemma near_sym D a b : near D a b -> near D b a.
Proof.
  intros (p & q & A & B & L). exists q, p. split; [assumption|]. split; [assumption|].
  unfold squared_distance in *. lra.
Qed.
Lemma near_of_common D a b p : inside a p -> inside b p -> near D a b.
Proof.
  intros A B. exists p, p. split; [assumption|]. split; [assumption|].
  pose proof (square D). unfold squared_distance. lra.
Qed.
(** Cauchy-Schwarz: projections onto d differ by at most |d| times the distance of the points. *)
Lemma cauchy d p q :
  (qdot d q - qdot d p) * (qdot d q - qdot d p) <= #(dot d d) * squared_distance p q.
Proof.
  unfold qdot, dot, squared_distance. inject.
  generalize #(x d) #(y d) #(z d). intros a b c.
  set (u := x p - x q). set (v := y p - y q). set (w := z p - z q).
  assert (E : a * x q + b * y q + c * z q - (a * x p + b * y p + c * z p) == - (a * u + b * v + c * w))
    by (unfold u, v, w; ring).
  rewrite E. clearbody u v w.
  pose proof (square (a * v - b * u)). pose proof (square (a * w - c * u)).
  pose proof (square (b * w - c * v)).
  assert (F : (a * a + b * b + c * c) * (u * u + v * v + w * w) -
              - (a * u + b * v + c * w) * - (a * u + b * v + c * w) ==
              (a * v - b * u) * (a * v - b * u) + (a * w - c * u) * (a * w - c * u) +
              (b * w - c * v) * (b * w - c * v)) by ring.
  lra.
Qed.

(** * A direction that separates *)
Lemma gap_below d a b g p q :
  g = (min3 (dot d (p1 b)) (dot d (p2 b)) (dot d (p3 b)) -
       max3 (dot d (p1 a)) (dot d (p2 a)) (dot d (p3 a)))%Z ->
  (0 < g)%Z -> inside (qtri a) p -> inside (qtri b) q ->
  #g * #g <= #(dot d d) * squared_distance p q.
Proof.
  unfold max3, min3. intros G P A B.
  set (l := Z.min _ _) in *. set (h := Z.max _ _) in *.
  assert (qdot d p <= #h) by (apply (dot_at_most d a); auto; unfold h; lia).
  assert (#l <= qdot d q) by (apply (dot_at_least d b); auto; unfold l; lia).
  assert (E : #g == #l - #h) by (rewrite G; inject; reflexivity).
  apply -> inject_lt in P. change #0 with 0 in P.
  pose proof (cauchy d p q) as C. set (t := qdot d q - qdot d p) in *.
  assert (T : #g <= t) by (unfold t; lra). clearbody t.
  assert (S : #g * #g <= t * t) by nra. lra.
Qed.
Lemma dot_positive d : 0 <= #(dot d d).
Proof. change 0 with #0. apply -> inject_le. unfold dot. nia. Qed.
Lemma far_below D d a b g :
  g = (min3 (dot d (p1 b)) (dot d (p2 b)) (dot d (p3 b)) -
       max3 (dot d (p1 a)) (dot d (p2 a)) (dot d (p3 a)))%Z ->
  (0 < g)%Z -> (D * D * dot d d < g * g)%Z -> ~ near #D (qtri a) (qtri b).
Proof.
  intros G P L (p & q & A & B & N). pose proof (gap_below _ _ _ _ _ _ G P A B).
  apply -> inject_lt in L. inject. pose proof (dot_positive d).
  assert (U : 0 <= #(dot d d) * (#D * #D - squared_distance p q)) by (apply Qmult_le_0_compat; lra).
  lra.
Qed.
Lemma separates_sound D a b d :
  separates D a b d = true -> ~ near #D (qtri a) (qtri b).
Proof.
  unfold separates, gap_along. intros H. tests.
  set (g1 := (min3 (dot d (p1 b)) _ _ - _)%Z) in *. set (g2 := (min3 (dot d (p1 a)) _ _ - _)%Z) in *.
  destruct (Z.max_spec g1 g2) as [[_ E] | [_ E]]; rewrite E in *.
  - intros N. apply near_sym in N. revert N. now apply (far_below D d b a g2).
  - now apply (far_below D d a b g1).
Qed.
Lemma separated_sound D a b : separated D a b = true -> ~ near #D (qtri a) (qtri b).
Proof. unfold separated. rewrite existsb_exists. intros (d & _ & H). eapply separates_sound, H. Qed.

(** * Boxes *)
Definition unit_x := Vec 1%Z 0%Z 0%Z.
Definition unit_y := Vec 0%Z 1%Z 0%Z.
Definition unit_z := Vec 0%Z 0%Z 1%Z.
Lemma dot_unit_x p : dot unit_x p = x p. Proof. unfold dot, unit_x. cbn [x y z]. ring. Qed.
Lemma dot_unit_y p : dot unit_y p = y p. Proof. unfold dot, unit_y. cbn [x y z]. ring. Qed.
Lemma dot_unit_z p : dot unit_z p = z p. Proof. unfold dot, unit_z. cbn [x y z]. ring. Qed.
Lemma far_boxes D r a b : (0 <= D)%Z -> (D <= r)%Z ->
  overlap (sub (least a) (Vec r r r)) (add (greatest a) (Vec r r r)) (least b) (greatest b) = false ->
  ~ near #D (qtri a) (qtri b).
Proof.
  intros P R O.
  assert (S : forall u g, (dot u u = 1)%Z -> (r < g)%Z -> (0 < g)%Z /\ (D * D * dot u u < g * g)%Z)
    by (intros u g -> G; nia).
  assert (X : dot unit_x unit_x = 1%Z) by reflexivity.
  assert (Y : dot unit_y unit_y = 1%Z) by reflexivity.
  assert (Z : dot unit_z unit_z = 1%Z) by reflexivity.
  unfold overlap in O. rewrite !andb_false_iff, !Z.leb_gt in O.
  unfold sub, add, least, greatest in O. cbn [x y z] in O.
  destruct O as [[[[[O | O] | O] | O] | O] | O].
  - intros N. apply near_sym in N. revert N. eapply (far_below D unit_x b a); [reflexivity| |];
      apply (S unit_x); auto; rewrite !dot_unit_x; lia.
  - eapply (far_below D unit_x a b); [reflexivity| |]; apply (S unit_x); auto; rewrite !dot_unit_x; lia.
  - intros N. apply near_sym in N. revert N. eapply (far_below D unit_y b a); [reflexivity| |];
      apply (S unit_y); auto; rewrite !dot_unit_y; lia.
  - eapply (far_below D unit_y a b); [reflexivity| |]; apply (S unit_y); auto; rewrite !dot_unit_y; lia.
  - intros N. apply near_sym in N. revert N. eapply (far_below D unit_z b a); [reflexivity| |];
      apply (S unit_z); auto; rewrite !dot_unit_z; lia.
  - eapply (far_below D unit_z a b); [reflexivity| |]; apply (S unit_z); auto; rewrite !dot_unit_z; lia.
Qed.

(** * A common point *)
(** The point p / m. *)
Definition over (p : vec Z) (m : Z) : vec Q := Vec (#(x p) / #m) (#(y p) / #m) (#(z p) / #m).

Lemma weigh_inside w t : are_weights w = true -> inside (qtri t) (over (weigh w t) (total w)).
Proof.
  unfold are_weights. intros H. tests.
  assert (M : 0 < #(total w)) by (change 0 with #0; now apply -> inject_lt).
  assert (N : ~ #(total w) == 0) by lra.
  exists (#(x w) / #(total w)), (#(y w) / #(total w)), (#(z w) / #(total w)).
  repeat split.
  1-3: apply Qle_shift_div_l; [assumption | rewrite Qmult_0_l; change 0 with #0; now apply -> inject_le].
  - unfold total in *. inject. field. assumption.
  - unfold over, mix, plus, times, qtri, map_triangle, map_vec, weigh, add, scale. simpl.
    inject. field. assumption.
  - unfold over, mix, plus, times, qtri, map_triangle, map_vec, weigh, add, scale. simpl.
    inject. field. assumption.
  - unfold over, mix, plus, times, qtri, map_triangle, map_vec, weigh, add, scale. simpl.
    inject. field. assumption.
Qed.
Lemma scaled_over p q m n :
  (0 < m)%Z -> (0 < n)%Z -> scale n p = scale m q -> same (over p m) (over q n).
Proof.
  intros M N E. apply -> inject_lt in M; apply -> inject_lt in N. change #0 with 0 in *.
  unfold scale in E. inversion E as [[X Y Z]].
  apply -> inject_eq in X; apply -> inject_eq in Y; apply -> inject_eq in Z. inject.
  unfold same, over; simpl. repeat split; apply Qmult_inj_r with (z := #m * #n); try nra;
    field_simplify; try lra; rewrite Qmult_comm.
  all: try lra.
Qed.
