// A panel of a picture with what it shows, the parts that both kinds of panels are made of, and the
// panel of --view-depth: the depth that a method stores in one of its views.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/gl/picture/picture.h"
#include "experiments/measure/lab.h"
#include "experiments/method/run.h"
#include "experiments/picture/arguments.h"
#include "experiments/picture/sheet.h"

namespace farcull {

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
