#include "core/gl_canvas.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/gl_objects.h"
#include "embedded/canvas_frag.h"
#include "embedded/canvas_vert.h"
#include "embedded/pack_comp.h"

namespace farcull {
namespace {

// Control items stand in the corner pixel of the render target, outside the window. The store of
// step k leaves the depth kControlTop - k * kControlGap there; the next ask's control item, half a
// gap behind it, is seen only if that store ran.
constexpr double kControlTop = 0.95;
constexpr double kControlGap = 0x1p-21;
constexpr std::size_t kMaxControls = 400'000;  // kControlTop - kMaxControls * kControlGap > 0.75

constexpr std::uint32_t kNone = 0xffffffff;
constexpr GLuint kElements = 0, kDraws = 1, kFlags = 2, kBits = 3,
                 kFinished = 4;  // storage buffer bindings

struct GpuDraw {
  std::uint32_t element;
  std::uint32_t slot;
};

// Consecutive draws of one step that fetch from one element buffer.
struct Run {
  std::size_t step;
  Verb verb;
  std::size_t chunk;   // element buffer; kExtras for the canvas's own elements
  std::size_t offset;  // into the draw list
  std::size_t count;
};
constexpr std::size_t kExtras = static_cast<std::size_t>(-1);

}  // namespace

struct GlCanvas::State {
  const GlContext& context;
  DepthMode mode;
  GlCanvasOptions options;
  std::string solid;  // GLSL
  RasterLimits limits;
  Fault fault = Fault::none;

  GlProgram store_program, ask_program, pack_program, exit_program, entry_values, exit_values;
  GlVertexArray vertex_array;
  GlTexture depth;
  GlFramebuffer depth_target, bare_target;
  int target_width = 0, target_height = 0;
  std::vector<GlBuffer> chunks;
  std::size_t per_chunk = 0;  // elements
  std::size_t elements = 0;
  GlBuffer extras, draws, flags, bits, finished;
  std::size_t alignment = 256;  // of a storage buffer range, in bytes
  std::vector<GlQuery> queries;
  Window window;

  State(const GlContext& c, DepthMode m, const GlCanvasOptions& o)
      : context(c), mode(m), options(o) {}

  std::size_t vec4s() const { return mode == DepthMode::fragment ? 7 : 3; }
  GLsizei vertices() const { return mode == DepthMode::fragment ? 6 : 3; }
  // Proxies write their depth, so their fragments compare with the stored one themselves. Triangles
  // at fixed depth let the depth test decide before the fragment program raises the flag: then no
  // step reads the texture that another draws to, which would have to be finished first.
  bool compares_in_shader() const {
    return options.query == QueryMode::flags && mode == DepthMode::fragment;
  }
  GLuint primitives() const { return mode == DepthMode::fragment ? 2 : 1; }

  GlProgram program(const std::string& name, std::vector<std::string> defines) const;
  void start(double clear) const;  // viewport, target and depth buffer of a pass
  void resize_target();
  void set_uniforms(GLuint program) const;
  // A quadrilateral of the canvas's own as elements at a fixed depth; one proxy or two triangles.
  void add_quad(std::vector<float>& out, double x0, double y0, double x1, double y1,
                float depth) const;
  std::size_t quad_elements() const { return mode == DepthMode::fragment ? 1 : 2; }
  void add_control(std::vector<float>& out, float depth) const;

