#!/usr/bin/env bash
# Functions that install packages and build. The scripts in experiments/ and tests/ use them.
# A script sources this file, then calls farcull_setup for the packages and farcull_build for the
# program. `bash experiments/setup.sh` by itself installs the packages and does nothing else.
# The script must work where there is nothing but Debian and a checkout: no sudo, no git, no terminal, a
# closed stdin, an empty environment. A second run installs and builds nothing.
set -euo pipefail

farcull_root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)

# If stdin were closed, the next file that a program opens would become its stdin.
exec </dev/null
# dpkg needs PATH in the environment, including the sbin folders. `su` and cron leave out the sbin folders.
export PATH="${PATH:-/usr/local/bin:/usr/bin:/bin}:/usr/local/sbin:/usr/sbin:/sbin"

# Packages that the program needs, and that CMake looks for when it configures the tests.
farcull_packages=(
  # tools for building
  g++ cmake ninja-build pkg-config git
  # EGL and GL. A context without a window on Mesa's software device needs libegl1 with libegl-mesa0
  # (its vendor), libgl1-mesa-dri (llvmpipe itself) and libgl1 (epoxy opens libOpenGL.so.0 or
  # libGL.so.1 by name). The last two are named here because the program is not linked to them.
  libegl-dev libepoxy-dev libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri
  # exact predicates, linear algebra, SIMD, tests, command line, JSON, formatted text
  libcgal-dev libboost-dev libgmp-dev libmpfr-dev libeigen3-dev libhwy-dev libgtest-dev librapidcheck-dev libcli11-dev
  nlohmann-json3-dev libfmt-dev
  # compressed meshes
  zlib1g-dev
  # the database of results, pictures, figures
  libsqlitecpp-dev libsqlite3-dev libpango1.0-dev libcairo2-dev fonts-dejavu-core
  # the report of measurements
  python3-matplotlib python3-pandas
  # web pages with three-dimensional pictures; the build works without this package
  libjs-three
  # the Python module; the build works without these packages
  python3-dev pybind11-dev python3-numpy
  # libraries that farcull bench compares with; the build works without these packages
  libfcl-dev libembree-dev libbullet-dev libode-dev
)
# Packages that only tests need. A test that lacks its package is skipped, and names the package. gappa proves the bounds of
# rounding errors. Tests of the Python module use pytest and hypothesis, and install the module into a virtual environment.
farcull_test_packages=(gappa python3 sqlite3 python3-pytest python3-hypothesis python3-venv python3-pip)
# Packages (300 MB) of tests that are labelled "rare". These tests open pages in a browser, and make PDFs with LaTeX.
farcull_rare_packages=(chromium poppler-utils texlive-latex-base pandoc texlive-latex-recommended lmodern librsvg2-bin)

# Prints the packages of farcull_packages that are not completely installed, one per line.
farcull_missing() {
  local package held
  # shellcheck disable=SC2016  # the format is dpkg's, not the shell's
  local format='${Package} ${db:Status-Status}\n'
  # dpkg-query exits with 1 if it does not know a package. That is no failure.
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

# farcull_install PACKAGES...: tries once to install. `update` may fail because of a source that is not needed, so only the status
# of `install` counts. apt-get waits while another apt holds the lock, since a new machine upgrades itself in the background.
farcull_install() {
  local -a apt_get=(farcull_as_root apt-get -o DPkg::Lock::Timeout=300)
  "${apt_get[@]}" update || echo "apt-get update failed; trying with the lists that are there"
  "${apt_get[@]}" install --yes --no-install-recommends "$@"
}

# Installs the missing packages of farcull_packages. If installing is impossible, prints what to do, and returns
# 2. A script that needs more packages first appends them to farcull_packages. Nothing is installed if
# FARCULL_BUILT is set, since the program is built already.
farcull_setup() {
  if [[ -n ${FARCULL_BUILT-} ]]; then return 0; fi
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
    # Waits in case the network fails briefly. dpkg completes an interrupted installation. Then the second attempt follows.
    sleep 5
    farcull_as_root dpkg --configure -a >>"$log" 2>&1 || true
    if ! farcull_install "${missing[@]}" >>"$log" 2>&1; then
      # Prints the first messages, which name the causes, such as a full disk. Later messages are consequences.
      awk '/^[WE]:/ && !seen[$0]++ && ++n <= 8' "$log" >&2
      printf '%s\n' "setup: installing failed twice (apt's output: build/setup.log). By hand:" \
        "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
      return 2
    fi
  fi
}

# Prints how many compilers may run at once: one for each core, but at most one for each 2 GiB of memory, since a file that
# includes CGAL takes 2 GiB. CMake's variable CMAKE_BUILD_PARALLEL_LEVEL overrides this number.
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
    # In a container, meminfo describes the host. The container's limit is in the files of control groups, version 2 or 1.
    for file in /sys/fs/cgroup/memory.max /sys/fs/cgroup/memory/memory.limit_in_bytes; do
      limit=$(cat "$file" 2>/dev/null) || continue
      if [[ $limit =~ ^[0-9]+$ ]] && ((limit < bytes)); then bytes=$limit; fi
    done
    if ((bytes / 2147483648 < jobs)); then jobs=$((bytes / 2147483648)); fi
  fi
  printf '%s\n' $((jobs > 1 ? jobs : 1))
}

