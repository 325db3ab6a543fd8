// The collider and distances of the library, for one scene or for many.
#include <pybind11/stl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiments/python/arrays.h"
#include "experiments/python/parts.h"
#include "verify/contact_kind.h"

namespace farcull::python {
namespace {

ColliderDevice device_of(const std::string& name) {
  if (name == "cpu") return ColliderDevice::cpu;
  if (name == "gl") return ColliderDevice::gl;
  if (name == "best") return ColliderDevice::best;
  raise("device", "'" + name + "' is no choice", "give cpu, gl or best", true);
}

py::dict report_of(const ColliderReport& report) {
  py::list views, stages;
  for (const ColliderReport::View& v : report.views) {
    py::dict view;
    view["name"] = v.name;
    view["looked"] = v.looked;
    view["reason"] = v.reason;
    view["width"] = v.width;
    view["height"] = v.height;
    views.append(std::move(view));
  }
  for (const ColliderReport::Stage& s : report.stages) {
    py::dict stage;
    stage["name"] = s.name;
    stage["ran"] = s.ran;
    stage["reason"] = s.reason;
    stage["ms"] = s.ms;
    stage["entered"] = s.in;
    stage["left"] = s.out;
    stage["unit"] = s.unit;
    stages.append(std::move(stage));
  }
  py::dict out;
  out["device"] = report.device;
  out["device_reason"] = report.device_reason;
  out["promises"] = report.promises;
  out["promises_reason"] = report.promises_reason;
  out["candidates_ms"] = report.candidates_ms;
  out["exact_ms"] = report.exact_ms;
  out["candidates"] = report.candidates;
  out["neighbours"] = report.neighbours;
  out["decided"] = report.decided;
  out["contacts_ms"] = report.contacts_ms;
  out["callers_arithmetic"] = report.callers_arithmetic;
  out["views"] = std::move(views);
  out["stages"] = std::move(stages);
  return out;
}

py::dict result_of(const ColliderResult& result, bool kinds) {
  py::dict out;
  out["pairs"] = pair_array(result.pairs);
  out["neighbour_pairs"] = pair_array(result.neighbour_pairs);
  out["kinds"] = kinds ? py::object(kind_array(result.contacts)) : py::none();
  out["neighbour_kinds"] = kinds ? py::object(kind_array(result.neighbour_contacts)) : py::none();
  out["complete"] = result.complete;
  out["report"] = report_of(result.report);
  return out;
}

// A collider of one thread at a time, and of one process: a forked one has neither its threads nor
// its device.
class KeptCollider {
 public:
  explicit KeptCollider(const ColliderOptions& options)
      : process_(::getpid()), kinds_(options.contacts != ColliderContacts::none) {
    beside([&] { collider_ = std::make_unique<Collider>(options); });
  }

  py::dict find(const py::array& vertices, const py::array& triangles, const py::array& starts) {
    if (::getpid() != process_) {
      raise("Collider", "was made by another process, which this one was forked from",
            "make one in each process", false);
    }
    const Turn turn(used_, "Collider");
    const Given given(vertices, triangles, starts);
    const ColliderResult result =
        answer_beside([&] { return collider_->find(given.input(copies_)); });
    return result_of(result, kinds_);
  }

 private:
  pid_t process_;
  bool kinds_;
  Copies copies_;
  std::atomic_flag used_;
  std::unique_ptr<Collider> collider_;
};

DistanceKind kind_of(const std::string& name) {
  if (name == "objects") return DistanceKind::objects;
  if (name == "nearest") return DistanceKind::nearest;
  if (name == "all") return DistanceKind::all;
  raise("kind", "'" + name + "' is no choice", "give objects, nearest or all", true);
}

const char* name_of(DistanceInside inside) {
  switch (inside) {
    case DistanceInside::unknown:
      return "unknown";
    case DistanceInside::none:
      return "none";
    case DistanceInside::a:
      return "a";
    case DistanceInside::b:
      return "b";
    case DistanceInside::not_closed:
      return "not closed";
  }
  return "unknown";
}

py::list distances_of(const py::array& vertices, const py::array& triangles,
                      const py::array& starts, const std::string& kind, std::size_t k,
                      double within, bool self, const std::vector<bool>& self_objects, bool inside,
                      unsigned threads) {
  const DistanceFinderOptions options{.kind = kind_of(kind),
                                      .k = k,
                                      .within = within,
                                      .self = self,
                                      .self_objects = self_objects,
                                      .inside = inside,
                                      .threads = threads};
  const Given given(vertices, triangles, starts);
  const std::vector<DistanceAnswer> answers = answer_beside([&] {
    Copies copies;
    return distances(given.input(copies), options);
  });
  py::list out;
  for (const DistanceAnswer& d : answers) {
    py::dict answer;
    answer["objects"] = std::pair(d.object_a, d.object_b);
    answer["triangles"] = std::pair(d.triangle_a, d.triangle_b);
    answer["distance"] = d.distance;
    answer["squared"] = d.squared;
    answer["points"] = std::pair(py::tuple(py::cast(d.point_a)), py::tuple(py::cast(d.point_b)));
    answer["features"] = std::pair(d.feature_a, d.feature_b);
    answer["inside"] = name_of(d.inside);
    out.append(std::move(answer));
  }
  return out;
}

}  // namespace

ColliderOptions options_of(const py::dict& question) {
  return {
      .threads = question["threads"].cast<unsigned>(),
      .self = question["all_objects"].cast<bool>(),
      .self_objects = question["self_objects"].cast<std::vector<bool>>(),
      .clearance = question["clearance"].cast<double>(),
      .neighbours = question["neighbours"].cast<bool>(),
      .contacts = question["kinds"].cast<bool>() ? ColliderContacts::kinds : ColliderContacts::none,
      .ignore = question["ignore"].cast<std::vector<std::array<std::uint32_t, 2>>>(),
      .limit = question["limit"].cast<std::uint64_t>()};
}

void add_collider(py::module_& module) {
  py::class_<KeptCollider>(module, "Collider")
      .def(py::init([](const py::dict& question, const std::string& device,
                       const std::string& views, int resolution) {
             ColliderOptions options = options_of(question);
             options.device = device_of(device);
             options.views = views;
             options.resolution = resolution;
             return std::make_unique<KeptCollider>(options);
           }),
           py::arg("question"), py::kw_only(), py::arg("device"), py::arg("views"),
           py::arg("resolution"))
      .def("find", &KeptCollider::find);
  // Codes of kinds are places in this tuple, whichever of the two enumerations they come from.
  static_assert(static_cast<int>(ColliderContactKind::touch_face) + 1 == kContactKinds.size());
  py::tuple kinds(kContactKinds.size());
  for (std::size_t k = 0; k < kContactKinds.size(); ++k)
    kinds[k] = to_string(static_cast<ColliderContactKind>(k));
  module.attr("kinds") = kinds;
}

void add_distances(py::module_& module) { module.def("distances", &distances_of); }

}  // namespace farcull::python
