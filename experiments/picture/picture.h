// `farcull picture`: the answer of a method on a scene as a picture: which triangles collide, which
// of these the method missed, and which it kept in vain.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/measure/lab.h"
#include "experiments/picture/arguments.h"
#include "experiments/picture/panel.h"

namespace farcull {

/// The answer of a method on the scene of a picture, beside the truth.
struct MethodAnswer {
  std::vector<TrianglePair> missed;  // colliding pairs that the method lacks; sorted
  std::vector<std::uint32_t> lost;   // triangles in one of those, ascending
  std::vector<std::uint32_t>
      idle;            // triangles that it kept and that are in no collision, ascending
  PanelResult result;  // its counts and words
};

/// The scene of the arguments, kept by the lab. Throws Error as load_scene() and FrameSource do.
const Scene& open_scene(const PictureArguments& arguments, Lab& lab);

/// Runs the method on the scene that the lab opened last, and compares with the lab's truth. The
/// lab's device answers; the options' device and verification are not looked at. Throws Error as
/// run() does.
MethodAnswer answer_of(RunOptions options, const Scene& scene, Lab& lab);

struct PictureResult {
  Image image;
  PngTexts texts;  // provenance: commit, scene and hash, device and driver, command, panels
  std::string scene, scene_hash;
  std::uint64_t objects = 0, triangles = 0;
  std::vector<PanelResult> panels;
  std::string not_asked;  // not_asked_line() of the scene (tables.h)
};

/// Runs the methods of the panels and draws. The lab's device answers; where it is "cpu" (far-pairs
/// alone) the picture itself is drawn by the first device. Throws Error for bad arguments, a scene
/// without triangles or one that a method does not take, and for faults of the device.
PictureResult make_picture(const PictureArguments& arguments, Lab& lab);

/// make_picture(), written to the path as PNG, whole or not at all; "-" is standard output. Throws
/// Error as write_output() as well.
PictureResult write_picture(const PictureArguments& arguments, Lab& lab, const std::string& path);

}  // namespace farcull
