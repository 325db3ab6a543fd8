#include "experiments/report/html.h"

#include <algorithm>
#include <cstdint>

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

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

}  // namespace farcull
