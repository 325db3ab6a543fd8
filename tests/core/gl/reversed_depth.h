// A driver that reverses the depth test: what shall keep the nearest keeps the farthest.
#pragma once

#include "core/gl/base/driver_fault.h"

namespace farcull::lab {

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

}  // namespace farcull::lab
