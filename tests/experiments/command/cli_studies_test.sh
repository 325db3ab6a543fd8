#!/usr/bin/env bash
# Studies as a user runs them: killed and resumed, interrupted, on a full disk, in shards, and into
# files that are none of ours. cli_studies_test.sh FARCULL
set -uo pipefail

program=${1:?the program}
work=$(mktemp -d)
cleanup() {
  mountpoint -q "$work/disk" 2>/dev/null && umount "$work/disk"
  rm -rf "$work"
}
trap cleanup EXIT
# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

# The study of the most points and the least work; every point of it by itself takes milliseconds.
readonly study=precision
unset SLURM_ARRAY_TASK_ID OMPI_COMM_WORLD_RANK OMPI_COMM_WORLD_SIZE

measure() { timeout 240 "$program" experiment "$study" --quick "$@" >"$out" 2>"$err"; }
# What has to be the same on every run: everything but times and runs.
rows_of() { # FOLDER
  sqlite3 "$1/results.sqlite" \
    "SELECT study, position, device, counts, left_out FROM rows ORDER BY study, position"
}
same() { # CASE FOLDER
  ((cases += 1))
  rows_of whole >"$work/rows.whole"
  rows_of "$2" >"$work/rows.other"
  cmp -s "$work/rows.whole" "$work/rows.other" ||
    fail "$1" "$(diff "$work/rows.whole" "$work/rows.other" | head -3 | tr '\n' '|')"
}
differ() { # CASE FOLDER: the twin of same
  ((cases += 1))
  rows_of "$2" >"$work/rows.other"
  if cmp -s "$work/rows.whole" "$work/rows.other"; then fail "$1" "no difference was seen"; fi
}

((cases += 1))
started=$(date +%s%N)
measure --out whole || fail whole "status $?"
took_ms=$((($(date +%s%N) - started) / 1000000))
expect whole "$out" "^$study +[0-9]"
expect whole "$out" '^results: whole/results.sqlite$'
points=$(rows_of whole | wc -l)
((cases += 1))
((points > 20)) || fail whole "only $points points"

