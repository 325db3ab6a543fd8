// Images with text, and the panels of a picture.
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
#include "experiments/scenes/frames.h"
#include "experiments/scenes/scene_file.h"

namespace farcull {

// ---- the arguments of `farcull picture` as values ----

struct PictureArguments {
  SceneArguments scene;
  bool self = false;          // every object is tested against itself as well
  std::optional<long> frame;  // of a scene that moves; empty: the scene without frames
  std::optional<FrameRange>
      frames;  // of the motion; default 30 frames, or only `frame` for numbered meshes
  std::vector<RunOptions> panels;  // one panel each, side by side; verify and device are ignored
  std::string view;                // direction that the eye looks along, as parse_view(); "":
                                   // down at an angle, at the side that faces +z
  std::string up;                  // upward direction in the picture: x, -x, ... z, -z; "": y
  bool zoom = false;               // only the colliding triangles
  int width = 900, height = 760;   // px of a panel's picture, 64 to kMostPicture
};

/// The largest number of panels.
constexpr std::size_t kMostPanels = 6;

/// The arguments as a command line, without -o.
std::string command_of(const PictureArguments& arguments);

/// Throws Error naming the option if one is out of range or options exclude each other. Reads no
/// scene, opens no device.
void validate(const PictureArguments& arguments);

/// The view of the picture. Its image is upright and not mirrored: the directions right, up and
/// backward are right-handed. Throws Error naming --up if --up is the direction of sight.
View camera(const PictureArguments& arguments);

/// The frames of the motion with arguments.frame. Precondition: a frame is given.
FrameRange frames_of(const PictureArguments& arguments);

// ---- images and panels ----

// Images with text: lettering, panels side by side with titles above and legends below, and PNG.
//
// The font is DejaVu Sans, drawn by pango and cairo without hinting; where the system lacks it,
// fontconfig chooses another one, and lettering_version() names that.

struct TextStyle {
  double height = 14;  // px of a capital letter
  bool bold = false;
  Rgba colour = {30, 30, 34, 255};
};

/// Draws the text with the left end of its baseline at (x, baseline), in px from the left and the
/// top. Clips it to the image. UTF-8; an invalid byte is drawn as U+FFFD. A text that is wider than
/// `room` px is cut, with "…" at its end.
void draw_text(Image& image, double x, double baseline, const std::string& text,
               const TextStyle& style, double room);

/// The versions that determine the pixels of a text: "DejaVu Sans, pango 1.50.12, cairo 1.16.0".
std::string lettering_version();

struct LegendEntry {
  enum class Sign { box, ring, ramp } sign = Sign::box;
  Rgba colour;  // for a ramp: its dark end
  std::string text;
  Rgba light = {};  // for a ramp: its other end
};

struct SheetPanel {
  std::string title;
  std::string headline;  // the panel's result
  Rgba headline_colour;
  Image image;  // opaque; all panels have the same size
  std::vector<LegendEntry> legend;
  int left = 0, top = 0;  // position of the image in the sheet of compose()
};

/// Blends `above`, times `opacity`, over `below`, which is opaque and of the same size.
void lay_over(Image& below, const Image& above, double opacity);

/// A circle around (x, y), px from the left and the top, with a light line on both sides of it.
void draw_ring(Image& image, double x, double y, double radius, double line, const Rgba& colour);

/// Height of the letters for a panel of this width, px. Legible even if it is shown at half size.
double letter_height(int panel_width);

/// The sheet: title and subtitle, the panels (at least one), a line of small print. Truncates texts
/// that are too long.
Image compose(const std::string& title, const std::string& subtitle,
              std::vector<SheetPanel>& panels, const std::string& small_print);

/// Keyword (1 to 79 printable ASCII characters) and text, in UTF-8; in the order of the file.
using PngTexts = std::vector<std::pair<std::string, std::string>>;

/// The bytes of a PNG with 8 bits a channel, RGB; texts as tEXt, or as iTXt if not ASCII. The same
/// image and texts give the same bytes with the same cairo. Throws Error if cairo fails.
/// Preconditions: the image has a pixel, and all are opaque.
std::string to_png(const Image& image, const PngTexts& texts);

/// three.js, a library for WebGL in browsers (Debian's libjs-three), which is part of the program.
/// All three are empty if the program was built without three.js.
struct ThreeJs {
  std::string_view library;   // three.min.js
  std::string_view controls;  // OrbitControls.js: the mouse and fingers turn and move the camera
  std::string_view licence;   // Debian's file with its owners and terms
};
ThreeJs three_js();

/// The colour of missed pairs, opaque and unshaded; nothing else has this colour.
constexpr Rgba kMissedColour = {220, 0, 90};
/// Colours of colliding triangles, and of triangles that a method kept in vain.
constexpr Rgba kFoundColour = {0, 128, 116}, kIdleColour = {240, 176, 32};
constexpr double kIdlePart = 0.6;  // share of kIdleColour; the rest is the object's colour
constexpr double kThrough = 0.28;  // opacity of collisions behind other triangles
/// Colours of the objects, in turn: pale, so that only collisions have strong colours.
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
  std::uint64_t colliding = 0;                   // pairs, by the exact method
  std::uint64_t neighbours = 0;                  // of these, pairs of neighbours
  std::uint64_t missed = 0;                      // of `colliding`, not found by the method
  std::uint64_t missed_triangles = 0;            // triangles in a missed pair
  std::uint64_t kept = 0;                        // triangles; 0 for exact, which culls none
  std::uint64_t idle = 0;                        // of `kept`, in no collision
  std::uint64_t rings = 0;                       // around misses that are too small to see
  bool drew = false;                             // it drew in views at a resolution
  bool broken = false;                           // the method is guaranteed, but missed a pair
  std::string device;                            // device used: a renderer, "cpu", or "none"
  int left = 0, top = 0, width = 0, height = 0;  // of its picture in the image, px
};

/// A panel of the picture, and its contents.
struct DrawnPanel {
  SheetPanel sheet;
  PanelResult result;
};
/// The width of lines, px, in proportion to the picture.
double line_of(const Window& window);
/// Only the triangles, on a transparent image.
Image painted(const GlContext& context, const Scene& scene, const Window& window,
              const std::vector<PictureTriangle>& triangles);
/// Draws the missed triangles over the image, with rings around those that are too small to see.
/// Returns the number of rings.
std::uint64_t draw_missed(const GlContext& context, const Scene& scene, const Window& window,
                          const std::vector<std::uint32_t>& missed, Image& image);
/// The method with its options but without a resolution: "far, exact offset".
std::string method_title(const RunOptions& options);
/// "far, exact offset, at 128 px".
std::string panel_title(const RunOptions& options);
/// "missed 12 of 4,268 colliding pairs".
std::string headline_of(const PanelResult& result);
/// Sets the title and the headline over the panel, and the colour of the headline.
void set_heading(DrawnPanel& panel);
/// Adds the line of the legend that explains a colour; or the rings, if there are any.
void explain(DrawnPanel& panel, Rgba colour, const std::string& text);
void explain_rings(DrawnPanel& panel, const std::string& text);

}  // namespace farcull
