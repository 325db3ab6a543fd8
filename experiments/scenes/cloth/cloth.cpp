// Advances the cloth step by step: the model gives the function of a step, the solver minimizes it.
#include "experiments/scenes/cloth/cloth.h"

#include <stdexcept>
#include <utility>

#include "experiments/scenes/mesh/scene_build.h"

namespace farcull {
namespace {

// The level of the finest sphere that has at most half as many triangles as the cloth.
int sphere_level(std::uint64_t triangles) {
  int level = 0;
  while (20 * (std::uint64_t{4} << (2 * level)) <= triangles / 2) ++level;
  return level;
}

Scene make_scene(const cloth::Model& model) {
  std::vector<Vec3> rest;
  for (Eigen::Index v = 0; v < model.rest.size(); v += 3)
    rest.emplace_back(model.rest.segment<3>(v));
  const Mesh square = shapes::finished(std::move(rest), model.triangles);
  Mesh ball;
  if (model.settings.radius > 0) ball = shapes::sphere(sphere_level(model.triangles.size()));
  for (Vec3& p : ball.vertices) p *= model.settings.radius;
  Scene scene;
  scene.name = "cloth";
  append_object("cloth", square.vertices, square.triangles, square.source_face, scene);
  append_object("sphere", ball.vertices, ball.triangles, ball.source_face, scene);
  scene.objects[0].self = true;
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

ClothState Cloth::state() const {
  return {.report = state_->report, .positions = state_->x, .velocities = state_->velocity};
}

void Cloth::restore(const ClothState& state) {
  State& s = *state_;
  if (state.positions.size() != s.x.size() || state.velocities.size() != s.x.size())
    throw std::logic_error("Cloth::restore: not three numbers for each vertex");
  s.move_to(state.positions);
  s.velocity = state.velocities;
  s.report = state.report;
  s.measure();
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
