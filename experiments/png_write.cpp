#include "experiments/png_write.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <stdexcept>

#include "core/error.h"

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

struct Source {
  const std::string& bytes;
  std::size_t at = 0;
};

extern "C" void take(png_structp png, png_bytep data, std::size_t length) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (length > source->bytes.size() - source->at) png_error(png, "the file ends too early");
  std::memcpy(data, source->bytes.data() + source->at, length);
  source->at += length;
}

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

struct Read {
  std::vector<png_bytep> rows;
  Failure failure;
};

bool read(Source& source, PngContent& out, Read& in) {
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &in.failure, png_failed, png_warned);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_read_fn(png, &source, take);
  png_read_info(png, info);
  const int type = png_get_color_type(png, info);
  if (png_get_bit_depth(png, info) != 8 ||
      (type != PNG_COLOR_TYPE_RGB && type != PNG_COLOR_TYPE_RGB_ALPHA)) {
    png_error(png, "it has no 8 bits for each of red, green and blue");
  }
  png_set_filler(png, 255, PNG_FILLER_AFTER);
  png_read_update_info(png, info);
  out.image = Image(static_cast<int>(png_get_image_width(png, info)),
                    static_cast<int>(png_get_image_height(png, info)), {});
  for (int y = 0; y < out.image.height; ++y)
    in.rows.push_back(reinterpret_cast<png_bytep>(&out.image.at(0, y)));
  png_read_image(png, in.rows.data());
  png_read_end(png, info);
  png_textp texts = nullptr;
  const int count = png_get_text(png, info, &texts, nullptr);
  for (int i = 0; i < count; ++i) out.texts.emplace_back(texts[i].key, texts[i].text);
  png_destroy_read_struct(&png, &info, nullptr);
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

PngContent from_png(const std::string& bytes, const std::string& where) {
  Source source{bytes};
  PngContent out;
  Read in;
  if (!read(source, out, in)) {
    throw Error(where, std::string("is no PNG of farcull: ") + in.failure.text,
                "give a file that farcull picture has written");
  }
  return out;
}

}  // namespace farcull