  std::vector<Run> lay_out(const Pass& pass, std::vector<GpuDraw>& list, std::vector<float>& own,
                           std::uint32_t& slots) const;
  // What storing or asking needs of GL's state.
  void set_verb(Verb verb, bool touching) const;
  // Binds a run's buffers; `before`: the run that was bound last, whose elements may serve again.
  void bind(const Run& run, const Run* before = nullptr) const;
  void draw(std::size_t first, std::size_t count) const;
  float draw_all(GLuint program, Verb verb, const std::vector<Draw>& wanted, GLuint target);
  std::vector<std::uint8_t> read_flags(std::uint32_t slots);
  std::vector<std::uint8_t> read_queries(std::uint32_t slots);
};

void GlCanvas::State::resize_target() {
  const int width = window.width + 2 * kBorder, height = window.height + 2 * kBorder;
  if (width == target_width && height == target_height) return;
  target_width = 0;
  depth = gl_make<GlTexture>(glGenTextures);
  glBindTexture(GL_TEXTURE_2D, depth);
  glTexStorage2D(
      GL_TEXTURE_2D, 1,
      options.depth_format == DepthFormat::float32 ? GL_DEPTH_COMPONENT32F : GL_DEPTH_COMPONENT24,
      width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  depth_target = gl_make<GlFramebuffer>(glGenFramebuffers);
  glBindFramebuffer(GL_FRAMEBUFFER, depth_target);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  glDrawBuffer(GL_NONE);
  const GLenum depth_status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  bare_target = gl_make<GlFramebuffer>(glGenFramebuffers);
  glBindFramebuffer(GL_FRAMEBUFFER, bare_target);
  glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, width);
  glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, height);
  glDrawBuffer(GL_NONE);
  const GLenum bare_status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  check_gl("render target of " + std::to_string(width) + " x " + std::to_string(height) + " px");
  if (depth_status != GL_FRAMEBUFFER_COMPLETE || bare_status != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("GL render target",
                "the device refuses a depth target of " + std::to_string(width) + " x " +
                    std::to_string(height) + " px",
                "choose a smaller resolution, another --depth-format or another --device");
  }
  target_width = width;
  target_height = height;
}

void GlCanvas::State::set_uniforms(GLuint program) const {
  glUseProgram(program);
  glUniform2f(glGetUniformLocation(program, "u_to_ndc"),
              2.0f / static_cast<float>(viewport_side(window.width)),
              2.0f / static_cast<float>(viewport_side(window.height)));
  glUniform1f(glGetUniformLocation(program, "u_scale"), depth_scale(window));
  glUniform4i(glGetUniformLocation(program, "u_window"), kBorder, kBorder, window.width,
              window.height);
  glUniform2f(glGetUniformLocation(program, "u_centre"), static_cast<float>(target_width / 2),
              static_cast<float>(target_height / 2));
  glUniform1i(glGetUniformLocation(program, "u_depth"), 0);
}

void GlCanvas::State::add_quad(std::vector<float>& out, double x0, double y0, double x1, double y1,
                               float d) const {
  const float l = static_cast<float>(x0), b = static_cast<float>(y0), r = static_cast<float>(x1),
              t = static_cast<float>(y1);
  if (mode == DepthMode::fragment) {
    out.insert(out.end(), {l, b, r, b, r, t, l, t});
    out.insert(out.end(), 16, 0.0f);
    out.insert(out.end(), {0.0f, 1.0f, d, 0.0f});
  } else {
    out.insert(out.end(), {l, b, d, 1, r, b, d, 1, r, t, d, 1});
    out.insert(out.end(), {l, b, d, 1, r, t, d, 1, l, t, d, 1});
  }
}

void GlCanvas::State::add_control(std::vector<float>& out, float d) const {
  const double x = -0.5 * target_width, y = -0.5 * target_height;
  add_quad(out, x, y, x + 1, y + 1, d);
}

