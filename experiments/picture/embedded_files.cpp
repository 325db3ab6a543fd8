// The assembler puts the files into the program: as arrays of the compiler they would take minutes.
#include "experiments/picture/embedded_files.h"

// FARCULL_EMBED(NAME, PATH): the bytes of the file from farcull_NAME to farcull_NAME_end.
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

}  // namespace farcull
