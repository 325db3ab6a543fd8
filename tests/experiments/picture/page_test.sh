#!/usr/bin/env bash
# The page of `farcull picture --html` in headless Chromium without a network: what it shows, every
# control, and faults that have to be caught.
#   tests/experiments/picture/page_test.sh FARCULL_BINARY
# FARCULL_PAGE_SHOTS=FOLDER keeps screenshots at three widths, light and dark.
set -uo pipefail

# shellcheck source-path=SCRIPTDIR source=../script_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../script_lab.sh" picture.page chromium python3
farcull=$(realpath -- "$1")
here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
cd "$work" || exit 2

"$farcull" picture two-tori --compare cullide,far,exact --resolutions 32,256,512 --size 400x340 \
  --html tori.html >said 2>errors
status=$?
if grep -q 'three.js' errors; then
  echo "picture.page: NOT RUN: the program was built without three.js (experiments/setup.sh installs it)"
  exit 77
fi
((status == 0)) || { cat errors >&2; exit 1; }
"$farcull" picture two-spheres --compare cullide:64,far-pairs --frames 3:6 --size 200x160 \
  --html spheres.html >said-of-frames || exit 1
"$farcull" run two-tori --method exact --no-verify --pairs pairs.csv >/dev/null || exit 1
PYTHONDONTWRITEBYTECODE=1 python3 "$here/page_test.py" tori.html said pairs.csv spheres.html said-of-frames || exit 1
