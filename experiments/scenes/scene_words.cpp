// The words of a scene on the command line: names, and options of how meshes are read.
#include <string_view>

#include "experiments/scenes/mesh/load.h"
#include "experiments/scenes/mesh/weld.h"
#include "experiments/scenes/scene_file.h"

namespace farcull {

SceneWords scene_words(const std::vector<std::string>& arguments) {
  constexpr std::string_view kWeld = "--weld=", kFormat = "--format=", kIgnore = "--ignore=";
  SceneWords out;
  for (const std::string& word : arguments) {
    if (word.starts_with(kWeld)) {
      out.reading.weld = word.substr(kWeld.size());
      parse_weld(out.reading.weld);
    } else if (word.starts_with(kFormat)) {
      out.reading.format = named_format(word.substr(kFormat.size()));
    } else if (word.starts_with(kIgnore)) {
      out.ignored = parse_ignored(word.substr(kIgnore.size()));
    } else {
      out.names.push_back(word);
    }
  }
  return out;
}

}  // namespace farcull
