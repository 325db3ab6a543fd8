// Runs the groups of probes in turn. A group that breaks off fails, and the next one runs.
#include "core/gl/probe.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/gl/probe_groups.h"
#include "core/gl/probe_target.h"

namespace farcull {

std::vector<ProbeResult> run_probes(const GlContext& context, const ProbeOptions& options,
                                    const std::function<void(const std::string&)>& started) {
  struct Group {
    std::vector<std::string> assumptions;
    std::vector<ProbeResult> (*run)(const GlContext&, const ProbeOptions&);
    bool drawing = true, pairs = false;  // who relies on it; of A4, pairs on a part alone
  };
  const Group groups[] = {{{"A1", "A2"}, probe::edges},
                          {{"A3", "A9"}, probe::coverage},
                          {{"A4", "A9"}, probe::arithmetic, true, true},
                          {{"A5"}, probe::depth_tests},
                          {{"A6"}, probe::queries},
                          {{"A7"}, probe::commands},
                          {{"A7"}, probe::pair_commands, false, true},
                          {{"A8"}, probe::memory, true, true},
                          {{"A10"}, probe::driver, true, true}};
  const GlCurrent current(context);
  std::vector<ProbeResult> out;
  for (const Group& group : groups) {
    const auto wanted = [&](const std::string& a) {
      return options.only.empty() || options.only == a;
    };
    if (std::none_of(group.assumptions.begin(), group.assumptions.end(), wanted)) continue;
    if (options.use == ProbeUse::pairs && !group.pairs) continue;
    if (options.use == ProbeUse::drawing && !group.drawing) continue;
    if (started) started(group.assumptions.front());
    std::vector<ProbeResult> results;
    try {
      results = group.run(context, options);
    } catch (const Error& error) {
      for (const std::string& assumption : group.assumptions)
        results.push_back(probe::broken(assumption, "broke off", error));
    }
    for (ProbeResult& r : results) {
      r.drawing = group.drawing;
      r.pairs = r.pairs || (group.pairs && (group.assumptions.front() != "A4" || r.broke_off));
      if (wanted(r.assumption)) out.push_back(std::move(r));
    }
  }
  return out;
}

}  // namespace farcull
