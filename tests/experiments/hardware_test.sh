#!/usr/bin/env bash
# experiments/hardware.sh with a program that only pretends to measure: every part is run once, an interrupted
# run goes on, the budget and the limit of the disk leave parts out by name, and what failed is said.
#   tests/experiments/hardware_test.sh
set -uo pipefail

# shellcheck source-path=SCRIPTDIR source=script_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/script_lab.sh" hardware_test flock awk tar
root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)

# A folder in which nothing is installed or built (FARCULL_BUILT). Its program writes down how it was called.
# FAKE_FAIL, FAKE_REFUSE, FAKE_SLEEP: a word of the calls that end with 1, with 2, or take 30 seconds.
tree=$work/tree
mkdir -p "$tree/experiments" "$tree/tests" "$tree/build" "$work/bin"
cp "$root"/experiments/{setup,hardware,reliability}.sh "$tree/experiments/"
echo 'exit 0' >"$tree/experiments/meshes.sh"
echo 'exit 0' >"$tree/tests/run.sh"
cat >"$tree/build/farcull" <<'FAKE'
#!/usr/bin/env bash
said=" $* "
says() { [[ -n $1 && $said == *" $1 "* ]]; }
case "$*" in
  --version) echo "farcull 0.1, commit ${FAKE_COMMIT:-abc}"; exit ;;
  "scenes --json -") printf '"name": "one",\n"moves": true\n"name": "two",\n"moves": false\n'; exit ;;
esac
echo "$*" >>"$CALLS"
if says "${FAKE_SLEEP-}"; then
  trap 'echo "interrupted $*" >>"$CALLS"; exit 143' TERM
  sleep 30 &
  wait
