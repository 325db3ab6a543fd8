// Opens the scene of a picture, runs a method on it, and takes the pairs that the method lacks from
// the truth.
#include "experiments/picture/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "experiments/scenes/scene_file.h"

namespace farcull {
namespace {

std::vector<TrianglePair> found_by(const Record& record) {
  std::vector<TrianglePair> out;
  std::set_union(record.collisions.pairs.begin(), record.collisions.pairs.end(),
                 record.collisions.neighbour_pairs.begin(), record.collisions.neighbour_pairs.end(),
                 std::back_inserter(out));
  return out;
}

std::string device_of(const Record& record) {
  if (record.found.device.gl) return record.found.device.gl->renderer;
  return record.found.device.cpu ? "cpu" : "none";
}

}  // namespace

const Scene& open_scene(const PictureArguments& arguments, Lab& lab) {
  if (arguments.scene.size() == 1 && !arguments.self && !arguments.frame)
    return lab.scene(arguments.scene.front());
  // No name of a scene holds a line feed.
  std::string key = arguments.self ? "self\n" : "\n";
  for (const std::string& part : arguments.scene) key += part + "\n";
  if (arguments.frame) {
    const FrameRange range = frames_of(arguments);
    key += fmt::format("{} of {}:{}", *arguments.frame, range.first, range.last);
  }
  if (lab.progress()) lab.progress()("reading the scene");
  return lab.scene(key, [&arguments] {
    if (arguments.frame) {
      FrameSource source(arguments.scene, frames_of(arguments), arguments.self);
      return source.at(*arguments.frame);
    }
    Scene scene = load_scene(arguments.scene);
    for (Object& object : scene.objects) object.self |= arguments.self;
    return scene;
  });
}

MethodAnswer answer_of(RunOptions options, const Scene& scene, Lab& lab) {
  options.verify = false;
  options.device = lab.device();
  const Record record = run(scene, options, lab.session(), lab.progress());
  const std::vector<TrianglePair>& truth = lab.truth().pairs;
  const std::vector<TrianglePair> found = found_by(record);
  MethodAnswer answer;
  std::set_difference(truth.begin(), truth.end(), found.begin(), found.end(),
                      std::back_inserter(answer.missed));
  answer.kept = record.found.triangles;
  answer.device = device_of(record);
  // As in run: whatever the probes of the device say.
  answer.broken = promises(record.options) && !answer.missed.empty();
  return answer;
}

}  // namespace farcull
