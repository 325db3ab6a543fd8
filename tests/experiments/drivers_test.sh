#!/usr/bin/env bash
# experiments/drivers.sh on two drivers that answer soon: one that does nothing, on which no probe may pass, and
# one whose OpenGL is too old. Where Mesa is not there, "not run".
#   tests/experiments/drivers_test.sh FARCULL
set -uo pipefail

program=$(realpath "${1:?the program}")
shift
# shellcheck source-path=SCRIPTDIR source=script_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/script_lab.sh" drivers_test sqlite3
script=$(dirname -- "${BASH_SOURCE[0]}")/../../experiments/drivers.sh

try() { # OPTIONS...: sets $status; the tables are in $work/said
  status=0
  bash "$script" --probes --program "$program" --out "$work/out" "$@" >"$work/said" 2>"$work/err" || status=$?
}
holds() { grep -qE -- "$2" "$1" || fail "no '$2' in: $(head -c 2000 "$1")"; }

if ! GALLIUM_DRIVER=llvmpipe LIBGL_ALWAYS_SOFTWARE=true "$program" run two-spheres --method cullide --device software \
  --no-verify >"$work/said" 2>&1; then
  echo "drivers_test: NOT RUN: $(tail -n 1 "$work/said")"
  exit 77
fi
try softpipe noop
((status == 0)) || fail "status $status: $(tail -n 2 "$work/err")"
holds "$work/said" '^\| softpipe \| .* \| refused: EGL: device [0-9]+: its OpenGL is older than 4.3 core \| - \|( - \|){9}$'
holds "$work/said" '^\| noop \| .* \| NOOP, OpenGL .* \| 0 of [0-9]{2} \|( 0/[0-9]+ \|){9}$'

# Twin: one of its probes passes. What was measured is not measured again.
report=$(find "$work/out" -name doctor.json)
passing=$(grep -c '"pass": true' "$report")
sed -i '/"probes"/,$ s/"pass": false/"pass": true/' "$report"
(($(grep -c '"pass": true' "$report") > passing)) || fail "the report did not change"
try noop
((status == 1)) || fail "twin: status $status"
holds "$work/err" 'a probe passes on a driver that does nothing'

try no-such-driver
((status == 2)) || fail "no such driver: status $status"
holds "$work/err" "'no-such-driver' is none of them; they are: llvmpipe "

if ((failures)); then exit 1; fi
echo "drivers_test: passed"
