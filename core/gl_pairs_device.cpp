#include "core/gl_pairs_device.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "core/error.h"
#include "embedded/interval_glsl.h"
#include "embedded/pair_check_comp.h"
#include "embedded/pair_common_glsl.h"
#include "embedded/pair_conflicts_comp.h"
#include "embedded/pair_cut_comp.h"
#include "embedded/pair_items_comp.h"
#include "embedded/pair_large_comp.h"
#include "embedded/pair_lists_comp.h"
#include "embedded/pair_rows_glsl.h"
#include "embedded/pair_scan_comp.h"
#include "embedded/pair_source_glsl.h"
#include "embedded/pair_spans_comp.h"
#include "embedded/pair_tests_comp.h"

namespace farcull {
namespace {

constexpr GLuint kCounters = 7;           // binding
constexpr GLint kBindings = 11;           // 0 .. 10
constexpr std::uint32_t kGroup = 64;      // local_size_x of pair_common.glsl
constexpr std::uint32_t kScanned = 64;    // numbers of a sum, pair_scan.comp
constexpr std::size_t kDispatches = 240;  // that are counted between two reads
constexpr std::size_t kMirrorBlock = std::size_t{64} << 10;

struct Source {
  const char* name;
  std::uint32_t batch;  // work items of an invocation
  const char* text;
  int step;
  const char* before = "";  // a text that it needs
  std::vector<std::string> defines = {};
};
const std::array<Source, kPairPrograms>& sources() {
  using namespace embedded;
  static const std::array<Source, kPairPrograms> all = {{
      {"pair items", 8, pair_items_comp, 0, pair_source_glsl},
      {"pair records", 4, pair_items_comp, 1, pair_source_glsl},
      {"pair spans", 16, pair_spans_comp, 0},
      {"pair lists, marking", 8, pair_lists_comp, 0},
      {"pair lists, counting", 8, pair_lists_comp, 1},
      {"pair lists, filling", 4, pair_lists_comp, 2},
      {"pair lists by rows, marking", 2, pair_lists_comp, 0, pair_rows_glsl, {"FAR_ROWS"}},
      {"pair lists by rows, counting", 2, pair_lists_comp, 1, pair_rows_glsl, {"FAR_ROWS"}},
      {"pair lists by rows, filling", 2, pair_lists_comp, 2, pair_rows_glsl, {"FAR_ROWS"}},
      {"pair conflicts", 16, pair_conflicts_comp, 0},
      {"pair scan, sums", 4, pair_scan_comp, 0},
      {"pair scan, sums of sums", 4, pair_scan_comp, 1},
      {"pair scan, top", 1, pair_scan_comp, 2},
      {"pair scan, down to sums", 4, pair_scan_comp, 3},
      {"pair scan, down", 4, pair_scan_comp, 4},
      {"pair check of crowds", 32, pair_check_comp, 0},
      {"pair check of lists", 64, pair_check_comp, 1},
      {"pair tests", 4, pair_tests_comp, 0, "", {"FAR_SUM FAR_TESTS"}},
      {"pair tests left", 4, pair_tests_comp, 1, "", {"FAR_SUM FAR_TESTS"}},
      {"pair tests of uncut cells",
       4,
       pair_tests_comp,
       0,
       "",
       {"FAR_SUM FAR_TESTS", "FAR_SOME_CROWDED"}},
      {"pair tests left of uncut cells",
       4,
       pair_tests_comp,
       1,
       "",
       {"FAR_SUM FAR_TESTS", "FAR_SOME_CROWDED"}},
      {"pair subdivision, parents", 16, pair_cut_comp, 0},
      {"pair subdivision, counting", 1, pair_cut_comp, 1, pair_rows_glsl},
      {"pair subdivision, deciding", 1, pair_cut_comp, 2},
      {"pair subdivision, filling", 1, pair_cut_comp, 3, pair_rows_glsl},
      {"pair large ones", 16, pair_large_comp, 0},
      {"pair comparison with large ones", 1, pair_large_comp, 1, pair_source_glsl},
  }};
  return all;
}

std::vector<std::string> defines_of(const Source& source) {
  const auto number = [](const char* name, std::uint32_t value) {
    return std::string(name) + " " + std::to_string(value) + "u";
  };
  std::vector<std::string> out = source.defines;
  for (const std::string& define : {
           number("FAR_WHOLES", kTotalWholes),
           number("FAR_ITEMS", kTotalItems),
           number("FAR_LARGE", kTotalLarge),
           number("FAR_ROWS_TOTAL", kTotalRows),
           number("FAR_OVERFLOW", kTotalOverflow),
           number("FAR_CROWDED_CELLS", kTotalCrowded),
           number("FAR_MISMATCHES", kTotalMismatches),
           number("FAR_LISTED", kTotalListed),
           number("FAR_LISTED_ROWS", kTotalListedRows),
           number("FAR_PARENTS", kTotalParents),
           number("FAR_PAIRS", kTotalPairs),
           number("FAR_TESTS", kTotalTests),
           number("FAR_MORE", kTotalMore),
           number("FAR_CROWDED", kCrowded),
           number("FAR_SUBDIVISION", kSubdivision),
           number("FAR_SPAN", kSpan),
           number("FAR_UNIT", kUnit),
           number("FAR_LARGE_BATCH", kLargeBatch),
           number("FAR_BATCH", source.batch),
           "FAR_STEP " + std::to_string(source.step),
           "FAR_WHOLE_PIXELS " + std::to_string(kWholePixels),
       })
    out.push_back(define);
  return out;
}

GLint limit_of(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

}  // namespace

bool PairStore::reserve(std::size_t wanted, std::size_t most, std::size_t keep) {
  wanted = std::max<std::size_t>(wanted, 16);
  if (name != 0 && wanted <= bytes) return false;
  GlBuffer grown = gl_make<GlBuffer>(glGenBuffers);
  const std::size_t size = (std::max(wanted, std::min(most, bytes + bytes / 2)) + 15) / 16 * 16;
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, grown);
  glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(size), nullptr, GL_DYNAMIC_COPY);
  if (keep > 0) {
    glBindBuffer(GL_COPY_READ_BUFFER, name);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_SHADER_STORAGE_BUFFER, 0, 0,
                        static_cast<GLsizeiptr>(keep));
  }
  name = std::move(grown);
  bytes = size;
  return true;
}

