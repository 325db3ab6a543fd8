// A headless OpenGL context through EGL, without a window system, on a chosen device.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace farcull {

/// One EGL device of this machine; `--device` takes its index.
struct GlDevice {
  int index = 0;
  std::string kind;                       // "software" or "hardware"
  std::string extensions;                 // EGL device extensions
  std::string drm;                        // device file, if the device has one
  bool usable = false;                    // farcull can make a context on this device
  std::string vendor, renderer, version;  // strings of its OpenGL context
  std::string problem;                    // why the device is not usable
};

/// Describes the device of a context. Every result is recorded with this description.
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
/// for it exists. A thread may use several contexts one after the other. Several threads may use
/// one context, one thread at a time.
class GlContext {
 public:
  /// device: "" (hardware first, then software), "hardware", "software" or an index of
  /// list_devices(). Throws Error if EGL or the device is missing, or if its OpenGL is too old.
  /// Afterwards the context that was current in this thread is current again.
  explicit GlContext(const std::string& device = "");
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  const GlInfo& info() const;

  /// Returns all devices, and tries to make a context on each one. Throws Error without EGL.
  static std::vector<GlDevice> list_devices();
  /// True if EGL lists a hardware device. Opens no device. Throws Error without EGL.
  static bool hardware_listed();

 private:
  friend class GlCurrent;
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

/// Makes a context current in this thread while the object exists. The destructor restores the
/// previous state: no context, another GlContext, or a context of the caller with its surfaces and
/// its rendering API. GlCurrent objects may be nested. All code that calls GL must hold one.
class GlCurrent {
 public:
  /// Throws Error if the context cannot be made current: another thread is using it, or a
  /// context of another window-system interface (GLX) is current in this thread.
  explicit GlCurrent(const GlContext& context);
  ~GlCurrent();
  GlCurrent(const GlCurrent&) = delete;
  GlCurrent& operator=(const GlCurrent&) = delete;

 private:
  friend class GlContext;
  struct Before;
  GlCurrent();                      // saves the current state, and changes nothing
  std::unique_ptr<Before> before_;  // null: the context was already current
};

/// Returns the number of threads with which Mesa's llvmpipe draws in this process: the number of
/// running threads, or the number set by LP_NUM_THREADS, whichever is larger. Returns 0 if the
/// renderer is not llvmpipe. Such threads may write to freed memory (docs/drivers.md), so nothing
/// is guaranteed on a device that has them (assumption A10).
int driver_threads(const std::string& renderer);

/// Returns a text about the risk of the driver's threads and the remedy, without a full stop.
/// Returns an empty text if driver_threads() is 0.
std::string risk_of_threads(const std::string& renderer);

/// Throws Error naming `stage` if GL reports an error or a reset (assumption A7). Also throws if
/// this thread's floating-point environment is not the one that the proofs assume, because the
/// driver may have changed it.
void check_gl(const std::string& stage);

}  // namespace farcull
