// `farcull picture`: shows the answer of a method on a scene, as a picture or as a page: which
// triangles collide, which of these the method missed, and which it kept in vain.
#pragma once

#include "experiments/measure/harness.h"
#include "experiments/method/clash.h"
#include "experiments/picture/panel.h"
#include "experiments/scenes/frames.h"

namespace farcull {

/// The answer of a method on the scene of a picture, compared with all colliding pairs.
struct MethodAnswer {
  std::vector<TrianglePair> missed;  // colliding pairs that the method lacks; sorted
  std::vector<std::uint32_t> lost;   // triangles in a missed pair, ascending
  std::vector<std::uint32_t> idle;   // kept triangles that are in no collision, ascending
  PanelResult result;                // counts and texts
};

/// The scene of the arguments, kept by the lab. Throws Error as load_scene() and FrameSource do.
const Scene& open_scene(const PictureArguments& arguments, MeasurementContext& lab);

/// Runs the method on `scene`, the last scene that the lab opened, and compares its answer with
/// lab.truth(). Uses the lab's device; ignores the options' device and verification. Throws Error
/// as run() does.
MethodAnswer answer_of(RunOptions options, const Scene& scene, MeasurementContext& lab);

struct PictureResult {
  Image image;
  PngTexts texts;  // provenance: commit, scene and hash, device and driver, command, panels
  std::string scene, scene_hash;
  std::uint64_t objects = 0, triangles = 0;
  std::vector<PanelResult> panels;
  std::string not_asked;  // not_asked_line() of the scene (tables.h)
};

/// Runs the methods of the panels and draws the picture, on the lab's device; if that is "cpu", the
/// first GL device draws. Throws Error for bad arguments, a scene without triangles, a scene that a
/// method does not accept, and faults of the device.
PictureResult make_picture(const PictureArguments& arguments, MeasurementContext& lab);

// `farcull picture --html`: one file with the scene, the answers of methods on it, and everything
// that a browser needs to show them. web/page_view.js reads the numbers and bits, which are
// compressed.

/// Base64 of gzip of the numbers. A number is stored as its difference to the previous one (the
/// first to 0) modulo 2^32, in the order 0, -1, 1, -2, ..; first the lowest bytes of all
/// differences, then the next bytes, and so on. Neighbours are similar, so most bytes are 0.
std::string packed_numbers(std::span<const std::uint32_t> numbers);

std::string packed_bytes(std::string_view bytes);

/// `count` bits, eight in a byte, the lowest first: 1 at the positions `numbers`, which are below
/// `count`.
std::string bits_of(std::span<const std::uint32_t> numbers, std::size_t count);

/// The coordinates as steps of 1/65535 of the box: all x, then all y, then all z. Points outside
/// the box are moved to its border. A coordinate is 0 if the box has no extent along its axis.
std::vector<std::uint32_t> quantized(std::span<const Vec3> points, const Box& box);

/// The most triangles, colliding pairs and objects of a page. A corner names its object by 16 bits.
constexpr std::uint64_t kMostPageTriangles = 2'000'000, kMostPagePairs = 4'000'000,
                        kMostPageObjects = 65'536;

struct PageArguments {
  PictureArguments picture;       // the flat picture; the page shows the same scene
  std::vector<RunOptions> steps;  // the choices of the reader: at least one
};

/// The default resolutions that a reader can choose, px.
constexpr std::array<int, 5> kPageResolutions = {32, 64, 128, 256, 512};

/// The methods of the panels: each method that draws at every resolution, ascending; the others
/// once.
std::vector<RunOptions> at_resolutions(const std::vector<RunOptions>& panels,
                                       std::vector<int> resolutions);

struct PageResult {
  std::string html;
  std::vector<PanelResult> steps;  // the answers, in the order of the arguments
};

/// Runs the methods of the steps and writes the page. flat: the picture of the same scene, for
/// printing and for browsers without WebGL 2. Throws Error if the program was built without
/// three.js, for a scene that is too large, and as make_picture() does.
PageResult make_page(const PageArguments& arguments, const PictureResult& flat,
                     MeasurementContext& lab);

/// Throws Error naming --html if the program was built without three.js.
void require_three();

/// Throws Error naming --html if the scene has more triangles or objects than a page holds, and as
/// open_scene() does. To be called before the work.
void require_page_size(const PageArguments& arguments, MeasurementContext& lab);

/// `farcull clash --html`: one file with the parts, the list of pairs that are not clear, and the
/// curves in which surfaces cross. unit: of the lengths; empty: not said. Throws Error as
/// require_clash_page() does.
std::string clash_page(const Scene& scene, const ClashRecord& record, const std::string& unit);

/// Throws Error naming --html if no page can show the scene. To be called before the work.
void require_clash_page(const Scene& scene);

}  // namespace farcull
