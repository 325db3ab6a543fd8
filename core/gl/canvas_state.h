// The canvas on the device. For core/gl/canvas*.cpp alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/canvas/canvas.h"
#include "core/gl/canvas_layout.h"
#include "core/gl/canvas_options.h"
#include "core/gl/canvas_report.h"
#include "core/gl/clock.h"
#include "core/gl/context.h"
#include "core/gl/objects.h"

namespace farcull {

// Storage buffer bindings of canvas.vert and canvas.frag, beside kReport.
constexpr GLuint kElements = 0, kDraws = 1, kFlags = 2;

/// A program of canvas.vert and canvas.frag, and the echo of its uniforms.
struct CanvasProgram {
  GlProgram name;
  std::uint32_t number = 0;  // no other program of the process has it
  std::uint32_t echo = 0;    // of the uniforms that belong to the window
};

/// Elements that were sent, so that the same ones are not sent twice.
struct CanvasElements {
  std::vector<GlStore> chunks;
  std::vector<std::byte> bytes;  // what was sent to them
};

/// The canvas on the device: its programs, render targets and stores, and the state that a pass
/// sets before it draws.
struct CanvasState {
  const GlContext& context;
  DepthMode mode;
  GlCanvasOptions options;
  std::string solid;  // GLSL
  bool begun = false;

  CanvasProgram store_program, ask_program, exit_program, entry_values, exit_values;
  GlVertexArray vertex_array;
  GlTexture depth;
  GlFramebuffer depth_target, bare_target;
  int target_width = 0, target_height = 0;
  bool odd = false;                     // which of two pixels the next pass marks
  CanvasElements current;               // of the last begin()
  std::vector<CanvasElements> earlier;  // of those before, which may come again
  std::size_t per_chunk = 0;            // elements
  std::size_t elements = 0;
  std::size_t block = 0;        // bytes of data in a storage block
  std::size_t alignment = 256;  // of a storage buffer range, in bytes
  GLenum conservative = 0;      // what turns conservative rasterization on; 0: not wanted
  GlStore extras, draws, flags;
  std::optional<CanvasReport> report;
  std::vector<GlQuery> queries;
  Window window;
  GlClock clock{2};  // when a pass or an upload begins and ends
  CanvasWork work;

  CanvasState(const GlContext& context, DepthMode mode, const std::string& solid,
              const GlCanvasOptions& options);

  std::size_t vec4s() const { return mode == DepthMode::fragment ? 7 : 3; }
  GLsizei vertices() const { return mode == DepthMode::fragment ? 6 : 3; }
  // Proxies write their depth, so their fragments compare with the stored one themselves. Triangles
  // at fixed depth let the depth test decide before the fragment program raises the flag: then no
  // step reads the texture that another draws to, which would have to be finished first.
  bool compares_in_shader() const {
    return options.query == QueryMode::flags && mode == DepthMode::fragment;
  }
  GLuint primitives() const { return mode == DepthMode::fragment ? 2 : 1; }
  const GlStore& elements_of(const CanvasRun& run) const {
    return run.chunk == kExtras ? extras : current.chunks[run.chunk];
  }

  CanvasShape shape() const;
  void bind_target(GLuint framebuffer) const;
  void set_depth_func(GLenum function) const;
  GlTexture texture(GLenum format) const;  // of the target's size
  CanvasProgram program(const std::string& name, std::vector<std::string> defines) const;
  void resize_target();
  void set_uniforms(CanvasProgram& program) const;
  void clear_depth(float value) const;
  void start(float clear) const;
  void set_verb(Verb verb, bool touching);
  void set_conservative(bool on) const;
  void upload(const CanvasPass& laid, bool with_flags);
  void bind(const CanvasRun& run, const CanvasRun* before) const;
  std::uint32_t echo(const CanvasPass& laid, const CanvasRun& run, const CanvasProgram& program,
                     bool touching) const;
  void draw(std::size_t first, std::size_t count);

  // Uploads the elements of `drawables` and prepares the targets. All functions throw Error where
  // the device refuses or a command was lost; nothing on it is to be believed then.
  void begin(const Window& window, const Drawables& drawables);
  std::vector<std::uint8_t> run(const Pass& pass);
  std::vector<float> depths(Verb verb, const std::vector<Draw>& wanted);
  std::vector<float> samples(Verb verb, const std::vector<Draw>& wanted);

 private:
  std::uint64_t draw_pass(const Pass& pass, const CanvasPass& laid);
  void draw_queries(const CanvasPass& laid, const CanvasRun& run, std::uint32_t& open);
  void draw_all(CanvasProgram& program, Verb verb, const std::vector<Draw>& wanted, GLuint target);
  std::vector<std::uint8_t> read_queries(std::uint32_t slots);
  std::vector<std::uint8_t> read_report(const std::string& stage);
  bool choose_elements(std::span<const std::byte> bytes);
};

}  // namespace farcull
