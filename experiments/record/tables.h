// Text for people: aligned tables and short lines. The JSON of output.h holds more, for programs.
#pragma once

#include "experiments/method/run.h"

namespace farcull {

/// The view with the largest budget, which texts quote. Null if no view was drawn.
const ViewReport* widest_budget(const std::vector<ViewReport>& views);

/// The object of a triangle, and the number of the triangle in the object.
struct TrianglePlace {
  std::uint32_t object = 0, triangle = 0;
};
TrianglePlace place_of(const Scene& scene, std::uint32_t triangle);
/// "bunny triangle 3".
std::string place_text(const Scene& scene, std::uint32_t triangle);

/// Why a scene has no pair of triangles to test.
struct NothingToTest {
  std::string reason;      // such as "the scene is one object, and ..."; empty: it has a pair
  bool with_self = false;  // the scene would have a pair with --self
};
NothingToTest nothing_to_test(const Scene& scene);

/// The line that says which method is the default and names the others; empty if the user named a
/// method.
std::string default_method_line(const RunOptions& options);

/// The words for a drawing method that did not draw, since boxes left nothing.
inline constexpr const char* kNothingToDraw = "nothing left to draw";
/// Why a drawing method did not draw, such as kNothingToDraw; empty if it drew, and for other
/// methods.
std::string not_drawn_text(const Record& record);
/// The line that names a faster method than a guaranteed one that draws on the cores of a CPU
/// (docs/results/stages.md); empty for other methods.
std::string faster_line(const RunOptions& options);

/// "298 pairs", or with `self` (an object is tested against itself) "1,643 pairs = 1,581 + 62 of
/// neighbours".
std::string colliding_text(std::uint64_t pairs, std::uint64_t neighbour_pairs, bool self);

/// Pairs that the scene leaves out (verify/certificate/certificate.h): "12 pairs of triangles
/// inside a and b"; empty if it leaves out none.
std::string not_asked_text(const Scene& scene);
/// A whole line with this text and the `options` that would ask about these pairs; empty if the
/// scene leaves out none.
std::string not_asked_line(const Scene& scene, const std::string& options = "--self");

/// ", 2 polygons folded: face 7 of fin, face 9 of fin": polygons of a file that are not simple;
/// empty if there are none.
std::string folded_text(const Scene& scene);
/// The name of the scene, and how many objects and triangles it has.
std::string scene_text(const Scene& scene, std::uint64_t degenerate_triangles);
/// Says how many rows of a table are not shown; empty if all are.
std::string more_line(std::size_t all, std::size_t shown);

/// The lines that say what was run, on which device, and what was not tested.
std::string run_heading(const Scene& scene, const Record& record);

/// A row for each stage: its time, how many items entered and were left, and its reason.
std::string stage_table(const std::vector<Stage>& stages);

/// The answer of one run, in lines of at most 80 columns if the words allow it: the pairs, the
/// accounting, the method and the device. verdict: lines of the caller, put before the accounting.
std::string run_answer(const Scene& scene, const Record& record, const std::string& verdict = "");
/// The lines that run --verbose adds: the views, the radius, and a row for each stage, also for
/// those that were left out. The stages of a view share a row, and so do all rounds after the
/// first.
std::string run_details(const Record& record);
std::string run_table(const Scene& scene, const Record& record, const std::string& verdict = "");

/// The verdict of an accounting, in one line without a newline: "verified: no colliding pair was
/// culled, 26,214,400 pairs accounted for".
std::string verdict_text(const Accounting& accounting);

/// The number of pairs, and how many are in each class: two lines.
std::string accounting_sum(const Accounting& accounting);

/// A method in a comparison.
struct Compared {
  Record record;                     // the run with the median time, cull + exact
  double least_ms = 0, most_ms = 0;  // the extremes of all its runs
  std::size_t runs = 1;
};
std::string comparison_table(const Scene& scene, const std::vector<Compared>& rows);

}  // namespace farcull
