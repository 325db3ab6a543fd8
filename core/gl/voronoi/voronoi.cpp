// Draws the bricks of a slice in passes of one program (core/gl/voronoi/voronoi.frag), then
// compares the report of every cell with what the CPU knows: the echoes of all triangles of its
// brick, each exactly once a pass, and that what the depth test kept is the least.
#include "core/gl/voronoi/voronoi.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/gl/base/objects.h"
#include "core/voronoi/voronoi.h"
#include "embedded/voronoi_bounds_glsl.h"
#include "embedded/voronoi_frag.h"
#include "embedded/voronoi_vert.h"

namespace farcull {
namespace {

// As in voronoi.frag.
enum class Pass : std::uint32_t { first, second, compare, least, list };
constexpr std::uint32_t kFirst = 1, kSecond = 2, kWrong = 4, kRoot = 8;
constexpr std::size_t kReportWords = 4;
constexpr GLuint kTriangles = 0, kItems = 1, kReport = 2, kList = 3;  // bindings

constexpr std::size_t kItemsDrawn = std::size_t{1} << 20;  // by one call
constexpr float kCleared = 1;                              // farther than any depth

using Words = std::array<std::uint32_t, 4>;

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

[[noreturn]] void lost(const std::string& reason) {
  throw_lost("Voronoi diagram", reason,
             "a command was lost, or the device computes otherwise than OpenGL promises");
}

// A distance and its object, for each cell.
struct Kept {
  GlTexture depth, object;
  GlFramebuffer target;

  Kept() = default;
  explicit Kept(const std::array<int, 3>& cells)
      : depth(gl_texture(GL_DEPTH_COMPONENT32F, cells[0], cells[1])),
        object(gl_texture(GL_R32UI, cells[0], cells[1])),
        target(gl_make<GlFramebuffer>(glGenFramebuffers)) {
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, object, 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  }
};

class GlVoronoi : public VoronoiDevice {
 public:
  GlVoronoi(const GlContext& context, const GlVoronoiOptions& options)
      : context_(context),
        block_(static_cast<std::size_t>(context.info().max_storage_block) - kTagBytes) {
    GLint blocks = 0;
    glGetIntegerv(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, &blocks);
    if (blocks < 4) {
      throw Error("GL Voronoi diagram",
                  "the device has " + std::to_string(blocks) +
                      " storage blocks for vertex programs, the diagram needs 4",
                  "use another {device}, or {device} cpu");
    }
    on_.program = gl_program(
        "voronoi", {},
        {{GL_VERTEX_SHADER, {kEchoGlsl, embedded::voronoi_vert}},
         {GL_FRAGMENT_SHADER, {kEchoGlsl, embedded::voronoi_bounds_glsl, embedded::voronoi_frag}}});
    on_.vertex_array = gl_make<GlVertexArray>(glGenVertexArrays);
    on_.list.reserve(16 + 16 * std::max<std::size_t>(options.list, 1), block_);
    check_gl("Voronoi diagram");
  }

  ~GlVoronoi() override {
    try {
      const GlCurrent current(context_);
      on_ = {};
    } catch (const Error&) {  // another thread holds the context: the objects end with it
    }
  }

  void start(const std::vector<GridTriangle>& triangles, const VoronoiGrid& grid) override {
    answer([&] {
      cells_ = grid.cells;
      error_ = voronoi_bounds::error(grid.longest());
      // A distance is at most 1.74 N, so a depth is below 1.
      const int exponent = std::ilogb(static_cast<double>(grid.longest())) + 2;
      scale_ = std::ldexp(1.0f, -exponent);
      unscale_ = std::ldexp(1.0f, exponent);
      send_triangles(triangles);
      make_targets();
    });
  }

  std::vector<std::array<std::uint32_t, 2>> nearest_two(int slice,
                                                        const VoronoiBricks& bricks) override {
    std::vector<std::array<std::uint32_t, 2>> out(cell_count(), {kNone, kNone});
    answer([&] {
      begin(slice, bricks);
      draw(Pass::first, 0);
      draw(Pass::second, 0);
      draw(Pass::compare, 0);
      read_report();
      for_cells(slice, bricks, [&](std::uint32_t cell, const Brick& brick) {
        const bool two = brick.two_objects;
        check_cell(cell, brick, two ? kFirst | kSecond : kFirst);
        const std::uint32_t* words = &report_[kReportWords * cell];
        out[cell] = {words[2], two ? words[3] : kNone};
      });
    });
    return out;
  }

