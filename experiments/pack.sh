#!/usr/bin/env bash
# Packs the program, the libraries that it needs, the meshes and the scripts into one folder of at most 60 MiB
# that runs experiments/hardware.sh on a machine without network, compilers and packages of ours. That machine
# needs bash, coreutils, tar, gzip, awk and sed, the same kind of processor (x86-64), and the EGL driver of its
# GPU.
#   bash experiments/pack.sh [DIR]               default build/farcull-packed
#   bash experiments/pack.sh --built [DIR]       takes build/farcull and build/meshes as they are
# Copy DIR there, and run: bash DIR/hardware.sh [OPTIONS OF experiments/hardware.sh]
# The folder has neither the test suite nor Python. If python3-matplotlib and python3-pandas are missing there, the
# archive has the measurements without a report, and `farcull report` makes the report of them here.
# Exit status: 0; 2 the folder could not be made, or is larger than 60 MiB.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"
built=''
if [[ ${1-} == --built ]]; then
  built=yes
  shift
fi
folder=$(realpath -m "${1:-build/farcull-packed}")
if [[ -e $folder && ! -e $folder/farcull.tar.gz ]]; then
  echo "pack: $folder is there, and this script did not make it; name another folder" >&2
  exit 2
fi
if [[ -z $built ]]; then
  farcull_setup
  farcull_build farcull
  bash experiments/meshes.sh || exit 2
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP
packed=$work/farcull
mkdir -p "$packed"/build/{meshes,libraries,fallback} "$packed/experiments"
cp build/meshes/*.off "$packed/build/meshes/"
cp experiments/*.sh "$packed/experiments/"
mkdir -p "$packed/share/farcull"
cp -r experiments/report "$packed/share/farcull/"
strip -o "$packed/build/program" build/farcull
echo "of $(build/farcull --version)" >"$packed/packed"

# The C and C++ runtimes are those of the system there: its driver may need newer ones than ours. Our copies
# are used only if the system's are too old for the program.
while read -r library; do
  case ${library##*/} in
    libc.so* | libm.so* | libdl.so* | libpthread.so* | librt.so* | libstdc++.so* | libgcc_s.so* | ld-linux*)
      cp -L "$library" "$packed/build/fallback/"
      ;;
    *) cp -L "$library" "$packed/build/libraries/" ;;
  esac
done < <(ldd build/farcull | grep -oE '/[^ ]+')
# epoxy opens these libraries by name. Our copies are used only if the system lacks them.
mkdir "$packed/build/dispatch"
for library in libEGL.so.1 libOpenGL.so.0 libGLdispatch.so.0; do
  found=$(ldconfig -p | sed -n "s|.*$library .*x86-64.* => ||p" | head -n 1)
  if [[ -n $found ]]; then cp -L "$found" "$packed/build/dispatch/"; fi
done

cat >"$packed/build/farcull" <<'START'
#!/usr/bin/env bash
# Starts the program with the libraries of this folder.
here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
export FARCULL_MESHES=${FARCULL_MESHES:-$here/meshes} FARCULL_REPORT=${FARCULL_REPORT:-${here%/*}/share/farcull/report}
libraries=$here/libraries
ldconfig=$(PATH=$PATH:/usr/sbin:/sbin command -v ldconfig)
for library in libEGL.so.1 libOpenGL.so.0; do
  if [[ -z $ldconfig ]] || ! "$ldconfig" -p | grep -q "$library"; then
    libraries=$libraries:$here/dispatch
    break
  fi
done
libraries=$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
if LD_LIBRARY_PATH=$libraries "$here/program" --version >/dev/null 2>&1; then
  export LD_LIBRARY_PATH=$libraries
  exec "$here/program" "$@"
fi
# The system's runtimes are too old. Those of this folder come first then, with their own loader.
libraries=$here/fallback:$libraries
for folder in /usr/lib/x86_64-linux-gnu /lib/x86_64-linux-gnu /usr/lib64 /lib64; do
  if [[ -d $folder ]]; then libraries=$libraries:$folder; fi
done
exec "$here"/fallback/ld-linux-x86-64.so.2 --library-path "$libraries" "$here/program" "$@"
START
chmod +x "$packed/build/farcull"

mkdir -p "$folder"
tar -czf "$folder/farcull.tar.gz.part" -C "$work" farcull
mv "$folder/farcull.tar.gz.part" "$folder/farcull.tar.gz"
cat >"$folder/hardware.sh" <<'START'
#!/usr/bin/env bash
# Unpacks the program beside this script and runs experiments/hardware.sh, whose head says what it does. The
# results are in farcull/build/ beside this script, with one archive at the end.
set -euo pipefail
here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
if [[ ! -e $here/farcull/packed ]]; then
  rm -rf "$here/farcull.part"
  mkdir "$here/farcull.part"
  tar -xzf "$here/farcull.tar.gz" -C "$here/farcull.part"
  mv "$here/farcull.part/farcull" "$here/farcull"
  rmdir "$here/farcull.part"
fi
exec bash "$here/farcull/experiments/hardware.sh" "$@"
START
size=$(du -sk "$folder" | cut -f 1)
echo "pack: $folder has $((size / 1024)) MiB; there: bash hardware.sh"
if ((size > 60 * 1024)); then
  echo "pack: that is more than 60 MiB" >&2
  exit 2
fi
