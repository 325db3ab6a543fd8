#!/usr/bin/env bash
# The real program against every bad input that a user may give it, and the good cases beside.
#   tests/experiments/command/cli_test.sh FARCULL_BINARY
# A bad input has to end within seconds with status 2, one line on stderr that names the place and
# says what to do (after a semicolon), nothing on stdout, nothing left in the folder, and within an
# address space too small for what its header claims. Prints each failing case and a count; status
# 1 if any failed. Needs bash, Debian's essential tools and a software device of Mesa.
set -uo pipefail

if [[ $# -ne 1 || ! -x $1 ]]; then
  echo "usage: cli_test.sh FARCULL_BINARY" >&2
  exit 2
fi
program=$(realpath -- "$1")
test_file=$(realpath -- "${BASH_SOURCE[0]}")
work=$(mktemp -d) || exit 2
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT

# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

echo older >old.json
formats=(obj off ply stl json)

# --- files -------------------------------------------------------------------------------------

mkdir folder
for format in "${formats[@]}"; do
  bad_scene "missing $format" "missing\.$format: the file does not exist" "missing.$format"
  : >"empty.$format"
  bad_scene "empty $format" "empty\.$format: the file is empty" "empty.$format"
  mkdir "folder.$format"
  bad_scene "folder $format" "folder\.$format: is a directory" "folder.$format"
  garbage >"garbage.$format"
  bad_scene "garbage $format" "garbage\.$format(:[0-9]+)?: " "garbage.$format"
  mkfifo "pipe.$format"
  bad_scene "pipe $format" "pipe\.$format: is not a regular file" "pipe.$format"
done
bad_scene 'folder as scene' 'folder: ' folder
obj 'f 1 2 3' >no_extension
bad_scene 'no extension' 'no_extension: ' no_extension
bad_scene 'other extension' 'mesh\.3ds: ' mesh.3ds
bad_scene 'two lines in a name' 'a\?b\.obj: ' $'a\nb.obj'
if (($(id -u) != 0)); then
  obj 'f 1 2 3' >secret.obj
  chmod 0 secret.obj
  bad_scene 'unreadable' 'secret\.obj: cannot be opened' secret.obj
else
  echo 'note: root may read everything, so an unreadable file was not tried'
fi

# Truncated.
printf 'v 0 0 0\nv 1 0' >truncated.obj
bad_scene 'truncated obj' 'truncated\.obj:2: ' truncated.obj
obj >no_face.obj
bad_scene 'obj without a face' 'no_face\.obj: ' no_face.obj
printf 'OFF\n4 1 0\n0 0 0\n1 0 0\n' >truncated.off
bad_scene 'truncated off' 'truncated\.off(:[0-9]+)?: ' truncated.off
off 2 '3 0 1 2' >one_face.off
bad_scene 'off with a face too few' 'one_face\.off(:[0-9]+)?: ' one_face.off
printf 'OFF\n4' >header.off
bad_scene 'truncated off header' 'header\.off:2: ' header.off
ply 2 '3 0 1 2' >truncated.ply
bad_scene 'truncated ply' 'truncated\.ply(:[0-9]+)?: ' truncated.ply
ply 1 '3 0 1 2' | head -c 60 >header.ply
bad_scene 'truncated ply header' 'header\.ply(:[0-9]+)?: ' header.ply
ply_binary 0 | head -c -3 >truncated_binary.ply
bad_scene 'truncated binary ply' 'truncated_binary\.ply: ' truncated_binary.ply
stl '0 0 0' '1 0 0' '0 1 0' | head -n 5 >truncated.stl
bad_scene 'truncated stl' 'truncated\.stl(:[0-9]+)?: ' truncated.stl
stl_binary 1 0 | head -c -3 >truncated_binary.stl
bad_scene 'truncated binary stl' 'truncated_binary\.stl: ' truncated_binary.stl
printf '{"objects": [\n{"mesh":' >truncated.json
bad_scene 'truncated scene file' 'truncated\.json:2: ' truncated.json

# A header that promises a billion.
printf 'OFF\n%d 1 0\n0 0 0\n' "$billion" >billion_vertices.off
bad_scene 'off of a billion vertices' 'billion_vertices\.off(:[0-9]+)?: ' billion_vertices.off
off "$billion" '3 0 1 2' >billion_faces.off
bad_scene 'off of a billion faces' 'billion_faces\.off(:[0-9]+)?: ' billion_faces.off
off 1 "$billion 0 1 2" >billion_corners.off
bad_scene 'off with a billion corners' 'billion_corners\.off:7: ' billion_corners.off
for kind in ascii binary_little_endian binary_big_endian; do
  ply_header "$kind" "$billion" 1 >billion_vertices.ply
  bad_scene "$kind ply of a billion vertices" 'billion_vertices\.ply(:[0-9]+)?: ' \
    billion_vertices.ply
  ply_header "$kind" 0 "$billion" >billion_faces.ply
  bad_scene "$kind ply of a billion faces" 'billion_faces\.ply(:[0-9]+)?: ' billion_faces.ply
done
{
  ply_header binary_little_endian 3 1 | sed 's/list uchar/list uint/'
  le32s 0 0 0 "$one" 0 0 0 "$one" 0 "$billion" 0 1 2
} >billion_corners.ply
bad_scene 'binary ply with a billion corners' 'billion_corners\.ply: ' billion_corners.ply
stl_binary "$billion" 0 >billion.stl
bad_scene 'stl of a billion triangles' 'billion\.stl: ' billion.stl

# Numbers that are no coordinates.
for number in nan NaN inf -inf infinity 1e999 -1e999; do
  obj "v 0 $number 0" 'f 1 2 5' >number.obj
  bad_scene "obj with $number" 'number\.obj:5: ' number.obj
  off 1 '3 0 1 2' | sed "5s/.*/0 $number 0/" >number.off
  bad_scene "off with $number" 'number\.off:5: ' number.off
  ply 1 '3 0 1 2' | sed "10s/.*/0 $number 0/" >number.ply
  bad_scene "ply with $number" 'number\.ply:10: ' number.ply
  stl "0 $number 0" '1 0 0' '0 1 0' >number.stl
  bad_scene "stl with $number" 'number\.stl:4: ' number.stl
  printf '{"objects": [{"mesh": "good.obj", "translate": [0, %s, 0]}]}' "$number" >number.json
  bad_scene "scene file with $number" 'number\.json:1: ' number.json
done
for word in "$nan" "$infinity" $((infinity | 1 << 31)); do
  ply_binary "$word" >number.ply
  bad_scene "binary ply with $word" 'number\.ply: ' number.ply
  stl_binary 1 "$word" >number.stl
  bad_scene "binary stl with $word" 'number\.stl: ' number.stl
done

# Indices and polygons.
for face in '1 2 5' '0 1 2' '1 2 -5' '1 2 99999999999999999999' '1 2 4294967297' '1 2 x' '1 2'; do
  obj "f $face" >face.obj
  bad_scene "obj with f $face" 'face\.obj:5: ' face.obj
done
for face in '3 0 1 4' '3 0 1 -1' '3 0 1 99999999999999999999' '3 0 1 4294967296' '2 0 1' '0 0 0 0' \
  '-1 0 1 2' '3 0 1'; do
  off 1 "$face" >face.off
  bad_scene "off with face $face" 'face\.off:7: ' face.off
  ply 1 "$face" >face.ply
  bad_scene "ply with face $face" 'face\.ply:14: ' face.ply
done
{
  ply_header binary_little_endian 3 1
  le32s 0 0 0 "$one" 0 0 0 "$one" 0
  printf '\x03'
  le32s 0 1 3
} >index.ply
bad_scene 'binary ply with an index out of range' 'index\.ply: ' index.ply
{
  ply_header binary_little_endian 3 1
  le32s 0 0 0 "$one" 0 0 0 "$one" 0
  printf '\x02'
  le32s 0 1
} >polygon.ply
bad_scene 'binary ply with two corners' 'polygon\.ply: ' polygon.ply
stl '0 0 0' '1 0 0' >polygon.stl
bad_scene 'stl with two corners' 'polygon\.stl:6: ' polygon.stl

# Scene files. Each line: what the message has to say after the file, a tab, the text.
obj 'f 1 2 3' 'f 1 2 4' 'f 1 3 4' 'f 2 3 4' >good.obj
while IFS=$'\t' read -r pattern text; do
  printf '%s\n' "$text" >bad.json
  bad_scene "scene file $text" "bad\.json$pattern" bad.json
done <<'END'
: .*objects	{}
: .*objects	{"objects": []}
: .*objects	{"objects": 7}
: .*objects	{"objects": {"mesh": "good.obj"}}
: surprise 	{"objects": [{"mesh": "good.obj"}], "surprise": 1}
: objects\[0\]\.meshes 	{"objects": [{"meshes": "good.obj"}]}
: objects\[0\]	{"objects": [7]}
: objects\[0\]	{"objects": [{"name": "a"}]}
: objects\[0\]\.mesh	{"objects": [{"mesh": 7}]}
: objects\[0\]\.name	{"objects": [{"mesh": "good.obj", "name": 7}]}
: objects\[0\]\.scale	{"objects": [{"mesh": "good.obj", "scale": "big"}]}
: objects\[0\]\.scale	{"objects": [{"mesh": "good.obj", "scale": 0}]}
: objects\[1\]\.translate	{"objects": [{"mesh": "good.obj"}, {"mesh": "good.obj", "translate": [1, 2]}]}
: objects\[0\]\.rotate	{"objects": [{"mesh": "good.obj", "rotate": [0, 0, 1, 0.5]}]}
: objects\[0\]\.rotate\.axis	{"objects": [{"mesh": "good.obj", "rotate": {"axis": [0, 0, 0], "angle": 1}}]}
: objects\[0\]\.split	{"objects": [{"mesh": "good.obj", "split": "halves"}]}
: .*'mesh'	{"objects": [{"mesh": "good.obj", "mesh": "good.obj"}]}
: 	[]
: 	7
:1: 	{"objects": [{"mesh": "good.obj",}]}
:1: 	{"objects": [{"mesh": "good.obj"}]} more
END
printf '{"objects":\n[{"mesh": "missing.obj"}]}' >nested.json
bad_scene 'scene file with a missing mesh' '.*missing\.obj: the file does not exist' nested.json
bad_scene 'a name in braces' 'x[{]left[}]\.obj: the file does not exist' 'x{left}.obj'
printf '{"objects":\n[{"mesh": "face.obj"}]}' >nested.json
bad_scene 'scene file with a bad mesh' '.*face\.obj:5: ' nested.json
printf '{"objects": [{"mesh": "nested.json"}]}' >nested.json
bad_scene 'scene file that names itself' '.*nested\.json: ' nested.json
printf '[%.0s' {1..200000} >deep.json
bad_scene 'scene file of 200000 brackets' 'deep\.json:1: ' deep.json

# --- the command line --------------------------------------------------------------------------

spheres=(two-spheres --device software --resolution 64 --method far)
cullide=(two-spheres --device software --resolution 64 --method cullide)
bad 'unknown command' 'frob: ' frob
bad 'unknown option of the program' '--frob: ' --frob
for command in run verify compare; do
  bad "$command without a scene" 'SCENE: ' "$command"
  bad "$command with an empty name" 'SCENE: ' "$command" ''
  bad "$command with an unknown scene" 'nope: ' "$command" nope
  bad "$command with an unknown suffix" 'two-spheres@nope: ' "$command" two-spheres@nope
  bad "$command with two scenes" 'two-tori: ' "$command" two-tori two-spheres
  bad "$command with a scene and a mesh" 'two-tori: ' "$command" good.obj two-tori
  bad "$command with an unknown option" '--frob: ' "$command" two-spheres --frob
  bad "$command with an unknown device" '--device: ' "$command" two-spheres --device nope
  bad "$command with an empty device" '--device: ' "$command" two-spheres --device ''
  bad "$command with device 99" '--device: ' "$command" two-spheres --device 99
  bad "$command with device -1" '--device: ' "$command" two-spheres --device -1
  for views in q 'x,' '' x,x 0:0:0 1:1 nan:1:1 1e999:0:0 1e-400:0:1 x:y:z; do
    bad "$command --views '$views'" '--views: ' "$command" two-spheres --views "$views"
  done
  for option in --views --device --json; do
    bad "$command $option without a value" "$option: " "$command" two-spheres "$option"
    bad "$command $option twice" "$option: " "$command" two-spheres "$option" x "$option" y
  done
done
bad 'a command among scenes' 'two-spheres: ' run two-spheres verify
for number in 0 -5 abc 1e99 1.5 '' 99999999999999999999 2147483648 ' 7' 7px 0x40; do
  bad "run --resolution '$number'" '--resolution: ' run two-spheres --resolution "$number"
  bad "compare --resolutions '64,$number'" '--resolutions: ' compare two-spheres \
    --resolutions "64,$number"
  bad "compare --repeat '$number'" '--repeat: ' compare two-spheres --resolutions 64 \
    --repeat "${number/2147483648/0}"
done
bad 'resolution beyond the device' '--resolution: .*limit of this device' run two-spheres \
  --method far --device software --resolution 2147483647 --json new.json
bad 'compared resolution beyond the device' '--resolutions: .*limit of this device' \
  compare two-spheres --methods far --device software --resolutions 64,2147483647 --json new.json
pairs=(two-spheres --method far-pairs)
for radius in -1 -1e-9 nan inf 1e999 4.8e38 100001 big '' 1x; do
  bad "radius '$radius'" '--radius: ' run two-spheres --method far --radius "$radius"
done
for option in --method --offset --depth --depth-format --query; do
  far=(two-spheres --method far)
  [[ $option == --method ]] && far=(two-spheres)
  bad "$option unknown" "$option: 'nope'" run "${far[@]}" "$option" nope
  bad "$option empty" "$option: ''" run "${far[@]}" "$option" ''
  bad "$option without a value" "$option: " run "${far[@]}" "$option"
  bad "$option twice" "$option: " verify two-spheres "$option" far "$option" far
done
bad 'compare with an unknown method' '--methods: ' compare two-spheres --methods far,nope
bad 'flags with 24 bits' '--query: ' run two-spheres --method far --query flags \
  --depth-format 24
bad 'fragment depth with cullide' '--depth: ' run two-spheres --method cullide --depth fragment
bad 'radius with cullide' '--radius: ' run two-spheres --method cullide --radius 0.5
bad 'depth with exact' '--depth: ' run two-spheres --method exact --depth fixed
bad 'a value for a flag' '--no-verify: ' run two-spheres --no-verify=7
bad 'verify without verifying' '--no-verify: ' verify two-spheres --no-verify
bad 'scenes with an argument' 'extra: no built-in scene' scenes extra
bad 'scenes with two arguments' 'far-apart: ' scenes two-tori far-apart --write new
bad 'a scene that is not written' 'two-spheres: .*--write' scenes two-spheres
bad 'writing no scene' '--write: ' scenes --write new
# Names as long as the system takes, though a part of the file is written under another name.
printf -v name 'n%.0s' {1..255}
printf -v wide '\xc3\xa4%.0s' {1..127}
bad 'a name that is too long' 'n+: cannot be written: File name too long' run "${spheres[@]}" --json "n$name"
printf -v deep './%.0s' {1..2045}
bad 'a path that is too long' '[./]+x: cannot be written: File name too long' run "${spheres[@]}" --json "${deep}x"
for long in "$name" "$wide"; do
  good 'a long name' 0 run "${spheres[@]}" --json "$long" --pairs "${long/?/p}"
  expect 'a long name' "$long" '"colliding_pairs"'
  rm -f -- "$long" "${long/?/p}"
done
bad 'writing to no folder' '--write: ' scenes two-spheres --write ''
bad 'writing into a missing folder' 'missing/new: the folder cannot be made: No such' \
  scenes far-apart --write missing/new
bad 'writing into a file' 'good\.obj: the folder cannot be made' scenes far-apart --write good.obj
bad 'a suite of no size' '--size: ' suite new --size large
bad 'a suite into a folder with files' '\.: is there already' suite .
bad 'a suite with a seed that is none' '--seed: ' suite new --seed one
bad 'a suite that is not there' 'new/suite\.txt: ' suite new --check
bad 'a suite that is checked for a seed' '--check: ' suite new --check --seed 2
bad 'writing frames of a list' '--frames: ' scenes --frames 3
bad 'writing frames of what stands still' 'two-tori: nothing .*moves' \
  scenes two-tori --write new --frames 3
bad 'writing no frames' '--frames: ' scenes crowd --write new --frames 0
bad 'writing and the list' '--json: ' scenes far-apart --write new --json -
for name in crowd:1 crowd:400:nan crowd:400:0.2:1 crowd::1 field:1e6 two-tori:5 shells:10:1; do
  bad "the numbers of $name" "$name: " run "$name"
done
bad 'doctor with an argument' 'extra: ' doctor extra
bad 'doctor with an unknown device' '--device: ' doctor --device nope
bad 'doctor with device 99' '--device: ' doctor --device 99

# Without arguments: the help, and then the message.
((cases += 1))
launch
if ((status != 2)) || [[ -s $out ]]; then
  fail 'no argument' "status $status or something on stdout"
elif ! grep -q '^Usage: farcull' "$err" ||
  ! grep -q '^farcull: COMMAND: .*; ' <<<"$(tail -n 1 "$err")"; then
  fail 'no argument' 'no help or no message on stderr'
fi

# --- outputs -----------------------------------------------------------------------------------

for option in --json --pairs; do
  bad "$option in a missing folder" 'missing/new: cannot be written' run "${spheres[@]}" \
    "$option" missing/new
  bad "$option below a file" 'good\.obj/new: cannot be written' run "${spheres[@]}" \
    "$option" good.obj/new
  bad "$option is a folder" 'folder: cannot be written' run "${spheres[@]}" "$option" folder
  bad "$option on a full disk" '/dev/full: cannot be written' run "${spheres[@]}" \
    "$option" /dev/full
  bad "$option empty" "$option: the path is empty" run "${spheres[@]}" "$option" ''
  bad "$option over a mesh" "$option: good\.obj" run "$option" good.obj good.obj
  bad "$option before an option" "$option: " run "${spheres[@]}" "$option" --no-verify
done
bad 'both outputs in one place' '--pairs: ' run "${spheres[@]}" --json new --pairs new
bad 'both outputs on stdout' '--pairs: ' run "${spheres[@]}" --json - --pairs -
for command in 'compare two-spheres --resolutions 64 --device software' scenes doctor; do
  # shellcheck disable=SC2086 # several words
  bad "${command%% *} --json in a missing folder" 'missing/new: cannot be written' $command \
    --json missing/new
done
if (($(id -u) != 0)); then
  chmod a-w folder
  bad 'a folder without permission' 'folder/new: cannot be written: Permission' \
    run "${spheres[@]}" --json folder/new
else
  echo 'note: root may write everywhere, so a folder without permission was not tried'
fi

# A disk that fills in the middle, for once with a real file: files end at 1 KiB.
((cases += 1))
before=$(snapshot)
(ulimit -f 1 && timeout "$seconds" "$program" run "${spheres[@]}" --json old.json >"$out" 2>"$err")
status=$?
refused 'a file that grows too large' 'old\.json: cannot be written: File too large'
[[ $before == "$(snapshot)" ]] || fail 'a file that grows too large' 'the folder changed'

((cases += 1))
(ulimit -f 1 && timeout "$seconds" "$program" scenes far-apart --write new >"$out" 2>"$err")
status=$?
refused 'a mesh that grows too large' 'new/first\.off: cannot be written: File too large'
[[ $before == "$(snapshot)" ]] || fail 'a mesh that grows too large' 'the folder changed'

to=/dev/full
bad 'table on a full disk' 'standard output: cannot be written' run "${spheres[@]}"
bad 'JSON on a full disk' 'standard output: cannot be written' run "${spheres[@]}" --json -
bad 'scenes on a full disk' 'standard output: cannot be written' scenes
bad 'help on a full disk' 'standard output: cannot be written' run --help
to=closed
bad 'table on a closed stdout' 'standard output: cannot be written' run "${spheres[@]}"
bad 'JSON on a closed stdout' 'standard output: cannot be written' run "${spheres[@]}" --json -
bad 'compare on a closed stdout' 'standard output: cannot be written' compare two-spheres \
  --resolutions 64
bad 'scenes on a closed stdout' 'standard output: cannot be written' scenes
bad 'version on a closed stdout' 'standard output: cannot be written' --version
to=broken
bad 'table into a broken pipe' 'standard output: cannot be written: Broken pipe' run "${spheres[@]}"
bad 'JSON into a broken pipe' 'standard output: cannot be written: Broken pipe' run \
  "${spheres[@]}" --json -
to=$out

# A table that cannot be shown takes no file with it.
((cases += 1))
to=broken launch run "${spheres[@]}" --json new.json
refused 'JSON file beside a broken pipe' 'standard output: '
[[ $(tail -n 1 new.json) == '}' ]] || fail 'JSON file beside a broken pipe' 'new.json is not whole'
rm -f new.json

# --- devices -----------------------------------------------------------------------------------

mkdir no_vendors broken_egl
echo 'not a library' >broken_egl/libEGL.so.1
for command in run verify compare doctor; do
  arguments=("$command")
  [[ $command == doctor ]] || arguments+=(two-spheres --device gl --json old.json)
  far=()
  [[ $command == run || $command == verify ]] && far=(--method far)
  arguments+=("${far[@]}")
  settings=(__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent)
  bad "$command without an EGL vendor" 'EGL: ' "${arguments[@]}"
  settings=("__EGL_VENDOR_LIBRARY_DIRS=$PWD/no_vendors")
  bad "$command without EGL vendors in the folder" 'EGL: ' "${arguments[@]}"
  settings=("LD_LIBRARY_PATH=$PWD/broken_egl")
  bad "$command without libEGL" 'EGL: libEGL\.so\.1 cannot be loaded' "${arguments[@]}"
  settings=(GALLIUM_DRIVER=nonsense)
  [[ $command == doctor ]] || arguments=("$command" two-spheres "${far[@]}" --json old.json)
  bad "$command without a driver" 'EGL: ' "${arguments[@]}" --device software
  settings=(MESA_GL_VERSION_OVERRIDE=3.3 MESA_GLSL_VERSION_OVERRIDE=330)
  bad "$command with OpenGL 3.3" 'EGL: .*older than 4\.3' "${arguments[@]}" --device software
done
settings=()
# What draws nothing needs no device.
settings=(__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent)
good 'far apart without EGL' 0 run far-apart
good 'exact without EGL' 0 run two-spheres --method exact
# What draws does so on the cores of the CPU where no device was asked for, and says why.
good 'far without EGL' 0 verify two-spheres --method far --resolution 64 --json -
expect 'far without EGL' "$out" '^    "cpu": "no --device: GL where hardware answers, else the CPU; EGL'
expect 'far without EGL' "$out" '^    "lanes": "[A-Za-z0-9_]+",$'
settings=("LD_LIBRARY_PATH=$PWD/broken_egl")
good 'cullide without libEGL' 0 run two-spheres --method cullide --resolution 64
expect 'cullide without libEGL' "$out" '^device     cpu, lanes of .*: no --device: '
settings=()

# --- the native canvas -------------------------------------------------------------------------

native=(two-spheres --method far --resolution 64)
for device in native cpu; do
  good "far on $device" 0 verify "${native[@]}" --device "$device" --json -
  expect "far on $device" "$out" "^    \"cpu\": \"--device $device\",\$"
  expect "far on $device" "$out" '^    "depth_bits": 32$'
done
good 'far on native as the default' 0 run "${native[@]}" --pairs -
cp "$out" default.csv
for options in '--device native' '--device native --query occlusion' '--device native --depth-format 24'; do
  # shellcheck disable=SC2086 # several words
  good "far, $options" 0 run "${native[@]}" $options --pairs -
  ((cases += 1))
  cmp -s "$out" default.csv || fail "far, $options" 'other pairs'
done
good '24 bits on native' 0 run "${native[@]}" --device native --depth-format 24
expect '24 bits on native' "$out" '^device     cpu, lanes of .*, 24 depth bits: --device native$'
good 'occlusion on native' 0 run "${native[@]}" --device native --query occlusion --json -
expect 'occlusion on native' "$out" '^  "query": null,$'
good 'occlusion on GL' 0 run "${native[@]}" --device software --query occlusion --json -
expect 'occlusion on GL' "$out" '^  "query": "occlusion",$'
rm default.csv

# --- interrupts --------------------------------------------------------------------------------

# interrupted SECONDS SIGNAL: a run that is ended then leaves whole files or none.
interrupted=0
for signal in INT TERM HUP; do
  for delay in 0.02 0.1 0.2; do
    ((cases += 1))
    before=$(snapshot)
    timeout -s "$signal" "$delay" "$program" run random-soup --method far --device software --json new.json \
      --pairs new.csv >"$out" 2>"$err"
    status=$?
    case $status in
      0) ;;
      124) ((interrupted += 1)) ;;
      *) fail "$signal after $delay s" "status $status" ;;
    esac
    for file in new.json new.csv; do
      [[ ! -e $file || $(tail -c 2 "$file") == *[0-9\}] ]] ||
        fail "$signal after $delay s" "$file is not whole"
      rm -f "$file"
    done
    [[ $before == "$(snapshot)" ]] || fail "$signal after $delay s" 'something is left'
  done
