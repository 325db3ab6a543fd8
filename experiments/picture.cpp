#include "experiments/picture.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "commit.h"
#include "core/error.h"
#include "experiments/builtin_scenes.h"
#include "experiments/output.h"
#include "experiments/scene_file.h"
#include "experiments/shell_word.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

constexpr Rgba kPaper = {255, 255, 255}, kGood = {0, 98, 84}, kFound = {0, 128, 116},
               kIdle = {240, 176, 32};
// Of the objects, in turn: pale, so that nothing but what collides has a strong colour.
constexpr std::array<Rgba, 8> kObjects = {{{176, 190, 210},
                                           {218, 214, 206},
                                           {186, 203, 184},
                                           {216, 204, 180},
                                           {196, 190, 214},
                                           {180, 206, 208},
                                           {222, 190, 168},
                                           {214, 192, 198}}};
constexpr double kIdlePart = 0.6;    // of kIdle in what was kept for nothing
constexpr double kThrough = 0.28;    // how strongly collisions shine through what hides them
constexpr double kMargin = 0.04;     // around the scene, of the picture's size
constexpr double kZoomMargin = 0.1;  // around what collides
// A disc of 2 sqrt(2) px contains a whole pixel wherever it lies: half a diagonal from its middle
// to that of the pixel, half a diagonal to its corners. So the colour of a miss is there, unmixed.
constexpr double kWholePixel = 2.83;
constexpr long kUsualFrames = 30;
constexpr const char* kUsualView = "-0.45:-0.35:-0.82";

/// Line widths follow the size of the picture.
double line_of(const Window& window) {
  return std::clamp(std::min(window.width, window.height) / 380.0, 1.0, 8.0);
}

// A view whose image is what an eye sees there: right, up and forward of a right-handed world.
View camera(const PictureArguments& arguments) {
  View view = parse_view(arguments.view.empty() ? kUsualView : arguments.view);
  const Vec3 forward = view.rows.row(2);
  Vec3 up = parse_view(arguments.up.empty() ? "y" : arguments.up).rows.row(2);
  if (forward.cross(up).norm() < 1e-6) {
    if (!arguments.up.empty()) {
      throw Error("--up", "it is the direction that --view looks along",
                  "give another axis to one of them");
    }
    up = Vec3(0, 0, forward[1] > 0 ? 1 : -1);
  }
  const Vec3 right = forward.cross(up).normalized();
  view.rows << right.transpose(), right.cross(forward).transpose(), forward.transpose();
  return view;
}

// The same under the name of an option of this command.
template <class Parse>
void as_option(const std::string& option, Parse parse) {
  try {
    parse();
  } catch (const Error& error) {
    throw Error(option, error.reason, error.remedy);
  }
}

FrameRange frames_of(const PictureArguments& arguments) {
  if (arguments.frames) return *arguments.frames;
  const bool motion = arguments.scene.size() == 1 && is_builtin_scene(arguments.scene.front());
  if (motion) return {0, kUsualFrames - 1};
  return {*arguments.frame, *arguments.frame};
}

const Scene& open_scene(const PictureArguments& arguments, Lab& lab) {
  if (arguments.scene.size() == 1 && !arguments.self && !arguments.frame)
    return lab.scene(arguments.scene.front());
  // No name of a scene holds a line feed.
  std::string key = arguments.self ? "self\n" : "\n";
  for (const std::string& part : arguments.scene) key += part + "\n";
  if (arguments.frame) {
    const FrameRange range = frames_of(arguments);
    key += fmt::format("{} of {}:{}", *arguments.frame, range.first, range.last);
  }
  if (lab.progress()) lab.progress()("reading the scene");
  return lab.scene(key, [&arguments] {
    if (arguments.frame) {
      FrameSource source(arguments.scene, frames_of(arguments), arguments.self);
      return source.at(*arguments.frame);
    }
    Scene scene = load_scene(arguments.scene);
    for (Object& object : scene.objects) object.self |= arguments.self;
    return scene;
  });
}

std::vector<TrianglePair> found_by(const RunRecord& record) {
  std::vector<TrianglePair> out;
  std::set_union(record.pairs.begin(), record.pairs.end(), record.neighbour_pairs.begin(),
                 record.neighbour_pairs.end(), std::back_inserter(out));
  return out;
}

