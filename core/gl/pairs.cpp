// GlPairs owns a PairFinder and forgets it after any failure, so that nothing that lies on the
// device is believed then.
#include "core/gl/pairs.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "core/base/error.h"
#include "core/gl/pairs_finder.h"
#include "core/pairs/backend.h"

namespace farcull {
namespace {

// Whether an eighth of the triangles says that all of them take several times the work that may be
// done. A device tells how much it did when it has done it, so this is asked before. Pixels grow
// with the triangles, and comparisons with their square.
bool takes_too_much(const PairTask& task) {
  constexpr std::size_t kOneOf = 8, kTimes = 4;
  if (task.most_tests == UINT64_MAX || std::max(task.width, task.height) > kMostCpuPixels)
    return false;
  std::vector<std::uint32_t> some;
  for (std::size_t k = 0; k < task.active.size(); k += kOneOf) some.push_back(task.active[k]);
  PairTask part = task;
  part.active = some;
  part.most_tests = task.most_tests / kOneOf;
  PairCounts counts;
  cpu_sample_backend(task.active.size())->raw_pairs(part, counts);
  return counts.given_up || counts.tests > kTimes * task.most_tests / (kOneOf * kOneOf);
}

}  // namespace

GlPairs::GlPairs(const GlContext& context, const GlPairOptions& options)
    : context_(context), options_(options) {
  const GlCurrent current(context);
  finder_ = std::make_unique<PairFinder>(context, options);
}

GlPairs::~GlPairs() { forget(); }

// Everything on the device is deleted, or where the context cannot be had, left to go with it.
void GlPairs::forget() {
  try {
    const GlCurrent current(context_);
    finder_.reset();
    // Errors of the deleted objects concern nobody. A lost context may report errors without end.
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
    }
  } catch (const Error&) {
    static_cast<void>(finder_.release());
  }
}

std::string GlPairs::name() const { return context_.info().renderer; }

std::vector<TrianglePair> GlPairs::raw_pairs(const PairTask& task, PairCounts& counts) {
  if (task.width < 1 || task.height < 1 || task.width > 65536 || task.height > 65536) {
    throw std::logic_error("GlPairs: a window of no pixels, or of more than 65536 along a side");
  }
  if (takes_too_much(task)) {
    counts = {};
    counts.given_up = true;
    return {};
  }
  const GlCurrent current(context_);
  try {
    if (!finder_) finder_ = std::make_unique<PairFinder>(context_, options_);
    return finder_->find(task, counts);
  } catch (...) {
    forget();
    throw;
  }
}

std::size_t GlPairs::dispatches() const { return finder_ ? finder_->dispatches() : 0; }
std::size_t GlPairs::uploaded_bytes() const { return finder_ ? finder_->sent_bytes() : 0; }
std::size_t GlPairs::portions() const { return finder_ ? finder_->portions() : 0; }
std::size_t GlPairs::reported_pairs() const { return finder_ ? finder_->reported_pairs() : 0; }

std::unique_ptr<PairBackend> gl_pair_backend(const GlContext& context, std::size_t memory) {
  return std::make_unique<GlPairs>(context, GlPairOptions{.memory = memory});
}

}  // namespace farcull
