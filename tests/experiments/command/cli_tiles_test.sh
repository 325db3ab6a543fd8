#!/usr/bin/env bash
# Tiles on the command line: the built-in scenes in tiles give the lists of one run, with every option
# that tiles take; the others are refused; and what is merged is whole or not there.
#   cli_tiles_test.sh FARCULL_BINARY
set -euo pipefail

program=$(realpath -- "$1")
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
cd "$work"
failed=0
wrong() {
  echo "FAILED $*"
  failed=$((failed + 1))
}

# same N SCENE OPTIONS...: N tiles, merged, against one run.
same() {
  local -i n=$1 k
  shift
  rm -f t[0-9]*.json ./*.csv
  "$program" run "$@" --no-verify --pairs one.csv >out.txt
  for ((k = 1; k <= n; ++k)); do
    "$program" run "$@" --no-verify --tiles "$k/$n" --json "t$k.json" --pairs "t$k.csv" >out.txt
  done
  "$program" merge t[0-9]*.json -o merged.csv --json whole.json >out.txt
  cmp -s one.csv merged.csv || wrong "$n tiles of $*: another list than that of one run"
}

# refused REASON ARGUMENTS...: status 2, and a line with the reason.
refused() {
  local reason=$1 status=0
  shift
  "$program" "$@" >out.txt 2>err.txt || status=$?
  if ((status != 2)) || ! grep -qF -- "$reason" err.txt; then wrong "$*: status $status, $(cat err.txt)"; fi
}

# The built-in scenes, the large ones of a smaller size, in 1 to 5 tiles.
n=0
for scene in two-spheres two-tori random-soup needles degenerate ground crowd:60 far-apart field:3000 crumpled:2000 \
  rope:3000 spheres:2000 fans:2000 funnel:5000 cylinders:20 torii:500 tree-leaves:20 shells cloth:1000 slivers stack \
  mixed gap; do
  same $((n++ % 5 + 1)) "$scene"
done
# Those of packaged meshes, where they are.
if "$program" run bunny --no-verify >out.txt 2>&1; then
  for scene in two-bunnies mannequin-devil; do same 2 "$scene"; done
fi

# Options that tiles take.
same 3 two-tori --clearance 0.05
same 4 cloth:1000 --self --contacts --faces
same 2 two-spheres --self --clearance 0.01 --segments
same 3 degenerate --kinds crossing,coplanar
same 3 crowd --ignore '*1:*2,*3:*4'
same 3 two-spheres --views x,y
same 2 field:3000@seed9

# Scenes from files, with meshes that are named several times and divided.
"$program" scenes crowd:40 --write crowd >out.txt
same 3 crowd/scene.json
same 3 crowd/scene.json --self
mesh=$(find crowd -type f ! -name '*.json' | sort | sed -n 1p)
cat >again.json <<END
{"name": "again", "objects": [{"mesh": "$mesh", "self": true}, {"mesh": "$mesh", "translate": [0.1, 0, 0]},
  {"mesh": "$mesh", "split": "components", "scale": 1.5}]}
END
same 2 again.json
# A scene that ignores pairs of its objects, some of which meet no tile of the other.
sed -E '0,/^\{/s//{"ignore": [["*1", "*2"], ["*3", "*4"]],/' crowd/scene.json >crowd/ignores.json
same 3 crowd/ignores.json
same 2 crowd/ignores.json --ignore '*5:*6'
# Tiles that ignore others are not joined, whether the scene or the command line names them.
"$program" run crowd/ignores.json --no-verify --tiles 2/2 --json t2.json --pairs t2.csv >out.txt
refused "was run with other options" merge t1.json t2.json -o merged.csv
"$program" run crowd/scene.json --no-verify --tiles 1/2 --json t1.json --pairs t1.csv >out.txt
refused "was run with other options" merge t1.json t2.json -o merged.csv
# Nor is a name believed, but the object: here one and the same name is of two objects.
sed 's/tetrahedron0"/kept"/; s/tetrahedron1"/tetrahedron0"/; s/kept"/tetrahedron1"/' crowd/scene.json >crowd/renamed.json
"$program" run crowd/scene.json --no-verify --ignore 'tetrahedron0:*2' --tiles 1/2 --json t1.json --pairs t1.csv >out.txt
"$program" run crowd/renamed.json --no-verify --ignore 'tetrahedron0:*2' --tiles 2/2 --json t2.json --pairs t2.csv >out.txt
refused "was run with other options" merge t1.json t2.json -o merged.csv
same 2 "$mesh" "$mesh"

# The plan cuts where the runs cut, and counts what they read.
"$program" plan field:30000 --tiles 3 --json plan.json >out.txt
grep -qE '^ *3/3 ' out.txt || wrong "plan --tiles 3: $(cat out.txt)"
# tile_of INDENT: interval and counts among the lines of JSON.
tile_of() { sed -nE "s/^ {$1}(\"(from|to|triangles|home_triangles)\": [^,]*),?\$/\1/p"; }
for k in 1 2 3; do
  "$program" run field:30000 --no-verify --tiles "$k/3" --json - | sed -n '/^  "tile": {/,/^  }/p' | tile_of 4 >tile.txt
  sed -n "/\"k\": $k,/,/}/p" plan.json | tile_of 6 | cmp -s - tile.txt || wrong "the plan says of tile $k something else"
  (($(wc -l <tile.txt) == 4)) || wrong "the record of tile $k lacks an entry: $(cat tile.txt)"
done
"$program" run field:30000 --tiles 2/3 >out.txt
for word in 'tile       2 of 3' 'pairs of other tiles are not covered' 'memory     ' 'accounted  '; do
  grep -qF "$word" out.txt || wrong "the table lacks '$word'"
done

# What cannot be answered in tiles, and values that are none.
refused "--tiles: are of far-pairs" run two-spheres --tiles 1/2 --method far
refused "--limit: cannot be answered in tiles" run two-spheres --tiles 1/2 --limit 5
refused "--frames: cannot be answered in tiles" run two-spheres --tiles 1/2 --frames 3
refused "--certificate: cannot be answered in tiles" run two-spheres --tiles 1/2 --certificate c.json
refused "'3/2' is no tile" run two-spheres --tiles 3/2
refused "'1/2' is no number of tiles" plan two-spheres --tiles 1/2
refused "no object is called so" run crowd --tiles 1/2 --ignore 'nobody:*'
refused "no object is called so" plan crowd --tiles 2 --ignore 'nobody:*'
refused "no UTF-8" run crowd --tiles 1/2 --json t.json --pairs $'u\xff.csv'
echo 'tetrahedron0:*2' >ignored.txt
refused "--ignore-file" run crowd --tiles 1/2 --ignore-file ignored.txt --pairs ignored.txt
refused "--ignore-file" run crowd --ignore-file ignored.txt --json ignored.txt
"$program" run "$mesh" --tiles 1/1 >out.txt
grep -q 'nothing to test: the scene is one object' out.txt || wrong "a tile of one object: $(cat out.txt)"
[[ ! -e c.json ]] || wrong "a certificate was written"

# A record and a list in two folders, of which one is behind a link.
mkdir -p real/deep
ln -s real/deep link
"$program" run two-tori --tiles 1/1 --json link/t.json --pairs t.csv >out.txt
"$program" merge link/t.json -o merged.csv >out.txt || wrong "a record behind a link"

# A tile that missed a pair, or promises nothing.
"$program" run two-tori --tiles 1/1 --json t1.json --pairs t1.csv >out.txt
"$program" merge t1.json -o merged.csv --json - | grep -q '"promises": true' || wrong "no promise"
sed -i 's/"false_negatives": 0/"false_negatives": 3/; s/"promises": true/"promises": false/' t1.json
status=0
"$program" merge t1.json -o merged.csv >out.txt 2>err.txt || status=$?
((status == 1)) || wrong "a merge with missed pairs: status $status"
grep -q 'culled pairs that collide: 3' err.txt || wrong "missed pairs: $(cat err.txt)"
grep -q 'no promise: ' out.txt || wrong "a tile without a promise: $(cat out.txt)"

# merge: what is missing, and that nothing is written then.
same 3 two-tori
rm merged.csv
refused "of its 3 tiles one is missing: 2" merge t1.json t3.json -o merged.csv
refused "is no record of a tile, as the others are" merge t1.json results.sqlite -o merged.csv
head -c 100 t2.csv >short.csv
mv short.csv t2.csv
refused "it was cut short" merge t1.json t2.json t3.json -o merged.csv
[[ ! -e merged.csv ]] || wrong "a list was written although a tile is cut short"

if ((failed > 0)); then
  echo "$failed cases of tiles failed"
  exit 1
fi
echo "tiles: the lists of one run, and errors where they cannot be"
