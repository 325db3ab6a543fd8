// The readers of OBJ, OFF, PLY and STL, one after the other.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>

#include "tests/experiments/scenes/mesh/mesh_samples.h"

namespace farcull {
namespace {

// The peak of the process's memory must not move and no time may pass, whatever the header says.
template <class Call>
void expect_cheap(const Call& call) {
  const auto peak_kilobytes = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const long before = peak_kilobytes();
  const auto start = std::chrono::steady_clock::now();
  call();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
  EXPECT_LT(peak_kilobytes() - before, 64 * 1024);
}

// ---- OBJ

TEST(ObjReader, ReadsCornersInEveryForm) {
  const Mesh mesh = obj(kThree + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1 3//1\nf -3 -2/1 -1//1\n");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.source_face, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"default"}));
}

TEST(ObjReader, CountsNegativeIndicesFromTheVerticesSoFar) {
  const Mesh mesh = obj(kThree + "f -1 -2 -3\nv 5 5 5\nf -1 -2 -3\n");
  EXPECT_EQ(mesh.triangles[0], (Triangle{2, 1, 0}));
  EXPECT_EQ(mesh.triangles[1], (Triangle{3, 2, 1}));
}

TEST(ObjReader, RefusesIndexZeroWithItsLine) {
  expect_error(error_of([] { obj(kThree + "f 0 1 2\n"); }), "m.obj", 4, "index 0");
  expect_error(error_of([] { obj(kThree + "# c\n\nf 1 2 0/1\n"); }), "m.obj", 6, "index 0");
}

TEST(ObjReader, RefusesIndexOutOfRangeWithItsLine) {
  expect_error(error_of([] { obj(kThree + "f 1 2 3\nf 1 2 4\n"); }), "m.obj", 5, "'4'");
  expect_error(error_of([] { obj(kThree + "f 1 2 -4\n"); }), "m.obj", 4, "'-4'");
  // 2^32 + 1 must not wrap to 1, nor what no integer holds.
  expect_error(error_of([] { obj(kThree + "f 1 2 4294967297\n"); }), "m.obj", 4, "4294967297");
  expect_error(error_of([] { obj(kThree + "f 1 2 99999999999999999999\n"); }), "m.obj", 4, "9999");
}

TEST(ObjReader, RefusesCornersThatAreNoIndices) {
  for (const char* corner : {"x", "1.5", "1/x", "/1", "1e0", "+-1", "--1", "+", "-"}) {
    const std::string text = kThree + "f 1 2 " + corner + "\n";
    expect_error(error_of([&] { obj(text); }), "m.obj", 4, "corner");
  }
}

TEST(ObjReader, RefusesPolygonOfTwoVerticesWithItsLine) {
  expect_error(error_of([] { obj(kThree + "f 1 2\n"); }), "m.obj", 4, "polygon with 2 vertices");
  expect_error(error_of([] { obj(kThree + "f\n"); }), "m.obj", 4, "polygon with 0 vertices");
}

TEST(ObjReader, RefusesCoordinatesThatAreNotFiniteOrMissing) {
  expect_error(error_of([] { obj("v 0 0 nan\n"); }), "m.obj", 1, "z is 'nan'");
  expect_error(error_of([] { obj("v 0 0 0\nv inf 0 0\n"); }), "m.obj", 2, "x is 'inf'");
  expect_error(error_of([] { obj("v 0 1e999 0\n"); }), "m.obj", 1, "y is '1e999'");
  expect_error(error_of([] { obj("v 0 0\n"); }), "m.obj", 1, "z is missing");
  expect_error(error_of([] { obj("v 0 0 zero\n"); }), "m.obj", 1, "not a number");
}

TEST(ObjReader, IgnoresWeightsAndColours) {
  const Mesh mesh = obj("v 1 2 3 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 # corner\nf 1 2 3\n");
  EXPECT_EQ(mesh.vertices[0], Vec3(1, 2, 3));
  EXPECT_EQ(mesh.vertices.size(), 3u);
}

TEST(ObjReader, JoinsContinuedLinesAndStillCountsThem) {
  const std::string text = "v 0 0 \\\n0\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 \\\r\n  3\r\n";
  EXPECT_EQ(obj(text).triangles[0], (Triangle{0, 1, 2}));
  expect_error(error_of([&] { obj(text + "f 1 2 9\n"); }), "m.obj", 7, "'9'");
  // A statement that is passed over is passed over to its end, and a comment is not continued.
  EXPECT_EQ(obj(kThree + "usemtl a\\\nf 9 9 9\nf 1 2 3\n").triangles.size(), 1u);
  EXPECT_EQ(obj(kThree + "vn 0 0 1 # c \\\nf 1 2 3\n").triangles.size(), 1u);
  EXPECT_EQ(obj(kThree + "# c \\\nf 1 2 3\n").triangles.size(), 1u);
}

TEST(ObjReader, GroupsFacesByTheLastOfObjectAndGroup) {
  const Mesh mesh =
      obj(kThree + "f 1 2 3\no arm\nf 1 2 3\ng left hand\nf 1 2 3\no arm\nf 1 2 3\ng\nf 1 2 3\n");
  EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"default", "arm", "left hand"}));
  EXPECT_EQ(mesh.group, (std::vector<std::uint32_t>{0, 1, 2, 1, 0}));
}

