// Turns distances into JSON, CSV and text.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "commit.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kRowsShown = 24;
// Words for the values of DistancePairs and of WhichInside. WhichInside::unknown has no word.
constexpr std::array kPairsAsked = {"objects", "nearest", "all"};
constexpr std::array kInside = {"", "none", "a", "b", "not closed"};

std::array<std::uint32_t, 2> within_objects(const Scene& scene, const Distance& d) {
  return {d.triangles.a - scene.objects[d.objects.a].first_triangle,
          d.triangles.b - scene.objects[d.objects.b].first_triangle};
}

Json pair_json(const Scene& scene, const Distance& d) {
  const Closest& c = d.closest;
  const auto [s, t] = within_objects(scene, d);
  return {{"a", d.objects.a},
          {"b", d.objects.b},
          {"distance", c.distance},
          {"squared", c.squared.text()},
          {"witness", {point_json(c.points[0]), point_json(c.points[1])}},
          {"features", {to_string(c.features[0]), to_string(c.features[1])}},
          {"triangles", {s, t}},
          {"faces", {scene.source_face[d.triangles.a], scene.source_face[d.triangles.b]}},
          {"inside", text_json(kInside.at(static_cast<std::size_t>(d.inside)))}};
}

std::uint32_t other_of(const Distance& d, std::uint32_t object) {
  return d.objects.a == object ? d.objects.b : d.objects.a;
}

Json nearest_json(const Scene& scene, const DistanceRecord& record) {
  if (record.options.pairs != DistancePairs::nearest) return nullptr;
  Json out = Json::array();
  for (const NearestOfObject& of : nearest_of_objects(scene, record.distances, record.options.k)) {
    Json others = Json::array();
    for (const std::size_t d : of.distances)
      others.push_back({{"object", other_of(record.distances[d], of.object)}, {"pair", d}});
    out.push_back({{"object", of.object}, {"others", others}});
  }
  return out;
}

Json verification_json(const Scene& scene, const std::optional<DistanceAccounting>& accounting) {
  if (!accounting) return nullptr;
  Json out = json_of(*accounting);
  out["examples"] = pairs_json(scene, accounting->examples);
  out["ms"] = accounting->ms;
  return out;
}

std::string object_text(const Scene& scene, std::uint32_t object) {
  return fmt::format("{} {}", object, scene.objects[object].name);
}

std::string place_text(const Scene& scene, const Distance& d, int side) {
  return fmt::format("{} {}", within_objects(scene, d)[side], to_string(d.closest.features[side]));
}

std::string inside_cell(const Distance& d) {
  constexpr std::array kTexts = {"-", "no", "a in b", "b in a", "not closed"};
  return kTexts.at(static_cast<std::size_t>(d.inside));
}

std::string distance_text(const Distance& d) { return fmt::format("{}", d.closest.distance); }

/// Returns a line with the least of all distances and its two objects. Returns "" if there are
/// fewer than two distances.
std::string least_line(const Scene& scene, const std::vector<Distance>& distances) {
  if (distances.size() < 2) return "";
  const auto least = std::min_element(
      distances.begin(), distances.end(),
      [](const Distance& a, const Distance& b) { return a.closest.squared < b.closest.squared; });
  return fmt::format("least      {}, of {} and {}{}\n", distance_text(*least),
                     object_text(scene, least->objects.a), object_text(scene, least->objects.b),
                     least->closest.squared.is_zero() ? ", which meet" : "");
}

std::string pairs_table(const Scene& scene, const std::vector<Distance>& distances, bool inside) {
  Table table(inside ? "llrlll" : "llrll");
  std::vector<std::string> header{"a", "b", "distance", "triangle of a", "triangle of b"};
  if (inside) header.push_back("inside");
  table.add(header);
  const std::size_t shown = std::min(distances.size(), kRowsShown);
  for (std::size_t k = 0; k < shown; ++k) {
    const Distance& d = distances[k];
    std::vector<std::string> row{object_text(scene, d.objects.a), object_text(scene, d.objects.b),
                                 distance_text(d), place_text(scene, d, 0),
                                 place_text(scene, d, 1)};
    if (inside) row.push_back(inside_cell(d));
    table.add(row);
  }
  return table.text() + more_line(distances.size(), shown);
}

std::string nearest_table(const Scene& scene, const DistanceRecord& record) {
  Table table("lrlrll");
  table.add({"object", "", "nearest other", "distance", "triangle", "of the other"});
  const std::vector<NearestOfObject> all =
      nearest_of_objects(scene, record.distances, record.options.k);
  std::size_t rows = 0, shown = 0;
  for (const NearestOfObject& of : all) {
    if (rows >= kRowsShown) break;
    ++shown;
    if (of.distances.empty()) table.add({object_text(scene, of.object), "", "none", "", "", ""});
    for (std::size_t k = 0; k < of.distances.size(); ++k, ++rows) {
      const Distance& d = record.distances[of.distances[k]];
      const int own = d.objects.a == of.object ? 0 : 1;
      table.add({object_text(scene, of.object), std::to_string(k + 1),
                 object_text(scene, other_of(d, of.object)), distance_text(d),
                 place_text(scene, d, own), place_text(scene, d, 1 - own)});
    }
  }
  return table.text() + more_line(all.size(), shown);
}

