// Merges series that agree, and replaces panels without a difference by a sentence.
#include "experiments/report/legible.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/report/axes.h"
#include "experiments/report/chapters/numbers.h"
#include "experiments/report/style.h"

namespace farcull {
namespace {

const Series* series_in(const Panel& panel, const std::string& name) {
  const auto at = std::find_if(panel.series.begin(), panel.series.end(),
                               [&](const Series& series) { return series.name == name; });
  return at == panel.series.end() ? nullptr : &*at;
}

bool same_values(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double one, double other) {
    return one == other || (std::isnan(one) && std::isnan(other));
  });
}

bool agree(const Figure& figure, const std::string& one, const std::string& other) {
  return std::all_of(figure.panels.begin(), figure.panels.end(), [&](const Panel& panel) {
    const Series *a = series_in(panel, one), *b = series_in(panel, other);
    if (a == nullptr || b == nullptr) return a == b;
    return a->style == b->style && same_values(a->x, b->x) && same_values(a->y, b->y) &&
           same_values(a->x_low, b->x_low) && same_values(a->x_high, b->x_high) &&
           same_values(a->y_low, b->y_low) && same_values(a->y_high, b->y_high);
  });
}

bool emphasised(const Figure& figure, const std::string& name) {
  return std::any_of(figure.panels.begin(), figure.panels.end(), [&](const Panel& panel) {
    const Series* series = series_in(panel, name);
    return series != nullptr && series->emphasis;
  });
}

constexpr std::size_t kLongestName = 85;  // characters that the key has room for

// The name of series that agree; where all names are too long for the key, the caption has them.
std::string name_of(const std::vector<std::string>& group, Figure& figure) {
  const std::string all = fmt::format("{}", fmt::join(group, " = "));
  if (characters(all) <= kLongestName) return all;
  const std::string few = fmt::format("{} and {} others", group.front(), group.size() - 1);
  figure.caption = sentence(figure.caption) + fmt::format(" {}: {}.", few, all);
  return few;
}

void merge_series(Figure& figure) {
  std::vector<std::vector<std::string>> groups;
  for (const std::string& name : series_names(figure)) {
    const auto at = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return agree(figure, group.front(), name);
    });
    if (at == groups.end()) {
      groups.push_back({name});
    } else {
      at->push_back(name);
    }
  }
  for (std::vector<std::string>& group : groups) {
    if (group.size() == 1) continue;
    // The first gives the colour: what the figure is about, or ours.
    std::ranges::stable_partition(group, [&](const std::string& one) {
      return emphasised(figure, one) || one.starts_with("FAR");
    });
    const std::string name = name_of(group, figure);
    for (Panel& panel : figure.panels) {
      bool emphasis = false;
      for (const std::string& one : group) {
        const Series* series = series_in(panel, one);
        emphasis = emphasis || (series != nullptr && series->emphasis);
      }
      std::erase_if(panel.series, [&](const Series& series) {
        return series.name != group.front() &&
               std::find(group.begin(), group.end(), series.name) != group.end();
      });
      for (Series& series : panel.series) {
        if (series.name != group.front()) continue;
        series.name = name;
        series.emphasis = emphasis;
      }
    }
  }
}

struct Difference {
  bool any = false;             // two values of the panel differ
  std::optional<double> value;  // the first; empty: there is none
};

Difference difference_in(const Panel& panel) {
  Difference out;
  for (const Series& series : panel.series) {
    for (const double y : series.y) {
      if (!std::isfinite(y)) continue;
      if (!out.value) out.value = y;
      if (y != *out.value) out.any = true;
    }
  }
  return out;
}

void drop_panels(Figure& figure) {
  std::vector<std::string> empty;
  std::vector<std::pair<std::string, std::vector<std::string>>> same;  // by value
  std::vector<Panel> kept;
  for (Panel& panel : figure.panels) {
    const Difference difference = difference_in(panel);
    if (difference.any || panel.drawing) {
      kept.push_back(std::move(panel));
    } else if (difference.value) {
      const std::string value = tick_label(*difference.value);
      auto at =
          std::find_if(same.begin(), same.end(), [&](const auto& s) { return s.first == value; });
      if (at == same.end()) at = same.insert(at, {value, {}});
      at->second.push_back(panel.title);
    } else {
      empty.push_back(panel.title);
    }
  }
  if (kept.empty()) return;
  figure.panels = std::move(kept);
  figure.caption = sentence(figure.caption);
  for (const auto& [value, titles] : same)
    figure.caption +=
        fmt::format(" Not drawn, since every value is {}: {}.", value, listed(titles));
  if (!empty.empty())
    figure.caption += fmt::format(" Not drawn, since there is no value: {}.", listed(empty));
}

}  // namespace

Figure legible(Figure figure) {
  drop_panels(figure);
  merge_series(figure);
  return figure;
}

}  // namespace farcull
