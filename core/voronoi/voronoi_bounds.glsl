// The distance of a point from a triangle, between two bounds of the exact distance, for any rounding that GLSL allows. This
// file compiles as GLSL and as C++.
//
// N is at least every coordinate of the point and of the triangle, none of which is negative; 1 <= N <= 2^14. v = 2^-23 is the
// largest relative error of a sum, a difference or a product, in any rounding mode; a quotient errs by 2.5 v; results below
// 2^-126 may be flushed to zero (GLSL 4.50, section 4.7.1; assumption A4). Nothing is assumed about sqrt: its result is
// compared with its square.
//
// The nearest point is looked for on each edge and in the face. On an edge it is w = q + t e with a float t in [0, 1],
// whatever error t has; in the face it is q + s e + t f with s, t >= 0 and s + t <= 1 + v. So there is a point P of the
// triangle that w was meant to be. Along each axis c - w is off c - P by at most v N for each of: the differences e and f
// together, the products together, each of two sums, s + t, c - w. That is 6 v N, with all second-order terms 6.2 v N, and
// 10.8 v N as a length.
//
// The length of n = c - w: the sum of three squares errs by 3 v, which is 1.5 v of the root. The root that sqrt gives is taken
// only if its square is within 16 v of the sum; with the roundings of that comparison it is within 8.6 v of the exact root.
// Together 10.2 v of |n| <= 1.7321 N, which is 17.7 v N. The corners were rounded to float along each axis by 1.01 * 2^-24 N,
// which is 0.9 v N as a length. So the exact distance is at most the computed one + 29.4 v N. Adding `error` rounds once, by
// 1.8 v N: 31.2 v N.
//
// Below: no point of the triangle is nearer to c along n than its corners are. So the distance is at least the least of
// n . (c - q_i) / |n|. The product errs by 4.1 v of |n| |c - q_i|: 7.2 v N |n|. Dividing by the computed length errs by
// 10.2 v + 2.5 v of the quotient, which is at most 1.74 N: 22.3 v N. With the corners 30.4 v N, with the subtraction of
// `error` 32.2 v N.
//
// Numbers that are flushed change a coordinate of w by less than 2^-120, and a product below by less than 2^-124, where
// |n| >= 2^-40. Both are far less than v N |n|.
//
// So error = 48 v N bounds both, and leaves 16.8 v N above and 15.8 v N below for sums of bounds that are compared.

const float kFarFlat = 8.67361737988403547e-19f;    // 2^-60: a square below it has no direction
const float kFarShort = 8.27180612553027674e-25f;   // 2^-80: the square of the shortest length
const float kFarRoot = 1.9073486328125e-6f;         // 16 v

struct FarStep {
  float x;
  float y;
  float z;
};

FAR_KERNEL FarStep far_minus(FarStep a, FarStep b) {
  FAR_PRECISE float x = a.x - b.x;
  FAR_PRECISE float y = a.y - b.y;
  FAR_PRECISE float z = a.z - b.z;
  return FarStep(x, y, z);
}

FAR_KERNEL float far_dot(FarStep a, FarStep b) {
  FAR_PRECISE float sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}

FAR_KERNEL FarStep far_cross(FarStep a, FarStep b) {
  FAR_PRECISE float x = a.y * b.z - a.z * b.y;
  FAR_PRECISE float y = a.z * b.x - a.x * b.z;
  FAR_PRECISE float z = a.x * b.y - a.y * b.x;
  return FarStep(x, y, z);
}

FAR_KERNEL FarStep far_along(FarStep q, float t, FarStep e) {
  FAR_PRECISE float x = q.x + t * e.x;
  FAR_PRECISE float y = q.y + t * e.y;
  FAR_PRECISE float z = q.z + t * e.z;
  return FarStep(x, y, z);
}

// From the point of the segment q, q + e that is nearest to c, to c.
FAR_KERNEL FarStep far_from_edge(FarStep c, FarStep q, FarStep e) {
  float square = far_dot(e, e);
  float t = 0.0f;
  if (square > kFarFlat) {
    FAR_PRECISE float quotient = far_dot(far_minus(c, q), e) / square;
    t = min(max(quotient, 0.0f), 1.0f);
  }
  return far_minus(c, far_along(q, t, e));
}

// computed: the distance that the published diagram compares. lower, upper: bounds of the exact distance. root_fails: the
// device's sqrt is not as good as the bounds need; they are worth nothing then. error: 48 v N.
FAR_KERNEL void far_distance(FarStep c, FarStep q0, FarStep q1, FarStep q2, float error, FAR_OUT(float) computed,
                             FAR_OUT(float) lower, FAR_OUT(float) upper, FAR_OUT(bool) root_fails) {
  FarStep e = far_minus(q1, q0);
  FarStep f = far_minus(q2, q0);
  FarStep n = far_from_edge(c, q0, e);
  float square = far_dot(n, n);
  FarStep other = far_from_edge(c, q0, f);
  float of_other = far_dot(other, other);
  if (of_other < square) {
    n = other;
    square = of_other;
  }
  other = far_from_edge(c, q1, far_minus(q2, q1));
  of_other = far_dot(other, other);
  if (of_other < square) {
    n = other;
    square = of_other;
  }
  FarStep normal = far_cross(e, f);
  float area = far_dot(normal, normal);
  if (area > kFarFlat) {
    FarStep from = far_minus(c, q0);
    FAR_PRECISE float s = far_dot(far_cross(from, f), normal) / area;
    FAR_PRECISE float t = far_dot(far_cross(e, from), normal) / area;
    FAR_PRECISE float both = s + t;
    if (s >= 0.0f && t >= 0.0f && both <= 1.0f) {
      other = far_minus(c, far_along(far_along(q0, s, e), t, f));
      of_other = far_dot(other, other);
      if (of_other < square) {
        n = other;
        square = of_other;
      }
    }
  }
  computed = 0.0f;
  lower = 0.0f;
  root_fails = false;
  if (square > kFarShort) {
    float length = sqrt(square);
    FAR_PRECISE float off = length * length - square;
    FAR_PRECISE float allowed = kFarRoot * square;
    root_fails = !(abs(off) <= allowed);
    float along = min(min(far_dot(n, far_minus(c, q0)), far_dot(n, far_minus(c, q1))), far_dot(n, far_minus(c, q2)));
    FAR_PRECISE float quotient = along / length;
    FAR_PRECISE float below = quotient - error;
    computed = length;
    lower = max(below, 0.0f);
  }
  FAR_PRECISE float above = computed + error;
  upper = above;
}
