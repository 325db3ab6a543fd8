#!/usr/bin/env bash
# Is a commit slower than another? Builds both, each from a clone in build/speed-guard/, and measures them in turn: boxes
# on scenes (farcull bench). The time of a scene in a turn is that of its fastest run, which other load on the machine disturbs least. For each row it prints the fastest time of each commit, and the
# median over the turns of the time of HEAD over that of BASE in the same turn, with the least and the greatest of these ratios.
#
#   bash experiments/speed_guard.sh BASE HEAD                          all scenes
#   bash experiments/speed_guard.sh HEAD~1 HEAD spheres 'funnel --self'   these scenes
#
# BASE and HEAD are commits as git names them; what is not committed is not measured. A scene that BASE does not have
# is skipped and named. Settings are variables of the environment:
#   TURNS=5         how often both are measured; they start alternately
#   REPEAT=5        runs of a scene in a turn, of which the fastest counts
#   THREADS=N       cores of boxes; default all there are. Where others use them, 1 is disturbed far less
#   PERCENT=10      a row is a warning if the median ratio is that much above 1,
#   MS=0.3          and the fastest time is also that many milliseconds longer
# Exit status: 0 no warning; 1 a warning: slower, or HEAD fails where BASE does not, or finds another number of pairs; 2 a commit
# could not be built or measured. Machines differ and are noisy: measure a warning again, with more turns, before it is believed.
set -euo pipefail

if [[ ${1-} == --help || ${1-} == -h ]]; then
  sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//;p}' "${BASH_SOURCE[0]}"
  exit 0
