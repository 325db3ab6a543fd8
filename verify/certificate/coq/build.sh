#!/bin/sh
# Builds the program of the proved checker: Coq turns Checker.v into OCaml, which is compiled with the reader. The proof is not
# checked here; tests/coq.sh does that.
#   build.sh FOLDER     makes FOLDER/farcull-check-verified; needs coqc, ocamlfind and zarith
set -eu
mkdir -p "$1"
for file in Spec.v Checker.v Extract.v json.ml main.ml; do cp "$(dirname -- "$0")/$file" "$1"; done
cd "$1"
for file in Spec Checker Extract; do coqc -q "$file.v"; done
# Warnings are those of code that Coq has written.
ocamlfind ocamlopt -package zarith -linkpkg -inline 100 -w -a checker.mli checker.ml json.ml main.ml -o farcull-check-verified
