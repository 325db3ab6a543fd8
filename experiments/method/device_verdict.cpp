// What probes found, in words and in a file of JSON: the inputs, the findings, and a checksum of
// both. A file's name is a hash of the inputs, so that builds and drivers keep theirs side by side.
#include "experiments/method/device_verdict.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "core/base/bytes.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "core/gl/base/context.h"
#include "core/gl/probe/probe.h"
#include "experiments/method/kernel_probes.h"
#include "probed.h"

extern char** environ;

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kFormat = 1;
constexpr std::uintmax_t kMostBytes = 1 << 20;

// Variables by which Mesa's drivers and compilers, and NVIDIA's, choose code.
constexpr std::array kDriverVariables = {
    "LP_",    "GALLIVM_", "GALLIUM_", "MESA_",  "LIBGL_",   "NIR_",   "ST_",    "DRAW_", "TGSI_",
    "INTEL_", "IRIS_",    "ANV_",     "AMD_",   "RADV_",    "ACO_",   "R600_",  "SI_",   "RADEON_",
    "ZINK_",  "NOUVEAU_", "NV50_",    "NVC0_",  "FD_",      "IR3_",   "TU_",    "V3D_",  "VC4_",
    "PAN_",   "LIMA_",    "ETNA_",    "SVGA_",  "VIRGL_",   "D3D12_", "ASAHI_", "AGX_",  "__GL_",
    "__GLX_", "glsl_",    "force_",   "allow_", "disable_", "mesa_",  "PIPE_",  "VK_"};
// Where caches and messages go, and how much of them, decides nothing.
constexpr std::array kIdleVariables = {"MESA_SHADER_CACHE", "MESA_GLSL_CACHE", "MESA_LOG",
                                       "MESA_DISK_CACHE", "__GL_SHADER_DISK_CACHE"};

bool begins(const std::string& text, const char* with) { return text.rfind(with, 0) == 0; }

std::string driver_environment() {
  std::vector<std::string> found;
  for (char** at = environ; at != nullptr && *at != nullptr; ++at) {
    const std::string variable = *at;
    const auto named = [&](const char* prefix) { return begins(variable, prefix); };
    if (std::any_of(kDriverVariables.begin(), kDriverVariables.end(), named) &&
        std::none_of(kIdleVariables.begin(), kIdleVariables.end(), named))
      found.push_back(variable);
  }
  std::sort(found.begin(), found.end());
  std::string out;
  for (const std::string& variable : found) out += (out.empty() ? "" : " ") + variable;
  return out;
}

// FNV-1a, 16 hex digits.
std::string hash_of(const std::string& text) {
  Fnv1a hash;
  hash.add(text);
  return hash.hex();
}

// Model and features of the processor, for which a software device generates code.
std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  std::string line, out;
  bool model = false, features = false;
  while (std::getline(in, line) && !(model && features)) {
    const bool is_model = begins(line, "model name") || begins(line, "CPU part");
    const bool is_features = begins(line, "flags") || begins(line, "Features");
    if ((is_model && !model) || (is_features && !features))
      out += (out.empty() ? "" : ", ") +
             (is_model ? line.substr(line.find(':') + 2) : "features " + hash_of(line));
    model |= is_model;
    features |= is_features;
  }
  return out.empty() ? "unknown" : out;
}

// Three digits, or "infinite".
std::string number(double x) {
  if (!std::isfinite(x)) return "infinite";
  char out[32];
  std::snprintf(out, sizeof out, "%.3g", x);
  return out;
}

Json inputs_json(const VerdictInputs& inputs) {
  Json out = Json::object();
  for (const auto& [name, value] : inputs) out[name] = value;
  return out;
}

