// States of the cloth that are kept in files: an interrupted simulation goes on with the same bits,
// and no file is believed that is not what was written.
#include "experiments/scenes/cloth/cloth.h"

#include "experiments/scenes/builtin/scenes.h"
#include "tests/lab/test.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 24;  // from rest, through the sphere, to the first folds

ClothSettings stiff() {
  ClothSettings settings;
  settings.triangles = 200;
  settings.stiffness = 1e6;
  return settings;
}

// Every bit that the steps to come may depend on, and of the report.
std::vector<std::uint64_t> bits_of(const ClothState& s) {
  std::vector<std::uint64_t> out;
  const auto add = [&](double value) { out.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (const double value : s.positions) add(value);
  for (const double value : s.velocities) add(value);
  const ClothReport& r = s.report;
  for (const double value :
       {r.kinetic, r.elastic, r.bending, r.gravitational, r.contact, r.residual, r.slack})
    add(value);
  for (const long value :
       {r.frame, long{r.iterations}, long{r.converged}, long{s.was_stiff}, long(r.warning.size())})
    out.push_back(static_cast<std::uint64_t>(value));
  return out;
}

std::vector<std::vector<std::uint64_t>> uninterrupted(const ClothSettings& settings, int frames) {
  Cloth cloth(settings);
  std::vector<std::vector<std::uint64_t>> out = {bits_of(cloth.state())};
  for (int i = 0; i < frames; ++i) {
    cloth.step();
    out.push_back(bits_of(cloth.state()));
  }
  return out;
}

class KeptClothFiles : public testing::Test {
 protected:
  ~KeptClothFiles() override { ::unsetenv("FARCULL_CLOTH"); }
  ScratchFolder scratch_;
  const std::string folder_ = scratch_.path("kept");
};

// An interruption is a new simulation that has only the last file. Where the solver's memory is
// dropped, the twin, steps differ.
TEST_F(KeptClothFiles, GoOnWithTheSameBitsWhereverTheyWereInterrupted) {
  const auto whole = uninterrupted(stiff(), kFrames);
  const KeptCloth kept(folder_, stiff());
  EXPECT_EQ(kept.last(kFrames), 0);
  int stiff_steps = 0, forgetful_differ = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    Cloth cloth(stiff()), forgetful(stiff());
    if (frame > 0) {
      ClothState state = kept.read(kept.last(frame));
      cloth.restore(state);
      stiff_steps += state.was_stiff;
      state.was_stiff = !state.was_stiff;
      forgetful.restore(state);
    }
    ASSERT_EQ(bits_of(cloth.state()), whole[frame]) << frame;
    cloth.step();
    forgetful.step();
    EXPECT_EQ(bits_of(cloth.state()), whole[frame + 1]) << frame;
    forgetful_differ += bits_of(forgetful.state()) != whole[frame + 1];
    kept.write(cloth.state());
    EXPECT_EQ(kept.last(kFrames), frame + 1);
    EXPECT_EQ(bits_of(kept.read(frame + 1)), whole[frame + 1]) << frame;
  }
  EXPECT_GT(stiff_steps, 0);
  EXPECT_GT(forgetful_differ, 0);
}

TEST_F(KeptClothFiles, RefuseEveryChangedBitAndEveryTruncation) {
  const KeptCloth kept(folder_, stiff());
  Cloth cloth(stiff());
  cloth.step();
  kept.write(cloth.state());
  const std::string path = kept.path(1), good = read_text(path);
  ASSERT_NO_THROW(kept.read(1));
  ASSERT_GT(good.size(), 1000u);
  // A prime step reaches every part of the file, and every bit of a byte.
  for (std::size_t bit = 0; bit < 8 * good.size(); bit += 97) {
    std::string bad = good;
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ (1 << bit % 8));
    write_text(path, bad);
    const Error error = error_of([&] { kept.read(1); });
    ASSERT_EQ(error.where, path) << bit;
    ASSERT_TRUE(has_text(error.remedy, "remove")) << bit;
  }
  for (std::size_t size = 0; size < good.size(); size += 97) {
    write_text(path, good.substr(0, size));
    ASSERT_EQ(error_of([&] { kept.read(1); }).where, path) << size;
  }
  write_text(path, good + "x");
  EXPECT_EQ(error_of([&] { kept.read(1); }).where, path);
  write_text(path, good);
  EXPECT_EQ(bits_of(kept.read(1)), bits_of(cloth.state()));
}

TEST_F(KeptClothFiles, RefuseWhatIsOfAnotherFrameOrAnotherCloth) {
  const KeptCloth kept(folder_, stiff());
  Cloth cloth(stiff());
  cloth.step();
  kept.write(cloth.state());
  fs::copy_file(kept.path(1), kept.path(2));
  EXPECT_TRUE(has_text(error_of([&] { kept.read(2); }).reason, "another frame"));
  ClothSettings other = stiff();
  other.friction = std::nextafter(other.friction, 1.0);
  const KeptCloth others(folder_, other);
  ASSERT_NE(others.path(1), kept.path(1));
  EXPECT_EQ(others.last(1), 0);
  fs::copy_file(kept.path(1), others.path(1));
  const Error error = error_of([&] { others.read(1); });
  EXPECT_EQ(error.where, others.path(1));
  EXPECT_TRUE(has_text(error.reason, "another cloth"));
  EXPECT_TRUE(has_text(error.remedy, "FARCULL_CLOTH"));
}

TEST_F(KeptClothFiles, NameTheFolderThatCannotBeMade) {
  write_text(folder_, "a file");
  EXPECT_TRUE(has_text(error_of([&] { KeptCloth(folder_, stiff()); }).where, folder_));
}

// The scene as commands have it: the frames that are there are read, and not simulated again.
TEST_F(KeptClothFiles, ServeTheSceneFrameByFrame) {
  const std::string name = "cloth:200:1e6";
  const auto vertices_at = [&](std::vector<long> frames) {
    MovingScene scene(name, kFrames);
    for (const long frame : frames) scene.at(frame);
    return std::pair(scene.at(frames.back()).vertices, scene.notes());
  };
  const auto plain = vertices_at({10});
  EXPECT_FALSE(fs::exists(folder_));
  ::setenv("FARCULL_CLOTH", folder_.c_str(), 1);
  EXPECT_EQ(vertices_at({4}).first, vertices_at({4}).first);
  EXPECT_EQ(vertices_at({10}), plain);
  EXPECT_EQ(vertices_at({10, 3, 10}), plain);
  const KeptCloth kept(folder_, stiff());
  EXPECT_EQ(kept.last(kFrames), 10);
  // Steps start from the file of frame 10: with another position in it, frame 11 is another.
  const auto next = vertices_at({11});
  fs::remove(kept.path(11));
  ClothState state = kept.read(10);
  state.positions[0] += 1e-3;
  kept.write(state);
  EXPECT_NE(vertices_at({11}).first, next.first);
  // A damaged file ends the run instead of being passed over.
  write_text(kept.path(11), "farcull");
  EXPECT_EQ(error_of([&] { vertices_at({11}); }).where, kept.path(11));
}

}  // namespace
}  // namespace farcull
