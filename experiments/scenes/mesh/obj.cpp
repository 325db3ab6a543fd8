// Wavefront OBJ: polygons, groups and objects. Materials, normals, texture coordinates, points and
// lines are passed over; free-form surfaces are refused, since passing over them would lose
// geometry.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "experiments/scenes/mesh/builder.h"
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

}  // namespace farcull
