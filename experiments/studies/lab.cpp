#include "experiments/studies/lab.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "core/stopwatch.h"
#include "experiments/scene_file.h"
#include "experiments/tables.h"
#include "verify/contact.h"
#include "verify/exact.h"

namespace farcull {
namespace {

std::vector<TrianglePair> all_pairs(const std::vector<TrianglePair>& pairs,
                                    const std::vector<TrianglePair>& neighbours) {
  std::vector<TrianglePair> out;
  out.reserve(pairs.size() + neighbours.size());
  std::set_union(pairs.begin(), pairs.end(), neighbours.begin(), neighbours.end(),
                 std::back_inserter(out));
  return out;
}

// How many of a are not in b; both sorted.
template <class T>
std::uint64_t lacking(const std::vector<T>& a, const std::vector<T>& b) {
  std::vector<T> difference;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(difference));
  return difference.size();
}

double total_of(const RunRecord& record) { return record.ms.cull + record.ms.exact; }

// Those colliding pairs that penetrate, of the ones that the sorted pairs lack.
std::uint64_t missed_penetrating(const Scene& scene, const Truth& truth,
                                 const std::vector<TrianglePair>& pairs) {
  std::vector<TrianglePair> missed;
  std::set_difference(truth.pairs.begin(), truth.pairs.end(), pairs.begin(), pairs.end(),
                      std::back_inserter(missed));
  return count_contacts(scene, missed).penetrating;
}

Outcome outcome_of(const Scene& scene, const Truth& truth, const RunRecord& record) {
  Outcome out;
  out.pairs = all_pairs(record.pairs, record.neighbour_pairs);
  out.device = record.device ? record.device->renderer : "cpu";
  const Errors errors = errors_of(truth, out.pairs);
  out.counts = {{"colliding", truth.pairs.size()},
                {"missed", errors.missed},
                {"missed_penetrating", missed_penetrating(scene, truth, out.pairs)},
                {"colliding_triangles", truth.triangles},
                {"missed_triangles", errors.missed_triangles},
                {"candidates", record.candidate_pairs},
                {"kept_triangles", record.pcs_triangles},
                {"kept_objects", record.pcs_objects},
                {"triangles", scene.triangles.size()},
                {"objects", scene.objects.size()},
                {"promises", record.promises},
                {"scene_hash", record.scene_hash}};
  const Method method = record.options.method;
  if (method == Method::i_collide) out.counts["object_triangles"] = record.object_triangles;
  if (draws(method)) {
    const Stage sum = work_of(record.stages);
    out.counts["queries"] = sum.queries;
    out.counts["draws"] = sum.draws;
    out.counts["queries_saved"] = sum.queries_saved;
    out.counts["draws_saved"] = sum.draws_saved;
    if (const ViewReport* view = widest_budget(record.views)) {
      out.counts["radius_px"] = view->radius_px;
      out.counts["pixel_size"] = view->pixel_size;
    }
  }
  return out;
}

}  // namespace

