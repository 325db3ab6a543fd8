// Paints rectangles, rings and lettering into one image. Letters are outlines of the font, scaled
// to the height of a capital, at subpixel positions: each is rendered as coverage and blended.
#include "experiments/picture/panel.h"

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include FT_SFNT_NAMES_H
#include FT_TRUETYPE_IDS_H
#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/base/error.h"

// FARCULL_EMBED(NAME, PATH): the bytes of the file from farcull_NAME to farcull_NAME_end. The
// assembler includes them: as arrays they would take the compiler minutes.
#define FARCULL_EMBED(name, path)          \
  asm(".pushsection .rodata\n"             \
      "farcull_" #name ": .incbin \"" path \
      "\"\n"                               \
      "farcull_" #name                     \
      "_end:\n"                            \
      ".popsection\n");                    \
  extern "C" const char farcull_##name[], farcull_##name##_end[];

FARCULL_EMBED(font_regular, FARCULL_FONT_REGULAR)
FARCULL_EMBED(font_bold, FARCULL_FONT_BOLD)
#if FARCULL_WITH_THREE
FARCULL_EMBED(three, FARCULL_THREE)
FARCULL_EMBED(three_controls, FARCULL_THREE_CONTROLS)
FARCULL_EMBED(three_licence, FARCULL_THREE_LICENCE)
#endif

namespace farcull {

std::string_view font_file(bool bold) {
  return bold ? std::string_view(farcull_font_bold, farcull_font_bold_end)
              : std::string_view(farcull_font_regular, farcull_font_regular_end);
}

ThreeJs three_js() {
#if FARCULL_WITH_THREE
  return {.library = {farcull_three, farcull_three_end},
          .controls = {farcull_three_controls, farcull_three_controls_end},
          .licence = {farcull_three_licence, farcull_three_licence_end}};
#else
  return {};
#endif
}

namespace {

constexpr double kUnits = 64;  // units of FreeType's coordinates per px
constexpr const char* kEllipsis = "\xe2\x80\xa6";

void require(FT_Error error, const char* what) {
  if (error == 0) return;
  throw Error("the font of pictures", fmt::format("FreeType {}: error {}", what, error),
              "build farcull again with libfreetype-dev and fonts-dejavu-core of this system");
}

// The characters of a UTF-8 text; '?' for each byte that is not UTF-8.
std::vector<std::uint32_t> characters_of(const std::string& text) {
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t more = byte < 0x80       ? 0
                             : byte >> 5 == 6  ? 1
                             : byte >> 4 == 14 ? 2
                             : byte >> 3 == 30 ? 3
                                               : 4;
    std::uint32_t code = more == 0 ? byte : byte & (0x3fu >> more);
    bool good = more < 4 && i + more < text.size();
    for (std::size_t k = 1; good && k <= more; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      good = next >> 6 == 2;
      code = code << 6 | (next & 0x3fu);
    }
    out.push_back(good ? code : '?');
    i += good ? more + 1 : 1;
  }
  return out;
}

// The font at one size.
class Font {
 public:
  Font(bool bold, double capital) {
    FT_Library library = nullptr;
    require(FT_Init_FreeType(&library), "does not start");
    library_.reset(library);
    const std::string_view file = font_file(bold);
    FT_Face face = nullptr;
    require(FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(file.data()),
                               static_cast<FT_Long>(file.size()), 0, &face),
            "cannot read the font");
    face_.reset(face);
    // FreeType's size is the height of the em square; the letter H gives the part of a capital.
    require(FT_Load_Char(face, 'H', FT_LOAD_NO_SCALE), "has no letter H");
    const double part = static_cast<double>(face->glyph->metrics.height) / face->units_per_EM;
    require(FT_Set_Char_Size(face, 0, std::lround(capital / part * kUnits), 72, 72),
            "cannot scale the font");
  }

  // Calls at(glyph slot, px from the left of the text) for each letter, with its outline loaded,
  // and returns the width of the text.
  template <class At>
  double walk(const std::string& text, const At& at) const {
    double left = 0;
    FT_UInt before = 0;
    for (const std::uint32_t code : characters_of(text)) {
      FT_UInt glyph = FT_Get_Char_Index(face_.get(), code);
      if (glyph == 0) glyph = FT_Get_Char_Index(face_.get(), '?');
      FT_Vector kern = {};
      if (before != 0 &&
          FT_Get_Kerning(face_.get(), before, glyph, FT_KERNING_UNFITTED, &kern) == 0)
        left += static_cast<double>(kern.x) / kUnits;
      require(FT_Load_Glyph(face_.get(), glyph, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP),
              "cannot load a letter");
      // Reads the advance before rendering, which rounds the glyph's other one to whole pixels.
      const double advance = static_cast<double>(face_->glyph->linearHoriAdvance) / 65536;
      at(face_->glyph, left);
      left += advance;
      before = glyph;
    }
    return left;
  }

