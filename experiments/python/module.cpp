// The compiled module. The package farcull/ around it checks arguments, and is what people call.
#include "experiments/python/parts.h"

namespace farcull::python {
namespace {

// pybind11 and numpy keep what they know in variables of the process, which interpreters in one
// process would share.
void require_main_interpreter() {
  if (PyInterpreterState_Get() == PyInterpreterState_Main()) return;
  throw py::import_error(
      "farcull: interpreter: is not the main one of the process; import farcull there, or in a "
      "process of its own");
}

}  // namespace
}  // namespace farcull::python

PYBIND11_MODULE(_farcull, module) {
  namespace python = farcull::python;
  python::require_main_interpreter();
  // A module that is made already is given to another interpreter without a call of this function.
  module.def("require_main_interpreter", &python::require_main_interpreter);
  python::register_exceptions();
  python::py::module_::import("atexit").attr("register")(
      python::py::cpp_function(&python::end_calls));
  python::add_collider(module);
  python::add_distances(module);
  python::add_scenes(module);
  python::add_runs(module);
}