TEST(ObjReader, IgnoresPointsLinesAndMaterials) {
  EXPECT_EQ(
      obj("mtllib a.mtl\n" + kThree + "p 1\nl 1 2\ns off\nusemtl m\nf 1 2 3").triangles.size(), 1u);
}

TEST(ObjReader, RefusesFreeFormGeometryRatherThanLosingIt) {
  expect_error(error_of([] { obj(kThree + "f 1 2 3\nsurf 0 1 0 1 1 2 3 4\n"); }), "m.obj", 5,
               "surf");
}

TEST(ObjReader, RefusesBinaryGarbageWithoutPrintingIt) {
  const Error error = error_of([] {
    obj(
        std::string("\x7f"
                    "ELF\x02\0\0\xff",
                    8));
  });
  expect_error(error, "m.obj", 1, "'\\x7fELF\\x02\\x00\\x00\\xff'");
}

TEST(ObjReader, RefusesAMeshWithoutTriangles) {
  expect_error(error_of([] { obj(kThree); }), "m.obj", 0, "no triangles");
  expect_error(error_of([] { obj("\n# nothing\n"); }), "m.obj", 0, "no triangles");
}

TEST(ObjReader, PassesOverAByteOrderMark) {
  EXPECT_EQ(obj("\xef\xbb\xbf" + kThree + "f 1 2 3\n").triangles.size(), 1u);
}

TEST(ObjReader, KeepsDegenerateTrianglesAndUnusedVertices) {
  const Mesh mesh = obj(kThree + "v 9 9 9\nf 1 1 2\nf 3 3 3\n");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 4u);
}

// ---- OFF

