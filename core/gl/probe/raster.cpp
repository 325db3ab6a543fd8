// Probes the device assumptions A1 and A2 (displacements of edges), A3 (the pixels that triangles
// cover), and A9 (gl_FragCoord).
#include <algorithm>
#include <array>
#include <numbers>

#include "core/gl/probe/target.h"
#include "embedded/probe_frag.h"

namespace farcull::probe {
namespace {

// A convex quadrilateral as four half-planes a x + b y + c >= 0 with |a| + |b| = 1. If a corner
// moves by at most d along each axis, its value a x + b y changes by at most d. So a pixel centre
// that is more than d inside (outside) stays inside (outside) if all corners move in this way.
struct Sides {
  std::array<std::array<double, 3>, 4> half{};

  explicit Sides(const Proxy& q) {
    const auto x = [&](std::size_t i) { return static_cast<double>(q.corners[2 * (i % 4)]); };
    const auto y = [&](std::size_t i) { return static_cast<double>(q.corners[2 * (i % 4) + 1]); };
    double area = 0;
    for (std::size_t i = 0; i < 4; ++i)
      area += (x(i) - x(0)) * (y(i + 1) - y(0)) - (x(i + 1) - x(0)) * (y(i) - y(0));
    for (std::size_t i = 0; i < 4; ++i) {
      const double a = y(i) - y(i + 1), b = x(i + 1) - x(i);
      const double scale = (area < 0 ? -1 : 1) / (std::abs(a) + std::abs(b));
      half[i] = {a * scale, b * scale, -(a * x(i) + b * y(i)) * scale};
    }
  }
  double inside(double px, double py) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : half) least = std::min(least, a * px + b * py + c);
    return least;
  }
};

// Draws proxies and counts the fragments of each pixel.
class Coverage {
 public:
  Coverage(int width, int height, const ProbeOptions& options)
      : target_(width, height),
        program_(proxy_program("coverage", {embedded::probe_frag}, {"FAR_COVERAGE"})),
        options_(options) {}

  const Target& target() const { return target_; }
  double centre_x(int i) const { return i + 0.5 - 0.5 * target_.width(); }
  double centre_y(int j) const { return j + 0.5 - 0.5 * target_.height(); }

  std::vector<std::uint32_t> draw(std::vector<Proxy> proxies) {
    if (options_.dropped_triangle) {
      for (Proxy& q : proxies) {
        q.corners[6] = q.corners[4];
        q.corners[7] = q.corners[5];
      }
    }
    target_.upload(proxies);
    target_.start();
    bind_zeros(counts_, 2, target_.pixels());
    target_.use(program_);
    glUniform1f(glGetUniformLocation(program_, "u_shift"), options_.shifted_pixel ? 0.5f : 0.0f);
    target_.draw(0, proxies.size());
    return words_of(counts_, target_.pixels());
  }

 private:
  Target target_;
  GlProgram program_;
  GlBuffer counts_;
  const ProbeOptions& options_;
};

enum class Direction { upright, level, diagonal, any };

// Tests edges near pixel centres, one proxy for each edge. If the coverage of a centre is wrong,
// the distance of edge and centre (px per axis) is a lower bound of the edge's displacement.
void short_edges(Coverage& coverage, Random& random, Direction direction, double reach,
                 Worst& worst) {
  constexpr int kCell = 6, kEdge = 3;
  const int width = coverage.target().width(), height = coverage.target().height();
  std::vector<Proxy> proxies;
  std::vector<std::size_t> pixel;
  for (int y = kEdge; y + kCell + kEdge <= height; y += kCell) {
    for (int x = kEdge; x + kCell + kEdge <= width; x += kCell) {
      const double cx = coverage.centre_x(x + kCell / 2), cy = coverage.centre_y(y + kCell / 2);
      double turn = 0;  // angle of the outward normal, in radians
      const int side = random.below(4);
      if (direction == Direction::upright) turn = (side % 2) * std::numbers::pi;
      if (direction == Direction::level) turn = (side % 2 + 0.5) * std::numbers::pi;
      if (direction == Direction::diagonal) turn = (side * 0.5 + 0.25) * std::numbers::pi;
      if (direction == Direction::any) turn = random.between(0, 2 * std::numbers::pi);
      // Rounds the normal, so that both ends of a vertical edge have the same x.
      const double nx = std::round(std::cos(turn) * 0x1p20) * 0x1p-20;
      const double ny = std::round(std::sin(turn) * 0x1p20) * 0x1p-20;
      const double delta = random.between(-reach, reach);
      const double ex = cx + nx * delta, ey = cy + ny * delta;
      const double l0 = random.between(1, 1.5), l1 = random.between(1, 1.5),
                   depth = random.between(1, 1.5);
      std::array<std::array<double, 2>, 4> p = {
          {{ex - ny * l0, ey + nx * l0},
           {ex + ny * l1, ey - nx * l1},
           {ex + ny * l1 - nx * depth, ey - nx * l1 - ny * depth},
           {ex - ny * l0 - nx * depth, ey + nx * l0 - ny * depth}}};
      if (random.below(2)) std::reverse(p.begin(), p.end());
      std::rotate(p.begin(), p.begin() + random.below(4), p.end());
      proxies.push_back(
          quad({p[0][0], p[0][1], p[1][0], p[1][1], p[2][0], p[2][1], p[3][0], p[3][1]}));
      pixel.push_back(static_cast<std::size_t>(y + kCell / 2) * width + x + kCell / 2);
    }
  }
  const std::vector<std::uint32_t> counts = coverage.draw(proxies);
  for (std::size_t i = 0; i < proxies.size(); ++i) {
    const double inside = Sides(proxies[i])
                              .inside(coverage.centre_x(static_cast<int>(pixel[i] % width)),
                                      coverage.centre_y(static_cast<int>(pixel[i] / width)));
    worst.add((counts[pixel[i]] > 0) == (inside > 0) ? 0 : std::abs(inside));
  }
}

