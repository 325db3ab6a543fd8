// The stages of experiments/method/run.h, with one more: candidates of other tiles are removed
// after the accounting, and before the exact tests.
#include "experiments/tiles/run_tile.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "core/scene/scene.h"
#include "experiments/method/stages.h"

namespace farcull {
namespace {

// Pairs of objects of the whole scene as those of the part; those of which one is elsewhere can
// have no pair here.
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

Record run_part(const TileScene& part, const RunOptions& options, const Slab& slab,
                Session& session, const Progress& progress, std::uint64_t& elsewhere) {
  const FloatingPointGuard guard;
  const Scene& scene = part.scene;
  Record record;
  record.callers = callers_floating_point();
  record.options = options;
  record.scene_hash = part.hash;
  record.degenerate_triangles = degenerate_triangles(scene);
  {
    const Plan planned = plan(scene, options, session.threads(), progress);
    record.plan = planned.stages();
    record.trace = planned.trace;
    record.ms.cull = planned.ms;
    record.found = find(scene, planned, session, progress);
  }  // the plan goes, to make room
  record.trace.insert(record.trace.end(), record.found.trace.begin(), record.found.trace.end());
  record.promise = promise_of(options, record.found.device, session);
  record.ms.setup = record.found.setup_ms;
  record.ms.cull += record.found.ms;
  verify_stage(scene, record.found.pairs, progress, record);  // the candidates of all tiles
  elsewhere = std::erase_if(record.found.pairs, [&](const TrianglePair& pair) {
    return !owns(slab, scene, pair, options.clearance);
  });
  record.found.count = record.found.pairs.size();
  count_kept(scene, record.found);
  decide_stage(scene, session, progress, record);
  record.ms.total = record.ms.setup + record.ms.cull + record.ms.exact;
  contact_stage(scene, session, progress, record);
  require_proved("arithmetic");  // a driver's code ran in this thread too
  record.used = floating_point();
  return record;
}

}  // namespace

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

TileRun run_tile(const SceneSource& source, const TileQuestion& question, Session& session,
                 const Progress& progress) {
  if (question.options.method != Method::far_pairs || question.options.limit > 0)
    throw std::logic_error("run_tile: a tile is of far-pairs, without a limit");
  const double clearance = question.options.clearance;
  const Stopwatch reading;
  if (progress) progress("reading the scene for the cuts");
  TileRun out{.tile = question.tile,
              .census = take_census(source, clearance, static_cast<bool>(question.ignored)),
              .cuts = {},
              .slab = {},
              .part = {},
              .record = {}};
  out.ignored = out.census.ignored;
  if (question.ignored) {
    const std::vector<ObjectPair> asked = question.ignored(names_of(out.census));
    out.ignored.insert(out.ignored.end(), asked.begin(), asked.end());
    out.ignored = in_order(std::move(out.ignored));
  }
  out.cuts = choose_cuts(out.census, question.tile.n);
  out.slab = slab_of(out.cuts.axis, out.cuts.at, question.tile.k - 1);
  if (progress) progress("reading the triangles of the tile");
  out.part = gather_tile(source, out.census, out.slab, clearance);
  out.part.scene.name += fmt::format(" (tile {} of {})", out.tile.k, out.tile.n);
  out.read_ms = reading.ms();
  RunOptions options = question.options;
  options.ignored = in_part(out.ignored, out.part.numbers);
  out.record = run_part(out.part, options, out.slab, session, progress, out.elsewhere);
  return out;
}

std::string tile_list(const TileRun& run, PairColumns columns) {
  columns.numbers = &run.part.numbers;
  return pairs_header(run.part.scene, columns) +
         pairs_rows(run.part.scene, run.record, "", columns);
}

double peak_memory_mib() {
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

}  // namespace farcull
