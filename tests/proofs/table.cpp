// A row has the columns of kHead. Between two comments of the page stands nothing but a table.
#include "tests/proofs/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "tests/proofs/gappa.h"

namespace farcull::proofs {
namespace {

const std::string kHead =
    "| proof | constant | what is proved | ours | least that is proved | room | refused |\n"
    "|---|---|---|---|---|---|---|\n";
const std::string kHandHead =
    "| statement | its proof | what joins it to the table above |\n|---|---|---|\n";

double unit_of(const Bound& bound) {
  if (bound.unit == "u") return 0x1p-53;
  if (bound.unit == "v") return 0x1p-23;
  if (bound.unit == "w") return 0x1p-24;
  return 1;
}

// Digits, rounded up, in the unit or times a power of 2.
std::string shown(const Bound& bound, double value, int digits) {
  if (value == 0) return "0";
  double x = value / unit_of(bound);
  int exponent = 0;
  if (bound.unit.empty() && x < 1e-5) {
    x = 2 * std::frexp(x, &exponent);
    --exponent;
  }
  const double step = std::pow(10.0, std::floor(std::log10(x)) - (digits - 1));
  x = std::ceil(x / step * (1 - 1e-9)) * step;
  const std::string number = fmt::format("{:.{}g}", x, digits);
  if (exponent == 0) return number + (bound.unit.empty() ? "" : " " + bound.unit);
  return number == "1" ? fmt::format("2^{}", exponent) : fmt::format("{} 2^{}", number, exponent);
}

// Bars divide the cells of a table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

bool is_proved(const Bound& bound, double value) { return ask_gappa(bound.script(value)).proved; }

}  // namespace

double parsed(const Bound& bound, const std::string& text) {
  std::istringstream in(text);
  double value = 0;
  std::string rest;
  if (text.starts_with("2^")) return std::ldexp(1, std::stoi(text.substr(2)));
  in >> value >> rest;
  if (rest.starts_with("2^")) return std::ldexp(value, std::stoi(rest.substr(2)));
  return value * unit_of(bound);
}

std::string least_value(const Bound& bound) {
  if (is_proved(bound, 0)) return "0";
  // By halves, then between two halves.
  int proved = 0, refused = 80;
  while (refused - proved > 1) {
    const int middle = (proved + refused) / 2;
    (is_proved(bound, std::ldexp(bound.value, -middle)) ? proved : refused) = middle;
  }
  double high = std::ldexp(bound.value, -proved), low = std::ldexp(bound.value, -refused);
  for (int i = 0; i < 10; ++i) {
    const double middle = 0.5 * (low + high);
    (is_proved(bound, middle) ? high : low) = middle;
  }
  // Rounded up to four digits it may look like more than ours, which is shown with six.
  const std::string least = shown(bound, high, 4);
  return parsed(bound, least) > bound.value ? shown(bound, high, 6) : least;
}

std::string row(const Bound& bound, const std::string& least) {
  const double value = parsed(bound, least);
  // The least value is rounded up, maybe beyond ours.
  const double room = value > 0 ? std::max(bound.value / value, 1.0) : HUGE_VAL;
  const std::string times = !(room < HUGE_VAL) ? "any"
                            : room > 1000 ? fmt::format("2^{:.0f}", std::floor(std::log2(room)))
                                          : fmt::format("{:.3g}", room);
  return fmt::format("| `{}` | `{}` | {} | {} | {} | {} | {} |\n", bound.name, bound.constant,
                     cell(bound.claim), shown(bound, bound.value, 6), least, times,
                     shown(bound, bound.twin * bound.value, 6));
}

std::vector<std::string> cells_of(const std::string& page, const Bound& bound) {
  std::istringstream lines(page);
  const std::string begin = "| `" + bound.name + "` |";
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(begin)) continue;
    std::vector<std::string> cells;
    std::size_t from = 2;
    while (from < line.size()) {
      const std::size_t to = line.find(" | ", from);
      if (to == std::string::npos) {
        cells.push_back(line.substr(from, line.size() - from - 2));
        break;
      }
      cells.push_back(line.substr(from, to - from));
      from = to + 3;
    }
    return cells;
  }
  return {};
}

std::string rows_by_hand() {
  std::string out = kHandHead;
  for (const ByHand& part : proved_by_hand()) {
    out +=
        fmt::format("| {} | {} | {} |\n", cell(part.statement), cell(part.place), cell(part.joins));
  }
  return out;
}

std::string page_with_tables(const std::string& page) {
  std::string rows = kHead;
  for (const Bound& bound : bounds()) rows += row(bound, least_value(bound));
  std::string out = page;
  const auto put = [&out](const std::string& name, const std::string& table) {
    const std::string begin = "<!-- " + name + ": made by farcull_proofs page -->\n",
                      end = "<!-- end of " + name + " -->";
    const std::size_t from = out.find(begin), to = out.find(end);
    if (from == std::string::npos || to == std::string::npos) {
      throw std::runtime_error("proofs: the page has no place for the table '" + name + "'");
    }
    out.replace(from + begin.size(), to - from - begin.size(), table);
  };
  put("bounds", rows);
  put("by hand", rows_by_hand());
  return out;
}

}  // namespace farcull::proofs
