// A process with limits that is fed lines and answers with lines.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace farcull {

struct ChildLimits {
  double start_s = 60;           // wall clock until the first line
  double line_s = 10;            // from one line to the next
  std::uint64_t cpu_s = 3600;    // CPU time
  std::uint64_t memory_mib = 0;  // of addresses; 0: no limit
};

struct ChildEnd {
  enum class How : std::uint8_t { peace, crash, time, memory } how = How::peace;
  std::string reason;  // but for peace: the signal or the status, and the last that it printed
  /// A limit of the whole process ended it, of CPU time or memory, and not that of one line: what
  /// it did before may have used that up.
  bool used_up = false;
};

/// Starts `command`, whose first word is a path or looked for in PATH, in a process group of its
/// own. `more` gives the next part of its input, or nothing at the end of it. `line` is called with
/// each whole line of its standard output, without the newline; where it returns false, the
/// line was none that may be there, and the group is killed (crash). All of the group has
/// ended on return, and also where `line` throws. Throws Error where no process can be
/// made, or there is no such program.
ChildEnd run_child(const std::vector<std::string>& command, const ChildLimits& limits,
                   const std::function<std::string()>& more,
                   const std::function<bool(std::string_view)>& line);

}  // namespace farcull
