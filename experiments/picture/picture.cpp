// Makes a picture: runs the methods, compares their pairs with all colliding pairs, and draws a
// panel for each method.
#include "experiments/picture/picture.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>

#include "commit.h"
#include "core/gl/picture/picture.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr long kUsualFrames = 30;
constexpr const char* kUsualView = "-0.45:-0.35:-0.82";

// Runs `parse`. If `parse` throws an Error, throws the same Error about `option` instead.
template <class Parse>
void as_option(const std::string& option, Parse parse) {
  try {
    parse();
  } catch (const Error& error) {
    throw Error(option, error.reason, error.remedy);
  }
}

constexpr Rgba kPaper = {255, 255, 255};
constexpr double kMargin = 0.04;     // margin around the scene, as a fraction of the picture's size
constexpr double kZoomMargin = 0.1;  // the same for a picture of the colliding triangles only

enum : std::uint8_t { kRest, kKept, kCollides };

// Draws each triangle in the colour of its `kind`. Then draws the colliding triangles `hit`
// translucently over triangles that hide them.
Image scene_image(const Scene& scene, const Window& window, const std::vector<std::uint8_t>& kind,
                  const std::vector<std::uint32_t>& hit, const GlContext& context) {
  const double line = line_of(window);
  std::vector<PictureTriangle> all;
  all.reserve(scene.triangles.size());
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    const Rgba plain = kObjectColours[o % kObjectColours.size()];
    Rgba idle = plain;
    blend(idle, kIdleColour, kIdlePart);
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count;
         ++t) {
      const bool collides = kind[t] == kCollides;
      all.push_back({.triangle = t,
                     .colour = collides           ? kFoundColour
                               : kind[t] == kKept ? idle
                                                  : plain,
                     .shaded = true,
                     .outline = static_cast<float>(collides ? 0.5 * line : 0),
                     .lift = static_cast<float>(collides ? line : 0)});
    }
  }
  Image image(window.width, window.height, kPaper);
  lay_over(image, painted(context, scene, window, all), 1);
  std::vector<PictureTriangle> through;
  for (const std::uint32_t t : hit) {
    through.push_back({.triangle = t,
                       .colour = kFoundColour,
                       .shaded = false,
                       .outline = static_cast<float>(0.5 * line)});
  }
  lay_over(image, painted(context, scene, window, through), kThrough);
  return image;
}

DrawnPanel panel_of(const RunOptions& options, const Scene& scene, const Window& window,
                    const TruePairs& truth, MeasurementContext& lab, const GlContext& context) {
  const MethodAnswer answer = answer_of(options, scene, lab);
  std::vector<std::uint8_t> kind(scene.triangles.size(), kRest);
  for (const std::uint32_t t : answer.idle) kind[t] = kKept;
  const std::vector<std::uint32_t> hit = members_of(truth.pairs);
  for (const std::uint32_t t : hit) kind[t] = kCollides;

  DrawnPanel panel;
  panel.result = answer.result;
  PanelResult& result = panel.result;
  if (lab.progress()) lab.progress()("drawing " + result.title);
  panel.sheet.image = scene_image(scene, window, kind, hit, context);
  result.rings = draw_missed(context, scene, window, answer.lost, panel.sheet.image);

  set_heading(panel);
  explain(panel, kFoundColour,
          "collide and found: " + counted(result.colliding - result.missed, "pair", "pairs"));
  if (result.missed > 0) {
    explain(panel, kMissedColour,
            fmt::format("missed: {} of {}", counted(result.missed, "pair", "pairs"),
                        counted(result.missed_triangles, "triangle", "triangles")));
  }
  explain_rings(panel, "misses that are easily overlooked");
  if (culls(options.method)) {
    Rgba idle = kObjectColours[0];
    blend(idle, kIdleColour, kIdlePart);
    explain(panel, idle,
            "kept, collide with nothing: " + counted(result.idle, "triangle", "triangles"));
  }
  return panel;
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
      {"Drawn by", drawn_by.vendor + ", " + drawn_by.renderer + ", " + drawn_by.version},
      {"Lettering", lettering_version()}};
  for (std::size_t i = 0; i < result.panels.size(); ++i) {
    const RunOptions& options = arguments.panels[i];
    const PanelResult& panel = result.panels[i];
    const int resolution = panel.drew ? resolution_of(options) : 0;
    const bool far = panel.drew && fattens(options.method);
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
                     const TruePairs& truth) {
  std::string out = counted(result.objects, "object", "objects") + ", " +
                    counted(result.triangles, "triangle", "triangles") + ", " +
                    counted(truth.pairs.size(), "colliding pair", "colliding pairs");
  if (arguments.frame) {
    const FrameRange range = frames_of(arguments);
    out += fmt::format(", frame {}", *arguments.frame);
    if (range.count() > 1) out += fmt::format(" of {} to {}", range.first, range.last);
  }
  return out;
}

