// Makes the list line by line, so hashing needs memory only for one line and for the owners of the
// triangles. A list from a file is compared with the scene and with the pairs that meet.
#include "verify/certificate/pair_list.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {
namespace {

bool share_corner(const Scene& scene, const TrianglePair& pair) {
  const std::array<Vec3, 3> a = scene.corners(pair.a), b = scene.corners(pair.b);
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

std::string in_quotes(std::string_view text) { return "'" + printable(text, 40) + "'"; }

/// Divides a CSV text into lines, and the lines into cells.
class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& name) : text_(text), name_(name) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(name_, reason,
                "give a list as `{run} {pairs} FILE` writes it: first a line "
                "object_a,triangle_a,object_b,triangle_b, then these four numbers for each pair",
                static_cast<long>(line_));
  }

  /// Reads the cells of the next line that is not empty. Returns false at the end of the text.
  bool next(std::vector<std::string>& cells) {
    std::string_view line;
    do {
      if (text_.empty()) return false;
      ++line_;
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      line = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      if (line.ends_with('\r')) line.remove_suffix(1);
    } while (line.empty());
    cells.clear();
    do {
      cells.push_back(cell(line));
    } while (take(line, ','));
    if (!line.empty()) fail("after the quotes of a cell stands " + in_quotes(line));
    return true;
  }
  std::uint64_t line() const { return line_; }

 private:
  static bool take(std::string_view& text, char c) {
    if (!text.starts_with(c)) return false;
    text.remove_prefix(1);
    return true;
  }
  std::string cell(std::string_view& line) const {
    if (!take(line, '"')) {
      const std::size_t end = std::min(line.find(','), line.size());
      std::string out(line.substr(0, end));
      line.remove_prefix(end);
      return out;
    }
    std::string out;  // two adjacent quotes stand for one quote
    for (;;) {
      const std::size_t end = line.find('"');
      if (end == std::string_view::npos) fail("the quotes of a cell are not closed on their line");
      out += line.substr(0, end);
      line.remove_prefix(end + 1);
      if (!take(line, '"')) return out;
      out += '"';
    }
  }

  std::string_view text_;
  const std::string& name_;
  std::uint64_t line_ = 0;
};

constexpr std::array kNames = {"object_a",   "triangle_a", "object_b",
                               "triangle_b", "frame",      "neighbours"};
constexpr std::size_t kNeeded = 4, kFrame = 4, kNeighboursColumn = 5;

}  // namespace

std::string pair_list_header(bool self) {
  return std::string("object_a,triangle_a,object_b,triangle_b") + (self ? ",neighbours\n" : "\n");
}

PairListRows::PairListRows(const Scene& scene, const ListNumbers* numbers)
    : scene_(scene),
      numbers_(numbers),
      owner_(owners(scene)),
      self_(numbers ? numbers->self : has_self(scene)) {}

void PairListRows::append(const TrianglePair& pair, std::string& text) const {
  const std::uint32_t a = owner_[pair.a];
  const std::uint32_t b = owner_[pair.b];
  const auto object = [&](std::uint32_t o) -> std::uint64_t {
    return numbers_ ? numbers_->objects[o] : o;
  };
  const auto triangle = [&](std::uint32_t t, std::uint32_t o) -> std::uint64_t {
    return numbers_ ? numbers_->triangles[t] : t - scene_.objects[o].first_triangle;
  };
  std::array<char, 4 * 21> numbers;  // at most 20 digits and a comma for each number
  char* end = numbers.data();
  for (const std::uint64_t number :
       {object(a), triangle(pair.a, a), object(b), triangle(pair.b, b)}) {
    end = std::to_chars(end, numbers.data() + numbers.size(), number).ptr;
    *end++ = ',';
  }
  text.append(numbers.data(), end);
  if (self_) {
    text += a == b && share_corner(scene_, pair) ? "1\n" : "0\n";
  } else {
    text.back() = '\n';
  }
}

std::string pair_list(const Scene& scene, std::span<const TrianglePair> pairs) {
  std::string out = pair_list_header(has_self(scene));
  const PairListRows rows(scene);
  for (const TrianglePair& pair : pairs) rows.append(pair, out);
  return out;
}

std::string pair_list_hash(const Scene& scene, std::span<const TrianglePair> pairs,
                           const ListNumbers* numbers) {
  Sha256 hash;
  hash.add(pair_list_header(numbers ? numbers->self : has_self(scene)));
  const PairListRows rows(scene, numbers);
  std::string line;
  for (const TrianglePair& pair : pairs) {
    line.clear();
    rows.append(pair, line);
    hash.add(line);
  }
  return hash.digest();
}

