#!/usr/bin/env bash
# Completion and the manual, against the help of every command; in bash, zsh and fish, and by the
# readers of manuals, where these are installed.
#   tests/experiments/command/completion_test.sh FARCULL
set -euo pipefail

program=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
PATH=$(dirname "$program"):$PATH
export PATH LC_ALL=C

failed=0
fail() {
  echo "completion_test: $1" >&2
  failed=1
}

# Every command, with those below it, one a line: "experiment all". From the help alone.
commands_below() { # WORDS...
  local name
  while read -r name; do
    echo "${*:+$* }$name"
    commands_below "$@" "$name"
  done < <(farcull "$@" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z-]*\).*/\1/p')
}
# The options of a command, one a line.
options_of() { # WORDS...
  farcull "$@" --help | sed -nE 's/^  (-[^ ]+).*/\1/p' | tr ',' '\n'
}

{
  echo
  commands_below
} >commands
(($(wc -l <commands) > 20)) || fail "only $(wc -l <commands) commands are found in the help"
for shell in bash zsh fish; do farcull completion $shell >"script.$shell"; done
farcull man >farcull.1

# missing KIND FILE: each option of the help that FILE, a script or the manual, does not have.
missing() {
  local command option block
  while read -r command; do
    for option in $(eval "options_of $command"); do
      case $1 in
        table) # the branch of _farcull_words
          block=$(sed -n "/^_farcull_words/,/^}/p" "$2" |
            grep -A1 -E "^    '?farcull${command:+ $command}'?\)")
          grep -qE "[' =]$option( |'|\$)" <<<"$block" || echo "$command $option"
          ;;
        fish)
          block=$(grep -E "__farcull_at ('\\\\'')?farcull${command:+ $command}('\\\\'')?'" "$2")
          case $option in
            --*) grep -qE " -l ${option#--} " <<<"$block" || echo "$command $option" ;;
            *) grep -qE " -s ${option#-} " <<<"$block" || echo "$command $option" ;;
          esac
          ;;
        manual)
          block=$(awk -v name=".SS farcull${command:+ $command}" \
            '{ plain = $0; gsub(/\\-/, "-", plain) }
             plain == name || (name == ".SS farcull" && /^\.SH DESCRIPTION/) { inside = 1; next }
             /^\.S[SH] / { inside = 0 }
             inside { print plain }' "$2")
          grep -qF -- "\\fB$option\\fR" <<<"$block" || echo "$command $option"
          ;;
      esac
    done
  done <commands
}
for where in 'table script.bash' 'table script.zsh' 'fish script.fish' 'manual farcull.1'; do
  read -r kind file <<<"$where"
  lost=$(missing "$kind" "$file")
  [[ -z $lost ]] || fail "$file lacks: $(tr '\n' ';' <<<"$lost")"
done
# The twins: one option is taken out of one command, and noticed.
sed '/^_farcull_words/,/^}/s/ --clearance / /' script.bash >damaged
[[ $(missing table damaged) == *--clearance* ]] || fail "an option lost by bash is not noticed"
grep -v -- ' -l clearance ' script.fish >damaged
[[ $(missing fish damaged) == *--clearance* ]] || fail "an option lost by fish is not noticed"
grep -v 'clearance' farcull.1 >damaged
[[ $(missing manual damaged) == *--clearance* ]] || fail "an option lost by the manual is not noticed"

# ---- the manual

if command -v mandoc >/dev/null; then
  mandoc -T lint -W error farcull.1 >said || fail "mandoc: $(head -3 said)"
  printf '%s\n' '.TH X 1' '.SH NAME' 'x \- y' '.TS' 'broken' >damaged
  if mandoc -T lint -W error damaged >said; then fail "mandoc finds nothing in a broken page"; fi
else
  echo "not run: mandoc"
fi
if command -v groff >/dev/null; then
  groff -ww -man -Tascii farcull.1 >page 2>said || true
  [[ ! -s said ]] || fail "groff: $(head -3 said)"
  grep -q 'collision culling that never misses' page || fail "groff prints no page"
else
  echo "not run: groff"
