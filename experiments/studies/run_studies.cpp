// Measures the points that the store lacks, in rounds. Formats the summary and lists all studies.
#include "experiments/studies/run_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <new>
#include <set>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "experiments/record/stage_words.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/studies/run_point.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

// A study with the points to measure.
struct Task {
  const Study* study = nullptr;
  std::vector<Point> points;
  std::vector<PointKey> keys;
  std::vector<std::size_t> open;            // positions of the points to measure
  std::map<std::size_t, Measurement> rows;  // the present rows of open points
  double seconds = 0;                       // time that this run spent on the task
  std::size_t measured = 0;                 // points finished in this run
  std::size_t visits = 0, visits_left = 0;  // visit: an untimed point or one round of a timed point
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

bool is_alike(const Provenance& a, const Provenance& b) {
  return a.commit == b.commit && device_text(a) == device_text(b) &&
         a.cpu_features == b.cpu_features;
}

// Throws Error if earlier rows are of another program or machine, since a table would mix them with
// new rows.
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

using Json = nlohmann::ordered_json;

// Drops the void rounds, so that they are measured again.
void drop_void_rounds(Json& times) {
  Json kept = Json::array();
  for (const Json& round : times["rounds"]) {
    if (!round["void"].get<bool>()) kept.push_back(round);
  }
  times["rounds"] = std::move(kept);
}

Task open_task(Store& store, const Study& study, const StudiesRequest& request) {
  Task task;
  task.study = &study;
  task.points = study.grid(request.choice);
  task.keys = keys_of(task.points);
  store.declare({.study = study.name,
                 .choice = request.choice,
                 .shard = request.shard.index,
                 .of = request.shard.of,
                 .points = task.keys});
  const StoredStudy stored = store.study(study.name);
  if (!stored.rows.empty() && !request.resume) {
    throw Error(store.path(),
                fmt::format("holds {} rows of {} already", stored.rows.size(), study.name),
                "add --resume to go on, or name another folder with --out");
  }
  require_alike(store, stored, request.provenance);
  std::vector<bool> done(task.points.size());
  for (const Row& row : stored.rows) {
    // A library or mesh that was missing may be available now.
    if (!row.measurement.left_out.empty()) continue;
    Measurement known = row.measurement;
    if (request.times && rounds_in(known)) {
      drop_void_rounds(known.times);
      done[row.position] = rounds_in(known) >= kRounds;
    } else {
      done[row.position] = is_whole(known);
    }
    if (!done[row.position]) task.rows.emplace(row.position, std::move(known));
  }
  for (std::size_t i = 0; i < task.points.size(); ++i) {
    if (!done[i] && request.shard.holds(i)) task.open.push_back(i);
  }
  require_one_version({{store.path(), &stored}});
  require_same_versions(store.path(), stored, study, task.points, task.open);
  return task;
}

// Returns why this machine does not have the scene, or "" if the machine has it.
std::string lacking(const PointKey& point) {
  const std::string base = point.scene.substr(0, point.scene.find_first_of(":@"));
  const auto entry = std::ranges::find(builtin_scenes(), base, &BuiltinScene::name);
  if (entry == builtin_scenes().end() || !entry->needs_meshes) return "";
  const std::string folder = mesh_folder();
  std::error_code code;
  if (std::filesystem::is_directory(folder, code) && !std::filesystem::is_empty(folder, code) &&
      !code)
    return "";
  return "the packaged meshes are not in " + folder + "; bash experiments/meshes.sh fetches them";
}

// Estimates the seconds that are left. A visit (Task::visits) is assumed to take the mean time of
// this run's visits to the same study. If that study had no visit yet, the mean is over the visits
// to all studies.
std::optional<double> remaining(const std::vector<Task>& tasks) {
  double seconds = 0;
  std::size_t visits = 0;
  for (const Task& task : tasks) {
    seconds += task.seconds;
    visits += task.visits;
  }
  if (visits == 0) return std::nullopt;
  double out = 0;
  for (const Task& task : tasks) {
    out += static_cast<double>(task.visits_left) *
           (task.visits > 0 ? task.seconds / static_cast<double>(task.visits)
                            : seconds / static_cast<double>(visits));
  }
  return out;
}

// Adds a round to the times, and recomputes the total over all rounds that are not void.
void add_round(Json& times, const std::vector<double>& ms, const std::optional<Load>& load,
               bool is_void) {
  Json rounds = times.value("rounds", Json::array());
  rounds.push_back({{"ms", ms}, {"load", load ? Json(load->share) : Json()}, {"void", is_void}});
  std::vector<double> all;
  for (const Json& round : rounds) {
    if (round["void"].get<bool>()) continue;
    for (const double one : round["ms"]) all.push_back(one);
  }
  times = Json::object();
  if (!all.empty()) times["total"] = middle(std::move(all));
  times["rounds"] = std::move(rounds);
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
    for (Task& task : tasks) {
      for (const std::size_t at : task.open) task.visits_left += visits_left(task, at);
    }
    find_known();
  }

