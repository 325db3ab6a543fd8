// The chapter of the study "stability": missed pairs and kept triangles in families of scenes that
// go to an extreme, such as slivers or offsets far from the origin.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/view/regions.h"
#include "core/view/view.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

// The quantity that a scene drives to an extreme, and how far.
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
  const double value = words.size() > 2 ? std::stod(words[2]) : kNone;
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

// The rows of a method by place in a family: a cloth has several frames at one place.
struct Track {
  std::string method;
  std::map<double, Rows> places;
};

struct Family {
  std::string name, axis;
  std::vector<Track> tracks;  // in the order of the grid
};

template <class Items, class Matches>
auto& find_or_add(Items& items, const Matches& matches, typename Items::value_type fresh) {
  const auto at = std::find_if(items.begin(), items.end(), matches);
  return at != items.end() ? *at : items.emplace_back(std::move(fresh));
}

std::vector<Family> families_of(const Rows& rows) {
  std::vector<Family> out;
  for (const Row* row : rows) {
    const Extreme extreme = extreme_of(*row);
    const std::string method = contestant(row->point);
    Family& family = find_or_add(
        out, [&](const Family& f) { return f.name == extreme.family; },
        Family{extreme.family, extreme.axis, {}});
    Track& track = find_or_add(
        family.tracks, [&](const Track& t) { return t.method == method; }, Track{method, {}});
    track.places[extreme.at].push_back(row);
  }
  return out;
}

// Whether the rows say which triangles the method keeps.
bool keeps(const Rows& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const Row* row) {
    return count_of(*row, "kept_triangles") && row->point.method != "exact";
  });
}

// Kept over colliding triangles; NaN where one of the two is not there.
double excess(const Rows& rows) {
  const std::uint64_t colliding = total(rows, "colliding_triangles");
  if (!keeps(rows) || colliding == 0) return kNone;
  return static_cast<double>(total(rows, "kept_triangles")) / static_cast<double>(colliding);
}
std::string excess_text(const Rows& rows) { return rounded(excess(rows)); }

// Pairs that 0.9 of the radius would miss; of methods without a radius nothing.
std::string risk_text(const Rows& rows) {
  const bool asked = std::any_of(rows.begin(), rows.end(), [](const Row* row) {
    return count_of(*row, "at_risk").has_value();
  });
  return asked ? grouped(total(rows, "at_risk")) : "-";
}

Panel panel_of(const Family& family, const std::string& y) {
  const bool zero = std::any_of(family.tracks.begin(), family.tracks.end(),
                                [](const Track& track) { return track.places.contains(0); });
  Panel out{.title = family.name, .x = logarithmic(family.axis, zero), .y = logarithmic(y, true)};
  out.y.to = 100;
  return out;
}

std::size_t runs_in(const std::vector<Family>& families) {
  std::size_t out = 0;
  for (const Family& family : families) {
    for (const Track& track : family.tracks) {
      for (const auto& [at, rows] : track.places) out += rows.size();
    }
  }
  return out;
}

bool ours(const std::string& method) { return method.starts_with("FAR"); }

Figure missed_figure(const std::vector<Family>& families) {
  Figure out{
      .name = "stability-missed",
      .title = "Missed pairs in extreme scenes",
      .caption = fmt::format("Colliding pairs that are not found, of all there are. Scenes in "
                             "which nothing collides have no share. n = {}, each of 1 run.",
                             counted(runs_in(families), "point", "points"))};
  for (const Family& family : families) {
    Panel panel = panel_of(family, "missed pairs (%)");
    bool collides = false;
    for (const auto& [method, places] : family.tracks) {
      if (method == "exact") continue;
      Series series{.name = method, .emphasis = ours(method)};
      for (const auto& [at, rows] : places) {
        const std::uint64_t colliding = total(rows, "colliding");
        series.x.push_back(at);
        series.y.push_back(share(total(rows, "missed"), colliding));
        collides = collides || colliding > 0;
      }
      panel.series.push_back(std::move(series));
    }
    if (collides) out.panels.push_back(std::move(panel));
  }
  return out;
}