fi
if command -v man >/dev/null; then
  grep -q 'farcull' <<<"$(man -l farcull.1 2>said)" || fail "man -l: $(head -3 said)"
else
  echo "not run: man"
fi

# ---- shells

printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >mesh.obj
gzip -k mesh.obj
echo text >notes.txt
mkdir meshes

# in_bash LINE: what bash offers at the end of the line, in one line.
in_bash() {
  bash --noprofile --norc -c '
    set -eu
    source script.bash
    [[ $(complete -p farcull) == "complete -F _farcull farcull" ]]
    COMP_LINE=$1 COMP_POINT=${#1}
    _farcull
    echo "${COMPREPLY[*]-}"' bash "$1"
}
in_zsh() {
  zsh -f -c '
    compdef() { : }
    compadd() { shift; offered+=("$@") }
    compset() { current=${current#*=} }
    _files() { offered+=(FILES) }
    offered=()
    source ./script.zsh
    words=(${(z)1}) CURRENT=${#words}
    [[ $1 == *" " ]] && { words+=(""); CURRENT=${#words} }
    _farcull
    print -r -- "${(@M)offered:#${words[CURRENT]#*=}*}" ${(M)offered:#FILES}' zsh "$1"
}
in_fish() {
  XDG_CONFIG_HOME=$work/fish fish --no-config -c '
    source script.fish; complete -C $argv[1] | string replace -r "\t.*" ""; true' -- "$1" | tr '\n' ' '
}

# offers SHELL LINE WORD...: all of the words are offered; after "but", none of them.
offers() {
  local shell=$1 line=$2 words word wanted=1
  shift 2
  words=" $("in_$shell" "$line" 2>said | tr '\n' ' ') "
  [[ ! -s said ]] || fail "$shell, '$line': $(head -3 said)"
  for word in "$@"; do
    if [[ $word == but ]]; then
      wanted=0
    elif ((wanted)) && [[ $words != *" $word "* ]]; then
      fail "$shell, '$line': $word is not offered, but:$words"
    elif ((!wanted)) && [[ $words == *" $word "* ]]; then
      fail "$shell, '$line': $word is offered"
    fi
  done
}

for shell in bash zsh fish; do
  if ! command -v $shell >/dev/null; then
    echo "not run: $shell"
    continue
  fi
  offers $shell 'farcull ru' run but compare
  offers $shell 'farcull run --me' --method but --resolution
  offers $shell 'farcull run --method ' far cullide far-pairs exact but native two-spheres
  offers $shell 'farcull run --depth f' fragment fixed but far
  offers $shell 'farcull run two-spheres --device n' native but software
  offers $shell 'farcull run --self two-sph' two-spheres but run
  offers $shell 'farcull experiment ' accuracy all lemma but run two-spheres
  offers $shell 'farcull experiment lemma --canvas w' worst but native
  offers $shell 'farcull experiment all --qui' --quick but --query
  offers $shell 'farcull completion ' bash zsh fish
done
offers bash 'farcull run --query=o' occlusion but flags
offers bash 'farcull run me' mesh.obj mesh.obj.gz meshes but notes.txt
offers bash 'farcull run a.obj me' mesh.obj
offers bash 'farcull run --json no' notes.txt
offers bash 'farcull scenes --write me' meshes but mesh.obj
offers bash 'farcull check no' notes.txt
offers bash 'farcull check notes.txt me' mesh.obj but notes.txt

# What is offered for an enumeration is taken.
for option in --method --offset --depth --depth-format --query --radius --resolution --clusters \
  --device; do
  taken=0
  for value in $(in_bash "farcull plan two-spheres $option "); do
    set --
    case $option:$value in --device:gl | --device:software | --device:hardware) continue ;; esac
    method=far
    [[ $option != --resolution ]] || method=far-pairs
    [[ $option == --method ]] || set -- --method $method
    [[ $value != s-cullide ]] || set -- --self
    farcull plan two-spheres "$@" "$option" "$value" >/dev/null 2>said ||
      fail "$option $value is offered, but: $(<said)"
    taken=$((taken + 1))
  done
  ((taken > 0)) || fail "nothing is offered after $option"
done
exit "$failed"
