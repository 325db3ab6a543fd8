#include "experiments/method/pair_device.h"

#include "core/base/error.h"
#include "core/gl/pairs/pairs.h"
#include "core/pairs/backend.h"
#include "experiments/method/options.h"

namespace farcull {

PairDevice cpu_pair_device(unsigned threads, const std::string& reason) {
  return {.backend = cpu_pair_backend(threads), .gl = {}, .reason = reason};
}

PairDevice gl_pair_device(const GlContext& context, const std::string& reason) {
  return {.backend = gl_pair_backend(context), .gl = context.info(), .reason = reason};
}

PairDevice open_pair_device(const std::string& device, unsigned threads,
                            const std::function<const GlContext&()>& context) {
  if (is_cpu(device)) return cpu_pair_device(threads, "--device " + device);
  if (!device.empty()) return gl_pair_device(context(), "--device " + device);
  const std::string rule = "no --device: GL where hardware answers, else the CPU; ";
  try {
    if (!GlContext::hardware_listed())
      return cpu_pair_device(threads, rule + "EGL lists no hardware device");
    const GlContext& found = context();
    if (found.info().kind != "hardware")
      return cpu_pair_device(threads, rule + "no hardware device could be opened");
    return gl_pair_device(found, rule + "hardware answered");
  } catch (const Error& error) {
    return cpu_pair_device(threads, rule + error.where + ": " + error.reason);
  }
}

}  // namespace farcull
