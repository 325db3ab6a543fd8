// The chapter of the study "accuracy": missed pairs against resolution, of FAR and of the form of
// CULLIDE that misses the fewest; all forms of CULLIDE beside each other; and a picture of CULLIDE
// beside FAR where CULLIDE misses something.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "experiments/report/chapters/numbers.h"
#include "experiments/report/chapters/rows.h"
#include "experiments/studies/point.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

// A scene, or several drawn alike with different seeds.
struct SceneGroup {
  std::string name;
  std::vector<NamedRows> seeds;  // at least one, the scene's own first
};

std::vector<SceneGroup> groups_of(const std::vector<NamedRows>& scenes) {
  std::vector<SceneGroup> out;
  for (const NamedRows& scene : scenes) {
    const std::string name = scene_base(scene.name);
    auto at =
        std::find_if(out.begin(), out.end(), [&](const auto& one) { return one.name == name; });
    if (at == out.end()) at = out.insert(at, {name, {}});
    at->seeds.push_back(scene);
  }
  return out;
}

// Whether the resolution was chosen by the size of triangles.
bool is_sized(const Row& row) { return row.point.method.find('@') != std::string::npos; }
double pixels_of(const Row& row) { return count_or_none(row, "mean_pixels"); }

// The contestant without the size.
std::string form_of(const Row& row) {
  PointKey point = row.point;
  point.method = point.method.substr(0, point.method.find(" @"));
  return contestant(point);
}

// "cullide", "quick-cullide" or "s-cullide", in any form.
bool is_of_family(const Row& row) { return row.point.method.find("cullide") != std::string::npos; }
bool is_object_level(const Row& row) {
  return row.point.method.find("--level objects") != std::string::npos;
}

// Misses and candidates of a form where all forms were measured.
struct FormSums {
  std::string name;
  Rows rows;
  std::uint64_t missed = 0, candidates = 0;
  bool culls = true;  // leaves no more candidates than the rival
};

// The forms of a family that cull triangles, at the scenes and resolutions that all of them have.
struct Family {
  std::string name;   // "CULLIDE" or "S-CULLIDE"
  std::string rival;  // what promises, at the same scenes and resolutions; empty: nothing there
  std::uint64_t rival_candidates = 0;
  std::vector<FormSums> forms;  // those that cull as well as the rival first; of these the fewest
                                // missed pairs first, then the fewest candidates
};

// S-CULLIDE tests objects against themselves, where FAR was not measured.
Family family_of(const Rows& rows, bool self) {
  using Place = std::pair<std::string, int>;
  Family out{.name = self ? "S-CULLIDE" : "CULLIDE", .rival = {}, .forms = {}};
  const std::string rival = self ? "FAR pairs" : "FAR (OBB)";
  std::map<std::string, std::map<Place, const Row*>> forms;
  std::map<Place, const Row*> rivals;
  for (const Row* row : rows) {
    if (is_sized(*row)) continue;
    const Place place(row->point.scene, row->point.resolution);
    if (contestant(row->point) == rival) rivals.emplace(place, row);
    if (!is_of_family(*row) || row->point.method.starts_with("s-cullide") != self ||
        is_object_level(*row))
      continue;
    forms[contestant(row->point)].emplace(place, row);
  }
  if (forms.empty()) return out;
  std::vector<Place> common;
  for (const auto& [place, row] : forms.begin()->second) {
    if (std::all_of(forms.begin(), forms.end(),
                    [&, &at = place](const auto& form) { return form.second.contains(at); }))
      common.push_back(place);
  }
  if (!common.empty() && std::all_of(common.begin(), common.end(),
                                     [&](const Place& at) { return rivals.contains(at); })) {
    out.rival = rival;
    for (const Place& at : common) out.rival_candidates += number_of(*rivals.at(at), "candidates");
  }
  for (const auto& [name, of] : forms) {
    FormSums sums{.name = name, .rows = {}};
    for (const Place& at : common) sums.rows.push_back(of.at(at));
    sums.missed = total(sums.rows, "missed");
    sums.candidates = total(sums.rows, "candidates");
    sums.culls = out.rival.empty() || sums.candidates <= out.rival_candidates;
    out.forms.push_back(std::move(sums));
  }
  std::stable_sort(out.forms.begin(), out.forms.end(), [](const FormSums& a, const FormSums& b) {
    return std::tuple(!a.culls, a.missed, a.candidates) <
           std::tuple(!b.culls, b.missed, b.candidates);
  });
  return out;
}

