// Options of `farcull report`, and its summary on standard output.
#include "experiments/command/report.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "core/base/error.h"
#include "experiments/command/options.h"
#include "experiments/command/studies.h"
#include "experiments/picture/picture.h"
#include "experiments/report/report.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"

namespace farcull {

CLI::App* ReportCommand::add_to(CLI::App& app) {
  folder_ = kResultsFolder;
  CLI::App* command = add_command(app, "report", "figures, tables and a page of what was measured");
  add_option(*command, "DIR", folder_, "",
             fmt::format("the folder of the results; default {}", kResultsFolder));
  add_option(*command, "--device", device_, "DEVICE", kDeviceHelp);
  add_flag(*command, "--no-pictures", no_pictures_,
           "leave out the pictures of scenes, for which methods are\nrun");
  add_footer(
      *command,
      "Writes DIR/report: index.html, one page that needs nothing else; figures as SVG and PDF "
      "with\n"
      "their gnuplot scripts and data; tables as CSV and LaTeX. An earlier report there is "
      "replaced.\n\n"
      "Examples:\n"
      "  farcull experiment all --quick && farcull report\n"
      "  farcull report results");
  return command;
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
  ReportRequest request;
  request.folder = folder_;
  request.progress = terminal.callback();
  request.draw_picture = [&](const PictureArguments& arguments,
                             const std::string& path) -> std::vector<PanelResult> {
    if (no_pictures_) throw Error("--no-pictures", "was given", "leave it out");
    if (!lab) lab.emplace(device_of(device_), request.progress);
    return write_picture(arguments, *lab, path).panels;
  };
  const ReportSummary summary = write_report(request);
  terminal.clear();
  std::string text;
  for (const std::string& note : summary.notes) text += note + "\n";
  text += fmt::format(
      "{}, {}, {}, {}\n{}/index.html\n", counted(summary.studies, "study", "studies"),
      counted(summary.figures, "figure", "figures"), counted(summary.tables, "table", "tables"),
      counted(summary.pictures, "picture", "pictures"), summary.folder);
  write_output("-", text);
  for (const std::string& broken : summary.broken)
    complain_broken("a promise is broken: " + broken);
  return summary.broken.empty() ? 0 : 1;
}

}  // namespace farcull