// The draw list of a pass, cut into runs; `own` receives the canvas's own elements: the quad for
// kEverywhere, which covers the window and nothing of the border, and the control items. Control
// slots follow the pass's own.
std::vector<Run> GlCanvas::State::lay_out(const Pass& pass, std::vector<GpuDraw>& list,
                                          std::vector<float>& own, std::uint32_t& slots) const {
  add_quad(own, -0.5 * window.width - 0.25, -0.5 * window.height - 0.25, 0.5 * window.width + 0.25,
           0.5 * window.height + 0.25, 0.0f);
  std::vector<Run> runs;
  std::size_t own_elements = quad_elements();
  std::size_t stores = 0;
  bool fresh = true;  // the next draw starts a run
  const std::size_t grain = alignment / sizeof(GpuDraw);
  std::size_t index = 0;
  const auto push = [&](Verb verb, std::size_t chunk, std::uint32_t element, std::uint32_t slot) {
    if (fresh || runs.back().chunk != chunk) {
      list.resize((list.size() + grain - 1) / grain * grain, GpuDraw{0, 0});
      runs.push_back({index, verb, chunk, list.size(), 0});
      fresh = false;
    }
    list.push_back({element, slot});
    ++runs.back().count;
  };
  slots = pass.slots;
  for (const Step& step : pass.steps) {
    fresh = true;
    for (std::uint32_t i = step.first; i < step.first + step.count; ++i) {
      const Draw& d = pass.draws[i];
      if (d.element == kEverywhere) {
        for (std::size_t q = 0; q < quad_elements(); ++q)
          push(step.verb, kExtras, static_cast<std::uint32_t>(q), d.slot);
      } else {
        push(step.verb, d.element / per_chunk, static_cast<std::uint32_t>(d.element % per_chunk),
             d.slot);
      }
    }
    stores += step.verb == Verb::store;
    if (stores > kMaxControls) {
      throw Error("GL pass",
                  "more than " + std::to_string(kMaxControls) +
                      " owners (objects; for s-cullide triangles) are stored in one pass",
                  "join objects that cannot collide with each other, or use far-pairs");
    }
    const double behind = step.verb == Verb::store ? 0 : 0.5;
    add_control(own, static_cast<float>(kControlTop -
                                        (static_cast<double>(stores) - behind) * kControlGap));
    const std::uint32_t slot = step.verb == Verb::store ? 0 : slots++;
    for (std::size_t q = 0; q < quad_elements(); ++q)
      push(step.verb, kExtras, static_cast<std::uint32_t>(own_elements++), slot);
    ++index;
  }
  return runs;
}

// A pass may have as many steps as triangles: what a step does not need is not called.
void GlCanvas::State::set_verb(Verb verb, bool touching) const {
  const bool ask = verb == Verb::ask;
  glUseProgram(ask ? ask_program : store_program);
  if (ask && compares_in_shader()) {
    glBindFramebuffer(GL_FRAMEBUFFER, bare_target);
    glDisable(GL_DEPTH_TEST);
    return;
  }
  if (compares_in_shader()) {
    glBindFramebuffer(GL_FRAMEBUFFER, depth_target);
    glEnable(GL_DEPTH_TEST);
  }
  glDepthMask(ask ? GL_FALSE : GL_TRUE);
  if (ask) {
    glDepthFunc(touching ? GL_GEQUAL : GL_GREATER);
  } else {
    glDepthFunc(options.reversed_depth_test ? GL_GREATER : GL_LESS);
  }
}

void GlCanvas::State::bind(const Run& run, const Run* before) const {
  if (before == nullptr || before->chunk != run.chunk) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kElements,
                     run.chunk == kExtras ? extras : chunks[run.chunk]);
  }
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, kDraws, draws,
                    static_cast<GLintptr>(run.offset * sizeof(GpuDraw)),
                    static_cast<GLsizeiptr>(run.count * sizeof(GpuDraw)));
}

void GlCanvas::State::draw(std::size_t first, std::size_t count) const {
  // GL counts vertices in signed 32-bit numbers.
  constexpr std::size_t kMost = 1u << 26;
  for (std::size_t at = first; at < first + count; at += kMost) {
    const std::size_t n = std::min(kMost, first + count - at);
    glDrawArrays(GL_TRIANGLES, static_cast<GLint>(at) * vertices(),
                 static_cast<GLsizei>(n) * vertices());
  }
}

