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
good 'ignored in frames' 0 verify two-spheres --frames 2 --ignore first:second
expect 'ignored in frames' "$out" ' 52,428,800 ignored \+ 0 missed$'

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
