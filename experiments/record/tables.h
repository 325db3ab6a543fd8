// Text for people: aligned tables and short lines. The JSON of output.h has more data.
#pragma once

#include "experiments/method/run.h"

namespace farcull {

/// Returns the view with the largest budget. Texts show the numbers of this view. Null if no view
/// was drawn.
const ViewReport* widest_budget(const std::vector<ViewReport>& views);

/// The object of a triangle, and the index of the triangle in the object.
struct TrianglePlace {
  std::uint32_t object = 0, triangle = 0;
};
TrianglePlace place_of(const Scene& scene, std::uint32_t triangle);
/// Returns a text such as "bunny triangle 3".
std::string place_text(const Scene& scene, std::uint32_t triangle);

/// Why a scene has no pair of triangles to test.
struct NothingToTest {
  std::string reason;      // "the scene is one object, and ..."; empty if there is a pair
  bool with_self = false;  // true: the scene would have a pair with --self
};
NothingToTest nothing_to_test(const Scene& scene);

/// Returns a line that names the default method and the other methods. Returns "" if the user named
/// a method.
std::string default_method_line(const RunOptions& options);

/// Text for a method that draws, if no triangle was left to draw after the box tests.
inline constexpr const char* kNothingToDraw = "nothing left to draw";
/// Returns why a method that can draw did not draw, such as kNothingToDraw. Returns "" if the
/// method drew, or if the method never draws.
std::string not_drawn_text(const Record& record);
/// If the method is guaranteed and draws on the cores of a CPU, returns a line that names a faster
/// method (docs/results/stages.md). Otherwise returns "".
std::string faster_line(const RunOptions& options);

/// Returns a text such as "298 pairs". If `self` is true (an object is tested against itself),
/// returns a text such as "1,643 pairs = 1,581 + 62 of neighbours".
std::string colliding_text(std::uint64_t pairs, std::uint64_t neighbour_pairs, bool self);

/// Returns a text about pairs that the scene leaves out (verify/certificate/certificate.h): "12
/// pairs of triangles inside a and b". Returns "" if the scene leaves out no pairs.
std::string not_asked_text(const Scene& scene);
/// Returns a line with not_asked_text() and the `options` that would include these pairs. Returns
/// "" if the scene leaves out no pairs.
std::string not_asked_line(const Scene& scene, const std::string& options = "--self");

/// Returns a text about polygons of a file that are not simple: ", 2 polygons folded: face 7 of
/// fin, face 9 of fin". Returns "" if there are no such polygons.
std::string folded_text(const Scene& scene);
std::string scene_text(const Scene& scene, std::uint64_t degenerate_triangles);
/// Returns a line with the number of rows that a table omits; "" if the table shows all rows.
std::string more_line(std::size_t all, std::size_t shown);

/// Returns lines about the method, the device, and the pairs that were not tested.
std::string run_heading(const Scene& scene, const Record& record);

/// Returns a row for each stage: its time, its numbers of items before and after, and its reason.
std::string stage_table(const std::vector<Stage>& stages);

/// Returns the answer of one run: the pairs, the accounting, the method and the device. Lines are
/// wrapped at 80 columns. verdict: lines to put before the accounting.
std::string run_answer(const Scene& scene, const Record& record, const std::string& verdict = "");
/// Returns the lines that run --verbose adds: the views, the radius and the stages, also those that
/// were left out. The stages of a view share a row. All rounds after the first share a row.
std::string run_details(const Record& record);
std::string run_table(const Scene& scene, const Record& record, const std::string& verdict = "");

/// Returns the verdict of an accounting as a line without a newline: "verified: no colliding pair
/// was culled, 26,214,400 pairs accounted for".
std::string verdict_text(const Accounting& accounting);

std::string accounting_sum(const Accounting& accounting);

/// A method in a comparison.
struct Compared {
  Record record;                     // the run with the median time (cull + exact)
  double least_ms = 0, most_ms = 0;  // least and largest time of all runs
  std::size_t runs = 1;
};
std::string comparison_table(const Scene& scene, const std::vector<Compared>& rows);

}  // namespace farcull
