// A chapter of the report: the figures, tables and findings of one study, as values. Chapters are
// made from the store alone, so no number of a report was typed; report.h writes them as files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/picture/arguments.h"
#include "experiments/studies/store.h"

namespace farcull {

/// Points of one line or cloud of a plot. x and y have one length. NaN: a gap in the line.
/// Style::area is the polygon with these corners, filled lightly within its line.
struct Series {
  std::string name;  // in the key of the plot; plain text
  std::vector<double> x = {}, y = {};
  enum class Style { lines_points, lines, points, area } style = Style::lines_points;
  bool emphasis = false;  // drawn thick: ours, or the one that the figure is about
  /// Intervals along an axis, drawn as bars: both of the length of x, or both empty. NaN: no bar.
  std::vector<double> x_low = {}, x_high = {}, y_low = {}, y_high = {};
};

/// A vertical or horizontal line, such as the budget radius. The key names it.
struct Mark {
  bool vertical = true;
  double at = 0;
  std::string name;
};

/// log10 of what is 0 or less does not exist. A logarithmic axis that shows zeros is linear from 0
/// to 1 (where values are below 1: to a power of ten below them all) and logarithmic beyond. The
/// linear part is shaded, and the figure says so.
struct Axis {
  std::string label;  // with the unit in brackets, "time (ms)"
  bool logarithmic = false;
  bool shows_zero = false;  // of a logarithmic axis: see above
  std::optional<double> from = {}, to = {};
};

inline Axis logarithmic(std::string label, bool shows_zero = false) {
  return {.label = std::move(label), .logarithmic = true, .shows_zero = shows_zero};
}

/// Panels stand side by side or below each other under one title, and share one key of names where
/// these agree.
struct Panel {
  std::string title;
  Axis x = {}, y = {};
  std::vector<Series> series = {};
  std::vector<Mark> marks = {};
  /// A drawing and no plot: without axes, grid and numbers. A unit of x is drawn as long as one of
  /// y, so that shapes are true. It has no marks, and nothing is set in its axes.
  bool drawing = false;
};

struct Figure {
  std::string name;  // of its files, such as "accuracy"; [a-z0-9-]
  std::string title;
  std::string caption = {};  // what it shows, with numbers from the rows
  std::vector<Panel> panels = {};
};

struct Column {
  std::string name;
  enum class Side { left, right } side = Side::right;  // where the cells stand
};
/// Columns of text stand on the left, columns of numbers on the right.
inline Column text_column(std::string name) { return {std::move(name), Column::Side::left}; }

struct DataTable {
  std::string name;  // of its files; [a-z0-9-]
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows = {};  // for people: numbers grouped and rounded
  bool in_text = true;  // shown in the page and in LaTeX; false: long, so linked as CSV alone
};

/// The counts of the rows that a panel of a picture shows.
struct PanelCounts {
  std::string method;  // in words
  std::optional<double> missed, colliding;
};

struct Picture {
  std::string name;     // of its PNG
  std::string caption;  // without its counts: these are of the picture that is drawn
  PictureArguments arguments = {};
  std::vector<PanelCounts> panels = {};  // from the left
};

/// A file of the report that is made for programs.
struct TextFile {
  std::string name;  // in the report's folder
  std::string text;
};

/// One sentence with numbers from the rows.
struct Finding {
  enum class Kind { result, broken } kind = Kind::result;  // broken: a promise was not kept
  std::string text;
};
inline Finding broken_promise(std::string text) { return {Finding::Kind::broken, std::move(text)}; }
inline bool is_broken(const Finding& finding) { return finding.kind == Finding::Kind::broken; }
/// As the report prints it: "BROKEN: " stands before a broken promise.
inline std::string printed(const Finding& finding) {
  return (is_broken(finding) ? "BROKEN: " : "") + finding.text;
}

struct Chapter {
  std::string study;
  std::string title;
  std::string question;
  std::vector<Finding> findings;
  std::vector<std::string> limits;  // what the study does not show
  std::vector<Figure> figures;
  std::vector<DataTable> tables;
  std::string command;  // that measures it again
  std::vector<Picture> pictures = {};
  std::vector<TextFile> files = {};

  void find(std::string text) { findings.push_back({Finding::Kind::result, std::move(text)}); }
  void find_broken(std::string text) { findings.push_back(broken_promise(std::move(text))); }
};

/// The chapter of one study, each in a file of its own, from its rows: all, or those that are
/// there.
Chapter scenes_chapter(const StoredStudy& stored);
Chapter accuracy_chapter(const StoredStudy& stored);
Chapter error_time_chapter(const StoredStudy& stored);
Chapter radius_chapter(const StoredStudy& stored);
Chapter offsets_chapter(const StoredStudy& stored);
Chapter precision_chapter(const StoredStudy& stored);
Chapter stability_chapter(const StoredStudy& stored);
Chapter culling_chapter(const StoredStudy& stored);
Chapter cloth_chapter(const StoredStudy& stored);
Chapter efficiency_chapter(const StoredStudy& stored);
Chapter scaling_chapter(const StoredStudy& stored);
Chapter libraries_chapter(const StoredStudy& stored);
Chapter proximity_chapter(const StoredStudy& stored);

}  // namespace farcull
