#!/usr/bin/env bash
# The cloth at each of four stiffnesses. far-pairs finds the colliding pairs of every frame, and the accounting decides every pair.
# It prints a row for each stiffness. It fails if a pair is missed, a number is not finite, a step did not converge, or the energy
# grew by more than the unbalanced forces can do. Each stiffness has a record in build/cloth/; a record that is there is not made again.
#
#   bash experiments/cloth.sh                              20,000 triangles, 500 frames: hours where it is stiff (docs/cloth.md)
#   TRIANGLES=800 bash experiments/cloth.sh                minutes
set -euo pipefail

# shellcheck source-path=SCRIPTDIR source=setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"
cd "$farcull_root"
farcull_setup
farcull_build farcull

triangles=${TRIANGLES:-20000}
frames=${FRAMES:-500}
# The name of a record contains the commit, so that the record of another commit is not reused.
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
out=build/cloth
mkdir -p "$out"
failed=0
printf '%-9s %7s %7s %12s %13s %13s %11s %12s %12s %7s\n' stiffness frames failed 'iterations' 'energy first' 'energy last' 'most gained' 'residual N' 'colliding' missed
for stiffness in 1e2 1e4 1e6 1e8; do
  record="$out/$triangles.$stiffness.$frames.$commit.json"
  if [[ ! -s $record ]]; then
    build/farcull verify "cloth:$triangles:$stiffness" --method far-pairs --frames "$frames" --json "$record" >/dev/null || failed=1
  fi
  [[ -s $record ]] || continue
  # The record has one number on each line.
  awk -F': ' -v stiffness="$stiffness" '
    { value = $2 + 0 }
    /"total J"/ { growth = n ? value - last : 0; if (!n++) first = value; last = value; }
    # The total energy grows by the work of the unbalanced forces at most.
    /"slack J"/ { if (growth > most) most = growth; if (growth > value) bad = 1 }
    /"residual N"/ && value > residual { residual = value }
    /"iterations"/ && value > iterations { iterations = value }
    /"converged": 0/ { unconverged++ }
    /^      "colliding_pairs"/ && value > colliding { colliding = value }
    /^    "missed": [0-9]/ { missed = value; counted = 1 }
    /null|nan|inf/ && /"(total|kinetic|elastic|residual)/ { bad = 1 }
    END {
      printf "%-9s %7d %7d %12d %13.6g %13.6g %11.2g %12.3g %12d %7s\n", stiffness, n, unconverged, iterations, first, last, most, residual, colliding, missed
      exit bad || n == 0 || !counted || unconverged > 0 || missed > 0
    }' "$record" || failed=1
done
if ((failed)); then
  echo "cloth: a pair was missed, a step failed, or the energy grew" >&2
  exit 1
fi
echo "cloth: finite, energy bounded, nothing missed; all records are in $out/"
