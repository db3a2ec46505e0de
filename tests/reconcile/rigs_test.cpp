// Each rig against a closed form, and every effect switched off leaves the baseline as it is, bit for bit.

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "reconcile/model.h"

namespace filum::reconcile {
namespace rigs_test {

Dataset dataset(Rig rig, const std::vector<std::string>& outputs) {
  Dataset d;
  d.rig = rig;
  for (const ParameterInfo& p : info(rig).baseline) d.nominal[p.name] = p.nominal, d.free.push_back(p.name);
  d.outputs = outputs;
  for (const ChannelInfo& c : info(rig).channels) d.channels.push_back({c.name, c.name, c.unit, 1.0, 0.0, c.input, 0.0});
  return d;
}

Trial trial(int n, double span) {
  Trial t;
  t.file = "a.csv";
  t.time = Eigen::VectorXd::LinSpaced(n, 0.0, span);
  return t;
}

Eigen::VectorXd run(const Dataset& d, const std::vector<double>& base) {
  const auto model = make_model(d);
  Setting s;
  s.base = base.data();
  Eigen::MatrixXd out;
  model->simulate(d.trials[0], s, out);
  return out.col(0);
}

TEST(Rigs, CantileverOfSmallDeflectionDropsByAnEighth) {
  Dataset d = dataset(Rig::suture_cantilever, {"tip_drop"});
  Trial t = trial(3, 2.0);
  t.specimen = {{"diameter", 25e-6}, {"density", 1140.0}};
  const double E = 2.5e9, L = 2e-3, G = 16 * 1140.0 * 9.81 * L * L * L / (E * 25e-6 * 25e-6);
  t.data["overhang"] = Eigen::VectorXd::Constant(3, L);
  t.data["tip_drop"] = Eigen::VectorXd::Ones(3);
  d.trials.push_back(t);
  EXPECT_NEAR(run(d, {E})[1] / (L * G / 8), 1.0, 2e-3);
}

TEST(Rigs, VesselFollowsLame) {
  Dataset d = dataset(Rig::vessel_inflation, {"outer_diameter"});
  Trial t = trial(3, 2.0);
  t.specimen = {{"outer_diameter", 2e-3}, {"wall_thickness", 0.3e-3}};
  t.data["pressure"] = Eigen::VectorXd::LinSpaced(3, 0.0, 1e4);
  t.data["outer_diameter"] = Eigen::VectorXd::Constant(3, 2e-3);
  d.trials.push_back(t);
  const double a = 0.7e-3, b = 1e-3, E = 3e5;
  // u(b) = 2 P a^2 b (1 - nu^2) / (E (b^2 - a^2)), nu = 1/2
  const double rise = 2.0 * 1e4 * a * a * b * 0.75 / (E * (b * b - a * a));
  EXPECT_NEAR(run(d, {E})[2], 2e-3 + 2.0 * rise, 1e-12);
}

/// The axial force that effects add, by work: F = dW/dlz - (C/lz) dW/dC of a tube with a closed end, W the energy a length of the wall stores at r'^2 = R^2/lz + 2 C.
TEST(Rigs, AxialForceOfAVesselIsTheWorkOfItsStretch) {
  Dataset d = dataset(Rig::vessel_inflation, {"outer_diameter", "axial_force"});
  Trial t = trial(3, 2.0);
  const double a = 0.7e-3, b = 1e-3, E = 3e5;
  t.specimen = {{"outer_diameter", 2 * b}, {"wall_thickness", b - a}};
  t.data["pressure"] = Eigen::VectorXd::Constant(3, 1e4);
  t.data["axial_stretch"] = Eigen::VectorXd::Constant(3, 1.1);
  t.data["outer_diameter"] = Eigen::VectorXd::Constant(3, 2 * b);
  t.data["axial_force"] = Eigen::VectorXd::Constant(3, 1e-2);
  d.trials.push_back(t);
  const auto model = make_model(d);
  const std::vector<double> base = {E};
  const double fibre[] = {4e4, 3.0, 0.7}, stiff[] = {0.6};
  for (const bool fibres : {true, false})
    for (int kind = 0; kind < 2; ++kind) {
      Setting s;
      s.base = base.data();
      s.mesh = 4;
      const Effect effect = fibres ? Effect::fibre_stiffening : Effect::strain_stiffening;
      s.p[static_cast<std::size_t>(index_of(effect))] = fibres ? fibre : stiff;
      s.kind[static_cast<std::size_t>(index_of(effect))] = kind;
      const auto energy = [&](double C, double lz) {
        double sum = 0.0;
        for (int i = 0; i < 2000; ++i) {
          const double R = a + (b - a) * (i + 0.5) / 2000, l2 = 1 / lz + 2 * C / (R * R), c2 = std::pow(std::cos(fibre[2]), 2);
          const double e = 0.5 * (c2 * (l2 - 1) + (1 - c2) * (lz * lz - 1)), i1 = l2 + lz * lz + 1 / (l2 * lz * lz) - 3;
          const double yeoh = E / 6 * stiff[0] * i1 * i1, exponential = E / 6 * (std::expm1(2 * stiff[0] * i1) / (2 * stiff[0]) - i1);
          const double W = fibres ? (kind == 1 ? 1 : 2) * fibre[0] / (2 * fibre[1]) * std::expm1(fibre[1] * e * e) : kind == 0 ? yeoh : exponential;
          sum += W * 2 * std::numbers::pi * R * (b - a) / 2000;
        }
        return sum;
      };
      const double C = 0.1 * b * b, lz = 1.1, h = 1e-5, g = 1e-5 * b * b;
      const double force = (energy(C, lz + h) - energy(C, lz - h)) / (2 * h) - C / lz * (energy(C + g, lz) - energy(C - g, lz)) / (2 * g);
      EXPECT_NEAR(model->wall_axial_force(d.trials[0], s, C, lz) / force, 1.0, 1e-5) << fibres << kind;
    }
}

TEST(Rigs, CapstanFollowsEuler) {
  Dataset d = dataset(Rig::suture_pull, {"pull_force"});
  Trial t = trial(3, 2.0);
  t.data["speed"] = Eigen::VectorXd::Constant(3, 1e-2);
  t.data["hold_force"] = Eigen::VectorXd::Constant(3, 0.05);
  t.data["wrap_angle"] = Eigen::VectorXd::Constant(3, std::numbers::pi);
  t.data["pull_force"] = Eigen::VectorXd::Constant(3, 0.1);
  d.trials.push_back(t);
  EXPECT_NEAR(run(d, {0.2})[0], 0.05 * std::exp(0.2 * std::numbers::pi), 1e-15);
}

TEST(Rigs, BlockIsLinearInCompressionAndShear) {
  for (const char* mode : {"compression", "shear"}) {
    Dataset d = dataset(Rig::tissue_block, {"force"});
    Trial t = trial(11, 10.0);
    t.shape = "cuboid";
    t.specimen = {{"length", 5e-3}, {"width", 4e-3}, {"height", 2e-3}};
    t.protocol["mode"] = mode;
    t.data["displacement"] = Eigen::VectorXd::LinSpaced(11, 0.0, -2e-4);
    t.data["force"] = t.data["displacement"] * 10.0;
    d.trials.push_back(t);
    const double modulus = std::string(mode) == "shear" ? 1000.0 / 2.98 : 1000.0;
    EXPECT_NEAR(run(d, {1000.0, 0.49})[10], modulus * 2e-5 * -0.1, 1e-15) << mode;
  }
}

TEST(Rigs, OgdenOfAlphaTwoIsNeoHookean) {
  Dataset d = dataset(Rig::tissue_block, {"force"});
  Trial t = trial(11, 10.0);
  t.shape = "cuboid";
  t.specimen = {{"length", 1e-2}, {"width", 1e-2}, {"height", 1e-2}};
  t.protocol["mode"] = "tension";
  t.data["displacement"] = Eigen::VectorXd::LinSpaced(11, 0.0, 2e-3);
  t.data["force"] = t.data["displacement"] * 10.0;
  d.trials.push_back(t);
  const auto model = make_model(d);
  const std::vector<double> base = {900.0, 0.49};
  const double alpha = 2.0;
  Setting s;
  s.base = base.data();
  s.p[static_cast<std::size_t>(index_of(Effect::tension_compression_asymmetry))] = &alpha;
  Eigen::MatrixXd out;
  model->simulate(d.trials[0], s, out);
  EXPECT_NEAR(out(10, 0), 300.0 * (1.2 - 1.0 / 1.44) * 1e-4, 1e-12);
}

/// Under a blade the secant grows by 2 r (I1 - 3) of the stretch 1 - depth/height, a finite one.
TEST(Rigs, ABladeStiffensByTheFirstInvariantOfItsStretch) {
  Dataset d = dataset(Rig::spatula_press, {"force"});
  Trial t = trial(3, 2.0);
  t.specimen = {{"length", 60e-3}, {"width", 50e-3}, {"height", 20e-3}, {"blade_length", 10e-3}, {"blade_width", 5e-3}};
  t.data["depth"] = Eigen::VectorXd::LinSpaced(3, 0.0, 0.25 * 20e-3);
  t.data["force"] = Eigen::VectorXd::Ones(3);
  d.trials.push_back(t);
  const auto model = make_model(d);
  const std::vector<double> base = {1000.0, 0.45};
  const double r = 2.0, i1 = 0.75 * 0.75 + 2.0 / 0.75 - 3.0;
  for (const auto& [kind, stiffer] : std::vector<std::pair<int, double>>{{0, 1.0 + 2.0 * r * i1}, {2, std::exp(2.0 * r * i1)}}) {
    Setting s;
    s.base = base.data();
    Eigen::MatrixXd plain, out;
    model->simulate(d.trials[0], s, plain);
    s.p[static_cast<std::size_t>(index_of(Effect::strain_stiffening))] = &r;
    s.kind[static_cast<std::size_t>(index_of(Effect::strain_stiffening))] = kind;
    model->simulate(d.trials[0], s, out);
    EXPECT_NEAR(out(2, 0) / plain(2, 0) / stiffer, 1.0, 1e-12);
  }
}

/// On the way back each state bears its own pressure with its own share of softening, however far apart the samples are.
TEST(Rigs, AVesselThatHasSoftenedBearsItsPressureInEverySample) {
  Dataset d = dataset(Rig::vessel_inflation, {"outer_diameter"});
  Trial t = trial(9, 8.0);
  t.specimen = {{"outer_diameter", 2e-3}, {"wall_thickness", 0.3e-3}};
  t.data["pressure"].resize(9);
  t.data["pressure"] << 0.0, 4e3, 8e3, 12e3, 9e3, 6e3, 3e3, 9e3, 13e3;
  t.data["outer_diameter"] = Eigen::VectorXd::Constant(9, 2e-3);
  d.trials.push_back(t);
  const auto model = make_model(d);
  const std::vector<double> base = {3e5};
  const double a = 0.7e-3, b = 1e-3, soft[] = {0.4, 2e-4}, firm = 2.0 * 1e5 * (1.0 / (a * a) - 1.0 / (b * b));
  Setting s;
  s.base = base.data();
  s.p[static_cast<std::size_t>(index_of(Effect::first_cycle_softening))] = soft;
  Eigen::MatrixXd out;
  model->simulate(d.trials[0], s, out);
  double top = 0.0;
  for (int n = 0; n < 9; ++n) {
    const double C = 0.5 * b * (out(n, 0) - 2.0 * b), W = 0.5 * std::pow(C / (a * b), 2);
    top = std::max(top, W);
    EXPECT_NEAR(firm * C * (1.0 - soft[0] * (1.0 - std::exp(-(top - W) / soft[1]))), t.data["pressure"][n], 1e-3) << n;
  }
}

TEST(Rigs, DrainageIsKnownByTheSizeThatVaries) {
  const auto unknown = [](const std::vector<std::array<double, 2>>& sizes, const char* mode) {  // forms of drainage that one size leaves open
    Dataset d = dataset(Rig::tissue_block, {"force"});
    for (const auto& [width, height] : sizes) {
      Trial t = trial(5, 1.0);
      t.shape = "cuboid";
      t.specimen = {{"length", width}, {"width", width}, {"height", height}};
      t.protocol = {{"mode", "compression"}};
      t.data["displacement"] = Eigen::VectorXd::LinSpaced(5, 0.0, -0.1 * height);
      t.data["force"] = Eigen::VectorXd::LinSpaced(5, 0.0, -1e-3);
      d.trials.push_back(t);
    }
    d.trials.back().protocol["mode"] = mode;
    std::set<int> kinds;
    const auto model = make_model(d);
    for (const Form& f : model->all_forms())
      if (f.effect == Effect::poroelastic_drainage && f.one_size) kinds.insert(f.kind);
    return kinds;
  };
  EXPECT_EQ(unknown({{5e-3, 5e-3}, {5e-3, 2e-3}}, "compression"), std::set<int>{0});  // through the sides: the width is the same; its slowest mode alone is left out
  EXPECT_EQ(unknown({{5e-3, 5e-3}, {9e-3, 5e-3}}, "compression"), std::set<int>{1});  // through the height
  EXPECT_EQ(unknown({{5e-3, 5e-3}, {9e-3, 2e-3}}, "compression"), std::set<int>{});
  EXPECT_EQ(unknown({{5e-3, 5e-3}, {5e-3, 2e-3}}, "shear"), std::set<int>{});  // shear keeps the volume: what relaxes there is the solid
}

}  // namespace rigs_test
}  // namespace filum::reconcile
