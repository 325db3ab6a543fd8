// Cuts the scene into tiles, gathers the triangles of one tile, and runs the method on these
// triangles. Then removes the candidate pairs that belong to other tiles.
#include "experiments/tiles/run_tile.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "core/boxes/block.h"

namespace farcull {
namespace {

constexpr std::size_t kSample = 65536;

// Samples the boxes of triangles. The sample holds the triangles whose hashed number ends with at
// least k zero bits. If the sample becomes too large, k grows by one. So the sample depends only on
// the scene, not on the parts in which the scene is read.
class Sampler {
 public:
  void add(std::uint64_t number, const Box& box) {
    const std::uint64_t hash = scrambled(number + kGolden);
    if ((hash & mask_) != 0) return;
    sample_.emplace_back(hash, box);
    while (sample_.size() > kSample) {
      mask_ = 2 * mask_ + 1;
      std::erase_if(sample_, [&](const auto& one) { return (one.first & mask_) != 0; });
    }
  }
  std::vector<Box> boxes() const {
    std::vector<Box> out;
    for (const auto& [hash, box] : sample_) out.push_back(box);
    return out;
  }

 private:
  std::uint64_t mask_ = 0;
  std::vector<std::pair<std::uint64_t, Box>> sample_;
};

// Returns how many cuts are at most `at` + `reach`, rounded as in meets(). With reach 0, the result
// is the index of the tile that contains `at`.
std::size_t tile_at(const Cuts& cuts, double at, double reach = 0) {
  const auto end =
      std::ranges::partition_point(cuts.at, [&](double cut) { return cut - at <= reach; });
  return static_cast<std::size_t>(end - cuts.at.begin());
}

Box box_of(const Scene& scene, std::uint32_t triangle) { return grown_box(scene, triangle, 0); }

// Counts the boxes that meet each tile. step_[k] is the count of tile k minus that of tile k - 1.
class Loads {
 public:
  Loads(const Cuts& cuts, double clearance)
      : cuts_(cuts), clearance_(clearance), step_(cuts.tiles() + 1, 0) {}
  void add(const Box& box) {
    ++step_[tile_at(cuts_, box.lo[cuts_.axis])];
    --step_[tile_at(cuts_, box.hi[cuts_.axis], clearance_) + 1];
  }
  // Returns the count of the fullest tile, and the sum of all counts.
  std::pair<std::uint64_t, std::uint64_t> most_and_all() const {
    std::pair<std::uint64_t, std::uint64_t> out;
    std::uint64_t now = 0;
    for (std::size_t k = 0; k < cuts_.tiles(); ++k) {
      now += static_cast<std::uint64_t>(step_[k]);
      out = {std::max(out.first, now), out.second + now};
    }
    return out;
  }

 private:
  const Cuts& cuts_;
  double clearance_;
  std::vector<std::int64_t> step_;
};

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMost = std::size_t{1} << 31;  // triangles + objects in a tile must be fewer

// Collects the triangles of one tile. Renumbers vertices per part, as parts share no vertex.
class Gathering {
 public:
  Gathering(const Census& census, const Tile& tile)
      : census_(census), tile_(tile), hash_(census.begun_hash()) {
    out_.numbers.self = census.self_objects > 0;
  }

  void add(const Scene& part) {
    out_.scene.name = part.name;
    vertex_.assign(part.vertices.size(), kNone);
    for (const Object& object : part.objects) add(part, object);
    if (out_.scene.triangles.size() + out_.scene.objects.size() >= kMost) {
      throw Error(part.name, "has 2^31 triangles and objects in the tile, or more",
                  "divide it into more tiles");
    }
  }

  TileScene take() {
    if (series_ != census_.sizes.size()) changed();
    out_.hash = hash_.hex();
    out_.faces_hash = faces_.hex();
    return std::move(out_);
  }

 private:
  [[noreturn]] void changed() const {
    throw Error(census_.name,
                fmt::format("is not what it was when it was read first: that had {} triangles of "
                            "{} objects; now object {} is another one",
                            census_.triangles, census_.objects, objects_),
                "do not change its files while a run reads them");
  }

