// `farcull check`: a certificate against the scene that it speaks about; and how a run leaves one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/run.h"
#include "verify/certificate.h"

namespace farcull {

struct CheckArguments {
  std::string certificate;         // a file
  std::vector<std::string> scene;  // as of `farcull run`
  std::string json = {};           // "" for none, "-" for standard output instead of the text
  bool self = false;               // every object is tested against itself, as by run --self
  std::string pairs = {};          // "" for none, or the list that `farcull run --pairs` wrote
};

/// Prints the verdict. 0: proved, and the list that is given is the one that is proved; 1: refuted
/// or not proved. Throws Error where the certificate, the scene or the list cannot be read.
int check_command(const CheckArguments& arguments);

/// What the run claims. kept: the pairs it left to the exact tests, sorted; for the method `exact`,
/// which culls nothing, the colliding ones (record.pairs), so that every other pair is proved
/// disjoint. Times are left out, so the same run gives the same text.
Certificate certificate_of(const Scene& scene, const RunRecord& record,
                           std::span<const TrianglePair> kept);

}  // namespace farcull
