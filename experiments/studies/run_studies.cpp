#include "experiments/studies/run_studies.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <set>

#include "core/error.h"
#include "core/stopwatch.h"
#include "experiments/builtin_scenes.h"
#include "experiments/interrupt.h"
#include "experiments/studies/lab.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

// What of one study is to be done.
struct Task {
  const Study* study;
  std::vector<Point> points;
  std::vector<std::size_t> open;  // positions
  double seconds = 0;             // of the points measured in this run
  std::size_t measured = 0;
};

void make_folder(const std::string& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code || !std::filesystem::is_directory(folder)) {
    throw Error(folder, "is no folder and cannot be made: " + code.message(),
                "name another one with --out");
  }
}

// Rows of different programs or machines would stand in one table as if they were of one.
void require_alike(const Store& store, const StoredStudy& stored, const Provenance& now) {
  std::set<std::int64_t> used;
  for (const Row& row : stored.rows) used.insert(row.run);
  const auto refuse = [&](const char* what, const std::string& then, const std::string& is,
                          const char* remedy) {
    throw Error(store.path(),
                fmt::format("its rows of {} are of {} {}, and this is {}", stored.declaration.study,
                            what, then, is),
                remedy);
  };
  for (const auto& [run, then] : store.runs()) {
    if (!used.contains(run)) continue;
    if (then.commit != now.commit)
      refuse("commit", then.commit, now.commit,
             "go on with that commit, or start anew in another folder");
    if (then.gl_renderer != now.gl_renderer || then.gl_version != now.gl_version)
      refuse("the device", then.gl_renderer + " (" + then.gl_version + ")",
             now.gl_renderer + " (" + now.gl_version + ")",
             "go on with that device (--device), or start anew in another folder");
    if (then.cpu_features != now.cpu_features)
      refuse("the processor", then.cpu, now.cpu + ", with other features",
             "go on with such a processor, or start anew in another folder");
  }
}

Task open_task(Store& store, const Study& study, const StudiesRequest& request) {
  Task task{.study = &study, .points = study.grid(request.choice), .open = {}};
  store.declare({.study = study.name,
                 .choice = request.choice,
                 .shard = request.shard.index,
                 .of = request.shard.of,
                 .points = task.points});
  const StoredStudy stored = store.study(study.name);
  if (!stored.rows.empty() && !request.resume) {
    throw Error(store.path(),
                fmt::format("holds {} rows of {} already", stored.rows.size(), study.name),
                "add --resume to go on, or name another folder with --out");
  }
  require_alike(store, stored, request.provenance);
  std::vector<bool> done(task.points.size());
  // What could not be had then may be there now.
  for (const Row& row : stored.rows) done[row.position] = row.measurement.left_out.empty();
  for (std::size_t i = 0; i < task.points.size(); ++i) {
    if (!done[i] && request.shard.holds(i)) task.open.push_back(i);
  }
  return task;
}

// Why a scene cannot be had on this machine; empty: it can.
std::string lacking(const Point& point) {
  const std::string base = point.scene.substr(0, point.scene.find_first_of(":@"));
  const std::vector<BuiltinScene>& known = builtin_scenes();
  const auto entry = std::find_if(known.begin(), known.end(),
                                  [&](const BuiltinScene& scene) { return scene.name == base; });
  if (entry == known.end() || !entry->needs_meshes) return "";
  const std::string folder = mesh_folder();
  std::error_code code;
  if (std::filesystem::is_directory(folder, code) && !std::filesystem::is_empty(folder, code) &&
      !code)
    return "";
  return "the packaged meshes are not in " + folder + "; bash experiments/meshes.sh fetches them";
}

