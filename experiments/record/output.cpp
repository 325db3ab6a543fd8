// Converts a record to JSON, CSV and a certificate, and a plan to a table and JSON.
#include "experiments/record/output.h"

#include <algorithm>
#include <iterator>

#include "commit.h"
#include "core/base/parallel.h"
#include "core/gl/base/context.h"
#include "experiments/record/stage_words.h"
#include "experiments/record/tables.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

Json view_json(const ViewReport& view) {
  Json out = FARCULL_JSON(view, name, drawn, width, height, pixel_size, depth_step_px);
  Json& budget = out["budget"] = Json::object();
  for (const BudgetTerm& term : view.budget.terms()) budget[term.name] = term.px;
  budget["radius_px"] = view.radius_px;
  return out;
}

Json device_work_json(const CanvasWork& work) {
  if (work.passes == 0) return nullptr;
  Json out = {{"passes", work.passes}, {"draw_calls", work.draws}};
  out.update(FARCULL_JSON(work, dispatches, state_changes, queries, readbacks, waits,
                          uploaded_bytes, downloaded_bytes));
  out["device_ms"] = json_of(work.known_ms());
  return out;
}

Json device_json(const Record& record) {
  const UsedDevice& used = record.found.device;
  if (used.cpu) {
    Json out = {{"cpu", used.note}};
    out.update(FARCULL_JSON(used, lanes, depth_bits));
    return out;
  }
  if (!used.gl) return {{"none", no_device_reason(record.trace)}};
  Json out = gl_json(*used.gl);
  out["subpixel_bits"] = used.gl->subpixel_bits;
  out["depth_bits"] = used.depth_bits;
  out["reset_detection"] = used.gl->reset_detection;
  out["threads"] = threads_json(*used.gl);
  out["reason"] = used.note;
  return out;
}

Json environment_json(const FloatingPoint& floating_point) {
  return FARCULL_JSON(floating_point, rounding, flushes_results, flushes_operands);
}

Json verdict_json(const Record& record) {
  if (!record.promise.verdict) return nullptr;
  const DeviceVerdict& v = *record.promise.verdict;
  Json out = FARCULL_JSON(v, holds, probes, failed, made, remembered, ms);
  out["file"] = text_json(v.file);
  out["problem"] = text_json(v.problem);
  out["note"] = text_json(v.note);
  return out;
}

std::uint64_t self_objects(const Scene& scene) {
  return static_cast<std::uint64_t>(
      std::count_if(scene.objects.begin(), scene.objects.end(),
                    [](const Object& object) { return object.self; }));
}

Json verification_json(const Scene& scene, const Record& record) {
  const std::optional<Accounting>& accounting = record.verification;
  if (!accounting) return nullptr;
  Json out = json_of(*accounting);
  const ContactCounts missed = record.missed.value_or(ContactCounts{});
  out["touching"] = json_if(record.missed.has_value(), missed.touching);
  out["penetrating"] = json_if(record.missed.has_value(), missed.penetrating);
  out["examples"] = pairs_json(scene, accounting->examples);
  out["ms"] = accounting->ms;
  return out;
}

Json contacts_json(const Record& record) {
  if (record.options.contacts == ContactDetail::none) return nullptr;
  Json out = Json::object();
  for (const auto& [kind, count] : count_kinds(record)) out[std::string(name_of(kind))] = count;
  return out;
}

// Appends six cells: two ends of a segment, or a point twice. For other shapes, cells are empty.
void append_ends(const ContactShape& shape, std::string& out) {
  for (const Vec3& end : shape.ends) {
    for (const double x : end) {
      out += ',';
      if (shape.dimension == 0 || shape.dimension == 1)
        fmt::format_to(std::back_inserter(out), "{}", x);
    }
  }
}

