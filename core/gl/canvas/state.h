// CanvasState holds the state of a GL canvas on the device: uploaded data, GL state, and the
// report. The report is a buffer in which the device returns checksums of the values that it read
// (assumption A7: no command is lost). Only core/gl/canvas includes this file.
//
// The canvas also draws its own elements: the quad for kEverywhere, and control items that reveal
// lost commands. Control items are in pixels 0 to 2 of the target's lowest row, outside the window:
// - Pixel 0: the k-th store step of a pass stores the depth kControlTop - k * kControlGap. The
//   next visibility test draws a control item at this depth (half a gap farther if equal depths are
//   not seen). The item is seen only if the store ran.
// - Pixels 1 and 2: each pass stores a mark (the depth kMark) in one of them, alternately. In the
//   other pixel, the pass tests a control item at kAsked. If the depth buffer still holds the
//   previous pass's mark, the item is seen, and the pass fails.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gl/base/objects.h"
#include "core/gl/canvas/canvas.h"

namespace farcull {

constexpr double kControlTop = 0.95;
constexpr double kControlGap = 0x1p-21;
constexpr float kMark = 0.96f, kAsked = 0.98f;
constexpr float kLeft = 0.5f;  // depth in all pixels before the first pass and after depths()

struct GpuDraw {
  std::uint32_t element;
  std::uint32_t slot;
};

/// A batch is a sequence of consecutive draws of one step that read the same element buffer.
struct CanvasBatch {
  std::size_t step;
  Verb verb;
  std::size_t chunk;   // index of the element buffer; kExtras: CanvasState::extras
  std::size_t offset;  // index of the batch's head entry in the draw list; the draws follow
  std::size_t count;   // number of draws
};
constexpr std::size_t kExtras = static_cast<std::size_t>(-1);

/// All data that a pass uploads.
struct CanvasPass {
  std::uint32_t serial = 0;  // unique among the passes of the process
  /// The first two entries are not uploaded: in the buffer, the tag has their place. The batches
  /// follow. Each begins with a head entry: {serial, index of the batch's word in the report}.
  std::vector<GpuDraw> list;
  std::vector<float> own;  // elements of the canvas itself (see above)
  std::vector<CanvasBatch> batches;
  /// Number of slots (results): the caller's slots, and one for each tested control item.
  std::uint32_t slots = 0;
  std::span<const std::byte> list_bytes() const {
    return std::as_bytes(std::span(list).subspan(2));
  }
};

/// Binding points of the storage buffers that the canvas's programs use.
constexpr GLuint kElements = 0, kDraws = 1, kFlags = 2, kReport = 3;

/// A storage buffer for the device's report. Each batch of draws and each dispatch writes its echo
/// (GlEcho: a checksum of the values that were read) to the report. Each dispatch also adds its
/// number of finished work items. After pack(), the report also holds the packed flags of a pass.
class CanvasReport {
 public:
  static constexpr std::uint32_t kHead = 2;  // words before the echoes: finished work items, sum

  /// block: data bytes in a storage block. alignment: alignment (bytes) of a range that is bound.
  CanvasReport(const GlContext& context, std::size_t block, std::size_t alignment);

  /// Begins a report on `batches` batches, at most `dispatches` dispatches and `flags` packed
  /// flags.
  void start(std::size_t batches, std::size_t dispatches, std::uint32_t flags);
  /// Returns the number of dispatches that expect() makes for this many bytes.
  std::size_t dispatches(std::size_t bytes) const { return (bytes + piece_ - 1) / piece_; }
  /// Makes the device sum the first data.size() bytes of the store. read() compares the result with
  /// the sum of `data`. The size of `data` must be a multiple of 16 bytes.
  void expect(const GlStore& store, std::span<const std::byte> data);
  /// Sets the echo that a batch should write to word kHead + batch.
  void expect_batch(std::size_t batch, std::uint32_t echo) { echoes_[batch] = echo; }
  /// Makes the device pack `count` flags into bits: a bit is 1 if its flag equals `serial`. Must be
  /// the last call before read().
  void pack(const GlStore& flags, std::uint32_t serial, std::uint32_t count);
  /// Waits for the device. Throws Error naming `stage` if an echo or the sum is wrong, a work item
  /// did not finish or GL reports an error. Returns the flags of pack(), one byte per flag.
  std::vector<std::uint8_t> read(const std::string& stage);
  const GlStore& store() const { return store_; }
  /// Return the number of dispatches so far, and the number of bytes that read() has read so far.
  std::uint64_t dispatches_in_all() const { return dispatches_; }
  std::uint64_t bytes_in_all() const { return bytes_; }

 private:
  void dispatch(std::uint32_t step, const GlStore& from, std::size_t offset, std::size_t bytes,
                std::uint32_t tag, std::uint32_t count, std::uint32_t serial, std::uint32_t flags);

