#include "tests/proofs/raw.h"

namespace farcull::proofs {

std::string bounded(const std::vector<std::string>& names, const std::string& most) {
  std::string out;
  for (const std::string& name : names) {
    out += (out.empty() ? "|" : " /\\ |") + name + "| <= " + most;
  }
  return out;
}

std::string raw_script(const std::string& definitions, const std::string& known,
                       const std::string& claim, const std::string& hints) {
  return definitions + "\n{ " + known + " ->\n  " + claim + " }\n" + hints + "\n";
}

}  // namespace farcull::proofs
