// Lettering for pictures without a font of the system: a table of dots, drawn as rounded strokes
// from dot to dot, so that it is smooth at every size.
#pragma once

#include <string>

#include "core/base/image.h"

namespace farcull {

struct TextStyle {
  double height = 14;  // px of a capital letter
  bool bold = false;
  Rgba colour = {30, 30, 34, 255};
};

/// px from the left of the first letter to the right of the last one; every letter is as wide as
/// every other.
double text_width(const std::string& text, const TextStyle& style);

/// Draws the text with the left end of its baseline at (x, baseline), in px from the left and the
/// top. What lies outside the image is cut off. ASCII from blank to ~; a byte that is none of these
/// is drawn as '?', the further bytes of a UTF-8 letter not at all.
void draw_text(Image& image, double x, double baseline, const std::string& text,
               const TextStyle& style);

/// The text, or as much of it as fits into `width` px, with ".." at its end.
std::string text_that_fits(const std::string& text, const TextStyle& style, double width);

}  // namespace farcull
