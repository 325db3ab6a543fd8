// What leaves the program for other programs: JSON and CSV. Files appear whole or not at all.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/run.h"

namespace farcull {

/// Keys keep their order, so that the same run gives the same text.
nlohmann::ordered_json to_json(const Scene& scene, const RunRecord& record);

/// The floating-point environment of the caller and the one in force.
nlohmann::ordered_json floating_point_json(const FloatingPoint& callers, const FloatingPoint& used);

/// What the scene does not ask (verify/not_asked.h): objects, pairs, and which objects, as the
/// first and the last of each run of them.
nlohmann::ordered_json not_asked_json(const Scene& scene);

/// The colliding pairs as verify/pair_list.h writes them, sorted, each once; neighbours among them
/// where an object of the scene is tested against itself.
std::string pairs_csv(const Scene& scene, const RunRecord& record);
/// Its parts, `before` at the start of each row.
std::string pairs_header(const Scene& scene);
std::string pairs_rows(const Scene& scene, const RunRecord& record, const std::string& before);

/// Throws Error naming the path if write_output would refuse it for what is known before anything
/// is written: no such folder, a directory, no permission, a closed standard output. So a run of an
/// hour does not end there.
void check_output(const std::string& path);

/// Writes the text beside the path and renames it into place; "-" is standard output. A symbolic
/// link stays and its file is replaced; devices and pipes take the text as it comes. Throws Error
/// naming the path where the disk, the folder or a closed pipe refuses. Nothing half-written is
/// left, also where SIGINT, SIGTERM or SIGHUP ends the program meanwhile. SIGPIPE and SIGXFSZ have
/// to be ignored for that (prepare_output()).
void write_output(const std::string& path, const std::string& text);

/// Once, at the start of the program: a full disk and a closed pipe answer with an error instead of
/// a signal, and standard streams that are closed do not let a file take their number.
void prepare_output();

}  // namespace farcull
