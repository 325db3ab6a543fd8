#!/usr/bin/env bash
# Compares the product with independent oracles in exact arithmetic, on random scenes (tests/oracles):
#   bash tests/oracles.sh [LINE...] [--scenes N] [--seed S]
# Below each line stand the faults that were planted into the answers, and how many of them it found. Needs the build folder
# with farcull and farcull_python; FARCULL_BUILD names another one than build. Exit status 1: an answer is wrong, or a planted
# fault was not found.
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
build=$(realpath "${FARCULL_BUILD:-build}")
export PYTHONPATH=$build/python:tests PYTHONDONTWRITEBYTECODE=1 FARCULL_PROGRAM=$build/farcull
exec /usr/bin/python3 -m oracles "$@"
