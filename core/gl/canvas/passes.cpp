// The passes of the GL canvas. A batch is a sequence of draws that belong to one step and read one
// element buffer. A pass uploads its draw list and draws the list batch by batch. Results are used
// only if report, number of primitives and control items (state.h) show that every command ran.
#include "core/gl/canvas/canvas.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/gl/canvas/state.h"

namespace farcull {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::size_t kMaxControls = 400'000;  // kControlTop - kMaxControls * kControlGap > 0.75

class Layout {
 public:
  Layout(const CanvasState& canvas, const Pass& pass, bool marks)
      : canvas_(canvas), pass_(pass), marked_(!marks), asked_(!marks) {
    out_.serial = gl_number();
    out_.list.assign(kTagBytes / sizeof(GpuDraw), GpuDraw{0, 0});
    out_.slots = pass.slots;
    // The quad for kEverywhere covers all pixel centres of the window, but none outside.
    const double x = 0.5 * canvas.window.width + 0.25, y = 0.5 * canvas.window.height + 0.25;
    add_quad(-x, -y, x, y, 0.0f);
    own_elements_ = quad_elements();
  }

  void add_step(const Step& step) {
    fresh_ = true;
    for (std::uint32_t i = step.first; i < step.first + step.count; ++i) {
      const Draw& d = pass_.draws[i];
      if (d.element == kEverywhere) {
        for (std::size_t q = 0; q < quad_elements(); ++q)
          push(step.verb, kExtras, static_cast<std::uint32_t>(q), d.slot);
      } else {
        push(step.verb, d.element / canvas_.per_chunk,
             static_cast<std::uint32_t>(d.element % canvas_.per_chunk), d.slot);
      }
    }
    add_controls(step.verb);
    ++index_;
  }

  CanvasPass finish() {
    if (out_.list.size() % 2 != 0)
      out_.list.push_back({0, 0});  // the device hashes 16 bytes at a time: two entries
    return std::move(out_);
  }

 private:
  std::size_t quad_elements() const { return canvas_.mode == DepthMode::fragment ? 1 : 2; }

  // Adds a rectangle at depth d to the canvas's own elements, as one proxy or two triangles.
  void add_quad(double x0, double y0, double x1, double y1, float d) {
    std::vector<float>& own = out_.own;
    const float l = static_cast<float>(x0), b = static_cast<float>(y0), r = static_cast<float>(x1),
                t = static_cast<float>(y1);
    if (canvas_.mode == DepthMode::fragment) {
      own.insert(own.end(), {l, b, r, b, r, t, l, t});
      own.insert(own.end(), 16, 0.0f);
      own.insert(own.end(), {0.0f, 1.0f, d, 0.0f});
    } else {
      own.insert(own.end(), {l, b, d, 1, r, b, d, 1, r, t, d, 1});
      own.insert(own.end(), {l, b, d, 1, r, t, d, 1, l, t, d, 1});
    }
  }

  void push(Verb verb, std::size_t chunk, std::uint32_t element, std::uint32_t slot) {
    if (fresh_ || out_.batches.back().chunk != chunk) {
      // Pads the list, because the device can bind a batch only at a multiple of `grain` entries.
      const std::size_t grain = canvas_.alignment / sizeof(GpuDraw);
      out_.list.resize((out_.list.size() + grain - 1) / grain * grain, GpuDraw{0, 0});
      const auto word = CanvasReport::kHead + static_cast<std::uint32_t>(out_.batches.size());
      out_.batches.push_back({index_, verb, chunk, out_.list.size(), 0});
      out_.list.push_back({out_.serial, word});
      fresh_ = false;
    }
    out_.list.push_back({element, slot});
    ++out_.batches.back().count;
  }

  // Adds a control item that covers one pixel. pixel: its index in the lowest row of the target.
  void push_control(Verb verb, double depth, int pixel, std::uint32_t slot) {
    const double x = pixel - 0.5 * canvas_.target_width, y = -0.5 * canvas_.target_height;
    add_quad(x, y, x + 1, y + 1, static_cast<float>(depth));
    for (std::size_t q = 0; q < quad_elements(); ++q)
      push(verb, kExtras, static_cast<std::uint32_t>(own_elements_++), slot);
  }

