// FAR pairs on GL, through the library, with one call to GL lost or one allocation failed at a
// time: the answer is right, or there is an error; and the next call on the same object is right.
#include "core/base/error.h"
#include "core/gl/base/context.h"
#include "core/gl/base/driver_fault.h"
#include "core/gl/base/objects.h"
#include "core/gl/pairs/pairs.h"
#include "experiments/scenes/builtin/scenes.h"
#include "tests/faults/gl_calls.h"
#include "tests/lab/flat.h"
#include "tests/lab/gl.h"
#include "tests/lab/pairs.h"

namespace farcull {
namespace {

using lab::expect_no_wrong_answer;
using lab::GlFault;
using lab::GlFaultOutcome;

class PairsFaults : public testing::TestWithParam<bool> {
 protected:
  // A find is tried again for each of its calls to GL, whose number does not grow with the scene.
  const char* const name = "spheres:1000";
  const lab::FlatScene scene{make_builtin_scene(name), GetParam()};
  std::optional<Collider> collider;
  void open() { collider.emplace(Options{.device = Device::gl, .self = GetParam()}); }
};

TEST_P(PairsFaults, EveryLostCallOfAFirstFindIsNoticed) {
  open();
  ASSERT_TRUE(scene.found_by(*collider));
  const auto outcomes = lab::try_gl_faults(
      GlFault::drop, [&] { open(); }, [&] { return scene.found_by(*collider); });
  EXPECT_GT(outcomes.size(), static_cast<std::size_t>(trials(100)));
  expect_no_wrong_answer("lost calls, first find", outcomes);
}

// Nothing is allocated then, and only what changed is sent.
TEST_P(PairsFaults, EveryLostCallOfALaterFindIsNoticed) {
  Scene moved = make_builtin_scene(name);
  for (std::size_t v = 0; v < moved.vertices.size() / 2; ++v) moved.vertices[v].x() += 0.125;
  const lab::FlatScene before(moved, GetParam());
  open();
  ASSERT_TRUE(before.found_by(*collider) && scene.found_by(*collider));
  const auto outcomes = lab::try_gl_faults(
      GlFault::drop, [&] { ASSERT_TRUE(before.found_by(*collider)); },
      [&] { return scene.found_by(*collider); });
  EXPECT_GT(outcomes.size(), static_cast<std::size_t>(trials(100)));
  expect_no_wrong_answer("lost calls, later find", outcomes);
}

TEST_P(PairsFaults, EveryFailedAllocationIsNoticed) {
  open();
  ASSERT_TRUE(scene.found_by(*collider));
  const auto outcomes = lab::try_gl_faults(
      GlFault::out_of_memory, [&] { open(); }, [&] { return scene.found_by(*collider); });
  EXPECT_GT(outcomes.size(), static_cast<std::size_t>(trials(20)));
  for (const GlFaultOutcome& o : outcomes)
    EXPECT_TRUE(o.threw && o.error.find("GL_OUT_OF_MEMORY") != std::string::npos) << o.at;
  expect_no_wrong_answer("failed allocations", outcomes);
}

// The twin: what is sent and read back without a check is wrong where a call is lost, and the trial
// of faults sees it.
TEST(PairsFaultsTwin, AnUncheckedProgramGivesWrongAnswers) {
  const GlContext context;
  const GlCurrent current(context);
  const std::array<std::uint32_t, 4> sent = {3, 5, 7, 11};
  const auto answer = [&] {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof sent, nullptr, GL_DYNAMIC_COPY);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof sent, sent.data());
    std::array<std::uint32_t, 4> got{};
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof got, got.data());
    glDeleteBuffers(1, &buffer);
    return got == sent;
  };
  std::size_t wrong = 0;
  for (const GlFaultOutcome& o : lab::try_gl_faults(
           GlFault::drop, [] {}, answer))
    wrong += !o.threw && !o.right;
  EXPECT_GE(wrong, 3u);
}

// Parts that two spheres do not need: crowded pixels that are cut, large triangles, pairs that
// repeat, a window in parts, whose triangles are sent piece by piece, counts that are read between
// the steps, and pairs in portions.
struct Hard {
  const char* name;
  Scene scene;
  GlPairOptions options;
};

