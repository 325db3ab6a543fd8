// Objects that are not tested against each other, by the names on the command line and in files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace farcull {

/// Treatment of a name that no object has. After the first frame it is not an error: objects may
/// appear and disappear, and an absent object need not be ignored.
enum class UnknownName { refused, passed_over };

/// The pairs of an object that the pattern `first` matches and a different object that `second`
/// matches. A * in a pattern stands for any characters. Errors name `where` and `line`, and call
/// the pair `what`. Throws Error if a pattern is the name of an object and matches others, too.
/// Unless `lacking` is passed_over, also throws Error if a pattern matches no object, or if both
/// match only one object, the same.
std::vector<ObjectPair> pairs_between(const Scene& scene, const std::string& first,
                                      const std::string& second, const std::string& where,
                                      const std::string& what, long line = 0,
                                      UnknownName lacking = UnknownName::refused);

/// Two groups of objects by their names, as in "link*:gripper". A * stands for any characters.
struct IgnoredNames {
  std::string text;   // such as "link*:gripper"
  std::string where;  // --ignore, or the file
  long line = 0;      // of the file, from 1; 0 without one
};

/// The pairs of a list as in "a:b,link*:gripper". Throws Error naming the option if a pair is
/// empty. Here and in files, \ before a comma, colon or * makes it a character of the name.
std::vector<IgnoredNames> parse_ignored(const std::string& list,
                                        const std::string& option = "--ignore");
/// The pairs of a text file, one per line. Empty lines, lines that begin with # and a byte order
/// mark are passed over. Throws Error naming the file if it cannot be read or names no pair.
std::vector<IgnoredNames> read_ignored(const std::string& path);
/// The pairs of a list and of a file, as --ignore and --ignore-file give them; either may be empty.
std::vector<IgnoredNames> ignored_names(const std::optional<std::string>& list,
                                        const std::optional<std::string>& file);

/// The pairs of an object of the first group and a different one of the second, as in_order() gives
/// them. A name may hold colons: each colon is tried as the one between the groups. Throws Error
/// naming `where` and the line if a text has no colon, if objects match both groups at two of its
/// colons, or if a name is ambiguous as in pairs_between(). Unless `lacking` is passed_over, also
/// throws Error if no object matches a name, or if both groups are only one object, the same.
std::vector<ObjectPair> ignored_objects(const Scene& scene, const std::vector<IgnoredNames>& names,
                                        UnknownName lacking = UnknownName::refused);

}  // namespace farcull
