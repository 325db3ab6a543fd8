#!/usr/bin/env bash
# Compares the product with independent oracles in exact arithmetic, on random scenes (tests/oracles):
#   bash tests/oracles.sh [LINE...] [--scenes N] [--seed S]
# The lines are the modules of tests/oracles. With 100 scenes or more, below each stand the faults that were planted into the
# answers, and how many of them it found. Needs the targets farcull and farcull_python in the folder build, or in FARCULL_BUILD.
# Exit status 1: an answer is wrong, or a planted fault was not found; 77: Python has no numpy.
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
python=${FARCULL_PYTHON:-/usr/bin/python3}
"$python" -c 'import numpy' 2>/dev/null || exit 77
build=$(realpath "${FARCULL_BUILD:-build}")
export PYTHONPATH=$build/python:tests PYTHONDONTWRITEBYTECODE=1 FARCULL_PROGRAM=$build/farcull
exec "$python" -m oracles "$@"