  // Throws Error if size_word() of the object differs from the first reading of the scene. These
  // words need not be hashed again: begun_hash() already includes them.
  void require_known(const Object& object) {
    if (series_ == census_.sizes.size() || census_.sizes[series_].first != size_word(object))
      changed();
    if (++of_series_ < census_.sizes[series_].second) return;
    ++series_;
    of_series_ = 0;
  }

  void add(const Scene& part, const Object& object) {
    Scene& to = out_.scene;
    require_known(object);
    const std::uint64_t number = objects_++;
    Object own{.name = {},
               .first_triangle = static_cast<std::uint32_t>(to.triangles.size()),
               .triangle_count = 0,
               .self = object.self};
    for (std::uint32_t k = 0; k < object.triangle_count; ++k) {
      const std::uint32_t t = object.first_triangle + k;
      for (const Vec3& p : part.corners(t)) {
        for (int i = 0; i < 3; ++i) hash_.add(std::bit_cast<std::uint64_t>(p[i]));
      }
      faces_.add(std::uint64_t{part.source_face[t]});
      const Box box = box_of(part, t);
      const double lo = box.lo[tile_.axis], hi = box.hi[tile_.axis];
      if (!meets(tile_, lo, hi, census_.clearance)) continue;
      out_.home += holds(tile_, lo);
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) corners[i] = vertex(part, part.triangles[t][i]);
      to.triangles.push_back(corners);
      to.source_face.push_back(part.source_face[t]);
      out_.numbers.triangles.push_back(k);
      ++own.triangle_count;
    }
    if (own.triangle_count == 0) return;
    own.name = object.name;
    to.objects.push_back(std::move(own));
    out_.numbers.objects.push_back(number);
  }

  std::uint32_t vertex(const Scene& part, std::uint32_t v) {
    std::uint32_t& to = vertex_[v];
    if (to == kNone) {
      if (out_.scene.vertices.size() == kNone) {
        throw Error(part.name, "has 2^32 vertices in the tile, or more",
                    "divide it into more tiles");
      }
      to = static_cast<std::uint32_t>(out_.scene.vertices.size());
      out_.scene.vertices.push_back(part.vertices[v]);
    }
    return to;
  }

