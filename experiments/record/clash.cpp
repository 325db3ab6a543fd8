// Writes, compares and collects the records of `farcull clash`.
#include "experiments/record/output.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "commit.h"
#include "core/base/bytes.h"
#include "experiments/record/stage_words.h"
#include "experiments/record/tables.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kRowsShown = 40;

std::string short_number(double x) { return fmt::format("{:.6g}", x); }

const std::string& name_of(const Scene& scene, std::uint32_t object) {
  return scene.objects[object].name;
}

/// Returns the strongest kind of contact between two surfaces: "faces lie on each other in 24 pairs
/// of triangles".
std::string contact_words(const ClashRow& row) {
  using enum ContactKind;
  std::uint64_t n = 0;
  const auto any = [&](auto... kinds) {
    return (n = (row.kinds[static_cast<std::size_t>(kinds)] + ...)) > 0;
  };
  const std::string how = any(crossing)          ? "surfaces cross"
                          : any(coplanar, equal) ? "faces lie on each other"
                          : any(touch_face)      ? "edges lie on faces"
                          : any(touch_edge)      ? "edges meet"
                          : any(touch_vertex)    ? "corners touch"
                                                 : "";
  return how + " in " + counted(n, "pair of triangles", "pairs of triangles");
}

/// Returns the id of a pair of parts. The order of the two names does not matter.
std::string id_of(std::string a, std::string b) {
  if (b < a) std::swap(a, b);
  return sha256(a + '\n' + b).substr(0, 8);
}
std::string id_of(const Scene& scene, const ClashRow& row) {
  return id_of(name_of(scene, row.objects.a), name_of(scene, row.objects.b));
}

struct CsvLine {
  long line = 0;  // number of the line, from 1
  std::vector<std::string> cells;
};

/// Splits a CSV text, as csv_cell() writes it, into lines of cells. Skips empty lines.
std::vector<CsvLine> csv_lines(const std::string& text) {
  std::vector<CsvLine> out;
  std::istringstream in(text);
  long number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty()) continue;
    CsvLine& row = out.emplace_back(CsvLine{.line = number, .cells = {""}});
    bool quoted = false;
    for (std::size_t k = 0; k < line.size(); ++k) {
      if (line[k] == '"' && quoted && line.substr(k + 1, 1) == "\"")
        row.cells.back() += line[k++];
      else if (line[k] == '"')
        quoted = !quoted;
      else if (line[k] == ',' && !quoted)
        row.cells.emplace_back();
      else
        row.cells.back() += line[k];
    }
  }
  return out;
}

const char* compared_word(const ClashTable& table, std::size_t row) {
  return table.compared->same[row] ? "same" : "new";
}

std::string depth_text(const ClashRow& row) {
  if (!row.depth) return "";
  const std::string low = short_number(row.depth->lo), high = short_number(row.depth->hi);
  return low == high ? high : (row.depth->lo > 0 ? low + " to " : "at most ") + high;
}

