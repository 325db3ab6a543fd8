#!/usr/bin/env bash
# farcull picture from the command line: good cases and every bad input, as cli_test.sh does it for
# the rest.
#   tests/experiments/command/cli_picture_test.sh FARCULL_BINARY
# Needs bash, Debian's essential tools and a software device of Mesa.
set -uo pipefail

# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

echo older >old.png
mkdir folder locked
chmod a-w locked
obj 'v 1 1 -1' 'v 1 1 1' 'v 0 0 -1' 'f 1 2 3' 'f 5 6 7' >crossing.obj
readonly small=(--size 100x80)

# --- bad input ---------------------------------------------------------------------------------

p() { bad "$1" "$2" picture two-spheres "${@:3}"; }
bad 'no scene' 'SCENE: ' picture -o new.png
bad 'an unknown scene' 'nowhere' picture nowhere -o new.png
p 'no output' '-o: '
p 'an empty output' '-o: ' -o ''
p 'an option for the output' '-o: ' -o --zoom
p 'an output named like a mesh' '-o: .*mesh' -o crossing.obj
p 'a folder for the output' 'folder: ' -o folder
p 'no such folder' 'nofolder/new.png: ' -o nofolder/new.png
if ((EUID != 0)); then p 'a folder without permission' 'locked/new.png: ' -o locked/new.png; fi
p 'an unknown method' "--method: 'nope'" --method nope -o new.png
p 'an unknown method to compare' "--compare: 'nope'" --compare far,nope -o new.png
p 'an empty method to compare' "--compare: ''" --compare far, -o new.png
p 'a bad resolution to compare' '--compare: ' --compare far:x -o new.png
p 'a resolution for exact' '--compare: exact' --compare exact:64 -o new.png
p 'both' '--compare: ' --compare far --method far -o new.png
p 'seven panels' '--compare: 7' --compare far,far,far,far,far,far,far -o new.png
p 'a radius of the default' '--radius: .*--method far' --radius 1 -o new.png
p 'a radius without far' '--radius: ' --method cullide --radius 1 -o new.png
p 'a depth without far' '--depth: ' --method cullide --depth fixed -o new.png
p 'an unknown depth' '--depth: ' --method far --depth deep -o new.png
p 'a resolution without pixels' '--resolution: ' --resolution 0 -o new.png
p 'a resolution that exact has not' '--resolution: ' --method exact --resolution 64 -o new.png
for size in '' 100 100x 100xx80 x80 100x80x 61x80 100x4097 -100x80 99999999999x80 100X80; do
  p "the size '$size'" '--size' --size "$size" -o new.png
done
p 'an unknown direction' "--view: 'up'" --view up -o new.png
p 'no direction' '--view: ' --view 0:0:0 -o new.png
p 'an empty direction' '--view: ' --view '' -o new.png
p 'up along the view' '--up: ' --view y --up y -o new.png
p 'an unknown view of the method' '--view-depth: ' --method far --view-depth top -o new.png
p 'the depth of exact' '--view-depth: exact' --method exact --view-depth -o new.png
p 'a frame that is none' '--frame: ' --frame x -o new.png
p 'a frame below' '--frame: ' --frame -1 -o new.png
p 'a frame beyond' '--frame: ' --frame 5 --frames 5 -o new.png
p 'frames alone' '--frames: ' --frames 5 -o new.png
p 'an empty page' '--html: ' --html ''
p 'a page to standard output' '--html: ' --html -
p 'a page named like a mesh' '--html: .*mesh' --html crossing.obj
p 'a page and a picture in one file' '--html' --html new.png -o new.png
p 'a page of a stored depth' '--html: ' --method far --view-depth --html new.html
p 'resolutions without a page' '--resolutions: ' --method far --resolutions 32,64 -o new.png
p 'no resolution' '--resolutions: ' --method far --resolutions 32, --html new.html
p 'resolutions that no method takes' '--resolutions: ' --compare exact,far:64 --resolutions 32 --html new.html
p 'an unknown device' '--device: ' --device nope --method cullide -o new.png
p 'an unknown option' '--nope: ' --nope -o new.png
p 's-cullide without self' 'two-spheres: ' --method s-cullide -o new.png
bad 'a scene that does not move' '.*move' picture far-apart --frame 0 -o new.png
bad 'zoom without a collision' '--zoom: ' picture far-apart --method exact --zoom -o new.png

# --- what it says and writes -------------------------------------------------------------------

is_png() { # CASE FILE
  ((cases += 1))
  [[ $(head -c 8 "$2" | od -An -tx1 | tr -d ' ') == 89504e470d0a1a0a ]] || fail "$1" "$2 is no PNG"
}
good 'help' 0 picture --help
expect 'help' "$out" '--view-depth'
good 'cullide' 0 picture two-spheres --method cullide --resolution 64 "${small[@]}" -o cullide.png
is_png 'cullide' cullide.png
expect 'cullide' "$out" '^cullide at 64 px: missed [1-9][0-9,]* of [0-9,]+ colliding pairs$'
expect 'cullide' "$out" '^The picture is in cullide.png$'
good 'compare' 0 picture two-spheres --compare cullide:32,far:64,exact "${small[@]}" -o old.png
is_png 'compare' old.png
expect 'compare' "$out" '^far at 64 px: missed 0 of '
expect 'compare' "$out" '^exact: missed 0 of '
expect 'provenance' old.png 'Scene hash'
good 'standard output' 0 picture crossing.obj --method exact --self "${small[@]}" -o -
is_png 'standard output' "$out"
good 'a view of the method' 0 picture two-spheres --method far --resolution 32 --view-depth=-x "${small[@]}" -o v.png
expect 'a view of the method' "$out" '^far at 32 px, along -x: this view loses 0 of '
if "$program" picture two-spheres --method exact "${small[@]}" --html page.html 2>&1 | grep -q 'three.js'; then
  bad 'a page without three.js' '--html: .*libjs-three' picture two-spheres --method exact --html new.html
else
  bad 'too many objects for a page' '--html: .*70,000 objects.*65,536' picture crowd:70000 --html new.html
  good 'a page' 0 picture two-spheres --compare cullide,exact --resolutions 32,64 "${small[@]}" --html page.html
  expect 'a page' "$out" '^cullide at 32 px: missed [1-9]'
  expect 'a page' "$out" '^exact: missed 0 of '
  expect 'a page' "$out" '^The page is in page.html .[0-9.]* MB.$'
  expect 'a page' page.html '^<!DOCTYPE html>'
  expect 'a page' page.html 'three.js'
fi
good 'a single mesh' 0 picture crossing.obj --method far-pairs --self --device cpu --view -z --up x \
  "${small[@]}" -o s.png
expect 'a single mesh' "$out" '^far-pairs: missed 0 of '
good 'a frame' 0 picture two-spheres --method exact --frame 3 --frames 10 "${small[@]}" -o f.png
good 'a ground a thousand times larger' 0 picture two-spheres@ground --method exact --zoom \
  "${small[@]}" -o g.png
to=closed
bad 'standard output closed' 'standard output: ' picture two-spheres --method exact -o -
to=broken
bad 'standard output that nobody reads' 'standard output: ' picture two-spheres --method exact -o -
to=$out
settings=(__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere)
bad 'no driver' 'EGL: ' picture two-spheres --method exact -o new.png
settings=()

if ((failed)); then
  echo "cli_picture_test: $failed of $cases cases failed"
  exit 1
fi
echo "cli_picture_test: $cases cases, none failed"
