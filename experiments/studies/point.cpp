// Converts points to the columns of a store and to text.
#include "experiments/studies/point.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "experiments/record/tables.h"

namespace farcull {
namespace {

// The texts of a column's values, in the order of the enumerators.
constexpr std::array kDepthFormats = {"float32", "fixed24"};
constexpr std::array kDepthModes = {"fragment", "fixed"};

template <class T, class Words>
std::optional<T> choice_of(const std::string& text, const Words& words) {
  if (text.empty()) return {};
  const auto at = std::find(words.begin(), words.end(), text);
  if (at == words.end())
    throw Error("depth", "'" + text + "' is no value of its column",
                "use the farcull that wrote it");
  return static_cast<T>(at - words.begin());
}

// Returns a key with only the columns that describe a scene.
PointKey key_of(const PointScene& scene) {
  struct Columns {
    PointKey operator()(const NamedScene& of) const { return {.scene = of.name}; }
    PointKey operator()(const MotionFrame& of) const {
      return {.scene = of.name, .frame = of.frame};
    }
    PointKey operator()(const ClothApart& of) const {
      return {.scene = of.name + "@apart", .frame = of.frame};
    }
    PointKey operator()(const PixelCorners&) const { return {.scene = "pixel-corners"}; }
    PointKey operator()(const ClusteredScene& of) const {
      return {.scene = fmt::format("clusters:{}@seed{}", of.ratio, of.seed)};
    }
    PointKey operator()(const ContactCells& of) const {
      return {.scene = fmt::format("contacts:{}:{}:{}", of.family, of.side, of.value)};
    }
  };
  return std::visit(Columns{}, scene);
}

PointKey key_of(const RunPoint& point) {
  PointKey key = key_of(point.scene);
  const std::string form = form_text({.method = point.method,
                                      .rounds = point.form.rounds,
                                      .clear = point.form.clear,
                                      .objects_alone = point.form.objects_alone,
                                      .conservative = point.form.conservative});
  key.method = to_string(point.method) + (form.empty() ? "" : " " + form);
  if (point.mean_pixels > 0) key.method += fmt::format(" @{}px", point.mean_pixels);
  key.offset = point.offset;
  key.radius = point.radius;
  key.depth_format = point.depth_format;
  key.depth_mode = point.depth_mode;
  key.resolution = point.resolution;
  key.views = point.form.views;
  return key;
}

PointKey key_of(const PeerPoint& point) {
  PointKey key = key_of(point.scene);
  key.method = point.peer;
  return key;
}

PointKey key_of(const NeighbourPoint& point) {
  PointKey key = key_of(point.scene);
  key.method = to_string(point.method);
  if (point.widening < 1) key.method += fmt::format(" --widening {}", point.widening);
  key.resolution = point.resolution;
  return key;
}

PointKey key_of(const DistancePoint& point) {
  PointKey key = key_of(point.scene);
  key.method = point.contestant + (point.task == DistanceTask::objects ? " objects" : " nearest");
  return key;
}

PointKey key_of(const LemmaPoint& point) {
  return {.scene = LemmaScene{point.generator, point.points, point.depth}.name(),
          .method = point.worst    ? "lemma-worst"
                    : point.coarse ? "lemma-fixed16"
                                   : "lemma",
          .offset = "obb",
          .radius = point.radius,
          .depth_format = point.depth_format,
          .depth_mode = point.depth_mode,
          .resolution = point.side,
          .seed = point.seed};
}

PointKey key_of(const PlacementPoint& point) {
  const std::string kind = point.pairs     ? fmt::format("pair{}", point.widening)
                           : point.grazing ? "grazing"
                                           : "crossing";
  const int bits = point.subpixel_bits;
  return {.scene = fmt::format("{}@{}:{}:{}", point.from, kind, point.side, point.placements),
          .method = bits > 0 ? fmt::format("far-snapped-{}", bits) : "far",
          .offset = "obb",
          .radius = point.radius,
          .depth_format = DepthFormat::float32,
          .depth_mode = DepthMode::fragment,
          .resolution = point.resolution,
          .seed = point.seed};
}

PointKey key_of(const LibraryPoint& point) {
  const std::string suite = !point.suite.empty() ? "suite-" + point.suite_name
                            : point.small        ? "small"
                                                 : "full";
  return {.scene = suite + "/" + point.question, .method = point.contestant, .seed = point.seed};
}

}  // namespace

std::string column_text(const std::optional<RadiusRule>& radius) {
  return radius ? radius_text(*radius) : "";
}
std::string column_text(const std::optional<DepthFormat>& format) {
  return format ? kDepthFormats[static_cast<std::size_t>(*format)] : "";
}
std::string column_text(const std::optional<DepthMode>& mode) {
  return mode ? kDepthModes[static_cast<std::size_t>(*mode)] : "";
}

template <>
std::optional<RadiusRule> column_of(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(parse_radius(text));
}
template <>
std::optional<DepthFormat> column_of(const std::string& text) {
  return choice_of<DepthFormat>(text, kDepthFormats);
}
template <>
std::optional<DepthMode> column_of(const std::string& text) {
  return choice_of<DepthMode>(text, kDepthModes);
}

int runs_of(const Point& point) {
  const auto runs = [](const auto& of) {
    if constexpr (requires { of.repeat; }) return of.repeat;
    return 1;
  };
  return std::visit(runs, point);
}

PointKey key_of(const Point& point) {
  return std::visit([](const auto& of) { return key_of(of); }, point);
}

std::vector<PointKey> keys_of(const std::vector<Point>& points) {
  std::vector<PointKey> out;
  for (const Point& point : points) out.push_back(key_of(point));
  return out;
}

std::string describe(const PointKey& key) {
  std::string out = key.scene;
  const auto add = [&out](const std::string& text) {
    if (!text.empty()) out += ", " + text;
  };
  add(key.method);
  add(key.offset);
  if (key.radius && key.radius != RadiusRule{}) add("radius " + column_text(key.radius));
  if (key.depth_format == DepthFormat::fixed24) add("24-bit depth");
  if (key.depth_mode == DepthMode::fixed) add("fixed-function depth");
  if (key.resolution > 0)
    add(fmt::format("{} {}", key.resolution, key.method.starts_with("voronoi") ? "cells" : "px"));
  if (!key.views.empty()) add("views " + key.views);
  if (key.frame >= 0) add(fmt::format("frame {}", key.frame));
  if (key.seed > 0) add(fmt::format("seed {}", key.seed));
  return out;
}

std::string describe(const Point& point) { return describe(key_of(point)); }

std::string LemmaScene::name() const {
  return fmt::format("lemma:{}:{}:{}", generator, points, depth);
}

LemmaScene parse_lemma_scene(const std::string& text) {
  const std::vector<std::string> words = split_list(text, ':');
  if (words.size() == 4 && words[0] == "lemma") {
    const auto points = parse_number<std::uint64_t>(words[2]);
    const auto depth = parse_number<double>(words[3]);
    if (points && depth) return {words[1], *points, *depth};
  }
  throw std::logic_error("parse_lemma_scene: " + text);
}

}  // namespace farcull
