#!/usr/bin/env bash
# Measures boxes on fields of 10^4 to 10^7 triangles of constant density. Prints time, memory beyond the input, candidates for
# each true pair, and the exponent of time over triangles: the slope of a least-squares line through the logarithms, 1 for linear
# growth. The arguments are the numbers of triangles.
#   SCENE=crumpled bash experiments/scaling.sh 10000 100000 1000000     another scene that takes a number
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"
farcull_setup
farcull_build farcull

sizes=("$@")
if ((${#sizes[@]} == 0)); then sizes=(10000 30000 100000 300000 1000000 3000000 10000000); fi
scene=${SCENE:-field}
record=build/scaling.json
printf '%12s %10s %10s %10s %9s %12s %10s %11s\n' triangles ms min max MiB candidates pairs cand./pairs
for size in "${sizes[@]}"; do
  build/farcull bench "$scene:$size" --peers none --methods boxes --device cpu --repeat 5 --json "$record" >/dev/null
  value() { sed -nE "0,/\"$1\": /s/.*\"$1\": *(-?[0-9.e+-]+).*/\1/p" "$record"; }
  printf '%s %s %s %s %s %s %s\n' "$(value triangles)" "$(value median)" "$(value min)" "$(value max)" "$(value peak_mib)" \
    "$(value candidate_pairs)" "$(value pairs)"
done | awk '{
    printf "%12d %10.2f %10.2f %10.2f %9.1f %12d %10d %11s\n", $1, $2, $3, $4, $5, $6, $7,
      ($7 > 0 ? sprintf("%.2f", $6 / $7) : "-")
    x = log($1); y = log($2); n += 1; sx += x; sy += y; sxx += x * x; sxy += x * y
  }
  END { if (n > 1) printf "exponent %.3f\n", (n * sxy - sx * sy) / (n * sxx - sx * sx) }'
