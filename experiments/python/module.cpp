// The compiled module. The package farcull/ around it checks arguments, and is what people call.
#include "core/base/parameter.h"
#include "experiments/method/options.h"
#include "experiments/python/parts.h"

namespace farcull::python {
namespace {

// pybind11 and numpy keep what they know in variables of the process, which interpreters in one
// process would share. pybind11 waits for ever where another one is the first that it sees.
constexpr const char* kNotMain =
    "farcull: interpreter: is not the main one of the process; import farcull there, or in a "
    "process of its own";

bool in_main_interpreter() { return PyInterpreterState_Get() == PyInterpreterState_Main(); }

void fill(py::module_& module) {
  // A module that is made already is given to another interpreter without a call of its maker.
  module.def("require_main_interpreter", [] {
    if (!in_main_interpreter()) throw py::import_error(kNotMain);
  });
  register_exceptions();
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_calls));
  spell_parameters(option_word);  // as records say it; exceptions name keywords (call.cpp)
  add_collider(module);
  add_stream(module);
  add_distances(module);
  add_scenes(module);
  add_runs(module);
}

py::module_::module_def definition;

}  // namespace
}  // namespace farcull::python

// As PYBIND11_MODULE does it, but that asks for the interpreter first.
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
