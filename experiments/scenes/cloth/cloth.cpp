// Takes one step after the other: the model gives the function of a step, the solver its minimum.
#include "experiments/scenes/cloth/cloth.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "experiments/scenes/cloth/model.h"
#include "experiments/scenes/cloth/solver.h"
#include "experiments/scenes/mesh/shapes.h"

namespace farcull {
namespace {

// The finest sphere with at most half as many triangles as the cloth: about as fine as the cloth.
int sphere_level(std::uint64_t triangles) {
  int level = 0;
  while (20 * (std::uint64_t{4} << (2 * level)) <= triangles / 2) ++level;
  return level;
}

Scene make_scene(const cloth::Model& model) {
  Scene scene;
  scene.name = "cloth";
  for (Eigen::Index v = 0; v < model.rest.size(); v += 3) {
    scene.vertices.push_back(model.rest.segment<3>(v));
  }
  scene.triangles = model.triangles;
  const auto count = static_cast<std::uint32_t>(model.triangles.size());
  scene.objects = {{"cloth", 0, count, true}, {"sphere", count, 0, false}};
  if (model.settings.radius > 0) {
    const Mesh ball = shapes::sphere(sphere_level(count));
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (const Vec3& p : ball.vertices) scene.vertices.push_back(model.settings.radius * p);
    for (const auto& [a, b, c] : ball.triangles) {
      scene.triangles.push_back({first + a, first + b, first + c});
    }
    scene.objects[1].triangle_count = static_cast<std::uint32_t>(ball.triangles.size());
  }
  for (const Object& object : scene.objects) {
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) scene.source_face.push_back(t);
  }
  validate(scene, "cloth");
  return scene;
}

}  // namespace

struct Cloth::State {
  explicit State(const ClothSettings& settings)
      : model(cloth::make_model(settings)),
        solver(model),
        x(model.rest),
        velocity(Eigen::VectorXd::Zero(model.rest.size())),
        scene(make_scene(model)) {}

  void move_to(Eigen::VectorXd positions) {
    x = std::move(positions);
    for (Eigen::Index v = 0; v < x.size(); v += 3) scene.vertices[v / 3] = x.segment<3>(v);
  }

  void measure() {
    const cloth::Energies now = cloth::energies(model, x, velocity);
    report.kinetic = now.kinetic;
    report.elastic = now.elastic;
    report.bending = now.bending;
    report.gravitational = now.gravitational;
    report.contact = now.contact;
  }

  const cloth::Model model;
  cloth::Solver solver;
  Eigen::VectorXd x;
  Eigen::VectorXd velocity;
  Scene scene;
  ClothReport report;
};

Cloth::Cloth(const ClothSettings& settings) : state_(std::make_unique<State>(settings)) {
  state_->measure();
}
Cloth::~Cloth() = default;
Cloth::Cloth(Cloth&&) noexcept = default;
Cloth& Cloth::operator=(Cloth&&) noexcept = default;

const Scene& Cloth::scene() const { return state_->scene; }
const ClothReport& Cloth::report() const { return state_->report; }
const Eigen::VectorXd& Cloth::velocity() const { return state_->velocity; }

void Cloth::set_velocity(const Eigen::VectorXd& velocity) {
  if (velocity.size() != state_->x.size()) {
    throw std::logic_error("Cloth::set_velocity: not three numbers for each vertex");
  }
  state_->velocity = velocity;
  state_->measure();
}

ClothState Cloth::state() const {
  return {.report = state_->report,
          .positions = state_->x,
          .velocities = state_->velocity,
          .was_stiff = state_->solver.was_stiff()};
}

void Cloth::restore(const ClothState& state) {
  State& s = *state_;
  if (state.positions.size() != s.x.size() || state.velocities.size() != s.x.size()) {
    throw std::logic_error("Cloth::restore: not three numbers for each vertex");
  }
  s.move_to(state.positions);
  s.velocity = state.velocities;
  s.report = state.report;
  s.solver.set_was_stiff(state.was_stiff);
}

ClothReport Cloth::step() {
  State& s = *state_;
  const cloth::Step step = cloth::make_step(s.model, s.x, s.velocity);
  cloth::Minimum minimum = s.solver.minimize(step);
  s.report = {.frame = s.report.frame + 1,
              .residual = minimum.residual,
              .iterations = minimum.iterations,
              .converged = minimum.converged && minimum.x.allFinite()};
  if (s.report.converged) {
    const Eigen::VectorXd moved = minimum.x - s.x;
    s.report.slack = minimum.gradient.dot(moved);
    s.velocity = moved / s.model.settings.time_step;
    s.move_to(std::move(minimum.x));
  } else {
    s.velocity.setZero();
    s.report.warning = "the solver did not converge: " + minimum.reason +
                       "; the cloth stays where it was, at rest";
  }
  s.measure();
  return s.report;
}

}  // namespace farcull
