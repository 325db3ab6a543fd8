// The methods that a run can use, and the abilities of each method. A method is one value of the
// enumeration, one entry of the table in methods.cpp, and the two functions that the entry names.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/stage.h"
#include "core/boxes/join.h"
#include "core/scene/scene.h"

namespace farcull {

/// far: FAR (2004), which draws fattened primitives in the passes of CULLIDE.
/// cullide: CULLIDE (2003). quick_cullide: Quick-CULLIDE (2005).
/// s_cullide: S-CULLIDE (2005), which tests the triangles of one object against each other.
/// i_collide: sweep and prune (I-COLLIDE, 1995). boxes: boxes of blocks of triangles.
/// exact: no culling. For sources and possible misses see docs/methods.md.
enum class Method {
  far,
  cullide,
  quick_cullide,
  s_cullide,
  i_collide,
  boxes,
  exact,
  // A new method goes here.
};

struct Candidates;  // record.h
struct Plan;        // plan.h
class Session;      // session.h

/// Makes all decisions that do not depend on drawn pixels. Sets plan.work, plan.trace and
/// plan.ahead. Precondition: plan.options is set.
using PlanFunction = void(const Scene& scene, unsigned threads, const Progress& progress,
                          Plan& plan);
/// Runs the method: finds the candidates of the planned scene. take: receives the candidates of a
/// tree of boxes as they are found (Candidates::streamed); if empty, the candidates are listed.
using FindFunction = Candidates(const Scene& scene, const Plan& plan, Session& session,
                                const Progress& progress, const TakePairs& take);

/// When a method guarantees to miss no pair.
enum class Promises { never, always, at_budget_radius };

struct Traits {
  Method method;
  const char* name;  // the value of --method
  Promises promises = Promises::never;
  bool draws = false;             // draws on a canvas, in views at a resolution
  bool fattens = false;           // fattens the triangles that it draws, by an offset and a radius
  bool quick = false;             // keeps visibility bits between passes
  bool culls = true;              // false: tests every pair whose boxes overlap
  bool tests_self = false;        // can test an object's triangles against each other
  bool tests_self_alone = false;  // tests only an object's triangles against each other
  bool takes_clearance = false;

  PlanFunction* plan;
  FindFunction* find;
};

const Traits& traits(Method method);

std::span<const Method> all_methods();
std::string to_string(Method method);
/// Returns the method with this name. Throws Error naming `option` for an unknown name.
Method parse_method(const std::string& name, const std::string& option = "{method}");
/// Returns the names of the methods for which `can` returns true; all names if `can` is empty.
std::vector<std::string> list_of_methods(const std::function<bool(const Traits&)>& can = {});
/// Returns the names of list_of_methods() in one text: "far, cullide, ... or exact".
std::string method_names(const std::function<bool(const Traits&)>& can = {});

inline bool draws(Method method) { return traits(method).draws; }
inline bool fattens(Method method) { return traits(method).fattens; }
inline bool tests_self_alone(Method method) { return traits(method).tests_self_alone; }
/// True if a broad phase between objects decides what the method draws.
inline bool has_broad_phase(Method method) { return draws(method) && !tests_self_alone(method); }
inline bool culls(Method method) { return traits(method).culls; }
inline bool tests_self(Method method) { return traits(method).tests_self; }
inline bool takes_clearance(Method method) { return traits(method).takes_clearance; }

PlanFunction plan_drawing, plan_sweep, plan_by_boxes, plan_exact;
FindFunction find_by_drawing, find_by_sweep, find_by_boxes, find_exact;
// The functions of a new method go here.

}  // namespace farcull