  std::vector<VoronoiNear> near(int slice, const VoronoiBricks& bricks, float reach) override {
    std::vector<VoronoiNear> out;
    answer([&] {
      std::uint32_t listed = 0;
      for (bool again = true; again;) {
        begin(slice, bricks);
        draw(Pass::least, reach);
        draw(Pass::list, reach);
        read_report();
        listed = read_listed();
        again = listed > capacity();
        if (again) grow_list(listed);
      }
      out = read_list(listed);
      for_cells(slice, bricks,
                [&](std::uint32_t cell, const Brick& brick) { check_cell(cell, brick, kFirst); });
      std::sort(out.begin(), out.end(), [](const VoronoiNear& a, const VoronoiNear& b) {
        return std::pair(a.cell, a.triangle) < std::pair(b.cell, b.triangle);
      });
    });
    return out;
  }

 private:
  // A brick that meets the slice, as the CPU knows it.
  struct Brick {
    std::uint32_t echo = 0;  // of its items and triangles, once
    std::size_t count = 0;   // of its triangles
    bool two_objects = false;
  };

  // Runs work with the context current. If it throws, every later call throws.
  template <class Work>
  void answer(const Work& work) {
    if (failed_)
      throw Error("GL Voronoi diagram", "the device failed before", "make the device anew");
    failed_ = true;
    const GlCurrent current(context_);
    work();
    failed_ = false;
  }

  std::size_t cell_count() const {
    return static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]);
  }
  std::size_t capacity() const { return (on_.list.bytes() - 16) / 16; }

