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

#include "experiments/contestants/contestant.h"

namespace farcull {
namespace {

bool triangles_intersect(const ContestPair& pair) {
  const auto& [a, b] = pair.triangles;
  return vtkTriangle::TrianglesIntersect(a[0].data(), a[1].data(), a[2].data(), b[0].data(),
                                         b[1].data(), b[2].data()) != 0;
}

bool intersection_filter(const ContestPair& pair) {
  auto [a, b] = pair.triangles;
  int coplanar = 0;
  double from[3], to[3], surfaces[2];
  constexpr double kTolerance = 1e-6;  // the filter's own default
  return vtkIntersectionPolyDataFilter::TriangleTriangleIntersection(
             a[0].data(), a[1].data(), a[2].data(), b[0].data(), b[1].data(), b[2].data(), coplanar,
             from, to, surfaces, kTolerance) != 0;
}

void fill(vtkPolyData& data, const ContestMesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const ContestPoint& p : mesh.vertices) points->InsertNextPoint(p.data());
  vtkNew<vtkCellArray> cells;
  for (const auto& [a, b, c] : mesh.triangles) {
    const vtkIdType corners[3] = {a, b, c};
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
  filter->SetBoxTolerance(0);
  filter->SetCellTolerance(0);
  filter->SetCollisionModeToAllContacts();
  filter->GenerateScalarsOff();
  filter->Update();
  vtkIdTypeArray *first = filter->GetContactCells(0), *second = filter->GetContactCells(1);
  std::vector<std::pair<vtkIdType, vtkIdType>> out;
  for (vtkIdType i = 0; i < first->GetNumberOfTuples(); ++i)
    out.emplace_back(first->GetValue(i), second->GetValue(i));
  return out;
}

bool collision_pair(const ContestPair& pair) {
  vtkNew<vtkPolyData> a, b;
  fill(*a, {.vertices = {pair.triangles[0].begin(), pair.triangles[0].end()},
            .triangles = {{0, 1, 2}}});
  fill(*b, {.vertices = {pair.triangles[1].begin(), pair.triangles[1].end()},
            .triangles = {{0, 1, 2}}});
  return !contacts(a, b).empty();
}

std::vector<ContestFound> collision_scene(const ContestScene& scene) {
  std::vector<ContestFound> out;
  for_each_object_pair(scene, [&](std::uint32_t o, std::uint32_t p) {
    if (o == p) throw Refusal("vtkCollisionDetectionFilter takes two models");
    vtkNew<vtkPolyData> a, b;
    fill(*a, scene.objects[o]);
    fill(*b, scene.objects[p]);
    for (const auto& [t, u] : contacts(a, b))
      out.push_back({o, static_cast<std::uint32_t>(t), p, static_cast<std::uint32_t>(u)});
  });
  return out;
}

ContestantCard card(const std::string& name, const std::string& call, const std::string& says) {
  return {.name = name,
          .library = std::string("VTK ") + vtkVersion::GetVTKVersion(),
          .means = Means::crossing,
          .degenerate = false,
          .call = call,
          .says = says,
          .use = "visualization, where a wrong contact is seen and does no harm"};
}

}  // namespace
}  // namespace farcull

int main(int argc, char** argv) {
  using namespace farcull;
  return contest(
      argc, argv,
      {{.card = card("vtk-collision", "vtkCollisionDetectionFilter, all contacts, tolerances 0",
                     "its documentation says nothing of exactness; cells intersect where lines of "
                     "contact are found"),
        .pair = collision_pair,
        .mesh = collision_scene},
       {.card = card("vtk-triangle", "vtkTriangle::TrianglesIntersect()",
                     "the algorithm of Guigue and Devillers, in double"),
        .pair = triangles_intersect},
       {.card =
            card("vtk-intersection",
                 "vtkIntersectionPolyDataFilter::TriangleTriangleIntersection(), tolerance 1e-6",
                 "a geometric tolerance is given; coplanar triangles are told apart"),
        .pair = intersection_filter}});
}
