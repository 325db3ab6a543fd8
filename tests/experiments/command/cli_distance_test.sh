#!/usr/bin/env bash
# `farcull distance` from the command line: bad input and good cases, as cli_test.sh does it for the
# rest.
#   tests/experiments/command/cli_distance_test.sh FARCULL_BINARY
# Needs bash and Debian's essential tools.
set -uo pipefail

# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

echo older >old.json
obj 'f 1 2 3' 'f 1 2 4' 'f 1 3 4' 'f 2 3 4' >small.obj
printf '%s\n' 'v -5 -5 -5' 'v 29 -5 -5' 'v -5 29 -5' 'v -5 -5 29' 'f 1 3 2' 'f 1 2 4' 'f 2 3 4' 'f 3 1 4' >large.obj
printf '%s\n' 'v -5 -5 -5' 'v 29 -5 -5' 'v -5 29 -5' 'v -5 -5 29' 'f 1 3 2' 'f 1 2 4' 'f 2 3 4' >open.obj
printf 'v 2 0 0\nv 3 0 0\nv 2 1 0\nf 1 2 3\n' >right.obj
for i in 1 2 3; do printf 'v %d 0 0\nv 9 0 0\nv 9 1 0\nf 1 2 3\n' $((i + 1)) >"moves_$i.obj"; done
two=(small.obj right.obj)

# --- bad input ---------------------------------------------------------------------------------

bad 'no scene' 'SCENE: none is named' distance
bad 'one object' 'SCENE: only one object .*farcull distance small\.obj --self' distance small.obj
bad 'one object, nearest' 'SCENE: only one object' distance small.obj --pairs nearest
bad 'no such pairs' "--pairs: 'some' is no choice; give objects, nearest or all" distance "${two[@]}" \
  --pairs some
bad 'all without a distance' '--within: is missing' distance "${two[@]}" --pairs all
for within in -1 -1e-300 nan inf 1e999 '' 1x ' 1' 0x1p3; do
  bad "within '$within'" '--within: ' distance "${two[@]}" --within "$within"
done
for k in 0 -1 1.5 '' x 99999999999999999999; do
  bad "k '$k'" '--k: ' distance "${two[@]}" --pairs nearest --k "$k"
done
bad 'k of objects' '--k: has no meaning without --pairs nearest' distance "${two[@]}" --k 2
bad 'nearest and self' '--self: has no meaning with --pairs nearest' distance "${two[@]}" --pairs nearest \
  --self
for threads in 0 -1 1025 x ''; do
  bad "threads '$threads'" '--threads: ' distance "${two[@]}" --threads "$threads"
done
bad 'inside maybe' '--inside: .*give yes or no' distance "${two[@]}" --inside maybe
bad 'inside of triangles' '--inside: ' distance "${two[@]}" --pairs all --within 1 --inside yes
bad 'no such option' '--clearance: farcull distance has no such option' distance "${two[@]}" --clearance 1
bad 'no such file' 'none\.obj: ' distance small.obj none.obj --json old.json
bad 'an output that is read' '--csv: ' distance "${two[@]}" --csv right.obj
bad 'one file twice' '--csv: .*--json' distance "${two[@]}" --csv a.out --json a.out
bad 'frames of what stands still' '--frames: nothing .*%d' distance "${two[@]}" --frames 3
bad 'no such diagram' "--voronoi: 'some' is no choice; give published or reliable" distance "${two[@]}" \
  --voronoi some
for cells in 0 -1 1.5 '' x 16385 99999999999999999999; do
  bad "cells '$cells'" '--resolution: ' distance "${two[@]}" --voronoi reliable --resolution "$cells"
done
bad 'a device of distances' '--device: has no meaning without --voronoi' distance "${two[@]}" --device cpu
bad 'no such device' "--device: 'toaster' is no device" distance "${two[@]}" --voronoi published --device toaster
bad 'cells of distances' '--resolution: has no meaning without --voronoi' distance "${two[@]}" --resolution 64
for option in '--pairs nearest' '--k 2' '--within 1' --self '--inside no' --verify '--frames 3' '--certificate c.json'; do
  # shellcheck disable=SC2086 # an option and its value
  bad "a diagram and $option" "${option%% *}: has no meaning with --voronoi" distance "${two[@]}" \
    --voronoi published $option
