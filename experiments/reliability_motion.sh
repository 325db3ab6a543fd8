#!/usr/bin/env bash
# The promise on moving scenes of full size. far-pairs, i-collide and FAR with both offsets run on every frame of every built-in
# scene that moves, and the accounting decides every pair of each frame. It fails if a pair is missed. Each scene has a record in
# build/reliability-motion/; a scene whose record is there does not run again. Remove the folder to begin again.
#
#   bash experiments/reliability_motion.sh                     all scenes, 100 frames each: hours on two cores
#   FRAMES=10 bash experiments/reliability_motion.sh cloth     one scene, ten frames
# Without a GPU the native canvas draws; DEVICE=software (or another --device) asks for GL.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"
farcull_setup
farcull_build farcull
bash experiments/meshes.sh

frames=${FRAMES:-100}
methods=${METHODS:-far-pairs,i-collide,far}
scenes=("$@")
if ((${#scenes[@]} == 0)); then
  mapfile -t scenes < <(build/farcull scenes --json - | awk -F'"' '$2 == "name" { name = $4 } /"moves": true/ { print name }')
fi
# The name of a record contains the commit, so that the record of another commit is not reused.
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
out=build/reliability-motion
mkdir -p "$out"
failed=()
for scene in "${scenes[@]}"; do
  record="$out/$scene.$frames.$methods.$commit"
  if [[ -s $record.json ]]; then
    echo "$scene: done before, see $record.txt"
    continue
  fi
  if build/farcull experiment family "$scene" --methods "$methods" --frames "$frames" --csv "$record.csv" \
    ${DEVICE:+--device "$DEVICE"} \
    --json "$record.json" >"$record.txt"; then
    cat "$record.txt"
  else
    failed+=("$scene")
    cat "$record.txt"
    rm -f "$record.json"
  fi
done
if ((${#failed[@]})); then
  printf 'reliability in motion: a pair was missed, or a run failed: %s\n' "${failed[@]}" >&2
  exit 1
fi
echo "reliability in motion: no pair was missed; all records are in $out/"
