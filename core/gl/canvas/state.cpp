// Sets the GL state for a pass, and reads back each value that GL can return. The echo, a checksum
// computed on the device, covers the other values. Compute programs sum the uploaded data and pack
// flags into bits. CanvasReport compares each echo with its expected value.
#include "core/gl/canvas/state.h"

#include <algorithm>
#include <cstring>

#include "core/base/error.h"
#include "embedded/canvas_frag.h"
#include "embedded/canvas_vert.h"
#include "embedded/canvas_work_comp.h"

namespace farcull {
namespace {

GLint asked(GLenum name) {
  GLint value = -1;
  glGetIntegerv(name, &value);
  return value;
}

void require(bool set, const char* what) {
  if (!set) throw_lost("state", std::string(what) + " is not as it was set");
}

void set_enabled(GLenum capability, bool on, const char* what) {
  (on ? glEnable : glDisable)(capability);
  require(glIsEnabled(capability) == (on ? GL_TRUE : GL_FALSE), what);
}

void bind_texture(GLuint name) {
  glBindTexture(GL_TEXTURE_2D, name);
  require(asked(GL_TEXTURE_BINDING_2D) == static_cast<GLint>(name), "the texture");
}

// Returns the sum of the words of `data` (a multiple of 4 bytes), each hashed with its position.
std::uint32_t sum_of(std::span<const std::byte> data) {
  std::uint32_t sum = 0;
  const auto count = static_cast<std::uint32_t>(data.size() / sizeof(std::uint32_t));
  for (std::uint32_t w = 0; w < count; ++w) {
    std::uint32_t word = 0;
    std::memcpy(&word, data.data() + w * sizeof word, sizeof word);
    sum += gl_mixed(word, w);
  }
  return sum;
}

void wait_for_device(const std::string& stage) {
  constexpr int kLongest = 600;  // seconds
  const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  GLenum answer = GL_TIMEOUT_EXPIRED;
  for (int second = 0; second < kLongest && answer == GL_TIMEOUT_EXPIRED; ++second)
    answer = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 1'000'000'000);
  glDeleteSync(fence);
  if (answer == GL_ALREADY_SIGNALED || answer == GL_CONDITION_SATISFIED) return;
  check_gl(stage);
  throw Error("GL " + stage,
              answer == GL_TIMEOUT_EXPIRED
                  ? "the device did not finish within " + std::to_string(kLongest) + " s"
                  : "the device does not say whether it has finished",
              "choose a smaller resolution, or another {device}");
}

// Returns the GL capability for conservative rasterization. Throws Error if the device has none.
GLenum conservative_switch() {
  if (epoxy_has_gl_extension("GL_NV_conservative_raster")) return GL_CONSERVATIVE_RASTERIZATION_NV;
  if (epoxy_has_gl_extension("GL_INTEL_conservative_rasterization"))
    return GL_CONSERVATIVE_RASTERIZATION_INTEL;
  throw Error("{conservative}",
              "the device has neither GL_NV_conservative_raster nor "
              "GL_INTEL_conservative_rasterization",
              "use {device} native, which draws conservatively on the cores of the CPU");
}

constexpr std::uint32_t kAllBits = 0xffffffff;
constexpr std::uint32_t kGroup = 64;            // work group size: local_size_x of canvas_work.comp
constexpr std::uint32_t kBatches[2] = {64, 4};  // work items per invocation: {sum, pack}
constexpr std::size_t kVec4 = 4 * sizeof(std::uint32_t);

// Positions at which canvas.vert hashes these values into its echo (a checksum).
constexpr std::uint32_t kSerialPlace = 1, kUniformPlace = 2, kElementsPlace = 11, kReportPlace = 12,
                        kFlagsPlace = 13, kFlagSerialPlace = 14, kTouchingPlace = 15;

}  // namespace

CanvasReport::CanvasReport(const GlContext& context, std::size_t block, std::size_t alignment)
    : context_(context), block_(block) {
  // expect() sums a buffer in pieces and binds one range per piece. A range must begin at a
  // multiple of `alignment`. The range begins kTagBytes before its piece, so that its head is the
  // buffer's tag (first piece) or the end of the previous piece (other pieces).
  const std::size_t step = std::max(alignment, kTagBytes);
  piece_ = std::max(block / step, std::size_t{1}) * step;
  for (std::uint32_t step_number = 0; step_number < 2; ++step_number) {
    programs_[step_number] =
        gl_program(step_number == 0 ? "sum of what was sent" : "pack",
                   {"FAR_STEP " + std::to_string(step_number),
                    "FAR_PROGRAM " + std::to_string(step_number + 1) + "u",
                    "FAR_BATCH " + std::to_string(kBatches[step_number]) + "u"},
                   {{GL_COMPUTE_SHADER, {kEchoGlsl, embedded::canvas_work_comp}}});
  }
}

void CanvasReport::start(std::size_t batches, std::size_t dispatches, std::uint32_t flags) {
  echoes_.assign(batches, 0);
  flags_ = 0;
  const std::size_t words = kHead + batches + dispatches + 1 + (flags + 31) / 32;
  store_.reserve(words * sizeof(std::uint32_t), block_);
  // If this write is lost, old sums remain on the device, and read() throws.
  const std::uint32_t zero[kHead] = {0, 0};
  store_.write(0, zero, sizeof zero);
  finished_ = sum_ = 0;
}

void CanvasReport::dispatch(std::uint32_t step, const GlStore& from, std::size_t offset,
                            std::size_t bytes, std::uint32_t tag, std::uint32_t count,
                            std::uint32_t serial, std::uint32_t flags) {
  const std::uint32_t place = kHead + static_cast<std::uint32_t>(echoes_.size());
  // The uniforms of canvas_work.comp: u_count, u_echo, u_serial, u_flags and u_bits.
  const std::array n = {count, place, serial, flags, step == 1 ? place + 1 : 0};
  glUseProgram(programs_[step]);
  for (std::size_t k = 0; k < n.size(); ++k)
    glProgramUniform1ui(programs_[step], static_cast<GLint>(k), n[k]);
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 0, from.name(), static_cast<GLintptr>(offset),
                    static_cast<GLsizeiptr>(bytes));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kReport, store_.name());
  GlEcho echo;
  echo.add({step + 1});
  echo.add(n);
  echo.add({tag, store_.tag()});
  echoes_.push_back(echo.sum);
  finished_ += count;
  const std::uint32_t per_group = kGroup * kBatches[step];
  const std::uint32_t groups = (count + per_group - 1) / per_group;
  const std::uint32_t row = std::min(groups, std::uint32_t(context_.info().max_compute_groups));
  glDispatchCompute(row, (groups + row - 1) / row, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  ++dispatches_;
}

