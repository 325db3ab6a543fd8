(** The checker: a program over integers that decides every pair of triangles whose boxes overlap.
    Proofs.v proves that its answer is right and complete. The searches (for trees, directions and
    points) need no proof, since the few tests that are proved verify their results. *)
From Coq Require Import ZArith NArith List Bool Orders Mergesort.
Require Import Spec.
Import ListNotations.
Open Scope Z_scope.

(** * Integers: the coordinates of all triangles, scaled by one power of two *)
Definition lower (e : Z) (d : double) : Z := Z.min e (exponent d).
Definition lower_vec (e : Z) (p : vec double) : Z := lower (lower (lower e (x p)) (y p)) (z p).
Definition lower_triangle (e : Z) (t : triangle double) : Z :=
  lower_vec (lower_vec (lower_vec e (p1 t)) (p2 t)) (p3 t).
Definition lower_place (e : Z) (place : option double) : Z :=
  match place with Some d => lower e d | None => e end.
(** The double d divided by 2^e. This is an integer, since e is at most the exponent of d. *)
Definition scaled (e : Z) (d : double) : Z :=
  mantissa d * Z.of_N (N.shiftl 1 (Z.to_N (exponent d - e))).

(** * The triangles that a tile needs

    A tile needs each triangle with a corner before the tile's end and a corner that is at most
    [reach] before the tile's beginning, or after it. main.ml calls [keep] for each triangle of a
    scene, and so stores only these triangles. [gathered] is the final list. *)
Record named := Named { of_object : Z; number : Z; inner : bool; corners : triangle double }.
Definition is_below (d place : double) : bool :=
  let e := Z.min (exponent d) (exponent place) in scaled e d <? scaled e place.
Definition is_reached (reach place d : double) : bool :=
  let e := lower (lower (exponent d) reach) place in scaled e place <=? scaled e d + scaled e reach.
Definition some_corner (f : double -> bool) (k : axis) (t : triangle double) : bool :=
  f (coordinate k (p1 t)) || f (coordinate k (p2 t)) || f (coordinate k (p3 t)).
Definition is_needed (b : tile) (reach : double) (t : triangle double) : bool :=
  match tile_end b with
  | Some e => some_corner (fun d => is_below d e) (tile_axis b) t
  | None => true
  end &&
  match tile_begin b with
  | Some e => some_corner (is_reached reach e) (tile_axis b) t
  | None => true
  end.
Definition keep (b : tile) (reach : double) (o i : Z) (inner : bool) (t : triangle double)
  (done : list named) : list named :=
  if is_needed b reach t then Named o i inner t :: done else done.

(** The triangle that was kept last comes first. *)
Fixpoint keep_triangles (b : tile) (reach : double) (o i : Z) (inner : bool)
  (l : list (triangle double)) (done : list named) : list named :=
  match l with
  | [] => done
  | t :: rest => keep_triangles b reach o (i + 1) inner rest (keep b reach o i inner t done)
  end.
Fixpoint keep_objects (b : tile) (reach : double) (o : Z) (s : scene) (done : list named)
  : list named :=
  match s with
  | [] => done
  | ob :: rest =>
      keep_objects b reach (o + 1) rest
        (keep_triangles b reach o 0 (self ob) (triangles ob) done)
  end.
Definition gathered (b : tile) (reach : double) (s : scene) : list named :=
  keep_objects b reach 0 s [].
Definition everything : tile := Tile Along_x None None.

Definition lowest (l : list named) (e : Z) : Z :=
  fold_left (fun e n => lower_triangle e (corners n)) l e.

(** * Vectors *)
Definition sub (p q : vec Z) : vec Z := Vec (x p - x q) (y p - y q) (z p - z q).
Definition add (p q : vec Z) : vec Z := Vec (x p + x q) (y p + y q) (z p + z q).
Definition scale (k : Z) (p : vec Z) : vec Z := Vec (k * x p) (k * y p) (k * z p).
Definition dot (p q : vec Z) : Z := x p * x q + y p * y q + z p * z q.
Definition cross (p q : vec Z) : vec Z :=
  Vec (y p * z q - z p * y q) (z p * x q - x p * z q) (x p * y q - y p * x q).
