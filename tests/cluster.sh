#!/usr/bin/env bash
# A real cluster on one machine. It starts Debian's Slurm with two nodes (munged, slurmctld and two slurmd,
# as processes of this user, with ports on the loopback), submits experiments/jobs.sbatch as an array job,
# kills the program of a task in the middle, and puts the task back in the queue. Then the shards are merged,
# and the rows have to be equal to those of an undisturbed run. At last the same is done with
# experiments/jobs.sbatch, whose merged list of pairs has to be that of one run. It is no part of CI.
#   bash tests/cluster.sh                                 the study radius, --quick: some minutes
#   STUDY=accuracy bash tests/cluster.sh --device native  another study and other options
# It installs what is missing and builds. The log and those of the daemons are in build/cluster/.
# Exit status: 0; 1 a check failed; 2 it did not start.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../experiments/setup.sh"
cd "$farcull_root"
farcull_packages+=(slurmctld slurmd slurm-client munge sqlite3)
farcull_setup
farcull_build farcull
unset "${!SLURM_@}"

study=${STUDY:-radius}
export STUDY=$study
options=("$@")
if ((${#options[@]} == 0)); then options=(--quick); fi
readonly tasks=4 tile_scene=field:2000000
folder=build/cluster
rm -rf "$folder"
mkdir -p "$folder"
# The sockets and states of the daemons are in a folder with a short path, since the name of a socket
# has at most 107 characters.
work=$(mktemp -d)
chmod 711 "$work" # munged wants every user to reach its socket
started=$SECONDS
failures=0
held=() # programs that are stopped

say() { printf '%5d s  %s\n' $((SECONDS - started)) "$*" | tee -a "$folder/log.txt"; }
check() { # TEXT COMMAND...: one line of the log
  if "${@:2}"; then
    say "ok      $1"
  else
    say "FAILED  $1"
    failures=$((failures + 1))
  fi
}
give_up() {
  say "ended: $*; the logs of the daemons are in $folder"
  exit 2
}

# shellcheck disable=SC2317 # called by a trap
cleanup() {
  local file pid
  for pid in "${held[@]}"; do kill -KILL "$pid" 2>/dev/null || true; done
  for pid in $(jobs -p); do kill "$pid" 2>/dev/null || true; done
  if [[ -n ${SLURM_CONF-} ]]; then
    timeout 10 scancel --user "$me" 2>/dev/null || true
    # One whose daemon was killed would wait for hours to report.
    for pid in $(process_of slurmstepd "SLURM_CONF=$SLURM_CONF"); do kill -KILL "$pid" || true; done
  fi
  for file in "$work"/*.pid; do
    if [[ -e $file ]]; then kill "$(<"$file")" 2>/dev/null || true; fi
  done
  sleep 1
  cp "$work"/*.log "$folder/" 2>/dev/null || true
  rm -rf "$work"
}
trap cleanup EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

# until_true SECONDS COMMAND...: waits until the command succeeds; 1 where it does not in that time.
until_true() {
  local -i ends=$((SECONDS + $1))
  until "${@:2}"; do
    if ((SECONDS >= ends)); then return 1; fi
    sleep 0.05
  done
}

# ---- rows ----

# Everything of a row but its run and its times.
rows_of() { # STORE
  sqlite3 "$1" "SELECT study, position, device, counts, left_out FROM rows ORDER BY study, position"
}
rows_in() { sqlite3 "$1" 'SELECT count(*) FROM rows'; }
runs_in() { sqlite3 "$1" 'SELECT count(DISTINCT run) FROM rows'; }
equal_to_whole() { cmp -s <(rows_of "$folder/whole/results.sqlite") <(rows_of "$1"); }
measure() { build/farcull experiment "$study" "${options[@]}" --resume "$@"; }
# Bash handles a signal while it waits, but not while a command runs in the foreground.
waited() {
  "$@" &
  wait "$!"
}
size_of() { stat -c %s "$1" 2>/dev/null || echo 0; }
# Points are declared before the first one is measured, so a store without rows has a known size. A larger
# file has rows.
has_rows() { (($(size_of "$1") >= bare + 8192)); }
# hold K: stops the program of that task; 1: it does not run yet. $program is set.
hold() {
  program=$(process_of farcull "SLURM_ARRAY_TASK_ID=$1")
  [[ -n $program ]] || return 1
  kill -STOP "$program"
  held+=("$program")
}
merge() { build/farcull merge "$folder/$1" >>"$folder/merged.txt"; }
not() { ! "$@"; }
says() { grep -qE -- "$2" "$1"; } # FILE PATTERN
refused_merge() { ! build/farcull merge "$folder/$1" >"$work/refused" 2>&1 && says "$work/refused" "$2"; }

# process_of NAME VARIABLE=VALUE: the processes of that name that have the variable in their environment.
process_of() {
  local pid
  for pid in $(pgrep -x "$1"); do
    if grep -qzxF -- "$2" "/proc/$pid/environ" 2>/dev/null; then echo "$pid"; fi
  done
}

say "study $study ${options[*]}, $(build/farcull --version), $(nproc) cores"
waited measure --out "$folder/whole" >"$folder/whole.txt" 2>&1 ||
  give_up "the undisturbed run ended with status $? ($folder/whole.txt)"
points=$(rows_in "$folder/whole/results.sqlite")
cp "$folder/whole/results.sqlite" "$work/bare.sqlite"
sqlite3 "$work/bare.sqlite" 'DELETE FROM rows; VACUUM'
bare=$(size_of "$work/bare.sqlite")
say "undisturbed: $points rows"
if ((points < 20 * tasks)); then give_up "too few points for $tasks tasks with a middle"; fi

# ---- Slurm ----

free_port() { # from $port on: one that nobody listens at
  while (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port=$((port + 1)); done
}
port=$((20000 + RANDOM % 10000))
ports=()
for _ in 1 2 3; do
  free_port
  ports+=("$port")
  port=$((port + 1))
done
me=$(id -un)
host=$(hostname -s)
export SLURM_CONF=$work/slurm.conf
# The processors that the nodes claim to have are more than this machine has (config_overrides).
# cred_expire is also the time after which a task that was put back may start.
cat >"$SLURM_CONF" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmUser=$me
SlurmdUser=$me
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$work/munge.socket,cred_expire=5
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/%n
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/%n.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/%n.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
JobRequeue=1
KillWait=2
SwitchType=switch/none
NodeName=node1 NodeHostname=$host NodeAddr=127.0.0.1 Port=${ports[1]} CPUs=2 RealMemory=8192
NodeName=node2 NodeHostname=$host NodeAddr=127.0.0.1 Port=${ports[2]} CPUs=2 RealMemory=8192
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF

node_is() { [[ $(sinfo -h -n "$1" -o %T 2>/dev/null) =~ ^($2) ]]; } # NODE BEGINNING
start_slurm() {
  local -i job
  local program store shard=$folder/slurm/results-3-of-$tasks.sqlite
  start_slurm
  job=$(submit slurm)
  say "Slurm: job $job, $tasks tasks"
  until_true 600 has_rows "$shard" || give_up "task 3 writes no rows: $(states "$job")"
  hold 3 || give_up "task 3 has ended before it was stopped"
  kill -KILL "$program"
  check "Slurm: task 3 failed, after its program was killed" until_true 30 state_is "$job" 3 FAILED
  check "Slurm: the queue is empty" until_true 600 is_over "$job"
  check "Slurm: a shard that is not complete is not merged" \
    refused_merge slurm "results-3-of-$tasks.sqlite: has no row of $study"
  scontrol requeue "${job}_3"
  check "Slurm: after it was put back every task is complete" until_true 300 all_completed "$job"
  check "Slurm: shard 3 holds rows of two runs" test "$(runs_in "$shard")" == 2
  job=$(submit slurm)
  check "Slurm: the same line again: every task completes" until_true 300 all_completed "$job"
  check "Slurm: and measures nothing" measured_none "$job"
  check "Slurm: the shards are merged" merge slurm
  store=$folder/slurm/results.sqlite
  check "Slurm: the $(rows_in "$store") rows equal those of an undisturbed run" equal_to_whole "$store"
  sqlite3 "$store" "UPDATE rows SET counts = '{}' WHERE position = 3"
  check "Slurm: twin: a changed count is noticed" not equal_to_whole "$store"
}

# The tiles of a scene, each a task; the program of the second one is killed before it has a record.
merge_tiles() {
  build/farcull merge "$folder"/tiles/tile-*.json -o "$folder/tiles/merged.csv" >>"$folder/merged.txt" 2>"$work/refused"
}
tiles() {
  local -i job
  local program
  say "tiles of $tile_scene"
  waited build/farcull run "$tile_scene" --no-verify --pairs "$folder/one-run.csv" >"$folder/one-run.txt"
  job=$(SCENE=$tile_scene sbatch --parsable --array=1-$tasks --output="$farcull_root/$folder/tiles-%A-%a.log" \
    experiments/jobs.sbatch "$folder/tiles" --no-verify)
  say "tiles: job $job, $tasks tasks"
  until_true 120 hold 2 || give_up "tile 2 does not start: $(states "$job")"
  check "tiles: task 2 has no record when it is killed" not test -e "$folder/tiles/tile-2.json"
  kill -KILL "$program"
  check "tiles: task 2 failed, after its program was killed" until_true 60 state_is "$job" 2 FAILED
  check "tiles: the queue is empty" until_true 300 is_over "$job"
  check "tiles: three tiles of four are not merged" not merge_tiles
  check "tiles: the refusal says why" says "$work/refused" "of its $tasks tiles one is missing: 2"
  scontrol requeue "${job}_2"
  check "tiles: after it was put back every task is complete" until_true 300 all_completed "$job"
  check "tiles: the tiles are merged" merge_tiles
  check "tiles: the $(($(wc -l <"$folder/one-run.csv") - 1)) pairs are those of one run" \
    cmp -s "$folder/one-run.csv" "$folder/tiles/merged.csv"
  sed -i '$d' "$folder/tiles/tile-3.csv"
  check "tiles: twin: a pair that is gone from a list is noticed" not merge_tiles
}

slurm
tiles

say "$failures checks failed; $(grep -c '  ok  ' "$folder/log.txt") passed"
((failures == 0))
