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

constexpr const char* kFormat = "docs/suite.md has the format; write the suite again";
constexpr const char* kAgain = "write the suite again, as in farcull suite DIR";
constexpr std::uint64_t kAnyBytes = std::numeric_limits<std::uint64_t>::max();

/// Removes the next word from `line`, with the blanks before it, and returns it. Empty at the end.
std::string_view take_word(std::string_view& line) {
  constexpr std::string_view kBlanks = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

/// The lines of a text one by one, with their numbers.
class Lines {
 public:
  /// `name` stands for the file in errors. Throws Error if the text does not end with a newline.
  Lines(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {
    if (text.empty() || text.back() != '\n') {
      throw Error(name_, "the file does not end with a newline, so its end may be missing",
                  "write or download it again");
    }
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
  std::string word_after(std::string_view key, const char* remedy) {
    std::string_view line;
    if (!next(line) || take_word(line) != key)
      fail(fmt::format("the line does not begin with '{}'", key), remedy);
    const std::string out(take_word(line));
    if (out.empty() || !take_word(line).empty())
      fail(fmt::format("there is not one word after '{}'", key), remedy);
    return out;
  }
  long number() const { return number_; }  // of the line read last, from 1
  /// Throws Error naming the file and the line read last.
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const {
    throw Error(name_, reason, remedy, number_);
  }

 private:
  std::string_view rest_;
  std::string name_;
  long number_ = 0;
};

template <class T>
T number(const Lines& lines, std::string_view word, const char* called) {
  const std::optional<T> value = parse_number<T>(word);
  if (!value || (std::is_floating_point_v<T> && !std::isfinite(static_cast<double>(*value))))
    lines.fail(fmt::format("{} is no number for {}", quote_token(word), called), kFormat);
  return *value;
}

bool is_corner(char c) { return c >= '0' && c <= '2'; }

/// "0-1,2-0", ascending.
std::vector<SharedCorner> parse_shared(const Lines& lines, std::string_view word) {
  std::vector<SharedCorner> out;
  if (word == "-") return out;
  for (std::string_view rest = word;;) {
    if (rest.size() < 3 || !is_corner(rest[0]) || rest[1] != '-' || !is_corner(rest[2]) ||
        (rest.size() > 3 && rest[3] != ',')) {
      lines.fail(quote_token(word) + " names no shared corners",
                 "give - for none, or corners from 0 to 2 as in 0-1,2-0");
    }
    const SharedCorner next{static_cast<std::uint8_t>(rest[0] - '0'),
                            static_cast<std::uint8_t>(rest[2] - '0')};
    if (!out.empty() && next <= out.back())
      lines.fail("the shared corners do not ascend", "sort them, each once");
    out.push_back(next);
    if (rest.size() == 3) return out;
    rest.remove_prefix(4);
  }
}

Vec3 parse_point(const Lines& lines, std::string_view& line) {
  Vec3 out;
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = take_word(line);
    if (word.empty()) lines.fail("the line has fewer than 18 coordinates", kFormat);
    const std::optional<double> value = parse_hexadecimal(word);
    if (!value) {
      lines.fail(quote_token(word) + " is no finite hexadecimal number",
                 "write coordinates as C's %a does, such as 0x1.8p+1");
    }
    out[k] = *value;
  }
  return out;
}

void check_pair(const Lines& lines, const SuitePair& pair) {
  for (const auto& [i, j] : pair.shared) {
    if (pair.a[i] == pair.b[j]) continue;
    lines.fail(fmt::format("corners {}-{} are called shared, but their coordinates differ", i, j),
               kFormat);
  }
  if (pair.kind == SuiteKind::unlabelled) return;
  const bool of_neighbours =
      pair.kind == SuiteKind::neighbours_meet || pair.kind == SuiteKind::neighbours_apart;
  if (of_neighbours != !pair.shared.empty()) {
    lines.fail(fmt::format("the kind {} is for triangles {} shared corners", to_string(pair.kind),
                           of_neighbours ? "with" : "without"),
               kFormat);
  }
}

SuitePair parse_pair(const Lines& lines, std::string_view line) {
  SuitePair out;
  out.line = lines.number();
  out.id = number<std::uint64_t>(lines, take_word(line), "the pair");
  out.parameter = number<double>(lines, take_word(line), "the parameter");
  out.shared = parse_shared(lines, take_word(line));
  const std::string_view kind = take_word(line);
  const std::optional<SuiteKind> known = parse_suite_kind(kind);
  if (!known) lines.fail(quote_token(kind) + " is no kind of contact", kFormat);
  out.kind = *known;
  for (auto* t : {&out.a, &out.b}) {
    for (Vec3& p : *t) p = parse_point(lines, line);
  }
  if (!take_word(line).empty()) lines.fail("the line has more than 18 coordinates", kFormat);
  check_pair(lines, out);
  return out;
}

// The folder of a mesh.

void read_properties(const std::string& path, SuiteMesh& mesh) {
  const std::string text = read_file(path, kAnyBytes);
  Lines lines(text, path);
  const std::string self = lines.word_after("self", kFormat);
  if (self != "yes" && self != "no")
    lines.fail(quote_token(self) + " is neither yes nor no", kFormat);
  mesh.self = self == "yes";
  const std::string parameter = lines.word_after("parameter", kFormat);
  const std::optional<double> number = parse_number<double>(parameter);
  if (!number) lines.fail(quote_token(parameter) + " is no number", kFormat);
  mesh.parameter = *number;
  mesh.family = lines.word_after("family", kFormat);
  for (std::string_view line; lines.next(line);) {
    if (!line.starts_with("# "))
      lines.fail("after three lines there is one that is no comment", kFormat);
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
        throw Error(path, fmt::format("face {} is no triangle", object.source_face[t]), kFormat);
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
      lines.fail("the line is not five whole numbers with commas between them", kFormat);
    cells[i] = *value;
    line.remove_prefix(std::min(line.size(), cell.size() + 1));
  }
  const auto triangle = [&](std::uint32_t object, std::uint32_t row) {
    if (object >= mesh.scene.objects.size() || row >= mesh.scene.objects[object].triangle_count)
      lines.fail(fmt::format("object {} has no triangle {}", object, row), kFormat);
    return mesh.scene.objects[object].first_triangle + row;
  };
  const SuiteMeshPair out{{triangle(cells[0], cells[1]), triangle(cells[2], cells[3])}, cells[4]};
  if (out.pair.a >= out.pair.b) lines.fail("the first triangle is not before the second", kFormat);
  const bool one_object = cells[0] == cells[2];
  if (one_object && !mesh.self)
    lines.fail("the triangles are of one object, which is not tested against itself", kFormat);
  const std::uint32_t shared = one_object ? shared_vertices(mesh.scene, out.pair) : 0;
  if (out.shared != shared)
    lines.fail(fmt::format("the triangles share {} vertices, not {}", shared, out.shared), kFormat);
  return out;
}

void read_colliding(const std::string& path, SuiteMesh& mesh) {
  const std::string text = read_file(path, kAnyBytes);
  Lines lines(text, path);
  std::string_view line;
  lines.next(line);
  if (line != "object_a,triangle_a,object_b,triangle_b,shared")
    lines.fail("the first line is not object_a,triangle_a,object_b,triangle_b,shared", kFormat);
  while (lines.next(line)) {
    const SuiteMeshPair row = parse_row(lines, line, mesh);
    if (!mesh.pairs.empty() && !(mesh.pairs.back().pair < row.pair))
      lines.fail("the pairs do not ascend", kFormat);
    mesh.pairs.push_back(row);
  }
}

// suite.txt.

std::uint64_t whole(const Lines& lines, std::string_view word) {
  const std::optional<std::uint64_t> value = parse_number<std::uint64_t>(word);
  if (!value) lines.fail(quote_token(word) + " is no whole number", kAgain);
  return *value;
}

bool is_sum(std::string_view word) {
  return word.size() == 64 && word.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Whether the path is relative to the folder and does not lead out of it.
bool is_inner_path(std::string_view path) {
  return !path.empty() && path[0] != '/' && path.find("..") == std::string_view::npos;
}

SuiteIndex::File parse_file(const Lines& lines, std::string_view line) {
  SuiteIndex::File out;
  out.path = take_word(line);
  out.bytes = whole(lines, take_word(line));
  out.sha256 = take_word(line);
  out.items = whole(lines, take_word(line));
  if (!is_inner_path(out.path) || !is_sum(out.sha256) || !take_word(line).empty())
    lines.fail("the line is not 'file PATH BYTES SHA256 ITEMS'", kAgain);
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

SuitePairs parse_pairs(std::string_view text, const std::string& name) {
  Lines lines(text, name);
  SuitePairs out;
  std::string_view line;
  lines.next(line);
  if (take_word(line) != "farcull-pairs" || take_word(line) != "1")
    lines.fail("the first line is not 'farcull-pairs 1 FAMILY'", "give a file of pairs, version 1");
  out.family = take_word(line);
  if (out.family.empty() || !take_word(line).empty())
    lines.fail("the first line is not 'farcull-pairs 1 FAMILY'", "give a file of pairs, version 1");
  while (lines.next(line)) {
    if (line.starts_with('#')) continue;
    SuitePair pair = parse_pair(lines, line);
    if (pair.id != out.pairs.size()) {
      lines.fail(fmt::format("the pair is called {} and should be {}", pair.id, out.pairs.size()),
                 "pairs count from 0; write the suite again if a line is missing");
    }
    out.pairs.push_back(std::move(pair));
  }
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
  if (line != "farcull-suite 1")
    lines.fail("the first line is not 'farcull-suite 1'", "give the folder of a suite, version 1");
  out.seed = whole(lines, lines.word_after("seed", kAgain));
  out.size = lines.word_after("size", kAgain);
  out.licence = lines.word_after("licence", kAgain);
  while (lines.next(line)) {
    const std::size_t before = static_cast<std::size_t>(line.data() - text.data());
    const std::string_view key = take_word(line);
    if (key == "file") {
      SuiteIndex::File file = parse_file(lines, line);
      if (!out.files.empty() && !(out.files.back().path < file.path))
        lines.fail("the paths do not ascend", kAgain);
      out.files.push_back(std::move(file));
      continue;
    }
    if (key != "sum") lines.fail(quote_token(key) + " is no word of a suite", kAgain);
    out.sum = take_word(line);
    if (out.sum != sha256(text.substr(0, before)))
      lines.fail("the sum is not that of the lines before it", kAgain);
    if (lines.next(line)) lines.fail("there are lines after the sum", kAgain);
    return out;
  }
  lines.fail("the last line is not 'sum SHA256', so the end of the file is missing", kAgain);
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
