// Turns the options of `farcull picture` into PictureArguments, and writes the result to a file or
// standard output.
#include "experiments/command/command.h"

#include <fmt/format.h>

#include <filesystem>

#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

namespace fs = std::filesystem;

// Reads a size in px, such as "900x760". Rounds both sides up to even numbers, as Window needs.
void parse_size(const std::string& text, int& width, int& height) {
  std::string_view rest = text;
  const std::optional<int> wide = take_number<int>(rest);
  const bool by = rest.starts_with('x');
  const std::optional<int> high = parse_number<int>(rest.substr(by ? 1 : 0));
  if (!wide || !by || !high) {
    throw Error("--size", "'" + text + "' is no size",
                "give the width and height of a panel in px, as in 900x760");
  }
  width = *wide + *wide % 2;
  height = *high + *high % 2;
}

// Reads a method, such as "far", or a method with a resolution, such as "far:128".
RunOptions parse_panel(const std::string& text, const RunOptions& usual) {
  RunOptions options = usual;
  const std::size_t colon = text.find(':');
  options.method = parse_method(text.substr(0, colon), "{compare}");
  const bool takes = draws(options.method);
  if (!takes) options.resolution = 0;
  if (colon == std::string::npos) return options;
  if (!takes) {
    throw Error("--compare", to_string(options.method) + " has no resolution",
                "leave out what follows the colon");
  }
  options.resolution = parse_resolution(text.substr(colon + 1), "--compare");
  return options;
}

}  // namespace

CLI::App* PictureCommand::add_to(CLI::App& app) {
  return add_command(
      app, "picture", "what a method finds and misses, as a picture (PNG) or a page",
      scene_rows(scene_) +
          Rows{{"-o,--output", &output_, "FILE", "where the PNG goes; - for standard output"},
               {"--method", &method_, "METHOD", "as farcull run takes it; default boxes"},
               {"--compare", &compare_, "LIST",
                "several methods, a panel each, by commas, each perhaps\nwith a resolution: "
                "cullide:128,far:128"},
               {"--resolution", &resolution_, "N", "px, as farcull run takes it"},
               {"--radius", &radius_, "RADIUS", "for far: budget, published, or a factor"},
               {"--offset", &offset_, "OFFSET", "for far: obb or exact; default obb"},
               {"--depth", &depth_, "fragment|fixed", "for far; default fragment"},
               {"--device", &device_, "DEVICE", help_of_option("device")},
               {"--self", &self_, "", help_of_option("self")},
               ignore_row(scene_.ignore),
               {"--frame", &frame_, "F", "of a scene that moves"},
               {"--frames", &frames_, "N|A:B",
                "of the motion that F is one of; default 30 of a\nbuilt-in scene"},
               {"--view", &view_, "DIR",
                "direction that the picture looks along, as in -z or\n-1:-1:-2; default "
                "-0.45:-0.35:-0.82"},
               {"--up", &up_, "AXIS", "upwards in the picture; default y"},
               {"--zoom", &zoom_, "", "show only where something collides"},
               {"--html", &html_, "FILE",
                "a page to look into the answers: one file that opens in\nany browser and needs no "
                "network"},
               {"--resolutions", &resolutions_, "LIST",
                "with --html: px, by commas, that the reader steps\nthrough, of "
                "methods without a resolution of their own;\ndefault 32,64,128,256,512"},
               {"--size", &size_, "WxH", "px of a panel; default 900x760"}},
      "Examples:\n"
      "  farcull picture two-bunnies --method cullide --resolution 128 -o missed.png\n"
      "  farcull picture two-bunnies --compare cullide,far --resolution 256 -o compare.png\n"
      "  farcull picture two-bunnies --compare cullide:128,cullide:512,far:128 --zoom -o c.png\n"
      "  farcull picture mannequin-devil --method s-cullide --self -o self.png\n"
      "  farcull picture cloth --frame 100 --frames 101 --up z -o cloth.png\n"
      "  farcull picture two-bunnies --compare cullide,far --html bunnies.html\n"
      "\n"
      "Exit status 1: a method that promises missed a pair; the picture shows it.");
}

