#!/usr/bin/env bash
# The page of `farcull picture --html` in headless Chromium without a network: what it shows, and faults that
# have to be caught.
#   tests/experiments/picture/page_test.sh FARCULL_BINARY
set -uo pipefail

# shellcheck source-path=SCRIPTDIR source=../script_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../script_lab.sh" picture.page chromium python3
if ! /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then
  echo "picture.page: NOT RUN: python3-matplotlib is missing (experiments/setup.sh installs it)"
  exit 77
fi
farcull=$(realpath -- "$1")
here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
cd "$work" || exit 2

# Two tori whose tubes cross, of few triangles: software draws each picture in the time that they take.
python3 - <<'END' || exit 1
import math


def torus(name, rings, sides, place):
    with open(name, "w", encoding="utf-8") as out:
        print(f"OFF\n{rings * sides} {2 * rings * sides} 0", file=out)
        for r in range(rings):
            for s in range(sides):
                a, t = 2 * math.pi * (r + 0.3) / rings, 2 * math.pi * (s + 0.2) / sides
                width = 1 + 0.35 * math.cos(t)
                print(*place(width * math.cos(a), width * math.sin(a), 0.35 * math.sin(t)), file=out)
        for r in range(rings):
            for s in range(sides):
                a, b = r * sides + s, (r + 1) % rings * sides + s
                c, d = r * sides + (s + 1) % sides, (r + 1) % rings * sides + (s + 1) % sides
                print(f"3 {a} {b} {d}\n3 {a} {d} {c}", file=out)


torus("first.off", 36, 18, lambda x, y, z: (x, y, z))
torus("second.off", 36, 18, lambda x, y, z: (x + 0.45, -z, y))
END
tori=(first.off second.off)
"$farcull" picture "${tori[@]}" --compare cullide,far,exact --resolutions 32,256,512 --size 400x340 \
  --html tori.html >said 2>errors
status=$?
if grep -q 'three.js' errors; then
  echo "picture.page: NOT RUN: the program was built without three.js (experiments/setup.sh installs it)"
  exit 77
fi
((status == 0)) || { cat errors >&2; exit 1; }
"$farcull" picture "${tori[@]}" --method cullide --resolution 256 --size 400x340 -o flat.png >/dev/null || exit 1
"$farcull" run "${tori[@]}" --method exact --no-verify --pairs pairs.csv --contacts >/dev/null || exit 1
# Triangles that meet the one of a.off: equal, crossing, touch-vertex, touch-edge, coplanar, touch-face.
printf '%s\n' OFF '3 1 0' '0 0 0' '8 0 0' '0 8 0' '3 0 1 2' >a.off
printf '%s\n' OFF '18 6 0' '0 0 0' '8 0 0' '0 8 0' '1 1 -1' '1 1 1' '1 3 0.5' '4 2 0' '4 2 3' '5 2 3' \
  '2 0 -1' '2 0 1' '2 -3 0' '1 1 0' '2 1 0' '1 2 0' '1 1 0' '3 1 0' '2 1 5' \
  '3 0 1 2' '3 3 4 5' '3 6 7 8' '3 9 10 11' '3 12 13 14' '3 15 16 17' >b.off
"$farcull" picture a.off b.off --compare exact --size 200x160 --html kinds.html >/dev/null || exit 1
"$farcull" run a.off b.off --no-verify --pairs kinds.csv --contacts >/dev/null || exit 1
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$here/page_test.py" tori.html said pairs.csv \
  kinds.html kinds.csv flat.png || exit 1

# The page of `farcull clash`.
box() {
  python3 -c "
import sys
lo, hi = [float(x) for x in sys.argv[1].split()], [float(x) for x in sys.argv[2].split()]
print('\n'.join('v {} {} {}'.format(*[(hi if k >> i & 1 else lo)[i] for i in range(3)]) for k in range(8)))
print('f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6')" "$1" "$2"
}
box '0 0 0' '4 4 4' >first.obj
box '3 1 1' '6 2 2' >second.obj
box '1 1 1' '2 2 2' >third.obj
"$farcull" clash first.obj second.obj third.obj --html clash.html --fail-on none >/dev/null || exit 1
box '5 0 0' '6 1 1' >fourth.obj
"$farcull" clash third.obj fourth.obj --clearance 5 --html near.html >/dev/null || exit 1
PYTHONDONTWRITEBYTECODE=1 python3 "$here/clash_page_test.py" clash.html near.html || exit 1
