// Keeps the results of probes in a text file: a checksum, the inputs, the results. The file's name
// is a hash of the inputs, so each build and driver has its own file.
#include "experiments/method/device_verdict.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "offsets/offsets.h"
#include "probed.h"

namespace farcull {
namespace {

// Checks a kernel with fattened triangles of every kind, then (`direct`) with random solids.
KernelTally solids(const GlContext& context, const KernelProbeOptions& options,
                   const SolidKernel& kernel) {
  SolidProgram solid = kernel.program;
  if (options.bare) solid.glsl = "#define FAR_WIDEN 0.0f\n" + solid.glsl;
  KernelTally tally;
  for (const bool direct : {false, true}) {
    std::vector<SolidCase> cases;
    std::vector<bool> ordinary(kSolidCases, false);
    for (std::size_t i = 0; i < kSolidCases; ++i) {
      SolidCase c = solid_case_at(i);
      if (direct) {
        c.solid = kernel.adversarial(options.seed, i, c.cx, c.cy);
      } else {
        const KernelTriangle t = kernel_triangle(options.seed, i, c.cx, c.cy);
        ordinary[i] = t.ordinary;
        c.solid = kernel.fatten(t);
      }
      cases.push_back(c);
    }
    const std::vector<SolidAnswer> answers = device_solids(context, solid, cases);
    for (std::size_t i = 0; i < kSolidCases; ++i)
      kernel.check(cases[i], answers[i], ordinary[i], tally);
    // A step of the depth buffer is 0.25 px, or 16 px if `direct`. For most solids the distance
    // from entry to exit is about one step.
    std::vector<SolidCase> stored = cases;
    if (options.late_stores) std::rotate(stored.begin(), stored.begin() + 1, stored.end());
    const std::vector<std::uint8_t> seen =
        device_seen(context, solid, stored, cases, direct ? 0x1p26 : 0x1p20);
    for (std::size_t i = 0; i < kSolidCases; ++i) {
      if (!answers[i].hit) continue;
      ++tally.checked;
      tally.lost += seen[i] == 0;
    }
  }
  return tally;
}

namespace fs = std::filesystem;

// Prefixes of environment variables that change the code that drivers of Mesa and NVIDIA generate.
constexpr std::array kDriverVariables = {
    "LP_",    "GALLIVM_", "GALLIUM_", "MESA_",    "LIBGL_", "NIR_",  "ST_",   "DRAW_",
    "TGSI_",  "INTEL_",   "IRIS_",    "ANV_",     "AMD_",   "RADV_", "ACO_",  "R600_",
    "SI_",    "RADEON_",  "ZINK_",    "NOUVEAU_", "NV50_",  "NVC0_", "FD_",   "IR3_",
    "TU_",    "V3D_",     "VC4_",     "PAN_",     "LIMA_",  "ETNA_", "SVGA_", "VIRGL_",
    "D3D12_", "ASAHI_",   "AGX_",     "__GL_",    "__GLX_", "PIPE_", "VK_"};

std::string driver_environment() {
  std::vector<std::string> found;
  for (char** at = environ; at != nullptr && *at != nullptr; ++at) {
    const std::string variable = *at;
    const auto named = [&](const char* prefix) { return variable.starts_with(prefix); };
    // Mesa also reads each driconf option from an environment variable with the option's lower-case
    // name. So all variables without capitals are inputs, except `_` and proxy settings.
    const std::string name = variable.substr(0, variable.find('='));
    const bool may_be_driconf =
        std::ranges::none_of(name, [](char c) { return c >= 'A' && c <= 'Z'; }) && name != "_" &&
        !name.ends_with("_proxy");
    if (may_be_driconf || std::ranges::any_of(kDriverVariables, named)) found.push_back(variable);
  }
  std::sort(found.begin(), found.end());
  std::string out;
  for (const std::string& variable : found) out += (out.empty() ? "" : " ") + variable;
  return out;
}

std::string hash_of(const std::string& text) {
  Fnv1a hash;
  hash.add(text);
  return hash.hex();
}

// Returns the processor's model and features, on which the code of a software device depends.
std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  std::string line, out;
  bool model = false, features = false;
  while (std::getline(in, line) && !(model && features)) {
    const bool is_model = line.starts_with("model name") || line.starts_with("CPU part");
    const bool is_features = line.starts_with("flags") || line.starts_with("Features");
    if ((is_model && !model) || (is_features && !features))
      out += (out.empty() ? "" : ", ") +
             (is_model ? line.substr(line.find(':') + 2) : "features " + hash_of(line));
    model |= is_model;
    features |= is_features;
  }
  return out.empty() ? "unknown" : out;
}

std::string number(double x) {
  if (!std::isfinite(x)) return "infinite";
  char out[32];
  std::snprintf(out, sizeof out, "%.3g", x);
  return out;
}

std::string text_of(const VerdictInputs& inputs) {
  std::string out;
  for (const auto& [name, value] : inputs) out += name + ": " + value + "\n";
  return out;
}

// Returns the path of the verdict's file: in $XDG_CACHE_HOME/farcull if that path is absolute, else
// in $HOME/.cache/farcull. Returns "" if neither variable has an absolute path.
std::string file_of(const std::string& inputs) {
  const auto absolute = [](const char* path) { return path != nullptr && path[0] == '/'; };
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  if (!absolute(cache) && !absolute(home)) return "";
  const std::string folder = absolute(cache) ? cache : std::string(home) + "/.cache";
  return folder + "/farcull/device-" + hash_of(inputs);
}

// Reads the verdict. Returns nothing if the file is missing, is damaged, belongs to another user,
// or was written for other inputs.
std::optional<DeviceVerdict> read(const std::string& file, const std::string& inputs) {
  struct stat status {};
  if (file.empty() || ::lstat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode) ||
      status.st_uid != ::geteuid())
    return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  std::string hash;
  std::getline(in, hash);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  if (hash != hash_of(text) || !text.starts_with(inputs)) return std::nullopt;
  std::istringstream found(text.substr(inputs.size()));
  DeviceVerdict out;
  out.file = file;
  found >> out.made >> out.probes >> out.ms;
  if (!found || found.get() != '\n' || out.probes == 0) return std::nullopt;
  for (std::string line; std::getline(found, line);) out.failed.push_back(line);
  out.holds = out.failed.empty();
  out.remembered = true;
  return out;
}