  void run() {
    run_ = store_.begin_run(request_.provenance);
    Interruptible interruptible(static_cast<long>(now_.points), "points",
                                "they are kept; the same command with --resume goes on",
                                is_terminal(stderr));
    interruptible_ = &interruptible;
    interruptible.done(static_cast<long>(now_.done));
    if (request_.times) time_points(0);
    for (Task& task : tasks_) {
      for (const std::size_t at : task.open) {
        if (!request_.times || !is_timed(task.points[at])) count_point(task, at);
      }
    }
    for (int round = 1; request_.times && round < kRounds; ++round) time_points(round);
  }

 private:
  struct At {
    Task* task;
    std::size_t position;

    const Point& point() const { return task->points[position]; }
    const PointKey& key() const { return task->keys[position]; }
  };
  // The results of the runs of a point in one round.
  struct Runs {
    At at;
    std::optional<PointResult> first = {};  // the first result; empty: no run has finished
    std::vector<double> ms = {};
    bool failed = false;
  };

  int rounds_of(const Task& task, std::size_t position) const {
    const auto row = task.rows.find(position);
    return row == task.rows.end() ? 0 : rounds_in(row->second).value_or(0);
  }
  std::size_t visits_left(const Task& task, std::size_t position) const {
    if (!request_.times || !is_timed(task.points[position])) return 1;
    return static_cast<std::size_t>(kRounds - rounds_of(task, position));
  }
  bool is_due(const Task& task, std::size_t position, int round) const {
    return !closed_.contains({&task, position}) && rounds_of(task, position) <= round;
  }

  // Collects the results in the store that other studies can use for the same points.
  void find_known() {
    std::set<std::int64_t> alike;
    for (const auto& [run, then] : store_.runs()) {
      if (is_alike(then, request_.provenance)) alike.insert(run);
    }
    for (const std::string& name : store_.studies()) {
      const auto task =
          std::ranges::find(tasks_, name, [](const Task& t) { return t.study->name; });
      for (Row& row : store_.study(name).rows) {
        if (!alike.contains(row.run)) continue;
        if (rounds_in(row.measurement)) drop_void_rounds(row.measurement.times);
        know(row.point, row.measurement, task != tasks_.end() && task->study->plain);
      }
    }
  }
  // Keeps a row for other studies. Ignores rows of frames of a motion, since these rows may depend
  // on earlier frames.
  void know(const PointKey& key, const Measurement& row, bool plain) {
    if (key.frame >= 0 || !row.left_out.empty()) return;
    if (rounds_in(row).value_or(0) > 0) {
      Measurement& times = timed_[key];
      if (rounds_in(times).value_or(0) < *rounds_in(row)) times.times = row.times;
    }
    if (plain) {
      counted_.try_emplace(key, Measurement{.counts = row.counts, .device = row.device});
    }
  }
  // Returns the counts of the point in another study that is `plain`, or null.
  const Measurement* counted(const At& at) const {
    if (!at.task->study->plain || !std::holds_alternative<RunPoint>(at.point())) return nullptr;
    const auto known = counted_.find(at.key());
    return known == counted_.end() ? nullptr : &known->second;
  }

