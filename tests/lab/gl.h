// The laboratory with a GL context.
#pragma once

#include "core/gl/base/driver_fault.h"
#include "core/gl/canvas/canvas.h"
#include "tests/lab/canvas.h"

namespace farcull::lab {

/// One context for all tests of a process, on the default device.
inline const GlContext& context() {
  static const GlContext shared;
  return shared;
}

inline MakeCanvas canvases(const GlCanvasOptions& options = {}) {
  return [options](const Fattener& fattener) {
    return std::make_unique<GlCanvas>(context(), fattener.mode, fattener.solid, options);
  };
}

// A driver that reverses the depth test: what shall keep the nearest keeps the farthest.

/// While it lives, LESS and LEQUAL are GREATER and GEQUAL, and depth buffers of the probes are
/// cleared to the other end. GL does not say so where it is asked.
class ReversedDepth {
  using Func = GlEntryPoint<&epoxy_glDepthFunc>;
  using Get = GlEntryPoint<&epoxy_glGetIntegerv>;
  using ClearBuffer = GlEntryPoint<&epoxy_glClearBufferfv>;
  static inline GLenum asked_ = 0;  // the function that was set, as the caller meant it

  static void func(GLenum function) {
    asked_ = function;
    Func::original(function == GL_LESS ? GL_GREATER : function == GL_LEQUAL ? GL_GEQUAL : function);
  }
  static void get(GLenum name, GLint* value) {
    Get::original(name, value);
    if (name == GL_DEPTH_FUNC && asked_ != 0) *value = static_cast<GLint>(asked_);
  }
  static void clear_buffer(GLenum buffer, GLint drawbuffer, const GLfloat* value) {
    const GLfloat other = 1 - *value;
    ClearBuffer::original(buffer, drawbuffer, buffer == GL_DEPTH ? &other : value);
  }

  Func func_{func};
  Get get_{get};
  ClearBuffer clear_buffer_{clear_buffer};
};

/// The same for a depth buffer that is cleared by glClearDepth and glClear.
class ReversedClear {
  using ClearDepth = GlEntryPoint<&epoxy_glClearDepth>;
  static void clear_depth(GLdouble depth) { ClearDepth::original(1 - depth); }
  ClearDepth clear_depth_{clear_depth};
};

// A driver that compiles other shaders than it was given.

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
