// Objects that are not tested against each other, as the command line and files name them.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Treatment of a name that no object has. In a frame after the first one it is no mistake: objects
/// may come and go, and an object that is not there needs not be ignored.
enum class Lacking { refused, passed_over };

/// The pairs of different objects of which one has a name of the first pattern and the other one a
/// name of the second. In a pattern a * stands for any characters. where, line: of an error; what:
/// the pair as an error names it. Throws Error where a pattern does not tell which objects it
/// means; and, unless that is passed over, where no object has a name of a pattern, and where both
/// patterns name one and the same object alone.
std::vector<ObjectPair> pairs_between(const Scene& scene, const std::string& first,
                                      const std::string& second, const std::string& where,
                                      const std::string& what, long line = 0,
                                      Lacking lacking = Lacking::refused);

/// Two groups of objects by their names, as in "link*:gripper". A * stands for any characters.
struct IgnoredNames {
  std::string text;   // such as "link*:gripper"
  std::string where;  // --ignore, or the file
  long line = 0;      // of the file, from 1; 0 without one
};

/// The pairs of a list as in "a:b,link*:gripper". Throws Error naming --ignore where one is empty.
std::vector<IgnoredNames> parse_ignored(const std::string& list);
/// The pairs of a text file, one a line; empty lines and those that begin with # are passed over.
/// A byte order mark is passed over. Throws Error naming the file where it cannot be read or names
/// no pair.
std::vector<IgnoredNames> read_ignored(const std::string& path);

/// The pairs of different objects of which one is of the first group and the other one of the
/// second; as in_order() gives them. A name may hold colons: each place where both sides name
/// objects is tried. Throws Error naming `where` and the line for a text without a colon, where two
/// places fit; and, unless that is passed over, for a name that no object has, and where the two
/// groups are one object.
std::vector<ObjectPair> ignored_objects(const Scene& scene, const std::vector<IgnoredNames>& names,
                                        Lacking lacking = Lacking::refused);

}  // namespace farcull
