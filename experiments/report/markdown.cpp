// Writes the same content as page.cpp as Markdown, with links to the files of figures.
#include "experiments/report/markdown.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/tables.h"
#include "experiments/system/shell_word.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

std::string bullets(const std::vector<std::string>& sentences) {
  std::string out;
  for (const std::string& text : sentences) out += "- " + markdown_prose(sentence(text)) + "\n";
  return out.empty() ? out : out + "\n";
}

std::string row_of(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& cell : cells) out += " " + markdown_prose(cell) + " |";
  return out + "\n";
}

std::string table_of(const DataTable& table) {
  std::string out = row_of(names_of(table.columns)) + "|";
  for (const Column& column : table.columns)
    out += column.side == Column::Side::right ? "---:|" : "---|";
  out += "\n";
  for (const std::vector<std::string>& row : table.rows) out += row_of(row);
  return out + "\n";
}

// Why points were left out is among the limits.
std::string gaps_of(const StoredStudy& stored) {
  if (stored.complete()) return {};
  return bullets({fmt::format("Incomplete: {} of {} points have a row", grouped(stored.rows.size()),
                              grouped(stored.declaration.points.size()))});
}

// Every promise that was not kept, of all chapters.
std::string broken_of(const Page& page) {
  std::vector<std::string> out;
  for (const DrawnChapter& drawn : page.chapters) {
    for (const Finding& finding : drawn.chapter.findings) {
      if (is_broken(finding)) out.push_back(drawn.chapter.title + ": " + printed(finding));
    }
  }
  if (out.empty()) return {};
  return "**Broken.** What must never happen has happened:\n\n" + bullets(out);
}

// JSON without backticks, which would end the code that it stands in.
std::string json_code(std::string json) {
  for (std::size_t at = 0; (at = json.find('`', at)) != std::string::npos;)
    json.replace(at, 1, "\\u0060");
  return "`" + json + "`";
}

std::string machine_of(const Page& page) {
  std::map<std::int64_t, std::size_t> rows;
  for (const DrawnChapter& drawn : page.chapters) {
    for (const Row& row : drawn.stored.rows) ++rows[row.run];
  }
  std::string out;
  for (const auto& [number, p] : page.runs) {
    if (!rows.contains(number)) continue;
    out += row_of({std::to_string(number), p.started, p.commit, p.gl_renderer, driver_text(p),
                   p.cpu, std::to_string(p.cores), json_code(p.options), grouped(rows.at(number))});
  }
  if (out.empty()) return out;
  return "| run | started | commit | device | driver | CPU | cores | options | rows |\n"
         "|---|---|---|---|---|---|---:|---|---:|\n" +
         out;
}

}  // namespace

std::string markdown_prose(const std::string& text) {
  const std::string signs = "\\*_<>|[]#";
  std::string out;
  bool code = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char ch = text[i];
    if (ch == '`' && (code || text.find('`', i + 1) != std::string::npos)) {
      code = !code;
      out += ch;
    } else if (ch == '\n' || ch == '\r') {
      out += ' ';
    } else {
      // A bar ends a cell between backticks as well.
      if (ch == '`' || ch == '|' || (!code && signs.find(ch) != std::string::npos)) out += '\\';
      out += ch;
    }
  }
  return out;
}

std::string markdown_code(const std::string& text) {
  std::size_t longest = 0, run = 0;
  std::string line;
  for (const char ch : text) {
    run = ch == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
    line += ch == '\n' || ch == '\r' ? ' ' : ch;
  }
  const std::string fence(longest + 1, '`');
  return longest == 0 ? fence + line + fence : fence + " " + line + " " + fence;
}

std::string page_markdown(const Page& page, const std::string& folder) {
  std::string out = "# Results\n\n" + broken_of(page);
  out += fmt::format(
      "All of this page is made from the store of results by {}, figures, tables and sentences: "
      "no "
      "number was typed. A single study is measured again by the command that stands below it. "
      "Counts are the same, bit for bit, on the same device and CPU features; times are of the "
      "machine [at the end](#where-it-was-measured).\n\n",
      markdown_code("farcull report " + quoted(folder)));
  std::size_t figure = 0, table = 0, section = 0;
  for (const DrawnChapter& drawn : page.chapters) {
    const Chapter& chapter = drawn.chapter;
    out += fmt::format("## {}. {}\n\n{}\n\n", ++section, markdown_prose(chapter.title),
                       markdown_prose(chapter.question));
    out += gaps_of(drawn.stored);
    std::vector<std::string> findings;
    for (const Finding& finding : chapter.findings) findings.push_back(printed(finding));
    out += bullets(findings);
    for (const DrawnPicture& picture : drawn.pictures) {
      if (picture.png.empty()) {
        out += fmt::format("A picture ({}) is left out: {}\n\n",
                           markdown_code(command_of(picture.picture.arguments)),
                           markdown_prose(sentence(picture.left_out)));
        continue;
      }
      out += fmt::format("![{0}](pictures/{1}.png)\n\n**Figure {2}.** {0} {3}\n\n",
                         markdown_prose(sentence(picture.picture.caption)), picture.picture.name,
                         ++figure, markdown_code(command_of(picture.picture.arguments)));
    }
    for (const Figure& f : chapter.figures) {
      out += fmt::format("![{0}](figures/{1}.svg)\n\n**Figure {2}. {3}** {4}\n\n",
                         markdown_prose(f.title), f.name, ++figure,
                         markdown_prose(sentence(f.title)), markdown_prose(sentence(f.caption)));
    }
    for (const DataTable& t : chapter.tables) {
      if (!t.in_text) continue;
      out += fmt::format("**Table {}.** {}\n\n", ++table, markdown_prose(sentence(t.caption)));
      out += table_of(t);
    }
    if (!chapter.limits.empty()) out += "What it does not show:\n\n" + bullets(chapter.limits);
    const Declaration& d = drawn.stored.declaration;
    out += fmt::format("Again: {} ({} grid, seed {}, {}), then `farcull report`.\n\n",
                       markdown_code(chapter.command), d.choice.quick ? "quick" : "full",
                       d.choice.seed, counted(d.points.size(), "point", "points"));
  }
  out += "## Where it was measured\n\n" + machine_of(page);
  return out;
}

}  // namespace farcull
