// How the page looks, on a screen and on paper.
#pragma once

namespace farcull {

inline constexpr const char* kPageStyle = R"(
:root { color-scheme: light; }
* { box-sizing: border-box; }
html { font-size: 100%; -webkit-text-size-adjust: 100%; }
body { margin: 0; background: #fff; color: #1a1a1a; line-height: 1.55;
  font-family: Charter, "Bitstream Charter", "Source Serif 4", Georgia, "Liberation Serif",
    "Times New Roman", serif; }
main { max-width: 48rem; margin: 0 auto; padding: 3rem 1.25rem 5rem; }
h1, h2, h3, figcaption, table, nav, .by, .files, .warning, .note, .again, .longer, summary {
  font-family: "Helvetica Neue", Helvetica, Arial, "Liberation Sans", "DejaVu Sans", sans-serif; }
h1 { font-size: 2rem; line-height: 1.2; margin: 0 0 .4rem; letter-spacing: -.01em; }
h2 { font-size: 1.35rem; line-height: 1.25; margin: 3.2rem 0 .8rem; }
h3 { font-size: 1rem; margin: 1.8rem 0 .5rem; }
p, ul, ol { margin: .7rem 0; }
ul, ol { padding-left: 1.3rem; }
li { margin: .35rem 0; }
a { color: #0b5394; text-decoration-thickness: 1px; text-underline-offset: 2px; }
code { font-family: "DejaVu Sans Mono", "Liberation Mono", Menlo, Consolas, monospace;
  font-size: .84em; overflow-wrap: anywhere; }
.by { color: #555; font-size: .9rem; margin: 0; }
header { border-bottom: 1px solid #1a1a1a; padding-bottom: 1.2rem; }
.study { border-top: 1px solid #ccc; margin-top: 3rem; }
.study > h2 { margin-top: 1.6rem; }
.question { font-style: italic; font-size: 1.06rem; }
nav ol { margin: .4rem 0; font-size: .95rem; }
nav h2, #summary h2 { font-size: 1.1rem; margin-top: 2rem; }
.warning { background: #fff3d6; border-left: 4px solid #d98e00; padding: .7rem 1rem;
  font-size: .93rem; }
.note { color: #444; font-size: .9rem; }
figure { margin: 2.2rem 0; }
.drawing { overflow-x: auto; }
.drawing svg { display: block; width: 100%; min-width: 36rem; height: auto; }
img { display: block; max-width: 100%; height: auto; margin: 0 auto; }
figcaption { font-size: .88rem; line-height: 1.45; color: #333; margin-top: .6rem; }
.table figcaption { margin: 0 0 .5rem; }
.files { color: #555; font-size: .8rem; white-space: normal; }
.files a { margin-right: .35em; }
.cells { overflow-x: auto; }
table { border-collapse: collapse; font-size: .84rem; line-height: 1.35;
  font-variant-numeric: tabular-nums; border-top: 1.5px solid #1a1a1a;
  border-bottom: 1.5px solid #1a1a1a; min-width: 60%; }
thead th { border-bottom: 1px solid #1a1a1a; font-weight: 600; vertical-align: bottom; }
th, td { text-align: left; padding: .28rem .9rem .28rem 0; vertical-align: top; }
th:last-child, td:last-child { padding-right: 0; }
.r { text-align: right; }
.machine th { font-weight: 600; white-space: nowrap; }
.machine td { overflow-wrap: anywhere; }
.longer, .again { font-size: .88rem; color: #333; }
details { margin: .6rem 0; }
summary { font-size: .88rem; cursor: pointer; }
.features { font-size: .75rem; color: #444; overflow-wrap: anywhere; }
@media (max-width: 40rem) {
  main { padding: 1.5rem 1rem 3rem; }
  h1 { font-size: 1.6rem; }
}
@media print {
  @page { size: A4; margin: 18mm 20mm; }
  html { font-size: 10.5pt; }
  main { max-width: none; padding: 0; }
  a { color: inherit; text-decoration: none; }
  .files a, .files { display: none; }
  .study { break-before: auto; }
  h2, h3 { break-after: avoid; }
  figure, tr, .warning { break-inside: avoid; }
  .table { break-inside: auto; }
  .table figcaption { break-after: avoid; }
  thead { display: table-header-group; }
  .drawing, .cells { overflow: visible; }
  .drawing svg { min-width: 0; max-height: 235mm; }
  img { max-height: 200mm; }
  table { font-size: 8pt; }
  figcaption { font-size: 9pt; }
  th, td { padding-right: .6rem; }
}
)";

}  // namespace farcull
