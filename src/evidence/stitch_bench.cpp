#include "evidence/stitch_bench.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "evidence/sewn_bench.h"
#include "evidence/vessel_bench.h"
#include "world/model.h"
#include "world/vessel_model.h"

namespace filum {
namespace {

constexpr const char* kTask = "vessel-stitch";

/// The scene's two stumps meshed anew; layered: of bench_artery()'s laws in the thickness of the scene's.
std::shared_ptr<const VesselModel> remeshed(const VesselModel& of, const StitchBench& b) {
  auto v = std::make_shared<VesselModel>(of);
  TubeShape shape = of.shape;
  shape.around = b.around;
  shape.along = b.along;
  if (b.layered) {
    v->layers = bench_artery();
    double total = 0.0;
    for (const WallLayer& l : v->layers) total += l.thickness;
    for (WallLayer& l : v->layers) l.thickness *= of.thickness / total;
    PunctureLayer easy = of.track.layers.front();
    easy.puncture *= 0.1;
    easy.cutting *= 0.1;
    easy.friction *= 0.5;
    v->track.layers.assign(v->layers.size(), easy);
    v->track.hold *= 0.4;
  }
  v->mesh = make_stumps(shape, of.clamp);
  return v;
}

std::shared_ptr<const Model> sized(const Model& of, const StitchBench& b) {
  auto m = std::make_shared<Model>(of);
  const double length = (of.thread_path.col(of.thread_path.cols() - 1) - of.thread_path.col(0)).norm();
  const Vec3 tip = of.thread_path.col(0), run = of.thread_path.col(of.thread_path.cols() - 1) - tip;
  m->thread_path.resize(3, b.suture);
  for (int i = 0; i < b.suture; ++i) m->thread_path.col(i) = tip + run * (static_cast<double>(i) / (b.suture - 1));
  m->resolution.longest = 1.1 * length / (b.suture - 1);
  m->step.longest_move = 0.5 * m->resolution.longest;
  m->description.capacity = 2 * b.suture;
  m->vessel = remeshed(*of.vessel, b);
  return m;
}

}  // namespace

std::vector<StitchBench> stitch_benches() {
  return {{"seed-vessel", 14, 2, false, 100, 8.0, 20.0, 0}, {"task-anastomosis", 24, 15, true, 150, 8.0, 20.0, 0}, {"task-anastomosis-8", 24, 15, true, 150, 8.0, 20.0, 8}};
}

void run_stitch_bench(const StitchBench& bench, BenchResult& r, const StepTimer& timer, const TaskOpener& open_task) {
  const DrivenTask driven = open_task(kTask);
  std::shared_ptr<const Model> model = sized(*driven.model, bench);
  std::optional<State> sewn;
  if (bench.sewn > 0) std::tie(model, sewn.emplace()) = sewn_stumps(model, bench.sewn);
  World world(model);
  if (sewn) world.restore(*sewn);
  r.dt_ms = 1e3 * world.description().dt;
  r.steps = static_cast<int>(std::lround((bench.to - bench.from) / world.description().dt));
  while (world.observation().time < bench.from) world.step(driven.inputs(world));
  Inputs inputs = driven.inputs(world);
  timer(
      r, [&] { world.step(inputs); },
      [&] {
        const Observation& o = world.observation();
        r.nodes = std::max(r.nodes, o.n_nodes + o.tissue.n);
        r.contacts = std::max(r.contacts, o.n_contacts + o.tissue.n_passes);
        inputs = driven.inputs(world);
      });
}

}  // namespace filum
