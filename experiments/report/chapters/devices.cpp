// Pairs the rows of two devices by their points.
#include "experiments/report/chapters/devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

// A method at the points that two devices have measured.
struct Compared {
  std::string method;
  std::size_t points = 0, differ = 0;
  Rows first, other;
  std::vector<double> times = {};  // of the other over those of the first
};

std::vector<Compared> compare(const StoredStudy& first, const StoredStudy& other) {
  std::map<PointKey, const Row*> by_point;
  for (const Row* row : measured(first)) by_point[row->point] = row;
  std::vector<Compared> out;
  for (const Row* row : measured(other)) {
    const auto found = by_point.find(row->point);
    if (found == by_point.end()) continue;
    const Row& one = *found->second;
    const std::string method = contestant(row->point);
    auto at = std::find_if(out.begin(), out.end(),
                           [&](const Compared& known) { return known.method == method; });
    if (at == out.end()) at = out.insert(at, Compared{.method = method, .first = {}, .other = {}});
    ++at->points;
    at->differ += *one.measurement.counts != *row->measurement.counts;
    at->first.push_back(&one);
    at->other.push_back(row);
    const double ratio = time_or_none(*row, "total") / time_or_none(one, "total");
    if (ratio > 0) at->times.push_back(ratio);
  }
  return out;
}

// Missed pairs, or violations of the lemmas.
double failures(const Rows& rows) {
  double out = 0;
  for (const Row* row : rows) out += failures_of(*row).value_or(0);
  return out;
}

std::string whole(double value) { return grouped(static_cast<std::uint64_t>(value)); }

}  // namespace

void add_devices(const std::string& device, const StoredStudy& first,
                 const std::vector<DeviceStudy>& others, Chapter& chapter) {
  DataTable table{
      .name = chapter.study + "-devices",
      .caption = fmt::format(
          "The same points on other devices than {}: points that both have measured, those of them "
          "at which any count differs, missed pairs (of the lemmas: violations) and candidates on "
          "{} and on the other, and the median of the ratios of their times",
          device, device),
      .columns = columns({"device", "method"},
                         {"points", "differ", "missed, first", "missed, other", "candidates, first",
                          "candidates, other", "time, other/first"})};
  for (const DeviceStudy& other : others) {
    std::size_t points = 0, differ = 0;
    for (const Row& row : other.stored.rows) {
      if (breaks(row)) {
        chapter.find_broken(fmt::format("On {}, {} did not keep its promise at {}.", other.device,
                                        contestant(row.point), describe(row.point)));
      }
    }
    for (const Compared& method : compare(first, other.stored)) {
      points += method.points;
      differ += method.differ;
      table.rows.push_back(
          {other.device, method.method, grouped(method.points), grouped(method.differ),
           whole(failures(method.first)), whole(failures(method.other)),
           grouped(total(method.first, "candidates")), grouped(total(method.other, "candidates")),
           method.times.empty() ? "-" : rounded(median(method.times))});
    }
    if (points == 0) continue;
    chapter.find(fmt::format("On {} counts differ from those on {} at {} points.", other.device,
                             device, of_all(differ, points)));
  }
  if (!table.rows.empty()) chapter.tables.push_back(std::move(table));
}

}  // namespace farcull
