#include "core/gl_canvas.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "core/gl_canvas_parts.h"

namespace farcull {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

[[noreturn]] void lost(const char* where, const std::string& reason) {
  throw Error(std::string("GL ") + where, reason,
              "a command was lost: run again, or with another --device");
}

}  // namespace

void GlCanvas::State::begin(const Window& to, const Drawables& drawables) {
  window = to;
  resize_target();
  elements = drawables.elements();
  const auto bytes = mode == DepthMode::fragment ? std::as_bytes(std::span(drawables.proxies))
                                                 : std::as_bytes(std::span(drawables.triangles));
  static_assert(sizeof(Proxy) == 7 * 16 && sizeof(drawables.triangles[0]) == 3 * 16);
  const std::size_t chunk_bytes = per_chunk * 16 * vec4s();
  chunks.resize((elements + per_chunk - 1) / per_chunk);
  report->start(0, report->dispatches(bytes.size()) + chunks.size(), 0);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const auto chunk =
        bytes.subspan(c * chunk_bytes, std::min(chunk_bytes, bytes.size() - c * chunk_bytes));
    chunks[c].reserve(chunk.size(), chunk_bytes);
    chunks[c].write(0, chunk.data(), chunk.size());
    report->expect(chunks[c], chunk);
  }
  set_uniforms(store_program);
  set_uniforms(ask_program);
  report->read("upload");
  begun = true;
}

std::vector<std::uint8_t> GlCanvas::State::run(const Pass& pass, Fault fault) {
  const CanvasPass laid = lay_out(pass, true);
  const bool with_flags = options.query == QueryMode::flags;
  upload(laid, with_flags);
  if (!with_flags) {
    // New names for every pass: a query that is never issued then has no object, and no stale
    // answer to give.
    queries.clear();
    while (queries.size() < laid.slots) queries.push_back(gl_make<GlQuery>(glGenQueries));
  }

  start(1);
  if (with_flags) {
    glProgramUniform1ui(ask_program.name, glGetUniformLocation(ask_program.name, "u_serial"),
                        laid.serial);
    glProgramUniform1i(ask_program.name, glGetUniformLocation(ask_program.name, "u_touching"),
                       pass.touching);
  }
  const GlQuery generated = gl_make<GlQuery>(glGenQueries);
  glBeginQuery(GL_PRIMITIVES_GENERATED, generated);
  GLuint64 expected = 0;
  bool lose_query = fault == Fault::lost_query;
  std::uint32_t open = kNone;  // slot whose occlusion query is active
  const auto end_query = [&open] {
    if (std::exchange(open, kNone) != kNone) glEndQuery(GL_ANY_SAMPLES_PASSED);
  };
  const CanvasRun* before = nullptr;  // the run whose state is set
  for (std::size_t r = 0; r < laid.runs.size(); ++r) {
    const CanvasRun& run = laid.runs[r];
    expected += static_cast<GLuint64>(run.count) * primitives();
    report->expect_run(
        r, echo(laid, run, run.verb == Verb::ask ? ask_program : store_program, pass.touching));
    if (fault == Fault::lost_draw && r == 0) continue;
    if (before == nullptr || before->verb != run.verb) set_verb(run.verb, pass.touching);
    bind(run, before);
    before = &run;
    if (run.verb == Verb::store || with_flags) {
      draw(0, run.count);
      continue;
    }
    const GpuDraw* const list = &laid.list[run.offset + 1];
    for (std::size_t from = 0; from < run.count;) {
      const std::uint32_t slot = list[from].slot;
      std::size_t to = from + 1;
      while (to < run.count && list[to].slot == slot) ++to;
      // A slot's draws may be spread over runs of its step: its query stays open until another slot
      // begins.
      if (slot != open) {
        end_query();
        if (!std::exchange(lose_query, false)) {
          glBeginQuery(GL_ANY_SAMPLES_PASSED, queries[slot]);
          open = slot;
        }
        if (fault == Fault::blind_query) end_query();
      }
      draw(from, to - from);
      from = to;
    }
    if (r + 1 == laid.runs.size() || laid.runs[r + 1].step != run.step) end_query();
  }
  glEndQuery(GL_PRIMITIVES_GENERATED);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  if (with_flags) report->pack(flags, laid.serial, laid.slots, fault);

  std::vector<std::uint8_t> seen = report->read("pass");
  GLuint64 drawn = kNone;
  glGetQueryObjectui64v(generated, GL_QUERY_RESULT, &drawn);
  if (drawn != expected) {
    lost("pass",
         std::to_string(drawn) + " of " + std::to_string(expected) + " primitives were drawn");
  }
  if (!with_flags) seen = read_queries(laid.slots);
  check_gl("answers");
  if (seen[pass.slots]) lost("pass", "the depth buffer was not cleared");
  for (std::uint32_t control = pass.slots + 1; control < laid.slots; ++control) {
    if (!seen[control]) {
      lost("pass", "control item " + std::to_string(control - pass.slots - 1) + " was not seen");
    }
  }
  odd = !odd;
  seen.resize(pass.slots);
  return seen;
}

