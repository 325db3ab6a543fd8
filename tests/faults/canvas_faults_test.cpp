// The canvas on GL with one call lost or one allocation failed at a time: what its passes answer is
// as without the fault, or there is an error; and the next use of the same canvas is right.
#include <regex>

#include "offsets/offsets.h"
#include "tests/faults/gl_calls.h"
#include "tests/lab/gl.h"

namespace farcull {
namespace {

using lab::expect_no_wrong_answer, lab::GlFault, lab::GlFaultOutcome;

struct Setting {
  const char* name;
  Fattener (*fattener)();
  GlCanvasOptions options;
  bool touching = true;
};
void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.name; }

const GlCanvasOptions kOcclusion{.query = QueryMode::occlusion};
const GlCanvasOptions kOcclusion24{.depth_format = DepthFormat::fixed24,
                                   .query = QueryMode::occlusion};

// Small triangles in a row of cells, a near one (item 2i) and a far one (2i + 1) in each.
struct Cells {
  static constexpr std::uint32_t kCells = 3;
  Window window;
  Drawables drawables;

  Cells(const Setting& setting, int side, double depth) : window(lab::window(side)) {
    std::vector<Patch> patches;
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const double x = 6.0 * i - 8;
      for (const double z : {-depth, depth})
        patches.push_back(lab::patch({Vec3(x, -4, z), Vec3(x + 3, -4, z), Vec3(x, 2, z)}));
    }
    drawables = lab::fattened(window, setting.fattener(), 0.75, patches);
  }

  // Each step draws these items; those that are asked get a slot each.
  Pass pass(bool touching,
            const std::vector<std::pair<Verb, std::vector<std::uint32_t>>>& steps) const {
    Pass out;
    out.touching = touching;
    for (const auto& [verb, items] : steps) {
      Step step{verb, static_cast<std::uint32_t>(out.draws.size()), 0};
      for (const std::uint32_t item : items)
        lab::add(out.draws, drawables, item, verb == Verb::ask ? out.slots++ : 0);
      step.count = static_cast<std::uint32_t>(out.draws.size()) - step.first;
      out.steps.push_back(step);
    }
    return out;
  }
  // Some are seen in each ask, some not; the second pass answers otherwise in every slot.
  Pass first(bool touching) const {
    return pass(touching, {{Verb::store, {0, 2}},
                           {Verb::ask, {1, 3, 5, 0}},
                           {Verb::store, {4}},
                           {Verb::ask, {5, 4}}});
  }
  Pass second(bool touching) const {
    return pass(touching, {{Verb::store, {5}}, {Verb::ask, {1, 3, 5, 0, 2, 4}}});
  }
};

class CanvasFaults : public testing::TestWithParam<Setting> {
 protected:
  const Setting& setting = GetParam();
  const Cells large{setting, 32, 10}, small{setting, 24, 20};
  std::optional<GlCanvas> canvas, other;
  std::vector<std::uint8_t> right;

  static void open(std::optional<GlCanvas>& to, const Setting& how) {
    const Fattener fattener = how.fattener();
    to.emplace(lab::context(), fattener.mode, fattener.solid, how.options);
  }
  void pass(const Cells& cells, bool is_first, std::vector<std::uint8_t>& answers) {
    const Pass p = is_first ? cells.first(setting.touching) : cells.second(setting.touching);
    const auto seen = canvas->run(p);
    answers.insert(answers.end(), seen.begin(), seen.end());
  }
  // Everything that a canvas goes through, from the first moment of its life.
  std::vector<std::uint8_t> life() {
    std::vector<std::uint8_t> out;
    if (!canvas) open(canvas, setting);
    canvas->begin(small.window, small.drawables);
    pass(small, true, out);
    pass(small, false, out);
    canvas->begin(large.window, large.drawables);
    pass(large, false, out);
    return out;
  }
  // Some passes of a canvas that has run, on a context that another has used since.
  std::vector<std::uint8_t> later() {
    std::vector<std::uint8_t> out;
    canvas->begin(large.window, large.drawables);
    pass(large, false, out);
    pass(large, true, out);
    return out;
  }
  void run_other() {
    const Setting how{"other", setting.fattener == obb_fattener ? minkowski_fattener : obb_fattener,
                      setting.options};
    const Cells cells(how, 32, 5);
    if (!other) open(other, how);
    other->begin(cells.window, cells.drawables);
    other->run(cells.first(true));
  }
  static bool mixed(const std::vector<std::uint8_t>& seen) {
    return std::ranges::count(seen, 1) > 0 && std::ranges::count(seen, 0) > 0;
  }
};

