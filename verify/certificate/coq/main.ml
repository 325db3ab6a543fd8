(* farcull-check-verified CERTIFICATE SCENE ...: reads both files, calls the checker (defined in
   Checker.v, proved in Proofs.v), and prints the verdict. Further pairs of files are checked
   likewise. With --tiles CERTIFICATE... SCENE, there is one certificate for each tile of the scene,
   in order. docs/certificate.md describes certificates. SCENE is a file that `farcull check
   --verified` writes: words of 64 bits, lowest byte first. Exit status: 0 proved; 1 refuted or not
   proved; 2 a file cannot be read; 3 the checker could not decide a pair; 4 the stack or the memory
   was too small. This file is trusted, not proved: it turns bytes into the values of Spec.v, and a
   verdict into text. *)
module Integer = Z
open Checker
module Z = Integer  (* Z is zarith's module, not the checker's Z *)

exception Bad of string
let bad format = Printf.ksprintf (fun text -> raise (Bad text)) format

let read_file path =
  let file = open_in_bin path in
  Fun.protect ~finally:(fun () -> close_in file) (fun () ->
      let size = in_channel_length file in
      really_input_string file size)

(* ---- SHA-256 (FIPS 180-4) and FNV-1a ---- *)

let primes =
  let rec from n found =
    if List.length found = 64 then List.rev found
    else from (n + 1) (if List.exists (fun p -> n mod p = 0) found then found else n :: found) in
  from 2 []
(* The first 32 fractional bits of the square root (power 2) or cube root (power 3) of n. *)
let fraction power n =
  let wanted = Z.shift_left (Z.of_int n) (32 * power) in
  Z.to_int (Z.logand (Z.root wanted power) (Z.of_int 0xffffffff))
let constants = Array.of_list (List.map (fraction 3) primes)
let start = Array.sub (Array.of_list (List.map (fraction 2) primes)) 0 8

let mask = 0xffffffff
(* Adds the first [size] bytes to the state, except for an incomplete last block of 64 bytes. *)
let sha_blocks state bytes size =
  let right x n = ((x lsr n) lor (x lsl (32 - n))) land mask in
  let w = Array.make 64 0 in
  for block = 0 to size / 64 - 1 do
    for i = 0 to 15 do
      w.(i) <- Int32.to_int (Bytes.get_int32_be bytes (64 * block + 4 * i)) land mask
    done;
    for i = 16 to 63 do
      let a = w.(i - 15) and b = w.(i - 2) in
      w.(i) <- (w.(i - 16) + (right a 7 lxor right a 18 lxor (a lsr 3)) + w.(i - 7)
                + (right b 17 lxor right b 19 lxor (b lsr 10))) land mask
    done;
    let s = Array.copy state in
    for i = 0 to 63 do
      let a = s.(0) and e = s.(4) in
      let t = s.(7) + (right e 6 lxor right e 11 lxor right e 25)
              + ((e land s.(5)) lxor (lnot e land mask land s.(6))) + constants.(i) + w.(i) in
      let u = (right a 2 lxor right a 13 lxor right a 22)
              + ((a land s.(1)) lxor (a land s.(2)) lxor (s.(1) land s.(2))) in
      Array.blit s 0 s 1 7;
      s.(4) <- (s.(4) + t) land mask;
      s.(0) <- (t + u) land mask
    done;
    Array.iteri (fun i x -> state.(i) <- (state.(i) + x) land mask) s
  done
(* Adds the last bytes and the padding; returns the digest. [total]: bytes of the whole text. *)
let sha_end state bytes size total =
  sha_blocks state bytes size;
  let rest = size mod 64 in
  let tail = Bytes.make (if rest < 56 then 64 else 128) '\000' in
  Bytes.blit bytes (size - rest) tail 0 rest;
  Bytes.set tail rest '\x80';
  Bytes.set_int64_be tail (Bytes.length tail - 8) (Int64.of_int (8 * total));
  sha_blocks state tail (Bytes.length tail);
  String.concat "" (List.map (Printf.sprintf "%08x") (Array.to_list state))
let sha256 text =
  let size = String.length text in
  sha_end (Array.copy start) (Bytes.unsafe_of_string text) size size

let fnv1a hash bytes size =
  let hash = ref hash in
  for i = 0 to size - 1 do
    let c = Int64.of_int (Char.code (Bytes.unsafe_get bytes i)) in
    hash := Int64.mul (Int64.logxor !hash c) 0x100000001b3L
  done;
  !hash

(* ---- the scene ---- *)

