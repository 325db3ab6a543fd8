#!/usr/bin/env bash
# The program built without OpenGL: what needs none answers as always, and the rest says why not.
#   tests/experiments/command/cli_without_gl_test.sh WITHOUT_GL [WITH_GL]
# WITHOUT_GL must not refer to OpenGL at all; WITH_GL, where it is given, is the twin that does.
set -euo pipefail

program=$1 twin=${2:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "cli_without_gl_test: $1" >&2
  exit 1
}

# Whether the program refers to functions of GL.
# (The list is read to its end: what stops nm early would fail the whole line.)
refers_to_gl() { grep -q 'epoxy_' <<<"$(nm -u "$1")"; }

if command -v nm >/dev/null; then
  ! refers_to_gl "$program" || fail "$program refers to OpenGL"
  [[ -z $twin ]] || refers_to_gl "$twin" || fail "no reference to OpenGL is seen in $twin either"
fi

"$program" verify two-spheres --method far --resolution 128 >"$work/far" 2>&1 ||
  fail "far does not run: $(<"$work/far")"
"$program" verify two-spheres --method far-pairs >"$work/pairs" 2>&1 ||
  fail "far-pairs does not run: $(<"$work/pairs")"
"$program" doctor --device native >"$work/doctor" 2>&1 || fail "doctor: $(<"$work/doctor")"

# refused ARGUMENTS...: exit status 2, and the message says why and what to do.
refused() {
  local status=0
  "$program" "$@" >"$work/out" 2>"$work/err" || status=$?
  ((status == 2)) || fail "$*: exit status $status"
  grep -q 'built without OpenGL; use --device native, or build it with -DFARCULL_GL=ON' \
    "$work/err" || fail "$*: $(<"$work/err")"
}
for device in software hardware gl 0; do
  refused run two-spheres --method far --device "$device"
  refused run two-spheres --method far-pairs --device "$device"
done
refused distance two-spheres --voronoi published --device gl
refused picture two-spheres -o "$work/picture.png"
