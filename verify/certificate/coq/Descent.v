(** Neighbours that share only their shared part. Planes reduce the set of corners whose hull can
    contain a common point. *)
From Coq Require Import ZArith NArith QArith Lqa Lia List Bool Setoid Morphisms.
Require Import Spec Checker Geometry Points.
Import ListNotations.
Open Scope Q_scope.

(** p is the mean, with weights w, of the corners of t whose indices are in l. *)
Definition weighted (w : index -> Q) (f : index -> Q) : Q := w I1 * f I1 + w I2 * f I2 + w I3 * f I3.
Definition mean_of (t : triangle Z) (l : list index) (w : index -> Q) (p : vec Q) : Prop :=
  (forall i, 0 <= w i) /\ (forall i, ~ In i l -> w i == 0) /\ weighted w (fun _ => 1) == 1 /\
  forall d, qdot d p == weighted w (fun i => #(dot d (corner t i))).

Lemma mean_of_inside t p : inside (qtri t) p -> exists w, mean_of t indices w p.
Proof.
  intros (u & v & w & U & V & W & S & P).
  exists (fun i => match i with I1 => u | I2 => v | I3 => w end). repeat split.
  - intros []; assumption.
  - intros i N. destruct N. destruct i; simpl; auto.
  - unfold weighted. lra.
  - intros d. rewrite (qdot_same _ _ _ P), qdot_mix. reflexivity.
Qed.

(** If all values with a weight above 0 are at most m, and their mean is m, then they are all m. *)
Lemma mean_tight w f m i :
  (forall i, 0 <= w i) -> weighted w (fun _ => 1) == 1 -> (forall i, w i == 0 \/ f i <= m) ->
  m <= weighted w f -> w i == 0 \/ f i == m.
Proof.
  intros W S L T. unfold weighted in *.
  assert (G : forall j, 0 <= w j * (m - f j)).
  { intros j. destruct (L j) as [E | E]; [rewrite E; lra | apply Qmult_le_0_compat; auto; lra]. }
  pose proof (G I1). pose proof (G I2). pose proof (G I3).
  assert (E : m == (w I1 * 1 + w I2 * 1 + w I3 * 1) * m) by (rewrite S; ring).
  assert (Z : w i * (m - f i) == 0) by (destruct i; lra).
  apply Qmult_integral in Z. destruct Z as [Z | Z]; [now left | right; lra].
Qed.
Lemma mean_not_above w f m :
  (forall i, 0 <= w i) -> weighted w (fun _ => 1) == 1 -> (forall i, w i == 0 \/ f i <= m) ->
  weighted w f <= m.
Proof.
  intros W S L. unfold weighted in *.
  assert (G : forall j, 0 <= w j * (m - f j)).
  { intros j. destruct (L j) as [E | E]; [rewrite E; lra | apply Qmult_le_0_compat; auto; lra]. }
  pose proof (G I1). pose proof (G I2). pose proof (G I3).
  assert (E : m == (w I1 * 1 + w I2 * 1 + w I3 * 1) * m) by (rewrite S; ring).
  lra.
Qed.

Lemma index_dec (i : index) l : In i l \/ ~ In i l.
Proof.
  assert (D : forall a b : index, {a = b} + {a <> b}) by decide equality.
  destruct (in_dec D i l); auto.
Qed.

Lemma cut_at a b la lb d h u v p :
  (forall i, In i la -> (dot d (corner a i) <= h)%Z) ->
  (forall i, In i lb -> (h <= dot d (corner b i))%Z) ->
  mean_of a la u p -> mean_of b lb v p ->
  mean_of a (filter (fun j => (dot d (corner a j) =? h)%Z) la) u p /\
  mean_of b (filter (fun j => (dot d (corner b j) =? h)%Z) lb) v p.
Proof.
  intros A B (U & UO & US & UD) (V & VO & VS & VD).
  assert (LA : forall i, u i == 0 \/ #(dot d (corner a i)) <= #h).
  { intros i. destruct (index_dec i la) as [I | I]; [right; apply -> inject_le; auto | left; auto]. }
  assert (LB : forall i, v i == 0 \/ - #(dot d (corner b i)) <= - #h).
  { intros i. destruct (index_dec i lb) as [I | I]; [|left; auto].
    right. assert (#h <= #(dot d (corner b i))) by (apply -> inject_le; auto). lra. }
  assert (N : weighted v (fun i => - #(dot d (corner b i))) ==
              - weighted v (fun i => #(dot d (corner b i)))) by (unfold weighted; ring).
  pose proof (mean_not_above u _ _ U US LA) as HA. rewrite <- UD in HA.
  pose proof (mean_not_above v _ _ V VS LB) as HB. rewrite N, <- VD in HB.
  split; (split; [assumption | split; [| split; assumption]]); intros i I.
  - destruct (mean_tight u _ _ i U US LA) as [E | E]; [rewrite <- UD; lra | assumption |].
    apply UO. intros J. apply I. apply filter_In. split; auto. apply Z.eqb_eq.
    now apply <- inject_eq.
  - destruct (mean_tight v _ _ i V VS LB) as [E | E]; [rewrite N, <- VD; lra | assumption |].
    apply VO. intros J. apply I. apply filter_In. split; auto. apply Z.eqb_eq.
    apply <- inject_eq. lra.
Qed.
Lemma cut_sound a b la lb d ka kb u v p :
  cut a b la lb d = Some (ka, kb) ->
  mean_of a la u p -> mean_of b lb v p -> mean_of a ka u p /\ mean_of b kb v p.
Proof.
  unfold cut. destruct la as [|i la]; [discriminate|].
  set (h := fold_left _ _ _). clearbody h.
  destruct (forallb _ (i :: la) && forallb _ lb)%bool eqn:H; [|discriminate].
  intros E A B. injection E as <- <-. apply andb_prop in H. destruct H as [HA HB].
  rewrite forallb_forall in HA, HB.
  apply (cut_at a b (i :: la) lb d h u v p); auto; intros j J.
  - apply Z.leb_le. now apply HA.
  - apply Z.leb_le. now apply HB.
Qed.
Lemma first_cut_sound a b la lb ds ka kb u v p :
  first_cut a b la lb ds = Some (ka, kb) ->
  mean_of a la u p -> mean_of b lb v p -> mean_of a ka u p /\ mean_of b kb v p.
Proof.
  induction ds as [|d ds IH]; simpl; [discriminate|].
  destruct (cut a b la lb d) as [[ca cb]|] eqn:C; [|assumption].
  destruct (fewer ca la || fewer cb lb)%bool; [|assumption].
  intros E. injection E as <- <-. now apply (cut_sound a b la lb d).
Qed.
Lemma find_cut_sound a b la lb gs ka kb u v p :
  find_cut a b la lb gs = Some (ka, kb) ->
  mean_of a la u p -> mean_of b lb v p -> mean_of a ka u p /\ mean_of b kb v p.
Proof.
  induction gs as [|g gs IH]; simpl; [discriminate|].
  destruct (first_cut a b la lb (g tt)) as [[ca cb]|] eqn:C; [|assumption].
  intros E. injection E as <- <-. eapply first_cut_sound, C.
Qed.

(** [covered_sound]: if corners lie on one segment, every mean of these corners lies on it. *)
Lemma qdot_unit p : qdot unit_x p == x p /\ qdot unit_y p == y p /\ qdot unit_z p == z p.
Proof.
  unfold qdot, unit_x, unit_y, unit_z. cbn [x y z]. change #1 with 1. change #0 with 0.
  repeat split; ring.
Qed.
Lemma covered_sound shared t l w p :
  covered shared t l = true -> mean_of t l w p ->
  exists c d, In c shared /\ In d shared /\ on_segment (qvec c) (qvec d) p.
Proof.
  unfold covered. rewrite existsb_exists. intros (c & C & H). apply existsb_exists in H.
  destruct H as (d & D & H). rewrite forallb_forall in H.
  intros (W & WO & WS & WD). exists c, d. repeat split; auto.
  (* Each corner with a weight above 0 is (1 - s) c + s d for some s. *)
  assert (P : forall i, exists s, 0 <= s /\ s <= 1 /\
            (w i == 0 \/ same (qvec (corner t i)) (plus (times (1 - s) (qvec c)) (times s (qvec d))))).
  { intros i. destruct (index_dec i l) as [I | I].
    - destruct (lies_on_sound _ _ _ (H i I)) as (s & S0 & S1 & E). exists s. auto.
    - exists 0. repeat split; try lra. left. auto. }
  destruct (P I1) as (s1 & A1 & B1 & E1), (P I2) as (s2 & A2 & B2 & E2), (P I3) as (s3 & A3 & B3 & E3).
  exists (w I1 * s1 + w I2 * s2 + w I3 * s3). unfold weighted in WS.
  pose proof (W I1) as W1. pose proof (W I2) as W2. pose proof (W I3) as W3.
  assert (0 <= w I1 * s1) by (apply Qmult_le_0_compat; lra).
  assert (0 <= w I2 * s2) by (apply Qmult_le_0_compat; lra).
  assert (0 <= w I3 * s3) by (apply Qmult_le_0_compat; lra).
  assert (0 <= w I1 * (1 - s1)) by (apply Qmult_le_0_compat; lra).
  assert (0 <= w I2 * (1 - s2)) by (apply Qmult_le_0_compat; lra).
  assert (0 <= w I3 * (1 - s3)) by (apply Qmult_le_0_compat; lra).
  split; [lra|]. split; [lra|].
  (* Each coordinate is a linear function k of the point. *)
  assert (K : forall k, qdot k p == (1 - (w I1 * s1 + w I2 * s2 + w I3 * s3)) * #(dot k c) +
                                    (w I1 * s1 + w I2 * s2 + w I3 * s3) * #(dot k d)).
  { intros k. rewrite WD. unfold weighted.
    assert (T : forall i s, (w i == 0 \/ same (qvec (corner t i)) (plus (times (1 - s) (qvec c)) (times s (qvec d)))) ->
              w i * #(dot k (corner t i)) == w i * ((1 - s) * #(dot k c) + s * #(dot k d))).
    { intros i s [E | E]; [rewrite E; ring|].
      rewrite <- qdot_qvec, (qdot_same _ _ _ E), <- !qdot_qvec. unfold qdot, plus, times. cbn [x y z]. ring. }
    rewrite (T I1 s1 E1), (T I2 s2 E2), (T I3 s3 E3).
    setoid_replace (1 - (w I1 * s1 + w I2 * s2 + w I3 * s3)) with
      (w I1 * 1 + w I2 * 1 + w I3 * 1 - (w I1 * s1 + w I2 * s2 + w I3 * s3)) by (rewrite WS; reflexivity).
    ring. }
  destruct (qdot_unit p) as (PX & PY & PZ).
  unfold same, plus, times, qvec, map_vec. cbn [x y z]. repeat split.
  - now rewrite <- PX, K, !dot_unit_x.
  - now rewrite <- PY, K, !dot_unit_y.
  - now rewrite <- PZ, K, !dot_unit_z.
Qed.

(** A bound for all corners in l is a bound for their weighted mean. *)
Lemma mean_at_most t l w p n h : mean_of t l w p ->
  (forall i, In i l -> (dot n (corner t i) <= h)%Z) -> qdot n p <= #h.
Proof.
  intros (W & WO & WS & WD) A. rewrite WD. apply mean_not_above; auto.
  intros i. destruct (index_dec i l); [right; apply -> inject_le; auto | left; auto].
Qed.
Definition opposite (n : vec Z) : vec Z := Vec (- x n)%Z (- y n)%Z (- z n)%Z.
Lemma dot_opposite n p : dot (opposite n) p = (- dot n p)%Z.
Proof. unfold dot, opposite. cbn [x y z]. ring. Qed.
Lemma qdot_opposite n p : qdot (opposite n) p == - qdot n p.
Proof. unfold qdot, opposite. cbn [x y z]. inject. ring. Qed.
Lemma mean_at_least t l w p n h : mean_of t l w p ->
  (forall i, In i l -> (h <= dot n (corner t i))%Z) -> #h <= qdot n p.
Proof.
  intros M A. assert (B : qdot (opposite n) p <= #(- h)).
  { apply (mean_at_most t l w); [assumption|]. intros i I. rewrite dot_opposite. specialize (A i I). lia. }
  rewrite qdot_opposite in B. inject. lra.
Qed.
Lemma mean_equal t l w p n h : mean_of t l w p ->
  (forall i, In i l -> dot n (corner t i) = h) -> qdot n p == #h.
Proof.
  intros M A. apply Qle_antisym.
  - apply (mean_at_most t l w); auto. intros i I. rewrite (A i I). lia.
  - apply (mean_at_least t l w); auto. intros i I. rewrite (A i I). lia.
Qed.

Lemma on_line_sound c e t l w p : on_line c e t l = true -> mean_of t l w p ->
  #(dot e e) * x p == #(dot e e) * #(x c) + (qdot e p - #(dot e c)) * #(x e) /\
  #(dot e e) * y p == #(dot e e) * #(y c) + (qdot e p - #(dot e c)) * #(y e) /\
  #(dot e e) * z p == #(dot e e) * #(z c) + (qdot e p - #(dot e c)) * #(z e).
Proof.
  unfold on_line. rewrite forallb_forall. intros H M.
  assert (K : forall k, In k [unit_x; unit_y; unit_z] -> qdot (away k e) p == #(dot (away k e) c)).
  { intros k K. apply (mean_equal t l w); auto. intros i I. specialize (H i I).
    rewrite forallb_forall in H. apply Z.eqb_eq. now apply H. }
  assert (E : forall k, qdot (away k e) p == #(dot e e) * qdot k p - #(dot k e) * qdot e p).
  { intros k. unfold away, qdot, sub, scale. cbn [x y z]. inject. ring. }
  assert (F : forall k, dot (away k e) c = (dot e e * dot k c - dot k e * dot e c)%Z).
  { intros k. unfold away. generalize (dot e e) (dot k e). intros u v. unfold dot, sub, scale. cbn [x y z]. ring. }
  destruct (qdot_unit p) as (PX & PY & PZ).
  pose proof (K unit_x (or_introl eq_refl)) as X. pose proof (K unit_y (or_intror (or_introl eq_refl))) as Y.
  pose proof (K unit_z (or_intror (or_intror (or_introl eq_refl)))) as Z.
  rewrite E, F, ?dot_unit_x, PX in X. rewrite E, F, ?dot_unit_y, PY in Y. rewrite E, F, ?dot_unit_z, PZ in Z.
  inject. repeat split; lra.
Qed.

Lemma pinned_by_sound a b la lb c d e n u v p :
  pinned_by a b la lb c d e n = true -> c = d \/ e = sub d c ->
  mean_of a la u p -> mean_of b lb v p -> on_segment (qvec c) (qvec d) p.
Proof.
  unfold pinned_by. intros H CD A B. tests.
  rename H into P, H2 into L, H1 into LO, H0 into HI.
  destruct (on_line_sound _ _ _ _ _ _ L A) as (X & Y & Z).
  assert (LO' : #(dot n c) <= qdot n p).
  { unfold at_least in LO. rewrite orb_true_iff, !forallb_forall in LO. destruct LO as [LO | LO].
    - apply (mean_at_least a la u); auto. intros i I. apply Z.leb_le. now apply LO.
    - apply (mean_at_least b lb v); auto. intros i I. apply Z.leb_le. now apply LO. }
  assert (HI' : qdot n p <= #(dot n d)).
  { unfold at_most in HI. rewrite orb_true_iff, !forallb_forall in HI. destruct HI as [HI | HI].
    - apply (mean_at_most a la u); auto. intros i I. apply Z.leb_le. now apply HI.
    - apply (mean_at_most b lb v); auto. intros i I. apply Z.leb_le. now apply HI. }
  clear L LO HI A B.
  assert (EE : (0 < dot e e)%Z).
  { destruct (Z.eq_dec (x e) 0), (Z.eq_dec (y e) 0), (Z.eq_dec (z e) 0); unfold dot in *; nia. }
  apply -> inject_lt in EE. apply -> inject_lt in P. change #0 with 0 in *.
  assert (N : ~ #(dot e e) == 0) by lra.
  set (t := (qdot e p - #(dot e c)) / #(dot e e)).
  assert (X' : x p == #(x c) + t * #(x e)).
  { unfold t. apply (Qmult_inj_l _ _ #(dot e e)); [assumption|]. rewrite X. field. assumption. }
  assert (Y' : y p == #(y c) + t * #(y e)).
  { unfold t. apply (Qmult_inj_l _ _ #(dot e e)); [assumption|]. rewrite Y. field. assumption. }
  assert (Z' : z p == #(z c) + t * #(z e)).
  { unfold t. apply (Qmult_inj_l _ _ #(dot e e)); [assumption|]. rewrite Z. field. assumption. }
  clearbody t. clear X Y Z.
  assert (D : qdot n p == #(dot n c) + t * #(dot n e)).
  { unfold qdot, dot. inject. rewrite X', Y', Z'. ring. }
  rewrite D in LO', HI'.
  assert (T0 : 0 <= t) by (destruct (Qlt_le_dec t 0); [exfalso; nra | assumption]).
  unfold on_segment, same, plus, times, qvec, map_vec. cbn [x y z].
  destruct CD as [-> | ->].
  - assert (T : t == 0) by (apply Qle_antisym; [destruct (Qlt_le_dec 0 t); [exfalso; nra | assumption] | assumption]).
    exists 0. rewrite X', Y', Z', T. repeat split; lra.
  - assert (S : dot n (sub d c) = (dot n d - dot n c)%Z) by (unfold dot, sub; cbn [x y z]; ring).
    rewrite S in *. unfold sub in X', Y', Z'. cbn [x y z] in X', Y', Z'. inject.
    exists t. split; [assumption|]. split; [destruct (Qlt_le_dec 1 t); [exfalso; nra | assumption]|].
    rewrite X', Y', Z'. repeat split; ring.
Qed.
Lemma pinned_sound shared a b la lb u v p :
  pinned shared a b la lb = true -> mean_of a la u p -> mean_of b lb v p ->
  exists c d, In c shared /\ In d shared /\ on_segment (qvec c) (qvec d) p.
Proof.
  unfold pinned. intros H A B. apply existsb_exists in H. destruct H as (c & C & H).
  apply existsb_exists in H. destruct H as (d & D & H). exists c, d. split; [assumption|]. split; [assumption|].
  destruct (equal c d) eqn:E.
  - apply equal_eq in E. subst d. apply existsb_exists in H. destruct H as (i & _ & H).
    apply existsb_exists in H. destruct H as (j & _ & H). eapply pinned_by_sound; eauto.
  - eapply pinned_by_sound; eauto.
Qed.

Lemma only_shared_from n a b la lb u v p :
  only_shared n a b (shared_corners a b) la lb = true ->
  mean_of a la u p -> mean_of b lb v p -> in_shared_part (qtri a) (qtri b) p.
Proof.
  revert la lb. induction n as [|n IH]; intros la lb H A B; cbn [only_shared] in H;
    rewrite in_shared_part_corners; rewrite !orb_true_iff in H; destruct H as [[H | H] | H].
  1, 4: now apply (covered_sound _ a la u).
  1, 3: now apply (covered_sound _ b lb v).
  - discriminate.
  - destruct (find_cut a b la lb (cuts a b)) as [[ka kb]|] eqn:C.
    + destruct (find_cut_sound _ _ _ _ _ _ _ _ _ _ C A B).
      rewrite <- in_shared_part_corners. now apply (IH ka kb).
    + now apply (pinned_sound _ a b la lb u v).
Qed.
Lemma only_shared_sound n a b p :
  only_shared n a b (shared_corners a b) indices indices = true ->
  inside (qtri a) p -> inside (qtri b) p -> in_shared_part (qtri a) (qtri b) p.
Proof.
  intros H A B. apply mean_of_inside in A, B. destruct A as (u & A), B as (v & B).
  now apply (only_shared_from n a b indices indices u v).
Qed.
