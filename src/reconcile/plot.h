#pragma once
// Line plots and heat maps as inline SVG.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace filum::reconcile {

struct Curve {
  Eigen::VectorXd x, y;
  std::string colour;
  bool dots = false;
  Eigen::VectorXd low;  // not empty: the area between it and y is filled
};

struct PlotText {
  std::string title, x, y;
};

std::string plot(const PlotText& text, const std::vector<Curve>& curves, int width = 380, int height = 230);
/// Rows of cells coloured by value, 0 white, `most` dark red.
std::string heat_map(const std::vector<std::string>& rows, const std::vector<std::vector<double>>& cells, double most);

}  // namespace filum::reconcile
