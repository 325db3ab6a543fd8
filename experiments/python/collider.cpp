// Python classes for the library's Collider and DistanceFinder.
#include <pybind11/stl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <ranges>

#include "experiments/library/distance.h"
#include "experiments/python/arrays.h"
#include "verify/contact.h"

namespace farcull::python {
namespace {

using namespace py::literals;

py::dict report_of(const Report& report) {
  py::list stages;
  for (const Report::Stage& s : report.stages) {
    stages.append(py::dict("name"_a = s.name, "ran"_a = s.ran, "reason"_a = s.reason, "ms"_a = s.ms,
                           "entered"_a = s.in, "left"_a = s.out, "unit"_a = s.unit));
  }
  return py::dict("candidates_ms"_a = report.candidates_ms, "exact_ms"_a = report.exact_ms,
                  "candidates"_a = report.candidates, "neighbours"_a = report.neighbours,
                  "decided"_a = report.decided, "contacts_ms"_a = report.contacts_ms,
                  "passed_over"_a = report.passed_over,
                  "callers_arithmetic"_a = report.callers_arithmetic,
                  "stages"_a = std::move(stages));
}

// Returns an array of kinds and an array of segments. An array that is not `asked` for is None.
std::pair<py::object, py::object> contact_arrays(const std::vector<Contact>& contacts,
                                                 Contacts asked) {
  if (asked == Contacts::none) return {py::none(), py::none()};
  if (asked == Contacts::kinds) return {kind_array(contacts), py::none()};
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  py::array_t<double> segments(
      {static_cast<py::ssize_t>(contacts.size()), py::ssize_t{2}, py::ssize_t{3}});
  double* to = segments.mutable_data();
  for (const Contact& contact : contacts) {
    const bool segment = contact.dimension == 0 || contact.dimension == 1;
    for (const std::array<double, 3>& end : contact.ends) {
      for (const double x : end) *to++ = segment ? x : kNone;
    }
  }
  return {kind_array(contacts), segments};
}

py::dict result_of(const Result& result, Contacts asked) {
  const auto [kinds, segments] = contact_arrays(result.contacts, asked);
  const auto [of_neighbours, between] = contact_arrays(result.neighbour_contacts, asked);
  return py::dict("pairs"_a = pair_array(result.pairs),
                  "neighbour_pairs"_a = pair_array(result.neighbour_pairs), "kinds"_a = kinds,
                  "segments"_a = segments, "neighbour_kinds"_a = of_neighbours,
                  "neighbour_segments"_a = between, "complete"_a = result.complete,
                  "report"_a = report_of(result.report));
}

// Throws if a forked process uses an object of its parent, since only the parent has the threads.
void require_process(pid_t maker, const char* made) {
  if (::getpid() == maker) return;
  raise(made, "was made by another process, which this one was forked from",
        "make one in each process", false);
}

// Holds a Collider or a DistanceFinder. Only the process that made a KeptFinder may use it, and
// only one thread at a time.
template <class Finder, class Asked>
class KeptFinder {
 public:
  KeptFinder(const char* name, Asked given)
      : options(std::move(given)), name_(name), process_(::getpid()) {
    run_without_gil([&] { finder_ = std::make_unique<Finder>(options); });
  }

  auto find(const py::array& vertices, const py::array& triangles, const py::array& starts,
            const py::array& poses) {
    require_process(process_, name_);
    const Turn turn(used_, name_);
    const MeshArrays given(vertices, triangles, starts, poses);
    return without_gil([&] { return finder_->find(given.input()); });
  }

  const Asked options;

