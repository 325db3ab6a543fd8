# shellcheck shell=bash disable=SC2034 # what is set here is used by cli_test.sh
# What the scripts cli_*_test.sh share: how the program is launched and judged, and files in every
# format. Sourced without arguments, so that $1 is that of the script. A script that takes more than
# the path of the program has set `program` to it, and `work` to a folder of its own; for the others
# that is done here. Leaves the caller in $work/here.
if [[ -z ${program-} ]]; then
  if [[ $# -ne 1 || ! -x $1 ]]; then
    echo "usage: ${0##*/} FARCULL_BINARY" >&2
    exit 2
  fi
  program=$(realpath -- "$1")
  work=$(mktemp -d) || exit 2
  trap 'chmod -R u+w "$work"; rm -rf -- "$work"' EXIT
fi
: "${program:?}" "${work:?}"

# What the caller has set must not decide; few malloc arenas, since each thread's takes address
# space that is counted below.
unset FARCULL_MESHES EGL_LOG_LEVEL LIBGL_ALWAYS_SOFTWARE GALLIUM_DRIVER
unset MESA_GL_VERSION_OVERRIDE MESA_GLSL_VERSION_OVERRIDE
unset __EGL_VENDOR_LIBRARY_DIRS __EGL_VENDOR_LIBRARY_FILENAMES
export LC_ALL=C MALLOC_ARENA_MAX=2

# A bad input ends within this much time of all cores, however busy the machine is; and any launch
# that takes a minute is taken for one that hangs.
readonly cpu_seconds=5
readonly seconds=60
# KiB. A billion vertices are 12 GB as floats, a billion triangles as much in indices; good runs
# pass with a tenth of it.
readonly address_space=4000000

# Verdicts about devices lie beside the program, made once, since a run says so when it makes one.
XDG_CACHE_HOME=$(dirname -- "$program")/test-cache
export XDG_CACHE_HOME
for method in far far-pairs; do
  "$program" run two-spheres --method "$method" --device software --no-verify >"$work/verdict" 2>&1
done

cases=0
failed=0
out=$work/stdout
err=$work/stderr
mkdir "$work/here"
cd "$work/here" || exit 2

fail() { # CASE WHAT: one line, with what the program said
  echo "FAILED $1: $2; stderr: $(head -c 300 "$err" | tr '\n' '|')"
  ((failed += 1))
}

# Names, sizes and times of all that lies in the folder.
snapshot() { find . -mindepth 1 -printf '%p %y %l %s %T@\n' | sort; }

# launch ARGUMENTS...: the program, with `status`, `$out` and `$err` as its answer. `to` is where
# its stdout goes: a path, "closed", or "broken" for a pipe that nobody reads. `settings` are
# variables for its environment, `cpu` is how many seconds of all cores it may use.
to=$out
settings=()
cpu=unlimited
launch() {
  : >"$out"
  local command=(env "${settings[@]}" timeout "$seconds" "$program" "$@")
  case $to in
    closed) (ulimit -v "$address_space" -t "$cpu" && exec "${command[@]}" >&- 2>"$err") ;;
    broken)
      (
        ulimit -v "$address_space" -t "$cpu" && "${command[@]}" 2>"$err"
        echo $? >"$work/status"
      ) | :
      (exit "$(<"$work/status")")
      ;;
    *) (ulimit -v "$address_space" -t "$cpu" && exec "${command[@]}" >"$to" 2>"$err") ;;
  esac
  status=$?
}

# refused CASE PATTERN: whether the last launch answered as a bad input must; PATTERN is an
# extended regular expression for the message after "farcull: ".
refused() {
  if ((status == 124)); then
    fail "$1" "not done after $seconds s"
  elif ((status == 137 || status == 152)); then
    fail "$1" "not done after $cpu_seconds s of all cores"
  elif ((status != 2)); then
    fail "$1" "status $status instead of 2"
  elif [[ -s $out ]]; then
    fail "$1" "something on stdout"
  elif [[ $(wc -l <"$err") -ne 1 ]]; then
    fail "$1" "not one line on stderr"
  elif ! grep -qE "^farcull: $2" "$err"; then
    fail "$1" "the message does not match '$2'"
  elif ! grep -qE '[^ ]; [^ ]' "$err"; then
    fail "$1" "no remedy"
  elif LC_ALL=C grep -q '[[:cntrl:]]' "$err"; then
    fail "$1" "control characters on stderr"
  fi
}

