// Counts misses and wrong answers by kind and parameter. To minimize a fault, tries simpler pairs,
// all of one round in one process, and goes on with the simplest pair that has the same fault.
#include "experiments/peers/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/view/view.h"
#include "experiments/suite/reader.h"
#include "verify/contact.h"
#include "verify/exact.h"

namespace farcull {
namespace {

bool degenerate(const std::array<Vec3, 3>& corners) { return shape(corners) != Shape::triangle; }

void count_outcome(ContestOutcome outcome, Score& score) {
  const std::array<std::uint64_t*, 8> counts = {nullptr,           nullptr,         &score.refused,
                                                &score.unanswered, &score.crashed,  &score.hung,
                                                &score.no_memory,  &score.not_asked};
  if (std::uint64_t* count = counts.at(static_cast<std::size_t>(outcome))) ++*count;
}

void note_reason(const std::string& reason, Score& score) {
  if (!score.reason.empty() || reason.empty()) return;
  score.reason = reason.substr(0, 160);
  for (char& c : score.reason) {
    if (c == ';' || c == '|' || static_cast<unsigned char>(c) < ' ') c = ' ';
  }
}

void count_pair(const ContestantCard& card, const SuitePair& pair, const ContestAnswer& answer,
                Score& score) {
  score.asked += answer.outcome != ContestOutcome::not_asked;
  score.ns += answer.ns;
  count_outcome(answer.outcome, score);
  note_reason(answer.reason, score);
  if (pair.kind == SuiteKind::unlabelled) return;
  const bool label = collides(pair.kind), apart = answer.outcome == ContestOutcome::apart,
             meets = answer.outcome == ContestOutcome::meets;
  if (!apart && !meets) return;
  const std::optional<bool> own = promised(card, pair);
  ++score.answered;
  score.own_asked += own.has_value();
  score.missed += label && apart;
  score.wrong += !label && meets;
  score.own_missed += own == true && apart;
  score.own_wrong += own == false && meets;
}

/// Whether the documentation promises an answer about such a pair of a mesh (a pair that collides
/// or was reported).
bool speaks_of(const ContestantCard& card, const Scene& scene, const TrianglePair& pair,
               bool collides) {
  const std::array<Vec3, 3> a = scene.corners(pair.a), b = scene.corners(pair.b);
  if (!card.degenerate && (degenerate(a) || degenerate(b))) return false;
  if (!collides) return card.margin == 0 || !within(a, b, card.margin);
  if (card.means == Means::closed) return true;
  return penetrate(a, b);
}

}  // namespace

void add(const Score& more, Score& to) {
  add_fields(more, to);
  to.ns += more.ns;
  note_reason(more.reason, to);
}

bool takes(const ContestantCard& card, const SuitePair& pair) {
  return pair.shared.empty() || card.neighbours;
}

std::optional<bool> promised(const ContestantCard& card, const SuitePair& pair) {
  if (pair.kind == SuiteKind::unlabelled) return {};
  if (!card.degenerate && (degenerate(pair.a) || degenerate(pair.b))) return {};
  const bool label = collides(pair.kind);
  if (!label && card.margin > 0 && within(pair.a, pair.b, card.margin)) return {};
  if (card.means == Means::crossing && label && pair.kind != SuiteKind::crossing &&
      (pair.kind != SuiteKind::neighbours_meet || !penetrate(pair.a, pair.b)))
    return {};
  return label;
}

std::vector<Score> score_pairs(const ContestantCard& card, const std::vector<SuitePair>& pairs,
                               const PairsAnswer& answer) {
  std::vector<Score> out;
  std::map<std::pair<double, SuiteKind>, std::size_t> at;
  std::vector<std::size_t> score_of(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const SuitePair& pair = pairs[i];
    const auto [entry, is_new] = at.try_emplace({pair.parameter, pair.kind}, out.size());
    if (is_new) out.push_back({.parameter = pair.parameter, .kind = to_string(pair.kind)});
    score_of[i] = entry->second;
    count_pair(card, pair, answer.answers[i], out[entry->second]);
  }
  for (const std::size_t i : answer.differing) ++out[score_of[i]].differing;
  if (!out.empty()) out.front().twice = answer.asked_twice;
  return out;
}

Score score_mesh(const ContestantCard& card, const SuiteMesh& mesh, const MeshAnswer& answer) {
  Score out{.parameter = mesh.parameter, .kind = "mesh"};
  std::vector<TrianglePair> truth;
  for (const SuiteMeshPair& pair : mesh.pairs) {
    if (pair.shared == 0 || card.neighbours) truth.push_back(pair.pair);
  }
  out.asked = truth.size();
  if (answer.outcome == ContestOutcome::meets) out.answered = truth.size();
  out.ns = answer.ns;
  out.twice = answered(answer.outcome);
  out.differing = answer.differs;
  note_reason(answer.reason, out);
  count_outcome(answer.outcome, out);
  std::vector<TrianglePair> reported;
  for (const TrianglePair& pair : answer.pairs) {
    if (card.neighbours || shared_vertices(mesh.scene, pair) == 0) reported.push_back(pair);
  }
  const auto own = [&](const TrianglePair& pair, bool collides) {
    return speaks_of(card, mesh.scene, pair, collides);
  };
  for (const TrianglePair& pair : truth) {
    const bool promised = own(pair, true);
    const bool missed = answer.outcome == ContestOutcome::meets &&
                        !std::binary_search(reported.begin(), reported.end(), pair);
    out.own_asked += promised && out.answered > 0;
    out.missed += missed;
    out.own_missed += missed && promised;
  }
  for (const TrianglePair& pair : reported) {
    if (!mesh.labelled || std::binary_search(truth.begin(), truth.end(), pair)) continue;
    ++out.wrong;
    out.own_wrong += own(pair, false);
  }
  return out;
}

std::string scores_text(const std::vector<Score>& scores) {
  std::string out;
  for (const Score& score : scores) {
    out += fmt::format("{}{} {}", out.empty() ? "" : ";", score.parameter, score.kind);
    std::apply([&](const auto... count) { ((out += fmt::format(" {}", count)), ...); },
               score.members());
    out += fmt::format(" {}|{}", score.ns, score.reason);
  }
  return out;
}

std::vector<Score> parse_scores(const std::string& text) {
  const auto fail = [&](const std::string& what) {
    throw Error("scores", "'" + what + "' is no score", "use the farcull that measured it");
  };
  constexpr std::size_t kCounts = std::tuple_size_v<decltype(Score().members())>;
  std::vector<Score> out;
  for (const std::string& part :
       text.empty() ? std::vector<std::string>{} : split_list(text, ';')) {
    Score& score = out.emplace_back();
    const std::size_t bar = part.find('|');
    if (bar == std::string::npos) fail(part);
    score.reason = part.substr(bar + 1);
    const std::vector<std::string> words = split_list(part.substr(0, bar), ' ');
    if (words.size() != kCounts + 3) fail(part);
    const auto number = [&](std::size_t i) {
      const auto value = parse_number<double>(words[i]);
      if (!value) fail(part);
      return *value;
    };
    score.parameter = number(0);
    score.kind = words[1];
    std::size_t i = 2;
    std::apply([&](auto&... count) { ((count = static_cast<std::uint64_t>(number(i++))), ...); },
               score.members());
    score.ns = number(words.size() - 1);
  }
  return out;
}

namespace {

using Change = std::function<double(double)>;

/// Coordinate i of 18: those of the first triangle, then those of the second.
double& coordinate(SuitePair& pair, std::size_t i) {
  return (i < 9 ? pair.a : pair.b)[i / 3 % 3][static_cast<Eigen::Index>(i % 3)];
}
double coordinate(const SuitePair& pair, std::size_t i) {
  return (i < 9 ? pair.a : pair.b)[i / 3 % 3][static_cast<Eigen::Index>(i % 3)];
}

void change_all(SuitePair& pair, const Change& change) {
  for (std::size_t i = 0; i < 18; ++i) coordinate(pair, i) = change(coordinate(pair, i));
}

/// The value rounded to so many bits.
double to_bits(double value, int bits) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(fraction, bits)), exponent - bits);
}
/// The value rounded to so many significant decimal digits.
double to_digits(double value, int digits) {
  if (value == 0) return 0;
  char text[40];
  std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
  return std::strtod(text, nullptr);
}