// After report->read(), so nothing is waited for.
std::vector<std::uint8_t> GlCanvas::State::read_queries(std::uint32_t slots) const {
  std::vector<std::uint8_t> seen(slots);
  for (std::uint32_t i = 0; i < slots; ++i) {
    GLuint result = kNone;
    glGetQueryObjectuiv(queries[i], GL_QUERY_RESULT, &result);
    // One that was never issued has no object behind its name, and gives nothing.
    if (result == kNone) lost("pass", "query " + std::to_string(i) + " gave no answer");
    seen[i] = result != 0;
  }
  return seen;
}

// Draws everything with one program into a target that shares the canvas's depth texture.
void GlCanvas::State::draw_all(CanvasProgram& program, Verb verb, const std::vector<Draw>& wanted,
                               GLuint target) {
  const bool store = verb == Verb::store;
  Pass pass;
  pass.draws = wanted;
  pass.steps = {{Verb::store, 0, static_cast<std::uint32_t>(wanted.size())}};
  const CanvasPass laid = lay_out(pass, false);
  upload(laid, false);
  set_uniforms(program);
  const float empty = store ? 1 : 0;
  start(empty);
  bind_target(target);
  set_depth_func(store ? GL_LESS : GL_GREATER);
  glUseProgram(program.name);
  for (std::size_t r = 0; r < laid.runs.size(); ++r) {
    report->expect_run(r, echo(laid, laid.runs[r], program, true));
    bind(laid.runs[r], nullptr);
    draw(0, laid.runs[r].count);
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  report->read("samples");
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  float corner[3] = {-1, -1, -1};
  glReadPixels(0, 0, 3, 1, GL_DEPTH_COMPONENT, GL_FLOAT, corner);
  check_gl("samples");
  // 24 bits move it by at most depth_rounding() steps, far less than half a gap.
  const double moved = std::abs(corner[0] - (kControlTop - kControlGap));
  if (!(moved <= (options.depth_format == DepthFormat::float32 ? 0x1p-24 : 4 * 0x1p-24)))
    lost("samples", "the control item was not drawn");
  if (corner[1] != empty || corner[2] != empty)
    lost("samples", "the depth buffer was not cleared, or not read");
}

std::vector<float> GlCanvas::State::depths(Verb verb, const std::vector<Draw>& wanted) {
  const bool exits = verb == Verb::ask && mode == DepthMode::fragment;
  if (exits && exit_program.name == 0) exit_program = program("exit", {"FAR_ASK"});
  draw_all(exits ? exit_program : store_program, verb, wanted, depth_target);
  std::vector<float> out(static_cast<std::size_t>(window.width) * window.height, -1);
  glReadPixels(kBorder, kBorder, window.width, window.height, GL_DEPTH_COMPONENT, GL_FLOAT,
               out.data());
  check_gl("depths");
  if (out[0] == -1) lost("depths", "they were not read");
  clear_depth(kLeft);
  return out;
}

std::vector<float> GlCanvas::State::samples(Verb verb, const std::vector<Draw>& wanted) {
  CanvasProgram& values_program = verb == Verb::store ? entry_values : exit_values;
  if (values_program.name == 0) {
    values_program = verb == Verb::store ? program("entry values", {"FAR_VALUE"})
                                         : program("exit values", {"FAR_VALUE", "FAR_ASK"});
  }
  const GlTexture values = texture(GL_R32F);
  const GlFramebuffer target = gl_make<GlFramebuffer>(glGenFramebuffers);
  bind_target(target);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, values, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("GL samples", "the device refuses a float target",
                "choose a smaller resolution or another --device");
  }
  const float none[4] = {std::numeric_limits<float>::quiet_NaN(), 0, 0, 0};
  glClearBufferfv(GL_COLOR, 0, none);
  draw_all(values_program, verb, wanted, target);
  constexpr float kUnread = std::numeric_limits<float>::infinity();
  float corner[2] = {kUnread, kUnread};
  std::vector<float> out(static_cast<std::size_t>(window.width) * window.height, kUnread);
  glReadPixels(0, 0, 2, 1, GL_RED, GL_FLOAT, corner);
  glReadPixels(kBorder, kBorder, window.width, window.height, GL_RED, GL_FLOAT, out.data());
  check_gl("samples");
  if (corner[0] != static_cast<float>(kControlTop - kControlGap))
    lost("samples", "the control item was not drawn");
  if (!std::isnan(corner[1])) lost("samples", "the target was not cleared");
  if (out[0] == kUnread) lost("samples", "they were not read");
  bind_target(depth_target);
  clear_depth(kLeft);
  return out;
}

