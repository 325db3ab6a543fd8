// Writes a record for other programs, as JSON, CSV and certificate, and a plan for people and
// programs.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/fields.h"
#include "experiments/method/clash.h"
#include "experiments/method/distances.h"
#include "experiments/method/miss_model.h"
#include "experiments/method/plan.h"
#include "experiments/method/run.h"
#include "experiments/system/output_file.h"
#include "verify/certificate/certificate.h"
#include "verify/certificate/pair_list.h"

namespace farcull {

// ---- JSON and CSV of a struct that has fields (core/base/fields.h) ----

/// A value of a record as JSON: an object of its fields, the word of an enumeration, null for an
/// empty optional, else the value itself. A number that is not finite is written as null.
template <class Value>
nlohmann::ordered_json json_of(const Value& value) {
  if constexpr (HasFields<Value>) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    value.fields(
        [&](std::string_view name, const auto& of) { out[std::string(name)] = json_of(of); });
    return out;
  } else if constexpr (requires { value.has_value(); }) {
    return value ? json_of(*value) : nlohmann::ordered_json(nullptr);
  } else if constexpr (std::is_enum_v<Value>) {
    return to_string(value);
  } else {
    return value;
  }
}
template <class Value>
nlohmann::ordered_json json_of(const std::vector<Value>& values) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Value& value : values) out.push_back(json_of(value));
  return out;
}

/// A JSON object with these members of a struct, by their names and in this order.
#define FARCULL_JSON(value, ...)                                                \
  [&] {                                                                         \
    nlohmann::ordered_json out;                                                 \
    const auto& of = value;                                                     \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(FARCULL_JSON_MEMBER, __VA_ARGS__)) \
    return out;                                                                 \
  }()
#define FARCULL_JSON_MEMBER(name) out[#name] = ::farcull::json_of(of.name);

/// A JSON list with one(value) for each value.
template <class Values, class One>
nlohmann::ordered_json json_list(const Values& values, const One& one) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const auto& value : values) out.push_back(one(value));
  return out;
}

/// The value; null if `counts` is false.
template <class Value>
nlohmann::ordered_json json_if(bool counts, const Value& value) {
  return counts ? json_of(value) : nlohmann::ordered_json(nullptr);
}

/// The text; null if it is empty.
inline nlohmann::ordered_json text_json(const std::string& text) {
  return json_if(!text.empty(), text);
}

inline nlohmann::ordered_json point_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

// ---- records ----

/// The record as JSON. Keys keep their order, so that the same run gives the same text.
nlohmann::ordered_json to_json(const Scene& scene, const Record& record);

/// gl_json: names and versions of a GL device. threads_json: the threads of a software device, null
/// for others.
nlohmann::ordered_json gl_json(const GlInfo& gl);
nlohmann::ordered_json threads_json(const GlInfo& gl);

/// The floating-point environment of the caller and the one in force.
nlohmann::ordered_json floating_point_json(const FloatingPoint& callers, const FloatingPoint& used);

/// Pairs inside objects that were not tested (verify/certificate/certificate.h): the number of
/// objects, the number of pairs, and the objects as ranges (first and last).
nlohmann::ordered_json not_asked_json(const Scene& scene);

/// Parts of records: the scene; the stages of a trace.
nlohmann::ordered_json scene_json(const Scene& scene, std::uint64_t degenerate_triangles,
                                  const std::string& hash);
nlohmann::ordered_json stages_json(const std::vector<Stage>& trace);
/// Each triangle as a person can find it: its object, its number there and the face of the file
/// that it comes from.
nlohmann::ordered_json pair_json(const Scene& scene, const TrianglePair& pair);
nlohmann::ordered_json pairs_json(const Scene& scene, const std::vector<TrianglePair>& pairs);

/// A name as a cell of a CSV: in quotes if it has to be.
std::string csv_cell(const std::string& text);

/// Columns of pairs_csv() besides those that every list has, and which rows it writes.
struct PairColumns {
  bool faces = false;     // face_a, face_b: 0-based in the files that the objects come from
  bool contacts = false;  // contact: the kind; the record must have the kinds
  bool segments = false;  // x0,y0,z0,x1,y1,z1: the ends of the common segment or point, in world
                          // units; empty for a polygon or nothing. The record must have them.
                          // polygon: the corners of a polygon, else empty
  bool names = false;     // name_a, name_b: of the objects
  std::vector<ContactKind> kinds = {};   // only pairs of these kinds; empty: all pairs
  const ListNumbers* numbers = nullptr;  // set if the scene is a part of another scene; else null
};

