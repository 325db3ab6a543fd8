// Numbers, files and polygons. mesh_formats_test.cpp has the formats one by one, tests/fuzz damaged
// bytes.
#include "experiments/scenes/mesh/load.h"

#include <sys/stat.h>
#include <unistd.h>

#include "experiments/scenes/mesh/text.h"
#include "tests/lab/meshes.h"

namespace farcull {
namespace {

// ---- numbers and text

TEST(ParseNumber, RoundsOnceToTheNearestDouble) {
  double x = 0;
  ASSERT_EQ(parse_number("0.1", x), Number::kOk);
  EXPECT_EQ(x, 0.1);
  // Between two floats and needing all 17 digits.
  ASSERT_EQ(parse_number("+16777217.000000004", x), Number::kOk);
  EXPECT_EQ(x, 0x1.0000010000001p+24);
  // Halfway cases: ties go to even, and the digit far behind decides.
  ASSERT_EQ(parse_number("9007199254740993", x), Number::kOk);
  EXPECT_EQ(x, 9007199254740992.0);
  ASSERT_EQ(parse_number("9007199254740993.00000000000000000000000000000000001", x), Number::kOk);
  EXPECT_EQ(x, 9007199254740994.0);
  ASSERT_EQ(parse_number("4.9e-324", x), Number::kOk);
  EXPECT_EQ(x, std::numeric_limits<double>::denorm_min());
}

TEST(ParseNumber, UnderflowIsZeroButOverflowIsNot) {
  double x = 1;
  ASSERT_EQ(parse_number("-1e-400", x), Number::kOk);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(x), std::bit_cast<std::uint64_t>(-0.0));
  x = 1;
  ASSERT_EQ(parse_number("0.000001e-99999999999999999999", x), Number::kOk);
  EXPECT_EQ(x, 0);
  EXPECT_EQ(parse_number("1e309", x), Number::kNotFinite);
  EXPECT_EQ(parse_number("0.001e99999999999999999999", x), Number::kNotFinite);
  EXPECT_EQ(parse_number("1" + std::string(400, '0'), x), Number::kNotFinite);
  EXPECT_EQ(parse_number("nan", x), Number::kNotFinite);
  EXPECT_EQ(parse_number("-inf", x), Number::kNotFinite);
}

TEST(ParseNumber, RefusesWhatIsOnlyNearlyANumber) {
  double x = 0;
  for (const char* text : {"", "+", "-", "+-1", "1e", "1.0x", "0x10", "1,5", "--1", ".", "1d5"})
    EXPECT_EQ(parse_number(text, x), Number::kMalformed) << text;
}

TEST(CleanName, KeepsUtf8AndReplacesWhatJsonCannotHold) {
  EXPECT_EQ(clean_name("b\xc3\xa4r \xf0\x9f\x90\x87"), "b\xc3\xa4r \xf0\x9f\x90\x87");
  EXPECT_EQ(clean_name("a\xff"
                       "b\xc0\x80"
                       "c\n"),
            "a?b??c?");
  EXPECT_EQ(clean_name("\xed\xa0\x80"), "???");  // a surrogate
  EXPECT_EQ(clean_name("\xe2\x82"), "??");       // cut off
}

// ---- files

TEST(LoadMesh, NamesTheFormatByExtensionInAnyCase) {
  EXPECT_EQ(mesh_format("a/b.OBJ"), MeshFormat::kObj);
  EXPECT_EQ(mesh_format("b.Off"), MeshFormat::kOff);
  EXPECT_EQ(mesh_format("b.x.ply"), MeshFormat::kPly);
  EXPECT_EQ(mesh_format("b.STL"), MeshFormat::kStl);
  EXPECT_TRUE(has_mesh_extension("b.STL"));
  EXPECT_FALSE(has_mesh_extension("b.gltf"));
  expect_error(error_of([] { mesh_format("b.xyz"); }), "b.xyz", 0, "'.xyz'");
  expect_error(error_of([] { mesh_format("b"); }), "b", 0, "extension");
}

TEST(LoadMesh, RefusesMissingEmptyAndDirectory) {
  const ScratchFolder folder;
  const std::string missing = folder.path("missing.obj");
  expect_error(error_of([&] { load_mesh(missing); }), missing, 0, "does not exist");
  for (const char* name : {"e.obj", "e.off", "e.ply", "e.stl"}) {
    const std::string empty = folder.write(name, "");
    expect_error(error_of([&] { load_mesh(empty); }), empty, 0, "empty");
  }
  const std::string directory = folder.path("d.obj");
  std::filesystem::create_directory(directory);
  expect_error(error_of([&] { load_mesh(directory); }), directory, 0, "directory");
}

TEST(LoadMesh, RefusesDevicesAndPipesThatMayNeverEnd) {
  const ScratchFolder folder;
  const std::string endless = folder.path("z.off");
  std::filesystem::create_symlink("/dev/zero", endless);
  expect_error(error_of([&] { load_mesh(endless); }), endless, 0, "regular");
  const std::string pipe = folder.path("p.off");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expect_error(error_of([&] { load_mesh(pipe); }), pipe, 0, "regular");
}

TEST(LoadMesh, RefusesAFileOfATerabyteWithoutReadingIt) {
  const ScratchFolder folder;
  const std::string path = folder.write("t.off", "OFF\n");
  std::error_code error;
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40, error);
  ASSERT_FALSE(error) << "this folder must hold sparse files: " << error.message();
  expect_error(error_of([&] { load_mesh(path); }), path, 0, "bytes");
}

// ---- polygons (polygon_test.cpp has more)

TEST(Triangulate, ConvexOfAnySizeButConcaveOnlyToItsLimit) {
  const auto wheel = [](std::size_t n, bool notched) {
    std::string text;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979 * static_cast<double>(i) / static_cast<double>(n);
      const double r = notched && i % 2 == 0 ? 0.5 : 1;
      text += "v " + std::to_string(r * std::cos(angle) * 1e9) + " " +
              std::to_string(r * std::sin(angle) * 1e9) + " 0\n";
    }
    text += "f";
    for (std::size_t i = 1; i <= n; ++i) text += " " + std::to_string(i);
    return text;
  };
  EXPECT_EQ(obj(wheel(20000, false)).triangles.size(), 19998u);
  EXPECT_EQ(obj(wheel(2000, true)).triangles.size(), 1998u);
  expect_error(error_of([&] { obj(wheel(20000, true)); }), "m.obj", 20001, "20000 vertices");
}

TEST(MeshReaders, TriangulatePolygonsInPlaceAndKeepTheirFace) {
  const Mesh mesh =
      off("OFF\n5 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n-1 0.5 0\n3 0 1 2\n5 0 1 2 3 4\n3 2 1 0\n");
  EXPECT_EQ(mesh.source_face, (std::vector<std::uint32_t>{0, 1, 1, 1, 2}));
  EXPECT_EQ(mesh.group, (std::vector<std::uint32_t>(5, 0)));
}

TEST(MeshReaders, NameTheFacesThatAreFolded) {
  const std::string corners = "OFF\n4 4 0\n0 0 0\n3 0 0\n3 3 0\n0 2 0\n";
  const Mesh mesh = off(corners + "3 0 1 2\n4 0 2 1 3\n4 0 1 2 3\n4 1 3 0 2\n");
  EXPECT_EQ(mesh.folded, (std::vector<std::uint32_t>{1, 3}));
}

}  // namespace
}  // namespace farcull
