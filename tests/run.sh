#!/usr/bin/env bash
# All tests in one command, on a machine with nothing but Debian and a checkout. It installs the
# packages that are missing, builds, fetches real meshes and runs ctest. Arguments go to ctest, for
# example: bash tests/run.sh -R Scene
# If the first argument is --sanitize, the tests that need no GL run a second time, built with the
# address and undefined behaviour sanitizers. If CI is set, only those of what handles memory by
# numbers or reads the files of strangers (FARCULL_TESTS_OF=inner in tests/CMakeLists.txt) and the
# fuzz targets on their corpus, for two instruction sets of the CPU: a sixth of the time.
# If the first argument is --long, the campaigns of docs/tests.md run one after the other instead: hours. Those that passed at
# this commit are not run again, and words behind --long choose some: bash tests/run.sh --long polygons odr
# Exit status: 0 every test passed, and there was at least one; 2 the tests did not start; otherwise
# that of ctest, or 1 if a campaign failed.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../experiments/setup.sh"
cd "$farcull_root"

# Campaigns: a name, and a command in the folder of the checkout.
campaigns=(
  "seeds bash tests/seeds.sh"
  "trials FARCULL_TRIALS=all ctest --test-dir build --output-on-failure -L 'one|gl'"
  "rounding FARCULL_ROUNDING_PAIRS=320000 build/tests/farcull_tests --gtest_filter=WorstRounding.LosesNoPair*"
  "polygons FARCULL_POLYGONS=1000000 build/tests/farcull_tests --gtest_filter=Polygons.*"
  "model FARCULL_MODEL_TRIALS=1000000 ctest --test-dir build --output-on-failure -R CullModel"
  "reliability bash experiments/reliability.sh"
  "reliability_boxes bash experiments/reliability.sh boxes"
  "reliability_motion bash experiments/reliability.sh motion"
  "distances FARCULL_DISTANCES=100000 build/tests/farcull_tests --gtest_filter=Distances.*Random*"
  "reliability_distances bash experiments/reliability.sh distances"
  "oracles bash tests/oracles.sh"
  "odr bash tests/odr.sh"
  "coq bash tests/coq.sh --long"
  "fuzz bash tests/fuzz/run.sh"
  "gl_loops bash tests/gl_loops.sh"
  "gl_loops_late bash tests/gl_loops.sh 20 --late"
  "gl_loops_address bash tests/gl_loops.sh 20 --address"
  "mutants bash tests/mutants.sh"
  "results /usr/bin/python3 tests/results_test.py"
)

# run_campaigns [NAMES...]: runs those, or all; keeps the output of each in build/long/NAME.log, and build/long/NAME.COMMIT
# where it passed. Prints a line for each; status 1 if one failed.
run_campaigns() {
  local commit campaign name log failed=0 status wanted=" $* " started
  commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
  mkdir -p build/long
  for campaign in "${campaigns[@]}"; do
    name=${campaign%% *} started=$SECONDS
    log=build/long/$name.log
    if (($#)) && [[ $wanted != *" $name "* ]]; then continue; fi
    wanted=${wanted/" $name "/ }
    if [[ -e build/long/$name.$commit && $name != seeds ]]; then # whose inputs are new every day
      echo "long: $name passed at $commit before"
      continue
    fi
    echo "long: ${campaign#* }  (output: $log)"
    if (eval "${campaign#* }") >"$log" 2>&1; then
      date >"build/long/$name.$commit"
      echo "long: $name passed in $((SECONDS - started)) s"
    else
      status=$?
      failed=1
      echo "long: $name FAILED with status $status after $((SECONDS - started)) s; the output ends with"
      tail -n 5 "$log" | sed 's/^/  /'
    fi
  done
  if [[ $wanted =~ [^\ ] ]]; then
    echo "long: no campaign is called${wanted% }; there are: $(printf '%s\n' "${campaigns[@]%% *}" | tr '\n' ' ')" >&2
    return 2
  fi
  return "$failed"
}

sanitize=${CI:+inner}
if [[ ${1-} == --sanitize ]]; then
  sanitize=all
  shift
fi

# Tests labelled "rare" need 300 MB of packages: a browser and TeX. CI and campaigns run them, and who names tests.
left_out=()
farcull_packages+=("${farcull_test_packages[@]}")
if [[ ${CI-} || ${1-} == --long ]]; then
  farcull_packages+=("${farcull_rare_packages[@]}")
elif (($# == 0)); then
  left_out=(rare)
fi
farcull_setup
farcull_build all

if [[ ${1-} == --long ]]; then
  bash experiments/meshes.sh
  run_campaigns "${@:2}"
  exit
fi

status=0
bash experiments/meshes.sh || status=$?
if ((status == 3)); then
  left_out+=(meshes)
elif ((status)); then
  exit 2
fi
without=()
if ((${#left_out[@]})); then
  pattern="^($(IFS='|' && echo "${left_out[*]}"))\$"
  without=(-LE "$pattern")
  echo "tests: NOT RUN: those of packaged meshes that are missing, and rare ones (CI=1 bash tests/run.sh runs these):"
  # The list names the tests that are left out, and ends with their number.
  ctest --test-dir build -C Release -N -L "$pattern" | grep -E '^ +Test +#|^Total Tests'
fi

# One test for each core at a time. Tests that must run alone have a ctest property that says so.
ctest --test-dir build -C Release --output-on-failure --no-tests=error \
  -j "$(nproc 2>/dev/null || echo 1)" "${without[@]}" "$@"

[[ -n $sanitize ]] || exit 0
# Tests that need GL are left out and named: Mesa is not built with sanitizers, and its leaks would be
# reported as ours.
echo "tests: a second time, with sanitizers ($sanitize)"
fewer=()
if [[ $sanitize == inner ]]; then fewer=(-DFARCULL_GL=OFF "-DFARCULL_WITHOUT_LANES=HWY_SSE4|HWY_AVX3"); fi
farcull_build_beside build-sanitize "farcull_tests farcull_fuzz_replay" -DFARCULL_TESTS_OF="$sanitize" "${fewer[@]}" \
  -DFARCULL_SANITIZE=address,undefined -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
pattern=gl
if ((status == 3)); then pattern='gl|meshes'; fi
# Without arguments many tests share a process; with arguments each is found by its name.
shape=one
if (($#)); then shape=shard; fi
ctest --test-dir build-sanitize -N -L "^($pattern)$" | grep -E '^ +Test +#|^Total Tests' |
  sed 's/^/  not run with sanitizers:/' || true
# Nor is the program built with sanitizers, so tests that call it are left out.
program='^(cli\.|readme$)'
ctest --test-dir build-sanitize -N -R "$program" -LE "^($pattern)$" | grep -E '^ +Test +#' |
  sed 's/^/  not run with sanitizers:/' || true
ctest --test-dir build-sanitize --output-on-failure --no-tests=error \
  -j "$(nproc 2>/dev/null || echo 1)" -LE "^($pattern|$shape)$" -E "$program" "$@"