done
((cases += 1))
((interrupted > 0)) || fail interrupts 'every run was done before its signal'

# whole_frames CASE FILE.json FILE.csv: what is left of frames that were ended is whole.
whole_frames() {
  local frames
  frames=$(grep -c '^      "frame": ' "$2")
  grep -q "^    \"frames\": $frames,\$" "$2" || fail "$1" "the summary is not of $frames frames"
  [[ $(tail -n 1 "$2") == '}' ]] || fail "$1" "$2 is not whole"
  grep -vqE '^(frame,|[0-9]+,[0-9]+,[0-9]+,[0-9]+,[0-9]+$)' "$3" && fail "$1" "$3 is not whole"
}

# Frames say how far they came, and what they gave stays. A kill says nothing.
for signal in INT TERM HUP KILL; do
  ((cases += 1))
  before=$(snapshot)
  # The shell has those that it starts in the background ignore SIGINT.
  env --default-signal=INT "$program" run two-spheres --method far-pairs --device cpu \
    --frames 1000000 --json new.json --pairs new.csv >"$out" 2>"$err" &
  child=$!
  for ((i = 0; i < 200; ++i)); do
    [[ -e new.csv && $(wc -l <"$out") -gt 8 ]] && break
    sleep 0.05
  done
  kill -"$signal" "$child"
  wait "$child" 2>/dev/null
  if [[ $signal != KILL ]]; then
    grep -qE '^farcull: interrupted: after [0-9]+ of 1000000 frames; what they gave is written$' \
      "$err" || fail "$signal among frames" 'it does not say how far it came'
  fi
  whole_frames "$signal among frames" new.json new.csv
  expect "$signal among frames" "$out" '^ +1 '
  rm -f new.json new.csv
  [[ $before == "$(snapshot)" ]] || fail "$signal among frames" 'something else is left'
