// Writes a record for other programs, as JSON, CSV and certificate. Writes a plan for people and
// for programs.
#pragma once

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <type_traits>

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

/// Returns a value of a record as JSON. A struct with fields becomes an object. An enumeration
/// becomes a string. An empty optional and a number that is not finite become null.
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

/// Makes a JSON object from the given members of a struct. Keeps the members' names and order.
#define FARCULL_JSON(value, ...)                                                \
  [&] {                                                                         \
    nlohmann::ordered_json out;                                                 \
    const auto& of = value;                                                     \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(FARCULL_JSON_MEMBER, __VA_ARGS__)) \
    return out;                                                                 \
  }()
#define FARCULL_JSON_MEMBER(name) out[#name] = ::farcull::json_of(of.name);

template <class Values, class One>
nlohmann::ordered_json json_list(const Values& values, const One& one) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const auto& value : values) out.push_back(one(value));
  return out;
}

template <class Value>
nlohmann::ordered_json json_if(bool counts, const Value& value) {
  return counts ? json_of(value) : nlohmann::ordered_json(nullptr);
}

inline nlohmann::ordered_json text_json(const std::string& text) {
  return json_if(!text.empty(), text);
}

inline nlohmann::ordered_json point_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// Returns the record as JSON. Keys keep their order, so the same run gives the same text.
nlohmann::ordered_json to_json(const Scene& scene, const Record& record);

nlohmann::ordered_json gl_json(const GlInfo& gl);
nlohmann::ordered_json threads_json(const GlInfo& gl);

nlohmann::ordered_json floating_point_json(const FloatingPoint& callers, const FloatingPoint& used);

/// Returns NotAsked (verify/certificate/certificate.h) of the scene: how many objects are not
/// tested against themselves, how many pairs of triangles are inside these objects, and the objects
/// as ranges (first and last).
nlohmann::ordered_json not_asked_json(const Scene& scene);

nlohmann::ordered_json scene_json(const Scene& scene, std::uint64_t degenerate_triangles,
                                  const std::string& hash);
nlohmann::ordered_json stages_json(const std::vector<Stage>& trace);
/// Returns, for each triangle of a pair, its object, its number in the object, and its face in the
/// file.
nlohmann::ordered_json pair_json(const Scene& scene, const TrianglePair& pair);
nlohmann::ordered_json pairs_json(const Scene& scene, const std::vector<TrianglePair>& pairs);

/// Returns a text as a CSV cell, in quotes if necessary.
std::string csv_cell(const std::string& text);

/// Selects additional columns of pairs_csv(), and its rows.
struct PairColumns {
  bool faces = false;     // columns face_a, face_b: 0-based face in the object's file
  bool contacts = false;  // column contact: the kind. Precondition: the record has kinds
  // Columns x0,y0,z0,x1,y1,z1: the ends of the common segment, or the common point twice, in world
  // units. Column polygon: the corners of the common polygon. Cells that do not apply are empty.
  // Precondition: the record has segments.
  bool segments = false;
  bool names = false;                    // columns name_a, name_b: names of the objects
  std::vector<ContactKind> kinds = {};   // rows: only pairs of these kinds; empty: all
  const ListNumbers* numbers = nullptr;  // set if the scene is a part of another scene
};

/// Returns the colliding pairs in the format of verify/certificate/pair_list.h, sorted, without
/// duplicates. If an object is tested against itself, colliding neighbours are included. The
/// additional columns come last.
std::string pairs_csv(const Scene& scene, const Record& record, const PairColumns& columns = {});
/// Passes the text of pairs_csv() to `sink` in parts, so that the whole text is never in memory.
/// All cores make the parts.
void give_pairs_csv(const Scene& scene, const Record& record, const PairColumns& columns,
                    const TextSink& sink);
/// The next two functions return the header and the rows of pairs_csv(). Rows begin with `before`.
std::string pairs_header(const Scene& scene, const PairColumns& columns = {});
std::string pairs_rows(const Scene& scene, const Record& record, const std::string& before,
                       const PairColumns& columns = {});

/// Returns the certificate of the run: claims about every pair of the scene, with evidence. The
/// certificate has no times, so equal runs give equal texts. whole: as in make_certificate().
Certificate certificate_of(const Scene& scene, const Record& record,
                           const WholeScene* whole = nullptr);

/// Returns a line for each stage: whether it runs, is left out or depends on pixels, and why.
std::string plan_table(const Scene& scene, const Plan& plan);
/// Returns the plan as JSON (docs/record.md, "Plans"). misses: the predicted misses of the method.
nlohmann::ordered_json plan_json(const Scene& scene, const Plan& plan,
                                 const std::optional<MissPrediction>& misses = {});

