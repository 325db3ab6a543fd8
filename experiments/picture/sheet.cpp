// Paints rectangles, rings and text into an image, and writes the image as PNG.
#include <fmt/format.h>
#include <pango/pangocairo.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "experiments/picture/panel.h"

namespace farcull {
namespace {

struct Free {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
  void operator()(PangoContext* context) const { g_object_unref(context); }
  void operator()(PangoFont* font) const { g_object_unref(font); }
  void operator()(PangoLayout* layout) const { g_object_unref(layout); }
  void operator()(PangoFontDescription* font) const { pango_font_description_free(font); }
  void operator()(char* text) const { g_free(text); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

// Returns the layout of a text. Hinting is off, so that letters have the same shapes at all sizes
// and positions.
Owned<PangoLayout> laid_out(const std::string& text, const TextStyle& style, double room) {
  constexpr double kCapital = 1493.0 / 2048;  // height of a capital letter in ems, for DejaVu
  const Owned<PangoContext> context(
      pango_font_map_create_context(pango_cairo_font_map_get_default()));
  const Owned<cairo_font_options_t> options(cairo_font_options_create());
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  pango_cairo_context_set_font_options(context.get(), options.get());
  pango_context_set_round_glyph_positions(context.get(), FALSE);
  const Owned<PangoFontDescription> font(
      pango_font_description_from_string(style.bold ? "DejaVu Sans Bold" : "DejaVu Sans"));
  pango_font_description_set_absolute_size(font.get(), style.height / kCapital * PANGO_SCALE);
  Owned<PangoLayout> out(pango_layout_new(context.get()));
  pango_layout_set_font_description(out.get(), font.get());
  pango_layout_set_single_paragraph_mode(out.get(), TRUE);
  pango_layout_set_ellipsize(out.get(), PANGO_ELLIPSIZE_END);
  pango_layout_set_width(out.get(), static_cast<int>(std::max(0.0, room) * PANGO_SCALE));
  const Owned<char> valid(g_utf8_make_valid(text.c_str(), -1));
  pango_layout_set_text(out.get(), valid.get(), -1);
  return out;
}

constexpr Rgba kSheet = {255, 255, 255}, kInk = {28, 30, 36}, kGrey = {112, 116, 124},
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
  if (entry.sign == LegendEntry::Sign::box)
    fill(sheet, left, top, left + size, top + size, entry.colour);
  else
    draw_ring(sheet, left + 0.5 * size, top + 0.5 * size, 0.42 * size, 0.14 * size, entry.colour);
}

void put(std::string& out, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(number >> shift));
}

// Returns a PNG chunk with a text, since cairo cannot write text chunks. An iTXt chunk has two
// flags, a language and a translated keyword before the text. All four are empty or 0 here.
std::string chunk_of(const std::string& key, const std::string& text) {
  const bool ascii = std::ranges::all_of(text, [](char c) { return (c & 0x80) == 0; });
  const std::string body =
      (ascii ? "tEXt" : "iTXt") + key + std::string(ascii ? 1 : 5, '\0') + text;
  std::string out;
  put(out, static_cast<std::uint32_t>(body.size() - 4));
  out += body;
  put(out, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(body.data()),
                                            static_cast<uInt>(body.size()))));
  return out;
}

Owned<cairo_surface_t> surface_of(cairo_format_t format, int width, int height) {
  Owned<cairo_surface_t> out(cairo_image_surface_create(format, width, height));
  if (const cairo_status_t status = cairo_surface_status(out.get()); status != CAIRO_STATUS_SUCCESS)
    throw Error("--size", fmt::format("cairo makes no image: {}", cairo_status_to_string(status)),
                "give another size");
  return out;
}

}  // namespace

void draw_text(Image& image, double x, double baseline, const std::string& text,
               const TextStyle& style, double room) {
  const Owned<PangoLayout> layout = laid_out(text, style, room);
  PangoLayoutLine* const line = pango_layout_get_line_readonly(layout.get(), 0);
  PangoRectangle ink;  // bounding box of the glyphs, px from the left end of the baseline
  pango_layout_line_get_extents(line, &ink, nullptr);
  pango_extents_to_pixels(&ink, nullptr);
  const double column = std::floor(x), row = std::floor(baseline);
  const Owned<cairo_surface_t> mask = surface_of(CAIRO_FORMAT_A8, ink.width + 2, ink.height + 2);
  const Owned<cairo_t> context(cairo_create(mask.get()));
  cairo_move_to(context.get(), x - column - ink.x, baseline - row - ink.y);
  pango_cairo_show_layout_line(context.get(), line);
  cairo_surface_flush(mask.get());
  const unsigned char* const covered = cairo_image_surface_get_data(mask.get());
  const int stride = cairo_image_surface_get_stride(mask.get());
  const int left = static_cast<int>(column) + ink.x, top = static_cast<int>(row) + ink.y;
  for (int py = std::max(0, -top); py < ink.height + 2 && top + py < image.height; ++py) {
    for (int px = std::max(0, -left); px < ink.width + 2 && left + px < image.width; ++px) {
      if (const int part = covered[py * stride + px]; part > 0)
        blend(image.at(left + px, top + py), style.colour, part / 255.0);
    }
  }
}

