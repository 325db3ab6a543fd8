// OFF, as written by Geomview and its followers: a header, the counts, one vertex and one face per
// line. Position comes first on a vertex line, so normals, colours and texture coordinates that the
// header declares (NOFF, COFF, STOFF and their combinations) can be passed over; so can the colour
// at the end of a face line.
#include <fmt/format.h>

#include <array>

#include "experiments/scenes/mesh/builder.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

constexpr const char* kDamaged = "correct the counts, or get the whole file";

struct Header {
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  bool extra_per_vertex = false;
};

// Whether keyword is [ST][C][N]OFF, the variants whose vertices are x y z and then other things.
bool is_three_dimensional(std::string_view keyword) {
  if (keyword.starts_with("ST")) keyword.remove_prefix(2);
  if (keyword.starts_with("C")) keyword.remove_prefix(1);
  if (keyword.starts_with("N")) keyword.remove_prefix(1);
  return keyword == "OFF";
}

// Every element takes at least `bytes_each` bytes of text, the last one perhaps without its
// newline.
std::uint64_t count(TextReader& in, std::string_view what, std::uint64_t bytes_each) {
  const std::int64_t value = in.integer(fmt::format("the number of {}", what));
  if (value < 0) in.fail(fmt::format("the number of {} is {}", what, value), kDamaged);
  const auto claimed = static_cast<std::uint64_t>(value);
  if (claimed > (in.bytes_left() + 1) / bytes_each) {
    in.fail(fmt::format("the header promises {} {}, but only {} bytes follow", claimed, what,
                        in.bytes_left()),
            kDamaged);
  }
  return claimed;
}

Header read_header(TextReader& in) {
  if (!in.next_line()) in.fail("there is no header", "give a file that begins with OFF");
  const std::string_view keyword = in.token();
  if (!keyword.ends_with("OFF")) {
    in.fail(quote_token(keyword) + " is not a header of OFF", "give a file that begins with OFF");
  }
  if (!is_three_dimensional(keyword)) {
    in.fail("the variant " + quote_token(keyword) + " is not read",
            "write it as OFF with three coordinates per vertex");
  }
  TextReader ahead = in;
  if (ahead.token() == "BINARY") {
    in.fail("the variant 'OFF BINARY' is not read", "write it as text");
  }
  // The counts follow on the same line or on the next.
  ahead = in;
  if (ahead.token().empty() && !in.next_line()) in.fail("the counts are missing", kDamaged);

  Header header;
  header.extra_per_vertex = keyword != "OFF";
  header.vertices = count(in, "vertices", 6);
  header.faces = count(in, "faces", 8);
  if (header.vertices * 6 + header.faces * 8 > in.bytes_left() + 1) {
    in.fail(fmt::format("the header promises {} vertices and {} faces, but only {} bytes follow",
                        header.vertices, header.faces, in.bytes_left()),
            kDamaged);
  }
  return header;
}

}  // namespace

Mesh parse_off(std::string_view bytes, const std::string& name) {
  TextReader in(bytes, name, {.comment = '#'});
  const Header header = read_header(in);
  MeshBuilder mesh(name);

  for (std::uint64_t i = 0; i < header.vertices; ++i) {
    if (!in.next_line()) {
      in.fail(fmt::format("the file ends after {} of {} vertices", i, header.vertices), kDamaged);
    }
    const Vec3 p = in.point();
    if (!header.extra_per_vertex && !in.token().empty()) {
      in.fail("more than three values on a vertex line of plain OFF",
              "put each vertex on a line of its own, or declare colours or normals (COFF, NOFF)");
    }
    mesh.add_vertex(p, in.line());
  }

  std::vector<std::uint32_t> corners;
  for (std::uint64_t i = 0; i < header.faces; ++i) {
    if (!in.next_line()) {
      in.fail(fmt::format("the file ends after {} of {} faces", i, header.faces), kDamaged);
    }
    const std::int64_t size = in.integer("the number of vertices of a face");
    if (size < 0) in.fail(fmt::format("a face of {} vertices", size), "correct the face");
    corners.clear();
    // Corner by corner, so that a false size ends with the line, not with the memory.
    for (std::int64_t k = 0; k < size; ++k) {
      const std::int64_t index = in.integer("a vertex index of the face");
      if (index < 0 || static_cast<std::uint64_t>(index) >= header.vertices) {
        in.fail(fmt::format("vertex index {} of {} vertices", index, header.vertices),
                "correct the index; OFF counts from 0");
      }
      corners.push_back(static_cast<std::uint32_t>(index));
    }
    mesh.add_face(corners, in.line());
  }
  if (in.next_line()) in.fail("more follows than the counts of the header promise", kDamaged);
  return mesh.finish();
}

}  // namespace farcull
