// Runs gnuplot, without a shell.
#pragma once

#include <string>

namespace farcull {

/// Runs `gnuplot SCRIPT` in the folder with `kind` set to "svg" or "pdf", without the settings of
/// the user. Throws Error where it is not installed, fails, or writes anything to its outputs.
void run_gnuplot(const std::string& folder, const std::string& script, const std::string& kind);

/// Throws Error where gnuplot is not installed.
void require_gnuplot();

/// A text between single quotes, where gnuplot takes everything as it is; control characters become
/// blanks.
std::string gnuplot_text(const std::string& text);

}  // namespace farcull