Definition equal (p q : vec Z) : bool := (x p =? x q) && (y p =? y q) && (z p =? z q).
Definition origin : vec Z := Vec 0 0 0.

Inductive index := I1 | I2 | I3.
Definition indices : list index := [I1; I2; I3].
Definition next (i : index) : index := match i with I1 => I2 | I2 => I3 | I3 => I1 end.
Definition corner {C} (t : triangle C) (i : index) : vec C :=
  match i with I1 => p1 t | I2 => p2 t | I3 => p3 t end.
Definition edge (t : triangle Z) (i : index) : vec Z := sub (corner t (next i)) (corner t i).
Definition normal (t : triangle Z) : vec Z := cross (edge t I1) (edge t I2).

Definition min3 (a b c : Z) : Z := Z.min a (Z.min b c).
Definition max3 (a b c : Z) : Z := Z.max a (Z.max b c).

(** * A direction that separates *)
Inductive direction :=
| Normal_a | Normal_b
| Edge_edge (i j : index) | Foot_a (i j : index) | Foot_b (i j : index) | Between (i j : index).

Definition between (a b : triangle Z) (i j : index) : vec Z := sub (corner b j) (corner a i).
Definition away (w e : vec Z) : vec Z := sub (scale (dot e e) w) (scale (dot w e) e).
Definition vector (a b : triangle Z) (d : direction) : vec Z :=
  match d with
  | Normal_a => normal a
  | Normal_b => normal b
  | Edge_edge i j => cross (edge a i) (edge b j)
  | Foot_a i j => away (between a b i j) (edge a i)
  | Foot_b i j => away (between a b i j) (edge b j)
  | Between i j => between a b i j
  end.
Definition each (f : index -> index -> direction) : list direction :=
  flat_map (fun i => map (f i) indices) indices.
Definition directions : list direction :=
  each Between ++ Normal_a :: Normal_b :: each Edge_edge ++ each Foot_a ++ each Foot_b.

Definition gap_along (a b : triangle Z) (d : vec Z) : Z :=
  let a1 := dot d (p1 a) in let a2 := dot d (p2 a) in let a3 := dot d (p3 a) in
  let b1 := dot d (p1 b) in let b2 := dot d (p2 b) in let b3 := dot d (p3 b) in
  Z.max (min3 b1 b2 b3 - max3 a1 a2 a3) (min3 a1 a2 a3 - max3 b1 b2 b3).
(** True if the gap along d, divided by the length of d, is longer than the clearance. *)
Definition separates (clearance : Z) (a b : triangle Z) (d : vec Z) : bool :=
  let gap := gap_along a b d in
  (0 <? gap) && (clearance * clearance * dot d d <? gap * gap).
Definition separated (clearance : Z) (a b : triangle Z) : bool :=
  existsb (fun d => separates clearance a b (vector a b d)) directions.

(** * A common point

    Three weights, one per corner, give a point of a triangle. [weigh] is the sum of the weighted
    corners, [total] is the sum of the weights, and the point is [weigh] / [total]. *)
Definition total (w : vec Z) : Z := x w + y w + z w.
Definition weigh (w : vec Z) (t : triangle Z) : vec Z :=
  add (add (scale (x w) (p1 t)) (scale (y w) (p2 t))) (scale (z w) (p3 t)).
Definition are_weights (w : vec Z) : bool :=
  (0 <=? x w) && (0 <=? y w) && (0 <=? z w) && (0 <? total w).
Definition is_common (a b : triangle Z) (u v : vec Z) : bool :=
  are_weights u && are_weights v &&
  equal (scale (total v) (weigh u a)) (scale (total u) (weigh v b)).

(** True if the point p / m is not on the segment from c to d. *)
Definition off_segment (c d p : vec Z) (m : Z) : bool :=
  let e := sub d c in let r := sub p (scale m c) in
  negb (equal (cross e r) origin) || (dot e r <? 0) || (m * dot e e <? dot e r) ||
  (equal e origin && negb (equal r origin)).
Definition off_shared (shared : list (vec Z)) (p : vec Z) (m : Z) : bool :=
  forallb (fun c => forallb (fun d => off_segment c d p m) shared) shared.

