#!/usr/bin/env bash
# Kinds of contact, ignored objects and limits from the command line: bad input and good cases.
#   tests/experiments/command/cli_contacts_test.sh FARCULL_BINARY
# Needs bash and Debian's essential tools.
set -uo pipefail

# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

triangle() { # NAME X Y Z X Y Z X Y Z: a mesh of one triangle
  printf 'v %s %s %s\nv %s %s %s\nv %s %s %s\nf 1 2 3\n' "${@:2}" >"$1.obj"
}
triangle floor 0 0 0 8 0 0 0 8 0
triangle fin 1 1 -1 1 1 1 1 3 0
triangle spike 4 2 0 4 2 3 5 2 3
triangle sheet 2 2 0 3 2 0 2 3 0
all=(floor.obj fin.obj spike.obj sheet.obj)

# --- bad input ---------------------------------------------------------------------------------

for option in --segments '--kinds crossing'; do
  # shellcheck disable=SC2086 # two words
  bad "$option without pairs" "${option%% *}: .*--pairs" run "${all[@]}" $option
done
for kinds in '' cross 'crossing,' ,crossing Crossing 'crossing coplanar'; do
  bad "kinds '$kinds'" '--kinds: .*give some of apart, ' run "${all[@]}" --pairs p.csv --kinds "$kinds"
done
for limit in 0 -1 1.5 '' all 99999999999999999999; do
  bad "limit '$limit'" '--limit: .*1 or more' run "${all[@]}" --limit "$limit"
done
bad 'an unknown name' "--ignore: 'floor:wing' names 'wing', and no object is called so; .*floor, fin" \
  run "${all[@]}" --ignore floor:wing
bad 'no colon' "--ignore: 'floor' has no colon" run "${all[@]}" --ignore floor
bad 'one object' "--ignore: 'fin:fin' names one object" verify "${all[@]}" --ignore fin:fin
bad 'an empty pair' '--ignore: a pair of names is empty' plan "${all[@]}" --ignore fin:floor,
bad 'no file' 'none\.txt: cannot be read' run "${all[@]}" --ignore-file none.txt
printf '# only a comment\n' >nothing.txt
bad 'a file of nothing' 'nothing\.txt: names no pair' run "${all[@]}" --ignore-file nothing.txt
printf 'floor:fin\n\nfloor:wing\n' >wrong.txt
bad 'a wrong line' "wrong\.txt:3: 'floor:wing' names 'wing'" run "${all[@]}" --ignore-file wrong.txt
for option in '--limit 1' '--ignore floor:fin' '--ignore-file wrong.txt'; do
  # shellcheck disable=SC2086 # two words
  bad "a certificate with $option" "${option%% *}: a certificate is about all " run "${all[@]}" \
    $option --certificate c.json
done

# --- good cases --------------------------------------------------------------------------------

good 'kinds' 0 verify "${all[@]}" --contacts --pairs kinds.csv
expect 'kinds' "$out" '^contacts   1 touch-vertex \+ 1 coplanar \+ 1 crossing$'
expect 'kinds' <(head -n 1 kinds.csv) '^object_a,triangle_a,object_b,triangle_b,contact$'
for line in 0,0,1,0,crossing 0,0,2,0,touch-vertex 0,0,3,0,coplanar; do
  expect 'kinds' kinds.csv "^$line$"
done
good 'without kinds' 0 run "${all[@]}" --pairs plain.csv
((cases += 1))
cmp -s plain.csv <(cut -d, -f1-4 kinds.csv) || fail 'kinds' 'the other columns differ'
good 'a list with kinds is proved' 0 check --pairs kinds.csv "${all[@]}"
good 'segments' 0 run "${all[@]}" --segments --faces --pairs -
expect 'segments' "$out" '^object_a,.*,contact,x0,y0,z0,x1,y1,z1,face_a,face_b$'
expect 'segments' "$out" '^0,0,1,0,crossing,1,1,0,1,3,0,0,0$'
expect 'segments' "$out" '^0,0,2,0,touch-vertex,4,2,0,4,2,0,0,0$'
expect 'segments' "$out" '^0,0,3,0,coplanar,,,,,,,0,0$'
good 'some kinds' 0 run "${all[@]}" --kinds crossing,coplanar --pairs some.csv
((cases += 1))
cmp -s some.csv <(grep -v touch kinds.csv) || fail 'some kinds' 'other lines'
good 'kinds of a clearance' 0 run "${all[@]}" --clearance 9 --kinds apart --pairs -
expect 'kinds of a clearance' "$out" '^0,0,|^1,0,2,0,apart$'
good 'kinds of frames' 0 run two-spheres --frames 2 --contacts --json - --pairs frames.csv
expect 'kinds of frames' "$out" '^ +"crossing": [0-9]+,$'
expect 'kinds of frames' <(head -n 1 frames.csv) '^frame,object_a,.*,contact$'

