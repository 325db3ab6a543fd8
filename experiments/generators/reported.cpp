// The cases of public trackers: reads the table reported.txt, which is part of the program, and
// makes families of it. The table has its format at its top.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/base/text.h"
#include "embedded/reported_txt.h"
#include "experiments/generators/pair_generators.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {
namespace {

using Words = std::vector<std::string_view>;
using Numbers = std::vector<double>;

/// Removes what is before the first `end` from the text, and this end, and returns it.
std::string_view take_until(std::string_view& text, char end) {
  const std::size_t at = std::min(text.find(end), text.size());
  const std::string_view out = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return out;
}

Words words_of(std::string_view text) {
  Words out;
  while (!text.empty()) {
    const std::string_view word = take_until(text, ' ');
    if (!word.empty()) out.push_back(word);
  }
  return out;
}

/// Empty if a word is no number.
std::optional<Numbers> numbers_of(const Words& words) {
  Numbers out;
  for (const std::string_view word : words) {
    const std::optional<double> value = parse_number<double>(word);
    if (!value) return std::nullopt;
    out.push_back(*value);
  }
  return out;
}

std::vector<Vec3> points_of(const Numbers& numbers) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    out.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return out;
}

/// A prism from z = numbers[0] to numbers[1] over the convex polygon that follows.
SuiteObject prism(const Numbers& numbers) {
  SuiteObject out;
  for (std::size_t i = 2; i + 1 < numbers.size(); i += 2) {
    out.vertices.emplace_back(numbers[i], numbers[i + 1], numbers[0]);
    out.vertices.emplace_back(numbers[i], numbers[i + 1], numbers[1]);
  }
  const auto count = static_cast<std::uint32_t>(out.vertices.size());
  for (std::uint32_t i = 0; i < count; i += 2) {
    const std::uint32_t next = (i + 2) % count;
    if (i > 0 && next > 0) {
      out.add(0, next, i);
      out.add(1, i + 1, next + 1);
    }
    out.add(i, next, next + 1);
    out.add(i, next + 1, i + 1);
  }
  return out;
}

/// n times n cells between two corners, all at one height.
SuiteObject grid(const Numbers& numbers) {
  const double x0 = numbers[0], y0 = numbers[1], x1 = numbers[2], y1 = numbers[3];
  const auto cells = static_cast<std::uint32_t>(numbers[5]);
  Mesh mesh = shapes::surface(cells, cells, false, [&](std::uint32_t i, std::uint32_t j) -> Vec3 {
    return {x0 + (x1 - x0) * i / cells, y0 + (y1 - y0) * j / cells, numbers[4]};
  });
  return {std::move(mesh.vertices), std::move(mesh.triangles)};
}

/// Vertices, '/', and three vertices for each triangle.
std::optional<SuiteObject> mesh(const Words& words) {
  const auto slash = std::find(words.begin(), words.end(), "/");
  const std::optional<Numbers> vertices = numbers_of(Words(words.begin(), slash));
  if (slash == words.end() || !vertices || vertices->size() % 3 != 0) return std::nullopt;
  const std::optional<Numbers> corners = numbers_of(Words(slash + 1, words.end()));
  if (!corners || corners->size() % 3 != 0) return std::nullopt;
  SuiteObject out;
  out.vertices = points_of(*vertices);
  for (const Vec3& t : points_of(*corners)) {
    if (t.minCoeff() < 0 || t.maxCoeff() >= static_cast<double>(out.vertices.size()))
      return std::nullopt;
    out.add(static_cast<std::uint32_t>(t.x()), static_cast<std::uint32_t>(t.y()),
            static_cast<std::uint32_t>(t.z()));
  }
  return out;
}

std::optional<SuiteObject> shape(Words words) {
  if (words.empty()) return std::nullopt;
  const std::string_view name = words.front();
  words.erase(words.begin());
  if (name == "mesh") return mesh(words);
  const std::optional<Numbers> read = numbers_of(words);
  if (!read) return std::nullopt;
  const Numbers& n = *read;
  if (name == "box" && n.size() == 6) return box_object({n[0], n[1], n[2]}, {n[3], n[4], n[5]});
  if (name == "prism" && n.size() >= 8 && n.size() % 2 == 0) return prism(n);
  if (name == "grid" && n.size() == 6 && n[5] >= 1) return grid(n);
  return std::nullopt;
}

void append(const SuiteObject& part, SuiteObject& to) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [i, j, k] : part.triangles) to.add(first + i, first + j, first + k);
}

bool set_pair(const Words& words, bool neighbours, ReportedCase& to) {
  const std::optional<Numbers> numbers = numbers_of(words);
  if (!numbers || numbers->size() != 18) return false;
  const std::vector<Vec3> points = points_of(*numbers);
  for (std::size_t i = 0; i < 6; ++i) (i < 3 ? to.pair.a : to.pair.b)[i % 3] = points[i];
  to.pair.neighbours = neighbours;
  return true;
}

