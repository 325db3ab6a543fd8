// `farcull experiment family` runs all methods on moving scenes in one program, and shows their
// frame rates beside those of the papers. It also compares the size of the potentially colliding
// sets of the methods with that of I-COLLIDE.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/measure/frames.h"
#include "experiments/method/run.h"
#include "experiments/scenes/frames.h"
#include "experiments/scenes/scene_file.h"

namespace farcull {

struct FamilyArguments {
  std::vector<std::string> scenes;     // empty: all built-in ones that move
  std::optional<std::string> methods;  // with commas; empty: all that apply to the scene
  FrameRange range = {0, 29};
  bool self = false;   // every object is tested against itself, by the methods that do so
  RunOptions options;  // resolution, device, verify and so on, of all
};

/// The results of a method on one frame.
struct FamilyFrame {
  long frame = 0;
  double ms = 0;  // from moved vertices to exact pairs: cull + exact
  std::uint64_t pcs_objects = 0, pcs_triangles = 0;
  std::uint64_t object_triangles = 0;  // of i-collide: SweptObjects::triangles
  std::uint64_t candidate_pairs = 0, colliding_pairs = 0, neighbour_pairs = 0;
  std::uint64_t queries = 0, draws = 0;
  std::uint64_t queries_saved = 0, draws_saved = 0;  // against plain CULLIDE
  std::optional<std::uint64_t> missed;
  FARCULL_FIELDS(candidate_pairs, colliding_pairs, neighbour_pairs, queries, draws, queries_saved,
                 draws_saved, missed)
  std::optional<ContactCounts> missed_contacts;
  bool broken = false;  // the method promises, whatever its device's verdict, and missed a pair
};

/// The results of a method on one scene.
struct FamilyCell {
  std::string scene;
  std::uint64_t objects = 0, triangles = 0;  // in the first frame
  Method method{};
  std::string offset;                 // of far
  std::string device;                 // the device that answered
  bool promises = false;              // the method promises, and its device keeps the assumptions
  std::uint64_t pairs_not_asked = 0;  // in the first frame: of triangles inside objects that the
                                      // method did not test against themselves
  double setup_ms = 0;
  std::vector<FamilyFrame> frames;

  FrameTimes times() const;
  std::optional<std::uint64_t> missed() const;
  bool broken() const;  // in any of its frames
};

/// The frame rate (1/s) that a paper gives for a similar scene, and the paper; 0 if no paper gives
/// one. It was measured on hardware of 2004 with other meshes, so it is not comparable with ours.
struct PaperRate {
  double fps = 0;
  std::string source;
};
PaperRate paper_rate(const std::string& scene);

/// Runs every scene by every method, frame after frame. Objects that the scene marks `self` are
/// tested against themselves by the methods that do so; the others see the scene without the marks
/// (and the output says so). Throws Error as run_frames() does, before the first run if possible.
std::vector<FamilyCell> run_family(const FamilyArguments& arguments, const Progress& progress = {});

/// The first promise that was broken; empty: none.
std::string broken(const std::vector<FamilyCell>& cells);

std::string family_table(const std::vector<FamilyCell>& cells);
/// A row for each frame. The columns factor_* are the culling efficiency against I-COLLIDE: the
/// number that I-COLLIDE keeps divided by the number that this method keeps. factor_objects counts
/// all triangles of the objects that I-COLLIDE keeps, as published; factor_triangles and
/// factor_pairs count the triangles and pairs that I-COLLIDE's boxes of triangles keep. A factor is
/// empty if I-COLLIDE was not run or either number is 0.
std::string family_csv(const std::vector<FamilyCell>& cells);
nlohmann::ordered_json family_json(const std::vector<FamilyCell>& cells,
                                   const FamilyArguments& arguments);

}  // namespace farcull