(* The double as an odd integer times a power of two; zero as 0. *)
let zero = { mantissa = Z.zero; exponent = Z.zero }
let double_of word =
  let exponent = Int64.to_int (Int64.shift_right_logical word 52) land 0x7ff in
  let fraction = Int64.to_int (Int64.logand word 0xfffffffffffffL) in
  if exponent = 0x7ff then bad "the scene has a coordinate that is not finite";
  let whole = if exponent = 0 then fraction else fraction lor (1 lsl 52) in
  if whole = 0 then zero
  else
    let zeros = Z.trailing_zeros (Z.of_int whole) in
    let odd = whole lsr zeros in
    { mantissa = Z.of_int (if Int64.compare word 0L < 0 then - odd else odd);
      exponent = Z.of_int (max exponent 1 - 1075 + zeros) }

(* The reach that [check] needs, and [less]. farcull compares the rounded difference of two doubles
   with the clearance. Let the middle be half way between the clearance and the next double. The
   rounded difference is at most the clearance iff the exact difference is at most the middle; it
   has to be less if the last bit of the clearance is 1, since the middle is then rounded up. A
   verdict is right for any reach of at least the clearance. This reach selects the pairs that the
   certificate has bytes for. *)
let reach_of clearance =
  if clearance = 0. then (zero, false)
  else
    let bits = Int64.bits_of_float clearance in
    let exponent = max 1 (Int64.to_int (Int64.shift_right_logical bits 52)) - 1075 in
    let whole = Z.of_float (Float.ldexp clearance (- exponent)) in
    ({ mantissa = Z.succ (Z.mul (Z.of_int 2) whole); exponent = Z.of_int (exponent - 1) },
     Z.is_odd whole)

(* The triangles that are kept of a scene, and facts about the whole scene. *)
type found = {
  kept : named list; objects : int; triangles : int; has_self : bool;
  unasked_objects : Z.t; unasked_pairs : Z.t;  (* objects that are not self; pairs inside them *)
  fnv : string; sha : string }

(* Reads the scene from beginning to end, and calls [keep] for each triangle in order. The triangles
   that [keep] adds to the list are those of [gathered] in Checker.v. *)
let read_scene path piece reach =
  let file = open_in_bin path in
  Fun.protect ~finally:(fun () -> close_in file) @@ fun () ->
  let block = Bytes.create (1 lsl 20) in
  let size = ref 0 and at = ref 0 and total = ref 0 in
  let hash = ref 0xcbf29ce484222325L and state = Array.copy start and sha = ref "" in
  let refill () =
    let rec fill from =
      match input file block from (Bytes.length block - from) with
      | 0 -> from
      | n -> if from + n = Bytes.length block then from + n else fill (from + n) in
    size := if !sha = "" then fill 0 else 0;
    at := 0;
    total := !total + !size;
    hash := fnv1a !hash block !size;
    if !size = Bytes.length block then sha_blocks state block !size
    else if !sha = "" then sha := sha_end state block !size !total in
  let word () =
    if !at = !size then refill ();
    if !at + 8 > !size then bad "the scene is too short";
    at := !at + 8;
    Bytes.get_int64_le block (!at - 8) in
  let number limit =
    let n = word () in
    if Int64.compare n 0L < 0 || Int64.compare n limit >= 0 then bad "the scene has a wrong size";
    Int64.to_int n in
  let point () =
    let x = double_of (word ()) in
    let y = double_of (word ()) in
    let z0 = double_of (word ()) in
    { x; y; z0 } in
  let triangle () =
    let p1 = point () in
    let p2 = point () in
    let p3 = point () in
    { p1; p2; p3 } in
  let rec sizes_of n done_ =
    if n = 0 then List.rev done_ else sizes_of (n - 1) (number 0x200000000L :: done_) in
  let objects = number 0x100000000L in
  let sizes = sizes_of objects [] in
  let count size = size land 0xffffffff and inner size = size land 0x100000000 <> 0 in
  let kept = ref [] in
  List.iteri (fun o size ->
      let keep = keep piece reach (Z.of_int o) in
      for i = 0 to count size - 1 do
        kept := keep (Z.of_int i) (inner size) (triangle ()) !kept
      done) sizes;
  if !at < !size || (refill (); !size > 0) then bad "the scene is too long";
  let unasked = List.filter (fun size -> not (inner size)) sizes in
  let inside n = Z.div (Z.mul (Z.of_int n) (Z.of_int (n - 1))) (Z.of_int 2) in
  { kept = !kept; objects; triangles = List.fold_left (fun n size -> n + count size) 0 sizes;
    has_self = List.exists inner sizes; unasked_objects = Z.of_int (List.length unasked);
    unasked_pairs = List.fold_left (fun n size -> Z.add n (inside (count size))) Z.zero unasked;
    fnv = Printf.sprintf "%016Lx" !hash; sha = !sha }