  const Census& census_;
  Tile tile_;
  Fnv1a hash_, faces_;
  TileScene out_;
  std::size_t series_ = 0;       // index in census_.sizes for the next object
  std::uint64_t of_series_ = 0;  // number of earlier objects in this series
  std::uint64_t objects_ = 0;
  std::vector<std::uint32_t> vertex_;  // per vertex of the part: number in the tile, or kNone
};

// Converts object numbers of the whole scene to object numbers of the tile. Omits pairs with an
// object that has no triangle in the tile.
std::vector<ObjectPair> in_part(const std::vector<ObjectPair>& whole, const ListNumbers& numbers) {
  const auto place = [&](std::uint32_t object) -> std::optional<std::uint32_t> {
    const auto found = std::ranges::lower_bound(numbers.objects, object);
    if (found == numbers.objects.end() || *found != object) return std::nullopt;
    return static_cast<std::uint32_t>(found - numbers.objects.begin());
  };
  std::vector<ObjectPair> out;
  for (const ObjectPair& pair : whole) {
    const auto a = place(pair.a), b = place(pair.b);
    if (a && b) out.push_back({*a, *b});
  }
  return out;
}

using Json = nlohmann::ordered_json;

double peak_memory_mib() {
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

std::string axis_name(int axis) { return std::string(1, "xyz"[axis]); }

// Returns JSON null if the tile is unbounded on this side.
Json end_json(double at) { return std::isfinite(at) ? Json(at) : Json(nullptr); }

// Returns a text that identifies the ignored pairs and is the same for all tiles. The text has a
// hash of object numbers, since two objects may have the same name.
std::string ignored_text(const std::vector<ObjectPair>& ignored) {
  if (ignored.empty()) return "";
  Fnv1a hash;
  for (const ObjectPair& pair : ignored) {
    hash.add(std::uint64_t{pair.a});
    hash.add(std::uint64_t{pair.b});
  }
  return fmt::format("{}, {}", counted(ignored.size(), "pair", "pairs"), hash.hex());
}

// Sets place["object"] and place["triangle"] to the numbers of the triangle in the whole scene.
void renumber(const TileScene& part, const std::vector<std::uint32_t>& owner,
              std::uint32_t triangle, Json& place) {
  place["object"] = part.numbers.objects[owner[triangle]];
  place["triangle"] = part.numbers.triangles[triangle];
}

Json list_json(const TileList& list) {
  Json kinds = Json::array();
  for (const ContactKind kind : list.columns.kinds) kinds.push_back(std::string(name_of(kind)));
  return {{"file", list.file},
          {"columns", list.text.substr(0, list.text.find('\n'))},
          {"kinds", kinds},
          {"rows", std::ranges::count(list.text, '\n') - 1},
          {"sha256", sha256(list.text)}};
}

}  // namespace

Fnv1a Census::begun_hash() const {
  Fnv1a hash;
  hash.add(objects);
  for (const auto& [word, times] : sizes) {
    for (std::uint64_t k = 0; k < times; ++k) hash.add(word);
  }
  return hash;
}

std::uint64_t size_word(const Object& object) {
  return object.triangle_count | std::uint64_t{object.self} << 32;
}

Census take_census(const SceneSource& source, double clearance, bool names) {
  Census out;
  out.clearance = clearance;
  Sampler sampler;
  out.ignored = source([&](Scene& part) {
    out.name = part.name;
    out.objects += part.objects.size();
    for (const Object& object : part.objects) {
      out.self_objects += object.self;
      const std::uint64_t word = size_word(object);
      if (out.sizes.empty() || out.sizes.back().first != word) out.sizes.emplace_back(word, 0);
      ++out.sizes.back().second;
      if (names) out.names.push_back(object.name);
    }
    const auto count = static_cast<std::uint32_t>(part.triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) sampler.add(out.triangles++, box_of(part, t));
  });
  out.sample = sampler.boxes();
  return out;
}

Scene names_of(const Census& census) {
  Scene out;
  out.name = census.name;
  out.ignored = census.ignored;
  for (const std::string& name : census.names) out.objects.push_back({.name = name});
  return out;
}

Cuts choose_cuts(const Census& census, std::size_t tiles) {
  Cuts best{.axis = 0, .at = std::vector<double>(tiles - 1, 0)};
  if (census.sample.empty()) return best;
  auto least = std::pair(std::numeric_limits<std::uint64_t>::max(), std::uint64_t{0});
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> places;
    for (const Box& box : census.sample) places.push_back(box.lo[axis]);
    std::sort(places.begin(), places.end());
    Cuts cuts{.axis = axis, .at = {}};
    for (std::size_t k = 1; k < tiles; ++k) cuts.at.push_back(places[places.size() * k / tiles]);
    Loads loads(cuts, census.clearance);
    for (const Box& box : census.sample) loads.add(box);
    if (const auto load = loads.most_and_all(); load < least) {
      least = load;
      best = std::move(cuts);
    }
  }
  return best;
}

std::size_t parse_tiles(const std::string& text) {
  const std::optional<std::size_t> n = parse_number<std::size_t>(text);
  if (n && *n >= 1 && *n <= kMostTiles) return *n;
  throw Error("--tiles", "'" + text + "' is no number of tiles",
              fmt::format("give a whole number, 1 to {}", kMostTiles));
}

TileNumber parse_tile(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos) {
    const auto k = parse_number<std::size_t>(std::string_view(text).substr(0, slash));
    const auto n = parse_number<std::size_t>(std::string_view(text).substr(slash + 1));
    if (k && n && *k >= 1 && *k <= *n && *n <= kMostTiles) return {*k, *n};
  }
  throw Error("--tiles", "'" + text + "' is no tile",
              fmt::format("give K/N with 1 <= K <= N <= {}, such as 2/4", kMostTiles));
}