  std::string version() const {
    std::string number;
    FT_SfntName name = {};
    for (FT_UInt i = 0; i < FT_Get_Sfnt_Name_Count(face_.get()); ++i) {
      if (FT_Get_Sfnt_Name(face_.get(), i, &name) == 0 &&
          name.name_id == TT_NAME_ID_VERSION_STRING && name.platform_id == TT_PLATFORM_MACINTOSH)
        number.assign(reinterpret_cast<const char*>(name.string), name.string_len);
    }
    FT_Int major = 0, minor = 0, patch = 0;
    FT_Library_Version(library_.get(), &major, &minor, &patch);
    return fmt::format("{} {}, FreeType {}.{}.{}", face_->family_name,
                       number.substr(number.rfind(' ') + 1), major, minor, patch);
  }

 private:
  struct Done {
    void operator()(FT_Library library) const { FT_Done_FreeType(library); }
    void operator()(FT_Face face) const { FT_Done_Face(face); }
  };
  std::unique_ptr<FT_LibraryRec_, Done> library_;
  std::unique_ptr<FT_FaceRec_, Done> face_;
};

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

// ---- PNG, by libpng ----

// libpng reports an error by a call that must not return. Jumping out of its frames is safe, but
// jumping over ours would skip destructors, so C++ objects are outside the function with setjmp.
struct Failure {
  char text[200] = "";
};

extern "C" void png_failed(png_structp png, png_const_charp message) {
  auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
  std::strncpy(failure->text, message, sizeof failure->text - 1);
  png_longjmp(png, 1);
}
extern "C" void png_warned(png_structp, png_const_charp) {}

extern "C" void append(png_structp png, png_bytep data, std::size_t length) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char*>(data), length);
}
extern "C" void flush(png_structp) {}

bool ascii(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

struct Written {
  std::string bytes;
  std::vector<png_text> texts;
  std::vector<png_bytep> rows;
  std::vector<png_byte> channels;
  Failure failure;
};

// Returns false if libpng has failed.
bool write(const Image& image, bool opaque, Written& out) {
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &out.failure, png_failed, png_warned);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, &out.bytes, append, flush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8,
               opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_text(png, info, out.texts.data(), static_cast<int>(out.texts.size()));
  png_write_info(png, info);
  png_write_image(png, out.rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

double text_width(const std::string& text, const TextStyle& style) {
  return Font(style.bold, style.height).walk(text, [](FT_GlyphSlot, double) {});
}

void draw_text(Image& image, double x, double baseline, const std::string& text,
               const TextStyle& style) {
  const Font font(style.bold, style.height);
  font.walk(text, [&](FT_GlyphSlot slot, double left) {
    const double column = std::floor(x + left), row = std::floor(baseline);
    FT_Outline_Translate(&slot->outline, std::lround((x + left - column) * kUnits),
                         -std::lround((baseline - row) * kUnits));
    require(FT_Render_Glyph(slot, FT_RENDER_MODE_NORMAL), "cannot draw a letter");
    const FT_Bitmap& bitmap = slot->bitmap;
    for (unsigned y = 0; y < bitmap.rows; ++y) {
      const int to_y = static_cast<int>(row) - slot->bitmap_top + static_cast<int>(y);
      if (to_y < 0 || to_y >= image.height) continue;
      for (unsigned i = 0; i < bitmap.width; ++i) {
        const int to_x = static_cast<int>(column) + slot->bitmap_left + static_cast<int>(i);
        if (to_x < 0 || to_x >= image.width) continue;
        const int covered = bitmap.buffer[static_cast<std::size_t>(y) * bitmap.pitch + i];
        if (covered > 0) blend(image.at(to_x, to_y), style.colour, covered / 255.0);
      }
    }
  });
}

std::string text_that_fits(const std::string& text, const TextStyle& style, double width) {
  if (text_width(text, style) <= width) return text;
  std::string cut = text;
  while (!cut.empty() && text_width(cut + kEllipsis, style) > width) {
    // Removes all bytes of a UTF-8 letter together.
    while (cut.size() > 1 && (static_cast<unsigned char>(cut.back()) & 0xc0) == 0x80)
      cut.pop_back();
    cut.pop_back();
  }
  return cut + kEllipsis;
}

std::string lettering_version() { return Font(false, 14).version(); }

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
  const int heading = 4 * line;  // title, subtitle and the space around them
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

std::string to_png(const Image& image, const PngTexts& texts) {
  if (image.width < 1 || image.height < 1) throw std::logic_error("to_png: an image of no pixels");
  const bool opaque = std::all_of(image.pixels.begin(), image.pixels.end(),
                                  [](const Rgba& pixel) { return pixel.a == 255; });
  Written out;
  for (const auto& [key, text] : texts) {
    png_text entry = {};
    entry.compression = ascii(text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    entry.key = const_cast<char*>(key.c_str());
    entry.text = const_cast<char*>(text.c_str());
    out.texts.push_back(entry);
  }
  const std::size_t size = opaque ? 3 : 4;
  out.channels.reserve(image.pixels.size() * size);
  for (const Rgba& pixel : image.pixels) {
    out.channels.insert(out.channels.end(), {pixel.r, pixel.g, pixel.b});
    if (!opaque) out.channels.push_back(pixel.a);
  }
  for (int y = 0; y < image.height; ++y)
    out.rows.push_back(out.channels.data() + static_cast<std::size_t>(y) * image.width * size);
  if (!write(image, opaque, out))
    throw Error("PNG", out.failure.text[0] ? out.failure.text : "libpng has no memory",
                "give another size, or report the command line");
  return std::move(out.bytes);
}

}  // namespace farcull
