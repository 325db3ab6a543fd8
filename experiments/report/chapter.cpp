#include "experiments/report/chapter.h"

#include <map>

#include "core/error.h"
#include "experiments/report/pictures.h"

namespace farcull {
namespace {

const std::map<std::string, ChapterOf>& chapters() {
  static const std::map<std::string, ChapterOf> all = {
      {"accuracy", accuracy_chapter},
      {"error-time", error_time_chapter},
      {"offsets", offsets_chapter},
      {"efficiency", efficiency_chapter},
      {"scaling", scaling_chapter},
  };
  return all;
}

}  // namespace

Chapter chapter_of(const StoredStudy& stored) {
  const auto at = chapters().find(stored.declaration.study);
  for (const Study& study : studies()) {  // bare: until every study has its chapter
    if (at != chapters().end() || study.name != stored.declaration.study) continue;
    Chapter out;
    out.study = study.name;
    out.title = study.title;
    out.question = study.question;
    out.command = "farcull experiment " + study.name;
    return out;
  }
  if (at == chapters().end()) {
    throw Error("report",
                "'" + stored.declaration.study + "' is no study that this program reports",
                "use the farcull that measured it");
  }
  Chapter chapter = at->second(stored);
  if (chapter.study == "accuracy") chapter.pictures = accuracy_pictures(stored);
  return chapter;
}

}  // namespace farcull
