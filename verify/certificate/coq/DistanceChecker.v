(** The checker of distances: it decides whether the squares that are given are those of the triangles,
    and of their objects, and whether all that is asked for is given. Distances.v and Nearest.v prove it. *)
From Coq Require Import ZArith NArith QArith List Bool.
Require Import Spec Checker InsideChecker.
Import ListNotations.
Open Scope Z_scope.

(** A square is n / m, where m is positive, in units of the scaled coordinates. *)
Definition numerator (f : Z) (q : Q) : Z := Qnum q * Z.of_N (N.shiftl 1 (Z.to_N (-2 * f))).
Definition denominator (q : Q) : Z := Zpos (Qden q).

(** No two points have a distance whose square is less than n / m; [strict]: or as much. *)
Definition keeps_off (strict : bool) (n m : Z) (a b : triangle Z) (d : vec Z) : bool :=
  let gap := gap_along a b d in let far := m * (gap * gap) in let limit := n * dot d d in
  (0 <? gap) && (if strict then limit <? far else limit <=? far).
Definition is_at_least (strict : bool) (n m : Z) (a b : triangle Z) : bool :=
  (negb strict && (n <=? 0)) || existsb (fun d => keeps_off strict n m a b (vector a b d)) directions.
(** Two points have one whose square is at most n / m. *)
Definition is_at_most (n m : Z) (a b : triangle Z) : bool :=
  has_near (are_within n m) a b || ((0 <=? n) && has_common (fun _ _ => true) a b).