(** Weight p for corner i, weight q for the next corner, weight 0 for the third corner. *)
Definition on_edge (i : index) (p q : Z) : vec Z :=
  match i with I1 => Vec p q 0 | I2 => Vec 0 p q | I3 => Vec q 0 p end.
(** Weights of the point at the fraction n / d of edge i. *)
Definition along (i : index) (n d : Z) : vec Z :=
  if d <? 0 then on_edge i (n - d) (- n) else on_edge i (d - n) n.

Inductive probe := Centre | Corner (i : index) | Crossing (i : index) | Meeting_edges (i j : index).
Definition probes : list probe :=
  map Crossing indices ++ map Corner indices ++
  flat_map (fun i => map (Meeting_edges i) indices) indices ++ [Centre].
Definition probe_weights (a b : triangle Z) (p : probe) : vec Z :=
  match p with
  | Centre => Vec 1 1 1
  | Corner i => on_edge i 1 0
  | Crossing i =>
      let n := normal b in along i (dot n (sub (p1 b) (corner a i))) (dot n (edge a i))
  | Meeting_edges i j =>
      let v := edge b j in let n := cross (edge a i) v in
      along i (dot (cross (between a b i j) v) n) (dot n n)
  end.
(** Candidates for the weights of the point p / m in the triangle t. The caller verifies them. *)
Definition locate (t : triangle Z) (p : vec Z) (m : Z) : list (vec Z) :=
  let n := normal t in
  let opposite i :=
    dot n (cross (edge t (next i)) (sub p (scale m (corner t (next i))))) in
  let project i :=
    let e := edge t i in let n := dot (sub p (scale m (corner t i))) e in
    along i n (m * dot e e) in
  if equal n origin then on_edge I1 1 0 :: map project indices
  else [Vec (opposite I1) (opposite I2) (opposite I3)].

Definition shows (good : vec Z -> Z -> bool) (a b : triangle Z) (p : probe) : bool :=
  let u := probe_weights a b p in
  are_weights u &&
  let q := weigh u a in
  existsb (fun v => is_common a b u v && good q (total u)) (locate b q (total u)).
(** True if a common point p / m is found for which [good p m] is true. *)
Definition has_common (good : vec Z -> Z -> bool) (a b : triangle Z) : bool :=
  existsb (shows good a b) probes || existsb (shows good b a) probes.

(** * Two points whose squared distance is at most n / m *)
Definition are_within (n m : Z) (a b : triangle Z) (u v : vec Z) : bool :=
  let k := total u in let l := total v in
  let w := sub (scale l (weigh u a)) (scale k (weigh v b)) in let r := k * l in
  are_weights u && are_weights v && (m * dot w w <=? n * (r * r)).
(** Candidates for the weights of the point of a that is nearest to corner j of b: the corners of a,
    a point of each edge, and points of the face. *)
Definition feet (a b : triangle Z) (j : index) : list (vec Z) :=
  let p := corner b j in
  let on_side i := let e := edge a i in along i (dot (sub p (corner a i)) e) (dot e e) in
  let n := normal a in let l := dot n n in
  map (fun i => on_edge i 1 0) indices ++ map on_side indices ++
  locate a (sub (scale l p) (scale (dot n (sub p (p1 a))) n)) l.
(** [good a b u v] tests the point of a with weights u and the point of b with weights v. *)
Definition near_corner (good : triangle Z -> triangle Z -> vec Z -> vec Z -> bool)
  (a b : triangle Z) : bool :=
  existsb (fun j => existsb (fun u => good a b u (on_edge j 1 0)) (feet a b j)) indices.
Definition near_edges (good : triangle Z -> triangle Z -> vec Z -> vec Z -> bool)
  (a b : triangle Z) : bool :=
  existsb (fun i => existsb (fun j =>
    good a b (probe_weights a b (Meeting_edges i j))
             (probe_weights b a (Meeting_edges j i))) indices) indices.
Definition has_near (good : triangle Z -> triangle Z -> vec Z -> vec Z -> bool)
  (a b : triangle Z) : bool :=
  near_corner good a b || near_corner good b a || near_edges good a b.

