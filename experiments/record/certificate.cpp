// Collects from a record what a certificate claims of its run; verify/certificate adds the
// evidence.
#include "experiments/record/certificate.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/base/count.h"
#include "core/base/error.h"
#include "core/gl/base/context.h"

namespace farcull {
namespace {

// As docs/reliability.md names them.
std::vector<std::string> assumptions_about(const GlInfo& device) {
  std::vector<std::string> lines = {
      "A1: vertex arithmetic through the viewport transform errs by no more than its term of the "
      "budget",
      "A2: window coordinates snap by at most 2^-b px per axis, b = GL_SUBPIXEL_BITS",
      "A3: coverage is that of one common, infinitesimally shifted sample; zero snapped area "
      "covers nothing",
      "A4: fragment and compute arithmetic as GLSL 4.50, 4.7.1 promises, each program by itself",
      "A5: the depth test compares the depths that the buffer holds; with 24 bits a depth is one "
      "of the two neighbouring integers",
      "A6: a query is zero only if no sample passed",
      "A7: every command ran, or the failure is seen",
      "A8: what a dispatch or a draw wrote is seen after the barrier; atomics neither lose nor "
      "double",
      "A9: gl_FragCoord names the pixel of the fragment; flat inputs, uniforms and what is read "
      "from a buffer are what was sent, to the bit",
      "A10: the driver damages no memory of the process"};
  if (device.kind == "software")
    lines.back() +=
        "; it drew in " +
        counted(static_cast<std::uint64_t>(driver_threads(device.renderer)), "thread", "threads") +
        " of its own";
  return lines;
}

}  // namespace

Certificate certificate_of(const Scene& scene, const Record& record) {
  const RunOptions& options = record.options;
  if (!options.ignored.empty() || options.limit > 0) {
    throw Error(options.ignored.empty() ? "--limit" : scene.name,
                options.ignored.empty() ? "was given, and a certificate is about all pairs"
                                        : "objects are ignored, and a certificate is about all",
                "ask for no certificate, or leave no pair out");
  }
  const std::vector<TrianglePair> kept = pairs_left(record);
  Certificate::Run run;
  run.method = to_string(options.method);
  run.offset = fattens(options.method) ? options.offset : "none";
  for (const ViewReport& view : record.found.views()) {
    if (!view.drawn) continue;
    run.views.push_back({view.name, static_cast<std::uint64_t>(view.width),
                         static_cast<std::uint64_t>(view.height), view.radius_px});
    run.radius_px = std::max(run.radius_px, view.radius_px);
    run.resolution = static_cast<std::uint64_t>(resolution_of(options));
  }
  for (const PairView& view : record.found.pair_views()) {
    if (!view.looked) continue;
    run.views.push_back({view.name, static_cast<std::uint64_t>(view.width),
                         static_cast<std::uint64_t>(view.height), 0});
    run.resolution = std::max({run.resolution, run.views.back().width, run.views.back().height});
  }
  if (record.found.device.gl) {
    const GlInfo& device = *record.found.device.gl;
    run.device = {device.vendor, device.renderer, device.version, device.glsl};
    run.assumptions = assumptions_about(device);
  }
  return make_certificate(scene, kept, record.collisions.all(), std::move(run), options.clearance);
}

}  // namespace farcull
