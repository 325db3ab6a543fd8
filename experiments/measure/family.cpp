// Runs every method on all frames of every scene, and writes the table, the CSV and the JSON.
#include "experiments/measure/family.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "commit.h"
#include "core/base/error.h"
#include "core/scene/scene.h"
#include "experiments/measure/harness.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/frames.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/text_table.h"
#include "verify/certificate/certificate.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

// A method of the table; far is listed once with each offset.
struct ListedMethod {
  Method method;
  std::string offset;
};

std::vector<ListedMethod> contestants(const FamilyArguments& arguments) {
  std::vector<Method> methods(all_methods().begin(), all_methods().end());
  if (arguments.methods) {
    methods.clear();
    for (const std::string& name : split_list(*arguments.methods))
      methods.push_back(parse_method(name, "--methods"));
  }
  std::vector<ListedMethod> out;
  for (const Method method : methods) {
    out.push_back({method, "obb"});
    if (fattens(method)) out.push_back({method, "exact"});
  }
  return out;
}

std::string label(const FamilyCell& cell) {
  return to_string(cell.method) + (cell.offset.empty() ? "" : ", " + cell.offset);
}

template <class Value>
double median_of(const FamilyCell& cell, Value value) {
  std::vector<double> values;
  for (const FamilyFrame& frame : cell.frames) values.push_back(static_cast<double>(value(frame)));
  return middle(std::move(values));
}

FamilyFrame frame_of(const Record& record, long frame) {
  FamilyFrame out{.frame = frame,
                  .ms = compared_ms(record),
                  .pcs_objects = record.found.object_count,
                  .pcs_triangles = record.found.triangle_count,
                  .object_triangles = record.found.swept_triangles().value_or(0),
                  .candidate_pairs = record.found.count,
                  .colliding_pairs = record.collisions.pairs.size(),
                  .neighbour_pairs = record.collisions.neighbour_pairs.size(),
                  .missed = {},
                  .missed_contacts = record.missed,
                  .broken = broken(record, false)};
  const Stage work = work_of(record.trace);
  out.queries = work.queries;
  out.draws = work.draws;
  out.queries_saved = work.queries_saved;
  out.draws_saved = work.draws_saved;
  if (record.verification) out.missed = record.verification->false_negatives;
  return out;
}

std::string device_of(const Record& record) {
  if (record.found.device.gl) return record.found.device.gl->renderer;
  return record.found.device.cpu ? "cpu" : "none";
}

void require_motion(const std::string& scene) {
  require_known(scene);
  if (!is_builtin_scene(scene) || has_motion(scene)) return;
  throw Error("--frames", "nothing in " + scene + " moves", "name one of " + moving_names());
}

// Gives the frames of a scene to one method after the other. Keeps frames if all together are not
// too many bytes, since a simulation may take longer than all methods together; else computes the
// motion again for each method.
class Frames {
 public:
  Frames(std::string scene, const FamilyArguments& arguments)
      : scene_(std::move(scene)), arguments_(arguments) {}

  const Scene& at(long frame) {
    const FrameRange& range = arguments_.range;
    const auto index = static_cast<std::size_t>(frame - range.first);
    if (index < kept_.size()) return kept_[index];
    // Every method starts at the first frame.
    if (!source_ || frame == range.first) {
      source_.emplace(std::vector{scene_}, range, arguments_.self);
      if (const std::optional<Error> missing = source_->missing()) throw *missing;
    }
    const Scene& scene = source_->at(frame);
    const std::size_t bytes =
        scene.vertices.size() * sizeof(Vec3) +
        scene.triangles.size() * (sizeof scene.triangles[0] + sizeof(std::uint32_t));
    if (index == kept_.size() && bytes * static_cast<std::size_t>(range.count()) <= kMostBytes)
      kept_.push_back(scene);
    return scene;
  }

 private:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 31;

  std::string scene_;
  const FamilyArguments& arguments_;
  std::optional<FrameSource> source_;
  std::vector<Scene> kept_;
};

