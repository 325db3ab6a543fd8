// The parts of the compiled module. Each adds its classes and functions.
#pragma once

#include <memory>
#include <utility>

#include "core/scene/scene.h"
#include "experiments/library/farcull.h"
#include "experiments/python/call.h"

namespace farcull::python {

/// A scene that Python holds. It never changes, so arrays and records may point into it.
struct KeptScene {
  std::shared_ptr<const Scene> scene;
  explicit KeptScene(Scene given) : scene(std::make_shared<const Scene>(std::move(given))) {}
};

/// What is asked of a collider or a stream, as _collide.py puts it together.
ColliderOptions options_of(const py::dict& question);

void add_collider(py::module_& module);
void add_distances(py::module_& module);
void add_scenes(py::module_& module);
void add_runs(py::module_& module);
void add_stream(py::module_& module);

}  // namespace farcull::python