done

# In the middle of a large file: 800 x 800 triangles that all cross give 640,000 lines.
{
  for i in {1..800}; do printf 'v 0 0 %d.5\nv 1 0 %d.5\nv 0 1 %d.5\n' "$i" "$i" "$i"; done
  for i in {1..800}; do printf 'f %d %d %d\n' $((3 * i - 2)) $((3 * i - 1)) $((3 * i)); done
} >sheets.obj
{
  for i in {1..800}; do
    printf 'v 0.0%03d 0.1 0\nv 0.0%03d 0.1 900\nv 0.0%03d 0.3 400\n' "$i" "$i" "$i"
  done
  for i in {1..800}; do printf 'f %d %d %d\n' $((3 * i - 2)) $((3 * i - 1)) $((3 * i)); done
} >blades.obj
((cases += 1))
before=$(snapshot)
"$program" run sheets.obj blades.obj --method exact --no-verify --pairs pairs.csv >"$out" 2>"$err" &
run=$!
part=
while [[ -z $part ]] && kill -0 "$run" 2>/dev/null; do part=$(compgen -G 'pairs.csv.part-*'); done
kill -TERM "$run" 2>/dev/null
wait "$run" 2>/dev/null
status=$?
if [[ -z $part ]]; then
  echo 'note: the large file was written too fast to be interrupted'