// Returns a convex quadrilateral, possibly very thin. Its corners lie on an ellipse in the box.
Proxy random_quad(Random& random, double cx, double cy, double half_width, double half_height) {
  const double turn = random.between(0, 2 * std::numbers::pi);
  const double thin = std::exp2(-random.between(0, 10));
  std::array<double, 4> at{};
  const bool rectangle = random.below(2) != 0;
  const double a = random.between(0, std::numbers::pi / 2);
  for (double& t : at) t = random.between(0, 2 * std::numbers::pi);
  if (rectangle) at = {a, std::numbers::pi - a, std::numbers::pi + a, 2 * std::numbers::pi - a};
  std::sort(at.begin(), at.end());
  std::array<double, 8> corners{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double u = std::cos(at[i]), v = std::sin(at[i]) * thin;
    corners[2 * i] = cx + half_width * (u * std::cos(turn) - v * std::sin(turn));
    corners[2 * i + 1] = cy + half_height * (u * std::sin(turn) + v * std::cos(turn));
  }
  return quad(corners);
}

bool has_sides(const Proxy& q) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    if (q.corners[2 * i] == q.corners[2 * j] && q.corners[2 * i + 1] == q.corners[2 * j + 1])
      return false;
  }
  return true;
}

// Draws one proxy as large as the target. `worst` measures the displacement of the proxy's sides at
// all pixels. `wrong` counts pixels more than `margin` inside that are not covered exactly once.
void large_quad(Coverage& coverage, Random& random, double margin, Worst* worst, Worst* wrong) {
  const int width = coverage.target().width(), height = coverage.target().height();
  const Proxy q = random_quad(random, 0, 0, 0.5 * width - 1, 0.5 * height - 1);
  if (!has_sides(q)) return;
  const std::vector<std::uint32_t> counts = coverage.draw({q});
  const Sides sides(q);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::uint32_t n = counts[static_cast<std::size_t>(y) * width + x];
      const double inside = sides.inside(coverage.centre_x(x), coverage.centre_y(y));
      if (worst) worst->add((n > 0) == (inside > 0) ? 0 : std::abs(inside));
      if (wrong && inside > margin) wrong->count(n != 1);
    }
  }
}

// Keeps the measurement with the largest ratio to its bound. worst.samples is a running total.
struct Tightest {
  Worst worst;
  double bound = 0;
  void add(const Worst& other, double other_bound) {
    const std::uint64_t samples = worst.samples + other.samples;
    if (worst.samples == 0 || other.value * bound > worst.value * other_bound ||
        (bound == 0 && other.value > worst.value)) {
      worst = other;
      bound = other_bound;
    }
    worst.samples = samples;
  }
};

std::string px(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g px", x);
  return text;
}

