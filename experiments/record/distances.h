// Distances for other programs, as JSON, CSV and certificates, and as a table for people
// (docs/proximity.md).
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "experiments/method/distances.h"
#include "verify/certificate/distance_certificate.h"

namespace farcull {

/// Keys keep their order, so that the same answers give the same text. seed: what the scene was
/// drawn with, where it is random.
nlohmann::ordered_json distances_json(const Scene& scene, const DistanceRecord& record,
                                      std::optional<std::uint64_t> seed = {});

/// A row for each pair, `before` at its start; the names of the columns.
std::string distances_header();
std::string distances_rows(const Scene& scene, const DistanceRecord& record,
                           const std::string& before = "");

/// The distances, of many the first ones, then the stages and the accounting.
std::string distances_table(const Scene& scene, const DistanceRecord& record);

/// The verdict of an accounting, in one line without its end.
std::string verdict_text(const DistanceAccounting& accounting);
/// The pairs, and the classes that they are in.
std::string accounting_sum(const DistanceAccounting& accounting);

/// The answers of the record in the form that a stranger can check, without times and without which
/// object is inside another.
DistanceCertificate certificate_of(const Scene& scene, const DistanceRecord& record);

}  // namespace farcull
