(* Reads a certificate from JSON. Accepts only the form that docs/certificate.md describes. *)
exception Bad of string
let bad format = Printf.ksprintf (fun text -> raise (Bad text)) format

type t = Object of (string * t) list | Array of t list | String of string | Number of string | Null | Truth

let deepest = 8

let parse most_values text =
  let at = ref 0 and values = ref 0 in
  let stop what = bad "not JSON at byte %d: %s" (!at + 1) what in
  let peek () = if !at < String.length text then text.[!at] else '\000' in
  let next () = let c = peek () in incr at; c in
  let rec space () = match peek () with ' ' | '\t' | '\n' | '\r' -> incr at; space () | _ -> () in
  let word w value =
    String.iter (fun c -> if next () <> c then stop "a word") w; value in
  let digits () =
    let from = !at in
    while peek () >= '0' && peek () <= '9' do incr at done;
    if !at = from then stop "a digit is missing" in
  let number () =
    let from = !at in
    if peek () = '-' then incr at;
    if peek () = '0' then incr at else digits ();
    if peek () = '.' then (incr at; digits ());
    if peek () = 'e' || peek () = 'E' then begin
      incr at;
      if peek () = '+' || peek () = '-' then incr at;
      digits ()
    end;
    let shown = String.sub text from (!at - from) in
    if Float.is_integer (float_of_string shown) || Float.abs (float_of_string shown) < infinity
    then Number shown else stop "a number that is too large" in
  (* One character of UTF-8, as in table 3-7 of the Unicode standard. *)
  let utf8 out first =
    let more low high =
      let c = Char.code (next ()) in
      if c < low || c > high then stop "a string that is not UTF-8";
      Buffer.add_char out (Char.chr c) in
    let any () = more 0x80 0xbf in
    let c = Char.code first in
    Buffer.add_char out first;
    if c < 0x80 then ()
    else if c >= 0xc2 && c <= 0xdf then any ()
    else if c = 0xe0 then (more 0xa0 0xbf; any ())
    else if c = 0xed then (more 0x80 0x9f; any ())
    else if c >= 0xe1 && c <= 0xef then (any (); any ())
    else if c = 0xf0 then (more 0x90 0xbf; any (); any ())
    else if c >= 0xf1 && c <= 0xf3 then (any (); any (); any ())
    else if c = 0xf4 then (more 0x80 0x8f; any (); any ())
    else stop "a string that is not UTF-8" in
  let hex4 () =
    let value = ref 0 in
    for _ = 1 to 4 do
      let c = next () in
      let digit = match c with
        | '0' .. '9' -> Char.code c - 48 | 'a' .. 'f' -> Char.code c - 87
        | 'A' .. 'F' -> Char.code c - 55 | _ -> stop "four hexadecimal digits" in
      value := 16 * !value + digit
    done;
    !value in
  let escape out = match next () with
    | ('"' | '\\' | '/') as c -> Buffer.add_char out c
    | 'b' -> Buffer.add_char out '\b' | 'f' -> Buffer.add_char out '\012'
    | 'n' -> Buffer.add_char out '\n' | 'r' -> Buffer.add_char out '\r'
    | 't' -> Buffer.add_char out '\t'
    | 'u' ->
      let u = hex4 () in
      let u =
        if u >= 0xdc00 && u <= 0xdfff then stop "half a character"
        else if u < 0xd800 || u > 0xdbff then u
        else begin
          if next () <> '\\' || next () <> 'u' then stop "half a character";
          let low = hex4 () in
          if low < 0xdc00 || low > 0xdfff then stop "half a character";
          0x10000 + ((u - 0xd800) lsl 10) + (low - 0xdc00)
        end in
      Buffer.add_utf_8_uchar out (Uchar.of_int u)
    | _ -> stop "an escape" in
  let string () =
    let out = Buffer.create 64 in
    let rec more () =
      if !at >= String.length text then stop "a string without an end";
      match next () with
      | '"' -> Buffer.contents out
      | '\\' -> escape out; more ()
      | c when c < ' ' -> stop "a control character"
      | c -> utf8 out c; more () in
    more () in
  let counted () = incr values; if !values > most_values then bad "more values than any certificate has" in
  let rec value depth =
    space (); counted ();
    let inner = depth + 1 in
    let enter () = if depth = deepest - 1 then bad "nested deeper than any certificate is" in
    match next () with
    | '{' -> enter (); space (); if peek () = '}' then (incr at; Object []) else members inner []
    | '[' -> enter (); space (); if peek () = ']' then (incr at; Array []) else elements inner []
    | '"' -> String (string ())
    | 't' -> word "rue" Truth
    | 'f' -> word "alse" Truth
    | 'n' -> word "ull" Null
    | '-' | '0' .. '9' -> decr at; number ()
    | _ -> decr at; stop "no value"
  and members depth found =
    space ();
    if next () <> '"' then stop "a key is missing";
    let key = string () in
    if List.mem_assoc key found then bad "the key '%s' occurs twice" key;
    space ();
    if next () <> ':' then stop "a colon is missing";
    let found = (key, value depth) :: found in
    space ();
    match next () with
    | ',' -> members depth found
    | '}' -> Object (List.rev found)
    | _ -> stop "a comma is missing"
  and elements depth found =
    let found = value depth :: found in
    space ();
    match next () with
    | ',' -> elements depth found
    | ']' -> Array (List.rev found)
    | _ -> stop "a comma is missing" in
  if String.length text >= 3 && String.sub text 0 3 = "\xef\xbb\xbf" then at := 3;
  let root = value 0 in
  space ();
  if !at <> String.length text then stop "more text than one value";
  root

