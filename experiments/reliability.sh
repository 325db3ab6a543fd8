#!/usr/bin/env bash
# Tests on large inputs that no pair is missed. Each form of the command prints a table and writes records to a folder in build/.
# The exit status is 1 if a pair is missed, an answer is wrong, or a run fails.
#   bash experiments/reliability.sh [SCENE...]             build/reliability: compares FAR (both offsets) with the method exact on
#     packaged scenes, at resolutions 64 to 2048. Also compares copies of the scenes at fewer resolutions. The copies are moved by
#     1e6 along the diagonal, scaled by 1e-6, scaled by 1e6, or have a ground a thousand times larger. The column "at risk" counts
#     pairs that are missed with 0.9 of the radius. Takes about half an hour on two cores without a GPU.
#   bash experiments/reliability.sh boxes [SCENE...]       build/reliability-boxes: tests the method boxes on packaged meshes, on
#     needles and on objects with themselves. The accounting tests every pair. --list prints all scenes.
#   bash experiments/reliability.sh motion [SCENE...]      build/reliability-motion: tests boxes, i-collide and FAR (both offsets)
#     on every frame of every built-in scene that moves (variables FRAMES=100, METHODS). The accounting tests every pair. Hours.
#   bash experiments/reliability.sh distances [SCENE...]   build/reliability-distances: computes distances in each built-in scene,
#     after moving half of its objects by 0, 1e-12, 1e-3, 1 and 1e3 diagonals of the scene. Each distance must equal, to the bit,
#     the exact result in rational numbers (tests/experiments/method/distance_truth.h). Takes one or two hours on one core.
# motion and distances skip runs that have a record of this commit. Remove the folder to start again. Without a GPU, the cores of
# the CPU draw. DEVICE=software (or another value of --device) selects a device.
set -euo pipefail

form=meshes
case ${1-} in boxes | motion | distances)
  form=$1
  shift
  ;;
esac
# The default scenes of the form `boxes`, with their options.
boxes_runs=(
  "two-bunnies" "two-bunnies@far" "two-bunnies@ground" "armadillo-elephant" "dragon-bunny" "near-copy"
  "needles" "needles@far" "needles-layers" "needles-crossed" "random-soup" "degenerate" "crowd" "field:100000"
  "crumpled:20000" "spheres:40000" "cad-cut:8000" "funnel"
  "mannequin-devil --self" "armadillo --self" "bunny --self" "degenerate --self" "two-spheres --clearance 0.01"
)
if [[ $form == boxes && ${1-} == --list ]]; then
  printf '%s\n' "${boxes_runs[@]}"
  exit 0
fi

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"
farcull_setup
programs=(farcull)
if [[ $form == distances ]]; then programs+=(farcull_distance_reliability); fi
farcull_build "${programs[@]}"
bash experiments/meshes.sh

out=build/reliability
if [[ $form != meshes ]]; then out+=-$form; fi
mkdir -p "$out"
failed=()
# The names of records contain the commit, so that records of another commit are not reused.
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
device=(${DEVICE:+--device "$DEVICE"})

# mesh_scene SCENE: compares FAR with the method exact on a scene and its copies.
mesh_scene() {
  local scene copy resolutions methods phase
  for copy in "" @far @tiny @huge @ground; do
    scene=$1$copy resolutions=128,1024 methods=far,exact
    if [[ -z $copy ]]; then resolutions=64,128,256,512,1024,2048 methods=far,cullide,exact; fi
    for phase in objects triangles; do
      # The broad phase over triangles leaves few triangles to draw, so two resolutions are enough.
      if [[ $phase == triangles ]]; then resolutions=128,1024 methods=far,exact; fi
      build/farcull compare "$scene" --methods "$methods" --offsets obb,exact --resolutions "$resolutions" \
        --broad-phase $phase "${device[@]}" --repeat 1 --json "$out/$scene.$phase.json" || failed+=("$scene")
    done
  done
}

