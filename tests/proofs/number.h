// Numbers that write down what is done with them, for scripts that Gappa proves. A kernel or a
// filter that computes with them gives the formula that is compiled, with every rounding in it.
//
// The model. An operation whose exact result is x gives x (1 + d) + f, where |d| is at most the
// rounding unit and |f| bounds what underflow or flushing to zero takes. A new d and a new f stand
// for each operation. `Arithmetic` has the bounds.
//
// Magnitudes and signs. A number that may have either sign is a magnitude times a sign, which is
// any number from -1 to 1. So every number is a sum of products: magnitudes, times signs, times a
// factor that holds the roundings. A claim "x >= 0" is handed to Gappa in both ways: as it was
// computed, and sorted by magnitudes. Gappa checks that both are the same polynomial. Then it
// bounds the sum term by term, which is enough, since no magnitude is negative.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace farcull::proofs {

/// What one operation loses, as numbers in Gappa's notation (2b-3 is 2 times 2^-3).
struct Arithmetic {
  std::string unit;      // relative error of a sum, a difference, a product or a root
  std::string product;   // what is added to a product that underflows, at most
  std::string sum;       // the same of a sum or a difference
  std::string quotient;  // relative error of a quotient
};

/// IEEE 754 doubles, rounded to nearest: a sum that is subnormal is exact.
extern const Arithmetic kDouble;
/// IEEE 754 floats, rounded to nearest.
extern const Arithmetic kFloat;
/// Floats of GLSL 4.50, section 4.7.1: any rounding, quotients 2.5 units, results below 2^-126 may
/// be flushed to zero.
extern const Arithmetic kGlsl;

class Script;

class Number {
 public:
  Number() = default;
  Number(double constant);  // NOLINT(google-explicit-constructor): texts mix in literals

  // Each rounds its result.
  friend Number operator+(const Number& a, const Number& b);
  friend Number operator-(const Number& a, const Number& b);
  friend Number operator*(const Number& a, const Number& b);
  friend Number operator-(const Number& a);
  /// A lower bound of |a|, for claims that only grow with it. Throws std::logic_error where `a` is
  /// a sum, whose magnitude is none of the terms.
  friend Number abs(const Number& a);

  // Nothing is rounded.
  friend Number exact_sum(const Number& a, const Number& b);
  friend Number exact_difference(const Number& a, const Number& b);
  friend Number exact_product(const Number& a, const Number& b);

 private:
  friend class Script;

  // Magnitudes and signs of a term, sorted.
  using Term = std::pair<std::vector<std::string>, std::vector<std::string>>;
  using Sum = std::map<Term, std::string>;

  static Number rounded(const Number& exact, const std::string& unit, const std::string& lost);
  static Sum product_of(const Sum& a, const Sum& b);

  Script* script_ = nullptr;  // null: a constant
  std::string text_ = "0";    // as it is computed
  Sum sum_;                   // sorted by magnitudes: what stands before each
  std::shared_ptr<const Number> magnitude_;
};

// The texts of kernels and filters call these; which side a comparison takes is no part of a proof
// about either side. They throw std::logic_error.
bool operator<(const Number& a, const Number& b);
bool operator>(const Number& a, const Number& b);
Number min(const Number& a, const Number& b);
Number max(const Number& a, const Number& b);
Number sqrt(const Number& a);

/// What is known, and what Gappa shall prove.
class Script {
 public:
  explicit Script(const Arithmetic& arithmetic) : arithmetic_(arithmetic) {}
  Script(const Script&) = delete;
  Script& operator=(const Script&) = delete;

  /// A number from 0 to `most`.
  Number magnitude(const std::string& name, const std::string& most = "1b3000");
  /// A number whose magnitude has this name.
  Number value(const std::string& name, const std::string& most = "1b3000");
  /// A number whose magnitude is at most the magnitude of that name, of which more may be said.
  Number within(const std::string& magnitude);
  /// A number from least to most.
  Number between(const std::string& least, const std::string& most);
  /// From -most to most, and any part of it.
  Number part(double most);
  /// (1 + d) a, |d| at most one rounding unit. (Also a / (1 + d) where that rounds to nearest.)
  Number perturbed(const Number& a);
  /// a as the result of a product or of a quotient.
  Number rounded_product(const Number& a);
  Number rounded_quotient(const Number& a);
  /// a + e, |e| at most `most`.
  Number shifted(const Number& a, const std::string& most);
  /// a + b + c where each term may meet both roundings, so in any order.
  Number sum_in_any_order(const Number& a, const Number& b, const Number& c);
  /// (1 + d) a, d from least to most.
  Number scaled(const Number& a, const std::string& least, const std::string& most);

  /// The script that claims that the number is not negative.
  std::string claims_not_negative(const Number& number) const;

 private:
  friend class Number;
  friend Number operator+(const Number& a, const Number& b);
  friend Number operator*(const Number& a, const Number& b);

  std::string fresh(const std::string& prefix, const std::string& bound);
  std::string define(const std::string& text);

  Arithmetic arithmetic_;
  std::vector<std::string> definitions_;
  std::vector<std::string> known_;
  std::map<std::string, int> names_;
  std::map<std::string, std::string> defined_;
  int count_ = 0;
};

/// A double as Gappa reads it, exactly.
std::string literal(double x);

}  // namespace farcull::proofs