std::string size(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

// Draws quadrilaterals, each in its own cell. Each pixel centre that is inside by more than
// `margin` must be covered once, even on the diagonal between the quadrilateral's two triangles.
Worst split_quads(Coverage& coverage, Random& random, double margin, int rounds) {
  constexpr int kCell = 32;
  const int side = coverage.target().width();
  Worst wrong;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Proxy> proxies;
    for (int cell = 0; cell < (side / kCell) * (side / kCell); ++cell) {
      const int column = cell % (side / kCell), row = cell / (side / kCell);
      const double x = (column + 0.5) * kCell - 0.5 * side, y = (row + 0.5) * kCell - 0.5 * side;
      Proxy q = random_quad(random, x, y, 15, 15);
      if (round % 2 == 1) {
        // A square, parallel to the axes or turned by 45 degrees, with corners at pixel centres.
        // Its diagonal passes through pixel centres.
        const int r = 1 + random.below(14);
        const double cx = x + 0.5, cy = y + 0.5;
        std::array<double, 8> at = {cx - r, cy - r, cx + r, cy - r, cx + r, cy + r, cx - r, cy + r};
        if (random.below(2)) at = {cx - r, cy, cx, cy - r, cx + r, cy, cx, cy + r};
        std::rotate(at.begin(), at.begin() + std::ptrdiff_t{2} * random.below(4), at.end());
        q = quad(at);
      }
      if (!has_sides(q)) q = box(x - 3, y - 3, x + 3, y + 3);
      proxies.push_back(q);
    }
    const std::vector<std::uint32_t> counts = coverage.draw(proxies);
    for (std::size_t cell = 0; cell < proxies.size(); ++cell) {
      const Sides sides(proxies[cell]);
      const int x0 = static_cast<int>(cell) % (side / kCell) * kCell;
      const int y0 = static_cast<int>(cell) / (side / kCell) * kCell;
      for (int y = y0; y < y0 + kCell; ++y) {
        for (int x = x0; x < x0 + kCell; ++x) {
          if (sides.inside(coverage.centre_x(x), coverage.centre_y(y)) > margin)
            wrong.count(counts[static_cast<std::size_t>(y) * side + x] != 1);
        }
      }
    }
  }
  return wrong;
}

// Draws a mesh of jittered cells that share corners. Each inner pixel must be covered once.
Worst abutting_mesh(Coverage& coverage, Random& random) {
  const int side = coverage.target().width();
  Worst wrong;
  for (const double cell : {0.7, 1.0, 2.3, 9.1}) {
    const int n = static_cast<int>((side - 8) / cell), middle = n / 2;
    std::vector<std::array<double, 2>> points(static_cast<std::size_t>(n + 1) * (n + 1));
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        const bool border = i == 0 || j == 0 || i == n || j == n;
        // If a cell is as large as a pixel, every second corner is exactly at a pixel centre.
        const double shake = border || (cell == 1 && (i + j) % 2 == 0) ? 0 : 0.2 * cell;
        points[static_cast<std::size_t>(j) * (n + 1) + i] = {
            (i - middle) * cell + 0.5 + random.between(-shake, shake),
            (j - middle) * cell + 0.5 + random.between(-shake, shake)};
      }
    }
    std::vector<Proxy> proxies;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const auto* const a = &points[static_cast<std::size_t>(j) * (n + 1) + i];
        const auto &b = a[1], &c = a[n + 2], &d = a[n + 1];
        proxies.push_back(quad({(*a)[0], (*a)[1], b[0], b[1], c[0], c[1], d[0], d[1]}));
      }
    }
    const std::vector<std::uint32_t> counts = coverage.draw(proxies);
    const double lo = -middle * cell + 1.5, hi = (n - middle) * cell - 0.5;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const double cx = coverage.centre_x(x), cy = coverage.centre_y(y);
        if (std::min(cx, cy) > lo && std::max(cx, cy) < hi)
          wrong.count(counts[static_cast<std::size_t>(y) * side + x] != 1);
      }
    }
  }
  return wrong;
}

// Draws points and segments, which must cover no pixel. Snapping keeps their area 0: multiples of
// 1/16 px do not move, and an axis-parallel segment remains an axis-parallel segment.
Worst zero_area(Coverage& coverage, Random& random, bool fat) {
  const int side = coverage.target().width();
  std::vector<Proxy> proxies;
  for (int i = 0; i < 40000; ++i) {
    const auto place = [&] {
      const double c = random.below(side - 32) - 0.5 * (side - 32);
      return random.below(2) ? c + 0.5 : c + random.below(16) / 16.0;
    };
    const double x = place(), y = place();
    const double shift = random.in_float(-1, 1);  // not a multiple of 1/16; added along one axis
    constexpr int kWays[][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {1, -1}, {1, 2}, {-3, 1}};
    const int way = random.below(7);
    std::array<double, 8> at{};
    for (std::size_t k = 0; k < 4; ++k) {
      const int t = random.below(65) - 32;
      at[2 * k] = x + kWays[way][0] * t / 16.0 + (way == 2 ? shift : 0);
      at[2 * k + 1] = y + kWays[way][1] * t / 16.0 + (way == 1 ? shift : 0);
    }
    if (fat) at[2] += 1;
    proxies.push_back(quad(at));
  }
  const std::vector<std::uint32_t> counts = coverage.draw(proxies);
  Worst wrong;
  for (const std::uint32_t n : counts) wrong.value += n;
  wrong.samples = 2 * proxies.size();
  return wrong;
}

}  // namespace

