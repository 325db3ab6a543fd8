// `farcull picture`: shows the answer of a method on a scene, as a picture or as a page: which
// triangles collide, which of these the method missed, and which it kept in vain.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/measure/harness.h"
#include "experiments/method/clash.h"
#include "experiments/picture/panel.h"
#include "experiments/scenes/frames.h"

namespace farcull {

/// The answer of a method on the scene of a picture, compared with the truth.
struct MethodAnswer {
  std::vector<TrianglePair> missed;  // colliding pairs that the method lacks; sorted
  std::vector<std::uint32_t> lost;   // triangles in a missed pair, ascending
  std::vector<std::uint32_t> idle;   // kept triangles that are in no collision, ascending
  PanelResult result;                // its counts and texts
};

/// The scene of the arguments, kept by the lab. Throws Error as load_scene() and FrameSource do.
const Scene& open_scene(const PictureArguments& arguments, MeasurementContext& lab);

/// Runs the method on the last scene that the lab opened, and compares its answer with lab.truth().
/// The lab's device is used; the options' device and verification are ignored. Throws Error as
/// run() does.
MethodAnswer answer_of(RunOptions options, const Scene& scene, MeasurementContext& lab);

struct PictureResult {
  Image image;
  PngTexts texts;  // provenance: commit, scene and hash, device and driver, command, panels
  std::string scene, scene_hash;
  std::uint64_t objects = 0, triangles = 0;
  std::vector<PanelResult> panels;
  std::string not_asked;  // not_asked_line() of the scene (tables.h)
};

/// Runs the methods of the panels and draws, both on the lab's device; if that is "cpu", the first
/// GL device draws the picture. Throws Error for bad arguments, a scene without triangles or one
/// that a method does not accept, and for faults of the device.
PictureResult make_picture(const PictureArguments& arguments, MeasurementContext& lab);

// `farcull picture --html`: one file with the scene, the answers of methods on it, and everything
// that a browser needs to show and explore them. Its data are text: numbers and bits, compressed
// for a reader in JavaScript (web/page_view.js).

/// Base64 of gzip of the numbers. Each number is stored as its difference to the previous one (the
/// first to 0) modulo 2^32, zigzag (0, -1, 1, -2, ... become 0, 1, 2, 3, ...); first the lowest
/// bytes of all, then the next ones, and so on. Neighbours are similar, so most bytes become 0.
std::string packed_numbers(std::span<const std::uint32_t> numbers);

/// Base64 of gzip of the bytes.
std::string packed_bytes(std::string_view bytes);

/// `count` bits: those at the positions `numbers` are 1. Eight in a byte, the lowest first.
/// Precondition: every number is below `count`.
std::string bits_of(std::span<const std::uint32_t> numbers, std::size_t count);

/// The coordinates as steps of 1/65535 of the box: all x, then all y, then all z. Points outside
/// the box are moved to its border. A coordinate is 0 if the box has no extent along its axis.
std::vector<std::uint32_t> quantized(std::span<const Vec3> points, const Box& box);

/// Limits of a page: triangles, colliding pairs, and objects (16 bits of a corner name its object).
constexpr std::uint64_t kMostPageTriangles = 2'000'000, kMostPagePairs = 4'000'000,
                        kMostPageObjects = 65'536;

struct PageArguments {
  PictureArguments picture;       // the flat picture; the page shows the same scene
  std::vector<RunOptions> steps;  // the choices of the reader: at least one
};

/// Default resolutions that a reader can step through, px: from large pixels to usual ones.
constexpr std::array<int, 5> kPageResolutions = {32, 64, 128, 256, 512};

/// The methods of the panels: each one that draws, once at every resolution, ascending; the others
/// once and unchanged.
std::vector<RunOptions> at_resolutions(const std::vector<RunOptions>& panels,
                                       std::vector<int> resolutions);

struct PageResult {
  std::string html;
  std::vector<PanelResult> steps;  // the answers, in the order of the arguments
};

/// Runs the methods of the steps and writes the page. `flat`: the flat picture of the same scene,
/// for printing and for browsers without WebGL 2. Throws Error if the program was built without
/// three.js, for a scene that is too large, and as make_picture() does.
PageResult make_page(const PageArguments& arguments, const PictureResult& flat,
                     MeasurementContext& lab);

/// Throws Error naming --html if the program was built without three.js.
void require_three();

/// Throws Error naming --html if the scene of the page has more triangles or objects than a page
/// holds. Called before any run. Throws as open_scene() does.
void require_page_size(const PageArguments& arguments, MeasurementContext& lab);

// `farcull clash --html` (clash_page.cpp): one file with the parts, the list of pairs that are not
// clear, and the curves in which surfaces cross.

/// unit: of the lengths; empty: not said. Throws Error as require_three() and require_page_size().
std::string clash_page(const Scene& scene, const ClashRecord& record, const std::string& unit);

/// Throws Error naming --html if no page can show the scene. To be called before the work.
void require_clash_page(const Scene& scene);

}  // namespace farcull