  void add_controls(Verb verb) {
    const bool store = verb == Verb::store;
    stores_ += store;
    if (stores_ > kMaxControls) {
      throw Error("GL pass",
                  "more than " + std::to_string(kMaxControls) +
                      " owners (objects; for s-cullide triangles) are stored in one pass",
                  "join objects that cannot collide with each other, or use boxes");
    }
    if (store && !std::exchange(marked_, true))
      push_control(Verb::store, kMark, canvas_.odd ? 1 : 2, 0);
    if (!store && !std::exchange(asked_, true))
      push_control(Verb::ask, kAsked, canvas_.odd ? 2 : 1, out_.slots++);
    const double behind = store || pass_.touching ? 0 : 0.5;
    push_control(verb, kControlTop - (static_cast<double>(stores_) - behind) * kControlGap, 0,
                 store ? 0 : out_.slots++);
  }

  const CanvasState& canvas_;
  const Pass& pass_;
  bool marked_, asked_;
  CanvasPass out_;
  std::size_t own_elements_ = 0;
  std::size_t stores_ = 0;
  std::size_t index_ = 0;  // index of the step
  bool fresh_ = true;      // true: the next draw starts a batch
};

// Returns the draw list of `pass`. If `marks` is true, the first step must store and the last step
// must test. If they do not, steps with only control items (state.h) are added. The first store
// then draws the mark of this pass, and the first test looks for the mark of the previous pass. If
// `marks` is false, no step is added, and no mark is drawn or tested.
CanvasPass lay_out(const CanvasState& canvas, const Pass& pass, bool marks) {
  Layout out(canvas, pass, marks);
  if (marks && pass.steps.front().verb != Verb::store) out.add_step({Verb::store, 0, 0});
  for (const Step& step : pass.steps) out.add_step(step);
  if (marks && pass.steps.back().verb != Verb::ask) out.add_step({Verb::ask, 0, 0});
  return out.finish();
}

}  // namespace

void CanvasState::begin(const Window& to, const Drawables& drawables) {
  window = to;
  resize_target();
  const auto bytes = mode == DepthMode::fragment ? std::as_bytes(std::span(drawables.proxies))
                                                 : std::as_bytes(std::span(drawables.triangles));
  static_assert(sizeof(Proxy) == 7 * 16 && sizeof(drawables.triangles[0]) == 3 * 16);
  const std::size_t chunk_bytes = per_chunk * 16 * vec4s();
  const bool known = choose_elements(bytes);
  std::vector<GlStore>& chunks = current.chunks;
  chunks.resize((drawables.elements() + per_chunk - 1) / per_chunk);
  stamp(0);
  report->start(0, report->dispatches(bytes.size()) + chunks.size(), 0);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const auto chunk =
        bytes.subspan(c * chunk_bytes, std::min(chunk_bytes, bytes.size() - c * chunk_bytes));
    if (chunks[c].reserve(chunk.size(), chunk_bytes) || !known) {
      chunks[c].write(0, chunk.data(), chunk.size());
      work.uploaded_bytes += chunk.size();
    }
    // Compares the data on the device with `chunk` even if nothing was uploaded.
    report->expect(chunks[c], chunk);
  }
  if (!known) current.bytes.assign(bytes.begin(), bytes.end());
  set_uniforms(store_program);
  set_uniforms(ask_program);
  stamp(1);
  read_report("upload");
  begun = true;
}

// Selects the stored set of elements with these bytes. Returns false if no stored set has these
// bytes: the caller must then write the elements. Several sets are stored, because an unchanged
// scene needs one set per view.
bool CanvasState::choose_elements(std::span<const std::byte> bytes) {
  constexpr std::size_t kEarlier = 2;                       // maximum of earlier.size()
  constexpr std::size_t kLargest = std::size_t{128} << 20;  // a larger new set clears `earlier`
  const auto is_same = [&](const CanvasElements& set) {
    return set.bytes.size() == bytes.size() && std::ranges::equal(set.bytes, bytes);
  };
  if (is_same(current)) return true;
  const auto found = std::find_if(earlier.begin(), earlier.end(), is_same);
  if (found != earlier.end()) {
    std::swap(current, *found);
    return true;
  }
  if (bytes.size() > kLargest) {
    earlier.clear();
  } else if (earlier.size() < kEarlier) {
    earlier.push_back(std::exchange(current, {}));
  } else {
    std::swap(current, earlier.front());
    std::rotate(earlier.begin(), earlier.begin() + 1, earlier.end());
  }
  return false;
}

