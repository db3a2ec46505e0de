#pragma once
// Discrete elastic rod: stretch, bend and twist of a thin elastic filament with material frames and rest curvature.
//
// Energy (Bergou, Wardetzky, Robinson, Audoly, Grinspun, "Discrete Elastic Rods", ACM TOG 27(3):63, 2008, and Bergou,
// Audoly, Vouga, Wardetzky, Grinspun, "Discrete Viscous Threads", ACM TOG 29(4):116, 2010, sec. 4), edges e^j = x_{j+1}-x_j:
//   U = sum_j  EA/2 (|e^j|/L^j - 1)^2 L^j
//     + sum_i  EI/(4 l_i) sum_{j=i-1,i} |kappa_i^j - kappa0_i^j|^2 ,   kappa_i^j = (kb.m2^j, -kb.m1^j)   (2008, eq. 2)
//     + sum_i  GJ/(2 l_i) (theta^i - theta^{i-1} + m_i - tau0_i)^2
// with kb = 2 t^{i-1} x t^i / (1 + t^{i-1}.t^i) the curvature binormal, l_i = (L^{i-1}+L^i)/2 the node's length, m_i the
// reference twist. The mean of the squares over both edges, not the square of the mean (2010): a straight rod's bending stiffness
// then does not depend on its twist. Reference directors are carried in time by parallel transport from the last converged step.
// Valid: slender rod (radius << radius of curvature, Kirchhoff), linear material. Neglects: shear.
// Tests: elastic_rod_test (gradient and Hessian by differences, rigid motion, order 2 in bending and twist), `filum validate`.

#include <limits>
#include <vector>

#include "base/block_cholesky.h"
#include "base/pose.h"

namespace filum {

/// Constants of one thread; all SI. Loaded from models/suture/.
struct RodMaterial {
  double radius = 12.5e-6;       // [m]
  double density = 1140.0;       // [kg/m3]
  double EA = 1.23;              // [N], axial stiffness
  double EI = 4.79e-11;          // [N m2], bending stiffness, the same about both axes
  double GJ = 3.5e-11;           // [N m2], twisting stiffness
  double friction = 0.2;         // [-], thread on thread
  double strength = 0.19;        // [N], tension at which it parts
  double internal_friction = 0.0;  // [s], Kelvin-Voigt time of bending and twisting: moment = EI (kappa + time dkappa/dt)
  double most_elastic_curvature = std::numeric_limits<double>::infinity();  // [1/m], what is bent further stays bent: see take_set
  double drag = 2.6e-5;          // [N s/m2], air drag per length and speed, slender body (Cox 1970, J. Fluid Mech. 44:791)

  /// Solid round wire of a linear isotropic material: E [Pa], Poisson's ratio [-].
  static RodMaterial round_wire(double radius, double youngs_modulus, double poissons_ratio, double density);
  double mass_per_length() const;  // [kg/m]
};

/// All that changes with time in a rod of n nodes; arrays are sized to a capacity and used up to n.
struct RodState {
  int n = 0;                          // nodes in use; edges: n - 1
  Points x;                           // [m], 3 x capacity, frame W
  Points v;                           // [m/s], 3 x capacity
  Eigen::VectorXd theta;              // [rad], edge j: angle of the material frame against the reference frame
  Eigen::VectorXd theta_dot;          // [rad/s]
  Points d1;                          // unit, 3 x capacity, reference director of edge j, normal to its tangent
  Eigen::VectorXd ref_twist;          // [rad], node i (1 ... n-2): twist of the reference frame, continuous in time
  Eigen::VectorXd rest_length;        // [m], edge j, unstretched
  Eigen::Matrix4Xd rest_kappa;        // [-], node i, integrated rest curvature (curvature x l_i), as RodGeometry::kappa
  Eigen::VectorXd rest_twist;         // [rad], node i
  Eigen::VectorXi alive;              // edge j: 1 whole, 0 parted (carries no force)
  double arc_start = 0.0;             // [m], material coordinate of node 0

