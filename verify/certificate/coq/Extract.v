(** Translates the checker into OCaml. Coq's integers become integers of zarith. *)
From Coq Require Import ExtrOcamlBasic ExtrOcamlZBigInt.
Require Import Checker.
Extraction "checker.ml" check keep everything merge_tiles.
