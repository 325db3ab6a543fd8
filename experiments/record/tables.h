// What people read: aligned tables and short lines. Programs read the JSON (output.h), which holds
// more.
#pragma once

#include <string>
#include <vector>

#include "experiments/method/run.h"

namespace farcull {

/// The radius as the option gives it: "budget", "published" or the factor.
std::string radius_text(const RadiusRule& radius);

/// The view with the largest budget: the one that a reader should quote. Null where none was drawn.
const ViewReport* widest_budget(const std::vector<ViewReport>& views);

/// What the scene does not ask (verify/certificate/not_asked.h): "12 pairs of triangles inside a
/// and b"; empty where it leaves out nothing.
std::string not_asked_text(const Scene& scene);
/// The same as a line of its own, with the options that ask it; empty where there is nothing.
std::string not_asked_line(const Scene& scene, const std::string& options = "--self");

/// The lines that say what was run, on what, and what was not asked.
std::string run_heading(const Scene& scene, const Record& record);

/// One run. The stages of a view are folded into one row, and so are all rounds after the first.
std::string run_table(const Scene& scene, const Record& record);

/// Several runs of one scene, a line each. `repeat` > 1: times are medians, the spread is in the
/// JSON.
std::string comparison_table(const Scene& scene, const std::vector<Record>& records);

}  // namespace farcull
