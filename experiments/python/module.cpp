// The compiled module of the Python package farcull. The package checks arguments before it calls
// the module. Messages name parameters such as depth_format, not options such as "--depth-format".
#include "experiments/python/arrays.h"

#include <cxxabi.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>

#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "experiments/method/options.h"

namespace farcull::python {
namespace {

constexpr std::chrono::milliseconds kLook{50};  // time between checks for signals

// Allocates and frees one large block. This raises the thresholds of the GNU C library, which then
// keeps more free memory. Otherwise each call requests the same pages again, which took half of the
// time of small scenes. Thresholds that the environment or mallopt() has set are not changed.
void keep_small_memory() {
#ifdef __GLIBC__
  static const bool done = [] {
    constexpr std::size_t kBlock = std::size_t{31} << 20;
    void* volatile block = std::malloc(kBlock);  // volatile: the compiler keeps malloc() and free()
    std::free(block);
    return true;
  }();
  static_cast<void>(done);
#endif
}

// Registers a call while the call runs. When the interpreter ends, end_all() stops all registered
// calls, since the process then destroys objects that these calls use.
class Running {
 public:
  explicit Running(StoppableCall& call) : call_(call) {
    const std::lock_guard lock(all().mutex);
    all().calls.insert(&call);
    if (all().ending) call.stop();
  }
  ~Running() {
    const std::lock_guard lock(all().mutex);
    all().calls.erase(&call_);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  static void end_all() {
    const std::lock_guard lock(all().mutex);
    all().ending = true;
    if (::getpid() != all().process) return;  // a forked process lacks the threads of the calls
    for (StoppableCall* call : all().calls) call->stop();
    for (StoppableCall* call : all().calls) {
      while (!call->wait_for(kLook)) {
      }
    }
  }

 private:
  struct All {
    std::mutex mutex;
    std::set<StoppableCall*> calls;
    bool ending = false;
    pid_t process = ::getpid();
  };
  // Never destroyed, since threads of the interpreter may use this object until the process ends.
  static All& all() {
    static All& made = *new All;
    return made;
  }

  StoppableCall& call_;
};

// Returns whether the call has ended. Waits up to kLook without the lock of the interpreter. If the
// interpreter shuts down meanwhile, PyEval_RestoreThread() unwinds this thread. The unwinding would
// run destructors that use Python, so the thread sleeps here until the process ends.
bool ended(StoppableCall& call) {
  PyThreadState* const state = PyEval_SaveThread();
  const bool ended = call.wait_for(kLook);
  try {
    PyEval_RestoreThread(state);
  } catch (const abi::__forced_unwind&) {
    for (;;) ::pause();
  }
  return ended;
}

// Replaces options such as "--depth-format" in the text by parameters such as depth_format.
std::string as_parameters(const std::string& text) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text.compare(at, 2, "--") != 0 || at + 2 >= text.size() || !letter(text[at + 2])) {
      out += text[at];
      continue;
    }
    for (at += 2; at < text.size() && (letter(text[at]) || text[at] == '-'); ++at)
      out += text[at] == '-' ? '_' : text[at];
    --at;
  }
  return out;
}

// True if `where`, the place of an Error, is a parameter of the Python package.
bool is_parameter(std::string_view where) {
  constexpr std::array<std::string_view, 19> kNames = {
      "V",       "F",         "vertices",  "triangles", "object_starts", "self_objects",
      "threads", "clearance", "tolerance", "views",     "resolution",    "neighbours",
      "kind",    "within",    "k",         "ignore",    "limit",         "poses",
      "names"};
  return std::find(kNames.begin(), kNames.end(), where) != kNames.end();
}

std::string parameter_of(const std::string& where) {
  if (where == "self_objects") return "self";
  if (where == "vertices") return "V";
  if (where == "triangles") return "F";
  return where;
}

void set(const std::string& where, const std::string& reason, const std::string& remedy,
         bool input) {
  const bool missing = reason == "the file does not exist";
  const py::object type = py::module_::import("farcull").attr(missing ? "MissingFileError"
                                                              : input ? "InputError"
                                                                      : "Error");
  const py::object made = type(where, reason, remedy);
  PyErr_SetObject(type.ptr(), made.ptr());
}

void set_from(const std::string& where, const std::string& reason, const std::string& remedy) {
  const bool option = where.starts_with("--");
  set(option ? as_parameters(where) : parameter_of(where), as_parameters(reason),
      as_parameters(remedy), option || is_parameter(where));
}

void translate(std::exception_ptr failure) {
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const Error& error) {
    const std::string line = error.line > 0 ? ":" + std::to_string(error.line) : "";
    set_from(error.where + line, error.reason, error.remedy);
  } catch (const std::system_error& error) {
    // The system could not start a thread, which needs memory for its stack.
    if (error.code() != std::errc::resource_unavailable_try_again) throw;
    PyErr_SetString(PyExc_MemoryError, "farcull: no thread can be started");
  } catch (const Stopped&) {
    set("farcull", "the interpreter is ending", "wait for threads that call farcull", false);
  } catch (const std::length_error&) {
    PyErr_SetString(PyExc_MemoryError, "farcull: more than fits into memory");
  } catch (const std::logic_error& error) {
    set("farcull", std::string("a fault of farcull itself: ") + error.what(),
        "report it with what was called", false);
  }
}

[[noreturn]] void refuse(const std::string& name, const std::string& reason,
                         const std::string& remedy) {
  raise(name, reason, remedy, true);
}

