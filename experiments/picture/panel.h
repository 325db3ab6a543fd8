// Images with words, and panels: a panel of a picture with what it shows, the parts of every panel,
// and the panel of --view-depth, the depth that a method stores in one of its views.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/gl/picture/picture.h"
#include "core/view/view.h"
#include "experiments/measure/harness.h"
#include "experiments/method/run.h"
#include "experiments/scenes/scene_file.h"

namespace farcull {

// ---- the arguments of `farcull picture` as values ----

struct PictureArguments {
  std::vector<std::string> scene;  // as load_scene()
  bool self = false;               // every object is tested against itself as well
  std::optional<long> frame;       // of a scene that moves; empty: the scene without frames
  std::optional<FrameRange>
      frames;  // of the motion; default 30 frames, or the one of numbered meshes
  std::vector<RunOptions>
      panels;         // a panel each, side by side; verify and device are not looked at
  std::string view;   // direction that the eye looks along, as parse_view(); "":
                      // obliquely down on the side that +z points to
  std::string up;     // upwards in the picture: x, -x, ... z, -z; "": y
  bool zoom = false;  // only what collides
  std::optional<std::string> depth_view;  // instead: the depth that is stored in this view of the
                                          // method's, and what the view culls, over it
  int width = 900, height = 760;          // px of a panel's picture, 64 to kMostPicture
};

/// At most so many panels.
constexpr std::size_t kMostPanels = 6;

/// The arguments as a command line, without -o.
std::string command_of(const PictureArguments& arguments);

/// Throws Error naming the option where one is out of range or options do not go together. Reads no
/// scene, opens no device.
void validate(const PictureArguments& arguments);

/// The view of the picture: an eye sees its image so, right, up and forward of a right-handed
/// world. Throws Error naming --up where that is the direction of sight.
View camera(const PictureArguments& arguments);

/// The frames of the motion that arguments.frame is one of. Precondition: a frame is given.
FrameRange frames_of(const PictureArguments& arguments);

// ---- images and panels ----

// Images with words: lettering, panels side by side with titles above and legends below, and PNG.
//
// The letters are DejaVu Sans, drawn by FreeType without hinting. The font is part of the program
// (Debian's fonts-dejavu-core, as it was when the program was built), so that a picture does not
// depend on the fonts of the machine that draws it.

struct TextStyle {
  double height = 14;  // px of a capital letter
  bool bold = false;
  Rgba colour = {30, 30, 34, 255};
};

/// px from the left end of the first letter to the place of a letter after the last one. Throws
/// Error where FreeType refuses the font.
double text_width(const std::string& text, const TextStyle& style);

/// Draws the text with the left end of its baseline at (x, baseline), in px from the left and the
/// top. What lies outside the image is cut off. UTF-8; a letter that the font lacks and a byte that
/// is no UTF-8 are drawn as '?'. Throws as text_width().
void draw_text(Image& image, double x, double baseline, const std::string& text,
               const TextStyle& style);

/// The text, or as much of it as fits into `width` px, with "…" at its end.
std::string text_that_fits(const std::string& text, const TextStyle& style, double width);

/// "DejaVu Sans 2.37, FreeType 2.12.1": what the pixels of a text depend on.
std::string lettering_version();

struct LegendEntry {
  enum class Sign { box, ring, ramp } sign = Sign::box;
  Rgba colour;  // of a ramp: its dark end
  std::string text;
  Rgba light = {};  // of a ramp: its other end
};

struct SheetPanel {
  std::string title;
  std::string headline;  // what the panel came to
  Rgba headline_colour;
  Image image;  // opaque; that of every panel of the same size
  std::vector<LegendEntry> legend;
  int left = 0, top = 0;  // where compose() has put the image in the sheet
};

/// Lays `above` over `below`, which is opaque and of the same size, with that opacity.
void lay_over(Image& below, const Image& above, double opacity);

/// A circle around (x, y), px from the left and the top, with a light line on both sides of it.
void draw_ring(Image& image, double x, double y, double radius, double line, const Rgba& colour);

/// Height of the letters that go with a panel of this width, px: legible at half of it.
double letter_height(int panel_width);

/// The sheet: title and subtitle, the panels (at least one), a line of small print. Texts that are
/// too long are cut.
Image compose(const std::string& title, const std::string& subtitle,
              std::vector<SheetPanel>& panels, const std::string& small_print);

/// Keyword (1 to 79 printable ASCII characters) and text, in UTF-8; in the order of the file.
using PngTexts = std::vector<std::pair<std::string, std::string>>;

/// The bytes of a PNG of 8 bits a channel: RGB where every pixel is opaque, else RGBA; texts as
/// tEXt, those beyond ASCII as iTXt. The same image and texts give the same bytes with the same
/// libpng. Throws Error where libpng refuses. Precondition: the image has a pixel.
std::string to_png(const Image& image, const PngTexts& texts);

// Files of Debian that are part of the program: the font of pictures, and three.js, a library for
// WebGL in browsers (libjs-three).

/// DejaVu Sans, or its bold.
std::string_view font_file(bool bold);

/// All three are empty where the program was built without three.js.
struct ThreeJs {
  std::string_view library;   // three.min.js
  std::string_view controls;  // OrbitControls.js: the mouse and fingers turn and move the camera
  std::string_view licence;   // the file of Debian that says whose it is and on which terms
};
ThreeJs three_js();

/// The colour of missed pairs, with full opacity and unshaded, and of nothing else.
constexpr Rgba kMissedColour = {220, 0, 90};
/// Colours of triangles that collide, and of those that a method kept although they do not.
constexpr Rgba kFoundColour = {0, 128, 116}, kIdleColour = {240, 176, 32};
constexpr double kIdlePart = 0.6;  // of kIdleColour in the colour of such a triangle's object
constexpr double kThrough = 0.28;  // how strongly collisions shine through what hides them
/// Colours of the objects, in turn: pale, so that nothing but what collides has a strong colour.
constexpr std::array<Rgba, 8> kObjectColours = {{{176, 190, 210},
                                                 {218, 214, 206},
                                                 {186, 203, 184},
                                                 {216, 204, 180},
                                                 {196, 190, 214},
                                                 {180, 206, 208},
                                                 {222, 190, 168},
                                                 {214, 192, 198}}};

/// The counts and words of a panel. Pairs of neighbours count with the others.
struct PanelResult {
  std::string title;                   // "cullide at 128 px"
  std::string headline;                // "missed 12 of 4,268 colliding pairs"
  std::uint64_t colliding = 0;         // pairs, by the exact method
  std::uint64_t neighbours = 0;        // of these, pairs of neighbours
  std::uint64_t missed = 0;            // of them, not found by the method (in a view of depth_view:
                                       // with a culled triangle)
  std::uint64_t missed_triangles = 0;  // in one of those
  std::uint64_t kept = 0;              // triangles; 0 for exact, which culls none
  std::uint64_t idle = 0;              // of them, in no collision
  std::uint64_t rings = 0;             // drawn around misses that are too small to be seen
  std::uint64_t first_pass = 0, second_pass = 0, culled = 0;  // of depth_view: triangles fully
                                                              // visible in that pass alone, in both
  bool broken = false;                           // the method promises, and missed a pair
  std::string device;                            // what answered: a renderer, "cpu", or "none"
  int left = 0, top = 0, width = 0, height = 0;  // of its picture in the image, px
};

/// A panel of the picture, and what it shows.
struct DrawnPanel {
  SheetPanel sheet;
  PanelResult result;
};
/// The width of lines, px, which follows the size of the picture.
double line_of(const Window& window);
/// The triangles alone, on a transparent image.
Image painted(const GlContext& context, const Scene& scene, const Window& window,
              const std::vector<PictureTriangle>& triangles);
/// Draws the missed triangles over the image, with rings where they are too small to be seen, and
/// says how many rings.
std::uint64_t draw_missed(const GlContext& context, const Scene& scene, const Window& window,
                          const std::vector<std::uint32_t>& missed, Image& image);
/// "far, exact offset": what tells methods apart, without a resolution.
std::string method_title(const RunOptions& options);
/// "far, exact offset, at 128 px".
std::string panel_title(const RunOptions& options);
/// "missed 12 of 4,268 colliding pairs".
std::string headline_of(const PanelResult& result, const std::string& verb);
/// The title and the headline of the result over the panel, and the colour of the latter.
void set_heading(DrawnPanel& panel);
/// A line of the legend that explains a colour; and one that explains the rings, if there are any.
void explain(DrawnPanel& panel, Rgba colour, const std::string& text);
void explain_rings(DrawnPanel& panel, const std::string& text);

/// The panel of arguments.depth_view: run, depths and picture. Throws Error where the method draws
/// no depth, or nothing is drawn in the view.
DrawnPanel depth_panel(const RunOptions& options, const PictureArguments& arguments,
                       const Scene& scene, const Truth& truth, Session& session,
                       const GlContext& context);

}  // namespace farcull
