// Lettering of pictures: DejaVu Sans, drawn by FreeType without hinting.
//
// The font is part of the program (Debian's fonts-dejavu-core, as it was when the program was
// built), so that a picture does not depend on the fonts of the machine that draws it.
#pragma once

#include <string>

#include "core/base/image.h"

namespace farcull {

struct TextStyle {
  double height = 14;  // px of a capital letter
  bool bold = false;
  Rgba colour = {30, 30, 34, 255};
};

/// px from the left end of the first letter to the place of a letter after the last one. Throws
/// Error where FreeType refuses the font.
double text_width(const std::string& text, const TextStyle& style);

/// Draws the text with the left end of its baseline at (x, baseline), in px from the left and the
/// top. What lies outside the image is cut off. UTF-8; a letter that the font lacks and a byte that
/// is no UTF-8 are drawn as '?'. Throws as text_width().
void draw_text(Image& image, double x, double baseline, const std::string& text,
               const TextStyle& style);

/// The text, or as much of it as fits into `width` px, with "…" at its end.
std::string text_that_fits(const std::string& text, const TextStyle& style, double width);

/// "DejaVu Sans 2.37, FreeType 2.12.1": what the pixels of a text depend on.
std::string lettering_version();

}  // namespace farcull
