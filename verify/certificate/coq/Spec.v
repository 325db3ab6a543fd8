(** The definitions of the question that the checker of certificates answers. Nothing here computes
    the answer. docs/verified.md explains the definitions. *)
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
(** Equality of points. == is equality of rational numbers, so 1/2 == 2/4. *)
Definition same (p q : vec Q) : Prop := x p == x q /\ y p == y q /\ z p == z q.
Definition plus (p q : vec Q) : vec Q := Vec (x p + x q) (y p + y q) (z p + z q).
Definition times (k : Q) (p : vec Q) : vec Q := Vec (k * x p) (k * y p) (k * z p).
(** The points of a closed triangle: convex combinations of its corners, which may be collinear or
    equal. Then the points of a closed segment, and of the segments between common corners. *)
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
(** Two triangles of different objects meet if they have a common point. Two triangles of one object
    meet if they have a common point that is not in their shared part. With a clearance, triangles
    at this distance or less count as well; neighbours count only if they meet. *)
Definition meet (one_object : Prop) (a b : triangle Q) : Prop :=
  exists p, inside a p /\ inside b p /\ (one_object -> ~ in_shared_part a b p).
Definition squared_distance (p q : vec Q) : Q :=
  (x p - x q) * (x p - x q) + (y p - y q) * (y p - y q) + (z p - z q) * (z p - z q).
Definition near (clearance : Q) (a b : triangle Q) : Prop :=
  exists p q, inside a p /\ inside b q /\ squared_distance p q <= clearance * clearance.
Definition count (clearance : Q) (one_object : Prop) (a b : triangle Q) : Prop :=
  meet one_object a b \/ (near clearance a b /\ ~ (one_object /\ exists c, is_shared a b c)).
(** A scene is a list of objects, and an object a list of triangles. [self]: pairs of triangles of
    this object are asked for, too. Indices of objects and triangles begin at 0. *)
Record object := Object { self : bool; triangles : list (triangle double) }.
Definition scene := list object.
Definition is_triangle (s : scene) (o i : nat) (t : triangle double) : Prop :=
  exists ob, nth_error s o = Some ob /\ nth_error (triangles ob) i = Some t.
Definition asked (s : scene) (o i o' i' : nat) : Prop := (o < o')%nat \/
  (o = o' /\ (i < i')%nat /\ exists ob, nth_error s o = Some ob /\ self ob = true).
Definition answer (s : scene) (clearance : double) (o i o' i' : nat) : Prop :=
  asked s o i o' i' /\ exists t t', is_triangle s o i t /\ is_triangle s o' i' t' /\
                                    count (value clearance) (o = o') (exact t) (exact t').
(** A row of a list of pairs. [neighbours]: the two triangles are of one object and have a common
    corner. A list is right and complete if no row occurs twice ([NoDup]), each row names a pair
    that is right, and each pair that is right has a row. *)
Record row := Row { object_a : Z; triangle_a : Z; object_b : Z; triangle_b : Z; neighbours : bool }.
Definition names (r : row) (o i o' i' : nat) : Prop := object_a r = Z.of_nat o /\
  triangle_a r = Z.of_nat i /\ object_b r = Z.of_nat o' /\ triangle_b r = Z.of_nat i'.
Definition are_neighbours (s : scene) (o i o' i' : nat) : Prop := o = o' /\ exists t t' c,
  is_triangle s o i t /\ is_triangle s o' i' t' /\ is_shared (exact t) (exact t') c.
Definition lists (right : nat -> nat -> nat -> nat -> Prop) (s : scene) (l : list row) : Prop :=
  NoDup l /\ (forall r, In r l -> exists o i o' i', names r o i o' i' /\ right o i o' i' /\
                                  (neighbours r = true <-> are_neighbours s o i o' i')) /\
  (forall o i o' i', right o i o' i' -> exists r, In r l /\ names r o i o' i').
Definition right_and_complete (s : scene) (clearance : double) := lists (answer s clearance) s.
(** A tile is the part of space between two places on an axis; None: the tile is unbounded on that
    side. A pair belongs to a tile if both triangles have a corner before its end, and if not both
    of them have a corner before its beginning. *)
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
