#include "training/stitch_knot.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

#include "tests/training/knot_shapes.h"
#include "training/needle_watch.h"
#include "training/rating_scale.h"
#include "training/task.h"

namespace filum {
namespace stitch_knot_test {

constexpr double kTau = 2.0 * std::numbers::pi;

/// A trefoil of radius `r` [m] opened where it is lowest, with straight ends of `tail` and `rest` [m]: T(2,3) as (2 + cos 3t)(cos 2t, sin 2t), sin 3t.
Observation trefoil(double r, double tail, double rest, bool knotted = true) {
  std::vector<Vec3> p;
  const int n = 120;
  const double gap = 0.15;
  const auto at = [&](double t) -> Vec3 {
    return r * Vec3((2.0 + std::cos(3.0 * t)) * std::cos(2.0 * t), (2.0 + std::cos(3.0 * t)) * std::sin(2.0 * t), knotted ? std::sin(3.0 * t) : 0.4 * t);
  };
  const Vec3 first = at(gap), last = at(kTau - gap);
  for (int k = 20; k > 0; --k) p.push_back(first + Vec3(1, 0.2, 0) * (tail * k / 20.0) / std::hypot(1.0, 0.2));
  for (int k = 0; k <= n; ++k) p.push_back(at(gap + (kTau - 2.0 * gap) * k / n));
  for (int k = 1; k <= 20; ++k) p.push_back(last + Vec3(1, -0.2, 0) * (rest * k / 20.0) / std::hypot(1.0, 0.2));
  Observation o;
  o.radius = 0.02 * r;
  o.n_nodes = static_cast<int>(p.size());
  o.positions = Points::Zero(3, o.n_nodes);
  double arc = 0.0;
  for (int k = 0; k < o.n_nodes; ++k) {
    o.positions.col(k) = p[static_cast<std::size_t>(k)];
    if (k > 0) arc += (p[static_cast<std::size_t>(k)] - p[static_cast<std::size_t>(k - 1)]).norm();
    o.arc.push_back(arc);
  }
  return o;
}

StitchKnot knot_in(const Observation& o) { return knot_in_piece(o, piece_at(o, 0.5 * o.arc.back())); }

/// The same with these edges cut.
Observation cut_at(Observation o, const std::vector<int>& edges) {
  for (const int edge : edges) o.parted[static_cast<std::size_t>(o.n_parted++)] = edge;
  return o;
}

/// One stitch of two ways at these places of the thread [m].
std::vector<Stitch> stitch_at(TissueObservation& tissue, double a, double b) {
  tissue.n_passes = 2;
  tissue.passes[0].arc = a;
  tissue.passes[1].arc = b;
  Stitch s;
  s.first = 0;
  s.second = 1;
  return {s};
}

TEST(StitchKnot, AThrowThatReachesOverBothBitesTiesTheStitch) {
  const Observation o = trefoil(1e-3, 5e-3, 8e-3);
  const StitchKnot k = knot_in(o);
  EXPECT_EQ(k.knot.knot_class, "overhand");
  EXPECT_EQ(k.knot.n_throws, 1);
  const double middle = 0.5 * (k.begin + k.end);
  TissueObservation tissue;
  auto stitches = stitch_at(tissue, middle - 0.3e-3, middle + 0.3e-3);
  name_knots(k, tissue, stitches);
  EXPECT_EQ(stitches[0].knot, "overhand");
  EXPECT_EQ(stitches[0].throws, 1);
  EXPECT_NEAR(stitches[0].tail, k.begin, 1e-9) << "nothing cut: the short end up to the knot";
  EXPECT_GT(stitches[0].tail, 4e-3);
}

/// The way round a stitch with holes at the corners of 0.6 by 0.2 mm is 1.6 mm; what its knot holds beyond that is slack.
TEST(StitchKnot, SlackIsTheLoopLessTheWayRoundItsBites) {
  const StitchKnot k = knot_in(trefoil(0.5e-3, 5e-3, 8e-3));
  const double middle = 0.5 * (k.begin + k.end);
  TissueObservation tissue;
  auto stitches = stitch_at(tissue, middle - 0.3e-3, middle + 0.3e-3);
  const double x[] = {-0.3e-3, 0.3e-3};
  for (std::size_t i = 0; i < 2; ++i) {
    tissue.passes[i].entry_W = Vec3(x[i], 0.0, i == 0 ? 0.2e-3 : 0.0);
    tissue.passes[i].exit_W = Vec3(x[i], 0.0, i == 0 ? 0.0 : 0.2e-3);
  }
  tissue.n_passes = 3;  // a bite that the loop does not hold counts for nothing
  tissue.passes[2].arc = -1.0;
  tissue.passes[2].entry_W = Vec3(1, 1, 1);
  EXPECT_NEAR(way_round(k, tissue), 1.6e-3, 1e-15);
  name_knots(k, tissue, stitches);
  EXPECT_NEAR(stitches[0].slack, k.loop() - 1.6e-3, 1e-15);
  EXPECT_EQ(way_round(StitchKnot{}, tissue), 0.0) << "no knot";
}

TEST(StitchKnot, AKnotBesideTheStitchTiesNothing) {
  const Observation o = trefoil(1e-3, 5e-3, 8e-3);
  TissueObservation tissue;
  auto stitches = stitch_at(tissue, 1e-3, 2e-3);  // in the short end, before the knot
  name_knots(knot_in(o), tissue, stitches);
  EXPECT_TRUE(stitches[0].knot.empty());
  EXPECT_EQ(stitches[0].throws, 0);
  EXPECT_TRUE(std::isnan(stitches[0].tail));
}

TEST(StitchKnot, AThreadThatIsOnlyDrawnThroughIsNotTied) {
  const StitchKnot k = knot_in(trefoil(1e-3, 5e-3, 8e-3, false));
  EXPECT_EQ(k.knot.knot_class, "unknot");
  EXPECT_FALSE(k.holds(5e-3));
}

TEST(StitchKnot, TheLoopShrinksWithTheKnotAndTheTailIsWhatTheCutLeft) {
  const StitchKnot wide = knot_in(trefoil(1e-3, 5e-3, 8e-3)), narrow = knot_in(trefoil(0.5e-3, 5e-3, 8e-3));
  EXPECT_NEAR(narrow.loop(), 0.5 * wide.loop(), 0.1 * wide.loop());
  const Observation cut = cut_at(trefoil(1e-3, 5e-3, 8e-3), {9});  // half of the short end is gone
  const StitchKnot k = knot_in(cut);
  EXPECT_NEAR(k.tail, k.begin - cut.arc[10], 1e-9) << "the long end is still whole";
  EXPECT_LT(k.tail, 0.75 * knot_in(trefoil(1e-3, 5e-3, 8e-3)).tail);
}

TEST(StitchKnot, TyingIsDoneWhenTheKnotHoldsTheBitesAndIsDrawnDown) {
  NeedleGoal tie, cut;
  tie.kind = NeedleGoal::Kind::tie;
  tie.passes = 2;
  tie.throws = 1;
  tie.loop = 0.75 * knot_in(trefoil(1e-3, 5e-3, 8e-3)).loop();
  tie.seconds = 0.3;
  cut.kind = NeedleGoal::Kind::cut;
  cut.passes = 2;
  NeedleTask task;
  task.goals = {tie, cut};
  task.has_tissue = true;
  NeedleWatch watch(task, {});
  std::vector<TaskEvent> events;
  const auto look = [&](Observation o, double from, bool beside = false) {
    const StitchKnot k = knot_in(o);
    o.tissue.n_passes = 2;
    for (std::size_t i = 0; i < 2; ++i) {
      o.tissue.passes[i].out = true;
      o.tissue.passes[i].state = PassObservation::State::thread;
      o.tissue.passes[i].arc = beside ? 1e-3 : 0.5 * (k.begin + k.end) + (i == 0 ? -1e-4 : 1e-4);
    }
    for (int step = 0; step < 8; ++step) {
      o.time = from + 0.1 * step;
      watch.observe(o, 0.1, true, events);
    }
  };
  look(trefoil(1e-3, 5e-3, 8e-3), 0.0);
  EXPECT_EQ(watch.step(), 0) << "too wide";
  look(trefoil(0.5e-3, 5e-3, 8e-3, false), 1.0);
  EXPECT_EQ(watch.step(), 0) << "no knot";
  look(trefoil(0.5e-3, 5e-3, 8e-3), 2.0, true);
  EXPECT_EQ(watch.step(), 0) << "beside the stitch";
  task.goals[0].knots = {"square", "granny"};
  NeedleWatch particular(task, {});
  std::swap(watch, particular);
  look(trefoil(0.5e-3, 5e-3, 8e-3), 3.0);
  EXPECT_EQ(watch.step(), 0) << "another knot was asked for";
  std::swap(watch, particular);
  look(trefoil(0.5e-3, 5e-3, 8e-3), 3.0);
  EXPECT_EQ(watch.step(), 1);
  Observation o = trefoil(0.5e-3, 5e-3, 8e-3);
  const double between = 0.5 * o.arc.back();
  o.tissue.n_passes = 2;
  o.tissue.passes[0].arc = between - 1e-4;
  o.tissue.passes[1].arc = between + 1e-4;
  const auto snip = [&](const std::vector<int>& edges, int newest) {
    Observation now = cut_at(o, edges);
    now.n_events = 1;
    now.events[0] = {"cut", 2, 0.5 * (o.arc[static_cast<std::size_t>(newest)] + o.arc[static_cast<std::size_t>(newest) + 1]), "m"};
    watch.observe(now, 0.1, true, events);
  };
  snip({3}, 3);
  EXPECT_EQ(watch.step(), 1) << "one end is still whole";
  snip({3, 8}, 8);
  EXPECT_EQ(watch.step(), 1) << "it was cut twice on the same side";
  snip({3, 8, 150}, 150);
  EXPECT_TRUE(watch.done());
}

/// The look at the first one's knot says nothing of the second's.
TEST(StitchKnot, ASecondTieIsLookedAtAnew) {
  NeedleGoal one;
  one.kind = NeedleGoal::Kind::tie;
  one.passes = 2;
  one.throws = 1;
  one.loop = 1.0;
  one.seconds = 0.3;
  NeedleGoal two = one;
  two.seconds = 0.2;
  two.knots = {"square"};
  NeedleTask task;
  task.goals = {one, two};
  task.has_tissue = true;
  NeedleWatch watch(task, {});
  std::vector<TaskEvent> events;
  Observation o = trefoil(1e-3, 5e-3, 8e-3);
  const double middle = 0.5 * (knot_in(o).begin + knot_in(o).end);
  o.tissue.n_passes = 2;
  for (std::size_t i = 0; i < 2; ++i) {
    o.tissue.passes[i].out = true;
    o.tissue.passes[i].state = PassObservation::State::thread;
    o.tissue.passes[i].arc = middle + (i == 0 ? -1e-4 : 1e-4);
  }
  for (int step = 0; step < 500; ++step) {
    o.time = 2e-3 * step;
    watch.observe(o, 2e-3, true, events);
  }
  EXPECT_EQ(watch.step(), 1) << "one throw is no square knot";
}

/// Both one after the other in one thread.
Observation in_a_row(const Observation& a, const Observation& b) {
  Observation o = a;
  o.n_nodes = a.n_nodes + b.n_nodes;
  o.positions = Points::Zero(3, o.n_nodes);
  o.positions.leftCols(a.n_nodes) = a.positions;
  o.positions.rightCols(b.n_nodes) = b.positions.colwise() + Vec3(0, 0.1, 0);
  const double join = a.arc.back() + 1e-3;
  for (const double arc : b.arc) o.arc.push_back(join + arc);
  return o;
}

TEST(StitchKnot, EveryPieceOfTheThreadHasItsOwnKnot) {
  const Observation knotted = trefoil(1e-3, 5e-3, 8e-3), plain = trefoil(1e-3, 5e-3, 8e-3, false);
  Observation o = in_a_row(in_a_row(knotted, plain), knotted);
  const int n = knotted.n_nodes;
  o = cut_at(o, {n - 1, 2 * n - 1});
  o.tissue.n_passes = 6;
  for (std::size_t i = 0; i < 6; ++i)
    o.tissue.passes[i].arc = o.arc[(i / 2) * static_cast<std::size_t>(n)] + 0.5 * knotted.arc.back() + (i % 2 == 0 ? -1e-4 : 1e-4);
  const std::vector<StitchKnot> knots = knots_in_tissue(o);
  ASSERT_EQ(knots.size(), 3u);
  std::vector<Stitch> stitches(3);
  for (int i = 0; i < 3; ++i) {
    stitches[static_cast<std::size_t>(i)].first = 2 * i;
    stitches[static_cast<std::size_t>(i)].second = 2 * i + 1;
  }
  for (const StitchKnot& k : knots) name_knots(k, o.tissue, stitches);
  EXPECT_EQ(stitches[0].knot, "overhand");
  EXPECT_EQ(stitches[1].knot, "");
  EXPECT_EQ(stitches[2].knot, "overhand");
  EXPECT_NEAR(stitches[0].tail, length_between(o, 0, n - 1) - (knots[0].end - knots[0].begin) - knots[0].begin, 1e-3) << "of the first piece the long end was cut";
  o.n_parted = 0;
  EXPECT_EQ(knots_in_tissue(o).size(), 2u) << "one thread, tied twice";
}

TEST(StitchKnot, OfTwoCutEndsTheLongerAndTheShorterAreTold) {
  const Observation o = cut_at(trefoil(1e-3, 5e-3, 8e-3), {150});
  const StitchKnot whole = knot_in_piece(o, {0, 150}), k = knot_in_piece(o, {0, 150}, 5, true);
  EXPECT_EQ(whole.tail, whole.short_tail) << "only the one behind was cut";
  EXPECT_NEAR(k.tail, std::max(whole.begin, whole.tail), 1e-9);
  EXPECT_NEAR(k.short_tail, std::min(whole.begin, whole.tail), 1e-9);
}

/// Two sutures, alike but for their turn: the long end of each is cut, the short end is as it was laid until it is cut, too.
TEST(StitchKnot, TheTailsOfALaterSutureAreThoseOfTheFirst) {
  const Observation one = trefoil(1e-3, 9e-3, 8e-3);
  const int n = one.n_nodes;
  Observation o = cut_at(in_a_row(one, one), {n - 9, n - 1, 2 * n - 9});
  o.tissue.n_passes = 2;
  for (std::size_t i = 0; i < 2; ++i) o.tissue.passes[i].arc = o.arc[i * static_cast<std::size_t>(n)] + 0.5 * one.arc.back();
  const auto tails = [&](const std::vector<char>& whole_front) {
    const std::vector<StitchKnot> k = knots_in_tissue(o, 5, whole_front);
    return std::array<double, 4>{k[0].tail, k[0].short_tail, k[1].tail, k[1].short_tail};
  };
  const auto laid = tails({1, 1}), second_cut = tails({1, 0});
  EXPECT_NEAR(laid[0], laid[2], 1e-9);
  EXPECT_NEAR(laid[1], laid[3], 1e-9);
  EXPECT_NEAR(second_cut[1], laid[1], 1e-9);
  EXPECT_GT(second_cut[2], laid[2] + 1e-3) << "now the short end counts";
}

constexpr int kRunning = 8;  // stitches of the running thread

/// A running thread: `first` ties its first stitch, then it goes through seven more and comes back to be tied to its short end with `last`.
Observation running_thread(const std::vector<int>& first, const std::vector<int>& last) {
  std::vector<int> all = first;
  all.insert(all.end(), last.begin(), last.end());
  const Points knots = shapes::throws_round_post(all);
  const auto nodes_of = [](const std::vector<int>& throws) {
    int n = 0;
    for (const int half_twists : throws) n += 6 * std::abs(half_twists) + 1;
    return n;
  };
  const int loop = 10 + nodes_of(all), leaves = loop + 17 + nodes_of(first);  // where the first stitch lies, and where the thread runs on
  std::vector<Vec3> p;
  for (int k = 0; k < leaves; ++k) p.push_back(knots.col(k));
  const Vec3 from = p.back(), out = Vec3(from.x() > 0.0 ? 1.0 : -1.0, 0.0, 0.0);
  const int runs = static_cast<int>(p.size());
  for (int k = 0; k <= 60; ++k) {  // out to one side and back beside it
    const double a = std::numbers::pi * k / 60.0;
    p.push_back(from + 4e-3 * std::sin(a) * out + Vec3(0.0, 0.5e-3 * std::sin(2.0 * a), 0.0));
  }
  for (int k = leaves; k < knots.cols(); ++k) p.push_back(knots.col(k));
  Observation o;
  o.radius = 12e-6;
  o.positions = shapes::from_list(p);
  o.n_nodes = static_cast<int>(p.size());
  o.arc.assign(1, 0.0);
  for (std::size_t k = 1; k < p.size(); ++k) o.arc.push_back(o.arc.back() + (p[k] - p[k - 1]).norm());
  o.tissue.n_passes = 2 * kRunning;
  for (int i = 0; i < o.tissue.n_passes; ++i) {
    PassObservation& pass = o.tissue.passes[static_cast<std::size_t>(i)];
    const auto node = static_cast<std::size_t>(i < 2 ? loop + 5 + 6 * i : runs + 4 * i);
    pass.arc = o.arc[node];
    pass.entry_W = pass.exit_W = p[node];
    pass.out = true;
    pass.state = PassObservation::State::thread;
  }
  return o;
}

/// Its stitches with their knots.
NeedleReport running_report(const std::vector<int>& first, const std::vector<int>& last) {
  const Observation o = running_thread(first, last);
  NeedleReport r;
  r.has_tissue = true;
  for (int k = 0; k < kRunning; ++k) {
    Stitch& s = r.stitches.emplace_back();
    s.first = 2 * k;
    s.second = 2 * k + 1;
    s.joins = true;
  }
  for (const StitchKnot& k : knots_in_tissue(o)) name_knots(k, o.tissue, r.stitches);
  return r;
}

std::string classes_of(const NeedleReport& r) {
  std::string text;
  for (const Stitch& s : r.stitches) text += (text.empty() ? "" : " ") + (s.knot.empty() ? std::string("-") : s.knot) + std::to_string(s.throws);
  return text;
}

TEST(StitchKnot, ARunningThreadHasTheKnotOfItsFirstStitchAndThatOfItsEnd) {
  const auto like = [](const std::string& first, const std::string& others) {
    std::string text = first;
    for (int k = 1; k < kRunning; ++k) text += " " + others;
    return text;
  };
  const NeedleReport good = running_report({3, -3}, {3, -3, 3});
  EXPECT_EQ(classes_of(good), like("square2", "triple3"));
  EXPECT_EQ(scale_value("knots-secure", good), 1.0);
  EXPECT_EQ(classes_of(running_report({3, -3, 3}, {-3, 3, -3})), like("triple3", "triple3"));
  EXPECT_EQ(classes_of(running_report({-5, 3}, {-3, 3, -3})), like("surgeons2", "triple3"));
  EXPECT_EQ(classes_of(running_report({3, -3}, {})), like("square2", "-0")) << "its end is not tied";
  EXPECT_EQ(classes_of(running_report({}, {3, -3, 3})), like("triple3", "triple3")) << "one knot that holds them all";
  const NeedleReport granny = running_report({3, -3}, {3, 3});
  EXPECT_EQ(classes_of(granny), like("square2", "granny2"));
  EXPECT_EQ(scale_value("knots-secure", granny), 1.0 / kRunning) << "only the first one holds";
}

TEST(StitchKnot, TheStitchesOfARunningThreadHaveItsEndsAndAPartOfItsSlackEach) {
  const Observation o = running_thread({3, -3}, {3, -3, 3});
  const NeedleReport r = running_report({3, -3}, {3, -3, 3});
  const StitchKnot whole = knot_in_piece(o, {0, o.n_nodes - 1});
  for (const Stitch& s : r.stitches) EXPECT_EQ(s.tail, whole.tail);
  EXPECT_NEAR(r.stitches[3].slack, (whole.loop() - way_round(whole, o.tissue)) / kRunning, 1e-12);
  EXPECT_LT(r.stitches[0].slack, whole.loop()) << "of its own loop";
  EXPECT_GT(r.stitches[0].slack, 0.0);
}

/// As its task asks for it: three throws at the end, whatever the first stitch was tied with.
TEST(StitchKnot, AContinuousSutureIsDoneAsItsHintSays) {
  const auto task = load_task(std::string(FILUM_SOURCE_DIR) + "/curricula/continuous-suture/task.yaml").needle;
  NeedleTask end;
  end.has_tissue = true;
  for (const NeedleGoal& g : task->goals)
    if (g.kind == NeedleGoal::Kind::tie && g.passes == 2 * kRunning) end.goals = {g};
  ASSERT_EQ(end.goals.size(), 1u);
  const auto done = [&](const std::vector<int>& first, const std::vector<int>& last) {
    NeedleWatch watch(end, {});
    std::vector<TaskEvent> events;
    Observation o = running_thread(first, last);
    for (int step = 0; step < 8; ++step) {
      o.time = 0.1 * step;
      watch.observe(o, 0.1, true, events);
    }
    return watch.done();
  };
  EXPECT_TRUE(done({3, -3}, {3, -3, 3}));
  EXPECT_TRUE(done({3, -3, 3}, {-3, 3, -3}));
  EXPECT_TRUE(done({5, -3}, {3, -3, 3}));
  EXPECT_FALSE(done({3, -3}, {})) << "only the first knot";
  EXPECT_FALSE(done({3, -3, 3}, {-3})) << "four throws in the thread, but the last knot has one";
  EXPECT_FALSE(done({3, -3}, {3, -3})) << "two throws";
  EXPECT_FALSE(done({3, -3}, {3, 3, 3})) << "a granny with one more";
}

}  // namespace stitch_knot_test
}  // namespace filum
