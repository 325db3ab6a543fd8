// Probes assumptions A5 (depth tests, and the depths that they store) and A6 (occlusion queries).
#include <algorithm>
#include <array>

#include "core/gl/probe/target.h"
#include "embedded/canvas_frag.h"
#include "embedded/probe_frag.h"
#include "embedded/probe_memory_comp.h"

namespace farcull::probe {
namespace {

constexpr int kSide = 160;
constexpr std::size_t kPixels = static_cast<std::size_t>(kSide) * kSide;

// Returns random depths, one for each pixel. They lie in the range of the canvas's depth map, at
// the ends of this range, at depths of control items (core/gl/canvas/state.h), or anywhere. If
// `beside` is not empty, some depths are at most two floats away from beside[i] in pixel i.
std::vector<float> random_depths(Random& random, const std::vector<float>& beside) {
  std::vector<float> out(kPixels);
  for (std::size_t i = 0; i < kPixels; ++i) {
    const int way = random.below(8);
    float d = random.in_float(0, 0.96);
    if (way < 3) d = random.in_float(0.25, 0.75);
    if (way == 3) d = static_cast<float>(0.95 - random.below(800000) * 0x1p-22);
    if (way > 4 && !beside.empty()) d = neighbour(beside[i], random.below(5) - 2);
    if (way == 4) d = random.below(2) ? 0.25f : 0.75f;
    out[i] = std::clamp(d, 0.0f, 0.96f);
  }
  return out;
}

std::vector<Proxy> proxies_at(const std::vector<float>& depths) {
  std::vector<Proxy> out = pixel_proxies(kSide);
  for (std::size_t i = 0; i < kPixels; ++i) out[i].solid[4][2] = depths[i];
  return out;
}

// Stores layers of one proxy per pixel with GL_LESS, then tests proxies with GL_GEQUAL.
ProbeResult raw_depth_test(const ProbeOptions& options, DepthBuffer format) {
  constexpr std::size_t kLayers = 4;
  const bool floats = format == DepthBuffer::float32;
  Random random(options.seed + 7);
  Target target(kSide, kSide, format);
  const GlProgram program = proxy_program("depth", {embedded::probe_frag}, {"FAR_DEPTH"});
  std::array<std::vector<float>, kLayers> layers;
  std::vector<Proxy> proxies;
  for (std::vector<float>& layer : layers) {
    layer = random_depths(random, &layer == &layers[0] ? std::vector<float>() : layers[0]);
    const std::vector<Proxy> one = proxies_at(layer);
    proxies.insert(proxies.end(), one.begin(), one.end());
  }
  target.upload(proxies);
  // Clears the buffer and draws `count` layers. Returns the depths that the buffer then holds.
  const auto store = [&](std::size_t first, std::size_t count) {
    target.start();
    Target::depth_test(GL_LESS, true);
    target.use(program);
    target.draw(first * kPixels, count * kPixels);
    return target.depths();
  };
  // Draws each layer alone to read its rounded depths. All layers together must leave the minimum.
  std::vector<std::uint32_t> least(kPixels, 0xffffffff);
  std::vector<float> nearest(kPixels, 1);
  Worst wrong;
  for (std::size_t k = 0; k < kLayers; ++k) {
    const std::vector<std::uint32_t> alone = store(k, 1);
    for (std::size_t i = 0; i < kPixels; ++i) {
      if (floats) wrong.count(alone[i] != std::bit_cast<std::uint32_t>(layers[k][i]));
      least[i] = std::min(least[i], alone[i]);
      nearest[i] = std::min(nearest[i], layers[k][i]);
    }
  }
  const std::vector<std::uint32_t> kept = store(0, kLayers);
  for (std::size_t i = 0; i < kPixels; ++i) wrong.count(kept[i] != least[i]);

  std::uint64_t extra = 0;
  for (std::size_t k = 0; k < kLayers + 1; ++k) {
    // The last round tests each pixel at its stored depth: GL_GEQUAL must pass equal depths.
    std::vector<float> asked = k < kLayers ? layers[k] : nearest;
    if (k < kLayers) {
      for (float& d : asked) d = std::max(0.0f, neighbour(d, random.below(3) - 1));
    }
    // Stores all layers, then tests a proxy in each pixel. Pixel i gets the colour i + 1 if its
    // proxy passes the depth test.
    store(0, kLayers);
    target.upload(proxies_at(asked));
    Target::depth_test(GL_GEQUAL, false);
    const GLuint zero[4] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, zero);
    target.draw(0, kPixels);
    const std::vector<std::uint32_t> passed = target.colour();
    target.upload(proxies);
    for (std::size_t i = 0; i < kPixels; ++i) {
      const bool pass = passed[i] == i + 1, must = asked[i] >= nearest[i];
      extra += pass && !must;
      wrong.count(must ? !pass : pass && floats);
    }
  }
  std::string note =
      "LESS keeps the nearest of 4 layers, GEQUAL passes at and behind it; neighbours, equal "
      "depths, control depths";
  if (!floats) note += "; " + std::to_string(extra) + " passed that were less than a step nearer";
  return result("A5", floats ? "depth test, 32F" : "depth test, 24 bits", wrong, 0, "wrong pixels",
                note);
}

// Checks that a shader reads exactly the stored depth, bit for bit.
ProbeResult texels(const ProbeOptions& options) {
  constexpr int kSide = 256;
  constexpr std::uint32_t kPixels = kSide * kSide;
  Random random(options.seed + 12);
  Target target(kSide, kSide, DepthBuffer::float32);
  const GlProgram store = proxy_program("depth", {embedded::probe_frag}, {"FAR_DEPTH"});
  const GlProgram read = gl_program("probe texels", {"FAR_STEP 3"},
                                    {{GL_COMPUTE_SHADER, {embedded::probe_memory_comp}}});
  std::vector<Proxy> proxies = pixel_proxies(kSide);
  std::vector<float> depths;
  for (std::uint32_t i = 0; i < kPixels; ++i) {
    // Depths: in the depth map's range, near its ends, anywhere in [0, 1), and exactly 0 or 1.
    float d = random.in_float(0.25, 0.75);
    if (i % 4 == 1) d = neighbour(random.below(2) ? 0.25f : 0.75f, random.below(9) - 4);
    if (i % 4 == 2) d = random.in_float(0, 1);
    if (i % 64 == 3) d = random.below(2) ? 0.0f : 1.0f;
    depths.push_back(d);
    proxies[i].solid[4][2] = d;
  }
  target.upload(proxies);
  target.start();
  Target::depth_test(GL_LEQUAL, true);
  target.use(store);
  target.draw(0, kPixels);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  GlBuffer got;
  bind_zeros(got, 1, kPixels);
  glUseProgram(read);
  glUniform1ui(0, kPixels);
  glUniform1ui(1, kSide);
  glUniform1i(2, 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, target.depth_texture());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_NONE);
  glDispatchCompute(kPixels / 64, 1, 1);  // 64 is local_size_x of probe_memory.comp
  Worst wrong;
  const std::vector<std::uint32_t> words = words_of(got, kPixels);
  for (std::uint32_t i = 0; i < kPixels; ++i) {
    const std::uint32_t kept =
        std::bit_cast<std::uint32_t>(depths[i]) ^ (options.damaged_texel && i == 77 ? 1u : 0u);
    wrong.count(words[i] != kept);
  }
  return result("A5", "texels of the depth buffer, 32F", wrong, 0, "wrong texels",
                "a shader reads what a draw stored, to the bit");
}

