// Output of `farcull bench`: a table for people, JSON for programs.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commit.h"
#include "core/scene/scene.h"
#include "experiments/measure/bench.h"
#include "experiments/record/output.h"
#include "experiments/record/tables.h"
#include "experiments/system/machine.h"
#include "experiments/system/text_table.h"

namespace farcull {
namespace {

using Json = nlohmann::ordered_json;

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// The fastest row of far-pairs.
const BenchRow* best_far_pairs(const BenchResult& result) {
  const BenchRow* best = nullptr;
  for (const BenchRow& row : result.rows) {
    if (row.name != "far-pairs") continue;
    if (best == nullptr || row.total_ms.median < best->total_ms.median) best = &row;
  }
  return best;
}

Json row_json(const BenchResult& result, const BenchRow& row) {
  Json json = {{"name", row.name},
               {"device", row.device},
               {"total_ms", to_json(row.total_ms)},
               {"setup_ms", row.setup_ms},
               {"build_ms", row.build_ms},
               {"candidates_ms", row.candidates_ms},
               {"exact_ms", row.exact_ms},
               {"candidate_pairs", row.candidate_pairs},
               {"pairs", row.pairs},
               {"peak_mib", or_null(row.peak_mib)},
               {"cold_ms", row.cold_ms},
               {"repeats", row.repeats},
               {"peer", row.peer},
               {"library", row.peer ? Json(row.library) : Json(nullptr)},
               {"ratio_to_fastest_peer", or_null(ratio_to_fastest(result, row))}};
  if (!row.peer) {
    Json ratios = Json::object();
    for (const BenchRow& peer : result.rows) {
      if (peer.peer) ratios[peer.name] = row.total_ms.median / peer.total_ms.median;
    }
    json["ratio_to_peers"] = ratios;
  }
  return json;
}

Json disagreement_json(const std::optional<Disagreement>& disagreement) {
  if (!disagreement) return nullptr;
  return {{"has", disagreement->has},
          {"lacks", disagreement->lacks},
          {"pair", {disagreement->pair.a, disagreement->pair.b}},
          {"collides", disagreement->collides}};
}

std::string ms(double value) {
  return value < 100 ? fmt::format("{:.2f}", value) : fmt::format("{:.0f}", value);
}

}  // namespace

std::string describe(const Scene& scene, const Disagreement& disagreement) {
  const auto place = [&](std::uint32_t triangle) {
    for (const Object& object : scene.objects) {
      if (triangle - object.first_triangle < object.triangle_count)
        return fmt::format("{} triangle {}", object.name, triangle - object.first_triangle);
    }
    return fmt::format("triangle {}, which the scene lacks,", triangle);
  };
  return fmt::format(
      "{} has the pair {} and {}, which {} lacks; the exact predicates say that it {}",
      disagreement.has, place(disagreement.pair.a), place(disagreement.pair.b), disagreement.lacks,
      disagreement.collides ? "collides" : "is none that collides");
}

nlohmann::ordered_json to_json(const Scene& scene, const BenchOptions& options,
                               const BenchResult& result) {
  Json rows = Json::array();
  for (const BenchRow& row : result.rows) rows.push_back(row_json(result, row));
  Json left_out = Json::array();
  for (const BenchContestant& c : result.left_out)
    left_out.push_back({{"name", c.name}, {"device", c.device}, {"reason", c.left_out}});
  const BenchRow* best = best_far_pairs(result);
  const std::optional<double> ratio = best ? ratio_to_fastest(result, *best) : std::nullopt;
  return {{"scene", scene.name},
          {"threads", options.threads},
          {"rows", rows},
          {"fastest_peer",
           result.fastest_peer ? Json(result.rows[*result.fastest_peer].name) : Json(nullptr)},
          {"ratio_to_fastest_peer", or_null(ratio)},
          {"left_out", left_out},
          {"disagreement", disagreement_json(result.disagreement)},
          {"objects", scene.objects.size()},
          {"triangles", scene.triangles.size()},
          {"self_not_asked", not_asked_json(scene)},
          {"hash", scene_hash(scene)},
          {"seed", or_null(options.seed)},
          {"options",
           {{"methods", options.methods},
            {"peers", options.peers},
            {"repeat", options.repeat},
            {"limit_s", options.limit_s},
            {"device", options.device},
            {"self", options.self}}},
          {"cpu", cpu_model()},
          {"commit", FARCULL_COMMIT}};
}

std::string bench_table(const Scene& scene, const BenchOptions& options,
                        const BenchResult& result) {
  std::string out = fmt::format("{}: {}, {}; {}, {}\n\n", scene.name,
                                counted(scene.objects.size(), "object", "objects"),
                                counted(scene.triangles.size(), "triangle", "triangles"),
                                counted(options.threads, "thread", "threads"), cpu_model());
  if (const std::string line = not_asked_line(scene); !line.empty())
    out.insert(out.size() - 1, line);
  const BenchRow* best = best_far_pairs(result);
  Table table("llrrrrrrrrrrrrrr");
  table.add({"", "device", "ms", "low", "high", "n", "cold", "setup", "build", "find", "exact",
             "candidates", "pairs", "MiB", result.fastest_peer ? "x fastest" : "",
             best ? "x far-pairs" : ""});
  for (const BenchRow& row : result.rows) {
    const std::optional<double> ratio = ratio_to_fastest(result, row);
    table.add({row.name + (row.repeats == 0 ? " (once)" : ""), row.device, ms(row.total_ms.median),
               ms(row.total_ms.low), ms(row.total_ms.high), std::to_string(row.total_ms.n),
               ms(row.cold_ms), ms(row.setup_ms), ms(row.build_ms), ms(row.candidates_ms),
               ms(row.exact_ms), grouped(row.candidate_pairs), grouped(row.pairs),
               row.peak_mib ? fmt::format("{:.1f}", *row.peak_mib) : "-",
               ratio ? fmt::format("{:.3f}", *ratio) : "",
               best ? fmt::format("{:.2f}", row.total_ms.median / best->total_ms.median) : ""});
  }
  out += table.text();
  for (const BenchContestant& c : result.left_out)
    out += fmt::format("left out: {}: {}\n", c.name, c.left_out);
  out +=
      "\nms: from the triangles to the sorted pairs, median of n runs; low, high: its 95 % "
      "interval "
      "by the\nbootstrap, which fewer than 6 runs make too narrow; cold: the first run; setup: "
      "once, "
      "not counted;\nbuild, find, exact: its parts; MiB: resident at the peak of the cold run, "
      "beyond before.\n";
  if (has_self(scene)) {
    out +=
        "candidates, pairs: without neighbours (farcull help terms); farcull run --self counts "
        "those too.\n";
  }
  if (result.fastest_peer) {
    out += fmt::format("x fastest: of the fastest peer, {}, in this run.\n",
                       result.rows[*result.fastest_peer].name);
  }
  return out;
}

}  // namespace farcull