void CanvasReport::expect(const GlStore& store, std::span<const std::byte> data) {
  for (std::size_t at = 0; at < data.size(); at += piece_) {
    const std::span<const std::byte> part = data.subspan(at, std::min(piece_, data.size() - at));
    std::uint32_t tag = store.tag();
    if (at > 0) std::memcpy(&tag, data.data() + at - kTagBytes, sizeof tag);
    sum_ += sum_of(part);
    dispatch(0, store, at, kTagBytes + part.size(), tag,
             static_cast<std::uint32_t>(part.size() / kVec4), 0, 0);
  }
}

void CanvasReport::pack(const GlStore& flags, std::uint32_t serial, std::uint32_t count) {
  flags_ = count;
  dispatch(1, flags, 0, kTagBytes + flags.bytes(), flags.tag(), (count + 31) / 32, serial, count);
}

std::vector<std::uint8_t> CanvasReport::read(const std::string& stage) {
  wait_for_device(stage);
  const std::size_t bits = kHead + echoes_.size();
  // If store_.read() is lost, all words keep this initial value. The number of finished work items
  // is never kAllBits, so a comparison below throws.
  std::vector<std::uint32_t> words(bits + (flags_ + 31) / 32, kAllBits);
  store_.read(0, words.data(), words.size() * sizeof(std::uint32_t));
  bytes_ += words.size() * sizeof(std::uint32_t);
  check_gl(stage);
  for (std::size_t e = 0; e < echoes_.size(); ++e) {
    if (words[kHead + e] != echoes_[e]) {
      throw_lost(
          stage,
          "a draw or a dispatch did not run, or with other numbers or other buffers than were "
          "meant");
    }
  }
  if (words[0] != finished_) {
    throw_lost(stage, std::to_string(words[0]) + " of " + std::to_string(finished_) +
                          " work items finished");
  }
  if (words[1] != sum_) throw_lost(stage, "the device holds other data than were sent");
  std::vector<std::uint8_t> seen(flags_);
  for (std::uint32_t i = 0; i < flags_; ++i) seen[i] = words[bits + i / 32] >> (i % 32) & 1;
  return seen;
}

