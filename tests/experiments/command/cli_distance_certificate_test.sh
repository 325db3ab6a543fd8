#!/usr/bin/env bash
# Certificates of distances on the command line: what `farcull distance --certificate` writes,
# `farcull check` proves, and a forged one it does not.
#   tests/experiments/command/cli_distance_certificate_test.sh FARCULL_BINARY
set -uo pipefail

# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

# Two squares of two triangles each, 2 apart; a third one 3 above.
square() { printf 'v 0 0 %s\nv 1 0 %s\nv 0 1 %s\nv 1 1 %s\nf 1 2 3\nf 2 3 4\n' "$1" "$1" "$1" "$1"; }
square 0 >low.obj
square 2 >middle.obj
square 5 >high.obj
scene=(low.obj middle.obj high.obj)

good 'objects' 0 distance "${scene[@]}" --certificate objects.json
answers 'objects' 0 '^proved: these 3 pairs of objects are at exactly these distances, and there are' \
  check objects.json "${scene[@]}"
good 'within' 0 distance "${scene[@]}" --within 3 --certificate within.json
answers 'within' 0 '^proved: these 2 pairs of objects .* no others are at distance 3 or less$' \
  check within.json "${scene[@]}"
good 'nearest' 0 distance "${scene[@]}" --pairs nearest --certificate nearest.json
answers 'nearest' 0 "^proved: these 2 pairs of objects .* each object's nearest, and no others$" \
  check nearest.json "${scene[@]}"
good 'all' 0 distance "${scene[@]}" --pairs all --within 3 --certificate all.json
answers 'all' 0 '^proved: these [0-9]+ pairs of triangles .* at distance 3 or less$' \
  check all.json "${scene[@]}"
good 'self' 0 distance two-tori --self --certificate self.json
answers 'self' 0 '^proved: these 3 pairs of objects are at exactly' check self.json two-tori --self
good 'a built-in scene' 0 distance far-apart --certificate far.json
answers 'a built-in scene' 0 '^proved: ' check far.json far-apart

# A false distance; an entry that is not there; a text cut short; another scene.
sed 's|"4/1"|"5/1"|' objects.json >forged.json
answers 'forged' 1 '^refuted: the square of the distance in distances\[0\]' \
  check forged.json "${scene[@]}"
expect 'forged: the pair' "$out" '^  pair: low triangle 0 and middle triangle 0$'
expect 'forged: its distance' "$out" '^  the exact square of its distance: 4/1, so about 2$'
sed '/"objects":\[0,1\]/d' objects.json >shorter.json
answers 'left out' 1 '^refuted: the objects of these triangles are not listed$' \
  check shorter.json "${scene[@]}"
head -c 400 objects.json >cut.json
bad 'cut short' 'cut\.json: not JSON' check cut.json "${scene[@]}"
answers 'another scene' 1 '^not proved: the certificate is of another scene: objects ' \
  check objects.json low.obj middle.obj
echo object_a,triangle_a,object_b,triangle_b >list.csv
bad 'with a list' '--pairs: ' check objects.json "${scene[@]}" --pairs list.csv
bad 'with a clearance' '--clearance: ' check objects.json "${scene[@]}" --clearance 1
bad 'over the scene' '--certificate: ' distance "${scene[@]}" --certificate low.obj

# Frames.
for frame in 1 2; do square "$frame" >"moving_$frame.obj"; done
good 'frames' 0 distance low.obj 'moving_%d.obj' --frames 1:2 --certificate 'f_%d.json'
answers 'frames' 0 '^ *frame ' check 'f_%d.json' low.obj 'moving_%d.obj' --frames 1:2
expect 'frames' "$out" '^proved: in each of 2 frames the distances are exactly these'
cp f_1.json f_2.json
answers 'another frame' 1 '^ *frame ' check 'f_%d.json' low.obj 'moving_%d.obj' --frames 2:2
expect 'another frame' "$out" 'not proved: the certificate is of another scene: hash'

if ((failed)); then
  echo "cli_distance_certificate_test: $failed of $cases cases failed"
  exit 1
fi
echo "cli_distance_certificate_test: $cases cases, none failed"