// The names of the family's lines in the headline: the strongest form, and the published one.
std::set<std::string> headline_forms(const Rows& rows) {
  std::set<std::string> out;
  for (const bool self : {false, true}) {
    const Family family = family_of(rows, self);
    if (family.forms.empty()) continue;
    out.insert(family.forms.front().name);
    for (const FormSums& form : family.forms) {
      if (form.name == family.name + ", one round") out.insert(form.name);
    }
  }
  return out;
}

bool always_drawn(const Row& row) {
  return contestant(row.point) == "FAR (OBB)" || contestant(row.point) == "FAR pairs";
}

// Missed pairs of a contestant in a group: the median over the seeds at each resolution; of several
// seeds also the least and the most.
void add_lines(const SceneGroup& group, const std::function<bool(const Row&)>& wanted,
               Panel& panel) {
  std::vector<std::string> names;
  std::map<std::string, std::map<int, std::vector<double>>> missed;
  for (const NamedRows& scene : group.seeds) {
    for (const Row* row : scene.rows) {
      if (is_sized(*row) || row->point.resolution <= 0 || !wanted(*row)) continue;
      const std::string name = contestant(row->point);
      if (!missed.contains(name)) names.push_back(name);
      missed[name][row->point.resolution].push_back(count_or_none(*row, "missed"));
    }
  }
  Series spread{.name = "least and most of the seeds", .style = Series::Style::points};
  for (const std::string& name : names) {
    Series series{.name = name};
    series.emphasis = name == "FAR (OBB)" || name == "FAR pairs";
    for (const auto& [resolution, values] : missed[name]) {
      // A resolution that some seeds lack would not be a median of the same scenes.
      if (values.size() < group.seeds.size()) continue;
      series.x.push_back(resolution);
      series.y.push_back(median(values));
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      if (*least == *most) continue;
      for (const double value : {*least, *most}) {
        spread.x.push_back(resolution);
        spread.y.push_back(value);
      }
    }
    if (!series.x.empty()) panel.series.push_back(std::move(series));
  }
  if (!spread.x.empty()) panel.series.push_back(std::move(spread));
}

std::string seeds_text(const SceneGroup& group) {
  return group.seeds.size() == 1 ? "" : fmt::format(" ({} seeds)", group.seeds.size());
}

// Of each seed.
std::vector<double> colliding_of(const SceneGroup& group) {
  std::vector<double> out;
  for (const NamedRows& scene : group.seeds)
    out.push_back(static_cast<double>(number_of(*scene.rows.front(), "colliding")));
  return out;
}

// One value where all are equal, else the median with the least and the most.
std::string value_or_spread(const std::vector<double>& values) {
  if (values.empty()) return "-";
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *least == *most ? rounded(*least) : spread(values);
}

// The groups with the first seed of each alone, which is the scene's own.
std::vector<SceneGroup> own_seeds(std::vector<SceneGroup> groups) {
  for (SceneGroup& group : groups) group.seeds.resize(1);
  return groups;
}

Figure missed_figure(const std::vector<SceneGroup>& groups, const std::string& name,
                     const std::string& title, const std::string& shows,
                     const std::function<bool(const Row&)>& wanted) {
  Figure out{.name = name, .title = title};
  std::vector<std::string> of;
  std::size_t runs = 0;
  bool seeds = false;
  for (const SceneGroup& group : groups) {
    Panel panel{.title = group.name + seeds_text(group),
                .x = logarithmic("resolution (px)"),
                .y = logarithmic("missed pairs", true)};
    add_lines(group, wanted, panel);
    if (panel.series.empty()) continue;
    for (const NamedRows& scene : group.seeds) {
      for (const Row* row : scene.rows)
        runs += !is_sized(*row) && row->point.resolution > 0 && wanted(*row);
    }
    seeds = seeds || group.seeds.size() > 1;
    of.push_back(group.name + " " + value_or_spread(colliding_of(group)));
    out.panels.push_back(std::move(panel));
  }
  out.caption =
      fmt::format("{} n = {}. Colliding pairs: {}.{}", shows, counted(runs, "run", "runs"),
                  fmt::format("{}", fmt::join(of, "; ")),
                  seeds ? " Where a scene was drawn with several seeds, lines are medians over the "
                          "seeds and points the least and the most; what was measured with one "
                          "seed alone is in the table."
                        : "");
  return out;
}

