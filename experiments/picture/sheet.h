// A sheet of panels side by side, each a picture with its title above and its legend below.
#pragma once

#include <string>
#include <vector>

#include "core/base/image.h"

namespace farcull {

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

}  // namespace farcull
