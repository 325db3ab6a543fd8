// The mesh readers.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/text.h"
#include "tests/fuzz/target.h"
#include "tests/lab/gzip.h"

namespace farcull {
namespace {

// The worst file is PLY whose polygon has n corners of 1 byte each. Per byte it takes, in vectors
// that grow by doubling: a corner (4, doubled), the point (24), the normalized point (24), the
// projected one (16), the ring (9), the triangle among those of the face (12) and in the mesh (12,
// while it doubles 36), its face and its group (4 each, doubled). The largest of them are 24 a
// byte; alive at once are 8 + 24 + 12 + 36 + 8 + 8 = 96 at most, here 128 for what malloc adds to
// small blocks (a group of OBJ: 5 bytes that take 40 a byte). The constant is for what does not
// grow: messages of errors, which quote 40 characters, and the first steps of every container.
constexpr AllocationLimits kLimits = {
    .once_per_byte = 24, .all_per_byte = 128, .constant = 16 << 10};

constexpr MeshFormat kFormats[] = {MeshFormat::kObj, MeshFormat::kOff, MeshFormat::kPly,
                                   MeshFormat::kStl};

/// A face of n corners is n - 2 triangles joined by n - 3 edges, each of which both neighbours
/// run through, in opposite directions.
void check_faces(const Mesh& mesh) {
  for (std::size_t begin = 0; begin < mesh.triangles.size();) {
    const std::uint32_t face = mesh.source_face[begin];
    require(begin == 0 ? face == 0 : face == mesh.source_face[begin - 1] + 1, "faces out of order");
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::ptrdiff_t> edges;  // lower end first
    std::size_t end = begin;
    for (; end < mesh.triangles.size() && mesh.source_face[end] == face; ++end) {
      require(mesh.group[end] == mesh.group[begin], "a face in two groups");
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = mesh.triangles[end][i];
        const std::uint32_t to = mesh.triangles[end][(i + 1) % 3];
        if (from != to) edges[std::minmax(from, to)] += from < to ? 1 : -1;
      }
    }
    std::size_t outer = 0;
    for (const auto& [edge, excess] : edges) outer += static_cast<std::size_t>(std::abs(excess));
    require(outer <= end - begin + 2, "the triangles of a face do not make one polygon");
    begin = end;
  }
}

void check_mesh(const Mesh& mesh) {
  const std::size_t count = mesh.triangles.size();
  require(count > 0, "a mesh without triangles");
  require(mesh.source_face.size() == count && mesh.group.size() == count, "arrays of other sizes");
  for (std::size_t t = 0; t < count; ++t) {
    for (const std::uint32_t v : mesh.triangles[t])
      require(v < mesh.vertices.size(), "an index out of range");
    require(mesh.group[t] < mesh.group_names.size(), "a group out of range");
  }
  for (const Vec3& p : mesh.vertices) require(p.allFinite(), "a vertex that is not finite");
  std::set<std::string_view> names;
  for (const std::string& name : mesh.group_names) {
    require(!name.empty() && clean_name(name) == name, "a group name that is not clean");
    require(names.insert(name).second, "two groups of one name");
  }
  check_faces(mesh);
  // Nothing is placed, so no scene may be refused; finish() validates it.
  for (const Split split : {Split::kNone, Split::kGroups, Split::kComponents}) {
    SceneBuilder builder("fuzz", "fuzz");
    builder.add(mesh, "mesh", split, {});
    const Scene scene = builder.finish();
    require(scene.triangles.size() == count, "a split that lost triangles");
    for (const Object& object : scene.objects)
      require(object.triangle_count > 0, "a split into an object without triangles");
  }
}

/// What was read, written as OFF and read again, is the same to the bit.
void check_rewritten(const Mesh& mesh) {
  std::string text = fmt::format("OFF {} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  // fmt writes the shortest number that reads back as the same double.
  for (const Vec3& p : mesh.vertices) text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  const Mesh again = parse_mesh(text, MeshFormat::kOff, "rewritten.off");
  require(again.triangles == mesh.triangles, "triangles that change when written and read");
  const auto same = [](const Vec3& p, const Vec3& q) {
    for (int i = 0; i < 3; ++i) {
      if (std::bit_cast<std::uint64_t>(p[i]) != std::bit_cast<std::uint64_t>(q[i])) return false;
    }
    return true;
  };
  require(std::equal(again.vertices.begin(), again.vertices.end(), mesh.vertices.begin(),
                     mesh.vertices.end(), same),
          "vertices that change when written and read");
}

// What comes out of gzip data is a string that grows by doubling, so at most 2 bytes for each byte
// of the text in one block, and 3 while it is copied. Deflate makes at most 1032 bytes of one.
constexpr AllocationLimits kGunzipLimits = {
    .once_per_byte = 2 * 1032, .all_per_byte = 3 * 1032, .constant = 16 << 10};

/// The mesh in words, or the Error.
std::string told(std::string_view bytes, MeshFormat format) {
  try {
    const Mesh mesh = parse_mesh(bytes, format, "fuzz");
    return fmt::format("{} vertices, {} triangles, {} groups", mesh.vertices.size(),
                       mesh.triangles.size(), mesh.group_names.size());
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace

Answer fuzz_mesh(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return Answer::refused;
  const MeshFormat format = kFormats[data[0] & 3];
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::size_t paid = bytes.size();
  if (is_gzip(bytes) && !(format == MeshFormat::kStl && is_binary_stl(bytes))) {
    const auto text = answer_of(kGunzipLimits, bytes.size(), [&] { return gunzip(bytes, "fuzz"); });
    if (!text) return Answer::refused;
    paid += text->size();
  } else if ((data[0] & 4) != 0) {
    require(told(lab::gzipped(bytes, 1), format) == told(bytes, format),
            "another answer where the file is compressed");
  }
  const auto mesh = answer_of(kLimits, paid, [&] { return parse_mesh(bytes, format, "fuzz"); });
  if (!mesh) return Answer::refused;
  check_mesh(*mesh);
  check_rewritten(*mesh);
  return Answer::accepted;
}

}  // namespace farcull
