(** The scale that turns doubles into integers does not change the answer. *)
From Coq Require Import ZArith NArith QArith Qpower Lqa Lia List Bool Setoid Morphisms.
Require Import Spec Checker Geometry Points Pairs.
Import ListNotations.
Open Scope Q_scope.

(** * One power of two *)
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
Lemma count_value e d t t' one : (e <= exponent d)%Z -> at_most_triangle e t -> at_most_triangle e t' ->
  count (value d) one (map_triangle value t) (map_triangle value t') <->
  count #(scaled e d) one (qtri (map_triangle (scaled e) t)) (qtri (map_triangle (scaled e) t')).
Proof.
  intros L T T'. apply (count_sized (2 ^ e)); auto using power_positive, value_scaled, sized_value.
Qed.

(** * Places on an axis *)
Lemma scaled_less e d d' : (e <= exponent d)%Z -> (e <= exponent d')%Z ->
  ((scaled e d < scaled e d')%Z <-> value d < value d').
Proof.
  intros L L'. rewrite (value_scaled e d L), (value_scaled e d' L'), inject_lt.
  symmetry. apply Qmult_lt_l, power_positive.
Qed.
Lemma scaled_at_most e d d' : (e <= exponent d)%Z -> (e <= exponent d')%Z ->
  ((scaled e d <= scaled e d')%Z <-> value d <= value d').
Proof. intros L L'. rewrite <- Z.nlt_ge, scaled_less by assumption.
  split; [apply Qnot_lt_le | apply Qle_not_lt]. Qed.
Lemma scaled_positive e e' d : (e <= exponent d)%Z -> (e' <= exponent d)%Z ->
  (0 <= scaled e d)%Z -> (0 <= scaled e' d)%Z.
Proof.
  intros L L' P. apply -> inject_le in P. apply <- inject_le. change #0 with 0 in *.
  assert (V : 0 <= value d).
  { rewrite (value_scaled e d L). apply Qmult_le_0_compat; [apply Qlt_le_weak, power_positive | exact P]. }
  rewrite (value_scaled e' d L') in V.
  rewrite <- (Qmult_0_r (2 ^ e')) in V. now apply Qmult_le_l in V; [|apply power_positive].
Qed.
Lemma is_below_sound d p : is_below d p = true <-> value d < value p.
Proof. unfold is_below. rewrite Z.ltb_lt. apply scaled_less; lia. Qed.
Lemma is_reached_complete e r p d : (e <= exponent r)%Z -> (e <= exponent p)%Z -> (e <= exponent d)%Z ->
  (scaled e p <= scaled e d + scaled e r)%Z -> is_reached r p d = true.
Proof.
  intros LR LP LD H. unfold is_reached, lower. set (e' := Z.min (Z.min _ _) _).
  apply Z.leb_le. apply -> inject_le in H. apply <- inject_le. inject.
  apply (Qmult_le_l _ _ (2 ^ e') (power_positive e')). 
  apply (Qmult_le_l _ _ (2 ^ e) (power_positive e)) in H.
  rewrite Qmult_plus_distr_r in *. rewrite <- !value_scaled in * by lia. assumption.
Qed.
Lemma coordinate_map {C D} (f : C -> D) k p : coordinate k (map_vec f p) = f (coordinate k p).
Proof. destruct k; reflexivity. Qed.
Lemma coordinate_exponent e k p : at_most_vec e p -> (e <= exponent (coordinate k p))%Z.
Proof. intros (A & B & C). destruct k; assumption. Qed.
Lemma coordinate_least k t : coordinate k (least t) =
  min3 (coordinate k (p1 t)) (coordinate k (p2 t)) (coordinate k (p3 t)).
Proof. destruct k; reflexivity. Qed.
Lemma coordinate_greatest k t : coordinate k (greatest t) =
  max3 (coordinate k (p1 t)) (coordinate k (p2 t)) (coordinate k (p3 t)).
Proof. destruct k; reflexivity. Qed.
Lemma before_corner k p t : before k p t <->
  value (coordinate k (p1 t)) < value p \/ value (coordinate k (p2 t)) < value p \/
  value (coordinate k (p3 t)) < value p.
Proof.
  unfold before. split.
  - intros (q & [-> | [-> | ->]] & L); auto.
  - intros [L | [L | L]]; eauto 6.
Qed.
Lemma before_box e k p t : (e <= exponent p)%Z -> at_most_triangle e t ->
  ((coordinate k (least (map_triangle (scaled e) t)) < scaled e p)%Z <-> before k p t).
Proof.
  intros L (A & B & C). rewrite before_corner, coordinate_least. unfold map_triangle. cbn [p1 p2 p3].
  rewrite !coordinate_map. apply (coordinate_exponent _ k) in A, B, C.
  rewrite <- !(scaled_less e) by assumption. unfold min3. lia.
Qed.
Lemma before_needed k p t : some_corner (fun d => is_below d p) k t = true <-> before k p t.
Proof. unfold some_corner. rewrite !orb_true_iff, !is_below_sound, before_corner. tauto. Qed.
Lemma reached_needed e k p r t : (e <= exponent p)%Z -> (e <= exponent r)%Z -> at_most_triangle e t ->
  (scaled e p <= coordinate k (greatest (map_triangle (scaled e) t)) + scaled e r)%Z ->
  some_corner (is_reached r p) k t = true.
Proof.
  intros LP LR (A & B & C). rewrite coordinate_greatest. unfold map_triangle. cbn [p1 p2 p3].
  rewrite !coordinate_map. apply (coordinate_exponent _ k) in A, B, C. intros H.
  unfold some_corner. rewrite !orb_true_iff. unfold max3 in H.
  assert (O : (scaled e p <= scaled e (coordinate k (p1 t)) + scaled e r \/
               scaled e p <= scaled e (coordinate k (p2 t)) + scaled e r \/
               scaled e p <= scaled e (coordinate k (p3 t)) + scaled e r)%Z) by lia.
  destruct O as [O | [O | O]]; apply is_reached_complete in O; auto.
Qed.
Lemma least_at_most_greatest k t : (coordinate k (least t) <= coordinate k (greatest t))%Z.
Proof. rewrite coordinate_least, coordinate_greatest. unfold min3, max3. lia. Qed.
Lemma overlap_axis k r a b :
  overlap (sub (least a) (Vec r r r)) (add (greatest a) (Vec r r r)) (least b) (greatest b) = true ->
  (coordinate k (least a) <= coordinate k (greatest b) + r /\
   coordinate k (least b) <= coordinate k (greatest a) + r)%Z.
Proof.
  rewrite overlap_true. unfold sub, add. cbn [x y z]. intros H. destruct k; cbn [coordinate]; lia.
Qed.