// Runs one method on one scene; empty if the method has nothing to test in the scene.
std::optional<FamilyCell> run_cell(const std::string& scene, const ListedMethod& contestant,
                                   const FamilyArguments& arguments, Frames& frames,
                                   Session& session, const Progress& progress) {
  RunOptions options = arguments.options;
  options.method = contestant.method;
  options.offset = fattens(contestant.method) ? contestant.offset : "obb";
  if (!draws(contestant.method)) {
    options.resolution = 0;
    options.views = "";
    options.query.reset();
  }
  FamilyCell cell{.scene = scene,
                  .method = contestant.method,
                  .offset = fattens(contestant.method) ? contestant.offset : "",
                  .device = {},
                  .frames = {}};
  session.sweep().forget();
  bool asks = true;
  const auto run_frame = [&](long frame, const Progress& named) {
    if (!asks) return;
    if (named) named("moving");
    const Scene& moved = frames.at(frame);
    asks = has_self(moved) || !tests_self_alone(contestant.method);
    if (!asks) return;
    Scene unmarked;
    const bool strip = has_self(moved) && !tests_self(contestant.method);
    if (strip) {
      unmarked = moved;
      for (Object& object : unmarked.objects) object.self = false;
    }
    const Record record = run(strip ? unmarked : moved, options, session, named);
    if (cell.frames.empty()) {
      cell.objects = moved.objects.size();
      cell.triangles = moved.triangles.size();
      cell.pairs_not_asked = not_asked(strip ? unmarked : moved).pairs;
    }
    cell.promises = record.promise.holds;
    if (cell.device.empty() || record.found.device.gl) cell.device = device_of(record);
    cell.setup_ms += record.ms.setup;
    cell.frames.push_back(frame_of(record, frame));
  };
  for_each_frame(arguments.range, nullptr, progress, fmt::format("{}, {}, ", scene, label(cell)),
                 run_frame);
  return asks ? std::optional(cell) : std::nullopt;
}

std::string rate(double ms) { return ms > 0 ? fmt::format("{:.1f}", 1000 / ms) : "-"; }

}  // namespace

FrameTimes FamilyCell::times() const {
  std::vector<double> ms;
  for (const FamilyFrame& frame : frames) ms.push_back(frame.ms);
  return summary_of(ms);
}

std::optional<std::uint64_t> FamilyCell::missed() const {
  std::uint64_t sum = 0;
  for (const FamilyFrame& frame : frames) {
    if (!frame.missed) return std::nullopt;
    sum += *frame.missed;
  }
  return sum;
}

bool FamilyCell::broken() const {
  return std::any_of(frames.begin(), frames.end(),
                     [](const FamilyFrame& frame) { return frame.broken; });
}

PaperRate paper_rate(const std::string& scene) {
  const std::string base = scene.substr(0, scene.find_first_of(":@"));
  if (base == "tree-leaves") return {15, "FAR 2004, tree with leaves"};
  if (base == "bunny-dragon") return {15, "FAR 2004, bunny and dragon"};
  if (base == "cloth") return {13, "FAR 2004, cloth"};
  return {};
}

std::vector<FamilyCell> run_family(const FamilyArguments& arguments, const Progress& progress) {
  std::vector<std::string> scenes = arguments.scenes;
  if (scenes.empty()) {
    for (const BuiltinScene& scene : builtin_scenes()) {
      if (has_motion(scene.name)) scenes.push_back(scene.name);
    }
  }
  const std::vector<ListedMethod> methods = contestants(arguments);
  // Checks all names before the first run, not after an hour of runs.
  for (const std::string& scene : scenes) require_motion(scene);
  Session session(arguments.options.device);
  std::vector<FamilyCell> cells;
  for (const std::string& scene : scenes) {
    Frames frames(scene, arguments);
    for (const ListedMethod& contestant : methods) {
      std::optional<FamilyCell> cell =
          run_cell(scene, contestant, arguments, frames, session, progress);
      if (cell) cells.push_back(std::move(*cell));
    }
  }
  if (cells.empty()) {
    throw Error("--methods", "none of them has a question to ask of these scenes",
                "add --self, or name other methods");
  }
  return cells;
}

std::string broken(const std::vector<FamilyCell>& cells) {
  for (const FamilyCell& cell : cells) {
    if (cell.broken()) {
      return fmt::format("{}: {} missed {}", cell.scene, label(cell),
                         counted(cell.missed().value_or(0), "pair", "pairs"));
    }
  }
  return "";
}