std::size_t PairMirror::update(std::span<const std::byte> data) {
  const bool lost = store_.reserve(data.size(), data.size());
  const std::size_t known = lost ? 0 : std::min(sent_.size(), data.size());
  sent_.resize(data.size());
  std::size_t sent = 0;
  const auto send = [&](std::size_t begin, std::size_t end) {
    if (begin == end) return;
    std::memcpy(sent_.data() + begin, data.data() + begin, end - begin);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(begin),
                    static_cast<GLsizeiptr>(end - begin), data.data() + begin);
    sent += end - begin;
  };
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, store_.name);
  std::size_t from = 0;  // the first byte of the blocks that changed up to here
  for (std::size_t at = 0; at < known; at += kMirrorBlock) {
    const std::size_t end = std::min(at + kMirrorBlock, known);
    if (std::memcmp(sent_.data() + at, data.data() + at, end - at) != 0) continue;
    send(from, at);
    from = end;
  }
  send(from, data.size());
  return sent;
}

PairDevice::PairDevice(const GlContext& context, const GlPairOptions& options)
    : context_(context), block_(static_cast<std::size_t>(context.info().max_storage_block)) {
  if (options.storage_limit > 0) {
    block_ = std::min(block_, static_cast<std::size_t>(options.storage_limit));
  }
  const GLint bindings = std::min(limit_of(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS),
                                  limit_of(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS));
  if (bindings < kBindings) {
    throw Error("GL pairs",
                "the device has " + std::to_string(bindings) +
                    " storage bindings, FAR pairs needs " + std::to_string(kBindings),
                "use --device cpu or another device");
  }
  // Those that every scene needs.
  for (std::size_t p = 0; p <= static_cast<std::size_t>(PairProgram::tests); ++p) program(p);
  counters_ = gl_make<GlBuffer>(glGenBuffers);
  words_.assign(kTotals + kDispatches, 0);
  start(true);
  check_gl("pairs");
}

GLuint PairDevice::program(std::size_t which) {
  GlProgram& out = programs_[which];
  if (out == 0) {
    const Source& source = sources()[which];
    out = gl_program(
        source.name, defines_of(source),
        {{GL_COMPUTE_SHADER,
          {embedded::interval_glsl, embedded::pair_common_glsl, source.before, source.text}}});
  }
  return out;
}

void PairDevice::start(bool fresh) {
  if (fresh) dispatches = 0;
  expected_.clear();
  std::fill(words_.begin(), words_.end(), 0);
  gl_fill(counters_, words_.data(), words_.size() * sizeof(std::uint32_t));
}

void PairDevice::reset(PairTotal first, std::uint32_t words) {
  const std::array<std::uint32_t, kTotals> zero{};
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, counters_);
  glBufferSubData(GL_SHADER_STORAGE_BUFFER, first * sizeof(std::uint32_t),
                  static_cast<GLsizeiptr>(words * sizeof(std::uint32_t)), zero.data());
}

