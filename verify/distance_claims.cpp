// Meaning of answers. `objects`: an answer says that nothing is nearer; no answer says that nothing
// is within the distance asked for. `nearest`: objects without an answer are not among each other's
// k nearest, so no pair of their triangles is nearer than the last neighbour of either, nor as near
// if the other object comes before that neighbour. `all`: every pair within the distance is an
// answer.
#include "verify/distance_claims.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/base/parallel.h"
#include "verify/certificate/integer_distance.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

mpq_class power_of_two(int exponent) {
  mpz_class out = 1;
  out <<= static_cast<unsigned>(std::abs(exponent));
  return exponent >= 0 ? mpq_class(out) : mpq_class(1, out);
}

// 2^1024 where the double is infinity.
mpq_class rational(double x) { return std::isfinite(x) ? mpq_class(x) : power_of_two(1024); }

bool has(const Object& object, std::uint32_t triangle) {
  return triangle >= object.first_triangle &&
         triangle - object.first_triangle < object.triangle_count;
}

auto objects_of(const ClaimedDistance& answer) { return std::pair(answer.a, answer.b); }

}  // namespace

bool is_rounded_root(double distance, const Fraction& square) {
  if (!(distance >= 0)) return false;
  mpq_class squared(square.over, square.under);
  squared.canonicalize();
  const bool even = (std::bit_cast<std::uint64_t>(distance) & 1) == 0;
  // How the root compares with the middle of the double and the next one.
  const auto beside = [&](double next) {
    const mpq_class middle = (rational(distance) + rational(next)) / 2;
    return cmp(squared, middle * middle);
  };
  if (std::isfinite(distance)) {
    const int above = beside(std::nextafter(distance, kInfinity));
    if (above > 0 || (above == 0 && !even)) return false;
  }
  if (distance == 0) return true;
  const int below = beside(std::nextafter(distance, 0.0));
  return below > 0 || (below == 0 && even);
}

DistanceClaims::DistanceClaims(const Scene& scene, std::span<const ClaimedDistance> answers,
                               const DistanceQuestion& question)
    : scene_(scene),
      answers_(answers),
      question_(question),
      squares_(answers.size()),
      insides_(scene) {
  using Kind = DistanceQuestion::Kind;
  if (!(question.within >= 0) || (question.kind == Kind::all && !std::isfinite(question.within)))
    throw std::logic_error("account_distances: no such distance");
  const auto place = [](const ClaimedDistance& x) { return std::tuple(x.a, x.b, x.pair); };
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const ClaimedDistance& x = answers[k];
    if (x.a > x.b || x.b >= scene.objects.size() || x.pair.a >= x.pair.b ||
        !has(scene.objects[x.a], x.pair.a) || !has(scene.objects[x.b], x.pair.b))
      throw std::logic_error("account_distances: an answer names no triangles of its objects");
    if (k == 0) continue;
    const bool before = question.kind == Kind::all ? place(answers[k - 1]) < place(x)
                                                   : objects_of(answers[k - 1]) < objects_of(x);
    if (!before) throw std::logic_error("account_distances: answers unsorted or repeated");
  }
  within_.bound = Bound::at_most;
  if (std::isfinite(question.within)) within_.length.emplace(square_of(question.within));
  for (std::size_t k = 0; k < answers.size(); ++k) squares_[k] = parse_fraction(answers[k].squared);
  if (question.kind == Kind::nearest) find_farthest();
}

void DistanceClaims::find_farthest() {
  // Per object: its answers, by distance and then by the other object.
  std::vector<std::vector<std::pair<Fraction, std::uint32_t>>> neighbours(scene_.objects.size());
  for (std::size_t k = 0; k < answers_.size(); ++k) {
    if (!squares_[k]) continue;
    neighbours[answers_[k].a].emplace_back(*squares_[k], answers_[k].b);
    neighbours[answers_[k].b].emplace_back(*squares_[k], answers_[k].a);
  }
  farthest_.resize(scene_.objects.size());
  for (std::size_t o = 0; o < neighbours.size(); ++o) {
    auto& of = neighbours[o];
    std::sort(of.begin(), of.end());
    farthest_[o].answers = std::min(of.size(), question_.k);
    if (of.size() < question_.k) continue;
    std::tie(farthest_[o].squared, farthest_[o].other) = of[question_.k - 1];
  }
}

bool DistanceClaims::asked(std::uint32_t a, std::uint32_t b) const {
  if (a != b) return true;
  return question_.kind != DistanceQuestion::Kind::nearest && scene_.objects[a].self;
}

std::span<const ClaimedDistance> DistanceClaims::of(std::uint32_t a, std::uint32_t b) const {
  const auto found = std::ranges::equal_range(answers_, std::pair(a, b), {}, objects_of);
  return {found.begin(), found.end()};
}

Threshold DistanceClaims::threshold(std::uint32_t a, std::uint32_t b) const {
  using Kind = DistanceQuestion::Kind;
  if (question_.kind == Kind::all) return within_;
  const std::span<const ClaimedDistance> answers = of(a, b);
  if (!answers.empty()) {
    const auto k = static_cast<std::size_t>(answers.data() - answers_.data());
    return {Length(squares_[k].value_or(Fraction())), Bound::below};
  }
  if (question_.kind == Kind::objects || farthest_[a].answers < question_.k ||
      farthest_[b].answers < question_.k) {
    return within_;
  }
  const auto& [a_count, a_squared, a_other] = farthest_[a];
  const auto& [b_count, b_squared, b_other] = farthest_[b];
  const Fraction& most = std::max(a_squared, b_squared);
  const bool before = (a_squared == most && b < a_other) || (b_squared == most && a < b_other);
  return {Length(most), before ? Bound::at_most : Bound::below};
}

bool DistanceClaims::wrong_inside(const ClaimedDistance& claim, const Fraction& squared) const {
  const bool has_answer = question_.inside && question_.kind != DistanceQuestion::Kind::all &&
                          claim.a != claim.b && squared.over != 0;
  if (!has_answer) return claim.inside != InsideClaim::unknown;
  return insides_.which(claim.a, claim.b) != claim.inside;
}

bool DistanceClaims::wrong(std::size_t answer) const {
  const ClaimedDistance& x = answers_[answer];
  const std::optional<Fraction>& squared = squares_[answer];
  if (!squared || !asked(x.a, x.b) || !is_rounded_root(x.distance, *squared)) return true;
  if (within_.length && *squared > within_.length->squared) return true;
  const std::array<Vec3, 3> s = scene_.corners(x.pair.a), t = scene_.corners(x.pair.b);
  if (x.a == x.b && share_position(s, t)) return true;
  const IntegerDistance exact = integer_distance(s, t);
  if (exact.squared != *squared || exact.features != x.features ||
      !is_rounded(x.points[0], exact.points[0]) || !is_rounded(x.points[1], exact.points[1]))
    return true;
  if (wrong_inside(x, *squared)) return true;
  if (question_.kind != DistanceQuestion::Kind::nearest) return false;
  // The answer is wrong if neither object has the other one among its k nearest.
  const auto beyond = [&](const Farthest& of, std::uint32_t other) {
    return of.answers == question_.k && std::tie(of.squared, of.other) < std::tie(*squared, other);
  };
  return beyond(farthest_[x.a], x.b) && beyond(farthest_[x.b], x.a);
}

std::uint64_t DistanceClaims::wrong(unsigned threads) const {
  std::atomic<std::uint64_t> count = 0;
  const std::size_t chunks = chunks_for(answers_.size(), 64, threads);
  for_chunks(answers_.size(), chunks, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) count += wrong(k);
  });
  return count;
}

}  // namespace farcull
