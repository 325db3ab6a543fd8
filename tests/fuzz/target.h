// What is fuzzed: one function per target, called by libFuzzer (fuzz_main.cpp) and by the ordinary
// tests on the corpus (replay_test.cpp).
//
// Any bytes may be given, and the only answers are a value or an Error that says what is wrong and
// what to do. Whatever else happens is a finding: another exception, a value that breaks its
// contract (FuzzFinding), more memory than the input pays for, or what a sanitizer reports.
#pragma once

#include <cstdint>
#include <new>
#include <optional>

#include "core/base/error.h"
#include "core/scene/scene.h"
#include "tests/fuzz/allocations.h"

namespace farcull {

/// How an input was answered, so that a replay can assert that the corpus reaches every answer.
enum class Answer : std::uint8_t { refused, accepted, proved, refuted, not_proved };

/// The first byte picks the format by its two lowest bits, OBJ, OFF, PLY, STL ('0' .. '3' will do);
/// the others are the file. With the bit above them ('4' .. '7') the file is compressed as well,
/// and must be answered alike.
Answer fuzz_mesh(const std::uint8_t* data, std::size_t size);
/// The text of a scene file beside the meshes of tests/fuzz/meshes.
Answer fuzz_scene_file(const std::uint8_t* data, std::size_t size);
/// The text of a certificate, checked against a fixed scene. Where the first byte is 1 the others
/// are its evidence instead, which no mutation of base64 would come across: see fuzz_check.cpp.
Answer fuzz_check(const std::uint8_t* data, std::size_t size);

/// A contract that does not hold. No std::exception, so that nothing under test catches it.
struct FuzzFinding {
  std::string what;
};

/// Adds a triangle with corners of its own, to no object.
inline void add_triangle(Scene& scene, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  scene.vertices.insert(scene.vertices.end(), {a, b, c});
  scene.triangles.push_back({first, first + 1, first + 2});
  scene.source_face.push_back(first / 3);
}

/// An object of all triangles that belong to none yet.
inline void end_object(Scene& scene, const char* name, bool self = false) {
  const std::uint32_t first = scene.objects.empty() ? 0
                                                    : scene.objects.back().first_triangle +
                                                          scene.objects.back().triangle_count;
  const auto end = static_cast<std::uint32_t>(scene.triangles.size());
  scene.objects.push_back({name, first, end - first, self});
}

inline void require(bool condition, const std::string& what) {
  if (!condition) throw FuzzFinding{what};
}

/// The value of the call, none where it throws Error; a FuzzFinding where it takes more memory than
/// `limits` allow for an input of this size.
template <class Call>
auto answer_of(const AllocationLimits& limits, std::size_t input_bytes, const Call& call)
    -> std::optional<decltype(call())> {
  std::optional<decltype(call())> value;
  std::string excess;
  {
    const AllocationMeter meter(limits, input_bytes);
    try {
      value = call();
    } catch (const Error& error) {
      require(!error.reason.empty() && !error.remedy.empty() && error.line >= 0,
              "an Error that does not help");
    } catch (const std::bad_alloc&) {
      if (meter.excess().empty()) throw;
    }
    excess = meter.excess();
  }
  require(excess.empty(), excess);
  return value;
}

}  // namespace farcull
