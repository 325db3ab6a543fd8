// The files that a command reads and those that it writes, and that none of them is both.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/scenes/frames.h"

namespace farcull {

/// A file as the command line names it.
struct NamedFile {
  std::string by;    // the option or argument: "--json", "SCENE"
  std::string path;  // "-": standard output
};

/// The files of a path: with a range one for each frame where the path has a number, else itself.
std::vector<std::string> numbered_files(const std::string& path,
                                        const std::optional<FrameRange>& range);

/// The files that load_scene() and, with a range, FrameSource read for these arguments: the scene
/// file and the meshes that it names, or the mesh files, numbered ones for each frame; for a
/// built-in scene of packaged meshes, and for no arguments (all built-in scenes), the meshes of
/// mesh_folder(). By SCENE. Throws nothing where a file cannot be read: whoever reads the scene
/// says so.
std::vector<NamedFile> scene_files(const std::vector<std::string>& arguments,
                                   const std::optional<FrameRange>& range = {});

/// Throws Error naming both options where an output is one of the inputs: by device and inode,
/// links followed.
void require_not_read(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

/// The same for all outputs of a command, among which is standard output, wherever it goes; and
/// where two outputs are one file, which does not have to exist yet. Anything but a
/// regular file (a terminal, /dev/null) may be an output several times, but "-" only once.
void require_apart(const std::vector<NamedFile>& inputs, std::vector<NamedFile> outputs);

}  // namespace farcull
