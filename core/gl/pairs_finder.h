// FAR pairs of one window on a GL device: parts of the window that fit the memory, one after the
// other. For core/gl/pairs.cpp alone.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/gl/pairs_emission.h"
#include "core/gl/pairs_items.h"
#include "core/gl/pairs_lists.h"
#include "core/gl/pairs_run.h"

namespace farcull {

/// By what a window is known again: its pixels and where some objects are in it.
struct SeenWindow {
  std::vector<float> places;  // px
  float side = 0;             // px; the larger one
};

class PairFinder {
 public:
  PairFinder(const GlContext& context, const GlPairOptions& options)
      : run_(context, options), lists_(run_, items_), emission_(run_, items_) {}

  std::vector<TrianglePair> find(const PairTask& task, PairCounts& counts);
  std::size_t dispatches() const { return run_.device.dispatches(); }
  std::size_t sent_bytes() const { return run_.scene.sent_bytes(); }
  std::size_t portions() const { return emission_.portions(); }
  std::size_t reported_pairs() const { return emission_.reported(); }

 private:
  struct Seen {
    PairForecast counts;
    SeenWindow window;
  };
  void split(const PairPart& part);
  bool find_in(const PairPart& part);
  bool find_at_once(const PairPart& part, const PairForecast& forecast);
  void begin_part(const PairPart& part);
  void end_part(const PairTotalWords& totals);
  std::optional<PairForecast> forecast() const;
  bool seen_like(const SeenWindow& window) const;

  PairRun run_;
  PairItems items_{run_};
  PairLists lists_;
  PairEmission emission_;
  bool fresh_ = true;                 // nothing was told to the device but what was sent
  std::optional<PairForecast> seen_;  // of the last part, where all of it is known
  std::deque<Seen> last_ones_;        // the last windows
};

}  // namespace farcull