// Whether a form is left to the tables: the figures would have too many names with it.
bool is_left_out(const Row& row) {
  return row.point.method.starts_with("quick-cullide") || row.point.views == kBothDirections ||
         row.point.method.ends_with("--clear all");
}

// Misses against what is left, each point a run.
Figure kept_figure(const std::vector<SceneGroup>& groups) {
  Figure out{
      .name = "accuracy-kept",
      .title = "Missed pairs against the candidates that are left",
      .caption =
          "Each point is a run at one resolution. A method that leaves all pairs of "
          "overlapping boxes (exact) misses nothing and has culled nothing: below and to "
          "the left is better. Scenes that are drawn at random have their own seed. Quick-CULLIDE, "
          "both directions of each axis and views that all have to clear are in the tables."};
  std::size_t runs = 0;
  for (const SceneGroup& group : groups) {
    Panel panel{.title = group.name,
                .x = logarithmic("candidates / colliding pairs"),
                .y = {.label = "missed pairs (%)", .from = 0, .to = 100}};
    for (const NamedRows& method : rows_by_contestant(group.seeds.front().rows)) {
      Rows rows = method.rows;
      std::erase_if(rows, [](const Row* row) {
        return is_sized(*row) || number_of(*row, "colliding") == 0 ||
               !(count_or_none(*row, "candidates") > 0) || row->point.radius == kPublishedRadius ||
               row->point.offset == "exact" || is_left_out(*row);
      });
      if (rows.empty()) continue;
      runs += rows.size();
      Series series = series_of(
          method.name, rows,
          [](const Row& row) {
            return *count_of(row, "candidates") / static_cast<double>(number_of(row, "colliding"));
          },
          [](const Row& row) {
            return share(number_of(row, "missed"), number_of(row, "colliding"));
          });
      series.style = Series::Style::points;
      series.emphasis = method.name == "FAR (OBB)";
      panel.series.push_back(std::move(series));
    }
    if (!panel.series.empty()) out.panels.push_back(std::move(panel));
  }
  out.caption += fmt::format(" n = {}.", counted(runs, "run", "runs"));
  return out;
}

// Misses by the size of triangles, over all scenes that have the size.
Figure size_figure(const std::vector<SceneGroup>& groups) {
  Figure out{.name = "accuracy-size",
             .title = "Missed pairs against the size of triangles",
             .caption =
                 "The resolution is chosen so that a triangle that can take part covers 1, 4 or 16 "
                 "pixels, on average over the triangles and the axes. Scenes that are drawn at "
                 "random have their own seed."};
  std::size_t runs = 0;
  for (const SceneGroup& group : groups) {
    Panel panel{.title = group.name,
                .x = logarithmic("mean pixels of a triangle"),
                .y = logarithmic("missed pairs", true)};
    std::map<std::string, Rows> forms;
    std::size_t sizes = 0;
    for (const Row* row : group.seeds.front().rows) {
      if (!is_sized(*row)) continue;
      Rows& of = forms[form_of(*row)];
      of.push_back(row);
      sizes = std::max(sizes, of.size());
    }
    if (sizes == 1) out.caption += " Not drawn, since one size alone fits: " + group.name + ".";
    if (sizes < 2) continue;
    for (const auto& [name, rows] : forms) runs += rows.size();
    for (const auto& [name, rows] : forms) {
      Series series = series_of(name, rows, pixels_of,
                                [](const Row& row) { return count_or_none(row, "missed"); });
      series.emphasis = name == "FAR (OBB)";
      panel.series.push_back(std::move(series));
    }
    if (!panel.series.empty()) out.panels.push_back(std::move(panel));
  }
  out.caption += fmt::format(" n = {}.", counted(runs, "run", "runs"));
  return out;
}

