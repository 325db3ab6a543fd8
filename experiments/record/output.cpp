// Turns a record into JSON and its colliding pairs into CSV.
#include "experiments/record/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>

#include "commit.h"
#include "core/gl/driver_threads.h"
#include "experiments/record/tables.h"
#include "verify/certificate/not_asked.h"
#include "verify/certificate/pair_list.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

Json view_json(const ViewReport& view) {
  Json budget = Json::object();
  for (const BudgetTerm& term : view.budget.terms()) budget[term.name] = term.px;
  budget["radius_px"] = view.radius_px;
  return {{"name", view.name},
          {"drawn", view.drawn},
          {"width", view.width},
          {"height", view.height},
          {"pixel_size", view.pixel_size},
          {"depth_step_px", view.depth_step_px},
          {"budget", budget}};
}

Json view_json(const PairView& view) {
  const PairCounts& c = view.counts;
  const auto or_null = [](double ms) { return ms < 0 ? Json(nullptr) : Json(ms); };
  return {{"name", view.name},
          {"looked", view.looked},
          {"reason", view.reason},
          {"width", view.width},
          {"height", view.height},
          {"pixel_size", view.pixel_size},
          {"widening_px", view.widening_px},
          {"listed", c.listed},
          {"entries", c.entries},
          {"crowded", c.crowded},
          {"large", c.large},
          {"tests", c.tests},
          {"bands", c.bands},
          {"undrawable", c.undrawable},
          {"dispatches", c.dispatches},
          {"readbacks", c.readbacks},
          {"redone", c.redone},
          {"mark_ms", c.mark_ms},
          {"list_ms", c.list_ms},
          {"pair_ms", c.pair_ms},
          {"mark_device_ms", or_null(c.mark_device_ms)},
          {"list_device_ms", or_null(c.list_device_ms)},
          {"pair_device_ms", or_null(c.pair_device_ms)}};
}

// What drawing asked of a GL device.
Json device_work_json(const CanvasWork& work) {
  if (work.passes == 0) return nullptr;
  const std::optional<double> ms = work.known_ms();
  return {{"passes", work.passes},
          {"draw_calls", work.draws},
          {"dispatches", work.dispatches},
          {"state_changes", work.state_changes},
          {"queries", work.queries},
          {"readbacks", work.readbacks},
          {"waits", work.waits},
          {"uploaded_bytes", work.uploaded_bytes},
          {"downloaded_bytes", work.downloaded_bytes},
          {"device_ms", ms ? Json(*ms) : Json(nullptr)}};
}

Json budget_json(const std::vector<ViewReport>& views) {
  const ViewReport* widest = widest_budget(views);
  return widest ? view_json(*widest)["budget"] : Json(nullptr);
}

Json device_json(const Record& record) {
  if (record.found.device.cpu) {
    Json out = {{"cpu", record.found.device.note}};
    if (draws(record.options.method)) {
      out["lanes"] = record.found.device.lanes;
      out["depth_bits"] = record.found.device.depth_bits;
    }
    return out;
  }
  if (!record.found.device.gl) return {{"none", record.found.device.note}};
  const GlInfo& device = *record.found.device.gl;
  Json out = {{"vendor", device.vendor},
              {"renderer", device.renderer},
              {"version", device.version},
              {"glsl", device.glsl},
              {"subpixel_bits", device.subpixel_bits},
              {"depth_bits", record.found.device.depth_bits},
              {"reset_detection", device.reset_detection},
              {"threads",
               device.kind == "software" ? Json(driver_threads(device.renderer)) : Json(nullptr)}};
  out["reason"] = record.found.device.note;
  if (chooses_views(record.options.method)) out.erase("depth_bits");
  return out;
}

Json environment_json(const FloatingPoint& floating_point) {
  return {{"rounding", to_string(floating_point.rounding)},
          {"flushes_results", floating_point.flushes_results},
          {"flushes_operands", floating_point.flushes_operands}};
}

Json verdict_json(const Record& record) {
  if (!record.promise.verdict) return nullptr;
  const DeviceVerdict& v = *record.promise.verdict;
  const auto or_null = [](const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
  };
  return {{"holds", v.holds},           {"probes", v.probes},
          {"failed", v.failed},         {"made", v.made},
          {"remembered", v.remembered}, {"ms", v.ms},
          {"file", or_null(v.file)},    {"problem", or_null(v.problem)},
          {"note", or_null(v.note)}};
}

std::uint64_t self_objects(const Scene& scene) {
  return static_cast<std::uint64_t>(
      std::count_if(scene.objects.begin(), scene.objects.end(),
                    [](const Object& object) { return object.self; }));
}

