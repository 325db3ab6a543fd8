#include "experiments/frames.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <csignal>
#include <filesystem>

#include "core/error.h"
#include "experiments/builtin_motion.h"
#include "experiments/builtin_scenes.h"
#include "experiments/output.h"
#include "experiments/run_pairs.h"
#include "experiments/scene_file.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

constexpr long kMostFrames = 1'000'000;

std::string moving_names() {
  std::string names;
  for (const BuiltinMotion& motion : builtin_motions())
    names += (names.empty() ? "" : ", ") + motion.scene;
  return names;
}

// What a signal's handler may look at.
std::atomic<long> frames_done = 0, frames_wanted = 0;
static_assert(std::atomic<long>::is_always_lock_free);
volatile std::sig_atomic_t on_terminal = 0;

std::size_t append(char* text, std::size_t at, const char* more) {
  while (*more != '\0') text[at++] = *more++;
  return at;
}

std::size_t append(char* text, std::size_t at, long number) {
  char digits[24];
  std::size_t n = 0;
  do {
    digits[n++] = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number > 0);
  while (n > 0) text[at++] = digits[--n];
  return at;
}

extern "C" void say_how_far(int signal) {
  char text[160];
  std::size_t size = append(text, 0, on_terminal ? "\r\033[K" : "");
  size = append(text, size, "farcull: interrupted: after ");
  size = append(text, size, frames_done.load());
  size = append(text, size, " of ");
  size = append(text, size, frames_wanted.load());
  size = append(text, size, " frames; nothing was written\n");
  (void)!::write(STDERR_FILENO, text, size);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

// While it lives, a signal that ends the program says how far it came.
class Interruptible {
 public:
  Interruptible(long frames, bool terminal) {
    frames_done = 0;
    frames_wanted = frames;
    on_terminal = terminal;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], nullptr, &before_[i]);
      // A signal that the caller had us ignore (nohup) stays ignored.
      if (before_[i].sa_handler == SIG_IGN) continue;
      struct sigaction action = {};
      action.sa_handler = say_how_far;
      ::sigaction(kSignals[i], &action, nullptr);
    }
  }
  ~Interruptible() {
    for (std::size_t i = 0; i < kSignals.size(); ++i)
      ::sigaction(kSignals[i], &before_[i], nullptr);
  }
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_ = {};
};

// What a frame has of its own in the record of a run; the rest is that of all.
constexpr std::array kOfFrame = {"views",           "stages",          "pcs",
                                 "candidate_pairs", "colliding_pairs", "neighbour_pairs",
                                 "neighbours",      "verification",    "time_ms"};

Json frame_json(const Json& run, long frame, double read_ms) {
  Json out = {{"frame", frame}, {"hash", run["scene"]["hash"]}};
  for (const char* key : kOfFrame) out[key] = run[key];
  out["time_ms"]["read"] = read_ms;
  return out;
}

}  // namespace

FrameRange parse_frames(const std::string& text) {
  const Error bad(
      "--frames", "'" + text + "' is no range of frames",
      fmt::format("give a number from 1 to {}, or first:last, as in 1:100", kMostFrames));
  const auto number = [&](const std::string& part) {
    long value = 0;
    const auto [end, code] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (code != std::errc() || end != part.data() + part.size() || value < 0) throw bad;
    return value;
  };
  FrameRange range;
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) {
    range.last = number(text) - 1;
  } else {
    range.first = number(text.substr(0, colon));
    range.last = number(text.substr(colon + 1));
  }
  if (range.last < range.first || range.last - range.first >= kMostFrames) throw bad;
  return range;
}

FrameSource::FrameSource(std::vector<std::string> arguments, FrameRange range, bool self)
    : arguments_(std::move(arguments)),
      range_(range),
      builtin_(arguments_.size() == 1 && is_builtin_scene(arguments_[0])),
      meshes_(range.first) {
  const bool moves = !builtin_ || has_motion(arguments_[0]);
  if (moves) scene_ = load_scene(arguments_, meshes_);
  const std::vector<std::string> paths = meshes_.numbered_paths();
  if (!moves || (!builtin_ && paths.empty())) {
    throw Error("--frames", "nothing in the scene moves",
                "put %d or %04d in place of the number in the name of a mesh, or name one of " +
                    moving_names());
  }
  // All before the first frame is run, not after an hour of frames.
  for (const std::string& path : paths) {
    for (long frame = range.first; frame <= range.last; ++frame) {
      const std::string file = numbered(path, frame);
      std::error_code error;
      if (!std::filesystem::exists(file, error)) {
        throw Error(file, "the file does not exist",
                    fmt::format("give the numbers that there are: --frames FIRST:LAST instead of "
                                "{}:{}",
                                range.first, range.last));
      }
    }
  }
  for (Object& object : scene_.objects) object.self = object.self || self;
  if (builtin_) rest_ = scene_;
}

