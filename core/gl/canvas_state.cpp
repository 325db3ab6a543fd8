// Sets the state that a pass draws with. GL is asked for each value after it was set, where it can
// be; the echo of each batch holds the rest.
#include "core/gl/canvas_state.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/gl/echo.h"
#include "embedded/canvas_frag.h"
#include "embedded/canvas_vert.h"
#include "embedded/echo_glsl.h"

namespace farcull {
namespace {

GLint asked(GLenum name) {
  GLint value = -1;
  glGetIntegerv(name, &value);
  return value;
}

void require(bool set, const char* what) {
  if (!set) throw_lost_state(what);
}

void bind_texture(GLuint name) {
  glBindTexture(GL_TEXTURE_2D, name);
  require(asked(GL_TEXTURE_BINDING_2D) == static_cast<GLint>(name), "the texture");
}

// What turns conservative rasterization on. Throws Error where the device has none.
GLenum conservative_switch() {
  if (epoxy_has_gl_extension("GL_NV_conservative_raster")) return GL_CONSERVATIVE_RASTERIZATION_NV;
  if (epoxy_has_gl_extension("GL_INTEL_conservative_rasterization"))
    return GL_CONSERVATIVE_RASTERIZATION_INTEL;
  throw Error("{conservative}",
              "the device has neither GL_NV_conservative_raster nor "
              "GL_INTEL_conservative_rasterization",
              "use {device} native, which draws conservatively on the cores of the CPU");
}

// Places of core/gl/shaders/canvas.vert in the echo.
constexpr std::uint32_t kSerialPlace = 1, kUniformPlace = 2, kElementsPlace = 11, kReportPlace = 12,
                        kFlagsPlace = 13, kFlagSerialPlace = 14, kTouchingPlace = 15;

}  // namespace

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
                "use another {device}, or {method} far-pairs");
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
  check_gl("canvas");
}

CanvasShape CanvasState::shape() const {
  return {mode,
          window.width,
          window.height,
          target_width,
          target_height,
          per_chunk,
          alignment / sizeof(GpuDraw)};
}