good 'ignored' 0 verify "${all[@]}" --ignore 'f*:spike' --pairs ignored.csv
expect 'ignored' "$out" '^ignored    0 candidate pairs of 2 pairs of objects$' # far-pairs makes none of them
expect 'ignored' "$out" ' 2 ignored \+ 0 missed$'
((cases += 1))
cmp -s ignored.csv <(grep -v ',2,0$' plain.csv) || fail 'ignored' 'other pairs'
printf '# links\nfloor:spike\nfin:spike\n' >pairs.txt
for method in far-pairs exact i-collide; do
  good "ignored by $method" 0 run "${all[@]}" --method "$method" --ignore-file pairs.txt \
    --pairs by.csv
  ((cases += 1))
  cmp -s ignored.csv by.csv || fail "ignored by $method" 'other pairs'
done
printf '\xEF\xBB\xBFfloor:spike\r\nfin:spike\r\n' >marked.txt
good 'a byte order mark' 0 run "${all[@]}" --ignore-file marked.txt --pairs by.csv
((cases += 1))
cmp -s ignored.csv by.csv || fail 'a byte order mark' 'other pairs'
good 'ignored in frames' 0 verify two-spheres --frames 2 --ignore first:second
expect 'ignored in frames' "$out" ' 52,428,800 ignored \+ 0 missed$'
# An object of the first frame that is gone in the second one; and one that comes in the second.
printf '%s\n' 'v 1 1 -1' 'v 1 1 1' 'v 1 3 0' 'g a' 'f 1 2 3' >parts_2.obj
cat parts_2.obj - <<<$'v 4 1 -1\nv 4 1 1\nv 4 3 0\ng b\nf 4 5 6' >parts_1.obj
printf '{"objects": [{"mesh": "parts_%%d.obj", "split": "groups"}, {"mesh": "floor.obj"}]}' >parts.json
good 'an object that goes' 0 verify parts.json --frames 1:2 --ignore '*/b:floor' --pairs frames.csv
((cases += 1))
cmp -s frames.csv <(printf 'frame,object_a,triangle_a,object_b,triangle_b\n1,0,0,2,0\n2,0,0,1,0\n') ||
  fail 'an object that goes' 'other pairs'
bad 'an object that comes' "--ignore: '\*/b:floor' names '\*/b', and no object is called so" \
  run parts.json --frames 2:2 --ignore '*/b:floor'
sed 's|^{|{"ignore": [["*/b", "floor"]], |' parts.json >ignores.json
good 'an object that goes, in the file' 0 verify ignores.json --frames 1:2 --pairs file.csv
((cases += 1))
cmp -s frames.csv file.csv || fail 'an object that goes, in the file' 'other pairs'
bad 'an object that comes, in the file' "ignores\.json:1: ignore\[0\] names '\*/b', and no object is called so" \
  run ignores.json --frames 2:2

# A polygon whose triangles a rounded sign would put outside of it, where the triangle is.
printf '%s\n' 'v .002 .002 0' 'v .004 .002 0' 'v .006 -.003 0' 'v -.006 -.006 0' 'v -.003 .001 0' \
  'v -.003 -.005 0' 'v .003 -.003 0' 'f 1 2 3 4 5 6 7' >seven.obj
triangle outside -.0003 -.0026 -.001 -.0003 -.0026 .001 -.0002 -.0026 .001
good 'a triangle outside a polygon' 0 verify seven.obj outside.obj
expect 'a triangle outside a polygon' "$out" '^colliding +0 pairs$'
# A polygon that crosses itself is named.
printf '%s\n' 'v 0 0 0' 'v 3 0 0' 'v 3 3 0' 'v 0 2 0' 'g a' 'f 1 2 3' 'g b' 'f 1 3 2 4' >folded.obj
printf '{"objects": [{"mesh": "folded.obj", "split": "groups"}]}' >folded.json
good 'a folded polygon' 0 run folded.json
expect 'a folded polygon' "$out" '^folded: 2 objects, 3 triangles, 1 polygon folded: face 1 of folded/b$'
good 'a folded polygon, as JSON' 0 run folded.json --json -
expect 'a folded polygon, as JSON' <(tr -d ' \n' <"$out") \
  '"folded_polygons":1,"folded":\[\{"object":"folded/b","face":1\}\],'
good 'a folded polygon of distances' 0 distance folded.json
expect 'a folded polygon of distances' "$out" '1 polygon folded: face 1 of folded/b$'

good 'a limit' 0 verify "${all[@]}" --limit 2 --pairs - --json first.json
((cases += 1))
cmp -s "$out" <(head -n 3 plain.csv) || fail 'a limit' 'other pairs'
expect 'a limit' first.json '"complete": false'
good 'a limit in the table' 0 run two-tori --limit 1
expect 'a limit in the table' "$out" '^limit      1 pair at most; .* behind the last one$'
good 'a limit beyond all' 0 run "${all[@]}" --limit 4 --json -
expect 'a limit beyond all' "$out" '"complete": true'

if ((failed)); then
  echo "cli_contacts_test: $failed of $cases cases failed"
  exit 1
fi
echo "cli_contacts_test: $cases cases, none failed"