std::string device_of(const RunRecord& record) {
  if (record.device) return record.device->renderer;
  return record.on_cpu ? "cpu" : "none";
}

DrawnPanel panel_of(const RunOptions& options, const Scene& scene, const Window& window,
                    const Truth& truth, Lab& lab, const GlContext& context) {
  const RunRecord record = run_scene(scene, options, lab.session(), lab.progress());
  const std::vector<TrianglePair> found = found_by(record);
  std::vector<TrianglePair> missed;
  std::set_difference(truth.pairs.begin(), truth.pairs.end(), found.begin(), found.end(),
                      std::back_inserter(missed));
  enum : std::uint8_t { kRest, kKept, kCollides };
  std::vector<std::uint8_t> kind(scene.triangles.size(), kRest);
  for (const std::uint32_t t : record.pcs) kind[t] = kKept;
  const std::vector<std::uint32_t> hit = members_of(truth.pairs);
  for (const std::uint32_t t : hit) kind[t] = kCollides;

  DrawnPanel panel;
  PanelResult& result = panel.result;
  result.title = panel_title(options);
  result.colliding = truth.pairs.size();
  result.missed = missed.size();
  result.kept = record.pcs.size();
  result.idle = static_cast<std::uint64_t>(std::count(kind.begin(), kind.end(), kKept));
  // As in run: whatever the probes of the device say.
  result.broken = promises(record.options) && !missed.empty();
  result.device = device_of(record);

  if (lab.progress()) lab.progress()("drawing " + result.title);
  const double line = line_of(window);
  std::vector<PictureTriangle> all;
  all.reserve(scene.triangles.size());
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    const Rgba plain = kObjects[o % kObjects.size()];
    Rgba idle = plain;
    blend(idle, kIdle, kIdlePart);
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count;
         ++t) {
      const bool collides = kind[t] == kCollides;
      all.push_back({.triangle = t,
                     .colour = collides           ? kFound
                               : kind[t] == kKept ? idle
                                                  : plain,
                     .shaded = true,
                     .outline = static_cast<float>(collides ? 0.5 * line : 0),
                     .lift = static_cast<float>(collides ? line : 0)});
    }
  }
  Image& image = panel.sheet.image;
  image = Image(window.width, window.height, kPaper);
  lay_over(image, painted(context, scene, window, all), 1);
  std::vector<PictureTriangle> through;
  for (const std::uint32_t t : hit) {
    through.push_back({.triangle = t,
                       .colour = kFound,
                       .shaded = false,
                       .outline = static_cast<float>(0.5 * line)});
  }
  lay_over(image, painted(context, scene, window, through), kThrough);
  const std::vector<std::uint32_t> lost = members_of(missed);
  result.missed_triangles = lost.size();
  result.rings = draw_missed(context, scene, window, lost, image);

  set_headline(panel, "missed");
  const auto entry = [&](Rgba colour, const std::string& text) {
    panel.sheet.legend.push_back({.sign = LegendEntry::Sign::box, .colour = colour, .text = text});
  };
  entry(kFound,
        fmt::format("collide and found: {} pairs", grouped(truth.pairs.size() - missed.size())));
  if (!missed.empty()) {
    entry(kMissedColour, fmt::format("missed: {} pairs of {} triangles", grouped(missed.size()),
                                     grouped(lost.size())));
  }
  if (result.rings > 0) {
    panel.sheet.legend.push_back({.sign = LegendEntry::Sign::ring,
                                  .colour = kMissedColour,
                                  .text = "misses that are easily overlooked"});
  }
  if (options.method != Method::exact) {
    Rgba idle = kObjects[0];
    blend(idle, kIdle, kIdlePart);
    entry(idle, fmt::format("kept, collide with nothing: {} triangle{}", grouped(result.idle),
                            result.idle == 1 ? "" : "s"));
  }
  return panel;
}

// "cullide", or "cullide:128" where the panel says so.
std::string panel_word(const RunOptions& options) {
  std::string out = to_string(options.method);
  if (options.resolution > 0) out += fmt::format(":{}", options.resolution);
  return out;
}