# bad CASE PATTERN ARGUMENTS...: a bad input, which also leaves the folder as it was.
bad() {
  local before after cpu=$cpu_seconds
  ((cases += 1))
  before=$(snapshot)
  launch "${@:3}"
  refused "$1" "$2"
  after=$(snapshot)
  if [[ $before != "$after" ]]; then
    fail "$1" "the folder changed: $(diff <(echo "$before") <(echo "$after") | tr '\n' '|')"
  fi
}

# bad_scene CASE PATTERN SCENE...: a scene that cannot be read, while outputs are asked for.
bad_scene() { bad "$1" "$2" run "${@:3}" --json old.json --pairs new.csv; }

# good CASE STATUS ARGUMENTS...: an answer of that status, with a message only where it is not 0.
good() {
  ((cases += 1))
  launch "${@:3}"
  if ((status != $2)); then
    fail "$1" "status $status instead of $2"
  elif (($2 == 0)) && [[ -s $err ]]; then
    fail "$1" "something on stderr"
  elif (($2 != 0)) && [[ $(wc -l <"$err") -ne 1 ]]; then
    fail "$1" "not one line on stderr"
  elif grep -q '[[:cntrl:]]' "$err"; then
    fail "$1" "control characters on stderr"
  fi
}

# expect CASE FILE PATTERN: a line of the file matches.
expect() {
  ((cases += 1))
  grep -qE -- "$3" "$2" || fail "$1" "$2 has no line that matches '$3'"
}

le32() { # NUMBER: its four bytes, lowest first
  local hex
  printf -v hex '\\x%02x\\x%02x\\x%02x\\x%02x' $(($1 & 255)) $(($1 >> 8 & 255)) \
    $(($1 >> 16 & 255)) $(($1 >> 24 & 255))
  # shellcheck disable=SC2059 # the format is what was just made
  printf "$hex"
}
le32s() { local n && for n in "$@"; do le32 "$n"; done; }

readonly nan=0x7fc00000 infinity=0x7f800000 one=0x3f800000 billion=1000000000

obj() { printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'v 0 0 1' "$@"; }
off() { printf '%s\n' OFF "4 ${1:-1} 0" '0 0 0' '1 0 0' '0 1 0' '0 0 1' "${@:2}"; }
ply_header() { # FORMAT VERTICES FACES
  printf '%s\n' ply "format $1 1.0" "element vertex $2" 'property float x' 'property float y' \
    'property float z' "element face $3" 'property list uchar int vertex_indices' end_header
}
ply() { # FACE-COUNT FACES...
  ply_header ascii 4 "$1"
  printf '%s\n' '0 0 0' '1 0 0' '0 1 0' '0 0 1' "${@:2}"
}
ply_binary() { # WORD: the x of the first vertex
  ply_header binary_little_endian 3 1
  le32s "$1" 0 0 "$one" 0 0 0 "$one" 0
  printf '\x03'
  le32s 0 1 2
}
stl() { # VERTEX...: one facet
  printf '%s\n' 'solid s' 'facet normal 0 0 1' 'outer loop'
  printf 'vertex %s\n' "$@"
  printf '%s\n' endloop endfacet 'endsolid s'
}
stl_binary() { # CLAIMED-COUNT WORD: one facet, the word its first coordinate
  head -c 80 /dev/zero
  le32 "$1"
  le32s 0 0 "$one" "$2" 0 0 "$one" 0 0 0 "$one" 0
  printf '\0\0'
}
garbage() { # 4 KiB of every byte, the same each time
  local i hex=
  for i in {0..255}; do printf -v hex '%s\\x%02x' "$hex" $(((i * 167 + 205) % 256)); done
  for i in {1..16}; do
    # shellcheck disable=SC2059
    printf "$hex"
  done
}

# answers CASE STATUS PATTERN ARGUMENTS...: an answer of that status on stdout, its first line
# matching.
answers() {
  ((cases += 1))
  launch "${@:4}"
  if ((status != $2)); then
    fail "$1" "status $status instead of $2: $(head -n 1 "$out")"
  elif ! grep -qE -- "$3" <<<"$(head -n 1 "$out")"; then
    fail "$1" "says: $(head -n 1 "$out")"
  fi
}
