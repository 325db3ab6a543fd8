// Reads Wavefront OBJ, OFF and STL, and writes OFF. Skips materials, normals, colours, texture
// coordinates, and points and lines of OBJ. Refuses free-form surfaces, since skipping them would
// lose geometry. Binary and ASCII STL files may both begin with "solid". So a file is read as
// binary STL if the number of triangles in its header matches its length.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <iterator>
#include <map>
#include <unordered_map>

#include "core/base/text.h"
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

// Reads a face corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, and returns its vertex as an index from 0.
// A negative v counts backwards from the last vertex.
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
  if (!beyond && (status != std::errc() || stop != end))
    in.fail(quote_token(token) + " is not a corner of a face", "write v, v/vt, v//vn or v/vt/vn");
  if (!beyond && index == 0) in.fail("vertex index 0; OBJ counts from 1", "correct the index");
  const auto count = static_cast<std::int64_t>(vertices);
  if (beyond || index > count || index < -count) {
    in.fail(fmt::format("vertex index {} where {} vertices are defined so far", quote_token(text),
                        count),
            "correct the index, or put the v lines before the faces that use them");
  }
  return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
}

// Throws Error if the bytes look like another format. Precondition: the bytes are not valid OBJ.
void refuse_other_format(std::string_view bytes, const std::string& name) {
  const std::string start = lower_case(bytes.substr(0, 5));
  const bool stl = is_binary_stl(bytes) || start == "solid";
  const std::string likely = stl ? "stl" : start.substr(0, 3);
  if (stl || likely == "ply" || likely == "off")
    throw Error(name, "looks like a ." + likely + " file, not OBJ", "rename it");
  if (bytes.substr(0, 512).find('\0') != std::string_view::npos)
    throw Error(name, "has NUL bytes, which no OBJ has",
                "rename it by its format, or get it again");
}

// Throws Error if lines end with LF, but a line has a CR inside. The reader would take this CR for
// a blank, and could skip the text after the CR as part of a comment or of a vertex line.
void require_one_end(std::string_view bytes, const std::string& name) {
  if (bytes.find('\n') == std::string_view::npos) return;
  for (std::size_t at = bytes.find('\r'); at != std::string_view::npos;
       at = bytes.find('\r', at + 1)) {
    const std::string_view after = bytes.substr(at + 1, 1);
    if (after.empty() || after == "\n" || after == "\r") continue;
    refuse_other_format(bytes, name);
    const auto before =
        std::count(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw Error(name, "a line ends with CR alone, and others end with LF",
                "let all end alike, as tr '\\r' '\\n' makes them", static_cast<long>(before) + 1);
  }
}

}  // namespace

Mesh parse_obj(std::string_view bytes, const std::string& name) {
  require_one_end(bytes, name);
  TextReader in(bytes, name, {.comment = '#', .continuation = true});
  MeshBuilder mesh(name, 1);
  std::vector<std::uint32_t> corners;
  std::string within;  // the number of the current object, as text
  std::map<std::string, std::size_t, std::less<>> objects;
  std::string twice;  // the first object that begins a second time
  long line_of_twice = 0;
  std::uint64_t unknown = 0;
  std::string first_unknown;
  long line_of_unknown = 0;
  while (in.next_line()) {
    const std::string_view keyword = in.token();
    if (keyword == "v") {
      const Vec3 p = in.point();
      mesh.add_vertex(p, in.line());
    } else if (keyword == "f" || keyword == "fo") {
      corners.clear();
      for (std::string_view token = in.token(); !token.empty(); token = in.token())
        corners.push_back(corner_vertex(token, mesh.vertex_count(), in));
      mesh.add_face(corners, in.line());
    } else if (keyword == "o") {
      const std::string object(in.rest());
      const auto [at, is_new] = objects.try_emplace(object, objects.size() + 1);
      within = std::to_string(at->second);
      mesh.set_group(object, within);
      if (!is_new && twice.empty()) {
        twice = quote_token(object);
        line_of_twice = in.line();
      }
    } else if (keyword == "g") {
      const std::string group(in.rest());
      mesh.set_group(group, group.empty() ? "" : within);
    } else if (contains(kFreeForm, keyword)) {
      in.fail("free-form geometry (" + quote_token(keyword) + ") is not read",
              "export the mesh as polygons");
    } else if (!contains(kPassedOver, keyword) && unknown++ == 0) {
      first_unknown = quote_token(keyword);
      line_of_unknown = in.line();
    }
  }
  if (unknown > 0 && mesh.vertex_count() == 0) {
    refuse_other_format(bytes, name);
    throw Error(name, first_unknown + " is not a statement of OBJ",
                "see whether the file is an OBJ file and whole", line_of_unknown);
  }
  if (!twice.empty()) {
    mesh.note(fmt::format("object {} begins again in line {}: its faces are one object", twice,
                          line_of_twice));
  }
  if (unknown > 0) {
    mesh.note(fmt::format(
        "{}, {} in line {}{}: passed over",
        counted(unknown, "statement that OBJ does not have", "statements that OBJ does not have"),
        first_unknown, line_of_unknown, unknown > 1 ? " first" : ""));
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

// True if the keyword is [ST][C][N]OFF: in these variants a vertex line begins with x, y and z.
bool is_three_dimensional(std::string_view keyword) {
  if (keyword.starts_with("ST")) keyword.remove_prefix(2);
  if (keyword.starts_with("C")) keyword.remove_prefix(1);
  if (keyword.starts_with("N")) keyword.remove_prefix(1);
  return keyword == "OFF";
}

// Reads a number of elements. Throws Error if the remaining bytes are too few for this number. An
// element takes at least `bytes_each` bytes of text; the last element may lack its newline.
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
  if (!keyword.ends_with("OFF"))
    in.fail(quote_token(keyword) + " is not a header of OFF", "give a file that begins with OFF");
  if (!is_three_dimensional(keyword)) {
    in.fail("the variant " + quote_token(keyword) + " is not read",
            "write it as OFF with three coordinates per vertex");
  }
  TextReader ahead = in;
  if (ahead.token() == "BINARY")
    in.fail("the variant 'OFF BINARY' is not read", "write it as text");
  // The counts are on the line of the keyword or on the next line.
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
    if (!in.next_line())
      in.fail(fmt::format("the file ends after {} of {} vertices", i, header.vertices), kDamaged);
    const Vec3 p = in.point();
    if (!header.extra_per_vertex && !in.token().empty()) {
      in.fail("more than three values on a vertex line of plain OFF",
              "put each vertex on a line of its own, or declare colours or normals (COFF, NOFF)");
    }
    mesh.add_vertex(p, in.line());
  }

  std::vector<std::uint32_t> corners;
  for (std::uint64_t i = 0; i < header.faces; ++i) {
    if (!in.next_line())
      in.fail(fmt::format("the file ends after {} of {} faces", i, header.faces), kDamaged);
    const std::int64_t size = in.integer("the number of vertices of a face");
    if (size < 0) in.fail(fmt::format("a face of {} vertices", size), "correct the face");
    corners.clear();
    // If `size` is too large, reading fails at the end of the line, before `corners` grows large.
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

std::string off_text(const MeshPart& part) {
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "OFF\n{} {} 0\n", part.vertices.size(),
                 part.triangles.size());
  for (const Vec3& p : part.vertices)
    fmt::format_to(std::back_inserter(out), "{:.17g} {:.17g} {:.17g}\n", p.x(), p.y(), p.z());
  for (const auto& [a, b, c] : part.triangles)
    fmt::format_to(std::back_inserter(out), "3 {} {} {}\n", a, b, c);
  return fmt::to_string(out);
}

namespace {

constexpr std::size_t kHeaderBytes = 84;    // 80 arbitrary bytes, then the number of triangles
constexpr std::size_t kTriangleBytes = 50;  // normal and corners as 12 floats, 2 arbitrary bytes

// Gives all corners at the same position the same vertex.
class Welder {
 public:
  explicit Welder(MeshBuilder& mesh) : mesh_(mesh) {}

  std::uint32_t vertex(const Vec3& p, long line) {
    const std::array<double, 3> key = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
    const auto [entry, is_new] =
        index_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertex_count()));
    if (is_new) mesh_.add_vertex(p, line);
    return entry->second;
  }

 private:
  MeshBuilder& mesh_;
  std::unordered_map<std::array<double, 3>, std::uint32_t, PositionHash> index_;
};

