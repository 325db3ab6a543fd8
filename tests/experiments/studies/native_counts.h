// The counts of the studies' quick grids on the native canvas, as hashes in a file of the
// repository: one line for each method of a study.
//
//   STUDY;METHOD;POINTS;HASH;HASH;HASH;HASH
//
// The hashes are of the rows of the first point of each kind, of the first eight of each kind, of
// all points, and of all points on packaged meshes, which a machine need not have; "-": there are
// none. Points that share method, offset, radius rule and kind of depth are of one kind, and come
// in the order of their rows. A row holds the key of a point (point.h) and all its counts, those
// with a fraction in hexadecimal. Times are no part of it. Points of other libraries are left out:
// their counts are those of the library's version.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include "core/base/bytes.h"
#include "experiments/studies/run_point.h"
#include "tests/lab/points.h"

namespace farcull::native_counts {

/// Parts of the points, in the order of the columns. The first two are parts of the third.
enum Part : std::uint8_t { first_of_kind, eight_of_kind, without_meshes, on_meshes };
inline constexpr std::array<const char*, 4> kParts = {"first", "eight", "all", "meshes"};

struct StudyGridPoint {
  const Study* study;
  Point point;
  std::string key;  // the ten columns of its key
  std::array<bool, 4> is_in = {};
};

/// Whether counts of the point are in the file. Sizes of potential neighbour sets change with each
/// improvement of the search; their tests stand in tests/experiments/measure.
inline bool is_counted(const Point& point) {
  return !std::holds_alternative<PeerPoint>(point) &&
         !std::holds_alternative<LibraryPoint>(point) &&
         !std::holds_alternative<DistancePoint>(point) &&
         !std::holds_alternative<NeighbourPoint>(point);
}

/// The points of a study's quick grid. The study "model" has none: its predictions are sums of
/// powers and logarithms of the C library, whose last bits differ between processors.
inline std::vector<StudyGridPoint> quick_points(const Study& study) {
  std::vector<StudyGridPoint> out;
  if (study.name == "model") return out;
  for (Point& point : study.grid({.quick = true, .seed = 1})) {
    if (!is_counted(point)) continue;
    std::string key;
    for (const std::string& axis : axis_values(key_of(point))) key += axis + ";";
    out.push_back({&study, std::move(point), key});
  }
  std::ranges::sort(out, {}, &StudyGridPoint::key);
  std::map<std::string, int> had;
  for (StudyGridPoint& one : out) {
    const PointKey key = key_of(one.point);
    const BuiltinScene* const scene = find_builtin_scene(key.scene);
    one.is_in[on_meshes] = scene != nullptr && scene->needs_meshes;
    if (one.is_in[on_meshes]) continue;
    const bool factor = !key.radius || (!key.radius->published && key.radius != kBudgetRadius);
    const int before =
        had[key.method + ";" + key.offset + ";" + (factor ? "factor" : column_text(key.radius)) +
            ";" + column_text(key.depth_format) + ";" + column_text(key.depth_mode)]++;
    one.is_in = {before < 1, before < 8, true, false};
  }
  return out;
}

inline std::string text_of(const CountValue& value) {
  if (const auto* const yes = std::get_if<bool>(&value)) return *yes ? "1" : "0";
  if (const auto* const number = std::get_if<std::uint64_t>(&value)) return std::to_string(*number);
  if (const auto* const text = std::get_if<std::string>(&value)) return *text;
  char text[40];
  std::snprintf(text, sizeof text, "%a", std::get<double>(value));
  return text;
}

/// key: that of the point, whatever was measured.
inline std::string row_of(const Study& study, const std::string& key, const Counts& counts) {
  std::string out = study.name + ";" + key, hash;
  for (const auto& [name, value] : to_columns(counts))
    (name == "scene_hash" ? hash : out) += " " + name + "=" + text_of(value);
  return out + hash;
}

/// Measures the point. Throws Error as the study does, and where nothing could be measured.
inline std::string measured_row(const Study& study, const Point& point, const std::string& key,
                                MeasurementContext& lab) {
  const PointResult result = study.measure(point, lab);
  if (!result.left_out.empty()) throw Error(describe(point), result.left_out, "look into it");
  return row_of(study, key, result.counts);
}

struct RowsHash {
  std::uint64_t rows = 0, sum = 0;
  void add(const std::string& row) {
    Fnv1a hash;
    hash.add(row);
    sum += hash.value();
    ++rows;
  }
  std::string text() const {
    char text[20];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sum));
    return rows == 0 ? "-" : text;
  }
};

/// By study and method: a hash for each part.
using Table = std::map<std::string, std::array<RowsHash, 4>>;

inline void add(Table& table, const StudyGridPoint& point, const std::string& row) {
  std::array<RowsHash, 4>& hashes = table[point.study->name + ";" + key_of(point.point).method];
  for (std::size_t part = 0; part < hashes.size(); ++part)
    if (point.is_in[part]) hashes[part].add(row);
}

/// The lines of the file: by study and method, the number of points and the hashes.
using Lines = std::map<std::string, std::array<std::string, 5>>;

inline Lines lines_of(const Table& table) {
  Lines out;
  for (const auto& [name, hashes] : table) {
    std::array<std::string, 5>& line = out[name];
    line[0] = std::to_string(hashes[without_meshes].rows + hashes[on_meshes].rows);
    for (std::size_t part = 0; part < hashes.size(); ++part) line[part + 1] = hashes[part].text();
  }
  return out;
}

inline std::string to_text(const Lines& lines) {
  std::string out;
  for (const auto& [name, line] : lines) {
    out += name;
    for (const std::string& field : line) out += ";" + field;
    out += "\n";
  }
  return out;
}

/// Throws Error naming the file where it is none.
inline Lines read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Lines out;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ';');) fields.push_back(field);
    std::array<std::string, 5> hashes;
    if (fields.size() != 7)
      throw Error(path, "this line is none of its format: " + line, "renew it");
    std::copy(fields.begin() + 2, fields.end(), hashes.begin());
    out[fields[0] + ";" + fields[1]] = hashes;
  }
  if (out.empty()) throw Error(path, "it has no counts", "name the file of counts");
  return out;
}

/// The studies and methods whose hash of this part the file has otherwise, or not.
inline std::vector<std::string> differences(const Lines& file, const Table& measured, Part part) {
  std::vector<std::string> out;
  for (const auto& [name, hashes] : measured) {
    const auto at = file.find(name);
    const std::string expected = at == file.end() ? "-" : at->second[part + std::size_t{1}];
    if (hashes[part].text() != expected) out.push_back(name);
  }
  return out;
}

}  // namespace farcull::native_counts
