// The C++ side of experiments/python_overhead.py: makes the same calls as the module, one for each
// line of its input.
//   farcull_python_overhead FOLDER    with the arrays V0, V1 (doubles), F and S (32-bit indices)
// Input: "collide N" or "find N", with the vertices VN. Output: processor time in ms, and the
// pairs.
#include <array>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include "experiments/library/farcull.h"

namespace {

template <class Number>
std::vector<Number> read(const std::string& name) {
  std::ifstream in(name, std::ios::binary | std::ios::ate);
  std::vector<Number> out(static_cast<std::size_t>(in.tellg()) / sizeof(Number));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(out.data()),
          static_cast<std::streamsize>(out.size() * sizeof(Number)));
  if (!in) throw std::ios_base::failure(name);
  return out;
}

double used_ms() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

std::size_t pairs_of(const farcull::Result& result) { return result.pairs.size(); }

}  // namespace

int main(int, char** arguments) {
  const std::string folder = std::string(arguments[1]) + "/";
  const std::array vertices = {read<double>(folder + "V0"), read<double>(folder + "V1")};
  const auto triangles = read<std::uint32_t>(folder + "F");
  const auto starts = read<std::uint32_t>(folder + "S");
  const farcull::Options options{.threads = 1};
  farcull::Collider kept(options);
  std::string call;
  std::size_t which = 0;
  while (std::cin >> call >> which) {
    const farcull::Input input{vertices.at(which), triangles, starts};
    const double begun = used_ms();
    const std::size_t pairs =
        call == "find" ? pairs_of(kept.find(input)) : pairs_of(farcull::collide(input, options));
    std::cout << std::setprecision(9) << used_ms() - begun << ' ' << pairs << std::endl;
  }
}
