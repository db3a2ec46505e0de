#include "physics/wall_overlay.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace filum {
namespace {

/// dx/dxi at the middle of an element.
Mat3 middle(const std::array<int, 8>& nodes, const Points& x) {
  const Eigen::Matrix<double, 8, 3> products = product_derivatives(Vec3::Zero());
  Mat3 J = Mat3::Zero();
  for (int b = 1; b < 8; ++b) {  // coefficient of a product: mean of the corners with its signs
    Vec3 c = Vec3::Zero();
    for (int a = 0; a < 8; ++a) {
      int sign = 1;
      for (int bit = 1; bit < 8; bit <<= 1)
        if ((b & bit) != 0 && (a & bit) == 0) sign = -sign;
      c += 0.125 * sign * x.col(nodes[static_cast<std::size_t>(a)]);
    }
    J += c * products.row(b);
  }
  return J;
}

/// int N_a (x_,s cross x_,t) ds dt over a bilinear face, exact by 2 x 2 Gauss points.
void add_areas(const std::array<int, 4>& node, const Points& x, Points& area) {
  constexpr double kSign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (const auto& gauss : kSign) {
    const double s = kGauss * gauss[0], t = kGauss * gauss[1];
    Vec3 xs = Vec3::Zero(), xt = Vec3::Zero();
    double weight[4];
    for (int a = 0; a < 4; ++a) {
      const Vec3 at = x.col(node[static_cast<std::size_t>(a)]);
      xs += 0.25 * kSign[a][0] * (1.0 + kSign[a][1] * t) * at;
      xt += 0.25 * kSign[a][1] * (1.0 + kSign[a][0] * s) * at;
      weight[a] = 0.25 * (1.0 + kSign[a][0] * s) * (1.0 + kSign[a][1] * t);
    }
    const Vec3 n = xs.cross(xt);
    for (int a = 0; a < 4; ++a) area.col(node[static_cast<std::size_t>(a)]) += weight[a] * n;
  }
}

}  // namespace

WallOverlay::WallOverlay(const VesselMesh& mesh, const std::vector<WallLayer>& layers, const Points& reference)
    : mesh_(mesh), elements_(mesh, layers), reference_(reference), held_(static_cast<std::size_t>(mesh.n_nodes()), 0), count_(static_cast<std::size_t>(mesh.n_nodes()), 0) {
  for (const int i : mesh.held) held_[static_cast<std::size_t>(i)] = 1;
  for (const auto& nodes : mesh.elements)
    for (const int i : nodes) ++count_[static_cast<std::size_t>(i)];
}

void WallOverlay::strain(const Points& x, std::vector<double>& out) const {
  out.assign(static_cast<std::size_t>(mesh_.n_nodes()), 0.0);
  for (const auto& nodes : mesh_.elements) {
    const Mat3 F = middle(nodes, x) * middle(nodes, reference_).inverse();
    const double largest = std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Mat3>(F.transpose() * F, Eigen::EigenvaluesOnly).eigenvalues()[2])) - 1.0;
    for (const int i : nodes) out[static_cast<std::size_t>(i)] += largest / count_[static_cast<std::size_t>(i)];
  }
}

void WallOverlay::pressure(const Points& x, std::vector<double>& out) const {
  Points force = Points::Zero(3, mesh_.n_nodes()), area = force;
  elements_.add_forces(x, std::vector<double>(mesh_.elements.size(), 1.0), force);
  for (const WallFace& face : mesh_.faces) {
    if (face.surface == WallSurface::end) continue;
    std::array<int, 4> node;
    for (std::size_t k = 0; k < 4; ++k) node[k] = mesh_.elements[static_cast<std::size_t>(face.element)][static_cast<std::size_t>(face.corner[k])];
    add_areas(node, x, area);
  }
  out.assign(static_cast<std::size_t>(mesh_.n_nodes()), 0.0);
  for (int i = 0; i < mesh_.n_nodes(); ++i)
    if (const double square = area.col(i).squaredNorm(); held_[static_cast<std::size_t>(i)] == 0 && square > 0.0)
      out[static_cast<std::size_t>(i)] = force.col(i).dot(area.col(i)) / square;
}

}  // namespace filum