std::vector<std::uint32_t> members_of(const std::vector<TrianglePair>& pairs) {
  std::vector<std::uint32_t> out;
  out.reserve(2 * pairs.size());
  for (const TrianglePair& pair : pairs) out.insert(out.end(), {pair.a, pair.b});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Errors errors_of(const Truth& truth, const std::vector<TrianglePair>& pairs) {
  return {.missed = lacking(truth.pairs, pairs),
          .missed_triangles = lacking(members_of(truth.pairs), members_of(pairs)),
          .wrong = lacking(pairs, truth.pairs)};
}

void require_same(const Point& point, const Outcome& first, const Outcome& other) {
  std::string what;
  const auto add = [&what](const std::string& text) { what += (what.empty() ? "" : ", ") + text; };
  if (first.device != other.device) add("device " + first.device + " and " + other.device);
  nlohmann::ordered_json all = first.counts;
  all.update(other.counts);
  for (const auto& [name, value] : all.items()) {
    const auto of = [&name](const Outcome& outcome) {
      return outcome.counts.contains(name) ? outcome.counts.at(name).dump() : "none";
    };
    if (of(first) != of(other)) add(name + " " + of(first) + " and " + of(other));
  }
  if (first.pairs != other.pairs) {
    add(fmt::format("{} and {} pairs that are in one answer alone",
                    lacking(first.pairs, other.pairs), lacking(other.pairs, first.pairs)));
  }
  if (what.empty()) return;
  throw Error(describe(point), "two runs of the same point differ: " + what,
              "run farcull doctor; the device is not deterministic");
}

Lab::Lab(std::string device, Progress progress)
    : device_(std::move(device)), progress_(std::move(progress)), session_(device_) {}

const Scene& Lab::scene(const std::string& name, long frame, long frames) {
  if (frame < 0) frames = 0;
  const bool same = name == name_ && frames == frames_;
  if (current_ != nullptr && same && frame == frame_) return *current_;
  if (progress_) progress_("reading " + name);
  current_ = nullptr;
  truth_.reset();
  if (!same) {
    source_.reset();
    session_.sweep().forget();
  }
  name_ = name;
  frame_ = frame;
  frames_ = frames;
  if (frame < 0) {
    scene_ = load_scene({name});
    current_ = &scene_;
  } else {
    if (!source_) source_.emplace(std::vector{name}, FrameRange{0, frames - 1}, false);
    current_ = &source_->at(frame);
  }
  return *current_;
}

const Scene& Lab::scene(const std::string& name, const std::function<Scene()>& make) {
  if (current_ != nullptr && name == name_ && frame_ < 0) return *current_;
  current_ = nullptr;
  truth_.reset();
  source_.reset();
  session_.sweep().forget();
  name_ = name;
  frame_ = -1;
  frames_ = 0;
  scene_ = make();
  current_ = &scene_;
  return scene_;
}

const Truth& Lab::truth() {
  if (!truth_) {
    if (progress_) progress_("exact tests of every pair");
    ExactResult result = all_colliding_pairs(*current_, {});
    truth_.emplace();
    truth_->pairs = all_pairs(result.pairs, result.neighbour_pairs);
    truth_->triangles = members_of(truth_->pairs).size();
    truth_->ms = result.join_ms + result.predicates_ms;
  }
  return *truth_;
}

const Scene& Lab::current() const { return *current_; }

RunOptions options_of(const Point& point, const Lab& lab) {
  RunOptions options;
  options.method = parse_method(point.method);
  options.resolution = point.resolution;
  options.radius = parse_radius(point.radius.empty() ? "budget" : point.radius);
  if (!point.offset.empty()) options.offset = point.offset;
  if (point.depth_mode == "fragment") options.depth = DepthMode::fragment;
  if (point.depth_mode == "fixed") options.depth = DepthMode::fixed;
  if (point.depth_format == "fixed24") options.depth_format = DepthFormat::fixed24;
  options.views = point.views;
  options.device = lab.device();
  options.verify = false;
  return options;
}

Measurement measure_run(const Point& point, Lab& lab, int repeat, RunRecord* kept) {
  if (repeat < 1 || (point.frame >= 0 && repeat > 1))
    throw std::logic_error("measure_run: runs of " + describe(point));
  const RunOptions options = options_of(point, lab);
  const Scene& scene = lab.current();
  const Truth& truth = lab.truth();
  double setup = 0;
  if (options.method == Method::far_pairs) {
    // Else the first run might go without a device, and a later one not.
    const Stopwatch watch;
    lab.session().pairs();
    setup += watch.ms();
  }
  std::vector<RunRecord> records;
  Outcome first;
  for (int i = 0; i < repeat; ++i) {
    if (point.frame < 0) lab.session().sweep().forget();
    records.push_back(run_scene(scene, options, lab.session(), lab.progress()));
    setup += records.back().ms.setup;
    Outcome outcome = outcome_of(scene, truth, records.back());
    if (i == 0) {
      first = std::move(outcome);
    } else {
      require_same(point, first, outcome);
    }
  }
  std::sort(records.begin(), records.end(),
            [](const RunRecord& a, const RunRecord& b) { return total_of(a) < total_of(b); });
  RunRecord& record = records[(records.size() - 1) / 2];

  Measurement out;
  out.device = first.device;
  out.counts = std::move(first.counts);
  out.times = {{"cull", record.ms.cull},
               {"exact", record.ms.exact},
               {"total", total_of(record)},
               {"setup", setup}};
  if (repeat > 1) {
    out.times["total_min"] = total_of(records.front());
    out.times["total_max"] = total_of(records.back());
  }
  if (kept != nullptr) *kept = std::move(record);
  return out;
}

}  // namespace farcull
