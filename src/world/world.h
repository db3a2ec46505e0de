#pragma once
// The simulated scene: constant Model, plain copyable State, scratch Workspace, one step. See ARCHITECTURE.md for the order.

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "world/inputs.h"
#include "world/observation.h"

namespace filum {

struct Model;  // world/model.h: constant after load
struct State;  // world/state.h: complete, copyable, no pointers

/// Runs one scene at a fixed step. Not thread-safe: one thread owns a World. Deterministic: same build, same Model, same
/// Inputs give bit-equal States. step() allocates nothing, throws nothing and reads no clock.
class World {
 public:
  explicit World(std::shared_ptr<const Model> model);
  ~World();
  World(World&&) noexcept;

  void step(const Inputs& inputs) noexcept;

  const Observation& observation() const noexcept;
  const SceneDescription& description() const noexcept;
  const Model& model() const noexcept;

  const State& state() const noexcept;
  void restore(const State& state);

  /// Hash of the whole state, as in Observation::state_hash, and of each of its arrays by name in a fixed order.
  std::uint64_t state_hash() const noexcept;
  std::vector<std::pair<std::string, std::uint64_t>> array_hashes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Loads a scene by task name ("knot-square") from `root`/curricula and `root`/models. Throws InputError.
std::shared_ptr<const Model> load_model(const std::string& root, const std::string& task, const std::string& model_file = "");

}  // namespace filum
