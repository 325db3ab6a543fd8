#!/usr/bin/env bash
# The set-up that experiments/demo.sh and tests/run.sh share. Both source this file, call
# farcull_setup for the packages and farcull_build for the program; `bash experiments/setup.sh` by
# itself only installs the packages.
#
# It has to work where there is nothing but Debian and a checkout: no sudo, no git, no terminal,
# stdin closed, an empty environment. A second run installs and builds nothing.
set -euo pipefail

farcull_root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)

# Nothing here asks questions. With a closed stdin the next file that any program opens would become
# its stdin.
exec </dev/null
# dpkg refuses to run without PATH in the environment or without the sbin folders, which `su` and
# cron leave out.
export PATH="${PATH:-/usr/local/bin:/usr/bin:/bin}:/usr/local/sbin:/usr/sbin:/sbin"

farcull_packages=(
  # tools
  g++ cmake ninja-build pkg-config git
  # EGL and GL. Of these a headless context on Mesa's software device needs, when it runs, libegl1
  # with libegl-mesa0 (its vendor), libgl1-mesa-dri (llvmpipe itself) and libgl1 (epoxy opens
  # libOpenGL.so.0 or libGL.so.1 by name). The last two are named here because the package system
  # does not derive them from what the program is linked to.
  libegl-dev libepoxy-dev libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri
  # exact predicates, linear algebra, tests, command line, records
  libcgal-dev libgmp-dev libmpfr-dev libeigen3-dev libgtest-dev librapidcheck-dev libcli11-dev
  nlohmann-json3-dev libfmt-dev
  # results, pictures, figures
  libsqlitecpp-dev libsqlite3-dev libpng-dev gnuplot-nox
  # what farcull bench compares with, and the cases of single kernels; a build without them works
  libfcl-dev libembree-dev libtbb-dev libbenchmark-dev
  # what the test of the report opens its page with, and reads what it printed
  chromium poppler-utils sqlite3
)

# Prints those of farcull_packages that dpkg does not hold as completely installed, one per line.
farcull_missing() {
  local package held
  # It exits 1 when it does not know one of them, which is an answer and no failure.
  # shellcheck disable=SC2016  # the format is dpkg's, not the shell's
  local format='${Package} ${db:Status-Status}\n'
  held=$(dpkg-query -W -f "$format" "${farcull_packages[@]}" 2>/dev/null) || true
  for package in "${farcull_packages[@]}"; do
    [[ $'\n'$held$'\n' == *$'\n'"$package installed"$'\n'* ]] || printf '%s\n' "$package"
  done
}

# Runs a command of the package system as root, without questions.
farcull_as_root() {
  local -a command=(env DEBIAN_FRONTEND=noninteractive LC_ALL=C "$@")
  if ((EUID == 0)); then "${command[@]}"; else sudo "${command[@]}"; fi
}

# apt-get, waiting for another apt that holds the lock (a new machine upgrades itself in the
# background).
farcull_apt_get() { farcull_as_root apt-get -o DPkg::Lock::Timeout=300 "$@"; }

# farcull_install PACKAGES...: one attempt. `update` may fail for a source that has nothing to do
# with us; `install` decides.
farcull_install() {
  farcull_apt_get update || echo "apt-get update failed; trying with the lists that are there"
  farcull_apt_get install --yes --no-install-recommends "$@"
}

