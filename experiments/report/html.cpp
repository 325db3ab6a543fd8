// Escapes what HTML and SVG take for markup.
#include "experiments/report/html.h"

#include <algorithm>

namespace farcull {

std::string html_text(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default: {
        const auto byte = static_cast<unsigned char>(c);
        out += (byte < ' ' && c != '\n') || byte == 127 ? ' ' : c;
      }
    }
  }
  return out;
}

std::string html_prose(const std::string& text) {
  std::string out;
  bool code = false;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find('`', from), text.size());
    out += html_text(text.substr(from, to - from));
    // A backtick without a partner is one.
    if (to < text.size()) {
      if (!code && text.find('`', to + 1) == std::string::npos) {
        out += '`';
      } else {
        out += code ? "</code>" : "<code>";
        code = !code;
      }
    }
    from = to + 1;
  }
  return out;
}

}  // namespace farcull
