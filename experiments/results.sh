#!/usr/bin/env bash
# Makes a page of docs/results with its figures: installs what is missing, builds, measures (or continues where an earlier call
# ended), makes the report, and copies page, figures and pictures into docs/results.
#   bash experiments/results.sh [OPTIONS]            studies.md: every study of `farcull experiment all`. About twenty minutes on
#                                                    two cores without a GPU; the page was measured on such a machine.
#   bash experiments/results.sh headline [OPTIONS]   headline.md: the figure and the table of README.md and of the paper. Minutes.
#   bash experiments/results.sh cloth [OPTIONS]      cloth.md: 500 frames of a cloth of 20,000 triangles at each of four
#                                                    stiffnesses, every frame accounted for pair by pair by boxes, and every
#                                                    tenth by far. Hours on one core. --quick: 200 triangles, 12 frames, seconds.
#   bash experiments/results.sh proximity [OPTIONS]  proximity.md: potential neighbour sets, what a grid loses of them, and the
#                                                    distances of libraries (docs/experiments.md). Minutes on one core.
#   bash experiments/results.sh stages [SCENE...]    stages.md: what each stage of FAR takes away and costs, on 19 scenes.
# OPTIONS are those of `farcull experiment`. With --quick, headline, cloth and proximity copy nothing. A measurement can be ended at
# any time. The same call continues it, but simulates a cloth again from its start. Each commit has a store of its own under build/,
# since a store refuses rows of another commit.
# Exit status: 0; 1 if a method that promises missed a pair or lost a neighbour, or a distance was not exact; 2 if the measurements
# did not complete.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"

study=all page=studies title="Results of the studies"
if [[ ${1-} == headline || ${1-} == cloth || ${1-} == proximity ]]; then
  study=$1 page=$1 title="Results of the study $1"
  shift
fi
farcull_setup
farcull_build farcull
if [[ ${1-} == stages ]]; then
  bash experiments/meshes.sh
  exec /usr/bin/python3 experiments/report/stages.py build/farcull docs/results/stages.md docs/results/figures/stages.svg "${@:2}"
fi
commit=$(build/farcull --version)
commit=${commit##* }
out=build/results-$commit
case $study in
  all | headline) bash experiments/meshes.sh || echo "results: points on packaged meshes will be left out" ;;&
  all) ;;
  *) out=build/$study/$commit ;;
esac
quick=
if [[ $study != all && " $* " == *" --quick "* ]]; then quick=yes; fi
if [[ $quick ]]; then out+=-quick; fi
status=0
build/farcull experiment "$study" --out "$out" --resume "$@" || status=$?
if ((status > 1)); then exit "$status"; fi
build/farcull report "$out"
# The page of one study is copied only if all points of the full size were measured and no promise was broken.
if [[ $study == all ]] || { ((status == 0)) && [[ ! $quick ]]; }; then
  call=${0##*/}
  if [[ $study != all ]]; then call+=" $study"; fi
  farcull_keep_report "$page" "$title" "$out/report" "$call"
  if [[ $study == headline ]]; then
    for copy in README.md docs/paper.md; do  # these files have the table of the page
      awk -v head='^[|] method [|] two-bunnies' 'NR == FNR { on = $0 ~ head || (on && /^[|]/); if (on) table = table $0 "\n"; next }
        $0 ~ head { printf "%s", table; old = 1 } old && /^[|]/ { next } { old = 0; print }' docs/results/headline.md "$copy" >"$out/copy"
      cat "$out/copy" >"$copy"
    done
  fi
fi
exit "$status"
