#!/usr/bin/env bash
# The commands of README.md and of pages that continue it: those that begin with build/farcull are run
# in their order, in an empty folder; of the others the words are held against the help.
#   tests/readme_test.sh FARCULL [PAGE...]
set -euo pipefail

program=$(realpath "$1")
root=$(realpath "$(dirname -- "${BASH_SOURCE[0]}")/..")
if (($# > 1)); then
  mapfile -t pages < <(realpath "${@:2}")
else
  pages=("$root/README.md" "$root"/docs/{scenes,methods,tiles,experiments}.md)
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/build"
ln -s "$program" "$work/build/farcull"
cd "$work"

# commands_of PAGE...: the indented lines that call farcull, without their comments.
commands_of() { sed -nE 's/^    ((build\/)?farcull .*)/\1/p' "$@" | sed -E 's/ +#.*$//'; }

# unknown COMMAND-LINE: what the program does not know of it; nothing where it knows all.
unknown() {
  local -a words command=()
  local word help
  read -ra words <<<"${1%%[|&]*}"
  help=$("$program" --help)
  for word in "${words[@]:1}"; do
    if [[ $word == -* ]]; then
      grep -qE "^  (-[a-z],)?${word%%=*}( |\$)" <<<"$help" ||
        grep -qE "^  ${word%%=*}(,| |\$)" <<<"$help" || echo "'$word' in: $1"
    elif ((${#command[@]} < 2)) && grep -qE "^  $word( |\$)" <(sed -n '/^Subcommands:/,/^$/p' <<<"$help"); then
      command+=("$word")
      help=$("$program" "${command[@]}" --help)
    elif ((${#command[@]} == 0)); then
      echo "'$word' in: $1"
    fi
  done
}

# wrong PAGE...: a line for each command that cannot be as it stands.
wrong() {
  local line said status
  while read -r line; do
    said=$(unknown "$line")
    if [[ -n $said ]]; then
      printf '%s\n' "$said"
      continue
    fi
    [[ $line == build/* ]] || continue
    status=0
    timeout 120 bash -c "set -o pipefail; $line" >said 2>&1 </dev/null || status=$?
    if ((status)) && ! grep -q 'was built without OpenGL' said; then
      echo "status $status of: $line: $(tail -n 1 said)"
    fi
  done < <(commands_of "$@")
}

failed=0
count=$(commands_of "${pages[@]}" | wc -l)
if ((count < 12)); then
  echo "readme_test: only $count commands are found in ${pages[*]}"
  failed=1
fi
found=$(wrong "${pages[@]}")
if [[ -n $found ]]; then
  echo "readme_test: $found"
  failed=1
fi

# Twins: each of these has to be noticed.
for line in 'farcull run two-spheres --metod far' 'farcull rum two-spheres' \
  'build/farcull run there-is-no-such-scene' 'build/farcull run two-spheres --method fast' \
  'farcull experiment accuracy --clearance 1'; do
  printf '    %s  # a comment\n' "$line" >twin.md
  if [[ -z $(wrong twin.md) ]]; then
    echo "readme_test: this is not noticed: $line"
    failed=1
  fi
done
exit "$failed"
