#!/usr/bin/env bash
# The report in a browser: made from a store with made-up rows of all studies, opened in headless
# Chromium without a network at two widths, and printed to PDF. Every figure has to be shown, no
# resource may be missing, nothing may be said on the console, and all titles and captions have to
# be in the PDF. Then pages that are broken in one way each, which have to be caught.
#   report_test.sh FARCULL FIXTURE
# FARCULL_REPORT_SHOTS=DIR keeps screenshots and the PDF there, to be looked at.
# Status 77: not run, for want of a browser or of the tools that read PDF.
set -euo pipefail

farcull=$1
fixture=$2
# shellcheck source-path=SCRIPTDIR source=../script_lab.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../script_lab.sh" report.browser chromium python3 pdftotext pdfinfo gnuplot

# One browser for all pages (browse.py).
here=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
coproc BROWSER { PYTHONDONTWRITEBYTECODE=1 exec python3 "$here/browse.py"; }

# browse QUESTION...: what the browser says to it.
browse() {
  local line
  printf '%s\n' "$*" >&"${BROWSER[1]}"
  while IFS= read -r line <&"${BROWSER[0]}"; do
    if [[ $line == END ]]; then return; fi
    printf '%s\n' "$line"
  done
  echo "FAILED: the browser has ended"
}

# The page measures itself, by a script that only the copy has: what it shows, what failed to load,
# and the size of each figure and its text.
probe='<script>
window.problems = [];
window.addEventListener("error", function (e) {
  window.problems.push(e.message || ("resource " + (e.target.src || e.target.href || e.target.tagName)));
}, true);
window.addEventListener("load", function () {
  var lines = window.problems.map(function (p) { return "PROBLEM " + p; });
  document.querySelectorAll("img").forEach(function (i) {
    if (!i.complete || i.naturalWidth === 0) lines.push("PROBLEM picture " + (i.alt || i.src.slice(0, 40)));
  });
  var ids = {};
  document.querySelectorAll("[id]").forEach(function (e) {
    if (ids[e.id]) lines.push("PROBLEM id twice: " + e.id);
    ids[e.id] = true;
  });
  document.querySelectorAll("use").forEach(function (u) {
    var to = (u.getAttribute("href") || u.getAttribute("xlink:href") || "").slice(1);
    if (!ids[to]) lines.push("PROBLEM no element " + to);
  });
  document.querySelectorAll("figure:not(.table)").forEach(function (f) {
    var svg = f.querySelector("svg, img");
    var box = svg ? svg.getBoundingClientRect() : { width: 0, height: 0 };
    var text = f.querySelector("svg text, svg tspan");
    var size = text ? parseFloat(getComputedStyle(text).fontSize) : 0;
    var scale = svg && svg.viewBox && svg.viewBox.baseVal && svg.viewBox.baseVal.width
      ? box.width / svg.viewBox.baseVal.width : 1;
    var marks = f.querySelectorAll("svg path, svg use, svg circle, img").length;
    lines.push("FIGURE " + f.id + " " + Math.round(box.width) + " " + Math.round(box.height) + " " +
      marks + " " + (text ? (size * scale).toFixed(1) : "-"));
  });
  lines.push("WIDTH " + document.documentElement.scrollWidth + " " + window.innerWidth);
  var pre = document.createElement("pre");
  pre.id = "probe-results";
  pre.textContent = "\n" + lines.join("\n") + "\nEND\n";
  document.body.appendChild(pre);
});
</script>'

widths=(1280 500)  # px of the window

# with_probe PAGE COPY
with_probe() {
  printf '%s\n' "$probe" >"$work/probe"
  sed "/<head>/r $work/probe" "$1" >"$2"
}

