// What a run on a tile, and a plan of tiles, tell people and programs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/bytes.h"
#include "experiments/record/tables.h"
#include "experiments/system/text_table.h"
#include "experiments/tiles/run_tile.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

std::string axis_name(int axis) { return std::string(1, "xyz"[axis]); }

// Null where a tile has no end on this side.
Json end_json(double at) { return std::isfinite(at) ? Json(at) : Json(nullptr); }

// The pairs of objects, in the same text for all tiles. Not as names: the same name may be of
// another object, and scene_hash() leaves names out.
std::string ignored_text(const std::vector<ObjectPair>& ignored) {
  if (ignored.empty()) return "";
  Fnv1a hash;
  for (const ObjectPair& pair : ignored) {
    hash.add(std::uint64_t{pair.a});
    hash.add(std::uint64_t{pair.b});
  }
  return fmt::format("{}, {}", counted(ignored.size(), "pair", "pairs"), hash.hex());
}

std::string interval_text(const Slab& slab) {
  const bool first = slab.from == -HUGE_VAL, last = slab.to == HUGE_VAL;
  if (first && last) return "everything";
  if (first) return fmt::format("{} below {}", axis_name(slab.axis), slab.to);
  if (last) return fmt::format("{} from {} on", axis_name(slab.axis), slab.from);
  return fmt::format("{} from {} to below {}", axis_name(slab.axis), slab.from, slab.to);
}

// A triangle in the numbers of the whole scene.
void renumber(const TileScene& part, const std::vector<std::uint32_t>& owner,
              std::uint32_t triangle, Json& place) {
  place["object"] = part.numbers.objects[owner[triangle]];
  place["triangle"] = part.numbers.triangles[triangle];
}

Json list_json(const TileList& list) {
  Sha256 hash;
  hash.add(list.text);
  Json kinds = Json::array();
  for (const ContactKind kind : list.columns.kinds) kinds.push_back(std::string(name_of(kind)));
  return {{"file", list.file},
          {"columns", list.text.substr(0, list.text.find('\n'))},
          {"kinds", kinds},
          {"rows", std::ranges::count(list.text, '\n') - 1},
          {"sha256", hash.digest()}};
}

// Bytes of memory for each triangle of a tile without the accounting: more than was measured on
// large tiles (docs/tiles.md).
constexpr double kBytesPerTriangle = 100;

double expected_mib(const TileCount& count) {
  return kBytesPerTriangle * static_cast<double>(count.triangles) / (1 << 20);
}

}  // namespace

Json tile_json(const TileRun& run, const TileList* list) {
  const Scene& scene = run.part.scene;
  const RunOptions& o = run.record.options;
  Json out = to_json(scene, run.record);
  const std::string nothing = nothing_to_test(run.census).reason;
  out["scene"] = {{"name", run.census.name},
                  {"objects", run.census.objects},
                  {"self_objects", run.census.self_objects},
                  {"triangles", run.census.triangles},
                  {"nothing_to_test", nothing.empty() ? Json(nullptr) : Json(nothing)},
                  {"hash", run.part.hash}};
  if (run.record.verification) {
    const std::vector<std::uint32_t> owner = owners(scene);
    const std::vector<TrianglePair>& examples = run.record.verification->examples;
    for (std::size_t k = 0; k < examples.size(); ++k) {
      Json& example = out["verification"]["examples"][k];
      renumber(run.part, owner, examples[k].a, example["a"]);
      renumber(run.part, owner, examples[k].b, example["b"]);
    }
  }
  Json cuts = Json::array();
  for (const double cut : run.cuts.at) cuts.push_back(cut);
  out["tile"] = {
      {"k", run.tile.k},
      {"n", run.tile.n},
      {"axis", axis_name(run.cuts.axis)},
      {"from", end_json(run.slab.from)},
      {"to", end_json(run.slab.to)},
      {"cuts", cuts},
      {"objects", scene.objects.size()},
      {"triangles", scene.triangles.size()},
      {"home_triangles", run.part.home},
      {"degenerate_triangles", run.record.degenerate_triangles},
      {"candidates_elsewhere", run.elsewhere},
      {"options",
       {{"resolution", o.resolution},
        {"views", o.views},
        {"clearance", o.clearance},
        {"full", o.full},
        {"verify", o.verify},
        {"contacts", o.contacts != ContactDetail::none},
        {"ignored", ignored_text(run.ignored)},
        {"faces", list && list->columns.faces ? Json(run.part.faces_hash) : Json(nullptr)}}},
      {"list", list ? list_json(*list) : Json(nullptr)},
      {"read_ms", run.read_ms},
      {"peak_memory_mib", peak_memory_mib()}};
  return out;
}