std::string decision_of(const Stage& stage);

/// Returns distances as JSON (docs/proximity.md). seed: the seed of a random scene.
nlohmann::ordered_json distances_json(const Scene& scene, const DistanceRecord& record,
                                      std::optional<std::uint64_t> seed = {});

/// The next two functions return the header and the rows of a CSV of distances. Each row is about
/// one distance and begins with `before`.
std::string distances_header();
std::string distances_rows(const Scene& scene, const DistanceRecord& record,
                           const std::string& before = "");

/// Returns a table with the first distances, the stages and the accounting.
std::string distances_table(const Scene& scene, const DistanceRecord& record);

std::string verdict_text(const DistanceAccounting& accounting);
std::string accounting_sum(const DistanceAccounting& accounting);

/// The differences between the rows of a record and the rows of an earlier CSV. Two rows are the
/// same if they have the same verdict and the same two parts, in any order.
struct ClashComparison {
  struct Gone {
    std::string a, b, verdict;
  };
  std::vector<bool> same;        // for each row of the record: true if the CSV has the row
  std::vector<Gone> gone;        // rows of the CSV that the record lacks
  std::uint64_t unexamined = 0;  // number of rows of the CSV whose pair was not examined
};
/// text: the CSV. name: name of its file. Throws Error if clash_csv() cannot have written the text.
ClashComparison compare_clashes(const Scene& scene, const ClashRecord& record,
                                const std::string& text, const std::string& name);

struct ClashTable {
  std::vector<ClashVerdict> failing =
      {};                 // argument of is_clean(); with `touch`, touches are listed
  std::string unit = {};  // unit of the lengths, such as "mm"; empty: unknown
  std::optional<ClashComparison> compared = {};  // differences from an earlier CSV
};

/// Returns a text for people: the summary, then the rows. Lengths have six digits, since the
/// coordinates of a mesh file may have been rounded to floats.
std::string clash_text(const Scene& scene, const ClashRecord& record, const ClashTable& table);

/// Returns the words that follow the verdict of a row, such as the kinds of contact.
std::string clash_words(const Scene& scene, const ClashRow& row);

/// Returns true if every wanted pair was examined, and no pair has the verdict clash, contained or
/// unknown, or a verdict in `failing`.
bool is_clean(const ClashRecord& record, const std::vector<ClashVerdict>& failing = {});

/// Returns a row for each pair that is not clear. Numbers have all digits. Then returns a row for
/// each entry of ClashComparison::gone, with only the names and the old verdict.
std::string clash_csv(const Scene& scene, const ClashRecord& record, const ClashTable& table = {});

nlohmann::ordered_json clash_json(const Scene& scene, const ClashRecord& record,
                                  const ClashTable& table = {});

/// A pair of parts over frames (`farcull clash --frames`). An optional value is empty if no frame
/// has such a value for the pair.
struct WorstClash {
  std::string name_a, name_b, id;
  ClashVerdict verdict = ClashVerdict::clear;  // the most serious verdict
  bool ignored = false;
  long frames = 0, first = 0, last = 0;  // number, first and last of the frames with this verdict
  std::optional<double> depth = {};      // the largest lower bound on the depth
  std::optional<double> distance = {};   // the least distance; 0 if the surfaces meet
  std::optional<long> deepest = {}, nearest = {};  // the first frames with `depth` and `distance`
  FARCULL_FIELDS(name_a, name_b, id, verdict, ignored, frames, first, last, depth, deepest,
                 distance, nearest)
};

/// Combines the records of all frames of `farcull clash --frames`.
class ClashFrames {
 public:
  /// wanted: number of frames that were requested.
  explicit ClashFrames(long wanted) : wanted_(wanted) {}

  struct Report {
    nlohmann::ordered_json head, frame, summary;  // parts of the JSON, as in FrameReport
    std::string csv;                              // clash_csv() with a first column `frame`
    std::string text;                             // number of pairs with each verdict
  };
  /// Returns the report of a frame. In the first report, `csv` and `text` begin with their headers.
  Report add(const Scene& scene, const ClashRecord& record, const ClashTable& table, long frame);
  /// Returns a text for people: the pairs of all frames, the most serious verdicts first.
  std::string text(const ClashTable& table) const;

 private:
  std::vector<WorstClash> worst() const;
  bool is_clean() const { return clean_ && frames_ == wanted_; }

  nlohmann::ordered_json head_;
  std::map<std::pair<std::string, std::string>, WorstClash> pairs_;  // keys: names of the two parts
  long wanted_ = 0, frames_ = 0;
  bool clean_ = true;
};

}  // namespace farcull
