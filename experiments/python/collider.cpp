// The collider, the stream and distances of the library.
#include <pybind11/stl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiments/library/distance.h"
#include "experiments/python/arrays.h"
#include "verify/contact.h"

namespace farcull::python {
namespace {

using namespace py::literals;

Device device_of(const std::string& name) {
  if (name == "cpu") return Device::cpu;
  if (name == "gl") return Device::gl;
  if (name == "best") return Device::best;
  raise("device", "'" + name + "' is no choice", "give cpu, gl or best", true);
}

py::dict report_of(const Report& report) {
  py::list views, stages;
  for (const Report::View& v : report.views) {
    views.append(py::dict("name"_a = v.name, "looked"_a = v.looked, "reason"_a = v.reason,
                          "width"_a = v.width, "height"_a = v.height));
  }
  for (const Report::Stage& s : report.stages) {
    stages.append(py::dict("name"_a = s.name, "ran"_a = s.ran, "reason"_a = s.reason, "ms"_a = s.ms,
                           "entered"_a = s.in, "left"_a = s.out, "unit"_a = s.unit));
  }
  return py::dict("device"_a = report.device, "device_reason"_a = report.device_reason,
                  "promises"_a = report.promises, "promises_reason"_a = report.promises_reason,
                  "candidates_ms"_a = report.candidates_ms, "exact_ms"_a = report.exact_ms,
                  "candidates"_a = report.candidates, "neighbours"_a = report.neighbours,
                  "decided"_a = report.decided, "contacts_ms"_a = report.contacts_ms,
                  "passed_over"_a = report.passed_over,
                  "callers_arithmetic"_a = report.callers_arithmetic, "views"_a = std::move(views),
                  "stages"_a = std::move(stages));
}

py::dict result_of(const Result& result, bool kinds) {
  return py::dict(
      "pairs"_a = pair_array(result.pairs),
      "neighbour_pairs"_a = pair_array(result.neighbour_pairs),
      "kinds"_a = kinds ? py::object(kind_array(result.contacts)) : py::none(),
      "neighbour_kinds"_a = kinds ? py::object(kind_array(result.neighbour_contacts)) : py::none(),
      "complete"_a = result.complete, "report"_a = report_of(result.report));
}

// A forked process lacks the threads and the device of objects made before the fork.
void require_process(pid_t maker, const char* made) {
  if (::getpid() == maker) return;
  raise(made, "was made by another process, which this one was forked from",
        "make one in each process", false);
}

// A collider for one thread at a time, and for one process.
class KeptCollider {
 public:
  explicit KeptCollider(const Options& options)
      : process_(::getpid()), kinds_(options.contacts != Contacts::none) {
    beside([&] { collider_ = std::make_unique<Collider>(options); });
  }