# Devices: what may differ on the further one is in a store of its own. Here both are the same one.
((cases += 1))
measure --out devices --devices native,native || fail devices "status $?"
differing() {
  sqlite3 devices/results.sqlite "ATTACH 'devices/on-native/results.sqlite' AS other;
    SELECT count(*), sum(a.counts != b.counts) FROM results a JOIN other.results b USING (study, scene,
    method, \"offset\", radius, depth_format, depth_mode, resolution, views, frame, seed)"
}
compared=$(differing)
[[ $compared =~ ^[1-9][0-9]+\|0$ ]] || fail "the same device twice" "$compared"
((cases += 1))
sqlite3 devices/on-native/results.sqlite "UPDATE rows SET counts = '{}' WHERE position = 0"
[[ $(differing) == "${compared%|0}|1" ]] || fail "a changed count of a device" "$(differing)"

# Ten kills at random moments of a run; what is left is gone on with.
RANDOM=${SEED:=$$}
kills=0
for _ in {1..10}; do
  "$program" experiment "$study" --quick --out killed --resume >"$out" 2>"$err" &
  child=$!
  sleep "$(awk -v r=$RANDOM -v t="$took_ms" 'BEGIN { printf "%.3f", r / 32768 * t / 5000 }')"
  kill -KILL "$child" 2>/dev/null
  wait "$child" 2>/dev/null
  status=$?
  ((status == 137)) && ((kills += 1))
done
((cases += 1))
((kills >= 5)) || fail killed "only $kills of 10 kills met a run that was going on (seed $SEED)"
((cases += 1))
measure --out killed --resume || fail "killed (seed $SEED)" "status $?"
same "killed (seed $SEED)" killed

# Ctrl-C (which a script's background has ignored): says how far it is and how to go on.
env --default-signal=INT "$program" experiment "$study" --quick --out interrupted >"$out" 2>"$err" &
child=$!
for _ in {1..100}; do
  [[ -n $(rows_of interrupted 2>/dev/null) ]] && break
  [[ -e interrupted/results.sqlite ]] && sleep 0.3 && break
  sleep 0.05
done
kill -INT "$child"
wait "$child"
status=$?
((cases += 1))
((status == 130)) || fail interrupted "status $status, not ended by the signal"
expect interrupted "$err" "^farcull: interrupted: after [0-9]+ of $points points; .*--resume"
measure --out interrupted --resume || fail interrupted "status $?"
same interrupted interrupted

# A disk that fills up: a small file system where one may be mounted, else a limit on files.
mkdir "$work/disk"
full() { # OUT
  ((cases += 1))
  if (($3 != 2)); then fail "$1" "status $3 instead of 2"; fi
  expect "$1" "$err" "^farcull: $2/results.sqlite: cannot be written.*--resume"
}
if mount -t tmpfs -o size=48k farcull-test "$work/disk" 2>/dev/null; then
  measure --out "$work/disk/full"
  full "full disk" "$work/disk/full" $?
  mount -o remount,size=64m "$work/disk"
  measure --out "$work/disk/full" --resume || fail "full disk" "status $?"
  same "full disk" "$work/disk/full"
else
  echo "not run: a disk that is really full (no file system may be mounted here)"
fi
(
  ulimit -f 48
  measure --out limited
)
full "limited file" limited $?
measure --out limited --resume || fail "limited file" "status $?"
same "limited file" limited

# Shards, by the option and by the variables of Slurm and Open MPI.
SLURM_ARRAY_TASK_ID=3 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=4 SLURM_ARRAY_TASK_COUNT=4 \
  measure --out shards || fail shards "status $?"
expect shards "$out" '^shard 3 of 4, by SLURM_ARRAY_TASK_ID$'
OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=4 measure --out shards || fail shards "status $?"
expect shards "$out" '^shard 2 of 4, by OMPI_COMM_WORLD_RANK$'
measure --out shards --shard 1/4 || fail shards "status $?"
bad "a shard is missing" 'shard 4/4: of precision is missing' merge shards
measure --out shards --shard 4/4 || fail shards "status $?"
bad "a shard twice" '.*is shard 1/4 of precision, and so is' merge shards/results-1-of-4.sqlite \
  shards/results-1-of-4.sqlite -o new.sqlite
good merge 0 merge shards
expect merge "$out" "^$points rows of 1 study from 4 shards: shards/results.sqlite$"
same shards shards
bad "merged already" 'shards/results.sqlite: is there already' merge shards
sqlite3 shards/results.sqlite "UPDATE rows SET counts = '{}' WHERE position = 3"
differ "a row that was changed" shards
sqlite3 shards/results-2-of-4.sqlite "DELETE FROM rows WHERE position = 5"
bad "a hole" 'shards/results-2-of-4.sqlite: has no row of precision' merge shards -o new.sqlite

# A folder that SQLite would take for something else than a folder.
good "a folder with a colon" 0 experiment "$study" --quick --out 'file:x?mode=memory&q=' --shard 1/1000
expect "a folder with a colon" <(ls 'file:x?mode=memory&q=') '^results-1-of-1000.sqlite$'

# What is refused.
bad "again without --resume" 'whole/results.sqlite: holds [0-9]+ rows of precision already' \
  experiment "$study" --quick --out whole
bad "another seed" 'whole/results.sqlite: precision stands there with' experiment "$study" --quick \
  --out whole --resume --seed 2
bad "the other grid" 'whole/results.sqlite: precision stands there with' experiment "$study" --out whole \
  --resume
mkdir foreign empty damaged
echo 'my notes, long enough to be no empty file' >foreign/results.sqlite
bad "a foreign file" 'foreign/results.sqlite: is no store of farcull' experiment "$study" --quick \
  --out foreign --resume
rm foreign/results.sqlite
sqlite3 foreign/results.sqlite 'CREATE TABLE mine (a)'
bad "a foreign database" 'foreign/results.sqlite: is a database of another program' experiment \
  "$study" --quick --out foreign
head -c 20000 whole/results.sqlite >damaged/results.sqlite
bad "a file cut short" 'damaged/results.sqlite: is damaged' experiment "$study" --quick --out damaged \
  --resume
: >afile
bad "the folder is a file" 'afile: is no folder' experiment "$study" --quick --out afile
bad "no such study" 'acuracy: no such command' experiment acuracy
bad "no study" 'experiment: no study is named; name one: all, scenes, accuracy' experiment
bad "seed 0" '--seed: 0 is out of range' experiment "$study" --seed 0
bad "a shard that is none" "--shard: '5/4' is no shard" experiment "$study" --shard 5/4
bad "a device that is no name" "--devices: 'a/b' is no device" experiment "$study" --devices native,a/b
bad "devices twice" '--devices: says what --device says' experiment "$study" --device native \
  --devices native
bad "no shards" 'empty: holds no shards' merge empty
bad "no folder" 'nowhere' merge nowhere
settings=(SLURM_ARRAY_TASK_ID=1)
bad "half of Slurm" 'SLURM_ARRAY_TASK_COUNT' experiment "$study" --quick --out new
settings=()

echo "cli_studies_test: $cases cases, $failed failed"
((failed == 0))