  // Measures one round of all timed points. The points of one scene are measured together.
  void time_points(int round) {
    for (Task& task : tasks_) {
      std::vector<At> block;
      const auto finish = [&] {
        if (!block.empty()) time_block(block, round);
        block.clear();
      };
      for (const std::size_t at : task.open) {
        if (!is_timed(task.points[at]) || !is_due(task, at, round)) continue;
        const PointKey& key = task.keys[at];
        if (!block.empty() &&
            (block.front().key().scene != key.scene || block.front().key().frame != key.frame))
          finish();
        const auto known = timed_.find(key);
        if (known != timed_.end() && *rounds_in(known->second) > rounds_of(task, at)) {
          take_times({&task, at}, known->second);
        } else {
          block.push_back({&task, at});
        }
      }
      finish();
    }
  }

  // Returns the point's row if the point has a row. Otherwise returns a row with the counts of the
  // point in another study, or measures the counts now. Returns nothing if measuring fails.
  std::optional<Measurement> row_without_times(const At& at) {
    if (const auto own = at.task->rows.find(at.position); own != at.task->rows.end())
      return own->second;
    if (const Measurement* counts = counted(at)) return *counts;
    show(at, "");
    const std::optional<PointResult> result = measure(at);
    return result ? std::optional(stored(*result)) : std::nullopt;
  }

  void take_times(const At& at, const Measurement& known) {
    const Stopwatch watch;
    const std::size_t before = visits_left(*at.task, at.position);
    std::optional<Measurement> row = row_without_times(at);
    if (row && row->left_out.empty()) row->times = known.times;
    if (row) put(at, std::move(*row));
    passed(*at.task, watch, before - (row ? visits_left(*at.task, at.position) : 0));
  }

  // Measures one round of a scene's points. The runs of the points take turns. Repeats the round if
  // the machine was busy.
  void time_block(const std::vector<At>& block, int round) {
    constexpr int kTries = 3;
    const Stopwatch watch;
    const int turns = std::max(1, runs_of(block.front().point()) / kRounds);
    std::vector<Runs> runs;
    std::optional<Load> load;
    bool is_void = true;
    for (int tried = 0; is_void && tried < kTries; ++tried) {
      runs.clear();
      for (const At& at : block) runs.push_back({.at = at});
      const LoadMeter meter;
      measure_in_turns(runs.size(), {.counted = turns}, [&](std::size_t i, int) {
        if (is_due(*runs[i].at.task, runs[i].at.position, round)) run_once(runs[i], round);
        return 0.0;
      });
      load = meter.now();
      is_void = load && load->beyond(request_.most_load);
    }
    for (Runs& of : runs) {
      if (of.failed || !of.first) continue;
      Measurement row = stored(*of.first);
      if (row.left_out.empty()) {
        row.times = Json::object();
        if (const auto own = of.at.task->rows.find(of.at.position); own != of.at.task->rows.end())
          row.times = own->second.times;
        add_round(row.times, of.ms, load, is_void);
      }
      put(of.at, std::move(row));
    }
    passed(*block.front().task, watch, block.size());
  }

  void run_once(Runs& runs, int round) {
    if (runs.failed || (runs.first && !runs.first->left_out.empty())) return;
    show(runs.at, fmt::format("round {} of {}", round + 1, kRounds));
    std::optional<PointResult> result = measure(runs.at);
    runs.failed = !result.has_value();
    if (runs.failed) return;
    if (result->times.total) runs.ms.push_back(*result->times.total);
    if (!runs.first) runs.first = std::move(result);
  }

  void count_point(Task& task, std::size_t position) {
    const At at{&task, position};
    const Stopwatch watch;
    std::optional<Measurement> row = row_without_times(at);
    if (row && row->left_out.empty() && is_timed(at.point())) {
      Json rounds = row->times.value("rounds", Json::array());
      row->times = Json{{"rounds", std::move(rounds)}, {"no_times", true}};
    }
    if (row) put(at, std::move(*row));
    passed(task, watch, 1);
  }

  void put(const At& at, Measurement row) {
    Task& task = *at.task;
    store_.add(task.study->name, run_, at.position, row);
    know(at.key(), row, task.study->plain);
    const bool whole = is_whole(row) || !row.left_out.empty();
    task.rows.insert_or_assign(at.position, std::move(row));
    if (!whole) return;
    closed_.insert({&task, at.position});
    ++task.measured;
    interruptible_->done(static_cast<long>(++now_.done));
  }