std::string family_table(const std::vector<FamilyCell>& cells) {
  Table table("lrlrrrrrrrrr");
  table.add({"scene", "triangles", "method", "fps", "p95", "paper, 2004", "objects", "triangles",
             "pairs", "queries", "draws", "missed"});
  for (const FamilyCell& cell : cells) {
    const FrameTimes times = cell.times();
    const PaperRate paper = paper_rate(cell.scene);
    const auto count = [&](auto value) {
      return grouped(static_cast<std::uint64_t>(median_of(cell, value)));
    };
    const std::optional<std::uint64_t> missed = cell.missed();
    table.add({cell.scene, grouped(cell.triangles), label(cell), rate(times.median),
               rate(times.p95), paper.fps > 0 ? fmt::format("{:.0f}", paper.fps) : "",
               count([](const FamilyFrame& f) { return f.pcs_objects; }),
               count([](const FamilyFrame& f) { return f.pcs_triangles; }),
               count([](const FamilyFrame& f) { return f.candidate_pairs; }),
               count([](const FamilyFrame& f) { return f.queries; }),
               count([](const FamilyFrame& f) { return f.draws; }),
               missed ? grouped(*missed) + (cell.broken() ? " BROKEN" : "") : "-"});
  }
  return table.text() +
         "\nfps: frames per second from moved vertices to exact pairs, median and at the 95th "
         "percentile of\n"
         "the times; paper, 2004: as published, on hardware of 2004 with other meshes, so the "
         "ratio "
         "to ours is\nno speed-up. objects, triangles, pairs: kept for the exact tests, queries, "
         "draws: "
         "of a frame,\nmedians; missed: in all frames together.\n" +
         (std::any_of(cells.begin(), cells.end(),
                      [](const FamilyCell& cell) { return cell.pairs_not_asked > 0; })
              ? "not asked: whether an object meets itself (--self, by the methods that can).\n"
              : "");
}

std::string family_csv(const std::vector<FamilyCell>& cells) {
  std::map<std::pair<std::string, long>, const FamilyFrame*> swept;
  for (const FamilyCell& cell : cells) {
    if (cell.method != Method::i_collide) continue;
    for (const FamilyFrame& frame : cell.frames) swept[{cell.scene, frame.frame}] = &frame;
  }
  std::string out = fmt::format(
      "scene,method,offset,frame,ms,pcs_objects,pcs_triangles,{},missed_touching,"
      "missed_penetrating,factor_objects,factor_triangles,factor_pairs\n",
      fmt::join(field_names<FamilyFrame>(), ","));
  for (const FamilyCell& cell : cells) {
    for (const FamilyFrame& f : cell.frames) {
      const auto found = swept.find({cell.scene, f.frame});
      const auto factor = [&](std::uint64_t theirs, std::uint64_t ours) {
        return ours > 0 && theirs > 0
                   ? fmt::format("{:.6g}", static_cast<double>(theirs) / static_cast<double>(ours))
                   : "";
      };
      const FamilyFrame none;
      const FamilyFrame& box = found == swept.end() ? none : *found->second;
      out += fmt::format(
          "{},{},{},{},{:.3f},{},{},{},{},{},{},{}\n", csv_cell(cell.scene), to_string(cell.method),
          cell.offset, f.frame, f.ms, f.pcs_objects, f.pcs_triangles, csv_of(f),
          f.missed_contacts
              ? fmt::format("{},{}", f.missed_contacts->touching, f.missed_contacts->penetrating)
              : ",",
          factor(box.object_triangles, f.pcs_triangles), factor(box.pcs_triangles, f.pcs_triangles),
          factor(box.candidate_pairs, f.candidate_pairs));
    }
  }
  return out;
}

nlohmann::ordered_json family_json(const std::vector<FamilyCell>& cells,
                                   const FamilyArguments& arguments) {
  Json rows = Json::array();
  for (const FamilyCell& cell : cells) {
    Json frames = Json::array();
    for (const FamilyFrame& f : cell.frames) {
      Json one = {{"frame", f.frame},
                  {"ms", f.ms},
                  {"pcs", {{"objects", f.pcs_objects}, {"triangles", f.pcs_triangles}}}};
      one.update(json_of(f));
      one["missed_contacts"] = f.missed_contacts
                                   ? Json{{"touching", f.missed_contacts->touching},
                                          {"penetrating", f.missed_contacts->penetrating}}
                                   : Json(nullptr);
      frames.push_back(std::move(one));
    }
    const PaperRate paper = paper_rate(cell.scene);
    rows.push_back({{"scene", cell.scene},
                    {"objects", cell.objects},
                    {"triangles", cell.triangles},
                    {"method", to_string(cell.method)},
                    {"offset", text_json(cell.offset)},
                    {"device", cell.device},
                    {"promises", cell.promises},
                    {"pairs_not_asked", cell.pairs_not_asked},
                    {"ms", json_of(cell.times())},
                    {"setup_ms", cell.setup_ms},
                    {"paper", paper.fps > 0 ? Json{{"fps", paper.fps}, {"source", paper.source}}
                                            : Json(nullptr)},
                    {"frames", frames}});
  }
  return {{"experiment", "family"},
          {"frames", {arguments.range.first, arguments.range.last}},
          {"resolution", arguments.options.resolution},
          {"commit", FARCULL_COMMIT},
          {"cells", rows}};
}

}  // namespace farcull