done
bad 'a diagram of one object' 'SCENE: only one object' distance small.obj --voronoi published
((cases += 1))
launch distance random-soup --pairs all --within 100 # for longer than bad() lets it
refused 'more pairs than are answered' 'within: has (more than )?[0-9]+ pairs .*; give a smaller distance'

# 5,794 objects of one triangle.
awk 'BEGIN { for (i = 0; i < 5794; ++i) printf "o o%d\nv %d 0 0\nv %d 1 0\nv %d 0 1\nf %d %d %d\n", i, i, i, i, 3*i+1, 3*i+2, 3*i+3 }' \
  >many.obj
echo '{"name": "many", "objects": [{"mesh": "many.obj", "split": "groups"}]}' >many.json
bad 'more pairs of objects than are answered' 'scene: has 16782321 pairs of objects, and at most 4194304 .*; ask for the nearest' \
  distance many.json
for option in --json --csv --certificate; do
  bad "a full disk for $option" '/dev/full: cannot be written: No space left' distance "${two[@]}" "$option" /dev/full
done
good 'a certificate' 0 distance "${two[@]}" --certificate whole.json
for size in 0 1 100 300; do
  head -c "$size" whole.json >cut.json
  bad "$size bytes of a certificate" 'cut\.json: not JSON at byte' check cut.json "${two[@]}"
done

# --- good cases --------------------------------------------------------------------------------

good 'two objects' 0 distance "${two[@]}" --verify
expect 'two objects' "$out" '^0 small +1 right +1 +0 vertex 1 +0 vertex 0'
expect 'two objects' "$out" '^verified: the answers are right, no nearer pair was culled, 4 pairs accounted for$'
expect 'two objects' "$out" '^nearest points and exact squares: with --csv or --json$'
good 'the least' 0 distance small.obj right.obj large.obj small.obj
expect 'the least' "$out" '^least +0, of 0 small and 3 small.*, which meet$'
expect 'the least' "$out" '^0 small +2 large .* a in b$'
good 'as JSON' 0 distance "${two[@]}" --json -
expect 'as JSON' "$out" '^ +"distance": 1\.0,$'
expect 'as JSON' "$out" '^ +"squared": "1/1",$'
expect 'as JSON' "$out" '^ +"inside": "none"$'
expect 'as JSON' "$out" '^ +"hash": "[0-9a-f]{16}"$'
good 'as CSV' 0 distance "${two[@]}" --csv -
expect 'as CSV' "$out" '^object_a,triangle_a,object_b,triangle_b,distance,squared,x_a,'
expect 'as CSV' "$out" '^0,0,1,0,1,1/1,1,0,0,2,0,0,vertex 1,vertex 0,none$'
good 'inside' 0 distance small.obj large.obj --csv -
expect 'inside' "$out" ',a$'
good 'outside in' 0 distance large.obj small.obj --csv -
expect 'outside in' "$out" ',b$'
good 'not closed' 0 distance small.obj open.obj --csv -
expect 'not closed' "$out" ',not closed$'
good 'inside not asked' 0 distance small.obj large.obj --inside no --csv -
expect 'inside not asked' "$out" ',$'
good 'within less' 0 distance "${two[@]}" --within 0.999 --csv -
((cases += 1))
(($(wc -l <"$out") == 1)) || fail 'within less' 'an answer'
good 'within as much' 0 distance "${two[@]}" --within 1 --csv -
expect 'within as much' "$out" '^0,0,1,0,1,'
good 'that meet' 0 distance small.obj small.obj --csv -
expect 'that meet' "$out" '^0,0,1,0,0,0/1,'
good 'nearest' 0 distance small.obj right.obj large.obj --pairs nearest --k 4000000000 --verify
expect 'nearest' "$out" '^0 small +1  1 right +1 '
good 'all' 0 distance crowd --pairs all --within 0.01 --verify --csv all.csv --json all.json
expect 'all' "$out" '^verified: '
good 'self' 0 distance rope:2000 --self --pairs all --within 0.001 --verify
expect 'self' "$out" '^verified: .* pairs accounted for$'
good 'threads' 0 distance crowd --pairs nearest --k 2 --threads 1 --csv one.csv
good 'threads' 0 distance crowd --pairs nearest --k 2 --threads 3 --csv three.csv
((cases += 1))
cmp -s one.csv three.csv || fail 'threads' 'other answers with 3 than with 1'
good 'frames' 0 distance small.obj moves_%d.obj --frames 1:3 --verify --csv frames.csv --json frames.json
expect 'frames' "$out" '^ +2 +1 +2 '
expect 'frames' frames.csv '^frame,object_a,'
expect 'frames' frames.csv '^3,0,0,1,0,3,9/1,'
expect 'frames' frames.json '^    "missed": 0,$'
# Objects that appear and vanish: hints of the frame before are of other objects, or of none.
for i in 1 2 3 4; do
  {
    for ((k = 1; k <= (i == 2 ? 3 : i == 4 ? 2 : 1); ++k)); do
      printf 'o o%d\nv %d 0 0\nv 9 0 %d\nv 9 1 0\nf -3 -2 -1\n' "$k" $((i + k)) "$k"
    done
  } >"comes_$i.obj"
