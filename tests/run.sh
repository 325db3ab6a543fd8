#!/usr/bin/env bash
# All tests in one command, on a machine with nothing but Debian and a checkout: installs what is
# missing, builds, fetches real meshes, runs ctest. Arguments are passed on to ctest, for example:
# bash tests/run.sh -R Scene
# Where the first argument is --sanitize, or CI is set, the tests that need no GL run once more,
# built with the address and undefined behaviour sanitizers.
# Exit status: 0 every test passed, and there was at least one; 2 it did not come to the tests;
# otherwise ctest's.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../experiments/setup.sh"
cd "$farcull_root"

sanitize=${CI:-}
if [[ ${1-} == --sanitize ]]; then
  sanitize=yes
  shift
fi

farcull_setup
farcull_build all

without=()
status=0
bash experiments/meshes.sh || status=$?
if ((status == 3)); then
  without=(-LE '^meshes$')
  echo "tests: NOT RUN for want of the packaged meshes:"
  # Whatever is left out is named; the list ends with their number.
  ctest --test-dir build -C Release -N -L '^meshes$' | grep -E '^ +Test +#|^Total Tests'
elif ((status)); then
  exit 2
fi

# As many at once as there are cores; tests that may not share the machine say so in their ctest
# properties.
ctest --test-dir build -C Release --output-on-failure --no-tests=error \
  -j "$(nproc 2>/dev/null || echo 1)" "${without[@]}" "$@"

[[ -n $sanitize ]] || exit 0
# Mesa is not sanitized and its leaks would be reported as ours: what needs GL is left out, by name.
echo "tests: once more, with sanitizers"
farcull_build_beside build-sanitize "farcull_tests farcull_fuzz_replay" \
  -DFARCULL_SANITIZE=address,undefined -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
left_out='^gl$'
if ((${#without[@]})); then left_out='^(gl|meshes)$'; fi
ctest --test-dir build-sanitize -N -L "$left_out" | grep -E '^ +Test +#|^Total Tests' |
  sed 's/^/  not run with them:/' || true
ctest --test-dir build-sanitize --output-on-failure --no-tests=error \
  -j "$(nproc 2>/dev/null || echo 1)" -LE "$left_out" "$@"