Figure kept_figure(const std::vector<Family>& families) {
  Figure out{
      .name = "stability-kept",
      .title = "What culling keeps in extreme scenes",
      .caption = fmt::format("Triangles that are kept, of all; below, those that collide: a method "
                             "that misses nothing cannot be below that line. n = {}, each of 1 "
                             "run.",
                             counted(runs_in(families), "point", "points"))};
  for (const Family& family : families) {
    Panel panel = panel_of(family, "kept triangles (%)");
    Series floor{.name = "colliding", .style = Series::Style::lines};
    for (const auto& [method, places] : family.tracks) {
      Series series{.name = method, .emphasis = ours(method)};
      for (const auto& [at, rows] : places) {
        if (!keeps(rows)) continue;
        const std::uint64_t triangles = total(rows, "triangles");
        series.x.push_back(at);
        series.y.push_back(share(total(rows, "kept_triangles"), triangles));
        if (!panel.series.empty()) continue;
        floor.x.push_back(at);
        floor.y.push_back(share(total(rows, "colliding_triangles"), triangles));
      }
      if (!series.x.empty()) panel.series.push_back(std::move(series));
    }
    if (panel.series.empty()) continue;
    panel.series.push_back(std::move(floor));
    out.panels.push_back(std::move(panel));
  }
  return out;
}

// 1e12 and 1e-9, as in the names of scenes.
std::string number_text(double value) {
  std::string out = fmt::format("{:g}", value);
  for (const char* sign : {"e+0", "e+", "e-0"}) {
    if (const std::size_t at = out.find(sign); at != std::string::npos)
      out.replace(at, std::string(sign).size(), sign[1] == '+' ? "e" : "e-");
  }
  return out;
}

// "2.14 at 1": what is kept at a place of a family.
std::string kept_at(const std::pair<const double, Rows>& place) {
  const std::string kept = excess_text(place.second);
  return kept == "-" ? kept : fmt::format("{} at {}", kept, number_text(place.first));
}

// All places of each family together, and what is kept at its ends.
DataTable short_table(const std::vector<Family>& families) {
  DataTable out{
      .name = "stability",
      .caption =
          "Pairs in all scenes of a family together: colliding ones, those of them that "
          "a method missed, those that it would miss with 0.9 of its radius (at risk: where "
          "there are none, the scenes do not show that the radius is large enough), and those "
          "that a library reported though they do not collide. Then how many triangles culling "
          "kept for each one that collides, in "
          "the first scene of the family and in its last: \"2.14 at 10\" are 2.14 "
          "triangles where what the family changes is 10",
      .columns = columns({"family", "method"}, {"scenes", "colliding", "missed", "at risk", "wrong",
                                                "kept, first scene", "kept, last scene"})};
  for (const Family& family : families) {
    for (const auto& [method, places] : family.tracks) {
      if (method == "exact") continue;
      Rows all;
      for (const auto& [at, rows] : places) all.insert(all.end(), rows.begin(), rows.end());
      out.rows.push_back({family.name + (family.axis.empty() ? "" : ", " + family.axis), method,
                          grouped(all.size()), grouped(total(all, "colliding")),
                          grouped(total(all, "missed")), risk_text(all),
                          grouped(total(all, "wrong")), kept_at(*places.begin()),
                          kept_at(*places.rbegin())});
    }
  }
  return out;
}

DataTable all_table(const std::vector<Family>& families) {
  DataTable out{.name = "stability-all",
                .caption = "Every place; of cloth the sum of its frames, and the widest radius",
                .columns = columns(
                    {"family"}, {"at"}, {"method"},
                    {"colliding", "missed", "wrong", "candidates", "kept triangles", "triangles",
                     "kept/colliding", "radius (px)", "radius (units)", "time (ms)"}),
                .in_text = false};
  for (const Family& family : families) {
    for (const auto& [method, places] : family.tracks) {
      for (const auto& [at, rows] : places) {
        const auto sum = [&rows = rows](const char* count) { return grouped(total(rows, count)); };
        const double radius = largest(rows, "radius_px", 0);
        const double units = radius * largest(rows, "pixel_size", 0);
        double ms = 0;
        for (const Row* row : rows) ms += time_of(*row, "total").value_or(0);
        out.rows.push_back({family.name, number_text(at), method, sum("colliding"), sum("missed"),
                            sum("wrong"), sum("candidates"),
                            keeps(rows) ? sum("kept_triangles") : "-", sum("triangles"),
                            excess_text(rows), radius > 0 ? rounded(radius) : "-",
                            radius > 0 ? rounded(units) : "-", rounded(ms)});
      }
    }
  }
  return out;
}

