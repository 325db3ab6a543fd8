// The passes of the GL canvas. A pass sends its list, draws it batch by batch, and believes the
// answers only after the report, the count of primitives and the control items say that it ran.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/gl/canvas_state.h"

namespace farcull {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

}  // namespace

void CanvasState::begin(const Window& to, const Drawables& drawables) {
  window = to;
  resize_target();
  elements = drawables.elements();
  const auto bytes = mode == DepthMode::fragment ? std::as_bytes(std::span(drawables.proxies))
                                                 : std::as_bytes(std::span(drawables.triangles));
  static_assert(sizeof(Proxy) == 7 * 16 && sizeof(drawables.triangles[0]) == 3 * 16);
  const std::size_t chunk_bytes = per_chunk * 16 * vec4s();
  const bool known = choose_elements(bytes);
  std::vector<GlStore>& chunks = current.chunks;
  chunks.resize((elements + per_chunk - 1) / per_chunk);
  clock.stamp(0);
  report->start(0, report->dispatches(bytes.size()) + chunks.size(), 0);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const auto chunk =
        bytes.subspan(c * chunk_bytes, std::min(chunk_bytes, bytes.size() - c * chunk_bytes));
    if (chunks[c].reserve(chunk.size(), chunk_bytes) || !known) {
      chunks[c].write(0, chunk.data(), chunk.size());
      work.uploaded_bytes += chunk.size();
    }
    // What lies on the device is compared each time, also where nothing is sent.
    report->expect(chunks[c], chunk);
  }
  if (!known) current.bytes.assign(bytes.begin(), bytes.end());
  set_uniforms(store_program);
  set_uniforms(ask_program);
  clock.stamp(1);
  read_report("upload");
  begun = true;
}

// Makes the elements that were sent as `bytes` the current ones, or others that are written next;
// true: they are the same. A scene that stays as it is has one set of elements for each view.
bool CanvasState::choose_elements(std::span<const std::byte> bytes) {
  constexpr std::size_t kEarlier = 2;                       // so three in all
  constexpr std::size_t kLargest = std::size_t{128} << 20;  // bytes of a set that is kept
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

// Draws the batches of a pass and returns how many primitives they are.
std::uint64_t CanvasState::draw_pass(const Pass& pass, const CanvasPass& laid) {
  const bool with_flags = options.query == QueryMode::flags;
  std::uint64_t primitives_of_pass = 0;
  std::uint32_t open = kNone;         // slot whose occlusion query is active
  const CanvasRun* before = nullptr;  // the batch whose state is set
  for (std::size_t r = 0; r < laid.runs.size(); ++r) {
    const CanvasRun& run = laid.runs[r];
    primitives_of_pass += run.count * primitives();
    report->expect_run(
        r, echo(laid, run, run.verb == Verb::ask ? ask_program : store_program, pass.touching));
    if (before == nullptr || before->verb != run.verb) set_verb(run.verb, pass.touching);
    bind(run, before);
    before = &run;
    if (run.verb == Verb::store || with_flags) {
      draw(0, run.count);
      continue;
    }
    draw_queries(laid, run, open);
    const bool last_of_step = r + 1 == laid.runs.size() || laid.runs[r + 1].step != run.step;
    if (last_of_step && std::exchange(open, kNone) != kNone) glEndQuery(GL_ANY_SAMPLES_PASSED);
  }
  return primitives_of_pass;
}

// Draws a batch with an occlusion query for each slot. A slot's draws may be spread over batches of
// its step: its query stays open until another slot comes or the step ends.
void CanvasState::draw_queries(const CanvasPass& laid, const CanvasRun& run, std::uint32_t& open) {
  const GpuDraw* const list = &laid.list[run.offset + 1];
  for (std::size_t from = 0; from < run.count;) {
    const std::uint32_t slot = list[from].slot;
    std::size_t to = from + 1;
    while (to < run.count && list[to].slot == slot) ++to;
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
  const CanvasPass laid = lay_out(shape(), pass, true, odd);
  ++work.passes;
  const bool with_flags = options.query == QueryMode::flags;
  clock.stamp(0);
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
  const std::uint64_t expected = draw_pass(pass, laid);
  glEndQuery(GL_PRIMITIVES_GENERATED);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  if (with_flags) report->pack(flags, laid.serial, laid.slots);
  clock.stamp(1);

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

// Waits, reads the report, and takes the time since the stamp 0.
std::vector<std::uint8_t> CanvasState::read_report(const std::string& stage) {
  const std::uint64_t bytes = report->bytes_in_all();
  std::vector<std::uint8_t> seen = report->read(stage);
  ++work.waits;
  ++work.readbacks;
  work.dispatches = report->dispatches_in_all();
  work.downloaded_bytes += report->bytes_in_all() - bytes;
  ++work.spans;
  const double ms = clock.between(0, 1);
  if (ms >= 0) {
    ++work.timed;
    work.device_ms += ms;
  }
  return seen;
}

// After report->read(), so nothing is waited for.
std::vector<std::uint8_t> CanvasState::read_queries(std::uint32_t slots) {
  work.readbacks += slots;
  work.downloaded_bytes += slots * sizeof(GLuint);
  std::vector<std::uint8_t> seen(slots);
  for (std::uint32_t i = 0; i < slots; ++i) {
    GLuint result = kNone;
    glGetQueryObjectuiv(queries[i], GL_QUERY_RESULT, &result);
    // One that was never issued has no object behind its name, and gives nothing.
    if (result == kNone) throw_lost("pass", "query " + std::to_string(i) + " gave no answer");
    seen[i] = result != 0;
  }
  return seen;
}

// Draws everything with one program into a target that shares the canvas's depth texture.
void CanvasState::draw_all(CanvasProgram& program, Verb verb, const std::vector<Draw>& wanted,
                           GLuint target) {
  const bool store = verb == Verb::store;
  Pass pass;
  pass.draws = wanted;
  pass.steps = {{Verb::store, 0, static_cast<std::uint32_t>(wanted.size())}};
  const CanvasPass laid = lay_out(shape(), pass, false, odd);
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

}  // namespace farcull
