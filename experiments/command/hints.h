// Hints that the program prints besides an answer. Each function searches the meshes anew.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/method/run.h"

namespace farcull {

/// The objects of which two triangles collide with each other, ascending.
std::vector<std::uint32_t> meeting_themselves(const Scene& scene, const Record& record);

/// Lines about those of these objects that --weld would close: at which tolerance, and where; at
/// most three. Empty for objects of more than 4 million triangles together.
std::string weld_lines(const Scene& scene, const std::vector<std::uint32_t>& objects);

/// Lines that say which objects may lie wholly inside closed ones: their boxes do, and the surfaces
/// do not meet. Empty if there are none, or more than a million pairs of boxes to examine.
std::string nested_line(const Scene& scene, const Record& record);

}  // namespace farcull