// Appends a cell with the corners of the polygon that two triangles have in common. Blanks separate
// the coordinates. The cell is empty if the common part is not a polygon.
void append_polygon(const Scene& scene, const TrianglePair& pair, const ContactShape& shape,
                    std::string& out) {
  out += ',';
  if (shape.dimension != 2) return;
  const char* blank = "";
  for (const Vec3& p : contact_polygon(scene.corners(pair.a), scene.corners(pair.b))) {
    fmt::format_to(std::back_inserter(out), "{}{} {} {}", blank, p.x(), p.y(), p.z());
    blank = " ";
  }
}

// The assumptions about the device, with their names in docs/reliability.md.
std::vector<std::string> assumptions_about(const GlInfo& device) {
  std::vector<std::string> lines = {
      "A1: vertex arithmetic through the viewport transform errs by no more than its term of the "
      "budget",
      "A2: window coordinates snap by at most 2^-b px per axis, b = GL_SUBPIXEL_BITS",
      "A3: coverage is that of one common, infinitesimally shifted sample; zero snapped area "
      "covers nothing",
      "A4: fragment and compute arithmetic as GLSL 4.50, 4.7.1 promises, each program by itself",
      "A5: the depth test compares the depths that the buffer holds; with 24 bits a depth is one "
      "of the two neighbouring integers",
      "A6: a query is zero only if no sample passed",
      "A7: every command ran, or the failure is seen",
      "A8: what a dispatch or a draw wrote is seen after the barrier; atomics neither lose nor "
      "double",
      "A9: gl_FragCoord names the pixel of the fragment; flat inputs, uniforms and what is read "
      "from a buffer are what was sent, to the bit",
      "A10: the driver damages no memory of the process"};
  if (device.kind == "software")
    lines.back() +=
        "; it drew in " +
        counted(static_cast<std::uint64_t>(driver_threads(device.renderer)), "thread", "threads") +
        " of its own";
  return lines;
}

// A range of Collisions::pairs, and a range of Collisions::neighbour_pairs. In sorted order, the
// neighbours lie between these pairs.
struct RowRange {
  std::size_t pairs = 0, pairs_end = 0;
  std::size_t neighbours = 0, neighbours_end = 0;
};

class Rows {
 public:
  Rows(const Scene& scene, const Record& record, const std::string& before,
       const PairColumns& columns)
      : scene_(scene),
        record_(record),
        before_(before),
        columns_(columns),
        rows_(scene, columns.numbers) {}

  void append(const RowRange& range, std::string& out) const {
    const Collisions& all = record_.collisions;
    std::size_t next = range.neighbours;
    const auto neighbours_before = [&](const TrianglePair* pair) {
      for (; next < range.neighbours_end && (!pair || all.neighbour_pairs[next] < *pair); ++next)
        append(all.neighbour_pairs, record_.neighbour_contacts, next, out);
    };
    for (std::size_t k = range.pairs; k < range.pairs_end; ++k) {
      neighbours_before(&all.pairs[k]);
      append(all.pairs, record_.contacts, k, out);
    }
    neighbours_before(nullptr);
  }

 private:
  void append(const std::vector<TrianglePair>& pairs, const std::vector<ContactShape>& contacts,
              std::size_t k, std::string& out) const {
    const TrianglePair& pair = pairs[k];
    if (!columns_.kinds.empty() &&
        std::ranges::find(columns_.kinds, contacts.at(k).kind) == columns_.kinds.end()) {
      return;
    }
    out += before_;
    rows_.append(pair, out);
    out.pop_back();
    if (columns_.contacts) out.append(",").append(name_of(contacts.at(k).kind));
    if (columns_.segments) {
      append_ends(contacts.at(k), out);
      append_polygon(scene_, pair, contacts.at(k), out);
    }
    if (columns_.faces) {
      fmt::format_to(std::back_inserter(out), ",{},{}", scene_.source_face[pair.a],
                     scene_.source_face[pair.b]);
    }
    if (columns_.names) {
      for (const std::uint32_t t : {pair.a, pair.b})
        out.append(",").append(csv_cell(scene_.objects[place_of(scene_, t).object].name));
    }
    out += '\n';
  }