Json verification_json(const Scene& scene, const Record& record) {
  const std::optional<Accounting>& accounting = record.verification;
  if (!accounting) return nullptr;
  return {{"pairs_total", accounting->pairs_total},
          {"ignored", accounting->ignored},
          {"pairs_kept", accounting->pairs_kept},
          {"certified_by_boxes", accounting->certified_by_boxes},
          {"certified_by_predicates", accounting->certified_by_predicates},
          {"neighbours", accounting->neighbours},
          {"false_negatives", accounting->false_negatives},
          {"touching", record.missed ? Json(record.missed->touching) : Json(nullptr)},
          {"penetrating", record.missed ? Json(record.missed->penetrating) : Json(nullptr)},
          {"examples", pairs_json(scene, accounting->examples)},
          {"ms", accounting->ms}};
}

Json contacts_json(const Record& record) {
  if (record.options.contacts == ContactDetail::none) return nullptr;
  Json out = Json::object();
  for (const auto& [kind, count] : count_kinds(record)) out[std::string(name_of(kind))] = count;
  return out;
}

Json ignored_json(const Record& record) {
  if (record.options.ignored.empty()) return nullptr;
  return {{"object_pairs", record.options.ignored.size()}, {"candidates", record.found.ignored}};
}

// Six cells: the ends of a segment, or a point twice.
void append_ends(const ContactShape& shape, std::string& out) {
  for (const Vec3& end : shape.ends) {
    for (const double x : end) {
      out += ',';
      if (shape.dimension == 0 || shape.dimension == 1)
        fmt::format_to(std::back_inserter(out), "{}", x);
    }
  }
}

}  // namespace

nlohmann::ordered_json pairs_json(const Scene& scene, const std::vector<TrianglePair>& pairs) {
  const std::vector<std::uint32_t> owner = owners(scene);
  Json out = Json::array();
  for (const TrianglePair& pair : pairs) {
    out.push_back(
        {{"a", place_json(scene, owner, pair.a)}, {"b", place_json(scene, owner, pair.b)}});
  }
  return out;
}

nlohmann::ordered_json floating_point_json(const FloatingPoint& callers,
                                           const FloatingPoint& used) {
  return {{"callers", environment_json(callers)}, {"used", environment_json(used)}};
}

Json not_asked_json(const Scene& scene) {
  const NotAsked unasked = not_asked(scene);
  return {{"objects", unasked.objects}, {"pairs", unasked.pairs}, {"which", unasked.ranges}};
}

Json scene_json(const Scene& scene, std::uint64_t degenerate_triangles, const std::string& hash) {
  constexpr std::size_t kNamed = 100;
  const std::string nothing = nothing_to_test(scene).reason;
  Json folded = Json::array();
  for (const FoldedFace& f : std::span(scene.folded).first(std::min(kNamed, scene.folded.size())))
    folded.push_back({{"object", scene.objects[f.object].name}, {"face", f.face}});
  return {{"name", scene.name},
          {"objects", scene.objects.size()},
          {"self_objects", self_objects(scene)},
          {"self_not_asked", not_asked_json(scene)},
          {"nothing_to_test", nothing.empty() ? Json(nullptr) : Json(nothing)},
          {"triangles", scene.triangles.size()},
          {"degenerate_triangles", degenerate_triangles},
          {"folded_polygons", scene.folded.size()},
          {"folded", folded},
          {"hash", hash}};
}

Json stages_json(const std::vector<Stage>& trace) {
  Json stages = Json::array();
  for (const Stage& s : trace) {
    stages.push_back({{"name", name_of(s)},
                      {"ran", s.ran},
                      {"depends", s.depends},
                      {"reason", reason_of(s)},
                      {"ms", s.ms},
                      {"in", s.in},
                      {"out", s.out},
                      {"unit", to_string(s.unit)},
                      {"draws", s.draws},
                      {"queries", s.queries},
                      {"draws_saved", s.draws_saved},
                      {"queries_saved", s.queries_saved}});
  }
  return stages;
}

Json place_json(const Scene& scene, const std::vector<std::uint32_t>& owner,
                std::uint32_t triangle) {
  const Object& object = scene.objects[owner[triangle]];
  return {{"object", owner[triangle]},
          {"name", object.name},
          {"triangle", triangle - object.first_triangle},
          {"face", scene.source_face[triangle]}};
}

namespace {

Json value_json(const OptionValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* whole = std::get_if<int>(&value)) return *whole;
  if (const auto* real = std::get_if<double>(&value)) return *real;
  return nullptr;
}

}  // namespace

