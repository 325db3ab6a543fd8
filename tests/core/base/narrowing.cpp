// Rounds doubles to floats, keeps these and measures what was lost: in straight-line code, two at a
// time, and in loops. Prints "straight" and "loop" with the number of values that come out wrong:
// GCC 12's vectorizer of straight-line code (SLP) makes x - double(float(x)) 0, two at a time, and
// with that an outward rounding that relies on it is none. tests/core/base/arithmetic_test.sh
// compiles it with the options of the product, and with that vectorizer.
#include <cstdio>

namespace {

constexpr int kMost = 17;

__attribute__((noinline)) void straight(const double* __restrict in, float* __restrict rounded,
                                        double* __restrict lost) {
  const double x = in[0], y = in[1];
  const float f = static_cast<float>(x), g = static_cast<float>(y);
  rounded[0] = f;
  rounded[1] = g;
  lost[0] = x - static_cast<double>(f);
  lost[1] = y - static_cast<double>(g);
}

__attribute__((noinline)) void loop(const double* __restrict in, float* __restrict rounded,
                                    double* __restrict lost, int count) {
  for (int i = 0; i < count; ++i) {
    const float f = static_cast<float>(in[i]);
    rounded[i] = f;
    lost[i] = in[i] - static_cast<double>(f);
  }
}

int wrong(const double* in, const float* rounded, const double* lost, int count) {
  int out = 0;
  for (int i = 0; i < count; ++i) {
    const volatile double f = rounded[i];  // one at a time
    out += lost[i] != in[i] - f;
  }
  return out;
}

}  // namespace

int main() {
  const volatile double tenth = 0.1;  // no double of this list is a float
  double in[kMost], lost[kMost];
  float rounded[kMost];
  for (int i = 0; i < kMost; ++i) in[i] = tenth * (3 * i + 1);
  straight(in, rounded, lost);
  const int in_straight = wrong(in, rounded, lost, 2);
  int in_loops = 0;
  for (int count = 1; count <= kMost; ++count) {
    loop(in, rounded, lost, count);
    in_loops += wrong(in, rounded, lost, count);
  }
  std::printf("straight %d loop %d\n", in_straight, in_loops);
}