// Runs `work` with the context current and the state there; after a failure nothing that lies on
// the device is believed.
template <class Work>
auto GlCanvas::guarded(const Work& work) {
  const GlCurrent current(context_);
  try {
    if (!state_) state_ = std::make_unique<State>(context_, mode_, solid_, options_);
    return work();
  } catch (...) {
    forget();
    throw;
  }
}

GlCanvas::GlCanvas(const GlContext& context, DepthMode mode, const SolidProgram& solid,
                   const GlCanvasOptions& options)
    : context_(context), mode_(mode), solid_(solid.glsl), options_(options) {
  if (options.query == QueryMode::flags && options.depth_format == DepthFormat::fixed24) {
    throw Error("--query",
                "flags cannot be used with a 24-bit depth buffer: a comparison in the shader loses "
                "equal depths",
                "use --query occlusion or --depth-format 32f");
  }
  const GlCurrent current(context);
  const GlInfo& info = context.info();
  limits_.subpixel_bits = info.subpixel_bits;
  limits_.depth_bits = options.depth_format == DepthFormat::float32 ? 32 : 24;
  GLint framebuffer[2] = {0, 0};
  glGetIntegerv(GL_MAX_FRAMEBUFFER_WIDTH, &framebuffer[0]);
  glGetIntegerv(GL_MAX_FRAMEBUFFER_HEIGHT, &framebuffer[1]);
  // A window is up to five pixels wider than its resolution (fit_window), and its viewport side a
  // power of two.
  const int viewport = static_cast<int>(std::bit_floor(static_cast<unsigned>(info.max_viewport)));
  limits_.max_resolution =
      std::min({viewport, info.max_texture_size, framebuffer[0], framebuffer[1]}) - 2 * kBorder - 6;
  guarded([] { return 0; });
}

GlCanvas::~GlCanvas() { forget(); }

const RasterLimits& GlCanvas::limits() const { return limits_; }

void GlCanvas::inject(Fault fault) { fault_ = fault; }

// Everything on the device is deleted, or where the context cannot be had, left to go with it.
void GlCanvas::forget() {
  try {
    const GlCurrent current(context_);
    for (const GLenum target : {GL_PRIMITIVES_GENERATED, GL_ANY_SAMPLES_PASSED}) {
      GLint open = 0;
      glGetQueryiv(target, GL_CURRENT_QUERY, &open);
      if (open != 0) glEndQuery(target);
    }
    state_.reset();
    // What the flags say concerns nobody any more. A lost context may report errors without end.
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
    }
  } catch (const Error&) {
    static_cast<void>(state_.release());
  }
}

void GlCanvas::require_begun(const char* function) const {
  if (state_ && state_->begun) return;
  throw std::logic_error(std::string("GlCanvas::") + function +
                         ": begin() must come first, and again after any exception");
}

void GlCanvas::begin(const Window& window, const Drawables& drawables) {
  if (drawables.mode != mode_)
    throw std::logic_error("GlCanvas::begin: drawables of another depth mode");
  if (state_) state_->begun = false;
  guarded([&] { state_->begin(window, drawables); });
}

std::vector<std::uint8_t> GlCanvas::run(const Pass& pass) {
  require_begun("run");
  if (pass.steps.empty()) return std::vector<std::uint8_t>(pass.slots);
  const Fault fault = std::exchange(fault_, Fault::none);
  return guarded([&] { return state_->run(pass, fault); });
}

std::vector<float> GlCanvas::depths(Verb verb, const std::vector<Draw>& draws) {
  require_begun("depths");
  return guarded([&] { return state_->depths(verb, draws); });
}

std::vector<float> GlCanvas::samples(Verb verb, const std::vector<Draw>& draws) {
  if (mode_ != DepthMode::fragment) throw std::logic_error("GlCanvas::samples: proxies only");
  require_begun("samples");
  return guarded([&] { return state_->samples(verb, draws); });
}

}  // namespace farcull