NothingToTest nothing_to_test(const Census& census) {
  // A scene that has as much to test: of its objects two with triangles, and one without.
  Scene few;
  std::uint32_t with = 0, without = 0;
  for (const auto& [word, times] : census.sizes) {
    Object object{
        .name = {}, .triangle_count = static_cast<std::uint32_t>(word), .self = word >> 32 != 0};
    std::uint32_t& count = object.triangle_count > 0 ? with : without;
    const std::uint32_t most = object.triangle_count > 0 ? 2 : 1;
    for (std::uint64_t k = 0; k < times && count < most; ++k, ++count)
      few.objects.push_back(object);
  }
  few.triangles.resize(std::min<std::uint64_t>(census.triangles, 2));
  return nothing_to_test(few);
}

std::string tile_lines(const TileRun& run) {
  return fmt::format(
      "tile       {} of {}: {}; {} of {} meet it, {} begin in it\n"
      "           pairs of other tiles are not covered: {} left to them; farcull merge joins all\n"
      "memory     {:.0f} MiB at most; the scene was read twice in {:.1f} ms\n",
      run.tile.k, run.tile.n, interval_text(run.slab), grouped(run.part.scene.triangles.size()),
      counted(run.census.triangles, "triangle", "triangles"), grouped(run.part.home),
      counted(run.elsewhere, "candidate pair is", "candidate pairs are"), peak_memory_mib(),
      run.read_ms);
}

std::string tiles_table(const Census& census, const Cuts& cuts,
                        const std::vector<TileCount>& counts) {
  Table table("rrrrr");
  table.add({"tile", axis_name(cuts.axis) + " from", "triangles", "begin in it", "about MiB"});
  for (std::size_t k = 0; k < counts.size(); ++k) {
    table.add({fmt::format("{}/{}", k + 1, counts.size()),
               k == 0 ? "-inf" : fmt::format("{}", cuts.at[k - 1]), grouped(counts[k].triangles),
               grouped(counts[k].home), fmt::format("{:.0f}", expected_mib(counts[k]))});
  }
  return fmt::format("{}: {}, {}, {} along {}\n\n{}", census.name,
                     counted(census.objects, "object", "objects"),
                     counted(census.triangles, "triangle", "triangles"),
                     counted(cuts.tiles(), "tile", "tiles"), axis_name(cuts.axis), table.text());
}

Json tiles_json(const Census& census, const Cuts& cuts, const std::vector<TileCount>& counts) {
  Json tiles = Json::array();
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const Slab slab = slab_of(cuts.axis, cuts.at, k);
    tiles.push_back({{"k", k + 1},
                     {"from", end_json(slab.from)},
                     {"to", end_json(slab.to)},
                     {"triangles", counts[k].triangles},
                     {"home_triangles", counts[k].home},
                     {"expected_mib", expected_mib(counts[k])}});
  }
  return {{"scene", census.name}, {"objects", census.objects},    {"triangles", census.triangles},
          {"n", cuts.tiles()},    {"axis", axis_name(cuts.axis)}, {"tiles", tiles}};
}

}  // namespace farcull
