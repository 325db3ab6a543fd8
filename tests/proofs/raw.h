// Scripts written as formulas, for what is no sum of products.
#pragma once

#include <string>
#include <vector>

namespace farcull::proofs {

/// Variables of magnitude at most `most`, as hypotheses: "|d1| <= m /\ |d2| <= m".
std::string bounded(const std::vector<std::string>& names, const std::string& most);

/// "definitions { known -> claim } hints"
std::string raw_script(const std::string& definitions, const std::string& known,
                       const std::string& claim, const std::string& hints = "");

}  // namespace farcull::proofs
