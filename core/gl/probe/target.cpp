// Runs the groups of probes in order. If an Error ends a group, the group fails and the next group
// runs. Also defines the render target of the probes, which draws with the canvas's vertex program.

#include <algorithm>
#include <numbers>

#include "core/gl/probe/target.h"
#include "embedded/canvas_vert.h"

namespace farcull {

std::vector<ProbeResult> run_probes(const GlContext& context, const ProbeOptions& options,
                                    const std::function<void(const std::string&)>& started) {
  struct Row {
    std::vector<std::string> assumptions;
    probe::Group* run;
  };
  const Row groups[] = {{{"A1", "A2"}, probe::edges},      {{"A3", "A9"}, probe::coverage},
                        {{"A4", "A9"}, probe::arithmetic}, {{"A5"}, probe::depth_tests},
                        {{"A6"}, probe::queries},          {{"A7"}, probe::commands},
                        {{"A8"}, probe::memory},           {{"A10"}, probe::driver}};
  const GlCurrent current(context);
  std::vector<ProbeResult> out;
  for (const Row& group : groups) {
    const auto wanted = [&](const std::string& a) {
      return options.only.empty() || options.only == a;
    };
    if (std::none_of(group.assumptions.begin(), group.assumptions.end(), wanted)) continue;
    if (started) started(group.assumptions.front());
    std::vector<ProbeResult> results;
    try {
      results = group.run(context, options);
    } catch (const Error& error) {
      for (const std::string& assumption : group.assumptions)
        results.push_back(probe::broken(assumption, "broke off", error));
    }
    for (ProbeResult& r : results) {
      if (wanted(r.assumption)) out.push_back(std::move(r));
    }
  }
  return out;
}

namespace probe {

float Random::normal(int lowest, int highest) {
  const std::uint64_t r = word();
  const int exponent = lowest + below(highest - lowest + 1);
  std::uint32_t mantissa = static_cast<std::uint32_t>(r) & 0x7fffff;
  // Rounding errors are likeliest at the ends of a binade and at mantissas with few bits.
  const std::uint64_t way = r >> 40 & 7;
  if (way == 0) mantissa &= 3;
  if (way == 1) mantissa |= 0x7ffffc;
  if (way == 2) mantissa &= 0x7ff000;
  const std::uint32_t sign = static_cast<std::uint32_t>(r >> 63) << 31;
  return std::bit_cast<float>(sign | static_cast<std::uint32_t>(exponent + 127) << 23 | mantissa);
}

float neighbour(float x, int steps) {
  const float towards =
      steps > 0 ? std::numeric_limits<float>::infinity() : -std::numeric_limits<float>::infinity();
  for (int i = 0; i < std::abs(steps); ++i) x = std::nextafter(x, towards);
  return x;
}

ProbeResult result(const std::string& assumption, const std::string& name, const Worst& measured,
                   double bound, const std::string& unit, const std::string& note) {
  return {assumption,
          name,
          measured.value,
          bound,
          unit,
          measured.samples,
          measured.samples > 0 && measured.value <= bound,
          note};
}

ProbeResult broken(const std::string& assumption, const std::string& name, const Error& error) {
  return {
      .assumption = assumption, .name = name, .unit = "", .note = error.what(), .broke_off = true};
}

void on_canvases(const std::string& assumption, const std::string& kind, CanvasProbe run,
                 const GlContext& context, const ProbeOptions& options,
                 std::vector<ProbeResult>& out) {
  for (const Configuration& configuration : kConfigurations) {
    const std::string name = kind + ", " + configuration.name;
    try {
      out.push_back(run(name, context, options, configuration.options));
    } catch (const Error& error) {
      out.push_back(broken(assumption, name, error));
    }
  }
}

Proxy quad(const std::array<double, 8>& corners) {
  Proxy out{};
  for (std::size_t i = 0; i < 8; ++i) out.corners[i] = static_cast<float>(corners[i]);
  return out;
}

Proxy box(double x0, double y0, double x1, double y1) {
  return quad({x0, y0, x1, y0, x1, y1, x0, y1});
}

Proxy pixel_box(int i, int side) {
  const int row = i / side, column = i % side;
  const double x = column - 0.5 * side, y = row - 0.5 * side;
  return box(x, y, x + 1, y + 1);
}

std::vector<Proxy> pixel_proxies(int side) {
  std::vector<Proxy> out;
  out.reserve(static_cast<std::size_t>(side) * side);
  for (int i = 0; i < side * side; ++i) out.push_back(pixel_box(i, side));
  return out;
}

Target::Target(int width, int height, DepthBuffer depth)
    : width_(width), height_(height), format_(depth) {
  colour_ = gl_texture(GL_R32UI, width, height);
  framebuffer_ = gl_make<GlFramebuffer>(glGenFramebuffers);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  if (depth != DepthBuffer::none) {
    depth_ =
        gl_texture(depth == DepthBuffer::float32 ? GL_DEPTH_COMPONENT32F : GL_DEPTH_COMPONENT24,
                   width, height);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
  }
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  check_gl("probe target");
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("GL probe target",
                "the device refuses a target of " + std::to_string(width) + " x " +
                    std::to_string(height) + " px",
                "try another {device}");
  }
  vertex_array_ = gl_make<GlVertexArray>(glGenVertexArrays);
  elements_ = gl_make<GlBuffer>(glGenBuffers);
  draws_ = gl_make<GlBuffer>(glGenBuffers);
}

int Target::viewport() const { return viewport_side(std::max(width_, height_) - 2 * kBorder); }

void Target::start(double clear) const {
  glBindVertexArray(vertex_array_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const int vw = viewport_side(width_ - 2 * kBorder), vh = viewport_side(height_ - 2 * kBorder);
  glViewport(width_ / 2 - vw / 2, height_ / 2 - vh / 2, vw, vh);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_CLAMP);
  glDepthRange(0, 1);
  const GLuint zero[4] = {0, 0, 0, 0};
  glClearBufferuiv(GL_COLOR, 0, zero);
  if (format_ == DepthBuffer::none) {
    glDisable(GL_DEPTH_TEST);
  } else {
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    const float depth = static_cast<float>(clear);
    glClearBufferfv(GL_DEPTH, 0, &depth);
  }
}

void Target::depth_test(GLenum function, bool store) {
  glDepthFunc(function);
  glDepthMask(store ? GL_TRUE : GL_FALSE);
}

void Target::use(GLuint program, float depth_scale) const {
  glUseProgram(program);
  glUniform2f(glGetUniformLocation(program, "u_to_ndc"),
              2.0f / static_cast<float>(viewport_side(width_ - 2 * kBorder)),
              2.0f / static_cast<float>(viewport_side(height_ - 2 * kBorder)));
  glUniform1f(glGetUniformLocation(program, "u_scale"), depth_scale);
  glUniform4i(glGetUniformLocation(program, "u_window"), 0, 0, width_, height_);
  glUniform2f(glGetUniformLocation(program, "u_centre"), 0.5f * static_cast<float>(width_),
              0.5f * static_cast<float>(height_));
  glUniform1ui(glGetUniformLocation(program, "u_width"), static_cast<GLuint>(width_));
}

void Target::upload(const std::vector<Proxy>& proxies) {
  std::vector<std::uint32_t> list(2 * proxies.size());
  for (std::size_t i = 0; i < proxies.size(); ++i)
    list[2 * i] = list[2 * i + 1] = static_cast<std::uint32_t>(i);
  gl_fill(elements_, proxies.data(), proxies.size() * sizeof(Proxy));
  gl_fill(draws_, list.data(), list.size() * sizeof(std::uint32_t));
}

void Target::draw(std::size_t first, std::size_t count) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, elements_);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, draws_);
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(6 * first), static_cast<GLsizei>(6 * count));
}

