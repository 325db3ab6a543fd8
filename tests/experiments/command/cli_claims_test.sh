#!/usr/bin/env bash
# What the program claims and what it may overwrite: a certificate says no more than it proves and
# is bound to the list of pairs; what was not asked is said; no output is an input.
#   tests/experiments/command/cli_claims_test.sh FARCULL_BINARY
# Needs bash, Debian's essential tools and a software device of Mesa.
set -uo pipefail

# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

# --- certificates ------------------------------------------------------------------------------

# A run that misses pairs, and the truth.
missing=(two-spheres --method quick-cullide --device software --resolution 16)
good 'a run that misses' 0 run "${missing[@]}" --certificate c.json --pairs missed.csv
expect 'a run that misses' "$out" ' \+ [1-9][0-9,]* missed$'
good 'the pairs' 0 run two-spheres --method exact --certificate exact.json --pairs pairs.csv
sha=$(sha256sum pairs.csv | cut -d' ' -f1)
expect 'the hash is that of the list' exact.json "^  \"list_sha256\": \"$sha\",$"
expect 'the hash is that of the list of the run' c.json \
  "^  \"list_sha256\": \"$(sha256sum missed.csv | cut -d' ' -f1)\",$"
answers 'a certificate of exact' 0 '^proved: these [0-9,]+ pairs of the scene meet, and no others$' \
  check exact.json two-spheres --pairs pairs.csv
expect 'a certificate of exact' "$out" "^list .*$sha$"
expect 'a certificate of exact' "$out" 'pairs\.csv is this list: [0-9,]+ rows$'
expect 'a certificate of exact' "$out" '^  which pairs the run kept'
answers 'another list' 1 '^not proved: missed\.csv is another list: a pair is missing$' \
  check exact.json two-spheres --pairs missed.csv
answers 'a certificate of a run that misses' 1 '^refuted: the pair is called culled, and it meets$' \
  check c.json two-spheres

# Forged: bit 6 set where a culled pair meets (byte 38, which is &, becomes f), two counts mended,
# another method. That says nothing false of the scene but for the list of pairs.
decoded() { sed -n 's/^  "evidence": "\(.*\)"$/\1/p' "$1" | base64 -d; }
value() { sed -n "s/^ *\"$2\": \([0-9]*\),\$/\1/p" "$1"; }
lies=$(decoded c.json | tr -cd '\046' | wc -c)
((cases += 1))
((lies > 0)) || fail 'forging' 'the run missed no pair'
sed -E -e "s/\"kept\": [0-9]+/\"kept\": $(($(value c.json kept) + lies))/" \
  -e "s/\"culled\": [0-9]+/\"culled\": $(($(value c.json culled) - lies))/" \
  -e 's/quick-cullide/far/' \
  -e "s|\"evidence\": \".*\"|\"evidence\": \"$(decoded c.json | tr '\046' '\146' | base64 -w 0)\"|" \
  c.json >forged.json
answers 'a forged certificate' 1 '^not proved: the certificate is of another list of pairs: ' \
  check forged.json two-spheres
sed -E "s/\"list_sha256\": \"[0-9a-f]+\"/\"list_sha256\": \"$sha\"/" forged.json >of_the_scene.json
answers 'forged with the hash as well' 0 '^proved: these [0-9,]+ pairs of the scene meet, and no' \
  check of_the_scene.json two-spheres
expect 'it proves nothing of the run' "$out" '^unattested, .* about the scene and not about the run:$'
expect 'it proves nothing of the run' "$out" '^  that the method was far$'
expect 'it proves nothing of the run' "$out" '^  which pairs the run kept'
answers 'and is not the list of the run' 1 '^not proved: missed\.csv is another list: ' \
  check of_the_scene.json two-spheres --pairs missed.csv
bad 'a list that is not there' 'nothing\.csv: ' check exact.json two-spheres --pairs nothing.csv
bad 'an empty name of a list' '--pairs: ' check exact.json two-spheres --pairs ''
sed 's/"version": 3/"version": 2/' exact.json >older.json
bad 'a certificate of another version' 'older\.json: version is not 3' check older.json two-spheres

# --- what was not asked ------------------------------------------------------------------------

# Two triangles of one object that pierce each other.
obj 'v 0.2 0.2 -1' 'v 0.2 0.2 1' 'v 0.3 0.6 1' 'f 1 2 3' 'f 5 6 7' >pierced.obj
obj 'f 1 2 3' >good_of_claims.obj
line='not asked +whether an object meets itself: 1 pair of triangles inside pierced \('
unasked() { # CASE ARGUMENTS...: the text says it
  good "$1" 0 "${@:2}"
  expect "$1 says what was not asked" "$out" "^$line"
}
unasked run run pierced.obj --method far-pairs --certificate p.json --json r.json
expect 'run asks by an option' "$out" '^not asked .*\(--self asks\)$'
expect 'run promises' "$out" 'promises to miss nothing$'
expect 'the record says it' <(tr -d ' \n' <r.json) '"self_not_asked":{"objects":1,"pairs":1,"which":\[\[0,0\]\]}'
expect 'the certificate says it' <(tr -d ' \n' <p.json) '"not_asked":{"objects":1,"pairs":1}'
# One object leaves nothing to test. That is said, with the command that tests it.
nothing='^nothing to test: the scene is one object, and an object is tested .* only with --self$'
for command in run verify plan; do
  good "nothing for $command" 0 "$command" pierced.obj
  expect "nothing for $command" "$out" "$nothing"
  expect "nothing for $command" "$out" "^this tests it: farcull $command pierced\\.obj --self$"