/// Sets shared corners of the second triangle to those of the first, since they are one vertex.
void keep_shared(SuitePair& pair) {
  for (const SharedCorner& corner : pair.shared) pair.b[corner.b] = pair.a[corner.a];
}

std::vector<SuitePair> simpler(const SuitePair& from) {
  std::vector<SuitePair> out;
  const auto with = [&](const std::function<void(SuitePair&)>& change) {
    SuitePair next = from;
    change(next);
    keep_shared(next);
    bool finite = true;
    for (std::size_t i = 0; i < 18; ++i) finite = finite && std::isfinite(coordinate(next, i));
    if (finite && cost_of(next) < cost_of(from)) out.push_back(std::move(next));
  };
  const auto all = [&](const Change& change) {
    with([&](SuitePair& pair) { change_all(pair, change); });
  };
  for (const int bits : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32})
    all([bits](double x) { return to_bits(x, bits); });
  for (int digits = 1; digits <= 16; ++digits)
    all([digits](double x) { return to_digits(x, digits); });
  // Tries integers, at the scale of the largest coordinate.
  double most = 0;
  for (std::size_t i = 0; i < 18; ++i) most = std::max(most, std::abs(coordinate(from, i)));
  if (most > 0) {
    const int exponent = std::ilogb(most);
    for (int keep = 1; keep <= 30; keep += 1) {
      all([=](double x) { return std::nearbyint(std::ldexp(x, keep - exponent)); });
    }
    all([=](double x) { return std::ldexp(x, -exponent); });
  }
  for (const auto* triangle : {&from.a, &from.b}) {
    for (const Vec3& corner : *triangle) {
      with([&](SuitePair& pair) {
        for (Vec3& p : pair.a) p -= corner;
        for (Vec3& p : pair.b) p -= corner;
      });
    }
  }
  for (std::size_t i = 0; i < 18; ++i) {
    for (const int digits : {0, 1, 2, 3, 5, 8}) {
      with([&](SuitePair& pair) {
        double& x = coordinate(pair, i);
        x = digits == 0 ? 0 : to_digits(x, digits);
      });
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const SuitePair& x, const SuitePair& y) { return cost_of(x) < cost_of(y); });
  return out;
}

