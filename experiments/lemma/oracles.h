// The two exact oracles against each other: verify/exact (a filter, CGAL's predicates, rational
// distances), with which every run is compared, and the integers (verify/certificate/integer_pair),
// on which certificates rest.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/base/fields.h"

namespace farcull {

/// The question about a pair.
enum class OracleQuestion {
  intersects,  // do the triangles share a point?
  neighbours,  // given a common corner or two: do they share more than the shared part?
  clearance    // are they within a clearance, which is near a distance of two corners?
};
std::string to_string(OracleQuestion question);

struct OracleRow {
  std::string generator;
  OracleQuestion question = OracleQuestion::intersects;
  std::uint64_t pairs = 0;
  std::uint64_t intersecting = 0;   // by CGAL; the answers that are yes
  std::uint64_t disagreements = 0;  // 0, or one of the two is wrong
  double cgal_ns = 0;               // per pair, in one thread
  double integer_ns = 0;
  FARCULL_FIELDS(generator, question, pairs, intersecting, disagreements, cgal_ns, integer_ns)
  std::string example;  // the first pair of a disagreement, a then b, in hexadecimal doubles
};

/// Called with a generator's name before its pairs; may be empty.
using OracleProgress = std::function<void(const std::string&)>;

/// Every generator of pair_generators() with every question, on all cores; neighbours and clearance
/// with a tenth of the pairs, rounded up, since they take longer. The pairs and the answers depend
/// on the seed alone, neither on the cores nor on how many pairs are asked for: more pairs begin
/// with the same.
std::vector<OracleRow> compare_oracles(std::uint64_t pairs_per_generator, std::uint64_t seed,
                                       const OracleProgress& progress = {});

/// For people.
std::string oracles_table(const std::vector<OracleRow>& rows);

/// {"seed", "pairs_per_generator", "disagreements", "generators": [...]}.
nlohmann::ordered_json oracles_json(const std::vector<OracleRow>& rows,
                                    std::uint64_t pairs_per_generator, std::uint64_t seed);

}  // namespace farcull
