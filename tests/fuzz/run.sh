#!/usr/bin/env bash
# Fuzzes the readers of meshes and scene files and `check` of certificates, one target after the other, with clang's libFuzzer and
# the address and undefined behaviour sanitizers:
#   tests/fuzz/run.sh [SECONDS]   seconds per target (default: 60)
# It starts from the archives in tests/fuzz/corpus and from what earlier runs added to build-fuzz/corpus.
# Exit status: 0 no error was found; 1 an error was found, and its input is named (minimize it and add it to the corpus
# with the printed commands); 2 fuzzing did not start.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../../experiments/setup.sh"
cd "$farcull_root"

seconds=${1:-60}
if [[ ! $seconds =~ ^[1-9][0-9]{0,5}$ ]]; then
  echo "fuzz: '$seconds' is not a number of seconds" >&2
  exit 2
fi

farcull_packages+=(clang libclang-rt-dev)
farcull_setup
farcull_build_beside build-fuzz "fuzz_mesh fuzz_scene_file fuzz_check" -DFARCULL_FUZZ=ON \
  -DFARCULL_TESTS=OFF -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O1 -g1"

# fuzz TARGET CORPUS: runs the target and prints its statistics; status 1 if it found an error.
fuzz() {
  local corpus=build-fuzz/corpus/$2 seeds=build-fuzz/seeds/$2 log=build-fuzz/$1.log
  rm -rf "$seeds"
  mkdir -p "$corpus" "$seeds" build-fuzz/findings
  tar -xf "tests/fuzz/corpus/$2.tar.gz" -C "$seeds"
  cat tests/fuzz/common.dict "tests/fuzz/$2.dict" >"build-fuzz/$2.dict"
  echo "fuzz: $1 for $seconds s (all output: $log)"
  # The time limit finds hangs: an input of 4 KiB takes milliseconds. The targets compare every
  # allocation with the size of the input; the memory limits find allocations without operator new.
  if ! "build-fuzz/tests/fuzz/$1" "$corpus" "$seeds" -dict="build-fuzz/$2.dict" \
    -max_len=4096 -timeout=10 -malloc_limit_mb=64 -rss_limit_mb=2048 -max_total_time="$seconds" \
    -artifact_prefix="build-fuzz/findings/$1-" -print_final_stats=1 >"$log" 2>&1; then
    grep -E '^finding:|ERROR:|SUMMARY:|runtime error:|terminate called|what\(\)|written to' "$log" \
      >&2 || tail -n 20 "$log" >&2
    echo "fuzz: to minimize it: build-fuzz/tests/fuzz/$1 -minimize_crash=1 -runs=100000 FILE" >&2
    echo "fuzz: to add it: cd tests/fuzz/corpus && gunzip $2.tar.gz && tar -rf $2.tar -C FOLDER NAME && gzip -9n $2.tar" >&2
    return 1
  fi
  grep -E '^stat::(number_of_executed_units|slowest_unit_time_sec)' "$log"
}

status=0
fuzz fuzz_mesh mesh || status=1
fuzz fuzz_scene_file scene || status=1
fuzz fuzz_check check || status=1
exit "$status"