GivenList read_pair_list(std::string_view text, const std::string& name) {
  GivenList out;
  out.name = name;
  CsvReader reader(text, name);
  std::vector<std::string> cells;
  if (!reader.next(cells)) reader.fail("the file is empty");
  std::array<std::optional<std::size_t>, kNames.size()> columns;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto known = std::ranges::find(kNames, cells[c]);
    if (known == kNames.end()) {
      out.not_looked_at.push_back(cells[c]);
      continue;
    }
    std::optional<std::size_t>& column = columns[static_cast<std::size_t>(known - kNames.begin())];
    if (column) reader.fail("the column " + cells[c] + " is named twice");
    column = c;
  }
  for (std::size_t n = 0; n < kNeeded; ++n) {
    if (!columns[n]) reader.fail(std::string("the first line names no column ") + kNames[n]);
  }
  const std::size_t width = cells.size();
  out.has_frames = columns[kFrame].has_value();
  const auto number = [&](std::size_t n) {
    const std::string& cell = cells[*columns[n]];
    const std::optional<std::uint32_t> value = parse_number<std::uint32_t>(cell);
    if (!value)
      reader.fail(std::string(kNames[n]) + " is " + in_quotes(cell) + ", no whole number");
    return *value;
  };
  while (reader.next(cells)) {
    if (cells.size() != width) {
      reader.fail("the line has " + std::to_string(cells.size()) + " cells, and the first has " +
                  std::to_string(width));
    }
    ListedPair row;
    row.line = reader.line();
    row.object = {number(0), number(2)};
    row.triangle = {number(1), number(3)};
    if (out.has_frames) row.frame = number(kFrame);
    if (columns[kNeighboursColumn]) {
      const std::uint32_t neighbours = number(kNeighboursColumn);
      if (neighbours > 1) reader.fail("neighbours is neither 0 nor 1");
      row.neighbours = neighbours == 1;
    }
    out.rows.push_back(row);
  }
  return out;
}

TrianglePair pair_of(const Scene& scene, const std::string& name, const ListedPair& row) {
  std::array<std::uint32_t, 2> t{};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto fail = [&](const std::string& reason) {
      throw Error(name, reason, "give the list and the scene that belong together",
                  static_cast<long>(row.line));
    };
    if (row.object[k] >= scene.objects.size()) {
      fail("there is no object " + std::to_string(row.object[k]) + ": the scene has " +
           std::to_string(scene.objects.size()) + ", from 0 on");
    }
    const Object& object = scene.objects[row.object[k]];
    if (row.triangle[k] >= object.triangle_count) {
      fail("object " + std::to_string(row.object[k]) + " has no triangle " +
           std::to_string(row.triangle[k]) + ": it has " + std::to_string(object.triangle_count) +
           ", from 0 on");
    }
    t[k] = object.first_triangle + row.triangle[k];
  }
  return {std::min(t[0], t[1]), std::max(t[0], t[1])};
}

ListDifferences find_differences(const Scene& scene, const std::string& name,
                                 std::span<const ListedPair> rows,
                                 std::span<const TrianglePair> meeting, double clearance) {
  ListDifferences out;
  out.listed = rows.size();
  const auto wrong = [&](std::uint64_t line, const TrianglePair& pair, std::string why) {
    if (out.wrong++ > 0 && out.wrong_line <= line) return;
    out.wrong_line = line;
    out.wrong_reason = std::move(why);
    out.wrong_pair = pair.a == pair.b ? std::nullopt : std::optional(pair);
  };
  struct Meeting {  // a row whose pair meets
    TrianglePair pair;
    std::uint64_t line;
    bool wrong;  // true: the row has a wrong value of `neighbours`
    auto operator<=>(const Meeting&) const = default;
  };
  std::vector<Meeting> listed;
  for (const ListedPair& row : rows) {
    const TrianglePair pair = pair_of(scene, name, row);
    const bool one_object = row.object[0] == row.object[1];
    if (pair.a == pair.b) {
      wrong(row.line, pair, "the line names one triangle twice");
    } else if (one_object && !scene.objects[row.object[0]].self) {
      wrong(row.line, pair,
            spelled("the pair is of one object that is not tested against itself ({self} asks)"));
    } else if (std::ranges::binary_search(scene.ignored,
                                          ObjectPair{std::min(row.object[0], row.object[1]),
                                                     std::max(row.object[0], row.object[1])})) {
      wrong(row.line, pair, "the pair is of two objects that are ignored");
    } else if (!std::binary_search(meeting.begin(), meeting.end(), pair)) {
      wrong(row.line, pair,
            one_object && share_corner(scene, pair)
                ? "the pair is of neighbours that share only vertices or an edge"
            : clearance > 0 ? "the pair is farther apart than the clearance"
                            : "the pair is disjoint");
    } else {
      const bool neighbours = one_object && share_corner(scene, pair);
      listed.push_back({pair, row.line, row.neighbours && *row.neighbours != neighbours});
      if (listed.back().wrong) {
        wrong(row.line, pair,
              neighbours ? "the triangles are neighbours, and the line says 0"
                         : "the triangles are no neighbours, and the line says 1");
      }
    }
  }
  std::sort(listed.begin(), listed.end());
  for (std::size_t i = 1; i < listed.size(); ++i) {
    if (listed[i].pair != listed[i - 1].pair || listed[i].wrong) continue;
    wrong(listed[i].line, listed[i].pair,
          "the pair is that of line " + std::to_string(listed[i - 1].line) + " again");
  }
  auto at = listed.begin();
  for (const TrianglePair& pair : meeting) {
    while (at != listed.end() && at->pair < pair) ++at;
    if (at != listed.end() && at->pair == pair) continue;
    if (out.missing++ == 0) out.missing_pair = pair;
  }
  return out;
}

}  // namespace farcull
