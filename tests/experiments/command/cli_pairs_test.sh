#!/usr/bin/env bash
# FAR pairs, self-collision, clearance and frames from the command line: bad input and good cases,
# as cli_test.sh does it for the rest.
#   tests/experiments/command/cli_pairs_test.sh FARCULL_BINARY
# Needs bash, Debian's essential tools and a software device of Mesa.
set -uo pipefail

# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

echo older >old.json
obj 'f 1 2 3' 'f 1 2 4' 'f 1 3 4' 'f 2 3 4' >good.obj

# --- bad input ---------------------------------------------------------------------------------

pairs=(two-spheres --method far-pairs)
bad 'far-pairs beyond its resolution' '--resolution: .*limit of far-pairs' run "${pairs[@]}" \
  --resolution 16385
bad 'far-pairs compared beyond it' '--resolutions: .*limit of far-pairs' compare two-spheres \
  --methods far-pairs --resolutions 16385
bad 'far at auto' '--resolution: auto .*far-pairs' run two-spheres --method far \
  --resolution auto
bad 'compare far at auto' '--resolutions: auto ' compare two-spheres --methods far \
  --resolutions auto
bad 'far with views auto' '--views: auto .*far-pairs' run two-spheres --method far --views auto
bad 'compare far with views auto' '--views: auto ' compare two-spheres --methods far --views auto
for method in far cullide; do
  bad "$method with a clearance" '--clearance: .*far-pairs' run two-spheres --method "$method" \
    --clearance 0
done
bad 'cullide with self' '--self: .*far-pairs' run two-spheres --method cullide --self
bad 'compare cullide with self' '--methods: .*far-pairs' compare two-spheres \
  --methods cullide,exact --self
for option in --radius --offset --depth --depth-format --query; do
  bad "far-pairs with $option" "$option: " run "${pairs[@]}" "$option" 24
done
for clearance in -1 -1e-300 nan inf 1e999 '' 1x ' 1' 0x1p3; do
  bad "clearance '$clearance'" '--clearance: ' run "${pairs[@]}" --clearance "$clearance"
  bad "compare clearance '$clearance'" '--clearance: ' compare two-spheres \
    --clearance "$clearance"
done
for frames in 0 -1 1.5 '' a 3:2 -1:2 1: :2 1:2:3 1000001 0:1000000 99999999999999999999 ' 1' 1-3 \
  9223372036854775807:9223372036854775807 1000000001:1000000001; do
  bad "frames '$frames'" '--frames: ' run "${pairs[@]}" --frames "$frames"
done
for option in --clearance --frames; do
  bad "$option without a value" "$option: " run "${pairs[@]}" "$option"
  bad "$option twice" "$option: " verify "${pairs[@]}" "$option" 1 "$option" 1
done
bad 'a value for --self' '--self: ' run "${pairs[@]}" --self=7
bad 'frames of what stands still' '--frames: nothing .*%d' run two-tori --method far-pairs --frames 3
bad 'frames of files without a number' '--frames: nothing .*%d' run good.obj --method far-pairs \
  --frames 3
for file in c.json - c_%4d.json; do
  bad "certificate of frames in $file" '--certificate: .*%04d' run "${pairs[@]}" --frames 3 \
    --certificate "$file"
done
bad 'certificate with a number and no frames' '--certificate: .*--frames' run "${pairs[@]}" \
  --certificate c_%04d.json
bad 'certificates in no folder' 'nowhere/c_0\.json: ' run "${pairs[@]}" --frames 3 \
  --certificate nowhere/c_%d.json
printf '{"objects": [{"mesh": "cloth_%%d.obj"}]}' >c_2.json
bad 'a certificate over the scene' '--certificate: c_2\.json is c_2\.json, which SCENE reads' run \
  c_2.json --method far-pairs --frames 3 --certificate c_%d.json
rm c_2.json
bad 'a certificate over the list' '--certificate: c_1\.json is c_1\.json, where --pairs goes' run \
  "${pairs[@]}" --frames 3 --certificate c_%d.json --pairs c_1.json
