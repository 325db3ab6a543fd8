// The chapter of the study "stability".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/plan.h"
#include "core/view.h"
#include "experiments/report/numbers.h"
#include "experiments/report/rows.h"
#include "experiments/tables.h"

namespace farcull {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// What a scene goes to an extreme in, and how far.
struct Extreme {
  std::string family;  // a panel
  std::string axis;
  double at = 0;
};

Extreme extreme_of(const Row& row) {
  const std::string& scene = row.point.scene;
  for (const auto& [mark, family, axis] :
       {std::tuple{"@offset-", "far from the origin", "offset (units)"},
        std::tuple{"@scale-", "scaled", "scale"}}) {
    if (const auto at = scene.find(mark); at != std::string::npos)
      return {family, axis, std::stod(scene.substr(at + std::string(mark).size()))};
  }
  const std::vector<std::string> words = split_list(scene.substr(0, scene.find('@')), ':');
  const double value = words.size() > 2 ? std::stod(words[2]) : kNaN;
  if (words[0] == "slivers") return {"slivers", "aspect", value};
  if (words[0] == "stack") return {"stacked sheets", "distance (widths)", value};
  if (words[0] == "mixed") return {"mixed sizes", "ratio of sizes", value};
  if (words[0] == "gap")
    return {value > 0 ? "gaps" : "overlaps", value > 0 ? "gap (ulps)" : "overlap (ulps)",
            std::abs(value)};
  if (words[0] == "cloth") {
    const bool apart = scene.find('@') != std::string::npos;
    return {apart ? "cloth on a sphere" : "cloth against itself and a sphere", "stiffness (N/m)",
            value};
  }
  return {words[0], "", value};
}

// What a method did over the rows at one place of a family: a cloth has several frames there.
struct Sum {
  std::uint64_t runs = 0, colliding = 0, missed = 0, wrong = 0, candidates = 0;
  std::uint64_t triangles = 0, colliding_triangles = 0, kept = 0;
  bool keeps = false;  // says what triangles it keeps
  double radius_px = 0, pixel_size = 0, ms = 0;
};
void add(const Row& row, Sum& sum) {
  ++sum.runs;
  sum.colliding += number_of(row, "colliding");
  sum.missed += number_of(row, "missed");
  sum.wrong += number_of(row, "wrong");
  sum.candidates += number_of(row, "candidates");
  sum.triangles += number_of(row, "triangles");
  sum.colliding_triangles += number_of(row, "colliding_triangles");
  sum.kept += number_of(row, "kept_triangles");
  sum.keeps = sum.keeps || (count_of(row, "kept_triangles") && row.point.method != "exact");
  sum.radius_px = std::max(sum.radius_px, count_of(row, "radius_px").value_or(0));
  sum.pixel_size = std::max(sum.pixel_size, count_of(row, "pixel_size").value_or(0));
  sum.ms += time_of(row, "total").value_or(0);
}

struct Family {
  std::string name, axis;
  std::vector<std::string> methods;                   // in the order of the grid
  std::map<std::string, std::map<double, Sum>> sums;  // by method and place
};

std::vector<Family> families_of(const StoredStudy& stored) {
  std::vector<Family> out;
  for (const Row& row : stored.rows) {
    if (!row.measurement.left_out.empty()) continue;
    const Extreme extreme = extreme_of(row);
    auto family = std::find_if(out.begin(), out.end(),
                               [&](const Family& f) { return f.name == extreme.family; });
    if (family == out.end()) {
      out.push_back({extreme.family, extreme.axis, {}, {}});
      family = out.end() - 1;
    }
    const std::string method = contestant(row.point);
    if (!family->sums.contains(method)) family->methods.push_back(method);
    add(row, family->sums[method][extreme.at]);
  }
  return out;
}

double share(std::uint64_t part, std::uint64_t all) {
  return all == 0 ? kNaN : 100 * static_cast<double>(part) / static_cast<double>(all);
}

Panel panel_of(const Family& family, const std::string& y) {
  bool zero = false;
  for (const auto& [method, places] : family.sums) zero = zero || places.contains(0);
  return {.title = family.name,
          .x = {.label = family.axis, .logarithmic = true, .shows_zero = zero},
          .y = {.label = y, .logarithmic = true, .shows_zero = true, .to = 100.0},
          .series = {}};
}

bool ours(const std::string& method) { return method.starts_with("FAR"); }

Figure missed_figure(const std::vector<Family>& families) {
  Figure out{.name = "stability-missed",
             .title = "Missed pairs in extreme scenes",
             .caption =
                 "Colliding pairs that are not found, of all there are. The line below the "
                 "powers is 0. Scenes in which nothing collides have no share.",
             .panels = {}};
  for (const Family& family : families) {
    Panel panel = panel_of(family, "missed pairs (%)");
    bool collides = false;
    for (const std::string& method : family.methods) {
      if (method == "exact") continue;
      Series series{.name = method, .x = {}, .y = {}, .emphasis = ours(method)};
      for (const auto& [at, sum] : family.sums.at(method)) {
        series.x.push_back(at);
        series.y.push_back(share(sum.missed, sum.colliding));
        collides = collides || sum.colliding > 0;
      }
      panel.series.push_back(std::move(series));
    }
    if (collides) out.panels.push_back(std::move(panel));
  }
  return out;
}

Figure kept_figure(const std::vector<Family>& families) {
  Figure out{.name = "stability-kept",
             .title = "What culling keeps in extreme scenes",
             .caption =
                 "Triangles that are kept, of all; below, those that collide: a method "
                 "that misses nothing cannot be below that line.",
             .panels = {}};
  for (const Family& family : families) {
    Panel panel = panel_of(family, "kept triangles (%)");
    Series floor{.name = "colliding", .x = {}, .y = {}, .style = Series::Style::lines};
    for (const std::string& method : family.methods) {
      Series series{.name = method, .x = {}, .y = {}, .emphasis = ours(method)};
      for (const auto& [at, sum] : family.sums.at(method)) {
        if (!sum.keeps) continue;
        series.x.push_back(at);
        series.y.push_back(share(sum.kept, sum.triangles));
        if (panel.series.empty()) {
          floor.x.push_back(at);
          floor.y.push_back(share(sum.colliding_triangles, sum.triangles));
        }
      }
      if (!series.x.empty()) panel.series.push_back(std::move(series));
    }
    if (panel.series.empty()) continue;
    panel.series.push_back(std::move(floor));
    out.panels.push_back(std::move(panel));
  }
  return out;
}

std::string number_text(double value) { return fmt::format("{:g}", value); }

// "3.1": kept over colliding triangles.
std::string over(const Sum& sum) {
  if (!sum.keeps || sum.colliding_triangles == 0) return "-";
  return rounded(static_cast<double>(sum.kept) / static_cast<double>(sum.colliding_triangles));
}

// The ends of each family.
DataTable short_table(const std::vector<Family>& families) {
  DataTable out{.name = "stability",
                .caption =
                    "All places of each family together: missed pairs, pairs that a library "
                    "reports though they do not collide, and kept over colliding triangles "
                    "at the first place and at the last",
                .columns = {"family", "method", "runs", "colliding", "missed", "wrong",
                            "kept/colliding at", "first", "last"},
                .alignment = "llrrrrlrr",
                .rows = {}};
  for (const Family& family : families) {
    for (const std::string& method : family.methods) {
      if (method == "exact") continue;
      Sum all;
      const auto& places = family.sums.at(method);
      for (const auto& [at, sum] : places) {
        all.runs += sum.runs;
        all.colliding += sum.colliding;
        all.missed += sum.missed;
        all.wrong += sum.wrong;
      }
      out.rows.push_back({family.name, method, grouped(all.runs), grouped(all.colliding),
                          grouped(all.missed), grouped(all.wrong),
                          fmt::format("{} .. {}", number_text(places.begin()->first),
                                      number_text(places.rbegin()->first)),
                          over(places.begin()->second), over(places.rbegin()->second)});
    }
  }
  return out;
}

DataTable all_table(const std::vector<Family>& families) {
  DataTable out{.name = "stability-all",
                .caption = "Every place; of cloth the sum of its frames, and the widest radius",
                .columns = {"family", "at", "method", "colliding", "missed", "wrong", "candidates",
                            "kept triangles", "triangles", "kept/colliding", "radius (px)",
                            "radius (units)", "ms"},
                .alignment = "lrlrrrrrrrrrr",
                .rows = {},
                .in_text = false};
  for (const Family& family : families) {
    for (const std::string& method : family.methods) {
      for (const auto& [at, sum] : family.sums.at(method)) {
        out.rows.push_back(
            {family.name, number_text(at), method, grouped(sum.colliding), grouped(sum.missed),
             grouped(sum.wrong), grouped(sum.candidates), sum.keeps ? grouped(sum.kept) : "-",
             grouped(sum.triangles), over(sum), sum.radius_px > 0 ? rounded(sum.radius_px) : "-",
             sum.radius_px > 0 ? rounded(sum.radius_px * sum.pixel_size) : "-", rounded(sum.ms)});
      }
    }
  }
  return out;
}

// Where a method that promises nothing misses, and what a library reports wrongly.
void add_failures(const std::vector<Family>& families, const std::vector<std::string>& promising,
                  Chapter& chapter) {
  std::map<std::string, std::vector<std::string>> misses, wrongs;
  std::vector<std::string> order;
  for (const Family& family : families) {
    for (const std::string& method : family.methods) {
      if (std::find(promising.begin(), promising.end(), method) != promising.end()) continue;
      if (std::find(order.begin(), order.end(), method) == order.end()) order.push_back(method);
      const std::pair<const double, Sum>*missing = nullptr, *mistaken = nullptr;
      for (const auto& place : family.sums.at(method)) {
        if (place.second.missed > 0 &&
            (missing == nullptr || share(place.second.missed, place.second.colliding) >
                                       share(missing->second.missed, missing->second.colliding)))
          missing = &place;
        if (place.second.wrong > 0 &&
            (mistaken == nullptr || place.second.wrong > mistaken->second.wrong))
          mistaken = &place;
      }
      if (missing != nullptr) {
        misses[method].push_back(
            fmt::format("{} ({} {}: {})", family.name, family.axis, number_text(missing->first),
                        of_all(missing->second.missed, missing->second.colliding)));
      }
      if (mistaken != nullptr) {
        wrongs[method].push_back(fmt::format("{} ({} {}: {})", family.name, family.axis,
                                             number_text(mistaken->first),
                                             grouped(mistaken->second.wrong)));
      }
    }
  }
  for (const std::string& method : order) {
    if (misses.contains(method)) {
      chapter.findings.push_back(
          fmt::format("{} misses pairs, at worst: {}.", method, listed(misses[method])));
    } else if (method != "exact") {
      chapter.findings.push_back(
          fmt::format("{} misses nothing here, and promises nothing.", method));
    }
    if (wrongs.contains(method)) {
      chapter.findings.push_back(fmt::format("{} reports pairs that do not collide, at worst: {}.",
                                             method, listed(wrongs[method])));
    }
  }
}

// How much more than what collides a promising method keeps, from the first place to the last.
void add_degradation(const std::vector<Family>& families, const std::vector<std::string>& promising,
                     Chapter& chapter) {
  for (const std::string& method : promising) {
    std::vector<std::string> parts;
    for (const Family& family : families) {
      const auto it = family.sums.find(method);
      if (it == family.sums.end()) continue;
      const Sum *least = nullptr, *most = nullptr;
      double least_at = 0, most_at = 0;
      const auto ratio = [](const Sum& sum) {
        return static_cast<double>(sum.kept) / static_cast<double>(sum.colliding_triangles);
      };
      for (const auto& [at, sum] : it->second) {
        if (!sum.keeps || sum.colliding_triangles == 0) continue;
        if (least == nullptr || ratio(sum) < ratio(*least)) least = &sum, least_at = at;
        if (most == nullptr || ratio(sum) > ratio(*most)) most = &sum, most_at = at;
      }
      if (least == nullptr) continue;
      parts.push_back(least == most || over(*least) == over(*most)
                          ? fmt::format("{} {}", family.name, over(*least))
                          : fmt::format("{} {} (at {}) to {} (at {})", family.name, over(*least),
                                        number_text(least_at), over(*most), number_text(most_at)));
    }
    if (!parts.empty()) {
      chapter.findings.push_back(
          fmt::format("{} keeps, per colliding triangle: {}.", method, listed(parts)));
    }
  }
}

}  // namespace

Chapter stability_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const std::vector<Family> families = families_of(stored);
  std::vector<std::string> promising;
  for (const Row& row : stored.rows) {
    const std::string name = contestant(row.point);
    if (row.measurement.left_out.empty() && promises(row) &&
        std::find(promising.begin(), promising.end(), name) == promising.end())
      promising.push_back(name);
  }
  add_promises(stored, out);
  add_failures(families, promising, out);
  add_degradation(families, promising, out);
  out.limits = {
      "FAR and CULLIDE test no object against itself: of the cloth they see it against the sphere, "
      "FAR pairs and S-CULLIDE also against itself.",
      "FCL leaves neighbours in one object out, so these are no misses of its; of the others they "
      "count.",
      "Where an input is already beyond what a library's type can hold, its misses are those of "
      "the rounding to it: FCL is asked in float, as it is mostly used.",
      fmt::format("Where {} triangles or fewer are left FAR stops culling, since testing them is "
                  "cheaper: what it keeps in small scenes says little.",
                  kFewTriangles)};
  add_gaps(stored, out);
  if (families.empty()) return out;
  out.figures = {missed_figure(families), kept_figure(families)};
  out.tables = {short_table(families), all_table(families)};
  return out;
}

}  // namespace farcull
