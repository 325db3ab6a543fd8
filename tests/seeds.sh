#!/usr/bin/env bash
# Runs the random tests with many seeds, on all cores, and prints the tests that fail.
#   bash tests/seeds.sh [SEEDS [FIRST]]
# SEEDS: how many, 50 by default. FIRST: the first one; by default FARCULL_SEED, else by the date, so that inputs are tried that
# nobody has tried before. Needs a build in build/.
# Random tests are those that read FARCULL_SEED (test_seed() of tests/lab/test.h), and the properties of rapidcheck. All tests
# run once, which shows which ones those are; build/seeds keeps their names and the output of each seed.
# Exit status: 0 none failed; 1 some did; 2 it did not start.
set -euo pipefail
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."

program=build/tests/farcull_tests names=build/seeds/names
seeds=${1:-50} first=${2:-${FARCULL_SEED:-$(date -u +%Y%m%d)000}}
if [[ ! -x $program || ! $seeds$first =~ ^[0-9]+$ ]]; then
  echo "seeds: ${program} is missing, or no number: $seeds, $first" >&2
  exit 2
fi
cores=$(nproc)
mkdir -p build/seeds

if [[ ! $names -nt $program ]]; then
  for ((i = 0; i < cores; ++i)); do
    FARCULL_SEED=$first GTEST_TOTAL_SHARDS=$cores GTEST_SHARD_INDEX=$i "$program" --gtest_brief=1 \
      --gtest_filter='-PackagedScenes.*' --gtest_output="json:build/seeds/shard$i.json" >"build/seeds/shard$i.log" 2>&1 &
  done
  wait
  {
    grep -rhoP --include='*_test.cpp' 'RC_GTEST_PROP\(\K\w+, \w+' tests | sed 's/, /./'
    python3 - build/seeds/shard*.json <<'END'
import json, sys
for file in sys.argv[1:]:
    for suite in json.load(open(file))['testsuites']:
        for test in suite['testsuite']:
            if 'reads_the_seed' in test:
                print(f"{suite['name']}.{test['name']}")
END
  } | sort -u >build/seeds/found
  mv build/seeds/found "$names"
fi
echo "seeds: $(wc -l <"$names") random tests, seeds $first to $((first + seeds - 1)); output in build/seeds"

# shellcheck disable=SC2317 # xargs calls it
run_seed() {
  if FARCULL_SEED=$1 "$2" --gtest_brief=1 --gtest_filter="$(paste -sd: "$3")" >"build/seeds/$1.log" 2>&1; then return 0; fi
  sed -n "s/^\[  FAILED  \] \([A-Za-z0-9_./]*\).*(.*/seeds: FARCULL_SEED=$1: \1 failed/p" "build/seeds/$1.log"
  echo "seeds: FARCULL_SEED=$1 failed; build/seeds/$1.log says how"
  return 1
}
export -f run_seed
status=0
seq "$first" "$((first + seeds - 1))" | xargs -P "$cores" -I{} bash -c 'run_seed {} "$@"' - "$program" "$names" || status=1
((status)) || echo "seeds: none failed"
exit "$status"
