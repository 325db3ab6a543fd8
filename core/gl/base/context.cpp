// Makes OpenGL contexts on EGL devices, without a window system. Makes a context current, and
// restores the previous EGL state of the thread.
#include "core/gl/base/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <thread>

#include "core/base/error.h"
#include "core/base/floating_point.h"
#include "core/base/text.h"

namespace farcull {

struct EglContext {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  ~EglContext() {
    // Does not terminate the display: EGL has one display per device, and another context of this
    // process may be using the display.
    if (context == EGL_NO_CONTEXT) return;
    if (eglGetCurrentContext() == context)
      eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
  }
};

namespace {

constexpr int kMajor = 4, kMinor = 3;
constexpr const char* kInstall =
    "install Mesa's software device (Debian: libegl1 libgl1-mesa-dri) or a GPU driver with EGL";

std::string text(const char* s) { return s ? s : ""; }
std::string gl_text(GLenum name) { return text(reinterpret_cast<const char*>(glGetString(name))); }

bool has_word(const std::string& list, const std::string& word) {
  return (" " + list + " ").find(" " + word + " ") != std::string::npos;
}

// driver_threads() returns the larger of two counts, because each count can be too small.
// running_threads() misses a new thread that is not yet named llvmpipe. asked_threads() is wrong if
// Mesa read another value of LP_NUM_THREADS.

// Returns the thread count that llvmpipe derives from LP_NUM_THREADS. The default is the number of
// cores, or 0 for one core. Call this before a display is opened: llvmpipe then reads the value.
int asked_threads() {
  static const int asked = [] {
    constexpr long kMost = 16;  // maximum number of llvmpipe threads in Mesa 22
    const long cores = static_cast<long>(std::thread::hardware_concurrency());
    long threads = cores > 1 ? cores : 0;
    if (const char* const text = std::getenv("LP_NUM_THREADS")) {
      char* end = nullptr;
      const long number = std::strtol(text, &end, 0);
      if (end != text) threads = number;
    }
    return static_cast<int>(threads < 0 ? kMost : std::min(threads, kMost));
  }();
  return asked;
}

int running_threads() {
  namespace fs = std::filesystem;
  int threads = 0;
  std::error_code failed;
  for (fs::directory_iterator task("/proc/self/task", failed), end; !failed && task != end;
       task.increment(failed)) {
    std::ifstream file(task->path() / "comm");
    std::string name;
    if (std::getline(file, name)) threads += name.starts_with("llvmpipe-");
  }
  return threads;
}

// Throws Error if too little address space is left for Mesa's software device, for example because
// of ulimit -v. The device needs memory for libraries such as LLVM, and a stack and a heap for each
// of up to 16 threads. With less memory, the device crashes or appears not to be installed.
void require_memory() {
  const unsigned threads = std::clamp(std::thread::hardware_concurrency(), 1u, 16u);
  const std::size_t bytes = (std::size_t{256} + std::size_t{64} * threads) << 20;
  void* const reserved = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                                MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (reserved == MAP_FAILED) {
    throw Error(
        "EGL",
        "a device may take " + std::to_string(bytes >> 20) + " MB of memory, and less is left",
        "raise the limit (ulimit -v), use {device} native, or a machine with "
        "more memory");
  }
  ::munmap(reserved, bytes);
}

// Throws Error if libEGL is missing, or lacks the extensions to list and open devices. Calls
// epoxy_has_egl() first, because libepoxy aborts the process if libEGL is missing.
void require_egl() {
  asked_threads();
  require_memory();
  if (!epoxy_has_egl()) throw Error("EGL", "libEGL.so.1 cannot be loaded", kInstall);
  const std::string client = text(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS));
  if (!has_word(client, "EGL_EXT_device_enumeration") && !has_word(client, "EGL_EXT_device_base")) {
    throw Error("EGL",
                "no EGL driver is installed, or it cannot list devices (EGL_EXT_device_enumeration "
                "is missing)",
                kInstall);
  }
  if (!has_word(client, "EGL_EXT_platform_device") && !has_word(client, "EGL_EXT_platform_base")) {
    throw Error("EGL",
                "this EGL cannot open a device without a window system (EGL_EXT_platform_device is "
                "missing)",
                kInstall);
  }
}

std::vector<EGLDeviceEXT> devices() {
  EGLint count = 0;
  if (!eglQueryDevicesEXT(0, nullptr, &count)) return {};
  std::vector<EGLDeviceEXT> list(count);
  if (count == 0 || !eglQueryDevicesEXT(count, list.data(), &count)) return {};
  list.resize(count);
  return list;
}

GlDevice describe(EGLDeviceEXT device, int index) {
  GlDevice out;
  out.index = index;
  out.extensions = text(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS));
  out.kind = has_word(out.extensions, "EGL_MESA_device_software") ? "software" : "hardware";
  if (has_word(out.extensions, "EGL_EXT_device_drm"))
    out.drm = text(eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT));
  return out;
}

constexpr const char* kNoMemory = "there is not enough memory for it (EGL_BAD_ALLOC)";

