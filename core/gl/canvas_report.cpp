// Compute programs sum what was sent and pack the flags. Each dispatch and each batch of draws
// leaves an echo in the report, which read() compares with the echo computed here.
#include "core/gl/canvas_report.h"

#include <algorithm>
#include <cstring>

#include "core/base/error.h"
#include "core/gl/echo.h"
#include "embedded/canvas_work_comp.h"
#include "embedded/echo_glsl.h"

namespace farcull {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::uint32_t kGroup = 64;            // local_size_x of canvas_work.comp
constexpr std::uint32_t kBatches[2] = {64, 4};  // work items of an invocation, by step
constexpr std::size_t kVec4 = 4 * sizeof(std::uint32_t);

}  // namespace

void throw_lost(const std::string& stage, const std::string& reason) {
  throw Error("GL " + stage, reason, "a command was lost: run again, or with another {device}");
}

void throw_lost_state(const char* what) {
  throw_lost("state", std::string(what) + " is not as it was set");
}

CanvasReport::CanvasReport(const GlContext& context, std::size_t block, std::size_t alignment)
    : context_(context), block_(block) {
  // Each piece begins where a range may begin, and its first 16 bytes stand for a tag.
  const std::size_t step = std::max(alignment, kTagBytes);
  piece_ = std::max(block / step, std::size_t{1}) * step;
  for (std::uint32_t step_number = 0; step_number < 2; ++step_number) {
    programs_[step_number] =
        gl_program(step_number == 0 ? "sum of what was sent" : "pack",
                   {"FAR_STEP " + std::to_string(step_number),
                    "FAR_PROGRAM " + std::to_string(step_number + 1) + "u",
                    "FAR_BATCH " + std::to_string(kBatches[step_number]) + "u"},
                   {{GL_COMPUTE_SHADER, {embedded::echo_glsl, embedded::canvas_work_comp}}});
  }
}

void CanvasReport::start(std::size_t runs, std::size_t dispatches, std::uint32_t flags) {
  echoes_.assign(runs, 0);
  flags_ = 0;
  const std::size_t words = kHead + runs + dispatches + 1 + (flags + 31) / 32;
  store_.reserve(words * sizeof(std::uint32_t), block_);
  // Where this is lost, what the last pass counted is found.
  const std::uint32_t zero[kHead] = {0, 0};
  store_.write(0, zero, sizeof zero);
  finished_ = sum_ = 0;
}

void CanvasReport::dispatch(std::uint32_t step, const GlStore& from, std::size_t offset,
                            std::size_t bytes, std::uint32_t tag, const Numbers& n,
                            std::uint32_t groups) {
  glUseProgram(programs_[step]);
  glProgramUniform1ui(programs_[step], 0, n.count);
  glProgramUniform1ui(programs_[step], 1, n.echo);
  glProgramUniform1ui(programs_[step], 2, n.serial);
  glProgramUniform1ui(programs_[step], 3, n.flags);
  glProgramUniform1ui(programs_[step], 4, n.bits);
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 0, from.name(), static_cast<GLintptr>(offset),
                    static_cast<GLsizeiptr>(bytes));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kReport, store_.name());
  GlEcho echo;
  echo.add({step + 1, n.count, n.echo, n.serial, n.flags, n.bits, tag, store_.tag()});
  echoes_.push_back(echo.sum);
  finished_ += n.count;
  const auto most = static_cast<std::uint32_t>(context_.info().max_compute_groups);
  const std::uint32_t columns = std::min(groups, most);
  glDispatchCompute(columns, (groups + columns - 1) / columns, 1);
  ++dispatches_;
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void CanvasReport::expect(const GlStore& store, std::span<const std::byte> data) {
  for (std::size_t at = 0; at < data.size(); at += piece_) {
    const std::span<const std::byte> part = data.subspan(at, std::min(piece_, data.size() - at));
    std::uint32_t tag = store.tag();
    if (at > 0) std::memcpy(&tag, data.data() + at - kTagBytes, sizeof tag);
    sum_ += gl_sum(part);
    const auto count = static_cast<std::uint32_t>(part.size() / kVec4);
    const std::uint32_t per_group = kGroup * kBatches[0];
    dispatch(0, store, at, kTagBytes + part.size(), tag,
             {.count = count,
              .echo = kHead + static_cast<std::uint32_t>(echoes_.size()),
              .serial = 0,
              .flags = 0,
              .bits = 0},
             (count + per_group - 1) / per_group);
  }
}

void CanvasReport::pack(const GlStore& flags, std::uint32_t serial, std::uint32_t count) {
  const std::uint32_t words = (count + 31) / 32;
  const std::uint32_t per_group = kGroup * kBatches[1];
  const auto echo = kHead + static_cast<std::uint32_t>(echoes_.size());
  flags_ = count;
  dispatch(1, flags, 0, kTagBytes + flags.bytes(), flags.tag(),
           {.count = words, .echo = echo, .serial = serial, .flags = count, .bits = echo + 1},
           (words + per_group - 1) / per_group);
}

std::vector<std::uint8_t> CanvasReport::read(const std::string& stage) {
  gl_wait(stage);
  const std::size_t bits = kHead + echoes_.size();
  // Where nothing is read, no echo is found.
  std::vector<std::uint32_t> words(bits + (flags_ + 31) / 32, kNone);
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

}  // namespace farcull