done
((cases += 1))
grep -q '^verified' "$out" && fail 'nothing for verify' 'it is verified'
good 'nothing for compare' 0 compare pierced.obj --methods far-pairs,exact
expect 'nothing for compare' "$out" '^this tests it: farcull compare pierced\.obj --self$'
good 'nothing for cullide' 0 run pierced.obj --method cullide --device software --resolution 64
expect 'nothing for cullide' "$out" \
  '^this tests it: farcull run pierced\.obj --method far-pairs --self$'
printf '{"objects": [{"mesh": "pierced.obj"}]}' >one.json
good 'nothing in a scene file' 0 verify one.json
expect 'nothing in a scene file' "$out" '^this tests it: farcull verify one\.json --self$'
expect 'the record says it' r.json '^    "nothing_to_test": "the scene is one object, and '
good 'plan as JSON' 0 plan pierced.obj --json -
expect 'the plan says it' "$out" '^  "nothing_to_test": "the scene is one object, and '
good 'something for verify' 0 verify pierced.obj --self --json something.json
expect 'something for verify' "$out" '^verified: no colliding pair was culled, 1 pair accounted for$'
expect 'something for verify' something.json '^    "nothing_to_test": null,$'
((cases += 1))
grep -q 'nothing to test' "$out" && fail 'something for verify' 'it says that there is nothing'
printf '{"objects": [{"mesh": "pierced.obj", "self": true}]}' >one.json
good 'something in a scene file' 0 verify one.json
expect 'something in a scene file' "$out" '^verified: '
good 'two objects' 0 verify pierced.obj good_of_claims.obj
expect 'two objects' "$out" '^verified: '
answers 'check' 0 '^proved: no pair of the scene meets$' check p.json pierced.obj
expect 'check says what was not asked' "$out" "^$line"
unasked verify verify pierced.obj --method far-pairs
unasked 'run far' run pierced.obj --method far --device software --resolution 64
expect 'run far asks by an option' "$out" '^not asked .*\(--self asks\)$'
unasked 'run cullide' run pierced.obj --method cullide --device software --resolution 64
expect 'run cullide asks by a method' "$out" '^not asked .*\(--method far-pairs --self asks\)$'
unasked compare compare pierced.obj --methods far-pairs,exact
unasked bench bench pierced.obj --device cpu --repeat 1 --peers none
cp pierced.obj pierced0.obj
good 'frames' 0 run 'pierced%d.obj' --method far-pairs --frames 1
expect 'frames leave nothing' "$out" "^this tests it: farcull run pierced%d\\.obj --method far-pairs --frames 1 --self$"
expect 'frames say what was not asked' "$out" '^not asked .* 1 pair of triangles inside pierced'
good 'frames' 0 run 'pierced%d.obj' --method far-pairs --frames 1 --json -
expect 'frames say what was not asked' <(tr -d ' \n' <"$out") '"self_not_asked":{"objects":1,"pairs":1,'
good 'plan' 0 plan pierced.obj --method far-pairs
expect 'plan' "$out" '^not asked  whether an object meets itself: 1 pair of triangles inside pierced '
good 'asked' 0 run pierced.obj --method far-pairs --self --certificate s.json --pairs s.csv
expect 'asked' "$out" '^colliding +1 pair '
((cases += 1))
grep -q 'not asked' "$out" && fail 'asked' 'it says that it was not'
answers 'check of it' 0 '^proved: this pair of the scene meets, and no other$' check s.json pierced.obj \
  --self --pairs s.csv

# --- outputs that are inputs -------------------------------------------------------------------

mkdir sub meshes
obj 'f 1 2 3' >sub/good.obj
obj 'f 1 2 4' >frame_7.obj
cp sub/good.obj meshes/armadillo.off
printf '{"objects": [{"mesh": "sub/good.obj"}, {"mesh": "%s/frame_7.obj"}]}' "$PWD" >s.json
printf '{"objects": [{"mesh": "frame_%%d.obj"}]}' >moving.json
ln -s s.json link.json
ln s.json hard.json
ln -s sub/good.obj mesh_link.json
ln frame_7.obj mesh_hard.csv
ln -s meshes/armadillo.off packaged.json
ln -s nowhere.json dangling.json
for output in s.json ./s.json "$PWD/s.json" sub/../s.json link.json hard.json; do
  for command in run verify plan compare bench; do
    bad "$command --json $output" '--json: .* SCENE .*; choose another place for --json' \
      "$command" s.json --json "$output"
  done
  for option in --pairs --certificate; do
    bad "run $option $output" "$option: .* SCENE " run s.json "$option" "$output"
    bad "verify $option $output" "$option: .* SCENE " verify s.json "$option" "$output"
  done
  bad "picture -o $output" '-o: .* SCENE ' picture s.json -o "$output"
  bad "savings --json $output" '--json: .* SCENE ' experiment savings s.json --json "$output"
  bad "family --csv $output" '--csv: .* SCENE ' experiment family s.json --csv "$output"
