// Reads lists of pairs, the folder of a mesh (mesh.txt, an OBJ for each object, pairs.csv), and
// suite.txt, the list of all files with their sums. The readers go through a text line by line, so
// that every error has its line. <charconv> converts numbers, since no locale changes it.
#include "experiments/suite/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/scenes/mesh/text.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 10> kKinds = {
    "apart",    "touch-vertex", "touch-edge",      "touch-face",       "crossing",
    "coplanar", "equal",        "neighbours-meet", "neighbours-apart", "?"};

constexpr const char* kAgain = "docs/suite.md has the format; write the suite again";
constexpr std::uint64_t kAnyBytes = std::numeric_limits<std::uint64_t>::max();

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<std::string_view> out;
  for (std::size_t at = 0; (at = line.find_first_not_of(kBlanks, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    out.push_back(line.substr(at, end - at));
    at = end;
  }
  return out;
}

/// The lines of a text one by one, with their numbers.
class Lines {
 public:
  /// `name` stands for the file in errors. Throws Error if the text does not end with a newline.
  Lines(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {
    if (text.empty() || text.back() != '\n')
      throw Error(name_, "the file does not end with a newline, so its end may be missing", kAgain);
  }

  /// The next line without its newline; false at the end.
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    ++number_;
    return true;
  }
  /// Reads the next line, which must be `key` and one word, and returns the word.
  std::string_view word_after(std::string_view key) {
    std::string_view line;
    const std::vector<std::string_view> words =
        next(line) ? words_of(line) : std::vector<std::string_view>{};
    if (words.size() != 2 || words[0] != key)
      fail(fmt::format("the line is not '{}' and one word", key));
    return words[1];
  }
  template <class T>
  T number(std::string_view word, const char* called) const {
    const std::optional<T> value = parse_number<T>(word);
    if (!value || !std::isfinite(static_cast<double>(*value)))
      fail(fmt::format("{} is no number for {}", quote_token(word), called));
    return *value;
  }
  long line() const { return number_; }  // the number of the line read last, from 1
  /// Throws Error naming the file and the line read last.
  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(name_, reason, kAgain, number_);
  }

 private:
  std::string_view rest_;
  std::string name_;
  long number_ = 0;
};

bool is_corner(char c) { return c >= '0' && c <= '2'; }

/// "0-1,2-0", ascending.
std::vector<SharedCorner> parse_shared(const ListLine& line, std::string_view word) {
  std::vector<SharedCorner> out;
  for (std::string_view rest = word == "-" ? "" : word; !rest.empty();
       rest.remove_prefix(std::min<std::size_t>(4, rest.size()))) {
    if (rest.size() < 3 || rest.size() == 4 || !is_corner(rest[0]) || rest[1] != '-' ||
        !is_corner(rest[2]) || (rest.size() > 3 && rest[3] != ','))
      line.fail(quote_token(word) + " names no shared corners, as 0-1,2-0 does");
    const SharedCorner next{static_cast<std::uint8_t>(rest[0] - '0'),
                            static_cast<std::uint8_t>(rest[2] - '0')};
    if (!out.empty() && next <= out.back()) line.fail("the shared corners do not ascend");
    out.push_back(next);
  }
  return out;
}

