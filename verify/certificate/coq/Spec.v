(** What the checker of certificates proves: the question alone, without a way to answer it.
    docs/verified.md explains each definition to readers who do not know Coq. *)
From Coq Require Import ZArith QArith List Bool.
Import ListNotations.
Open Scope Q_scope.
(** Numbers. A finite double is [mantissa] times 2 to the power [exponent], exactly. *)
Record double := Double { mantissa : Z; exponent : Z }.
Definition value (d : double) : Q := inject_Z (mantissa d) * 2 ^ exponent d.
(** Points and triangles; a coordinate is of type C: a double, a rational or an integer. *)
Record vec (C : Type) := Vec { x : C; y : C; z : C }.
Record triangle (C : Type) := Triangle { p1 : vec C; p2 : vec C; p3 : vec C }.
Arguments Vec {C}. Arguments x {C}. Arguments y {C}. Arguments z {C}.
Arguments Triangle {C}. Arguments p1 {C}. Arguments p2 {C}. Arguments p3 {C}.
Definition map_vec {C D} (f : C -> D) (p : vec C) : vec D := Vec (f (x p)) (f (y p)) (f (z p)).
Definition map_triangle {C D} (f : C -> D) (t : triangle C) : triangle D :=
  Triangle (map_vec f (p1 t)) (map_vec f (p2 t)) (map_vec f (p3 t)).
Notation exact := (map_triangle value).
(** Two names of one point: == is equality of rational numbers, so 1/2 == 2/4. *)
Definition same (p q : vec Q) : Prop := x p == x q /\ y p == y q /\ z p == z q.
Definition plus (p q : vec Q) : vec Q := Vec (x p + x q) (y p + y q) (z p + z q).
Definition times (k : Q) (p : vec Q) : vec Q := Vec (k * x p) (k * y p) (k * z p).
(** The points of a closed triangle, the convex combinations of its corners, which may lie on one
    line or be one point; of a closed segment; of the segments between common corners. *)
Definition mix (u v w : Q) (t : triangle Q) : vec Q :=
  plus (plus (times u (p1 t)) (times v (p2 t))) (times w (p3 t)).
Definition inside (t : triangle Q) (p : vec Q) : Prop :=
  exists u v w, 0 <= u /\ 0 <= v /\ 0 <= w /\ u + v + w == 1 /\ same p (mix u v w t).
Definition on_segment (c d p : vec Q) : Prop :=
  exists t, 0 <= t /\ t <= 1 /\ same p (plus (times (1 - t) c) (times t d)).
Definition is_corner (t : triangle Q) (c : vec Q) : Prop :=
  same c (p1 t) \/ same c (p2 t) \/ same c (p3 t).
Definition is_shared (a b : triangle Q) (c : vec Q) : Prop := is_corner a c /\ is_corner b c.
Definition in_shared_part (a b : triangle Q) (p : vec Q) : Prop :=
  exists c d, is_shared a b c /\ is_shared a b d /\ on_segment c d p.
(** Two triangles meet if they have a common point, in one object one that is not in their shared
    part. With a clearance those count as well that are so near, but neighbours have to meet. *)
Definition meet (one_object : Prop) (a b : triangle Q) : Prop :=
  exists p, inside a p /\ inside b p /\ (one_object -> ~ in_shared_part a b p).
Definition squared_distance (p q : vec Q) : Q :=
  (x p - x q) * (x p - x q) + (y p - y q) * (y p - y q) + (z p - z q) * (z p - z q).
Definition near (clearance : Q) (a b : triangle Q) : Prop :=
  exists p q, inside a p /\ inside b q /\ squared_distance p q <= clearance * clearance.
Definition count (clearance : Q) (one_object : Prop) (a b : triangle Q) : Prop :=
  meet one_object a b \/ (near clearance a b /\ ~ (one_object /\ exists c, is_shared a b c)).
(** A scene is a list of objects, lists of triangles; [self]: two triangles of the object are asked
    for as well. Triangle i of object o, both counted from 0. The pairs asked for, in one order. *)
Record object := Object { self : bool; triangles : list (triangle double) }.
Definition scene := list object.
Definition is_triangle (s : scene) (o i : nat) (t : triangle double) : Prop :=
  exists ob, nth_error s o = Some ob /\ nth_error (triangles ob) i = Some t.
Definition asked (s : scene) (o i o' i' : nat) : Prop := (o < o')%nat \/
  (o = o' /\ (i < i')%nat /\ exists ob, nth_error s o = Some ob /\ self ob = true).
