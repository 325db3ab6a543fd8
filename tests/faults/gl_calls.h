// Faults of a GL driver, put in place of libepoxy's entry points: one call of a run is dropped, or
// one allocation fails. Every function that changes state or data and that farcull calls is listed;
// a test holds the list against the sources.
#pragma once

#include <epoxy/gl.h>
#include "core/gl/base/driver_fault.h"
#include "tests/lab/test.h"

namespace farcull::lab {

enum class GlFault {
  none,
  drop,           // the call does nothing and returns 0
  out_of_memory,  // an allocation does nothing, and glGetError says GL_OUT_OF_MEMORY
};

/// Which calls there are, and what becomes of them. One process runs one such test at a time.
struct GlCalls {
  static inline GlFault fault = GlFault::none;
  static inline long at = 0;                // which call (drop) or which allocation (out_of_memory)
  static inline long calls = 0;             // so far
  static inline long allocations = 0;       // so far
  static inline std::string hit;            // the function that the fault has met; empty: none yet
  static inline bool memory_error = false;  // still to be said by glGetError

  static void start(GlFault f, long k) {
    fault = f;
    at = k;
    calls = allocations = 0;
    hit.clear();
    memory_error = false;
  }
  static void stop() { fault = GlFault::none; }

  /// True where this call of `name` does nothing.
  static bool lost(const char* name, bool allocates) {
    const long call = calls++, allocation = allocates ? allocations++ : -1;
    const bool now = (fault == GlFault::drop && call == at) ||
                     (fault == GlFault::out_of_memory && allocation == at);
    if (now) {
      hit = name;
      if (fault == GlFault::out_of_memory) memory_error = true;
    }
    return now;
  }
};

template <auto* Pointer, class Function = std::remove_pointer_t<decltype(Pointer)>>
struct GlHook;

template <auto* Pointer, class Result, class... Arguments>
struct GlHook<Pointer, Result (*)(Arguments...)> {
  using Entry = GlEntryPoint<Pointer>;
  static inline std::optional<Entry> entry;
  static inline const char* name = nullptr;
  static inline bool allocates = false;

