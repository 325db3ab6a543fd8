# The page with its table anew, from verdicts (tests/mutants.sh): name, file, change, explained, result, seconds; by tabs.
# begin, end: the lines of the page between which the table stands; page: the page as it is.
$1 ~ /^control-/ { next }
{
  total++
  part = $2
  sub(/\/[^\/]*$/, "", part)
  result = $5
  spent += $6
  if (result ~ /^noticed/) {
    noticed++
    if (sub(/^noticed by /, "", result)) result = "`" result "`"
    else sub(/^noticed: /, "", result)
  } else if (result == "SURVIVED" && $4 != "") {
    explained++
    result = "survives"
  } else if (result == "not measured") {
    waiting++
  } else {
    open++
    result = "**" result "**"
  }
  rows = rows "| " part " | `" $1 "` | " result " | " $6 " |\n"
}
END {
  while ((getline line < page) > 0) {
    if (line == end) inside = 0
    if (!inside) print line
    if (line != begin) continue
    inside = 1
    printf "\n%d mutants: %d noticed, %d explained, %d open, %d not measured. Building and testing them took %.0f minutes.\n\n",
           total, noticed, explained, open, waiting, spent / 60
    printf "| part | mutant | noticed by | s |\n|---|---|---|---|\n%s\n", rows
  }
}
