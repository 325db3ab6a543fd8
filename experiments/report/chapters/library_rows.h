// Of the study "libraries": what its rows say together, for its tables, figures and sentences.
#pragma once

#include <cstdint>
#include <string>

#include "experiments/report/chapters/rows.h"

namespace farcull {

/// "pairs/random" or "meshes/shells" of the scene "small/pairs/random".
std::string family_of(const Row& row);
/// Whether a method of farcull answered.
bool is_ours(const Row& row);
/// The rows about pairs of triangles, or those about meshes.
Rows rows_about(const Rows& rows, bool pairs);

/// Questions at which the process crashed, hung or ran out of memory.
std::uint64_t deaths(const Rows& rows);
/// Questions without an answer, for whatever reason.
std::uint64_t without_answer(const Rows& rows);
/// "78 of 646": answered otherwise the second time, of those asked twice. "0": none.
std::string differing(const Rows& rows);

/// Pairs of triangles of meshes by one of the two measures (docs/libraries.md, "By which measure"),
/// of the meshes that were answered. Of pairs that are apart nobody knows the number, so false
/// alarms are a part of what was reported.
struct MeshAnswers {
  std::uint64_t colliding = 0, missed = 0;       // missed: of the colliding
  std::uint64_t reported = 0, false_alarms = 0;  // false alarms: of the reported
};
/// `own`: the pairs alone of which the contestant's documentation promises the answer.
MeshAnswers mesh_answers(const Rows& rows, bool own);
/// Of the pairs that collide or were reported, the part about which the answer is wrong: 0 to 1; 0
/// where there is no such pair.
double wrong_part(const MeshAnswers& answers);

}  // namespace farcull