# check_page PAGE FIGURES: prints what is wrong with a page, nothing where all is well. FIGURES: the
# ids that have to be there.
check_page() {
  local page=$1 id width height marks text copy said=$work/said
  shift
  copy=$work/copy/index.html
  rm -rf "$work/copy"
  mkdir "$work/copy"
  with_probe "$page" "$copy"
  local pixels
  for pixels in "${widths[@]}"; do
    browse probe "$pixels" "$copy" >"$said"
    grep -E '^(PROBLEM|console|FAILED)' "$said" | sed "s/^/$pixels px: /" || true
    grep -q '^WIDTH' "$said" || echo "$pixels px: the page did not load"
    for id in "$@"; do
      if ! read -r _ _ width height marks text < <(grep "^FIGURE $id " "$said"); then
        echo "$pixels px: figure $id is missing"
        continue
      fi
      ((width >= 300 && height >= 100)) || echo "$pixels px: figure $id is $width x $height px"
      ((marks >= 1)) || echo "$pixels px: figure $id is empty"
      # 8 pt are 10.67 px; on narrow screens a figure is moved sideways rather than shrunk.
      if [[ $text != - ]] && ! awk -v t="$text" 'BEGIN { exit !(t >= 10) }'; then
        echo "$pixels px: the text of figure $id is $text px high"
      fi
    done
    if read -r _ width marks < <(grep '^WIDTH' "$said"); then
      ((width <= marks)) || echo "$pixels px: the page is $width px wide"
    fi
  done
}

# check_links PAGE: every address that a page loads by itself lies within it; every link leads to a
# file that is there.
check_links() {
  local page=$1 folder to
  folder=$(dirname "$page")
  grep -oE '(src|href|url\()[="'\''(]*[a-z]+://[^"'\'' )>]*' "$page" |
    grep -v 'www.w3.org' | sed 's/^/leads to a network: /' || true
  grep -oE ' src="[^"]{0,60}' "$page" | grep -v ' src="data:' | sed 's/^/is loaded from outside: /' || true
  while IFS= read -r to; do
    [[ -e $folder/$to ]] || echo "leads to no file: $to"
  done < <(grep -oE ' href="[^"#]+"' "$page" | sed -E 's/ href="(.*)"/\1/' | grep -v '^data:' | sort -u)
}

# Words alone, so that lines may break anywhere in the PDF; pdftotext hyphenates nothing.
words() { tr -cs '[:alnum:]' '\n' | tr -d '\n'; }

# check_pdf PAGE PDF: prints which captions (their first 100 letters) are not in the PDF.
check_pdf() {
  local page=$1 pdf=$2 text caption pages
  pages=$(pdfinfo "$pdf" | awk '/^Pages:/ { print $2 }')
  ((pages > 1)) || echo "the PDF has $pages pages"
  grep -q 'Page size:.*A4' <<<"$(pdfinfo "$pdf")" || echo "the PDF is not of A4"
  text=$(pdftotext "$pdf" - | words)
  while IFS= read -r caption; do
    caption=$(printf '%s' "$caption" | words)
    [[ $text == *"${caption:0:100}"* ]] || echo "not in the PDF: ${caption:0:100}"
  done < <(grep -oE '<figcaption>.*' "$page" |
    sed -E 's/<span class="files">.*//; s/<[^>]*>//g; s/&lt;/</g; s/&gt;/>/g; s/&quot;/"/g; s/&#39;/ /g; s/&amp;/\&/g')
}

"$fixture" "$work/results"
"$farcull" report --no-pictures "$work/results" >"$work/report.out" 2>"$work/report.err" ||
  fail "the report: $(cat "$work/report.err")"
[[ -s $work/report.err ]] && fail "the report warns: $(cat "$work/report.err")"
report=$work/results/report
page=$report/index.html