Definition answer (s : scene) (clearance : double) (o i o' i' : nat) : Prop :=
  asked s o i o' i' /\ exists t t', is_triangle s o i t /\ is_triangle s o' i' t' /\
                                    count (value clearance) (o = o') (exact t) (exact t').
(** A row of a list of pairs, and lists that are right and complete. The last column says whether
    the two triangles are of one object and have a common corner. *)
Record row := Row { object_a : Z; triangle_a : Z; object_b : Z; triangle_b : Z; neighbours : bool }.
Definition names (r : row) (o i o' i' : nat) : Prop := object_a r = Z.of_nat o /\
  triangle_a r = Z.of_nat i /\ object_b r = Z.of_nat o' /\ triangle_b r = Z.of_nat i'.
Definition are_neighbours (s : scene) (o i o' i' : nat) : Prop := o = o' /\ exists t t' c,
  is_triangle s o i t /\ is_triangle s o' i' t' /\ is_shared (exact t) (exact t') c.
Definition lists (right : nat -> nat -> nat -> nat -> Prop) (s : scene) (l : list row) : Prop :=
  forall o i o' i', (right o i o' i' <-> exists r, In r l /\ names r o i o' i') /\
    forall r, In r l -> names r o i o' i' -> (neighbours r = true <-> are_neighbours s o i o' i').
Definition right_and_complete (s : scene) (clearance : double) := lists (answer s clearance) s.
(** A tile is the part of space between two places on an axis; None: no end. A pair belongs to the
    tile before whose end both triangles have a corner, and before whose beginning not both have. *)
Inductive axis := Along_x | Along_y | Along_z.
Definition coordinate {C} (k : axis) (p : vec C) : C :=
  match k with Along_x => x p | Along_y => y p | Along_z => z p end.
Record tile := Tile { tile_axis : axis; tile_begin : option double; tile_end : option double }.
Definition before (k : axis) (place : double) (t : triangle double) : Prop :=
  exists p, (p = p1 t \/ p = p2 t \/ p = p3 t) /\ value (coordinate k p) < value place.
Definition belongs (b : tile) (t t' : triangle double) : Prop :=
  (forall e, tile_end b = Some e -> before (tile_axis b) e t /\ before (tile_axis b) e t') /\
  (forall e, tile_begin b = Some e -> ~ (before (tile_axis b) e t /\ before (tile_axis b) e t')).
Definition in_tile (b : tile) (s : scene) (o i o' i' : nat) : Prop :=
  exists t t', is_triangle s o i t /\ is_triangle s o' i' t' /\ belongs b t t'.
Definition right_and_complete_in (b : tile) (s : scene) (clearance : double) : list row -> Prop :=
  lists (fun o i o' i' => answer s clearance o i o' i' /\ in_tile b s o i o' i') s.