for i in 3 4 5; do obj 'f 1 2 3' 'f 1 2 4' >"cloth_0$i.obj"; done
((cases += 1))
launch run cloth_%02d.obj --method far-pairs --frames 3:6 --json missing.json --pairs missing.csv
((status == 2)) || fail 'a frame that is missing' "status $status"
expect 'a frame that is missing' "$err" '^farcull: .*cloth_06\.obj: the file does not exist; give '
expect 'a frame that is missing' "$out" '^ +5 '
expect 'a frame that is missing' missing.json '^ +"frame": 5,'
expect 'a frame that is missing' missing.json '^    "frames": 3,'
expect 'a frame that is missing' missing.json '^}$'
expect 'a frame that is missing' missing.csv '^frame,'
rm -f missing.json missing.csv
bad 'frames from another number' 'cloth_00\.obj: the file does not exist' run cloth_%02d.obj \
  --method far-pairs --frames 3
bad 'numbered files without frames' 'cloth_%02d\.obj: .*; add --frames FIRST:LAST ' run cloth_%02d.obj
printf '{"objects": [{"mesh": "cloth_%%02d.obj"}]}' >cloth.json
bad 'numbered files of a scene file' '.*cloth_%02d\.obj: .*; add --frames' run cloth.json
bad 'numbered files to compare' 'cloth_%02d\.obj: .*, or name one file' compare cloth_%02d.obj
obj 'f 1 2 3' >'really_%d.obj'
good 'a file with such a name' 0 run 'really_%d.obj'
bad 'faces without pairs' '--faces: .*--pairs' run "${pairs[@]}" --faces
obj 'f 1 2 3' >cloth_05.obj
good 'a frame with fewer triangles' 0 run cloth_%02d.obj --method far-pairs --frames 3:5
expect 'a frame with fewer triangles' "$out" '^topology  changed 1 time between frames$'
printf 'v 0 0 nan\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n' >cloth_05.obj
bad 'a first frame that is no mesh' 'cloth_05\.obj:1: ' run cloth_%02d.obj --method far-pairs \
  --frames 5:5 --json old.json --pairs new.csv
printf '{"objects": [{"mesh": "good.obj", "self": true}, {"mesh": "good.obj"}]}' >self.json
bad 'cullide on a scene that collides with itself' 'self: cullide tests no object .*far-pairs' \
  run self.json --method cullide
bad 'compare cullide on one' '--methods: cullide tests no object .*far-pairs' compare self.json \
  --methods cullide,exact

# --- good cases --------------------------------------------------------------------------------

good 'far-pairs' 0 run "${pairs[@]}"
expect 'far-pairs' "$out" '^device     cpu: boxes of runs decide: no view$'
expect 'far-pairs' "$out" '^method     far-pairs; promises to miss nothing$'
expect 'far-pairs' "$out" ' \+ 0 missed$'
expect 'far-pairs' "$out" '^colliding  298 pairs$'
good 'far-pairs with a clearance of 0' 0 run "${pairs[@]}" --device cpu --clearance 0 --pairs -
cp "$out" plain.csv
good 'far-pairs without' 0 run "${pairs[@]}" --device cpu --pairs -
((cases += 1))
cmp -s "$out" plain.csv || fail 'a clearance of 0' 'other pairs than without'
good 'exact pairs' 0 run two-spheres --method exact --pairs -
((cases += 1))
cmp -s "$out" plain.csv || fail 'far-pairs' 'other pairs than exact'
good 'far-pairs as asked' 0 verify "${pairs[@]}" --device cpu --views x,1:2:3 --resolution 64
expect 'far-pairs as asked' "$out" '^method     far-pairs at 64 px; '
expect 'far-pairs as asked' "$out" '^views      x [0-9]+ x [0-9]+, 1:2:3 '
good 'far-pairs auto' 0 run "${pairs[@]}" --views auto --resolution auto --json -
for line in '"method": "far-pairs"' '"resolution": "auto"' '"clearance": 0\.0' '"promises": true' \
  '"cpu": "boxes of runs decide: no view"' '"neighbour_pairs": 0' '"self_objects": 0'; do
  expect 'far-pairs auto' "$out" "^ *$line"
