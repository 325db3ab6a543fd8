// Meshes compressed by gzip, and files of formats that are not read.
#include "experiments/scenes/mesh/text.h"

#include "experiments/scenes/scene_file.h"
#include "tests/lab/gzip.h"
#include "tests/lab/meshes.h"

namespace farcull {
namespace {

using lab::gzipped;

bool same(const Mesh& a, const Mesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles && a.source_face == b.source_face &&
         a.group == b.group && a.group_names == b.group_names;
}

const std::string kObj = kThree + "g first part\nf 1 2 3\nv 0 0 1\nf 1 2 4\n";
const std::string kStlText = "solid s\n" + kFacet + "endsolid s\n";

struct Sample {
  const char* name;
  MeshFormat format;
  std::string text;
};

std::vector<Sample> samples() {
  return {{"m.obj", MeshFormat::kObj, kObj},
          {"m.off", MeshFormat::kOff, kOff + "3 0 1 2\n3 0 2 3\n"},
          {"m.ply", MeshFormat::kPly, kPlyHeader + kPlyVertices + "4 0 1 2 3\n"},
          {"b.ply", MeshFormat::kPly, binary_ply(true)},
          {"m.stl", MeshFormat::kStl, kStlText},
          {"b.stl", MeshFormat::kStl, binary_stl("b", {{0, 0, 0, 1, 0, 0, 0, 1, 0}})}};
}

TEST(GzipMesh, IsReadByNameAndByContentsInEveryFormat) {
  const ScratchFolder folder;
  for (const Sample& sample : samples()) {
    const Mesh plain = parse_mesh(sample.text, sample.format, sample.name);
    for (const int level : {0, 1, 9}) {
      const std::string bytes = gzipped(sample.text, level);
      EXPECT_TRUE(same(parse_mesh(bytes, sample.format, sample.name), plain)) << sample.name;
      const std::string name = std::string(sample.name) + ".gz";
      EXPECT_EQ(mesh_format(name), sample.format);
      EXPECT_TRUE(has_mesh_extension(name));
      EXPECT_TRUE(same(load_mesh(folder.write(name, bytes)), plain)) << name;
      // The contents decide, not the name.
      EXPECT_TRUE(same(load_mesh(folder.write(sample.name, bytes)), plain)) << sample.name;
    }
  }
  EXPECT_EQ(mesh_format("A.OBJ.GZ"), MeshFormat::kObj);
}

TEST(GzipMesh, RefusesEveryPrefix) {
  const ScratchFolder folder;
  for (const Sample& sample : samples()) {
    const std::string bytes = gzipped(sample.text);
    for (std::size_t size = 3; size < bytes.size(); ++size) {
      const Error error =
          error_of([&] { parse_mesh(bytes.substr(0, size), sample.format, sample.name); });
      EXPECT_TRUE(has_text(error.reason, "end too early")) << size << error.what();
      EXPECT_TRUE(has_text(error.remedy, "whole file"));
    }
  }
}

// The text is stored as it is, so that a changed digit leaves a mesh, though another one: the twin
// reads it. The checksum alone notices.
TEST(GzipMesh, RefusesAChangedDigitThatWouldBeAMesh) {
  std::string bytes = gzipped(kObj, 0);
  const std::size_t at = bytes.find("v 1 0 0");
  ASSERT_NE(at, std::string::npos);
  bytes[at + 2] = '9';
  EXPECT_EQ(obj(replaced(kObj, "v 1 0 0", "v 9 0 0")).vertices[1].x(), 9);
  expect_error(error_of([&] { obj(bytes); }), "m.obj", 0, "damaged");
}

TEST(GzipMesh, JoinsMembersAndRefusesWhatIsNone) {
  const std::string first = gzipped(kThree), second = gzipped("f 1 2 3\n");
  EXPECT_TRUE(same(obj(first + second), obj(kThree + "f 1 2 3\n")));
  EXPECT_TRUE(same(obj(first + second + std::string(512, '\0')), obj(kThree + "f 1 2 3\n")));
  expect_error(error_of([&] { obj(first + second + "f 1 2 3\n"); }), "m.obj", 0, "follow");
  expect_error(error_of([&] { obj(first + second.substr(0, 9)); }), "m.obj", 0, "end too early");
}

TEST(GzipMesh, RefusesABombBeforeItFillsTheMemory) {
  const std::string text(1 << 20, '\n');
  const std::string bomb = gzipped(text);
  ASSERT_LT(bomb.size() * 500, text.size());
  const GzipLimits limits = {.max_bytes = 1 << 30, .free_bytes = 1 << 16, .most_ratio = 100};
  const Error error = error_of([&] { gunzip(bomb, "b.obj.gz", limits); });
  expect_error(error, "b.obj.gz", 0, "more than 100 times");
  EXPECT_TRUE(has_text(error.remedy, "gzip -d"));
  // Each limit alone lets it pass, and so do contents that are not compressed so far.
  EXPECT_EQ(gunzip(bomb, "b", {.max_bytes = 1 << 30, .free_bytes = 1 << 20, .most_ratio = 100}),
            text);
  EXPECT_EQ(gunzip(bomb, "b", {.max_bytes = 1 << 30, .free_bytes = 1 << 16, .most_ratio = 2000}),
            text);
  EXPECT_EQ(gunzip(gzipped(text, 0), "b", limits), text);
  expect_error(
      error_of([&] { gunzip(bomb, "b", {.max_bytes = (1 << 20) - 1, .free_bytes = 1 << 30}); }),
      "b", 0, "more than 1048575 bytes");
}

TEST(GzipMesh, IsNoStlFileWhoseHeaderBeginsLikeGzip) {
  const std::string bytes = binary_stl("\x1f\x8b\x08", {{0, 0, 0, 1, 0, 0, 0, 1, 0}});
  ASSERT_TRUE(is_gzip(bytes));
  EXPECT_EQ(stl(bytes).triangles.size(), 1u);
  EXPECT_THROW(stl(bytes + "x"), Error);
}

TEST(ForeignMesh, IsNamedByItsExtensionWithWhatConvertsIt) {
  struct Case {
    const char *path, *remedy;
  };
  for (const auto& [path, remedy] :
       {Case{"d/a b.GLB", "assimp"}, Case{"a.vtu", "meshio"}, Case{"a.stp", "gmsh"},
        Case{"a.stp.gz", "gmsh"}, Case{"a.blend", "Blender"}, Case{"a.obj.xz", "unpack"},
        Case{"a.FCStd", "export"}, Case{"a.urdf", "name the meshes"}}) {
    const Error error = error_of([&] { mesh_format(path); });
    expect_error(error, path, 0, "OBJ, OFF, PLY and STL are read");
    EXPECT_TRUE(has_text(error.remedy, remedy));
    // One argument alone could be a built-in scene as well.
    EXPECT_STREQ(error_of([&] { load_scene({path}); }).what(), error.what());
  }
  EXPECT_FALSE(foreign_mesh("a.obj"));
  EXPECT_FALSE(foreign_mesh("a.xyz"));
}

}  // namespace
}  // namespace farcull
