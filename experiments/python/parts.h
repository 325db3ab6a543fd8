// The parts of the compiled module. Each adds its classes and functions.
#pragma once

#include "experiments/python/call.h"

namespace farcull::python {

void add_collider(py::module_& module);
void add_distances(py::module_& module);
void add_scenes(py::module_& module);
void add_runs(py::module_& module);
void add_stream(py::module_& module);

}  // namespace farcull::python