// Bytes that are no UTF-8 (of the environment) are replaced.
std::string text_of(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string file_of(const VerdictInputs& inputs) {
  const std::string folder = verdict_folder();
  if (folder.empty()) return "";
  return folder + "/device-" + hash_of(text_of(inputs_json(inputs))) + ".json";
}

// A file that is there, and of which `problem` says why it is of no use.
std::optional<DeviceVerdict> read(const std::string& file, const VerdictInputs& inputs,
                                  std::string& problem) {
  struct stat status {};
  if (file.empty() || ::lstat(file.c_str(), &status) != 0) return std::nullopt;
  if (!S_ISREG(status.st_mode) || status.st_uid != ::geteuid()) {
    problem = file + " is not a file of this user";
    return std::nullopt;
  }
  if (static_cast<std::uintmax_t>(status.st_size) > kMostBytes) {
    problem = file + " is damaged";
    return std::nullopt;
  }
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  try {
    Json json = Json::parse(text.str());
    const std::string checksum = json.at("checksum");
    json.erase("checksum");
    if (json.at("farcull_verdict") != kFormat || checksum != hash_of(text_of(json)) ||
        text_of(json.at("inputs")) != text_of(inputs_json(inputs))) {
      problem = file + " is damaged, or about something else";
      return std::nullopt;
    }
    DeviceVerdict out;
    out.holds = json.at("holds");
    out.failed = json.at("failed").get<std::vector<std::string>>();
    out.made = json.at("made");
    out.probes = json.at("probes").size();
    out.ms = json.at("ms");
    out.file = file;
    out.remembered = true;
    if (out.holds != out.failed.empty() || out.probes == 0) {
      problem = file + " contradicts itself";
      return std::nullopt;
    }
    return out;
  } catch (const Json::exception&) {
    problem = file + " is damaged";
    return std::nullopt;
  }
}

// "" or why it could not be written. A reader sees the old file or the new one.
std::string write(const std::string& file, const std::string& text) {
  if (file.empty()) return "neither XDG_CACHE_HOME nor HOME is an absolute path";
  const auto why = [&](int error) { return file + ": " + std::strerror(error); };
  std::error_code error;
  fs::create_directories(fs::path(file).parent_path(), error);
  if (error) return why(error.value());
  std::string beside = file + ".XXXXXX";
  const int descriptor = ::mkstemp(beside.data());
  if (descriptor < 0) return why(errno);
  int failure = 0;
  std::size_t done = 0;
  while (done < text.size() && failure == 0) {
    const ssize_t n = ::write(descriptor, text.data() + done, text.size() - done);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (n == 0 || errno != EINTR) {
      failure = n == 0 ? EIO : errno;
    }
  }
  if (::close(descriptor) != 0 && failure == 0) failure = errno;
  if (failure == 0 && ::rename(beside.c_str(), file.c_str()) != 0) failure = errno;
  if (failure == 0) return "";
  ::unlink(beside.c_str());
  return why(failure);
}

// Takes an older verdict away; "" or why it is still there. Where the folder allows no removal, an
// empty file is one that nobody believes.
std::string forget(const std::string& file) {
  if (file.empty() || ::unlink(file.c_str()) == 0 || errno == ENOENT || errno == ENOTDIR) return "";
  const int failure = errno;
  const int descriptor =
      ::open(file.c_str(), O_WRONLY | O_TRUNC | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0)
    return "an older verdict could not be removed: " + file + ": " + std::strerror(failure);
  ::close(descriptor);
  return "";
}

// Whether write() would have a chance.
std::string unwritable(const std::string& file) {
  if (file.empty()) return write(file, "");
  std::error_code error;
  const fs::path folder = fs::path(file).parent_path();
  fs::create_directories(folder, error);
  if (error) return folder.string() + ": " + std::strerror(error.value());
  return ::access(folder.c_str(), W_OK | X_OK) == 0 ? ""
                                                    : folder.string() + ": " + std::strerror(errno);
}

Json probe_json(const ProbeResult& p) {
  return {{"assumption", p.assumption},
          {"name", p.name},
          {"pass", p.pass},
          {"measured", std::isfinite(p.measured) ? Json(p.measured) : Json("infinite")},
          {"bound", p.bound},
          {"unit", p.unit},
          {"samples", p.samples}};
}

const char* assumptions(Reliance reliance) {
  return reliance == Reliance::pairs ? "A4, A7, A8 and A10" : "A1 to A10";
}

}  // namespace

