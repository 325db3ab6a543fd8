// Options and answers of the library, to and from those of a run.
#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "experiments/library/farcull.h"
#include "experiments/method/options.h"
#include "verify/contact_kind.h"

namespace farcull {

/// Throws Error naming the option that is bad, whatever the input.
void check(const ColliderOptions& options);

ContactDetail detail_of(ColliderContacts contacts);

/// The ignored pairs of a scene with so many objects. Throws Error where it has them not.
std::vector<ObjectPair> ignored_of(const ColliderOptions& options, std::size_t objects);

ColliderContact given_out(const ContactShape& shape);
std::vector<ColliderContact> given_out(const std::vector<ContactShape>& shapes);

}  // namespace farcull
