// Counts misses and wrong answers by kind and parameter.
#include "experiments/peers/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/view/view.h"
#include "verify/contact.h"
#include "verify/exact.h"

namespace farcull {
namespace {

/// The counts that are written, in this order.
constexpr std::array kCounts = {&Score::asked,     &Score::answered,  &Score::missed,
                                &Score::wrong,     &Score::own_asked, &Score::own_missed,
                                &Score::own_wrong, &Score::refused,   &Score::unanswered,
                                &Score::crashed,   &Score::hung,      &Score::no_memory,
                                &Score::not_asked, &Score::twice,     &Score::differing};

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

/// Whether the documentation speaks of such a pair of a mesh that collides or was reported.
bool speaks_of(const ContestantCard& card, const Scene& scene, const TrianglePair& pair,
               bool collides) {
  const std::array<Vec3, 3> a = scene.corners(pair.a), b = scene.corners(pair.b);
  if (!card.degenerate && (degenerate(a) || degenerate(b))) return false;
  if (!collides) return card.margin == 0 || !within(a, b, card.margin);
  if (card.means == Means::closed) return true;
  return contact_of(a, b) == Contact::penetrating;
}

}  // namespace

void add(const Score& more, Score& to) {
  for (const auto count : kCounts) to.*count += more.*count;
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
      (pair.kind != SuiteKind::neighbours_meet ||
       contact_of(pair.a, pair.b) != Contact::penetrating))
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
    for (const auto count : kCounts) out += fmt::format(" {}", score.*count);
    out += fmt::format(" {}|{}", score.ns, score.reason);
  }
  return out;
}

std::vector<Score> parse_scores(const std::string& text) {
  const auto fail = [&](const std::string& what) {
    throw Error("scores", "'" + what + "' is no score", "use the farcull that measured it");
  };
  std::vector<Score> out;
  for (const std::string& part :
       text.empty() ? std::vector<std::string>{} : split_list(text, ';')) {
    Score& score = out.emplace_back();
    const std::size_t bar = part.find('|');
    if (bar == std::string::npos) fail(part);
    score.reason = part.substr(bar + 1);
    const std::vector<std::string> words = split_list(part.substr(0, bar), ' ');
    if (words.size() != kCounts.size() + 3) fail(part);
    const auto number = [&](std::size_t i) {
      const auto value = parse_number<double>(words[i]);
      if (!value) fail(part);
      return *value;
    };
    score.parameter = number(0);
    score.kind = words[1];
    for (std::size_t i = 0; i < kCounts.size(); ++i)
      score.*kCounts[i] = static_cast<std::uint64_t>(number(i + 2));
    score.ns = number(words.size() - 1);
  }
  return out;
}

}  // namespace farcull
