#include "experiments/output.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "commit.h"
#include "core/error.h"
#include "experiments/growing_output.h"
#include "experiments/tables.h"
#include "verify/not_asked.h"
#include "verify/pair_list.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

Json view_json(const ViewReport& view) {
  Json budget = Json::object();
  for (const BudgetTerm& term : view.budget.terms()) budget[term.name] = term.px;
  budget["radius_px"] = view.radius_px;
  return {{"name", view.name},
          {"drawn", view.drawn},
          {"width", view.width},
          {"height", view.height},
          {"pixel_size", view.pixel_size},
          {"depth_step_px", view.depth_step_px},
          {"budget", budget}};
}

Json view_json(const PairView& view) {
  const PairCounts& c = view.counts;
  return {{"name", view.name},
          {"looked", view.looked},
          {"reason", view.reason},
          {"width", view.width},
          {"height", view.height},
          {"pixel_size", view.pixel_size},
          {"widening_px", view.widening_px},
          {"listed", c.listed},
          {"entries", c.entries},
          {"crowded", c.crowded},
          {"large", c.large},
          {"tests", c.tests},
          {"bands", c.bands},
          {"undrawable", c.undrawable}};
}

Json budget_json(const std::vector<ViewReport>& views) {
  const ViewReport* widest = widest_budget(views);
  return widest ? view_json(*widest)["budget"] : Json(nullptr);
}

Json device_json(const RunRecord& record) {
  if (record.on_cpu) return {{"cpu", record.device_note}};
  if (!record.device) return {{"none", record.device_note}};
  const GlInfo& device = *record.device;
  Json out = {{"vendor", device.vendor},
              {"renderer", device.renderer},
              {"version", device.version},
              {"glsl", device.glsl},
              {"subpixel_bits", device.subpixel_bits},
              {"depth_bits", record.depth_bits},
              {"reset_detection", device.reset_detection}};
  if (record.options.method == Method::far_pairs) {
    out.erase("depth_bits");
    out["reason"] = record.device_note;
  }
  return out;
}

Json environment_json(const FloatingPoint& floating_point) {
  return {{"rounding", to_string(floating_point.rounding)},
          {"flushes_results", floating_point.flushes_results},
          {"flushes_operands", floating_point.flushes_operands}};
}

Json verdict_json(const RunRecord& record) {
  if (!record.verdict) return nullptr;
  const DeviceVerdict& v = *record.verdict;
  const auto or_null = [](const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
  };
  return {{"holds", v.holds},           {"probes", v.probes},
          {"failed", v.failed},         {"made", v.made},
          {"remembered", v.remembered}, {"ms", v.ms},
          {"file", or_null(v.file)},    {"problem", or_null(v.problem)},
          {"note", or_null(v.note)}};
}

std::uint64_t self_objects(const Scene& scene) {
  return static_cast<std::uint64_t>(
      std::count_if(scene.objects.begin(), scene.objects.end(),
                    [](const Object& object) { return object.self; }));
}

// A triangle as a person finds it again: its object, its place there and the face of the file it
// came from.
Json place_json(const Scene& scene, const std::vector<std::uint32_t>& owner,
                std::uint32_t triangle) {
  const Object& object = scene.objects[owner[triangle]];
  return {{"object", owner[triangle]},
          {"name", object.name},
          {"triangle", triangle - object.first_triangle},
          {"face", scene.source_face[triangle]}};
}

Json verification_json(const Scene& scene, const RunRecord& record) {
  const std::optional<Accounting>& accounting = record.verification;
  if (!accounting) return nullptr;
  const std::vector<std::uint32_t> owner = owners(scene);
  Json examples = Json::array();
  for (const TrianglePair& pair : accounting->examples) {
    examples.push_back(
        {{"a", place_json(scene, owner, pair.a)}, {"b", place_json(scene, owner, pair.b)}});
  }
  return {{"pairs_total", accounting->pairs_total},
          {"pairs_kept", accounting->pairs_kept},
          {"certified_by_boxes", accounting->certified_by_boxes},
          {"certified_by_predicates", accounting->certified_by_predicates},
          {"neighbours", accounting->neighbours},
          {"false_negatives", accounting->false_negatives},
          {"touching", record.missed ? Json(record.missed->touching) : Json(nullptr)},
          {"penetrating", record.missed ? Json(record.missed->penetrating) : Json(nullptr)},
          {"examples", examples},
          {"ms", accounting->ms}};
}

