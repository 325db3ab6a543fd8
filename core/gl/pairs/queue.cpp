// Runs the programs of FAR pairs. Each dispatch counts its finished work items and leaves an echo
// of the numbers and buffers that it read; both are compared when totals are read.
#include "core/gl/pairs/finder.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "core/base/error.h"
#include "embedded/interval_glsl.h"
#include "embedded/pair_arrays_comp.h"
#include "embedded/pair_common_glsl.h"
#include "embedded/pair_cut_comp.h"
#include "embedded/pair_items_comp.h"
#include "embedded/pair_large_comp.h"
#include "embedded/pair_lists_comp.h"
#include "embedded/pair_main_glsl.h"
#include "embedded/pair_rows_glsl.h"
#include "embedded/pair_source_glsl.h"
#include "embedded/pair_tests_comp.h"

namespace farcull {
namespace {

constexpr GLuint kCounters = 7;           // binding
constexpr GLint kBindings = 11;           // 0 .. 10
constexpr std::uint32_t kGroup = 64;      // local_size_x of pair_common.glsl
constexpr std::uint32_t kScanned = 64;    // numbers of a sum, pair_arrays.comp
constexpr std::size_t kDispatches = 240;  // the most that are counted between two reads

// Defines of single programs.
constexpr const char* kRows = "#define FAR_ROWS\n";
constexpr const char* kSum = "#define FAR_SUM FAR_SENT\n";
constexpr const char* kTests = "#define FAR_SUM FAR_TESTS\n";
constexpr const char* kUncut = "#define FAR_SUM FAR_TESTS\n#define FAR_SOME_CROWDED\n";
constexpr const char* kSettled = "#define FAR_SUM FAR_TESTS\n#define FAR_SETTLED\n";
constexpr const char* kUncutSettled =
    "#define FAR_SUM FAR_TESTS\n#define FAR_SOME_CROWDED\n#define FAR_SETTLED\n";

struct Source {
  const char* name;
  std::uint32_t batch;  // work items of an invocation
  const char* text;
  int step;
  const char* before = "";  // a text that stands before it
  const char* defines = "";
};
using namespace embedded;
// In the order of PairProgram.
constexpr std::array<Source, kPairPrograms> kSources = {{
    {"pair items", 8, pair_items_comp, 0, pair_source_glsl},
    {"pair records", 4, pair_items_comp, 1, pair_source_glsl},
    {"pair lists, marking", 8, pair_lists_comp, 0},
    {"pair lists, counting", 8, pair_lists_comp, 1},
    {"pair lists, filling", 4, pair_lists_comp, 2},
    {"pair lists by rows, marking", 2, pair_lists_comp, 0, pair_rows_glsl, kRows},
    {"pair lists by rows, counting", 2, pair_lists_comp, 1, pair_rows_glsl, kRows},
    {"pair lists by rows, filling", 2, pair_lists_comp, 2, pair_rows_glsl, kRows},
    {"pair conflicts", 16, pair_arrays_comp, 5},
    {"pair scan, sums", 1, pair_arrays_comp, 3},
    {"pair scan, down", 1, pair_arrays_comp, 4},
    {"pair check of crowds", 32, pair_arrays_comp, 6},
    {"pair sum of what was sent", 64, pair_arrays_comp, 0, "", kSum},
    {"pair zeros", 64, pair_arrays_comp, 2},
    {"pair check of lists, and crowded cells", 16, pair_cut_comp, 0, pair_rows_glsl},
    {"pair tests", 4, pair_tests_comp, 0, "", kTests},
    {"pair tests left", 4, pair_tests_comp, 1, "", kTests},
    {"pair tests of uncut cells", 4, pair_tests_comp, 0, "", kUncut},
    {"pair tests left of uncut cells", 4, pair_tests_comp, 1, "", kUncut},
    {"pair subdivision, counting", 1, pair_cut_comp, 1, pair_rows_glsl},
    {"pair subdivision, deciding", 1, pair_cut_comp, 2},
    {"pair subdivision, filling", 1, pair_cut_comp, 3, pair_rows_glsl},
    {"pair large ones", 16, pair_large_comp, 0},
    {"pair comparison with large ones", 1, pair_large_comp, 1, pair_source_glsl},
    {"pair copy", 64, pair_arrays_comp, 1},
    {"pair tests, settled", 4, pair_tests_comp, 0, "", kSettled},
    {"pair tests left, settled", 4, pair_tests_comp, 1, "", kSettled},
    {"pair tests of uncut cells, settled", 4, pair_tests_comp, 0, "", kUncutSettled},
    {"pair tests left of uncut cells, settled", 4, pair_tests_comp, 1, "", kUncutSettled},
}};

std::vector<std::string> defines_of(const Source& source, std::uint32_t index) {
  std::vector<std::string> out = {"FAR_STEP " + std::to_string(source.step),
                                  "FAR_WHOLE_PIXELS " + std::to_string(kWholePixels)};
  const std::pair<const char*, std::uint32_t> numbers[] = {
      {"FAR_WHOLES", kTotalWholes},
      {"FAR_ITEMS", kTotalItems},
      {"FAR_LARGE", kTotalLarge},
      {"FAR_ROWS_TOTAL", kTotalRows},
      {"FAR_OVERFLOW", kTotalOverflow},
      {"FAR_CROWDED_CELLS", kTotalCrowded},
      {"FAR_MISMATCHES", kTotalMismatches},
      {"FAR_LISTED", kTotalListed},
      {"FAR_LISTED_ROWS", kTotalListedRows},
      {"FAR_PARENTS", kTotalParents},
      {"FAR_ENTRIES", kTotalEntries},
      {"FAR_LARGE_FOUND", kTotalLargeFound},
      {"FAR_PAIRS", kTotalPairs},
      {"FAR_TESTS", kTotalTests},
      {"FAR_MORE", kTotalMore},
      {"FAR_SENT", kTotalSent},
      {"FAR_PROGRAM", index + 1},
      {"FAR_CROWDED", kCrowded},
      {"FAR_SUBDIVISION", kSubdivision},
      {"FAR_SPAN", kSpan},
      {"FAR_UNIT", kUnit},
      {"FAR_LARGE_BATCH", kLargeBatch},
      {"FAR_BATCH", source.batch},
  };
  for (const auto& [name, value] : numbers)
    out.push_back(std::string(name) + " " + std::to_string(value) + "u");
  return out;
}

constexpr std::array kSerials = {kSerialStart, kSerialItems, kSerialPairs};

// core/gl/pairs/pair_main.glsl adds the tags of buffers to the echo from this place on.
constexpr std::uint32_t kTagPlace = 37;

// The uniforms, as core/gl/pairs/pair_common.glsl has them.
std::array<std::uint32_t, kTagPlace - 1> words_of(const PairUniforms& u, const PairWork& work,
                                                  std::uint32_t count, std::uint32_t finished) {
  std::array<std::uint32_t, kTagPlace - 1> out{};
  std::size_t at = 0;
  const auto add = [&](const auto& numbers) {
    for (const auto number : numbers) out.at(at++) = std::bit_cast<std::uint32_t>(number);
  };
  using Four = std::array<std::uint32_t, 4>;
  add(Four{count, finished, u.cells, u.masked});
  add(u.widen);
  add(u.tile);
  add(u.window);
  add(std::array{u.steps_per_px});
  add(std::array{u.first_step});
  add(u.bins);
  add(Four{u.capacity, u.items, static_cast<std::uint32_t>(u.slices_per_step), 0});
  add(u.extra);
  add(u.numbers);
  add(Four{work.total, work.per, work.times, 0});
  return out;
}

GLint limit_of(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

}  // namespace

PairQueue::PairQueue(const GlContext& context, const GlPairOptions& options)
    : context_(context), block_(static_cast<std::size_t>(context.info().max_storage_block)) {
  if (options.storage_limit > 0)
    block_ = std::min(block_, static_cast<std::size_t>(options.storage_limit));
  block_ -= kTagBytes;
  const GLint bindings = std::min(limit_of(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS),
                                  limit_of(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS));
  if (bindings < kBindings) {
    throw Error("GL pairs",
                "the device has " + std::to_string(bindings) +
                    " storage bindings, FAR pairs needs " + std::to_string(kBindings),
                "use {device} cpu or another device");
  }
  // Compiles the programs that every scene needs.
  for (std::size_t p = 0; p <= static_cast<std::size_t>(PairProgram::tests); ++p) program(p);
  words_.assign(kTotals + 2 * kDispatches, 0);
  counters_.reserve(words_.size() * sizeof(std::uint32_t), block_);
  start(true);
  check_gl("pairs");
}

const PairQueue::Program& PairQueue::program(std::size_t which) {
  Program& out = programs_[which];
  if (out.name != 0) return out;
  const Source& source = kSources[which];
  GlProgram made = gl_program(source.name, defines_of(source, static_cast<std::uint32_t>(which)),
                              {{GL_COMPUTE_SHADER,
                                {source.defines, interval_glsl, pair_common_glsl, kEchoGlsl,
                                 source.before, source.text, pair_main_glsl}}});
  GLint blocks = 0;
  glGetProgramInterfaceiv(made, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &blocks);
  std::uint32_t bindings = 0;
  for (GLint b = 0; b < blocks; ++b) {
    const GLenum wanted = GL_BUFFER_BINDING;
    GLint binding = 0;
    glGetProgramResourceiv(made, GL_SHADER_STORAGE_BLOCK, static_cast<GLuint>(b), 1, &wanted, 1,
                           nullptr, &binding);
    bindings |= 1u << binding;
  }
  out.bindings = bindings;
  std::swap(out.name, made);
  return out;
}

void PairQueue::start(bool fresh) {
  if (fresh) dispatches_ = readbacks_ = 0;
  clock_.forget();
  expected_.clear();
  needed_.clear();
  overflow_ = false;
  expected_sum_ = 0;
  std::fill(words_.begin(), words_.end(), 0);
  for (const PairTotal place : kSerials) words_[place] = serials_[place] = ++serial_;
  counters_.write(0, words_.data(), words_.size() * sizeof(std::uint32_t));
}

void PairQueue::reset(PairTotals totals) {
  PairTotalWords words{};
  words[0] = serials_[totals.serial] = ++serial_;
  if (totals.serial == kSerialPairs) overflow_ = false;
  counters_.write(totals.serial * sizeof(std::uint32_t), words.data(),
                  totals.words * sizeof(std::uint32_t));
}

void PairQueue::run(PairProgram which, const PairWork& work, const PairUniforms& u,
                    const std::vector<PairBinding>& bindings) {
  const std::uint64_t count = work.items(work.most);
  if (count >> 31 != 0) throw std::logic_error("PairQueue::run: too much work for one dispatch");
  if (expected_.size() == kDispatches) check_finished("pairs");
  if (work.total != kSerialStart) needed_.push_back(work);
  if (count == 0) return;
  const auto index = static_cast<std::size_t>(which);
  const auto n = static_cast<std::uint32_t>(work.most);
  const Program& used = program(index);
  const auto finished = kTotals + 2 * static_cast<std::uint32_t>(expected_.size());
  glUseProgram(used.name);
  const auto all = words_of(u, work, n, finished);
  glUniform4uiv(0, static_cast<GLsizei>(all.size() / 4), all.data());
  GlEcho echo;
  echo.add({static_cast<std::uint32_t>(index) + 1});
  echo.add(all);
  const auto bind = [&](GLuint at, const GlStore& store) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, at, store.name());
    if ((used.bindings >> at & 1) != 0) echo.add_at(kTagPlace + at, store.tag());
  };
  for (const PairBinding& b : bindings) bind(b.index, *b.store);
  bind(kCounters, counters_);
  const std::uint32_t per_group = kGroup * kSources[index].batch;
  const auto groups = static_cast<std::uint32_t>((count + per_group - 1) / per_group);
  gl_dispatch(groups, context_.info().max_compute_groups);
  expected_.push_back({work, echo.sum});
  ++dispatches_;
}

