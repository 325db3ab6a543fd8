// Writes each frame as a row of a table, an element of the JSON record and rows of CSV.
#include "experiments/measure/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/stopwatch.h"
#include "core/view/view.h"
#include "experiments/record/stage_words.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

// Returns the keys of a run's record that may differ between frames. Options of drawing may differ,
// since boxes may leave nothing to draw in a frame.
std::vector<std::string> keys_of_frame() {
  std::vector<std::string> keys = split_list(
      "views,stages,pcs,object_triangles,candidate_pairs,colliding_pairs,neighbour_pairs,"
      "all_colliding_pairs,neighbours,contacts,ignored,decided_pairs,complete,verification,"
      "time_ms");
  for (const Option& option : run_options()) {
    if (option.of_drawing) keys.emplace_back(option.name);
  }
  return keys;
}

Json rate_json(double ms) { return json_of(per_second(ms)); }

// Returns the record of a frame. head: the record of the first frame. Entries that are usually the
// same in all frames are written only if they differ from `head`.
Json frame_json(const Scene& scene, const Record& record, const Json& head, long frame,
                double read_ms, const FrameSource& source) {
  const Json run = to_json(scene, record);
  Json out = {{"frame", frame},
              {"hash", run["scene"]["hash"]},
              {"objects", scene.objects.size()},
              {"triangles", scene.triangles.size()},
              {"folded_polygons", scene.folded.size()},
              {"topology_changed", source.topology_changed()}};
  for (const std::string& key : keys_of_frame()) out[key] = run[key];
  for (const char* key : {"promises", "promise_reason", "verdict", "device"})
    if (run[key] != head[key]) out[key] = run[key];
  out["time_ms"]["read"] = read_ms;
  out["fps"] = rate_json(record.ms.cull + record.ms.exact);
  const Stage work = work_of(record.trace);
  out["draws"] = work.draws;
  out["queries"] = work.queries;
  out["motion"] = Json::object();
  const FrameNotes notes = source.notes();
  // A value that is not finite becomes null in JSON.
  for (const auto& [name, value] : notes.values) out["motion"][name] = value;
  out["warning"] = text_json(notes.warning);
  return out;
}

// Formats a row for each frame as soon as the frame is done. The first frame that has a value for a
// column adds the column. The header line is repeated when a column is added or becomes wider.
class FrameTable {
 public:
  /// width: the least width of the first column.
  explicit FrameTable(std::size_t width) : first_width_(width) {}

  void add(const std::string& column, const std::string& cell) {
    auto found = std::ranges::find(columns_, column, &Column::name);
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

  /// Returns the row of the frame, after a header line if a column is new or wider.
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
    std::string cell;  // text in the row that is being made
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

void add_row(const Scene& scene, const Record& record, long frame, const FrameNotes& notes,
             FrameTable& table) {
  table.add("frame", std::to_string(frame));
  table.add("candidates", grouped(record.found.count));
  table.add("colliding", grouped(record.collisions.pairs.size()));
  if (has_self(scene)) {
    table.add("+ neighbours", "+ " + grouped(record.collisions.neighbour_pairs.size()));
  }
  if (record.verification) table.add("missed", grouped(record.verification->false_negatives));
  table.add("cull ms", fmt::format("{:.1f}", record.ms.cull));
  table.add("exact ms", fmt::format("{:.1f}", record.ms.exact));
  const std::optional<double> rate = per_second(record.ms.cull + record.ms.exact);
  table.add("fps", rate ? fmt::format("{:.1f}", *rate) : "-");
  table.add("PCS objects", grouped(record.found.object_count));
  table.add("PCS triangles", grouped(record.found.triangle_count));
  const Stage work = work_of(record.trace);
  if (work.queries > 0) table.add("queries", grouped(work.queries));
  if (work.draws > 0) table.add("draws", grouped(work.draws));
  for (const auto& [name, value] : notes.values) table.add(name, fmt::format("{:.6g}", value));
}

// The distinct warnings, each with the first frame and the number of frames that have the warning.
struct Warnings {
  struct Line {
    std::string text;
    long first = 0, frames = 0;
  };
  std::vector<Line> lines;

  void add(long frame, const std::string& warning) {
    if (warning.empty()) return;
    const auto known = std::ranges::find(lines, warning, &Line::text);
    if (known == lines.end())
      lines.push_back({warning, frame, 1});
    else
      ++known->frames;
  }
  std::string text() const {
    std::string out;
    for (const Line& line : lines) {
      out += fmt::format("warning  {} (frame {}{})\n", line.text, line.first,
                         line.frames > 1 ? fmt::format(" and {} more", line.frames - 1) : "");
    }
    return out;
  }
};

FrameTimes summary_of_sorted(const std::vector<double>& ms) {
  if (ms.empty()) return {};
  const std::size_t n = ms.size();
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(n)));
  return {.median = 0.5 * (ms[(n - 1) / 2] + ms[n / 2]), .p95 = ms[rank - 1], .max = ms[n - 1]};
}

// Totals over the frames so far.
struct Totals {
  std::vector<double> ms;  // times of the frames, ascending
  double first_ms = 0;     // time of the first frame
  double setup_ms = 0;
  std::uint64_t missed = 0;
  long topologies = 0;

  void add(const Record& record, bool topology_changed) {
    const double time = record.ms.cull + record.ms.exact;
    if (ms.empty()) first_ms = time;
    ms.insert(std::upper_bound(ms.begin(), ms.end(), time), time);
    setup_ms += record.ms.setup;
    topologies += topology_changed;
    if (record.verification) missed += record.verification->false_negatives;
  }

