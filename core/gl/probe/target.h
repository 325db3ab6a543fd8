// Declares the groups of probes and what they share: random numbers, results, and a render target
// that places proxies as the canvas does. Only core/gl/probe includes this file.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/gl/base/objects.h"
#include "core/gl/canvas/canvas.h"
#include "core/gl/probe/probe.h"
#include "core/view/budget.h"

namespace farcull::probe {

/// A group of probes. The comments name the assumptions that each group probes.
using Group = std::vector<ProbeResult>(const GlContext& context, const ProbeOptions& options);
Group edges;        // A1, A2
Group coverage;     // A3, A9
Group arithmetic;   // A4, A9
Group depth_tests;  // A5
Group queries;      // A6
Group commands;     // A7
Group memory;       // A8
Group driver;       // A10

struct Random : RandomNumbers {
  using RandomNumbers::RandomNumbers;
  int below(int n) { return static_cast<int>(word() >> 33) % n; }
  /// Returns a normal float of either sign, with an exponent in [lowest, highest].
  float normal(int lowest, int highest);
  float in_float(double lo, double hi) { return static_cast<float>(between(lo, hi)); }
};

/// Returns the float that is `steps` floats above x (below x if `steps` is negative).
float neighbour(float x, int steps);

/// Collects the worst measured value (add(); NaN counts as infinite), or counts wrong results.
struct Worst {
  double value = 0;
  std::uint64_t samples = 0;
  void add(double x) {
    ++samples;
    if (std::isnan(x)) x = std::numeric_limits<double>::infinity();
    if (x > value) value = x;
  }
  void count(bool wrong) {
    ++samples;
    value += wrong;
  }
};

ProbeResult result(const std::string& assumption, const std::string& name, const Worst& measured,
                   double bound, const std::string& unit, const std::string& note);

/// Returns the result of a probe that failed because an Error ended it.
ProbeResult broken(const std::string& assumption, const std::string& name, const Error& error);

/// A kind of canvas to probe: how it tests visibility, and its depth format.
struct Configuration {
  const char* name;
  GlCanvasOptions options;
};
inline constexpr Configuration kConfigurations[] = {
    {"flags, 32F", {}},
    {"occlusion queries, 32F", {.query = QueryMode::occlusion}},
    {"occlusion queries, 24 bits",
     {.depth_format = DepthFormat::fixed24, .query = QueryMode::occlusion}}};

/// Runs the probe on a canvas of each configuration and appends the results. If a canvas throws an
/// Error, its probe fails, and the next configuration follows.
using CanvasProbe = ProbeResult(const std::string& name, const GlContext& context,
                                const ProbeOptions& options, const GlCanvasOptions& canvas);
void on_canvases(const std::string& assumption, const std::string& kind, CanvasProbe run,
                 const GlContext& context, const ProbeOptions& options,
                 std::vector<ProbeResult>& out);

/// Returns a proxy with these corners (px from the target's centre) and a solid of zeros. Callers
/// may set the solid's entry (s0.z), exit (s0.w), or a fixed depth (s4.y = 1 and s4.z).
Proxy quad(const std::array<double, 8>& corners);
Proxy box(double x0, double y0, double x1, double y1);
/// Returns a proxy that covers pixel i of a square target. side: px, even. i counts row by row.
Proxy pixel_box(int i, int side);
/// Returns one proxy for each pixel of a square target or window, row by row.
std::vector<Proxy> pixel_proxies(int side);

enum class DepthBuffer { none, float32, fixed24 };

/// A render target of any even size (px). Like GlCanvas, it places proxies with canvas.vert, and
/// with the same viewport and scale to normalized device coordinates. Colour is one uint per pixel.
class Target {
 public:
  Target(int width, int height, DepthBuffer depth = DepthBuffer::none);

  int width() const { return width_; }
  int height() const { return height_; }
  int viewport() const;  // larger side of the viewport, px
  std::size_t pixels() const { return static_cast<std::size_t>(width_) * height_; }

  /// Binds the target, sets its viewport, and clears colour to 0 and depth to `clear`.
  void start(double clear = 1) const;
  /// Sets the depth function, and whether draws store their depths.
  static void depth_test(GLenum function, bool store);
  /// Sets the uniforms of canvas.vert and canvas.frag, and u_width. The program remains in use.
  void use(GLuint program, float depth_scale = 1) const;
  /// Uploads `proxies` as elements 0, 1, .... The slot of each element is the element's index.
  void upload(const std::vector<Proxy>& proxies);
  void draw(std::size_t first, std::size_t count) const;

  GLuint depth_texture() const { return depth_; }
  std::vector<std::uint32_t> colour() const;
  /// Returns the depths as bits: floats for float32, else normalized 32-bit integers.
  std::vector<std::uint32_t> depths() const;

 private:
  std::vector<std::uint32_t> read(GLenum what, GLenum type, const char* doing) const;

  int width_, height_;
  DepthBuffer format_;
  GlTexture colour_, depth_;
  GlFramebuffer framebuffer_;
  GlVertexArray vertex_array_;
  GlBuffer elements_, draws_;
};

/// Links canvas.vert, compiled for proxies, with this source of a fragment program.
GlProgram proxy_program(const std::string& name, const std::vector<std::string>& fragment,
                        std::vector<std::string> defines = {});

/// Fills the buffer with `words` zeros and binds it.
void bind_zeros(GlBuffer& buffer, GLuint binding, std::size_t words);
std::vector<std::uint32_t> words_of(const GlBuffer& buffer, std::size_t words);

/// Returns a window that looks along z, with 1 px per world unit and depths -depth to depth (px).
Window window(int width, int height, double depth = 100);
/// A solid that every line hits. The proxy gives the entry depth (s0.z) and the exit depth (s0.w).
inline constexpr char kDepthSolid[] = R"glsl(
bool solid_interval(vec2 c, vec4 s0, vec4 s1, vec4 s2, vec4 s3, vec4 s4, FAR_OUT(float) entry,
                    FAR_OUT(float) exit) {
  entry = s0.z;
  exit = s0.w;
  return true;
}
)glsl";
inline SolidProgram depth_solid() { return {"probe", kDepthSolid, nullptr}; }

/// Returns the number of rounds of a probe: `n`, or about n / 3 if options.brief is set.
inline int rounds(const ProbeOptions& options, int n) { return options.brief ? (n + 2) / 3 : n; }

/// Returns the largest side (px) that a target of a canvas on this device can have.
int largest_side(const GlContext& context);
/// Return bounds (px per axis) of a corner's displacement by snapping, and by vertex arithmetic.
double snap_bound(const GlContext& context, const ProbeOptions& options);
double vertex_bound(const ProbeOptions& options, int viewport);

}  // namespace farcull::probe
