// What a view of FAR pairs asks of a GL device: dispatches, and results that are read back.
#include "core/gl/pairs/pairs.h"
#include "core/pairs/pairs.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/gl.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

// What one view asked.
struct Asked {
  std::uint64_t dispatches = 0, readbacks = 0;
  std::size_t portions = 0, pairs = 0;
};

// Notes what each view asks.
class Counting final : public PairBackend {
 public:
  explicit Counting(GlPairs& gl) : gl_(gl) {}
  std::string name() const override { return gl_.name(); }
  std::vector<TrianglePair> raw_pairs(const PairTask& task, PairCounts& counts) override {
    std::vector<TrianglePair> pairs = gl_.raw_pairs(task, counts);
    views.push_back({counts.dispatches, counts.readbacks, gl_.portions(), gl_.reported_pairs()});
    return pairs;
  }
  std::vector<Asked> views;

 private:
  GlPairs& gl_;
};

constexpr std::size_t kOutput = std::size_t{256} << 20;  // GlPairOptions::memory, bytes

// As docs/device-work.md says. A portion of the pairs is nine dispatches at most, and one that sets
// bits to 0; its totals and its pairs are read. Where the first one was too large, it is done again
// in smaller ones.
std::uint64_t most_dispatches(const Asked& a) {
  return 40 + (a.portions > 1 ? 10 * a.portions : 0);
}
std::uint64_t most_readbacks(const Asked& a) { return 3 + 2 * (a.portions - 1); }
// A portion holds at least three quarters of what its buffer could: a quarter is room for the next
// frame, or for portions that differ.
std::size_t most_portions(const Asked& a) {
  const auto block = static_cast<std::size_t>(lab::context().info().max_storage_block) - 16;
  return 1 + a.pairs * sizeof(TrianglePair) / (std::min(kOutput, block) / 4 * 3);
}

void expect_few(const Asked& asked, const std::string& what) {
  EXPECT_LE(asked.dispatches, most_dispatches(asked)) << what;
  EXPECT_LE(asked.readbacks, most_readbacks(asked)) << what;
  EXPECT_LE(asked.portions, most_portions(asked)) << what << ": " << asked.pairs << " pairs";
}

struct Case {
  std::string name;
  Scene scene;
  PairSettings settings;
};

// Two frames of the scene: the first is guessed, the second is foreseen.
void expect_few(const Case& c, PairCounts& sum) {
  GlPairs backend(lab::context());
  std::string row = "| `" + c.name + "` |";
  for (const char* frame : {", first frame", ", later frame"}) {
    Counting counting(backend);
    for (const PairView& view : find_pairs(c.scene, c.settings, counting).views) {
      if (!view.looked) continue;
      sum.crowded += view.counts.crowded;
      sum.large += view.counts.large;
      EXPECT_EQ(view.counts.redone, 0u) << c.name << frame;
      EXPECT_EQ(view.counts.bands, 1u) << c.name << frame;
      // The clock of the device gives all times or none.
      const bool timed = view.counts.mark_device_ms >= 0;
      EXPECT_EQ(view.counts.list_device_ms >= 0, timed) << c.name << frame;
      EXPECT_EQ(view.counts.pair_device_ms >= 0, timed) << c.name << frame;
    }
    Asked most;
    for (const Asked& asked : counting.views) {
      expect_few(asked, c.name + frame);
      if (asked.dispatches > most.dispatches) most = asked;
    }
    row += " " + std::to_string(most.dispatches) + ", " + std::to_string(most.readbacks) + " |";
    if (*(frame + 2) == 'l') row += " " + std::to_string(most.pairs) + " |";
  }
  if (!c.name.starts_with("case")) std::printf("%s\n", row.c_str());
}

// Built-in scenes that a software device does within a second or so; others by name, separated by
// blanks: FARCULL_DEVICE_WORK="two-bunnies fans". A row has what the view asked that asked most: on
// the first frame and on a later one dispatches and readbacks, and the pairs that it reported.
TEST(GlPairs, AskForFewDispatchesAndReadbacks) {
  std::vector<Case> cases;
  const char* const asked = std::getenv("FARCULL_DEVICE_WORK");
  std::istringstream names(asked ? asked
                                 : "two-spheres random-soup needles degenerate ground crowd");
  for (std::string name; names >> name;)
    cases.push_back({name, make_builtin_scene(name), {.views = parse_views("z")}});
  PairCounts sum;
  for (const Case& c : cases) expect_few(c, sum);
  if (asked) return;
  cases.clear();
  for (std::uint64_t seed = 400; seed < 412; ++seed) {
    Scene scene = lab::random_scene(seed);
    if (seed % 2 == 0) scene = lab::with_self(std::move(scene));
    cases.push_back({"case " + std::to_string(seed), std::move(scene), lab::settings_of(seed)});
  }
  for (const int resolution : {1, 8, 24}) {
    cases.push_back({"case of everything at " + std::to_string(resolution),
                     lab::mixed_scene(),
                     {.views = parse_views("z"), .resolution = resolution}});
  }
  cases.push_back({"case of crowds",
                   lab::crowded_scene(6, 3000),
                   {.views = parse_views("z"), .resolution = 1}});
  cases.push_back({"case of repeated pairs",
                   lab::coincident(300, 1e-3, 7),
                   {.views = parse_views("z"), .resolution = 64}});
  for (const Case& c : cases) expect_few(c, sum);
  EXPECT_GT(sum.crowded, 0u);
  EXPECT_GT(sum.large, 0u);
}

// The twin: with buffers of 100,000 bytes there are many portions, and the bounds are broken.
TEST(GlPairsTwin, PortionsOfASmallBufferAskForMore) {
  const Scene scene = lab::coincident(300, 1e-3, 7);
  const PairSettings settings{.views = parse_views("z"), .resolution = 8};
  GlPairs large(lab::context()), small(lab::context(), {.storage_limit = 100'000});
  Counting of_large(large), of_small(small);
  const auto expected = find_pairs(scene, settings, of_large).candidates;
  for (int frame = 0; frame < 2; ++frame) {
    of_small.views.clear();
    EXPECT_EQ(find_pairs(scene, settings, of_small).candidates, expected);
    const Asked& asked = of_small.views.at(0);
    EXPECT_GT(asked.portions, 1u);
    EXPECT_GT(asked.readbacks, 3u);
    EXPECT_GT(asked.portions, most_portions(asked)) << "for a buffer that is not so small";
  }
  EXPECT_EQ(of_large.views.at(0).portions, 1u);
}

}  // namespace
}  // namespace farcull
