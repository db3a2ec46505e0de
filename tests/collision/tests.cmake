filum_test(collision/segment_distance filum_base Eigen3::Eigen)
