#!/usr/bin/env bash
# Tests of the Python module.
#   tests/experiments/python/run.sh PYTHON BUILD_FOLDER SOURCE_FOLDER NAME
# Runs test_NAME.py with the module of the build folder. Status 77: PYTHON lacks what they need.
set -euo pipefail

python=$1 build=$2 source=$3 name=$4
if ! "$python" -c 'import numpy, pytest, hypothesis' 2>/dev/null; then
  echo "$python has no numpy, pytest or hypothesis (Debian: python3-numpy python3-pytest python3-hypothesis)"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export PYTHONPATH=$build/python PYTHONDONTWRITEBYTECODE=1
export FARCULL_PROGRAM=$build/farcull FARCULL_ROOT=$source
"$python" -m pytest -q -p no:cacheprovider --rootdir="$work" --durations=5 -s \
  "$source/tests/experiments/python/test_$name.py"
