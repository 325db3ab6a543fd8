// The cases of public trackers: reads the table reported.txt, which is part of the program, and
// makes families of it. The table has its format at its top.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/text.h"
#include "embedded/reported_txt.h"
#include "experiments/generators/pair_generators.h"
#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {
namespace {

/// Numbers and words of a line.
using Numbers = std::vector<double>;
using Words = std::vector<std::string>;

struct Malformed {};

void require(bool holds) {
  if (!holds) throw Malformed{};
}

Numbers numbers_of(Words::const_iterator begin, Words::const_iterator end) {
  Numbers out;
  for (; begin != end; ++begin) {
    const std::optional<double> value = parse_number<double>(*begin);
    require(value.has_value());
    out.push_back(*value);
  }
  return out;
}

std::vector<Vec3> points_of(const Numbers& numbers) {
  require(numbers.size() % 3 == 0);
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    out.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return out;
}

/// A prism from z = numbers[0] to numbers[1] over the convex polygon that follows.
SuiteObject prism(const Numbers& numbers) {
  require(numbers.size() >= 8 && numbers.size() % 2 == 0);
  SuiteObject out;
  for (std::size_t i = 2; i < numbers.size(); i += 2) {
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
  require(numbers.size() == 6 && numbers[5] >= 1);
  const double x0 = numbers[0], y0 = numbers[1], x1 = numbers[2], y1 = numbers[3];
  const auto cells = static_cast<std::uint32_t>(numbers[5]);
  Mesh mesh = shapes::surface(cells, cells, false, [&](std::uint32_t i, std::uint32_t j) -> Vec3 {
    return {x0 + (x1 - x0) * i / cells, y0 + (y1 - y0) * j / cells, numbers[4]};
  });
  return {std::move(mesh.vertices), std::move(mesh.triangles)};
}

/// Vertices, '/', and three vertices for each triangle.
SuiteObject mesh(Words::const_iterator begin, Words::const_iterator end) {
  const auto slash = std::find(begin, end, "/");
  require(slash != end);
  SuiteObject out;
  out.vertices = points_of(numbers_of(begin, slash));
  for (const Vec3& t : points_of(numbers_of(slash + 1, end))) {
    require(t.minCoeff() >= 0 && t.maxCoeff() < static_cast<double>(out.vertices.size()));
    out.add(static_cast<std::uint32_t>(t.x()), static_cast<std::uint32_t>(t.y()),
            static_cast<std::uint32_t>(t.z()));
  }
  return out;
}

/// The shape that the words after the first one name.
SuiteObject shape(const Words& words) {
  require(words.size() > 2);
  const std::string& name = words[1];
  if (name == "mesh") return mesh(words.begin() + 2, words.end());
  const Numbers n = numbers_of(words.begin() + 2, words.end());
  if (name == "prism") return prism(n);
  if (name == "grid") return grid(n);
  require(name == "box" && n.size() == 6);
  return box_object({n[0], n[1], n[2]}, {n[3], n[4], n[5]});
}

void append(const SuiteObject& part, SuiteObject& to) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [i, j, k] : part.triangles) to.add(first + i, first + j, first + k);
}

/// Applies a line of the table to its case. `rest`: the line after its first word.
void apply(const Words& words, const std::string& rest, ReportedCase& to) {
  const std::string& key = words[0];
  if (key == "expected" || key == "why" || key == "label") {
    (key == "expected" ? to.expected : key == "why" ? to.why : to.label) = rest;
    return require(!rest.empty());
  }
  if (key == "object" || key == "self" || key == "part") {
    if (key != "part") to.objects.emplace_back();
    require(!to.objects.empty());
    to.self = to.self || key == "self";
    return append(shape(words), to.objects.back());
  }
  const Numbers n = numbers_of(words.begin() + 1, words.end());
  if (key == "pair" || key == "neighbours") {
    require(n.size() == 18);
    const std::vector<Vec3> points = points_of(n);
    for (std::size_t i = 0; i < 6; ++i) (i < 3 ? to.pair.a : to.pair.b)[i % 3] = points[i];
    to.pair.neighbours = key == "neighbours";
    return;
  }
  require(!to.objects.empty());
  Placement placement;
  if (key == "turn" && n.size() == 4) {
    placement.rotate =
        Placement::Rotation{.quaternion = std::array<double, 4>{n[1], n[2], n[3], n[0]}};
  } else {
    require(key == "move" && n.size() == 3);
    placement.translate = points_of(n)[0];
  }
  std::vector<Vec3>& vertices = to.objects.back().vertices;
  vertices = place(std::move(vertices), placement);
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
  std::istringstream lines{std::string(table)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream in(line);
    const Words words(std::istream_iterator<std::string>(in), {});
    if (words.empty() || words[0].front() == '#') continue;
    const std::string rest = line.substr(std::min(words[0].size() + 1, line.size()));
    try {
      if (words[0] == "case") out.emplace_back().source = rest;
      require(!out.empty());
      if (words[0] != "case") apply(words, rest, out.back());
    } catch (const Malformed&) {
      throw std::logic_error(fmt::format("reported.txt: line {} is malformed", number));
    }
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
