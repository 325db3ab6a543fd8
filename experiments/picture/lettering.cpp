// Outlines of the font, scaled to the height of a capital, at places between pixels: each is
// rendered as coverage and blended.
#include "experiments/picture/lettering.h"

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include FT_SFNT_NAMES_H
#include FT_TRUETYPE_IDS_H

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/error.h"

// The files of the font, by the assembler: as an array of the compiler they would take minutes.
asm(".pushsection .rodata\n"
    "farcull_font_regular: .incbin \"" FARCULL_FONT_REGULAR
    "\"\n"
    "farcull_font_regular_end:\n"
    "farcull_font_bold: .incbin \"" FARCULL_FONT_BOLD
    "\"\n"
    "farcull_font_bold_end:\n"
    ".popsection\n");
extern "C" {
extern const FT_Byte farcull_font_regular[], farcull_font_regular_end[];
extern const FT_Byte farcull_font_bold[], farcull_font_bold_end[];
}

namespace farcull {
namespace {

constexpr double kUnits = 64;  // of FreeType's coordinates in a px
constexpr const char* kEllipsis = "\xe2\x80\xa6";

void require(FT_Error error, const char* what) {
  if (error == 0) return;
  throw Error("the font of pictures", fmt::format("FreeType {}: error {}", what, error),
              "build farcull again with libfreetype-dev and fonts-dejavu-core of this system");
}

// The characters of a UTF-8 text; '?' for each byte that is none.
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

// The font in a size.
class Font {
 public:
  Font(bool bold, double capital) {
    FT_Library library = nullptr;
    require(FT_Init_FreeType(&library), "does not start");
    library_.reset(library);
    const FT_Byte* const begin = bold ? farcull_font_bold : farcull_font_regular;
    const FT_Byte* const end = bold ? farcull_font_bold_end : farcull_font_regular_end;
    FT_Face face = nullptr;
    require(FT_New_Memory_Face(library, begin, end - begin, 0, &face), "cannot read the font");
    face_.reset(face);
    // The size is that of the em square; a capital is the part of it that H takes.
    require(FT_Load_Char(face, 'H', FT_LOAD_NO_SCALE), "has no letter H");
    const double part = static_cast<double>(face->glyph->metrics.height) / face->units_per_EM;
    require(FT_Set_Char_Size(face, 0, std::lround(capital / part * kUnits), 72, 72),
            "cannot scale the font");
  }

  // Calls at(glyph slot, px from the left of the text) for each letter, its outline loaded, and
  // returns the width of all.
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
      // Before rendering, which leaves whole pixels in the other advance.
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
    // A letter of UTF-8 goes as a whole.
    while (cut.size() > 1 && (static_cast<unsigned char>(cut.back()) & 0xc0) == 0x80)
      cut.pop_back();
    cut.pop_back();
  }
  return cut + kEllipsis;
}

std::string lettering_version() { return Font(false, 14).version(); }

}  // namespace farcull
