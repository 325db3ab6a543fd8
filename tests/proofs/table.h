// The tables of docs/proofs.md: how much room each bound has, and what is proved by hand.
#pragma once

#include "tests/proofs/bounds.h"

namespace farcull::proofs {

/// A row of the table. `least`: a value, as the table shows it, that Gappa proves.
std::string row(const Bound& bound, const std::string& least);
/// The smallest value that Gappa proves, by bisection, rounded up to four digits.
std::string least_value(const Bound& bound);
/// The value that least_value() shows.
double parsed(const Bound& bound, const std::string& text);

/// The page with both tables made anew; the text around them stays.
std::string page_with_tables(const std::string& page);
/// The cells of the page's row about the bound; empty where it has none.
std::vector<std::string> cells_of(const std::string& page, const Bound& bound);
/// The rows about what is proved by hand.
std::string rows_by_hand();

}  // namespace farcull::proofs