constexpr const char* kStdoutRemedy = "let it go somewhere, or write to a file with --json FILE";
constexpr const char* kPathRemedy = "give a path in a folder with room that you may write to";

[[noreturn]] void refuse(const std::string& path, int code) {
  const bool standard = path == "-";
  throw Error(standard ? "standard output" : path,
              std::string("cannot be written: ") + std::strerror(code),
              standard ? kStdoutRemedy : kPathRemedy);
}

// Where a path leads. Only a regular file, or none yet, can be put in place by renaming; anything
// else takes the text as it comes.
struct Target {
  std::string path;
  bool exists = false;
  bool direct = false;
  mode_t mode = 0;  // of what exists
};

Target target_of(const std::string& path) {
  Target target{.path = path};
  struct stat link = {}, status = {};
  target.exists = ::stat(path.c_str(), &status) == 0;
  const bool is_link = ::lstat(path.c_str(), &link) == 0 && S_ISLNK(link.st_mode);
  // /dev/stdout is a link to whatever that is, perhaps a file that another program holds open.
  const bool kernels = path.starts_with("/dev/") || path.starts_with("/proc/");
  target.mode = status.st_mode;
  target.direct = (target.exists && !S_ISREG(status.st_mode)) || (is_link && kernels);
  if (is_link && target.exists && !target.direct)
    target.path = std::filesystem::canonical(path).string();
  return target;
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

// A file that is being written, taken away again unless it is put in place: by the destructor, or
// by the handler where a signal ends the program. One at a time.
char half_written[4096] = "";

extern "C" void take_away(int signal) {
  ::unlink(half_written);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

class HalfWritten {
 public:
  explicit HalfWritten(const std::string& path) : path_(path) {
    if (path.size() >= sizeof half_written) refuse(path, ENAMETOOLONG);
    path.copy(half_written, path.size());
    half_written[path.size()] = '\0';
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], nullptr, &before_[i]);
      // A signal that the caller had us ignore (nohup) stays ignored.
      if (before_[i].sa_handler == SIG_IGN) continue;
      struct sigaction action = {};
      action.sa_handler = take_away;
      ::sigaction(kSignals[i], &action, nullptr);
    }
  }
  ~HalfWritten() {
    if (!in_place_) ::unlink(path_.c_str());
    for (std::size_t i = 0; i < kSignals.size(); ++i)
      ::sigaction(kSignals[i], &before_[i], nullptr);
    half_written[0] = '\0';
  }
  HalfWritten(const HalfWritten&) = delete;
  HalfWritten& operator=(const HalfWritten&) = delete;

  bool put(const std::string& place) {
    in_place_ = std::rename(path_.c_str(), place.c_str()) == 0;
    return in_place_;
  }

 private:
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::string path_;
  bool in_place_ = false;
  std::array<struct sigaction, 3> before_ = {};
};

// Writes all of the text and closes the file; 0 or the errno of the first failure.
int write_and_close(std::FILE* file, const std::string& text, bool to_disk) {
  int failure = 0;
  if (std::fwrite(text.data(), 1, text.size(), file) != text.size() || std::fflush(file) != 0 ||
      (to_disk && ::fsync(::fileno(file)) != 0)) {
    failure = errno;
  }
  if (std::fclose(file) != 0 && failure == 0) failure = errno;
  return failure;
}

// Writes all of the text, at a place of a file where `at` is not negative; 0 or the errno of the
// first failure.
int write_all(int file, const std::string& text, long long at) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = at < 0 ? ::write(file, text.data() + done, text.size() - done)
                             : ::pwrite(file, text.data() + done, text.size() - done,
                                        at + static_cast<long long>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n < 0 ? errno : EIO;
    done += static_cast<std::size_t>(n);
  }
  return 0;
}

}  // namespace

