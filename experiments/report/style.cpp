// Finds the method in the name of a series, and gives the others free colours in turn.
#include "experiments/report/style.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>

namespace farcull {
namespace {

// The words that a name contains, lower-case, with blanks for all that is no letter or digit; the
// first that fits counts, so the longer ones come first.
struct Known {
  const char* words;
  SeriesStyle style;
};

const std::vector<Known>& known() {
  static const std::vector<Known> all = {
      {"far pairs", {"#009e73", 0, 9}},     {"interval", {"#009e73", 0, 9}},
      {"far exact", {"#56b4e9", 0, 5}},     {"exact offset", {"#56b4e9", 0, 5}},
      {"far", {"#0072b2", 0, 7}},           {"obb union", {"#0072b2", 0, 7}},
      {"quick cullide", {"#e69f00", 1, 8}}, {"s cullide", {"#cc79a7", 3, 12}},
      {"cullide", {"#d55e00", 1, 6}},       {"i collide", {"#777777", 3, 4}},
      {"cgal", {"#882255", 2, 10}},         {"fcl", {"#aa7744", 2, 13}},
      {"embree", {"#999933", 2, 11}},       {"exact", {"#000000", 2, 1}},
      {"colliding", {"#000000", 2, 1}},     {"ode", {"#661100", 2, 2}},
  };
  return all;
}

const std::vector<std::string>& free_colours() {
  static const std::vector<std::string> all = {"#332288", "#117733", "#cc6677", "#44aa99",
                                               "#aa4499", "#888800", "#661100", "#6699cc",
                                               "#555555", "#dd8800"};
  return all;
}

const std::vector<int>& points() {
  static const std::vector<int> all = {7, 5, 9, 11, 13, 6, 4, 8, 10, 12};
  return all;
}

// " far exact " of "FAR, exact": words between blanks, so that "far" is not found in "farther".
std::string words_of(std::string_view name) {
  std::string out = " ";
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) {
      out += static_cast<char>(std::tolower(byte));
    } else if (out.back() != ' ') {
      out += ' ';
    }
  }
  if (out.back() != ' ') out += ' ';
  return out;
}

const Known* known_of(const std::string& name) {
  // Of several that agree, "A = B", the first.
  const std::string words = words_of(std::string_view(name).substr(0, name.find(" = ")));
  for (const Known& k : known()) {
    if (words.find(" " + std::string(k.words) + " ") != std::string::npos) return &k;
  }
  return nullptr;
}

}  // namespace

const std::vector<std::string>& dashes() {
  static const std::vector<std::string> all = {"solid", "(10,5)", "(2,3)", "(10,4,2,4)", "(16,4)"};
  return all;
}

std::vector<SeriesStyle> styles_of(const std::vector<std::string>& names) {
  std::vector<SeriesStyle> out;
  std::map<const Known*, std::size_t> times;
  std::size_t unknown = 0;
  for (const std::string& name : names) {
    const Known* k = known_of(name);
    if (k == nullptr) {
      out.push_back(
          {.colour = free_colours()[unknown % free_colours().size()],
           .dash = static_cast<int>((unknown + unknown / free_colours().size()) % dashes().size()),
           .point = points()[(unknown + unknown / points().size()) % points().size()]});
      ++unknown;
      continue;
    }
    SeriesStyle style = k->style;
    if (const std::size_t before = times[k]++; before > 0) {
      style.dash =
          static_cast<int>((static_cast<std::size_t>(style.dash) + before) % dashes().size());
      const auto at = std::find(points().begin(), points().end(), style.point) - points().begin();
      style.point = points()[(static_cast<std::size_t>(at) + before) % points().size()];
    }
    out.push_back(style);
  }
  return out;
}

std::vector<std::string> series_names(const Figure& figure) {
  std::vector<std::string> out;
  for (const Panel& panel : figure.panels) {
    for (const Series& series : panel.series) {
      if (std::find(out.begin(), out.end(), series.name) == out.end()) out.push_back(series.name);
    }
  }
  return out;
}

}  // namespace farcull