  void passed(Task& task, const Stopwatch& watch, std::size_t visits) {
    task.seconds += watch.ms() / 1000;
    task.visits += visits;
    task.visits_left -= std::min(visits, task.visits_left);
  }

  void show(const At& at, const std::string& stage) {
    now_.study = at.task->study->name;
    now_.point = describe(at.key());
    now_.remaining_s = remaining(tasks_);
    show_stage(stage);
  }
  void show_stage(const std::string& stage) {
    now_.stage = stage;
    if (progress_) progress_(now_);
  }

  // Measures a point. Returns nothing if measuring fails or the result differs from an earlier run.
  // In this case the failure is noted, the point is not measured again, and the next point gets a
  // new device.
  std::optional<PointResult> measure(const At& at) {
    std::string why = lacking(at.key());
    if (!why.empty()) return PointResult{.device = "none", .left_out = std::move(why)};
    if (!lab_) {
      lab_.emplace(request_.device,
                   [this](const ProgressStep& step) { show_stage(text_of(step)); });
    }
    std::string failure;
    try {
      PointResult out = at.task->study->measure(at.point(), *lab_);
      if (request_.times && is_timed(at.point()) && out.left_out.empty())
        require_as_before(at, out);
      return out;
    } catch (const Error& error) {
      failure = error.what();
    } catch (const std::bad_alloc&) {
      failure = "out of memory";
    }
    summary_.failed.push_back(now_.study + ": " + now_.point + ": " + failure);
    closed_.insert({at.task, at.position});
    lab_.reset();
    return std::nullopt;
  }

  // Throws Error unless all runs of a point agree. Runs of this process must agree in everything
  // but times; runs of different processes must agree in the counts.
  void require_as_before(const At& at, const PointResult& result) {
    const auto [first, is_new] = first_.try_emplace({at.task, at.position}, result);
    if (!is_new) return require_same(at.key(), first->second, result);
    const auto row = at.task->rows.find(at.position);
    if (row == at.task->rows.end() || stored(result).counts == row->second.counts) return;
    throw Error(describe(at.key()), "its counts are not those of an earlier round",
                "run farcull doctor; the device is not deterministic");
  }

  using Place = std::pair<const Task*, std::size_t>;

  const StudiesRequest& request_;
  StudiesSummary& summary_;
  std::vector<Task>& tasks_;
  Store& store_;
  const std::function<void(const StudiesProgress&)>& progress_;
  StudiesProgress now_;
  std::optional<MeasurementContext> lab_;
  std::int64_t run_ = 0;
  Interruptible* interruptible_ = nullptr;
  std::set<Place> closed_;                   // points that are finished or have failed
  std::map<Place, PointResult> first_;       // the first run of each timed point
  std::map<PointKey, Measurement> timed_;    // times of a point in any study
  std::map<PointKey, Measurement> counted_;  // counts of a point in a plain study
};

}  // namespace

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
  std::optional<TimingLock> lock;
  for (const Task& task : tasks) {
    const auto timed = [&](std::size_t i) { return is_timed(task.points[i]); };
    if (request.times && !lock && std::ranges::any_of(task.open, timed)) lock.emplace(request.lock);
  }
  Runner(request, summary, tasks, store, progress).run();
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    StudySummary& study = summary.studies[t];
    study.measured = tasks[t].measured;
    study.seconds = tasks[t].seconds;
    for (const Row& row : store.study(study.study).rows) {
      study.left_out += !row.measurement.left_out.empty();
      for (const Json& round : row.measurement.times.value("rounds", Json::array()))
        study.void_rounds += round["void"].get<bool>();
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
      headline_study(),   scenes_study(),    accuracy_study(),  error_time_study(), radius_study(),
      offsets_study(),    precision_study(), culling_study(),   stability_study(),  cloth_study(),
      efficiency_study(), scaling_study(),   libraries_study(), proximity_study(),  model_study()};
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
      if (const auto* run = std::get_if<RunPoint>(&point)) return !draws(run->method);
      if (const auto* placed = std::get_if<PlacementPoint>(&point))
        return !placed->pairs || placed->subpixel_bits > 0;
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
