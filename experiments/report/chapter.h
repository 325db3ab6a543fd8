// What a study says: its figures, tables and findings, as values. Chapters are made from the store
// alone, so no number of a report was typed; report.h turns them into files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/studies/store.h"

namespace farcull {

/// Points of one line or cloud of a plot. x and y are of one length; lo and hi are empty or as
/// long: the bars of each y. NaN: a gap in the line.
struct Series {
  std::string name;  // in the key of the plot; plain text
  std::vector<double> x, y;
  std::vector<double> lo = {}, hi = {};
  enum class Style { lines_points, lines, points, steps } style = Style::lines_points;
  bool emphasis = false;  // drawn thick: ours, or the one that the figure is about
};

/// A vertical or horizontal line with a name, such as the budget radius.
struct Mark {
  bool vertical = true;
  double at = 0;
  std::string name;
};

/// log10 of what is 0 or less does not exist: on a logarithmic axis `zero` says where zeros are
/// drawn, on a line of their own below the smallest power that the plot shows, labelled 0.
struct Axis {
  std::string label;  // with the unit
  bool logarithmic = false;
  bool shows_zero = false;  // of a logarithmic axis: see above
  std::optional<double> from = {}, to = {};
};

/// Panels stand side by side or below each other under one title, and share one key of names where
/// these agree.
struct Panel {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  std::vector<Mark> marks = {};
};

struct Figure {
  std::string name;  // of its files, such as "accuracy"; [a-z0-9-]
  std::string title;
  std::string caption;  // what it shows, with numbers from the rows
  std::vector<Panel> panels;
};

struct DataTable {
  std::string name;  // of its files; [a-z0-9-]
  std::string caption;
  std::vector<std::string> columns;
  std::string alignment;                       // one letter a column: l or r
  std::vector<std::vector<std::string>> rows;  // for people: numbers grouped and rounded
  bool in_text = true;  // shown in the page and in LaTeX; false: long, so linked as CSV alone
};

/// What the rows say of a panel of a picture.
struct PanelCounts {
  std::string method;  // in words
  std::optional<double> missed, colliding;
};

struct Picture {
  std::string name;     // of its PNG
  std::string caption;  // without its counts: these are of the picture that is drawn
  std::string command;  // that makes it: arguments of farcull picture, without -o
  std::vector<PanelCounts> panels = {};  // from the left
};

/// How a finding begins that tells of a promise that was not kept.
inline constexpr const char* kBroken = "BROKEN:";
inline bool is_broken(const std::string& finding) { return finding.starts_with(kBroken); }

struct Chapter {
  std::string study;
  std::string title;
  std::string question;
  std::vector<std::string> findings;  // a sentence each, with numbers from the rows
  std::vector<std::string> limits;    // what the study does not show
  std::vector<Figure> figures;
  std::vector<DataTable> tables;
  std::string command;  // that measures it again
  std::vector<Picture> pictures = {};
};

/// The chapter of a study from its rows, all or those that are there. A finding that is_broken()
/// stands before all others.
using ChapterOf = Chapter (*)(const StoredStudy&);
Chapter chapter_of(const StoredStudy& stored);

/// Each in a file of its own.
Chapter accuracy_chapter(const StoredStudy& stored);
Chapter error_time_chapter(const StoredStudy& stored);
Chapter radius_chapter(const StoredStudy& stored);
Chapter offsets_chapter(const StoredStudy& stored);
Chapter precision_chapter(const StoredStudy& stored);
Chapter stability_chapter(const StoredStudy& stored);
Chapter efficiency_chapter(const StoredStudy& stored);
Chapter scaling_chapter(const StoredStudy& stored);

}  // namespace farcull
