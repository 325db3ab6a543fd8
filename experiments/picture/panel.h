// Images with text, and the panels of a picture.
#pragma once

#include "core/gl/picture/picture.h"
#include "core/view/view.h"
#include "experiments/measure/harness.h"
#include "experiments/method/run.h"
#include "experiments/scenes/frames.h"
#include "experiments/scenes/scene_file.h"

namespace farcull {

/// The arguments of `farcull picture`.
struct PictureArguments {
  SceneArguments scene;
  bool self = false;          // also tests every object against itself
  std::optional<long> frame;  // frame number of a moving scene; empty: the scene does not move
  // The frames of the motion. Default: 30 frames, or for numbered meshes only `frame`.
  std::optional<FrameRange> frames;
  std::vector<RunOptions> panels;  // one per panel; verify and device are not used
  std::string view;                // viewing direction, for parse_view(); "": obliquely down onto
                                   // the side that faces +z
  std::string up;                  // upward direction in the picture: x, -x, ... z, -z; "": y
  bool zoom = false;               // true: shows only the region of the colliding triangles
  int width = 900, height = 760;   // px, size of a panel's picture; 64 to kMostPicture
};

constexpr std::size_t kMostPanels = 6;

/// Returns the command line of these arguments, without -o.
std::string command_of(const PictureArguments& arguments);

/// Throws Error naming the option if a value is out of range, or if options exclude each other.
/// Reads no scene and opens no device.
void validate(const PictureArguments& arguments);

/// Returns the view of the picture. Its axes right, up and backward are right-handed, so the image
/// is not mirrored. Throws Error naming --up if arguments.up is parallel to the viewing direction.
View camera(const PictureArguments& arguments);

/// Returns the frames of the motion. Precondition: arguments.frame is not empty.
FrameRange frames_of(const PictureArguments& arguments);

// The functions below draw text, compose panels with titles and legends into a sheet, and write PNG
// files. Pango and cairo draw text in the font DejaVu Sans, without hinting. If the system lacks
// this font, fontconfig chooses another font.

struct TextStyle {
  double height = 14;  // height of a capital letter, px
  bool bold = false;
  Rgba colour = {30, 30, 34, 255};
};

/// Draws a UTF-8 text. The baseline begins at (x, baseline), in px from the left and top edges. An
/// invalid byte is drawn as U+FFFD. Text beyond the edge of the image is cut. Text wider than
/// `room` px is cut and ends with "…".
void draw_text(Image& image, double x, double baseline, const std::string& text,
               const TextStyle& style, double room);

/// Returns the names of font and libraries: "DejaVu Sans, pango 1.50.12, cairo 1.16.0".
std::string lettering_version();

struct LegendEntry {
  enum class Sign { box, ring } sign = Sign::box;
  Rgba colour;
  std::string text;
};

struct SheetPanel {
  std::string title;
  std::string headline;  // the panel's result
  Rgba headline_colour;
  Image image;  // opaque; all panels have the same size
  std::vector<LegendEntry> legend;
  int left = 0, top = 0;  // position of the image in the sheet, px; set by compose()
};

/// Blends `above` over `below`, after multiplying the opacity of `above` by `opacity`.
/// Preconditions: `below` is opaque, and the two images have the same size.
void lay_over(Image& below, const Image& above, double opacity);

/// Draws a circle with light outlines. (x, y): its centre, in px from the left and top edges.
void draw_ring(Image& image, double x, double y, double radius, double line, const Rgba& colour);

/// Returns a sheet with title and subtitle, the panels (at least one), and a line of small print.
/// Texts that are too long are cut.
Image compose(const std::string& title, const std::string& subtitle,
              std::vector<SheetPanel>& panels, const std::string& small_print);

/// Pairs of a keyword (1 to 79 printable ASCII characters) and a text (UTF-8).
using PngTexts = std::vector<std::pair<std::string, std::string>>;

/// Returns the bytes of a PNG with 8 bits each for red, green and blue. ASCII texts become tEXt
/// chunks, and other texts become iTXt chunks. The same image, texts and version of cairo give the
/// same bytes. Throws Error if cairo fails. Precondition: the image has pixels, and all pixels are
/// opaque.
std::string to_png(const Image& image, const PngTexts& texts);

/// The colour of missed pairs. Nothing else is drawn in this colour.
constexpr Rgba kMissedColour = {220, 0, 90};
/// kFoundColour: colliding triangles. kIdleColour: triangles that a method kept although they do
/// not collide.
constexpr Rgba kFoundColour = {0, 128, 116}, kIdleColour = {240, 176, 32};
constexpr double kIdlePart = 0.6;  // weight of kIdleColour when mixed with the object's colour
constexpr double kThrough = 0.28;  // opacity of colliding triangles drawn over triangles in front
/// Colours of the objects, used in turn. All are pale, so that only collisions have strong colours.
constexpr std::array<Rgba, 8> kObjectColours = {{{176, 190, 210},
                                                 {218, 214, 206},
                                                 {186, 203, 184},
                                                 {216, 204, 180},
                                                 {196, 190, 214},
                                                 {180, 206, 208},
                                                 {222, 190, 168},
                                                 {214, 192, 198}}};

/// The counts and texts of a panel. `colliding` and `missed` include pairs of neighbours.
struct PanelResult {
  std::string title;                             // "cullide at 128 px"
  std::string headline;                          // "missed 12 of 4,268 colliding pairs"
  std::uint64_t colliding = 0;                   // number of colliding pairs, by the method `exact`
  std::uint64_t neighbours = 0;                  // number of colliding pairs of neighbours
  std::uint64_t missed = 0;                      // colliding pairs that the method missed
  std::uint64_t missed_triangles = 0;            // triangles in at least one missed pair
  std::uint64_t kept = 0;                        // triangles that the method kept; 0 for `exact`
  std::uint64_t idle = 0;                        // kept triangles that do not collide
  std::uint64_t rings = 0;                       // number of rings around small missed triangles
  bool drew = false;                             // the method rendered views
  bool broken = false;                           // a method with a guarantee missed a pair
  std::string device;                            // name of the GL renderer used, "cpu", or "none"
  int left = 0, top = 0, width = 0, height = 0;  // place of the panel's picture in the image, px
};

struct DrawnPanel {
  SheetPanel sheet;
  PanelResult result;
};
/// Returns the width of drawn lines, in px, for a picture of this size.
double line_of(const Window& window);
/// Returns an image of the triangles on a transparent background.
Image painted(const GlContext& context, const Scene& scene, const Window& window,
              const std::vector<PictureTriangle>& triangles);
/// Draws the missed triangles over the image. Draws rings around missed triangles that are too
/// small to see, and returns the number of rings.
std::uint64_t draw_missed(const GlContext& context, const Scene& scene, const Window& window,
                          const std::vector<std::uint32_t>& missed, Image& image);
/// Returns the method and its options without the resolution: "far, exact offset".
std::string method_title(const RunOptions& options);
/// Returns the title of a panel: "far, exact offset, at 128 px".
std::string panel_title(const RunOptions& options);
/// Returns the headline: "missed 12 of 4,268 colliding pairs".
std::string headline_of(const PanelResult& result);
/// Sets the panel's title, headline and colour of the headline.
void set_heading(DrawnPanel& panel);
/// Adds a line to the legend: a box of this colour, and the text.
void explain(DrawnPanel& panel, Rgba colour, const std::string& text);
void explain_rings(DrawnPanel& panel, const std::string& text);

}  // namespace farcull
