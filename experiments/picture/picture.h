// `farcull picture`: makes a picture or an HTML page of a method's result on a scene. Both show the
// colliding triangles, the missed triangles, and the kept triangles that do not collide.
#pragma once

#include "experiments/measure/harness.h"
#include "experiments/method/clash.h"
#include "experiments/picture/panel.h"
#include "experiments/scenes/frames.h"

namespace farcull {

/// The result of a method on a scene, compared with all colliding pairs.
struct MethodAnswer {
  std::vector<TrianglePair> missed;  // colliding pairs that the method did not find; sorted
  std::vector<std::uint32_t> lost;   // triangles in at least one missed pair, ascending
  std::vector<std::uint32_t> idle;   // kept triangles that do not collide, ascending
  PanelResult result;                // counts and texts
};

/// Returns the scene that the arguments name; `lab` owns the scene. Throws Error as load_scene()
/// and FrameSource do.
const Scene& open_scene(const PictureArguments& arguments, MeasurementContext& lab);

/// Runs a method on `scene`, and compares the result with lab.truth(). Uses the lab's device. The
/// device and the verification in `options` are not used. Throws Error as run() does. Precondition:
/// `scene` is the last scene that the lab opened.
MethodAnswer answer_of(RunOptions options, const Scene& scene, MeasurementContext& lab);

struct PictureResult {
  Image image;
  PngTexts texts;  // provenance: commit, scene and hash, device and driver, command, panels
  std::string scene, scene_hash;
  std::uint64_t objects = 0, triangles = 0;
  std::vector<PanelResult> panels;
  std::string not_asked;  // text about pairs that were not tested; not_asked_line()
};

/// Runs the methods of the panels and draws the picture on the lab's device. If this device is
/// "cpu", the first GL device draws the picture. Throws Error for bad arguments, a scene without
/// triangles, a scene that a method does not accept, and faults of the device.
PictureResult make_picture(const PictureArguments& arguments, MeasurementContext& lab);

// `farcull picture --html` writes one file. The file has the scene, the results of methods, and all
// code that a browser needs to show them. web/page_view.js unpacks the numbers and bits.

/// Returns Base64 of gzip of encoded numbers. Replaces each number by its difference, modulo 2^32,
/// from the previous number (0 before the first). Encodes the differences 0, -1, 1, -2, ... as 0,
/// 1, 2, 3, ... Stores the lowest bytes of all codes first, then the next bytes, and so on. Since
/// successive numbers are similar, most bytes are 0.
std::string packed_numbers(std::span<const std::uint32_t> numbers);

std::string packed_bytes(std::string_view bytes);

/// Returns `count` bits, eight in a byte, lowest bit first. Bit i is 1 if `numbers` contains i.
/// Precondition: the numbers are below `count`.
std::string bits_of(std::span<const std::uint32_t> numbers, std::size_t count);

/// Returns the positions of points in the box, in units of 1/65535 of the box's extent along each
/// axis: all x, then all y, then all z. Points outside the box are moved to its border. If the box
/// has no extent along an axis, the coordinates on this axis are 0.
std::vector<std::uint32_t> quantized(std::span<const Vec3> points, const Box& box);

/// The maximum numbers of triangles, colliding pairs and objects that a page can show. The page
/// stores an object's number in 16 bits.
constexpr std::uint64_t kMostPageTriangles = 2'000'000, kMostPagePairs = 4'000'000,
                        kMostPageObjects = 65'536;

struct PageArguments {
  PictureArguments picture;       // arguments of the picture of the same scene
  std::vector<RunOptions> steps;  // options of the runs that the reader can select; not empty
};

/// Default resolutions, in px, that a reader can choose.
constexpr std::array<int, 5> kPageResolutions = {32, 64, 128, 256, 512};

/// Returns the options of the runs. A method that renders appears once for each resolution, in
/// ascending order. Any other method appears once.
std::vector<RunOptions> at_resolutions(const std::vector<RunOptions>& panels,
                                       std::vector<int> resolutions);

struct PageResult {
  std::string html;
  std::vector<PanelResult> steps;  // results, in the order of PageArguments::steps
};

/// Runs the methods of the steps, and returns the page. flat: the picture of the same scene, for
/// printing and for browsers without WebGL 2. Throws Error as make_picture() does, if the program
/// was built without three.js, or if the scene is too large for a page.
PageResult make_page(const PageArguments& arguments, const PictureResult& flat,
                     MeasurementContext& lab);

/// Throws Error naming --html if the program was built without three.js.
void require_three();

/// Throws Error naming --html if the scene has too many triangles or objects for a page. Throws
/// Error as open_scene() does. Call this function before the methods run.
void require_page_size(const PageArguments& arguments, MeasurementContext& lab);

/// Returns the page of `farcull clash --html`: the parts, the list of pairs whose verdict is not
/// `clear`, and the curves in which surfaces intersect. unit: the unit of the lengths; empty if the
/// unit is unknown. Throws Error as require_clash_page() does.
std::string clash_page(const Scene& scene, const ClashRecord& record, const std::string& unit);

/// Throws Error naming --html if no page can show the scene. Call this before the clash test.
void require_clash_page(const Scene& scene);

}  // namespace farcull
