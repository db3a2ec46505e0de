#pragma once
// Stage lint: from the inputs alone, before any residual is looked at, which effects of the rig these trials could not show; and what the records say of
// the hardware that made them (hardware.h).

#include "reconcile/hardware.h"
#include "reconcile/score_tests.h"

namespace filum::reconcile {

struct NotTestable {
  Effect effect;
  std::string why, needs;
  bool hidden = false;  // by the inputs altogether: it cannot be named. Else a condition is lacking, and it stays as a rival
};

struct LintSummary {
  std::vector<NotTestable> not_testable;
  std::vector<HardwareCheck> hardware;
};

LintSummary lint(const RigModel& model, const std::vector<Form>& forms, const LintOptions& options);
/// Forms without those of effects that the inputs hide altogether; what lacks a condition stays as a rival.
std::vector<Form> nameable(std::vector<Form> forms, const LintSummary& lint);

}  // namespace filum::reconcile