std::string place_text(const ClashRow& row) {
  const Vec3& p = row.witness[0];
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

bool lists_touches(const ClashTable& table) {
  return std::ranges::count(table.failing, ClashVerdict::touch) > 0;
}
bool is_hidden(const auto& row, const ClashTable& table) {
  return row.verdict == ClashVerdict::touch && !row.ignored && !lists_touches(table);
}

/// Returns why a clash or a containment has no depth. Returns "" if the row has a depth, or if the
/// row has another verdict.
std::string no_depth_words(const Scene& scene, const ClashRow& row) {
  const bool deep = row.verdict == ClashVerdict::clash || row.verdict == ClashVerdict::contained;
  if (!deep || row.depth) return "";
  if (row.open) return name_of(scene, *row.open) + " is not closed";
  return row.proved ? "not asked for" : "no overlap is proved";
}

std::string rows_text(const Scene& scene, const ClashRecord& record, const ClashTable& table) {
  const std::string unit = table.unit.empty() ? "" : " (" + table.unit + ")";
  Table out("lllrrrll", 3);  // the first 3 columns identify a row
  out.add({"verdict", "a", "b", "depth" + unit, "curve" + unit, "distance" + unit, "at", "what"});
  std::size_t all = 0;
  for (std::size_t k = 0; k < record.rows.size(); ++k) {
    const ClashRow& row = record.rows[k];
    if (is_hidden(row, table)) continue;
    if (++all > kRowsShown) continue;
    out.add({(table.compared ? compared_word(table, k) + std::string(" ") : "") +
                 to_string(row.verdict) + (row.ignored ? " (ignored)" : ""),
             name_of(scene, row.objects.a), name_of(scene, row.objects.b), depth_text(row),
             row.curve > 0 ? short_number(row.curve) : "",
             row.squared ? short_number(row.distance) : "", place_text(row),
             clash_words(scene, row) + (record.options.depth && row.open
                                            ? "; no depth: " + no_depth_words(scene, row)
                                            : "")});
  }
  for (std::size_t k = 0; table.compared && k < table.compared->gone.size(); ++k) {
    const auto& [a, b, verdict] = table.compared->gone[k];
    if (verdict == to_string(ClashVerdict::touch) && !lists_touches(table)) continue;
    if (++all <= kRowsShown) out.add({"gone " + verdict, a, b, "", "", "", "", ""});
  }
  if (all == 0) return "";
  const bool unasked = std::ranges::any_of(record.rows, [&](const ClashRow& row) {
    return no_depth_words(scene, row) == "not asked for";
  });
  return "\n" + out.text() + more_line(all, kRowsShown) +
         (unasked ? "depths are not asked for (--depth)\n" : "");
}

std::string heading(const Scene& scene) {
  return fmt::format("{}: {}, {}{}\n", scene.name, counted(scene.objects.size(), "part", "parts"),
                     counted(scene.triangles.size(), "triangle", "triangles"), folded_text(scene));
}

std::string counts_text(const ClashRecord& record) {
  std::string out;
  for (const ClashVerdict verdict : kClashVerdicts)
    out += fmt::format("{}{} {}{}", out.empty() ? "" : ", ", grouped(record.count(verdict)),
                       to_string(verdict),
                       verdict == ClashVerdict::touch && record.options.tolerance > 0
                           ? fmt::format(" ({} within tolerance)", grouped(record.within_tolerance))
                           : "");
  return out;
}

std::string tolerance_text(const ClashRecord& record, const ClashTable& table) {
  const double tolerance = record.options.tolerance;
  if (!(tolerance > 0)) return "";
  return fmt::format("tolerance  {:.6g}{}\n", tolerance,
                     table.unit.empty() ? "" : " " + table.unit);
}

/// Returns a text such as "2 new, 5 same, 1 gone".
std::string compared_text(const ClashComparison& compared) {
  const auto same = static_cast<std::size_t>(std::ranges::count(compared.same, true));
  return fmt::format("{} new, {} same, {} gone{}", grouped(compared.same.size() - same),
                     grouped(same), grouped(compared.gone.size()),
                     compared.unexamined > 0
                         ? fmt::format(", {} not examined", grouped(compared.unexamined))
                         : "");
}

/// Returns lines about likely faults of the input: copies of a part, and parts in different units.
std::string hints_text(const Scene& scene, const ClashRecord& record) {
  constexpr std::size_t kShown = 3;
  std::string out;
  for (std::size_t k = 0; k < std::min(kShown, record.copies.size()); ++k) {
    const auto& [a, b] = record.copies[k];
    out +=
        fmt::format("hint       {} and {} may be one part twice: as many triangles, in one box\n",
                    name_of(scene, a), name_of(scene, b));
  }
  if (record.copies.size() > kShown)
    out += fmt::format("hint       and {} others\n", grouped(record.copies.size() - kShown));
  if (record.sizes) {
    const double ratio = size_of(scene, record.sizes->b) / size_of(scene, record.sizes->a);
    out += fmt::format("hint       {} is {:.3g} times the size of {}: are all parts in one unit?\n",
                       name_of(scene, record.sizes->b), ratio, name_of(scene, record.sizes->a));
  }
  return out;
}

/// Returns a text such as "412.0 ms = read 80.1 + pairs 31.0 + ...".
std::string time_text(const ClashRecord& record) {
  using enum StageKind;
  std::vector<std::pair<std::string, double>> parts = {{"pairs", 0}};
  for (const Stage& stage : record.trace) {
    const bool own = stage.kind == read || stage.kind == contacts || stage.kind == touch ||
                     stage.kind == depth || stage.kind == inside || stage.kind == near;
    if (!own)
      parts.front().second += stage.ms;
    else
      parts.emplace_back(farcull::name_of(stage), stage.ms);
  }
  std::string out;
  for (const auto& [name, ms] : parts)
    out += fmt::format("{}{} {:.1f}", out.empty() ? "" : " + ", name, ms);
  return fmt::format("{:.1f} ms = {}", record.ms, out);
}

Json row_json(const Scene& scene, const ClashRow& row) {
  Json kinds = Json::object();
  for (const ContactKind kind : kContactKinds) {
    if (const std::uint64_t n = row.kinds[static_cast<std::size_t>(kind)]; n > 0)
      kinds[std::string(farcull::name_of(kind))] = n;
  }
  Json out = {{"object_a", row.objects.a},
              {"object_b", row.objects.b},
              {"name_a", name_of(scene, row.objects.a)},
              {"name_b", name_of(scene, row.objects.b)},
              {"id", id_of(scene, row)},
              {"verdict", to_string(row.verdict)},
              {"exact", to_string(row.exact)},
              {"ignored", row.ignored},
              {"proved", row.proved && !row.shallow},
              {"triangle_pairs", row.pairs},
              {"kinds", kinds},
              {"inner", json_of(row.inner)},
              {"distance", json_if(row.squared.has_value(), row.distance)},
              {"squared", row.squared ? Json(row.squared->text()) : Json(nullptr)},
              {"box", {point_json(row.box.lo), point_json(row.box.hi)}},
              {"witness", {point_json(row.witness[0]), point_json(row.witness[1])}},
              {"curve", row.curve},
              {"depth", nullptr},
              {"no_depth", text_json(no_depth_words(scene, row))}};
  if (const auto& depth = row.depth) {
    out["depth"] = {{"least", depth->lo},
                    {"most", depth->hi},
                    {"translation_of_a", point_json(depth->translation)}};
  }
  return out;
}

}  // namespace