(* ---- the certificate ---- *)

let number_of of_ key = Json.whole (Json.member key of_)

let index = [| I1; I2; I3 |]
let evidence_of byte =
  let claim = byte land 0xbf in
  let two n make = Direction (make index.(n / 3) index.(n mod 3)) in
  let claimed =
    if claim = 0 then Direction Normal_a
    else if claim = 1 then Direction Normal_b
    else if claim < 11 then two (claim - 2) (fun i j -> Edge_edge (i, j))
    else if claim < 20 then two (claim - 11) (fun i j -> Foot_a (i, j))
    else if claim < 29 then two (claim - 20) (fun i j -> Foot_b (i, j))
    else if claim < 38 then two (claim - 29) (fun i j -> Between (i, j))
    else if claim = 38 then Meets
    else if claim = 39 then Neighbours
    else Nothing in
  { kept = byte land 0x40 <> 0; claimed }

let claims_of root =
  let claims = Json.member "claims" root in
  { box_pairs = number_of claims "box_pairs"; kept_pairs = number_of claims "kept";
    culled = number_of claims "culled"; separated_pairs = number_of claims "separated";
    neighbour_pairs = number_of claims "neighbours"; meeting = number_of claims "meeting" }

let tile_of root =
  match Json.tile root with
  | None -> everything
  | Some (axis, from, to_) ->
    let place = Option.map (fun x -> double_of (Int64.bits_of_float x)) in
    { tile_axis = (match axis with "x" -> Along_x | "y" -> Along_y | _ -> Along_z);
      tile_begin = place from; tile_end = place to_ }
let tile_text root =
  match Json.tile root with
  | None -> ""
  | Some (axis, from, to_) ->
    let place end_ = function None -> end_ | Some x -> Printf.sprintf "%.17g" x in
    Printf.sprintf " for the tile of %s from %s to %s" axis (place "-inf" from) (place "+inf" to_)

(* ---- the verdict ---- *)

let list_text with_neighbours rows =
  let text = Buffer.create 65536 in
  Buffer.add_string text "object_a,triangle_a,object_b,triangle_b";
  if with_neighbours then Buffer.add_string text ",neighbours";
  Buffer.add_char text '\n';
  List.iter (fun r ->
      Printf.bprintf text "%s,%s,%s,%s%s\n" (Z.to_string r.object_a) (Z.to_string r.triangle_a)
        (Z.to_string r.object_b) (Z.to_string r.triangle_b)
        (if not with_neighbours then "" else if r.neighbours then ",1" else ",0")) rows;
  Buffer.contents text

let pair r =
  Printf.sprintf "object %s triangle %s and object %s triangle %s" (Z.to_string r.object_a)
    (Z.to_string r.triangle_a) (Z.to_string r.object_b) (Z.to_string r.triangle_b)
let reason = function
  | As_claimed -> "as claimed"
  | Wrong_direction -> "the direction does not separate the pair, which is disjoint"
  | Not_neighbours -> "the byte does not say that these neighbours share only vertices or an edge"
  | No_evidence -> "the byte is no evidence"
  | Culled_meets -> "the pair is called culled, and it counts"
  | Said_disjoint -> "the pair is called disjoint, and it counts"
  | Said_to_meet -> "the pair is said to count, and it does not"

let say format = Printf.ksprintf (fun text -> Printf.printf "verified   %s\n%!" text) format
let not_proved text = say "not proved: %s" text; Error "not proved"
let status_of = function Ok _ -> 0 | Error "undecided" -> 3 | Error _ -> 1
let clearance_text clearance =
  if clearance = 0. then " for pairs that meet" else Printf.sprintf " for pairs at most %.17g apart" clearance
let hash_of has_self rows = sha256 (list_text has_self rows)

let other_scene root found =
  let key = Json.member "scene" root in
  not (Z.equal (number_of key "objects") (Z.of_int found.objects))
  || not (Z.equal (number_of key "triangles") (Z.of_int found.triangles))
  || Json.text (Json.member "hash" key) <> found.fnv

(* Checks one certificate. If it is proved, returns its tile, rows and clearance, and whether an
   object of the scene is self; otherwise returns the verdict. *)
