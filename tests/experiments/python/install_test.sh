#!/usr/bin/env bash
# The Python module as users install it: as a wheel, by pip, into a fresh virtual environment, and by
# `cmake --install`. Each then answers from any folder, and is the one that was installed.
#   tests/experiments/python/install_test.sh PYTHON BUILD_FOLDER SOURCE_FOLDER CMAKE
# Status 77: PYTHON cannot make virtual environments, or has no numpy.
set -euo pipefail

python=$1 build=$2 source=$3 cmake=$4
if ! "$python" -c 'import numpy, venv, ensurepip, setuptools' 2>/dev/null; then
  echo "$python has no numpy, setuptools or venv (Debian: python3-numpy python3-venv python3-pip)"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset PYTHONPATH

# answers PYTHON FOLDER: the module of that Python lies below the folder, and answers.
answers() {
  (cd "$work" && "$1" -B -c '
import sys
import farcull
assert farcull.__file__.startswith(sys.argv[1]), farcull.__file__
V = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [2, 1, 1]]
assert farcull.collide(V, [[0, 1, 2], [3, 4, 5]], [0, 1]).pairs.tolist() == [[0, 1]]
assert len(farcull.Scene("two-tori").run().pairs) == 282
' "$2")
}

if (answers "$python" "$work") 2>/dev/null; then
  echo "install_test: the module answers before it is installed" >&2
  exit 1
fi

"$cmake" --install "$build" --prefix "$work/prefix" >/dev/null
folder=$(dirname "$(dirname "$(find "$work/prefix" -name '_farcull.*.so')")")
PYTHONPATH=$folder answers "$python" "$work/prefix"
[[ $folder == */site-packages ]] || { echo "install_test: a prefix of its own got $folder" >&2; exit 1; }
# Below /usr and /usr/local the package lies where Debian's Python looks: sys.path has the folder.
for prefix in /usr /usr/local; do
  [[ -e /etc/debian_version && $python == /usr/bin/* ]] || continue
  DESTDIR=$work/root "$cmake" --install "$build/experiments/python" --prefix $prefix >/dev/null
  folder=$(dirname "$(dirname "$(find "$work/root$prefix/lib" -name '_farcull.*.so')")")
  (cd / && "$python" -c 'import sys; assert sys.argv[1] in sys.path, sys.argv' "${folder#"$work/root"}")
  rm -rf "$work/root"
done

# pip writes into the folder that it builds from.
mkdir -p "$work/source/experiments"
cp -r "$source/experiments/python" "$work/source/experiments/"
ln -s "$source/core" "$work/source/core"
"$python" -m venv --system-site-packages "$work/venv"
# The build folder holds the module. Where a file or the commit changed since it was built, the test would
# compile for minutes; so CMake only says what it would do, which fails where the target is none.
mkdir "$work/bin"
printf '#!/bin/sh\ntouch "%s"\nexec "%s" "$@" -- -n\n' "$work/asked" "$cmake" >"$work/bin/cmake"
chmod +x "$work/bin/cmake"
PATH=$work/bin:$PATH FARCULL_BUILD=$build "$work/venv/bin/pip" wheel --quiet --no-deps --no-index --no-build-isolation \
  --disable-pip-version-check --wheel-dir "$work/wheels" "$work/source/experiments/python"
[[ -e $work/asked ]] || { echo "install_test: pip did not ask for a build" >&2; exit 1; }
(cd "$work/wheels" && "$work/venv/bin/pip" install --quiet --no-index --disable-pip-version-check farcull-*.whl)
answers "$work/venv/bin/python" "$work/venv"
"$work/venv/bin/pip" uninstall --quiet --yes --disable-pip-version-check farcull
if (answers "$work/venv/bin/python" "$work/venv") 2>/dev/null; then
  echo "install_test: the module answers after it was removed" >&2
  exit 1
fi
echo "install_test: installed by CMake and as a wheel"
