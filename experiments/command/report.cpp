// Options of `farcull report`, and its summary on standard output.
#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "core/base/error.h"
#include "experiments/command/options.h"
#include "experiments/picture/page.h"
#include "experiments/report/report.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

class ReportCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  int run();

 private:
  std::string folder_;
  Text device_;
  bool no_pictures_ = false;
};

CLI::App* ReportCommand::add_to(CLI::App& app) {
  folder_ = kResultsFolder;
  return add_command(
      app, "report", "figures, tables and a page of what was measured",
      {{"DIR", &folder_, "", fmt::format("the folder of the results; default {}", kResultsFolder)},
       {"--device", &device_, "DEVICE", kDeviceHelp},
       {"--no-pictures", &no_pictures_, "",
        "leave out the pictures of scenes, for which methods are\nrun"}},
      "Writes DIR/report: index.html, one page that needs nothing else; figures as SVG and PDF "
      "with\n"
      "their gnuplot scripts and data; tables as CSV and LaTeX. An earlier report there is "
      "replaced.\n\n"
      "Examples:\n"
      "  farcull experiment all --quick && farcull report\n"
      "  farcull report results");
}

int ReportCommand::run() {
  if (folder_.empty()) throw Error("DIR", "the folder is empty", "name one");
  while (folder_.size() > 1 && folder_.back() == '/') folder_.pop_back();
  // An earlier report is taken away whole, and what it holds with it.
  std::error_code error;
  const auto place = [&](const std::string& path) {
    return std::filesystem::weakly_canonical(path, error).string();
  };
  const std::string report = place(folder_ + "/report");
  if (!error && place(store_path(folder_)).starts_with(report + "/")) {
    throw Error(store_path(folder_), "leads into DIR/report, which the report replaces",
                "move the results out of it");
  }
  TerminalProgress terminal;
  std::optional<Lab> lab;
  PictureResult drawn;  // the last one, which the page of its scene holds
  ReportRequest request;
  request.folder = folder_;
  request.progress = terminal.callback();
  request.draw_picture = [&](const PictureArguments& arguments,
                             const std::string& path) -> std::vector<PanelResult> {
    if (no_pictures_) throw Error("--no-pictures", "was given", "leave it out");
    if (!lab) lab.emplace(device_of(device_), request.progress);
    drawn = write_picture(arguments, *lab, path);
    return drawn.panels;
  };
  request.make_page = [&](const PictureArguments& picture, const std::string& path) {
    require_three();
    std::vector<int> resolutions(kPageResolutions.begin(), kPageResolutions.end());
    for (const RunOptions& panel : picture.panels) {
      if (panel.resolution > 0) resolutions.push_back(panel.resolution);
    }
    const PageArguments arguments = {
        .picture = picture, .steps = at_resolutions(picture.panels, resolutions), .frames = {}};
    const PageResult page = make_page(arguments, drawn, *lab);
    write_output(path, page.html);
    std::vector<std::string> broken;
    for (const PageStep& step : page.steps) {
      if (step.result.broken) broken.push_back(step.result.title + " " + step.result.headline);
    }
    return broken;
  };
  const ReportSummary summary = write_report(request);
  terminal.clear();
  std::string text;
  for (const std::string& note : summary.notes) text += note + "\n";
  text += fmt::format(
      "{}, {}, {}, {}, {}\n{}/index.html\n", counted(summary.studies, "study", "studies"),
      counted(summary.figures, "figure", "figures"), counted(summary.tables, "table", "tables"),
      counted(summary.pictures, "picture", "pictures"), counted(summary.pages, "page", "pages"),
      summary.folder);
  write_output("-", text);
  for (const std::string& broken : summary.broken)
    complain_broken("a promise is broken: " + broken);
  return summary.broken.empty() ? 0 : 1;
}

}  // namespace

Command add_report(CLI::App& app) { return declare<ReportCommand>(app); }

}  // namespace farcull
