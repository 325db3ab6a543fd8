#include "experiments/report/chapter.h"

#include <map>

#include "core/error.h"
#include "experiments/report/pictures.h"
#include "experiments/report/rows.h"

namespace farcull {
namespace {

const std::map<std::string, ChapterOf>& chapters() {
  static const std::map<std::string, ChapterOf> all = {
      {"accuracy", accuracy_chapter},     {"error-time", error_time_chapter},
      {"offsets", offsets_chapter},       {"radius", radius_chapter},
      {"precision", precision_chapter},   {"stability", stability_chapter},
      {"efficiency", efficiency_chapter}, {"scaling", scaling_chapter},
  };
  return all;
}

}  // namespace

Chapter chapter_of(const StoredStudy& stored) {
  const auto at = chapters().find(stored.declaration.study);
  if (at == chapters().end()) {
    throw Error("report",
                "'" + stored.declaration.study + "' is no study that this program reports",
                "use the farcull that measured it");
  }
  Chapter chapter = at->second(stored);
  put_broken_first(chapter);
  if (chapter.study == "accuracy") chapter.pictures = accuracy_pictures(stored);
  return chapter;
}

}  // namespace farcull