done
for output in mesh_link.json mesh_hard.csv; do
  for command in run verify plan compare bench 'experiment savings'; do
    # shellcheck disable=SC2086 # two words
    bad "$command over a mesh of the scene file by $output" '--json: .*obj, which SCENE reads' \
      $command s.json --json "$output"
  done
  bad "picture over a mesh by $output" '-o: .*obj, which SCENE reads' picture s.json -o "$output"
  bad "run --pairs over a mesh by $output" '--pairs: .*obj, which SCENE reads' \
    run sub/good.obj frame_7.obj --pairs "$output"
done
moving=(--method far-pairs --frames 7:7)
bad 'a numbered mesh' '--json: mesh_hard\.csv is frame_7\.obj, which SCENE' run 'frame_%d.obj' \
  sub/good.obj "${moving[@]}" --json mesh_hard.csv
bad 'a numbered mesh of a scene file' '--pairs: mesh_hard\.csv is frame_7\.obj, which SCENE' \
  verify moving.json "${moving[@]}" --pairs mesh_hard.csv
cp exact.json kept.json
for output in exact.json ./exact.json; do
  bad "check --json $output" '--json: .*CERTIFICATE reads' check exact.json two-spheres \
    --json "$output"
done
bad 'check over the list' '--json: pairs\.csv is pairs\.csv, which --pairs reads' check exact.json \
  two-spheres --pairs pairs.csv --json pairs.csv
bad 'check over the scene' '--json: .* SCENE ' check exact.json s.json --json link.json
settings=("FARCULL_MESHES=$PWD/meshes")
bad 'a packaged mesh' '--json: packaged\.json is .*armadillo\.off, which SCENE' run near-copy \
  --json packaged.json
bad 'a packaged mesh of any scene' '--json: packaged\.json is .*armadillo\.off, which SCENE' \
  experiment savings --json packaged.json
bad 'a scene over the meshes that it is made of' '--write: .*armadillo\.off, which SCENE reads' \
  scenes armadillo --write meshes
settings=()
mkdir -p results/report
: >results/report/results.sqlite
ln -s report/results.sqlite results/results.sqlite
bad 'results in the report' 'results/results\.sqlite: leads into DIR/report' report results

# Two outputs that are one file.
for other in new.csv ./new.csv "$PWD/new.csv" sub/../new.csv; do
  bad "two outputs, $other" "--pairs: .*where --json goes as well" run two-spheres --json new.csv \
    --pairs "$other"
done
bad 'two outputs by a link' '--certificate: .*where --json goes as well' run two-spheres \
  --json hard.json --certificate link.json
# A link to a file that is not there counts as that file; so does a link to such a link.
ln -s "$PWD/sub/../dangling.json" chain.json
bad 'the first output by a link to nowhere' '--pairs: .*where --json goes as well' run two-spheres \
  --json dangling.json --pairs nowhere.json
bad 'the second output by a link to nowhere' '--pairs: .*where --json goes as well' run two-spheres \
  --json nowhere.json --pairs dangling.json
bad 'two outputs by links to nowhere' '--certificate: .*where --json goes as well' run two-spheres \
  --json chain.json --certificate dangling.json
# Standard output is one as well.
((cases += 1))
before=$(snapshot)
timeout "$seconds" "$program" run s.json --method exact >>s.json 2>"$err"
status=$?
: >"$out"
refused 'the table into the scene' 'standard output: .* SCENE '
[[ $before == "$(snapshot)" ]] || fail 'the table into the scene' 'the folder changed'
((cases += 1))
timeout "$seconds" "$program" run s.json --method exact --json both.txt >>both.txt 2>"$err"
status=$?
refused 'the table and the record into one file' '--json: .*where standard output goes as well'
[[ -s both.txt ]] && fail 'the table and the record into one file' 'something was written'
rm both.txt

# What is allowed stays so.
good 'another file' 0 run s.json --method exact --json kept.json --pairs pairs.csv
good 'a link to nowhere, and another file' 0 run s.json --method exact --json dangling.json \
  --pairs elsewhere.csv
good 'the same device twice' 0 run s.json --method exact --json /dev/null --pairs /dev/null
to=/dev/null
good 'the same device as stdout' 0 run s.json --method exact --json /dev/null
to=$out
good 'frames that are not read' 0 run 'frame_%d.obj' sub/good.obj --method far-pairs --frames 7:7 \
  --json kept.json

if ((failed)); then
  echo "cli_claims_test: $failed of $cases cases failed"
  exit 1
fi
echo "cli_claims_test: $cases cases, none failed"