PngTexts provenance(const PictureArguments& arguments, const PictureResult& result,
                    const GlInfo& drawn_by) {
  PngTexts out = {
      {"Title", result.scene + ": collisions by farcull"},
      {"Software", "farcull"},
      {"Commit", FARCULL_COMMIT},
      {"Scene", result.scene},
      {"Scene hash", result.scene_hash},
      {"Command", command_of(arguments)},
      {"Drawn by", drawn_by.vendor + ", " + drawn_by.renderer + ", " + drawn_by.version}};
  for (std::size_t i = 0; i < result.panels.size(); ++i) {
    const RunOptions& options = arguments.panels[i];
    const PanelResult& panel = result.panels[i];
    const int resolution = resolution_of(options);
    const bool far = options.method == Method::far;
    out.emplace_back(
        fmt::format("Panel {}", i + 1),
        fmt::format("method {}; resolution {}; radius {}; offset {}; device {}; colliding {}; "
                    "missed {}; kept {}",
                    to_string(options.method),
                    resolution > 0 ? std::to_string(resolution) : std::string("none"),
                    far ? radius_text(options.radius) : "none", far ? options.offset : "none",
                    panel.device, panel.colliding, panel.missed, panel.kept));
  }
  return out;
}

std::string subtitle(const PictureArguments& arguments, const PictureResult& result,
                     const Truth& truth) {
  const auto counted = [](std::uint64_t n, const char* one) {
    return grouped(n) + " " + one + (n == 1 ? "" : "s");
  };
  std::string out = counted(result.objects, "object") + ", " +
                    counted(result.triangles, "triangle") + ", " +
                    counted(truth.pairs.size(), "colliding pair");
  if (arguments.frame) {
    const FrameRange range = frames_of(arguments);
    out += fmt::format(", frame {}", *arguments.frame);
    if (range.count() > 1) out += fmt::format(" of {} to {}", range.first, range.last);
  }
  if (arguments.depth_view) out += ", one view of the method's";
  return out;
}

Window window_of(const PictureArguments& arguments, const Scene& scene, const Truth& truth) {
  const View view = camera(arguments);
  std::vector<Box> boxes = triangle_boxes(scene);
  if (!arguments.zoom)
    return picture_window(view, boxes, arguments.width, arguments.height, kMargin, scene.name);
  std::vector<Box> hit;
  for (const std::uint32_t t : members_of(truth.pairs)) hit.push_back(boxes[t]);
  if (hit.empty()) throw Error("--zoom", "nothing collides in " + scene.name, "leave --zoom out");
  return picture_window(view, hit, arguments.width, arguments.height, kZoomMargin, scene.name);
}

// Groups of missed triangles that lie close together in the picture.
class Clusters2d {
 public:
  explicit Clusters2d(double reach) : reach_(reach) {}

  void add(double x, double y, double radius) {
    const std::pair cell(std::lround(x / reach_), std::lround(y / reach_));
    Group& group = cells_[cell];
    group.add(x - radius, y - radius);
    group.add(x + radius, y + radius);
  }

  struct Group {
    double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;
    void add(double x, double y) {
      x0 = std::min(x0, x), y0 = std::min(y0, y), x1 = std::max(x1, x), y1 = std::max(y1, y);
    }
    void add(const Group& other) {
      add(other.x0, other.y0);
      add(other.x1, other.y1);
    }
  };

  // Cells that touch, corners included, are one group.
  std::vector<Group> groups() const {
    std::vector<Group> out;
    std::map<std::pair<long, long>, bool> done;
    for (const auto& [cell, group] : cells_) {
      if (done[cell]) continue;
      done[cell] = true;
      Group all = group;
      std::vector<std::pair<long, long>> open = {cell};
      while (!open.empty()) {
        const auto [cx, cy] = open.back();
        open.pop_back();
        for (long dx = -1; dx <= 1; ++dx) {
          for (long dy = -1; dy <= 1; ++dy) {
            const auto next = cells_.find({cx + dx, cy + dy});
            if (next == cells_.end() || done[next->first]) continue;
            done[next->first] = true;
            all.add(next->second);
            open.push_back(next->first);
          }
        }
      }
      out.push_back(all);
    }
    return out;
  }

 private:
  double reach_;
  std::map<std::pair<long, long>, Group> cells_;
};

}  // namespace