elif ((status == 143)) && [[ -e pairs.csv || $(compgen -G 'pairs.csv*') ]]; then
  fail 'interrupt while writing' 'a file is left'
elif ((status != 143 && status != 0)); then
  fail 'interrupt while writing' "status $status"
fi
rm -f pairs.csv

# --- good cases --------------------------------------------------------------------------------

for command in run verify compare scenes doctor; do
  good "$command --help" 0 "$command" --help
  expect "$command --help" "$out" '^Examples:'
  expect "$command --help" "$out" "^  farcull $command"
done
good '--help' 0 --help
expect '--help' "$out" '^  farcull run'
good '--version' 0 --version
good 'help' 0 help
expect 'help' "$out" '^  farcull help terms '
cp "$out" help.txt
good '--help' 0 --help
((cases += 1))
cmp -s "$out" help.txt || fail 'help' 'it is not --help'
good 'help run' 0 help run
cp "$out" help.txt
good 'run --help' 0 run --help
((cases += 1))
cmp -s "$out" help.txt || fail 'help run' 'it is not run --help'
good 'help experiment accuracy' 0 help experiment accuracy
cp "$out" help.txt
good 'experiment accuracy --help' 0 experiment accuracy --help
((cases += 1))
cmp -s "$out" help.txt || fail 'help experiment accuracy' 'it is not experiment accuracy --help'
rm help.txt
for topic in methods pairs scene-file terms; do
  good "help $topic" 0 help "$topic"
  ((cases += 1))
  cmp -s "$out" "$(dirname -- "$test_file")/../../../docs/help/$topic.txt" ||
    fail "help $topic" 'it is not docs/help'