std::string clash_words(const Scene& scene, const ClashRow& row) {
  if (row.verdict == ClashVerdict::contained) return name_of(scene, *row.inner) + " inside";
  if (row.verdict == ClashVerdict::unknown) {
    return "the one around " + name_of(scene, *row.inner) +
           " is not closed, or it is not certain what its faces enclose";
  }
  if (row.within_tolerance()) {
    return "within the tolerance; exactly: " + to_string(row.exact) +
           (row.pairs > 0 ? ", " + contact_words(row) : "");
  }
  if (row.pairs == 0) return "";
  const char* shallow = row.shallow ? "; not proved to be within the tolerance" : "";
  if (row.verdict == ClashVerdict::clash && row.kinds[std::size_t(ContactKind::crossing)] == 0) {
    return (row.proved ? "the insides overlap, and " : "not proved to touch only: ") +
           contact_words(row) + shallow;
  }
  return contact_words(row) + shallow;
}

ClashComparison compare_clashes(const Scene& scene, const ClashRecord& record,
                                const std::string& text, const std::string& name) {
  const auto fail = [&](const std::string& reason, long line) {
    throw Error(name, reason, "name a file that farcull clash --csv wrote without --frames", line);
  };
  using Row = std::array<std::string, 3>;  // the two names, sorted, and the verdict
  const auto row_of = [](std::string a, std::string b, std::string verdict) {
    if (b < a) std::swap(a, b);
    return Row{std::move(a), std::move(b), std::move(verdict)};
  };
  const std::vector<CsvLine> lines = csv_lines(text);
  std::map<std::string, std::size_t> column;
  for (std::size_t k = 0; !lines.empty() && k < lines[0].cells.size(); ++k)
    column[lines[0].cells[k]] = k;
  for (const char* wanted : {"name_a", "name_b", "verdict"}) {
    if (!column.contains(wanted)) fail(fmt::format("has no column {}", wanted), 1);
  }
  if (column.contains("frame")) fail("has a column frame: it is about many frames", 1);
  std::set<Row> old, forgiven;  // old: all rows of the file; forgiven: rows of ignored pairs
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const std::vector<std::string>& cells = lines[k].cells;
    if (cells.size() != lines[0].cells.size())
      fail(fmt::format("{} cells under {} names", cells.size(), lines[0].cells.size()),
           lines[k].line);
    if (column.contains("compared") && cells[column["compared"]] == "gone") continue;
    const Row row =
        row_of(cells[column["name_a"]], cells[column["name_b"]], cells[column["verdict"]]);
    old.insert(row);
    if (column.contains("ignored") && cells[column["ignored"]] == "1") forgiven.insert(row);
  }
  ClashComparison out;
  for (const ClashRow& row : record.rows) {
    const Row key = row_of(name_of(scene, row.objects.a), name_of(scene, row.objects.b),
                           to_string(row.verdict));
    out.same.push_back(old.erase(key) > 0 && (row.ignored || !forgiven.contains(key)));
  }
  std::map<std::string, std::uint32_t> numbers;
  for (std::uint32_t o = 0; o < scene.objects.size(); ++o) numbers[scene.objects[o].name] = o;
  // Returns true if the record has no row for this pair because the pair was not examined, or
  // because the pair is near and ignored.
  const auto left_out = [&](const std::string& name_a, const std::string& name_b, bool near) {
    if (!numbers.contains(name_a) || !numbers.contains(name_b)) return false;
    const auto [a, b] = std::minmax({numbers[name_a], numbers[name_b]});
    const auto has = [&](const auto& pairs) {
      return std::ranges::binary_search(pairs, ObjectPair{a, b});
    };
    return (record.options.only && !has(*record.options.only)) ||
           (near && has(record.options.ignored)) || scene.objects[a].triangle_count == 0 ||
           scene.objects[b].triangle_count == 0;
  };
  for (const auto& [a, b, verdict] : old) {
    if (left_out(a, b, verdict == to_string(ClashVerdict::near)))
      ++out.unexamined;
    else
      out.gone.push_back({a, b, verdict});
  }
  return out;
}

