// Runs calls in their own threads, turns exceptions of C++ into those of Python, and defines the
// compiled module. Messages name parameters, not options: depth_format, not "--depth-format".
#include "experiments/python/arrays.h"

#include <cxxabi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/base/parallel.h"
#include "experiments/library/farcull.h"
#include "experiments/method/options.h"

namespace farcull::python {
namespace {

constexpr std::chrono::milliseconds kLook{50};  // between checks for signals

// The GNU C library returns free memory at the top of a thread's heap to the system if it exceeds
// twice the largest block that was mapped and freed before, at most 32 MB. While that limit is low,
// each call requests the same pages again, and writing to new pages took half of the time of small
// scenes. So one large block is mapped and freed, never written to, which raises the limit. A limit
// that the environment or mallopt() has set stays.
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

// The running calls. They are stopped at the end of the interpreter, since they would use what the
// process destroys.
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
    if (::getpid() != all().process) return;  // a fork does not have the threads of the calls
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
  // Never destroyed, since a thread of the interpreter may outlive it.
  static All& all() {
    static All& made = *new All;
    return made;
  }

  StoppableCall& call_;
};

// Waits a moment without the lock of the interpreter; returns whether the call has ended. If the
// interpreter ends meanwhile, it ends threads that request its lock, and Python must not be touched
// any more, so such a thread waits here for the end of the process.
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

// Replaces each "--depth-format" in the text by depth_format.
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

// Whether an error of the library names a parameter of the caller.
bool is_parameter(std::string_view where) {
  constexpr std::array<std::string_view, 19> kNames = {
      "V",       "F",         "vertices",  "triangles", "object_starts", "self_objects",
      "threads", "clearance", "tolerance", "views",     "resolution",    "neighbours",
      "kind",    "within",    "k",         "ignore",    "limit",         "poses",
      "names"};
  return std::find(kNames.begin(), kNames.end(), where) != kNames.end();
}

// The Python names of the library's parameters.
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
    // The system could not start a thread; each needs memory for its stack.
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

void end_calls() {
  const py::gil_scoped_release released;
  Running::end_all();
}

Progress stopping_progress() {
  return [](const ProgressStep&) { stop_point(); };
}

void raise(const std::string& where, const std::string& reason, const std::string& remedy,
           bool input) {
  set(where, reason, remedy, input);
  throw py::error_already_set();
}

void register_exceptions() { py::register_exception_translator(&translate); }

// The compiled module. Users call the package farcull/ around it, which checks arguments.

namespace {

// pybind11 and numpy keep state in variables of the process, which all its interpreters would
// share. pybind11 waits forever if it first sees an interpreter other than the main one.
constexpr const char* kNotMain =
    "farcull: interpreter: is not the main one of the process; import farcull there, or in a "
    "process of its own";

bool in_main_interpreter() { return PyInterpreterState_Get() == PyInterpreterState_Main(); }

void fill(py::module_& module) {
  // Python gives another interpreter an existing module without calling PyInit again.
  module.def("require_main_interpreter", [] {
    if (!in_main_interpreter()) throw py::import_error(kNotMain);
  });
  register_exceptions();
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_calls));
  spell_parameters(option_word);  // for records; exceptions name keywords (as_parameters())
  add_collider(module);
  add_distances(module);
  add_scenes(module);
  add_runs(module);
}

py::module_::module_def definition;

}  // namespace

}  // namespace farcull::python

// As PYBIND11_MODULE, but checks the interpreter first.
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