std::string utc_now() {
  const std::time_t seconds =
      std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc = {};
  ::gmtime_r(&seconds, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string to_string(const DeviceVerdict& verdict, Reliance reliance) {
  if (!verdict.failed.empty()) {
    std::string out = "a probe fails on this device: ";
    for (std::size_t i = 0; i < verdict.failed.size(); ++i)
      out += (i > 0 ? "; " : "") + verdict.failed[i];
    return out;
  }
  if (!verdict.holds) return "the probes of this device broke off: " + verdict.problem;
  return counted(static_cast<std::uint64_t>(verdict.probes), "probe", "probes") + " of " +
         assumptions(reliance) + (verdict.probes == 1 ? " passes" : " pass") +
         " on this device (probed " + verdict.made + (verdict.remembered ? ", remembered)" : ")");
}

VerdictInputs verdict_inputs(const GlInfo& device, Reliance reliance) {
  return {{"relied on", reliance == Reliance::pairs ? "pairs" : "drawing"},
          {"kind", device.kind},
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

std::string verdict_folder() {
  const auto absolute = [](const char* path) { return path != nullptr && path[0] == '/'; };
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  if (absolute(cache)) return std::string(cache) + "/farcull";
  const char* const home = std::getenv("HOME");
  return absolute(home) ? std::string(home) + "/.cache/farcull" : "";
}

std::vector<ProbeResult> pair_probes(const GlContext& context) {
  std::vector<ProbeResult> out = run_probes(context, {.brief = true, .use = ProbeUse::pairs});
  for (ProbeResult& r : pair_kernel_probes(context, {.brief = true})) out.push_back(std::move(r));
  return out;
}

DeviceVerdict device_verdict(const GlInfo& device, Reliance reliance, const Probes& probes,
                             const Say& say) {
  const VerdictInputs inputs = verdict_inputs(device, reliance);
  const std::string file = file_of(inputs);
  std::string useless;
  if (const std::optional<DeviceVerdict> known = read(file, inputs, useless)) return *known;
  if (say) {
    const std::string unkept = unwritable(file);
    say("probing " + device.renderer + " for " + assumptions(reliance) +
        (unkept.empty() ? ", once for this device, driver and build"
                        : "; the verdict cannot be kept, so every run does it: " + unkept) +
        (useless.empty() ? "" : "; " + useless + " and is written anew"));
  }
  const Stopwatch start;
  const std::vector<ProbeResult> results = probes();
  DeviceVerdict out = keep_verdict(device, reliance, results, start.ms());
  if (!useless.empty()) out.note = useless + (out.note.empty() ? "" : "; " + out.note);
  return out;
}

DeviceVerdict keep_verdict(const GlInfo& device, Reliance reliance,
                           const std::vector<ProbeResult>& results, double ms) {
  DeviceVerdict out;
  out.made = utc_now();
  out.probes = results.size();
  out.ms = ms;
  Json probes = Json::array();
  for (const ProbeResult& p : results) {
    probes.push_back(probe_json(p));
    if (p.broke_off && out.problem.empty())
      out.problem = p.assumption + " " + p.name + ": " + p.note;
    if (p.pass || p.broke_off) continue;
    out.failed.push_back(p.assumption + " " + p.name + ": " + number(p.measured) + " " + p.unit +
                         ", bound " + number(p.bound));
  }
  if (results.empty()) out.problem = "there are none";
  out.holds = out.problem.empty() && out.failed.empty();
  const VerdictInputs inputs = verdict_inputs(device, reliance);
  const std::string file = file_of(inputs);
  // Before anything else can fail: no older promise outlives what refutes it.
  if (!out.holds) out.note = forget(file);
  if (!out.holds && out.failed.empty()) return out;
  Json json = {{"farcull_verdict", kFormat},
               {"inputs", inputs_json(inputs)},
               {"holds", out.holds},
               {"failed", out.failed},
               {"made", out.made},
               {"ms", out.ms},
               {"probes", probes}};
  // As a reader will find it, so that the checksum is of the same text.
  json = Json::parse(text_of(json));
  json["checksum"] = hash_of(text_of(json));
  const std::string unkept = write(file, text_of(json, 2) + "\n");
  if (unkept.empty()) {
    out.file = file;
    out.note.clear();
  } else {
    out.note += (out.note.empty() ? "" : "; ") + unkept;
  }
  return out;
}

}  // namespace farcull
