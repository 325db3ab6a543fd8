// The protocol of contestants. A contestant of the study "libraries" is a library, called as its
// documentation says, in a program of its own that reads questions as text and answers them.
//
// Each library has a program of its own, and not a command of farcull, for three reasons. It may
// crash, hang or take all memory. Libraries do not go together in one program: Bullet is there in
// float and in double under the same names. And a program in any language can take part.
//
// The program is called in one of three ways. Fields of a line stand between tabulators. NUMBER is
// that of the question, which the answer repeats.
//   PROGRAM list          prints a card for each of its contestants (card.h)
//   PROGRAM NAME pairs    reads a pair of triangles a line:
//                           NUMBER SHARED, then 18 coordinates as decimal numbers that a reader of
//                           doubles gives back exactly; SHARED as in a suite, `-` for none
//                         and answers in the same order, a line each:
//                           NUMBER 0|1 NANOSECONDS, or NUMBER refused REASON
//   PROGRAM NAME meshes   reads a scene a line:
//                           NUMBER SELF (0 or 1: each object against itself too), then the OBJ
//                           file of each object, whose triangles count from 0
//                         and answers with any number of lines
//                           NUMBER pair OBJECT TRIANGLE OBJECT TRIANGLE
//                         and one more: NUMBER done NANOSECONDS, or NUMBER refused REASON
// Nothing else may be on standard output. The program ends at the end of its input.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "experiments/peers/card.h"

namespace farcull {

using ContestPoint = std::array<double, 3>;
using ContestTriangle = std::array<ContestPoint, 3>;

/// Two triangles, and the corners that are one vertex of a mesh: corner `first` of the first is
/// corner `second` of the second.
struct ContestPair {
  std::array<ContestTriangle, 2> triangles;
  std::vector<std::pair<int, int>> shared;
};

struct ContestMesh {
  std::vector<ContestPoint> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices of vertices

  ContestTriangle corners(std::uint32_t triangle) const {
    const auto& [a, b, c] = triangles[triangle];
    return {vertices[a], vertices[b], vertices[c]};
  }
};

struct ContestScene {
  std::vector<ContestMesh> objects;
  bool self = false;  // each object is tested against itself too
};

/// A pair of triangles of a scene.
struct ContestFound {
  std::uint32_t object_a = 0, triangle_a = 0, object_b = 0, triangle_b = 0;
};

/// What a contestant throws where its library gives an error instead of an answer, or where its
/// documentation says that it is not made for the question.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Contestant {
  ContestantCard card;  // `pairs` and `meshes` are set by what is not null below
  std::function<bool(const ContestPair&)> pair = {};
  std::function<std::vector<ContestFound>(const ContestScene&)> mesh = {};
};

/// main() of a program of contestants: the protocol above. Any exception of a library is a refusal,
/// but for std::bad_alloc, which ends the program. The exit status: 0; 2 for a wrong call or a line
/// that is no question; 3 without memory.
int contest(int argc, char** argv, std::vector<Contestant> contestants);

/// Asks about every pair of objects, and about each object with itself where the scene wants that;
/// objects that are equal (a == b) mean itself. A library of two meshes needs no more.
void for_each_object_pair(const ContestScene& scene,
                          const std::function<void(std::uint32_t a, std::uint32_t b)>& ask);

}  // namespace farcull