done
echo '{"name": "comes", "objects": [{"mesh": "small.obj"}, {"mesh": "comes_%d.obj", "split": "groups"}]}' >comes.json
for pairs in objects nearest; do
  good "objects that come and go, $pairs" 0 distance comes.json --pairs "$pairs" --frames 1:4 --verify --csv frames.csv
  for i in 1 2 3 4; do
    good "frame $i of them alone" 0 distance comes.json --pairs "$pairs" --frames "$i:$i" --csv frame.csv
    ((cases += 1))
    [[ $(grep "^$i," frames.csv) == "$(grep "^$i," frame.csv)" ]] || fail "frame $i of them alone" 'other answers'
  done
done
# A distance beyond the largest double.
printf 'v 1.7e308 0 0\nv 1.6e308 0 0\nv 1.7e308 1 0\nf 1 2 3\n' >right_end.obj
printf 'v -1.7e308 0 0\nv -1.6e308 0 0\nv -1.7e308 1 0\nf 1 2 3\n' >left_end.obj
good 'beyond the doubles' 0 distance right_end.obj left_end.obj --verify --json - --certificate ends.json
expect 'beyond the doubles' "$out" '^ +"distance": null,$'
good 'beyond the doubles, proved' 0 check ends.json right_end.obj left_end.obj
good 'frames of a built-in scene' 0 distance two-spheres --frames 2 --inside no
good 'a diagram' 0 distance small.obj right.obj large.obj --voronoi published
expect 'a diagram' "$out" '^0 small +1 right +1 +'
expect 'a diagram' "$out" '^nearest +[3-6] nearest objects of 3 objects; the diagram lost [0-9]+$'
good 'a diagram that loses' 0 distance ground@tiny --voronoi published --csv lost.csv --json lost.json
expect 'a diagram that loses' lost.csv '^object,nearest,nearest_objects,distance,'
expect 'a diagram that loses' lost.json '^    "lost": [1-9]'
good 'a reliable diagram' 0 distance crowd --voronoi reliable --resolution 32 --threads 1 --json -
expect 'a reliable diagram' "$out" '^    "lost": 0,$'
for form in published reliable; do
  good "a $form diagram on GL" 0 distance small.obj right.obj large.obj --voronoi "$form" --resolution 9 \
    --device software --csv gl.csv --json gl.json
  good "a $form diagram on the CPU" 0 distance small.obj right.obj large.obj --voronoi "$form" --resolution 9 \
    --device cpu --csv cpu.csv
  ((cases += 1))
  [[ $(cut -d, -f1-4,7 gl.csv) == "$(cut -d, -f1-4,7 cpu.csv)" ]] || fail "a $form diagram on GL" 'other answers'
  expect "a $form diagram on GL" gl.json '^    "renderer": '
  expect "a $form diagram on GL" gl.json '^    "probes": "[0-9]+ probes of '
done

if ((failed > 0)); then
  echo "cli_distance_test: $failed of $cases cases failed"
  exit 1
fi
echo "cli_distance_test: $cases cases, none failed"
