#!/usr/bin/env bash
# Measures the promise on large inputs. Each form prints a table, keeps its records in a folder of build/, and fails if a pair is
# missed or an answer is wrong.
#   bash experiments/reliability.sh [SCENE...]             build/reliability: FAR with both offsets is compared with the method exact
#     on the packaged scenes, at resolutions 64 to 2048; with fewer resolutions copies of the scenes as well: moved by 1e6 along the
#     diagonal, scaled by 1e-6 and 1e6, and with a ground a thousand times larger. It also prints how many pairs are at risk (lost
#     with 0.9 of the radius). About half an hour on two cores without a GPU.
#   bash experiments/reliability.sh pairs [SCENE...]       build/reliability-pairs: far-pairs at 32 to 4096 px, in one view, in three,
#     and as the scene decides, by both back ends, on packaged meshes, on needles and inside objects. --list prints all scenes. The
#     back ends are the cores of the CPU and Mesa's software device; DEVICE=hardware asks for another second one.
#   bash experiments/reliability.sh motion [SCENE...]      build/reliability-motion: far-pairs, i-collide and FAR with both offsets on
#     every frame of every built-in scene that moves (FRAMES=100, METHODS); the accounting decides every pair of each frame. Hours.
#   bash experiments/reliability.sh distances [SCENE...]   build/reliability-distances: distances of every built-in scene, with the
#     second half of its objects moved away by 0, 1e-12, 1e-3, 1 and 1e3 diagonals of the scene, and of 100,000 small random scenes
#     (`random`; RANDOM_SCENES). Each is compared with the truth in rational numbers (tests/experiments/method/distance_truth.h), to
#     the bit. An hour or two on one core.
# motion and distances skip what has a record of this commit; remove the folder to begin again. Without a GPU the native canvas
# draws; DEVICE=software (or another --device) asks for GL.
set -euo pipefail

form=meshes
case ${1-} in pairs | motion | distances)
  form=$1
  shift
  ;;
esac
# Scenes of far-pairs with their options.
pairs_runs=(
  "two-bunnies" "two-bunnies@far" "two-bunnies@ground" "armadillo-elephant" "dragon-bunny" "near-copy"
  "needles" "needles@far" "needles-layers" "needles-crossed" "random-soup" "degenerate" "crowd" "field:100000"
  "crumpled:20000" "rope:20000" "spheres:40000" "fans:8000"
  "mannequin-devil --self" "armadillo --self" "bunny --self" "degenerate --self" "two-spheres --clearance 0.01"
)
if [[ $form == pairs && ${1-} == --list ]]; then
  printf '%s\n' "${pairs_runs[@]}"
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
# Records have the commit in their names, so that those of another commit are not reused.
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
device=(${DEVICE:+--device "$DEVICE"})

# mesh_scene SCENE: FAR on a scene and its copies.
mesh_scene() {
  local scene copy resolutions methods boxes
  for copy in "" @far @tiny @huge @ground; do
    scene=$1$copy resolutions=128,1024 methods=far,exact
    if [[ -z $copy ]]; then resolutions=64,128,256,512,1024,2048 methods=far,cullide,exact; fi
    for boxes in objects triangles; do
      # Few triangles are drawn after boxes of triangles, so the same pairs may be at risk in finer pixels.
      if [[ $boxes == triangles ]]; then resolutions=128,1024 methods=far,exact; fi
      build/farcull compare "$scene" --methods "$methods" --offsets obb,exact --resolutions "$resolutions" \
        --boxes $boxes "${device[@]}" --json "$out/$scene.$boxes.json" || failed+=("$scene")
      risk_of "$scene" $boxes "$resolutions"
    done
  done
}