void PairQueue::expect(const std::array<Sent, 5>& sent) {
  PairUniforms u;
  std::vector<PairBinding> bindings;
  std::size_t words = 0;
  for (std::size_t k = 0; k < sent.size(); ++k) {
    expected_sum_ += gl_sum(sent[k].data);
    words += sent[k].data.size() / sizeof(std::uint32_t);
    if (k < u.extra.size()) u.extra[k] = static_cast<std::uint32_t>(words);
    bindings.push_back({static_cast<GLuint>(k), sent[k].store});
  }
  run(PairProgram::sum, words, u, bindings);
}

void PairQueue::grow(GlStore& store, std::size_t wanted, std::size_t keep) {
  if (wanted <= store.bytes()) return;
  GlStore grown;
  grown.reserve(wanted, block_);
  if (keep > 0)
    run(PairProgram::copy, keep / sizeof(std::uint32_t), {}, {{0, &store}, {1, &grown}});
  std::swap(store, grown);
}

void PairQueue::scan(const GlStore& numbers, const GlStore& before, std::size_t count,
                     PairTotal counted, PairTotal sum) {
  const auto sums_of = [](std::size_t n) { return (n + kScanned - 1) / kScanned; };
  const std::size_t first = sums_of(count), second = sums_of(first), third = sums_of(second);
  sums_.reserve((first + second + third) * sizeof(std::uint32_t), block_);
  zero(sums_, second + third);
  PairUniforms u;
  u.extra = {sum, static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(second),
             static_cast<std::uint32_t>(second + third)};
  const PairWork work =
      counted == kSerialStart ? PairWork(first) : PairWork(count, counted, kScanned);
  for (const PairProgram step : {PairProgram::sum_numbers, PairProgram::scan_numbers})
    run(step, work, u, {{0, &numbers}, {1, &before}, {2, &sums_}});
}