void CanvasState::bind_target(GLuint framebuffer) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  require(asked(GL_DRAW_FRAMEBUFFER_BINDING) == static_cast<GLint>(framebuffer), "the framebuffer");
}

void CanvasState::set_depth_func(GLenum function) const {
  glDepthFunc(function);
  require(asked(GL_DEPTH_FUNC) == static_cast<GLint>(function), "the depth function");
}

GlTexture CanvasState::texture(GLenum format) const {
  GlTexture out = gl_make<GlTexture>(glGenTextures);
  bind_texture(out);
  glTexStorage2D(GL_TEXTURE_2D, 1, format, target_width, target_height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  check_gl("texture of " + std::to_string(target_width) + " x " + std::to_string(target_height) +
           " px");
  GLint near = 0, far = 0;
  glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, &near);
  glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, &far);
  require(near == GL_NEAREST && far == GL_NEAREST, "the filter of a texture");
  return out;
}

CanvasState::CanvasState(const GlContext& c, DepthMode m, const std::string& s,
                         const GlCanvasOptions& o)
    : context(c), mode(m), options(o), solid(s) {
  if (options.conservative) conservative = conservative_switch();
  const bool with_flags = options.query == QueryMode::flags;
  const GLint blocks = asked(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS), needed = with_flags ? 4 : 3;
  if (blocks < needed) {
    throw Error("GL canvas",
                "the device has " + std::to_string(blocks) +
                    " storage blocks for vertex programs, the canvas needs " +
                    std::to_string(needed),
                "use another {device}, or {method} boxes");
  }
  long storage = context.info().max_storage_block;
  if (options.storage_limit > 0) storage = std::min(storage, options.storage_limit);
  block = static_cast<std::size_t>(storage) - kTagBytes;
  alignment = static_cast<std::size_t>(std::max(asked(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT),
                                                static_cast<GLint>(sizeof(GpuDraw))));
  per_chunk = std::max<std::size_t>(1, block / (16 * vec4s()));
  store_program = program("store", {});
  ask_program =
      with_flags ? program("ask", {ask_define(), "FAR_FLAGS"}) : program("ask", {ask_define()});
  report.emplace(context, block, alignment);
  vertex_array = gl_make<GlVertexArray>(glGenVertexArrays);
  GLint bits = 0;
  glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
  ticks = bits > 0;
  check_gl("canvas");
}

CanvasProgram CanvasState::program(const std::string& name,
                                   std::vector<std::string> defines) const {
  defines.push_back("FAR_ECHO");
  if (mode == DepthMode::fragment) defines.push_back("FAR_PROXY");
  CanvasProgram out;
  out.name = gl_program(name, defines,
                        {{GL_VERTEX_SHADER, {kEchoGlsl, embedded::canvas_vert}},
                         {GL_FRAGMENT_SHADER, {solid, embedded::canvas_frag}}});
  out.number = gl_number();
  glProgramUniform1ui(out.name, glGetUniformLocation(out.name, "u_program"), out.number);
  return out;
}

void CanvasState::resize_target() {
  const int width = window.width + 2 * kBorder, height = window.height + 2 * kBorder;
  if (width == target_width && height == target_height) return;
  target_width = width;
  target_height = height;
  depth = texture(options.depth_format == DepthFormat::float32 ? GL_DEPTH_COMPONENT32F
                                                               : GL_DEPTH_COMPONENT24);
  bare_target = gl_make<GlFramebuffer>(glGenFramebuffers);
  bind_target(bare_target);
  glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, width);
  glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, height);
  glDrawBuffer(GL_NONE);
  GLint given[2] = {0, 0};
  glGetFramebufferParameteriv(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, &given[0]);
  glGetFramebufferParameteriv(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, &given[1]);
  require(given[0] == width && given[1] == height, "the size of a render target");
  const GLenum bare_status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  depth_target = gl_make<GlFramebuffer>(glGenFramebuffers);
  bind_target(depth_target);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  glDrawBuffer(GL_NONE);
  const GLenum depth_status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  check_gl("render target of " + std::to_string(width) + " x " + std::to_string(height) + " px");
  if (depth_status != GL_FRAMEBUFFER_COMPLETE || bare_status != GL_FRAMEBUFFER_COMPLETE) {
    throw Error("GL render target",
                "the device refuses a depth target of " + std::to_string(width) + " x " +
                    std::to_string(height) + " px",
                "choose a smaller resolution, another {depth_format} or another {device}");
  }
  clear_depth(kLeft);
}

