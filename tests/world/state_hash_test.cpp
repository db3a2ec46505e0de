#include "world/state_hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "world/world.h"

namespace filum {
namespace state_hash_test {

State sample() {
  State s = World(load_model(FILUM_SOURCE_DIR, "knot-square")).state();
  s.memory.self.push_back({1, 5, Vec3::Zero(), 0.0});
  s.memory.obstacle.push_back({1, 5, Vec3::Zero(), 0.0});
  s.memory.grasps.push_back({0, 1e-3, Vec3::Zero()});
  return s;
}

TEST(StateHash, NamesTheArrayThatChanged) {
  const State s = sample();
  const std::vector<std::pair<std::string, std::function<void(State&)>>> changes = {
      {"positions", [](State& c) { c.thread.x(2, 3) += 1e-18; }},
      {"velocities", [](State& c) { c.thread.v(0, 0) = 1e-30; }},
      {"theta", [](State& c) { c.thread.theta[2] += 1e-16; }},
      {"theta_dot", [](State& c) { c.thread.theta_dot[2] += 1e-16; }},
      {"directors", [](State& c) { c.thread.d1(1, 1) += 1e-3; }},
      {"ref_twist", [](State& c) { c.thread.ref_twist[1] += 1e-3; }},
      {"rest_length", [](State& c) { c.thread.rest_length[1] *= 1.001; }},
      {"rest_kappa", [](State& c) { c.thread.rest_kappa(1, 1) += 1e-3; }},
      {"rest_twist", [](State& c) { c.thread.rest_twist[1] += 1e-3; }},
      {"alive", [](State& c) { c.thread.alive[4] = 0; }},
      {"grasps", [](State& c) { c.memory.grasps[0].anchor_T.z() = 1e-9; }},
      {"grasps", [](State& c) { c.memory.grasps.clear(); }},
      {"self_bristles", [](State& c) { c.memory.self[0].xi.x() = 1e-9; }},
      {"obstacle_bristles", [](State& c) { c.memory.obstacle[0].j = 6; }},
      {"instruments", [](State& c) { c.instruments[1].angle_rate += 1e-9; }},
      {"instruments", [](State& c) { c.instruments[0].X_WD.q.x() += 1e-9; }},
      {"instruments", [](State& c) { c.force[2].y() += 1e-9; }},
      {"flags", [](State& c) { c.step += 1; }},
      {"flags", [](State& c) { c.armed[1] = 1; }},
      {"flags", [](State& c) { c.valid[2] = 1; }},
      {"flags", [](State& c) { c.cut_high = 1e-3; }},
      {"flags", [](State& c) { c.overloaded = 0.1; }},
  };
  const auto before = array_hashes(s);
  for (const auto& [name, change] : changes) {
    State changed = s;
    change(changed);
    EXPECT_NE(hash_state(changed), hash_state(s)) << name;
    const auto after = array_hashes(changed);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < after.size(); ++k) {
      ASSERT_EQ(after[k].first, before[k].first);
      EXPECT_EQ(after[k].second != before[k].second, after[k].first == name) << name << " changed, seen in " << after[k].first;
    }
  }
  for (const auto& array : before) {
    const bool covered = std::any_of(changes.begin(), changes.end(), [&](const auto& c) { return c.first == array.first; });
    EXPECT_TRUE(covered) << array.first;
  }
}

TEST(StateHash, CopiesAreEqualAndUnusedCapacityIsNotSeen) {
  const State s = sample();
  State copy = s;
  EXPECT_EQ(hash_state(copy), hash_state(s));
  copy.thread.x.col(copy.thread.n).setConstant(7.0);
  EXPECT_EQ(hash_state(copy), hash_state(s));
}

}  // namespace state_hash_test
}  // namespace filum
