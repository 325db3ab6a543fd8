#!/usr/bin/env bash
# Checks the layout of the repository: which folder includes which, which libraries a folder uses,
# which file starts threads, that core names no option of the command line, that a type has its name
# alone in its namespace, where source files lie, and that the paths named in the pages exist.
#   tests/layout_test.sh [ROOT]          checks ROOT (default: this repository). It prints one line
#                                        for each violation, and then exits with status 1.
#   tests/layout_test.sh --graph [ROOT]  prints the folders by level and the arrows between them
#   tests/layout_test.sh --self-test     breaks each rule in a temporary tree and checks that the
#                                        violation is reported, with its reason
set -euo pipefail

self=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)/${BASH_SOURCE[0]##*/}
# A git hook sets these for its own repository. The check may look at another one.
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE

# Folder, and the folders that it includes. A folder may include itself, what its row names, and
# whatever those may include; a * stands for every folder. A file belongs to the longest folder of
# the table that its path begins with.
export may_include='
core/base
core/scene                 core/base
core/boxes                 core/scene
core/view                  core/boxes
core/canvas                core/view
core/cull                  core/canvas
core/sweep                 core/boxes
core/pairs                 core/view
core/proximity             core/boxes
core/voronoi               core/scene
core/native                core/canvas
core/gl                    core/cull core/sweep core/pairs core/proximity core/voronoi
offsets                    core/native
verify/certificate         core/scene
verify                     core/canvas verify/certificate
experiments/system         core/base
experiments/scenes/mesh    experiments/system core/gl
experiments/scenes/cloth   experiments/scenes/mesh
experiments/scenes/builtin experiments/scenes/mesh experiments/scenes/cloth
experiments/scenes         experiments/scenes/builtin
experiments/method         core/gl core/proximity offsets verify
experiments/library        experiments/method
experiments/record         experiments/method experiments/system
experiments/tiles          experiments/scenes experiments/record
experiments/generators     experiments/scenes
experiments/suite          experiments/generators verify
experiments/peers          experiments/suite experiments/library
experiments/measure        experiments/record experiments/peers
experiments/lemma          experiments/generators experiments/record
experiments/studies        experiments/measure experiments/lemma
experiments/picture        experiments/measure
experiments/command        experiments/studies experiments/picture experiments/library experiments/tiles
experiments/python         experiments/library experiments/picture
tests                      *
'

# Folder, and files or folders that it must not include although the table above lets it. The
# verification shares no code with the culling that it checks: neither the boxes, with their joins
# and trees, nor the plan nor the error budget.
export must_not_include='
verify             core/boxes core/view/budget core/view/plan core/view/regions
verify/certificate core/boxes core/view/budget core/view/plan core/view/regions
'

# Library, a regular expression for its headers, and who may include them: folders of the table, or
# with a * all files whose path begins so.
export libraries='
EGL/OpenGL ^(epoxy|EGL|GL|GLES[0-9]*|KHR)/ core/gl tests/faults/*
CGAL       ^CGAL/                          verify experiments/peers/cgal* experiments/peers/contest_cgal* tests
GMP/MPFR   ^(gmp|gmpxx|mpfr)\.h$           verify verify/certificate tests
zlib       ^zlib\.h$                       experiments/scenes/mesh tests
'

export most_folders=20 # in experiments/
ours=(core offsets verify experiments tests)
top=(CMakeLists.txt README.md docs "${ours[@]}")
source_names=(-name '*.h' -o -name '*.cpp' -o -name '*.glsl' -o -name '*.vert' -o -name '*.frag'
  -o -name '*.comp')

# Those of the folders named that are there.
present() {
  local folder
  for folder; do
    if [[ -d $folder ]]; then printf '%s\n' "$folder"; fi
  done
}

# Prints "file PATH" for every source file, then "include FILE:LINE:INCLUDED" for every #include,
# with either kind of quotes. Shaders are among the files, since C++ includes some of them.
sources() {
  local -a there
  mapfile -t there < <(present "${ours[@]}")
  ((${#there[@]})) || return 0
  find "${there[@]}" -type f \( "${source_names[@]}" \) -printf 'file %p\n' | LC_ALL=C sort
  find "${there[@]}" -type f \( "${source_names[@]}" \) -exec \
    grep -HnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]' {} + | LC_ALL=C sort -t: -k1,1 -k2,2n |
    sed -E 's/^([^:]*:[0-9]+:)[^<"]*[<"]([^>"]*).*/include \1\2/'
}