DataTable short_table(const std::vector<SceneGroup>& groups) {
  std::set<int> resolutions;
  for (const SceneGroup& group : groups) {
    for (const NamedRows& scene : group.seeds) resolutions.merge(resolutions_in(scene.rows));
  }
  DataTable out{.name = "accuracy",
                .caption =
                    "Missed pairs by resolution in px. Of scenes that are drawn with several "
                    "seeds the median, with the least and the most",
                .columns = columns({"scene", "method"}, {"colliding"})};
  for (const int resolution : resolutions) out.columns.push_back({std::to_string(resolution)});
  for (const SceneGroup& group : groups) {
    Rows all;
    for (const NamedRows& scene : group.seeds)
      all.insert(all.end(), scene.rows.begin(), scene.rows.end());
    std::erase_if(all, [](const Row* row) { return is_sized(*row); });
    for (const NamedRows& method : rows_by_contestant(all)) {
      std::vector<std::string> cells = {group.name, method.name,
                                        value_or_spread(colliding_of(group))};
      for (const int resolution : resolutions) {
        std::vector<double> missed;
        for (const Row* row : method.rows) {
          if (row->point.resolution == resolution) missed.push_back(count_or_none(*row, "missed"));
        }
        // What was measured with one seed of several has no median.
        const bool one = missed.size() < group.seeds.size() && missed.size() == 1;
        cells.push_back(value_or_spread(missed) + (one ? " (own seed)" : ""));
      }
      out.rows.push_back(std::move(cells));
    }
  }
  return out;
}

// The forms of CULLIDE where all of them were measured.
DataTable forms_table(const Rows& rows) {
  DataTable out{
      .name = "accuracy-forms",
      .caption =
          "Forms of CULLIDE and S-CULLIDE that cull triangles, at the scenes and "
          "resolutions that all of a family have: missed pairs with the 95 % "
          "interval of Clopper and Pearson, and candidates that are left",
      .columns = columns({"form"}, {"runs", "missed pairs", "penetrating", "candidates"})};
  for (const bool self : {false, true}) {
    const Family family = family_of(rows, self);
    for (const FormSums& form : family.forms) {
      out.rows.push_back({form.name, grouped(form.rows.size()),
                          rate_text(form.missed, total(form.rows, "colliding")),
                          grouped(total(form.rows, "missed_penetrating")),
                          grouped(form.candidates)});
    }
    if (!family.rival.empty() && !family.forms.empty()) {
      out.rows.push_back({family.rival + ", there", grouped(family.forms.front().rows.size()), "-",
                          "-", grouped(family.rival_candidates)});
    }
  }
  return out;
}

DataTable long_table(const Rows& rows) {
  return table_of_rows(
      "accuracy-all", "All points", rows,
      {scene_column(), contestant_column(), resolution_column("resolution", "auto"),
       rounded_column("resolution by size", "resolution"),
       rounded_column("mean pixels of a triangle", "mean_pixels"),
       rounded_column("radius px", "radius_px"), count_column("colliding pairs", "colliding"),
       count_column("missed pairs", "missed"),
       count_column("of them penetrating", "missed_penetrating"),
       count_column("colliding triangles", "colliding_triangles"),
       count_column("missed triangles", "missed_triangles"),
       count_column("kept triangles", "kept_triangles"), count_column("candidates", "candidates"),
       time_column("ms", "total")});
}

