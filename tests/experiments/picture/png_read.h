// Reads back the PNG files that farcull writes: libpng gives the pixels, a walk over the chunks the
// texts.
#pragma once

#include <png.h>

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

/// Fails the test and gives no image where libpng does not read the bytes.
inline PngContent png_content(const std::string& bytes) {
  PngContent out;
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()) == 0) {
    ADD_FAILURE() << header.message;
    return out;
  }
  header.format = PNG_FORMAT_RGBA;
  out.image = Image(static_cast<int>(header.width), static_cast<int>(header.height), {});
  if (png_image_finish_read(&header, nullptr, out.image.pixels.data(), 0, nullptr) == 0)
    ADD_FAILURE() << header.message;
  out.texts = png_texts(bytes);
  return out;
}

}  // namespace farcull
