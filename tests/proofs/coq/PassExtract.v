(** Writes the model as OCaml, for replay.ml. Natural numbers become those of OCaml. *)
From Coq Require Import ExtrOcamlBasic ExtrOcamlNatInt.
Require Import Passes.
Extraction "passes.ml" do_step quick plain tested.