fi
if says "${FAKE_REFUSE-}"; then echo "farcull: no"; exit 2; fi
while (($#)); do
  if [[ $1 == --json ]]; then printf '"gl": {\n"renderer": "A Device (R) 1.0"\n}\n' >"$2"; fi
  if [[ $1 == --out ]]; then mkdir -p "$2" && touch "$2/results.sqlite"; fi
  shift
done
echo "| a table |"
if says "${FAKE_FAIL-}"; then
  echo "farcull: missed 3 pairs"
  exit 1
fi
FAKE
# The report needs a Python with its packages to be there.
printf '#!/bin/sh\n' >"$work/bin/python"
chmod +x "$tree/build/farcull" "$work/bin/python"
export FARCULL_BUILT=yes CALLS=$work/calls PATH=$work/bin:$PATH LC_ALL=C FARCULL_PYTHON=$work/bin/python
out=$work/out
script=$tree/experiments/hardware.sh
measure() { # OPTIONS...: sets $status; what is said is in $work/said
  : >"$CALLS"
  status=0
  bash "$script" --device software --out "$out" "$@" >"$work/said" 2>&1 || status=$?
}
calls() { grep -c -- "$1" "$CALLS"; }
expect() { # CASE STATUS
  if ((status != $2)); then fail "$1: status $status instead of $2: $(tail -n 3 "$work/said")"; fi
}
holds() { grep -qE -- "$3" "$2" || fail "$1: ${2##*/} has no '$3': $(tail -n 3 "$2")"; }
page=$out/a-device-r-1-0.md

# Of a budget that is spent all but the first parts are left out, by name.
FAKE_SLEEP=compare measure --minutes 0.15
expect "no time" 3
holds "no time" "$work/said" 'misses \(missed pairs of two bunnies\): cut off after [0-9]+ s'
holds "no time" "$work/said" 'left out, since the 0.15 minutes are spent, [0-9]+ parts: bench-two-bunnies-[0-9]+ .* field-10000 '
holds "no time" "$work/said" 'report \(of the studies\): left out'
if [[ ! -s $out.tar.gz ]]; then fail "no time: no archive"; fi
(($(calls field) == 0)) || fail "no time: a part was begun"

# No probes, nothing else.
FAKE_REFUSE=doctor bash "$script" --device software --out "$work/none" >"$work/said" 2>&1
(($? == 2)) || fail "no device: $(<"$work/said")"
holds "no device" "$work/said" 'farcull doctor --device software has no result'

# Interrupted in the middle; the child is ended as well.
: >"$CALLS"
FAKE_SLEEP=field:300000 bash "$script" --device software --out "$out" >"$work/said" 2>&1 &
running=$!
for _ in {1..200}; do
  if grep -q 'field:300000' "$CALLS"; then break; fi
  sleep 0.1
done
status=0
bash "$script" --device software --out "$out" >"$work/second" 2>&1 || status=$?
expect "two at once" 2
holds "two at once" "$work/second" 'another program works in'
kill -TERM "$running"
status=0
wait "$running" || status=$?
expect interrupted 143
holds interrupted "$work/said" 'the same command goes on'
(($(calls 'interrupted bench field:300000') == 1)) || fail "interrupted: the child was not"
(($(calls 'bench field:100000 --peers') == 1)) || fail "interrupted: no part before it: $(<"$CALLS")"
(($(calls doctor) == 0)) || fail "interrupted: the probes ran again"

# It goes on: what is done is not measured again. A part fails, another one has no result.
FAKE_FAIL=dragon-bunny FAKE_REFUSE=funnel measure
expect "goes on" 1
(($(calls 'bench field:100000 --peers') == 0)) || fail "goes on: a part that was done ran again"
(($(calls 'bench field:300000 --peers') == 1)) || fail "goes on: the part that was interrupted did not run"
holds "goes on" "$work/said" 'FAILED: reliability-dragon-bunny'
holds "goes on" "$work/said" 'bench-funnel-[0-9]+ .*: status 2: farcull: no'
holds "goes on" "$page" '[1-9] failed: .*reliability-dragon-bunny'
holds "goes on" "$page" '^# A Device \(R\) 1.0$'
for part in doctor misses suite bench-two-bunnies field-10000000 reliability-near-copy motion-one \
  bench-spheres studies report; do
  compgen -G "$out/steps/$part*" >/dev/null || fail "goes on: $part is not done"
done
holds "goes on" "$CALLS" 'experiment all --devices software,native --resume --out .*/out/results$'
tar -tzf "$out.tar.gz" >"$work/list"
holds archive "$work/list" '^out/a-device-r-1-0.md$'
holds archive "$work/list" '^out/logs/doctor.txt$'

# Once more: only what had no result, and what failed is still said.
measure
expect "once more" 1
(($(calls funnel) > 0)) || fail "once more: what had no result did not run"
(($(calls dragon-bunny) == 0)) || fail "once more: what failed ran again"

# The twin: the script without its memory.
# shellcheck disable=SC2016 # the dollars are those of the script
sed 's/if \[\[ -e \$out\/steps\/\$name \]\]; then return 0; fi/:/' "$tree/experiments/hardware.sh" >"$tree/experiments/twin.sh"
script=$tree/experiments/twin.sh
measure
(($(calls 'bench field:100000 --peers') == 1)) || fail "twin: without its memory a part must run again"
script=$tree/experiments/hardware.sh

# The disk, another commit, options.
rm "$out/steps/misses"
FARCULL_HARDWARE_DISK=1 measure
holds disk "$work/said" 'misses .*: left out, .* KiB, more than 1$'
FAKE_COMMIT=def measure
expect "another commit" 2
holds "another commit" "$work/said" 'is of farcull 0.1, commit abc, software; this is farcull 0.1, commit def, software'
for wrong in "--minutes x" "--minutes" "--device a/b" "--fast 1"; do
  read -ra words <<<"$wrong"
  measure "${words[@]}"
  expect "$wrong" 2
done

if ((failures)); then exit 1; fi
echo "hardware_test: passed"