PictureArguments PictureCommand::arguments() const {
  PictureArguments out;
  out.scene = scene_;
  out.self = self_;
  out.zoom = zoom_;
  if (frame_) {
    out.frame =
        number_of("--frame", *frame_, "no frame", 0L, 1'000'000'000L, "give its number, 0 or more");
  }
  if (frames_) out.frames = parse_frames(*frames_);
  if (size_) parse_size(*size_, out.width, out.height);
  for (const auto& [option, text] : {std::pair("--view", view_), std::pair("--up", up_)}) {
    if (text && text->empty())
      throw Error(option, "its value is empty", "give a direction, as in -z");
  }
  out.view = view_.value_or("");
  out.up = up_.value_or("");

  RunOptions usual{.device = device_of(device_), .verify = false};  // options of all panels
  for (const auto& [name, text] :
       {std::pair("resolution", resolution_), std::pair("radius", radius_),
        std::pair("offset", offset_), std::pair("depth", depth_)}) {
    if (text) take_option(name, *text, usual);
  }
  if (method_ && compare_)
    throw Error("--compare", "names the methods, and so does --method", "give one of the two");
  bool far = false;
  for (const std::string& word :
       split_list(compare_.value_or(method_.value_or(to_string(kDefaultMethod))))) {
    if (compare_) {
      out.panels.push_back(parse_panel(word, usual));
    } else {
      usual.method = parse_method(word);
      if (usual.resolution > 0 && !draws(usual.method)) {
        throw Error("--resolution", "has no meaning for --method " + word,
                    "leave --resolution out");
      }
      out.panels.push_back(usual);
    }
    RunOptions& options = out.panels.back();
    far |= fattens(options.method);
    if (!fattens(options.method)) {
      options.radius = {};
      options.offset = "obb";
      options.depth.reset();
    }
  }
  if (!far) {
    refuse_given({{"--radius", radius_.has_value()},
                  {"--offset", offset_.has_value()},
                  {"--depth", depth_.has_value()}},
                 "has a meaning for far alone", "leave it out, or use --method far");
  }
  validate(out);
  return out;
}

PageArguments PictureCommand::page_arguments(const PictureArguments& picture) const {
  PageArguments out;
  out.picture = picture;
  std::vector<int> resolutions(kPageResolutions.begin(), kPageResolutions.end());
  if (resolutions_) {
    resolutions.clear();
    for (const std::string& word : split_list(*resolutions_))
      resolutions.push_back(parse_resolution(word, "--resolutions"));
  }
  bool used = false;
  for (const RunOptions& panel : picture.panels) {
    const bool steps = draws(panel.method) && panel.resolution == 0;
    used |= steps;
    const std::vector<RunOptions> each =
        steps ? at_resolutions({panel}, resolutions) : std::vector{panel};
    out.steps.insert(out.steps.end(), each.begin(), each.end());
  }
  if (resolutions_ && !used) {
    throw Error("--resolutions", "every method has a resolution of its own, or needs none",
                "leave it out");
  }
  for (const RunOptions& options : out.steps) validate(options);
  return out;
}

int PictureCommand::run() const {
  const PictureArguments arguments = this->arguments();
  if (resolutions_ && !html_)
    throw Error("--resolutions", "has a meaning for a page alone", "give --html FILE as well");
  check_scene(arguments.scene.names);
  std::optional<FrameRange> range = arguments.frames;
  if (arguments.frame && !range) range = FrameRange{*arguments.frame, *arguments.frame};
  const std::vector<NamedFile> inputs = scene_files(arguments.scene.names, range);
  if (!html_ && (!output_ || output_->empty())) {
    throw Error("-o", "it does not say where the picture goes",
                "give -o FILE.png, or -o - for standard output, or --html FILE for a page");
  }
  const Outputs outputs = checked({.picture = output_, .page = html_}, inputs);
  if (outputs.page == "-")
    throw Error("--html", "a page does not go to standard output", "give --html FILE.html");
  const std::string ending = output_ ? fs::path(*output_).extension().string() : "";
  if (!ending.empty() && lower_case(ending) != ".png") {
    throw Error("-o", "'" + *output_ + "' is not named like a PNG, the only format that is written",
                "give -o " + fs::path(*output_).replace_extension(".png").string());
  }
  if (outputs.picture == "-" && is_terminal(stdout)) {
    throw Error("-o", "standard output is a terminal, which shows no PNG",
                "let it go somewhere, or give -o FILE.png");
  }
  PageArguments page_arguments;
  if (html_) {
    page_arguments = this->page_arguments(arguments);
    require_three();
  }
  TerminalProgress terminal;
  MeasurementContext lab(arguments.panels.front().device, terminal.callback());
  require_asked(open_scene(arguments, lab), {});
  if (html_) require_page_size(page_arguments, lab);
  const PictureResult result = make_picture(arguments, lab);
  if (outputs.picture) write_output(*outputs.picture, to_png(result.image, result.texts));
  PageResult page;
  if (html_) {
    page = make_page(page_arguments, result, lab);
    write_output(*outputs.page, page.html);
  }
  terminal.clear();
  int status = kExitDone;
  std::string lines;
  for (const PanelResult& panel : html_ ? page.steps : result.panels) {
    lines += panel.title + ": " + panel.headline + "\n";
    if (!panel.broken) continue;
    status = kExitBroken;
    complain_broken(
        fmt::format("{} culled pairs that collide: {}", panel.title, grouped(panel.missed)));
  }
  if (outputs.picture != "-") {
    lines += result.not_asked;
    if (outputs.picture) lines += "The picture is in " + clean_name(*outputs.picture) + "\n";
    if (html_) {
      lines += fmt::format("The page is in {} ({:.1f} MB)\n", clean_name(*outputs.page),
                           static_cast<double>(page.html.size()) / 1e6);
    }
    print(lines);
  }
  return status;
}

Command add_picture(CLI::App& app) { return declare<PictureCommand>(app); }

}  // namespace farcull
