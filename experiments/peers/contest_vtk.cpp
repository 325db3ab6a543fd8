// VTK's two tests of triangles, and vtkCollisionDetectionFilter with its trees of oriented boxes.
#include <vtkCellArray.h>
#include <vtkCollisionDetectionFilter.h>
#include <vtkIdTypeArray.h>
#include <vtkIntersectionPolyDataFilter.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTriangle.h>
#include <vtkVersion.h>

#include "experiments/peers/contestant.h"

namespace farcull {
namespace {

bool triangles_intersect(const SuitePair& pair) {
  const auto &a = pair.a, &b = pair.b;
  return vtkTriangle::TrianglesIntersect(a[0].data(), a[1].data(), a[2].data(), b[0].data(),
                                         b[1].data(), b[2].data()) != 0;
}

bool intersection_filter(const SuitePair& pair) {
  auto a = pair.a, b = pair.b;
  int coplanar = 0;
  double from[3], to[3], surfaces[2];
  constexpr double kTolerance = 1e-6;  // default of vtkIntersectionPolyDataFilter
  return vtkIntersectionPolyDataFilter::TriangleTriangleIntersection(
             a[0].data(), a[1].data(), a[2].data(), b[0].data(), b[1].data(), b[2].data(), coplanar,
             from, to, surfaces, kTolerance) != 0;
}

void fill(vtkPolyData& data, const Scene& scene, const Object& object) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const auto [first, last] = vertices_of(scene, object);
  for (std::uint32_t v = first; v <= last; ++v) points->InsertNextPoint(scene.vertices[v].data());
  vtkNew<vtkCellArray> cells;
  for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
    const auto& [a, b, c] = scene.triangles[object.first_triangle + t];
    const vtkIdType corners[3] = {a - first, b - first, c - first};
    cells->InsertNextCell(3, corners);
  }
  data.SetPoints(points);
  data.SetPolys(cells);
}

std::vector<std::pair<vtkIdType, vtkIdType>> contacts(vtkPolyData* a, vtkPolyData* b) {
  vtkNew<vtkMatrix4x4> identity;
  vtkNew<vtkCollisionDetectionFilter> filter;
  filter->SetInputData(0, a);
  filter->SetInputData(1, b);
  filter->SetMatrix(0, identity);
  filter->SetMatrix(1, identity);
  filter->SetCollisionModeToAllContacts();
  filter->GenerateScalarsOff();
  filter->Update();
  vtkIdTypeArray *first = filter->GetContactCells(0), *second = filter->GetContactCells(1);
  std::vector<std::pair<vtkIdType, vtkIdType>> out;
  for (vtkIdType i = 0; i < first->GetNumberOfTuples(); ++i)
    out.emplace_back(first->GetValue(i), second->GetValue(i));
  return out;
}

std::vector<TrianglePair> collision_scene(const Scene& scene) {
  std::vector<TrianglePair> out;
  for_each_object_pair(scene, [&](const Object& o, const Object& p) {
    if (&o == &p) throw Refusal("vtkCollisionDetectionFilter takes two models");
    vtkNew<vtkPolyData> a, b;
    fill(*a, scene, o);
    fill(*b, scene, p);
    for (const auto& [t, u] : contacts(a, b)) {
      out.push_back({o.first_triangle + static_cast<std::uint32_t>(t),
                     p.first_triangle + static_cast<std::uint32_t>(u)});
    }
  });
  return out;
}

bool collision_pair(const SuitePair& pair) { return !collision_scene(two_objects(pair)).empty(); }

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  const std::string library = std::string("VTK ") + vtkVersion::GetVTKVersion();
  return contest(
      argc, argv,
      {{.card = crossing_card("vtk-collision", library),
        .pair = collision_pair,
        .mesh = collision_scene},
       {.card = crossing_card("vtk-triangle", library), .pair = triangles_intersect},
       {.card = crossing_card("vtk-intersection", library), .pair = intersection_filter}});
}