SuitePair parse_pair(const ListLine& line) {
  const std::vector<std::string_view>& words = line.words;
  if (words.size() != 22) line.fail("the line is not 'ID PARAMETER SHARED KIND' and 18 numbers");
  SuitePair out;
  out.line = line.number;
  out.id = line.id;
  out.parameter = line.parameter;
  out.shared = parse_shared(line, words[2]);
  const std::optional<SuiteKind> known = parse_suite_kind(words[3]);
  if (!known) line.fail(quote_token(words[3]) + " is no kind of contact");
  out.kind = *known;
  const std::vector<double> x = line.coordinates(4);
  for (std::size_t i = 0; i < 3; ++i) {
    out.a[i] = {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
    out.b[i] = {x[3 * i + 9], x[3 * i + 10], x[3 * i + 11]};
  }
  for (const auto& [i, j] : out.shared) {
    if (out.a[i] != out.b[j])
      line.fail(fmt::format("corners {}-{} are called shared, but their coordinates differ", i, j));
  }
  const bool of_neighbours =
      out.kind == SuiteKind::neighbours_meet || out.kind == SuiteKind::neighbours_apart;
  if (out.kind != SuiteKind::unlabelled && of_neighbours == out.shared.empty()) {
    line.fail(fmt::format("the kind {} is for triangles {} shared corners", words[3],
                          of_neighbours ? "with" : "without"));
  }
  return out;
}

// The folder of a mesh.

void read_properties(const std::string& path, SuiteMesh& mesh) {
  const std::string text = read_file(path, kAnyBytes);
  Lines lines(text, path);
  const std::string_view self = lines.word_after("self");
  if (self != "yes" && self != "no") lines.fail(quote_token(self) + " is neither yes nor no");
  mesh.self = self == "yes";
  mesh.parameter = lines.number<double>(lines.word_after("parameter"), "the parameter");
  mesh.family = lines.word_after("family");
  for (std::string_view line; lines.next(line);) {
    if (!line.starts_with("# ")) lines.fail("after three lines there is one that is no comment");
    if (!mesh.note.empty()) mesh.note += '\n';
    mesh.note += line.substr(2);
  }
}

/// 0.obj, 1.obj and so on.
Scene read_objects(const std::string& folder, const SuiteMesh& mesh) {
  SceneBuilder builder(mesh.name, folder);
  for (int i = 0;; ++i) {
    const std::string path = fmt::format("{}/{}.obj", folder, i);
    if (i > 0 && !fs::exists(path)) return builder.finish();
    const Mesh object = load_mesh(path);
    for (std::size_t t = 0; t < object.triangles.size(); ++t) {
      if (object.source_face[t] != t)
        throw Error(path, fmt::format("face {} is no triangle", object.source_face[t]), kAgain);
    }
    builder.add(object, std::to_string(i), Split::kNone, {}, mesh.self);
  }
}

/// A row of pairs.csv.
SuiteMeshPair parse_row(const Lines& lines, std::string_view line, const SuiteMesh& mesh) {
  std::array<std::uint32_t, 5> cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string_view cell = line.substr(0, line.find(','));
    const std::optional<std::uint32_t> value = parse_number<std::uint32_t>(cell);
    if (!value || (i < 4) != (cell.size() < line.size()))
      lines.fail("the line is not five whole numbers with commas between them");
    cells[i] = *value;
    line.remove_prefix(std::min(line.size(), cell.size() + 1));
  }
  const auto triangle = [&](std::uint32_t object, std::uint32_t row) {
    if (object >= mesh.scene.objects.size() || row >= mesh.scene.objects[object].triangle_count)
      lines.fail(fmt::format("object {} has no triangle {}", object, row));
    return mesh.scene.objects[object].first_triangle + row;
  };
  const SuiteMeshPair out{{triangle(cells[0], cells[1]), triangle(cells[2], cells[3])}, cells[4]};
  if (out.pair.a >= out.pair.b) lines.fail("the first triangle is not before the second");
  const bool one_object = cells[0] == cells[2];
  if (one_object && !mesh.self)
    lines.fail("the triangles are of one object, which is not tested against itself");
  const std::uint32_t shared = one_object ? shared_vertices(mesh.scene, out.pair) : 0;
  if (out.shared != shared)
    lines.fail(fmt::format("the triangles share {} vertices, not {}", shared, out.shared));
  return out;
}

void read_colliding(const std::string& path, SuiteMesh& mesh) {
  const std::string text = read_file(path, kAnyBytes);
  Lines lines(text, path);
  std::string_view line;
  lines.next(line);
  if (line != "object_a,triangle_a,object_b,triangle_b,shared")
    lines.fail("the first line is not object_a,triangle_a,object_b,triangle_b,shared");
  while (lines.next(line)) {
    const SuiteMeshPair row = parse_row(lines, line, mesh);
    if (!mesh.pairs.empty() && !(mesh.pairs.back().pair < row.pair))
      lines.fail("the pairs do not ascend");
    mesh.pairs.push_back(row);
  }
}