const Scene& FrameSource::at(long frame) {
  if (builtin_) {
    const long last = std::max(1L, range_.count() - 1);
    const double time = static_cast<double>(frame - range_.first) / static_cast<double>(last);
    scene_.vertices = moved(arguments_[0], rest_, time);
    validate(scene_, scene_.name);
  } else {
    meshes_.set_frame(frame);
    scene_.vertices = load_scene(arguments_, meshes_).vertices;
  }
  return scene_;
}

FrameTimes summary_of(std::vector<double> ms) {
  if (ms.empty()) return {};
  std::sort(ms.begin(), ms.end());
  const std::size_t n = ms.size();
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(n)));
  return {.median = 0.5 * (ms[(n - 1) / 2] + ms[n / 2]), .p95 = ms[rank - 1], .max = ms[n - 1]};
}

FramesResult run_frames(const std::vector<std::string>& arguments, const FramesQuestion& question,
                        const Progress& progress) {
  if (progress) progress("reading the scene");
  FrameSource source(arguments, question.range, question.self);
  Session session(question.options.device);
  FramesResult out;
  RunRecord first;
  std::vector<double> times;
  Json frames = Json::array();
  Table table("rrrrrrr");
  double setup_ms = 0;
  std::uint64_t missed = 0;
  const Scene* scene = nullptr;
  {
    const Interruptible interruptible(question.range.count(), static_cast<bool>(progress));
    for (long frame = question.range.first; frame <= question.range.last; ++frame) {
      const std::string name =
          fmt::format("frame {} of {}", times.size() + 1, question.range.count());
      const Progress named =
          progress ? [&](const std::string& stage) { progress(name + ": " + stage); } : Progress{};
      if (named) named("reading");
      const Stopwatch reading;
      scene = &source.at(frame);
      const double read_ms = reading.ms();
      RunRecord record = run_scene(*scene, question.options, session, named);
      times.push_back(record.ms.cull + record.ms.exact);
      setup_ms += record.ms.setup;
      frames.push_back(frame_json(to_json(*scene, record), frame, read_ms));
      if (frame == question.range.first) {
        table.add({"frame", "candidates", "colliding", has_self(*scene) ? "neighbours" : "",
                   record.verification ? "missed" : "", "cull ms", "exact ms"});
        if (question.pairs) out.pairs_csv = "frame," + pairs_header(*scene);
      }
      if (record.verification) missed += record.verification->false_negatives;
      table.add({std::to_string(frame), grouped(record.candidate_pairs),
                 grouped(record.pairs.size()),
                 has_self(*scene) ? grouped(record.neighbour_pairs.size()) : "",
                 record.verification ? grouped(record.verification->false_negatives) : "",
                 fmt::format("{:.1f}", record.ms.cull), fmt::format("{:.1f}", record.ms.exact)});
      if (question.pairs) out.pairs_csv += pairs_rows(*scene, record, std::to_string(frame) + ",");
      if (out.broken.empty() && broken(record, question.strict)) {
        out.broken =
            fmt::format("frame {}: {} culled pairs that collide: {}", frame,
                        describe(record.options), grouped(record.verification->false_negatives));
      }
      if (frame == question.range.first) first = std::move(record);
      ++frames_done;
    }
  }

  const FrameTimes ms = summary_of(times);
  out.json = to_json(*scene, first);
  for (const char* key : kOfFrame) out.json.erase(key);
  out.json["frames"] = std::move(frames);
  out.json["summary"] = {{"frames", times.size()},
                         {"ms", {{"median", ms.median}, {"p95", ms.p95}, {"max", ms.max}}},
                         {"setup_ms", setup_ms},
                         {"missed", question.options.verify ? Json(missed) : Json(nullptr)}};
  out.table = run_heading(*scene, first) + "\n" + table.text() +
              fmt::format(
                  "\nper frame  median {:.1f} ms, 95% within {:.1f} ms, at most {:.1f} ms (cull + "
                  "exact; setup {:.1f} ms besides)\n",
                  ms.median, ms.p95, ms.max, setup_ms);
  if (!question.options.verify) out.table += "accounted  not at all (--no-verify)\n";
  return out;
}

}  // namespace farcull
