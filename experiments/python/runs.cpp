// Python classes and functions for scenes, moving scenes, runs, records, checks and pictures.
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <nlohmann/json.hpp>
#include <ranges>

#include "experiments/library/input.h"
#include "experiments/measure/harness.h"
#include "experiments/method/clash.h"
#include "experiments/method/run.h"
#include "experiments/picture/picture.h"
#include "experiments/python/arrays.h"
#include "experiments/record/check.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/scenes/frames.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/scene_file.h"
#include "verify/certificate/certificate.h"

namespace farcull::python {

namespace {

using namespace py::literals;

using Kept = std::unique_ptr<KeptScene>;
using Ignored = std::vector<std::array<std::uint32_t, 2>>;  // pairs of objects

Kept from_arrays(const py::array& vertices, const py::array& triangles, const py::array& starts,
                 const py::array& poses, const std::string& name,
                 const std::vector<std::string>& names, bool self,
                 const std::vector<bool>& self_objects) {
  const MeshArrays given(vertices, triangles, starts, poses);
  return without_gil([&] {
    TakenInput taken;
    load_input(given.input(), self, self_objects, taken, nullptr, false);
    Scene& scene = taken.scene;
    scene.name = name;
    if (!names.empty() && names.size() != scene.objects.size()) {
      throw Error("names",
                  "are " + std::to_string(names.size()) + " for " +
                      std::to_string(scene.objects.size()) + " objects",
                  "give one for each object, or none");
    }
    for (std::size_t o = 0; o < scene.objects.size(); ++o)
      scene.objects[o].name = names.empty() ? std::to_string(o) : names[o];
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
      scene.source_face[t] = static_cast<std::uint32_t>(t);
    return std::make_unique<KeptScene>(std::move(scene));
  });
}

SceneArguments arguments_of(const std::vector<std::string>& names, const std::string& weld) {
  SceneArguments out(names);
  if (!weld.empty()) out.weld = weld;
  return out;
}

Kept from_names(const std::vector<std::string>& names, const std::string& weld, bool self) {
  return without_gil([&] {
    Scene scene = load_scene(arguments_of(names, weld));
    for (Object& object : scene.objects) object.self |= self;
    return std::make_unique<KeptScene>(std::move(scene));
  });
}

// A scene that moves. One thread at a time may use it.
class Frames {
 public:
  Frames(const std::vector<std::string>& names, const std::string& weld, const std::string& range,
         bool self) {
    run_without_gil([&] {
      range_ = parse_frames(range);
      source_ = std::make_unique<FrameSource>(arguments_of(names, weld), range_, self);
    });
  }
  long first() const { return range_.first; }
  long last() const { return range_.last; }
  Kept at(long frame) {
    if (frame < range_.first || frame > range_.last)
      raise("frame", std::to_string(frame) + " is none of the frames", "give one of them", true);
    const Turn turn(used_, "Frames");
    return without_gil([&] { return std::make_unique<KeptScene>(source_->at(frame)); });
  }

