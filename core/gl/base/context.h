// Creates OpenGL contexts through EGL, without a window system, on a chosen device.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace farcull {

/// One EGL device of this machine. The constructor of GlContext accepts its index.
struct GlDevice {
  int index = 0;
  std::string kind;                       // "software" or "hardware"
  std::string extensions;                 // EGL device extensions
  std::string drm;                        // DRM device file; empty if there is none
  bool usable = false;                    // true: a context was made on this device
  std::string vendor, renderer, version;  // strings of the device's OpenGL context
  std::string problem;                    // why the device is not usable
};

/// Describes the device of a context.
struct GlInfo {
  std::string kind;  // "software" or "hardware"
  std::string vendor, renderer, version, glsl;
  int subpixel_bits = 0;
  int max_texture_size = 0;
  int max_viewport = 0;
  int max_compute_groups = 0;
  long max_storage_block = 0;  // bytes
  bool reset_detection = false;
};

/// Owns a context of OpenGL 4.3 core or later. The context is current only while a GlCurrent object
/// for the context exists. A thread may use several contexts, one after the other. Several threads
/// may use one context, one thread at a time.
class GlContext {
 public:
  /// device: "" (hardware if available, else software), "hardware", "software" or an index of
  /// list_devices(). Throws Error if EGL or the device is missing, or if the device's OpenGL is too
  /// old. Does not change which context is current in this thread.
  explicit GlContext(const std::string& device = "");
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  const GlInfo& info() const;

  /// Describes all devices. Tries to make a context on each device. Throws Error if EGL is missing.
  static std::vector<GlDevice> list_devices();
  /// True if EGL lists a hardware device. Opens no device. Throws Error if EGL is missing.
  static bool hardware_listed();

 private:
  friend class GlCurrent;
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

/// Makes a context current in this thread while the object exists. The destructor restores the
/// previous state: no context, another GlContext, or a context of the caller with its surfaces and
/// rendering API. Code may call GL only while a GlCurrent object exists. Objects may be nested.
class GlCurrent {
 public:
  /// Throws Error if the context cannot be made current, for example because another thread is
  /// using the context, or because a GLX context is current in this thread.
  explicit GlCurrent(const GlContext& context);
  ~GlCurrent();
  GlCurrent(const GlCurrent&) = delete;
  GlCurrent& operator=(const GlCurrent&) = delete;

 private:
  friend class GlContext;
  struct Before;
  GlCurrent();                      // makes no context current; the destructor restores the state
  std::unique_ptr<Before> before_;  // null: the context was already current
};

/// Returns the number of threads with which Mesa's llvmpipe draws in this process: the larger of
/// the number of running threads and the number set by LP_NUM_THREADS. Returns 0 if the renderer is
/// not llvmpipe. These threads may write to freed memory (docs/drivers.md). So farcull guarantees
/// nothing if there are such threads (assumption A10).
int driver_threads(const std::string& renderer);

/// Returns a text that explains the risk of the driver's threads and the remedy, without a full
/// stop at the end. Returns an empty text if driver_threads() is 0.
std::string risk_of_threads(const std::string& renderer);

/// Throws Error if GL reports an error or a reset (assumption A7). Also throws if the driver has
/// changed this thread's floating-point environment, so that the assumption of the proofs fails
/// (core/base/floating_point.h). stage: the step that the error names.
void check_gl(const std::string& stage);

}  // namespace farcull
