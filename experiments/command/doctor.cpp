// Probes the native canvas (a rasterizer on the CPU) and the device, and prints the results. A
// probe of the native canvas counts errors, so its bound is 0.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include "commit.h"
#include "core/base/floating_point.h"
#include "core/base/stopwatch.h"
#include "core/gl/base/context.h"
#include "core/gl/canvas/canvas.h"
#include "core/gl/probe/probe.h"
#include "core/native/canvas.h"
#include "experiments/command/command.h"
#include "experiments/lemma/lemma.h"
#include "experiments/method/device_verdict.h"
#include "experiments/record/output.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"
#include "offsets/offsets.h"
#include "verify/kernel_check.h"

namespace farcull {
namespace {

constexpr std::size_t kCases = 6000;
constexpr std::uint64_t kPoints = 60'000;
constexpr std::uint64_t kSeed = 1;

// Probes one kernel. Half of the solids are fattened triangles, half have random floats.
ProbeResult probe_kernel(const SolidKernel& kernel, const std::string& target) {
  KernelTally tally;
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < kCases; ++i) {
    SolidCase c{static_cast<float>(i % 97) - 48.5f, static_cast<float>(i % 89) - 44.5f, {}};
    bool ordinary = false;
    if (i % 2 == 0) {
      const KernelTriangle t = kernel_triangle(kSeed, i, c.cx, c.cy);
      ordinary = t.ordinary;
      c.solid = kernel.fatten(t);
    } else {
      c.solid = kernel.adversarial(kSeed, i, c.cx, c.cy);
    }
    SolidAnswer answer{}, scalar{};
    std::uint8_t hit = 0;
    kernel.program.lines_native({&c.solid, 1, &c.cx, &c.cy, &hit, &answer.entry, &answer.exit});
    answer.hit = hit != 0;
    scalar.hit = kernel.program.interval(c.cx, c.cy, c.solid, scalar.entry, scalar.exit);
    kernel.check(c, answer, ordinary, tally);
    const auto bits = [](const SolidAnswer& a) {
      return std::pair(std::bit_cast<std::uint32_t>(a.entry), std::bit_cast<std::uint32_t>(a.exit));
    };
    different += answer.hit != scalar.hit || (answer.hit && bits(answer) != bits(scalar));
  }
  return {.assumption = "A4",
          .name = fmt::format("{}, lanes of {}", kernel.name, target),
          .measured = static_cast<double>(tally.lost + different),
          .unit = "lost or other bits",
          .samples = tally.checked,
          .pass = tally.checked > 0 && tally.lost == 0 && different == 0,
          .note = {}};
}

using Json = nlohmann::ordered_json;

// Returns the index of the device that GlContext would use for this value of --device.
std::optional<int> choose(const std::vector<GlDevice>& devices, const std::string& device) {
  for (const std::string kind : {"hardware", "software"}) {
    for (const GlDevice& d : devices) {
      const bool named = device == std::to_string(d.index);
      if (d.usable && d.kind == kind && (named || device.empty() || device == kind)) return d.index;
    }
  }
  return std::nullopt;
}

Json devices_json(const std::vector<GlDevice>& devices) {
  return json_list(devices, [](const GlDevice& d) {
    Json out = {{"number", d.index},
                {"kind", d.kind},
                {"usable", d.usable},
                {"problem", json_if(!d.usable, d.problem)}};
    out.update(FARCULL_JSON(d, vendor, renderer, version, drm));
    return out;
  });
}

// Formats a number for the table: an integer in full, any other number with three digits.
std::string number(double x) {
  if (x == std::floor(x) && std::abs(x) < 1e9) return fmt::format("{:.0f}", x);
  return fmt::format("{:.3g}", x);
}

std::string devices_table(const std::vector<GlDevice>& devices, int chosen) {
  std::string out = "devices:\n";
  for (const GlDevice& d : devices) {
    out += fmt::format("{} {}  {:<8}  {}\n", d.index == chosen ? '*' : ' ', d.index, d.kind,
                       d.usable ? d.renderer : "not usable: " + d.problem);
  }
  return out;
}

std::string threads_text(const GlInfo& gl) {
  if (gl.kind != "software") return "none on the CPU: the device is hardware";
  const int threads = driver_threads(gl.renderer);
  return threads == 0 ? "0 of the driver: it draws in the calling thread"
                      : std::to_string(threads) + " of the driver: assumption A10 fails";
}

std::string limits_table(const GlInfo& gl, int resolution) {
  return fmt::format(
      "\nchosen: {}\n"
      "  vendor            {}\n"
      "  OpenGL            {}\n"
      "  GLSL              {}\n"
      "  subpixel bits     {}\n"
      "  largest texture   {}\n"
      "  largest viewport  {}\n"
      "  resolution limit  {}\n"
      "  compute groups    {}\n"
      "  storage block     {} bytes\n"
      "  reset detection   {}\n"
      "  threads           {}\n",
      gl.renderer, gl.vendor, gl.version, gl.glsl, gl.subpixel_bits, gl.max_texture_size,
      gl.max_viewport, resolution, gl.max_compute_groups, gl.max_storage_block,
      gl.reset_detection ? "yes" : "no: a reset is seen by lost commands alone (A7)",
      threads_text(gl));
}

Json limits_json(const GlInfo& gl, int resolution) {
  Json out = FARCULL_JSON(gl, subpixel_bits, max_texture_size, max_viewport);
  out["max_resolution"] = resolution;
  out.update(FARCULL_JSON(gl, max_compute_groups, max_storage_block, reset_detection));
  out["threads"] = threads_json(gl);
  return out;
}

std::string arithmetic_line() {
  const FloatingPoint callers = callers_floating_point();
  return fmt::format("\narithmetic of the host: {}; the caller's: {}\n",
                     to_string(floating_point()),
                     callers == kProved ? "the same" : to_string(callers) + " (set aside)");
}

std::string probes_table(const std::vector<ProbeResult>& probes) {
  Table table("lllrrlr");
  table.add({"", "", "probe", "measured", "bound", "", "samples"});
  int failed = 0;
  for (const ProbeResult& p : probes) {
    table.add({p.pass ? "pass" : "FAIL", p.assumption, p.name, number(p.measured), number(p.bound),
               p.unit, grouped(p.samples)});
    if (!p.note.empty()) table.add({p.note});
    failed += !p.pass;
  }
  std::string out = "\n" + table.text();
  out += failed == 0
             ? fmt::format("\nall {} probes pass\n", probes.size())
             : fmt::format(
                   "\n{} of {} probes FAIL: what relies on them promises nothing on this device\n",
                   failed, probes.size());
  return out;
}

Json probes_json(const std::vector<ProbeResult>& probes) {
  return json_list(probes, [](const ProbeResult& p) {
    Json out = FARCULL_JSON(p, assumption, name, pass, measured, bound, unit, samples, note);
    if (!std::isfinite(p.measured)) out["measured"] = "infinite";  // JSON has no infinite number
    return out;
  });
}

// Tests the kernels with each instruction set of lane_targets(). Counts results that lose a part of
// the exact solid, and results that differ from those of the scalar kernel. Then counts violations
// of lemmas 1 and 2 (LemmaRow). Restores the instruction set at the end.
std::vector<ProbeResult> native_probes() {
  struct Restore {
    std::string target = lane_target();
    ~Restore() { use_lane_target(target); }
  };
  std::vector<ProbeResult> out;
  {
    const Restore restore;
    for (const std::string& target : lane_targets()) {
      use_lane_target(target);
      for (const SolidKernel& kernel : solid_kernels()) out.push_back(probe_kernel(kernel, target));
    }
  }
  LemmaSettings settings;
  settings.points = kPoints;
  settings.seed = kSeed;
  settings.displace = true;
  settings.radius = [](const Budget& budget, double) { return budget.radius(); };
  LemmaRow sum;
  for (const Fattener& fattener : {obb_fattener(), minkowski_fattener()}) {
    NativeCanvas canvas(fattener.mode, fattener.solid);
    const LemmaRow total = lemma_total(lemma_experiment(canvas, fattener, settings));
    sum.points += total.points;
    sum.no_sample += total.no_sample;
    sum.not_bounding += total.not_bounding;
  }
  const auto add = [&](const char* assumption, const char* name, std::uint64_t found) {
    out.push_back({.assumption = assumption,
                   .name = name,
                   .measured = static_cast<double>(found),
                   .unit = "points",
                   .samples = sum.points,
                   .pass = sum.points > 0 && found == 0,
                   .note = {}});
  };
  add("A3", "points of triangles whose pixel got no sample", sum.no_sample);
  add("A5", "points that their samples do not bound", sum.not_bounding);
  return out;
}

bool all_pass(const std::vector<ProbeResult>& probes) {
  return std::ranges::all_of(probes, &ProbeResult::pass);
}

std::string native_text(const std::vector<ProbeResult>& probes) {
  std::vector<std::string> others = lane_targets();
  std::erase(others, lane_target());
  return fmt::format(
      "native: the cores of the CPU, lanes of {}{}\n{}", lane_target(),
      others.empty() ? "" : fmt::format(" (also probed: {})", fmt::join(others, ", ")),
      probes_table(probes));
}

Json native_json(const std::vector<ProbeResult>& probes) {
  return {{"lanes", lane_targets()},
          {"max_resolution", native_limits().max_resolution},
          {"probes", probes_json(probes)},
          {"pass", all_pass(probes)}};
}

void write_report(Json report, bool pass, const std::string& path) {
  report["pass"] = pass;
  report["commit"] = FARCULL_COMMIT;
  write_json(report, path);
}

// Probes only the native canvas. Returns the exit status. json: path of the JSON; "": none.
int doctor_without_gl(const std::string& json) {
  const std::vector<ProbeResult> native = native_probes();
  if (!json.empty()) {
    write_report(
        {{"native", native_json(native)},
         {"floating_point", floating_point_json(callers_floating_point(), floating_point())}},
        all_pass(native), json);
  }
  if (json != "-") print(native_text(native) + arithmetic_line());
  return all_pass(native) ? 0 : 1;
}

class DoctorCommand {
 public:
  CLI::App* add_to(CLI::App& app) {
    return add_command(
        app, "doctor", "the devices, and whether each keeps the assumptions",
        {{"--device", &device_, "DEVICE", kDeviceHelp}, {"--json", &json_, "FILE", kJsonHelp}},
        "Examples:\n  farcull doctor\n  farcull doctor --device native\n"
        "  farcull doctor --device software --json -\n\n"
        "What the probes find is kept for later runs, in $XDG_CACHE_HOME/farcull or\n"
        "~/.cache/farcull: far on OpenGL promises where all of A1 to A10 pass. A run without\n"
        "such a verdict on its device, driver and build makes one itself.\n\n"
        "Exit status 1: the native canvas or the device breaks an assumption; what relies on it\n"
        "promises nothing.");
  }
  // Returns 0 if every assumption holds on the native canvas and on the chosen device, else 1.
  // Without OpenGL only the native canvas is tested.
  int run() const {
    const std::string device = device_of(device_);
    const std::string json = checked({.json = json_}, {}).json.value_or("");
    const FloatingPointGuard guard;
    if (is_cpu(device)) return doctor_without_gl(json);
    // Looks for the device first, since the probes of the native canvas take seconds.
    const std::vector<GlDevice> devices = GlContext::list_devices();
    const std::optional<int> chosen = choose(devices, device);
    const bool people = json != "-";
    if (!chosen && device.empty()) {
      if (people)
        print(devices_table(devices, -1) +
              "no device offers what farcull needs of OpenGL: "
              "everything runs on the cores of the CPU\n\n");
      return doctor_without_gl(json);
    }
    if (device == "hardware" && std::ranges::count(devices, device, &GlDevice::kind) == 0)
      throw Error("--device", "no GPU was found", "give software or native");
    // The constructor throws Error if no device fits the option.
    const GlContext context(chosen ? std::to_string(*chosen) : device);
    const std::vector<ProbeResult> native = native_probes();
    const GlInfo& gl = context.info();
    const int resolution = gl_canvas(context, DepthMode::fixed, {})->limits().max_resolution;
    if (people)
      print(native_text(native) + "\n" + devices_table(devices, chosen.value_or(-1)) +
            limits_table(gl, resolution) + arithmetic_line());
    const bool terminal = is_terminal(stderr);
    const Stopwatch probing;
    const std::vector<ProbeResult> probes =
        all_probes(context, [terminal](const std::string& assumption) {
          if (terminal) std::fprintf(stderr, "\r\033[Kprobing %s ...", assumption.c_str());
        });
    if (terminal) std::fprintf(stderr, "\r\033[K");
    const DeviceVerdict verdict = keep_verdict(gl, probes, probing.ms());
    const bool pass = all_pass(native) && all_pass(probes);
    if (!json.empty()) {
      Json report = {
          {"native", native_json(native)},
          {"devices", devices_json(devices)},
          {"chosen", json_of(chosen)},
          {"gl", gl_json(gl)},
          {"limits", limits_json(gl, resolution)},
          {"floating_point", floating_point_json(callers_floating_point(), floating_point())},
          {"probes", probes_json(probes)},
          {"verdict_file", verdict.file}};
      write_report(std::move(report), pass, json);
    }
    if (people) {
      print(probes_table(probes) + fmt::format("\nfar: {}; {}\n", to_string(verdict),
                                               !verdict.file.empty() ? "kept in " + verdict.file
                                               : verdict.note.empty()
                                                   ? "not kept"
                                                   : "not kept: " + verdict.note));
    }
    return pass ? 0 : 1;
  }

 private:
  Text device_, json_;
};

}  // namespace

Command add_doctor(CLI::App& app) { return declare<DoctorCommand>(app); }

}  // namespace farcull
