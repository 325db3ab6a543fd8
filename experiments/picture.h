// `farcull picture`: what a method makes of a scene, as a picture: what collides, what of it the
// method missed, and what it kept for nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/gl_picture.h"
#include "experiments/frames.h"
#include "experiments/picture_sheet.h"
#include "experiments/png_write.h"
#include "experiments/run.h"
#include "experiments/studies/lab.h"

namespace farcull {

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

/// What a panel shows and says. Pairs of neighbours count with the others.
struct PanelResult {
  std::string title;                   // "cullide at 128 px"
  std::string headline;                // "missed 12 of 4,268 colliding pairs"
  std::uint64_t colliding = 0;         // pairs, by the exact method
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

struct PictureResult {
  Image image;
  PngTexts texts;  // provenance: commit, scene and hash, device and driver, command, panels
  std::string scene, scene_hash;
  std::uint64_t objects = 0, triangles = 0;
  std::vector<PanelResult> panels;
  std::string not_asked;  // not_asked_line() of the scene (tables.h)
};

/// What is drawn for a missed pair, with full opacity and unshaded, and for nothing else.
constexpr Rgba kMissedColour = {220, 0, 90};

/// The arguments as a command line, without -o.
std::string command_of(const PictureArguments& arguments);

/// Throws Error naming the option where one is out of range or options do not go together. Reads no
/// scene, opens no device.
void validate(const PictureArguments& arguments);

/// Runs the methods of the panels and draws. The lab's device answers; where it is "cpu" (far-pairs
/// alone) the picture itself is drawn by the first device. Throws Error for bad arguments, a scene
/// without triangles or one that a method does not take, and for faults of the device.
PictureResult make_picture(const PictureArguments& arguments, Lab& lab);

/// make_picture(), written to the path as PNG, whole or not at all; "-" is standard output. Throws
/// Error as write_output() as well.
PictureResult write_picture(const PictureArguments& arguments, Lab& lab, const std::string& path);

/// A panel of the picture, and what it shows.
struct DrawnPanel {
  SheetPanel sheet;
  PanelResult result;
};
/// The panel of arguments.depth_view: run, depths and picture. Throws Error where the method draws
/// no depth, or nothing is drawn in the view.
DrawnPanel depth_panel(const RunOptions& options, const PictureArguments& arguments,
                       const Scene& scene, const Truth& truth, Session& session,
                       const GlContext& context);

/// Parts of both kinds of panels.
Image painted(const GlContext& context, const Scene& scene, const Window& window,
              const std::vector<PictureTriangle>& triangles);
/// Draws the missed triangles over the image, with rings where they are too small to be seen, and
/// says how many rings.
std::uint64_t draw_missed(const GlContext& context, const Scene& scene, const Window& window,
                          const std::vector<std::uint32_t>& missed, Image& image);
/// "far, exact offset, at 128 px".
std::string panel_title(const RunOptions& options);
/// "missed 12 of 4,268 colliding pairs", and its colour.
void set_headline(DrawnPanel& panel, const std::string& verb);

}  // namespace farcull