done
good 'far-pairs by views' 0 run "${pairs[@]}" --views auto --resolution 64 --json -
for line in '"cpu": "no --device' '"looked": true'; do expect 'far-pairs by views' "$out" "^ *$line"; done
obj 'v 1 1 -1' 'v 1 1 1' 'v 0 0 -1' 'f 1 2 3' 'f 1 2 4' 'f 5 6 7' >folded.obj
good 'self-collision' 0 verify folded.obj --method far-pairs --self --pairs -
expect 'self-collision' "$out" '^object_a,triangle_a,object_b,triangle_b,neighbours$'
expect 'self-collision' "$out" '^0,0,0,2,0$'
good 'self-collision by exact' 0 verify folded.obj --method exact --self
expect 'self-collision by exact' "$out" '^colliding  1 pair = 1 \+ 0 of neighbours; 1 candidate is of neighbours$'
# Faces of the file: a square and a concave hexagon, six triangles of two faces, and a blade.
printf 'v %s\n' '0 0 0' '1 0 0' '1 1 0' '0 1 0' '2 0 0' '4 0 0' '4 1 0' '3 0.2 0' '2.5 1 0' '2 1 0' \
  >faces.obj
printf 'f 1 2 3 4\nf 5 6 7 8 9 10\n' >>faces.obj
printf 'v %s\n' '0.1 0.6 -1' '0.1 0.6 1' '0.1 0.7 0' '2.1 0.6 -1' '2.1 0.6 1' '2.1 0.7 0' >blade.obj
printf 'f 1 2 3\nf 4 5 6\n' >>blade.obj
good 'faces' 0 run faces.obj blade.obj --pairs faces.csv --faces
expect 'faces' <(head -n 1 faces.csv) '^object_a,triangle_a,object_b,triangle_b,face_a,face_b$'
expect 'faces' faces.csv '^0,1,1,0,0,0$'
expect 'faces' faces.csv '^0,[2-5],1,1,1,1$'
good 'without faces' 0 run faces.obj blade.obj --pairs unnamed.csv
((cases += 1))
cmp -s unnamed.csv <(cut -d, -f1-4 faces.csv) || fail 'faces' 'the other columns differ'
good 'faces of self-collision' 0 run faces.obj blade.obj --self --pairs - --faces
expect 'faces of self-collision' "$out" \
  '^object_a,triangle_a,object_b,triangle_b,neighbours,face_a,face_b$'
expect 'faces of self-collision' "$out" '^0,1,1,0,0,0,0$'
good 'faces of frames' 0 run two-spheres --frames 1 --pairs - --faces
expect 'faces of frames' "$out" '^frame,object_a,triangle_a,object_b,triangle_b,face_a,face_b$'
expect 'faces of frames' "$out" '^0,0,([0-9]+),1,([0-9]+),\1,\2$'
rm faces.csv
good 'certificate of self-collision' 0 run folded.obj --method far-pairs --self --certificate c.json
good 'check of it' 0 check c.json folded.obj --self
expect 'check of it' "$out" '^proved: '
((cases += 1))
launch check c.json folded.obj
((status == 1)) || fail 'check of it without --self' "status $status instead of 1"
expect 'check of it without --self' "$out" '^not proved: the certificate is of another scene'
rm c.json
good 'no self-collision' 0 verify folded.obj --method far-pairs
expect 'no self-collision' "$out" '^colliding  0 pairs$'
good 'scene that collides with itself' 0 verify self.json --method far-pairs
good 'compare with self' 0 compare folded.obj --self --clearance 0.5
expect 'compare with self' "$out" '^far-pairs +- +auto'
expect 'compare with self' "$out" '^method .* colliding  \+ neighbours '

# Frames: a triangle that falls through another.
for i in 1 2 3; do
  printf 'v 0.1 0.1 %d.5\nv 0.9 0.1 %d.5\nv 0.1 0.1 %d.1\nf 1 2 3\n' $((i - 2)) $((i - 2)) \
    $((i - 2)) >"fall_$i.obj"
