// The draw list of a pass: its steps cut into runs, with the canvas's own elements, by which lost
// commands are seen.
#include <utility>

#include "core/error.h"
#include "core/gl_canvas_parts.h"

namespace farcull {

// A quadrilateral of the canvas's own as elements at a fixed depth; one proxy or two triangles.
void GlCanvas::State::add_quad(std::vector<float>& out, double x0, double y0, double x1, double y1,
                               float d) const {
  const float l = static_cast<float>(x0), b = static_cast<float>(y0), r = static_cast<float>(x1),
              t = static_cast<float>(y1);
  if (mode == DepthMode::fragment) {
    out.insert(out.end(), {l, b, r, b, r, t, l, t});
    out.insert(out.end(), 16, 0.0f);
    out.insert(out.end(), {0.0f, 1.0f, d, 0.0f});
  } else {
    out.insert(out.end(), {l, b, d, 1, r, b, d, 1, r, t, d, 1});
    out.insert(out.end(), {l, b, d, 1, r, t, d, 1, l, t, d, 1});
  }
}

// pixel: counted along the lower side of the target.
void GlCanvas::State::add_control(std::vector<float>& out, float d, int pixel) const {
  const double x = pixel - 0.5 * target_width, y = -0.5 * target_height;
  add_quad(out, x, y, x + 1, y + 1, d);
}

// The canvas's own elements: the quad for kEverywhere, which covers the window and nothing of the
// border, and the control items. With `marks`, a pass begins with a store and ends with an ask,
// which have control items alone where the caller's do not, and the first of each carries the mark
// and asks for that of the pass before. Without, it has neither.
CanvasPass GlCanvas::State::lay_out(const Pass& pass, bool marks) const {
  CanvasPass out;
  out.serial = gl_number();
  out.list.assign(kTagBytes / sizeof(GpuDraw), GpuDraw{0, 0});
  out.slots = pass.slots;
  add_quad(out.own, -0.5 * window.width - 0.25, -0.5 * window.height - 0.25,
           0.5 * window.width + 0.25, 0.5 * window.height + 0.25, 0.0f);
  std::size_t own_elements = quad_elements();
  std::size_t stores = 0;
  bool fresh = true;  // the next draw starts a run
  bool marked = !marks, asked = !marks;
  const std::size_t grain = alignment / sizeof(GpuDraw);
  std::size_t index = 0;
  const auto push = [&](Verb verb, std::size_t chunk, std::uint32_t element, std::uint32_t slot) {
    if (fresh || out.runs.back().chunk != chunk) {
      out.list.resize((out.list.size() + grain - 1) / grain * grain, GpuDraw{0, 0});
      const auto word = CanvasReport::kHead + static_cast<std::uint32_t>(out.runs.size());
      out.runs.push_back({index, verb, chunk, out.list.size(), 0});
      out.list.push_back({out.serial, word});
      fresh = false;
    }
    out.list.push_back({element, slot});
    ++out.runs.back().count;
  };
  const auto push_control = [&](Verb verb, double depth, int pixel, std::uint32_t slot) {
    add_control(out.own, static_cast<float>(depth), pixel);
    for (std::size_t q = 0; q < quad_elements(); ++q)
      push(verb, kExtras, static_cast<std::uint32_t>(own_elements++), slot);
  };
  const auto add_step = [&](const Step& step) {
    fresh = true;
    for (std::uint32_t i = step.first; i < step.first + step.count; ++i) {
      const Draw& d = pass.draws[i];
      if (d.element == kEverywhere) {
        for (std::size_t q = 0; q < quad_elements(); ++q)
          push(step.verb, kExtras, static_cast<std::uint32_t>(q), d.slot);
      } else {
        push(step.verb, d.element / per_chunk, static_cast<std::uint32_t>(d.element % per_chunk),
             d.slot);
      }
    }
    const bool store = step.verb == Verb::store;
    stores += store;
    if (stores > kMaxControls) {
      throw Error("GL pass",
                  "more than " + std::to_string(kMaxControls) +
                      " owners (objects; for s-cullide triangles) are stored in one pass",
                  "join objects that cannot collide with each other, or use far-pairs");
    }
    if (store && !std::exchange(marked, true)) push_control(Verb::store, kMark, odd ? 1 : 2, 0);
    if (!store && !std::exchange(asked, true))
      push_control(Verb::ask, kAsked, odd ? 2 : 1, out.slots++);
    const double behind = store || pass.touching ? 0 : 0.5;
    push_control(step.verb, kControlTop - (static_cast<double>(stores) - behind) * kControlGap, 0,
                 store ? 0 : out.slots++);
    ++index;
  };
  if (marks && pass.steps.front().verb != Verb::store) add_step({Verb::store, 0, 0});
  for (const Step& step : pass.steps) add_step(step);
  if (marks && pass.steps.back().verb != Verb::ask) add_step({Verb::ask, 0, 0});
  if (out.list.size() % 2 != 0) out.list.push_back({0, 0});  // sums take 16 bytes at a time
  return out;
}

}  // namespace farcull