(** * Neighbours that have no more in common than their shared part *)
Definition is_corner_of (t : triangle Z) (c : vec Z) : bool :=
  equal c (p1 t) || equal c (p2 t) || equal c (p3 t).
Definition shared_corners (a b : triangle Z) : list (vec Z) :=
  filter (is_corner_of b) [p1 a; p2 a; p3 a].

(** True if q is on the segment from c to d. *)
Definition lies_on (c d q : vec Z) : bool :=
  let e := sub d c in let r := sub q c in let n := dot e r in let l := dot e e in
  if l =? 0 then equal r origin
  else (0 <=? n) && (n <=? l) && equal (scale l r) (scale n e).
Definition covered (shared : list (vec Z)) (t : triangle Z) (l : list index) : bool :=
  existsb (fun c => existsb (fun d => forallb (fun i => lies_on c d (corner t i)) l) shared) shared.

(** Precondition: all common points lie in the hull of the corners la of a, and in the hull of the
    corners lb of b. If a plane perpendicular to d has la below and lb above, all common points lie
    in the plane. [cut] then returns the corners of la and of lb in the plane. *)
Definition cut (a b : triangle Z) (la lb : list index) (d : vec Z)
  : option (list index * list index) :=
  match la with
  | [] => None
  | i :: _ =>
      let h := fold_left (fun m j => Z.max m (dot d (corner a j))) la (dot d (corner a i)) in
      if forallb (fun j => dot d (corner a j) <=? h) la &&
         forallb (fun j => h <=? dot d (corner b j)) lb
      then Some (filter (fun j => dot d (corner a j) =? h) la,
                 filter (fun j => dot d (corner b j) =? h) lb)
      else None
  end.

Definition opposed (l : list (vec Z)) : list (vec Z) := l ++ map (scale (-1)) l.
Definition pairs_of {A B C} (f : A -> B -> C) (l : list A) (m : list B) : list C :=
  flat_map (fun p => map (f p) m) l.
(** Directions to try, in groups. A group is computed only if no earlier group gives a cut. *)
Definition cuts (a b : triangle Z) : list (unit -> list (vec Z)) :=
  let ea := map (edge a) indices in let eb := map (edge b) indices in
  let ws := ea ++ eb ++ pairs_of (between a b) indices indices in
  [ (fun _ => opposed [normal a; normal b]);
    (fun _ => opposed (pairs_of cross ea eb));
    (fun _ => opposed (pairs_of cross [normal a; normal b] (ea ++ eb)));
    (fun _ => opposed (ea ++ eb));
    (fun _ => opposed (ws ++ pairs_of cross ws ws));
    (fun _ => opposed (pairs_of cross ws (pairs_of cross ws ws))) ].

Definition fewer {A} (l m : list A) : bool := Nat.ltb (length l) (length m).
Fixpoint first_cut (a b : triangle Z) (la lb : list index) (ds : list (vec Z))
  : option (list index * list index) :=
  match ds with
  | [] => None
  | d :: rest =>
      match cut a b la lb d with
      | Some (ka, kb) =>
          if fewer ka la || fewer kb lb then Some (ka, kb) else first_cut a b la lb rest
      | None => first_cut a b la lb rest
      end
  end.
Fixpoint find_cut (a b : triangle Z) (la lb : list index) (groups : list (unit -> list (vec Z)))
  : option (list index * list index) :=
  match groups with
  | [] => None
  | g :: rest =>
      match first_cut a b la lb (g tt) with
      | Some found => Some found
      | None => find_cut a b la lb rest
      end
  end.
(** The tests of [pinned_by]. If it is true, all common points lie on the line through c along e,
    and n bounds them to the part of the line between c and d. *)
Definition on_line (c e : vec Z) (t : triangle Z) (l : list index) : bool :=
  forallb (fun i => forallb (fun k => dot (away k e) (corner t i) =? dot (away k e) c)
                            [Vec 1 0 0; Vec 0 1 0; Vec 0 0 1]) l.
Definition at_least (n : vec Z) (h : Z) (t : triangle Z) (l : list index) : bool :=
  forallb (fun i => h <=? dot n (corner t i)) l.
