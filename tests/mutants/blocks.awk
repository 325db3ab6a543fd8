# Reads the lists of mutants; tests/mutants.sh describes their form. Files of the program are read relative to the current folder.
#   awk -f blocks.awk -v mode=list LIST...              a line for each block: name, file, program, tests, change, explained; by tabs
#   awk -f blocks.awk -v mode=check LIST...             a line for each violation of the form
#   awk -f blocks.awk -v mode=apply -v name=NAME LIST...  the block's file with the new text in place of the old one
#   awk -f blocks.awk -v mode=block -v name=NAME LIST...  the block, with the lines that it takes from the one before
function violation(text) { print at[n] ": " names[n] ": " text }

function whole(file,   text, line) {
  if (file in texts) return texts[file]
  text = ""
  while ((getline line < file) > 0) text = text line "\n"
  close(file)
  return texts[file] = text
}

# Where the old text begins; 0 where it is missing or stands twice, which `problem` then says.
function place(k,   text, from, rest) {
  problem = ""
  text = whole(field[k, "file"])
  if (text == "") problem = field[k, "file"] " is missing or empty"
  else if (field[k, "old"] == "") problem = "there is no old text"
  else {
    from = index(text, field[k, "old"])
    rest = substr(text, from + 1)
    if (!from) problem = "the old text is not in " field[k, "file"]
    else if (index(rest, field[k, "old"])) problem = "the old text stands more than once in " field[k, "file"]
  }
  return problem == "" ? from : 0
}

function finish(   k) {
  if (!n) return
  for (k in part) field[n, k] = part[k]
  split("", part)
}

# A line of the block before that this one leaves out.
function inherit(key) {
  if (key in part || field[n - 1, key] == "" || at[n - 1] != FILENAME) return
  part[key] = field[n - 1, key]
  raw[n] = raw[n] key ": " part[key] "\n"
}

# A block ends with its list.
FNR == 1 { open = 0 }
/^=== / {
  finish()
  open = 1
  at[++n] = FILENAME
  split($2, words, ":")
  names[n] = words[1]
  part["change"] = substr($0, length(names[n]) + 7)
  raw[n] = "=== " names[n] "\n"
  next
}
open && !/^file: / { inherit("file") }
open && /^[-+]/ && !("old" in part || "new" in part) {
  inherit("tests")
  raw[n] = raw[n] "change: " part["change"] "\n"
}
open { raw[n] = raw[n] $0 "\n" }
/^[-+]/ && open {
  key = /^-/ ? "old" : "new"
  before = key in part ? part[key] "\n" : ""
  part[key] = before substr($0, 2)
  next
}
open && /^[a-z]+: / {
  key = substr($1, 1, length($1) - 1)
  part[key] = substr($0, length(key) + 3)
  next
}
/^#/ || $0 == "" { next }
{ print FILENAME ":" FNR ": stands in no block: " $0; bad = 1 }

END {
  finish()
  total = n
  for (n = 1; n <= total; n++) {
    program = field[n, "program"] == "" ? "farcull_mutant_tests" : field[n, "program"]
    if (mode == "list") {
      print names[n] "\t" field[n, "file"] "\t" program "\t" field[n, "tests"] "\t" field[n, "change"] "\t" field[n, "explained"]
    } else if (mode == "check") {
      if (seen[names[n]]++) violation("a second block of this name")
      if (names[n] !~ /^[a-z0-9-]+$/) violation("a name has lower-case letters, digits and hyphens alone")
      if (field[n, "file"] !~ /^(core|offsets|verify)\//) violation("its file is not in core, offsets or verify")
      if (field[n, "tests"] == "") violation("it names no tests")
      if (field[n, "change"] !~ /^[A-Z].*[.]$/) violation("its change is no sentence")
      if (field[n, "old"] == field[n, "new"]) violation("it changes nothing")
      place(n)
      if (problem != "") violation(problem)
    } else if (names[n] == name) {
      found = 1
      if (mode == "block") printf "%s", raw[n]
      else {
        from = place(n)
        if (!from) { print names[n] ": " problem > "/dev/stderr"; exit 1 }
        text = whole(field[n, "file"])
        printf "%s%s%s", substr(text, 1, from - 1), field[n, "new"], substr(text, from + length(field[n, "old"]))
      }
    }
  }
  if (name != "" && !found) { print "no block " name > "/dev/stderr"; exit 1 }
  if (bad) exit 1
}