Window window_of(const PictureArguments& arguments, const Scene& scene, const TruePairs& truth) {
  const View view = camera(arguments);
  std::vector<Box> boxes = triangle_boxes(scene);
  if (!arguments.zoom)
    return picture_window(view, boxes, arguments.width, arguments.height, kMargin, scene.name);
  std::vector<Box> hit;
  for (const std::uint32_t t : members_of(truth.pairs)) hit.push_back(boxes[t]);
  if (hit.empty()) throw Error("--zoom", "nothing collides in " + scene.name, "leave --zoom out");
  return picture_window(view, hit, arguments.width, arguments.height, kZoomMargin, scene.name);
}

}  // namespace

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

FrameRange frames_of(const PictureArguments& arguments) {
  if (arguments.frames) return *arguments.frames;
  const std::vector<std::string>& names = arguments.scene.names;
  const bool motion = names.size() == 1 && is_builtin_scene(names.front());
  if (motion) return {0, kUsualFrames - 1};
  return {*arguments.frame, *arguments.frame};
}

std::string command_of(const PictureArguments& arguments) {
  std::string out = "farcull picture";
  const auto add = [&](const std::string& word) { out += " " + quoted(word); };
  const auto option = [&](const std::string& name, const std::string& value) {
    add(name);
    add(value);
  };
  for (const std::string& word : arguments.scene.words()) add(word);
  const RunOptions& first = arguments.panels.front();
  if (arguments.panels.size() == 1) {
    option("--method", to_string(first.method));
    if (first.resolution > 0) option("--resolution", std::to_string(first.resolution));
  } else {
    std::string list;
    for (const RunOptions& options : arguments.panels) {
      list += (list.empty() ? "" : ",") + to_string(options.method);
      if (options.resolution > 0) list += fmt::format(":{}", options.resolution);
    }
    option("--compare", list);
  }
  for (const RunOptions& options : arguments.panels) {
    if (!fattens(options.method)) continue;
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
  for (const RunOptions& options : arguments.panels) validate(options);
  as_option("--view", [&] { parse_view(arguments.view.empty() ? kUsualView : arguments.view); });
  as_option("--up", [&] { parse_view(arguments.up.empty() ? "y" : arguments.up); });
  camera(arguments);
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

const Scene& open_scene(const PictureArguments& arguments, MeasurementContext& lab) {
  const std::vector<std::string> words = arguments.scene.words();
  if (words.size() == 1 && !arguments.self && !arguments.frame) return lab.scene(words.front());
  // Joins the parts of the key by '\n', since no name of a scene contains '\n'.
  std::string key = arguments.self ? "self\n" : "\n";
  for (const std::string& word : words) key += word + "\n";
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

MethodAnswer answer_of(RunOptions options, const Scene& scene, MeasurementContext& lab) {
  options.verify = false;
  options.device = lab.device();
  const Record record = run(scene, options, lab.session(), lab.progress());
  const std::vector<TrianglePair>& truth = lab.truth().pairs;
  std::vector<TrianglePair> found;
  std::ranges::set_union(record.collisions.pairs, record.collisions.neighbour_pairs,
                         std::back_inserter(found));
  const std::vector<std::uint32_t>& kept = record.found.triangles;
  const std::vector<std::uint32_t> hit = members_of(truth);
  MethodAnswer answer;
  std::ranges::set_difference(truth, found, std::back_inserter(answer.missed));
  std::ranges::set_difference(kept, hit, std::back_inserter(answer.idle));
  answer.lost = members_of(answer.missed);
  PanelResult& result = answer.result;
  const std::string not_drawn = not_drawn_text(record);
  result.title =
      not_drawn.empty() ? panel_title(options) : method_title(options) + ", " + not_drawn;
  result.drew = record.found.drew();
  result.colliding = truth.size();
  result.neighbours = truth.size() - without_neighbours(scene, lab.truth()).pairs.size();
  result.missed = answer.missed.size();
  result.missed_triangles = answer.lost.size();
  result.kept = kept.size();
  result.idle = answer.idle.size();
  // As in `farcull run`, guaranteed() depends only on the options, not on probes of the device.
  result.broken = guaranteed(record.options) && !answer.missed.empty();
  const UsedDevice& device = record.found.device;
  result.device = device.gl ? device.gl->renderer : device.cpu ? "cpu" : "none";
  result.headline = headline_of(result);
  return answer;
}

PictureResult make_picture(const PictureArguments& arguments, MeasurementContext& lab) {
  validate(arguments);
  const Scene& scene = open_scene(arguments, lab);
  if (scene.triangles.empty())
    throw Error(scene.name, "it has no triangles to draw", "give a scene that has some");
  for (const RunOptions& options : arguments.panels) require_scene(scene, options.method);
  const TruePairs& truth = lab.truth();
  const Window window = window_of(arguments, scene, truth);

  std::optional<GlContext> own;
  if (is_cpu(lab.device())) own.emplace();
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
    DrawnPanel panel = panel_of(options, scene, window, truth, lab, context);
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

}  // namespace farcull
