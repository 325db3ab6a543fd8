// The list of studies, the loop over their open points, the shard that this process measures, and
// the sums that it prints.
#include "experiments/studies/run_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <optional>
#include <set>
#include <variant>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/base/text.h"
#include "experiments/measure/harness.h"
#include "experiments/method/method.h"
#include "experiments/record/tables.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

constexpr long kMostShards = 100'000;

bool is_shard(long index, long of) {
  return of >= 1 && of <= kMostShards && index >= 1 && index <= of;
}

// A study with the points to measure.
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

std::string device_text(const Provenance& provenance) {
  const std::string& version = provenance.gl_version;
  return provenance.gl_renderer + (version.empty() ? "" : " (" + version + ")");
}

// Refuses to continue if earlier rows are of another program or machine: a table would show both as
// one.
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
      refuse("the device", device_text(then), device_text(now),
             "go on with that device (--device), or start anew in another folder");
    if (then.cpu_features != now.cpu_features)
      refuse("the processor", then.cpu, now.cpu + ", with other features",
             "go on with such a processor, or start anew in another folder");
  }
}

Task open_task(Store& store, const Study& study, const StudiesRequest& request) {
  Task task{.study = &study, .points = study.grid(request.choice), .open = {}};
  const std::vector<PointKey> keys = keys_of(task.points);
  store.declare({.study = study.name,
                 .choice = request.choice,
                 .shard = request.shard.index,
                 .of = request.shard.of,
                 .points = keys});
  const StoredStudy stored = store.study(study.name);
  if (!stored.rows.empty() && !request.resume) {
    throw Error(store.path(),
                fmt::format("holds {} rows of {} already", stored.rows.size(), study.name),
                "add --resume to go on, or name another folder with --out");
  }
  require_alike(store, stored, request.provenance);
  std::vector<bool> done(task.points.size());
  // A library or mesh that was missing may be available now.
  for (const Row& row : stored.rows) done[row.position] = row.measurement.left_out.empty();
  for (std::size_t i = 0; i < task.points.size(); ++i) {
    if (!done[i] && request.shard.holds(i)) task.open.push_back(i);
  }
  require_one_version({{store.path(), &stored}});
  require_same_versions(store.path(), stored, study, task.points, task.open);
  return task;
}

// Why this machine does not have the scene; empty if it does.
std::string lacking(const PointKey& point) {
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

// Seconds for the remaining points, at the mean time of their study's points in this run, or of the
// points of all studies if their study has none yet.
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

// Measures the open points of all tasks and stores every row at once.
class Runner {
 public:
  Runner(const StudiesRequest& request, StudiesSummary& summary, std::vector<Task>& tasks,
         Store& store, const std::function<void(const StudiesProgress&)>& progress)
      : request_(request), summary_(summary), tasks_(tasks), store_(store), progress_(progress) {
    for (const StudySummary& study : summary.studies) {
      now_.points += study.points;
      now_.done += study.before;
    }
  }

  void run() {
    const std::int64_t run = store_.begin_run(request_.provenance);
    Interruptible interruptible(static_cast<long>(now_.points), "points",
                                "they are kept; the same command with --resume goes on",
                                is_terminal(stderr));
    interruptible.done(static_cast<long>(now_.done));
    for (std::size_t t = 0; t < tasks_.size(); ++t) {
      Task& task = tasks_[t];
      now_.study = task.study->name;
      for (std::size_t i = 0; i < task.open.size(); ++i) {
        const Point& point = task.points[task.open[i]];
        now_.point = describe(point);
        now_.remaining_s = remaining(tasks_, t, i);
        show("");
        const Stopwatch watch;
        const std::optional<Measurement> measurement = measure(*task.study, point);
        if (!measurement) continue;
        store_.add(now_.study, run, task.open[i], *measurement);
        task.seconds += watch.ms() / 1000;
        ++task.measured;
        interruptible.done(static_cast<long>(++now_.done));
      }
    }
  }

 private:
  void show(const std::string& stage) {
    now_.stage = stage;
    if (progress_) progress_(now_);
  }

  // Empty if measuring failed: the failure is noted, and the next point gets a new device.
  std::optional<Measurement> measure(const Study& study, const Point& point) {
    std::string why = lacking(key_of(point));
    if (!why.empty()) return Measurement{.device = "none", .left_out = std::move(why)};
    if (!lab_) {
      lab_.emplace(request_.device, [this](const std::string& stage) { show(stage); });
    }
    std::string failure;
    try {
      return stored(study.measure(point, *lab_));
    } catch (const Error& error) {
      failure = error.what();
    } catch (const std::bad_alloc&) {
      failure = "out of memory";
    }
    summary_.failed.push_back(now_.study + ": " + now_.point + ": " + failure);
    lab_.reset();
    return std::nullopt;
  }

  const StudiesRequest& request_;
  StudiesSummary& summary_;
  std::vector<Task>& tasks_;
  Store& store_;
  const std::function<void(const StudiesProgress&)>& progress_;
  StudiesProgress now_;
  std::optional<Lab> lab_;
};

}  // namespace

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::optional<long> index = parse_number<long>(text.substr(0, slash));
  const std::optional<long> of =
      slash == std::string::npos ? std::nullopt : parse_number<long>(text.substr(slash + 1));
  if (!index || !of || !is_shard(*index, *of)) {
    throw Error("--shard", "'" + text + "' is no shard",
                fmt::format("give K/N with 1 <= K <= N <= {}, such as 2/4", kMostShards));
  }
  return {static_cast<int>(*index), static_cast<int>(*of), "--shard"};
}

