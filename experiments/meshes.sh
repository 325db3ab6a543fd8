#!/usr/bin/env bash
# Puts the meshes of Debian's package libcgal-demo into build/meshes/. Downloads and unpacks the package, since an installation
# needs root. Minimal systems also leave out documentation when they install a package, and the meshes are documentation.
# Exit status: 0: all meshes are there. 3: the meshes cannot be obtained, and stderr says why.
# Other values: an error of the disk or of this script.
set -euo pipefail

root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
exec </dev/null
export PATH="${PATH:-/usr/local/bin:/usr/bin:/bin}:/usr/sbin:/sbin"
meshes=$root/build/meshes
# The path of the archive of meshes in the package. If the package is installed, /$inside exists.
inside=usr/share/doc/libcgal-dev/data.tar.gz

# The number of triangles of each mesh. A file with another number is rejected.
declare -A triangles=(
  [bunny00.off]=75408
  [ChineseDragon-10kv.off]=19994
  [armadillo.off]=52000
  [refined_elephant.off]=88928
  [mannequin-devil.off]=25888
  [elephant.off]=5558
)

# Prints the number of faces of an OFF file. This is the second count after the word OFF. Comments
# and empty lines may come before the counts.
faces_in_header() {
  awk '{ sub(/#.*/, ""); sub(/^[ \t]*[A-Z]*OFF/, "") } NF { print $2; exit }' "$1"
}

# all_in FOLDER: succeeds if the folder has every mesh with its number of triangles. Else $trouble
# names a mesh that is missing or wrong.
all_in() {
  local folder=$1 name found
  for name in "${!triangles[@]}"; do
    if [[ ! -f $folder/$name ]]; then
      trouble="$name is not there"
      return 1
    fi
    found=$(faces_in_header "$folder/$name")
    if [[ $found != "${triangles[$name]}" ]]; then
      trouble="$name has ${found:-no} triangles in its header, not ${triangles[$name]}"
      return 1
    fi
  done
}

if all_in "$meshes"; then exit 0; fi

# The work folder is on the file system of build/meshes/, so that a rename puts a complete mesh in place.
mkdir -p "$root/build"
# Removes folders of runs that were killed. No run lasts an hour.
find "$root/build" -maxdepth 1 -name 'meshes.unpacking.*' -mmin +60 -exec rm -rf {} +
work=$(mktemp -d "$root/build/meshes.unpacking.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

# take_from ARCHIVE: unpacks the meshes of the archive, checks them and moves them to build/meshes/.
take_from() {
  local archive=$1
  local -a names=("${!triangles[@]}")
  rm -rf "$work/unpacked"
  mkdir "$work/unpacked"
  if ! tar -xzf "$archive" -C "$work/unpacked" --no-same-owner --strip-components=2 \
    "${names[@]/#/data/meshes/}" 2>"$work/tar.log"; then
    trouble="$archive cannot be unpacked: $(grep -m 1 . "$work/tar.log" || true)"
    return 1
  fi
  if ! all_in "$work/unpacked"; then
    trouble="$archive: $trouble"
    return 1
  fi
  mkdir -p "$meshes"
  mv -f "$work/unpacked"/*.off "$meshes/"
  echo "meshes: ${#triangles[@]} in build/meshes/"
}

# Downloads the package into $work with the system's package lists. If that fails, downloads new
# package lists into $work and tries again. Neither attempt needs root or changes the system.
download() {
  # With this option, apt as root does not change to the user _apt, who may not write here.
  local -a apt=(apt-get -q -o APT::Sandbox::User=root -o Acquire::Retries=2)
  local -a own=(-o Dir::State::Lists="$work/lists" -o Dir::Cache="$work/cache")
  mkdir -p "$work/lists/partial" "$work/cache/archives/partial"
  (
    export LC_ALL=C
    cd "$work"
    "${apt[@]}" download libcgal-demo ||
      { "${apt[@]}" "${own[@]}" update && "${apt[@]}" "${own[@]}" download libcgal-demo; }
  ) >"$work/apt.log" 2>&1
}

if [[ -r /$inside ]]; then
  if take_from "/$inside"; then exit 0; fi
  echo "meshes: $trouble; trying the package" >&2
fi

if ! command -v apt-get >/dev/null || ! command -v dpkg-deb >/dev/null; then
  trouble="they are in the Debian package libcgal-demo, and this system has no apt-get or no dpkg-deb"
elif ! download; then
  cause=$(grep -m 1 '^[WE]: Failed to fetch' "$work/apt.log" ||
    grep -m 1 '^E:' "$work/apt.log" || tail -n 1 "$work/apt.log")
  trouble="the package libcgal-demo cannot be downloaded: $cause"
elif ! dpkg-deb --fsys-tarfile "$work"/libcgal-demo_*.deb |
  tar -x -C "$work" "./$inside" 2>"$work/tar.log"; then
  trouble="the package libcgal-demo does not hold $inside"
elif take_from "$work/$inside"; then
  exit 0
fi
echo "meshes: the packaged meshes cannot be obtained: ${trouble/"$work/"/}" >&2
exit 3
