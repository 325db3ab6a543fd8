// Writes and reads cards, a line for each field.
#include "experiments/peers/card.h"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "core/base/error.h"
#include "core/base/text.h"

namespace farcull {
namespace {

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

/// The shortest decimal number that is read back as this one.
std::string shortest(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::optional<bool> yes_or_no(const std::string& text) {
  if (text == "yes") return true;
  if (text == "no") return false;
  return {};
}

// False: the key is unknown or the value is none of it.
bool set(ContestantCard& card, const std::string& key, const std::string& value) {
  const std::map<std::string, std::string*> texts = {
      {"name", &card.name}, {"library", &card.library}, {"call", &card.call},
      {"says", &card.says}, {"source", &card.source},   {"use", &card.use}};
  const std::map<std::string, bool*> flags = {{"degenerate", &card.degenerate},
                                              {"neighbours", &card.neighbours},
                                              {"promises", &card.promises},
                                              {"pairs", &card.pairs},
                                              {"meshes", &card.meshes}};
  if (const auto text = texts.find(key); text != texts.end()) {
    *text->second = value;
    return !value.empty();
  }
  if (const auto flag = flags.find(key); flag != flags.end()) {
    const std::optional<bool> read = yes_or_no(value);
    if (read) *flag->second = *read;
    return read.has_value();
  }
  if (key == "means") {
    card.means = value == "crossing" ? Means::crossing : Means::closed;
    return value == "crossing" || value == "closed";
  }
  if (key == "margin") {
    const auto margin = parse_number<double>(value);
    if (margin) card.margin = *margin;
    return margin.has_value() && *margin >= 0 && std::isfinite(*margin);
  }
  if (key == "memory") {
    const auto mib = parse_number<std::uint64_t>(value);
    if (mib) card.memory_mib = *mib;
    return mib.has_value() && *mib > 0;
  }
  return false;
}

}  // namespace

std::string card_text(const ContestantCard& card) {
  std::string out;
  const auto add = [&out](const char* key, const std::string& value) {
    out += std::string(key) + " " + one_line(value) + "\n";
  };
  const auto flag = [&add](const char* key, bool value) { add(key, value ? "yes" : "no"); };
  add("name", card.name);
  add("library", card.library);
  add("means", card.means == Means::closed ? "closed" : "crossing");
  flag("degenerate", card.degenerate);
  flag("neighbours", card.neighbours);
  flag("promises", card.promises);
  flag("pairs", card.pairs);
  flag("meshes", card.meshes);
  if (card.margin > 0) add("margin", shortest(card.margin));
  add("memory", std::to_string(card.memory_mib));
  add("call", card.call);
  add("says", card.says);
  if (!card.source.empty()) add("source", card.source);
  add("use", card.use);
  return out + "\n";
}

std::vector<ContestantCard> read_cards(std::string_view text, const std::string& where) {
  std::vector<ContestantCard> out;
  bool open = false;
  long line = 0;
  while (!text.empty()) {
    ++line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string row(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (row.empty()) {
      open = false;
      continue;
    }
    if (!open) out.emplace_back();
    open = true;
    const std::size_t blank = std::min(row.find(' '), row.size() - 1);
    if (!set(out.back(), row.substr(0, blank), row.substr(blank + 1)))
      throw Error(where, "the card says '" + row + "'", "see experiments/peers/card.h", line);
  }
  for (const ContestantCard& card : out) {
    if (card.name.empty() || card.library.empty() || (!card.pairs && !card.meshes))
      throw Error(where, "a card lacks its name, its library, or what it can be asked",
                  "see experiments/peers/card.h");
  }
  return out;
}

}  // namespace farcull