// Returns kNoMemory if EGL's last error is EGL_BAD_ALLOC, else `reason`.
std::string with_cause(const char* reason) {
  return eglGetError() == EGL_BAD_ALLOC ? kNoMemory : reason;
}

// Returns the properties of the current context's device.
GlInfo read_info(const std::string& kind) {
  GlInfo info;
  info.kind = kind;
  info.vendor = gl_text(GL_VENDOR);
  info.renderer = gl_text(GL_RENDERER);
  info.version = gl_text(GL_VERSION);
  info.glsl = gl_text(GL_SHADING_LANGUAGE_VERSION);
  GLint viewport[2] = {0, 0};
  GLint64 block = 0;
  glGetIntegerv(GL_SUBPIXEL_BITS, &info.subpixel_bits);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &info.max_texture_size);
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 0, &info.max_compute_groups);
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
  info.max_viewport = std::min(viewport[0], viewport[1]);
  info.max_storage_block = static_cast<long>(block);
  GLint strategy = GL_NO_RESET_NOTIFICATION;
  if (epoxy_has_gl_extension("GL_KHR_robustness") || epoxy_gl_version() >= 45)
    glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY, &strategy);
  info.reset_detection = strategy == GL_LOSE_CONTEXT_ON_RESET;
  return info;
}

// Makes a context on the device and makes it current. Returns the error, or "" on success.
std::string open(EGLDeviceEXT device, EglContext& out) {
  const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
    return with_cause("its display cannot be initialized");
  out.display = display;
  if (!eglBindAPI(EGL_OPENGL_API)) return "it has no desktop OpenGL";
  const std::string extensions = text(eglQueryString(display, EGL_EXTENSIONS));
  if (!has_word(extensions, "EGL_KHR_surfaceless_context")) return "it has no surfaceless contexts";
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!has_word(extensions, "EGL_KHR_no_config_context")) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                             EGL_NONE};
    EGLint found = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &found) || found == 0)
      return "it has no OpenGL configuration";
  }
  const auto create = [&](bool robust) {
    std::vector<EGLint> wanted = {
        EGL_CONTEXT_MAJOR_VERSION,       kMajor,
        EGL_CONTEXT_MINOR_VERSION,       kMinor,
        EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    if (robust) {
      wanted.insert(wanted.end(),
                    {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
    }
    wanted.push_back(EGL_NONE);
    return eglCreateContext(display, config, EGL_NO_CONTEXT, wanted.data());
  };
  out.context = create(true);
  if (out.context == EGL_NO_CONTEXT) out.context = create(false);
  if (out.context == EGL_NO_CONTEXT) {
    if (eglGetError() == EGL_BAD_ALLOC) return kNoMemory;
    return "its OpenGL is older than " + std::to_string(kMajor) + "." + std::to_string(kMinor) +
           " core";
  }
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, out.context))
    return with_cause("its context cannot be made current");
  return "";
}

}  // namespace

struct GlContext::Handles {
  EglContext egl;
  GlInfo info;
};

// Saves EGL's state of this thread (rendering API, current context). The destructor restores it.
struct GlCurrent::Before {
  EGLenum api = eglQueryAPI();
  EGLDisplay display = eglGetCurrentDisplay();
  EGLContext context = eglGetCurrentContext();
  EGLSurface draw = eglGetCurrentSurface(EGL_DRAW), read = eglGetCurrentSurface(EGL_READ);
  EGLDisplay ours = EGL_NO_DISPLAY;

  ~Before() {
    const EGLDisplay now = eglGetCurrentDisplay();
    if (context != EGL_NO_CONTEXT) {
      eglBindAPI(api);
      if (eglMakeCurrent(display, draw, read, context)) return;
      // The saved context no longer exists. The code below leaves no context current.
    }
    if (ours != EGL_NO_DISPLAY || now != EGL_NO_DISPLAY) {
      eglBindAPI(EGL_OPENGL_API);
      eglMakeCurrent(ours != EGL_NO_DISPLAY ? ours : now, EGL_NO_SURFACE, EGL_NO_SURFACE,
                     EGL_NO_CONTEXT);
    }
    eglBindAPI(api);
  }
};

GlCurrent::GlCurrent() : before_(std::make_unique<Before>()) {}

GlCurrent::GlCurrent(const GlContext& context) {
  const EglContext& egl = context.handles_->egl;
  if (eglGetCurrentContext() == egl.context) return;
  auto before = std::make_unique<Before>();
  before->ours = egl.display;
  eglBindAPI(EGL_OPENGL_API);
  const bool made = eglMakeCurrent(egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl.context);
  const bool taken = !made && eglGetError() == EGL_BAD_ACCESS;
  if (!made || eglGetCurrentContext() != egl.context) {
    throw Error("GL context",
                taken ? "it cannot be made current: another thread is using it, or a context of "
                        "another interface than EGL (GLX) is current in this thread"
                      : "it cannot be made current",
                taken ? "use it from one thread at a time, and release a GLX context first"
                      : "run again, or with another {device}");
  }
  before_ = std::move(before);
}

