// The record of `farcull clash --frames` (docs/clash.md); clash.cpp has the code.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/fields.h"
#include "experiments/record/output.h"

namespace farcull {

/// A pair of parts over frames. Optional values: of the frames where the pair is listed with them.
struct WorstClash {
  std::string name_a, name_b, id;
  ClashVerdict verdict = ClashVerdict::clear;  // the most serious one
  bool ignored = false;
  long frames = 0, first = 0, last = 0;  // how many frames have this verdict; the ends of these
  std::optional<double> depth = {},      // largest lower bound, if depths are asked for
      distance = {};                     // least; 0 if the surfaces meet
  std::optional<long> deepest = {}, nearest = {};  // the first frame with it
  FARCULL_FIELDS(name_a, name_b, id, verdict, ignored, frames, first, last, depth, deepest,
                 distance, nearest)
};

/// Collects the records of `farcull clash --frames`.
class ClashFrames {
 public:
  /// wanted: how many frames there are to be.
  explicit ClashFrames(long wanted) : wanted_(wanted) {}

  struct Report {
    nlohmann::ordered_json head, frame, summary;  // as in FrameReport
    std::string csv;   // clash_csv() after a column `frame`; the first with the header
    std::string text;  // the number of pairs by verdict; the first with a heading
  };
  Report add(const Scene& scene, const ClashRecord& record, const ClashTable& table, long frame);
  /// For people: the pairs, the most serious first.
  std::string text(const ClashTable& table) const;

 private:
  std::vector<WorstClash> worst() const;
  bool is_clean() const { return clean_ && frames_ == wanted_; }

  nlohmann::ordered_json head_;
  std::map<std::pair<std::string, std::string>, WorstClash> pairs_;  // by the names
  long wanted_ = 0, frames_ = 0;
  bool clean_ = true;
};

}  // namespace farcull