void CanvasState::set_uniforms(CanvasProgram& program) const {
  const std::array<float, 2> to_ndc = {2.0f / static_cast<float>(viewport_side(window.width)),
                                       2.0f / static_cast<float>(viewport_side(window.height))};
  const std::array<float, 1> scale = {depth_scale(window)};
  const std::array<std::int32_t, 4> inner = {kBorder, kBorder, window.width, window.height};
  const std::array<float, 2> centre = {static_cast<float>(target_width / 2),
                                       static_cast<float>(target_height / 2)};
  const auto at = [&](const char* uniform) { return glGetUniformLocation(program.name, uniform); };
  glProgramUniform2fv(program.name, at("u_to_ndc"), 1, to_ndc.data());
  glProgramUniform1f(program.name, at("u_scale"), scale[0]);
  glProgramUniform4iv(program.name, at("u_window"), 1, inner.data());
  glProgramUniform2fv(program.name, at("u_centre"), 1, centre.data());
  GlEcho echo{.sum = 0, .place = kUniformPlace};
  echo.add_at(0, program.number);
  echo.add(to_ndc);
  echo.add(scale);
  echo.add(inner);
  echo.add(centre);
  program.echo = echo.sum;
}

void CanvasState::clear_depth(float value) const {
  glDepthMask(GL_TRUE);
  require(asked(GL_DEPTH_WRITEMASK) == GL_TRUE, "the depth mask");
  glClearDepth(value);
  GLfloat given = -1;
  glGetFloatv(GL_DEPTH_CLEAR_VALUE, &given);
  require(given == value, "the depth to clear to");
  glClear(GL_DEPTH_BUFFER_BIT);
}

// Sets the GL state that is constant during a pass, and clears the depth buffer to `clear`.
void CanvasState::start(float clear) const {
  glBindVertexArray(vertex_array);
  const int vw = viewport_side(window.width), vh = viewport_side(window.height);
  const std::array<GLint, 4> viewport = {target_width / 2 - vw / 2, target_height / 2 - vh / 2, vw,
                                         vh};
  glViewport(viewport[0], viewport[1], vw, vh);
  set_enabled(GL_CULL_FACE, false, "face culling");
  set_enabled(GL_DEPTH_CLAMP, true, "depth clamping");
  glDepthRange(0, 1);
  glActiveTexture(GL_TEXTURE0);
  std::array<GLint, 4> given{};
  std::array<GLfloat, 2> range{};
  glGetIntegerv(GL_VIEWPORT, given.data());
  glGetFloatv(GL_DEPTH_RANGE, range.data());
  require(asked(GL_VERTEX_ARRAY_BINDING) == static_cast<GLint>(vertex_array), "the vertex array");
  require(given == viewport, "the viewport");
  require(range[0] == 0 && range[1] == 1, "the depth range");
  require(asked(GL_ACTIVE_TEXTURE) == GL_TEXTURE0, "the texture unit");
  bind_texture(depth);
  bind_target(depth_target);
  set_enabled(GL_DEPTH_TEST, true, "the depth test");
  clear_depth(clear);
}

// Sets the GL state for a step. Makes only needed calls, since a pass may have many steps.
void CanvasState::set_verb(Verb verb, bool touching) {
  ++work.state_changes;
  const bool ask = verb == Verb::ask, bare = ask && compares_in_shader();
  glUseProgram(ask ? ask_program.name : store_program.name);
  if (compares_in_shader()) {
    bind_target(bare ? bare_target : depth_target);
    set_enabled(GL_DEPTH_TEST, !bare, "the depth test");
  }
  if (bare) return;
  glDepthMask(ask ? GL_FALSE : GL_TRUE);
  require(asked(GL_DEPTH_WRITEMASK) == (ask ? GL_FALSE : GL_TRUE), "the depth mask");
  set_depth_func(ask ? (touching ? GL_GEQUAL : GL_GREATER) : GL_LESS);
}

