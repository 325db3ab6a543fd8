#!/usr/bin/env bash
# The promise of far-pairs. It runs at 32 to 4096 px, in one view, in three, and as the scene decides, by both back ends, on packaged
# meshes, on needles and inside objects. It prints a row for each run (candidates, colliding pairs, their quotient, missed), keeps the
# records in build/reliability-pairs/, and fails if a pair is missed. `bash experiments/reliability_pairs.sh needles` runs one scene;
# --list prints all. The back ends are the cores of the CPU and Mesa's software device; DEVICE=hardware asks for another second one.
set -euo pipefail

# A scene with its options.
runs=(
  "two-bunnies" "two-bunnies@far" "two-bunnies@ground" "armadillo-elephant" "dragon-bunny" "near-copy"
  "needles" "needles@far" "needles-layers" "needles-crossed" "random-soup" "degenerate" "crowd" "field:100000"
  "crumpled:20000" "rope:20000" "spheres:40000" "fans:8000" "funnel"
  "mannequin-devil --self" "armadillo --self" "bunny --self" "degenerate --self" "two-spheres --clearance 0.01"
)
if [[ ${1-} == --list ]]; then
  printf '%s\n' "${runs[@]}"
  exit 0
fi
if (($#)); then runs=("$@"); fi

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"
farcull_setup
farcull_build farcull
bash experiments/meshes.sh

out=build/reliability-pairs
mkdir -p "$out"
failed=()
printf '%-30s %-9s %-6s %11s %11s %10s %12s %7s\n' scene device views resolution candidates colliding cand./coll. missed
for run in "${runs[@]}"; do
  read -ra words <<<"$run"
  scene=${words[0]}
  for device in cpu "${DEVICE:-software}"; do
    if [[ $device == native ]]; then continue; fi # that is cpu
    for views in auto z x,y,z; do
      resolutions=auto
      if [[ $views != auto ]]; then resolutions=32,128,512,2048,4096; fi
      # The accounting of the box-hostile scenes decides tens of millions of pairs each time.
      if [[ $scene == needles-* && $views != auto ]]; then resolutions=128; fi
      record="$out/${run// /_}.$device.${views//,/}.json"
      # A row ends in: resolution, objects, triangles, candidates, colliding, (+ and neighbours,) missed, two times.
      build/farcull compare "${words[@]}" --methods far-pairs --device "$device" --views "$views" --resolutions "$resolutions" \
        --json "$record" |
        awk -v run="$run" -v device="$device" -v views="$views" '/^method / { colliding = /neighbours/ ? 5 : 3 }
          $1 == "far-pairs" && $2 == "-" {
            pairs = $(NF - colliding); candidates = $(NF - colliding - 1)
            row = sprintf("%-30s %-9s %-6s %11s %11s %10s", run, device, views, $(NF - colliding - 4), candidates, pairs)
            gsub(",", "", pairs); gsub(",", "", candidates)
            printf "%s %12s %7s\n", row, (pairs > 0 ? sprintf("%.2f", candidates / pairs) : "-"), $(NF - 2)
          }' || failed+=("$run $device $views")
    done
  done
done
if ((${#failed[@]})); then
  printf 'reliability of pairs: missed, or a run failed: %s\n' "${failed[@]}" >&2
  exit 1
fi
echo "reliability of pairs: none was missed; all records are in $out/"
