(** The checker of distances: it decides whether the squares that are given are those of the nearest
    triangles of each two objects, and whether all that are so near are given. Distances.v proves it. *)
From Coq Require Import ZArith NArith QArith List Bool.
Require Import Spec Checker.
Import ListNotations.
Open Scope Z_scope.

(** A square is n / m, where m is positive, in units of the scaled coordinates. *)
Definition numerator (f : Z) (q : Q) : Z := Qnum q * Z.of_N (N.shiftl 1 (Z.to_N (-2 * f))).
Definition denominator (q : Q) : Z := Zpos (Qden q).

(** No two points have a distance whose square is less than n / m. *)
Definition keeps_off (n m : Z) (a b : triangle Z) (d : vec Z) : bool :=
  let gap := gap_along a b d in (0 <? gap) && (n * dot d d <=? m * (gap * gap)).
Definition is_at_least (n m : Z) (a b : triangle Z) : bool :=
  (n <=? 0) || existsb (fun d => keeps_off n m a b (vector a b d)) directions.
(** Two points have one whose square is at most n / m. *)
Definition is_at_most (n m : Z) (a b : triangle Z) : bool :=
  has_near (are_within n m) a b || ((0 <=? n) && has_common (fun _ _ => true) a b).

(** * What is given for two objects *)
Definition is_for (o o' : Z) (e : entry) : bool :=
  (object_a (nearest e) =? o) && (object_b (nearest e) =? o').
Definition measures (f : Z) (l : list item) (e : entry) : bool :=
  let r := nearest e in let n := numerator f (squared e) in let m := denominator (squared e) in
  existsb (fun a => (obj a =? object_a r) && (num a =? triangle_a r) &&
    existsb (fun b => (obj b =? object_b r) && (num b =? triangle_b r) && comes_before a b &&
      match shared_of a b with [] => true | _ => false end &&
      is_at_least n m (shape a) (shape b) && is_at_most n m (shape a) (shape b)) l) l.

(** A whole number whose square is more than n / m. *)
Definition root_above (n m : Z) : Z := Z.sqrt (Z.max 0 n / m) + 1.
Definition reach_for (f : Z) (es : list entry) (within : Z) (a : item) : Z :=
  fold_left (fun r e =>
    if object_a (nearest e) =? obj a
    then Z.max r (root_above (numerator f (squared e)) (denominator (squared e))) else r) es within.

(** A pair of triangles with a distance is as far apart as its objects, or it is too far apart. *)
Definition is_far (f : Z) (es : list entry) (within : option Z) (p : item * item) : bool :=
  let (a, b) := p in
  match shared_of a b with
  | _ :: _ => true
  | [] =>
      match List.find (is_for (obj a) (obj b)) es with
      | Some e => is_at_least (numerator f (squared e)) (denominator (squared e)) (shape a) (shape b)
      | None => match within with Some d => separated d (shape a) (shape b) | None => false end
      end
  end.

(** Without a limit: each two objects are given that have two triangles with a distance. *)
Fixpoint first_items (l seen : list item) : list item :=
  match l with
  | [] => seen
  | a :: rest =>
      first_items rest
        (if existsb (fun b => (obj b =? obj a)) (firstn 1 seen) then seen else a :: seen)
  end.
Definition is_given (es : list entry) (a b : item) : bool :=
  existsb (is_for (obj a) (obj b)) es.
Definition all_given (es : list entry) (l : list item) : bool :=
  let firsts := first_items l [] in
  forallb (fun a => forallb (fun b => negb (obj a <? obj b) || is_given es a b) firsts) firsts &&
  forallb (fun a => negb (own a) || is_given es a a ||
    forallb (fun b => negb (comes_before a b && (obj a =? obj b)) ||
                      match shared_of a b with [] => false | _ => true end) l) l.

(** Two entries for the same objects: then find would see the first alone. *)
Fixpoint once (es : list entry) : bool :=
  match es with
  | [] => true
  | e :: rest =>
      negb (existsb (is_for (object_a (nearest e)) (object_b (nearest e))) rest) && once rest
  end.
Definition is_close (f : Z) (within : option Z) (e : entry) : bool :=
  match within with
  | None => true
  | Some d => numerator f (squared e) <=? denominator (squared e) * (d * d)
  end.

Inductive distance_verdict :=
| Distances_proved
| Bad_limit
| Bad_entries  (* two are for the same objects, or one is too far apart *)
| Bad_entry (e : entry)
| Bad_pair (r : row)
| Missing_objects.
Definition check_distances (l : list named) (within : option double) (es : list entry)
  : distance_verdict :=
  let f := lowest l (lower_place 0 within) in
  let items := items_of f l in
  let d := match within with Some w => Some (scaled f w) | None => None end in
  let least := match d with Some d => d | None => 0 end in
  if least <? 0 then Bad_limit
  else if negb (once es && forallb (is_close f d) es) then Bad_entries
  else match List.find (fun e => negb (measures f items e)) es with
  | Some e => Bad_entry e
  | None =>
      match List.find (fun p => negb (is_far f es d p))
                 (pairs (fun _ _ => true) (reach_for f es least) items) with
      | Some (a, b) => Bad_pair (name_of a b)
      | None =>
          if match d with Some _ => true | None => all_given es items end
          then Distances_proved else Missing_objects
      end
  end.