void GlCanvas::State::start(double clear) const {
  glBindVertexArray(vertex_array);
  const int vw = viewport_side(window.width), vh = viewport_side(window.height);
  glViewport(target_width / 2 - vw / 2, target_height / 2 - vh / 2, vw, vh);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_CLAMP);
  glDepthRange(0, 1);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, depth);
  glBindFramebuffer(GL_FRAMEBUFFER, depth_target);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glClearDepth(clear);
  glClear(GL_DEPTH_BUFFER_BIT);
}

GlProgram GlCanvas::State::program(const std::string& name,
                                   std::vector<std::string> defines) const {
  if (mode == DepthMode::fragment) defines.push_back("FAR_PROXY");
  return gl_program(name, defines,
                    {{GL_VERTEX_SHADER, {embedded::canvas_vert}},
                     {GL_FRAGMENT_SHADER, {solid, embedded::canvas_frag}}});
}

GlCanvas::GlCanvas(const GlContext& context, DepthMode mode, const SolidProgram& solid,
                   const GlCanvasOptions& options)
    : state_(std::make_unique<State>(context, mode, options)) {
  State& s = *state_;
  if (options.query == QueryMode::flags && options.depth_format == DepthFormat::fixed24) {
    throw Error("--query",
                "flags cannot be used with a 24-bit depth buffer: a comparison in the shader loses "
                "equal depths",
                "use --query occlusion or --depth-format 32f");
  }
  const GlInfo& info = context.info();
  s.limits.subpixel_bits = info.subpixel_bits;
  s.limits.depth_bits = options.depth_format == DepthFormat::float32 ? 32 : 24;
  GLint framebuffer[2] = {0, 0};
  glGetIntegerv(GL_MAX_FRAMEBUFFER_WIDTH, &framebuffer[0]);
  glGetIntegerv(GL_MAX_FRAMEBUFFER_HEIGHT, &framebuffer[1]);
  // A window is up to five pixels wider than its resolution (fit_window), and its viewport side a
  // power of two.
  const int viewport = static_cast<int>(std::bit_floor(static_cast<unsigned>(info.max_viewport)));
  s.limits.max_resolution =
      std::min({viewport, info.max_texture_size, framebuffer[0], framebuffer[1]}) - 2 * kBorder - 6;
  long storage = info.max_storage_block;
  GLint offset_alignment = 0;
  glGetIntegerv(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, &offset_alignment);
  s.alignment = std::max<std::size_t>(offset_alignment, sizeof(GpuDraw));
  if (options.storage_limit > 0) storage = std::min(storage, options.storage_limit);
  s.per_chunk = std::max<std::size_t>(1, static_cast<std::size_t>(storage) / (16 * s.vec4s()));

  s.solid = solid.glsl;
  s.store_program = s.program("store", {});
  s.ask_program = options.query == QueryMode::flags ? s.program("ask", {"FAR_ASK", "FAR_FLAGS"})
                                                    : s.program("ask", {"FAR_ASK"});
  s.pack_program = gl_program("pack", {}, {{GL_COMPUTE_SHADER, {embedded::pack_comp}}});
  s.vertex_array = gl_make<GlVertexArray>(glGenVertexArrays);
  for (GlBuffer* buffer : {&s.extras, &s.draws, &s.flags, &s.bits, &s.finished})
    *buffer = gl_make<GlBuffer>(glGenBuffers);
  check_gl("canvas");
}

GlCanvas::~GlCanvas() = default;

const RasterLimits& GlCanvas::limits() const { return state_->limits; }

void GlCanvas::inject(Fault fault) { state_->fault = fault; }

