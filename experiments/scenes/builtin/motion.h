// Motions that move the objects of a scene as they are.
#pragma once

#include "core/scene/scene.h"
#include "experiments/scenes/builtin/built_scene.h"

namespace farcull {

/// `rest` is the scene without frames, whose objects share no vertex. The second object comes from
/// beside the first, goes through it and leaves on the other side.
Motion pass_through(const Scene& rest);
/// All objects breathe, out of step, while waves run along them.
Motion pulse(const Scene& rest);
/// Each object goes its own way, by up to its diagonal, and comes back.
Motion drift(const Scene& rest);

}  // namespace farcull