done
bad 'help of nothing known' 'nope: no such .*terms' help nope
bad 'help of two topics' 'terms pairs: no such ' help terms pairs
good scenes 0 scenes
expect scenes "$out" '^two-spheres '
good 'scenes as JSON' 0 scenes --json -
expect 'scenes as JSON' "$out" '"name": "two-spheres"'
good 'a scene as meshes' 0 scenes crowd:5:2@far --write crowd
expect 'a scene as meshes' "$out" '^farcull run crowd/scene\.json$'
good 'a scene as meshes again' 0 scenes crowd:5:2@far --write crowd
for scene in crowd:5:2@far crowd/scene.json; do
  good "$scene" 0 run "$scene" --method exact --json "${scene%%[:/]*}.json"
  grep '"hash"' crowd.json >"hash-${scene##*[@.]}"
done
cmp -s hash-far hash-json || fail 'a scene as meshes' 'it is another one when it is read'
good 'frames as meshes' 0 scenes cylinders:2@ground --write tubes --frames 9:11
good 'frames of these meshes' 0 verify tubes/scene.json --method far-pairs --frames 9:11 --json tubes.json
good 'the same frames, built in' 0 verify cylinders:2@ground --method far-pairs --frames 9:11 \
  --json built.json
cmp -s <(grep '"hash"' tubes.json) <(grep '"hash"' built.json) ||
  fail 'frames as meshes' 'they are others when they are read'
