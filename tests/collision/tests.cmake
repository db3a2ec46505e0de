filum_test(collision/segment_distance filum_base Eigen3::Eigen)
filum_test(collision/point_triangle)
filum_test(collision/surface_tree)