nlohmann::ordered_json floating_point_json(const FloatingPoint& callers,
                                           const FloatingPoint& used) {
  return {{"callers", environment_json(callers)}, {"used", environment_json(used)}};
}

Json not_asked_json(const Scene& scene) {
  const NotAsked unasked = not_asked(scene);
  return {{"objects", unasked.objects}, {"pairs", unasked.pairs}, {"which", unasked.ranges}};
}

nlohmann::ordered_json to_json(const Scene& scene, const RunRecord& record) {
  const RunOptions& o = record.options;
  const bool drawn = draws(o.method);
  const bool pairs = o.method == Method::far_pairs;
  Json resolution = nullptr;
  if (drawn || pairs) resolution = resolution_of(o) > 0 ? Json(resolution_of(o)) : Json("auto");
  Json views = Json::array();
  for (const ViewReport& view : record.views) views.push_back(view_json(view));
  for (const PairView& view : record.pair_views) views.push_back(view_json(view));
  Json stages = Json::array();
  for (const Stage& s : record.stages) {
    stages.push_back({{"name", s.name},
                      {"ran", s.ran},
                      {"reason", s.reason},
                      {"ms", s.ms},
                      {"in", s.in},
                      {"out", s.out},
                      {"unit", s.unit},
                      {"draws", s.draws},
                      {"queries", s.queries},
                      {"draws_saved", s.draws_saved},
                      {"queries_saved", s.queries_saved}});
  }
  return {{"scene",
           {{"name", scene.name},
            {"objects", scene.objects.size()},
            {"self_objects", self_objects(scene)},
            {"self_not_asked", not_asked_json(scene)},
            {"triangles", scene.triangles.size()},
            {"degenerate_triangles", record.degenerate_triangles},
            {"hash", record.scene_hash}}},
          {"method", to_string(o.method)},
          {"resolution", resolution},
          {"radius", o.method == Method::far ? Json(radius_text(o.radius)) : Json(nullptr)},
          {"offset", o.method == Method::far ? Json(o.offset) : Json(nullptr)},
          {"depth", !drawn ? Json(nullptr)
                           : Json(depth_of(o) == DepthMode::fragment ? "fragment" : "fixed")},
          {"depth_format",
           drawn ? Json(o.depth_format == DepthFormat::float32 ? "32f" : "24") : Json(nullptr)},
          {"query",
           drawn ? Json(query_of(o) == QueryMode::flags ? "flags" : "occlusion") : Json(nullptr)},
          {"clearance", takes_clearance(o.method) ? Json(o.clearance) : Json(nullptr)},
          {"full", o.full},
          {"promises", record.promises},
          {"promise_reason", record.promise_reason},
          {"verdict", verdict_json(record)},
          {"views", views},
          {"budget", budget_json(record.views)},
          {"device", device_json(record)},
          {"floating_point", floating_point_json(record.callers, record.used)},
          {"stages", stages},
          {"pcs", {{"objects", record.pcs_objects}, {"triangles", record.pcs_triangles}}},
          {"object_triangles",
           o.method == Method::i_collide ? Json(record.object_triangles) : Json(nullptr)},
          {"candidate_pairs", record.candidate_pairs},
          {"colliding_pairs", record.pairs.size()},
          {"neighbour_pairs", record.neighbour_pairs.size()},
          {"neighbours", record.neighbours},
          {"verification", verification_json(scene, record)},
          {"time_ms",
           {{"setup", record.ms.setup},
            {"cull", record.ms.cull},
            {"exact", record.ms.exact},
            {"total", record.ms.total}}},
          {"seed", o.seed ? Json(*o.seed) : Json(nullptr)},
          {"commit", FARCULL_COMMIT}};
}

std::string pairs_header(const Scene& scene) { return pair_list_header(scene); }