/// Whether a simpler pair is of the same sort: it meets iff `before` meets, and the documentation
/// promises the same of it. Sets its kind.
bool like(const ContestantCard& card, const SuitePair& before, SuitePair& pair) {
  // Corners that became equal by rounding would share a position, but no index.
  if (!pair.shared.empty() && pair.shared != equal_corners(pair.a, pair.b)) return false;
  pair.kind = decide(pair, "a smaller pair");
  return collides(pair.kind) == collides(before.kind) &&
         promised(card, pair) == promised(card, before);
}

}  // namespace

std::size_t cost_of(const SuitePair& pair) { return coordinates_text(pair).size(); }

std::string coordinates_text(const SuitePair& pair) {
  std::string out;
  for (std::size_t i = 0; i < 18; ++i)
    out += (i == 0 ? "" : " ") + decimal(coordinate(pair, i) + 0.0);
  return out;
}

std::optional<SuitePair> minimized(const Invited& invited, const PairFault& fault,
                                   const ContestLimits& limits, int rounds) {
  ContestLimits hasty = limits;
  if (is_death(fault.outcome)) {  // each death costs a process, and a hang its whole time limit
    hasty.start_s = limits.answer_s;
    rounds = std::min(rounds, 3);
  }
  // True if the pair has the fault twice, each time alone in a new process.
  const auto errs_alone = [&](const SuitePair& pair) {
    for (int time = 0; time < 2; ++time) {
      if (ask_pairs(invited, std::span(&pair, 1), hasty, 0).answers[0].outcome != fault.outcome)
        return false;
    }
    return true;
  };
  if (!errs_alone(fault.pair)) return std::nullopt;
  SuitePair best = fault.pair;
  for (int round = 0; round < rounds; ++round) {
    std::vector<SuitePair> tried = simpler(best);
    std::erase_if(tried, [&](SuitePair& pair) { return !like(invited.card, fault.pair, pair); });
    if (tried.empty()) return best;
    if (is_death(fault.outcome)) tried.resize(std::min<std::size_t>(tried.size(), 4));
    const PairsAnswer answer = ask_pairs(invited, tried, hasty, 0);
    bool found = false;
    for (std::size_t i = 0; i < tried.size() && !found; ++i) {
      if (answer.answers[i].outcome != fault.outcome || !errs_alone(tried[i])) continue;
      best = tried[i];
      found = true;
    }
    if (!found) return best;
  }
  return best;
}

}  // namespace farcull
