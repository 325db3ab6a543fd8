// The files of three.js as parts of the program.
#include "experiments/picture/panel.h"

#if FARCULL_WITH_THREE

// Puts the bytes of a file between farcull_NAME and farcull_NAME_end. The assembler includes them,
// since the compiler would take minutes for arrays.
#define FARCULL_EMBED(name, path)          \
  asm(".pushsection .rodata\n"             \
      "farcull_" #name ": .incbin \"" path \
      "\"\n"                               \
      "farcull_" #name                     \
      "_end:\n"                            \
      ".popsection\n");                    \
  extern "C" const char farcull_##name[], farcull_##name##_end[];

FARCULL_EMBED(three, FARCULL_THREE)
FARCULL_EMBED(three_controls, FARCULL_THREE_CONTROLS)
FARCULL_EMBED(three_licence, FARCULL_THREE_LICENCE)

farcull::ThreeJs farcull::three_js() {
  return {.library = {farcull_three, farcull_three_end},
          .controls = {farcull_three_controls, farcull_three_controls_end},
          .licence = {farcull_three_licence, farcull_three_licence_end}};
}

#else

farcull::ThreeJs farcull::three_js() { return {}; }

#endif
