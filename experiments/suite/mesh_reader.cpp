// The folder of a mesh: mesh.txt, an OBJ for each object, and pairs.csv.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/suite/reader.h"
#include "experiments/suite/words.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "docs/suite.md has the format; write the suite again";
constexpr std::uint64_t kAnyBytes = std::numeric_limits<std::uint64_t>::max();

void read_properties(const std::string& path, SuiteMesh& mesh) {
  const std::string text = read_file(path, kAnyBytes);
  Lines lines(text, path);
  std::string_view line;
  const auto value = [&](std::string_view key) {
    if (!lines.next(line) || take_word(line) != key)
      lines.fail(fmt::format("the line does not begin with '{}'", key), kFormat);
    const std::string_view word = take_word(line);
    if (word.empty() || !take_word(line).empty())
      lines.fail(fmt::format("there is not one word after '{}'", key), kFormat);
    return word;
  };
  const std::string_view self = value("self");
  if (self != "yes" && self != "no")
    lines.fail(quote_token(self) + " is neither yes nor no", kFormat);
  mesh.self = self == "yes";
  const std::string_view parameter = value("parameter");
  const std::optional<double> number = parse_number<double>(parameter);
  if (!number) lines.fail(quote_token(parameter) + " is no number", kFormat);
  mesh.parameter = *number;
  mesh.family = value("family");
  if (lines.next(line)) lines.fail("there are more lines than three", kFormat);
}

/// 0.obj, 1.obj and so on.
Scene read_objects(const std::string& folder, const SuiteMesh& mesh) {
  SceneBuilder builder(mesh.name, folder);
  for (int i = 0;; ++i) {
    const std::string path = fmt::format("{}/{}.obj", folder, i);
    if (i > 0 && !fs::exists(path)) return builder.finish();
    const Mesh object = load_mesh(path);
    for (std::size_t t = 0; t < object.triangles.size(); ++t) {
      if (object.source_face[t] != t)
        throw Error(path, fmt::format("face {} is no triangle", object.source_face[t]), kFormat);
    }
    builder.add(object, std::to_string(i), Split::kNone, {}, mesh.self);
  }
}

/// A row of pairs.csv.
SuiteMeshPair parse_row(const Lines& lines, std::string_view line, const SuiteMesh& mesh) {
  std::array<std::uint32_t, 5> cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string_view cell = line.substr(0, line.find(','));
    const std::optional<std::uint32_t> value = parse_number<std::uint32_t>(cell);
    if (!value || (i < 4) != (cell.size() < line.size()))
      lines.fail("the line is not five whole numbers with commas between them", kFormat);
    cells[i] = *value;
    line.remove_prefix(std::min(line.size(), cell.size() + 1));
  }
  const auto triangle = [&](std::uint32_t object, std::uint32_t row) {
    if (object >= mesh.scene.objects.size() || row >= mesh.scene.objects[object].triangle_count)
      lines.fail(fmt::format("object {} has no triangle {}", object, row), kFormat);
    return mesh.scene.objects[object].first_triangle + row;
  };
  const SuiteMeshPair out{{triangle(cells[0], cells[1]), triangle(cells[2], cells[3])}, cells[4]};
  if (out.pair.a >= out.pair.b) lines.fail("the first triangle is not before the second", kFormat);
  const bool one_object = cells[0] == cells[2];
  if (one_object && !mesh.self)
    lines.fail("the triangles are of one object, which is not tested against itself", kFormat);
  const std::uint32_t shared = one_object ? shared_vertices(mesh.scene, out.pair) : 0;
  if (out.shared != shared) {
    lines.fail(fmt::format("the triangles share {} vertices, not {}", shared, out.shared), kFormat);
  }
  return out;
}

void read_colliding(const std::string& path, SuiteMesh& mesh) {
  const std::string text = read_file(path, kAnyBytes);
  Lines lines(text, path);
  std::string_view line;
  lines.next(line);
  if (line != "object_a,triangle_a,object_b,triangle_b,shared")
    lines.fail("the first line is not object_a,triangle_a,object_b,triangle_b,shared", kFormat);
  while (lines.next(line)) {
    const SuiteMeshPair row = parse_row(lines, line, mesh);
    if (!mesh.pairs.empty() && !(mesh.pairs.back().pair < row.pair))
      lines.fail("the pairs do not ascend", kFormat);
    mesh.pairs.push_back(row);
  }
}

}  // namespace

std::uint32_t shared_vertices(const Scene& scene, const TrianglePair& pair) {
  const std::array<std::uint32_t, 3>& a = scene.triangles[pair.a];
  const std::array<std::uint32_t, 3>& b = scene.triangles[pair.b];
  std::uint32_t out = 0;
  for (int i = 0; i < 3; ++i) {
    const bool repeated = std::find(a.begin(), a.begin() + i, a[i]) != a.begin() + i;
    out += !repeated && std::find(b.begin(), b.end(), a[i]) != b.end();
  }
  return out;
}

SuiteMesh read_mesh(const std::string& folder) {
  SuiteMesh out;
  const fs::path path(folder);
  out.name = (path.has_filename() ? path : path.parent_path()).filename().string();
  read_properties(folder + "/mesh.txt", out);
  out.scene = read_objects(folder, out);
  out.labelled = fs::exists(folder + "/pairs.csv");
  if (out.labelled) read_colliding(folder + "/pairs.csv", out);
  return out;
}

}  // namespace farcull
