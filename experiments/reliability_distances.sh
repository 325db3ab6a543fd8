#!/usr/bin/env bash
# Distances of every built-in scene, with the second half of its objects moved away by 0, 1e-12, 1e-3, 1 and 1e3 diagonals of the scene,
# and of 100,000 small random scenes. Each is compared with the truth in rational numbers (tests/experiments/method/distance_truth.h).
# It prints a row for each question, and fails if an answer differs in a bit or a nearest pair is missed. The rows are kept in
# build/reliability-distances/; what is there does not run again. Remove the folder to begin again.
#
#   bash experiments/reliability_distances.sh                  everything: an hour or two on one core
#   bash experiments/reliability_distances.sh needles random   one scene, and the random ones
#   RANDOM_SCENES=1000 bash experiments/reliability_distances.sh random
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"
farcull_setup
farcull_build farcull farcull_distance_reliability
bash experiments/meshes.sh

scenes=("$@")
if ((${#scenes[@]} == 0)); then
  mapfile -t scenes < <(build/farcull scenes --json - | awk -F'"' '$2 == "name" { print $4 }')
  scenes+=(random)
fi
# The name of a record contains the commit, so that the record of another commit is not reused.
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
out=build/reliability-distances
mkdir -p "$out"
failed=()

# ask WORDS...: prints the rows, from the record or by running the program.
ask() {
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

cat <<'END'
| scene | moved by, diagonals | question | answers | unequal | nearest pairs | missed | distances in rationals | s |
|---|---:|---|---:|---:|---:|---:|---:|---:|
END
for scene in "${scenes[@]}"; do
  if [[ $scene == random ]]; then
    # In parts, each of which has a record.
    count=${RANDOM_SCENES:-100000}
    step=$((count < 10000 ? count : 10000))
    for ((first = 0; first < count; first += step)); do
      ask random "$first" $((count - first < step ? count - first : step))
    done
    continue
  fi
  for diagonals in 0 1e-12 1e-3 1 1e3; do
    ask "$scene" "$diagonals"
    # One object cannot be moved apart.
    if [[ $diagonals == 0 ]] && grep -q '| itself |' "$out/$scene-0.$commit" 2>/dev/null; then break; fi
  done
done
if ((${#failed[@]})); then
  printf 'reliability of distances: a wrong answer, or a run failed: %s\n' "${failed[@]}" >&2
  exit 1
fi
echo "reliability of distances: all answers are right; all rows are in $out/"
