#!/usr/bin/env bash
# Measures farcull on this machine's GPU, by default in at most two hours: the probes, missed pairs, times of farcull and of other
# libraries, times for up to 10^7 triangles, moving scenes, the test suite, experiments/reliability.sh, all studies and their
# report. The most important parts come first. Installs missing packages and builds the program.
#   bash experiments/hardware.sh
#     --minutes N      time limit of the measurements (default 120); the output names parts without a result
#     --device DEVICE  default hardware; software (Mesa's) or native for a trial
#     --out DIR        default build/hardware-COMMIT-DEVICE
# To continue after Ctrl-C, a kill or the time limit, run the same command again. Finished parts are not measured again. Studies
# continue at the next point. The script makes an archive, DIR.tar.gz, and a page, DIR/NAME.md, where NAME is the name of the
# device. For hardware, it also puts the page in docs/results/. It stops when DIR has 20 GiB. Exit status: 0 done; 1 a pair was
# missed or a check failed; 2 the script could not begin; 3 nothing failed, but some parts have no result; 130 or 143 interrupted.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

minutes=120 device=hardware out=''
refuse() {
  echo "hardware: $*" >&2
  exit 2
}
while (($#)); do
  case $1 in
    --minutes | --device | --out) if (($# < 2)); then refuse "$1 needs a value"; fi ;;
    *) refuse "'$1' is no option; the head of $0 names them" ;;
  esac
  case $1 in
    --minutes) minutes=$2 ;;
    --device) device=$2 ;;
    --out) out=$(realpath -m "$2") ;;
  esac
  shift 2
done
if [[ ! $minutes =~ ^[0-9]{1,4}(\.[0-9]{1,3})?$ ]]; then refuse "--minutes: '$minutes' is no number of minutes, such as 30 or 0.5"; fi
budget=$(awk -v m="$minutes" 'BEGIN { printf "%d", 60 * m }') # seconds
if [[ ! $device =~ ^[a-z0-9]+$ ]]; then refuse "--device: '$device' is no device; farcull doctor lists them"; fi

cd "$farcull_root"
farcull_setup
farcull_build farcull
bash experiments/meshes.sh || echo "hardware: what needs the packaged meshes will fail"
version=$(build/farcull --version)
commit=${version##* }
out=${out:-$farcull_root/build/hardware-$commit-$device}
mkdir -p "$out/steps" "$out/logs"
exec 9>"$out/lock"
flock -n 9 || refuse "another program works in $out"
if [[ -e $out/commit && $(<"$out/commit") != "$version, $device" ]]; then
  refuse "$out is of $(<"$out/commit"); this is $version, $device; name another folder with --out"
fi
echo "$version, $device" >"$out/commit"
# Keeps the scripts below from building: after an edit of the sources, they would build another program.
export FARCULL_BUILT=yes DEVICE=$device XDG_CACHE_HOME=$out/cache

began=$SECONDS
cores=$(nproc)
# Only a test sets FARCULL_HARDWARE_DISK.
most_disk=${FARCULL_HARDWARE_DISK:-20971520} # KiB
child=''
missing=() # parts without a result, with the reason
spent=()   # parts that did not begin, since no time was left
say() { printf 'hardware: %s\n' "$*"; }

# ---- running a part ----

left() { echo $((budget - (SECONDS - began))); } # seconds

# step NAME SHARE TEXT COMMAND...: runs the command unless an earlier call ran it. The time limit is 1/SHARE of the time left. If
# this is below 10 minutes, the limit is 10 minutes or all the time left. Writes steps/NAME (status, seconds) and logs/NAME.txt.
step() {
  local name=$1 text=$3 used
  local -i share=$2 limit start status=0
  shift 3
  if [[ -e $out/steps/$name ]]; then return 0; fi
  limit=$(($(left) / share))
  if ((limit < 600)); then limit=600; fi
  if (($(left) < limit)); then limit=$(left); fi
  if ((limit < 5)); then
    spent+=("$name")
    return 0
  fi
  used=$(du -sk "$out" | cut -f 1)
  if ((used > most_disk)); then
    missing+=("$name ($text): left out, $out has $used KiB, more than $most_disk")
    return 0
  fi
  say "$text (part $name, at most $limit s)"
  start=$SECONDS
  # The command runs in the background, since bash handles signals during `wait`, but not during a foreground
  # command. A background command ignores Ctrl-C unless `env` restores the default. `timeout` passes signals on to the command.
  env --default-signal=INT timeout --kill-after=30 "$limit" "$@" >"$out/logs/$name.txt" 2>&1 </dev/null 9>&- &
  child=$!
  wait "$child" || status=$?
  child=''
  case $status in
    0) echo "$status $((SECONDS - start))" >"$out/steps/$name" ;;
    1)
      echo "$status $((SECONDS - start))" >"$out/steps/$name"
      say "FAILED: $name: $(tail -n 1 "$out/logs/$name.txt")"
      ;;
    124 | 137) missing+=("$name ($text): cut off after $((SECONDS - start)) s") ;;
    *) missing+=("$name ($text): status $status: $(tail -n 1 "$out/logs/$name.txt")") ;;
  esac
}
# shellcheck disable=SC2317 # called by traps
stop() {
  if [[ -n $child ]]; then
    kill -TERM "$child" 2>/dev/null || true
    wait "$child" 2>/dev/null || true
  fi
  say "interrupted; what is done is kept in $out, and the same command goes on"
  exit "$1"
}
trap 'stop 130' INT
trap 'stop 143' TERM HUP

