#!/usr/bin/env bash
# What far-pairs asks of a GL device per view: dispatches and readbacks on the first frame and on a later one,
# for each built-in scene, as the table of docs/results/device-work.md.
#   bash experiments/device_work.sh                      all built-in scenes, some minutes
#   bash experiments/device_work.sh two-tori needles     these
#     --seconds N   a scene that takes longer is left out by name; default 120
# It needs the program and the tests: cmake --build build --target farcull farcull_gl_tests -j 2
# Exit status: 0; 1 a view asked more than the bound; 2 there is no such scene, or the tests are not built.
set -euo pipefail

seconds=120
scenes=()
while [ $# -gt 0 ]; do
  case $1 in
    --seconds) seconds=${2:?--seconds: how many}; shift ;;
    -h | --help) sed -n '2,/^set/p' "$0" | sed '/^set/d; s/^# \{0,1\}//'; exit 0 ;;
    *) scenes+=("$1") ;;
  esac
  shift
done
repository=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
tests=$repository/build/tests/farcull_gl_tests
for needed in "$repository/build/farcull" "$tests"; do
  if [ ! -x "$needed" ]; then
    echo "device_work.sh: $needed is not there: cmake --build build --target farcull farcull_gl_tests -j 2" >&2
    exit 2
  fi
done
if [ ${#scenes[@]} -eq 0 ]; then
  mapfile -t scenes < <("$repository/build/farcull" scenes | sed -n '2,/^$/p' | awk 'NF { print $1 }')
fi

status=0
echo "| scene | first frame | later frames | pairs reported |"
echo "|---|---|---|---|"
for scene in "${scenes[@]}"; do
  out=$(FARCULL_DEVICE_WORK=$scene timeout "$seconds" "$tests" --gtest_filter=GlPairs.AskForFewDispatchesAndReadbacks 2>&1) &&
    found=0 || found=$?
  row=$(grep '^| ' <<< "$out" || true)
  if [ "$found" -eq 124 ]; then
    echo "| \`$scene\` | left out: more than $seconds s | | |"
  elif [ -z "$row" ]; then
    echo "device_work.sh: $scene: $(tail -n 3 <<< "$out")" >&2
    exit 2
  else
    echo "$row"
    if [ "$found" -ne 0 ]; then
      grep -A 2 'Failure$' <<< "$out" >&2 || true
      status=1
    fi
  fi
done
exit $status
