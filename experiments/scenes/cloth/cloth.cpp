// Advances the cloth step by step: the model gives the function of a step, the solver minimizes it.
// States are kept in files: a line of text, then numbers as they are in memory, then a checksum:
//   farcull cloth 1, settings HASH, arithmetic HASH, frame N
//   the report, positions, velocities, and the state of the solver
//   FNV-1a of all bytes before it
// A changed byte always changes the checksum: each step of FNV-1a is a bijection.
#include "experiments/scenes/cloth/cloth.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "experiments/scenes/mesh/scene_build.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

// The finest sphere with at most half as many triangles as the cloth: about as fine as the cloth.
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
  return {.report = state_->report,
          .positions = state_->x,
          .velocities = state_->velocity,
          .was_stiff = state_->solver.was_stiff()};
}

void Cloth::restore(const ClothState& state) {
  State& s = *state_;
  if (state.positions.size() != s.x.size() || state.velocities.size() != s.x.size())
    throw std::logic_error("Cloth::restore: not three numbers for each vertex");
  s.move_to(state.positions);
  s.velocity = state.velocities;
  s.report = state.report;
  s.solver.set_was_stiff(state.was_stiff);
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

namespace {

static_assert(std::endian::native == std::endian::little, "files hold numbers as in memory");

void add(Fnv1a& hash, double value) { hash.add(std::bit_cast<std::uint64_t>(value)); }

std::string hash_of(const ClothSettings& s) {
  Fnv1a hash;
  hash.add(s.triangles);
  for (const double value :
       {s.stiffness, s.side, s.density, s.buckling_load, s.bending_rigidity, s.gravity, s.drag,
        s.radius, s.contact_modulus, s.friction, s.stick_speed, s.height, s.time_step, s.tolerance})
    add(hash, value);
  hash.add(static_cast<std::uint64_t>(s.max_iterations));
  hash.add(s.seed);
  return hash.hex();
}

// A hash of the results for a small stiff cloth that meets the sphere: its steps need both Newton's
// method and interior points. Another version of the simulation, or another rounding, gives other
// doubles. The hash includes the sizes of the caches: Eigen cuts products of large matrices into
// blocks of sizes that depend on the caches, and the blocks determine the rounding.
std::string arithmetic() {
  static const std::string hash = [] {
    constexpr int kSteps = 12;  // the cloth meets the sphere in step 7
    ClothSettings settings;
    settings.triangles = 200;
    settings.stiffness = 1e6;
    Cloth cloth(settings);
    for (int i = 0; i < kSteps; ++i) cloth.step();
    Fnv1a out;
    const ClothState state = cloth.state();
    for (const double value : state.positions) add(out, value);
    for (const double value : state.velocities) add(out, value);
    out.add(Eigen::SimdInstructionSetsInUse());
    for (const Eigen::Index size :
         {Eigen::l1CacheSize(), Eigen::l2CacheSize(), Eigen::l3CacheSize()})
      out.add(static_cast<std::uint64_t>(size));
    return out.hex();
  }();
  return hash;
}

template <class Number>
void put(std::string& out, const Number& number) {
  static_assert(std::is_arithmetic_v<Number>);
  char bytes[sizeof number];
  std::memcpy(bytes, &number, sizeof number);
  out.append(bytes, sizeof number);
}
void put(std::string& out, const std::string& text) {
  put(out, static_cast<std::uint64_t>(text.size()));
  out += text;
}
void put(std::string& out, const Eigen::VectorXd& values) {
  put(out, static_cast<std::uint64_t>(values.size()));
  for (const double value : values) put(out, value);
}

// Reads numbers from a text. Past its end it returns zeros, and fits() is false.
class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {}

  bool skip(const std::string& expected) {
    if (text_.compare(at_, expected.size(), expected) != 0) return false;
    at_ += expected.size();
    return true;
  }
  void get(std::string& out) {
    const std::uint64_t size = count(1);
    if (fits_) out = text_.substr(at_, size);
    at_ += out.size();
  }
  void get(Eigen::VectorXd& out) {
    out.resize(static_cast<Eigen::Index>(count(sizeof(double))));
    for (double& value : out) get(value);
  }
  void get(bool& flag) {
    unsigned char byte = 0;
    get(byte);
    flag = byte != 0;
  }
  template <class Number>
  void get(Number& number) {
    static_assert(std::is_arithmetic_v<Number>);
    number = {};
    fits_ = fits_ && text_.size() - at_ >= sizeof number;
    if (!fits_) return;
    std::memcpy(&number, text_.data() + at_, sizeof number);
    at_ += sizeof number;
  }
  bool at_end() const { return fits_ && at_ == text_.size(); }

 private:
  // Reads how many parts of `bytes` bytes each follow; 0 if the text is too short for them.
  std::uint64_t count(std::size_t bytes) {
    std::uint64_t out = 0;
    get(out);
    fits_ = fits_ && out <= (text_.size() - at_) / bytes;
    return fits_ ? out : 0;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  bool fits_ = true;
};

// Visits all numbers of a state in a file except the frame, in the order of the file.
template <class State, class Do>
void for_each_number(State& state, const Do& take) {
  auto& r = state.report;
  for (auto* value :
       {&r.kinetic, &r.elastic, &r.bending, &r.gravitational, &r.contact, &r.residual, &r.slack})
    take(*value);
  take(r.iterations);
  take(r.converged);
  take(r.warning);
  take(state.was_stiff);
  take(state.positions);
  take(state.velocities);
}

std::string frame_line(long frame) { return "frame " + std::to_string(frame) + "\n"; }

std::uint64_t checksum(std::string_view text) {
  Fnv1a hash;
  hash.add(text);
  return std::strtoull(hash.hex().c_str(), nullptr, 16);
}

void make(const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (std::filesystem::is_directory(folder)) return;
  throw Error(folder.string(), "the folder of the cloth cannot be made: " + code.message(),
              "name another one in FARCULL_CLOTH, or unset it");
}

}  // namespace

std::string cloth_folder() {
  const char* const folder = std::getenv("FARCULL_CLOTH");
  return folder != nullptr ? folder : "";
}

KeptCloth::KeptCloth(const std::string& folder, const ClothSettings& settings)
    : heading_("farcull cloth 1\nsettings " + hash_of(settings) + "\narithmetic " + arithmetic() +
               "\n") {
  std::ostringstream name;
  name << settings.triangles << "-" << settings.stiffness << "-" << hash_of(settings);
  const std::filesystem::path path = std::filesystem::path(folder) / name.str();
  make(path);
  folder_ = path.string();
}

std::string KeptCloth::path(long frame) const {
  std::string number = std::to_string(frame);
  if (number.size() < 4) number.insert(0, 4 - number.size(), '0');
  return folder_ + "/" + number + ".state";
}

long KeptCloth::last(long frame) const {
  std::error_code code;
  for (; frame > 0; --frame) {
    if (std::filesystem::exists(std::filesystem::symlink_status(path(frame), code))) break;
  }
  return frame;
}

ClothState KeptCloth::read(long frame) const {
  const std::string file = path(frame);
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  if (!in || !bytes)
    throw Error(file, "cannot be read", "make it readable, or remove it: it is simulated again");
  std::string text = std::move(bytes).str();
  const auto refuse = [&](const std::string& why, const std::string& remedy) {
    throw Error(file, why, remedy);
  };
  const std::string again = "remove it: this frame is then simulated again";
  std::uint64_t sum = 0;
  if (text.size() < sizeof sum) refuse("is truncated", again);
  std::memcpy(&sum, text.data() + text.size() - sizeof sum, sizeof sum);
  text.resize(text.size() - sizeof sum);
  if (sum != checksum(text)) refuse("is damaged: its checksum is that of other bytes", again);
  Reader reader(text);
  if (!reader.skip(heading_)) {
    refuse("is the state of another cloth, or of a farcull or a machine that rounds otherwise",
           "name another folder in FARCULL_CLOTH, or remove this one");
  }
  if (!reader.skip(frame_line(frame))) refuse("is of another frame", again);
  ClothState state;
  state.report.frame = frame;
  for_each_number(state, [&](auto& value) { reader.get(value); });
  if (!reader.at_end()) refuse("is not as this farcull writes it", again);
  return state;
}

void KeptCloth::write(const ClothState& state) const {
  const long frame = state.report.frame;
  std::string text = heading_ + frame_line(frame);
  for_each_number(state, [&](const auto& value) { put(text, value); });
  put(text, checksum(text));
  if (const int failure = replace_file(path(frame), text)) {
    throw Error(path(frame), std::string("cannot be written: ") + std::strerror(failure),
                "make room on the disk, or name another folder in FARCULL_CLOTH");
  }
}

}  // namespace farcull