std::string pairs_rows(const Scene& scene, const RunRecord& record, const std::string& before) {
  const PairListRows rows(scene);
  std::string out;
  const auto add = [&](const TrianglePair& pair) {
    out += before;
    rows.append(pair, out);
  };
  auto next = record.neighbour_pairs.begin();
  for (const TrianglePair& p : record.pairs) {
    for (; next != record.neighbour_pairs.end() && *next < p; ++next) add(*next);
    add(p);
  }
  for (; next != record.neighbour_pairs.end(); ++next) add(*next);
  return out;
}

std::string pairs_csv(const Scene& scene, const RunRecord& record) {
  return pairs_header(scene) + pairs_rows(scene, record, "");
}

void check_output(const std::string& path) {
  if (path == "-") {
    const int flags = ::fcntl(STDOUT_FILENO, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) refuse(path, EBADF);
    return;
  }
  const Target target = target_of(path);
  if (S_ISDIR(target.mode)) refuse(path, EISDIR);
  if (target.exists && ::access(target.path.c_str(), W_OK) != 0) refuse(path, errno);
  if (!target.direct && ::access((folder_of(target.path) + "/").c_str(), W_OK | X_OK) != 0)
    refuse(path, errno);
}

void write_output(const std::string& path, const std::string& text) {
  check_output(path);
  if (path == "-") {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
      refuse(path, errno);
    return;
  }
  const Target target = target_of(path);
  if (target.direct) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) refuse(path, errno);
    if (const int failure = write_and_close(file, text, false)) refuse(path, failure);
    return;
  }
  const std::string beside = target.path + ".part-" + std::to_string(::getpid());
  HalfWritten part(beside);
  std::FILE* file = std::fopen(beside.c_str(), "wb");
  if (file == nullptr) refuse(path, errno);
  if (target.exists) ::fchmod(::fileno(file), target.mode & 07777);
  if (const int failure = write_and_close(file, text, true)) refuse(path, failure);
  if (!part.put(target.path)) refuse(path, errno);
}

GrowingOutput::~GrowingOutput() {
  try {
    finish();
  } catch (const Error&) {
    // Another error is on its way, and the text is whole without the end's last state.
  }
  if (file_ >= 0) ::close(file_);
}

void GrowingOutput::add(const std::string& text, const std::string& end) {
  if (!begun_) {
    check_output(path_);
    streamed_ = path_ == "-" || target_of(path_).direct;
    if (!streamed_) write_output(path_, text + end);
    if (path_ != "-") {
      file_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
      if (file_ < 0) refuse(path_, errno);
    }
    begun_ = true;
    if (!streamed_) {
      kept_ = static_cast<long long>(text.size());
      end_ = end;
      return;
    }
  }
  if (streamed_) {
    end_ = end;
    if (path_ == "-") {
      write_output(path_, text);
    } else if (const int failure = write_all(file_, text, -1)) {
      refuse(path_, failure);
    }
    return;
  }
  if (const int failure = write_all(file_, text + end, kept_)) {
    // The bytes of the end before are the file's own already, so a full disk takes them.
    (void)write_all(file_, end_, kept_);
    (void)!::ftruncate(file_, kept_ + static_cast<long long>(end_.size()));
    refuse(path_, failure);
  }
  kept_ += static_cast<long long>(text.size());
  end_ = end;
  if (::ftruncate(file_, kept_ + static_cast<long long>(end_.size())) != 0) refuse(path_, errno);
}

void GrowingOutput::finish() {
  if (!begun_ || std::exchange(finished_, true)) return;
  if (!streamed_) {
    if (::fsync(file_) != 0) refuse(path_, errno);
  } else if (path_ == "-") {
    write_output(path_, end_);
  } else if (const int failure = write_all(file_, end_, -1)) {
    refuse(path_, failure);
  }
}

void prepare_output() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  // The next file that is opened would get the number of a closed stream, and with it the table.
  // What stands in its place refuses instead.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) < 0)
      (void)!::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace farcull
