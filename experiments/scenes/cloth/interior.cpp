// Nesterov and Todd's scaling of each cone, and the length of a step that stays inside all cones.
#include "experiments/scenes/cloth/interior.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace farcull::cloth {
namespace {

constexpr double kWidth = 1e-2;          // of a spring's length: how far inside the cone it begins
constexpr double kToTheBoundary = 0.95;  // no further than this part of the way

}  // namespace

double determinant(const ConePoint& u) {
  const double n = u.d.norm();
  return (u.t - n) * (u.t + n);
}

double reach(const ConePoint& u, const ConePoint& du) {
  // The first zero above 0 of (u + a du)'s determinant, c + 2 b a + q a^2, c > 0, and of its t.
  const double q = determinant(du);
  const double b = u.t * du.t - u.d.dot(du.d);
  const double c = determinant(u);
  double first = std::numeric_limits<double>::infinity();
  const double discriminant = b * b - q * c;
  if (discriminant >= 0) {
    const double root = -(b + std::copysign(std::sqrt(discriminant), b));
    for (const double a : {root / q, c / root}) {
      if (a > 0) first = std::min(first, a);
    }
  }
  if (du.t < 0) first = std::min(first, -u.t / du.t);
  return first;
}

Interior::Interior(const Step& step, const Eigen::VectorXd& x, double complementarity)
    : step_(step), springs_(step.model.springs.size()), contacts_(step.model.mass.size()) {
  const Model& model = step.model;
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    SpringState& spring = springs_[i];
    const auto [a, b] = model.springs[i].vertices;
    spring.length = slack_length(model, i);
    spring.u.d = x.segment<3>(3 * b) - x.segment<3>(3 * a);
    spring.u.t = std::max(spring.length, spring.u.d.norm()) + kWidth * model.springs[i].length;
    const double scale = complementarity / determinant(spring.u);
    spring.z = {scale * spring.u.t, -scale * spring.u.d};
  }
  for (std::size_t v = 0; v < contacts_.size(); ++v) {
    ContactState& contact = contacts_[v];
    contact.is_there = !step.normal[v].isZero(0);
    if (!contact.is_there) continue;
    contact.stiffness = contact_stiffness(model, v);
    const double away = step.normal[v].dot(x.segment<3>(3 * v)) - model.settings.radius;
    contact.s = std::max(away, kWidth * model.springs[0].length);
    contact.f = complementarity / contact.s;
  }
}

double Interior::complementarity() const {
  double sum = 0;
  double count = 0;
  for (const SpringState& spring : springs_) {
    sum += spring.u.t * spring.z.t + spring.u.d.dot(spring.z.d);
    ++count;
  }
  for (const ContactState& contact : contacts_) {
    if (!contact.is_there) continue;
    sum += contact.s * contact.f;
    ++count;
  }
  return sum / count;
}

void Interior::linearize(const Eigen::VectorXd& x, double target) {
  target_ = target;
  for (SpringState& spring : springs_) {
    const ConePoint& u = spring.u;
    const ConePoint& z = spring.z;
    // The scaling W^-2, which takes u to z: eta (2 w w' - J) with w = J (u/|u| + J z/|z|)/(2 g),
    // J = diag(1, -1, -1, -1), |u| the root of the determinant.
    const double size_u = std::sqrt(determinant(u));
    const double size_z = std::sqrt(determinant(z));
    const double cosine = (u.t * z.t + u.d.dot(z.d)) / (size_u * size_z);
    const double g = std::sqrt(0.5 * (1 + cosine));
    const double wt = (u.t / size_u + z.t / size_z) / (2 * g);
    const Vec3 wd = (z.d / size_z - u.d / size_u) / (2 * g);
    const double eta = size_z / size_u;
    const double tt = eta * (2 * wt * wt - 1);
    spring.mixed = eta * 2 * wt * wd;
    spring.whole = eta * (2 * wd * wd.transpose() + Block::Identity());
    spring.across = step_.stretch + tt;
    // dz = target u^-1 - z - W^-2 du and du_t = dz_t/c - (t - l* - z_t/c), whence du_t.
    const double inverse = target / (size_u * size_u);
    spring.right =
        inverse * u.t - z.t - step_.stretch * (u.t - spring.length - z.t / step_.stretch);
    spring.block = spring.whole - spring.mixed * spring.mixed.transpose() / spring.across;
    spring.force = inverse * u.d + spring.mixed * spring.right / spring.across;
  }
  for (std::size_t v = 0; v < contacts_.size(); ++v) {
    ContactState& contact = contacts_[v];
    if (!contact.is_there) continue;
    const double away = step_.normal[v].dot(x.segment<3>(3 * v)) - step_.model.settings.radius;
    contact.scaling = contact.f / contact.s;
    // s = f/c + away; the same as above in one dimension.
    const double off = contact.s - contact.f / contact.stiffness - away;
    contact.right = (target / contact.s - contact.f) / contact.stiffness - off;
    const double divisor = 1 + contact.scaling / contact.stiffness;
    contact.block = contact.scaling / divisor;
    contact.force = -target / contact.s + contact.scaling * contact.right / divisor;
  }
}

Block Interior::contact_block(std::size_t vertex) const {
  if (!contacts_[vertex].is_there) return Block::Zero();
  const Vec3& n = step_.normal[vertex];
  return contacts_[vertex].block * n * n.transpose();
}

Vec3 Interior::contact_force(std::size_t vertex) const {
  if (!contacts_[vertex].is_there) return Vec3::Zero();
  return contacts_[vertex].force * step_.normal[vertex];
}

double Interior::move(const Eigen::VectorXd& direction, Eigen::VectorXd& x) {
  double way = 1 / kToTheBoundary;
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    SpringState& spring = springs_[i];
    const auto [a, b] = step_.model.springs[i].vertices;
    const double inverse = target_ / determinant(spring.u);
    const double tt = spring.across - step_.stretch;
    spring.du.d = direction.segment<3>(3 * b) - direction.segment<3>(3 * a);
    spring.du.t = (spring.right - spring.mixed.dot(spring.du.d)) / spring.across;
    spring.dz.t =
        inverse * spring.u.t - spring.z.t - tt * spring.du.t - spring.mixed.dot(spring.du.d);
    spring.dz.d = -inverse * spring.u.d - spring.z.d - spring.mixed * spring.du.t -
                  spring.whole * spring.du.d;
    way = std::min({way, reach(spring.u, spring.du), reach(spring.z, spring.dz)});
  }
  for (std::size_t v = 0; v < contacts_.size(); ++v) {
    ContactState& contact = contacts_[v];
    if (!contact.is_there) continue;
    const double out = step_.normal[v].dot(direction.segment<3>(3 * v));
    contact.ds = (contact.right + out) / (1 + contact.scaling / contact.stiffness);
    contact.df = target_ / contact.s - contact.f - contact.scaling * contact.ds;
    if (contact.ds < 0) way = std::min(way, -contact.s / contact.ds);
    if (contact.df < 0) way = std::min(way, -contact.f / contact.df);
  }
  way *= kToTheBoundary;
  x += way * direction;
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    SpringState& spring = springs_[i];
    const auto [a, b] = step_.model.springs[i].vertices;
    spring.u.d = x.segment<3>(3 * b) - x.segment<3>(3 * a);
    spring.u.t += way * spring.du.t;
    spring.z.t += way * spring.dz.t;
    spring.z.d += way * spring.dz.d;
  }
  for (ContactState& contact : contacts_) {
    contact.s += way * contact.ds;
    contact.f += way * contact.df;
  }
  return way;
}

}  // namespace farcull::cloth