rm -r crowd tubes crowd.json tubes.json built.json hash-*

good 'run' 0 run "${spheres[@]}"
expect 'run' "$out" '^two-spheres: 2 objects, 10,240 triangles$'
expect 'run' "$out" ' \+ 0 missed$'
good 'cullide misses' 0 run "${cullide[@]}"
expect 'cullide misses' "$out" ' \+ [1-9][0-9,]* missed$'
good 'verify' 0 verify "${spheres[@]}"
verified='^verified: no colliding pair was culled, 26,214,400 pairs accounted for$'
expect 'verify' <(tail -n 3 "$out" | head -n 1) "$verified"
expect 'verify' <(tail -n 2 "$out") '^accounted  26,214,400 pairs = '
good 'verify cullide' 1 verify "${cullide[@]}"
expect 'verify cullide' "$err" '^farcull: cullide at 64 px '
expect 'verify cullide' "$out" \
  '^NOT verified: [1-9][0-9,]* colliding pairs were culled, 26,214,400 pairs accounted for$'
((cases += 1))
grep -qE "$verified" "$out" && fail 'verify cullide' 'it is verified'
good 'verify frames' 0 verify two-spheres --frames 2
expect 'verify frames' <(tail -n 3 "$out") \
  '^verified: no colliding pair was culled, 52,428,800 pairs accounted for$'
