// Small meshes in every format as text, and what the tests of the readers ask of errors.
#pragma once

#include "experiments/scenes/mesh/load.h"
#include "tests/lab/test.h"

namespace farcull {

using Triangle = std::array<std::uint32_t, 3>;

inline Mesh obj(const std::string& text) { return parse_mesh(text, MeshFormat::kObj, "m.obj"); }
inline Mesh off(const std::string& text) { return parse_mesh(text, MeshFormat::kOff, "m.off"); }
inline Mesh ply(const std::string& text) { return parse_mesh(text, MeshFormat::kPly, "m.ply"); }
inline Mesh stl(const std::string& text) { return parse_mesh(text, MeshFormat::kStl, "m.stl"); }

inline const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

inline void expect_error(const Error& error, const std::string& where, long line,
                         const std::string& reason) {
  EXPECT_EQ(error.where, where);
  EXPECT_EQ(error.line, line) << error.what();
  EXPECT_TRUE(has_text(error.reason, reason)) << error.what();
}

// The bytes of a value, first byte lowest or highest.
template <class T>
inline std::string bytes_of(T value, bool big = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  const bool big_here = std::endian::native == std::endian::big;
  if (big != big_here) bytes = std::string(bytes.rbegin(), bytes.rend());
  return bytes;
}

inline const std::string kOff = "OFF\n# c\n4 2 0\n\n0 0 0\n1 0 0 # c\n1 1 0\n0 1 0\n";

inline const std::string kPlyHeader =
    "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty double x\nproperty double y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
inline const std::string kPlyVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// One file in both byte orders with every kind of thing that must be passed over, and mixed types.
inline std::string binary_ply(bool big) {
  const auto put = [big](auto value) { return bytes_of(value, big); };
  std::string text =
      std::string("ply\r\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
      " 1.0\r\nobj_info i\r\nelement nothing 1000000000\r\nelement material 2\r\n"
      "property uchar a\r\nproperty list ushort double b\r\nelement vertex 3\r\n"
      "property list char short tags\r\nproperty double x\r\nproperty float y\r\n"
      "property short z\r\nproperty uint flags\r\nelement face 1\r\nproperty uchar red\r\n"
      "property list int uint vertex_index\r\nproperty list uchar float texcoord\r\n"
      "element edge 1\r\nproperty int a\r\nend_header\r\n";
  for (int i = 0; i < 2; ++i)
    text += put(std::uint8_t{7}) + put(std::uint16_t{2}) + put(1.0) + put(2.0);
  const double x[] = {0.1, 1e300, -0.0};
  const float y[] = {0.1f, 2, 3};
  const std::int16_t z[] = {-2, 300, 5};
  for (int i = 0; i < 3; ++i) {
    text += put(std::int8_t{1}) + put(std::int16_t{4}) + put(x[i]) + put(y[i]) + put(z[i]) +
            put(std::uint32_t{9});
  }
  text += put(std::uint8_t{1}) + put(std::int32_t{3}) + put(std::uint32_t{2}) +
          put(std::uint32_t{0}) + put(std::uint32_t{1}) + put(std::uint8_t{2}) + put(0.5f) +
          put(0.5f);
  return text + put(std::int32_t{1});
}

inline std::string binary_stl(const std::string& header,
                              const std::vector<std::array<float, 9>>& triangles) {
  std::string text = header + std::string(80 - header.size(), '\0') +
                     bytes_of(static_cast<std::uint32_t>(triangles.size()));
  for (const auto& triangle : triangles) {
    for (int i = 0; i < 3; ++i)
      text += bytes_of(std::numeric_limits<float>::quiet_NaN());  // the normal
    for (const float x : triangle) text += bytes_of(x);
    text += "ab";
  }
  return text;
}

inline const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n "
    "endloop\nendfacet\n";

}  // namespace farcull