  Json json(const FramesQuestion& question) const {
    const FrameTimes times = summary_of_sorted(ms);
    return {{"frames", ms.size()},
            {"wanted", question.range.count()},
            {"ms",
             {{"first", first_ms},
              {"median", times.median},
              {"p95", times.p95},
              {"max", times.max},
              {"following", ms.size() > 1 ? Json(following()) : Json(nullptr)}}},
            {"fps", {{"median", rate_json(times.median)}, {"p95", rate_json(times.p95)}}},
            {"setup_ms", setup_ms},
            {"topology_changes", topologies},
            {"missed", question.options.verify ? Json(missed) : Json(nullptr)}};
  }

  // Returns the median time of all frames but the first.
  double following() const {
    std::vector<double> others = ms;
    others.erase(std::ranges::find(others, first_ms));
    return summary_of_sorted(others).median;
  }

  std::string text() const {
    const FrameTimes times = summary_of_sorted(ms);
    std::string out = fmt::format(
        "\nper frame  median {:.1f} ms, 95% within {:.1f} ms, at most {:.1f} ms (cull + exact; "
        "setup {:.1f} ms besides)\n",
        times.median, times.p95, times.max, setup_ms);
    if (ms.size() > 1) {
      out += fmt::format("           the first {:.1f} ms, the following ones median {:.1f} ms\n",
                         first_ms, following());
    }
    if (topologies > 0) {
      out += fmt::format("topology  changed {} between frames\n",
                         counted(static_cast<std::uint64_t>(topologies), "time", "times"));
    }
    return out;
  }
};

}  // namespace

std::optional<double> per_second(double ms) {
  const double rate = 1000 / ms;
  return rate > 0 && std::isfinite(rate) ? std::optional(rate) : std::nullopt;
}

FrameTimes summary_of(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  return summary_of_sorted(ms);
}

void for_each_frame(const FrameRange& range, const char* end, const Progress& progress,
                    const std::string& before,
                    const std::function<void(long frame, const Progress& named)>& one) {
  std::optional<Interruptible> interruptible;
  if (end) interruptible.emplace(range.count(), "frames", end, static_cast<bool>(progress));
  for (long frame = range.first; frame <= range.last; ++frame) {
    const long done = frame - range.first + 1;
    const std::string name = fmt::format("{}frame {} of {}: ", before, done, range.count());
    one(frame,
        progress ? [&](const ProgressStep& step) { progress(name + text_of(step)); } : Progress{});
    if (interruptible) interruptible->done(done);
  }
}

void FrameRecord::add(const Json& head, const Json& frame, const Json& summary) {
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
    text = head.empty() ? "{" : head.dump(2);
    if (!head.empty()) text.replace(text.rfind("\n}"), 2, ",");
    text += "\n  \"frames\": [\n    ";
  }
  output_.add(text + indented(frame, "    "),
              "\n  ],\n  \"summary\": " + indented(summary, "  ") + "\n}\n");
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
  session.remember_frames();
  FramesResult out;
  Json frames = Json::array();
  Totals totals;
  FrameTable table(std::to_string(question.range.last).size());
  Warnings warnings;
  const auto run_frame = [&](long frame, const Progress& named) {
    if (named) named("reading");
    const Stopwatch reading;
    const Scene& scene = source.at(frame);
    const double read_ms = reading.ms();
    RunOptions options = question.options;
    if (question.ignored) options.ignored = question.ignored(scene);
    if (frame == question.range.first)
      require_asked(scene, options.ignored, "SCENE", "test objects against themselves with --self");
    const Record record = run(scene, options, session, named);
    totals.add(record, source.topology_changed());
    if (record.verification) {
      add_fields(*record.verification, out.sum);
      out.sum.ms += record.verification->ms;
    }
    const NothingToTest nothing = nothing_to_test(scene);
    if (frame == question.range.first || nothing.reason.empty()) out.nothing = nothing;
    add_row(scene, record, frame, source.notes(), table);
    warnings.add(frame, source.notes().warning);
    std::string rows = table.row(), csv;
    if (question.pairs) {
      csv = pairs_rows(scene, record, std::to_string(frame) + ",", question.columns);
    }
    if (frame == question.range.first) {
      out.json = to_json(scene, record);
      for (const std::string& key : keys_of_frame()) out.json.erase(key);
      rows.insert(0, run_heading(scene, record) + "\n");
      if (question.pairs) csv.insert(0, "frame," + pairs_header(scene, question.columns));
    }
    Json one = frame_json(scene, record, out.json, frame, read_ms, source);
    if (sink) {
      std::string certificate;
      if (question.certificates) certificate = to_text(certificate_of(scene, record));
      sink({out.json, one, totals.json(question), std::move(rows), std::move(csv), frame,
            std::move(certificate)});
    } else {
      frames.push_back(std::move(one));
      out.table += rows;
      out.pairs_csv += csv;
    }
    if (out.broken.empty() && broken(record, question.strict)) {
      out.broken = fmt::format("frame {}: {} culled pairs that collide: {}", frame,
                               describe(record.options, not_drawn_text(record)),
                               grouped(record.verification->false_negatives));
    }
  };
  for_each_frame(question.range, sink ? "what they gave is written" : "nothing was written",
                 progress, "", run_frame);

  if (!sink) out.json["frames"] = std::move(frames);
  out.json["summary"] = totals.json(question);
  out.table += totals.text();
  if (!question.options.verify) out.table += "accounted  not at all (--no-verify)\n";
  out.table += warnings.text();
  return out;
}

}  // namespace farcull
