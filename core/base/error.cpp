// The text of an error: where, line, reason and remedy in one sentence.
#include "core/base/error.h"

#include <utility>

namespace farcull {
namespace {

std::string sentence(const std::string& where, const std::string& reason, const std::string& remedy,
                     long line) {
  std::string text = where;
  if (line > 0) text += ":" + std::to_string(line);
  text += ": " + reason;
  if (!remedy.empty()) text += "; " + remedy;
  return text;
}

}  // namespace

Error::Error(std::string where_, std::string reason_, std::string remedy_, long line_)
    : std::runtime_error(sentence(where_, reason_, remedy_, line_)),
      where(std::move(where_)),
      reason(std::move(reason_)),
      remedy(std::move(remedy_)),
      line(line_) {}

}  // namespace farcull
