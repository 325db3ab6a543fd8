// What a method answers on the scene of a picture, beside the truth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/measure/lab.h"
#include "experiments/picture/arguments.h"

namespace farcull {

struct MethodAnswer {
  std::vector<TrianglePair> missed;  // colliding pairs that the method lacks; sorted
  std::vector<std::uint32_t> kept;   // triangles, ascending; none for exact, which culls none
  std::string device;                // what answered: a renderer, "cpu", or "none"
  bool broken = false;               // the method promises, and missed a pair
};

/// The scene of the arguments, kept by the lab. Throws Error as load_scene() and FrameSource do.
const Scene& open_scene(const PictureArguments& arguments, Lab& lab);

/// Runs the method on the scene that the lab opened last, and compares with the lab's truth. The
/// lab's device answers; the options' device and verification are not looked at. Throws Error as
/// run() does.
MethodAnswer answer_of(RunOptions options, const Scene& scene, Lab& lab);

}  // namespace farcull
