#pragma once
// What linear_fem's tetrahedra lack of soft tissue, element by element from the local strain, at small strains. With e the deviator of the strain less
// what has set, J = 2 e:e (I1 - 3 of an isochoric strain to second order):
//   stiffening   s = 2 G e (1 + 2 r J), r = c20/c10 (Yeoh, Rubber Chem. Technol. 66:754, 1993), or 2 G e exp(2 r J) (Demiray, J. Biomech. 5:309, 1972)
//   softening    s -> s (1 - d q((Wmax - W)/W0)), W = G e:e, Wmax the largest past one (Ogden & Roxburgh, Proc. R. Soc. A 455:2861, 1999)
//   asymmetry    s -> s + 2 G dev(h(e) - e), h of the principal values, so that uniaxial stress has P(e) - E e more, P by Ogden's one-term law (Proc. R. Soc.
//                A 326:565, 1972), with a quadratic term or with two moduli: h(x) - h(-x/2) = 3/2 P(x)/E has h(x) = sum_k 3/2 P((-1/2)^k x)/E, kept as a table
//   set          e = dev(eps) - f e_peak, e_peak the deviator of largest size so far
// Uniaxial: W = E e^2/2 and J = 3 e^2, so a block under this law is the rig's closed form. The volume change stays linear. What is added to the linear
// element is a load (initial stress): the matrix of a step stays. A step of a scene takes it of the displacements before, which is stable while the tangent
// stays below twice the linear one; beyond that `limit` holds the stress back (of the asymmetry its slope, at the mean of `limit` and 1). Internal variables: 7 numbers an element.
// Valid: strains below about 10 %, as linear_fem. Test: tissue_law_test.

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "physics/linear_fem.h"

namespace filum {

/// Share of the full softening at x = (Wmax - W)/W0: exponential, error function (Ogden & Roxburgh 1999), or x/(1 + x).
inline double softening_share(double x, int kind) noexcept { return kind == 0 ? -std::expm1(-x) : kind == 1 ? std::erf(x) : x / (1.0 + x); }

/// Uniaxial nominal stress over Young's modulus at strain e, less e: 0 Ogden 2/(3 a) (l^(a-1) - l^(-a/2-1)), l = 1 + e; 1 its quadratic term; 2 two moduli
/// whose ratio is Ogden's at a strain of 0.1.
double asymmetric_stress(double e, double alpha, int form) noexcept;

struct TissueLaw {
  double asymmetry = 0.0;         // alpha [-], below 0; 0: none
  int asymmetry_form = 0;
  double stiffening = 0.0;        // r [-]; 0: none
  bool exponential = false;
  double softening = 0.0;         // d [-]; 0: none
  double softening_energy = 1.0;  // W0 over Young's modulus [-]
  int softening_form = 0;
  double set = 0.0;               // f [-]; 0: none
  double set_strain = 0.0;        // [-]: f grows with the uniaxial strain of the peak, and is itself here; 0: f is the same for all
  double limit = INFINITY;        // of the secant of stiffening over 2 G
  bool linear() const noexcept { return stiffening == 0.0 && softening == 0.0 && set == 0.0 && asymmetry == 0.0; }
};

/// Internal variables of the elements.
struct TissueMemory {
  Eigen::Matrix<double, 6, Eigen::Dynamic> peak;  // deviator of strain of largest size so far: xx, yy, zz, xy, yz, zx
  Eigen::VectorXd top;                            // largest past W/G
};

class ElementLaw {
 public:
  ElementLaw(const TetMesh& mesh, const std::vector<FemMaterial>& regions, const TissueLaw& law);
  TissueMemory start() const;
  /// loads [N] += force of the linear element less that of the law, at displacements u, 3 x n. Allocates nothing.
  void push(const Eigen::Ref<const Points>& u, const TissueMemory& m, const std::vector<char>& removed, Points& loads) const noexcept;
  void remember(const Eigen::Ref<const Points>& u, TissueMemory& m) const noexcept;
  /// Mean of dev(eps):dev(eps) over the elements by their share of the energy of shape.
  double mean_square(const Eigen::Ref<const Points>& u) const noexcept;
  /// Stress [Pa] of the deviator e under the law with this memory, over 2 G e: the secant.
  double secant(double square, double top, double young_over_G) const noexcept;

 private:
  struct Element {
    Tetrahedron nodes;
    Eigen::Matrix<double, 3, 4> b;  // [1/m]
    double volume, G, ratio;        // [m3], [Pa], E/G
  };
  static Mat3 deviator(const Element& e, const Eigen::Ref<const Points>& u) noexcept;
  Mat3 shifted(const Mat3& strain, const Eigen::Matrix<double, 6, 1>& peak) const noexcept;

  double softened(double square, double top, double young_over_G) const noexcept;
  double principal(double x) const noexcept;                // h(x) - x
  Mat3 asymmetric(const Mat3& strain) const noexcept;       // dev(h(e) - e)

  TissueLaw law_;
  std::vector<Element> elements_;
  std::vector<double> table_;  // of h(x) - x at equal steps of x; empty: no asymmetry
};

}  // namespace filum
