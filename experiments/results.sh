#!/usr/bin/env bash
# Makes a page of docs/results with its figures. Installs missing packages, builds, measures (or continues a measurement), makes
# the report, and copies the page, figures and pictures to docs/results.
#   bash experiments/results.sh [OPTIONS]            studies.md: every study of `farcull experiment all`. Takes about 20 minutes
#                                                    on two cores without a GPU; the page was measured on such a machine.
#   bash experiments/results.sh headline [OPTIONS]   headline.md: the figure and the table of README.md and of the paper. Minutes.
#   bash experiments/results.sh cloth [OPTIONS]      cloth.md: 500 frames of a cloth of 20,000 triangles at each of four
#                                                    stiffnesses. boxes tests every frame and far every tenth frame, with an
#                                                    accounting of all pairs. Hours. --quick: 200 triangles, 12 frames.
#   bash experiments/results.sh proximity [OPTIONS]  proximity.md: potential neighbour sets, the neighbours that a grid misses,
#                                                    and distances of libraries (docs/experiments.md). Minutes on one core.
#   bash experiments/results.sh stages [SCENE...]    stages.md: how much each stage of FAR culls, and its time, on 19 scenes.
# OPTIONS are the options of `farcull experiment`. With --quick, headline, cloth and proximity copy nothing. You can end a
# measurement at any time. The same call continues it, but simulates a cloth again from its start. Each commit has its own store
# under build/, since a store accepts only rows of one commit.
# Exit status: 0; 1 if a method with a guarantee missed a pair or a neighbour, or if a distance was not exact; 2 if the
# measurements were not completed.
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
# The page of one study is copied only if all points of the full size were measured and no guarantee was broken.
if [[ $study == all ]] || { ((status == 0)) && [[ ! $quick ]]; }; then
  call=${0##*/}
  if [[ $study != all ]]; then call+=" $study"; fi
  farcull_keep_report "$page" "$title" "$out/report" "$call"
  if [[ $study == headline ]]; then
    for copy in README.md docs/paper.md; do  # both files contain the table of the page
      awk -v head='^[|] method [|] two-bunnies' 'NR == FNR { on = $0 ~ head || (on && /^[|]/); if (on) table = table $0 "\n"; next }
        $0 ~ head { printf "%s", table; old = 1 } old && /^[|]/ { next } { old = 0; print }' docs/results/headline.md "$copy" >"$out/copy"
      cat "$out/copy" >"$copy"
    done
  fi
fi
exit "$status"
