// Pairs as they come: the stream of the library.
#include <pybind11/stl.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "experiments/python/arrays.h"
#include "experiments/python/parts.h"

namespace farcull::python {
namespace {

// A stream of one thread at a time, and of one process, as a collider. What a call gives has to be
// taken: where a signal, or a lack of memory, comes between, there is no next part, since nobody
// would see the gap.
class KeptStream {
 public:
  KeptStream(const py::array& vertices, const py::array& triangles, const py::array& starts,
             const ColliderOptions& options)
      : process_(::getpid()), kinds_(options.contacts != ColliderContacts::none) {
    const Given given(vertices, triangles, starts);
    beside([&] {
      Copies copies;
      stream_ = std::make_unique<ColliderStream>(given.input(copies), options);
    });
  }

  // The pairs that follow, which may be none; None behind the last.
  py::object next() {
    if (::getpid() != process_) {
      raise("Stream", "was made by another process, which this one was forked from",
            "make one in each process", false);
    }
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
    for (const ColliderFound& one : found_) {
      *pair++ = one.pair.a;
      *pair++ = one.pair.b;
      *neighbour++ = one.neighbours;
      if (kinds_) *kind++ = static_cast<std::uint8_t>(one.contact.kind);
    }
    return py::make_tuple(pairs, neighbours, kinds_ ? py::object(kinds) : py::none());
  }

  void take() { given_ = false; }

  // As they were after the last call, so that they can be asked while another thread calls.
  std::uint64_t decided() const { return decided_; }
  bool complete() const { return complete_; }

 private:
  pid_t process_;
  bool kinds_;
  bool given_ = false;  // a call began, and its pairs were not taken
  std::atomic_flag used_;
  std::unique_ptr<ColliderStream> stream_;
  std::vector<ColliderFound> found_;
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
      // Python looks for signals behind a call, and not behind an assignment.
      .def_property(
          "taken", [](const KeptStream&) { return true; },
          [](KeptStream& stream, bool) { stream.take(); })
      .def_property_readonly("decided", &KeptStream::decided)
      .def_property_readonly("complete", &KeptStream::complete);
}

}  // namespace farcull::python
