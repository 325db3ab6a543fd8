// Text for people: aligned tables and short lines. The JSON of output.h holds more, for programs.
#pragma once

#include "experiments/method/run.h"

namespace farcull {

/// Returns the view with the largest budget; texts give the numbers of this view. Null if no view
/// was drawn.
const ViewReport* widest_budget(const std::vector<ViewReport>& views);

/// The object of a triangle, and the number of the triangle in the object.
struct TrianglePlace {
  std::uint32_t object = 0, triangle = 0;
};
TrianglePlace place_of(const Scene& scene, std::uint32_t triangle);
/// Returns a text such as "bunny triangle 3".
std::string place_text(const Scene& scene, std::uint32_t triangle);

/// Why a scene has no pair of triangles to test.
struct NothingToTest {
  std::string reason;      // "the scene is one object, and ..."; empty if there is a pair
  bool with_self = false;  // the scene would have a pair with --self
};
NothingToTest nothing_to_test(const Scene& scene);

/// Returns a line that names the default method and the other methods. Empty if the user named a
/// method.
std::string default_method_line(const RunOptions& options);

/// Text for a drawing method that did not draw, because the box tests left nothing to draw.
inline constexpr const char* kNothingToDraw = "nothing left to draw";
/// Returns why a drawing method did not draw, such as kNothingToDraw. Empty if the method drew, or
/// if the method does not draw at all.
std::string not_drawn_text(const Record& record);
/// If the method is guaranteed and draws on the cores of a CPU, returns a line that names a faster
/// method (docs/results/stages.md). Otherwise returns an empty text.
std::string faster_line(const RunOptions& options);

/// Returns "298 pairs"; with `self` (an object is tested against itself) "1,643 pairs = 1,581 + 62
/// of neighbours".
std::string colliding_text(std::uint64_t pairs, std::uint64_t neighbour_pairs, bool self);

/// Returns a text about pairs that the scene leaves out (verify/certificate/certificate.h): "12
/// pairs of triangles inside a and b". Empty if the scene leaves out no pairs.
std::string not_asked_text(const Scene& scene);
/// Returns a line with not_asked_text() and the `options` that include these pairs. Empty if the
/// scene leaves out no pairs.
std::string not_asked_line(const Scene& scene, const std::string& options = "--self");

/// Returns a text about polygons of a file that are not simple: ", 2 polygons folded: face 7 of
/// fin, face 9 of fin". Empty if there are no such polygons.
std::string folded_text(const Scene& scene);
std::string scene_text(const Scene& scene, std::uint64_t degenerate_triangles);
/// Returns a line with the number of rows that a table does not show; empty if it shows all rows.
std::string more_line(std::size_t all, std::size_t shown);

/// Returns lines about what was run, on which device, and what was not tested.
std::string run_heading(const Scene& scene, const Record& record);

/// Returns a row for each stage: its time, how many items it got and left, and its reason.
std::string stage_table(const std::vector<Stage>& stages);

/// Returns the answer of one run: the pairs, the accounting, the method and the device. Lines have
/// at most 80 columns if the words allow it. verdict: lines to put before the accounting.
std::string run_answer(const Scene& scene, const Record& record, const std::string& verdict = "");
/// Returns the lines that run --verbose adds: the views, the radius, and the stages, with stages
/// that were left out. The stages of a view share a row. All rounds after the first share a row.
std::string run_details(const Record& record);
std::string run_table(const Scene& scene, const Record& record, const std::string& verdict = "");

/// Returns the verdict of an accounting, a line without a newline: "verified: no colliding pair was
/// culled, 26,214,400 pairs accounted for".
std::string verdict_text(const Accounting& accounting);

std::string accounting_sum(const Accounting& accounting);

/// A method in a comparison.
struct Compared {
  Record record;                     // the run whose time (cull + exact) is the median
  double least_ms = 0, most_ms = 0;  // the extremes of all runs
  std::size_t runs = 1;
};
std::string comparison_table(const Scene& scene, const std::vector<Compared>& rows);

}  // namespace farcull
