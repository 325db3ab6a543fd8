// How a long computation reports where it stands.
#pragma once

#include <functional>
#include <string>

namespace farcull {

/// Called before each stage with the stage's name. May be empty.
using Progress = std::function<void(const std::string&)>;

}  // namespace farcull