(** * What is given for two objects *)
Definition is_for (o o' : Z) (e : entry) : bool :=
  (object_a (nearest e) =? o) && (object_b (nearest e) =? o').
Definition has_no_shared (a b : item) : bool := match shared_of a b with [] => true | _ => false end.
(** The square is that of two triangles that have a distance. *)
Definition measures (f : Z) (e : entry) (a b : item) : bool :=
  let r := nearest e in let n := numerator f (squared e) in let m := denominator (squared e) in
  (obj a =? object_a r) && (num a =? triangle_a r) &&
  (obj b =? object_b r) && (num b =? triangle_b r) && comes_before a b && has_no_shared a b &&
  is_at_least false n m (shape a) (shape b) && is_at_most n m (shape a) (shape b).
Definition is_measured (f : Z) (l : list item) (e : entry) : bool :=
  let r := nearest e in
  existsb (fun a => (obj a =? object_a r) && (num a =? triangle_a r) &&
                    existsb (measures f e a) l) l.

(** A whole number whose square is more than n / m. *)
Definition root_above (n m : Z) : Z := Z.sqrt (Z.max 0 n / m) + 1.
(** The largest root of the entries that f picks. *)
Definition reach_for (f : Z) (picks : entry -> bool) (es : list entry) (within : Z) : Z :=
  fold_left (fun r e => if picks e
    then Z.max r (root_above (numerator f (squared e)) (denominator (squared e))) else r) es within.
Definition reach_in (f : Z) (q : question) (es : list entry) (within : Z) : item -> Z :=
  match q with
  | Of_nearest _ => let r := reach_for f (fun _ => true) es within in fun _ => r
  | _ => fun a => reach_for f (fun e => object_a (nearest e) =? obj a) es within
  end.

(** * Nearest objects: how far the kth one that is given for an object is, and its number *)
Definition partner (o : Z) (e : entry) : list (Q * Z) :=
  let r := nearest e in
  if object_a r =? o then [(squared e, object_b r)]
  else if object_b r =? o then [(squared e, object_a r)] else [].
Definition partners (es : list entry) (o : Z) : list (Q * Z) := flat_map (partner o) es.
Definition up_to (u v : Q * Z) : bool :=
  match Qcompare (fst u) (fst v) with Lt => true | Eq => snd u <=? snd v | Gt => false end.
Definition rank (ps : list (Q * Z)) (v : Q * Z) : Z :=
  Z.of_nat (length (filter (fun u => up_to u v) ps)).
Definition ends := list (Z * option (Q * Z)).
Fixpoint distinct (l : list Z) : bool :=
  match l with [] => true | o :: rest => negb (existsb (Z.eqb o) rest) && distinct rest end.
(** For each object the partner of rank k; None: there are fewer. *)
Definition end_of (k : Z) (es : list entry) (o : Z) : option (Q * Z) :=
  let ps := partners es o in
  if distinct (map snd ps) then List.find (fun v => rank ps v =? k) ps else None.
Definition ends_of (q : question) (es : list entry) (l : list item) : ends :=
  match q with Of_nearest k => map (fun a => (obj a, end_of k es (obj a))) l | _ => [] end.
Definition end_at (t : ends) (o : Z) : option (Q * Z) :=
  match List.find (fun p => fst p =? o) t with Some p => snd p | None => None end.
(** The other object of the entry is not beyond the end for o, and among the k nearest. *)
Definition is_among (k : Z) (es : list entry) (t : ends) (o : Z) (e : entry) : bool :=
  match partner o e with
  | [v] => (rank (partners es o) v <=? k) &&
           match end_at t o with Some w => up_to v w | None => true end
  | _ => false
  end.
Definition is_wanted (q : question) (es : list entry) (t : ends) (e : entry) : bool :=
  match q with
  | Of_nearest k =>
      let a := object_a (nearest e) in let b := object_b (nearest e) in
      negb (a =? b) && (is_among k es t a e || is_among k es t b e)
  | _ => true
  end.

(** * The other pairs of triangles are far enough apart *)
Definition is_apart (within : option Z) (a b : item) : bool :=
  match within with Some d => separated d (shape a) (shape b) | None => false end.
(** [o] sees [other] beyond its end. *)
Definition is_beyond (f : Z) (t : ends) (within : option Z) (a b : item) (o other : Z) : bool :=
  match end_at t o with
  | Some (q, last) =>
      is_at_least (negb (last <? other)) (numerator f q) (denominator q) (shape a) (shape b)
  | None => is_apart within a b
  end.
Definition comes_first (a b : item) (r : row) : bool :=
  (num a <? triangle_a r) || ((num a =? triangle_a r) && (num b <? triangle_b r)).
Definition is_far (f : Z) (q : question) (es : list entry) (t : ends) (within : option Z)
  (p : item * item) : bool :=
  let (a, b) := p in
  negb (has_no_shared a b) ||
  match List.find (is_for (obj a) (obj b)) es with
  | Some e =>
      is_at_least (comes_first a b (nearest e)) (numerator f (squared e)) (denominator (squared e))
                  (shape a) (shape b)
  | None =>
      match q with
      | Of_nearest _ =>
          (obj a =? obj b) ||
          (is_beyond f t within a b (obj a) (obj b) && is_beyond f t within a b (obj b) (obj a))
      | _ => is_apart within a b
      end
  end.

(** Without a limit: each two objects are given that have two triangles with a distance, or both know
    an end of what is asked for. *)
Fixpoint first_items (l seen : list item) : list item :=
  match l with
  | [] => seen
  | a :: rest =>
      first_items rest
        (if existsb (fun b => (obj b =? obj a)) (firstn 1 seen) then seen else a :: seen)
  end.
Definition has_end (t : ends) (o : Z) : bool := match end_at t o with Some _ => true | None => false end.
Definition is_given (es : list entry) (t : ends) (a b : item) : bool :=
  existsb (is_for (obj a) (obj b)) es || (has_end t (obj a) && has_end t (obj b)).
Definition all_given (q : question) (es : list entry) (t : ends) (l firsts : list item) : bool :=
  forallb (fun a => forallb (fun b => negb (obj a <? obj b) || is_given es t a b) firsts) firsts &&
  match q with
  | Of_nearest _ => true
  | _ =>
      forallb (fun a => negb (own a) || existsb (is_for (obj a) (obj a)) es ||
        forallb (fun b => negb (comes_before a b && (obj a =? obj b)) || negb (has_no_shared a b)) l) l
  end.

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

(** * All triangles: the entries follow each other in the order of the pairs *)
Definition is_named (a b : item) (e : entry) : bool :=
  let r := nearest e in (obj a =? object_a r) && (num a =? triangle_a r) &&
                        (obj b =? object_b r) && (num b =? triangle_b r).
Fixpoint all_triangles (f d : Z) (l : list (item * item)) (es : list entry) : option row :=
  match l, es with
  | [], [] => None
  | [], e :: _ => Some (nearest e)
  | (a, b) :: l', [] =>
      if negb (has_no_shared a b) || separated d (shape a) (shape b) then all_triangles f d l' es
      else Some (name_of a b)
  | (a, b) :: l', e :: es' =>
      if is_named a b e
      then if measures f e a b then all_triangles f d l' es' else Some (name_of a b)
      else if negb (has_no_shared a b) || separated d (shape a) (shape b)
           then all_triangles f d l' es else Some (name_of a b)
  end.

Inductive distance_verdict :=
| Distances_proved
| Bad_limit
| Bad_entries  (* two are for the same objects, or one is too far apart *)
| Bad_entry (e : entry)
| Bad_word (e : entry)
| Bad_pair (r : row)
| Missing_objects.
(** Nothing is to be said of triangles, of one object, and of objects that meet. *)
Definition is_unsaid (w : word) : bool := match w with Unsaid => true | _ => false end.
Definition may_say (e : entry) : bool :=
  negb (object_a (nearest e) =? object_b (nearest e)) && (0 <? Qnum (squared e)).
Definition has_right_word (q : question) (l : list item) (e : entry) : bool :=
  is_unsaid (says e) ||
  (match q with Of_all => false | _ => true end && may_say e &&
   is_said_rightly l (says e) (object_a (nearest e)) (object_b (nearest e))).
Definition check_objects (f : Z) (q : question) (items : list item) (d : option Z)
  (es : list entry) : distance_verdict :=
  let least := match d with Some d => d | None => 0 end in
  let firsts := first_items items [] in
  let t := ends_of q es firsts in
  if negb (once es && forallb (is_wanted q es t) es) then Bad_entries
  else match List.find (fun e => negb (is_measured f items e)) es with
  | Some e => Bad_entry e
  | None =>
      match List.find (fun p => negb (is_far f q es t d p))
                 (pairs (fun _ _ => true) (reach_in f q es least) items) with
      | Some (a, b) => Bad_pair (name_of a b)
      | None =>
          if match d with Some _ => true | None => all_given q es t items firsts end
          then Distances_proved else Missing_objects
      end
  end.
Definition check_distances (l : list named) (q : question) (within : option double)
  (es : list entry) : distance_verdict :=
  let f := lowest l (lower_place 0 within) in
  let items := items_of f l in
  let d := match within with Some w => Some (scaled f w) | None => None end in
  if match d with Some d => d <? 0 | None => false end then Bad_limit
  else if negb (forallb (is_close f d) es) then Bad_entries
  else match List.find (fun e => negb (has_right_word q items e)) es with
  | Some e => Bad_word e
  | None =>
      match q, d with
      | Of_all, None => Bad_limit
      | Of_all, Some d =>
          match all_triangles f d (pairs (fun _ _ => true) (fun _ => d) items) es with
          | None => Distances_proved
          | Some r => Bad_pair r
          end
      | _, _ => check_objects f q items d es
      end
  end.