/// The colliding pairs as verify/certificate/pair_list.h writes them, sorted, each once; with
/// colliding neighbours if an object of the scene is tested against itself. More columns come at
/// the end: contact, the segment and the polygon, the faces, the names.
std::string pairs_csv(const Scene& scene, const Record& record, const PairColumns& columns = {});
/// The same, given to `sink` part by part in order, so that the whole text is never in memory. All
/// cores make the parts.
void give_pairs_csv(const Scene& scene, const Record& record, const PairColumns& columns,
                    const TextSink& sink);
/// The header and the rows of pairs_csv(); `before` comes at the start of each row.
std::string pairs_header(const Scene& scene, const PairColumns& columns = {});
std::string pairs_rows(const Scene& scene, const Record& record, const std::string& before,
                       const PairColumns& columns = {});

/// The certificate of the run: its claims about every pair of the scene, with evidence. Times are
/// left out, so the same run gives the same text. whole: as for make_certificate().
Certificate certificate_of(const Scene& scene, const Record& record,
                           const WholeScene* whole = nullptr);

// `farcull plan`: a plan as a table and as JSON.

/// One line for each stage: whether it runs, is left out or depends on pixels, and why.
std::string plan_table(const Scene& scene, const Plan& plan);
/// The plan as JSON (docs/record.md, "Plans"). misses: the predicted misses of the method.
nlohmann::ordered_json plan_json(const Scene& scene, const Plan& plan,
                                 const std::optional<MissPrediction>& misses = {});

/// The plan's decision about a stage: "runs", "left out" or "depends".
std::string decision_of(const Stage& stage);

// Distances (docs/proximity.md).

/// The distances as JSON. Keys keep their order, so that the same answers give the same text. seed:
/// the seed of a random scene.
nlohmann::ordered_json distances_json(const Scene& scene, const DistanceRecord& record,
                                      std::optional<std::uint64_t> seed = {});

/// The distances as CSV: the names of the columns, and a row for each pair with `before` at its
/// start.
std::string distances_header();
std::string distances_rows(const Scene& scene, const DistanceRecord& record,
                           const std::string& before = "");

/// The distances (only the first of many), the stages and the accounting.
std::string distances_table(const Scene& scene, const DistanceRecord& record);

/// The verdict of an accounting, in one line without a newline.
std::string verdict_text(const DistanceAccounting& accounting);
/// The number of pairs, and how many are in each class.
std::string accounting_sum(const DistanceAccounting& accounting);

/// The differences between the rows of a record and those of an earlier CSV. Two rows are the same
/// if they name the same two parts, in any order, and have the same verdict.
struct ClashComparison {
  struct Gone {
    std::string a, b, verdict;
  };
  std::vector<bool> same;        // per row of the record: whether the file has it
  std::vector<Gone> gone;        // rows of the file that the record does not have
  std::uint64_t unexamined = 0;  // such rows of pairs that were left out, so they are not gone
};
/// text: the CSV; name: of the file, for errors. Throws Error if clash_csv() wrote no such text.
ClashComparison compare_clashes(const Scene& scene, const ClashRecord& record,
                                const std::string& text, const std::string& name);

struct ClashTable {
  std::vector<ClashVerdict> failing = {};        // as for is_clean(); with touch, lists touches
  std::string unit = {};                         // of the lengths, such as "mm"; empty: not said
  std::optional<ClashComparison> compared = {};  // with an earlier CSV
};

/// For people: the summary, then the rows; rows of pairs that touch only if `failing` has touch.
/// Lengths have six digits, since the coordinates of a mesh file may be rounded to floats.
std::string clash_text(const Scene& scene, const ClashRecord& record, const ClashTable& table);

/// What a row says beyond its verdict, such as the kinds of contact.
std::string clash_words(const Scene& scene, const ClashRow& row);

/// Whether no pair is a clash, contained, unknown or one of `failing`, and every pair that was
/// asked for was examined.
bool is_clean(const ClashRecord& record, const std::vector<ClashVerdict>& failing = {});

/// Why a clash or a containment has no depth; empty if it has one, and for other verdicts.
std::string no_depth_words(const Scene& scene, const ClashRow& row);

/// A row for each pair that is not clear, numbers with all digits; then a row for each pair that is
/// gone (ClashComparison), with only its names and its old verdict.
std::string clash_csv(const Scene& scene, const ClashRecord& record, const ClashTable& table = {});

nlohmann::ordered_json clash_json(const Scene& scene, const ClashRecord& record,
                                  const ClashTable& table = {});

}  // namespace farcull
