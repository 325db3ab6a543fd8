// Asks both oracles about blocks of generated pairs on all cores.
#include "experiments/lemma/oracles.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "core/base/parallel.h"
#include "experiments/generators/pair_generators.h"
#include "experiments/record/fields.h"
#include "verify/certificate/integer_pair.h"
#include "verify/exact.h"

namespace farcull {
namespace {

constexpr std::uint64_t kBlock = 1024;  // pairs with a seed of their own, timed together

std::string text(const DrawnPair& pair) {
  std::string out;
  for (const auto* t : {&pair.a, &pair.b}) {
    for (const Vec3& p : *t)
      out += fmt::format("{}{:a} {:a} {:a}", out.empty() ? "" : "; ", p.x(), p.y(), p.z());
  }
  return out;
}

/// A pair, and a clearance where that is asked.
struct Case {
  DrawnPair pair;
  double clearance = 0;
};

/// Puts one corner of b on one of a, half of the time two; the clearance about the distance of two
/// corners, which often is that of the triangles, or a part of it.
Case make_case(const PairGenerator& generator, OracleQuestion question, RandomDraws& random) {
  Case out{generator.make(random)};
  auto& [a, b] = out.pair;
  if (question == OracleQuestion::neighbours) {
    b[random.below(3)] = a[random.below(3)];
    if (random.chance(2)) b[random.below(3)] = a[random.below(3)];
  } else if (question == OracleQuestion::clearance) {
    out.clearance = (a[random.below(3)] - b[random.below(3)]).norm();
    if (random.chance(2)) out.clearance *= random.unit();
    if (!std::isfinite(out.clearance)) out.clearance = 1;
  }
  return out;
}

bool ask_cgal(const Case& x, OracleQuestion question) {
  switch (question) {
    case OracleQuestion::neighbours:
      return intersects_beyond_shared(x.pair.a, x.pair.b);
    case OracleQuestion::clearance:
      return within(x.pair.a, x.pair.b, x.clearance);
    case OracleQuestion::intersects:
      break;
  }
  return intersects(x.pair.a, x.pair.b);
}

bool ask_integers(const Case& x, OracleQuestion question) {
  switch (question) {
    case OracleQuestion::neighbours:
      return IntegerPair(x.pair.a, x.pair.b).meets_beyond_shared();
    case OracleQuestion::clearance:
      return integer_within(x.pair.a, x.pair.b, x.clearance);
    case OracleQuestion::intersects:
      break;
  }
  return integer_intersects(x.pair.a, x.pair.b);
}

/// A block's counts, its times in ns in all.
OracleRow compare_block(const PairGenerator& generator, OracleQuestion question,
                        std::uint64_t pairs, std::uint64_t seed) {
  using Clock = std::chrono::steady_clock;
  RandomDraws random(seed);
  std::vector<Case> list;
  for (std::uint64_t i = 0; i < pairs; ++i) list.push_back(make_case(generator, question, random));
  std::vector<char> by_cgal(pairs);
  std::vector<char> by_integers(pairs);
  const auto begin = Clock::now();
  for (std::uint64_t i = 0; i < pairs; ++i) by_cgal[i] = ask_cgal(list[i], question);
  const auto middle = Clock::now();
  for (std::uint64_t i = 0; i < pairs; ++i) by_integers[i] = ask_integers(list[i], question);
  const auto end = Clock::now();

  OracleRow row;
  row.pairs = pairs;
  row.cgal_ns = std::chrono::duration<double, std::nano>(middle - begin).count();
  row.integer_ns = std::chrono::duration<double, std::nano>(end - middle).count();
  for (std::uint64_t i = 0; i < pairs; ++i) {
    row.intersecting += by_cgal[i];
    if (by_cgal[i] == by_integers[i]) continue;
    if (row.disagreements++ == 0) row.example = text(list[i].pair);
  }
  return row;
}

}  // namespace

std::string to_string(OracleQuestion question) {
  switch (question) {
    case OracleQuestion::neighbours:
      return "neighbours";
    case OracleQuestion::clearance:
      return "clearance";
    case OracleQuestion::intersects:
      break;
  }
  return "intersects";
}

std::vector<OracleRow> compare_oracles(std::uint64_t pairs_per_generator, std::uint64_t seed,
                                       const OracleProgress& progress) {
  std::vector<OracleRow> rows;
  const auto compare = [&](const PairGenerator& generator, OracleQuestion question,
                           std::uint64_t pairs_in_all) {
    const std::uint64_t blocks = (pairs_in_all + kBlock - 1) / kBlock;
    std::vector<OracleRow> results(blocks);
    std::atomic<std::uint64_t> next = 0;
    // Blocks are handed out one by one, since some take a hundred times as long as others.
    const std::size_t threads = chunks_for(blocks, 1);
    for_chunks(threads, threads, [&](std::size_t, std::size_t, std::size_t) {
      for (std::uint64_t block; (block = next++) < blocks;) {
        const std::uint64_t pairs = std::min(kBlock, pairs_in_all - block * kBlock);
        std::seed_seq mix{seed, seed >> 32, block, block >> 32, std::uint64_t{rows.size()}};
        std::array<std::uint32_t, 2> words;
        mix.generate(words.begin(), words.end());
        results[block] =
            compare_block(generator, question, pairs, std::uint64_t{words[0]} << 32 | words[1]);
      }
    });
    OracleRow row;
    row.generator = generator.name;
    row.question = question;
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
  };
  for (const OracleQuestion question :
       {OracleQuestion::intersects, OracleQuestion::neighbours, OracleQuestion::clearance}) {
    const std::uint64_t part = question == OracleQuestion::intersects ? 1 : 10;
    for (const PairGenerator& generator : pair_generators()) {
      if (progress) progress(generator.name + ", " + to_string(question));
      compare(generator, question, (pairs_per_generator + part - 1) / part);
    }
  }
  return rows;
}

std::string oracles_table(const std::vector<OracleRow>& rows) {
  std::string out =
      fmt::format("{:<17} {:<10} {:>10} {:>13} {:>13} {:>10} {:>12}\n", "generator", "question",
                  "pairs", "yes", "disagreements", "exact ns", "integers ns");
  for (const OracleRow& row : rows) {
    out += fmt::format("{:<17} {:<10} {:>10} {:>13} {:>13} {:>10.0f} {:>12.0f}\n", row.generator,
                       to_string(row.question), row.pairs, row.intersecting, row.disagreements,
                       row.cgal_ns, row.integer_ns);
  }
  for (const OracleRow& row : rows) {
    if (row.disagreements > 0)
      out += fmt::format("{}, {}: {}\n", row.generator, to_string(row.question), row.example);
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
    generators.push_back(json_of(row));
    generators.back()["example"] = text_json(row.example);
  }
  return {{"seed", seed},
          {"pairs_per_generator", pairs_per_generator},
          {"disagreements", disagreements},
          {"generators", generators}};
}

}  // namespace farcull
