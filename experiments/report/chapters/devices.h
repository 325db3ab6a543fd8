// The same points of a study on several devices, beside each other.
#pragma once

#include <string>
#include <vector>

#include "experiments/report/chapters/chapter.h"
#include "experiments/studies/store.h"

namespace farcull {

/// What a further device gave at points of a study.
struct DeviceStudy {
  std::string device;  // as Provenance::gl_renderer
  StoredStudy stored;
};

/// Adds to the chapter of `first` a table of each method on its device and on each of the others:
/// at how many points counts differ, what was missed, candidates, and the ratio of times; and a
/// finding for each other device. Only points that both have measured are compared. Adds nothing
/// where there are no others.
void add_devices(const std::string& device, const StoredStudy& first,
                 const std::vector<DeviceStudy>& others, Chapter& chapter);

}  // namespace farcull
