#include "experiments/picture/picture.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commit.h"
#include "embedded/clash_html.h"
#include "embedded/clash_js.h"
#include "experiments/picture/page_parts.h"
#include "experiments/record/output.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {
namespace {

using nlohmann::json;

/// The data of a row. Appends the ends of the segments of its curve to `segments`.
json row_of(const Scene& scene, const ClashRow& row, const Box& box, std::vector<Vec3>& segments) {
  // For parts that are apart: the line between two nearest points.
  std::vector<std::array<Vec3, 2>> lines = row.segments;
  if (row.squared && !row.inner) lines.push_back(row.witness);
  const std::size_t first = segments.size();
  for (const auto& ends : lines) segments.insert(segments.end(), ends.begin(), ends.end());
  const std::vector<Vec3> corners = {row.box.lo, row.box.hi};
  json out = {{"a", row.objects.a},
              {"b", row.objects.b},
              {"verdict", to_string(row.verdict)},
              {"exact", to_string(row.exact)},
              {"ignored", row.ignored},
              {"what", clash_words(scene, row)},
              {"depth", nullptr},
              {"curve", row.curve},
              {"distance", row.squared ? json(row.distance) : json(nullptr)},
              {"at", point_json(row.witness[0])},
              {"inner", json_of(row.inner)},
              {"box", quantized(corners, box)},
              {"segments", {first / 2, lines.size()}}};
  if (row.depth) out["depth"] = {row.depth->lo, row.depth->hi};
  return out;
}

}  // namespace

void require_clash_page(const Scene& scene) {
  require_three();
  require_page_size(scene);
}

std::string clash_page(const Scene& scene, const ClashRecord& record, const std::string& unit) {
  require_clash_page(scene);
  const Box box = bounds(scene);
  PageBlocks blocks;
  json frame = page_vertices(scene, box, blocks);
  add_page_triangles(scene, blocks, frame);
  const std::string none = blocks.add(packed_numbers({}));
  frame["a"] = frame["b"] = frame["contacts"] = none;
  json rows = json::array();
  std::vector<Vec3> segments;
  for (const ClashRow& row : record.rows) rows.push_back(row_of(scene, row, box, segments));
  json about = page_box(box);
  about.update(
      json{{"title", scene.name},
           {"commit", FARCULL_COMMIT},
           {"unit", unit},
           {"asked", record.asked},
           {"examined", record.examined},
           {"clean", is_clean(record)},
           {"forward", {-0.55, 0.7, -0.45}},
           {"worldUp", {0, 0, 1}},
           {"zoom", false},
           {"rows", rows},
           {"segments", blocks.add(packed_numbers(quantized(segments, box)))},
           {"frame", frame},
           // Two hues that people with colour blindness can distinguish; neither one is green.
           {"colours",
            {{"found", {0, 0, 0}},
             {"missed", {0, 0, 0}},
             {"idle", {232, 128, 16}},
             {"idlePart", 1},
             {"through", 0},
             {"objects", json(8, {60, 120, 216})}}}});
  return framed_page("Clashes by farcull", embedded::clash_html, blocks, about, embedded::clash_js);
}

}  // namespace farcull