Definition at_most (n : vec Z) (h : Z) (t : triangle Z) (l : list index) : bool :=
  forallb (fun i => dot n (corner t i) <=? h) l.
Definition pinned_by (a b : triangle Z) (la lb : list index) (c d e n : vec Z) : bool :=
  (0 <? dot n e) && on_line c e a la &&
  (at_least n (dot n c) a la || at_least n (dot n c) b lb) &&
  (at_most n (dot n d) a la || at_most n (dot n d) b lb).
Definition pinned (shared : list (vec Z)) (a b : triangle Z) (la lb : list index) : bool :=
  existsb (fun c => existsb (fun d =>
    if equal c d
    then existsb (fun i => existsb (fun j => let e := edge a i in
           pinned_by a b la lb c c e (away e (edge b j))) indices) indices
    else let e := sub d c in pinned_by a b la lb c d e e) shared) shared.

Fixpoint only_shared (steps : nat) (a b : triangle Z) (shared : list (vec Z)) (la lb : list index)
  : bool :=
  covered shared a la || covered shared b lb ||
  match steps with
  | O => false
  | S fewer_steps =>
      match find_cut a b la lb (cuts a b) with
      | Some (ka, kb) => only_shared fewer_steps a b shared ka kb
      | None => pinned shared a b la lb
      end
  end.

(** * The decision of one pair *)
Inductive kind := Separated | Only_shared | Meeting.
(** None: no proof was found. [first]: looks for a common point before other proofs. *)
Definition decide (first : bool) (clearance : Z) (shared : list (vec Z)) (a b : triangle Z)
  : option kind :=
  let apart := match shared with
               | [] => if separated clearance a b then Some Separated else None
               | _ => if only_shared 7 a b shared indices indices then Some Only_shared else None
               end in
  let common (_ : unit) :=
    match shared with [] => (0 <? clearance) && has_near (are_within (clearance * clearance) 1) a b | _ => false end ||
    has_common (off_shared shared) a b in
  if first then (if common tt then Some Meeting else apart)
  else match apart with
       | Some k => Some k
       | None => if common tt then Some Meeting else None
       end.

(** * The claim of a certificate about a pair, and the finding of the checker *)
Inductive claim := Direction (d : direction) | Meets | Neighbours | Nothing.
Record evidence := Evidence { kept : bool; claimed : claim }.
Inductive finding :=
| As_claimed | Wrong_direction | Not_neighbours | No_evidence
| Culled_meets | Said_disjoint | Said_to_meet.

Definition find (e : evidence) (by_claim neighbour : bool) (k : kind) : finding :=
  match k, claimed e with
  | Meeting, c =>
      if negb (kept e) then Culled_meets
      else match c with
           | Meets => As_claimed
           | Direction _ => Said_disjoint
           | Neighbours => if neighbour then Said_disjoint else No_evidence
           | Nothing => No_evidence
           end
  | Only_shared, Neighbours => As_claimed
  | Only_shared, Meets => Said_to_meet
  | Only_shared, _ => Not_neighbours
  | Separated, Meets => Said_to_meet
  | Separated, Direction _ => if by_claim then As_claimed else Wrong_direction
  | Separated, _ => No_evidence
  end.
Definition refutes (f : finding) : bool :=
  match f with Culled_meets | Said_disjoint | Said_to_meet => true | _ => false end.
Definition is_as_claimed (f : finding) : bool := match f with As_claimed => true | _ => false end.

(** * Triangles with their names and boxes *)
(** [middle]: twice the middle of the box; only the tree uses it. *)
Record item := Item {
  obj : Z; num : Z; own : bool; shape : triangle Z; lo : vec Z; hi : vec Z; middle : vec Z }.
Definition least (t : triangle Z) : vec Z :=
  Vec (min3 (x (p1 t)) (x (p2 t)) (x (p3 t))) (min3 (y (p1 t)) (y (p2 t)) (y (p3 t)))
      (min3 (z (p1 t)) (z (p2 t)) (z (p3 t))).