# Reads the output of `sources`. With mode=check it prints the violations, then a line "includes N";
# with mode=graph the levels and arrows.
# shellcheck disable=SC2016  # the dollars are those of awk
judge='
function folder_of(path) {
  while (sub(/\/[^\/]*$/, "", path)) if (path in row) return path
  return ""
}
# May from include to? Follows the rows of the table, which has no cycle.
function allows(from, to,   n, i, names) {
  if (from == to || row[from] == "*") return 1
  n = split(row[from], names, " ")
  for (i = 1; i <= n; i++) if (allows(names[i], to)) return 1
  return 0
}
# One more than the highest level among the folders that it includes as the table allows.
function level_of(folder,   i, to, high) {
  if (folder in level) return level[folder]
  high = -1
  for (i = 1; i <= folder_count; i++) {
    to = folders[i]
    if ((folder, to) in arrow && allows(folder, to) && level_of(to) > high) high = level_of(to)
  }
  return level[folder] = high + 1
}
# The path that `beside` and `path` make together, without . and ..
function join_paths(beside, path,   n, i, parts, out, depth) {
  n = split(beside "/" path, parts, "/")
  depth = 0
  for (i = 1; i <= n; i++) {
    if (parts[i] == "..") depth--
    else if (parts[i] != ".") out[++depth] = parts[i]
  }
  path = out[1]
  for (i = 2; i <= depth; i++) path = path "/" out[i]
  return path
}
function stem(path) { sub(/\.(h|cpp)$/, "", path); return path }
function violation(text) { if (mode == "check") print text }
# Tarjan: files that include each other are those of one strongly connected component.
function visit(v,   n, i, names, w, members, size) {
  order[v] = low[v] = ++visited
  stack[++stacked] = v
  on_stack[v] = 1
  n = split(below[v], names, " ")
  for (i = 1; i <= n; i++) {
    w = names[i]
    if (!(w in order)) {
      visit(w)
      if (low[w] < low[v]) low[v] = low[w]
    } else if (on_stack[w] && order[w] < low[v]) low[v] = order[w]
  }
  if (low[v] != order[v]) return
  size = 0
  do {
    w = stack[stacked--]
    on_stack[w] = 0
    members = w (size++ ? ", " members : "")
  } while (w != v)
  if (size > 1) violation(v ": a cycle of includes, with .h and .cpp of one name as one file: " members)
}
function library(file, line, included,   i, n, who, good, folder) {
  folder = folder_of(file)
  for (i = 1; i <= library_rows; i++) {
    if (included !~ headers[i]) continue
    good = 0
    n = split(users[i], who, " ")
    while (n) {
      if (who[n] == folder && index(users[i], folder "/*") == 0) good = 1
      if (sub(/\*$/, "", who[n]) && index(file, who[n]) == 1) good = 1
      n--
    }
    if (!good)
      violation(file ":" line ": includes " included ": only " users[i] " may use " named[i])
    return 1
  }
  return 0
}
BEGIN {
  rows = split(ENVIRON["may_include"], lines, "\n")
  for (i = 1; i <= rows; i++) {
    if (split(lines[i], words, " ") == 0) continue
    folder = words[1]
    sub(/^[^ ]+ */, "", lines[i])
    row[folder] = lines[i]
    folders[++folder_count] = folder
  }
  rows = split(ENVIRON["must_not_include"], lines, "\n")
  for (i = 1; i <= rows; i++) {
    n = split(lines[i], words, " ")
    for (j = 2; j <= n; j++) denied[words[1], words[j]] = 1
  }
  rows = split(ENVIRON["libraries"], lines, "\n")
  for (i = 1; i <= rows; i++) {
    if (split(lines[i], words, " ") == 0) continue
    named[++library_rows] = words[1]
    headers[library_rows] = words[2]
    sub(/^[^ ]+ +[^ ]+ +/, "", lines[i])
    users[library_rows] = lines[i]
  }
}
$1 == "file" {
  sub(/^file /, "")
  exists[$0] = 1
  files++
  directory = $0
  sub(/\/[^\/]*$/, "", directory)
  folder = folder_of($0)
  if (folder == "") violation($0 ": lies directly in " directory ", which is no folder of the table")
  else has_files[folder] = 1
  if (directory ~ /^experiments\// && !(directory in counted)) {
    counted[directory] = 1
    in_experiments++
  }
  next
}
{
  sub(/^include /, "")
  file = $0; sub(/:.*/, "", file)
  line = substr($0, length(file) + 2); sub(/:.*/, "", line)
  included = substr($0, length(file) + length(line) + 3)
  includes++
  directory = file; sub(/\/[^\/]*$/, "", directory)
  # An include relative to its own folder is the file that it means, however it is spelled.
  beside = join_paths(directory, included)
  if (beside in exists) included = beside
  if (library(file, line, included)) next
  if (included !~ /^(core|offsets|verify|experiments|tests)\//) next
  a = stem(file)
  b = stem(included)
  if (a != b && !((a, b) in edge)) {
    edge[a, b] = 1
    if (!(a in below)) nodes[++node_count] = a
    below[a] = below[a] " " b
  }
  from = folder_of(file)
  to = folder_of(included)
  if (from == "") next # reported above
  if (from != to && to != "") arrow[from, to] = 1
  place = file ":" line ": includes " included ": "
  if (to == "") violation(place "it lies in no folder of the table")
  else if ((from, b) in denied || (from, to) in denied)
    violation(place "the verification shares no code with the culling that it checks")
  else if (!allows(from, to))
    violation(place "the table does not let " from " include " to)
}
END {
  if (in_experiments > ENVIRON["most_folders"])
    violation("experiments: " in_experiments " folders hold source files; at most " \
              ENVIRON["most_folders"] " may")
  for (i = 1; i <= node_count; i++) if (!(nodes[i] in order)) visit(nodes[i])
  if (mode == "check") {
    print "includes " includes + 0
    exit
  }
  for (i = 1; i <= folder_count; i++) {
    folder = folders[i]
    if (!(folder in has_files) || folder == "tests") continue
    there++
    high = level_of(folder)
    at_level[high] = at_level[high] (at_level[high] == "" ? "" : ", ") folder
    if (high > top_level) top_level = high
  }
  print "Folders by level. A folder includes only folders of lower levels."
  for (i = top_level; i >= 0; i--) printf "%5d  %s\n", i, at_level[i]
  print "\nArrows: a folder, and those that it includes directly. Left out are the arrows to folders"
  print "that it also reaches through another folder."
  for (i = 1; i <= folder_count; i++) {
    from = folders[i]
    if (from == "tests" || !(from in has_files)) continue
    text = ""
    for (j = 1; j <= folder_count; j++) {
      to = folders[j]
      if (!((from, to) in arrow)) continue
      arrows++
      if (!allows(from, to)) {
        against++
        upward += level_of(to) >= level_of(from)
        text = text (text == "" ? "" : ", ") to " (against the table)"
        continue
      }
      through = 0
      for (k = 1; k <= folder_count && !through; k++) {
        via = folders[k]
        through = via != to && via != from && (from, via) in arrow && allows(from, via) && reaches(via, to)
      }
      if (through) continue
      drawn++
      text = text (text == "" ? "" : ", ") to
    }
    if (text != "") printf "  %-27s -> %s\n", from, text
  }
  printf "\n%d folders (%d in experiments, at most %d), %d levels, %d arrows (%d drawn)", there,
         in_experiments, ENVIRON["most_folders"], top_level + 1, arrows, drawn
  printf ", %d against the table, %d upward\n", against, upward
}
# Does a chain of arrows that the table allows lead from one folder to another?
function reaches(from, to,   k) {
  if ((from, to) in arrow && allows(from, to)) return 1
  for (k = 1; k <= folder_count; k++)
    if ((from, folders[k]) in arrow && folders[k] != from && allows(from, folders[k]) &&
        reaches(folders[k], to)) return 1
  return 0
}
'

# Prints "FILE:LINE:TEXT" wherever the product starts a thread, except in core/base/parallel.cpp.
thread_starts() {
  grep -rnE 'std::(jthread|async|thread)([^:_[:alnum:]]|$)|pthread_create' \
    core offsets verify experiments --include='*.h' --include='*.cpp' |
    grep -v '^core/base/parallel\.cpp:' || true
}

# Prints a violation for each type that two files define in one namespace: to a linker they are one
# type, and which of its functions a program gets is chance (tests/odr.sh asks the linker). Types of
# anonymous namespaces, nested types and specializations are no such types. A name that one file
# defines twice stands in the branches of an #if.
type_names() {
  local -a there
  mapfile -t there < <(present "${ours[@]}")
  ((${#there[@]})) || return 0
  # shellcheck disable=SC2016  # the dollars are those of awk
  find "${there[@]}" -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.inl' \) -print0 | LC_ALL=C sort -z |
    xargs -0r awk '
      # Forgets what the last file left open.
      FNR == 1 { depth = blocks = hidden = comment = 0; statement = raw = ""; directive = 0 }
      raw != "" {
        at = index($0, raw)
        if (!at) next
        $0 = substr($0, at + length(raw))
        raw = ""
      }
      directive || /^[ \t]*#/ { directive = /\\$/; next }
      {
        # Without strings, characters and comments. A raw string may end in a later line.
        text = ""
        while (match($0, /R"[^ ()\\"]*\(|"([^"\\]|\\.)*"|[^0-9A-Za-z]\047([^\047\\]|\\.)+\047|\/\/|\/\*|\*\//)) {
          found = substr($0, RSTART, RLENGTH)
          if (!comment) text = text substr($0, 1, RSTART - 1) " "
          $0 = substr($0, RSTART + RLENGTH)
          if (found == "*/") comment = 0
          else if (comment) continue
          else if (found == "/*") comment = 1
          else if (found == "//") $0 = ""
          else if (found ~ /^R"/) {
            raw = ")" substr(found, 3, length(found) - 3) "\""
            at = index($0, raw)
            if (!at) { $0 = ""; break }
            $0 = substr($0, at + length(raw))
            raw = ""
          } else text = text " \"\" "
        }
        if (!comment) text = text $0
        while (match(text, /[{};]/)) {
          mark = substr(text, RSTART, 1)
          if (!blocks) statement = statement " " substr(text, 1, RSTART - 1)
          text = substr(text, RSTART + 1)
          if (mark == "{") opened()
          else if (mark == "}") closed()
          if (!blocks) statement = ""
        }
        if (!blocks) statement = statement " " text
      }
      function opened(   words, name) {
        if (blocks) { ++blocks; return }
        words = statement
        gsub(/\[\[[^\]]*\]\]|alignas *\([^)]*\)/, " ", words)
        gsub(/[ \t]+/, " ", words)
        sub(/ $/, "", words)
        if (words ~ /^ (inline )?namespace( [A-Za-z0-9_:]+)?$/ || words ~ /^ extern ""$/) {
          name = words
          sub(/^ (inline )?(namespace|extern) ?/, "", name)
          inside[++depth] = name == "\"\"" || name == "" ? "" : name "::"
          anonymous[depth] = name == ""
          hidden += anonymous[depth]
          return
        }
        blocks = 1
        if (hidden || !match(words, / (struct|class|union|enum|enum class|enum struct) [A-Za-z0-9_]+( final)?( :[^:].*)?$/))
          return
        name = substr(words, RSTART)
        sub(/^ (enum )?(struct|class|union|enum) /, "", name)
        sub(/[^A-Za-z0-9_].*/, "", name)
        if (words ~ /[(=]/ && words !~ /^ template/) return
        for (level = depth; level > 0; --level) name = inside[level] name
        if (!(name in file)) {
          file[name] = FILENAME
          place[name] = FILENAME ":" FNR
        } else if (file[name] != FILENAME)
          print FILENAME ":" FNR ": defines " name ", and so does " place[name] ": a type name once a namespace"
      }
      function closed() {
        if (blocks) { --blocks; return }
        hidden -= anonymous[depth--]
      }'
}

# Prints a violation for each path in README.md, docs/*.md and docs/results/*.md that does not exist: paths in
# backticks and in indented blocks that begin with one of our folders, and the targets of links.
# NAME and * in a path stand for any text. A path without an ending, such as verify/accounting,
# means the files of that name with any ending. A page may name a file that it tells the reader to
# make: "the new file `PATH`", there and below.
page_paths() {
  local -a there pages
  mapfile -t there < <(present "${ours[@]}" docs)
  mapfile -t pages < <(find README.md docs -maxdepth 2 -name '*.md' 2>/dev/null | LC_ALL=C sort)
  ((${#pages[@]})) || return 0
  # shellcheck disable=SC2016  # the dollars are those of awk
  find README.md CMakeLists.txt "${there[@]}" -printf '%p\n' 2>/dev/null |
    awk '
      function known(path,   pattern, name) {
        if (path in exists || (FILENAME, path) in made) return 1
        if (path !~ /NAME|\*/) return 0
        pattern = path
        gsub(/[.]/, "[.]", pattern)
        gsub(/NAME|\*/, "[^/]*", pattern)
        for (name in exists) if (name ~ "^" pattern "$") return 1
        return 0
      }
      function words_of(text,   n, i, words) {
        n = split(text, words, /[^A-Za-z0-9_.\/*@%-]+/)
        for (i = 1; i <= n; i++) {
          sub(/[.]+$/, "", words[i])
          sub(/\/$/, "", words[i])
          if (words[i] ~ /^(core|offsets|verify|experiments|tests|docs)\// && !known(words[i]))
            print FILENAME ":" FNR ": names " words[i] ", which does not exist"
        }
      }
      FILENAME == "-" {
        exists[$0] = 1
        if (sub(/[.][^.\/]*$/, "")) exists[$0] = 1
        next
      }
      match($0, /new file `[^`]*`/) { made[FILENAME, substr($0, RSTART + 10, RLENGTH - 11)] = 1 }
      FNR == 1 || /^$/ { inside = 0 } # a span in backticks may go on in the next line, but not further
      /^    / && !inside { words_of($0); next }
      {
        n = split($0, spans, "`")
        for (i = 1; i <= n; i++) {
          if (inside) words_of(spans[i])
          if (i < n) inside = !inside
        }
        rest = $0
        while (match(rest, /\]\([^)]*\)/)) {
          target = substr(rest, RSTART + 2, RLENGTH - 3)
          rest = substr(rest, RSTART + RLENGTH)
          sub(/#.*/, "", target)
          if (target == "" || target ~ /^[a-z]+:/) continue
          path = FILENAME
          sub(/[^\/]*$/, target, path)
          while (sub(/[^\/]+\/[.][.]\//, "", path)) {}
          sub(/\/$/, "", path)
          if (!known(path)) print FILENAME ":" FNR ": links to " target ", which does not exist"
        }
      }' - "${pages[@]}"
}

# The names at the top, without dot files: those that git has or would add, or all but build folders
# if there is no git.
names_at_top() {
  local files name
  if [[ -e .git ]] && files=$(git ls-files --cached --others --exclude-standard 2>/dev/null); then
    cut -d/ -f1 <<<"$files" | sort -u | while IFS= read -r name; do
      # Git still lists a file whose removal is not committed yet.
      if [[ -e $name ]]; then printf '%s\n' "$name"; fi
    done
  else
    find . -mindepth 1 -maxdepth 1 ! -name 'build*' -printf '%f\n' | sort
  fi | grep -v '^\.' || true
}

# Prints every violation of the rules about the top level.
top_level() {
  local names name
  names=$(names_at_top)
  for name in "${top[@]}"; do
    if ! grep -qxF -- "$name" <<<"$names"; then echo "$name: missing at the top level"; fi
  done
  while IFS= read -r name; do
    if [[ -n $name && " ${top[*]} " != *" $name "* ]]; then
      echo "$name: the top level holds nothing but ${top[*]}"
    fi
  done <<<"$names"
}

# Texts of core that name an option as the command line writes it.
option_words() {
  [[ -d core ]] || return 0
  { grep -rnE --include='*.cpp' --include='*.h' '"[^"]*--[a-z]' core || true; } | LC_ALL=C sort |
    sed -E 's/^([^:]*:[0-9]+:).*/\1 names an option of the command line: write {name} (core\/base\/parameter.h)/'
}

check() {
  local judged violations
  local -i seen
  cd "$1"
  judged=$(sources | awk -v mode=check "$judge")
  seen=${judged##*includes }
  violations=$(
    sed '$d' <<<"$judged"
    if ((seen == 0)); then
      echo "no #include found under $1: this is not the repository, or the test reads it wrongly"
    fi
    thread_starts | sed -E \
      's/^([^:]*:[0-9]+:).*/\1 starts a thread: only core\/base\/parallel.cpp does, which sets the arithmetic of each/'
    option_words
    type_names
    page_paths
    top_level
  )
  if [[ -n $violations ]]; then
    printf '%s\n' "$violations"
    return 1
  fi
  echo "layout: $seen includes obey the table"
}

# ---- self-test: a small tree that obeys every rule, then one violation at a time ----

# put FILE INCLUDE: a file with one include, which is spelled with its quotes or brackets.
put() {
  mkdir -p "$(dirname "$1")"
  printf '// a file of the self-test\n#include %s\n' "$2" >"$1"
}

# Runs the check on the tree as a fresh process. Prints "pass"; or "caught" if it fails with a
# single line, which begins with $1 and contains $2.
verdict() {
  local output status=0
  output=$(bash "$self" . 2>&1) || status=$?
  if ((status == 0)); then
    echo pass
  elif ((status == 1)) && [[ $(grep -c . <<<"$output") == 1 && $output == "$1:"*"$2"* ]]; then
    echo caught
  else
    echo "status $status: $output"
  fi
}

failures=0
# expect CASE VERDICT FOUND
expect() {
  if [[ $3 == "$2" ]]; then return; fi
  echo "self-test: $1: expected $2, got: $3"
  failures=$((failures + 1))
}

# breaks FILE INCLUDE REASON: with FILE in place the check must fail, for this reason and no other.
breaks() {
  put "$1" "$2"
  expect "$1 includes $2" caught "$(verdict "$1" "$3")"
  rm "$1"
}

# forbids FOLDER OTHER: a file of FOLDER must not include one of OTHER.
forbids() {
  breaks "$1/file.cpp" "\"$2/other.h\"" "the table does not let $1 include $2"
}

# keeps FILE INCLUDE: the check must accept FILE.
keeps() {
  put "$1" "$2"
  expect "$1 includes $2" pass "$(verdict "$1" '')"
  rm "$1"
}

break_includes() {
  local name
  forbids core/base core/scene
  forbids core/scene core/view
  forbids core/scene core/boxes
  forbids core/boxes core/view
  forbids core/boxes core/pairs
  forbids core/proximity core/pairs
  forbids core/voronoi core/proximity
  forbids core/scene offsets
  forbids core/scene experiments/command
  forbids core/view core/canvas
  forbids core/view core/cull
  forbids core/view verify
  forbids core/canvas core/gl
  forbids core/canvas offsets
  forbids core/cull offsets
  forbids core/cull core/sweep
  forbids core/cull experiments/command
  forbids core/pairs verify
  forbids core/pairs core/canvas
  forbids core/gl offsets
  forbids core/gl verify
  forbids core/gl experiments/method
  forbids offsets core/gl
  forbids offsets core/pairs
  forbids offsets verify
  forbids offsets experiments/command
  forbids verify offsets
  forbids verify core/cull
  forbids verify core/sweep
  forbids verify core/pairs
  forbids verify core/gl
  forbids verify experiments/system
  forbids verify/certificate verify
  forbids verify/certificate core/view
  forbids experiments/system core/scene
  forbids experiments/scenes experiments/record
  forbids experiments/scenes/mesh experiments/scenes
  forbids experiments/scenes/cloth experiments/scenes/builtin
  forbids experiments/method experiments/record
  forbids experiments/method experiments/scenes
  forbids experiments/library experiments/record
  forbids experiments/record experiments/scenes
  forbids experiments/peers experiments/measure
  forbids experiments/lemma experiments/measure
  forbids experiments/generators experiments/suite
  forbids experiments/suite experiments/lemma
  forbids experiments/peers experiments/studies
  forbids experiments/studies experiments/command
  forbids experiments/picture experiments/studies
  for name in core/base core/view core/cull core/gl offsets verify experiments/command; do
    forbids "$name" tests
  done
  for name in core/boxes/join core/boxes/block_join core/view/budget core/view/plan; do
    breaks verify/accounting.cpp "\"$name.h\"" 'shares no code'
  done
  breaks verify/certificate/pair.cpp '"core/boxes/join.h"' 'shares no code'
  breaks core/scene/scene.cpp '"core/other/other.h"' 'in no folder of the table'

  # The same with other spellings, in other files and in deeper folders.
  breaks verify/canvas.cpp '"../offsets/obb.glsl"' 'let verify include offsets'
  breaks core/view/view.cpp '"../canvas/canvas.h"' 'let core/view include core/canvas'
  breaks verify/canvas.h '<offsets/obb.h>' 'let verify include offsets'
  breaks verify/deep/canvas.h '"offsets/obb.h"' 'let verify include offsets'
  breaks core/gl/canvas/cull.frag '"offsets/obb.glsl"' 'let core/gl include offsets'
  printf '  #  include\t"offsets/obb.h" // why\r\n' >verify/odd.h
  expect "an include with odd spaces" caught "$(verdict verify/odd.h 'let verify include offsets')"
  rm verify/odd.h

  keeps core/scene/file.cpp '"core/base/error.h"'
  keeps core/view/file.cpp '"core/scene/scene.h"'
  keeps core/view/file.cpp '"core/boxes/join.h"'
  keeps core/canvas/file.cpp '"core/base/error.h"'
  keeps core/gl/file.cpp '"core/canvas/canvas.h"'
  keeps core/gl/file.cpp '"generated/commit.h"'
  keeps offsets/file.cpp '"core/view/budget.h"'
  keeps verify/file.cpp '"core/canvas/canvas.h"'
  keeps verify/file.cpp '"verify/certificate/json.h"'
  keeps experiments/method/file.cpp '"core/gl/canvas/canvas.h"'
  keeps experiments/suite/file.cpp '"verify/certificate/integer_pair.h"'
  keeps experiments/peers/file.cpp '"experiments/suite/reader.h"'
  keeps experiments/peers/contest_cgal.cpp '<CGAL/Kernel.h>'
  keeps experiments/picture/file.cpp '"experiments/measure/compare.h"'
  keeps experiments/command/file.cpp '"experiments/studies/store.h"'
  keeps experiments/command/file.cpp '"experiments/library/farcull.h"'
  keeps tests/verify/file_test.cpp '"offsets/obb.glsl"'
}

break_libraries() {
  local name
  for name in core/scene core/canvas core/cull offsets verify experiments/command tests/core/gl; do
    breaks "$name/file.cpp" '<epoxy/gl.h>' 'may use EGL/OpenGL'
    breaks "$name/file.cpp" '<EGL/egl.h>' 'may use EGL/OpenGL'
  done
  for name in core/scene core/pairs core/gl offsets verify/certificate experiments/command \
    experiments/peers; do
    breaks "$name/file.cpp" '<CGAL/box_intersection_d.h>' 'may use CGAL'
  done
  for name in core/scene core/gl offsets experiments/command experiments/peers; do
    breaks "$name/file.cpp" '<gmpxx.h>' 'may use GMP/MPFR'
    breaks "$name/file.cpp" '<mpfr.h>' 'may use GMP/MPFR'
  done
  keeps core/gl/file.cpp '<epoxy/egl.h>'
  keeps tests/faults/lost_call_test.cpp '<epoxy/gl.h>'
  keeps verify/file.cpp '<gmpxx.h>'
  keeps verify/certificate/file.cpp '<gmpxx.h>'
  keeps tests/verify/file_test.cpp '<CGAL/Kernel.h>'
  keeps experiments/peers/cgal.cpp '<CGAL/Kernel.h>'
}

break_cycles() {
  local both='a cycle of includes, with .h and .cpp of one name as one file: '
  put core/view/left.h '"core/view/right.h"'
  put core/view/right.h '"core/view/left.h"'
  expect "two headers" caught "$(verdict core/view/left "${both}core/view/left, core/view/right")"
  # The cycle closes through a source file.
  put core/view/right.h '<vector>'
  put core/view/right.cpp '"core/view/left.h"'
  expect "a header and a source" caught "$(verdict core/view/left "$both")"
  put core/view/right.cpp '"middle.h"'
  put core/view/middle.h '"core/view/left.h"'
  expect "three files" caught "$(verdict core/view/left "$both")"
  put core/view/middle.h '<vector>'
  expect "a chain" pass "$(verdict '' '')"
  rm core/view/{left,middle,right}.*
}

break_places() {
  local -i i
  put core/file.cpp '<vector>'
  expect "a source file in core" caught "$(verdict core/file.cpp 'lies directly in core')"
  rm core/file.cpp
  put experiments/file.h '<vector>'
  expect "a header in experiments" caught "$(verdict experiments/file.h 'lies directly in experiments')"
  rm experiments/file.h
  put experiments/unknown/file.h '<vector>'
  expect "a folder beyond the table" caught "$(verdict experiments/unknown/file.h 'no folder of the table')"
  rm -r experiments/unknown
  for ((i = 0; i < most_folders; ++i)); do put "experiments/measure/more$i/file.h" '<vector>'; done
  expect "too many folders" caught "$(verdict experiments "at most $most_folders may")"
  rm -r experiments/measure
}

break_threads() {
  local text
  for text in 'std::jthread t(work);' 'auto f = std::async(work);' 'std::vector<std::thread> t;' \
    'pthread_create(&t, nullptr, work, nullptr);'; do
    printf '#include <vector>\n%s\n' "$text" >verify/threads.cpp
    expect "$text" caught "$(verdict verify/threads.cpp 'starts a thread')"
  done
  printf '#include <thread>\nunsigned n = std::thread::hardware_concurrency();\n' >verify/threads.cpp
  expect "the number of cores" pass "$(verdict '' '')"
  rm verify/threads.cpp
  put core/base/parallel.cpp '<thread>'
  echo 'std::jthread t(work);' >>core/base/parallel.cpp
  expect "core/base/parallel.cpp starts threads" pass "$(verdict '' '')"
  rm core/base/parallel.cpp
}

break_options() {
  printf '#include <vector>\nconst char* s = "use --device cpu";\n' >core/view/words.cpp
  expect "an option in a text of core" caught "$(verdict core/view/words.cpp 'names an option')"
  printf '#include <vector>\nconst char* s = "use {device} cpu"; int i = 3; int j = i--;\n' >core/view/words.cpp
  expect "a parameter in a text of core" pass "$(verdict '' '')"
  rm core/view/words.cpp
}

# types FIRST SECOND VERDICT: two files in which these types are defined.
types() {
  printf '#include <vector>\n%s\n' "$1" >verify/first.h
  printf '#include <vector>\n%s\n' "$2" >verify/second.cpp
  expect "types '$1' and '$2'" "$3" \
    "$(verdict verify/second.cpp 'so does verify/first.h:2: a type name once a namespace')"
  rm verify/first.h verify/second.cpp
}

break_types() {
  local in='namespace farcull {' text
  for text in 'class A {};' 'struct A final : B<int> {};' 'enum class A : int { x };' 'template <class T = int> struct A {};' \
    'struct alignas(64) [[nodiscard]] A {};' 'const char* s = "{\"}"; struct A {};' "char c = '{'; struct A {};" \
    '/* { */ struct A {}; // }' 'const int n = 1'"'"'000; struct A {};' 'int f(int x) { return x; } struct A {};' \
    $'const char* s = R"(\n{)"; struct A {};' $'\n#define X {\\\n{\nstruct A {};'; do
    types "$in struct A {}; }" "$in $text }" caught
  done
  types "namespace farcull::deep { struct A {}; }" "$in namespace deep { struct A {}; } }" caught
  types "$in struct A {}; }" "$in namespace deep { struct A {}; } }" pass
  types "$in struct A {}; }" "$in namespace { struct A {}; } }" pass
  types "$in struct A {}; }" "$in struct B { struct A {}; }; }" pass
  types "$in struct A {}; }" "$in struct A; struct B::A {}; template <> struct A<int> {}; }" pass
  types "$in struct A {}; }" "$in void f() { struct A {}; } struct A* g() {} }" pass
}

# page TEXT VERDICT REASON: a page that says TEXT.
page() {
  printf '%s\n' "$1" >docs/page.md
  expect "a page that says $1" "$2" "$(verdict docs/page.md "$3")"
  rm docs/page.md
}

break_pages() {
  local gone='which does not exist'
  # shellcheck disable=SC2016  # the backticks are those of the page
  {
    page 'The file `core/base/gone.h`.' caught "core/base/gone.h, $gone"
    page 'The folder `tests/gone/`.' caught "tests/gone, $gone"
    page 'Run `bash tests/gone.sh --all` twice.' caught "tests/gone.sh, $gone"
    page $'Run `bash\ntests/gone.sh`.' caught "tests/gone.sh, $gone"
    page '    bash experiments/gone.sh' caught "experiments/gone.sh, $gone"
    page 'Any `offsets/gone_*.glsl`.' caught "$gone"
    page 'In the new file `core/base/made.h`: see `core/base/made.h`.' pass ''
    page $'See `core/base/made.h`.\n\nIn the new file `core/base/made.h`:' caught "core/base/made.h, $gone"
    page 'See [this](gone.md#part).' caught "gone.md, $gone"
    page 'See `core/base/error.h`, `core/base/error`, `core/`, `offsets/NAME.glsl`, `verify/*.h`.' pass ''
    page 'See [this](index.md), [that](../README.md), [there](https://example.org/gone) and [here](#gone).' pass ''
    page 'Options `--report`, `{"mesh": "core"}`, `x/core/y`, and core/gone without marks.' pass ''
  }
  # shellcheck disable=SC2016
  printf 'The file `verify/gone.h`.\n' >README.md
  expect "a wrong path in README.md" caught "$(verdict README.md "$gone")"
  echo top >README.md
}

# What the top level must refuse.
break_top_level() {
  local name
  echo note >notes.txt
  expect "a file too many" caught "$(verdict notes.txt 'the top level holds nothing but')"
  rm notes.txt
  mkdir extra
  echo note >extra/note
  expect "a folder too many" caught "$(verdict extra 'the top level holds nothing but')"
  rm -r extra
  for name in CMakeLists.txt README.md docs; do
    mv "$name" build/
    expect "$name gone" caught "$(verdict "$name" 'missing at the top level')"
    mv "build/$name" .
  done
}

self_test() {
  local tree name graph
  tree=$(mktemp -d)
  # shellcheck disable=SC2064  # the folder's name as it is now
  trap "rm -rf '$tree'" EXIT
  cd "$tree"
  echo top >CMakeLists.txt
  echo top >README.md
  mkdir docs build
  echo page >docs/index.md
  echo junk >build/junk
  for name in base/error scene/scene view/view view/budget canvas/canvas cull/cull gl/canvas; do
    put "core/$name.h" '<vector>'
  done
  put offsets/obb.glsl '"core/base/shim.h"'
  put offsets/obb.h '<vector>'
  put verify/exact.h '<CGAL/Kernel.h>'
  put experiments/method/run.cpp '"offsets/obb.h"'
  put tests/all_test.cpp '"verify/exact.h"'
  expect "the tree that obeys" pass "$(verdict '' '')"
  graph=$(bash "$self" --graph .)
  if [[ $graph != *'experiments/method          -> offsets'*', 0 upward'* ]]; then
    expect "the graph" 'an arrow from method to offsets, none upward' "$graph"
  fi
  put core/base/error.h '"core/view/view.h"'
  graph=$(bash "$self" --graph .)
  if [[ $graph != *'core/view (against the table)'*', 1 upward'* ]]; then
    expect "the graph" 'an arrow upward' "$graph"
  fi
  put core/base/error.h '<vector>'

  break_includes
  break_libraries
  break_cycles
  break_places
  break_threads
  break_options
  break_types
  break_pages
  # The top level, as a plain folder and as a git checkout.
  break_top_level
  if command -v git >/dev/null; then
    printf '/build*/\n' >.gitignore
    git -c init.defaultBranch=main init -q .
    expect "the tree that obeys, in git" pass "$(verdict '' '')"
    break_top_level
  fi

  rm -rf core offsets verify experiments tests .git
  mkdir "${ours[@]}"
  expect "a tree without a file" caught "$(verdict 'no #include found under .' '')"
  if ((failures)); then return 1; fi
  echo "layout: every rule is caught when it is broken"
}

root=$(dirname -- "$self")/..
case ${1-} in
  --self-test) self_test ;;
  --graph)
    cd "${2:-$root}"
    sources | awk -v mode=graph "$judge"
    ;;
  *) check "${1:-$root}" ;;
esac
