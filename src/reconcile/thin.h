#pragma once
// Records too long to be fitted in the time that a dataset may take are thinned before anything looks at them: every channel and the clock through the same
// low-pass, then every m-th sample. The low-pass is a root-raised-cosine filter (Proakis & Salehi 2008, ch. 9.2) from 0.4 to 0.6 of the new rate under Kaiser's
// window (Oppenheim & Schafer 2010, ch. 7.5): its power at f and at the new rate less f add up to one, so that white noise stays white, as every stage
// presumes (a low-pass that ends below half the rate leaves a hole in it, and all else stands out). What is slower than 0.4 of the new rate passes, inputs
// and outputs stay in step, and a straight line stays itself up to the ends; a line between 0.5 and 0.6 is folded, by 3 dB or more weaker. Test: thin_test.

#include "reconcile/dataset.h"

namespace filum::reconcile {

/// Samples that a dataset keeps, all trials together: more than the generator's largest (45,000) has.
inline constexpr int kMostSamples = 60'000;

/// One channel, every m-th sample of what the low-pass leaves. NaN where the samples that are there bear less than half of the filter's weight.
Eigen::VectorXd thinned(const Eigen::VectorXd& v, int m);
/// All trials by the same m, where they have more than `most` samples in all; the notices say so. What a channel states of its noise is that of a sample
/// before: it is estimated anew.
void thin(Dataset& d, int most = kMostSamples);
/// Whether the records were thinned behind a low-pass that lets no mains hum through.
bool hum_is_gone(const Dataset& d);

}  // namespace filum::reconcile