mapfile -t ids < <(grep -oE '<figure id="(fig|pic)-[^"]*"' "$page" | sed -E 's/.*"(.*)"/\1/')
drawn=$(find "$report/figures" -name '*.svg' | wc -l)
((drawn > 0 && ${#ids[@]} >= drawn)) ||
  fail "$drawn figures were drawn, the page shows ${#ids[@]}"
for kind in pdf gp dat; do
  (($(find "$report/figures" -name "*.$kind" -size +0 | wc -l) == drawn)) || fail "not every figure has its $kind"
done
wrong=$(check_page "$page" "${ids[@]}" && check_links "$page")
[[ -z $wrong ]] || fail "the page: $wrong"
if grep -q '<script' "$page"; then fail "the page has a script"; fi

wrong=$(browse pdf "$page" "$work/page.pdf")
[[ -z $wrong ]] || fail "printing: $wrong"
wrong=$(check_pdf "$page" "$work/page.pdf")
[[ -z $wrong ]] || fail "the PDF: $wrong"

if [[ -n ${FARCULL_REPORT_SHOTS:-} ]]; then
  mkdir -p "$FARCULL_REPORT_SHOTS"
  browse shot 1280 "$page" "$FARCULL_REPORT_SHOTS/1280.png"
  browse shot 500 "$page" "$FARCULL_REPORT_SHOTS/500.png"
  cp "$work/page.pdf" "$FARCULL_REPORT_SHOTS/"
fi

# ---- what has to be caught ----

# caught WHAT PATTERN CHECK...: the check has to say something that fits the pattern.
caught() {
  local what=$1 pattern=$2 said
  shift 2
  said=$("$@")
  grep -qE -- "$pattern" <<<"$said" || fail "$what is not caught; said: ${said:-nothing}"
}

widths=(1280)
broken=$work/broken
mkdir -p "$broken"
first=${ids[0]}
# They are made of a page of one figure and one table, which the browser shows sooner.
small=$broken/small-page.html
awk -v first="<figure id=\"$first\">" '
  /<figure/ { kept = $0 == first || (/class="table"/ && !tables++); inside = 1 }
  !inside || kept
  /<\/figure>/ { inside = 0 }' "$page" >"$small"
grep -q "<figure id=\"$first\"" "$small" || fail "the small page has no figure: the cases show nothing"
wrong=$(check_page "$small" "$first")
[[ -z $wrong ]] || fail "the small page: $wrong"
sed 's|<h2>Contents</h2>|&<img src="gone.png" alt="gone">|' "$small" >"$broken/image.html"
caught "a picture that is not there" 'PROBLEM .*gone' check_page "$broken/image.html" "$first"
caught "a picture outside the page" 'from outside: .*gone.png' check_links "$broken/image.html"
sed 's|<h2>Contents</h2>|&<img src="data:image/png;base64,AAAA" alt="spoiled">|' "$small" >"$broken/data.html"
caught "a picture that is none" 'PROBLEM .*spoiled' check_page "$broken/data.html" "$first"
sed 's|<h2>Contents</h2>|&<script>nothing_of_this_name();</script>|' "$small" >"$broken/script.html"
caught "an error of a script" 'PROBLEM .*nothing_of_this_name' check_page "$broken/script.html" "$first"
caught "a line on the console" 'console: .*nothing_of_this_name' check_page "$broken/script.html" "$first"
caught "a figure that is missing" "figure fig-not-there is missing" check_page "$small" fig-not-there
sed "s|<figure id=\"$first\">|<figure id=\"$first\" style=\"display:none\">|" "$small" >"$broken/hidden.html"
caught "a figure that is hidden" "figure $first is 0 x 0 px" check_page "$broken/hidden.html" "$first"
sed 's|</style>|.drawing svg { min-width: 0 !important; width: 320px !important; }&|' "$small" >"$broken/small.html"
caught "text that is too small" "the text of figure $first" check_page "$broken/small.html" "$first"
sed 's|<h2>Contents</h2>|&<p id="summary">twice</p>|' "$small" >"$broken/twice.html"
caught "an id that is there twice" 'PROBLEM id twice: summary' check_page "$broken/twice.html" "$first"
sed 's|<h2>Contents</h2>|&<img src="https://example.org/a.png" alt="far away">|' "$small" >"$broken/network.html"
caught "a page that needs a network" 'PROBLEM resource https://example.org/a.png' check_page "$broken/network.html" "$first"
caught "a link to a network" 'leads to a network' check_links "$broken/network.html"
sed 's|</style>|@media print { figcaption { display: none; } }&|' "$small" >"$broken/captions.html"
browse pdf "$broken/captions.html" "$work/captions.pdf"
caught "a PDF without captions" 'not in the PDF' check_pdf "$small" "$work/captions.pdf"

# ---- stores that are not whole ----

"$fixture" "$work/some" some
"$farcull" report --no-pictures "$work/some" >"$work/some.out"
grep -q 'points have a row' "$work/some.out" || fail "an incomplete study is not told of"
grep -q 'class="warning".*Incomplete' "$work/some/report/index.html" || fail "the page hides that it is incomplete"
wrong=$(check_links "$work/some/report/index.html")
[[ -z $wrong ]] || fail "the page of some rows: $wrong"
if grep -q 'class="warning".*Incomplete' "$page"; then fail "a complete page says that it is not"; fi

# ---- a promise that was not kept ----

# What was drawn above, in place of gnuplot: the figures of these stores are not looked at.
mkdir "$work/reuse"
cat >"$work/reuse/gnuplot" <<'END'
#!/bin/sh
if [ "$1" = --version ]; then exit 0; fi
kind=${3#kind=?}
name=${4%.gp}.${kind%?}
cp "$FIGURES/$name" "$name"
END
chmod +x "$work/reuse/gnuplot"
reusing() { env FIGURES="$report/figures" PATH="$work/reuse:$PATH" "$@"; }

"$fixture" "$work/liar" broken
status=0
reusing "$farcull" report --no-pictures "$work/liar" >"$work/liar.out" 2>"$work/liar.err" || status=$?
((status == 1)) || fail "a broken promise: status $status"
grep -q 'a promise is broken: accuracy: ' "$work/liar.err" || fail "a broken promise is not told of"
liar=$work/liar/report
sed '/<nav/,$d' "$liar/index.html" >"$work/liar.summary"
for study in accuracy error-time radius offsets precision culling stability cloth efficiency scaling; do
  grep -q "<li><a href=\"#$study\">.*BROKEN:" "$work/liar.summary" || fail "the summary hides what $study broke"
done
if grep -q 'never misses' "$liar/index.html"; then fail "the page claims what its rows deny"; fi
grep -q 'BROKEN:' <<<"$(sed '/^All of this page/,$d' "$liar/results.md")" || fail "results.md hides a broken promise"
# The twin: the store of before keeps its promises.
grep -q 'never misses' "$page" || fail "the page of kept promises claims nothing"

# What a chapter finds broken beyond single rows counts as well.
"$fixture" "$work/stuck" unconverged
status=0
reusing "$farcull" report --no-pictures "$work/stuck" >"$work/stuck.out" 2>"$work/stuck.err" || status=$?
((status == 1)) || fail "a step that did not converge: status $status"
grep -q 'a promise is broken: cloth: ' "$work/stuck.err" || fail "a step that did not converge is not told of"

# refuses WHAT PATTERN COMMAND...: status 2 and one line that fits.
refuses() {
  local what=$1 pattern=$2 status=0 said
  shift 2
  said=$("$@" 2>&1) || status=$?
  [[ $status == 2 && $said =~ $pattern ]] || fail "$what: status $status, $said"
}
"$fixture" "$work/shard" shard
refuses "a shard" 'farcull merge' "$farcull" report "$work/shard"
refuses "no folder" 'no folder of results' "$farcull" report "$work/nowhere"
"$fixture" "$work/foreign" foreign
refuses "a foreign study" 'unheard-of' "$farcull" report "$work/foreign"
mkdir "$work/empty"
refuses "an empty folder" 'no results.sqlite' "$farcull" report "$work/empty"
refuses "no gnuplot" 'gnuplot: is not installed; install it' env PATH=/nonexistent "$farcull" report "$work/results"
mkdir "$work/bin"
printf '#!/bin/sh\necho "warning: made up" >&2\nexit 0\n' >"$work/bin/gnuplot"
chmod +x "$work/bin/gnuplot"
before=$(md5sum <"$page")
refuses "a warning of gnuplot" 'warned: warning: made up' env PATH="$work/bin:$PATH" "$farcull" report "$work/results"
[[ $(md5sum <"$page") == "$before" ]] || fail "a report that failed replaced the one before"
mkdir "$work/mine"
cp "$work/results/results.sqlite" "$work/mine/"
mkdir "$work/mine/report"
echo mine >"$work/mine/report/notes.txt"
refuses "a folder of somebody else" 'no report of this program' "$farcull" report "$work/mine"
[[ -e $work/mine/report/notes.txt ]] || fail "a file of somebody else is gone"
# Ended by a signal while it draws.
# shellcheck disable=SC2016  # the script's argument, not ours
printf '#!/bin/sh\n[ "$1" = --version ] || { touch "%s"; sleep 1; }\n' "$work/drawing" >"$work/bin/gnuplot"
PATH="$work/bin:$PATH" "$farcull" report "$work/results" >/dev/null 2>&1 &
pid=$!
for ((i = 0; i < 100; ++i)); do
  if [[ -e $work/drawing ]]; then break; fi
  sleep 0.1
done
kill -TERM "$pid"
status=0
wait "$pid" || status=$?
((status == 143)) || fail "ended by SIGTERM: status $status"
[[ $(md5sum <"$page") == "$before" ]] || fail "a report that was ended replaced the one before"
leftover=$(find "$work" -name 'report.part-*')
[[ -z $leftover ]] || fail "half a report is left: $leftover"
# Killed while it draws: the next report takes that away, but not what another one still works on,
# nor what only has such a name.
rm -f "$work/drawing"
PATH="$work/bin:$PATH" setsid "$farcull" report "$work/results" >/dev/null 2>&1 &
pid=$!
for ((i = 0; i < 100; ++i)); do
  if [[ -e $work/drawing ]]; then break; fi
  sleep 0.1
done
kill -KILL "$pid"
wait "$pid" 2>/dev/null || true
half=$(find "$work/results" -name 'report.part-*')
[[ -d $half ]] || fail "a killed report left nothing: the case shows nothing"
mkdir "$work/results/report.part-abcdef" "$work/results/report.part-notours"
rm -f "$work/drawing"
# This one draws until the report beside it has ended.
# shellcheck disable=SC2016  # as above
printf '#!/bin/sh\n[ "$1" = --version ] || { touch "%s"; until [ -e "%s" ]; do sleep 0.1; done; }\n' \
  "$work/drawing" "$work/ended" >"$work/bin/gnuplot"
PATH="$work/bin:$PATH" "$farcull" report "$work/results" >/dev/null 2>&1 &
pid=$!
for ((i = 0; i < 100; ++i)); do
  if [[ -e $work/drawing ]]; then break; fi
  sleep 0.1
done
[[ ! -e $half ]] || fail "what a killed report left is still there"
working=$(find "$work/results" -name 'report.part-??????' -not -name report.part-abcdef)
[[ -d $working ]] || fail "no report is being made: the case shows nothing"
reusing "$farcull" report "$work/results" >/dev/null 2>&1 || fail "a report beside another fails"
[[ -d $working ]] || fail "a report took away what another one works on"
kill -TERM "$pid"
touch "$work/ended"
wait "$pid" 2>/dev/null || true
for name in abcdef notours; do
  [[ -d $work/results/report.part-$name ]] || fail "a folder of somebody else is gone"
  rmdir "$work/results/report.part-$name"
done
leftover=$(find "$work" -name 'report.part-*')
[[ -z $leftover ]] || fail "half a report is left: $leftover"
[[ ! -e $work/results/report/.unfinished ]] || fail "a report in its place holds its mark"

((failures == 0)) || exit 1
echo "report.browser: ${#ids[@]} figures at two widths and in a PDF of $(pdfinfo "$work/page.pdf" | awk '/^Pages:/ { print $2 }') pages"