/// Applies a line of the table to its case. False: the line is malformed.
bool apply(std::string_view key, std::string_view rest, ReportedCase& to) {
  if (key == "expected" || key == "why" || key == "label") {
    (key == "expected" ? to.expected : key == "why" ? to.why : to.label) = rest;
    return !rest.empty();
  }
  const Words words = words_of(rest);
  if (key == "pair" || key == "neighbours") return set_pair(words, key == "neighbours", to);
  if (key == "object" || key == "self" || key == "part") {
    const std::optional<SuiteObject> made = shape(words);
    if (!made || (key == "part" && to.objects.empty())) return false;
    if (key != "part") to.objects.emplace_back();
    to.self = to.self || key == "self";
    append(*made, to.objects.back());
    return true;
  }
  const std::optional<Numbers> n = numbers_of(words);
  if (!n || to.objects.empty()) return false;
  Placement placement;
  if (key == "turn" && n->size() == 4)
    placement.rotate = Placement::Rotation{
        .quaternion = std::array<double, 4>{(*n)[1], (*n)[2], (*n)[3], (*n)[0]}};
  else if (key == "move" && n->size() == 3)
    placement.translate = points_of(*n)[0];
  else
    return false;
  std::vector<Vec3>& vertices = to.objects.back().vertices;
  vertices = place(std::move(vertices), placement);
  return true;
}

std::string note_of(const ReportedCase& one) {
  return "source: " + one.source + "\nexpected: " + one.expected + "\nwhy: " + one.why;
}

enum class Sort : std::uint8_t { pairs, meshes, self };

std::vector<const ReportedCase*> cases_of(Sort sort) {
  std::vector<const ReportedCase*> out;
  for (const ReportedCase& one : reported_cases()) {
    const Sort its = one.objects.empty() ? Sort::pairs : one.self ? Sort::self : Sort::meshes;
    if (its == sort) out.push_back(&one);
  }
  return out;
}

template <Sort sort>
const ReportedCase& case_at(std::size_t i) {
  static const std::vector<const ReportedCase*> cases = cases_of(sort);
  return *cases.at(i);
}

template <Sort sort>
std::vector<SuiteObject> objects_at(RandomDraws&, double, int i) {
  return case_at<sort>(static_cast<std::size_t>(i)).objects;
}

template <Sort sort>
MeshFamily mesh_family(const char* name, const char* description) {
  MeshFamily out{.name = name,
                 .description = description,
                 .parameter = "number of the case",
                 .self = sort == Sort::self,
                 .make = objects_at<sort>,
                 .members = {}};
  for (const ReportedCase* one : cases_of(sort)) {
    const int i = static_cast<int>(out.members.size());
    out.members.push_back({i + 1.0, i, note_of(*one)});
  }
  out.small = out.members.size();
  return out;
}

}  // namespace

SuiteObject box_object(const Vec3& lo, const Vec3& hi) {
  SuiteObject out;
  for (int i = 0; i < 8; ++i) {
    out.vertices.emplace_back((i & 1) != 0 ? hi.x() : lo.x(), (i & 2) != 0 ? hi.y() : lo.y(),
                              (i & 4) != 0 ? hi.z() : lo.z());
  }
  out.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return out;
}

std::vector<ReportedCase> parse_reported(std::string_view table) {
  std::vector<ReportedCase> out;
  for (int number = 1; !table.empty(); ++number) {
    std::string_view line = take_until(table, '\n');
    if (line.empty() || line.front() == '#') continue;
    const std::string_view key = take_until(line, ' ');
    if (key == "case")
      out.emplace_back().source = line;
    else if (out.empty() || !apply(key, line, out.back()))
      throw std::logic_error(fmt::format("reported.txt: line {} is malformed", number));
  }
  return out;
}

const std::vector<ReportedCase>& reported_cases() {
  static const std::vector<ReportedCase> cases = parse_reported(embedded::reported_txt);
  return cases;
}

PairFamily reported_pairs() {
  PairFamily out{.name = "reported",
                 .description = "cases of public trackers, rebuilt",
                 .parameter = "number of the case",
                 .values = {},
                 .make = [](RandomDraws&, double number) {
                   return case_at<Sort::pairs>(static_cast<std::size_t>(number)).pair;
                 }};
  for (const ReportedCase* one : cases_of(Sort::pairs)) {
    out.values.push_back(static_cast<double>(out.values.size()));
    out.notes.push_back(note_of(*one));
  }
  return out;
}

std::vector<MeshFamily> reported_meshes() {
  return {mesh_family<Sort::meshes>("reported", "cases of public trackers, rebuilt"),
          mesh_family<Sort::self>("reported-self", "the same, of one object against itself")};
}

}  // namespace farcull