// Draws all batches. Returns how many primitives the device should have drawn.
std::uint64_t CanvasState::draw_pass(const Pass& pass, const CanvasPass& laid) {
  const bool with_flags = options.query == QueryMode::flags;
  std::uint64_t primitives_of_pass = 0;
  std::uint32_t open = kNone;           // the slot whose occlusion query is active
  const CanvasBatch* before = nullptr;  // the previous batch
  for (std::size_t r = 0; r < laid.batches.size(); ++r) {
    const CanvasBatch& batch = laid.batches[r];
    primitives_of_pass += batch.count * primitives();
    report->expect_batch(
        r, echo(laid, batch, batch.verb == Verb::ask ? ask_program : store_program, pass.touching));
    if (before == nullptr || before->verb != batch.verb) set_verb(batch.verb, pass.touching);
    bind(batch, before);
    before = &batch;
    if (batch.verb == Verb::store || with_flags) {
      draw(0, batch.count);
      continue;
    }
    draw_queries(laid, batch, open);
    const bool last_of_step =
        r + 1 == laid.batches.size() || laid.batches[r + 1].step != batch.step;
    if (last_of_step && std::exchange(open, kNone) != kNone) glEndQuery(GL_ANY_SAMPLES_PASSED);
  }
  return primitives_of_pass;
}

// Draws a batch with one occlusion query for each slot. The draws of a slot may be in several
// batches of a step, so the slot's query stays active until the next slot or the end of the step.
void CanvasState::draw_queries(const CanvasPass& laid, const CanvasBatch& batch,
                               std::uint32_t& open) {
  const GpuDraw* const list = &laid.list[batch.offset + 1];
  for (std::size_t from = 0; from < batch.count;) {
    const std::uint32_t slot = list[from].slot;
    std::size_t to = from + 1;
    while (to < batch.count && list[to].slot == slot) ++to;
    if (slot != open) {
      if (open != kNone) glEndQuery(GL_ANY_SAMPLES_PASSED);
      glBeginQuery(GL_ANY_SAMPLES_PASSED, queries[slot]);
      ++work.queries;
      open = slot;
    }
    draw(from, to - from);
    from = to;
  }
}

