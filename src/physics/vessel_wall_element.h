#pragma once
// The element of the vessel wall: eight nodes, 2 x 2 Gauss points in the wall's plane, and through it one or two for each layer
// that the element meets. Energy and forces come from covariant components of C, as in solid-shells:
//   C_13, C_23  at the middles of the sides, interpolated (Dvorkin & Bathe, Eng. Comput. 1:77, 1984): no transverse shear locking
//   C_33        of the middle, and linear in how it changes over the element. With the squares of that change (Betsch & Stein, Commun.
//               Num. Meth. 11:899, 1995, keep them) a radial pressure above about mu (height/length)^2 folds elements in zigzags,
//               because the shear that would hold them has been interpolated away
//   volume      J of points only by Lame's share that plane stress leaves to them (hyperelastic.h); the rest of lambda by the
//               element's mean J: (lambda - lambda_point)/2 V (mean J - 1)^2 (mean dilatation: Nagtegaal, Parks & Rice, CMAME 4:153,
//               1974): no volume locking, and one element through the wall bends as an incompressible plate does.
// Symbols: x(xi,eta,zeta) = sum over the eight products of coordinates of c_m, c by a Walsh-Hadamard transform of the corners.
// C is blind to mirror images: an element whose signed volume falls below half pushes back by a term that is zero otherwise.
// Exact for constant strain in elements whose edges through the wall are parallel. Elements are computed in packs (vessel_wall_kernel.h).
// Neglects: locking of long thin elements that bend in the wall's own plane. Test: vessel_wall_element_test.

#include <vector>

#include "physics/vessel_mesh.h"
#include "physics/vessel_wall_wide.h"

namespace filum {

struct WallLayer {
  std::string name;
  double thickness = 0.0;  // [m], stress-free
  WallLaw law;
};

/// Derivatives of the eight products 1, xi, eta, xi eta, zeta, xi zeta, eta zeta, xi eta zeta: column i by local coordinate i.
Eigen::Matrix<double, 8, 3> product_derivatives(const Vec3& local) noexcept;
/// Shape functions of the corners.
Eigen::Matrix<double, 8, 1> corner_weights(const Vec3& local) noexcept;

class WallElements {
 public:
  /// `single_precision`: forces come from the kernel in float, at half the cost, with errors of about 1e-7 of the stiffest stress.
  /// `wide`: sixteen elements at a time instead of eight, for the same bits (has_wide_lanes() must be true).
  WallElements(const VesselMesh& mesh, const std::vector<WallLayer>& layers, bool single_precision = false, bool wide = has_wide_lanes());

  /// Energy [J]; forces -dE/dx [N] are added to `force` (3 x n). `soundness`: share of stiffness left in each element.
  /// An element turned inside out makes the energy infinite. Allocates nothing.
  double add_forces(const Points& x, const std::vector<double>& soundness, Points& force) const noexcept;

  using Stiffness = Eigen::Matrix<double, 24, 24>;
  /// d(-force)/dx [N/m] of one element, corner by corner. `taut`: fibres count as in tension where they are not.
  Stiffness stiffness(int element, const Points& x, bool taut = false) const noexcept;
  /// Energy of one element, sound, by scalar code. [J]
  double energy(int element, const Points& x) const noexcept;
  /// Stress-free volume. [m3]
  double volume(int element) const noexcept { return volume_[static_cast<std::size_t>(element)]; }

  struct Strain {
    double around = 1.0, along = 1.0, through = 1.0;  // stretches at the middle of an element
    double J = 1.0;                                   // at the middle
  };
  Strain strain(int element, const Points& x) const noexcept;

  /// Cauchy stress [Pa] at a point of an element, in the frame of x.
  Mat3 stress(int element, const Vec3& local, const Points& x) const noexcept;
  const std::vector<WallLayer>& layers() const noexcept { return layers_; }
  int layer_at(int element, double zeta) const noexcept;
  int n_nodes() const noexcept { return n_nodes_; }

 private:
  struct Scalars {
    LawGeometry<double> geometry;
    double weight;
  };

  template <class Use>
  void each_point(std::size_t e, const Corners& corners, const Use& use) const noexcept;
  double mean_pressure(std::size_t e, const Corners& corners) const noexcept;  // [Pa]
  void add_row(const std::array<double, 2>& span);
  template <class S>
  void pack_rows(WallKernel<S>& kernel);
  template <class S>
  void pack_row(int row, WallKernel<S>& kernel);
  template <class S>
  void fill_lane(WallKernel<S>& kernel, typename WallKernel<S>::Pack& pack, int lane, int element, bool real);
  Scalars scalars(const Corners& rest, const Vec3& local, double share, const WallLaw& law) const;

  int n_nodes_ = 0;
  std::vector<WallLayer> layers_;
  std::vector<LawConstants> constants_;
  std::vector<KernelRow> rows_;
  WallKernel<Lanes<double>> double_;  // of the three one has packs
  WallKernel<Lanes<float>> single_;
  WideKernel wide_;
  std::vector<int> row_of_;
  std::vector<double> volume_;
  std::vector<std::array<int, 8>> nodes_of_;
  std::vector<Corners> rest_;
};

}  // namespace filum
