#pragma once
// Hereditary integrals of linear viscoelasticity and drainage: F(t) = int g(t-s) dFe/ds ds with g a sum of exponentials,
// advanced exactly for an Fe that is linear between samples (Taylor, Pister & Goudreau 1970; Simo & Hughes, Computational
// Inelasticity, 1998, eq. 10.3.12). Test: hereditary_test (closed form of ramp and hold).

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "physics/tissue_law.h"

namespace filum::reconcile {

/// g(t) = rest + sum weight_i exp(-t/tau_i), rest + sum weight_i = 1.
struct Kernel {
  double rest = 1.0;
  std::vector<double> weight, tau;
};

Kernel prony(double g1, double tau1);
Kernel prony(double g1, double tau1, double g2, double tau2);
/// Fractional Zener (Cole-Cole) relaxation 1 - g1 + g1 E_a(-(t/tau)^a) by its spectrum (Gross 1947):
/// w(ln x) = sin(a pi) / (2 pi (cosh(a ln x) + cos(a pi))), 12 times `finer` intervals.
Kernel fractional(double g1, double tau1, double order, int finer = 1);
/// 1-D consolidation: weights 8/(pi (2n+1))^2, times size^2 / ((2n+1)^2 pi^2 D) for a slab of thickness `size` drained on both faces (Terzaghi);
/// twelve of them (or `modes`), what is left over in one more exponential of the same weight and first moment.
Kernel slab_drainage(double g1, double diffusivity, double size, int modes = 12);
/// Radial drainage of a cylinder of radius `size`: weights 4/a_n^2, times size^2/(a_n^2 D), a_n the zeros of J0.
Kernel radial_drainage(double g1, double diffusivity, double size, int modes = 12);

/// In place: elastic response -> response with memory.
void relax(const Kernel& k, const Eigen::VectorXd& time, Eigen::Ref<Eigen::VectorXd> f);
/// The inverse problem: from the response with memory (prescribed) to the elastic one.
void creep(const Kernel& k, const Eigen::VectorXd& time, Eigen::Ref<Eigen::VectorXd> f);

}  // namespace filum::reconcile
