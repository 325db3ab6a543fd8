#!/usr/bin/env bash
# Makes docs/results.md and all its figures: installs what is missing, builds, measures every study
# (or continues where an earlier call ended), makes the report, and copies page, figures and pictures
# into docs/. About twenty minutes on two cores without a GPU; docs/results.md was measured on such a
# machine.
#   bash experiments/results.sh [OPTIONS OF farcull experiment all]
# Exit status: 0; 1 if a method that promises missed a pair; 2 if the measurements did not complete.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"

farcull_setup
farcull_build farcull
bash experiments/meshes.sh || echo "results: points on packaged meshes will be left out"

# Each commit has a store of its own, since a store refuses rows of another commit.
commit=$(build/farcull --version)
out=build/results-${commit##* }
status=0
build/farcull experiment all --out "$out" --resume "$@" || status=$?
if ((status > 1)); then exit "$status"; fi
build/farcull report "$out"
cp "$out"/report/results.md docs/results.md
for kind in figures:svg pictures:png; do
  folder=${kind%:*}
  mkdir -p "docs/$folder" "$out/report/$folder"
  find "$out/report/$folder" -name "*.${kind#*:}" -exec cp -t "docs/$folder" {} +
  for old in "docs/$folder"/*."${kind#*:}"; do
    if [[ ${old##*/} == paper-* ]]; then continue; fi # experiments/paper.sh makes these
    if [[ -e $old && ! -e $out/report/$folder/${old##*/} ]]; then rm "$old"; fi
  done
done
echo "results: made docs/results.md from $out/results.sqlite"
exit "$status"