TEST_P(CanvasFaults, EveryLostCallOfALifeIsNoticed) {
  right = life();
  ASSERT_TRUE(mixed(right));
  const auto outcomes = lab::try_gl_faults(
      GlFault::drop, [&] { canvas.reset(); }, [&] { return life() == right; });
  EXPECT_GT(outcomes.size(), static_cast<std::size_t>(trials(200)));
  expect_no_wrong_answer("lost calls, life of a canvas", outcomes);
}

TEST_P(CanvasFaults, EveryLostCallOfALaterPassIsNoticed) {
  life();
  right = later();
  ASSERT_TRUE(mixed(right));
  const auto outcomes = lab::try_gl_faults(
      GlFault::drop,
      [&] {
        canvas->begin(small.window, small.drawables);
        std::vector<std::uint8_t> ignored;
        pass(small, false, ignored);
        run_other();
      },
      [&] { return later() == right; });
  EXPECT_GT(outcomes.size(), static_cast<std::size_t>(trials(100)));
  expect_no_wrong_answer("lost calls, later passes", outcomes);
}

TEST_P(CanvasFaults, EveryFailedAllocationIsNoticed) {
  right = life();
  const auto outcomes = lab::try_gl_faults(
      GlFault::out_of_memory, [&] { canvas.reset(); }, [&] { return life() == right; });
  EXPECT_GT(outcomes.size(), 4u);
  for (const GlFaultOutcome& o : outcomes)
    EXPECT_TRUE(o.threw && o.error.find("GL_OUT_OF_MEMORY") != std::string::npos)
        << o.at << ": " << o.error;
  expect_no_wrong_answer("failed allocations", outcomes);
}

INSTANTIATE_TEST_SUITE_P(
    , CanvasFaults,
    testing::Values(Setting{"ObbFlags", obb_fattener, {}},
                    Setting{"ObbOcclusion", obb_fattener, kOcclusion},
                    Setting{"ExactFlags", minkowski_fattener, {}},
                    Setting{"ExactOcclusion", minkowski_fattener, kOcclusion},
                    Setting{"ObbOcclusion24", obb_fattener, kOcclusion24},
                    Setting{"RawFlags", raw_triangles, {}},
                    Setting{"RawOcclusion", raw_triangles, kOcclusion},
                    Setting{"RawOcclusion24", raw_triangles, kOcclusion24},
                    Setting{"SurfaceOcclusion", obb_surface_fattener, kOcclusion},
                    Setting{"RawFlagsBehindOnly", raw_triangles, {}, false},
                    Setting{"RawOcclusionBehindOnly", raw_triangles, kOcclusion, false}),
    [](const auto& info) { return info.param.name; });

// Depths and samples, which the lemmas' tests and pictures read.
TEST(CanvasSampleFaults, EveryLostCallIsNoticed) {
  const Setting setting{"obb", obb_fattener, {}};
  const Cells cells(setting, 24, 10);
  const Fattener fattener = obb_fattener();
  GlCanvas canvas(lab::context(), fattener.mode, fattener.solid);
  std::vector<Draw> draws;
  for (const std::uint32_t item : {0u, 3u, 4u}) lab::add(draws, cells.drawables, item, 0);
  const auto read = [&] {
    std::vector<std::uint32_t> out;
    canvas.begin(cells.window, cells.drawables);
    const auto add = [&](const std::vector<float>& values) {
      for (const float value : values) out.push_back(std::bit_cast<std::uint32_t>(value));
    };
    for (const Verb verb : {Verb::store, Verb::ask}) {
      add(canvas.depths(verb, draws));
      add(canvas.samples(verb, draws));
    }
    const auto seen = canvas.run(cells.second(true));
    out.insert(out.end(), seen.begin(), seen.end());
    return out;
  };
  const auto right = read();
  const auto outcomes = lab::try_gl_faults(
      GlFault::drop, [&] { read(); }, [&] { return read() == right; });
  expect_no_wrong_answer("lost calls, samples and depths", outcomes);
}