Image painted(const GlContext& context, const Scene& scene, const Window& window,
              const std::vector<PictureTriangle>& triangles) {
  const int larger = std::max(window.width, window.height);
  return draw_picture(context, scene, window, triangles,
                      {.samples = larger <= 1200   ? 4
                                  : larger <= 2400 ? 3
                                                   : 2});
}

std::uint64_t draw_missed(const GlContext& context, const Scene& scene, const Window& window,
                          const std::vector<std::uint32_t>& missed, Image& image) {
  if (missed.empty()) return 0;
  const double line = line_of(window);
  std::vector<PictureTriangle> over;
  // What is farther apart than a ring is wide gets a ring of its own.
  const double ring = 11 * line;
  Clusters2d clusters(ring);
  for (const std::uint32_t t : missed) {
    over.push_back({.triangle = t,
                    .colour = kMissedColour,
                    .shaded = false,
                    .outline = static_cast<float>(std::max(kWholePixel, 1.5 * line))});
    Box box = Box::empty();
    for (const Vec3& corner : scene.corners(t)) box.add(to_pixel(window, corner).p);
    const Vec3 middle = 0.5 * (box.lo + box.hi);
    if (!(std::abs(middle[0]) <= window.width) || !(std::abs(middle[1]) <= window.height)) continue;
    const double radius = 0.5 * (box.hi - box.lo).head<2>().maxCoeff();
    clusters.add(0.5 * window.width + middle[0], 0.5 * window.height - middle[1], radius);
  }
  lay_over(image, painted(context, scene, window, over), 1);
  std::uint64_t rings = 0;
  for (const Clusters2d::Group& group : clusters.groups()) {
    const double size = std::max(group.x1 - group.x0, group.y1 - group.y0);
    if (size > 2 * ring) continue;  // seen without
    draw_ring(image, 0.5 * (group.x0 + group.x1), 0.5 * (group.y0 + group.y1),
              0.5 * size + 0.6 * ring, std::max(1.5, line), kMissedColour);
    ++rings;
  }
  return rings;
}

std::string panel_title(const RunOptions& options) {
  std::string out = to_string(options.method);
  if (options.method == Method::far) {
    if (options.offset != "obb") out += ", " + options.offset + " offset";
    const std::string radius = radius_text(options.radius);
    if (radius == "published") out += ", published radius";
    if (radius != "published" && radius != "budget") out += ", radius " + radius + " of the budget";
    if (depth_of(options) == DepthMode::fixed) out += ", fixed depth";
    if (out != to_string(options.method)) out += ",";
  }
  const int resolution = resolution_of(options);
  const bool has = draws(options.method) || options.method == Method::far_pairs;
  if (has && resolution > 0) out += fmt::format(" at {} px", resolution);
  return out;
}

void set_headline(DrawnPanel& panel, const std::string& verb) {
  const PanelResult& result = panel.result;
  panel.result.headline = fmt::format("{} {} of {} colliding pair{}", verb, grouped(result.missed),
                                      grouped(result.colliding), result.colliding == 1 ? "" : "s");
  panel.sheet.title = result.title;
  panel.sheet.headline = panel.result.headline;
  panel.sheet.headline_colour = result.missed > 0 ? kMissedColour : kGood;
}

std::string command_of(const PictureArguments& arguments) {
  std::string out = "farcull picture";
  const auto add = [&](const std::string& word) { out += " " + quoted(word); };
  const auto option = [&](const std::string& name, const std::string& value) {
    add(name);
    add(value);
  };
  for (const std::string& part : arguments.scene) add(part);
  const RunOptions& first = arguments.panels.front();
  if (arguments.panels.size() == 1) {
    option("--method", to_string(first.method));
    if (first.resolution > 0) option("--resolution", std::to_string(first.resolution));
  } else {
    std::string list;
    for (const RunOptions& options : arguments.panels)
      list += (list.empty() ? "" : ",") + panel_word(options);
    option("--compare", list);
  }
  for (const RunOptions& options : arguments.panels) {
    if (options.method != Method::far) continue;
    const std::string radius = radius_text(options.radius);
    if (radius != "budget") option("--radius", radius);
    if (options.offset != "obb") option("--offset", options.offset);
    if (options.depth) option("--depth", *options.depth == DepthMode::fixed ? "fixed" : "fragment");
    break;
  }
  if (!first.device.empty()) option("--device", first.device);
  if (arguments.self) add("--self");
  if (arguments.frame) {
    const FrameRange range = frames_of(arguments);
    option("--frame", std::to_string(*arguments.frame));
    option("--frames", fmt::format("{}:{}", range.first, range.last));
  }
  if (!arguments.view.empty()) option("--view", arguments.view);
  if (!arguments.up.empty()) option("--up", arguments.up);
  if (arguments.zoom) add("--zoom");
  // Its value may be left out, so what begins with - would be taken for another option.
  if (arguments.depth_view) add("--view-depth=" + *arguments.depth_view);
  option("--size", fmt::format("{}x{}", arguments.width, arguments.height));
  return out;
}

