#!/usr/bin/env bash
# Tries every rasterizer of Debian's Mesa that needs no GPU. Runs the probes of `farcull doctor`. Counts the
# pairs that FAR misses in the quick grid of the study `radius`, at the published radius and at the budget's
# radius. Mesa's driver noop draws nothing, so every probe of drawing must fail on this driver.
#   bash experiments/drivers.sh              all drivers, some minutes each; makes docs/results/drivers.md
#   bash experiments/drivers.sh zink noop    only these; prints the tables
#     --probes           only the probes
#     --program FARCULL  uses this program; installs and builds nothing
#     --out DIR          default build/drivers; keeps results in DIR that the same program made
# Exit status: 0 done; 1 a driver whose probes pass missed a pair at the budget's radius, or noop passed a
# probe of drawing; 2 a run failed.
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

# The drivers, their environments, and their descriptions.
drivers=(llvmpipe llvmpipe-128 zink softpipe softpipe-4.5 noop)
declare -A settings=(
  [llvmpipe]="GALLIUM_DRIVER=llvmpipe"
  [llvmpipe-128]="GALLIUM_DRIVER=llvmpipe LP_NATIVE_VECTOR_WIDTH=128"
  [zink]="GALLIUM_DRIVER=zink VK_ICD_FILENAMES=$(echo /usr/share/vulkan/icd.d/lvp_icd.*.json)"
  [softpipe]="GALLIUM_DRIVER=softpipe"
  [softpipe-4.5]="GALLIUM_DRIVER=softpipe MESA_GL_VERSION_OVERRIDE=4.5 MESA_GLSL_VERSION_OVERRIDE=450"
  [noop]="GALLIUM_DRIVER=llvmpipe GALLIUM_NOOP=true"
)
declare -A about=(
  [llvmpipe]="compiled by LLVM"
  [llvmpipe-128]="the same with vectors of 128 bits"
  [zink]="OpenGL by Vulkan (lavapipe)"
  [softpipe]="an interpreter"
  [softpipe-4.5]="the same, told to say that it has OpenGL 4.5"
  [noop]="drops every command"
)

