#!/usr/bin/env bash
# The folder that experiments/pack.sh makes: it is small, its program runs with nothing but what is in it, and
# its hardware.sh begins.
#   tests/experiments/pack_test.sh BUILD_FOLDER
set -uo pipefail

build=$(realpath "${1:?the build folder}")
shift
# shellcheck source-path=SCRIPTDIR source=script_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/script_lab.sh" pack_test strip ldd tar gzip
root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)

# The scripts beside a build folder that is elsewhere, with one mesh in place of all, which is quicker.
mkdir -p "$work/tree/build/meshes"
cp -r "$root/experiments" "$work/tree/"
ln -s "$build/farcull" "$work/tree/build/farcull"
echo "exit 0" >"$work/tree/experiments/meshes.sh"
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >"$work/tree/build/meshes/one.off"
bash "$work/tree/experiments/pack.sh" --built "$work/there" >"$work/said" 2>&1 || fail "pack: $(<"$work/said")"
size=$(du -sk "$work/there" | cut -f 1)
# All packaged meshes have 9.8 MiB before they are compressed.
((size + 9800 < 60 * 1024)) || fail "the folder has $size KiB"
mkdir "$work/other"
echo notes >"$work/other/notes"
if bash "$work/tree/experiments/pack.sh" --built "$work/other" >"$work/said" 2>&1; then fail "a foreign folder was taken"; fi
grep -q 'this script did not make it' "$work/said" || fail "a foreign folder: $(<"$work/said")"

# A budget of no time: everything is unpacked, and the probes have none.
rm -rf "$work/tree"
env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME="$work" bash "$work/there/hardware.sh" --device native --minutes 0 >"$work/said" 2>&1
(($? == 2)) || fail "hardware.sh: $(<"$work/said")"
grep -q 'farcull doctor --device native has no result' "$work/said" || fail "hardware.sh: $(<"$work/said")"
packed=$work/there/farcull
env -i PATH=/usr/bin:/bin bash "$packed/build/farcull" run two-spheres --method far --device native >"$work/said" 2>&1 ||
  fail "the program: $(tail -n 1 "$work/said")"
grep -q '^colliding  298 pairs' "$work/said" || fail "the program found something else"

# With the loader of the folder, where the system has no libraries: an empty folder hides them.
mkdir "$work/empty" "$work/aside"
# shellcheck disable=SC2016 # the dollars are those of the inner shell
hide='mount --bind "$1" /usr/lib/x86_64-linux-gnu && shift && exec "$@"'
alone() {
  unshare -rm bash -c "$hide" bash "$work/empty" "$packed/build/fallback/ld-linux-x86-64.so.2" --inhibit-cache \
    --library-path "$packed/build/fallback:$packed/build/libraries" \
    "$packed/build/program" run two-spheres --method far --device native --no-verify >"$work/said" 2>&1
}
if unshare -rm bash -c "$hide" bash "$work/empty" "$packed/build/fallback/ld-linux-x86-64.so.2" --inhibit-cache \
  --library-path "$packed/build/fallback" /bin/true 2>"$work/why"; then
  alone || fail "without the system's libraries: $(tail -n 1 "$work/said")"
  # Twin: without one of its own.
  mv "$packed"/build/libraries/libfmt.so* "$work/aside/"
  if alone; then fail "twin: it starts without a library"; fi
  grep -q 'libfmt' "$work/said" || fail "twin: $(tail -n 1 "$work/said")"
else
  echo "not run: the program without the system's libraries ($(tail -n 1 "$work/why"))"
fi

if ((failures)); then exit 1; fi
echo "pack_test: passed, $size KiB"