  const GlContext& context_;
  std::size_t block_, piece_;
  std::array<GlProgram, 2> programs_;  // programs of canvas_work.comp: sum, pack
  GlStore store_;
  std::vector<std::uint32_t> echoes_;     // expected echoes of the batches, then of the dispatches
  std::uint32_t finished_ = 0, sum_ = 0;  // expected values of words 0 and 1
  std::uint32_t flags_ = 0;               // number of packed flags
  std::uint64_t dispatches_ = 0, bytes_ = 0;
};

/// A program linked from canvas.vert and canvas.frag, and the echo (checksum) of its uniforms.
struct CanvasProgram {
  GlProgram name;
  std::uint32_t number = 0;  // unique among the programs of the process
  std::uint32_t echo = 0;    // echo of `number` and of the uniforms that depend on the window
};

/// Elements on the device. The copy of their bytes shows whether new elements need an upload.
struct CanvasElements {
  std::vector<GlStore> chunks;
  std::vector<std::byte> bytes;  // copy of the bytes that the chunks hold
};

struct CanvasState {
  const GlContext& context;
  DepthMode mode;
  GlCanvasOptions options;
  std::string solid;  // GLSL source of the solid's function
  bool begun = false;

  CanvasProgram store_program, ask_program, exit_program, entry_values, exit_values;
  GlVertexArray vertex_array;
  GlTexture depth;
  GlFramebuffer depth_target, bare_target;
  int target_width = 0, target_height = 0;
  bool odd = false;                     // pixel for the next pass's mark: 2 if false, 1 if true
  CanvasElements current;               // elements of the last begin()
  std::vector<CanvasElements> earlier;  // elements of earlier begin() calls, for reuse
  std::size_t per_chunk = 0;            // largest number of elements in a chunk
  std::size_t block = 0;                // bytes of data in a storage block
  std::size_t alignment = 256;          // alignment of a storage buffer range, in bytes
  GLenum conservative = 0;              // GL capability for conservative rasterization; 0: off
  GlStore extras, draws, flags;
  std::optional<CanvasReport> report;
  std::vector<GlQuery> queries;
  Window window;
  bool ticks = false;             // true if the device has a clock (GL_TIMESTAMP)
  std::array<GlQuery, 2> stamps;  // time at the start and the end of a pass or upload
  CanvasWork work;

  CanvasState(const GlContext& context, DepthMode mode, const std::string& solid,
              const GlCanvasOptions& options);

  std::size_t vec4s() const { return mode == DepthMode::fragment ? 7 : 3; }
  GLsizei vertices() const { return mode == DepthMode::fragment ? 6 : 3; }
  // True if the fragment program compares a proxy's depth with the depth texture. For triangles,
  // the depth test decides before the fragment program runs. So a test need not wait until earlier
  // stores are visible in a texture.
  bool compares_in_shader() const {
    return options.query == QueryMode::flags && mode == DepthMode::fragment;
  }
  GLuint primitives() const { return mode == DepthMode::fragment ? 2 : 1; }
  const GlStore& elements_of(const CanvasBatch& batch) const {
    return batch.chunk == kExtras ? extras : current.chunks[batch.chunk];
  }

  void bind_target(GLuint framebuffer) const;
  void set_depth_func(GLenum function) const;
  GlTexture texture(GLenum format) const;  // a texture of the target's size
  CanvasProgram program(const std::string& name, std::vector<std::string> defines) const;
  void resize_target();
  void set_uniforms(CanvasProgram& program) const;
  void clear_depth(float value) const;
  void start(float clear) const;
  void set_verb(Verb verb, bool touching);
  void upload(const CanvasPass& laid, bool with_flags);
  void bind(const CanvasBatch& batch, const CanvasBatch* before) const;
  std::uint32_t echo(const CanvasPass& laid, const CanvasBatch& batch, const CanvasProgram& program,
                     bool touching) const;
  void draw(std::size_t first, std::size_t count);
  void stamp(std::size_t place);
  /// Returns the milliseconds between the two stamps; negative if unknown. Precondition: the device
  /// has finished all commands. Throws Error if GL fails.
  double stamped_ms() const;

  // begin() uploads the elements and prepares the targets. If the device refuses a request or loses
  // a command, each of these four functions throws Error and leaves the device's data undefined.
  void begin(const Window& window, const Drawables& drawables);
  std::vector<std::uint8_t> run(const Pass& pass);
  std::vector<float> depths(Verb verb, const std::vector<Draw>& wanted);
  std::vector<float> samples(Verb verb, const std::vector<Draw>& wanted);

 private:
  std::uint64_t draw_pass(const Pass& pass, const CanvasPass& laid);
  void draw_queries(const CanvasPass& laid, const CanvasBatch& batch, std::uint32_t& open);
  void draw_all(CanvasProgram& program, Verb verb, const std::vector<Draw>& wanted, GLuint target);
  std::vector<std::uint8_t> read_queries(std::uint32_t slots);
  std::vector<std::uint8_t> read_report(const std::string& stage);
  bool choose_elements(std::span<const std::byte> bytes);
};

}  // namespace farcull