done
good 'frames' 0 verify fall_%d.obj good.obj --method far-pairs --frames 1:3 --json - --pairs falls.csv
for line in '"frame": 3' '"read": ' '"median": ' '"p95": ' '"max": ' '"frames": 3' '"missed": 0'; do
  expect 'frames' "$out" "^ *$line"
done
expect 'frames' falls.csv '^frame,object_a,triangle_a,object_b,triangle_b$'
expect 'frames' falls.csv '^2,0,0,1,3$'
rm falls.csv
printf '{"objects": [{"mesh": "fall_%%d.obj", "self": true}, {"mesh": "good.obj"}]}' >fall.json
good 'frames of a scene file' 0 run fall.json --method exact --frames 1:3 --no-verify
expect 'frames of a scene file' "$out" '^frame +candidates +colliding +\+ neighbours +cull ms'
expect 'frames of a scene file' "$out" '^per frame  median '
good 'frames of a built-in scene' 0 verify two-spheres@far@ground --method far-pairs --frames 3
expect 'frames of a built-in scene' "$out" '^ +2 .* 0 +[0-9.]+ +[0-9.]+ +[0-9.]+ +[0-9,]+ +[0-9,]+$'
good 'frames of one number' 0 run crowd --method far-pairs --frames 1

# --- certificates of frames and of clearances, and lists without a certificate ---------------------

says() { # CASE STATUS PATTERN ARGUMENTS...: this status, a line that matches, nothing on stderr
  ((cases += 1))
  launch "${@:4}"
  if ((status != $2)); then
    fail "$1" "status $status instead of $2: $(head -n 1 "$out")"
  elif [[ -s $err ]]; then
    fail "$1" 'something on stderr'
  fi
  expect "$1" "$out" "$3"
}
mkdir certificates
good 'certificates of frames' 0 run fall.json --method exact --frames 1:3 --no-verify \
  --certificate certificates/c_%02d.json --pairs falls.csv
((cases += 1))
[[ $(cd certificates && echo *) == 'c_01.json c_02.json c_03.json' ]] ||
  fail 'certificates of frames' "left $(ls certificates)"
says 'check of frames' 0 '^proved: in each of 3 frames these pairs of the scene meet, and no others: 1 in all$' \
  check certificates/c_%02d.json fall.json --frames 1:3 --pairs falls.csv
expect 'check of frames' "$out" '^ +2  proved +[0-9]+ +1 +[0-9.]+$'
says 'a list of frames alone' 0 '^proved: in each of 3 frames ' check fall.json --frames 1:3 \
  --pairs falls.csv
expect 'a list of frames alone' "$out" '^ +3  proved '
sed '2d' falls.csv >fewer.csv
says 'a list that lacks a pair of a frame' 1 '^refuted: 1 of 3 frames, the first is frame 2$' check \
  fall.json --frames 1:3 --pairs fewer.csv
expect 'a list that lacks a pair of a frame' "$out" \
  '^ +refuted: fewer\.csv is not the list of the pairs: a pair is missing$'
expect 'a list that lacks a pair of a frame' "$out" '^  pair: fall_%d triangle 0 and good triangle 3$'
cp certificates/c_01.json certificates/c_02.json
says 'the certificate of another frame' 1 '^not proved: 1 of 3 frames, the first is frame 2$' check \
  certificates/c_%02d.json fall.json --frames 1:3
expect 'the certificate of another frame' "$out" 'not proved: the certificate is of another scene: hash'
bad 'certificates of frames without frames' 'CERTIFICATE: .*--frames' check certificates/c_%02d.json \
  fall.json
bad 'frames of one certificate' 'CERTIFICATE: .*%04d' check certificates/c_01.json fall.json \
  --frames 1:3
bad 'a list of frames without frames' 'falls\.csv: has a column .*--frames' check fall.json \
  --pairs falls.csv
