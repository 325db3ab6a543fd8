#!/usr/bin/env bash
# Fails if two different types have one name (the one definition rule, ODR): the program would use
# either of them by chance. It builds the program with link time optimization (-Wodr), where the compiler
# sees all types at once. tests/layout_test.sh finds types of one name in the sources; this script also
# finds types that differ by macros, options or includes. CI leaves it out, since it builds the program a
# second time.
#   bash tests/odr.sh               in build-odr/: a quarter of an hour on two cores
#   bash tests/odr.sh --self-test   two small files with such a type; a second
# Exit status: 0; 1 two types of one name differ; 2 it could not build.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=../experiments/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../experiments/setup.sh"
cd "$farcull_root"
# Files that the assembler embeds are seen from their own part alone, so there is one part.
readonly flags='-O0 -g0 -flto=auto -flto-partition=one -Wodr -Wlto-type-mismatch'

# The lines of a log in which the compiler names two types or functions that differ.
differ() { grep -E '\[-W(odr|lto-type-mismatch)\]' "$1" | sort -u; }

if [[ ${1-} == --self-test ]]; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  cd "$work"
  for type in double float; do
    printf 'namespace n { struct Kind { int i; }; int f(Kind a) { return a.i; } }\n' >one.cpp
    printf 'namespace n { struct Kind { %s x; }; int g(Kind a) { return a.x > 0; } }\n' "$type" >two.cpp
    if [[ $type == double ]]; then sed -i 's/double x/int i/; s/a\.x/a.i/' two.cpp; fi
    printf 'int main() { return 0; }\n' >main.cpp
    # shellcheck disable=SC2086 # several words
    "${CXX:-c++}" $flags one.cpp two.cpp main.cpp -o program >log 2>&1 || exit 2
    if [[ $type == double ]] && differ log; then echo "odr: equal types are reported" && exit 1; fi
    if [[ $type == float ]] && ! differ log >/dev/null; then echo "odr: different types are not reported" && exit 1; fi
  done
  echo "odr: types that differ are reported, and no others"
  exit 0
fi

farcull_packages+=("${farcull_test_packages[@]}")
farcull_setup
farcull_build_beside build-odr farcull -DCMAKE_BUILD_TYPE=Debug -DFARCULL_TESTS=OFF -DCMAKE_CXX_FLAGS_DEBUG="$flags" \
  -DCMAKE_AR="$(command -v gcc-ar)" -DCMAKE_RANLIB="$(command -v gcc-ranlib)"
if differ build-odr/build.log; then exit 1; fi
echo "odr: no two types of one name differ in the program"
