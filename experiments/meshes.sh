#!/usr/bin/env bash
# Brings the meshes of Debian's package libcgal-demo into build/meshes/. The package is downloaded
# and unpacked, not installed: that needs no root, and small images exclude documentation, where the
# meshes are, when they install.
# Exit status: 0 they are all there; 3 they cannot be had (stderr says why); anything else: this
# disk or this script.
set -euo pipefail

root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
exec </dev/null
export PATH="${PATH:-/usr/local/bin:/usr/bin:/bin}:/usr/sbin:/sbin"
meshes=$root/build/meshes
# The archive, in the package and where the package is installed.
inside=usr/share/doc/libcgal-dev/data.tar.gz

# Each mesh with its triangles: a file that claims another number is not the one that our results
# are about.
declare -A triangles=(
  [bunny00.off]=75408
  [ChineseDragon-10kv.off]=19994
  [armadillo.off]=52000
  [refined_elephant.off]=88928
  [mannequin-devil.off]=25888
  [elephant.off]=5558
)

# The number of faces in the header of an OFF file: the second of the three counts, which follow the
# word OFF, after any comments and empty lines.
faces_in_header() {
  awk '{ sub(/#.*/, ""); sub(/^[ \t]*[A-Z]*OFF/, "") } NF { print $2; exit }' "$1"
}

# Is every mesh in FOLDER, as it should be? Says the first one that is not, in $trouble.
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

# All work is done in a folder beside the goal, on the same file system, so that a mesh arrives by
# one rename: a run that is killed leaves no half of one.
mkdir -p "$root/build"
# A run that had no chance to clean up (kill -9, a power cut) left its folder; an hour is longer
# than any run lasts.
find "$root/build" -maxdepth 1 -name 'meshes.unpacking.*' -mmin +60 -exec rm -rf {} +
work=$(mktemp -d "$root/build/meshes.unpacking.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

# Unpacks the meshes of an archive, checks them and puts them where they belong.
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

# Downloads the package into $work: with apt's lists if they know it, otherwise (none yet, or old
# ones) with lists of our own, which need no root and change nothing on the system.
download() {
  # Root's apt would work as the user _apt, who may not write here, and warn about it.
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
  trouble="they come in Debian's package libcgal-demo, and this system has no apt-get and dpkg-deb"
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
echo "meshes: the packaged meshes cannot be had: ${trouble/"$work/"/}" >&2
exit 3
