// The meshes of a scene, each read once; and numbered ones, of which another is read for each
// frame.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/scenes/mesh/mesh.h"

namespace farcull {

/// Whether a name holds one place for a number: %d, or %0Nd for N digits (1 to 9) with leading
/// zeros.
bool is_numbered(const std::string& name);
/// The name with the number in its place. Precondition: is_numbered(name), number >= 0.
std::string numbered(const std::string& name, long number);

class MeshCache {
 public:
  /// Without frames every name is that of a file.
  MeshCache() = default;
  /// Numbered names are files of the frame that set_frame() gives.
  explicit MeshCache(long first_frame) : frame_(first_frame) {}
  /// Precondition: made with a frame.
  void set_frame(long frame) { frame_ = frame; }

  /// The mesh of the path; valid until the same path is asked for in another frame. Throws Error as
  /// load_mesh, and for a numbered name without frames that is no file. The meshes of two frames
  /// may differ in their triangles.
  const Mesh& get(const std::string& path);

  /// The numbered names that were asked for.
  std::vector<std::string> numbered_paths() const;

 private:
  struct Moving {
    long frame = 0;
    Mesh mesh;
  };

  std::optional<long> frame_;
  std::map<std::string, Mesh> meshes_;    // by the file's real path
  std::map<std::string, Moving> moving_;  // by the name
};

}  // namespace farcull