bool is_clean(const ClashRecord& record, const std::vector<ClashVerdict>& failing) {
  const auto none = [&](ClashVerdict verdict) { return record.count(verdict) == 0; };
  return record.asked > 0 && record.examined == record.asked && none(ClashVerdict::clash) &&
         none(ClashVerdict::contained) && none(ClashVerdict::unknown) &&
         std::ranges::all_of(failing, none);
}

std::string clash_text(const Scene& scene, const ClashRecord& record, const ClashTable& table) {
  std::string out = heading(scene);
  out += fmt::format("examined   {} of {} of parts{}\n", grouped(record.examined),
                     counted(record.asked, "pair", "pairs"),
                     is_clean(record, table.failing) ? ": clean" : "");
  out += "verdicts   " + counts_text(record) + "\n";
  out += tolerance_text(record, table);
  if (table.compared) out += "compared   " + compared_text(*table.compared) + "\n";
  if (record.ignored > 0) {
    out += fmt::format("ignored    {}, of which {}\n", counted(record.ignored, "pair", "pairs"),
                       counted(record.ignored_meet, "meets", "meet"));
  }
  for (const std::uint32_t object : record.empty)
    out += "not examined: " + name_of(scene, object) + " has no triangles\n";
  return out + hints_text(scene, record) + rows_text(scene, record, table) +
         fmt::format("\ntime       {}\n", time_text(record));
}