std::string lettering_version() {
  const Owned<PangoLayout> layout = laid_out("", {}, 0);
  const Owned<PangoFont> font(pango_context_load_font(
      pango_layout_get_context(layout.get()), pango_layout_get_font_description(layout.get())));
  const Owned<PangoFontDescription> used(pango_font_describe(font.get()));
  return fmt::format("{}, pango {}, cairo {}", pango_font_description_get_family(used.get()),
                     pango_version_string(), cairo_version_string());
}

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
      if (around > 0) blend(image.at(px, py), kSheet, 0.8 * around);
      if (on > 0) blend(image.at(px, py), colour, on);
    }
  }
}

Image compose(const std::string& title, const std::string& subtitle,
              std::vector<SheetPanel>& panels, const std::string& small_print) {
  const int width = panels.front().image.width, height = panels.front().image.height;
  // Height of letters, px. Text stays legible even if the sheet is shown at half size.
  const double letter = std::clamp(width / 52.0, 7.0, 64.0);
  const int line = static_cast<int>(std::lround(1.75 * letter)), margin = line;
  std::size_t entries = 0;
  for (const SheetPanel& panel : panels) entries = std::max(entries, panel.legend.size());

  const TextStyle big{1.3 * letter, true, kInk}, plain{letter, false, kInk},
      strong{letter, true, kInk}, small{0.72 * letter, false, kGrey};
  const int count = static_cast<int>(panels.size());
  const int total_width = 2 * margin + count * width + (count - 1) * margin;
  const int heading = 4 * line;  // title and subtitle with margins
  const int top = heading + 2 * line + line / 2;
  const int legend_top = top + height + line / 2;
  const int total_height = legend_top + static_cast<int>(entries) * line + 2 * line;

  Image sheet(total_width, total_height, kSheet);
  const double room = total_width - 2.0 * margin;
  draw_text(sheet, margin, margin + big.height, title, big, room);
  draw_text(sheet, margin, margin + big.height + line, subtitle, plain, room);
  for (int i = 0; i < count; ++i) {
    SheetPanel& panel = panels[static_cast<std::size_t>(i)];
    panel.left = margin + i * (width + margin);
    panel.top = top;
    TextStyle headline = strong;
    headline.colour = panel.headline_colour;
    draw_text(sheet, panel.left, heading + letter, panel.title, strong, width);
    draw_text(sheet, panel.left, heading + line + letter, panel.headline, headline, width);
    put(sheet, panel.image, panel.left, panel.top);
    int y = legend_top;
    for (const LegendEntry& entry : panel.legend) {
      const int size = static_cast<int>(std::lround(1.1 * letter));
      draw_sign(sheet, entry, panel.left, y + (line - size) / 2, size);
      const double x = panel.left + 1.9 * letter;
      draw_text(sheet, x, y + 0.5 * (line + letter), entry.text, plain, width - 1.9 * letter);
      y += line;
    }
  }
  draw_text(sheet, margin, total_height - 0.75 * margin, small_print, small, room);
  return sheet;
}

std::string to_png(const Image& image, const PngTexts& texts) {
  const Owned<cairo_surface_t> surface = surface_of(CAIRO_FORMAT_RGB24, image.width, image.height);
  unsigned char* const data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int y = 0; y < image.height; ++y) {
    auto* const row =
        reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
    for (int x = 0; x < image.width; ++x) {
      const Rgba& pixel = image.at(x, y);
      row[x] = std::uint32_t{pixel.r} << 16 | std::uint32_t{pixel.g} << 8 | pixel.b;
    }
  }
  cairo_surface_mark_dirty(surface.get());
  std::string out;
  const auto append = [](void* to, const unsigned char* bytes, unsigned length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), length);
    return CAIRO_STATUS_SUCCESS;
  };
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface.get(), append, &out);
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error("PNG", cairo_status_to_string(status), "give another size, or report the command");
  std::string chunks;
  for (const auto& [key, text] : texts) chunks += chunk_of(key, text);
  constexpr std::size_t kHeader = 8 + 25;  // bytes of the PNG signature and of the chunk IHDR
  return out.insert(kHeader, chunks);
}

}  // namespace farcull
