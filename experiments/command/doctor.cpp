// Reads the options; experiments/lemma/doctor has the probes.
#include "experiments/lemma/doctor.h"
#include "experiments/command/commands.h"
#include "experiments/command/options.h"

namespace farcull {
namespace {

class DoctorCommand {
 public:
  CLI::App* add_to(CLI::App& app);
  int run() const;

 private:
  Text device_, json_;
};

CLI::App* DoctorCommand::add_to(CLI::App& app) {
  CLI::App* command =
      add_command(app, "doctor", "the devices, and whether each keeps the assumptions");
  add_option(*command, "--device", device_, "DEVICE", kDeviceHelp);
  add_option(*command, "--json", json_, "FILE", kJsonHelp);
  add_footer(
      *command,
      "Examples:\n  farcull doctor\n  farcull doctor --device native\n"
      "  farcull doctor --device software --json -\n\n"
      "What the probes find is kept for later runs, in $XDG_CACHE_HOME/farcull or\n"
      "~/.cache/farcull: far on OpenGL promises where all of A1 to A10 pass, far-pairs\n"
      "where A4, A7, A8 and A10 do. A run without such a verdict on its device, driver and build "
      "makes\n"
      "one itself.\n\n"
      "Exit status 1: the native canvas or the device breaks an assumption; what relies on it\n"
      "promises nothing.");
  return command;
}

int DoctorCommand::run() const {
  return doctor_command(
      {.device = device_of(device_), .json = checked({.json = json_}, {}).json.value_or("")});
}

}  // namespace

Command add_doctor(CLI::App& app) { return declare<DoctorCommand>(app); }

}  // namespace farcull
