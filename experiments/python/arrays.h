// Helpers of the compiled module: calls without the interpreter's lock, conversion of arrays to an
// Input, and conversion of answers to arrays.
#pragma once

#include <pybind11/numpy.h>

#include <pybind11/pybind11.h>
#include <atomic>
#include <cstddef>

#include "core/base/stage.h"
#include "core/scene/scene.h"
#include "experiments/library/farcull.h"

namespace farcull::python {

namespace py = pybind11;

/// Runs `work` in its own thread, without the lock of the interpreter, in the floating-point
/// environment that the proofs assume. The calling thread waits, and checks for signals every 50
/// ms. If a signal handler raises an exception (for example Ctrl-C), StoppableCall::stop() is
/// called. The exception is thrown after `work` has ended. Exceptions of `work` are thrown to the
/// caller. Preconditions: the caller holds the lock; `work` does not use Python.
void run_without_gil(const std::function<void()>& work);

/// Runs `work` as run_without_gil() does, and returns its value.
template <class Work>
auto without_gil(const Work& work) {
  std::optional<decltype(work())> out;
  run_without_gil([&] { out.emplace(work()); });
  return std::move(*out);
}

/// Marks an object as in use during the lifetime of the Turn. Throws farcull.Error if the object is
/// in use already, either by another thread or by a call of this thread that a signal handler
/// interrupted.
class Turn {
 public:
  Turn(std::atomic_flag& used, const char* name);
  ~Turn() { used_.clear(); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  std::atomic_flag& used_;
};

/// Returns a Progress that ends a run between two stages if the run has to stop.
Progress stopping_progress();

/// Throws farcull.InputError if `input` is true (an argument is wrong), otherwise farcull.Error.
[[noreturn]] void raise(const std::string& where, const std::string& reason,
                        const std::string& remedy, bool input);

/// Converts arrays to the Input of a call. Only the constructor and the destructor need the
/// interpreter's lock.
class MeshArrays {
 public:
  /// Takes contiguous arrays: vertices (n, 3), doubles; triangles (m, 3), int64 or uint32;
  /// object_starts (k); poses (k, 3, 4), or (0, 3, 4) if no object moves.
  MeshArrays(const py::array& vertices, const py::array& triangles,
             const py::array_t<std::int64_t>& object_starts, const py::array_t<double>& poses);
  MeshArrays(const MeshArrays&) = delete;
  MeshArrays& operator=(const MeshArrays&) = delete;
  /// The returned Input points into the arrays and into this MeshArrays.
  const Input& input() const { return input_; }

 private:
  std::array<py::array, 2> kept_;
  std::vector<std::uint32_t> starts_;
  std::vector<Pose> poses_;
  Input input_;
};

/// Returns pairs as an array (k, 2). The element type of `pairs` has members a and b.
template <class Pairs>
py::array_t<std::int64_t> pair_array(const Pairs& pairs) {
  py::array_t<std::int64_t> out({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}});
  std::int64_t* to = out.mutable_data();
  for (const auto& pair : pairs) {
    *to++ = pair.a;
    *to++ = pair.b;
  }
  return out;
}

/// Returns an array (k): for each contact, the index of its kind in farcull.KINDS.
template <class Contacts>
py::array_t<std::uint8_t> kind_array(const Contacts& contacts) {
  py::array_t<std::uint8_t> out(static_cast<py::ssize_t>(contacts.size()));
  std::uint8_t* to = out.mutable_data();
  for (const auto& contact : contacts) *to++ = static_cast<std::uint8_t>(contact.kind);
  return out;
}

/// Returns memory of `owner` as a read-only array. The array keeps `owner` alive.
template <class Value>
py::array_t<Value> view_of(const Value* data, std::vector<py::ssize_t> shape, py::handle owner) {
  py::array_t<Value> out(std::move(shape), data, owner);
  py::detail::array_proxy(out.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return out;
}

/// Returns the rows (k, 2) as pairs, each with its lower number first. Throws farcull.InputError
/// naming `name` if a number is negative, or not below `triangles`.
std::vector<TrianglePair> pairs_of(const py::array& array, const std::string& name,
                                   std::size_t triangles);

/// A scene that a Python object owns. The scene never changes, so arrays may point into it.
struct KeptScene {
  std::shared_ptr<const Scene> scene;
  explicit KeptScene(Scene given) : scene(std::make_shared<const Scene>(std::move(given))) {}
};

// Each of these functions adds classes and functions to the Python module.
void add_collider(py::module_& module);
void add_distances(py::module_& module);
void add_scenes(py::module_& module);
void add_runs(py::module_& module);

}  // namespace farcull::python
