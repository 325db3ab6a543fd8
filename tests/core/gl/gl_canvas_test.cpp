// The GL canvas does what core/canvas/canvas.h specifies, and notices every fault of assumption A7.
#include "core/gl/base/driver_fault.h"
#include "offsets/offsets.h"
#include "tests/lab/gl.h"

namespace farcull {
namespace {

// Two layers of small triangles, near (z = -10) in item 2i and far (z = 10) in item 2i + 1, on a
// grid of cells.
struct Layers {
  Window window = lab::window(64);
  std::vector<Patch> patches;

  Layers() {
    for (int y = -24; y <= 24; y += 8) {
      for (int x = -24; x <= 24; x += 8)
        for (const double z : {-10.0, 10.0})
          patches.push_back(lab::patch({Vec3(x, y, z), Vec3(x + 2, y, z), Vec3(x, y + 2, z)}));
    }
  }
  int cells() const { return static_cast<int>(patches.size()) / 2; }

  // Stores one layer, then asks the other, a slot per cell.
  Pass pass(const Drawables& drawables, int stored, int asked) const {
    Pass p;
    for (int i = 0; i < cells(); ++i) lab::add(p.draws, drawables, 2 * i + stored, 0);
    const auto middle = static_cast<std::uint32_t>(p.draws.size());
    for (int i = 0; i < cells(); ++i) lab::add(p.draws, drawables, 2 * i + asked, i);
    p.slots = cells();
    p.steps = {{Verb::store, 0, middle},
               {Verb::ask, middle, static_cast<std::uint32_t>(p.draws.size()) - middle}};
    return p;
  }
};

struct Drawn {
  explicit Drawn(const Fattener& by = obb_fattener(), const GlCanvasOptions& options = {})
      : fattener(by), canvas(lab::context(), by.mode, by.solid, options) {
    canvas.begin(layers.window, drawables);
  }
  Layers layers;
  Fattener fattener;
  Drawables drawables = lab::fattened(layers.window, fattener, 0.75, layers.patches);
  GlCanvas canvas;
};

struct Setting {
  const char* name;
  Fattener (*fattener)();
  GlCanvasOptions options;
};

std::vector<Setting> settings() {
  return {{"flags", obb_fattener, {}},
          {"occlusion", obb_fattener, {.query = QueryMode::occlusion}},
          {"occlusion24",
           obb_fattener,
           {.depth_format = DepthFormat::fixed24, .query = QueryMode::occlusion}},
          {"raw flags", raw_triangles, {}},
          {"raw occlusion24",
           raw_triangles,
           {.depth_format = DepthFormat::fixed24, .query = QueryMode::occlusion}},
          {"surface occlusion", obb_surface_fattener, {.query = QueryMode::occlusion}},
          {"small blocks flags", obb_fattener, {.storage_limit = 500}},
          {"small blocks occlusion",
           obb_surface_fattener,
           {.query = QueryMode::occlusion, .storage_limit = 500}}};
}

TEST(GlCanvas, SeesWhatIsBehindAndNotWhatIsInFront) {
  for (const Setting& setting : settings()) {
    SCOPED_TRACE(setting.name);
    auto [layers, fattener, drawables, canvas] = Drawn(setting.fattener(), setting.options);
    EXPECT_EQ(canvas.run(layers.pass(drawables, 0, 1)),
              std::vector<std::uint8_t>(layers.cells(), 1));
    EXPECT_EQ(canvas.run(layers.pass(drawables, 1, 0)),
              std::vector<std::uint8_t>(layers.cells(), 0));
    EXPECT_EQ(canvas.run(layers.pass(drawables, 0, 0)),
              std::vector<std::uint8_t>(layers.cells(), 1))
        << "equal depths must be seen";
    Pass first = layers.pass(drawables, 0, 1);  // only the first cell is stored
    for (std::uint32_t d = drawables.first[1]; d < first.steps[0].count; ++d)
      first.draws[d] = first.draws[0];
    std::vector<std::uint8_t> seen(layers.cells(), 0);
    seen[0] = 1;
    EXPECT_EQ(canvas.run(first), seen) << "nothing is seen where nothing is stored";
    Pass everywhere = layers.pass(drawables, 1, 0);
    everywhere.draws[0] = {kEverywhere, 0};
    EXPECT_EQ(canvas.run(everywhere), std::vector<std::uint8_t>(layers.cells(), 1));
  }
}

// A step is one draw call for each element buffer that it reads, and one for the canvas's control
// items. With flags all answers come in one buffer, whatever the number of slots.
TEST(GlCanvas, AsksForFewDrawsAndReadbacks) {
  const Layers layers;
  const Fattener fattener = obb_fattener();
  const Drawables drawables = lab::fattened(layers.window, fattener, 0.75, layers.patches);
  for (const long limit : {0L, 16L * 7 * 20}) {
    for (const QueryMode query : {QueryMode::flags, QueryMode::occlusion}) {
      SCOPED_TRACE(std::to_string(limit));
      GlCanvas canvas(lab::context(), fattener.mode, fattener.solid,
                      {.query = query, .storage_limit = limit});
      canvas.begin(layers.window, drawables);
      const CanvasWork upload = canvas.work();
      const Pass pass = layers.pass(drawables, 0, 1);
      EXPECT_EQ(canvas.run(pass), std::vector<std::uint8_t>(layers.cells(), 1));
      CanvasWork work = canvas.work();
      work -= upload;
      const std::size_t bytes = drawables.elements() * 7 * 16;
      const std::size_t per_chunk = static_cast<std::size_t>(limit) / (7 * 16);
      const std::size_t chunks = limit == 0 ? 1 : drawables.elements() / (per_chunk - 1) + 1;
      EXPECT_EQ(upload.uploaded_bytes, bytes);
      EXPECT_EQ(upload.draws + upload.passes, 0u);
      EXPECT_EQ(upload.readbacks, 1u);
      EXPECT_EQ(work.passes, 1u);
      EXPECT_EQ(work.waits, 1u);
      // A draw is 8 bytes, and lists may have room between their batches.
      EXPECT_GE(work.uploaded_bytes, 8 * pass.draws.size());
      EXPECT_GT(work.dispatches, 0u);
      EXPECT_EQ(work.spans, 1u);
      EXPECT_EQ(work.timed > 0, work.device_ms > 0);  // the device has a clock, or not
      EXPECT_EQ(work.state_changes, pass.steps.size());
      if (query == QueryMode::flags) {
        EXPECT_LE(work.draws, pass.steps.size() * (1 + chunks));
        EXPECT_EQ(work.queries, 1u);
        EXPECT_EQ(work.readbacks, 2u);  // the report with the flags, and the number of primitives
        // Echoes, and a bit for each slot.
        EXPECT_LE(work.downloaded_bytes, 4 * (work.draws + work.dispatches + 16) + pass.slots / 8);
      } else {
        EXPECT_GE(work.queries, pass.slots);
        EXPECT_GE(work.readbacks, pass.slots);
        EXPECT_GE(work.downloaded_bytes, 4 * pass.slots);
      }
    }
  }
}

// The elements of three views stay on the device, and are compared with what they should be.
TEST(GlCanvas, SendsNothingTwice) {
  const Layers layers;
  const Fattener fattener = obb_fattener();
  GlCanvas canvas(lab::context(), fattener.mode, fattener.solid);
  std::vector<Drawables> views;
  for (const double radius : {0.5, 0.75, 1.0})
    views.push_back(lab::fattened(layers.window, fattener, radius, layers.patches));
  const std::vector<std::uint8_t> right(layers.cells(), 1);
  for (int frame = 0; frame < 3; ++frame) {
    for (const Drawables& view : views) {
      const std::uint64_t before = canvas.work().uploaded_bytes;
      canvas.begin(layers.window, view);
      EXPECT_EQ(canvas.work().uploaded_bytes - before, frame == 0 ? view.elements() * 7 * 16 : 0);
      EXPECT_EQ(canvas.run(layers.pass(view, 0, 1)), right);
    }
  }
  Drawables moved = views[1];
  moved.proxies.back().corners[0] -= 0.125f;
  const std::uint64_t before = canvas.work().uploaded_bytes;
  canvas.begin(layers.window, moved);
  EXPECT_EQ(canvas.work().uploaded_bytes - before, moved.elements() * 7 * 16);
  EXPECT_EQ(canvas.run(layers.pass(moved, 0, 1)), right);
}

TEST(GlCanvas, ReversedDepthTestIsADefectThatShows) {
  const lab::ReversedDepth reversed;
  auto [layers, fattener, drawables, canvas] = Drawn();
  EXPECT_THROW(canvas.run(layers.pass(drawables, 0, 1)), Error)
      << "a depth test that stores nothing loses the control item";
}

TEST(GlCanvas, NoticesEveryFault) {
  const Layers layers;
  const Fattener fattener = obb_fattener();
  const std::pair<QueryMode, DriverFaultKind> faults[] = {
      {QueryMode::flags, DriverFaultKind::lost_draw},
      {QueryMode::flags, DriverFaultKind::lost_dispatch},
      {QueryMode::flags, DriverFaultKind::oversized_dispatch},
      {QueryMode::flags, DriverFaultKind::unfinished_item},
      {QueryMode::occlusion, DriverFaultKind::lost_draw},
      {QueryMode::occlusion, DriverFaultKind::lost_query},
      {QueryMode::occlusion, DriverFaultKind::blind_queries}};
  // The fourth dispatch of a pass is past the last one, which packs the flags.
  for (std::size_t call = 0; call < 4; ++call) {
    for (const auto& [query, kind] : faults) {
      const bool of_dispatch = kind == DriverFaultKind::lost_dispatch ||
                               kind == DriverFaultKind::oversized_dispatch ||
                               kind == DriverFaultKind::unfinished_item;
      if (call > 0 && !of_dispatch) continue;
      SCOPED_TRACE(std::to_string(static_cast<int>(kind)) + " at " + std::to_string(call));
      std::optional<DriverFault> fault(kind);
      GlCanvas canvas(lab::context(), fattener.mode, fattener.solid, {.query = query});
      const Drawables drawables = lab::fattened(layers.window, fattener, 0.75, layers.patches);
      canvas.begin(layers.window, drawables);
      const Pass pass = layers.pass(drawables, 0, 1);
      const std::vector<std::uint8_t> right(layers.cells(), 1);
      EXPECT_EQ(canvas.run(pass), right);
      fault->strike(call);
      if (call == 3) {
        EXPECT_EQ(canvas.run(pass), right) << "a pass has three dispatches when nothing grows";
        continue;
      }
      EXPECT_THROW(canvas.run(pass), Error);
      fault.reset();
      EXPECT_THROW(canvas.run(pass), std::logic_error) << "nothing is believed any more";
      canvas.begin(layers.window, drawables);
      EXPECT_EQ(canvas.run(pass), right) << "the pass after a fault is a clean one";
    }
  }
}

// A driver that leaves out the last element of each draw that has more than one.
class ShortDraws {
  using Draw = GlEntryPoint<&epoxy_glDrawArrays>;
  static constexpr GLsizei kVertices = 6;  // of a proxy
  static void draw(GLenum mode, GLint first, GLsizei count) {
    Draw::original(mode, first, count > kVertices ? count - kVertices : count);
  }
  Draw draw_{draw};
};

// The first vertex of such a draw runs, and so do the control items. Only the number of primitives
// is wrong, and an item would not be seen.
TEST(GlCanvas, CountsPrimitives) {
  for (const QueryMode query : {QueryMode::flags, QueryMode::occlusion}) {
    auto [layers, fattener, drawables, canvas] = Drawn(obb_fattener(), {.query = query});
    const Pass pass = layers.pass(drawables, 0, 1);
    EXPECT_EQ(canvas.run(pass), std::vector<std::uint8_t>(layers.cells(), 1));
    const ShortDraws fault;
    EXPECT_TRUE(refuses("primitives were drawn", [&] { canvas.run(pass); }));
  }
}

TEST(GlCanvas, RefusesFlagsOn24BitDepth) {
  const Fattener fattener = obb_fattener();
  EXPECT_THROW(GlCanvas(lab::context(), fattener.mode, fattener.solid,
                        {.depth_format = DepthFormat::fixed24}),
               Error);
}

}  // namespace
}  // namespace farcull
