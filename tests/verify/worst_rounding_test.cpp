// The worst canvas where the program that stores and the one that asks round the depth map, each in
// a direction of its own: nothing is lost with the slack, and pairs are lost without it.
// FARCULL_ROUNDING_PAIRS: how many pairs each depth of window and each way to round tries.
#include "core/base/random.h"
#include "tests/lab/lemmas.h"
#include "verify/worst_canvas.h"

namespace farcull {
namespace {

// px, half the depth of a window; at 258 a step of the buffer is 6e-5 px, at 2^20 it is 0.25 px.
constexpr double kDepths[] = {258, 0x1p17, 0x1p19, 0x1p20};
constexpr float kStep = 0x1p-24f;

std::uint64_t pairs_wanted(std::uint64_t usual) {
  const char* const text = std::getenv("FARCULL_ROUNDING_PAIRS");
  return text == nullptr ? usual : std::stoull(text);
}

struct Lost {
  std::uint64_t pairs = 0, lost = 0;
  void operator+=(const Lost& other) {
    pairs += other.pairs;
    lost += other.lost;
  }
};

// Stores the first of each pair of elements, then asks the second.
Lost ask_pairs(WorstCanvas& canvas, const Window& window, const Drawables& drawables) {
  Pass pass;
  pass.slots = static_cast<std::uint32_t>(drawables.items() / 2);
  for (std::uint32_t item : {0u, 1u}) {
    const auto first = static_cast<std::uint32_t>(pass.draws.size());
    for (std::uint32_t slot = 0; slot < pass.slots; ++slot)
      lab::add(pass.draws, drawables, 2 * slot + item, slot);
    pass.steps.push_back({item == 0 ? Verb::store : Verb::ask, first,
                          static_cast<std::uint32_t>(pass.draws.size()) - first});
  }
  canvas.begin(window, drawables);
  Lost out{pass.slots, 0};
  for (const std::uint8_t seen : canvas.run(pass)) out.lost += seen == 0;
  return out;
}

// A triangle no larger than 2^-9 px, or a segment at 45 degrees, with a corner or its middle at q;
// all of it displaced as far as double arithmetic may.
Patch small_at(RandomNumbers& random, const Vec3& q) {
  const auto direction = [&] {
    return Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
  };
  const double size = std::exp2(random.between(-16, -9));
  std::array<Vec3, 3> corners = {q, q + size * direction(), q + size * direction()};
  if (random.below(2)) {
    const Vec3 half(size, size * random.sign(), 0);
    corners = {q - half, q + half, q + half};
  }
  const Vec3 by(random.sign(), random.sign(), random.sign());
  Patch out;
  for (const Vec3& c : corners) out.corners[out.count++] = c + kMaxDoubleError * by;
  return out;
}

// Pairs of small triangles that meet at a corner of pixels, one in each cell of 6 px.
Lost pairs_at_corners(const Fattener& fattener, double depth, std::uint64_t seed,
                      std::uint64_t wanted, const WorstCanvasOptions& options) {
  constexpr int kSide = 508, kCell = 6;
  const Window window = lab::window(kSide, depth);
  WorstCanvas canvas(fattener.solid, options);
  RandomNumbers random(seed);
  Lost out;
  while (out.pairs < wanted) {
    std::vector<Patch> patches;
    for (int y = -kSide / 2; y + kCell <= kSide / 2; y += kCell) {
      for (int x = -kSide / 2; x + kCell <= kSide / 2; x += kCell) {
        if (out.pairs + patches.size() / 2 >= wanted) break;
        const double z = random.sign() * std::exp2(random.between(-4, std::log2(depth - 1)));
        const Vec3 q(x + kCell / 2, y + kCell / 2, z);
        for (int k = 0; k < 2; ++k) patches.push_back(small_at(random, q));
      }
    }
    out += ask_pairs(canvas, window,
                     lab::fattened(window, fattener, lab::budget_radius(canvas, window), patches));
  }
  return out;
}

// Of all depths of windows, both offsets, and the worst rounding and a random one.
Lost pairs_everywhere(float asked_behind, int depth_bits, std::uint64_t usual) {
  Lost out;
  std::uint64_t seed = 1;
  for (const double depth : kDepths) {
    for (const std::uint64_t rounding : {0, 7}) {
      for (const Fattener& fattener : lab::fatteners())
        out += pairs_at_corners(
            fattener, depth, ++seed, pairs_wanted(usual),
            {.depth_bits = depth_bits, .asked_behind = asked_behind, .rounding_seed = rounding});
    }
  }
  std::cout << "[ " << out.lost << " of " << out.pairs << " pairs lost, asked "
            << asked_behind / kStep << " steps behind, " << depth_bits << " bits ]\n";
  return out;
}

TEST(WorstRounding, LosesNoPairThatMeetsAtAPixelCorner) {
  for (const int bits : {32, 24}) EXPECT_EQ(pairs_everywhere(kAskedBehind, bits, 700).lost, 0u);
}

TEST(WorstRounding, LosesPairsWithoutTheSlack) {
  for (const int bits : {32, 24}) EXPECT_GT(pairs_everywhere(0, bits, 700).lost, 0u);
}

// A solid of one depth for each pixel: lemma 4 by itself, with no room but the slack.
Lost equal_depths(double depth, std::uint64_t seed, const WorstCanvasOptions& options) {
  constexpr int kSide = 64;
  const Window window = lab::window(kSide, depth);
  SolidProgram solid;
  solid.interval_worst = [](float, float, const Solid& s, float& entry, float& exit) {
    entry = s[0][2];
    exit = s[0][3];
    return true;
  };
  RandomNumbers random(seed);
  Drawables drawables;
  for (int y = -kSide / 2; y < kSide / 2; ++y) {
    for (int x = -kSide / 2; x < kSide / 2; ++x) {
      const auto z = static_cast<float>(random.between(-1.1, 1.1) * depth);
      const float l = static_cast<float>(x), b = static_cast<float>(y);
      const Proxy proxy{{l, b, l + 1, b, l + 1, b + 1, l, b + 1}, {{{0, 0, z, z}}}};
      for (int k = 0; k < 2; ++k) {
        drawables.proxies.push_back(proxy);
        drawables.first.push_back(static_cast<std::uint32_t>(drawables.proxies.size()));
      }
    }
  }
  WorstCanvas canvas(solid, options);
  return ask_pairs(canvas, window, drawables);
}

TEST(WorstRounding, AskingBehindSeesAnExitAtTheEntryThatWasStored) {
  for (const int bits : {32, 24}) {
    for (const std::uint64_t rounding : {0, 1, 2, 3}) {
      Lost with, without, half;
      for (std::uint64_t seed = 1; seed <= pairs_wanted(4096) / 4096 + 3; ++seed) {
        for (const double depth : kDepths) {
          const WorstCanvasOptions options{.depth_bits = bits, .rounding_seed = rounding};
          WorstCanvasOptions fewer = options, none = options;
          fewer.asked_behind = kStep;
          none.asked_behind = 0;
          with += equal_depths(depth, seed, options);
          half += equal_depths(depth, seed, fewer);
          without += equal_depths(depth, seed, none);
        }
      }
      EXPECT_EQ(with.lost, 0u) << bits << " " << rounding;
      EXPECT_GT(without.lost, without.pairs / 10) << bits << " " << rounding;
      // One step is enough for floats and not for 24 bits.
      EXPECT_EQ(half.lost > 0, bits == 24) << rounding;
    }
  }
}

}  // namespace
}  // namespace farcull