# Installs the packages that are missing. Status 2, with what to do, where that is impossible.
farcull_setup() {
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    echo "setup: no apt-get here, so nothing is installed; CMake names what it does not find" >&2
    return 0
  fi
  local -a missing
  mapfile -t missing < <(farcull_missing)
  ((${#missing[@]})) || return 0

  if ((EUID != 0)) && ! command -v sudo >/dev/null; then
    printf '%s\n' "setup: packages are missing; installing them takes root or sudo. As root, run:" \
      "  apt-get install --no-install-recommends ${missing[*]}" >&2
    return 2
  fi
  local log=$farcull_root/build/setup.log
  mkdir -p "$farcull_root/build" || return 2
  echo "setup: installing ${#missing[@]} packages: ${missing[*]}"
  if ! farcull_install "${missing[@]}" >"$log" 2>&1; then
    # Once more, after a pause for the network, and after finishing what an installation killed
    # earlier left undone.
    sleep 5
    farcull_as_root dpkg --configure -a >>"$log" 2>&1 || true
    if ! farcull_install "${missing[@]}" >>"$log" 2>&1; then
      # The first complaints are the causes (a name that does not resolve, a full disk), the last
      # only follow.
      awk '/^[WE]:/ && !seen[$0]++ && ++n <= 8' "$log" >&2
      printf '%s\n' "setup: installing failed twice (apt's output: build/setup.log). By hand:" \
        "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
      return 2
    fi
  fi
}

# How many compilers may run at once: one per core, but one per 2 GiB of memory, which is what a
# file full of CGAL takes. CMAKE_BUILD_PARALLEL_LEVEL, CMake's own variable, overrides it.
farcull_jobs() {
  if [[ -n ${CMAKE_BUILD_PARALLEL_LEVEL:-} ]]; then
    printf '%s\n' "$CMAKE_BUILD_PARALLEL_LEVEL"
    return
  fi
  local cores bytes file limit jobs
  cores=$(nproc 2>/dev/null || getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)
  jobs=$cores
  if [[ -r /proc/meminfo ]]; then
    bytes=$(awk '/^MemAvailable:/ { printf "%.0f", $2 * 1024 }' /proc/meminfo)
    # In a container meminfo is the host's; the limit is the control group's (version 2, version 1).
    for file in /sys/fs/cgroup/memory.max /sys/fs/cgroup/memory/memory.limit_in_bytes; do
      limit=$(cat "$file" 2>/dev/null) || continue
      if [[ $limit =~ ^[0-9]+$ ]] && ((limit < bytes)); then bytes=$limit; fi
    done
    if ((bytes / 2147483648 < jobs)); then jobs=$((bytes / 2147483648)); fi
  fi
  printf '%s\n' $((jobs > 1 ? jobs : 1))
}

# The value of a CMake cache entry of the build folder, empty where there is none.
farcull_cached() {
  sed -n "s/^$1:[^=]*=//p" "$farcull_root/build/CMakeCache.txt" 2>/dev/null || true
}

# Configures build/ as Release with the tests, unless it is so already; CMake itself notices changed
# CMakeLists.txt.
farcull_configure() {
  local build=$farcull_root/build
  local -a how=()
  if [[ -e $build/build.ninja || -e $build/Makefile ]]; then
    # A folder that works keeps its generator.
    if [[ $(farcull_cached CMAKE_BUILD_TYPE) == Release &&
      $(farcull_cached FARCULL_TESTS) == ON ]]; then
      return 0
    fi
  else
    # What an unfinished configuration remembers (a generator without its tool, say) must not bind
    # this one.
    rm -rf "$build/CMakeCache.txt" "$build/CMakeFiles"
    if command -v ninja >/dev/null; then how=(-G Ninja); fi
  fi
  local said
  how+=(-DCMAKE_BUILD_TYPE=Release -DFARCULL_TESTS=ON)
  if ! said=$(cmake -S "$farcull_root" -B "$build" "${how[@]}" 2>&1); then
    printf '%s\n' "$said" "build: CMake could not configure build/" >&2
    return 2
  fi
}

# farcull_progress JOBS LOG: reads the output of a build, from Ninja or make; lets through what
# compilers and linkers say (stderr), and of the steps only every fifth part of the way, so that a
# long build is not silent.
farcull_progress() {
  local line percent said=-1
  local steps='^\[ *([0-9]+)(/([0-9]+)|%)\] (.*)$'
  while IFS= read -r line; do
    if [[ $line =~ $steps ]]; then
      # The step that notes the commit runs in every build; it is no news.
      [[ ${BASH_REMATCH[4]} == Building* || ${BASH_REMATCH[4]} == Linking* ]] || continue
      percent=${BASH_REMATCH[1]}
      if [[ -n ${BASH_REMATCH[3]} ]]; then percent=$((100 * percent / BASH_REMATCH[3])); fi
      if ((said < 0)); then
        echo "build: compiling, $1 at a time (all output: $2)"
        said=0
      fi
      if ((percent < 100 && percent / 20 > said / 20)); then
        echo "build: $percent %"
        said=$percent
      fi
      continue
    fi
    case $line in
      '' | '-- '* | 'ninja: no work to do.' | 'ninja: Entering directory'*) ;;
      *make*': '*' directory '*) ;;
      'Consolidate compiler generated dependencies'* | 'Scanning dependencies'*) ;;
      *) printf '%s\n' "$line" >&2 ;;
    esac
  done
}

# farcull_build [TARGETS...]: brings build/ up to date, everything where no target is named. Prints
# one line when there is nothing to do; otherwise how far it is, and what the compilers complain
# about.
farcull_build() {
  local build=$farcull_root/build started=$SECONDS jobs steps
  local -a what=()
  if (($#)); then what=(--target "$@"); fi
  if ! command -v cmake >/dev/null; then
    echo "build: cmake is missing (Debian: cmake); it will name whatever else is missing" >&2
    return 2
  fi
  farcull_configure || return
  jobs=$(farcull_jobs)
  what+=(--config Release --parallel "$jobs")
  if ! NINJA_STATUS='[%f/%t] ' LC_ALL=C cmake --build "$build" "${what[@]}" 2>&1 |
    tee "$build/build.log" | farcull_progress "$jobs" build/build.log; then
    echo "build: failed (all output: build/build.log)" >&2
    return 2
  fi
  steps=$(grep -cE '^\[[^]]*\] (Building|Linking)' "$build/build.log" || true)
  if ((steps)); then
    echo "build: done in $((SECONDS - started)) s (Release, build/)"
  else
    echo "build: up to date (Release, build/)"
  fi
}

# farcull_build_beside FOLDER "TARGETS" CMAKE-OPTIONS...: brings targets up to date in a folder
# beside build/.
farcull_build_beside() {
  local build=$farcull_root/$1 log=$1/build.log started=$SECONDS jobs said
  local -a targets how=()
  read -ra targets <<<"$2"
  shift 2
  if [[ ! -e $build/CMakeCache.txt ]] && command -v ninja >/dev/null; then how=(-G Ninja); fi
  if ! said=$(cmake -S "$farcull_root" -B "$build" "${how[@]}" "$@" 2>&1); then
    printf '%s\n' "$said" "build: CMake could not configure ${log%/*}/" >&2
    return 2
  fi
  jobs=$(farcull_jobs)
  if ! NINJA_STATUS='[%f/%t] ' LC_ALL=C cmake --build "$build" --parallel "$jobs" \
    --target "${targets[@]}" 2>&1 | tee "$farcull_root/$log" | farcull_progress "$jobs" "$log"; then
    echo "build: failed (all output: $log)" >&2
    return 2
  fi
  echo "build: ${targets[*]} done in $((SECONDS - started)) s (${log%/*}/)"
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then farcull_setup; fi
