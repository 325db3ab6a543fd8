// Reads PLY files, ASCII or binary in either byte order. Takes the positions of the element
// `vertex` and the index lists of `face` or `tristrips`, and skips everything else.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <set>

#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

constexpr std::string_view kStrips = "tristrips";
constexpr const char* kDamaged = "correct the header, or get the whole file";

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
enum class Encoding { kAscii, kLittle, kBig };

struct TypeInfo {
  std::string_view name, other_name;
  std::size_t size;  // bytes
  bool is_signed_integer;
};
// Types in the order of the enumerators of Type.
constexpr std::array<TypeInfo, 8> kTypes = {{{"char", "int8", 1, true},
                                             {"uchar", "uint8", 1, false},
                                             {"short", "int16", 2, true},
                                             {"ushort", "uint16", 2, false},
                                             {"int", "int32", 4, true},
                                             {"uint", "uint32", 4, false},
                                             {"float", "float32", 4, false},
                                             {"double", "float64", 8, false}}};

const TypeInfo& info_of(Type type) { return kTypes[static_cast<std::size_t>(type)]; }
bool is_integer(Type type) { return type != Type::kFloat && type != Type::kDouble; }

struct Property {
  std::string name;
  Type type = Type::kFloat;
  std::optional<Type> count;  // set for a list: the type of the list's length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  long line = 0;
};

struct Header {
  Encoding encoding = Encoding::kAscii;
  std::vector<Element> elements;
};

Type read_type(TextReader& in) {
  const std::string_view word = in.token();
  const auto found = std::ranges::find_if(
      kTypes, [&](const TypeInfo& type) { return word == type.name || word == type.other_name; });
  if (found == kTypes.end())
    in.fail(quote_token(word) + " is not a type of PLY",
            "use int, uchar, float, double or the like");
  return static_cast<Type>(found - kTypes.begin());
}

Encoding read_format(TextReader& in) {
  const std::string_view word = in.token();
  const std::string_view version = in.token();
  if (version != "1.0")
    in.fail("PLY version " + quote_token(version) + " is not read", "write it as 1.0");
  if (word == "ascii") return Encoding::kAscii;
  if (word == "binary_little_endian") return Encoding::kLittle;
  if (word == "binary_big_endian") return Encoding::kBig;
  in.fail("the format " + quote_token(word) + " is not read",
          "use ascii, binary_little_endian or binary_big_endian");
}

Property read_property(TextReader& in) {
  Property property;
  TextReader ahead = in;
  if (ahead.token() == "list") {
    in.token();
    property.count = read_type(in);
    if (!is_integer(*property.count))
      in.fail("a list whose length is not an integer", "declare its length as uchar or int");
  }
  property.type = read_type(in);
  property.name = in.token();
  if (property.name.empty()) in.fail("a property without a name", "name it");
  return property;
}

Header read_header(TextReader& in) {
  if (!in.next_line() || in.token() != "ply")
    in.fail("the file does not begin with 'ply'", "give a PLY file");
  Header header;
  std::set<std::string> names;
  bool has_format = false;
  for (;;) {
    if (!in.next_line()) in.fail("the file ends within its header", "get the whole file");
    const std::string_view word = in.token();
    if (word == "format") {
      header.encoding = read_format(in);
      has_format = true;
    } else if (word == "element") {
      Element element;
      element.name = in.token();
      element.line = in.line();
      const std::int64_t count = in.integer("the number of elements");
      if (count < 0) in.fail(fmt::format("{} elements", count), kDamaged);
      element.count = static_cast<std::uint64_t>(count);
      if (!names.insert(element.name).second)
        in.fail("a second element " + quote_token(element.name), kDamaged);
      header.elements.push_back(element);
    } else if (word == "property") {
      if (header.elements.empty()) in.fail("a property before any element", kDamaged);
      header.elements.back().properties.push_back(read_property(in));
    } else if (word == "end_header") {
      if (!has_format) in.fail("the header has no format line", kDamaged);
      return header;
    } else if (word != "comment" && word != "obj_info") {
      in.fail(quote_token(word) + " is not a line of a PLY header", kDamaged);
    }
  }
}

// AsciiBody and BinaryBody read the values after the header. Both have the same member functions.
// An ASCII body has one element per line.
class AsciiBody {
 public:
  explicit AsciiBody(const TextReader& in) : in_(in) {}

