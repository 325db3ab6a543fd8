(** The passes of CULLIDE and Quick-CULLIDE as functions of sets, and what is assumed of them. Nothing is
    proved here: PassProofs.v proves theorem 2 and the lemmas of Quick-CULLIDE (docs/reliability.md) of
    these definitions, which docs/model.md explains. Items and owners are numbers. *)
From Coq Require Import List Bool Arith.
Import ListNotations.

(** The items that take part, and the owner of each. Owners are in the order of their numbers. *)
Record world := World { items : list nat; owner : nat -> nat }.
Definition owners (w : world) : nat := S (list_max (map (owner w) (items w))).

(** A view knows for each item whether its place is unknown, and whether it has a point in the window;
    [behind t u]: t, when it is asked, has a fragment at or behind the stored depth of u. *)
Record view :=
  View { undrawable : nat -> bool; shown : nat -> bool; behind : nat -> nat -> bool }.
Definition hides (v : view) (t u : nat) : bool := undrawable v u || behind v t u.

(** Items with F are cleared against all earlier owners, items with L against all later ones. *)
Record bits := Bits { f : list nat; l : list nat }.
Definition bit (second : bool) (b : bits) : list nat := if second then l b else f b.
Definition mem (t : nat) (s : list nat) : bool := existsb (Nat.eqb t) s.

(** A pass. The second goes backwards and gives L, the first gives F. [groups o]: what is asked as a
    whole of owner o. *)
Record pass :=
  Pass { second : bool; along : view; groups : nat -> list (list nat);
         asks : nat -> bool; stores : nat -> bool }.

(** The items of a group that get the bit: all that are asked, or, if one of them is seen, those
    without a point in the window. An undrawable item is never asked. *)
Definition unseen (p : pass) (stored group : list nat) : list nat :=
  let asked := filter (fun t => asks p t && negb (undrawable (along p) t)) group in
  if existsb (fun t => shown (along p) t && existsb (hides (along p) t) stored) asked
  then filter (fun t => negb (shown (along p) t)) asked else asked.

(** Each owner is asked, then stored. *)
Fixpoint go (w : world) (p : pass) (order stored : list nat) : list nat :=
  match order with
  | [] => []
  | o :: rest =>
      flat_map (unseen p stored) (groups p o) ++
      go w p rest (filter (fun u => (owner w u =? o) && stores p u) (items w) ++ stored)
  end.
Definition cleared (w : world) (p : pass) : list nat :=
  go w p (if second p then rev (seq 0 (owners w)) else seq 0 (owners w)) [].
Definition after (w : world) (b : bits) (p : pass) : bits :=
  if second p then Bits (f b) (cleared w p ++ l b) else Bits (cleared w p ++ f b) (l b).

(** Quick-CULLIDE asks what lacks the bit of the pass and stores what lacks the other bit. Plain
    CULLIDE asks and stores what lacks one of them. *)
Definition quick (b : bits) (second : bool) (v : view) (groups : nat -> list (list nat)) : pass :=
  Pass second v groups (fun t => negb (mem t (bit second b)))
    (fun u => negb (mem u (bit (negb second) b))).
Definition live (b : bits) (t : nat) : bool := negb (mem t (f b) && mem t (l b)).
Definition plain (b : bits) (second : bool) (v : view) (groups : nat -> list (list nat)) : pass :=
  Pass second v groups (live b) (live b).
Definition both (b : bits) : bits :=
  let culled := filter (fun t => mem t (l b)) (f b) in Bits culled culled.

(** A schedule is any sequence of passes. Between them bits may be taken back, as plain CULLIDE does,
    or runs that want all views to agree; and bits of another run may be added. *)
Inductive step := Draw (p : pass) | Keep (kept : bits) | Add (more : bits).
Definition do_step (w : world) (b : bits) (s : step) : bits :=
  match s with
  | Draw p => after w b p
  | Keep kept => Bits (filter (fun t => mem t (f kept)) (f b)) (filter (fun t => mem t (l kept)) (l b))
  | Add more => Bits (f more ++ f b) (l more ++ l b)
  end.
Definition run (w : world) (b : bits) (ss : list step) : bits := fold_left (do_step w) ss b.

(** Boxes before pixels: of the pairs whose boxes overlap, the exact tests leave out a drawn pair of
    two owners if the earlier item has L or the later one F. All others are tested. *)
Definition tested (w : world) (drawn : nat -> nat -> bool) (b : bits) (pair : nat * nat) : bool :=
  let (u, t) := pair in
  negb (drawn u t) || (owner w u =? owner w t) || (negb (mem u (l b)) && negb (mem t (f b))).
(** Only items of drawn pairs take part. *)
Definition drawn_world (owner : nat -> nat) (drawn : nat -> nat -> bool)
    (boxes : list (nat * nat)) : world :=
  World (flat_map (fun '(u, t) => if drawn u t then [u; t] else []) boxes) owner.

(** What theorem 1 and lemmas 4 and 5 say of a view: of two items that meet each is undrawable, or it is
    shown, and is seen when it is asked after the other was stored, which hides it where its depths say so,
    or everywhere if it is undrawable. Then the rules: whose a group is, and what a pass has to store. *)
Section Statements.
Variables (w : world) (meet : nat -> nat -> Prop).
Definition sees (v : view) (t u : nat) : Prop :=
  undrawable v t = true \/
  (shown v t = true /\ (undrawable v u = true \/ behind v t u = true)).
Definition shows (v : view) : Prop :=
  forall u t, meet u t -> owner w u < owner w t -> sees v u t /\ sees v t u.
Definition take_part : Prop :=
  forall u t, meet u t -> owner w u < owner w t -> In u (items w) /\ In t (items w).
Definition of_one_owner (groups : nat -> list (list nat)) : Prop :=
  forall o g t, In g (groups o) -> In t g -> owner w t = o.
Definition stores_enough (b : bits) (p : pass) : Prop :=
  forall u, In u (items w) -> ~ In u (bit (negb (second p)) b) -> stores p u = true.

(** What the bits say: F(t) that t meets no item of an earlier owner, L(u) the reverse. *)
Definition facts (b : bits) : Prop :=
  forall u t, meet u t -> owner w u < owner w t -> ~ In u (l b) /\ ~ In t (f b).

Definition allowed (b : bits) (s : step) : Prop :=
  match s with
  | Draw p => shows (along p) /\ of_one_owner (groups p) /\ stores_enough b p
  | Keep _ => True
  | Add more => facts more
  end.
Fixpoint allowed_run (b : bits) (ss : list step) : Prop :=
  match ss with [] => True | s :: rest => allowed b s /\ allowed_run (do_step w b s) rest end.
End Statements.