# Configures build/ as Release with the tests, unless this is done already. CMake itself notices a changed CMakeLists.txt.
farcull_configure() {
  local build=$farcull_root/build
  local -a how=()
  if [[ -e $build/build.ninja || -e $build/Makefile ]]; then
    # A configured folder keeps its generator.
    if [[ $(grep -cE '^(CMAKE_BUILD_TYPE:[^=]*=Release|FARCULL_TESTS:[^=]*=ON)$' "$build/CMakeCache.txt") == 2 ]]; then
      return 0
    fi
  else
    # An unfinished configuration may have stored settings that do not work, such as a generator whose tool is missing.
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

# farcull_progress JOBS LOG: reads the output of a build by Ninja or make. It prints the messages of
# compilers and linkers on stderr, and a line after each fifth of the steps.
farcull_progress() {
  local line percent said=-1
  local steps='^\[ *([0-9]+)(/([0-9]+)|%)\] (.*)$'
  while IFS= read -r line; do
    if [[ $line =~ $steps ]]; then
      # The step that stores the commit runs in every build, so it is not counted.
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

# farcull_make FOLDER OPTIONS...: builds in this folder, with the options of `cmake --build`. It prints
# the progress and the messages of the compilers.
farcull_make() {
  local folder=$1 jobs
  jobs=$(farcull_jobs)
  if ! NINJA_STATUS='[%f/%t] ' LC_ALL=C cmake --build "$farcull_root/$folder" --parallel "$jobs" "${@:2}" 2>&1 |
    tee "$farcull_root/$folder/build.log" | farcull_progress "$jobs" "$folder/build.log"; then
    echo "build: failed (all output: $folder/build.log)" >&2
    return 2
  fi
}

# farcull_build [TARGETS...]: brings the targets in build/ up to date, or all targets if none is named. If
# there is nothing to do, it prints one line.
farcull_build() {
  if [[ -n ${FARCULL_BUILT-} ]]; then return 0; fi
  local started=$SECONDS steps
  local -a what=(--config Release)
  if (($#)); then what+=(--target "$@"); fi
  if ! command -v cmake >/dev/null; then
    echo "build: cmake is missing (Debian: cmake); it will name whatever else is missing" >&2
    return 2
  fi
  farcull_configure || return
  farcull_make build "${what[@]}" || return
  steps=$(grep -cE '^\[[^]]*\] (Building|Linking)' "$farcull_root/build/build.log" || true)
  if ((steps)); then
    echo "build: done in $((SECONDS - started)) s (Release, build/)"
  else
    echo "build: up to date (Release, build/)"
  fi
}

# farcull_build_beside FOLDER "TARGETS" CMAKE-OPTIONS...: brings targets up to date in another build folder.
farcull_build_beside() {
  local folder=$1 started=$SECONDS said
  local build=$farcull_root/$1
  local -a targets how=()
  read -ra targets <<<"$2"
  if [[ ! -e $build/CMakeCache.txt ]] && command -v ninja >/dev/null; then how=(-G Ninja); fi
  if ! said=$(cmake -S "$farcull_root" -B "$build" "${how[@]}" "${@:3}" 2>&1); then
    printf '%s\n' "$said" "build: CMake could not configure $folder/" >&2
    return 2
  fi
  farcull_make "$folder" --target "${targets[@]}" || return
  echo "build: ${targets[*]} done in $((SECONDS - started)) s ($folder/)"
}

# farcull_keep_report NAME TITLE REPORT [CALL]: copies the page of a report to docs/results/NAME.md, with the figures, pictures
# and tables that it shows or links. Then removes figures, pictures and tables that no page in docs/results shows or links.
farcull_keep_report() {
  local results=$farcull_root/docs/results file
  mkdir -p "$results"/{figures,pictures,tables}
  {
    printf '# %s\n\nMade again by\n\n    bash experiments/%s\n' "$2" "${4:-${0##*/}}"
    tail -n +2 "$3/results.md"
  } >"$results/$1.md"
  for file in "$3"/figures/*.svg "$3"/pictures/*.png "$3"/tables/*.csv; do
    if grep -qF "(${file#"$3/"})" "$results/$1.md"; then cp "$file" "$results/${file#"$3/"}"; fi
  done
  for file in "$results"/{figures,pictures,tables}/*; do
    grep -qF "(${file#"$results/"})" "$results"/*.md || rm -f "$file"
  done
  echo "$1: made docs/results/$1.md"
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then
  farcull_packages+=("${farcull_test_packages[@]}" "${farcull_rare_packages[@]}")
  farcull_setup
fi
