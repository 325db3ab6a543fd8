// The counts of the studies' quick grids on the native canvas, as a text file of the repository.
//
//   # comment
//   [STUDY] COUNT COUNT ..    a section; the next lines have these counts, in this order
//   KEY;..;KEY;COUNT;..       a point: the ten columns of its key (point.h), then its counts
//   [scenes]
//   SCENE;FRAME;HASH          the triangles of each scene, which all its points share
//
// A number that may have a fraction is written in hexadecimal, so that the text holds all its bits.
// Sections and lines are sorted. Times are no part of it. Points of other libraries are left out:
// their counts are those of the library's version.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "experiments/scenes/builtin/scenes.h"
#include "experiments/studies/run_point.h"
#include "experiments/studies/study.h"

namespace farcull::native_counts {

struct StudyGridPoint {
  const Study* study;
  Point point;
};

/// Whether the scene of the point is made of packaged meshes, which a machine need not have.
inline bool needs_meshes(const Point& point) {
  const BuiltinScene* const scene = find_builtin_scene(key_of(point).scene);
  return scene != nullptr && scene->needs_meshes;
}

/// Whether counts of the point are in the file. Those of other libraries are of their versions.
/// Sizes of potential neighbour sets change with each improvement of the search; their tests stand
/// in tests/experiments/measure.
inline bool is_counted(const Point& point) {
  return std::visit(
      [](const auto& of) {
        using Of = std::decay_t<decltype(of)>;
        return !(std::is_same_v<Of, PeerPoint> || std::is_same_v<Of, LibraryPoint> ||
                 std::is_same_v<Of, DistancePoint> || std::is_same_v<Of, NeighbourPoint>);
      },
      point);
}

/// The points of a study's quick grid. The study "model" has none: its predictions are sums of
/// powers and logarithms of the C library, whose last bits differ between processors.
inline std::vector<StudyGridPoint> quick_points(const Study& study) {
  std::vector<StudyGridPoint> out;
  if (study.name == "model") return out;
  for (Point& point : study.grid({.quick = true, .seed = 1})) {
    if (!is_counted(point)) continue;
    out.push_back({&study, std::move(point)});
  }
  return out;
}

/// A line of the file.
struct Line {
  std::string section;  // "[STUDY] COUNT COUNT .."
  std::string key;      // the ten columns
  std::string counts;
  std::string scene, hash;  // the key of the scene's own line, and its hash; empty: it has none
};

inline std::string text_of(const CountValue& value) {
  if (const auto* const yes = std::get_if<bool>(&value)) return *yes ? "1" : "0";
  if (const auto* const number = std::get_if<std::uint64_t>(&value)) return std::to_string(*number);
  if (const auto* const text = std::get_if<std::string>(&value)) return *text;
  char text[40];
  std::snprintf(text, sizeof text, "%a", std::get<double>(value));
  return text;
}

/// key: that of the point, whatever was measured at it.
inline Line line_of(const Study& study, const PointKey& key, const Counts& counts) {
  Line out{.section = "[" + study.name + "]", .key = {}, .counts = {}, .scene = {}, .hash = {}};
  const std::vector<std::string> axes = axis_values(key);
  for (std::size_t i = 0; i < axes.size(); ++i) out.key += (i == 0 ? "" : ";") + axes[i];
  for (const auto& [name, value] : named(counts)) {
    if (name == "scene_hash") {
      out.scene = key.scene + ";" + (key.frame >= 0 ? std::to_string(key.frame) : "");
      out.hash = text_of(value);
      continue;
    }
    out.section += " " + name;
    out.counts += (out.counts.empty() ? "" : ";") + text_of(value);
  }
  return out;
}

/// Measures the point. Throws Error as the study does, and where nothing could be measured.
inline Line measured(const Study& study, const Point& point, const PointKey& key, Lab& lab) {
  const PointResult result = study.measure(point, lab);
  if (!result.left_out.empty()) throw Error(describe(point), result.left_out, "look into it");
  return line_of(study, key, result.counts);
}

inline constexpr const char* kScenes = "[scenes]";

/// The file: by section, by key.
using Table = std::map<std::string, std::map<std::string, std::string>>;

/// Throws Error where the table has another line for the point, or another hash for its scene.
inline void add(Table& table, const Line& line) {
  const auto put = [&](const std::string& section, const std::string& key, const std::string& is) {
    const auto [at, is_new] = table[section].try_emplace(key, is);
    if (!is_new && at->second != is)
      throw Error(section + " " + key, "it is " + at->second + " and " + is, "look into it");
  };
  put(line.section, line.key, line.counts);
  if (!line.hash.empty()) put(kScenes, line.scene, line.hash);
}

/// "[STUDY]" of a section.
inline std::string study_of(const std::string& section) {
  return section.substr(0, section.find(' '));
}

/// Empty, or how the line of a measured point differs from the table.
inline std::string difference(const Table& table, const Line& line) {
  const auto look = [&](const std::string& section, const std::string& key,
                        const std::string& is) -> std::string {
    const std::string before = section + "\n  " + key + ": ";
    const auto found = table.find(section);
    if (found == table.end()) return before + "the file has no such section\n";
    const auto at = found->second.find(key);
    if (at == found->second.end()) return before + "the file has no such line\n";
    if (at->second == is) return "";
    return before + "\n    " + is + "\n  and the file has\n    " + at->second + "\n";
  };
  std::string out = look(line.section, line.key, line.counts);
  if (!line.hash.empty()) out += look(kScenes, line.scene, line.hash);
  return out;
}

inline std::string to_text(const Table& table, const std::string& header) {
  std::string out = header;
  for (const auto& [section, lines] : table) {
    out += section + "\n";
    for (const auto& [key, counts] : lines) out += key + ";" + counts + "\n";
  }
  return out;
}

/// Throws Error naming `path` for a text that is no such file.
inline Table parse(const std::string& text, const std::string& path) {
  const auto refuse = [&](const std::string& line) {
    throw Error(path, "this line is none of its format: " + line,
                "make it anew: bash experiments/native_counts.sh --renew");
  };
  Table out;
  std::map<std::string, std::string>* section = nullptr;
  bool scenes = false;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[') {
      section = &out[line];
      scenes = line == kScenes;
      continue;
    }
    std::size_t end = 0;  // of the key: before the counts
    for (std::size_t i = 0; i < (scenes ? 2 : field_names<PointKey>().size()); ++i) {
      end = line.find(';', i == 0 ? 0 : end + 1);
      if (end == std::string::npos) refuse(line);
    }
    if (section == nullptr || !section->emplace(line.substr(0, end), line.substr(end + 1)).second)
      refuse(line);
  }
  return out;
}

inline Table read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path, "it cannot be read", "name the file of counts");
  return parse({std::istreambuf_iterator<char>(file), {}}, path);
}

}  // namespace farcull::native_counts
