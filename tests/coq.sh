#!/usr/bin/env bash
# What Coq proves. The checker of certificates (docs/verified.md): its build, verify/certificate/coq/build.sh, lets Coq check the
# proof and then makes build/farcull-check-verified, unless the build of farcull has just done so. Here its verdicts are compared
# with those of `farcull check`. Culling (docs/model.md and docs/proofs.md):
# the passes for any number of items, whose model is extracted and replays runs of core/cull, and the heart of lemmas 1, 3 and 16
# over the reals. Prints the theorems and the axioms that they need: none but, for the last three, those of Coq's reals. Changes one
# rule or inequality at a time, which must break the proof.
#   bash tests/coq.sh                    all of this; it installs Coq and OCaml where they are missing: ten minutes
#   bash tests/coq.sh --long             the same with 10,000 random scenes, and the proofs of Gappa checked by Coq
#   bash tests/coq.sh --built FOLDER     for ctest: in a folder that is built; skipped (77) where Coq or OCaml is missing,
#                                        and without the changes
# Exit status: 0; 1 the proof, a verdict or a change is not as it must be; 2 it could not build; 77 skipped.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../experiments/setup.sh"
cd "$farcull_root"
build=build scenes=60 mutants=yes gappa=no
case ${1-} in
  --built) build=$2 scenes=20 mutants=no ;;
  --long) scenes=10000 gappa=yes ;;
esac
if [[ ${1-} != --built ]]; then
  farcull_packages+=(coq ocaml-nox ocaml-findlib libzarith-ocaml-dev python3)
  if [[ $gappa == yes ]]; then farcull_packages+=(gappa libcoq-gappa); fi
  farcull_setup
  farcull_build farcull
  if [[ $gappa == yes ]]; then farcull_build farcull_proofs; fi
fi
for tool in coqc ocamlfind ocamlopt python3; do
  if ! command -v "$tool" >/dev/null; then echo "coq: NOT RUN, $tool is missing" && exit 77; fi
done
if ! ocamlfind query zarith >/dev/null 2>&1; then echo "coq: NOT RUN, zarith is missing" && exit 77; fi

work=$build/coq culling=$build/coq/culling checker=$build/verify/verified
rm -rf "${work:?}"
mkdir -p "$culling"
cp tests/proofs/coq/*.v tests/proofs/coq/*.ml "$culling"
echo "coq: $(coqc --version | head -n 1)"
if ! sh verify/certificate/coq/build.sh "$checker" >"$work/build.log" 2>&1; then
  cat "$work/build.log"
  echo "coq: the proved checker is not built" && exit 1
fi
cp "$checker/farcull-check-verified" "$build/farcull-check-verified.new"
mv "$build/farcull-check-verified.new" "$build/farcull-check-verified"
wc -l "$checker"/{Spec,Checker,Geometry,Points,Descent,Pairs,Scaling,Proofs}.v "$culling"/*.v | sed "s|$build/||"
cat "$checker/Proofs.log"
echo "coq: $build/farcull-check-verified is built, and its proof holds"
if grep -nE '^ *(Axiom|Parameter|Hypothesis|Conjecture|Admitted)|admit\.|Unset Guard|bypass_check' "$culling"/*.v; then
  echo "coq: the proof assumes something" && exit 1
fi
# Lets Coq check the files of a folder in this order: check FOLDER AXIOMS FILES. Prints the theorems; AXIOMS is a pattern for the
# names of the axioms that they may need.
check() {
  local folder=$1 axioms=$2 file said
  shift 2
  for file in "$@"; do
    if ! (cd "$folder" && coqc -q "$file.v") >"$folder/$file.log" 2>&1; then
      cat "$folder/$file.log"
      echo "coq: $file.v is not accepted" && exit 1
    fi
    if ! grep -q '^Print Assumptions' "$folder/$file.v"; then continue; fi
    cat "$folder/$file.log"
    said=$(grep -cE '^(Closed under the global context|Axioms:)$' "$folder/$file.log")
    if [[ $said != $(grep -c '^Print Assumptions' "$folder/$file.v") ]] ||
      awk '/^Closed/ { on = 0; next } /^Axioms:$/ { on = 1; next } on && /^[^ ]/ { print $1 }' "$folder/$file.log" |
      grep -vxE "$axioms"; then
      echo "coq: a theorem of $file.v needs other axioms" && exit 1
    fi
  done
}
check "$culling" none Passes PassProofs PassExtract
check "$culling" 'ClassicalDedekindReals\.sig_(forall|not)_dec|FunctionalExtensionality\.functional_extensionality_dep' Fan View

# Runs of core/cull, replayed by the model of the passes.
if [[ -x $build/tests/farcull_tests ]]; then
  (cd "$culling" && ocamlfind ocamlopt -w -a passes.mli passes.ml replay.ml -o replay)
  FARCULL_MODEL_TRIALS=4000 FARCULL_MODEL_DUMP=$culling/runs "$build/tests/farcull_tests" \
    --gtest_filter=CullModel.AgreesWithCullStepByStep >"$culling/runs.log"
  "$culling/replay" <"$culling/runs"
  if "$culling/replay" twin <"$culling/runs"; then echo "coq: the twin of the replay agrees with core/cull" && exit 1; fi
else
  echo "coq: NOT RUN: the replay of core/cull, since $build/tests/farcull_tests is not built"
fi

python3 -B tests/verify/certificate/verified_test.py compare "$build/farcull" "$build/farcull-check-verified" "$work/scenes" "$scenes"
if [[ $mutants == yes ]]; then
  # A checker whose proof does not hold is not built, and one that was there before is gone.
  for twin in 's/(0 <? total w)/(0 <=? total w)/' 's/^Proof. symmetry. apply Sorting.Permuted_sort. Qed.$/Admitted./'; do
    rm -rf "$work/twin"
    mkdir -p "$work/twin/made"
    cp verify/certificate/coq/* "$work/twin"
    cp "$build/farcull-check-verified" "$work/twin/made"
    sed -i "$twin" "$work/twin"/*.v
    if sh "$work/twin/build.sh" "$work/twin/made" >"$work/twin/log" 2>&1 || [[ -e $work/twin/made/farcull-check-verified ]]; then
      echo "coq: a checker without a proof was built: $twin" && exit 1
    fi
    if grep -q 'not found\|Syntax error' "$work/twin/log"; then cat "$work/twin/log" && exit 1; fi
  done
  python3 -B tests/verify/certificate/verified_test.py mutants "$checker" "$work/mutants"
  python3 -B tests/verify/certificate/verified_test.py mutants "$culling" "$culling/mutants"
fi
if [[ $gappa == yes ]]; then python3 -B tests/proofs/coq/gappa.py "$build/tests/farcull_proofs" "$work/gappa"; fi
