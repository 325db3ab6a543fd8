(* Replays runs of core/cull with the model that Coq has proved things of (Passes.v), and compares the bits
   after each pass, and which pairs are left to exact tests.
     replay [twin] < DUMP     the dump is that of CullModel.AgreesWithCullStepByStep (model_cull_test.cpp)
   "twin" stores no undrawable item, so some run must differ. Exit status: 0 none differs; 1 some do. *)
open Passes

let twin = Array.length Sys.argv > 1 && Sys.argv.(1) = "twin"
let number () = Scanf.scanf " %d" Fun.id
let several read = List.init (number ()) (fun _ -> read ())
let inside set t = set lsr t land 1 = 1
let list_of set = List.filter (inside set) (List.init 31 Fun.id)
let set_of items = List.fold_left (fun set t -> set lor (1 lsl t)) 0 items
let bits_of f l = { f = list_of f; l = list_of l }

let read_view triangles =
  let undrawable = inside (number ()) in
  let shown = inside (number ()) in
  let behind = Array.init triangles (fun _ -> inside (number ())) in
  { undrawable; shown; behind = (fun t u -> behind.(t) u) }

(* The steps of one run; true if all agree. *)
let replay_case () =
  let triangles = number () in
  let region = number () in
  let taken f l = bits_of (f land region) (l land region) in
  let read_taken () = let f = number () in taken f (number ()) in
  let owners = Array.of_list (several number) in
  let owner t = Option.get (List.find_opt (fun o -> inside owners.(o) t) (List.init (Array.length owners) Fun.id)) in
  let views = Array.of_list (several (fun () -> read_view triangles)) in
  let equal a b = set_of a.f = set_of b.f && set_of a.l = set_of b.l in
  let bits = ref None and agree = ref true in
  let step () =
    let quick_pass = number () = 1 in
    let second = number () = 1 in
    let view = views.(number ()) in
    let ran = number () = 1 in
    let groups = Array.of_list (several (fun () -> several (fun () -> list_of (number () land region)))) in
    let before = read_taken () in
    let after = read_taken () in
    let items = list_of region in
    let items = if twin then List.filter (fun t -> not (view.undrawable t)) items else items in
    let world = { items; owner } in
    (* A run begins with facts; later bits are only taken back between passes. *)
    let now = match !bits with None -> before | Some b -> do_step world b (Keep before) in
    let groups o = if o < Array.length groups then groups.(o) else [] in
    let pass = (if quick_pass then quick else plain) now second view groups in
    let now' = if ran then do_step world now (Draw pass) else now in
    agree := !agree && equal now before && equal now' after;
    bits := Some after
  in
  ignore (several step);
  (* What takes no part has both bits. *)
  let last = let f = number () in bits_of f (number ()) in
  let pair () =
    let u = number () in
    let t = number () in
    let exact = number () = 1 in
    let u, t = if owner u <= owner t then u, t else t, u in
    let drawn u t = owner u <> owner t in
    agree := !agree && tested { items = list_of region; owner } drawn last (u, t) = exact
  in
  let pairs = several pair in
  !agree, List.length pairs

let () =
  let cases = ref 0 and pairs = ref 0 and different = ref 0 in
  (try
     while true do
       Scanf.scanf " case" ();
       let agree, more = replay_case () in
       incr cases;
       pairs := !pairs + more;
       if not agree then incr different
     done
   with End_of_file | Scanf.Scan_failure _ -> ());
  Scanf.scanf " %s" (fun rest -> if rest <> "end" then (Printf.printf "replay: the dump is not whole\n"; exit 2));
  Printf.printf "replay%s: %d runs of core/cull, %d pairs; %d differ from the proved model\n"
    (if twin then ", twin" else "") !cases !pairs !different;
  exit (if !different > 0 || !cases < 100 || !pairs < 100 then 1 else 0)