Definition greatest (t : triangle Z) : vec Z :=
  Vec (max3 (x (p1 t)) (x (p2 t)) (x (p3 t))) (max3 (y (p1 t)) (y (p2 t)) (y (p3 t)))
      (max3 (z (p1 t)) (z (p2 t)) (z (p3 t))).
Definition make_item (e : Z) (n : named) : item :=
  let s := map_triangle (scaled e) (corners n) in let l := least s in let h := greatest s in
  Item (of_object n) (number n) (inner n) s l h (add l h).
(** The items in the order of the list. Two tail-recursive reversals need no stack. *)
Definition items_of (e : Z) (l : list named) : list item :=
  fold_left (fun done n => make_item e n :: done) (rev_append l []) [].

Definition overlap (l h l' h' : vec Z) : bool :=
  (x l <=? x h') && (x l' <=? x h) && (y l <=? y h') && (y l' <=? y h) &&
  (z l <=? z h') && (z l' <=? z h).
Definition comes_before (a b : item) : bool :=
  (obj a <? obj b) || ((obj a =? obj b) && own a && (num a <? num b)).
Definition candidate (a b : item) : bool :=
  comes_before a b && overlap (lo a) (hi a) (lo b) (hi b).
(** The item with its box enlarged by [reach] on all sides. *)
Definition grow (reach : Z) (a : item) : item :=
  if reach =? 0 then a else
  let r := Vec reach reach reach in
  Item (obj a) (num a) (own a) (shape a) (sub (lo a) r) (add (hi a) r) (middle a).

(** * A tree of boxes. How it divides the triangles changes the speed, not the answer. *)
Record bounds := Bounds { low : vec Z; high : vec Z; last : Z }.  (* last: the largest [obj] *)
Inductive tree :=
| Leaf (around : bounds) (held : list item)
| Node (around : bounds) (one other : tree).
Definition around (t : tree) : bounds := match t with Leaf b _ => b | Node b _ _ => b end.

Definition down (p q : vec Z) : vec Z :=
  Vec (Z.min (x p) (x q)) (Z.min (y p) (y q)) (Z.min (z p) (z q)).
Definition up (p q : vec Z) : vec Z :=
  Vec (Z.max (x p) (x q)) (Z.max (y p) (y q)) (Z.max (z p) (z q)).
Definition leaf (held : list item) : tree :=
  match held with
  | [] => Leaf (Bounds origin origin 0) []
  | a :: _ => Leaf (Bounds (fold_left (fun p b => down p (lo b)) held (lo a))
                           (fold_left (fun p b => up p (hi b)) held (hi a))
                           (fold_left (fun n b => Z.max n (obj b)) held (obj a))) held
  end.
Definition node (s t : tree) : tree :=
  let b := around s in let c := around t in
  Node (Bounds (down (low b) (low c)) (up (high b) (high c)) (Z.max (last b) (last c))) s t.

Fixpoint divide (f : item -> bool) (l yes no : list item) : list item * list item :=
  match l with
  | [] => (yes, no)
  | a :: rest => if f a then divide f rest (a :: yes) no else divide f rest yes (a :: no)
  end.
(** Tests whether the middle of a box is in the lower half of the range of all middles, along the
    axis with the longest range. *)
Definition halve (first : item) (l : list item) : item -> bool :=
  let bottom := fold_left (fun p b => down p (middle b)) l (middle first) in
  let top := fold_left (fun p b => up p (middle b)) l (middle first) in
  let s := sub top bottom in let m := add top bottom in
  if (y s <=? x s) && (z s <=? x s) then let h := x m / 2 in fun a => x (middle a) <=? h
  else if z s <=? y s then let h := y m / 2 in fun a => y (middle a) <=? h
  else let h := z m / 2 in fun a => z (middle a) <=? h.
Fixpoint build (depth : nat) (l : list item) : tree :=
  match depth, l with
  | S deeper, a :: _ :: _ :: _ :: _ :: _ =>
      match divide (halve a l) l [] [] with
      | ([], _) | (_, []) => leaf l
      | (yes, no) => node (build deeper yes) (build deeper no)
      end
  | _, _ => leaf l
  end.

Fixpoint pick (a : item) (l found : list item) : list item :=
  match l with
  | [] => found
  | b :: rest => pick a rest (if candidate a b then b :: found else found)
  end.
