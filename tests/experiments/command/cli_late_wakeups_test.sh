#!/usr/bin/env bash
# Runs on Mesa's llvmpipe where every thread but the first one waits a moment before it wakes those
# that wait for a fence (docs/drivers.md). Without threads of llvmpipe, which is what the program
# asks for, answers are those of any other run. The twin has one such thread; it touches a fence that
# was freed, which ends the process with status 66, or waits for ever.
#   tests/experiments/command/cli_late_wakeups_test.sh FARCULL_BINARY LIBRARY
# LIBRARY is tests/core/gl/late_wakeups.cpp. Needs bash, Debian's essential tools and a software device
# of Mesa. Exit status 77: the device is not llvmpipe.
set -uo pipefail

if [[ $# -ne 2 || ! -x $1 || ! -e $2 ]]; then
  echo "usage: cli_late_wakeups_test.sh FARCULL_BINARY LIBRARY" >&2
  exit 2
fi
program=$(realpath -- "$1")
library=$(realpath -- "$2")
work=$(mktemp -d) || exit 2
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT

unset LP_NUM_THREADS
# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

for method in far far-pairs; do
  run=(run two-spheres --method "$method" --device software --no-verify)
  settings=()
  good "$method" 0 "${run[@]}" --pairs pairs.csv --json r.json
  if ! grep -q '"renderer": ".*llvmpipe' r.json; then
    echo "late wakeups: not run: the software device is $(sed -n 's/^ *"renderer": //p' r.json)"
    exit 77
  fi
  expect "$method draws without threads" r.json '^ *"threads": 0'
  settings=("LD_PRELOAD=$library")
  good "$method, late" 0 "${run[@]}" --pairs late.csv --json late.json
  cmp -s pairs.csv late.csv || fail "$method, late" 'the pairs differ'
  expect "$method, late: it promises" late.json '^ *"promises": true'
done

# Only far has a twin: llvmpipe's fences are of draws, and far-pairs draws nothing.
settings+=(LP_NUM_THREADS=1)
launch run two-spheres --method far --device software --no-verify
((cases += 1))
((status == 66 || status == 124)) || fail 'far, late, with a thread' "ended with status $status"

if ((failed)); then
  echo "cli_late_wakeups_test: $failed of $cases cases failed"
  exit 1
fi
echo "cli_late_wakeups_test: $cases cases, none failed"