// Crumbs in a square, few of which meet, and two large triangles that cross.
Scene crumbs(int count, double side) {
  lab::Random random(5);
  std::vector<lab::Triangles> objects(2);
  double tilt = 0.5;
  for (lab::Triangles& object : objects) {
    object.push_back({Vec3(-1, -1, tilt), Vec3(3, -1, 1 - tilt), Vec3(-1, 3, 0.3)});
    tilt = 0.1;
    for (int k = 0; k < count; ++k) {
      const Vec3 at(random.between(0.28, 0.28 + side), random.between(0.28, 0.28 + side),
                    random.between(0, 1));
      const auto near = [&] {
        return Vec3(
            at + 0.004 * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)));
      };
      object.push_back({near(), near(), near()});
    }
  }
  return lab::scene_of(objects);
}

class HardPairsFaults : public testing::TestWithParam<int> {
 protected:
  static Hard hard(int which) {
    switch (which) {
      case 0:
        return {"crowds", lab::with_self(crumbs(540, 0.05)), {}};
      case 1:
        return {"parts", crumbs(120, 0.8), {.memory = 160'000, .storage_limit = 30'000}};
      case 2:
        return {"repeats", lab::coincident(40, 1e-3, 7), {}};
      case 3:
        return {"step by step", lab::with_self(crumbs(540, 0.05)), {.step_by_step = true}};
      default:
        return {"portions", lab::coincident(100, 1e-3, 7), {.storage_limit = 70'000}};
    }
  }
  const Hard hard_ = hard(GetParam());
  const PairSettings settings_{.views = parse_views("z"), .resolution = 24};
  const std::vector<TrianglePair> truth_ = lab::truth_of(hard_.scene);
  const GlContext context_;
  std::optional<GlPairs> backend_;

  PairResult find() { return find_pairs(hard_.scene, settings_, *backend_); }
  bool right() { return lab::missed(truth_, find().candidates) == 0; }
  void open() { backend_.emplace(context_, hard_.options); }
};

TEST_P(HardPairsFaults, EveryLostCallAndFailedAllocationIsNoticed) {
  open();
  ASSERT_FALSE(truth_.empty());
  const PairCounts counts = find().views.at(0).counts;
  const bool coincident = GetParam() == 2 || GetParam() == 4;
  EXPECT_EQ(counts.crowded > 0, GetParam() == 0 || GetParam() == 3);
  EXPECT_TRUE(counts.large > 0 || coincident);
  EXPECT_EQ(counts.bands > 1, GetParam() == 1);
  EXPECT_EQ(backend_->portions() > 1, GetParam() == 1 || GetParam() == 4);
  const auto again = [&] { open(); };
  const auto answer = [&] { return right(); };
  const std::string name = hard_.name;
  std::printf("%s: %zu parts of the window\n", hard_.name, static_cast<std::size_t>(counts.bands));
  expect_no_wrong_answer((name + ", lost calls, first find").c_str(),
                         lab::try_gl_faults(GlFault::drop, again, answer));
  // A window in parts makes thousands of calls, and the same ones again.
  if (GetParam() != 1) {
    expect_no_wrong_answer((name + ", lost calls, later find").c_str(),
                           lab::try_gl_faults(
                               GlFault::drop, [] {}, answer));
  }
  expect_no_wrong_answer((name + ", failed allocations").c_str(),
                         lab::try_gl_faults(GlFault::out_of_memory, again, answer));
}

INSTANTIATE_TEST_SUITE_P(, HardPairsFaults, testing::Range(0, 5));

// More pairs than 32 bits count, by shaders that count each one so often that the total is exactly
// 2^32: no answer that takes them for none.
class PairsFaultsTotal : public testing::Test {
 protected:
  // A scene of which so many pairs are reported that 2^32 is a multiple of their number.
  void SetUp() override {
    for (int n = 2; n < 40 && !found(); ++n) {
      scene_ = lab::coincident(n, 1e-3, 7);
      GlPairs backend(context_);
      find(backend);
      pairs_ = backend.reported_pairs();
    }
    ASSERT_TRUE(found());
    ASSERT_FALSE(lab::truth_of(scene_).empty());
  }
  bool found() const { return pairs_ >= 4 && pairs_ <= 64 && std::has_single_bit(pairs_); }
  std::vector<TrianglePair> find(GlPairs& backend) const {
    return find_pairs(scene_, {.views = parse_views("z"), .resolution = 2}, backend).candidates;
  }
  lab::ShaderChange counted_often() const {
    return {"#define FAR_ONE_PAIR 1u",
            "#define FAR_ONE_PAIR " + std::to_string((std::uint64_t{1} << 32) / pairs_) + "u"};
  }

  const GlContext context_;
  Scene scene_;
  std::size_t pairs_ = 0;
};

TEST_F(PairsFaultsTotal, Of64BitsIsNotTakenForNone) {
  const lab::OtherShaderText text{counted_often()};
  GlPairs backend(context_);
  EXPECT_GT(text.replaced(), 0);
  try {
    find(backend);
    ADD_FAILURE() << "there was an answer";
  } catch (const Error& error) {
    EXPECT_EQ(error.reason, "one work item has more pairs than fit its memory");
  }
}

// The twin: without the second word of the total there is an answer, of no pairs.
TEST_F(PairsFaultsTotal, Of32BitsIsTakenForNone) {
  const lab::OtherShaderText text{counted_often(),
                                  {"atomicAdd(counters[FAR_PAIRS + 1u], 1u)", "place += 0u"}};
  GlPairs backend(context_);
  EXPECT_TRUE(find(backend).empty());
}

// A driver that sends other bytes than it was given, all of them 255, in one upload.
class OtherBytes {
  using SubData = GlEntryPoint<&epoxy_glBufferSubData>;
  static inline long at = -1, uploads = 0;
  static void sub_data(GLenum target, GLintptr offset, GLsizeiptr size, const void* data) {
    const std::vector<unsigned char> other(static_cast<std::size_t>(size), 255);
    SubData::original(target, offset, size, uploads++ == at ? other.data() : data);
  }
  SubData sub_data_{sub_data};

 public:
  explicit OtherBytes(long which) {
    at = which;
    uploads = 0;
  }
  static long count() { return uploads; }
};

// Indices that were not sent are beyond every buffer: shaders stay inside, and there is an error.
TEST(PairsFaultsUpload, OtherBytesThanWereSentAreNoticed) {
  const Scene scene = make_builtin_scene("two-spheres");
  const PairSettings settings{.views = parse_views("z"), .resolution = 24};
  const GlContext context;
  long uploads = 1, noticed = 0;
  std::vector<TrianglePair> right;
  for (long at = -1; at < uploads; ++at) {
    const OtherBytes fault(at);
    GlPairs backend(context);
    try {
      const auto found = find_pairs(scene, settings, backend).candidates;
      if (at < 0) right = found;
      // Some bytes stand for nothing, as the tag of a buffer that no program reads.
      EXPECT_EQ(found, right) << at;
    } catch (const Error&) {
      ++noticed;
    }
    if (at < 0) uploads = OtherBytes::count();
    EXPECT_EQ(find_pairs(scene, settings, backend).candidates, right) << "after " << at;
  }
  EXPECT_FALSE(right.empty());
  EXPECT_GE(noticed, 5) << "of " << uploads;
}

// Sums and echoes: old contents never pass for new ones. Where words were only multiplied by a
// number of their place, both cases did.
TEST(PairsFaultsSum, ChangesOfSignsDoNotCancel) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 20'000; ++trial) {
    std::vector<float> numbers(2 + random() % 40);
    for (float& x : numbers) x = static_cast<float>(random() % 1000 + 1) / 64;
    std::vector<float> mirrored = numbers;
    for (float& x : mirrored) x = -x;
    ASSERT_NE(gl_sum(std::as_bytes(std::span(numbers))),
              gl_sum(std::as_bytes(std::span(mirrored))));
  }
}

TEST(PairsFaultsSum, OtherNumbersHaveOtherEchoes) {
  std::set<std::uint32_t> echoes;
  const auto echo = [](std::int32_t width, std::int32_t height) {
    GlEcho out;
    out.add({1, 2, 3, 4});
    out.add(std::array<std::int32_t, 4>{0, width - 1, 0, height - 1});
    return out.sum;
  };
  EXPECT_NE(echo(512, 400), echo(535, 381));
  for (std::int32_t width = 500; width < 550; ++width)
    for (std::int32_t height = 370; height < 410; ++height) echoes.insert(echo(width, height));
  EXPECT_EQ(echoes.size(), 50u * 40u);
}

INSTANTIATE_TEST_SUITE_P(, PairsFaults, testing::Values(false, true),
                         [](const auto& info) { return info.param ? "Self" : "BetweenObjects"; });

}  // namespace
}  // namespace farcull
