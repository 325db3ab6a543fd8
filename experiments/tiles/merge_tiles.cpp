// Merges sorted lists. A priority queue holds the next line of each list.
#include <fmt/format.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <queue>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/output_file.h"
#include "experiments/tiles/run_tile.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kAgain = "run the tile again";

// The record of a tile (JSON), and the values of the record that the merge uses.
struct Source {
  std::string path;
  Json json;
  std::uint64_t k = 0, n = 0, rows = 0, home = 0;
  std::string list, columns, sha256;
};

[[noreturn]] void no_record(const std::string& path, const std::string& reason) {
  throw Error(path, reason,
              "give the files that farcull run SCENE --tiles K/N --json FILE --pairs LIST wrote");
}

// Returns the value at a JSON pointer such as /tile/k. Throws Error if there is no such value, or
// if the value has another type.
template <class Value>
Value at(const Source& source, const char* place) {
  try {
    const Json& value = source.json.at(nlohmann::ordered_json::json_pointer(place));
    // get() would round a fraction, and turn a negative number into a large one.
    if (!std::is_same_v<Value, std::uint64_t> || value.is_number_unsigned())
      return value.get<Value>();
  } catch (const nlohmann::json::exception&) {
    // The error is thrown below.
  }
  no_record(source.path, fmt::format("is no record of a tile: {} is missing or wrong", place));
}

Source read_record(const std::string& path) {
  Source out;
  out.path = path;
  out.json = Json::parse(read_file(path, std::uint64_t{1} << 30), nullptr, false);
  if (out.json.is_discarded()) no_record(path, "is no JSON, or was cut short");
  if (!out.json.is_object() || !out.json.contains("tile"))
    no_record(path, "is no record of a tile: it has no entry `tile`");
  out.k = at<std::uint64_t>(out, "/tile/k");
  out.n = at<std::uint64_t>(out, "/tile/n");
  out.home = at<std::uint64_t>(out, "/tile/home_triangles");
  if (out.k < 1 || out.k > out.n || out.n > kMostTiles)
    no_record(path, fmt::format("says that it is tile {} of {}", out.k, out.n));
  if (at<Json>(out, "/tile/list").is_null()) {
    throw Error(path, "has no list: the tile was run without --pairs FILE",
                "run it again with --pairs FILE and --json FILE");
  }
  out.rows = at<std::uint64_t>(out, "/tile/list/rows");
  out.columns = at<std::string>(out, "/tile/list/columns");
  out.sha256 = at<std::string>(out, "/tile/list/sha256");
  const fs::path list(at<std::string>(out, "/tile/list/file"));
  out.list = (fs::path(path).parent_path() / list).string();
  std::error_code code;
  if (!fs::exists(out.list, code)) {
    throw Error(out.list, fmt::format("does not exist, and {} names it", path),
                "put the list where it was, beside the record");
  }
  return out;
}

// Throws Error if two records differ in the scene, the tiles, the method or the options.
void require_alike(const Source& first, const Source& other) {
  const std::pair<const char*, const char*> places[] = {
      {"/scene", "is of another scene"},
      {"/tile/n", "is of another number of tiles"},
      {"/tile/axis", "is cut along another axis"},
      {"/tile/cuts", "is cut elsewhere"},
      {"/method", "is of another method"},
      {"/tile/options", "was run with other options"},
      {"/tile/list/columns", "has other columns in its list"},
      {"/tile/list/kinds", "has other kinds of contact in its list"},
      {"/commit", "is of another version of farcull"}};
  for (const auto& [place, what] : places) {
    if (at<Json>(first, place) == at<Json>(other, place)) continue;
    throw Error(other.path, fmt::format("{} than {}", what, first.path),
                "run all tiles of one scene with one program and the same options");
  }
}

// Throws Error if a tile is given twice or not at all, or if a triangle is in no tile.
void require_whole(const std::vector<Source>& sources) {
  const Source& first = sources.front();
  std::vector<const Source*> tiles(first.n, nullptr);
  for (const Source& source : sources) {
    const Source*& place = tiles.at(source.k - 1);
    if (place != nullptr) {
      throw Error(source.path,
                  fmt::format("is tile {} of {}, and so is {}", source.k, source.n, place->path),
                  "leave one of them out");
    }
    place = &source;
  }
  std::string missing;
  std::size_t count = 0;
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    if (tiles[k] != nullptr) continue;
    if (++count <= 5) missing += fmt::format("{}{}", missing.empty() ? "" : ", ", k + 1);
  }
  if (count > 0) {
    throw Error(first.path,
                fmt::format("of its {} tiles {} missing: {}{}", first.n,
                            count == 1 ? "one is" : fmt::format("{} are", count), missing,
                            count > 5 ? ", ..." : ""),
                fmt::format("run them too, as --tiles {}/{}, and name all records",
                            missing.substr(0, missing.find(',')), first.n));
  }
  std::uint64_t home = 0;
  for (const Source& source : sources) home += source.home;
  const auto all = at<std::uint64_t>(first, "/scene/triangles");
  if (home != all) {
    throw Error(first.path, fmt::format("the tiles together hold {} of {} triangles", home, all),
                kAgain);
  }
}

