#pragma once
// Space curves of known knots for the tests, built from their definition: stacks of throws round a post,
// hitches round a straight strand, closed braids and plats cut open. Lengths in metres.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/pose.h"
#include "base/rng.h"
#include "world/observation.h"

namespace filum::shapes {

inline constexpr double kPi = std::numbers::pi;

inline Points from_list(const std::vector<Vec3>& list) {
  Points points(3, static_cast<Eigen::Index>(list.size()));
  for (std::size_t k = 0; k < list.size(); ++k) points.col(static_cast<Eigen::Index>(k)) = list[k];
  return points;
}

/// Post along y below the knot.
inline PostShape post() {
  PostShape shape;
  shape.p_W = Vec3(0, 0, -1.0e-3);
  shape.radius = 0.5e-3;
  return shape;
}

/// Two strands twisted about a horizontal axis at each throw, stacked upwards from the post. half_twists: +-3
/// single throw, +-5 double, + right-handed. gap: distance of the strands' centrelines within a throw.
inline Points throws_round_post(const std::vector<int>& half_twists, double gap = 60e-6,
                                int nodes_per_twist = 6) {
  const double r = 0.5 * gap, pitch = 2.0 * gap;  // length along the axis for one half-twist
  const double rise = 4.0 * gap;
  // strands[0] starts at the left, strands[1] at the right; each throw swaps the sides.
  std::vector<Vec3> strands[2];
  if (half_twists.empty()) {  // both ends just come up
    strands[0] = {Vec3(-pitch, 0, 0)};
    strands[1] = {Vec3(pitch, 0, 0)};
  }
  for (std::size_t level = 0; level < half_twists.size(); ++level) {
    const int n = std::abs(half_twists[level]), hand = half_twists[level] > 0 ? -1 : 1;
    const double z = rise * static_cast<double>(level), width = 0.5 * n * pitch;
    for (int s = 0; s < 2; ++s) {
      // Strand s enters on this side, low, and leaves on the other side, high.
      const double side = (s + static_cast<int>(level)) % 2 == 0 ? -1.0 : 1.0;
      const int steps = n * nodes_per_twist;
      for (int k = 0; k <= steps; ++k) {
        const double along = static_cast<double>(k) / steps;
        const double x = side * width * (1.0 - 2.0 * along);
        const double turn = n * kPi * along;  // the mirror-image way for the strand from the other side
        strands[s].push_back(Vec3(x, side * hand * r * std::sin(turn), z - r * std::cos(turn)));
      }
    }
  }
  std::vector<Vec3> curve;
  const auto tail = [&](int s) {
    const double side = strands[s].back().x() > 0 ? 1.0 : -1.0;
    std::vector<Vec3> out;
    for (int k = 1; k <= 10; ++k) {
      out.push_back(strands[s].back() + 0.2e-3 * k * Vec3(0.9 * side, 0.05 * k, 0.3));
    }
    return out;
  };
  const std::vector<Vec3> left_tail = tail(0), right_tail = tail(1);
  curve.insert(curve.end(), left_tail.rbegin(), left_tail.rend());
  curve.insert(curve.end(), strands[0].rbegin(), strands[0].rend());
  const PostShape bar = post();
  for (int k = 0; k <= 16; ++k) {  // round the post from the left, below, to the right
    const double a = kPi + kPi * k / 16.0;
    curve.push_back(bar.p_W + 0.55e-3 * Vec3(std::cos(a), 0.02 * std::sin(3.0 * a), std::sin(a)));
  }
  curve.insert(curve.end(), strands[1].begin(), strands[1].end());
  curve.insert(curve.end(), right_tail.begin(), right_tail.end());
  return from_list(curve);
}

/// Half-hitches of one strand round the other, which runs straight up from the post. hands: +1 or -1 for each
/// hitch.
inline Points hitches_round_strand(const std::vector<int>& hands, double gap = 25e-6) {
  const double g = 1.25 * gap;
  const double top = (3.0 * static_cast<double>(hands.size()) + 2.0) * g;
  std::vector<Vec3> curve;
  for (int k = 40; k >= 0; --k) curve.push_back(Vec3(0, 0, -4.0 * g + 2.0 * (top + 4.0 * g) * k / 40.0));
  const PostShape bar = post();
  for (int k = 1; k < 16; ++k) {
    const double a = kPi + kPi * k / 16.0;
    curve.push_back(bar.p_W + 0.55e-3 * Vec3(std::cos(a), 0.02 * std::sin(3.0 * a), std::sin(a)));
  }
  double z = 0.0;
  for (int hand : hands) {
    // Seen along y: up on the right, over the straight strand to the left, back behind it, over its own
    // start.
    const double y = hand;
    for (const Vec3& p :
         {Vec3(2, 0, -1), Vec3(2, 0, 0), Vec3(1.7, 0.3 * y, 1), Vec3(0.8, 0.9 * y, 1.2), Vec3(0, 1.0 * y, 1),
          Vec3(-0.8, 0.7 * y, 0.8), Vec3(-1.1, 0, 0.5), Vec3(-0.8, -0.7 * y, 0.2), Vec3(0, -1.0 * y, 0),
          Vec3(1, -0.3 * y, 0), Vec3(2, 1.0 * y, 0), Vec3(3, 0.8 * y, 0), Vec3(3, 0, 1.5)}) {
      curve.push_back(g * p + Vec3(0, 0, z));
    }
    z += 3.0 * g;
  }
  const Vec3 last = curve.back();
  for (int k = 1; k <= 10; ++k) curve.push_back(last + 0.15e-3 * k * Vec3(0.9, 0.05 * k, 0.3));
  return from_list(curve);
}

/// Closed braid on `strands` strands (word: +-i swaps strands i and i+1, positive = right-handed crossing
/// when all run the same way), cut open on its outermost turn, tails led outwards.
inline Points open_braid(int strands, const std::vector<int>& word, double gap = 60e-6) {
  const int per = 6;                                      // nodes for one letter
  const int letters = static_cast<int>(word.size()) + 1;  // one quiet sector in which the cut is made
  const double ring = gap * (letters * 3.0 + 4.0) / (2.0 * kPi) + 2.0 * gap * strands;
  const auto place = [&](double sector, double lane, double height) {
    const double a = 2.0 * kPi * sector / letters, r = ring + 2.0 * gap * lane;
    return Vec3(r * std::cos(a), r * std::sin(a), height);
  };
  // Follow the strand in the outermost lane from the cut until it returns to it.
  std::vector<Vec3> curve;
  int lane = strands - 1;
  for (int turn = 0; turn < strands; ++turn) {
    for (int k = turn == 0 ? per / 2 : 0; k < per; ++k)
      curve.push_back(place(static_cast<double>(k) / per, lane, 0.0));
    for (int l = 1; l < letters; ++l) {
      const int letter = word[static_cast<std::size_t>(l - 1)], low = std::abs(letter) - 1;
      const bool rises = lane == low, falls = lane == low + 1;
      const double side = (rises ? 1.0 : -1.0) * (letter > 0 ? 1.0 : -1.0);
      const int next = rises ? lane + 1 : (falls ? lane - 1 : lane);
      for (int k = 0; k < per; ++k) {
        const double s = static_cast<double>(k) / per;
        const double height = rises || falls ? side * 0.6 * gap * std::sin(kPi * s) : 0.0;
        curve.push_back(place(l + s, lane + (next - lane) * s, height));
      }
      lane = next;
    }
  }
  for (int k = 0; k < per / 2 - 1; ++k) curve.push_back(place(static_cast<double>(k) / per, lane, 0.0));
  std::vector<Vec3> whole;
  const Vec3 out = place(0.25, 0, 0).normalized();
  for (int k = 12; k >= 1; --k) whole.push_back(curve.front() + k * 0.1 * ring * (out + Vec3(0, 0, 0.1)));
  whole.insert(whole.end(), curve.begin(), curve.end());
  for (int k = 1; k <= 12; ++k) whole.push_back(curve.back() + k * 0.1 * ring * (out - Vec3(0, 0, 0.1)));
  return from_list(whole);
}

/// A thread led along `path` and back beside it: an unknot whatever the path, as the bight can be drawn out
/// again.
inline Points doubled(const Points& path, double gap = 12e-6) {
  std::vector<Vec3> curve;
  const Eigen::Index n = path.cols();
  const auto beside = [&](Eigen::Index k) {
    const Vec3 along = path.col(std::min(k + 1, n - 1)) - path.col(std::max<Eigen::Index>(k - 1, 0));
    return Vec3(path.col(k) + gap * along.cross(Vec3(0.3, 0.2, 1)).normalized());
  };
  for (Eigen::Index k = 0; k < n; ++k) curve.push_back(path.col(k));
  for (Eigen::Index k = n - 1; k >= 0; --k) curve.push_back(beside(k));
  for (int k = 1; k <= 4; ++k) curve.push_back(curve.back() + Vec3(0, 0, 0.2e-3));  // part the tails
  return from_list(curve);
}

/// Smallest distance between edges that do not share a node. [m]
inline double strand_distance(const Points& p) {
  double best = 1e300;
  const Eigen::Index n = p.cols();
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    for (Eigen::Index j = i + 2; j + 1 < n; ++j) {
      // Sampled: fine enough for a bound that is then halved.
      for (int a = 0; a <= 4; ++a) {
        const Vec3 x = p.col(i) + 0.25 * a * (p.col(i + 1) - p.col(i));
        const Vec3 u = p.col(j + 1) - p.col(j);
        const double t = std::clamp(u.dot(x - p.col(j)) / u.squaredNorm(), 0.0, 1.0);
        best = std::min(best, (p.col(j) + t * u - x).norm());
      }
    }
  }
  return best;
}

/// The same knot, turned, its edges split at random, its nodes moved by less than a quarter of `distance`.
inline Points varied(const Points& p, double distance, Rng& rng) {
  const Mat3 turn = rng.rotation().toRotationMatrix();
  std::vector<Vec3> nodes;
  for (Eigen::Index k = 0; k < p.cols(); ++k) {
    nodes.push_back(p.col(k));
    if (k + 1 < p.cols() && rng.below(3) == 0)
      nodes.push_back(p.col(k) + rng.uniform(0.2, 0.8) * (p.col(k + 1) - p.col(k)));
  }
  const double amount = 0.24 * distance * rng.uniform();
  for (Vec3& node : nodes) node = turn * (node + amount * rng.direction());
  return from_list(nodes);
}

}  // namespace filum::shapes