 private:
  const char* name_;
  pid_t process_;
  std::atomic_flag used_;
  std::unique_ptr<Finder> finder_;
};

using KeptCollider = KeptFinder<Collider, Options>;
using KeptDistances = KeptFinder<DistanceFinder, DistanceFinderOptions>;

DistanceKind kind_of(const std::string& name) {
  if (name == "objects") return DistanceKind::objects;
  if (name == "nearest") return DistanceKind::nearest;
  if (name == "all") return DistanceKind::all;
  raise("kind", "'" + name + "' is no choice", "give objects, nearest or all", true);
}

// The codes of features, and the codes of DistanceInside, are indices into these two arrays.
constexpr std::array kFeatures = {"vertex 0", "vertex 1", "vertex 2", "edge 0",
                                  "edge 1",   "edge 2",   "face"};
constexpr std::array kInside = {"unknown", "none", "a", "b", "not closed"};

std::uint8_t feature_code(const std::string& feature) {
  if (feature == "face") return 6;
  return static_cast<std::uint8_t>((feature[0] == 'e' ? 3 : 0) + (feature.back() - '0'));
}

// Returns one column for each member of DistanceAnswer. The column `squared` is empty if `exact` is
// false.
py::dict columns_of(const std::vector<DistanceAnswer>& answers, bool exact) {
  const auto count = static_cast<py::ssize_t>(answers.size());
  constexpr py::ssize_t kTwo = 2, kThree = 3;
  py::array_t<std::int64_t> objects({count, kTwo}), triangles({count, kTwo});
  py::array_t<double> distance(count), points({count, kTwo, kThree});
  py::array_t<double> weights({count, kTwo, kThree}), normals({count, kThree});
  py::array_t<std::uint8_t> features({count, kTwo}), inside(count);
  py::list squared(exact ? answers.size() : 0);
  std::int64_t *object = objects.mutable_data(), *triangle = triangles.mutable_data();
  double *point = points.mutable_data(), *weight = weights.mutable_data();
  double* normal = normals.mutable_data();
  std::uint8_t* feature = features.mutable_data();
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const DistanceAnswer& d = answers[k];
    const auto at = static_cast<py::ssize_t>(k);
    object = std::ranges::copy(std::array{d.object_a, d.object_b}, object).out;
    triangle = std::ranges::copy(std::array{d.triangle_a, d.triangle_b}, triangle).out;
    point = std::ranges::copy(d.point_b, std::ranges::copy(d.point_a, point).out).out;
    weight = std::ranges::copy(d.weights_b, std::ranges::copy(d.weights_a, weight).out).out;
    normal = std::ranges::copy(d.normal, normal).out;
    *feature++ = feature_code(d.feature_a);
    *feature++ = feature_code(d.feature_b);
    distance.mutable_at(at) = d.distance;
    inside.mutable_at(at) = static_cast<std::uint8_t>(d.inside);
    if (exact) squared[k] = py::str(d.squared);
  }
  return py::dict("objects"_a = objects, "triangles"_a = triangles, "distance"_a = distance,
                  "squared"_a = squared, "points"_a = points, "weights"_a = weights,
                  "normals"_a = normals, "features"_a = features, "inside"_a = inside);
}

template <class Values, class Name>
py::tuple tuple_of(const Values& values, const Name& name) {
  py::list out;
  for (const auto& value : values) out.append(name(value));
  return py::tuple(out);
}

Options options_of(const py::dict& question) {
  return {.threads = question["threads"].cast<unsigned>(),
          .self = question["all_objects"].cast<bool>(),
          .self_objects = question["self_objects"].cast<std::vector<bool>>(),
          .clearance = question["clearance"].cast<double>(),
          .neighbours = question["neighbours"].cast<bool>(),
          .contacts = static_cast<Contacts>(question["contacts"].cast<int>()),
          .ignore = question["ignore"].cast<std::vector<std::array<std::uint32_t, 2>>>(),
          .limit = question["limit"].cast<std::uint64_t>()};
}

}  // namespace

void add_collider(py::module_& module) {
  py::class_<KeptCollider>(module, "Collider")
      .def(py::init([](const py::dict& question) {
        return std::make_unique<KeptCollider>("Collider", options_of(question));
      }))
      .def("find", [](KeptCollider& kept, const py::array& vertices, const py::array& triangles,
                      const py::array& starts, const py::array& poses) {
        return result_of(kept.find(vertices, triangles, starts, poses), kept.options.contacts);
      });
  // A kind's code is its index in this tuple. Contact::Kind and ContactKind have equal codes.
  static_assert(static_cast<int>(Contact::Kind::touch_face) + 1 == kContactKinds.size());
  module.attr("kinds") = tuple_of(kContactKinds, [](ContactKind kind) { return name_of(kind); });
}

void add_distances(py::module_& module) {
  py::class_<KeptDistances>(module, "DistanceFinder")
      .def(py::init([](const std::string& kind, std::size_t k, std::optional<double> within,
                       bool self, const std::vector<bool>& self_objects, bool inside,
                       const std::vector<std::array<std::uint32_t, 2>>& ignore, unsigned threads,
                       bool exact) {
        return std::make_unique<KeptDistances>("DistanceFinder",
                                               DistanceFinderOptions{.kind = kind_of(kind),
                                                                     .k = k,
                                                                     .within = within,
                                                                     .self = self,
                                                                     .self_objects = self_objects,
                                                                     .inside = inside,
                                                                     .exact = exact,
                                                                     .ignore = ignore,
                                                                     .threads = threads});
      }))
      .def("find", [](KeptDistances& kept, const py::array& vertices, const py::array& triangles,
                      const py::array& starts, const py::array& poses) {
        return columns_of(kept.find(vertices, triangles, starts, poses), kept.options.exact);
      });
  module.attr("features") = tuple_of(kFeatures, std::identity());
  module.attr("inside") = tuple_of(kInside, std::identity());
}

}  // namespace farcull::python