Definition may_ask (a : item) (b : bounds) : bool :=
  ((obj a <? last b) || ((obj a =? last b) && own a)) && overlap (lo a) (hi a) (low b) (high b).
Fixpoint query (a : item) (t : tree) (found : list item) : list item :=
  if may_ask a (around t) then
    match t with
    | Leaf _ held => pick a held found
    | Node _ one other => query a one (query a other found)
    end
  else found.

(** * All pairs to decide, in the order of the certificate *)
Module Downwards <: TotalLeBool.
  Definition t := item.
  Definition leb (a b : item) : bool :=
    if obj a =? obj b then num b <=? num a else obj b <=? obj a.
  Lemma leb_total : forall a b, leb a b = true \/ leb b a = true.
  Proof.
    intros a b. unfold leb. rewrite (Z.eqb_sym (obj b)).
    destruct (obj a =? obj b); rewrite !Z.leb_le; apply Z.le_ge_cases.
  Qed.
End Downwards.
Module Sorting := Sort Downwards.

(** [is_of]: true if a pair belongs to the tile. *)
Definition both_before (e : Z) (k : axis) (place : double) (a b : item) : bool :=
  let p := scaled e place in (coordinate k (lo a) <? p) && (coordinate k (lo b) <? p).
Definition is_of (e : Z) (t : tile) (a b : item) : bool :=
  match tile_end t with Some p => both_before e (tile_axis t) p a b | None => true end &&
  match tile_begin t with Some p => negb (both_before e (tile_axis t) p a b) | None => true end.

Fixpoint put (mine : item -> item -> bool) (a : item) (partners : list item)
  (done : list (item * item)) :=
  match partners with
  | [] => done
  | b :: rest => put mine a rest (if mine a b then (a, b) :: done else done)
  end.
Fixpoint collect (mine : item -> item -> bool) (reach : item -> Z) (t : tree) (l : list item)
  (done : list (item * item)) :=
  match l with
  | [] => done
  | a :: rest =>
      collect mine reach t rest (put mine a (Sorting.sort (query (grow (reach a) a) t [])) done)
  end.
Definition pairs (mine : item -> item -> bool) (reach : item -> Z) (l : list item) : list (item * item) :=
  collect mine reach (build 64 l) l [].

(** * The check of a certificate *)
Record claims := Claims {
  box_pairs : Z; kept_pairs : Z; culled : Z; separated_pairs : Z; neighbour_pairs : Z; meeting : Z }.
Record tally := Tally {
  rows : list row; refuting : option (row * finding); weak : option (row * finding);
  n_kept : Z; n_culled : Z; n_separated : Z; n_neighbours : Z; n_meeting : Z }.
Inductive verdict :=
| Proved (list_of_pairs : list row)
| Refuted (r : row) (f : finding)
| Unproved (r : row) (f : finding)
| Wrong_count | Too_short | Too_long | Bad_reach
| Undecided (r : row).

Definition row_of (a b : item) (neighbour : bool) : row :=
  Row (obj a) (num a) (obj b) (num b) neighbour.
Definition note (o : option (row * finding)) (b : bool) (r : row) (f : finding) :=
  match o with None => if b then Some (r, f) else None | _ => o end.