Shard shard_from_environment(const std::function<const char*(const char*)>& variable) {
  const char* const remedy = "give --shard K/N, or 1/1 for the whole";
  const auto number = [&](const char* name) -> std::optional<long> {
    const char* const text = variable(name);
    if (text == nullptr) return std::nullopt;
    const std::optional<long> out = parse_number<long>(text);
    if (!out) throw Error(name, fmt::format("'{}' is no number", text), remedy);
    return out;
  };
  const auto made = [&](const char* name, long index, long of) -> Shard {
    if (!is_shard(index, of))
      throw Error(name, fmt::format("makes this part {} of {}, which is none", index, of), remedy);
    return {static_cast<int>(index), static_cast<int>(of), name};
  };

  const std::optional<long> task = number("SLURM_ARRAY_TASK_ID");
  const std::optional<long> rank = number("OMPI_COMM_WORLD_RANK");
  const std::optional<long> size = number("OMPI_COMM_WORLD_SIZE");
  // A single process under mpirun or srun does not divide the work.
  const bool ranks = rank && size && *size != 1;
  if (task && ranks) {
    throw Error("SLURM_ARRAY_TASK_ID", "and OMPI_COMM_WORLD_RANK both say which part this is",
                remedy);
  }
  if (task) {
    const long least = number("SLURM_ARRAY_TASK_MIN").value_or(0);
    const std::optional<long> most = number("SLURM_ARRAY_TASK_MAX");
    const std::optional<long> count = number("SLURM_ARRAY_TASK_COUNT");
    if (!most || !count || *most - least + 1 != *count) {
      throw Error("SLURM_ARRAY_TASK_COUNT", "the array has gaps, or does not say where it ends",
                  "submit it as --array=1-N, or give --shard K/N");
    }
    // A resubmitted part of an array would appear to be the whole.
    if (least != 0 && least != 1) {
      throw Error("SLURM_ARRAY_TASK_MIN", fmt::format("the array begins at {}", least),
                  "submit it as --array=1-N, all of it (what is done is not measured again), or "
                  "give --shard K/N");
    }
    return made("SLURM_ARRAY_TASK_ID", *task - least + 1, *count);
  }
  if (ranks) return made("OMPI_COMM_WORLD_RANK", *rank + 1, *size);
  return {};
}

StudiesSummary run_studies(const StudiesRequest& request,
                           const std::function<void(const StudiesProgress&)>& progress) {
  make_folder(request.folder);
  StudiesSummary summary;
  summary.store = store_path(request.folder, request.shard.index, request.shard.of);
  Store store(summary.store, Store::Access::write);
  std::vector<Task> tasks;
  for (const Study& study : request.studies) {
    tasks.push_back(open_task(store, study, request));
    const Task& task = tasks.back();
    std::size_t mine = 0;
    for (std::size_t i = 0; i < task.points.size(); ++i) mine += request.shard.holds(i);
    summary.studies.push_back(
        {.study = study.name, .points = mine, .before = mine - task.open.size()});
  }
  Runner(request, summary, tasks, store, progress).run();
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    StudySummary& study = summary.studies[t];
    study.measured = tasks[t].measured;
    study.seconds = tasks[t].seconds;
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

const std::vector<Study>& studies() {
  static const std::vector<Study> all = {
      scenes_study(),    accuracy_study(),  error_time_study(), radius_study(), offsets_study(),
      precision_study(), culling_study(),   stability_study(),  cloth_study(),  efficiency_study(),
      scaling_study(),   libraries_study(), proximity_study(),  model_study()};
  return all;
}

std::vector<Study> studies_of_all() {
  std::vector<Study> out = studies();
  std::erase_if(out, [](const Study& study) { return study.campaign; });
  return out;
}

Study on_devices(const Study& study) {
  Study out = study;
  out.grid = [grid = study.grid](const GridChoice& choice) {
    std::vector<Point> points = grid(choice);
    std::erase_if(points, [](const Point& point) {
      if (const auto* run = std::get_if<RunPoint>(&point))
        return !draws(run->method) && !chooses_views(run->method);
      const auto* lemma = std::get_if<LemmaPoint>(&point);
      return lemma == nullptr || lemma->worst;
    });
    return points;
  };
  return out;
}

const Study& study_named(const std::string& name) {
  std::string known;
  for (const Study& study : studies()) {
    if (study.name == name) return study;
    known += (known.empty() ? "" : ", ") + study.name;
  }
  throw Error("experiment", "'" + name + "' is no study", "name one of " + known + ", or all");
}

}  // namespace farcull
