// A driver that compiles other shaders than it was given.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "core/gl/base/driver_fault.h"

namespace farcull::lab {

struct ShaderChange {
  std::string from, to;
};

/// As long as it lives, each text `from` is replaced by `to` in all shaders that are compiled. One
/// at a time.
class OtherShaderText {
  using Source = GlEntryPoint<&epoxy_glShaderSource>;

 public:
  OtherShaderText(std::initializer_list<ShaderChange> wanted) {
    changes = wanted;
    done = 0;
  }
  /// How many texts were replaced.
  static int replaced() { return done; }

 private:
  static void source(GLuint shader, GLsizei, const GLchar* const* texts, const GLint* lengths) {
    std::string text = texts[0];
    for (const auto& [from, to] : changes) {
      for (std::size_t at = text.find(from); at != std::string::npos;
           at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
        ++done;
      }
    }
    const GLchar* one = text.c_str();
    Source::original(shader, 1, &one, lengths);
  }

  static inline std::vector<ShaderChange> changes;
  static inline int done = 0;
  Source source_{source};
};

}  // namespace farcull::lab