std::uint32_t little_word(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return word;
}

// True if one of the first 4096 bytes is NUL. Binary STL usually has NULs there; text has none.
bool has_nul(std::string_view bytes) { return bytes.substr(0, 4096).find('\0') != bytes.npos; }

bool is_text(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  const std::size_t start = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  return lower_case(bytes.substr(start, 5)) == "solid" && !has_nul(bytes);
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
    if (!has_nul(bytes))
      throw Error(name, "is text that does not begin with 'solid', not STL", "rename it");
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

// Reads the next words, even over several lines. Throws Error if these words are not `words`.
void expect(TextReader& in, std::string_view words) {
  const std::string remedy = "see whether the file is an STL file and whole";
  for (std::size_t start = 0; start < words.size();) {
    const std::size_t end = std::min(words.find(' ', start), words.size());
    if (!in.seek()) in.fail(fmt::format("the file ends where '{}' should follow", words), remedy);
    const std::string_view word = in.token();
    if (lower_case(word) != words.substr(start, end - start))
      in.fail(fmt::format("'{}' should stand here, not {}", words, quote_token(word)), remedy);
    start = end + 1;
  }
}

// Reads and returns the rest of the line. A file may have only one line. So the function stops at
// the word `stop` if the word `after` follows within a few words.
std::string rest_before(TextReader& in, std::string_view stop, std::string_view after) {
  std::string out;
  for (;;) {
    TextReader ahead = in;
    const std::string_view word = ahead.token();
    if (word.empty()) return out;
    TextReader behind = ahead;
    constexpr int kFew = 8;
    for (int k = 0; lower_case(word) == stop && k < kFew; ++k) {
      if (lower_case(behind.token()) == after) return out;
    }
    out.append(out.empty() ? "" : " ").append(word);
    in = ahead;
  }
}

Mesh parse_text(std::string_view bytes, const std::string& name) {
  TextReader in(bytes, name, {});
  MeshBuilder mesh(name);
  Welder welder(mesh);
  bool inside = false;
  std::size_t solids = 0;
  std::vector<std::uint32_t> corners;
  while (in.seek()) {
    const std::string word = lower_case(in.token());
    if (!inside && word == "solid") {
      inside = true;
      const std::string solid = rest_before(in, "facet", "normal");
      ++solids;
      mesh.set_group(solid.empty() && solids > 1 ? fmt::format("solid {}", solids) : solid,
                     std::to_string(solids));
    } else if (inside && word == "endsolid") {
      inside = false;
      rest_before(in, "solid", "facet");
    } else if (inside && word == "facet") {
      rest_before(in, "outer", "loop");
      expect(in, "outer loop");
      corners.clear();
      for (;;) {
        if (!in.seek()) in.fail("the file ends within a facet", "get the whole file");
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
