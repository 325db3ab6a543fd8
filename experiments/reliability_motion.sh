#!/usr/bin/env bash
# The promise in motion, at full size: FAR with both offsets and far-pairs on every frame of every built-in scene that moves,
# each frame accounted for pair by pair. Fails where a pair is missed.
# Keeps a record a scene in build/reliability-motion/ and goes on where it was interrupted; remove the folder to begin again.
#
#   bash experiments/reliability_motion.sh                     all scenes, 100 frames each: hours on a software rasterizer
#   FRAMES=10 bash experiments/reliability_motion.sh cloth     one scene, ten frames
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
# Of these sources: what another commit found is not taken for done.
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
    --json "$record.json" >"$record.txt"; then
    cat "$record.txt"
  else
    failed+=("$scene")
    cat "$record.txt"
    rm -f "$record.json"
  fi
done
if ((${#failed[@]})); then
  printf 'reliability in motion: missed, or a run failed: %s\n' "${failed[@]}" >&2
  exit 1
fi
echo "reliability in motion: none was missed; all records are in $out/"
