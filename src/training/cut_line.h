#pragma once
// Where places of the tissue at rest lie along a cut and how far across it: the straight cut of a card, the cut round the axis of two stumps, or two edges
// of their own shape (end to side). Of these each place counts by the nearest point of its own side's edge, as share of that edge's length, so that
// edges of different shape and length are laid on one another heel on heel and turned into angles: 360 degrees once round. Test: cut_line_test.

#include "world/observation.h"

namespace filum {

/// A place at rest [m] in the tissue on one side of a cut, 0 or 1.
struct CutPlace {
  Vec3 p;
  int side = 0;
};

class CutLine {
 public:
  explicit CutLine(const TissueDescription& d);  // keeps a reference

  /// [rad], round a closed cut from where its angle is zero, within -pi and pi.
  double angle(const CutPlace& a) const;
  double turn(const CutPlace& a, const CutPlace& b) const;   // [rad], from a to b the shorter way
  double along(const CutPlace& a, const CutPlace& b) const;  // [m]
  /// [m], from a to b at right angles to the cut; end to side as with the edges laid together.
  double across(const CutPlace& a, const CutPlace& b) const;
  double position(const CutPlace& a, const CutPlace& b) const;  // [m], along the cut, of the middle of the two
  /// [rad], how far round the lumen from a to b: 180 degrees is the wall across. End to side the greater of the turn along the edges and of each
  /// place's turn about its own vessel's axis, from its edge.
  double round_lumen(const CutPlace& a, const CutPlace& b) const;
  double radius() const noexcept { return radius_; }  // [m], length of a closed cut over 2 pi

 private:
  struct Foot {
    double arc = 0.0, distance = 0.0;  // [m]
    Vec3 at = Vec3::Zero();
  };
  bool edges() const { return !d_.edges[0].rim.empty(); }
  Foot foot(const CutPlace& a) const;
  double own_turn(const CutPlace& a) const;

  const TissueDescription& d_;
  double radius_ = 0.0;
  double length_[2] = {0.0, 0.0};  // [m], of the edges
};

}  // namespace filum
