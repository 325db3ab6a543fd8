// The scene cache and the comparison of answers with the truth.
#include "experiments/measure/lab.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/scene/scene.h"
#include "experiments/scenes/scene_file.h"
#include "verify/exact.h"

namespace farcull {
namespace {

template <class T>
std::uint64_t count_lacking(const std::vector<T>& a, const std::vector<T>& b) {
  std::vector<T> difference;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(difference));
  return difference.size();
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

Truth without_neighbours(const Scene& scene, const Truth& truth) {
  if (!has_self(scene)) return truth;
  const std::vector<std::uint32_t> owner = owners(scene);
  Truth out{.pairs = {}, .triangles = 0, .ms = truth.ms};
  std::copy_if(truth.pairs.begin(), truth.pairs.end(), std::back_inserter(out.pairs),
               [&](const TrianglePair& pair) {
                 return owner[pair.a] != owner[pair.b] ||
                        !share_position(scene.corners(pair.a), scene.corners(pair.b));
               });
  out.triangles = members_of(out.pairs).size();
  return out;
}

std::uint64_t lacking(const std::vector<TrianglePair>& a, const std::vector<TrianglePair>& b) {
  return count_lacking(a, b);
}

Errors errors_of(const Truth& truth, const std::vector<TrianglePair>& pairs) {
  return {.missed = lacking(truth.pairs, pairs),
          .missed_triangles = count_lacking(members_of(truth.pairs), members_of(pairs)),
          .wrong = lacking(pairs, truth.pairs)};
}

Lab::Lab(std::string device, Progress progress, unsigned threads)
    : device_(std::move(device)), progress_(std::move(progress)), session_(device_, threads) {}

void Lab::begin_scene(const std::string& name, long frame, long frames) {
  current_ = nullptr;
  truth_.reset();
  // Frames of one motion share the source and the lists of i-collide.
  if (name != name_ || frames != frames_ || frames == 0) {
    source_.reset();
    session_.sweep().forget();
  }
  name_ = name;
  frame_ = frame;
  frames_ = frames;
}

const Scene& Lab::scene(const std::string& name, long frame, long frames) {
  if (frame < 0) {
    return scene(name, [&] {
      if (progress_) progress_("reading " + name);
      return load_scene({name});
    });
  }
  if (current_ != nullptr && name == name_ && frames == frames_ && frame == frame_)
    return *current_;
  if (progress_) progress_("reading " + name);
  begin_scene(name, frame, frames);
  if (!source_) source_.emplace(std::vector{name}, FrameRange{0, frames - 1}, false);
  current_ = &source_->at(frame);
  return *current_;
}

const Scene& Lab::scene(const std::string& name, const std::function<Scene()>& make) {
  if (current_ != nullptr && name == name_ && frame_ < 0) return *current_;
  begin_scene(name, -1, 0);
  scene_ = make();
  current_ = &scene_;
  return scene_;
}

const Truth& Lab::truth() {
  if (!truth_) {
    if (progress_) progress_("exact tests of every pair");
    ExactResult result = all_colliding_pairs(*current_, {}, current_->ignored);
    truth_.emplace();
    std::merge(result.pairs.begin(), result.pairs.end(), result.neighbour_pairs.begin(),
               result.neighbour_pairs.end(), std::back_inserter(truth_->pairs));
    truth_->triangles = members_of(truth_->pairs).size();
    truth_->ms = result.join_ms + result.predicates_ms;
  }
  return *truth_;
}

const Scene& Lab::current() const { return *current_; }

}  // namespace farcull