(** Distances. All pairs that are asked for have one, but neighbours. *)
Definition measured (s : scene) (o i o' i' : nat) (t t' : triangle double) := asked s o i o' i' /\
  ~ are_neighbours s o i o' i' /\ is_triangle s o i t /\ is_triangle s o' i' t'.
(** Asked for are each two objects, those of which one is among the k nearest of the other, or all
    triangles. Of two objects p and o' that are as far from o the first one counts as nearer. *)
Inductive question := Of_objects | Of_nearest (k : Z) | Of_all.
Definition point_of (s : scene) (o : nat) (c : vec Q) : Prop :=
  exists i t, is_triangle s o i t /\ inside (exact t) c.
Definition less (q r : Q) (tie : Prop) : Prop := q < r \/ (q == r /\ tie).
Definition nearer (s : scene) (o p o' : nat) : Prop := p <> o /\ exists c d,
  point_of s o c /\ point_of s p d /\ forall c' e, point_of s o c' -> point_of s o' e ->
    less (squared_distance c d) (squared_distance c' e) (p < o')%nat.
Definition among (k : Z) (s : scene) (o o' : nat) : Prop :=
  forall l, NoDup l -> (forall p, In p l -> nearer s o p o') -> (Z.of_nat (length l) < k)%Z.
(** One object inside another. How often a mesh passes from a to b. A ray from p along d misses a
    triangle (0), or crosses it, on no edge, from behind (1) or from the front (-1). *)
Definition mesh (s : scene) (o : nat) : list (triangle Q) :=
  match nth_error s o with Some ob => map exact (triangles ob) | None => [] end.
Definition is (p q : vec Q) : bool := Qeq_bool (squared_distance p q) 0.
Definition passes (m : list (triangle Q)) (a b : vec Q) : nat :=
  length (filter (fun e => is (fst e) a && is (snd e) b)
                 (flat_map (fun t => [(p1 t, p2 t); (p2 t, p3 t); (p3 t, p1 t)]) m)).
Definition closed (m : list (triangle Q)) : Prop :=
  forall a b, is a b = false -> Nat.Even (passes m a b + passes m b a).
Definition oriented (m : list (triangle Q)) : Prop := forall a b, passes m a b = passes m b a.
Definition volume (a b c : vec Q) : Q :=
  x a * (y b * z c - z b * y c) + y a * (z b * x c - x b * z c) + z a * (x b * y c - y b * x c).
Inductive crossing (p d : vec Q) (t : triangle Q) : Z -> Prop :=
| Misses : (forall r, 0 <= r -> ~ inside t (plus p (times r d))) -> crossing p d t 0
| Crosses r u v w k : 0 < r -> 0 < u -> 0 < v -> 0 < w -> u + v + w == 1 -> k = 1%Z \/ k = (-1)%Z ->
    same (plus p (times r d)) (mix u v w t) ->
    0 < inject_Z k * (volume d (p1 t) (p2 t) + volume d (p2 t) (p3 t) + volume d (p3 t) (p1 t)) ->
    crossing p d t k.
(** By the sum of its crossings a ray tells whether p is inside a closed mesh. If it meets nothing,
    p is not inside any mesh. An object is inside with all of its corners. *)
Definition ray (m : list (triangle Q)) (p : vec Q) (ks : list Z) : Prop :=
  exists d, ~ same (plus p d) p /\ Forall2 (crossing p d) m ks.
Definition tells (m : list (triangle Q)) (ks : list Z) : Prop :=
  let k := fold_right Z.add 0%Z ks in Z.Odd k \/ (oriented m /\ k <> 0%Z).
Definition is_in (s : scene) (o o' : nat) : Prop := let m := mesh s o' in
  closed m /\ forall t p, In t (mesh s o) -> is_corner t p -> exists ks, ray m p ks /\ tells m ks.
Definition not_in (s : scene) (o o' : nat) : Prop := let m := mesh s o' in exists t p ks,
  In t (mesh s o) /\ is_corner t p /\ ray m p ks /\ (Forall (eq 0%Z) ks \/ closed m /\ ~tells m ks).
Inductive word := Unsaid | Neither | Not_closed | First_in | Second_in.
Definition right_word (s : scene) (w : word) (o o' : nat) : Prop :=
  let open o := ~ closed (mesh s o) in match w with
  | Unsaid => True | First_in => is_in s o o' | Second_in => is_in s o' o
  | Neither => not_in s o o' /\ not_in s o' o
  | Not_closed => (open o \/ open o') /\ (not_in s o o' \/ open o') /\ (not_in s o' o \/ open o)
  end.
(** An answer: two triangles, the square of their distance, what is inside. No pair of their objects
    is nearer, or as near and before it, unless all are asked for. [within] None: no limit. *)
Record entry := Entry { nearest : row; squared : Q; says : word }.
Definition wanted (s : scene) (q : question) (o o' : nat) : Prop := forall k,
  q = Of_nearest k -> o <> o' /\ (among k s o o' \/ among k s o' o).
Definition right_entry (s : scene) (q : question) (e : entry) (o i o' i' : nat) : Prop :=
  names (nearest e) o i o' i' /\ wanted s q o o' /\ right_word s (says e) o o' /\
  (exists t t' p r, measured s o i o' i' t t' /\ inside (exact t) p /\ inside (exact t') r /\
                    squared_distance p r == squared e) /\
  forall j j' t t' p r, measured s o j o' j' t t' -> q <> Of_all \/ (j = i /\ j' = i') ->
    inside (exact t) p -> inside (exact t') r ->
    less (squared e) (squared_distance p r) (~ (j < i \/ j = i /\ j' < i')%nat).
Definition right_distances (s : scene) (q : question) (within : option double) (l : list entry) :=
  (forall e, In e l -> exists o i o' i', right_entry s q e o i o' i' /\
     forall d, within = Some d -> squared e <= value d * value d) /\
  (forall o i o' i' t t', measured s o i o' i' t t' -> wanted s q o o' ->
     (forall d, within = Some d -> near (value d) (exact t) (exact t')) ->
     exists e j j', In e l /\ names (nearest e) o j o' j' /\ (q = Of_all -> j = i /\ j' = i')).
