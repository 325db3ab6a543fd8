// Pictures as PNG files.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/image.h"

namespace farcull {

/// Keyword (1 to 79 printable ASCII characters) and text, in UTF-8; in the order of the file.
using PngTexts = std::vector<std::pair<std::string, std::string>>;

/// The bytes of a PNG of 8 bits a channel: RGB where every pixel is opaque, else RGBA; texts as
/// tEXt, those beyond ASCII as iTXt. The same image and texts give the same bytes with the same
/// libpng. Throws Error where libpng refuses. Precondition: the image has a pixel.
std::string to_png(const Image& image, const PngTexts& texts);

}  // namespace farcull
