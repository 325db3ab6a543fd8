#!/usr/bin/env bash
# The methods, the plan, the studies of the family and of savings, from the command line: good cases
# and every bad input, as cli_test.sh does it for the rest.
#   tests/experiments/command/cli_methods_test.sh FARCULL_BINARY
# Needs bash, Debian's essential tools and a software device of Mesa.
set -uo pipefail

# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

echo older >old.json
obj 'v 1 1 -1' 'v 1 1 1' 'v 0 0 -1' 'f 1 2 3' 'f 1 2 4' 'f 5 6 7' >folded.obj

# --- bad input ---------------------------------------------------------------------------------

for method in quick-cullide s-cullide; do
  bad "$method with a clearance" '--clearance: .*far-pairs' run two-spheres --method "$method" \
    --clearance 0
  bad "$method with fragment depth" '--depth: ' run two-spheres --method "$method" --depth fragment
  bad "$method with a radius" '--radius: ' run two-spheres --method "$method" --radius 0.5
  bad "$method with an offset" '--offset: ' run two-spheres --method "$method" --offset exact
  bad "$method with flags and 24 bits" '--query: ' run two-spheres --method "$method" \
    --query flags --depth-format 24
done
bad 'quick-cullide with self' '--self: .*s-cullide' run two-spheres --method quick-cullide --self
bad 's-cullide without self' 'two-spheres: .*--self' run two-spheres --method s-cullide
bad 'plan of s-cullide without self' 'two-spheres: .*--self' plan two-spheres --method s-cullide
bad 'i-collide with a query' '--query: ' run two-spheres --method i-collide --query flags
bad 'i-collide with a clearance' '--clearance: ' run two-spheres --method i-collide --clearance 1
bad 'exact with full' '--full: ' run two-spheres --method exact --full
bad 'a value for --full' '--full: ' run two-spheres --full=7
for sizes in '' 1 0 x 32,32 16,32 32, 1e3; do
  bad "clusters '$sizes'" '--clusters: ' run two-spheres --method far --clusters "$sizes"
done
bad 'clusters with far-pairs' '--clusters: ' run two-spheres --method far-pairs --clusters 32
for method in i-collide exact; do
  bad "$method with a resolution" '--resolution: ' run two-spheres --method "$method" --resolution 64
  bad "$method with views" '--views: ' run two-spheres --method "$method" --views x
  bad "$method with a device" '--device: ' run two-spheres --method "$method" --device software
done
for rounds in '' 0 -1 x 1.5; do
  bad "rounds '$rounds'" '--rounds: ' run two-spheres --method cullide --rounds "$rounds"
done
bad 'a clear rule that is none' '--clear: ' run two-spheres --method cullide --clear some
bad 'a level that is none' '--level: ' run two-spheres --method cullide --level faces
for option in '--rounds 1' '--clear all' '--level objects' '--conservative'; do
  # shellcheck disable=SC2086
  bad "far-pairs with $option" "${option%% *}: .*cullide" run two-spheres --method far-pairs $option
  # shellcheck disable=SC2086
  bad "compare without a use for $option" "${option%% *}: " compare two-spheres \
    --methods far-pairs,exact $option
done
bad 'far drawn conservatively' '--conservative: .*cullide' run two-spheres --method far --conservative
bad 's-cullide of objects alone' '--level: ' run folded.obj --method s-cullide --self --level objects
bad 'far of objects alone against themselves' '--level: .*self' run cloth:400 --method far --self \
  --level objects
bad 'clusters of objects alone' '--clusters: ' run two-spheres --method cullide --level objects \
  --clusters 8
bad 'conservative without the extension' '--conservative: .*--device native' run two-spheres \
  --method cullide --conservative --device software
bad 'an unknown method' '--method: .*quick-cullide' run two-spheres --method quick
for command in plan; do
  bad "$command without a scene" 'SCENE: ' "$command"
  bad "$command of nothing known" 'nope: ' "$command" nope
  bad "$command with frames" '--frames: ' "$command" two-spheres --frames 3
  bad "$command to a full device" 'standard output|/dev/full' "$command" two-spheres --json /dev/full
done
bad 'an unknown study' 'nope: .*family' experiment nope
bad 'family of what stands still' '--frames: nothing ' experiment family two-tori --frames 2
bad 'family by no method' '--methods: ' experiment family two-spheres --methods nope --frames 2
bad 'family of no frames' '--frames: ' experiment family two-spheres --frames 0
bad 'family at no resolution' '--resolution: ' experiment family two-spheres --resolution 0
bad 'family with no query' '--query: ' experiment family two-spheres --query maybe
bad 'family with auto views' '--views: ' experiment family two-spheres --views auto
bad 'family into a folder' '\.: ' experiment family two-spheres --frames 1 --csv .
bad 'savings of nothing known' 'nope: ' experiment savings nope
bad 'family of an unknown scene last' 'nosuch: ' experiment family two-bunnies nosuch --frames 1000
bad 'family of nothing to ask' '--methods: .*--self' experiment family two-spheres \
  --methods s-cullide --frames 1
bad 'savings of exact' '--methods: ' experiment savings far-apart --methods exact
bad 'savings of an unknown scene last' 'nosuch: ' experiment savings two-bunnies nosuch
bad 'savings never repeated' '--repeat: ' experiment savings far-apart --repeat 0
bad 'savings by no method' '--methods: ' experiment savings far-apart --methods nope

