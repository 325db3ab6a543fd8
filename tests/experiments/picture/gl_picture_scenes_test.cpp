// farcull picture on scenes: what is missed is seen, what is not is not claimed, and the file says
// where it came from.
#include <CLI/CLI.hpp>

#include "experiments/command/command.h"
#include "tests/experiments/picture/png_read.h"
#include "tests/lab/gl.h"

namespace farcull {
namespace {

MeasurementContext& shared_lab() {
  static MeasurementContext lab("");
  return lab;
}

// The arguments of a command line without -o; the name of the program before it does no harm.
PictureArguments picture_arguments(const std::string& words) {
  CLI::App app("farcull picture");
  PictureCommand command;
  command.add_to(app);
  app.parse(words.starts_with("farcull ") ? words.substr(8) : "picture " + words, false);
  return command.arguments();
}

PictureResult made(const std::string& words) {
  return make_picture(picture_arguments(words), shared_lab());
}

// Pixels of that colour in the picture of a panel: the legend and the headline are outside.
std::size_t pixels(const PictureResult& result, std::size_t panel, const Rgba& colour) {
  const PanelResult& p = result.panels[panel];
  std::size_t count = 0;
  for (int y = p.top; y < p.top + p.height; ++y)
    for (int x = p.left; x < p.left + p.width; ++x) count += result.image.at(x, y) == colour;
  return count;
}

TEST(GlPictureScenes, MissedPairsAreSeenForCullideAndNotForFar) {
  const PictureResult r =
      made("two-tori --compare cullide,far,exact --resolution 64 --size 300x300");
  ASSERT_EQ(r.panels.size(), 3u);
  EXPECT_GT(r.panels[0].missed, 0u);
  EXPECT_GT(pixels(r, 0, kMissedColour), 100u);
  for (const std::size_t panel : {1u, 2u}) {
    EXPECT_EQ(r.panels[panel].missed, 0u);
    EXPECT_EQ(pixels(r, panel, kMissedColour), 0u);
  }
  EXPECT_EQ(r.panels[0].headline, "missed " + std::to_string(r.panels[0].missed) + " of " +
                                      std::to_string(r.panels[0].colliding) + " colliding pairs");
}

TEST(GlPictureScenes, CountsAreThoseOfTheAccounting) {
  const PictureResult r = made("two-tori --method cullide --resolution 1024 --size 200x200");
  RunOptions options;
  options.method = Method::cullide;
  options.resolution = 1024;
  const Record record = run(make_builtin_scene("two-tori"), options, shared_lab().session());
  EXPECT_EQ(r.panels[0].missed, record.verification->false_negatives);
  EXPECT_EQ(r.panels[0].colliding - r.panels[0].missed, record.collisions.pairs.size());
  EXPECT_EQ(r.panels[0].kept, record.found.triangle_count);
  EXPECT_EQ(record.found.triangles.size(), record.found.triangle_count);
  EXPECT_EQ(r.scene_hash, record.scene_hash);
}

// A triangle of a tenth of a pixel, behind a wall of 20,000.
struct Hidden {
  Scene scene = make_builtin_scene("two-tori");
  std::uint32_t tiny = 0;
  Window window;
  Hidden() {
    std::vector<Box> boxes = triangle_boxes(scene);
    window = picture_window(parse_view("-1:-1:-1"), boxes, 300, 300, 0.04, "two-tori");
    const double s = 0.1 * window.pixel_size;
    const Vec3 at = 0.5 * boxes[0].lo + 0.5 * boxes[0].hi;
    tiny = static_cast<std::uint32_t>(scene.triangles.size());
    add_triangle(scene, {at, at + Vec3(s, 0, 0), at + Vec3(0, s, 0)});
    ++scene.objects.back().triangle_count;
  }
};

TEST(GlPictureScenes, ASingleTinyMissIsSeenAndRinged) {
  const Hidden hidden;
  const GlContext& context = shared_lab().session().context();
  Image image(300, 300, {255, 255, 255});
  EXPECT_EQ(draw_missed(context, hidden.scene, hidden.window, {hidden.tiny}, image), 1u);
  EXPECT_GE(std::ranges::count(image.pixels, kMissedColour), 1);
  const auto red = [](const Rgba& p) { return p.r > 200 && p.g < 140 && p.b < 190; };
  EXPECT_GE(std::ranges::count_if(image.pixels, red), 30);  // most of a ring
  // The twin: as the scene is drawn, without outline and ring, nobody would see it.
  const Image plain =
      painted(context, hidden.scene, hidden.window,
              {{.triangle = hidden.tiny, .colour = kMissedColour, .shaded = false}});
  EXPECT_TRUE(std::ranges::none_of(plain.pixels, [](const Rgba& p) { return p.a > 128; }));
}

TEST(GlPictureScenes, TheFileSaysWhereItCameFrom) {
  const PictureResult r =
      made("two-spheres --method far --resolution 64 --radius published --size 200x160");
  const PngContent back = png_content(to_png(r.image, r.texts));
  EXPECT_EQ(back.image.pixels, r.image.pixels);
  EXPECT_EQ(back.texts, r.texts);
  const auto text = [&](const std::string& key) {
    const auto found =
        std::ranges::find_if(back.texts, [&](const auto& entry) { return entry.first == key; });
    return found == back.texts.end() ? "absent" : found->second;
  };
  EXPECT_EQ(text("Scene hash"), r.scene_hash);
  EXPECT_EQ(
      text("Command"),
      "farcull picture two-spheres --method far --resolution 64 --radius published --size 200x160");
  EXPECT_NE(text("Commit"), "absent");
  EXPECT_TRUE(has_text(text("Drawn by"), shared_lab().session().context().info().version));
  EXPECT_TRUE(has_text(text("Panel 1"), "radius published"));
}

TEST(GlPictureScenes, TheCommandInTheFileAsksForTheSame) {
  for (const char* words :
       {"two-tori --compare cullide:64,far:32,exact --offset exact --zoom --view -x --up z",
        "mannequin-devil --method s-cullide --self --resolution 128",
        "'a b.obj' c.off --method boxes --size 301x200",
        "two-bunnies --method far --frame 3 --frames 2:9 --radius 0.5 --depth fixed"}) {
    const std::string once = command_of(picture_arguments(words));
    EXPECT_EQ(command_of(picture_arguments(once)), once) << words;
  }
}

}  // namespace
}  // namespace farcull