void GlCanvas::begin(const Window& window, const Drawables& drawables) {
  State& s = *state_;
  if (drawables.mode != s.mode)
    throw std::logic_error("GlCanvas::begin: drawables of another depth mode");
  s.window = window;
  s.resize_target();
  s.elements = drawables.elements();
  const char* bytes = s.mode == DepthMode::fragment
                          ? reinterpret_cast<const char*>(drawables.proxies.data())
                          : reinterpret_cast<const char*>(drawables.triangles.data());
  static_assert(sizeof(Proxy) == 7 * 16 && sizeof(drawables.triangles[0]) == 3 * 16);
  const std::size_t size = 16 * s.vec4s();
  const std::size_t chunks = (s.elements + s.per_chunk - 1) / s.per_chunk;
  if (s.chunks.size() > chunks) s.chunks.resize(chunks);
  while (s.chunks.size() < chunks) s.chunks.push_back(gl_make<GlBuffer>(glGenBuffers));
  for (std::size_t c = 0; c < chunks; ++c) {
    const std::size_t first = c * s.per_chunk;
    gl_fill(s.chunks[c], bytes + first * size, std::min(s.per_chunk, s.elements - first) * size);
  }
  s.set_uniforms(s.store_program);
  s.set_uniforms(s.ask_program);
  check_gl("upload");
}

std::vector<std::uint8_t> GlCanvas::run(const Pass& pass) {
  State& s = *state_;
  if (pass.steps.empty()) return std::vector<std::uint8_t>(pass.slots);
  const Fault fault = std::exchange(s.fault, Fault::none);
  std::vector<GpuDraw> list;
  std::vector<float> own;
  std::uint32_t slots = 0;
  const std::vector<Run> runs = s.lay_out(pass, list, own, slots);
  const std::size_t longest =
      std::max_element(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
        return a.count < b.count;
      })->count;
  if (std::max(
          {longest * sizeof(GpuDraw), own.size() * sizeof(float), slots * sizeof(std::uint32_t)}) >
      static_cast<std::size_t>(s.context.info().max_storage_block)) {
    throw Error("GL pass",
                "its draw list or its slots are beyond this device's largest storage block",
                "split the scene into several runs, or choose another --device");
  }
  gl_fill(s.draws, list.data(), list.size() * sizeof(GpuDraw));
  gl_fill(s.extras, own.data(), own.size() * sizeof(float));
  const bool flags = s.options.query == QueryMode::flags;
  if (flags) {
    gl_fill(s.flags, nullptr, slots * sizeof(std::uint32_t));
    const GLuint zero = 0;
    glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kFlags, s.flags);
  } else {
    // New names for every pass: a query that is never issued then has no object, and no stale
    // answer to give.
    s.queries.clear();
    while (s.queries.size() < slots) s.queries.push_back(gl_make<GlQuery>(glGenQueries));
  }
  check_gl("pass upload");

  s.start(1);
  glUseProgram(s.ask_program);
  glUniform1i(glGetUniformLocation(s.ask_program, "u_touching"), pass.touching);
  const GlQuery generated = gl_make<GlQuery>(glGenQueries);
  glBeginQuery(GL_PRIMITIVES_GENERATED, generated);
  GLuint64 expected = 0;
  bool lose_query = fault == Fault::lost_query;
  std::uint32_t open = kNone;  // slot whose occlusion query is active
  const auto end_query = [&open] {
    if (std::exchange(open, kNone) != kNone) glEndQuery(GL_ANY_SAMPLES_PASSED);
  };
  const Run* before = nullptr;  // the run whose state is set
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Run& run = runs[r];
    expected += static_cast<GLuint64>(run.count) * s.primitives();
    if (fault == Fault::lost_draw && r == 0) continue;
    if (before == nullptr || before->verb != run.verb) s.set_verb(run.verb, pass.touching);
    s.bind(run, before);
    before = &run;
    if (run.verb == Verb::store || flags) {
      s.draw(0, run.count);
      continue;
    }
    for (std::size_t from = 0; from < run.count;) {
      const std::uint32_t slot = list[run.offset + from].slot;
      std::size_t to = from + 1;
      while (to < run.count && list[run.offset + to].slot == slot) ++to;
      // A slot's draws may be spread over runs of its step: its query stays open until another slot
      // begins.
      if (slot != open) {
        end_query();
        if (!std::exchange(lose_query, false)) {
          glBeginQuery(GL_ANY_SAMPLES_PASSED, s.queries[slot]);
          open = slot;
        }
        if (fault == Fault::blind_query) end_query();
      }
      s.draw(from, to - from);
      from = to;
    }
    if (r + 1 == runs.size() || runs[r + 1].step != run.step) end_query();
  }
  glEndQuery(GL_PRIMITIVES_GENERATED);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  check_gl("pass");

  GLuint64 drawn = 0;
  glGetQueryObjectui64v(generated, GL_QUERY_RESULT, &drawn);
  if (drawn != expected) {
    throw Error(
        "GL pass",
        std::to_string(drawn) + " of " + std::to_string(expected) + " primitives were drawn",
        "a command was lost: run again, or with another --device");
  }
  if (flags && (fault == Fault::oversized_dispatch || fault == Fault::unfinished_invocation))
    s.fault = fault;
  std::vector<std::uint8_t> seen = flags ? s.read_flags(slots) : s.read_queries(slots);
  check_gl("answers");
  for (std::uint32_t control = pass.slots; control < slots; ++control) {
    if (!seen[control]) {
      throw Error("GL pass",
                  "control item " + std::to_string(control - pass.slots) + " was not seen",
                  "a draw or a query was lost: run again, or with another --device");
    }
  }
  seen.resize(pass.slots);
  return seen;
}