std::string clash_csv(const Scene& scene, const ClashRecord& record, const ClashTable& table) {
  std::string out =
      "name_a,name_b,id,verdict,exact,ignored,proved,triangle_pairs,inner,distance,squared,"
      "depth_least,depth_most,no_depth,curve,"
      "x_lo,y_lo,z_lo,x_hi,y_hi,z_hi,x_a,y_a,z_a,x_b,y_b,z_b,object_a,object_b";
  for (const ContactKind kind : kContactKinds) out += fmt::format(",{}", farcull::name_of(kind));
  out += table.compared ? ",compared\n" : "\n";
  for (std::size_t k = 0; k < record.rows.size(); ++k) {
    const ClashRow& row = record.rows[k];
    out += fmt::format("{},{},{},{},{},{},{},{},{},", csv_cell(name_of(scene, row.objects.a)),
                       csv_cell(name_of(scene, row.objects.b)), id_of(scene, row),
                       to_string(row.verdict), to_string(row.exact), int{row.ignored},
                       int{row.proved && !row.shallow}, row.pairs,
                       row.inner ? csv_cell(name_of(scene, *row.inner)) : "");
    out += row.squared ? fmt::format("{},{},", row.distance, row.squared->text()) : ",,";
    out += row.depth ? fmt::format("{},{},", row.depth->lo, row.depth->hi) : ",,";
    out += fmt::format("{},{}", csv_cell(no_depth_words(scene, row)), row.curve);
    for (const Vec3& p : {row.box.lo, row.box.hi, row.witness[0], row.witness[1]})
      out += fmt::format(",{},{},{}", p.x(), p.y(), p.z());
    out += fmt::format(",{},{}", row.objects.a, row.objects.b);
    for (const std::uint64_t n : row.kinds) out += fmt::format(",{}", n);
    out += table.compared ? fmt::format(",{}\n", compared_word(table, k)) : "\n";
  }
  if (!table.compared) return out;
  const auto columns = std::count(out.begin(), std::ranges::find(out, '\n'), ',');
  for (const auto& [a, b, verdict] : table.compared->gone) {
    out += fmt::format("{},{},{},{}{}gone\n", csv_cell(a), csv_cell(b), id_of(a, b), verdict,
                       std::string(static_cast<std::size_t>(columns) - 3, ','));
  }
  return out;
}

Json clash_json(const Scene& scene, const ClashRecord& record, const ClashTable& table) {
  const auto pair_json = [&](const ObjectPair& pair) {
    return Json{name_of(scene, pair.a), name_of(scene, pair.b)};
  };
  Json rows = json_list(record.rows, [&](const ClashRow& r) { return row_json(scene, r); });
  Json gone = Json::array();
  for (std::size_t k = 0; table.compared && k < rows.size(); ++k)
    rows[k]["compared"] = compared_word(table, k);
  if (table.compared) {
    gone = json_list(table.compared->gone, [](const ClashComparison::Gone& g) {
      return Json{
          {"name_a", g.a}, {"name_b", g.b}, {"id", id_of(g.a, g.b)}, {"verdict", g.verdict}};
    });
  }
  Json verdicts = Json::object();
  for (const ClashVerdict verdict : kClashVerdicts)
    verdicts[to_string(verdict)] = record.count(verdict);
  return {{"scene", scene.name},
          {"objects", json_list(scene.objects, [](const Object& object) { return object.name; })},
          {"triangles", scene.triangles.size()},
          {"folded_polygons", scene.folded.size()},
          {"unit", text_json(table.unit)},
          {"clearance", record.options.clearance},
          {"tolerance", record.options.tolerance},
          {"asked", record.asked},
          {"examined", record.examined},
          {"clean", is_clean(record, table.failing)},
          {"verdicts", verdicts},
          {"within_tolerance", record.within_tolerance},
          {"ignored", record.ignored},
          {"ignored_meet", record.ignored_meet},
          {"without_triangles", record.empty},
          {"copies", json_list(record.copies, pair_json)},
          {"sizes_differ", record.sizes ? pair_json(*record.sizes) : Json(nullptr)},
          {"pairs", rows},
          {"gone", gone},
          {"gone_unexamined", table.compared ? table.compared->unexamined : 0},
          {"triangle_pairs", record.triangle_pairs},
          {"stages", stages_json(record.trace)},
          {"time_ms", {{"total", record.ms}}},
          {"commit", FARCULL_COMMIT}};
}