  const Scene& scene_;
  const Record& record_;
  const std::string& before_;
  const PairColumns& columns_;
  const PairListRows rows_;
};

// Divides the sorted pairs and neighbours into consecutive ranges. A range has at most kRows pairs
// and at most kRows neighbours.
std::vector<RowRange> ranges_of(const Collisions& all) {
  constexpr std::size_t kRows = std::size_t{1} << 15;
  const std::vector<TrianglePair>&pairs = all.pairs, &neighbours = all.neighbour_pairs;
  const auto before = [](const std::vector<TrianglePair>& some, const TrianglePair& pair) {
    return static_cast<std::size_t>(std::ranges::lower_bound(some, pair) - some.begin());
  };
  std::vector<RowRange> out;
  for (RowRange at; at.pairs < pairs.size() || at.neighbours < neighbours.size();) {
    at.pairs_end = std::min(at.pairs + kRows, pairs.size());
    at.neighbours_end =
        at.pairs_end < pairs.size() ? before(neighbours, pairs[at.pairs_end]) : neighbours.size();
    if (at.neighbours_end - at.neighbours > kRows) {
      at.neighbours_end = at.neighbours + kRows;
      at.pairs_end = before(pairs, neighbours[at.neighbours_end]);
    }
    out.push_back(at);
    at = {.pairs = at.pairs_end, .neighbours = at.neighbours_end};
  }
  return out;
}

}  // namespace

Json gl_json(const GlInfo& gl) { return FARCULL_JSON(gl, vendor, renderer, version, glsl); }

Json threads_json(const GlInfo& gl) {
  return json_if(gl.kind == "software", driver_threads(gl.renderer));
}

Json pair_json(const Scene& scene, const TrianglePair& pair) {
  const auto place = [&](std::uint32_t triangle) -> Json {
    const TrianglePlace at = place_of(scene, triangle);
    return {{"object", at.object},
            {"name", scene.objects[at.object].name},
            {"triangle", at.triangle},
            {"face", scene.source_face[triangle]}};
  };
  return {{"a", place(pair.a)}, {"b", place(pair.b)}};
}

Json pairs_json(const Scene& scene, const std::vector<TrianglePair>& pairs) {
  return json_list(pairs, [&](const TrianglePair& pair) { return pair_json(scene, pair); });
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
  Json folded = Json::array();
  for (const FoldedFace& f : std::span(scene.folded).first(std::min(kNamed, scene.folded.size())))
    folded.push_back({{"object", scene.objects[f.object].name}, {"face", f.face}});
  return {{"name", scene.name},
          {"objects", scene.objects.size()},
          {"self_objects", self_objects(scene)},
          {"self_not_asked", not_asked_json(scene)},
          {"nothing_to_test", text_json(nothing_to_test(scene).reason)},
          {"triangles", scene.triangles.size()},
          {"degenerate_triangles", degenerate_triangles},
          {"folded_polygons", scene.folded.size()},
          {"folded", folded},
          {"hash", hash}};
}

Json stages_json(const std::vector<Stage>& trace) {
  return json_list(trace, [](const Stage& s) {
    Json out = {
        {"name", name_of(s)}, {"ran", s.ran}, {"depends", s.depends}, {"reason", reason_of(s)}};
    out.update(FARCULL_JSON(s, ms, in, out, unit, draws, queries, draws_saved, queries_saved));
    return out;
  });
}

