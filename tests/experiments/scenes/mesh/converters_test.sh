#!/usr/bin/env bash
# The commands that farcull names for formats that it does not read: each is taken from the message,
# run, and its result is read.
#   tests/experiments/scenes/mesh/converters_test.sh FARCULL
# Exit status 77 where none of the converters is installed.
set -euo pipefail

farcull=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
printf 'v %s\n' '0 0 0' '1 0 0' '0 1 0' '0 0 1' >a.obj
printf 'f %s\n' '1 3 2' '1 2 4' '1 4 3' '2 3 4' >>a.obj

tried=0
# convert FILE RESULT: runs the command that farcull names for FILE; RESULT must be a mesh then.
convert() {
  local said command
  said=$("$farcull" run "$1" 2>&1) && { echo "converters_test: $1 is read" >&2; exit 1; }
  command=${said##*convert it: }
  command=${command%% (*}
  [[ $command != "$said" ]] || { echo "converters_test: no command: $said" >&2; exit 1; }
  bash -c "$command" >log 2>&1 || { echo "converters_test: $command" >&2; cat log >&2; exit 1; }
  "$farcull" run "$2" --self --method i-collide >/dev/null
  rm "$2"
  tried=$((tried + 1))
}

if command -v assimp >/dev/null; then
  for kind in gltf:gltf2 glb:glb2 fbx:fbxa dae:collada 3ds:3ds x3d:x3d 3mf:3mf; do
    file="by assimp.${kind%:*}"
    assimp export a.obj "$file" "-f${kind#*:}" >/dev/null
    convert "$file" 'by assimp.obj'
  done
fi
if command -v meshio >/dev/null; then
  for extension in vtk vtu mesh inp bdf vol; do
    meshio convert a.obj "m.$extension" >/dev/null 2>&1
    convert "m.$extension" m.off
  done
fi
if command -v gmsh >/dev/null; then
  for extension in step brep; do
    printf 'SetFactory("OpenCASCADE");\nSphere(1) = {0, 0, 0, 1};\nSave "g.%s";\n' \
      "$extension" >g.geo
    gmsh g.geo - >/dev/null
    convert "g.$extension" g.stl
  done
  printf 'SetFactory("OpenCASCADE");\nSphere(1) = {0, 0, 0, 1};\n' >g.geo
  gmsh g.geo -2 -o g.msh >/dev/null
  convert g.msh g.stl
fi
if ((tried == 0)); then
  echo "not run: none of assimp, meshio and gmsh is installed"
  exit 77
fi
echo "converters_test: $tried files were converted and read"
