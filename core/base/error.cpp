// Joins the members of an Error into one message, and replaces the parameter names in its texts.
#include "core/base/error.h"

namespace farcull {
namespace {

std::string (*spelling_of_program)(const std::string& name) = nullptr;

bool is_parameter(const std::string& name) {
  return !name.empty() &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos;
}

std::string sentence(const std::string& where, const std::string& reason, const std::string& remedy,
                     long line) {
  return where + (line > 0 ? ":" + std::to_string(line) : "") + ": " + reason +
         (remedy.empty() ? "" : "; " + remedy);
}

}  // namespace

void spell_parameters(std::string (*spelling)(const std::string& name)) {
  spelling_of_program = spelling;
}

std::string spelled(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text[at] == '{' ? text.find('}', at) : std::string::npos;
    const std::string name = end == std::string::npos ? "" : text.substr(at + 1, end - at - 1);
    const std::string word =
        is_parameter(name) && spelling_of_program ? spelling_of_program(name) : name;
    if (!is_parameter(name) || word.empty()) {  // copies one character: no parameter begins here
      out += text[at++];
      continue;
    }
    out += word;
    at = end + 1;
  }
  return out;
}

Error::Error(std::string where_, std::string reason_, std::string remedy_, long line_)
    : std::runtime_error(sentence(spelled(where_), spelled(reason_), spelled(remedy_), line_)),
      where(spelled(where_)),
      reason(spelled(reason_)),
      remedy(spelled(remedy_)),
      line(line_) {}

}  // namespace farcull
