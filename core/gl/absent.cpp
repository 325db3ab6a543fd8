// Stubs for a build without OpenGL (-DFARCULL_GL=OFF). Replaces all other files of core/gl except
// picture/window.cpp. The constructor of GlContext throws Error, so functions that take a GlContext
// are never called. They exist only for the linker.
#include "core/base/error.h"
#include "core/gl/base/context.h"
#include "core/gl/canvas/canvas.h"
#include "core/gl/picture/picture.h"
#include "core/gl/probe/probe.h"

namespace farcull {
namespace {

[[noreturn]] void refuse(const std::string& device = "") {
  throw Error(device.empty() ? "OpenGL" : "{device} " + device,
              "this farcull was built without OpenGL",
              "use {device} native, or build it with -DFARCULL_GL=ON (Debian: libepoxy-dev, "
              "libegl-dev)");
}

}  // namespace

struct GlContext::Handles {};

GlContext::GlContext(const std::string& device) { refuse(device); }
GlContext::~GlContext() = default;
const GlInfo& GlContext::info() const { refuse(); }
std::vector<GlDevice> GlContext::list_devices() { return {}; }
bool GlContext::hardware_listed() { refuse(); }

int driver_threads(const std::string&) { return 0; }
std::string risk_of_threads(const std::string&) { return ""; }

std::unique_ptr<Canvas> gl_canvas(const GlContext&, DepthMode, const SolidProgram&,
                                  const GlCanvasOptions&) {
  refuse();
}

std::vector<ProbeResult> run_probes(const GlContext&, const ProbeOptions&,
                                    const std::function<void(const std::string&)>&) {
  refuse();
}

std::vector<SolidAnswer> device_solids(const GlContext&, const SolidProgram&,
                                       std::span<const SolidCase>) {
  refuse();
}

std::vector<std::uint8_t> device_seen(const GlContext&, const SolidProgram&,
                                      std::span<const SolidCase>, std::span<const SolidCase>,
                                      double) {
  refuse();
}

Image draw_picture(const GlContext&, const Scene&, const Window&, std::span<const PictureTriangle>,
                   int) {
  refuse();
}

}  // namespace farcull