Definition count_if (b : bool) (n : Z) : Z := if b then n + 1 else n.
Definition is_kind (k k' : kind) : bool :=
  match k, k' with
  | Separated, Separated | Only_shared, Only_shared | Meeting, Meeting => true
  | _, _ => false
  end.
Definition enter (t : tally) (e : evidence) (r : row) (k : kind) (f : finding) : tally :=
  Tally (if is_kind k Meeting then r :: rows t else rows t)
        (note (refuting t) (refutes f) r f) (note (weak t) (negb (is_as_claimed f)) r f)
        (count_if (kept e) (n_kept t)) (count_if (negb (kept e)) (n_culled t))
        (count_if (is_kind k Separated) (n_separated t))
        (count_if (is_kind k Only_shared) (n_neighbours t))
        (count_if (is_kind k Meeting) (n_meeting t)).

Definition shared_of (a b : item) : list (vec Z) :=
  if obj a =? obj b then shared_corners (shape a) (shape b) else [].
Definition judge (clearance : Z) (a b : item) (e : evidence) : option (kind * finding) :=
  let shared := shared_of a b in
  let neighbour := match shared with [] => false | _ => true end in
  let by_claim := match shared, claimed e with
                  | [], Direction d =>
                      separates clearance (shape a) (shape b) (vector (shape a) (shape b) d)
                  | _, _ => false
                  end in
  let first := match claimed e with Meets => true | _ => false end in
  match (if by_claim then Some Separated else decide first clearance shared (shape a) (shape b)) with
  | Some k => Some (k, find e by_claim neighbour k)
  | None => None
  end.
Definition name_of (a b : item) : row :=
  row_of a b (match shared_of a b with [] => false | _ => true end).

Definition counts_are (c : claims) (t : tally) : bool :=
  (box_pairs c =? n_kept t + n_culled t) && (kept_pairs c =? n_kept t) && (culled c =? n_culled t) &&
  (separated_pairs c =? n_separated t) && (neighbour_pairs c =? n_neighbours t) &&
  (meeting c =? n_meeting t).

Fixpoint judge_all (clearance : Z) (c : claims) (l : list (item * item))
  (es : list evidence) (t : tally) : verdict :=
  match l, es with
  | [], [] =>
      match refuting t, weak t with
      | Some (r, f), _ => Refuted r f
      | None, Some (r, f) => Unproved r f
      | None, None => if counts_are c t then Proved (rev_append (rows t) []) else Wrong_count
      end
  | [], _ :: _ => Too_long
  | _ :: _, [] => Too_short
  | (a, b) :: l', e :: es' =>
      match judge clearance a b e with
      | None => Undecided (name_of a b)
      | Some (k, f) => judge_all clearance c l' es' (enter t e (name_of a b) k f)
      end
  end.
(** [l]: the triangles that the tile needs. [reach]: a pair is decided if its boxes are at most
    [reach] apart along each axis; with [less], if they are less than [reach] apart. The verdict is
    right for any reach that is at least the clearance. *)
Definition check (l : list named) (b : tile) (clearance reach : double) (less : bool) (c : claims)
  (es : list evidence) : verdict :=
  let e := lower_place (lower_place (lower (lower 0 clearance) reach) (tile_begin b)) (tile_end b) in
  let f := lowest l e in
  let d := scaled f clearance in let r := scaled f reach - (if less then 1 else 0) in
  if (0 <=? d) && (d <=? r)
  then judge_all d c (pairs (is_of f b) (fun _ => r) (items_of f l)) es (Tally [] None None 0 0 0 0 0)
  else Bad_reach.

(** * Tiles that together cover an axis

    Each tile begins where the tile before it ends. No tile ends before its own beginning, since
    then tiles could cover a place twice. *)
Definition same_axis (k k' : axis) : bool :=
  match k, k' with
  | Along_x, Along_x | Along_y, Along_y | Along_z, Along_z => true
  | _, _ => false
  end.
Definition same_place (p q : option double) : bool :=
  match p, q with
  | Some d, Some d' => (mantissa d =? mantissa d') && (exponent d =? exponent d')
  | None, None => true
  | _, _ => false
  end.
Definition is_backwards (b : tile) : bool :=
  match tile_begin b, tile_end b with Some p, Some q => is_below q p | _, _ => false end.
Fixpoint join (k : axis) (place : option double) (l : list (tile * list row)) (done : list row)
  : option (list row) :=
  match l with
  | [] => None
  | (b, rows) :: rest =>
      let all := rev_append rows done in
      if same_axis (tile_axis b) k && same_place (tile_begin b) place && negb (is_backwards b) then
        match tile_end b, rest with
        | None, [] => Some all
        | Some _, _ :: _ => join k (tile_end b) rest all
        | _, _ => None
        end
      else None
  end.
(** The rows of all tiles, unsorted. None if the tiles leave a place out, or cover a place twice. *)
Definition merge_tiles (l : list (tile * list row)) : option (list row) :=
  match l with [] => None | (b, _) :: _ => join (tile_axis b) None l [] end.