  py::dict find(const py::array& vertices, const py::array& triangles, const py::array& starts) {
    require_process(process_, "Collider");
    const Turn turn(used_, "Collider");
    const Given given(vertices, triangles, starts);
    const Result result = answer_beside([&] { return collider_->find(given.input(copies_)); });
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

// In the order of DistanceInside.
constexpr std::array kInside = {"unknown", "none", "a", "b", "not closed"};

py::list distances_of(const py::array& vertices, const py::array& triangles,
                      const py::array& starts, const std::string& kind, std::size_t k,
                      double within, bool self, const std::vector<bool>& self_objects, bool inside,
                      unsigned threads) {
  const DistanceFinderOptions options{.kind = kind_of(kind),
                                      .k = k,
                                      .within = within < 0 ? std::optional<double>() : within,
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
    out.append(py::dict(
        "objects"_a = std::pair(d.object_a, d.object_b),
        "triangles"_a = std::pair(d.triangle_a, d.triangle_b), "distance"_a = d.distance,
        "squared"_a = d.squared,
        "points"_a = std::pair(py::tuple(py::cast(d.point_a)), py::tuple(py::cast(d.point_b))),
        "features"_a = std::pair(d.feature_a, d.feature_b),
        "inside"_a = kInside.at(static_cast<std::size_t>(d.inside))));
  }
  return out;
}

}  // namespace

Options options_of(const py::dict& question) {
  return {.threads = question["threads"].cast<unsigned>(),
          .self = question["all_objects"].cast<bool>(),
          .self_objects = question["self_objects"].cast<std::vector<bool>>(),
          .clearance = question["clearance"].cast<double>(),
          .neighbours = question["neighbours"].cast<bool>(),
          .contacts = question["kinds"].cast<bool>() ? Contacts::kinds : Contacts::none,
          .ignore = question["ignore"].cast<std::vector<std::array<std::uint32_t, 2>>>(),
          .limit = question["limit"].cast<std::uint64_t>()};
}

void add_collider(py::module_& module) {
  py::class_<KeptCollider>(module, "Collider")
      .def(py::init([](const py::dict& question, const std::string& device,
                       const std::string& views, int resolution) {
             Options options = options_of(question);
             options.device = device_of(device);
             options.advanced.views = views;
             options.advanced.resolution = resolution;
             return std::make_unique<KeptCollider>(options);
           }),
           py::arg("question"), py::kw_only(), py::arg("device"), py::arg("views"),
           py::arg("resolution"))
      .def("find", &KeptCollider::find);
  // Codes of kinds are indices into this tuple, for both enumerations.
  static_assert(static_cast<int>(Contact::Kind::touch_face) + 1 == kContactKinds.size());
  py::tuple kinds(kContactKinds.size());
  for (std::size_t k = 0; k < kContactKinds.size(); ++k)
    kinds[k] = to_string(static_cast<Contact::Kind>(k));
  module.attr("kinds") = kinds;
}

void add_distances(py::module_& module) { module.def("distances", &distances_of); }

// Pairs part by part: the stream of the library.

namespace {

// A stream for one thread at a time and for one process, like KeptCollider. After each next()
// Python must call take(). If a signal or a lack of memory prevents that, the following next()
// throws, since nobody would notice the gap.
class KeptStream {
 public:
  KeptStream(const py::array& vertices, const py::array& triangles, const py::array& starts,
             const Options& options)
      : process_(::getpid()), kinds_(options.contacts != Contacts::none) {
    const Given given(vertices, triangles, starts);
    beside([&] {
      Copies copies;
      stream_ = std::make_unique<Stream>(given.input(copies), options);
    });
  }

  // The next part of the pairs, perhaps empty; None after the last part.
  py::object next() {
    require_process(process_, "Stream");
    const Turn turn(used_, "Stream");
    if (given_) {
      raise("stream", "an earlier call was interrupted, and its pairs are lost",
            "make a new stream; one for each thread", false);
    }
    given_ = true;
    const bool more = answer_beside([&] { return stream_->next(found_); });
    decided_ = stream_->decided();
    complete_ = stream_->complete();
    if (!more) {
      given_ = false;
      return py::none();
    }
    const auto count = static_cast<py::ssize_t>(found_.size());
    py::array_t<std::int64_t> pairs({count, py::ssize_t{2}});
    py::array_t<bool> neighbours(count);
    py::array_t<std::uint8_t> kinds(kinds_ ? count : 0);
    std::int64_t* pair = pairs.mutable_data();
    bool* neighbour = neighbours.mutable_data();
    std::uint8_t* kind = kinds.mutable_data();
    for (const StreamedPair& one : found_) {
      *pair++ = one.pair.a;
      *pair++ = one.pair.b;
      *neighbour++ = one.neighbours;
      if (kinds_) *kind++ = static_cast<std::uint8_t>(one.contact.kind);
    }
    return py::make_tuple(pairs, neighbours, kinds_ ? py::object(kinds) : py::none());
  }

  void take() { given_ = false; }

  // The values after the last next(), so that they can be read while another thread calls it.
  std::uint64_t decided() const { return decided_; }
  bool complete() const { return complete_; }

 private:
  pid_t process_;
  bool kinds_;
  bool given_ = false;  // a call began, and its pairs were not taken
  std::atomic_flag used_;
  std::unique_ptr<Stream> stream_;
  std::vector<StreamedPair> found_;
  std::uint64_t decided_ = 0;
  bool complete_ = false;
};

}  // namespace

void add_stream(py::module_& module) {
  py::class_<KeptStream>(module, "Stream")
      .def(py::init([](const py::array& vertices, const py::array& triangles,
                       const py::array& starts, const py::dict& question) {
        return std::make_unique<KeptStream>(vertices, triangles, starts, options_of(question));
      }))
      .def("next", &KeptStream::next)
      // Python checks for signals after a call, but not after an assignment.
      .def_property(
          "taken", [](const KeptStream&) { return true; },
          [](KeptStream& stream, bool) { stream.take(); })
      .def_property_readonly("decided", &KeptStream::decided)
      .def_property_readonly("complete", &KeptStream::complete);
}

}  // namespace farcull::python