void PairDevice::run(PairProgram which, std::uint64_t count, const PairUniforms& u,
                     const std::vector<PairBinding>& bindings) {
  if (count == 0) return;
  if (count >> 31 != 0) throw std::logic_error("PairDevice::run: too much work for one dispatch");
  if (expected_.size() == kDispatches) check_finished("pairs");
  const auto index = static_cast<std::size_t>(which);
  const bool at_fault = fault != PairFault::none && dispatches == fault_at;
  const auto n = static_cast<std::uint32_t>(count);
  glUseProgram(program(index));
  glUniform1ui(0, n);
  glUniform1ui(1, kTotals + static_cast<std::uint32_t>(expected_.size()));
  glUniform1ui(2, at_fault && fault == PairFault::unfinished_item ? n / 2 : n);
  glUniform4fv(3, 1, u.widen.data());
  glUniform4iv(4, 1, u.tile.data());
  glUniform2iv(5, 1, u.window.data());
  glUniform2fv(6, 1, u.depth.data());
  glUniform4uiv(7, 1, u.bins.data());
  glUniform1ui(8, u.cells);
  glUniform1ui(9, u.masked);
  glUniform1ui(10, u.capacity);
  glUniform1ui(11, u.items);
  glUniform4uiv(12, 1, u.extra.data());
  glUniform4fv(13, 1, u.numbers.data());
  for (const PairBinding& b : bindings) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, b.index, b.buffer);
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kCounters, counters_);
  const std::uint32_t per_group = kGroup * sources()[index].batch;
  const std::uint32_t groups = (n + per_group - 1) / per_group;
  const std::uint32_t most = static_cast<std::uint32_t>(context_.info().max_compute_groups);
  const std::uint32_t columns = std::min(groups, most);
  const std::uint32_t rows = (groups + columns - 1) / columns;
  if (!(at_fault && fault == PairFault::lost_dispatch)) {
    glDispatchCompute(at_fault && fault == PairFault::oversized_dispatch ? most + 1 : columns, rows,
                      1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  }
  expected_.push_back(n);
  ++dispatches;
}

void PairDevice::scan(GLuint numbers, GLuint before, std::size_t count) {
  // Where each level of sums begins, and how long it is.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> levels;
  std::uint32_t at = 0;
  for (std::size_t n = count;;) {
    n = (n + kScanned - 1) / kScanned;
    levels.emplace_back(at, static_cast<std::uint32_t>(n));
    at += static_cast<std::uint32_t>(n);
    if (n <= kScanned) break;
  }
  sums_.reserve(at * sizeof(std::uint32_t), block_);
  const auto step = [&](PairProgram program, std::uint32_t from, std::size_t length,
                        std::uint32_t to) {
    PairUniforms u;
    u.extra = {from, static_cast<std::uint32_t>(length), to, kTotalScanned};
    run(program, (length + kScanned - 1) / kScanned, u,
        {{0, numbers}, {1, before}, {2, sums_.name}});
  };
  step(PairProgram::sum_numbers, 0, count, levels[0].first);
  for (std::size_t l = 1; l < levels.size(); ++l) {
    step(PairProgram::sum_sums, levels[l - 1].first, levels[l - 1].second, levels[l].first);
  }
  step(PairProgram::scan_top, levels.back().first, levels.back().second, 0);
  for (std::size_t l = levels.size(); l-- > 1;) {
    step(PairProgram::scan_sums, levels[l - 1].first, levels[l - 1].second, levels[l].first);
  }
  step(PairProgram::scan_numbers, 0, count, levels[0].first);
}

void PairDevice::check_finished(const std::string& stage) {
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, counters_);
  const std::size_t words = kTotals + expected_.size();
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                     static_cast<GLsizeiptr>(words * sizeof(std::uint32_t)), words_.data());
  check_gl(stage);
  for (std::size_t d = 0; d < expected_.size(); ++d) {
    if (words_[kTotals + d] == expected_[d]) continue;
    throw Error("GL " + stage,
                std::to_string(words_[kTotals + d]) + " of " + std::to_string(expected_[d]) +
                    " work items finished",
                "a compute invocation was lost: run again, or with another --device");
  }
  const std::vector<std::uint32_t> zero(expected_.size(), 0);
  glBufferSubData(GL_SHADER_STORAGE_BUFFER, kTotals * sizeof(std::uint32_t),
                  static_cast<GLsizeiptr>(zero.size() * sizeof(std::uint32_t)), zero.data());
  expected_.clear();
}

std::array<std::uint32_t, kTotals> PairDevice::read(const std::string& stage) {
  check_finished(stage);
  std::array<std::uint32_t, kTotals> totals;
  std::copy_n(words_.begin(), kTotals, totals.begin());
  return totals;
}

}  // namespace farcull