nlohmann::ordered_json to_json(const Scene& scene, const Record& record) {
  const RunOptions& o = record.options;
  Json views = Json::array();
  for (const ViewReport& view : record.found.views()) views.push_back(view_json(view));
  for (const PairView& view : record.found.pair_views()) views.push_back(view_json(view));
  const std::optional<std::uint64_t> swept = record.found.swept_triangles();
  Json out = {{"scene", scene_json(scene, record.degenerate_triangles, record.scene_hash)},
              {"method", to_string(o.method)},
              {"method_reason", method_reason(o)}};
  for (const Option& option : run_options()) {
    if (option.value) out[option.name] = value_json(option.value(o));
  }
  if (record.found.device.cpu) out["query"] = nullptr;
  const Json rest = {
      {"promises", record.promise.holds},
      {"promise_reason", record.promise.reason},
      {"verdict", verdict_json(record)},
      {"views", views},
      {"budget", budget_json(record.found.views())},
      {"device", device_json(record)},
      {"device_work", device_work_json(record.found.asked)},
      {"floating_point", floating_point_json(record.callers, record.used)},
      {"stages", stages_json(record.trace)},
      {"pcs", {{"objects", record.found.object_count}, {"triangles", record.found.triangle_count}}},
      {"object_triangles", swept ? Json(*swept) : Json(nullptr)},
      {"candidate_pairs", record.found.count},
      {"colliding_pairs", record.collisions.pairs.size()},
      {"neighbour_pairs", record.collisions.neighbour_pairs.size()},
      {"all_colliding_pairs",
       record.collisions.pairs.size() + record.collisions.neighbour_pairs.size()},
      {"neighbours", record.collisions.neighbours},
      {"contacts", contacts_json(record)},
      {"ignored", ignored_json(record)},
      {"limit", o.limit > 0 ? Json(o.limit) : Json(nullptr)},
      {"decided_pairs", record.decided},
      {"complete", record.complete},
      {"verification", verification_json(scene, record)},
      {"time_ms",
       {{"setup", record.ms.setup},
        {"cull", record.ms.cull},
        {"exact", record.ms.exact},
        {"total", record.ms.total},
        {"contacts", record.ms.contacts}}},
      {"seed", o.seed ? Json(*o.seed) : Json(nullptr)},
      {"commit", FARCULL_COMMIT}};
  out.update(rest);
  return out;
}

std::string pairs_header(const Scene& scene, const PairColumns& columns) {
  std::string header =
      columns.numbers ? pair_list_header(columns.numbers->self) : pair_list_header(scene);
  header.pop_back();
  if (columns.contacts) header += ",contact";
  if (columns.segments) header += ",x0,y0,z0,x1,y1,z1";
  if (columns.faces) header += ",face_a,face_b";
  return header + '\n';
}

std::string pairs_rows(const Scene& scene, const Record& record, const std::string& before,
                       const PairColumns& columns) {
  const PairListRows rows(scene, columns.numbers);
  std::string out;
  const auto add = [&](const std::vector<TrianglePair>& pairs,
                       const std::vector<ContactShape>& contacts, std::size_t k) {
    const TrianglePair& pair = pairs[k];
    if (!columns.kinds.empty() &&
        std::ranges::find(columns.kinds, contacts.at(k).kind) == columns.kinds.end()) {
      return;
    }
    out += before;
    rows.append(pair, out);
    out.pop_back();
    if (columns.contacts) out.append(",").append(name_of(contacts.at(k).kind));
    if (columns.segments) append_ends(contacts.at(k), out);
    if (columns.faces) {
      fmt::format_to(std::back_inserter(out), ",{},{}", scene.source_face[pair.a],
                     scene.source_face[pair.b]);
    }
    out += '\n';
  };
  const Collisions& all = record.collisions;
  std::size_t next = 0;
  for (std::size_t k = 0; k < all.pairs.size(); ++k) {
    for (; next < all.neighbour_pairs.size() && all.neighbour_pairs[next] < all.pairs[k]; ++next)
      add(all.neighbour_pairs, record.neighbour_contacts, next);
    add(all.pairs, record.contacts, k);
  }
  for (; next < all.neighbour_pairs.size(); ++next)
    add(all.neighbour_pairs, record.neighbour_contacts, next);
  return out;
}

std::string pairs_csv(const Scene& scene, const Record& record, const PairColumns& columns) {
  return pairs_header(scene, columns) + pairs_rows(scene, record, "", columns);
}

}  // namespace farcull