probes_only='' program='' out=$farcull_root/build/drivers
chosen=()
while (($#)); do
  case $1 in
    --probes) probes_only=yes ;;
    --program | --out)
      if (($# < 2)); then
        echo "drivers: $1 needs a value" >&2
        exit 2
      fi
      if [[ $1 == --out ]]; then out=$(realpath -m "$2"); else program=$(realpath "$2"); fi
      shift
      ;;
    *)
      if [[ -z ${settings[$1]-} ]]; then
        echo "drivers: '$1' is none of them; they are: ${drivers[*]}" >&2
        exit 2
      fi
      chosen+=("$1")
      ;;
  esac
  shift
done
if [[ -z $program ]]; then
  cd "$farcull_root"
  farcull_packages+=(sqlite3 mesa-vulkan-drivers)
  farcull_setup
  farcull_build farcull
  program=$farcull_root/build/farcull
fi
commit=$("$program" --version)
out=$out/${commit##* }
whole=''
if ((${#chosen[@]} == 0)); then
  chosen=("${drivers[@]}")
  whole=yes
fi
mkdir -p "$out"
export LC_ALL=C
unset "${!MESA_@}" "${!GALLIUM_@}" "${!LP_@}" "${!EGL_@}" "${!__EGL_@}" VK_DRIVER_FILES
# Without this variable, Mesa does not use every Gallium driver for its software device.
export LIBGL_ALWAYS_SOFTWARE=true

# under DRIVER COMMAND...: runs the command with this driver. Each driver has its own cache folder.
under() {
  local -a variables
  read -ra variables <<<"${settings[$1]}"
  env "${variables[@]}" XDG_CACHE_HOME="$out/$1/cache" "${@:2}"
}
sql() { sqlite3 -separator ' | ' :memory: "$@"; }

# measure DRIVER: writes doctor.json, or the file `refused` with the error. Writes the study to results/.
measure() {
  local -i status=0
  local folder=$out/$1
  mkdir -p "$folder"
  if [[ ! -e $folder/doctor.json && ! -e $folder/refused ]]; then
    under "$1" timeout 900 "$program" doctor --device software --json "$folder/doctor.part" \
      >"$folder/doctor.txt" 2>"$folder/said" || status=$?
    case $status in
      0 | 1) mv "$folder/doctor.part" "$folder/doctor.json" ;;
      2) sed -n 's/^farcull: //p' "$folder/said" >"$folder/refused" ;;
      *)
        echo "drivers: $1: the probes ended with status $status; $folder/said says why" >&2
        return 2
        ;;
    esac
  fi
  if [[ -n $probes_only || -e $folder/refused || -e $folder/measured ]]; then return 0; fi
  status=0
  under "$1" timeout 3600 "$program" experiment radius --quick --resume --device software --out "$folder/results" \
    >"$folder/study.txt" 2>"$folder/study.said" || status=$?
  # Status 2 means that some points of the study have no result. The other points are used.
  if ((status > 2)); then
    echo "drivers: $1: the study ended with status $status; $folder/study.said says why" >&2
    return 2
  fi
  touch "$folder/measured"
}

assumptions=(A1 A2 A3 A4 A5 A6 A7 A8 A9)
# Leaves out the probe of assumption A10. A10 is about threads of the driver, so noop passes this probe.
drawn_probes="p.value ->> 'assumption' <> 'A10'"
probes_table() {
  local driver json
  echo "| driver | what it is | answers as | probes that pass | $(printf '%s |' "${assumptions[@]}")"
  echo "|---|---|---|---|$(printf -- '---|%.0s' "${assumptions[@]}")"
  for driver in "${chosen[@]}"; do
    json=$out/$driver/doctor.json
    if [[ ! -e $json ]]; then
      echo "| $driver | ${about[$driver]} | refused: $(sed 's/;.*//' "$out/$driver/refused") | - |$(printf -- ' - |%.0s' "${assumptions[@]}")"
      continue
    fi
    sql "WITH report AS (SELECT readfile('$json') AS j),
      probe AS (SELECT p.value ->> 'assumption' AS a, p.value ->> 'pass' AS pass FROM report, json_each(j, '\$.probes') p
        WHERE $drawn_probes)
      SELECT '| $driver', '${about[$driver]}', j ->> '\$.gl.renderer' || ', OpenGL ' || (j ->> '\$.gl.version'),
        (SELECT sum(pass) || ' of ' || count(*) FROM probe),
        $(for a in "${assumptions[@]}"; do echo "(SELECT sum(pass) || '/' || count(*) FROM probe WHERE a = '$a'),"; done | sed '$ s/,$//')
        || ' |' FROM report"
  done
}
broken_table() {
  local driver
  echo '| driver | probe that fails | measured | bound | unit |'
  echo '|---|---|---|---|---|'
  for driver in "${chosen[@]}"; do
    # Leaves out noop, whose probes of drawing all fail.
    if [[ ! -e $out/$driver/doctor.json || $driver == noop ]]; then continue; fi
    sql "SELECT '| $driver', (p.value ->> 'assumption') || ' ' || (p.value ->> 'name'),
      CASE WHEN p.value ->> 'samples' = 0 OR p.value ->> 'unit' = '' THEN 'broke off: ' || replace(p.value ->> 'note', '|', '/')
        ELSE printf('%.3g', p.value ->> 'measured') END,
      printf('%.3g', p.value ->> 'bound'), (p.value ->> 'unit') || ' |'
      FROM json_each(readfile('$out/$driver/doctor.json'), '\$.probes') p WHERE NOT p.value ->> 'pass'"
  done
}
# For each of the two radii, the table has the colliding pairs that FAR missed, and the points that violate the lemmas. It leaves
# out rows of the native canvas and of device models, which do not depend on the driver.
drawn="device NOT IN ('cpu', 'native')"
missed_table() {
  local driver store
  echo '| driver | points that it draws, with an answer | missed, published radius | missed, budget | lemmas broken, published | lemmas broken, budget |'
  echo '|---|---|---|---|---|---|'
  for driver in "${chosen[@]}"; do
    store=$out/$driver/results/results.sqlite
    if [[ ! -e $store ]]; then continue; fi
    sqlite3 -separator ' | ' "$store" "
      SELECT '| $driver', (SELECT sum($drawn) || ' of ' || ((SELECT count(*) FROM points) - sum(NOT ($drawn))) FROM rows),
        $(for what in "far missed colliding" "lemma violations points"; do
          read -r method count of <<<"$what"
          for radius in published budget; do
            echo "(SELECT coalesce(sum(counts ->> '\$.$count') || ' of ' || sum(counts ->> '\$.$of'), 'no answer') FROM results
              WHERE $drawn AND method = '$method' AND radius = '$radius' AND depth_mode = 'fragment' AND counts IS NOT NULL),"
          done
        done | sed '$ s/,$//') || ' |'"
  done
}

# shellcheck disable=SC2016 # the backticks are those of the page
tables() {
  printf 'Made by `bash experiments/drivers.sh` at commit %s, %s.\n\n' "${commit##* }" "$(dpkg-query -W -f 'Mesa ${Version}' libgl1-mesa-dri 2>/dev/null || echo 'Mesa of unknown version')"
  probes_table
  printf '\n'
  broken_table
  if [[ -z $probes_only ]]; then
    printf '\n'
    missed_table
  fi
}

for driver in "${chosen[@]}"; do
  echo "drivers: $driver (${settings[$driver]})" >&2
  measure "$driver"
done
tables >"$out/results.md"
cat "$out/results.md"

status=0
for driver in "${chosen[@]}"; do
  json=$out/$driver/doctor.json
  store=$out/$driver/results/results.sqlite
  if [[ ! -e $json ]]; then continue; fi
  passing=$(sql "SELECT sum(p.value ->> 'pass') || ' ' || count(*) FROM json_each(readfile('$json'), '\$.probes') p
    WHERE $drawn_probes")
  if [[ $driver == noop && ${passing% *} != 0 ]]; then
    echo "drivers: a probe passes on a driver that does nothing: see $json" >&2
    status=1
  fi
  if [[ ${passing% *} == "${passing#* }" && -e $store ]]; then
    missed=$(sqlite3 "$store" "SELECT coalesce(sum(counts ->> '\$.missed'), 0) FROM results
      WHERE $drawn AND method = 'far' AND radius = 'budget' AND depth_mode = 'fragment'")
    if [[ $missed != 0 ]]; then
      echo "drivers: $driver missed $missed pairs at the budget's radius, though its probes pass" >&2
      status=1
    fi
  fi
done
if [[ -n $whole && -z $probes_only ]] && ((status == 0)) && [[ -d $farcull_root/docs ]]; then
  # Keeps the top of the page, up to the first line that begins with "<!-- ".
  page=$farcull_root/docs/results/drivers.md
  { sed '/^<!-- /q' "$page"; echo; cat "$out/results.md"; } >"$out/page.md"
  cp "$out/page.md" "$page"
  echo "drivers: made docs/results/drivers.md" >&2
fi
exit "$status"
