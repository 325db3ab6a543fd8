// Writes tables as CSV, HTML and LaTeX, with the escapes of each.
#include "experiments/report/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/report/html.h"

namespace farcull {
namespace {

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    out += c;
    if (c == '"') out += c;
  }
  return out + "\"";
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string out;
  for (std::size_t i = 0; i < cells.size(); ++i) out += (i > 0 ? "," : "") + csv_cell(cells[i]);
  return out + "\r\n";
}

// Of all rows, each once, in the order of first appearance.
std::vector<std::string> names_of(const StoredStudy& stored, JsonObject Measurement::*values) {
  std::vector<std::string> out;
  for (const Row& row : stored.rows) {
    for (const auto& [name, value] : (row.measurement.*values)->items()) {
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
    }
  }
  return out;
}

std::string value_text(const nlohmann::ordered_json& values, const std::string& name) {
  const auto at = values.find(name);
  if (at == values.end() || at->is_null()) return "";
  return at->is_string() ? at->get<std::string>() : at->dump();
}

// Signs that pdfLaTeX's text fonts lack, as mathematics.
struct Sign {
  const char* text;
  const char* latex;
};
constexpr Sign kSigns[] = {
    {"±", "$\\pm$"}, {"×", "$\\times$"}, {"≤", "$\\le$"},    {"≥", "$\\ge$"}, {"·", "$\\cdot$"},
    {"→", "$\\to$"}, {"−", "$-$"},       {"∞", "$\\infty$"}, {"µ", "$\\mu$"}, {"≈", "$\\approx$"},
    {"⁻", "$^{-}$"}, {"⁰", "$^0$"},      {"¹", "$^1$"},      {"²", "$^2$"},   {"³", "$^3$"},
    {"⁴", "$^4$"},   {"⁵", "$^5$"},      {"⁶", "$^6$"},      {"⁷", "$^7$"},   {"⁸", "$^8$"},
    {"⁹", "$^9$"}};

}  // namespace

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> out;
  for (const Column& column : columns) out.push_back(column.name);
  return out;
}

std::string table_csv(const DataTable& table) {
  std::string out = csv_line(names_of(table.columns));
  for (const std::vector<std::string>& row : table.rows) out += csv_line(row);
  return out;
}

std::string table_html(const DataTable& table) {
  const auto alignment = [&table](std::size_t column) {
    return table.columns[column].side == Column::Side::right ? " class=\"r\"" : "";
  };
  std::string out = "<table>\n<thead><tr>";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    out +=
        fmt::format("<th scope=\"col\"{}>{}</th>", alignment(i), html_prose(table.columns[i].name));
  }
  out += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      out += fmt::format("<td{}>{}</td>", alignment(i), html_prose(row[i]));
    }
    out += "</tr>\n";
  }
  return out + "</tbody>\n</table>\n";
}

std::string latex_text(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto sign = std::find_if(std::begin(kSigns), std::end(kSigns), [&](const Sign& s) {
      return text.compare(i, std::string_view(s.text).size(), s.text) == 0;
    });
    if (sign != std::end(kSigns)) {
      out += sign->latex;
      i += std::string_view(sign->text).size();
      continue;
    }
    const char c = text[i++];
    switch (c) {
      case '&':
      case '%':
      case '$':
      case '#':
      case '_':
      case '{':
      case '}':
        out += std::string("\\") + c;
        break;
      case '~':
        out += "\\textasciitilde{}";
        break;
      case '^':
        out += "\\textasciicircum{}";
        break;
      case '\\':
        out += "\\textbackslash{}";
        break;
      case '<':
        out += "$<$";
        break;
      case '>':
        out += "$>$";
        break;
      case '|':
        out += "$|$";
        break;
      case '`':
        break;
      default:
        out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return out;
}

std::string table_latex(const DataTable& table) {
  const auto line = [](const std::vector<std::string>& cells) {
    std::string out;
    for (std::size_t i = 0; i < cells.size(); ++i)
      out += (i > 0 ? " & " : "") + latex_text(cells[i]);
    return out + " \\\\\n";
  };
  std::string alignment;
  for (const Column& column : table.columns)
    alignment += column.side == Column::Side::right ? 'r' : 'l';
  std::string out = "% \\usepackage{booktabs,graphicx}\n";
  // A float holds a page at most.
  constexpr std::size_t kRows = 40;
  for (std::size_t begin = 0; begin == 0 || begin < table.rows.size(); begin += kRows) {
    out += "\\begin{table}\n  \\centering\n  \\caption{" + latex_text(table.caption) +
           (begin == 0 ? ".}\n  \\label{tab:" + table.name + "}\n" : ", continued.}\n") +
           // Scaled where it is wider than the text.
           "  \\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n"
           "  \\begin{tabular}{" +
           alignment + "}\n    \\toprule\n    " + line(names_of(table.columns)) + "    \\midrule\n";
    const std::size_t end = std::min(begin + kRows, table.rows.size());
    for (std::size_t i = begin; i < end; ++i) out += "    " + line(table.rows[i]);
    out += "    \\bottomrule\n  \\end{tabular}}\n\\end{table}\n";
  }
  return out;
}

std::string rows_csv(const StoredStudy& stored) {
  const std::vector<std::string> counts = names_of(stored, &Measurement::counts);
  const std::vector<std::string> times = names_of(stored, &Measurement::times);
  std::vector<std::string> header = {"position"};
  const std::vector<std::string> axes = field_names<PointKey>();
  header.insert(header.end(), axes.begin(), axes.end());
  header.insert(header.end(), counts.begin(), counts.end());
  for (const std::string& name : times) header.push_back(name + "_ms");
  for (const char* name : {"device", "run", "measured", "left_out"}) header.push_back(name);
  std::string out = csv_line(header);
  for (const Row& row : stored.rows) {
    const Measurement& m = row.measurement;
    std::vector<std::string> cells = {std::to_string(row.position)};
    for (std::string& value : axis_values(row.point)) cells.push_back(std::move(value));
    for (const std::string& name : counts) cells.push_back(value_text(*m.counts, name));
    for (const std::string& name : times) cells.push_back(value_text(*m.times, name));
    cells.push_back(m.device);
    cells.push_back(std::to_string(row.run));
    cells.push_back(row.measured);
    cells.push_back(m.left_out);
    out += csv_line(cells);
  }
  return out;
}

}  // namespace farcull
