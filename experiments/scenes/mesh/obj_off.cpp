// Wavefront OBJ and OFF, read and written.
//
// OBJ: polygons, groups and objects. Materials, normals, texture coordinates, points and lines are
// passed over; free-form surfaces are refused, since passing over them would lose geometry.
//
// OFF, as written by Geomview and its followers: a header, the counts, one vertex and one face per
// line. Position comes first on a vertex line, so normals, colours and texture coordinates that the
// header declares (NOFF, COFF, STOFF and their combinations) can be passed over; so can the colour
// at the end of a face line.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>

#include "experiments/scenes/mesh/builder.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

constexpr std::array<std::string_view, 27> kPassedOver = {
    "vn",     "vt",         "usemtl",    "s",      "mtllib", "l",        "p",
    "vp",     "mg",         "usemap",    "maplib", "bevel",  "c_interp", "d_interp",
    "lod",    "shadow_obj", "trace_obj", "ctech",  "stech",  "ka",       "kd",
    "cstype", "deg",        "bmat",      "step",   "vo",     "con"};
constexpr std::array<std::string_view, 11> kFreeForm = {
    "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp", "bzp", "bsp", "cdc"};

bool contains(std::span<const std::string_view> words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// The vertex of one corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, as a 0-based index; negative v count
// from the last vertex.
std::uint32_t corner_vertex(std::string_view token, std::uint64_t vertices, const TextReader& in) {
  const std::string_view text = token.substr(0, token.find('/'));
  if (token.find_first_not_of("0123456789/-+") != std::string_view::npos || text.empty() ||
      text.starts_with("+-")) {
    in.fail(quote_token(token) + " is not a corner of a face", "write v, v/vt, v//vn or v/vt/vn");
  }
  const char* const end = text.data() + text.size();
  std::int64_t index = 0;
  const auto [stop, status] = std::from_chars(text.data() + text.starts_with('+'), end, index);
  const bool beyond = status == std::errc::result_out_of_range;
  if (!beyond && (status != std::errc() || stop != end)) {
    in.fail(quote_token(token) + " is not a corner of a face", "write v, v/vt, v//vn or v/vt/vn");
  }
  if (!beyond && index == 0) {
    in.fail("vertex index 0; OBJ counts from 1", "correct the index");
  }
  const auto count = static_cast<std::int64_t>(vertices);
  if (beyond || index > count || index < -count) {
    in.fail(fmt::format("vertex index {} where {} vertices are defined so far", quote_token(text),
                        count),
            "correct the index, or put the v lines before the faces that use them");
  }
  return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
}

}  // namespace

Mesh parse_obj(std::string_view bytes, const std::string& name) {
  TextReader in(bytes, name, {.comment = '#', .continuation = true});
  MeshBuilder mesh(name);
  std::vector<std::uint32_t> corners;
  while (in.next_line()) {
    const std::string_view keyword = in.token();
    if (keyword == "v") {
      const Vec3 p = in.point();
      mesh.add_vertex(p, in.line());
    } else if (keyword == "f" || keyword == "fo") {
      corners.clear();
      for (std::string_view token = in.token(); !token.empty(); token = in.token()) {
        corners.push_back(corner_vertex(token, mesh.vertex_count(), in));
      }
      mesh.add_face(corners, in.line());
    } else if (keyword == "o" || keyword == "g") {
      mesh.set_group(in.rest());
    } else if (contains(kFreeForm, keyword)) {
      in.fail("free-form geometry (" + quote_token(keyword) + ") is not read",
              "export the mesh as polygons");
    } else if (!contains(kPassedOver, keyword)) {
      in.fail(quote_token(keyword) + " is not a statement of OBJ",
              "see whether the file is an OBJ file and whole");
    }
  }
  return mesh.finish();
}

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

namespace {

void add_vertices(const MeshPart& part, const char* before, fmt::memory_buffer& out) {
  for (const Vec3& p : part.vertices) {
    fmt::format_to(std::back_inserter(out), "{}{:.17g} {:.17g} {:.17g}\n", before, p.x(), p.y(),
                   p.z());
  }
}

}  // namespace

std::string off_text(const MeshPart& part) {
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "OFF\n{} {} 0\n", part.vertices.size(),
                 part.triangles.size());
  add_vertices(part, "", out);
  for (const auto& [a, b, c] : part.triangles)
    fmt::format_to(std::back_inserter(out), "3 {} {} {}\n", a, b, c);
  return fmt::to_string(out);
}

std::string obj_object(const MeshPart& part, const std::string& name, std::uint64_t first) {
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "o {}\n", name);
  add_vertices(part, "v ", out);
  for (const auto& [a, b, c] : part.triangles)
    fmt::format_to(std::back_inserter(out), "f {} {} {}\n", first + a, first + b, first + c);
  return fmt::to_string(out);
}

}  // namespace farcull
