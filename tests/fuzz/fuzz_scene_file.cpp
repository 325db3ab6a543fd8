// Scene files. FARCULL_FUZZ_MESHES is the folder that they stand in.
#include <set>

#include "experiments/scenes/mesh/text.h"
#include "experiments/scenes/scene_file.h"
#include "tests/fuzz/target.h"

namespace farcull {
namespace {

// What a scene takes grows with its objects times the size of their meshes: a text may name the
// same file again and again. The meshes here have at most 8 vertices and 4 triangles in 3 parts,
// and an object takes at least 16 bytes of text ({"mesh":"t.off"},). Per object, in vectors that
// grow by doubling and, while they do, hold 3 times as much: vertices 8 * 24, triangles 4 * 12,
// faces 4 * 4, parts 3 * 40; and 3 names in a table, 96 each. That is 3 * 376 + 288 = 1416 bytes,
// 89 a byte of text; the largest single one is 2 * 192 / 16 = 24 a byte. The JSON of the text
// itself takes at most 48 a byte: nested objects 45 while the syntax is read ({"":, 5 bytes with
// the bracket that closes it, take a set of keys, 48 tripled, and a key, 80). Its largest single
// allocation, 96 / 4, is 24 a byte as well. A path of "a/a/a/" takes, in std::filesystem, 48 for
// each part of 2 bytes, in a list that grows by half, 36 a byte; three of them stand beside each
// other while a file is looked for, one of them growing: 24 + 36 + 60 = 120.
constexpr AllocationLimits kLimits = {
    .once_per_byte = 40, .all_per_byte = 160, .constant = 32 << 10};

void check_scene(const Scene& scene) {
  validate(scene, "fuzz");  // an Error from here is a finding: it passes through as one
  require(!scene.objects.empty(), "a scene without objects");
  require(clean_name(scene.name) == scene.name, "a name that is not clean");
  std::set<std::string_view> names;
  for (const Object& object : scene.objects) {
    require(clean_name(object.name) == object.name, "an object name that is not clean");
    require(names.insert(object.name).second, "two objects of one name");
    require(object.triangle_count > 0, "an object without triangles");
  }
}

}  // namespace

Answer fuzz_scene_file(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string path = std::string(FARCULL_FUZZ_MESHES) + "/scene.json";
  const auto scene = answer_of(kLimits, size, [&] { return parse_scene_file(text, path); });
  if (!scene) return Answer::refused;
  check_scene(*scene);
  require(scene_hash(*scene) == scene_hash(parse_scene_file(text, path)), "two scenes of one text");
  return Answer::accepted;
}

}  // namespace farcull
