#!/usr/bin/env bash
# The proved checker of certificates (docs/verified.md): lets Coq check its proof, prints the theorems and the axioms that they
# need, of which there must be none, extracts the program build/farcull-check-verified, compares its verdicts with those of
# `farcull check`, and changes inequalities of the checker, each of which must break the proof.
#   bash tests/coq.sh                    all of this; it installs Coq and OCaml where they are missing: ten minutes
#   bash tests/coq.sh --long             the same with 10,000 random scenes
#   bash tests/coq.sh --built FOLDER     for ctest: in a folder that is built; skipped (77) where Coq or OCaml is missing,
#                                        and without the changes
# Exit status: 0; 1 the proof, a verdict or a change is not as it must be; 2 it could not build; 77 skipped.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../experiments/setup.sh"
cd "$farcull_root"
build=build scenes=60 mutants=yes
case ${1-} in
  --built) build=$2 scenes=20 mutants=no ;;
  --long) scenes=10000 ;;
esac
if [[ $build == build ]]; then
  farcull_packages+=(coq ocaml-nox ocaml-findlib libzarith-ocaml-dev python3)
  farcull_setup
  farcull_build farcull
fi
for tool in coqc ocamlfind ocamlopt python3; do
  if ! command -v "$tool" >/dev/null; then echo "coq: NOT RUN, $tool is missing" && exit 77; fi
done
if ! ocamlfind query zarith >/dev/null 2>&1; then echo "coq: NOT RUN, zarith is missing" && exit 77; fi

work=$build/coq
mkdir -p "$work"
rm -rf "${work:?}"/*
cp verify/certificate/coq/*.v verify/certificate/coq/*.ml "$work"
echo "coq: $(coqc --version | head -n 1)"
wc -l "$work"/{Spec,Checker,DistanceChecker,Geometry,Points,Descent,Pairs,Proofs,Distances}.v | sed "s|$work/||"
if grep -nE '^ *(Axiom|Parameter|Hypothesis|Conjecture|Admitted)|admit\.|Unset Guard|bypass_check' "$work"/*.v; then
  echo "coq: the proof assumes something" && exit 1
fi
if ! python3 -c 'import sys; page, spec = (open(f, encoding="utf-8").read() for f in sys.argv[1:])
sys.exit("".join("    " + line if line.strip() else line for line in spec.splitlines(True)) not in page)' \
  docs/verified.md "$work/Spec.v"; then
  echo "coq: docs/verified.md does not quote Spec.v as it is" && exit 1
fi
for file in Spec Checker Geometry Points Descent Pairs Proofs DistanceChecker Distances; do
  if ! (cd "$work" && coqc -q "$file.v") >"$work/$file.log" 2>&1; then
    cat "$work/$file.log"
    echo "coq: $file.v is not accepted" && exit 1
  fi
done
cat "$work"/{Proofs,Distances}.log
if [[ $(cat "$work"/{Proofs,Distances}.log | grep -c '^Closed under the global context$') != 5 ]]; then
  echo "coq: a theorem needs axioms" && exit 1
fi
if ! sh verify/certificate/coq/build.sh "$work/program" >"$work/ocaml.log" 2>&1; then
  cat "$work/ocaml.log"
  exit 2
fi
cp "$work/program/farcull-check-verified" "$build/farcull-check-verified.new"
mv "$build/farcull-check-verified.new" "$build/farcull-check-verified"
echo "coq: built $build/farcull-check-verified"

python3 -B tests/verify/certificate/verified_test.py compare "$build/farcull" "$build/farcull-check-verified" "$work/scenes" "$scenes"
if [[ $mutants == yes ]]; then python3 -B tests/verify/certificate/verified_test.py mutants "$work" "$work/mutants"; fi