ClashFrames::Report ClashFrames::add(const Scene& scene, const ClashRecord& record,
                                     const ClashTable& table, long frame) {
  const Json all = clash_json(scene, record, table);
  Report out;
  out.frame["frame"] = frame;
  std::istringstream lines(clash_csv(scene, record, table));
  std::string line;
  std::getline(lines, line);
  if (frames_ == 0) {
    for (const char* key : {"scene", "objects", "unit", "clearance", "tolerance", "commit"})
      head_[key] = all[key];
    out.csv = "frame," + line + "\n";
    out.text = heading(scene) + tolerance_text(record, table) + hints_text(scene, record) +
               fmt::format("\n{:>7}", "frame");
    for (const ClashVerdict v : kClashVerdicts) out.text += fmt::format("  {:>9}", to_string(v));
    out.text += "\n";
  }
  while (std::getline(lines, line)) out.csv += fmt::format("{},{}\n", frame, line);
  for (const auto& [key, value] : all.items()) {
    if (!head_.contains(key) || head_[key] != value) out.frame[key] = value;
  }
  out.text += fmt::format("{:>7}", frame);
  for (const std::uint64_t n : record.verdicts) out.text += fmt::format("  {:>9}", grouped(n));
  out.text += "\n";
  for (const ClashRow& row : record.rows) {
    const std::string &a = name_of(scene, row.objects.a), &b = name_of(scene, row.objects.b);
    WorstClash& worst = pairs_[std::minmax(a, b)];
    if (worst.id.empty()) worst = {.name_a = a, .name_b = b, .id = id_of(a, b)};
    if (row.verdict < worst.verdict)
      worst.verdict = row.verdict, worst.first = frame, worst.frames = 0;
    if (row.verdict == worst.verdict) worst.last = frame, ++worst.frames;
    worst.ignored = row.ignored;
    if (record.options.depth && row.depth && !(worst.depth >= row.depth->lo))
      worst.depth = row.depth->lo, worst.deepest = frame;
    if ((row.pairs > 0 || row.squared) && !(worst.distance && *worst.distance <= row.distance))
      worst.distance = row.distance, worst.nearest = frame;
  }
  ++frames_;
  clean_ = clean_ && all["clean"];
  out.head = head_;
  out.summary = {
      {"wanted", wanted_}, {"frames", frames_}, {"clean", is_clean()}, {"pairs", json_of(worst())}};
  return out;
}

std::vector<WorstClash> ClashFrames::worst() const {
  std::vector<WorstClash> out;
  for (const auto& [names, pair] : pairs_) out.push_back(pair);
  std::ranges::stable_sort(out, {}, [](const WorstClash& pair) {
    return std::tuple(pair.ignored, pair.verdict, -pair.depth.value_or(0),
                      pair.distance.value_or(0));
  });
  return out;
}

std::string ClashFrames::text(const ClashTable& table) const {
  const std::string unit = table.unit.empty() ? "" : " (" + table.unit + ")";
  const auto at = [](const std::optional<double>& value, const std::optional<long>& frame) {
    return value ? fmt::format("{:.6g} in {}", *value, *frame) : "";
  };
  Table out("lllrrrrr", 3);
  out.add({"worst", "a", "b", "frames", "first", "last", "depth" + unit, "distance" + unit});
  std::size_t all = 0;
  for (const WorstClash& pair : worst()) {
    if (is_hidden(pair, table) || ++all > kRowsShown) continue;
    out.add({to_string(pair.verdict) + (pair.ignored ? " (ignored)" : ""), pair.name_a, pair.name_b,
             grouped(pair.frames), std::to_string(pair.first), std::to_string(pair.last),
             at(pair.depth, pair.deepest), at(pair.distance, pair.nearest)});
  }
  return (all == 0 ? "" : "\n" + out.text() + more_line(all, kRowsShown)) +
         fmt::format("\n{} of {}{}\n", grouped(frames_), counted(wanted_, "frame", "frames"),
                     is_clean() ? ": clean" : "");
}

}  // namespace farcull