// Functions that neither change GL's state or data nor bring data back.
const std::vector<std::string> kQuestions = listed(
    "glCheckFramebufferStatus,glGetBufferParameteri64v,glGetError,glGetFloatv,"
    "glGetFramebufferParameteriv,glGetGraphicsResetStatus,glGetGraphicsResetStatusKHR,"
    "glGetInteger64v,glGetIntegeri_v,glGetIntegerv,glGetProgramInfoLog,"
    "glGetProgramInterfaceiv,glGetProgramResourceiv,glGetProgramiv,glGetQueryiv,"
    "glGetShaderInfoLog,glGetShaderiv,glGetString,glGetTexParameteriv,glGetUniformLocation,"
    "glIsEnabled");

std::set<std::string> unlisted_calls(const std::string& text) {
  const std::set<std::string> hooked = lab::hooked_gl_calls();
  static const std::regex call("\\bgl[A-Z][A-Za-z0-9_]*");
  std::set<std::string> out;
  for (std::sregex_iterator i(text.begin(), text.end(), call), end; i != end; ++i)
    if (!hooked.contains(i->str()) && std::ranges::find(kQuestions, i->str()) == kQuestions.end())
      out.insert(i->str());
  return out;
}

TEST(CanvasFaultList, HasEveryCallOfTheSources) {
  const std::regex ours(".*/core/gl/(canvas/|base/objects|base/context).*");
  int files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(FARCULL_TEST_DIR "/../core/gl")) {
    const std::string name = entry.path().string();
    if (!entry.is_regular_file() || !std::regex_match(name, ours)) continue;
    ++files;
    for (const std::string& call : unlisted_calls(read_text(name)))
      ADD_FAILURE() << name << " calls " << call << ", which tests/faults/gl_calls.h does not drop";
  }
  EXPECT_GE(files, 8);
}

// Elements of storage buffers of a shader that are read or written without FAR_AT (objects.cpp),
// which keeps every index inside the buffer. Totals have places that no buffer decides.
std::set<std::string> unclamped(const std::string& text) {
  static const std::regex block("layout\\(std430[^{]*\\{([^}]*)\\}"), array("(\\w+)\\[\\]");
  std::set<std::string> out;
  const std::sregex_iterator end;
  for (std::sregex_iterator b(text.begin(), text.end(), block); b != end; ++b) {
    const std::string fields = (*b)[1];
    for (std::sregex_iterator a(fields.begin(), fields.end(), array); a != end; ++a) {
      const std::string name = (*a)[1];
      if (name != "counters" && std::regex_search(text, std::regex("\\b" + name + "\\[[^\\]]")))
        out.insert(name);
    }
  }
  return out;
}

TEST(CanvasFaultList, ShadersStayInsideTheirBuffers) {
  int files = 0, clamped = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(FARCULL_TEST_DIR "/../core/gl")) {
    const std::string name = entry.path().filename().string();
    const std::string kind = entry.path().extension().string();
    if (kind == ".cpp" || kind == ".h") continue;
    if (!name.starts_with("canvas.") && !name.starts_with("canvas_")) continue;
    ++files;
    const std::string text = read_text(entry.path());
    EXPECT_EQ(unclamped(text), std::set<std::string>()) << name;
    clamped += text.find("FAR_AT(") != std::string::npos;
  }
  EXPECT_EQ(files, 3);
  EXPECT_EQ(clamped, 3);
}

TEST(CanvasFaultListTwin, AnIndexWithoutABoundIsFound) {
  const std::string block = "layout(std430, binding = 1) buffer B { uvec4 tag; uint b[]; };\n";
  EXPECT_EQ(unclamped(block + "x = FAR_AT(b, i);"), std::set<std::string>());
  EXPECT_EQ(unclamped(block + "x = b[i];"), std::set<std::string>{"b"});
}

TEST(CanvasFaultListTwin, AnUnknownCallIsFound) {
  EXPECT_EQ(unlisted_calls("glGetError(); glDrawElements(GL_TRIANGLES); glUseProgram(0);"),
            std::set<std::string>{"glDrawElements"});
}

}  // namespace
}  // namespace farcull