let check_file scene certificate =
  let text = read_file certificate in
  let root = Json.certificate text in
  let bytes = Json.base64 (Json.member "evidence" root) in
  let clearance = Json.clearance root and piece = tile_of root in
  let reach, less = reach_of clearance in
  let found = read_scene scene piece reach in
  say "certificate sha256 %s" (sha256 text);
  say "scene       sha256 %s" found.sha;
  let unasked = Json.member "not_asked" root in
  let has_self = found.has_self in
  if other_scene root found
  then not_proved "the certificate is of another scene"
  else
    let right_unasked = Z.equal (number_of unasked "objects") found.unasked_objects
                        && Z.equal (number_of unasked "pairs") found.unasked_pairs in
    let evidence =
      let rec from i found = if i < 0 then found else from (i - 1) (evidence_of (Char.code bytes.[i]) :: found) in
      from (String.length bytes - 1) [] in
    match check found.kept piece (double_of (Int64.bits_of_float clearance)) reach less (claims_of root) evidence with
    | Refuted (r, f) -> say "refuted: %s: %s" (reason f) (pair r); Error "refuted"
    | Unproved (r, f) -> not_proved (reason f ^ ": " ^ pair r)
    | Wrong_count -> not_proved "a count is wrong"
    | Too_short -> not_proved "the evidence is too short"
    | Bad_reach -> bad "the clearance is negative or not finite"
    | Too_long -> not_proved "the evidence is too long"
    | Undecided r -> say "undecided: %s" (pair r); Error "undecided"
    | Proved _ when not right_unasked -> not_proved "a count is wrong"
    | Proved rows ->
      let hash = hash_of has_self rows in
      if hash <> Json.text (Json.member "list_sha256" root)
      then not_proved ("the certificate is of another list of pairs; that of the scene is " ^ hash)
      else begin
        say "proved: the list with the hash %s is right and complete%s%s, %d pairs" hash
          (clearance_text clearance) (tile_text root) (List.length rows);
        Ok (piece, rows, clearance, has_self)
      end

(* Checks the certificates of all tiles of a scene, in the order of the tiles. *)
let check_tiles scene certificates =
  let results = List.map (check_file scene) certificates in
  let proved = List.filter_map Result.to_option results in
  let is word = List.exists (function Error other -> other = word | Ok _ -> false) results in
  let has_self = List.exists (fun (_, _, _, has_self) -> has_self) proved in
  let clearances = List.map (fun (_, _, clearance, _) -> clearance) proved in
  match List.find_opt is [ "undecided"; "refuted"; "not proved" ] with
  | Some word -> say "%s: a tile is" word; Error word
  | None when List.exists ((<>) (List.hd clearances)) clearances ->
    not_proved "the tiles have different clearances"
  | None ->
    match merge_tiles (List.map (fun (piece, rows, _, _) -> (piece, rows)) proved) with
    | None -> not_proved "the tiles do not follow each other from one end of an axis to the other"
    | Some rows ->  (* sorted for the hash; no pair is in two tiles *)
      let key r = [ r.object_a; r.triangle_a; r.object_b; r.triangle_b ] in
      let rows = List.sort (fun r s -> List.compare Z.compare (key r) (key s)) rows in
      say "proved: the list with the hash %s is right and complete%s, %d pairs of %d tiles"
        (hash_of has_self rows) (clearance_text (List.hd clearances)) (List.length rows)
        (List.length proved);
      Ok ()

let usage = "usage: farcull-check-verified CERTIFICATE SCENE [CERTIFICATE SCENE]...\n\
             or: farcull-check-verified --tiles CERTIFICATE... SCENE"
let () =
  let run check =
    let failed status text = Printf.eprintf "farcull-check-verified: %s\n%!" text; status in
    try status_of (check ()) with
    | Bad text | Json.Bad text | Sys_error text -> failed 2 text
    | Stack_overflow -> failed 4 "the stack is too small (ulimit -s)"
    | Out_of_memory -> failed 4 "there is too little memory" in
  let one certificate scene = run (fun () -> Result.map ignore (check_file scene certificate)) in
  let rec each worst = function
    | certificate :: scene :: rest -> each (max worst (one certificate scene)) rest
    | _ -> worst in
  match List.tl (Array.to_list Sys.argv) with
  | "--tiles" :: (_ :: _ :: _ as files) ->
    let scene, certificates = List.hd (List.rev files), List.rev (List.tl (List.rev files)) in
    exit (run (fun () -> check_tiles scene certificates))
  | _ :: _ as files when List.length files mod 2 = 0 -> exit (each 0 files)
  | _ -> prerr_endline usage; exit 2
