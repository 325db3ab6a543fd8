// STL, ASCII and binary. A binary file may begin with "solid" too, so its length decides first,
// then its contents.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "core/base/error.h"
#include "experiments/scenes/mesh/builder.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 of anything, then the number of triangles
constexpr std::size_t kTriangleBytes =
    50;  // normal and corners as 12 floats, then 2 bytes of anything

// Vertices by exact position. Adding 0.0 makes -0.0 the same key as 0.0.
class Welder {
 public:
  explicit Welder(MeshBuilder& mesh) : mesh_(mesh) {}

  std::uint32_t vertex(const Vec3& p, long line) {
    const Key key{std::bit_cast<std::uint64_t>(p.x() + 0.0),
                  std::bit_cast<std::uint64_t>(p.y() + 0.0),
                  std::bit_cast<std::uint64_t>(p.z() + 0.0)};
    const auto [entry, is_new] =
        index_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertex_count()));
    if (is_new) mesh_.add_vertex(p, line);
    return entry->second;
  }

 private:
  using Key = std::array<std::uint64_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t hash = 0;
      for (const std::uint64_t word : key) {
        // The high bits of a double vary most; the multiplier is 2^64 over the golden ratio.
        hash = (std::rotl(hash, 21) ^ word) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
      }
      return hash;
    }
  };
  MeshBuilder& mesh_;
  std::unordered_map<Key, std::uint32_t, Hash> index_;
};

std::uint32_t little_word(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  }
  return word;
}

bool is_text(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  const std::size_t start = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  if (lower_case(bytes.substr(start, 5)) != "solid") return false;
  // No text has NUL bytes; a binary file has them in the padding of its header or in its attribute
  // bytes.
  return bytes.substr(0, 4096).find('\0') == std::string_view::npos;
}

Mesh parse_binary(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kHeaderBytes) {
    throw Error(
        name,
        fmt::format(
            "neither ASCII STL (no 'solid') nor binary STL ({} bytes are less than its header)",
            bytes.size()),
        "give an STL file, whole");
  }
  const std::uint64_t triangles = little_word(bytes, 80);
  if (!is_binary_stl(bytes)) {
    throw Error(
        name,
        fmt::format("the header promises {} triangles, {} bytes in all, but the file has {} bytes",
                    triangles, kHeaderBytes + triangles * kTriangleBytes, bytes.size()),
        "get the whole file, or write it again");
  }
  MeshBuilder mesh(name);
  Welder welder(mesh);
  for (std::uint64_t t = 0; t < triangles; ++t) {
    std::array<std::uint32_t, 3> corners;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Vec3 p;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t at = kHeaderBytes + t * kTriangleBytes + 12 * (corner + 1) + 4 * i;
        p[static_cast<int>(i)] = std::bit_cast<float>(little_word(bytes, at));
      }
      if (!p.allFinite()) {
        throw Error(name, fmt::format("triangle {} has a coordinate that is not finite", t),
                    "correct the mesh where it was made");
      }
      corners[corner] = welder.vertex(p, 0);
    }
    mesh.add_face(corners, 0);
  }
  return mesh.finish();
}

// Moves to the next line and checks its first words; false at the end of the file.
void expect(TextReader& in, std::string_view words) {
  const std::string remedy = "see whether the file is an STL file and whole";
  if (!in.next_line())
    in.fail(fmt::format("the file ends where '{}' should follow", words), remedy);
  for (std::size_t start = 0; start < words.size();) {
    const std::size_t end = std::min(words.find(' ', start), words.size());
    const std::string_view word = in.token();
    if (lower_case(word) != words.substr(start, end - start)) {
      in.fail(fmt::format("'{}' should stand here, not {}", words, quote_token(word)), remedy);
    }
    start = end + 1;
  }
}

Mesh parse_text(std::string_view bytes, const std::string& name) {
  TextReader in(bytes, name, {});
  MeshBuilder mesh(name);
  Welder welder(mesh);
  bool inside = false;
  std::vector<std::uint32_t> corners;
  while (in.next_line()) {
    const std::string word = lower_case(in.token());
    if (!inside && word == "solid") {
      inside = true;
    } else if (inside && word == "endsolid") {
      inside = false;
    } else if (inside && word == "facet") {
      expect(in, "outer loop");
      corners.clear();
      for (;;) {
        if (!in.next_line()) in.fail("the file ends within a facet", "get the whole file");
        const std::string_view token = in.token();
        if (lower_case(token) == "endloop") break;
        if (lower_case(token) != "vertex") {
          in.fail("'vertex' or 'endloop' should stand here, not " + quote_token(token),
                  "see whether the file is an STL file and whole");
        }
        if (corners.size() == 3) in.fail("a facet with a fourth vertex", "triangulate the mesh");
        const Vec3 p = in.point();
        corners.push_back(welder.vertex(p, in.line()));
      }
      mesh.add_face(corners, in.line());
      expect(in, "endfacet");
    } else {
      in.fail(fmt::format("'{}' should stand here, not {}", inside ? "facet or endsolid" : "solid",
                          quote_token(word)),
              "see whether the file is an STL file and whole");
    }
  }
  if (inside) in.fail("the file ends before 'endsolid'", "get the whole file");
  return mesh.finish();
}

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= kHeaderBytes &&
         bytes.size() - kHeaderBytes == std::uint64_t{little_word(bytes, 80)} * kTriangleBytes;
}

Mesh parse_stl(std::string_view bytes, const std::string& name) {
  if (!is_binary_stl(bytes) && is_text(bytes)) return parse_text(bytes, name);
  return parse_binary(bytes, name);
}

}  // namespace farcull
