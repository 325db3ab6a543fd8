// Reads the store, makes the chapters, draws them, and writes all files into a folder that appears
// at once.
#include "experiments/report/report.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "commit.h"
#include "core/base/error.h"
#include "experiments/record/output.h"
#include "experiments/report/chapters/chapters.h"
#include "experiments/report/chapters/devices.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/report/figures.h"
#include "experiments/report/gnuplot.h"
#include "experiments/report/latex.h"
#include "experiments/report/legible.h"
#include "experiments/report/markdown.h"
#include "experiments/report/pictures.h"
#include "experiments/report/tables.h"
#include "experiments/studies/run_studies.h"
#include "experiments/system/output_file.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

volatile std::sig_atomic_t signalled = 0;

extern "C" void note_signal(int signal) { signalled = signal; }

// While it lives, signals that would end the program are only noted. The destructor then ends the
// program by them, after the unfinished folder is removed.
class Signals {
 public:
  Signals() {
    signalled = 0;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      ::sigaction(kSignals[i], nullptr, &before_[i]);
      if (before_[i].sa_handler == SIG_IGN) continue;
      struct sigaction action = {};
      action.sa_handler = note_signal;
      ::sigaction(kSignals[i], &action, nullptr);
    }
  }
  ~Signals() {
    for (std::size_t i = 0; i < kSignals.size(); ++i)
      ::sigaction(kSignals[i], &before_[i], nullptr);
    if (signalled != 0) ::raise(signalled);
  }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  static void check() {
    if (signalled != 0) throw Error("report", "was interrupted", "start it again");
  }

 private:
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> before_ = {};
};

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream out;
  out << file.rdbuf();
  return out.str();
}

bool is_report(const std::string& folder) {
  return content_of(folder + "/index.html").find(kPageMark) != std::string::npos;
}

constexpr const char* kMarker = ".unfinished";

// Opens the marker of an unfinished report and locks it. -1: there is none, or the process that
// makes the report still runs. A lock ends with its process, however that ends.
int lock_marker(const std::string& path, int flags) {
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | flags, 0666);
  if (file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  if (file >= 0) ::close(file);
  return -1;
}

// Removes folders that killed reports left beside the place: those named like an UnfinishedFolder
// that hold a marker which nobody has locked, or an earlier report that a new one had just
// replaced.
void remove_leftovers(const std::string& place) {
  const fs::path whole(place);
  const std::string start = whole.filename().string() + ".part-";
  const fs::path folder = whole.has_parent_path() ? whole.parent_path() : ".";
  std::error_code code;
  std::vector<fs::path> found;
  for (fs::directory_iterator next(folder, code), end; !code && next != end; next.increment(code)) {
    const std::string name = next->path().filename().string();
    if (!name.starts_with(start) || name.size() != start.size() + 6) continue;
    if (next->symlink_status(code).type() == fs::file_type::directory)
      found.push_back(next->path());
  }
  for (const fs::path& path : found) {
    const std::string marker = path / kMarker;
    const bool marked = fs::exists(fs::symlink_status(marker, code));
    const int lock = marked ? lock_marker(marker, 0) : -1;
    if (lock >= 0 || (!marked && is_report(path))) fs::remove_all(path, code);
    if (lock >= 0) ::close(lock);
  }
}

// The folder beside the report in which the report is made. It is removed unless publish() puts it
// in place; where the process was killed the next report removes it.
class UnfinishedFolder {
 public:
  explicit UnfinishedFolder(std::string place) : place_(std::move(place)) {
    remove_leftovers(place_);
    path_ = place_ + ".part-XXXXXX";
    const auto refuse = [&] {
      throw Error(place_, std::string("cannot be made: ") + std::strerror(errno),
                  "use a folder with room that you may write to");
    };
    if (::mkdtemp(path_.data()) == nullptr) refuse();
    // The marker gets its name when it is locked, so that no process sees it without its lock.
    const std::string marker = path_ + "/" + kMarker;
    marker_ = lock_marker(marker + "-new", O_CREAT | O_EXCL);
    if (marker_ < 0 || std::rename((marker + "-new").c_str(), marker.c_str()) != 0) {
      const int code = errno;
      remove();
      errno = code;
      refuse();
    }
    // mkdtemp denies access to other users, which a folder of results does not.
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::chmod(path_.c_str(), 0777 & ~mask);
  }
  ~UnfinishedFolder() { remove(); }
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;

  std::string folder(const std::string& name) const {
    const std::string out = path_ + "/" + name;
    std::error_code code;
    if (!fs::create_directory(out, code) && code) {
      throw Error(out, "cannot be made: " + code.message(), "make room on the disk");
    }
    return out;
  }
  const std::string& path() const { return path_; }

  void publish() {
    exchange();
    ::unlink((place_ + "/" + kMarker).c_str());
  }

