#include "world/wall_file.h"

#include <numbers>

#include "world/model_file.h"

namespace filum {
namespace {

// Small vessels, sheets and what they are made of, widely taken: a slip of unit or exponent is refused, no wall is.
constexpr Range kLayerThickness{1e-6, 5e-3};  // [m], an intima to a large artery's wall
constexpr Range kModulus{10.0, 1e10};         // [Pa], jelly to hard plastics
constexpr Range kBulkModulus{1e3, 1e11};      // [Pa]
constexpr Range kVesselLength{1e-5, 0.1};     // [m], radius and length
constexpr Range kWallDensity{100.0, 1e4};     // [kg/m3]
constexpr double kMostStress = 1e7;           // [Pa], of muscle and fibres
constexpr double kMostDamping = 1e5;          // [1/s]
constexpr Range kPressure{100.0, 1e5};        // [Pa], 750 mmHg

/// Active stress of the muscle around the vessel.
MuscleTone read_tone(const YamlNode& node) {
  MuscleTone tone;
  tone.shape = node.choice("shape", {"parabola", "bell"}) == "bell" ? MuscleTone::Shape::bell : MuscleTone::Shape::parabola;
  tone.stress = measured(node, "active_stress", "kPa", Range::between(0.0, kMostStress));
  tone.best = measured(node, "stretch_of_most_tone", "-", Range::between(1.02, 1.8));
  return tone;
}

WallLayer read_layer(const YamlNode& node) {
  WallLayer l;
  l.name = node.text("name");
  const std::string law = node.choice("law", {"linear", "neo-hookean", "fibres"});
  l.thickness = measured(node, "thickness", "um", kLayerThickness);
  if (law == "linear") {
    const double young = measured(node, "youngs_modulus", "kPa", kModulus);
    l.law = WallLaw::hooke(young, measured(node, "poisson", "-", Range::between(0.0, 0.499)));
    return l;
  }
  l.law.mu = measured(node, "shear_modulus", "kPa", kModulus);
  const double bulk = measured(node, "bulk", "MPa", kBulkModulus);
  l.law.lambda = bulk - 2.0 / 3.0 * l.law.mu;
  if (l.law.lambda < l.law.mu) node.refuse("bulk", "more than 5/3 of the shear modulus");
  l.law.kind = WallLaw::Kind::neo_hookean;
  if (node.has("tone")) l.law.tone = read_tone(node.map("tone"));
  if (law == "neo-hookean") return l;
  l.law.kind = WallLaw::Kind::fibres;
  l.law.k1 = measured(node, "k1", "kPa", Range::between(0.0, kMostStress));
  l.law.k2 = measured(node, "k2", "-", {1e-3, 1e3});
  l.law.beta = measured(node, "beta", "deg", Range::between(0.0, 0.5 * std::numbers::pi));
  return l;
}

void read_tube(const YamlNode& file, VesselPreset& p) {
  p.shape.inner_radius = measured(file, "inner_radius", "mm", kVesselLength);
  p.shape.length = measured(file, "length", "mm", kVesselLength);
  p.shape.opening_angle = measured(file, "opening_angle", "deg", Range::between(0.0, 1.9 * std::numbers::pi));
  p.axial_stretch = measured(file, "axial_stretch", "-", Range::between(0.5, 3.0));
  p.pressure = measured(file, "pressure", "mmHg", kPressure);
  // the radius in the file is the closed ring's; the opened sector with the same middle line is longer
  const double turn = 2.0 * std::numbers::pi, middle = p.shape.inner_radius + 0.5 * p.shape.thickness;
  p.shape.inner_radius = middle * turn / (turn - p.shape.opening_angle) - 0.5 * p.shape.thickness;
}

}  // namespace

VesselPreset load_vessel(const std::string& path) {
  const YamlNode file = open_model_file(path, "filum-vessel/1");
  VesselPreset p;
  p.title = file.text("title");
  p.tube = file.choice("kind", {"tube", "card"}) == "tube";
  p.shape.thickness = 0.0;
  for (const YamlNode& node : file.items("layers")) {
    p.layers.push_back(read_layer(node));
    p.shape.thickness += p.layers.back().thickness;
  }
  if (p.layers.empty() || p.layers.size() > 4) file.refuse("layers", "one to four layers");
  if (p.tube) read_tube(file, p);
  p.wall.density = measured(file, "density", "kg/m3", kWallDensity);
  p.wall.damping = measured(file, "damping", "1/s", Range::between(0.0, kMostDamping));
  file.finish();
  return p;
}

}  // namespace filum
