#include "experiments/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "experiments/interrupt.h"
#include "experiments/output.h"
#include "experiments/run_pairs.h"
#include "experiments/scene_file.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

constexpr long kMostFrames = 1'000'000;
constexpr long kLastFrame = 1'000'000'000;

// What a frame has of its own in the record of a run; the rest is that of all.
constexpr std::array kOfFrame = {
    "views",           "stages",          "pcs",        "object_triangles", "candidate_pairs",
    "colliding_pairs", "neighbour_pairs", "neighbours", "verification",     "time_ms"};

Json rate_json(double ms) {
  const std::optional<double> rate = per_second(ms);
  return rate ? Json(*rate) : Json(nullptr);
}

Json frame_json(const Scene& scene, const RunRecord& record, long frame, double read_ms,
                const FrameSource& source) {
  const Json run = to_json(scene, record);
  Json out = {{"frame", frame},
              {"hash", run["scene"]["hash"]},
              {"objects", scene.objects.size()},
              {"triangles", scene.triangles.size()},
              {"topology_changed", source.topology_changed()}};
  for (const char* key : kOfFrame) out[key] = run[key];
  out["time_ms"]["read"] = read_ms;
  out["fps"] = rate_json(record.ms.cull + record.ms.exact);
  const Stage work = work_of(record.stages);
  out["draws"] = work.draws;
  out["queries"] = work.queries;
  out["motion"] = Json::object();
  const FrameNotes notes = source.notes();
  // Null where it is not finite.
  for (const auto& [name, value] : notes.values) out["motion"][name] = value;
  out["warning"] = notes.warning.empty() ? Json(nullptr) : Json(notes.warning);
  return out;
}

// A line for each frame, made as it comes. Columns appear where a frame has something for them;
// the names are written again where one appears, or where a cell does not fit any more.
class FrameTable {
 public:
  /// `width` of the first column, if that is more than its name takes.
  explicit FrameTable(std::size_t width) : first_width_(width) {}

  void add(const std::string& column, const std::string& cell) {
    auto found = std::find_if(columns_.begin(), columns_.end(),
                              [&](const Column& known) { return known.name == column; });
    if (found == columns_.end()) {
      const std::size_t least = columns_.empty() ? first_width_ : cell.size() + 1;
      found = columns_.insert(found, Column{column, std::max(least, column.size()), ""});
      renamed_ = true;
    }
    if (cell.size() > found->width) {
      found->width = cell.size() + 1;
      renamed_ = true;
    }
    found->cell = cell;
  }

  /// The row, with a line of names before it where it needs one.
  std::string row() {
    std::string out;
    if (std::exchange(renamed_, false)) {
      if (std::exchange(begun_, true)) out += "\n";
      out += line([](const Column& column) { return column.name; });
    }
    out += line([](const Column& column) { return column.cell; });
    for (Column& column : columns_) column.cell.clear();
    return out;
  }

 private:
  struct Column {
    std::string name;
    std::size_t width;
    std::string cell;  // of the row that is being made
  };

  template <class Text>
  std::string line(const Text& text) const {
    std::string out;
    for (const Column& column : columns_) {
      out += fmt::format("{}{:>{}}", out.empty() ? "" : "  ", text(column), column.width);
    }
    return out + "\n";
  }

  std::size_t first_width_;
  std::vector<Column> columns_;
  bool renamed_ = false, begun_ = false;
};

void add_row(const Scene& scene, const RunRecord& record, long frame, const FrameNotes& notes,
             FrameTable& table) {
  table.add("frame", std::to_string(frame));
  table.add("candidates", grouped(record.candidate_pairs));
  table.add("colliding", grouped(record.pairs.size()));
  if (has_self(scene)) table.add("neighbours", grouped(record.neighbour_pairs.size()));
  if (record.verification) table.add("missed", grouped(record.verification->false_negatives));
  table.add("cull ms", fmt::format("{:.1f}", record.ms.cull));
  table.add("exact ms", fmt::format("{:.1f}", record.ms.exact));
  const std::optional<double> rate = per_second(record.ms.cull + record.ms.exact);
  table.add("fps", rate ? fmt::format("{:.1f}", *rate) : "-");
  table.add("PCS objects", grouped(record.pcs_objects));
  table.add("PCS triangles", grouped(record.pcs_triangles));
  const Stage work = work_of(record.stages);
  if (work.queries > 0) table.add("queries", grouped(work.queries));
  if (work.draws > 0) table.add("draws", grouped(work.draws));
  for (const auto& [name, value] : notes.values) table.add(name, fmt::format("{:.6g}", value));
}

