// Reads back the PNG files that farcull writes: cairo gives the pixels, a walk over the chunks the
// texts.
#pragma once

#include <cairo/cairo.h>

#include "experiments/picture/panel.h"
#include "tests/lab/test.h"

namespace farcull {

struct PngContent {
  Image image;
  PngTexts texts;
};

inline PngTexts png_texts(const std::string& bytes) {
  PngTexts out;
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes.at(at)); };
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t length =
        byte(at) << 24 | byte(at + 1) << 16 | byte(at + 2) << 8 | byte(at + 3);
    const std::string kind = bytes.substr(at + 4, 4), data = bytes.substr(at + 8, length);
    const std::string key = data.c_str();
    // iTXt has two flags, a language and a translated keyword before the text; here all are empty.
    if (kind == "tEXt") out.emplace_back(key, data.substr(key.size() + 1));
    if (kind == "iTXt") out.emplace_back(key, data.substr(key.size() + 5));
    at += length + 12;
  }
  return out;
}

/// Fails the test and gives no image where cairo does not read the bytes.
inline PngContent png_content(const std::string& bytes) {
  std::string_view left = bytes;
  const auto read = [](void* from, unsigned char* to, unsigned length) {
    auto& rest = *static_cast<std::string_view*>(from);
    if (rest.size() < length) return CAIRO_STATUS_READ_ERROR;
    std::copy_n(rest.data(), length, to);
    rest.remove_prefix(length);
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_surface_t* const surface = cairo_image_surface_create_from_png_stream(read, &left);
  PngContent out;
  EXPECT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  EXPECT_EQ(cairo_image_surface_get_format(surface), CAIRO_FORMAT_RGB24);
  out.image =
      Image(cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface), {});
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; y < out.image.height; ++y) {
    const unsigned char* const row = cairo_image_surface_get_data(surface) + y * stride;
    for (int x = 0; x < out.image.width; ++x)  // blue, green, red, nothing
      out.image.at(x, y) = {row[4 * x + 2], row[4 * x + 1], row[4 * x], 255};
  }
  cairo_surface_destroy(surface);
  out.texts = png_texts(bytes);
  return out;
}

}  // namespace farcull
