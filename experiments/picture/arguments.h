// The arguments of `farcull picture` as values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/view/view.h"
#include "experiments/method/run.h"
#include "experiments/scenes/frames.h"

namespace farcull {

struct PictureArguments {
  std::vector<std::string> scene;  // as load_scene()
  bool self = false;               // every object is tested against itself as well
  std::optional<long> frame;       // of a scene that moves; empty: the scene without frames
  std::optional<FrameRange>
      frames;  // of the motion; default 30 frames, or the one of numbered meshes
  std::vector<RunOptions>
      panels;         // a panel each, side by side; verify and device are not looked at
  std::string view;   // direction that the eye looks along, as parse_view(); "":
                      // obliquely down on the side that +z points to
  std::string up;     // upwards in the picture: x, -x, ... z, -z; "": y
  bool zoom = false;  // only what collides
  std::optional<std::string> depth_view;  // instead: the depth that is stored in this view of the
                                          // method's, and what the view culls, over it
  int width = 900, height = 760;          // px of a panel's picture, 64 to kMostPicture
};

/// At most so many panels.
constexpr std::size_t kMostPanels = 6;

/// The arguments as a command line, without -o.
std::string command_of(const PictureArguments& arguments);

/// Throws Error naming the option where one is out of range or options do not go together. Reads no
/// scene, opens no device.
void validate(const PictureArguments& arguments);

/// The view of the picture: an eye sees its image so, right, up and forward of a right-handed
/// world. Throws Error naming --up where that is the direction of sight.
View camera(const PictureArguments& arguments);

/// The frames of the motion that arguments.frame is one of. Precondition: a frame is given.
FrameRange frames_of(const PictureArguments& arguments);

}  // namespace farcull
