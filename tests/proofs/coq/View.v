(** The heart of lemmas 1 and 3 and of theorem 1 (docs/reliability.md) over the real numbers: the samples of a
    pixel bound the depth of each point of the triangle in it, and the pixel is covered. *)
From Coq Require Import Reals Lra Psatz List.
Import ListNotations.
Require Import Fan.
Open Scope R_scope.

(** ** Lemma 1 *)
Record place := Place { px : R; py : R; pz : R }.
Definition squared (p q : place) : R := (px p - px q) ^ 2 + (py p - py q) ^ 2 + (pz p - pz q) ^ 2.

(** [Q] is a point of the triangle, [Q'] one of the drawn patch within E of it (lemma 16); the pixel whose
    centre is (cx, cy) holds Q. *)
Record seen_at (E : R) (Q Q' : place) (cx cy : R) : Prop := {
  near_x : Rabs (px Q - px Q') <= E; near_y : Rabs (py Q - py Q') <= E; near_z : Rabs (pz Q - pz Q') <= E;
  pixel_x : Rabs (cx - px Q) <= 1 / 2; pixel_y : Rabs (cy - py Q) <= 1 / 2 }.

(** The terms `sampling` and `double` of the budget (docs/budget.md). *)
Definition reach (E : R) : R := sqrt 2 / 2 + sqrt 2 * E.
Definition double (E : R) : R := E ^ 2.
Lemma sqrt_2 : 0 < sqrt 2 /\ sqrt 2 * sqrt 2 = 2.
Proof. split; [apply sqrt_lt_R0 | apply sqrt_sqrt]; lra. Qed.

(** In the image the centre is within [reach] of Q'; in space it is, at the depth of Q, within r. *)
Lemma centre_is_near E Q Q' cx cy : 0 <= E -> seen_at E Q Q' cx cy ->
  (cx - px Q') ^ 2 + (cy - py Q') ^ 2 <= reach E ^ 2 /\
  squared (Place cx cy (pz Q)) Q' <= (reach E + double E) ^ 2.
Proof.
  intros P [X Y Z U V]. apply Rabs_between in X, Y, Z, U, V. destruct sqrt_2 as [S S2].
  assert (R2 : reach E ^ 2 = 2 * (1 / 2 + E) ^ 2).
  { unfold reach. transitivity (sqrt 2 * sqrt 2 * (1 / 2 + E) ^ 2); [field | rewrite S2; ring]. }
  assert (I : (cx - px Q') ^ 2 + (cy - py Q') ^ 2 <= reach E ^ 2) by (rewrite R2; nra).
  split; [exact I|]. unfold squared, double. simpl px. simpl py. simpl pz.
  assert (1 / 2 <= reach E) by (unfold reach; nra).
  assert ((pz Q - pz Q') ^ 2 <= E ^ 2) by nra. nra.
Qed.

(** A solid that contains a ball of radius r around Q', and a kernel whose interval on the line of sight
    contains all of the solid there (lemmas 17 and 20). *)
Definition holds_ball (solid : place -> Prop) (r : R) (Q' : place) : Prop :=
  forall p, squared p Q' <= r ^ 2 -> solid p.
Definition bounds_solid (entry exit : R) (solid : place -> Prop) (cx cy : R) : Prop :=
  forall z, solid (Place cx cy z) -> entry <= z <= exit.
Theorem samples_bound_the_point E r Q Q' cx cy solid entry exit :
  0 <= E -> reach E + double E <= r -> seen_at E Q Q' cx cy -> holds_ball solid r Q' ->
  bounds_solid entry exit solid cx cy -> entry <= pz Q <= exit.
Proof.
  intros P R S B K. apply K, B. apply centre_is_near in S as [_ S]; [|trivial].
  assert (0 <= reach E + double E) by (destruct sqrt_2; unfold reach, double; nra). nra.
Qed.

(** Lemma 1 from lemma 16: the patch is clipped from a triangle that has Q; each triangle of its fan has a
    solid with a ball around each of its points, and a kernel that bounds the solid. The coordinates of Q
    are Q 0, Q 1 and its depth Q 2. *)
Definition point_of (u v w : R) (p s t : corner) : place :=
  let at_axis i := u * computed p i + v * computed s i + w * computed t i in
  Place (at_axis 0%nat) (at_axis 1%nat) (at_axis 2%nat).
Theorem lemma_1 Q A B E r a b c p q s l cx cy (solid : corner -> corner -> place -> Prop)
    (entry exit : corner -> corner -> R) :
  0 <= E < 1 -> reach E + double E <= r ->
  Forall (near Q A B E) [a; b; c] -> inside (partner a) (partner b) (partner c) ->
  clipped Q A B E [a; b; c] (p :: q :: s :: l) ->
  Rabs (cx - Q 0%nat) <= 1 / 2 -> Rabs (cy - Q 1%nat) <= 1 / 2 ->
  (forall t t' u v w, 0 <= u -> 0 <= v -> 0 <= w -> u + v + w = 1 ->
     holds_ball (solid t t') r (point_of u v w p t t')) ->
  (forall t t', bounds_solid (entry t t') (exit t t') (solid t t') cx cy) ->
  exists before t t' after, q :: s :: l = before ++ t :: t' :: after /\ entry t t' <= Q 2%nat <= exit t t'.
Proof.
  intros [P P'] R N I C X Y B' K.
  destruct (the_fan_keeps_Q Q A B E P' _ _ _ _ _ _ _ N I C) as (before & t & t' & after & u & v & w & F & U & V & W & S & D).
  exists before, t, t', after. split; [exact F|].
  change (Q 2%nat) with (pz (Place (Q 0%nat) (Q 1%nat) (Q 2%nat))).
  apply samples_bound_the_point with E r (point_of u v w p t t') cx cy (solid t t'); auto.
  split; simpl; auto.
Qed.

(** Theorem 1: of two triangles with a common point the samples overlap, both ways. So with depth maps that
    never exchange an entry and an exit (lemma 4) each is seen when it is asked after the other was stored. *)
Theorem triangles_that_meet_overlap E r Q Q1 Q2 cx cy solid1 solid2 entry1 exit1 entry2 exit2 :
  0 <= E -> reach E + double E <= r -> seen_at E Q Q1 cx cy -> seen_at E Q Q2 cx cy ->
  holds_ball solid1 r Q1 -> holds_ball solid2 r Q2 ->
  bounds_solid entry1 exit1 solid1 cx cy -> bounds_solid entry2 exit2 solid2 cx cy ->
  entry1 <= pz Q <= exit2 /\ entry2 <= pz Q <= exit1.
Proof.
  intros P R S1 S2 B1 B2 K1 K2.
  pose proof (samples_bound_the_point _ _ _ _ _ _ _ _ _ P R S1 B1 K1).
  pose proof (samples_bound_the_point _ _ _ _ _ _ _ _ _ P R S2 B2 K2). lra.
Qed.

(** ** Lemma 3 *)
(** Coordinates along the sides of the proxy, with the centre of the pixel as the origin. The rectangle from
    (x0, y0) to (x1, y1) contains the disc of radius r around q, and q is within d of the origin. *)
Definition holds_disc (x0 y0 x1 y1 r : R) (q : point) : Prop :=
  x0 <= fst q - r /\ fst q + r <= x1 /\ y0 <= snd q - r /\ snd q + r <= y1.
Definition displaced (w : R) (p : point) (x y : R) : Prop := (fst p - x) ^ 2 + (snd p - y) ^ 2 <= w ^ 2.
Lemma sum_of_squares a b w : 0 <= w -> a ^ 2 + b ^ 2 <= w ^ 2 -> - w <= a <= w /\ - w <= b <= w.
Proof. intros. split; split; nra. Qed.

(** The corners reach the rasterizer displaced by at most w. One of the two triangles that share the diagonal
    from a to c has the centre. *)
Theorem the_centre_is_covered x0 y0 x1 y1 r w d q a b c e : 0 <= w -> 0 <= d -> d + w < r ->
  fst q ^ 2 + snd q ^ 2 <= d ^ 2 -> holds_disc x0 y0 x1 y1 r q ->
  displaced w a x0 y0 -> displaced w b x1 y0 -> displaced w c x1 y1 -> displaced w e x0 y1 ->
  inside a b c \/ inside a c e.
Proof.
  intros W D R Q (X0 & X1 & Y0 & Y1) A B C E. apply sum_of_squares in Q; [|trivial].
  apply sum_of_squares in A, B, C, E; trivial.
  assert (a_ : fst a < 0 /\ snd a < 0) by lra. assert (b_ : 0 < fst b /\ snd b < 0) by lra.
  assert (c_ : 0 < fst c /\ 0 < snd c) by lra. assert (e_ : fst e < 0 /\ 0 < snd e) by lra.
  clear - a_ b_ c_ e_. destruct a as [ax ay], b as [bx b'], c as [cx cy], e as [ex ey]. simpl in *.
  destruct (Rle_lt_dec 0 (cx * ay - cy * ax)) as [S | S].
  - left. apply inside_scaled with (bx * cy - b' * cx) (cx * ay - cy * ax) (ax * b' - ay * bx); simpl; try ring; nra.
  - right. apply inside_scaled with (cx * ey - cy * ex) (ex * ay - ey * ax) (ax * cy - ay * cx); simpl; try ring; nra.
Qed.

Check samples_bound_the_point.
Check lemma_1.
Check triangles_that_meet_overlap.
Check the_centre_is_covered.
Print Assumptions samples_bound_the_point.
Print Assumptions lemma_1.
Print Assumptions triangles_that_meet_overlap.
Print Assumptions the_centre_is_covered.
