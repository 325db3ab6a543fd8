// `farcull picture --html`: one file with the scene, the answers of methods on it, and all that a
// browser needs to show them and to look around in them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/picture/picture.h"

namespace farcull {

/// At most so many triangles in a frame, so many in all frames, so many colliding pairs in a frame,
/// and so many objects: 16 bits of a corner name its object.
constexpr std::uint64_t kMostPageTriangles = 2'000'000, kMostPageTrianglesOfFrames = 16'000'000,
                        kMostPagePairs = 4'000'000, kMostPageObjects = 65'536;

struct PageArguments {
  PictureArguments picture;          // the flat picture; its scene is that of the page
  std::vector<RunOptions> steps;     // what the reader can choose among: at least one
  std::optional<FrameRange> frames;  // of a scene that moves; empty: the frame of the picture
};

/// Resolutions that a reader can step through where none is named, px: from pixels that are large
/// to the usual ones.
constexpr std::array<int, 5> kPageResolutions = {32, 64, 128, 256, 512};

/// The methods of the panels, each once at every resolution, ascending; one that takes none, or
/// chooses it by the scene, as it is.
std::vector<RunOptions> at_resolutions(const std::vector<RunOptions>& panels,
                                       std::vector<int> resolutions);

/// What one method answered on one frame.
struct PageStep {
  PanelResult result;
  std::optional<long> frame;
};

struct PageResult {
  std::string html;
  std::vector<PageStep> steps;  // frame by frame, in the order of the arguments
};

/// Runs the methods of the steps and writes the page. `flat`: the flat picture of the same scene,
/// which is printed, and shown where a browser lacks WebGL 2. Throws Error where the program was
/// built without three.js, for a scene or a motion that is too large, and as make_picture() does.
PageResult make_page(const PageArguments& arguments, const PictureResult& flat, Lab& lab);

/// Throws Error naming --html where the program was built without three.js.
void require_three();

/// Throws Error naming --html where the scene of the page, or its first frame, has more triangles
/// or objects than a page holds: before anything is run. Throws as open_scene() does.
void require_page_size(const PageArguments& arguments, Lab& lab);

}  // namespace farcull
