// Formats that are not read: what they are called, and the command that converts them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace farcull {

/// How many bytes of a file foreign_contents() looks at.
constexpr std::size_t kTellingBytes = 1024;

/// The Error for a path whose extension names a format that is not read: it names the format and
/// the command that converts the file. Empty where the extension is none of a known format.
std::optional<Error> foreign_name(const std::string& path);
/// The same for a file whose first bytes show such a format, whatever its name.
std::optional<Error> foreign_contents(std::string_view bytes, const std::string& path);

/// The extension in lower case, with its dot. That of a compressed file counts with the one before
/// it: of "a.OBJ.gz" it is ".obj.gz".
std::string lower_extension(const std::string& path);
/// The name of a file without its folder and its extension, as lower_extension() has it.
std::string mesh_stem(const std::string& path);

}  // namespace farcull