# ---- the parts, the most important first ----

moving_scenes() {
  build/farcull scenes --json - | awk -F'"' '$2 == "name" { name = $4 } /"moves": true/ { print name }'
}
safe() { tr -c 'a-zA-Z0-9\n' '-' <<<"$1"; } # turns a text into a file name
bench() { # SHARE SCENE [OPTIONS]: times farcull and the other libraries, on all cores and on one core
  local share=$1 name threads
  name=$(safe "${*:2}")
  for threads in "$cores" 1; do
    step "bench-$name-$threads" "$share" "times of ${*:2} beside other libraries, --threads $threads" \
      build/farcull bench "${@:2}" --device "$device" --threads "$threads" --json "$out/bench-$name-$threads.json"
    if ((cores == 1)); then return; fi
  done
}
if [[ -e $out/steps/doctor ]]; then say "going on with $out"; fi
step doctor 1 "the probes of the assumptions" build/farcull doctor --device "$device" --json "$out/doctor.json"
if [[ ! -e $out/steps/doctor ]]; then
  cat "$out/logs/doctor.txt" >&2 2>/dev/null || true
  refuse "farcull doctor --device $device has no result; --device software tries the script without a GPU"
fi
step misses 3 "missed pairs of two bunnies" build/farcull compare two-bunnies \
  --methods far,boxes,cullide,exact --offsets obb,exact --resolutions 128,512 --device "$device" --json "$out/misses.json"
bench 3 two-bunnies
for size in 10000 30000 100000 300000 1000000 3000000 10000000; do
  step "field-$size" 3 "boxes on a field of $size triangles" build/farcull bench "field:$size" \
    --peers none --methods boxes --json "$out/field-$size.json"
done
mapfile -t moving < <(moving_scenes)
step suite 2 "the test suite" env -u FARCULL_BUILT bash tests/run.sh
for scene in two-bunnies armadillo-elephant dragon-bunny near-copy bunnies-far-apart; do
  step "reliability-$scene" 3 "missed pairs of $scene, and of its copies" bash experiments/reliability.sh "$scene"
done
for scene in "${moving[@]}"; do
  step "motion-$scene" 3 "missed pairs in 100 frames of $scene" bash experiments/reliability.sh motion "$scene"
done
for scene in armadillo-elephant needles-layers needles-crossed "mannequin-devil --self" "armadillo --self" "bunny --self" \
  tree-leaves field:100000 crumpled spheres cad-cut funnel funnel:20000:144; do
  read -ra words <<<"$scene"
  bench 3 "${words[@]}"
done
devices=$device
if [[ $device != native ]]; then devices=$device,native; fi
# --resume keeps what an earlier call measured.
step studies 1 "all studies" build/farcull experiment all --devices "$devices" --resume --out "$out/results"

# ---- the report, the page, the archive ----

rm -f "$out/steps/report"
if [[ ! -e $out/results/results.sqlite ]]; then
  missing+=("report (of the studies): left out, no study was measured")
elif ! "${FARCULL_PYTHON:-/usr/bin/python3}" -c 'import matplotlib, pandas' 2>/dev/null; then
  missing+=("report (of the studies): left out, python3-matplotlib and python3-pandas are not here; elsewhere: farcull report DIR/results")
