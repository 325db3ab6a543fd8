// `farcull report`: writes the content of a store as figures, tables and one page.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/method/run.h"
#include "experiments/picture/panel.h"
#include "experiments/report/page.h"

namespace farcull {

/// Writes the picture as a PNG to the path and returns its panels in their order. Throws Error
/// where it cannot (no device, no meshes): the page then says why the picture is left out.
using PictureMaker = std::function<std::vector<PanelResult>(const PictureArguments& arguments,
                                                            const std::string& path)>;

/// Writes a page of the picture's scene (experiments/picture/page.h) to the path, and returns a
/// line for each answer in it that breaks a promise. Throws Error where it cannot: the picture is
/// then shown without one.
using PageMaker = std::function<std::vector<std::string>(const PictureArguments& arguments,
                                                         const std::string& path)>;

struct ReportRequest {
  std::string folder;  // of the store
  PictureMaker draw_picture;
  PageMaker make_page = {};  // empty: no pages
  Progress progress = {};
};

struct ReportSummary {
  std::string folder;  // of the report
  std::size_t studies = 0, figures = 0, tables = 0, pictures = 0, pages = 0;
  std::vector<std::string>
      notes;  // studies that are incomplete, pictures and pages that are left out
  /// Rows of methods that promise and missed, and findings that tell of a promise that was not
  /// kept. Empty, or the worst has happened; the report is written all the same and says so.
  std::vector<std::string> broken;
};

/// The path of the store in the folder. Throws Error where there is none: with what to do where
/// there are shards that are not merged.
std::string store_of(const std::string& folder);

/// Writes FOLDER/report: index.html, results.md, figures/NAME.{svg,pdf,gp,dat},
/// tables/NAME.{csv,tex} and STUDY-rows.csv, pictures/NAME.png,
/// pages/NAME.html. It appears whole or not at all, in
/// place of an earlier report; any other folder of that name is left alone. Throws Error as
/// store_of() and Store, where nothing was measured, where gnuplot is missing or says anything, and
/// where the disk refuses.
ReportSummary write_report(const ReportRequest& request);

}  // namespace farcull