  void begin() {
    if (!in_.next_line()) in_.fail("the file ends before its last element", kDamaged);
  }
  void end() {
    if (!in_.token().empty()) in_.fail("more values than the header declares", kDamaged);
  }
  double coordinate(Type, std::string_view what) { return in_.coordinate(what); }
  std::int64_t integer(Type, std::string_view what) { return in_.integer(what); }
  void skip(Type) {
    if (in_.token().empty()) in_.fail("fewer values than the header declares", kDamaged);
  }
  // Returns the least number of bytes of a value: a digit and a separator.
  static std::size_t least_bytes(Type) { return 2; }
  // Counts one byte more, since the last value of the file may lack its separator.
  std::size_t bytes_left() const { return in_.bytes_left() + 1; }
  bool at_end() { return !in_.next_line(); }
  long line() const { return in_.line(); }
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const {
    in_.fail(reason, remedy);
  }

 private:
  TextReader in_;
};

class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, bool big, const std::string& name)
      : bytes_(bytes), big_(big), name_(name) {}

  void begin() {}
  void end() {}
  double coordinate(Type type, std::string_view) { return take(type); }
  // Every integer type of PLY fits into a double.
  std::int64_t integer(Type type, std::string_view) {
    return static_cast<std::int64_t>(take(type));
  }
  void skip(Type type) { take(type); }
  static std::size_t least_bytes(Type type) { return info_of(type).size; }
  std::size_t bytes_left() const { return bytes_.size(); }
  bool at_end() const { return bytes_.find_first_not_of(" \t\r\n") == std::string_view::npos; }
  static long line() { return 0; }
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const {
    throw Error(name_, reason, remedy);
  }

 private:
  double take(Type type) {
    const std::size_t size = info_of(type).size;
    if (bytes_.size() < size) fail("the file ends before its last element", kDamaged);
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint64_t byte = static_cast<unsigned char>(bytes_[i]);
      word |= byte << (8 * (big_ ? size - 1 - i : i));
    }
    bytes_.remove_prefix(size);
    if (type == Type::kFloat) return std::bit_cast<float>(static_cast<std::uint32_t>(word));
    if (type == Type::kDouble) return std::bit_cast<double>(word);
    if (!info_of(type).is_signed_integer) return static_cast<double>(word);
    const std::size_t unused = 64 - 8 * size;
    return static_cast<double>(static_cast<std::int64_t>(word << unused) >> unused);
  }

  std::string_view bytes_;
  bool big_;
  std::string name_;
};

// Reads the length of a list. Throws Error if the remaining bytes are too few for the list.
template <class Body>
std::uint64_t list_length(Body& body, const Property& list) {
  const std::int64_t length = body.integer(*list.count, "the length of a list");
  if (length < 0) body.fail(fmt::format("a list of {} values", length), "correct the list");
  const auto claimed = static_cast<std::uint64_t>(length);
  if (claimed > body.bytes_left() / body.least_bytes(list.type)) {
    body.fail(
        fmt::format("a list of {} values where {} bytes are left", claimed, body.bytes_left()),
        kDamaged);
  }
  return claimed;
}

template <class Body>
void skip_property(Body& body, const Property& property) {
  const std::uint64_t values = property.count ? list_length(body, property) : 1;
  for (std::uint64_t i = 0; i < values; ++i) body.skip(property.type);
}

template <class Body>
void read_vertices(Body& body, const Element& element, MeshBuilder& mesh) {
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.begin();
    Vec3 p;
    for (const Property& property : element.properties) {
      const int axis = property.name == "x"   ? 0
                       : property.name == "y" ? 1
                       : property.name == "z" ? 2
                                              : 3;
      if (axis < 3) {
        p[axis] = body.coordinate(property.type, property.name);
      } else {
        skip_property(body, property);
      }
    }
    body.end();
    mesh.add_vertex(p, body.line());
  }
}

bool is_index_list(const Property& property) {
  return property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
}

// Stores the faces until all vertices are read, since faces may come first in the file.
struct Faces {
  std::vector<std::uint32_t> corners;  // corners of all faces, one face after the other
  std::vector<std::uint32_t> sizes;
  std::vector<long> lines;
};

/// Converts triangle strips into triangles. Each vertex forms a triangle with the two vertices
/// before it. Every second triangle is reversed, so that the triangles of a strip have one
/// orientation. The index -1 begins a new strip. Triangles that name a vertex twice are left out.
class Strip {
 public:
  void add(std::int64_t index, long line, Faces& faces) {
    last_ = {last_[1], last_[2], static_cast<std::uint32_t>(index)};
    length_ = index < 0 ? 0 : length_ + 1;
    auto [p, q, r] = last_;
    if (length_ < 3 || p == q || q == r || p == r) return;
    if (length_ % 2 == 0) std::swap(p, q);
    faces.corners.insert(faces.corners.end(), {p, q, r});
    faces.sizes.push_back(3);
    faces.lines.push_back(line);
  }