nlohmann::ordered_json to_json(const Scene& scene, const Record& record) {
  const RunOptions& o = record.options;
  Json views = nullptr;
  for (const ViewReport& view : record.found.views()) views.push_back(view_json(view));
  Json out = {{"scene", scene_json(scene, record.degenerate_triangles, record.scene_hash)},
              {"method", to_string(o.method)},
              {"method_reason", method_reason(o)}};
  for (const Option& option : run_options()) {
    if (!option.value) continue;
    std::visit(
        [&](const auto& value) {
          if constexpr (std::is_same_v<decltype(value), const std::monostate&>)
            out[option.name] = nullptr;
          else
            out[option.name] = value;
        },
        option.value(o));
    if (option.of_drawing && draws(o.method) && !record.found.drew()) out[option.name] = nullptr;
  }
  if (record.found.device.cpu) out["query"] = nullptr;
  const ViewReport* const widest = widest_budget(record.found.views());
  const Json rest = {
      {"promises", record.promise.holds},
      {"promise_reason", record.promise.reason},
      {"verdict", verdict_json(record)},
      {"views", views},
      {"budget", widest ? view_json(*widest)["budget"] : Json(nullptr)},
      {"device", device_json(record)},
      {"device_work", device_work_json(record.found.asked)},
      {"floating_point", floating_point_json(record.callers, record.used)},
      {"stages", stages_json(record.trace)},
      {"pcs", {{"objects", record.found.object_count}, {"triangles", record.found.triangle_count}}},
      {"object_triangles", json_of(record.found.swept_triangles())},
      {"candidate_pairs", record.found.count},
      {"colliding_pairs", record.collisions.pairs.size()},
      {"neighbour_pairs", record.collisions.neighbour_pairs.size()},
      {"all_colliding_pairs",
       record.collisions.pairs.size() + record.collisions.neighbour_pairs.size()},
      {"neighbours", record.collisions.neighbours},
      {"contacts", contacts_json(record)},
      {"ignored", o.ignored.empty() ? Json(nullptr)
                                    : Json{{"object_pairs", o.ignored.size()},
                                           {"candidates", record.found.ignored}}},
      {"limit", json_if(o.limit > 0, o.limit)},
      {"decided_pairs", record.decided},
      {"complete", record.complete},
      {"verification", verification_json(scene, record)},
      {"at_risk", json_if(record.risk.has_value(), record.risk.value_or(PairsAtRisk{}).at_risk)},
      {"at_risk_bare",
       json_if(record.risk.has_value(), record.risk.value_or(PairsAtRisk{}).at_risk_bare)},
      {"no_shortcuts", o.no_shortcuts},
      {"time_ms", json_of(record.ms)},
      {"seed", json_of(o.seed)},
      {"commit", FARCULL_COMMIT}};
  out.update(rest);
  return out;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string pairs_header(const Scene& scene, const PairColumns& columns) {
  std::string header = pair_list_header(columns.numbers ? columns.numbers->self : has_self(scene));
  header.pop_back();
  if (columns.contacts) header += ",contact";
  if (columns.segments) header += ",x0,y0,z0,x1,y1,z1,polygon";
  if (columns.faces) header += ",face_a,face_b";
  if (columns.names) header += ",name_a,name_b";
  return header + '\n';
}

void give_pairs_rows(const Scene& scene, const Record& record, const std::string& before,
                     const PairColumns& columns, const TextSink& sink) {
  const Rows rows(scene, record, before, columns);
  const std::vector<RowRange> ranges = ranges_of(record.collisions);
  std::vector<std::string> texts(chunks_for(ranges.size(), 1));
  for (std::size_t from = 0; from < ranges.size(); from += texts.size()) {
    const std::size_t count = std::min(texts.size(), ranges.size() - from);
    for_chunks(count, count, [&](std::size_t k, std::size_t, std::size_t) {
      texts[k].clear();
      rows.append(ranges[from + k], texts[k]);
    });
    for (std::size_t k = 0; k < count; ++k) sink(texts[k]);
  }
}

void give_pairs_csv(const Scene& scene, const Record& record, const PairColumns& columns,
                    const TextSink& sink) {
  sink(pairs_header(scene, columns));
  give_pairs_rows(scene, record, "", columns, sink);
}

std::string pairs_rows(const Scene& scene, const Record& record, const std::string& before,
                       const PairColumns& columns) {
  std::string out;
  give_pairs_rows(scene, record, before, columns, [&](std::string_view text) { out += text; });
  return out;
}

std::string pairs_csv(const Scene& scene, const Record& record, const PairColumns& columns) {
  return pairs_header(scene, columns) + pairs_rows(scene, record, "", columns);
}

Certificate certificate_of(const Scene& scene, const Record& record, const WholeScene* whole) {
  const RunOptions& options = record.options;
  if (!options.ignored.empty() || options.limit > 0) {
    throw Error(options.ignored.empty() ? "--limit" : scene.name,
                options.ignored.empty() ? "was given, and a certificate is about all pairs"
                                        : "objects are ignored, and a certificate is about all",
                "ask for no certificate, or leave no pair out");
  }
  const std::vector<TrianglePair> kept = pairs_left(record);
  Certificate::Run run;
  run.method = to_string(options.method);
  run.offset = fattens(options.method) && record.found.drew() ? options.offset : "none";
  for (const ViewReport& view : record.found.views()) {
    if (!view.drawn) continue;
    run.views.push_back({view.name, static_cast<std::uint64_t>(view.width),
                         static_cast<std::uint64_t>(view.height), view.radius_px});
    run.radius_px = std::max(run.radius_px, view.radius_px);
    run.resolution = static_cast<std::uint64_t>(resolution_of(options));
  }
  if (record.found.device.gl) {
    const GlInfo& device = *record.found.device.gl;
    run.device = {device.vendor, device.renderer, device.version, device.glsl};
    run.assumptions = assumptions_about(device);
  }
  return make_certificate(scene, kept, record.collisions.all(), std::move(run), options.clearance,
                          whole);
}

std::string decision_of(const Stage& stage) {
  return stage.depends ? "depends" : stage.ran ? "runs" : "left out";
}

std::string plan_table(const Scene& scene, const Plan& plan) {
  Table table("lll");
  table.add({"stage", "done", "why"});
  for (const Stage& stage : plan.stages()) {
    const std::string decision = decision_of(stage);
    table.add({name_of(stage), decision == "runs" ? "yes" : decision, reason_of(stage)});
  }
  const RunOptions& options = plan.options;
  const auto* const work = std::get_if<DrawPlan>(&plan.work);
  const bool idle = work && work->fatteners.empty();
  const bool on_cpu = options.device.empty() || is_cpu(options.device);
  const std::uint64_t self = self_objects(scene);
  const std::string tested = self == 0 ? ""
                                       : fmt::format("self       {} tested against {}\n",
                                                     counted(self, "object is", "objects are"),
                                                     self == 1 ? "itself" : "themselves");
  return fmt::format("{}: {}, {}, {}{}\n{}\n{}", scene.name,
                     counted(scene.objects.size(), "object", "objects"),
                     counted(scene.triangles.size(), "triangle", "triangles"),
                     describe(options, idle ? kNothingToDraw : ""), options.full ? ", --full" : "",
                     default_method_line(options) + (on_cpu && !idle ? faster_line(options) : "") +
                         tested + not_asked_line(scene),
                     table.text());
}

Json plan_json(const Scene& scene, const Plan& plan, const std::optional<MissPrediction>& misses) {
  Json missed = nullptr;
  if (misses) {
    missed = {{"colliding", misses->colliding},
              {"expected", misses->missed},
              {"low", misses->low()},
              {"high", misses->high()},
              {"judged", misses->judged()}};
  }
  return {{"scene", scene.name},
          {"objects", scene.objects.size()},
          {"triangles", scene.triangles.size()},
          {"nothing_to_test", text_json(nothing_to_test(scene).reason)},
          {"method", to_string(plan.options.method)},
          {"method_reason", method_reason(plan.options)},
          {"form", form_text(plan.options)},
          {"full", plan.options.full},
          {"steps", json_list(plan.stages(),
                              [](const Stage& stage) {
                                return Json{{"step", name_of(stage)},
                                            {"decision", decision_of(stage)},
                                            {"reason", reason_of(stage)}};
                              })},
          {"misses", missed}};
}

}  // namespace farcull