// Writes the file. Returns why this failed, or "". A reader sees either the old file or the new
// file, never a partial file.
std::string write(const std::string& file, const std::string& text) {
  if (file.empty()) return "neither XDG_CACHE_HOME nor HOME is an absolute path";
  const std::string beside = file + "." + std::to_string(::getpid());
  std::error_code error, ignored;
  fs::create_directories(fs::path(file).parent_path(), error);
  std::ofstream out(beside, std::ios::binary);
  out << text;
  out.close();
  if (!out) error = {errno, std::generic_category()};
  if (!error) fs::rename(beside, file, error);
  if (!error) return "";
  fs::remove(beside, ignored);
  return file + ": " + error.message();
}

}  // namespace

std::vector<SolidKernel> solid_kernels() {
  return {{"oriented boxes", obb_fattener().solid,
           [](const KernelTriangle& t) { return obb_of(t.corners, t.radius); }, adversarial_box,
           check_box},
          {"exact offsets", minkowski_fattener().solid,
           [](const KernelTriangle& t) {
             return minkowski_solid(t.corners[0], t.corners[1], t.corners[2], t.radius);
           },
           adversarial_minkowski, check_minkowski}};
}

std::vector<ProbeResult> solid_kernel_probes(const GlContext& context,
                                             const KernelProbeOptions& options) {
  const std::string tried =
      "solid_interval by the canvas's fragment program; triangles of every kind, and floats made "
      "to fail; each is seen behind itself, by the programs with flags and with queries, in both "
      "depth formats";
  std::vector<ProbeResult> out;
  for (const SolidKernel& kernel : solid_kernels()) {
    out.push_back({.assumption = "A4", .name = kernel.name, .unit = "lost", .note = {}});
    ProbeResult& of = out.back();
    try {
      const KernelTally t = solids(context, options, kernel);
      const bool loose =
          static_cast<double>(t.loose) > kLooseShare * static_cast<double>(t.ordinary);
      of.measured = static_cast<double>(t.lost);
      of.samples = t.checked;
      of.pass = t.checked > 0 && t.lost == 0 && !loose;
      of.note = tried;
      if (t.ordinary > 0) {
        of.note += "; " + std::to_string(t.loose) + " of " + std::to_string(t.ordinary) +
                   " ordinary ones wider than exact by 0.1 px" + (loose ? ": TOO MANY" : "");
      }
    } catch (const Error& error) {
      of.note = error.what();
      of.broke_off = true;
    }
  }
  return out;
}