// Draws everything with one program into a target that shares the canvas's depth texture; returns
// the depth that the control item left.
float GlCanvas::State::draw_all(GLuint program, Verb verb, const std::vector<Draw>& wanted,
                                GLuint target) {
  const bool store = verb == Verb::store;
  Pass pass;
  pass.draws = wanted;
  pass.steps = {{Verb::store, 0, static_cast<std::uint32_t>(wanted.size())}};
  std::vector<GpuDraw> list;
  std::vector<float> own;
  std::uint32_t slots = 0;
  const std::vector<Run> runs = lay_out(pass, list, own, slots);
  gl_fill(draws, list.data(), list.size() * sizeof(GpuDraw));
  gl_fill(extras, own.data(), own.size() * sizeof(float));
  set_uniforms(program);
  start(store ? 1 : 0);
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glDepthFunc(store ? GL_LESS : GL_GREATER);
  for (const Run& run : runs) {
    bind(run);
    draw(0, run.count);
  }
  float control = 0;
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &control);
  check_gl("samples");
  return control;
}

std::vector<float> GlCanvas::depths(Verb verb, const std::vector<Draw>& wanted) {
  State& s = *state_;
  const bool exits = verb == Verb::ask && s.mode == DepthMode::fragment;
  if (exits && s.exit_program == 0) s.exit_program = s.program("exit", {"FAR_ASK"});
  const float control =
      s.draw_all(exits ? s.exit_program : s.store_program, verb, wanted, s.depth_target);
  // 24 bits move it by at most depth_rounding() steps, far less than half a gap.
  const double moved = std::abs(control - (kControlTop - kControlGap));
  if (moved > (s.limits.depth_bits == 32 ? 0x1p-24 : 4 * 0x1p-24)) {
    throw Error("GL depths", "the control item was not drawn",
                "run again, or with another --device");
  }
  std::vector<float> out(static_cast<std::size_t>(s.window.width) * s.window.height);
  glReadPixels(kBorder, kBorder, s.window.width, s.window.height, GL_DEPTH_COMPONENT, GL_FLOAT,
               out.data());
  check_gl("depths");
  return out;
}

