// A slow reference for verify/closest.h, written apart from it: no guess, no cross products, no
// proof of a guess. For each corners S of a and T of b the least distance of the points of the two
// flats through them is solved for by Cramer's rule; it counts where its point is a mean of the
// corners with weights >= 0. The distance of two features is the least of those that count among
// their corners, and the answer the first pair of features that has the distance of the triangles.
#pragma once

#include "tests/lab/reference.h"
#include "verify/closest.h"

namespace farcull::closest_reference {

using reference::Rational, reference::RationalPoint, reference::Triangle;
using Integer = mpz_class;
using Point = reference::Vector<Integer>;

/// The features in their order, and the corners of each.
struct Corners {
  Feature feature;
  std::vector<int> corners;
};
inline const std::vector<Corners>& features() {
  using enum FeatureKind;
  static const std::vector<Corners> all = {
      {{vertex, 0}, {0}},  {{vertex, 1}, {1}},  {{vertex, 2}, {2}},    {{edge, 0}, {0, 1}},
      {{edge, 1}, {1, 2}}, {{edge, 2}, {2, 0}}, {{face, 0}, {0, 1, 2}}};
  return all;
}

/// The squared distance num / den, and the multiples, times den, of the edges from the first corner
/// of each to the others of it: those of a before those of b.
struct Least {
  Integer num, den;
  std::vector<Integer> multiples;
};

inline Integer determinant(const std::vector<std::vector<Integer>>& m) {
  if (m.empty()) return 1;
  if (m.size() == 1) return m[0][0];
  if (m.size() == 2) return m[0][0] * m[1][1] - m[0][1] * m[1][0];
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// Of the flats through some corners of each; nothing where they have no single pair of closest
/// points, or where one of these is no mean of the corners.
inline std::optional<Least> of_flats(const std::array<Point, 3>& a, const std::vector<int>& s,
                                     const std::array<Point, 3>& b, const std::vector<int>& t) {
  const Point from = reference::minus(a[s[0]], b[t[0]]);
  std::vector<Point> columns;
  for (std::size_t i = 1; i < s.size(); ++i) columns.push_back(reference::minus(a[s[i]], a[s[0]]));
  for (std::size_t i = 1; i < t.size(); ++i) columns.push_back(reference::minus(b[t[0]], b[t[i]]));
  const std::size_t n = columns.size();
  if (n > 3) return {};  // a plane and a plane
  std::vector<std::vector<Integer>> gram(n, std::vector<Integer>(n));
  std::vector<Integer> right(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) gram[i][j] = reference::dot(columns[i], columns[j]);
    right[i] = -reference::dot(columns[i], from);
  }
  Least out;
  out.den = determinant(gram);
  if (out.den == 0) return {};
  out.num = reference::dot(from, from) * out.den;
  std::array<Integer, 2> sums = {0, 0};
  for (std::size_t i = 0; i < n; ++i) {
    auto replaced = gram;
    for (std::size_t j = 0; j < n; ++j) replaced[j][i] = right[j];
    const Integer multiple = determinant(replaced);
    if (multiple < 0) return {};
    sums[i < s.size() - 1 ? 0 : 1] += multiple;
    out.num -= right[i] * multiple;
    out.multiples.push_back(multiple);
  }
  if (sums[0] > out.den || sums[1] > out.den) return {};
  return out;
}

/// The point of the corners s of t with multiples from `first` on, over the scale.
inline RationalPoint point_of(const std::array<Point, 3>& t, const std::vector<int>& s,
                              const Least& least, std::size_t first, const Integer& scale) {
  RationalPoint out;
  for (int k = 0; k < 3; ++k) {
    Integer sum = t[s[0]][k] * least.den;
    for (std::size_t i = 1; i < s.size(); ++i)
      sum += least.multiples[first + i - 1] * (t[s[i]][k] - t[s[0]][k]);
    out[k] = Rational(sum, least.den * scale);
    out[k].canonicalize();
  }
  return out;
}

struct Answer {
  Rational squared;
  std::array<Feature, 2> features;
  std::array<RationalPoint, 2> points;
};

/// The answer; without edges against edges for the twin that must be noticed.
inline Answer closest_points(const Triangle& a, const Triangle& b, bool edges = true) {
  Integer scale = 1;
  for (const Triangle* t : {&a, &b}) {
    for (const Vec3& p : *t)
      for (const double x : p) scale = std::max(scale, Integer(Rational(x).get_den()));
  }
  const auto integer = [&](double x) { return Integer(Rational(Rational(x) * scale)); };
  const auto p = reference::converted(a, integer);
  const auto q = reference::converted(b, integer);
  const auto& all = features();
  std::vector<std::vector<std::optional<Least>>> found(7);
  const Least* least = nullptr;
  const auto less = [](const Least& x, const Least& y) { return x.num * y.den < y.num * x.den; };
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 7; ++j) {
      const bool left_out = !edges && i >= 3 && j >= 3;
      found[i].push_back(left_out ? std::nullopt : of_flats(p, all[i].corners, q, all[j].corners));
    }
  }
  for (const auto& row : found) {
    for (const auto& f : row)
      if (f && (!least || less(*f, *least))) least = &*f;
  }
  const auto part = [&](int i, int j) {  // is feature i one of j's?
    return std::ranges::all_of(all[i].corners, [&](int c) {
      return std::ranges::find(all[j].corners, c) != all[j].corners.end();
    });
  };
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 7; ++j) {
      for (int k = 0; k < 7; ++k) {
        for (int l = 0; l < 7; ++l) {
          const auto& f = found[k][l];
          if (!f || !part(k, i) || !part(l, j) || less(*least, *f)) continue;
          Answer out;
          out.squared = Rational(f->num, f->den * scale * scale);
          out.squared.canonicalize();
          out.features = {all[i].feature, all[j].feature};
          out.points = {point_of(p, all[k].corners, *f, 0, scale),
                        point_of(q, all[l].corners, *f, all[k].corners.size() - 1, scale)};
          return out;
        }
      }
    }
  }
  throw std::logic_error("two corners have a distance");
}

/// True iff x is the double nearest to `exact`, compared with the middles between x and its
/// neighbours: sign(middle) is to be that of middle - exact.
template <class Sign>
bool is_nearest(double x, Sign sign) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  if (std::signbit(x) && x == 0) return false;
  const bool even = (std::bit_cast<std::uint64_t>(x) & 1) == 0;
  const auto middle = [&](double y) {
    // 2^1024 stands for infinity, as IEEE 754 rounds.
    const auto exact = [](double z) {
      return std::isinf(z) ? Rational(z < 0 ? -1 : 1) * (Integer(1) << 1024) : Rational(z);
    };
    return Rational((exact(x) + exact(y)) / 2);
  };
  const int below = std::isinf(x) && x < 0 ? -1 : sign(middle(std::nextafter(x, -kInf)));
  const int above = std::isinf(x) && x > 0 ? 1 : sign(middle(std::nextafter(x, kInf)));
  return (below < 0 || (even && below == 0)) && (above > 0 || (even && above == 0));
}

inline bool is_rounded(double x, const Rational& exact) {
  return is_nearest(x, [&](const Rational& middle) { return cmp(middle, exact); });
}

inline bool is_rounded_root(double x, const Rational& square) {
  return is_nearest(x, [&](const Rational& middle) {
    return middle < 0 ? -1 : cmp(Rational(middle * middle), square);
  });
}

}  // namespace farcull::closest_reference