# --- good cases --------------------------------------------------------------------------------

# The default, and what is not it.
good 'the default' 0 run two-spheres --json default.json
expect 'the default' "$out" '^method     far-pairs; promises to miss nothing$'
expect 'the default' "$out" '^default    no --method: far-pairs misses nothing, and is the fastest on '
expect 'the default' "$out" \
  '^           others: far, cullide, quick-cullide, s-cullide, i-collide or exact \('
expect 'the default' default.json '^  "method": "far-pairs",$'
expect 'the default' default.json '^  "method_reason": "no --method: far-pairs misses nothing, '
good 'the default of plan' 0 plan two-spheres
expect 'the default of plan' "$out" '^default    no --method: far-pairs '
good 'named' 0 run two-spheres --method far-pairs --json named.json
expect 'named' named.json '^  "method_reason": "--method",$'
((cases += 1))
grep -q '^default' "$out" && fail 'named' 'it is called the default'
rm default.json named.json
bad 'a radius of the default' '--radius: .*far-pairs; .*--method far' run two-spheres --radius 1

good 'plan' 0 plan far-apart --method far
expect 'plan' "$out" '^draw +left out +no two objects'
expect 'plan' "$out" '^not asked +whether an object meets itself: '
good 'plan of everything' 0 plan far-apart --method far --full --no-verify
expect 'plan of everything' "$out" '^setup +runs '
expect 'plan of everything' "$out" '^verify +left out '
good 'plan as JSON' 0 plan two-spheres --method far-pairs --json -
expect 'plan as JSON' "$out" '"decision": "depends"'
good 'plan of self-collision' 0 plan folded.obj --method far-pairs --self
expect 'plan of self-collision' "$out" '^self +1 object is tested against itself'
good 'plan of far inside objects' 0 plan two-spheres --method far --self
expect 'plan of far inside objects' "$out" '^patches +.*32 patches of at most 320 triangles'
good 'far inside a small object' 0 verify folded.obj --method far --self
expect 'far inside a small object' "$out" '^patches .*boxes alone$'
expect 'far inside a small object' "$out" 'promises to miss nothing$'

good 'quick-cullide' 0 run crowd --method quick-cullide --resolution 64 --device software --json -
expect 'quick-cullide' "$out" '"draws_saved": [1-9]'
expect 'quick-cullide' "$out" '"promises": false'
good 'cullide by occlusion queries' 0 run two-spheres --method cullide --resolution 64 \
  --device software --query occlusion --depth-format 24
expect 'cullide by occlusion queries' "$out" 'occlusion queries'
good 's-cullide' 0 run folded.obj --method s-cullide --self --resolution 64 --device software
expect 's-cullide' "$out" '^method     s-cullide at 64 px'
good 'i-collide' 0 verify two-spheres --method i-collide
expect 'i-collide' "$out" '^colliding  298 pairs$'
good 'i-collide in motion' 0 verify two-spheres --method i-collide --frames 3
good 'clusters' 0 run crowd --method cullide --clusters 64,8 --resolution 64 --device software
expect 'clusters' "$out" 'clusters of 8'
good 'a form of cullide' 0 run crowd --method cullide --rounds 1 --clear all --conservative \
  --views x,-x,y,-y,z,-z --resolution 64 --device native --json form.json
expect 'a form of cullide' "$out" '^method     cullide at 64 px, --rounds 1 --clear all --conservative'
expect 'a form of cullide' "$out" '^agree, round 1'
expect 'a form of cullide' form.json '"rounds": 1'
expect 'a form of cullide' form.json '"clear": "all"'
expect 'a form of cullide' form.json '"level": "triangles"'
expect 'a form of cullide' form.json '"conservative": true'
good 'plan of a form' 0 plan crowd --method quick-cullide --rounds 1 --level objects
expect 'plan of a form' "$out" '^further rounds +left out +--rounds 1'
good 'forms of far' 0 verify crowd --method far --rounds 1 --clear all --resolution 64
good 'compare forms' 0 compare two-spheres --methods far,cullide,exact --resolutions 64 --rounds 1 \
  --level objects --device native
expect 'compare forms' "$out" '^cullide --rounds 1 --level objects '
good 'exact offsets' 0 verify crowd --method far --offset exact --resolution 64 --device software
good 'full' 0 verify far-apart --method far-pairs --device cpu --full
expect 'full' "$out" '^colliding  0 pairs$'
good 'compare the family' 0 compare two-spheres --methods cullide,quick-cullide,i-collide,exact \
  --resolutions 64 --device software
expect 'compare the family' "$out" '^i-collide +- +- '

good 'family' 0 experiment family two-spheres --methods far-pairs,i-collide --frames 3 --csv - \
  --json family.json
expect 'family' "$out" '^scene,method,offset,frame,'
expect 'family' "$out" '^two-spheres,far-pairs,,2,'
expect 'family' family.json '"missed": 0'
good 'family for people' 0 experiment family two-spheres --methods i-collide --frames 2
expect 'family for people' "$out" '^two-spheres +10,240 +i-collide '
good 'savings' 0 experiment savings far-apart --methods i-collide --repeat 2 --json -
expect 'savings' "$out" '"same_pairs": true'

if ((failed)); then
  echo "cli_methods_test: $failed of $cases cases failed"
  exit 1
fi
echo "cli_methods_test: $cases cases, none failed"
