// The steps of the kernels' arithmetic, as functions of any number. With floats they give the bits
// of the kernels (tests/proofs/steps_test.cpp compares them). With numbers that write down what is
// done (number.h) they give the formulas that Gappa is asked about. Names are those of the kernels.
#pragma once

namespace farcull::proofs {

/// offsets/slab.glsl: its constants.
struct SlabConstants {
  double eight_u, four_u, tiny;
};

template <class R>
struct Doubt {
  R s, e;
};
/// The position of the line in a slab, and the doubt about it.
template <class R>
Doubt<R> doubt(const R& sx, const R& sy, const SlabConstants& k) {
  const R s = sx + sy;
  const R e = (abs(sx) + abs(sy)) * R(k.eight_u) + R(k.tiny);
  return {s, e};
}
/// The slab's half width, with the doubt.
template <class R>
R height(const R& h, const R& e, const SlabConstants& k) {
  return (h + e) * R(1 + k.eight_u);
}
/// A bound of |z - m.z| on the solid, from a depth less that of the centre.
template <class R>
R reach(const R& below, const SlabConstants& k) {
  return below * R(1 + k.eight_u);
}
/// What a normal that is all but in the image may add.
template <class R>
R slack(const R& steep, const R& reach, const SlabConstants& k) {
  return steep * reach * R(1 + k.eight_u);
}
template <class R>
R limit(const R& h, const R& slack, const SlabConstants& k) {
  return (h + slack) * R(1 + k.eight_u);
}
/// The end of the interval behind a quotient t, relative to the centre; the near end is its mirror
/// image.
template <class R>
R far_end(const R& t, const SlabConstants& k) {
  const R w = abs(t) * R(k.eight_u) + R(k.tiny);
  return t + w;
}
/// The same as a depth.
template <class R>
R far_depth(const R& mz, const R& far, const SlabConstants& k) {
  const R far_error = (abs(mz) + abs(far)) * R(k.four_u);
  return (mz + far) + far_error;
}
/// The room of a halfspace around the line. `widening` is its first line, which may be negative.
template <class R>
R room(const R& h, const R& s, const R& e) {
  return (h - s) + e;
}
template <class R>
R wide(const R& room, const R& h, const R& s, const R& e, const SlabConstants& k) {
  return room + (abs(h) + abs(s) + e) * R(k.eight_u);
}
/// offsets/minkowski.glsl: a corner along a normal, from the products of their components.
template <class R>
R along(const R& x, const R& y, const R& z) {
  return x + y + z;
}
/// The doubt about it.
template <class R>
R along_doubt(const R& x, const R& y, const R& z, const SlabConstants& k) {
  return (abs(x) + abs(y) + abs(z)) * R(k.eight_u) + R(k.tiny);
}
/// The radius times a bound of a normal's length, from the squares of its components.
template <class R>
R ball(const R& radius, const R& xx, const R& yy, const R& zz, const SlabConstants& k) {
  const R up = R(1 + k.eight_u);
  const R squared = xx + yy + zz;
  const R length = (R(0.5) + R(0.5) * squared) * up * up;
  return radius * length * up;
}
template <class R>
R extent(const R& sum, const SlabConstants& k) {
  return sum + abs(sum) * R(k.eight_u);
}

}  // namespace farcull::proofs
