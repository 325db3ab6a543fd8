// A headless OpenGL context through EGL: no window system, the device chosen by name or number.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace farcull {

/// One EGL device of this machine, as `--device` numbers them.
struct GlDevice {
  int index = 0;
  std::string kind;        // "software" or "hardware"
  std::string extensions;  // EGL device extensions
  std::string drm;         // device file, where it has one
  bool usable = false;     // a context of the version that farcull needs could be made
  std::string vendor, renderer, version;  // of that context
  std::string problem;                    // why it is not usable
};

/// What answered; recorded with every result.
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

/// A current context of OpenGL 4.3 core or later, released with the object. One at a time per
/// thread.
class GlContext {
 public:
  /// device: "" (hardware first, then software), "hardware", "software" or a number of
  /// list_devices(). Throws Error where there is no EGL, no such device, or its OpenGL is too old.
  explicit GlContext(const std::string& device = "");
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  const GlInfo& info() const;

  /// Every device, each tried with a context of its own; an empty list where there are none. Throws
  /// Error without EGL.
  static std::vector<GlDevice> list_devices();
  /// Whether EGL lists a hardware device; none is opened. Throws Error without EGL.
  static bool hardware_listed();

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

/// Reads GL's error flags and the reset status; throws Error naming `stage` unless both are clean
/// (assumption A7).
void check_gl(const std::string& stage);

}  // namespace farcull