  void send_triangles(const std::vector<GridTriangle>& triangles) {
    std::vector<Words> words;
    words.reserve(3 * triangles.size());
    triangle_echo_.clear();
    objects_.clear();
    for (const GridTriangle& t : triangles) {
      std::uint32_t place = 16, echo = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& q = t.corners[k];
        words.push_back({bits(q[0]), bits(q[1]), bits(q[2]), k == 0 ? t.object : 0});
        for (std::size_t w = 0; w < (k == 0 ? 4 : 3); ++w)
          echo += gl_mixed(words.back()[w], place + static_cast<std::uint32_t>(w));
        place += 4;
      }
      triangle_echo_.push_back(echo);
      objects_.push_back(t.object);
    }
    const std::size_t bytes = words.size() * sizeof(Words);
    if (bytes > block_) {
      throw Error("GL Voronoi diagram",
                  std::to_string(triangles.size()) +
                      " triangles are more than a storage block of this device holds",
                  "use {device} cpu, or a smaller scene");
    }
    on_.triangles.reserve(bytes, block_);
    on_.triangles.write(0, words.data(), bytes);
    check_gl("Voronoi diagram, triangles");
  }

  void make_targets() {
    const GlInfo& info = context_.info();
    const std::size_t bytes = cell_count() * kReportWords * sizeof(std::uint32_t);
    if (std::max(cells_[0], cells_[1]) > std::min(info.max_texture_size, info.max_viewport) ||
        bytes > block_) {
      throw Error("resolution",
                  "a slice of " + std::to_string(cells_[0]) + " x " + std::to_string(cells_[1]) +
                      " cells has no room on this device",
                  "give fewer cells, or use {device} cpu");
    }
    on_.report.reserve(bytes, block_);
    report_.resize(bytes / sizeof(std::uint32_t));
    on_.first = Kept(cells_);
    const GLenum first = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    on_.second = Kept(cells_);
    const GLenum second = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    on_.bare = gl_make<GlFramebuffer>(glGenFramebuffers);
    glBindFramebuffer(GL_FRAMEBUFFER, on_.bare);
    glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, cells_[0]);
    glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, cells_[1]);
    const GLenum bare = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    check_gl("Voronoi diagram, targets");
    for (const GLenum status : {first, second, bare}) {
      if (status != GL_FRAMEBUFFER_COMPLETE)
        throw Error("GL Voronoi diagram", "the device refuses a target of the slice's size",
                    "give fewer cells, or use another {device}");
    }
  }

  // Lays out what is drawn for a slice, and clears what its passes write.
  void begin(int slice, const VoronoiBricks& bricks) {
    centre_ = static_cast<float>(slice) + 0.5f;
    expected_ = 0;
    drawn_.clear();
    of_brick_.assign(bricks.bricks.size(), {});
    for (std::size_t b = 0; b < bricks.bricks.size(); ++b) {
      const VoronoiBrick& brick = bricks.bricks[b];
      if (slice < brick.from[2] || slice >= brick.to[2]) continue;
      const auto ends = [&](std::size_t k) {
        return static_cast<std::uint32_t>(brick.from[k]) | static_cast<std::uint32_t>(brick.to[k])
                                                               << 16;
      };
      Brick& known = of_brick_[b];
      for (const std::uint32_t id : bricks.of(brick)) {
        const Words item = {id, ends(0), ends(1), 0};
        for (std::uint32_t w = 0; w < 3; ++w) known.echo += gl_mixed(item[w], 12 + w);
        known.echo += triangle_echo_[id];
        known.two_objects |= objects_[id] != objects_[bricks.of(brick).front()];
        drawn_.push_back(item);
      }
      known.count = brick.count;
    }
    passes_ = 0;
    on_.report.clear(report_.size() * sizeof(std::uint32_t));
    on_.list.clear(16);
    for (const Kept* kept : {&on_.first, &on_.second}) clear(*kept);
  }

  void clear(const Kept& kept) const {
    glBindFramebuffer(GL_FRAMEBUFFER, kept.target);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_SCISSOR_TEST);
    const GLuint none[4] = {VoronoiDevice::kNone, 0, 0, 0};
    glClearBufferfv(GL_DEPTH, 0, &kCleared);
    glClearBufferuiv(GL_COLOR, 0, none);
  }

  // Sets the target, the depth test and the textures of a pass.
  void set_state(Pass pass) const {
    const bool keeps = pass == Pass::first || pass == Pass::second || pass == Pass::least;
    glBindFramebuffer(GL_FRAMEBUFFER, !keeps                 ? on_.bare
                                      : pass == Pass::second ? on_.second.target
                                                             : on_.first.target);
    glViewport(0, 0, cells_[0], cells_[1]);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDisable(GL_STENCIL_TEST);
    glDepthRange(0, 1);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    if (keeps) {
      glEnable(GL_DEPTH_TEST);
    } else {
      glDisable(GL_DEPTH_TEST);
    }
    // A texture that is drawn to is not bound for reading.
    const bool reads_first = pass != Pass::first && pass != Pass::least;
    const bool reads_second = pass == Pass::compare;
    const std::array<GLuint, 4> textures = {
        reads_first ? on_.first.depth : GLuint{0}, reads_first ? on_.first.object : GLuint{0},
        reads_second ? on_.second.depth : GLuint{0}, reads_second ? on_.second.object : GLuint{0}};
    for (GLuint unit = 0; unit < 4; ++unit) {
      glActiveTexture(GL_TEXTURE0 + unit);
      glBindTexture(GL_TEXTURE_2D, textures[unit]);
    }
    glBindVertexArray(on_.vertex_array);
  }

  void draw(Pass pass, float reach) {
    set_state(pass);
    glUseProgram(on_.program);
    const auto at = [&](const char* uniform) { return glGetUniformLocation(on_.program, uniform); };
    const std::uint32_t serial = gl_number();
    const auto width = static_cast<std::uint32_t>(cells_[0]);
    const auto room = static_cast<std::uint32_t>(capacity());
    const std::array<float, 4> numbers = {centre_, error_, scale_, reach};
    glUniform1ui(at("u_serial"), serial);
    glUniform1ui(at("u_pass"), static_cast<GLuint>(pass));
    glUniform1ui(at("u_width"), width);
    glUniform1ui(at("u_capacity"), room);
    glUniform2f(at("u_to_ndc"), 2.0f / static_cast<float>(cells_[0]),
                2.0f / static_cast<float>(cells_[1]));
    glUniform4fv(at("u_numbers"), 1, numbers.data());
    glUniform1f(at("u_unscale"), unscale_);
    for (std::size_t from = 0; from < drawn_.size(); from += kItemsDrawn) {
      const std::size_t count = std::min(kItemsDrawn, drawn_.size() - from);
      on_.items.reserve(count * sizeof(Words), block_);
      on_.items.write(0, &drawn_[from], count * sizeof(Words));
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kTriangles, on_.triangles.name());
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kItems, on_.items.name());
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kReport, on_.report.name());
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kList, on_.list.name());
      glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * count));
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    // Each fragment adds this echo, and its triangle's part of the echo of the brick.
    GlEcho echo;
    echo.add({serial, static_cast<std::uint32_t>(pass), width, room});
    echo.add(numbers);
    echo.add({on_.triangles.tag(), on_.items.tag(), on_.report.tag(), on_.list.tag()});
    echo.add_at(15, bits(unscale_));
    expected_ += echo.sum;
    ++passes_;
  }

  void read_report() {
    gl_wait("Voronoi diagram");
    std::fill(report_.begin(), report_.end(), 0xffffffff);  // where nothing is read, no sum fits
    on_.report.read(0, report_.data(), report_.size() * sizeof(std::uint32_t));
    check_gl("Voronoi diagram");
  }

  std::uint32_t read_listed() const {
    std::uint32_t listed = 0xffffffff;
    on_.list.read(0, &listed, sizeof listed);
    check_gl("Voronoi diagram, list");
    return listed;
  }

  void grow_list(std::uint32_t listed) {
    require_voronoi_list(listed);
    const std::size_t bytes = 16 + std::size_t{listed} * 16;
    if (bytes > block_) {
      throw Error("resolution",
                  "a slice has " + std::to_string(listed) +
                      " triangles that may be nearest to its cells, more than a storage block of "
                      "this device holds",
                  "give more cells, or use {device} cpu");
    }
    on_.list.reserve(bytes, block_);
  }

  // Reads the list. Subtracts the echo of each entry from the sum of its cell, so that a missing
  // entry is noticed.
  std::vector<VoronoiNear> read_list(std::uint32_t listed) {
    std::vector<Words> words(listed, Words{0xffffffff, 0, 0, 0});
    on_.list.read(16, words.data(), words.size() * sizeof(Words));
    check_gl("Voronoi diagram, list");
    std::vector<VoronoiNear> out;
    out.reserve(words.size());
    for (const auto& [cell, triangle, lower, upper] : words) {
      if (cell >= cell_count() || triangle >= objects_.size()) lost("a list was not written");
      std::uint32_t& sum = report_[kReportWords * cell];
      sum -= gl_mixed(triangle, 32) + gl_mixed(lower, 33) + gl_mixed(upper, 34);
      out.push_back({cell, triangle, std::bit_cast<float>(lower), std::bit_cast<float>(upper)});
    }
    return out;
  }

  template <class Work>
  void for_cells(int slice, const VoronoiBricks& bricks, const Work& work) const {
    for (std::size_t b = 0; b < bricks.bricks.size(); ++b) {
      const VoronoiBrick& brick = bricks.bricks[b];
      if (slice < brick.from[2] || slice >= brick.to[2] || brick.count == 0) continue;
      for (int y = brick.from[1]; y < brick.to[1]; ++y) {
        for (int x = brick.from[0]; x < brick.to[0]; ++x)
          work(static_cast<std::uint32_t>(x + cells_[0] * y), of_brick_[b]);
      }
    }
  }

  void check_cell(std::uint32_t cell, const Brick& brick, std::uint32_t flags) const {
    const std::uint32_t sum = report_[kReportWords * cell];
    const std::uint32_t found = report_[kReportWords * cell + 1];
    // Sums wrap around, as those of the device do.
    const std::uint32_t expected =
        passes_ * brick.echo + static_cast<std::uint32_t>(brick.count) * expected_;
    if (sum != expected) lost("a triangle was not drawn over every cell, or read wrongly");
    if ((found & kRoot) != 0) lost("a square root is too inexact");
    if ((found & kWrong) != 0) lost("the depth test kept a distance that is not the least");
    if (found != flags) lost("the depth test kept a distance that no triangle has");
  }

  const GlContext& context_;
  std::size_t block_;  // bytes of data in a storage block
  bool failed_ = false;
  std::array<int, 3> cells_{};
  float error_ = 0, scale_ = 1, unscale_ = 1, centre_ = 0;
  struct OnDevice {
    GlProgram program;
    GlVertexArray vertex_array;
    Kept first, second;
    GlFramebuffer bare;
    GlStore triangles, items, report, list;
  } on_;
  std::vector<std::uint32_t> triangle_echo_, objects_;  // of each triangle
  std::vector<Words> drawn_;                            // items of the slice
  std::vector<Brick> of_brick_;
  std::uint32_t expected_ = 0, passes_ = 0;  // of the passes since begin()
  std::vector<std::uint32_t> report_;
};

}  // namespace

std::unique_ptr<VoronoiDevice> gl_voronoi_device(const GlContext& context,
                                                 const GlVoronoiOptions& options) {
  const GlCurrent current(context);  // also while a constructor that throws deletes what it made
  return std::make_unique<GlVoronoi>(context, options);
}

}  // namespace farcull