// Each warning once, with the frames that had it.
class Warnings {
 public:
  void add(long frame, const std::string& warning) {
    if (warning.empty()) return;
    for (Line& line : lines_) {
      if (line.text != warning) continue;
      ++line.frames;
      return;
    }
    lines_.push_back({warning, frame, 1});
  }
  std::string text() const {
    std::string out;
    for (const Line& line : lines_) {
      out += fmt::format("warning  {} (frame {}{})\n", line.text, line.first,
                         line.frames > 1 ? fmt::format(" and {} more", line.frames - 1) : "");
    }
    return out;
  }

 private:
  struct Line {
    std::string text;
    long first = 0;
    long frames = 0;
  };
  std::vector<Line> lines_;
};

Error missing_file(const std::string& file, FrameRange range) {
  return Error(file, "the file does not exist",
               fmt::format("give the numbers that there are: --frames FIRST:LAST instead of {}:{}",
                           range.first, range.last));
}

FrameTimes summary_of_sorted(const std::vector<double>& ms) {
  if (ms.empty()) return {};
  const std::size_t n = ms.size();
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(n)));
  return {.median = 0.5 * (ms[(n - 1) / 2] + ms[n / 2]), .p95 = ms[rank - 1], .max = ms[n - 1]};
}

// Of the frames up to now.
struct Totals {
  std::vector<double> ms;  // ascending
  double setup_ms = 0;
  std::uint64_t missed = 0;
  long topologies = 0;

  void add(const RunRecord& record, bool topology_changed) {
    const double time = record.ms.cull + record.ms.exact;
    ms.insert(std::upper_bound(ms.begin(), ms.end(), time), time);
    setup_ms += record.ms.setup;
    topologies += topology_changed;
    if (record.verification) missed += record.verification->false_negatives;
  }

  Json json(const FramesQuestion& question) const {
    const FrameTimes times = summary_of_sorted(ms);
    return {{"frames", ms.size()},
            {"wanted", question.range.count()},
            {"ms", {{"median", times.median}, {"p95", times.p95}, {"max", times.max}}},
            {"fps", {{"median", rate_json(times.median)}, {"p95", rate_json(times.p95)}}},
            {"setup_ms", setup_ms},
            {"topology_changes", topologies},
            {"missed", question.options.verify ? Json(missed) : Json(nullptr)}};
  }

  std::string text() const {
    const FrameTimes times = summary_of_sorted(ms);
    std::string out = fmt::format(
        "\nper frame  median {:.1f} ms, 95% within {:.1f} ms, at most {:.1f} ms (cull + exact; "
        "setup {:.1f} ms besides)\n",
        times.median, times.p95, times.max, setup_ms);
    if (topologies > 0)
      out += fmt::format("topology  changed {} times between frames\n", topologies);
    return out;
  }
};

bool same_objects(const std::vector<Object>& a, const std::vector<Object>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Object& x, const Object& y) {
    return x.triangle_count == y.triangle_count && x.self == y.self;
  });
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
  if (range.last < range.first || range.last > kLastFrame ||
      range.last - range.first >= kMostFrames) {
    throw bad;
  }
  return range;
}

FrameSource::FrameSource(std::vector<std::string> arguments, FrameRange range, bool self)
    : arguments_(std::move(arguments)), range_(range), self_(self), meshes_(range.first) {
  const bool built_in = arguments_.size() == 1 && is_builtin_scene(arguments_[0]);
  if (built_in && has_motion(arguments_[0])) {
    built_in_.emplace(arguments_[0], range.count(), range.first, self);
    return;
  }
  if (!built_in) scene_ = load_scene(arguments_, meshes_);
  const std::vector<std::string> paths = meshes_.numbered_paths();
  if (paths.empty()) {
    throw Error("--frames", "nothing in the scene moves",
                "put %d or %04d in place of the number in the name of a mesh, or name one of " +
                    moving_names());
  }
}

FrameSource::FrameSource(MovingScene moving) : built_in_(std::move(moving)) {}

const Scene& FrameSource::at(long frame) {
  if (!built_in_) {
    meshes_.set_frame(frame);
    for (const std::string& path : meshes_.numbered_paths()) {
      const std::string file = numbered(path, frame);
      std::error_code error;
      if (!std::filesystem::exists(file, error)) throw missing_file(file, range_);
    }
    Scene now = load_scene(arguments_, meshes_);
    if (now.triangles == scene_.triangles) now.triangles.swap(scene_.triangles);
    scene_ = std::move(now);
    for (Object& object : scene_.objects) object.self = object.self || self_;
  }
  const Scene& scene = built_in_ ? built_in_->at(frame) : scene_;
  const bool same = vertices_ == scene.vertices.size() && triangles_ == scene.triangles &&
                    same_objects(objects_, scene.objects);
  changed_ = !same && !first_;
  first_ = false;
  if (!same) {
    vertices_ = scene.vertices.size();
    triangles_ = scene.triangles;
    objects_ = scene.objects;
  }
  return scene;
}