// "slivers (aspect 1000: 4 of 20)": the place of the track with the largest positive value, or
// nothing. Of equal ones the first.
template <class ValueOf, class TextOf>
void add_worst(const Family& family, const Track& track, const ValueOf& value, const TextOf& text,
               std::vector<std::string>& out) {
  const std::pair<const double, Rows>* worst = nullptr;
  for (const auto& place : track.places) {
    if (value(place.second) > (worst == nullptr ? 0.0 : value(worst->second))) worst = &place;
  }
  if (worst == nullptr) return;
  out.push_back(fmt::format("{} ({} {}: {})", family.name, family.axis, number_text(worst->first),
                            text(worst->second)));
}

// Adds where a method that promises nothing misses, and what a library reports wrongly.
void add_failures(const std::vector<Family>& families, const std::set<std::string>& promising,
                  Chapter& chapter) {
  struct Failures {
    std::string method;
    std::vector<std::string> misses = {}, wrongs = {};
  };
  std::vector<Failures> all;
  for (const Family& family : families) {
    for (const Track& track : family.tracks) {
      if (promising.contains(track.method)) continue;
      Failures& of = find_or_add(
          all, [&](const Failures& f) { return f.method == track.method; }, Failures{track.method});
      add_worst(
          family, track,
          [](const Rows& rows) { return share(total(rows, "missed"), total(rows, "colliding")); },
          [](const Rows& rows) { return of_all(rows, "missed", "colliding"); }, of.misses);
      add_worst(
          family, track, [](const Rows& rows) { return static_cast<double>(total(rows, "wrong")); },
          [](const Rows& rows) { return grouped(total(rows, "wrong")); }, of.wrongs);
    }
  }
  for (const auto& [method, misses, wrongs] : all) {
    if (!misses.empty()) {
      chapter.find(fmt::format("{} missed pairs, at worst: {}.", method, listed(misses)));
    } else if (method != "exact") {
      chapter.find(fmt::format("{} missed nothing here, and promises nothing.", method));
    }
    if (!wrongs.empty()) {
      chapter.find(fmt::format("{} reported pairs that do not collide, at worst: {}.", method,
                               listed(wrongs)));
    }
  }
}

// Adds how much more than what collides a promising method keeps, over the places of each family.
void add_degradation(const std::vector<Family>& families, const std::string& method,
                     Chapter& chapter) {
  std::vector<std::string> parts;
  for (const Family& family : families) {
    for (const Track& track : family.tracks) {
      if (track.method != method) continue;
      const std::pair<const double, Rows>*least = nullptr, *most = nullptr;
      for (const auto& place : track.places) {
        const double value = excess(place.second);
        if (std::isnan(value)) continue;
        if (least == nullptr || value < excess(least->second)) least = &place;
        if (most == nullptr || value > excess(most->second)) most = &place;
      }
      if (least == nullptr) continue;
      const std::string from = excess_text(least->second), to = excess_text(most->second);
      parts.push_back(from == to
                          ? fmt::format("{} {}", family.name, from)
                          : fmt::format("{} {} (at {}) to {} (at {})", family.name, from,
                                        number_text(least->first), to, number_text(most->first)));
    }
  }
  if (!parts.empty())
    chapter.find(
        fmt::format("{} keeps for each triangle that collides: {}.", method, listed(parts)));
}

}  // namespace

Chapter stability_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const Rows rows = measured(stored);
  const std::vector<Family> families = families_of(rows);
  Rows reliable = rows;
  std::erase_if(reliable, [](const Row* row) { return !promises(*row); });
  const std::vector<NamedRows> promising = rows_by_contestant(reliable);
  std::set<std::string> names;
  for (const NamedRows& method : promising) names.insert(method.name);
  add_promises(stored, out);
  add_failures(families, names, out);
  for (const NamedRows& method : promising) add_degradation(families, method.name, out);
  out.limits = {
      "FAR and CULLIDE are measured between objects: of the cloth they see it against the sphere, "
      "FAR pairs and S-CULLIDE also against itself.",
      "The cloth here is small, and looked at in a few frames. The study cloth (farcull experiment "
      "cloth, hours) goes through 500 frames of 20,000 triangles.",
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