  static Result call(Arguments... arguments) {
    if (GlCalls::lost(name, allocates)) return Result();
    return Entry::original(arguments...);
  }
  static void install(const char* function, bool memory) {
    name = function;
    allocates = memory;
    entry.emplace(&call);
  }
  static void remove() { entry.reset(); }
};

// Functions that change GL's state or data, or bring data back.
// clang-format off
#define FAR_GL_CALLS(X) \
  X(glActiveTexture) X(glAttachShader) X(glBeginQuery) X(glBindBuffer) X(glBindBufferBase) \
  X(glBindBufferRange) X(glBindFramebuffer) X(glBindTexture) X(glBindVertexArray) \
  X(glBufferSubData) X(glClear) X(glClearBufferData) X(glClearBufferSubData) X(glClearBufferfv) \
  X(glClearBufferuiv) X(glColorMask) \
  X(glClearDepth) X(glClientWaitSync) X(glCompileShader) X(glCreateProgram) X(glCreateShader) \
  X(glDeleteBuffers) X(glDeleteFramebuffers) X(glDeleteProgram) X(glDeleteQueries) \
  X(glDeleteShader) X(glDeleteSync) X(glDeleteTextures) X(glDeleteVertexArrays) X(glDepthFunc) \
  X(glDepthMask) X(glDepthRange) X(glDisable) X(glDispatchCompute) X(glDrawArrays) \
  X(glDrawBuffer) X(glEnable) X(glEndQuery) X(glFenceSync) X(glFramebufferParameteri) \
  X(glFramebufferTexture2D) X(glGenBuffers) X(glGenFramebuffers) X(glGenQueries) \
  X(glGenTextures) X(glGenVertexArrays) X(glGetBufferSubData) X(glGetQueryObjectui64v) \
  X(glGetQueryObjectuiv) X(glLinkProgram) X(glMemoryBarrier) X(glPixelStorei) \
  X(glQueryCounter) X(glProgramUniform1f) X(glProgramUniform1i) X(glProgramUniform1ui) X(glProgramUniform2fv) \
  X(glProgramUniform4iv) X(glReadPixels) X(glShaderSource) X(glTexParameteri) X(glUniform1f) \
  X(glUniform1i) X(glUniform1ui) X(glUniform2f) X(glUniform2fv) X(glUniform2iv) X(glUniform4fv) \
  X(glUniform4i) X(glUniform4iv) X(glUniform4uiv) X(glUseProgram) X(glViewport)
// clang-format on
// Those that take memory of the device.
#define FAR_GL_ALLOCATIONS(X) X(glBufferData) X(glTexStorage2D)

inline GLenum (*gl_error_before)() = nullptr;
inline GLenum gl_error_with_memory() {
  if (std::exchange(GlCalls::memory_error, false)) return GL_OUT_OF_MEMORY;
  return gl_error_before();
}

/// Puts the hooks in place for its lifetime.
struct GlHooks {
  GlHooks() {
#define FAR_INSTALL(f) GlHook<&epoxy_##f>::install(#f, false);
    FAR_GL_CALLS(FAR_INSTALL)
#undef FAR_INSTALL
#define FAR_INSTALL(f) GlHook<&epoxy_##f>::install(#f, true);
    FAR_GL_ALLOCATIONS(FAR_INSTALL)
#undef FAR_INSTALL
    gl_error_before = epoxy_glGetError;
    epoxy_glGetError = gl_error_with_memory;
  }
  ~GlHooks() {
#define FAR_REMOVE(f) GlHook<&epoxy_##f>::remove();
    FAR_GL_CALLS(FAR_REMOVE)
    FAR_GL_ALLOCATIONS(FAR_REMOVE)
#undef FAR_REMOVE
    epoxy_glGetError = gl_error_before;
    GlCalls::stop();
  }
};

inline std::set<std::string> hooked_gl_calls() {
  return {
#define FAR_NAME(f) #f,
      FAR_GL_CALLS(FAR_NAME) FAR_GL_ALLOCATIONS(FAR_NAME)
#undef FAR_NAME
  };
}

/// The outcome of one fault.
struct GlFaultOutcome {
  long at = 0;
  std::string function;
  bool threw = false;
  std::string error;
  bool right = false;       // the answer of the faulty call, where it gave one
  bool next_right = false;  // that of the next call
  std::string next_error;   // why the next call gave none
  double seconds = 0;       // of both
};

/// Runs `answer` once per call (or allocation) of an undisturbed run with that one at fault, and
/// again undisturbed after each. `answer` returns whether its answer is right, or throws.
/// `fresh` makes what the run starts from. Of more than 40 calls every fourth is tried, which ones
/// by FARCULL_SEED; all of them with FARCULL_TRIALS=all.
inline std::vector<GlFaultOutcome> try_gl_faults(GlFault fault, const std::function<void()>& fresh,
                                                 const std::function<bool()>& answer) {
  GlHooks hooks;
  fresh();
  GlCalls::start(GlFault::none, 0);
  if (!answer()) throw std::logic_error("the undisturbed answer is wrong");
  const long count = fault == GlFault::drop ? GlCalls::calls : GlCalls::allocations;
  const long step = count > 40 ? 4 / trials(4) : 1;
  std::vector<GlFaultOutcome> out;
  for (long k = static_cast<long>(test_seed(0) % 4) % step; k < count; k += step) {
    fresh();
    GlFaultOutcome o;
    o.at = k;
    const auto start = std::chrono::steady_clock::now();
    GlCalls::start(fault, k);
    try {
      o.right = answer();
    } catch (const std::exception& error) {
      o.threw = true;
      o.error = error.what();
    }
    o.function = GlCalls::hit;
    GlCalls::start(GlFault::none, 0);
    try {
      o.next_right = answer();
    } catch (const std::exception& error) {
      o.next_error = error.what();
    }
    o.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    out.push_back(o);
  }
  return out;
}

// A test of faults expects this of every outcome, and prints these numbers.

/// The answer is right, or there is an error; the next answer is right; no call hangs.
inline void expect_no_wrong_answer(const char* what, const std::vector<GlFaultOutcome>& outcomes) {
  std::size_t threw = 0, wrong = 0, next_wrong = 0, slow = 0;
  double longest = 0;
  for (const GlFaultOutcome& o : outcomes) {
    threw += o.threw;
    longest = std::max(longest, o.seconds);
    if (!o.threw && !o.right) {
      ++wrong;
      ADD_FAILURE() << what << " " << o.at << ", " << o.function << ": a wrong answer";
    }
    if (!o.next_right) {
      ++next_wrong;
      ADD_FAILURE() << what << " " << o.at << ", " << o.function << ": the next answer is wrong"
                    << (o.next_error.empty() ? "" : ": ") << o.next_error
                    << "; before it: " << o.error;
    }
    slow += o.seconds > 60;
  }
  EXPECT_EQ(slow, 0u) << what;
  std::printf(
      "%s: %zu tried, %zu errors, %zu wrong answers, %zu wrong next answers, longest %.1f s\n",
      what, outcomes.size(), threw, wrong, next_wrong, longest);
}

}  // namespace farcull::lab