// suite.txt.

SuiteIndex::File parse_file(const Lines& lines, const std::vector<std::string_view>& words) {
  if (words.size() != 5) lines.fail("the line is not 'file PATH BYTES SHA256 ITEMS'");
  const SuiteIndex::File out{std::string(words[1]), lines.number<std::uint64_t>(words[2], "bytes"),
                             std::string(words[3]), lines.number<std::uint64_t>(words[4], "items")};
  if (out.path.starts_with('/') || out.path.find("..") != std::string::npos)
    lines.fail("the path leads out of the folder");
  return out;
}

}  // namespace

std::string to_string(SuiteKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

std::optional<SuiteKind> parse_suite_kind(std::string_view name) {
  const auto* const at = std::find(kKinds.begin(), kKinds.end(), name);
  if (at == kKinds.end()) return std::nullopt;
  return static_cast<SuiteKind>(at - kKinds.begin());
}

bool collides(SuiteKind kind) {
  return kind != SuiteKind::apart && kind != SuiteKind::neighbours_apart;
}

void ListLine::fail(const std::string& reason) const { throw Error(list, reason, kAgain, number); }

std::vector<double> ListLine::coordinates(std::size_t from) const {
  std::vector<double> out;
  for (; from < words.size(); ++from) {
    const std::optional<double> value = parse_hexadecimal(words[from]);
    if (!value)
      fail(quote_token(words[from]) + " is no finite hexadecimal number, such as 0x1.8p+1");
    out.push_back(*value);
  }
  return out;
}

std::string read_list(std::string_view text, const std::string& name, const std::string& kind,
                      const std::function<void(const ListLine&)>& take) {
  Lines lines(text, name);
  std::string_view line;
  lines.next(line);
  const std::vector<std::string_view> head = words_of(line);
  if (head.size() != 3 || head[0] != kind || head[1] != "1")
    lines.fail(fmt::format("the first line is not '{} 1 FAMILY'", kind));
  for (std::uint64_t id = 0; lines.next(line);) {
    if (line.starts_with('#')) continue;
    ListLine out{name, lines.line(), id, 0, words_of(line)};
    if (out.words.size() < 4) lines.fail("the line has fewer than four words");
    if (out.words[0] != std::to_string(id))
      lines.fail(fmt::format("the line is called {} and should be {}", out.words[0], id));
    out.parameter = lines.number<double>(out.words[1], "the parameter");
    take(out);
    ++id;
  }
  return std::string(head[2]);
}

SuitePairs parse_pairs(std::string_view text, const std::string& name) {
  SuitePairs out;
  out.family = read_list(text, name, "farcull-pairs",
                         [&](const ListLine& line) { out.pairs.push_back(parse_pair(line)); });
  return out;
}

SuitePairs read_pairs(const std::string& path) {
  return parse_pairs(read_file(path, kAnyBytes), path);
}

std::uint32_t shared_vertices(const Scene& scene, const TrianglePair& pair) {
  const std::array<std::uint32_t, 3>& a = scene.triangles[pair.a];
  const std::array<std::uint32_t, 3>& b = scene.triangles[pair.b];
  std::uint32_t out = 0;
  for (int i = 0; i < 3; ++i) {
    const bool repeated = std::find(a.begin(), a.begin() + i, a[i]) != a.begin() + i;
    out += !repeated && std::find(b.begin(), b.end(), a[i]) != b.end();
  }
  return out;
}

SuiteMesh read_mesh(const std::string& folder) {
  SuiteMesh out;
  const fs::path path(folder);
  out.name = (path.has_filename() ? path : path.parent_path()).filename().string();
  read_properties(folder + "/mesh.txt", out);
  out.scene = read_objects(folder, out);
  out.labelled = fs::exists(folder + "/pairs.csv");
  if (out.labelled) read_colliding(folder + "/pairs.csv", out);
  return out;
}

SuiteIndex parse_suite(std::string_view text, const std::string& name) {
  Lines lines(text, name);
  SuiteIndex out;
  std::string_view line;
  lines.next(line);
  if (line != "farcull-suite 1") lines.fail("the first line is not 'farcull-suite 1'");
  out.seed = lines.number<std::uint64_t>(lines.word_after("seed"), "the seed");
  out.size = lines.word_after("size");
  out.licence = lines.word_after("licence");
  while (lines.next(line) && line.starts_with("file ")) {
    SuiteIndex::File file = parse_file(lines, words_of(line));
    if (!out.files.empty() && !(out.files.back().path < file.path))
      lines.fail("the paths do not ascend");
    out.files.push_back(std::move(file));
  }
  const auto before = static_cast<std::size_t>(line.data() - text.data());
  if (line != "sum " + sha256(text.substr(0, before)))
    lines.fail("the sum is not that of the lines before it");
  out.sum = line.substr(4);
  if (lines.next(line)) lines.fail("there are lines after the sum");
  return out;
}

SuiteIndex read_suite(const std::string& folder) {
  const std::string path = folder + "/suite.txt";
  return parse_suite(read_file(path, kAnyBytes), path);
}

std::vector<std::string> SuiteIndex::pair_files() const {
  std::vector<std::string> out;
  for (const File& file : files) {
    if (file.path.starts_with("pairs/")) out.push_back(file.path);
  }
  return out;
}

std::vector<std::string> SuiteIndex::mesh_folders() const {
  constexpr std::string_view kFile = "/mesh.txt";
  std::vector<std::string> out;
  for (const File& file : files) {
    if (file.path.starts_with("meshes/") && file.path.ends_with(kFile))
      out.push_back(file.path.substr(0, file.path.size() - kFile.size()));
  }
  return out;
}

void check_files(const std::string& folder, const SuiteIndex& index) {
  for (const SuiteIndex::File& file : index.files) {
    const std::string path = folder + "/" + file.path;
    const std::string text = read_file(path, kAnyBytes);
    if (text.size() != file.bytes) {
      throw Error(path, fmt::format("has {} bytes; suite.txt says {}", text.size(), file.bytes),
                  kAgain);
    }
    if (sha256(text) != file.sha256)
      throw Error(path, "its SHA-256 is not the one of suite.txt, so it was changed", kAgain);
  }
  std::vector<std::string> there;
  for (const char* part : {"pairs", "meshes", "questions"}) {
    std::error_code error;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(folder + "/" + part, error)) {
      if (!entry.is_directory())
        there.push_back(std::filesystem::relative(entry.path(), folder).generic_string());
    }
  }
  std::sort(there.begin(), there.end());
  for (const std::string& path : there) {
    const auto named = [&](const SuiteIndex::File& file) { return file.path == path; };
    if (!std::any_of(index.files.begin(), index.files.end(), named))
      throw Error(folder + "/" + path, "is no file of the suite", "move it elsewhere");
  }
}

std::optional<double> parse_hexadecimal(std::string_view word) {
  const bool negative = word.starts_with('-');
  if (negative) word.remove_prefix(1);
  if (!word.starts_with("0x")) return std::nullopt;
  word.remove_prefix(2);
  // from_chars would accept a second sign, and also inf and nan.
  if (word.empty() || word[0] == '-' || word[0] == 'i' || word[0] == 'n') return std::nullopt;
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [rest, code] = std::from_chars(word.data(), end, value, std::chars_format::hex);
  if (code != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
  return negative ? -value : value;
}

void append_hexadecimal(std::string& text, double value) {
  std::array<char, 40> buffer;
  if (std::signbit(value)) text += '-';
  const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(),
                                         std::abs(value), std::chars_format::hex);
  text += "0x";
  text.append(buffer.data(), end);
}

}  // namespace farcull
