// A file is text for people, then numbers as they are in memory, then a checksum:
//   farcull cloth 1, settings HASH, arithmetic HASH, frame N
//   the report, positions, velocities, and what the solver remembers
//   FNV-1a of all bytes before it
// A checksum of FNV-1a differs whenever one byte differs: each of its steps is a bijection.
#include "experiments/scenes/cloth/kept.h"

#include <Eigen/Core>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "experiments/system/output_file.h"

namespace farcull {
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

// What this program makes of a small stiff cloth that meets the sphere, where interior points are
// needed as well. Another version of the simulation, or another way to round, gives other doubles.
// Products of large matrices round by the blocks that they are cut into, which Eigen chooses by the
// sizes of the caches.
std::string arithmetic() {
  static const std::string hash = [] {
    constexpr int kSteps = 12;  // it meets the sphere in step 7
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

// Takes numbers from a text. Past its end it gives zeros, and fits() is false.
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
  // The number of the parts that follow, of so many bytes each; 0 where they are not there.
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
  ClothReport& r = state.report;
  r.frame = frame;
  for (double* value :
       {&r.kinetic, &r.elastic, &r.bending, &r.gravitational, &r.contact, &r.residual, &r.slack})
    reader.get(*value);
  reader.get(r.iterations);
  reader.get(r.converged);
  reader.get(r.warning);
  reader.get(state.was_stiff);
  reader.get(state.positions);
  reader.get(state.velocities);
  if (!reader.at_end()) refuse("is not as this farcull writes it", again);
  return state;
}

void KeptCloth::write(const ClothState& state) const {
  const ClothReport& r = state.report;
  std::string text = heading_ + frame_line(r.frame);
  for (const double value :
       {r.kinetic, r.elastic, r.bending, r.gravitational, r.contact, r.residual, r.slack})
    put(text, value);
  put(text, r.iterations);
  put(text, r.converged);
  put(text, r.warning);
  put(text, state.was_stiff);
  put(text, state.positions);
  put(text, state.velocities);
  put(text, checksum(text));
  if (const int failure = replace_file(path(r.frame), text)) {
    throw Error(path(r.frame), std::string("cannot be written: ") + std::strerror(failure),
                "make room on the disk, or name another folder in FARCULL_CLOTH");
  }
}

}  // namespace farcull
