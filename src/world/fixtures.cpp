#include "world/fixtures.h"

#include <algorithm>

namespace filum {

namespace {

RoundBar bar_of(const PostShape& bar) {
  return {bar.p_W - bar.half_length * bar.axis_W, bar.p_W + bar.half_length * bar.axis_W, bar.radius, bar.radius};
}

}  // namespace

Surroundings surroundings(const Model& model) {
  Surroundings s;
  if (model.description.has_post) s.bars = {bar_of(model.description.post), bar_of(model.description.base)};
  for (const PostShape& bar : model.description.frame) s.bars.push_back(bar_of(bar));
  s.sheet = model.description.floor_height;
  return s;
}

void add_fixtures(const Model& model, RodObstacles& obstacles) {
  const int body = static_cast<int>(obstacles.bodies.size());
  const Surroundings fixed = surroundings(model);
  obstacles.bodies.emplace_back();
  const auto add = [&](const RoundBar& bar) {
    Obstacle o;
    o.body = body;
    o.a_B = bar.a;
    o.b_B = bar.b;
    o.r_a = bar.r_a;
    o.r_b = bar.r_b;
    o.friction = model.post_friction;
    obstacles.obstacles.push_back(o);
  };
  for (const RoundBar& bar : fixed.bars) add(bar);
  for (const PostShape& lip : model.lips) add(bar_of(lip));
  for (const PostShape& bar : model.description.notch) add(bar_of(bar));
  Obstacle sheet;
  sheet.kind = Obstacle::Kind::plane;
  sheet.body = body;
  sheet.a_B = Vec3(0, 0, fixed.sheet);
  sheet.b_B = sheet.a_B + Vec3::UnitZ();
  sheet.friction = model.post_friction;
  sheet.bears_end = model.needle == nullptr;  // else the needle around it meets the sheet
  obstacles.obstacles.push_back(sheet);
}

double arc_on_post(const Model& model, const RodState& thread) noexcept {
  const PostShape &post = model.description.post, &base = model.description.base;
  const Vec3 slit = 0.5 * (post.p_W + base.p_W);
  double nearest = 1.0, found = thread.arc_start, arc = thread.arc_start;
  for (int j = 0; j + 1 < thread.n; arc += thread.rest_length[j++]) {
    const Vec3 a = thread.x.col(j), e = thread.x.col(j + 1) - thread.x.col(j);
    const Vec3 across_a = (a - slit) - (a - slit).dot(post.axis_W) * post.axis_W;
    const Vec3 across_e = e - e.dot(post.axis_W) * post.axis_W;
    const double f = std::clamp(-across_a.dot(across_e) / std::max(across_e.squaredNorm(), 1e-18), 0.0, 1.0);
    const double distance = (across_a + f * across_e).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    found = arc + f * thread.rest_length[j];
  }
  return found;
}

}  // namespace filum