TileScene gather_tile(const SceneSource& source, const Census& census, const Tile& tile) {
  Gathering gathering(census, tile);
  source([&](Scene& part) { gathering.add(part); });
  return gathering.take();
}

WholeScene whole_scene(const Census& census, const Tile& tile, const TileScene& part) {
  WholeScene out{.tile = tile,
                 .numbers = &part.numbers,
                 .key = {census.name, census.objects, census.triangles, part.hash},
                 .not_asked = {}};
  for (const auto& [word, times] : census.sizes) {
    const std::uint64_t self = word >> 32, n = word & 0xffffffff;
    if (self != 0) continue;
    out.not_asked.objects += times;
    if (n > 0) out.not_asked.pairs += times * (n * (n - 1) / 2);
  }
  return out;
}

TileRun run_tile(const SceneSource& source, const TileQuestion& question, Session& session,
                 const Progress& progress) {
  if (question.options.method != Method::boxes || question.options.limit > 0)
    throw std::logic_error("run_tile: a tile is of boxes, without a limit");
  const Stopwatch reading;
  if (progress) progress("reading the scene for the cuts");
  TileRun out;
  out.number = question.number;
  out.census = take_census(source, question.options.clearance, static_cast<bool>(question.ignored));
  out.ignored = out.census.ignored;
  if (question.ignored)
    out.ignored = in_order(question.ignored(names_of(out.census)), out.census.ignored);
  out.cuts = choose_cuts(out.census, question.number.n);
  out.tile = tile_of(out.cuts.axis, out.cuts.at, question.number.k - 1);
  if (progress) progress("reading the triangles of the tile");
  out.part = gather_tile(source, out.census, out.tile);
  out.part.scene.name += fmt::format(" (tile {} of {})", out.number.k, out.number.n);
  out.read_ms = reading.ms();
  RunOptions options = question.options;
  options.ignored = in_part(out.ignored, out.part.numbers);
  const Scene& scene = out.part.scene;
  const auto keep_ours = [&](std::vector<TrianglePair>& candidates) {
    out.elsewhere = std::erase_if(candidates, [&](const TrianglePair& pair) {
      const auto begin = [&](std::uint32_t t) { return box_of(scene, t).lo[out.tile.axis]; };
      return !owns(out.tile, begin(pair.a), begin(pair.b));
    });
  };
  out.record =
      run(scene, options, session, progress, {.filter = keep_ours, .scene_hash = out.part.hash});
  return out;
}

std::string tile_list(const TileRun& run, PairColumns columns) {
  columns.numbers = &run.part.numbers;
  return pairs_header(run.part.scene, columns) +
         pairs_rows(run.part.scene, run.record, "", columns);
}

// ---- text and JSON about a tile ----

std::string interval_text(const Tile& tile) {
  const bool first = tile.from == -HUGE_VAL, last = tile.to == HUGE_VAL;
  if (first && last) return "everything";
  if (first) return fmt::format("{} below {}", axis_name(tile.axis), tile.to);
  if (last) return fmt::format("{} from {} on", axis_name(tile.axis), tile.from);
  return fmt::format("{} from {} to below {}", axis_name(tile.axis), tile.from, tile.to);
}

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
      {"k", run.number.k},
      {"n", run.number.n},
      {"axis", axis_name(run.cuts.axis)},
      {"from", end_json(run.tile.from)},
      {"to", end_json(run.tile.to)},
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
  // Calls nothing_to_test() for a smaller scene that has the same answer. The smaller scene has at
  // most two of the objects with triangles, and one of the objects without triangles.
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
      run.number.k, run.number.n, interval_text(run.tile), grouped(run.part.scene.triangles.size()),
      counted(run.census.triangles, "triangle", "triangles"), grouped(run.part.home),
      counted(run.elsewhere, "candidate pair is", "candidate pairs are"), peak_memory_mib(),
      run.read_ms);
}

}  // namespace farcull
