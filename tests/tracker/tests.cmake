if(TARGET filum_tracker)
  foreach(name camera_model marker_tracker)
    filum_test(tracker/${name} opencv_imgproc opencv_calib3d)
  endforeach()
else()
  add_test(NAME tracker.NotTested COMMAND ${CMAKE_COMMAND} -E echo
    "SKIPPED: install libopencv-dev and libopencv-contrib-dev to build and test the camera tracker")
  set_tests_properties(tracker.NotTested PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED")
endif()
