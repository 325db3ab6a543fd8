// The methods that a run can choose between, and what each can do.
#pragma once

#include <span>
#include <string>

namespace farcull {

/// far: FAR (2004), CULLIDE's passes on fattened primitives. cullide: CULLIDE (2003).
/// quick_cullide: Quick-CULLIDE (2005). s_cullide: S-CULLIDE (2005), every triangle an owner.
/// i_collide: sweep and prune (I-COLLIDE, 1995). far_pairs: interval pairs. exact: no culling.
/// docs/methods.md tells each one's source and where it can miss.
enum class Method { far, cullide, quick_cullide, s_cullide, i_collide, far_pairs, exact };

std::span<const Method> all_methods();
std::string to_string(Method method);
/// Throws Error naming `option` for an unknown one.
Method parse_method(const std::string& name, const std::string& option = "--method");
/// "far, cullide, ... or exact", of those that `can`; all where it is null.
std::string method_names(bool (*can)(Method) = nullptr);

/// Draws on a canvas, in views at a resolution: far and the CULLIDE family.
bool draws(Method method);
/// Can test an object's triangles against each other.
bool tests_self(Method method);
/// Tests nothing else: without an object that is tested against itself it has no question.
bool tests_self_alone(Method method);
/// Takes a clearance.
bool takes_clearance(Method method);

}  // namespace farcull
