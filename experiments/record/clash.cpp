#include "experiments/record/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "commit.h"
#include "core/base/text.h"
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

std::string kinds_text(const ClashRow& row) {
  std::string out;
  for (const ContactKind kind : kContactKinds) {
    if (const std::uint64_t n = row.kinds[static_cast<std::size_t>(kind)]; n > 0)
      out += fmt::format("{}{} {}", out.empty() ? "" : ", ", grouped(n), farcull::name_of(kind));
  }
  return out;
}

std::string depth_text(const ClashRow& row) {
  if (!row.depth) return "";
  const std::string low = short_number(row.depth->lo), high = short_number(row.depth->hi);
  return low == high ? high : low + " to " + high;
}

std::string distance_text(const ClashRow& row) {
  return row.squared ? short_number(row.distance) : "";
}

std::string place_text(const ClashRow& row) {
  const Vec3& p = row.witness[0];
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

std::string rows_text(const Scene& scene, const ClashRecord& record, const ClashTable& table) {
  const std::string unit = table.unit.empty() ? "" : " (" + table.unit + ")";
  Table out("lllrrrll");
  out.add({"verdict", "a", "b", "depth" + unit, "curve" + unit, "distance" + unit, "at", "what"});
  std::size_t all = 0;
  const bool touches = std::ranges::count(table.failing, ClashVerdict::touch) > 0;
  for (const ClashRow& row : record.rows) {
    if (row.verdict == ClashVerdict::touch && !touches && !row.ignored) continue;
    if (++all > kRowsShown) continue;
    out.add({to_string(row.verdict) + (row.ignored ? " (ignored)" : ""),
             name_of(scene, row.objects.a), name_of(scene, row.objects.b), depth_text(row),
             row.curve > 0 ? short_number(row.curve) : "", distance_text(row), place_text(row),
             clash_words(scene, row)});
  }
  if (all == 0) return "";
  const bool deep = record.count(ClashVerdict::clash) + record.count(ClashVerdict::contained) > 0;
  const std::string hint =
      deep && !record.options.depth ? "depths are not asked for (--depth)\n" : "";
  return "\n" + out.text() + more_line(all, kRowsShown) + hint;
}

std::string counts_text(const ClashRecord& record) {
  std::string out;
  for (const ClashVerdict verdict : kClashVerdicts)
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", grouped(record.count(verdict)),
                       to_string(verdict));
  return out;
}

/// "412.0 ms = read 80.1 + pairs 31.0 + ...".
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
              {"verdict", to_string(row.verdict)},
              {"ignored", row.ignored},
              {"proved", row.proved},
              {"triangle_pairs", row.pairs},
              {"kinds", kinds},
              {"inner", json_of(row.inner)},
              {"distance", json_if(row.squared.has_value(), row.distance)},
              {"squared", row.squared ? Json(row.squared->text()) : Json(nullptr)},
              {"box", {point_json(row.box.lo), point_json(row.box.hi)}},
              {"witness", {point_json(row.witness[0]), point_json(row.witness[1])}},
              {"curve", row.curve},
              {"depth", nullptr}};
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
           " is not closed, or its faces do not all face outward";
  }
  const bool doubtful = row.verdict == ClashVerdict::clash && !row.proved;
  return (doubtful ? "not proved to touch only: " : "") + kinds_text(row);
}

bool is_clean(const ClashRecord& record, const std::vector<ClashVerdict>& failing) {
  const auto none = [&](ClashVerdict verdict) { return record.count(verdict) == 0; };
  return record.examined == record.asked && none(ClashVerdict::clash) &&
         none(ClashVerdict::contained) && none(ClashVerdict::unknown) &&
         std::ranges::all_of(failing, none);
}

std::string clash_text(const Scene& scene, const ClashRecord& record, const ClashTable& table) {
  std::string out =
      fmt::format("{}: {}, {}{}\n", scene.name, counted(scene.objects.size(), "part", "parts"),
                  counted(scene.triangles.size(), "triangle", "triangles"), folded_text(scene));
  out += fmt::format("examined   {} of {} of parts{}\n", grouped(record.examined),
                     counted(record.asked, "pair", "pairs"),
                     is_clean(record, table.failing) ? ": clean" : "");
  out += "verdicts   " + counts_text(record) + "\n";
  if (record.ignored > 0) {
    out += fmt::format("ignored    {}, of which {}\n", counted(record.ignored, "pair", "pairs"),
                       counted(record.ignored_meet, "meets", "meet"));
  }
  for (const std::uint32_t object : record.empty)
    out += "not examined: " + name_of(scene, object) + " has no triangles\n";
  return out + rows_text(scene, record, table) +
         fmt::format("\ntime       {}\n", time_text(record));
}

std::string clash_csv(const Scene& scene, const ClashRecord& record) {
  std::string out =
      "object_a,object_b,name_a,name_b,verdict,ignored,proved,triangle_pairs,inner,distance,"
      "squared,"
      "depth_least,depth_most,curve,x_lo,y_lo,z_lo,x_hi,y_hi,z_hi,x_a,y_a,z_a,x_b,y_b,z_b";
  for (const ContactKind kind : kContactKinds) out += fmt::format(",{}", farcull::name_of(kind));
  out += "\n";
  for (const ClashRow& row : record.rows) {
    out += fmt::format("{},{},{},{},{},{},{},{},{},", row.objects.a, row.objects.b,
                       csv_cell(name_of(scene, row.objects.a)),
                       csv_cell(name_of(scene, row.objects.b)), to_string(row.verdict),
                       int{row.ignored}, int{row.proved}, row.pairs,
                       row.inner ? std::to_string(*row.inner) : "");
    out += row.squared ? fmt::format("{},{},", row.distance, row.squared->text()) : ",,";
    out += row.depth ? fmt::format("{},{},", row.depth->lo, row.depth->hi) : ",,";
    out += fmt::format("{}", row.curve);
    for (const Vec3& p : {row.box.lo, row.box.hi, row.witness[0], row.witness[1]})
      out += fmt::format(",{},{},{}", p.x(), p.y(), p.z());
    for (const std::uint64_t n : row.kinds) out += fmt::format(",{}", n);
    out += "\n";
  }
  return out;
}

Json clash_json(const Scene& scene, const ClashRecord& record, const std::string& unit,
                const std::vector<ClashVerdict>& failing) {
  Json verdicts = Json::object();
  for (const ClashVerdict verdict : kClashVerdicts)
    verdicts[to_string(verdict)] = record.count(verdict);
  return {{"scene", scene.name},
          {"objects", json_list(scene.objects, [](const Object& object) { return object.name; })},
          {"triangles", scene.triangles.size()},
          {"folded_polygons", scene.folded.size()},
          {"unit", text_json(unit)},
          {"clearance", record.options.clearance},
          {"asked", record.asked},
          {"examined", record.examined},
          {"clean", is_clean(record, failing)},
          {"verdicts", verdicts},
          {"ignored", record.ignored},
          {"ignored_meet", record.ignored_meet},
          {"without_triangles", record.empty},
          {"pairs", json_list(record.rows, [&](const ClashRow& r) { return row_json(scene, r); })},
          {"triangle_pairs", record.triangle_pairs},
          {"stages", stages_json(record.trace)},
          {"time_ms", {{"total", record.ms}}},
          {"commit", FARCULL_COMMIT}};
}

}  // namespace farcull
