// Compares two triangles with each other's planes, and along the line where the planes cross. This
// file is compiled for scalars (in filter_scalars.h, which derives the bounds) and for lanes (in
// filter.cpp, where each lane has a pair of its own). The including namespace defines
//   Real, Truth   a number and a truth value for each lane; PlainReal is one number for all lanes
//   Point         a corner, with x(), y() and z()
//   min, max, abs, sqrt, of_all, and FAR_FILTER before each function.
// The only branches are early returns once all lanes are decided.

struct Triple {
  Real x, y, z;
};

FAR_FILTER Triple difference(const Point& p, const Point& q) {
  return {p.x() - q.x(), p.y() - q.y(), p.z() - q.z()};
}
FAR_FILTER Triple magnitudes(const Triple& p) { return {abs(p.x), abs(p.y), abs(p.z)}; }
FAR_FILTER Real dot(const Triple& p, const Triple& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
FAR_FILTER Real sum(const Triple& p) { return p.x + p.y + p.z; }

FAR_FILTER Triple largest(const Triple& p, const Triple& q) {
  return {max(abs(p.x), abs(q.x)), max(abs(p.y), abs(q.y)), max(abs(p.z), abs(q.z))};
}

/// n = e x f. m has the same terms as n, but adds their magnitudes.
struct Normal {
  Triple n, m;
};

FAR_FILTER Normal normal_of(const Triple& e, const Triple& f) {
  const Real yz = e.y * f.z, zy = e.z * f.y;
  const Real zx = e.z * f.x, xz = e.x * f.z;
  const Real xy = e.x * f.y, yx = e.y * f.x;
  return {{yz - zy, zx - xz, xy - yx}, {abs(yz) + abs(zy), abs(zx) + abs(xz), abs(xy) + abs(yx)}};
}

/// Returns an error bound of dot(normal.n, x) for all x with |x| <= w per axis; x is relative to
/// the common corner of the normal's edges.
template <class Bounds>
FAR_FILTER Real side_bound(const Normal& normal, const Triple& w) {
  return Bounds::side * dot(normal.m, w) + Bounds::absolute * (sum(w) + 1);
}

// ---- sides of planes ----

/// On which side of the plane of a triangle t the corners of a triangle s lie. The sign of value[i]
/// is the side of corner i. The sign is proved if |value[i]| > bound.
struct Sides {
  Real value[3];
  Real bound;
  Real needed;  // |value| > bound + needed proves a distance above the clearance

  FAR_FILTER Real least() const { return min(min(value[0], value[1]), value[2]); }
  FAR_FILTER Real most() const { return max(max(value[0], value[1]), value[2]); }
  FAR_FILTER Truth on_one_side() const {
    return least() > bound + needed || most() < -(bound + needed);
  }
  /// True if corners are on both sides, and no corner is in doubt.
  FAR_FILTER Truth on_both_sides() const {
    const Real nearest = min(min(abs(value[0]), abs(value[1])), abs(value[2]));
    return nearest > bound && least() < Real(0.0) && most() > Real(0.0);
  }
};

/// Returns an upper bound of the clearance times the length of the exact normal. The computed
/// normal is off by at most ((1 + u)^4 - 1) (1 - u)^-4 m per axis, u = 2^-53. kLeastSquare covers
/// squares that underflow. kNormalRounding covers the 8 roundings of the last expression.
FAR_FILTER Real at_clearance(const Normal& normal, PlainReal clearance) {
  const Real length = sqrt(dot(normal.n, normal.n) + kLeastSquare);
  return clearance * (length + sum(normal.m) * kNormalLength) * (1 + kNormalRounding) + 0x1p-1000;
}

template <class Bounds>
FAR_FILTER Sides sides(const Point* s, const Point* t, PlainReal clearance) {
  const Normal normal = normal_of(difference(t[1], t[0]), difference(t[2], t[0]));
  const Triple w0 = difference(s[0], t[0]);
  const Triple w1 = difference(s[1], t[0]);
  const Triple w2 = difference(s[2], t[0]);
  return {{dot(normal.n, w0), dot(normal.n, w1), dot(normal.n, w2)},
          side_bound<Bounds>(normal, largest(largest(w0, w1), w2)),
          clearance > 0 ? at_clearance(normal, clearance) : Real(0.0)};
}

/// The answers that the planes alone give.
struct AgainstPlanes {
  Truth apart;     // a triangle is on one side of the other's plane, beyond the clearance
  Truth crossing;  // each triangle has corners on both sides of the other's plane
  Sides a, b;      // `a`: sides of a's corners, not valid if every lane is apart; `b`: of b's
};

template <class Bounds>
FAR_FILTER AgainstPlanes against_planes(const Point* a, const Point* b, PlainReal clearance) {
  const Sides b_sides = sides<Bounds>(b, a, clearance);
  Truth apart = b_sides.on_one_side();
  if (of_all(apart)) return {apart, !apart, b_sides, b_sides};
  const Sides a_sides = sides<Bounds>(a, b, clearance);
  apart = apart || a_sides.on_one_side();
  if (of_all(apart)) return {apart, !apart, a_sides, b_sides};
  return {apart, a_sides.on_both_sides() && b_sides.on_both_sides(), a_sides, b_sides};
}

// ---- along the line of two planes ----

/// The answers of compare_on_line().
struct OnLine {
  Truth apart, meeting;  // if neither is true, rounding leaves a doubt
};

/// Compares the segments in which the triangles meet the common line of their planes. The corners
/// are in the order of corner_order().
template <class Bounds>
FAR_FILTER OnLine compare_on_line(const Point& a0, const Point& a1, const Point& a2,
                                  const Point& b0, const Point& b1, const Point& b2) {
  const Normal first_normal = normal_of(difference(a1, a0), difference(b0, a0));
  const Triple first_w = difference(b1, a0);
  const Real first = dot(first_normal.n, first_w);
  const Real first_bound = side_bound<Bounds>(first_normal, magnitudes(first_w));
  const Truth first_apart = first > first_bound;
  if (of_all(first_apart)) return {first_apart, !first_apart};
  const Normal second_normal = normal_of(difference(a2, a0), difference(b2, a0));
  const Triple second_w = difference(b0, a0);
  const Real second = dot(second_normal.n, second_w);
  const Real second_bound = side_bound<Bounds>(second_normal, magnitudes(second_w));
  return {first_apart || second > second_bound, first < -first_bound && second < -second_bound};
}
