// Reads a shard from text or from the environment.
#include "experiments/studies/shard.h"

#include <fmt/format.h>

#include <optional>

#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {
namespace {

constexpr long kMostShards = 100'000;

bool is_shard(long index, long of) {
  return of >= 1 && of <= kMostShards && index >= 1 && index <= of;
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::optional<long> index = parse_number<long>(text.substr(0, slash));
  const std::optional<long> of =
      slash == std::string::npos ? std::nullopt : parse_number<long>(text.substr(slash + 1));
  if (!index || !of || !is_shard(*index, *of)) {
    throw Error("--shard", "'" + text + "' is no shard",
                fmt::format("give K/N with 1 <= K <= N <= {}, such as 2/4", kMostShards));
  }
  return {static_cast<int>(*index), static_cast<int>(*of), "--shard"};
}

Shard shard_from_environment(const std::function<const char*(const char*)>& variable) {
  const char* const remedy = "give --shard K/N, or 1/1 for the whole";
  const auto number = [&](const char* name) -> std::optional<long> {
    const char* const text = variable(name);
    if (text == nullptr) return std::nullopt;
    const std::optional<long> out = parse_number<long>(text);
    if (!out) throw Error(name, fmt::format("'{}' is no number", text), remedy);
    return out;
  };
  const auto made = [&](const char* name, long index, long of) -> Shard {
    if (!is_shard(index, of))
      throw Error(name, fmt::format("makes this part {} of {}, which is none", index, of), remedy);
    return {static_cast<int>(index), static_cast<int>(of), name};
  };

  const std::optional<long> task = number("SLURM_ARRAY_TASK_ID");
  const std::optional<long> rank = number("OMPI_COMM_WORLD_RANK");
  const std::optional<long> size = number("OMPI_COMM_WORLD_SIZE");
  // A single process under mpirun or srun divides nothing.
  const bool ranks = rank && size && *size != 1;
  if (task && ranks) {
    throw Error("SLURM_ARRAY_TASK_ID", "and OMPI_COMM_WORLD_RANK both say which part this is",
                remedy);
  }
  if (task) {
    const long least = number("SLURM_ARRAY_TASK_MIN").value_or(0);
    const std::optional<long> most = number("SLURM_ARRAY_TASK_MAX");
    const std::optional<long> count = number("SLURM_ARRAY_TASK_COUNT");
    if (!most || !count || *most - least + 1 != *count) {
      throw Error("SLURM_ARRAY_TASK_COUNT", "the array has gaps, or does not say where it ends",
                  "submit it as --array=1-N, or give --shard K/N");
    }
    // A part of an array that is submitted again would take itself for the whole.
    if (least != 0 && least != 1) {
      throw Error("SLURM_ARRAY_TASK_MIN", fmt::format("the array begins at {}", least),
                  "submit it as --array=1-N, all of it (what is done is not measured again), or "
                  "give --shard K/N");
    }
    return made("SLURM_ARRAY_TASK_ID", *task - least + 1, *count);
  }
  if (ranks) return made("OMPI_COMM_WORLD_RANK", *rank + 1, *size);
  return {};
}

}  // namespace farcull