 private:
  void remove() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    if (marker_ >= 0) ::close(marker_);
  }

  // Exchanges the two folders in one step; the destructor removes the earlier report.
  void exchange() {
    if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, place_.c_str(), RENAME_NOREPLACE) == 0 ||
        (errno == EEXIST &&
         ::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, place_.c_str(), RENAME_EXCHANGE) == 0)) {
      return;
    }
    if (errno == EINVAL || errno == ENOSYS) {  // a file system without it
      std::error_code code;
      fs::remove_all(place_, code);
      if (!code) fs::rename(path_, place_, code);
      if (!code) return;
      errno = code.value();
    }
    throw Error(place_, std::string("cannot be put in place: ") + std::strerror(errno),
                "see who may write to the folder");
  }

  std::string place_, path_;
  int marker_ = -1;
};

// An earlier report may be replaced, nothing else.
void check_place(const std::string& place) {
  std::error_code code;
  const fs::file_status status = fs::symlink_status(place, code);
  if (status.type() == fs::file_type::not_found) return;
  const bool folder = status.type() == fs::file_type::directory;
  if (folder && fs::is_empty(place, code)) return;
  if (folder && is_report(place)) return;
  throw Error(place, "is there and no report of this program", "move it away");
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm utc = {};
  ::gmtime_r(&time, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1,
                     utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

// In the order of studies(), names that this program does not have last.
std::vector<std::string> in_order(std::vector<std::string> names) {
  const auto place = [](const std::string& name) {
    const auto& all = studies();
    return std::find_if(all.begin(), all.end(), [&](const Study& s) { return s.name == name; }) -
           all.begin();
  };
  std::stable_sort(names.begin(), names.end(),
                   [&](const auto& a, const auto& b) { return place(a) < place(b); });
  return names;
}

// The device of the runs that a store holds.
std::string device_of(const Store& store) {
  const auto runs = store.runs();
  return runs.empty() ? "no device" : runs.back().second.gl_renderer;
}

// The stores of further devices beside that of the report.
class OtherDevices {
 public:
  // Those of another commit are left out, which `notes` says.
  OtherDevices(const std::string& folder, const Store& first, std::vector<std::string>& notes) {
    const auto commit = [](const Store& store) {
      const auto runs = store.runs();
      return runs.empty() ? std::string() : runs.back().second.commit;
    };
    for (const std::string& other : device_folders(folder)) {
      Store store(store_path(other), Store::Access::read);
      if (commit(store) == commit(first)) {
        stores_.push_back(std::move(store));
      } else {
        notes.push_back(other + " is of another commit, and is not compared");
      }
    }
  }

  std::vector<DeviceStudy> of(const std::string& study) const {
    std::vector<DeviceStudy> out;
    for (const Store& store : stores_) {
      if (store.declaration(study)) out.push_back({device_of(store), store.study(study)});
    }
    return out;
  }

 private:
  std::vector<Store> stores_;
};

class Reporter {
 public:
  Reporter(const ReportRequest& request, const UnfinishedFolder& unfinished)
      : request_(request),
        root_(unfinished.path()),
        figures_(unfinished.folder("figures")),
        tables_(unfinished.folder("tables")) {}

  void add(StoredStudy stored, const std::string& device, const std::vector<DeviceStudy>& others) {
    DrawnChapter drawn;
    drawn.chapter = chapter_of(stored);
    drawn.chapter.command = command_of(stored, page.runs);
    add_devices(device, stored, others, drawn.chapter);
    put_broken_first(drawn.chapter);
    const std::size_t rows_before = summary_.broken.size();
    const auto add_broken = [&](const StoredStudy& of, const std::string& where) {
      for (const Row& row : of.rows) {
        if (breaks_promise(row.measurement))
          summary_.broken.push_back(drawn.chapter.study + where + ": " + describe(row.point));
      }
    };
    add_broken(stored, "");
    for (const DeviceStudy& other : others) add_broken(other.stored, " on " + other.device);
    // What a chapter finds broken where each row by itself is right, such as energy that a solver
    // made.
    const bool rows_are_right = summary_.broken.size() == rows_before;
    for (const Finding& finding : drawn.chapter.findings) {
      if (rows_are_right && is_broken(finding))
        summary_.broken.push_back(drawn.chapter.study + ": " + finding.text);
    }
    if (!stored.complete()) {
      summary_.notes.push_back(fmt::format("{}: {} of {} points have a row", drawn.chapter.study,
                                           stored.rows.size(), stored.declaration.points.size()));
    }
    for (Figure& figure : drawn.chapter.figures) {
      figure = legible(std::move(figure));
      say("drawing " + figure.name);
      name(figure.name, names_of_figures_);
      draw_figure(figure, figures_);
      drawn.svgs.push_back(content_of(figures_ + "/" + figure.name + ".svg"));
      ++summary_.figures;
    }
    for (const DataTable& table : drawn.chapter.tables) {
      name(table.name, names_of_tables_);
      write_output(tables_ + "/" + table.name + ".csv", table_csv(table));
      write_output(tables_ + "/" + table.name + ".tex", table_latex(table));
      ++summary_.tables;
    }
    write_output(tables_ + "/" + drawn.chapter.study + "-rows.csv", rows_csv(stored));
    for (const TextFile& file : drawn.chapter.files)
      write_output(root_ + "/" + file.name, file.text);
    for (const Picture& picture : drawn.chapter.pictures)
      drawn.pictures.push_back(draw(picture, drawn.chapter));
    put_broken_first(drawn.chapter);
    drawn.stored = std::move(stored);
    page.chapters.push_back(std::move(drawn));
    ++summary_.studies;
  }

  ReportSummary finish() {
    write_output(root_ + "/index.html", page_html(page));
    write_output(root_ + "/results.md", page_markdown(page, request_.folder));
    write_output(root_ + "/report.tex", page_latex(page));
    return std::move(summary_);
  }

  void note(std::vector<std::string> notes) { summary_.notes = std::move(notes); }

  Page page;

 private:
  void say(const std::string& what) const {
    Signals::check();
    if (request_.progress) request_.progress(what);
  }

  static void name(const std::string& name, std::set<std::string>& taken) {
    if (!taken.insert(name).second) throw std::logic_error("two are named " + name);
  }

  // Promises that the picture breaks become findings of the chapter.
  DrawnPicture draw(const Picture& picture, Chapter& chapter) {
    say("picture " + picture.name);
    DrawnPicture out{.picture = picture, .png = {}, .page = false, .left_out = {}};
    const std::string folder = root_ + "/pictures";
    std::error_code ignored;
    fs::create_directory(folder, ignored);
    const std::string path = folder + "/" + picture.name + ".png";
    try {
      if (!request_.draw_picture) throw Error("picture", "no device was asked", "");
      const std::vector<PanelResult> panels = request_.draw_picture(picture.arguments, path);
      out.png = content_of(path);
      for (const Finding& finding : add_counts(out.picture, panels)) {
        chapter.findings.push_back(finding);
        summary_.broken.push_back(printed(finding));
      }
      ++summary_.pictures;
    } catch (const Error& error) {
      Signals::check();
      out.left_out = error.where + " " + error.reason;
      summary_.notes.push_back("picture " + picture.name + " is left out: " + out.left_out);
    }
    if (!out.png.empty()) out.page = make_page(picture);
    return out;
  }

  // Whether the page of the picture's scene is there. A page of a stored depth is never asked for.
  bool make_page(const Picture& picture) {
    if (!request_.make_page || picture.arguments.depth_view) return false;
    say("page " + picture.name);
    const std::string folder = root_ + "/pages";
    std::error_code ignored;
    fs::create_directory(folder, ignored);
    try {
      const std::string path = folder + "/" + picture.name + ".html";
      for (const std::string& broken : request_.make_page(picture.arguments, path)) {
        summary_.broken.push_back(
            fmt::format("in the page of the picture {}, {}", picture.name, broken));
      }
      ++summary_.pages;
      return true;
    } catch (const Error& error) {
      Signals::check();
      summary_.notes.push_back(fmt::format("the page of picture {} is left out: {} {}",
                                           picture.name, error.where, error.reason));
      return false;
    }
  }

  const ReportRequest& request_;
  std::string root_, figures_, tables_;
  std::set<std::string> names_of_figures_, names_of_tables_;
  ReportSummary summary_;
};

}  // namespace

std::string store_of(const std::string& folder) {
  const std::string path = store_path(folder);
  if (fs::exists(path)) return path;
  if (!fs::is_directory(folder)) {
    throw Error(folder, "is no folder of results",
                "measure first, as in farcull experiment all --quick --out " + folder);
  }
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("results-") && name.ends_with(".sqlite")) {
      throw Error(folder, "holds shards that are not merged", "farcull merge " + folder);
    }
  }
  throw Error(folder, "holds no results.sqlite",
              "measure first, as in farcull experiment all --quick --out " + folder);
}

