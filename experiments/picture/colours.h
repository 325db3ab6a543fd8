// The colours of pictures, flat ones and pages alike.
#pragma once

#include <array>

#include "core/base/image.h"

namespace farcull {

/// The colour of missed pairs, with full opacity and unshaded, and of nothing else.
constexpr Rgba kMissedColour = {220, 0, 90};
/// Of triangles that collide, and of those that a method kept although they do not.
constexpr Rgba kFoundColour = {0, 128, 116}, kIdleColour = {240, 176, 32};
constexpr double kIdlePart = 0.6;  // of kIdleColour in the colour of such a triangle's object
constexpr double kThrough = 0.28;  // how strongly collisions shine through what hides them
/// Of the objects, in turn: pale, so that nothing but what collides has a strong colour.
constexpr std::array<Rgba, 8> kObjectColours = {{{176, 190, 210},
                                                 {218, 214, 206},
                                                 {186, 203, 184},
                                                 {216, 204, 180},
                                                 {196, 190, 214},
                                                 {180, 206, 208},
                                                 {222, 190, 168},
                                                 {214, 192, 198}}};

}  // namespace farcull
