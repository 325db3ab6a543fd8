// A record for other programs, as JSON and CSV.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/method/run.h"
#include "verify/certificate/pair_list.h"

namespace farcull {

/// Keys keep their order, so that the same run gives the same text.
nlohmann::ordered_json to_json(const Scene& scene, const Record& record);

/// The floating-point environment of the caller and the one in force.
nlohmann::ordered_json floating_point_json(const FloatingPoint& callers, const FloatingPoint& used);

/// What the scene does not ask (verify/certificate/not_asked.h): objects, pairs, and which objects,
/// as the first and the last of each run of them.
nlohmann::ordered_json not_asked_json(const Scene& scene);

/// Parts of records: the scene; the stages of a trace.
nlohmann::ordered_json scene_json(const Scene& scene, std::uint64_t degenerate_triangles,
                                  const std::string& hash);
nlohmann::ordered_json stages_json(const std::vector<Stage>& trace);
/// A triangle as a person finds it again: its object, its place there and the face of the file it
/// came from. owner: owners(scene).
nlohmann::ordered_json place_json(const Scene& scene, const std::vector<std::uint32_t>& owner,
                                  std::uint32_t triangle);
/// Pairs of triangles, each as {"a": place, "b": place}.
nlohmann::ordered_json pairs_json(const Scene& scene, const std::vector<TrianglePair>& pairs);

/// Columns of pairs_csv() besides those that every list has, and which rows there are.
struct PairColumns {
  bool faces = false;     // face_a, face_b: 0-based in the files that the objects come from
  bool contacts = false;  // contact: the kind; of a record that has the kinds
  bool segments = false;  // x0,y0,z0,x1,y1,z1: the ends of what the triangles have in common, world
                          // units; empty where that is a polygon or nothing. Of a record with them
  std::vector<ContactKind> kinds = {};   // pairs of these kinds alone; empty: all
  const ListNumbers* numbers = nullptr;  // where the scene is a part of another one; else null
};

/// The colliding pairs as verify/certificate/pair_list.h writes them, sorted, each once; neighbours
/// among them where an object of the scene is tested against itself. More columns come at the end:
/// contact, the segment, the faces.
std::string pairs_csv(const Scene& scene, const Record& record, const PairColumns& columns = {});
/// Its parts, `before` at the start of each row.
std::string pairs_header(const Scene& scene, const PairColumns& columns = {});
std::string pairs_rows(const Scene& scene, const Record& record, const std::string& before,
                       const PairColumns& columns = {});

}  // namespace farcull