std::string question_text(const DistanceOptions& options) {
  std::string text = "all pairs of triangles";
  if (options.pairs == DistancePairs::objects) text = "the nearest triangles of every two objects";
  if (options.pairs == DistancePairs::nearest) {
    text = options.k == 1 ? "of each object the nearest other one"
                          : fmt::format("of each object the {} nearest others", options.k);
  }
  if (std::isfinite(options.within)) text += fmt::format(" within {}", options.within);
  return text;
}

std::string accounting_lines(const Scene& scene, const DistanceRecord& record) {
  if (!record.verification) return "";
  const DistanceAccounting& v = *record.verification;
  std::string out = verdict_text(v) + "\n" + accounting_sum(v);
  for (const TrianglePair& pair : v.examples)
    out +=
        fmt::format("  missed: {} and {}\n", place_text(scene, pair.a), place_text(scene, pair.b));
  return out;
}

}  // namespace

Json distances_json(const Scene& scene, const DistanceRecord& record,
                    std::optional<std::uint64_t> seed) {
  const DistanceOptions& o = record.options;
  return {{"scene", scene_json(scene, record.degenerate_triangles, record.scene_hash)},
          {"objects", json_list(scene.objects, [](const Object& object) { return object.name; })},
          {"pairs_asked", kPairsAsked.at(static_cast<std::size_t>(o.pairs))},
          {"k", json_if(o.pairs == DistancePairs::nearest, o.k)},
          {"within", o.within},
          {"inside_by", text_json(o.inside ? "winding number" : "")},
          {"ignored", scene.ignored.size()},
          {"pairs",
           json_list(record.distances, [&](const Distance& d) { return pair_json(scene, d); })},
          {"nearest", nearest_json(scene, record)},
          {"counts", FARCULL_JSON(record.counts, box_pairs, triangle_pairs, kept)},
          {"stages", stages_json(record.trace)},
          {"verification", verification_json(scene, record.verification)},
          {"time_ms", {{"total", record.ms}}},
          {"seed", json_of(seed)},
          {"commit", FARCULL_COMMIT}};
}

std::string distances_header() {
  return "object_a,triangle_a,object_b,triangle_b,distance,squared,x_a,y_a,z_a,x_b,y_b,z_b,"
         "feature_a,feature_b,inside\n";
}

std::string distances_rows(const Scene& scene, const DistanceRecord& record,
                           const std::string& before) {
  std::string out;
  for (const Distance& d : record.distances) {
    const Closest& c = d.closest;
    const auto [s, t] = within_objects(scene, d);
    out += fmt::format("{}{},{},{},{},{},{}", before, d.objects.a, s, d.objects.b, t, c.distance,
                       c.squared.text());
    for (const Vec3& p : c.points) out += fmt::format(",{},{},{}", p.x(), p.y(), p.z());
    out += fmt::format(",{},{},{}\n", to_string(c.features[0]), to_string(c.features[1]),
                       kInside.at(static_cast<std::size_t>(d.inside)));
  }
  return out;
}

std::string verdict_text(const DistanceAccounting& v) {
  const std::string all = counted(v.pairs_total, "pair", "pairs") + " accounted for";
  if (v.holds()) return "verified: the answers are right, no nearer pair was culled, " + all;
  std::string what;
  if (v.nearer > 0) what = counted(v.nearer, "nearer pair was", "nearer pairs were") + " culled, ";
  if (v.earlier > 0)
    what += counted(v.earlier, "pair as near comes", "pairs as near come") + " before an answer, ";
  if (v.wrong > 0) what += counted(v.wrong, "answer is", "answers are") + " wrong, ";
  return "NOT verified: " + what + all;
}

std::string accounting_sum(const DistanceAccounting& v) {
  return fmt::format(
      "accounted  {} = {} answered{} + {} farther by boxes\n           + {} by planes + {} by "
      "exact "
      "distances{}{} + {} missed\n",
      counted(v.pairs_total, "pair", "pairs"), grouped(v.answers),
      v.objects_meet > 0 ? " + " + grouped(v.objects_meet) + " of objects that meet" : "",
      grouped(v.farther_by_boxes), grouped(v.farther_by_planes), grouped(v.farther_by_exact),
      v.neighbours > 0 ? " + " + grouped(v.neighbours) + " neighbours" : "",
      v.earlier > 0 ? " + " + grouped(v.earlier) + " as near and before an answer" : "",
      grouped(v.nearer));
}

std::string distances_table(const Scene& scene, const DistanceRecord& record) {
  std::string out = scene_text(scene, record.degenerate_triangles);
  out += "\nasked      " + question_text(record.options) + "\n";
  if (!scene.ignored.empty())
    out +=
        "ignored    " + counted(scene.ignored.size(), "pair of objects", "pairs of objects") + "\n";
  out += fmt::format("answered   {}\n", counted(record.distances.size(), "pair", "pairs"));
  out += least_line(scene, record.distances) + "\n";
  if (!record.distances.empty()) {
    out += record.options.pairs == DistancePairs::nearest
               ? nearest_table(scene, record)
               : pairs_table(scene, record.distances,
                             record.options.inside && record.options.pairs != DistancePairs::all);
    out += "nearest points and exact squares: with --csv or --json\n\n";
  }
  out += stage_table(record.trace) + "\n";
  out += fmt::format(
      "time       {:.1f} ms{}\n", record.ms,
      record.verification ? fmt::format("; accounting {:.1f} more", record.verification->ms) : "");
  return out + accounting_lines(scene, record);
}

}  // namespace farcull
