(** Writes the checker as OCaml. Integers become those of zarith. *)
From Coq Require Import ExtrOcamlBasic ExtrOcamlZBigInt.
Require Import Checker.
Extraction "checker.ml" check keep everything merge_tiles.
