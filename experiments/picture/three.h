// three.js, a library for WebGL in browsers (Debian: libjs-three), as part of the program.
#pragma once

#include <string_view>

namespace farcull {

/// All three are empty where the program was built without it.
struct ThreeJs {
  std::string_view library;   // three.min.js
  std::string_view controls;  // OrbitControls.js: the mouse and fingers turn and move the camera
  std::string_view licence;   // the file of Debian that says whose it is and on which terms
};
ThreeJs three_js();

}  // namespace farcull
