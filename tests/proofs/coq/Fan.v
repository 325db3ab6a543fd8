(** Lemma 16 (docs/budget.md) over the real numbers: clipping keeps each point that is a pixel inside all
    planes, although the corners are rounded. Needs the axioms of Coq's reals. *)
From Coq Require Import Reals Lra List ZArith Lia.
Import ListNotations.
Open Scope R_scope.

(** ** Winding in the plane of the triangle, whose origin is the point Q *)
Definition point : Type := R * R.
Definition side (p q : point) : R := fst p * snd q - snd p * fst q.
Definition on (p q : point) : Prop :=
  exists t, 0 <= t <= 1 /\ (1 - t) * fst p + t * fst q = 0 /\ (1 - t) * snd p + t * snd q = 0.
Definition inside (a b c : point) : Prop :=
  exists u v w, 0 <= u /\ 0 <= v /\ 0 <= w /\ u + v + w = 1 /\
    u * fst a + v * fst b + w * fst c = 0 /\ u * snd a + v * snd b + w * snd c = 0.

(** How often the edge from p to q crosses the positive half of the first axis, upward. *)
Definition crossing (p q : point) : Z :=
  if Rlt_dec (snd p) 0 then
    if Rlt_dec (snd q) 0 then 0%Z else if Rlt_dec 0 (side p q) then 1%Z else 0%Z
  else
    if Rlt_dec (snd q) 0 then if Rlt_dec (side p q) 0 then (-1)%Z else 0%Z else 0%Z.

(** The edges of a path from p over l to e. A polygon is the path from its first corner to itself. *)
Fixpoint turns (p : point) (l : list point) (e : point) : Z :=
  match l with [] => crossing p e | q :: l => (crossing p q + turns q l e)%Z end.
Fixpoint touched (p : point) (l : list point) (e : point) : Prop :=
  match l with [] => on p e | q :: l => on p q \/ touched q l e end.

Ltac cases := unfold crossing, side in *; simpl in *; repeat (destruct Rlt_dec; try lra; try lia).

Lemma crossing_back p q : crossing q p = (- crossing p q)%Z.
Proof. cases. Qed.

(** A path in a halfplane without Q that ends where it begins does not wind around Q. *)
Definition ahead (n p : point) : Prop := 0 < fst n * fst p + snd n * snd p.
Definition above (n p : point) : Z :=
  if Rlt_dec 0 (fst n) then if Rlt_dec (snd p) 0 then 0%Z else 1%Z else 0%Z.
Lemma crossing_ahead n p q : ahead n p -> ahead n q -> crossing p q = (above n q - above n p)%Z.
Proof.
  unfold ahead, above. destruct n as [n m], p as [px py], q as [qx qy]; simpl. intros P Q.
  cases; try nra.
Qed.
Lemma turns_ahead n e l : forall p, ahead n p -> Forall (ahead n) l -> ahead n e ->
  turns p l e = (above n e - above n p)%Z.
Proof.
  induction l as [|q l IH]; intros p P L E; simpl; [now apply crossing_ahead|].
  inversion_clear L. rewrite (crossing_ahead n), IH; trivial. lia.
Qed.
Lemma not_on_ahead n p q : ahead n p -> ahead n q -> ~ on p q.
Proof.
  unfold ahead. intros P Q (t & T & X & Y).
  assert (0 = (1 - t) * (fst n * fst p + snd n * snd p) + t * (fst n * fst q + snd n * snd q))
    by (replace 0 with (fst n * 0 + snd n * 0) by lra; rewrite <- X, <- Y at 1; lra).
  destruct (Rle_lt_dec t (1 / 2)); nra.
Qed.
Lemma not_touched_ahead n e l : forall p, ahead n p -> Forall (ahead n) l -> ahead n e -> ~ touched p l e.
Proof.
  induction l as [|q l IH]; intros p P L E; simpl; [now apply (not_on_ahead n)|].
  inversion_clear L. intros [T | T]; revert T; [now apply (not_on_ahead n) | now apply IH].
Qed.

Lemma turns_app p l q m e : turns p (l ++ q :: m) e = (turns p l q + turns q m e)%Z.
Proof. revert p. induction l; intros p; simpl; [trivial|]. rewrite IHl. lia. Qed.
Lemma touched_app p l q m e : touched p (l ++ q :: m) e <-> touched p l q \/ touched q m e.
Proof. revert p. induction l; intros p; simpl; [tauto|]. rewrite IHl. tauto. Qed.

(** Q lies on the polygon, or the polygon winds around it. *)
Definition holds (polygon : list point) : Prop :=
  match polygon with [] => False | p :: l => touched p l p \/ turns p l p <> 0%Z end.

(** A corner that is put on an edge changes neither. *)
Definition between (p q m : point) : Prop :=
  exists t, 0 <= t <= 1 /\ fst m = (1 - t) * fst p + t * fst q /\ snd m = (1 - t) * snd p + t * snd q.
Lemma on_split p q m : between p q m -> on p q -> on p m \/ on m q.
Proof.
  intros (t & T & X & Y) (s & S & U & V). destruct (Rle_lt_dec s t) as [H | H].
  - left. destruct (Req_dec t 0) as [Z | Z].
    + exists 0. assert (s = 0) by lra. subst. split; [lra|]. split; lra.
    + assert (E : s / t * t = s) by (field; trivial). set (k := s / t) in *. exists k.
      split; [split; apply Rmult_le_reg_r with t; lra|]. rewrite X, Y.
      split; [replace 0 with ((1 - k * t) * fst p + k * t * fst q) by (now rewrite E)
             |replace 0 with ((1 - k * t) * snd p + k * t * snd q) by (now rewrite E)]; ring.
  - right. assert (E : (s - t) / (1 - t) * (1 - t) = s - t) by (field; lra). set (k := (s - t) / (1 - t)) in *.
    exists k. split; [split; apply Rmult_le_reg_r with (1 - t); lra|]. rewrite X, Y.
    assert (K : (1 - k) * (1 - t) = 1 - s /\ (1 - k) * t + k = s) by lra. destruct K as [K K'].
    split; [replace 0 with ((1 - k) * (1 - t) * fst p + ((1 - k) * t + k) * fst q) by (now rewrite K, K')
           |replace 0 with ((1 - k) * (1 - t) * snd p + ((1 - k) * t + k) * snd q) by (now rewrite K, K')]; ring.
Qed.
Lemma crossing_split p q m : between p q m -> crossing p q = (crossing p m + crossing m q)%Z.
Proof.
  intros (t & T & X & Y).
  assert (A : side p m = t * side p q) by (unfold side; rewrite X, Y; lra).
  assert (B : side m q = (1 - t) * side p q) by (unfold side; rewrite X, Y; lra).
  unfold crossing. rewrite A, B. destruct (Rtotal_order (side p q) 0) as [S | [S | S]].
  - cases; try nra.
  - rewrite S. cases; try nra.
  - cases; try nra.
Qed.

(** A triangle around which its border winds holds Q, and one that holds Q has it on the border or inside. *)
Definition around (a b c : point) : Z := (crossing a b + crossing b c + crossing c a)%Z.
Lemma inside_turned a b c : inside a b c -> inside b c a.
Proof. intros (u & v & w & H). exists v, w, u. repeat split; lra. Qed.
(** Where the weighted sum of the corners is Q, whatever the sum of the weights. *)
Lemma inside_scaled a b c u v w : 0 <= u -> 0 <= v -> 0 <= w -> 0 < u + v + w ->
  u * fst a + v * fst b + w * fst c = 0 -> u * snd a + v * snd b + w * snd c = 0 -> inside a b c.
Proof.
  intros U V W S X Y. set (s := u + v + w) in *. exists (u / s), (v / s), (w / s).
  assert (I : 0 < / s) by now apply Rinv_0_lt_compat. unfold Rdiv.
  repeat split; try (apply Rmult_le_pos; lra).
  - rewrite <- !Rmult_plus_distr_r. fold s. field. lra.
  - rewrite <- (Rmult_0_l (/ s)), <- X. ring.
  - rewrite <- (Rmult_0_l (/ s)), <- Y. ring.
Qed.
Lemma inside_swapped a b c : inside a b c -> inside a c b.
Proof. intros (u & v & w & H). exists u, w, v. repeat split; lra. Qed.
(** The corner a is below the first axis and the others are not, or the reverse; the axis is met to the
    right on the way to b, and not on the way to c. *)
Lemma inside_odd a b c : (snd a < 0 /\ 0 <= snd b /\ 0 <= snd c /\ 0 < side a b /\ side a c <= 0) \/
  (0 <= snd a /\ snd b < 0 /\ snd c < 0 /\ side a b < 0 /\ 0 <= side a c) -> inside a b c.
Proof.
  unfold side. destruct a as [ax ay], b as [bx b'], c as [cx cy]. simpl.
  intros [(A & B & C & S & T) | (A & B & C & S & T)].
  - apply inside_scaled with (bx * cy - b' * cx) (cx * ay - cy * ax) (ax * b' - ay * bx); simpl; try ring; nra.
  - apply inside_scaled with (b' * cx - bx * cy) (cy * ax - cx * ay) (ay * bx - ax * b'); simpl; try ring; nra.
Qed.
Lemma around_inside a b c : around a b c <> 0%Z -> inside a b c.
Proof.
  assert (O : forall a b c, (snd a < 0 /\ 0 <= snd b /\ 0 <= snd c) \/ (0 <= snd a /\ snd b < 0 /\ snd c < 0) ->
    around a b c <> 0%Z -> inside a b c).
  { clear. intros a b c S N. assert (R : side c a = - side a c) by (unfold side; lra).
    unfold around, crossing in N. rewrite R in N.
    destruct S as [S | S]; repeat (destruct Rlt_dec in N; try lra; try lia);
      first [apply inside_odd; lra | apply inside_swapped, inside_odd; lra]. }
  assert (T : around a b c = around b c a /\ around a b c = around c a b) by (unfold around; lia).
  intros N. destruct (Rlt_le_dec (snd a) 0), (Rlt_le_dec (snd b) 0), (Rlt_le_dec (snd c) 0);
    try (apply O; [lra | trivial]);
    try (apply inside_turned, O; [lra | lia]); try (apply inside_turned, inside_turned, O; [lra | lia]).
  all: unfold around in N; cases.
Qed.

Lemma on_line a b : side a b = 0 -> fst a * fst b + snd a * snd b <= 0 -> on a b.
Proof.
  unfold side, on. destruct a as [x y], b as [z w]. simpl. intros S D.
  set (s := x * x + y * y - (x * z + y * w)).
  destruct (Req_dec s 0) as [Z | Z].
  - exists 0. assert (x = 0 /\ y = 0) as [-> ->] by (unfold s in Z; nra). repeat split; lra.
  - assert (P : 0 < s) by (unfold s in *; nra). assert (I := Rinv_0_lt_compat _ P).
    assert (E : s * / s = 1) by now apply Rinv_r. exists ((x * x + y * y) * / s).
    assert (N : 1 - (x * x + y * y) * / s = - (x * z + y * w) * / s) by (rewrite <- E; unfold s; ring).
    rewrite N. repeat split.
    + apply Rmult_le_pos; nra.
    + enough (0 <= - (x * z + y * w) * / s) by lra. apply Rmult_le_pos; lra.
    + transitivity (- y * (x * w - y * z) * / s); [ring | rewrite S; ring].
    + transitivity (x * (x * w - y * z) * / s); [ring | rewrite S; ring].
Qed.
Lemma on_back a b : on a b -> on b a.
Proof. intros (t & T & X & Y). exists (1 - t). repeat split; lra. Qed.

Lemma inside_holds a b c : inside a b c -> holds [a; b; c].
Proof.
  intros (u & v & w & U & V & W & S & X & Y). simpl.
  assert (A : v * side a b = w * side c a).
  { unfold side. transitivity (fst a * - (u * snd a + w * snd c) - snd a * - (u * fst a + w * fst c));
      [|ring]. replace (- (u * snd a + w * snd c)) with (v * snd b) by lra.
    replace (- (u * fst a + w * fst c)) with (v * fst b) by lra. ring. }
  assert (B : u * side a b = w * side b c).
  { unfold side. transitivity (- (v * fst b + w * fst c) * snd b - - (v * snd b + w * snd c) * fst b);
      [|ring]. replace (- (v * snd b + w * snd c)) with (u * snd a) by lra.
    replace (- (v * fst b + w * fst c)) with (u * fst a) by lra. ring. }
  destruct (Req_dec u 0) as [-> | U']; [left; right; left; exists w; repeat split; try lra; 
    replace (1 - w) with v by lra; lra|].
  destruct (Req_dec v 0) as [-> | V']; [left; right; right; exists u; repeat split; try lra;
    replace (1 - u) with w by lra; lra|].
  destruct (Req_dec w 0) as [-> | W']; [left; left; exists v; repeat split; try lra;
    replace (1 - v) with u by lra; lra|].
  assert (Up : side a b <> 0 -> ~ (0 <= snd a /\ 0 <= snd b /\ 0 <= snd c)).
  { intros N (P & Q & R). assert (snd a = 0 /\ snd b = 0) as [Z Z']; [|apply N; unfold side; rewrite Z, Z'; ring].
    assert (0 <= u * snd a) by nra. assert (0 <= v * snd b) by nra. assert (0 <= w * snd c) by nra.
    split; [apply (Rmult_eq_reg_l u) | apply (Rmult_eq_reg_l v)]; lra. }
  assert (Down : ~ (snd a < 0 /\ snd b < 0 /\ snd c < 0)) by nra.
  destruct (Rtotal_order (side a b) 0) as [N | [Z | P]].
  - right. assert (side c a < 0) by nra. assert (side b c < 0) by nra. specialize (Up ltac:(lra)).
    unfold crossing. repeat (destruct Rlt_dec; try lra; try lia).
  - left. rewrite Z in A, B. assert (side c a = 0) by nra. assert (side b c = 0) by nra.
    destruct (Rle_lt_dec (fst a * fst b + snd a * snd b) 0) as [D | D]; [left; now apply on_line|].
    right; right. apply on_line; trivial.
    assert (u * (fst a * fst a + snd a * snd a) + v * (fst a * fst b + snd a * snd b) +
            w * (fst a * fst c + snd a * snd c) = 0).
    { transitivity (fst a * (u * fst a + v * fst b + w * fst c) + snd a * (u * snd a + v * snd b + w * snd c));
        [ring | rewrite X, Y; ring]. }
    nra.
  - right. assert (0 < side c a) by nra. assert (0 < side b c) by nra. specialize (Up ltac:(lra)).
    unfold crossing. repeat (destruct Rlt_dec; try lra; try lia).
Qed.

(** ** The fan *)
(** What a closed polygon holds is in a triangle of its fan. *)
Lemma holds_fan a : forall p q l, holds (a :: p :: q :: l) ->
  exists before b c after, p :: q :: l = before ++ b :: c :: after /\ inside a b c.
Proof.
  intros p q l. revert p q. induction l as [|r l IH]; intros p q H.
  - exists [], p, q, []. split; [trivial|]. simpl in H.
    destruct H as [[H | [H | H]] | H]; [| | |apply around_inside; unfold around; lia].
    all: destruct H as (t & T & X & Y).
    + exists (1 - t), t, 0. repeat split; lra.
    + exists 0, (1 - t), t. repeat split; lra.
    + exists t, 0, (1 - t). repeat split; lra.
  - assert (F : inside a p q \/ holds (a :: q :: r :: l)).
    { simpl in H. destruct H as [[(t & T & X & Y) | [(t & T & X & Y) | H]] | H].
      - left. exists (1 - t), t, 0. repeat split; lra.
      - left. exists 0, (1 - t), t. repeat split; lra.
      - right. simpl. tauto.
      - destruct (Z.eq_dec (around a p q) 0) as [Z | Z]; [right; right | left; now apply around_inside].
        unfold around in Z. rewrite (crossing_back a q) in Z. simpl. lia. }
    destruct F as [F | F]; [now exists [], p, q, (r :: l)|].
    destruct (IH q r F) as (before & b & c & after & E & I). exists (p :: before), b, c, after.
    split; [now rewrite E | trivial].
Qed.

(** ** Clipping *)
Lemma Rabs_between x e : Rabs x <= e -> - e <= x <= e.
Proof. unfold Rabs. destruct Rcase_abs; lra. Qed.

(** A corner of the patch: its partner in the plane of the triangle, and the computed corner in space, by
    its coordinates. The plane is put into space by an affine map that takes the origin to Q. *)
Record corner := Corner { partner : point; computed : nat -> R }.
Section Patch.
Variables (Q A B : nat -> R) (E : R).
Definition space (i : nat) (p : point) : R := Q i + A i * fst p + B i * snd p.
(** Lemma 15: each computed corner is within E of its partner, along each axis. *)
Definition near (c : corner) : Prop := forall i, Rabs (space i (partner c) - computed c i) <= E.
(** A plane across axis i; s says on which side it cuts. Q is a pixel inside, the corner beyond or on it. *)
Definition beyond (i : nat) (s bound : R) (c : corner) : Prop :=
  (s = 1 \/ s = -1) /\ bound + 1 <= s * Q i /\ s * computed c i <= bound.

(** What a plane does to the polygon: where an edge meets it there is a new corner; then a path of
    corners beyond the plane, or on it, is replaced by the segment between its ends. A polygon may begin at
    any corner. *)
Inductive cut : list corner -> list corner -> Prop :=
| turned a l : cut (a :: l) (l ++ [a])
| split a b m l : between (partner a) (partner b) (partner m) -> near m ->
    cut (a :: b :: l) (a :: m :: b :: l)
| replaced i s bound a path b l : Forall (beyond i s bound) (a :: path ++ [b]) ->
    cut (a :: path ++ b :: l) (a :: b :: l).
Inductive clipped (first : list corner) : list corner -> Prop :=
| uncut : clipped first first
| more p q : clipped first p -> cut p q -> clipped first q.

Context (small : E < 1).
Lemma beyond_ahead i s bound : exists n, forall c, near c -> beyond i s bound c -> ahead n (partner c).
Proof.
  exists (- s * A i, - s * B i). intros c N ([-> | ->] & I & O); specialize (N i); apply Rabs_between in N;
    unfold ahead, space in *; simpl; lra.
Qed.

Lemma cut_near p q : cut p q -> Forall near p -> Forall near q.
Proof.
  intros [a l | a b m l _ N | i s bound a path b l _]; rewrite !Forall_forall; intros H c C; simpl in C.
  - apply H. rewrite in_app_iff in C. simpl in *. tauto.
  - destruct C as [<- | [<- | C]]; trivial; apply H; simpl; tauto.
  - apply H. simpl. rewrite in_app_iff. simpl. tauto.
Qed.
Lemma cut_holds p q : cut p q -> Forall near p -> holds (map partner p) -> holds (map partner q).
Proof.
  intros [a l | a b m l S _ | i s bound a path b l O] N H.
  - destruct l as [|b l]; [trivial|]. simpl in *. rewrite map_app. simpl.
    rewrite touched_app, turns_app. simpl. destruct H as [[H | H] | H]; [tauto | tauto | right; lia].
  - simpl in *. destruct H as [[H | H] | H].
    + apply (on_split _ _ _ S) in H. tauto.
    + tauto.
    + right. rewrite (crossing_split _ _ _ S) in H. lia.
  - destruct (beyond_ahead i s bound) as [n G].
    assert (F : Forall (ahead n) (partner a :: map partner path ++ [partner b])).
    { rewrite Forall_forall in *. intros c C.
      assert (C' : In c (map partner (a :: path ++ [b]))) by (simpl; rewrite map_app; exact C).
      apply in_map_iff in C' as (x & <- & X). apply G; [|now apply O]. apply N. simpl in *.
      rewrite in_app_iff in *. simpl in *. tauto. }
    inversion_clear F as [|? ? Fa F']. apply Forall_app in F' as [Fp Fb]. inversion_clear Fb.
    simpl in *. rewrite map_app in H. simpl in H. rewrite touched_app, turns_app in H.
    rewrite (turns_ahead n), <- (crossing_ahead n) in H by trivial.
    destruct H as [[H | H] | H]; [exfalso; revert H; now apply (not_touched_ahead n) | tauto | tauto].
Qed.

(** The lemma: a triangle of the fan has a point within E of Q along each axis. *)
Theorem the_fan_keeps_Q a b c p q r l : Forall near [a; b; c] -> inside (partner a) (partner b) (partner c) ->
  clipped [a; b; c] (p :: q :: r :: l) ->
  exists before s t after u v w, q :: r :: l = before ++ s :: t :: after /\
    0 <= u /\ 0 <= v /\ 0 <= w /\ u + v + w = 1 /\
    forall i, Rabs (Q i - (u * computed p i + v * computed s i + w * computed t i)) <= E.
Proof.
  intros N I C.
  assert (H : Forall near (p :: q :: r :: l) /\ holds (map partner (p :: q :: r :: l))).
  { remember (p :: q :: r :: l) as polygon. clear p q r l Heqpolygon.
    induction C as [|x y C [IH IH'] K]; [split; [trivial | now apply inside_holds]|].
    split; [now apply (cut_near x) | now apply (cut_holds x)]. }
  destruct H as [N' H]. apply holds_fan in H as (before & s' & t' & after & F & (u & v & w & U & V & W & S & X & Y)).
  change (map partner (q :: r :: l) = before ++ s' :: t' :: after) in F.
  apply map_eq_app in F as (before' & tail & F & <- & F'). destruct tail as [|s tail]; [discriminate|].
  destruct tail as [|t after']; [discriminate|]. injection F' as <- <- _.
  exists before', s, t, after', u, v, w. repeat (apply conj; [trivial|]). intros i.
  assert (M : near p /\ near s /\ near t).
  { rewrite Forall_forall in N'. rewrite F in N'. repeat split; apply N'; simpl; rewrite ?in_app_iff; simpl; tauto. }
  destruct M as (P & P' & P''). specialize (P i). specialize (P' i). specialize (P'' i). unfold space in *.
  apply Rabs_le. apply Rabs_between in P, P', P''.
  assert (Z : Q i = u * (Q i + A i * fst (partner p) + B i * snd (partner p)) +
    v * (Q i + A i * fst (partner s) + B i * snd (partner s)) +
    w * (Q i + A i * fst (partner t) + B i * snd (partner t))).
  { transitivity ((u + v + w) * Q i + A i * (u * fst (partner p) + v * fst (partner s) + w * fst (partner t)) +
      B i * (u * snd (partner p) + v * snd (partner s) + w * snd (partner t))); [rewrite S, X, Y|]; ring. }
  rewrite Z. split; nra.
Qed.

(** A polygon with Q is not cut away as a whole. *)
Theorem some_corner_is_left i s bound polygon : Forall near polygon -> holds (map partner polygon) ->
  ~ Forall (beyond i s bound) polygon.
Proof.
  destruct polygon as [|a l]; intros N H O; [exact H|]. destruct (beyond_ahead i s bound) as [n G].
  assert (F : Forall (ahead n) (map partner (a :: l))).
  { rewrite Forall_forall in *. intros c C. apply in_map_iff in C as (x & <- & X). apply G; auto. }
  inversion_clear F. simpl in H. rewrite (turns_ahead n) in H by trivial. destruct H as [H | H]; [|lia].
  revert H. now apply (not_touched_ahead n).
Qed.
End Patch.

Check the_fan_keeps_Q.
Check some_corner_is_left.
Print Assumptions the_fan_keeps_Q.
Print Assumptions some_corner_is_left.