bad 'a list of other frames' 'falls\.csv:2: frame 2 ' check fall.json --frames 1:1 --pairs falls.csv
rm certificates/c_03.json
((cases += 1))
launch check certificates/c_%02d.json fall.json --frames 1:3
((status == 2)) || fail 'a certificate that is missing' "status $status"
expect 'a certificate that is missing' "$err" '^farcull: certificates/c_03\.json: the file does not .*; give '
expect 'a certificate that is missing' "$out" '^ +1  proved '
rm -r certificates falls.csv fewer.csv

# Certificates of two questions are not one answer. The first one's is the question.
spheres_move=(two-spheres --method far-pairs --frames 2)
good 'certificates of a clearance' 0 run "${spheres_move[@]}" --clearance 0.2 --certificate near_%d.json
good 'certificates of meeting' 0 run "${spheres_move[@]}" --certificate meet_%d.json
cp near_0.json mixed_0.json
cp meet_1.json mixed_1.json
says 'certificates of two questions' 1 '^not proved: 1 of 2 frames, the first is frame 1$' \
  check mixed_%d.json two-spheres --frames 2
expect 'certificates of two questions' "$out" 'not proved: the certificate is of another clearance: 0, not 0\.2$'
says 'certificates of one question' 0 '^proved: in each of 2 frames these pairs are at distance 0\.2 or less' \
  check near_%d.json two-spheres --frames 2
# A built-in motion goes to its last frame, so that its end can be run by itself.
rm meet_1.json
((cases += 1))
launch check meet_%d.json two-spheres --frames 2
((status == 2)) || fail 'a frame of a motion that is missing' "status $status"
expect 'a frame of a motion that is missing' "$err" '; make it with farcull run --certificate --frames 1:1$'
good 'the last frame alone' 0 run two-spheres --method far-pairs --frames 1:1 --certificate meet_%d.json
says 'certificates of two runs' 0 '^proved: in each of 2 frames ' check meet_%d.json two-spheres --frames 2
rm ./near_?.json ./meet_?.json ./mixed_?.json

# At 0.1, as at every decimal fraction, the clearance is the double nearest to it.
near=(two-spheres --method far-pairs --clearance 0.1)
good 'a clearance' 0 run "${near[@]}" --certificate near.json --pairs near.csv
expect 'a certificate of a clearance' near.json '^  "version": 4,$'
expect 'a certificate of a clearance' near.json '^  "clearance": 0\.1,$'
says 'check of a clearance' 0 '^proved: these [0-9,]+ pairs of the scene are at distance 0\.1 or less, and no others$' \
  check near.json two-spheres --pairs near.csv
says 'with the clearance' 0 '^proved: ' check near.json two-spheres --clearance 0.1
says 'with another clearance' 1 '^not proved: the certificate is of another clearance: 0\.1, not 0\.2$' \
  check near.json two-spheres --clearance 0.2
says 'the list of a clearance alone' 0 '^proved: these [0-9,]+ pairs of the scene are at distance ' \
  check two-spheres --pairs near.csv --clearance 0.1
says 'without the clearance' 1 '^refuted: near\.csv is not the list of the pairs: line [0-9]+: the pair is disjoint$' \
  check two-spheres --pairs near.csv
sed 's/"clearance": 0\.1/"clearance": 0.2/' near.json >farther.json
((cases += 1))
launch check farther.json two-spheres
((status == 1)) || fail 'a larger clearance in the file' "status $status"

# Lists that others wrote.
says 'a list alone' 0 '^proved: these 298 pairs of the scene meet, and no others$' check two-spheres \
  --pairs plain.csv
{
  echo 'triangle_b,name,object_b,triangle_a,object_a'
  tail -n +2 plain.csv | tac | awk -F, '{ print $2 ",\"x, y\"," $1 "," $4 "," $3 "\r" }'
} >other.csv
says 'a list in another form' 0 '^ +other\.csv is this list: 298 rows$' check two-spheres --pairs other.csv
expect 'a list in another form' "$out" 'not looked at: columns name$'
sed '100d' plain.csv >fewer.csv
says 'a list that lacks a pair' 1 '^refuted: fewer\.csv is not the list of the pairs: a pair is missing$' \
  check two-spheres --pairs fewer.csv