std::vector<std::uint8_t> CanvasState::run(const Pass& pass) {
  const CanvasPass laid = lay_out(*this, pass, true);
  ++work.passes;
  const bool with_flags = options.query == QueryMode::flags;
  stamp(0);
  upload(laid, with_flags);
  if (!with_flags) {
    // Generates new query names in every pass. If glBeginQuery is lost, no query object exists for
    // the new name. So read_queries() cannot read a result of an earlier pass.
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
  const std::uint64_t expected = draw_pass(pass, laid);
  glEndQuery(GL_PRIMITIVES_GENERATED);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  if (with_flags) report->pack(flags, laid.serial, laid.slots);
  stamp(1);

  std::vector<std::uint8_t> seen = read_report("pass");
  GLuint64 drawn = kNone;
  glGetQueryObjectui64v(generated, GL_QUERY_RESULT, &drawn);
  ++work.queries;
  ++work.readbacks;
  work.downloaded_bytes += sizeof drawn;
  if (drawn != expected) {
    throw_lost("pass", std::to_string(drawn) + " of " + std::to_string(expected) +
                           " primitives were drawn");
  }
  if (!with_flags) seen = read_queries(laid.slots);
  check_gl("answers");
  if (seen[pass.slots]) throw_lost("pass", "the depth buffer was not cleared");
  for (std::uint32_t control = pass.slots + 1; control < laid.slots; ++control) {
    if (!seen[control]) {
      throw_lost("pass",
                 "control item " + std::to_string(control - pass.slots - 1) + " was not seen");
    }
  }
  odd = !odd;
  seen.resize(pass.slots);
  return seen;
}

// Waits for the device and reads the report. Adds the time between time stamps 0 and 1 to `work`.
std::vector<std::uint8_t> CanvasState::read_report(const std::string& stage) {
  const std::uint64_t bytes = report->bytes_in_all();
  std::vector<std::uint8_t> seen = report->read(stage);
  ++work.waits;
  ++work.readbacks;
  work.dispatches = report->dispatches_in_all();
  work.downloaded_bytes += report->bytes_in_all() - bytes;
  ++work.spans;
  const double ms = stamped_ms();
  if (ms >= 0) {
    ++work.timed;
    work.device_ms += ms;
  }
  return seen;
}

// Reads the results of the occlusion queries. report->read() has already waited for the device.
std::vector<std::uint8_t> CanvasState::read_queries(std::uint32_t slots) {
  work.readbacks += slots;
  work.downloaded_bytes += slots * sizeof(GLuint);
  std::vector<std::uint8_t> seen(slots);
  for (std::uint32_t i = 0; i < slots; ++i) {
    GLuint result = kNone;
    glGetQueryObjectuiv(queries[i], GL_QUERY_RESULT, &result);
    // If glBeginQuery was lost, there is no query object, and GL leaves `result` unchanged.
    if (result == kNone) throw_lost("pass", "query " + std::to_string(i) + " gave no answer");
    seen[i] = result != 0;
  }
  return seen;
}

// Draws all of `wanted` with one program. target: a framebuffer with the canvas's depth texture.
void CanvasState::draw_all(CanvasProgram& program, Verb verb, const std::vector<Draw>& wanted,
                           GLuint target) {
  const bool store = verb == Verb::store;
  Pass pass;
  pass.draws = wanted;
  pass.steps = {{Verb::store, 0, static_cast<std::uint32_t>(wanted.size())}};
  const CanvasPass laid = lay_out(*this, pass, false);
  upload(laid, false);
  set_uniforms(program);
  const float empty = store ? 1 : 0;
  start(empty);
  bind_target(target);
  set_depth_func(store ? GL_LESS : GL_GREATER);
  glUseProgram(program.name);
  for (std::size_t r = 0; r < laid.batches.size(); ++r) {
    report->expect_batch(r, echo(laid, laid.batches[r], program, true));
    bind(laid.batches[r], nullptr);
    draw(0, laid.batches[r].count);
  }
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  report->read("samples");
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  float corner[3] = {-1, -1, -1};
  glReadPixels(0, 0, 3, 1, GL_DEPTH_COMPONENT, GL_FLOAT, corner);
  check_gl("samples");
  // For a 24-bit buffer, depth_rounding() is less than 4, which is half of kControlGap / 2^-24.
  const double moved = std::abs(corner[0] - (kControlTop - kControlGap));
  if (!(moved <= (options.depth_format == DepthFormat::float32 ? 0x1p-24 : 4 * 0x1p-24)))
    throw_lost("samples", "the control item was not drawn");
  if (corner[1] != empty || corner[2] != empty)
    throw_lost("samples", "the depth buffer was not cleared, or not read");
}

std::vector<float> CanvasState::depths(Verb verb, const std::vector<Draw>& wanted) {
  const bool exits = verb == Verb::ask && mode == DepthMode::fragment;
  if (exits && exit_program.name == 0) exit_program = program("exit", {ask_define()});
  draw_all(exits ? exit_program : store_program, verb, wanted, depth_target);
  std::vector<float> out(static_cast<std::size_t>(window.width) * window.height, -1);
  glReadPixels(kBorder, kBorder, window.width, window.height, GL_DEPTH_COMPONENT, GL_FLOAT,
               out.data());
  check_gl("depths");
  if (out[0] == -1) throw_lost("depths", "they were not read");
  clear_depth(kLeft);
  return out;
}

std::vector<float> CanvasState::samples(Verb verb, const std::vector<Draw>& wanted) {
  CanvasProgram& values_program = verb == Verb::store ? entry_values : exit_values;
  if (values_program.name == 0) {
    values_program = verb == Verb::store ? program("entry values", {"FAR_VALUE"})
                                         : program("exit values", {"FAR_VALUE", ask_define()});
  }
  const GlTexture values = texture(GL_R32F);
  const GlFramebuffer target = gl_make<GlFramebuffer>(glGenFramebuffers);
  bind_target(target);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, values, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("GL samples", "the device refuses a float target",
                "choose a smaller resolution or another {device}");
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
    throw_lost("samples", "the control item was not drawn");
  if (!std::isnan(corner[1])) throw_lost("samples", "the target was not cleared");
  if (out[0] == kUnread) throw_lost("samples", "they were not read");
  bind_target(depth_target);
  clear_depth(kLeft);
  return out;
}

// Makes the context current, creates a missing state, and runs `work`. Calls forget() on failure.
template <class Work>
auto GlCanvas::guarded(const Work& work) {
  const GlCurrent current(context_);
  try {
    if (!state_) state_ = std::make_unique<CanvasState>(context_, mode_, solid_, options_);
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
    throw Error("{query}",
                "flags cannot be used with a 24-bit depth buffer: a comparison in the shader loses "
                "equal depths",
                "use {query} occlusion or {depth_format} 32f");
  }
  if (options.conservative && mode == DepthMode::fragment)
    throw std::logic_error("GlCanvas: proxies are not drawn conservatively");
  const GlCurrent current(context);
  const GlInfo& info = context.info();
  limits_.subpixel_bits = info.subpixel_bits;
  limits_.depth_bits = options.depth_format == DepthFormat::float32 ? 32 : 24;
  GLint framebuffer[2] = {0, 0};
  glGetIntegerv(GL_MAX_FRAMEBUFFER_WIDTH, &framebuffer[0]);
  glGetIntegerv(GL_MAX_FRAMEBUFFER_HEIGHT, &framebuffer[1]);
  // A window is at most five pixels wider than its resolution (fit_window). The sides of a viewport
  // are powers of two.
  const int viewport = static_cast<int>(std::bit_floor(static_cast<unsigned>(info.max_viewport)));
  limits_.max_resolution =
      std::min({viewport, info.max_texture_size, framebuffer[0], framebuffer[1]}) - 2 * kBorder - 6;
  guarded([] { return 0; });
}

GlCanvas::~GlCanvas() { forget(); }

// Deletes all GL objects. If the context cannot be made current, GL frees them with the context.
void GlCanvas::forget() {
  if (state_) earlier_ += std::exchange(state_->work, {});
  try {
    const GlCurrent current(context_);
    for (const GLenum target : {GL_PRIMITIVES_GENERATED, GL_ANY_SAMPLES_PASSED}) {
      GLint open = 0;
      glGetQueryiv(target, GL_CURRENT_QUERY, &open);
      if (open != 0) glEndQuery(target);
    }
    state_.reset();
    // Discards pending GL errors, at most 16: a lost context may report errors endlessly.
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
    }
  } catch (const Error&) {
    static_cast<void>(state_.release());
  }
}

CanvasWork GlCanvas::work() const {
  CanvasWork all = earlier_;
  if (state_) all += state_->work;
  return all;
}

void GlCanvas::require_begun(const char* function) const {
  if (state_ && state_->begun) return;
  throw std::logic_error(std::string("GlCanvas::") + function +
                         ": begin() must come first, and again after any exception");
}

void GlCanvas::begin(const Window& window, const Drawables& drawables) {
  if (state_) state_->begun = false;
  if (drawables.mode != mode_)
    throw std::logic_error("GlCanvas::begin: drawables of another depth mode");
  guarded([&] { state_->begin(window, drawables); });
}

std::vector<std::uint8_t> GlCanvas::run(const Pass& pass) {
  require_begun("run");
  if (pass.steps.empty()) return std::vector<std::uint8_t>(pass.slots);
  return guarded([&] { return state_->run(pass); });
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

std::unique_ptr<Canvas> gl_canvas(const GlContext& context, DepthMode mode,
                                  const SolidProgram& solid, const GlCanvasOptions& options) {
  return std::make_unique<GlCanvas>(context, mode, solid, options);
}

}  // namespace farcull
