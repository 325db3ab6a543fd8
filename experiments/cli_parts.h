// What the commands share: optional texts, outputs and progress.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/cull.h"

namespace farcull {

using Text = std::optional<std::string>;  // of an option; empty where it was not given

/// The one line of a failure, on standard error. A path may hold anything, so control characters do
/// not get through.
void complain(const std::string& message);

/// One line on standard error that is written over, on a terminal only.
class TerminalProgress {
 public:
  Progress callback();
  void clear();
  TerminalProgress() = default;
  ~TerminalProgress() { clear(); }
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;

 private:
  void show(std::string line);

  bool shown_ = false;
};

/// Where results go besides the table.
struct Outputs {
  Text json;
  Text pairs;
  Text certificate;
  Text csv;

  bool to_stdout() const { return json == "-" || pairs == "-" || certificate == "-" || csv == "-"; }
};

/// The outputs, or an Error for what can be known to go wrong with them before anything is read or
/// run.
Outputs checked(Outputs outputs);

/// Empty where none is asked for. Throws Error where the value is empty.
std::string device_of(const Text& device);

void write_json(const nlohmann::ordered_json& json, const std::string& path);

inline constexpr const char* kViewsHelp =
    "axes or directions to look along, by commas, as in\n"
    "x,-y,1:1:0.5; default x,y,z";
inline constexpr const char* kDeviceHelp =
    "software, hardware or a number that `farcull doctor`\n"
    "lists; default hardware first, then software";
inline constexpr const char* kJsonHelp =
    "write the record as JSON to this file; - for standard\n"
    "output, without the table";

}  // namespace farcull
