#include "experiments/pair_device.h"

#include "core/error.h"
#include "core/gl_pairs.h"
#include "core/pairs_cpu.h"

namespace farcull {
namespace {

PairDevice on_cpu(unsigned threads, const std::string& reason) {
  return {.backend = cpu_pair_backend(threads), .gl = {}, .reason = reason};
}

PairDevice on_gl(const GlContext& context, const std::string& reason) {
  return {.backend = gl_pair_backend(context), .gl = context.info(), .reason = reason};
}

}  // namespace

PairDevice open_pair_device(const std::string& device, unsigned threads,
                            const std::function<const GlContext&()>& context) {
  if (device == "cpu") return on_cpu(threads, "--device cpu");
  if (!device.empty()) return on_gl(context(), "--device " + device);
  const std::string rule = "no --device: GL where hardware answers, else the CPU; ";
  try {
    if (!GlContext::hardware_listed())
      return on_cpu(threads, rule + "EGL lists no hardware device");
    const GlContext& found = context();
    if (found.info().kind != "hardware")
      return on_cpu(threads, rule + "no hardware device could be opened");
    return on_gl(found, rule + "hardware answered");
  } catch (const Error& error) {
    return on_cpu(threads, rule + error.where + ": " + error.reason);
  }
}

}  // namespace farcull
