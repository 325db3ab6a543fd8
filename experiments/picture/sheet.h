// Images with words: lettering, panels side by side with titles above and legends below, and PNG.
//
// The letters are DejaVu Sans, drawn by FreeType without hinting. The font is part of the program
// (Debian's fonts-dejavu-core, as it was when the program was built), so that a picture does not
// depend on the fonts of the machine that draws it.
#pragma once

#include <string>
#include <utility>
#include <vector>

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

struct LegendEntry {
  enum class Sign { box, ring, ramp } sign = Sign::box;
  Rgba colour;  // of a ramp: its dark end
  std::string text;
  Rgba light = {};  // of a ramp: its other end
};

struct SheetPanel {
  std::string title;
  std::string headline;  // what the panel came to
  Rgba headline_colour;
  Image image;  // opaque; that of every panel of the same size
  std::vector<LegendEntry> legend;
  int left = 0, top = 0;  // where compose() has put the image in the sheet
};

/// Lays `above` over `below`, which is opaque and of the same size, with that opacity.
void lay_over(Image& below, const Image& above, double opacity);

/// A circle around (x, y), px from the left and the top, with a light line on both sides of it.
void draw_ring(Image& image, double x, double y, double radius, double line, const Rgba& colour);

/// Height of the letters that go with a panel of this width, px: legible at half of it.
double letter_height(int panel_width);

/// The sheet: title and subtitle, the panels (at least one), a line of small print. Texts that are
/// too long are cut.
Image compose(const std::string& title, const std::string& subtitle,
              std::vector<SheetPanel>& panels, const std::string& small_print);

/// Keyword (1 to 79 printable ASCII characters) and text, in UTF-8; in the order of the file.
using PngTexts = std::vector<std::pair<std::string, std::string>>;

/// The bytes of a PNG of 8 bits a channel: RGB where every pixel is opaque, else RGBA; texts as
/// tEXt, those beyond ASCII as iTXt. The same image and texts give the same bytes with the same
/// libpng. Throws Error where libpng refuses. Precondition: the image has a pixel.
std::string to_png(const Image& image, const PngTexts& texts);

}  // namespace farcull
