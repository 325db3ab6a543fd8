#!/usr/bin/env bash
# Runs the GL tests of FAR many times on a busy machine, and names each run that fails, crashes or hangs.
# Faults that depend on timing show only this way: those of llvmpipe's threads were found by this script
# (docs/drivers.md).
#   bash tests/gl_loops.sh [LOOPS]      default 200, some hours on two cores; needs a build in build/
#     --filter TESTS     which tests, as in --gtest_filter; default GlFar.*
#     --late             every thread but the first one waits before it wakes others, so that faults of
#                        timing show sooner
#     --address          builds with the address sanitizer in build-address/ (an hour), runs the fault
#                        tests and all GL tests once, then the loops
#     --idle             starts no busy processes; without it there is one for each core
# LP_NUM_THREADS is taken from the environment: with 1 or 2 threads, --late fails at once.
# Exit status: 0 all passed; 1 not all; 2 it did not start.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../experiments/setup.sh"
cd "$farcull_root"

loops=200 filter='GlFar.*' folder=build preload='' busy=yes
while (($#)); do
  case $1 in
    --filter)
      filter=${2:?--filter needs a value}
      shift
      ;;
    --late) preload=build/tests/libfarcull_late_wakeups.so ;;
    --address) folder='build-address' ;;
    --idle) busy='' ;;
    *)
      if [[ ! $1 =~ ^[1-9][0-9]*$ ]]; then
        echo "gl_loops: '$1' is no number of loops" >&2
        exit 2
      fi
      loops=$1
      ;;
  esac
  shift
done

if [[ $folder == build-address ]]; then
  farcull_build_beside build-address "farcull_gl_tests farcull_fault_tests" -DFARCULL_SANITIZE=address \
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
  export ASAN_OPTIONS=detect_leaks=0 # Mesa's leaks would be reported as ours
  "$folder/tests/farcull_fault_tests" --gtest_brief=1
  "$folder/tests/farcull_gl_tests" --gtest_brief=1
fi
tests=$folder/tests/farcull_gl_tests
for file in "$tests" $preload; do
  if [[ ! -e $file ]]; then
    echo "gl_loops: $file is missing; build it first" >&2
    exit 2
  fi
done

beside=()
stop() { ((${#beside[@]} == 0)) || kill "${beside[@]}" 2>/dev/null || true; }
trap stop EXIT
if [[ -n $busy ]]; then
  for ((core = 0; core < $(nproc); ++core)); do
    while :; do :; done &
    beside+=($!)
  done
fi

log=$(mktemp)
failed=0
for ((loop = 1; loop <= loops; ++loop)); do
  status=0
  env ${preload:+LD_PRELOAD="$PWD/$preload"} timeout 900 "$tests" --gtest_brief=1 --gtest_filter="$filter" >"$log" 2>&1 ||
    status=$?
  if ((status)); then
    ((failed += 1))
    echo "loop $loop: ended with status $status$( ((status == 124)) && echo ', it hangs')"
    tail -n 5 "$log"
  elif ((loop % 10 == 0)); then
    echo "loop $loop of $loops"
  fi
done
rm -f "$log"
echo "$((loops - failed)) passed, $failed failed"
((failed == 0))