// Tests the canvas as a whole. In each pixel it stores a far and a near proxy. Then it tests a
// third proxy, at the depth of the near proxy or at most 32 floats from it.
ProbeResult canvas_depth_test(const std::string& name, const GlContext& context,
                              const ProbeOptions& options, const GlCanvasOptions& kind) {
  constexpr int kWindow = 64;
  constexpr std::uint32_t kSlots = kWindow * kWindow;
  constexpr std::ptrdiff_t kStored = std::ptrdiff_t{2} * kWindow * kWindow;  // stored proxies
  Random random(options.seed + 8);
  GlCanvas canvas(context, DepthMode::fragment, depth_solid(), kind);
  Worst wrong;
  for (const float reach : {3.0f, 100.0f, 8200.0f, 1048576.0f}) {
    Drawables drawables;
    std::vector<float> stored(kSlots), asked(kSlots);
    for (int layer = 0; layer < 3; ++layer) {
      std::vector<Proxy> proxies = pixel_proxies(kWindow);
      for (std::uint32_t i = 0; i < kSlots; ++i) {
        if (layer == 1) stored[i] = random.in_float(-0.9 * reach, 0.9 * reach);
        if (layer == 2)
          asked[i] = neighbour(stored[i], random.below(2) ? 0 : random.below(64) - 32);
        const float z = layer == 0 ? 0.95f * reach : layer == 1 ? stored[i] : asked[i];
        proxies[i].solid[0][2] = proxies[i].solid[0][3] = z;
      }
      drawables.proxies.insert(drawables.proxies.end(), proxies.begin(), proxies.end());
    }
    for (std::uint32_t i = 1; i <= 3 * kSlots; ++i) drawables.first.push_back(i);
    Pass pass;
    pass.slots = kSlots;
    for (std::uint32_t i = 0; i < 3 * kSlots; ++i) pass.draws.push_back({i, i % kSlots});
    pass.steps = {
        {Verb::store, 0, kSlots}, {Verb::store, kSlots, kSlots}, {Verb::ask, 2 * kSlots, kSlots}};
    canvas.begin(window(kWindow, kWindow, reach), drawables);
    const std::vector<std::uint8_t> seen = canvas.run(pass);
    std::vector<float> kept, exits;
    if (canvas.limits().depth_bits == 32) {
      const auto first = pass.draws.begin();
      kept = canvas.depths(Verb::store, {first, first + kStored});
      exits = canvas.depths(Verb::ask, {first + kStored, pass.draws.end()});
    }
    for (std::uint32_t i = 0; i < kSlots; ++i) {
      const bool must = asked[i] >= stored[i];
      wrong.count((must && !seen[i]) || (!kept.empty() && seen[i] != (exits[i] >= kept[i])));
    }
  }
  return result(
      "A5", name, wrong, 0, "wrong slots",
      "far and near proxies stored, each pixel asked as a slot of its own; unseen though at "
      "or behind what is stored, in windows of 3 to 2^20 px; 32F: seen exactly where the "
      "depths say so");
}

