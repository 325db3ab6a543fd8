#!/usr/bin/env bash
# Fuzzes the readers of meshes and scene files and `check`, with clang's libFuzzer and the address
# and undefined behaviour sanitizers, one target after the other:
#   tests/fuzz/run.sh [SECONDS]   seconds per target (default: 60)
# It starts from tests/fuzz/corpus and what earlier runs added to build-fuzz/corpus. Exit status:
# 0 nothing was found; 1 a finding, which is named (minimize it with the printed command, then add
# it to the corpus); 2 it did not come to fuzzing.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../../experiments/setup.sh"
cd "$farcull_root"

seconds=${1:-60}
if [[ ! $seconds =~ ^[1-9][0-9]{0,5}$ ]]; then
  echo "fuzz: '$seconds' is no number of seconds" >&2
  exit 2
fi

farcull_packages+=(clang libclang-rt-dev)
farcull_setup
farcull_build_beside build-fuzz "fuzz_mesh fuzz_scene_file fuzz_check" -DFARCULL_FUZZ=ON \
  -DFARCULL_TESTS=OFF -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O1 -g1"

# fuzz TARGET CORPUS: prints what the target did; status 1 where something was found.
fuzz() {
  local corpus=build-fuzz/corpus/$2 log=build-fuzz/$1.log
  mkdir -p "$corpus" build-fuzz/findings
  echo "fuzz: $1 for $seconds s (all output: $log)"
  # Hangs: an input of 4 KiB takes milliseconds. Memory: the targets hold every allocation against
  # the size of the input; these limits catch what does not pass through operator new.
  if ! "build-fuzz/tests/fuzz/$1" "$corpus" "tests/fuzz/corpus/$2" -dict="tests/fuzz/$2.dict" \
    -max_len=4096 -timeout=10 -malloc_limit_mb=64 -rss_limit_mb=2048 -max_total_time="$seconds" \
    -artifact_prefix="build-fuzz/findings/$1-" -print_final_stats=1 >"$log" 2>&1; then
    grep -E '^finding:|ERROR:|SUMMARY:|runtime error:|terminate called|what\(\)|written to' "$log" \
      >&2 || tail -n 20 "$log" >&2
    echo "fuzz: to minimize it: build-fuzz/tests/fuzz/$1 -minimize_crash=1 -runs=100000 FILE" >&2
    return 1
  fi
  grep -E '^stat::(number_of_executed_units|slowest_unit_time_sec)' "$log"
}

status=0
fuzz fuzz_mesh mesh || status=1
fuzz fuzz_scene_file scene || status=1
fuzz fuzz_check check || status=1
exit "$status"