// Adds the strongest form of each family and, beside it, the published one.
void add_forms(const Rows& rows, Chapter& chapter) {
  for (const bool self : {false, true}) {
    const Family family = family_of(rows, self);
    if (family.forms.size() < 2) continue;
    const auto in_words = [](const FormSums& form) {
      return fmt::format("misses {} colliding pairs and leaves {} candidates",
                         rate_text(form.missed, total(form.rows, "colliding")),
                         grouped(form.candidates));
    };
    const FormSums& best = family.forms.front();
    chapter.find(fmt::format(
        "Of {} forms of {} that cull triangles, \"{}\" misses the fewest pairs{}: in {} it {}.",
        family.forms.size(), family.name, best.name,
        family.rival.empty()
            ? ""
            : fmt::format(" (among those that leave no more candidates than {}, which leaves {})",
                          family.rival, grouped(family.rival_candidates)),
        counted(best.rows.size(), "run", "runs"), in_words(best)));
    for (const FormSums& form : family.forms) {
      if (form.name == family.name + ", one round")
        chapter.find(fmt::format("As published (\"{}\"), it {}.", form.name, in_words(form)));
    }
    std::vector<std::string> weak;
    for (const FormSums& form : family.forms) {
      if (!form.culls)
        weak.push_back(fmt::format("\"{}\" ({} missed, {} candidates)", form.name,
                                   grouped(form.missed), grouped(form.candidates)));
    }
    if (weak.empty()) continue;
    chapter.find(
        fmt::format("Forms that leave more candidates than {}: {}.", family.rival, listed(weak)));
  }
}

// Adds the misses where triangles have a size, of each form.
void add_sizes(const Rows& rows, Chapter& chapter) {
  std::map<double, std::map<std::string, Rows>> sizes;
  for (const Row* row : rows) {
    if (!is_sized(*row)) continue;
    const std::string& method = row->point.method;
    const double size = std::stod(method.substr(method.find('@') + 1));
    sizes[size][form_of(*row)].push_back(row);
  }
  for (const auto& [size, forms] : sizes) {
    std::vector<std::string> words;
    for (const auto& [name, of] : forms) {
      if (name == "CULLIDE, one round" || name == "FAR (OBB)" ||
          name == "CULLIDE, one round, conservative")
        words.push_back(name + " misses " + of_all(of, "missed", "colliding"));
    }
    if (words.empty()) continue;
    chapter.find(fmt::format("Where a triangle covers {} {} on average: {}.", rounded(size),
                             size == 1 ? "pixel" : "pixels",
                             fmt::format("{}", fmt::join(words, "; "))));
  }
}

// Adds how the misses of a method that promises nothing change from the fewest pixels to the most.
void add_course(const NamedRows& scene, const std::string& method, Chapter& chapter) {
  const Row *first = nullptr, *last = nullptr;
  for (const int resolution : resolutions_in(scene.rows)) {
    const Row* row = find_row(scene.rows, method, resolution);
    if (row == nullptr) continue;
    if (first == nullptr) first = row;
    last = row;
  }
  if (first == last) return;
  const std::uint64_t from = number_of(*first, "missed"), to = number_of(*last, "missed");
  chapter.find(fmt::format("{} on {}: {} colliding pairs are missed at {} px and {} at {} px{}.",
                           method, scene.name, of_all(from, number_of(*first, "colliding")),
                           first->point.resolution, grouped(to), last->point.resolution,
                           to > from              ? ", so more pixels made it worse"
                           : to == from && to > 0 ? ", so more pixels did not help"
                                                  : ""));
}

// Adds the sums over all rows of methods that promise nothing and are no form of CULLIDE.
void add_sums(Rows rows, Chapter& chapter) {
  std::erase_if(rows, [](const Row* row) {
    return promises(*row) || is_of_family(*row) || row->point.method == "exact";
  });
  const auto sums = rows_by(rows, [](const Row& row) { return contestant(row.point); });
  for (const auto& [method, runs] : sums) {
    chapter.find(fmt::format("{} promises nothing, and missed {} colliding pairs in {} here.",
                             method, rate_text(total(runs, "missed"), total(runs, "colliding")),
                             counted(runs.size(), "run", "runs")));
  }
}

// A picture with fewer pixels than these shows hardly more than misses.
constexpr int kLeastPixels = 128;

bool is_of(const Row& row, const char* method) {
  return row.point.method == method && row.point.resolution >= kLeastPixels;
}

// FAR as it promises, of the same scene and resolution; null where it was not measured.
const Row* partner_of(const Rows& rows, const Row& cullide) {
  for (const Row* row : rows) {
    if (is_of(*row, "far") && row->point.scene == cullide.point.scene &&
        row->point.resolution == cullide.point.resolution && row->point.offset == "obb" &&
        row->point.radius == kBudgetRadius) {
      return row;
    }
  }
  return nullptr;
}