// Issues all single-pixel queries, then reads their results. Odd queries draw hidden proxies.
ProbeResult single_pixel_queries(const GlContext& context, const ProbeOptions& options) {
  Random random(options.seed + 9);
  constexpr std::size_t kQueries = 3000;
  Worst missed;
  std::uint64_t false_positives = 0, hidden = 0;
  const int side = largest_side(context);
  for (const auto& [width, height] : {std::pair{512, 512}, {side, 64}, {64, side}}) {
    Target target(width, height, DepthBuffer::float32);
    const GlProgram program =
        proxy_program("query", {kDepthSolid, embedded::canvas_frag}, {ask_define()});
    std::vector<Proxy> proxies;
    for (std::size_t i = 0; i < kQueries; ++i) {
      const double x = random.below(width) - 0.5 * width, y = random.below(height) - 0.5 * height;
      // Each proxy is a square around a pixel's centre. About half of the squares fill the pixel.
      const double d = random.below(2) ? 0 : random.below(7) / 16.0;
      proxies.push_back(box(x + d, y + d, x + 1 - d, y + 1 - d));
      proxies.back().solid[4][1] = 1;
      proxies.back().solid[4][2] = i % 2 == 0 ? (i % 4 == 0 ? 0.5f : 0.6f) : 0.4f;
    }
    target.upload(proxies);
    target.start(0.5);
    Target::depth_test(GL_GEQUAL, false);
    target.use(program);
    std::vector<GlQuery> queries;
    while (queries.size() < kQueries) queries.push_back(gl_make<GlQuery>(glGenQueries));
    for (std::size_t i = 0; i < kQueries; ++i) {
      glBeginQuery(GL_ANY_SAMPLES_PASSED, queries[i]);
      if (options.blind_queries) glEndQuery(GL_ANY_SAMPLES_PASSED);
      target.draw(i, 1);
      if (!options.blind_queries) glEndQuery(GL_ANY_SAMPLES_PASSED);
    }
    for (std::size_t i = 0; i < kQueries; ++i) {
      GLuint any = 0;
      glGetQueryObjectuiv(queries[i], GL_QUERY_RESULT, &any);
      if (i % 2 == 0) {
        missed.count(any == 0);
      } else {
        ++hidden;
        false_positives += any != 0;
      }
    }
    check_gl("probe queries");
  }
  return result("A6", "queries of single pixels", missed, 0, "missed",
                std::to_string(kQueries) + " in flight, targets up to " + std::to_string(side) +
                    " px; false positives " + std::to_string(false_positives) + " of " +
                    std::to_string(hidden));
}