std::vector<ProbeResult> edges(const GlContext& context, const ProbeOptions& options) {
  Random random(options.seed);
  const double snap = snap_bound(context, options);
  const double reach = 4 * std::ldexp(1.0, -context.info().subpixel_bits);
  constexpr Direction kDirections[] = {Direction::upright, Direction::level, Direction::diagonal,
                                       Direction::any};

  Worst near;
  double near_of[4] = {};
  Coverage small(256, 256, options);
  for (std::size_t d = 0; d < 4; ++d) {
    Worst worst;
    for (int round = 0; round < rounds(options, 12); ++round)
      short_edges(small, random, kDirections[d], reach, worst);
    near_of[d] = worst.value;
    near.value = std::max(near.value, worst.value);
    near.samples += worst.samples;
  }
  const int side = largest_side(context);
  const std::string strips = size(side, 64) + ", " + size(64, side) + " and 2000 x 2000";
  Tightest far, large;
  double displacement = 0;
  for (const auto& [width, height] : {std::pair{side, 64}, std::pair{64, side}, {2000, 2000}}) {
    Coverage coverage(width, height, options);
    const int viewport = coverage.target().viewport();
    const double vertex = vertex_bound(options, viewport);
    Worst edge, whole;
    for (const Direction direction : kDirections)
      short_edges(coverage, random, direction, reach + 2 * vertex_bound({}, viewport), edge);
    for (int round = 0; round < rounds(options, 4); ++round)
      large_quad(coverage, random, 0, &whole, nullptr);
    displacement = std::max(displacement, edge.value);
    // `near` is the displacement by snapping. The excess over `near` is due to vertex arithmetic.
    edge.value = std::max(0.0, edge.value - near.value);
    far.add(edge, vertex);
    large.add(whole, snap + vertex);
  }
  return {result("A1", "vertex arithmetic", far.worst, far.bound, "px",
                 "edges of 2 to 3 px all over targets of " + strips + "; displacement " +
                     px(displacement) + " less that of A2, per axis"),
          result("A1", "sides of large proxies", large.worst, large.bound, "px",
                 "all pixels of quadrilaterals as large as those targets; with snapping"),
          result("A2", "snapping", near, snap + vertex_bound(options, 256), "px",
                 "edges near pixel centres, 256 x 256: upright " + px(near_of[0]) + ", level " +
                     px(near_of[1]) + ", 45 degrees " + px(near_of[2]) + ", any " + px(near_of[3]) +
                     ", per axis, looked for up to " + px(reach))};
}

std::vector<ProbeResult> coverage(const GlContext& context, const ProbeOptions& options) {
  Random random(options.seed + 3);
  const double snap = snap_bound(context, {});
  Coverage small(1024, 1024, options);
  const double margin = snap + vertex_bound({}, 1024);
  const Worst split = split_quads(small, random, margin, rounds(options, 10));
  Worst wrong, misplaced;
  const int side = largest_side(context);
  for (const auto& [width, height] : {std::pair{1024, 1024}, {side, 64}, {64, side}}) {
    Coverage large(width, height, options);
    for (int round = 0; round < rounds(options, 4); ++round)
      large_quad(large, random, snap + vertex_bound({}, large.target().viewport()), nullptr,
                 &wrong);
    large.draw({box(-0.5 * width, -0.5 * height, 0.5 * width, 0.5 * height)});
    const std::vector<std::uint32_t> place = large.target().colour();
    for (std::size_t i = 0; i < place.size(); ++i) misplaced.count(place[i] != i + 1);
  }
  Coverage medium(512, 512, options);
  const Worst mesh = abutting_mesh(medium, random);
  const Worst flat = zero_area(medium, random, options.fat_zero_area);
  return {
      result("A3", "split quadrilaterals cover once", split, 0, "pixels",
             "two triangles a proxy, any direction, down to slivers, centres on diagonals; "
             "pixels inside that were not covered once"),
      result("A3", "large quadrilaterals cover once", wrong, 0, "pixels",
             "as large as targets of 1024 x 1024, " + size(side, 64) + " and " + size(64, side)),
      result("A3", "abutting triangles cover once", mesh, 0, "pixels",
             "shaken meshes with cells of 0.7 to 9.1 px"),
      result("A3", "no area covers nothing", flat, 0, "fragments",
             "triangles that are points and segments, half of them on pixel centres"),
      result("A9", "gl_FragCoord names the pixel", misplaced, 0, "pixels",
             "every pixel of the same three targets")};
}

}  // namespace farcull::probe
