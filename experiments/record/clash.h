// The record of `farcull clash` as a table, CSV and JSON (docs/clash.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/method/clash.h"

namespace farcull {

struct ClashTable {
  std::vector<ClashVerdict> failing = {};  // also lists pairs that touch if touch is here
  std::string unit = {};                   // of the lengths, such as "mm"; empty: not said
};

/// For people: the summary, then a row for each pair. Pairs that touch get rows only if asked for.
/// Lengths have six digits, since the coordinates of a mesh file may be rounded to floats.
std::string clash_text(const Scene& scene, const ClashRecord& record, const ClashTable& table);

/// Details of a row besides its verdict, such as the kinds of contact.
std::string clash_words(const Scene& scene, const ClashRow& row);

/// Whether no pair is a clash, contained, unknown or one of `failing`, and every pair that was
/// asked for was examined.
bool is_clean(const ClashRecord& record, const std::vector<ClashVerdict>& failing = {});

/// A row for each pair that is not clear; numbers with all digits.
std::string clash_csv(const Scene& scene, const ClashRecord& record);

nlohmann::ordered_json clash_json(const Scene& scene, const ClashRecord& record,
                                  const std::string& unit,
                                  const std::vector<ClashVerdict>& failing = {});

}  // namespace farcull