void validate(const PictureArguments& arguments) {
  if (arguments.panels.empty() || arguments.panels.size() > kMostPanels) {
    throw Error("--compare", fmt::format("{} panels do not fit", arguments.panels.size()),
                fmt::format("name 1 to {} methods", kMostPanels));
  }
  for (const int side : {arguments.width, arguments.height}) {
    if (side >= 64 && side <= kMostPicture) continue;
    throw Error("--size", fmt::format("{} px is outside 64 .. {}", side, kMostPicture),
                "give the width and height of a panel in that range, as in 900x760");
  }
  for (const RunOptions& options : arguments.panels) {
    validate(options);
    if (!arguments.depth_view || draws(options.method)) continue;
    throw Error("--view-depth", to_string(options.method) + " stores no depth",
                "use --method " + method_names(draws));
  }
  as_option("--view", [&] { parse_view(arguments.view.empty() ? kUsualView : arguments.view); });
  as_option("--up", [&] { parse_view(arguments.up.empty() ? "y" : arguments.up); });
  camera(arguments);
  if (arguments.depth_view) as_option("--view-depth", [&] { parse_view(*arguments.depth_view); });
  if (!arguments.frame) {
    if (!arguments.frames) return;
    throw Error("--frames", "says of how many, not which", "give --frame F as well");
  }
  const FrameRange range = frames_of(arguments);
  if (*arguments.frame < range.first || *arguments.frame > range.last) {
    throw Error(
        "--frame",
        fmt::format("{} is none of the frames {} to {}", *arguments.frame, range.first, range.last),
        "give one of these, or other --frames");
  }
}

PictureResult make_picture(const PictureArguments& arguments, Lab& lab) {
  validate(arguments);
  const Scene& scene = open_scene(arguments, lab);
  if (scene.triangles.empty())
    throw Error(scene.name, "it has no triangles to draw", "give a scene that has some");
  for (const RunOptions& options : arguments.panels) require_scene(scene, options.method);
  const Truth& truth = lab.truth();
  const Window window = window_of(arguments, scene, truth);

  std::optional<GlContext> own;
  if (lab.device() == "cpu") own.emplace();
  const GlContext& context = own ? *own : lab.session().context();
  PictureResult result;
  result.scene = scene.name;
  result.scene_hash = scene_hash(scene);
  result.objects = scene.objects.size();
  result.triangles = scene.triangles.size();
  result.not_asked = not_asked_line(scene);
  std::vector<SheetPanel> sheets;
  for (RunOptions options : arguments.panels) {
    options.verify = false;
    options.device = lab.device();
    DrawnPanel panel = arguments.depth_view
                           ? depth_panel(options, arguments, scene, truth, lab.session(), context)
                           : panel_of(options, scene, window, truth, lab, context);
    result.panels.push_back(std::move(panel.result));
    sheets.push_back(std::move(panel.sheet));
  }
  result.image =
      compose(scene.name, subtitle(arguments, result, truth), sheets,
              fmt::format("farcull {:.10}, {}", FARCULL_COMMIT, context.info().renderer));
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    result.panels[i].left = sheets[i].left;
    result.panels[i].top = sheets[i].top;
    result.panels[i].width = sheets[i].image.width;
    result.panels[i].height = sheets[i].image.height;
  }
  result.texts = provenance(arguments, result, context.info());
  return result;
}

PictureResult write_picture(const PictureArguments& arguments, Lab& lab, const std::string& path) {
  check_output(path);
  PictureResult result = make_picture(arguments, lab);
  write_output(path, to_png(result.image, result.texts));
  return result;
}

}  // namespace farcull
