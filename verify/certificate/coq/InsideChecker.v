(** The checker of what is inside: it casts rays from corners of one object and adds up how they cross
    the triangles of another. Inside.v proves it. *)
From Coq Require Import ZArith List Bool.
Require Import Spec Checker.
Import ListNotations.
Open Scope Z_scope.

(** * A ray from p along d and a triangle *)
(** The triangle is on one side of a plane through p, and the ray is not: corners relative to p. *)
Definition parts (a b c d n : vec Z) : bool :=
  (0 <? dot n a) && (0 <? dot n b) && (0 <? dot n c) && (dot n d <=? 0).
Definition planes (t : triangle Z) (a b c d : vec Z) : list (vec Z) :=
  opposed (normal t :: map (fun i => cross d (edge t i)) indices) ++
  [away a d; away b d; away c d; away a (edge t I1); away b (edge t I2); away c (edge t I3); a; b; c].
(** None: the ray meets an edge, or begins in the triangle. *)
Definition crossing_of (p d : vec Z) (t : triangle Z) : option Z :=
  let a := sub (p1 t) p in let b := sub (p2 t) p in let c := sub (p3 t) p in
  let ab := dot d (cross a b) in let bc := dot d (cross b c) in let ca := dot d (cross c a) in
  let v := dot a (cross b c) in
  if (0 <? ab) && (0 <? bc) && (0 <? ca) && (0 <? v) then Some 1
  else if (ab <? 0) && (bc <? 0) && (ca <? 0) && (v <? 0) then Some (-1)
  else if existsb (parts a b c d) (planes t a b c d) then Some 0 else None.

(** * A ray and all triangles of a tree: boxes beside the ray are passed over *)
Definition axes : list (vec Z) := [Vec 1 0 0; Vec 0 1 0; Vec 0 0 1].
Definition lowest_along (n l h : vec Z) : Z :=
  Z.min (x n * x l) (x n * x h) + Z.min (y n * y l) (y n * y h) + Z.min (z n * z l) (z n * z h).
Definition beside (p d : vec Z) (b : bounds) : bool :=
  let l := sub (low b) p in let h := sub (high b) p in
  existsb (fun n => (dot n d <=? 0) && (0 <? lowest_along n l h))
          (opposed (axes ++ map (cross d) axes)).
Definition plus_both (k k' : option Z) : option Z :=
  match k, k' with Some i, Some j => Some (i + j) | _, _ => None end.
Fixpoint wind (p d : vec Z) (t : tree) : option Z :=
  if beside p d (around t) then Some 0 else
  match t with
  | Leaf _ held => fold_right (fun a k => plus_both (crossing_of p d (shape a)) k) (Some 0) held
  | Node _ one other => plus_both (wind p d one) (wind p d other)
  end.

(** * Edges: a tree brings those together that are one edge *)
Definition edge_item (a b : vec Z) : item :=
  let m := add a b in Item 0 0 false (Triangle a b b) m m m.
Definition edge_items (l : list item) : list item :=
  fold_left (fun done n => let t := shape n in
    edge_item (p1 t) (p2 t) :: edge_item (p2 t) (p3 t) :: edge_item (p3 t) (p1 t) :: done) l [].
Definition times_passed (a b : vec Z) (l : list item) : nat :=
  length (filter (fun e => equal (p1 (shape e)) a && equal (p2 (shape e)) b) l).
Definition is_even (l : list item) (e : item) : bool :=
  let a := p1 (shape e) in let b := p2 (shape e) in
  equal a b || Nat.even (times_passed a b l + times_passed b a l).
Definition is_balanced (l : list item) (e : item) : bool :=
  let a := p1 (shape e) in let b := p2 (shape e) in
  Nat.eqb (times_passed a b l) (times_passed b a l).
(** An edge that is not good, by the edges of its leaf alone. *)
Fixpoint bad_edge (good : list item -> item -> bool) (t : tree) : option item :=
  match t with
  | Leaf _ held => List.find (fun e => negb (good held e)) held
  | Node _ one other =>
      match bad_edge good one with Some e => Some e | None => bad_edge good other end
  end.
(** Whether all edges are good; None: an edge is good, and is not by those of its leaf. *)
Definition all_good (good : list item -> item -> bool) (t : tree) (l : list item) : option bool :=
  match bad_edge good t with
  | None => Some true
  | Some e => if good l e then None else Some false
  end.

(** * Two objects *)
Record surface := Surface {
  members : list item; held : tree; is_closed : option bool; is_oriented : option bool }.
Definition surface_of (o : Z) (l : list item) : surface :=
  let m := filter (fun a => obj a =? o) l in let es := edge_items m in let t := build 64 es in
  Surface m (build 64 m) (all_good is_even t es) (all_good is_balanced t es).

Definition tell (oriented : option bool) (k : Z) : option bool :=
  if Z.odd k then Some true
  else if k =? 0 then Some false
  else oriented.
(** Directions that meet an edge of few meshes: others are tried if one does. *)
Definition rays : list (vec Z) :=
  [Vec 1021 11 7; Vec (-13) 1019 5; Vec 17 (-23) 1013; Vec (-1009) 311 (-89); Vec 419 (-997) 263;
   Vec (-163) 557 (-991); Vec 7919 104729 1299709; Vec (-611953) 15485863 (-86028121)].
Definition tells_of (m : surface) (p : vec Z) (wanted : bool) : bool :=
  existsb (fun d => match wind p d (held m) with
                    | Some k => match tell (is_oriented m) k with Some b => Bool.eqb b wanted | None => false end
                    | None => false
                    end) rays.
Definition some_corner_of (f : vec Z -> bool) (a : item) : bool :=
  f (p1 (shape a)) || f (p2 (shape a)) || f (p3 (shape a)).
Definition all_inside (a b : surface) : bool :=
  match is_closed b with Some true => true | _ => false end &&
  forallb (fun i => negb (some_corner_of (fun p => negb (tells_of b p true)) i)) (members a).
Definition has_free_ray (a b : surface) : bool :=
  existsb (some_corner_of (fun p => existsb (fun d => beside p d (around (held b))) (opposed axes)))
          (members a).
(** Some true: not all of a is inside b; Some false: b is not closed, and a is in its box. *)
Definition not_inside (a b : surface) : option bool :=
  if has_free_ray a b then Some true
  else match is_closed b with
       | Some true => if existsb (some_corner_of (fun p => tells_of b p false)) (members a)
                      then Some true else None
       | Some false => Some false
       | None => None
       end.
Definition is_said_rightly (l : list item) (w : word) (o o' : Z) : bool :=
  match w with
  | Unsaid => true
  | _ =>
      let a := surface_of o l in let b := surface_of o' l in
      match w with
      | First_in => all_inside a b
      | Second_in => all_inside b a
      | Neither => match not_inside a b, not_inside b a with Some true, Some true => true | _, _ => false end
      | _ => match not_inside a b, not_inside b a with
             | Some i, Some j => negb (i && j)
             | _, _ => false
             end
      end
  end.