GlCurrent::~GlCurrent() = default;

GlContext::GlContext(const std::string& device) {
  const FloatingPointGuard guard;  // drivers loaded below may use -ffast-math
  require_egl();
  const GlCurrent before;
  const std::vector<EGLDeviceEXT> list = devices();
  if (list.empty()) throw Error("EGL", "there is no EGL device", kInstall);
  const std::optional<int> wanted = parse_number<int>(device);
  if (!device.empty() && device != "hardware" && device != "software" && !wanted) {
    throw Error("{device}", "'" + device + "' is no device",
                "give software, hardware or a number that `{doctor}` lists");
  }
  if (wanted && (*wanted < 0 || *wanted >= static_cast<int>(list.size()))) {
    throw Error("{device}",
                "there is no device " + device + " (0 .. " + std::to_string(list.size() - 1) + ")",
                "see `{doctor}`");
  }
  std::string problems;
  for (const std::string kind : {"hardware", "software"}) {
    for (int i = 0; i < static_cast<int>(list.size()); ++i) {
      if (wanted && *wanted != i) continue;
      if (describe(list[i], i).kind != kind || (!wanted && !device.empty() && device != kind))
        continue;
      handles_ = std::make_unique<Handles>();
      const std::string problem = open(list[i], handles_->egl);
      if (problem.empty()) {
        handles_->info = read_info(kind);
        check_gl("context");
        return;
      }
      problems += (problems.empty() ? "device " : ", device ") + std::to_string(i) + ": " + problem;
      handles_.reset();
    }
  }
  throw Error("EGL", problems.empty() ? "there is no " + device + " device" : problems,
              problems.find(kNoMemory) == std::string::npos
                  ? kInstall
                  : "use a machine with more memory, or {device} native");
}

GlContext::~GlContext() = default;

const GlInfo& GlContext::info() const { return handles_->info; }

bool GlContext::hardware_listed() {
  const FloatingPointGuard guard;  // drivers are loaded below
  require_egl();
  return std::ranges::any_of(
      devices(), [](EGLDeviceEXT device) { return describe(device, 0).kind == "hardware"; });
}

std::vector<GlDevice> GlContext::list_devices() {
  const FloatingPointGuard guard;  // drivers are loaded below
  require_egl();
  const GlCurrent before;
  std::vector<GlDevice> out;
  const std::vector<EGLDeviceEXT> list = devices();
  for (int i = 0; i < static_cast<int>(list.size()); ++i) {
    out.push_back(describe(list[i], i));
    EglContext egl;
    out.back().problem = open(list[i], egl);
    out.back().usable = out.back().problem.empty();
    if (!out.back().usable) continue;
    out.back().vendor = gl_text(GL_VENDOR);
    out.back().renderer = gl_text(GL_RENDERER);
    out.back().version = gl_text(GL_VERSION);
  }
  return out;
}

int driver_threads(const std::string& renderer) {
  // If Mesa's zink (OpenGL on Vulkan) draws with llvmpipe, its renderer text also names llvmpipe.
  if (renderer.find("llvmpipe") == std::string::npos) return 0;
  return std::max(asked_threads(), running_threads());
}

std::string risk_of_threads(const std::string& renderer) {
  const int threads = driver_threads(renderer);
  if (threads == 0) return "";
  return "the driver draws in " +
         counted(static_cast<std::uint64_t>(threads), "thread", "threads") +
         " of its own, which may damage the memory of this process or hang it; set "
         "LP_NUM_THREADS=0 in the environment before a display is opened, so that it has none";
}

void check_gl(const std::string& stage) {
  std::string errors;
  // Stops after 16 errors, because a lost context may report errors endlessly.
  for (int i = 0; i < 16; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    const char* name = error == GL_INVALID_ENUM        ? "GL_INVALID_ENUM"
                       : error == GL_INVALID_VALUE     ? "GL_INVALID_VALUE"
                       : error == GL_INVALID_OPERATION ? "GL_INVALID_OPERATION"
                       : error == GL_OUT_OF_MEMORY     ? "GL_OUT_OF_MEMORY"
                       : error == GL_INVALID_FRAMEBUFFER_OPERATION
                           ? "GL_INVALID_FRAMEBUFFER_OPERATION"
                           : "an unknown GL error";
    errors += (errors.empty() ? "" : ", ") + std::string(name);
  }
  if (!errors.empty()) {
    throw Error("GL " + stage, errors,
                errors.find("MEMORY") != std::string::npos
                    ? "memory is missing: choose a smaller resolution or another {device}"
                    : "this is a fault of the driver or of farcull: report it with the output of "
                      "`{doctor}`");
  }
  if (epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_KHR_robustness")) {
    const GLenum reset =
        epoxy_gl_version() >= 45 ? glGetGraphicsResetStatus() : glGetGraphicsResetStatusKHR();
    if (reset != GL_NO_ERROR)
      throw Error("GL " + stage, "the graphics context was reset",
                  "run again, or with another {device}");
  }
  require_proved("GL " + stage);
}

}  // namespace farcull
