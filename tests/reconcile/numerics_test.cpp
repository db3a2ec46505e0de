// What halving steps and cells changes, and differences at two steps, on models whose answer is known.

#include "reconcile/numerics.h"
#include "reconcile/structure.h"

#include <gtest/gtest.h>

#include "records.h"

namespace filum::reconcile {
namespace numerics_test {

const std::string kTrials = "  - { file: a.csv, protocol: { mode: compression, rate: \"1 mm/s\" } }\n";

struct Block {
  Folder folder;
  Dataset data;
  std::unique_ptr<RigModel> model;
  std::vector<Form> forms;

  Block() {
    folder.write("experiment.yaml", block_yaml(kTrials));
    folder.write("a.csv", block_csv([](double, double u, int) { return 5.0 * u; }, 1.0));
    data = load_dataset(folder.path(), FILUM_SOURCE_DIR);
    model = make_model(data);
    forms = model->all_forms();
  }
  const Form& form(Effect e, int kind) const {
    for (const Form& f : forms)
      if (f.effect == e && f.kind == kind) return f;
    throw std::runtime_error("no such form");
  }
  Fitter fitter() const { return Fitter(*model, {{{0.03e-3, 0.0, model->full_scale("force"), "stated"}}, 0.02, 0.006}); }
  Fit fixed(const Fitter& f, const std::vector<const Form*>& with, const std::vector<std::vector<double>>& values) const { return f.fit(with, {1000.0, 0.49}, values, {0, 1.0}); }
};

TEST(Numerics, ALinearBlockHasNoSolverError) {
  const Block b;
  const Fitter f = b.fitter();
  const Numerics n = solver_error(f, b.fixed(f, {}, {}));
  EXPECT_LT(n.time, 1e-12);
  EXPECT_EQ(n.mesh, 0.0);
}

TEST(Numerics, ExponentialsAreExactBetweenSamplesAndModesAreCounted) {
  const Block b;
  const Fitter f = b.fitter();
  EXPECT_LT(solver_error(f, b.fixed(f, {&b.form(Effect::viscoelastic_relaxation, 0)}, {{0.4, 2.0}})).time, 1e-9);
  const Numerics drained = solver_error(f, b.fixed(f, {&b.form(Effect::poroelastic_drainage, 0)}, {{1e-7, 0.4}}));
  EXPECT_GT(drained.mesh, 0.0);  // 24 modes are not 12
  EXPECT_LT(drained.mesh, 1e-3);
}

TEST(Numerics, StepsOfTheHistoryAreSeen) {
  // a relaxing spring behind play is not straight between two samples: finer ones change it, by little
  const Block b;
  const Fitter f = b.fitter();
  const double time = solver_error(f, b.fixed(f, {&b.form(Effect::hysteresis, 0), &b.form(Effect::viscoelastic_relaxation, 0)}, {{0.03e-3}, {0.4, 2.0}})).time;
  EXPECT_GT(time, 0.0);
  EXPECT_LT(time, 5e-3);
}

TEST(Numerics, DifferencesAgreeWhereTheModelIsSmooth) {
  const Block b;
  const Fitter f = b.fitter();
  for (const Sensitivity& s : check_sensitivities(f, b.fixed(f, {&b.form(Effect::viscoelastic_relaxation, 0)}, {{0.4, 2.0}}))) EXPECT_LT(s.disagreement, 1e-3) << s.parameter;
}

TEST(Numerics, TailOfChiSquaredIsTheTables) {
  EXPECT_NEAR(chi2_tail(5.991, 2), 0.05, 1e-4);    // Abramowitz & Stegun, table 26.8
  EXPECT_NEAR(chi2_tail(18.307, 10), 0.05, 1e-4);
  EXPECT_NEAR(chi2_tail(63.691, 40), 0.01, 1e-4);
  EXPECT_DOUBLE_EQ(chi2_tail(0.0, 4), 1.0);
}

}  // namespace numerics_test
}  // namespace filum::reconcile
