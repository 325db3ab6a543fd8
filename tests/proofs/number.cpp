// A number is kept twice: as text, operation by operation, and sorted by magnitudes.
#include "tests/proofs/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace farcull::proofs {
namespace {

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : between) + part;
  return out;
}

std::vector<std::string> merged(const std::vector<std::string>& a,
                                const std::vector<std::string>& b) {
  std::vector<std::string> out;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

[[noreturn]] void undecided(const std::string& what) {
  throw std::logic_error("proofs: " + what + " of numbers that are only bounded");
}

}  // namespace

const Arithmetic kDouble = {"1b-53", "1b-1075", "0", "1b-53"};
const Arithmetic kFloat = {"1b-24", "1b-150", "0", "1b-24"};
const Arithmetic kGlsl = {"1b-23", "1b-126", "1b-126", "5b-24"};

std::string literal(double x) {
  if (x == 0) return "0";
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  auto digits = static_cast<long long>(std::ldexp(fraction, 53));
  exponent -= 53;
  while (digits % 2 == 0) {
    digits /= 2;
    ++exponent;
  }
  return digits < 0 ? fmt::format("(-{}b{})", -digits, exponent)
                    : fmt::format("{}b{}", digits, exponent);
}

Number::Number(double constant) : text_(literal(constant)) {
  if (constant == 0) return;
  sum_[{}] = text_;
  if (constant > 0) {
    magnitude_ = std::make_shared<Number>(*this);
  } else {
    magnitude_ = std::make_shared<Number>(-constant);
  }
}

Number::Sum Number::product_of(const Sum& a, const Sum& b) {
  Sum out;
  for (const auto& [p, x] : a) {
    for (const auto& [q, y] : b) {
      const Term term = {merged(p.first, q.first), merged(p.second, q.second)};
      std::string& factor = out[term];
      factor += (factor.empty() ? "" : " + ") + fmt::format("({})*({})", x, y);
    }
  }
  return out;
}

Number Number::rounded(const Number& exact, const std::string& unit, const std::string& lost) {
  Number out;
  out.script_ = exact.script_;
  if (out.script_ == nullptr) throw std::logic_error("proofs: an operation on constants alone");
  const std::string d = out.script_->fresh("d", unit);
  const bool loses = lost != "0";
  const std::string f = loses ? out.script_->fresh("f", lost) : "";
  out.text_ =
      out.script_->define(fmt::format("({})*(1 + {}){}", exact.text_, d, loses ? " + " + f : ""));
  for (const auto& [term, factor] : exact.sum_)
    out.sum_[term] = fmt::format("({})*(1 + {})", factor, d);
  if (loses) {
    std::string& rest = out.sum_[{}];
    rest += (rest.empty() ? "" : " + ") + f;
  }
  if (exact.magnitude_) {
    // The same rounding, and at most as much is lost.
    Number least = *exact.magnitude_;
    const std::string g = loses ? out.script_->fresh("f", lost) : "";
    least.text_ =
        out.script_->define(fmt::format("({})*(1 + {}){}", least.text_, d, loses ? " - " + g : ""));
    for (auto& [term, factor] : least.sum_) factor = fmt::format("({})*(1 + {})", factor, d);
    if (loses) {
      std::string& rest = least.sum_[{}];
      rest += " - " + g;
    }
    least.script_ = out.script_;
    least.magnitude_ = nullptr;
    out.magnitude_ = std::make_shared<Number>(least);
  }
  return out;
}

Number exact_sum(const Number& a, const Number& b) {
  Number out;
  out.script_ = a.script_ != nullptr ? a.script_ : b.script_;
  out.text_ = fmt::format("({} + {})", a.text_, b.text_);
  out.sum_ = a.sum_;
  for (const auto& [term, factor] : b.sum_) {
    std::string& whole = out.sum_[term];
    whole = whole.empty() ? factor : fmt::format("{} + {}", whole, factor);
  }
  return out;
}

Number exact_difference(const Number& a, const Number& b) { return exact_sum(a, -b); }

Number operator-(const Number& a) {
  Number out = a;
  out.text_ = fmt::format("(-({}))", a.text_);
  for (auto& [term, factor] : out.sum_) factor = fmt::format("(-({}))", factor);
  return out;
}

Number exact_product(const Number& a, const Number& b) {
  Number out;
  out.script_ = a.script_ != nullptr ? a.script_ : b.script_;
  out.text_ = fmt::format("({} * {})", a.text_, b.text_);
  out.sum_ = Number::product_of(a.sum_, b.sum_);
  if (a.magnitude_ && b.magnitude_ && a.magnitude_.get() != &a) {
    Number least;
    least.script_ = out.script_;
    least.text_ = fmt::format("({} * {})", a.magnitude_->text_, b.magnitude_->text_);
    least.sum_ = Number::product_of(a.magnitude_->sum_, b.magnitude_->sum_);
    out.magnitude_ = std::make_shared<Number>(least);
  }
  return out;
}