# risk_of SCENE BOXES RESOLUTIONS: prints how many pairs are at risk. Where there are none, "0 missed" does not show that the radius
# is large enough.
risk_of() {
  local risk='' offset resolution lost
  for offset in obb exact; do
    for resolution in ${3//,/ }; do
      lost=$(build/farcull run "$1" --method far --offset $offset --resolution "$resolution" --radius 0.9 --boxes "$2" \
        "${device[@]}" --json - | sed -nE 's/^ *"false_negatives": ([0-9]+),?$/\1/p') || true
      risk+=" $offset $resolution px ${lost:-?},"
    done
  done
  printf 'at risk at 0.9 of the radius, boxes of %s:%s\n\n' "$2" "${risk%,}"
}

# pairs_run SCENE [OPTIONS]: far-pairs by both back ends.
pairs_run() {
  local on views resolutions record
  for on in cpu "${DEVICE:-software}"; do
    if [[ $on == native ]]; then continue; fi # that is cpu
    for views in auto z x,y,z; do
      resolutions=auto
      if [[ $views != auto ]]; then resolutions=32,128,512,2048,4096; fi
      # The accounting of the box-hostile scenes decides tens of millions of pairs each time.
      if [[ $1 == needles-* && $views != auto ]]; then resolutions=128; fi
      record="$out/${*// /_}"
      record="${record// /_}.$on.${views//,/}.json"
      # A row ends in: resolution, objects, triangles, candidates, colliding, (+ and neighbours,) missed, two times.
      build/farcull compare "$@" --methods far-pairs --device "$on" --views "$views" --resolutions "$resolutions" --json "$record" |
        awk -v run="$*" -v device="$on" -v views="$views" '/^method / { colliding = /neighbours/ ? 5 : 3 }
          $1 == "far-pairs" && $2 == "-" {
            pairs = $(NF - colliding); candidates = $(NF - colliding - 1)
            row = sprintf("%-30s %-9s %-6s %11s %11s %10s", run, device, views, $(NF - colliding - 4), candidates, pairs)
            gsub(",", "", pairs); gsub(",", "", candidates)
            printf "%s %12s %7s\n", row, (pairs > 0 ? sprintf("%.2f", candidates / pairs) : "-"), $(NF - 2)
          }' || failed+=("$* $on $views")
    done
  done
}

# moving_scene SCENE: all frames by METHODS.
moving_scene() {
  local frames=${FRAMES:-100} methods=${METHODS:-far-pairs,i-collide,far}
  local record="$out/$1.$frames.$methods.$commit"
  if [[ -s $record.json ]]; then
    echo "$1: done before, see $record.txt"
    return
  fi
  build/farcull experiment family "$1" --methods "$methods" --frames "$frames" --csv "$record.csv" "${device[@]}" \
    --json "$record.json" >"$record.txt" || {
    failed+=("$1")
    rm -f "$record.json"
  }
  cat "$record.txt"
}

# ask_distances WORDS...: prints the rows, from the record or by running the program.
ask_distances() {
  local words="$*"
  local record="$out/${words// /-}.$commit"
  if [[ -s $record ]]; then
    cat "$record"
  elif build/tests/farcull_distance_reliability "$@" | tee "$record.part"; then
    mv "$record.part" "$record"
  else
    failed+=("$words") # its record stays unfinished, and is not reused
  fi
}

# distances_of SCENE: the distances of a scene moved apart; or of `random`, in parts, each with a record.
distances_of() {
  local count=${RANDOM_SCENES:-100000} first step diagonals
  if [[ $1 == random ]]; then
    step=$((count < 10000 ? count : 10000))
    for ((first = 0; first < count; first += step)); do
      ask_distances random "$first" $((count - first < step ? count - first : step))
    done
    return
  fi
  for diagonals in 0 1e-12 1e-3 1 1e3; do
    ask_distances "$1" "$diagonals"
    # One object cannot be moved apart.
    if [[ $diagonals == 0 ]] && grep -q '| itself |' "$out/$1-0.$commit" 2>/dev/null; then break; fi
  done
}

scenes=("$@")
case $form in
  meshes)
    if ((!$#)); then scenes=(two-bunnies armadillo-elephant dragon-bunny near-copy bunnies-far-apart); fi
    for scene in "${scenes[@]}"; do mesh_scene "$scene"; done
    ;;
  pairs)
    if ((!$#)); then scenes=("${pairs_runs[@]}"); fi
    printf '%-30s %-9s %-6s %11s %11s %10s %12s %7s\n' scene device views resolution candidates colliding cand./coll. missed
    for run in "${scenes[@]}"; do
      read -ra words <<<"$run"
      pairs_run "${words[@]}"
    done
    ;;
  motion)
    if ((!$#)); then
      mapfile -t scenes < <(build/farcull scenes --json - | awk -F'"' '$2 == "name" { name = $4 } /"moves": true/ { print name }')
    fi
    for scene in "${scenes[@]}"; do moving_scene "$scene"; done
    ;;
  distances)
    if ((!$#)); then
      mapfile -t scenes < <(build/farcull scenes --json - | awk -F'"' '$2 == "name" { print $4 }')
      scenes+=(random)
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
