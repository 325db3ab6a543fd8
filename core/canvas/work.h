// Counts of what a canvas sends to a GL device and reads from it.
#pragma once

#include <cstdint>
#include <optional>

namespace farcull {

/// Counts since the canvas was made. All are 0 for a canvas on the cores of the CPU.
struct CanvasWork {
  std::uint64_t passes = 0;            // Canvas::run() of at least one step
  std::uint64_t draws = 0;             // draw calls
  std::uint64_t dispatches = 0;        // of programs that sum what was sent and pack flags
  std::uint64_t state_changes = 0;     // of program, target or depth test: between steps
  std::uint64_t queries = 0;           // occlusion queries, and one a pass that counts primitives
  std::uint64_t readbacks = 0;         // answers that are read: reports, then each query
  std::uint64_t waits = 0;             // for the device to finish what it was told
  std::uint64_t uploaded_bytes = 0;    // of elements and of the lists of passes
  std::uint64_t downloaded_bytes = 0;  // of reports and queries
  std::uint64_t spans = 0;             // passes and uploads, which the device's clock may time
  std::uint64_t timed = 0;             // spans whose time is known
  double device_ms = 0;                // sum of these times, by the clock of the device

  /// The time of all spans on the device, ms; empty if there was no span, or one was not timed.
  std::optional<double> known_ms() const {
    if (spans == 0 || timed < spans) return {};
    return device_ms;
  }
  /// Calls change(mine, other's) for each count.
  template <class Change>
  void for_each(const CanvasWork& other, const Change& change) {
    change(passes, other.passes);
    change(draws, other.draws);
    change(dispatches, other.dispatches);
    change(state_changes, other.state_changes);
    change(queries, other.queries);
    change(readbacks, other.readbacks);
    change(waits, other.waits);
    change(uploaded_bytes, other.uploaded_bytes);
    change(downloaded_bytes, other.downloaded_bytes);
    change(spans, other.spans);
    change(timed, other.timed);
    change(device_ms, other.device_ms);
  }
  CanvasWork& operator+=(const CanvasWork& other) {
    for_each(other, [](auto& mine, auto its) { mine += its; });
    return *this;
  }
  CanvasWork& operator-=(const CanvasWork& other) {
    for_each(other, [](auto& mine, auto its) { mine -= its; });
    return *this;
  }
};

}  // namespace farcull
