# For tests that are scripts: a folder that is removed at the end, and a count of failures.
#   source script_lab.sh NAME TOOL...    the test's name, and the programs that it needs. Where one is
#                                        missing it is named, and the script ends with status 77.
# shellcheck shell=bash
lab_name=$1
shift
for tool in "$@"; do
  if ! command -v "$tool" >/dev/null; then
    echo "$lab_name: NOT RUN: $tool is missing (experiments/setup.sh installs it)"
    exit 77
  fi
done

work=$(mktemp -d)
# shellcheck disable=SC2064  # the folder's name as it is now
trap "rm -rf '$work'" EXIT
failures=0
fail() {
  echo "FAILED: $*" >&2
  failures=$((failures + 1))
}
