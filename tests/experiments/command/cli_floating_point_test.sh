#!/usr/bin/env bash
# The program in a process whose floating-point environment a library has changed before main, as
# one that was built with -ffast-math does. Answers are those of any other process; where the
# environment cannot be set there is an error.
#   tests/experiments/command/cli_floating_point_test.sh FARCULL_BINARY LIBRARY
# LIBRARY is tests/experiments/method/disturbed.cpp. Needs bash, Debian's essential tools and a software
# device of Mesa.
set -uo pipefail

if [[ $# -ne 2 || ! -x $1 || ! -e $2 ]]; then
  echo "usage: cli_floating_point_test.sh FARCULL_BINARY LIBRARY" >&2
  exit 2
fi
program=$(realpath -- "$1")
library=$(realpath -- "$2")
work=$(mktemp -d) || exit 2
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT

# shellcheck source-path=SCRIPTDIR source=cli_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/cli_lab.sh"

triangle() { # FILE VERTEX VERTEX VERTEX
  { printf 'v %s\n' "${@:2}" && echo 'f 1 2 3'; } >"$1"
}
# Triangles that overlap, in a plane. Flushing makes the first two disjoint, rounding downward or
# toward zero the second two. The third two are disjoint, but meet as zeros.
triangle tiny-a.obj '-1.90109156629516e-211 -3.80218313259032e-211 0' \
  '1.90109156629516e-211 1.90109156629516e-211 0' '1.90109156629516e-211 -1.90109156629516e-211 0'
triangle tiny-b.obj '3.80218313259032e-211 1.90109156629516e-211 0' \
  '-1.90109156629516e-211 3.80218313259032e-211 0' '3.80218313259032e-211 -1.90109156629516e-211 0'
triangle huge-a.obj '0 0 0' '2e150 -1e150 1e150' '0 2e150 2e150'
triangle huge-b.obj '-1e150 4e150 3e150' '-1e150 -3e150 -4e150' '1e150 -4e150 -3e150'
triangle subnormal-a.obj '0 0 0' '4e-320 0 0' '0 4e-320 0'
triangle subnormal-b.obj '4e-320 4e-320 0' '4e-320 3e-320 0' '3e-320 4e-320 0'
for name in a b; do
  cp "tiny-$name.obj" "many-$name.obj"
  for ((i = 1; i < 20; ++i)); do echo 'f 1 2 3'; done >>"many-$name.obj"
done

environments=(none upward downward 'toward zero')
# Only where the processor is one whose flushing the library knows how to set.
[[ $(uname -m) == x86_64 ]] && environments+=(flush)

for environment in "${environments[@]}"; do
  settings=("LD_PRELOAD=$library" "FARCULL_DISTURB=$environment")
  case $environment in
    none) callers='rounds to nearest, keeps subnormals' ;;
    flush) callers='rounds to nearest, flushes subnormal results and operands to zero' ;;
    *) callers="rounds $environment, keeps subnormals" ;;
  esac
  for scene in tiny:1 huge:1 subnormal:0; do
    name=${scene%:*} pairs=${scene#*:}
    for method in exact far-pairs far i-collide; do
      case="$name, $environment, $method"
      good "$case" 0 verify "$name-a.obj" "$name-b.obj" --method "$method" --json "$work/r.json"
      expect "$case" "$work/r.json" "\"colliding_pairs\": $pairs,"
      expect "$case" "$work/r.json" '"false_negatives": 0,'
      if [[ $environment == none ]]; then
        ! grep -q arithmetic "$out" || fail "$case" 'the usual environment is mentioned'
      else
        expect "$case" "$out" "^arithmetic rounds to nearest, keeps subnormals; the caller $callers\$"
      fi
    done
    # A certificate that is right, and one that says the contrary of it.
    good "$name, $environment" 0 run "$name-a.obj" "$name-b.obj" --method exact \
      --certificate right.json
    good "$name, $environment" 0 check right.json "$name-a.obj" "$name-b.obj"
    expect "$name, $environment" "$out" '^proved: '
    contrary=Zg==  # kept, meets
    if ((pairs)); then contrary=AA==; fi
    sed -E "s/(\"evidence\": \")[^\"]*/\1$contrary/" right.json >wrong.json
    launch check wrong.json "$name-a.obj" "$name-b.obj"
    ((status == 1)) || fail "$name, $environment, wrong" "status $status instead of 1"
    expect "$name, $environment, wrong" "$out" '^refuted'
  done
  good "frames, $environment" 0 verify two-spheres --method far-pairs --frames 2 \
    --json "$work/f.json"
  expect "frames, $environment" "$work/f.json" '"floating_point": \{'
  if [[ $environment != none ]]; then
    expect "frames, $environment" "$out" "^arithmetic .*; the caller $callers\$"
  fi
  # Every contestant, with several threads; they find all pairs and agree.
  good "bench, $environment" 0 bench many-a.obj many-b.obj --device cpu --repeat 1 \
    --json "$work/b.json"
  expect "bench, $environment" "$work/b.json" '"disagreement": null'
  expect "bench, $environment" "$work/b.json" '"pairs": 400,?$'
  [[ $environment == none || $environment == "${environments[-1]}" ]] || continue
  # Longer than the limit of the others.
  env "${settings[@]}" timeout 300 "$program" doctor --device software --json "$work/d.json" \
    >"$out" 2>"$err" || fail "doctor, $environment" "status $?"
  expected="arithmetic of the host: rounds to nearest, keeps subnormals; the caller's: "
  if [[ $environment == none ]]; then
    expected+='the same'
  else
    expected+="$callers \(set aside\)"
  fi
  expect "doctor, $environment" "$out" "^$expected\$"
  expect "doctor, $environment" "$work/d.json" '"rounding": "to nearest"'
done

# Twin: where the environment stays as it is, whatever we do, the program says so and answers
# nothing.
for environment in "${environments[@]:1}"; do
  settings=("LD_PRELOAD=$library" "FARCULL_DISTURB=$environment" FARCULL_DISTURB_STAYS=1)
  bad "$environment stays" 'arithmetic: this thread (rounds (upward|downward|toward zero)|.*flushes)' \
    verify tiny-a.obj tiny-b.obj --method exact
done

if ((failed)); then
  echo "cli_floating_point_test: $failed of $cases cases failed"
  exit 1
fi
echo "cli_floating_point_test: $cases cases, none failed"
