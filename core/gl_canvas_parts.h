// The parts of the GL canvas, for core/gl_canvas*.cpp alone: what lies on the device, the draw list
// of a pass, and the report in which the device says what it has read and done (assumption A7).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gl_canvas.h"
#include "core/gl_echo.h"
#include "core/gl_objects.h"

namespace farcull {

struct GpuDraw {
  std::uint32_t element;
  std::uint32_t slot;
};

/// A batch of draws: consecutive ones of one step that read one element buffer.
struct CanvasRun {
  std::size_t step;
  Verb verb;
  std::size_t chunk;   // element buffer; kExtras for the canvas's own elements
  std::size_t offset;  // of its head in the draw list; its draws follow
  std::size_t count;   // of draws
};
constexpr std::size_t kExtras = static_cast<std::size_t>(-1);

/// All that a pass sends.
struct CanvasPass {
  std::uint32_t serial = 0;   // no other pass of the process has it
  std::vector<GpuDraw> list;  // begins with two entries where the store has its tag; each
                              // batch begins with {serial, word of the report}
  std::vector<float> own;     // the canvas's own elements
  std::vector<CanvasRun> runs;
  std::uint32_t slots = 0;  // of the caller's; with marks, one that must not be seen; controls
  std::span<const std::byte> list_bytes() const {
    return std::as_bytes(std::span(list).subspan(2));
  }
};

/// Throws Error: GL does not have `what` as it was set.
[[noreturn]] void throw_lost_state(const char* what);

/// A storage buffer into which every batch of draws writes its echo, every dispatch its own and the
/// number of its work items that finished, and which holds the flags of a pass.
class CanvasReport {
 public:
  static constexpr std::uint32_t kHead = 2;  // words before the echoes: finished, sum

  /// block: bytes of data in a storage block; alignment: of a storage buffer range, in bytes.
  CanvasReport(const GlContext& context, std::size_t block, std::size_t alignment);

  /// Expects `runs` batches of draws and at most `dispatches` dispatches; `flags` to be packed.
  void start(std::size_t runs, std::size_t dispatches, std::uint32_t flags);
  /// The dispatches that expect() makes for so many bytes.
  std::size_t dispatches(std::size_t bytes) const { return (bytes + piece_ - 1) / piece_; }
  /// Lets the device sum what the store holds from its beginning; read() compares the sum with that
  /// of `data`, of a multiple of 16 bytes.
  void expect(const GlStore& store, std::span<const std::byte> data);
  /// The echo of batch `run`, which writes it to word kHead + run.
  void expect_run(std::size_t run, std::uint32_t echo) { echoes_[run] = echo; }
  /// Lets the device pack the flags that hold `serial`; the last dispatch before read().
  void pack(const GlStore& flags, std::uint32_t serial, std::uint32_t count, Fault fault);
  /// Waits and reads. Throws Error naming `stage` unless every echo and the sum are those that were
  /// expected, every work item finished and GL has no error. A flag each, where pack() was called.
  std::vector<std::uint8_t> read(const std::string& stage);
  const GlStore& store() const { return store_; }

 private:
  struct Numbers {  // the uniforms of canvas_work.comp
    std::uint32_t count, echo, unfinished, serial, flags, bits;
  };
  void dispatch(std::uint32_t step, const GlStore& from, std::size_t offset, std::size_t bytes,
                std::uint32_t tag, const Numbers& numbers, std::uint32_t groups);

  const GlContext& context_;
  std::size_t block_, piece_;
  std::array<GlProgram, 2> programs_;  // by step: sum, pack
  GlStore store_;
  std::vector<std::uint32_t> echoes_;     // expected: of the batches, then of the dispatches
  std::uint32_t finished_ = 0, sum_ = 0;  // expected
  std::uint32_t flags_ = 0;               // packed
};

/// A program of canvas.vert and canvas.frag, and the echo of its uniforms.
struct CanvasProgram {
  GlProgram name;
  std::uint32_t number = 0;  // no other program of the process has it
  std::uint32_t echo = 0;    // of the uniforms that belong to the window
};

struct GlCanvas::State {
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
  bool odd = false;  // which of two pixels the next pass marks
  std::vector<GlStore> chunks;
  std::size_t per_chunk = 0;  // elements
  std::size_t elements = 0;
  std::size_t block = 0;        // bytes of data in a storage block
  std::size_t alignment = 256;  // of a storage buffer range, in bytes
  GlStore extras, draws, flags;
  std::optional<CanvasReport> report;
  std::vector<GlQuery> queries;
  Window window;

  State(const GlContext& context, DepthMode mode, const std::string& solid,
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
    return run.chunk == kExtras ? extras : chunks[run.chunk];
  }

  // gl_canvas_layout.cpp
  std::size_t quad_elements() const { return mode == DepthMode::fragment ? 1 : 2; }
  void add_quad(std::vector<float>& out, double x0, double y0, double x1, double y1,
                float depth) const;
  void add_control(std::vector<float>& out, float depth, int pixel) const;
  CanvasPass lay_out(const Pass& pass, bool marks) const;

  // gl_canvas_state.cpp
  void bind_target(GLuint framebuffer) const;
  void set_depth_func(GLenum function) const;
  GlTexture texture(GLenum format) const;  // of the target's size
  CanvasProgram program(const std::string& name, std::vector<std::string> defines) const;
  void resize_target();
  void set_uniforms(CanvasProgram& program) const;
  void clear_depth(float value) const;
  void start(float clear) const;
  void set_verb(Verb verb, bool touching) const;
  void upload(const CanvasPass& laid, bool with_flags);
  void bind(const CanvasRun& run, const CanvasRun* before) const;
  std::uint32_t echo(const CanvasPass& laid, const CanvasRun& run, const CanvasProgram& program,
                     bool touching) const;
  void draw(std::size_t first, std::size_t count) const;

  // gl_canvas.cpp
  void begin(const Window& window, const Drawables& drawables);
  std::vector<std::uint8_t> run(const Pass& pass, Fault fault);
  void draw_all(CanvasProgram& program, Verb verb, const std::vector<Draw>& wanted, GLuint target);
  std::vector<float> depths(Verb verb, const std::vector<Draw>& wanted);
  std::vector<float> samples(Verb verb, const std::vector<Draw>& wanted);
  std::vector<std::uint8_t> read_queries(std::uint32_t slots) const;
};

// Control items stand in corner pixels of the render target, outside the window. In pixel 0 the
// store of step k leaves the depth kControlTop - k * kControlGap; the next ask's control item, at
// that depth (or half a gap behind it, where equal depths are not seen), is seen only if that store
// ran.
constexpr double kControlTop = 0.95;
constexpr double kControlGap = 0x1p-21;
constexpr std::size_t kMaxControls = 400'000;  // kControlTop - kMaxControls * kControlGap > 0.75
// A pass marks pixel 1 or 2 in turn, and asks in the other, where the pass before it left its mark:
// kAsked must not be seen, so it has been cleared since.
constexpr float kMark = 0.96f, kAsked = 0.98f;
constexpr float kLeft = 0.5f;  // where no pass has been, every pixel is cleared to this depth

// Storage buffer bindings.
constexpr GLuint kElements = 0, kDraws = 1, kFlags = 2, kReport = 3;

}  // namespace farcull
