#include "core/pairs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/box_join.h"
#include "core/error.h"
#include "core/pair_view.h"
#include "core/pairs_cpu.h"
#include "core/parallel.h"
#include "core/stopwatch.h"

namespace farcull {
namespace {

// Pairs of the scene whose grown boxes overlap and one of whose triangles is in `some` (ascending):
// for triangles of which a view can say nothing.
std::vector<TrianglePair> pairs_by_boxes(const Scene& scene, const PairRegions& regions,
                                         std::span<const std::uint32_t> some, double clearance) {
  std::vector<Box> boxes(scene.triangles.size(), Box::empty());
  for (const std::uint32_t t : regions.triangles) boxes[t] = grown_box(scene, t, clearance);
  std::vector<TrianglePair> pairs = box_join(boxes, join_owners(scene), regions.triangles);
  if (some.size() < regions.triangles.size()) {
    std::erase_if(pairs, [&](const TrianglePair& pair) {
      return !std::binary_search(some.begin(), some.end(), pair.a) &&
             !std::binary_search(some.begin(), some.end(), pair.b);
    });
  }
  return pairs;
}

// Whether the boxes of two triangles, each grown by `half`, overlap: outward where half > 0, so
// that a distance of twice `half` or less is never lost.
bool boxes_meet(const Scene& scene, const TrianglePair& pair, double half) {
  const std::array<std::uint32_t, 3>&s = scene.triangles[pair.a], &t = scene.triangles[pair.b];
  const double *a = scene.vertices[s[0]].data(), *b = scene.vertices[s[1]].data(),
               *c = scene.vertices[s[2]].data();
  const double *d = scene.vertices[t[0]].data(), *e = scene.vertices[t[1]].data(),
               *f = scene.vertices[t[2]].data();
  const auto least = [](double x, double y) { return x < y ? x : y; };
  const auto most = [](double x, double y) { return x > y ? x : y; };
  for (int axis = 0; axis < 3; ++axis) {
    double lo0 = least(least(a[axis], b[axis]), c[axis]),
           hi0 = most(most(a[axis], b[axis]), c[axis]);
    double lo1 = least(least(d[axis], e[axis]), f[axis]),
           hi1 = most(most(d[axis], e[axis]), f[axis]);
    if (half > 0) {
      lo0 = std::nextafter(lo0 - half, -HUGE_VAL);
      hi0 = std::nextafter(hi0 + half, HUGE_VAL);
      lo1 = std::nextafter(lo1 - half, -HUGE_VAL);
      hi1 = std::nextafter(hi1 + half, HUGE_VAL);
    }
    if (lo0 > hi1 || lo1 > hi0) return false;
  }
  return true;
}

// Whether two triangles of one object share a vertex index.
bool share_index(const Scene& scene, const TrianglePair& pair) {
  const auto& [p, q, r] = scene.triangles[pair.b];
  bool shared = false;
  for (const std::uint32_t v : scene.triangles[pair.a]) shared |= (v == p) | (v == q) | (v == r);
  return shared;
}

// Pairs whose second corners are fetched ahead; the first ones are mostly those of the pair before.
constexpr std::size_t kAhead = 8;

// Those whose boxes overlap, in order; without neighbours where they are not asked for.
void keep_overlapping(const Scene& scene, const PairScene& seen, double clearance, unsigned threads,
                      std::vector<TrianglePair>& pairs) {
  const double half = half_of(clearance);
  const std::size_t chunks = chunks_for(pairs.size(), 2048, threads);
  std::vector<std::size_t> kept(chunks, 0);
  for_chunks(pairs.size(), chunks, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t to = begin;
    for (std::size_t k = begin; k < end; ++k) {
      prefetch(scene, pairs[std::min(k + kAhead, end - 1)].b);
      pairs[to] = pairs[k];
      to += boxes_meet(scene, pairs[k], half) &&
            (seen.task.neighbours || seen.owners[pairs[k].a] != seen.owners[pairs[k].b] ||
             !share_index(scene, pairs[k]));
    }
    kept[chunk] = to - begin;
  });
  std::size_t to = 0;
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    const std::size_t from = pairs.size() * chunk / chunks;
    std::copy(pairs.begin() + from, pairs.begin() + from + kept[chunk], pairs.begin() + to);
    to += kept[chunk];
  }
  pairs.resize(to);
}