// Meshes are easier to see than slivers.
int rank(const Row& row) { return row.point.scene.starts_with("two-bunnies") ? 0 : 1; }

// CULLIDE beside FAR on a scene, at a resolution where both were measured and CULLIDE missed
// something. Empty where there is none.
std::vector<Picture> pictures_of(const Rows& rows) {
  const Row *cullide = nullptr, *far = nullptr;
  for (const Row* row : rows) {
    if (!is_of(*row, "cullide") || number_of(*row, "missed") == 0) continue;
    const bool better = cullide == nullptr || rank(*row) < rank(*cullide) ||
                        (row->point.scene == cullide->point.scene &&
                         row->point.resolution < cullide->point.resolution);
    const Row* partner = better ? partner_of(rows, *row) : nullptr;
    if (partner == nullptr) continue;
    cullide = row;
    far = partner;
  }
  if (cullide == nullptr) return {};
  Picture out{
      .name = "accuracy-compare",
      .caption = fmt::format(
          "CULLIDE and FAR on {} at {} px. Missed pairs are drawn in the colour that nothing else "
          "has. What collides and was found is coloured, what was kept and does not collide is "
          "faint.",
          cullide->point.scene, cullide->point.resolution)};
  out.arguments.scene = {cullide->point.scene};
  for (const Method method : {Method::cullide, Method::far}) {
    RunOptions& options = out.arguments.panels.emplace_back();
    options.method = method;
    options.resolution = cullide->point.resolution;
    options.verify = false;
  }
  out.panels = {{"CULLIDE", count_of(*cullide, "missed"), count_of(*cullide, "colliding")},
                {"FAR", count_of(*far, "missed"), count_of(*far, "colliding")}};
  return {std::move(out)};
}

}  // namespace

Chapter accuracy_chapter(const StoredStudy& stored) {
  Chapter out = begin_chapter(stored);
  const Rows rows = measured(stored);
  const std::vector<NamedRows> scenes = rows_by_scene(stored);
  const std::vector<SceneGroup> groups = groups_of(scenes);
  const std::set<std::string> headline = headline_forms(rows);
  add_promises(stored, out);
  add_forms(rows, out);
  for (const SceneGroup& group : groups) {
    for (const std::string& form : headline) add_course(group.seeds.front(), form, out);
  }
  add_sizes(rows, out);
  add_sums(rows, out);
  out.limits = {
      "Scenes are few and still, so that no miss is no proof; the proof is in "
      "docs/reliability.md.",
      "Pairs of one scene do not collide independently of each other, so an interval over pairs is "
      "narrower than one over scenes would be.",
      "The form that misses the fewest pairs was chosen by the same runs that are shown.",
      "FAR is measured between objects; against themselves objects are tested by S-CULLIDE and FAR "
      "pairs alone.",
      "How much CULLIDE misses depends on how a device samples: other devices give other counts.",
      "The published radius may miss nothing in these scenes and pairs in others (see the study of "
      "the radius)."};
  add_gaps(stored, out);
  if (scenes.empty()) return out;
  out.figures = {
      missed_figure(groups, "accuracy", "Missed colliding pairs against resolution",
                    "FAR, and CULLIDE in the form that misses the fewest pairs and as "
                    "published.",
                    [&](const Row& row) {
                      return always_drawn(row) || headline.contains(contestant(row.point));
                    }),
      missed_figure(own_seeds(groups), "accuracy-forms", "Forms of CULLIDE",
                    "Scenes that are drawn at random have their own seed. Quick-CULLIDE, "
                    "both directions of each axis and views that all have to clear are "
                    "in the tables.",
                    [](const Row& row) { return is_of_family(row) && !is_left_out(row); }),
      kept_figure(groups)};
  Figure sizes = size_figure(groups);
  if (!sizes.panels.empty()) out.figures.push_back(std::move(sizes));
  std::erase_if(out.figures, [](const Figure& figure) { return figure.panels.empty(); });
  out.tables = {forms_table(rows), short_table(groups), long_table(rows)};
  out.pictures = pictures_of(rows);
  return out;
}

}  // namespace farcull