// As the points of the study took in this run, or those of all studies where it has none yet.
std::optional<double> remaining(const std::vector<Task>& tasks, std::size_t at, std::size_t next) {
  double seconds = 0;
  std::size_t measured = 0;
  for (const Task& task : tasks) {
    seconds += task.seconds;
    measured += task.measured;
  }
  if (measured == 0) return std::nullopt;
  double out = 0;
  for (std::size_t t = at; t < tasks.size(); ++t) {
    const Task& task = tasks[t];
    const std::size_t left = task.open.size() - (t == at ? next : 0);
    out += static_cast<double>(left) * (task.measured > 0
                                            ? task.seconds / static_cast<double>(task.measured)
                                            : seconds / static_cast<double>(measured));
  }
  return out;
}

Measurement measure(const Study& study, const Point& point, Lab& lab) {
  std::string why = lacking(point);
  if (!why.empty()) return {.device = "none", .left_out = std::move(why)};
  return study.measure(point, lab);
}

}  // namespace

bool breaks_promise(const Measurement& measurement) {
  const auto& counts = measurement.counts;
  if (!counts.value("promises", false)) return false;
  return counts.value("missed", std::uint64_t{0}) > 0 ||
         counts.value("violations", std::uint64_t{0}) > 0;
}

StudiesSummary run_studies(const StudiesRequest& request,
                           const std::function<void(const StudiesProgress&)>& progress) {
  make_folder(request.folder);
  StudiesSummary summary;
  summary.store = store_path(request.folder, request.shard.index, request.shard.of);
  Store store(summary.store, Store::Access::write);

  std::vector<Task> tasks;
  StudiesProgress now;
  for (const Study& study : request.studies) {
    tasks.push_back(open_task(store, study, request));
    const Task& task = tasks.back();
    std::size_t mine = 0;
    for (std::size_t i = 0; i < task.points.size(); ++i) mine += request.shard.holds(i);
    summary.studies.push_back(
        {.study = study.name, .points = mine, .before = mine - task.open.size()});
    now.points += mine;
    now.done += mine - task.open.size();
  }

  const std::int64_t run = store.begin_run(request.provenance);
  Interruptible interruptible(static_cast<long>(now.points), "points",
                              "they are kept; the same command with --resume goes on",
                              ::isatty(STDERR_FILENO));
  interruptible.done(static_cast<long>(now.done));
  const auto show = [&](const std::string& stage) {
    now.stage = stage;
    if (progress) progress(now);
  };
  std::optional<Lab> lab;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    Task& task = tasks[t];
    now.study = task.study->name;
    for (std::size_t i = 0; i < task.open.size(); ++i) {
      const Point& point = task.points[task.open[i]];
      now.point = describe(point);
      now.remaining_s = remaining(tasks, t, i);
      show("");
      const Stopwatch watch;
      if (!lab) lab.emplace(request.device, show);
      std::optional<Measurement> measurement;
      try {
        measurement = measure(*task.study, point, *lab);
      } catch (const Error& error) {
        summary.failed.push_back(now.study + ": " + now.point + ": " + error.what());
      } catch (const std::bad_alloc&) {
        summary.failed.push_back(now.study + ": " + now.point + ": out of memory");
      }
      if (!measurement) {
        lab.reset();
        continue;
      }
      store.add(now.study, run, task.open[i], *measurement);
      task.seconds += watch.ms() / 1000;
      ++task.measured;
      interruptible.done(static_cast<long>(++now.done));
    }
    summary.studies[t].measured = task.measured;
    summary.studies[t].seconds = task.seconds;
  }
  for (StudySummary& study : summary.studies) {
    for (const Row& row : store.study(study.study).rows) {
      study.left_out += !row.measurement.left_out.empty();
      if (breaks_promise(row.measurement))
        summary.broken.push_back(study.study + ": " + describe(row.point));
    }
  }
  return summary;
}

std::string summary_table(const StudiesSummary& summary) {
  Table table("lrrrrr");
  table.add({"study", "points", "before", "measured", "left out", "seconds"});
  for (const StudySummary& s : summary.studies) {
    table.add({s.study, grouped(s.points), grouped(s.before), grouped(s.measured),
               grouped(s.left_out), fmt::format("{:.1f}", s.seconds)});
  }
  return table.text() + "\nresults: " + summary.store + "\n";
}

}  // namespace farcull
