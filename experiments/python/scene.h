// A scene that Python holds. It never changes, so arrays and records may point into it.
#pragma once

#include <memory>
#include <utility>

#include "core/scene/scene.h"

namespace farcull::python {

struct KeptScene {
  std::shared_ptr<const Scene> scene;
  explicit KeptScene(Scene given) : scene(std::make_shared<const Scene>(std::move(given))) {}
};

}  // namespace farcull::python