  /// Straight-sided rod through `nodes` (3 x n, n >= 2), unstretched and untwisted, straight at rest if `naturally_straight`,
  /// else with the given shape as its rest shape.
  static RodState from_nodes(const Points& nodes, int capacity, bool naturally_straight = true);
};

/// One number, or three, for each edge or node, those of four neighbours side by side: they are computed together.
using RodRow = Eigen::VectorXd;
using RodRows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;

/// Geometry of one trial configuration, the inputs of energy, force and stiffness. Sized once.
struct RodGeometry {
  explicit RodGeometry(int capacity);
  RodRow length;                      // [m], edge
  RodRows t, d1, m1, m2;              // unit, edge: tangent, reference director, material directors
  RodRows kb;                         // [-], node: curvature binormal
  Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::RowMajor> kappa;  // [-], node: curvature about m1, m2 of the edge before, then of the edge behind
  RodRow chi;                         // 1 + t.t at each inner node
  RodRow ref_twist, twist;            // [rad], inner node
  RodRows x, reference_t, reference_d1;               // [m], node; unit, edge
  RodRow theta, reference_twist, reference_cos, reference_sin;  // [rad], edge; [rad], node
};

/// Fills `g` for positions x [m] and angles theta [rad], with reference frames transported from those of `reference`
/// (whose tangents are those of reference.x).
void update_geometry(const RodState& reference, const Points& x, const Eigen::VectorXd& theta, RodGeometry& g) noexcept;
/// Its two halves, for many trial shapes of `n` nodes from one reference; and the present shape made the reference. The derivatives below are those
/// of the energy at the reference itself: how directors are carried to a shape far from it adds a turn of second order that they leave out.
void set_reference(const RodState& reference, RodGeometry& g) noexcept;
void take_reference(int n, RodGeometry& g) noexcept;
void follow_reference(int n, const Points& x, const Eigen::VectorXd& theta, RodGeometry& g) noexcept;

/// U [J] of the configuration in `g`.
double elastic_energy(const RodMaterial& m, const RodState& s, const RodGeometry& g) noexcept;

/// Adds dU/dq to `gradient` (4 x n: rows x, y, z in N, and N m for the twist angle of edge j in column j).
void add_elastic_gradient(const RodMaterial& m, const RodState& s, const RodGeometry& g, Eigen::Matrix4Xd& gradient) noexcept;

/// Slots of the chain blocks (i, i+1) and (i, i+2) in the matrix.
struct ChainSlots {
  std::vector<BlockCholesky::Slot> next, second;
};

/// How much of the second derivative is used: `exact` (may be indefinite under compression) or `gauss_newton` (always
/// positive semidefinite: the fallback when the exact one cannot be factorised).
enum class Stiffness { exact, gauss_newton };

/// Adds d2U/dq2 to `matrix`.
void add_elastic_hessian(const RodMaterial& m, const RodState& s, const RodGeometry& g, Stiffness kind,
                         const ChainSlots& slots, BlockCholesky& matrix) noexcept;

/// Accepts a converged configuration: positions, angles and reference frames move into `s` (velocities are the caller's).
void accept_geometry(const RodGeometry& g, const Points& x, const Eigen::VectorXd& theta, RodState& s) noexcept;

/// Plastic set. A bending moment beyond M_p = EI most_elastic_curvature cannot be carried: the rest curvature follows until the elastic
/// part is down to the limit (return mapping of a perfectly plastic hinge; Simo, Hughes, Computational Inelasticity, 1998, ch. 1.2).
/// A solid round section first yields at curvature eps_y/r and carries M_p = 16/(3 pi) times that moment when yielded throughout (Horne,
/// Plastic Theory of Structures, 1979, ch. 1). Neglects: the gradual rounding between the two, hardening, yield in twist and tension.
void take_set(const RodMaterial& m, RodState& s, const RodGeometry& g) noexcept;

/// 16/(3 pi) yield_strain / radius [1/m].
double most_elastic_curvature(double yield_strain, double radius) noexcept;

/// Axial force [N] in edge j, positive in tension.
double edge_tension(const RodMaterial& m, const RodState& s, int j) noexcept;

/// Angle [rad] from d0 (normal to t0), carried to t1 by parallel transport, to d1 (normal to t1); of all angles that differ by
/// whole turns the one nearest to `previous`.
double reference_twist(const Vec3& d0, const Vec3& t0, const Vec3& d1, const Vec3& t1, double previous) noexcept;

/// Parallel transport of d (normal to unit vector a) to unit vector b along the shortest rotation; b != -a.
Vec3 parallel_transport(const Vec3& d, const Vec3& a, const Vec3& b) noexcept;

}  // namespace filum