// Uploads the draw list and the canvas's own elements (state.h). The device sums their bytes.
void CanvasState::upload(const CanvasPass& laid, bool with_flags) {
  const auto list = laid.list_bytes();
  const auto own = std::as_bytes(std::span(laid.own));
  const std::size_t flag_bytes = with_flags ? (laid.slots + std::size_t{3}) / 4 * 16 : 0;
  std::size_t longest = 0;
  for (const CanvasBatch& batch : laid.batches) longest = std::max(longest, batch.count);
  const std::size_t words = laid.batches.size() + report->dispatches(list.size() + own.size()) + 8 +
                            report->dispatches(flag_bytes) + (with_flags ? laid.slots / 32 : 0);
  if (std::max({(longest + 1) * sizeof(GpuDraw), kTagBytes + own.size(), kTagBytes + flag_bytes,
                kTagBytes + words * sizeof(std::uint32_t)}) >
      static_cast<std::size_t>(context.info().max_storage_block)) {
    throw Error("GL pass",
                "its draw list or its slots are beyond this device's largest storage block",
                "split the scene into several runs, or choose another {device}");
  }
  draws.reserve(list.size(), std::max(block, list.size()));
  draws.write(0, list.data(), list.size());
  extras.reserve(own.size(), block);
  extras.write(0, own.data(), own.size());
  std::size_t cleared = 0;
  if (with_flags && flags.reserve(flag_bytes, block)) {
    cleared = flags.bytes() / 16 * 16;
    flags.clear(cleared);
  }
  work.uploaded_bytes += list.size() + own.size();
  report->start(laid.batches.size(),
                report->dispatches(list.size()) + report->dispatches(own.size()) +
                    report->dispatches(cleared),
                with_flags ? laid.slots : 0);
  report->expect(draws, list);
  report->expect(extras, own);
  if (cleared > 0) report->expect(flags, std::vector<std::byte>(cleared));
  if (with_flags) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kFlags, flags.name());
}

// Binds the buffers of a batch, except those that `before` (the previous batch or null) bound.
void CanvasState::bind(const CanvasBatch& batch, const CanvasBatch* before) const {
  if (before == nullptr || before->chunk != batch.chunk)
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kElements, elements_of(batch).name());
  // Conservative rasterization is off for the canvas's own elements, which do not need it.
  const bool own = batch.chunk == kExtras;
  if (conservative != 0 && (before == nullptr || (before->chunk == kExtras) != own))
    set_enabled(conservative, !own, "conservative rasterization");
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, kDraws, draws.name(),
                    static_cast<GLintptr>(batch.offset * sizeof(GpuDraw)),
                    static_cast<GLsizeiptr>((batch.count + 1) * sizeof(GpuDraw)));
}

std::uint32_t CanvasState::echo(const CanvasPass& laid, const CanvasBatch& batch,
                                const CanvasProgram& program, bool touching) const {
  GlEcho echo{.sum = program.echo};
  echo.add_at(kSerialPlace, laid.serial);
  echo.add_at(kElementsPlace, elements_of(batch).tag());
  echo.add_at(kReportPlace, report->store().tag());
  if (&program == &ask_program && options.query == QueryMode::flags) {
    echo.add_at(kFlagsPlace, flags.tag());
    echo.add_at(kFlagSerialPlace, laid.serial);
    echo.add_at(kTouchingPlace, touching);
  }
  return echo.sum;
}

void CanvasState::draw(std::size_t first, std::size_t count) {
  // Limits the vertices of a draw call, because GL counts vertices in signed 32-bit integers.
  constexpr std::size_t kMost = 1u << 26;
  for (std::size_t at = first; at < first + count; at += kMost) {
    const std::size_t n = std::min(kMost, first + count - at);
    glDrawArrays(GL_TRIANGLES, static_cast<GLint>(at) * vertices(),
                 static_cast<GLsizei>(n) * vertices());
    ++work.draws;
  }
}

// Records the device's time. The query is new, so a lost glQueryCounter leaves no old time in it.
void CanvasState::stamp(std::size_t place) {
  if (!ticks) return;
  stamps[place] = gl_make<GlQuery>(glGenQueries);
  glQueryCounter(stamps[place], GL_TIMESTAMP);
}

double CanvasState::stamped_ms() const {
  std::array<GLuint64, 2> ns{};
  for (std::size_t k = 0; k < ns.size(); ++k) {
    if (stamps[k] == 0) return -1;
    GLuint ready = GL_FALSE;
    glGetQueryObjectuiv(stamps[k], GL_QUERY_RESULT_AVAILABLE, &ready);
    if (ready == GL_TRUE) glGetQueryObjectui64v(stamps[k], GL_QUERY_RESULT, &ns[k]);
    check_gl("clock");
    if (ns[k] == 0) return -1;
  }
  return ns[1] >= ns[0] ? static_cast<double>(ns[1] - ns[0]) / 1e6 : -1;
}

}  // namespace farcull