TEST(OffReader, ReadsCommentsColoursAndCountsOnTheHeaderLine) {
  const Mesh mesh = off(kOff + "3 0 1 2 255 0 0\n3  0 2 3\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(off("OFF 3 1\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2").triangles.size(), 1u);
}

TEST(OffReader, PassesOverDeclaredVertexAttributes) {
  for (const char* header : {"COFF", "NOFF", "CNOFF", "STOFF", "STCNOFF"}) {
    const Mesh mesh =
        off(std::string(header) + "\n3 1 0\n0 0 0 9 9 9\n1 0 0 9 9 9 9\n0 1 0 1\n3 0 1 2\n");
    EXPECT_EQ(mesh.vertices[2], Vec3(0, 1, 0)) << header;
  }
}

TEST(OffReader, RefusesVariantsByName) {
  for (const char* header : {"4OFF", "nOFF", "4nOFF", "OFF BINARY", "ST4OFF"}) {
    const std::string text = std::string(header) + "\n3 1 0\n0 0 0 0\n1 0 0 0\n0 1 0 0\n3 0 1 2\n";
    expect_error(error_of([&] { off(text); }), "m.off", 1, std::string("'") + header + "'");
  }
  expect_error(error_of([] { off("3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"); }), "m.off", 1,
               "header");
}

TEST(OffReader, RefusesUndeclaredVertexAttributes) {
  expect_error(error_of([] { off("OFF\n3 1 0\n0 0 0 1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"); }), "m.off",
               3, "more than three");
}

TEST(OffReader, RefusesBadIndicesWithTheirLine) {
  expect_error(error_of([] { off(kOff + "3 0 1 2\n3 0 1 4\n"); }), "m.off", 10, "index 4");
  expect_error(error_of([] { off(kOff + "3 0 1 -1\n3 0 1 2\n"); }), "m.off", 9, "index -1");
  expect_error(error_of([] { off(kOff + "3 0 1 4294967296\n3 0 1 2\n"); }), "m.off", 9,
               "4294967296");
  expect_error(error_of([] { off(kOff + "4 0 1 2\n3 0 1 2\n"); }), "m.off", 9, "missing");
}

TEST(OffReader, RefusesPolygonOfTwoVerticesWithItsLine) {
  expect_error(error_of([] { off(kOff + "3 0 1 2\n2 0 1\n     \n"); }), "m.off", 10,
               "polygon with 2 vertices");
  expect_error(error_of([] { off(kOff + "-3 0 1 2\n2 0 1\n"); }), "m.off", 9, "-3");
}

TEST(OffReader, RefusesTruncatedAndOverlongFiles) {
  expect_error(error_of([] { off(kOff + "3 0 1 2    \n      "); }), "m.off", 10, "1 of 2 faces");
  expect_error(error_of([] { off("OFF\n2 1 0\n0 0 0                      "); }), "m.off", 3,
               "1 of 2 vertices");
  expect_error(error_of([] { off("OFF"); }), "m.off", 1, "counts");
  expect_error(error_of([] { off("OFF\n3                   "); }), "m.off", 2, "faces is missing");
  expect_error(error_of([] { off(kOff + "3 0 1 2\n3 0 2 3\n3 0 1 3\n"); }), "m.off", 11,
               "more follows");
}

TEST(OffReader, RefusesCoordinatesThatAreNotFinite) {
  expect_error(error_of([] { off("OFF\n1 0 0\n0 nan 0\n"); }), "m.off", 3, "y is 'nan'");
  expect_error(error_of([] { off("OFF\n1 0 0\n0 0 -1e309\n"); }), "m.off", 3, "z is '-1e309'");
}

TEST(OffReader, RefusesABillionVerticesBeforeAllocatingThem) {
  expect_cheap([] {
    expect_error(error_of([] { off("OFF\n1000000000 1 0\n0 0 0\n"); }), "m.off", 2,
                 "promises 1000000000");
    expect_error(error_of([] { off("OFF\n1 1000000000 0\n0 0 0\n"); }), "m.off", 2,
                 "promises 1000000000");
    expect_error(error_of([] { off("OFF\n9223372036854775807 9223372036854775807 0\n"); }), "m.off",
                 2, "promises");
    expect_error(error_of([] { off("OFF\n99999999999999999999 1 0\n"); }), "m.off", 2, "beyond");
    expect_error(error_of([] { off("OFF\n-1 1 0\n"); }), "m.off", 2, "-1");
    // Either count would fit alone.
    expect_error(error_of([] { off("OFF\n5 5 0\n" + std::string(45, ' ')); }), "m.off", 2,
                 "promises 5 vertices and 5 faces");
    expect_error(error_of([] { off(kOff + "1000000000 0 1 2 3\n"); }), "m.off", 9, "missing");
  });
}

// ---- PLY

TEST(PlyReader, ReadsAsciiAndTriangulates) {
  const Mesh mesh = ply(kPlyHeader + kPlyVertices + "4 0 1 2 3\n");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.source_face, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(mesh.vertices[2], Vec3(1, 1, 0));
}

TEST(PlyReader, NeverRoundsAsciiThroughFloatWhateverTheTypeSays) {
  const Mesh mesh = ply(kPlyHeader + "0 0 0.1\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(mesh.vertices[0].z(), 0.1);
}

TEST(PlyReader, ReadsBothByteOrdersBitForBit) {
  for (const bool big : {false, true}) {
    const Mesh mesh = ply(binary_ply(big));
    ASSERT_EQ(mesh.vertices.size(), 3u);
    EXPECT_EQ(mesh.vertices[0], Vec3(0.1, static_cast<double>(0.1f), -2));
    EXPECT_EQ(mesh.vertices[1], Vec3(1e300, 2, 300));
    EXPECT_TRUE(std::signbit(mesh.vertices[2].x()));
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{2, 0, 1}}));
  }
}

TEST(PlyReader, RefusesEveryTruncationOfABinaryFile) {
  const std::string whole = binary_ply(false);
  for (std::size_t size = 1; size < whole.size(); ++size) {
    const Error error = error_of([&] { ply(whole.substr(0, size)); });
    EXPECT_EQ(error.where, "m.ply") << size;
  }
}

