// Pictures as PNG files, and back.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/image.h"

namespace farcull {

/// Keyword (1 to 79 printable ASCII characters) and text, in UTF-8; in the order of the file.
using PngTexts = std::vector<std::pair<std::string, std::string>>;

/// The bytes of a PNG of 8 bits a channel: RGB where every pixel is opaque, else RGBA; texts as
/// tEXt, those beyond ASCII as iTXt. The same image and texts give the same bytes with the same
/// libpng. Throws Error where libpng refuses. Precondition: the image has a pixel.
std::string to_png(const Image& image, const PngTexts& texts);

struct PngContent {
  Image image;
  PngTexts texts;
};
/// Reads what to_png() has written. Throws Error naming `where` for anything else.
PngContent from_png(const std::string& bytes, const std::string& where);

}  // namespace farcull
