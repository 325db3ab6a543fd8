#!/usr/bin/env bash
# Tests of the report.
#   tests/experiments/report/run.sh PROGRAM FIXTURE NAME
# Runs test_NAME.py. Status 77: Debian's Python lacks what they need.
set -euo pipefail

python=/usr/bin/python3
if ! "$python" -c 'import pandas, matplotlib, pytest' 2>/dev/null; then
  echo "$python has no pandas, matplotlib or pytest (Debian: python3-pandas python3-matplotlib python3-pytest)"
  exit 77
fi
export FARCULL_PROGRAM=$1 FARCULL_REPORT_FIXTURE=$2 PYTHONDONTWRITEBYTECODE=1
cd "$(dirname -- "${BASH_SOURCE[0]}")"
exec "$python" -m pytest -q -p no:cacheprovider --durations=5 "test_$3.py"
