(* farcull-check-verified CERTIFICATE SCENE: reads both files, calls the checker that Checker.v
   defines and Proofs.v proves, and prints its verdict. This file is trusted: it turns bytes into
   the values of Spec.v, and a verdict into a line. SCENE holds the words that `farcull check
   --verified` writes: 64 bits each, lowest byte first. docs/certificate.md describes the
   certificate. Exit status as of `farcull check`: 0 proved; 1 refuted or not proved; 2 a file that
   cannot be read; 3 the checker could not decide a pair. *)
module Integer = Z
open Checker
module Z = Integer  (* zarith's; the checker has a Z of its own *)

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
(* The first 32 bits after the point of the square or cube root of n, by integers. *)
let fraction power n =
  let wanted = Z.shift_left (Z.of_int n) (32 * power) in
  Z.to_int (Z.logand (Z.root wanted power) (Z.of_int 0xffffffff))
let constants = Array.of_list (List.map (fraction 3) primes)
let start = Array.sub (Array.of_list (List.map (fraction 2) primes)) 0 8

let sha256 text =
  let length = String.length text in
  let zeros = (119 - length mod 64) mod 64 in
  let tail = Bytes.make (1 + zeros + 8) '\000' in
  Bytes.set tail 0 '\x80';
  Bytes.set_int64_be tail (1 + zeros) (Int64.of_int (8 * length));
  let padded = text ^ Bytes.unsafe_to_string tail in
  let mask = 0xffffffff in
  let right x n = ((x lsr n) lor (x lsl (32 - n))) land mask in
  let state = Array.copy start and w = Array.make 64 0 in
  for block = 0 to String.length padded / 64 - 1 do
    for i = 0 to 15 do
      w.(i) <- Int32.to_int (String.get_int32_be padded (64 * block + 4 * i)) land mask
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
  done;
  String.concat "" (List.map (Printf.sprintf "%08x") (Array.to_list state))

let fnv1a text =
  let hash = ref 0xcbf29ce484222325L in
  String.iter (fun c ->
      hash := Int64.mul (Int64.logxor !hash (Int64.of_int (Char.code c))) 0x100000001b3L) text;
  Printf.sprintf "%016Lx" !hash

(* ---- the scene ---- *)

(* The double as an odd integer times a power of two; zero as 0. *)
let double_of word =
  let x = Int64.float_of_bits word in
  match classify_float x with
  | FP_nan | FP_infinite -> bad "the scene has a coordinate that is not finite"
  | FP_zero -> { mantissa = Z.zero; exponent = Z.zero }
  | FP_normal | FP_subnormal ->
    let fraction, exponent = Float.frexp x in
    let whole = Z.of_float (Float.ldexp fraction 53) in
    let zeros = Z.trailing_zeros whole in
    { mantissa = Z.shift_right whole zeros; exponent = Z.of_int (exponent - 53 + zeros) }

(* Up to which difference boxes count as near. farcull rounds the difference of two doubles, and
   compares it with the clearance. The rounded one is at most the clearance if the exact one is at
   most half way to the next double; if the last bit of the clearance is 1, half way rounds up. Any
   reach that is not below the clearance is right; this one gives the pairs that the bytes are for. *)
let reach_of clearance =
  if clearance = 0. then ({ mantissa = Z.zero; exponent = Z.zero }, false)
  else
    let bits = Int64.bits_of_float clearance in
    let exponent = max 1 (Int64.to_int (Int64.shift_right_logical bits 52)) - 1075 in
    let whole = Z.of_float (Float.ldexp clearance (- exponent)) in
    ({ mantissa = Z.succ (Z.mul (Z.of_int 2) whole); exponent = Z.of_int (exponent - 1) },
     Z.is_odd whole)

let scene_of bytes =
  let at = ref 0 in
  let word () =
    if !at + 8 > String.length bytes then bad "the scene is too short";
    at := !at + 8;
    String.get_int64_le bytes (!at - 8) in
  let many f n =  (* f () n times, in a list in this order *)
    let rec more n done_ = if n = 0 then List.rev done_ else more (n - 1) (f () :: done_) in
    more n [] in
  let number limit =
    let n = word () in
    if Int64.compare n 0L < 0 || Int64.compare n limit >= 0 then bad "the scene has a wrong size";
    Int64.to_int n in
  let sizes = many (fun () -> number 0x200000000L) (number 0x100000000L) in
  let point () =
    let x = double_of (word ()) in
    let y = double_of (word ()) in
    let z = double_of (word ()) in
    { x; y; z0 = z } in
  let triangle () =
    let p1 = point () in
    let p2 = point () in
    let p3 = point () in
    { p1; p2; p3 } in
  let scene = List.rev (List.rev_map (fun size ->
      { self = size land 0x100000000 <> 0; triangles = many triangle (size land 0xffffffff) }) sizes) in
  if !at <> String.length bytes then bad "the scene is too long";
  scene

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
  let claims = Json.member "claims" root and unasked = Json.member "not_asked" root in
  { box_pairs = number_of claims "box_pairs"; kept_pairs = number_of claims "kept";
    culled = number_of claims "culled"; separated_pairs = number_of claims "separated";
    neighbour_pairs = number_of claims "neighbours"; meeting = number_of claims "meeting";
    unasked_objects = number_of unasked "objects"; unasked_pairs = number_of unasked "pairs" }

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

let check_files certificate scene =
  let text = read_file certificate and words = read_file scene in
  let root = Json.certificate text in
  let bytes = Json.base64 (Json.member "evidence" root) in
  let s = scene_of words in
  Printf.printf "verified   certificate sha256 %s\n" (sha256 text);
  Printf.printf "verified   scene       sha256 %s\n" (sha256 words);
  let key = Json.member "scene" root in
  let triangles = List.fold_left (fun n ob -> n + List.length ob.triangles) 0 s in
  let not_proved text = Printf.printf "verified   not proved: %s\n" text; 1 in
  if not (Z.equal (number_of key "objects") (Z.of_int (List.length s)))
  || not (Z.equal (number_of key "triangles") (Z.of_int triangles))
  || Json.text (Json.member "hash" key) <> fnv1a words
  then not_proved "the certificate is of another scene"
  else
    let evidence =
      let rec from i found = if i < 0 then found else from (i - 1) (evidence_of (Char.code bytes.[i]) :: found) in
      from (String.length bytes - 1) [] in
    let clearance = Json.clearance root in
    let reach, less = reach_of clearance in
    match check s (double_of (Int64.bits_of_float clearance)) reach less (claims_of root) evidence with
    | Refuted (r, f) -> Printf.printf "verified   refuted: %s: %s\n" (reason f) (pair r); 1
    | Unproved (r, f) -> not_proved (reason f ^ ": " ^ pair r)
    | Wrong_count -> not_proved "a count is wrong"
    | Too_short -> not_proved "the evidence is too short"
    | Bad_reach -> bad "the clearance is negative or not finite"
    | Too_long -> not_proved "the evidence is too long"
    | Undecided r -> Printf.printf "verified   undecided: %s\n" (pair r); 3
    | Proved rows ->
      let hash = sha256 (list_text (List.exists (fun ob -> ob.self) s) rows) in
      if hash <> Json.text (Json.member "list_sha256" root)
      then not_proved ("the certificate is of another list of pairs; that of the scene is " ^ hash)
      else (Printf.printf "verified   proved: the list with the hash %s is right and complete, %d pairs\n" hash
              (List.length rows); 0)

let () =
  match Sys.argv with
  | [| _; certificate; scene |] ->
    (try exit (check_files certificate scene) with
     | Bad text | Json.Bad text -> Printf.eprintf "farcull-check-verified: %s\n" text; exit 2
     | Sys_error text -> Printf.eprintf "farcull-check-verified: %s\n" text; exit 2)
  | _ -> prerr_endline "usage: farcull-check-verified CERTIFICATE SCENE"; exit 2
