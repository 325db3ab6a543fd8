// The steps of a pass are cut into batches, one for each element buffer that a step reads in a row.
#include "core/gl/canvas_layout.h"

#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/gl/canvas_report.h"

namespace farcull {
namespace {

constexpr std::size_t kMaxControls = 400'000;  // kControlTop - kMaxControls * kControlGap > 0.75

class Layout {
 public:
  Layout(const CanvasShape& shape, const Pass& pass, bool marks, bool odd)
      : shape_(shape), pass_(pass), odd_(odd), marked_(!marks), asked_(!marks) {
    out_.serial = gl_number();
    out_.list.assign(kTagBytes / sizeof(GpuDraw), GpuDraw{0, 0});
    out_.slots = pass.slots;
    // It covers the window and nothing of the border.
    const double x = 0.5 * shape.width + 0.25, y = 0.5 * shape.height + 0.25;
    add_quad(-x, -y, x, y, 0.0f);
    own_elements_ = quad_elements();
  }

  void add_step(const Step& step) {
    fresh_ = true;
    for (std::uint32_t i = step.first; i < step.first + step.count; ++i) {
      const Draw& d = pass_.draws[i];
      if (d.element == kEverywhere) {
        for (std::size_t q = 0; q < quad_elements(); ++q)
          push(step.verb, kExtras, static_cast<std::uint32_t>(q), d.slot);
      } else {
        push(step.verb, d.element / shape_.per_chunk,
             static_cast<std::uint32_t>(d.element % shape_.per_chunk), d.slot);
      }
    }
    add_controls(step.verb);
    ++index_;
  }

  CanvasPass finish() {
    if (out_.list.size() % 2 != 0) out_.list.push_back({0, 0});  // sums take 16 bytes at a time
    return std::move(out_);
  }

 private:
  std::size_t quad_elements() const { return shape_.mode == DepthMode::fragment ? 1 : 2; }

  // A quadrilateral as elements at a fixed depth: one proxy or two triangles.
  void add_quad(double x0, double y0, double x1, double y1, float d) {
    std::vector<float>& own = out_.own;
    const float l = static_cast<float>(x0), b = static_cast<float>(y0), r = static_cast<float>(x1),
                t = static_cast<float>(y1);
    if (shape_.mode == DepthMode::fragment) {
      own.insert(own.end(), {l, b, r, b, r, t, l, t});
      own.insert(own.end(), 16, 0.0f);
      own.insert(own.end(), {0.0f, 1.0f, d, 0.0f});
    } else {
      own.insert(own.end(), {l, b, d, 1, r, b, d, 1, r, t, d, 1});
      own.insert(own.end(), {l, b, d, 1, r, t, d, 1, l, t, d, 1});
    }
  }

  void push(Verb verb, std::size_t chunk, std::uint32_t element, std::uint32_t slot) {
    if (fresh_ || out_.runs.back().chunk != chunk) {
      const std::size_t grain = shape_.grain;
      out_.list.resize((out_.list.size() + grain - 1) / grain * grain, GpuDraw{0, 0});
      const auto word = CanvasReport::kHead + static_cast<std::uint32_t>(out_.runs.size());
      out_.runs.push_back({index_, verb, chunk, out_.list.size(), 0});
      out_.list.push_back({out_.serial, word});
      fresh_ = false;
    }
    out_.list.push_back({element, slot});
    ++out_.runs.back().count;
  }

  // pixel: counted along the lower side of the target.
  void push_control(Verb verb, double depth, int pixel, std::uint32_t slot) {
    const double x = pixel - 0.5 * shape_.target_width, y = -0.5 * shape_.target_height;
    add_quad(x, y, x + 1, y + 1, static_cast<float>(depth));
    for (std::size_t q = 0; q < quad_elements(); ++q)
      push(verb, kExtras, static_cast<std::uint32_t>(own_elements_++), slot);
  }

  void add_controls(Verb verb) {
    const bool store = verb == Verb::store;
    stores_ += store;
    if (stores_ > kMaxControls) {
      throw Error("GL pass",
                  "more than " + std::to_string(kMaxControls) +
                      " owners (objects; for s-cullide triangles) are stored in one pass",
                  "join objects that cannot collide with each other, or use far-pairs");
    }
    if (store && !std::exchange(marked_, true)) push_control(Verb::store, kMark, odd_ ? 1 : 2, 0);
    if (!store && !std::exchange(asked_, true))
      push_control(Verb::ask, kAsked, odd_ ? 2 : 1, out_.slots++);
    const double behind = store || pass_.touching ? 0 : 0.5;
    push_control(verb, kControlTop - (static_cast<double>(stores_) - behind) * kControlGap, 0,
                 store ? 0 : out_.slots++);
  }

  const CanvasShape& shape_;
  const Pass& pass_;
  bool odd_;
  bool marked_, asked_;
  CanvasPass out_;
  std::size_t own_elements_ = 0;
  std::size_t stores_ = 0;
  std::size_t index_ = 0;  // of the step
  bool fresh_ = true;      // the next draw starts a batch
};

}  // namespace

CanvasPass lay_out(const CanvasShape& shape, const Pass& pass, bool marks, bool odd) {
  Layout out(shape, pass, marks, odd);
  if (marks && pass.steps.front().verb != Verb::store) out.add_step({Verb::store, 0, 0});
  for (const Step& step : pass.steps) out.add_step(step);
  if (marks && pass.steps.back().verb != Verb::ask) out.add_step({Verb::ask, 0, 0});
  return out.finish();
}

}  // namespace farcull
