// The scene is written as 64-bit words, lowest byte first, so that the proved checker needs no
// reader of meshes: the number of objects, the sizes of the objects, then all coordinates.
#include "experiments/command/verified.h"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"

namespace farcull {
namespace {

constexpr const char* kProgram = "farcull-check-verified";
constexpr const char* kRemedy =
    "build it with `bash tests/coq.sh`, which puts it into build/, or leave --verified out";

[[noreturn]] void refuse(const std::string& what) { throw Error(kProgram, what, kRemedy); }

std::string program() {
  std::error_code error;
  const std::filesystem::path beside =
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / kProgram;
  return std::filesystem::exists(beside, error) ? beside.string() : kProgram;
}

/// The words that scene_hash() hashes, in the same order.
void write_words(const Scene& scene, std::FILE* file) {
  const auto write = [file](std::uint64_t word) {
    std::array<unsigned char, 8> bytes;
    for (unsigned char& byte : bytes) {
      byte = static_cast<unsigned char>(word);
      word >>= 8;
    }
    std::fwrite(bytes.data(), 1, bytes.size(), file);
  };
  write(scene.objects.size());
  for (const Object& object : scene.objects)
    write(object.triangle_count | std::uint64_t{object.self} << 32);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (const Vec3& p : scene.corners(t)) {
      for (int i = 0; i < 3; ++i) write(std::bit_cast<std::uint64_t>(p[i]));
    }
  }
}

}  // namespace

int run_verified_checker(const std::string& certificate, const Scene& scene) {
  // The new process inherits the descriptor, and opens the file by its number.
  const int memory = ::memfd_create("scene", 0);
  std::FILE* file = memory < 0 ? nullptr : ::fdopen(memory, "wb");
  if (file == nullptr) refuse(std::string("no file in memory: ") + std::strerror(errno));
  write_words(scene, file);
  const bool written = std::fflush(file) == 0 && std::ferror(file) == 0;
  std::fflush(stdout);

  std::string path = program();
  std::string words = "/proc/self/fd/" + std::to_string(memory);
  std::string given = certificate;
  const std::array<char*, 4> arguments = {path.data(), given.data(), words.data(), nullptr};
  pid_t child = 0;
  const int error =
      written ? ::posix_spawnp(&child, path.c_str(), nullptr, nullptr, arguments.data(), environ)
              : EIO;
  int status = 0;
  if (error == 0) {
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
  }
  std::fclose(file);
  if (error != 0) refuse(std::string("cannot be run: ") + std::strerror(error));
  constexpr int kUndecided = 3;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kUndecided) {
    throw Error(kProgram, "could not decide the pair that it names",
                "leave --verified out, and report the scene: docs/verified.md says why this should "
                "not happen");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) > kUndecided) refuse("ended without a verdict");
  return WEXITSTATUS(status);
}

}  // namespace farcull