fi
if (($# < 2)); then
  echo "speed-guard: give two commits, the old one first; --help says more" >&2
  exit 2
fi

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"

turns=${TURNS:-5} repeat=${REPEAT:-5} threads=${THREADS:-$(nproc)}
percent=${PERCENT:-10} ms=${MS:-0.3}
sides=(base head)
declare -A commit tree
for side in "${sides[@]}"; do
  if ! commit[$side]=$(git rev-parse --verify --quiet --short=12 "$1^{commit}"); then
    echo "speed-guard: '$1' is no commit of this repository" >&2
    exit 2
  fi
  tree[$side]=$farcull_root/build/speed-guard/${commit[$side]}
  shift
done
scenes=("$@")
if ((${#scenes[@]} == 0)); then
  scenes=(crumpled spheres cad-cut funnel two-bunnies armadillo-elephant 'mannequin-devil --self' field:100000 needles-crossed)
fi
out=$farcull_root/build/speed-guard
times=$out/times.tsv       # a measured time per line: row, side, turn, nanoseconds
problems=$out/problems.txt # a warning per line that is no time

# clone_and_build SIDE: the commit in a clone of its own. A clone that is there is brought up to date, which takes no time.
clone_and_build() {
  local at=${tree[$1]}
  if [[ ! -e $at/.git ]]; then
    rm -rf "$at"
    git clone --quiet --shared --no-checkout "$farcull_root" "$at"
  fi
  git -C "$at" checkout --quiet --detach "${commit[$1]}"
  echo "speed-guard: $1 is ${commit[$1]}: $(git -C "$at" log -1 --format=%s)"
  farcull_root=$at
  farcull_build farcull
}

# run_scene SIDE SCENE REPEAT: prints the fastest run in nanoseconds and the number of pairs. The scene may be followed by options.
run_scene() {
  local -a scene
  read -ra scene <<<"$2"
  "${tree[$1]}/build/farcull" bench "${scene[@]}" --peers none --methods boxes --device cpu --threads "$threads" \
    --repeat "$3" --json "$out/run.json" >"$out/run.log" 2>&1 || return
  awk -F'[:,]' '/"min"/ && !ns { ns = $2 * 1e6 } /"pairs"/ && pairs == "" { pairs = $2 + 0 }
    END { printf "%.0f %d\n", ns, pairs }' "$out/run.json"
}

# known SCENE: whether both commits run it, and find the same number of pairs.
known() {
  local -A pairs
  local side ns
  for side in "${sides[@]}"; do
    if read -r ns "pairs[$side]" < <(run_scene "$side" "$1" 1); then continue; fi
    if [[ $side == base ]]; then
      echo "speed-guard: skipped: $1: ${commit[base]} does not run it: $(tail -n 1 "$out/run.log")"
    else
      echo "$1: HEAD does not run it: $(tail -n 1 "$out/run.log")" >>"$problems"
    fi
    return 1
  done
  if ((pairs[base] != pairs[head])); then
    echo "$1: BASE finds ${pairs[base]} pairs, HEAD ${pairs[head]}" >>"$problems"
  fi
}

# measure_scene SCENE SIDE TURN appends to $times.
measure_scene() {
  local ns pairs
  read -r ns pairs < <(run_scene "$2" "$1" "$repeat") || return
  printf '%s\t%s\t%s\t%s\n' "$1" "$2" "$3" "$ns" >>"$times"
}
# Prints a line per row of $times, and at the end those that are slower. Fails if there is one.
report() {
  awk -F'\t' -v percent="$percent" -v ms="$ms" '
    function median(list, n,   i, j, x) {  # sorts the list
      for (i = 2; i <= n; i++) {
        x = list[i]
        for (j = i - 1; j >= 1 && list[j] > x; j--) list[j + 1] = list[j]
        list[j + 1] = x
      }
      return n % 2 ? list[(n + 1) / 2] : (list[n / 2] + list[n / 2 + 1]) / 2
    }
    function in_units(ns) { return ns < 1e7 ? sprintf("%.3f ms", ns / 1e6) : sprintf("%.1f ms", ns / 1e6) }
    { if (!($1 in seen)) { seen[$1]; rows[++count] = $1 } time[$1, $2, $3] = $4; if ($3 > turns) turns = $3 }
    END {
      printf "%-36s %12s %12s %8s %16s\n", "row", "BASE", "HEAD", "ratio", "least - most"
      for (r = 1; r <= count; r++) {
        n = 0
        for (t = 1; t <= turns; t++) {
          if (!((rows[r], "base", t) in time) || !((rows[r], "head", t) in time)) continue
          base[++n] = time[rows[r], "base", t]; head[n] = time[rows[r], "head", t]
          ratio[n] = base[n] > 0 ? head[n] / base[n] : 1
        }
        if (n == 0) { skipped = skipped "skipped: " rows[r] ": one of the two does not have it\n"; continue }
        middle = median(ratio, n); median(base, n); median(head, n)
        old = base[1]; new = head[1]
        slower = middle > 1 + percent / 100 && new - old > ms * 1e6
        warnings += slower
        printf "%-36s %12s %12s %8.3f %7.3f - %6.3f%s\n", rows[r], in_units(old), in_units(new), middle, ratio[1], ratio[n], slower ? "  WARNING: slower" : ""
      }
      printf "%s", skipped
      exit warnings > 0
    }' "$times"
}

farcull_setup
bash experiments/meshes.sh || exit 2
export FARCULL_MESHES=${FARCULL_MESHES:-$farcull_root/build/meshes}
mkdir -p "$out"
: >"$times"
: >"$problems"
for side in "${sides[@]}"; do (clone_and_build "$side") || exit 2; done

measured=()
for scene in "${scenes[@]}"; do
  if known "$scene"; then measured+=("$scene"); fi
done
for ((turn = 1; turn <= turns; turn++)); do
  order=(base head)
  if ((turn % 2 == 0)); then order=(head base); fi
  for scene in "${measured[@]}"; do
    for side in "${order[@]}"; do measure_scene "$scene" "$side" "$turn" || exit 2; done
  done
done
status=0
report || status=1
if [[ -s $problems ]]; then
  sed 's/^/WARNING: /' "$problems"
  status=1
fi
echo "speed-guard: ${commit[head]} against ${commit[base]}, $turns turns, $threads threads, more than $percent % and $ms ms: \
$( ((status)) && echo 'there are warnings' || echo 'no warning')"
exit "$status"
