#!/usr/bin/env bash
# experiments/jobs.sbatch as Slurm calls it, one task after the other: what the tasks of a study or the tiles of a scene
# merge to is what one run gives. Tests of the store kill a task and go on with it.
#   tests/experiments/jobs_test.sh FARCULL
set -euo pipefail

program=$(realpath "${1:?the program}")
script=$(realpath "$(dirname -- "${BASH_SOURCE[0]}")/../../experiments/jobs.sbatch")
# shellcheck source-path=SCRIPTDIR source=script_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/script_lab.sh" jobs_test sqlite3
mkdir "$work/build"
ln -s "$program" "$work/build/farcull"
unset "${!SLURM_@}"
export SLURM_SUBMIT_DIR=$work STUDY=culling

task() { # K ARGUMENTS...: the Kth of three
  SLURM_ARRAY_TASK_ID=$1 SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_MAX=3 bash "$script" "${@:2}" >"$work/said" 2>&1 || {
    cat "$work/said" >&2
    return 1
  }
}
refused() { # TEXT COMMAND...
  if "${@:2}" >"$work/said" 2>&1 || ! grep -qF -- "$1" "$work/said"; then fail "no '$1' in: $(<"$work/said")"; fi
}
farcull() { (cd "$work" && build/farcull "$@"); }

refused 'submit this with --array=1-N' bash "$script" study
study=(study --quick --no-times --device native)
rows() { sqlite3 "$work/$1/results.sqlite" 'SELECT study, position, device, counts, left_out FROM rows ORDER BY study, position'; }
farcull experiment culling --out whole "${study[@]:1}" >/dev/null
task 1 "${study[@]}"
task 3 "${study[@]}"
refused 'shard 2/3: of culling is missing' farcull merge study
task 2 "${study[@]}"
task 2 "${study[@]}"
grep -qE '^culling +8 +8 +0 ' "$work/said" || fail "submitted again, a task measures anew: $(<"$work/said")"
farcull merge study >/dev/null
cmp -s <(rows whole) <(rows study) || fail "the merged rows are not those of one run"
sqlite3 "$work/study/results.sqlite" "UPDATE rows SET counts = '{}' WHERE position = 3"
if cmp -s <(rows whole) <(rows study); then fail "twin: a changed count is not noticed"; fi

export SCENE=field:20000
farcull run "$SCENE" --no-verify --pairs one-run.csv >/dev/null
task 1 tiles --no-verify
task 3 tiles --no-verify
refused 'of its 3 tiles one is missing: 2' farcull merge "$work"/tiles/tile-{1,3}.json -o merged.csv
TILES=3 SLURM_ARRAY_TASK_ID=2 bash "$script" tiles --no-verify >/dev/null # a single tile that is submitted again
before=$(stat -c %y "$work/tiles/tile-1.json")
task 1 tiles --no-verify
[[ $(stat -c %y "$work/tiles/tile-1.json") == "$before" ]] || fail "a tile that is done is done again"
farcull merge "$work"/tiles/tile-*.json -o merged.csv >/dev/null
cmp -s "$work/one-run.csv" "$work/merged.csv" || fail "the merged pairs are not those of one run"

if ((failures)); then exit 1; fi
echo "jobs_test: passed"
