// Writes PNG with libpng, the texts in chunks before the pixels.
#include "experiments/picture/png_write.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <stdexcept>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr const char* kRemedy = "give another size, or report the command line";

// libpng reports by a call that must not return; its frames hold nothing that has to be destroyed,
// but jumping over ours would, so the C++ objects of a call stand outside the function with setjmp.
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

// False: libpng has failed.
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
    throw Error("PNG", out.failure.text[0] ? out.failure.text : "libpng has no memory", kRemedy);
  return std::move(out.bytes);
}

}  // namespace farcull
