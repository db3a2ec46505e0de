// Pictures of a chessboard for the guided calibration without a camera: FOLDER/view_000.png, ... as of a board that is shown at one place after
// another and rests at each.
//   filum_board_pictures FOLDER           (and FOLDER/marker.png, marker 0 of 12 mm as the same camera sees it)
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "tests/tracker/board_views.h"
#include "tests/tracker/marker_views.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "filum_board_pictures FOLDER\n");
    return 2;
  }
  constexpr int kAtRest = 11;  // pictures, of 25 a second
  const filum::CameraModel camera = filum::small_camera();
  cv::RNG random(5);
  int n = 0;
  for (const filum::Pose& X : filum::whole_tour(camera)) {
    const cv::Mat picture = filum::picture_of_board(camera, X, 0.5, random);
    for (int k = 0; k < kAtRest; ++k, ++n) {
      char name[32];
      std::snprintf(name, sizeof name, "/view_%03d.png", n);
      if (!cv::imwrite(argv[1] + std::string(name), picture)) return 1;
    }
  }
  cv::Mat big = filum::blank2x(camera);
  filum::draw(camera, filum::picture_of(0), 0.02, 0.02, filum::board_at(camera, camera.cx, camera.cy, 0.1, 0.4, 0.2), big);
  if (!cv::imwrite(argv[1] + std::string("/marker.png"), filum::developed(big, 0.5, 1.5, random))) return 1;
  std::printf("%d pictures\n", n);
  return 0;
}
