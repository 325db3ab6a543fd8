// Paints rectangles, rings and lettering into one image.
#include "experiments/picture/sheet.h"

#include <algorithm>
#include <cmath>

#include "experiments/picture/lettering.h"

namespace farcull {
namespace {

constexpr Rgba kPaper = {255, 255, 255}, kInk = {28, 30, 36}, kGrey = {112, 116, 124},
               kFrame = {205, 208, 213};

void fill(Image& image, int x0, int y0, int x1, int y1, const Rgba& colour) {
  for (int y = std::max(0, y0); y < std::min(image.height, y1); ++y) {
    for (int x = std::max(0, x0); x < std::min(image.width, x1); ++x) image.at(x, y) = colour;
  }
}

void put(Image& sheet, const Image& picture, int left, int top) {
  fill(sheet, left - 1, top - 1, left + picture.width + 1, top + picture.height + 1, kFrame);
  for (int y = 0; y < picture.height; ++y)
    std::copy_n(&picture.at(0, y), picture.width, &sheet.at(left, top + y));
}

void draw_sign(Image& sheet, const LegendEntry& entry, int left, int top, int size) {
  switch (entry.sign) {
    case LegendEntry::Sign::box:
      fill(sheet, left, top, left + size, top + size, entry.colour);
      break;
    case LegendEntry::Sign::ring:
      draw_ring(sheet, left + 0.5 * size, top + 0.5 * size, 0.42 * size, 0.14 * size, entry.colour);
      break;
    case LegendEntry::Sign::ramp:
      for (int x = 0; x < size; ++x) {
        Rgba colour = entry.light;
        blend(colour, entry.colour, (x + 0.5) / size);
        fill(sheet, left + x, top, left + x + 1, top + size, colour);
      }
      break;
  }
}

}  // namespace

void lay_over(Image& below, const Image& above, double opacity) {
  for (std::size_t i = 0; i < below.pixels.size(); ++i) {
    const Rgba& pixel = above.pixels[i];
    if (pixel.a != 0) blend(below.pixels[i], pixel, opacity * pixel.a / 255);
  }
}

void draw_ring(Image& image, double x, double y, double radius, double line, const Rgba& colour) {
  const double halo = 0.5 * line + std::max(1.0, 0.5 * line), reach = radius + halo + 1;
  const int x0 = std::max(0, static_cast<int>(x - reach));
  const int x1 = std::min(image.width - 1, static_cast<int>(x + reach));
  const int y0 = std::max(0, static_cast<int>(y - reach));
  const int y1 = std::min(image.height - 1, static_cast<int>(y + reach));
  for (int py = y0; py <= y1; ++py) {
    for (int px = x0; px <= x1; ++px) {
      const double off = std::abs(std::hypot(px + 0.5 - x, py + 0.5 - y) - radius);
      const double around = std::clamp(halo - off + 0.5, 0.0, 1.0);
      const double on = std::clamp(0.5 * line - off + 0.5, 0.0, 1.0);
      if (around > 0) blend(image.at(px, py), kPaper, 0.8 * around);
      if (on > 0) blend(image.at(px, py), colour, on);
    }
  }
}

double letter_height(int panel_width) { return std::clamp(panel_width / 52.0, 7.0, 64.0); }

Image compose(const std::string& title, const std::string& subtitle,
              std::vector<SheetPanel>& panels, const std::string& small_print) {
  const int width = panels.front().image.width, height = panels.front().image.height;
  const double letter = letter_height(width);
  const int line = static_cast<int>(std::lround(1.75 * letter)), margin = line;
  std::size_t entries = 0;
  for (const SheetPanel& panel : panels) entries = std::max(entries, panel.legend.size());

  const TextStyle big{1.3 * letter, true, kInk}, plain{letter, false, kInk},
      strong{letter, true, kInk}, small{0.72 * letter, false, kGrey};
  const int count = static_cast<int>(panels.size());
  const int total_width = 2 * margin + count * width + (count - 1) * margin;
  const int heading = 4 * line;  // title, subtitle and the room around them
  const int top = heading + 2 * line + line / 2;
  const int legend_top = top + height + line / 2;
  const int total_height = legend_top + static_cast<int>(entries) * line + 2 * line;

  Image sheet(total_width, total_height, kPaper);
  const double room = total_width - 2.0 * margin;
  draw_text(sheet, margin, margin + big.height, text_that_fits(title, big, room), big);
  draw_text(sheet, margin, margin + big.height + line, text_that_fits(subtitle, plain, room),
            plain);
  for (int i = 0; i < count; ++i) {
    SheetPanel& panel = panels[static_cast<std::size_t>(i)];
    panel.left = margin + i * (width + margin);
    panel.top = top;
    TextStyle headline = strong;
    headline.colour = panel.headline_colour;
    draw_text(sheet, panel.left, heading + letter, text_that_fits(panel.title, strong, width),
              strong);
    draw_text(sheet, panel.left, heading + line + letter,
              text_that_fits(panel.headline, headline, width), headline);
    put(sheet, panel.image, panel.left, panel.top);
    int y = legend_top;
    for (const LegendEntry& entry : panel.legend) {
      const int size = static_cast<int>(std::lround(1.1 * letter));
      draw_sign(sheet, entry, panel.left, y + (line - size) / 2, size);
      const double x = panel.left + 1.9 * letter;
      draw_text(sheet, x, y + 0.5 * (line + letter),
                text_that_fits(entry.text, plain, width - 1.9 * letter), plain);
      y += line;
    }
  }
  draw_text(sheet, margin, total_height - 0.75 * margin, text_that_fits(small_print, small, room),
            small);
  return sheet;
}

}  // namespace farcull
