// The table of all chapters.
#include "experiments/report/chapters/chapters.h"

#include <map>

#include "core/base/error.h"
#include "experiments/report/chapters/rows.h"

namespace farcull {

Chapter chapter_of(const StoredStudy& stored) {
  static const std::map<std::string, Chapter (*)(const StoredStudy&)> kChapters = {
      {"scenes", scenes_chapter},       {"culling", culling_chapter},
      {"accuracy", accuracy_chapter},   {"error-time", error_time_chapter},
      {"offsets", offsets_chapter},     {"radius", radius_chapter},
      {"precision", precision_chapter}, {"stability", stability_chapter},
      {"cloth", cloth_chapter},         {"efficiency", efficiency_chapter},
      {"scaling", scaling_chapter},     {"libraries", libraries_chapter},
      {"proximity", proximity_chapter},
  };
  const auto at = kChapters.find(stored.declaration.study);
  if (at == kChapters.end()) {
    throw Error("report",
                "'" + stored.declaration.study + "' is no study that this program reports",
                "use the farcull that measured it");
  }
  Chapter chapter = at->second(stored);
  put_broken_first(chapter);
  return chapter;
}

}  // namespace farcull