void PairQueue::check_finished(const std::string& stage) {
  gl_wait(stage);
  ++readbacks_;
  const std::size_t words = kTotals + 2 * expected_.size();
  // If nothing is read, no serial number is found.
  std::fill(words_.begin(), words_.end(), 0xffffffff);
  counters_.read(0, words_.data(), words * sizeof(std::uint32_t));
  check_gl(stage);
  for (const PairTotal place : kSerials) {
    if (words_[place] != serials_[place])
      throw_lost(stage, "counts were not set to zero, or not read");
  }
  overflow_ |= words_[kTotalOverflow] != 0 ||
               std::any_of(needed_.begin(), needed_.end(),
                           [&](const PairWork& work) { return words_[work.total] > work.most; });
  needed_.clear();
  for (std::size_t d = 0; d < expected_.size(); ++d) {
    const PairWork& work = expected_[d].work;
    const bool counted = work.total != kSerialStart;
    const std::uint32_t finished = words_[kTotals + 2 * d];
    const std::uint64_t meant = work.items(counted ? words_[work.total] : work.most);
    // After an overflow no work is done, and the results are not used.
    if (finished != meant && !(counted && overflow_)) {
      throw_lost(stage, std::to_string(finished) + " of " + std::to_string(meant) +
                            " work items finished");
    }
    if (words_[kTotals + 2 * d + 1] != expected_[d].echo)
      throw_lost(stage, "a program ran with other numbers or other buffers than were meant");
  }
  const std::vector<std::uint32_t> zero(2 * expected_.size(), 0);
  counters_.write(kTotals * sizeof(std::uint32_t), zero.data(),
                  zero.size() * sizeof(std::uint32_t));
  expected_.clear();
}

PairTotalWords PairQueue::read(const std::string& stage) {
  check_finished(stage);
  PairTotalWords totals;
  std::copy_n(words_.begin(), kTotals, totals.begin());
  totals[kTotalOverflow] = overflow_;
  if (totals[kTotalSent] != expected_sum_)
    throw_lost(stage, "the device holds other data than were sent");
  return totals;
}

}  // namespace farcull
