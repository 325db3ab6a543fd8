#!/usr/bin/env bash
# A real cluster on one machine. It starts Debian's Slurm with three nodes (munged, slurmctld and three
# slurmd, as processes of this user, with ports on the loopback), submits experiments/jobs.sbatch as an
# array job, and makes three tasks fail in the middle:
#   lost node      every process of a node is killed; Slurm gives its task to another node
#   lost daemon    only the daemon of a node is killed and its task lives on; Slurm starts the task a
#                  second time, which has to be refused, since the first one still writes the file
#   killed task    its program is killed; it is put back in the queue by hand
# Then the shards are merged, and the rows have to be equal to those of an undisturbed run. At last
# experiments/jobs.sbatch is submitted, the program of a tile is killed and put back, and the merged list
# of pairs has to be that of one run. It is no part of CI.
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
shard() { printf '%s' "$folder/$1/results-$2-of-$3.sqlite"; } # FOLDER K N
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
# hold STORE VARIABLE=VALUE: stops the program with that environment, which writes the store; 1: it has
# written no rows yet. $program is set.
hold() {
  has_rows "$1" || return 1
  program=$(process_of farcull "$2")
  if [[ -z $program ]]; then give_up "$2: no such program, though there is $1"; fi
  kill -STOP "$program"
  held+=("$program")
}
# A program that writes keeps its file locked, so a copy is read, with the journal that belongs to it.
rows_while_held() {
  cp "$1" "$work/copy.sqlite"
  if [[ -e $1-journal ]]; then cp "$1-journal" "$work/copy.sqlite-journal"; fi
  rows_in "$work/copy.sqlite"
  rm -f "$work"/copy.sqlite*
}
# The share of the points of the whole study that shard K of N has.
points_of_shard() { echo $(((points - $1 + $2) / $2)); }
in_the_middle() { # STORE K N
  local -i rows
  rows=$(rows_while_held "$1")
  say "        shard $2 of $3 has $rows of $(points_of_shard "$2" "$3") rows"
  ((rows > 0 && rows < $(points_of_shard "$2" "$3")))
}
# merges FOLDER NAME: the shards of a folder, compared with the undisturbed run. Its twin: a changed count
# and a row that is gone have to be noticed.
merges() {
  check "$2: the shards are merged" merge "$1"
  local store=$folder/$1/results.sqlite
  check "$2: the $(rows_in "$store") rows equal those of an undisturbed run" equal_to_whole "$store"
  cp "$store" "$work/twin.sqlite"
  sqlite3 "$work/twin.sqlite" "UPDATE rows SET counts = '{}' WHERE position = 3"
  check "$2: twin: a changed count is noticed" not equal_to_whole "$work/twin.sqlite"
  cp "$store" "$work/twin.sqlite"
  sqlite3 "$work/twin.sqlite" "DELETE FROM rows WHERE position = 3"
  check "$2: twin: a row that is gone is noticed" not equal_to_whole "$work/twin.sqlite"
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
for _ in 1 2 3 4; do
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
ReturnToService=2
SlurmdTimeout=10
KillWait=2
SwitchType=switch/none
NodeName=node1 NodeHostname=$host NodeAddr=127.0.0.1 Port=${ports[1]} CPUs=2 RealMemory=8192
NodeName=node2 NodeHostname=$host NodeAddr=127.0.0.1 Port=${ports[2]} CPUs=2 RealMemory=8192
NodeName=node3 NodeHostname=$host NodeAddr=127.0.0.1 Port=${ports[3]} CPUs=2 RealMemory=8192
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF

start_node() { slurmd -N "$1" >>"$work/$1.log" 2>&1; }
node_is() { [[ $(sinfo -h -n "$1" -o %T 2>/dev/null) =~ ^($2) ]]; } # NODE BEGINNING
start_slurm() {
  mkdir "$work/state" "$work/node1" "$work/node2" "$work/node3"
  (umask 077 && head -c 1024 /dev/urandom >"$work/munge.key")
  munged --socket="$work/munge.socket" --key-file="$work/munge.key" --pid-file="$work/munged.pid" \
    --log-file="$work/munged.log" --seed-file="$work/munge.seed" || give_up "munged does not start"
  slurmctld >>"$work/slurmctld.log" 2>&1 || give_up "slurmctld does not start"
  local node
  for node in node1 node2 node3; do
    start_node "$node" || give_up "slurmd of $node does not start"
  done
  for node in node1 node2 node3; do
    until_true 60 node_is "$node" idle || give_up "$node is not idle: $(sinfo -h -n "$node" -o '%T %E')"
  done
  say "Slurm: $(sinfo -V); nodes $(sinfo -h -o '%N are %T'); ports ${ports[*]}"
}
submit() { # OUT: prints the number of the job
  sbatch --parsable --array=1-$tasks --output="$farcull_root/$folder/slurm-%A-%a.log" \
    experiments/jobs.sbatch "$folder/$1" "${options[@]}"
}
# state JOB TASK: such as RUNNING, COMPLETED, NODE_FAIL
state() { squeue -h -r -t all -j "$1_$2" -o %T 2>/dev/null; }
state_is() { [[ $(state "$1" "$2") == "$3" ]]; } # JOB TASK STATE
field() { scontrol show job "$1_$2" 2>/dev/null | grep -oE "(^| )$3=[^ ]*" | head -n 1 | sed 's/.*=//'; }
restarts() { [[ $(field "$1" "$2" Restarts) == "$3" ]]; }
is_over() { ! squeue -h -r -j "$1" -t PENDING,RUNNING,COMPLETING,CONFIGURING,SUSPENDED -o %T | grep -q .; }
states() { squeue -h -r -t all -j "$1" -o '%K %T' | sort -n | tr '\n' ',' | sed 's/,$//; s/,/, /g'; }
all_completed() { [[ $(squeue -h -r -t all -j "$1" -o %T | sort | uniq -c | tr -s ' ') == " $tasks COMPLETED" ]]; }
# The log of a task says how many of its points were measured before and now.
measured_none() { # JOB
  local -i task
  for ((task = 1; task <= tasks; ++task)); do
    awk -v study="$study" '$1 == study && NF == 6 { seen = 1; if ($4 + 0 != 0) bad = 1 } END { exit !seen || bad }' \
      "$folder/slurm-$1-$task.log" || return 1
  done
}

slurm() {
  local -i job task ends
  local -A on=() pid=()
  local node program
  start_slurm
  job=$(submit slurm)
  say "Slurm: job $job, $tasks tasks"
  ends=$((SECONDS + 120))
  while ((${#pid[@]} < 3)); do
    for task in 1 2 3; do
      if [[ -z ${pid[$task]-} ]] && hold "$(shard slurm $task $tasks)" "SLURM_ARRAY_TASK_ID=$task"; then
        pid[$task]=$program
      fi
    done
    if ((SECONDS > ends)); then give_up "the first three tasks write no rows: $(states "$job")"; fi
    sleep 0.05
  done
  for task in 1 2 3; do
    on[$task]=$(squeue -h -r -j "${job}_$task" -o %N)
    say "Slurm: task $task is held on ${on[$task]}"
    check "Slurm: task $task is in the middle" in_the_middle "$(shard slurm $task $tasks)" $task $tasks
  done

  # Task 1: its node is lost. The daemon of the task is the parent of the program.
  node=${on[1]}
  local -i step
  step=$(ps -o ppid= -p "${pid[1]}")
  check "Slurm: the parent of the program is a slurmstepd" says "/proc/$step/cmdline" slurmstepd
  kill -KILL "$(<"$work/$node.pid")" "$step" "${pid[1]}"
  say "Slurm: $node is lost, with task 1"
  # Task 2: only the daemon of its node.
  kill -KILL "$(<"$work/${on[2]}.pid")"
  say "Slurm: the daemon of ${on[2]} is lost; task 2 goes on"
  # Task 3: the program.
  kill -KILL "${pid[3]}"
  check "Slurm: task 3 failed, after its program was killed" until_true 30 state_is "$job" 3 FAILED
  say "Slurm: waiting for Slurm to notice the lost nodes"
  check "Slurm: ${on[1]} is down" until_true 120 node_is "${on[1]}" down
  check "Slurm: ${on[2]} is down" until_true 120 node_is "${on[2]}" down
  # The second copy of task 2 must not write a file that the first one writes.
  check "Slurm: task 2 was started again and refused" until_true 240 state_is "$job" 2 FAILED
  check "Slurm: the refusal says why" says "$folder/slurm-$job-2.log" 'another program is writing it'
  kill -CONT "${pid[2]}"
  for node in "${on[1]}" "${on[2]}"; do
    rm -f "$work/$node.pid"
    check "Slurm: the daemon of $node is started again" start_node "$node"
    check "Slurm: $node is back" until_true 60 not node_is "$node" down
  done
  check "Slurm: the first copy of task 2 ends by itself" until_true 240 not test -e "/proc/${pid[2]}"
  check "Slurm: the queue is empty" until_true 600 is_over "$job"
  say "Slurm: $(states "$job")"
  check "Slurm: task 1 was started again by Slurm" restarts "$job" 1 1
  check "Slurm: task 1 is complete" state_is "$job" 1 COMPLETED
  check "Slurm: shard 2 was completed by its first copy" test "$(runs_in "$(shard slurm 2 $tasks)")" == 1
  check "Slurm: a shard that is not complete is not merged" \
    refused_merge slurm "results-3-of-$tasks.sqlite: has no row of $study"
  scontrol requeue "${job}_3"
  say "Slurm: task 3 is put back"
  check "Slurm: task 3 is complete" until_true 300 state_is "$job" 3 COMPLETED
  for task in 1 3; do
    check "Slurm: shard $task holds rows of two runs" test "$(runs_in "$(shard slurm $task $tasks)")" == 2
  done
  job=$(submit slurm)
  check "Slurm: the same line again: every task completes" until_true 300 all_completed "$job"
  check "Slurm: and measures nothing" measured_none "$job"
  merges slurm Slurm
}

# The tiles of a scene, each a task; the program of the second one is killed before it has a record.
hold_tile() { # K: stops the program of that tile; 1: it does not run yet. $program is set.
  program=$(process_of farcull "SLURM_ARRAY_TASK_ID=$1")
  [[ -n $program ]] || return 1
  kill -STOP "$program"
  held+=("$program")
}
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
  until_true 120 hold_tile 2 || give_up "tile 2 does not start: $(states "$job")"
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
