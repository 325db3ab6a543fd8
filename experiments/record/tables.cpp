// Formats records as text, section by section.
#include "experiments/record/tables.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/gl/base/context.h"
#include "experiments/record/stage_words.h"
#include "experiments/system/text_table.h"
#include "verify/certificate/certificate.h"

namespace farcull {
namespace {

constexpr std::size_t kExamplesShown = 5;

// Wraps the text of an answer at 80 columns or less. Tables may be wider.
std::string answer(const std::string& text) {
  return wrapped(text, std::min<std::size_t>(80, text_columns()));
}

std::string scene_line(const Scene& scene, const Record& record) {
  std::string line = scene_text(scene, record.degenerate_triangles);
  if (record.options.seed) line += fmt::format(", seed {}", *record.options.seed);
  return line + "\n";
}

std::string device_text(const Record& record) {
  if (record.found.device.cpu) {
    return fmt::format("cpu, lanes of {}, {} depth bits: {}", record.found.device.lanes,
                       record.found.device.depth_bits, record.found.device.note);
  }
  if (!record.found.device.gl) return "none needed: " + no_device_reason(record.trace);
  const GlInfo& gl = *record.found.device.gl;
  std::string warnings = gl.reset_detection ? "" : "; it does not report when it resets";
  if (const std::string risk = risk_of_threads(gl.renderer); !risk.empty()) warnings += "; " + risk;
  return fmt::format("{}, {} depth bits, {} subpixel bits{}", gl.renderer,
                     record.found.device.depth_bits, gl.subpixel_bits, warnings);
}

std::string method_text(const Record& record) {
  const RunOptions& o = record.options;
  const bool drew = record.found.drew();
  std::string text = describe(o, not_drawn_text(record));
  if (fattens(o.method) && drew) text += fmt::format(", {} offsets", o.offset);
  if (fattens(o.method) && drew && radius_text(o.radius) != "budget")
    text += fmt::format(", radius {}", radius_text(o.radius));
  if (drew) {
    text += depth_of(o) == DepthMode::fragment ? ", fragment depth" : ", fixed-function depth";
    // The canvas on the CPU has no query modes.
    if (!record.found.device.cpu)
      text += query_of(o) == QueryMode::flags ? ", flags" : ", occlusion queries";
  }
  if (o.clearance > 0) text += fmt::format(", clearance {}", o.clearance);
  return text + (record.promise.holds ? "; promises to miss nothing" : "");
}

std::string views_text(const std::vector<ViewReport>& views) {
  std::string text;
  for (const ViewReport& view : views) {
    text += (text.empty() ? "" : ", ") + view.name + " ";
    text += view.drawn ? fmt::format("{} x {}", view.width, view.height) : "not drawn";
  }
  return text + " px";
}

// Returns a line with the radius of the view with the largest budget, and the terms of its budget.
std::string radius_line(const Record& record) {
  const ViewReport* view = widest_budget(record.found.views());
  if (!fattens(record.options.method) || view == nullptr) return "";
  const RadiusRule& rule = record.options.radius;
  std::string line = fmt::format("radius     {:.5f} px", view->radius_px);
  if (rule.published) line += ", as published";
  if (!rule.published && rule.factor != 1) line += fmt::format(", {} of the budget", rule.factor);
  if (rule.published || rule.factor != 1)
    line += fmt::format("\nbudget     {:.5f} px", view->budget.radius());
  bool first = true;
  for (const BudgetTerm& term : view->budget.terms()) {
    if (term.px <= 0) continue;
    line += fmt::format("{}{} {:.5f}", first ? " = " : " + ", term.name, term.px);
    first = false;
  }
  return line + "\n";
}

// A row of the stage table: one stage, all stages of one view in the first round, or all stages of
// the later rounds.
struct Row {
  std::string key;  // stages with the same key share a row; empty: the row has one stage
  std::string name;
  std::string note;
  std::vector<std::string> views;  // views in later rounds, or names of stages left out
  Stage sum;                       // sum of ms; `in` of the first stage, `out` of the last
};

// Returns the key of a stage's row: the view, or "later rounds". Empty if the stage has a row of
// its own.
std::string key_of(const Stage& stage) {
  if (stage.round == 0) return "";
  if (stage.round == 1 && stage.kind == StageKind::agreement) return "";
  return stage.round == 1 ? "view " + stage.subject : "later rounds";
}

// Adds a stage that was left out. If the last row has the same reason, the stage joins that row.
void add_left_out(const Stage& stage, std::vector<Row>& rows) {
  const std::string name = name_of(stage), note = "left out: " + reason_of(stage);
  if (rows.empty() || rows.back().note != note || rows.back().sum.ran) {
    rows.push_back({"", name, note, {name}, stage});
    return;
  }
  Row& row = rows.back();
  row.views.push_back(name);
  row.name = fmt::format("{} and {} more", row.views.front(), row.views.size() - 1);
}

void fold(const Stage& stage, Row& row) {
  if (stage.round > 1) {
    row.name = stage.round == 2 ? "round 2" : fmt::format("rounds 2-{}", stage.round);
    if (stage.kind == StageKind::agreement) return;
    if (std::find(row.views.begin(), row.views.end(), stage.subject) != row.views.end()) return;
    row.note += (row.note.empty() ? "" : ", ") + stage.subject;
    row.views.push_back(stage.subject);
    return;
  }
  const bool fattened = stage.kind == StageKind::fatten;
  row.note += fmt::format("{}{} {:.1f}", row.note.empty() ? "" : ", ",
                          fattened ? "fatten" : level_name(stage.level), stage.ms);
  if (fattened && stage.n > 0)
    row.note +=
        fmt::format(" ({} beyond the budget, kept)", counted(stage.n, "triangle", "triangles"));
}

std::vector<Row> folded(const std::vector<Stage>& stages) {
  std::vector<Row> rows;
  for (const Stage& stage : stages) {
    const std::string key = key_of(stage);
    if (!stage.ran) {
      add_left_out(stage, rows);
    } else if (key.empty()) {
      rows.push_back({"", name_of(stage), reason_of(stage), {}, stage});
    } else {
      if (rows.empty() || rows.back().key != key) {
        rows.push_back({key, key, "", {}, stage});
      } else {
        rows.back().sum.ms += stage.ms;
        rows.back().sum.out = stage.out;
      }
      fold(stage, rows.back());
    }
  }
  return rows;
}

std::string accounting_lines(const Scene& scene, const Record& record) {
  if (!record.verification) {
    return record.limited ? "accounted  not at all: --limit ended the search\n"
                          : "accounted  not at all (--no-verify)\n";
  }
  const Accounting& v = *record.verification;
  std::string out = accounting_sum(v);
  if (v.false_negatives > 0 && record.missed) {
    out += fmt::format("           of those missed {} touching, {} penetrating\n",
                       grouped(record.missed->touching), grouped(record.missed->penetrating));
  }
  const std::size_t shown = std::min(v.examples.size(), kExamplesShown);
  for (std::size_t i = 0; i < shown; ++i)
    out += fmt::format("  missed: {} meets {}\n", place_text(scene, v.examples[i].a),
                       place_text(scene, v.examples[i].b));
  if (v.false_negatives > shown && shown > 0)
    out += fmt::format("  missed: {} more\n", grouped(v.false_negatives - shown));
  return out;
}

std::string work_line(const Record& record) {
  if (!record.found.drew()) return "";
  const Stage sum = work_of(record.trace);
  return fmt::format("drawn      {}, {}{}\n", counted(sum.draws, "element", "elements"),
                     counted(sum.queries, "query", "queries"),
                     sum.draws_saved + sum.queries_saved == 0
                         ? ""
                         : fmt::format("; {} and {} fewer than plain CULLIDE would",
                                       grouped(sum.draws_saved), grouped(sum.queries_saved)));
}

std::string device_work_line(const Record& record) {
  const CanvasWork& work = record.found.asked;
  if (work.passes == 0) return "";
  const std::optional<double> ms = work.known_ms();
  return fmt::format(
      "work       {}: {}, {}, {}, {}; {} kB up, {} kB down; {}\n",
      counted(work.passes, "pass", "passes"), counted(work.draws, "draw call", "draw calls"),
      counted(work.state_changes, "state change", "state changes"),
      counted(work.readbacks, "readback", "readbacks"), counted(work.waits, "wait", "waits"),
      grouped((work.uploaded_bytes + 1023) / 1024), grouped((work.downloaded_bytes + 1023) / 1024),
      ms ? fmt::format("{:.1f} ms by the device's clock", *ms) : "device time not known");
}

// Returns a line with the number of pairs that a smaller radius would miss. Returns "" if the
// record has no such number.
std::string risk_line(const Record& record) {
  if (!record.risk) return "";
  const auto& [smaller, bare] = *record.risk;
  return fmt::format("at risk    {} with 0.9 of the radius, {} without a ball{}\n",
                     counted(smaller, "pair", "pairs"), grouped(bare),
                     smaller > 0 ? ""
                     : bare > 0  ? ": this tests that a ball is needed, not how large it has to be"
                                 : ": this run does not test the radius");
}

// Returns the kinds of contact that occur, such as "12 crossing + 3 touch-vertex". Returns "" if
// the run determined no kinds.
std::string contacts_line(const Record& record) {
  if (record.options.contacts == ContactDetail::none) return "";
  std::string text;
  for (const auto& [kind, count] : count_kinds(record)) {
    if (count == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : " + ", grouped(count), name_of(kind));
  }
  return fmt::format("contacts   {}\n", text.empty() ? "none" : text);
}

std::string limit_line(const Record& record) {
  if (record.options.limit == 0) return "";
  const std::string candidates = counted(record.found.count, "candidate", "candidates");
  return fmt::format("limit      {} at most; {} decided{}\n",
                     counted(record.options.limit, "pair", "pairs"),
                     record.limited ? candidates : grouped(record.decided) + " of " + candidates,
                     record.complete ? "" : "; there may be more pairs behind the last one");
}

std::string ignored_line(const Record& record) {
  if (record.options.ignored.empty()) return "";
  const std::string objects =
      counted(record.options.ignored.size(), "pair of objects", "pairs of objects");
  // If tests of boxes leave pairs of ignored objects out, these pairs are not counted.
  if (record.found.ignored == 0)
    return "ignored    " + objects + ", of which no candidate pairs were made\n";
  return fmt::format("ignored    {} of {}\n",
                     counted(record.found.ignored, "candidate pair", "candidate pairs"), objects);
}

}  // namespace

TrianglePlace place_of(const Scene& scene, std::uint32_t triangle) {
  const auto after = std::upper_bound(
      scene.objects.begin(), scene.objects.end(), triangle,
      [](std::uint32_t t, const Object& object) { return t < object.first_triangle; });
  // An object without triangles has the same first triangle as the next object. So the owner is the
  // last object with this first triangle.
  const auto owner = static_cast<std::uint32_t>(after - scene.objects.begin() - 1);
  return {owner, triangle - scene.objects[owner].first_triangle};
}

std::string place_text(const Scene& scene, std::uint32_t triangle) {
  const TrianglePlace at = place_of(scene, triangle);
  return fmt::format("{} triangle {}", scene.objects[at.object].name, at.triangle);
}

std::string not_drawn_text(const Record& r) {
  if (!draws(r.options.method) || r.found.drew()) return "";
  return r.found.views().empty() ? kNothingToDraw : "too fine for pixels, so all is kept";
}

std::string folded_text(const Scene& scene) {
  if (scene.folded.empty()) return "";
  std::string out = fmt::format(", {} folded", counted(scene.folded.size(), "polygon", "polygons"));
  const std::size_t shown = std::min(kExamplesShown, scene.folded.size());
  for (std::size_t k = 0; k < shown; ++k) {
    const FoldedFace& f = scene.folded[k];
    out +=
        fmt::format("{} face {} of {}", k == 0 ? ":" : ",", f.face, scene.objects[f.object].name);
  }
  return out + (shown < scene.folded.size() ? ", ..." : "");
}

std::string scene_text(const Scene& scene, std::uint64_t degenerate_triangles) {
  std::string out =
      fmt::format("{}: {}, {}", scene.name, counted(scene.objects.size(), "object", "objects"),
                  counted(scene.triangles.size(), "triangle", "triangles"));
  if (degenerate_triangles > 0)
    out += fmt::format(", {} of them degenerate", grouped(degenerate_triangles));
  return out + folded_text(scene);
}

std::string more_line(std::size_t all, std::size_t shown) {
  if (all <= shown) return "";
  return fmt::format("and {} more (--json and --csv have all)\n", grouped(all - shown));
}

const ViewReport* widest_budget(const std::vector<ViewReport>& views) {
  const ViewReport* widest = nullptr;
  for (const ViewReport& view : views) {
    if (view.drawn && (!widest || view.budget.radius() > widest->budget.radius())) widest = &view;
  }
  return widest;
}

std::string stage_table(const std::vector<Stage>& stages) {
  Table table("lrrrll");
  table.add({"stage", "ms", "in", "out", "", ""});
  for (const Row& row : folded(stages)) {
    const Stage& s = row.sum;
    const bool counts = s.unit != Unit::none && (s.ran || s.in > 0);
    table.add({row.name, s.ran ? fmt::format("{:.1f}", s.ms) : "-", counts ? grouped(s.in) : "",
               counts ? grouped(s.out) : "", counts ? to_string(s.unit) : "", row.note});
  }
  return table.text();
}

NothingToTest nothing_to_test(const Scene& scene) {
  std::uint64_t with_triangles = 0;
  for (const Object& object : scene.objects) {
    with_triangles += object.triangle_count > 0;
    if (object.self && object.triangle_count > 1) return {};
  }
  if (with_triangles > 1) return {};
  if (scene.triangles.size() < 2) return {.reason = "the scene has fewer than two triangles"};
  const std::string one = scene.objects.size() == 1 ? "the scene is one object"
                                                    : "one object of the scene has all triangles";
  return {.reason = one + ", and an object is tested against itself only with --self",
          .with_self = true};
}

std::string default_method_line(const RunOptions& options) {
  if (!options.method_is_default) return "";
  return fmt::format("default    {};\n           others: {} (farcull help methods)\n",
                     method_reason(options),
                     method_names([](const Traits& t) { return t.method != kDefaultMethod; }));
}

std::string faster_line(const RunOptions& options) {
  if (!draws(options.method) || !guaranteed(options)) return "";
  return fmt::format("hint       on a CPU {} {} takes less time than drawing\n",
                     option_word("method"), to_string(kDefaultMethod));
}

std::string colliding_text(std::uint64_t pairs, std::uint64_t neighbour_pairs, bool self) {
  const std::string all = counted(pairs + neighbour_pairs, "pair", "pairs");
  if (!self) return all;
  return fmt::format("{} = {} + {} of neighbours", all, grouped(pairs), grouped(neighbour_pairs));
}

std::string not_asked_text(const Scene& scene) {
  constexpr std::size_t kNamed = 3;
  const NotAsked unasked = not_asked(scene);
  if (unasked.pairs == 0) return "";
  std::vector<std::string> names;
  for (const auto& [first, last] : unasked.ranges) {
    for (std::uint32_t o = first; o <= last && names.size() < kNamed + 1; ++o)
      names.push_back(scene.objects[o].name);
  }
  std::string where = fmt::format("{}", fmt::join(names, ", "));
  if (names.size() > kNamed) {
    where = fmt::format("{} of {}", grouped(unasked.objects),
                        counted(scene.objects.size(), "object", "objects"));
  }
  return counted(unasked.pairs, "pair", "pairs") + " of triangles inside " + where;
}

std::string not_asked_line(const Scene& scene, const std::string& options) {
  const std::string text = not_asked_text(scene);
  return text.empty() ? "" : "not asked  " + text + " (add " + options + ")\n";
}

std::string run_heading(const Scene& scene, const Record& record) {
  std::string out =
      "scene      " + scene_line(scene, record) + "method     " + method_text(record) + "\n" +
      (record.promise.verdict
           ? fmt::format("promise    {}{}\n",
                         record.promise.holds ? "" : "none: ", record.promise.reason)
           : "") +
      "device     " + device_text(record) + "\n" +
      not_asked_line(scene, tests_self(record.options.method) ? "--self" : "--method boxes --self");
  if (record.callers != kProved)
    out +=
        "floats     " + to_string(record.used) + "; the caller " + to_string(record.callers) + "\n";
  return answer(out);
}

std::string verdict_text(const Accounting& accounting) {
  const std::string all = counted(accounting.pairs_total, "pair", "pairs") + " accounted for";
  if (accounting.false_negatives == 0) return "verified: no colliding pair was culled, " + all;
  return fmt::format(
      "NOT verified: {} culled, {}",
      counted(accounting.false_negatives, "colliding pair was", "colliding pairs were"), all);
}

std::string accounting_sum(const Accounting& v) {
  return fmt::format(
      "accounted  {} = {} kept + {} disjoint boxes\n           + {} proved disjoint{}{} + {} "
      "missed\n",
      counted(v.pairs_total, "pair", "pairs"), grouped(v.pairs_kept), grouped(v.certified_by_boxes),
      grouped(v.certified_by_predicates),
      v.neighbours > 0 ? " + " + grouped(v.neighbours) + " neighbours" : "",
      v.ignored > 0 ? " + " + grouped(v.ignored) + " ignored" : "", grouped(v.false_negatives));
}

std::string run_answer(const Scene& scene, const Record& record, const std::string& verdict) {
  const bool self = has_self(scene);
  const std::uint64_t missed = record.verification ? record.verification->false_negatives : 0;
  std::string out = fmt::format(
      "colliding  {}{}{}\n",
      colliding_text(record.collisions.pairs.size(), record.collisions.neighbour_pairs.size(),
                     self),
      self ? "; " + counted(record.collisions.neighbours, "candidate is", "candidates are") +
                 " of neighbours"
           : "",
      missed > 0 ? " found; " + grouped(missed) + " missed" : "");
  out += contacts_line(record) + limit_line(record) + ignored_line(record);
  const std::string time = fmt::format(
      "time       {:.1f} ms = setup {:.1f} + cull {:.1f} + exact {:.1f}{}{}\n", record.ms.total,
      record.ms.setup, record.ms.cull, record.ms.exact,
      record.ms.contacts > 0 ? fmt::format("; contacts {:.1f} more", record.ms.contacts) : "",
      record.verification ? fmt::format("; accounting {:.1f} more", record.verification->ms) : "");
  return answer(out) + verdict + answer(accounting_lines(scene, record) + risk_line(record)) +
         run_heading(scene, record) + answer(time);
}

std::string run_details(const Record& record) {
  std::string out = default_method_line(record.options);
  if (record.found.device.cpu && record.found.drew()) out += faster_line(record.options);
  if (!record.found.views().empty()) out += "views      " + views_text(record.found.views()) + "\n";
  out += radius_line(record);
  out += fmt::format("kept       {}, {}, {}\n",
                     counted(record.found.object_count, "object", "objects"),
                     counted(record.found.triangle_count, "triangle", "triangles"),
                     counted(record.found.count, "candidate pair", "candidate pairs"));
  out += work_line(record) + device_work_line(record);
  return answer(out) + "\n" + stage_table(record.trace);
}

std::string run_table(const Scene& scene, const Record& record, const std::string& verdict) {
  return run_answer(scene, record, verdict) + run_details(record);
}

std::string comparison_table(const Scene& scene, const std::vector<Compared>& rows) {
  if (rows.empty()) return "";
  const auto some = [&](auto&& is) {
    return std::ranges::any_of(rows, [&](const Compared& row) { return is(row.record); });
  };
  const auto drawn =
      std::ranges::find_if(rows, [](const Compared& row) { return row.record.found.drew(); });
  const Compared* reference = nullptr;
  for (const Compared& row : rows) {
    if (!culls(row.record.options.method)) reference = &row;
  }
  const auto ms_of = [](const Record& r) { return r.ms.cull + r.ms.exact; };
  const bool self = has_self(scene);
  const bool offsets = some([](const Record& r) { return r.options.offset != "obb"; });
  const bool radii =
      some([](const Record& r) { return radius_text(r.options.radius) != "budget"; });
  const bool risks = some([](const Record& r) { return r.risk.has_value(); });
  Table table("lllrrrrrrrr");
  table.add({"method", offsets ? "offset" : "", radii ? "radius" : "", "px", "candidates",
             self ? "colliding + neighbours" : "colliding", "missed", risks ? "at risk" : "", "ms",
             "least - most", reference ? "x exact" : ""});
  for (const Compared& row : rows) {
    const Record& r = row.record;
    const std::string form = form_text(r.options);
    const auto if_fattened = [&](bool shown, const std::string& text) -> std::string {
      return !shown ? "" : fattens(r.options.method) && r.found.drew() ? text : "-";
    };
    table.add(
        {to_string(r.options.method) + (form.empty() ? "" : " " + form),
         if_fattened(offsets, r.options.offset), if_fattened(radii, radius_text(r.options.radius)),
         draws(r.options.method) && not_drawn_text(r).empty()
             ? std::to_string(resolution_of(r.options))
             : "-",
         grouped(r.found.count),
         grouped(r.collisions.pairs.size()) +
             (self ? " + " + grouped(r.collisions.neighbour_pairs.size()) : ""),
         r.verification ? grouped(r.verification->false_negatives) : "not verified",
         r.risk  ? grouped(r.risk->at_risk) + " / " + grouped(r.risk->at_risk_bare)
         : risks ? "-"
                 : "",
         fmt::format("{:.1f}", ms_of(r)), fmt::format("{:.1f} - {:.1f}", row.least_ms, row.most_ms),
         reference ? fmt::format("{:.2f}", ms_of(r) / ms_of(reference->record)) : ""});
  }
  std::string out = scene_line(scene, rows[0].record) + "device     " +
                    device_text(drawn != rows.end() ? drawn->record : rows[0].record) + "\n" +
                    not_asked_line(scene) + "\n" + table.text();
  out +=
      "\ncandidates: pairs that culling left; missed: colliding pairs that it lost, found by "
      "exact\n"
      "predicates over all pairs";
  if (self) out += "; neighbours: of one object, and share a vertex position";
  out += fmt::format(
      ".\nms: culling and exact tests, median of {}, and the least and the most; the graphics\n"
      "context is set up once and not counted.\n",
      counted(rows[0].runs, "run", "runs"));
  if (risks) {
    out +=
        "at risk: pairs that far loses with 0.9 of its radius / without a ball. Where none is "
        "lost, "
        "0 missed\ndoes not show that the radius is large enough (--no-risk: not counted, takes "
        "less "
        "time).\n";
  }
  if (some([](const Record& r) { return r.options.no_shortcuts; }))
    out +=
        "far leaves no stage out here, so that all radii draw the same; alone it takes less "
        "time.\n";
  if (some([](const Record& r) { return !not_drawn_text(r).empty(); }))
    out +=
        "-: a method that draws had nothing left to draw, or the scene is too fine for pixels.\n";
  if (some([](const Record& r) {
        return draws(r.options.method) && !fattens(r.options.method) && r.options.rounds == 0;
      }))
    out += "cullide: repeated until a round changes nothing; --rounds 1 is the form of 2003.\n";
  if (reference)
    out += "x exact: ms over that of the method exact (boxes of all triangles); lower is faster.\n";
  return out;
}

}  // namespace farcull