// Reads a list once, from its beginning to its end.
class List {
 public:
  explicit List(const Source& source) : source_(&source), file_(source.list, std::ios::binary) {
    if (!next_line() || line_ != source.columns) fail("does not begin as its record says");
  }

  // Reads the next row. Returns false at the end of the list. There, throws Error if the number of
  // rows or the hash of the list is not that of the record.
  bool next() {
    const std::array<std::uint64_t, 4> before = key_;
    if (!next_line()) {
      if (rows_ != source_->rows || hash_.digest() != source_->sha256)
        fail("is not the list that the tile wrote: it was cut short or changed");
      return false;
    }
    read_key();
    if (rows_++ > 0 && !(before < key_)) fail("is not sorted");
    return true;
  }
  // Returns the numbers of object a, triangle a, object b and triangle b, in this order.
  const std::array<std::uint64_t, 4>& key() const { return key_; }
  const std::string& line() const { return line_; }

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(source_->list, reason, kAgain, static_cast<long>(lines_));
  }

 private:
  bool next_line() {
    if (!std::getline(file_, line_)) {
      if (!file_.eof()) fail("cannot be read to its end");
      return false;
    }
    if (file_.eof()) fail("ends within a line: it was cut short");
    ++lines_;
    hash_.add(line_);
    hash_.add("\n");
    return true;
  }

  void read_key() {
    std::string_view rest = line_;
    for (std::size_t i = 0; i < key_.size(); ++i) {
      if (i > 0 && !rest.starts_with(',')) fail("holds a line that is no pair");
      if (i > 0) rest.remove_prefix(1);
      const auto number = take_number<std::uint64_t>(rest);
      if (!number) fail("holds a line that is no pair");
      key_[i] = *number;
    }
    if (!rest.empty() && rest.front() != ',') fail("holds a line that is no pair");
  }

  const Source* source_;
  std::ifstream file_;
  std::string line_;
  std::uint64_t rows_ = 0, lines_ = 0;
  std::array<std::uint64_t, 4> key_{};
  Sha256 hash_;
};

std::uint64_t merge_lists(const std::vector<Source>& sources, const std::string& out) {
  StreamedOutput file(out);
  std::string piece = sources.front().columns + "\n";
  // Raises the limit of open files, since all lists are open at once.
  if (rlimit files{}; ::getrlimit(RLIMIT_NOFILE, &files) == 0) {
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
  }
  std::vector<List> lists;
  const auto later = [&](std::size_t a, std::size_t b) { return lists[a].key() > lists[b].key(); };
  std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> next(later);
  for (const Source& source : sources) {
    lists.emplace_back(source);
    if (lists.back().next()) next.push(lists.size() - 1);
  }
  std::uint64_t rows = 0;
  std::optional<std::array<std::uint64_t, 4>> last;
  while (!next.empty()) {
    const std::size_t index = next.top();
    next.pop();
    List& list = lists[index];
    if (last == list.key()) list.fail("holds a pair that the list of another tile holds as well");
    last = list.key();
    piece.append(list.line()).push_back('\n');
    ++rows;
    if (piece.size() >= (std::size_t{1} << 20)) {
      file.add(piece);
      piece.clear();
    }
    if (list.next()) next.push(index);
  }
  file.add(piece);
  file.put();
  return rows;
}

void require_other_files(const std::vector<Source>& sources, const std::string& out) {
  for (const Source& source : sources) {
    for (const std::string& read : {source.path, source.list}) {
      std::error_code code;
      if (fs::equivalent(read, out, code)) {
        throw Error(out, "is " + read + ", which is read, and would be overwritten",
                    "choose another place for it");
      }
    }
  }
}

}  // namespace

bool is_tile_record(const std::string& path) { return fs::path(path).extension() == ".json"; }

MergedTiles merge_tiles(const std::vector<std::string>& records, const std::string& out) {
  std::vector<Source> sources;
  for (const std::string& record : records) {
    sources.push_back(read_record(record));
    require_alike(sources.front(), sources.back());
  }
  if (sources.empty()) no_record("SHARDS", "no record is named");
  require_whole(sources);
  require_other_files(sources, out);
  MergedTiles merged{.tiles = sources.size(), .verified = true};
  for (const Source& source : sources) {
    merged.guaranteed = merged.guaranteed && at<bool>(source, "/promises");
    if (at<Json>(source, "/verification").is_object())
      merged.false_negatives += at<std::uint64_t>(source, "/verification/false_negatives");
    else
      merged.verified = false;
  }
  merged.rows = merge_lists(sources, out);
  return merged;
}

}  // namespace farcull
