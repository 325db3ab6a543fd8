// Writes the page from top to bottom: broken promises first, then a section for each chapter.
#include "experiments/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/base64.h"
#include "experiments/record/tables.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/figures.h"
#include "experiments/report/html.h"
#include "experiments/report/page_style.h"
#include "experiments/report/tables.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

std::string grid_text(const StoredStudy& stored) {
  const Declaration& d = stored.declaration;
  return fmt::format("{} grid, seed {}, {} of {}", d.choice.quick ? "quick" : "full", d.choice.seed,
                     grouped(stored.rows.size()), counted(d.points.size(), "point", "points"));
}

class Writer {
 public:
  explicit Writer(const Page& page) : page_(page) {}

  std::string made() {
    head();
    summary();
    contents();
    for (const DrawnChapter& chapter : page_.chapters) section(chapter);
    machine();
    out_ += "</main>\n</body>\n</html>\n";
    return std::move(out_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    out_ += fmt::format(format, std::forward<Args>(args)...) + "\n";
  }

  void head() {
    out_ += "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
    out_ += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
    out_ += std::string(kPageMark) + "\n";
    out_ += "<title>Reliable collision culling: results</title>\n";
    // Without this a browser looks for an icon beside the page.
    out_ += "<link rel=\"icon\" href=\"data:,\">\n";
    out_ += std::string("<style>\n") + kPageStyle + "</style>\n</head>\n<body>\n<main>\n";
    out_ += "<header>\n<h1>Reliable collision culling: results</h1>\n";
    add("<p class=\"by\">farcull {}, written {}</p>\n</header>", html_text(short_commit()),
        html_text(page_.written));
  }

  std::string short_commit() const {
    return page_.commit.empty() ? "of no commit" : page_.commit.substr(0, 12);
  }

  std::set<std::int64_t> runs_of(const StoredStudy& stored) const {
    std::set<std::int64_t> out;
    for (const Row& row : stored.rows) out.insert(row.run);
    return out;
  }

  const Provenance* run(std::int64_t number) const {
    for (const auto& [n, provenance] : page_.runs) {
      if (n == number) return &provenance;
    }
    return nullptr;
  }

  // Each once, in order: renderers or CPUs of the runs.
  std::vector<std::string> machines(const std::set<std::int64_t>& numbers) const {
    std::vector<std::string> out;
    for (const std::int64_t number : numbers) {
      const Provenance* p = run(number);
      if (p == nullptr) continue;
      const std::string text = fmt::format("{} on {} ({} cores)", p->gl_renderer, p->cpu, p->cores);
      if (std::find(out.begin(), out.end(), text) == out.end()) out.push_back(text);
    }
    return out;
  }

  // Every promise that was not kept, of all chapters, before anything else.
  bool broken() {
    std::string items;
    for (const DrawnChapter& c : page_.chapters) {
      for (const Finding& finding : c.chapter.findings) {
        if (!is_broken(finding)) continue;
        items += fmt::format("<li><a href=\"#{}\">{}</a>: {}</li>\n", c.chapter.study,
                             html_text(c.chapter.title), html_prose(sentence(printed(finding))));
      }
    }
    if (items.empty()) return false;
    out_ +=
        "<p class=\"warning\" role=\"note\"><strong>Broken.</strong> What must never "
        "happen has happened:</p>\n<ul class=\"broken\">\n" +
        items + "</ul>\n";
    return true;
  }

  void summary() {
    std::size_t rows = 0, points = 0;
    bool quick = false, full = false;
    std::vector<std::string> incomplete;
    std::set<std::int64_t> runs;
    for (const DrawnChapter& c : page_.chapters) {
      rows += c.stored.rows.size();
      points += c.stored.declaration.points.size();
      (c.stored.declaration.choice.quick ? quick : full) = true;
      if (!c.stored.complete()) incomplete.push_back(c.chapter.study);
      runs.merge(runs_of(c.stored));
    }
    if (!incomplete.empty()) {
      add("<p class=\"warning\" role=\"note\"><strong>Incomplete.</strong> {} of {} points have a "
          "row; {} what is missing: {}. What follows is of the rows that are there. "
          "<code>farcull experiment NAME --resume</code> measures the others.</p>",
          grouped(rows), grouped(points),
          incomplete.size() == 1 ? "the study that shows" : "the studies that show",
          html_text(listed(incomplete)));
    }
    add("<section id=\"summary\">\n<h2>Summary</h2>");
    // The claim of the rows, or none.
    const char* claim =
        broken() ? "FAR and CULLIDE cull with graphics hardware."
                 : "FAR culls with graphics hardware and never misses a pair that collides; "
                   "CULLIDE, from which it comes, can.";
    add("<p>{} This page reports {} on {}: {}, {}. All its numbers come from "
        "<code>{}</code>. Counts are the same, bit for bit, on the same device and CPU features; "
        "times are of this machine.</p>",
        claim, counted(page_.chapters.size(), "study", "studies"),
        html_text(listed(machines(runs))), counted(rows, "row", "rows"),
        quick && full ? "quick grids and full ones"
        : quick       ? "of quick grids, which are made for a first look"
                      : "of full grids",
        html_text(page_.store));
    std::string items;
    for (const DrawnChapter& c : page_.chapters) {
      const auto& findings = c.chapter.findings;
      const auto first = std::find_if_not(findings.begin(), findings.end(), is_broken);
      if (first == findings.end()) continue;
      items += fmt::format("<li><a href=\"#{}\">{}</a>: {}</li>\n", c.chapter.study,
                           html_text(c.chapter.title), html_prose(sentence(first->text)));
    }
    if (!items.empty()) out_ += "<ul class=\"findings\">\n" + items + "</ul>\n";
    out_ += "</section>\n";
  }

  void contents() {
    out_ += "<nav aria-label=\"Contents\">\n<h2>Contents</h2>\n<ol>\n";
    for (const DrawnChapter& c : page_.chapters) {
      add("<li><a href=\"#{}\">{}</a></li>", c.chapter.study, html_text(c.chapter.title));
    }
    out_ += "<li><a href=\"#machine\">Where it was measured</a></li>\n</ol>\n</nav>\n";
  }

  void section(const DrawnChapter& drawn) {
    const Chapter& chapter = drawn.chapter;
    ++section_;
    add("<section id=\"{}\" class=\"study\">\n<h2>{}. {}</h2>", chapter.study, section_,
        html_text(chapter.title));
    add("<p class=\"question\">{}</p>", html_prose(chapter.question));
    state(drawn.stored);
    if (!chapter.findings.empty()) {
      out_ += "<h3>What it shows</h3>\n<ul>\n";
      for (const Finding& finding : chapter.findings)
        add("<li>{}</li>", html_prose(sentence(printed(finding))));
      out_ += "</ul>\n";
    }
    for (const DrawnPicture& picture : drawn.pictures) show(picture);
    for (std::size_t i = 0; i < chapter.figures.size(); ++i)
      show(chapter.figures[i], drawn.svgs[i]);
    for (const DataTable& table : chapter.tables) show(table);
    if (!chapter.limits.empty()) {
      out_ += "<h3>What it does not show</h3>\n<ul>\n";
      for (const std::string& limit : chapter.limits)
        add("<li>{}</li>", html_prose(sentence(limit)));
      out_ += "</ul>\n";
    }
    add("<p class=\"again\">Measured by <code>{}</code>: {}. Every row: <a "
        "href=\"tables/{}-rows.csv\">{}-rows.csv</a>.</p>\n</section>",
        html_text(chapter.command), grid_text(drawn.stored), chapter.study, chapter.study);
  }

  // Missing points, before anything is claimed; why points were left out is among the limits.
  void state(const StoredStudy& stored) {
    const std::size_t points = stored.declaration.points.size();
    if (!stored.complete()) {
      add("<p class=\"warning\" role=\"note\"><strong>Incomplete.</strong> {} of {} points have a "
          "row; findings, figures and tables are of these.</p>",
          grouped(stored.rows.size()), grouped(points));
    }
  }

  void show(const Figure& figure, const std::string& svg) {
    ++figure_;
    add("<figure id=\"fig-{}\">\n<div class=\"drawing\" role=\"img\" aria-label=\"{}\" "
        "tabindex=\"0\">{}</div>",
        figure.name, html_text(figure.title), inline_svg(svg, figure.name + "-"));
    add("<figcaption><strong>Figure {}. {}</strong> {} <span class=\"files\"><a "
        "href=\"figures/{}.svg\">SVG</a> <a href=\"figures/{}.pdf\">PDF</a> <a "
        "href=\"figures/{}.gp\">script</a> <a "
        "href=\"figures/{}.dat\">data</a></span></figcaption>\n</figure>",
        figure_, html_text(sentence(figure.title)), html_prose(sentence(figure.caption)),
        figure.name, figure.name, figure.name, figure.name);
  }

  void show(const DrawnPicture& drawn) {
    const std::string command = command_of(drawn.picture.arguments);
    if (drawn.png.empty()) {
      add("<p class=\"note\" role=\"note\">A picture (<code>{}</code>) is left out: {}</p>",
          html_text(command), html_text(sentence(drawn.left_out)));
      return;
    }
    ++figure_;
    add("<figure id=\"pic-{}\">\n<img src=\"data:image/png;base64,{}\" alt=\"{}\">",
        drawn.picture.name,
        to_base64({reinterpret_cast<const std::uint8_t*>(drawn.png.data()), drawn.png.size()}),
        html_text(drawn.picture.caption));
    const std::string look = drawn.page ? fmt::format(
                                              " <a href=\"pages/{}.html\">look around in it"
                                              "</a>",
                                              drawn.picture.name)
                                        : "";
    add("<figcaption><strong>Figure {}.</strong> {} <span class=\"files\"><code>{}</code> <a "
        "href=\"pictures/{}.png\">PNG</a>{}</span></figcaption>\n</figure>",
        figure_, html_prose(sentence(drawn.picture.caption)), html_text(command),
        drawn.picture.name, look);
  }

  void show(const DataTable& table) {
    if (!table.in_text) {
      add("<p class=\"longer\">{} ({}): <a href=\"tables/{}.csv\">{}.csv</a>.</p>",
          html_prose(table.caption), counted(table.rows.size(), "row", "rows"), table.name,
          table.name);
      return;
    }
    const std::string files = fmt::format(
        "<span class=\"files\"><a href=\"tables/{0}.csv\">CSV</a> <a "
        "href=\"tables/{0}.tex\">LaTeX</a></span>",
        table.name);
    ++table_;
    add("<figure id=\"tab-{}\" class=\"table\">\n<figcaption><strong>Table {}.</strong> {} "
        "{}</figcaption>\n<div class=\"cells\" tabindex=\"0\" role=\"region\" aria-label=\"Table "
        "{}\">\n{}</div>\n</figure>",
        table.name, table_, html_prose(sentence(table.caption)), files, table_, table_html(table));
  }

  void machine() {
    out_ += "<section id=\"machine\">\n<h2>Where it was measured</h2>\n";
    std::map<std::int64_t, std::map<std::string, std::size_t>> rows;
    std::map<std::string, std::size_t> devices;
    for (const DrawnChapter& c : page_.chapters) {
      for (const Row& row : c.stored.rows) {
        ++rows[row.run][c.chapter.study];
        if (row.measurement.left_out.empty()) ++devices[row.measurement.device];
      }
    }
    for (const auto& [number, provenance] : page_.runs) {
      if (rows.contains(number)) show(number, provenance, rows.at(number));
    }
    std::vector<std::string> answered;
    for (const auto& [device, count] : devices) {
      answered.push_back(
          fmt::format("{} ({})", device.empty() ? "none" : device, counted(count, "row", "rows")));
    }
    if (!answered.empty()) add("<p>What answered: {}.</p>", html_text(listed(answered)));
    add("<p>This page was made by <code>farcull report</code> from {}; figures, their data and "
        "scripts, tables as CSV and LaTeX lie beside it in <code>figures/</code> and "
        "<code>tables/</code>. The page itself needs none of them.</p>\n</section>",
        html_text(page_.store));
  }

  void show(std::int64_t number, const Provenance& p,
            const std::map<std::string, std::size_t>& rows) {
    std::vector<std::string> parts;
    for (const auto& [study, count] : rows) {
      parts.push_back(fmt::format("{} {}", grouped(count), study));
    }
    const auto line = [this](const char* name, const std::string& value) {
      add("<tr><th scope=\"row\">{}</th><td>{}</td></tr>", name,
          value.empty() ? "unknown" : html_text(value));
    };
    add("<h3>Run {}</h3>\n<table class=\"machine\">\n<tbody>", number);
    line("Started", p.started);
    line("Device", p.gl_renderer);
    line("Driver", driver_text(p));
    line("CPU", p.cpu);
    line("Cores", std::to_string(p.cores));
    line("Commit", p.commit);
    line("Options", p.options);
    line("Rows", listed(parts));
    out_ += "</tbody>\n</table>\n";
    add("<details>\n<summary>CPU features</summary>\n<p "
        "class=\"features\">{}</p>\n</details>",
        p.cpu_features.empty() ? "unknown" : html_text(p.cpu_features));
  }

  const Page& page_;
  std::string out_;
  int section_ = 0, figure_ = 0, table_ = 0;
};

}  // namespace

std::string page_html(const Page& page) { return Writer(page).made(); }

}  // namespace farcull
