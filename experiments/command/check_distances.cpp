// Reads a certificate of distances and its scene, and prints what the checker finds.
#include "experiments/command/check_distances.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "core/scene/ignored.h"
#include "experiments/command/frame_checks.h"
#include "experiments/command/options.h"
#include "experiments/record/check_result.h"
#include "experiments/record/distance_result.h"
#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/text.h"
#include "experiments/scenes/scene_file.h"
#include "experiments/system/interrupt.h"
#include "experiments/system/output_file.h"
#include "experiments/system/text_table.h"
#include "verify/certificate/distance_certificate.h"

namespace farcull {
namespace {

CheckedDistances checked(const std::string& path, DistanceCertificate certificate,
                         const Scene& scene) {
  require_nothing_ignored(scene, "a check");
  CheckedDistances out{clean_name(path), std::move(certificate), {}};
  out.result = check_distances(out.certificate, scene, out.file);
  return out;
}

}  // namespace

std::string clean_lines(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    out += clean_name(std::string_view(text).substr(at, end - at)) + "\n";
    at = end + 1;
  }
  return out;
}

bool is_of_distances(const std::string& file) {
  std::array<char, 1024> start{};
  std::ifstream in(file, std::ios::binary);
  in.read(start.data(), start.size());
  return is_distance_certificate({start.data(), static_cast<std::size_t>(in.gcount())});
}

int check_distance_file(const DistanceCheckArguments& arguments, const std::string& text) {
  // Before the scene, which may be large.
  DistanceCertificate certificate =
      parse_distance_certificate(text, clean_name(arguments.certificate));
  Scene scene = load_scene(arguments.scene);
  if (arguments.self) make_self(scene);
  const CheckedDistances check = checked(arguments.certificate, std::move(certificate), scene);
  if (!arguments.json.empty()) write_json(check_json(scene, check), arguments.json);
  if (arguments.json != "-") write_output("-", clean_lines(check_text(scene, check)));
  return check.result.verdict == Verdict::proved ? kExitDone : kExitBroken;
}

int check_distance_frames(const DistanceCheckArguments& arguments, const FrameRange& range) {
  FrameSource source(arguments.scene, range, arguments.self);
  std::optional<FrameChecks> json;
  if (!arguments.json.empty()) json.emplace(arguments.json);
  const bool table = arguments.json != "-";
  Interruptible interruptible(range.count(), "frames", "their verdicts are given", false);
  if (table) {
    write_output("-", fmt::format("{:>7}  {:<10}  {:>10}  {:>12}  {:>10}\n", "frame", "verdict",
                                  "distances", "decided", "ms"));
  }
  FrameVerdicts verdicts;
  for (long frame = range.first; frame <= range.last; ++frame) {
    const std::string file = numbered(arguments.certificate, frame);
    DistanceCertificate certificate =
        parse_distance_certificate(read_file(file, kMaxBytes), clean_name(file));
    const Scene& scene = source.at(frame);
    const CheckedDistances check = checked(file, std::move(certificate), scene);
    const DistanceCheck& result = check.result;
    verdicts.add(frame, result.verdict, check.certificate.distances.size());
    if (table) {
      std::string text = fmt::format(
          "{:>7}  {:<10}  {:>10}  {:>12}  {:>10.1f}\n", frame, to_string(result.verdict),
          grouped(check.certificate.distances.size()), grouped(result.decided), result.ms);
      if (result.verdict != Verdict::proved) text += "         " + verdict_text(scene, check);
      write_output("-", clean_lines(text));
    }
    if (json) {
      nlohmann::ordered_json one = {{"frame", frame}};
      one.update(check_json(scene, check));
      json->add(one, verdicts.json(range.count()));
    }
    interruptible.done(frame - range.first + 1);
  }
  if (json) json->finish();
  if (table) {
    write_output("-", "\n" + clean_lines(verdicts.text(
                                 "the distances are exactly these, and no others were asked for")));
  }
  return verdicts.in_all() == Verdict::proved ? kExitDone : kExitBroken;
}

}  // namespace farcull
