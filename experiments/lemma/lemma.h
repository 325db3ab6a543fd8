// Tests lemmas 1 and 2 (docs/reliability.md) by experiment: draws fattened triangles that are hard
// cases on a canvas, and checks the samples of their points' pixels in exact arithmetic.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/canvas/canvas.h"
#include "core/canvas/fatten.h"
#include "core/cull/cull.h"

namespace farcull {

/// A row per generator. A point counts once for each pixel that contains it.
struct LemmaRow {
  std::string generator;
  std::uint64_t points = 0;
  std::uint64_t no_sample = 0;     // the pixel got no sample
  std::uint64_t not_bounding = 0;  // its samples do not bound the point's depth
  std::uint64_t rounded = 0;       // not counted above: off by no more than depth_rounding(); only
                                   // if samples are depths of the buffer
  double largest_px = 0;           // the most by which a depth is outside its samples; 0: none
  double largest_steps = 0;        // the same in steps of the depth buffer
  std::uint64_t violations() const { return no_sample + not_bounding; }
};

/// Names of the generators, in the order of the rows.
std::vector<std::string> lemma_generators();

struct LemmaSettings {
  std::uint64_t points = 0;    // in all, shared evenly by the generators
  std::string generator = {};  // the only one to run, with its share of points; empty: all
  std::uint64_t seed = 0;
  /// The radius in px for a view's budget and depth step.
  std::function<double(const Budget& budget, double depth_step)> radius;
  /// Displaces what is drawn by as much as double arithmetic may (kMaxDoubleError per axis and
  /// corner). Half of the triangles move as a whole, which is the budget's "double" term at its
  /// worst; in the others each corner moves by itself, which turns edges.
  bool displace = false;
  /// The samples are the values in the depth buffer (Canvas::depths); fixed-function depth has no
  /// others. A monotone rounding of both ends costs nothing (docs/reliability.md, lemma 4), so
  /// errors up to depth_rounding() are counted apart (LemmaRow::rounded).
  bool stored = false;
  int side = 0;        // px of the window, even, at least 128; 0: the generator's own
  double depth = 128;  // px, half the window's depth, at least 128; if it is more, the triangles
                       // are spread over it
};

/// Throws std::logic_error for an unknown generator.
std::vector<LemmaRow> lemma_experiment(Canvas& canvas, const Fattener& fattener,
                                       const LemmaSettings& settings,
                                       const Progress& progress = {});

/// The radius in px by the rule, for a view's budget and depth step.
double lemma_radius(const RadiusRule& rule, const Budget& budget, double depth_step);

/// A row "all" with the sums of the counts and the maxima of the largest values of all rows.
LemmaRow lemma_total(const std::vector<LemmaRow>& rows);

// Compares the two exact oracles: verify/exact (a filter, CGAL's predicates, rational distances),
// with which every run is compared, and the integers (verify/certificate/integer_pair), on which
// certificates rest.

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

/// Asks both oracles every question about pairs of every generator of pair_generators(), on all
/// cores. The questions neighbours and clearance get a tenth of the pairs, rounded up, since they
/// take longer. The pairs and the answers depend on the seed alone, not on the cores. A larger
/// number of pairs begins with the pairs of a smaller one.
std::vector<OracleRow> compare_oracles(std::uint64_t pairs_per_generator, std::uint64_t seed,
                                       const OracleProgress& progress = {});

/// For people.
std::string oracles_table(const std::vector<OracleRow>& rows);

/// {"seed", "pairs_per_generator", "disagreements", "generators": [...]}.
nlohmann::ordered_json oracles_json(const std::vector<OracleRow>& rows,
                                    std::uint64_t pairs_per_generator, std::uint64_t seed);

}  // namespace farcull
