#!/usr/bin/env bash
# All tests in one command, on a machine with nothing but Debian and a checkout: installs what is
# missing, builds, fetches real meshes, runs ctest. Arguments are passed on to ctest, for example:
# bash tests/run.sh -R Scene
# Exit status: 0 every test passed, and there was at least one; 2 it did not come to the tests;
# otherwise ctest's.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../experiments/setup.sh"
cd "$farcull_root"

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
