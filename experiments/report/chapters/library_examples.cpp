// Draws pairs of triangles in a cube, as seen from where both are broad.
#include "experiments/report/chapters/library_examples.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "experiments/suite/reader.h"
#include "experiments/suite/writer.h"

namespace farcull {
namespace {

SuitePair pair_of(const LibraryExample& example) {
  return parse_pairs("farcull-pairs 1 example\n" + example.line + "\n",
                     "the example of " + example.contestant)
      .pairs.front();
}

std::vector<Vec3> corners_of(const SuitePair& pair) {
  std::vector<Vec3> out(pair.a.begin(), pair.a.end());
  out.insert(out.end(), pair.b.begin(), pair.b.end());
  return out;
}

std::string coordinates(const SuitePair& pair) {
  std::string out;
  for (const Vec3& p : corners_of(pair)) {
    out += out.empty() ? "(" : " (";
    for (int k = 0; k < 3; ++k) out += (k == 0 ? "" : ", ") + decimal(p[k] + 0.0);
    out += ")";
  }
  return out;
}

// Corners moved and stretched along each axis so that their box is the unit cube, which changes
// nothing about whether triangles meet. Halves, since the difference of two doubles may be
// infinite.
std::vector<Vec3> in_unit_cube(const SuitePair& pair) {
  std::vector<Vec3> out = corners_of(pair);
  Vec3 low = out[0] / 2, high = low;
  for (const Vec3& p : out) {
    low = low.cwiseMin(p / 2);
    high = high.cwiseMax(p / 2);
  }
  for (Vec3& p : out) {
    for (int k = 0; k < 3; ++k) {
      const double size = high[k] - low[k];
      p[k] = size > 0 ? (p[k] / 2 - low[k]) / size : 0;
    }
  }
  return out;
}

struct Point2 {
  double x = 0, y = 0;
};
// As seen along a direction, which need not have length 1.
std::vector<Point2> seen_along(const Vec3& direction, const std::vector<Vec3>& corners) {
  const Vec3 along = direction.normalized();
  const Vec3 up = std::abs(along.z()) < 0.9 ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
  const Vec3 right = up.cross(along).normalized(), above = along.cross(right);
  std::vector<Point2> out;
  for (const Vec3& p : corners) out.push_back({p.dot(right), p.dot(above)});
  return out;
}

// Large where each triangle is seen from its broad side; a degenerate one has its length alone.
double clearness(const std::vector<Point2>& seen) {
  double least = 1e9;
  for (const std::size_t first : {0, 3}) {
    const Point2 a = seen[first], b = seen[first + 1], c = seen[first + 2];
    const double area = std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) / 2;
    const double length =
        std::max({std::hypot(b.x - a.x, b.y - a.y), std::hypot(c.x - b.x, c.y - b.y),
                  std::hypot(a.x - c.x, a.y - c.y)});
    least = std::min(least, area + 0.1 * length);
  }
  return least;
}

// From the one of these directions from which both triangles are seen best.
std::vector<Point2> drawn_corners(const SuitePair& pair) {
  const std::vector<Vec3> corners = in_unit_cube(pair);
  std::vector<Point2> best;
  for (const double x : {-1.0, -0.3, 0.3, 1.0}) {
    for (const double y : {0.4, 1.0}) {
      for (const double z : {0.3, 0.8}) {
        std::vector<Point2> seen = seen_along(Vec3(x, y, z), corners);
        if (best.empty() || clearness(seen) > clearness(best)) best = std::move(seen);
      }
    }
  }
  return best;
}

Panel panel_of(const LibraryExample& example) {
  const std::vector<Point2> corners = drawn_corners(pair_of(example));
  Panel out{.title = example.contestant, .drawing = true};
  for (const auto& [name, first, style] : {std::tuple{"first triangle", 0, Series::Style::area},
                                           {"second triangle", 3, Series::Style::lines}}) {
    Series series{.name = name, .style = style};
    for (const int corner : {0, 1, 2, 0}) {
      series.x.push_back(corners[static_cast<std::size_t>(first + corner)].x);
      series.y.push_back(corners[static_cast<std::size_t>(first + corner)].y);
    }
    out.series.push_back(std::move(series));
  }
  return out;
}

void add_figure(const std::vector<LibraryExample>& examples, const std::string& fault,
                const std::string& title, Chapter& chapter) {
  Figure out{
      .name = "libraries-examples-" + fault,
      .title = title,
      .caption =
          "The pairs of the table of examples, one for each contestant: the first triangle is "
          "filled, the second has dashed edges. Each pair is moved and stretched along x, y and z "
          "until its box is a cube, which changes nothing about whether triangles meet, and is "
          "seen from where both triangles are broad. So every panel has a scale of its own, and "
          "says nothing of lengths and angles: the table has the coordinates. A triangle that is "
          "equal to the other, or much smaller, cannot be seen, nor can differences in the last "
          "place."};
  for (const LibraryExample& example : examples) {
    if (example.fault == fault) out.panels.push_back(panel_of(example));
  }
  if (!out.panels.empty()) chapter.figures.push_back(std::move(out));
}

std::string text_of(const std::vector<LibraryExample>& examples) {
  std::string out =
      "farcull-pairs 1 libraries-examples\n# Pairs at which libraries err, minimized: whose fault, "
      "which, and the family that the pair was made from.\n";
  std::uint64_t id = 0;
  for (const LibraryExample& example : examples) {
    SuitePair pair = pair_of(example);
    pair.id = id++;
    out += "# " + example.contestant + " " + example.fault + " " + example.family + "\n" +
           pair_line(pair) + "\n";
  }
  return out;
}

}  // namespace

std::size_t digits_of(const LibraryExample& example) {
  return coordinates(pair_of(example)).size();
}

void add_examples(const std::vector<LibraryExample>& examples, Chapter& chapter) {
  if (examples.empty()) return;
  DataTable table{
      .name = "libraries-examples",
      .caption =
          "The smallest pair of each kind of fault, of pairs of which the "
          "documentation promises the answer: how its triangles meet, the "
          "corners of the first, then those of the second",
      .columns = {text_column("contestant"), text_column("fault"), text_column("family"),
                  text_column("kind"), text_column("coordinates")}};
  for (const LibraryExample& example : examples) {
    const SuitePair pair = pair_of(example);
    table.rows.push_back({example.contestant, example.fault, example.family, to_string(pair.kind),
                          coordinates(pair)});
  }
  chapter.tables.push_back(std::move(table));
  chapter.files.push_back({"libraries-examples.txt", text_of(examples)});
  add_figure(examples, "missed", "Missed: pairs that meet and that a library calls apart", chapter);
  add_figure(examples, "false", "False alarms: pairs apart that a library calls meeting", chapter);
}

}  // namespace farcull