ReportSummary write_report(const ReportRequest& request) {
  const std::string path = store_of(request.folder);
  const Store store(path, Store::Access::read);
  std::vector<StoredStudy> measured;
  for (const std::string& name : in_order(store.studies())) {
    StoredStudy stored = store.study(name);
    if (stored.declaration.of > 1) {
      throw Error(path, "holds a shard of " + name, "farcull merge " + request.folder);
    }
    measured.push_back(std::move(stored));
  }
  if (std::all_of(measured.begin(), measured.end(),
                  [](const StoredStudy& s) { return s.rows.empty(); })) {
    throw Error(path, "holds no row yet", "measure first, as in farcull experiment all --quick");
  }
  const std::string place = request.folder + "/report";
  check_place(place);
  require_gnuplot();

  const Signals signals;
  UnfinishedFolder unfinished(place);
  Reporter reporter(request, unfinished);
  reporter.page.store = path;
  reporter.page.commit = FARCULL_COMMIT;
  reporter.page.written = now();
  reporter.page.runs = store.runs();
  std::vector<std::string> notes;
  const OtherDevices others(request.folder, store, notes);
  reporter.note(std::move(notes));
  for (StoredStudy& stored : measured) {
    const std::vector<DeviceStudy> of = others.of(stored.declaration.study);
    reporter.add(std::move(stored), device_of(store), of);
  }
  ReportSummary summary = reporter.finish();
  Signals::check();
  unfinished.publish();
  summary.folder = place;
  return summary;
}

}  // namespace farcull