TEST(PlyReader, TakesFacesBeforeVertices) {
  const Mesh mesh =
      ply("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
          "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
          "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST(PlyReader, RefusesABillionElementsBeforeAllocatingThem) {
  expect_cheap([] {
    const std::string vertices = replaced(kPlyHeader, "vertex 4", "vertex 1000000000");
    expect_error(error_of([&] { ply(vertices + kPlyVertices); }), "m.ply", 4,
                 "promises 1000000000");
    const std::string faces = replaced(kPlyHeader, "face 1", "face 1000000000");
    expect_error(error_of([&] { ply(faces + kPlyVertices); }), "m.ply", 8, "promises 1000000000");
    const std::string list = replaced(kPlyHeader, "uchar int", "uint int");
    expect_error(error_of([&] { ply(list + kPlyVertices + "4000000000 0 1 2\n"); }), "m.ply", 15,
                 "list of 4000000000");
    const std::string binary = replaced(vertices, "ascii", "binary_little_endian");
    expect_error(error_of([&] { ply(binary + kPlyVertices); }), "m.ply", 4, "promises 1000000000");
  });
}

TEST(PlyReader, RefusesCoordinatesThatAreNotFinite) {
  expect_error(error_of([] { ply(kPlyHeader + "0 0 0\n1 nan 0\n1 1 0\n0 1 0\n3 0 1 2\n"); }),
               "m.ply", 12, "y is 'nan'");
  const std::string binary =
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const double infinity = std::numeric_limits<double>::infinity();
  const std::string body = bytes_of(0.0f, true) + bytes_of(0.0f, true) + bytes_of(infinity, true) +
                           bytes_of(std::uint8_t{3}, true) + std::string(12, '\0');
  expect_error(error_of([&] { ply(binary + body); }), "m.ply", 0, "z of a vertex is not finite");
}

TEST(PlyReader, RefusesBadFacesWithTheirLine) {
  const std::string start = kPlyHeader + kPlyVertices;
  expect_error(error_of([&] { ply(start + "3 0 1 4\n"); }), "m.ply", 15, "vertex 4");
  expect_error(error_of([&] { ply(start + "3 0 1 -1\n"); }), "m.ply", 15, "vertex -1");
  expect_error(error_of([&] { ply(start + "3 0 1 4294967296\n"); }), "m.ply", 15, "4294967296");
  expect_error(error_of([&] { ply(start + "2 0 1\n"); }), "m.ply", 15, "polygon with 2 vertices");
  expect_error(error_of([&] { ply(start + "-1 0 1\n"); }), "m.ply", 15, "-1");
  expect_error(error_of([&] { ply(start + "3 0 1 2 3\n"); }), "m.ply", 15, "more values");
  expect_error(error_of([&] { ply(start + "3 0 1\n"); }), "m.ply", 15, "missing");
}

TEST(PlyReader, RefusesTruncatedAndOverlongAscii) {
  const std::string wide = replaced(kPlyHeader, "element face 1", "element face 2");
  expect_error(error_of([&] { ply(wide + kPlyVertices + "3 0 1 2      "); }), "m.ply", 15,
               "ends before");
  expect_error(error_of([] { ply(kPlyHeader + kPlyVertices + "3 0 1 2\n3 0 1 2\n"); }), "m.ply", 16,
               "more follows");
}

TEST(PlyReader, RefusesBadHeadersWithTheirLine) {
  const auto bad = [](const std::string& from, const std::string& to) {
    return error_of([&] { ply(replaced(kPlyHeader, from, to) + kPlyVertices + "3 0 1 2\n"); });
  };
  expect_error(bad("ply", "plx"), "m.ply", 1, "'ply'");
  expect_error(bad("ascii", "utf8"), "m.ply", 2, "'utf8'");
  expect_error(bad("1.0", "2.0"), "m.ply", 2, "'2.0'");
  expect_error(bad("format ascii 1.0\n", ""), "m.ply", 9, "no format");
  expect_error(bad("vertex 4", "vertex four"), "m.ply", 4, "'four'");
  expect_error(bad("vertex 4", "vertex -4"), "m.ply", 4, "-4");
  expect_error(bad("double x", "quad x"), "m.ply", 5, "'quad'");
  expect_error(bad("property double x", "property double"), "m.ply", 5, "without a name");
  expect_error(bad("double x", "double u"), "m.ply", 4, "'x'");
  expect_error(bad("double y", "double x"), "m.ply", 4, "2 scalar properties named 'x'");
  expect_error(bad("uchar int", "float int"), "m.ply", 9, "length");
  expect_error(bad("uchar int", "uchar float"), "m.ply", 8, "floating-point");
  expect_error(bad("vertex_indices", "corners"), "m.ply", 8, "0 lists");
  expect_error(bad("element face 1", "element vertex 1"), "m.ply", 8, "second element");
  expect_error(bad("element face 1", "element strip 1"), "m.ply", 0, "no element 'face'");
  expect_error(bad("end_header", "end_head"), "m.ply", 10, "'end_head'");
  expect_error(error_of([] { ply("ply\nformat ascii 1.0\n"); }), "m.ply", 3, "within its header");
}

// ---- STL

TEST(StlReader, WeldsByExactPositionAndNoFurther) {
  const float next = std::nextafter(1.0f, 2.0f);
  const Mesh mesh =
      stl(binary_stl("b", {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {-0.0f, 0, 0, 0, 1, 0, next, 0, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh.vertices[3].x(), static_cast<double>(next));
  EXPECT_FALSE(std::signbit(mesh.vertices[0].x()));
}

TEST(StlReader, ReadsBinaryThatBeginsWithSolid) {
  EXPECT_EQ(stl(binary_stl("solid of a kind", {{0, 0, 0, 1, 0, 0, 0, 1, 0}})).triangles.size(), 1u);
}

TEST(StlReader, ReadsAsciiInAnyCaseWithSeveralSolids) {
  const Mesh mesh = stl("solid a\n" + kFacet + "endsolid a\nSOLID b\r\n" + kFacet + "EndSolid\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}}));
  EXPECT_EQ(mesh.vertices.size(), 3u);
}

TEST(StlReader, NeverRoundsAsciiThroughFloat) {
  EXPECT_EQ(stl("solid\n" + replaced(kFacet, "1 0 0", "0.1 0 0") + "endsolid\n").vertices[1].x(),
            0.1);
}

TEST(StlReader, RefusesEveryTruncation) {
  const std::string binary =
      binary_stl("solid", {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}});
  for (std::size_t size = 1; size < binary.size(); ++size) {
    EXPECT_EQ(error_of([&] { stl(binary.substr(0, size)); }).where, "m.stl") << size;
  }
  const std::string ascii = "solid\n" + kFacet + "endsolid";
  for (std::size_t size = 1; size < ascii.size(); ++size) {
    EXPECT_EQ(error_of([&] { stl(ascii.substr(0, size)); }).where, "m.stl") << size;
  }
}

TEST(StlReader, RefusesABillionTrianglesBeforeAllocatingThem) {
  expect_cheap([] {
    std::string text = binary_stl("b", {{0, 0, 0, 1, 0, 0, 0, 1, 0}});
    text.replace(80, 4, bytes_of(std::uint32_t{1'000'000'000}));
    expect_error(error_of([&] { stl(text); }), "m.stl", 0, "promises 1000000000 triangles");
    text.replace(80, 4, bytes_of(std::uint32_t{0xffffffff}));
    expect_error(error_of([&] { stl(text); }), "m.stl", 0, "promises 4294967295 triangles");
  });
}

TEST(StlReader, RefusesOverlongAndEmptyMeshes) {
  expect_error(error_of([] {
                 stl(binary_stl("b", {{0, 0, 0, 1, 0, 0, 0, 1, 0}}) + "x");
               }),
               "m.stl", 0, "135 bytes");
  expect_error(error_of([] { stl(binary_stl("b", {})); }), "m.stl", 0, "no triangles");
  expect_error(error_of([] { stl("solid a\nendsolid a\n"); }), "m.stl", 0, "no triangles");
}

TEST(StlReader, RefusesCoordinatesThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::array<float, 9>> triangles = {{0, 0, 0, 1, 0, 0, 0, 1, 0},
                                                       {0, 0, 0, 1, 0, 0, 0, nan, 0}};
  expect_error(error_of([&] { stl(binary_stl("b", triangles)); }), "m.stl", 0, "triangle 1");
  const std::string ascii = "solid\n" + replaced(kFacet, "1 0 0", "1 nan 0") + "endsolid\n";
  expect_error(error_of([&] { stl(ascii); }), "m.stl", 5, "y is 'nan'");
}

TEST(StlReader, RefusesFacetsThatAreNoTrianglesWithTheirLine) {
  const std::string two = "solid\n" + replaced(kFacet, "  vertex 1 0 0\n", "") + "endsolid\n";
  expect_error(error_of([&] { stl(two); }), "m.stl", 6, "polygon with 2 vertices");
  const std::string four =
      "solid\n" + replaced(kFacet, " endloop", " vertex 1 1 0\n endloop") + "endsolid\n";
  expect_error(error_of([&] { stl(four); }), "m.stl", 7, "fourth vertex");
  const std::string wrong = "solid\n" + replaced(kFacet, "outer loop", "inner loop") + "endsolid\n";
  expect_error(error_of([&] { stl(wrong); }), "m.stl", 3, "'inner'");
  expect_error(error_of([] { stl("garbage that is not STL at all"); }), "m.stl", 0, "neither");
}

}  // namespace
}  // namespace farcull