# boxes_run SCENE [OPTIONS]: runs the method boxes on the scene and prints a row.
boxes_run() {
  local record="$out/${*// /_}"
  record="${record// /_}.json"
  build/farcull compare "$@" --methods boxes --repeat 1 --json "$record" --csv - |
    awk -F, -v run="$*" 'NR == 1 { for (k = 1; k <= NF; ++k) at[$k] = k }
      NR == 2 {
        pairs = $at["colliding"]
        printf "%-30s %11s %10s %12s %7s\n", run, $at["candidates"], pairs,
          (pairs > 0 ? sprintf("%.2f", $at["candidates"] / pairs) : "-"), $at["missed"]
      }' || failed+=("$*")
}

# moving_scene SCENE: runs each of the METHODS on the scene and prints a row. A method can have options (far --offset exact).
moving_scene() {
  local frames=${FRAMES:-100} method record
  while read -r method; do
    record="$out/$1.$frames.${method// /_}.$commit"
    if [[ ! -s $record ]]; then
      # shellcheck disable=SC2086 # the method's options are words
      build/farcull verify "$1" --method $method --frames "$frames" "${device[@]}" --json "$record.part" >/dev/null || {
        failed+=("$1 --method $method")
        continue
      }
      mv "$record.part" "$record"
    fi
    awk -F'[:,]' -v run="$1, $method" '/"candidate_pairs"/ { candidates += $2 } /"all_colliding_pairs"/ { pairs += $2 }
      /"missed"/ { missed = $2 } END { printf "%-50s %15d %13d %7d\n", run, candidates, pairs, missed }' "$record"
  done < <(tr , '\n' <<<"${METHODS:-boxes,i-collide,far,far --offset exact}")
}

# distances_of SCENE: prints distances after half of the objects were moved. Reuses records of earlier runs.
distances_of() {
  local diagonals record
  for diagonals in 0 1e-12 1e-3 1 1e3; do
    record=$out/$1-$diagonals.$commit
    if [[ -s $record ]]; then
      cat "$record"
    elif build/tests/farcull_distance_reliability "$1" "$diagonals" | tee "$record.part"; then
      mv "$record.part" "$record"
    else
      failed+=("$1 $diagonals") # the record stays unfinished, and is not reused
    fi
    # A scene of one object has no half to move, so only one run is needed.
    if [[ $diagonals == 0 ]] && grep -q '| itself |' "$record" 2>/dev/null; then break; fi
  done
}

scenes=("$@")
case $form in
  meshes)
    if ((!$#)); then scenes=(two-bunnies armadillo-elephant dragon-bunny near-copy bunnies-far-apart); fi
    for scene in "${scenes[@]}"; do mesh_scene "$scene"; done
    ;;
  boxes)
    if ((!$#)); then scenes=("${boxes_runs[@]}"); fi
    printf '%-30s %11s %10s %12s %7s\n' scene candidates colliding cand./coll. missed
    for run in "${scenes[@]}"; do
      read -ra words <<<"$run"
      boxes_run "${words[@]}"
    done
    ;;
  motion)
    if ((!$#)); then
      mapfile -t scenes < <(build/farcull scenes --json - | awk -F'"' '$2 == "name" { name = $4 } /"moves": true/ { print name }')
    fi
    printf '%-50s %15s %13s %7s\n' "scene, method" candidates colliding missed
    for scene in "${scenes[@]}"; do moving_scene "$scene"; done
    ;;
  distances)
    if ((!$#)); then
      mapfile -t scenes < <(build/farcull scenes --json - | awk -F'"' '$2 == "name" { print $4 }')
    fi
    cat <<'END'
| scene | moved by, diagonals | question | answers | unequal | nearest pairs | missed | distances in rationals | s |
|---|---:|---|---:|---:|---:|---:|---:|---:|
END
    for scene in "${scenes[@]}"; do distances_of "$scene"; done
    ;;
esac
if ((${#failed[@]})); then
  printf 'reliability (%s): a pair was missed, an answer is wrong, or a run failed: %s\n' "$form" "${failed[*]}" >&2
  exit 1
fi
echo "reliability ($form): no pair was missed, no answer was wrong; all records are in $out/"