 private:
  FrameRange range_;
  std::atomic_flag used_;
  std::unique_ptr<FrameSource> source_;
};

// Merges vertices that are at most `tolerance` apart. Returns the triangles of the merged mesh.
py::array_t<std::uint32_t> welded(const py::array_t<double>& vertices,
                                  const py::array_t<std::int64_t>& triangles,
                                  const std::string& tolerance) {
  py::array_t<std::uint32_t> out({triangles.shape(0), py::ssize_t{3}});
  std::uint32_t* const to = out.mutable_data();
  const std::span<const double> points(vertices.data(), static_cast<std::size_t>(vertices.size()));
  const std::span<const std::int64_t> corners(triangles.data(),
                                              static_cast<std::size_t>(triangles.size()));
  run_without_gil([&] {
    Mesh mesh;
    for (std::size_t k = 0; k + 2 < points.size(); k += 3)
      mesh.vertices.emplace_back(points[k], points[k + 1], points[k + 2]);
    for (std::size_t k = 0; k + 2 < corners.size(); k += 3) {
      mesh.triangles.push_back({static_cast<std::uint32_t>(corners[k]),
                                static_cast<std::uint32_t>(corners[k + 1]),
                                static_cast<std::uint32_t>(corners[k + 2])});
    }
    weld(mesh, parse_weld(tolerance));
    std::ranges::copy(mesh.triangles | std::views::join, to);
  });
  return out;
}

// Returns the pairs of objects whose names match the patterns `first` and `second`. what: name of
// the patterns in errors.
Ignored pairs_named(const KeptScene& kept, const std::string& first, const std::string& second,
                    const std::string& what) {
  return without_gil([&] {
    Ignored out;
    for (const ObjectPair& pair : pairs_between(*kept.scene, first, second, "ignore", what))
      out.push_back({pair.a, pair.b});
    return out;
  });
}

}  // namespace

void add_scenes(py::module_& module) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const auto rows = [](auto rows_of) {
    return [rows_of](py::object self) {
      const auto& out = (*self.cast<const KeptScene&>().scene).*rows_of;
      return view_of(out.empty() ? nullptr : out[0].data(),
                     {static_cast<py::ssize_t>(out.size()), 3}, self);
    };
  };
  const auto each = [](auto member) {
    return [member](const KeptScene& k) {
      py::list out;
      for (const Object& object : k.scene->objects) out.append(object.*member);
      return out;
    };
  };
  py::class_<KeptScene>(module, "Scene")
      .def_property_readonly("name", [](const KeptScene& k) { return k.scene->name; })
      .def_property_readonly("vertices", rows(&Scene::vertices))
      .def_property_readonly("triangles", rows(&Scene::triangles))
      .def_property_readonly("object_starts",
                             [](const KeptScene& k) {
                               std::vector<std::int64_t> out;
                               for (const Object& o : k.scene->objects)
                                 out.push_back(o.first_triangle);
                               return py::array_t<std::int64_t>(py::cast(out));
                             })
      .def_property_readonly("ignored",
                             [](const KeptScene& k) { return pair_array(k.scene->ignored); })
      .def("pairs_named", &pairs_named)
      .def_property_readonly("names", each(&Object::name))
      .def_property_readonly("self", each(&Object::self));
  module.def("scene_of_arrays", &from_arrays);
  module.def("scene_of_names", &from_names);
  module.def("weld", &welded);
  module.def("take_reading_notes", &take_reading_notes);
  module.def("builtin_scenes", [] {
    py::list out;
    for (const BuiltinScene& scene : builtin_scenes()) out.append(scene.name);
    return out;
  });
  py::class_<Frames>(module, "Frames")
      .def(
          py::init<const std::vector<std::string>&, const std::string&, const std::string&, bool>())
      .def_property_readonly("first", &Frames::first)
      .def_property_readonly("last", &Frames::last)
      .def("at", &Frames::at);
}

namespace {

struct KeptRecord {
  std::shared_ptr<const Scene> scene;
  Record record;

