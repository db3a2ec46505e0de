#pragma once
// The constant part of a scene: materials, instruments, post, first shape of the thread. Immutable after load.

#include <memory>
#include <string>
#include <vector>

#include "physics/implicit_rod.h"
#include "physics/instrument.h"
#include "physics/pellet.h"
#include "physics/rod_resolution.h"
#include "world/observation.h"

namespace filum {

struct BrainModel;   // world/brain_model.h
struct NeedleModel;  // world/needle_model.h
struct VesselModel;  // world/vessel_model.h

struct Model {
  SceneDescription description;
  RodMaterial thread;
  ContactMaterial contact;
  std::vector<PostShape> lips;     // thin bars along the mouth of the slit: they keep the thread's direction
  double post_friction = 0.3;      // [-], thread on the post and the sheet
  double jaw_friction = 0.15;      // [-], thread on the outside of polished jaws
  double rest_curvature = 0.0;     // [1/m], of the thread, kept from its packet, in the plane of the sheet
  Points thread_path;              // [m], 3 x n, first shape of the thread, short end first
  ResolutionOptions resolution;
  RodStepOptions step;
  std::vector<InstrumentParameters> instruments;
  std::vector<Pose> instrument_start;
  bool instruments_touch = true;   // each other, post and sheet; false: scenes whose demonstrations were made before they did
  std::vector<PelletParameters> pellets;  // small objects to be picked up; most scenes have none
  std::shared_ptr<const BrainModel> brain;  // instead of the thread, in scenes of brain retraction
  int sutures = 1;                 // with a needle: so many may be used, one after the other (world/fresh_suture.h)
  std::shared_ptr<const NeedleModel> needle;  // swaged to the long end of the thread; most scenes have none
  std::shared_ptr<const VesselModel> vessel;  // tissue to be stitched
  std::vector<std::string> sources;  // files it was read from, relative to the root
};

}  // namespace filum
