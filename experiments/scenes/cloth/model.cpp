// Builds the model of a cloth, and computes the energies, gradient and Hessian blocks of a step.
#include "experiments/scenes/cloth/cloth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/scenes/mesh/scene_build.h"

namespace farcull::cloth {
namespace {

// The ratio of Model::crimp to the product of a cell's weight and side. With this ratio, an edge
// that is slack by 1e-4 of its length pulls with 1e-4 of a cell's weight.
constexpr double kCrimp = 1e-8;

void check(bool good, const char* what, double value, const char* range) {
  if (good) return;
  throw Error("cloth", fmt::format("{} is {}", what, value), fmt::format("give {}", range));
}

void check(const ClothSettings& s) {
  check(s.triangles >= 8 && s.triangles <= 200000, "triangles", static_cast<double>(s.triangles),
        "8 to 200000");
  const auto positive = [](const char* what, double value) {
    check(std::isfinite(value) && value > 0, what, value, "a finite number above 0");
  };
  const auto not_negative = [](const char* what, double value) {
    check(std::isfinite(value) && value >= 0, what, value, "a finite number, 0 or more");
  };
  positive("stiffness", s.stiffness);
  positive("side", s.side);
  positive("density", s.density);
  not_negative("buckling_load", s.buckling_load);
  not_negative("bending_rigidity", s.bending_rigidity);
  not_negative("gravity", s.gravity);
  not_negative("drag", s.drag);
  not_negative("radius", s.radius);
  positive("contact_modulus", s.contact_modulus);
  not_negative("friction", s.friction);
  positive("stick_speed", s.stick_speed);
  not_negative("height", s.height);
  positive("time_step", s.time_step);
  positive("tolerance", s.tolerance);
  check(s.max_iterations >= 0, "max_iterations", s.max_iterations, "0 or more");
}

Vec3 at(const Eigen::VectorXd& x, std::uint32_t vertex) { return x.segment<3>(3 * vertex); }

void add_triangles(Model& model) {
  const std::uint32_t m = model.cells;
  const auto id = [m](std::uint32_t i, std::uint32_t j) { return j * (m + 1) + i; };
  for (std::uint32_t j = 0; j < m; ++j) {
    for (std::uint32_t i = 0; i < m; ++i) {
      const std::uint32_t a = id(i, j);
      const std::uint32_t b = id(i + 1, j);
      const std::uint32_t c = id(i + 1, j + 1);
      const std::uint32_t d = id(i, j + 1);
      // Diagonals alternate, so that the cloth is equally stiff in mirrored directions.
      if ((i + j) % 2 == 0) {
        model.triangles.insert(model.triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        model.triangles.insert(model.triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
}

// Places the cloth flat above the sphere, a little off the sphere's centre. Adds small random
// heights, far below the size of a cell. Otherwise rounding errors would place the folds.
void place(Model& model) {
  const ClothSettings& s = model.settings;
  const std::uint32_t m = model.cells;
  const double cell = s.side / m;
  shapes::Random random(s.seed);
  model.rest.resize(3 * static_cast<Eigen::Index>(m + 1) * (m + 1));
  Eigen::Index at = 0;
  for (std::uint32_t j = 0; j <= m; ++j) {
    for (std::uint32_t i = 0; i <= m; ++i) {
      model.rest[at++] = cell * i - 0.5 * s.side + 0.02 * s.side;
      model.rest[at++] = cell * j - 0.5 * s.side + 0.01 * s.side;
      model.rest[at++] = s.radius + s.height + random.between(0, 1e-3 * cell);
    }
  }
}

// Adds the hinge of edge a-b. Its two triangles have the opposite corners c and d. The weights of a
// and b give the point where the segment c-d meets the edge. If the edge is a diagonal of a cell,
// this point is the middle of the edge. Otherwise the triangles are mirror images, and the point is
// an end of the edge.
void add_hinge(Model& model, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const std::uint32_t side = model.cells + 1;
  const bool diagonal = a / side != b / side && a % side != b % side;
  // This stiffness gives the cloth the bending rigidity of the settings (docs/cloth.md, "Model").
  const double cell = model.settings.side / model.cells;
  const double stiffness = 4 * model.settings.bending_rigidity / (cell * cell);
  Hinge hinge{{a, b, c, d}, {-0.5, -0.5, 0.5, 0.5}, 2 * stiffness};
  if (!diagonal) {
    const bool at_a = a % side == c % side || a / side == c / side;
    hinge = {{a, b, c, d}, {at_a ? -1.0 : 0.0, at_a ? 0.0 : -1.0, 0.5, 0.5}, stiffness};
  }
  model.hinges.push_back(hinge);
}

void add_springs_and_hinges(Model& model) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> opposite;
  const std::uint32_t side = model.cells + 1;
  const double cell = model.settings.side / model.cells;
  for (const auto& corners : model.triangles) {
    for (int e = 0; e < 3; ++e) {
      const auto [a, b] = std::minmax(corners[e], corners[(e + 1) % 3]);
      const std::uint32_t c = corners[(e + 2) % 3];
      const auto [entry, is_new] = opposite.try_emplace({a, b}, c);
      if (!is_new) {
        add_hinge(model, a, b, entry->second, c);
        continue;
      }
      const bool diagonal = a / side != b / side && a % side != b % side;
      model.springs.push_back({{a, b}, diagonal ? std::sqrt(2.0) * cell : cell});
    }
  }
}

// Returns the energy (J) of a spring of length l, shifted to 0 at the spring's rest length.
double spring_energy(const Model& model, std::size_t spring, double l) {
  const ClothSettings& s = model.settings;
  const double c = s.stiffness + s.buckling_load;
  const double from = slack_length(model, spring);
  const double rest = model.springs[spring].length;
  return smooth_energy(c, model.crimp, l - from) - smooth_energy(c, model.crimp, rest - from) -
         0.5 * s.buckling_load * (l - rest) * (l + rest);
}

double depth_energy(const Model& model, std::size_t vertex, double depth) {
  return smooth_energy(contact_stiffness(model, vertex), model.crimp, depth);
}

}  // namespace

double smooth_force(double c, double crimp, double e) {
  const double root = std::sqrt(e * e + 4 * crimp / c);
  return e < 0 ? 2 * crimp / (root - e) : 0.5 * c * (e + root);
}

double smooth_stiffness(double c, double crimp, double e) {
  return smooth_force(c, crimp, e) / std::sqrt(e * e + 4 * crimp / c);
}

double smooth_energy(double c, double crimp, double e) {
  const double root = std::sqrt(e * e + 4 * crimp / c);
  // sum = e^2 + e root, computed without cancellation for e < 0.
  const double sum = e < 0 ? 4 * crimp / c * e / (root - e) : e * (e + root);
  return 0.25 * c * sum + crimp * std::asinh(0.5 * e * std::sqrt(c / crimp));
}

double slack_length(const Model& model, std::size_t spring) {
  const ClothSettings& s = model.settings;
  return s.stiffness / (s.stiffness + s.buckling_load) * model.springs[spring].length;
}

double contact_stiffness(const Model& model, std::size_t vertex) {
  return model.settings.contact_modulus * model.area[vertex];
}

Model make_model(const ClothSettings& settings) {
  check(settings);
  Model model;
  model.settings = settings;
  model.cells = static_cast<std::uint32_t>(
      std::lround(std::sqrt(static_cast<double>(settings.triangles) / 2)));
  place(model);
  add_triangles(model);
  add_springs_and_hinges(model);
  const double cell = settings.side / model.cells;
  model.area.assign(static_cast<std::size_t>(model.rest.size() / 3), 0);
  for (const auto& corners : model.triangles) {
    for (const std::uint32_t v : corners) model.area[v] += cell * cell / 6;
  }
  for (const double area : model.area) model.mass.push_back(settings.density * area);
  model.crimp = kCrimp * kStandardGravity * settings.density * cell * cell * cell;
  return model;
}

Energies energies(const Model& model, const Eigen::VectorXd& x, const Eigen::VectorXd& velocity) {
  const ClothSettings& s = model.settings;
  Energies sum;
  for (std::size_t i = 0; i < model.springs.size(); ++i) {
    const auto [a, b] = model.springs[i].vertices;
    sum.elastic += spring_energy(model, i, (at(x, b) - at(x, a)).norm());
  }
  for (const Hinge& hinge : model.hinges) {
    Vec3 w = Vec3::Zero();
    for (int c = 0; c < 4; ++c) w += hinge.weights[c] * at(x, hinge.vertices[c]);
    sum.bending += 0.5 * hinge.stiffness * w.squaredNorm();
  }
  for (std::uint32_t v = 0; v < model.mass.size(); ++v) {
    sum.kinetic += 0.5 * model.mass[v] * at(velocity, v).squaredNorm();
    sum.gravitational += model.mass[v] * s.gravity * x[3 * v + 2];
    if (s.radius > 0) sum.contact += depth_energy(model, v, s.radius - at(x, v).norm());
  }
  return sum;
}

Step make_step(const Model& model, const Eigen::VectorXd& x0, const Eigen::VectorXd& v0) {
  const ClothSettings& s = model.settings;
  Step step{model,
            x0,
            v0,
            std::vector<Vec3>(model.mass.size(), Vec3::Zero()),
            std::vector<double>(model.mass.size(), 0),
            s.stiffness + s.buckling_load};
  for (std::uint32_t v = 0; v < model.mass.size(); ++v) {
    const double distance = at(x0, v).norm();
    if (s.radius == 0) continue;
    step.normal[v] = distance > 0 ? Vec3(at(x0, v) / distance) : Vec3(Vec3::UnitZ());
    step.friction[v] =
        s.friction * smooth_force(contact_stiffness(model, v), model.crimp, s.radius - distance);
  }
  return step;
}

void soft_gradient(const Step& step, const Eigen::VectorXd& x, Eigen::VectorXd& result) {
  const Model& model = step.model;
  const ClothSettings& s = model.settings;
  const double h = s.time_step;
  result.resize(x.size());
  for (std::uint32_t v = 0; v < model.mass.size(); ++v) {
    const Vec3 moved = at(x, v) - at(step.x0, v);
    Vec3 force = model.mass[v] / h * (moved / h - at(step.v0, v));
    force += s.drag * model.area[v] / h * moved;
    force.z() += model.mass[v] * s.gravity;
    if (step.friction[v] != 0) {
      const Vec3 slid = moved - step.normal[v].dot(moved) * step.normal[v];
      force += step.friction[v] / std::max(slid.norm(), h * s.stick_speed) * slid;
    }
    result.segment<3>(3 * v) = force;
  }
  for (const Spring& spring : model.springs) {
    const auto [a, b] = spring.vertices;
    const Vec3 thrust = s.buckling_load * (at(step.x0, b) - at(step.x0, a));
    result.segment<3>(3 * b) -= thrust;
    result.segment<3>(3 * a) += thrust;
  }
  for (const Hinge& hinge : model.hinges) {
    Vec3 w = Vec3::Zero();
    for (int c = 0; c < 4; ++c) w += hinge.weights[c] * at(x, hinge.vertices[c]);
    w *= hinge.stiffness;
    for (int c = 0; c < 4; ++c) result.segment<3>(3 * hinge.vertices[c]) += hinge.weights[c] * w;
  }
}

void gradient(const Step& step, const Eigen::VectorXd& x, Eigen::VectorXd& result) {
  const Model& model = step.model;
  soft_gradient(step, x, result);
  for (std::size_t i = 0; i < model.springs.size(); ++i) {
    const auto [a, b] = model.springs[i].vertices;
    const Vec3 d = at(x, b) - at(x, a);
    const double l = d.norm();
    if (l == 0) continue;  // the direction is undefined, and the force is negligible
    const Vec3 force = smooth_force(step.stretch, model.crimp, l - slack_length(model, i)) / l * d;
    result.segment<3>(3 * b) += force;
    result.segment<3>(3 * a) -= force;
  }
  for (std::uint32_t v = 0; v < model.mass.size(); ++v) {
    const Vec3& n = step.normal[v];
    if (n.isZero(0)) continue;
    const double depth = model.settings.radius - n.dot(at(x, v));
    result.segment<3>(3 * v) -= smooth_force(contact_stiffness(model, v), model.crimp, depth) * n;
  }
}

Block spring_block(const Step& step, std::size_t spring, const Eigen::VectorXd& x) {
  const auto [a, b] = step.model.springs[spring].vertices;
  const Vec3 d = at(x, b) - at(x, a);
  const double l = d.norm();
  if (l == 0) return Block::Zero();
  const double e = l - slack_length(step.model, spring);
  const double across = smooth_force(step.stretch, step.model.crimp, e) / l;
  const Block outer = d / l * (d / l).transpose();
  return across * Block::Identity() +
         (smooth_stiffness(step.stretch, step.model.crimp, e) - across) * outer;
}

void for_constant_blocks(
    const Model& model,
    const std::function<void(std::uint32_t, std::uint32_t, const Block&)>& add) {
  const ClothSettings& s = model.settings;
  const double h = s.time_step;
  for (std::uint32_t v = 0; v < model.mass.size(); ++v)
    add(v, v, (model.mass[v] / (h * h) + s.drag * model.area[v] / h) * Block::Identity());
  for (const Hinge& hinge : model.hinges) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b <= a; ++b) {
        const double d = hinge.stiffness * hinge.weights[a] * hinge.weights[b];
        add(hinge.vertices[a], hinge.vertices[b], d * Block::Identity());
      }
    }
  }
}

Block contact_block(const Step& step, std::uint32_t vertex, const Eigen::VectorXd& x) {
  const Vec3& n = step.normal[vertex];
  if (n.isZero(0)) return Block::Zero();
  const double c = contact_stiffness(step.model, vertex);
  const double depth = step.model.settings.radius - n.dot(at(x, vertex));
  return smooth_stiffness(c, step.model.crimp, depth) * n * n.transpose();
}

Block friction_block(const Step& step, std::uint32_t vertex, const Eigen::VectorXd& x) {
  if (step.friction[vertex] == 0) return Block::Zero();
  const ClothSettings& s = step.model.settings;
  const Vec3& n = step.normal[vertex];
  const Vec3 moved = at(x, vertex) - at(step.x0, vertex);
  const Vec3 slid = moved - n.dot(moved) * n;
  const double way = slid.norm();
  const double stick = s.time_step * s.stick_speed;
  Block tangent = Block::Identity() - n * n.transpose();
  if (way > stick) tangent -= slid / way * (slid / way).transpose();
  return step.friction[vertex] / std::max(way, stick) * tangent;
}

}  // namespace farcull::cloth