 private:
  std::array<std::uint32_t, 3> last_ = {};
  std::uint64_t length_ = 0;
};

template <class Body>
void read_faces(Body& body, const Element& element, Faces& faces) {
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.begin();
    for (const Property& property : element.properties) {
      if (!is_index_list(property)) {
        skip_property(body, property);
        continue;
      }
      const std::uint64_t size = list_length(body, property);
      const bool strips = element.name == kStrips;
      Strip strip;
      if (!strips) faces.sizes.push_back(static_cast<std::uint32_t>(size));
      if (!strips) faces.lines.push_back(body.line());
      for (std::uint64_t k = 0; k < size; ++k) {
        const std::int64_t index = body.integer(property.type, "a vertex index of the face");
        if (index < (strips ? -1 : 0) || index > std::int64_t{0xffffffff}) {
          body.fail(fmt::format("face {} names vertex {}", i, index),
                    "correct the index; PLY counts from 0");
        }
        if (strips)
          strip.add(index, body.line(), faces);
        else
          faces.corners.push_back(static_cast<std::uint32_t>(index));
      }
    }
    body.end();
  }
}

void check_vertex(const Element& element, const std::string& name) {
  for (const std::string_view axis : {"x", "y", "z"}) {
    const auto same = [&](const Property& p) { return p.name == axis && !p.count; };
    const auto found = std::count_if(element.properties.begin(), element.properties.end(), same);
    if (found != 1) {
      throw Error(name, fmt::format("vertices have {} scalar properties named '{}'", found, axis),
                  "give each vertex one x, one y and one z", element.line);
    }
  }
}

void check_face(const Element& element, const std::string& name) {
  std::vector<Property> lists;
  std::ranges::copy_if(element.properties, std::back_inserter(lists), is_index_list);
  if (lists.size() != 1) {
    throw Error(
        name,
        fmt::format("faces have {} lists named 'vertex_indices' or 'vertex_index'", lists.size()),
        "give each face one such list", element.line);
  }
  if (!is_integer(lists[0].type)) {
    throw Error(name, "vertex indices are declared as floating-point numbers",
                "declare them as int or uint", element.line);
  }
}

template <class Body>
Mesh read_body(Body body, const Header& header, const std::string& name) {
  MeshBuilder mesh(name);
  Faces faces;
  bool has_faces = false;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;  // the elements take no bytes
    std::size_t least = 0;                     // least number of bytes of an element
    for (const Property& p : element.properties)
      least += body.least_bytes(p.count.value_or(p.type));
    if (element.count > body.bytes_left() / std::max<std::size_t>(least, 1)) {
      throw Error(name,
                  fmt::format("the header promises {} elements {}, but only {} bytes follow",
                              element.count, quote_token(element.name), body.bytes_left()),
                  kDamaged, element.line);
    }
    if (element.name == "vertex") {
      check_vertex(element, name);
      read_vertices(body, element, mesh);
    } else if (element.name == "face" || element.name == kStrips) {
      check_face(element, name);
      read_faces(body, element, faces);
      has_faces = true;
    } else {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        body.begin();
        for (const Property& property : element.properties) skip_property(body, property);
        body.end();
      }
    }
  }
  if (!body.at_end()) body.fail("more follows than the header promises", kDamaged);
  if (faces.sizes.empty() && mesh.vertex_count() > 0) {
    throw Error(name,
                fmt::format("is a cloud of {} points: {}", mesh.vertex_count(),
                            has_faces ? "it has no faces" : "there is no element 'face'"),
                "give the mesh of a surface, written as faces or strips of triangles");
  }

  std::span<const std::uint32_t> corners = faces.corners;
  for (std::size_t i = 0; i < faces.sizes.size(); ++i) {
    mesh.add_face(corners.first(faces.sizes[i]), faces.lines[i]);
    corners = corners.subspan(faces.sizes[i]);
  }
  return mesh.finish();
}

}  // namespace

Mesh parse_ply(std::string_view bytes, const std::string& name) {
  TextReader in(bytes, name, {});
  const Header header = read_header(in);
  if (header.encoding == Encoding::kAscii) {
    if (!in.token().empty()) in.fail("more stands on the line of 'end_header'", kDamaged);
    return read_body(AsciiBody(in), header, name);
  }
  // The body begins right after the line of end_header.
  const std::size_t newline = bytes.find('\n', in.offset());
  const std::string_view body = newline == std::string_view::npos ? "" : bytes.substr(newline + 1);
  return read_body(BinaryBody(body, header.encoding == Encoding::kBig, name), header, name);
}

}  // namespace farcull
