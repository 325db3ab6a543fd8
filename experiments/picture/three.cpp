// The files of three.js, put into the program by the assembler as the font of pictures is.
#include "experiments/picture/three.h"

#if FARCULL_WITH_THREE
asm(".pushsection .rodata\n"
    "farcull_three: .incbin \"" FARCULL_THREE
    "\"\n"
    "farcull_three_end:\n"
    "farcull_three_controls: .incbin \"" FARCULL_THREE_CONTROLS
    "\"\n"
    "farcull_three_controls_end:\n"
    "farcull_three_licence: .incbin \"" FARCULL_THREE_LICENCE
    "\"\n"
    "farcull_three_licence_end:\n"
    ".popsection\n");
extern "C" {
extern const char farcull_three[], farcull_three_end[];
extern const char farcull_three_controls[], farcull_three_controls_end[];
extern const char farcull_three_licence[], farcull_three_licence_end[];
}
#endif

namespace farcull {

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