template <class Number>
std::span<const Number> numbers_of(const py::array& array) {
  return {static_cast<const Number*>(array.data()), static_cast<std::size_t>(array.size())};
}

// pybind11 and numpy have global variables, which all interpreters of a process share. If the first
// interpreter that uses pybind11 is not the main interpreter, pybind11 waits forever.
constexpr const char* kNotMain =
    "farcull: interpreter: is not the main one of the process; import farcull there, or in a "
    "process of its own";

bool in_main_interpreter() { return PyInterpreterState_Get() == PyInterpreterState_Main(); }

// Stops all running calls and waits for their end. Later calls stop at once. Called when the
// interpreter ends, with the lock of the interpreter.
void end_calls() {
  const py::gil_scoped_release released;
  Running::end_all();
}

void fill(py::module_& module) {
  // Other interpreters get this module without a call of PyInit, so the package calls this check.
  module.def("require_main_interpreter", [] {
    if (!in_main_interpreter()) throw py::import_error(kNotMain);
  });
  // Converts an Error that names a parameter to InputError, any other Error to farcull.Error, and
  // std::bad_alloc to MemoryError.
  py::register_exception_translator(&translate);
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_calls));
  spell_parameters(option_word);  // for names in records; exceptions use as_parameters()
  add_collider(module);
  add_distances(module);
  add_scenes(module);
  add_runs(module);
}

py::module_::module_def definition;

}  // namespace

void run_without_gil(const std::function<void()>& work) {
  keep_small_memory();
  StoppableCall call([&work] {
    const FloatingPointGuard guard;
    work();
  });
  const Running running(call);
  std::optional<py::error_already_set> interrupted;
  while (!ended(call)) {
    if (interrupted || PyErr_CheckSignals() == 0) continue;
    interrupted.emplace();
    call.stop();
  }
  if (interrupted) throw std::move(*interrupted);
  call.finish();
}

Turn::Turn(std::atomic_flag& used, const char* name) : used_(used) {
  if (used_.test_and_set())
    raise(name, "is in use by another thread or call", "make one for each thread", false);
}

Progress stopping_progress() {
  return [](const ProgressStep&) { stop_point(); };
}

void raise(const std::string& where, const std::string& reason, const std::string& remedy,
           bool input) {
  set(where, reason, remedy, input);
  throw py::error_already_set();
}

MeshArrays::MeshArrays(const py::array& vertices, const py::array& triangles,
                       const py::array_t<std::int64_t>& object_starts,
                       const py::array_t<double>& poses)
    : kept_{vertices, triangles} {
  for (py::ssize_t k = 0; k < object_starts.size(); ++k) {
    const std::int64_t first = object_starts.at(k);
    if (first < 0 || first > std::numeric_limits<std::uint32_t>::max()) {
      refuse("object_starts",
             "object " + std::to_string(k) + " starts at triangle " + std::to_string(first),
             "give the first triangle of each object, ascending from 0");
    }
    starts_.push_back(static_cast<std::uint32_t>(first));
  }
  poses_.resize(static_cast<std::size_t>(poses.shape(0)));
  const double* from = poses.data();
  for (Pose& pose : poses_) {
    for (std::size_t row = 0; row < 3; ++row, from += 4) {
      std::copy(from, from + 3, pose.r.begin() + static_cast<std::ptrdiff_t>(3 * row));
      pose.t[row] = from[3];
    }
  }
  input_ = {numbers_of<double>(vertices), {}, starts_, {}, poses_};
  if (triangles.itemsize() == sizeof(std::int64_t)) {
    input_.wide_triangles = numbers_of<std::int64_t>(triangles);
  } else {
    input_.triangles = numbers_of<std::uint32_t>(triangles);
  }
}

std::vector<TrianglePair> pairs_of(const py::array& array, const std::string& name,
                                   std::size_t triangles) {
  // The caller has checked that these are whole numbers. Numbers of 2^63 or more become negative.
  const auto given =
      py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!given || given.ndim() != 2 || given.shape(1) != 2)
    refuse(name, "have no two columns", "give an array of shape (k, 2)");
  std::vector<TrianglePair> out(static_cast<std::size_t>(given.shape(0)));
  const std::int64_t* from = given.data();
  for (std::size_t k = 0; k < out.size(); ++k, from += 2) {
    const auto [low, high] = std::minmax(from[0], from[1]);
    if (low < 0 || static_cast<std::uint64_t>(high) >= triangles) {
      refuse(name,
             "row " + std::to_string(k) + " names triangles " + std::to_string(from[0]) + " and " +
                 std::to_string(from[1]) + " of " + std::to_string(triangles),
             "give numbers of triangles from 0");
    }
    out[k] = {static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high)};
  }
  return out;
}

}  // namespace farcull::python

// Same as PYBIND11_MODULE, except that every interpreter but the main interpreter is refused.
extern "C" PYBIND11_EXPORT PyObject* PyInit__farcull();
extern "C" PYBIND11_EXPORT PyObject* PyInit__farcull() {
  namespace python = farcull::python;
  if (!python::in_main_interpreter()) {
    PyErr_SetString(PyExc_ImportError, python::kNotMain);
    return nullptr;
  }
  pybind11::detail::get_internals();
  auto module =
      pybind11::module_::create_extension_module("_farcull", nullptr, &python::definition);
  try {
    python::fill(module);
    return module.ptr();
  }
  PYBIND11_CATCH_INIT_EXCEPTIONS
}