std::vector<float> GlCanvas::samples(Verb verb, const std::vector<Draw>& wanted) {
  State& s = *state_;
  if (s.mode != DepthMode::fragment) throw std::logic_error("GlCanvas::samples: proxies only");
  GlProgram& program = verb == Verb::store ? s.entry_values : s.exit_values;
  if (program == 0) {
    program = verb == Verb::store ? s.program("entry values", {"FAR_VALUE"})
                                  : s.program("exit values", {"FAR_VALUE", "FAR_ASK"});
  }
  const GlTexture values = gl_make<GlTexture>(glGenTextures);
  glBindTexture(GL_TEXTURE_2D, values);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_R32F, s.target_width, s.target_height);
  const GlFramebuffer target = gl_make<GlFramebuffer>(glGenFramebuffers);
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, s.depth, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, values, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("GL samples", "the device refuses a float target",
                "choose a smaller resolution or another --device");
  }
  const float none[4] = {std::numeric_limits<float>::quiet_NaN(), 0, 0, 0};
  glClearBufferfv(GL_COLOR, 0, none);
  s.draw_all(program, verb, wanted, target);
  float control = 0;
  std::vector<float> out(static_cast<std::size_t>(s.window.width) * s.window.height);
  glReadPixels(0, 0, 1, 1, GL_RED, GL_FLOAT, &control);
  glReadPixels(kBorder, kBorder, s.window.width, s.window.height, GL_RED, GL_FLOAT, out.data());
  check_gl("samples");
  if (control != static_cast<float>(kControlTop - kControlGap)) {
    throw Error("GL samples", "the control item was not drawn",
                "run again, or with another --device");
  }
  return out;
}

std::vector<std::uint8_t> GlCanvas::State::read_flags(std::uint32_t slots) {
  const Fault injected = std::exchange(fault, Fault::none);
  const std::uint32_t words = (slots + 31) / 32;
  gl_fill(bits, nullptr, words * sizeof(std::uint32_t));
  const std::uint32_t zero[4] = {0, 0, 0, 0};
  gl_fill(finished, zero, sizeof zero);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kFlags, flags);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kBits, bits);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kFinished, finished);
  glUseProgram(pack_program);
  glUniform1ui(glGetUniformLocation(pack_program, "u_words"), words);
  glUniform1ui(glGetUniformLocation(pack_program, "u_flags"), slots);
  glUniform1ui(glGetUniformLocation(pack_program, "u_unfinished"),
               injected == Fault::unfinished_invocation ? 0 : kNone);
  constexpr std::uint32_t kGroup = 64;  // local_size_x of pack.comp
  const std::uint32_t most = static_cast<std::uint32_t>(context.info().max_compute_groups);
  for (std::uint32_t first = 0; first < words;) {
    const std::uint32_t groups = std::min(most, (words - first + kGroup - 1) / kGroup);
    glUniform1ui(glGetUniformLocation(pack_program, "u_first"), first);
    glDispatchCompute(injected == Fault::oversized_dispatch ? most + 1 : groups, 1, 1);
    first += groups * kGroup;
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  check_gl("pack");
  std::uint32_t done = 0;
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, finished);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof done, &done);
  if (done != words) {
    throw Error("GL pack",
                std::to_string(done) + " of " + std::to_string(words) + " invocations finished",
                "a compute invocation was lost: run again, or with another --device");
  }
  std::vector<std::uint32_t> packed(words);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, bits);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                     static_cast<GLsizeiptr>(words * sizeof(std::uint32_t)), packed.data());
  std::vector<std::uint8_t> seen(slots);
  for (std::uint32_t i = 0; i < slots; ++i) seen[i] = packed[i / 32] >> (i % 32) & 1;
  return seen;
}

std::vector<std::uint8_t> GlCanvas::State::read_queries(std::uint32_t slots) {
  std::vector<std::uint8_t> seen(slots);
  for (std::uint32_t i = 0; i < slots; ++i) {
    GLuint result = 0;
    glGetQueryObjectuiv(queries[i], GL_QUERY_RESULT, &result);
    seen[i] = result != 0;
  }
  // A query that was never issued has no object behind its name: the read above is then an error,
  // found by the caller.
  return seen;
}

}  // namespace farcull
