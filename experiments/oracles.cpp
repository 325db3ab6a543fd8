#include "experiments/oracles.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/parallel.h"
#include "experiments/pair_generators.h"
#include "verify/exact.h"
#include "verify/integer_pair.h"

namespace farcull {
namespace {

constexpr std::uint64_t kBlock = 1024;  // pairs with a seed of their own, timed together

std::string text(const PairOfTriangles& pair) {
  std::string out;
  for (const auto* t : {&pair.a, &pair.b}) {
    for (const Vec3& p : *t)
      out += fmt::format("{}{:a} {:a} {:a}", out.empty() ? "" : "; ", p.x(), p.y(), p.z());
  }
  return out;
}

/// A block's counts, its times in ns in all.
OracleRow compare_block(const PairGenerator& generator, std::uint64_t pairs, std::uint64_t seed) {
  using Clock = std::chrono::steady_clock;
  PairRandom random(seed);
  std::vector<PairOfTriangles> list;
  for (std::uint64_t i = 0; i < pairs; ++i) list.push_back(generator.make(random));
  std::vector<char> by_cgal(pairs);
  std::vector<char> by_integers(pairs);
  const auto begin = Clock::now();
  for (std::uint64_t i = 0; i < pairs; ++i) by_cgal[i] = intersects(list[i].a, list[i].b);
  const auto middle = Clock::now();
  for (std::uint64_t i = 0; i < pairs; ++i)
    by_integers[i] = integer_intersects(list[i].a, list[i].b);
  const auto end = Clock::now();

  OracleRow row;
  row.pairs = pairs;
  row.cgal_ns = std::chrono::duration<double, std::nano>(middle - begin).count();
  row.integer_ns = std::chrono::duration<double, std::nano>(end - middle).count();
  for (std::uint64_t i = 0; i < pairs; ++i) {
    row.intersecting += by_cgal[i];
    if (by_cgal[i] == by_integers[i]) continue;
    if (row.disagreements++ == 0) row.example = text(list[i]);
  }
  return row;
}

}  // namespace

std::vector<OracleRow> compare_oracles(std::uint64_t pairs_per_generator, std::uint64_t seed,
                                       const OracleProgress& progress) {
  const std::uint64_t blocks = (pairs_per_generator + kBlock - 1) / kBlock;
  std::vector<OracleRow> rows;
  for (const PairGenerator& generator : pair_generators()) {
    if (progress) progress(generator.name);
    std::vector<OracleRow> results(blocks);
    std::atomic<std::uint64_t> next = 0;
    // Blocks are handed out one by one, since some take a hundred times as long as others.
    const std::size_t threads = chunks_for(blocks, 1);
    for_chunks(threads, threads, [&](std::size_t, std::size_t, std::size_t) {
      for (std::uint64_t block; (block = next++) < blocks;) {
        const std::uint64_t pairs = std::min(kBlock, pairs_per_generator - block * kBlock);
        std::seed_seq mix{seed, seed >> 32, block, block >> 32, std::uint64_t{rows.size()}};
        std::array<std::uint32_t, 2> words;
        mix.generate(words.begin(), words.end());
        results[block] = compare_block(generator, pairs, std::uint64_t{words[0]} << 32 | words[1]);
      }
    });
    OracleRow row;
    row.generator = generator.name;
    for (const OracleRow& part : results) {
      row.pairs += part.pairs;
      row.intersecting += part.intersecting;
      row.disagreements += part.disagreements;
      row.cgal_ns += part.cgal_ns;
      row.integer_ns += part.integer_ns;
      if (row.example.empty()) row.example = part.example;
    }
    if (row.pairs > 0) {
      row.cgal_ns /= static_cast<double>(row.pairs);
      row.integer_ns /= static_cast<double>(row.pairs);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string oracles_table(const std::vector<OracleRow>& rows) {
  std::string out = fmt::format("{:<17} {:>10} {:>13} {:>13} {:>10} {:>12}\n", "generator", "pairs",
                                "intersecting", "disagreements", "CGAL ns", "integers ns");
  for (const OracleRow& row : rows) {
    out += fmt::format("{:<17} {:>10} {:>13} {:>13} {:>10.0f} {:>12.0f}\n", row.generator,
                       row.pairs, row.intersecting, row.disagreements, row.cgal_ns, row.integer_ns);
  }
  for (const OracleRow& row : rows) {
    if (row.disagreements > 0) out += fmt::format("{}: {}\n", row.generator, row.example);
  }
  return out;
}

nlohmann::ordered_json oracles_json(const std::vector<OracleRow>& rows,
                                    std::uint64_t pairs_per_generator, std::uint64_t seed) {
  using Json = nlohmann::ordered_json;
  std::uint64_t disagreements = 0;
  Json generators = Json::array();
  for (const OracleRow& row : rows) {
    disagreements += row.disagreements;
    generators.push_back({{"generator", row.generator},
                          {"pairs", row.pairs},
                          {"intersecting", row.intersecting},
                          {"disagreements", row.disagreements},
                          {"cgal_ns", row.cgal_ns},
                          {"integer_ns", row.integer_ns},
                          {"example", row.example.empty() ? Json(nullptr) : Json(row.example)}});
  }
  return {{"seed", seed},
          {"pairs_per_generator", pairs_per_generator},
          {"disagreements", disagreements},
          {"generators", generators}};
}

}  // namespace farcull
