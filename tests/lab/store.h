// A study that measures nothing but its own points, for tests of what is kept of a study; and when
// two stores say the same.
#pragma once

#include <unistd.h>
#include "experiments/studies/run_studies.h"
#include "tests/lab/test.h"

namespace farcull {

inline Provenance lab_provenance(const std::string& commit = "c0ffee") {
  return {.started = "2026-01-01T00:00:00Z",
          .commit = commit,
          .gl_vendor = "v",
          .gl_renderer = "r",
          .gl_version = "4.5",
          .cpu = "cpu",
          .cpu_features = "a b",
          .cores = 2,
          .options = "{}"};
}

/// `points` points, each answered by a number that depends on the point and the seed; each takes
/// `pause`.
inline Study counting_study(std::size_t points, std::chrono::microseconds pause = {},
                            const std::string& name = "counting") {
  return {.name = name,
          .title = "counts",
          .question = "does every point get its row?",
          .grid =
              [=](const GridChoice& choice) {
                std::vector<Point> out;
                for (std::size_t i = 0; i < (choice.quick ? points / 2 : points); ++i)
                  out.push_back(LemmaPoint{.generator = "scene-" + std::to_string(i / 7),
                                           .points = 1,
                                           .worst = i % 2 == 1,
                                           .side = static_cast<int>(i + 1),
                                           .seed = choice.seed});
                return out;
              },
          .measure =
              [=](const Point& point, MeasurementContext&) {
                std::this_thread::sleep_for(pause);
                const auto& lemma = std::get<LemmaPoint>(point);
                const auto side = static_cast<std::uint64_t>(lemma.side);
                LemmaCounts counts;
                counts.points = side * side;
                counts.largest_px = lemma.side / 3.0;
                counts.rounded = lemma.seed;
                PointResult out{.counts = counts, .device = "cpu"};
                out.times.total = static_cast<double>(::getpid());
                return out;
              }};
}

/// Which of the points of counting_study() this is, from 1.
inline int number_of(const Point& point) { return std::get<LemmaPoint>(point).side; }

/// Times are measured however busy the machine is, and beside other tests.
inline StudiesRequest lab_request(const std::string& folder, std::vector<Study> studies,
                                  bool resume = false) {
  return {.studies = std::move(studies),
          .folder = folder,
          .choice = {},
          .resume = resume,
          .shard = {},
          .device = {},
          .provenance = lab_provenance(),
          .most_load = 1,
          .lock = folder + "/lock"};
}

/// A study of timed points, one for each name: scenes "a", "b", .. with methods boxes and
/// exact. `runs` grows by "SCENE METHOD" with each run. The nth run of the study takes n ms.
inline Study timed_study(const std::vector<std::string>& scenes, std::vector<std::string>& runs,
                         const std::string& name = "timed") {
  return {.name = name,
          .title = "times",
          .question = "in which order?",
          .grid =
              [=](const GridChoice&) {
                std::vector<Point> out;
                for (const std::string& scene : scenes) {
                  for (const Method method : {Method::boxes, Method::exact})
                    out.push_back(repeated(plain_point(NamedScene{scene}, method), 2 * kRounds));
                }
                return out;
              },
          .measure =
              [&runs](const Point& point, MeasurementContext&) {
                const PointKey key = key_of(point);
                runs.push_back(key.scene + " " + key.method);
                RunCounts counts;
                counts.colliding = key.method.size();
                return PointResult{.counts = counts,
                                   .times = {.total = static_cast<double>(runs.size())},
                                   .device = "cpu"};
              },
          .plain = true};
}

/// The number of rows of a study; 0 where it is not declared.
inline std::size_t rows_in(const Store& store, const std::string& study) {
  return store.declaration(study) ? store.study(study).rows.size() : 0;
}

/// Empty where both stores hold the same points with the same counts, devices and reasons; else the
/// first difference. Times and runs are no part of it.
inline std::string difference(const std::string& a, const std::string& b) {
  const Store first(a, Store::Access::read), second(b, Store::Access::read);
  if (first.studies() != second.studies()) return "other studies";
  for (const std::string& name : first.studies()) {
    const StoredStudy one = first.study(name), two = second.study(name);
    if (one.declaration.points != two.declaration.points) return name + ": other points";
    if (one.rows.size() != two.rows.size())
      return name + ": " + std::to_string(one.rows.size()) + " rows and " +
             std::to_string(two.rows.size());
    for (std::size_t i = 0; i < one.rows.size(); ++i) {
      const Row &x = one.rows[i], &y = two.rows[i];
      if (x.position != y.position || x.point != y.point ||
          x.measurement.counts.dump() != y.measurement.counts.dump() ||
          x.measurement.device != y.measurement.device ||
          x.measurement.left_out != y.measurement.left_out)
        return name + ": row " + std::to_string(i);
    }
  }
  return "";
}

}  // namespace farcull
