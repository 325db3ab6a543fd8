// Files of Debian that are part of the program: the font of pictures, and three.js, a library for
// WebGL in browsers (libjs-three).
#pragma once

#include <string_view>

namespace farcull {

/// DejaVu Sans, or its bold.
std::string_view font_file(bool bold);

/// All three are empty where the program was built without three.js.
struct ThreeJs {
  std::string_view library;   // three.min.js
  std::string_view controls;  // OrbitControls.js: the mouse and fingers turn and move the camera
  std::string_view licence;   // the file of Debian that says whose it is and on which terms
};
ThreeJs three_js();

}  // namespace farcull
