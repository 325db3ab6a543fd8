#!/bin/sh
# Builds the proved checker, but only if its proof holds. Coq checks Proofs.v and prints the axioms that the theorems use;
# no axiom is allowed. Then Coq translates Checker.v into OCaml, which is compiled together with the reader of certificates.
#   build.sh FOLDER     makes FOLDER/farcull-check-verified; needs coqc, ocamlfind and zarith. FOLDER/Proofs.log has the theorems.
#                       Does nothing if FOLDER has a program made from the same files.
set -eu
from=$(cd "$(dirname -- "$0")" && pwd)
mkdir -p "$1"
cd "$1"
same=yes
for file in "$from"/*.v "$from"/*.ml "$from/build.sh"; do
  cmp -s "$file" "${file##*/}" || same=no
done
if [ $same = yes ] && [ -x farcull-check-verified ]; then exit 0; fi
rm -f farcull-check-verified
cp "$from"/*.v "$from"/*.ml "$from/build.sh" .

# These words make Coq accept a theorem without a proof, so no file may contain them.
if grep -nE '^ *(Axiom|Parameter|Hypothesis|Conjecture|Admitted)|admit\.|Unset Guard|bypass_check' ./*.v; then
  echo "build.sh: the proof assumes something" >&2
  exit 1
fi
for file in Spec Checker Geometry Points Descent Pairs Scaling; do coqc -q "$file.v"; done
coqc -q Proofs.v >Proofs.log
if [ "$(grep -cx 'Closed under the global context' Proofs.log)" != "$(grep -c '^Print Assumptions' Proofs.v)" ]; then
  cat Proofs.log
  echo "build.sh: a theorem needs an axiom" >&2
  exit 1
fi
coqc -q Extract.v
# -w -a disables warnings, since Coq generates most of the code.
ocamlfind ocamlopt -package zarith -linkpkg -inline 100 -w -a checker.mli checker.ml json.ml main.ml -o farcull-check-verified.new
mv farcull-check-verified.new farcull-check-verified
