// The readers go through a text line by line, so that every error has its line.
#include "experiments/suite/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "core/base/text.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/suite/words.h"

namespace farcull {
namespace {

constexpr std::array<const char*, 10> kKinds = {
    "apart",    "touch-vertex", "touch-edge",      "touch-face",       "crossing",
    "coplanar", "equal",        "neighbours-meet", "neighbours-apart", "?"};

constexpr const char* kFormat = "docs/suite.md has the format; write the suite again";

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
  return parse_pairs(read_file(path, std::numeric_limits<std::uint64_t>::max()), path);
}

}  // namespace farcull