// Tests rectangles of 1 to 400 pixels with the canvas. A rectangle has few visible pixels or none.
ProbeResult area_queries(const std::string& name, const GlContext& context,
                         const ProbeOptions& options, const GlCanvasOptions& kind) {
  constexpr int kWindow = 256;
  constexpr std::uint32_t kSlots = 4000, kOpen = 400;
  Random random(options.seed + 10);
  GlCanvas canvas(context, DepthMode::fragment, depth_solid(), kind);
  Drawables drawables;
  const auto add = [&](Proxy q, float z) {
    q.solid[0][2] = q.solid[0][3] = z;
    drawables.proxies.push_back(q);
    drawables.first.push_back(static_cast<std::uint32_t>(drawables.proxies.size()));
  };
  // Stores a far background (z = 50) and some near pixels (z = -50). The rectangles are tested
  // at z = 0, so they are seen only in the near pixels. `open` marks the near pixels.
  std::vector<std::uint8_t> open(std::size_t{kWindow} * kWindow);
  constexpr double kHalf = 0.5 * kWindow;
  add(box(-kHalf, -kHalf, kHalf, kHalf), 50);
  for (std::uint32_t i = 0; i < kOpen; ++i) {
    const int x = random.below(kWindow), y = random.below(kWindow);
    open[static_cast<std::size_t>(y) * kWindow + x] = 1;
    add(box(x - kHalf, y - kHalf, x + 1 - kHalf, y + 1 - kHalf), -50);
  }
  const std::uint32_t stores = static_cast<std::uint32_t>(drawables.proxies.size());
  std::vector<std::uint8_t> truth;
  while (truth.size() < kSlots) {
    const int w = 1 + random.below(20), h = 1 + random.below(20);
    const int x = random.below(kWindow - w), y = random.below(kWindow - h);
    std::uint8_t any = 0;
    for (int j = y; j < y + h; ++j) {
      for (int i = x; i < x + w; ++i) any |= open[static_cast<std::size_t>(j) * kWindow + i];
    }
    truth.push_back(any);
    constexpr double d = 0.25;
    add(box(x + d - kHalf, y + d - kHalf, x + w - d - kHalf, y + h - d - kHalf),
        options.blind_queries ? -99 : 0);
  }
  Pass pass;
  pass.slots = kSlots;
  for (std::uint32_t i = 0; i < drawables.elements(); ++i)
    pass.draws.push_back({i, i < stores ? 0 : i - stores});
  pass.steps = {{Verb::store, 0, stores}, {Verb::ask, stores, kSlots}};
  canvas.begin(window(kWindow, kWindow), drawables);
  const std::vector<std::uint8_t> seen = canvas.run(pass);
  Worst missed;
  std::uint64_t false_positives = 0, hidden = 0;
  for (std::uint32_t i = 0; i < kSlots; ++i) {
    if (truth[i]) missed.count(!seen[i]);
    hidden += !truth[i];
    false_positives += seen[i] && !truth[i];
  }
  return result("A6", name, missed, 0, "missed",
                "up to 400 px of which few pass; false positives " +
                    std::to_string(false_positives) + " of " + std::to_string(hidden));
}

}  // namespace

std::vector<ProbeResult> depth_tests(const GlContext& context, const ProbeOptions& options) {
  std::vector<ProbeResult> out = {raw_depth_test(options, DepthBuffer::float32),
                                  raw_depth_test(options, DepthBuffer::fixed24), texels(options)};
  on_canvases("A5", "canvas", canvas_depth_test, context, options, out);
  return out;
}

std::vector<ProbeResult> queries(const GlContext& context, const ProbeOptions& options) {
  std::vector<ProbeResult> out = {single_pixel_queries(context, options)};
  on_canvases("A6", "areas", area_queries, context, options, out);
  return out;
}

}  // namespace farcull::probe
