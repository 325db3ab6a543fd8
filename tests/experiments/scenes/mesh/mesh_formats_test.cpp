// The readers of OBJ, OFF, PLY and STL, one after the other.
#include <sys/resource.h>

#include "tests/lab/meshes.h"

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
  const std::clock_t start =
      std::clock();  // of the processor, which a busy machine does not change
  call();
  EXPECT_LT(std::clock() - start, CLOCKS_PER_SEC);
  EXPECT_LT(peak_kilobytes() - before, 64 * 1024);
}

struct Refusal {
  std::string text;
  long line;  // of the error; 0: none
  std::string reason;
};

void expect_refused(Mesh (*read)(const std::string&), const std::vector<Refusal>& refusals) {
  const std::string file = read == obj   ? "m.obj"
                           : read == off ? "m.off"
                           : read == ply ? "m.ply"
                                         : "m.stl";
  for (const Refusal& r : refusals) {
    SCOPED_TRACE(r.reason);
    expect_error(error_of([&] { read(r.text); }), file, r.line, r.reason);
  }
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

TEST(ObjReader, RefusesWithTheLine) {
  expect_refused(obj, {{kThree + "f 0 1 2\n", 4, "index 0"},
                       {kThree + "# c\n\nf 1 2 0/1\n", 6, "index 0"},
                       {kThree + "f 1 2 3\nf 1 2 4\n", 5, "'4'"},
                       {kThree + "f 1 2 -4\n", 4, "'-4'"},
                       // 2^32 + 1 must not wrap to 1, nor what no integer holds.
                       {kThree + "f 1 2 4294967297\n", 4, "4294967297"},
                       {kThree + "f 1 2 99999999999999999999\n", 4, "9999"},
                       {kThree + "f 1 2\n", 4, "polygon with 2 vertices"},
                       {kThree + "f\n", 4, "polygon with 0 vertices"},
                       {"v 0 0 nan\nv 0 0 0\nv 1 0 0\nf 1 2 3\n", 1, "vertex 1 (counted from 1)"},
                       {"v 0 0 0\nv inf 0 0\nf 1 1 2\n", 2, "is not finite, and face 1"},
                       {"v 0 1e999 0\nf 1 1 1\n", 1, "not finite"},
                       {"v 0 0\n", 1, "z is missing"},
                       {"v 0 0 zero\n", 1, "not a number"},
                       // Free-form geometry would be lost; binary garbage is not printed as it is.
                       {kThree + "f 1 2 3\nsurf 0 1 0 1 1 2 3 4\n", 5, "surf"},
                       {std::string("\x7f"
                                    "ELF\x02\x03\x03\xff"),
                        1, "'\\x7fELF\\x02\\x03\\x03\\xff'"},
                       {kThree, 0, "no triangles"},
                       {"\n# nothing\n", 0, "no triangles"}});
  for (const char* corner : {"x", "1.5", "1/x", "/1", "1e0", "+-1", "--1", "+", "-"})
    expect_refused(obj, {{kThree + "f 1 2 " + corner + "\n", 4, "corner"}});
}

TEST(ObjReader, IgnoresWeightsAndColours) {
  const Mesh mesh = obj("v 1 2 3 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 # corner\nf 1 2 3\n");
  EXPECT_EQ(mesh.vertices[0], Vec3(1, 2, 3));
  EXPECT_EQ(mesh.vertices.size(), 3u);
}

TEST(ObjReader, JoinsContinuedLinesAndStillCountsThem) {
  const std::string text = "v 0 0 \\\n0\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 \\\r\n  3\r\n";
  EXPECT_EQ(obj(text).triangles[0], (Triangle{0, 1, 2}));
  expect_refused(obj, {{text + "f 1 2 9\n", 7, "'9'"}});
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

TEST(ObjReader, PassesOverAByteOrderMark) {
  EXPECT_EQ(obj("\xef\xbb\xbf" + kThree + "f 1 2 3\n").triangles.size(), 1u);
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

TEST(OffReader, RefusesWithTheLine) {
  for (const std::string header : {"4OFF", "nOFF", "4nOFF", "OFF BINARY", "ST4OFF"}) {
    const std::string text = header + "\n3 1 0\n0 0 0 0\n1 0 0 0\n0 1 0 0\n3 0 1 2\n";
    expect_refused(off, {{text, 1, "'" + header + "'"}});
  }
  expect_refused(off, {{"3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 1, "header"},
                       {"OFF\n3 1 0\n0 0 0 1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 3, "more than three"},
                       {kOff + "3 0 1 2\n3 0 1 4\n", 10, "index 4"},
                       {kOff + "3 0 1 -1\n3 0 1 2\n", 9, "index -1"},
                       {kOff + "3 0 1 4294967296\n3 0 1 2\n", 9, "4294967296"},
                       {kOff + "4 0 1 2\n3 0 1 2\n", 9, "missing"},
                       {kOff + "3 0 1 2\n2 0 1\n     \n", 10, "polygon with 2 vertices"},
                       {kOff + "-3 0 1 2\n2 0 1\n", 9, "-3"},
                       {kOff + "3 0 1 2    \n      ", 10, "1 of 2 faces"},
                       {"OFF\n2 1 0\n0 0 0                      ", 3, "1 of 2 vertices"},
                       {"OFF", 1, "counts"},
                       {"OFF\n3                   ", 2, "faces is missing"},
                       {kOff + "3 0 1 2\n3 0 2 3\n3 0 1 3\n", 11, "more follows"},
                       {"OFF\n1 1 0\n0 nan 0\n3 0 0 0\n", 3, "vertex 0"},
                       {"OFF\n1 1 0\n0 0 -1e309\n3 0 0 0\n", 3, "vertex 0"}});
}

TEST(OffReader, RefusesABillionVerticesBeforeAllocatingThem) {
  expect_cheap([] {
    expect_refused(off,
                   {{"OFF\n1000000000 1 0\n0 0 0\n", 2, "promises 1000000000"},
                    {"OFF\n1 1000000000 0\n0 0 0\n", 2, "promises 1000000000"},
                    {"OFF\n9223372036854775807 9223372036854775807 0\n", 2, "promises"},
                    {"OFF\n99999999999999999999 1 0\n", 2, "beyond"},
                    {"OFF\n-1 1 0\n", 2, "-1"},
                    // Either count would fit alone.
                    {"OFF\n5 5 0\n" + std::string(45, ' '), 2, "promises 5 vertices and 5 faces"},
                    {kOff + "1000000000 0 1 2 3\n", 9, "missing"}});
  });
}

// ---- PLY

TEST(PlyReader, ReadsAsciiAndTriangulates) {
  const Mesh mesh = ply(kPlyHeader + kPlyVertices + "4 0 1 2 3\n");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.source_face, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(mesh.vertices[2], Vec3(1, 1, 0));
}

TEST(PlyReader, ReadsStripsAsTheTrianglesThatTheyAre) {
  const std::string header = replaced(replaced(kPlyHeader, "element face 1", "element tristrips 2"),
                                      "uchar int", "int int");
  // Every other triangle is turned. -1 begins a strip; a vertex named twice makes none.
  const Mesh mesh = ply(header + kPlyVertices + "9 0 1 3 2 -1 2 3 3 0\n3 1 2 0\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 3}, {3, 1, 2}, {1, 2, 0}}));
  EXPECT_EQ(ply(header + kPlyVertices + "5 0 1 1 3 2\n3 1 2 0\n").triangles,
            (std::vector<Triangle>{{1, 3, 2}, {1, 2, 0}}));
  expect_refused(ply, {{header + kPlyVertices + "3 0 1 2\n3 0 1 4\n", 16, "vertex 4"},
                       {header + kPlyVertices + "3 0 1 -2\n3 0 1 2\n", 15, "vertex -2"}});
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
    const std::string faces = replaced(kPlyHeader, "face 1", "face 1000000000");
    const std::string list = replaced(kPlyHeader, "uchar int", "uint int");
    const std::string binary = replaced(vertices, "ascii", "binary_little_endian");
    expect_refused(ply, {{vertices + kPlyVertices, 4, "promises 1000000000"},
                         {faces + kPlyVertices, 8, "promises 1000000000"},
                         {list + kPlyVertices + "4000000000 0 1 2\n", 15, "list of 4000000000"},
                         {binary + kPlyVertices, 4, "promises 1000000000"}});
  });
}

TEST(PlyReader, RefusesWithTheLine) {
  const std::string binary =
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const double infinity = std::numeric_limits<double>::infinity();
  const std::string body = bytes_of(0.0f, true) + bytes_of(0.0f, true) + bytes_of(infinity, true) +
                           bytes_of(std::uint8_t{3}, true) + std::string(12, '\0');
  const std::string start = kPlyHeader + kPlyVertices;
  const std::string wide = replaced(kPlyHeader, "element face 1", "element face 2");
  expect_refused(ply, {{kPlyHeader + "0 0 0\n1 nan 0\n1 1 0\n0 1 0\n3 0 1 2\n", 12, "vertex 1"},
                       {binary + body, 0, "vertex 0 (counted from 0) is not finite"},
                       {start + "3 0 1 4\n", 15, "vertex 4"},
                       {start + "3 0 1 -1\n", 15, "vertex -1"},
                       {start + "3 0 1 4294967296\n", 15, "4294967296"},
                       {start + "2 0 1\n", 15, "polygon with 2 vertices"},
                       {start + "-1 0 1\n", 15, "-1"},
                       {start + "3 0 1 2 3\n", 15, "more values"},
                       {start + "3 0 1\n", 15, "missing"},
                       {wide + kPlyVertices + "3 0 1 2      ", 15, "ends before"},
                       {start + "3 0 1 2\n3 0 1 2\n", 16, "more follows"},
                       {"ply\nformat ascii 1.0\n", 3, "within its header"}});
}

TEST(PlyReader, RefusesBadHeadersWithTheirLine) {
  struct Bad {
    std::string from, to;
    long line;
    std::string reason;
  };
  for (const Bad& bad :
       std::vector<Bad>{{"ply", "plx", 1, "'ply'"},
                        {"ascii", "utf8", 2, "'utf8'"},
                        {"1.0", "2.0", 2, "'2.0'"},
                        {"format ascii 1.0\n", "", 9, "no format"},
                        {"vertex 4", "vertex four", 4, "'four'"},
                        {"vertex 4", "vertex -4", 4, "-4"},
                        {"double x", "quad x", 5, "'quad'"},
                        {"property double x", "property double", 5, "without a name"},
                        {"double x", "double u", 4, "'x'"},
                        {"double y", "double x", 4, "2 scalar properties named 'x'"},
                        {"uchar int", "float int", 9, "length"},
                        {"uchar int", "uchar float", 8, "floating-point"},
                        {"vertex_indices", "corners", 8, "0 lists"},
                        {"element face 1", "element vertex 1", 8, "second element"},
                        {"element face 1", "element strip 1", 0, "no element 'face'"},
                        {"end_header", "end_head", 10, "'end_head'"}})
    expect_refused(ply, {{replaced(kPlyHeader, bad.from, bad.to) + kPlyVertices + "3 0 1 2\n",
                          bad.line, bad.reason}});
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

TEST(StlReader, ReadsAsciiInAnyCaseWithSeveralSolids) {
  const Mesh mesh = stl("solid a\n" + kFacet + "endsolid a\nSOLID b\r\n" + kFacet + "EndSolid\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}}));
  EXPECT_EQ(mesh.vertices.size(), 3u);
}

TEST(StlReader, RefusesEveryTruncation) {
  const std::string binary =
      binary_stl("solid", {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}});
  for (std::size_t size = 1; size < binary.size(); ++size)
    EXPECT_EQ(error_of([&] { stl(binary.substr(0, size)); }).where, "m.stl") << size;
  const std::string ascii = "solid\n" + kFacet + "endsolid";
  for (std::size_t size = 1; size < ascii.size(); ++size)
    EXPECT_EQ(error_of([&] { stl(ascii.substr(0, size)); }).where, "m.stl") << size;
}

TEST(StlReader, RefusesABillionTrianglesBeforeAllocatingThem) {
  expect_cheap([] {
    std::string text = binary_stl("b", {{0, 0, 0, 1, 0, 0, 0, 1, 0}});
    for (const std::uint32_t count : {1'000'000'000u, 0xffffffffu}) {
      text.replace(80, 4, bytes_of(count));
      expect_refused(stl, {{text, 0, "promises " + std::to_string(count) + " triangles"}});
    }
  });
}

TEST(StlReader, RefusesWithTheLine) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::array<float, 9>> good = {{0, 0, 0, 1, 0, 0, 0, 1, 0}},
                                          bad = {good[0], {0, 0, 0, 1, 0, 0, 0, nan, 0}};
  const auto ascii = [](const std::string& from, const std::string& to) {
    return "solid\n" + replaced(kFacet, from, to) + "endsolid\n";
  };
  expect_refused(stl, {{binary_stl("b", good) + "x", 0, "135 bytes"},
                       {binary_stl("b", {}), 0, "no triangles"},
                       {"solid a\nendsolid a\n", 0, "no triangles"},
                       {binary_stl("b", bad), 0, "triangle 1"},
                       {ascii("1 0 0", "1 nan 0"), 5, "vertex 1"},
                       {ascii("  vertex 1 0 0\n", ""), 6, "polygon with 2 vertices"},
                       {ascii(" endloop", " vertex 1 1 0\n endloop"), 7, "fourth vertex"},
                       {ascii("outer loop", "inner loop"), 3, "'inner'"},
                       {"garbage that is not STL at all", 0, "neither"}});
}

}  // namespace
}  // namespace farcull
