// Runs of any method, with their record, plan, check and picture: what the commands of the program
// of the same names do.
#include <pybind11/stl.h>

#include <array>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "experiments/measure/lab.h"
#include "experiments/picture/picture.h"
#include "experiments/python/arrays.h"
#include "experiments/python/parts.h"
#include "experiments/record/check.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "verify/certificate/certificate.h"

namespace farcull::python {
namespace {

// A record, with the scene that it is about.
struct KeptRecord {
  std::shared_ptr<const Scene> scene;
  Record record;

  bool verified() const { return record.verification.has_value(); }
  // All that were missed, not the first ones alone.
  std::vector<TrianglePair> missed() const {
    const Accounting& known = record.verification.value();
    if (known.false_negatives <= known.examples.size()) return known.examples;
    return account(*scene, pairs_left(record),
                   {.clearance = record.options.clearance,
                    .max_examples = static_cast<std::size_t>(known.false_negatives),
                    .ignored = record.options.ignored})
        .examples;
  }
};

using Ignored = std::vector<std::array<std::uint32_t, 2>>;

// ignore: pairs of two different objects of the scene; limit: 0 for none.
RunOptions options_of(const GivenOptions& given, const Ignored& ignore, std::uint64_t limit,
                      bool verify = true, bool kinds = false) {
  RunOptions out{.verify = verify,
                 .limit = limit,
                 .contacts = kinds ? ContactDetail::kinds : ContactDetail::none};
  for (const auto& [a, b] : ignore) out.ignored.push_back({a, b});
  out.ignored = in_order(std::move(out.ignored));
  return read_options(given, out);
}

KeptRecord run_of(const KeptScene& kept, const GivenOptions& given, bool verify, unsigned threads,
                  bool kinds, const Ignored& ignore, std::uint64_t limit) {
  return answer_beside([&] {
    const RunOptions options = options_of(given, ignore, limit, verify, kinds);
    Session session(options.device, threads, Say());
    return KeptRecord{kept.scene, run(*kept.scene, options, session, stopping_progress())};
  });
}

py::object kinds_of(const KeptRecord& kept, const std::vector<ContactShape>& contacts) {
  if (kept.record.options.contacts == ContactDetail::none) return py::none();
  return kind_array(contacts);
}

py::dict accounting_of(const Accounting& accounting) {
  py::dict out;
  out["pairs_total"] = accounting.pairs_total;
  out["ignored"] = accounting.ignored;
  out["pairs_kept"] = accounting.pairs_kept;
  out["certified_by_boxes"] = accounting.certified_by_boxes;
  out["neighbours"] = accounting.neighbours;
  out["certified_by_predicates"] = accounting.certified_by_predicates;
  out["false_negatives"] = accounting.false_negatives;
  out["ms"] = accounting.ms;
  return out;
}

py::list views_of(const Candidates& found) {
  py::list out;
  for (const PairView& v : found.pair_views()) {
    py::dict view;
    view["name"] = v.name;
    view["looked"] = v.looked;
    view["reason"] = v.reason;
    view["width"] = v.width;
    view["height"] = v.height;
    out.append(std::move(view));
  }
  for (const ViewReport& v : found.views()) {
    py::dict view;
    view["name"] = v.name;
    view["looked"] = v.drawn;
    view["width"] = v.width;
    view["height"] = v.height;
    view["radius_px"] = v.radius_px;
    out.append(std::move(view));
  }
  return out;
}

py::tuple plan_of(const KeptScene& kept, const GivenOptions& given, unsigned threads,
                  const Ignored& ignore, std::uint64_t limit) {
  const auto [json, table] = answer_beside([&] {
    const RunOptions options = options_of(given, ignore, limit);
    const Plan planned = plan(*kept.scene, options, threads, stopping_progress());
    return std::pair(plan_json(*kept.scene, planned).dump(), plan_table(*kept.scene, planned));
  });
  return py::make_tuple(json, table);
}

// The list as a file of the program would have it.
GivenList listed(const Scene& scene, const std::vector<TrianglePair>& pairs) {
  const std::vector<std::uint32_t> owner = owners(scene);
  GivenList out{.name = "pairs", .has_frames = false, .rows = {}, .not_looked_at = {}};
  for (const TrianglePair& pair : pairs) {
    const std::uint32_t a = owner[pair.a], b = owner[pair.b];
    out.rows.push_back({.line = out.rows.size() + 1,
                        .frame = 0,
                        .object = {a, b},
                        .triangle = {pair.a - scene.objects[a].first_triangle,
                                     pair.b - scene.objects[b].first_triangle},
                        .neighbours = {}});
  }
  return out;
}

// certificate: its text, or none; pairs: a list to be checked with it or alone, or none.
py::dict check_of(const KeptScene& kept, const std::optional<std::string>& certificate,
                  const std::optional<py::array>& pairs, std::optional<double> clearance) {
  const Scene& scene = *kept.scene;
  std::optional<GivenList> list;
  if (pairs) list = listed(scene, pairs_of(*pairs, "pairs", scene.triangles.size()));
  const SceneCheck check = answer_beside([&] {
    std::optional<Certificate> parsed;
    if (certificate) parsed = parse_certificate(*certificate, "certificate");
    const double asked = clearance.value_or(parsed ? parsed->clearance : 0);
    return check_scene_with(
        asked, "certificate", parsed, scene, list ? &*list : nullptr,
        list ? std::span<const ListedPair>(list->rows) : std::span<const ListedPair>());
  });
  const CheckResult& result = check.result;
  py::dict out;
  out["verdict"] = to_string(result.verdict);
  out["reason"] = result.reason;
  out["pair"] = result.pair ? py::object(py::make_tuple(result.pair->a, result.pair->b))
                            : py::object(py::none());
  out["decided"] = !result.list_sha256.empty();
  out["pairs"] = pair_array(result.meeting);
  out["culled_meeting"] = result.culled_meeting;
  out["unattested"] = result.unattested;
  out["text"] = check_text(scene, check);
  return out;
}

py::tuple picture_of(const KeptScene& kept, const std::vector<GivenOptions>& panels,
                     const std::string& view, const std::string& up, bool zoom,
                     const std::optional<std::string>& depth_view, int width, int height,
                     const std::string& device, unsigned threads) {
  const PictureResult result = answer_beside([&] {
    PictureArguments arguments;
    arguments.scene = {"scene"};
    arguments.view = view;
    arguments.up = up;
    arguments.zoom = zoom;
    arguments.depth_view = depth_view;
    arguments.width = width;
    arguments.height = height;
    for (const GivenOptions& given : panels) arguments.panels.push_back(read_options(given));
    validate(arguments);
    Lab lab(device, stopping_progress(), threads);
    lab.scene("scene", [&] { return *kept.scene; });
    return make_picture(arguments, lab);
  });
  const Image& image = result.image;
  static_assert(sizeof(Rgba) == 4);
  py::array_t<std::uint8_t> pixels({image.height, image.width, 4});
  std::memcpy(pixels.mutable_data(), image.pixels.data(), 4 * image.pixels.size());
  py::list shown;
  for (const PanelResult& p : result.panels) {
    py::dict panel;
    panel["title"] = p.title;
    panel["headline"] = p.headline;
    panel["colliding"] = p.colliding;
    panel["missed"] = p.missed;
    panel["kept"] = p.kept;
    panel["device"] = p.device;
    shown.append(std::move(panel));
  }
  return py::make_tuple(pixels, shown);
}

}  // namespace

void add_runs(py::module_& module) {
  py::class_<KeptRecord>(module, "Record")
      .def_property_readonly(
          "pairs", [](const KeptRecord& k) { return pair_array(k.record.collisions.pairs); })
      .def_property_readonly(
          "neighbour_pairs",
          [](const KeptRecord& k) { return pair_array(k.record.collisions.neighbour_pairs); })
      .def_property_readonly("kinds",
                             [](const KeptRecord& k) { return kinds_of(k, k.record.contacts); })
      .def_property_readonly(
          "neighbour_kinds",
          [](const KeptRecord& k) { return kinds_of(k, k.record.neighbour_contacts); })
      .def_property_readonly("complete", [](const KeptRecord& k) { return k.record.complete; })
      .def_property_readonly("bits",
                             [](py::object self) {
                               const auto& bits = self.cast<const KeptRecord&>().record.found.bits;
                               return view_of(bits.data(), {static_cast<py::ssize_t>(bits.size())},
                                              self);
                             })
      .def_property_readonly(
          "kept_triangles",
          [](py::object self) {
            const auto& kept = self.cast<const KeptRecord&>().record.found.triangles;
            return view_of(kept.data(), {static_cast<py::ssize_t>(kept.size())}, self);
          })
      .def_property_readonly("candidates", [](const KeptRecord& k) { return k.record.found.count; })
      .def_property_readonly("views", [](const KeptRecord& k) { return views_of(k.record.found); })
      .def_property_readonly("promises", [](const KeptRecord& k) { return k.record.promise.holds; })
      .def_property_readonly("promises_reason",
                             [](const KeptRecord& k) { return k.record.promise.reason; })
      .def_property_readonly("accounting",
                             [](const KeptRecord& k) -> py::object {
                               if (!k.verified()) return py::none();
                               return accounting_of(*k.record.verification);
                             })
      .def("missed",
           [](const KeptRecord& k) -> py::object {
             if (!k.verified()) return py::none();
             return pair_array(answer_beside([&] { return k.missed(); }));
           })
      .def("json",
           [](const KeptRecord& k) {
             return answer_beside([&] { return to_json(*k.scene, k.record).dump(); });
           })
      .def("table",
           [](const KeptRecord& k) {
             return answer_beside([&] { return run_table(*k.scene, k.record); });
           })
      .def("certificate", [](const KeptRecord& k) {
        if (k.record.options.limit > 0 || !k.record.options.ignored.empty()) {
          raise("certificate", "is about all colliding pairs of all objects",
                "run without ignore and limit", true);
        }
        return answer_beside([&] { return to_text(certificate_of(*k.scene, k.record)); });
      });
  // The keywords of run(), and which are flags; method and limit are parameters of their own.
  py::dict options;
  for (const Option& option : run_options()) {
    if (option.take && option.name != std::string("method") && option.name != std::string("limit"))
      options[option.name] = *option.type == 0;
  }
  module.attr("options") = options;
  module.def("run", &run_of);
  module.def("plan", &plan_of);
  module.def("check", &check_of);
  module.def("picture", &picture_of);
}

}  // namespace farcull::python