expect 'verify frames' <(tail -n 2 "$out") '^accounted  52,428,800 pairs = '

# Colours are for terminals alone, and not where NO_COLOR is set.
escape=$'\033'
shown() { # FILE VARIABLE=VALUE... -- ARGUMENTS...: the answer on a terminal of its own
  local variables=()
  while [[ $2 != -- ]]; do variables+=("$2") && set -- "$1" "${@:3}"; done
  script -qec "env ${variables[*]} '$program' ${*:3}" /dev/null >"$1" 2>&1 </dev/null
}
((cases += 4))
shown shown.txt -u NO_COLOR TERM=xterm -- verify two-spheres
grep -qF "$escape[1;32mverified: " shown.txt || fail 'colour' 'the verdict is not green'
shown shown.txt -u NO_COLOR TERM=xterm -- verify "${cullide[@]}"
grep -qF "$escape[1;31mNOT verified: " shown.txt || fail 'colour' 'the verdict is not red'
grep -qF "$escape[1;31mfarcull: cullide at" shown.txt || fail 'colour' 'the message is not red'
shown shown.txt NO_COLOR=1 TERM=xterm -- verify two-spheres
grep -q '^verified: ' shown.txt || fail 'NO_COLOR' 'no plain verdict'
rm shown.txt
settings=(TERM=xterm)
good 'a pipe' 0 verify two-spheres
settings=()
expect 'a pipe' "$out" "$verified"
good 'negative direction' 0 run "${spheres[@]}" --views -y,x
good 'compare' 0 compare two-spheres --device software --resolutions 32,64 --json compare.json
expect 'compare' "$out" '^cullide +- +64 '
expect 'compare' "$out" '^exact +- '
expect 'compare' compare.json '^  "runs": \['

