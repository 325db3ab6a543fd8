#!/usr/bin/env bash
# The installed library as a stranger uses it: docs/example, built by CMake and by pkg-config, and with what the
# Debian package holds.
#   tests/experiments/library/install_test.sh BUILD_FOLDER SOURCE_FOLDER CXX CMAKE
# Installs to a folder of its own, moves that, and leaves nothing.
set -euo pipefail

build=$1 source=$2 cxx=$3 cmake=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "install_test: $1" >&2
  exit 1
}

"$cmake" --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/prefix"
headers=$(cd "$work/prefix/include/farcull" && echo *)
[[ $headers == 'distance.h eigen.h error.h farcull.h' ]] || fail "the headers are $headers"
if grep -nE '#include [<"](CGAL|GL|epoxy|core|verify|offsets|experiments)|spell' -r "$work/prefix/include" ||
  grep -n 'include <Eigen' "$work/prefix/include/farcull/"{distance,error,farcull}.h; then
  fail 'a header includes what users do not have'
fi
if grep -rnF -e "$build" -e "$source" "$work/prefix" --include='*.cmake' --include='*.pc' \
  --include='*.h'; then
  fail 'what is installed names the folder that it was built in'
fi
"$work/prefix/bin/farcull" --version >/dev/null
share=$work/prefix/share
# The report finds its Python program beside it.
[[ -e $share/farcull/report/__main__.py && -e $share/farcull/report/chapters/accuracy.py ]] ||
  fail "the program that writes reports is not installed"
grep -q farcull "$share/bash-completion/completions/farcull" || fail "the completion is not installed, or empty"
grep -q LGPL-3.0-or-later "$share/doc/farcull/LICENSE" || fail 'the licence is not installed'
pages=$(grep -rhoE 'docs/[a-z-]+\.md' "$work/prefix/include" | sort -u)
[[ $pages == *docs/library.md* ]] || fail 'the headers do not name the page of the library'
for page in $pages; do
  cmp "$source/$page" "$share/doc/farcull/${page#docs/}" || fail "a header names $page, which is not installed"
done

# by_cmake PREFIX: prints what the example says that find_package() builds with the library below the prefix.
by_cmake() {
  rm -rf "$work/by_cmake"
  "$cmake" -S "$source/docs/example" -B "$work/by_cmake" -DCMAKE_PREFIX_PATH="$1" -DCMAKE_CXX_COMPILER="$cxx" \
    >"$work/log" || fail "$(cat "$work/log")"
  grep -q "farcull_DIR:PATH=$1/" "$work/by_cmake/CMakeCache.txt" || fail "another farcull than in $1 was found"
  "$cmake" --build "$work/by_cmake" >"$work/log" || fail "$(cat "$work/log")"
  "$work/by_cmake/main"
  "$work/by_cmake/contacts"
}
by_cmake "$work/prefix" >"$work/cmake.txt"

PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name farcull.pc)")
export PKG_CONFIG_PATH
for example in main contacts; do
  # shellcheck disable=SC2046 # several words
  "$cxx" -std=c++20 -Wall -Wextra -Werror "$source/docs/example/$example.cpp" \
    $(pkg-config --cflags --libs farcull) -o "$work/example"
  "$work/example"
done >"$work/pkg_config.txt"

# The loop of docs/library.md is that of the example.
sed 's/^ *//' "$source/docs/example/contacts.cpp" >"$work/lines"
loop=$(sed -n '/^    farcull::DistanceFinder finder({.kind = /,/^$/s/^ *//p' "$source/docs/library.md")
[[ $(wc -l <<<"$loop") -gt 9 ]] || fail "docs/library.md has no loop of poses"
while read -r line; do
  grep -qxF -e "$line" "$work/lines" || fail "docs/library.md has a line that the example has not: $line"
done <<<"$loop"

# An older standard: one line says what to do.
for header in farcull distance; do
  ! echo "#include <farcull/$header.h>" | "$cxx" -std=c++17 -fsyntax-only -I "$work/prefix/include" -x c++ - 2>"$work/log" ||
    fail "<farcull/$header.h> compiles as C++17"
  [[ $(grep -c 'error: #error "farcull needs C++20: ' "$work/log") == 1 && $(grep -c 'error:' "$work/log") == 2 ]] ||
    fail "as C++17 <farcull/$header.h> says: $(cat "$work/log")"
done

cmp "$work/cmake.txt" "$work/pkg_config.txt" || fail 'the two examples differ'
expected="farcull $(pkg-config --modversion farcull)"$'
pairs: 1
frame 1: 1\n  0 and 1
frame 2: 0
frame 3: 0
distance: 1.19
step 0
step 1
  objects 0 and 1: 0.5 along (0, 0, 1)
    weights of triangle 0: 0.5, 0.25, 0.25
step 2
  objects 0 and 1: 0.25 along (0, 0, 1)
    weights of triangle 0: 0.5, 0.25, 0.25
step 3
  objects 0 and 1: 0 along (0, 0, 0)
    weights of triangle 0: 0.5, 0.25, 0.25'
[[ $(<"$work/cmake.txt") == "$expected" ]] || fail "the example says: $(<"$work/cmake.txt")"

# The package. CPack would build everything first; with this generator it takes what is built.
if command -v dpkg-shlibdeps >/dev/null; then
  (cd "$build" && "$(dirname "$cmake")/cpack" -G DEB -B "$work/deb" -D CPACK_CMAKE_GENERATOR=Ninja) >"$work/log" 2>&1 ||
    fail "$(cat "$work/log")"
  deb=("$work"/deb/*.deb)
  dpkg-deb -x "${deb[0]}" "$work/tree"
  by_cmake "$work/tree/usr" | cmp - "$work/cmake.txt" || fail 'the example of the package differs'
  "$work/tree/usr/bin/farcull" --version >/dev/null
  depends=$(dpkg-deb -f "${deb[0]}" Depends)
  for package in libgmp-dev libmpfr-dev libhwy-dev pkg-config 'libc6 '; do
    [[ $depends == *"$package"* ]] || fail "the package does not depend on $package: $depends"
  done
  # apt installs what is recommended too: the Python of reports would bring 250 packages and 1.6 GB.
  recommends=$(dpkg-deb -f "${deb[0]}" Recommends)
  [[ $recommends != *python3* ]] || fail "the package recommends $recommends"
  [[ -s $work/tree/usr/share/doc/farcull/copyright ]] || fail 'the package has no copyright file'
fi
echo "install_test: the example was built by CMake and by pkg-config"
