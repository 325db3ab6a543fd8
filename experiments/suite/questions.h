// Questions of a suite beyond "which triangles collide": distances of triangles, whether a mesh
// meets itself, whether a point is inside, whether two solids overlap. docs/suite.md has the
// format.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/suite/label.h"

namespace farcull {

enum class SuiteQuestionKind : std::uint8_t { distance, self, inside, clash };

struct SuiteQuestion {
  std::uint64_t id = 0;
  double parameter = 0;
  SuiteQuestionKind kind = SuiteQuestionKind::distance;
  std::string label = {};                // as in the file; "?" if it is not known
  std::vector<std::string> paths = {};   // of OBJ files, relative to the folder of the suite
  std::vector<double> coordinates = {};  // 18 of two triangles, 3 of a point, or none
};

/// One file of questions.
struct SuiteQuestions {
  std::string family = {};
  std::vector<SuiteQuestion> questions = {};
};

/// The text of a file of questions.
std::string questions_text(const SuiteQuestions& questions);

/// Asks for the distances of the first pairs of a family, as many as the small suite has. Pairs
/// with shared corners are left out.
SuiteQuestions questions_of(const SuitePairs& pairs);
/// Questions about the objects of a mesh: whether each meets itself; for closed ones, also whether
/// points are inside and whether two clash. There is no question where the oracles cannot decide.
SuiteQuestions questions_of(const SuiteMesh& mesh, std::uint64_t seed);

// Each label is decided by two programs that share no code. Throws Error naming `where` if they
// disagree.

/// "LOW,HIGH": the distance of two triangles lies between these doubles, which are equal or
/// neighbours. Found in exact fractions (verify/closest.h), and in integers by the directions of
/// the certificate checker.
std::string decide_distance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                            const std::string& where);
/// Whether each point is in the closed object 0 of the scene or on its surface. Found by rays in
/// rational numbers (verify/inside.h), and in integers (verify/certificate/integer_distance.h).
std::vector<bool> decide_inside(const Scene& scene, const std::vector<Vec3>& points,
                                const std::string& where);
/// Whether the insides of the closed objects 0 and 1 overlap. True if a point is found that is
/// inside both; the oracles of decide_inside() check it. False if an axis-aligned plane lies
/// between the objects. Empty if neither is found.
std::optional<bool> decide_clash(const Scene& scene, const std::string& where);

}  // namespace farcull