std::vector<std::uint32_t> Target::colour() const {
  return read(GL_RED_INTEGER, GL_UNSIGNED_INT, "probe colours");
}

std::vector<std::uint32_t> Target::depths() const {
  return read(GL_DEPTH_COMPONENT, format_ == DepthBuffer::float32 ? GL_FLOAT : GL_UNSIGNED_INT,
              "probe depths");
}

std::vector<std::uint32_t> Target::read(GLenum what, GLenum type, const char* doing) const {
  std::vector<std::uint32_t> out(pixels());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width_, height_, what, type, out.data());
  check_gl(doing);
  return out;
}

GlProgram proxy_program(const std::string& name, const std::vector<std::string>& fragment,
                        std::vector<std::string> defines) {
  defines.push_back("FAR_PROXY");
  return gl_program("probe " + name, defines,
                    {{GL_VERTEX_SHADER, {embedded::canvas_vert}}, {GL_FRAGMENT_SHADER, fragment}});
}

void bind_zeros(GlBuffer& buffer, GLuint binding, std::size_t words) {
  if (buffer == 0) buffer = gl_make<GlBuffer>(glGenBuffers);
  gl_fill(buffer, nullptr, words * sizeof(std::uint32_t));
  const GLuint zero = 0;
  glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

std::vector<std::uint32_t> words_of(const GlBuffer& buffer, std::size_t words) {
  std::vector<std::uint32_t> out(words);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                     static_cast<GLsizeiptr>(words * sizeof(std::uint32_t)), out.data());
  check_gl("probe results");
  return out;
}

Window window(int width, int height, double depth) {
  Window out;
  out.view = parse_view("z");
  out.origin = Vec3::Zero();
  out.map = out.view.rows;
  out.pixel_size = 1;
  out.width = width;
  out.height = height;
  out.hi = Vec3(0.5 * width, 0.5 * height, depth);
  out.lo = -out.hi;
  return out;
}

int largest_side(const GlContext& context) {
  const GlInfo& info = context.info();
  GLint framebuffer[2] = {0, 0};
  glGetIntegerv(GL_MAX_FRAMEBUFFER_WIDTH, &framebuffer[0]);
  glGetIntegerv(GL_MAX_FRAMEBUFFER_HEIGHT, &framebuffer[1]);
  const int side =
      std::min({info.max_viewport, info.max_texture_size, framebuffer[0], framebuffer[1]});
  return static_cast<int>(std::bit_floor(static_cast<unsigned>(side)));
}

double snap_bound(const GlContext& context, const ProbeOptions& options) {
  return std::ldexp(1.0,
                    -(options.snap_bits > 0 ? options.snap_bits : context.info().subpixel_bits));
}

double vertex_bound(const ProbeOptions& options, int viewport) {
  // Budget::vertex bounds a distance in the plane. Dividing by sqrt(2) gives a bound per axis.
  return options.no_vertex_term ? 0 : budget_for({}, viewport).vertex / std::numbers::sqrt2;
}

}  // namespace probe
}  // namespace farcull