std::vector<ProbeResult> all_probes(const GlContext& context,
                                    const std::function<void(const std::string&)>& started,
                                    bool brief) {
  std::vector<ProbeResult> out = run_probes(context, {.brief = brief}, started);
  if (started) started("kernels");
  for (ProbeResult& r : solid_kernel_probes(context)) out.push_back(std::move(r));
  std::ranges::stable_sort(out, {}, [](const ProbeResult& r) {
    return std::pair(r.assumption.size(), r.assumption);  // sorts A10 after A2
  });
  return out;
}

std::string utc_now() {
  const std::time_t seconds =
      std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc = {};
  ::gmtime_r(&seconds, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string to_string(const DeviceVerdict& verdict) {
  if (!verdict.failed.empty()) {
    std::string out = "a probe fails on this device: ";
    for (std::size_t i = 0; i < verdict.failed.size(); ++i)
      out += (i > 0 ? "; " : "") + verdict.failed[i];
    return out;
  }
  if (!verdict.holds) return "the probes of this device broke off: " + verdict.problem;
  return counted(static_cast<std::uint64_t>(verdict.probes), "probe", "probes") + " of A1 to A10" +
         (verdict.probes == 1 ? " passes" : " pass") + " on this device (probed " + verdict.made +
         (verdict.remembered ? ", remembered)" : ")");
}

VerdictInputs verdict_inputs(const GlInfo& device) {
  return {{"kind", device.kind},
          {"vendor", device.vendor},
          {"renderer", device.renderer},
          {"version", device.version},
          {"glsl", device.glsl},
          {"subpixel bits", std::to_string(device.subpixel_bits)},
          {"limits", std::to_string(device.max_texture_size) + " " +
                         std::to_string(device.max_viewport) + " " +
                         std::to_string(device.max_compute_groups) + " " +
                         std::to_string(device.max_storage_block)},
          {"sources", FARCULL_PROBED},
          {"threads", std::to_string(driver_threads(device.renderer))},
          {"processor", device.kind == "software" ? processor() : ""},
          {"environment", driver_environment()}};
}

DeviceVerdict device_verdict(const GlInfo& device, const Probes& probes, const Say& say) {
  const std::string inputs = text_of(verdict_inputs(device));
  if (const std::optional<DeviceVerdict> known = read(file_of(inputs), inputs)) return *known;
  if (say)
    say("probing " + device.renderer + " for A1 to A10, once for this device, driver and build");
  const Stopwatch start;
  const std::vector<ProbeResult> results = probes();
  DeviceVerdict out = keep_verdict(device, results, start.ms());
  if (say && !out.note.empty())
    say("the verdict cannot be kept, so every run probes the device: " + out.note);
  return out;
}

DeviceVerdict keep_verdict(const GlInfo& device, const std::vector<ProbeResult>& results,
                           double ms) {
  DeviceVerdict out;
  out.made = utc_now();
  out.probes = results.size();
  out.ms = ms;
  for (const ProbeResult& p : results) {
    if (p.broke_off && out.problem.empty())
      out.problem = p.assumption + " " + p.name + ": " + p.note;
    if (p.pass || p.broke_off) continue;
    out.failed.push_back(p.assumption + " " + p.name + ": " + number(p.measured) + " " + p.unit +
                         ", bound " + number(p.bound));
  }
  if (results.empty()) out.problem = "there are none";
  out.holds = out.problem.empty() && out.failed.empty();
  const std::string inputs = text_of(verdict_inputs(device)), file = file_of(inputs);
  // If the device breaks an assumption, the older file is removed first, or emptied if it cannot be
  // removed. So no file keeps a refuted verdict, even if a later step fails.
  std::error_code error;
  if (!out.holds && !file.empty() && !fs::remove(file, error) && error)
    fs::resize_file(file, 0, error);
  if (!out.holds && out.failed.empty()) return out;
  // Lines of the file: a hash of all following lines, the inputs, three values, the failures.
  std::ostringstream rest;
  rest << inputs << out.made << ' ' << out.probes << ' ' << ms << '\n';
  for (const std::string& failure : out.failed) rest << failure << '\n';
  out.note = write(file, hash_of(rest.str()) + "\n" + rest.str());
  if (out.note.empty()) out.file = file;
  return out;
}

}  // namespace farcull