let member key = function
  | Object members -> (try List.assoc key members with Not_found -> bad "%s is missing" key)
  | _ -> bad "%s has no object around it" key
let text = function String s -> s | _ -> bad "a string is missing"
let whole = function
  | Number s when String.for_all (fun c -> c >= '0' && c <= '9') s
               && Z.lt (Z.of_string s) (Z.shift_left Z.one 64) -> Z.of_string s
  | _ -> bad "no whole number from 0 to 2^64 - 1"

(* ---- the form ---- *)

let is_text v = ignore (text v)
let is_count v = ignore (whole v)
let is_length = function
  | Number s when float_of_string s >= 0. && float_of_string s < infinity -> ()
  | _ -> bad "no finite number of 0 or more"
let is_hex size v =
  let hex c = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') in
  if String.length (text v) <> size || not (String.for_all hex (text v))
  then bad "not %d lower-case hexadecimal digits" size
let has keys = function
  | Object members ->
    List.iter (fun (key, test) ->
        match List.assoc_opt key members with None -> bad "%s is missing" key | Some v -> test v) keys;
    if List.length members <> List.length keys then bad "a key is unknown"
  | _ -> bad "an object is missing"
let every test = function Array l -> List.iter test l | _ -> bad "an array is missing"

let base64 v =
  let s = text v in
  let length = String.length s in
  if length mod 4 <> 0 then bad "evidence is not base64";
  let padding = if length = 0 || s.[length - 1] <> '=' then 0 else if s.[length - 2] <> '=' then 1 else 2 in
  let six i = match s.[i] with
    | 'A' .. 'Z' as c -> Char.code c - 65 | 'a' .. 'z' as c -> Char.code c - 71
    | '0' .. '9' as c -> Char.code c + 4 | '+' -> 62 | '/' -> 63
    | '=' when i >= length - padding -> 0
    | _ -> bad "evidence is not base64" in
  let out = Bytes.create (length / 4 * 3) in
  for block = 0 to length / 4 - 1 do
    let bits = ref 0 in
    for i = 0 to 3 do bits := (!bits lsl 6) lor six (4 * block + i) done;
    for i = 0 to 2 do
      Bytes.set out (3 * block + i) (Char.chr ((!bits lsr (16 - 8 * i)) land 255))
    done
  done;
  let size = Bytes.length out - padding in
  for i = size to Bytes.length out - 1 do
    if Bytes.get out i <> '\000' then bad "evidence has bits after its end"
  done;
  Bytes.sub_string out 0 size

let version root = match member "version" root with
  | Number (("3" | "4" | "5") as v) -> int_of_string v
  | _ -> bad "version is not 3, 4 or 5"
let clearance root =
  if version root = 3 then 0.
  else match member "clearance" root with Number s -> float_of_string s | _ -> 0.

(* The tile of a certificate of version 5: its axis and its two ends. null: unbounded. *)
let is_place = function
  | Null -> ()
  | Number s when Float.abs (float_of_string s) < infinity -> ()
  | _ -> bad "no finite number and not null"
let tile root =
  if version root < 5 then None
  else
    let tile = member "tile" root in
    let place key = match member key tile with Number s -> Some (float_of_string s) | _ -> None in
    Some (text (member "axis" tile), place "from", place "to")
let is_axis v = if not (List.mem (text v) [ "x"; "y"; "z" ]) then bad "axis is not x, y or z"

let certificate text_of_file =
  let root = parse 10_000 text_of_file in
  if text (member "format" root) <> "farcull-certificate" then bad "format is not farcull-certificate";
  let version = version root in
  let is_clearance v = is_length v; if version = 4 && clearance root = 0. then bad "clearance is 0" in
  let counts keys = has (List.map (fun key -> (key, is_count)) keys) in
  let texts keys = has (List.map (fun key -> (key, is_text)) keys) in
  has ((if version > 3 then [ "clearance", is_clearance ] else [])
       @ (if version = 5 then [ "tile", has [ "axis", is_axis; "from", is_place; "to", is_place ] ] else []) @ [
        "format", is_text; "version", is_count;
        "scene", has [ "name", is_text; "objects", is_count; "triangles", is_count; "hash", is_hex 16 ];
        "not_asked", counts [ "objects"; "pairs" ];
        "claims", counts [ "box_pairs"; "kept"; "culled"; "separated"; "neighbours"; "meeting" ];
        "list_sha256", is_hex 64;
        "unattested", has [
          "method", is_text; "resolution", is_count; "radius_px", is_length; "offset", is_text;
          "views", every (has [ "name", is_text; "width", is_count; "height", is_count;
                                "radius_px", is_length ]);
          "device", (function Null -> () | v -> texts [ "vendor"; "renderer"; "version"; "glsl" ] v);
          "assumptions", every is_text ];
        "evidence", (fun v -> ignore (base64 v)) ]) root;
  (match tile root with
   | Some (_, Some from, Some to_) when to_ < from -> bad "tile.to is less than tile.from"
   | _ -> ());
  root