row=$(sed -n 100p plain.csv)
says 'and the pair' 1 "^  pair: .* triangle $(cut -d, -f2 <<<"$row") and .* triangle $(cut -d, -f4 <<<"$row")\$" \
  check two-spheres --pairs fewer.csv
good 'self-collision' 0 run folded.obj --method far-pairs --self --pairs folded.csv
says 'a list of self-collision' 0 '^proved: this pair of the scene meets, and no other$' check folded.obj \
  --pairs folded.csv --self
says 'and without --self' 1 '^refuted: .*line 2: .*\(--self asks\)$' check folded.obj --pairs folded.csv
good 'two meshes' 0 run good.obj folded.obj --method exact --pairs two.csv
says 'a list of two meshes' 0 '^proved: these [0-9]+ pairs ' check good.obj folded.obj --pairs two.csv
sed '3s/,[0-9]*$/,x/' plain.csv >broken.csv
bad 'a list that is no list' "broken\.csv:3: triangle_b is 'x', .*; give a list as " check two-spheres \
  --pairs broken.csv
bad 'a list of another scene' 'plain\.csv:[0-9]+: object 0 has no triangle .*; give ' check good.obj good.obj \
  --pairs plain.csv
bad 'neither certificate nor list' 'SCENE: is missing ' check two-spheres
bad 'a mesh for the certificate' 'CERTIFICATE: .*--pairs' check good.obj folded.obj
bad 'a bad clearance' '--clearance: ' check two-spheres --pairs plain.csv --clearance -1
bad 'bad frames' '--frames: ' check two-spheres --pairs plain.csv --frames 0
rm near.json near.csv farther.json other.csv fewer.csv folded.csv broken.csv two.csv

# Triangles that lie on each other: memory for the pairs that there are, not for each pixel of each.
for name in first second; do
  {
    printf 'v 0 0 0\nv 1 0 0.3\nv 0 1 0.2\n'
    for ((i = 0; i < 1200; ++i)); do printf 'f 1 2 3\n'; done
  } >"$name.obj"
done
for device in cpu software; do
  ((cases += 1))
  limit=400000
  [[ $device == software ]] && limit=1000000
  (ulimit -v $limit && exec timeout 60 "$program" run first.obj second.obj --method far-pairs \
    --device $device --no-verify) >"$out" 2>"$err" || fail "coincident triangles, $device" "status $?"
  expect "coincident triangles, $device" "$out" '^colliding  1,440,000 pairs$'
done

# Where memory is the cause, the message says so. A limit too small for the libraries that the program
# is linked with is theirs to report: the loader's (status 127), or that of a library which takes memory
# before main(), as octomap under FCL does. Then not even --version works. And a driver may crash under
# it (docs/reliability.md).
least_started=0
for limit in 75000 80000 100000 150000 200000 300000 350000 400000; do
  (ulimit -v $limit && exec "$program" --version) >"$out" 2>"$err" || continue
  ((least_started > 0)) || least_started=$limit
  for method in 'far-pairs --device software' 'far-pairs --device cpu' far exact; do
    ((cases += 1))
    # shellcheck disable=SC2086  # the method and its device are words
    (ulimit -v $limit && exec timeout 60 "$program" run two-spheres --method $method) >"$out" 2>"$err"
    status=$?
    ((status == 0 || status == 127)) && continue
    ((status == 2)) || fail "$method in $limit KiB" "status $status"
    expect "$method in $limit KiB" "$err" '^farcull: .*memory.*; .*memory'
  done
done
((cases += 1))
((least_started > 0 && least_started <= 150000)) ||
  fail "limits on memory" "the least limit at which the program starts is $least_started KiB (0: none)"

if ((failed)); then
  echo "cli_pairs_test: $failed of $cases cases failed"
  exit 1
fi
echo "cli_pairs_test: $cases cases, none failed"
