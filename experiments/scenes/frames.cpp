// Makes the frames of a moving scene by a built-in motion, or by reading meshes for each frame.
#include "experiments/scenes/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/base/text.h"

namespace farcull {

namespace {

constexpr long kMostFrames = 1'000'000;
constexpr long kLastFrame = 1'000'000'000;

bool same_objects(const std::vector<Object>& a, const std::vector<Object>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Object& x, const Object& y) {
    return x.triangle_count == y.triangle_count && x.self == y.self;
  });
}

// Returns an Error for the first path that has a %d or %04d, but no file for this frame.
std::optional<Error> missing_file(const std::vector<std::string>& paths, const FrameRange& range,
                                  long frame) {
  for (const std::string& path : paths) {
    const auto exists = [&](long number) {
      std::error_code error;
      return std::filesystem::exists(numbered(path, number), error);
    };
    if (!is_numbered(path) || exists(frame)) continue;
    constexpr long kTried = 1000;  // tries frame numbers below this to find the first file
    long first = exists(range.first) ? range.first : 0;
    while (first < kTried && !exists(first)) ++first;
    long last = first;
    while (last - first + 1 < range.count() && exists(last + 1)) ++last;
    return Error(numbered(path, frame), "the file does not exist",
                 exists(first) ? fmt::format("give numbers that there are: --frames {}:{} instead "
                                             "of {}:{}",
                                             first, last, range.first, range.last)
                               : "give numbers that there are");
  }
  return std::nullopt;
}

}  // namespace

FrameRange parse_frames(const std::string& text) {
  const Error bad(
      "--frames", "'" + text + "' is no range of frames",
      fmt::format("give a number from 1 to {}, or first:last, as in 1:100", kMostFrames));
  const auto number = [&](const std::string& part) {
    const std::optional<long> value = parse_number<long>(part);
    if (!value || *value < 0) throw bad;
    return *value;
  };
  FrameRange range;
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    range.last = number(text) - 1;
  } else {
    range.first = number(text.substr(0, colon));
    range.last = number(text.substr(colon + 1));
  }
  if (range.last < range.first || range.last > kLastFrame ||
      range.last - range.first >= kMostFrames) {
    throw bad;
  }
  return range;
}

FrameSource::FrameSource(SceneArguments arguments, FrameRange range, bool self)
    : arguments_(std::move(arguments)), range_(range), self_(self), meshes_(range.first) {
  const std::vector<std::string>& names = arguments_.names;
  const bool built_in = names.size() == 1 && is_builtin_scene(names[0]);
  require_meshes(arguments_);
  if (built_in && has_motion(names[0])) {
    built_in_.emplace(names[0], range.last + 1, self);
    return;
  }
  if (const std::optional<Error> error = missing_file(names, range_, range_.first)) throw *error;
  if (!built_in) scene_ = load_scene(arguments_, meshes_);
  if (meshes_.numbered_paths().empty()) {
    throw Error("--frames", "nothing in the scene moves",
                "put %d or %04d in place of the number in the name of a mesh, or name one of " +
                    moving_names());
  }
}

FrameSource::FrameSource(MovingScene moving) : built_in_(std::move(moving)) {}

const Scene& FrameSource::at(long frame) {
  if (!built_in_) {
    meshes_.set_frame(frame);
    if (const std::optional<Error> error = missing_file(meshes_.numbered_paths(), range_, frame))
      throw *error;
    Scene now = load_scene(arguments_, meshes_);
    if (now.triangles == scene_.triangles) now.triangles.swap(scene_.triangles);
    scene_ = std::move(now);
    for (Object& object : scene_.objects) object.self = object.self || self_;
  } else if (arguments_.ignore) {
    scene_ = built_in_->at(frame);  // copies into the memory of the previous frame
    ignore_more(scene_, arguments_, first_ ? UnknownName::refused : UnknownName::passed_over);
  }
  const Scene& scene = built_in_ && !arguments_.ignore ? built_in_->at(frame) : scene_;
  const bool same = vertices_ == scene.vertices.size() && triangles_ == scene.triangles &&
                    same_objects(objects_, scene.objects);
  changed_ = !same && !first_;
  first_ = false;
  if (!same) {
    vertices_ = scene.vertices.size();
    triangles_ = scene.triangles;
    objects_ = scene.objects;
  }
  return scene;
}

std::optional<Error> FrameSource::missing() const {
  const std::vector<std::string> paths = meshes_.numbered_paths();
  for (long frame = range_.first; !paths.empty() && frame <= range_.last; ++frame) {
    if (std::optional<Error> error = missing_file(paths, range_, frame)) return error;
  }
  return std::nullopt;
}

FrameNotes FrameSource::notes() const {
  if (!built_in_) return {};
  return {.values = built_in_->notes(), .warning = built_in_->warning()};
}

}  // namespace farcull