  // Returns all missed pairs. The record may hold only the first missed pairs.
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

// ignore: pairs of different objects. limit: maximum number of pairs; 0: no limit.
RunOptions options_of(const GivenOptions& given, const Ignored& ignore, std::uint64_t limit,
                      bool verify = true, bool kinds = false) {
  RunOptions out{.verify = verify,
                 .limit = limit,
                 .contacts = kinds ? ContactDetail::kinds : ContactDetail::none};
  for (const auto& [a, b] : ignore) out.ignored.push_back({a, b});
  out.ignored = in_order(std::move(out.ignored));
  return read_options(given, out);
}

void require_pairs(const Scene& scene) {
  const NothingToTest nothing = nothing_to_test(scene);
  if (nothing.reason.empty()) return;
  throw Error("scene", "nothing to test: " + nothing.reason,
              nothing.with_self ? "make the scene with self=True, or of two objects or more"
                                : "make it of two objects or more");
}

KeptRecord run_of(const KeptScene& kept, const GivenOptions& given, bool verify, unsigned threads,
                  bool kinds, const Ignored& ignore, std::uint64_t limit) {
  return without_gil([&] {
    const RunOptions options = options_of(given, ignore, limit, verify, kinds);
    require_pairs(*kept.scene);
    require_asked(*kept.scene, options.ignored, "ignore", "make the scene with self=True");
    Session session(options.device, threads, Say());
    return KeptRecord{kept.scene, run(*kept.scene, options, session, stopping_progress())};
  });
}

py::object kinds_of(const Record& record, const std::vector<ContactShape>& contacts) {
  if (record.options.contacts == ContactDetail::none) return py::none();
  return kind_array(contacts);
}

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

// certificate: text of a certificate. pairs: a list of pairs to check. One of the two may be empty.
py::dict check_of(const KeptScene& kept, const std::optional<std::string>& certificate,
                  const std::optional<py::array>& pairs, std::optional<double> clearance) {
  const Scene& scene = *kept.scene;
  std::optional<GivenList> list;
  if (pairs) list = listed(scene, pairs_of(*pairs, "pairs", scene.triangles.size()));
  const SceneCheck check = without_gil([&] {
    std::optional<Certificate> parsed;
    if (certificate) parsed = parse_certificate(*certificate, "certificate");
    const double asked = clearance.value_or(parsed ? parsed->clearance : 0);
    return check_scene_with(
        asked, "certificate", parsed, scene, list ? &*list : nullptr,
        list ? std::span<const ListedPair>(list->rows) : std::span<const ListedPair>());
  });
  const CheckResult& result = check.result;
  return py::dict("verdict"_a = to_string(result.verdict), "reason"_a = result.reason,
                  "pair"_a = result.pair
                                 ? py::object(py::make_tuple(result.pair->a, result.pair->b))
                                 : py::object(py::none()),
                  "decided"_a = !result.list_sha256.empty(), "pairs"_a = pair_array(result.meeting),
                  "culled_meeting"_a = result.culled_meeting, "unattested"_a = result.unattested,
                  "text"_a = check_text(scene, check));
}

// Returns the pixels, the texts of the panels, and an HTML page with the same results. The page is
// empty if `page` is false.
py::tuple picture_of(const KeptScene& kept, const std::vector<GivenOptions>& panels,
                     const std::string& view, const std::string& up, bool zoom, int width,
                     int height, const std::string& device, unsigned threads, bool page) {
  std::string html;
  const PictureResult result = without_gil([&] {
    if (page) require_three();
    PictureArguments arguments;
    arguments.scene = {kept.scene->name};
    arguments.view = view;
    arguments.up = up;
    arguments.zoom = zoom;
    arguments.width = width;
    arguments.height = height;
    for (const GivenOptions& given : panels) arguments.panels.push_back(read_options(given));
    validate(arguments);
    MeasurementContext lab(device, stopping_progress(), threads);
    lab.scene(kept.scene->name, [&] { return *kept.scene; });
    PictureResult flat = make_picture(arguments, lab);
    if (page) {
      html = make_page({.picture = arguments, .steps = arguments.panels}, flat, lab).html;
    }
    return flat;
  });
  const Image& image = result.image;
  static_assert(sizeof(Rgba) == 4);
  py::array_t<std::uint8_t> pixels({image.height, image.width, 4});
  std::memcpy(pixels.mutable_data(), image.pixels.data(), 4 * image.pixels.size());
  py::list shown;
  for (const PanelResult& p : result.panels) {
    shown.append(py::dict("title"_a = p.title, "headline"_a = p.headline,
                          "colliding"_a = p.colliding, "missed"_a = p.missed, "kept"_a = p.kept,
                          "device"_a = p.device));
  }
  return py::make_tuple(pixels, shown, html);
}

struct KeptClash {
  std::shared_ptr<const Scene> scene;
  ClashRecord record;
};

KeptClash clash_of(const KeptScene& kept, double clearance, const std::string& tolerance,
                   const Ignored& ignore, bool depth, unsigned threads) {
  return without_gil([&] {
    auto scene = std::make_shared<Scene>(*kept.scene);
    for (Object& object : scene->objects) object.self = false;
    ClashOptions options{.clearance = clearance,
                         .ignored = scene->ignored,
                         .tolerance = parse_weld(tolerance, "tolerance").length(bounds(*scene)),
                         .depth = depth,
                         .threads = threads};
    for (const auto& [a, b] : ignore) options.ignored.push_back({a, b});
    options.ignored = in_order(std::move(options.ignored));
    scene->ignored.clear();
    ClashRecord record = clashes(*scene, options, stopping_progress());
    return KeptClash{std::move(scene), std::move(record)};
  });
}

}  // namespace

void add_runs(py::module_& module) {
  py::class_<KeptRecord> made(module, "Record");
  const auto property = [&](const char* name, auto read) {
    made.def_property_readonly(name, [read](const KeptRecord& k) { return read(k.record); });
  };
  property("pairs", [](const Record& r) { return pair_array(r.collisions.pairs); });
  property("neighbour_pairs",
           [](const Record& r) { return pair_array(r.collisions.neighbour_pairs); });
  property("kinds", [](const Record& r) { return kinds_of(r, r.contacts); });
  property("neighbour_kinds", [](const Record& r) { return kinds_of(r, r.neighbour_contacts); });
  property("complete", [](const Record& r) { return r.complete; });
  property("candidates", [](const Record& r) { return r.found.count; });
  property("views", [](const Record& r) {
    py::list out;
    for (const ViewReport& v : r.found.views()) {
      out.append(py::dict("name"_a = v.name, "looked"_a = v.drawn, "width"_a = v.width,
                          "height"_a = v.height, "radius_px"_a = v.radius_px));
    }
    return out;
  });
  property("promises", [](const Record& r) { return r.promise.holds; });
  property("promises_reason", [](const Record& r) { return r.promise.reason; });
  property("accounting", [](const Record& r) -> py::object {
    if (!r.verification) return py::none();
    const Accounting& all = *r.verification;
    return py::dict(
        "pairs_total"_a = all.pairs_total, "ignored"_a = all.ignored,
        "pairs_kept"_a = all.pairs_kept, "certified_by_boxes"_a = all.certified_by_boxes,
        "neighbours"_a = all.neighbours, "certified_by_predicates"_a = all.certified_by_predicates,
        "false_negatives"_a = all.false_negatives, "ms"_a = all.ms);
  });
  const auto viewed = [&](const char* name, auto numbers) {
    made.def_property_readonly(name, [numbers](py::object self) {
      const auto& out = self.cast<const KeptRecord&>().record.found.*numbers;
      return view_of(out.data(), {static_cast<py::ssize_t>(out.size())}, self);
    });
  };
  viewed("bits", &Candidates::bits);
  viewed("kept_triangles", &Candidates::triangles);
  const auto text = [](auto& of, const char* name, auto write) {
    using Answer = typename std::decay_t<decltype(of)>::type;
    of.def(name, [write](const Answer& k) { return without_gil([&] { return write(k); }); });
  };
  text(made, "json", [](const KeptRecord& k) { return to_json(*k.scene, k.record).dump(); });
  text(made, "table", [](const KeptRecord& k) { return run_table(*k.scene, k.record); });
  made.def("missed", [](const KeptRecord& k) -> py::object {
    if (!k.record.verification) return py::none();
    return pair_array(without_gil([&] { return k.missed(); }));
  });
  made.def("certificate", [](const KeptRecord& k) {
    if (k.record.options.limit > 0 || !k.record.options.ignored.empty()) {
      raise("certificate", "is about all colliding pairs of all objects",
            "run without ignore and limit", true);
    }
    return without_gil([&] { return to_text(certificate_of(*k.scene, k.record)); });
  });
  // Maps the keywords of run() to true for flags. method and limit are separate parameters.
  py::dict options;
  for (const Option& option : run_options()) {
    if (option.take && option.name != std::string("method") && option.name != std::string("limit"))
      options[option.name] = *option.type == 0;
  }
  module.attr("options") = options;
  module.def("run", &run_of);
  module.def("check", &check_of);
  module.def("picture", &picture_of);
  py::class_<KeptClash> clash(module, "Clash");
  text(clash, "json", [](const KeptClash& k) { return clash_json(*k.scene, k.record).dump(); });
  text(clash, "table", [](const KeptClash& k) { return clash_text(*k.scene, k.record, {}); });
  text(clash, "page", [](const KeptClash& k) { return clash_page(*k.scene, k.record, ""); });
  module.def("clash", &clash_of);
}

}  // namespace farcull::python