std::vector<TrianglePair> common(const std::vector<TrianglePair>& a,
                                 const std::vector<TrianglePair>& b) {
  std::vector<TrianglePair> out;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

std::vector<TrianglePair> merged(const std::vector<TrianglePair>& a,
                                 const std::vector<TrianglePair>& b) {
  std::vector<TrianglePair> out;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

std::vector<std::uint32_t> members(const Scene& scene, const std::vector<TrianglePair>& pairs) {
  std::vector<std::uint8_t> in(scene.triangles.size(), 0);
  for (const TrianglePair& pair : pairs) in[pair.a] = in[pair.b] = 1;
  std::vector<std::uint32_t> out;
  for (std::uint32_t t = 0; t < in.size(); ++t) {
    if (in[t] != 0) out.push_back(t);
  }
  return out;
}

// Pairs that a further view is tried on, before it looks at all of them.
constexpr std::size_t kTried = 256;

// Whether a further view would keep every one of some candidates, evenly chosen: it then takes next
// to nothing away from the others. That is so where triangles lie on each other. A choice alone:
// no pair is lost either way.
bool keeps_sample(const Scene& scene, const PairRegions& regions, const PairChoice& choice,
                  double clearance, const std::vector<TrianglePair>& candidates,
                  std::size_t triangles) {
  std::vector<TrianglePair> sample;
  const std::size_t count = std::min(kTried, candidates.size());
  for (std::size_t k = 0; k < count; ++k) {
    sample.push_back(candidates[candidates.size() * k / count]);
  }
  PairScene seen;
  if (!look(scene, regions, members(scene, sample), choice.view, choice.resolution, clearance, 1,
            seen)) {
    return true;
  }
  PairCounts counts;
  const std::vector<TrianglePair> kept =
      cpu_sample_backend(triangles)->raw_pairs(seen.task, counts);
  const auto& bad = seen.undrawable;
  return std::all_of(sample.begin(), sample.end(), [&](const TrianglePair& pair) {
    return std::binary_search(kept.begin(), kept.end(), pair) ||
           std::binary_search(bad.begin(), bad.end(), pair.a) ||
           std::binary_search(bad.begin(), bad.end(), pair.b);
  });
}

}  // namespace

PairResult find_pairs(const Scene& scene, const PairSettings& settings, PairBackend& backend,
                      const std::function<void(const std::string&)>& progress) {
  if (!(settings.clearance >= 0) || !std::isfinite(settings.clearance)) {
    throw std::logic_error("find_pairs: the clearance is negative or not finite");
  }
  if (scene.triangles.size() + scene.objects.size() >= std::size_t{1} << 31) {
    throw Error(scene.name, "has 2^31 triangles and objects, or more", "split it into scenes");
  }
  PairResult out;
  const Stopwatch planning;
  if (progress) progress("planning");
  const PairRegions regions =
      pair_regions(scene, settings.clearance, settings.full, backend.threads());
  out.stages.push_back(
      {.name = "boxes",
       .ran = true,
       .reason = settings.full
                     ? "nothing is left out"
                     : "pairs of objects whose boxes overlap: " + std::to_string(regions.pairs) +
                           "; objects tested against themselves: " + std::to_string(regions.self),
       .ms = planning.ms(),
       .in = scene.triangles.size(),
       .out = regions.triangles.size(),
       .unit = "triangles"});
  if (regions.triangles.empty()) {
    out.stages.push_back({.name = "views",
                          .reason = "no two objects' boxes overlap, none collides with itself",
                          .unit = "pairs"});
    return out;
  }

  const Stopwatch choosing;
  std::vector<PairChoice> choices;
  if (settings.views.empty()) {
    choices = choose_pair_views(scene, regions, settings.resolution);
  } else {
    for (const View& view : settings.views) {
      choices.push_back({view,
                         settings.resolution > 0 ? settings.resolution
                                                 : choose_pair_resolution(scene, regions, view),
                         settings.resolution > 0
                             ? "direction and resolution given"
                             : "direction given; pixels by the triangles' sizes"});
    }
  }
  out.stages.push_back(
      {.name = "choose",
       .ran = true,
       .reason = settings.views.empty() ? "views chosen by the scene" : "views given",
       .ms = choosing.ms(),
       .in = choices.size(),
       .out = settings.views.empty() ? 1 : choices.size(),
       .unit = "views"});

  bool first = true;  // no view has said anything yet
  std::size_t looked = 0;
  if (!backend.kept) backend.kept = std::make_shared<PairScene>();
  PairScene& seen = *backend.kept;
  for (const PairChoice& choice : choices) {
    if (settings.views.empty() && !first && !(settings.full && looked < kMostPairViews)) {
      const bool enough = out.candidates.size() <= kFurtherViewFrom * regions.triangles.size();
      if (enough || looked == kMostPairViews) {
        out.stages.push_back({.name = "view " + choice.view.name,
                              .reason = enough ? "exact tests of " +
                                                     std::to_string(out.candidates.size()) +
                                                     " candidates are cheaper than a further view"
                                               : "enough views were looked at",
                              .unit = "pairs"});
        break;
      }
      if (keeps_sample(scene, regions, choice, settings.clearance, out.candidates,
                       regions.triangles.size())) {
        out.stages.push_back({.name = "view " + choice.view.name,
                              .reason = "it keeps all of a sample of the candidates",
                              .unit = "pairs"});
        ++looked;
        continue;
      }
    }
    const Stopwatch start;
    if (progress) progress("view " + choice.view.name);
    const std::vector<std::uint32_t> left =
        first ? std::vector<std::uint32_t>() : members(scene, out.candidates);
    const std::span<const std::uint32_t> triangles =
        first ? std::span<const std::uint32_t>(regions.triangles) : left;
    PairView view{.name = choice.view.name, .reason = choice.reason};
    Stage stage{.name = "view " + choice.view.name, .in = triangles.size(), .unit = "pairs"};
    if (!look(scene, regions, triangles, choice.view, choice.resolution, settings.clearance,
              backend.threads(), seen)) {
      view.reason = "pixel space cannot resolve the scene in this view";
      stage.reason = view.reason;
      out.views.push_back(view);
      out.stages.push_back(stage);
      continue;
    }
    view.looked = true;
    view.width = seen.window.width;
    view.height = seen.window.height;
    view.pixel_size = seen.window.pixel_size;
    view.widening_px = std::max({seen.task.widening.x, seen.task.widening.y, seen.task.widening.z});
    seen.task.neighbours = settings.neighbours;
    const double prepare_ms = start.ms();
    std::vector<TrianglePair> pairs = backend.raw_pairs(seen.task, view.counts);
    view.counts.undrawable = seen.undrawable.size();
    view.counts.prepare_ms = prepare_ms;
    if (first) {
      keep_overlapping(scene, seen, settings.clearance, backend.threads(), pairs);
      if (!seen.undrawable.empty()) {
        pairs = merged(pairs, pairs_by_boxes(scene, regions, seen.undrawable, settings.clearance));
      }
      out.candidates = std::move(pairs);
    } else {
      std::vector<TrianglePair> unseen;
      const auto& bad = seen.undrawable;
      for (const TrianglePair& pair : out.candidates) {
        if (std::binary_search(bad.begin(), bad.end(), pair.a) ||
            std::binary_search(bad.begin(), bad.end(), pair.b))
          unseen.push_back(pair);
      }
      out.candidates = common(out.candidates, merged(pairs, unseen));
    }
    first = false;
    ++looked;
    stage.ran = true;
    stage.reason = choice.reason + ": " + std::to_string(view.width) + " x " +
                   std::to_string(view.height) + " px";
    stage.ms = start.ms();
    stage.out = out.candidates.size();
    out.views.push_back(view);
    out.stages.push_back(stage);
  }
  if (first) {
    const Stopwatch start;
    if (progress) progress("joining boxes");
    out.candidates = pairs_by_boxes(scene, regions, regions.triangles, settings.clearance);
    out.stages.push_back({.name = "join",
                          .ran = true,
                          .reason = "no view can resolve the scene: pairs by their boxes alone",
                          .ms = start.ms(),
                          .in = regions.triangles.size(),
                          .out = out.candidates.size(),
                          .unit = "pairs"});
  }
  return out;
}

}  // namespace farcull