# The JSON has every key, stands alone on stdout, and is JSON: farcull's own reader of scene files
# refuses it for its keys and not, with a line, for its syntax.
good 'JSON' 0 run "${spheres[@]}" --json -
cp "$out" record.json
expect 'JSON starts stdout' <(head -n 1 record.json) '^\{$'
expect 'JSON ends stdout' <(tail -n 1 record.json) '^\}$'
for key in scene name objects triangles degenerate_triangles hash method resolution views budget \
  sampling input double vertex snap offset radius_px device vendor renderer version subpixel_bits \
  depth_bits stages ran reason ms in out pcs candidate_pairs colliding_pairs verification \
  pairs_total pairs_kept certified_by_boxes certified_by_predicates neighbours false_negatives \
  examples time_ms setup cull exact total seed commit; do
  expect "JSON key $key" record.json "^ *\"$key\": "
done
expect 'JSON seed of a scene without' record.json '^  "seed": null,'
for file in record.json compare.json; do
  bad "$file is JSON" "$file: .*key" run "$file"
done
good 'JSON of a random scene' 0 run random-soup --method exact --json -
expect 'JSON of a random scene' "$out" '^  "seed": [0-9]+,'

# Every format, an older file that is replaced, a link that stays a link.
off 2 '3 0 1 2' '4 0 1 2 3' >good.off
ply 1 '3 0 1 2' >good.ply
ply_binary 0 >good_binary.ply
stl '0 0 0' '1 0 0' '0 1 0' >good.stl
stl_binary 1 0 >good_binary.stl
for mesh in good.off good.ply good_binary.ply good.stl good_binary.stl; do
  good "$mesh" 0 run good.obj "$mesh" --method far --device software --resolution 64 --pairs pairs.csv \
    --json old.json
  expect "pairs of $mesh" <(head -n 1 pairs.csv) '^object_a,triangle_a,object_b,triangle_b$'
  expect "pairs of $mesh" pairs.csv '^0,[0-9]+,1,[0-9]+$'
  expect "JSON of $mesh" old.json "^  \"colliding_pairs\": $(($(wc -l <pairs.csv) - 1)),$"
  expect "JSON of $mesh" old.json '^  "seed": null,'
  rm pairs.csv
  echo older >old.json
done
printf '{"name": "s", "objects": [{"mesh": "good.obj"}, {"mesh": "good.off", "scale": 2}]}' \
  >good.json
ln -s old.json link.json
good 'scene file' 0 run good.json --method far --device software --resolution 64 --json link.json
expect 'scene file' old.json '"name": "s",'
((cases += 1))
[[ -L link.json ]] || fail 'JSON through a link' 'the link was replaced'
good 'JSON to /dev/stdout' 0 run good.json --method far --device software --resolution 64 --json /dev/stdout
expect 'JSON to /dev/stdout' "$out" '^  "method": "far",'
((cases += 1))
[[ -z $(compgen -G '*.part-*') ]] || fail 'good runs' 'a part of a file is left'

if ((failed)); then
  echo "cli_test: $failed of $cases cases failed"
  exit 1
fi
echo "cli_test: $cases cases, none failed"