CanvasProgram CanvasState::program(const std::string& name,
                                   std::vector<std::string> defines) const {
  defines.push_back("FAR_ECHO");
  if (mode == DepthMode::fragment) defines.push_back("FAR_PROXY");
  CanvasProgram out;
  out.name = gl_program(name, defines,
                        {{GL_VERTEX_SHADER, {embedded::echo_glsl, embedded::canvas_vert}},
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

// Sets the state that stays the same during a pass.
void CanvasState::start(float clear) const {
  glBindVertexArray(vertex_array);
  const int vw = viewport_side(window.width), vh = viewport_side(window.height);
  const std::array<GLint, 4> viewport = {target_width / 2 - vw / 2, target_height / 2 - vh / 2, vw,
                                         vh};
  glViewport(viewport[0], viewport[1], vw, vh);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_CLAMP);
  glDepthRange(0, 1);
  glActiveTexture(GL_TEXTURE0);
  std::array<GLint, 4> given{};
  std::array<GLfloat, 2> range{};
  glGetIntegerv(GL_VIEWPORT, given.data());
  glGetFloatv(GL_DEPTH_RANGE, range.data());
  require(asked(GL_VERTEX_ARRAY_BINDING) == static_cast<GLint>(vertex_array), "the vertex array");
  require(given == viewport, "the viewport");
  require(glIsEnabled(GL_CULL_FACE) == GL_FALSE, "face culling");
  require(glIsEnabled(GL_DEPTH_CLAMP) == GL_TRUE, "depth clamping");
  require(range[0] == 0 && range[1] == 1, "the depth range");
  require(asked(GL_ACTIVE_TEXTURE) == GL_TEXTURE0, "the texture unit");
  bind_texture(depth);
  bind_target(depth_target);
  glEnable(GL_DEPTH_TEST);
  require(glIsEnabled(GL_DEPTH_TEST) == GL_TRUE, "the depth test");
  clear_depth(clear);
}

// A pass may have as many steps as triangles, so a step calls only what it needs.
void CanvasState::set_verb(Verb verb, bool touching) {
  ++work.state_changes;
  const bool ask = verb == Verb::ask, bare = ask && compares_in_shader();
  glUseProgram(ask ? ask_program.name : store_program.name);
  if (compares_in_shader()) {
    bind_target(bare ? bare_target : depth_target);
    if (bare) {
      glDisable(GL_DEPTH_TEST);
    } else {
      glEnable(GL_DEPTH_TEST);
    }
    require(glIsEnabled(GL_DEPTH_TEST) == (bare ? GL_FALSE : GL_TRUE), "the depth test");
  }
  if (bare) return;
  glDepthMask(ask ? GL_FALSE : GL_TRUE);
  require(asked(GL_DEPTH_WRITEMASK) == (ask ? GL_FALSE : GL_TRUE), "the depth mask");
  set_depth_func(ask ? (touching ? GL_GEQUAL : GL_GREATER) : GL_LESS);
}

// The canvas's own elements fill single pixels, so they are never drawn conservatively.
void CanvasState::set_conservative(bool on) const {
  if (conservative == 0) return;
  if (on) {
    glEnable(conservative);
  } else {
    glDisable(conservative);
  }
  require(glIsEnabled(conservative) == (on ? GL_TRUE : GL_FALSE), "conservative rasterization");
}

// Sends the lists of a pass; the device sums them.
void CanvasState::upload(const CanvasPass& laid, bool with_flags) {
  const auto list = laid.list_bytes();
  const auto own = std::as_bytes(std::span(laid.own));
  const std::size_t flag_bytes = with_flags ? (laid.slots + std::size_t{3}) / 4 * 16 : 0;
  std::size_t longest = 0;
  for (const CanvasRun& run : laid.runs) longest = std::max(longest, run.count);
  const std::size_t words = laid.runs.size() + report->dispatches(list.size() + own.size()) + 8 +
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
  report->start(laid.runs.size(),
                report->dispatches(list.size()) + report->dispatches(own.size()) +
                    report->dispatches(cleared),
                with_flags ? laid.slots : 0);
  report->expect(draws, list);
  report->expect(extras, own);
  if (cleared > 0) report->expect(flags, std::vector<std::byte>(cleared));
  if (with_flags) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kFlags, flags.name());
}

// `before`: the run that was bound last, whose elements may serve again.
void CanvasState::bind(const CanvasRun& run, const CanvasRun* before) const {
  if (before == nullptr || before->chunk != run.chunk)
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kElements, elements_of(run).name());
  if (before == nullptr || (before->chunk == kExtras) != (run.chunk == kExtras))
    set_conservative(run.chunk != kExtras);
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, kDraws, draws.name(),
                    static_cast<GLintptr>(run.offset * sizeof(GpuDraw)),
                    static_cast<GLsizeiptr>((run.count + 1) * sizeof(GpuDraw)));
}

std::uint32_t CanvasState::echo(const CanvasPass& laid, const CanvasRun& run,
                                const CanvasProgram& program, bool touching) const {
  GlEcho echo{.sum = program.echo};
  echo.add_at(kSerialPlace, laid.serial);
  echo.add_at(kElementsPlace, elements_of(run).tag());
  echo.add_at(kReportPlace, report->store().tag());
  if (&program == &ask_program && options.query == QueryMode::flags) {
    echo.add_at(kFlagsPlace, flags.tag());
    echo.add_at(kFlagSerialPlace, laid.serial);
    echo.add_at(kTouchingPlace, touching);
  }
  return echo.sum;
}

void CanvasState::draw(std::size_t first, std::size_t count) {
  // GL counts vertices in signed 32-bit numbers.
  constexpr std::size_t kMost = 1u << 26;
  for (std::size_t at = first; at < first + count; at += kMost) {
    const std::size_t n = std::min(kMost, first + count - at);
    glDrawArrays(GL_TRIANGLES, static_cast<GLint>(at) * vertices(),
                 static_cast<GLsizei>(n) * vertices());
    ++work.draws;
  }
}

}  // namespace farcull