else
  # The report takes a minute. It is made even if no time is left.
  budget=$((budget + 600))
  step report 1 "the report of the studies" build/farcull report "$out/results" --device "$device"
fi

processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
renderer=$(sed -n '/"gl": {/,/}/ s/.*"renderer": "\(.*\)".*/\1/p' "$out/doctor.json" 2>/dev/null || true)
renderer=${renderer:-native, $processor}
name=$(tr '[:upper:]' '[:lower:]' <<<"$renderer" | sed 's/[^a-z0-9]\+/-/g; s/^-//; s/-$//' | cut -c 1-60)
if ((${#spent[@]})); then
  missing+=("left out, since the $minutes minutes are spent, ${#spent[@]} parts: ${spent[*]}")
fi
failed=()
for file in "$out"/steps/*; do
  if [[ $(<"$file") == 1\ * ]]; then failed+=("${file##*/}"); fi
done
# section HEADING PATTERNS...: prints the output of each part that is done and whose name matches a pattern.
# shellcheck disable=SC2016 # the backticks are those of the page
section() {
  local heading=$1 pattern part status seconds
  for pattern in "${@:2}"; do
    while read -r part; do
      if [[ -n $heading ]]; then printf '\n## %s\n' "$heading"; fi
      heading=''
      read -r status seconds <"$out/steps/$part"
      printf '\nPart `%s`, %d s%s:\n\n' "$part" "$seconds" "$(if ((status)); then echo ', **failed**'; fi)"
      # A long log is cut in the middle.
      awk '{ line[NR] = $0 }
        END {
          for (i = 1; i <= NR; i++)
            if (NR <= 120 || i <= 60 || i > NR - 60) print "    " line[i]
            else if (i == 61) print "    ..."
        }' "$out/logs/$part.txt"
    done < <(cd "$out/steps" && compgen -G "$pattern" | sort -V)
  done
}
# shellcheck disable=SC2016 # the backticks are those of the page
{
  printf '# %s\n\nMade by `bash experiments/hardware.sh` with %s, on %s; the budget of the last call was %s minutes.\n' \
    "$renderer" "$version" "$(date -u +%F)" "$minutes"
  printf '%s, %d threads, %s MiB of memory, %s.\n' "$processor" "$cores" \
    "$(awk '/^MemTotal/ { print int($2 / 1024) }' /proc/meminfo)" "$(sed -n 's/^PRETTY_NAME="\(.*\)"/\1/p' /etc/os-release 2>/dev/null)"
  printf '\n%d parts are done, %d failed%s.\n' "$(find "$out/steps" -type f | wc -l)" "${#failed[@]}" "${failed[*]:+: ${failed[*]}}"
  if ((${#missing[@]})); then
    printf '\nNot measured:\n\n'
    printf -- '- %s\n' "${missing[@]//"$farcull_root/"/}"
  fi
  section 'The assumptions' doctor
  section 'Missed pairs' misses 'reliability-*' 'motion-*'
  section 'Times beside other libraries' 'bench-*'
  section 'Growth' 'field-*'
  section 'The test suite' suite
  if [[ -e $out/results/report/results.md ]]; then
    printf '\n'
    # Lowers headings by one level. Removes figures, which are in the archive.
    sed '1s/^# .*/## The studies/; 2,$s/^#/##/; /^!\[/d' "$out/results/report/results.md"
  fi
} >"$out/$name.md"
if [[ $device == hardware ]]; then
  mkdir -p docs/results
  cp "$out/$name.md" docs/results/
  say "made docs/results/$name.md"
fi
# The archive gets its name when it is complete.
tar -czf "$out.tar.gz.part" -C "$(dirname "$out")" --exclude=lock --exclude=mesa_shader_cache \
  "$(basename "$out")"
mv "$out.tar.gz.part" "$out.tar.gz"
say "$(find "$out/steps" -type f | wc -l) parts are done, ${#failed[@]} failed, $((${#missing[@]} + (${#spent[@]} ? ${#spent[@]} - 1 : 0))) are not measured:"
if ((${#missing[@]})); then printf '  %s\n' "${missing[@]}"; fi
say "the page is $out/$name.md, the archive $out.tar.gz ($(du -h "$out.tar.gz" | cut -f 1))"
if ((${#failed[@]})); then exit 1; fi
if ((${#missing[@]})); then exit 3; fi