std::optional<Error> FrameSource::missing() const {
  const std::vector<std::string> paths = meshes_.numbered_paths();
  for (long frame = range_.first; frame <= range_.last && !paths.empty(); ++frame) {
    for (const std::string& path : paths) {
      const std::string file = numbered(path, frame);
      std::error_code error;
      if (!std::filesystem::exists(file, error)) return missing_file(file, range_);
    }
  }
  return std::nullopt;
}

FrameNotes FrameSource::notes() const {
  if (!built_in_) return {};
  return {.values = built_in_->notes(), .warning = built_in_->warning()};
}

std::optional<double> per_second(double ms) {
  const double rate = 1000 / ms;
  return rate > 0 && std::isfinite(rate) ? std::optional(rate) : std::nullopt;
}

FrameTimes summary_of(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  return summary_of_sorted(ms);
}

// The text is that of Json::dump(2) of the whole record.
void FrameRecord::add(const FrameReport& report) {
  const auto indented = [](const Json& json, const std::string& by) {
    std::string out;
    for (const char c : json.dump(2)) {
      out += c;
      if (c == '\n') out += by;
    }
    return out;
  };
  std::string text = ",\n    ";
  if (!std::exchange(begun_, true)) {
    text = report.head.dump(2);
    text.erase(text.rfind("\n}"));
    text += ",\n  \"frames\": [\n    ";
  }
  output_.add(text + indented(report.frame, "    "),
              "\n  ],\n  \"summary\": " + indented(report.summary, "  ") + "\n}\n");
}

FramesResult run_frames(const std::vector<std::string>& arguments, const FramesQuestion& question,
                        const Progress& progress, const FrameSink& sink) {
  if (progress) progress("reading the scene");
  FrameSource source(arguments, question.range, question.self);
  return run_frames(source, question, progress, sink);
}

FramesResult run_frames(FrameSource& source, const FramesQuestion& question,
                        const Progress& progress, const FrameSink& sink) {
  Session session(question.options.device);
  FramesResult out;
  Json frames = Json::array();
  Totals totals;
  FrameTable table(std::to_string(question.range.last).size());
  Warnings warnings;
  Interruptible interruptible(question.range.count(), "frames",
                              sink ? "what they gave is written" : "nothing was written",
                              static_cast<bool>(progress));
  for (long frame = question.range.first; frame <= question.range.last; ++frame) {
    const std::string name =
        fmt::format("frame {} of {}", totals.ms.size() + 1, question.range.count());
    const Progress named =
        progress ? [&](const std::string& stage) { progress(name + ": " + stage); } : Progress{};
    if (named) named("reading");
    const Stopwatch reading;
    const Scene& scene = source.at(frame);
    const double read_ms = reading.ms();
    const RunRecord record = run_scene(scene, question.options, session, named);
    totals.add(record, source.topology_changed());
    add_row(scene, record, frame, source.notes(), table);
    warnings.add(frame, source.notes().warning);
    std::string rows = table.row(), csv;
    if (question.pairs) csv = pairs_rows(scene, record, std::to_string(frame) + ",");
    if (frame == question.range.first) {
      out.json = to_json(scene, record);
      for (const char* key : kOfFrame) out.json.erase(key);
      rows.insert(0, run_heading(scene, record) + "\n");
      if (question.pairs) csv.insert(0, "frame," + pairs_header(scene));
    }
    Json one = frame_json(scene, record, frame, read_ms, source);
    if (sink) {
      sink({out.json, one, totals.json(question), std::move(rows), std::move(csv)});
    } else {
      frames.push_back(std::move(one));
      out.table += rows;
      out.pairs_csv += csv;
    }
    if (out.broken.empty() && broken(record, question.strict)) {
      out.broken =
          fmt::format("frame {}: {} culled pairs that collide: {}", frame, describe(record.options),
                      grouped(record.verification->false_negatives));
    }
    interruptible.done(static_cast<long>(totals.ms.size()));
  }

  if (!sink) out.json["frames"] = std::move(frames);
  out.json["summary"] = totals.json(question);
  out.table += totals.text();
  if (!question.options.verify) out.table += "accounted  not at all (--no-verify)\n";
  out.table += warnings.text();
  return out;
}

}  // namespace farcull