Number operator+(const Number& a, const Number& b) {
  const Number exact = exact_sum(a, b);
  const Arithmetic& with = exact.script_->arithmetic_;
  return Number::rounded(exact, with.unit, with.sum);
}
Number operator-(const Number& a, const Number& b) { return a + -b; }
Number operator*(const Number& a, const Number& b) {
  const Number exact = exact_product(a, b);
  const Arithmetic& with = exact.script_->arithmetic_;
  return Number::rounded(exact, with.unit, with.product);
}
Number abs(const Number& a) {
  if (!a.magnitude_) undecided("the magnitude of a sum");
  return *a.magnitude_;
}

bool operator<(const Number&, const Number&) { undecided("a comparison"); }
bool operator>(const Number&, const Number&) { undecided("a comparison"); }
Number min(const Number&, const Number&) { undecided("the minimum"); }
Number max(const Number&, const Number&) { undecided("the maximum"); }
Number sqrt(const Number&) { undecided("the root"); }

std::string Script::fresh(const std::string& prefix, const std::string& bound) {
  const std::string name = fmt::format("{}{}", prefix, ++count_);
  known_.push_back(fmt::format("|{}| <= {}", name, bound));
  return name;
}

std::string Script::define(const std::string& text) {
  std::string& name = defined_[text];  // Gappa wants one name for one formula
  if (name.empty()) {
    name = fmt::format("v{}", ++count_);
    definitions_.push_back(fmt::format("{} = {};", name, text));
  }
  return name;
}

Number Script::magnitude(const std::string& name, const std::string& most) {
  if (names_[name]++ == 0) known_.push_back(fmt::format("{} in [0,{}]", name, most));
  Number out;
  out.script_ = this;
  out.text_ = name;
  out.sum_[{{name}, {}}] = "1";
  out.magnitude_ = std::make_shared<Number>(out);
  return out;
}

Number Script::within(const std::string& magnitude) {
  Number out;
  out.script_ = this;
  const std::string sign = fresh("s", "1");
  out.text_ = fmt::format("({} * {})", magnitude, sign);
  out.sum_[{{magnitude}, {sign}}] = "1";
  return out;
}

Number Script::value(const std::string& name, const std::string& most) {
  const Number size = magnitude(name, most);
  Number out = within(name);
  out.magnitude_ = std::make_shared<Number>(size);
  return out;
}

Number Script::between(const std::string& least, const std::string& most) {
  const std::string name = fmt::format("r{}", ++count_);
  known_.push_back(fmt::format("{} in [{},{}]", name, least, most));
  Number out;
  out.script_ = this;
  out.text_ = name;
  out.sum_[{}] = name;
  return out;
}

Number Script::perturbed(const Number& a) { return Number::rounded(a, arithmetic_.unit, "0"); }

Number Script::rounded_product(const Number& a) {
  return Number::rounded(a, arithmetic_.unit, arithmetic_.product);
}
Number Script::rounded_quotient(const Number& a) {
  return Number::rounded(a, arithmetic_.quotient, arithmetic_.product);
}

Number Script::part(double most) {
  return most == 0 ? Number(0.0) : between("-" + literal(most), literal(most));
}

Number Script::shifted(const Number& a, const std::string& most) {
  const Number e = between("-" + most, most);
  Number out = exact_sum(a, e);
  if (a.magnitude_)
    out.magnitude_ = std::make_shared<Number>(exact_sum(*a.magnitude_, between("-" + most, "0")));
  return out;
}

Number Script::sum_in_any_order(const Number& a, const Number& b, const Number& c) {
  const auto twice = [this](const Number& x) { return perturbed(perturbed(x)); };
  return exact_sum(exact_sum(twice(a), twice(b)), twice(c));
}

Number Script::scaled(const Number& a, const std::string& least, const std::string& most) {
  Number factor = between(least, most);
  factor.text_ = fmt::format("(1 + {})", factor.text_);
  factor.sum_[{}] = factor.text_;
  return exact_product(a, factor);
}

std::string Script::claims_not_negative(const Number& number) const {
  std::string out;
  for (const std::string& definition : definitions_) out += definition + "\n";
  out += "claim = " + number.text_ + ";\n{ " + joined(known_, " /\\\n  ") + " ->\n  claim >= 0 }\n";
  // The terms of one magnitude together.
  std::map<std::vector<std::string>, std::string> sorted;
  for (const auto& [term, factor] : number.sum_) {
    std::string& whole = sorted[term.first];
    std::vector<std::string> parts = term.second;
    parts.push_back("(" + factor + ")");
    whole += (whole.empty() ? "" : " + ") + joined(parts, "*");
  }
  std::string terms;
  for (const auto& [magnitudes, factor] : sorted) {
    std::vector<std::string> parts = magnitudes;
    parts.push_back("(" + factor + ")");
    terms += (terms.empty() ? "" : "\n  + ") + joined(parts, "*");
  }
  return out + "claim -> " + terms + ";\n";
}

}  // namespace farcull::proofs
